//! The view `--slip`: lasting slip, and the speeds at which it exists.

use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View};
use crate::report::number::speed;
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{
    HarmonicError, SlipLimit, SlipOrbit, SlipPoint, slip_limits, slip_over,
};

pub const SLIP: View = View {
    option: "slip",
    help: "View: lasting slip, the fixed point of the map from corner to corner",
    always_damped: true,
    one_speed: false,
    lock: LockBeside::Rigid(|_| false),
    answer,
};

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let Request { machine, speeds, .. } = request;
    let points = slip_over(machine, speeds)?;
    let limits = slip_limits(machine, speeds)?;
    let title = heading(&points, &limits);
    let limits: Vec<f64> = limits.iter().map(|limit| limit.speed_rad_s).collect();
    let json = Parts::default().with_rows("slip", &points, value).with("slip_limits_rad_s", limits);
    Ok(Answer::of(json, vec![(title, Table::of(&points, SLIPS))]))
}

fn heading(points: &[SlipPoint], limits: &[SlipLimit]) -> String {
    let changes: Vec<String> = limits
        .iter()
        .map(|limit| {
            let change = if limit.appears { "appears" } else { "vanishes" };
            format!("{change} at {}", speed(limit.speed_rad_s))
        })
        .collect();
    let found = points.iter().filter(|point| point.exists()).count();
    match (changes.is_empty(), found) {
        (false, _) => format!("Slip {}.", changes.join(", ")),
        (true, 0) => "There is no slip at any of these speeds.".to_string(),
        (true, all) if all == points.len() => "Slip exists at all of these speeds.".to_string(),
        (true, _) => "Slip exists at some of these speeds.".to_string(),
    }
}

/// Returns the slip at one speed as JSON, with `null` for a value that does not exist.
fn value(point: &SlipPoint) -> Value {
    let mut value = json!({
        "speed_rad_s": point.speed_rad_s,
        "exists": point.exists(),
        "stable": point.stable(),
        "reason": point.outcome.err(),
    });
    let orbit = json!(point.outcome.unwrap_or_default());
    if let (Some(map), Value::Object(orbit)) = (value.as_object_mut(), orbit) {
        let null = |(name, figure)| (name, if point.exists() { figure } else { Value::Null });
        map.extend(orbit.into_iter().map(null));
    }
    value
}

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
];

fn of_slip(point: &SlipPoint, figure: fn(SlipOrbit) -> f64) -> TableCell {
    point.outcome.ok().map(figure).into()
}
