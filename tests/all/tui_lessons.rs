//! Every step of every lesson, through the explorer: answers, tasks, and what the
//! text says against what the solvers find.

use rubscope::sheet::number::{in_tenths, tell_in_rpm, with_speeds};
use rubscope::tui::command::Command;
use rubscope::tui::command::table::Group;
use rubscope::tui::lessons::{self, Lesson, LessonStep};
use rubscope::tui::{App, Marker, Theme};
use rubscope_solver::motion::simulate;
use rubscope_solver::scene::Scene;

use super::lesson_values::{Check, Expected, Runs, checks, found, shown};
use super::tui_support::{Session, scene};

/// Begins a lesson of a fresh explorer.
fn begin(width: u16, height: u16, place: usize) -> Session {
    let mut session = Session::open(width, height, scene(), Theme::Dark, Marker::Braille);
    session.press(&format!("g{}\n", "↓".repeat(place)));
    session
}

fn do_task(session: &mut Session, step: &LessonStep) {
    for (path, value) in &step.doing {
        let mut turns = 0;
        while session.app.selected().unwrap().path != path {
            session.press("j");
            turns += 1;
            assert!(turns < 100, "no knob {path}");
        }
        session.press(&format!("\n{value}\n"));
    }
}

/// Half of the last digit of a number as it is written.
fn half_digit(x: f64) -> f64 {
    let text = format!("{x:e}");
    let (digits, power) = text.split_once('e').unwrap();
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let last = 10f64.powi(power.parse::<i32>().unwrap() - decimals as i32);
    // Zeros before the decimal point count.
    0.5 * if x.abs() >= 1.0 { last.min(1.0) } else { last }
}

fn assert_true(check: &Check, session: &Session, runs: &mut Runs) {
    let app = &session.app;
    match &check.is {
        Expected::Word(word) if check.run.as_deref() == Some("verdict") => {
            if check.with.is_empty() {
                let shown = app.verdict_word();
                assert_eq!(shown, word.to_uppercase(), "{check:?}");
                assert!(session.text().contains(&shown), "{}", session.text());
                return;
            }
            let mut scene = app.scene.clone().into_scene();
            check.with.iter().for_each(|(path, value)| scene.set(path, value).unwrap());
            let run = runs.of(&scene.checked().unwrap());
            assert_eq!(run.outcome.verdict.to_string(), *word, "{check:?}");
        }
        Expected::Word(word) => {
            assert_eq!(check.run.as_deref(), Some("sensitive"), "{check:?}");
            let sensitive = simulate(&app.scene).outcome.sensitive.unwrap();
            assert_eq!(sensitive.to_string(), *word, "{check:?}");
        }
        Expected::Number(is) => {
            let found = found(check, app, runs);
            let written = if check.key.is_some() { 1e-9 * is.abs() } else { half_digit(*is) };
            let within = check.within.unwrap_or(written);
            assert!(within <= half_digit(*is), "{check:?}: looser than it is written");
            let near = found.iter().any(|x| (x - is).abs() <= within);
            assert!(near, "{check:?}: {:?}", found.iter().take(8).collect::<Vec<_>>());
            // A marked speed has more digits, for the other unit.
            let (step, _) = app.lesson_step().unwrap();
            let of_this = |mark: &f64| in_tenths(*mark) == in_tenths(is.abs());
            for mark in marks(step).into_iter().filter(of_this) {
                let near = found.iter().any(|x| (x.abs() - mark).abs() <= half_digit(mark));
                assert!(near, "{mark} is none of {:?}", found.iter().take(8).collect::<Vec<_>>());
            }
        }
    }
}

/// Every text of a step.
fn texts(step: &LessonStep) -> impl Iterator<Item = &String> {
    let others = [&step.question, &step.reason, &step.task, &step.equation];
    [&step.text].into_iter().chain(others.into_iter().flatten()).chain(&step.answers)
}

/// The marked speeds of a step.
fn marks(step: &LessonStep) -> Vec<f64> {
    let marked = texts(step).flat_map(|text| text.split('{').skip(1));
    marked.map(|mark| mark.split([' ', '}']).next().unwrap().parse().unwrap()).collect()
}

