//! The loop of the explorer without new snapshots, and the record of its engine.

use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::engine::{Engine, Order, Snapshot};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::files::{FileJob, FileResult, FoundScenes};
use rubscope::tui::history::Channel;
use rubscope::tui::host::Host;
use rubscope::tui::{App, Exit, Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::stepwise::{NoHost, Stepwise};
use crate::tui_support::{key, select};

/// An explorer of a scene.
fn app(scene: Scene) -> App {
    App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille)
}

/// The paper's scene to an early end.
fn short() -> Scene {
    Scene::base().with(&[("solver.end_s", "2e-3")]).unwrap().into_scene()
}

fn screen(width: u16, height: u16) -> Terminal<TestBackend> {
    Terminal::new(TestBackend::new(width, height)).unwrap()
}

/// The loop on a screen of 80 columns.
fn run(events: &Receiver<ScreenEvent>, app: &mut App, engine: &mut dyn Engine) -> Exit {
    run_with(events, app, engine, &mut NoHost)
}

fn run_with(
    events: &Receiver<ScreenEvent>,
    app: &mut App,
    engine: &mut dyn Engine,
    host: &mut dyn Host,
) -> Exit {
    let frame = Duration::from_millis(100);
    rubscope::tui::run(&mut screen(80, 24), events, app, engine, host, frame).unwrap()
}

fn press(app: &mut App, letter: char) {
    let _ = app.key(&KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
}

fn interrupt() -> ScreenEvent {
    ScreenEvent::Key(KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL))
}

/// An engine with the order of an explorer, and its answer.
fn answer(app: &App) -> (Stepwise, Snapshot) {
    let mut engine = Stepwise::new(1e-4);
    engine.order(&app.order());
    let snapshot = engine.take().unwrap();
    (engine, snapshot)
}

/// Ends the loop once the last of some pictures is on the screen.
struct Pictures {
    left: u32,
    events: Sender<ScreenEvent>,
}

impl Engine for Pictures {
    fn order(&mut self, _: &Order) {}

    fn take(&mut self) -> Option<Snapshot> {
        None
    }

    fn drawn(&mut self) {
        self.left -= 1;
        if self.left == 0 {
            self.events.send(ScreenEvent::Signal(15)).unwrap();
        }
    }
}

/// Closes the input of a loop that hangs. A long limit, not a speed test: a second
/// is enough on a quiet machine.
fn end_in_a_minute(events: &Sender<ScreenEvent>) {
    let events = events.clone();
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs(60));
        let _ = events.send(ScreenEvent::InputClosed);
    });
}

#[test]
fn a_screen_without_news_is_drawn_again_to_notice_a_lost_terminal() {
    let (sender, events) = channel();
    end_in_a_minute(&sender);
    let mut engine = Pictures { left: 2, events: sender };
    let exit = run(&events, &mut app(Scene::base()), &mut engine);
    assert_eq!(exit, Exit::Signal(15), "nothing was drawn for a minute");
}

/// A host whose files take a while: the results come as events.
struct Slow {
    results: Vec<FileResult>,
    events: Sender<ScreenEvent>,
    suspended: u32,
    unseen: Option<String>,
}

impl Host for Slow {
    fn suspend(&mut self, _: bool) -> std::io::Result<bool> {
        self.suspended += 1;
        Ok(true)
    }
    fn resume(&mut self) -> std::io::Result<()> {
        Ok(())
    }
    fn copy(&mut self, _: &str) -> std::io::Result<()> {
        Ok(())
    }
    fn write(&mut self, _: FileJob) -> Option<ScreenEvent> {
        self.events.send(ScreenEvent::Suspend).unwrap();
        self.events.send(ScreenEvent::Written(self.results.remove(0))).unwrap();
        None
    }
    fn unseen(&mut self, reason: Option<String>) {
        self.unseen = reason;
    }
    fn find_scenes(&mut self, directory: PathBuf) -> Option<ScreenEvent> {
        Some(ScreenEvent::Scenes(FoundScenes::of(&directory)))
    }
}

#[test]
fn quitting_waits_for_the_file_and_keeps_the_reason_why_it_was_not_written() {
    let (sender, events) = channel();
    let failed = FileResult::Failed("no room".into());
    let results = vec![failed, FileResult::Exists, FileResult::Written];
    let mut host = Slow { results, events: sender.clone(), suspended: 0, unseen: None };
    for (quit, reason) in [
        (key('q'), Some("cannot write scene.toml: no room")),
        (interrupt(), Some("cannot write scene.toml: it exists")),
        (interrupt(), None),
    ] {
        "s\n".chars().for_each(|letter| sender.send(key(letter)).unwrap());
        sender.send(quit).unwrap();
        sender.send(key('?')).unwrap();
        // If the loop goes on, it is until this.
        end_in_a_minute(&sender);
        let mut engine = Stepwise::new(1e-4);
        let exit = run_with(&events, &mut app(Scene::base()), &mut engine, &mut host);
        assert_eq!(exit, Exit::Done);
        assert_eq!(host.unseen.take().as_deref(), reason);
        while events.try_recv().is_ok() {}
    }
    assert_eq!(host.suspended, 3, "a suspension was lost");
}

