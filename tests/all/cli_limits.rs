//! What is refused before anything is computed: places, sizes and lengths; and that
//! a refusal stands alone.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use crate::cli_support::{json, program, refusal, rubscope, text, words};

fn message(arguments: &[&str]) -> (Option<i32>, String) {
    let output = rubscope(arguments);
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

/// Commands that would take minutes, or hours in a debug build.
const LONG: [&str; 4] = [
    "run undamped --end 20",
    "hbm --branches --speed 0:500:100000",
    "precision undamped --repeat 1000",
    "map --solver event --speed 0:500:3900 --pulse 1e5:1e6:3900",
];

#[test]
fn a_place_that_takes_no_file_is_said_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    let read_only = folder.path().join("mine.csv");
    fs::write(&read_only, "mine").unwrap();
    let mut permissions = fs::metadata(&read_only).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).unwrap();
    let mut places = vec![(read_only, "the file is read-only")];
    if cfg!(target_os = "linux") {
        // No folder where a superuser may make a file.
        places.push(("/proc/none.csv".into(), ""));
    }
    for command in LONG {
        for (place, reason) in &places {
            let place = place.to_str().unwrap();
            let arguments: Vec<&str> = command.split_whitespace().chain(["--out", place]).collect();
            let (status, said) = message(&arguments);
            assert_eq!(status, Some(1), "{said}");
            assert_eq!(said.lines().count(), 1, "{said}");
            assert!(
                said.starts_with(&format!("rubscope: cannot write {place}: {reason}")),
                "{said}"
            );
        }
    }
    // Of figures the last is tried too.
    let figure = folder.path().join("fig10.svg");
    fs::create_dir(&figure).unwrap();
    let (status, said) = message(&["figures", "--out", folder.path().to_str().unwrap()]);
    assert_eq!((status, said.lines().count()), (Some(1), 1), "{said}");
    assert!(said.contains("cannot write") && said.contains("fig10.svg"), "{said}");
    assert!(!folder.path().join("fig04.svg").exists());
}

#[test]
fn a_result_whose_folder_is_gone_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let [place, pipe] = ["results", "scene.toml"].map(|name| folder.path().join(name));
    fs::create_dir(&place).unwrap();
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let mut command = program();
    command.arg("hbm").arg(&pipe).arg("--out").arg(place.join("a.csv"));
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // The place is checked before the scene is read, and opening waits for the reader.
    let mut scene = fs::OpenOptions::new().write(true).open(&pipe).unwrap();
    fs::remove_dir(&place).unwrap();
    scene.write_all(rubscope_solver::scene::BUILTIN[0].toml.as_bytes()).unwrap();
    drop(scene);
    let output = child.wait_with_output().unwrap();
    assert!(output.stdout.starts_with(b"speed_rad_s,") && output.status.code() == Some(1));
}

#[test]
fn a_file_that_is_replaced_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let here = folder.path().to_str().unwrap();
    for (command, name, new, replaced) in [
        (
            "run --solver event --end 0.001 --out",
            "h.csv",
            "wrote 2000 rows to",
            "replaced {} (2000 rows)",
        ),
        ("hbm --speed 0:500:5 --out", "l.csv", "wrote 5 rows to", "replaced {} (5 rows)"),
        (
            "map --solver event --model rigid --speed 250:500:2 --pulse 1e5:2e5:2 --out",
            "m.csv",
            "wrote 4 rows to",
            "replaced {} (4 rows)",
        ),
    ] {
        let path = at(name);
        let arguments: Vec<&str> = command.split_whitespace().chain([&path[..]]).collect();
        let (status, said) = message(&arguments);
        assert_eq!(status, Some(0), "{said}");
        assert!(said.contains(&format!("rubscope: {new} {path}\n")), "{said}");
        let (_, said) = message(&arguments);
        let expected = format!("rubscope: {}\n", replaced.replace("{}", &path));
        assert!(said.contains(&expected), "{said}");
    }
    let figures = ["figures", "--only", "9", "--out", here];
    assert!(message(&figures).1.contains("rubscope: wrote fig09.svg"));
    assert!(message(&figures).1.contains("rubscope: replaced fig09.svg"));
}

#[test]
fn long_titles_and_notes_are_refused_by_their_length() {
    for (key, most) in [("title", 200), ("note", 4000)] {
        let text = |length: usize| format!("{key}={}", "\u{e9}".repeat(length));
        assert_eq!(
            refusal(&["run", "--set", &text(most + 1)]),
            format!(
                "rubscope: {key} = {} characters: allowed is a line of text of up to {most} characters",
                most + 1
            )
        );
        let (status, said) = message(&["run", "--end", "0.001", "--set", &text(most)]);
        assert_eq!(status, Some(0), "{said}");
        let file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
        fs::write(file.path(), format!("{key} = \"{}\"", "x".repeat(100_000))).unwrap();
        let said = refusal(&["run", file.path().to_str().unwrap()]);
        assert!(said.contains(&format!("{key} = 100000 characters: allowed")), "{said}");
    }
}

