//! The state of the run in words: its verdict as one sentence, the blades in contact and their
//! depth in a lining, and the lock and coincidence speeds.

use super::model::App;
use crate::sheet::number::count;
use crate::sheet::sentence::{Facts, Sentence};
use crate::tui::axis::readable;
use crate::tui::engine::{Answer, FORECAST_LIMIT, FullRun, FullRunState};
use crate::tui::knobs::KNOBS;
use crate::tui::text::few;
use crate::tui::trace::{Happening, Mark};
use rubscope_solver::harmonic;
use rubscope_solver::model::LockWindow;
use rubscope_solver::motion::{ActiveSet, Verdict};
use rubscope_solver::scene::ContactLaw;

impl App {
    /// Returns the run to its end; `None` until it is complete, and if it was given up.
    pub fn full_run(&self) -> Option<&FullRun> {
        match &self.results().full_run {
            Some(FullRunState::Done(run)) => Some(run),
            _ => None,
        }
    }

    /// Returns the verdict; `None` until the run is complete or its verdict is proved.
    pub fn verdict(&self) -> Option<Verdict> {
        self.results().verdict
    }

    /// Returns whether the run was given up because it takes too long.
    pub fn is_given_up(&self) -> bool {
        matches!(self.results().full_run, Some(FullRunState::GivenUp(_)))
    }

    /// Returns the headline of the run, in at most `width` columns.
    pub fn sentence(&self, width: usize) -> Sentence {
        if let Some(trouble) = &self.run.latest.trouble {
            let forms = [format!("The computation stopped: {trouble}."), "It stopped.".into()];
            return Sentence::of("STOPPED", forms, &[], width);
        }
        match &self.results().full_run {
            Some(FullRunState::Done(run)) => self.facts(run).sentence(width),
            Some(FullRunState::GivenUp(part)) => {
                let (limit, part) = (FORECAST_LIMIT.as_secs(), 100.0 * part);
                let forms = [
                    format!("{limit} s of work reached {part:.0} % of the run."),
                    format!("{part:.0} % in {limit} s."),
                ];
                Sentence::of(&self.proved().unwrap_or("NO FORECAST".into()), forms, &[], width)
            }
            Some(FullRunState::Computing(part)) => {
                let part = 100.0 * part;
                self.computing(&format!(", {part:.0} %"), width)
            }
            None => self.computing("", width),
        }
    }

    /// Returns the verdict in capitals, which may be proved before the end of the run; `None` if it
    /// is not known.
    fn proved(&self) -> Option<String> {
        Some(self.verdict()?.as_ref().to_uppercase())
    }

    /// Returns the headline while the run is computed: a proved verdict, or the latest older
    /// verdict with the knob value it belongs to.
    fn computing(&self, part: &str, width: usize) -> Sentence {
        let proved = if self.verdict().is_some() { "Proved. " } else { "" };
        let forms =
            [format!("{proved}Computing the run{part}."), format!("{proved}Computing{part}.")];
        match self.proved().or_else(|| self.older_answer()) {
            Some(answer) => Sentence::of(&answer, forms, &[], width),
            None => {
                let part = part.trim_start_matches(", ").to_string();
                Sentence::of("computing", [part.clone(), part], &[], width)
            }
        }
    }

    /// Returns the first word of the headline.
    pub fn verdict_word(&self) -> String {
        self.sentence(0).word
    }

    /// Returns the latest verdict as `at 405 rad/s: WHIRL` if its scene differs in one knob, or as
    /// `before: WHIRL` if no knob differs. `None` if more knobs differ, or no verdict is known.
    fn older_answer(&self) -> Option<String> {
        let Answer { scene, verdict } = self.run.answer.as_deref()?;
        let mut differ = KNOBS.iter().filter(|knob| knob.get(scene) != knob.get(&self.scene));
        let when = match (differ.next(), differ.next()) {
            (Some(knob), None) => format!("at {}", knob.text(scene)),
            (None, _) => "before".into(),
            _ => return None,
        };
        Some(format!("{when}: {}", verdict.as_ref().to_uppercase()))
    }

    /// Collects the facts for the sentence about a complete run.
    fn facts(&self, run: &FullRun) -> Facts {
        Facts {
            other: self.results().reference,
            certainty: self.results().sensitive.known(),
            ..run.facts.clone()
        }
    }

    /// Returns the contact state at the time shown: `free`, `touching 12`, `held on 6 + 21`.
    pub fn state_now(&self) -> String {
        let Some(moment) = self.shown() else { return "starting".into() };
        if moment.failure.is_some() {
            let grown = self.full_run().is_some_and(|run| run.facts.verdict == Verdict::Divergent);
            return if grown { "diverged" } else { "failed" }.into();
        }
        if self.has_lining() && moment.active_set == ActiveSet::Many {
            let touching = moment.gaps.iter().filter(|gap| **gap < 0.0).count();
            return match touching == moment.gaps.len() {
                true => "touching all".into(),
                false => format!("touching {}", count(touching as u64, "blade")),
            };
        }
        self.state_of(moment.active_set)
    }

    fn state_of(&self, active_set: ActiveSet) -> String {
        let blades = self.numbers_of(active_set.sides());
        match active_set {
            ActiveSet::Nothing => "free".into(),
            ActiveSet::Side(_) => format!("touching {blades}"),
            ActiveSet::Corner(..) => format!("held on {blades}"),
            ActiveSet::Many => "touching many".into(),
        }
    }

