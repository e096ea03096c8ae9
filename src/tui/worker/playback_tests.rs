//! Tests of the playback against plain runs of the solver.

use super::*;
use crate::tui::{App, Marker, Theme};
use rubscope_solver::scene::Scene;

fn order(scene: Scene) -> Order {
    let app = App::new(scene.checked().unwrap(), Theme::Mono, Marker::Ascii);
    Order { rate: 5e-3, bin_s: 2e-5, slow_at_events: false, ..app.order() }
}

fn computed(order: &Order) -> Playback {
    let mut playback = Playback::with_time_limit(order.clone(), Duration::MAX);
    while playback.is_computing() {
        playback.compute();
    }
    playback
}

#[test]
fn a_turning_picture_turns_an_eighth_between_two_frames_at_most() {
    let mut order = order(Scene::builtin("undamped").unwrap());
    order.open = vec![ViewId::Frame];
    order.rate = 0.1;
    let mut playback = computed(&order);
    let phase = |playback: &Playback| {
        let (state, machine) = (playback.motion.state(), playback.motion.machine());
        let turned = machine.nodal_diameters * playback.motion.rotor().angle(state.t_s);
        let [x, y] = super::super::recorder::in_blade_frame(state.u, turned);
        (y.atan2(x), state.amplitude() > 0.05 * machine.clearance())
    };
    let (mut frames, mut limited) = (0, 0);
    while playback.motion.t_s() < 0.02 {
        let (before, shown) = phase(&playback);
        // Several ticks of the clock per frame.
        for _ in 0..5 {
            playback.play_paced(Duration::from_millis(33));
        }
        limited += u32::from(playback.limit == Limit::Wave);
        let (after, still) = phase(&playback);
        let turn = (after - before).rem_euclid(std::f64::consts::TAU);
        let turn = turn.min(std::f64::consts::TAU - turn) / std::f64::consts::TAU;
        assert!(!shown || !still || turn <= 0.125 + 1e-9, "{turn}");
        playback.drawn();
        frames += 1;
        assert!(frames < 2000);
    }
    assert!(limited > 10, "{limited} of {frames}");
    // Without the wheel or the gaps on the screen, nothing limits the rate.
    order.open = vec![ViewId::Response];
    let mut playback = computed(&order);
    (0..5).for_each(|_| _ = playback.play_paced(Duration::from_millis(33)));
    assert!((playback.motion.t_s() - 0.0165).abs() < 1e-4);
}

#[test]
fn the_motion_waits_at_the_end_of_its_forecast_and_goes_on_when_asked() {
    for name in ["paper-nd3", "rocking"] {
        let mut scene = Scene::builtin(name).unwrap();
        (scene.solver.end_s, scene.solver.step_s) = (5e-3, 2e-7);
        let mut order = order(scene);
        let mut playback = computed(&order);
        playback.play(1.0);
        playback.play(1.0);
        let snapshot = playback.snapshot();
        let moment = snapshot.moment.unwrap();
        assert!((moment.state.t_s - 5e-3).abs() < 2.1e-7 && moment.ends == 1, "{name}");
        order.extensions = 1;
        playback.apply(&order);
        assert!((playback.forecasts.full_run.end() - 1e-2).abs() < 3e-7);
        playback.play(1e-3);
        assert!(playback.motion.t_s() > 5.9e-3);
    }
}

#[test]
fn a_jump_stops_at_the_change_of_contact_at_any_zoom() {
    // The first two impacts of the event solver, as a plain run records them.
    let scene = Scene::builtin("rocking").unwrap();
    let mut run = Motion::new(&scene.clone().checked().unwrap());
    run.advance(scene.solver.end_s).unwrap();
    let impacts: Vec<f64> = run.contacts().impacts.iter().map(|impact| impact.t_s).collect();
    for bin_s in [1e-9, 2e-5, 1e-3] {
        // A page of 1024 bins, as on the screen.
        let mut order = Order { bin_s, page: (0.0, 1024.0 * bin_s), ..order(scene.clone()) };
        let mut playback = computed(&order);
        for (number, impact) in (1..).zip(impacts.iter().take(2)) {
            order.jumps = number;
            order.playing = false;
            playback.apply(&order);
            let now = playback.motion.t_s();
            assert!((now - impact).abs() <= 1e-12 * impact.max(1e-6), "{now} {impact}");
            let (number_met, met) = playback.snapshot().moment.unwrap().met;
            assert_eq!((number_met, met.unwrap().t_s), (number, *impact));
        }
    }
}

