//! Plausibility checks: values that suggest a wrong unit or a misplaced decimal point. Each doubt
//! is one sentence with the key, its value and the usual range. Nothing is refused.

use std::f64::consts::TAU;

use rubscope_solver::model::Mode;
use rubscope_solver::numeric::rounding::rounded;
use rubscope_solver::scene::Scene;
use rubscope_solver::scene::keys::{
    BLADE_DAMPING, BLADE_INERTIA, BLADE_LENGTH, CASING_DAMPING, CASING_MASS, CASING_MODES,
    CASING_RADIUS, DIAMETERS, DISK_MODES, PULSE, SPEED,
};
use rubscope_solver::study::margins::Margins;

/// Largest plausible clearance, relative to the radius; blade tips run within some tenths of a per
/// cent. With a larger one, millimetres given as metres would not be noticed.
const CLEARANCE: f64 = 0.01;

/// Smallest plausible clearance \[m\]: surfaces are not rounder. With a larger one, laboratory machines
/// would be questioned.
const GAP: f64 = 1e-6;

/// Plausible frequencies of first modes, from and to \[Hz\].
const FREQUENCY: [f64; 2] = [1.0, 2e4];

/// Largest plausible damping ratio; metal structures have thousandths to hundredths. With a larger one,
/// per cent given as a fraction would not be noticed.
const DAMPING: f64 = 0.3;

/// Plausible radius of a casing, from and to \[m\]: from turbochargers to steam turbines.
const RADIUS: [f64; 2] = [0.02, 8.0];

/// Plausible modal mass of casing or disk divided by the cube of the radius, from and to \[kg/m^3\].
/// The paper's casing has 16, its disk 73, a solid steel disk about 6000, a sheet-metal ring 2. Grams
/// or tonnes given as kilograms are off by a factor of a thousand.
const DENSITY: [f64; 2] = [1.0, 6000.0];

/// Largest plausible speed of blade tips \[m/s\]; metal tips reach about 500. With a larger one, rpm
/// given as rad/s would not be noticed for small machines.
const TIP_SPEED: f64 = 800.0;

/// Factor and exponent `p` of the largest plausible ratio of the frequencies or modal masses of two
/// modes: factor times the ratio of their nodal diameters to the power `p`. Frequencies of rings rise
/// with the second to third power. With larger values, a misplaced decimal point would not be noticed.
const COURSE: [f64; 2] = [3.0, 3.0];

/// Largest plausible factor by which frequencies fall with more nodal diameters; those of shells fall
/// by less before they rise. With a larger one, a thousands separator that was read as a decimal point
/// would not be noticed.
const FALL: f64 = 30.0;

/// Largest plausible ratio of the frequencies of casing and disk, either way. With a much larger one,
/// an error by a factor of a thousand would not be noticed.
const APART: f64 = 100.0;

/// Plausible centrifugal stiffening `B` of first blade modes, from and to; 0 means none. Theory gives
/// about 1 to 5. In a wider range, speeds given in a wrong unit would not be noticed.
const STIFFENING: [f64; 2] = [0.1, 20.0];

/// Modal masses to which FE programs scale mode shapes: 1 kg, g or t \[kg\].
const SCALED_MASSES: [f64; 3] = [1.0, 1e-3, 1e3];

/// Largest plausible pulse \[N\].
const FORCE: f64 = 1e7;

/// Largest plausible contact force on one blade tip in the lock \[N\], about the strength of a few
/// square centimetres of metal. With a larger one, a stiffness or a clearance that is off by a factor
/// of ten would not be noticed.
const PUSH: f64 = 2e4;

/// Returns one sentence for each value that looks like a unit error: of the scene, and the push of
/// a tip in its lock.
#[must_use]
pub fn doubts(margins: &Margins) -> Vec<String> {
    let mut all = of_scene(&margins.scene);
    if let Some(push) = margins.tip_push().filter(|push| *push > PUSH) {
        all.push(format!(
            "In the lock a blade tip pushes with {:.1} kN; metal tips bear some {:.0} kN. Are \
             masses, frequencies and the clearance right?",
            1e-3 * push,
            1e-3 * PUSH
        ));
    }
    all
}

