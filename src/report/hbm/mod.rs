//! Reports of the frequency domain: JSON (`rubscope.hbm/1`), tables and a
//! heading in sentences. Results serialise themselves; this file has only the
//! views that combine several results or take parts of one.

use std::rc::Rc;

use serde::Serialize;
use serde_json::{Value, json};

mod heading;
mod joined;
mod lining;
mod parts;
mod tables;

pub use heading::Heading;
pub use joined::{
    CompliancePoint, WhirlRow, compliance, compliance_chart, compliance_table, wave_table, whirl,
    whirl_table,
};
pub use lining::*;
pub use tables::*;

use parts::{Part, Parts};

use crate::report::number::{per_speed, short};
use rubscope_solver::harmonic::{
    Branches, Campbell, ExcitedLock, ExcitedLocks, Form, Line, LockedPoint, SlipPoint, Sweep,
};
use rubscope_solver::model::{ContactPolygon, Excitation, LockWindow, Machine};
use rubscope_solver::scene::Scene;

/// The whole answer of `rubscope hbm --json`, its parts in order.
#[derive(Debug, Serialize)]
#[serde(transparent)]
pub struct HbmReport(Parts);

impl HbmReport {
    /// The report of the machine of a scene, without points; the coincidence is that of a
    /// rotor that turns in the sense of `speed`.
    #[must_use]
    pub fn new(scene: &Scene, machine: &Machine, form: Form, damped: bool, speed: f64) -> Self {
        let report = Self(Parts::default())
            .with("scene", scene.reported())
            .with("form", form)
            .with("damped", damped);
        let (notes, window) = (notes(scene, machine), machine.lock_window(speed));
        let report = if notes.is_empty() { report } else { report.with("notes", notes) };
        report
            .with("omega_c_rad_s", machine.critical_speed())
            .with("omega_lock_rad_s", window.map(|window| window.from))
            .with("lock_ends_rad_s", window.and_then(|window| window.to))
            .with("omega_adhesive_rad_s", machine.adhesive_speed())
            .with("coincidence_rad_s", machine.dangerous_speed_toward(speed))
            .with("casing_frequency_rad_s", machine.omega_c)
            .with("blade_frequency_rad_s", machine.omega_bd)
            .with("clearance_m", machine.clearance())
            .with("locked_amplitude_m", machine.locked_amplitude())
            .with("missing_rad_s", [(); 0])
            .with("points", [(); 0])
    }

    /// Adds a part, or replaces it in its place.
    #[must_use]
    pub fn with(self, name: &'static str, part: impl Serialize) -> Self {
        Self(self.0.with_whole(name, part))
    }

    /// As `with`, of parts of which some are made as they are written.
    #[must_use]
    pub fn with_parts(self, name: &'static str, parts: Parts) -> Self {
        Self(self.0.with(name, Part::Parts(parts)))
    }

    /// Adds an array with an element for each item, made as it is written.
    #[must_use]
    pub fn with_rows<T: 'static>(
        self,
        name: &'static str,
        items: &Rc<Vec<T>>,
        of: impl Fn(&T) -> Value + 'static,
    ) -> Self {
        Self(self.0.with_rows(name, items, of))
    }

    /// Adds every equilibrium at these speeds, made as they are written, and where they
    /// change.
    #[must_use]
    pub fn with_branches(self, branches: &Rc<Branches>) -> Self {
        let parts = Parts::default().with_whole("thresholds", &branches.thresholds);
        let (speeds, branches) = (branches.speeds(), Rc::clone(branches));
        let states =
            move |place| Ok(branches.states_at(place)?.iter().map(|state| json!(state)).collect());
        self.with_parts("branches", parts.with("states", Part::Rows(speeds, Box::new(states))))
    }

    /// Adds the locked motion over speed.
    #[must_use]
    pub fn with_sweep(self, polygon: &ContactPolygon, sweep: &Rc<Sweep>) -> Self {
        let blades = sweep.corner.sides().map(|side| polygon.blades_of_side(side));
        let report = self.with("missing_rad_s", &sweep.missing);
        let (count, sweep) = (sweep.points.len(), Rc::clone(sweep));
        let points = move |place: usize| {
            let point = sweep.points.get(place);
            Ok(point.map(|point| with_groups(point, &blades)).into_iter().collect())
        };
        Self(report.0.with("points", Part::Rows(count, Box::new(points))))
    }
}

