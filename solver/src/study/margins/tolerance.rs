//! How far limits spread where parameters are known only so well: by the first
//! derivatives, and by samples. Each parameter is taken as evenly likely anywhere
//! within its tolerance.

use rayon::prelude::*;
use serde::Serialize;
use thiserror::Error;

use super::closed::{CLOSED, values};
use super::limit::LimitName;
use super::parameters::{Parameter, Parameters, is_length, parameter};
use super::target::paths;
use super::{Margins, touching};
use crate::scene::CheckedScene;

/// Samples taken.
pub const SAMPLES: usize = 10_000;
/// Where the random numbers begin.
pub const SEED: u64 = 2010;
/// Largest tolerance, in per cent: values beyond are not those of one design.
const MOST_PERCENT: f64 = 50.0;
/// Parts of the samples at the ends of the range that is told.
const ENDS: [f64; 2] = [0.025, 0.975];

/// Why a tolerance was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ToleranceError {
    /// Text of another form, or out of bounds.
    #[error(
        "tolerance {text}: allowed is PATH=PERCENT, such as casing.damping_ratio=10, PERCENT above 0 and up to {MOST_PERCENT}"
    )]
    Form {
        /// As given.
        text: String,
    },
    /// No parameter.
    #[error("tolerance {path}: allowed is one of {}", paths())]
    Parameter {
        /// As given.
        path: String,
    },
    /// The same parameter again.
    #[error("tolerance {path} is given twice: allowed is once")]
    Twice {
        /// As given.
        path: String,
    },
    /// A length that may be off by more than the clearance.
    #[error(
        "tolerance {path} = {percent}: allowed is less than {most:.3} %, the clearance as a part of it; or give clearance=PERCENT"
    )]
    Length {
        /// As given.
        path: String,
        /// As given \\[%\\].
        percent: f64,
        /// The clearance \\[%\\].
        most: f64,
    },
    /// A parameter that is zero.
    #[error("tolerance {path}: the scene has 0 there, and per cents of it are 0")]
    Zero {
        /// As given.
        path: String,
    },
}

/// How well one parameter is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// Path of the parameter.
    pub path: &'static str,
    /// It is within this of its value \[%\].
    pub percent: f64,
}

/// How far one limit spreads, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Standard deviation by the first derivatives.
    pub linear_sd: Option<f64>,
    /// Largest change by the first derivatives, all tolerances against it.
    pub linear_worst: Option<f64>,
    /// By samples; none for limits that are searched by many runs each.
    pub sampled: Option<Sampled>,
}

/// What samples of one limit are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sampled {
    /// Number of samples.
    pub samples: usize,
    /// Where the random numbers began.
    pub seed: u64,
    /// Samples without such a limit, not counted below.
    pub missing: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
    /// 95 % of the samples are from this...
    pub low: f64,
    /// ...to this.
    pub high: f64,
}

impl Tolerance {
    /// Reads tolerances of a scene, each `PATH=PERCENT`.
    ///
    /// # Errors
    /// The first that is of another form, out of bounds, given twice, or of nothing.
    pub fn parse_all(texts: &[String], scene: &CheckedScene) -> Result<Vec<Self>, ToleranceError> {
        let mut found: Vec<Self> = Vec::new();
        for text in texts {
            let form = || ToleranceError::Form { text: text.clone() };
            let (path, percent) = text.split_once('=').ok_or_else(form)?;
            let path = path.trim().to_string();
            let Some(known) = parameter(&path) else {
                return Err(ToleranceError::Parameter { path });
            };
            let percent = percent.trim().trim_end_matches('%').trim_end();
            let percent: f64 = percent.parse().map_err(|_| form())?;
            if !(percent > 0.0 && percent <= MOST_PERCENT) {
                return Err(form());
            }
            if found.iter().any(|other| other.path == known.path) {
                return Err(ToleranceError::Twice { path });
            }
            if known.of(scene) == 0.0 {
                return Err(ToleranceError::Zero { path });
            }
            if is_length(known.path) {
                let most = 100.0 / known.lever(scene).abs();
                if percent >= most {
                    return Err(ToleranceError::Length { path, percent, most });
                }
            }
            found.push(Self { path: known.path, percent });
        }
        Ok(found)
    }
}