    /// Describes a change of contact, e.g. `impact on 6`.
    pub fn happening(&self, what: Happening) -> String {
        let blades = |sides: ActiveSet| self.numbers_of(sides.sides());
        match what {
            Happening::Impact(side) => format!("impact on {}", blades(ActiveSet::Side(side))),
            Happening::Contact(before, now) => match (before, now) {
                (ActiveSet::Corner(a, b), ActiveSet::Side(kept)) if kept == a || kept == b => {
                    let gone = blades(ActiveSet::Side(if kept == a { b } else { a }));
                    format!("release of {gone}, {} still touches", blades(now))
                }
                _ => self.state_of(now),
            },
            Happening::Release(ActiveSet::Many) => "release of all".into(),
            Happening::Release(gone) => format!("release of {}", blades(gone)),
        }
    }

    /// Returns the next change of contact after the time shown; `None` if there is none, or the run
    /// is not complete.
    pub fn next_change(&self) -> Option<Mark> {
        let now = self.now();
        self.full_run()?.marks.iter().find(|mark| mark.t_s > now).copied()
    }

    /// Returns the blades of some sides as text, e.g. `blades 6 + 21`.
    pub fn blades_of(&self, sides: impl Iterator<Item = u32>) -> String {
        let numbers = self.numbers_of(sides);
        match numbers.chars().any(|letter| matches!(letter, '+' | ',')) {
            _ if numbers.is_empty() => numbers,
            true => format!("blades {numbers}"),
            false => format!("blade {numbers}"),
        }
    }

    /// Returns the blade numbers of some sides as text, e.g. `6 + 21`; at most four sides.
    pub fn numbers_of(&self, sides: impl Iterator<Item = u32>) -> String {
        let mut all: Vec<Vec<u32>> =
            sides.take(4).map(|side| self.machine.first_of_side(side)).collect();
        all.sort_unstable();
        let groups: Vec<String> = all.iter().map(|blades| few(blades)).collect();
        groups.join(" + ")
    }
}

/// Gaps below this fraction of the clearance count as contact, where the contact state does not say
/// which blades touch.
const CLOSED: f64 = 1e-9;

/// Half width of the polygon chart, in corner amplitudes.
const MARGIN: f64 = 1.15;

impl App {
    /// Returns the half width of the polygon chart while the casing is inside \[m\].
    pub fn usual_reach(&self) -> f64 {
        let polygon = &self.machine.polygon;
        let corner = if polygon.has_corners() { polygon.delta.cos() } else { 1.0 };
        MARGIN * (self.roomiest() / corner).abs()
    }

    /// Returns the largest gap between a tip and the casing at rest \[m\]: that of the shortest
    /// tip, plus the out-of-roundness.
    pub fn roomiest(&self) -> f64 {
        let machine = &self.machine;
        let gaps =
            (0..machine.polygon.blades).map(|blade| machine.clearance() - machine.longer(blade));
        gaps.fold(f64::NEG_INFINITY, f64::max) + machine.out_of_round()
    }

    /// Returns whether the contact law is that of an elastic lining.
    pub fn has_lining(&self) -> bool {
        self.scene.solver.contact == ContactLaw::Smooth
    }

    /// Returns whether the blades rub at rest (negative clearance).
    pub fn is_pressed(&self) -> bool {
        self.machine.clearance() < 0.0
    }

    /// Returns the blades in contact at the time shown, numbered from 1.
    pub fn touching_blades(&self) -> Vec<u32> {
        let Some(moment) = self.shown() else { return Vec::new() };
        let polygon = &self.machine.polygon;
        let within = |most: f64| {
            let gaps = (1..=polygon.blades).zip(&moment.gaps);
            gaps.filter(|(_, gap)| **gap <= most).map(|(blade, _)| blade).collect()
        };
        match moment.active_set {
            _ if self.has_lining() => within(-f64::MIN_POSITIVE),
            ActiveSet::Many => within(CLOSED * polygon.clearance),
            touching => {
                touching.sides().flat_map(|side| self.machine.first_of_side(side)).collect()
            }
        }
    }

    /// Describes a gap \[m\]: the distance to the casing, or the depth in the lining if negative.
    pub fn gap_words(&self, gap: f64) -> String {
        match self.has_lining() && gap < 0.0 {
            true => format!("{} into the lining", readable(-gap, "m")),
            false if gap.abs() <= CLOSED * self.machine.polygon.clearance => "touches".into(),
            false => readable(gap, "m"),
        }
    }

    /// Returns the speed from which a lock with pushing contact exists \[rad/s\]; 0 if it exists at
    /// standstill, `None` if nothing locks (e.g. all blades rub).
    pub fn lock_speed(&self) -> Option<f64> {
        self.lock_window().map(|window| window.from)
    }

    /// Returns the speed range in which a lock with pushing contact exists, for the current
    /// direction of rotation; `None` if nothing locks.
    pub fn lock_window(&self) -> Option<LockWindow> {
        let [forward, backward] = &self.locks;
        let found = if self.speed() < 0.0 { backward } else { forward };
        *found.get_or_init(|| harmonic::lock_window(&self.machine, self.speed()))
    }

    /// Returns a note that the frequency-domain results assume equal blades in two modes; `None`
    /// unless the run computes every blade (the full model).
    pub fn tuned_note(&self) -> Option<&'static str> {
        self.scene.tuned_note().map(|_| "of equal blades, two modes")
    }

    /// Returns the dangerous coincidence speed, as a magnitude \[rad/s\]: that of the sum of the
    /// frequencies of casing and blades, or of their difference if `kappa (kappa + mu) < 0`. `None`
    /// if there is none.
    pub fn coincidence(&self) -> Option<f64> {
        self.machine.coincidence_felt_at(self.speed()).map(f64::abs)
    }
}
