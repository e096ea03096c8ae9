//! The limits of a machine for every number of diameters from 0 to N/2: the speeds of
//! `margins`, which of them lie in a range of speeds, and which are nearest to the scene's.
//!
//! A limit of a rotor that turns backward is a negative speed. Its size is that of the
//! forward one unless friction tells the two apart.

use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;
use strum::IntoEnumIterator;
use thiserror::Error;

use super::margins::{LimitName, Parameter, shown_margin, speed_sensitivities, speeds};
use crate::harmonic::lock_window;
use crate::scene::units::{self, RangeError, UnitError};
use crate::scene::{CheckedScene, Scene};

/// Why a survey was refused.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SurveyError {
    /// No range.
    #[error(
        "range {text}: allowed is FROM:TO, two speeds, the lower one first, such as \
         6000rpm:11000rpm"
    )]
    Range {
        /// As given.
        text: String,
    },
    /// An end of another quantity.
    #[error("range {text}: {why}")]
    Unit {
        /// As given.
        text: String,
        /// What it is, and which units are allowed.
        why: UnitError,
    },
}

/// Reads `FROM:TO` \[rad/s\].
///
/// # Errors
/// Text of another form, an end of another quantity, or a lower end that is not lower.
pub fn speed_range(text: &str) -> Result<[f64; 2], SurveyError> {
    let form = || SurveyError::Range { text: text.to_string() };
    match units::read_ends(text, units::Quantity::Speed) {
        Ok(([from, to], None)) if from < to && (to - from).is_finite() => Ok([from, to]),
        Err(RangeError::End(why)) => Err(SurveyError::Unit { text: text.to_string(), why }),
        _ => Err(form()),
    }
}

/// Every number of diameters of a machine.
///
/// ```
/// use rubscope_solver::scene::Scene;
/// use rubscope_solver::study::margins::LimitName;
/// use rubscope_solver::study::survey::Survey;
///
/// let scene = Scene::builtin("paper-nd3")?.checked()?;
/// let survey = Survey::of(&scene, Some([200.0, 300.0]), None);
/// assert_eq!(survey.rows.len(), 12);
/// let four = survey.rows[4].limit(LimitName::OmegaC, true).ok_or("it has one")?;
/// assert!((four.value - 256.12).abs() < 1e-2 && four.in_range == Some(true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Survey {
    /// The scene; its own number of diameters is one of them.
    pub scene: CheckedScene,
    /// The range of speeds that was asked for \[rad/s\].
    pub range_rad_s: Option<[f64; 2]>,
    /// The parameter whose sensitivity each limit has, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<&'static str>,
    /// What the limits are of, where the scene asks for more than they have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// What tips of their own lengths do to the lock of the scene, where it has one.
    pub scattered: Option<Scattered>,
    /// One row for each number of diameters, from 0.
    pub rows: Vec<SurveyRow>,
    /// Wall time \[s\].
    pub wall_s: f64,
}

/// Locks of rotors whose tips differ by chance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scattered {
    /// Standard deviation of the tips, 1 % of the clearance \[m\].
    pub tip_scatter_m: f64,
    /// How many rotors were drawn.
    pub rotors: u32,
    /// `Omega_lock` of equal tips, the last of all \[rad/s\].
    pub equal_rad_s: f64,
    /// The mean of the lowest speeds at which a corner of those rotors is held \[rad/s\].
    pub mean_rad_s: f64,
}

impl Scattered {
    /// Draws rotors for a scene; none where its equal tips have no lock, or one on a lining.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        const ROTORS: u32 = 200;
        let lock = |tip_scatter_m: f64, tip_seed: u32| {
            let mut rotor = scene.clone();
            (rotor.bladed_disk.tips_m, rotor.casing.out_of_round_m) = (Vec::new(), 0.0);
            (rotor.bladed_disk.longest_tip_m, rotor.bladed_disk.orbit_m) = (0.0, 0.0);
            (rotor.bladed_disk.tip_scatter_m, rotor.bladed_disk.tip_seed) =
                (tip_scatter_m, tip_seed);
            let window = lock_window(&rotor.machine(), scene.operation.speed_rad_s);
            window.map(|window| window.from)
        };
        let (equal_rad_s, tip_scatter_m) = (lock(0.0, 1)?, 0.01 * scene.clearance());
        let draws = (1..=ROTORS).into_par_iter().map(|seed| lock(tip_scatter_m, seed));
        let found: Vec<f64> = draws.collect::<Option<_>>()?;
        let mean_rad_s = found.iter().sum::<f64>() / f64::from(ROTORS);
        Some(Self { tip_scatter_m, rotors: ROTORS, equal_rad_s, mean_rad_s })
    }
}

/// One number of diameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyRow {
    /// How many.
    pub nodal_diameters: u32,
    /// Frequency of the casing \[rad/s\].
    pub omega_c_rad_s: f64,
    /// Frequency of the bladed disk \[rad/s\].
    pub omega_bd_rad_s: f64,
    /// Whether modes of casing and disk are known for them, where any are.
    pub modes_known: bool,
    /// The limits that there are, in the order of `margins`; forward ones first.
    pub limits: Vec<SurveyLimit>,
}

/// One limit of one number of diameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyLimit {
    /// Which.
    pub name: LimitName,
    /// Its speed; below zero for a rotor that turns backward \[rad/s\].
    pub value: f64,
    /// How far the scene is beyond it, as a part of it; none for the other sense of rotation.
    #[serde(serialize_with = "shown_margin")]
    pub margin: Option<f64>,
    /// Whether it lies in the range; none without a range.
    pub in_range: Option<bool>,
    /// Its change in per cent by one per cent of the parameter that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<f64>,
}

