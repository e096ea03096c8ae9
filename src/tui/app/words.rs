//! Commands in words: one list of everything that can be done and one parser of typed text, for the
//! list opened by `:` and for `--lines`. A word that introduces a target (`t 0.3 ms`, `blade 7`,
//! `scene rub`) or a knob with a value takes precedence over entries that contain the words.

use super::model::App;
use crate::machine::range_doubt;
use crate::sheet::number::with_typed_unit;
use crate::tui::axis::readable;
use crate::tui::command::chord::Chord;
use crate::tui::command::table::{self, Binding, Group};
use crate::tui::command::{Command, Purpose};
use crate::tui::knobs::{Fit, KNOBS, Knob, called, fit, knob_of, plain};
use crate::tui::lessons::{self, LETTERS};
use crate::tui::theme::Theme;
use crate::tui::views::map::plan::numeric;
use rubscope_solver::scene::Value;
use rubscope_solver::scene::keys;
use rubscope_solver::scene::speed_range;
use rubscope_solver::scene::{Quantity, SceneError};

/// A command as an entry of the list.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Kind of the command, such as `scene` or `knob`.
    pub kind: &'static str,
    /// Description of what it does.
    pub what: String,
    /// Text shown beside the entry, such as the key that does the same or the present value of a
    /// knob; may be empty.
    pub beside: String,
    /// The command to execute.
    pub command: Command,
    /// What is said about the entry below the list while it is selected; may be empty.
    pub note: String,
    /// Whether it is selected before another is chosen.
    pub first: bool,
    /// Other words that match the entry.
    also: String,
}

impl Found {
    fn of(kind: &'static str, what: impl Into<String>, command: Command) -> Self {
        let (beside, note, also) = Default::default();
        Self { kind, what: what.into(), beside, command, note, first: false, also }
    }

    fn beside(self, beside: impl Into<String>) -> Self {
        Self { beside: beside.into(), ..self }
    }

    fn also(self, also: impl Into<String>) -> Self {
        Self { also: also.into(), ..self }
    }
}

/// Returns the entries that match the typed words, the best first.
pub fn found(app: &App, typed: &str) -> Vec<Found> {
    if let Some(found) = directed(app, typed) {
        return found.unwrap_or_default();
    }
    let mut all: Vec<Found> = going_to(app, typed).into_iter().collect();
    all.extend(assignments(app, typed).into_iter().filter_map(|(_, item)| item.ok()));
    all.extend(ranked(everything(app), typed));
    all
}

/// Returns the command of a whole line. A single character is a key.
///
/// # Errors
/// One line that explains why the line is no command.
pub fn only(app: &App, typed: &str) -> Result<Found, String> {
    let typed = typed.trim();
    let mut signs = typed.chars();
    if let (Some(sign), None) = (signs.next(), signs.next())
        && let Some(command) = table::lookup(app.keyboard(), Chord::from(sign))
    {
        return Ok(Found::of("key", typed, command));
    }
    // The name of a knob alone selects it, which prints its value.
    if let Some(place) = called(typed) {
        return Ok(Found::of("knob", typed, Command::Select(place)));
    }
    if let Some(Err(why)) = directed(app, typed) {
        return Err(why);
    }
    let assignments = assignments(app, typed);
    let refusals = assignments.iter().filter_map(|(fit, item)| Some((*fit, item.as_ref().err()?)));
    let refusal = refusals.min_by_key(|(fit, _)| *fit);
    match (found(app, typed).into_iter().next(), refusal) {
        (Some(Found { command: Command::Set(..), .. }), _) => alone(assignments, typed),
        (Some(item), Some(((fit, _), why))) if gives_way(&item, typed, fit) => Err(why.clone()),
        (Some(item), _) => Ok(item),
        (None, Some((_, why))) => Err(why.clone()),
        (None, None) if is_numeric(typed) => {
            Err(format!("{typed}: which knob? Write for example speed 450 rad/s"))
        }
        (None, None) => Err(format!("no command matches: {typed}; help lists the commands")),
    }
}

/// Returns whether an entry is worse than the error of a knob that is named this well but refuses
/// the value: one that selects a knob, or contains the words by chance.
fn gives_way(item: &Found, typed: &str, fit: Fit) -> bool {
    let (what, typed) = (item.what.to_lowercase(), typed.to_lowercase());
    let is_own = |word: &str| what.split_whitespace().any(|own| own == word);
    let by_chance = ["", "knob", "scene", "lesson"].contains(&item.kind)
        && !typed.split_whitespace().all(is_own);
    matches!(item.command, Command::Select(_)) || (fit < Fit::Begins && by_chance)
}

