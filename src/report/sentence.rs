//! What the motion of a run is, in one sentence of plain words, and how it came there in a
//! second one. Every sentence has a long and a short form.

use std::fmt;

use super::line::capital;
use super::number::{grouped, rounded, short, with_unit};
use rubscope_solver::harmonic::{lock_growth, roundness_needed};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{Certainty, Failure, FailureReason, RunReport, Verdict};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// Separators: after the verdict, and between the two sentences.
const APART: [&str; 2] = ["  ", " "];
/// A sentence in its long and its short form.
type Forms = [String; 2];

/// Most blades that are named one by one.
const NAMED: usize = 4;

/// Facts of a run from which its sentences are made.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Blades in contact at the end.
    pub blades: Vec<u32>,
    /// Those of `blades` whose contact force pulls.
    pub pulling: Vec<u32>,
    /// Total number of impacts.
    pub touches: u64,
    /// The contact law.
    pub law: ContactLaw,
    /// Whether all blades rub the lining at rest.
    pub pressed: bool,
    /// Whether the casing is damped, so that it comes to rest after the last contact.
    pub damped: bool,
    /// Rotor speed at which a lock separated during the run \[rad/s\].
    pub broken: Option<f64>,
    /// Rotor speed at which a run-up (true) or run-down came to its last contact \[rad/s\].
    pub caught: Option<(f64, bool)>,
    /// Why the run stopped early, if it did.
    pub failure: Option<Failure>,
    /// Whether a contact force pulled during the run.
    pub pulled: bool,
    /// Verdict of the event solver, whose contact only pushes, if it is known.
    pub other: Option<Verdict>,
    /// Result of the sensitivity check.
    pub certainty: Certainty,
    /// Growth rate of a deviation from an unstable lock at constant speed \[1/s\].
    pub growth: Option<f64>,
    /// Largest out-of-roundness of the casing that allows the lock, if that is demanding \[m\].
    pub round: Option<f64>,
    /// Whether the tips differ in length, so that errors of the blade angles matter.
    pub angles: bool,
}

/// A verdict in words that fit a given width.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sentence {
    /// The verdict, one word in capitals.
    pub word: String,
    /// Sentence on the motion at the end.
    pub what: String,
    /// Sentence on how the motion got there, if there is one and it fits.
    pub history: Option<String>,
    /// Whether the history says that the result is suspect (shown in red).
    pub wrong: bool,
}

impl fmt::Display for Sentence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [after_word, between] = APART;
        f.write_str(&self.word)?;
        if !self.what.is_empty() {
            write!(f, "{after_word}{}", self.what)?;
        }
        self.history.iter().try_for_each(|history| write!(f, "{between}{history}"))
    }
}

impl Sentence {
    /// Creates the word with the long form of a sentence, or the short one where the long one
    /// does not fit in so many columns.
    pub fn of(word: &str, forms: Forms, width: usize) -> Self {
        Self::with_notes(word, forms, &[], width)
    }

    /// Same, with the first of these texts that fits beside one of the forms.
    fn with_notes(word: &str, forms: Forms, notes: &[String], width: usize) -> Self {
        let sentence = |what: &String, history: Option<&String>| Self {
            word: word.to_string(),
            what: what.clone(),
            history: history.cloned(),
            wrong: false,
        };
        let fits = |sentence: &Self| sentence.to_string().chars().count() <= width;
        let both = notes.iter().flat_map(|note| forms.iter().map(move |what| (what, Some(note))));
        let mut all = both.chain(forms.iter().map(|what| (what, None)));
        let fitting = all.find_map(|(what, note)| Some(sentence(what, note)).filter(&fits));
        fitting.unwrap_or_else(|| sentence(&forms[1], None))
    }
}

