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
use crate::tui::knobs::{Fit, KNOBS, Knob, best, called, fit, knob_of, plain};
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
    /// Other words that match the entry.
    also: String,
}

impl Found {
    fn of(kind: &'static str, what: impl Into<String>, command: Command) -> Self {
        Self { kind, what: what.into(), beside: String::new(), command, also: String::new() }
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
        return found;
    }
    let mut all: Vec<Found> = going_to(app, typed).into_iter().collect();
    all.extend(assignments(app, typed).into_iter().map(|(_, item)| item));
    let typed = typed.to_lowercase();
    let words: Vec<&str> = typed.split_whitespace().collect();
    let fits = |item: Found| rank(&item, &words).map(|rank| (rank, item));
    let mut others: Vec<_> = everything(app).filter_map(fits).collect();
    // An exact name comes first; entries of equal rank keep the order of the list.
    let place = |item: &Found| match &item.command {
        Command::Scene(name) if name == typed.trim() => 0,
        Command::View(view) if view.word() == typed.trim() => 1,
        _ if item.what.to_lowercase() == typed.trim() => 0,
        _ => 2,
    };
    others.sort_by_key(|(rank, item)| (place(item), *rank));
    all.extend(others.into_iter().map(|(_, item)| item));
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
    let lower = typed.to_lowercase();
    let words: Vec<&str> = lower.split_whitespace().collect();
    let refusal = refused(app, typed);
    let first = found(app, typed).into_iter().next();
    match (first, refusal) {
        (Some(Found { command: Command::Set(..), .. }), _) => alone(app, typed),
        // If a knob was named but refuses the value, that error is better than an entry that
        // selects the knob or contains the same words by chance.
        (Some(Found { command: Command::Select(_), .. }), Some((_, why))) => Err(why),
        (Some(item), Some((fit, why)))
            if fit < Fit::Begins
                && ["", "knob", "scene", "lesson"].contains(&item.kind)
                && !is_own(&item, &words) =>
        {
            Err(why)
        }
        (Some(item), _) => Ok(item),
        (None, Some((_, why))) => Err(why),
        (None, None) if is_numeric(typed) => {
            Err(format!("{typed}: which knob? Write for example speed 450 rad/s"))
        }
        (None, None) => Err(format!("no command matches: {typed}; help lists the commands")),
    }
}

/// Returns whether the description of an entry contains each of `words` as a whole word. They must
/// be in lower case.
fn is_own(item: &Found, words: &[&str]) -> bool {
    let what = item.what.to_lowercase();
    words.iter().all(|word| what.split_whitespace().any(|own| own == *word))
}

/// Returns the knob setting that the words name; an error if several knobs match equally well.
fn alone(app: &App, typed: &str) -> Result<Found, String> {
    let fitting = assignments(app, typed);
    let best = fitting.first().map(|(fit, _)| *fit);
    let mut alike: Vec<Found> =
        fitting.into_iter().filter(|(fit, _)| Some(*fit) == best).map(|(_, item)| item).collect();
    let labels = alike.iter().filter_map(|item| match item.command {
        Command::Set(place, _) => Some(KNOBS.get(place)?.label),
        _ => None,
    });
    let mut named: Vec<&str> = labels.take(CANDIDATES).collect();
    if alike.len() > CANDIDATES {
        named.push("others");
    }
    let which = format!("{typed}: which of {}?", named.join(", "));
    alike.pop().filter(|_| alike.is_empty()).ok_or(which)
}

/// Largest number of candidates listed for an ambiguous name.
const CANDIDATES: usize = 4;

/// Returns how well a name matches, and why the named knob or target refuses the value after it;
/// `None` if nothing is named or the value is accepted.
fn refused(app: &App, typed: &str) -> Option<(Fit, String)> {
    let words: Vec<&str> = typed.split([' ', '=']).filter(|word| !word.is_empty()).collect();
    match words.as_slice() {
        ["t" | "T", time @ ..] if !time.is_empty() => {
            let why = format!("t {}: not a time; write for example 0.3 ms", time.join(" "));
            return Some((Fit::Name, why));
        }
        ["range", rest @ ..] if !rest.is_empty() => {
            return surveyed(app, &rest.join(" ")).err().map(|why| (Fit::Name, why.to_string()));
        }
        ["blade", rest @ ..] if rest.first().is_some_and(|word| is_numeric(word)) => {
            let (blade, all) = (rest.join(" "), app.machine.polygon.blades);
            return Some((Fit::Name, format!("blade {blade}: from 1 to {all}")));
        }
        _ => {}
    }
    let splits = (1..words.len()).rev().filter_map(|at| words.split_at_checked(at));
    let named = splits.filter_map(|(name, value)| {
        let (fit, knob) = best(KNOBS.iter(), name)?;
        app.parse(knob, &value.join(" ")).err().map(|error| (fit, knob.refusal(&error)))
    });
    named.min_by_key(|(fit, _)| *fit)
}

/// Returns whether a word looks like a number.
fn is_numeric(word: &str) -> bool {
    word.starts_with(|first: char| first.is_ascii_digit() || first == '-')
}

