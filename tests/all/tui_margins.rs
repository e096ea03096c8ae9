//! The margins of the explorer: Enter jumps to a limit or selects a knob, and no scene and no
//! size is too odd for it.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use rubscope::tui::command::Command;
use rubscope::tui::{Effect, Marker, Theme};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{LimitName, Margins};

use crate::tui_support::{Session, scene};

/// A short run.
fn short() -> Scene {
    let mut scene = scene();
    scene.solver.end_s = 5e-3;
    scene
}

fn open(size: (u16, u16), scene: Scene) -> Session {
    let mut session = Session::open(size.0, size.1, scene, Theme::Dark, Marker::Braille);
    session.press("8");
    session
}

/// The line of a limit.
fn line(session: &Session, symbol: &str) -> String {
    let text = session.text();
    let beginning = ["▸", " ", "●"].map(|sign| format!("{sign}{symbol} "));
    let chart = |line: &str| {
        let at = beginning.iter().find_map(|start| line.find(start.as_str()))?;
        let knobs = usize::from(session.app.layout.size.0 >= 100) * 27;
        (line[..at].chars().count() == knobs).then(|| line[at..].to_string())
    };
    text.lines().find_map(chart).unwrap_or_else(|| panic!("no {symbol} in {text}"))
}

/// The cell under the cursor.
fn cell(session: &Session) -> [usize; 2] {
    session.app.margins_cell().unwrap()
}

fn selected(session: &Session) -> &'static str {
    session.app.selected().unwrap().path
}

#[test]
fn the_margins_follow_the_knobs_and_nothing_is_computed_while_they_are_closed() {
    let mut session = Session::open(120, 40, short(), Theme::Dark, Marker::Braille);
    session.press("");
    assert!(session.app.margins().is_none());
    session.press("8");
    session.select("casing.damping_ratio");
    session.press("\n0.1\n");
    session.press("");
    let lock = session.app.machine.lock_speed().unwrap();
    assert!(line(&session, "Ω_lock").contains(&format!("{lock:.2}")), "{}", session.text());
    assert!(line(&session, "Ω_lock").contains(" -"), "{}", session.text());
    session.press("4");
    session.press("\n0.02\n");
    let (live, old) = session.app.margins().unwrap();
    assert!(old && live.margins.scene.casing.damping_ratio == 0.1);
}

#[test]
fn enter_jumps_to_a_limit_and_undo_comes_back() {
    let mut session = open((120, 40), short());
    session.press("i");
    assert_eq!(cell(&session), [0, 0]);
    assert!(session.text().contains("Enter jump  "), "{}", session.text());
    session.press("jj\n");
    let lock = session.app.machine.lock_speed().unwrap();
    assert_eq!(session.app.scene.operation.speed_rad_s, lock);
    assert!(session.text().contains("speed 411.93 rad/s: Ω_lock"), "{}", session.text());
    assert_eq!(selected(&session), "operation.speed_rad_s");
    session.press("");
    assert!(line(&session, "Ω_lock").contains("+0.0 %"), "{}", session.text());
    session.press("u");
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
    session.press("");
    session.press("jjj\n");
    let touching = Margins::of(&session.app.scene).limit(LimitName::TouchingPulse).unwrap().value;
    assert_eq!(Some(session.app.scene.operation.pulse_n), touching);
    assert!(session.text().contains("pulse 3.795 kN: F that touches"), "{}", session.text());
}

#[test]
fn a_rotor_that_turns_backward_jumps_backward() {
    let mut scene = short();
    scene.operation.speed_rad_s = -430.0;
    let mut session = open((120, 40), scene);
    assert!(line(&session, "Ω_lock").contains("-4.2 %"), "{}", session.text());
    session.press("i\n");
    let critical = session.app.machine.critical_speed().unwrap();
    assert_eq!(session.app.scene.operation.speed_rad_s, -critical);
    assert!(session.text().contains("speed -292.88 rad/s: Ω_c"), "{}", session.text());
}

