//! The glossary: every symbol and every verdict, with its equation and, where
//! it has one, its value in the present scene.

mod beyond;
mod terms;

pub use terms::SECTIONS;

use super::app::App;
use super::knobs::{knob_of, number};

/// The value of a symbol in the present scene.
#[derive(Clone, Copy, Debug)]
pub enum Here {
    /// It has none.
    Nothing,
    /// That of the knob with this key.
    Knob(&'static str),
    /// What follows from the scene, and its unit.
    Of(fn(&App) -> Option<f64>, &'static str),
}

/// One symbol or word.
#[derive(Debug)]
pub struct Term {
    /// As it is written.
    pub symbol: &'static str,
    /// The same in letters that every keyboard has.
    pub name: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Its equation or condition; may be empty.
    pub equation: &'static str,
    /// Its present value.
    pub here: Here,
}

impl Term {
    /// Meaning, equation and value as one text.
    pub fn text(&self, app: &App) -> String {
        let mut text = self.meaning.to_string();
        if !self.equation.is_empty() {
            text.push_str(": ");
            text.push_str(self.equation);
        }
        if let Some(value) = self.value(app) {
            text.push_str("; here ");
            text.push_str(&value);
        }
        text
    }

    fn value(&self, app: &App) -> Option<String> {
        match self.here {
            Here::Nothing => None,
            Here::Knob(path) => knob_of(path).map(|knob| knob.text(&app.scene)),
            Here::Of(value, unit) => {
                let value = value(app).filter(|value| value.is_finite())?;
                // Four digits are enough to know where one stands.
                let rounded: f64 = format!("{value:.3e}").parse().ok()?;
                Some(number(rounded, unit))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Verdict;
    use crate::scene::Scene;
    use crate::tui::{Marker, Theme};

    fn app() -> App {
        App::new(
            Scene::builtin("paper-nd3").unwrap().checked().unwrap(),
            Theme::Mono,
            Marker::Braille,
        )
    }

    #[test]
    fn every_verdict_is_explained() {
        let (_, verdicts) = SECTIONS.iter().find(|(heading, _)| *heading == "Verdicts").unwrap();
        for verdict in Verdict::ALL {
            let known = verdicts.iter().any(|term| term.symbol == verdict.as_ref());
            assert!(known, "{verdict}");
        }
    }

    #[test]
    fn every_value_is_there_and_is_that_of_the_scene() {
        let app = app();
        for (_, terms) in SECTIONS {
            for term in *terms {
                // A lock of this scene has no upper end.
                let has = !matches!(term.here, Here::Nothing) && term.symbol != "lock ends";
                assert_eq!(term.value(&app).is_some(), has, "{}", term.symbol);
                assert!(term.name.is_ascii(), "{}", term.symbol);
            }
        }
        let text = |symbol: &str| {
            let mut terms = SECTIONS.iter().flat_map(|(_, terms)| *terms);
            terms.find(|term| term.symbol == symbol).map(|term| term.text(&app)).unwrap()
        };
        for (symbol, value) in [
            ("Ω_c", "here 292.9 rad/s"),
            ("Ω_lock", "here 411.9 rad/s"),
            ("adhesive limit", "here 295 rad/s"),
            ("coincidence", "here 388.3 rad/s"),
            ("λ_a", "here -244.4 N"),
            ("λ_b", "here -57.29 N"),
            ("|z| locked", "here 101 µm"),
            ("g0", "here 100 µm"),
        ] {
            assert!(text(symbol).ends_with(value), "{}", text(symbol));
        }
    }
}
