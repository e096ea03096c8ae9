//! A view of the steady states, and the part that all views have: the machine, its limits, and the
//! assumptions behind the numbers.

use crate::sheet::line::{capital, listed};
use crate::sheet::number::{count, rounded, short, span, speed};
use crate::sheet::{CommandLine, Sheet};
use rubscope_solver::harmonic::{Corner, Form, Locked, lock_windows};
use rubscope_solver::model::{LockWindow, Machine};
use rubscope_solver::scene::{Scene, SceneError, keys};

/// A view of the steady states of a scene.
#[derive(Debug)]
pub struct View {
    /// Name of the option, without dashes; empty for the default view.
    pub option: &'static str,
    /// Help of the option.
    pub help: &'static str,
    /// Whether the view always includes damping, so that `--undamped` is refused.
    pub always_damped: bool,
    /// Whether the view is at a single speed, by default that of the scene.
    pub one_speed: bool,
    /// `None` for the contact law of the scene. Otherwise the view is for rigid contact and a corner
    /// in which it can lock: if there is no lock for a reason that the function accepts, the view is
    /// computed nevertheless; otherwise it is refused.
    pub rigid: Option<fn(&SceneError) -> bool>,
    /// Whether the view is derived for blades of unequal length.
    pub unequal_tips: bool,
    /// Whether the view is derived for a casing out of round.
    pub out_of_round: bool,
    /// Adds the facts, sentences and tables of the view to the sheet. The table for files comes
    /// last; in JSON it is `points`.
    pub fill: Fill,
}

/// Function that adds a view to a sheet.
type Fill = fn(&Request<'_>, &mut Sheet<'_>) -> Result<(), SceneError>;

impl View {
    /// Creates a view of the damped motion in rigid contact at several speeds, derived for equal
    /// tips in a round casing. Without a corner that can lock it is refused.
    pub(super) const fn new(option: &'static str, help: &'static str, fill: Fill) -> Self {
        Self {
            option,
            help,
            always_damped: true,
            one_speed: false,
            rigid: Some(|_| false),
            unequal_tips: false,
            out_of_round: false,
            fill,
        }
    }
}

/// Input of a view.
#[derive(Debug)]
pub struct Request<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Rotor speeds, at least one; negative turns the other way \[rad/s\].
    pub speeds: &'a [f64],
    /// Form of the lock's equations.
    pub form: Form,
    /// Whether the equations include the damping of the scene.
    pub damped: bool,
    /// Numbers of the two blades that hold the wave; `None` for the default corner
    /// ([`Corner::paper`]).
    pub pair: Option<[u32; 2]>,
    /// Machine of the scene; without its lining if the view uses rigid contact.
    pub machine: Machine,
}

