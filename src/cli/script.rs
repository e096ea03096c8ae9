//! Changes of a running motion: `--at TIME:PATH=VALUE` and `--at TIME:pulse`. The rules are those of
//! live knobs in the explorer, so that changes made on the screen can be repeated without it.

use serde_json::{Value, json};

use super::status::Refusal;
use crate::sheet::number::time;
use rubscope_solver::motion;
use rubscope_solver::scene::keys::{self, Live, SPEED};
use rubscope_solver::scene::units::UnitError;
use rubscope_solver::scene::{CheckedScene, KEYS, Key, Quantity, SolverKind};

/// Name of the option, for error messages.
const OPTION: &str = "--at";
/// Word that fires the pulse, in place of a key.
const PULSE: &str = "pulse";

/// The changes of a run, in order of time.
#[derive(Debug, Default)]
pub struct RequestedScript {
    /// The changes in words, such as `operation.speed_rad_s=480 at 10 ms`.
    pub words: Vec<String>,
    /// The changes as they appear in JSON reports, with the checked values of their keys.
    pub json: Vec<Value>,
    /// The operations of the solver that make the changes.
    pub changes: motion::Script,
}

impl RequestedScript {
    /// Reads the options, and checks each change on the scene with the earlier ones applied. Changes
    /// at the same time keep their order.
    ///
    /// # Errors
    /// The first option that has another form, or the first change that is refused: its time is
    /// outside the run, its key does not exist or cannot change during this run, or its value is
    /// not allowed.
    pub fn of(options: &[String], scene: &CheckedScene) -> Result<Self, Refusal> {
        let mut requested =
            options.iter().map(|text| parsed(text)).collect::<Result<Vec<_>, _>>()?;
        requested.sort_by(|one, other| one.0.total_cmp(&other.0));
        let (mut script, mut acts) = (Self::default(), Vec::new());
        let mut scene = scene.clone();
        for (t_s, change) in requested {
            let told = match &change {
                None => PULSE.to_string(),
                Some((path, value)) => format!("{path}={value}"),
            };
            let shown = format!("{t_s}:{told}");
            let end = scene.solver.end_s;
            if !(0.0..=end).contains(&t_s) {
                let allowed = format!("a time from 0 to solver.end_s = {end}");
                return Err(Refusal::of(OPTION, shown, allowed));
            }
            let mut own = vec![motion::Change::Pulse];
            let mut json = json!({ "t_s": t_s, "pulse": true });
            if let Some((path, value)) = change {
                let after = changed(t_s, [&path, &value], &scene, &shown)?;
                own = acts_of(&path, &scene, &after);
                let value = keys::find(&path).map(|key| (key.get)(&after)).ok();
                json = json!({ "t_s": t_s, "path": path, "value": value });
                scene = after;
            }
            acts.extend(own.into_iter().map(|act| (t_s, act)));
            script.words.push(format!("{told} at {}", time(t_s)));
            script.json.push(json);
        }
        Ok(Self { changes: motion::Script::new(acts), ..script })
    }
}

/// A change as requested: its time \[s\], and the key with its value as typed; `None` fires the
/// pulse.
type Requested = (f64, Option<(String, String)>);

fn parsed(text: &str) -> Result<Requested, Refusal> {
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
        Some((path, value)) => Some((path.trim().into(), value.trim().into())),
        None if change.trim() == PULSE => None,
        None => return Err(form()),
    };
    // Adding zero turns -0 into 0, which sorts as the same time.
    Ok((time + 0.0, change))
}

/// Returns the scene with a key changed at a time of the run; `shown` is the change for messages.
fn changed(
    t_s: f64,
    [path, value]: [&str; 2],
    before: &CheckedScene,
    shown: &str,
) -> Result<CheckedScene, Refusal> {
    let refused = |error| Refusal::because(format!("{OPTION} {shown}: {error}"));
    let key = keys::find(path).map_err(refused)?;
    let fixed = || {
        let keys = KEYS.iter().filter(|key| acts_live(key, before)).map(|key| key.path);
        let (solver, keys) = (before.solver.kind, keys.collect::<Vec<_>>().join(", "));
        let allowed = format!("{PULSE}, or a key that a running {solver} motion takes: {keys}");
        Refusal::of(OPTION, shown, allowed)
    };
    if !acts_live(key, before) {
        return Err(fixed());
    }
    let mut running = before.clone().into_scene();
    if t_s > 0.0 {
        // A change of the gaps is checked at rest, because the displacement at time t is unknown;
        // the solver handles any overlap.
        (running.initial.u_c_m, running.initial.u_s_m) = (0.0, 0.0);
    }
    let after = running.with(&[(path, value)]).map_err(refused)?;
    after.slides().map_err(refused)?;
    if key.live != Live::Always && !motion::Change::is_live(before, &after) {
        let crossed = motion::Change::crosses(before, &after);
        return Err(crossed.map_or_else(fixed, |why| Refusal::of(OPTION, shown, why)));
    }
    Ok(after)
}

/// Returns the operations of the solver that change a key.
fn acts_of(path: &str, before: &CheckedScene, after: &CheckedScene) -> Vec<motion::Change> {
    let mut acts = motion::Change::between(before, after);
    let (speed, ramp) = (after.operation.speed_rad_s, after.operation.speed_ramp_rad_s2);
    if path == SPEED && before.operation.speed_rad_s == speed {
        // With a speed ramp, setting the initial speed again still changes the motion.
        acts.insert(0, motion::Change::Rotor { speed: Some(speed), ramp });
    }
    acts
}

/// Returns whether a key may change while the motion of a scene runs with the solver of the scene.
fn acts_live(key: &Key, scene: &CheckedScene) -> bool {
    let by_steps = scene.solver.kind == SolverKind::Explicit;
    key.live == Live::Always || (by_steps && key.live == Live::Steps)
}
