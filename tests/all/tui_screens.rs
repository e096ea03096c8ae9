//! Whole screens of the explorer: keys in, text out, without a terminal. The test
//! drives the engine, so that a screen is the same on every machine.

use std::sync::mpsc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::scene::Scene;
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::terminal::NoHost;
use rubscope::tui::worker::Stepwise;
use rubscope::tui::{App, Exit, Marker, Theme, run};

/// An explorer on a test backend.
pub struct Session {
    pub terminal: Terminal<TestBackend>,
    pub app: App,
    pub engine: Stepwise,
}

/// The paper's scene with a coarser step and a shorter run, for speed.
pub fn scene() -> Scene {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    scene.solver.step_s = 2e-7;
    scene.solver.end_s = 0.02;
    scene
}

impl Session {
    pub fn open(width: u16, height: u16, scene: Scene, theme: Theme, marker: Marker) -> Self {
        let terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        let mut session = Self {
            terminal,
            app: App::new(scene.checked().unwrap(), theme, marker),
            engine: Stepwise::new(3e-3),
        };
        session.press("");
        session
    }

    /// Presses keys, one a letter; two frames later the screen is looked at.
    pub fn press(&mut self, keys: &str) -> Exit {
        self.keys(keys.chars().map(|letter| match letter {
            '\n' => KeyCode::Enter,
            '\t' => KeyCode::Tab,
            '\u{1b}' => KeyCode::Esc,
            '\u{8}' => KeyCode::Backspace,
            letter => KeyCode::Char(letter),
        }))
    }

    fn keys(&mut self, keys: impl Iterator<Item = KeyCode>) -> Exit {
        let (sender, events) = mpsc::channel();
        for key in keys {
            sender.send(ScreenEvent::Key(KeyEvent::new(key, KeyModifiers::NONE))).unwrap();
        }
        drop(sender);
        let (app, engine) = (&mut self.app, &mut self.engine);
        run(&mut self.terminal, &events, app, engine, &mut NoHost, Duration::ZERO).unwrap()
    }

    /// Selects the knob of a key, wherever it stands.
    pub fn select(&mut self, path: &str) {
        assert!(self.app.select_path(path), "{path}");
    }

    pub fn text(&self) -> String {
        let buffer = self.terminal.backend().buffer();
        let width = usize::from(buffer.area.width);
        buffer
            .content
            .chunks(width)
            .map(|row| row.iter().map(|cell| cell.symbol()).collect::<String>())
            .map(|row| row.trim_end().to_string() + "\n")
            .collect()
    }
}

#[test]
fn the_first_screen_at_three_sizes() {
    for (width, height) in [(80, 24), (120, 40), (40, 12)] {
        let session = Session::open(width, height, scene(), Theme::Dark, Marker::Braille);
        insta::assert_snapshot!(format!("first_{width}x{height}"), session.text());
    }
}

#[test]
fn each_view_and_the_help_in_ascii() {
    for (name, keys) in [("response", "1f"), ("gaps", "2f"), ("locked", "3f"), ("help", "?")] {
        let mut session = Session::open(80, 24, scene(), Theme::Mono, Marker::Ascii);
        session.press(keys);
        let text = session.text();
        assert!(text.is_ascii(), "{text}");
        insta::assert_snapshot!(format!("ascii_{name}"), text);
    }
}

#[test]
fn an_adhesive_lock_is_never_called_locked_without_saying_so() {
    let mut scene = Scene::builtin("adhesive").unwrap();
    scene.solver.step_s = 2e-7;
    let session = Session::open(100, 30, scene, Theme::Dark, Marker::Braille);
    let text = session.text();
    assert!(text.contains(" ADHESIVE ") && text.contains("a lock that pulls"), "{text}");
}

#[test]
fn a_run_that_fails_says_when_and_why() {
    let mut scene = scene();
    scene.operation.pulse_n = 1e9;
    let session = Session::open(100, 30, scene, Theme::Dark, Marker::Braille);
    let text = session.text();
    assert!(text.contains(" FAILED ") && text.contains("failed at t = "), "{text}");
}

