//! Finds the knob that typed words name, and rates the match.

use super::knob::Knob;
use super::table::{KNOBS, knob_of};
use crate::tui::appearance::Appearance;
use crate::tui::raster::Marker;
use crate::tui::theme::Theme;
use rubscope_solver::scene::{Allowed, SceneError, Value, keys};

/// Quality of a match, the best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fit {
    /// The typed words are the label, with or without its symbol, or the key.
    Name,
    /// The typed words are the symbol; a single letter must match in case.
    Symbol,
    /// The typed word is one word of the label.
    Word,
    /// Every typed word begins a word of the label or of the key.
    Begins,
}

/// Parts of a key that are units, which do not name a knob.
const UNITS: [&str; 9] = ["n", "m", "s", "rad", "s2", "kg", "m2", "nm", "per"];

/// Rates how well typed words name a knob; `None` if they do not. Greek letters may be spelled out.
pub fn fit(knob: &Knob, words: &[&str]) -> Option<Fit> {
    let typed = words.join(" ");
    let lower = typed.to_lowercase();
    let plain = plain(knob.label);
    let (label, name) = (knob.label.to_lowercase(), knob.name().to_lowercase());
    let spelled = plain.to_lowercase();
    let law = match knob.path {
        keys::LAW => "law",
        keys::SPEED => "omega",
        path => path,
    };
    if [label.as_str(), spelled.as_str(), name.as_str(), law, knob.path].contains(&&*lower) {
        return Some(Fit::Name);
    }
    let is_one = typed.chars().count() == 1;
    let symbols = [knob.symbol(), plain.split(' ').next_back().unwrap_or_default()];
    let joined = lower.replace('_', "");
    let is_like = |own: &str| !is_one && own.to_lowercase().replace('_', "") == joined;
    if symbols.iter().any(|own| *own == typed || is_like(own)) {
        return Some(Fit::Symbol);
    }
    let own = || label.split(' ').chain(spelled.split(' '));
    if !is_one && own().any(|own| own == lower) {
        return Some(Fit::Word);
    }
    let key = knob.path.split(['.', '_']).filter(|word| !UNITS.contains(word));
    let names: Vec<&str> = own().chain(key).chain([law, knob.path]).collect();
    let begins = |word: &&str| names.iter().any(|name| name.starts_with(&word.to_lowercase()));
    words.iter().all(begins).then_some(Fit::Begins)
}

/// Returns the index in [`KNOBS`] of the knob that a whole line names by its label, the first word
/// of its label, or its symbol; `None` for any other text.
pub fn called(typed: &str) -> Option<usize> {
    let words: Vec<&str> = typed.split_whitespace().collect();
    let place = |wanted: Fit, has: fn(&Knob) -> bool| {
        KNOBS.iter().position(|knob| has(knob) && fit(knob, &words) == Some(wanted))
    };
    let begins = |knob: &Knob| {
        plain(knob.label).to_lowercase().split(' ').next() == Some(&typed.to_lowercase())
    };
    place(Fit::Name, |_| true)
        .or_else(|| KNOBS.iter().position(begins))
        .or_else(|| place(Fit::Symbol, |knob| knob.name() != knob.label))
}

/// Returns the value of an error, which is in the unit of its key, as the knob of the key shows it.
fn told(key: &str, value: &str) -> String {
    let real = |knob: &&Knob| matches!(knob.allowed(), Allowed::Real { .. });
    let shown = knob_of(key).filter(real).and_then(|knob| {
        let number = value.strip_suffix(knob.unit()).unwrap_or(value).trim_end().parse();
        Some(knob.shown(&Value::Real(number.ok()?)))
    });
    shown.unwrap_or_else(|| value.to_string())
}

/// Spells a text in ASCII.
pub fn plain(text: &str) -> String {
    Appearance::new(Theme::Mono, Marker::Ascii).spell(text)
}

impl Knob {
    /// Returns the message for a refused value, with the labels of knobs in place of keys.
    pub fn refusal(&self, error: &SceneError) -> String {
        if let SceneError::Unit { value, why, .. } = error {
            return format!("{}: {value} cannot be read: {why}", self.label);
        }
        let SceneError::Refused { key, value, allowed } = error else { return error.to_string() };
        let words = |text: &str| {
            KNOBS.iter().fold(text.to_string(), |text, knob| text.replace(knob.path, knob.label))
        };
        let own = key == self.path;
        // False if the error comes from `parse` itself: the text is not a value at all.
        let reads = self.parse(value).err().as_ref() != Some(error);
        let shown = told(key, value);
        if !own || (reads && *allowed != self.allowed().to_string()) {
            let (key, allowed) = (words(key), words(allowed));
            return format!("{key}: {shown} is not possible; allowed is {allowed}");
        }
        let why = match self.allowed() {
            _ if reads => "is not possible",
            Allowed::OneOf(_) => "is unknown",
            Allowed::Whole { .. } => "is not a whole number",
            _ => "is not a number",
        };
        format!("{}: {shown} {why}; {}", self.label, self.range_words())
    }
}