impl Facts {
    /// Creates the facts known from the scene, the machine and the groups in contact (blades and
    /// contact force) at the end; all others are empty.
    pub fn at(
        verdict: Verdict,
        (scene, machine, speed): (&Scene, &Machine, f64),
        contacts: impl Iterator<Item = (Vec<u32>, f64)>,
    ) -> Self {
        let (pull, push): (Vec<_>, Vec<_>) = contacts.partition(|(_, force)| *force > 0.0);
        let blades = |groups: Vec<(Vec<u32>, f64)>| groups.into_iter().flat_map(|group| group.0);
        let pulling: Vec<u32> = blades(pull).collect();
        let locked = verdict == Verdict::Locked;
        let steady = scene.operation.speed_ramp_rad_s2 == 0.0;
        let may_grow = locked && steady && scene.solver.model != ModelSize::Rigid;
        Self {
            verdict,
            blades: pulling.iter().copied().chain(blades(push)).collect(),
            pulling,
            touches: 0,
            law: scene.solver.contact,
            pressed: scene.clearance() < 0.0,
            damped: machine.casing_damping_ratio > 0.0,
            broken: None,
            caught: None,
            failure: None,
            pulled: false,
            other: None,
            certainty: Certainty::default(),
            growth: may_grow.then(|| lock_growth(machine, speed)).flatten(),
            round: locked.then(|| roundness_needed(machine, speed)).flatten(),
            angles: scene.has_other_tips(),
        }
    }

    /// Collects the facts of a run.
    pub fn of(report: &RunReport) -> Self {
        let outcome = &report.outcome;
        let end = (&*report.scene, &report.end_machine, report.end_speed_rad_s);
        let contacts = outcome.contacts.iter();
        let contacts = contacts.map(|group| (group.blades.clone(), group.multiplier_n));
        Self {
            touches: report.impact_count,
            broken: report.broken.map(|(_, speed)| speed),
            caught: report.caught,
            failure: report.failure.clone(),
            pulled: report.checks.tensile_steps > 0,
            other: report.pushes_only,
            certainty: Certainty {
                sensitive: outcome.sensitive == Some(true),
                ends_otherwise: outcome.ends_otherwise == Some(true),
                depends_on_step: outcome.depends_on_step,
            },
            ..Self::at(outcome.verdict, end, contacts)
        }
    }

    /// Returns the sentences for so many columns; from 40 on they fit.
    pub fn sentence(&self, width: usize) -> Sentence {
        let word = self.verdict.as_ref().to_uppercase();
        let (notes, wrong) = self.notes();
        let [_, between] = APART;
        let all = |form: usize| notes.iter().map(|note| note[form].as_str()).collect::<Vec<_>>();
        let mut texts: Vec<String> = [0, 1].map(|form| all(form).join(between)).into();
        texts.extend(notes.first().map(|first| first[1].clone()));
        texts.retain(|text| !text.is_empty());
        Sentence { wrong, ..Sentence::with_notes(&word, self.forms(), &texts, width) }
    }

    /// Returns what the motion is.
    fn forms(&self) -> Forms {
        if let (Some(speed), Some(after)) = (self.broken, self.after_a_lock()) {
            let at = rad_s(speed);
            return [format!("The lock breaks at {at}; then {after}."), "The lock breaks.".into()];
        }
        match self.verdict {
            Verdict::Locked => self.held(),
            Verdict::Adhesive => self.pulled(),
            Verdict::Slip if self.pressed => plain([
                "All blades press the lining, and the wave slips along them.",
                "The wave slips.",
            ]),
            Verdict::Slip => plain([
                "A blade always touches, and the wave slips along the blades.",
                "The wave slips along the blades.",
            ]),
            Verdict::Whirl => plain([
                "The contact runs from blade to blade and keeps them swinging.",
                "The contact swings the blades.",
            ]),
            Verdict::Forced if self.pressed => plain([
                "All blades press the lining, and the longer ones drag the wave.",
                "Longer blades drag the wave.",
            ]),
            Verdict::Forced => plain([
                "One blade or group presses without a break and drags the wave.",
                "One blade drags it.",
            ]),
            Verdict::Bounce => self.bounced(),
            Verdict::Decay => self.decayed(),
            Verdict::Divergent => {
                let why = self.failure.as_ref().map(|failure| why(&failure.reason));
                let why = why.map_or(String::new(), |why| format!(": {why}"));
                [format!("The motion grows without end{why}."), "It grows without end.".into()]
            }
            Verdict::Failed => self.failed(),
        }
    }

