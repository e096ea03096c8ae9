//! Plausibility checks: values that suggest a wrong unit or a misplaced decimal point. Each doubt
//! is one sentence with the key, its value and the usual range. Nothing is refused.

use std::f64::consts::TAU;

use rubscope_solver::model::Mode;
use rubscope_solver::scene::{Scene, keys};
use rubscope_solver::study::margins::Margins;

use rubscope_solver::numeric::rounding::rounded;

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

/// A structure, casing or disk, and the keys of its values.
struct Structure {
    name: &'static str,
    modes: &'static str,
    mass: &'static str,
    damping: &'static str,
    /// Where the amplitude of a mode shape is taken.
    amplitude: &'static str,
}

const STRUCTURES: [Structure; 2] = [
    Structure {
        name: "casing",
        modes: keys::CASING_MODES,
        mass: keys::CASING_MASS,
        damping: keys::CASING_DAMPING,
        amplitude: "the rim of the casing, radially",
    },
    Structure {
        name: "bladed disk",
        modes: keys::DISK_MODES,
        mass: keys::BLADE_INERTIA,
        damping: keys::BLADE_DAMPING,
        amplitude: "the blade tips, along the rim",
    },
];

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

/// Returns one sentence for each value that looks like a unit error: of the scene, and the push of
/// a tip in its lock.
#[must_use]
pub fn doubts(margins: &Margins) -> Vec<String> {
    let mut all = of_scene(&margins.scene);
    all.extend(margins.tip_push().filter(|push| *push > PUSH).map(|push| {
        format!(
            "In the lock a blade tip pushes with {:.1} kN; metal tips bear some {:.0} kN. Are \
             masses, frequencies and the clearance right?",
            1e-3 * push,
            1e-3 * PUSH
        )
    }));
    all
}

fn of_scene(scene: &Scene) -> Vec<String> {
    let radius = radius_doubt(scene);
    // If the radius is doubtful, it also explains the tip speed.
    let speed = if radius.is_none() { speed_doubt(scene) } else { None };
    let doubts =
        [radius, clearance_doubt(scene), speed, force_doubt(scene), diameters_doubt(scene)];
    let mut all: Vec<String> = doubts.into_iter().flatten().collect();
    all.extend(tips_doubt(scene));
    let (mut both, mut is_usual) = (Vec::new(), true);
    for (structure, own) in STRUCTURES.iter().zip([&scene.casing.modes, &scene.bladed_disk.modes]) {
        all.extend(modes_doubts(scene, structure, own));
        let modes = checked_modes(scene, structure, own);
        all.extend(
            scaled_doubt(structure, &modes).or_else(|| mass_doubt(scene, structure, &modes)),
        );
        all.extend(damping_doubt(structure, &modes));
        all.extend(stiffening_doubt(&modes));
        let hertz = frequency_doubt(structure, &modes);
        let course = course_doubts(structure, "frequency", "Hz", FALL, &modes, |mode| mode.hertz);
        is_usual &= hertz.is_none() && course.is_empty();
        all.extend(hertz.into_iter().chain(course));
        let mass = |mode: &CheckedMode| mode.mass;
        all.extend(course_doubts(structure, "modal mass", "kg", f64::INFINITY, &modes, mass));
        both.push(modes);
    }
    all.extend(if is_usual { apart_doubt(&both) } else { None });
    all
}

/// Returns the values of all modes of a structure, or, if it has no list of modes, of the mode
/// in use.
fn checked_modes(scene: &Scene, structure: &Structure, own: &[Mode]) -> Vec<CheckedMode> {
    let mut diameters: Vec<u32> = own.iter().map(|mode| mode.nodal_diameters).collect();
    if diameters.is_empty() {
        diameters.push(scene.operation.nodal_diameters);
    }
    let is_casing = structure.modes == keys::CASING_MODES;
    let look = |diameters| {
        let mut scene = scene.clone();
        scene.operation.nodal_diameters = diameters;
        if !own.is_empty() {
            scene.bladed_disk.nodal_diameters = 0;
        }
        let machine = scene.machine();
        let length = machine.blade_length;
        let (omega, mass, damping) = match is_casing {
            true => (machine.omega_c, machine.casing_mass, scene.casing_in_use().damping_ratio),
            false => {
                let mass = machine.blade_modal_mass / (length * length);
                (machine.omega_bd, mass, scene.disk_in_use().damping_ratio)
            }
        };
        let stiffening = if is_casing { 0.0 } else { scene.disk_in_use().centrifugal_stiffening };
        CheckedMode { diameters, hertz: omega / TAU, mass, damping, stiffening }
    };
    diameters.into_iter().map(look).collect()
}

