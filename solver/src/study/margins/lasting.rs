//! The smallest pulse after which contact lasts without a break, under one law: runs over
//! pulses at equal factors, bisection where lasting begins and ends, and how such an edge
//! moves with a parameter.
//!
//! Lasting pulses come in bands. Where every larger pulse that was tried lasts too, that last
//! band is the *zone*, and the limit is its beginning; bands below it are *islands*. Without a
//! zone the limit is the beginning of the first island. A band thinner than the factor between
//! two pulses is missed.
//!
//! An edge is where one run ends in decay and its neighbour does not, so it has no equation to
//! be differentiated; it is searched again with the parameter changed both ways.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use serde::Serialize;

use super::limit::{Limit, LimitName, Sensitivities};
use super::parameters::{CLEARANCE, Parameter, acting, is_length, parameter};
use super::touching;
use crate::motion::{GoOn, Verdict, run_to_verdict, run_with_sensitivity};
use crate::numeric::bisection::{try_bisected, try_cut};
use crate::scene::keys::PULSE;
use crate::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SolverKind};
use crate::tolerances::{
    LASTING_CHANGE, LASTING_CUT, LASTING_EDGE, LASTING_EDGE_BY_STEPS, LASTING_PART, LASTING_REACH,
    LASTING_REACH_BY_STEPS, LASTING_SMOOTH, LASTING_WORK, LASTING_ZONE,
};

/// Pulses tried in each decade by the explicit solver: every 7.5 %.
const PULSES_PER_DECADE: u32 = 32;
/// The same by the event solver, whose runs take a hundredth of the time: every 0.45 %.
const PULSES_PER_DECADE_BY_EVENTS: u32 = 512;
/// Decades above the touching pulse that are searched; further where the pulse of the
/// scene is.
const DECADES: f64 = 3.5;
/// Most decades, where the scene has a pulse far from touching.
const MOST_DECADES: f64 = 6.0;

/// Pulses in a row that last.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Band {
    /// The smallest \[N\].
    pub from_n: f64,
    /// The largest; none for the zone, up to the largest that was tried \[N\].
    pub to_n: Option<f64>,
    /// How they last.
    pub verdicts: Vec<Verdict>,
    /// Whether a tiny change makes another verdict in its middle.
    pub sensitive: bool,
}

impl Band {
    /// Whether a pulse is in it.
    #[must_use]
    pub fn holds(&self, pulse: f64) -> bool {
        let size = pulse.abs();
        pulse * self.from_n > 0.0
            && size >= self.from_n.abs()
            && self.to_n.is_none_or(|to| size <= to.abs())
    }
}

/// The smallest pulse that lasts under a law, as a limit, and the runs it took; none
/// where `go_on` said no on the way.
pub fn lasting_pulse(
    scene: &CheckedScene,
    law: ContactLaw,
    go_on: GoOn<'_>,
) -> Option<(Limit, u64)> {
    let present = scene.operation.pulse_n;
    let name = LimitName::lasting(law, scene.solver.contact);
    let none = |note: String| {
        let mut limit = Limit::new(name, None, Some(present));
        (limit.contact, limit.note) = (Some(law), Some(note));
        limit
    };
    let edges = match Edges::of(scene, law, go_on) {
        Ok(edges) => edges,
        Err(why) => return Some((none(why), 0)),
    };
    let Some(pulses) = pulses(scene, edges.scene().solver.kind) else {
        return Some((none(touching::why_none(scene).to_string()), 0));
    };
    let bands = bands(&edges, &pulses)?;
    let Some(place) = beginning(&bands) else {
        let times = pulses.last().zip(pulses.first()).map_or(1.0, |(last, first)| last / first);
        let note = format!(
            "nothing lasts up to {times:.0} times the touching pulse, tried every {:.2} %",
            100.0 * step(&pulses)
        );
        return Some((none(note), edges.runs()));
    };
    let mut limit = Limit::new(name, bands.get(place).map(|band| band.from_n), Some(present));
    limit.contact = Some(law);
    let by = sensitivities(&edges, &bands, place)?;
    limit.sensitivities = Sensitivities(by);
    limit.note = Some(told(&bands, place, &pulses));
    limit.bands = bands;
    Some((limit, edges.runs()))
}

