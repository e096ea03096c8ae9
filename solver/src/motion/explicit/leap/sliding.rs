//! A wave that slides on one side of blades that move, step by step, with nothing
//! in the way: no search for sides, no angles, no other rows (docs/theory.md,
//! sections 6 and 10).
//!
//! The side's own blade phase `tau` multiplies the place along the side, so that there is
//! no closed form. But only the blade mode `a` that turns this side feels the push; the
//! one `across` it swings freely. In the frame of the blades at rest, with
//! `zeta = z conj(normal) = -g0 + X + i Y`, all numbers of a step are small parts.
//!
//! Tips that move outward or rub slide by the same loop, with larger phases, their slope
//! and friction, and what the ledger of energy asks of each step.

use super::along_side::SideStep;
use crate::model::Machine;
use crate::motion::explicit::disk::ModalBlades;
use crate::motion::explicit::record::Watch;
use crate::motion::explicit::rows::TipLaw;
use crate::motion::explicit::{Coordinate, Oscillator};
use crate::motion::{EnergyAccount, Plane};
use crate::tolerances::{
    LIGHT_PUSH, NEIGHBOUR_DEPTHS, SERIES_PHASE, SLIDING_DEPTH, SLIDING_SHARE, SMALL_TURN,
};

/// A wave under way along a side.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct Sliding {
    pub side: u32,
    rules: Rules,
    /// `X + i Y` above \[m\].
    place: Plane,
    /// Its change in the latest step \[m\].
    change: Plane,
    /// Angle of this side's blades.
    along: Coordinate,
    /// The same a step later, before the push of that step; and its phase, which would
    /// round otherwise if it were worked out anew where one looks.
    ahead: Coordinate,
    turn: f64,
    /// The mode that leaves them at rest.
    across: Coordinate,
    /// Multiplier of the latest step \[N\].
    pub multiplier: f64,
    /// What tips beyond the paper keep of the step before.
    pub before: Before,
}

/// What a step leaves to the ones after it, beyond the paper.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion::explicit) struct Before {
    /// `zeta[n-1] - w zeta[n-2]` \[m\].
    pub moved: Plane,
    /// Increments of `along` and `across` in the step before the last \[rad\].
    pub bent: [f64; 2],
    /// Gaps that the latest step and the one before have left \[m\].
    pub gaps: [f64; 2],
}

/// What a step needs and what ends it.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct Rules {
    step: SideStep,
    clearance: f64,
    diameters: f64,
    /// Displacement of the casing by a unit force in one step \[m/N\].
    compliance: f64,
    blades: Oscillator,
    /// Place along the side, angle and depth up to which no other side can touch; beyond
    /// the paper of blades without a phase.
    farthest: f64,
    widest: f64,
    depth: f64,
    /// Cosine and sine of the angle between two sides.
    upright: f64,
    aslant: f64,
    /// Tangent of half the angle between the directions that blades swing in.
    spread: f64,
    /// Tips beyond the paper.
    tips: Option<Tips>,
}

/// What a step of tips beyond the paper needs.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion::explicit) struct Tips {
    pub law: TipLaw,
    /// Way of the casing in a step from which on it must be looked at \[m\].
    pub fastest: f64,
    /// What the rotor turns in a step \[rad\], and the radius of the casing and the length
    /// of the blades \[m\].
    pub turned: f64,
    pub radius: f64,
    pub length: f64,
    /// Energy lost in the damping of the casing by the square of two increments \[J/m^2\].
    pub casing_lost: f64,
    /// Whether someone asks for the flows of energy.
    pub counts: bool,
}

/// What some steps did.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion::explicit) struct Done {
    pub steps: u64,
    /// Sum of the multipliers \[N\].
    pub pushes: f64,
    /// Deepest predicted penetration, and the deepest that a step has left \[m\].
    pub predicted: f64,
    pub left: f64,
    /// Flows of energy beyond the paper.
    pub flows: EnergyAccount,
}

