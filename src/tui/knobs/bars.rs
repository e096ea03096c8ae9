//! The ranges of bars that are computed from the scene.

use super::range::{AROUND, Case, KnobRange};
use rubscope_solver::harmonic::lock_window;
use rubscope_solver::model::Initial;
use rubscope_solver::study::margins::grazing_pulse;
use std::f64::consts::TAU;

/// The largest interference on the bar, relative to the largest clearance. It is not 1, so that
/// zero lies between two cells of a map.
const PRESSED: f64 = 0.9;
/// The smallest pulse that makes a blade touch is sought in this many periods of the casing.
const PERIODS: f64 = 20.0;
/// Upper end of the speed bar, as a multiple of the highest of critical speed, lock speed and
/// coincidence.
const BEYOND: f64 = 1.5;

pub fn speed(case: &Case) -> KnobRange {
    let machine = case.machine;
    let window = lock_window(machine, case.value);
    let lock = window.map(|window| window.from);
    let limits = [machine.critical_speed(), lock, machine.dangerous_speed()];
    // Without a coupling nothing drives the coincidence.
    let driven = limits[2].filter(|_| case.scene.is_coupled());
    let most = limits.into_iter().flatten().fold(0.0, f64::max);
    let most = if most > 0.0 { most } else { machine.omega_c };
    KnobRange::linear(0.0, BEYOND * most).signed(case.value).marked(&[
        ("the adhesive limit", machine.adhesive_speed()),
        ("the end of the lock", window.and_then(|window| window.to)),
        ("the coincidence", driven),
        ("Ω_c", limits[0]),
        ("Ω_lock", limits[1]),
    ])
}

pub fn ramp(case: &Case) -> KnobRange {
    let turn = case.scene.operation.speed_rad_s.abs().max(1.0) / case.scene.solver.end_s;
    let usual = if case.opened == 0.0 { turn } else { case.opened.abs() };
    KnobRange::log(usual / AROUND, usual * AROUND).signed(case.value)
}

pub fn pulse(case: &Case) -> KnobRange {
    let mut scene = case.scene.clone();
    // Later passes of a blade come only slightly closer.
    scene.solver.end_s = scene.solver.end_s.min(PERIODS * TAU / case.machine.omega_c);
    let touch = grazing_pulse(&scene, f64::MAX.copysign(case.value));
    let middle = touch.map_or_else(|| case.usual(), f64::abs);
    let range = KnobRange::log(middle / 30.0, middle * 3000.0);
    range.signed(case.value).marked(&[("the first touch", touch.map(f64::abs))])
}

pub fn diameters(least: f64, case: &Case) -> KnobRange {
    KnobRange::linear(least, (case.blades() / 2.0).floor().max(2.0))
}

pub fn order(case: &Case) -> KnobRange {
    KnobRange::linear(1.0, case.blades().max(2.0))
}

/// Few casings have more than eight lobes.
pub fn lobes(case: &Case) -> KnobRange {
    KnobRange::linear(0.0, (2.0 * case.usual()).max(8.0))
}

pub fn blade_length(case: &Case) -> KnobRange {
    let (radius, room) = (case.scene.casing.radius_m, 4.0 * case.clearance());
    let most = if case.has_lining() { radius + PRESSED * room } else { radius };
    KnobRange::linear(radius - room, most)
}

pub fn casing_radius(case: &Case) -> KnobRange {
    let (length, room) = (case.scene.bladed_disk.blade_length_m, 4.0 * case.clearance());
    let least = if case.has_lining() { length - PRESSED * room } else { length };
    KnobRange::linear(least, length + room)
}

pub fn clearance(case: &Case) -> KnobRange {
    let most = 0.5 * AROUND * case.usual();
    match case.has_lining() {
        true => KnobRange::linear(-PRESSED * most, most),
        false => case.around(),
    }
}

pub fn position(case: &Case) -> KnobRange {
    let Initial { u_c_m, u_s_m, .. } = case.scene.initial;
    let across = u_c_m * u_c_m + u_s_m * u_s_m - case.value * case.value;
    let most = (case.clearance().powi(2) - across).max(0.0).sqrt().max(case.value.abs());
    KnobRange::linear(-most, most)
}

pub fn growth(case: &Case) -> KnobRange {
    let usual = 0.1 * case.clearance() / case.scene.fastest_rad_s().max(1.0).powi(2);
    let usual = if case.opened == 0.0 { usual } else { case.opened };
    KnobRange::log(0.1 * usual, usual)
}

pub fn velocity(case: &Case) -> KnobRange {
    let most = 2.0 * case.clearance() * case.machine.omega_c;
    KnobRange::linear(-most, most)
}