#[test]
fn a_refusal_stands_alone_and_what_was_changed_is_said_when_the_command_goes_on() {
    let took = "rubscope: took solver.kind = \"explicit\" instead of the scene's \"event\"";
    let changed = ["rocking", "--contact", "bilateral", "--end", "0.001"];
    for (before, after) in [
        (&["run"][..], &["--out", "a.xlsx"][..]),
        (&["run"], &["--at", "never"]),
        (&["map"], &["--threads", "0"]),
        (&["map"], &["--y", "operation.pulse_n=0:nan:5"]),
        (
            &["map"],
            &["--x", "operation.speed_rad_s=0:500:90000", "--y", "operation.pulse_n=0:1:9000"],
        ),
        (&["hbm"], &["--form", "printed", "--blades", "1,99"]),
        (&["precision"], &["--finest", "0"]),
        (&[], &[]),
    ] {
        let said = refusal(&[before, &changed, after].concat());
        assert!(!said.contains("took solver.kind"), "{said}");
    }
    let (status, said) = message(&[&["run"][..], &changed].concat());
    assert_eq!(status, Some(0), "{said}");
    assert!(said.starts_with(took) && said.lines().count() == 1, "{said}");
}

#[test]
fn a_picture_has_a_largest_number_of_cells() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.svg");
    let map = words("map --speed 0:500:2000 --pulse 0:1:2000 --out");
    let said = refusal(&[&map[..], &[path.to_str().unwrap()]].concat());
    let expected = "an .svg of 4000000 cells: allowed is up to 1000000 cells in a picture";
    assert!(said.contains(expected), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn two_axes_of_one_name_have_their_whole_names() {
    let command = "map --solver event --model rigid --x casing.damping_ratio=0:0.1:2 \
                   --y bladed_disk.damping_ratio=0:0.1:3 --no-sensitivity --json";
    let map = json(&words(command));
    assert_eq!(map["casing.damping_ratio"].as_array().unwrap().len(), 2);
    assert_eq!(map["bladed_disk.damping_ratio"].as_array().unwrap().len(), 3);
    assert_eq!(map["verdict"].as_array().unwrap().len(), 3);
}

#[test]
fn a_history_that_no_memory_holds_is_refused_at_once() {
    let run = "run --gaps --samples 1000000 --set bladed_disk.blades=4096 --out h.csv";
    let arguments: Vec<&str> = run.split(' ').collect();
    assert_eq!(
        refusal(&arguments),
        "rubscope: --samples = 1000000: allowed is up to 24348 with the gaps of 4096 blades: a \
         history has at most 100000000 values"
    );
    // Without the gaps it is small.
    let history = rubscope::report::History::most_samples;
    let more = (history(4096) + 1).to_string();
    let arguments = arguments.iter().map(|word| if *word == "1000000" { &more } else { *word });
    let said = refusal(&arguments.collect::<Vec<_>>());
    assert!(said.contains("allowed is up to 24348 with the gaps"), "{said}");
    assert!(history(0) > 1_000_000 && history(22) > 1_000_000);
}

#[test]
fn titles_are_of_characters_that_are_seen() {
    let letters =
        ['\u{34f}', '\u{115f}', '\u{17b4}', '\u{180c}', '\u{3164}', '\u{ffa0}', '\u{1d173}'];
    let marks = ['\u{7}', '\u{61c}', '\u{200b}', '\u{202e}', '\u{2060}', '\u{feff}', '\u{e0041}'];
    let controls = ['\u{1b}', '\u{9b}', '\u{2028}', '\u{fffe}'];
    for c in letters.into_iter().chain(marks).chain(controls) {
        let said = refusal(&["run", "--set", &format!("title=a{c}b")]);
        assert!(said.starts_with("rubscope: title = "), "{said}");
        assert!(said.ends_with("allowed is a line of text of up to 200 characters"), "{said}");
    }
    assert!(rubscope(&["run", "--end", "1e-4", "--set", "title=Ω e\u{301} 叶"]).status.success());
}

#[test]
fn an_end_below_one_step_is_refused_and_one_step_is_not() {
    let lines = [
        "run --end 1e-8 --step 1e-7",
        "run rub --end 1e-8 --step 1e-7",
        "map --speed 400:500:2 --pulse 1e4:2e4:2 --end 1e-8 --step 1e-7",
        "margins --end 1e-8 --step 1e-7",
    ];
    for line in lines {
        let said = refusal(&words(line));
        let expected = "solver.end_s = 1e-8: allowed is at least one step, solver.step_s = 1e-7";
        assert!(said.contains(expected) && said.lines().count() == 1, "{line}: {said}");
    }
    for line in ["run --end 1e-7 --step 1e-7", "run --solver event --end 1e-8 --step 1e-7"] {
        text(&words(line));
    }
}
