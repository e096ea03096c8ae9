//! The bar of a knob as numbers: its usual range, which is a column of the table, the limits
//! marked on it, among them the pulse from which on a blade touches, and the value at a place of
//! the bar.

use crate::report::number::rounded;
use crate::tui::knobs::{Knob, Turn};
use rubscope_solver::model::{Initial, Machine};
use rubscope_solver::scene::{Allowed, ContactLaw, Scene, Value};

/// The usual range of a knob, or of a limit, on which its bar is drawn. Values may be
/// beyond it.
#[derive(Clone, Debug, PartialEq)]
pub struct KnobRange {
    low: f64,
    high: f64,
    /// Whether equal factors have equal widths.
    log: bool,
    /// Minus one where the bar shows magnitudes of negative values.
    sign: f64,
    /// Limits on it, the most important last: a letter and a place, 0 to 1.
    pub marks: Vec<(char, f64)>,
}

impl KnobRange {
    /// Creates a range on which equal differences have equal widths.
    pub fn linear(low: f64, high: f64) -> Self {
        Self { low, high, log: false, sign: 1.0, marks: Vec::new() }
    }

    /// Creates a range on which equal factors have equal widths.
    pub fn log(low: f64, high: f64) -> Self {
        Self { log: true, ..Self::linear(low, high) }
    }

    fn signed(self, value: f64) -> Self {
        Self { sign: if value < 0.0 { -1.0 } else { 1.0 }, ..self }
    }

    fn marked(mut self, marks: &[(char, Option<f64>)]) -> Self {
        let inside = |at: f64| at.is_finite() && at > self.low && at < self.high;
        let marks = marks.iter().filter_map(|(letter, at)| Some((*letter, (*at)?)));
        let marks: Vec<_> = marks.filter(|(_, at)| inside(*at)).collect();
        self.marks =
            marks.into_iter().map(|(letter, at)| (letter, self.part(self.sign * at))).collect();
        self
    }

    /// Returns whether there are places on it.
    pub fn is_sound(&self) -> bool {
        let ends = self.low.is_finite() && self.high.is_finite() && self.high > self.low;
        ends && (!self.log || self.low > 0.0)
    }

    /// Returns the place of a value on the bar, 0 to 1.
    pub fn part(&self, value: f64) -> f64 {
        let value = value * self.sign;
        let part = match self.log {
            true if value <= self.low => 0.0,
            true => (value / self.low).ln() / (self.high / self.low).ln(),
            false => (value - self.low) / (self.high - self.low),
        };
        if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Returns where a value stands; nowhere for 0 on a scale of factors.
    pub fn place(&self, value: f64) -> Option<f64> {
        (!self.log || value != 0.0).then(|| self.part(value))
    }

    /// Returns the value at a place of the bar.
    pub fn at(&self, part: f64) -> f64 {
        let part = part.clamp(0.0, 1.0);
        self.sign
            * match self.log {
                true => self.low * (self.high / self.low).powf(part),
                false => self.low + part * (self.high - self.low),
            }
    }
}

/// Factor below and above the value of the opened scene.
const AROUND: f64 = 10.0;

/// The range of the bar of a knob.
#[derive(Clone, Copy, Debug)]
pub enum Bar {
    /// A decade below and above the value of the opened scene, by factors.
    Around,
    /// Range from one value to another.
    From(f64, f64),
    /// Range that follows from the scene.
    Of(fn(&Case) -> KnobRange),
}

/// The letters on bars, and what they mean.
const LETTERS: [(char, &str); 10] = [
    ('a', "adhesive limit"),
    ('e', "lock ends"),
    ('x', "coincidence"),
    ('c', "Ω_c"),
    ('L', "Ω_lock"),
    ('t', "a blade touches"),
    ('n', "as the casing"),
    ('0', "zero"),
    ('d', "blades dig in below"),
    ('r', "a ring: 1/n_d"),
];

/// Returns what a letter on a bar means.
pub fn meaning(letter: char) -> &'static str {
    LETTERS.iter().find(|(known, _)| *known == letter).map_or("", |(_, meaning)| meaning)
}

/// Data from which the range of a bar follows.
#[derive(Debug)]
pub struct Case<'a> {
    knob: &'a Knob,
    value: f64,
    scene: &'a Scene,
    opened: &'a Scene,
    machine: &'a Machine,
}

