//! `rubscope hbm`: its output for users and for scripts.

use std::process::Command;

use serde_json::Value;

use crate::cli_support::{self, ended, program, text, words};

fn hbm(args: &[&str]) -> Command {
    let mut command = program();
    command.arg("hbm").args(args);
    command
}

fn json(args: &[&str]) -> Value {
    cli_support::json(&[&["hbm"], args, &["--json"]].concat())
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn said(arguments: &[&str]) -> String {
    text(&[&["hbm"], arguments].concat())
}

#[test]
fn the_papers_form_says_that_it_has_no_damping() {
    let printed = said(&["--form", "printed", "--speed", "500"]);
    assert!(printed.contains("form printed, undamped as in the paper"), "{printed}");
    // The lock speed that is told is that of the equations below it.
    let words = "lock from 292.878 rad/s without damping, 411.934 with zeta_c = 0.05";
    assert!(printed.contains(words), "{printed}");
    assert!(said(&["--undamped"]).contains(words));
    assert!(said(&[]).contains("lock from 411.934 rad/s (zeta_c = 0.05)"));
    assert_eq!(json(&["--form", "printed"])["damped"], false);
    assert_eq!(json(&["--form", "printed", "--damped"])["damped"], true);
    ended(&mut hbm(&["--damped", "--undamped"]), 2);
}

#[test]
fn views_that_are_always_damped_do_not_drop_it() {
    let tips = ["--set", "bladed_disk.radial_coupling=0.1"];
    for view in ["--slip", "--excitation", "--whirl", "--compliance", "--smooth"] {
        let output = ended(hbm(&tips).args([view, "--undamped"]), 2);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains("'--undamped'") && said.contains(view), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    // The paper's form is of the multipliers alone.
    let told = said(&["--slip", "--form", "printed"]);
    assert!(told.contains("lock from 411.934 rad/s (zeta_c = 0.05)"), "{told}");
    ended(&mut hbm(&["--branches", "--undamped"]), 0);
}

#[test]
fn slip_at_every_speed_and_at_none_are_told_apart_in_the_heading() {
    for (speeds, told) in [
        ("450:500:3", "Slip exists at all of these speeds."),
        ("300:400:3", "There is no slip at any of these speeds."),
        ("400:500:3", "Slip appears at 433.524 rad/s."),
    ] {
        let text = said(&["--slip", "--zeta-casing", "0.01", "--speed", speeds]);
        assert!(text.contains(told), "{speeds}");
    }
}

#[test]
fn a_rotor_that_turns_backward_has_its_own_coincidence() {
    for (speeds, at) in
        [("-430", -388.315), ("0:-500:11", -388.315), ("-100:500:7", 388.315), ("430", 388.315)]
    {
        let report = json(&["--campbell", "--speed", speeds]);
        assert!((number(&report["coincidence_rad_s"]) - at).abs() < 1e-3, "{speeds}");
        let all = report["coincidences"].as_array().unwrap();
        let dangerous: Vec<_> = all.iter().filter(|found| found["dangerous"] == true).collect();
        assert_eq!(dangerous.len(), 1, "{speeds}");
        assert!((number(&dangerous[0]["speed_rad_s"]) - at).abs() < 1e-3, "{speeds}");
        let text = said(&["--campbell", "--speed", speeds]);
        assert!(text.contains(&format!("dangerous coincidence {at} rad/s")), "{text}");
    }
}

#[test]
fn every_view_prints_a_table_and_json() {
    let soft = "bladed_disk.stiffness_nm_per_rad=0.002";
    let load = "excitation.amplitude_nm=10";
    for (args, field, words) in [
        (vec!["--branches"], "thresholds", "411.934  corner  adhesive"),
        (vec!["--campbell"], "coincidences", "388.315       878.635      -286.309  true"),
        (
            vec![
                "--branches",
                "--set",
                soft,
                "--set",
                "bladed_disk.coupling_nm_per_rad=0",
                "--speed",
                "600:700:2",
            ],
            "thresholds",
            "657.872  corner  penetrates  absent",
        ),
        (vec!["--excitation", "--set", load], "points", "Engine order 3 with 10 N m"),
    ] {
        assert!(json(&args)[field].is_array(), "{field}");
        let text = ended(&mut hbm(&args), 0).stdout;
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains(words), "{field}: {text}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{field}");
    }
}

#[test]
fn results_are_drawn_with_their_origin() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    for (command, drawn) in [
        ("hbm --speed 400:500:3", "multiplier [N]"),
        ("hbm --campbell --speed 0:500:3", "frequency [rad/s]"),
        ("run grazing --end 0.001", "smallest gap [m]"),
        ("map slip --speed 300:500:2 --pulse 2e4:5e4:2", "rotor speed"),
        ("margins --no-search", "omega_lock"),
    ] {
        text(&[&words(command)[..], &["--out", path.to_str().unwrap()]].concat());
        let picture = std::fs::read_to_string(&path).unwrap();
        assert!(picture.starts_with("<svg") && picture.contains(drawn), "{command}");
        let word = command.split(' ').next().unwrap();
        assert!(picture.contains(&format!("\nrubscope {word} ")), "{command}: {picture}");
    }
}