impl<'a> Request<'a> {
    /// Computes the sheet of a view; `command` reproduces it.
    ///
    /// # Errors
    /// The scene has a key, named in the error, that the view cannot handle; or the view cannot be
    /// computed.
    pub fn sheet(
        mut self,
        view: &View,
        command: CommandLine,
    ) -> Result<Sheet<'static>, SceneError> {
        self.refuse_uneven(view)?;
        if let Some(tolerates) = view.rigid {
            self.machine = self.scene.machine().with_lining(None).under_load();
            if let Err(error) = self.lock()
                && !tolerates(&error)
            {
                return Err(error);
            }
        }
        let mut sheet = Sheet::new("hbm", 3, command, self.scene);
        self.tell(self.damped || view.always_damped, &mut sheet);
        (view.fill)(&self, &mut sheet)?;
        Ok(sheet)
    }

    /// Returns the solver of the lock of rigid contact.
    pub(super) fn lock(&self) -> Result<Locked, SceneError> {
        let Self { form, damped, pair, speeds, .. } = *self;
        if self.scene.clearance() <= 0.0 {
            // The limit of rigid contact needs a clearance.
            let allowed = "above 0 here: hbm --smooth has the steady states of a preloaded lining";
            let clearance = format!("{} m", rounded(self.scene.clearance(), 9));
            return Err(SceneError::refused(keys::CLEARANCE, clearance, allowed));
        }
        let corner = Corner::of(&self.machine, speeds.last().copied().unwrap_or(1.0), pair)?;
        Locked::new(&self.machine, corner, form, damped)
    }

    /// Returns the speed of largest magnitude, with its sign, which determines the sense of
    /// rotation \[rad/s\].
    pub(super) fn fastest(&self) -> f64 {
        let further = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        self.speeds.iter().copied().max_by(further).unwrap_or(self.scene.operation.speed_rad_s)
    }

    /// Refuses unequal tips and an out-of-round casing if the view is not derived for them.
    fn refuse_uneven(&self, view: &View) -> Result<(), SceneError> {
        // Tips that are all longer by the same length are equal.
        let tips = view.unequal_tips || !self.machine.has_unequal_tips();
        let is_known = |key| if key == keys::OUT_OF_ROUND { view.out_of_round } else { tips };
        let mut uneven = self.scene.unevenness().into_iter();
        let refused = uneven.find(|(key, length)| *length != 0.0 && !is_known(*key));
        let Some((key, length)) = refused else { return Ok(()) };
        let option =
            if view.option.is_empty() { "hbm".into() } else { format!("--{}", view.option) };
        let allowed = format!("none with {option}, which is not derived for it");
        Err(SceneError::refused(key, format!("{length:e}"), allowed))
    }

    /// Adds the machine and its limits, as facts and as sentences. `damped` tells whether the view
    /// includes damping.
    fn tell(&self, damped: bool, sheet: &mut Sheet) {
        let Self { scene, machine, .. } = self;
        let speed = self.fastest();
        // Effects of the scene that the view ignores.
        let is_hard = scene.lining().is_some() && machine.lining.is_none();
        let hard = is_hard.then(|| "of rigid contact; --smooth has the lining of the scene".into());
        let notes: Vec<String> = hard.into_iter().chain(scene.tuned_note()).collect();
        let locks = lock_windows(machine, speed);
        let window = locks.first();
        sheet.fact("form", self.form);
        sheet.fact("damped", self.damped);
        if !notes.is_empty() {
            sheet.fact("notes", &notes);
        }
        sheet.fact("omega_c_rad_s", machine.critical_speed());
        sheet.fact("omega_lock_rad_s", window.map(|window| window.from));
        sheet.fact("lock_ends_rad_s", window.and_then(|window| window.to));
        sheet.fact("omega_adhesive_rad_s", machine.adhesive_speed());
        sheet.fact("coincidence_rad_s", machine.dangerous_speed_toward(speed));
        sheet.fact("casing_frequency_rad_s", machine.omega_c);
        sheet.fact("blade_frequency_rad_s", machine.omega_bd);
        sheet.fact("clearance_m", machine.clearance());
        sheet.fact("locked_amplitude_m", machine.locked_amplitude());
        if !scene.title.is_empty() {
            sheet.line(&scene.title);
        }
        if let Some(note) = scene.modes_note() {
            sheet.line(format!("{}.", capital(&note)));
        }
        let polygon = &machine.polygon;
        sheet.line(format!(
            "{} blades, {}: {} phase groups of {}, clearance {} m.",
            polygon.blades,
            count(u64::from(polygon.nodal_diameters), "nodal diameter"),
            polygon.sides,
            count(u64::from(polygon.blades_per_side), "blade"),
            short(machine.clearance())
        ));
        self.limits(&locks, damped).into_iter().for_each(|limits| sheet.line(limits));
        notes.iter().for_each(|note| sheet.line(format!("These numbers are {note}.")));
    }

    /// States the critical speed, the speeds at which it `locks`, and the dangerous coincidence;
    /// `None` without a critical speed.
    fn limits(&self, locks: &[LockWindow], damped: bool) -> Option<String> {
        let (machine, toward) = (&self.machine, self.fastest());
        let critical = machine.critical_speed()?;
        let zeta = short(machine.casing_damping_ratio);
        // On a lining, groups of more blades may lock at other speeds.
        let groups = if machine.lining.is_some() { " of two groups" } else { "" };
        let lock = match (all_speeds(locks), damped) {
            (lock, _) if lock.is_empty() => lock,
            (lock, true) => format!(", lock{groups} {lock} (zeta_c = {zeta})"),
            (lock, false) => {
                let without = all_speeds(&lock_windows(&machine.clone().undamped(), toward));
                format!(", lock{groups} {without} without damping, {lock} with zeta_c = {zeta}")
            }
        };
        let dangerous = machine.dangerous_speed_toward(toward);
        let dangerous = dangerous.map(|at| format!(", dangerous coincidence {}", speed(at)));
        let dangerous = dangerous.unwrap_or_default();
        Some(format!("Critical speed {}{lock}{dangerous}.", speed(critical)))
    }
}

/// Describes windows of rotor speeds, such as those of a lock; empty without one.
pub(super) fn all_speeds(windows: &[LockWindow]) -> String {
    let from = |window: &LockWindow| Some(window.from).filter(|from| *from > 0.0);
    let each = windows.iter().map(|window| span(from(window), window.to, 6));
    listed(&each.collect::<Vec<_>>(), "and")
}
