//! The two lines at the top. The first: what is now, and what will be at the end
//! of the run. The second: where the limits are, whether another solver or a
//! small change says otherwise, and the solver.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier, style::Style};

use crate::report::number::trimmed;
use crate::tui::app::{App, VerdictText};
use crate::tui::appearance::Appearance;
use crate::tui::axis::readable;
use crate::tui::engine::Limit;
use crate::tui::text::{columns, print, shorten, spelled_pieces};
use crate::tui::theme::{Role, Theme};
use crate::tui::views::map::colour;

/// Columns that the words after the verdict should have, if there are any.
const DETAIL: usize = 40;
/// From this width on, the next change of contact is told.
const ROOMY: usize = 110;
/// From this width on, the second line has the limits in full and the solver,
const WIDE: u16 = 100;
/// and from this one on the limits beside a doubt.
const MEDIUM: u16 = 60;
/// Below this width the verdict comes first.
const NARROW: usize = 60;
/// Most columns of a title.
const MOST_TITLE: usize = 40;

type Parts = Vec<(String, Style)>;

/// Columns of the lines where there is no screen: room for all of them.
const TOLD: u16 = 240;

/// Both lines as text, for where there is no screen.
pub fn head_text(app: &App) -> [String; 2] {
    let area = Rect::new(0, 0, TOLD, 2);
    let mut buffer = Buffer::empty(area);
    draw(app, &mut buffer, area);
    let row = |y: u16| {
        let cells = (0..TOLD).filter_map(|x| buffer.cell((x, y)));
        let text: String = cells.map(|cell| cell.symbol()).collect();
        // What stands apart on a screen is parted by three spaces.
        let parts = text.split("   ").map(str::trim).filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>().join("   ")
    };
    [0, 1].map(row)
}

/// Draws both lines.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let first = now_and_end(app, usize::from(area.width));
    let used = spelled_pieces(look, buffer, area, 0, &first);
    let mut parts = pace(app);
    // In a lesson the title, too, and what another solver finds would be an answer.
    let asked = app.is_asked();
    if !asked {
        title(app, buffer, area, used);
    }
    let doubt = app.disagreement().filter(|_| !asked);
    let doubted = doubt.is_some();
    if area.width >= WIDE {
        parts.extend(limits(app));
    } else if !doubted || area.width >= MEDIUM {
        parts.extend(short_limits(app));
    }
    if !asked {
        parts.extend(doubts(app, doubt));
    }
    if area.width >= WIDE || !doubted {
        parts.extend(solver(app));
    }
    spelled_pieces(look, buffer, area, 1, &parts);
}

/// The title of the scene at the right end, if there is room.
fn title(app: &App, buffer: &mut Buffer, area: Rect, used: u16) {
    let look = &app.appearance;
    let left = area.width.saturating_sub(used.saturating_add(3));
    let title = shorten(&look.spell(&app.scene.title), MOST_TITLE, look.ellipsis());
    let wide = u16::try_from(columns(&title)).unwrap_or(u16::MAX);
    // A part of it beside the verdict would read as one sentence.
    if wide > left {
        return;
    }
    let right = Rect { x: area.right() - wide, width: wide, ..area };
    print(buffer, right, 0, &title, look.style(Role::Quiet));
}

