//! The law of key streams: after any keys at any sizes, the explorer draws a
//! screen of characters, and its scene is one that can be solved.

use std::sync::{LazyLock, mpsc};
use std::time::Duration;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::engine::{Engine, Order, Snapshot};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::worker::{PLAY_TIME, Playback};
use rubscope::tui::{App, Exit, Marker, Theme, run};
use rubscope_solver::scene::Scene;

use crate::stepwise::NoHost;
use crate::tui_random::bound_keys;

/// Most bytes of one stream.
const LONGEST: usize = 400;
/// Keys between two pictures.
const ROUND: usize = 6;
/// From this byte on, a byte is no key: the next two are a size.
const SIZE: u8 = 250;

/// Characters that are typed. No slash: files stay in their folder.
const TYPED: &str = "0123456789.-+eEkMuµn,:= abx\u{1b}\u{7f}\u{202e}é漢\u{301}";

/// The keys, by number.
static KEYS: LazyLock<Vec<KeyEvent>> = LazyLock::new(|| {
    let mut keys = bound_keys();
    let typed =
        TYPED.chars().map(|letter| KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
    keys.extend(typed);
    keys.push(KeyEvent::new(KeyCode::Char('j'), KeyModifiers::ALT));
    keys.push(KeyEvent::new(KeyCode::F(5), KeyModifiers::NONE));
    assert!(keys.len() < SIZE as usize, "more keys than bytes");
    keys
});

/// The engine of the explorer, a slice of work at a look.
struct Sliced(Option<Playback>, Option<Order>);

impl Engine for Sliced {
    fn order(&mut self, order: &Order) {
        self.1 = Some(order.clone());
    }

    fn take(&mut self) -> Option<Snapshot> {
        let order = self.1.as_ref()?;
        let playback = self.0.get_or_insert_with(|| Playback::new(order.clone(), PLAY_TIME));
        playback.apply(order);
        if playback.is_computing() {
            playback.compute();
        }
        if order.playing {
            playback.play(1e-4, false);
        }
        Some(playback.snapshot())
    }
}

/// A byte is a key, or announces a size.
pub fn keys(data: &[u8]) {
    let files = tempfile::tempdir().unwrap();
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 2e-3);
    let mut app = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille);
    app.files.directory = files.path().to_path_buf();
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    let mut engine = Sliced(None, None);
    let mut waiting = Vec::new();
    let mut bytes = data.iter().take(LONGEST);
    while let Some(&byte) = bytes.next() {
        if byte < SIZE {
            waiting.push(KEYS[byte as usize % KEYS.len()]);
        } else {
            let mut side = || u16::from(bytes.next().copied().unwrap_or(0));
            let (width, height) = (side(), side());
            terminal.backend_mut().resize(width, height);
        }
        if byte >= SIZE || waiting.len() >= ROUND {
            picture(&mut terminal, &mut app, &mut engine, &mut waiting);
        }
    }
    picture(&mut terminal, &mut app, &mut engine, &mut waiting);
    // Once more: a screen depends on the state, not on what was there before.
    picture(&mut terminal, &mut app, &mut engine, &mut waiting);
}

/// Sends the keys, draws, and looks at the screen.
fn picture(
    terminal: &mut Terminal<TestBackend>,
    app: &mut App,
    engine: &mut Sliced,
    keys: &mut Vec<KeyEvent>,
) {
    let (sender, events) = mpsc::channel();
    sender.send(ScreenEvent::Resize).unwrap();
    keys.drain(..).for_each(|key| sender.send(ScreenEvent::Key(key)).unwrap());
    drop(sender);
    let exit = run(terminal, &events, app, engine, &mut NoHost, Duration::ZERO);
    assert_eq!(exit.unwrap(), Exit::Done);
    app.scene.checked().unwrap();
    for cell in &terminal.backend().buffer().content {
        let plain = |c: char| !c.is_control() && !('\u{202a}'..='\u{202e}').contains(&c);
        assert!(cell.symbol().chars().all(plain), "{:?} on the screen", cell.symbol());
    }
}

/// The bytes of keys, given as characters; each stands for the first key of it.
fn stream(text: &str) -> Vec<u8> {
    let number = |letter: char| {
        let code = match letter {
            '\n' => KeyCode::Enter,
            '\t' => KeyCode::Tab,
            '\u{8}' => KeyCode::Backspace,
            letter => KeyCode::Char(letter),
        };
        KEYS.iter().position(|key| key.code == code)
    };
    text.chars().filter_map(number).map(|place| place as u8).collect()
}

/// Knobs, views, dialogs, a lesson, files and sizes.
pub fn seeds() -> Vec<Vec<u8>> {
    let texts = [
        "jjlLhHkuu",
        "\n20k\n\u{8}\n1e-7\n",
        "\t\t\t\t\t\t\t\t12345678ijl\n",
        "s\ns\nye\n",
        "?jjj?tm",
        "g\nggggG",
        "jjjjjjjlll",
        "xllxpp..n",
        "cvbwf[[]]++-=a",
        "(){}<>rb",
        "5jlLL6c7r",
    ];
    let mut seeds: Vec<Vec<u8>> = texts.map(stream).to_vec();
    for (width, height) in [(0, 0), (1, 1), (20, 5), (80, 24), (255, 255), (255, 1), (1, 255)] {
        let mut seed = vec![SIZE, width, height];
        seed.extend(stream("?\t\tfv"));
        seeds.push(seed);
    }
    seeds
}