/// Returns the entries that an introductory word such as `blade` or `scene` leads to; `None` if the
/// text begins with no such word.
fn directed(app: &App, typed: &str) -> Option<Vec<Found>> {
    let typed = typed.trim_start();
    let (first, rest) = typed.split_once(char::is_whitespace)?;
    let rest = rest.trim();
    let lower = rest.to_lowercase();
    let first = first.to_lowercase();
    Some(match first.as_str() {
        "blade" => {
            let all = app.machine.polygon.blades;
            let blade = |blade: u32| {
                Found::of("go", format!("blade {blade}"), Command::Blade(blade))
                    .beside(format!("of {all}"))
            };
            match rest.parse() {
                Ok(number) => vec![blade(number)],
                Err(_) if is_numeric(rest) => Vec::new(),
                // "blade" also begins the name of knobs.
                Err(_) => return None,
            }
        }
        "axes" => match both_axes(&lower) {
            Some(both) => vec![both],
            None => one_axis(app, "across", &lower),
        },
        "across" | "up" => one_axis(app, &first, &lower),
        "range" => surveyed(app, rest).into_iter().collect(),
        "scene" => those_with(scenes(app), &lower),
        "lesson" => match lower.parse::<usize>() {
            Ok(number) => lessons().nth(number.checked_sub(1)?).into_iter().collect(),
            Err(_) => those_with(lessons(), &lower),
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
    })
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

/// Returns those of the entries that match all of `words`, the best first.
fn those_with(all: impl Iterator<Item = Found>, words: &str) -> Vec<Found> {
    let words: Vec<&str> = words.split_whitespace().collect();
    let is_exact = |item: &Found| item.what.split(':').next() != words.first().copied();
    let mut found: Vec<_> = all
        .filter_map(|item| rank(&item, &words).map(|rank| (is_exact(&item), rank, item)))
        .collect();
    found.sort_by_key(|(other, rank, _)| (*other, *rank));
    found.into_iter().map(|(.., item)| item).collect()
}

/// Parses the words after `axes`, such as `clearance pulse`: the horizontal, then the vertical axis
/// of the map. `None` unless they name two different knobs.
fn both_axes(words: &str) -> Option<Found> {
    let words: Vec<&str> = words.split_whitespace().filter(|word| *word != "over").collect();
    let knob = |words: &[&str]| best(numeric(), words).map(|(_, knob)| knob);
    let splits = (1..words.len()).filter_map(|at| words.split_at_checked(at));
    let (x, y) =
        splits.filter_map(|(x, y)| knob(x).zip(knob(y))).find(|(x, y)| x.path != y.path)?;
    let what = format!("map: {} across, {} up", x.label, y.label);
    Some(Found::of("go", what, Command::Axes([Some(x.path), Some(y.path)])))
}

/// Returns the numeric knobs that match the words, each as a command that puts it on an axis of the
/// map: on the horizontal one if `first` is `across`, otherwise on the vertical one.
fn one_axis(app: &App, first: &str, words: &str) -> Vec<Found> {
    let words: Vec<&str> = words.split_whitespace().collect();
    let across = first == "across";
    let item = |knob: &'static Knob| {
        let paths = [Some(knob.path).filter(|_| across), Some(knob.path).filter(|_| !across)];
        let kind = if across { "across" } else { "up" };
        Found::of(kind, knob.label, Command::Axes(paths)).beside(knob.text(&app.scene))
    };
    let mut fitting: Vec<_> =
        numeric().filter_map(|knob| Some((fit(knob, &words)?, knob))).collect();
    fitting.sort_by_key(|(fit, _)| *fit);
    fitting.into_iter().map(|(_, knob)| item(knob)).collect()
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

/// Returns the knobs that the first words name, set to the value that follows, the best match
/// first. A number alone, or with a unit of speed, sets the speed.
fn assignments(app: &App, typed: &str) -> Vec<(Fit, Found)> {
    let typed = typed.replacen('=', " ", 1);
    let words: Vec<&str> = typed.split_whitespace().collect();
    let nameless = words.concat();
    let mut found = Vec::new();
    for (place, knob) in KNOBS.iter().enumerate() {
        let splits = (1..words.len()).rev().filter_map(|at| words.split_at_checked(at));
        let named = splits.filter_map(|(name, value)| Some((fit(knob, name)?, value.join(" "))));
        // A single digit is the key of a view.
        let is_number = nameless.len() > 1 && nameless.parse().is_ok_and(f64::is_finite);
        let alone = knob.path == keys::SPEED
            && (is_number || ["rpm", "Hz", "rad/s"].iter().any(|unit| nameless.ends_with(unit)));
        let alone = alone.then(|| (Fit::Name, nameless.clone()));
        let values = named.chain(alone);
        let values =
            values.filter_map(|(fit, text)| Some((fit, app.parse(knob, &text).ok()?, text)));
        if let Some((fit, value, text)) = values.min_by_key(|(fit, ..)| *fit) {
            let what = format!("{} = {}", knob.label, knob.shown(&value));
            let set = Found::of("set", what, Command::Set(place, text));
            found.push((fit, set.beside(format!("now {}", knob.text(&app.scene)))));
        }
    }
    found.sort_by_key(|(fit, _)| *fit);
    found
}

fn scenes(app: &App) -> impl Iterator<Item = Found> {
    app.scene_entries().into_iter().map(|scene| {
        let what = match &scene.scene {
            Ok(read) => format!("{}: {}", scene.name, read.title),
            Err(_) => scene.name.clone(),
        };
        Found::of("scene", what, Command::Scene(scene.name)).also("open")
    })
}

fn lessons() -> impl Iterator<Item = Found> {
    lessons::all().iter().enumerate().map(|(place, lesson)| {
        let also = format!("guide learn {}", lesson.name);
        Found::of("lesson", lesson.title.as_str(), Command::Lesson(place)).also(also)
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
    bound.chain(knobs).chain(scenes(app)).chain(lessons())
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