#[test]
fn what_has_no_meaning_ends_with_status_2_and_one_line() {
    for (args, start) in [
        (vec!["--nd", "0"], "rubscope: operation.nodal_diameters = 0: allowed is"),
        (vec!["--nd", "11", "--slip"], "rubscope: operation.nodal_diameters = 11: allowed is"),
        (vec!["--nd", "0", "--campbell"], "rubscope: operation.nodal_diameters = 0: allowed is"),
        (vec!["--blades", "6,7"], "rubscope: --blades = 6,7: allowed is a pair of phase"),
        (vec!["--blades", "6,99"], "rubscope: --blades = 6,99: allowed is two blades from 1"),
        (vec!["--blades", "six"], "rubscope: --blades = six: allowed is I,J"),
        (vec!["--form", "round"], "rubscope: --form = round: allowed is one of printed"),
        (vec!["--excitation"], "rubscope: excitation.amplitude_nm = 0: allowed is above 0"),
        (vec!["--out", "a.txt"], "rubscope: --out = a.txt: allowed is"),
        (vec!["--slip", "--branches"], "rubscope: the argument '--slip' cannot be used with"),
    ] {
        let output = ended(&mut hbm(&args), 2);
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.starts_with(start), "{args:?}: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(output.stdout.is_empty());
    }
}

const INCLINED: [&str; 2] = ["--set", "bladed_disk.radial_coupling=0.3"];

#[test]
fn whirl_has_its_onset_and_its_limits() {
    let told = said(&[&INCLINED[..], &["--whirl", "--speed", "450"]].concat());
    assert!(told.contains("whirl begins at 414.339 rad/s and ends at "), "{told}");
    assert!(told.contains("; a lock holds from 472.117"), "{told}");
    // Without damping every frequency would do.
    let undamped = json(&["undamped", "--whirl", "--speed", "450:500:6"]);
    assert!(undamped["points"].as_array().unwrap().iter().all(|row| row["state"] != "whirls"));
}

