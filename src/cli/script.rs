//! Changes of a running motion: `--at TIME:PATH=VALUE` and `--at TIME:pulse`.
//! The rules are those of live knobs in the explorer, so that changes made on
//! the screen can be repeated without it.
//!
//! `parse` reads the options, `RequestedScript::resolve` checks them against a
//! scene before anything is simulated, and `RequestedScript::changes` gives the
//! changes of the motion.

use serde::{Serialize, Serializer};

use super::status::Refusal;
use crate::sheet::number::time;
use rubscope_solver::motion;
use rubscope_solver::scene::keys::{self, Live, SPEED};
use rubscope_solver::scene::units::UnitError;
use rubscope_solver::scene::{CheckedScene, KEYS, Key, Quantity, SolverKind, Value};

/// Name of the option, for error messages.
const OPTION: &str = "--at";
/// Word that fires the pulse, in place of a key.
const PULSE: &str = "pulse";

/// One change of a running motion.
#[derive(Clone, Debug, PartialEq)]
pub enum RequestedChange {
    /// Fires the pulse.
    Pulse,
    /// Sets a key of the scene to a value.
    Set {
        /// Dotted path of the key.
        path: String,
        /// The value, as typed.
        value: String,
    },
}

impl std::fmt::Display for RequestedChange {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Pulse => out.write_str(PULSE),
            Self::Set { path, value } => write!(out, "{path}={value}"),
        }
    }
}

/// Parses the `--at` options and sorts them by time \[s\]; changes at the same time keep their
/// order.
///
/// # Errors
/// An option is not `TIME:PATH=VALUE` or `TIME:pulse`.
pub fn parse(options: &[String]) -> Result<Vec<(f64, RequestedChange)>, Refusal> {
    let mut changes = options.iter().map(|text| parse_one(text)).collect::<Result<Vec<_>, _>>()?;
    changes.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    Ok(changes)
}

fn parse_one(text: &str) -> Result<(f64, RequestedChange), Refusal> {
    let form = || {
        let allowed = "TIME:PATH=VALUE or TIME:pulse, with TIME in seconds or as 0.3ms";
        Refusal::of(OPTION, text, allowed)
    };
    let (time, change) = text.split_once(':').ok_or_else(form)?;
    let time = Quantity::Time.read(time).map_err(|why| match why {
        UnitError::NoNumber => form(),
        why => Refusal::because(format!("{OPTION} {text}: {why}")),
    })?;
    let change = match change.split_once('=') {
        Some((path, value)) => {
            RequestedChange::Set { path: path.trim().into(), value: value.trim().into() }
        }
        None if change.trim() == PULSE => RequestedChange::Pulse,
        None => return Err(form()),
    };
    // Adding zero turns -0 into 0, which sorts as the same time.
    Ok((time + 0.0, change))
}

/// A checked change, and the scene with it applied.
#[derive(Clone, Debug, PartialEq)]
pub struct RequestedStep {
    /// Simulated time of the change \[s\].
    pub t_s: f64,
    /// The change as the user requested it.
    pub change: RequestedChange,
    /// The scene with this and all earlier changes applied.
    pub scene: CheckedScene,
    /// The operations of the solver that make the change.
    acts: Vec<motion::Change>,
}