/// The band with which the limit begins: the zone, or else the first.
fn beginning(bands: &[Band]) -> Option<usize> {
    let zone = bands.iter().rposition(|band| band.to_n.is_none());
    zone.or((!bands.is_empty()).then_some(0))
}

/// What the bands are, in words: what was tried, and not more.
fn told(bands: &[Band], place: usize, pulses: &[f64]) -> String {
    let zone = bands.get(place).is_some_and(|band| band.to_n.is_none());
    let tried = format!("tried every {:.2} %", 100.0 * step(pulses));
    let count = |count: usize| match count {
        1 => "one island".to_string(),
        count => format!("{count} islands"),
    };
    match (zone, bands.len()) {
        (true, 1) => format!("every larger pulse lasts, {tried}"),
        (true, all) => {
            format!("every larger pulse lasts, {tried}, and smaller ones in {}", count(all - 1))
        }
        (false, 1) => format!("one island was found, {tried}"),
        (false, all) => format!("the first of {} that were found, {tried}", count(all)),
    }
}

/// How much larger each pulse is than the one before, as a part of it.
fn step(pulses: &[f64]) -> f64 {
    match pulses {
        [first, second, ..] => second / first - 1.0,
        _ => 0.0,
    }
}

/// The pulses that are tried, from just below the one that touches.
fn pulses(scene: &CheckedScene, kind: SolverKind) -> Option<Vec<f64>> {
    let present = scene.operation.pulse_n;
    let touch = touching::smallest(scene)?.pulse_n;
    let start = touch * (1.0 - LASTING_EDGE);
    let reach = (1.5 * present / start).log10();
    let decades = if reach.is_finite() { reach.clamp(DECADES, MOST_DECADES) } else { DECADES };
    let each = f64::from(match kind {
        SolverKind::Explicit => PULSES_PER_DECADE,
        SolverKind::Event => PULSES_PER_DECADE_BY_EVENTS,
    });
    let count = (decades * each).ceil() as u32;
    Some((0..=count).map(|k| start * 10_f64.powf(f64::from(k) / each)).collect())
}

/// Where pulses last; the edge at which the limit begins to its last digits, the
/// others to `LASTING_PART`. None where told to stop.
fn bands(edges: &Edges<'_>, pulses: &[f64]) -> Option<Vec<Band>> {
    let mut found: Vec<Band> = Vec::new();
    let mut before: Option<(f64, bool)> = None;
    let verdicts: Option<Vec<Verdict>> =
        pulses.par_iter().map(|pulse| edges.verdict(*pulse, None)).collect();
    for (&pulse, verdict) in pulses.iter().zip(verdicts?) {
        let now = lasts(verdict);
        match (before, now) {
            (Some((_, true)), true) => {
                if let Some(band) = found.last_mut()
                    && !band.verdicts.contains(&verdict)
                {
                    band.verdicts.push(verdict);
                }
            }
            (less, true) => {
                let less = less.map_or(pulse, |(less, _)| less);
                let from_n = edges.between([less, pulse], LASTING_PART)?;
                let verdicts = vec![verdict];
                found.push(Band { from_n, to_n: None, verdicts, sensitive: false });
            }
            (Some((less, true)), false) => {
                let to_n = edges.between([pulse, less], LASTING_PART)?;
                if let Some(band) = found.last_mut() {
                    band.to_n = Some(to_n);
                }
            }
            (_, false) => {}
        }
        before = Some((pulse, now));
    }
    for band in &mut found {
        let to = band.to_n.or(pulses.last().copied()).unwrap_or(band.from_n);
        let middle = (band.from_n * to).sqrt().copysign(to);
        band.sensitive = edges.is_sensitive(middle)?;
    }
    // A few of the largest pulses are no zone, but an island at the end of the search.
    if let Some((band, largest)) = found.last_mut().zip(pulses.last())
        && band.to_n.is_none()
        && (largest / band.from_n) < LASTING_ZONE
    {
        band.to_n = Some(*largest);
    }
    if let Some(band) = beginning(&found).and_then(|place| found.get_mut(place)) {
        // The edge is known to a part that the pulse just below it does not last.
        let less = band.from_n * (1.0 - LASTING_PART);
        band.from_n = edges.between([less, band.from_n], edges.finest())?;
    }
    Some(found)
}

