//! Lock speeds and locked contact forces in closed form, for blades that are rigid in rotation
//! (docs/theory.md, sections 4 and 10).
//!
//! Two neighbouring phase groups carry the contact force `q = -(g0/cos delta)/H`, where `H = B(nu)`
//! is the joint compliance of casing and blades (`frame`). Both groups push where
//! `|arg(-1/H)| <= delta`.
//!
//! On a lining with the group stiffness `k` (no smoothing) both push where
//! `-tan(delta) Re H - |Im H| >= 1/(k sin 2 delta)`, which adds the term
//! `|1/H|^2/(k sin 2 delta)` to the condition on `1/H`. If the blades grow with speed, every window
//! ends where the clearance closes.
//!
//! Read [`Machine::lock_windows`] first, then `windows`, the general case.

use super::tip_corner::drag_factor;
use super::{Frame, Machine, TipCorner};
use crate::numeric::search::{geometric, zeros};

/// Range of rotor speeds with a lock, flutter, whirl or growth, as the function that returns it
/// states. Both ends are magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockWindow {
    /// Lowest speed; 0 if the range begins at standstill \[rad/s\].
    pub from: f64,
    /// Highest speed; `None` if the range is unbounded \[rad/s\].
    pub to: Option<f64>,
}

impl LockWindow {
    /// Returns whether the magnitude `speed` lies in the window \[rad/s\].
    #[must_use]
    pub fn has(&self, speed: f64) -> bool {
        self.from <= speed && self.to.is_none_or(|to| speed <= to)
    }

    /// Returns the parts of this window outside `other`, in increasing order.
    pub(crate) fn without(self, other: &Self) -> impl Iterator<Item = Self> + use<> {
        let ends_before = |to: f64| self.to.is_none_or(|end| end > to);
        let lower = Self {
            from: self.from,
            to: Some(other.from).filter(|to| ends_before(*to)).or(self.to),
        };
        let upper = other.to.filter(|to| ends_before(*to)).map(|to| {
            let from = if to > self.from { to } else { self.from };
            Self { from, to: self.to }
        });
        let lower = Some(lower).filter(|_| self.from < other.from);
        lower.into_iter().chain(upper)
    }
}

impl Machine {
    /// Returns the lock speed: the lowest speed at which both multipliers of the locked motion are
    /// compressive, for forward rotation \[rad/s\].
    ///
    /// Without friction, inclined tips and lining,
    /// `Omega_lock = Omega_c [zeta cot delta + sqrt(1 + zeta^2 cot^2 delta)]`. `None` without
    /// corners, or if no speed has a lock.
    #[must_use]
    pub fn lock_speed(&self) -> Option<f64> {
        self.lock_windows(1.0).first().map(|window| window.from)
    }

    /// Returns every window of speeds at which pushes alone balance a lock, in increasing order,
    /// for a rotor that turns in the direction of the sign of `toward`. The lock may be unstable;
    /// `harmonic::lock_windows` returns the windows with a stable one.
    ///
    /// Empty without corners, if the blades rub at rest, and where unequal tips or an out-of-round
    /// casing have no closed form. Also empty if inclined tips have modes with other nodal
    /// diameters than the casing: then no single wave closes both gaps.
    #[must_use]
    pub fn lock_windows(&self, toward: f64) -> Vec<LockWindow> {
        if self.clearance_at_rest() <= 0.0 {
            return Vec::new();
        }
        if self.out_of_round() != 0.0 {
            return self.lock_out_of_round().into_iter().collect();
        }
        let corners = self.other_corners();
        let mut all: Vec<LockWindow> =
            corners.iter().flat_map(|corner| self.windows_of(corner, toward)).collect();
        all.sort_by(|one, other| one.from.total_cmp(&other.from));
        let mut apart: Vec<LockWindow> = Vec::new();
        for window in all {
            let end = |window: &LockWindow| window.to.unwrap_or(f64::INFINITY);
            match apart.last_mut().filter(|last| window.from <= end(last)) {
                Some(last) if end(&window) > end(last) => last.to = window.to,
                Some(_) => {}
                None => apart.push(window),
            }
        }
        self.with_clearance(apart)
    }

    /// Returns whether the speeds at which pushes balance a lock are known; they are not if unequal
    /// tips or lobes have no closed form.
    #[must_use]
    pub fn knows_locks(&self) -> bool {
        let shape = self.out_of_round() == 0.0 || self.lock_out_of_round().is_some();
        let nothing_locks = !self.polygon.has_corners() || self.clearance_at_rest() <= 0.0;
        nothing_locks || (shape && self.knows_tip_corners())
    }

