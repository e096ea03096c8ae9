//! Survey of a machine over all nodal diameters from 0 to N/2: the characteristic speeds of
//! `margins`, and the speeds within a range at which waves can lock or whirl.
//!
//! Limits for backward rotation are negative. Their magnitude equals that of the forward ones
//! unless there is friction.

use std::cmp::Ordering;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use super::margins::{LimitName, shown_margin, speeds};
use crate::harmonic::{SpeedRanges, lock_windows};
use crate::model::{LockWindow, Machine};
use crate::scene::{CheckedScene, Key, SPEED_RANGE, Scene, SceneError, is_speed_range, keys};

/// Survey of a machine over all nodal diameters.
///
/// ```
/// use rubscope_solver::scene::Scene;
/// use rubscope_solver::study::margins::LimitName;
/// use rubscope_solver::study::survey::Survey;
///
/// let scene = Scene::builtin("paper-nd3")?.checked()?;
/// let survey = Survey::of(&scene, Some([200.0, 300.0]), None)?;
/// assert_eq!(survey.rows.len(), 12);
/// let four = survey.rows[4].limit(LimitName::OmegaC, true).ok_or("it has one")?;
/// assert!((four.value - 256.12).abs() < 1e-2 && four.in_range == Some(true));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Survey {
    /// Scene; its own nodal diameters are among the rows.
    pub scene: CheckedScene,
    /// Requested range of speeds; `None` for all speeds in the scene's direction of rotation
    /// \[rad/s\].
    pub range_rad_s: Option<[f64; 2]>,
    /// Parameter for which each limit has a sensitivity, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<&'static str>,
    /// Simplification of the limits compared with the scene, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Effect of random tip lengths on the lock of the scene; `None` as in [`Scattered::of`].
    pub scattered: Option<Scattered>,
    /// One row for each number of nodal diameters, from 0.
    pub rows: Vec<SurveyRow>,
    /// Wall time \[s\].
    pub wall_s: f64,
}

/// Lock speeds of rotors with random tip lengths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scattered {
    /// Standard deviation of the tip lengths, 1 % of the clearance \[m\].
    pub tip_scatter_m: f64,
    /// Number of random rotors.
    pub rotors: u32,
    /// Lock speed with equal tips, which is the highest \[rad/s\].
    pub equal_rad_s: f64,
    /// Mean over the rotors of the lowest speed at which a corner is held \[rad/s\].
    pub mean_rad_s: f64,
}

impl Scattered {
    /// Evaluates random rotors for a scene; `None` if the machine with equal tips has no lock, on a
    /// lining, and with a clearance that changes with speed.
    #[must_use]
    pub fn of(scene: &Scene) -> Option<Self> {
        const ROTORS: u32 = 200;
        let lock = |tip_scatter_m: f64, tip_seed: u32| {
            let mut rotor = even(scene);
            (rotor.bladed_disk.tip_scatter_m, rotor.bladed_disk.tip_seed) =
                (tip_scatter_m, tip_seed);
            // The pushes of rigid blades in closed form: hundreds of corners are compared.
            let windows = rotor.machine().lock_windows(scene.operation.speed_rad_s);
            windows.first().map(|window| window.from)
        };
        let (equal_rad_s, tip_scatter_m) = (lock(0.0, 1)?, 0.01 * scene.clearance());
        let draws = (1..=ROTORS).into_par_iter().map(|seed| lock(tip_scatter_m, seed));
        let found: Vec<f64> = draws.collect::<Option<_>>()?;
        let mean_rad_s = found.iter().sum::<f64>() / f64::from(ROTORS);
        Some(Self { tip_scatter_m, rotors: ROTORS, equal_rad_s, mean_rad_s })
    }
}

