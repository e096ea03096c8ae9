//! What a coincidence does against speed, as the library, the command line and its files
//! give it.

use rubscope_solver::harmonic::{Joint, coincidence, round_whirls, shifted_coincidence};
use rubscope_solver::scene::Scene;
use serde_json::Value;

use crate::cli_support::{refusal, rubscope};
use crate::hbm_lining::{close, preloaded};

const PRELOADED: &str = "--contact smooth --set casing.radius_m=0.49988 --set \
    bladed_disk.radial_coupling=0.5 --set contact.stiffness_n_per_m=27e3";

fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

fn json(line: &str) -> Value {
    let output = rubscope(&words(&format!("hbm {line} --json")));
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn under_preload_it_is_growth_and_the_wave_it_ends_in() {
    let scene = preloaded("27e3", &[]);
    let points = coincidence(&scene, &[390.0, 406.0, 425.0, 445.0]).unwrap();
    let growths: Vec<f64> = points.iter().map(|point| point.growth_1_s.unwrap()).collect();
    close(growths[0], -5.799479916, 1e-9);
    close(growths[2], 7.512595085, 1e-9);
    assert!(growths[1] > 0.0 && growths[3] < 0.0);
    close(points[1].blade_amplitude_rad.unwrap(), 1.8201e-4, 5e-5);
    close(points[2].casing_amplitude_m.unwrap(), 2.39884117e-5, 1e-8);
    close(points[2].omega_rad_s.unwrap(), 970.690111, 1e-9);
    assert!(points[0].blade_amplitude_rad.is_none() && points[3].omega_rad_s.is_none());
    assert!(points.iter().all(|point| point.bounded));
    let stiff = coincidence(&preloaded("54e3", &[]), &[425.0]).unwrap()[0];
    assert!(!stiff.bounded && stiff.blade_amplitude_rad.is_none());
    assert!(shifted_coincidence(&scene, 1.0).unwrap() > 419.0);
}

#[test]
fn over_a_clearance_it_is_the_whirl_on_the_rim() {
    let mut scene = Scene::base();
    scene.set("bladed_disk.radial_coupling", "0.3").unwrap();
    // Of the rim formula: omega, |z| and |a|.
    for (speed, omega, z, a) in [
        (420.0, 982.439, 1.6765e-4, 5.7724e-4),
        (450.0, 1088.520, 2.1659e-4, 8.0872e-4),
        (500.0, 1261.599, 2.6738e-4, 1.12563e-3),
    ] {
        let point = coincidence(&scene, &[speed]).unwrap()[0];
        close(point.omega_rad_s.unwrap(), omega, 1e-6);
        close(point.casing_amplitude_m.unwrap(), z, 5e-5);
        close(point.blade_amplitude_rad.unwrap(), a, 5e-5);
        assert!(point.bounded && point.growth_1_s.is_none());
        let waves = round_whirls(&Joint::at(&scene.machine(), speed));
        assert_eq!(waves.len(), 2);
    }
    // Below the fold every pulse decays; above the flutter speed nothing bounds it.
    let below = coincidence(&scene, &[405.0]).unwrap()[0];
    assert!(below.blade_amplitude_rad.is_none() && below.bounded);
    assert!(!coincidence(&scene, &[800.0]).unwrap()[0].bounded);
    assert_eq!(shifted_coincidence(&scene, 1.0), None);
    // A very stiff lining is a rim, and the rotor may turn the other way.
    let mut lined = scene.clone();
    lined.set("solver.contact", "smooth").unwrap();
    lined.set("contact.stiffness_n_per_m", "1e13").unwrap();
    lined.set("contact.smoothing_m", "0").unwrap();
    for speed in [450.0, -450.0] {
        let rigid = coincidence(&scene, &[speed]).unwrap()[0];
        let soft = coincidence(&lined, &[speed]).unwrap()[0];
        close(soft.blade_amplitude_rad.unwrap(), rigid.blade_amplitude_rad.unwrap(), 1e-3);
        close(soft.omega_rad_s.unwrap(), rigid.omega_rad_s.unwrap(), 1e-9);
        assert!((rigid.omega_rad_s.unwrap() * speed) > 0.0);
    }
    scene.set("operation.nodal_diameters", "11").unwrap();
    assert!(coincidence(&scene, &[400.0]).is_err());
}

#[test]
fn the_command_gives_the_numbers_of_the_library() {
    let curve = &json(&format!("--coincidence {PRELOADED} --speed 390:410:3"))["coincidence"];
    assert_eq!(curve["points"].as_array().unwrap().len(), 3);
    close(curve["points"][2]["growth_1_s"].as_f64().unwrap(), 6.643429931, 1e-9);
    assert_eq!(curve["points"][0]["blade_amplitude_rad"], Value::Null);
    let markers: Vec<f64> =
        curve["markers_rad_s"].as_array().unwrap().iter().map(|m| m.as_f64().unwrap()).collect();
    close(markers[0], 197.442, 1e-6);
    close(markers[1], 388.315, 1e-6);
    close(curve["shifted_rad_s"].as_f64().unwrap(), 419.849, 1e-6);
    let smooth = json(&format!("--smooth {PRELOADED} --speed 390:440:6"));
    assert_eq!(smooth["locked_amplitude_m"], Value::Null);
    let smooth = &smooth["smooth"];
    close(smooth["hopf"][0]["speed_rad_s"].as_f64().unwrap(), 399.4641, 2e-7);
    close(smooth["hopf"][1]["speed_rad_s"].as_f64().unwrap(), 437.8875, 2e-7);
    close(smooth["cycles"][1]["gap_amplitude_m"].as_f64().unwrap(), 6.80419176e-5, 1e-8);
    assert_eq!(smooth["lock_from_rad_s"], Value::Null);
    let lined = "--contact smooth --set contact.smoothing_m=0 --set contact.stiffness_n_per_m=1e9";
    let soft = json(&format!("--smooth {lined} --speed 418.6166508"));
    close(soft["smooth"]["lock_from_rad_s"].as_f64().unwrap(), 417.6167, 2e-7);
    close(soft["smooth"]["states"][2]["pushes"][1]["push_n"].as_f64().unwrap(), 0.541935, 2e-6);
}

#[test]
fn tables_say_what_they_show() {
    let text = |line: &str| {
        let output = rubscope(&words(&format!("hbm {line}")));
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let rest = text(&format!("--smooth {PRELOADED} --speed 390:440:6"));
    assert!(rest.contains("A wave grows from 399.464 rad/s, decays from 437.888 rad/s."), "{rest}");
    assert!(rest.contains("grows to a wave") && !rest.contains(", lock "), "{rest}");
    let lined = "--contact smooth --set contact.stiffness_n_per_m=3e8 --speed 500:600:2";
    let lock = text(&format!("--smooth {lined}"));
    assert!(lock.contains("holds it from 438.158 to 732.355 rad/s"), "{lock}");
    assert!(lock.contains("a lock of two groups needs a lining of at least"), "{lock}");
    let curve = text("--coincidence --set bladed_disk.radial_coupling=0.3 --speed 400:500:2");
    assert!(curve.contains("Coincidences (30) at 197.442 and 388.315 rad/s; the wave"), "{curve}");
}

#[test]
fn what_has_no_meaning_is_refused_by_name() {
    let refused = |line: &str| refusal(&words(&format!("hbm {line}")));
    for view in ["", "--slip", "--branches", "--excitation"] {
        let said = refused(&format!("{view} {PRELOADED}"));
        assert!(
            said.starts_with("rubscope: casing.radius_m = 0.49988: allowed is above"),
            "{said}"
        );
        assert!(said.contains("hbm --smooth has the steady states of a preloaded lining"));
    }
    let said = refused("--smooth");
    assert!(said.contains("solver.contact = ") && said.contains("allowed is \"smooth\""), "{said}");
    assert!(refused("--coincidence --nd 11").contains("operation.nodal_diameters = 11"));
}