#[test]
fn too_small_a_screen_says_what_it_needs() {
    let session = Session::open(39, 12, scene(), Theme::Dark, Marker::Braille);
    assert!(session.text().contains("rubscope needs 40x12; this is 39x12"));
}

#[test]
fn pause_stops_time_and_a_step_is_one_step() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press(" ");
    let before = session.app.now();
    session.press("");
    assert_eq!(session.app.now(), before);
    session.press("...");
    let steps = (session.app.now() - before) / session.app.scene.solver.step_s;
    // Three steps, to the round-off of a time that is a multiple of a step.
    assert!((steps - 3.0).abs() < 1e-6, "{steps}");
}

#[test]
fn quitting_is_quitting_and_escape_is_not() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("?\u{1b}\u{1b}\u{1b}");
    assert!(session.text().contains(" LOCKED "));
    assert_eq!(session.press("q"), Exit::Done);
}

#[test]
fn escape_and_a_key_in_one_go_are_both_heard() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("?");
    session.app.key(&KeyEvent::new(KeyCode::Char('2'), KeyModifiers::ALT));
    session.press("");
    assert!(session.text().contains("2 gaps"), "{}", session.text());
    assert_eq!(session.app.view.digit(), 2);
}

#[test]
fn signals_and_a_lost_terminal_end_with_their_number() {
    for (event, number) in [(ScreenEvent::Signal(15), 15), (ScreenEvent::InputClosed, 1)] {
        let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
        let (sender, events) = mpsc::channel();
        sender.send(event).unwrap();
        let (app, engine) = (&mut session.app, &mut session.engine);
        let exit = run(&mut session.terminal, &events, app, engine, &mut NoHost, Duration::ZERO);
        assert_eq!(exit.unwrap(), Exit::Signal(number));
    }
}

#[test]
fn every_view_with_the_large_chart_at_120_by_40() {
    for digit in ['1', '2', '3', '4', '5', '6'] {
        let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
        session.press(&digit.to_string());
        insta::assert_snapshot!(format!("view_{digit}"), session.text());
    }
}

#[test]
fn speed_against_error_shows_every_kind_of_solver() {
    let mut scene = scene();
    scene.solver.end_s = 2e-3;
    scene.solver.contact = rubscope::scene::ContactLaw::Unilateral;
    scene.operation.pulse_n = 2e4;
    let mut session = Session::open(120, 40, scene, Theme::Dark, Marker::Braille);
    // Wall times differ from run to run: only the fixed parts are checked.
    session.press("7f");
    let text = session.text();
    assert!(text.contains("7 precision") && text.contains("reference"), "{text}");
    for letter in ["e", "U"] {
        assert!(text.contains(letter), "no {letter} in {text}");
    }
}

#[test]
fn themes_differ_in_colour_only_and_mono_has_none() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press(" ");
    let before = session.text();
    for theme in ["light", "colour-blind on dark", "colour-blind on light", "mono"] {
        session.press("t");
        assert!(session.text().contains(&format!("theme {theme}")));
    }
    let colours = session.terminal.backend().buffer().content.iter().map(|cell| cell.fg);
    assert!(colours.into_iter().all(|colour| colour == ratatui::style::Color::Reset));
    let body = |text: &str| text.lines().take(23).collect::<Vec<_>>().join("\n");
    assert_eq!(body(&session.text()), body(&before), "a theme changed the text");
}

#[test]
fn both_laws_side_by_side_and_a_pinned_baseline() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("bilateral: LOCKED") && text.contains("unilateral: DECAY"), "{text}");
    session.press("c");
    session.press("b");
    session.select("solver.contact");
    session.press("l");
    let text = session.text();
    assert!(text.contains(" DECAY ") && text.contains("pinned: LOCKED"), "{text}");
}

#[test]
fn a_file_is_never_replaced_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let name = path.to_str().unwrap().to_string();
    let erase = "\u{8}".repeat(40);
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press(&format!("s{erase}{name}\n"));
    assert_eq!(Scene::load(&name).unwrap(), scene());
    std::fs::write(&path, "mine").unwrap();
    session.press(&format!("s{erase}{name}\n"));
    assert!(session.text().contains("y replaces it"), "{}", session.text());
    session.press("n");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
    session.press(&format!("s{erase}{name}\n"));
    session.press("y");
    assert_eq!(Scene::load(&name).unwrap(), scene());
    for (view, file) in [("1", "a.csv"), ("2", "b.csv"), ("3", "c.csv"), ("1", "d.svg")] {
        let path = folder.path().join(file);
        let name = path.to_str().unwrap();
        session.press(view);
        session.press(&format!("e{erase}{name}\n"));
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.len() > 100 && !text.contains("NaN"), "{file}: {text}");
    }
}

