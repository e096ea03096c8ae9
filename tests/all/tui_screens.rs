//! Whole screens of the explorer: its first screen, its views, its themes, and how
//! it says what it finds.

use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, scene};

#[test]
fn the_first_screen_at_four_sizes() {
    for (width, height) in [(80, 24), (120, 40), (40, 12), (200, 50)] {
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
fn scenes_of_each_kind_of_end_at_two_sizes() {
    for name in ["slip", "rub", "grazing"] {
        for (width, height) in [(80, 24), (120, 40)] {
            let scene = Scene::builtin(name).unwrap();
            let session = Session::open(width, height, scene, Theme::Dark, Marker::Braille);
            insta::assert_snapshot!(format!("{name}_{width}x{height}"), session.text());
        }
    }
}

#[test]
fn an_adhesive_lock_is_never_called_locked_without_saying_so() {
    let mut scene = Scene::builtin("adhesive").unwrap();
    scene.solver.step_s = 2e-7;
    let session = Session::open(100, 30, scene, Theme::Dark, Marker::Braille);
    let text = session.text();
    let state = "Blade 19 pushes the wave and blade 12 pulls it: no real contact can.";
    assert!(text.contains(" ADHESIVE ") && text.contains(state), "{text}");
}

#[test]
fn a_run_that_pulls_and_is_sensitive_says_both_and_no_exact_instant() {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    scene.operation.pulse_n = 42_171.451_712_342_3;
    (scene.solver.step_s, scene.solver.end_s) = (2e-7, 30e-3);
    let session = Session::open(200, 40, scene, Theme::Dark, Marker::Braille);
    let rows = session.rows();
    assert!(rows[0].contains(" only pushes ") && rows[0].contains("A tiny change"), "{}", rows[0]);
    assert!(rows[1].contains("AT 30 ms ") && !rows[1].contains(" since "), "{}", rows[1]);
    assert!(!rows[1].contains("until"), "{}", rows[1]);
    // It is told how to audit it, on the usual screen, too.
    let scene = session.app.scene.clone().into_scene();
    for width in [80, 200] {
        let session = Session::open(width, 24, scene.clone(), Theme::Dark, Marker::Braille);
        assert!(session.rows()[1].contains("audit: run --plain"), "{}", session.rows()[1]);
    }
    let sure = Session::open(200, 24, self::scene(), Theme::Dark, Marker::Braille);
    assert!(!sure.rows()[1].contains("audit"), "{}", sure.rows()[1]);
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
fn every_view_with_the_large_chart_at_120_by_40() {
    for digit in ['1', '2', '3', '4', '5', '6', '8'] {
        let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
        session.press(&if digit == '4' { "f".into() } else { digit.to_string() });
        insta::assert_snapshot!(format!("view_{digit}"), session.text());
    }
}

#[test]
fn a_rotor_that_turns_backward_has_campbell_lines_of_its_own() {
    // The marks where lines meet that of the casing, by column from the left.
    let marks = |speed: f64| {
        let mut scene = scene();
        scene.operation.speed_rad_s = speed;
        let mut session = Session::open(120, 40, scene, Theme::Dark, Marker::Ascii);
        session.press("6f ");
        let text = session.text();
        let row = text.lines().rfind(|line| line.matches('@').count() == 3);
        let row = row.unwrap_or_else(|| panic!("no row with three marks in {text}")).to_string();
        let at = |(place, _)| u32::try_from(place).unwrap();
        (text, row.match_indices('@').map(at).collect::<Vec<u32>>())
    };
    let (forward, right) = marks(500.0);
    let (backward, left) = marks(-500.0);
    assert!(forward.contains(" 600") && !forward.contains("-600"), "{forward}");
    assert!(backward.contains("-600") && !backward.contains(" 600"), "{backward}");
    // One picture is the mirror image of the other.
    let sums: Vec<u32> = right.iter().zip(left.iter().rev()).map(|(a, b)| a + b).collect();
    assert!(sums.iter().all(|sum| sum.abs_diff(sums[0]) <= 1), "{right:?} {left:?}");
}

#[test]
fn a_wide_first_line_has_the_cost_of_a_step_taken_and_the_part_skipped() {
    let session = Session::open(300, 30, scene(), Theme::Dark, Marker::Braille);
    let text = session.text();
    let line = text.lines().nth(1).unwrap();
    assert!(line.contains("42 ns/step taken, 94.") && line.contains(" % skipped, "), "{line}");
}

#[test]
fn speed_against_error_shows_every_kind_of_solver_and_exports_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene();
    scene.solver.end_s = 2e-3;
    scene.solver.contact = rubscope_solver::scene::ContactLaw::Unilateral;
    scene.operation.pulse_n = 2e4;
    let mut session = Session::open(120, 40, scene, Theme::Dark, Marker::Braille);
    session.app.files.directory = folder.path().into();
    // Wall times differ from run to run: only the fixed parts are checked.
    session.press("7f");
    let text = session.text();
    for words in ["7 precision", "reference", "e", "U"] {
        assert!(text.contains(words), "no {words} in {text}");
    }
    session.press(":export rows.csv\n");
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert!(rows.starts_with("solver,contact,model,step_s,") && rows.lines().count() > 5, "{rows}");
}

/// Beyond the event solver the view says what it compares with.
#[test]
fn speed_against_error_names_its_reference() {
    let mut scene = Scene::builtin("soft-lining").unwrap();
    scene.solver.end_s = 2e-3;
    let mut session = Session::open(120, 40, scene, Theme::Dark, Marker::Braille);
    session.press("7f");
    let text = session.text();
    assert!(text.contains("reference (smooth law) locked, finest step, error "), "{text}");
    assert!(text.contains("; 0 of its 13 differ"), "{text}");
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
fn a_pinned_baseline_stands_beside_the_run() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("b");
    session.select("solver.contact");
    session.press("l");
    let text = session.text();
    assert!(text.contains(" DECAY ") && text.contains("pinned: LOCKED"), "{text}");
}

/// Red is a state that is wrong: the paper's lock is none, one that is held by a pull is.
#[test]
fn a_first_screen_is_red_only_where_the_state_is_wrong() {
    let red = [ratatui::style::Color::LightRed, ratatui::style::Color::Red];
    for theme in [Theme::Dark, Theme::Light, Theme::ColourBlind, Theme::ColourBlindLight] {
        let adhesive = || Scene::builtin("adhesive").unwrap();
        for (scene, (width, height), red_places) in [
            (scene(), (80, 24), 0..=0),
            (scene(), (120, 40), 0..=0),
            (scene(), (200, 50), 0..=0),
            (adhesive(), (80, 24), 1..=2),
        ] {
            let session = Session::open(width, height, scene, theme, Marker::Braille);
            let buffer = session.terminal.backend().buffer();
            let places: usize = buffer
                .content
                .chunk_by(|a, b| a.fg == b.fg && a.bg == b.bg)
                .filter(|run| {
                    run.iter().any(|cell| red.contains(&cell.fg) || red.contains(&cell.bg))
                })
                .filter(|run| run.iter().any(|cell| cell.symbol() != " "))
                .count();
            assert!(red_places.contains(&places), "{theme:?} {width}: {places}");
        }
    }
}

/// Nothing of the first two lines is ever cut, whatever the width.
#[test]
fn the_first_two_lines_are_whole_at_every_width() {
    let mut session = Session::open(200, 24, scene(), Theme::Mono, Marker::Ascii);
    for width in 40..=200_u16 {
        session.resize((width, 24));
        let rows = session.rows();
        let [first, second] = [&rows[0], &rows[1]].map(|row| row.trim_end());
        assert!(first.starts_with(" LOCKED  ") && first.contains('.'), "{width}: {first}");
        assert!(!first.contains("..") && !second.contains(".."), "{width}: {first}\n{second}");
        // The end is always told, with its verdict.
        let end = second.split_once("AT ").map_or("", |(_, end)| end);
        assert!(second.starts_with("NOW ") && end.starts_with("20 ms locked"), "{width}: {second}");
        let title = first.contains("nodal diameters");
        assert!(title || first.ends_with('.'), "{width}: {first}");
    }
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

#[test]
fn a_long_tip_and_the_corner_that_it_makes_are_seen_in_every_view() {
    let mut scene = Scene::builtin("long-tip").unwrap();
    (scene.operation.speed_rad_s, scene.operation.speed_ramp_rad_s2) = (400.0, 0.0);
    scene.solver.end_s = 0.05;
    let mut session = Session::open(120, 40, scene, Theme::Mono, Marker::Braille);
    for _ in 0..40 {
        session.press("");
    }
    // The polygon has the side of blade 1 beyond the centre, and those that it leaves.
    let machine = &session.app.machine;
    let apothems: Vec<f64> =
        (0..machine.polygon.sides).map(|side| machine.apothem_at(side, 0.3)).collect();
    let left = machine.polygon.sides_left(&apothems);
    assert!(left.len() < 22 && left[0].side == 0, "{left:?}");
    let pair = [left[0].side, left[0].next].map(|side| machine.polygon.blades_of_side(side)[0]);
    assert_eq!(pair, [1, 3]);
    let reach = session.app.usual_reach();
    assert!(left.iter().all(|left| left.reach.iter().all(|end| end.abs() < reach)), "{left:?}");
    session.press("3");
    let text = session.text();
    let rows: Vec<&str> = text.lines().filter(|row| row.contains("locked λ(Ω)")).collect();
    assert!(rows[0].contains("λ_a blade 1") && rows[0].contains("λ_b blade 3"), "{text}");
}

#[test]
fn an_oval_casing_lies_or_stands_as_its_lobes_do() {
    let mut scene = Scene::builtin("oval").unwrap();
    scene.view.charts = vec!["wheel".into()];
    // It hardly turns while it is looked at.
    scene.operation.speed_rad_s = 0.1;
    scene.solver.end_s = 0.05;
    let mut width = |angle: f64| {
        (scene.casing.lobes, scene.casing.out_of_round_angle_rad) = (2, angle);
        let mut session = Session::open(80, 40, scene.clone(), Theme::Mono, Marker::Braille);
        session.press("4f");
        let drawn = |letter: char| ('\u{2801}'..='\u{28ff}').contains(&letter);
        // The wheel is on the left.
        let columns = session.rows().into_iter().skip(4).flat_map(move |row| {
            let places = row.chars().enumerate().take(40);
            places.filter(move |(_, c)| drawn(*c)).map(|(x, _)| x).collect::<Vec<_>>()
        });
        let columns: Vec<usize> = columns.collect();
        columns.iter().max().unwrap() - columns.iter().min().unwrap()
    };
    // A lobe of 60 um on both sides, or at the top and at the bottom.
    let (lying, standing) = (width(0.0), width(std::f64::consts::PI));
    assert!(lying > standing + 6, "{lying} {standing}");
}

/// Rows of the screen that a chart's upright axis goes through, by its column.
fn axis_rows(session: &Session, column: usize) -> usize {
    let is_axis = |sign: char| "│┤".contains(sign);
    session.text().lines().filter(|line| line.chars().nth(column).is_some_and(is_axis)).count()
}

#[test]
fn two_laws_have_the_whole_height_and_the_same_axes() {
    let mut session = Session::open(80, 24, scene(), Theme::Dark, Marker::Braille);
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("bilateral: LOCKED") && text.contains("unilateral: DECAY"), "{text}");
    assert!(!text.contains("2 gaps") && !text.contains("pulse F"), "{text}");
    insta::assert_snapshot!("laws_80x24", text);
    let column = text.lines().find(|line| line.contains("0┤")).unwrap();
    let column = column.chars().position(|sign| sign == '┤').unwrap();
    assert!(axis_rows(&session, column) >= 13, "{text}");
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("c");
    session.press("");
    let text = session.text();
    assert!(text.contains("pulse F") && !text.contains("2 gaps"), "{text}");
    insta::assert_snapshot!("laws_120x40", text);
    let row = text.lines().find(|line| line.contains("bilateral: LOCKED")).unwrap();
    assert!(row.contains("unilateral: DECAY"), "{text}");
}
