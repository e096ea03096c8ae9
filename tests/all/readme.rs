//! What the README promises of the explorer: its pictures and its first minute.
//! `RUBSCOPE_PICTURES=write cargo test readme` makes the pictures again.

use std::path::PathBuf;

use rubscope::tui::{Marker, Theme, export};
use rubscope_solver::scene::Scene;

use crate::cli_support::{ended, program};
use crate::stepwise::Stepwise;
use crate::tui_support::Session;

fn open(theme: Theme) -> Session {
    let scene = Scene::builtin("paper-nd3").unwrap();
    Session::searched(120, 40, scene, theme, Marker::Braille)
}

/// The screen of the default scene some milliseconds after its start.
fn picture(theme: Theme) -> String {
    let mut session = open(theme);
    (0..3).for_each(|_| _ = session.press(""));
    export::svg(&session.app)
}

/// A picture that moves: the screens of the first minute, with the keys below.
struct Moving {
    session: Session,
    /// The rows of each frame, and how long it stands in tenths of a second.
    frames: Vec<(Vec<String>, u32)>,
}

impl Moving {
    /// Frames of the motion as it goes on, with a line that says what was pressed.
    fn film(&mut self, said: &str, count: usize, tenths: u32) {
        for _ in 0..count {
            self.session.press("");
            let mut rows = export::rows(&self.session.app);
            let light = self.session.app.appearance.theme == Theme::Light;
            let fill = if light { "#0b57d0" } else { "#78a9ff" };
            let y = 17 * (u32::try_from(rows.len()).unwrap() + 1) - 4;
            rows.push(format!("<text x=\"8\" y=\"{y}\" fill=\"{fill}\">{said}</text>\n"));
            self.frames.push((rows, tenths));
        }
    }

    /// Every row that differs is there once, and seen while it stands on the screen.
    /// Where motion is unwanted the first frame stays.
    fn picture(&self) -> String {
        let total: u32 = self.frames.iter().map(|(_, tenths)| tenths).sum();
        let (mut styles, mut parts) = (String::new(), String::new());
        let mut seen: Vec<(String, String)> = Vec::new();
        for row in 0..self.frames[0].0.len() {
            let mut shown: Vec<(&str, Vec<[u32; 2]>)> = Vec::new();
            let mut at = 0;
            for (rows, tenths) in &self.frames {
                let span = [at, at + tenths];
                at += tenths;
                match shown.iter_mut().find(|(text, _)| *text == rows[row]) {
                    Some((_, spans)) if spans.last().unwrap()[1] == span[0] => {
                        spans.last_mut().unwrap()[1] = span[1];
                    }
                    Some((_, spans)) => spans.push(span),
                    None => shown.push((&rows[row], vec![span])),
                }
            }
            for (text, spans) in shown {
                if spans == [[0, total]] {
                    parts.push_str(text);
                    continue;
                }
                let percent = |tenths: u32| f64::from(tenths) * 100.0 / f64::from(total);
                let mut keys = String::new();
                for [from, to] in &spans {
                    keys += &format!(
                        "{:.2}%{{opacity:1}}{:.2}%{{opacity:0}}",
                        percent(*from),
                        percent(*to)
                    );
                }
                if spans[0][0] > 0 {
                    keys.insert_str(0, "0%{opacity:0}");
                }
                let known =
                    seen.iter().find(|(other, _)| *other == keys).map(|(_, name)| name.clone());
                let name = known.unwrap_or_else(|| {
                    let name = format!("k{}", seen.len());
                    styles += &format!(
                        "@keyframes {name}{{{keys}}}.{name}{{animation:{name} {}s step-end infinite}}\n",
                        f64::from(total) / 10.0
                    );
                    seen.push((keys, name.clone()));
                    name
                });
                let still = if spans[0][0] == 0 { " class=\"first" } else { " class=\"later" };
                parts += &format!("<g{still} {name}\">{text}</g>\n");
            }
        }
        let still = "@media (prefers-reduced-motion:reduce){.later{display:none}g{animation:none!important}}\n";
        let style = format!("<style>{styles}{still}</style>\n");
        export::opening(&self.session.app, 1, &style) + &parts + "</svg>\n"
    }
}

/// The first minute of the README: its keys, and what they show. The blades turn with the
/// picture, so what moves is the casing: slowly while a pulse pushes it into a lock, faster
/// while it bounces.
fn first_minute(theme: Theme) -> String {
    let (slow, fast) = (4e-6, 4e-4);
    let scene = Scene::builtin("paper-nd3").unwrap();
    let mut engine = Stepwise::new(slow);
    (engine.extent.searches_changes, engine.checks) = (true, true);
    let session = Session::with_engine((80, 24), engine, scene, theme, Marker::Braille);
    let mut moving = Moving { session, frames: Vec::new() };
    moving.film("rubscope: a pulse pushes the casing, and two blades catch its wave", 9, 6);
    moving.session.press("c");
    moving.session.engine.stride = fast;
    moving.film("c: beside it contact that only pushes; the wave bounces, and dies out", 9, 6);
    for (keys, said) in [("c\n", "c: closed. Enter"), ("400", "Enter 400")] {
        moving.session.press(keys);
        moving.film(said, 1, 8);
    }
    moving.session.press("\n");
    moving.film("Enter 400 Enter: the speed is turned down, and one blade pulls", 9, 6);
    moving.session.engine.extent.most_cells = usize::MAX;
    moving.session.press("5");
    moving.film("5: the map of all speeds and pulses", 1, 50);
    moving.picture()
}

