//! The list of lessons, and the current step.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use crate::tui::app::{App, InputMode};
use crate::tui::lessons;
use crate::tui::text::{print, wrap};
use crate::tui::theme::Role;

/// The list of lessons, one of them selected.
pub fn list(app: &App, buffer: &mut Buffer, area: Rect, place: usize) {
    let look = &app.appearance;
    let bold = look.style(Role::Text).add_modifier(Modifier::BOLD);
    print(buffer, area, 0, "Lessons: Enter begins one, g goes from step to step", bold);
    let first = first_listed(area, place);
    for (row, (index, lesson)) in
        (2..area.height).zip(lessons::all().iter().enumerate().skip(first))
    {
        let selected = index == place;
        let sign = if selected { look.either("▸", ">") } else { " " };
        let text = format!("{sign} {}. {} ({} steps)", index + 1, lesson.title, lesson.steps.len());
        let style = if selected {
            look.style(Role::Focus).add_modifier(Modifier::REVERSED)
        } else {
            look.style(Role::Text)
        };
        print(buffer, area, row, &look.spell(&text), style);
    }
}

/// The first lesson in sight, so that the selected one is.
fn first_listed(area: Rect, place: usize) -> usize {
    (place + 1).saturating_sub(usize::from(area.height.saturating_sub(2)))
}

/// The lesson in a row of the screen while the list is open in `area`.
pub fn place_at(app: &App, area: Rect, y: u16) -> Option<usize> {
    let InputMode::Lessons(place) = app.mode else { return None };
    let row = y.checked_sub(area.y + 2)?;
    let place = first_listed(area, place) + usize::from(row);
    (place < lessons::all().len()).then_some(place)
}

/// The lines of a step; `page` if its text is a page in front of the charts.
fn lines(app: &App, width: usize, page: bool) -> Vec<(String, Role)> {
    let Some((lesson, progress)) = app.current_lesson() else { return Vec::new() };
    let Some(step) = lesson.steps.get(progress.step) else { return Vec::new() };
    let look = &app.appearance;
    let of = |text: &str, role: Role| -> Vec<(String, Role)> {
        wrap(&look.spell(text), width).into_iter().map(|line| (line, role)).collect()
    };
    let head = format!("{} - step {} of {}", lesson.title, progress.step + 1, lesson.steps.len());
    let mut lines = of(&head, Role::Focus);
    lines.extend(of(&step.text, Role::Text));
    if let Some(equation) = &step.equation {
        lines.extend(of(equation, Role::First));
    }
    let last = progress.step + 1 == lesson.steps.len();
    let next = if last { "g ends the lesson" } else { "g: next step" };
    if page {
        lines.extend(of("g: to the charts", Role::Good));
        return lines;
    }
    match &step.task {
        Some(task) if progress.done => lines.extend(of(&format!("[x] {task}  {next}"), Role::Good)),
        Some(task) => lines.extend(of(&format!("[ ] {task}"), Role::Focus)),
        None => lines.extend(of(next, Role::Good)),
    }
    lines
}

/// Rows the step needs, with a rule below.
pub fn rows(app: &App, width: usize) -> u16 {
    u16::try_from(lines(app, width, false).len() + 1).unwrap_or(u16::MAX)
}

/// Draws the current step.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let page = app.lesson.as_ref().is_some_and(|progress| !progress.read);
    let lines = lines(app, usize::from(area.width), page && super::lesson_fills(app));
    // If it is too long for the screen, its end, the task, must be visible.
    let room = usize::from(area.height.saturating_sub(1));
    let skip = lines.len().saturating_sub(room);
    let kept = lines.iter().take(1).chain(lines.iter().skip(1 + skip));
    for (row, (text, role)) in (0..area.height).zip(kept) {
        print(buffer, area, row, text, look.style(*role));
    }
    let rule = look.either("─", "-").repeat(usize::from(area.width));
    print(buffer, area, area.height.saturating_sub(1), &rule, look.style(Role::Quiet));
}