impl Case<'_> {
    fn clearance(&self) -> f64 {
        self.machine.clearance().abs()
    }

    fn blades(&self) -> f64 {
        f64::from(self.scene.bladed_disk.blades)
    }

    fn has_lining(&self) -> bool {
        self.scene.solver.contact == ContactLaw::Smooth
    }

    /// Returns the magnitude in the opened scene, or what is usual where it is 0 there.
    fn usual(&self) -> f64 {
        let value = self.knob.number(self.opened).unwrap_or(0.0).abs();
        if value > 0.0 { value } else { self.knob.usual }
    }

    fn around(&self) -> KnobRange {
        let usual = self.usual();
        KnobRange::log(usual / AROUND, usual * AROUND).signed(self.value)
    }
}

/// The ranges that follow from the scene.
pub mod bars {
    use super::{AROUND, Case, KnobRange, touching_pulse};
    use rubscope_solver::harmonic::lock_window;

    /// End of the bar of the speed over the greatest threshold.
    const BEYOND: f64 = 1.5;

    pub fn speed(case: &Case) -> KnobRange {
        let machine = case.machine;
        let window = lock_window(machine, case.value);
        let lock = window.map(|window| window.from);
        let limits = [machine.critical_speed(), lock, machine.dangerous_speed()];
        let most = limits.into_iter().flatten().fold(0.0, f64::max);
        let most = if most > 0.0 { most } else { machine.omega_c };
        // The most important one last: it covers the others in its cell.
        KnobRange::linear(0.0, BEYOND * most).signed(case.value).marked(&[
            ('a', machine.adhesive_speed()),
            ('e', window.and_then(|window| window.to)),
            ('x', limits[2]),
            ('c', limits[0]),
            ('L', limits[1]),
        ])
    }

    pub fn ramp(case: &Case) -> KnobRange {
        let opened = &case.opened;
        let value = opened.operation.speed_ramp_rad_s2.abs();
        let turn = opened.operation.speed_rad_s.abs().max(1.0) / opened.solver.end_s;
        let usual = if value > 0.0 { value } else { turn };
        KnobRange::log(usual / AROUND, usual * AROUND).signed(case.value)
    }

    pub fn pulse(case: &Case) -> KnobRange {
        let touch = touching_pulse(case.scene, case.machine);
        let middle = touch.unwrap_or_else(|| case.usual());
        let range = KnobRange::log(middle / 30.0, middle * 3000.0);
        range.signed(case.value).marked(&[('t', touch)])
    }

    pub fn casing_diameters(case: &Case) -> KnobRange {
        KnobRange::linear(1.0, (case.blades() / 2.0).floor().max(2.0))
    }

    pub fn disk_diameters(case: &Case) -> KnobRange {
        let own = Some(case.machine.nodal_diameters).filter(|own| *own > 0.0);
        KnobRange::linear(0.0, (case.blades() / 2.0).floor().max(2.0)).marked(&[('n', own)])
    }

    pub fn order(case: &Case) -> KnobRange {
        KnobRange::linear(1.0, case.blades().max(2.0))
    }

    pub fn blade_length(case: &Case) -> KnobRange {
        let (radius, room) = (case.scene.casing.radius_m, 4.0 * case.clearance());
        let most = if case.has_lining() { radius + room } else { radius };
        KnobRange::linear(radius - room, most)
    }

    pub fn casing_radius(case: &Case) -> KnobRange {
        let (length, room) = (case.scene.bladed_disk.blade_length_m, 4.0 * case.clearance());
        let least = if case.has_lining() { length - room } else { length };
        KnobRange::linear(least, length + room)
    }

    pub fn clearance(case: &Case) -> KnobRange {
        let most = 0.5 * AROUND * case.usual();
        match case.has_lining() {
            true => KnobRange::linear(-most, most).marked(&[('0', Some(0.0))]),
            false => case.around(),
        }
    }

    pub fn position(case: &Case) -> KnobRange {
        KnobRange::linear(-case.clearance(), case.clearance())
    }

    pub fn velocity(case: &Case) -> KnobRange {
        let most = 2.0 * case.clearance() * case.machine.omega_c;
        KnobRange::linear(-most, most)
    }

