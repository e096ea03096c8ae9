//! Names of files with characters that a terminal would obey or that are not seen: no output has
//! them as they are, and no file of such a name is written.

use std::io::Write;
use std::process::Stdio;

use rubscope_solver::scene::Scene;
use rubscope_solver::scene::keys::is_plain;

use crate::cli_support::program;

/// Sequences of control, bidirectional and zero-width characters.
const ODD: [&str; 20] = [
    "\u{1b}]0;own\u{7}",
    "\u{1b}[2J",
    "\u{9b}1m",
    "\u{7}",
    "\r",
    "\u{8}",
    "\u{7f}",
    "\u{85}",
    "\ndone: forged",
    "\t",
    "\u{202e}",
    "\u{2066}",
    "\u{200f}",
    "\u{61c}",
    "\u{200b}",
    "\u{200d}",
    "\u{2060}",
    "\u{feff}",
    "\u{2028}",
    "\u{e0041}",
];

#[test]
fn no_output_has_a_character_of_a_name_that_a_terminal_would_obey() {
    let folder = tempfile::tempdir().unwrap();
    let names: Vec<String> = ODD
        .iter()
        .flat_map(|odd| [format!("{odd}a"), format!("a{odd}b"), format!("a{odd}")])
        .collect();
    let written = |name: &str| folder.path().join(format!("{name}.toml"));
    let assert_plain = |what: &str, bytes: &[u8]| {
        let text = String::from_utf8(bytes.to_vec()).unwrap();
        assert!(text.chars().all(|c| c == '\n' || is_plain(c)), "{what:?}: {text:?}");
        assert!(!text.lines().any(|line| line.starts_with("done: forged")), "{what:?}: {text:?}");
    };
    let new = "--blades 36 --radius 420mm --clearance 0.3mm --nd 5 --range 600:1100";
    let new = format!("{new} --casing 5:420.3:2.9 --disk 5:155.9Hz:5.4kg");
    let map = "--speed 400:500:2 --pulse 1e4:2e4:2 --end 1e-5 --no-sensitivity";
    let mut typed = String::from("scene\n");
    let mut scene = Scene::base();
    scene.solver.end_s = 1e-5;
    for (place, name) in names.iter().enumerate() {
        std::fs::write(written(name), scene.to_toml()).unwrap();
        for line in ["open", "scene", "save", "export"] {
            typed.push_str(&format!("{line} {name}.toml\n"));
        }
        let (file, table) = (format!("{name}.toml"), format!("{name}.csv"));
        let commands = [("check", ""), ("new", &new), ("map", map)];
        // At the ends of a name the first command judges, in its middle all do.
        for (command, options) in commands.into_iter().take(if place % 3 == 1 { 3 } else { 1 }) {
            let mut run = program();
            run.current_dir(folder.path()).args([command, &file]).args(options.split_whitespace());
            if command == "map" {
                run.args(["--out", &table]);
            }
            let ended = run.output().unwrap();
            assert_plain(command, &[ended.stdout, ended.stderr].concat());
            assert!(command != "new" || !ended.status.success(), "{file:?}");
        }
    }
    let mut lines = program();
    lines.current_dir(folder.path()).args(["--lines", "--no-config"]);
    lines.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = lines.spawn().unwrap();
    child.stdin.take().unwrap().write_all(typed.as_bytes()).unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_plain("--lines", &[ended.stdout, ended.stderr].concat());
}
