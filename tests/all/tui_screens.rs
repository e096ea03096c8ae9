//! Pictures of whole screens, themes and colours, and laws of the first two lines. What must stand
//! on a screen is in `tests/screens`.

use rubscope::tui::{Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, scene};

#[test]
fn the_first_screen_at_four_sizes() {
    for (width, height) in [(80, 24), (120, 40), (40, 12), (200, 50)] {
        let session = Session::searched(width, height, scene(), Theme::Dark, Marker::Braille);
        insta::assert_snapshot!(format!("first_{width}x{height}"), session.text());
    }
}

#[test]
fn each_view_and_the_help_in_ascii() {
    for (name, keys) in [("response", "1f"), ("gaps", "2f"), ("locked", "3f"), ("help", "?")] {
        let mut session = Session::searched(80, 24, scene(), Theme::Mono, Marker::Ascii);
        session.press(keys);
        let text = session.text();
        assert!(text.is_ascii(), "{text}");
        insta::assert_snapshot!(format!("ascii_{name}"), text);
    }
}

#[test]
fn scenes_of_each_kind_of_end() {
    for (name, width, height) in [("slip", 120, 40), ("rub", 80, 24), ("grazing", 80, 24)] {
        let mut scene = Scene::builtin(name).unwrap();
        scene.solver.end_s = 0.02;
        let session = Session::searched(width, height, scene, Theme::Dark, Marker::Braille);
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), session.text());
    }
}

#[test]
fn every_view_with_the_large_chart_at_120_by_40() {
    for digit in ['1', '2', '3', '4', '5', '6', '8'] {
        let mut session = Session::searched(120, 40, scene(), Theme::Dark, Marker::Braille);
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
            let session = Session::searched(width, height, scene, theme, Marker::Braille);
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
    let mut session = Session::searched(200, 24, scene(), Theme::Mono, Marker::Ascii);
    for width in 40..=200_u16 {
        session.resize((width, 24));
        let rows = session.rows();
        let [first, second] = [&rows[0], &rows[1]].map(|row| row.trim_end());
        assert!(first.starts_with(" LOCKED  ") && first.contains('.'), "{width}: {first}");
        assert!(!first.contains("..") && !second.contains(".."), "{width}: {first}\n{second}");
        // The end is always told, and the lock speed from 80 columns on.
        assert!(second.starts_with("NOW ") && second.contains("AT 20 ms"), "{width}: {second}");
        assert!(width < 80 || second.contains(" Om_lock"), "{width}: {second}");
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
        let session = Session::searched(80, 24, scene(), theme, Marker::Ascii);
        insta::assert_snapshot!(format!("styles_{name}_80x24"), styles(&session));
    }
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

#[test]
fn two_laws_have_the_whole_height_and_the_same_axes() {
    for (width, height, has_casing) in [(80, 24, false), (120, 40, true)] {
        let mut session = Session::searched(width, height, scene(), Theme::Dark, Marker::Braille);
        session.press("c");
        session.press("");
        let text = session.text();
        assert!(text.contains("bilateral: LOCKED") && text.contains("unilateral: DECAY"), "{text}");
        assert_eq!((text.contains("pulse F"), text.contains("2 gaps")), (has_casing, false));
        insta::assert_snapshot!(format!("laws_{width}x{height}"), text);
    }
}