    /// Window for an out-of-round casing whose number of lobes equals `n_d`: the lobes act as the
    /// static force `k_c e` on the casing mode. `None` for other lobe counts, where a largest
    /// height is known instead of a window (`harmonic::roundness`), and in combination with unequal
    /// tips.
    fn lock_out_of_round(&self) -> Option<LockWindow> {
        let lobes = self.tips.as_ref().map_or(0, |tips| tips.lobes);
        let alone = !self.has_unequal_tips() && !self.casing_feels_tips() && self.lining.is_none();
        if lobes != self.polygon.nodal_diameters || !alone || self.changes_with_speed() {
            return None;
        }
        let slope = 1.0 / self.polygon.delta.tan();
        let x = self.casing_damping_ratio * slope;
        let root = (x * x + 1.0 + self.out_of_round() / self.clearance * slope).sqrt();
        let critical = self.critical_speed().filter(|_| self.polygon.has_corners())?;
        Some(LockWindow { from: critical * (x + root), to: None })
    }

    /// Cuts the windows off at the speed at which the clearance closes.
    fn with_clearance(&self, mut windows: Vec<LockWindow>) -> Vec<LockWindow> {
        if let Some(closed) = self.closing_speed() {
            windows.retain(|window| window.from < closed);
            for window in &mut windows {
                window.to = Some(window.to.map_or(closed, |to| to.min(closed)));
            }
        }
        windows
    }

    /// Returns the adhesive speed: the lowest speed at which the paper's equality algorithm holds a
    /// lock, one multiplier being tensile \[rad/s\]. The formula is that of
    /// [`lock_speed`](Self::lock_speed) with `tan(beta - gamma)` for `cot gamma`. `None` without
    /// corners, without clearance, where no contact can pull, out of round, and for unequal tips if a
    /// lock of pushes begins at a lower speed.
    #[must_use]
    pub fn adhesive_speed(&self) -> Option<f64> {
        let known = self.contact_can_pull() && self.out_of_round() == 0.0;
        let (corner, windows) = self.lowest_corner(1.0).filter(|_| known)?;
        let slope = (corner.beta - corner.gamma).tan();
        let speed = self.critical_speed()? * drag_factor(self.casing_damping_ratio * slope);
        // If a lock of pushes begins below this speed, there is no range of adhesive locks.
        let below = |lock: &LockWindow| !self.has_unequal_tips() || speed < lock.from;
        let open = self.clearance_at_rest() > 0.0
            && self.closing_speed().is_none_or(|closed| speed < closed);
        (open && windows.first().is_none_or(below)).then_some(speed)
    }

    /// Returns whether every lock above the critical speed pushes: without damping, inclined tips
    /// and lining both contact forces are equal.
    #[must_use]
    pub fn locks_from_critical_speed(&self) -> bool {
        self.casing_damping == 0.0 && !self.casing_feels_tips() && self.lining.is_none()
    }

    /// Returns the windows of speeds at which `slope Re(1/H) + sign Im(1/H) <= 0`, plus the term of
    /// a lining, for both sides of a corner ([`TipCorner::conditions`]). For equal tips without a
    /// lining the two conditions together are `|arg(-1/H)| <= delta`. The sign of `toward` is the
    /// direction of rotation.
    pub(super) fn windows(&self, corner: &TipCorner, toward: f64) -> Vec<LockWindow> {
        let Some(critical) = self.critical_speed() else { return Vec::new() };
        if !self.polygon.has_corners() || self.has_other_diameters() {
            return Vec::new();
        }
        let sense = 1_f64.copysign(toward);
        let lining = self.lining.map_or(0.0, |lining| {
            let group = lining.stiffness_n_per_m * f64::from(self.polygon.blades_per_side);
            corner.gamma.cos() / (group * corner.beta.sin())
        });
        let sides = corner.conditions();
        let excess = |speed: f64| {
            let inverse = Frame::at(self, sense * speed).impedance();
            let of_lining = lining * inverse.norm_sqr();
            let of = |(slope, sign): (f64, f64)| inverse.re * slope + inverse.im * sign + of_lining;
            f64::max(of(sides[0]), of(sides[1]))
        };
        // A point at every fifth, and at every half of the distance from the critical speed.
        let beside = geometric([1e-10, 0.5], 1.5).flat_map(|apart| [1.0 - apart, 1.0 + apart]);
        let places = geometric([1e-9, 1e9], 1.2).chain(beside).chain([1.0]);
        let mut places: Vec<f64> = places.map(|place| critical * place).collect();
        places.sort_by(f64::total_cmp);
        let mut ends = vec![0.0];
        ends.extend(zeros(&places, excess));
        ends.push(f64::INFINITY);
        let mut windows: Vec<LockWindow> = Vec::new();
        for pair in ends.windows(2) {
            let (from, to) = (pair[0], Some(pair[1]).filter(|to| to.is_finite()));
            let middle = to.map_or(2.0 * from + critical, |to| 0.5 * (from + to));
            if excess(middle) > 0.0 {
                continue;
            }
            match windows.last_mut().filter(|last| last.to == Some(from)) {
                Some(last) => last.to = to,
                None => windows.push(LockWindow { from, to }),
            }
        }
        windows
    }

