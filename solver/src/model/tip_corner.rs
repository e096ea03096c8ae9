//! Corners of the contact polygon that hold the wave (docs/theory.md, sections 4 and 11).
//!
//! With equal tips all corners are alike, and one represents them. Unequal tips give the sides
//! different apothems, so some sides are cut off and the remaining neighbours meet at other angles.
//! This module finds the corners and the speeds at which pushes hold them: with the angle `gamma`
//! from the outward normal of side `a` to the corner and the angle `beta` to the normal of side `b`
//! (`delta` and `2 delta` for equal tips), both sides push where `gamma - beta <= theta <= gamma`,
//! `theta = -arg(-1/H)`, with the response `H` of the casing as in `lock.rs`.

use std::f64::consts::{PI, TAU};

use super::{LockWindow, Machine};

/// Corner between two neighbouring sides that remain part of the polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipCorner {
    /// Sides `a` and `b`, in the direction of increasing phase.
    pub sides: [u32; 2],
    /// Angle from the outward normal of `a` to the corner, positive towards increasing phase
    /// \[rad\].
    pub gamma: f64,
    /// Angle between both normals \[rad\].
    pub beta: f64,
    /// Distance of the corner from the centre of the polygon \[m\].
    pub distance: f64,
}

impl TipCorner {
    /// Returns slope and sign of the two conditions `slope Re(1/H) + sign Im(1/H) <= 0` under which
    /// sides `b` and `a` push.
    pub(super) fn conditions(&self) -> [(f64, f64); 2] {
        let rest = self.beta - self.gamma;
        [(self.gamma.sin(), self.gamma.cos()), (rest.sin(), -rest.cos())]
    }

    /// Returns the speeds, in units of `omega_c/n_d`, at which both sides push for the casing
    /// damping ratio `damping`, without friction and inclined tips. The sign of `toward` is the
    /// direction of rotation. `None` if pushes hold the corner at no speed.
    pub(super) fn window(&self, damping: f64, toward: f64) -> Option<LockWindow> {
        let gamma = if toward < 0.0 { self.beta - self.gamma } else { self.gamma };
        let at = |angle: f64| drag_factor(damping / angle.tan());
        if gamma <= 0.0 {
            // The drag of a slow wave acts nearly opposite to the corner, which may then be held
            // from standstill on.
            let turned = gamma - self.beta + TAU;
            let held = turned < PI;
            return held.then(|| LockWindow { from: 0.0, to: Some(at(turned)) });
        }
        let beyond = gamma - self.beta;
        let to = (beyond > 0.0).then(|| at(beyond));
        Some(LockWindow { from: at(gamma), to })
    }
}

impl Machine {
    /// Returns every corner of the polygon at the current clearance.
    #[must_use]
    pub fn tip_corners(&self) -> Vec<TipCorner> {
        let sides = 0..self.polygon.sides;
        let left = self.polygon.sides_left(&sides.map(|k| self.apothem(k)).collect::<Vec<_>>());
        let met = left.into_iter().filter(|left| left.next != left.side);
        met.map(|left| self.tip_corner([left.side, left.next])).collect()
    }

    /// Returns the corners that differ: one for equal tips, otherwise one of each run of equal
    /// neighbours. Empty without corners, and where unequal tips have no closed form.
    pub(super) fn other_corners(&self) -> Vec<TipCorner> {
        if !self.polygon.has_corners() || !self.knows_tip_corners() {
            return Vec::new();
        }
        if !self.has_unequal_tips() {
            let (gamma, distance) = (self.polygon.delta, self.clearance / self.polygon.delta.cos());
            return vec![TipCorner { sides: [0, 1], gamma, beta: 2.0 * gamma, distance }];
        }
        let mut corners = self.tip_corners();
        corners.dedup_by(|one, other| one.gamma == other.gamma && one.beta == other.beta);
        corners
    }

    fn tip_corner(&self, sides: [u32; 2]) -> TipCorner {
        let [a, b] = sides.map(|side| self.apothem(side));
        let polygon = &self.polygon;
        let steps = (sides[1] + polygon.sides - sides[0]) % polygon.sides;
        let beta = 2.0 * polygon.delta * f64::from(steps);
        let (sin, cos) = beta.sin_cos();
        let along = (b - a * cos) / sin;
        TipCorner { sides, gamma: along.atan2(a), beta, distance: (a * a + along * along).sqrt() }
    }

    /// Returns the corner that pushes hold at the lowest speed, and its speed windows, for a rotor
    /// that turns in the direction of the sign of `toward`. `None` if pushes hold no corner, and
    /// where unequal tips have no closed form.
    #[must_use]
    pub fn lowest_corner(&self, toward: f64) -> Option<(TipCorner, Vec<LockWindow>)> {
        let corners = self.other_corners().into_iter();
        let held = corners.map(|corner| (corner, self.windows_of(&corner, toward)));
        let lowest = |windows: &[LockWindow]| windows.first().map_or(f64::INFINITY, |of| of.from);
        held.filter(|(_, windows)| !windows.is_empty())
            .min_by(|(_, one), (_, other)| lowest(one).total_cmp(&lowest(other)))
    }

    /// Returns whether the corners have a closed form: unequal tips have none on a lining, and with
    /// a clearance that changes with speed.
    pub(super) fn knows_tip_corners(&self) -> bool {
        !self.has_unequal_tips() || (self.lining.is_none() && self.clearance_loss() == 0.0)
    }

    /// Returns the windows of speeds at which pushes hold one corner, for a rotor that turns in the
    /// direction of the sign of `toward`.
    #[must_use]
    pub fn windows_of(&self, corner: &TipCorner, toward: f64) -> Vec<LockWindow> {
        if self.casing_feels_tips() || self.lining.is_some() {
            return self.windows(corner, toward);
        }
        let scaled = || {
            let critical = self.critical_speed()?;
            let LockWindow { from, to } = corner.window(self.casing_damping_ratio, toward)?;
            Some(LockWindow { from: critical * from, to: to.map(|to| critical * to) })
        };
        scaled().into_iter().collect()
    }
}

/// Returns `x + sqrt(1 + x^2)`, the ratio of a lock speed to the critical speed.
pub(super) fn drag_factor(x: f64) -> f64 {
    x + (x * x + 1.0).sqrt()
}
