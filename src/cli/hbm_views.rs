//! What each view of `rubscope hbm` computes and shows; those of a lining are in
//! `hbm_lining`.

use std::rc::Rc;

use super::hbm_lining::{self, LiningView};
use super::range::linspace;
use super::status::Refusal;
use crate::report::hbm::{self as report, CompliancePoint, HbmReport, WhirlRow};
use crate::report::number::{self, short};
use crate::report::table::{MadeTable, Table};
use rubscope_solver::harmonic::{
    Branches, Campbell, Corner, ExcitedLocks, Form, HarmonicError, Joint, SlipPoint, SlipRegion,
    Sweep, drives, flutter_speed, locked_motion, round_whirls, slip_limits, slip_over,
    undamped_flutter_speed, whirl_onset,
};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{Scene, keys};

/// Engine-order lines drawn in addition to those of the scene.
const ORDERS: [u32; 4] = [1, 2, 3, 4];

/// What is looked at.
pub(super) enum HbmView {
    /// The locked motion.
    Locked,
    /// Every equilibrium.
    Branches,
    /// Slip, and the speeds where it exists over these damping ratios.
    Slip(Vec<f64>),
    /// Campbell data.
    Campbell,
    /// The response to the scene's engine order.
    Excitation,
    /// Blades on a lining, and what the coincidences do.
    Lining(LiningView),
    /// Whirl of inclined tips.
    Whirl,
    /// The joint compliance, at these casing frequencies.
    Compliance(Option<Vec<f64>>),
}

impl HbmView {
    /// Whether its numbers have the damping of the scene whatever is asked for.
    pub fn is_always_damped(&self) -> bool {
        !matches!(self, Self::Locked | Self::Branches | Self::Campbell)
    }
}

/// The input of a view.
pub(super) struct Asked<'a> {
    pub scene: &'a Scene,
    pub speeds: &'a [f64],
    pub form: Form,
    pub damped: bool,
    pub pair: Option<[u32; 2]>,
}

impl Asked<'_> {
    /// The machine of a view: with rigid contact, but for those of a lining.
    pub fn machine(&self, view: &HbmView) -> Machine {
        let machine = self.scene.machine();
        if matches!(view, HbmView::Lining(_)) { machine } else { machine.with_lining(None) }
    }

    /// The speed furthest from standstill, whose sense of rotation counts.
    pub fn fastest(&self) -> f64 {
        let further = |a: &f64, b: &f64| a.abs().total_cmp(&b.abs());
        self.speeds.iter().copied().max_by(further).unwrap_or(self.scene.operation.speed_rad_s)
    }
}

/// The result of a view: JSON, tables with their titles, the table for files.
pub(super) struct Answer {
    pub json: HbmReport,
    pub tables: Vec<(String, MadeTable)>,
    pub file: MadeTable,
    /// The locked motion, where it is the subject.
    pub sweep: Option<Rc<Sweep>>,
}

impl Answer {
    /// An answer whose last table is the one for files.
    pub fn of<T: Into<MadeTable>>(json: HbmReport, tables: Vec<(String, T)>) -> Self {
        let tables: Vec<_> =
            tables.into_iter().map(|(title, table)| (title, table.into())).collect();
        let last = tables.last().map(|(_, table): &(_, MadeTable)| table.clone());
        let file = last.unwrap_or_else(|| Table::default().into());
        Self { json, tables, file, sweep: None }
    }
}

/// Computes a view.
///
/// # Errors
/// What has no meaning, refused by name.
pub(super) fn answer(asked: &Asked, view: &HbmView) -> Result<Answer, Refusal> {
    let Asked { scene, speeds, form, damped, pair } = *asked;
    match view {
        HbmView::Lining(view) => return hbm_lining::answer(asked, view),
        HbmView::Campbell | HbmView::Compliance(_) => {}
        _ => hbm_lining::clear(scene)?,
    }
    let machine = asked.machine(view);
    let sweep = locked_motion(&machine, form, damped, pair, speeds).map(Rc::new);
    let json = HbmReport::new(scene, &machine, form, damped, asked.fastest());
    let json = match (&sweep, view) {
        (Ok(sweep), _) => json.with_sweep(&machine.polygon, sweep),
        // These have a meaning without corners too.
        (Err(HarmonicError::NoCorner { .. }), HbmView::Branches | HbmView::Campbell) => json,
        // These ask no rigid contact and no balance of one harmonic.
        (Err(HarmonicError::Refused { .. }), HbmView::Campbell) => json,
        (Err(HarmonicError::Refused { key: "clearance", .. }), HbmView::Compliance(_)) => json,
        (Err(error), _) => return Err(refused(error.clone())),
    };
    let answer = match (view, sweep) {
        (HbmView::Branches, _) => all_branches(json, &machine, speeds, damped),
        (HbmView::Campbell, _) => campbell(json, asked, &machine),
        (HbmView::Slip(zetas), _) => slipping(json, scene, speeds, zetas),
        (HbmView::Whirl, _) => Ok(whirling(json, &machine, speeds, asked.fastest())),
        (HbmView::Compliance(omegas), _) => {
            compliance(json, &machine, asked.fastest(), omegas.as_deref())
        }
        (HbmView::Excitation, _) => excited(json, scene, corner(asked, &machine)?.a, speeds),
        (HbmView::Locked | HbmView::Lining(_), Err(error)) => Err(error),
        (HbmView::Locked | HbmView::Lining(_), Ok(sweep)) => Ok(locked(json, sweep)),
    };
    answer.map_err(refused)
}