    /// Describes the motion after a lock broke.
    fn after_a_lock(&self) -> Option<&'static str> {
        match self.verdict {
            Verdict::Decay => Some(self.rest()),
            Verdict::Bounce => Some("blades and casing bounce"),
            Verdict::Slip => Some("the wave slips along"),
            Verdict::Whirl => Some("the contact runs round"),
            Verdict::Forced => Some("one blade drags the wave"),
            _ => None,
        }
    }

    /// Describes the final motion of a casing without contact.
    fn rest(&self) -> &'static str {
        if self.damped { "the casing comes to rest" } else { "the casing swings on freely" }
    }

    fn held(&self) -> Forms {
        let [hold, push] = match self.blades.len() {
            1 => ["holds", "it pushes"],
            2 => ["hold", "both push"],
            _ => ["hold", "all push"],
        };
        let [who, few] = [named(&self.blades), counted(&self.blades)];
        [format!("{who} {hold} the casing's wave; {push}."), format!("{few} {hold} it; {push}.")]
    }

    fn pulled(&self) -> Forms {
        let pulls = match self.pulling.as_slice() {
            [] => "one blade pulls".to_string(),
            [blade] => format!("blade {blade} pulls"),
            several => format!("{} blades pull", several.len()),
        };
        let pushing = self.blades.iter().find(|blade| !self.pulling.contains(blade));
        let long = match (pushing, &*self.blades, &*self.pulling) {
            (Some(push), [_, _], [_]) => {
                format!("Blade {push} pushes the wave and {pulls} it: no real contact can.")
            }
            _ => format!("{}: no real contact can.", capital(&pulls)),
        };
        [long, "A pull holds the wave.".into()]
    }

    fn bounced(&self) -> Forms {
        if self.touches == 0 {
            return plain(["Blades and casing meet and part again.", "They meet and part."]);
        }
        let again = if self.touches > 1 { " again and again" } else { "" };
        let touches = touches(self.touches);
        [
            format!("Blades and casing meet and part{again}: {touches}."),
            "They meet and part.".into(),
        ]
    }

    fn decayed(&self) -> Forms {
        let rest = self.rest();
        if self.pressed {
            return plain([
                "The wave dies away; the blades rub the lining as at rest.",
                "The wave dies away.",
            ]);
        }
        if self.touches == 0 {
            return [format!("No blade touches; {rest}."), "No blade touches.".into()];
        }
        let touches = touches(self.touches);
        let who = match self.law {
            ContactLaw::Smooth => "Blades leave the lining",
            ContactLaw::Unilateral | ContactLaw::Bilateral => "The blades let go",
        };
        [format!("{who} after {touches}; {rest}."), "The blades let go.".into()]
    }

    fn failed(&self) -> Forms {
        let Some(failure) = &self.failure else {
            return plain(["The computation stops before the end.", "The computation stops."]);
        };
        let (at, why) = (with_unit(failure.t_s, 3, "s"), why(&failure.reason));
        [format!("The computation stops at {at}: {why}."), "The computation stops.".into()]
    }

    /// Returns how the motion came there, the most serious note first; and whether the first
    /// says that the state itself is wrong.
    fn notes(&self) -> (Vec<Forms>, bool) {
        let mut notes: Vec<Forms> = self.growth.map(grows).into_iter().collect();
        let sensitive = self.certainty.sensitive;
        if self.certainty.depends_on_step == Some(true) {
            notes.push(plain([
                "Another step ends otherwise: the step is too long.",
                "Another step ends otherwise.",
            ]));
        }
        if let Some(other) = self.other.filter(|other| *other != self.verdict)
            && !self.pulled
            && !sensitive
            && notes.is_empty()
        {
            notes.push(self.differs(other));
        }
        let wrong = !notes.is_empty();
        if self.pulled && self.verdict != Verdict::Adhesive && self.other != Some(self.verdict) {
            notes.push(self.pushes_only());
        }
        if let Some((speed, up)) = self.caught.filter(|_| self.verdict == Verdict::Locked) {
            let at = format!("{} at {}", if up { "run-up" } else { "run-down" }, rad_s(speed));
            notes.push([format!("Caught in a {at}."), format!("{}.", capital(&at))]);
        }
        if sensitive {
            let ends = self.certainty.ends_otherwise;
            let does = if ends { "ends otherwise" } else { "gives other impacts" };
            notes.push([format!("A tiny change {does}."), "Sensitive.".into()]);
        }
        if let Some(round) = self.round.filter(|_| notes.is_empty()) {
            let round = format!("{} um", short(rounded(1e6 * round, 2)));
            notes.push([
                format!("It needs a casing round to {round}."),
                format!("Round to {round}."),
            ]);
        }
        (notes, wrong)
    }

    /// Returns what contact that only pushes does, where this one pulled on the way.
    fn pushes_only(&self) -> Forms {
        let locked = self.verdict == Verdict::Locked;
        let ends = if locked { "would not catch it" } else { "ends otherwise" };
        match self.other {
            None | Some(Verdict::Failed) => plain(["Contact pulled on the way."; 2]),
            Some(other) => [
                format!("Contact that only pushes {ends}: {other}."),
                format!("Pushes only: {other}."),
            ],
        }
    }

    /// Returns that the event solver finds another end.
    fn differs(&self, other: Verdict) -> Forms {
        let why = if self.angles { "step or angles are too large" } else { "the step is too long" };
        let fails = other == Verdict::Failed;
        let does = if fails { "fails".into() } else { format!("says {other}") };
        let short = format!("The exact solver {does}.");
        // A run that stops has said why.
        if self.verdict == Verdict::Failed {
            return [short.clone(), short];
        }
        [format!("The exact solver {does}: {why}."), short]
    }
}