#[test]
fn every_speed_of_the_lessons_is_told_in_the_unit_of_the_mode() {
    for step in lessons::all().iter().flat_map(|lesson| &lesson.steps) {
        for text in texts(step) {
            tell_in_rpm(true);
            let told = with_speeds(text);
            tell_in_rpm(false);
            assert!(!told.contains(['{', '}']) && !told.contains("rad/s"), "{told}");
            // Where a text says no unit it says no number of rad/s either.
            let alike = |text: &str| numbers(text).len();
            assert_eq!(alike(&told), alike(&with_speeds(text)), "{told}");
        }
        for mark in marks(step) {
            tell_in_rpm(true);
            let [turns, frequency] =
                [" rad/s", " 1/s"].map(|unit| with_speeds(&format!("{{{mark}{unit}}}")));
            tell_in_rpm(false);
            let number = |text: &str, unit: &str| -> f64 {
                text.strip_suffix(unit).unwrap().parse().unwrap()
            };
            let turn = std::f64::consts::TAU;
            assert!((number(&turns, " rpm") - mark * 60.0 / turn).abs() <= 0.0501, "{turns}");
            assert!((number(&frequency, " Hz") - mark / turn).abs() <= 0.0501, "{frequency}");
        }
    }
}

/// The numbers of a text, each with the values it may stand for.
fn numbers(text: &str) -> Vec<(String, Vec<f64>)> {
    let letters: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < letters.len() {
        let before = at.checked_sub(1).map_or(' ', |place| letters[place]);
        let of_a_name = before.is_alphanumeric() || "_^'/".contains(before);
        let after = letters.get(at + 1).copied().unwrap_or(' ');
        if !letters[at].is_ascii_digit() || of_a_name || after == 'δ' {
            at += 1;
            continue;
        }
        let from = at;
        let decimal = |at: usize| {
            letters[at] == '.' && letters.get(at + 1).is_some_and(|next| next.is_ascii_digit())
        };
        while at < letters.len() && (letters[at].is_ascii_digit() || decimal(at)) {
            at += 1;
        }
        let digits: String = letters[from..at].iter().collect();
        let value: f64 = digits.parse().unwrap();
        let rest: String = letters[at..].iter().take(4).collect();
        let unit = rest.strip_prefix(' ').unwrap_or(&rest);
        let mut values = vec![value];
        for (prefix, factor) in
            [('M', 1e6), ('k', 1e3), ('m', 1e-3), ('µ', 1e-6), ('u', 1e-6), ('n', 1e-9)]
        {
            let mut signs = unit.chars();
            if signs.next() == Some(prefix)
                && signs.next().is_none_or(|unit| "Nsmr)".contains(unit))
            {
                values = vec![value * factor];
            }
        }
        if unit.starts_with('%') {
            values = vec![value / 100.0];
        }
        if unit.starts_with("rpm") {
            values = vec![value * std::f64::consts::TAU / 60.0];
        }
        found.push((digits, values));
    }
    found
}

fn assert_numbers_are_checked(lesson: &Lesson, step: &LessonStep) {
    let right = step.right_place().and_then(|place| step.answers.get(place));
    let prose = [Some(&step.text), step.question.as_ref(), right, step.reason.as_ref()];
    let texts = prose.into_iter().chain([step.task.as_ref()]).flatten();
    for (digits, values) in texts.flat_map(|text| numbers(&with_speeds(text))) {
        let checked = checks(step).iter().any(|check| match check.is {
            Expected::Number(is) => {
                values.iter().any(|value| (is.abs() - value).abs() <= 1e-9 * value.abs())
            }
            Expected::Word(_) => false,
        });
        assert!(checked, "{}: {digits} is in the text, but nothing checks it", lesson.title);
    }
}

/// What a text says of the header, up to the next sign.
fn quoted_header(text: &str) -> Option<&str> {
    let (_, rest) = text.split_once("eader says ")?;
    rest.split([',', '.', ':', ';']).next()
}

