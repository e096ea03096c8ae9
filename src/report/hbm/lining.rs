//! Tables and JSON of blades on a lining, and of a coincidence against speed.

use std::rc::Rc;

use serde_json::{Value, json};

use super::parts::Parts;
use crate::report::table::MadeTable;
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{
    CoincidencePoint, Cycle, GrowthThreshold, HopfPoint, LeastStiffness, LiningState, Rest,
};
use rubscope_solver::model::LockWindow;

/// All of one lining against speed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiningReport {
    /// Depth to which blades are pressed in at rest; negative with a clearance \[m\].
    pub preload_m: f64,
    /// Stiffness of all blades at rest, `S0` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// The coincidence that the lining shifts \[rad/s\].
    pub shifted_rad_s: Option<f64>,
    /// The least lining that makes rest grow.
    pub threshold: Option<GrowthThreshold>,
    /// Where rest begins and ends to grow.
    pub hopf: Vec<HopfPoint>,
    /// Rest at each speed, and whether waves far out stay bounded.
    pub rest: Vec<(Rest, bool)>,
    /// Waves of constant amplitude.
    pub cycles: Vec<Cycle>,
    /// Speeds between which it holds a lock \[rad/s\].
    pub window: Option<LockWindow>,
    /// The softest lining that holds one.
    pub least: Option<LeastStiffness>,
    /// Waves that stand in the frame of the blades.
    pub states: Vec<LiningState>,
}

impl LiningReport {
    /// As JSON.
    #[must_use]
    pub fn json(&self) -> Value {
        let rest = self.rest.iter().map(|(rest, bounded)| {
            let worst = rest.worst();
            json!({
                "speed_rad_s": rest.speed_rad_s,
                "growth_1_s": worst.growth_1_s,
                "s_rad_s": worst.s_rad_s,
                "omega_rad_s": worst.omega_rad_s,
                "grows": rest.grows,
                "bounded": bounded,
            })
        });
        json!({
            "preload_m": self.preload_m,
            "stiffness_at_rest_n_per_m": self.stiffness_n_per_m,
            "shifted_coincidence_rad_s": self.shifted_rad_s,
            "threshold_n_per_m": self.threshold.map(|least| least.stiffness_n_per_m),
            "threshold_rad_s": self.threshold.map(|least| least.speed_rad_s),
            "hopf": self.hopf,
            "rest": rest.collect::<Value>(),
            "cycles": self.cycles,
            "lock_from_rad_s": self.window.map(|window| window.from),
            "lock_to_rad_s": self.window.and_then(|window| window.to),
            "least_stiffness_n_per_m": self.least.map(|least| least.stiffness_n_per_m),
            "least_stiffness_rad_s": self.least.map(|least| least.speed_rad_s),
            "states": self.states,
        })
    }
}

/// Rest under preload, a row for each speed, with the cycle that it grows into.
#[must_use]
pub fn rest_table(rest: &[(Rest, bool)], cycles: &[Cycle]) -> Table {
    let rows: Vec<_> = rest
        .iter()
        .map(|(rest, bounded)| {
            let here = |cycle: &&Cycle| cycle.stable && cycle.speed_rad_s == rest.speed_rad_s;
            (rest, *bounded, cycles.iter().find(here))
        })
        .collect();
    Table::of(
        &rows,
        &[
            ("speed_rad_s", |row| row.0.speed_rad_s.into()),
            ("growth_1_s", |row| row.0.worst().growth_1_s.into()),
            ("s_rad_s", |row| row.0.worst().s_rad_s.into()),
            ("omega_rad_s", |row| row.0.worst().omega_rad_s.into()),
            ("cycle_omega_rad_s", |row| row.2.map(|cycle| cycle.omega_rad_s).into()),
            ("gap_amplitude_m", |row| row.2.map(|cycle| cycle.gap_amplitude_m).into()),
            ("casing_m", |row| row.2.map(|cycle| cycle.casing_m).into()),
            ("blade_rad", |row| row.2.map(|cycle| cycle.blade_rad).into()),
            ("rest", |row| {
                match (row.0.grows, row.2, row.1) {
                    (false, None, _) => "decays",
                    (false, Some(_), _) => "decays, a wave lasts",
                    (true, Some(_), _) => "grows to a wave",
                    (true, None, true) => "grows",
                    (true, None, false) => "grows without bound",
                }
                .into()
            }),
        ],
    )
}

/// Waves of constant amplitude, one per row.
#[must_use]
pub fn cycle_table(cycles: &[Cycle]) -> Table {
    Table::of(
        cycles,
        &[
            ("speed_rad_s", |cycle| cycle.speed_rad_s.into()),
            ("omega_rad_s", |cycle| cycle.omega_rad_s.into()),
            ("s_rad_s", |cycle| cycle.s_rad_s.into()),
            ("gap_amplitude_m", |cycle| cycle.gap_amplitude_m.into()),
            ("casing_m", |cycle| cycle.casing_m.into()),
            ("blade_rad", |cycle| cycle.blade_rad.into()),
            ("growth_1_s", |cycle| cycle.growth_1_s.into()),
            ("character", |cycle| word(cycle.stable).into()),
        ],
    )
}

fn word(stable: bool) -> &'static str {
    if stable { "stable" } else { "unstable" }
}

fn push(state: &LiningState, place: usize) -> TableCell {
    state.pushes.get(place).map(|push| push.push_n).into()
}

/// Waves that stand in the frame of the blades, one per row.
#[must_use]
pub fn state_table(states: &[LiningState]) -> Table {
    Table::of(
        states,
        &[
            ("speed_rad_s", |state| state.speed_rad_s.into()),
            ("pushing", |state| (state.pushing as f64).into()),
            ("push_a_n", |state| push(state, 0)),
            ("push_b_n", |state| push(state, 1)),
            ("push_c_n", |state| push(state, 2)),
            ("casing_m", |state| state.casing_m.into()),
            ("blade_rad", |state| state.blade_rad.into()),
            ("growth_1_s", |state| state.growth_1_s.into()),
            ("character", |state| word(state.stable).into()),
        ],
    )
}

/// Columns of a coincidence against speed.
const CURVE: &[Column<'_, CoincidencePoint>] = &[
    ("speed_rad_s", |point| point.speed_rad_s.into()),
    ("growth_1_s", |point| point.growth_1_s.into()),
    ("blade_amplitude_rad", |point| point.blade_amplitude_rad.into()),
    ("casing_amplitude_m", |point| point.casing_amplitude_m.into()),
    ("omega_rad_s", |point| point.omega_rad_s.into()),
    ("bounded", |point| point.bounded.into()),
];

/// A coincidence against speed.
#[must_use]
pub fn curve_table(points: &Rc<Vec<CoincidencePoint>>) -> MadeTable {
    MadeTable::over(CURVE, points)
}

/// A coincidence in JSON: both speeds of Eq. (30), the one that a lining shifts, and the
/// points.
#[must_use]
pub fn curve(markers: &[f64], shifted: Option<f64>, points: &Rc<Vec<CoincidencePoint>>) -> Parts {
    Parts::default()
        .with_whole("markers_rad_s", markers)
        .with_whole("shifted_rad_s", shifted)
        .with_rows("points", points, |point| json!(point))
}