fn locked(json: HbmReport, sweep: Rc<Sweep>) -> Answer {
    let [shown, file] = report::locked_tables(&sweep);
    let tables = vec![(String::new(), shown)];
    Answer { json, tables, file, sweep: Some(sweep) }
}

fn corner(asked: &Asked, machine: &Machine) -> Result<Corner, Refusal> {
    let corner = match asked.pair {
        Some(pair) => Corner::of_blades(&machine.polygon, pair),
        None => Corner::paper(&machine.polygon),
    };
    corner.map_err(refused)
}

/// An input that has no meaning is refused input, not a failure.
fn refused(error: HarmonicError) -> Refusal {
    let message = error.to_string();
    // The option as typed, where the library names the argument.
    Refusal::because(match error {
        HarmonicError::Blades { .. } => format!("--{message}"),
        _ => message,
    })
}

fn all_branches(
    json: HbmReport,
    machine: &Machine,
    speeds: &[f64],
    damped: bool,
) -> Result<Answer, HarmonicError> {
    let branches = Rc::new(Branches::over(machine, speeds, damped)?);
    let damping = if damped { "with damping" } else { "without damping" };
    let changes = format!("Where branches change between these speeds, {damping}:");
    let tables = vec![
        (changes, report::threshold_table(&branches).into()),
        ("Equilibria of the blade frame:".to_string(), report::branch_table(&branches)),
    ];
    Ok(Answer::of::<MadeTable>(json.with_branches(&branches), tables))
}

fn campbell(json: HbmReport, asked: &Asked, machine: &Machine) -> Result<Answer, HarmonicError> {
    let Asked { scene, speeds, .. } = *asked;
    let mut orders = ORDERS.to_vec();
    if scene.excitation.amplitude_nm > 0.0 && !orders.contains(&scene.excitation.order) {
        orders.push(scene.excitation.order);
    }
    let campbell = Campbell::of(machine, &orders, asked.fastest())?;
    let coincidences = "Coincidences +-omega_c = n_d Omega +- omega_bd, Eq. (30):".to_string();
    let lines = "Frequencies in the standing frame [rad/s]:".to_string();
    let speeds = Rc::new(speeds.to_vec());
    let tables = vec![
        (coincidences, report::coincidence_table(&campbell).into()),
        (lines, report::campbell_table(&campbell, &speeds)),
    ];
    let json = json.with_parts("campbell", report::campbell(&campbell, &speeds));
    Ok(Answer::of::<MadeTable>(json, tables))
}

fn slipping(
    json: HbmReport,
    scene: &Scene,
    speeds: &[f64],
    zetas: &[f64],
) -> Result<Answer, HarmonicError> {
    let machine = scene.machine();
    let points = Rc::new(slip_over(&machine, speeds)?);
    let limits = slip_limits(&machine, speeds)?;
    let told: Vec<String> = limits
        .iter()
        .map(|limit| {
            let change = if limit.appears { "appears" } else { "vanishes" };
            format!("{change} at {}", number::speed(limit.speed_rad_s))
        })
        .collect();
    let found = points.iter().filter(|point| point.exists()).count();
    let title = match (told.is_empty(), found) {
        (false, _) => format!("Slip {}.", told.join(", ")),
        (true, 0) => "There is no slip at any of these speeds.".to_string(),
        (true, all) if all == points.len() => "Slip exists at all of these speeds.".to_string(),
        (true, _) => "Slip exists at some of these speeds.".to_string(),
    };
    let limit_speeds: Vec<f64> = limits.iter().map(|limit| limit.speed_rad_s).collect();
    let mut json =
        json.with_rows("slip", &points, report::slip).with("slip_limits_rad_s", limit_speeds);
    let mut tables = vec![(title, report::slip_table(&points))];
    if !zetas.is_empty() {
        let mut region = Vec::with_capacity(zetas.len());
        for &zeta in zetas {
            let mut damped = scene.clone();
            damped.set(keys::CASING_DAMPING, &zeta.to_string()).map_err(|_| {
                let allowed = "damping ratios from 0 to 10".to_string();
                HarmonicError::Refused { key: "--zetas", value: zeta.to_string(), allowed }
            })?;
            let machine = damped.machine();
            let lowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
            region.push(SlipRegion {
                casing_damping_ratio: zeta,
                exists_at_lowest: slip_over(&machine, &[lowest])?.iter().any(SlipPoint::exists),
                limits: slip_limits(&machine, speeds)?,
            });
        }
        json = json.with("slip_region", &region);
        let title = "Where slip exists between these speeds:".to_string();
        tables.push((title, report::region_table(&region).into()));
    }
    Ok(Answer::of(json, tables))
}

