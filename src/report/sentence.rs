//! What a run does, in one sentence of plain words, and what makes it doubtful in a
//! second one. Every sentence has shorter forms: what is told is the longest that has
//! room whole, so nothing is ever cut.

use std::fmt;

use super::line::capital;
use super::number::{count, grouped, with_unit};
use rubscope_solver::harmonic::lock_growth;
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{Failure, FailureReason, RunReport, Verdict};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// Between the word of the verdict and its sentence, and between two sentences.
const APART: [&str; 2] = ["  ", " "];
/// Most blades that are named one by one.
const NAMED: usize = 4;

/// Facts of a run from which its sentence is made.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Verdict of the run.
    pub verdict: Verdict,
    /// The blades in contact at the end.
    pub blades: Vec<u32>,
    /// Blades of these whose contact force pulls.
    pub pulling: Vec<u32>,
    /// Impacts in all.
    pub touches: u64,
    /// The contact law.
    pub law: ContactLaw,
    /// Whether all blades rub the lining at rest.
    pub pressed: bool,
    /// Whether the casing is damped: left alone, it comes to rest.
    pub damped: bool,
    /// Rotor speed at which a lock separated during the run \[rad/s\].
    pub broken: Option<f64>,
    /// Why the run stopped early.
    pub failure: Option<Failure>,
    /// Reasons to doubt the verdict, the most serious first.
    pub doubts: Vec<Doubt>,
}

/// Reason to doubt a verdict.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// The contact pulled in so many steps, which no real one can; and what a contact that
    /// only pushes does, where that is known.
    Pulls(u64, Option<Verdict>),
    /// The lock is unstable at a constant speed, and grows at this rate \[1/s\].
    Grows(f64),
    /// A change that no measurement could see makes another end, or only other impacts.
    Sensitive {
        /// Whether the end is another.
        ends: bool,
    },
    /// Another step makes another end.
    Step,
    /// Another verdict of the event solver, for this reason.
    Differs(Verdict, Cause),
}

/// Cause of a difference between two solvers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The step is too long.
    Step,
    /// The step is too long, or the angles that the solver leaves out are not small.
    Angles,
}

/// A verdict in words that fit in a width.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sentence {
    /// One word in capitals.
    pub word: String,
    /// Sentence on what happens.
    pub what: String,
    /// Sentence on what makes it doubtful, if there is one and it has room.
    pub doubt: Option<String>,
}

impl fmt::Display for Sentence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [after_word, between] = APART;
        f.write_str(&self.word)?;
        if !self.what.is_empty() {
            write!(f, "{after_word}{}", self.what)?;
        }
        self.doubt.iter().try_for_each(|doubt| write!(f, "{between}{doubt}"))
    }
}

impl Sentence {
    /// Creates the word with the longest of these forms that fit in so many columns, each list from
    /// long to short. A doubt in few words goes before a longer sentence.
    #[must_use]
    pub fn of(word: &str, forms: &[String], doubts: &[String], width: usize) -> Self {
        let sentence = |what: &str, doubt: Option<&String>| Self {
            word: word.to_string(),
            what: what.to_string(),
            doubt: doubt.cloned(),
        };
        let fits = |sentence: &Self| sentence.to_string().chars().count() <= width;
        // Both get shorter in turn, the sentence first.
        let pairs = (0..forms.len() + doubts.len()).flat_map(|shorter| {
            let pair = move |place: usize| Some((forms.get(shorter - place)?, doubts.get(place)?));
            (0..=shorter).filter_map(pair)
        });
        let doubted = pairs.map(|(what, doubt)| sentence(what, Some(doubt)));
        let alone = forms.iter().map(|what| sentence(what, None));
        doubted.chain(alone).find(fits).unwrap_or_else(|| sentence("", None))
    }
}

/// Returns how fast a lock grows in which a run of a scene ended, of this machine at this speed
/// \[1/s\]; none where it lasts, and where the speed changes.
#[must_use]
pub fn growth(verdict: Verdict, scene: &Scene, machine: &Machine, speed: f64) -> Option<f64> {
    let steady = scene.operation.speed_ramp_rad_s2 == 0.0;
    let bends = scene.solver.model != ModelSize::Rigid;
    (verdict == Verdict::Locked && steady && bends).then(|| lock_growth(machine, speed))?
}

