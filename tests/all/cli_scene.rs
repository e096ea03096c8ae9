//! The options that change a scene: each sets its key, their precedence, and
//! what is refused.

use std::io::Write;

use crate::cli_support::{json, refusal, rubscope};

/// The scene of a short run with these arguments, as its report gives it.
fn scene(arguments: &[&str]) -> serde_json::Value {
    let mut report = json(&[&["run", "--json"], arguments].concat());
    report["scene"].take()
}

fn file(toml: &str) -> tempfile::NamedTempFile {
    let mut file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    file.write_all(toml.as_bytes()).unwrap();
    file
}

#[test]
fn every_option_reaches_its_key() {
    let short = ["--end", "1e-4", "--contact", "unilateral"];
    for (option, text, path, value) in [
        ("--speed", "-430", "/operation/speed_rad_s", serde_json::json!(-430.0)),
        ("--speed", "4.3e2", "/operation/speed_rad_s", serde_json::json!(430.0)),
        ("--pulse", "-1e3", "/operation/pulse_n", serde_json::json!(-1000.0)),
        ("--nd", "4", "/operation/nodal_diameters", serde_json::json!(4)),
        ("--zeta-casing", "0.01", "/casing/damping_ratio", serde_json::json!(0.01)),
        ("--zeta-disk", "0", "/bladed_disk/damping_ratio", serde_json::json!(0.0)),
        ("--solver", "explicit", "/solver/kind", serde_json::json!("explicit")),
        ("--model", "rigid", "/solver/model", serde_json::json!("rigid")),
        ("--model", "full", "/solver/model", serde_json::json!("full")),
        ("--step", "2e-7", "/solver/step_s", serde_json::json!(2e-7)),
        ("--set", "bladed_disk.blades=24", "/bladed_disk/blades", serde_json::json!(24)),
        ("--set", "initial.v_c_m_s=-0.1", "/initial/v_c_m_s", serde_json::json!(-0.1)),
        ("--set", "title=a = b", "/title", serde_json::json!("a = b")),
    ] {
        let scene = scene(&[&short[..], &[option, text]].concat());
        assert_eq!(scene.pointer(path), Some(&value), "{option} {text}");
    }
    assert_eq!(scene(&["--contact=bilateral", "--end=1e-4"])["solver"]["contact"], "bilateral");
}

#[test]
fn an_option_wins_over_the_file_and_the_file_over_the_default() {
    let file = file("[operation]\nspeed_rad_s = 450.0\n[solver]\nend_s = 1e-4\n");
    let path = file.path().to_str().unwrap();
    let from_file = scene(&[path]);
    assert_eq!(from_file["operation"]["speed_rad_s"], 450.0);
    assert_eq!(from_file["bladed_disk"]["blades"], 22);
    assert_eq!(scene(&[path, "--speed", "-460"])["operation"]["speed_rad_s"], -460.0);
    let set_last = scene(&["--set", "operation.speed_rad_s=470", path, "--speed", "460"]);
    assert_eq!(set_last["operation"]["speed_rad_s"], 470.0);
}

#[test]
fn without_a_scene_the_default_one_is_run() {
    assert_eq!(scene(&["--end", "1e-4"]), scene(&["paper-nd3", "--end", "1e-4"]));
}

#[test]
fn an_option_can_mend_a_file_that_is_refused_alone() {
    let file = file("[solver]\nstep_s = 0.01\nend_s = 1e-4\n");
    let path = file.path().to_str().unwrap();
    assert!(refusal(&["run", path]).contains("solver.step_s = 1e-2: allowed is above 0 and below"));
    assert_eq!(scene(&[path, "--step", "1e-7"])["solver"]["step_s"], 1e-7);
}

#[test]
fn refused_options_name_key_value_and_what_is_allowed() {
    for (arguments, start) in [
        (
            &["--set", "paint.colour=red"][..],
            "unknown key paint.colour; allowed: schema, title, note, bladed_disk, casing",
        ),
        (&["--set", "casing.colour=red"], "unknown key casing.colour; allowed: casing.radius_m,"),
        (&["--set", "blades"], "--set = blades: allowed is PATH=VALUE"),
        (&["--set", "bladed_disk.blades=0"], "bladed_disk.blades = 0: allowed is a whole number"),
        (&["--set", "bladed_disk.blades=2.5"], "bladed_disk.blades = 2.5: allowed is a whole"),
        (&["--set", "casing.radius_m=0.4999"], "casing.radius_m = 0.4999: allowed is above bl"),
        (&["--speed", "NaN"], "operation.speed_rad_s = NaN: allowed is a number from -1e6 to 1e6"),
        (&["--speed", "inf"], "operation.speed_rad_s = inf: allowed is a number from"),
        (&["--speed", "fast"], "operation.speed_rad_s = fast: allowed is a number from"),
        (&["--speed", "1:2:3"], "operation.speed_rad_s = 1:2:3: allowed is a number from"),
        (&["--nd", "-3"], "operation.nodal_diameters = -3: allowed is a whole number from 0"),
        (&["--zeta-casing", "-0.1"], "casing.damping_ratio = -0.1: allowed is a number from 0"),
        (&["--zeta-disk", "x"], "bladed_disk.damping_ratio = x: allowed is a number from 0"),
        (&["--solver", "magic"], "solver.kind = \"magic\": allowed is one of explicit, event"),
        (&["--contact", "glue"], "solver.contact = \"glue\": allowed is one of unilateral, bil"),
        (
            &["--solver", "event", "--contact", "bilateral"],
            "solver.contact = \"bilateral\": allowed",
        ),
        (&["--solver", "event", "--model", "full"], "solver.model = \"full\": allowed is"),
        (&["--model", "huge"], "solver.model = \"huge\": allowed is one of rigid, modal, full"),
        (&["--step", "0"], "solver.step_s = 0: allowed is a number above 0"),
        (&["--step", "0.01"], "solver.step_s = 1e-2: allowed is above 0 and below the stability"),
        (&["--end", "-1"], "solver.end_s = -1: allowed is a number above 0"),
        (&["nowhere"], "unknown scene nowhere; allowed: a path ending in .toml, or one of paper"),
        (&["nowhere.toml"], "cannot read scene file nowhere.toml: "),
        (&["padder-nd3"], "unknown scene padder-nd3 (did you mean paper-nd3?); allowed: a path"),
    ] {
        let message = refusal(&[&["run"], arguments].concat());
        assert!(message.starts_with(&format!("rubscope: {start}")), "{arguments:?}: {message}");
    }
}