impl Rules {
    /// None where blades of the paper are so light that a push moves them as it moves the
    /// casing.
    pub fn new(
        machine: &Machine,
        casing: &Oscillator,
        blades: &ModalBlades,
        step: SideStep,
        tips: Option<Tips>,
    ) -> Option<Self> {
        let polygon = &machine.polygon;
        let (clearance, diameters) = (polygon.clearance, machine.nodal_diameters);
        let (sin, cos) = (2.0 * polygon.delta).sin_cos();
        let depth = SLIDING_DEPTH * clearance * (1.0 - cos);
        // Blade phases move the gap of a neighbour by less than this.
        let turned = 2.0 * SMALL_TURN * clearance / polygon.delta.cos();
        let oscillator = blades.oscillator();
        let moment_arm = 2.0 * diameters * polygon.half_side();
        let share = moment_arm * moment_arm * oscillator.compliance / casing.compliance;
        let interleaved = polygon.sides % 2 == 1;
        let (near, widest) = match tips {
            Some(_) => (NEIGHBOUR_DEPTHS * depth + depth, SERIES_PHASE),
            None => (depth + turned, SMALL_TURN),
        };
        (tips.is_some() || share < LIGHT_PUSH).then(|| Self {
            step,
            clearance,
            diameters,
            compliance: casing.compliance,
            farthest: (clearance * (1.0 - cos) - near) / sin,
            upright: cos,
            aslant: sin,
            widest: widest / diameters,
            depth,
            spread: if interleaved { 0.5 * polygon.delta } else { polygon.delta }.tan(),
            blades: oscillator.clone(),
            tips,
        })
    }

    /// Returns the largest angle of any blade, for a side's blades at `along`.
    fn largest(&self, along: f64, across: f64, blades: &ModalBlades, side: u32) -> f64 {
        if across.abs() <= self.spread * along.abs() {
            return along.abs();
        }
        let (c, s) = blades.shape(side);
        blades.largest([c * along - s * across, s * along + c * across])
    }
}

impl Sliding {
    /// From the coordinates in the frame of the blades at rest, turned so that the
    /// inward normal of the side is real: `zeta`, `zeta[n] - w zeta[n-1]`, and the same a
    /// step before. None where a neighbour is near.
    pub fn new(
        rules: Rules,
        blades: &ModalBlades,
        side: u32,
        [zeta, moved]: [Plane; 2],
        [cosine, sine]: [Coordinate; 2],
        moved_before: Plane,
    ) -> Option<Self> {
        let (c, s) = blades.shape(side);
        let combine = |p: f64, q: f64| Coordinate {
            x: p * cosine.x + q * sine.x,
            increment: p * cosine.increment + q * sine.increment,
        };
        let across = combine(-s, c);
        let swing = rules.blades.reach_of([across, Coordinate::default()]).0;
        // Beyond the paper each step looks itself.
        let inside =
            rules.tips.is_some() || (zeta.im.abs() < rules.farthest && swing < rules.widest);
        let along = combine(c, s);
        let ahead = rules.blades.step(along, 0.0);
        let change = moved + rules.step.turned.conj() * (zeta - moved);
        let [cosine, sine] = blades.before();
        let gap = |zeta: Plane, along: f64| {
            rules.tips.map_or(0.0, |tips| tips.law.place((1.0, 0.0), zeta, along).gap)
        };
        let before = Before {
            moved: moved_before,
            bent: [c * cosine + s * sine, c * sine - s * cosine],
            gaps: [gap(zeta, along.x), gap(zeta - change, along.x - along.increment)],
        };
        inside.then(|| Self {
            side,
            place: zeta + rules.clearance,
            change,
            along,
            ahead,
            turn: rules.diameters * ahead.x,
            across,
            multiplier: 0.0,
            before,
            rules,
        })
    }

    /// Returns the amplitude of the blade modes \[rad\].
    pub fn amplitude(&self) -> f64 {
        self.along.x.hypot(self.across.x)
    }

    /// Returns `zeta`, and `zeta[n] - w zeta[n-1]`.
    pub fn casing(&self) -> [Plane; 2] {
        let zeta = self.place - self.rules.clearance;
        [zeta, self.change + self.rules.step.turned * (zeta - self.change)]
    }

