//! The verdict in words: the verdict, its start, its blades, and whether
//! another solver disagrees.

use super::App;
use crate::motion::{ActiveSet, Verdict};
use crate::tui::axis::readable;
use crate::tui::engine::{Answer, FORECAST_LIMIT, FullRun, FullRunState};
use crate::tui::knobs::KNOBS;
use crate::tui::theme::Role;
use crate::tui::trace::{Happening, Mark};

/// A verdict as the header shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VerdictText {
    /// The one word, in capitals.
    pub word: String,
    /// The rest of the line; left out if there is no room.
    pub detail: String,
    /// How to colour it.
    pub role: Role,
}

impl App {
    /// The full run of the scene's own solver, once it is computed.
    pub fn full_run(&self) -> Option<&FullRun> {
        match &self.results().full_run {
            Some(FullRunState::Done(run)) => Some(run),
            _ => None,
        }
    }

    /// The verdict of the running solver.
    pub fn verdict(&self) -> VerdictText {
        if let Some(trouble) = &self.run.latest.trouble {
            return VerdictText {
                word: "STOPPED".into(),
                detail: trouble.clone(),
                role: Role::Trouble,
            };
        }
        match &self.results().full_run {
            Some(FullRunState::Done(run)) => {
                let mut words = self.words(run);
                if self.results().sensitive {
                    words.detail.push_str(", sensitive");
                }
                words
            }
            Some(FullRunState::Computing(part)) => {
                self.computing(&format!("{:.0} %", 100.0 * part))
            }
            Some(FullRunState::GivenUp(part)) => VerdictText {
                word: "NO FORECAST".into(),
                detail: format!(
                    "{} s of work reached {:.0} % of the run",
                    FORECAST_LIMIT.as_secs(),
                    100.0 * part
                ),
                role: Role::Trouble,
            },
            None => self.computing(""),
        }
    }

    /// While there is no verdict, the latest one stays, dimmed and with its value; the event
    /// solver, which is done sooner, is told beside it.
    fn computing(&self, part: &str) -> VerdictText {
        let event = self.results().reference.as_ref();
        let event =
            event.map_or(String::new(), |run| format!("event, unilateral: {}", run.verdict));
        let (word, state) = match self.older_answer() {
            Some(answer) => (answer, format!("computing {part}")),
            None => ("computing".into(), part.to_string()),
        };
        let detail = join(&[&event, state.trim_end()]);
        VerdictText { word, detail, role: Role::Quiet }
    }

    /// The verdict of a scene that differs in one knob, `at 405 rad/s: WHIRL`, or of this one
    /// before it was changed in another way.
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

    pub(crate) fn words(&self, run: &FullRun) -> VerdictText {
        let since = run.since.map_or(String::new(), |t| format!("since {}", readable(t, "s")));
        let tensile = run.checks.tensile_steps;
        let blades = self.numbers_of(run.multipliers.iter().map(|(side, _)| *side));
        let (detail, role) = match run.verdict {
            Verdict::Locked => (format!("on {blades} {since}"), Role::Contact),
            Verdict::Adhesive => {
                let pulled = run.multipliers.iter().filter(|(_, force)| *force > 0.0);
                let pulled = self.blades_of(pulled.map(|(side, _)| *side));
                (join(&["a lock that pulls, not a real contact", &pulled, &since]), Role::Trouble)
            }
            Verdict::Slip => (join(&["contact without a break, side after side"]), Role::Contact),
            Verdict::Whirl => {
                ("the contact goes round and swings the blades".into(), Role::Trouble)
            }
            Verdict::Divergent => (run.stopped.clone().unwrap_or_default(), Role::Trouble),
            Verdict::Bounce => {
                (format!("{} impacts, and more to come", run.impacts), Role::Contact)
            }
            Verdict::Decay => (plural(run.impacts, "impact"), Role::Good),
            Verdict::Failed => (run.stopped.clone().unwrap_or_default(), Role::Trouble),
        };
        let pulls = tensile > 0
            && matches!(
                run.verdict,
                Verdict::Locked | Verdict::Decay | Verdict::Slip | Verdict::Whirl | Verdict::Bounce
            );
        let mut parts = vec![detail];
        if let Some((hold, speed)) = &run.broken {
            let (at, speed) = (readable(hold.ended, "s"), readable(*speed, "rad/s"));
            parts.insert(0, format!("lock broken at {at}, {speed}"));
        }
        if pulls {
            parts.push(plural(tensile, "tensile step"));
        }
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        let detail = join(&parts);
        VerdictText { word: run.verdict.as_ref().to_uppercase(), detail, role }
    }