#[test]
fn a_misspelt_command_or_scene_is_answered_with_the_nearest_one() {
    for (arguments, meant) in [
        (&["runn"][..], "unknown command runn (did you mean run?); see rubscope --help"),
        (&["runn", "paper-nd3"], "unknown command runn (did you mean run?)"),
        (&["srvey", "mine.toml", "--range", "6000:11000"], "command srvey (did you mean survey?)"),
        (&["marigns", "--json"], "unknown command marigns (did you mean margins?)"),
        (&["grazin"], "unknown scene grazin (did you mean grazing?); allowed: a path"),
        (&["scenes", "long_tip"], "unknown scene long_tip (did you mean long-tip?); allowed"),
        (&["nowhere"], "unknown scene nowhere; allowed: a path"),
        (&["./runn"], "cannot read scene file ./runn"),
        (&["run", "--speeed", "3"], "unexpected argument '--speeed' found"),
    ] {
        let message = refusal(arguments);
        assert!(message.contains(meant), "{arguments:?}: {message}");
        assert_eq!(message.matches("did you mean").count(), meant.matches("did you mean").count());
    }
}

#[test]
fn a_step_bound_is_printed_in_four_digits_and_accepted_as_printed() {
    for (speed, step, bound) in [
        ("0", "0.01", "2.276e-3"),
        ("0", "2.4e-3", "2.276e-3"),
        ("500", "0.01", "3.333e-4"),
        ("500", "4e-4", "3.333e-4"),
        ("-430", "2.4e-3", "3.875e-4"),
    ] {
        let short = ["run", "--end", "0.01", "--speed", speed, "--step"];
        let said = refusal(&[&short[..], &[step]].concat());
        let printed = said.split("at most ").nth(1).unwrap().split(',').next().unwrap();
        assert_eq!(printed, bound, "{said}");
        // With such a coarse step the run may break down, but it is accepted.
        assert_ne!(rubscope(&[&short[..], &[printed]].concat()).status.code(), Some(2), "{said}");
    }
}

#[test]
fn refused_files_are_named() {
    for (toml, found) in [
        ("[casing]\nradius_m = nan\n", "casing.radius_m = NaN: allowed is"),
        ("[casing]\ncolour = 1\n", "unknown key casing.colour; allowed: casing.radius_m"),
        ("[bladed_disk]\nblades = \"many\"\n", "bladed_disk.blades = \"many\": allowed is a whole"),
        ("[bladed_disk]\n\nblades = = 3\n", "not a TOML file: line 3: "),
    ] {
        let file = file(toml);
        let path = file.path().to_str().unwrap();
        let message = refusal(&["run", path]);
        assert!(message.starts_with(&format!("rubscope: {path}: {found}")), "{message}");
    }
}

/// A device without end, or a huge file, is refused before it fills the memory.
#[test]
fn a_scene_file_has_a_largest_size() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("endless.toml");
    std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
    let huge = folder.path().join("huge.toml");
    std::fs::write(&huge, format!("title = \"{}\"", "x".repeat(2 << 20))).unwrap();
    for path in [link, huge] {
        let refused = rubscope_solver::scene::Scene::load(path.to_str().unwrap()).unwrap_err();
        assert!(refused.to_string().contains("up to 1048576 bytes"), "{refused}");
    }
}

/// A pipe that nobody writes to would be waited for in silence.
#[test]
fn a_scene_from_a_pipe_is_read_and_one_in_a_folder_says_that_it_waits() {
    use std::process::Stdio;
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("scene.toml");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let run = |path: &std::path::Path, input: Stdio| {
        let mut run = crate::cli_support::program();
        run.args(["run", "--end", "1e-5"]).arg(path).stdin(input);
        run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let waiting = run(&pipe, Stdio::null());
    std::fs::write(&pipe, "title = \"through a pipe\"").unwrap();
    let fed = run(
        "/dev/stdin".as_ref(),
        Stdio::from(file("title = \"through a pipe\"").reopen().unwrap()),
    );
    let said = format!("rubscope: {} is a pipe: waiting for its writer\n", pipe.display());
    for (run, said) in [(waiting, said.as_str()), (fed, "")] {
        let output = run.wait_with_output().unwrap();
        assert!(output.status.success());
        assert!(String::from_utf8(output.stdout).unwrap().contains("through a pipe"));
        assert_eq!(String::from_utf8(output.stderr).unwrap(), said);
    }
}