/// `NOW free ► 12.7 ms 430.2 rad/s | AT 100 ms LOCKED on 6 + 21 since 76.9 ms`.
fn now_and_end(app: &App, width: usize) -> Parts {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    // The end would answer the question of a lesson.
    let words = match app.is_asked() {
        true => {
            VerdictText { word: "?".into(), detail: "your answer first".into(), role: Role::Quiet }
        }
        false => app.verdict(),
    };
    let word = format!(" {} ", words.word);
    let mut detail = words.detail;
    if let Some(baseline) = &app.run.baseline
        && baseline.words.word != words.word
    {
        detail = format!("{detail} | pinned: {}", baseline.words.word);
    }
    // The colour of the verdict in the map, where it has one.
    let verdict = app.full_run().map(|run| run.verdict);
    let verdict = verdict.filter(|verdict| verdict.as_ref().to_uppercase() == words.word);
    let own = verdict.filter(|_| look.theme != Theme::Mono);
    let own = own.and_then(|verdict| colour(look, verdict));
    let style = own.map_or(look.style(words.role), |colour| Style::new().fg(colour));
    let loud = (word.clone(), style.add_modifier(Modifier::BOLD | Modifier::REVERSED));
    let end = duration(app.end_s());
    let at = format!(" | AT {end} ");
    let needed = |now: &Parts, detail: usize| {
        let now: usize = now.iter().map(|(text, _)| columns(text)).sum();
        now + columns(&at) + columns(&word) + detail <= width
    };
    let wanted = (columns(&detail) + 1).min(DETAIL);
    let about = |detail: String| (format!(" {detail}"), look.style(words.role));
    let least = now(app, 0);
    if width < NARROW || !needed(&least, 0) {
        let after = vec![(format!(" AT {end}"), quiet)];
        let beside = std::iter::once((" | ".to_string(), quiet)).chain(least).collect();
        return that_fit(look, width, vec![vec![loud], after, beside, vec![about(detail)]]);
    }
    let mut now = now(app, 3);
    for much in [2, 1, 0] {
        let room = if much == 2 { width >= ROOMY } else { true };
        if room && needed(&now, if much == 0 { 0 } else { wanted }) {
            break;
        }
        now = self::now(app, much);
    }
    now.extend([(at, quiet), loud]);
    if !detail.is_empty() {
        now.push(about(detail));
    }
    now
}

/// The first group, and of the others those that have room whole, up to the first that
/// has none.
fn that_fit(look: &Appearance, width: usize, groups: Vec<Parts>) -> Parts {
    let mut used = 0;
    let fits = |(place, group): &(usize, Parts)| {
        used += group.iter().map(|(text, _)| columns(&look.spell(text))).sum::<usize>();
        *place == 0 || used <= width
    };
    groups.into_iter().enumerate().take_while(fits).flat_map(|(_, group)| group).collect()
}

/// What is now: 3 all of it, 2 without the next change, 1 without speed, 0 in
/// one word.
fn now(app: &App, much: u8) -> Parts {
    let look = &app.appearance;
    let (text, quiet) = (look.style(Role::Text), look.style(Role::Quiet));
    let state = app.state_now();
    let touches = state != "free" && state != "starting";
    let role = if touches { Role::Contact } else { Role::Text };
    let state = match much {
        0 => state.split(' ').next().unwrap_or_default().to_string(),
        _ => state,
    };
    let go = if app.play.playing { look.either('►', '>') } else { look.either('‖', '=') };
    let mut parts = vec![
        ("NOW ".to_string(), quiet),
        (state, look.style(role)),
        (format!(" {go} "), look.style(Role::Focus)),
        (readable(app.now(), "s"), text),
    ];
    if much >= 2 {
        let arrow = match app.scene.operation.speed_ramp_rad_s2 {
            ramp if ramp > 0.0 => "↑",
            ramp if ramp < 0.0 => "↓",
            _ => "",
        };
        parts.push((format!("  {}{arrow}", readable(app.speed(), "rad/s")), text));
    }
    if much >= 3
        && let Some(next) = app.next_change()
    {
        let (what, after) = (app.happening(next.what), readable(next.t_s - app.now(), "s"));
        parts.push((format!("  next: {what} in {after}"), quiet));
    }
    parts
}

/// How it plays.
fn pace(app: &App) -> Parts {
    let look = &app.appearance;
    let (quiet, focus) = (look.style(Role::Quiet), look.style(Role::Focus));
    let limit = match app.results().pace.limit {
        Limit::None => "",
        Limit::Solver => " (solver's limit)",
        Limit::Wave => " (slowed: the wave)",
    };
    let about = if app.play.slow_at_events { "about " } else { "" };
    let mut parts = vec![(format!("{about}{}{limit}", app.rate_text()), quiet)];
    if app.play.pages_back != 0 {
        let (count, word) =
            (app.play.pages_back, if app.play.pages_back > 0 { "back" } else { "ahead" });
        parts.push((format!(" {} {word}", count.abs()), focus));
    }
    if app.knobs.live {
        parts.push((" LIVE".into(), focus));
    }
    parts
}

