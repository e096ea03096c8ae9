//! The explorer on scenes that go beyond the paper: its knobs, its scales, a lining
//! below the zero line, and the view of the coincidence.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::{ContactLaw, Scene, SolverKind};

use crate::tui_support::{Session, scene};

/// A scene with some keys set, short and coarse.
fn with(keys: &[(&str, &str)]) -> Scene {
    let mut scene = scene();
    scene.solver.contact = ContactLaw::Unilateral;
    scene.solver.step_s = 1e-6;
    for (path, text) in keys {
        scene.set(path, text).unwrap();
    }
    scene
}

/// Trailing blades over a clearance, above the dangerous coincidence.
fn trailing() -> Scene {
    with(&[
        ("bladed_disk.radial_coupling", "0.3"),
        ("operation.speed_rad_s", "450"),
        ("operation.pulse_n", "100000"),
    ])
}

/// All blades rub on a soft lining.
fn pressed() -> Scene {
    with(&[
        ("bladed_disk.radial_coupling", "0.5"),
        ("solver.contact", "smooth"),
        ("solver.step_s", "5e-6"),
        ("casing.radius_m", "0.49988"),
        ("contact.stiffness_n_per_m", "27000"),
        ("operation.speed_rad_s", "410"),
        ("operation.pulse_n", "100"),
    ])
}

fn friction() -> Scene {
    with(&[("contact.friction", "0.15"), ("casing.tangential_ratio", "1")])
}

fn open(size: (u16, u16), scene: Scene) -> Session {
    Session::open(size.0, size.1, scene, Theme::Dark, Marker::Braille)
}

/// The column of knobs, without the charts.
fn column(session: &Session) -> String {
    let text = session.text();
    let rows = text.lines().skip(2);
    rows.map(|row| row.chars().take(26).collect::<String>().trim_end().to_string() + "\n").collect()
}

/// A click of the left button, and a look at the screen after it.
fn click(session: &mut Session, (column, row): (u16, u16)) {
    let kind = MouseEventKind::Down(MouseButton::Left);
    session.app.mouse(&MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
    session.press("");
}

#[test]
fn the_header_has_both_ends_of_a_lock() {
    let session = open((300, 40), trailing());
    assert!(session.rows()[1].contains("Ω_lock 472.1 to 566.3"), "{}", session.rows()[1]);
    // On a lining those of the lining.
    let lined = with(&[("solver.contact", "smooth"), ("contact.stiffness_n_per_m", "3e8")]);
    let session = open((300, 40), lined);
    assert!(session.rows()[1].contains("Ω_lock 438.2 to 732.4"), "{}", session.rows()[1]);
    let session = open((300, 40), scene());
    assert!(!session.rows()[1].contains(" to "), "{}", session.rows()[1]);
}

/// Steady states and limits of equal blades say so where every blade moves alone.
#[test]
fn views_of_equal_blades_say_so_in_the_full_model() {
    for (digit, scene) in [("3", trailing()), ("8", trailing()), ("9", pressed())] {
        for (model, says) in [("modal", false), ("full", true)] {
            let mut scene = scene.clone();
            scene.set("solver.model", model).unwrap();
            scene.solver.step_s = 1e-6;
            let mut session = open((160, 40), scene);
            session.press(digit);
            let text = session.text();
            assert_eq!(text.contains("of equal blades, two"), says, "{digit} {model}\n{text}");
        }
    }
}

#[test]
fn what_is_beyond_the_paper_is_folded_but_for_what_the_scene_has_of_it() {
    for size in [(100, 24), (120, 40), (200, 50)] {
        let paper = column(&open(size, scene()));
        assert!(!paper.contains("tip slope"), "{paper}");
        let coupled = column(&open(size, pressed()));
        for label in
            ["tip slope κ           0.5", "lining k_p        27 kN/m", "lining eps", "speed Ω"]
        {
            assert!(coupled.contains(label), "{size:?} {label}\n{coupled}");
        }
        assert!(!coupled.contains("restitution"), "{coupled}");
    }
    // A click on a folded group opens it.
    let mut session = open((100, 24), scene());
    for (group, label) in [("beyond the paper 11 ▸", "▸tip slope κ"), ("start 6 ▸", "▸start u_c")]
    {
        let row = session.rows().iter().position(|row| row.contains(group)).unwrap() as u16;
        click(&mut session, (3, row));
        assert!(column(&session).contains(label), "{}", column(&session));
        session.select("operation.speed_rad_s");
        session.press("");
    }
}

#[test]
fn the_clearance_goes_through_zero_on_a_lining_only() {
    let mut session = open((120, 40), with(&[("solver.contact", "smooth")]));
    session.select("casing.radius_m");
    session.press("");
    let place = session.rows().iter().position(|row| row.contains("clearance g0")).unwrap();
    session.select("bladed_disk.blades");
    session.press("k");
    assert!(session.rows()[place].contains("▸clearance g0       100 µm"));
    session.press_each("HHHHHHHHHHH");
    assert!(session.rows()[place].contains("▸clearance g0*      -20 µm"), "{}", session.text());
    assert!(session.text().contains("no lock"), "{}", session.text());
    session.press_each("LLLLL");
    assert!(session.rows()[place].contains("▸clearance g0*        1 µm"), "{}", session.text());
    // A rigid casing has a clearance.
    session.select("solver.contact");
    session.press("\nuni\n");
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Unilateral);
    session.select("bladed_disk.blades");
    session.press("k\n-20u\n");
    assert!(session.text().contains("casing R_c:"), "{}", session.text());
    assert!(session.app.scene.clearance() > 0.0);
}

