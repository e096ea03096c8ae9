//! The locked motion against speed: JSON points, a short table for people and
//! the table with every figure.

use serde::Serialize;

use crate::harmonic::{LockedPoint, Sweep};
use crate::model::Rim;
use crate::report::table::Table;

#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    speed_rad_s: f64,
    groups: [Group; 2],
    u_cc_m: f64,
    u_cs_m: f64,
    u_sc_m: f64,
    u_ss_m: f64,
    amplitude_m: f64,
    smallest_gap_m: f64,
    torque_nm: f64,
    power_w: f64,
    admissible: bool,
    stable: bool,
    residual: f64,
}

#[derive(Clone, Debug, Serialize)]
struct Group {
    blades: Vec<u32>,
    multiplier_n: f64,
    alpha_rad: f64,
}

impl Point {
    fn of(point: &LockedPoint, blades: &[Vec<u32>; 2]) -> Self {
        let [a, b] = blades;
        let [lambda_a, lambda_b] = point.multipliers;
        let [alpha_a, alpha_b] = point.alpha;
        let group = |blades: &Vec<u32>, multiplier_n, alpha_rad| Group {
            blades: blades.clone(),
            multiplier_n,
            alpha_rad,
        };
        Self {
            speed_rad_s: point.speed,
            groups: [group(a, lambda_a, alpha_a), group(b, lambda_b, alpha_b)],
            u_cc_m: point.u_cc,
            u_cs_m: point.u_cs,
            u_sc_m: point.u_sc,
            u_ss_m: point.u_ss,
            amplitude_m: point.amplitude(),
            smallest_gap_m: point.smallest_gap,
            torque_nm: point.torque,
            power_w: point.power,
            admissible: point.admissible,
            stable: point.stable,
            residual: point.residual,
        }
    }
}

/// One word for a point: locked, pulls, penetrates or unstable.
fn state(point: &LockedPoint) -> &'static str {
    if point.stable && point.admissible {
        "locked"
    } else if point.multipliers.iter().any(|&multiplier| multiplier > 0.0) {
        "pulls"
    } else if !point.admissible {
        "penetrates"
    } else {
        "unstable"
    }
}

/// The locked motion as a short table for people.
#[must_use]
pub fn summary_table(sweep: &Sweep) -> Table {
    let mut table = Table::new(&[
        "speed [rad/s]",
        "multiplier a [N]",
        "multiplier b [N]",
        "alpha a [rad]",
        "amplitude [m]",
        "power [W]",
        "state",
    ]);
    for point in &sweep.points {
        let [lambda_a, lambda_b] = point.multipliers;
        table.push(vec![
            point.speed.into(),
            lambda_a.into(),
            lambda_b.into(),
            point.alpha[0].into(),
            point.amplitude().into(),
            point.power.into(),
            state(point).into(),
        ]);
    }
    table
}

/// The locked motion with every figure, for files.
#[must_use]
pub fn locked_table(sweep: &Sweep) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "multiplier_a_n",
        "multiplier_b_n",
        "alpha_a_rad",
        "alpha_b_rad",
        "u_cc_m",
        "u_cs_m",
        "u_sc_m",
        "u_ss_m",
        "amplitude_m",
        "smallest_gap_m",
        "torque_nm",
        "power_w",
        "admissible",
        "stable",
        "residual",
    ]);
    for point in &sweep.points {
        let [lambda_a, lambda_b] = point.multipliers;
        let [alpha_a, alpha_b] = point.alpha;
        table.push(vec![
            point.speed.into(),
            lambda_a.into(),
            lambda_b.into(),
            alpha_a.into(),
            alpha_b.into(),
            point.u_cc.into(),
            point.u_cs.into(),
            point.u_sc.into(),
            point.u_ss.into(),
            point.amplitude().into(),
            point.smallest_gap.into(),
            point.torque.into(),
            point.power.into(),
            point.admissible.into(),
            point.stable.into(),
            point.residual.into(),
        ]);
    }
    table
}

/// The points of a sweep, with the blades of both groups.
pub(super) fn points(rim: &Rim, sweep: &Sweep) -> Vec<Point> {
    let blades = sweep.corner.sides().map(|side| rim.blades_of_side(side));
    sweep.points.iter().map(|point| Point::of(point, &blades)).collect()
}
