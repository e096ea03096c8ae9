//! The two lines at the top: scene and verdict; speeds, solver, time.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use crate::report::number::trimmed;
use crate::tui::app::App;
use crate::tui::axis::readable;
use crate::tui::text::{columns, pieces, print, shorten};
use crate::tui::theme::Role;

/// Draws both lines.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    verdict(app, buffer, area);
    speeds(app, buffer, area);
}

fn verdict(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let words = app.verdict();
    let width = usize::from(area.width);
    let word = format!(" {} ", words.word);
    let style = look.style(words.role).add_modifier(Modifier::BOLD | Modifier::REVERSED);
    let mut detail = words.detail;
    if let Some(other) = app.disagreement() {
        detail = format!("{detail} | {other}");
    }
    if let Some(baseline) = &app.baseline
        && baseline.words.word != words.word
    {
        detail = format!("{detail} | pinned: {}", baseline.words.word);
    }
    let detail = look.spell(&detail);
    // The word is always shown; its detail, then the title, use the remaining room.
    let title = look.spell(&app.scene.title);
    let room = width.saturating_sub(columns(&word) + 1);
    let detail = shorten(&detail, room, look.either("…", ".."));
    let left = room.saturating_sub(columns(&detail) + 2);
    let title =
        if left >= 8 { shorten(&title, left, look.either("…", "..")) } else { String::new() };
    print(buffer, area, 0, &word, style);
    let after = Rect {
        x: area.x + cells(&word) + 1,
        width: area.width.saturating_sub(cells(&word) + 1),
        ..area
    };
    print(buffer, after, 0, &detail, look.style(words.role));
    let start = area.width.saturating_sub(cells(&title));
    let right = Rect { x: area.x + start, width: area.width - start, ..area };
    print(buffer, right, 0, &title, look.style(Role::Quiet));
}

fn cells(text: &str) -> u16 {
    u16::try_from(columns(text)).unwrap_or(u16::MAX)
}

fn speeds(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let (text, quiet) = (look.style(Role::Text), look.style(Role::Quiet));
    let mut parts = Vec::new();
    let speed = app.speed().abs();
    let ratio = |of: Option<f64>| {
        of.filter(|of| *of > 0.0).map_or("-".to_string(), |of| format!("{:.3}", speed / of))
    };
    parts.push((look.spell("Ω/Ω_c "), quiet));
    parts.push((ratio(app.machine.critical_speed()), text));
    parts.push((look.spell(" Ω/Ω_lock "), quiet));
    parts.push((ratio(app.machine.lock_speed()), text));
    let go = if app.playing { look.either("►", ">") } else { look.either("‖", "=") };
    parts.push((format!("  {go} "), look.style(Role::Focus)));
    parts.push((look.spell(&readable(app.now(), "s")), text));
    let limited = if app.latest.results.pace.limited { " (solver's limit)" } else { "" };
    parts.push((format!(" {}{limited}", app.rate_text()), quiet));
    if app.pages_back > 0 {
        parts.push((format!(" {} back", app.pages_back), look.style(Role::Focus)));
    }
    if app.live {
        parts.push((" LIVE".into(), look.style(Role::Focus)));
    }
    let solver = &app.scene.solver;
    parts.push((format!("  {}", solver.kind), text));
    if let Some(step) = app.latest.results.pace.step_s {
        parts.push((look.spell(&format!(" {}/step", short(step))), text));
    }
    if let Some(run) = app.latest.results.pace.run_s {
        let run = format!(", {} in {}", short(solver.end_s), short(run));
        parts.push((look.spell(&run), quiet));
    }
    parts.push((format!("  {} {}", solver.contact, solver.model), quiet));
    pieces(buffer, area, 1, &parts);
}

/// Two or three digits are enough for a speed.
fn short(seconds: f64) -> String {
    let scale = crate::tui::axis::SiScale::of(seconds);
    let shown = seconds / scale.factor;
    let decimals = usize::from(shown < 9.95);
    format!("{} {}s", trimmed(&format!("{shown:.decimals$}")), scale.prefix)
}
