//! Whether a lock holds, whether a rub whirls or grows, and what is not known: one answer in every
//! command.

use crate::cli_support::{self, words};
use serde_json::{Value, json};

fn text(line: &str) -> String {
    cli_support::text(&words(line))
}

fn json_of(line: &str) -> Value {
    cli_support::json(&words(&format!("{line} --json")))
}

/// A machine whose heavy pushes hold a lock that blades and casing as one would leave:
/// `-mu < kappa < 0`. A stepper that starts in it at 290 rad/s stays.
const HEAVY: &str = "--set casing.modes=[] --set bladed_disk.blades=49 \
    --set operation.nodal_diameters=7 --set bladed_disk.blade_length_m=0.48853 \
    --set casing.radius_m=0.48924 --set bladed_disk.inertia_kg_m2=0.03588 \
    --set bladed_disk.stiffness_nm_per_rad=38230 --set bladed_disk.coupling_nm_per_rad=0 \
    --set bladed_disk.damping_ratio=0.001 --set casing.modal_mass_kg=11.18 \
    --set casing.modal_stiffness_n_per_m=2.952e7 --set casing.damping_ratio=0.005 \
    --set bladed_disk.radial_coupling=-0.156 --set contact.friction=0.4";

#[test]
fn a_lock_that_heavy_pushes_hold_is_denied_nowhere() {
    let point = &json_of(&format!("hbm --speed 290 {HEAVY}"))["points"][0];
    assert_eq!(point["stable"], true, "{point}");
    let margins = json_of(&format!("margins --no-search --speed 290 {HEAVY}"));
    let limits = margins["limits"].as_array().unwrap();
    let lock = limits.iter().find(|limit| limit["name"] == "omega_lock").unwrap();
    let from = lock["value"].as_f64().unwrap();
    assert!((230.0..250.0).contains(&from), "{lock}");
    let survey = json_of(&format!("survey --range 250:320 {HEAVY}"));
    assert_eq!(survey["rows"][7]["locks_in_range"], json!([[250.0, 320.0]]));
    assert!(text(&format!("survey --range 250:320 {HEAVY}")).contains(" can lock"));
    let whirl = json_of(&format!("hbm --whirl --speed 290 {HEAVY}"));
    assert_eq!(whirl["lock_window_rad_s"][0].as_f64(), Some(from));
    assert!(text(&format!("check --speed 290 {HEAVY}")).contains("omega_lock"));
}

#[test]
fn whirl_from_rest_on_is_not_denied() {
    let tips = "--set bladed_disk.radial_coupling=-0.0446 --set contact.friction=0.1 \
        --set bladed_disk.stiffness_nm_per_rad=600000 --set bladed_disk.damping_ratio=0.01 \
        --set casing.damping_ratio=0.01 --contact unilateral";
    let found = json_of(&format!("hbm --whirl --speed 1:700:3 {tips}"));
    assert_eq!(found["whirl_onset_rad_s"], 0.0);
    let states = found["points"].as_array().unwrap().iter().map(|point| &point["state"]);
    assert!(states.clone().count() == 3 && states.clone().all(|state| state == "whirls"));
    assert!(!text(&format!("hbm --whirl --speed 1:700:3 {tips}")).contains("Nothing whirls"));
    let row = &json_of(&format!("survey --range 1:700 {tips}"))["rows"][3];
    assert_eq!((&row["whirl_spans"], &row["growth_spans"]), (&json!([[1.0, 700.0]]), &json!([])));
    assert_eq!(row["whirls_in_range"], json!([1.0]));
}

/// Runs whirl at 440 rad/s and diverge at 500 and 520, whatever the pulse.
#[test]
fn growth_without_bound_is_not_called_none() {
    let tips = "--contact unilateral --set bladed_disk.radial_coupling=0.5";
    let found = json_of(&format!("hbm --whirl --speed 380:520:8 {tips}"));
    let states: Vec<&str> = found["points"]
        .as_array()
        .unwrap()
        .iter()
        .map(|at| at["state"].as_str().unwrap())
        .collect();
    let expected = ["none", "whirls", "whirls", "whirls", "grows", "grows", "grows", "grows"];
    assert_eq!(states, expected);
    let title = text(&format!("hbm --whirl --speed 400:520:7 {tips}"));
    assert!(title.contains("a rub grows without bound above 452.804 rad/s"), "{title}");
    let row = &json_of(&format!("survey --range 400:520 {tips}"))["rows"][3];
    let end = row["whirl_spans"][0][1].as_f64().unwrap();
    assert!((end / 452.804 - 1.0).abs() < 1e-5, "{row}");
    let begin = row["growth_spans"][0][0].as_f64().unwrap();
    assert!((begin / end - 1.0).abs() < 1e-8, "{row}");
    assert_eq!(row["growth_spans"][0][1], 520.0);
    let survey = text(&format!("survey --range 400:520 {tips}")).replace('\n', " ");
    let said = "until 452.804 rad/s it whirls, from 452.804 rad/s on it grows without bound";
    assert!(survey.contains(said), "{survey}");
}

#[test]
fn no_note_says_that_blades_bend_or_that_a_slope_leaves_no_lock_where_that_is_false() {
    let lobes = "--contact unilateral --set casing.lobes=3 --set casing.out_of_round_m=2e-6";
    for more in ["", "--model rigid"] {
        let margins = text(&format!("margins --no-search {lobes} {more}"));
        assert!(margins.contains("omega_lock") && margins.contains("430.611"), "{margins}");
        assert!(!margins.contains("bend so much"), "{margins}");
        let survey = text(&format!("survey {lobes} {more}"));
        assert!(!survey.contains("rigid") && !survey.contains("bend so much"), "{survey}");
    }
    let rubs = text(
        "margins --no-search --contact unilateral --zeta-disk 0.01 --zeta-casing 0.01 \
         --set bladed_disk.radial_coupling=-0.0446 --set contact.friction=0.1 \
         --set bladed_disk.stiffness_nm_per_rad=600000",
    );
    assert!(rubs.contains("omega_adhesive: none, as tips that rub cannot pull"), "{rubs}");
    assert!(!rubs.contains("leaves no lock"), "{rubs}");
}
