//! `rubscope survey`: its text, its files, its ranges and its units. Its numbers are in
//! `golden_outputs`.

use rubscope_solver::harmonic::{Form, locked_motion};
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::{Survey, speed_range};

use crate::cli_support::{self, json, refusal, rubscope, words};
use crate::{close, scene};

fn text(line: &str) -> String {
    cli_support::text(&words(line))
}

#[test]
fn the_lock_speed_of_a_row_is_that_of_its_own_blades() {
    let soft =
        [("bladed_disk.stiffness_nm_per_rad", "0.02"), ("bladed_disk.coupling_nm_per_rad", "0")];
    for (changes, bends) in [(&soft[..], true), (&[][..], false)] {
        let scene = scene("paper-nd3", changes);
        let row = &Survey::of(&scene, None, None).unwrap().rows[3];
        let lock = row.locks_in_range.as_ref().unwrap()[0][0];
        assert_eq!(Some(lock), Margins::of(&scene).limit(LimitName::OmegaLock).unwrap().value);
        let rigid = scene.machine().lock_speed().unwrap();
        assert_eq!((lock / rigid - 1.0).abs() > 2e-3, bends, "{lock} {rigid}");
        let here = |speed: f64| {
            locked_motion(&scene.machine(), Form::Modal, true, None, &[speed]).unwrap().points[0]
        };
        let beside = [0.997, 1.003].map(|part| here(lock * part).stable);
        assert_eq!(beside, [false, true]);
    }
}

/// The lines of the rows, without spaces at their beginning.
fn rows_of(text: &str) -> Vec<&str> {
    let rows = text.lines().skip_while(|line| !line.starts_with("n_d")).skip(1);
    rows.take_while(|line| !line.is_empty()).map(str::trim_start).collect()
}

#[test]
fn a_row_says_first_where_it_can_lock_also_where_the_limit_lies_below_the_range() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = crate::own_machine::made(folder.path());
    let told = |range: &str| text(&format!("survey {file} --rpm --range {range}"));
    let whole = told("6000:11000");
    let said = "From 6000 rpm to 11000 rpm waves of 4, 5 and 6 nodal diameters can lock.";
    assert!(whole.contains(said), "{whole}");
    let rows = rows_of(&whole);
    for (row, start) in rows.iter().zip(["4 ", ">5 ", "6 "]) {
        assert!(row.starts_with(start) && row.contains(" can lock: whole range  ####"), "{whole}");
    }
    assert!(rows[3].starts_with("16 more have no modes of their own: --all"), "{whole}");
    // Omega_lock of 4, 5 and 6 is 4790, 5653 and 5432 rpm: the first one that locks stands first.
    let part = told("4700:5500");
    let rows = rows_of(&part);
    for (row, start) in rows.iter().zip(["4 ", "6 ", ">5 "]) {
        assert!(row.starts_with(start), "{part}");
    }
    assert!(rows[0].contains("can lock: from 4790 rpm  ..####"), "{part}");
    assert!(rows[1].contains("can lock: from 5432 rpm  ................"), "{part}");
    assert!(rows[2].contains("no lock") && !rows[2].contains('#'), "{part}");
    let json = json(&["survey", &file, "--range", "4700rpm:5500rpm", "--json"]);
    let row = &json["rows"][4];
    let lock = row["limits"].as_array().unwrap().iter().find(|one| one["name"] == "omega_lock");
    assert_eq!(
        row["locks_in_range"][0],
        serde_json::json!([lock.unwrap()["value"], json["range_rad_s"][1]])
    );
    assert_eq!(json["rows"][5]["locks_in_range"], serde_json::json!([]));
}

