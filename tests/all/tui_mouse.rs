//! The mouse in the explorer: what a click or the wheel does at a place of the screen.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use rubscope::tui::{Effect, Marker, Theme};

use crate::tui_support::{Session, scene};

use MouseEventKind::{Down, Drag, Moved, ScrollDown, ScrollUp, Up};

const LEFT: MouseEventKind = Down(MouseButton::Left);
const HELD: MouseEventKind = Drag(MouseButton::Left);

fn open(width: u16, height: u16) -> Session {
    Session::open(width, height, scene(), Theme::Dark, Marker::Braille)
}

fn with(
    session: &mut Session,
    modifiers: KeyModifiers,
    kind: MouseEventKind,
    at: (u16, u16),
) -> Option<Effect> {
    session.app.mouse(&MouseEvent { kind, column: at.0, row: at.1, modifiers })
}

fn mouse(session: &mut Session, kind: MouseEventKind, at: (u16, u16)) -> Option<Effect> {
    with(session, KeyModifiers::NONE, kind, at)
}

fn selected(session: &Session) -> &'static str {
    session.app.selected().unwrap().path
}

#[test]
fn the_keys_of_the_last_line_can_be_clicked() {
    let mut session = open(120, 40);
    let turn = session.find("←→ turn");
    for (at, speed) in [(0, 495.0), (1, 500.0), (4, 505.0)] {
        mouse(&mut session, LEFT, (turn.0 + at, turn.1));
        assert_eq!(session.app.scene.operation.speed_rad_s, speed);
    }
    let commands = session.find(": commands");
    mouse(&mut session, LEFT, (commands.0 + 3, commands.1));
    session.press("undo");
    let choose = session.find("Enter run");
    assert_eq!(mouse(&mut session, LEFT, choose), Some(Effect::None));
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
    session.press("");
    let quit = session.find("q quit");
    assert_eq!(mouse(&mut session, LEFT, quit), Some(Effect::Quit));
}

#[test]
fn a_click_selects_a_knob_and_the_wheel_turns_the_one_below_it() {
    let mut session = open(100, 24);
    let diameters = session.find("diameters n_d");
    assert_eq!(mouse(&mut session, LEFT, diameters), Some(Effect::None));
    assert_eq!(selected(&session), "operation.nodal_diameters");
    let damping = session.find("damping ζ_c");
    mouse(&mut session, ScrollUp, damping);
    assert_eq!(selected(&session), "casing.damping_ratio");
    assert_eq!(session.app.scene.casing.damping_ratio, 0.055);
    mouse(&mut session, ScrollDown, damping);
    with(&mut session, KeyModifiers::SHIFT, ScrollUp, damping);
    assert_eq!(session.app.scene.casing.damping_ratio, 0.1);
    // A folded group opens at its first knob.
    let machine = session.find("machine ▸");
    mouse(&mut session, LEFT, machine);
    session.press("");
    assert!(session.text().contains("▸clearance g0"), "{}", session.text());
}

#[test]
fn the_wheel_turns_the_same_knob_while_the_pointer_stays() {
    let scene = rubscope_solver::scene::Scene::builtin("rub").unwrap();
    let mut session = Session::with_stride((100, 24), 1e-4, scene, Theme::Dark, Marker::Braille);
    let contact = session.find("contact    ");
    // The bar of the speed goes, and the rows below it move up.
    for law in ["unilateral", "smooth", "bilateral"] {
        mouse(&mut session, ScrollUp, contact);
        assert_eq!(selected(&session), "solver.contact");
        session.press("");
        assert!(session.text().contains(law), "{}", session.text());
    }
    // The pointer moves: what is in its row then.
    mouse(&mut session, ScrollUp, (contact.0 + 1, contact.1));
    assert_eq!(selected(&session), "solver.kind");
}

#[test]
fn a_bar_is_set_where_it_is_clicked() {
    let mut session = open(80, 24);
    let (left, row) = session.find("▕▒");
    mouse(&mut session, LEFT, (left + 1, row));
    assert_eq!(session.app.scene.operation.speed_rad_s, 0.0);
    session.press("u");
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
    // Neither a move nor a drag changes anything.
    for kind in [HELD, Moved, Up(MouseButton::Left)] {
        assert_eq!(mouse(&mut session, kind, (left + 3, row)), None);
    }
    assert_eq!(session.app.scene.operation.speed_rad_s, 500.0);
}

#[test]
fn a_click_reads_the_large_chart() {
    let mut session = open(80, 24);
    session.press("1f");
    let (left, row) = session.find("0┤");
    let (first, last) = (left + 2, 79);
    for (column, cells) in [(first, 0.5), (last, f64::from(last - first) + 0.5)] {
        mouse(&mut session, LEFT, (column, row));
        assert!(session.app.reading.on);
        let (from, to) = session.app.page();
        let cell = (to - from) / f64::from(last - first + 1);
        assert!((session.app.reading.at_s.unwrap() - (from + cells * cell)).abs() < 1e-12);
    }
    mouse(&mut session, Down(MouseButton::Right), (last, row));
    assert!(session.app.reading.cursor.is_none() && !session.app.reading.on);
}

#[test]
fn the_wheel_zooms_time_and_nothing_else() {
    let mut session = open(80, 24);
    session.press("1");
    let (left, row) = session.find("0┤");
    mouse(&mut session, ScrollUp, (left + 9, row));
    mouse(&mut session, ScrollUp, (left + 9, row));
    assert_eq!(session.app.play.tempo.zoom, 2);
    mouse(&mut session, ScrollDown, (left + 9, row));
    assert_eq!(session.app.play.tempo.zoom, 1);
    session.press("3f");
    assert_eq!(mouse(&mut session, ScrollUp, (40, 12)), None);
    assert_eq!(session.app.play.tempo.zoom, 1);
}

#[test]
fn the_mouse_may_do_anything_anywhere_on_a_small_screen() {
    [(1, 1), (40, 12)].into_iter().for_each(anything_in_every_state);
}

#[test]
fn the_mouse_may_do_anything_anywhere_on_a_usual_screen() {
    anything_in_every_state((80, 24));
}

#[test]
fn the_mouse_may_do_anything_anywhere_on_a_large_screen() {
    anything_in_every_state((120, 40));
}

fn anything_in_every_state((width, height): (u16, u16)) {
    let kinds = [LEFT, HELD, Moved, ScrollUp, ScrollDown, Up(MouseButton::Left)];
    let states = ["", "f", "c", "?", "g", "\n12", "s", "i", "5", "2w", "4", "6"];
    for (place, keys) in states.iter().enumerate() {
        let mut scene = scene();
        scene.solver.end_s = 2e-3;
        let mut session = Session::open(width, height, scene, Theme::Dark, Marker::Braille);
        session.press(keys);
        for y in 0..=height {
            for x in (0..=width).step_by(if width > 100 { 23 } else { 11 }) {
                let kind = kinds[(usize::from(x + 7 * y) + place) % kinds.len()];
                mouse(&mut session, kind, (x, y));
            }
        }
        session.press("");
        assert!(!session.text().contains("NaN"), "{}", session.text());
    }
}
