//! The page of `rubscope margins`, and what no format of it may have: numbers that are
//! none, and lines that do not fit.

use rubscope::report::margins as report;
use rubscope::report::table::WIDTH;
use rubscope_solver::motion::to_the_end;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;

use crate::cli_margins::{full, sheet, text};
use crate::cli_support::rubscope;
use crate::scene;

fn page(margins: &Margins) -> String {
    let mut out = Vec::new();
    sheet(margins).write_file("svg", &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// The lines of a page.
fn told(page: &str) -> Vec<String> {
    let texts = page.split("<text").skip(1).map(|rest| rest.split_once("</text>").unwrap().0);
    let plain = |text: &str| text.replace("&gt;", ">").replace("&lt;", "<").replace("&amp;", "&");
    texts.map(|text| plain(text.split_once('>').unwrap().1)).collect()
}

#[test]
fn the_page_says_what_the_text_says() {
    let margins = full(&scene("paper-nd3", &[("operation.speed_rad_s", "-430")]));
    let (page, text) = (page(&margins), text(&margins));
    let (lines, page_lines) = (text.lines().filter(|line| line.len() <= WIDTH), told(&page));
    for line in lines.filter(|line| !line.starts_with("Computed in ")) {
        assert!(page_lines.iter().any(|known| known == line), "{line}");
    }
    assert!(text.contains("411.934 rad/s"), "{text}");
    let command = "rubscope margins paper-nd3 --set operation.speed_rad_s=-430.0";
    assert!(page_lines.join(" ").contains(command), "{page_lines:?}");
    let described = page.split_once("<desc>").unwrap().1.split_once("</desc>").unwrap().0;
    assert!(described.contains(command) && described.contains("speed_rad_s = -430.0"));
}

/// Scenes at the edge of what there is.
fn odd() -> Vec<CheckedScene> {
    let long = "x".repeat(200);
    let heavy = format!("casing.modal_mass_kg=1e9;title={long};operation.pulse_n=1");
    let changes = [
        "operation.nodal_diameters=0",
        "operation.nodal_diameters=11",
        "casing.damping_ratio=0;bladed_disk.damping_ratio=0",
        "operation.pulse_n=0;title=",
        "operation.pulse_n=-3e5",
        "operation.pulse_s=0",
        "operation.speed_rad_s=0",
        "operation.speed_rad_s=-500",
        "operation.speed_rad_s=1e5;operation.pulse_n=1e12",
        "operation.speed_rad_s=1e-6;operation.pulse_n=1e-9",
        "casing.damping_ratio=10",
        &heavy,
        "casing.modal_stiffness_n_per_m=1e9;solver.step_s=1e-9",
        "initial.u_c_m=9.9e-5;initial.v_c_m_s=-0.05",
        "casing.radius_m=0.49990000001",
        "bladed_disk.stiffness_nm_per_rad=0.02;bladed_disk.coupling_nm_per_rad=0;\
         operation.speed_rad_s=1880",
        // It touches without a pulse.
        "initial.v_c_m_s=-1;operation.pulse_n=0",
    ];
    let known = |changes: &str| {
        let pairs: Vec<_> = changes.split(';').map(|it| it.split_once('=').unwrap()).collect();
        scene("paper-nd3", &pairs)
    };
    let critical = [("operation.speed_rad_s", "411.9335172932687"), ("operation.pulse_n", "0")];
    let others = [scene("undamped", &critical), scene("rocking", &[]), scene("run-down", &[])];
    changes.into_iter().map(known).chain(others).collect()
}

#[test]
fn odd_scenes_have_no_number_that_is_none_and_fit() {
    for scene in odd() {
        let margins = full(&scene);
        let (text, page) = (text(&margins), page(&margins));
        let mut csv = Vec::new();
        report::table(&margins).write_csv(&mut csv).unwrap();
        for file in [&text, &page, &String::from_utf8(csv).unwrap()] {
            for word in file.split(|c: char| !c.is_alphanumeric()) {
                assert!(!["NaN", "inf"].contains(&word), "{word} in {file}");
            }
            assert!(!file.contains("not a number"), "{file}");
        }
        for line in text.lines().filter(|line| !line.starts_with("Check it: ")) {
            assert!(line.chars().count() <= WIDTH, "{line}");
        }
        for line in told(&page) {
            assert!(line.chars().count() <= WIDTH, "{line}");
        }
    }
}

#[test]
fn files_are_what_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    let [csv, picture] = ["a.csv", "a.svg"].map(|name| directory.path().join(name));
    let mut margins = Margins::of(&scene("paper-nd3", &[("operation.speed_rad_s", "450")]));
    margins.ask_runs(&to_the_end, &mut |_| {}).unwrap();
    for file in [&csv, &picture] {
        let out = file.to_str().unwrap();
        let output = rubscope(&["margins", "--speed", "450", "--out", out]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let printed = String::from_utf8(output.stdout).unwrap();
        let without_cost = |text: &str| text.split_once("Computed in ").unwrap().0.to_string();
        assert_eq!(without_cost(&printed), without_cost(&text(&margins)));
    }
    let mut table = Vec::new();
    report::table(&margins).write_csv(&mut table).unwrap();
    assert_eq!(std::fs::read(csv).unwrap(), table);
    let picture = std::fs::read_to_string(picture).unwrap();
    let lines = told(&picture);
    let command = "rubscope margins paper-nd3 --set operation.speed_rad_s=450.0";
    assert!(lines.join(" ").contains(command), "{lines:?}");
    assert_eq!(lines[0], margins.scene.title);
}
