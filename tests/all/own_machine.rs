//! `rubscope new` and `rubscope check`: from modal data to a scene, and what it says of it.

use std::f64::consts::TAU;
use std::path::Path;

use rubscope_solver::scene::Scene;

use crate::cli_support::{program, refusal, rubscope, text};

/// The worked example of docs/your-machine.md: `stage.toml` from its table, by its command.
pub fn stage(folder: &Path) {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/your-machine.md");
    let page = std::fs::read_to_string(page).unwrap();
    let table = page.split_once("<<'END'\n").unwrap().1.split_once("END\n").unwrap().0;
    std::fs::write(folder.join("modes.csv"), table).unwrap();
    let command = page.lines().find_map(|line| line.strip_prefix("rubscope new ")).unwrap();
    let words = std::iter::once("new").chain(command.split(' '));
    assert!(program().current_dir(folder).args(words).output().unwrap().status.success());
}

#[test]
fn a_stage_of_blades_that_stiffen_is_what_its_table_says_and_locks_where_runs_do() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path());
    let file = folder.path().join("stage.toml").to_str().unwrap().to_string();
    let mut scene = Scene::load(&file).unwrap();
    let table = std::fs::read_to_string(folder.path().join("modes.csv")).unwrap();
    for row in table.lines().skip(1) {
        let cells: Vec<String> = row.split(';').map(|cell| cell.replace(',', ".")).collect();
        scene.set("operation.nodal_diameters", &cells[1]).unwrap();
        let (machine, hertz) = (scene.machine(), cells[2].parse::<f64>().unwrap());
        let speed = cells[4].parse().unwrap_or(0.0) * (TAU / 60.0);
        let omega = if cells[0] == "disk" { machine.at(speed).omega_bd } else { machine.omega_c };
        assert!((omega / (TAU * hertz) - 1.0).abs() < 1e-12, "{row}");
    }
    let survey: serde_json::Value =
        serde_json::from_str(&text(&["survey", &file, "--range", "7000rpm:12000rpm", "--json"]))
            .unwrap();
    // What is guessed is not counted.
    let said = text(&["survey", &file, "--range", "7000:12000", "--rpm", "--nd", "9"]);
    let said = said.lines().take(4).collect::<Vec<_>>().join(" ");
    let guessed = "; with guessed modes waves of 9 nodal diameters could, too.";
    assert!(said.contains(guessed) && !said.contains("and 9 nodal"), "{said}");
    // Verdicts of runs of many pulses, of which some lock where a lock is possible.
    for (diameters, rpm, locks) in
        [(4, 9500, true), (5, 7200, false), (5, 11800, true), (6, 11800, false)]
    {
        let found = survey["rows"][diameters]["locks_in_range"].as_array().unwrap();
        let speed = f64::from(rpm) * (TAU / 60.0);
        let inside = found.iter().any(|span| {
            let [from, to] = [0, 1].map(|end| span[end].as_f64().unwrap());
            (from..=to).contains(&speed)
        });
        assert_eq!(inside, locks, "{diameters} at {rpm} rpm");
        let nd = diameters.to_string();
        let locked = (0..12).any(|k| {
            let pulse = format!("{}", 7e5 * 1.12_f64.powi(k));
            let at = format!("{rpm}rpm");
            let words = ["run", &file, "--nd", &nd, "--speed", &at, "--pulse", &pulse];
            let run = text(&[&words[..], &["--no-sensitivity", "--json"]].concat());
            run.contains("\"verdict\": \"locked\"") || run.contains("\"verdict\":\"locked\"")
        });
        assert_eq!(locked, locks, "{diameters} at {rpm} rpm");
    }
}

