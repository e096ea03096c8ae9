//! The verdict in words: what the run comes to, since when, on which blades,
//! and where another solver disagrees.

use super::App;
use crate::motion::{Touching, Verdict};
use crate::tui::axis::readable;
use crate::tui::engine::{Ahead, Forecast};
use crate::tui::theme::Role;

/// A verdict as the header shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    /// The one word, in capitals.
    pub word: String,
    /// The rest of the line; may be left out where there is no room.
    pub detail: String,
    /// How to colour it.
    pub role: Role,
}

impl App {
    /// The verdict of the running solver.
    #[must_use]
    pub fn verdict(&self) -> Words {
        if let Some(trouble) = &self.trouble {
            return Words { word: "STOPPED".into(), detail: trouble.clone(), role: Role::Trouble };
        }
        match &self.ahead {
            Some(Ahead::Done(forecast)) => {
                let mut words = self.words(forecast);
                if self.sensitive {
                    words.detail.push_str(", sensitive");
                }
                words
            }
            Some(Ahead::Computing(part)) => Words {
                word: "computing".into(),
                detail: format!("{:.0} %", 100.0 * part),
                role: Role::Quiet,
            },
            None => Words { word: "computing".into(), detail: String::new(), role: Role::Quiet },
        }
    }

    pub(crate) fn words(&self, forecast: &Forecast) -> Words {
        let since = forecast.since.map_or(String::new(), |t| format!("since {}", readable(t, "s")));
        let tensile = forecast.checks.tensile_steps;
        let blades = self.blades_of(forecast.multipliers.iter().map(|(side, _)| *side));
        let (detail, role) = match forecast.verdict {
            Verdict::Locked => (join(&[&blades, &since]), Role::Contact),
            Verdict::Adhesive => {
                let pulled: Vec<u32> = forecast
                    .multipliers
                    .iter()
                    .filter(|(_, l)| *l > 0.0)
                    .map(|(s, _)| *s)
                    .collect();
                let pulled = self.blades_of(pulled.into_iter());
                (join(&["a lock that pulls, no contact can", &pulled, &since]), Role::Trouble)
            }
            Verdict::Slip => (join(&["contact without a break, side after side"]), Role::Contact),
            Verdict::Bounce => {
                (format!("{} impacts, and more to come", forecast.impacts), Role::Contact)
            }
            Verdict::Decay => (plural(forecast.impacts, "impact"), Role::Good),
            Verdict::Failed => (forecast.failure.clone().unwrap_or_default(), Role::Trouble),
        };
        let pulls = tensile > 0
            && matches!(
                forecast.verdict,
                Verdict::Locked | Verdict::Decay | Verdict::Slip | Verdict::Bounce
            );
        let detail =
            if pulls { format!("{detail}, {}", plural(tensile, "tensile step")) } else { detail };
        Words { word: forecast.verdict.as_ref().to_uppercase(), detail, role }
    }

    /// What the event solver under unilateral contact says, where it differs.
    #[must_use]
    pub fn disagreement(&self) -> Option<String> {
        let Some(Ahead::Done(own)) = &self.ahead else { return None };
        let other = self.reference.as_ref()?;
        if other.verdict == own.verdict {
            return None;
        }
        let why = if self.sensitive {
            "the scene is sensitive".to_string()
        } else if own.checks.tensile_steps > 0 {
            format!("here {} pulled", plural(own.checks.tensile_steps, "step"))
        } else {
            "step too large".to_string()
        };
        Some(format!("event solver, unilateral: {} ({why})", other.verdict))
    }

    /// What touches now, in words.
    #[must_use]
    pub fn contact_now(&self) -> String {
        let Some(moment) = &self.moment else { return String::new() };
        if let Some(failure) = &moment.failure {
            return failure.clone();
        }
        match moment.touching {
            Touching::Nothing => "no contact".into(),
            Touching::Side(side) => self.blades_of([side].into_iter()),
            Touching::Corner(a, b) => self.blades_of([a, b].into_iter()),
            Touching::Many => "many blades".into(),
        }
    }

    /// The blades of some sides, `blades 6 + 21`.
    #[must_use]
    pub fn blades_of(&self, sides: impl Iterator<Item = u32>) -> String {
        let mut groups: Vec<String> = Vec::new();
        let mut count = 0;
        for side in sides.take(4) {
            let blades = self.machine.rim.blades_of_side(side);
            count += blades.len();
            let names: Vec<String> = blades.iter().take(3).map(ToString::to_string).collect();
            let more = if blades.len() > 3 { ",.." } else { "" };
            groups.push(format!("{}{more}", names.join(",")));
        }
        match count {
            0 => String::new(),
            1 => format!("blade {}", groups.join(" + ")),
            _ => format!("blades {}", groups.join(" + ")),
        }
    }
}

fn join(parts: &[&str]) -> String {
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(", ")
}

/// `1 impact`, `2 impacts`, `no impacts`.
#[must_use]
pub fn plural(count: u64, what: &str) -> String {
    match count {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}
