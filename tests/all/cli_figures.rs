//! `rubscope figures`: the files it writes and the numbers in them.

use std::path::Path;

use crate::cli_support::{refusal, rubscope};

fn figures(only: &str, more: &[&str]) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("made/here");
    let arguments = ["figures", "--out", path.to_str().unwrap(), "--only", only];
    let output = rubscope(&[&arguments[..], more].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    directory
}

/// A file as columns of numbers, by name; words are left out.
fn columns(directory: &Path, name: &str) -> Vec<(String, Vec<f64>)> {
    let mut reader = csv::Reader::from_path(directory.join("made/here").join(name)).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let records: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let column = |index| records.iter().filter_map(|row| row[index].parse().ok()).collect();
    names.into_iter().enumerate().map(|(index, name)| (name, column(index))).collect()
}

#[test]
fn figure_9_changes_sign_at_the_critical_speed() {
    let directory = figures("9", &[]);
    let columns = columns(directory.path(), "fig09.csv");
    let (speed, lambda) = (&columns[0].1, &columns[1].1);
    assert_eq!((speed.len(), speed[500]), (501, 500.0));
    assert!((lambda[500] - -150.855).abs() < 1e-3);
    // Omega_c = 292.88 rad/s.
    assert!(lambda[292] > 0.0 && lambda[293] < 0.0);
    let svg = std::fs::read_to_string(directory.path().join("made/here/fig09.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Omega_lock"));
}

#[test]
fn figure_10_has_a_casing_that_does_not_notice_the_speed() {
    let directory = figures("10", &[]);
    for (name, values) in &columns(directory.path(), "fig10a.csv")[1..] {
        // Blade angles of 1e-6 rad move the corner by about 1e-6 of its size.
        let change = values.iter().map(|x| (x / values[0] - 1.0).abs()).fold(0.0, f64::max);
        assert!(change < 1e-4, "{name} changes by {change}");
    }
    let angles = columns(directory.path(), "fig10b.csv");
    assert!((angles[1].1[500] - 7.62e-7).abs() < 1e-9, "the printed form");
}

#[test]
fn figures_in_time_have_their_samples() {
    let directory = figures("4,5,6,7", &["--end", "1e-3"]);
    let gaps = columns(directory.path(), "fig05.csv");
    assert_eq!(gaps.len(), 1 + 22);
    assert!(gaps.iter().all(|(_, values)| values.len() == 1501));
    assert_eq!(columns(directory.path(), "fig06a.csv")[1].0, "u_c_m");
    let steps = columns(directory.path(), "fig04.csv");
    assert_eq!(steps[2].1.len(), 3 * 1501);
}

#[test]
fn figure_8_has_a_verdict_for_every_cell() {
    let directory = figures("8", &["--end", "1e-3"]);
    assert_eq!(columns(directory.path(), "fig08a.csv")[1].1.len(), 51 * 31);
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    assert!(refusal(&["figures"]).contains("--out <DIR>"));
    let nowhere = ["figures", "--out", "unused", "--only"];
    assert_eq!(
        refusal(&[&nowhere[..], &["3"]].concat()),
        "rubscope: --only = 3: allowed is numbers from 4 to 10"
    );
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().to_str().unwrap();
    let without_corners = ["figures", "--out", path, "--only", "9", "--nd", "11"];
    assert!(refusal(&without_corners).starts_with("rubscope: figure 9: "));
}