/// What a step says of the header stands there, on a small screen and on a large one.
fn assert_header_is_shown(session: &mut Session, step: &LessonStep) {
    let texts = [Some(&step.text), step.reason.as_ref(), step.task.as_ref()];
    let quoted: Vec<&str> =
        texts.into_iter().flatten().filter_map(|text| quoted_header(text)).collect();
    for size in [(80, 24), (120, 40)] {
        session.resize(size);
        let header = session.rows()[..3].join("\n");
        quoted.iter().for_each(|words| assert!(header.contains(words), "{words} in {header}"));
    }
}

/// Words of a text that speak of what stands on the screen.
const SPEAKS: [&str; 6] =
    ["row of", "rows of", "margins have", "gaps show", "beside it", "go with"];

/// What the text of a step names stands on the screen, at 80x24 and at 40x12.
fn assert_named_is_shown(session: &mut Session, step: &LessonStep) {
    let named = shown(step);
    let answered = [Some(&step.text), step.reason.as_ref()];
    let mut texts = answered.into_iter().flatten();
    let speaks = texts.any(|text| SPEAKS.iter().any(|words| text.contains(words)));
    assert!(
        !speaks || !named.is_empty(),
        "nothing checks what stands on the screen: {}",
        step.text
    );
    for size in [(80, 24), (40, 12)] {
        session.resize(size);
        let text = session.text();
        for one in named.iter().filter(|one| one.from <= size.0) {
            assert!(text.contains(&one.shown), "{} is not in {text}", one.shown);
        }
    }
    session.resize((120, 40));
}

fn assert_has_words(text: &str, words: &str) {
    for word in words.split_whitespace() {
        assert!(text.contains(word), "{word} is not in {text}");
    }
}

/// The step leaves room for a chart at 80x24. At 40x12 an open question and its answers are in
/// sight, and a chart after the answer.
fn assert_has_room(session: &mut Session, lesson: &Lesson, step: &LessonStep) {
    let is_open = session.app.keyboard() == Group::Question;
    let shown = if is_open { &step.question } else { &step.reason };
    let shown = &with_speeds(shown.as_ref().unwrap_or(&step.text));
    let answers: Vec<String> = step.answers.iter().map(|answer| with_speeds(answer)).collect();
    session.resize((80, 24));
    let text = session.text();
    assert_has_words(&text, shown);
    let digit = session.app.view().digit();
    let chart = text.lines().position(|line| line.contains(&format!("─ {digit} ")));
    // Without its title, and the last line.
    assert!(chart.is_some_and(|row| 24 - row - 2 >= 7), "{text}");
    session.resize((40, 12));
    let head = session.rows()[2].clone();
    assert!(head.contains(lesson.brief()) && !head.contains('…'), "{head}");
    if is_open {
        // The question and its answers stay in sight.
        let text = session.text();
        answers.iter().chain([shown]).for_each(|words| assert_has_words(&text, words));
    } else {
        assert!(session.text().contains(&format!(" {digit} ")), "{}", session.text());
    }
    session.resize((120, 40));
}

