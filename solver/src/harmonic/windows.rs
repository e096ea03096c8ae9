//! Ranges of rotor speed with a lock, and with flutter (docs/theory.md, sections 4 and 10). The spans
//! of a condition are found by one scan over the speed and by bisection.
//!
//! A lock **holds** if it is admissible (both groups push, every other gap is open) and stable (no
//! motion that keeps the contacts grows, with the curvature of the pushes). [`Locks::hold`] is this
//! condition; `hbm`, `margins`, `survey`, `check`, runs and the screen use it.
//!
//! The scan has a point every 3 %, from a twentieth of the critical speed to ten times (lock) or
//! fifty times (whirl and flutter) the faster of critical speed and coincidence. It also includes
//! the ends of the closed form for rigid blades (`Machine::lock_windows`), points beside them and
//! the middles between them. An end of the scan within 0.2 % of one of the closed form is replaced
//! by it. With rigid blades, and without slope if the blades hardly bend up to the last speed, there is
//! no scan: the closed form is returned.

use super::held::Held;
use super::{Corner, Form, Locked, LockedPoint};
use crate::model::{Frame, LockWindow, Machine, TipCorner};
use crate::numeric::search::{geometric, spans};

/// Highest speed of the search for whirl and flutter, relative to the faster of critical speed and
/// coincidence. No rotor turns faster.
pub(super) const FURTHEST: f64 = 50.0;

/// Critical speed divided by the lowest speed of the scan.
const NEAREST: f64 = 20.0;

/// As [`FURTHEST`], for a lock. It is smaller because the contact forces of a lock grow with the
/// square of the speed.
const LOCK_FURTHEST: f64 = 10.0;

/// Ratio of neighbouring speeds of the scan. A narrower range can be missed.
const SCAN_RATIO: f64 = 1.03;

/// Relative difference up to which an end of the scan is replaced by that of the closed form for
/// rigid blades. With a larger one the effect of blades that bend would be lost.
const CLOSED_FORM: f64 = 2e-3;

/// Relative distance from a known end at which the condition is evaluated on both sides.
const BESIDE_AN_END: f64 = 1e-6;

/// Rotation of a side by its bent blades \[rad\], relative to the damping ratio, up to which the lock
/// counts as stable without a search. With a larger one a lock that flutters could count as stable.
const TURN_BESIDE_DAMPING: f64 = 0.1;

/// The corners of a machine that can hold a lock in one direction of rotation.
#[derive(Debug)]
pub struct Locks {
    /// Corners, and the speeds at which rigid blades push in each; `None` if one corner represents
    /// all.
    corners: Vec<(Locked, Option<Vec<LockWindow>>)>,
}

impl Locks {
    /// Finds the corners for a rotor that turns in the direction of the sign of `toward`. Empty
    /// without corners or clearance, on a lining, and with disk modes of other nodal diameters.
    #[must_use]
    pub fn new(machine: &Machine, toward: f64) -> Self {
        let locked = |corner| Locked::new(machine, corner, Form::Modal, true).ok();
        let corners = if machine.lining.is_some() {
            Vec::new()
        } else if machine.has_unequal_tips() {
            let of = |corner: &TipCorner| {
                let windows = machine.windows_of(corner, toward);
                let [a, b] = corner.sides;
                let locked = locked(Corner { a, b }).filter(|_| !windows.is_empty());
                Some((locked?, Some(windows)))
            };
            machine.tip_corners().iter().filter_map(of).collect()
        } else {
            let corner = Corner::paper(&machine.polygon).ok().and_then(locked);
            corner.into_iter().map(|locked| (locked, None)).collect()
        };
        Self { corners }
    }

    /// Returns the motions about the admissible locks at a speed \[rad/s\], stable or not.
    fn balanced(&self, speed: f64) -> impl Iterator<Item = Held> {
        let here = self.corners.iter().filter(move |(_, windows)| match windows {
            Some(windows) => windows.iter().any(|window| window.has(speed.abs())),
            None => true,
        });
        here.filter_map(move |(locked, _)| locked.admissible(speed))
    }