/// Returns that a lock is unstable.
fn grows(growth: f64) -> Forms {
    let growth = with_unit(growth, 3, "1/s");
    [format!("But this lock is unstable: it grows by {growth}."), "It is unstable.".into()]
}

/// Formats a speed with four digits.
fn rad_s(speed: f64) -> String {
    with_unit(speed, 4, "rad/s")
}

/// Counts touches: `1 touch`, `5 touches`.
fn touches(count: u64) -> String {
    format!("{} touch{}", grouped(count), if count == 1 { "" } else { "es" })
}

/// Returns constant forms.
fn plain(forms: [&str; 2]) -> Forms {
    forms.map(String::from)
}

/// Names blades: `Blades 12 and 19`; many are counted.
fn named(blades: &[u32]) -> String {
    let mut blades = blades.to_vec();
    blades.sort_unstable();
    match blades.as_slice() {
        [head @ .., last] if (2..=NAMED).contains(&blades.len()) => {
            let head: Vec<String> = head.iter().map(ToString::to_string).collect();
            format!("Blades {} and {last}", head.join(", "))
        }
        _ => counted(&blades),
    }
}

/// Names one or two blades, as in `12 + 19`, and counts more.
fn counted(blades: &[u32]) -> String {
    match blades {
        [] => "Some blades".into(),
        [only] => format!("Blade {only}"),
        [a, b] => format!("{} + {}", a.min(b), a.max(b)),
        several => format!("{} blades", several.len()),
    }
}

/// Explains why a run failed.
fn why(reason: &FailureReason) -> &'static str {
    match reason {
        FailureReason::BladeAngle { .. }
        | FailureReason::CornerAngle { .. }
        | FailureReason::TwoSides { .. } => "the blades bend too far",
        FailureReason::NoCorner { .. } => "no blades hold the wave",
        FailureReason::Displacement { .. } => "the casing moves too far",
        FailureReason::CasingSpeed { .. } => "the casing outruns the blades",
        FailureReason::LongStep { .. } | FailureReason::Penetration { .. } => {
            "the step is too long"
        }
        FailureReason::Rows { .. } => "too many blades touch at once",
        FailureReason::Ramp => "the speed must be constant",
        FailureReason::Closed { .. } => "the blades have grown into the casing",
        FailureReason::Series => "the motion is too fast",
        FailureReason::Events | FailureReason::EventsAtOnce | FailureReason::Looks => {
            "there are too many touches"
        }
        FailureReason::Pull { .. } => "a contact that only pushes pulls",
        FailureReason::Singular { .. } => "the contact forces have no solution",
    }
}

#[cfg(test)]
mod tests;
