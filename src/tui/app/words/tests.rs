//! Tests of what is typed after `:`.

use super::*;
use crate::tui::Marker;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::keys::PULSE;
use rubscope_solver::scene::{BUILTIN, Scene};

fn app() -> App {
    App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
}

/// The knob that a whole line sets.
fn sets(typed: &str) -> Result<usize, String> {
    only(&app(), typed).map(|item| match item.command {
        Command::Set(place, _) => place,
        other => panic!("{typed}: {other:?}"),
    })
}

#[test]
fn the_name_of_every_knob_with_a_value_sets_it_and_alone_says_its_value() {
    let app = app();
    for (place, knob) in KNOBS.iter().enumerate() {
        let label = knob.label;
        for name in [label.to_string(), label.to_lowercase(), plain(label), knob.path.into()] {
            let typed = format!("{name} {}", knob.text(&app.scene));
            assert_eq!(sets(&typed), Ok(place), "{typed}");
            let found = only(&app, &name).unwrap();
            assert_eq!(found.command, Command::Select(place), "{name}");
        }
    }
    for (typed, symbol) in [("F", "F"), ("n_d", "n_d"), ("K_BB", "k_bb"), ("om", "Ω")] {
        let Command::Select(place) = only(&app, typed).unwrap().command else { panic!() };
        assert_eq!(KNOBS[place].symbol(), symbol);
    }
}

#[test]
fn the_words_of_every_action_run_it() {
    let app = app();
    for binding in table::main() {
        if matches!(binding.command, Command::Palette("") | Command::Close) {
            continue;
        }
        let command = only(&app, binding.what).map(|item| item.command);
        assert_eq!(command.as_ref(), Ok(&binding.command), "{}", binding.what);
    }
}

fn first(typed: &str) -> Found {
    only(&app(), typed).unwrap_or_else(|why| panic!("{typed}: {why}"))
}

#[test]
fn every_scene_and_lesson_is_found_by_its_name() {
    let app = app();
    let found = |typed: &str| found(&app, typed);
    for scene in BUILTIN {
        assert_eq!(
            found(scene.name)[0].command,
            Command::Scene(scene.name.into()),
            "{}",
            scene.name
        );
    }
    for (place, lesson) in lessons::all().iter().enumerate() {
        // A scene may have the title of its lesson.
        let first = &found(&lesson.title)[..2.min(found(&lesson.title).len())];
        let known = first.iter().any(|item| item.command == Command::Lesson(place));
        assert!(known, "{}", lesson.title);
    }
    assert_eq!(first("undo").beside, "u");
    assert_eq!(first("theme").command, Command::NextTheme);
}

#[test]
fn a_name_and_a_value_set_a_knob() {
    for (typed, path, shown) in [
        ("speed 430", "operation.speed_rad_s", "430 rad/s"),
        ("Speed -430", "operation.speed_rad_s", "-430 rad/s"),
        ("pulse 20k", "operation.pulse_n", "20 kN"),
        ("pulse 1M", PULSE, "1 MN"),
        ("pulse 43.4 kN", PULSE, "43.4 kN"),
        ("law smooth", "solver.contact", "smooth"),
        ("speed 9500 rpm", keys::SPEED, "994.8377 rad/s"),
        ("9500rpm", keys::SPEED, "994.8377 rad/s"),
        ("pulse time 20u", "operation.pulse_s", "20 µs"),
        ("operation.pulse_n=1e6", "operation.pulse_n", "1 MN"),
        ("n_d 4", "operation.nodal_diameters", "4"),
        ("zeta_c 0.01", "casing.damping_ratio", "0.01"),
        ("N 23", "bladed_disk.blades", "23"),
        ("e 0.1", "contact.restitution", "0.1"),
        ("450", "operation.speed_rad_s", "450 rad/s"),
        ("fric 0.2", "contact.friction", "0.2"),
        ("contact bi", "solver.contact", "bilateral"),
        ("speed ramp -400", "operation.speed_ramp_rad_s2", "-400 rad/s^2"),
        // A share of the clearance, which is 100 µm here.
        ("longest 5%", keys::LONGEST_TIP, "5 µm"),
        ("out of round 0.24 %", keys::OUT_OF_ROUND, "240 nm"),
    ] {
        let item = first(typed);
        assert_eq!(item.kind, "set", "{typed}");
        let Command::Set(place, _) = item.command else { panic!("{typed}") };
        assert_eq!(KNOBS[place].path, path, "{typed}");
        assert!(item.what.ends_with(shown), "{typed}: {}", item.what);
    }
    assert_ne!(first("speed").kind, "set");
    let refused = only(&app(), "longest tip x").unwrap_err();
    assert!(refused.ends_with("from -1000 to 1000 mm or % of g0"), "{refused}");
    assert_eq!(found(&app(), "speed qqq"), []);
}

#[test]
fn a_word_of_its_own_goes_to_its_place() {
    let axes = |x, y| Command::Axes([x, y]);
    for (typed, command) in [
        ("t 0.3 ms", Command::GoTo(0.3e-3)),
        ("T=2e-3", Command::GoTo(2e-3)),
        ("5 ms", Command::GoTo(5e-3)),
        ("40us", Command::GoTo(4e-5)),
        ("compare", Command::OtherLaw),
        ("margins", Command::View(ViewId::Margins)),
        ("survey", Command::Survey),
        ("end", Command::GoToEnd),
        ("blade 7", Command::Blade(7)),
        ("axes clearance pulse", axes(Some("clearance"), Some(PULSE))),
        ("axes speed over damping zeta_c", axes(Some(keys::SPEED), Some("casing.damping_ratio"))),
        ("axes clear", axes(Some("clearance"), None)),
        ("across clear", axes(Some("clearance"), None)),
        ("up pulse t_p", axes(None, Some("operation.pulse_s"))),
        ("scene rub", Command::Scene("rub".into())),
        ("scene slip", Command::Scene("slip".into())),
        ("lesson friction", Command::Lesson(11)),
        ("lesson 2", Command::Lesson(1)),
        ("view 5", Command::View(ViewId::Map)),
        ("view gaps", Command::View(ViewId::Gaps)),
        ("save Mine.toml", Command::Write(Purpose::Save, "Mine.toml".into())),
    ] {
        assert_eq!(first(typed).command, command, "{typed}");
    }
    // A list to choose from.
    assert_eq!(found(&app(), "across ").len(), numeric().count());
}
