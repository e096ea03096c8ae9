//! The fields of the JSON reports, and the columns of the files, in the tables
//! of docs/formats.md: all of them, and none that is not there.

use std::collections::BTreeSet;

use rubscope_solver::study::margins::CLEARANCE;
use serde_json::Value;

use super::{Document, read};
use crate::cli_support::{rubscope, text, words};

fn names(fields: &[&str]) -> BTreeSet<String> {
    fields.iter().map(ToString::to_string).collect()
}

/// The dotted paths of all values; `[]` is each entry of an array.
fn paths(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    match value {
        // The scene has the keys of a scene file, and so have sensitivities.
        Value::Object(_) if path == "scene" || path.ends_with(".sensitivities") => {
            _ = found.insert(path.to_string())
        }
        Value::Object(map) => {
            for (name, inner) in map {
                let dot = if path.is_empty() { "" } else { "." };
                paths(inner, &format!("{path}{dot}{name}"), found);
            }
        }
        Value::Array(entries) => {
            // An empty one has no fields to tell.
            entries.iter().for_each(|inner| paths(inner, &format!("{path}[]"), found));
        }
        _ => _ = found.insert(path.to_string()),
    }
}

fn fields_of(commands: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for command in commands {
        // A run that fails has a report, too.
        let output = rubscope(&words(command));
        paths(&serde_json::from_slice(&output.stdout).unwrap(), "", &mut found);
    }
    found
}

/// The names in the first column of the table with this header, without their
/// code signs.
fn told(document: &Document, header: &str) -> BTreeSet<String> {
    let rows = document.table(header);
    let names = rows.iter().flat_map(|row| row[0].split(", "));
    names.map(|name| name.trim_matches('`').to_string()).collect()
}

#[test]
fn every_field_of_the_reports_is_in_the_documents() {
    let document = read("docs/formats.md");
    let common = told(&document, "| field of every report | what it is |");
    let map = "map slip --speed 300:500:2 --pulse 2e4:5e4:2 --json";
    let pressed = "--contact smooth --set casing.radius_m=0.49988 --set bladed_disk.radial_coupling=0.5 --set contact.stiffness_n_per_m=27e3";
    let soft = "--set bladed_disk.stiffness_nm_per_rad=1e-3 --speed";
    for (header, commands) in [
        (
            "| field of `rubscope.run/1` | what it is |",
            vec![
                "run --json --at 0.01:operation.pulse_n=10 --at 0.02:pulse --end 0.03",
                "run --json --end 0.001 --no-sensitivity",
                "run --contact unilateral --pulse 5e4 --step 1e-6 --json",
                "run --nd 11 --speed 100 --pulse 20000 --solver event --contact unilateral --model rigid --end 0.02 --json",
                "run --contact unilateral --set contact.restitution=0.3 --end 0.002 --json",
                "run --solver event --set bladed_disk.stiffness_nm_per_rad=1e12 --json",
                "run --solver event --set bladed_disk.radial_coupling=0.1 --json",
                "run --json --end 0.02 --step 1e-6 --no-sensitivity --contact unilateral --set bladed_disk.radial_coupling=-0.01 --set contact.friction=0.4 --set casing.tangential_ratio=0.2 --set bladed_disk.damping_ratio=0.0001 --speed 800 --pulse 0 --set initial.u_c_m=2.8462967654628568e-05 --set initial.u_s_m=9.693596572228599e-05 --set initial.v_c_m_s=-0.23264631773348637 --set initial.v_s_m_s=0.06831112237110856",
                "run --model full --nd 2 --contact unilateral --set contact.friction=0.3 --end 0.001 --json",
            ],
        ),
        ("| field of `rubscope.map/1` | what it is |", vec![map]),
        (
            "| field of `rubscope.survey/1` | what it is |",
            vec![
                "survey --range 200:500 --by casing.modal_mass_kg --set bladed_disk.radial_coupling=0.3 --json",
            ],
        ),
        (
            "| field of `rubscope.precision/1` | what it is |",
            vec![
                "precision grazing --finest 1e-6 --repeat 1 --json",
                "precision soft-lining --end 1e-3 --finest 1e-6 --repeat 1 --json",
            ],
        ),
        (
            "| field of `rubscope.margins/1` | what it is |",
            vec![
                "margins --nd 11 --model full --no-search --json",
                "margins --end 0.02 --json --target omega_c=300 --by casing.modal_mass_kg",
            ],
        ),
    ] {
        let commands: Vec<&str> = commands.to_vec();
        assert_eq!(&told(&document, header) | &common, fields_of(&commands), "{header}");
    }
    let inclined = "--set bladed_disk.radial_coupling=0.3 --speed";
    let lobed = format!("{pressed} --set casing.lobes=3 --set casing.out_of_round_m=5e-6 --speed");
    let base = told(&document, "| field of `rubscope.hbm/3` | what it is |");
    let smooth = told(&document, "| field added by `--smooth` | what it is |");
    for (view, command) in [
        // The second has a speed without a locked motion.
        ("without a view", format!("--model full --json;hbm {soft} 5e5:7e5:3")),
        ("by `--branches`", "--branches --json;hbm long-tip --branches --speed 300".to_string()),
        ("by `--slip`", "slip --slip --speed 300:500:3".to_string()),
        ("by `--excitation`", "--excitation --set excitation.amplitude_nm=10".to_string()),
        ("by `--smooth` with a preload", format!("--smooth {pressed} --speed 390:440:6")),
        ("by `--smooth` with a clearance", "soft-lining --smooth".to_string()),
        ("by `--coincidence`", format!("--coincidence {pressed} --speed 390:440:6")),
        ("by `--forced`", format!("--forced {lobed} 90")),
        ("by `--whirl`", format!("--whirl {inclined} 300:450:2")),
        ("by `--compliance`", format!("--compliance {inclined} 450")),
    ] {
        let commands = format!("hbm {command} --json");
        let all = fields_of(&commands.split(';').collect::<Vec<_>>());
        let own = &(&all - &base) - &common;
        let own = if view.contains("smooth") { &own - &smooth } else { own };
        let header = format!("| field added {view} | what it is |");
        assert_eq!(told(&document, &header), own, "{header}");
    }
}

