//! Slip over speed, and the Fourier series of its orbits.

use serde::Serialize;

use crate::harmonic::{NoSlip, SlipPoint, SlipSpectrum};
use crate::report::table::{Cell, Table};

/// Slip at one speed in JSON; `null` where there is no slip.
#[derive(Clone, Debug, Serialize)]
pub struct SlipReport {
    speed_rad_s: f64,
    exists: bool,
    stable: bool,
    /// Why there is none.
    reason: Option<NoSlip>,
    wave_speed_rad_s: Option<f64>,
    period_s: Option<f64>,
    speed_after_corner_m_s: Option<f64>,
    speed_before_corner_m_s: Option<f64>,
    /// Slope of the map at its fixed point.
    slope: Option<f64>,
    least_push_n: Option<f64>,
    corner_impulse_ns: Option<f64>,
    torque_nm: Option<f64>,
    power_w: Option<f64>,
    damper_power_w: Option<f64>,
    corner_power_w: Option<f64>,
}

impl SlipReport {
    /// Of this speed.
    #[must_use]
    pub fn of(point: &SlipPoint) -> Self {
        let orbit = point.outcome.ok();
        Self {
            speed_rad_s: point.speed,
            exists: point.exists(),
            stable: point.stable(),
            reason: point.outcome.err(),
            wave_speed_rad_s: orbit.map(|orbit| orbit.wave_speed),
            period_s: orbit.map(|orbit| orbit.period),
            speed_after_corner_m_s: orbit.map(|orbit| orbit.speed_after),
            speed_before_corner_m_s: orbit.map(|orbit| orbit.speed_before),
            slope: orbit.map(|orbit| orbit.slope),
            least_push_n: orbit.map(|orbit| orbit.least_push),
            corner_impulse_ns: orbit.map(|orbit| orbit.corner_impulse),
            torque_nm: orbit.map(|orbit| orbit.torque),
            power_w: orbit.map(|orbit| orbit.power),
            damper_power_w: orbit.map(|orbit| orbit.damper_power),
            corner_power_w: orbit.map(|orbit| orbit.corner_power),
        }
    }
}

/// Slip over speed, a row each.
#[must_use]
pub fn slip_table(points: &[SlipPoint]) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "slip",
        "wave_speed_rad_s",
        "period_s",
        "slope",
        "least_push_n",
        "torque_nm",
        "power_w",
    ]);
    for point in points {
        let figure = |read: fn(&crate::harmonic::SlipOrbit) -> f64| {
            Cell::from(point.outcome.as_ref().ok().map(read))
        };
        let word = match point.outcome {
            Ok(_) if point.stable() => "stable",
            Ok(_) => "unstable",
            Err(reason) => reason.word(),
        };
        table.push(vec![
            point.speed.into(),
            word.into(),
            figure(|orbit| orbit.wave_speed),
            figure(|orbit| orbit.period),
            figure(|orbit| orbit.slope),
            figure(|orbit| orbit.least_push),
            figure(|orbit| orbit.torque),
            figure(|orbit| orbit.power),
        ]);
    }
    table
}

/// Where slip lives at one damping ratio, in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct RegionReport {
    casing_damping_ratio: f64,
    /// Whether there is slip at the lowest speed.
    exists_at_lowest: bool,
    /// Speeds where slip appears and vanishes.
    limits: Vec<LimitReport>,
}

#[derive(Clone, Debug, Serialize)]
struct LimitReport {
    speed_rad_s: f64,
    appears: bool,
}

/// Where slip lives at one damping ratio.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Damping ratio of the casing.
    pub zeta: f64,
    /// Whether there is slip at the lowest speed.
    pub at_lowest: bool,
    /// Speeds \[rad/s\] where slip appears (`true`) and vanishes.
    pub limits: Vec<(f64, bool)>,
}