    /// Returns the corner of which the loads of a lock are stated: that of equal tips, or the one
    /// that is held at the lowest speed.
    fn locked_corner(&self, toward: f64) -> Option<TipCorner> {
        let clear = self.clearance() > 0.0;
        let corner = match self.has_unequal_tips() {
            true => self.lowest_corner(toward).map(|(corner, _)| corner),
            false => self.other_corners().first().copied(),
        };
        corner.filter(|_| clear)
    }

    /// Returns the amplitude of the locked casing wave, `g0/cos delta` \[m\]. `None` without
    /// corners or clearance, if no corner of unequal tips is held, and with inclined tips or a
    /// lining, where the amplitude depends on the speed.
    #[must_use]
    pub fn locked_amplitude(&self) -> Option<f64> {
        let still = self.radial_coupling == 0.0 && self.lining.is_none();
        self.locked_corner(1.0).filter(|_| still).map(|corner| corner.distance)
    }

    /// Returns the group multipliers `[lambda_a, lambda_b]` of the locked motion at a constant
    /// speed, with the sides in the order of their phase; negative is a push \[N\].
    ///
    /// For rigid contact and blades that are rigid in rotation they are
    /// `(g0/2 cos delta)(Re(1/H)/cos delta -+ Im(1/H)/sin delta)` with equal tips. Without friction
    /// and inclined tips `1/H = K + i D` with `K = k_c - nu^2 m_c` and `D = d_c nu`. `None` without
    /// corners, with an interference fit, if inclined tips have modes with other nodal diameters
    /// than the casing, and if no corner of unequal tips is held.
    #[must_use]
    pub fn locked_multipliers(&self, speed: f64) -> Option<[f64; 2]> {
        let here = self.at(speed);
        let known = !(here.casing_feels_tips() && here.has_other_diameters());
        let corner = here.locked_corner(speed).filter(|_| known)?;
        let inverse = Frame::at(&here, speed).impedance();
        let scale = corner.distance / corner.beta.sin();
        let push = |(own, sign): (f64, f64)| (own * inverse.re + sign * inverse.im) * scale;
        let [b, a] = corner.conditions().map(push);
        Some([a, b])
    }

