//! A step from one corner to the next, worked out with its small parts apart, so that it
//! carries no round-off of the gaps.
//!
//! The prediction of such a step leaves the corner by some `h^2` of the clearance, and a
//! gap taken from the clearance itself would round that off. In the frame of the blades,
//! with `q = 1 - exp(-i nu h)`, `r = 1 - ratio` and the steps of the oscillator, a casing
//! that stood in the corners `z[n-1]` and `z[n]` is predicted at
//!
//! ```text
//! z* = z[n] - (q (q + r - q r) + (1 - q) pull) z[n] + (1 - q)^2 (1 - r) (z[n] - z[n-1])
//! ```
//!
//! where nothing is added up that cancels. A side turned by `tau` from where it touched at
//! `y`, a reach `d` from the centre, opens by `2 d sin^2(tau/2) + y sin tau`. Tips that
//! rise as blades bend by `a` move their side by `kappa l_b a`, and friction turns the
//! pushes (`rows`).

use nalgebra::SVector;

use crate::contact;
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::explicit::disk::ModalBlades;
use crate::motion::explicit::rows::TipLaw;
use crate::motion::explicit::{Coordinate, Oscillator};
use crate::tolerances::{HELD_LEFT, HELD_ROUNDINGS};

/// `(alpha_c, alpha_s)` and their increments.
pub(in crate::motion::explicit) type Modes = SVector<f64, 4>;

/// A step from one corner to the next.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct CornerStep {
    sides: [u32; 2],
    /// `exp(i psi)` of both sides.
    directions: [Plane; 2],
    tips: TipLaw,
    casing: Oscillator,
    blades: Option<ModalBlades>,
    /// `q` above.
    turned: Plane,
    /// How much the tips of both sides are longer \[m\].
    longer: [f64; 2],
    /// Gaps of both sides in every corner, as each step leaves them \[m\].
    pub open: [f64; 2],
}

/// What a step does.
pub(in crate::motion::explicit) struct Stepped {
    /// Change of the blade modes.
    pub change: Modes,
    /// Multipliers of both sides \[N\].
    pub multipliers: [f64; 2],
    /// Predicted gaps of both sides \[m\], their normals and moment arms.
    pub gaps: [f64; 2],
    pub normals: [Plane; 2],
    pub arms: [f64; 2],
    /// What the correction leaves of the gaps, as it turns the sides \[m\].
    pub left: [f64; 2],
}

/// Two sides turned to these phases by the last change of them, by blades at these angles,
/// which turned with it \[rad\].
#[derive(Clone, Copy)]
struct Sides {
    turns: [f64; 2],
    change: [f64; 2],
    angles: [f64; 2],
    bent: [f64; 2],
}

impl CornerStep {
    /// Creates the step of a wave that turns by `turn` per step against the standing frame.
    pub fn new(
        machine: &Machine,
        tips: TipLaw,
        casing: &Oscillator,
        blades: Option<&ModalBlades>,
        sides: [u32; 2],
        turn: f64,
    ) -> Self {
        let half = (0.5 * turn).sin();
        Self {
            sides,
            directions: sides.map(|side| {
                let (c, s) = machine.polygon.direction(side);
                Plane::new(c, s)
            }),
            tips,
            casing: casing.clone(),
            blades: blades.cloned(),
            turned: Plane::new(2.0 * half * half, turn.sin()),
            longer: sides.map(|side| machine.longest_of_side(side)),
            open: [0.0; 2],
        }
    }

    pub fn sides(&self) -> [u32; 2] {
        self.sides
    }

    /// Returns the sine of the angle between the sides.
    pub fn sine(&self) -> f64 {
        (self.directions[0].conj() * self.directions[1]).im
    }

    /// Returns the blades that move, if any.
    pub fn blades(&self) -> Option<&ModalBlades> {
        self.blades.as_ref()
    }

    /// Returns the angle of the blades of both sides at these displacements of the modes.
    pub fn angles(&self, displacements: [f64; 2]) -> [f64; 2] {
        let Some(blades) = &self.blades else { return [0.0; 2] };
        self.sides.map(|side| {
            let (c, s) = blades.shape(side);
            c * displacements[0] + s * displacements[1]
        })
    }

