//! Figs. 9 and 10: the locked motion by harmonic balance as a function of speed.

use super::{Figure, Mark, Panel, Quantity, Series, Style, group_name, speed_marks};
use crate::harmonic::{Form, LockedPoint, Sweep, locked_motion};
use crate::model::Machine;
use crate::scene::{Scene, SceneError};

/// Number of speeds of a curve, from standstill to the speed of the scene.
const SPEEDS: u32 = 501;

const LAMBDA: Quantity =
    Quantity::new("multiplier_n", "contact multiplier λ [N], negative pushes", 1.0);
const AMPLITUDE: Quantity =
    Quantity::new("amplitude_m", "harmonic amplitude of the casing [µm]", 1e6);
const MICRO: Quantity = Quantity::new("alpha_rad", "blade angle [µrad]", 1e6);
const NANO: Quantity = Quantity::new("alpha_rad", "blade angle [nrad]", 1e9);

fn sweep(scene: &Scene, form: Form, damped: bool) -> Result<Sweep, SceneError> {
    let top = scene.operation.speed_rad_s;
    let speeds: Vec<f64> =
        (0..SPEEDS).map(|n| top * f64::from(n) / f64::from(SPEEDS - 1)).collect();
    locked_motion(&scene.machine(), form, damped, None, &speeds)
}

fn series(label: &str, style: Style, sweep: &Sweep, of: impl Fn(&LockedPoint) -> f64) -> Series {
    Series::new(label, style, sweep.points.iter().map(|point| (point.speed_rad_s, of(point))))
}

/// Returns the names of the two groups that hold the wave, such as "#6" and "#21".
fn names(machine: &Machine, sweep: &Sweep) -> [String; 2] {
    sweep.corner.sides().map(|side| group_name(&machine.polygon.blades_of_side(side)))
}

/// Converts the name of a group for use in a column name: "6", "3_14".
fn plain(group: &str) -> String {
    group.replace('#', "").replace('+', "_")
}

/// Draws Fig. 9: the multipliers, undamped as in the paper, and damped.
pub fn multipliers(scene: &Scene) -> Result<Figure, SceneError> {
    let machine = scene.machine();
    let undamped = sweep(scene, Form::Printed, false)?;
    let damped = sweep(scene, Form::Modal, true)?;
    let names = names(&machine, &undamped);
    let [a, b] = &names;
    let line = |sweep: &Sweep, group: usize, style: Style, words: &str| {
        let of = |point: &LockedPoint| point.multipliers_n[group];
        let label = format!("λ of {}, {words}", names[group]);
        series(&label, style, sweep, of).named(format!("lambda_{}_{words}", plain(&names[group])))
    };
    let lines = vec![
        line(&undamped, 0, Style::Line(0), "undamped"),
        line(&undamped, 1, Style::Dashed(1), "undamped"),
        line(&damped, 0, Style::Dotted(2), "damped"),
        line(&damped, 1, Style::Dashed(3), "damped"),
    ];
    let marks = speed_marks(&machine, scene.operation.speed_rad_s);
    let panel = Panel { marks, ..Panel::new("", Quantity::SPEED, LAMBDA, lines) };
    let note = format!(
        "n_d = {}, locked between {a} and {b}. Undamped: the paper's equations as printed (27); \
         damped: the form of the time-domain model, with ζ_c = {}.",
        machine.nodal_diameters, machine.casing_damping_ratio
    );
    let title = "Contact multipliers of the locked motion against rotor speed";
    let mut figure = Figure::new(title, note, vec![panel]);
    figure.caption = [
        "Agrees with the paper: without damping both multipliers are equal and change their \
             sign at Ω_c. Here a negative multiplier is a push of the blade on the casing; below \
             Ω_c they pull, and the solution is no contact. At 500 rad/s each is −150.9 N.",
        "Differs: with the damping of the paper's own Table 1 the two are not equal \
             (−244.4 N on #6 and −57.3 N on #21 at 500 rad/s), and one of them pulls up to \
             Ω_lock = 411.9 rad/s. The paper drops the damping here.",
        "Cannot be compared: the sign and the scale of its axis.",
    ]
    .map(String::from)
    .to_vec();

    Ok(figure)
}

/// Draws Fig. 10: the amplitudes of casing and blades, undamped as in the paper.
pub fn amplitudes(scene: &Scene) -> Result<Figure, SceneError> {
    let machine = scene.machine();
    let [printed, blade, modal] = [
        sweep(scene, Form::Printed, false)?,
        sweep(scene, Form::Blade, false)?,
        sweep(scene, Form::Modal, false)?,
    ];
    let casing = vec![
        series("u_cc", Style::Line(0), &printed, |point| point.u_cc_m),
        series("u_ss", Style::Dashed(1), &printed, |point| point.u_ss_m),
        series("u_sc", Style::Dotted(2), &printed, |point| point.u_sc_m),
        series("u_cs", Style::Dashed(3), &printed, |point| point.u_cs_m),
    ];
    let [a, b] = names(&machine, &printed);
    let angles = |form: Form, sweep: &Sweep, colour: usize| {
        let line = |group: usize, label: &str, style| {
            let of = |point: &LockedPoint| point.alpha_rad[group];
            let line = series(&format!("α of {label}, {form}"), style, sweep, of);
            line.named(format!("alpha_{}_{form}", plain(label)))
        };
        [line(0, &a, Style::Line(colour)), line(1, &b, Style::Dashed(colour))]
    };
    let critical: Vec<Mark> =
        speed_marks(&machine, scene.operation.speed_rad_s).into_iter().take(1).collect();
    let panel = |title: &str, y: Quantity, lines: Vec<Series>| Panel {
        marks: critical.clone(),
        ..Panel::new(title, Quantity::SPEED, y, lines)
    };
    let of_one = [angles(Form::Printed, &printed, 0), angles(Form::Blade, &blade, 1)].concat();
    let panels = vec![
        Panel::new("(a) casing", Quantity::SPEED, AMPLITUDE, casing),
        panel(
            "(b) blades in contact, one blade by itself: as printed (27) and from (19)",
            MICRO,
            of_one,
        ),
        panel(
            "(c) blades in contact, in the two modes of the bladed disk",
            NANO,
            angles(Form::Modal, &modal, 2).to_vec(),
        ),
    ];
    let note =
        format!("n_d = {}, locked between {a} and {b}, no damping.", machine.nodal_diameters);
    let mut figure =
        Figure::new("Amplitudes of the locked motion against rotor speed", note, panels);
    figure.caption = [
            "Agrees with the paper: the amplitudes of the casing do not depend on the speed and \
             belong to one forward wave (u_cc = u_ss = 28.46 µm, u_sc = −u_cs = 96.94 µm); the \
             angles of the blades go through zero at Ω_c.",
            "Differs: the paper's equation (27) should follow from its equation (19), and \
             contradicts it in the first two rows: at 500 rad/s #6 is turned by +0.762 µrad in (27) and \
             by −0.381 µrad in (19). With the two modes of the time-domain model it is \
             −1.404 nrad (c), and only this form agrees with the time-domain solvers.",
            "Cannot be compared: the scales of the paper's picture.",
        ]
        .map(String::from)
        .to_vec();

    Ok(figure)
}
