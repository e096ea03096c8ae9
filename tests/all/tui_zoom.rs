//! The page of time at every zoom: what is drawn is the range of the run in its time, and
//! contact is marked where contact was.

use crate::random::{each_case, one_of};
use rubscope::tui::history::{Bin, Channel, columns, contacts};
use rubscope::tui::{App, Marker, Theme};
use rubscope_solver::motion::{ActiveSet, Motion};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, scene};

/// Columns across a chart, and its cells.
const COLUMNS: usize = 150;
const CELLS: usize = 75;

/// A sample of a run: when, `u_c`, and whether something touched since the one before.
type Sample = (f64, f64, bool);

/// Samples of a run from the start to `to`; many between `from` and there.
fn samples(app: &App, (from, to): (f64, f64)) -> Vec<Sample> {
    let mut motion = Motion::new(&app.run.film.scene);
    let mut out: Vec<Sample> = Vec::new();
    let mut impacts = 0;
    let mut look = |motion: &Motion| {
        let log = motion.contacts();
        let touches = log.active_set != ActiveSet::Nothing || log.impact_count > impacts;
        impacts = log.impact_count;
        if out.last().is_none_or(|(t, ..)| *t < motion.t_s()) {
            out.push((motion.t_s(), motion.state().u[0], touches));
        }
    };
    motion.advance(from).unwrap();
    look(&motion);
    for k in 1..=20 * COLUMNS {
        motion.advance(from + (to - from) * k as f64 / (20 * COLUMNS) as f64).unwrap();
        look(&motion);
    }
    motion.advance(to + app.scene.solver.step_s).unwrap();
    look(&motion);
    out
}

/// The range of the samples around a stretch of time.
fn range(samples: &[Sample], from: f64, to: f64) -> (f64, f64) {
    let first = samples.partition_point(|(t, ..)| *t < from).saturating_sub(1);
    let last = samples.partition_point(|(t, ..)| *t <= to).min(samples.len() - 1);
    let values = samples[first..=last].iter().map(|(_, u, _)| *u);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), u| (a.min(u), b.max(u)))
}

/// The page that is shown, both what is behind and what is to come, against the run.
fn check(app: &App) {
    let page = app.page();
    let (length, end) = (page.1 - page.0, page.1.min(app.end_s()));
    let samples = samples(app, (page.0, end));
    let record: &[Bin] = app.record();
    let largest = samples.iter().fold(0.0_f64, |most, (_, u, _)| most.max(u.abs()));
    // A solver that steps is at its last step by then.
    let reached = record.last().unwrap().to;
    assert!(reached >= end - app.scene.solver.step_s * 1.01, "{reached} of {end}");
    let bin = length / 1024.0;
    let drawn = columns(record, Channel::UC, page, COLUMNS);
    for (k, drawn) in drawn.into_iter().enumerate() {
        let at = |k: usize| page.0 + length * k as f64 / COLUMNS as f64;
        let (from, to) = (at(k), at(k + 1));
        if to > reached {
            break;
        }
        let (low, high) = drawn.unwrap_or_else(|| panic!("nothing in column {k} of {page:?}"));
        // A peak between two samples, 24 a turn, is lower by less than a dot of a chart.
        let dot = 0.01 * largest;
        let (least, most) = range(&samples, from - 1.5 * bin, to + 1.5 * bin);
        assert!(
            low >= least - dot && high <= most + dot,
            "{page:?} {k}: {low} {high} {least} {most}"
        );
        for (t, u, _) in samples.iter().filter(|(t, ..)| (from..to).contains(t)) {
            assert!(low - dot <= *u && *u <= high + dot, "{page:?} {k}, {t}: {u} {low} {high}");
        }
    }
    let step = app.scene.solver.step_s;
    for (k, marked) in contacts(record, page, CELLS).into_iter().enumerate() {
        let at = |k: usize| page.0 + length * k as f64 / CELLS as f64;
        let (from, to) = (at(k), at(k + 1));
        let near = |t: f64, by: f64| t >= from - by && t <= to + by;
        // A sample tells of the time since the one before.
        let dt = (end - page.0) / (20 * COLUMNS) as f64;
        let by = dt
            + if app.scene.solver.kind == rubscope_solver::scene::SolverKind::Explicit {
                step
            } else {
                0.0
            };
        let touched = samples.iter().any(|(t, _, touches)| *touches && near(*t, by));
        assert!(!marked || touched, "{page:?}: a contact in cell {k}, from {from} to {to}");
        let inside = samples
            .iter()
            .any(|(t, _, touches)| *touches && *t - by > from && *t < to && *t < reached);
        assert!(marked || !inside, "{page:?}: no contact in cell {k}");
    }
}