impl RequestedStep {
    fn of(t_s: f64, change: &RequestedChange, before: &CheckedScene) -> Result<Self, Refusal> {
        let shown = format!("{t_s}:{change}");
        let end = before.solver.end_s;
        if !(0.0..=end).contains(&t_s) {
            let allowed = format!("a time from 0 to solver.end_s = {end}");
            return Err(Refusal::of(OPTION, shown, allowed));
        }
        let step = |scene, acts| Self { t_s, change: change.clone(), scene, acts };
        let RequestedChange::Set { path, value } = change else {
            return Ok(step(before.clone(), vec![motion::Change::Pulse]));
        };
        let refused = |error| Refusal::because(format!("{OPTION} {shown}: {error}"));
        let key = keys::find(path).map_err(refused)?;
        let fixed = || Refusal::of(OPTION, &shown, live_keys(before));
        if !acts_live(key, before) {
            return Err(fixed());
        }
        let mut running = before.clone().into_scene();
        if t_s > 0.0 {
            // A change of the gaps is checked at rest, because the displacement at time t is
            // unknown; the solver handles any overlap.
            (running.initial.u_c_m, running.initial.u_s_m) = (0.0, 0.0);
        }
        let scene = running.with(&[(path, value)]).map_err(refused)?;
        scene.slides().map_err(refused)?;
        if key.live != Live::Always && !motion::Change::is_live(before, &scene) {
            return Err(match motion::Change::crosses(before, &scene) {
                Some(why) => Refusal::of(OPTION, &shown, why),
                None => fixed(),
            });
        }
        let mut acts = motion::Change::between(before, &scene);
        if path == SPEED && before.operation.speed_rad_s == scene.operation.speed_rad_s {
            // With a speed ramp, setting the initial speed again still changes the motion.
            let (speed, ramp) =
                (Some(scene.operation.speed_rad_s), scene.operation.speed_ramp_rad_s2);
            acts.insert(0, motion::Change::Rotor { speed, ramp });
        }
        Ok(step(scene, acts))
    }
}

/// Returns whether a key may change while the motion of a scene runs with the solver of the scene.
fn acts_live(key: &Key, scene: &CheckedScene) -> bool {
    let by_steps = scene.solver.kind == SolverKind::Explicit;
    key.live == Live::Always || (by_steps && key.live == Live::Steps)
}

/// Lists the changes that the running motion of a scene accepts, for error messages.
fn live_keys(scene: &CheckedScene) -> String {
    let keys: Vec<&str> =
        KEYS.iter().filter(|key| acts_live(key, scene)).map(|key| key.path).collect();
    let solver = scene.solver.kind;
    format!("{PULSE}, or a key that a running {solver} motion takes: {}", keys.join(", "))
}

/// Checked changes, in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RequestedScript(Vec<RequestedStep>);

impl RequestedScript {
    /// Checks changes that are sorted by time, each on the scene with the earlier ones applied.
    ///
    /// # Errors
    /// The first change that is refused: its time is outside the run, its key does not exist or
    /// cannot change during this run, or its value is not allowed.
    pub fn resolve(
        changes: &[(f64, RequestedChange)],
        scene: &CheckedScene,
    ) -> Result<Self, Refusal> {
        let mut steps: Vec<RequestedStep> = Vec::with_capacity(changes.len());
        for (t_s, change) in changes {
            let before = steps.last().map_or(scene, |step| &step.scene);
            let step = RequestedStep::of(*t_s, change, before)?;
            steps.push(step);
        }
        Ok(Self(steps))
    }

    /// Returns whether there are no changes.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the changes as operations of the solver, each with its time.
    pub fn changes(&self) -> motion::Script {
        let acts =
            |step: &RequestedStep| step.acts.iter().map(|act| (step.t_s, act.clone())).collect();
        motion::Script::new(self.0.iter().flat_map::<Vec<_>, _>(acts).collect())
    }
}

impl std::fmt::Display for RequestedScript {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (index, step) in self.0.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            write!(out, "{comma}{} at {}", step.change, time(step.t_s))?;
        }
        Ok(())
    }
}

impl Serialize for RequestedScript {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_seq(self.0.iter().map(as_json))
    }
}

/// Returns a change as it appears in JSON reports, with the checked value of its key.
fn as_json(step: &RequestedStep) -> serde_json::Value {
    let t_s = step.t_s;
    match &step.change {
        RequestedChange::Pulse => serde_json::json!({ "t_s": t_s, "pulse": true }),
        RequestedChange::Set { path, value } => {
            let value = match keys::find(path).map(|key| (key.get)(&step.scene)) {
                Ok(Value::Real(x)) => serde_json::json!(x),
                Ok(Value::Whole(n)) => serde_json::json!(n),
                Ok(Value::Text(word)) => serde_json::json!(word),
                Ok(Value::Numbers(list)) => serde_json::json!(list),
                Ok(Value::Words(_)) | Err(_) => serde_json::json!(value),
            };
            serde_json::json!({ "t_s": t_s, "path": path, "value": value })
        }
    }
}