#[test]
fn the_words_of_the_contact_law_take_the_solver_with_them_or_are_refused_in_a_line() {
    let mut session = open((120, 40), with(&[("solver.kind", "event")]));
    session.select("solver.contact");
    session.press("\nsmooth\n");
    assert_eq!(session.app.scene.solver.kind, SolverKind::Explicit);
    assert!(session.text().contains("a lining has no events"), "{}", session.text());
    session.select("solver.kind");
    session.press("l");
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Unilateral);
    let mut session = open((120, 40), friction());
    session.select("solver.contact");
    session.press("h");
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Unilateral);
    assert!(column(&session).contains("friction μ: 0.15 is not"), "{}", column(&session));
    session.press("l");
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Smooth);
}

#[test]
fn a_lining_is_compared_with_the_rigid_law_where_the_scene_can_have_it() {
    let mut session = open((120, 40), with(&[("solver.contact", "smooth")]));
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("smooth: ") && text.contains("unilateral: "), "{text}");
    for (scene, why) in [(pressed(), "casing.radius_m"), (friction(), "contact.friction")] {
        let mut session = open((120, 40), scene);
        session.press("c");
        let rows = session.rows();
        let start = rows.iter().position(|row| row.starts_with("no ")).unwrap();
        let said = rows[start..].join(" ");
        assert!(rows.len() - start <= 2 && said.contains(why), "{said}");
        assert!(!session.app.run.compare);
    }
    // A knob can make it impossible later: then its chart says so.
    let mut session =
        open((120, 40), with(&[("contact.friction", "0"), ("casing.tangential_ratio", "1")]));
    session.press("c");
    session.select("contact.friction");
    session.press("l");
    assert!(session.app.run.compare && session.text().contains("a pull has"), "{}", session.text());
}

#[test]
fn the_second_line_has_the_coincidence_where_it_is_dangerous() {
    let line = |scene: Scene, width: u16| open((width, 40), scene).rows()[1].clone();
    let rigid = with(&[("solver.model", "rigid"), ("bladed_disk.radial_coupling", "0.3")]);
    assert!(line(trailing(), 120).contains("1.16 coincidence"), "{}", line(trailing(), 120));
    assert!(line(trailing(), 80).contains("1.16 coincidence"), "{}", line(trailing(), 80));
    assert!(line(rigid, 300).contains("coincidence 388.3"));
    assert!(line(scene(), 300).contains("coincidence 388.3"));
    // A blade that friction turns outward meets the other one.
    let keys = [("bladed_disk.radial_coupling", "-0.15"), ("contact.friction", "0.3")];
    assert!(line(with(&keys), 300).contains("coincidence 197.4"), "{}", line(with(&keys), 300));
    assert!(line(pressed(), 120).contains("no lock"), "{}", line(pressed(), 120));
}

#[test]
fn every_view_of_every_such_scene_is_drawn_at_every_size() {
    let scenes = [
        trailing(),
        pressed(),
        friction(),
        with(&[("solver.contact", "smooth"), ("solver.model", "full")]),
        with(&[("bladed_disk.radial_coupling", "-0.15"), ("contact.friction", "0.3")]),
        with(&[("solver.contact", "smooth"), ("bladed_disk.nodal_diameters", "6")]),
        with(&[("bladed_disk.radial_coupling", "0.3"), ("operation.speed_rad_s", "-450")]),
        with(&[("operation.nodal_diameters", "0"), ("contact.restitution", "0.5")]),
    ];
    for scene in scenes {
        let mut session = Session::open(200, 50, scene, Theme::Mono, Marker::Ascii);
        for (width, height) in [(40, 12), (80, 24), (120, 40), (200, 50)] {
            session.terminal.backend_mut().resize(width, height);
            session.press("");
            for keys in ["1", "2", "w", "w3", "4", "6", "9", "9i"] {
                session.press(keys);
                let text = session.text();
                assert!(!text.contains("NaN") && !text.contains("inf "), "{keys} {text}");
                assert!(text.is_ascii(), "{keys} {text}");
                session.press("\u{1b}");
            }
        }
    }
}

#[test]
fn a_lining_is_below_the_zero_line_and_the_blade_that_is_read_says_how_deep() {
    let mut session = open((120, 40), pressed());
    session.press("2 i");
    let text = session.text();
    assert!(text.contains("µm into the lining"), "{text}");
    assert!(text.contains("all blades") && text.contains("deepest"), "{text}");
    session.press("\u{1b}4f");
    assert!(session.text().contains("inside all rub"), "{}", session.text());
    session.press("3");
    assert!(session.text().contains("all blades rub at rest: nothing locks"), "{}", session.text());
}

#[test]
fn the_coincidence_marks_both_speeds_and_is_read_at_the_cursor() {
    let mut session = open((120, 40), trailing());
    session.press("9f");
    session.press("");
    let text = session.text();
    for words in
        ["9 coincidence", "coincidence (30)", "coincidence (31)", "a whirl can last from 41"]
    {
        assert!(text.contains(words), "{words} {text}");
    }
    session.press("i");
    let text = session.text();
    assert!(text.contains("at 450.0 rad/s: |a| 808.7 µrad, |z| 216.6 µm"), "{text}");
    // The rim of many blades at 450 rad/s: omega = 1088.52 rad/s.
    assert!(text.contains("ω 1.089 krad/s"), "{text}");
    session.press("\u{1b}");
    session.select("bladed_disk.radial_coupling");
    session.press("\n0\n");
    session.press("");
    assert!(session.text().contains("κ = 0: tips do not move outward"), "{}", session.text());
}
