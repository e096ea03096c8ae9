//! The table of knobs, in the order of the panel, group after group.

use super::{CLEARANCE, Group, Knob, Turn};
use Group::{Machine, Operation, Solver, Start};
use Turn::{Decades, Linear, Whole, Words};

const fn knob(
    group: Group,
    label: &'static str,
    path: &'static str,
    turn: Turn,
    does: &'static str,
) -> Knob {
    Knob { group, label, path, turn, does }
}

/// Every knob, in the order of the panel. The first five, which a newcomer turns,
/// come first.
pub const KNOBS: &[Knob] = &[
    knob(
        Operation,
        "speed Ω",
        "operation.speed_rad_s",
        Linear(5.0, 50.0),
        "rotor speed: above Ω_c (c) the wave is pushed onto the blades, above Ω_lock (L) a lock only pushes",
    ),
    knob(
        Operation,
        "pulse F",
        "operation.pulse_n",
        Decades(1.0),
        "force of the push on u_c that starts the motion; from t on a blade touches",
    ),
    knob(
        Operation,
        "diameters n_d",
        "operation.nodal_diameters",
        Whole(1, 4),
        "nodal diameters of the wave in casing and blades",
    ),
    knob(
        Operation,
        "damping ζ_c",
        "casing.damping_ratio",
        Linear(0.005, 0.05),
        "damping ratio of the casing: lets waves die away, and moves Ω_lock up",
    ),
    knob(
        Operation,
        "damping ζ_bd",
        "bladed_disk.damping_ratio",
        Linear(0.005, 0.05),
        "damping ratio of the blades",
    ),
    knob(
        Operation,
        "pulse time t_p",
        "operation.pulse_s",
        Decades(1e-9),
        "how long the pulse pushes",
    ),
    knob(
        Operation,
        "speed ramp",
        "operation.speed_ramp_rad_s2",
        Decades(1.0),
        "how fast the rotor speeds up, or slows down if negative",
    ),
    knob(
        Solver,
        "solver",
        "solver.kind",
        Words,
        "solver: explicit takes time steps; event goes from impact to impact exactly",
    ),
    knob(
        Solver,
        "contact",
        "solver.contact",
        Words,
        "contact law: unilateral only pushes; bilateral, the paper's, may also pull",
    ),
    knob(
        Solver,
        "model",
        "solver.model",
        Words,
        "model size: rigid moves the casing only, modal two blade modes too, full every blade",
    ),
    knob(
        Solver,
        "step h",
        "solver.step_s",
        Decades(1e-12),
        "time step of the explicit solver: shorter is more exact and slower",
    ),
    knob(
        Solver,
        "run end",
        "solver.end_s",
        Decades(1e-9),
        "end of the run that the verdict judges",
    ),
    knob(
        Machine,
        "clearance g0",
        CLEARANCE,
        Decades(1e-9),
        "clearance at rest g0 = R_c - l_b, set by the casing radius",
    ),
    knob(
        Machine,
        "blades N",
        "bladed_disk.blades",
        Whole(1, 10),
        "number of blades; with n_d it gives the sides that can touch",
    ),
    knob(
        Machine,
        "casing k_c",
        "casing.modal_stiffness_n_per_m",
        Decades(1e-6),
        "modal stiffness of the casing; stiffer raises Ω_c",
    ),
    knob(
        Machine,
        "casing m_c",
        "casing.modal_mass_kg",
        Decades(1e-9),
        "modal mass of the casing; heavier lowers Ω_c",
    ),
    knob(
        Machine,
        "blade k_b",
        "bladed_disk.stiffness_nm_per_rad",
        Decades(1e-6),
        "stiffness of a blade on the disk",
    ),
    knob(
        Machine,
        "blade k_bb",
        "bladed_disk.coupling_nm_per_rad",
        Decades(1e-3),
        "stiffness between neighbouring blades",
    ),
    knob(
        Machine,
        "blade m_b",
        "bladed_disk.inertia_kg_m2",
        Decades(1e-9),
        "moment of inertia of a blade about the axis",
    ),
    knob(
        Machine,
        "blade l_b",
        "bladed_disk.blade_length_m",
        Linear(1e-6, 1e-5),
        "blade length from the axis to the tip; longer closes the clearance",
    ),
    knob(
        Machine,
        "casing R_c",
        "casing.radius_m",
        Linear(1e-6, 1e-5),
        "inner radius of the casing; larger opens the clearance",
    ),
    knob(
        Start,
        "start u_c",
        "initial.u_c_m",
        Linear(5e-6, 2e-5),
        "casing position u_c at t = 0; every gap must be open there",
    ),
    knob(
        Start,
        "start u_s",
        "initial.u_s_m",
        Linear(5e-6, 2e-5),
        "casing position u_s at t = 0; every gap must be open there",
    ),
    knob(
        Start,
        "start u_c'",
        "initial.v_c_m_s",
        Linear(5e-3, 5e-2),
        "casing velocity along u_c at t = 0",
    ),
    knob(
        Start,
        "start u_s'",
        "initial.v_s_m_s",
        Linear(5e-3, 5e-2),
        "casing velocity along u_s at t = 0",
    ),
    knob(
        Start,
        "EO torque",
        "excitation.amplitude_nm",
        Decades(1e-3),
        "engine-order torque on each blade, fixed in space; 0 for none",
    ),
    knob(
        Start,
        "EO order",
        "excitation.order",
        Whole(1, 5),
        "engine order: load cycles of that torque per turn",
    ),
];
