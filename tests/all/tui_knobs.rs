//! The knobs of the explorer: turned, typed, in groups, with their bars.

use std::f64::consts::TAU;

use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::ContactLaw;

use crate::tui_support::{Session, scene};

#[test]
fn a_knob_changes_the_verdict_and_undo_brings_it_back() {
    let mut session = Session::open(100, 30, scene(), Theme::Dark, Marker::Braille);
    assert!(session.text().contains(" LOCKED "), "{}", session.text());
    session.select("solver.contact");
    session.press("l");
    assert!(session.text().contains(" DECAY "), "{}", session.text());
    session.press("u");
    assert!(session.text().contains(" LOCKED "), "{}", session.text());
}

#[test]
fn inclined_tips_take_the_law_that_only_pushes_with_them_and_undo_is_one_step() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    let before = session.app.scene.clone();
    assert_eq!(before.solver.contact, ContactLaw::Bilateral);
    session.select("bladed_disk.radial_coupling");
    session.press("l");
    let scene = &session.app.scene;
    assert!(scene.bladed_disk.radial_coupling > 0.0);
    assert_eq!(scene.solver.contact, ContactLaw::Unilateral);
    let said = "contact is now unilateral: the bilateral law takes no inclined tips";
    assert!(session.text().contains(said), "{}", session.text());
    session.press("u");
    assert_eq!(session.app.scene, before);
    // The law itself is refused by name where the tips are inclined.
    session.press("l");
    session.select("solver.contact");
    session.press("h");
    assert!(session.app.knobs.refusal.as_ref().unwrap().contains("inclined tips"));
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Unilateral);
}

#[test]
fn a_typed_value_that_is_refused_says_so_in_place() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("\nfast\n");
    let text = column(&session);
    assert!(text.contains("speed Ω: fast is not a\nnumber; from -1e6 to 1e6\nrad/s"), "{text}");
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
    session.press("\u{1b}\n-430\n");
    assert_eq!(session.app.scene.operation.speed_rad_s, -430.0);
    session.select("bladed_disk.blades");
    session.press("\n0\n");
    let text = column(&session);
    assert!(text.contains("blades N: 0 is not"), "{text}");
}

#[test]
fn a_damping_acts_on_the_running_motion_and_the_number_of_blades_begins_anew() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    let before = session.app.now();
    session.select("casing.damping_ratio");
    session.press("cxL");
    assert!(session.app.now() > before, "the run restarted");
    assert!(session.app.scene.casing.damping_ratio > scene().casing.damping_ratio);
    session.press("u");
    let later = session.app.now();
    assert!(later > before && *session.app.scene == scene(), "undo restarted the run");
    session.select("bladed_disk.blades");
    session.press("l");
    assert_eq!(session.app.scene.bladed_disk.blades, 23);
    assert!(session.app.now() < later && session.text().contains("restarted"));
}

/// The column of knobs, without the charts.
fn column(session: &Session) -> String {
    let text = session.text();
    let rows = text.lines().skip(2);
    rows.map(|row| row.chars().take(26).collect::<String>().trim_end().to_string() + "\n").collect()
}

#[test]
fn the_operation_is_whole_and_the_group_of_the_selected_knob_is_open() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    let labels = ["speed", "pulse F", "n_d", "ζ_c", "ζ_bd", "contact", "solver"];
    let text = column(&session);
    assert!(labels.iter().all(|label| text.contains(label)), "{text}");
    for (group, path, label) in [
        ("time 2 ▸", "operation.pulse_s", "pulse time"),
        ("model 3 ▸", "solver.step_s", "step h"),
        ("machine 9 ▸", "casing.radius_m", "casing R_c"),
        ("start 6 ▸", "excitation.order", "EO order"),
    ] {
        let text = column(&session);
        assert!(text.contains(group) && !text.contains(&format!("▸{label}")), "{text}");
        session.select(path);
        session.press("");
        let text = column(&session);
        assert!(!text.contains(group) && text.contains(&format!("▸{label}")), "{text}");
    }
}

#[test]
fn the_selected_knob_is_in_sight_at_every_size() {
    for (width, height) in [(66, 12), (80, 15), (80, 24), (120, 40), (200, 50)] {
        let mut session = Session::open(width, height, scene(), Theme::Dark, Marker::Braille);
        // Nobody has a hundred knobs: the selection comes back to the first.
        for turn in 0..100 {
            let text = session.text();
            let signs =
                text.split('▸').skip(1).filter(|rest| rest.starts_with(char::is_alphabetic));
            assert_eq!(signs.count(), 1, "{text}");
            if turn > 0 && session.app.knobs.selected == 0 {
                break;
            }
            session.press("j");
        }
        assert_eq!(session.app.knobs.selected, 0);
    }
}