#[test]
fn the_reading_cursor_has_the_state_of_a_run_that_stops_there() {
    for name in ["rocking", "paper-nd3"] {
        let mut scene = Scene::builtin(name).unwrap();
        scene.solver.end_s = 0.01;
        let mut order = order(scene.clone());
        let mut playback = computed(&order);
        playback.play(8e-3);
        // Times before and after that of the motion.
        for t in [0.0, 1.8e-3, 7.3e-3, 9.1e-3] {
            order.cursor_s = Some(t);
            playback.apply(&order);
            let read = playback.snapshot().results.reading.unwrap();
            let mut run = Motion::new(&scene.clone().checked().unwrap());
            run.advance(t).unwrap();
            assert_eq!(read.state, run.state(), "{name} at {t}");
            assert_eq!(read.gaps, run.blade_gaps());
        }
    }
}

#[test]
fn the_reading_cursor_knows_changes_of_the_motion() {
    let mut order = order(Scene::builtin("rocking").unwrap());
    let mut playback = computed(&order);
    playback.play(2e-3);
    order.pulses += 1;
    playback.apply(&order);
    playback.play(3e-3);
    let now = playback.motion.state();
    order.cursor_s = Some(now.t_s);
    playback.play(1e-3);
    playback.apply(&order);
    assert_eq!(playback.snapshot().results.reading.unwrap().state, now);
}

#[test]
fn a_comparison_that_is_slow_catches_up_before_a_change_acts_on_both() {
    let mut scene = Scene::base();
    scene.solver.step_s = 1e-6;
    scene.solver.end_s = 1e-3;
    let mut order = order(scene);
    let mut playback = Playback::with_time_limit(order.clone(), Duration::MAX);
    playback.play(2e-3);
    // The comparison is requested late and has no time: one sample per call.
    playback.time_limit = Duration::ZERO;
    order.compare = true;
    playback.apply(&order);
    assert!(playback.behind && playback.is_computing());
    order.pulses += 1;
    playback.apply(&order);
    let (now, theirs) = (playback.motion.t_s(), playback.comparison.as_ref().unwrap());
    assert!(!playback.behind && now - theirs.motion.t_s() < 1.5e-6, "{now}");
    assert_eq!(theirs.motion.pulse().start, playback.motion.pulse().start);
    while playback.is_computing() {
        playback.compute();
    }
}

/// Returns an order for the paper's scene over one millisecond, with both laws.
fn short() -> Order {
    let mut scene = Scene::base();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 1e-3);
    Order { compare: true, ..order(scene) }
}

#[test]
fn a_change_of_the_motion_forgets_the_pages() {
    let mut order = short();
    let mut playback = computed(&order);
    let known = |playback: &Playback| {
        let theirs = playback.comparison.as_ref().unwrap();
        [&playback.page, &theirs.page].map(|page| page.record().is_some())
    };
    assert_eq!(known(&playback), [true; 2]);
    order.pulses += 1;
    playback.apply(&order);
    assert_eq!(known(&playback), [false; 2]);
}

#[test]
fn going_to_an_instant_neither_goes_back_nor_beyond_the_run() {
    let mut order = short();
    let mut playback = computed(&order);
    playback.play(8e-4);
    let now = playback.motion.t_s();
    for (to, reached) in [(2e-4, now), (9e-4, 9e-4), (1.0, 1e-3)] {
        order.goes += 1;
        order.go_to_s = to;
        playback.apply(&order);
        while playback.is_computing() {
            playback.compute();
        }
        let now = playback.motion.t_s();
        assert!((now - reached).abs() < 1.1e-6, "{to}: {now}");
        let ends = playback.snapshot().moment.unwrap().ends;
        assert_eq!(ends, u64::from(to == 1.0), "{to}");
    }
}

#[test]
fn the_rate_reached_is_forgotten_where_another_is_asked_for() {
    let mut order = short();
    let mut playback = computed(&order);
    playback.reached.add(1.0, 5e-3);
    playback.apply(&order);
    assert_eq!(playback.reached.rate(), Some(5e-3));
    order.rate *= 2.0;
    playback.apply(&order);
    assert_eq!(playback.reached.rate(), None);
}

#[test]
fn pages_take_turns_with_the_run_ahead_and_wait_for_an_arrival() {
    let mut playback = Playback::with_time_limit(short(), Duration::MAX);
    playback.going = Some(1e-3);
    assert!(!playback.compute_page() && !playback.pages_are_done());
    playback.going = None;
    // The full run has the first slice, because its verdict is wanted first.
    assert!(!playback.compute_page() && !playback.pages_are_done());
    while !playback.pages_are_done() {
        playback.compute();
    }
    assert!(!playback.forecasts.full_run.wall().is_zero());
}
