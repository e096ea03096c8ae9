//! The terms of the glossary.

use super::App;
use super::Here::{self, Knob, Nothing, Of};
use super::Term;
use super::beyond::BEYOND;
use crate::scene::keys::PULSE;

pub(super) const fn term(
    symbol: &'static str,
    name: &'static str,
    meaning: &'static str,
    equation: &'static str,
    here: Here,
) -> Term {
    Term { symbol, name, meaning, equation, here }
}

/// The sections of the glossary and their terms.
pub const SECTIONS: &[(&str, &[Term])] = &[
    ("Speeds", SPEEDS),
    ("Symbols", SYMBOLS),
    ("Beyond the paper", BEYOND),
    ("Words", WORDS),
    ("Verdicts", VERDICTS),
];

const SPEEDS: &[Term] = &[
    term("Ω", "Omega", "rotor speed", "", Of(|app| Some(app.speed()), "rad/s")),
    term(
        "Ω_c",
        "Omega_c",
        "critical speed (c on the bar of the speed); above it the turning blades push the casing wave outward",
        "Ω_c = ω_c/n_d",
        Of(|app| app.machine.critical_speed(), "rad/s"),
    ),
    term(
        "Ω_lock",
        "Omega_lock",
        "from it on both blade groups of a lock push (L on the bar of the speed)",
        "Ω_lock = Ω_c [ζ_c cot δ + sqrt(1 + ζ_c² cot² δ)]",
        Of(App::lock_speed, "rad/s"),
    ),
    term(
        "lock ends",
        "lock_ends",
        "up to it both groups of a lock push, where tips move outward or a lining gives (e on the bar of the speed)",
        "section 10",
        Of(|app| app.lock_window()?.to, "rad/s"),
    ),
    term(
        "adhesive limit",
        "Omega_adhesive",
        "down to it the bilateral law holds a lock by a pull (a on the bar of the speed)",
        "Ω_c [ζ_c tan δ + sqrt(1 + ζ_c² tan² δ)]",
        Of(|app| app.machine.adhesive_speed(), "rad/s"),
    ),
    term(
        "coincidence",
        "coincidence",
        "the casing wave and the blade wave turn alike; the dangerous one of two (x on the bar of the speed)",
        "n_d |Ω| = ω_c + ω_bd, Eq. (31)",
        Of(|app| app.machine.dangerous_speed_toward(app.speed()), "rad/s"),
    ),
    term(
        "coincidence (30)",
        "coincidence (30)",
        "the other coincidence, of the difference of the frequencies",
        "n_d |Ω| = |ω_c - ω_bd|, Eq. (30)",
        Of(|app| app.machine.coincidence_speeds().first().copied(), "rad/s"),
    ),
    term(
        "ω_c",
        "omega_c",
        "angular frequency of the casing",
        "ω_c = sqrt(k_c/m_c)",
        Of(|app| Some(app.machine.omega_c), "rad/s"),
    ),
    term(
        "ω_bd",
        "omega_bd",
        "angular frequency of the bladed disk at n_d diameters",
        "ω_bd² = (k_b + 2 k_bb (1 - cos(2 pi n_d/N)))/m_b",
        Of(|app| Some(app.machine.omega_bd), "rad/s"),
    ),
    term(
        "ν",
        "nu",
        "angular frequency at which the blades pass the lobes of the casing",
        "ν = n_d Ω",
        Of(|app| Some(app.machine.nu(app.speed())), "rad/s"),
    ),
];