fn of_scene(scene: &Scene) -> Vec<String> {
    let mut all = of_values(scene);
    let casing = Structure {
        name: "casing",
        modes_key: CASING_MODES,
        mass_key: CASING_MASS,
        damping_key: CASING_DAMPING,
        amplitude: "the rim of the casing, radially",
        modes: checked_modes(scene, &scene.casing.modes, casing_mode),
    };
    let disk = Structure {
        name: "bladed disk",
        modes_key: DISK_MODES,
        mass_key: BLADE_INERTIA,
        damping_key: BLADE_DAMPING,
        amplitude: "the blade tips, along the rim",
        modes: checked_modes(scene, &scene.bladed_disk.modes, disk_mode),
    };
    let is_usual = [
        casing.tell(scene, &scene.casing.modes, &mut all),
        disk.tell(scene, &scene.bladed_disk.modes, &mut all),
    ];
    if is_usual == [true; 2] {
        all.extend(apart_doubt(&casing.modes, &disk.modes));
    }
    all
}

/// Checks the values of a scene other than its modes.
fn of_values(scene: &Scene) -> Vec<String> {
    let mut all = Vec::new();
    let radius = scene.casing.radius_m;
    if !is_usual_radius(scene) {
        let [least, most] = RADIUS;
        all.push(format!("{CASING_RADIUS} = {radius} is in m, and casings have a radius of {least} to {most} m. Was it mm? Then write \"{radius} mm\"."));
    }
    let gap = scene.clearance();
    let given =
        format!("The clearance ({CASING_RADIUS} less {BLADE_LENGTH}) is {:.4} mm", 1e3 * gap);
    if gap > CLEARANCE * radius {
        let part = 100.0 * gap / radius;
        all.push(format!("{given}, {part:.2} % of the radius; blade tips usually run within 1 %. Are both lengths in m, and to enough digits?"));
    } else if (0.0..GAP).contains(&gap) {
        all.push(format!("{given}, less than a machined surface deviates from a circle. Are both lengths given to enough digits?"));
    }
    let speed = scene.operation.speed_rad_s.abs();
    let (tips, rpm) = (speed * radius, speed * 60.0 / TAU);
    // If the radius is doubtful, it also explains the tip speed.
    if is_usual_radius(scene) && tips > TIP_SPEED {
        all.push(format!("{SPEED} = {speed} ({rpm:.0} rpm) moves the blade tips at {tips:.0} m/s; metal ones reach some 500. Was it rpm? Then write \"{speed} rpm\"."));
    }
    let force = scene.operation.pulse_n;
    if force.abs() > FORCE {
        all.push(format!(
            "{PULSE} = {force:e} is in N, and more than the weight of {:.0} t. Is its unit right?",
            FORCE / 1e4
        ));
    }
    let (diameters, blades) = (scene.operation.nodal_diameters, scene.bladed_disk.blades);
    if diameters > blades / 2 {
        let alias = diameters.abs_diff(blades * ((diameters + blades / 2) / blades));
        all.push(format!("{DIAMETERS} = {diameters} is more than half of the {blades} blades, which cannot distinguish it from {alias}."));
    }
    // Tips, eccentricity and lobes.
    let is_large = |(_, length): &(&str, f64)| *length > CLEARANCE * radius;
    if let Some((key, length)) = scene.unevenness().into_iter().find(is_large) {
        all.push(format!(
            "{key} = {length} is in m, and more than {:.0} % of the radius. Was it mm or um? Then write its unit.",
            100.0 * CLEARANCE
        ));
    }
    all
}

fn is_usual_radius(scene: &Scene) -> bool {
    (RADIUS[0]..=RADIUS[1]).contains(&scene.casing.radius_m)
}

/// Checked values of one mode.
#[derive(Clone, Copy)]
struct CheckedMode {
    diameters: u32,
    hertz: f64,
    /// Modal mass for unit amplitude at the casing rim or at the blade tips \[kg\].
    mass: f64,
    damping: f64,
    /// Centrifugal stiffening `B` of the disk; 0 for the casing.
    stiffening: f64,
}

/// Returns the values of all modes of a structure that has the list `own`, or, if this is empty, of
/// the mode in use.
fn checked_modes(
    scene: &Scene,
    own: &[Mode],
    in_use: fn(&Scene) -> CheckedMode,
) -> Vec<CheckedMode> {
    let mut scene = scene.clone();
    if own.is_empty() {
        return vec![in_use(&scene)];
    }
    scene.bladed_disk.nodal_diameters = 0;
    let look = |mode: &Mode| {
        scene.operation.nodal_diameters = mode.nodal_diameters;
        in_use(&scene)
    };
    own.iter().map(look).collect()
}

