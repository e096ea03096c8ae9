//! Where contact begins to last, over the pulse: the runs, the edge between two
//! pulses, the same edge with a parameter changed, and how it moves.
//!
//! An edge is where one run ends in decay and its neighbour does not, so it has no
//! equation to be differentiated; it is searched again with the parameter changed both
//! ways.

use std::sync::atomic::{AtomicU64, Ordering};

use super::parameters::Parameter;
use crate::motion::{GoOn, Verdict, run_to_verdict, run_with_sensitivity};
use crate::numeric::bisection::try_bisected;
use crate::scene::keys::PULSE;
use crate::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SolverKind};
use crate::tolerances::{
    LASTING_CHANGE, LASTING_EDGE, LASTING_EDGE_BY_STEPS, LASTING_REACH, LASTING_REACH_BY_STEPS,
    LASTING_SMOOTH, LASTING_WORK,
};

/// How much further an edge that is not smooth is looked at once more: the explicit
/// solver knows the length of a pulse by its steps.
const FURTHER: f64 = 10.0;

/// The runs of one scene under one law, over pulses and values of parameters.
pub(super) struct Edges<'a> {
    scene: CheckedScene,
    go_on: GoOn<'a>,
    runs: AtomicU64,
}

/// A parameter and its changed value.
pub(super) type Change<'a> = (&'a Parameter, f64);

/// Whether contact lasts without a break, by the verdict.
pub(super) fn lasts(verdict: Verdict) -> bool {
    verdict.keeps_contact()
}

/// The scene under a law, by the event solver where that knows it.
fn under(scene: &CheckedScene, law: ContactLaw) -> Option<CheckedScene> {
    let mut scene = Scene::clone(scene);
    scene.solver.contact = law;
    scene.solver.kind = SolverKind::Explicit;
    if law == ContactLaw::Unilateral {
        let reference = scene.as_reference();
        if let Ok(reference) = reference.checked() {
            return Some(reference);
        }
    }
    scene.checked().ok()
}

/// How much work one run may be: steps times coordinates, or a hundred for each casing
/// period.
fn work(scene: &CheckedScene) -> f64 {
    let (end_s, machine) = (scene.solver.end_s, scene.machine());
    match (scene.solver.kind, scene.solver.model) {
        (SolverKind::Event, _) => 100.0 * end_s * machine.omega_c,
        (_, ModelSize::Full) => end_s / scene.solver.step_s * machine.polygon.sides as f64,
        _ => 4.0 * end_s / scene.solver.step_s,
    }
}

impl<'a> Edges<'a> {
    /// Of a scene under a law.
    ///
    /// # Errors
    /// No solver takes the scene under this law, or it is too long to be run many
    /// times; the reason in words.
    pub(super) fn of(
        scene: &CheckedScene,
        law: ContactLaw,
        go_on: GoOn<'a>,
    ) -> Result<Self, String> {
        let Some(scene) = under(scene, law) else {
            return Err(format!("no solver takes this scene under the {law} law"));
        };
        if work(&scene) > LASTING_WORK {
            return Err("not searched: the run is too long for a thousand runs".to_string());
        }
        Ok(Self { scene, go_on, runs: AtomicU64::new(0) })
    }

    /// The scene that is run.
    pub(super) fn scene(&self) -> &CheckedScene {
        &self.scene
    }

    /// The runs so far.
    pub(super) fn runs(&self) -> u64 {
        self.runs.load(Ordering::Relaxed)
    }

    /// The verdict under another pulse and, where given, another value of a parameter.
    pub(super) fn verdict(&self, pulse: f64, changed: Option<Change<'_>>) -> Option<Verdict> {
        self.runs.fetch_add(1, Ordering::Relaxed);
        let mut scene = match changed {
            None => Scene::clone(&self.scene),
            // What the key does not allow is as a run that fails.
            Some((parameter, value)) => match parameter.set(&self.scene, value) {
                Ok(scene) => scene,
                Err(_) => return Some(Verdict::Failed),
            },
        };
        scene.operation.pulse_n = pulse;
        let Ok(scene) = scene.checked() else { return Some(Verdict::Failed) };
        run_to_verdict(&scene, self.go_on).map(|reached| reached.verdict)
    }

    /// Whether a tiny change makes another verdict of this pulse.
    pub(super) fn is_sensitive(&self, pulse: f64) -> Option<bool> {
        self.runs.fetch_add(1, Ordering::Relaxed);
        let scene = self.scene.perturbed(|scene| scene.operation.pulse_n = pulse);
        run_with_sensitivity(&scene, self.go_on).map(|(_, sensitive)| sensitive)
    }

    /// `d ln(edge)/d ln(parameter)`, where the next edge is not nearer than by a part
    /// `room` of this one; none inside where the edge is not smooth, none where told to
    /// stop.
    pub(super) fn sensitivity(
        &self,
        parameter: &Parameter,
        edge: f64,
        room: f64,
    ) -> Option<Option<f64>> {
        let value = parameter.of(&self.scene);
        let rigid = self.scene.solver.model == ModelSize::Rigid && parameter.is_of_blades();
        if value == 0.0 || parameter.path == PULSE || rigid {
            return Some(Some(0.0));
        }
        let reach = room.min(match self.scene.solver.kind {
            SolverKind::Explicit => LASTING_REACH_BY_STEPS,
            SolverKind::Event => LASTING_REACH,
        });
        match self.moved(parameter, value, edge, reach)? {
            None => self.moved(parameter, value, edge, room.min(FURTHER * reach)),
            found => Some(found),
        }
    }

