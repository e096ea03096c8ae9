//! What all views of `rubscope hbm` begin with: the machine, its limits, and the assumptions behind
//! the numbers, in sentences and as facts.

use super::{Request, notes, speeds_of};
use crate::report::Sheet;
use crate::report::line::capital;
use crate::report::number::{count, short, speed, speed_unit};
use rubscope_solver::harmonic::lock_window;
use rubscope_solver::model::Machine;

impl Request<'_> {
    /// Adds the machine and its limits. `damped` tells whether the view includes damping.
    pub(super) fn tell(&self, damped: bool, sheet: &mut Sheet) {
        let Self { scene, machine, .. } = self;
        self.facts(sheet);
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
        self.limits(damped).into_iter().for_each(|limits| sheet.line(limits));
        for note in notes(scene, machine) {
            sheet.line(format!("These numbers are {note}."));
        }
    }

    /// Names the critical speed, the lock and the dangerous coincidence; `None` without a critical
    /// speed.
    fn limits(&self, damped: bool) -> Option<String> {
        let (machine, toward) = (&self.machine, self.fastest());
        let critical = machine.critical_speed()?;
        let lock_of = |machine: &Machine| lock_window(machine, toward).map(speeds_of);
        let (zeta, unit) = (short(machine.casing_damping_ratio), speed_unit());
        // On a lining, groups of more blades may lock at other speeds.
        let groups = if machine.lining.is_some() { " of two groups" } else { "" };
        let lock = lock_of(machine).map(|lock| match damped {
            true => format!(", lock{groups} from {lock} {unit} (zeta_c = {zeta})"),
            false => {
                let without = lock_of(&machine.clone().undamped()).unwrap_or_default();
                format!(
                    ", lock{groups} from {without} {unit} without damping, {lock} with zeta_c = \
                     {zeta}"
                )
            }
        });
        let dangerous = machine.dangerous_speed_toward(toward);
        let dangerous = dangerous.map(|at| format!(", dangerous coincidence {}", speed(at)));
        let rest = [lock, dangerous].into_iter().flatten().collect::<String>();
        Some(format!("Critical speed {}{rest}.", speed(critical)))
    }
}