impl Region {
    /// Where between the lowest and the highest speed there is slip.
    fn word(&self) -> &'static str {
        match (self.limits.is_empty(), self.at_lowest) {
            (true, true) => "everywhere",
            (true, false) => "nowhere",
            (false, _) => "in part",
        }
    }
}

impl RegionReport {
    /// Of a damping ratio and its limits.
    #[must_use]
    pub fn of(region: &Region) -> Self {
        let limit = |&(speed_rad_s, appears): &(f64, bool)| LimitReport { speed_rad_s, appears };
        Self {
            casing_damping_ratio: region.zeta,
            exists_at_lowest: region.at_lowest,
            limits: region.limits.iter().map(limit).collect(),
        }
    }
}

/// Where slip lives, a row for each damping ratio.
#[must_use]
pub fn region_table(regions: &[Region]) -> Table {
    let mut table =
        Table::new(&["casing_damping_ratio", "slip", "appears_rad_s", "vanishes_rad_s"]);
    for region in regions {
        let first =
            |appears| region.limits.iter().find(|limit| limit.1 == appears).map(|limit| limit.0);
        table.push(vec![
            region.zeta.into(),
            region.word().into(),
            first(true).into(),
            first(false).into(),
        ]);
    }
    table
}

/// The series at one speed in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct HarmonicsReport {
    speed_rad_s: f64,
    exists: bool,
    reason: Option<NoSlip>,
    period_s: Option<f64>,
    amplitude_m: Option<f64>,
    terms: Vec<TermReport>,
    truncation: Vec<TruncationReport>,
}

#[derive(Clone, Debug, Serialize)]
struct TermReport {
    number: i32,
    frequency_rad_s: f64,
    amplitude_m: f64,
}

#[derive(Clone, Debug, Serialize)]
struct TruncationReport {
    harmonics: u32,
    rms_error_m: f64,
    max_error_m: f64,
    penetration_m: f64,
}

impl HarmonicsReport {
    /// Of this speed.
    #[must_use]
    pub fn of((speed, series): &(f64, Result<SlipSpectrum, NoSlip>)) -> Self {
        let found = series.as_ref().ok();
        let terms = found.into_iter().flat_map(|series| &series.terms).map(|term| TermReport {
            number: term.number,
            frequency_rad_s: term.frequency,
            amplitude_m: term.amplitude,
        });
        let truncation = found.into_iter().flat_map(|series| &series.truncations);
        Self {
            speed_rad_s: *speed,
            exists: found.is_some(),
            reason: series.as_ref().err().copied(),
            period_s: found.map(|series| series.period),
            amplitude_m: found.map(|series| series.amplitude),
            terms: terms.collect(),
            truncation: truncation
                .map(|cut| TruncationReport {
                    harmonics: cut.harmonics,
                    rms_error_m: cut.rms_error,
                    max_error_m: cut.max_error,
                    penetration_m: cut.penetration,
                })
                .collect(),
        }
    }
}

/// What is left out with `H` harmonics.
#[must_use]
pub fn truncation_table(series: &SlipSpectrum) -> Table {
    let mut table = Table::new(&[
        "harmonics",
        "rms_error_m",
        "max_error_m",
        "part_of_amplitude",
        "penetration_m",
    ]);
    for cut in &series.truncations {
        table.push(vec![
            f64::from(cut.harmonics).into(),
            cut.rms_error.into(),
            cut.max_error.into(),
            (cut.max_error / series.amplitude).into(),
            cut.penetration.into(),
        ]);
    }
    table
}

/// The coefficients, amplitude by amplitude.
#[must_use]
pub fn term_table(series: &SlipSpectrum) -> Table {
    let mut table = Table::new(&["number", "frequency_rad_s", "amplitude_m", "part_of_amplitude"]);
    for term in &series.terms {
        table.push(vec![
            f64::from(term.number).into(),
            term.frequency.into(),
            term.amplitude.into(),
            (term.amplitude / series.amplitude).into(),
        ]);
    }
    table
}
