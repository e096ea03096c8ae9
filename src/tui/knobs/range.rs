//! The bar of a knob as numbers: its usual range, the limits marked on it (speed limits, and the
//! smallest pulse that makes a blade touch), and the value at a position on the bar.

use rubscope_solver::model::Machine;
use rubscope_solver::scene::keys::Turn;
use rubscope_solver::scene::{ContactLaw, Scene};

/// The range of values that a bar covers, for a knob or a limit. Values outside it are shown at its
/// ends.
#[derive(Clone, Debug, PartialEq)]
pub struct KnobRange {
    low: f64,
    high: f64,
    /// Whether the scale is logarithmic.
    log: bool,
    /// -1 if the bar shows the magnitudes of negative values, otherwise 1.
    sign: f64,
    /// Limits marked on the bar: name and position, from 0 (left) to 1.
    pub marks: Vec<(&'static str, f64)>,
}

impl KnobRange {
    /// Creates a linear range.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, log: false, sign: 1.0, marks: Vec::new() }
    }

    /// Creates a logarithmic range.
    pub fn log(low: f64, high: f64) -> Self {
        Self { log: true, ..Self::linear(low, high) }
    }

    pub fn signed(self, value: f64) -> Self {
        Self { sign: if value < 0.0 { -1.0 } else { 1.0 }, ..self }
    }

