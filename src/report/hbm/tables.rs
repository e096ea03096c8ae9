//! Tables of the frequency domain: short ones to read, and complete ones for
//! files. Each column is a name, with its unit, and what it shows.

use std::io::Error;
use std::rc::Rc;

use crate::report::table::MadeTable;
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{
    Branches, Campbell, Equilibrium, ExcitedLock, ExcitedLocks, Kind, LockedPoint, SlipOrbit,
    SlipPoint, SlipRegion, Sweep,
};

/// One word for a point: that of its character, or locked.
fn state(point: &LockedPoint) -> TableCell {
    if point.stable { "locked" } else { point.character.as_ref() }.into()
}

/// Columns of the locked motion to read.
const SUMMARY: &[Column<'_, LockedPoint>] = &[
    ("speed [rad/s]", |point| point.speed_rad_s.into()),
    ("multiplier a [N]", |point| point.multipliers_n[0].into()),
    ("multiplier b [N]", |point| point.multipliers_n[1].into()),
    ("alpha a [rad]", |point| point.alpha_rad[0].into()),
    ("amplitude [m]", |point| point.amplitude_m.into()),
    ("power [W]", |point| point.power_w.into()),
    ("state", state),
];

/// Columns of the locked motion with every number.
const LOCKED: &[Column<'_, LockedPoint>] = &[
    ("speed_rad_s", |point| point.speed_rad_s.into()),
    ("multiplier_a_n", |point| point.multipliers_n[0].into()),
    ("multiplier_b_n", |point| point.multipliers_n[1].into()),
    ("alpha_a_rad", |point| point.alpha_rad[0].into()),
    ("alpha_b_rad", |point| point.alpha_rad[1].into()),
    ("u_cc_m", |point| point.u_cc_m.into()),
    ("u_cs_m", |point| point.u_cs_m.into()),
    ("u_sc_m", |point| point.u_sc_m.into()),
    ("u_ss_m", |point| point.u_ss_m.into()),
    ("amplitude_m", |point| point.amplitude_m.into()),
    ("smallest_gap_m", |point| point.smallest_gap_m.into()),
    ("torque_nm", |point| point.torque_nm.into()),
    ("power_w", |point| point.power_w.into()),
    ("character", |point| point.character.as_ref().into()),
    ("admissible", |point| point.admissible.into()),
    ("stable", |point| point.stable.into()),
    ("residual", |point| point.residual.into()),
];

/// The locked motion: a short table to read, and every number for files.
#[must_use]
pub fn locked_tables(sweep: &Rc<Sweep>) -> [MadeTable; 2] {
    [SUMMARY, LOCKED].map(|columns| {
        let (count, sweep) = (sweep.points.len(), Rc::clone(sweep));
        MadeTable::of(columns, [count; 2], move |place| {
            Ok(sweep.points.get(place).copied().into_iter().collect())
        })
    })
}

/// The speeds where branches appear, vanish or change.
#[must_use]
pub fn threshold_table(branches: &Branches) -> Table {
    Table::of(
        &branches.thresholds,
        &[
            ("speed_rad_s", |threshold| threshold.speed_rad_s.into()),
            ("state", |threshold| threshold.kind.as_ref().into()),
            ("below", |threshold| threshold.below.as_ref().into()),
            ("above", |threshold| threshold.above.as_ref().into()),
        ],
    )
}

fn multiplier(state: &Equilibrium, index: usize) -> TableCell {
    state.contacts.get(index).map(|contact| contact.multiplier_n).into()
}

/// Columns of equilibria.
const BRANCHES: &[Column<'_, Equilibrium>] = &[
    ("speed_rad_s", |state| state.speed_rad_s.into()),
    ("state", |state| state.kind.as_ref().into()),
    ("character", |state| state.character.as_ref().into()),
    ("multiplier_a_n", |state| multiplier(state, 0)),
    ("multiplier_b_n", |state| multiplier(state, 1)),
    ("amplitude_m", |state| state.amplitude_m.into()),
    // At rest nothing is driven.
    ("power_w", |state| (state.kind != Kind::Rest).then_some(state.power_w).into()),
    ("growth_per_s", |state| growth(state).into()),
];

/// Every equilibrium, one per row.
#[must_use]
pub fn branch_table(branches: &Rc<Branches>) -> MadeTable {
    let counts = [branches.speeds(), branches.count];
    let branches = Rc::clone(branches);
    MadeTable::of(BRANCHES, counts, move |place| branches.states_at(place).map_err(Error::other))
}

