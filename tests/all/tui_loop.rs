//! The loop of the explorer without new snapshots, and the record of its engine.

use std::f64::consts::TAU;
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

use ratatui::{Terminal, backend::TestBackend};
use rubscope::scene::Scene;
use rubscope::tui::engine::{Engine, Order, Snapshot};
use rubscope::tui::events::ScreenEvent;
use rubscope::tui::history::Channel;
use rubscope::tui::terminal::NoHost;
use rubscope::tui::worker::Stepwise;
use rubscope::tui::{App, Exit, Marker, Theme, run};

/// Ends the loop at the second picture.
struct Second {
    pictures: u32,
    events: Sender<ScreenEvent>,
}

impl Engine for Second {
    fn order(&mut self, _: &Order) {}

    fn take(&mut self) -> Option<Snapshot> {
        self.pictures += 1;
        if self.pictures == 2 {
            self.events.send(ScreenEvent::Signal(15)).unwrap();
        }
        None
    }
}

#[test]
fn a_screen_without_news_is_drawn_again_to_notice_a_lost_terminal() {
    let (sender, events) = channel();
    let watchdog = sender.clone();
    // A long limit, not a speed test: a second is enough on a quiet machine.
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs(60));
        let _ = watchdog.send(ScreenEvent::InputClosed);
    });
    let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
    let mut app = App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille);
    let mut engine = Second { pictures: 0, events: sender };
    let frame = Duration::from_millis(100);
    let exit = run(&mut terminal, &events, &mut app, &mut engine, &mut NoHost, frame);
    assert_eq!(exit.unwrap(), Exit::Signal(15), "nothing was drawn for a minute");
}

#[test]
fn a_bin_longer_than_a_turn_of_the_wave_shows_its_whole_swing() {
    // Free vibration without damping, in bins of five periods.
    let mut scene = Scene::base();
    scene.casing.damping_ratio = 0.0;
    scene.operation.pulse_n = 0.0;
    scene.initial.u_c_m = 5e-5;
    let mut order = App::new(scene.checked().unwrap(), Theme::Dark, Marker::Braille).order();
    order.bin_s = 5.0 * TAU / order.scene.machine().omega_c;
    let mut engine = Stepwise::new(4.0 * order.bin_s);
    engine.order(&order);
    let bins = engine.take().unwrap().bins;
    assert!(bins.len() >= 3);
    for bin in &bins[..3] {
        // 24 samples a turn miss a top by less than one in a hundred.
        let [low, high] = [bin.low, bin.high].map(|ends| ends[Channel::UC as usize] / 5e-5);
        assert!((-1.0 - 1e-9..-0.99).contains(&low), "{low}");
        assert!((0.99..1.0 + 1e-9).contains(&high), "{high}");
    }
}
