//! Reports of the frequency domain: JSON (`rubscope.hbm/1`), tables and a
//! heading in sentences.

use std::io::Write;

use serde::Serialize;

mod branches;
mod campbell;
mod excitation;
mod locked;
mod slip;

pub use branches::{BranchReport, FoldReport, branch_table, corner_table, threshold_table};
pub use campbell::{CampbellReport, campbell_table, coincidence_table};
pub use excitation::{ExcitationReport, excitation_table};
pub use locked::{locked_table, summary_table};
pub use slip::{
    HarmonicsReport, Region, RegionReport, SlipReport, region_table, slip_table, term_table,
    truncation_table,
};

use crate::harmonic::{
    Branches, Campbell, CornerBranch, Form, NoSlip, SlipPoint, SlipSpectrum, Sweep,
};
use crate::model::{Machine, Rim};
use crate::report::number::{count, short};

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
    points: Vec<locked::Point>,
    #[serde(skip_serializing_if = "Option::is_none")]
    branches: Option<BranchReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    fold: Option<FoldReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slip: Option<Vec<SlipReport>>,
    /// Speeds where slip appears or vanishes.
    #[serde(skip_serializing_if = "Option::is_none")]
    slip_limits_rad_s: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    slip_region: Option<Vec<RegionReport>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    harmonics: Option<Vec<HarmonicsReport>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    campbell: Option<CampbellReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    excitation: Option<ExcitationReport>,
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
            branches: None,
            fold: None,
            slip: None,
            slip_limits_rad_s: None,
            slip_region: None,
            harmonics: None,
            campbell: None,
            excitation: None,
        }
    }

    /// Adds the locked motion over speed.
    #[must_use]
    pub fn with_sweep(mut self, rim: &Rim, sweep: &Sweep) -> Self {
        self.points = locked::points(rim, sweep);
        self.missing_rad_s.clone_from(&sweep.missing);
        self
    }

    /// Adds every equilibrium and the thresholds of the branches.
    #[must_use]
    pub fn with_branches(mut self, machine: &Machine, branches: &Branches) -> Self {
        self.branches = Some(BranchReport::of(machine, branches));
        self
    }

    /// Adds the corner branch followed through its fold.
    #[must_use]
    pub fn with_fold(mut self, branch: &CornerBranch) -> Self {
        self.fold = Some(FoldReport::of(branch));
        self
    }

    /// Adds slip over speed and the speeds where it appears or vanishes.
    #[must_use]
    pub fn with_slip(mut self, points: &[SlipPoint], limits: &[(f64, bool)]) -> Self {
        self.slip = Some(points.iter().map(SlipReport::of).collect());
        self.slip_limits_rad_s = Some(limits.iter().map(|limit| limit.0).collect());
        self
    }

    /// Adds where slip lives over damping ratios of the casing.
    #[must_use]
    pub fn with_slip_region(mut self, region: &[Region]) -> Self {
        self.slip_region = Some(region.iter().map(RegionReport::of).collect());
        self
    }

    /// Adds the Fourier series of slip at each speed.
    #[must_use]
    pub fn with_harmonics(mut self, series: &[(f64, Result<SlipSpectrum, NoSlip>)]) -> Self {
        self.harmonics = Some(series.iter().map(HarmonicsReport::of).collect());
        self
    }

    /// Adds Campbell data at these speeds.
    #[must_use]
    pub fn with_campbell(mut self, campbell: &Campbell, speeds: &[f64]) -> Self {
        self.campbell = Some(CampbellReport::of(campbell, speeds));
        self
    }

    /// Adds the response to an engine order.
    #[must_use]
    pub fn with_excitation(mut self, report: ExcitationReport) -> Self {
        self.excitation = Some(report);
        self
    }
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
) -> std::io::Result<()> {
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