/// Returns the rate of [`growth`] in words.
pub(super) fn rate(growth: f64) -> String {
    with_unit(growth, 3, "1/s")
}

/// Returns the growth of the lock in which a run ended \[1/s\].
pub(super) fn growth_of(report: &RunReport) -> Option<f64> {
    growth(report.outcome.verdict, &report.scene, &report.end_machine, report.end_speed_rad_s)
}

impl Facts {
    /// Collects the facts of a run. What unilateral contact would do is not known of it.
    #[must_use]
    pub fn of(report: &RunReport) -> Self {
        let (outcome, scene) = (&report.outcome, &report.scene);
        let blades = |pulling: bool| {
            let groups = outcome.contacts.iter();
            let groups = groups.filter(move |group| !pulling || group.multiplier_n > 0.0);
            groups.flat_map(|group| group.blades.iter().copied()).collect()
        };
        let grows = growth_of(report).map(Doubt::Grows);
        let pulls = report.checks.tensile_steps;
        let pulls = (pulls > 0).then_some(Doubt::Pulls(pulls, None));
        let ends = outcome.ends_otherwise == Some(true);
        let sensitive = (outcome.sensitive == Some(true)).then_some(Doubt::Sensitive { ends });
        let step = (outcome.depends_on_step == Some(true)).then_some(Doubt::Step);
        Self {
            verdict: outcome.verdict,
            blades: blades(false),
            pulling: blades(true),
            touches: report.impact_count,
            law: report.solver.contact,
            pressed: scene.clearance() < 0.0,
            damped: scene.casing_in_use().damping_ratio > 0.0,
            broken: report.broken.map(|(_, speed)| speed),
            failure: report.failure.clone(),
            doubts: grows.into_iter().chain(pulls).chain(sensitive).chain(step).collect(),
        }
    }

    /// Returns the sentence in at most so many columns; from 40 on there is always one.
    #[must_use]
    pub fn sentence(&self, width: usize) -> Sentence {
        let (word, forms) = (self.verdict.as_ref().to_uppercase(), self.forms());
        let doubts: Vec<Vec<String>> = self.doubts.iter().map(|one| self.doubt(*one)).collect();
        // All of them where there is room, the later ones in fewer words; else the worst.
        let all = doubts.iter().cloned().reduce(|worse, next| joined(&worse, &next));
        let tried = [all.unwrap_or_default(), doubts.into_iter().next().unwrap_or_default()];
        let [all, worst] = tried.map(|doubt| Sentence::of(&word, &forms, &doubt, width));
        if all.doubt.is_some() { all } else { worst }
    }

