//! Reports of the frequency domain: JSON (`rubscope.hbm/1`), tables and a
//! heading in sentences.

use std::io::{Result, Write};

use serde::Serialize;

use super::number::{count, short};
use super::table::Table;
use crate::harmonic::{Form, LockedPoint, Sweep};
use crate::model::{Machine, Rim};

/// The whole answer of `rubscope hbm --json`.
#[derive(Clone, Debug, Serialize)]
pub struct HbmReport {
    schema: &'static str,
    form: Form,
    damped: bool,
    /// Critical rotor speed `Omega_c = omega_c/n_d`, Eq. (17).
    omega_c_rad_s: Option<f64>,
    /// Speed above which both multipliers of the damped lock push.
    omega_lock_rad_s: Option<f64>,
    /// Speed above which the equality law holds a lock, one multiplier tensile.
    omega_adhesive_rad_s: Option<f64>,
    /// The dangerous coincidence, Eq. (31).
    coincidence_rad_s: Option<f64>,
    /// Frequency of the casing `omega_c`.
    casing_frequency_rad_s: f64,
    /// Frequency of the bladed disk `omega_bd`.
    blade_frequency_rad_s: f64,
    clearance_m: f64,
    locked_amplitude_m: Option<f64>,
    /// Speeds asked for at which there is no locked motion.
    missing_rad_s: Vec<f64>,
    points: Vec<Point>,
}

#[derive(Clone, Debug, Serialize)]
struct Point {
    speed_rad_s: f64,
    groups: [Group; 2],
    u_cc_m: f64,
    u_cs_m: f64,
    u_sc_m: f64,
    u_ss_m: f64,
    amplitude_m: f64,
    smallest_gap_m: f64,
    torque_nm: f64,
    power_w: f64,
    admissible: bool,
    stable: bool,
    residual: f64,
}

#[derive(Clone, Debug, Serialize)]
struct Group {
    blades: Vec<u32>,
    multiplier_n: f64,
    alpha_rad: f64,
}

impl HbmReport {
    /// The report of one machine, so far without any point.
    #[must_use]
    pub fn new(machine: &Machine, form: Form, damped: bool) -> Self {
        Self {
            schema: "rubscope.hbm/1",
            form,
            damped,
            omega_c_rad_s: machine.critical_speed(),
            omega_lock_rad_s: machine.lock_speed(),
            omega_adhesive_rad_s: machine.adhesive_speed(),
            coincidence_rad_s: machine.dangerous_speed(),
            casing_frequency_rad_s: machine.omega_c,
            blade_frequency_rad_s: machine.omega_bd,
            clearance_m: machine.clearance(),
            locked_amplitude_m: machine.locked_amplitude(),
            missing_rad_s: Vec::new(),
            points: Vec::new(),
        }
    }

    /// Adds the locked motion over speed.
    #[must_use]
    pub fn with_sweep(mut self, rim: &Rim, sweep: &Sweep) -> Self {
        let blades = sweep.corner.sides().map(|side| rim.blades_of_side(side));
        self.points = sweep.points.iter().map(|point| Point::of(point, &blades)).collect();
        self.missing_rad_s.clone_from(&sweep.missing);
        self
    }
}

impl Point {
    fn of(point: &LockedPoint, blades: &[Vec<u32>; 2]) -> Self {
        let [a, b] = blades;
        let [lambda_a, lambda_b] = point.multipliers;
        let [alpha_a, alpha_b] = point.alpha;
        let group = |blades: &Vec<u32>, multiplier_n, alpha_rad| Group {
            blades: blades.clone(),
            multiplier_n,
            alpha_rad,
        };
        Self {
            speed_rad_s: point.speed,
            groups: [group(a, lambda_a, alpha_a), group(b, lambda_b, alpha_b)],
            u_cc_m: point.u_cc,
            u_cs_m: point.u_cs,
            u_sc_m: point.u_sc,
            u_ss_m: point.u_ss,
            amplitude_m: point.amplitude(),
            smallest_gap_m: point.smallest_gap,
            torque_nm: point.torque,
            power_w: point.power,
            admissible: point.admissible,
            stable: point.stable,
            residual: point.residual,
        }
    }
}

