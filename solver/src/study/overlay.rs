//! Curves drawn over a map: critical speed, ends of the lock, and the smallest pulse that makes a
//! blade touch.

use super::MapPlan;
use super::margins::grazing_pulse;
use crate::harmonic::lock_window;
use crate::model::Machine;
use crate::scene::Scene;
use crate::scene::keys::{PULSE, SPEED};

/// A curve in the quantities of the map's axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name of the curve.
    pub name: &'static str,
    /// Points `(x, y)` in order along the curve, in the units of the axes' keys.
    pub points: Vec<(f64, f64)>,
}

/// Returns the curves that apply to the axes of a map, with one point for each of its columns or
/// rows.
#[must_use]
pub fn curves(plan: &MapPlan) -> Vec<Curve> {
    let mut curves = speed_curves(plan);
    if let Some(of_pulse) = AlongOther::new(plan, PULSE) {
        let most = plan.x.to.abs().max(plan.y.to.abs());
        curves.push(of_pulse.trace("grazing pulse", |scene| grazing_pulse(scene, most)));
    }
    curves.retain(|curve| !curve.points.is_empty());
    curves
}

/// Returns the critical speed and the ends of the lock, if one axis is the speed.
#[must_use]
pub fn speed_curves(plan: &MapPlan) -> Vec<Curve> {
    let Some(of_speed) = AlongOther::new(plan, SPEED) else { return Vec::new() };
    vec![
        of_speed.trace_speed("Omega_c", |machine, _| machine.critical_speed()),
        of_speed.trace_speed("Omega_lock", |machine, toward| {
            lock_window(machine, toward).map(|window| window.from)
        }),
        of_speed.trace_speed("lock ends", |machine, toward| lock_window(machine, toward)?.to),
    ]
}

/// As [`speed_curves`], with the dangerous coincidence.
#[must_use]
pub fn threshold_curves(plan: &MapPlan) -> Vec<Curve> {
    let mut curves = speed_curves(plan);
    if let Some(of_speed) = AlongOther::new(plan, SPEED) {
        curves.push(of_speed.trace_speed("coincidence", |machine, _| machine.dangerous_speed()));
    }
    curves
}

/// A map with one axis over a given key; curves are traced along the other axis.
struct AlongOther<'a> {
    plan: &'a MapPlan,
    /// Whether the key is that of the x axis.
    on_x: bool,
}

impl<'a> AlongOther<'a> {
    fn new(plan: &'a MapPlan, path: &str) -> Option<Self> {
        let on_x = plan.x.path == path;
        (on_x || plan.y.path == path).then_some(Self { plan, on_x })
    }

    /// Traces a threshold, for the direction of rotation in which the speed axis extends further.
    fn trace_speed(
        &self,
        name: &'static str,
        threshold: fn(&Machine, f64) -> Option<f64>,
    ) -> Curve {
        let axis = if self.on_x { &self.plan.x } else { &self.plan.y };
        let sense = if axis.from + axis.to < 0.0 { -1.0 } else { 1.0 };
        self.trace(name, |scene| threshold(&scene.machine(), sense).map(|speed| sense * speed))
    }

    fn trace(&self, name: &'static str, value: impl Fn(&Scene) -> Option<f64>) -> Curve {
        let other = if self.on_x { &self.plan.y } else { &self.plan.x };
        let points = (0..other.count).filter_map(|index| {
            let mut scene = self.plan.scene.clone();
            other.apply(&mut scene, index).ok()?;
            let (along, value) = (other.value(index), value(&scene)?);
            Some(if self.on_x { (value, along) } else { (along, value) })
        });
        Curve { name, points: points.collect() }
    }
}
