//! The two lines at the top. The first says in one sentence how the run ends and how it came to
//! that; it is red only if the result is suspect. The second gives the time and contact state now,
//! the rotor speed relative to its limits, and the end of the run. A part that does not fit has a
//! short form or is left out; no part is cut.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier, style::Style};

use crate::sheet::number::{
    in_tenths, per_speed, rounded, short as digits, speed_unit, trimmed, with_unit,
};
use crate::sheet::sentence::Sentence;
use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::axis::{number, readable};
use crate::tui::engine::{FORECAST_LIMIT, Limit, Sensitive};
use crate::tui::text::{columns, pieces, print};
use crate::tui::theme::{Role, Theme};
use crate::tui::views::map::colour;
use rubscope_solver::motion::Verdict;

type Parts = Vec<(String, Style)>;

/// Width of both lines for `--lines`, where there is no screen \[columns\]: room for every part.
const WIDE: u16 = 240;

/// Returns both lines as text, for `--lines`.
pub fn head_text(app: &App) -> [String; 2] {
    let area = Rect::new(0, 0, WIDE, 2);
    let mut buffer = Buffer::empty(area);
    draw(app, &mut buffer, area);
    let row = |y: u16| {
        let cells = (0..WIDE).filter_map(|x| buffer.cell((x, y)));
        let text: String = cells.map(|cell| cell.symbol()).collect();
        // Parts that are aligned apart on a screen are separated by three spaces.
        let parts = text.split("   ").map(str::trim).filter(|part| !part.is_empty());
        parts.collect::<Vec<_>>().join("   ")
    };
    [0, 1].map(row)
}

pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let used = sentence(app, buffer, area);
    // In a lesson, the title could give the answer away.
    if !app.is_asked() {
        title(app, buffer, area, used);
    }
    second(app, buffer, area);
}

/// Draws the first line; returns its width in columns.
fn sentence(app: &App, buffer: &mut Buffer, area: Rect) -> u16 {
    let look = &app.appearance;
    // The reversed word has a space on each side.
    let width = usize::from(area.width).saturating_sub(1);
    let (headline, style) = headline(app, width);
    let mut parts = vec![(format!(" {} ", headline.word), style.add_modifier(Modifier::REVERSED))];
    parts.push((format!(" {}", headline.what), look.style(Role::Text)));
    let role = if headline.wrong { Role::Trouble } else { Role::Quiet };
    parts.extend(headline.history.map(|history| (format!(" {history}"), look.style(role))));
    let parts: Parts = parts.into_iter().map(|(text, style)| (look.spell(&text), style)).collect();
    pieces(buffer, area, 0, &parts);
    u16::try_from(parts.iter().map(|(text, _)| columns(text)).sum::<usize>()).unwrap_or(u16::MAX)
}

/// Returns the headline that fits `width`, and the style of its verdict.
pub fn headline(app: &App, width: usize) -> (Sentence, Style) {
    let look = &app.appearance;
    // The verdict would answer the open question of a lesson.
    if app.is_asked() {
        let forms = ["Your answer first.", ""].map(String::from);
        return (Sentence::of("?", forms, &[], width), look.style(Role::Quiet));
    }
    let sentence = app.sentence(width);
    let style = match app.verdict() {
        _ if app.run.latest.trouble.is_some() || sentence.wrong => look.style(Role::Trouble),
        Some(verdict) => verdict_style(look, verdict),
        // Nothing is wrong, but no verdict will come.
        None if app.is_given_up() => look.style(Role::Text).add_modifier(Modifier::BOLD),
        None => look.style(Role::Quiet),
    };
    (sentence, style)
}

/// Returns the style of a verdict: its colour in the map, or that of trouble.
fn verdict_style(look: &Appearance, verdict: Verdict) -> Style {
    let own = colour(look, verdict).filter(|_| look.theme != Theme::Mono);
    let style = match (verdict, own) {
        (Verdict::Failed | Verdict::Adhesive | Verdict::Divergent, _) => look.style(Role::Trouble),
        (_, Some(colour)) => Style::new().fg(colour),
        (_, None) => look.style(Role::Text),
    };
    style.add_modifier(Modifier::BOLD)
}