#[test]
fn tips_that_move_outward_whirl_from_where_whirl_begins_or_the_range() {
    let whirls = |words: &str, diameters: usize| {
        let survey = json(&words.split(' ').chain(["--json"]).collect::<Vec<_>>());
        let found = survey["rows"][diameters]["whirls_in_range"].as_array().unwrap().clone();
        found.iter().map(|speed| speed.as_f64().unwrap()).collect::<Vec<_>>()
    };
    let begins = whirls("survey rub --range 300:500", 3);
    assert!((begins[0] / 414.339 - 1.0).abs() < 1e-6 && begins.len() == 1, "{begins:?}");
    // It does not end there.
    assert_eq!(whirls("survey rub --range 450:500", 3), [450.0]);
    assert!(whirls("survey rub --range 300:400", 3).is_empty());
    // On a lining that is pressed at rest the coincidence is known.
    let felt = whirls("survey coincidence --range 300:500", 3);
    assert!((felt[0] / 388.315 - 1.0).abs() < 1e-6 && felt.len() == 1, "{felt:?}");
    assert!(whirls("survey coincidence --range 300:380", 3).is_empty());
    // The paper's tips do not move outward.
    assert!(whirls("survey paper-nd3 --range 300:500", 3).is_empty());
    let told = text("survey coincidence --range 300:500");
    assert!(rows_of(&told)[1].contains("no lock  388.3 rad/s  ........w..."), "{told}");
    assert!(text("survey rub").contains("  from 414.3 rad/s  "));
}

#[test]
fn what_is_not_known_of_a_shape_is_not_told_as_no_lock() {
    let words = "survey paper-nd3 --set casing.lobes=2 --set casing.out_of_round_m=1e-6";
    let told = text(words);
    let said = told.lines().take(4).collect::<Vec<_>>().join(" ");
    assert!(said.contains("At 500 rad/s it is not known whether a wave can lock"), "{told}");
    assert!(said.contains("a run at a speed tells"), "{told}");
    assert!(!told.contains("no wave can lock") && !told.contains("no lock"), "{told}");
    assert!(rows_of(&told)[0].contains("not known: a run tells"), "{told}");
    let survey = json(&words.split(' ').chain(["--json"]).collect::<Vec<_>>());
    assert!(survey["rows"][3]["locks_in_range"].is_null());
    assert_eq!(survey["rows"][0]["locks_in_range"], serde_json::json!([]));
}

#[test]
fn rows_without_modes_of_their_own_come_with_all_of_them_and_are_drawn_hollow() {
    let few = text("survey paper-nd3 --range 200:320");
    assert_eq!(rows_of(&few).len(), 3, "{few}");
    let all = text("survey paper-nd3 --range 200:320 --all");
    assert!(rows_of(&all).len() == 12 && all.contains(" 5? "), "{all}");
    assert!(all.lines().all(|line| line.chars().count() <= 110), "{all}");
    // The row of the scene is there, whatever it has.
    assert!(text("survey paper-nd3 --nd 5").contains(">5? "));
    let survey = Survey::of(&scene("paper-nd3", &[]), None, None).unwrap();
    let figure = |all| rubscope::report::survey::figure(&survey, all);
    let points = |all| {
        let [of, _] = &figure(all).panels[..] else { panic!() };
        of.series[..4].iter().map(|series| series.points.len()).collect::<Vec<_>>()
    };
    assert_eq!(points(false), [2, 0, 2, 0]);
    assert_eq!(points(true), [2, 10, 2, 10]);
    // A mark that is left out is counted.
    assert!(
        figure(true).note.contains("2 limits beyond 1000 rad/s left out."),
        "{}",
        figure(true).note
    );
}