const SYMBOLS: &[Term] = &[
    term("N", "N", "number of blades", "", Knob("bladed_disk.blades")),
    term(
        "n_d",
        "n_d",
        "nodal diameters: the waves have n_d lobes around the circumference",
        "",
        Knob("operation.nodal_diameters"),
    ),
    term(
        "N'",
        "N'",
        "sides of the polygon in which the wave moves, seen from the blades",
        "N' = N/gcd(N, n_d)",
        Of(|app| Some(f64::from(app.machine.polygon.sides)), ""),
    ),
    term(
        "δ",
        "delta",
        "half the angle at a corner of that polygon",
        "δ = pi/N'",
        Of(|app| Some(app.machine.polygon.delta), "rad"),
    ),
    term("g0", "g0", "clearance of a blade tip at rest", "g0 = R_c - l_b", Knob("clearance")),
    term(
        "g_i",
        "g_i",
        "gap of blade i; zero is contact",
        "g_i = g0 + u_c cos β_i + u_s sin β_i, β_i = n_d (θ + Φ_i + α_i)",
        Nothing,
    ),
    term("θ", "theta", "angle of the rotor", "θ' = Ω", Nothing),
    term("Φ_i", "Phi_i", "place of blade i on the disk", "Φ_i = 2 pi (i-1)/N", Nothing),
    term(
        "ψ_i",
        "psi_i",
        "phase of blade i; blades of one phase touch together, as a group",
        "ψ_i = n_d Φ_i",
        Nothing,
    ),
    term(
        "u_c, u_s",
        "u_c, u_s",
        "cosine and sine part of the casing wave",
        "m_c u'' + d_c u' + k_c u = contact + pulse, d_c = 2 m_c ω_c ζ_c",
        Nothing,
    ),
    term(
        "α_c, α_s",
        "alpha_c, alpha_s",
        "cosine and sine part of the blade angles",
        "α_i = α_c cos ψ_i + α_s sin ψ_i",
        Nothing,
    ),
    term(
        "z",
        "z",
        "the casing wave seen from the blades: a point inside the polygon",
        "z = (u_c + i u_s) exp(-i n_d θ)",
        Nothing,
    ),
    term(
        "|z| locked",
        "|z| locked",
        "amplitude of the casing wave in a lock: a corner of the polygon",
        "g0/cos δ",
        Of(|app| app.machine.locked_amplitude(), "m"),
    ),
    term(
        "λ",
        "lambda",
        "contact multiplier (force) of a blade group; negative pushes, positive pulls, which a real contact cannot do",
        "g >= 0, λ <= 0, g λ = 0",
        Nothing,
    ),
    term(
        "λ_a",
        "lambda_a",
        "multiplier of the first group of a lock",
        "λ_a = (g0/2 cos δ) (K/cos δ - D/sin δ), K = k_c - ν² m_c, D = d_c ν",
        Of(|app| app.machine.locked_multipliers(app.speed()).map(|[a, _]| a), "N"),
    ),
    term(
        "λ_b",
        "lambda_b",
        "multiplier of the second group of a lock, the one that pulls first",
        "λ_b = (g0/2 cos δ) (K/cos δ + D/sin δ)",
        Of(|app| app.machine.locked_multipliers(app.speed()).map(|[_, b]| b), "N"),
    ),
    term("ζ_c", "zeta_c", "damping ratio of the casing", "", Knob("casing.damping_ratio")),
    term(
        "ζ_bd",
        "zeta_bd",
        "damping ratio of the bladed disk",
        "",
        Knob("bladed_disk.damping_ratio"),
    ),
    term("m_c", "m_c", "modal mass of the casing", "", Knob("casing.modal_mass_kg")),
    term("k_c", "k_c", "modal stiffness of the casing", "", Knob("casing.modal_stiffness_n_per_m")),
    term("m_b", "m_b", "moment of inertia of a blade", "", Knob("bladed_disk.inertia_kg_m2")),
    term(
        "k_b",
        "k_b",
        "stiffness from blade to disk",
        "",
        Knob("bladed_disk.stiffness_nm_per_rad"),
    ),
    term(
        "k_bb",
        "k_bb",
        "stiffness from blade to blade",
        "",
        Knob("bladed_disk.coupling_nm_per_rad"),
    ),
    term("l_b", "l_b", "length of a blade", "", Knob("bladed_disk.blade_length_m")),
    term("R_c", "R_c", "radius of the casing", "", Knob("casing.radius_m")),
    term("F", "F", "force of the pulse that starts the motion", "", Knob(PULSE)),
    term("t_p", "t_p", "length of that pulse", "", Knob("operation.pulse_s")),
    term("h", "h", "time step of the explicit solver", "", Knob("solver.step_s")),
    term(
        "EO",
        "EO",
        "engine order: a torque on the blades that turns r times around the circumference",
        "",
        Knob("excitation.order"),
    ),
];