/// How the edge with which a band begins moves with every parameter.
fn sensitivities(
    edges: &Edges<'_>,
    bands: &[Band],
    place: usize,
) -> Option<Vec<(&'static str, Option<f64>)>> {
    let Some(band) = bands.get(place) else { return Some(Vec::new()) };
    // The next edge on each side must not be taken for this one.
    let before = place.checked_sub(1).and_then(|place| bands.get(place)?.to_n);
    let room = |other: Option<f64>| other.map_or(1.0, |other| (other / band.from_n - 1.0).abs());
    let most = 0.3 * room(before).min(room(band.to_n));
    let by = |parameter: &Parameter| {
        // The lengths matter by their clearance alone, whose sensitivity says theirs.
        let found = match is_length(parameter.path) {
            true => None,
            false => edges.sensitivity(parameter, band.from_n, most)?,
        };
        Some((parameter.path, found))
    };
    let parameters: Vec<_> = acting(edges.scene()).collect();
    let mut found: Vec<_> = parameters.into_par_iter().map(by).collect::<Option<_>>()?;
    let of_clearance = found.iter().find(|(path, _)| *path == CLEARANCE).and_then(|(_, by)| *by);
    for (path, by) in found.iter_mut().filter(|(path, _)| is_length(path)) {
        *by =
            of_clearance.zip(parameter(path)).map(|(by, length)| by * length.lever(edges.scene()));
    }
    Some(found)
}

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
    fn between(&self, [not, lasting]: [f64; 2], part: f64) -> Option<f64> {
        let lasts = |pulse| self.verdict(pulse, None).map(lasts).ok_or(());
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
        // What lasts is run for long, and what does not ends early: so the edge is come to by
        // small cuts, and the answers that follow from it are not asked again.
        let (ends, part) = ([not, lasting], self.finest());
        let asked = |pulse: f64| self.verdict(pulse, changed).map(lasts).ok_or(());
        let [short, enough] = try_cut(ends, part, LASTING_CUT, asked).ok()?;
        let sense = (lasting - not).signum();
        let known = |pulse: f64| match pulse {
            _ if (pulse - short) * sense <= 0.0 => Ok(false),
            _ if (pulse - enough) * sense >= 0.0 => Ok(true),
            _ => asked(pulse),
        };
        try_bisected(ends, part, known).ok().map(|[_, edge]| Some(edge))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::to_the_end;
    use crate::scene::Scene;

    fn scene(name: &str, changes: &[(&str, &str)]) -> CheckedScene {
        Scene::builtin(name).unwrap().with(changes).unwrap()
    }

    fn band(from_n: f64, to_n: Option<f64>) -> Band {
        Band { from_n, to_n, verdicts: vec![Verdict::Slip], sensitive: false }
    }

    #[test]
    fn the_limit_begins_with_the_zone_or_else_with_the_first_island() {
        let islands = [band(1.0, Some(2.0)), band(3.0, Some(4.0))];
        let zone = [band(1.0, Some(2.0)), band(3.0, Some(4.0)), band(5.0, None)];
        for (bands, place, words) in [
            (
                &zone[..],
                2,
                "every larger pulse lasts, tried every 7.00 %, and smaller ones in 2 islands",
            ),
            (
                &zone[1..],
                1,
                "every larger pulse lasts, tried every 7.00 %, and smaller ones in one island",
            ),
            (&zone[2..], 0, "every larger pulse lasts, tried every 7.00 %"),
            (&islands[..], 0, "the first of 2 islands that were found, tried every 7.00 %"),
            (&islands[1..], 0, "one island was found, tried every 7.00 %"),
        ] {
            assert_eq!(beginning(bands), Some(place));
            assert_eq!(told(bands, place, &[100.0, 107.0, 114.49]), words);
        }
        assert_eq!(beginning(&[]), None);
    }

    #[test]
    fn pulses_go_from_the_touch_beyond_that_of_the_scene() {
        let of = |pulse| scene("paper-nd3", &[("operation.pulse_n", pulse)]);
        let tried = |pulse, kind| pulses(&of(pulse), kind).unwrap();
        let touch = touching::limit(&scene("paper-nd3", &[])).value.unwrap();
        for (pulse, count) in [("1e6", 113), ("1e8", 149), ("1e12", 193), ("-1e8", 149)] {
            let all = tried(pulse, SolverKind::Explicit);
            let finer = tried(pulse, SolverKind::Event);
            assert!((16 * (count - 2) + 2..=16 * (count - 1) + 1).contains(&finer.len()));
            assert_eq!(finer[0], all[0], "{pulse}");
            assert_eq!(all.len(), count, "{pulse}");
            let start = all[0].abs();
            assert!(start < touch && start > touch * (1.0 - 1e-9), "{pulse}: {start}");
            assert!(all.iter().all(|tried| (*tried < 0.0) == pulse.starts_with('-')));
            let factor = all[1] / all[0];
            assert!((factor.powi(32) - 10.0).abs() < 1e-9, "{pulse}: {factor}");
        }
    }

    #[test]
    fn the_last_pulses_are_a_zone_only_where_they_are_many() {
        // The zone of the paper begins at 376,620 N.
        let scene = scene("paper-nd3", &[]);
        let edges = Edges::of(&scene, ContactLaw::Bilateral, &to_the_end).unwrap();
        for (factor, is_zone) in [(0.99 * LASTING_ZONE, false), (1.01 * LASTING_ZONE, true)] {
            let all = [3.5e5, 376_621.0, 5e5, factor * 376_621.0];
            let found = bands(&edges, &all).unwrap();
            let [band] = found.as_slice() else { panic!("{found:?}") };
            assert_eq!(band.to_n, (!is_zone).then_some(all[3]));
            assert!(!lasts(edges.verdict(band.from_n * (1.0 - 1e-5), None).unwrap()));
        }
    }

    #[test]
    fn a_band_lasts_from_its_beginning_to_its_end_and_no_further() {
        let scene = scene("slip", &[("solver.end_s", "0.02")]);
        let edges = Edges::of(&scene, ContactLaw::Unilateral, &to_the_end).unwrap();
        let pulses = pulses(&scene, SolverKind::Event).unwrap();
        let found = bands(&edges, &pulses).unwrap();
        let lasts = |pulse| lasts(edges.verdict(pulse, None).unwrap());
        let place = beginning(&found).unwrap();
        for (at, band) in found.iter().enumerate() {
            // The edge of the limit itself is known better.
            let part = if at == place { 1.1 * LASTING_EDGE } else { 1.1 * LASTING_PART };
            assert!(lasts(band.from_n) && !lasts(band.from_n * (1.0 - part)), "{band:?}");
            if let Some(to) = band.to_n {
                assert!(to > band.from_n && lasts(to), "{band:?}");
                assert!(!lasts(to * (1.0 + 1.1 * LASTING_PART)), "{band:?}");
            }
        }
    }
}

#[cfg(test)]
mod edge_tests {
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
