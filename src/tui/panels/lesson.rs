//! The list of lessons, and the current step: the question, or the answer with its reason.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::lists::{first_in_sight, look_of};
use crate::report::number::with_speeds;
use crate::tui::app::App;
use crate::tui::command::Command;
use crate::tui::lessons::{self, LETTERS, LessonStep};
use crate::tui::text::{columns, print, shorten, whole_parts, wrap};
use crate::tui::theme::Role;

/// Width from which the question stays above its answer.
const WIDE: usize = 110;

/// Draws the list of lessons with the progress in each.
pub fn list(app: &App, buffer: &mut Buffer, area: Rect, place: usize) {
    let look = &app.appearance;
    let width = usize::from(area.width);
    let bold = look.style(Role::Text).add_modifier(Modifier::BOLD);
    let head = "Lessons: Enter begins one, g goes on, B back, G leaves";
    print(buffer, area, 0, &whole_parts(head, width, 1).join(""), bold);
    let first = first_in_sight(place, usize::from(area.height.saturating_sub(2)));
    for (row, (index, lesson)) in
        (2..area.height).zip(lessons::all().iter().enumerate().skip(first))
    {
        app.note(Rect { y: area.y + row, height: 1, ..area }, Command::Lesson(index));
        let (sign, style) = look_of(look, index == place, Role::Text);
        let (done, steps) = (app.lessons.done.count(lesson), lesson.steps.len());
        // A step that was skipped comes before the last completed one.
        let passed = app.lessons.done.next(lesson).filter(|next| *next < done);
        let done = if done == steps { "done".to_string() } else { format!("{done}/{steps}") };
        let name = |title: &str| format!("{sign} {done:>4}  {}. {title}", index + 1);
        let [whole, brief] = [lesson.title.as_str(), lesson.brief()].map(name);
        let minutes = format!("   {} min", lesson.minutes());
        let needs = match passed {
            Some(step) => format!("{minutes}, step {} is left", step + 1),
            None => format!("{minutes}, needs {}", lesson.needs),
        };
        // Parts that do not fit are omitted.
        let ways = [whole.clone() + &needs, whole + &minutes, brief.clone() + &minutes, brief];
        let ways = ways.map(|way| look.spell(&way));
        let fits = ways.iter().find(|way| columns(way) <= width);
        print(buffer, area, row, fits.unwrap_or(&ways[3]), style);
    }
}

/// A line and its colour.
type Line = (String, Role);

/// Returns a text with its speeds in the unit of the screen.
fn told(app: &App, text: &str) -> String {
    app.appearance.spell(&with_speeds(text))
}

/// Returns the lines of the current step below its head.
fn lines(app: &App, width: usize) -> Vec<Line> {
    let Some((step, now)) = app.lesson_step() else { return Vec::new() };
    let of = |text: &str, role: Role| -> Vec<Line> {
        wrap(&told(app, text), width).into_iter().map(|line| (line, role)).collect()
    };
    let mut lines = Vec::new();
    match (&step.question, now.answer) {
        (Some(question), None) => {
            lines.extend(of(&step.text, Role::Text));
            lines.extend(of(question, Role::Focus));
            let chosen = app.lessons.progress.as_ref().map_or(0, |progress| progress.choice);
            let named = LETTERS.iter().zip(&step.answers).enumerate();
            let named = named.map(|(place, (letter, text))| {
                format!("{}[{letter}] {text}", if place == chosen { '▸' } else { ' ' })
            });
            let named: Vec<String> = named.map(|text| told(app, &text)).collect();
            let one = named.join("  ");
            // The answers share a line if they fit.
            match columns(&one) <= width {
                true => lines.push((one, Role::Focus)),
                false => lines.extend(named.iter().flat_map(|line| of(line, Role::Focus))),
            }
            return lines;
        }
        (Some(question), Some(answer)) => {
            if width >= WIDE {
                lines.extend(of(question, Role::Quiet));
            }
            lines.extend(of(&judged(step, answer), Role::Good));
            lines.extend(of(step.reason.as_deref().unwrap_or_default(), Role::Text));
        }
        (None, _) => lines.extend(of(&step.text, Role::Text)),
    }
    if let Some(equation) = &step.equation {
        lines.extend(of(equation, Role::First));
    }
    match &step.task {
        Some(task) if now.done => lines.extend(of(&format!("[x] {task}"), Role::Good)),
        Some(task) => lines.extend(of(&format!("[ ] {task}"), Role::Focus)),
        None => {}
    }
    lines
}