fn radius_doubt(scene: &Scene) -> Option<String> {
    let radius = scene.casing.radius_m;
    let [least, most] = RADIUS;
    (!(least..=most).contains(&radius)).then(|| {
        format!(
            "{} = {radius} is in m, and casings have a radius of {least} to {most} m. Was it mm? Then write \"{radius} mm\".",
            keys::CASING_RADIUS
        )
    })
}

/// Checks tips, eccentricity and lobes against the size of usual imperfections.
fn tips_doubt(scene: &Scene) -> Option<String> {
    let most = CLEARANCE * scene.casing.radius_m;
    let (key, length) = scene.unevenness().into_iter().find(|(_, length)| *length > most)?;
    Some(format!(
        "{key} = {length} is in m, and more than {:.0} % of the radius. Was it mm or um? Then write its unit.",
        100.0 * CLEARANCE
    ))
}

fn force_doubt(scene: &Scene) -> Option<String> {
    let force = scene.operation.pulse_n;
    (force.abs() > FORCE).then(|| {
        format!(
            "{} = {force:e} is in N, and more than the weight of {:.0} t. Is its unit right?",
            keys::PULSE,
            FORCE / 1e4
        )
    })
}

fn clearance_doubt(scene: &Scene) -> Option<String> {
    let (gap, radius) = (scene.clearance(), scene.casing.radius_m);
    let given = format!(
        "The clearance ({} less {}) is {:.4} mm",
        keys::CASING_RADIUS,
        keys::BLADE_LENGTH,
        1e3 * gap
    );
    if gap > CLEARANCE * radius {
        let part = 100.0 * gap / radius;
        return Some(format!(
            "{given}, {part:.2} % of the radius; blade tips usually run within 1 %. Are both lengths in m, and to enough digits?"
        ));
    }
    (0.0..GAP).contains(&gap).then(|| {
        format!("{given}, less than a machined surface deviates from a circle. Are both lengths given to enough digits?")
    })
}