#[test]
fn the_speed_acts_on_the_running_motion_when_live() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    let before = session.app.now();
    session.press("x");
    session.press("HHHH");
    assert!(session.app.now() > before, "the run restarted");
    assert_eq!(session.app.speed(), 300.0);
    assert!(session.text().contains("LIVE"), "{}", session.text());
}

#[test]
fn the_cursor_reads_values_and_pages_can_be_looked_back_at() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    // 33 ms of motion are on the second page of 20 ms.
    for _ in 0..10 {
        session.press("");
    }
    session.press(" ((((");
    assert!(session.text().contains(" at "), "{}", session.text());
    session.press("<");
    assert!(session.text().contains("1 back"), "{}", session.text());
    session.press("\u{1b}");
    assert!(!session.text().contains("1 back"), "{}", session.text());
}

#[test]
fn the_gaps_against_time_need_no_colour() {
    for (name, marker) in [("heat", Marker::Braille), ("ascii_heat", Marker::Ascii)] {
        let mut session = Session::open(80, 24, scene(), Theme::Mono, marker);
        session.press("wf ");
        let text = session.text();
        assert!(marker != Marker::Ascii || text.is_ascii(), "{text}");
        insta::assert_snapshot!(name, text);
        session.press("w");
        assert!(session.text().contains("gaps of this instant"), "{}", session.text());
    }
}

#[test]
fn a_storm_of_sizes_between_keys_leaves_one_picture_of_the_last() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Dot);
    for (width, height) in [(40, 12), (1, 1), (200, 60), (0, 0), (39, 11), (97, 31)] {
        session.terminal.backend_mut().resize(width, height);
        let (sender, events) = mpsc::channel();
        for key in "\t[]fwf".chars().cycle().take(300) {
            let code = if key == '\t' { KeyCode::Tab } else { KeyCode::Char(key) };
            (0..10).for_each(|_| sender.send(ScreenEvent::Resize).unwrap());
            sender.send(ScreenEvent::Key(KeyEvent::new(code, KeyModifiers::NONE))).unwrap();
        }
        drop(sender);
        let (app, engine) = (&mut session.app, &mut session.engine);
        run(&mut session.terminal, &events, app, engine, &mut NoHost, Duration::ZERO).unwrap();
        assert_eq!(session.app.size, (width, height));
    }
    assert!(session.text().contains(" LOCKED "), "{}", session.text());
}

/// Every run of one style: row, columns, colour, weight, and its text.
fn styles(session: &Session) -> String {
    let buffer = session.terminal.backend().buffer();
    let mut out = String::new();
    for (y, row) in buffer.content.chunks(usize::from(buffer.area.width)).enumerate() {
        let mut from = 0;
        while let Some(first) = row.get(from) {
            let alike = |cell: &&ratatui::buffer::Cell| {
                (cell.fg, cell.bg, cell.modifier) == (first.fg, first.bg, first.modifier)
            };
            let count = row.iter().skip(from).take_while(alike).count();
            let text: String =
                row.iter().skip(from).take(count).map(|cell| cell.symbol()).collect();
            if !text.trim().is_empty() {
                let (fg, weight) = (first.fg, first.modifier);
                out.push_str(&format!(
                    "{y:2} {from:2}+{count:<2} {fg} {weight:?} {}\n",
                    text.trim()
                ));
            }
            from += count;
        }
    }
    out
}

#[test]
fn the_colours_of_the_light_and_the_weights_of_the_mono_theme() {
    for (name, theme) in [("light", Theme::Light), ("mono", Theme::Mono)] {
        let session = Session::open(80, 24, scene(), theme, Marker::Ascii);
        insta::assert_snapshot!(format!("styles_{name}_80x24"), styles(&session));
    }
}