/// A Ctrl-C does not wait until what was sent before it is answered; a word and a name that
/// were typed ahead of it are.
#[test]
fn behind_a_burst_of_keys_a_ctrl_c_is_the_next_one() {
    for (before, answered) in [(1000, true), (1001, false)] {
        let (sender, events) = channel();
        for _ in 0..before {
            sender.send(key('→')).unwrap();
        }
        sender.send(interrupt()).unwrap();
        let mut app = app(Scene::base());
        let scene = app.scene.clone();
        assert_eq!(run(&events, &mut app, &mut Silent), Exit::Done);
        assert_eq!(app.scene != scene, answered, "{before} keys");
    }
}

/// Sends the next key a moment after each order; counts the frames.
struct Repeating {
    events: Sender<ScreenEvent>,
    left: u32,
    frames: u32,
}

impl Engine for Repeating {
    fn order(&mut self, _: &Order) {
        std::thread::sleep(Duration::from_millis(4));
        self.left -= 1;
        let next = if self.left > 0 { key('→') } else { ScreenEvent::Signal(15) };
        self.events.send(next).unwrap();
    }

    fn take(&mut self) -> Option<Snapshot> {
        None
    }

    fn drawn(&mut self) {
        self.frames += 1;
    }
}

#[test]
fn a_key_that_repeats_faster_than_a_frame_waits_for_its_answer_is_drawn() {
    let (sender, events) = channel();
    let mut engine = Repeating { events: sender, left: 50, frames: 0 };
    let (mut app, frame) = (app(Scene::base()), Duration::from_millis(33));
    rubscope::tui::run(&mut screen(80, 24), &events, &mut app, &mut engine, &mut NoHost, frame)
        .unwrap();
    assert!(engine.frames > 5, "{} frames of 50 keys", engine.frames);
}

#[test]
fn a_burst_of_turns_of_one_knob_is_one_change_and_ends_at_the_refused_value() {
    let mut scene = Scene::builtin("friction-lock").unwrap();
    // Down from there, Coulomb's law is without a direction at 0.
    let speed = 50.0;
    scene.operation.speed_rad_s = speed;
    for (keys, wanted, refused) in [('→', speed + 200.0, false), ('←', 5.0, true)] {
        let presses = if refused { 60 } else { 40 };
        let one = |presses: usize, at_once: bool| {
            let mut app = app(scene.clone());
            select(&mut app, "operation.speed_rad_s");
            let mut send = |presses: usize| {
                let (sender, events) = channel();
                (0..presses).for_each(|_| sender.send(key(keys)).unwrap());
                drop(sender);
                run(&events, &mut app, &mut Silent);
            };
            match at_once {
                true => send(presses),
                false => (0..presses).for_each(|_| send(1)),
            }
            app
        };
        let (joined, each) = (one(presses, true), one(presses, false));
        assert_eq!((&joined.scene, &joined.knobs.refusal), (&each.scene, &each.knobs.refusal));
        let end = (joined.scene.operation.speed_rad_s, joined.knobs.refusal.is_some());
        assert_eq!(end, (wanted, refused));
        assert!(joined.run.runs <= 2 && each.run.runs > 2, "{}", joined.run.runs);
        // One undo for the turns, and one for the refused value.
        let mut undone = joined;
        (0..2).for_each(|_| _ = undone.act(rubscope::tui::command::Command::Undo));
        assert_eq!(undone.scene, app(scene.clone()).scene);
    }
}

/// What failed before the key that quits came, with no screen in between.
#[test]
fn a_reason_that_no_screen_showed_is_kept_and_one_that_was_shown_is_not() {
    let (sender, events) = channel();
    let mut host = Slow { results: Vec::new(), events: sender.clone(), suspended: 0, unseen: None };
    let failed = || ScreenEvent::Written(FileResult::Failed("no room".into()));
    for shown in [false, true] {
        sender.send(failed()).unwrap();
        let mut one = Pictures { left: 1, events: sender.clone() };
        let mut none = Stepwise::new(1e-4);
        let engine: &mut dyn Engine = if shown { &mut one } else { &mut none };
        if !shown {
            sender.send(key('q')).unwrap();
        }
        run_with(&events, &mut app(Scene::base()), engine, &mut host);
        assert_eq!(host.unseen.take().is_some(), !shown);
        while events.try_recv().is_ok() {}
    }
}