/// Results for one number of nodal diameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyRow {
    /// Number of nodal diameters.
    pub nodal_diameters: u32,
    /// Frequency of the casing \[rad/s\].
    pub omega_c_rad_s: f64,
    /// Frequency of the bladed disk \[rad/s\].
    pub omega_bd_rad_s: f64,
    /// Whether the scene has no modes of these nodal diameters, so that these frequencies are
    /// borrowed.
    pub guessed: bool,
    /// Intervals of speed in which a lock holds, from the lowest, within the range or, without one,
    /// within all speeds of the scene's direction of rotation; the last may end at infinity. `None`
    /// if unknown for these tips and this casing \[rad/s\].
    pub locks_in_range: Option<Vec<[f64; 2]>>,
    /// Speeds within the range at which inclined tips begin to whirl; if they whirl at no speed, the
    /// coincidence that acts on them \[rad/s\].
    pub whirls_in_range: Vec<f64>,
    /// Intervals of speed in which a whirl lasts, in the form of `locks_in_range` \[rad/s\].
    pub whirl_spans: Vec<[f64; 2]>,
    /// Intervals of speed in which rubbing grows without bound, in the form of `locks_in_range`
    /// \[rad/s\].
    pub growth_spans: Vec<[f64; 2]>,
    /// Existing limits, in the order of `margins`, forward ones first.
    pub limits: Vec<SurveyLimit>,
}

/// A limit for one number of nodal diameters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurveyLimit {
    /// Name of the limit.
    pub name: LimitName,
    /// Speed; negative for backward rotation \[rad/s\].
    pub value: f64,
    /// Speed of the scene divided by the limit, minus 1; `None` for the other direction of rotation
    /// and for a limit at standstill.
    #[serde(serialize_with = "shown_margin")]
    pub margin: Option<f64>,
    /// Whether the limit lies in the range; `None` without a range.
    pub in_range: Option<bool>,
    /// Sensitivity of the limit to the requested parameter, in per cent for one per cent of it;
    /// `None` if not requested, or if there is no derivative.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<f64>,
}

impl SurveyRow {
    /// Returns a limit for forward or backward rotation; `None` if these nodal diameters have none
    /// of this name.
    #[must_use]
    pub fn limit(&self, name: LimitName, forward: bool) -> Option<&SurveyLimit> {
        self.limits
            .iter()
            .find(|limit| limit.name == name && limit.value.is_sign_positive() == forward)
    }

    /// Returns whether a wave can lock at a speed \[rad/s\].
    #[must_use]
    pub fn locks_at(&self, speed: f64) -> bool {
        let has = |[from, to]: &[f64; 2]| (*from..=*to).contains(&speed);
        self.locks_in_range.as_ref().is_some_and(|locks| locks.iter().any(has))
    }

    /// Returns the sort key: rows with a lock throughout the range first, then by the lowest lock
    /// speed, those with unknown lock speeds last; equal ones by the lowest whirl speed.
    fn order(&self, range: [f64; 2]) -> [f64; 2] {
        let least = |speeds: &[f64]| speeds.iter().map(|x| x.abs()).fold(f64::INFINITY, f64::min);
        let locks = match &self.locks_in_range {
            None => f64::MAX,
            Some(locks) if locks.contains(&range) => 0.0,
            Some(locks) => least(locks.as_flattened()),
        };
        [locks, least(&self.whirls_in_range)]
    }
}

impl Survey {
    /// Computes the survey of a scene over a range of speeds \[rad/s\], with the sensitivity of
    /// every limit to a parameter, if requested.
    ///
    /// # Errors
    /// The range is not finite, or its ends are not in increasing order.
    pub fn of(
        scene: &CheckedScene,
        range: Option<[f64; 2]>,
        by: Option<&Key>,
    ) -> Result<Self, SceneError> {
        if let Some([from, to]) = range.filter(|range| !is_speed_range(*range)) {
            return Err(SceneError::refused("range", format!("{from}:{to}"), SPEED_RANGE));
        }
        let start = Instant::now();
        let most = scene.bladed_disk.blades / 2;
        let rows = (0..=most).into_par_iter().map(|diameters| row(scene, diameters, range, by));
        Ok(Self {
            scene: scene.clone(),
            range_rad_s: range,
            by: by.map(|parameter| parameter.path),
            note: scene.tuned_note(),
            scattered: Scattered::of(scene),
            rows: rows.collect(),
            wall_s: start.elapsed().as_secs_f64(),
        })
    }

