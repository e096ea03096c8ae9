//! Corners of unequal tips (docs/theory.md, section 11): which sides of the polygon are left,
//! where neighbours of them meet, and at which speeds such a corner is held. With `gamma` from
//! the outward normal of the side `a` to the corner and `beta` to that of `b`, both sides push
//! where `gamma - beta <= theta <= gamma`, `theta = arg(-1/H)` mirrored.

use std::f64::consts::{PI, TAU};

use super::{LockWindow, Machine, Number};

/// A corner between two sides that nothing cuts off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipCorner<T = f64> {
    /// The sides `a` and `b`, in increasing phase.
    pub sides: [u32; 2],
    /// Angle from the normal of `a` to the corner \[rad\].
    pub gamma: T,
    /// Angle between both normals \[rad\].
    pub beta: f64,
    /// Distance of the corner from the centre \[m\].
    pub distance: T,
}

impl<T: Number> TipCorner<T> {
    /// Slope and sign of the two conditions `slope Re(1/H) + sign Im(1/H) <= 0` under which the
    /// sides `b` and `a` push.
    pub(super) fn conditions(&self) -> [(T, T); 2] {
        let rest = -self.gamma + self.beta;
        [(self.gamma.sin(), self.gamma.cos()), (rest.sin(), -rest.cos())]
    }

    /// The speeds, in `omega_c/n_d`, at which both sides push on a casing of this damping
    /// ratio without friction, for a rotor that turns forward or backward.
    pub(super) fn window(&self, damping: T, toward: f64) -> Option<LockWindow<T>> {
        let gamma = if toward < 0.0 { -self.gamma + self.beta } else { self.gamma };
        let at = |angle: T| {
            let x = damping / angle.tan();
            x + (x * x + 1.0).sqrt()
        };
        if gamma.re() <= 0.0 {
            // The drag of a slow wave is nearly opposite to the corner, which may be held at rest.
            let turned = gamma - self.beta + TAU;
            let held = turned.re() < PI;
            return held.then(|| LockWindow { from: T::from(0.0), to: Some(at(turned)) });
        }
        let beyond = gamma - self.beta;
        let to = (beyond.re() > 0.0).then(|| at(beyond));
        Some(LockWindow { from: at(gamma), to })
    }
}

impl<T: Number> Machine<T> {
    /// Every corner of two sides that no other cuts off, at the clearance of now.
    #[must_use]
    pub fn tip_corners(&self) -> Vec<TipCorner<T>> {
        let sides = 0..self.polygon.sides;
        let left =
            self.polygon.sides_left(&sides.map(|k| self.apothem(k).re()).collect::<Vec<_>>());
        let met = left.into_iter().filter(|left| left.next != left.side);
        met.map(|left| self.tip_corner([left.side, left.next])).collect()
    }

    /// The same, one of neighbours that are alike.
    fn other_tip_corners(&self) -> Vec<TipCorner<T>> {
        let mut corners = self.tip_corners();
        corners.dedup_by(|one, other| one.gamma.re() == other.gamma.re() && one.beta == other.beta);
        corners
    }

    fn tip_corner(&self, sides: [u32; 2]) -> TipCorner<T> {
        let [a, b] = sides.map(|side| self.apothem(side));
        let polygon = &self.polygon;
        let steps = (sides[1] + polygon.sides - sides[0]) % polygon.sides;
        let beta = 2.0 * polygon.delta * f64::from(steps);
        let (sin, cos) = beta.sin_cos();
        let along = (b - a * cos) / sin;
        TipCorner { sides, gamma: along.atan2(a), beta, distance: (a * a + along * along).sqrt() }
    }

    /// The corner that is held at the lowest speed, for a rotor that turns in the sense of
    /// `toward`, with those speeds; none where no corner is, and where that is not known: on a
    /// lining, and with a clearance that closes with the speed.
    #[must_use]
    pub fn lowest_corner(&self, toward: f64) -> Option<(TipCorner<T>, Vec<LockWindow<T>>)> {
        if !self.knows_tip_corners() {
            return None;
        }
        // Derivatives are those of the one corner that is found.
        let plain = self.plain();
        let from = |corner: &TipCorner| plain.windows_of(corner, toward).first().map(|of| of.from);
        let found = plain.other_tip_corners().into_iter();
        let lowest = found
            .filter_map(|corner| Some((from(&corner)?, corner.sides)))
            .min_by(|one, other| one.0.total_cmp(&other.0))?;
        let corner = self.tip_corner(lowest.1);
        let windows = self.windows_of(&corner, toward);
        Some((corner, windows))
    }

    /// Whether it is known at which speeds corners of unequal tips are held.
    fn knows_tip_corners(&self) -> bool {
        self.polygon.has_corners() && self.lining.is_none() && self.clearance_loss().re() == 0.0
    }

    /// The windows of speeds at which any corner of unequal tips is held, in order and apart.
    pub(super) fn windows_of_tips(&self, toward: f64) -> Vec<LockWindow<T>> {
        if !self.knows_tip_corners() {
            return Vec::new();
        }
        let corners = self.other_tip_corners();
        let mut all: Vec<_> =
            corners.iter().flat_map(|corner| self.windows_of(corner, toward)).collect();
        all.sort_by(|one, other| one.from.re().total_cmp(&other.from.re()));
        let mut apart: Vec<LockWindow<T>> = Vec::new();
        for window in all {
            let end = |window: &LockWindow<T>| window.to.map_or(f64::INFINITY, |to| to.re());
            match apart.last_mut().filter(|last| window.from.re() <= end(last)) {
                Some(last) if end(&window) > end(last) => last.to = window.to,
                Some(_) => {}
                None => apart.push(window),
            }
        }
        apart
    }

    /// The windows of speeds at which a corner is held.
    #[must_use]
    pub fn windows_of(&self, corner: &TipCorner<T>, toward: f64) -> Vec<LockWindow<T>> {
        if self.casing_feels_tips() {
            return self.windows(corner.conditions(), toward);
        }
        let scaled = || {
            let critical = self.critical_speed()?;
            let LockWindow { from, to } = corner.window(self.casing_damping_ratio, toward)?;
            Some(LockWindow { from: critical * from, to: to.map(|to| critical * to) })
        };
        scaled().into_iter().collect()
    }
}
