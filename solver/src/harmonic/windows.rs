//! Ranges of rotor speed in which a lock holds, and in which it flutters (docs/theory.md, sections
//! 4 and 10): spans of a condition of the speed, found by one scan and bisection.
//!
//! A lock **holds** where it is admissible (both groups only push, every other gap is open) and
//! stable (no motion that keeps the contact grows, with the curvature of the pushes). [`Locks::hold`]
//! is that condition; `hbm`, `margins`, `survey`, `check`, runs and the screen ask it.
//!
//! The scan has a point every 3 % from a twentieth of the critical speed to ten times (a lock) or
//! fifty times the faster of critical speed and coincidence, and every end of the closed form for
//! rigid blades (`Machine::lock_windows`) with the middles between them. Where blades do not bend,
//! the ends found are those of the closed form to two thousandths; then the closed form is returned.
//! It is not even searched if tips without slope bend so little up to the last speed that damping
//! decides.

use super::stability::Kept;
use super::{Corner, Form, Locked, LockedPoint};
use crate::model::{Frame, LockWindow, Machine, TipCorner};
use crate::numeric::search::{geometric, spans};

/// Whirl and flutter are searched up to this many times the faster of critical speed and
/// coincidence. Beyond, no rotor turns.
pub(super) const FURTHEST: f64 = 50.0;

/// Speeds are searched from the critical speed divided by this.
const NEAREST: f64 = 20.0;

/// The same of a lock, whose pushes grow with the square of the speed.
const LOCK_FURTHEST: f64 = 10.0;

/// Ratio of neighbouring speeds of a search. Larger: a range narrower than this is stepped over.
const SCAN_RATIO: f64 = 1.03;

/// Part of a lock speed up to which it is that of rigid blades in closed form: the slope of the gap
/// beside the middle of a side makes a thousandth. Larger: blades that bend are said not to.
const CLOSED_FORM: f64 = 2e-3;

/// Part of a speed beside a known end at which a condition is asked.
const BESIDE_AN_END: f64 = 1e-6;

/// Turn of a side by its bent blades \[rad\], as a part of the damping ratio, up to which it makes no
/// motion grow. Larger: a lock that flutters is said to hold; smaller: only more is searched.
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

    /// Returns the motions about the locks that pushes balance at a speed \[rad/s\], stable or not.
    fn balanced(&self, speed: f64) -> impl Iterator<Item = Kept> {
        let here = self.corners.iter().filter(move |(_, windows)| match windows {
            Some(windows) => windows.iter().any(|window| window.has(speed.abs())),
            None => true,
        });
        here.filter_map(move |(locked, _)| locked.admissible(speed))
    }

    /// Returns whether the blades turn their sides by a small part of the damping ratios, up to the
    /// last speed of the search. Tips without slope couple blades and casing by that turn alone.
    fn bend_little(&self, machine: &Machine, sense: f64) -> bool {
        let damping = machine.casing_damping_ratio.min(machine.blade_damping_ratio);
        let least = TURN_BESIDE_DAMPING * damping;
        let furthest = scale(machine).map(|scale| sense * scale * LOCK_FURTHEST);
        let turns = |point: LockedPoint| {
            let angles = point.alpha_rad.map(|alpha| machine.nodal_diameters * alpha.abs());
            angles[0].max(angles[1]) < least
        };
        let mut corners = self.corners.iter().take(1);
        furthest.is_some_and(|speed| corners.all(|(locked, _)| locked.at(speed).is_ok_and(turns)))
    }

    /// Returns whether a lock holds at a rotor speed \[rad/s\].
    #[must_use]
    pub fn hold(&self, speed: f64) -> bool {
        self.balanced(speed).any(|motion| motion.growth().is_none())
    }

    /// Returns the growth rate of the lock that pushes balance at a rotor speed \[1/s\]; `None` if one
    /// holds, or if pushes balance none.
    #[must_use]
    pub fn growth(&self, speed: f64) -> Option<f64> {
        let growth = |motion: Kept| motion.growth().filter(|growth| growth.is_finite());
        let each: Option<Vec<f64>> = self.balanced(speed).map(growth).collect();
        each?.into_iter().reduce(f64::min)
    }
}

/// Returns the growth rate of a lock that is held by pushes at a constant speed, without a lining
/// \[1/s\]. `None` if it is stable, or if there is no such lock.
#[must_use]
pub fn lock_growth(machine: &Machine, speed: f64) -> Option<f64> {
    Locks::new(machine, speed).growth(speed)
}

/// Returns every window of speeds in which a lock holds, as `lock_windows`; the ranges of
/// [`flutters`] are asked for only where a search needs them.
pub(super) fn lock_windows_beside<'a>(
    machine: &Machine,
    toward: f64,
    flutters: impl FnOnce() -> &'a [LockWindow],
) -> Vec<LockWindow> {
    let pushed = machine.lock_windows(toward);
    let known = machine.out_of_round() == 0.0 && !machine.has_unequal_tips() || !pushed.is_empty();
    if machine.lining.is_some() || machine.out_of_round() != 0.0 || !known {
        return pushed;
    }
    let (locks, sense) = (Locks::new(machine, toward), 1_f64.copysign(toward));
    if machine.radial_coupling == 0.0 && locks.bend_little(machine, sense) {
        return pushed;
    }
    // Where curvature does little, a lock grows where blades and casing as one do.
    let ranges = pushed.iter().chain(flutters());
    let ends: Vec<f64> = ranges.flat_map(|range| [Some(range.from), range.to]).flatten().collect();
    windows(machine, LOCK_FURTHEST, &ends, |speed| locks.hold(sense * speed))
}

/// Returns every range of speeds in which blades and casing that move as one grow, `B = 0`: waves of
/// any amplitude whose contact lasts do. For a rotor that turns in the direction of the sign of
/// `toward`, before the clearance closes. Empty without corners, with disk modes of other nodal
/// diameters, and if the tips do not couple blades and casing.
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
    if coupling == 0.0 || !rest.polygon.has_corners() || rest.has_other_diameters() {
        return None;
    }
    let compliance = 1.0 / rest.casing_mass + coupling / rest.blade_modal_mass;
    let square = compliance * (rest.casing_stiffness + rest.blade_modal_stiffness / coupling);
    // Blades that stiffen by B Omega^2 move the limit by the same share at every speed.
    let stiffer = compliance * rest.blade_modal_mass / coupling * machine.stiffening();
    let speed = (square / (machine.nodal_diameters * machine.nodal_diameters - stiffer)).sqrt();
    speed.is_finite().then_some(speed)
}

/// Returns whether blades and casing that move as one grow at a rotor speed \[rad/s\].
#[must_use]
pub fn joined_grow(machine: &Machine, speed: f64) -> bool {
    Frame::at(machine, speed).joined().iter().any(|rate| rate.re > 0.0)
}

/// Returns the faster of critical speed and coincidence without stiffening \[rad/s\].
fn scale(machine: &Machine) -> Option<f64> {
    let coincidence = (machine.omega_c + machine.omega_bd_at_rest()) / machine.nodal_diameters;
    machine.critical_speed().map(|critical| critical.max(coincidence))
}

/// Returns the spans of a condition of the speed, which `ends` may bound \[rad/s\], up to `reach` times
/// the faster of critical speed and coincidence.
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