    /// Returns the blade modes, and their increments of the step before the last.
    pub fn modes(&self, blades: &ModalBlades) -> ([Coordinate; 2], [f64; 2]) {
        let (c, s) = blades.shape(self.side);
        let combine = |p: f64, q: f64| Coordinate {
            x: p * self.along.x + q * self.across.x,
            increment: p * self.along.increment + q * self.across.increment,
        };
        let modes = [combine(c, -s), combine(s, c)];
        let [along, across] = self.before.bent;
        match self.rules.tips {
            Some(_) => (modes, [c * along - s * across, s * along + c * across]),
            None => (modes, modes.map(|mode| mode.increment)),
        }
    }

    /// Up to `steps` steps in which this side closes and no other can; fewer where the
    /// next one must be looked at.
    pub fn advance(&mut self, steps: u64, watch: &mut Watch, blades: &ModalBlades) -> Done {
        match self.rules.tips {
            Some(tips) => self.advance_by::<true>(tips, steps, watch, blades),
            None => self.advance_by::<false>(Tips::default(), steps, watch, blades),
        }
    }

    #[inline(always)]
    fn advance_by<const BEYOND: bool>(
        &mut self,
        tips: Tips,
        steps: u64,
        watch: &mut Watch,
        blades: &ModalBlades,
    ) -> Done {
        let Rules { step, clearance, diameters, compliance, .. } = self.rules;
        let Rules { farthest, widest, depth, upright, aslant, .. } = self.rules;
        let SideStep { stiff, push, lost, coriolis, turned } = step;
        let TipLaw { rise, pushed, casing_friction: drag, friction, .. } = tips.law;
        let fastest2 = tips.fastest * tips.fastest;
        let (farthest2, by_clearance) = ((0.5 * aslant * farthest).powi(2), 1.0 / clearance);
        let (keep, stiffness) = (1.0 - lost, 1.0 / compliance);
        let oscillator = &self.rules.blades;
        let (pull, ratio, soft) = (oscillator.pull, oscillator.ratio, oscillator.compliance);
        let Plane { re: mut x, im: mut y } = self.place;
        let Plane { re: mut dx, im: mut dy } = self.change;
        let Coordinate { x: mut a, increment: mut da } = self.along;
        let Coordinate { x: mut b, increment: mut db } = self.across;
        let mut done = Done::default();
        let mut largest = watch.largest();
        // Blade angle by a unit push at a unit lever, and what it adds to the compliance.
        let by_lever = soft * diameters;
        let inertia = by_lever * diameters * stiffness;
        let mut largest2 = largest * largest;
        let mut lambda = self.multiplier;
        let Coordinate { x: mut pa, increment: mut ea } = self.ahead;
        let mut turn = self.turn;
        let (mut before, mut latest) = (self.before, self.casing()[1]);
        let blades_lost = oscillator.lost();
        while done.steps < steps {
            let out = x - clearance;
            let ex = stiff * out + push * y + (keep * dx + coriolis * dy);
            let ey = stiff * y - push * out + (keep * dy - coriolis * dx);
            let (px, py) = (x + ex, y + ey);
            let eb = ratio * db - pull * b;
            let pb = b + eb;
            let (sin, bow) = phase::<BEYOND>(turn);
            let reach = clearance - px;
            let closed = px + (py * sin + reach * bow);
            let (gap, aside) =
                if BEYOND { (closed - rise * pa, py - rise * pb) } else { (closed, py) };
            if !(gap < 0.0 && gap > -depth && aside.abs() < farthest && pa.abs() < widest) {
                break;
            }
            let lever = py + (reach * sin - py * bow);
            let (arm, from) = (diameters * lever, Plane::new(out, y));
            let free = gap * stiffness;
            let bent;
            let mut moved = Plane::default();
            if BEYOND {
                bent = soft * (arm - pushed);
                let share = (arm - rise) * (bent * stiffness);
                // zeta* - w zeta[n]
                moved = Plane::new(ex, ey) + turned * from;
                // The gap of the nearer neighbour, with its blades' phase to the first order:
                // all phases move a gap by less than the root of `phases2`, and to the
                // second order by less than `phases2` over the clearance.
                let away = if aside > 0.0 { -aslant } else { aslant };
                let phase = diameters * (pa * upright + pb * away);
                let place2 = reach * reach + py * py;
                let phases2 = diameters * diameters * (pa * pa + pb * pb) * place2;
                let room = aslant * (farthest - aside.abs())
                    + upright * (px - rise * pa)
                    + phase * (py * upright + reach * away)
                    - phases2 * by_clearance;
                let apart = room > 0.0 && phases2 < farthest2 && moved.norm_sqr() < fastest2;
                if !(apart && share > -SLIDING_SHARE) {
                    break;
                }
                lambda = free / (1.0 + share);
            } else {
                bent = by_lever * lever;
                // gap/(compliance (1 + share)), to the third power of a small share.
                let share = inertia * (lever * lever);
                lambda = free - free * (share - share * share);
            }
            let shift = -compliance * lambda;
            let (sx, sy) = (shift - shift * bow, shift * sin);
            let (sx, sy) = if BEYOND { (sx - drag * sy, sy + drag * sx) } else { (sx, sy) };
            (dx, dy) = (ex + sx, ey + sy);
            (x, y) = (px + sx, py + sy);
            let turning = da;
            a = pa - bent * lambda;
            da = ea - bent * lambda;
            // The blades of the step after, without the push and by a unit of it: so that
            // from one push to the next there are few operations in a row.
            let kept = (ratio - pull) * bent;
            ea = ratio * ea - pull * pa;
            pa += ea;
            turn = diameters * pa - diameters * (bent + kept) * lambda;
            pa -= (bent + kept) * lambda;
            ea -= kept * lambda;
            if BEYOND {
                let (sine, versine) = phase::<true>(diameters * a);
                let left = x + (y * sine + (clearance - x) * versine) - rise * a;
                let now = moved + Plane::new(sx, sy);
                if tips.counts {
                    let flows = &mut done.flows;
                    let both = now + (latest - turned * latest);
                    let swept = [da + turning, eb + db];
                    flows.casing_loss_j += tips.casing_lost * both.norm_sqr();
                    flows.blade_loss_j += blades_lost * (swept[0] * swept[0] + swept[1] * swept[1]);
                    flows.impact_loss_j += 0.5 * lambda * (left - before.gaps[1]);
                    flows.rotor_work_j += lambda * arm * tips.turned;
                    if friction != 0.0 {
                        let slid = tips.radius * tips.turned;
                        let bent = 0.5 * tips.length * swept[0];
                        let along = 0.5 * (both.im * (1.0 - bow) - both.re * sin);
                        flows.rotor_work_j -= lambda * friction * slid;
                        flows.friction_heat_j -= lambda * (friction * (slid + bent) - drag * along);
                    }
                }
                done.left = done.left.max(-left);
                before =
                    Before { moved: latest, bent: [turning, db], gaps: [left, before.gaps[0]] };
                latest = now;
            }
            db = eb;
            b = pb;
            done.steps += 1;
            done.pushes += lambda;
            done.predicted = done.predicted.max(-gap);
            let size2 = a * a + b * b;
            if size2 > largest2 {
                largest = largest.max(self.rules.largest(a, b, blades, self.side));
                largest2 = largest * largest;
            }
        }
        self.multiplier = lambda;
        self.place = Plane::new(x, y);
        self.change = Plane::new(dx, dy);
        self.along = Coordinate { x: a, increment: da };
        self.ahead = Coordinate { x: pa, increment: ea };
        self.turn = turn;
        self.across = Coordinate { x: b, increment: db };
        self.before = before;
        watch.skipped(largest, a.abs() + b.abs());
        done
    }
}

