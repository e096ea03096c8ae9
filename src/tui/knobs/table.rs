//! The table of knobs in the order of the panel, group after group: key, range of the bar, and when
//! the knob has no effect. Label, steps and sentence are those of the key.

use super::bars;
use super::inert::{self, Inert};
use super::knob::{Group, Knob};
use super::range::Bar;
use Bar::{From, Of};
use Group::{Beyond, Machine, Model, Operation, Start, Time, Tips};
use rubscope_solver::scene::keys::{self, CLEARANCE_KEY, Handle, Turn, find_varied};
use std::sync::LazyLock;

/// Creates the knob of a key.
fn knob(group: Group, path: &'static str) -> Knob {
    let key = find_varied(path).unwrap_or(&CLEARANCE_KEY);
    let handle = key.handle.unwrap_or(Handle { label: path, turn: Turn::Words, does: key.what });
    let Handle { label, turn, does } = handle;
    Knob { group, label, path, key, turn, does, bar: Bar::Around, usual: 1.0, inert: |_| None }
}

impl Knob {
    fn bar(self, bar: Bar) -> Self {
        Self { bar, ..self }
    }

    fn usual(self, usual: f64) -> Self {
        Self { usual, ..self }
    }

    fn unless(self, inert: Inert) -> Self {
        Self { inert, ..self }
    }
}

/// Every knob, in the order of the panel. The five that a new user needs come first. A key with
/// steps that is not listed goes beyond the paper.
pub static KNOBS: LazyLock<Vec<Knob>> = LazyLock::new(|| {
    let mut knobs = vec![
        knob(Operation, keys::SPEED).bar(Of(bars::speed)),
        knob(Operation, keys::PULSE).bar(Of(bars::pulse)).usual(1e4).unless(inert::without_time),
        knob(Operation, keys::DIAMETERS).bar(Of(|case| bars::diameters(1.0, case))),
        knob(Operation, keys::CASING_DAMPING).bar(From(0.0, 0.2)),
        knob(Operation, keys::BLADE_DAMPING).bar(From(0.0, 0.2)).unless(inert::rigid),
        knob(Operation, keys::LAW),
        knob(Operation, keys::SOLVER),
        knob(Time, keys::PULSE_TIME).usual(1e-4).unless(inert::without_pulse),
        knob(Time, keys::SPEED_RAMP).bar(Of(bars::ramp)),
        knob(Model, keys::MODEL),
        knob(Model, keys::STEP).unless(inert::step),
        knob(Model, keys::END),
        knob(Machine, keys::CLEARANCE).bar(Of(bars::clearance)),
        knob(Machine, keys::BLADES),
        knob(Machine, keys::CASING_STIFFNESS),
        knob(Machine, keys::CASING_MASS),
        knob(Machine, keys::BLADE_STIFFNESS).unless(inert::rigid),
        knob(Machine, keys::BLADE_COUPLING).unless(inert::coupling),
        knob(Machine, keys::BLADE_INERTIA).unless(inert::rigid),
        knob(Machine, keys::BLADE_LENGTH).bar(Of(bars::blade_length)),
        knob(Machine, keys::CASING_RADIUS).bar(Of(bars::casing_radius)),
        knob(Beyond, keys::RADIAL_COUPLING).bar(From(-1.0, 1.0)).unless(inert::rigid),
        knob(Beyond, keys::FRICTION).bar(From(0.0, 0.5)).unless(inert::friction),
        knob(Beyond, keys::TANGENTIAL_RATIO).bar(From(0.0, 1.0)).unless(inert::tangential),
        knob(Beyond, keys::LINING_STIFFNESS).unless(inert::lining),
        knob(Beyond, keys::LINING_SMOOTHING).usual(1e-6).unless(inert::lining),
        knob(Beyond, keys::RESTITUTION).bar(From(0.0, 0.95)).unless(inert::restitution),
        knob(Beyond, keys::DISK_DIAMETERS)
            .bar(Of(|case| bars::diameters(0.0, case)))
            .unless(inert::not_modal),
        knob(Beyond, keys::MISTUNING).bar(From(0.0, 0.05)).unless(inert::not_full),
        knob(Beyond, keys::MISTUNING_SEED).bar(From(0.0, 20.0)).unless(inert::draw),
        knob(Beyond, keys::STIFFENING).bar(From(0.0, 3.0)).unless(inert::rigid),
        knob(Beyond, keys::CLEARANCE_LOSS).bar(Of(bars::growth)),
        knob(Tips, keys::LONGEST_TIP).bar(From(-2e-4, 2e-4)),
        knob(Tips, keys::TIP_SCATTER).usual(1e-6),
        knob(Tips, keys::TIP_SEED).unless(inert::equal_tips),
        knob(Tips, keys::ORBIT).usual(1e-5),
        knob(Tips, keys::ORBIT_ANGLE).bar(From(-3.2, 3.2)).unless(inert::centred),
        knob(Tips, keys::LOBES).bar(Of(bars::lobes)).unless(inert::round),
        knob(Tips, keys::OUT_OF_ROUND).usual(1e-6).unless(inert::without_lobes),
        knob(Tips, keys::OUT_OF_ROUND_ANGLE).bar(From(-3.2, 3.2)).unless(inert::round),
        knob(Start, keys::INITIAL_U_C).bar(Of(bars::position)),
        knob(Start, keys::INITIAL_U_S).bar(Of(bars::position)),
        knob(Start, keys::INITIAL_V_C).bar(Of(bars::velocity)),
        knob(Start, keys::INITIAL_V_S).bar(Of(bars::velocity)),
        knob(Start, keys::EXCITATION).unless(inert::rigid),
        knob(Start, keys::ENGINE_ORDER).bar(Of(bars::order)).unless(inert::order),
    ];
    for key in keys::KEYS.iter().filter(|key| key.handle.is_some()) {
        if !knobs.iter().any(|knob| knob.path == key.path) {
            knobs.push(knob(Beyond, key.path));
        }
    }
    knobs.sort_by_key(|knob| knob.group as usize);
    knobs
});

impl Group {
    /// Iterates over the group's knobs, each with its index in [`KNOBS`].
    pub fn knobs(self) -> impl Iterator<Item = (usize, &'static Knob)> {
        KNOBS.iter().enumerate().filter(move |(_, knob)| knob.group == self)
    }
}

/// Returns the index in [`KNOBS`] of the knob that sets a key.
pub fn place_of(path: &str) -> Option<usize> {
    KNOBS.iter().position(|knob| knob.path == path)
}

/// Returns the knob that sets a key.
pub fn knob_of(path: &str) -> Option<&'static Knob> {
    KNOBS.get(place_of(path)?)
}