/// Returns the only one of the best of `assignments`; an error if several knobs match equally well.
fn alone(assignments: Vec<Assignment>, typed: &str) -> Result<Found, String> {
    let mut fitting =
        assignments.into_iter().filter_map(|((fit, _), item)| Some((fit, item.ok()?)));
    let Some((best, first)) = fitting.next() else { return Err(format!("{typed}: which knob?")) };
    let others = fitting.take_while(|(fit, _)| *fit == best).map(|(_, item)| item);
    let alike: Vec<Found> = std::iter::once(first).chain(others).collect();
    if let [one] = alike.as_slice() {
        return Ok(one.clone());
    }
    // Before the value.
    let label = |item: &Found| item.what.split(" = ").next().unwrap_or_default().to_string();
    let mut named: Vec<String> = alike.iter().take(CANDIDATES).map(label).collect();
    if alike.len() > CANDIDATES {
        named.push("others".into());
    }
    Err(format!("{typed}: which of {}?", named.join(", ")))
}

/// Largest number of candidates listed for an ambiguous name.
const CANDIDATES: usize = 4;

/// Returns whether a word looks like a number.
fn is_numeric(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_digit() || first == '-')
}

/// Returns the entries that an introductory word such as `blade` or `scene` leads to, or why what
/// follows it is refused; `None` if the text begins with no such word.
fn directed(app: &App, typed: &str) -> Option<Result<Vec<Found>, String>> {
    let typed = typed.trim_start();
    let (first, rest) = typed.split_once([' ', '='])?;
    let rest = rest.trim();
    let lower = rest.to_lowercase();
    let first = first.to_lowercase();
    Some(Ok(match first.as_str() {
        "t" if !rest.is_empty() => match going_to(app, typed) {
            Some(time) => vec![time],
            None => return Some(Err(format!("t {rest}: not a time; write for example 0.3 ms"))),
        },
        "blade" => {
            let all = app.machine.polygon.blades;
            let blade = |blade: u32| {
                Found::of("go", format!("blade {blade}"), Command::Blade(blade))
                    .beside(format!("of {all}"))
            };
            match rest.parse() {
                Ok(number) => vec![blade(number)],
                Err(_) if is_numeric(rest) => {
                    return Some(Err(format!("blade {rest}: from 1 to {all}")));
                }
                // "blade" also begins the name of knobs.
                Err(_) => return None,
            }
        }
        "axes" => match both_axes(&lower) {
            Some(both) => vec![both],
            None => one_axis(app, "across", &lower),
        },
        "across" | "up" => one_axis(app, &first, &lower),
        "range" => match surveyed(app, rest) {
            Ok(range) => vec![range],
            Err(why) => return Some(Err(why.to_string())),
        },
        "scene" => ranked(scenes(app, rest), rest),
        "lesson" => match lower.parse::<usize>() {
            Ok(number) => lessons(app, rest).nth(number.checked_sub(1)?).into_iter().collect(),
            Err(_) => ranked(lessons(app, rest), rest),
        },
        "answer" => {
            let place = LETTERS.iter().position(|letter| lower == letter.to_string())?;
            vec![Found::of("go", typed.trim(), Command::Answer(place))]
        }
        "theme" => {
            let named = Theme::ALL.into_iter().filter(|theme| theme.name().starts_with(&lower));
            let of = |theme: Theme| {
                Found::of("look", format!("theme {}", theme.name()), Command::Theme(theme))
            };
            named.map(of).collect()
        }
        "save" | "export" if !rest.is_empty() && !rest.contains(' ') => {
            let purpose = if first == "save" { Purpose::Save } else { Purpose::Export };
            vec![Found::of("file", typed.trim(), Command::Write(purpose, rest.into()))]
        }
        _ => return None,
    }))
}

/// Parses the speed range of a survey: `200:600`, `200 600` or `all`.
fn surveyed(app: &App, text: &str) -> Result<Found, SceneError> {
    // A space may also separate a number from its unit, so the second number is searched for.
    let second = |&at: &usize| text.get(at + 1..).is_some_and(is_numeric);
    let spaces = text.match_indices(' ').map(|(at, _)| at);
    let ends = match spaces.filter(|_| !text.contains(':')).find(second) {
        Some(at) => format!("{}:{}", text.split_at(at).0, text.split_at(at + 1).1),
        None => text.to_string(),
    };
    let typed = with_typed_unit(&ends, Quantity::Speed);
    let range = (text != "all").then(|| speed_range("range", &typed)).transpose()?;
    let is_bare = typed.split(':').all(|end| Quantity::bare(end).is_some());
    let doubt = range.filter(|_| is_bare).and_then(|range| range_doubt(&app.scene, range));
    let command = Command::Range { ends: range, doubt };
    Ok(Found::of("go", format!("survey of all nodal diameters over {ends}"), command))
}

