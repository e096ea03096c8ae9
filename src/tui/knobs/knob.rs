//! A knob: its value in a scene, setting, turning, and typing it, the range of its bar, and its text.

use std::sync::LazyLock;

use strum::VariantArray;

use super::inert::Inert;
use super::number::{self, decades, mantissas};
use super::range::{Bar, Case, KnobRange};
use crate::sheet::number::{from_shown, in_shown_unit, rounded, with_typed_unit};
use crate::tui::axis;
use crate::tui::field::Field;
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{
    Adjustment, Allowed, CheckedScene, ContactLaw, Scene, SceneError, Value, keys,
    keys::{CLEARANCE, Key, Turn},
};

/// The contact laws in the order of their knob: one step up from the paper's bilateral law is the
/// unilateral one.
const LAWS: [&str; 3] = ["bilateral", "unilateral", "smooth"];

/// Groups of knobs, in the order of the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum Group {
    /// Speed, pulse, dampings, contact and solver.
    Operation,
    /// Pulse and speed as functions of time.
    Time,
    /// Model size and numerical accuracy.
    Model,
    /// Casing and bladed disk.
    Machine,
    /// Extensions of the model of the paper: coupled tips, friction, linings.
    Beyond,
    /// Unequal tips and the shape of the casing.
    Tips,
    /// State at t = 0, and the excitation.
    Start,
}

impl Group {
    /// Returns the heading of the group.
    pub fn name(self) -> &'static str {
        ["operation", "time", "model", "machine", "beyond the paper", "tips and shape", "start"]
            [self as usize]
    }
}

/// An entry of the knob table.
#[derive(Debug)]
pub struct Knob {
    /// Group of the panel that lists the knob.
    pub group: Group,
    /// Short name, which usually ends in the symbol.
    pub label: &'static str,
    /// Path of its key.
    pub path: &'static str,
    /// Key of the scene that the knob sets.
    pub key: &'static Key,
    /// How the knob steps through its values.
    pub turn: Turn,
    /// Effect of turning the knob, in one sentence.
    pub does: &'static str,
    /// How the range of the knob's bar is chosen.
    pub(super) bar: Bar,
    /// Usual magnitude of the value, in the unit of the key, for the bar of a knob that is 0 in the
    /// opened scene.
    pub(super) usual: f64,
    /// Returns why the knob has no effect in a scene; `None` if it has an effect.
    pub(super) inert: Inert,
}

/// The base scene, which has the paper's values.
static PAPER: LazyLock<Scene> = LazyLock::new(Scene::base);

impl Knob {
    /// Returns the value of the knob in a scene.
    pub fn get(&self, scene: &Scene) -> Value {
        match (self.key.get)(scene) {
            // Twelve digits: a difference of two lengths is not more accurate.
            Value::Real(g0) if self.path == CLEARANCE => {
                Value::Real(format!("{g0:.11e}").parse().unwrap_or(g0))
            }
            value => value,
        }
    }

    /// Returns the scene with this value, checked. If the value needs another solver, contact law
    /// or model, the nearest combination that works is chosen, and the message says so; otherwise
    /// it is `None`.
    ///
    /// # Errors
    /// The value is refused, for this reason.
    pub fn set(
        &self,
        scene: &Scene,
        value: Value,
    ) -> Result<(CheckedScene, Option<String>), SceneError> {
        let mut changed = scene.clone();
        changed.set_value(self.key, value)?;
        let made = changed.make_compatible(|key| key == self.path);
        let said = made.iter().map(|Adjustment { key, from, to, why }| {
            let key = key.trim_end_matches(".kind").trim_start_matches("solver.");
            format!("{key} is now {to}, not {from}, which {why}")
        });
        let said = Some(said.collect::<Vec<_>>().join("; ")).filter(|said| !said.is_empty());
        let changed = changed.checked()?;
        if scene.slides().is_ok() {
            changed.slides()?;
        }
        Ok((changed, said))
    }

