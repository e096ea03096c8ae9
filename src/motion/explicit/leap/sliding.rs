//! A wave that slides on one side of blades that move, step by step, with nothing
//! in the way: no search for sides, no angles, no other rows (docs/theory.md,
//! section 6).
//!
//! The side's own blade phase `tau` multiplies the place along the side, so that there is
//! no closed form. But only the blade mode `a` that turns this side feels the push; the
//! one `across` it swings freely. In the frame of the blades at rest, with
//! `zeta = z conj(normal) = -g0 + X + i Y`, all numbers of a step are small parts.

use super::held_side::SideStep;
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::explicit::disk::ModalBlades;
use crate::motion::explicit::record::Watch;
use crate::motion::explicit::{Coordinate, Oscillator};
use crate::tolerances::{LIGHT_PUSH, SLIDING_DEPTH, SMALL_TURN};

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
    /// Place along the side, angle and depth up to which no other side can touch.
    farthest: f64,
    widest: f64,
    depth: f64,
    /// Tangent of half the angle between the directions that blades swing in.
    spread: f64,
}

/// What some steps did.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion::explicit) struct Done {
    pub steps: u64,
    /// Sum of the multipliers \[N\].
    pub pushes: f64,
    /// Deepest predicted penetration \[m\].
    pub predicted: f64,
}

impl Rules {
    /// None where blades are so light that a push moves them as it moves the casing.
    pub fn new(
        machine: &Machine,
        casing: &Oscillator,
        blades: &ModalBlades,
        step: SideStep,
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
        (share < LIGHT_PUSH).then(|| Self {
            step,
            clearance,
            diameters,
            compliance: casing.compliance,
            farthest: (clearance * (1.0 - cos) - depth - turned) / sin,
            widest: SMALL_TURN / diameters,
            depth,
            spread: if interleaved { 0.5 * polygon.delta } else { polygon.delta }.tan(),
            blades: oscillator.clone(),
        })
    }

    /// The largest angle of any blade, for a side's blades at `along`.
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
    /// inward normal of the side is real: `zeta`, and `zeta[n] - w zeta[n-1]`.
    /// None where a neighbour is near.
    pub fn new(
        rules: Rules,
        blades: &ModalBlades,
        side: u32,
        [zeta, moved]: [Plane; 2],
        [cosine, sine]: [Coordinate; 2],
    ) -> Option<Self> {
        let (c, s) = blades.shape(side);
        let combine = |p: f64, q: f64| Coordinate {
            x: p * cosine.x + q * sine.x,
            increment: p * cosine.increment + q * sine.increment,
        };
        let across = combine(-s, c);
        let swing = rules.blades.reach_of([across, Coordinate::default()]).0;
        let inside = zeta.im.abs() < rules.farthest && swing < rules.widest;
        let along = combine(c, s);
        let ahead = rules.blades.step(along, 0.0);
        inside.then(|| Self {
            side,
            place: zeta + rules.clearance,
            change: moved + rules.step.turned.conj() * (zeta - moved),
            along,
            ahead,
            turn: rules.diameters * ahead.x,
            across,
            multiplier: 0.0,
            rules,
        })
    }

    /// `zeta`, and `zeta[n] - w zeta[n-1]`.
    pub fn casing(&self) -> [Plane; 2] {
        let zeta = self.place - self.rules.clearance;
        [zeta, self.change + self.rules.step.turned * (zeta - self.change)]
    }

    /// The blade modes.
    pub fn modes(&self, blades: &ModalBlades) -> [Coordinate; 2] {
        let (c, s) = blades.shape(self.side);
        let combine = |p: f64, q: f64| Coordinate {
            x: p * self.along.x + q * self.across.x,
            increment: p * self.along.increment + q * self.across.increment,
        };
        [combine(c, -s), combine(s, c)]
    }

    /// Up to `steps` steps in which this side closes and no other can; fewer where the
    /// next one must be looked at.
    pub fn advance(&mut self, steps: u64, watch: &mut Watch, blades: &ModalBlades) -> Done {
        let Rules { step, clearance, diameters, compliance, .. } = self.rules;
        let Rules { farthest, widest, depth, .. } = self.rules;
        let SideStep { stiff, push, lost, coriolis, .. } = step;
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
        let soft = soft * diameters;
        let inertia = soft * diameters * stiffness;
        let mut largest2 = largest * largest;
        let mut lambda = self.multiplier;
        let Coordinate { x: mut pa, increment: mut ea } = self.ahead;
        let mut turn = self.turn;
        while done.steps < steps {
            let out = x - clearance;
            let ex = stiff * out + push * y + (keep * dx + coriolis * dy);
            let ey = stiff * y - push * out + (keep * dy - coriolis * dx);
            let (px, py) = (x + ex, y + ey);
            // The gap of the side, turned by an angle whose cube is round-off.
            let bow = 0.5 * (turn * turn);
            let reach = clearance - px;
            let gap = px + (py * turn + reach * bow);
            if !(gap < 0.0 && gap > -depth && py.abs() < farthest && pa.abs() < widest) {
                break;
            }
            let lever = py + (reach * turn - py * bow);
            // gap/(compliance (1 + share)), to the third power of a small share.
            let share = inertia * (lever * lever);
            let free = gap * stiffness;
            lambda = free - free * (share - share * share);
            let bent = soft * lever;
            let shift = -compliance * lambda;
            let (sx, sy) = (shift - shift * bow, shift * turn);
            (dx, dy) = (ex + sx, ey + sy);
            (x, y) = (px + sx, py + sy);
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
            db = ratio * db - pull * b;
            b += db;
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
        watch.skipped(largest, a.abs() + b.abs());
        done
    }
}