/// Prints the scene's title at the right end if it fits as a whole.
fn title(app: &App, buffer: &mut Buffer, area: Rect, used: u16) {
    let look = &app.appearance;
    let title = look.spell(&app.scene.title);
    let wide = u16::try_from(columns(&title)).unwrap_or(u16::MAX);
    // A truncated title beside the sentence would read as part of it.
    if wide <= area.width.saturating_sub(used.saturating_add(3)) {
        let right = Rect { x: area.right() - wide, width: wide, ..area };
        print(buffer, right, 0, &title, look.style(Role::Quiet));
    }
}

/// A part of the second line. While the line is too long, the last part of the highest rank is
/// left out.
struct Part {
    /// 0 for the most important parts.
    rank: u8,
    /// Text between the previous part and this one.
    gap: &'static str,
    pieces: Vec<(String, Role)>,
}

/// Text between two parts that do not belong together.
const GAP: &str = "   ";

/// Creates a part of one style, separated from the previous one by [`GAP`].
fn plain(rank: u8, text: String, role: Role) -> Part {
    Part { rank, gap: GAP, pieces: vec![(text, role)] }
}

fn second(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let mut parts: Vec<Part> = [now(app), speed(app), end(app)].into_iter().flatten().collect();
    if !app.is_asked() {
        parts.extend(baseline(app));
        parts.extend(unsure(app));
    }
    parts.extend(modes(app));
    parts.extend(next(app));
    parts.extend(limits(app));
    parts.extend(cost(app));
    let width_of = |part: &Part| {
        let pieces = part.pieces.iter().map(|(text, _)| columns(&look.spell(text)));
        part.gap.len() + pieces.sum::<usize>()
    };
    let width = usize::from(area.width) + GAP.len();
    while parts.iter().map(width_of).sum::<usize>() > width {
        let last = parts.iter().enumerate().max_by_key(|(_, part)| part.rank);
        let Some((last, _)) = last else { break };
        parts.remove(last);
    }
    let mut line = Parts::new();
    for part in parts {
        if !line.is_empty() {
            line.push((part.gap.into(), look.style(Role::Quiet)));
        }
        line.extend(part.pieces.iter().map(|(text, role)| (look.spell(text), look.style(*role))));
    }
    pieces(buffer, area, 1, &line);
}

/// Returns the present state: `NOW 12.0 ms held on 12 + 19 ► 200x slower`.
fn now(app: &App) -> Vec<Part> {
    let (text, quiet) = (Role::Text, Role::Quiet);
    let state = app.state_now();
    let touches = state != "free" && state != "starting";
    let role = match app.failure().is_some() {
        true => Role::Trouble,
        false if touches => Role::Contact,
        false => Role::Text,
    };
    let go = if app.play.playing { "►" } else { app.appearance.either("‖", "=") };
    let limit = match app.results().pace.limit {
        Limit::None => "",
        Limit::Solver => " (solver's limit)",
        Limit::Wave => " (slowed: the wave)",
    };
    let time = vec![("NOW ".into(), quiet), (readable(app.now(), "s"), text)];
    let rate = vec![(go.to_string(), Role::Focus), (format!(" {}{limit}", app.rate_text()), quiet)];
    vec![
        Part { rank: 0, gap: GAP, pieces: time },
        Part { rank: 2, gap: " ", pieces: vec![(state, role)] },
        Part { rank: 7, gap: " ", pieces: rate },
    ]
}

/// Returns the rotor speed, also as a multiple of its limits: `500 rad/s = 1.71 Ω_c = 1.21 Ω_lock`.
fn speed(app: &App) -> Vec<Part> {
    let (text, quiet) = (Role::Text, Role::Quiet);
    let arrow = match app.scene.operation.speed_ramp_rad_s2 {
        ramp if ramp > 0.0 => "↑",
        ramp if ramp < 0.0 => "↓",
        _ => "",
    };
    // During a ramp, keep the width constant.
    let shown = match arrow {
        "" => digits(rounded(per_speed(app.speed()), 4)),
        _ => format!("{:.1}", per_speed(app.speed())),
    };
    let mut parts = vec![plain(1, format!("{shown} {}{arrow}", speed_unit()), text)];
    for (place, (name, limit)) in named_limits(app).into_iter().enumerate() {
        let rank = if place == 0 { 3 } else { 4 };
        let (gap, pieces) = match limit {
            Some(limit) if limit > 0.0 => {
                let ratio = format!("{:.2}", app.speed().abs() / limit);
                (" ", vec![("= ".into(), quiet), (ratio, text), (format!(" {name}"), quiet)])
            }
            Some(_) => continue,
            None if name == "lock" && !app.machine.knows_locks() => {
                ("", vec![(", lock not known".to_string(), quiet)])
            }
            None => ("", vec![(format!(", no {name}"), quiet)]),
        };
        parts.push(Part { rank, gap, pieces });
    }
    parts
}