#[test]
fn rigid_blades_do_not_bend_under_a_lock() {
    let soft = ["bladed_disk.stiffness_nm_per_rad=10", "bladed_disk.coupling_nm_per_rad=0"];
    let soft = ["--set", soft[0], "--set", soft[1], "--speed", "500"];
    let groups = |model: &str| {
        let report = json(&[&soft[..], &["--model", model]].concat());
        let point = &report["points"][0];
        let group = |[push, angle]: [&str; 2]| [number(&point[push]), number(&point[angle])];
        [["multiplier_a_n", "alpha_a_rad"], ["multiplier_b_n", "alpha_b_rad"]].map(group)
    };
    let [rigid, modal] = ["rigid", "modal"].map(groups);
    for (rigid, modal) in rigid.iter().zip(modal) {
        assert!(rigid[1] == 0.0 && modal[1].abs() > 6e-5, "{rigid:?} {modal:?}");
        assert!((rigid[0] / modal[0] - 1.0).abs() > 1e-5, "{rigid:?} {modal:?}");
    }
    // As of the event solver, whose rigid blades have no angle.
    assert!((rigid[0][0] + 244.415_92).abs() < 1e-5 && (rigid[1][0] + 57.294_78).abs() < 1e-5);
}

#[test]
fn corners_of_unequal_tips_are_named_by_their_blades() {
    let text = said(&["long-tip", "--branches", "--speed", "300"]);
    assert!(text.contains("blade_a  blade_b"), "{text}");
    let rows: Vec<Vec<&str>> = text.lines().map(|row| row.split_whitespace().collect()).collect();
    let first = rows.iter().find(|row| row.first() == Some(&"300")).unwrap();
    assert_eq!(first[1..4], ["1", "3", "292.149"]);
}

#[test]
fn lobes_that_drive_no_wave_say_so() {
    let title = |scene: &[&str]| said(&[scene, &["--forced", "--speed", "90"]].concat());
    let still = "4 lobes drive no wave of 3 nodal diameters, whatever the speed:";
    assert!(title(&["oval"]).contains(still), "{}", title(&["oval"]));
    let three = title(&["oval", "--set", "casing.lobes=3"]);
    assert!(three.contains("3 lobes of 6e-5 m drive, where all blades press:"), "{three}");
}

#[test]
fn the_compliance_crosses_the_negative_axis_where_the_waves_are() {
    let report = json(&[&INCLINED[..], &["--compliance", "--speed", "450"]].concat());
    let [omega, re, im] = ["omega_rad_s", "re_m_per_n", "im_m_per_n"].map(|name| {
        let points = report["points"].as_array().unwrap();
        points.iter().map(|point| number(&point[name])).collect::<Vec<f64>>()
    });
    let [first, last] = [omega[0], omega[omega.len() - 1]];
    // 1.5 times the fastest resonance, both ways.
    assert!(omega.len() == 201 && first == -last && last > 1.5 * 1350.0, "{first} {last}");
    let waves = report["waves"].as_array().unwrap();
    assert_eq!(waves.len(), 2);
    for wave in waves {
        let at = number(&wave["omega_rad_s"]);
        let place = omega.windows(2).position(|pair| pair[0] <= at && at < pair[1]).unwrap();
        // Between two frequencies of the table it may go round a resonance, too.
        assert!(im[place] * im[place + 1] < 0.0 && re[place].min(re[place + 1]) < 0.0, "{at}");
    }
    let text = said(&[&INCLINED[..], &["--compliance", "--speed", "450"]].concat());
    assert!(text.contains("attracts") && text.contains("threshold"), "{text}");
}

#[test]
fn inclined_tips_have_a_lock_and_no_view_that_is_of_the_paper_alone() {
    for view in [&["--branches"][..], &["--slip"], &["--form", "printed"]] {
        let refused = ended(&mut hbm(&[&INCLINED[..], view].concat()), 2);
        let said = String::from_utf8(refused.stderr).unwrap();
        assert!(said.contains("bladed_disk.radial_coupling = 0.3: allowed is 0 "), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    let other = ["--contact", "smooth", "--set", "bladed_disk.nodal_diameters=4"];
    ended(&mut hbm(&[&other[..], &["--campbell"]].concat()), 0);
    let refused = ended(&mut hbm(&[&other[..], &["--whirl"]].concat()), 2);
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.contains("bladed_disk.nodal_diameters = 4: allowed is 0 or"), "{said}");
}
