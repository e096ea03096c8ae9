//! The two lines at the top: scene and verdict; speeds, solver, time.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::{pieces, print};
use crate::tui::app::App;
use crate::tui::axis::readable;
use crate::tui::theme::Role;

/// Draws both lines.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    verdict(app, buffer, area);
    speeds(app, buffer, area);
}

fn verdict(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let words = app.verdict();
    let width = usize::from(area.width);
    let word = format!(" {} ", words.word);
    let style = skin.style(words.role).add_modifier(Modifier::BOLD | Modifier::REVERSED);
    let mut detail = words.detail;
    if let Some(other) = app.disagreement() {
        detail = format!("{detail} | {other}");
    }
    let detail = skin.spell(&detail);
    // The word always stands; its detail, then the title, take what is left.
    let title = skin.spell(&app.scene.title);
    let room = width.saturating_sub(word.chars().count() + 1);
    let detail: String = detail.chars().take(room).collect();
    let left = room.saturating_sub(detail.chars().count() + 2);
    let title: String = if left >= 8 { title.chars().take(left).collect() } else { String::new() };
    print(buffer, area, 0, &word, style);
    let after = Rect {
        x: area.x + cells(&word) + 1,
        width: area.width.saturating_sub(cells(&word) + 1),
        ..area
    };
    print(buffer, after, 0, &detail, skin.style(words.role));
    let start = area.width.saturating_sub(cells(&title));
    let right = Rect { x: area.x + start, width: area.width - start, ..area };
    print(buffer, right, 0, &title, skin.style(Role::Quiet));
}

fn cells(text: &str) -> u16 {
    u16::try_from(text.chars().count()).unwrap_or(u16::MAX)
}

fn speeds(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let (text, quiet) = (skin.style(Role::Text), skin.style(Role::Quiet));
    let mut parts = Vec::new();
    let speed = app.speed().abs();
    let ratio = |of: Option<f64>| {
        of.filter(|of| *of > 0.0).map_or("-".to_string(), |of| format!("{:.3}", speed / of))
    };
    parts.push((skin.spell("Ω/Ω_c "), quiet));
    parts.push((ratio(app.machine.critical_speed()), text));
    parts.push((skin.spell(" Ω/Ω_lock "), quiet));
    parts.push((ratio(app.machine.lock_speed()), text));
    let go = if app.playing { skin.either("►", ">") } else { skin.either("‖", "=") };
    parts.push((format!("  {go} "), skin.style(Role::Focus)));
    parts.push((skin.spell(&readable(app.now(), "s")), text));
    let limited = if app.pace.limited { " (solver's limit)" } else { "" };
    if app.live {
        parts.push((" LIVE".into(), skin.style(Role::Focus)));
    }
    parts.push((format!("  {}{limited}", app.rate_text()), quiet));
    let solver = &app.scene.solver;
    let names = [solver.kind.word(), solver.contact.word(), solver.model.word()].join(" ");
    parts.push((format!("  {names}"), quiet));
    if let Some(pace) = pace(app) {
        parts.push((format!("  {}", skin.spell(&pace)), text));
    }
    pieces(buffer, area, 1, &parts);
}

/// The solver's speed: nanoseconds a step, and the whole run.
fn pace(app: &App) -> Option<String> {
    let run =
        app.pace.run_s.map(|run| format!("{} in {}", short(app.scene.solver.end_s), short(run)));
    let step = app.pace.step_s.map(|step| format!("{}/step", short(step)));
    match (step, run) {
        (Some(step), Some(run)) => Some(format!("{step}, {run}")),
        (step, run) => step.or(run),
    }
}

/// Two or three digits are enough for a speed.
fn short(seconds: f64) -> String {
    let scale = crate::tui::axis::Scale::of(seconds);
    let shown = seconds / scale.factor;
    let decimals = usize::from(shown < 9.95);
    let text = format!("{shown:.decimals$}");
    let text = text.strip_suffix(".0").unwrap_or(&text);
    format!("{text} {}s", scale.prefix)
}