fn speed_doubt(scene: &Scene) -> Option<String> {
    let speed = scene.operation.speed_rad_s.abs();
    let tips = speed * scene.casing.radius_m;
    (tips > TIP_SPEED).then(|| {
        format!(
            "{} = {speed} ({:.0} rpm) moves the blade tips at {tips:.0} m/s; metal ones reach some 500. Was it rpm? Then write \"{speed} rpm\".",
            keys::SPEED, speed * 60.0 / TAU
        )
    })
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

fn diameters_doubt(scene: &Scene) -> Option<String> {
    let (diameters, blades) = (scene.operation.nodal_diameters, scene.bladed_disk.blades);
    (diameters > blades / 2).then(|| {
        format!("{} = {diameters} is more than half of the {blades} blades, which cannot distinguish it from {}.", keys::DIAMETERS, diameters.abs_diff(blades * ((diameters + blades / 2) / blades)))
    })
}

fn modes_doubts(scene: &Scene, structure: &Structure, own: &[Mode]) -> Vec<String> {
    let (blades, key) = (scene.bladed_disk.blades, structure.modes);
    let far = own.iter().filter(|mode| mode.nodal_diameters > blades / 2);
    far.map(|mode| {
        format!("{key} has a mode of {} nodal diameters, more than half of the {blades} blades; it is never in use.", mode.nodal_diameters)
    })
    .collect()
}

fn mass_doubt(scene: &Scene, structure: &Structure, modes: &[CheckedMode]) -> Option<String> {
    // If the radius is doubtful, it also explains the mass.
    radius_doubt(scene).is_none().then_some(())?;
    let [least, most] = DENSITY.map(|density| density * scene.casing.radius_m.powi(3));
    let (mode, at) = first(modes, |mode| !(least..=most).contains(&mode.mass))?;
    Some(format!(
        "The modal mass of the {}{at} is {} kg ({}); at this radius modes of metal have {least:.2} to {most:.0} kg. Was it in g or in t?",
        structure.name,
        rounded(mode.mass, 4),
        structure.mass
    ))
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

fn frequency_doubt(structure: &Structure, modes: &[CheckedMode]) -> Option<String> {
    let [least, most] = FREQUENCY;
    let (mode, at) = first(modes, |mode| !(least..=most).contains(&mode.hertz))?;
    Some(format!(
        "The frequency of the {}{at} is {} Hz; first modes usually have {least} to {most} Hz.",
        structure.name,
        rounded(mode.hertz, 4)
    ))
}

fn damping_doubt(structure: &Structure, modes: &[CheckedMode]) -> Option<String> {
    let (mode, at) = first(modes, |mode| mode.damping > DAMPING)?;
    let ratio = mode.damping;
    Some(format!(
        "{} = {ratio}{at} is a fraction of critical damping; structures have some thousandths to hundredths. Was it per cent? Then write \"{ratio} %\".",
        structure.damping
    ))
}

/// Asks about modal masses that are all the 1 to which FE programs scale mode shapes.
fn scaled_doubt(structure: &Structure, modes: &[CheckedMode]) -> Option<String> {
    let is_scaled = |mass: &&f64| modes.iter().all(|mode| (mode.mass / *mass - 1.0).abs() < 1e-9);
    let mass = SCALED_MASSES.iter().find(is_scaled)?;
    Some(format!(
        "Every modal mass of the {} is exactly {mass} kg, to which FE programs scale mode shapes. rubscope needs 1/phi^2, where phi is the amplitude of such a shape at {}.",
        structure.name, structure.amplitude
    ))
}

fn stiffening_doubt(modes: &[CheckedMode]) -> Option<String> {
    let [least, most] = STIFFENING;
    let is_odd = |b: f64| b != 0.0 && !(least..=most).contains(&b);
    let (mode, at) = first(modes, |mode| is_odd(mode.stiffening))?;
    Some(format!(
        "The centrifugal stiffening B of the bladed disk{at} is {}; first modes of blades have some 1 to 5. Are the speeds of its frequencies in the right unit, rpm, rad/s or Hz?",
        rounded(mode.stiffening, 3)
    ))
}

/// Finds modes whose frequency or mass is far from that of the others: both vary smoothly with the
/// nodal diameters, and none falls by more than `fall` with more of them.
fn course_doubts(
    structure: &Structure,
    what: &str,
    unit: &str,
    fall: f64,
    modes: &[CheckedMode],
    value: impl Fn(&CheckedMode) -> f64,
) -> Vec<String> {
    let far = |a: &CheckedMode, b: &CheckedMode| {
        let [a_n, b_n] = [a, b].map(|mode| f64::from(mode.diameters.max(1)));
        let (rise, ratio) = ((value(a) / value(b)).ln(), (a_n / b_n).ln());
        rise.abs() > COURSE[0].ln() + COURSE[1] * ratio.abs()
            || (rise * ratio < 0.0 && rise.abs() > fall.ln())
    };
    let mut doubts = Vec::new();
    let mut rest = modes.to_vec();
    loop {
        let against = |mode: &CheckedMode| rest.iter().filter(|other| far(mode, other)).count();
        let Some(place) = (0..rest.len()).max_by_key(|place| against(&rest[*place])) else {
            break;
        };
        if against(&rest[place]) == 0 {
            break;
        }
        let odd = rest.remove(place);
        let near = rest.iter().min_by_key(|other| other.diameters.abs_diff(odd.diameters));
        doubts.extend(near.map(|near| {
            format!(
                "The {what} of the {} is {} {unit} at {} nodal diameters and {} {unit} at {}. Is the decimal point right, and the unit?",
                structure.name,
                rounded(value(&odd), 4),
                odd.diameters,
                rounded(value(near), 4),
                near.diameters
            )
        }));
    }
    doubts
}

/// Asks about frequencies of the casing that are far from those of the disk with the nearest
/// diameters.
fn apart_doubt(both: &[Vec<CheckedMode>]) -> Option<String> {
    let [casing, disk] = both else { return None };
    let beside = |mode: &CheckedMode| {
        let apart = |other: &&CheckedMode| other.diameters.abs_diff(mode.diameters);
        disk.iter().min_by_key(apart).map_or(mode.hertz, |other| other.hertz)
    };
    let is_apart = |mode: &CheckedMode| (mode.hertz / beside(mode)).ln().abs() > APART.ln();
    let (mode, at) = first(casing, is_apart)?;
    Some(format!(
        "The frequency of the casing{at} is {} Hz, and that of the bladed disk {} Hz. Is the decimal point right, and the unit?",
        rounded(mode.hertz, 4),
        rounded(beside(&mode), 4)
    ))
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
