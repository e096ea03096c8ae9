//! The explorer without a screen, for screen readers, transcripts and scripts. Standard input has
//! one command per line, as typed after `:`; the answer is the two header lines and what changed.
//! The motion is paused and moves only by commands. The same commands give the same answers, except
//! for a run that takes longer than the explorer waits: how far it gets depends on the machine.

use std::io::{BufRead, Error, Read, Write};

use anyhow::Context as _;

use super::app::words::{self, Found};
use super::app::{App, InputMode, help, lesson};
use super::command::table::{BINDINGS, Group};
use super::command::{Command, Effect};
use super::engine::{Order, Pace};
use super::files::{FileResult, FoundScenes};
use super::knobs::KNOBS;
use super::options::ExploreOptions;
use super::raster::Marker;
use super::theme::Theme;
use super::views::id::ViewId;
use super::worker::{PLAY_TIME, Playback};
use super::{ability, config, panels};
use crate::sheet::line::clean;
use rubscope_solver::scene::{CheckedScene, Scene};

/// Longest command line that is read \[bytes\].
const LONGEST: u64 = 1000;
/// Upper bound on engine rounds per command (a go-to turns the page, which must be recomputed).
const ORDERS: usize = 8;
/// Width of the text of lessons and help \[columns\].
const WIDTH: u16 = 80;
/// Height of the virtual screen: tall enough that lesson text is never paged.
const ROWS: u16 = 1000;
/// Number of columns and rows of the screen when it is written as a picture.
const PICTURE: (u16, u16) = (120, 40);

/// Answer to `help`.
const USAGE: &str = "\
speed 450, pulse 20k, law unilateral: give a knob a value; its name alone says the value
t 0.3 ms, end, n, blade 7: go to an instant, the end, the next change of contact, a gap
scene rub, lesson friction: open; answer b answers its question, g goes on, G leaves
margins, survey, view 3: the rows of the tables, and the lock at this speed
undo, restart, live, fire, and every other action of the explorer by its words or key
save FILE, copy: the scene as a file, the command that repeats the run
help WORDS: what the help says about them; quit, or the end of input, ends";

/// The explorer with an engine that runs in the same thread.
struct Lines {
    app: App,
    engine: Option<Playback>,
    ordered: Option<Order>,
    /// View whose results the present command prints; `None` if it prints the changes instead.
    printed_view: Option<ViewId>,
}

/// The answer to a line.
enum Reply {
    /// The end.
    Quit,
    /// Why nothing was done.
    Refused(String),
    /// These lines.
    Told(Vec<String>),
    /// What the command changed or shows; a doubt about it comes first.
    Done(Option<String>),
}

/// Executes the commands of `input` until it ends or one of them quits. `prompt` says whether a
/// prompt is printed before each.
///
/// # Errors
/// The input cannot be read, or the output cannot be written.
pub fn lines(
    scene: CheckedScene,
    options: &ExploreOptions,
    input: &mut dyn BufRead,
    out: &mut dyn Write,
    prompt: bool,
) -> anyhow::Result<()> {
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let marker = options.marker(&config::Config::default(), ability::only_ascii(&variable));
    let mut lines = Lines::of(scene, marker);
    lines.app.files.source.clone_from(&options.source);
    lines.app.appearance.rpm |= options.rpm;
    lines.app.appearance.use_units();
    lines.settle();
    lines.tell(out)?;
    writeln!(out, "{}", lines.app.appearance.spell("help lists the commands"))?;
    loop {
        if prompt {
            write!(out, "> ")?;
        }
        out.flush()?;
        let Some(line) = read(input).context("cannot read standard input")? else { return Ok(()) };
        let goes_on = match line {
            Ok(line) if line.trim().is_empty() || line.trim_start().starts_with('#') => true,
            Ok(line) => lines.answer(line.trim(), out)?,
            Err(refused) => {
                writeln!(out, "refused: {refused}")?;
                true
            }
        };
        if !goes_on {
            return Ok(());
        }
    }
}

/// Reads a line; `None` at the end of the input, and the reason if a line is refused.
fn read(input: &mut dyn BufRead) -> Result<Option<Result<String, &'static str>>, Error> {
    let mut bytes = Vec::new();
    // Plus its newline.
    let most = LONGEST + 1;
    if input.take(most).read_until(b'\n', &mut bytes)? == 0 {
        return Ok(None);
    }
    if !bytes.ends_with(b"\n") && bytes.len() as u64 == most {
        input.skip_until(b'\n')?;
        return Ok(Some(Err("a line of more than 1000 bytes")));
    }
    Ok(Some(String::from_utf8(bytes).map_err(|_| "a line that is not UTF-8")))
}

