//! The headline of a run: one sentence on the motion at its end, and a second one on how the motion
//! got there. Every sentence has a long and a short form.

use std::fmt;

use super::line::{blades, capital};
use super::number::{grouped, micro, rounded, short, time, with_unit};
use rubscope_solver::harmonic::{lock_growth, roundness_needed};
use rubscope_solver::motion::{
    Certainty, Contact, Failure, FailureReason, RunReport, Seen, Verdict,
};
use rubscope_solver::scene::ContactLaw;

/// Separators: after the verdict, and between the two sentences.
const APART: [&str; 2] = ["  ", " "];
/// Begins the sentences of a run whose verdict another step changes.
const AT_THIS_STEP: &str = "At this step only.";
/// A sentence in its long and its short form.
type Forms = [String; 2];

/// Facts of a run from which its sentences are made. Blades are numbered from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Blades in contact at the end.
    pub blades: Vec<u32>,
    /// Those of `blades` whose contact force pulls.
    pub pulling: Vec<u32>,
    /// Number of impacts during the run.
    pub touches: u64,
    /// Contact law of the scene.
    pub law: ContactLaw,
    /// Clearance of the scene; negative if all blades rub the lining at rest \[m\].
    pub clearance_m: f64,
    /// Whether the casing is damped, so that it comes to rest after the last contact.
    pub damped: bool,
    /// Rotor speed at which the longest lock that ended during the run broke \[rad/s\]; `None` if
    /// no lock broke.
    pub broken: Option<f64>,
    /// Rotor speed at which the contact at the end began \[rad/s\], and whether the rotor was
    /// accelerating then; `None` at constant speed.
    pub caught: Option<(f64, bool)>,
    /// Why the run stopped early; `None` if it reached its end.
    pub failure: Option<Failure>,
    /// Whether a contact force pulled at any time of the run.
    pub pulled: bool,
    /// Verdict of the event solver, whose contact only pushes; `None` if it was not requested or
    /// is not known yet.
    pub other: Option<Verdict>,
    /// What was observed over the last part of the run; `None` if the verdict is proved.
    pub seen: Option<Seen>,
    /// Whether casing and blades have not moved at all.
    pub still: bool,
    /// Result of the sensitivity check.
    pub certainty: Certainty,
    /// Whether two groups of blades hit the casing in one step.
    pub in_one_step: bool,
    /// Growth rate of a deviation from the lock at the end \[1/s\]; `None` if the run does not end
    /// in a lock, the lock is stable or on a lining, the speed changes, or the model is rigid.
    pub growth: Option<f64>,
    /// Largest out-of-roundness of the casing that leaves the lock intact \[m\]; `None` if the run
    /// does not end in a lock, if it is unknown, or if usual casings are rounder.
    pub round: Option<f64>,
    /// Largest deviation of the tips that leaves both pushes of the lock, whichever tips deviate
    /// \[m\]; `None` as for `round`.
    pub tips: Option<f64>,
}