/// The first line of a file that a command writes.
fn columns_of(arguments: &str, name: &str) -> BTreeSet<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    text(&[&words(arguments)[..], &["--out", path.to_str().unwrap()]].concat());
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.headers().unwrap().iter().map(String::from).collect()
}

#[test]
fn every_column_of_the_files_is_in_the_documents() {
    let document = read("docs/formats.md");
    let gaps: Vec<String> = (1..=22).map(|blade| format!("gap_{blade}_m")).collect();
    let without_gaps = |columns: BTreeSet<String>| -> BTreeSet<String> {
        let mut columns: BTreeSet<String> =
            columns.into_iter().filter(|name| !gaps.contains(name)).collect();
        columns.insert("gap_I_m".to_string());
        columns
    };
    let history = columns_of("run --end 1e-3 --samples 3 --gaps", "a.csv");
    assert!(gaps.iter().all(|name| history.contains(name)));
    let header = "| column of the history | what it is |";
    assert_eq!(told(&document, header), without_gaps(history));
    // All others have the names of fields, but for those that the page explains.
    let fields: BTreeSet<String> = document
        .text
        .lines()
        .filter(|line| line.starts_with("| `"))
        .flat_map(|line| line.split(" | ").next().unwrap().split('`').skip(1).step_by(2))
        .map(|path| path.replace("[]", "").rsplit('.').next().unwrap().to_string())
        .collect();
    let axes = names(&["speed_rad_s", "pulse_n"]);
    let map = columns_of("map slip --speed 400:500:2 --pulse 1e4:2e4:2 --no-sensitivity", "a.csv");
    assert!(axes.is_subset(&map));
    let margins = columns_of("margins", "a.csv");
    let paths: BTreeSet<String> =
        margins.iter().filter(|name| name.contains('.') || *name == CLEARANCE).cloned().collect();
    assert!(paths.len() > 5 && (&margins - &paths).is_subset(&fields), "{margins:?}");
    assert!(map.is_subset(&fields), "{map:?}");
    let explained = told(&document, "| column of a file | what it is |");
    let others = &fields - &explained;
    let mut found = BTreeSet::new();
    for command in [
        "hbm",
        "hbm --branches",
        "hbm --slip",
        "hbm --excitation --set excitation.amplitude_nm=10",
        "hbm --smooth --contact smooth --set casing.radius_m=0.49988",
        "hbm --smooth --contact smooth",
        "hbm --coincidence --speed 300:500:3",
        "hbm --whirl --speed 400:500:2",
        "hbm --compliance --set bladed_disk.radial_coupling=0.3",
        "precision grazing --finest 1e-6 --repeat 1",
        "survey",
    ] {
        found.extend(columns_of(command, "a.csv").difference(&others).cloned());
    }
    assert_eq!(found, explained);
}
