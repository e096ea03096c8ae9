//! A wave that slides on one side of rigid blades: step after step the same
//! side closes, and no other (docs/theory.md, section 6). Such a stretch is decided on
//! once, up to the step that may end it, and looked at wherever asked.

use std::sync::Arc;

use super::side_map::{Along, SideMap};
use super::{BladeModel, Coordinate, Explicit};
use crate::motion::{ActiveSet, Plane};

/// A stretch of sliding, from the step it starts at.
#[derive(Clone, Debug)]
pub(super) struct HeldSide {
    map: Arc<SideMap>,
    pub side: u32,
    start: Along,
    /// Steps that it lasts.
    pub length: u64,
    /// Casing displacement by a unit force in one step \[m/N\].
    compliance: f64,
}

impl HeldSide {
    fn after(&self, steps: u64) -> Along {
        self.map.after(self.start, steps)
    }

    /// Multiplier of the step that led to `steps` steps from the start \[N\].
    pub fn multiplier(&self, steps: u64) -> f64 {
        self.map.gap(self.after(steps.saturating_sub(1))) / self.compliance
    }

    /// Sum of the multipliers of the steps after `before`, up to `steps` \[N\].
    pub fn sum(&self, before: u64, steps: u64) -> f64 {
        let [from, to] = [before, steps].map(|steps| self.after(steps));
        self.map.gaps(from, to, steps - before) / self.compliance
    }

    /// Deepest predicted penetration of those steps \[m\].
    pub fn deepest(&self, before: u64, steps: u64) -> f64 {
        let [from, to] =
            [before, steps.saturating_sub(1).max(before)].map(|steps| self.after(steps));
        self.map.deepest(from, to)
    }
}

impl<B: BladeModel> Explicit<B> {
    /// The stretch of steps from now on that close this one side and no other.
    pub(super) fn hold_side(&mut self) -> Option<HeldSide> {
        let ActiveSet::Side(side) = self.log.active_set else { return None };
        let rigid = self.blades.held_modes().is_some_and(|blades| blades.moving.is_none());
        if !rigid || self.same_sides < 2 || !self.is_steady() || self.n < self.slide_tried {
            return None;
        }
        let map = self.side_map();
        let back = self.standing_side(side, self.n).conj();
        let [u_c, u_s] = self.u;
        let y = (Plane::new(u_c.x, u_s.x) * back).im;
        let moved = Plane::new(u_c.increment, u_s.increment) * back;
        let clearance = self.machine.polygon.clearance;
        // moved = zeta[n] - exp(-i nu h) zeta[n-1]
        let before = Plane::new(-clearance, y) - moved;
        let step = moved + map.turned.conj() * before;
        let start = Along::new(y, step.im, clearance, 0.0);
        let length = map.length(start);
        let compliance = self.casing.compliance;
        Some(HeldSide { map, side, start, length, compliance })
    }

    /// `exp(i (n_d theta + psi))` of a side at step `n`: its inward normal in the
    /// standing frame.
    fn standing_side(&self, side: u32, n: u64) -> Plane {
        let diameters = self.machine.nodal_diameters;
        let (c, s) = self.phasor.once(n, &self.rotor, diameters, self.step);
        let (cos, sin) = self.machine.polygon.direction(side);
        Plane::new(c, s) * Plane::new(cos, sin)
    }

    /// The map of a side at this speed.
    fn side_map(&mut self) -> Arc<SideMap> {
        let turn = self.machine.nu(self.rotor.speed(self.time_of(self.n))) * self.step;
        let (machine, farthest) = (&self.machine, 0.5 * self.scene.casing.radius_m);
        let make = || Arc::new(SideMap::new(&machine.polygon, &self.casing, turn, farthest));
        self.side_map.get_or_insert_with(make).clone()
    }

    /// Coordinates of the casing `steps` steps into the stretch.
    pub(super) fn along_side(&self, held: &HeldSide, steps: u64) -> [Coordinate; 2] {
        let at = held.after(steps);
        let (y, step) = (at[0], at[1]);
        let before = Plane::new(-at[2], y - step);
        // zeta[n] - exp(-i nu h) zeta[n-1]
        let moved = Plane::new(0.0, step) + held.map.turned * before;
        let turn = self.standing_side(held.side, self.n + steps);
        let (place, moved) = (Plane::new(-at[2], y) * turn, moved * turn);
        [
            Coordinate { x: place.re, increment: moved.re },
            Coordinate { x: place.im, increment: moved.im },
        ]
    }
}