/// The limits of a lock, by the index of their symbol.
fn thresholds(app: &App) -> [(&'static str, Option<f64>); 2] {
    [("c", app.machine.critical_speed()), ("lock", app.lock_speed())]
}

/// The speed up to which a lock holds, behind the one from which it does.
fn lock_ends(app: &App) -> Option<String> {
    let to = app.lock_window()?.to?;
    Some(format!(" to {}", short(to)))
}

/// The limits as numbers, and the present speed in parts of them.
fn limits(app: &App) -> Parts {
    let look = &app.appearance;
    let (text, quiet) = (look.style(Role::Text), look.style(Role::Quiet));
    let speed = app.speed().abs();
    let mut parts = Vec::new();
    let ends = lock_ends(app).unwrap_or_default();
    let mut ratio = |name: &str, limit: f64, to: &str| {
        parts.push((format!("  Ω/{name} "), quiet));
        parts.push((format!("{:.3}", speed / limit), text));
        parts.push((format!(" of {}{to}", short(limit)), quiet));
    };
    let (coupled, coincidence) = (app.is_coupled(), app.coincidence());
    let [critical, lock] = thresholds(app).map(|(name, limit)| {
        if let Some(limit) = limit.filter(|limit| *limit > 0.0) {
            ratio(&format!("Ω_{name}"), limit, if name == "lock" { &ends } else { "" });
        }
        limit
    });
    if let Some(coincidence) = coincidence.filter(|_| coupled) {
        ratio("coincidence", coincidence, "");
    }
    if critical.is_none() || lock.is_none() {
        let what = if critical.is_none() { "no Ω_c" } else { "no lock at any speed" };
        parts.push((format!("  {what}"), quiet));
    }
    if let Some(coincidence) = app.machine.dangerous_speed_toward(app.speed())
        && !coupled
    {
        parts.push((format!(" · coincidence {}", short(coincidence)), quiet));
    }
    parts
}

/// The limits alone.
fn short_limits(app: &App) -> Parts {
    let look = &app.appearance;
    let (text, quiet) = (look.style(Role::Text), look.style(Role::Quiet));
    let mut parts = Vec::new();
    let coupled = app.is_coupled();
    for (name, limit) in thresholds(app) {
        match limit {
            // Where the coincidence matters, Ω_c makes room for it.
            _ if coupled && name == "c" => {}
            None if name == "lock" => parts.push(("  no lock".into(), quiet)),
            limit => {
                parts.push((format!("  Ω_{name} "), quiet));
                parts.push((limit.map_or("-".into(), short), text));
            }
        }
    }
    parts.extend(lock_ends(app).map(|ends| (ends, text)));
    if let Some(coincidence) = app.coincidence().filter(|_| coupled) {
        parts.push(("  coincidence ".into(), quiet));
        parts.push((short(coincidence), text));
    }
    parts.push((" rad/s".into(), quiet));
    parts
}

/// Four or five digits are enough for a limit.
fn short(speed: f64) -> String {
    let decimals = if speed.abs() < 10.0 { 3 } else { 1 };
    trimmed(&format!("{speed:.decimals$}")).to_string()
}

/// Whether another solver, or a small change, says otherwise.
fn doubts(app: &App, doubt: Option<String>) -> Parts {
    let look = &app.appearance;
    let known = app.full_run().zip(app.results().reference.as_ref()).is_some();
    match doubt {
        Some(other) => vec![(format!("  | {other}"), look.style(Role::Trouble))],
        None if known => vec![("  | event agrees".into(), look.style(Role::Quiet))],
        None => Parts::new(),
    }
}

/// The solver and its speed; the scene.
fn solver(app: &App) -> Parts {
    let look = &app.appearance;
    let (text, quiet) = (look.style(Role::Text), look.style(Role::Quiet));
    let solver = &app.scene.solver;
    let mut parts = vec![
        ("  ".to_string(), quiet),
        (solver.kind.to_string(), text),
        (format!(" {} {}", solver.contact, solver.model), quiet),
    ];
    let pace = &app.results().pace;
    if let Some(step) = pace.step_s {
        parts.push((format!(" {}/step taken", duration(step)), text));
    }
    if let Some(part) = pace.skipped {
        // Rounded down: 100 % means that no step was taken.
        let percent = (1e3 * part).floor() / 10.0;
        parts.push((format!(", {} % skipped", trimmed(&format!("{percent:.1}"))), quiet));
    }
    if let Some(run) = pace.run_s {
        parts.push((format!(", {} in {}", duration(solver.end_s), duration(run)), quiet));
    }
    parts
}

/// Two or three digits are enough for a duration.
fn duration(seconds: f64) -> String {
    let scale = crate::tui::axis::SiScale::of(seconds);
    let shown = seconds / scale.factor;
    let decimals = usize::from(shown < 99.95);
    format!("{} {}s", trimmed(&format!("{shown:.decimals$}")), scale.prefix)
}
