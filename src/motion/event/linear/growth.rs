//! How far the blades swing, and motions that leave the range of the model.

use std::f64::consts::TAU;

use super::Joined;
use super::parameters::{Parameters, Point};
use crate::motion::FailureReason;
use crate::motion::trend::Trend;
use crate::tolerances::LARGEST_BLADE_ANGLE;

/// The largest amplitude of the blades over the last casing period or two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swings {
    period: f64,
    /// When the period of now ends \[s\].
    end: f64,
    before: f64,
    now: f64,
    trend: Trend,
}

impl Swings {
    pub(super) fn new(parameters: &Parameters, end: f64) -> Self {
        let period = TAU / parameters.machine.omega_c;
        Self { period, end: period, before: 0.0, now: 0.0, trend: Trend::over(end) }
    }

    /// Sees an amplitude at an instant \[rad\].
    pub(super) fn see(&mut self, t: f64, amplitude: f64) {
        if t >= self.end {
            // After a whole period without a look nothing of before is left.
            self.before = if t < self.end + self.period { self.now } else { 0.0 };
            (self.now, self.end) = (0.0, t + self.period);
            self.trend.see(t, self.before);
        }
        self.now = self.now.max(amplitude);
    }

    /// The largest that lasts, as they go \[rad\].
    pub(super) fn lasting(&self) -> f64 {
        self.trend.falls_to(self.largest()).unwrap_or_else(|| self.largest())
    }

    /// Forgets what was before a change on the way.
    pub(super) fn forget(&mut self) {
        self.trend.forget();
    }

    pub(super) fn largest(&self) -> f64 {
        self.now.max(self.before)
    }
}

impl Joined {
    /// Fails a motion that has grown beyond what the model describes.
    pub(super) fn check_growth(&mut self, s: f64, point: &Point) {
        let parameters = &self.parameters;
        let angle_rad = parameters.largest_angle(point.a);
        let (distance_m, radius_m) = (point.z.norm(), parameters.radius);
        let along = parameters.machine.tangential_ratio * parameters.carried(point).norm();
        let tips = parameters.speed.abs() * radius_m;
        let reason = if angle_rad > LARGEST_BLADE_ANGLE {
            FailureReason::BladeAngle { angle_rad }
        } else if distance_m > radius_m && !parameters.machine.polygon.has_corners() {
            FailureReason::NoCorner { radius_m }
        } else if distance_m > radius_m {
            FailureReason::Displacement { distance_m, radius_m }
        } else if parameters.turn.im != 0.0 && along > tips {
            FailureReason::CasingSpeed { speed_m_s: along, tip_m_s: tips }
        } else {
            return;
        };
        self.fail(s, reason);
    }
}
