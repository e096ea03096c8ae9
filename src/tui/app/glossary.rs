//! The glossary in `assets/glossary.toml`: every symbol, word and sign of the screen with its
//! equation and, if it has one, its value in the present scene; and a description of every view.

use std::sync::LazyLock;

use serde::Deserialize;

use super::model::App;
use crate::sheet::number::{frequency_unit, in_shown_unit, per_frequency};
use crate::tui::axis::number;
use crate::tui::knobs::knob_of;
use crate::tui::views::id::ViewId;
use rubscope_solver::model::Frame;

/// The text of the glossary.
const TEXT: &str = include_str!("../../../assets/glossary.toml");

/// A value computed from the present scene: ASCII name of the term, SI unit, and function.
type Value = (&'static str, &'static str, fn(&App) -> Option<f64>);

/// Stands for the unit of an angular frequency, which is shown in rad/s or Hz.
const FREQUENCY: &str = "frequency";

/// Values of the terms that are not knobs.
const VALUES: &[Value] = &[
    ("Omega", "rad/s", |app| Some(app.speed())),
    ("Omega_c", "rad/s", |app| app.machine.critical_speed()),
    ("Omega_lock", "rad/s", App::lock_speed),
    ("lock_ends", "rad/s", |app| app.lock_window()?.to),
    ("Omega_adhesive", "rad/s", |app| app.machine.adhesive_speed()),
    ("coincidence", "rad/s", |app| app.machine.dangerous_speed_toward(app.speed())),
    ("coincidence (30)", "rad/s", |app| app.machine.coincidence_speeds().first().copied()),
    ("omega_c", FREQUENCY, |app| Some(app.machine.omega_c)),
    ("omega_bd", FREQUENCY, |app| Some(app.machine.omega_bd)),
    ("nu", FREQUENCY, |app| Some(app.machine.nu(app.speed()))),
    ("N'", "", |app| Some(f64::from(app.machine.polygon.sides))),
    ("delta", "rad", |app| Some(app.machine.polygon.delta)),
    ("|z| locked", "m", |app| app.machine.locked_amplitude()),
    ("lambda_a", "N", |app| app.machine.locked_multipliers(app.speed()).map(|[a, _]| a)),
    ("lambda_b", "N", |app| app.machine.locked_multipliers(app.speed()).map(|[_, b]| b)),
    ("c2", "m²", |app| Some(app.machine.coupling_product_at(app.speed()))),
    ("B(omega)", "m/N at ω = 0", |app| {
        let frame = Frame::at(&app.machine, app.speed());
        Some(frame.turning(-frame.casing.turn).compliance().re)
    }),
];

/// Contents of the glossary file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Glossary {
    section: Vec<Section>,
    view: Vec<ViewWords>,
}

/// A group of terms.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Heading of its terms.
    pub heading: String,
    /// Its terms.
    #[serde(rename = "term")]
    pub terms: Vec<Term>,
}

/// A symbol, word or sign.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// Symbol as the screen shows it.
    pub symbol: String,
    /// The symbol in ASCII; `None` if it is ASCII already.
    name: Option<String>,
    /// Meaning of the term, in words.
    pub meaning: String,
    /// Equation or condition that defines the term; may be empty.
    #[serde(default)]
    pub equation: String,
    /// Key of the knob that the term names; `None` if it is not a knob.
    knob: Option<String>,
}

/// Description of a view.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewWords {
    name: String,
    /// What the view draws.
    pub drawn: String,
    /// What to look for in the view.
    pub look: String,
    /// The keys that act on the view.
    pub keys: String,
}

/// The parsed glossary. The file is embedded, and a test checks that it parses.
static GLOSSARY: LazyLock<Glossary> = LazyLock::new(|| toml::from_str(TEXT).unwrap_or_default());

/// Returns the sections of the glossary.
pub fn sections() -> &'static [Section] {
    &GLOSSARY.section
}

