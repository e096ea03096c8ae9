//! One sentence on the motion of a run, and a second one on its history. Every sentence has several
//! forms, from long to short; the longest that fits is shown, so that no text is ever cut.

use std::fmt;

use super::line::capital;
use super::number::{grouped, rounded, short, with_unit};
use rubscope_solver::harmonic::{lock_growth, roundness_needed};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{Certainty, Failure, FailureReason, RunReport, Verdict};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// Separators: after the verdict, and between the two sentences.
const APART: [&str; 2] = ["  ", " "];
/// Blades are named one by one up to this number, and counted above it.
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
    /// Combines `word` with the longest sentence and history that fit into `width` columns. Both
    /// lists go from long to short. A short history is preferred to a longer sentence.
    pub fn of(word: &str, forms: &[String], histories: &[String], width: usize) -> Self {
        let sentence = |what: &str, history: Option<&String>| Self {
            word: word.to_string(),
            what: what.to_string(),
            history: history.cloned(),
            wrong: false,
        };
        let fits = |sentence: &Self| sentence.to_string().chars().count() <= width;
        // Both are shortened step by step, the sentence before the history.
        let pairs = (0..forms.len() + histories.len()).flat_map(|shorter| {
            let pair =
                move |place: usize| Some((forms.get(shorter - place)?, histories.get(place)?));
            (0..=shorter).filter_map(pair)
        });
        let both = pairs.map(|(what, history)| sentence(what, Some(history)));
        let alone = forms.iter().map(|what| sentence(what, None));
        both.chain(alone).find(fits).unwrap_or_else(|| sentence("", None))
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

    /// Returns the sentences in at most `width` columns; from 40 columns on, one always fits.
    pub fn sentence(&self, width: usize) -> Sentence {
        let (word, forms) = (self.verdict.as_ref().to_uppercase(), self.forms());
        let (notes, wrong) = self.notes();
        // Prefer all notes, the later ones shortened; if they do not fit, only the first.
        let all = notes.iter().cloned().reduce(|first, next| joined(&first, &next));
        let tried = [all.unwrap_or_default(), notes.into_iter().next().unwrap_or_default()];
        let [all, first] = tried.map(|note| Sentence::of(&word, &forms, &note, width));
        Sentence { wrong, ..if all.history.is_some() { all } else { first } }
    }

    /// Returns the sentence on the motion, from the longest form to the shortest.
    fn forms(&self) -> Vec<String> {
        if let (Some(speed), Some(after)) = (self.broken, self.after_a_lock()) {
            let at = rad_s(speed);
            return vec![
                format!("The lock breaks at {at}; then {after}."),
                format!("The lock breaks at {at}."),
                "The lock breaks.".into(),
            ];
        }
        match self.verdict {
            Verdict::Locked => self.held(),
            Verdict::Adhesive => self.pulled(),
            Verdict::Slip if self.pressed => plain(&[
                "All blades press the lining, and the wave slips along them.",
                "The wave slips along the pressed blades.",
                "The wave slips.",
            ]),
            Verdict::Slip => plain(&[
                "A blade always touches, and the wave slips along the blades.",
                "The wave slips along the blades.",
                "The wave slips.",
            ]),
            Verdict::Whirl => plain(&[
                "The contact runs from blade to blade and keeps them swinging.",
                "The contact runs round and swings the blades.",
                "The contact swings the blades.",
                "The blades swing.",
            ]),
            Verdict::Forced if self.pressed => plain(&[
                "All blades press the lining, and the longer ones drag the wave.",
                "Longer blades drag the wave.",
                "Blades drag it.",
            ]),
            Verdict::Forced => plain(&[
                "One blade or group presses without a break and drags the wave.",
                "One blade drags the casing's wave.",
                "One blade drags it.",
            ]),
            Verdict::Bounce => self.bounced(),
            Verdict::Decay => self.decayed(),
            Verdict::Divergent => {
                let why = self.failure.as_ref().map(|failure| why(&failure.reason));
                let mut forms = Vec::new();
                if let Some(why) = why {
                    forms.push(format!("The motion grows without end: {why}."));
                    forms.push(format!("It grows without end: {why}."));
                }
                forms.extend(plain(&["It grows without end.", "It only grows."]));
                forms
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

    fn held(&self) -> Vec<String> {
        let [hold, push] = match self.blades.len() {
            1 => ["holds", "it pushes"],
            2 => ["hold", "both push"],
            _ => ["hold", "all push"],
        };
        let [who, few] = [true, false].map(|noun| named(&self.blades, noun));
        let fewest = counted(&self.blades);
        vec![
            format!("{who} {hold} the casing's wave; {push}."),
            format!("{who} {hold} the wave; {push}."),
            format!("{few} {hold} the wave; {push}."),
            format!("{fewest} {hold} it; {push}."),
            format!("{fewest} {hold} it."),
        ]
    }

    fn pulled(&self) -> Vec<String> {
        let pulls = match self.pulling.as_slice() {
            [] => "one blade pulls".to_string(),
            [blade] => format!("blade {blade} pulls"),
            several => format!("{} blades pull", several.len()),
        };
        let mut forms = vec![
            format!("{}: no real contact can.", capital(&pulls)),
            "A pull holds the wave.".into(),
            "A pull holds it.".into(),
        ];
        let pushing = self.blades.iter().find(|blade| !self.pulling.contains(blade));
        if let (Some(push), [_, _], [_]) = (pushing, &*self.blades, &*self.pulling) {
            for [wave, it] in [["", ""], [" the wave", " it"]] {
                forms.insert(
                    0,
                    format!("Blade {push} pushes{wave} and {pulls}{it}: no real contact can."),
                );
            }
        }
        forms
    }

    fn bounced(&self) -> Vec<String> {
        if self.touches == 0 {
            return plain(&["Blades and casing meet and part again.", "They meet and part."]);
        }
        let again = if self.touches > 1 { " again and again" } else { "" };
        let touches = touches(self.touches);
        vec![
            format!("Blades and casing meet and part{again}: {touches}."),
            format!("Blades and casing meet and part: {touches}."),
            format!("They meet and part: {touches}."),
            "They meet and part.".into(),
        ]
    }

    fn decayed(&self) -> Vec<String> {
        let rest = self.rest();
        if self.pressed {
            return plain(&[
                "The wave dies away; the blades rub the lining as at rest.",
                "The wave dies; the blades rub as at rest.",
                "The wave dies away.",
            ]);
        }
        if self.touches == 0 {
            return vec![
                format!("No blade touches; {rest}."),
                "No blade touches the casing.".into(),
                "No blade touches.".into(),
            ];
        }
        let touches = touches(self.touches);
        let who = match self.law {
            ContactLaw::Smooth => "Blades leave the lining",
            ContactLaw::Unilateral | ContactLaw::Bilateral => "The blades let go",
        };
        vec![
            format!("{who} after {touches}; {rest}."),
            format!("{who} after {touches}."),
            format!("They let go after {touches}."),
            "The blades let go.".into(),
        ]
    }

    fn failed(&self) -> Vec<String> {
        let Some(failure) = &self.failure else {
            return plain(&["The computation stops before the end.", "The computation stops."]);
        };
        let (at, why) = (with_unit(failure.t_s, 3, "s"), why(&failure.reason));
        vec![
            format!("The computation stops at {at}: {why}."),
            format!("Stopped at {at}: {why}."),
            format!("Stopped: {why}."),
            format!("{}.", capital(why)),
            "The computation stops.".into(),
        ]
    }

    /// Returns the notes on the history, the most serious first, each from the longest form to the
    /// shortest, and whether the first one makes the result suspect.
    fn notes(&self) -> (Vec<Vec<String>>, bool) {
        let mut notes: Vec<Vec<String>> = self.growth.map(grows).into_iter().collect();
        let sensitive = self.certainty.sensitive;
        if self.certainty.depends_on_step == Some(true) {
            notes.push(plain(&[
                "Another step ends otherwise: the step is too long.",
                "Another step ends otherwise.",
                "Step too long.",
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
            notes.push(vec![format!("Caught in a {at}."), format!("{}.", capital(&at))]);
        }
        if sensitive {
            let ends = self.certainty.ends_otherwise;
            let does = if ends { "ends otherwise" } else { "gives other impacts" };
            notes.push(vec![format!("A tiny change {does}."), "Sensitive.".into()]);
        }
        if let Some(round) = self.round.filter(|_| notes.is_empty()) {
            let round = format!("{} um", short(rounded(1e6 * round, 2)));
            notes.push(vec![format!("It needs a casing round to {round}.")]);
        }
        (notes, wrong)
    }

    /// Notes what push-only contact would have done, for a run in which contact pulled.
    fn pushes_only(&self) -> Vec<String> {
        let locked = self.verdict == Verdict::Locked;
        let ends = if locked { "would not catch it" } else { "ends otherwise" };
        match self.other {
            None | Some(Verdict::Failed) => plain(&["Contact pulled on the way."]),
            Some(other) => vec![
                format!("Contact that only pushes {ends}: {other}."),
                format!("Contact that only pushes: {other}."),
                format!("Pushes only: {other}."),
            ],
        }
    }

    /// Notes that the event solver gives another verdict.
    fn differs(&self, other: Verdict) -> Vec<String> {
        let why = if self.angles { "step or angles are too large" } else { "the step is too long" };
        let fails = other == Verdict::Failed;
        let does = if fails { "fails".into() } else { format!("says {other}") };
        let mut forms = vec![
            format!("The exact solver {does}: {why}."),
            format!("The exact solver {does}."),
            format!("Exact: {other}."),
        ];
        // The verdict of a failed run has given the reason already.
        if self.verdict == Verdict::Failed {
            forms.remove(0);
        }
        forms
    }
}

/// Notes that the lock is unstable, with its growth rate.
fn grows(growth: f64) -> Vec<String> {
    let grows = format!("it grows by {}", with_unit(growth, 3, "1/s"));
    vec![
        format!("But this lock is unstable: {grows}."),
        format!("{}.", capital(&grows)),
        "It is unstable.".into(),
    ]
}

/// Formats a speed with four digits.
fn rad_s(speed: f64) -> String {
    with_unit(speed, 4, "rad/s")
}

/// Joins two notes, from long to short: the second is shortened first.
fn joined(first: &[String], next: &[String]) -> Vec<String> {
    let shorter = first.iter().skip(1).zip(next.last().into_iter().cycle());
    let pairs = first.iter().take(1).flat_map(|first| next.iter().map(move |next| (first, next)));
    let [_, between] = APART;
    pairs.chain(shorter).map(|(first, next)| format!("{first}{between}{next}")).collect()
}

/// Formats a number of touches: `1 touch`, `5 touches`.
fn touches(count: u64) -> String {
    format!("{} touch{}", grouped(count), if count == 1 { "" } else { "es" })
}

fn plain(forms: &[&str]) -> Vec<String> {
    forms.iter().map(ToString::to_string).collect()
}

/// Names blades: `Blades 12 and 19`, or `12 and 19` without the noun; many are counted.
fn named(blades: &[u32], with_noun: bool) -> String {
    let mut blades = blades.to_vec();
    blades.sort_unstable();
    let noun = match (with_noun, blades.len()) {
        (false, _) => "",
        (true, 1) => "Blade ",
        (true, _) => "Blades ",
    };
    match blades.as_slice() {
        [only] => format!("{noun}{only}"),
        [head @ .., last] if blades.len() <= NAMED => {
            let head: Vec<String> = head.iter().map(ToString::to_string).collect();
            format!("{noun}{} and {last}", head.join(", "))
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
