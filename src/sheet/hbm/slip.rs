//! The view `--slip`: steady slip, and the speeds at which it exists.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::speed;
use crate::sheet::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{SlipLimit, SlipOrbit, SlipPoint, slip_limits, slip_over};
use rubscope_solver::scene::SceneError;

pub const SLIP: View =
    View::new("slip", "View: lasting slip, a fixed point of the map from corner to corner", fill);

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { machine, speeds, .. } = request;
    let points = slip_over(machine, speeds)?;
    let limits = slip_limits(machine, speeds)?;
    let title = heading(&points, &limits);
    let limits: Vec<f64> = limits.iter().map(|limit| limit.speed_rad_s).collect();
    sheet.fact("slip_limits_rad_s", limits);
    sheet.table("points", title, Table::of(points, SLIPS).shown(8));
    sheet.chart("speed of the wave [rad/s]", &[["wave_speed_rad_s", "wave"]]);
    sheet.chart("smallest push [N]", &[["least_push_n", "push"]]);
    Ok(())
}

fn heading(points: &[SlipPoint], limits: &[SlipLimit]) -> String {
    let change = |limit: &SlipLimit| {
        let change = if limit.appears { "appears" } else { "vanishes" };
        format!("{change} at {}", speed(limit.speed_rad_s))
    };
    let changes: Vec<String> = limits.iter().map(change).collect();
    let found = points.iter().filter(|point| point.exists()).count();
    let mut reasons: Vec<&str> =
        points.iter().filter_map(|point| point.outcome.err()).map(Into::into).collect();
    reasons.dedup();
    let exists = format!("Slip exists at {found} of {} speeds", points.len());
    match changes.is_empty() {
        true if found == 0 => format!("{exists}: {}.", reasons.join(", ")),
        true => format!("{exists}."),
        false => format!("Slip {}.", changes.join(", ")),
    }
}

/// Columns of slip. Where none exists, all but the first two are empty.
const SLIPS: &[Column<'_, SlipPoint>] = &[
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
    ("speed_after_corner_m_s", |point| of_slip(point, |orbit| orbit.speed_after_corner_m_s)),
    ("speed_before_corner_m_s", |point| of_slip(point, |orbit| orbit.speed_before_corner_m_s)),
    ("corner_impulse_ns", |point| of_slip(point, |orbit| orbit.corner_impulse_ns)),
    ("damper_power_w", |point| of_slip(point, |orbit| orbit.damper_power_w)),
    ("corner_power_w", |point| of_slip(point, |orbit| orbit.corner_power_w)),
];

fn of_slip(point: &SlipPoint, figure: fn(SlipOrbit) -> f64) -> TableCell {
    point.outcome.ok().map(figure).into()
}
