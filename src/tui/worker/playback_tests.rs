//! Tests of the playback against plain runs of the solver.

use super::*;
use crate::tui::film::{FilmPlan, in_blade_frame};
use crate::tui::{App, Marker, Theme};
use rubscope_solver::motion::Motion;
use rubscope_solver::scene::Scene;

fn order(scene: Scene) -> Order {
    let app = App::new(scene.checked().unwrap(), Theme::Mono, Marker::Ascii);
    Order { rate: 5e-3, slow_at_events: false, ..app.order() }
}

fn settle(playback: &mut Playback) {
    while playback.is_computing() {
        playback.compute();
    }
}

fn computed(order: &Order) -> Playback {
    let mut playback = Playback::new(order.clone(), Duration::MAX);
    settle(&mut playback);
    playback
}

/// Applies an order with another film.
fn refilmed(playback: &mut Playback, order: &mut Order, film: FilmPlan) {
    (order.film, order.number) = (film, order.number + 1);
    playback.apply(order);
    settle(playback);
}

#[test]
fn a_turning_picture_turns_an_eighth_between_two_frames_at_most() {
    let mut order = order(Scene::builtin("undamped").unwrap());
    order.open = vec![ViewId::Frame];
    order.rate = 0.1;
    let mut playback = computed(&order);
    let phase = |playback: &Playback| {
        let motion = &playback.head.at.motion;
        let (state, machine) = (motion.state(), motion.machine());
        let turned = machine.nodal_diameters * motion.rotor().angle(state.t_s);
        let [x, y] = in_blade_frame(state.u, turned);
        (y.atan2(x), state.amplitude() > 0.05 * machine.clearance())
    };
    let (mut frames, mut limited) = (0, 0);
    while playback.t < 0.02 {
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
    assert!((playback.t - 0.0165).abs() < 1e-4);
}

#[test]
fn a_jump_stops_at_the_change_of_contact_at_any_zoom() {
    // The first two impacts of the event solver, as a plain run records them.
    let scene = Scene::builtin("rocking").unwrap();
    let mut run = Motion::new(&scene.clone().checked().unwrap());
    run.advance(scene.solver.end_s).unwrap();
    let impacts: Vec<f64> = run.contacts().impacts.iter().map(|impact| impact.t_s).collect();
    for page_s in [1e-6, 2e-2, 1.0] {
        let mut order = Order { page: (0.0, page_s), playing: false, ..order(scene.clone()) };
        let mut playback = computed(&order);
        for impact in impacts.iter().take(2) {
            let number = order.moves.push(Move::NextChange);
            playback.apply(&order);
            let snapshot = playback.snapshot();
            let now = snapshot.moment.unwrap().state.t_s;
            assert!((now - impact).abs() <= 1e-12 * impact.max(1e-6), "{now} {impact}");
            let (number_met, met) = snapshot.met;
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
        playback.play(8e-3, false);
        // Times before and after that of the motion.
        for t in [0.0, 1.8e-3, 7.3e-3, 9.1e-3] {
            order.cursor_s = Some(t);
            playback.apply(&order);
            let snapshot = playback.snapshot();
            let read = snapshot.moment.unwrap();
            let mut run = Motion::new(&scene.clone().checked().unwrap());
            run.advance(t).unwrap();
            assert_eq!(read.state, run.state(), "{name} at {t}");
            assert_eq!(read.gaps, run.blade_gaps());
            assert_eq!(snapshot.t_s, 8e-3);
        }
    }
}

#[test]
fn a_change_acts_on_both_laws_at_its_instant_and_undo_takes_it_away() {
    let mut scene = Scene::base();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 3e-3);
    let mut order = Order { compare: true, ..order(scene) };
    let mut playback = computed(&order);
    let results = |playback: &mut Playback| {
        let results = playback.snapshot().results;
        let pages = [results.page, results.comparison_page];
        pages.map(|page| page.unwrap().bins.last().unwrap().high)
    };
    let before = results(&mut playback);
    playback.play(2e-3, false);
    let unchanged = order.film.clone();
    let fired = unchanged.fired(2e-3);
    refilmed(&mut playback, &mut order, fired);
    for (fired, before) in results(&mut playback).iter().zip(&before) {
        assert!(fired != before);
    }
    assert_eq!(playback.t, 2e-3);
    refilmed(&mut playback, &mut order, unchanged);
    assert!(results(&mut playback) == before && playback.t == 2e-3);
}

/// Returns an order for the paper's scene over one millisecond, with both laws.
fn short() -> Order {
    let mut scene = Scene::base();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 1e-3);
    Order { compare: true, ..order(scene) }
}

#[test]
fn steps_and_jumps_are_made_once_each_in_the_order_of_their_keys() {
    let mut order = short();
    let mut playback = computed(&order);
    for (made, to) in [(0, Move::Step), (2, Move::Step), (2, Move::To(5e-4)), (2, Move::Step)] {
        // Each order repeats moves that the screen does not know to be made.
        order.moves.drop_made(made);
        order.moves.push(to);
        playback.apply(&order);
    }
    settle(&mut playback);
    let steps = (playback.head.at.motion.t_s() - 5e-4) / 1e-6;
    assert!((steps - 1.0).abs() < 1e-6, "{steps}");
    assert_eq!(playback.snapshot().moved, order.moves.last);
}