    /// Returns the value one step above or below `value`, within the bounds of the knob.
    pub fn turned(&self, value: &Value, up: bool, coarse: bool, scene: &Scene) -> Value {
        match (value, self.turn) {
            (Value::Real(x), Turn::Linear(fine, large)) => {
                let step = if coarse { large } else { fine };
                Value::Real(self.stepped(*x, step, Some(up)))
            }
            (Value::Real(x), Turn::Decades(_)) if self.path == CLEARANCE => {
                Value::Real(number::turned(*x, up, coarse, scene))
            }
            (Value::Real(x), Turn::Decades(least)) => {
                Value::Real(self.bounded(decades(*x, up, mantissas(coarse), least)))
            }
            (Value::Whole(n), Turn::Whole(fine, large)) => {
                let step = if coarse { large } else { fine };
                let Allowed::Whole { min, mut max } = self.allowed() else { return value.clone() };
                if self.path == keys::DIAMETERS {
                    // More than N/2 nodal diameters are equivalent to fewer, so steps end there;
                    // they can still be typed.
                    max = max.min(u64::from(scene.bladed_disk.blades / 2)).max(*n);
                }
                let next = if up { n.saturating_add(step) } else { n.saturating_sub(step) };
                Value::Whole(next.clamp(min, max.max(min)))
            }
            (Value::Text(word), Turn::Words) => {
                let Allowed::OneOf(mut words) = self.allowed() else { return value.clone() };
                if self.path == keys::LAW {
                    words = &LAWS;
                }
                let place = words.iter().position(|w| w == word).unwrap_or(0);
                let next = if up { place + 1 } else { place + words.len().saturating_sub(1) };
                let next = words.get(next % words.len().max(1));
                Value::Text(next.map_or_else(|| word.clone(), ToString::to_string))
            }
            _ => value.clone(),
        }
    }

    /// Returns the next multiple of `step` above or below `x`, or the nearest if `up` is `None`,
    /// within bounds. Multiples are counted in the shown unit.
    fn stepped(&self, x: f64, step: f64, up: Option<bool>) -> f64 {
        let (shown, unit) = in_shown_unit(x, self.unit());
        // 1 rpm is about a tenth of a rad/s.
        let step = if unit == self.unit() { step } else { 10.0 * step };
        let at = shown / step;
        let multiple = match up {
            Some(true) => (at + 1e-9).floor() + 1.0,
            Some(false) => (at - 1e-9).ceil() - 1.0,
            None => at.round(),
        };
        let next = multiple * step;
        // Through decimal digits, to remove the round-off of the multiplication.
        let digits = (-step.log10()).ceil().clamp(0.0, 12.0) as usize + 1;
        let next = format!("{next:.digits$}").parse().unwrap_or(next);
        self.bounded(from_shown(next, self.unit()))
    }

    fn bounded(&self, x: f64) -> f64 {
        match self.allowed() {
            Allowed::Real { min, max, .. } => x.clamp(min, max),
            _ => x,
        }
    }

    /// Returns the values that the knob accepts.
    pub fn allowed(&self) -> Allowed {
        self.key.allowed
    }

