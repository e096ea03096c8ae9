//! Answers that come late: the screen never shows a result of knobs that have been turned since.
//! `fuzz_keys` presses keys at random.

use std::collections::VecDeque;
use std::sync::mpsc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::command::table::BINDINGS;
use rubscope::tui::engine::{Engine, FullRunState, Order, Results, Snapshot};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::{App, Exit, Marker, Theme, run};
use rubscope_solver::scene::Scene;

use crate::stepwise::{NoHost, Stepwise};

/// Number of looks that the answers of `Late` are delayed: more than one `press` has.
const DELAY: usize = 3;

/// An engine whose answers come late. The impact count of each result is
/// replaced by the number of the film it was computed for.
struct Late {
    engine: Stepwise,
    kept: VecDeque<Snapshot>,
}

impl Late {
    fn new() -> Self {
        let mut engine = Stepwise::new(1e-4);
        engine.checks = true;
        Self { engine, kept: VecDeque::new() }
    }
}

impl Engine for Late {
    fn order(&mut self, order: &Order) {
        self.engine.order(order);
    }

    fn take(&mut self) -> Option<Snapshot> {
        if let Some(mut snapshot) = self.engine.take() {
            let Snapshot { number, results, .. } = &mut snapshot;
            let Results { full_run, comparison, .. } = results;
            let full_run = match full_run {
                Some(FullRunState::Done(run)) => Some(run),
                _ => None,
            };
            let results = [full_run, comparison.as_mut()].into_iter().flatten();
            results.for_each(|run| std::sync::Arc::make_mut(run).facts.touches = *number);
            self.kept.push_back(snapshot);
        }
        if self.kept.len() > DELAY { self.kept.pop_front() } else { None }
    }
}

/// The results on the screen, as the numbers of the films they belong to; at the end 100 if the
/// event solver has given a verdict.
fn results(app: &App) -> Vec<u64> {
    let Results { full_run, comparison, reference, .. } = &app.run.latest.results;
    let full_run = match full_run {
        Some(FullRunState::Done(run)) => Some(run),
        _ => None,
    };
    let shown = [full_run, comparison.as_ref()];
    let numbers = shown.into_iter().flatten().map(|result| result.facts.touches);
    numbers.chain(reference.map(|_| 100)).collect()
}

fn scene() -> Scene {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    scene.solver.step_s = 1e-6;
    scene.solver.end_s = 2e-3;
    // A motion that fails cannot be changed live.
    scene.operation.pulse_n = 2e4;
    scene
}

/// Sends keys and looks at the screen.
fn press(
    terminal: &mut Terminal<TestBackend>,
    app: &mut App,
    engine: &mut Late,
    keys: impl IntoIterator<Item = KeyEvent>,
) {
    let (sender, events) = mpsc::channel();
    sender.send(ScreenEvent::Resize).unwrap();
    keys.into_iter().for_each(|key| sender.send(ScreenEvent::Key(key)).unwrap());
    drop(sender);
    let exit = run(terminal, &events, app, engine, &mut NoHost, Duration::ZERO);
    assert_eq!(exit.unwrap(), Exit::Done);
}

#[test]
fn a_live_knob_and_a_pulse_drop_every_result_of_the_motion_before() {
    for (live, letter) in [(true, 'h'), (false, 'p')] {
        let mut app = App::new(scene().checked().unwrap(), Theme::Dark, Marker::Braille);
        (app.knobs.live, app.run.compare) = (live, true);
        let mut terminal = Terminal::new(TestBackend::new(120, 40)).unwrap();
        let mut engine = Late::new();
        let mut look = |letter: Option<char>| {
            let key = letter.map(|it| KeyEvent::new(KeyCode::Char(it), KeyModifiers::NONE));
            press(&mut terminal, &mut app, &mut engine, key);
            results(&app)
        };
        assert!(look(None).is_empty());
        assert_eq!((0..DELAY).map(|_| look(None)).last(), Some(vec![0, 0, 100]));
        // The answers that arrive now still belong to the earlier motion.
        assert!(look(Some(letter)).is_empty());
        // The event solver gives no verdict on a motion that was changed live.
        assert_eq!((0..DELAY).map(|_| look(None)).last(), Some(vec![1, 1]));
    }
}

#[test]
fn a_snapshot_of_a_run_before_a_restart_changes_nothing() {
    let mut app = App::new(scene().checked().unwrap(), Theme::Dark, Marker::Braille);
    let mut engine = Stepwise::new(1e-4);
    engine.order(&app.order());
    let old = engine.take().unwrap();
    app.restart();
    assert!(!app.apply_snapshot(old));
    assert!(app.run.latest.moment.is_none() && results(&app).is_empty());
    engine.order(&app.order());
    assert!(app.apply_snapshot(engine.take().unwrap()) && !results(&app).is_empty());
}

/// Every key of the table.
pub fn bound_keys() -> Vec<KeyEvent> {
    let chords = BINDINGS.iter().flat_map(|binding| binding.keys);
    let key = |chord: &rubscope::tui::command::chord::Chord| {
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, chord.ctrl);
        modifiers.set(KeyModifiers::SHIFT, chord.shift);
        KeyEvent::new(chord.code, modifiers)
    };
    chords.map(key).collect()
}