    /// Returns the largest deviation `e` of the tips, between `-e` and `e`, with which both sides of
    /// the corner push whichever tips are long or short \[m\]. If they do not push with equal tips,
    /// the value is negative; its magnitude is the smallest deviation with which a corner can push.
    /// `None` if tips or casing are uneven already, if the contact does not push the casing outward,
    /// if the deviation would cut a side off, and where `locked_multipliers` are unknown.
    ///
    /// Both sides push where `theta <= gamma`, with
    /// `tan theta = tan(delta) (lambda_a - lambda_b)/(lambda_a + lambda_b)`. The apothems
    /// `g0 - e` and `g0 + e` of both sides turn `gamma = delta` until
    /// `e = g0 tan(delta) tan(delta - theta)`.
    #[must_use]
    pub fn tip_deviation(&self, speed: f64) -> Option<f64> {
        let [a, b] = self.locked_multipliers(speed).filter(|_| self.lining.is_none())?;
        if self.is_uneven() || a + b >= 0.0 {
            return None;
        }
        let (delta, clearance) = (self.polygon.delta, self.at(speed).clearance());
        let theta = (delta.tan() * ((a - b) / (a + b)).abs()).atan();
        let deviation = clearance * delta.tan() * (delta - theta).tan();
        let cut = clearance * ((2.0 * delta).cos().recip() - 1.0);
        Some(deviation).filter(|deviation| -deviation < cut)
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{BladedDisk, Casing, LiningLaw, Machine};

    fn paper(casing: Casing) -> Machine {
        Machine::new(&BladedDisk::default(), &casing, 3)
    }

    #[test]
    fn blades_that_rub_at_rest_have_no_lock() {
        let radius_m = BladedDisk::default().blade_length_m - 1e-5;
        let pressed = paper(Casing { radius_m, ..Casing::default() });
        assert!(pressed.lock_windows(1.0).is_empty());
        assert_eq!((pressed.adhesive_speed(), pressed.locked_amplitude()), (None, None));
    }

    #[test]
    fn the_amplitude_of_a_lock_on_a_lining_is_not_that_of_rigid_contact() {
        let rigid = paper(Casing::default());
        let lining = LiningLaw { stiffness_n_per_m: 1e9, smoothing_m: 0.0 };
        assert!(rigid.locked_amplitude().is_some());
        assert_eq!(rigid.with_lining(Some(lining)).locked_amplitude(), None);
    }

    #[test]
    fn a_corner_keeps_its_pushes_up_to_the_deviation_of_the_tips_and_gains_them_beyond() {
        let equal = paper(Casing::default());
        let first = equal.polygon.side_of_blade(1);
        let sides = [first, (first + 1) % equal.polygon.sides];
        for speed in [360.0, 380.0, 411.0, 413.0, 480.0, 900.0] {
            let needed = equal.tip_deviation(speed).unwrap();
            assert_eq!(needed > 0.0, equal.lock_speed().unwrap() < speed);
            for (part, pushes) in [(0.99, needed > 0.0), (1.01, needed < 0.0)] {
                let mut disk = BladedDisk { tips_m: vec![part * needed; 22], ..Default::default() };
                disk.tips_m[0] = -part * needed;
                let machine = Machine::new(&disk, &Casing::default(), 3);
                let corner = machine.tip_corners().into_iter().find(|at| at.sides == sides);
                let windows = machine.windows_of(&corner.unwrap(), 1.0);
                let has = windows.iter().any(|window| window.has(speed));
                assert_eq!(has, pushes, "{speed} {part} {needed}");
            }
        }
        assert_eq!([290.0, 305.0].map(|speed| equal.tip_deviation(speed)), [None; 2]);
    }

    #[test]
    fn a_corner_of_unequal_tips_is_held_where_both_forces_push_whichever_way_the_rotor_turns() {
        let disk = BladedDisk { tips_m: vec![1e-5, 0.0, -4e-6, 2e-6], ..Default::default() };
        for (mu, radial_coupling) in [(0.0, 0.0), (0.4, 0.0), (0.0, 0.1), (0.3, -0.1)] {
            let disk = BladedDisk { radial_coupling, ..disk.clone() };
            let casing = Casing { tangential_ratio: 0.3, ..Casing::default() };
            let machine = Machine::new(&disk, &casing, 3).with_friction(mu);
            for toward in [1.0, -1.0] {
                let (_, windows) = machine.lowest_corner(toward).unwrap();
                let holds = |speed: &f64| windows.iter().any(|window| window.has(*speed));
                let pushes = |speed: &f64| {
                    let forces = machine.locked_multipliers(toward * speed).unwrap();
                    forces.iter().all(|force| *force < 0.0)
                };
                let speeds: Vec<f64> = (1..200).map(|step| 5.0 * f64::from(step)).collect();
                let held: Vec<_> = speeds.iter().map(holds).collect();
                assert_eq!(held, speeds.iter().map(pushes).collect::<Vec<_>>(), "{mu} {toward}");
                assert!(held.contains(&true) && held.contains(&false), "{mu} {toward}");
            }
        }
    }

    #[test]
    fn with_friction_alone_a_lock_has_no_upper_end() {
        let casing = Casing { tangential_ratio: 0.3, ..Casing::default() };
        for k in 1..20_u32 {
            let machine = paper(casing.clone()).with_friction(0.02 * f64::from(k));
            let window = machine.lock_windows(1.0).first().copied().unwrap();
            assert_eq!(window.to, None, "{k}");
            let push = |part: f64| {
                let multipliers = machine.locked_multipliers(window.from * part).unwrap();
                multipliers.iter().all(|lambda| *lambda < 0.0)
            };
            assert!(push(1.0 + 1e-9) && !push(1.0 - 1e-9), "{k}: {window:?}");
        }
    }
}
