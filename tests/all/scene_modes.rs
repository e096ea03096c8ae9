//! The modes of casing and disk by their diameters, and numbers with units, as files give them.

use std::f64::consts::TAU;

use rubscope::sheet::CommandLine;
use rubscope_solver::scene::{BUILTIN, Scene};

use crate::close;

fn scene(name: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::builtin(name).unwrap().with(changes).unwrap().into_scene()
}

const DIAMETERS: &str = "operation.nodal_diameters";
const STIFFNESS: &str = "casing.modal_stiffness_n_per_m";

#[test]
fn keys_act_on_the_mode_in_use_and_others_keep_their_values() {
    let mut scene = scene("paper-nd3", &[(DIAMETERS, "4"), (STIFFNESS, "3e6")]);
    close(scene.machine().omega_c, 1.5e6_f64.sqrt(), 1e-14);
    scene.set(DIAMETERS, "3").unwrap();
    close(scene.machine().casing_stiffness, 1.544e6, 0.0);
    // What a mode leaves out is the casing's own, and is shared.
    scene.set("casing.damping_ratio", "0.01").unwrap();
    scene.set(DIAMETERS, "4").unwrap();
    assert_eq!(scene.machine().casing_damping_ratio, 0.01);
    assert_eq!(scene.machine().casing_stiffness, 3e6);
}

#[test]
fn frequencies_in_hertz_stand_for_the_stiffness_that_gives_them() {
    let toml = "
[casing]
modal_mass_kg = 3.5
[[casing.modes]]
nodal_diameters = 5
frequency_hz = 251.3
[[casing.modes]]
nodal_diameters = 6
frequency_hz = \"17400 rpm\"
modal_mass_kg = \"3300 g\"
[bladed_disk]
blades = 36
[[bladed_disk.modes]]
nodal_diameters = 5
frequency_hz = 92.75
[operation]
nodal_diameters = 5
speed_rad_s = \"2000 rpm\"
pulse_n = \"43.4 kN\"
pulse_s = \"50us\"
";
    let mut scene = Scene::from_toml(toml).unwrap();
    let machine = scene.machine();
    close(machine.omega_c, TAU * 251.3, 1e-14);
    close(machine.omega_bd, TAU * 92.75, 1e-13);
    close(scene.operation.speed_rad_s, TAU * 2000.0 / 60.0, 1e-14);
    assert_eq!((scene.operation.pulse_n, scene.operation.pulse_s), (43.4e3, 50e-6));
    assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
    scene.set(DIAMETERS, "6").unwrap();
    let machine = scene.machine();
    close(machine.omega_c, TAU * 290.0, 1e-14);
    assert_eq!(machine.casing_mass, 3.3);
    assert!(scene.modes_note().unwrap().starts_with("no mode of the disk with 6 nodal"));
}

#[test]
fn every_scene_is_made_again_by_its_command_also_where_a_mode_hides_values() {
    let modes = "[{ nodal_diameters = 3, modal_stiffness_n_per_m = 2.0e6 }]";
    let hidden = Scene::from_toml(
        "[casing]\nmodal_mass_kg = 3.0\nmodal_stiffness_n_per_m = 1e6\n[[casing.modes]]\n\
         nodal_diameters = 3\nmodal_stiffness_n_per_m = 2e6\n",
    )
    .unwrap();
    let mut all = vec![hidden, scene("paper-nd3", &[(DIAMETERS, "4"), (STIFFNESS, "3e6")])];
    all.push(scene("paper-nd3", &[(DIAMETERS, "5"), (STIFFNESS, "3e6")]));
    all.push(scene("slip", &[("casing.modes", modes)]));
    all.push(scene(
        "paper-nd3",
        &[(DIAMETERS, "11"), ("bladed_disk.modes", "[{ nodal_diameters = 11 }]")],
    ));
    for name in BUILTIN {
        all.push(scene(name.name, &[(DIAMETERS, "2")]));
    }
    for scene in all {
        for base in ["paper-nd3", "soft-lining"] {
            let from = Scene::builtin(base).unwrap();
            let line = CommandLine::from_base("run", base, &from, &scene).to_string();
            let mut made = from.clone();
            for (path, text) in rubscope_solver::scene::keys::differences(&from, &scene) {
                made.set(path, &text).unwrap();
            }
            let alike = (&made.casing, &made.bladed_disk, &made.operation, &made.title)
                == (&scene.casing, &scene.bladed_disk, &scene.operation, &scene.title);
            assert!(alike, "{line}");
        }
    }
}

#[test]
fn a_frequency_of_turning_blades_gives_that_at_rest_for_each_mode() {
    let square = |x: f64| x * x;
    let at = |rest: f64, b: f64, omega: f64| (square(TAU * rest) + b * square(omega)).sqrt();
    let toml = format!(
        "[bladed_disk]\nblades = 36\ncentrifugal_stiffening = 0.5
        [[bladed_disk.modes]]\nnodal_diameters = 5\nfrequency_hz = {}\nat_speed_rad_s = 300
        [[bladed_disk.modes]]\nnodal_diameters = 5\nfrequency_hz = {}\nat_speed_rad_s = \"9000 rpm\"
        [[bladed_disk.modes]]\nnodal_diameters = 6\nfrequency_hz = {}\nat_speed_rad_s = 700
        centrifugal_stiffening = 1.9
        [[bladed_disk.modes]]\nnodal_diameters = 7\nfrequency_hz = 93.0",
        at(92.75, 1.7, 300.0) / TAU,
        at(92.75, 1.7, TAU * 150.0) / TAU,
        at(95.0, 1.9, 700.0) / TAU,
    );
    let mut scene = Scene::from_toml(&toml).unwrap();
    assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
    for (diameters, rest, b) in [("5", 92.75, 1.7), ("6", 95.0, 1.9), ("7", 93.0, 0.5)] {
        scene.set(DIAMETERS, diameters).unwrap();
        let machine = scene.machine();
        close(machine.omega_bd_at_rest(), TAU * rest, 1e-12);
        close(machine.stiffening(), b, 1e-11);
        close(machine.at(600.0).omega_bd, at(rest, b, 600.0), 1e-12);
    }
    // The key is that of the mode in use; others keep theirs.
    scene.set(DIAMETERS, "6").unwrap();
    scene.set("bladed_disk.centrifugal_stiffening", "0").unwrap();
    assert_eq!(scene.bladed_disk.centrifugal_stiffening, 0.5);
    assert!(!scene.changes_with_speed() && scene.machine().stiffening() == 0.0);
    scene.set(DIAMETERS, "7").unwrap();
    assert!(scene.changes_with_speed());
}