    /// Returns whether the survey refers to forward rotation: by the range, otherwise by the scene.
    #[must_use]
    pub fn is_forward(&self) -> bool {
        let speed = self.scene.operation.speed_rad_s;
        match self.range_rad_s {
            Some([from, to]) if from + to != 0.0 => from + to > 0.0,
            _ => speed >= 0.0,
        }
    }

    /// Returns the range, or all speeds of the scene's direction of rotation \[rad/s\].
    #[must_use]
    pub fn speeds(&self) -> [f64; 2] {
        searched(self.range_rad_s, &self.scene)
    }

    /// Returns the rows in order of relevance within the range: all, or those with modes of their
    /// own and that of the scene, where the scene lists modes.
    #[must_use]
    pub fn shown(&self, all: bool) -> Vec<&SurveyRow> {
        let own = self.scene.operation.nodal_diameters;
        let all = all || self.scene.casing.modes.is_empty();
        let shown = |row: &&SurveyRow| all || !row.guessed || row.nodal_diameters == own;
        let mut rows: Vec<&SurveyRow> = self.rows.iter().filter(shown).collect();
        let order = |row: &SurveyRow| row.order(self.speeds());
        rows.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(Ordering::Equal));
        rows
    }
}

/// Returns the range, or all speeds of the scene's direction of rotation.
fn searched(range: Option<[f64; 2]>, scene: &Scene) -> [f64; 2] {
    let forward = scene.operation.speed_rad_s >= 0.0;
    range.unwrap_or(if forward { [0.0, f64::INFINITY] } else { [f64::NEG_INFINITY, 0.0] })
}

/// Returns the scene with equal tips in a round casing.
fn even(scene: &Scene) -> Scene {
    let (mut even, paper) = (scene.clone(), Scene::base());
    let uneven = scene.unevenness().into_iter().filter_map(|(path, _)| keys::find(path).ok());
    uneven.for_each(|key| (key.set)(&mut even, (key.get)(&paper)));
    even
}

/// Returns the intervals of these speeds in which a lock holds, from the lowest; `None` if unknown.
fn locks<'a>(
    scene: &Scene,
    machine: &Machine,
    asked: [f64; 2],
    ranges: impl Fn(f64) -> &'a SpeedRanges,
) -> Option<Vec<[f64; 2]>> {
    if !machine.knows_locks() {
        // Lobes only break a lock, so none in a round casing is none. Unequal tips can lock where
        // equal ones do not.
        let round = even(scene).machine();
        let locks = || senses(asked).any(|sense| !lock_windows(&round, sense).is_empty());
        if machine.has_unequal_tips() || locks() {
            return None;
        }
    }
    Some(within(asked, |sense| ranges(sense).locks()))
}

/// Returns the directions of rotation of these speeds.
fn senses([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    [-1.0, 1.0].into_iter().filter(move |sense| if *sense < 0.0 { from < 0.0 } else { to > 0.0 })
}

/// Returns the parts within these speeds of ranges of their magnitudes, from the lowest.
fn within<'a>(asked: [f64; 2], of: impl Fn(f64) -> &'a [LockWindow]) -> Vec<[f64; 2]> {
    let [from, to] = asked;
    let parts = senses(asked).flat_map(|sense| {
        of(sense).iter().filter_map(move |window| {
            let ends = [window.from, window.to.unwrap_or(f64::INFINITY)].map(|end| sense * end);
            let [low, high] = [ends[0].min(ends[1]).max(from), ends[0].max(ends[1]).min(to)];
            (low < high).then_some([low, high])
        })
    });
    let mut found: Vec<[f64; 2]> = parts.collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    found
}

/// Returns the speeds in this interval at which whirl begins: the slower ends of its spans or, if no
/// span is known in a direction, the coincidence that the tips feel, unless rubbing grows there.
fn whirls(
    machine: &Machine,
    limits: &[SurveyLimit],
    [spans, growths]: [&[[f64; 2]]; 2],
    asked: [f64; 2],
) -> Vec<f64> {
    let of_sense = |sense: f64| {
        let onset =
            |limit: &SurveyLimit| limit.name == LimitName::WhirlOnset && limit.value * sense >= 0.0;
        let grows = |at: f64| growths.iter().any(|[from, to]| (*from..=*to).contains(&at));
        let felt = machine.coincidence_felt_at(sense);
        let felt = felt.filter(|at| !limits.iter().any(onset) && !grows(*at));
        let own = spans.iter().filter(move |[from, to]| sense * (from + to) > 0.0);
        let slower = own.map(move |[from, to]| if sense > 0.0 { *from } else { *to });
        slower.chain(felt).collect::<Vec<_>>()
    };
    let moves = machine.coupling_product_at(1.0) != 0.0;
    let all = senses(asked).filter(|_| moves).flat_map(of_sense);
    all.filter(|speed| (asked[0]..=asked[1]).contains(speed)).collect()
}