/// One word for a point: locked, pulls, penetrates or unstable.
fn state(point: &LockedPoint) -> &'static str {
    if point.stable && point.admissible {
        "locked"
    } else if point.multipliers.iter().any(|&multiplier| multiplier > 0.0) {
        "pulls"
    } else if !point.admissible {
        "penetrates"
    } else {
        "unstable"
    }
}

/// The locked motion as a short table for people.
#[must_use]
pub fn summary_table(sweep: &Sweep) -> Table {
    let mut table = Table::new(&[
        "speed [rad/s]",
        "multiplier a [N]",
        "multiplier b [N]",
        "alpha a [rad]",
        "amplitude [m]",
        "power [W]",
        "state",
    ]);
    for point in &sweep.points {
        let [lambda_a, lambda_b] = point.multipliers;
        table.push(vec![
            point.speed.into(),
            lambda_a.into(),
            lambda_b.into(),
            point.alpha[0].into(),
            point.amplitude().into(),
            point.power.into(),
            state(point).into(),
        ]);
    }
    table
}

/// The locked motion with every figure, for files.
#[must_use]
pub fn locked_table(sweep: &Sweep) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "multiplier_a_n",
        "multiplier_b_n",
        "alpha_a_rad",
        "alpha_b_rad",
        "u_cc_m",
        "u_cs_m",
        "u_sc_m",
        "u_ss_m",
        "amplitude_m",
        "smallest_gap_m",
        "torque_nm",
        "power_w",
        "admissible",
        "stable",
        "residual",
    ]);
    for point in &sweep.points {
        let [lambda_a, lambda_b] = point.multipliers;
        let [alpha_a, alpha_b] = point.alpha;
        table.push(vec![
            point.speed.into(),
            lambda_a.into(),
            lambda_b.into(),
            alpha_a.into(),
            alpha_b.into(),
            point.u_cc.into(),
            point.u_cs.into(),
            point.u_sc.into(),
            point.u_ss.into(),
            point.amplitude().into(),
            point.smallest_gap.into(),
            point.torque.into(),
            point.power.into(),
            point.admissible.into(),
            point.stable.into(),
            point.residual.into(),
        ]);
    }
    table
}

/// What machine this is and who holds the wave, a fact a line.
///
/// # Errors
/// What the writer refuses.
pub fn write_heading(
    machine: &Machine,
    title: &str,
    sweep: Option<&Sweep>,
    out: &mut dyn Write,
) -> Result<()> {
    if !title.is_empty() {
        writeln!(out, "{title}")?;
    }
    let rim = &machine.rim;
    writeln!(
        out,
        "{} blades, {}: {} phase groups of {}, clearance {} m.",
        rim.blades,
        count(u64::from(rim.nodal_diameters), "nodal diameter"),
        rim.sides,
        count(u64::from(rim.blades_per_side), "blade"),
        short(machine.clearance())
    )?;
    if let Some(critical) = machine.critical_speed() {
        write!(out, "Critical speed {} rad/s", short(critical))?;
        if let Some(lock) = machine.lock_speed() {
            let zeta = machine.casing_damping_ratio;
            write!(out, ", lock-in from {} rad/s (zeta_c = {})", short(lock), short(zeta))?;
        }
        if let Some(dangerous) = machine.dangerous_speed() {
            write!(out, ", dangerous coincidence {} rad/s", short(dangerous))?;
        }
        writeln!(out, ".")?;
    }
    if let Some(sweep) = sweep {
        let name = |side| {
            let list: Vec<String> =
                rim.blades_of_side(side).iter().map(|blade| format!("#{blade}")).collect();
            list.join(" ")
        };
        let damping = if sweep.damped { "damped" } else { "undamped" };
        writeln!(
            out,
            "Locked motion held between a: {} and b: {}; form {}, {damping}. Negative pushes; a positive multiplier is a pull, which no contact can give.",
            name(sweep.corner.a),
            name(sweep.corner.b),
            sweep.form,
        )?;
    }
    Ok(())
}