    /// Returns whether the bent blades rotate their sides by less than [`TURN_BESIDE_DAMPING`] times
    /// the damping ratios at the last speed of the search. This rotation is the only coupling of
    /// blades and casing for tips without slope.
    fn bend_little(&self, machine: &Machine, sense: f64) -> bool {
        let damping = machine.casing_damping_ratio.min(machine.blade_damping_ratio);
        let least = TURN_BESIDE_DAMPING * damping;
        let furthest = scale(machine).map(|scale| sense * scale * LOCK_FURTHEST);
        let turns = |point: LockedPoint| {
            let angles = point.alpha_rad.map(|alpha| machine.nodal_diameters * alpha.abs());
            angles[0].max(angles[1]) < least
        };
        let mut corners = self.corners.iter().take(1);
        furthest.is_some_and(|speed| corners.all(|(locked, _)| locked.at(speed).is_some_and(turns)))
    }

    /// Returns whether a lock holds at a rotor speed \[rad/s\].
    #[must_use]
    pub fn hold(&self, speed: f64) -> bool {
        self.balanced(speed).any(|motion| motion.growth().is_none())
    }

    /// Returns the growth rate of the unstable lock at a rotor speed \[1/s\]; `None` if a lock holds,
    /// or if none is admissible.
    #[must_use]
    pub fn growth(&self, speed: f64) -> Option<f64> {
        let growth = |motion: Held| motion.growth().filter(|growth| growth.is_finite());
        let each: Option<Vec<f64>> = self.balanced(speed).map(growth).collect();
        each?.into_iter().reduce(f64::min)
    }
}

/// Returns the growth rate of the admissible lock of a machine without a lining at a constant speed
/// \[1/s\]. `None` if it is stable, as with rigid blades, or if there is no such lock.
#[must_use]
pub fn lock_growth(machine: &Machine, speed: f64) -> Option<f64> {
    if machine.rigid_blades { None } else { Locks::new(machine, speed).growth(speed) }
}

/// As `lock_windows`; the ranges of [`flutters`] are computed only if the search needs them.
pub(super) fn lock_windows_beside<'a>(
    machine: &Machine,
    toward: f64,
    flutters: impl FnOnce() -> &'a [LockWindow],
) -> Vec<LockWindow> {
    let pushed = machine.lock_windows(toward);
    let known = machine.out_of_round() == 0.0 && !machine.has_unequal_tips() || !pushed.is_empty();
    let closed = machine.lining.is_some() || machine.rigid_blades;
    if closed || machine.out_of_round() != 0.0 || !known {
        return pushed;
    }
    let (locks, sense) = (Locks::new(machine, toward), 1_f64.copysign(toward));
    if machine.radial_coupling == 0.0 && locks.bend_little(machine, sense) {
        return pushed;
    }
    // If curvature has little effect, the lock is unstable exactly in the ranges of flutter.
    let ranges = pushed.iter().chain(flutters());
    let ends: Vec<f64> = ranges.flat_map(|range| [Some(range.from), range.to]).flatten().collect();
    windows(machine, LOCK_FURTHEST, &ends, |speed| locks.hold(sense * speed))
}

/// Returns every range of speeds with flutter: blades and casing in lasting contact (`B = 0`) have a
/// growing wave. The rotor turns in the direction of the sign of `toward`; ranges end where the
/// clearance closes. Empty without corners, with disk modes of other nodal diameters, and if the tips
/// do not couple blades and casing.
#[must_use]
pub fn flutters(machine: &Machine, toward: f64) -> Vec<LockWindow> {
    if !machine.polygon.has_corners() || machine.has_other_diameters() {
        return Vec::new();
    }
    let sense = 1_f64.copysign(toward);
    windows(machine, FURTHEST, &[], |speed| joined_grow(machine, sense * speed))
}