fn row(
    scene: &CheckedScene,
    diameters: u32,
    range: Option<[f64; 2]>,
    by: Option<&Key>,
) -> SurveyRow {
    // Without a list of modes there is only that of the scene's own nodal diameters.
    let is_other = diameters != scene.operation.nodal_diameters && scene.casing.modes.is_empty();
    // Selects the modes with these nodal diameters.
    let mut scene = Scene::clone(scene);
    scene.operation.nodal_diameters = diameters;
    let machine = scene.machine();
    let own = 1_f64.copysign(scene.operation.speed_rad_s);
    let asked = searched(range, &scene);
    let found = Speeds::new(&scene, own, by);
    // Limits depend on the direction of rotation only with friction.
    let other = (scene.contact.friction != 0.0).then(|| Speeds::new(&scene, -own, by));
    let of = |sense: f64| match &other {
        Some(other) if sense != own => other,
        _ => &found,
    };
    let limits = [1.0, -1.0].map(|sense| of(sense).limits(&scene, sense, range)).concat();
    let back = SpeedRanges::new(&machine, -own);
    let ranges = |sense: f64| match &other {
        _ if sense == own => &found.ranges,
        Some(other) => &other.ranges,
        None => &back,
    };
    // A lining that is compressed at rest has limits of its own.
    let open = scene.clearance() > 0.0;
    let spans = |of: fn(&SpeedRanges) -> &[LockWindow]| {
        within(asked, |sense| if open { of(ranges(sense)) } else { &[] })
    };
    let (whirl_spans, growth_spans) = (spans(SpeedRanges::whirls), spans(SpeedRanges::growths));
    SurveyRow {
        nodal_diameters: diameters,
        omega_c_rad_s: machine.omega_c,
        omega_bd_rad_s: machine.omega_bd,
        guessed: is_other || scene.modes_note().is_some(),
        locks_in_range: locks(&scene, &machine, asked, ranges),
        whirls_in_range: whirls(&machine, &limits, [&whirl_spans, &growth_spans], asked),
        whirl_spans,
        growth_spans,
        limits,
    }
}

/// Magnitudes of the limits for one direction of rotation with their sensitivities, and the ranges
/// on which they rest.
struct Speeds {
    limits: Vec<(LimitName, f64, Option<f64>)>,
    ranges: SpeedRanges,
}

impl Speeds {
    fn new(scene: &Scene, sense: f64, by: Option<&Key>) -> Self {
        let mut turned = scene.clone();
        turned.operation.speed_rad_s = sense * scene.operation.speed_rad_s.abs().max(1.0);
        let (limits, ranges) = speeds(&turned, by);
        Self { limits, ranges }
    }

    /// Converts the magnitudes to limits for a direction of rotation.
    fn limits(&self, scene: &Scene, sense: f64, range: Option<[f64; 2]>) -> Vec<SurveyLimit> {
        let present = scene.operation.speed_rad_s;
        let limit = |&(name, size, by): &(LimitName, f64, Option<f64>)| {
            let value = sense * size;
            let margin = (present * sense >= 0.0 && size > 0.0).then(|| present.abs() / size - 1.0);
            let in_range = range.map(|[from, to]| (from..=to).contains(&value));
            SurveyLimit { name, value, margin, in_range, by }
        };
        // The adhesive speed belongs to the paper's algorithm, not to the machine.
        let of_machine = |limit: &SurveyLimit| limit.name != LimitName::OmegaAdhesive;
        self.limits.iter().map(limit).filter(of_machine).collect()
    }
}