#[test]
fn bars_show_the_value_and_its_limits_in_every_alphabet() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    let text = column(&session);
    assert!(text.contains("▕▒▒▒▒▒▒▒▒▒▒┃┃▒▒┃┃▒▒█▁▁▁▁▏"), "{text}");
    assert_eq!(text.matches('▕').count(), 1, "only the selected knob has a bar: {text}");
    session.press("j");
    let text = column(&session);
    assert!(text.contains("┃▒▒▒▒▒▒▒▒▒█"), "{text}");
    session.press("k");
    // A limit beyond the value has its tick in the part that is not filled.
    session.press("\n350\n");
    let text = column(&session);
    assert!(text.contains("┃┃█▁┃┃") && text.contains("Now just below the"), "{text}");
    session.press("\n430\n");
    assert!(column(&session).contains("Now just above Ω_lock."), "{}", column(&session));
    let session = Session::open(100, 24, scene(), Theme::Mono, Marker::Ascii);
    let text = column(&session);
    assert!(text.contains("[==========||==||==#....]"), "{text}");
}

#[test]
fn a_knob_without_effect_is_dim_says_why_and_stands_in_brackets() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    assert!(!column(&session).contains("no effect"), "{}", column(&session));
    session.select("solver.kind");
    session.press("l");
    session.select("solver.step_s");
    session.press("");
    let text = column(&session);
    assert!(text.contains("(200 ns)") && text.contains("no effect now: the event"), "{text}");
}

/// Up and Down step through the strip and on to the other knobs, which are listed over the charts.
#[test]
fn a_narrow_screen_has_the_knobs_as_a_strip_and_lists_the_others() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    let strip = |session: &Session| session.rows()[2..4].join("\n");
    let first = "▸Ω 500 rad/s  F 1 MN  n_d 3  ζ_c 0.05  ζ_bd 0.04  contact bilateral  more ▸";
    assert!(strip(&session).contains(first), "{}", strip(&session));
    assert!(
        strip(&session).contains("┃▒▒▒▒▒▒▒▒█▁▁") && strip(&session).contains("▏ 0 to 618 rad/s")
    );
    session.press("\n430\n");
    assert!(strip(&session).contains("▸Ω* 430 rad/s"), "{}", strip(&session));
    assert!(strip(&session).contains("just above Ω_lock"), "{}", strip(&session));
    session.press("\nfast\n");
    assert!(strip(&session).contains("speed Ω: fast is not a number;"), "{}", strip(&session));
    session.press("\u{1b}jjjjj");
    assert!(strip(&session).contains("▸contact bilateral"), "{}", strip(&session));
    assert!(session.text().contains("2 gaps") && !session.text().contains("time 2 ▸"));
    session.press("j");
    let text = session.text();
    for words in
        ["1 response", "3 λ(Ω)", "▸solver", "time 2 ▸", "start 6 ▸", "Solver: explicit takes"]
    {
        assert!(text.contains(words), "no {words} in {text}");
    }
    assert!(!text.contains("2 gaps"), "{text}");
    session.press("\u{1b}");
    assert!(session.text().contains("2 gaps") && strip(&session).contains("▸Ω"));
    // Without room for a list, the selected knob comes first.
    let mut session = Session::open(40, 12, scene(), Theme::Dark, Marker::Braille);
    assert!(session.text().contains("▸Ω 500 rad/s  F 1 MN  n_d 3  more ▸"), "{}", session.text());
    session.select("bladed_disk.blades");
    session.press("");
    assert!(session.text().contains("▸blades N 22"), "{}", session.text());
    assert!(session.text().contains("1 response"), "{}", session.text());
}

#[test]
fn a_folded_group_tells_what_is_changed_in_it() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    for path in ["bladed_disk.blades", "casing.modal_mass_kg"] {
        session.select(path);
        session.press("l");
    }
    session.select("operation.speed_rad_s");
    session.press("");
    let text = column(&session);
    assert!(text.contains("machine 9 ▸ 2*"), "{text}");
    assert!(text.contains("model 3 ▸\n"), "{text}");
}

#[test]
fn the_operation_stays_open_beside_the_solver() {
    let mut session = Session::open(100, 24, scene(), Theme::Dark, Marker::Braille);
    session.select("solver.contact");
    session.press("");
    let text = column(&session);
    assert!(text.contains("speed Ω") && text.contains("▸contact"), "{text}");
    assert!(text.contains("Contact law: unilateral"), "{text}");
}

#[test]
fn after_the_unit_of_speeds_is_changed_bare_speeds_are_in_rpm_everywhere() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    let now = |session: &Session| session.app.scene.operation.speed_rad_s * 60.0 / TAU;
    session.press("U\n45");
    assert!(column(&session).contains("45_ rpm"), "{}", column(&session));
    session.press("00\n");
    assert!((now(&session) - 4500.0).abs() < 1e-9, "{}", now(&session));
    session.press("l");
    assert!((now(&session) - 4550.0).abs() < 1e-9, "{}", now(&session));
    session.press(":speed 4600\n");
    assert!((now(&session) - 4600.0).abs() < 1e-9, "{}", now(&session));
    session.press(":speed 450 rad/s\n");
    assert!((session.app.scene.operation.speed_rad_s - 450.0).abs() < 1e-9);
    session.press("U\n500\n");
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
}