/// Returns the sine and versine of the phase of a side, to round-off. In the paper's model its cube
/// is round-off.
#[inline(always)]
fn phase<const BEYOND: bool>(turn: f64) -> (f64, f64) {
    let q = turn * turn;
    if !BEYOND {
        return (turn, 0.5 * q);
    }
    let sixth = 1.0 / 6.0 - q * (1.0 / 120.0 - q * (1.0 / 5040.0));
    let versine = 0.5 - q * (1.0 / 24.0 - q * (1.0 / 720.0 - q * (1.0 / 40320.0)));
    (turn - turn * q * sixth, q * versine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::motion::explicit::Explicit;
    use crate::motion::explicit::disk::Disk;
    use crate::scene::Scene;

    /// Tips that move outward as blades bend and rub, under a pulse that lets them slide.
    fn scene(random: &mut fastrand::Rng) -> Scene {
        let mut scene = Scene::base();
        let mut between = |from: f64, to: f64| from + (to - from) * random.f64();
        scene.bladed_disk.radial_coupling = between(-0.4, 0.4);
        scene.contact.friction = between(-0.1, 0.3_f64).max(0.0);
        scene.casing.tangential_ratio = between(-0.3, 0.3_f64).max(0.0);
        scene.operation.speed_rad_s = between(150.0, 550.0);
        scene.operation.pulse_n = between(2e4, 2e5);
        scene.bladed_disk.inertia_kg_m2 *= between(0.05, 1.0);
        scene.solver.step_s = 1e-6;
        scene
    }

    fn numbers(motion: &Explicit<ModalBlades>) -> Vec<(f64, f64)> {
        let mut motion = motion.clone();
        motion.close_block();
        let (clearance, step) = (motion.machine.clearance(), motion.drive.step);
        let angle = clearance / motion.machine.blade_length;
        let energy = motion.casing.twice_energy(motion.casing.start(clearance, 0.0, 0.0));
        let of_casing = |at: f64| (at, clearance);
        let sums = motion.beyond.account.sums;
        let ledger = [sums.rotor_work_j, sums.casing_loss_j, sums.blade_loss_j];
        let heat = [sums.friction_heat_j, sums.impact_loss_j, motion.stored()];
        let mut all: Vec<_> = ledger.into_iter().chain(heat).map(|sum| (sum, energy)).collect();
        all.extend(motion.u.iter().flat_map(|at| [at.x, at.increment]).map(of_casing));
        all.extend(motion.beyond.before.into_iter().chain(motion.beyond.dips).map(of_casing));
        all.extend([motion.record.deepest, motion.record.deepest_predicted].map(of_casing));
        all.extend(motion.blades.modal().into_iter().map(|at| (at, angle)));
        all.extend(motion.blades.before().into_iter().map(|at| (at, angle)));
        all.push((motion.watch.largest(), angle));
        all.push((motion.beyond.lasting.swing(), clearance));
        // A momentum in the fifty steps between two looks.
        let force = motion.machine.casing_mass * clearance / (50.0 * step * step);
        all.extend(motion.take_mean_forces().into_iter().map(|(_, mean)| (mean, force)));
        all
    }

    #[test]
    fn slides_of_inclined_and_rubbing_tips_are_their_steps_one_by_one() {
        let mut random = fastrand::Rng::with_seed(71);
        let (mut slides, mut ended) = (0, 0);
        for turn in 0..40 {
            let scene = scene(&mut random);
            let mut slid = Explicit::<ModalBlades>::new(&scene.checked().unwrap());
            for part in 1..400 {
                let mut plain = slid.clone();
                plain.close_block();
                plain.leaps.slide_tried = u64::MAX;
                let t = 50e-6 * f64::from(part);
                let both = [slid.advance(t), plain.advance(t)];
                assert_eq!(both[0].is_ok(), both[1].is_ok(), "{turn} {part} {both:?}");
                if both[0].is_err() {
                    break;
                }
                slides += u32::from(slid.leaps.sliding.is_some());
                ended += u32::from(slid.leaps.sliding.is_none() && slid.leaps.slide_tried > 0);
                assert_eq!(slid.contacts().impact_count, plain.contacts().impact_count);
                let sets = [&slid, &plain].map(|motion| motion.contacts().active_set);
                assert_eq!(sets[0], sets[1], "{turn} {part}");
                for (k, (a, b)) in numbers(&slid).into_iter().zip(numbers(&plain)).enumerate() {
                    // Fifty steps add round-off of what is measured against.
                    let apart = (a.0 - b.0).abs() / (a.1 + a.0.abs());
                    assert!(apart < 1e-12, "{turn} {part} {k}: {a:?} {b:?}");
                }
            }
        }
        assert!(slides > 1000 && ended > 100, "{slides} {ended}");
    }
}