impl Margins {
    /// Adds how far each limit spreads with these tolerances; `counted` is called after
    /// each of the `SAMPLES`.
    pub fn spread(&mut self, tolerances: Vec<Tolerance>, counted: &(dyn Fn() + Sync)) {
        if tolerances.is_empty() {
            return;
        }
        let samples = Samples::of(self, &tolerances, counted);
        let mut before = None;
        for limit in &mut self.limits {
            // Samples are of the first of a name.
            let again = before.replace(limit.name) == Some(limit.name);
            let Some(value) = limit.value else { continue };
            let sum = |each: &dyn Fn(f64) -> f64| -> Option<f64> {
                let parts = tolerances.iter().map(|tolerance| {
                    Some(each(limit.sensitivities.by(tolerance.path)? * tolerance.percent / 100.0))
                });
                parts.sum()
            };
            // A parameter that is evenly likely has this deviation.
            let variance = sum(&|part| part * part / 3.0);
            let worst = sum(&f64::abs);
            limit.spread = Some(Spread {
                linear_sd: variance.map(|variance| value.abs() * variance.sqrt()),
                linear_worst: worst.map(|worst| value.abs() * worst),
                sampled: if again { None } else { samples.told(limit.name) },
            });
        }
        self.tolerances = tolerances;
    }
}

/// The limits of every sample, `CLOSED` and then the touching pulse.
struct Samples(Vec<[Option<f64>; CLOSED.len() + 1]>);

impl Samples {
    fn of(margins: &Margins, tolerances: &[Tolerance], counted: &(dyn Fn() + Sync)) -> Self {
        let scene = &margins.scene;
        let touches =
            margins.limit(LimitName::TouchingPulse).is_some_and(|limit| limit.value.is_some());
        let known: Vec<(&Parameter, f64)> = tolerances
            .iter()
            .filter_map(|tolerance| Some((parameter(tolerance.path)?, tolerance.percent / 100.0)))
            .collect();
        let mut random = fastrand::Rng::with_seed(SEED);
        let changes: Vec<Vec<f64>> = (0..SAMPLES)
            .map(|_| known.iter().map(|(_, part)| part * (2.0 * random.f64() - 1.0)).collect())
            .collect();
        let sample = |changes: &Vec<f64>| {
            let mut changed = scene.clone().into_scene();
            for ((parameter, _), change) in known.iter().zip(changes) {
                // The clearance and its lengths each keep what the one before changed.
                let value = parameter.of(&changed) * (1.0 + change);
                match parameter.set(&changed, value) {
                    Ok(scene) => changed = scene,
                    Err(_) => return [None; CLOSED.len() + 1],
                }
            }
            let Ok(changed) = changed.checked() else { return [None; CLOSED.len() + 1] };
            let mut all = [None; CLOSED.len() + 1];
            let closed = values(&Parameters::<f64>::of(&changed));
            all[..CLOSED.len()].copy_from_slice(&closed);
            if touches {
                all[CLOSED.len()] = touching::smallest(&changed).map(|touch| touch.pulse_n);
            }
            all
        };
        Self(changes.par_iter().map(|changes| (sample(changes), counted()).0).collect())
    }

    /// What the samples of a limit are; none of one that was not sampled.
    fn told(&self, name: LimitName) -> Option<Sampled> {
        let place = match name {
            LimitName::TouchingPulse => CLOSED.len(),
            _ => CLOSED.iter().position(|closed| *closed == name)?,
        };
        let mut found: Vec<f64> = self.0.iter().filter_map(|sample| sample[place]).collect();
        found.retain(|value| value.is_finite());
        found.sort_by(f64::total_cmp);
        let count = found.len() as f64;
        // From the first, so that equal samples have exactly their own mean.
        let first = *found.first()?;
        let mean = first + found.iter().map(|value| value - first).sum::<f64>() / count;
        let variance =
            found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let at = |part: f64| found.get((part * (count - 1.0)).round() as usize).copied();
        let [low, high] = ENDS.map(at);
        Some(Sampled {
            samples: SAMPLES,
            seed: SEED,
            missing: SAMPLES - found.len(),
            mean,
            sd: Some(variance.sqrt()).filter(|sd| sd.is_finite())?,
            low: low?,
            high: high?,
        })
    }
}