    /// Returns what happens, from the longest form to the shortest.
    fn forms(&self) -> Vec<String> {
        if let (Some(speed), Some(after)) = (self.broken, self.after_a_lock()) {
            let at = with_unit(speed, 4, "rad/s");
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

    /// Returns what follows a lock that broke.
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

    /// Returns how a casing ends that nothing touches.
    fn rest(&self) -> &'static str {
        if self.damped { "the casing comes to rest" } else { "the casing swings on freely" }
    }

    fn held(&self) -> Vec<String> {
        let [hold, carry] = match self.blades.len() {
            1 => ["holds", "carries"],
            _ => ["hold", "carry"],
        };
        let who = named(&self.blades, true);
        let mut forms = vec![
            format!("{who} {hold} the casing's wave and {carry} it round."),
            format!("{who} {hold} the casing's wave."),
            format!("{who} {hold} the wave."),
            format!("{} {hold} the wave.", named(&self.blades, false)),
            format!("{} {hold} it.", counted(&self.blades)),
        ];
        // Four names have no room in twelve words.
        if self.blades.len() == NAMED {
            forms.remove(0);
        }
        forms
    }

    fn pulled(&self) -> Vec<String> {
        let pulls = match self.pulling.as_slice() {
            [] => "one blade pulls".to_string(),
            [blade] => format!("blade {blade} pulls"),
            several => format!("{} blades pull", several.len()),
        };
        let hold = if self.blades.len() == 1 { "holds" } else { "hold" };
        let mut forms = vec![
            format!("{} {hold} the wave, but {pulls}.", named(&self.blades, true)),
            format!("The wave is held, but {pulls}."),
            "A pull holds the wave.".into(),
            "A pull holds it.".into(),
        ];
        if self.blades.len() == NAMED {
            forms.remove(0);
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

    /// Returns a doubt, from the longest form to the shortest.
    fn doubt(&self, doubt: Doubt) -> Vec<String> {
        match doubt {
            Doubt::Pulls(steps, otherwise) => {
                let other = otherwise.filter(|other| *other != self.verdict).and_then(would);
                let verb = if steps == 1 { "pulls" } else { "pull" };
                let pulls = format!("{} {verb}", count(steps, "step"));
                match other {
                    _ if self.verdict == Verdict::Adhesive => plain(&[
                        "A real contact cannot pull: it would let go.",
                        "A real contact cannot pull.",
                        "No real contact.",
                    ]),
                    Some(other) => vec![
                        format!("A real contact would {other}: {pulls}."),
                        format!("A real contact would {other}."),
                        format!("But {pulls}."),
                        "But it pulls.".into(),
                    ],
                    None => vec![
                        format!("{pulls}, which no real contact can."),
                        format!("But {pulls}."),
                        "But it pulls.".into(),
                    ],
                }
            }
            Doubt::Grows(growth) => {
                let grows = format!("it grows by {}", rate(growth));
                vec![
                    format!("But this lock is unstable: {grows}."),
                    format!("{}.", capital(&grows)),
                    "It is unstable.".into(),
                ]
            }
            Doubt::Sensitive { ends } => {
                let does = if ends { "ends otherwise" } else { "gives other impacts" };
                vec![
                    format!("A tiny change of pulse or speed {does}."),
                    format!("A tiny change {does}."),
                    "Sensitive.".into(),
                ]
            }
            Doubt::Step => plain(&[
                "Another step ends otherwise: the step is too long.",
                "Another step ends otherwise.",
                "Step too long.",
            ]),
            Doubt::Differs(other, cause) => {
                let why = match cause {
                    Cause::Step => "the step is too long",
                    Cause::Angles => "step or angles are too large",
                };
                let does = match other {
                    Verdict::Failed => "fails".into(),
                    other => format!("says {other}"),
                };
                let mut forms = vec![
                    format!("The exact solver {does}: {why}."),
                    format!("The exact solver {does}."),
                    format!("Exact: {other}."),
                ];
                // A run that stops has said why.
                if self.verdict == Verdict::Failed {
                    forms.remove(0);
                }
                forms
            }
        }
    }
}

/// Returns two doubts one after the other, from long to short: the second gets shorter first.
fn joined(worse: &[String], next: &[String]) -> Vec<String> {
    let shorter = worse.iter().skip(1).zip(next.last().into_iter().cycle());
    let pairs = worse.iter().take(1).flat_map(|first| next.iter().map(move |next| (first, next)));
    let [_, between] = APART;
    pairs.chain(shorter).map(|(first, next)| format!("{first}{between}{next}")).collect()
}

/// Counts touches: `1 touch`, `5 touches`.
fn touches(count: u64) -> String {
    format!("{} touch{}", grouped(count), if count == 1 { "" } else { "es" })
}

/// Returns constant forms.
fn plain(forms: &[&str]) -> Vec<String> {
    forms.iter().map(ToString::to_string).collect()
}

/// Returns what a real contact would do.
fn would(verdict: Verdict) -> Option<&'static str> {
    match verdict {
        Verdict::Decay => Some("let go"),
        Verdict::Bounce => Some("bounce"),
        Verdict::Slip => Some("slip"),
        Verdict::Whirl => Some("whirl"),
        Verdict::Forced => Some("drag"),
        Verdict::Locked | Verdict::Adhesive => Some("hold"),
        Verdict::Divergent => Some("diverge"),
        Verdict::Failed => None,
    }
}

/// Names blades: `Blades 12 and 19`, or without the noun `12 and 19`; many are counted.
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

/// Names one or two blades, `12 + 19`, and counts more.
fn counted(blades: &[u32]) -> String {
    match blades {
        [] => "Some blades".into(),
        [only] => format!("Blade {only}"),
        [a, b] => format!("{} + {}", a.min(b), a.max(b)),
        several => format!("{} blades", several.len()),
    }
}

/// Returns why a run stopped, in plain words.
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