fn casing_mode(scene: &Scene) -> CheckedMode {
    let machine = scene.machine();
    CheckedMode {
        diameters: scene.operation.nodal_diameters,
        hertz: machine.omega_c / TAU,
        mass: machine.casing_mass,
        damping: scene.casing_in_use().damping_ratio,
        stiffening: 0.0,
    }
}

fn disk_mode(scene: &Scene) -> CheckedMode {
    let (machine, disk) = (scene.machine(), scene.disk_in_use());
    CheckedMode {
        diameters: scene.operation.nodal_diameters,
        hertz: machine.omega_bd / TAU,
        mass: machine.blade_modal_mass / (machine.blade_length * machine.blade_length),
        damping: disk.damping_ratio,
        stiffening: disk.centrifugal_stiffening,
    }
}

/// A structure, casing or disk: the keys of its values, and its modes.
struct Structure {
    name: &'static str,
    modes_key: &'static str,
    mass_key: &'static str,
    damping_key: &'static str,
    /// Where the amplitude of a mode shape is taken.
    amplitude: &'static str,
    modes: Vec<CheckedMode>,
}

impl Structure {
    /// Checks the modes. Returns whether their frequencies are plausible.
    fn tell(&self, scene: &Scene, own: &[Mode], all: &mut Vec<String>) -> bool {
        let Self { name, modes_key, mass_key, damping_key, amplitude, modes } = self;
        let blades = scene.bladed_disk.blades;
        for diameters in own.iter().map(|mode| mode.nodal_diameters).filter(|n| *n > blades / 2) {
            all.push(format!("{modes_key} has a mode of {diameters} nodal diameters, more than half of the {blades} blades; it is never in use."));
        }
        let is_scaled =
            |mass: &&f64| modes.iter().all(|mode| (mode.mass / *mass - 1.0).abs() < 1e-9);
        let [least, most] = DENSITY.map(|density| density * scene.casing.radius_m.powi(3));
        if let Some(mass) = SCALED_MASSES.iter().find(is_scaled) {
            all.push(format!("Every modal mass of the {name} is exactly {mass} kg, to which FE programs scale mode shapes. rubscope needs 1/phi^2, where phi is the amplitude of such a shape at {amplitude}."));
        } else if let Some((mode, at)) = first(modes, |mode| !(least..=most).contains(&mode.mass))
            // If the radius is doubtful, it also explains the mass.
            && is_usual_radius(scene)
        {
            let mass = rounded(mode.mass, 4);
            all.push(format!("The modal mass of the {name}{at} is {mass} kg ({mass_key}); at this radius modes of metal have {least:.2} to {most:.0} kg. Was it in g or in t?"));
        }
        if let Some((mode, at)) = first(modes, |mode| mode.damping > DAMPING) {
            let ratio = mode.damping;
            all.push(format!("{damping_key} = {ratio}{at} is a fraction of critical damping; structures have some thousandths to hundredths. Was it per cent? Then write \"{ratio} %\"."));
        }
        let [least, most] = STIFFENING;
        let is_odd = |b: f64| b != 0.0 && !(least..=most).contains(&b);
        if let Some((mode, at)) = first(modes, |mode| is_odd(mode.stiffening)) {
            let b = rounded(mode.stiffening, 3);
            all.push(format!("The centrifugal stiffening B of the {name}{at} is {b}; first modes of blades have some 1 to 5. Are the speeds of its frequencies in the right unit, rpm, rad/s or Hz?"));
        }
        let count = all.len();
        let [least, most] = FREQUENCY;
        if let Some((mode, at)) = first(modes, |mode| !(least..=most).contains(&mode.hertz)) {
            let hertz = rounded(mode.hertz, 4);
            all.push(format!("The frequency of the {name}{at} is {hertz} Hz; first modes usually have {least} to {most} Hz."));
        }
        self.tell_course("frequency", "Hz", FALL, |mode| mode.hertz, all);
        let is_usual = all.len() == count;
        self.tell_course("modal mass", "kg", f64::INFINITY, |mode| mode.mass, all);
        is_usual
    }

