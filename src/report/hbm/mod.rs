//! Steady states against speed (`rubscope hbm`): what each view computes, its tables and its JSON
//! (`rubscope.hbm/1`). A view is one file with one [`View`], listed in [`VIEWS`].

mod branches;
mod campbell;
pub mod coincidence;
mod compliance;
mod excitation;
mod forced;
mod heading;
pub mod locked;
mod parts;
mod slip;
mod smooth;
mod whirl;

pub use heading::Heading;
pub use locked::LOCKED;
pub use parts::Parts;

use super::number::{per_speed, short};
use super::table::Table;
use rubscope_solver::harmonic::{Corner, Form, HarmonicError, Sweep, lock_window, locked_motion};
use rubscope_solver::model::{LockWindow, Machine};
use rubscope_solver::scene::{ModelSize, Scene, keys};

/// The views that have an option, in the order of the help.
pub const VIEWS: [&View; 9] = [
    &branches::BRANCHES,
    &slip::SLIP,
    &campbell::CAMPBELL,
    &excitation::EXCITATION,
    &smooth::SMOOTH,
    &coincidence::COINCIDENCE,
    &forced::FORCED,
    &whirl::WHIRL,
    &compliance::COMPLIANCE,
];

/// A view of the steady states of a scene.
#[derive(Debug)]
pub struct View {
    /// Name of the option, without dashes; empty for the default view.
    pub option: &'static str,
    /// Help of the option.
    pub help: &'static str,
    /// Whether the view always includes damping, so that `--undamped` is refused.
    pub always_damped: bool,
    /// Whether the view needs a single speed.
    pub one_speed: bool,
    /// How the JSON of the view includes the lock of rigid contact.
    pub lock: LockBeside,
    /// Computes the view.
    pub answer: fn(&Request<'_>) -> Result<Answer, HarmonicError>,
}

/// Whether the lock of rigid contact is added to a view.
#[derive(Debug)]
pub enum LockBeside {
    /// The view uses the contact law of the scene; no lock is added.
    OfScene,
    /// The view uses rigid contact, and the lock is added. If computing the lock fails with an
    /// error that the function accepts, the view is shown without it.
    Rigid(fn(&HarmonicError) -> bool),
}

/// Input of a view.
#[derive(Debug)]
pub struct Request<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Rotor speeds \[rad/s\].
    pub speeds: &'a [f64],
    /// Form of the lock's equations.
    pub form: Form,
    /// Whether the equations include the damping of the scene.
    pub damped: bool,
    /// The two blades that hold the wave, if the user chose them.
    pub pair: Option<[u32; 2]>,
    /// Machine of the scene, with rigid contact if the view uses it.
    pub machine: Machine,
    /// The locked motion, where there is one and the view has rigid contact.
    pub sweep: Option<Sweep>,
}