#[test]
fn a_bin_longer_than_a_turn_of_the_wave_shows_its_whole_swing() {
    // Free vibration without damping, in bins of five periods.
    let mut scene = Scene::base();
    scene.casing.damping_ratio = 0.0;
    scene.operation.pulse_n = 0.0;
    scene.initial.u_c_m = 5e-5;
    scene.solver.end_s = 1.0;
    let mut order = app(scene).order();
    let period = TAU / order.scene.machine().omega_c;
    order.page = (0.0, 1024.0 * 5.0 * period);
    let mut engine = Stepwise::new(1e-4);
    engine.order(&order);
    let page = engine.take().unwrap().results.page.unwrap();
    assert!(page.is_whole && page.bins.len() > 3);
    for bin in &page.bins[..3] {
        // 24 samples a turn miss a top by less than one in a hundred.
        let [low, high] = [bin.low, bin.high].map(|ends| ends[Channel::UC as usize] / 5e-5);
        assert!((-1.0 - 1e-9..-0.99).contains(&low), "{low}");
        assert!((0.99..1.0 + 1e-9).contains(&high), "{high}");
    }
}

/// Its answer to an order comes after the frame that the key asked for.
struct Later {
    engine: Stepwise,
    events: Sender<ScreenEvent>,
    asked: u32,
}

impl Engine for Later {
    fn order(&mut self, order: &Order) {
        self.engine.order(order);
        self.asked = 0;
        self.events.send(ScreenEvent::Fresh).unwrap();
    }

    fn take(&mut self) -> Option<Snapshot> {
        self.asked += 1;
        match self.asked {
            // For the first picture: the answer comes when it is drawn.
            2 => {
                self.events.send(ScreenEvent::Fresh).unwrap();
                None
            }
            3 => self.engine.take(),
            4 => {
                // The picture that follows shows the answer.
                self.events.send(ScreenEvent::Signal(15)).unwrap();
                None
            }
            _ => None,
        }
    }
}

#[test]
fn a_forecast_is_drawn_when_it_exists_and_not_at_the_next_frame() {
    let (sender, events) = channel();
    end_in_a_minute(&sender);
    let (mut app, mut terminal) = (app(short()), screen(80, 24));
    let mut engine = Later { engine: Stepwise::new(1e-4), events: sender, asked: 0 };
    let frame = Duration::from_secs(3600);
    let host = &mut NoHost;
    let exit = rubscope::tui::run(&mut terminal, &events, &mut app, &mut engine, host, frame);
    assert_eq!(exit.unwrap(), Exit::Signal(15), "it waits for the frame");
    let line = top(&terminal, 80);
    assert!(!line.contains("computing"), "{line}");
    assert!(line.contains(&format!(" {} ", app.verdict_word())), "{line}");
}

#[test]
fn the_verdict_of_the_value_before_stays_with_it_until_there_is_a_new_one() {
    let mut app = app(short());
    assert_eq!(app.verdict_word(), "computing");
    let (mut engine, first) = answer(&app);
    app.apply_snapshot(first);
    let before = app.sentence(80);
    assert!(before.word != "computing" && !before.what.contains("Computing"));
    for _ in 0..2 {
        press(&mut app, 'l');
        let dimmed = app.sentence(80);
        assert_eq!(dimmed.word, format!("at 500 rad/s: {}", before.word));
        assert_eq!(dimmed.what, "Computing the run.");
    }
    engine.order(&app.order());
    app.apply_snapshot(engine.take().unwrap());
    assert!(!app.sentence(80).what.contains("Computing"));
}

/// An engine that has nothing new.
struct Silent;

impl Engine for Silent {
    fn order(&mut self, _: &Order) {}

    fn take(&mut self) -> Option<Snapshot> {
        None
    }
}

fn top(terminal: &Terminal<TestBackend>, width: u16) -> String {
    (0..width).map(|x| terminal.backend().buffer().cell((x, 0)).unwrap().symbol()).collect()
}

#[test]
fn an_answer_to_an_older_value_is_told_with_it_however_late_it_comes() {
    let mut app = app(short());
    let (_, late) = answer(&app);
    press(&mut app, 'l');
    assert_eq!(app.verdict_word(), "computing");
    assert!(!app.apply_snapshot(late));
    let word = app.verdict_word();
    assert!(word.starts_with("at 500 rad/s: "), "{word}");
    // Of two knobs no one value says what it was of.
    press(&mut app, 'j');
    press(&mut app, 'l');
    assert_eq!(app.verdict_word(), "computing");
}

#[test]
fn a_screen_too_small_for_the_question_takes_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    for (height, replaced) in [(1, false), (24, true)] {
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, "old").unwrap();
        let (mut app, mut terminal) = (app(Scene::base()), screen(80, height));
        app.files.directory = folder.path().to_path_buf();
        for keys in ["s\n", "y"] {
            let (sender, events) = channel();
            keys.chars().for_each(|letter| sender.send(key(letter)).unwrap());
            drop(sender);
            let (mut engine, frame) = (Stepwise::new(1e-4), Duration::ZERO);
            let host = &mut NoHost;
            rubscope::tui::run(&mut terminal, &events, &mut app, &mut engine, host, frame).unwrap();
        }
        assert_eq!(std::fs::read_to_string(&path).unwrap() != "old", replaced, "{height}");
    }
}