    fn sides_at(&self, modes: Modes) -> Sides {
        let (angles, bent) = (self.angles([modes[0], modes[1]]), self.angles([modes[2], modes[3]]));
        let turns = |angles: [f64; 2]| angles.map(|angle| self.tips.diameters * angle);
        Sides { turns: turns(angles), change: turns(bent), angles, bent }
    }

    /// Where the casing stands and what it moved with the last change of the sides, and
    /// the normals there.
    fn stand(&self, sides: Sides) -> (Plane, Plane, [Plane; 2]) {
        let Sides { turns, change, angles, bent } = sides;
        let TipLaw { clearance, rise, .. } = self.tips;
        let a = self.directions[0] * Plane::cis(turns[0]);
        let b = self.directions[1] * Plane::cis(turns[1]);
        let spread = (a.conj() * b).im;
        // Without rise and gaps the corner is z = i g0 (b - a)/Im(conj(a) b); with them,
        // i ((g0 - p) b - (g0 - q) a)/Im(conj(a) b).
        let scale = -clearance / spread;
        let corner = Plane::new(scale * (b.im - a.im), scale * (a.re - b.re));
        let [p, q] = [0, 1].map(|k| self.open[k] + self.longer[k] + rise * angles[k]);
        let raised = Plane::new(p * b.im - q * a.im, q * a.re - p * b.re) / spread;
        // Its change, taken apart from its value before: of s/D it is
        // (ds - now dD)/(D - dD).
        let back = |normal: Plane, by: f64| {
            let half = (0.5 * by).sin();
            // normal (1 - exp(-i by))
            normal * Plane::new(2.0 * half * half, by.sin())
        };
        let (da, db) = (back(a, change[0]), back(b, change[1]));
        let before = ((a - da).conj() * (b - db)).im;
        let spread = (da.conj() * b + a.conj() * db - da.conj() * db).im;
        let shift = Plane::i() * (da - db) * -clearance;
        let moved = (shift - corner * spread) / before;
        let [dp, dq] = bent.map(|bent| rise * bent);
        let shift = Plane::i() * (q * da + dq * (a - da) - p * db - dp * (b - db));
        let raised_by = (shift - raised * spread) / before;
        (corner + raised, moved + raised_by, [a, b])
    }

    /// Returns whether a step leaves the gaps it begins with, but for next to nothing of those
    /// predicted at rest.
    pub fn is_closed_by(&self, step: &Stepped, at_rest: [f64; 2]) -> bool {
        let part = HELD_LEFT.max(HELD_ROUNDINGS * f64::EPSILON / self.sine().powi(2));
        (0..2).all(|k| (step.left[k] - self.open[k]).abs() <= part * at_rest[k].abs())
    }

    /// Returns the casing in the corner of these modes, and what it moved in its last
    /// step, both in the frame of the blades now.
    pub fn casing(&self, modes: Modes) -> (Plane, Plane) {
        let (place, moved, _) = self.stand(self.sides_at(modes));
        // z[n] - exp(-i nu h) z[n-1]
        (place, moved + self.turned * (place - moved))
    }

    /// Returns `exp(-i nu h)`.
    pub fn turn(&self) -> Plane {
        Plane::new(1.0, 0.0) - self.turned
    }

