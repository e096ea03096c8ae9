//! Figs. 9 and 10: the locked motion by harmonic balance, against speed.

use super::{Figure, Mark, Panel, Quantity, Series, Style, speed_marks};
use crate::harmonic::{Form, HarmonicError, LockedPoint, Sweep, locked_motion};
use crate::model::Machine;
use crate::scene::Scene;

/// Speeds of a curve, from standstill to the speed of the scene.
const SPEEDS: u32 = 501;

const LAMBDA: Quantity = Quantity::new("multiplier_n", "multiplier [N], negative pushes", 1.0);
const AMPLITUDE: Quantity = Quantity::new("amplitude_m", "harmonic amplitude [um]", 1e6);
const ALPHA: Quantity = Quantity::new("alpha_rad", "blade angle [nrad]", 1e9);

fn sweep(scene: &Scene, form: Form, damped: bool) -> Result<Sweep, HarmonicError> {
    let top = scene.operation.speed_rad_s;
    let speeds: Vec<f64> =
        (0..SPEEDS).map(|n| top * f64::from(n) / f64::from(SPEEDS - 1)).collect();
    locked_motion(&scene.machine(), form, damped, None, &speeds)
}

fn series(label: &str, style: Style, sweep: &Sweep, of: fn(&LockedPoint) -> f64) -> Series {
    Series::new(label, style, sweep.points.iter().map(|point| (point.speed_rad_s, of(point))))
}

fn note(machine: &Machine, sweep: &Sweep) -> String {
    let [a, b] = sweep.corner.sides().map(|side| {
        let blades = machine.polygon.blades_of_side(side);
        blades.iter().map(|blade| format!("#{blade}")).collect::<Vec<_>>().join(" ")
    });
    format!("n_d = {}, locked between {a} and {b}", machine.nodal_diameters)
}

/// Fig. 9: the multipliers, as the paper has them and with damping.
pub fn multipliers(scene: &Scene) -> Result<Figure, HarmonicError> {
    let machine = scene.machine();
    let undamped = sweep(scene, Form::Printed, false)?;
    let damped = sweep(scene, Form::Modal, true)?;
    let lines = vec![
        series("lambda_1", Style::Line(0), &undamped, |point| point.multipliers_n[0]),
        series("lambda_2", Style::Dashed(1), &undamped, |point| point.multipliers_n[1]),
        series("lambda_1, damped", Style::Line(2), &damped, |point| point.multipliers_n[0]),
        series("lambda_2, damped", Style::Dashed(3), &damped, |point| point.multipliers_n[1]),
    ];
    let marks = speed_marks(&machine);
    let panel = Panel { marks, ..Panel::new("", Quantity::SPEED, LAMBDA, lines) };
    Ok(Figure {
        title: "Contact multipliers of the locked motion against rotor speed".into(),
        note: note(&machine, &undamped),
        panels: vec![panel],
    })
}

/// Fig. 10: the amplitudes of casing and blades, undamped as in the paper.
pub fn amplitudes(scene: &Scene) -> Result<Figure, HarmonicError> {
    let machine = scene.machine();
    let printed = sweep(scene, Form::Printed, false)?;
    let casing = vec![
        series("u_cc", Style::Line(0), &printed, |point| point.u_cc_m),
        series("u_ss", Style::Dashed(1), &printed, |point| point.u_ss_m),
        series("u_sc", Style::Line(2), &printed, |point| point.u_sc_m),
        series("u_cs", Style::Dashed(3), &printed, |point| point.u_cs_m),
    ];
    let mut blades = Vec::new();
    for (index, form) in Form::ALL.into_iter().enumerate() {
        let sweep = sweep(scene, form, false)?;
        blades.push(series(form.as_ref(), Style::Line(index), &sweep, |point| point.alpha_rad[0]));
    }
    let mut angles =
        Panel::new("(b) angle of the first blade, in three forms", Quantity::SPEED, ALPHA, blades);
    angles.marks.extend(machine.critical_speed().map(|x| Mark { x, label: "Omega_c" }));
    Ok(Figure {
        title: "Amplitudes of the locked motion against rotor speed".into(),
        note: note(&machine, &printed),
        panels: vec![Panel::new("(a) casing", Quantity::SPEED, AMPLITUDE, casing), angles],
    })
}
