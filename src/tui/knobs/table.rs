//! The table of knobs in the order of the panel, group after group: label, key, steps, description,
//! range of the bar, and when the knob has no effect.

use super::inert::{self, Inert};
use super::number::{CLEARANCE, LEAST};
use super::range::{Bar, bars};
use super::{Group, Knob, Turn};
use Bar::{From, Of};
use Group::{Beyond, Machine, Model, Operation, Start, Time, Tips};
use Turn::{Decades, Linear, Whole, Words};
use rubscope_solver::scene::keys;

const fn knob(
    group: Group,
    label: &'static str,
    path: &'static str,
    turn: Turn,
    does: &'static str,
) -> Knob {
    Knob { group, label, path, turn, does, bar: Bar::Around, usual: 1.0, inert: |_| None }
}

impl Knob {
    const fn bar(self, bar: Bar) -> Self {
        Self { bar, ..self }
    }

    const fn usual(self, usual: f64) -> Self {
        Self { usual, ..self }
    }

    const fn unless(self, inert: Inert) -> Self {
        Self { inert, ..self }
    }
}

/// Every knob, in the order of the panel. The five that a new user needs come first.
pub const KNOBS: &[Knob] = &[
    knob(
        Operation,
        "speed Ω",
        keys::SPEED,
        Linear(5.0, 50.0),
        "rotor speed: above Ω_c the wave is pushed onto the blades, above Ω_lock a lock only pushes",
    )
    .bar(Of(bars::speed)),
    knob(
        Operation,
        "pulse F",
        keys::PULSE,
        Decades(1.0),
        "force of the push on u_c that starts the motion",
    )
    .bar(Of(bars::pulse))
    .usual(1e4)
    .unless(inert::without_time),
    knob(
        Operation,
        "diameters n_d",
        keys::DIAMETERS,
        Whole(1, 4),
        "nodal diameters of the wave in casing and blades",
    )
    .bar(Of(bars::casing_diameters)),
    knob(
        Operation,
        "damping ζ_c",
        keys::CASING_DAMPING,
        Linear(0.005, 0.05),
        "damping ratio of the casing: lets waves die away, and moves Ω_lock up",
    )
    .bar(From(0.0, 0.2)),
    knob(
        Operation,
        "damping ζ_bd",
        keys::BLADE_DAMPING,
        Linear(0.005, 0.05),
        "damping ratio of the blades",
    )
    .bar(From(0.0, 0.2))
    .unless(inert::rigid),
    knob(
        Operation,
        "contact",
        keys::LAW,
        Words,
        "contact law: unilateral pushes; bilateral, the paper's, pulls too; smooth is elastic",
    ),
    knob(
        Operation,
        "solver",
        keys::SOLVER,
        Words,
        "solver: explicit takes time steps; event goes from impact to impact exactly",
    ),
    knob(
        Time,
        "pulse time t_p",
        keys::PULSE_TIME,
        Decades(1e-9),
        "how long the pulse pushes",
    )
    .usual(1e-4)
    .unless(inert::without_pulse),
    knob(
        Time,
        "speed ramp",
        keys::SPEED_RAMP,
        Decades(1.0),
        "how fast the rotor speeds up, or slows down if negative",
    )
    .bar(Of(bars::ramp)),
    knob(
        Model,
        "model",
        keys::MODEL,
        Words,
        "model size: rigid moves the casing only, modal two blade modes too, full every blade",
    ),
    knob(
        Model,
        "step h",
        keys::STEP,
        Decades(1e-12),
        "time step of the explicit solver: shorter is more exact and slower",
    )
    .unless(inert::step),
    knob(
        Model,
        "run end",
        keys::END,
        Decades(1e-9),
        "end of the run that the verdict judges",
    ),
    knob(
        Machine,
        "clearance g0",
        CLEARANCE,
        Decades(LEAST),
        "clearance at rest g0 = R_c - l_b; below 0, with the smooth law, all blades rub",
    )
    .bar(Of(bars::clearance)),
    knob(
        Machine,
        "blades N",
        keys::BLADES,
        Whole(1, 10),
        "number of blades; with n_d it gives the sides that can touch",
    ),
    knob(
        Machine,
        "casing k_c",
        keys::CASING_STIFFNESS,
        Decades(1e-6),
        "modal stiffness of the casing; stiffer raises Ω_c",
    ),
    knob(
        Machine,
        "casing m_c",
        keys::CASING_MASS,
        Decades(1e-9),
        "modal mass of the casing; heavier lowers Ω_c",
    ),
    knob(
        Machine,
        "blade k_b",
        keys::BLADE_STIFFNESS,
        Decades(1e-6),
        "stiffness of a blade on the disk",
    )
    .unless(inert::rigid),
    knob(
        Machine,
        "blade k_bb",
        keys::BLADE_COUPLING,
        Decades(1e-3),
        "stiffness between neighbouring blades",
    )
    .unless(inert::coupling),
    knob(
        Machine,
        "blade m_b",
        keys::BLADE_INERTIA,
        Decades(1e-9),
        "moment of inertia of a blade about the axis",
    )
    .unless(inert::rigid),
    knob(
        Machine,
        "blade l_b",
        keys::BLADE_LENGTH,
        Linear(1e-6, 1e-5),
        "blade length from the axis to the tip; longer closes the clearance",
    )
    .bar(Of(bars::blade_length)),
    knob(
        Machine,
        "casing R_c",
        keys::CASING_RADIUS,
        Linear(1e-6, 1e-5),
        "inner radius of the casing; larger opens the clearance",
    )
    .bar(Of(bars::casing_radius)),
    knob(
        Beyond,
        "tip slope κ",
        keys::RADIAL_COUPLING,
        Linear(0.05, 0.1),
        "radial coupling: a blade tip moves outward by κ l_b α; 0 in the paper",
    )
    .bar(From(-1.0, 1.0))
    .unless(inert::rigid),
    knob(
        Beyond,
        "friction μ",
        keys::FRICTION,
        Linear(0.05, 0.1),
        "Coulomb friction of the blades, which slide forward; 0 in the paper",
    )
    .bar(From(0.0, 0.5))
    .unless(inert::friction),
    knob(
        Beyond,
        "tangential τ",
        keys::TANGENTIAL_RATIO,
        Linear(0.05, 0.1),
        "tangential over radial motion of the casing: 1/n_d for a ring",
    )
    .bar(From(0.0, 1.0))
    .unless(inert::tangential),
    knob(
        Beyond,
        "lining k_p",
        keys::LINING_STIFFNESS,
        Decades(1e-3),
        "stiffness of the lining under one blade, for the smooth law",
    )
    .unless(inert::lining),
    knob(
        Beyond,
        "lining eps",
        keys::LINING_SMOOTHING,
        Decades(1e-9),
        "depth over which the stiffness of the lining sets in, for the smooth law",
    )
    .usual(1e-6)
    .unless(inert::lining),
    knob(
        Beyond,
        "restitution e",
        keys::RESTITUTION,
        Linear(0.05, 0.1),
        "part of the speed that an impact gives back; 0 in the paper",
    )
    .bar(From(0.0, 0.95))
    .unless(inert::restitution),
    knob(
        Beyond,
        "diameters n_b",
        keys::DISK_DIAMETERS,
        Whole(1, 4),
        "nodal diameters of the disk; 0 for those of the casing",
    )
    .bar(Of(bars::disk_diameters))
    .unless(inert::not_modal),
    knob(
        Beyond,
        "mistuning",
        keys::MISTUNING,
        Linear(0.005, 0.01),
        "standard deviation of the stiffness of single blades, in the full model",
    )
    .bar(From(0.0, 0.05))
    .unless(inert::not_full),
    knob(
        Beyond,
        "draw",
        keys::MISTUNING_SEED,
        Whole(1, 10),
        "number of the draw of the single stiffnesses",
    )
    .bar(From(0.0, 20.0))
    .unless(inert::draw),
    knob(
        Beyond,
        "stiffening B",
        keys::STIFFENING,
        Linear(0.1, 0.5),
        "centrifugal stiffening: ω_bd² grows by B Ω²; 0 in the paper",
    )
    .bar(From(0.0, 3.0))
    .unless(inert::rigid),
    knob(
        Beyond,
        "growth c",
        keys::CLEARANCE_LOSS,
        Decades(1e-14),
        "clearance lost as blades grow with the speed, c Ω²; 0 in the paper",
    )
    .bar(Of(bars::growth)),
    knob(Tips, "longest tip", keys::LONGEST_TIP, Linear(1e-6, 1e-5), "how much longer blade 1 is than the others; beyond the clearance it drags the wave").bar(From(-2e-4, 2e-4)),
    knob(Tips, "tip scatter", keys::TIP_SCATTER, Decades(1e-9), "standard deviation of the lengths of single blades; 0 for equal tips").usual(1e-6),
    knob(Tips, "tip seed", keys::TIP_SEED, Whole(1, 10), "number of the draw of those lengths").unless(inert::equal_tips),
    knob(Tips, "orbit r", keys::ORBIT, Decades(1e-9), "how far the rotor is off its centre").usual(1e-5),
    knob(Tips, "orbit χ", keys::ORBIT_ANGLE, Linear(0.1, 1.0), "direction of that in the frame of the rotor").bar(From(-3.2, 3.2)).unless(inert::centred),
    knob(Tips, "lobes", keys::LOBES, Whole(1, 5), "lobes of a casing that is out of round; 0 for none").unless(inert::round),
    knob(Tips, "out of round", keys::OUT_OF_ROUND, Decades(1e-9), "height of those lobes; 0 for a round casing").usual(1e-6).unless(inert::without_lobes),
    knob(Tips, "shape ψ", keys::OUT_OF_ROUND_ANGLE, Linear(0.1, 1.0), "phase of those lobes").bar(From(-3.2, 3.2)).unless(inert::round),
    knob(
        Start,
        "start u_c",
        keys::INITIAL_U_C,
        Linear(5e-6, 2e-5),
        "casing position u_c at t = 0; every gap must be open there",
    )
    .bar(Of(bars::position)),
    knob(
        Start,
        "start u_s",
        keys::INITIAL_U_S,
        Linear(5e-6, 2e-5),
        "casing position u_s at t = 0; every gap must be open there",
    )
    .bar(Of(bars::position)),
    knob(
        Start,
        "start u_c'",
        keys::INITIAL_V_C,
        Linear(5e-3, 5e-2),
        "casing velocity along u_c at t = 0",
    )
    .bar(Of(bars::velocity)),
    knob(
        Start,
        "start u_s'",
        keys::INITIAL_V_S,
        Linear(5e-3, 5e-2),
        "casing velocity along u_s at t = 0",
    )
    .bar(Of(bars::velocity)),
    knob(
        Start,
        "EO torque",
        keys::EXCITATION,
        Decades(1e-3),
        "engine-order torque on each blade, fixed in space; 0 for none",
    )
    .unless(inert::torque),
    knob(
        Start,
        "EO order",
        keys::ENGINE_ORDER,
        Whole(1, 5),
        "engine order: load cycles of that torque per turn",
    )
    .bar(Of(bars::order))
    .unless(inert::order),
];