/// Returns the entries that match the typed words. An exact name comes first; entries of equal rank
/// keep their order.
fn ranked(all: impl Iterator<Item = Found>, typed: &str) -> Vec<Found> {
    let typed = typed.trim().to_lowercase();
    let words: Vec<&str> = typed.split_whitespace().collect();
    let place = |item: &Found| match &item.command {
        Command::Scene(name) if *name == typed => 0,
        Command::View(view) if view.word() == typed => 1,
        _ if item.what.to_lowercase() == typed => 0,
        _ => 2,
    };
    let fits = |item: Found| Some(((place(&item), rank(&item, &words)?), item));
    let mut found: Vec<_> = all.filter_map(fits).collect();
    found.sort_by_key(|(key, _)| *key);
    found.into_iter().map(|(_, item)| item).collect()
}

/// Parses the words after `axes`, such as `clearance pulse`: the horizontal, then the vertical axis
/// of the map. `None` unless they name two different knobs.
fn both_axes(words: &str) -> Option<Found> {
    let words: Vec<&str> = words.split_whitespace().filter(|word| *word != "over").collect();
    let fits = |words: &[&str], knob| Some((fit(knob, words)?, knob));
    let knob = |words: &[&str]| {
        let best = numeric().filter_map(|knob| fits(words, knob)).min_by_key(|(fit, _)| *fit);
        best.map(|(_, knob)| knob)
    };
    let splits = (1..words.len()).filter_map(|at| words.split_at_checked(at));
    let (x, y) =
        splits.filter_map(|(x, y)| knob(x).zip(knob(y))).find(|(x, y)| x.path != y.path)?;
    let what = format!("map: {} across, {} up", x.label, y.label);
    Some(Found::of("go", what, Command::Axes([Some(x.path), Some(y.path)])))
}

/// Returns the numeric knobs that match the typed words, each as a command that puts it on an axis
/// of the map: on the horizontal one if `first` is `across`, otherwise on the vertical one.
fn one_axis(app: &App, first: &str, typed: &str) -> Vec<Found> {
    let (kind, is_across) = if first == "across" { ("across", true) } else { ("up", false) };
    let item = |knob: &'static Knob| {
        let paths = [Some(knob.path).filter(|_| is_across), Some(knob.path).filter(|_| !is_across)];
        let axis = Found::of(kind, knob.label, Command::Axes(paths));
        axis.beside(knob.text(&app.scene)).also(format!("{} {}", knob.path, plain(knob.label)))
    };
    ranked(numeric().map(item), typed)
}

/// Parses `t 0.3 ms`, or `0.3 ms` alone, as a simulated time to go to; `None` for any other text.
fn going_to(app: &App, typed: &str) -> Option<Found> {
    let named = typed.trim().strip_prefix(['t', 'T']);
    let text = named.map(|text| text.trim_start_matches(['=', ' ']));
    let text = text.or(Some(typed.trim()).filter(|text| text.ends_with('s')))?;
    let Value::Real(t) = knob_of(keys::END)?.parse(text).ok()? else { return None };
    let what = format!("t = {}", readable(t, "s"));
    Some(
        Found::of("go", what, Command::GoTo(t)).beside(format!("now {}", readable(app.now(), "s"))),
    )
}

/// How well typed words name a knob, with the number of words of the value: of two names that fit
/// equally well, the longer one counts. Then the entry that sets the knob, or why it refuses the
/// value.
type Assignment = ((Fit, usize), Result<Found, String>);