/// Growth rate to read: 0 for an undamped motion, which grows or decays only by
/// round-off.
fn growth(state: &Equilibrium) -> f64 {
    let fastest = state.eigenvalues_per_s.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if state.growth_per_s.abs() > 1e-13 * fastest { state.growth_per_s } else { 0.0 }
}

/// Columns of slip.
const SLIP: &[Column<'_, SlipPoint>] = &[
    ("speed_rad_s", |point| point.speed_rad_s.into()),
    ("slip", |point| match point.outcome {
        Ok(_) if point.stable() => "stable".into(),
        Ok(_) => "unstable".into(),
        Err(reason) => <&str>::from(reason).into(),
    }),
    ("wave_speed_rad_s", |point| of_slip(point, |orbit| orbit.wave_speed_rad_s)),
    ("period_s", |point| of_slip(point, |orbit| orbit.period_s)),
    ("slope", |point| of_slip(point, |orbit| orbit.slope)),
    ("least_push_n", |point| of_slip(point, |orbit| orbit.least_push_n)),
    ("torque_nm", |point| of_slip(point, |orbit| orbit.torque_nm)),
    ("power_w", |point| of_slip(point, |orbit| orbit.power_w)),
];

fn of_slip(point: &SlipPoint, figure: fn(SlipOrbit) -> f64) -> TableCell {
    point.outcome.ok().map(figure).into()
}

/// Slip over speed, one row per speed.
#[must_use]
pub fn slip_table(points: &Rc<Vec<SlipPoint>>) -> MadeTable {
    MadeTable::over(SLIP, points)
}

/// Where there is slip, a row for each damping ratio.
#[must_use]
pub fn region_table(regions: &[SlipRegion]) -> Table {
    fn first(region: &SlipRegion, appears: bool) -> TableCell {
        let found = region.limits.iter().find(|limit| limit.appears == appears);
        found.map(|limit| limit.speed_rad_s).into()
    }
    Table::of(
        regions,
        &[
            ("casing_damping_ratio", |region| region.casing_damping_ratio.into()),
            ("slip", |region| match (region.limits.is_empty(), region.exists_at_lowest) {
                (true, true) => "everywhere".into(),
                (true, false) => "nowhere".into(),
                (false, _) => "in part".into(),
            }),
            ("appears_rad_s", |region| first(region, true)),
            ("vanishes_rad_s", |region| first(region, false)),
        ],
    )
}

/// The Campbell lines over speed, one per column.
#[must_use]
pub fn campbell_table(campbell: &Campbell, speeds: &Rc<Vec<f64>>) -> MadeTable {
    let names = campbell.lines.iter().map(|line| line.name.clone());
    let names = std::iter::once("speed_rad_s".to_string()).chain(names).collect();
    let (lines, count, speeds) = (campbell.lines.clone(), speeds.len(), Rc::clone(speeds));
    MadeTable::named(names, count, move |place| {
        let row = |&speed: &f64| {
            let lines = lines.iter().map(|line| line.at(speed));
            std::iter::once(speed).chain(lines).map(TableCell::from).collect()
        };
        speeds.get(place).map(row).unwrap_or_default()
    })
}

/// The coincidences of Eq. (30).
#[must_use]
pub fn coincidence_table(campbell: &Campbell) -> Table {
    Table::of(
        &campbell.coincidences,
        &[
            ("speed_rad_s", |found| found.speed_rad_s.into()),
            ("casing_rad_s", |found| found.casing_rad_s.into()),
            ("blades_rad_s", |found| found.blades_rad_s.into()),
            ("dangerous", |found| if found.dangerous { "yes" } else { "no" }.into()),
        ],
    )
}

/// Columns of the response to an engine order.
const EXCITED: &[Column<'_, ExcitedLock>] = &[
    ("speed_rad_s", |lock| lock.state.speed_rad_s.into()),
    ("frequency_rad_s", |lock| lock.frequency_rad_s.into()),
    ("alpha_c_rad", |lock| lock.response[2].norm().into()),
    ("casing_m", |lock| lock.casing_m().into()),
    ("change_of_amplitude", |lock| lock.relative_amplitude.into()),
    ("change_of_multiplier", |lock| lock.relative_multiplier.into()),
    ("release_torque_nm", |lock| lock.release_torque_nm.into()),
    ("state", |lock| lock.state.character.as_ref().into()),
];

/// The response to an engine order, a row for each speed.
#[must_use]
pub fn excitation_table(found: &Rc<ExcitedLocks>) -> MadeTable {
    let (counts, found) = ([found.places(), found.count], Rc::clone(found));
    MadeTable::of(EXCITED, counts, move |place| {
        Ok(found.lock_at(place).map_err(Error::other)?.into_iter().collect())
    })
}