impl SurveyRow {
    /// A limit of a rotor that turns forward, or backward.
    #[must_use]
    pub fn limit(&self, name: LimitName, forward: bool) -> Option<&SurveyLimit> {
        self.limits
            .iter()
            .find(|limit| limit.name == name && limit.value.is_sign_positive() == forward)
    }
}

impl Survey {
    /// The survey of a scene, over a range of speeds, with the sensitivities by a parameter,
    /// if there is one.
    #[must_use]
    pub fn of(scene: &CheckedScene, range: Option<[f64; 2]>, by: Option<&Parameter>) -> Self {
        let start = Instant::now();
        let most = scene.bladed_disk.blades / 2;
        let rows = (0..=most).into_par_iter().map(|diameters| row(scene, diameters, range, by));
        Self {
            scene: scene.clone(),
            range_rad_s: range,
            by: by.map(|parameter| parameter.path),
            note: scene.tuned_note(),
            scattered: Scattered::of(scene),
            rows: rows.collect(),
            wall_s: start.elapsed().as_secs_f64(),
        }
    }

    /// The sense of rotation that is looked at: that of the range, or else of the scene.
    #[must_use]
    pub fn is_forward(&self) -> bool {
        let speed = self.scene.operation.speed_rad_s;
        match self.range_rad_s {
            Some([from, to]) if from + to != 0.0 => from + to > 0.0,
            _ => speed >= 0.0,
        }
    }

    /// Limits with the diameters that they are of, the nearest to the scene first: those in
    /// the range, or all of the scene's sense of rotation without one. Diameters of which no
    /// mode is known, where others are, have none of this machine.
    #[must_use]
    pub fn nearest(&self) -> Vec<(u32, &SurveyLimit)> {
        let speed = self.scene.operation.speed_rad_s;
        let own = self.is_forward();
        let wanted = |limit: &SurveyLimit| match limit.in_range {
            Some(inside) => inside,
            None => limit.value.is_sign_positive() == own,
        };
        let mut found: Vec<(u32, &SurveyLimit)> = self
            .rows
            .iter()
            .filter(|row| row.modes_known)
            .flat_map(|row| row.limits.iter().map(|limit| (row.nodal_diameters, limit)))
            .filter(|(_, limit)| wanted(limit))
            .collect();
        found.sort_by(|a, b| {
            let far = |limit: &SurveyLimit| (limit.value - speed).abs();
            far(a.1).total_cmp(&far(b.1))
        });
        found
    }

    /// The names of limits that any row has, in the order of `margins`.
    #[must_use]
    pub fn names(&self) -> Vec<LimitName> {
        let has = |name: LimitName| {
            self.rows.iter().any(|row| row.limits.iter().any(|limit| limit.name == name))
        };
        LimitName::iter().filter(|name| has(*name)).collect()
    }
}

/// The scene with so many diameters, whose mode is then in use.
fn with_diameters(scene: &Scene, diameters: u32) -> Scene {
    let mut scene = scene.clone();
    scene.operation.nodal_diameters = diameters;
    scene
}

fn row(
    scene: &CheckedScene,
    diameters: u32,
    range: Option<[f64; 2]>,
    by: Option<&Parameter>,
) -> SurveyRow {
    let scene = with_diameters(scene, diameters);
    let machine = scene.machine();
    let own = 1_f64.copysign(scene.operation.speed_rad_s);
    let found = Speeds::of(&scene, own, by);
    // Only friction tells the two senses apart.
    let other = (scene.contact.friction != 0.0).then(|| Speeds::of(&scene, -own, by));
    let of = |sense: f64| match &other {
        Some(other) if sense != own => other,
        _ => &found,
    };
    let limits = [1.0, -1.0].map(|sense| of(sense).limits(&scene, sense, range));
    SurveyRow {
        nodal_diameters: diameters,
        omega_c_rad_s: machine.omega_c,
        omega_bd_rad_s: machine.omega_bd,
        modes_known: scene.modes_note().is_none(),
        limits: limits.concat(),
    }
}

/// The sizes of the limits of a rotor that turns in one sense, and their sensitivities.
struct Speeds {
    sizes: Vec<(LimitName, f64)>,
    by: Vec<Option<f64>>,
}

impl Speeds {
    fn of(scene: &Scene, sense: f64, by: Option<&Parameter>) -> Self {
        let mut turned = scene.clone();
        turned.operation.speed_rad_s = sense * scene.operation.speed_rad_s.abs().max(1.0);
        let by = by.map_or(Vec::new(), |by| speed_sensitivities(&turned, by));
        Self { sizes: speeds(&turned), by }
    }

    /// As limits of a rotor that turns in this sense.
    fn limits(&self, scene: &Scene, sense: f64, range: Option<[f64; 2]>) -> Vec<SurveyLimit> {
        let present = scene.operation.speed_rad_s;
        let limit = |(place, (name, size)): (usize, &(LimitName, f64))| {
            let value = sense * size;
            SurveyLimit {
                name: *name,
                value,
                margin: (present * sense >= 0.0 && *size > 0.0).then(|| present.abs() / size - 1.0),
                in_range: range.map(|[from, to]| (from..=to).contains(&value)),
                by: self.by.get(place).copied().flatten(),
            }
        };
        self.sizes.iter().enumerate().map(limit).collect()
    }
}