#[test]
fn enter_on_a_knob_selects_it_and_enter_elsewhere_types_a_value() {
    let mut session = open((120, 40), short());
    session.press("ijjlll");
    assert_eq!(cell(&session), [3, 2]);
    assert!(
        session.text().contains("1 % more of damping ζ_c: Ω_lock +0.33 % (1.3"),
        "{}",
        session.text()
    );
    assert!(session.text().contains("Enter select  "), "{}", session.text());
    session.press("\n");
    assert_eq!(selected(&session), "casing.damping_ratio");
    assert!(session.text().contains("damping ζ_c selected"), "{}", session.text());
    // The last row is a load: Enter selects what moves it most, from a folded group.
    session.press("hhhJJJkkkk\n");
    assert_eq!(selected(&session), "clearance");
    session.press("i\n150u\n");
    assert!((session.app.machine.clearance() - 150e-6).abs() < 1e-12);
}

#[test]
fn a_click_reads_a_row_and_a_second_one_jumps() {
    let mut session = open((120, 40), short());
    let click = |session: &mut Session, (column, row)| {
        let kind = MouseEventKind::Down(MouseButton::Left);
        let heard =
            session.app.mouse(&MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
        session.press("");
        heard
    };
    let coincidence = session.find("388.31");
    assert_eq!(click(&mut session, coincidence), Some(Effect::None));
    assert_eq!(cell(&session), [0, 3]);
    click(&mut session, coincidence);
    let speed = session.app.machine.dangerous_speed().unwrap();
    assert_eq!(session.app.scene.operation.speed_rad_s, speed);
    let (_, row) = session.find("411.93");
    click(&mut session, (118, row));
    assert_eq!(cell(&session), [3, 2]);
    click(&mut session, (118, row));
    assert_eq!(selected(&session), "casing.damping_ratio");
}

#[test]
fn the_columns_and_rows_that_have_no_room_are_said_or_left_out() {
    let mut session = open((80, 24), short());
    session.press("ij ");
    session.press("kj");
    for (width, height) in [(80, 24), (120, 40), (40, 12), (200, 50)] {
        session.resize((width, height));
        insta::assert_snapshot!(format!("margins_{width}x{height}"), session.text());
        assert!(session.text().contains("Enter jump  "), "{}", session.text());
    }
    session.resize((80, 13));
    session.press("i");
    assert!(session.text().contains("↓"), "{}", session.text());
    session.press("i");
    session.press(&"j".repeat(20));
    assert_eq!(cell(&session), [0, 13]);
    assert!(session.text().contains("↑"), "{}", session.text());
    assert!(line(&session, "e_max m=2").contains(" nm"), "{}", session.text());
}

#[test]
fn a_companion_has_the_symbols_per_cents_and_words_and_mono_needs_no_colour() {
    let mut scene = short();
    scene.view.charts = vec!["response".into(), "margins".into(), "gaps".into()];
    let mut session = Session::open(120, 40, scene.clone(), Theme::Dark, Marker::Braille);
    session.press(" ");
    assert!(session.text().contains("Ω_lock ") && session.text().contains("-17.6 %"));
    insta::assert_snapshot!("margins_companion", session.text());
    let mut plain = Session::open(120, 40, short(), Theme::Mono, Marker::Ascii);
    plain.press("8 i");
    let text = plain.text();
    assert!(text.is_ascii() && text.contains("Om_lock"), "{text}");
    insta::assert_snapshot!("margins_ascii", text);
}

#[test]
fn no_scene_is_too_odd() {
    let with = |set: &[(&str, &str)]| short().with(set).unwrap().into_scene();
    let scenes = [
        with(&[("operation.nodal_diameters", "0")]),
        with(&[("operation.nodal_diameters", "11")]),
        with(&[("casing.damping_ratio", "0"), ("bladed_disk.damping_ratio", "0")]),
        with(&[("operation.pulse_n", "0")]),
        with(&[("operation.pulse_n", "-50000")]),
        with(&[("operation.pulse_n", "1e-9")]),
        with(&[("operation.pulse_n", "1e12")]),
        with(&[("operation.speed_rad_s", "-500")]),
        with(&[("operation.speed_rad_s", "0")]),
        with(&[("operation.speed_rad_s", "1e5")]),
        with(&[("casing.modal_mass_kg", "1e-4"), ("casing.modal_stiffness_n_per_m", "1e7")]),
        with(&[("casing.damping_ratio", "3")]),
        with(&[("solver.end_s", "2e-7")]),
        with(&[("initial.u_c_m", "5e-5"), ("operation.pulse_n", "0")]),
    ];
    for (place, scene) in scenes.into_iter().enumerate() {
        let mut session = open((120, 40), scene);
        assert!(session.app.margins().is_some(), "scene {place}");
        session.press("i");
        for size in [(40, 12), (80, 24), (200, 50), (120, 40)] {
            session.resize(size);
            for keys in ["JJJJJ", "LLL", "KK", "HHH", "KKK"] {
                session.press(keys);
                let text = session.text();
                assert!(!text.contains("NaN") && !text.contains("inf"), "scene {place}: {text}");
            }
        }
        // Every row and every knob, from the first to the last.
        let rows = session.app.margins().unwrap().0.margins.limits.len();
        let step = |right, up| Command::Cursor { right, up, coarse: false };
        for _ in 0..rows {
            for _ in 0..4 {
                let before = session.app.scene.clone();
                session.app.act(Command::Open);
                assert!(session.app.scene.checked().is_ok(), "scene {place}");
                if session.app.scene != before {
                    session.app.act(Command::Undo);
                }
                assert_eq!(session.app.scene, before, "scene {place}");
                session.app.act(step(1, 0));
            }
            session.app.act(step(-4, -1));
        }
        session.press("");
    }
}

#[test]
fn where_there_is_no_limit_the_row_says_why() {
    let mut scene = short();
    scene.operation.nodal_diameters = 0;
    let mut session = open((120, 40), scene);
    assert!(line(&session, "Ω_c").contains("-"), "{}", session.text());
    session.press("i");
    assert!(!session.text().contains("Enter"), "{}", session.text());
    session.press("\n");
    assert!(session.text().contains("Ω_c: none: no wave turns"), "{}", session.text());
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
}

#[test]
fn the_survey_shows_every_number_of_diameters_and_enter_takes_one() {
    for size in [(80, 24), (120, 40)] {
        let mut session = Session::open(size.0, size.1, short(), Theme::Dark, Marker::Braille);
        session.press("D");
        session.press("");
        let text = session.text();
        let limits: &[&str] = if size.0 > 80 { &["139.84", "411.93", "303.42"] } else { &[] };
        let words = ["8 all diameters", ">3", "can lock: from 303.4 rad/s ......####"];
        for words in words.iter().chain(limits) {
            assert!(text.contains(words), "{words}: {text}");
        }
        let said = "At 500 rad/s waves of 3 and 4 nodal diameters can";
        assert!(
            text.contains(said)
                && text.contains("lock.")
                && !text.contains('…')
                && !text.contains("5?"),
            "{text}"
        );
        session.press("i↑");
        assert!(session.text().contains("▸ 4"), "{}", session.text());
        session.press("\n");
        assert_eq!(session.app.scene.operation.nodal_diameters, 4);
        let critical = session.app.machine.critical_speed().unwrap();
        assert!((critical - 256.12).abs() < 5e-3, "{critical}");
        session.press("\u{1b}");
        session.press("D");
        session.press("");
        let text = session.text();
        assert!(text.contains("Ω_lock") && !text.contains("all diameters"), "{text}");
    }
}

#[test]
fn where_blades_whirl_both_verdicts_fit_the_small_screen() {
    let mut scene = Scene::builtin("rub").unwrap();
    scene.solver.end_s = 1e-3;
    let mut session = Session::open(80, 24, scene, Theme::Dark, Marker::Braille);
    session.press("D");
    session.press("");
    let text = session.text();
    assert!(text.contains("can lock: 472.1 to 566.3 rad/s from 414.3 rad/s"), "{text}");
}

#[test]
fn speeds_are_told_in_the_chosen_unit_and_a_missing_mode_is_told() {
    let mut session = Session::open(120, 40, short(), Theme::Dark, Marker::Braille);
    session.press("U");
    let text = session.text();
    assert!(text.contains("speeds in rpm") && text.contains("4775 rpm"), "{text}");
    session.press("8");
    session.press("");
    assert!(session.text().contains("2796.78"), "{}", session.text());
    session.press("U");
    session.press("");
    assert!(session.text().contains("292.878") && session.text().contains("500 rad/s"));
    session.select("operation.nodal_diameters");
    session.press("\n5\n");
    assert!(session.text().contains("own mode: none known of n_d"), "{}", session.text());
}

#[test]
fn the_view_begins_with_how_robust_the_run_is() {
    for size in [(80, 24), (120, 40)] {
        let mut session = Session::open(size.0, size.1, short(), Theme::Dark, Marker::Braille);
        session.press(":");
        session.press("robust\n");
        session.press("");
        let text = session.text();
        let place = |words: &str| text.find(words).unwrap_or_else(|| panic!("no {words}\n{text}"));
        let sentence = place("500 rad/s, bilateral law: locked;");
        assert!(sentence < place("speed [rad/s]  adhesive? at 412.1"), "{text}");
        assert!(place("pulse [MN]") < place("limit   "), "{text}");
        if size.0 == 80 {
            place("Pushes only: slip.");
            continue;
        }
        assert!(place("pulse [MN]") < place("500 rad/s, pushes only, by events: slip;"), "{text}");
    }
}

#[test]
fn every_limit_stays_in_sight_below_it_over_the_whole_screen() {
    let mut session = open((120, 40), short());
    session.press("f");
    let (live, _) = session.app.margins().unwrap();
    assert!(live.margins.robust.is_some() && live.margins.pushes_only.is_some());
    let text = session.text();
    for limit in &live.margins.limits {
        let start = format!("{} ", limit.name.titles()[1]);
        let is_here = |row: &str| row.trim_start_matches([' ', '●']).starts_with(&start);
        assert!(text.lines().any(is_here), "{start}\n{text}");
    }
}

#[test]
fn the_survey_is_of_the_range_that_is_asked_for_in_the_unit_of_speeds() {
    let mut session = open((80, 24), short());
    session.press("D");
    assert!(session.text().contains(": range 200:600"), "{}", session.text());
    for (typed, said) in [
        ("range 200:300", "From 200 rad/s to 300 rad/s no wave can lock."),
        ("range 400 450", "From 400 rad/s to 450 rad/s waves of 3 and 4 nodal diameters can lock."),
        ("range 400rad/s 450 rad/s", "From 400 rad/s to 450 rad/s waves of 3 and 4"),
        ("range 2000 rpm 2900 rpm", "From 209.44 rad/s to 303.687 rad/s"),
        ("range 2000rpm:2900rpm", "From 209.44 rad/s to 303.687 rad/s"),
        ("range all", "At 500 rad/s waves of 3 and 4"),
    ] {
        session.press(&format!(":{typed}\n"));
        session.press("");
        let text = session.text().split_whitespace().collect::<Vec<_>>().join(" ");
        let rows: String = text.chars().filter(|c| !"│─".contains(*c)).collect();
        let survey = session.app.margins().unwrap().0.survey.clone().unwrap();
        assert_eq!(survey.range_rad_s, session.app.layout.range);
        assert!(!text.contains("of the knobs before"), "{text}");
        let answer = rubscope::report::survey::answer(&survey, false);
        assert!(answer.starts_with(said), "{answer}");
        assert!(rows.contains(&said[..20]), "{text}");
    }
    session.press(":range 7000:12000\n");
    let asked = session.app.status.as_deref().unwrap_or_default();
    assert!(asked.ends_with("Was it rpm? Then write 7000rpm:12000rpm."), "{asked}");
    session.press("U:range 2000 2900\n");
    session.press("");
    let range = session.app.layout.range.unwrap();
    session.press("DD");
    assert!(session.text().contains(": range 2000:6000"), "{}", session.text());
    session.press("U");
    assert!((range[1] - 2900.0 * std::f64::consts::TAU / 60.0).abs() < 1e-9, "{range:?}");
    session.press(":range 5:2\n");
    assert!(session.text().contains("range = 5:2: allowed is FROM:TO"), "{}", session.text());
    assert_eq!(session.app.layout.range, Some(range));
}
