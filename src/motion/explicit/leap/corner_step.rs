//! One step of a casing held in a corner, with its small parts kept apart
//! (docs/theory.md, section 6).
//!
//! The prediction leaves the corner by some `h^2` of the clearance, and a gap
//! taken from the clearance itself would round that off. In the frame of the
//! blades, with `q = 1 - exp(-i nu h)`, `r = 1 - ratio` and the steps of the
//! oscillator, a casing that stood in the corners `z[n-1]` and `z[n]` is
//! predicted at
//!
//! ```text
//! z* = z[n] - (q (q + r - q r) + (1 - q) pull) z[n] + (1 - q)^2 (1 - r) (z[n] - z[n-1])
//! ```
//!
//! where nothing is added up that cancels. A side turned by `tau` from where it
//! touched at `y` opens by `2 g0 sin^2(tau/2) + y sin tau`.

use super::held_corner::Modes;
use crate::contact;
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::explicit::disk::ModalBlades;
use crate::motion::explicit::{Coordinate, Oscillator};

/// A step from one corner to the next.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct CornerStep {
    sides: [u32; 2],
    /// `exp(i psi)` of both sides.
    directions: [Plane; 2],
    clearance: f64,
    diameters: f64,
    casing: Oscillator,
    blades: Option<ModalBlades>,
    /// `q` above.
    turned: Plane,
}

/// What a step does.
pub(in crate::motion::explicit) struct Stepped {
    /// Change of the blade modes.
    pub change: Modes,
    /// Multipliers of both sides \[N\].
    pub multipliers: [f64; 2],
    /// Predicted gaps of both sides \[m\].
    pub gaps: [f64; 2],
    /// What the correction leaves of them, as it turns the sides \[m\].
    pub left: [f64; 2],
}

impl CornerStep {
    /// For a wave that turns by `turn` a step against the standing frame.
    pub fn new(
        machine: &Machine,
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
            clearance: machine.clearance(),
            diameters: machine.nodal_diameters,
            casing: casing.clone(),
            blades: blades.cloned(),
            turned: Plane::new(2.0 * half * half, turn.sin()),
        }
    }

    pub fn sides(&self) -> [u32; 2] {
        self.sides
    }

    /// Sine of the angle between the sides.
    pub fn sine(&self) -> f64 {
        (self.directions[0].conj() * self.directions[1]).im
    }

    /// The blades that move, if any.
    pub fn blades(&self) -> Option<&ModalBlades> {
        self.blades.as_ref()
    }

    /// `n_d alpha` of both sides at these displacements of the modes.
    fn turns(&self, displacements: [f64; 2]) -> [f64; 2] {
        let Some(blades) = &self.blades else { return [0.0; 2] };
        self.sides.map(|side| {
            let (c, s) = blades.shape(side);
            self.diameters * (c * displacements[0] + s * displacements[1])
        })
    }

    /// The point where both gaps are zero, and the normals there.
    fn corner(&self, turns: [f64; 2]) -> (Plane, [Plane; 2]) {
        let a = self.directions[0] * Plane::cis(turns[0]);
        let b = self.directions[1] * Plane::cis(turns[1]);
        let scale = -self.clearance / (a.conj() * b).im;
        (Plane::new(scale * (b.im - a.im), scale * (a.re - b.re)), [a, b])
    }

    /// Change of the corner where the sides turn by `change` to `turns`.
    fn moved(&self, turns: [f64; 2], change: [f64; 2]) -> Plane {
        // z = i g0 (b - a)/Im(conj(a) b), taken apart from its value before.
        let (now, [a, b]) = self.corner(turns);
        let back = |normal: Plane, by: f64| {
            let half = (0.5 * by).sin();
            // normal (1 - exp(-i by))
            normal * Plane::new(2.0 * half * half, by.sin())
        };
        let (da, db) = (back(a, change[0]), back(b, change[1]));
        let before = ((a - da).conj() * (b - db)).im;
        let spread = (da.conj() * b + a.conj() * db - da.conj() * db).im;
        // now = s/D, then = (s - ds)/(D - dD): now - then = (ds - now dD)/(D - dD).
        let shift = Plane::i() * (da - db) * -self.clearance;
        (shift - now * spread) / before
    }

    /// The casing in the corner of these modes, and what it moved in its last
    /// step, both in the frame of the blades now.
    pub fn casing(&self, modes: Modes) -> (Plane, Plane) {
        let turns = self.turns([modes[0], modes[1]]);
        let place = self.corner(turns).0;
        let moved = self.moved(turns, self.turns([modes[2], modes[3]]));
        // z[n] - exp(-i nu h) z[n-1]
        (place, moved + self.turned * (place - moved))
    }

    /// One step from these modes. `None` where the rows are dependent.
    pub fn from(&self, modes: Modes) -> Option<Stepped> {
        let turns = self.turns([modes[0], modes[1]]);
        let (place, normals) = self.corner(turns);
        let moved = self.moved(turns, self.turns([modes[2], modes[3]]));
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
        let bends = self.turns(steps);
        let ahead: [Plane; 2] = std::array::from_fn(|k| normals[k] * Plane::cis(bends[k]));
        // Gaps of a casing that has left the corner, of sides turned meanwhile.
        let opened = |shift: Plane, bends: [f64; 2]| -> [f64; 2] {
            std::array::from_fn(|k| {
                let half = (0.5 * bends[k]).sin();
                let along = (place * normals[k].conj()).im;
                let turned = 2.0 * self.clearance * half * half + along * bends[k].sin();
                (shift * (normals[k] * Plane::cis(bends[k])).conj()).re + turned
            })
        };
        let gaps = opened(shift, bends);
        let arms = ahead.map(|normal| self.diameters * ((place + shift) * normal.conj()).im);
        let bent = |j: usize, k: usize| {
            self.blades.as_ref().map_or(0.0, |blades| {
                let ((ca, sa), (cb, sb)) =
                    (blades.shape(self.sides[j]), blades.shape(self.sides[k]));
                blades.oscillator().compliance * (ca * cb + sa * sb)
            })
        };
        let entry = |j: usize, k: usize| {
            self.casing.compliance * (ahead[j] * ahead[k].conj()).re
                + arms[j] * arms[k] * bent(j, k)
        };
        let cross = entry(0, 1);
        let multipliers = contact::pair([[entry(0, 0), cross], [cross, entry(1, 1)]], gaps);
        let (mut change, mut left) = (Modes::zeros(), [0.0; 2]);
        if let Some(blades) = &self.blades {
            let (mut taken, mut moved) = (steps, shift);
            for k in 0..2 {
                let (c, s) = blades.shape(self.sides[k]);
                let torque = -arms[k] * multipliers[k] * blades.oscillator().compliance;
                taken[0] += torque * c;
                taken[1] += torque * s;
                moved -= ahead[k] * (self.casing.compliance * multipliers[k]);
            }
            change = Modes::new(taken[0], taken[1], taken[0] - modes[2], taken[1] - modes[3]);
            left = opened(moved, self.turns(taken));
        }
        let finite = multipliers.iter().all(|lambda| lambda.is_finite());
        finite.then_some(Stepped { change, multipliers, gaps, left })
    }
}