fn open(name: &str) -> Session {
    let scene = match name {
        "paper-nd3" => scene(),
        name => {
            let mut scene = Scene::builtin(name).unwrap();
            scene.solver.end_s = 0.02;
            scene
        }
    };
    Session::with_stride((170, 40), 2e-3, scene, Theme::Mono, Marker::Braille)
}

#[test]
fn every_column_is_the_range_of_the_run_at_any_zoom_and_page() {
    each_case(8, |rng| {
        let name = one_of(rng, &["paper-nd3", "rocking", "slip", "coincidence"]);
        let (played, zoom, pages) = (rng.usize(0..5), rng.i32(-3..13), rng.i32(-3..8));
        let mut session = open(name);
        session.press_each(&format!("{} ", ".".repeat(played)));
        session.press_each(&if zoom < 0 { "-" } else { "+" }.repeat(zoom.unsigned_abs() as usize));
        session
            .press_each(&if pages < 0 { ">" } else { "<" }.repeat(pages.unsigned_abs() as usize));
        // A motion that plays on may just have come to a page that is not computed yet.
        if session.app.play.playing {
            session.press_each(" ");
        }
        check(&session.app);
    });
}

#[test]
fn a_zoom_on_the_first_impact_shows_the_flight_before_it() {
    let mut session = open("paper-nd3");
    session.press_each(" r");
    session.press_each("n++++++");
    check(&session.app);
    let app = &session.app;
    let first = app.now();
    assert_eq!(app.page(), (0.0, 2e-4));
    let marked = contacts(app.past_and_future(app.record()).0, app.page(), CELLS);
    let cell = (first / 2e-4 * CELLS as f64) as usize;
    assert_eq!(marked.iter().position(|marked| *marked), Some(cell), "{first} {marked:?}");
    // Free flight from rest under a constant force: a quarter of the way at half the time.
    let u = |t: f64| app.record().iter().find(|bin| bin.to >= t).unwrap().middle(Channel::UC);
    let part = u(0.5 * first) / u(first);
    assert!((0.2..0.3).contains(&part), "{part}");
}

#[test]
fn the_gap_of_a_blade_at_an_instant_is_read_in_every_chart() {
    let mut session = open("rocking");
    session.press_each(":t 0.3 ms\n");
    assert_eq!((session.app.reading.at_s, session.app.play.playing), (Some(3e-4), false));
    assert_eq!(session.app.status.as_deref(), Some("paused at 300.000 µs"));
    assert!(session.rows()[1].starts_with("NOW 300.0 µs touching 12 ‖"), "{}", session.text());
    let mut motion = Motion::new(&session.app.scene);
    motion.advance(3e-4).unwrap();
    let wanted = format!("blade 7: {:.1}", 1e6 * motion.blade_gaps()[6]);
    session.press_each(":blade 7\n");
    let text = session.text();
    assert!(text.contains(&wanted) && text.contains("at 300.000 µs"), "{wanted}\n{text}");
    let said = session.app.status.clone().unwrap();
    assert!(said.starts_with("blade 7: gap ") && said.ends_with(" at 300.000 µs"), "{said}");
    // The file names the instant, and has its gaps.
    let file = session.app.panel().file(&session.app, "csv").unwrap();
    let row = format!("0.0003,7,{}", motion.blade_gaps()[6]);
    assert!(file.starts_with("t_s,blade,gap_m\n") && file.contains(&row), "{row}\n{file}");
    // The arrows go back to the knobs, and the instant stays.
    session.press_each("i");
    assert_eq!((session.app.reading.on, session.app.reading.at_s), (false, Some(3e-4)));
    session.press_each("i41");
    assert_eq!(session.app.reading.at_s, Some(3e-4));
    // The cursor goes on from there, and the end of reading is the end of it.
    session.press_each("l");
    let page = session.app.page_s();
    assert!((session.app.reading.at_s.unwrap() - 3e-4 - 0.01 * page).abs() < 1e-12);
    session.press_each("\u{1b}2");
    assert_eq!((session.app.reading.at_s, session.app.reading.cursor), (None, None));
}

