//! Random keys at random sizes: no panic, no hang, and never a result of
//! knobs that have been turned since.

use std::sync::mpsc;
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use proptest::prelude::*;
use ratatui::{Terminal, backend::TestBackend};
use rubscope::scene::Scene;
use rubscope::tui::bindings::BINDINGS;
use rubscope::tui::events::Event;
use rubscope::tui::terminal::NoHost;
use rubscope::tui::worker::Stepwise;
use rubscope::tui::{App, Exit, Marker, Theme, run};

/// Every key of the table, and the characters of typed values.
fn any_key() -> impl Strategy<Value = KeyEvent> {
    let mut keys: Vec<KeyEvent> = Vec::new();
    for chord in BINDINGS.iter().flat_map(|binding| binding.keys) {
        let mut modifiers = KeyModifiers::NONE;
        modifiers.set(KeyModifiers::CONTROL, chord.ctrl);
        modifiers.set(KeyModifiers::SHIFT, chord.shift);
        keys.push(KeyEvent::new(chord.code, modifiers));
    }
    // Typing is rare among the bindings and takes several keys: weigh it.
    for letter in "0123456789.-ekMu".chars() {
        keys.push(KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
    }
    for _ in 0..6 {
        keys.push(KeyEvent::new(KeyCode::Enter, KeyModifiers::NONE));
    }
    proptest::sample::select(keys)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, max_shrink_iters: 200, ..ProptestConfig::default() })]
    #[test]
    fn random_keys_at_random_sizes(
        rounds in proptest::collection::vec(
            (0u16..140, 0u16..50, proptest::collection::vec(any_key(), 0..12)), 1..8),
    ) {
        let mut scene = Scene::builtin("paper-nd3").unwrap();
        scene.solver.step_s = 1e-6;
        scene.solver.end_s = 2e-3;
        let mut app = App::new(scene, Theme::Dark, Marker::Braille);
        // Keys at random save and export, too.
        let files = tempfile::tempdir().unwrap();
        app.directory = files.path().to_path_buf();
        let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
        let mut engine = Stepwise::new(1e-4);
        for (width, height, keys) in rounds {
            terminal.backend_mut().resize(width, height);
            let (sender, events) = mpsc::channel();
            sender.send(Event::Resize).unwrap();
            for key in keys {
                sender.send(Event::Key(key)).unwrap();
            }
            drop(sender);
            let exit = run(&mut terminal, &events, &mut app, &mut engine, &mut NoHost, Duration::ZERO);
            prop_assert_eq!(exit.unwrap(), Exit::Done);
            prop_assert!(app.scene.check().is_ok(), "a scene that was refused came through");
            if let Some(moment) = &app.latest.moment {
                prop_assert_eq!(moment.gaps.len(), app.scene.bladed_disk.blades as usize);
            }
        }
    }
}