#[test]
fn a_range_without_its_unit_is_asked_about_and_computed_as_given() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path());
    let said = |words: &[&str]| {
        let output = program().current_dir(folder.path()).args(words).output().unwrap();
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let asked = "rubscope: --range: 6000:13000 is in rad/s and moves the blade tips at 5460 m/s; \
                 metal ones reach some 500. Was it rpm? Then write 6000rpm:13000rpm.\n";
    assert_eq!(said(&["survey", "stage.toml", "--range", "6000:13000"]), asked);
    let swept = said(&["hbm", "stage.toml", "--speed", "6000:13000:2"]);
    assert_eq!(swept, asked.replace("--range", "--speed"));
    for words in [
        &["survey", "stage.toml", "--range", "6000:13000", "--rpm"][..],
        &["survey", "stage.toml", "--range", "6000rpm:13000rpm"],
        &["survey", "stage.toml", "--range", "600:1300"],
        &["hbm", "stage.toml", "--speed", "600:1300:2"],
    ] {
        assert_eq!(said(words), "", "{words:?}");
    }
    for (words, question) in [
        ("survey stage.toml --range 7.000:12.000 --rpm", "is that 7.0000 or 7000? Write it so"),
        ("survey stage.toml --range 7000rpm:12.000rpm", "is that 12.0000 or 12000? Write it so"),
        ("check stage.toml --speed 9.500 --rpm", "is that 9.5000 or 9500? Write it so"),
    ] {
        let output = program().current_dir(folder.path()).args(words.split(' ')).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && said.contains(question), "{said}");
    }
}

/// Another table.
pub const TABLE: &str = "\
structure,nodal_diameters,frequency_hz,modal_mass_kg
casing,4,310.7,3.1
casing,5,420.3,2.9
casing,6,533.9,2.8
disk,4,151.3,5.5
disk,5,155.9,5.4
disk,6,159.7,5.3
";

/// A new scene in a folder, and what was said.
pub fn made(folder: &Path) -> (String, String) {
    let [table, file] = ["modes.csv", "mine.toml"].map(|name| folder.join(name));
    std::fs::write(&table, TABLE).unwrap();
    let [table, file] = [table, file].map(|path| path.to_str().unwrap().to_string());
    let machine = "--blades 36 --radius 420mm --clearance 0.3mm --nd 5 --range 6000rpm:11000rpm";
    let words = machine.split(' ').chain(["--casing-damping", "1 %"]);
    let told =
        text(&["new", &file, "--modes", &table].into_iter().chain(words).collect::<Vec<_>>());
    (file, told)
}

#[test]
fn a_new_scene_has_its_speed_a_pulse_that_touches_and_comments() {
    let folder = tempfile::tempdir().unwrap();
    let (file, told) = made(folder.path());
    assert!(told.starts_with("Wrote ") && told.contains("36 blades, 0 to 18 nodal"), "{told}");
    let scene = Scene::load(&file).unwrap();
    assert!((scene.operation.speed_rad_s / (8500.0 * TAU / 60.0) - 1.0).abs() < 1e-13);
    assert_eq!(scene.casing.damping_ratio, 0.01);
    // The pulse makes a blade touch.
    let run = text(&["run", &file]);
    assert!(!run.contains("No blade hit the casing"), "{run}");
    // Every line of a key has a comment.
    let toml = std::fs::read_to_string(&file).unwrap();
    for key in ["blade_length_m", "inertia_kg_m2", "radius_m", "speed_rad_s", "pulse_n", "end_s"] {
        let line = toml.lines().find(|line| line.starts_with(key)).unwrap();
        assert!(line.contains("  # "), "{line}");
    }
    let command = "# Its speeds: rubscope survey FILE --range 6000rpm:11000rpm";
    assert!(toml.contains(command), "{toml}");
}