    /// The verdict of the event solver under unilateral contact, if it differs.
    pub fn disagreement(&self) -> Option<String> {
        let own = self.full_run()?;
        let other = self.results().reference.as_ref()?;
        if other.verdict == own.verdict {
            return None;
        }
        let why = if own.checks.tensile_steps > 0 {
            plural(own.checks.tensile_steps, "pull") + " here"
        } else if self.results().sensitive {
            "the scene is sensitive".to_string()
        } else if self.scene.goes_beyond() {
            "step too large, or its angles left out".to_string()
        } else {
            "step too large".to_string()
        };
        Some(format!("event, unilateral: {} ({why})", other.verdict))
    }

    /// The blades in contact at the instant that is shown, in words.
    pub fn contact_shown(&self) -> String {
        let Some(moment) = self.shown() else { return String::new() };
        if let Some(failure) = &moment.failure {
            return failure.clone();
        }
        if self.has_lining() {
            return self.in_the_lining();
        }
        match moment.active_set {
            ActiveSet::Nothing => "no contact".into(),
            ActiveSet::Many => "many blades".into(),
            touching => self.blades_of(touching.sides()),
        }
    }

    /// The state of the motion now: `free`, `touching 12`, `held on 6 + 21`.
    pub fn state_now(&self) -> String {
        let Some(moment) = self.moment() else { return "starting".into() };
        if moment.failure.is_some() {
            let grown = self.full_run().is_some_and(|run| run.verdict == Verdict::Divergent);
            return if grown { "diverged" } else { "failed" }.into();
        }
        if self.has_lining() && moment.active_set == ActiveSet::Many {
            let touching = moment.gaps.iter().filter(|gap| **gap < 0.0).count();
            return match touching == moment.gaps.len() {
                true => "touching all".into(),
                false => format!("touching {touching} blades"),
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

    /// A change of contact in words.
    pub fn happening(&self, what: Happening) -> String {
        let blades = |sides: ActiveSet| self.numbers_of(sides.sides());
        match what {
            Happening::Impact(side) => format!("impact on {}", blades(ActiveSet::Side(side))),
            Happening::Contact(before, now) => match (before, now) {
                (ActiveSet::Corner(a, b), ActiveSet::Side(kept)) if kept == a || kept == b => {
                    let gone = blades(ActiveSet::Side(if kept == a { b } else { a }));
                    format!("{gone} lets go, {} still touches", blades(now))
                }
                _ => self.state_of(now),
            },
            Happening::Release(gone @ ActiveSet::Side(_)) => format!("{} lets go", blades(gone)),
            Happening::Release(gone @ ActiveSet::Corner(..)) => format!("{} let go", blades(gone)),
            Happening::Release(_) => "all let go".into(),
        }
    }

    /// The next change of contact: when, and what.
    pub fn next_change(&self) -> Option<Mark> {
        let now = self.now();
        self.full_run()?.marks.iter().find(|mark| mark.t_s > now).copied()
    }

    /// The blades of some sides, `blades 6 + 21`.
    pub fn blades_of(&self, sides: impl Iterator<Item = u32>) -> String {
        let numbers = self.numbers_of(sides);
        match numbers.chars().any(|letter| matches!(letter, '+' | ',')) {
            _ if numbers.is_empty() => numbers,
            true => format!("blades {numbers}"),
            false => format!("blade {numbers}"),
        }
    }

    /// The numbers of the blades of some sides, `6 + 21`.
    pub fn numbers_of(&self, sides: impl Iterator<Item = u32>) -> String {
        let mut groups: Vec<String> = Vec::new();
        for side in sides.take(4) {
            let blades = self.machine.polygon.blades_of_side(side);
            let names: Vec<String> = blades.iter().take(3).map(ToString::to_string).collect();
            let more = if blades.len() > 3 { ",.." } else { "" };
            groups.push(format!("{}{more}", names.join(",")));
        }
        groups.join(" + ")
    }
}

fn join(parts: &[&str]) -> String {
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(", ")
}

/// `1 impact`, `2 impacts`, `no impacts`.
pub fn plural(count: u64, what: &str) -> String {
    match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}