/// The verdict of a run as a word and at most two sentences, chosen to fit a given width.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sentence {
    /// The verdict, one word in capitals.
    pub word: String,
    /// Sentence on the motion at the end; may be empty.
    pub what: String,
    /// Sentences on how the motion got there and how far to trust it; `None` if there is nothing to
    /// say or no room.
    pub history: Option<String>,
    /// Whether the result is suspect, which is shown in red: the lock is unstable, or another step
    /// or the event solver gives another verdict.
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
    /// Combines the word with the long form of a sentence or, if that is wider than `width` columns,
    /// the short one, and with the first of `notes` that still fits. If none fits, there is no history.
    pub fn of(word: &str, forms: Forms, notes: &[String], width: usize) -> Self {
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
    /// Collects the facts of a run.
    pub fn of(report: &RunReport) -> Self {
        let (outcome, scene, checks) = (&report.outcome, &report.scene, &report.checks);
        let (machine, speed) = (&report.end_machine, report.end_speed_rad_s);
        let (pull, push): (Vec<_>, Vec<_>) =
            outcome.contacts.iter().partition(|group| group.multiplier_n > 0.0);
        let blades =
            |groups: &[&Contact]| groups.iter().flat_map(|group| group.blades.clone()).collect();
        let locked = outcome.verdict == Verdict::Locked;
        let may_grow = locked && scene.operation.speed_ramp_rad_s2 == 0.0;
        Self {
            verdict: outcome.verdict,
            blades: blades(&[&pull[..], &push].concat()),
            pulling: blades(&pull),
            touches: report.impact_count,
            law: scene.solver.contact,
            clearance_m: scene.clearance(),
            damped: machine.casing_damping_ratio > 0.0,
            broken: report.broken.map(|(_, speed)| speed),
            caught: report.caught,
            failure: report.failure.clone(),
            pulled: checks.tensile_steps > 0,
            other: report.pushes_only,
            seen: report.seen,
            still: outcome.amplitude_m == 0.0,
            certainty: Certainty {
                sensitive: outcome.sensitive == Some(true),
                ends_otherwise: outcome.ends_otherwise == Some(true),
                depends_on_step: outcome.depends_on_step,
            },
            in_one_step: report.impacts_in_one_step_at_s.is_some(),
            growth: may_grow.then(|| lock_growth(machine, speed)).flatten(),
            round: locked.then(|| roundness_needed(machine, speed)).flatten(),
            tips: locked.then(|| machine.tip_deviation(speed)).flatten().filter(|tips| *tips > 0.0),
        }
    }

    /// Returns the verdict and its sentences in at most `width` columns. The shortest forms need up
    /// to 40; below that, the result may be wider.
    pub fn sentence(&self, width: usize) -> Sentence {
        let word = self.verdict.as_ref().to_uppercase();
        let (notes, wrong) = self.notes();
        let [_, between] = APART;
        let all = |form: usize| notes.iter().map(|note| note[form].as_str()).collect::<Vec<_>>();
        let mut texts: Vec<String> = [0, 1].map(|form| all(form).join(between)).into();
        texts.extend(notes.first().map(|first| first[1].clone()));
        texts.retain(|text| !text.is_empty());
        let mut forms = self.forms();
        if self.is_of_this_step() {
            forms = [format!("{AT_THIS_STEP} {}", forms[0]), AT_THIS_STEP.into()];
        }
        Sentence { wrong, ..Sentence::of(&word, forms, &texts, width) }
    }

    /// Returns whether another step gives another verdict.
    pub(super) fn is_of_this_step(&self) -> bool {
        self.certainty.depends_on_step == Some(true)
    }

    /// Describes the motion at the end of the run.
    pub(super) fn forms(&self) -> Forms {
        match self.verdict {
            Verdict::Locked => self.held(),
            Verdict::Adhesive => self.pulled(),
            Verdict::Slip if self.clearance_m < 0.0 => self.lately([
                "all blades press the lining, and the wave slips along them.",
                "The wave slips.",
            ]),
            Verdict::Slip => self.lately([
                "a blade always touches, and the wave slips along the blades.",
                "The wave slips along the blades.",
            ]),
            Verdict::Whirl => self.lately([
                "the contact runs from blade to blade and keeps them swinging.",
                "The contact swings the blades.",
            ]),
            Verdict::Forced if self.clearance_m < 0.0 => self.lately([
                "all blades press the lining, and the longer ones drag the wave.",
                "Longer blades drag the wave.",
            ]),
            Verdict::Forced => self.lately([
                "one blade or group presses without a break and drags the wave.",
                "One blade drags it.",
            ]),
            Verdict::Bounce => {
                let count = Some(touches(self.touches)).filter(|_| self.touches > 0);
                let count = count.map_or(String::new(), |count| format!(", with {count} so far"));
                [format!("Contacts come and go{count}."), "Contacts come and go.".into()]
            }
            Verdict::Decay => self.decayed(),
            Verdict::Divergent => {
                let why = self.failure.as_ref().map(|failure| why(&failure.reason));
                let why = why.map_or(String::new(), |why| format!(": {why}"));
                [format!("The motion grows without end{why}."), "It grows without end.".into()]
            }
            Verdict::Failed => self.failed(),
        }
    }

    /// Begins the long form with the observed time span if the verdict is judged and not proved.
    fn lately(&self, [long, short]: [&str; 2]) -> Forms {
        let long = match self.seen {
            Some(seen) => format!("In the last {} {long}", time(seen.span_s)),
            None => capital(long),
        };
        [long, short.into()]
    }

    fn held(&self) -> Forms {
        let [hold, push] = match self.blades.len() {
            1 => ["holds", "it pushes"],
            2 => ["hold", "both push"],
            _ => ["hold", "all push"],
        };
        let few = match self.blades.as_slice() {
            [] => "Some blades".into(),
            [only] => format!("Blade {only}"),
            [a, b] => format!("{} + {}", a.min(b), a.max(b)),
            several => format!("{} blades", several.len()),
        };
        let long = format!("{} {hold} the casing's wave; {push}.", blades(&self.blades));
        self.lately([&long, &format!("{few} {hold} it; {push}.")])
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

    fn decayed(&self) -> Forms {
        let touched = self.seen.is_some_and(|seen| seen.without_contact_s < seen.span_s);
        if self.clearance_m < 0.0 || (self.law == ContactLaw::Smooth && touched) {
            return self.lately([
                "the wave dies away; the blades rub the lining as at rest.",
                "The wave dies away.",
            ]);
        }
        if let Some(seen) = self.seen {
            let span = time(seen.without_contact_s);
            let at = seen.reach.map_or(String::new(), |reach| match rounded(reach, 2) {
                1.0 => ", close to the clearance".into(),
                reach => format!(", at {} of the clearance", short(reach)),
            });
            let again = if self.touches == 0 { "yet" } else { "again" };
            return [
                format!("No contact in the last {span}{at}; it may touch {again}."),
                format!("No contact in {span}."),
            ];
        }
        if self.still && self.touches == 0 {
            return plain(["Nothing moves and no blade touches.", "Nothing moves."]);
        }
        let rest = if self.damped { "comes to rest" } else { "swings on freely" };
        if self.touches == 0 {
            return [format!("No blade touches; the casing {rest}."), "No blade touches.".into()];
        }
        let touches = touches(self.touches);
        [format!("Contact ends after {touches}; the casing {rest}."), "Contact ends.".into()]
    }

    fn failed(&self) -> Forms {
        let Some(failure) = &self.failure else {
            return plain(["The computation stops before the end.", "The computation stops."]);
        };
        let (at, why) = (with_unit(failure.t_s, 3, "s"), why(&failure.reason));
        [format!("The computation stops at {at}: {why}."), "The computation stops.".into()]
    }

    /// Returns the notes on how the motion got there, the most serious first, and whether the result
    /// is suspect.
    fn notes(&self) -> (Vec<Forms>, bool) {
        let mut notes: Vec<Forms> = Vec::new();
        if let Some(growth) = self.growth {
            let growth = with_unit(growth, 3, "1/s");
            let long = format!("But this lock is unstable: it grows by {growth}.");
            notes.push([long, "It is unstable.".into()]);
        }
        let (sensitive, at_this_step) = (self.certainty.sensitive, self.is_of_this_step());
        if let Some(other) = self.other.filter(|other| *other != self.verdict)
            && !at_this_step
            && !self.pulled
            && !sensitive
            && notes.is_empty()
        {
            let fails = other == Verdict::Failed;
            let does = if fails { "fails".into() } else { format!("says {other}") };
            let told = format!("The exact solver {does}.");
            notes.push([told.clone(), told]);
        }
        let wrong = at_this_step || !notes.is_empty();
        if let Some(speed) = self.broken.map(rad_s).filter(|_| !self.verdict.is_held()) {
            notes.push([format!("A lock broke at {speed}."), format!("Lock broke at {speed}.")]);
        }
        if self.pulled && self.verdict != Verdict::Adhesive && self.other != Some(self.verdict) {
            notes.push(self.pushes_only());
        }
        if let Some((speed, up)) = self.caught.filter(|_| self.verdict == Verdict::Locked) {
            let at = format!("{} at {}", if up { "run-up" } else { "run-down" }, rad_s(speed));
            notes.push([format!("Caught in a {at}."), format!("{}.", capital(&at))]);
        }
        if sensitive {
            let does = if self.certainty.ends_otherwise {
                "changes the verdict"
            } else {
                "gives other impacts"
            };
            notes.push([format!("A tiny change {does}."), "Sensitive.".into()]);
        }
        if self.in_one_step {
            let hit = "Two groups of blades hit in one step".to_string();
            notes.push([format!("{hit}: their order decides what follows."), hit + "."]);
        }
        if let Some(round) = self.round.filter(|_| notes.is_empty()) {
            let um = |length: f64| format!("{} {}m", short(rounded(1e6 * length, 2)), micro());
            let part = |length: f64| short(rounded(100.0 * length / self.clearance_m, 2));
            let (height, height_part) = (um(round), part(round));
            let mut needed = [
                format!("It needs a casing round to {height} ({height_part} % of the clearance)."),
                format!("Round to {height}"),
            ];
            if let Some(tips) = self.tips {
                needed[0] += &format!(" Tips may be off by {} ({} %).", um(tips), part(tips));
                needed[1] += &format!(", tips to {}", um(tips));
            }
            needed[1].push('.');
            notes.push(needed);
        }
        (notes, wrong)
    }

    /// Says that contact pulled during the run, and what a contact that only pushes gives instead.
    fn pushes_only(&self) -> Forms {
        let locked = self.verdict == Verdict::Locked;
        let ends = if locked { "would not catch it" } else { "gives another verdict" };
        match self.other {
            None | Some(Verdict::Failed) => plain(["Contact pulled on the way."; 2]),
            Some(other) => [
                format!("Contact that only pushes {ends}: {other}."),
                format!("Pushes only: {other}."),
            ],
        }
    }
}

/// Formats a rotor speed \[rad/s\] with four digits, in the shown unit.
fn rad_s(speed: f64) -> String {
    with_unit(speed, 4, "rad/s")
}

/// Counts touches: `1 touch`, `5 touches`.
fn touches(count: u64) -> String {
    format!("{} touch{}", grouped(count), if count == 1 { "" } else { "es" })
}

/// Creates the long and the short form from constant text.
fn plain(forms: [&str; 2]) -> Forms {
    forms.map(String::from)
}

/// Explains why a run failed.
fn why(reason: &FailureReason) -> &'static str {
    match reason {
        FailureReason::BladeAngle { .. } | FailureReason::TwoSides { .. } => {
            "the blades bend too far"
        }
        FailureReason::NoCorner { .. } => "no blades hold the wave",
        FailureReason::Displacement { .. } => "the casing moves too far",
        FailureReason::CasingSpeed { .. } => "the casing outruns the blades",
        FailureReason::LongStep { .. } => "the casing runs past the blades",
        FailureReason::Penetration { .. } => "a step goes deeper than the clearance",
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