/// Returns the limits of the rotor speed that matter for this scene \[rad/s\], the most important
/// first; `None` if a limit does not exist.
fn named_limits(app: &App) -> Vec<(&'static str, Option<f64>)> {
    let (critical, lock) = (("Ω_c", app.machine.critical_speed()), app.lock_speed());
    let lock = (if lock.is_none() { "lock" } else { "Ω_lock" }, lock);
    let coincidence = app.coincidence().filter(|_| app.scene.is_coupled());
    let mut limits = match coincidence {
        Some(speed) => vec![("coincidence", Some(speed)), lock, critical],
        None => vec![critical, lock],
    };
    limits.retain(|(name, limit)| *name != "Ω_c" || limit.is_some());
    limits.sort_by_key(|(_, limit)| limit.is_none());
    limits
}

/// Returns the limits of the rotor speed as numbers; `None` if there are none.
fn limits(app: &App) -> Option<Part> {
    let to = app.lock_window().and_then(|window| window.to);
    let short = |speed| in_tenths(per_speed(speed));
    let known = named_limits(app).into_iter().filter_map(|(name, limit)| Some((name, limit?)));
    let mut listed: Vec<String> = known
        .map(|(name, limit)| {
            let to = to.filter(|_| name == "Ω_lock").map(|to| format!(" to {}", short(to)));
            format!("{name} {}{}", short(limit), to.unwrap_or_default())
        })
        .collect();
    if !app.scene.is_coupled()
        && let Some(coincidence) = app.machine.dangerous_speed_toward(app.speed())
    {
        listed.push(format!("coincidence {}", short(coincidence)));
    }
    (!listed.is_empty()).then(|| plain(10, listed.join(", "), Role::Quiet))
}

/// Returns the end of the run and its verdict, which the first line has too: `AT 100 ms locked since
/// 38.1 µs`.
fn end(app: &App) -> Vec<Part> {
    let (text, quiet) = (Role::Text, Role::Quiet);
    let piece = |rank, gap, text| Part { rank, gap, pieces: vec![(text, quiet)] };
    let at = vec![("AT ".into(), quiet), (number(rounded(app.end_s(), 4), "s"), text)];
    let verdict = app.verdict().filter(|_| !app.is_asked());
    let verdict = verdict.map_or("?".into(), |verdict| verdict.to_string());
    // A reminder takes this place before that of a limit.
    let rank = if modes(app).is_some() { 5 } else { 0 };
    let mut parts = vec![Part { rank, gap: GAP, pieces: at }, piece(5, " ", verdict)];
    let Some(run) = app.full_run().filter(|_| !app.is_asked()) else { return parts };
    // Of a whirl or a slip, only the latest change of sides is known; where a tiny change
    // decides, no instant is known at all.
    let known = !app.results().sensitive.known().sensitive;
    let held = run.locked_s.filter(|_| known);
    let broken = run.broken.filter(|_| known && !run.facts.verdict.keeps_contact());
    let since = held.map(|t| (" ", format!("since {}", readable(t, "s"))));
    let until = broken.map(|hold| ("", format!(", locked until {}", readable(hold.ended, "s"))));
    parts.extend(since.or(until).map(|(gap, text)| piece(6, gap, text)));
    parts
}

/// Returns a note if the sensitivity check was given up, or, for a doubtful verdict with skipped
/// steps, how to check it; `None` otherwise.
fn unsure(app: &App) -> Option<Part> {
    let (results, known) = (app.results(), app.results().sensitive.known());
    let doubtful = known.sensitive || known.depends_on_step == Some(true);
    let (rank, text) = if results.sensitive == Sensitive::GivenUp {
        (7, format!("small changes: not checked in {} s", FORECAST_LIMIT.as_secs()))
    } else if doubtful && results.pace.skipped.is_some_and(|part| part > 0.0) {
        (2, "audit: A".to_string())
    } else {
        return None;
    };
    Some(plain(rank, text, Role::Quiet))
}

