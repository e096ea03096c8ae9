//! The page of `rubscope margins`, and what no format of it may have: numbers that are
//! none, and lines that do not fit.

use rubscope::report::line::wrapped;
use rubscope::report::table::WIDTH;
use rubscope::report::{CommandLine, Provenance, margins as report, svg};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;

use crate::cli_margins::{full, scene, text};
use crate::cli_support::rubscope;

fn page(margins: &Margins) -> String {
    let scene = margins.scene.clone().into_scene();
    let origin = Provenance { command: CommandLine::new("margins", &scene), scene };
    let mut out = Vec::new();
    svg::write_margins(margins, &origin, &mut out).unwrap();
    String::from_utf8(out).unwrap()
}

/// One text of a page: where it is, how large, which end is there, and what it says.
struct Words {
    x: f64,
    size: f64,
    end: String,
    says: String,
}

fn attribute(tag: &str, name: &str) -> String {
    let start = tag.split_once(&format!(" {name}=\"")).unwrap().1;
    start.split_once('"').unwrap().0.to_string()
}

/// The texts of a page, without their tags.
fn told(page: &str) -> Vec<Words> {
    let texts = page.split("<text").skip(1).map(|rest| rest.split_once("</text>").unwrap().0);
    texts
        .map(|text| {
            let (tag, inside) = text.split_once('>').unwrap();
            let parts = inside.split('<').enumerate();
            let says = parts.map(|(place, part)| match part.split_once('>') {
                // Room after a subscript stands for a space.
                Some((tag, rest)) if tag.contains("dx=\"16\"") => format!(" {rest}"),
                Some((_, rest)) if place > 0 => rest.to_string(),
                _ => part.to_string(),
            });
            let says = says.collect::<String>().replace("&apos;", "'").replace("&quot;", "\"");
            let number = |name| attribute(tag, name).parse::<f64>().unwrap() / 4.0;
            Words {
                x: number("x"),
                size: number("font-size"),
                end: attribute(tag, "text-anchor"),
                says: says.trim().to_string(),
            }
        })
        .collect()
}

#[test]
fn the_page_says_and_draws_the_same() {
    let margins = full(&scene("paper-nd3", &[("operation.speed_rad_s", "-430")]));
    let page = page(&margins);
    let words = told(&page);
    let says = |what: &str| words.iter().any(|words| words.says == what);
    for what in [
        "411.934 rad/s".into(),
        "Ω_lock".replace('_', ""),
        "+4.4 %".into(),
        "&gt; 100 x".into(),
        "ζc +0.33 %".into(),
        "−6.94122 mN m".into(),
    ] {
        assert!(says(&what), "{what}");
    }
    let all: Vec<&str> = words.iter().map(|words| words.says.as_str()).collect();
    let all = all.join(" ");
    let command = "rubscope margins paper-nd3 --set operation.speed_rad_s=-430.0";
    for what in [
        "pulse of 1 MN for 50 µs",
        "N = 22, lb = 499.9 mm, mb = 0.20825 kg m², kb = 15 kN m/rad",
        "casing.damping_ratio = 0.0636674 puts omega_lock at 450 rad/s",
        command,
    ] {
        assert!(all.contains(what), "{what} is not in {all}");
    }
    let described = page.split_once("<desc>").unwrap().1.split_once("</desc>").unwrap().0;
    assert!(described.contains(command) && described.contains("speed_rad_s = -430.0"));
}

/// Scenes at the edge of what there is.
fn odd() -> Vec<CheckedScene> {
    let long = "x".repeat(200);
    let changes: [(&str, &[(&str, &str)]); 18] = [
        ("paper-nd3", &[("operation.nodal_diameters", "0")]),
        ("paper-nd3", &[("operation.nodal_diameters", "11")]),
        ("paper-nd3", &[("casing.damping_ratio", "0"), ("bladed_disk.damping_ratio", "0")]),
        ("paper-nd3", &[("operation.pulse_n", "0"), ("title", "")]),
        ("paper-nd3", &[("operation.pulse_n", "-3e5")]),
        ("paper-nd3", &[("operation.pulse_s", "0")]),
        ("paper-nd3", &[("operation.speed_rad_s", "0")]),
        ("paper-nd3", &[("operation.speed_rad_s", "-500")]),
        ("paper-nd3", &[("operation.speed_rad_s", "1e5"), ("operation.pulse_n", "1e12")]),
        ("paper-nd3", &[("operation.speed_rad_s", "1e-6"), ("operation.pulse_n", "1e-9")]),
        ("paper-nd3", &[("casing.damping_ratio", "10")]),
        (
            "paper-nd3",
            &[("casing.modal_mass_kg", "1e9"), ("title", &long), ("operation.pulse_n", "1")],
        ),
        ("paper-nd3", &[("casing.modal_stiffness_n_per_m", "1e9"), ("solver.step_s", "1e-9")]),
        ("paper-nd3", &[("initial.u_c_m", "9.9e-5"), ("initial.v_c_m_s", "-0.05")]),
        ("paper-nd3", &[("casing.radius_m", "0.49990000001")]),
        (
            "paper-nd3",
            &[
                ("bladed_disk.stiffness_nm_per_rad", "0.02"),
                ("bladed_disk.coupling_nm_per_rad", "0"),
                ("operation.speed_rad_s", "1880"),
            ],
        ),
        // It touches without a pulse.
        ("paper-nd3", &[("initial.v_c_m_s", "-1"), ("operation.pulse_n", "0")]),
        ("undamped", &[("operation.speed_rad_s", "411.9335172932687"), ("operation.pulse_n", "0")]),
    ];
    let known = |(name, changes)| scene(name, changes);
    changes.into_iter().map(known).chain([scene("rocking", &[]), scene("run-down", &[])]).collect()
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
        let height: f64 = attribute(&page, "height").parse().unwrap();
        assert!(height / 840.0 < 1.6, "{height} high");
        for words in told(&page) {
            // Letters of a wide font.
            let width = 0.59 * words.size * words.says.chars().count() as f64;
            let [left, right] = match words.end.as_str() {
                "start" => [words.x, words.x + width],
                "end" => [words.x - width, words.x],
                _ => [words.x - width / 2.0, words.x + width / 2.0],
            };
            assert!(left >= 5.0 && right <= 840.0, "{}: {left} {right}", words.says);
        }
    }
}

#[test]
fn files_are_what_is_printed() {
    let directory = tempfile::tempdir().unwrap();
    let [csv, picture] = ["a.csv", "a.svg"].map(|name| directory.path().join(name));
    let margins = Margins::of(&scene("paper-nd3", &[("operation.speed_rad_s", "450")]));
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
    let words: Vec<String> = told(&picture).into_iter().map(|words| words.says).collect();
    let command = "rubscope margins paper-nd3 --set operation.speed_rad_s=450.0";
    assert!(words.join(" ").contains(command), "{words:?}");
    assert_eq!(wrapped(&words[0], 100)[0], margins.scene.title);
}