    /// Returns the SI unit of the knob; empty for words and counts.
    pub fn unit(&self) -> &'static str {
        self.key.unit.trim_matches('-')
    }

    /// Formats the value of the knob in a scene, with prefix and unit.
    pub fn text(&self, scene: &Scene) -> String {
        self.shown(&self.get(scene))
    }

    /// Formats a value of this knob, with prefix and unit.
    pub fn shown(&self, value: &Value) -> String {
        match value {
            Value::Real(x) => axis::number(*x, self.unit()),
            Value::Text(word) => word.clone(),
            other => other.to_string(),
        }
    }

    /// Returns the last word of the label, which is the symbol if the knob has one.
    pub fn symbol(&self) -> &'static str {
        self.label.split(' ').next_back().unwrap_or(self.label)
    }

    /// Returns the label without its symbol; the whole label if it has none.
    pub fn name(&self) -> &'static str {
        let is_word = |word: &str| word.len() > 1 && word.bytes().all(|b| b.is_ascii_lowercase());
        match self.label.rsplit_once(' ') {
            Some((name, last)) if !is_word(last) => name,
            _ => self.label,
        }
    }

    /// Describes the allowed values: the words, or the bounds with the unit shown.
    pub fn range_words(&self) -> String {
        let (factor, unit) = match self.is_of_clearance() {
            true => (1e3, "mm or % of g0"),
            false => in_shown_unit(1.0, self.unit()),
        };
        let words = match self.allowed() {
            Allowed::OneOf(words) => return format!("one of {}", words.join(", ")),
            Allowed::Real { min, max, above } if factor != 1.0 => {
                let [min, max] = [min, max].map(|end| rounded(end * factor, 6));
                Allowed::Real { min, max, above }.to_string()
            }
            other => other.to_string(),
        };
        let words = words.trim_start_matches("a whole number ").trim_start_matches("a number ");
        format!("{words} {unit}").trim_end().to_string()
    }

    /// Returns whether a share of this length is one of the clearance.
    pub fn is_of_clearance(&self) -> bool {
        self.group == Group::Tips && self.unit() == "m"
    }

    /// Returns the text typed so far in at most `columns` columns, with a cursor and the unit that
    /// a plain number gets.
    pub fn typed(&self, text: &Field, columns: usize) -> String {
        let unit = in_shown_unit(0.0, self.unit()).1;
        let text = text.shown(columns.saturating_sub(unit.chars().count() + 1));
        format!("{text} {unit}").trim_end().to_string()
    }

    /// Parses typed text: a number, with or without a unit or an SI prefix, or a word or its
    /// beginning.
    ///
    /// # Errors
    /// The text is refused, for this reason.
    pub fn parse(&self, text: &str) -> Result<Value, SceneError> {
        let text = text.trim();
        let refused = || SceneError::refused(self.path, text, self.allowed().to_string());
        if let Allowed::OneOf(words) = self.allowed() {
            let found = words.iter().find(|word| !text.is_empty() && word.starts_with(text));
            return found.map(|word| Value::Text((*word).to_string())).ok_or_else(refused);
        }
        match self.key.parse(&with_typed_unit(text, self.key.quantity()))? {
            Value::Real(x) if !x.is_finite() => Err(refused()),
            value => Ok(value),
        }
    }

    /// Returns the range of the knob's bar with its marks, where the value was `opened` as the scene
    /// was opened; `None` for words, and for a range that is empty or not finite.
    pub fn range(&self, opened: f64, scene: &Scene, machine: &Machine) -> Option<KnobRange> {
        let (turn, value, usual) = (self.turn, self.number(scene)?, self.usual);
        let case = Case { turn, value, opened, usual, scene, machine };
        let range = match self.bar {
            Bar::Around => case.around(),
            Bar::From(low, high) => KnobRange::linear(low, high),
            Bar::Of(range) => range(&case),
        };
        Some(range).filter(KnobRange::is_sound)
    }

    /// Returns the value of the knob in a scene as a number; `None` for words.
    pub fn number(&self, scene: &Scene) -> Option<f64> {
        match self.get(scene) {
            Value::Real(x) => Some(x),
            Value::Whole(n) => Some(n as f64),
            _ => None,
        }
    }

    /// Returns the value nearest to `x` that turning the knob can give, for a click in its bar;
    /// `None` for words.
    pub fn near(&self, x: f64) -> Option<Value> {
        match (self.turn, self.allowed()) {
            (Turn::Linear(fine, _), _) => Some(Value::Real(self.stepped(x, fine, None))),
            (Turn::Decades(_), _) => Some(Value::Real(self.bounded(rounded(x, 2)))),
            (Turn::Whole(..), Allowed::Whole { min, max }) => {
                // The cast saturates, so negative and huge numbers end at a bound.
                Some(Value::Whole((x.round() as u64).clamp(min, max)))
            }
            _ => None,
        }
    }

    /// Returns why this knob has no effect on the run of a scene; `None` if it has an effect.
    pub fn inert(&self, scene: &Scene) -> Option<&'static str> {
        (self.inert)(scene)
    }

    /// Returns whether the knob takes the scene beyond the paper's model: it is of the group
    /// [`Group::Beyond`], and its value differs from the paper's or describes the lining of the
    /// scene.
    pub fn leaves_the_paper(&self, scene: &Scene) -> bool {
        let lining = self.path.starts_with("contact.s");
        self.group == Group::Beyond
            && (self.get(scene) != self.get(&PAPER)
                || (lining && scene.solver.contact == ContactLaw::Smooth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::tui::knobs::{KNOBS, knob_of};

    fn knob(path: &str) -> &'static Knob {
        knob_of(path).unwrap()
    }

    #[test]
    fn every_knob_reads_and_writes_a_scene() {
        let scene = Scene::base();
        for knob in KNOBS.iter() {
            let value = knob.get(&scene);
            let (again, _) = knob.set(&scene, value.clone()).unwrap();
            assert_eq!(knob.get(&again), value, "{}", knob.label);
            assert!(!knob.shown(&value).is_empty() && !knob.does.is_empty());
        }
    }

    #[test]
    fn groups_follow_each_other_and_have_every_knob() {
        let places: Vec<usize> = Group::VARIANTS
            .iter()
            .flat_map(|group| group.knobs())
            .map(|(place, _)| place)
            .collect();
        assert_eq!(places, (0..KNOBS.len()).collect::<Vec<_>>());
        let first: Vec<&str> = KNOBS.iter().take(5).map(|knob| knob.label).collect();
        assert_eq!(first, ["speed Ω", "pulse F", "diameters n_d", "damping ζ_c", "damping ζ_bd"]);
    }

    #[test]
    fn every_number_of_a_scene_has_a_knob() {
        // The `view` keys choose what the explorer shows and do not affect the motion.
        for key in keys::KEYS.iter().filter(|key| !key.path.starts_with("view.")) {
            let numeric = matches!(key.allowed, Allowed::Real { .. } | Allowed::Whole { .. });
            let knobs = KNOBS.iter().filter(|knob| knob.path == key.path).count();
            let wanted = usize::from(numeric || matches!(key.allowed, Allowed::OneOf(_)));
            assert_eq!(knobs, wanted, "{}", key.path);
        }
    }

    #[test]
    fn turning_up_and_down_again_comes_back() {
        let scene = Scene::base();
        for (path, values) in [
            ("operation.pulse_n", vec![20e3, 1e6, 5e-1 * 20e3]),
            ("operation.speed_rad_s", vec![500.0, -430.0, 0.0]),
            ("casing.damping_ratio", vec![0.05, 0.015]),
            ("solver.step_s", vec![1e-7, 2e-6]),
        ] {
            for x in values {
                for coarse in [false, true] {
                    let up = knob(path).turned(&Value::Real(x), true, coarse, &scene);
                    assert_ne!(up, Value::Real(x));
                    if !coarse {
                        let back = knob(path).turned(&up, false, coarse, &scene);
                        assert_eq!(back, Value::Real(x), "{path} {x}");
                    }
                }
            }
        }
    }

    #[test]
    fn pulses_pass_through_zero() {
        let pulse = knob("operation.pulse_n");
        let scene = Scene::base();
        let zero = pulse.turned(&Value::Real(1.0), false, true, &scene);
        assert_eq!(zero, Value::Real(0.0));
        assert_eq!(pulse.turned(&zero, true, true, &scene), Value::Real(1.0));
        assert_eq!(pulse.turned(&Value::Real(-20e3), true, true, &scene), Value::Real(-10e3));
    }
}