#[test]
fn a_bare_speed_is_in_rpm_with_the_option_and_keys_and_other_units_stay() {
    let json = |words: String| json(&words.split(' ').collect::<Vec<_>>());
    let speed = |words: &str| {
        let run = json(format!("{words} --json"));
        run["scene"]["operation"]["speed_rad_s"].as_f64().unwrap()
    };
    let turns = 4500.0 * (std::f64::consts::TAU / 60.0);
    for (words, expected) in [
        ("margins --rpm --speed 4500", turns),
        ("margins --rpm --speed 4.5k", turns),
        ("margins --speed 4500rpm", turns),
        ("margins --rpm --speed 75Hz", turns),
        ("margins --rpm --speed 450rad/s", 450.0),
        ("margins --rpm --set operation.speed_rad_s=450", 450.0),
        ("margins --speed 450", 450.0),
        ("run --rpm --speed 4500 --end 0.001", turns),
    ] {
        assert!((speed(words) / expected - 1.0).abs() < 1e-14, "{words}");
    }
    // Every option that takes speeds, and the command in JSON gives the same again.
    for (bare, with_unit, command) in [
        ("survey --range 2000:3000", "survey --range 2000rpm:3000rpm", "--range 2000rpm:3000rpm"),
        ("hbm --speed 4000:5000:3", "hbm --speed 4000rpm:5000rpm:3", "--speed 4000rpm:5000rpm:3"),
        (
            "margins --target omega_c=3000 --by casing.modal_mass_kg",
            "margins --target omega_c=3000rpm --by casing.modal_mass_kg",
            "--target omega_c=3000rpm",
        ),
    ] {
        let [mut in_rpm, mut same] =
            [json(format!("{bare} --rpm --json")), json(format!("{with_unit} --json"))];
        assert!(in_rpm["program"]["command"].as_str().unwrap().contains(command), "{in_rpm}");
        for found in [&mut in_rpm, &mut same] {
            found["cost"] = serde_json::Value::Null;
            found["wall_s"] = serde_json::Value::Null;
        }
        assert_eq!(in_rpm, same, "{bare}");
    }
    let told = text("margins --rpm --speed 4500");
    assert!(told.contains("4500 rpm"), "{told}");
    let columns = text("map --rpm --speed 4000:5000:2 --pulse 1e4:2e4:2 --end 0.001");
    assert!(columns.contains("operation.speed_rpm") && columns.contains(" 4000 5000"), "{columns}");
}

#[test]
fn speeds_are_told_in_turns_a_minute_where_that_is_wanted() {
    let told = text("survey paper-nd3 --range 2000rpm:3000rpm --rpm");
    let joined = told.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in ["speeds in rpm", "From 2000 rpm to 3000 rpm", "2796.8"] {
        assert!(joined.contains(words), "{words}: {told}");
    }
    assert!(!told.contains("rad/s"), "{told}");
    let run = text("run paper-nd3 --rpm --end 0.001");
    for words in ["at 4774.65 rpm", "Omega_c (2796.78 rpm"] {
        assert!(run.contains(words), "{words}: {run}");
    }
    let hbm = text("hbm paper-nd3 --rpm --speed 450:500:2");
    assert!(hbm.contains("Critical speed 2796.78 rpm") && hbm.contains("speed_rpm"), "{hbm}");
    let margins = text("margins paper-nd3 --rpm");
    assert!(margins.contains("2796.78 rpm") && !margins.contains("rad/s"), "{margins}");
    // Files and JSON stay as they are.
    let whole = |words: &str| {
        let mut value = json(&words.split(' ').collect::<Vec<_>>());
        value["wall_s"] = serde_json::Value::Null;
        value
    };
    assert_eq!(whole("survey paper-nd3 --json --rpm"), whole("survey paper-nd3 --json"));
}

#[test]
fn the_survey_is_written_as_csv() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("s.csv");
    let file = csv.to_str().unwrap();
    let words = ["survey", "paper-nd3", "--range", "200:320", "--out", file];
    assert!(rubscope(&words).status.success());
    let csv = std::fs::read_to_string(csv).unwrap();
    assert!(csv.starts_with("nodal_diameters,omega_c_rad_s,omega_bd_rad_s,name,value_rad_s,"));
    let four = csv.lines().find(|line| line.starts_with("4,") && line.contains(",omega_c,"));
    let value: f64 = four.unwrap().split(',').nth(4).unwrap().parse().unwrap();
    close(value, 256.12, 1e-5);
    assert!(four.unwrap().contains(",true,"), "{four:?}");
}