/// A picture without the scene in it, and that scene: a kept one need not have a key that came
/// later.
fn apart(picture: &str) -> (String, Option<Scene>) {
    let ends = picture.find("\n\nschema = ").zip(picture.find("</desc>"));
    let Some((from, to)) = ends else { return (picture.into(), None) };
    let scene = Scene::from_toml(&picture[from..to]).unwrap();
    (picture[..from].to_string() + &picture[to..], Some(scene))
}

/// Compares a picture of the page with what makes it, or writes it.
fn assert_is_made(file: &str, now: &str) {
    // A kept picture cannot name the commit that it is in.
    let now = now.replacen(concat!(" ", env!("RUBSCOPE_COMMIT"), "\n"), "\n", 1);
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file);
    let is_made = || std::fs::read_to_string(&path).is_ok_and(|kept| apart(&kept) == apart(&now));
    if !is_made() && std::env::var("RUBSCOPE_PICTURES").is_ok_and(|value| value == "write") {
        std::fs::write(&path, &now).unwrap();
    }
    assert!(
        is_made(),
        "{file} is not what rubscope makes: RUBSCOPE_PICTURES=write cargo test readme makes it again"
    );
    assert!(now.len() < 400_000, "{file} has {} bytes", now.len());
}

#[test]
fn the_pictures_are_what_the_screen_shows() {
    for (name, theme) in [("dark", Theme::Dark), ("light", Theme::Light)] {
        for (what, now) in [("screen", picture(theme)), ("minute", first_minute(theme))] {
            assert_is_made(&format!("assets/pictures/{what}-{name}.svg"), &now);
        }
    }
}

#[test]
fn the_map_and_the_survey_are_what_their_commands_write() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    for what in ["map", "survey"] {
        let out = format!("--out {what}.svg");
        let command = page.lines().find_map(|line| {
            let (before, _) = line.split_once(&out)?;
            Some(before.rsplit_once("rubscope ")?.1.to_string())
        });
        let folder = tempfile::tempdir().unwrap();
        if what == "survey" {
            crate::own_machine::stage(folder.path());
        }
        let command = command.unwrap() + &out;
        ended(program().current_dir(folder.path()).args(command.split(' ')), 0);
        let now = std::fs::read_to_string(folder.path().join(format!("{what}.svg"))).unwrap();
        assert_is_made(&format!("assets/pictures/{what}.svg"), &now);
    }
}

fn header(session: &Session) -> String {
    session.text().lines().take(3).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_first_minute_is_as_it_says() {
    let mut session = open(Theme::Mono);
    let start = header(&session);
    assert!(start.contains("500 rad/s") && start.contains("LOCKED"), "{start}");
    assert!(start.contains("Blades 12 and 19"), "{start}");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let first = session.text().lines().next().unwrap().trim().to_string();
    assert!(page.contains(&format!("\n{first}\n")), "the page does not say {first}");
    session.press("cr");
    session.press("");
    let both = session.text();
    assert!(both.contains("LOCKED") && both.contains("unilateral: DECAY"), "{both}");
    // The speed is the selected knob.
    session.press("c\n400\n");
    session.press("");
    assert!(header(&session).contains("ADHESIVE"), "{}", header(&session));
    session.press("5");
    session.press("");
    assert_eq!(session.app.view().word(), "map");
    assert!(session.text().contains("5 map"), "{}", session.text());
    session.press("\u{1b}g");
    assert!(session.text().contains("Lessons"), "{}", session.text());
    session.press("\u{1b}:scene long-tip\n");
    session.press("");
    let (scene, start) = (&session.app.scene, header(&session));
    assert!(start.contains("LOCKED") && start.contains("blades 1 and 3"), "{start}");
    assert_eq!(scene.operation.pulse_n, 0.0);
    let beyond = scene.bladed_disk.longest_tip_m - scene.clearance();
    assert!((beyond - 5e-6).abs() < 1e-12, "{beyond}");
    let from = scene.operation.speed_rad_s;
    let at = |t: f64| from + scene.operation.speed_ramp_rad_s2 * t;
    assert_eq!((from, at(scene.solver.end_s)), (250.0, 350.0));
    let held = at(crate::run_once(scene).outcome.lock_time_s.unwrap());
    assert_eq!(held.round(), 294.0);
    for said in
        ["`scene long-tip`", "5 um longer", "from 250 to 350 rad/s: LOCKED", "from 294 rad/s"]
    {
        assert!(page.contains(said), "{said}");
    }
}

/// The pictures of the views on the page of the explorer. That of view 7 shows times of one
/// machine, so it is made only where it is missing.
#[test]
fn every_view_has_its_picture_on_the_page_of_the_explorer() {
    let views = ["1", "2", "3", "4", "5", "6", "7", "8", "9"];
    let check = |view: &str| {
        let file = format!("assets/pictures/view-{view}.svg");
        assert!(include_str!("../../docs/explorer.md").contains(&format!("(../{file})")), "{file}");
        if view == "7" && std::path::Path::new(&file).exists() {
            return;
        }
        let scene = Scene::builtin(if view == "9" { "coincidence" } else { "paper-nd3" }).unwrap();
        let mut session = Session::searched(80, 24, scene, Theme::Dark, Marker::Braille);
        session.engine.extent.most_cells = usize::MAX;
        session.press(&format!("{view}f"));
        // The second page of view 1 is nearly full.
        (0..if view == "1" { 9 } else { 4 }).for_each(|_| _ = session.press(""));
        assert_is_made(&file, &export::svg(&session.app));
    };
    std::thread::scope(|scope| views.map(|view| _ = scope.spawn(move || check(view))));
}