const WORDS: &[Term] = &[
    term(
        "the machine",
        "the machine",
        "a rotor of N flexible blades turns inside a flexible casing; both vibrate in one pattern of n_d nodal diameters",
        "",
        Nothing,
    ),
    term(
        "unilateral",
        "unilateral",
        "contact law: contact only pushes",
        "g >= 0, λ <= 0, g λ = 0",
        Nothing,
    ),
    term(
        "bilateral",
        "bilateral",
        "contact law of the paper: a predicted penetration is closed exactly, by a pull too",
        "g = 0 wherever g < 0 is predicted",
        Nothing,
    ),
    term("explicit", "explicit", "solver: the paper's time steps of length h", "", Nothing),
    term(
        "event",
        "event",
        "solver: closed forms from contact to contact, without time steps",
        "",
        Nothing,
    ),
    term("rigid", "rigid", "model: the blades are rigid, the casing moves (u_c, u_s)", "", Nothing),
    term("modal", "modal", "model: the paper's four coordinates u_c, u_s, α_c, α_s", "", Nothing),
    term("full", "full", "model: every blade has a coordinate of its own", "", Nothing),
    term(
        "margin",
        "margin",
        "how far beyond a limit the present value is; below zero it is not there yet",
        "now/limit - 1",
        Nothing,
    ),
    term("F touches", "F touches", "smallest pulse that makes a blade touch", "", Nothing),
    term(
        "F lasts",
        "F lasts",
        "smallest pulse after which contact lasts, under one law; islands are bands of such pulses below others that do not last",
        "",
        Nothing,
    ),
    term(
        "corner",
        "corner",
        "place of the wave where two neighbouring blade groups touch: there it can lock",
        "|y| = g0 tan δ along a side",
        Nothing,
    ),
    term("tensile step", "tensile step", "a time step in which contact pulled", "λ > 0", Nothing),
    term(
        "sensitive",
        "sensitive",
        "a tiny change of the data changes the result: compare verdicts, not end states",
        "",
        Nothing,
    ),
];

/// The verdicts, judged over the last part of a run.
const VERDICTS: &[Term] = &[
    term(
        "locked",
        "locked",
        "the same blade groups stay in contact and all push; the casing wave turns with the rotor",
        "g = 0 and λ <= 0 for both groups, Ω > Ω_lock",
        Nothing,
    ),
    term(
        "adhesive",
        "adhesive",
        "as locked, but a group pulls: only the bilateral law allows it",
        "g = 0 for both groups, some λ > 0",
        Nothing,
    ),
    term(
        "slip",
        "slip",
        "contact without a break that no corner holds: the groups change, and the wave turns slower or faster than the rotor",
        "some g = 0 at every instant",
        Nothing,
    ),
    term("bounce", "bounce", "contacts come and go", "", Nothing),
    term(
        "whirl",
        "whirl",
        "as slip, but the blades swing with it: the wave lasts because tips that move outward as they bend feed it",
        "|κ| l_b |a| > |g0|/4",
        Nothing,
    ),
    term(
        "divergent",
        "divergent",
        "nothing bounds the growth of the motion, which left the range of the model",
        "|α_i| > 0.1 rad, or the casing as fast as the tips",
        Nothing,
    ),
    term(
        "decay",
        "decay",
        "the motion dies away without further contact",
        "never again if |u'|² + ω_c² |u|² < (ω_c g0)²",
        Nothing,
    ),
    term(
        "failed",
        "failed",
        "the run stopped early, with a reason: it broke down, or a predicted penetration or a blade angle was too large",
        "predicted penetration > g0, or |α_i| > 0.1 rad",
        Nothing,
    ),
];