/// A locked motion with its multipliers and angles by phase group.
fn with_groups(point: &LockedPoint, blades: &[Vec<u32>; 2]) -> Value {
    let mut value = json!(point);
    if let Some(map) = value.as_object_mut() {
        let groups = [0, 1].map(|i| {
            let (multiplier, alpha) = (point.multipliers_n[i], point.alpha_rad[i]);
            json!({ "blades": blades[i], "multiplier_n": multiplier, "alpha_rad": alpha })
        });
        map.shift_remove("multipliers_n");
        map.shift_remove("alpha_rad");
        map.shift_insert(1, "groups".to_string(), json!(groups));
    }
    value
}

/// Slip at one speed in JSON, with `null` for each figure where there is none.
#[must_use]
pub fn slip(point: &SlipPoint) -> Value {
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

/// Campbell data at these speeds \[rad/s\] in JSON.
#[must_use]
pub fn campbell(campbell: &Campbell, speeds: &Rc<Vec<f64>>) -> Parts {
    let at = Rc::clone(speeds);
    let line = move |line: &Line| {
        let frequencies: Vec<f64> = at.iter().map(|&speed| line.at(speed)).collect();
        json!({
            "name": line.name,
            "at_standstill_rad_s": line.at_standstill_rad_s,
            "slope": line.slope,
            "frequency_rad_s": frequencies,
        })
    };
    Parts::default()
        .with_rows("speed_rad_s", speeds, |speed| json!(speed))
        .with_rows("lines", &Rc::new(campbell.lines.clone()), line)
        .with_whole("coincidences", &campbell.coincidences)
}

/// The response of the lock to an engine order in JSON: amplitudes of
/// oscillation, and whether this order drives the modes.
#[must_use]
pub fn excitation(excitation: &Excitation, drives: bool, found: &Rc<ExcitedLocks>) -> Parts {
    let point = |lock: ExcitedLock| {
        json!({
            "speed_rad_s": lock.state.speed_rad_s,
            "frequency_rad_s": lock.frequency_rad_s,
            "character": lock.state.character,
            "casing_m": lock.casing_m(),
            "alpha_c_rad": lock.response[2].norm(),
            "alpha_s_rad": lock.response[3].norm(),
            "multipliers_n": lock.multipliers_n.map(|multiplier| multiplier.norm()),
            "relative_amplitude": lock.relative_amplitude,
            "relative_multiplier": lock.relative_multiplier,
            "release_torque_nm": lock.release_torque_nm,
        })
    };
    let (places, found) = (found.places(), Rc::clone(found));
    let points = move |place| Ok(found.lock_at(place)?.map(point).into_iter().collect());
    Parts::default()
        .with_whole("amplitude_nm", excitation.amplitude_nm)
        .with_whole("order", excitation.order)
        .with_whole("drives", drives)
        .with("points", Part::Rows(places, Box::new(points)))
}

/// What the numbers are of, where the scene asks for more than the view has.
#[must_use]
pub fn notes(scene: &Scene, machine: &Machine) -> Vec<String> {
    let hard = scene.lining().filter(|_| machine.lining.is_none());
    let hard = hard.map(|_| "of rigid contact; --smooth has the lining of the scene".to_string());
    hard.into_iter().chain(scene.tuned_note()).collect()
}

/// The speeds of a window: `472.117 to 566.259`, or where it begins alone.
#[must_use]
pub fn speeds_of(window: LockWindow) -> String {
    match window.to {
        Some(to) => format!("{} to {}", short(per_speed(window.from)), short(per_speed(to))),
        None => short(per_speed(window.from)),
    }
}