/// Returns the verdict of the pinned run; `None` if it is that of the current run, or no run is
/// pinned.
fn baseline(app: &App) -> Option<Part> {
    let word = &app.run.baseline.as_ref()?.word;
    let text = format!("pinned: {word}");
    (*word != app.verdict_word()).then(|| plain(3, text, Role::Text))
}

/// Returns reminders of unusual states: the motion is not on the page shown, knobs are live, every
/// step is taken, and no own mode is known for the number of nodal diameters.
fn modes(app: &App) -> Option<Part> {
    let ((from, to), now) = (app.page(), app.now().min(app.end_s()));
    let word = if now > to { "back" } else { "ahead" };
    let pages = ((now - from) / (to - from) - 1e-9).floor().abs();
    let modes = [
        ((now < from || now > to) && pages >= 1.0).then(|| format!("{pages} {word}")),
        app.knobs.live.then(|| "LIVE".into()),
        app.scene.solver.plain.then(|| "PLAIN".into()),
        app.scene.modes_note().map(|_| "n_d: no own mode".into()),
    ];
    let modes: Vec<String> = modes.into_iter().flatten().collect();
    (!modes.is_empty()).then(|| plain(1, modes.join(" "), Role::Focus))
}

/// Returns the next change of contact and the time until then: `next: impact on 6 in 12 µs`. `None`
/// if there is none, the run is not complete, or a question is open.
fn next(app: &App) -> Option<Part> {
    let next = app.next_change().filter(|_| !app.is_asked())?;
    let (what, after) = (app.happening(next.what), readable(next.t_s - app.now(), "s"));
    Some(plain(8, format!("next: {what} in {after}"), Role::Quiet))
}

/// Returns the cost of the run: wall-clock time per step taken, fraction of skipped steps, and
/// wall-clock time in all. `None` until the run is complete.
fn cost(app: &App) -> Option<Part> {
    let pace = &app.results().pace;
    let run = pace.run_s?;
    let mut parts = Vec::new();
    parts.extend(pace.step_s.map(|step| format!("{}/step taken", with_unit(step, 3, "s"))));
    if let Some(part) = pace.skipped {
        // Round down, so that 100 % means that no step was taken.
        let percent = (1e3 * part).floor() / 10.0;
        parts.push(format!("{} % skipped", trimmed(&format!("{percent:.1}"))));
    }
    let [end, run] = [app.scene.solver.end_s, run].map(|time| with_unit(time, 3, "s"));
    parts.push(format!("{end} in {run}"));
    Some(plain(11, parts.join(", "), Role::Quiet))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::engine::FullRunState;
    use crate::tui::raster::Marker;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_run_that_was_given_up_is_told_as_text_and_not_as_work() {
        let scene = Scene::base().checked().unwrap();
        let mut app = App::new(scene, Theme::Dark, Marker::Braille);
        let style = |app: &App| headline(app, 80).1;
        assert_eq!(style(&app), app.appearance.style(Role::Quiet));
        app.run.latest.results.full_run = Some(FullRunState::GivenUp(0.3));
        assert_eq!(app.verdict_word(), "NO FORECAST");
        let text = app.appearance.style(Role::Text).add_modifier(Modifier::BOLD);
        assert_eq!(style(&app), text);
    }

    #[test]
    fn a_verdict_that_is_proved_is_told_while_its_run_goes_on() {
        let scene = Scene::base().checked().unwrap();
        let mut app = App::new(scene, Theme::Dark, Marker::Braille);
        app.run.latest.results.full_run = Some(FullRunState::Computing(0.13));
        assert_eq!(app.verdict_word(), "computing");
        app.run.latest.results.verdict = Some(Verdict::Decay);
        let (told, style) = headline(&app, 80);
        assert_eq!(
            (told.word.as_str(), told.what.as_str()),
            ("DECAY", "Proved. Computing the run, 13 %.")
        );
        assert_eq!(style, verdict_style(&app.appearance, Verdict::Decay));
        assert_eq!(end(&app)[1].pieces[0].0, "decay");
        app.run.latest.results.full_run = Some(FullRunState::GivenUp(0.3));
        assert_eq!(app.verdict_word(), "DECAY");
        app.run.show(app.run.film.fired(0.0));
        assert_eq!(app.verdict_word(), "computing");
    }
}