/// A test for each lesson, and one that none is left out.
macro_rules! lessons {
    ($($name:ident)*) => {
        const NAMES: &[&str] = &[$(stringify!($name)),*];

        $(#[test] fn $name() { every_step_says_what_the_solvers_find(stringify!($name)); })*
    };
}

lessons! {
    critical_speed lock sign run_down rocking slip polygon time_step speed_and_error what_if
    coincidence friction long_tip roundness your_machine
}

/// The names of the lessons as those of their tests.
fn names() -> Vec<String> {
    lessons::all().iter().map(|lesson| lesson.name.replace('-', "_")).collect()
}

#[test]
fn every_lesson_is_played() {
    assert_eq!(names(), NAMES);
}

/// Goes through a lesson, whose steps have room at every size.
fn every_step_says_what_the_solvers_find(name: &str) {
    let place = names().iter().position(|known| known == name).unwrap();
    let lesson = &lessons::all()[place];
    let mut runs = Runs::default();
    let mut session = begin(120, 40, place);
    for (number, step) in lesson.steps.iter().enumerate() {
        let at = format!("{}, step {}", lesson.title, number + 1);
        println!("{at}");
        let text = session.text();
        let head = format!("step {} of {}", number + 1, lesson.steps.len());
        assert!(text.contains(&head), "{at}: {text}");
        assert!(!text.contains("FAILED"), "{at}: {text}");
        if let Some(knob) = &step.knob {
            assert_eq!(session.app.selected().unwrap().path, knob, "{at}");
        }
        if step.question.is_some() {
            assert_eq!(session.app.keyboard(), Group::Question, "{at}");
            assert_eq!(session.app.scene, lesson.scene_at(number, false).unwrap(), "{at}");
            assert!(text.contains("[a] ") && text.contains("[c] "), "{at}: {text}");
            assert_has_room(&mut session, lesson, step);
            session.press(&keys_of(step.right.unwrap()));
            assert!(session.text().contains("is right"), "{at}: {}", session.text());
        }
        assert_eq!(session.app.scene, lesson.scene_at(number, true).unwrap(), "{at}");
        assert_has_room(&mut session, lesson, step);
        assert_named_is_shown(&mut session, step);
        let progress = |session: &Session| session.app.lessons.progress.as_ref().unwrap().now();
        if step.task.is_some() {
            assert!(!progress(&session).done, "{at}: nothing to do");
            do_task(&mut session, step);
        }
        session.press("");
        assert!(progress(&session).done, "{at}: {}", session.text());
        assert!(session.app.lessons.done.has(lesson, number));
        assert!(!session.text().contains("FAILED"), "{at}: {}", session.text());
        checks(step).iter().for_each(|check| assert_true(check, &session, &mut runs));
        let verdict = |check: &Check| check.run.as_deref() == Some("verdict");
        assert!(checks(step).iter().any(verdict) || number == 0, "{at}: no verdict is checked");
        assert_numbers_are_checked(lesson, step);
        assert_header_is_shown(&mut session, step);
        session.press("g");
    }
    assert!(session.app.lessons.progress.is_none());
    assert_eq!(*session.app.scene, scene(), "{}", lesson.title);
}

/// The keys that give an answer: down to it, and Enter.
fn keys_of(letter: char) -> String {
    let place = lessons::LETTERS.iter().position(|known| *known == letter).unwrap();
    "↓".repeat(place) + "\n"
}

#[test]
fn a_step_that_was_passed_over_is_named_in_the_list() {
    let mut session = begin(80, 24, 0);
    for step in &lessons::all()[0].steps {
        if let Some(right) = step.right {
            session.press(&keys_of(right));
        }
        // Its second step has a task, which is not done.
        session.press("g");
    }
    session.press("g");
    let text = session.text();
    let left = text.lines().find(|line| line.contains("lesson The critical")).unwrap();
    assert!(left.contains(" 3/4") && text.contains("Goes on at step 2."), "{text}");
}

#[test]
fn a_lesson_gives_back_what_was_there_and_undo_reaches_across() {
    let mut session = Session::open(120, 40, scene(), Theme::Dark, Marker::Braille);
    session.press("\n430\n6x] :t 3 ms\n");
    let own = session.app.clone();
    session.press("g\n");
    assert_ne!(session.app.scene, own.scene);
    assert!(!session.app.knobs.live);
    session.press(&(keys_of('b') + "[["));
    session.press("G");
    let same = |app: &App| {
        let live = (app.knobs.live, app.view(), app.layout.views.clone(), app.run.compare);
        app.lessons.progress.is_none()
            && app.scene == own.scene
            && app.files.opened == own.files.opened
            && app.files.source == own.files.source
            && app.now() == 3e-3
            && live == (own.knobs.live, own.view(), own.layout.views.clone(), own.run.compare)
    };
    assert!(same(&session.app) && session.app.play.tempo.rate == own.play.tempo.rate);
    // Undo: the lesson with its answer, the open question, and the time before.
    session.press("u");
    assert_eq!(session.app.lessons.progress.as_ref().unwrap().now().answer, Some(1));
    session.press("u");
    assert!(session.app.is_asked());
    session.press("u");
    assert!(same(&session.app));
    session.press("u");
    assert_eq!(*session.app.scene, Scene { operation: scene().operation, ..scene() });
    for _ in 0..2 {
        session.app.act(Command::Redo);
    }
    assert!(session.app.lessons.progress.is_some() && session.app.is_asked());
}