/// Returns the knobs that the first words name, set to the value that follows, the best match
/// first. A number alone, or with a unit of speed, sets the speed.
fn assignments(app: &App, typed: &str) -> Vec<Assignment> {
    let typed = typed.replacen('=', " ", 1);
    let words: Vec<&str> = typed.split_whitespace().collect();
    let nameless = words.concat();
    // A single digit is the key of a view.
    let is_speed = (nameless.len() > 1 && nameless.parse().is_ok_and(f64::is_finite))
        || ["rpm", "Hz", "rad/s"].iter().any(|unit| nameless.ends_with(unit));
    let mut found = Vec::new();
    for (place, knob) in KNOBS.iter().enumerate() {
        let set = |text: String| match app.parse(knob, &text) {
            Ok(value) => {
                let what = format!("{} = {}", knob.label, knob.shown(&value));
                let set = Found::of("set", what, Command::Set(place, text));
                Ok(set.beside(format!("now {}", knob.text(&app.scene))))
            }
            Err(why) => Err(knob.refusal(&why)),
        };
        let splits = (1..words.len()).map(|at| words.split_at(at));
        let named = splits.filter_map(|(name, value)| {
            Some(((fit(knob, name)?, value.len()), set(value.join(" "))))
        });
        let alone = (knob.path == keys::SPEED && is_speed).then(|| set(nameless.clone()));
        let alone = alone.filter(Result::is_ok).map(|set| ((Fit::Name, 0), set));
        found.extend(named.chain(alone).min_by_key(|(fit, set)| (set.is_err(), *fit)));
    }
    found.sort_by_key(|((fit, _), _)| *fit);
    found
}

/// Returns the scenes; without typed words the open one is selected first.
fn scenes(app: &App, typed: &str) -> impl Iterator<Item = Found> {
    let is_all = typed.is_empty();
    app.scene_entries().into_iter().map(move |scene| {
        let is_open = app.is_open_scene(&scene);
        let (what, beside, note) = match &scene.scene {
            Ok(read) => (format!("{}: {}", scene.name, read.title), "open", read.note.clone()),
            Err(why) => (scene.name.clone(), "cannot be read", why.clone()),
        };
        let beside = if is_open || scene.scene.is_err() { beside } else { "" };
        let found = Found::of("scene", what, Command::Scene(scene.name)).beside(beside);
        Found { note, first: is_open && is_all, ..found.also("open") }
    })
}

/// Returns the lessons; without typed words the first that is not done is selected first.
fn lessons(app: &App, typed: &str) -> impl Iterator<Item = Found> {
    let (done, is_all) = (&app.lessons.done, typed.is_empty());
    let open = lessons::all().iter().position(|lesson| done.next(lesson).is_some());
    lessons::all().iter().enumerate().map(move |(place, lesson)| {
        let (count, steps) = (done.count(lesson), lesson.steps.len());
        let state = if count == steps { "done".into() } else { format!("{count}/{steps}") };
        let beside = format!("{}, {} min, {state}", place + 1, lesson.minutes());
        // A step that was skipped comes before the last completed one.
        let note = match done.next(lesson).filter(|next| *next < count) {
            Some(step) => format!("Goes on at step {}.", step + 1),
            None => format!("Needs {}.", lesson.needs),
        };
        let also = format!("guide learn {}", lesson.name);
        let found = Found::of("lesson", lesson.title.as_str(), Command::Lesson(place));
        Found { note, first: is_all && open == Some(place), ..found.beside(beside).also(also) }
    })
}

fn everything(app: &App) -> impl Iterator<Item = Found> {
    let asked = table::of(Group::Question).filter(|_| app.is_asked());
    // Those that open or close the list itself make no sense in it.
    let makes_sense =
        |binding: &&Binding| !matches!(binding.command, Command::Palette("") | Command::Close);
    let bound = asked.chain(table::main()).filter(makes_sense).map(|binding| {
        let key = binding.keys.first().map(ToString::to_string).unwrap_or_default();
        let also = table::keys_text(binding);
        Found::of("", binding.what, binding.command.clone()).beside(key).also(also)
    });
    let knobs = KNOBS.iter().enumerate().map(|(place, knob)| {
        Found::of("knob", format!("{}: {}", knob.label, knob.does), Command::Select(place))
            .beside(knob.text(&app.scene))
            .also(format!("{} {}", knob.path, plain(knob.label)))
    });
    bound.chain(knobs).chain(scenes(app, "")).chain(lessons(app, ""))
}

/// Rates how well an entry matches all the words: lower is better, `None` if some word is missing.
fn rank(item: &Found, words: &[&str]) -> Option<usize> {
    let what = item.what.to_lowercase();
    let all = format!("{} {what} {}", item.kind, item.also.to_lowercase());
    let each = words.iter().map(|word| match () {
        () if what.starts_with(word) => Some(0),
        () if all.split(|c: char| !c.is_alphanumeric()).any(|part| part.starts_with(word)) => {
            Some(1)
        }
        () => all.contains(word).then_some(2),
    });
    each.sum()
}

#[cfg(test)]
mod tests;
