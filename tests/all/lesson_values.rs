//! The numbers that lessons state, from the solvers: what a check of a lesson asks for.

use std::collections::BTreeMap;

use rubscope::tui::App;
use rubscope::tui::lessons::{LessonStep, Settings};
use rubscope_solver::harmonic::{Form, Lining, locked_motion, roundness};
use rubscope_solver::motion::RunReport;
use rubscope_solver::scene::{CheckedScene, Value, keys};
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Scattered;
use serde::Deserialize;

/// A number or a word of the text, and where it is from.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Check {
    /// Something of the run to the end.
    pub run: Option<String>,
    /// Something of the steady states, from the harmonic balance.
    pub hbm: Option<String>,
    /// Something of the machine.
    pub model: Option<String>,
    /// A limit of the scene.
    pub margins: Option<String>,
    /// The parameter of which one per cent more changes that limit by a part of it.
    pub by: Option<String>,
    /// A key of the scene.
    pub key: Option<String>,
    /// The rotor speed for `hbm`, if not that of the scene \[rad/s\].
    pub speed: Option<f64>,
    /// Keys in which the scene differs from that of the step.
    #[serde(default)]
    pub with: Settings,
    /// Expected value.
    pub is: Expected,
    /// Largest difference; half of the last digit if not given.
    pub within: Option<f64>,
}

/// Expectation of a check.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Expected {
    /// A number, in SI units.
    Number(f64),
    /// A word.
    Word(String),
}

/// The checks of a step.
pub fn checks(step: &LessonStep) -> Vec<Check> {
    let checks = step.check.iter().filter(|check| !check.contains_key("shown"));
    checks.map(|check| check.clone().try_into().unwrap()).collect()
}

/// What the text names of the screen, and the columns from which on there is room for it.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    pub shown: String,
    #[serde(default)]
    pub from: u16,
}

/// What a step names of the screen.
pub fn shown(step: &LessonStep) -> Vec<Shown> {
    let named = step.check.iter().filter(|check| check.contains_key("shown"));
    named.map(|check| check.clone().try_into().unwrap()).collect()
}

/// Runs that were asked for, by their scene: several checks ask for the same.
#[derive(Default)]
pub struct Runs(BTreeMap<String, RunReport>);

impl Runs {
    pub fn of(&mut self, scene: &CheckedScene) -> &RunReport {
        let run = || crate::run_once(scene);
        self.0.entry(scene.to_toml()).or_insert_with(run)
    }
}