/// Says whether an answer is right, and which one is.
fn judged(step: &LessonStep, answer: usize) -> String {
    let right = step.right_place().unwrap_or(0);
    let text = step.answers.get(right).map_or("", String::as_str);
    let [given, right_letter] =
        [answer, right].map(|place| LETTERS.get(place).copied().unwrap_or('?'));
    match answer == right {
        true => format!("Your answer {given} is right: {text}."),
        false => format!("Not {given}. Right is {right_letter}: {text}."),
    }
}

/// Returns the head in two halves: lesson on the left, step and keys on the right.
fn head(app: &App, width: usize) -> (String, String) {
    let Some((lesson, progress)) = app.current_lesson() else { return Default::default() };
    let look = &app.appearance;
    let count = lessons::all().len();
    let number = progress.lesson + 1;
    let whole = format!("Lesson {number} of {count} · {}", lesson.title);
    let [number, brief] =
        [&lesson.title, lesson.brief()].map(|title| format!("{number}/{count} {title}"));
    let of = format!("{} of {}", progress.step + 1, lesson.steps.len());
    let step = format!("step {of}");
    let keys = match (app.is_asked(), progress.step + 1 == lesson.steps.len()) {
        (true, _) => "↑↓ Enter answer",
        (false, false) => "g next",
        (false, true) => "g ends",
    };
    let long = format!("{step} · {keys} · B back · G leave");
    let short = format!("{step} · {keys}");
    let numbers = [(&number, &short), (&number, &step), (&brief, &step), (&brief, &of)];
    let ways = [[(&whole, &long), (&whole, &short)].as_slice(), &numbers].concat();
    let mut ways = ways.iter().map(|(left, right)| (look.spell(left), look.spell(right)));
    let fits = |(left, right): &(String, String)| columns(left) + columns(right) + 2 <= width;
    let last = ways.clone().next_back();
    let (left, right) = ways.find(fits).or(last).unwrap_or_default();
    let room = width.saturating_sub(columns(&right) + 2);
    (shorten(&left, room, look.ellipsis()), right)
}

/// Returns the rows the step needs, with its head and a rule below.
pub fn rows(app: &App, width: usize) -> u16 {
    u16::try_from(lines(app, width).len() + 2).unwrap_or(u16::MAX)
}

/// Returns the current step as text, in lines of `width` columns; empty if no lesson is open.
pub fn lesson_text(app: &App, width: u16) -> Vec<String> {
    let (left, right) = head(app, usize::from(width));
    let head = [left, right].join("   ");
    let lines = lines(app, usize::from(width)).into_iter().map(|(line, _)| line);
    let is_open = app.lessons.progress.is_some();
    std::iter::once(head).chain(lines).filter(|_| is_open).collect()
}

pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let width = usize::from(area.width);
    let (left, right) = head(app, width);
    let bold = look.style(Role::Focus).add_modifier(Modifier::BOLD);
    print(buffer, area, 0, &left, bold);
    let start = u16::try_from(width.saturating_sub(columns(&right))).unwrap_or(0);
    let beside = Rect { x: area.x + start, width: area.width - start, ..area };
    print(buffer, beside, 0, &right, look.style(Role::Good));
    let all = lines(app, width);
    let room = usize::from(area.height.saturating_sub(2));
    // The end of the step, its answers or its task, must be visible.
    let skip = all.len().saturating_sub(room);
    for (row, (text, role)) in (1..area.height).zip(all.iter().skip(skip).take(room)) {
        print(buffer, area, row, text, look.style(*role));
    }
    let last = area.height.saturating_sub(1);
    let rule = look.either("─", "-").repeat(width);
    print(buffer, area, last, &rule, look.style(Role::Quiet));
}