    /// How well the edge of the limit is worth knowing: of the explicit solver it is
    /// where contacts happen to fall among steps.
    pub(super) fn finest(&self) -> f64 {
        match self.scene.solver.kind {
            SolverKind::Explicit => LASTING_EDGE_BY_STEPS,
            SolverKind::Event => LASTING_EDGE,
        }
    }

    /// The edge of lasting from a pulse that does not last to one that does, either
    /// way; the nearest found that lasts.
    pub(super) fn between(
        &self,
        [not, lasting]: [f64; 2],
        part: f64,
        changed: Option<Change<'_>>,
    ) -> Option<f64> {
        let lasts = |pulse| self.verdict(pulse, changed).map(lasts).ok_or(());
        try_bisected([not, lasting], part, lasts).ok().map(|[_, lasting]| lasting)
    }

    /// `d ln(edge)/d ln(parameter)` by two central differences, of which the second
    /// has half the change; none inside where they do not agree: the edge is not
    /// smooth there. None where told to stop.
    fn moved(
        &self,
        parameter: &Parameter,
        value: f64,
        edge: f64,
        reach: f64,
    ) -> Option<Option<f64>> {
        let mut slopes = [None; 2];
        for (slope, part) in slopes.iter_mut().zip([1.0, 0.5]) {
            let change = part * LASTING_CHANGE * reach;
            let mut ends = [None; 2];
            for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
                *end = self.near(parameter, value * (1.0 + sign * change), edge, reach)?;
            }
            *slope = match ends {
                [Some(up), Some(down)] => Some((up / down).ln() / (2.0 * change)),
                _ => None,
            };
        }
        let [Some(wide), Some(narrow)] = slopes else { return Some(None) };
        let smooth = (wide - narrow).abs() <= LASTING_SMOOTH * narrow.abs().max(1.0);
        // The error of a central difference is of second order.
        Some(smooth.then_some((4.0 * narrow - wide) / 3.0))
    }

    /// The same edge with a parameter changed; none inside where it is not near.
    pub(super) fn near(
        &self,
        parameter: &Parameter,
        value: f64,
        edge: f64,
        reach: f64,
    ) -> Option<Option<f64>> {
        let changed = Some((parameter, value));
        let [not, lasting] = [1.0 - reach, 1.0 + reach].map(|part| part * edge);
        if lasts(self.verdict(not, changed)?) || !lasts(self.verdict(lasting, changed)?) {
            return Some(None);
        }
        let part = self.finest();
        self.between([not, lasting], part, changed).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::to_the_end;
    use crate::study::margins::{CLEARANCE, parameter, touching};

    fn scene(name: &str, changes: &[(&str, &str)]) -> CheckedScene {
        Scene::builtin(name).unwrap().with(changes).unwrap()
    }

    #[test]
    fn work_goes_with_the_length_of_the_run() {
        let base = scene("paper-nd3", &[("solver.end_s", "0.1"), ("solver.step_s", "1e-6")]);
        let full = scene(
            "paper-nd3",
            &[("solver.model", "full"), ("solver.end_s", "0.1"), ("solver.step_s", "1e-6")],
        );
        let events = scene("slip", &[("solver.end_s", "2")]);
        let expected = 200.0 * events.machine().omega_c;
        for (scene, expected) in [(base, 4e5), (full, 22e5), (events, expected)] {
            assert!((work(&scene) / expected - 1.0).abs() < 1e-12, "{}", work(&scene));
        }
        // Some of them are too long.
        let of = |end| {
            let scene = scene("slip", &[("solver.end_s", end)]);
            Edges::of(&scene, ContactLaw::Unilateral, &to_the_end).is_ok()
        };
        assert!(of("100") && !of("1000"));
    }

    #[test]
    fn a_pulse_at_the_touch_is_sensitive_and_one_far_from_it_is_not() {
        let scene = scene("slip", &[("solver.end_s", "0.02"), ("operation.pulse_n", "1000")]);
        let edges = Edges::of(&scene, ContactLaw::Unilateral, &to_the_end).unwrap();
        let touch = touching::limit(&scene).value.unwrap();
        assert_eq!(edges.is_sensitive(touch), Some(true));
        assert_eq!(edges.is_sensitive(0.5 * touch), Some(false));
    }
    #[test]
    fn an_edge_is_near_only_between_a_pulse_that_does_not_last_and_one_that_does() {
        let scene = scene("paper-nd3", &[]);
        let edges = Edges::of(&scene, ContactLaw::Bilateral, &to_the_end).unwrap();
        let clearance = parameter(CLEARANCE).unwrap();
        let near =
            |edge: f64| edges.near(clearance, clearance.of(&scene), edge, LASTING_REACH).unwrap();
        // The zone of the paper begins at 376,620 N.
        let found = near(3.75e5).unwrap();
        assert!((found / 376_620.0 - 1.0).abs() < 1e-5, "{found}");
        assert_eq!((near(3.6e5), near(3.95e5)), (None, None));
    }
}