/// The number that a check asks about, in SI units.
pub fn found(check: &Check, app: &App, runs: &mut Runs) -> Vec<f64> {
    let mut scene = app.scene.clone().into_scene();
    for (path, value) in &check.with {
        scene.set(path, value).unwrap();
    }
    let scene = scene.checked().unwrap();
    let machine = scene.machine();
    let speed = check.speed.unwrap_or(scene.operation.speed_rad_s);
    if let Some(name) = &check.key {
        return match (keys::find(name).unwrap().get)(&scene) {
            Value::Real(x) => vec![x],
            Value::Whole(n) => vec![n as f64],
            other => panic!("{name} is {other}"),
        };
    }
    if let Some(name) = &check.model {
        return vec![match name.as_str() {
            "omega_c" => machine.omega_c,
            "critical_speed" => machine.critical_speed().unwrap(),
            "lock_speed" => machine.lock_speed().unwrap(),
            "adhesive_speed" => machine.adhesive_speed().unwrap(),
            "amplitude_m" => machine.locked_amplitude().unwrap(),
            "coincidence" => machine.dangerous_speed().unwrap(),
            // mu tau = tan delta.
            "friction_limit" => machine.polygon.delta.tan() / machine.tangential_ratio,
            "sides" => f64::from(machine.polygon.sides),
            "clearance_m" => machine.clearance(),
            "least_clearance_m" => machine.least_clearance(),
            // A blade shorter by more has no side between its neighbours.
            "cut_off_m" => {
                machine.clearance() * ((2.0 * machine.polygon.delta).cos().recip() - 1.0)
            }
            "scattered_speed" => Scattered::of(&scene).unwrap().mean_rad_s,
            "scattered_rotors" => f64::from(Scattered::of(&scene).unwrap().rotors),
            "scattered_part" => Scattered::of(&scene).unwrap().tip_scatter_m / machine.clearance(),
            // The part of the circumference on which lobes press.
            "rub_part" => {
                (machine.clearance() / machine.out_of_round()).acos() / std::f64::consts::PI
            }
            "corner_factor" => (2.0 * machine.polygon.delta).cos(),
            _ => panic!("{name}"),
        }];
    }
    if let Some(name) = &check.margins {
        let margins = Margins::of(&scene);
        let limit = margins.limit(name.parse().unwrap()).unwrap();
        let change = |path: &String| limit.sensitivities.by(path).unwrap() / 100.0;
        return vec![check.by.as_ref().map_or_else(|| limit.value.unwrap(), change)];
    }
    if let Some(name @ ("hopf_a" | "hopf_b" | "cycle_rad")) = check.hbm.as_deref() {
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        let hopf = lining.hopf_points([300.0, 500.0]).unwrap();
        return vec![match name {
            "hopf_a" => hopf[0].speed_rad_s,
            "hopf_b" => hopf[1].speed_rad_s,
            _ => lining.cycles(speed).unwrap().iter().find(|one| one.stable).unwrap().blade_rad,
        }];
    }
    if let Some(lobes) = check.hbm.as_ref().and_then(|name| name.strip_prefix("roundness_")) {
        return vec![roundness(&machine, speed, lobes.parse().unwrap()).unwrap()];
    }
    if check.hbm.as_deref() == Some("growth_1_s") {
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        return vec![lining.rest(speed).worst().growth_1_s];
    }
    if let Some(name) = &check.hbm {
        let sweep = locked_motion(&machine, Form::Modal, true, None, &[speed]).unwrap();
        let place = ["multiplier_a_n", "multiplier_b_n"].iter().position(|known| known == name);
        return vec![sweep.points[0].multipliers_n[place.unwrap()]];
    }
    let run = runs.of(&scene).clone();
    match check.run.as_deref().unwrap() {
        "impacts" => vec![run.impact_count as f64],
        "tensile" => vec![run.checks.tensile_steps as f64],
        "impact_s" => run.impacts.iter().map(|impact| impact.t_s).collect(),
        "impact_blade" => blades(run.impacts.iter().map(|impact| &impact.blades)),
        "blade" => blades(run.outcome.contacts.iter().map(|contact| &contact.blades)),
        "force_n" => run.outcome.contacts.iter().map(|contact| contact.multiplier_n).collect(),
        "since_s" => run.outcome.lock_time_s.into_iter().collect(),
        "wave_speed" => run.outcome.wave_speed_rad_s.into_iter().collect(),
        "lag" => run.outcome.wave_speed_rad_s.into_iter().map(|wave| speed - wave).collect(),
        "final_m" => vec![run.r#final.u_c_m.hypot(run.r#final.u_s_m)],
        "end_speed" => vec![speed + scene.operation.speed_ramp_rad_s2 * scene.solver.end_s],
        "held_speed" => {
            let ramp = scene.operation.speed_ramp_rad_s2;
            run.outcome.lock_time_s.into_iter().map(|since| speed + ramp * since).collect()
        }
        "break_s" => vec![break_time(&scene)],
        "break_speed" => vec![speed + scene.operation.speed_ramp_rad_s2 * break_time(&scene)],
        "error_u_s" => {
            let right = runs.of(&scene.as_reference().checked().unwrap()).r#final.u_s_m;
            vec![((run.r#final.u_s_m - right) / right).abs()]
        }
        name => panic!("{name}"),
    }
}

fn blades<'a>(groups: impl Iterator<Item = &'a Vec<u32>>) -> Vec<f64> {
    groups.flatten().map(|blade| f64::from(*blade)).collect()
}

/// When the two sides that are held at the start are no longer held \[s\].
fn break_time(scene: &CheckedScene) -> f64 {
    let (mut held, mut broken) = (0.0, scene.solver.end_s);
    for _ in 0..30 {
        let mut shorter = scene.clone().into_scene();
        shorter.solver.end_s = 0.5 * (held + broken);
        let held_still = crate::run_once(&shorter.checked().unwrap()).outcome.contacts.len() == 2;
        *(if held_still { &mut held } else { &mut broken }) = shorter.solver.end_s;
    }
    held
}
