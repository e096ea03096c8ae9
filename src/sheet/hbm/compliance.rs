//! The view `--compliance`: the joint compliance `B(omega)` of casing and blades, and the whirl
//! frequencies, where it crosses the negative real axis.

use nalgebra::Complex;

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::speed;
use crate::sheet::table::{Column, Table, TableCell};
use crate::sheet::ticks::linspace;
use rubscope_solver::harmonic::{RoundWhirl, RoundWhirlLoads, round_whirls};
use rubscope_solver::model::Frame;
use rubscope_solver::scene::{SceneError, keys};

pub const COMPLIANCE: View = View {
    one_speed: true,
    // The compliance belongs to the structures, with or without a preload.
    rigid: Some(|error| error.is_of(keys::CLEARANCE)),
    out_of_round: true,
    ..View::new(
        "compliance",
        "View: the joint compliance B(omega), in JSON and CSV; a whirl is possible where it \
         crosses the negative real axis",
        fill,
    )
};

/// Number of frequencies in the table, evenly spaced and odd so that 0 is one of them. Negative ones
/// belong to waves that travel backward.
const FREQUENCIES: usize = 201;
/// The table extends to this multiple of the highest resonance, in both directions of travel.
const BEYOND: f64 = 1.5;

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let machine = &request.machine;
    let turning = request.fastest();
    let frame = Frame::at(machine, turning);
    let nu = frame.casing.turn;
    let waves = round_whirls(machine, turning).into_iter();
    let waves: Vec<Wave> = waves.map(|wave| (wave, wave.loads(machine, turning))).collect();
    let at = |omega: f64| (omega, omega - nu, frame.turning(omega - nu).compliance());
    let machine = &*machine.at(turning);
    let reach = BEYOND * machine.omega_c.max(nu.abs() + machine.omega_bd);
    let points: Vec<Point> = linspace(-reach, reach, FREQUENCIES).into_iter().map(at).collect();
    let shown = format!("at {}", speed(request.fastest()));
    let crossings = if waves.is_empty() {
        format!("B(omega) does not cross the negative real axis {shown}: nothing whirls.")
    } else {
        format!("Where B(omega) crosses the negative real axis {shown}:")
    };
    // On a preloaded lining, stability depends on the amplitude, which this view does not know.
    let columns = if machine.clearance() <= 0.0 { PRESSED } else { WAVES };
    sheet.fact("speed_rad_s", turning);
    sheet.table("waves", crossings, Table::of(waves, columns).shown(7));
    sheet.filed(Some("points"), Table::of(points, POINTS));
    sheet.chart(
        "compliance B [m/N]",
        &[["re_m_per_n", "real part"], ["im_m_per_n", "imaginary part"]],
    );
    Ok(())
}

/// A whirl and its loads.
type Wave = (RoundWhirl, RoundWhirlLoads);

/// Frequency of the wave in the fixed frame and in the frame of the blades \[rad/s\], and the joint
/// compliance there \[m/N\].
type Point = (f64, f64, Complex<f64>);

/// Columns of the whirls at a clearance.
const WAVES: &[Column<'_, Wave>] =
    &waves(|wave| if wave.0.attracts { "attracts" } else { "threshold" }.into());

/// Columns of the whirls on a preloaded lining.
const PRESSED: &[Column<'_, Wave>] = &waves(|_| "see --smooth".into());

/// Returns the columns of the whirls. `state` says whether a whirl attracts.
const fn waves(state: fn(&Wave) -> TableCell) -> [Column<'static, Wave>; 11] {
    [
        ("omega_rad_s", |wave| wave.0.omega_rad_s.into()),
        ("s_rad_s", |wave| wave.0.s_rad_s.into()),
        ("state", state),
        ("stiffness_n_per_m", |wave| wave.0.stiffness_n_per_m.into()),
        ("push_n", |wave| loaded(wave.1.push_n)),
        ("casing_m", |wave| loaded(wave.1.casing_m)),
        ("blade_rad", |wave| loaded(wave.1.blade_rad)),
        ("growth_per_s", |wave| {
            Some(wave.0.growth_per_s).filter(|_| wave.1.casing_m >= 0.0).into()
        }),
        ("casing_w", |wave| loaded(wave.1.casing_w)),
        ("blades_w", |wave| loaded(wave.1.blades_w)),
        ("friction_w", |wave| loaded(wave.1.friction_w)),
    ]
}

/// Returns the cell of a load; a negative value stands for a load that does not exist.
fn loaded(load: f64) -> TableCell {
    Some(load).filter(|load| *load >= 0.0).into()
}

const POINTS: &[Column<'_, Point>] = &[
    ("omega_rad_s", |point| point.0.into()),
    ("s_rad_s", |point| point.1.into()),
    ("re_m_per_n", |point| point.2.re.into()),
    ("im_m_per_n", |point| point.2.im.into()),
];