impl Lines {
    fn of(scene: CheckedScene, marker: Marker) -> Self {
        let mut app = App::new(scene, Theme::Mono, marker);
        app.layout.size = (WIDTH, ROWS);
        app.play.playing = false;
        Self { app, engine: None, ordered: None, printed_view: None }
    }

    /// Runs the engine until it has computed everything that the explorer shows.
    fn settle(&mut self) {
        for _ in 0..ORDERS {
            // Charts are not drawn, so only the study that is printed is computed.
            let open = self.printed_view.into_iter().collect();
            let order = Order { playing: false, open, ..self.app.order() };
            if self.ordered.as_ref() == Some(&order) {
                return;
            }
            let engine = self.engine.get_or_insert_with(|| Playback::new(order.clone(), PLAY_TIME));
            engine.apply(&order);
            while engine.is_computing() {
                engine.compute();
            }
            let mut snapshot = engine.snapshot();
            snapshot.results.pace = Pace::default();
            self.app.apply_snapshot(snapshot);
            self.ordered = Some(order);
        }
    }

    /// Executes a line and prints the answer; returns false if the line quits.
    fn answer(&mut self, line: &str, out: &mut dyn Write) -> Result<bool, Error> {
        let (before, lesson) = (self.app.scene.clone(), self.app.lessons.progress.clone());
        let lines = match self.obey(line) {
            Reply::Quit => return Ok(false),
            Reply::Refused(why) => vec![format!("refused: {}", self.shown(&why))],
            Reply::Told(lines) => lines,
            Reply::Done(doubt) => {
                self.settle();
                self.app.check_lesson();
                self.tell(out)?;
                let mut lines: Vec<String> = doubt.iter().map(|doubt| self.done(doubt)).collect();
                if let Some(view) = self.printed_view {
                    self.app.status = None;
                    let rows = self.app.panel_of(view).text(&self.app);
                    lines.extend(rows.lines().map(|row| self.shown(row)));
                } else {
                    lines.extend(self.changed(&before));
                    if self.app.lessons.progress != lesson {
                        lines.extend(lesson::lesson_text(&self.app, WIDTH));
                    }
                }
                lines
            }
        };
        lines.iter().try_for_each(|line| writeln!(out, "{line}")).map(|()| true)
    }

    /// Executes a line.
    fn obey(&mut self, line: &str) -> Reply {
        let (first, rest) = line.split_once(' ').unwrap_or((line, ""));
        if first.starts_with("scene") {
            self.app.files.found = FoundScenes::of(&self.app.files.directory);
        }
        match (first, rest.trim()) {
            ("help" | "?", words) => return self.help(words),
            ("scene" | "scenes" | "lesson" | "lessons", "") => {
                return self.list(first.trim_end_matches('s'));
            }
            _ => {}
        }
        let Found { command, what, .. } = match words::only(&self.app, line) {
            Ok(found) => found,
            Err(refused) => return Reply::Refused(refused),
        };
        let (mut knob, mut doubt) = (None, None);
        self.printed_view = None;
        match &command {
            Command::Leave => return Reply::Quit,
            Command::View(view) => {
                self.printed_view = Some(*view).filter(|view| PRINTED.contains(view));
            }
            Command::Survey => self.printed_view = Some(ViewId::Margins),
            Command::Range { doubt: asked, .. } => {
                (self.printed_view, doubt) = (Some(ViewId::Margins), asked.clone());
            }
            Command::Select(place) => knob = KNOBS.get(*place),
            _ => {}
        }
        if self.printed_view.is_none() && needs_screen(&command) {
            return Reply::Refused(format!("only a screen shows this: {what}"));
        }
        // A reading cursor would not be visible.
        self.app.stop_reading();
        self.app.layout.size = PICTURE;
        let effect = self.app.update(command);
        self.app.layout.size = (WIDTH, ROWS);
        // The paused motion moves to the cursor at once.
        self.app.depart();
        self.app.play.playing = false;
        match effect {
            Err(refused) => return Reply::Refused(refused),
            Ok(Effect::Quit) => return Reply::Quit,
            // Nothing in it acts on a terminal; a shortened command would be another one.
            Ok(Effect::Copy(command)) => return Reply::Told(vec![command]),
            Ok(Effect::Write(job)) => {
                // An existing file is refused, because there is no dialogue to ask about it.
                let result = match job.run() {
                    FileResult::Exists => FileResult::Failed("it exists".into()),
                    result => result,
                };
                if !self.app.written(result) {
                    return Reply::Refused(self.app.status.take().unwrap_or_default());
                }
            }
            // Effects on the screen are ignored.
            Ok(_) => {}
        }
        if let Some(knob) = knob {
            let text = format!("{} is {}: {}", knob.label, knob.text(&self.app.scene), knob.does);
            return Reply::Told(vec![self.shown(&text)]);
        }
        match std::mem::replace(&mut self.app.dialogue.mode, InputMode::Main) {
            InputMode::Main => Reply::Done(doubt),
            InputMode::Palette(word @ ("scene " | "lesson "), _) => self.list(word.trim_end()),
            _ => Reply::Refused(format!("{what} needs a screen, or more words; help")),
        }
    }

