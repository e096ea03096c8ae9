//! Margins: sensitivities against closed forms and against a whole search, and targets.

use rubscope_solver::scene::{CheckedScene, ContactLaw, ModelSize, Scene};
use rubscope_solver::study::margins::{
    CLEARANCE, Limit, LimitName, Margins, changed, grazing_pulse, parameter,
};
const MASS: &str = "casing.modal_mass_kg";
const STIFFNESS: &str = "casing.modal_stiffness_n_per_m";
const DAMPING: &str = "casing.damping_ratio";
const SPEED: &str = "operation.speed_rad_s";

/// A scene of another machine than the paper's, at rest.
fn random_scene(random: &mut fastrand::Rng) -> CheckedScene {
    let mut between = |low, high| crate::random::within(random, low..high);
    let mut scene = Scene::base();
    let disk = &mut scene.bladed_disk;
    disk.blades = between(5.0, 45.0) as u32;
    disk.inertia_kg_m2 *= between(0.3, 3.0);
    disk.stiffness_nm_per_rad *= between(0.3, 3.0);
    disk.coupling_nm_per_rad *= between(0.0, 3.0);
    disk.damping_ratio = between(0.0, 0.2);
    scene.casing.modal_mass_kg *= between(0.3, 3.0);
    scene.casing.modal_stiffness_n_per_m *= between(0.3, 3.0);
    scene.casing.damping_ratio = between(0.001, 0.3);
    scene.casing.radius_m = scene.bladed_disk.blade_length_m + between(3e-5, 3e-4);
    scene.operation.nodal_diameters = between(1.0, 5.0) as u32;
    scene.operation.speed_rad_s = between(-700.0, 700.0);
    scene.operation.pulse_s = 10_f64.powf(between(-5.0, -2.0));
    scene.solver.contact = ContactLaw::Unilateral;
    scene.checked().unwrap()
}

pub fn of(scene: &CheckedScene, name: LimitName) -> Limit {
    Margins::of(scene).limit(name).unwrap().clone()
}

pub fn close(found: Option<f64>, expected: f64, most: f64, what: &str) {
    let found = found.unwrap_or_else(|| panic!("{what}: none"));
    let error = (found - expected).abs();
    assert!(error <= most * expected.abs().max(1.0), "{what}: {found} is not {expected}");
}

/// The sensitivity by a central difference of fourth order.
pub fn differenced(scene: &CheckedScene, path: &str, value: &dyn Fn(&CheckedScene) -> f64) -> f64 {
    let parameter = parameter(path).unwrap();
    let clearance = scene.machine().clearance();
    let size = parameter.real(scene);
    let lengths = ["casing.radius_m", "bladed_disk.blade_length_m"];
    let step = 1e-3 * if lengths.contains(&path) { clearance / size } else { 1.0 };
    let at = |part: f64| {
        value(&changed(parameter, scene, size * (1.0 + part * step)).unwrap().checked().unwrap())
    };
    let slope = |part: f64| (at(part) - at(-part)) / (2.0 * part * step * at(0.0));
    (4.0 * slope(0.5) - slope(1.0)) / 3.0
}

/// The closed form of a sensitivity with rigid blades; `None` of a limit that is not known here.
fn in_closed_form(scene: &CheckedScene, name: LimitName, path: &str) -> Option<f64> {
    let machine = scene.machine();
    let delta = machine.polygon.delta;
    let frequencies = [machine.omega_c, machine.omega_bd];
    let [of_casing, of_blades] = frequencies.map(|omega| omega / (frequencies[0] + frequencies[1]));
    let by_damping = |slope: f64| {
        let x = machine.casing_damping_ratio * slope;
        x / (x * x + 1.0).sqrt()
    };
    let nu = machine.nu(scene.operation.speed_rad_s);
    let inertia = nu * nu * machine.casing_mass / delta.cos();
    let elastic = machine.casing_stiffness / delta.cos();
    let drag = machine.casing_damping * nu / delta.sin();
    let drag = if name == LimitName::PushA { drag } else { -drag };
    let push = inertia - elastic + drag;
    // Parts of mass, stiffness, damping ratio, clearance, speed and inertia of the blades.
    let parts = match name {
        LimitName::OmegaC => [-0.5, 0.5, 0.0, 0.0, 0.0, 0.0],
        LimitName::OmegaLock => [-0.5, 0.5, by_damping(delta.tan().recip()), 0.0, 0.0, 0.0],
        LimitName::OmegaAdhesive => [-0.5, 0.5, by_damping(delta.tan()), 0.0, 0.0, 0.0],
        LimitName::Coincidence => {
            [-0.5 * of_casing, 0.5 * of_casing, 0.0, 0.0, 0.0, -0.5 * of_blades]
        }
        LimitName::PushA | LimitName::PushB => [
            (inertia + 0.5 * drag) / push,
            (0.5 * drag - elastic) / push,
            drag / push,
            1.0,
            (2.0 * inertia + drag) / push,
            0.0,
        ],
        LimitName::Torque => [0.5, 0.5, 1.0, 2.0, 1.0, 0.0],
        LimitName::Power => [0.5, 0.5, 1.0, 2.0, 2.0, 0.0],
        _ => return None,
    };
    let paths = [MASS, STIFFNESS, DAMPING, CLEARANCE, SPEED, "bladed_disk.inertia_kg_m2"];
    paths.iter().zip(parts).find(|(known, _)| **known == path).map(|(_, part)| part)
}

#[test]
fn sensitivities_of_rigid_blades_are_those_of_their_closed_forms() {
    let mut random = fastrand::Rng::with_seed(2010);
    let mut compared = 0;
    for _ in 0..20 {
        let mut scene = random_scene(&mut random).into_scene();
        scene.solver.model = ModelSize::Rigid;
        let scene = scene.checked().unwrap();
        for limit in Margins::of(&scene).limits {
            for (path, by) in &limit.sensitivities.0 {
                let Some(expected) = in_closed_form(&scene, limit.name, path) else { continue };
                let what = format!("{} by {path}", limit.name);
                if expected.abs() > 100.0 {
                    assert_eq!(*by, None, "{what}");
                } else {
                    close(*by, expected, 1e-7, &what);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 600, "{compared}");
}

#[test]
fn sensitivities_of_the_touching_pulse_are_those_of_the_whole_search() {
    let mut random = fastrand::Rng::with_seed(2010);
    let mut compared = 0;
    for _ in 0..8 {
        let scene = random_scene(&mut random);
        let limit = of(&scene, LimitName::TouchingPulse);
        let Some(found) = limit.value else { continue };
        let value = |scene: &CheckedScene| grazing_pulse(scene, 3.0 * found).unwrap();
        for (path, by) in &limit.sensitivities.0 {
            let expected = differenced(&scene, path, &value);
            // One per cent of a length is many clearances.
            let Some(by) = by else {
                assert!(expected.abs() > 99.0, "{path}: {expected}");
                continue;
            };
            let lengths = path.ends_with("_m") && *path != CLEARANCE;
            let most = 1e-6 * (1.0 + expected.abs()).max(if lengths { 1e4 } else { 1.0 });
            assert!((by - expected).abs() < most, "{path}: {by} is not {expected}");
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
}