impl Request<'_> {
    /// Returns the speed of largest magnitude, which determines the sense of rotation \[rad/s\].
    pub fn fastest(&self) -> f64 {
        let further = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        self.speeds.iter().copied().max_by(further).unwrap_or(self.scene.operation.speed_rad_s)
    }

    /// Returns the lowest and the highest speed \[rad/s\].
    fn span(&self) -> [f64; 2] {
        let least = self.speeds.iter().copied().fold(f64::INFINITY, f64::min);
        [least, self.speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
    }

    fn corner(&self) -> Result<Corner, HarmonicError> {
        let polygon = &self.machine.polygon;
        self.pair.map_or_else(|| Corner::paper(polygon), |pair| Corner::of_blades(polygon, pair))
    }

    /// Computes a view, and puts the JSON fields common to all views before its own.
    ///
    /// # Errors
    /// The scene has a key, named in the error, that the view cannot handle.
    pub fn answer(&mut self, view: &View) -> Result<Answer, HarmonicError> {
        self.knows_tips(view)?;
        if let LockBeside::Rigid(tolerates) = view.lock {
            let machine = self.scene.machine().with_lining(None);
            // The rigid model ignores the bending of the blades under load.
            let rigid = self.scene.solver.model == ModelSize::Rigid;
            self.machine = if rigid { machine.with_stiff_blades() } else { machine };
            let Self { form, damped, pair, speeds, .. } = *self;
            let found = match self.scene.clearance() {
                ..=0.0 => Err(no_clearance(self.scene)),
                _ => locked_motion(&self.machine, form, damped, pair, speeds),
            };
            match found {
                Ok(mut sweep) => {
                    let points = sweep.points.iter_mut().filter(|_| rigid);
                    points.for_each(|point| point.alpha_rad = [0.0; 2]);
                    self.sweep = Some(sweep);
                }
                Err(error) if tolerates(&error) => {}
                Err(error) => return Err(error),
            }
        }
        let answer = (view.answer)(self)?;
        Ok(Answer { json: self.json().and(answer.json), ..answer })
    }

    /// Refuses unequal tips and an out-of-round casing if the view is not derived for them.
    fn knows_tips(&self, view: &View) -> Result<(), HarmonicError> {
        let (machine, height) = (&self.machine, self.scene.casing.out_of_round_m);
        let refuse = |key, given: String| {
            let option =
                if view.option.is_empty() { "hbm".into() } else { format!("--{}", view.option) };
            Err(HarmonicError::refused(
                key,
                given,
                format!("none with {option}, which is not derived for it"),
            ))
        };
        if machine.has_unequal_tips() && !["", "branches", "campbell"].contains(&view.option) {
            let given = self.scene.unevenness().into_iter().find(|(_, length)| *length != 0.0);
            let (key, length) = given.unwrap_or((keys::TIPS, 0.0));
            return refuse(key, format!("{length:e}"));
        }
        let round = ["forced", "coincidence", "campbell", "compliance"];
        if height != 0.0 && !round.contains(&view.option) {
            return refuse(keys::OUT_OF_ROUND, format!("{height:e}"));
        }
        Ok(())
    }

    /// Returns the JSON fields common to all views.
    fn json(&self) -> Parts {
        let Self { scene, machine, form, damped, .. } = self;
        let (speed, notes) = (self.fastest(), notes(scene, machine));
        let window = lock_window(machine, speed);
        let json = Parts::default()
            .with("scene", scene.reported())
            .with("form", form)
            .with("damped", damped);
        let json = if notes.is_empty() { json } else { json.with("notes", notes) };
        let json = json
            .with("omega_c_rad_s", machine.critical_speed())
            .with("omega_lock_rad_s", window.map(|window| window.from))
            .with("lock_ends_rad_s", window.and_then(|window| window.to))
            .with("omega_adhesive_rad_s", machine.adhesive_speed())
            .with("coincidence_rad_s", machine.dangerous_speed_toward(speed))
            .with("casing_frequency_rad_s", machine.omega_c)
            .with("blade_frequency_rad_s", machine.omega_bd)
            .with("clearance_m", machine.clearance())
            .with("locked_amplitude_m", machine.locked_amplitude());
        match &self.sweep {
            Some(sweep) => locked::points(json, &machine.polygon, sweep),
            None => json.with("missing_rad_s", [(); 0]).with("points", [(); 0]),
        }
    }
}

/// Result of a view.
#[derive(Debug)]
pub struct Answer {
    /// Its own fields in JSON.
    pub json: Parts,
    /// Tables to show, each with its title.
    pub tables: Vec<(String, Table)>,
    /// The table for files, where it is none of those.
    file: Option<Table>,
}

impl Answer {
    /// Creates an answer; the last table also goes to files.
    fn of(json: Parts, tables: Vec<(String, Table)>) -> Self {
        Self { json, tables, file: None }
    }

    /// Returns the table for files.
    pub fn file(&self) -> Option<&Table> {
        self.file.as_ref().or(self.tables.last().map(|(_, table)| table))
    }
}

/// Refuses a preloaded lining: the limit of rigid contact needs a clearance.
fn no_clearance(scene: &Scene) -> HarmonicError {
    let length = scene.bladed_disk.blade_length_m;
    HarmonicError::refused(
        keys::CASING_RADIUS,
        scene.casing.radius_m,
        format!(
            "above bladed_disk.blade_length_m = {length} here: hbm --smooth has the steady states of \
         a preloaded lining"
        ),
    )
}

/// Returns remarks on effects of the scene that the view ignores.
pub fn notes(scene: &Scene, machine: &Machine) -> Vec<String> {
    let hard = scene.lining().filter(|_| machine.lining.is_none());
    let hard = hard.map(|_| "of rigid contact; --smooth has the lining of the scene".to_string());
    hard.into_iter().chain(scene.tuned_note()).collect()
}

/// Formats a speed window: `472.117 to 566.259`, or only its start if it has no upper end.
pub fn speeds_of(window: LockWindow) -> String {
    match window.to {
        Some(to) => format!("{} to {}", short(per_speed(window.from)), short(per_speed(to))),
        None => short(per_speed(window.from)),
    }
}