    /// Finds modes whose frequency or mass is far from that of the others: both vary smoothly with
    /// the nodal diameters, and none falls by more than `fall` with more of them.
    fn tell_course(
        &self,
        what: &str,
        unit: &str,
        fall: f64,
        value: fn(&CheckedMode) -> f64,
        all: &mut Vec<String>,
    ) {
        let far = |a: &CheckedMode, b: &CheckedMode| {
            let [a_n, b_n] = [a, b].map(|mode| f64::from(mode.diameters.max(1)));
            let (rise, ratio) = ((value(a) / value(b)).ln(), (a_n / b_n).ln());
            rise.abs() > COURSE[0].ln() + COURSE[1] * ratio.abs()
                || (rise * ratio < 0.0 && rise.abs() > fall.ln())
        };
        let mut rest = self.modes.clone();
        let oddest = |rest: &[CheckedMode]| {
            let against = |place: &usize| rest.iter().filter(|it| far(&rest[*place], it)).count();
            (0..rest.len()).filter(|place| against(place) > 0).max_by_key(against)
        };
        while let Some(place) = oddest(&rest) {
            let odd = rest.remove(place);
            let near = rest.iter().min_by_key(|other| other.diameters.abs_diff(odd.diameters));
            all.extend(near.map(|near| {
                let [odd_value, near_value] = [&odd, near].map(|mode| rounded(value(mode), 4));
                format!(
                    "The {what} of the {} is {odd_value} {unit} at {} nodal diameters and {near_value} {unit} at {}. Is the decimal point right, and the unit?",
                    self.name, odd.diameters, near.diameters
                )
            }));
        }
    }
}

/// Returns the first mode that meets the condition, and the words that name it and count the
/// others.
fn first(
    modes: &[CheckedMode],
    is_doubted: impl Fn(&CheckedMode) -> bool,
) -> Option<(CheckedMode, String)> {
    let doubted: Vec<&CheckedMode> = modes.iter().filter(|mode| is_doubted(mode)).collect();
    let mode = **doubted.first()?;
    let at = match (modes.len(), doubted.len()) {
        (1, _) => String::new(),
        (_, 1) => format!(" at {} nodal diameters", mode.diameters),
        (_, all) => format!(" at {} nodal diameters (and {} more)", mode.diameters, all - 1),
    };
    Some((mode, at))
}

/// Asks about frequencies of the casing that are far from those of the disk with the nearest
/// diameters.
fn apart_doubt(casing: &[CheckedMode], disk: &[CheckedMode]) -> Option<String> {
    let beside = |mode: &CheckedMode| {
        let apart = |other: &&CheckedMode| other.diameters.abs_diff(mode.diameters);
        disk.iter().min_by_key(apart).map_or(mode.hertz, |other| other.hertz)
    };
    let is_apart = |mode: &CheckedMode| (mode.hertz / beside(mode)).ln().abs() > APART.ln();
    let (mode, at) = first(casing, is_apart)?;
    let [casing, disk] = [mode.hertz, beside(&mode)].map(|hertz| rounded(hertz, 4));
    Some(format!(
        "The frequency of the casing{at} is {casing} Hz, and that of the bladed disk {disk} Hz. Is the decimal point right, and the unit?"
    ))
}

/// Asks whether a range of speeds that was given without a unit \[rad/s\] was meant in rpm: blade
/// tips do not move so fast, or it contains the speed of the scene only in rpm.
#[must_use]
pub fn range_doubt(scene: &Scene, range: [f64; 2]) -> Option<String> {
    let [from, to] = range;
    let speed = scene.operation.speed_rad_s;
    let tips = from.abs().max(to.abs()) * scene.casing.radius_m;
    let contains = |unit: f64| (from.min(to) * unit..=from.max(to) * unit).contains(&speed);
    let why = if tips > TIP_SPEED {
        format!("moves the blade tips at {tips:.0} m/s; metal ones reach some 500")
    } else if !contains(1.0) && contains(TAU / 60.0) {
        format!("does not contain the speed of the scene, {:.0} rpm", speed * 60.0 / TAU)
    } else {
        return None;
    };
    let (typed, in_rpm) = match from == to {
        true => (from.to_string(), format!("{from}rpm")),
        false => (format!("{from}:{to}"), format!("{from}rpm:{to}rpm")),
    };
    Some(format!("{typed} is in rad/s and {why}. Was it rpm? Then write {in_rpm}."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::scene::BUILTIN;

    #[test]
    fn usual_machines_are_not_asked_about() {
        for builtin in BUILTIN {
            let doubts = of_scene(&Scene::builtin(builtin.name).unwrap());
            assert_eq!(doubts, [""; 0], "{}", builtin.name);
        }
    }
}