/// Returns the flutter speed without any damping, as a magnitude \[rad/s\]:
/// `Omega_f = sqrt[(1/m_c + c2/m_a)(k_c + k_a/c2)]/n_d`, which is never below the dangerous
/// coincidence. `None` without corners, with disk modes of other nodal diameters, if the tips do
/// not couple blades and casing, or if the lock never flutters. The sign of `toward` is the
/// direction of rotation.
#[must_use]
pub fn undamped_flutter_speed(machine: &Machine, toward: f64) -> Option<f64> {
    let rest = machine.at(0.0);
    let coupling = rest.coupling_product_at(toward);
    if !rest.polygon.has_corners() || rest.has_other_diameters() {
        return None;
    }
    // Infinite if the tips do not couple blades and casing.
    let compliance = 1.0 / rest.casing_mass + coupling / rest.blade_modal_mass;
    let square = compliance * (rest.casing_stiffness + rest.blade_modal_stiffness / coupling);
    // Blades that stiffen by B Omega^2 move the limit by the same share at every speed.
    let stiffer = compliance * rest.blade_modal_mass / coupling * machine.stiffening();
    let speed = (square / (machine.nodal_diameters * machine.nodal_diameters - stiffer)).sqrt();
    speed.is_finite().then_some(speed)
}

/// Returns whether blades and casing in lasting contact have a growing wave at a rotor speed
/// \[rad/s\].
#[must_use]
pub fn joined_grow(machine: &Machine, speed: f64) -> bool {
    Frame::at(machine, speed).joined().iter().any(|rate| rate.re > 0.0)
}

/// Returns the faster of critical speed and coincidence without stiffening \[rad/s\].
fn scale(machine: &Machine) -> Option<f64> {
    let coincidence = (machine.omega_c + machine.omega_bd_at_rest()) / machine.nodal_diameters;
    machine.critical_speed().map(|critical| critical.max(coincidence))
}

/// Returns the spans of speed in which a condition is true, up to `reach` times the faster of critical
/// speed and coincidence \[rad/s\]. `ends` are speeds at which the condition probably changes.
pub(super) fn windows(
    machine: &Machine,
    reach: f64,
    ends: &[f64],
    is_true: impl Fn(f64) -> bool,
) -> Vec<LockWindow> {
    let Some((critical, scale)) = machine.critical_speed().zip(scale(machine)) else {
        return Vec::new();
    };
    let known = ends.iter().copied().fold(0.0, f64::max);
    let [standstill, furthest] = [1e-6 * critical, (reach * scale).max(1.1 * known)];
    let closed = machine.closing_speed().filter(|_| machine.lining.is_none());
    let last = closed.map_or(furthest, |closed| closed.next_down().min(furthest));
    let mut places: Vec<f64> = geometric([critical / NEAREST, furthest], SCAN_RATIO).collect();
    let mut ends = ends.to_vec();
    ends.sort_by(f64::total_cmp);
    places.extend(ends.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
    let beside = [-CLOSED_FORM, -BESIDE_AN_END, BESIDE_AN_END, CLOSED_FORM];
    places.extend(ends.iter().flat_map(|end| beside.map(|part| end * (1.0 + part))));
    places.extend([standstill, last]);
    places.retain(|place| (standstill..=last).contains(place));
    places.sort_by(f64::total_cmp);
    let close = |end: f64| {
        let known = ends.iter().find(|known| (end - **known).abs() <= CLOSED_FORM * end);
        known.copied().unwrap_or(end)
    };
    let window = |[from, to]: [f64; 2]| LockWindow {
        from: if from == standstill { 0.0 } else { close(from) },
        to: if to == last { closed.filter(|closed| *closed < furthest) } else { Some(close(to)) },
    };
    spans(&places, is_true).into_iter().map(window).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{BladedDisk, Casing};

    #[test]
    fn only_blades_with_corners_and_the_diameters_of_the_casing_flutter() {
        for (casing, nodal_diameters) in [(3, 0), (3, 3), (3, 4), (11, 0)] {
            let radial_coupling = 0.3;
            let disk = BladedDisk { nodal_diameters, radial_coupling, ..BladedDisk::default() };
            let machine = Machine::new(&disk, &Casing::default(), casing);
            let flutters = casing == 3 && nodal_diameters != 4;
            assert_eq!(!super::flutters(&machine, 1.0).is_empty(), flutters);
            assert_eq!(undamped_flutter_speed(&machine, 1.0).is_some(), flutters);
        }
    }
}