    /// Takes one step from these modes. `None` where the rows are dependent.
    pub fn from(&self, modes: Modes) -> Option<Stepped> {
        let sides = self.sides_at(modes);
        let (place, moved, normals) = self.stand(sides);
        let TipLaw { clearance, diameters, rise, pushed, .. } = self.tips;
        let (q, one) = (self.turned, Plane::new(1.0, 0.0));
        let (loss, pull) = (self.casing.loss, self.casing.pull);
        let pulled = q * (q + loss - q * loss) + (one - q) * pull;
        let shift = (one - q) * (one - q) * ((1.0 - loss) * moved) - place * pulled;
        // The blades predict, too: their change, which is their increment.
        let steps = self.blades.as_ref().map(|blades| {
            let at = |x, increment| Coordinate { x, increment };
            [at(modes[0], modes[2]), at(modes[1], modes[3])]
                .map(|mode| blades.oscillator().step(mode, 0.0).increment)
        });
        let steps = steps.unwrap_or_default();
        let bends = self.angles(steps);
        let ahead: [Plane; 2] =
            std::array::from_fn(|k| normals[k] * Plane::cis(diameters * bends[k]));
        // Gaps of a casing that has left the corner, of sides turned meanwhile.
        let opened = |shift: Plane, bends: [f64; 2]| -> [f64; 2] {
            std::array::from_fn(|k| {
                let turn = diameters * bends[k];
                let half = (0.5 * turn).sin();
                let along = (place * normals[k].conj()).im;
                let reach = clearance - self.open[k] - self.longer[k] - rise * sides.angles[k];
                let turned = 2.0 * reach * half * half + along * turn.sin();
                let gone = (shift * (normals[k] * Plane::cis(turn)).conj()).re + turned;
                self.open[k] + (gone - rise * bends[k])
            })
        };
        let gaps = opened(shift, bends);
        let arms = ahead.map(|normal| diameters * ((place + shift) * normal.conj()).im);
        let bent = |j: usize, k: usize| {
            self.blades.as_ref().map_or(0.0, |blades| {
                let ((ca, sa), (cb, sb)) =
                    (blades.shape(self.sides[j]), blades.shape(self.sides[k]));
                blades.oscillator().compliance * (ca * cb + sa * sb)
            })
        };
        let pushes = ahead.map(|normal| self.tips.push_on_casing(normal));
        let entry = |j: usize, k: usize| {
            self.casing.compliance * (ahead[j] * pushes[k].conj()).re
                + (arms[j] - rise) * (arms[k] - pushed) * bent(j, k)
        };
        let w = [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]];
        let multipliers = contact::pair(w, gaps);
        let (mut change, mut left) = (Modes::zeros(), [0.0; 2]);
        if let Some(blades) = &self.blades {
            let (mut taken, mut moved) = (steps, shift);
            for k in 0..2 {
                let (c, s) = blades.shape(self.sides[k]);
                let torque = -(arms[k] - pushed) * multipliers[k] * blades.oscillator().compliance;
                taken[0] += torque * c;
                taken[1] += torque * s;
                moved -= pushes[k] * (self.casing.compliance * multipliers[k]);
            }
            change = Modes::new(taken[0], taken[1], taken[0] - modes[2], taken[1] - modes[3]);
            left = opened(moved, self.angles(taken));
        }
        let finite = multipliers.iter().all(|lambda| lambda.is_finite());
        let normals = ahead;
        finite.then_some(Stepped { change, multipliers, gaps, normals, arms, left })
    }

    /// Flows of energy in the step from these modes, for a rotor that turns by `rotor`
    /// \[rad\] in it, as a plain step beyond the paper counts them: work of the rotor, loss
    /// of casing and blades, heat of friction \[J\].
    pub fn flows(
        &self,
        modes: Modes,
        step: &Stepped,
        rotor: f64,
        length: f64,
        radius: f64,
    ) -> [f64; 4] {
        let next = modes + step.change;
        // Over the last two steps, in the frame at their end.
        let moved = self.casing(next).1 + self.turn() * self.casing(modes).1;
        let turned = [next[2] + modes[2], next[3] + modes[3]];
        let bent = self.angles(turned);
        let lost = self.blades.as_ref().map_or(0.0, |blades| blades.oscillator().lost());
        let TipLaw { friction, casing_friction, .. } = self.tips;
        let (mut work, mut heat) = (0.0, 0.0);
        for (k, bent) in bent.into_iter().enumerate() {
            let push = -step.multipliers[k];
            let along = 0.5 * (moved * step.normals[k].conj()).im;
            work += push * (friction * radius * rotor - step.arms[k] * rotor);
            heat += push
                * (friction * (radius * rotor + 0.5 * length * bent) - casing_friction * along);
        }
        let casing = self.casing.lost() * moved.norm_sqr();
        let blades = lost * (turned[0] * turned[0] + turned[1] * turned[1]);
        [work, casing, blades, heat]
    }

    /// Returns the smallest gap of the sides that are not held, for modes at these displacements.
    pub fn nearest_other(&self, machine: &Machine, modes: Modes) -> f64 {
        let (place, ..) = self.stand(self.sides_at(modes));
        let others = (0..machine.polygon.sides).filter(|side| !self.sides.contains(side));
        let gap = |side| {
            let angle = self.blades.as_ref().map_or(0.0, |blades| {
                let (c, s) = blades.shape(side);
                c * modes[0] + s * modes[1]
            });
            self.tips.place(machine.polygon.direction(side), place, angle).gap
                - machine.longest_of_side(side)
        };
        others.map(gap).fold(f64::INFINITY, f64::min)
    }
}