#[test]
fn the_end_of_the_run_and_any_instant_are_one_command_away() {
    for name in ["rocking", "paper-nd3"] {
        let mut session = open(name);
        session.engine.stride = 1e-15;
        session.press_each("E");
        let end = session.app.scene.solver.end_s;
        let step = session.app.scene.solver.step_s;
        assert!((session.app.now() - end).abs() <= step && !session.app.play.playing, "{name}");
        // The whole page of the end is there, although it was not played.
        check(&session.app);
        assert!(session.app.played_s() < 0.01, "nothing was played");
        session.press_each(" ");
        assert!((session.app.played_s() - end).abs() <= step, "{name}: goes on from the cursor");
        // What is behind begins again, with the state of a run that stops there.
        session.press_each(":t 1.25 ms\n");
        let mut motion = Motion::new(&session.app.scene);
        motion.advance(1.25e-3).unwrap();
        for goes_on in ["", " "] {
            session.press_each(goes_on);
            let moment = session.app.shown().unwrap();
            assert_eq!(
                moment.state.u.map(|u| (1e12 * u).round()),
                motion.state().u.map(|u| (1e12 * u).round()),
                "{name}"
            );
            check(&session.app);
        }
        assert!(session.app.play.playing && session.app.reading.at_s.is_none());
    }
    let mut session = open("rocking");
    session.press_each(":t 9\n");
    let status = session.app.status.clone().unwrap();
    assert_eq!(status, "t = 9.000 s: from 0 to 20.00 ms, the end of the run");
}

#[test]
fn zoom_keeps_the_cursor_in_the_middle_and_stays_inside_the_run() {
    let mut session = open("rocking");
    session.engine.stride = 1e-12;
    session.press_each("1:t 12 ms\n");
    let page = |session: &Session| {
        let (from, to) = session.app.page();
        [from, to].map(|t| (1e6 * t).round() / 1e6)
    };
    assert_eq!(page(&session), [0.0, 0.02]);
    for (keys, wanted) in [("+", [7e-3, 17e-3]), ("++", [11e-3, 13e-3]), ("-", [9.5e-3, 14.5e-3])] {
        session.press_each(keys);
        assert_eq!(page(&session), wanted, "{keys}");
    }
    check(&session.app);
    // At the ends of the run the page is as far as it goes; it is never longer than the run.
    session.press_each("--------");
    assert_eq!((page(&session), session.app.play.tempo.zoom), ([0.0, 0.02], 0));
    session.press_each("-");
    assert!(session.app.status.as_ref().is_some_and(|said| said.contains("changes nothing")));
    session.press_each("++E");
    assert_eq!(page(&session), [0.015, 0.02]);
    session.press_each("<<<<>");
    assert_eq!(page(&session), [5e-3, 0.01]);
    assert!(session.rows()[1].contains("2 back"), "{}", session.rows()[1]);
    // The usual page is where NOW is, with a cursor and without one.
    session.press_each("=");
    assert_eq!(page(&session), [0.0, 0.02]);
    session.press_each("\u{1b}++>>=");
    assert_eq!((page(&session), session.app.play.middle_s), ([0.0, 0.02], None));
}

#[test]
fn steps_and_jumps_go_on_from_the_cursor() {
    let mut session = open("rocking");
    session.engine.stride = 1e-12;
    // Ahead of the motion, and behind it.
    for from in [13e-3, 3e-4] {
        session.press_each(&format!(":t {from}\nn"));
        let marks = session.app.full_run().unwrap().marks.clone();
        let next = marks.iter().find(|mark| mark.t_s > from).unwrap().t_s;
        assert!((session.app.now() - next).abs() < 1e-12, "{} {next}", session.app.now());
        let said = session.app.status.clone().unwrap_or_default();
        assert!(said.contains(" ms: touching ") && session.app.reading.at_s.is_none(), "{said}");
        session.press_each(".");
        assert!(session.app.now() > next && !session.app.play.playing);
    }
    // A pulse acts at the instant that the cursor shows, and says so.
    session.press_each(":t 9 ms\np");
    let said = session.app.status.clone().unwrap();
    assert!(said.contains(" fired at 9.00") && session.app.reading.at_s.is_none(), "{said}");
}