    pub fn marked(mut self, marks: &[(&'static str, Option<f64>)]) -> Self {
        let inside = |at: f64| at.is_finite() && at > self.low && at < self.high;
        let marks = marks.iter().filter_map(|(name, at)| Some((*name, (*at)?)));
        let marks: Vec<_> = marks.filter(|(_, at)| inside(*at)).collect();
        self.marks =
            marks.into_iter().map(|(name, at)| (name, self.part(self.sign * at))).collect();
        self
    }

    /// Returns the two ends, the lower first, with the fraction `without` of the bar cut off at
    /// each, and whether an axis between them can be logarithmic.
    pub fn ends(&self, without: f64) -> (f64, f64, bool) {
        let (low, high) = (self.at(without), self.at(1.0 - without));
        (low.min(high), high.max(low), self.log && self.sign > 0.0)
    }

    /// Returns whether the range is finite and not empty, and positive if it is logarithmic.
    pub fn is_sound(&self) -> bool {
        let ends = self.low.is_finite() && self.high.is_finite() && self.high > self.low;
        ends && (!self.log || self.low > 0.0)
    }

    /// Returns the position of a value on the bar, limited to 0 to 1.
    pub fn part(&self, value: f64) -> f64 {
        let value = value * self.sign;
        let part = match self.log {
            true if value <= self.low => 0.0,
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Returns the position of a value; `None` for 0 on a logarithmic scale.
    pub fn place(&self, value: f64) -> Option<f64> {
        (!self.log || value != 0.0).then(|| self.part(value))
    }

    /// Describes a value near a marked limit, as in `just above Ω_lock`; `None` if none is near.
    pub fn near_mark(&self, value: f64) -> Option<String> {
        let here = self.place(value)?;
        let near = self.marks.iter().map(|(name, at)| (name, here - at));
        let (name, apart) = near.min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        let side = match apart {
            apart if apart.abs() > NEAR => return None,
            0.0 => "at",
            apart if apart > 0.0 => "just above",
            _ => "just below",
        };
        Some(format!("{side} {name}"))
    }

    /// Returns the value at a position of the bar, 0 to 1.
    pub fn at(&self, part: f64) -> f64 {
        let part = part.clamp(0.0, 1.0);
        self.sign
            * match self.log {
                true => self.low * (self.high / self.low).powf(part),
                false => self.low + part * (self.high - self.low),
            }
    }
}

/// Largest distance at which a value counts as near a limit, as a fraction of the bar.
const NEAR: f64 = 0.1;
/// Ratio of the upper end of a logarithmic bar to the usual value, and of that to the lower end.
pub const AROUND: f64 = 10.0;

/// How the range of a knob's bar is chosen.
#[derive(Clone, Copy, Debug)]
pub enum Bar {
    /// A decade on each side of the value in the opened scene, on a logarithmic scale; for a whole
    /// number, from half to twice that value on a linear scale.
    Around,
    /// Between two values in the unit of the key, on a linear scale.
    From(f64, f64),
    /// Computed from the scene by this function.
    Of(fn(&Case) -> KnobRange),
}

/// Data from which the range of a bar is computed.
#[derive(Debug)]
pub struct Case<'a> {
    /// How the knob steps through its values.
    pub turn: Turn,
    /// Value of the knob.
    pub value: f64,
    /// Value of the knob in the scene as it was opened.
    pub opened: f64,
    /// Magnitude of the value where it was 0 as the scene was opened.
    pub usual: f64,
    pub scene: &'a Scene,
    pub machine: &'a Machine,
}

impl Case<'_> {
    /// Returns the magnitude of the clearance \[m\].
    pub fn clearance(&self) -> f64 {
        self.machine.clearance().abs()
    }

    pub fn blades(&self) -> f64 {
        f64::from(self.scene.bladed_disk.blades)
    }

    pub fn has_lining(&self) -> bool {
        self.scene.solver.contact == ContactLaw::Smooth
    }

    /// Returns the magnitude of the knob in the opened scene, or its usual one if that is 0.
    pub fn usual(&self) -> f64 {
        if self.opened == 0.0 { self.usual } else { self.opened.abs() }
    }

    pub fn around(&self) -> KnobRange {
        let usual = self.usual();
        match self.turn {
            Turn::Whole(..) => KnobRange::linear((0.5 * usual).floor(), 2.0 * usual),
            _ => KnobRange::log(usual / AROUND, usual * AROUND).signed(self.value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::{KNOBS, knob_of};
    use rubscope_solver::scene::Value;

    fn range(path: &str, scene: &Scene) -> Option<KnobRange> {
        let knob = knob_of(path).unwrap();
        knob.range(knob.number(scene)?, scene, &scene.machine())
    }

    #[test]
    fn every_number_has_a_bar_and_its_place_gives_it_back() {
        for name in ["paper-nd3", "paper-nd4", "run-down", "grazing", "undamped"] {
            let scene = Scene::builtin(name).unwrap();
            for knob in KNOBS.iter() {
                let Some(range) = range(knob.path, &scene) else {
                    assert!(matches!(knob.turn, Turn::Words), "{name} {}", knob.label);
                    continue;
                };
                for part in [0.0, 0.25, 0.5, 1.0] {
                    let there = range.part(range.at(part));
                    assert!((there - part).abs() < 1e-9, "{name} {} {part} {there}", knob.label);
                }
                for (name, at) in &range.marks {
                    assert!((0.0..=1.0).contains(at), "{name}");
                }
            }
        }
    }

    #[test]
    fn the_speed_shows_its_limits_whichever_way_it_turns() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        let forward = range("operation.speed_rad_s", &scene).unwrap();
        let names: Vec<&str> = forward.marks.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["the adhesive limit", "Ω_c", "Ω_lock"]);
        for (mark, speed) in forward.marks.iter().zip([294.990, 292.878, 411.928]) {
            assert!((forward.at(mark.1) - speed).abs() < 1e-2, "{mark:?} {speed}");
        }
        scene.operation.speed_rad_s = -430.0;
        let back = range("operation.speed_rad_s", &scene).unwrap();
        assert_eq!(back.marks, forward.marks);
        for (range, sign) in [(&forward, 1.0), (&back, -1.0)] {
            let beside = |speed: f64| range.near_mark(sign * speed);
            assert_eq!(beside(430.0).as_deref(), Some("just above Ω_lock"));
            assert_eq!(beside(405.0).as_deref(), Some("just below Ω_lock"));
            assert_eq!((beside(100.0), beside(500.0)), (None, None));
        }
        assert!((back.at(back.part(-430.0)) + 430.0).abs() < 1e-9);
    }

    #[test]
    fn a_click_in_a_bar_gives_a_round_value() {
        let of = |path: &str, x| knob_of(path).unwrap().near(x);
        assert_eq!(of("operation.speed_rad_s", 431.7), Some(Value::Real(430.0)));
        assert_eq!(of("casing.damping_ratio", 0.0512), Some(Value::Real(0.05)));
        assert_eq!(of("operation.pulse_n", 43_423.0), Some(Value::Real(43_000.0)));
        assert_eq!(of("operation.nodal_diameters", 2.6), Some(Value::Whole(3)));
        assert_eq!(of("bladed_disk.blades", -5.0), Some(Value::Whole(1)));
        assert_eq!(of("solver.kind", 0.5), None);
    }

    #[test]
    fn the_pulse_shows_the_first_touch_where_the_casing_begins_at_rest() {
        let scene = Scene::builtin("paper-nd3").unwrap();
        let of = |change: fn(&mut Scene)| {
            let mut scene = scene.clone();
            change(&mut scene);
            let range = range("operation.pulse_n", &scene).unwrap();
            range.marks.first().map(|(_, part)| range.at(*part))
        };
        assert!((of(|_| ()).unwrap() - 3795.0).abs() < 1.0);
        assert!((of(|scene| scene.operation.pulse_n = -1e3).unwrap() + 3795.0).abs() < 1.0);
        assert_eq!(of(|scene| scene.operation.pulse_s = 0.0), None);
        assert_eq!(of(|scene| scene.initial.v_c_m_s = 0.1), None);
        let undamped = of(|scene| (scene.casing.damping_ratio, scene.solver.end_s) = (0.0, 10.0));
        assert!(undamped.unwrap() < 3795.0, "{undamped:?}");
    }
}