#[test]
fn what_cannot_be_made_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = made(folder.path());
    let new = folder.path().join("other.toml");
    let new = new.to_str().unwrap();
    let start = ["new", new, "--blades", "36", "--radius", "0.42"];
    let more = ["--clearance", "0.3mm", "--nd", "5", "--casing", "5:420.3:2.9"];
    let whole = [&start[..], &more, &["--disk", "5:155.9Hz:5.4kg"]].concat();
    for (words, says) in [
        (vec!["new", &file], "a name that is not taken: this file exists"),
        (vec!["new", "x.txt"], "FILE = x.txt: allowed is a name that ends in .toml"),
        (vec!["new", "x\u{202e}.toml"], "FILE = x .toml: allowed is a name of letters that can"),
        (start.to_vec(), "new: --clearance is missing (Clearance of the blade tips"),
        ([&start[..], &more].concat(), "new: --disk is missing (Frequency of the bladed disk"),
        (whole.clone(), "new: --range is missing"),
        (
            [&whole[..], &["--range", "9:3"]].concat(),
            "--range = 9:3: allowed is FROM:TO, two speeds",
        ),
        (
            [&whole[..], &["--range", "3:9", "--casing", "5:1:1"]].concat(),
            "--casing = 5 nodal diameters twice: allowed is one mode for each",
        ),
        (
            [&start[..], &["--clearance", "3 kN"]].concat(),
            "--clearance = 3 kN: this is a force; it takes m",
        ),
        (
            [&start[..], &["--clearance", "2m"]].concat(),
            "--clearance = 2 m: allowed is a length above 0 and below the radius, 0.42 m",
        ),
        ([&start[..], &["--casing", "5:0:1"]].concat(), "frequency_hz = 0: allowed is a frequency"),
    ] {
        let said = refusal(&words);
        assert!(said.contains(says), "{said}");
        assert!(!Path::new(new).exists());
    }
}

#[test]
fn a_check_says_what_follows_and_what_looks_like_a_slip() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = made(folder.path());
    let told = text(&["check", &file]).split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "36 blades of 419.7 mm in a casing of the radius 420 mm: a clearance of 300 um, 0.0714 % \
         of the radius.",
        "With 5 nodal diameters the blades form 36 groups of 1, between which a wave can lock.",
        "The casing has 420.3 Hz (2.9 kg, damping ratio 0.01), the bladed disk 155.9 Hz (5.4 kg",
        "The rotor turns at 890.118 rad/s. omega_c 528.165 rad/s (-40.7 % from here): critical speed",
        "Modes of the casing are known for 3 of 19 nodal diameters",
        "In the lock a blade tip pushes with up to ",
        "Checked: radius, clearance, tip speed, pulse and the push of a tip by their size; frequency, \
         modal mass and damping ratio of every mode, and their course over the diameters. Nothing \
         looks like a slip of a unit or a decimal point.",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let slips = ["check", &file, "--speed", "9500", "--set", "bladed_disk.blade_length_m=0.4"];
    let told = text(&slips).split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "These look like a slip:",
        "- The clearance (casing.radius_m less bladed_disk.blade_length_m) is 20.0000 mm",
        "- operation.speed_rad_s = 9500 (90718 rpm) moves the blade tips at 3990 m/s",
        "Was it rpm? Then write \"9500 rpm\".",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let missing = text(&["check", &file, "--nd", "7"]);
    assert!(missing.contains("No mode of the casing with 7 nodal diameters is known"), "{missing}");
    let own = text(&["check", "undamped", "--set", "casing.modes=[]"]);
    assert!(own.contains("One mode of the casing is given"), "{own}");
}

#[test]
fn a_damping_ratio_that_nobody_gave_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    let file = file.to_str().unwrap();
    let said = |words: &[&str]| {
        let output = rubscope(words);
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let casing = "rubscope: casing.damping_ratio: 0.05 is assumed (--zeta-casing)\n";
    let disk = "rubscope: bladed_disk.damping_ratio: 0.04 is assumed (--zeta-disk)\n";
    for (text, expected) in [
        ("schema = 1\n", [casing, disk].concat()),
        ("[casing]\ndamping_ratio = 0.05\n", disk.to_string()),
        (
            "[[casing.modes]]\nnodal_diameters = 3\ndamping_ratio = 0.01\n[bladed_disk]\ndamping_ratio = 0\n",
            String::new(),
        ),
    ] {
        std::fs::write(file, text).unwrap();
        for command in ["check", "survey", "margins"] {
            assert_eq!(said(&[command, file]), expected, "{command} {text}");
        }
        assert!(!said(&["check", file, "--zeta-disk", "0.04"]).contains("bladed_disk"), "{text}");
        assert!(!said(&["check", file, "--set", "casing.damping_ratio=0.05"]).contains("casing"));
    }
    assert_eq!(said(&["check", "adhesive"]), "");
}

/// The words of a new scene from a table.
fn of_table<'a>(file: &'a str, table: &'a str) -> Vec<&'a str> {
    let machine = ["--blades", "40", "--radius", "420mm", "--clearance", "0.3mm", "--nd", "2"];
    [&["new", file, "--modes", table][..], &machine, &["--range", "7000:12000", "--rpm"]].concat()
}