#[test]
fn a_range_that_is_none_is_refused_by_name() {
    assert_eq!(speed_range("--range", "0:60 rpm").unwrap()[1], std::f64::consts::TAU);
    for (words, start) in [
        (
            "survey --range 11000rpm:6000rpm",
            "rubscope: --range = 11000rpm:6000rpm: allowed is FROM:",
        ),
        (
            "survey --range 5",
            "rubscope: --range = 5: allowed is FROM:TO, two speeds, the lower one",
        ),
        ("survey --range 0:3kN", "rubscope: --range = 0:3kN: this is a force; it takes rad/s, rpm"),
        ("survey --range 0:nan", "rubscope: --range = 0:nan: allowed is FROM:TO"),
        ("survey --by casing", "rubscope: parameter casing: allowed is one of clearance, "),
        ("survey --out x.txt", "rubscope: --out"),
    ] {
        let said = refusal(&words.split(' ').collect::<Vec<_>>());
        assert!(said.starts_with(start), "{said}");
    }
}

#[test]
fn a_survey_takes_no_range_that_is_none() {
    let scene = scene("paper-nd3", &[]);
    let nan = f64::NAN;
    for range in [[nan, 300.0], [200.0, nan], [300.0, 200.0], [5.0, 5.0], [0.0, f64::INFINITY]] {
        let refused = Survey::of(&scene, Some(range), None).unwrap_err().to_string();
        let start = format!("range = {}:{}: allowed is FROM:TO, two speeds", range[0], range[1]);
        assert!(refused.starts_with(&start), "{refused}");
    }
    // A rotor that turns backward.
    assert!(!Survey::of(&scene, Some([-600.0, -200.0]), None).unwrap().is_forward());
}

#[test]
fn thousands_of_blades_have_a_row_each() {
    let blades = [("bladed_disk.blades", "4096")];
    let survey = Survey::of(&scene("paper-nd3", &blades), Some([1.0, 2.0]), None).unwrap();
    assert_eq!(survey.rows.len(), 2049);
    let told = text("survey paper-nd3 --set bladed_disk.blades=4096 --range 1:2 --all");
    assert!(told.contains(" more: --json or --out") && told.lines().count() < 100, "{told}");
}

#[test]
fn the_limits_say_of_which_tips_they_are_and_what_scatter_does() {
    let scattered = "Tips that differ by 1 % of the clearance lock from 360.5 rad/s on instead of 411.9 \
                     rad/s, the mean of 200 rotors.";
    for command in ["survey", "check"] {
        let told = |scene| {
            let text = text(&format!("{command} {scene}"));
            text.split_whitespace().collect::<Vec<_>>().join(" ")
        };
        let of = |scene, tips| {
            told(scene).contains(&format!("The limits are those of {tips}. {scattered}"))
        };
        assert!(
            of("paper-nd3", "equal tips in a round casing, which lock last"),
            "{}",
            told("paper-nd3")
        );
        let own = "the tips and the casing of the scene. Equal tips in a round casing lock last";
        assert!(of("long-tip", own), "{}", told("long-tip"));
        // Equal tips on a lining have another lock.
        assert!(!told("oval").contains("differ by 1 %"), "{}", told("oval"));
    }
    // Of another machine it is another speed: twice the diameters turn at half of it.
    let own = Survey::of(&scene("paper-nd3", &[("operation.nodal_diameters", "6")]), None, None);
    let found = own.unwrap().scattered.unwrap();
    assert!(found.mean_rad_s < found.equal_rad_s && found.equal_rad_s < 200.0, "{found:?}");
}

#[test]
fn soft_blades_are_told_of_the_sense_of_the_range() {
    let soft = "survey --contact unilateral --nd 3 --range=-900:-100 \
                --set bladed_disk.stiffness_nm_per_rad=65.4 --set bladed_disk.coupling_nm_per_rad=2.28 \
                --set bladed_disk.inertia_kg_m2=0.005124 --set bladed_disk.radial_coupling=0.0407 \
                --set contact.friction=0.05 --speed";
    let told = ["500", "-500"].map(|speed| {
        let text = text(&format!("{soft}={speed}"));
        let row = text.lines().find(|line| line.starts_with(" 4  ")).unwrap();
        row.split_whitespace().take(7).collect::<Vec<_>>().join(" ")
    });
    assert!(told[0].starts_with("4 can lock: "), "{told:?}");
    assert_eq!(told[0], told[1]);
}