fn excited(
    json: HbmReport,
    scene: &Scene,
    side: u32,
    speeds: &[f64],
) -> Result<Answer, HarmonicError> {
    let (machine, excitation) = (scene.machine(), &scene.excitation);
    if excitation.amplitude_nm <= 0.0 {
        let allowed = "above 0 with --excitation, such as --set excitation.amplitude_nm=10";
        return Err(HarmonicError::Refused {
            key: keys::EXCITATION,
            value: excitation.amplitude_nm.to_string(),
            allowed: allowed.to_string(),
        });
    }
    let reaches = drives(&machine, excitation.order);
    let found = Rc::new(ExcitedLocks::over(&machine, side, excitation, speeds)?);
    let title = format!(
        "Engine order {} with {} N m on each blade{}",
        excitation.order,
        short(excitation.amplitude_nm),
        if reaches {
            ": amplitudes about the damped lock."
        } else {
            " does not drive the modes of these diameters: E is not +-n_d modulo N."
        }
    );
    let json = json.with_parts("excitation", report::excitation(excitation, reaches, &found));
    Ok(Answer::of(json, vec![(title, report::excitation_table(&found))]))
}

/// Frequencies of the table of the compliance.
const FREQUENCIES: usize = 201;
/// How far beyond the fastest resonance they go.
const BEYOND: f64 = 1.5;

/// Whirl against speed, and where it begins and ends.
pub(super) fn whirling(json: HbmReport, machine: &Machine, speeds: &[f64], fastest: f64) -> Answer {
    let rows = Rc::new(speeds.iter().map(|&speed| WhirlRow::at(machine, speed)).collect());
    let onset = whirl_onset(machine, fastest);
    let [flutter, undamped] =
        [flutter_speed(machine, fastest), undamped_flutter_speed(machine, fastest)];
    let window = machine.lock_window(fastest);
    let told = number::speed;
    let mut title = match onset {
        Some(onset) => format!("On a rim of many blades whirl begins at {}", told(onset)),
        None => "Nothing whirls on a rim of many blades".to_string(),
    };
    title += &match window {
        Some(window) => {
            format!("; a lock holds from {} {}", report::speeds_of(window), number::speed_unit())
        }
        None => "; no lock holds at any speed".to_string(),
    };
    title += &match flutter {
        Some(limit) => format!("; blades and casing as one flutter above {}.", told(limit)),
        None => ".".to_string(),
    };
    let json = json
        .with("whirl_onset_rad_s", onset)
        .with("flutter_speed_rad_s", flutter)
        .with("flutter_undamped_rad_s", undamped)
        .with("lock_window_rad_s", window.map(|window| [Some(window.from), window.to]))
        .with_rows("whirl", &rows, report::whirl);
    Answer::of(json, vec![(title, report::whirl_table(&rows))])
}

/// The joint compliance at one speed, over frequencies of the casing \[rad/s\].
pub(super) fn compliance(
    json: HbmReport,
    machine: &Machine,
    speed: f64,
    omegas: Option<&[f64]>,
) -> Result<Answer, HarmonicError> {
    let joint = Joint::at(machine, speed);
    let resonances = [machine.omega_c, joint.nu.abs() + machine.omega_bd];
    let reach = BEYOND * resonances[0].max(resonances[1]);
    let range = omegas.map_or_else(|| linspace(-reach, reach, FREQUENCIES), <[f64]>::to_vec);
    let waves = round_whirls(&joint);
    let chart = report::compliance_chart(&joint, &waves);
    let at = format!("at {}", number::speed(speed));
    let title = format!("B(omega) {at}, real part to the right, imaginary part up [m/N]:");
    let crossings = if waves.is_empty() {
        format!("B(omega) does not cross the negative real axis {at}: nothing whirls.")
    } else {
        format!("Where B(omega) crosses the negative real axis {at}:")
    };
    let points = Rc::new(range.iter().map(|&omega| CompliancePoint::at(&joint, omega)).collect());
    let file = report::compliance_table(&points);
    let json = json.with_parts("compliance", report::compliance(&joint, &points, &waves));
    let tables = vec![(title, chart), (crossings, report::wave_table(&joint, &waves))];
    Ok(Answer { file, ..Answer::of(json, tables) })
}