    pub fn slope(case: &Case) -> KnobRange {
        // Between 0 and -mu the blades dig in.
        let dig = Some(-case.scene.contact.friction).filter(|dig| *dig < 0.0);
        KnobRange::linear(-1.0, 1.0).marked(&[('d', dig), ('0', Some(0.0))])
    }

    pub fn tangential(case: &Case) -> KnobRange {
        // A ring that does not stretch.
        KnobRange::linear(0.0, 1.0).marked(&[('r', Some(1.0 / case.machine.nodal_diameters))])
    }
}

impl Knob {
    /// Returns the usual range of this knob, and the limits on it; none for words. It depends on
    /// the machine and on the scene as it was opened, not on the value: a bar whose scale moves
    /// cannot be read.
    pub fn range(&self, scene: &Scene, opened: &Scene, machine: &Machine) -> Option<KnobRange> {
        let case = Case { knob: self, value: self.number(scene)?, scene, opened, machine };
        let range = match self.bar {
            Bar::Around => case.around(),
            Bar::From(low, high) => KnobRange::linear(low, high),
            Bar::Of(range) => range(&case),
        };
        Some(range).filter(KnobRange::is_sound)
    }

    /// Returns the value as a number; none for words.
    pub fn number(&self, scene: &Scene) -> Option<f64> {
        match self.get(scene) {
            Value::Real(x) => Some(x),
            Value::Whole(n) => Some(n as f64),
            _ => None,
        }
    }

    /// Returns the value that the knob would be turned to next to a number, for a bar that is
    /// dragged.
    pub fn near(&self, x: f64) -> Option<Value> {
        match (self.turn, self.allowed()) {
            (Turn::Linear(fine, _), _) => Some(Value::Real(self.stepped(x, fine, None))),
            (Turn::Decades(_), _) => Some(Value::Real(self.bounded(rounded(x, 2)))),
            (Turn::Whole(..), Allowed::Whole { min, max }) => {
                // A negative or huge number is at a bound.
                Some(Value::Whole((x.round() as u64).clamp(min, max)))
            }
            _ => None,
        }
    }
}