    /// Lists every scene or every lesson that can be opened; `kind` is `scene` or `lesson`.
    fn list(&self, kind: &str) -> Reply {
        let found = words::found(&self.app, &format!("{kind} ")).into_iter();
        Reply::Told(found.map(|found| self.shown(&format!("{kind} {}", found.what))).collect())
    }

    /// Prints the two header lines of the screen.
    fn tell(&self, out: &mut dyn Write) -> Result<(), Error> {
        panels::head_text(&self.app).iter().try_for_each(|line| writeln!(out, "{}", clean(line)))
    }

    /// Returns a line with the knobs that changed since `before` and their old and new values, and
    /// a line with the text of the status line, as far as there are any.
    fn changed(&self, before: &Scene) -> Vec<String> {
        let differ = KNOBS.iter().filter(|knob| knob.get(before) != knob.get(&self.app.scene));
        let parts: Vec<String> = differ
            .map(|knob| {
                format!("{} {} -> {}", knob.label, knob.text(before), knob.text(&self.app.scene))
            })
            .collect();
        let changed = match (parts.is_empty(), &self.app.status) {
            (true, None) => Some("changed: nothing".into()),
            (true, Some(_)) => None,
            (false, _) => Some(format!("changed: {}", parts.join("; "))),
        };
        let changed = changed.map(|text| self.shown(&text));
        changed.into_iter().chain(self.app.status.iter().map(|said| self.done(said))).collect()
    }

    fn done(&self, said: &str) -> String {
        self.shown(&format!("done: {said}"))
    }

    fn help(&self, words: &str) -> Reply {
        if words.is_empty() {
            return Reply::Told(vec![USAGE.into()]);
        }
        match help::help_text(&self.app, WIDTH, words) {
            found if found.is_empty() => Reply::Refused(format!("no command matches: {words}")),
            found => Reply::Told(found),
        }
    }

    fn shown(&self, text: &str) -> String {
        self.app.appearance.spell(&clean(text))
    }
}

/// Views whose results can be printed as text.
const PRINTED: [ViewId; 2] = [ViewId::Locked, ViewId::Margins];

/// Returns whether a command has an effect on the screen only. The motion is paused, so most
/// commands of playback have none.
fn needs_screen(command: &Command) -> bool {
    use Command::{Axes, Fire, GoToEnd, Jump, Plain, Restart, SpeedUnit, Step, Theme};
    match command {
        Axes(_) | Theme(_) => true,
        Step | Restart | Fire | Jump | GoToEnd | Plain | SpeedUnit => false,
        other => BINDINGS.iter().find(|binding| binding.command == *other).is_some_and(|binding| {
            [Group::Time, Group::Views, Group::Look].contains(&binding.group)
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_a_file_that_a_terminal_would_obey_is_not_printed() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["\u{1b}]0;own\u{7}.toml", "m\ndone: forged.toml", "\u{202e}\u{9b}a.toml"] {
            std::fs::write(folder.path().join(name), Scene::base().to_toml()).unwrap();
        }
        let mut own = Lines::of(Scene::base().checked().unwrap(), Marker::Braille);
        own.app.files.directory = folder.path().to_path_buf();
        for line in ["scene", "scene own", "open own", "copy", "save a\u{7}B.toml", "save ok.toml"]
        {
            let mut out = Vec::new();
            own.answer(line, &mut out).unwrap();
            let text = String::from_utf8(out).unwrap();
            let shown = |c: char| c == '\n' || rubscope_solver::scene::keys::is_plain(c);
            assert!(text.chars().all(shown), "{line}: {text:?}");
            assert!(!text.lines().any(|line| line.starts_with("done: forged")), "{text}");
            let refused = line.starts_with("save a");
            assert_eq!(text.contains("refused: a file name may have"), refused, "{text}");
        }
        assert!(folder.path().join("ok.toml").exists());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4);
    }
}