#[test]
fn an_ordinary_blade_family_is_taken_as_it_is_and_a_slip_is_shown_before_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let [table, good, odd, slipped] =
        ["min.csv", "good.toml", "odd.csv", "slipped.toml"].map(|name| folder.path().join(name));
    let family = "Structure;Nodal diameters;Frequency [Hz];Modal mass [kg]\ndisk;2;214;3,9\n\
                  disk;3;297,5;2,9\ndisk;8;378;2,25\ncasing;2;145;9,8\ncasing;3;272;9,1\n";
    std::fs::write(&table, format!("\u{feff}{family}")).unwrap();
    let made = rubscope(&of_table(good.to_str().unwrap(), table.to_str().unwrap()));
    let said = String::from_utf8_lossy(&made.stderr).into_owned();
    assert!(made.status.success() && !said.contains("slip"), "{said}");
    let assumed = "rubscope: Damping ratio of the bladed disk: 0.01 is assumed (--disk-damping)";
    assert!(said.contains(assumed), "{said}");
    let mut scene = Scene::load(good.to_str().unwrap()).unwrap();
    assert!((scene.operation.speed_rad_s / (9500.0 * TAU / 60.0) - 1.0).abs() < 1e-13);
    for (diameters, hertz, mass) in [(2, 214.0, 3.9), (3, 297.5, 2.9), (8, 378.0, 2.25)] {
        scene.operation.nodal_diameters = diameters;
        let machine = scene.machine();
        let tip = machine.blade_modal_mass / machine.blade_length.powi(2);
        assert!((machine.omega_bd / (TAU * hertz) - 1.0).abs() < 1e-12, "{diameters}");
        assert!((tip / mass - 1.0).abs() < 1e-12, "{diameters}");
    }
    std::fs::write(&odd, family.replace("297,5", "2,975")).unwrap();
    let made = rubscope(&of_table(slipped.to_str().unwrap(), odd.to_str().unwrap()));
    let said =
        String::from_utf8_lossy(&made.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
    let doubt = "- The frequency of the bladed disk is 2.975 Hz at 3 diameters and 214 Hz at 2.";
    assert!(made.status.success() && said.contains(doubt), "{said}");
    let told = text(&["check", slipped.to_str().unwrap()]);
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(told.contains(doubt) && !told.contains("Nothing looks"), "{told}");
}

#[test]
fn what_a_new_scene_does_not_use_of_its_table_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [table, file] = ["modes.csv", "mine.toml"].map(|name| folder.path().join(name));
    let rows = "Structure;Nodal diameters;Frequency [kHz];Mass [g];Speed [1/min];Tested by;Date\r\n\
                casing;2;0,145;9800;;me;\r\ndisk;2;0,352;3900;0;;\r\ndisk;2;0,4103;4100;10000;;\r\n";
    std::fs::write(&table, rows).unwrap();
    let [table, file] = [&table, &file].map(|path| path.to_str().unwrap());
    let made = rubscope(&of_table(file, table));
    let said = String::from_utf8(made.stderr).unwrap();
    assert!(made.status.success() && !said.contains("slip"), "{said}");
    for words in [
        "columns not used: Tested by, Date",
        "line 4, modal_mass_kg = 4.1 is not used: the line before of this mode has 3.9",
    ] {
        assert!(said.contains(&format!("rubscope: {table}: {words}\n")), "{said}");
    }
    let mut scene = Scene::load(file).unwrap();
    scene.set("operation.nodal_diameters", "2").unwrap();
    let turning = scene.machine().at(10000.0 * (TAU / 60.0)).omega_bd;
    assert!((turning / (TAU * 410.3) - 1.0).abs() < 1e-12);
}

#[cfg(unix)]
#[test]
fn a_name_that_is_no_text_is_refused_as_by_every_command() {
    use std::os::unix::ffi::OsStrExt;
    let name = std::ffi::OsStr::from_bytes(b"\xff.toml");
    let said = |command: &str| {
        let output = program().arg(command).arg(name).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(said("new"), said("check"));
    assert_eq!(said("new").lines().count(), 1);
}