/// Returns the force at which the free casing, at rest before the pulse, reaches the clearance
/// \[N\]. That is the least pulse that can make contact; the blades may need up to `1/cos delta`
/// times as much, until one passes the largest displacement. None where something else moves the
/// casing too, or where it does not swing.
pub fn touching_pulse(scene: &Scene, machine: &Machine) -> Option<f64> {
    let (zeta, omega) = (machine.casing_damping_ratio, machine.omega_c);
    let (length, mass) = (scene.operation.pulse_s, machine.casing_mass);
    let at_rest = scene.initial == Initial::default();
    if !at_rest || !machine.polygon.has_corners() || zeta >= 1.0 || length <= 0.0 {
        return None;
    }
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let decay = zeta * omega;
    // The displacement under a force of 1 N is greatest after half a swing, or
    // where the pulse ends before, in the free swing that follows.
    let still = 1.0 / (mass * omega * omega);
    let most = if damped * length >= std::f64::consts::PI {
        still * (1.0 + (-decay * std::f64::consts::PI / damped).exp())
    } else {
        let (sin, cos) = (damped * length).sin_cos();
        let fade = (-decay * length).exp();
        let place = still * (1.0 - fade * (cos + decay / damped * sin));
        let speed = fade * sin / (mass * damped);
        // Free: u = e^{-decay t} (place cos + b sin), at rest where its rate is 0.
        let b = (speed + decay * place) / damped;
        let angle = (damped * b - decay * place).atan2(damped * place + decay * b);
        (-decay * angle / damped).exp() * (place * angle.cos() + b * angle.sin())
    };
    let force = machine.clearance() / most;
    (force.is_finite() && force > 0.0).then_some(force)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::{KNOBS, knob_of};
    use rubscope_solver::study::margins::grazing_pulse;

    fn range(path: &str, scene: &Scene) -> Option<KnobRange> {
        knob_of(path).unwrap().range(scene, scene, &scene.machine())
    }

    #[test]
    fn every_number_has_a_bar_and_its_place_gives_it_back() {
        for name in ["paper-nd3", "paper-nd4", "run-down", "grazing", "undamped"] {
            let scene = Scene::builtin(name).unwrap();
            for knob in KNOBS {
                let Some(range) = knob.range(&scene, &scene, &scene.machine()) else {
                    assert!(matches!(knob.turn, Turn::Words), "{name} {}", knob.label);
                    continue;
                };
                for part in [0.0, 0.25, 0.5, 1.0] {
                    let there = range.part(range.at(part));
                    assert!((there - part).abs() < 1e-9, "{name} {} {part} {there}", knob.label);
                }
                for (letter, at) in &range.marks {
                    assert!((0.0..=1.0).contains(at) && !meaning(*letter).is_empty(), "{letter}");
                }
            }
        }
    }

    #[test]
    fn the_speed_shows_its_limits_whichever_way_it_turns() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        let forward = range("operation.speed_rad_s", &scene).unwrap();
        let letters: String = forward.marks.iter().map(|(letter, _)| *letter).collect();
        // A later one covers an earlier one.
        assert_eq!(letters, "axcL");
        for (mark, speed) in forward.marks.iter().zip([294.990, 388.311, 292.878, 411.928]) {
            assert!((forward.at(mark.1) - speed).abs() < 1e-2, "{mark:?} {speed}");
        }
        scene.operation.speed_rad_s = -430.0;
        let back = range("operation.speed_rad_s", &scene).unwrap();
        assert_eq!(back.marks, forward.marks);
        assert!((back.at(back.part(-430.0)) + 430.0).abs() < 1e-9);
    }

    #[test]
    fn the_speed_shows_where_a_lock_ends() {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        scene.bladed_disk.radial_coupling = 0.3;
        let bar = range("operation.speed_rad_s", &scene).unwrap();
        let end = bar.marks.iter().find(|(letter, _)| *letter == 'e').unwrap();
        assert!((bar.at(end.1) - 566.259).abs() < 1e-2, "{end:?}");
    }

    #[test]
    fn a_dragged_bar_gives_round_values() {
        let of = |path: &str, x| knob_of(path).unwrap().near(x);
        assert_eq!(of("operation.speed_rad_s", 431.7), Some(Value::Real(430.0)));
        assert_eq!(of("casing.damping_ratio", 0.0512), Some(Value::Real(0.05)));
        assert_eq!(of("operation.pulse_n", 43_423.0), Some(Value::Real(43_000.0)));
        assert_eq!(of("operation.nodal_diameters", 2.6), Some(Value::Whole(3)));
        assert_eq!(of("bladed_disk.blades", -5.0), Some(Value::Whole(1)));
        assert_eq!(of("solver.kind", 0.5), None);
    }

    #[test]
    fn it_is_the_least_pulse_that_makes_contact_but_for_the_angle_between_blades() {
        for (name, pulse_s, zeta) in [
            ("paper-nd3", 50e-6, 0.05),
            ("paper-nd3", 50e-6, 0.0),
            ("paper-nd4", 1e-3, 0.02),
            ("paper-nd3", 4e-3, 0.05),
        ] {
            let mut scene = Scene::builtin(name).unwrap();
            (scene.operation.pulse_s, scene.casing.damping_ratio) = (pulse_s, zeta);
            let machine = scene.machine();
            let closed = touching_pulse(&scene, &machine).unwrap();
            let found = grazing_pulse(&scene, 1e6).unwrap();
            let most = closed / machine.polygon.delta.cos() * (1.0 + 1e-9);
            assert!((closed * (1.0 - 1e-9)..=most).contains(&found), "{closed} {found}");
        }
    }

    #[test]
    fn there_is_none_where_the_casing_moves_already_or_does_not_swing() {
        let scene = Scene::builtin("paper-nd3").unwrap();
        let of = |change: fn(&mut Scene)| {
            let mut scene = scene.clone();
            change(&mut scene);
            touching_pulse(&scene, &scene.machine())
        };
        assert!(of(|_| ()).is_some());
        assert_eq!(of(|scene| scene.operation.pulse_s = 0.0), None);
        assert_eq!(of(|scene| scene.initial.v_c_m_s = 0.1), None);
        assert_eq!(of(|scene| scene.casing.damping_ratio = 1.5), None);
    }
}