/// Returns whether a term of the file explains the knob of a key.
pub fn explains(path: &str) -> bool {
    let mut terms = GLOSSARY.section.iter().flat_map(|section| &section.terms);
    terms.any(|term| term.knob.as_deref() == Some(path))
}

/// Returns the description of a view; `None` if the glossary has none.
pub fn view(view: ViewId) -> Option<&'static ViewWords> {
    GLOSSARY.view.iter().find(|words| words.name == view.word())
}

impl Term {
    /// Returns the meaning, the equation and the value in the present scene as one text.
    pub fn text(&self, app: &App) -> String {
        let mut text = self.meaning.clone();
        if !self.equation.is_empty() {
            text.push_str(": ");
            text.push_str(&self.equation);
        }
        if let Some(value) = self.value(app) {
            text.push_str("; here ");
            text.push_str(&value);
        }
        text
    }

    /// Returns the symbol in ASCII.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.symbol)
    }

    fn value(&self, app: &App) -> Option<String> {
        if let Some(path) = &self.knob {
            return knob_of(path).map(|knob| knob.text(&app.scene));
        }
        let (_, unit, value) = VALUES.iter().find(|(name, ..)| *name == self.name())?;
        let value = value(app).filter(|value| value.is_finite())?;
        let (value, unit) = match *unit {
            FREQUENCY => (per_frequency(value), frequency_unit()),
            unit => in_shown_unit(value, unit),
        };
        let rounded: f64 = format!("{value:.3e}").parse().ok()?;
        Some(number(rounded, unit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::motion::Verdict;
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(
            Scene::builtin("paper-nd3").unwrap().checked().unwrap(),
            Theme::Mono,
            Marker::Braille,
        )
    }

    fn terms() -> impl Iterator<Item = &'static Term> {
        sections().iter().flat_map(|section| &section.terms)
    }

    #[test]
    fn the_file_is_read_and_says_something_about_every_verdict_and_view() {
        toml::from_str::<Glossary>(TEXT).unwrap();
        for verdict in Verdict::ALL {
            assert!(terms().any(|term| term.symbol == verdict.as_ref()), "{verdict}");
        }
        for known in ViewId::all() {
            assert!(view(known).is_some(), "{}", known.word());
        }
        assert_eq!(GLOSSARY.view.len(), ViewId::all().count());
    }

    /// Returns the source code of the explorer, without tests, comments and the function that
    /// spells text in ASCII.
    fn code(folder: &std::path::Path) -> String {
        let mut out = String::new();
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                out.push_str(&code(&path));
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let own = text.split("#[cfg(test)]").next().unwrap_or_default();
            let drawn = |line: &&str| {
                let line = line.trim();
                !line.starts_with("//") && !line.contains("=> out.push")
            };
            out.extend(own.lines().filter(drawn));
        }
        out
    }

    #[test]
    fn every_sign_that_is_explained_is_drawn() {
        let code = code(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/tui"));
        let signs = sections().iter().find(|section| section.heading == "Signs").unwrap();
        for sign in signs.terms.iter().flat_map(|term| term.symbol.split(' ')) {
            // Braille dots appear in any pattern, not only this one.
            assert!(sign == "⠿" || code.contains(sign), "{sign} is not drawn");
        }
        assert!(!code.contains('▪'), "the code is read without tests");
    }

    #[test]
    fn every_value_is_there_and_is_that_of_the_scene() {
        let app = app();
        for (name, ..) in VALUES {
            assert_eq!(terms().filter(|term| term.name() == *name).count(), 1, "{name}");
        }
        for term in terms() {
            let of = |name: &str| VALUES.iter().any(|(known, ..)| *known == name);
            // In this scene the lock has no upper end.
            let has = (term.knob.is_some() || of(term.name())) && term.symbol != "lock ends";
            assert_eq!(term.value(&app).is_some(), has, "{}", term.symbol);
            assert!(term.name().is_ascii(), "{}", term.symbol);
        }
    }
}
