//! The open lesson: its progress, going through its steps and answers, and the current step on the
//! screen.

use std::sync::Arc;

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::model::{App, InputMode, LessonProgress, Past, StepProgress};
use crate::sheet::number::with_speeds;
use crate::tui::command::Command;
use crate::tui::field::Field;
use crate::tui::knobs::{knob_of, place_of};
use crate::tui::lessons::{self, Condition, LETTERS, Lesson, LessonStep};
use crate::tui::text::{columns, print, shorten, wrap};
use crate::tui::theme::Role;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::SceneError;

impl LessonProgress {
    /// Returns the progress in the current step.
    pub fn now(&self) -> StepProgress {
        self.steps.get(self.step).copied().unwrap_or_default()
    }

    /// As [`Self::now`], to change it; `None` if there is no such step.
    pub fn now_mut(&mut self) -> Option<&mut StepProgress> {
        self.steps.get_mut(self.step)
    }
}

impl App {
    /// Returns the open lesson and its progress; `None` if none is open.
    pub fn current_lesson(&self) -> Option<(&'static Lesson, &LessonProgress)> {
        let progress = self.lessons.progress.as_ref()?;
        Some((lessons::all().get(progress.lesson)?, progress))
    }

    /// Returns the current step and its progress; `None` if no lesson is open.
    pub fn lesson_step(&self) -> Option<(&'static LessonStep, StepProgress)> {
        let (lesson, progress) = self.current_lesson()?;
        Some((lesson.steps.get(progress.step)?, progress.now()))
    }

    /// Returns whether the current step has an unanswered question.
    pub fn is_asked(&self) -> bool {
        let step = self.lesson_step();
        step.is_some_and(|(step, now)| step.question.is_some() && now.answer.is_none())
    }

    /// Marks the current step as done once its question is answered and its task's condition is
    /// met.
    pub fn check_lesson(&mut self) {
        let Some((step, now)) = self.lesson_step() else { return };
        let meets = || step.until.as_ref().is_none_or(|condition| self.meets(condition));
        if now.done || self.is_asked() || !meets() {
            return;
        }
        if let Some(progress) = &mut self.lessons.progress {
            progress.now_mut().into_iter().for_each(|now| now.done = true);
            if let Some(lesson) = lessons::all().get(progress.lesson) {
                self.lessons.done.add(lesson, progress.step);
            }
        }
    }

    /// Returns whether the state satisfies a task's condition.
    pub fn meets(&self, condition: &Condition) -> bool {
        let number = |path: &str| knob_of(path)?.number(&self.scene);
        match condition {
            Condition::Verdict(word) => {
                let now = self.full_run().map(|run| run.facts.verdict);
                now.is_some() && now == word.parse().ok()
            }
            Condition::Above(path, limit) => number(path).is_some_and(|x| x > *limit),
            Condition::Below(path, limit) => number(path).is_some_and(|x| x < *limit),
            Condition::Limit(name, least) => self.margins().is_some_and(|(live, old)| {
                let value = live.margins.limit(*name).and_then(|limit| limit.value);
                !old && value.is_some_and(|value| value > *least)
            }),
        }
    }

    /// Opens the list of lessons, or goes to the next step.
    pub fn guide(&mut self) {
        let Some((lesson, progress)) = self.current_lesson() else {
            return self.dialogue.open(InputMode::Palette("lesson ", Field::default()));
        };
        let (number, step) = (progress.lesson, progress.step);
        if self.is_asked() {
            self.status = Some("your answer first: press a, b or c".into());
        } else if step + 1 < lesson.steps.len() {
            self.begin_step(number, step + 1);
        } else {
            self.leave_lesson();
            self.status = Some("end of the lesson; your scene is back".into());
        }
    }

    /// Goes back one step.
    pub fn lesson_back(&mut self) {
        match self.lessons.progress.as_ref().map(|progress| (progress.lesson, progress.step)) {
            None => self.status = Some("no lesson is open".into()),
            Some((_, 0)) => self.status = Some("this is the first step".into()),
            Some((lesson, step)) => self.begin_step(lesson, step - 1),
        }
    }

    /// Starts a lesson at its first unfinished step, with the lesson's own scene.
    pub fn begin_lesson(&mut self, place: usize) {
        self.dialogue.close();
        if let Some(lesson) = lessons::all().get(place) {
            let step = self.lessons.done.next(lesson).unwrap_or(0);
            self.begin_step(place, step);
        }
    }

    /// Closes the lesson and restores the user's scene.
    pub fn leave_lesson(&mut self) {
        if let Some(own) = self.lessons.progress.as_ref().map(|progress| Arc::clone(&progress.own))
        {
            // Undo can reopen the lesson.
            self.knobs.remember(self.past());
            self.come_back(Past::clone(&own));
        }
    }

    /// Drops the lesson without restoring the scene; the modes it had changed are restored.
    pub fn end_lesson(&mut self) {
        if let Some(progress) = self.lessons.progress.take() {
            self.knobs.live = progress.own.live;
            self.play.tempo.slow_at_events = progress.own.tempo.slow_at_events;
            self.run.set_compare(progress.own.compare);
        }
    }

    /// Shows a step; an answer given before stays.
    fn begin_step(&mut self, place: usize, step: usize) {
        let Some(lesson) = lessons::all().get(place) else { return };
        let past = self.past();
        // A step starts playing even if the cursor had paused the run.
        self.play.playing |= self.reading.at_s.is_some();
        self.stop_reading();
        let begun = self.lessons.progress.clone().filter(|progress| progress.lesson == place);
        let begun = begun.unwrap_or_else(|| LessonProgress {
            lesson: place,
            step,
            steps: vec![StepProgress::default(); lesson.steps.len()],
            choice: 0,
            own: match &self.lessons.progress {
                Some(other) => Arc::clone(&other.own),
                None => Arc::new(past.clone()),
            },
        });
        self.lessons.progress = Some(LessonProgress { step, choice: 0, ..begun });
        self.show_step(past);
    }

    /// Selects the answer above or below, cyclically.
    pub fn choose_answer(&mut self, up: bool) {
        if let Some(progress) = &mut self.lessons.progress {
            let by = if up { LETTERS.len() - 1 } else { 1 };
            progress.choice = (progress.choice + by) % LETTERS.len();
        }
    }

    /// Records an answer and runs the scene that it is about.
    pub fn answer(&mut self, place: usize) {
        if !self.is_asked() {
            self.status = Some("no question is open".into());
            return;
        }
        let past = self.past();
        if let Some(now) = self.lessons.progress.as_mut().and_then(LessonProgress::now_mut) {
            now.answer = Some(place.min(LETTERS.len() - 1));
        }
        self.show_step(past);
    }

    /// Shows the current step by commands; one undo returns to `past`.
    fn show_step(&mut self, past: Past) {
        let Some((lesson, progress)) = self.current_lesson() else { return };
        match self.step_commands(lesson, progress.step) {
            Ok(commands) => {
                self.knobs.remember(past);
                let refused = commands.into_iter().find_map(|command| self.update(command).err());
                self.status = refused;
            }
            Err(error) => self.status = Some(error.to_string()),
        }
    }

    /// Returns the commands that show a step, before or after its question is answered.
    ///
    /// # Errors
    /// A value of the lesson is refused.
    fn step_commands(&self, lesson: &Lesson, place: usize) -> Result<Vec<Command>, SceneError> {
        let Some(step) = lesson.steps.get(place) else { return Ok(Vec::new()) };
        let answered = !self.is_asked();
        let view = |word: &Option<String>| ViewId::from_word(word.as_deref()?);
        let scene = Box::new(lesson.scene_at(place, answered)?);
        let mut commands = vec![Command::LessonScene(lesson.scene.clone(), scene)];
        commands.extend(step.knob.as_deref().and_then(place_of).map(Command::Select));
        commands.extend((self.knobs.live != step.live).then_some(Command::Live));
        commands.extend((!self.play.tempo.slow_at_events).then_some(Command::SlowAtEvents));
        commands.push(Command::Page(step.page_s));
        let then = view(&step.then_view).filter(|_| answered);
        commands.extend(then.or(view(&step.view)).map(Command::View));
        commands.push(Command::Compare(step.compare && answered));
        commands.push(Command::Behind(view(&step.then_view).filter(|_| !answered)));
        Ok(commands)
    }
}

/// Width from which the question stays above its answer.
const WIDE: usize = 110;

/// A line and its colour.
type StepLine = (String, Role);

/// Returns a text with its speeds in the unit of the screen.
fn told(app: &App, text: &str) -> String {
    app.appearance.spell(&with_speeds(text))
}

/// Returns the lines of the current step below its head, at most `room`. If there are more, the
/// first sentences are left out: the end of the step, its answers or its task, must be visible.
fn lines(app: &App, width: usize, room: usize) -> Vec<StepLine> {
    let mut texts = texts(app, width);
    loop {
        let wrapped = |(text, role): &StepLine| {
            let role = *role;
            wrap(text, width).into_iter().map(move |line| (line, role))
        };
        let mut lines: Vec<StepLine> = texts.iter().flat_map(wrapped).collect();
        let Some((first, _)) = texts.first_mut().filter(|_| lines.len() > room) else {
            return lines;
        };
        match first.find(". ") {
            Some(end) => *first = first.split_off(end + 2),
            None if texts.len() > 1 => drop(texts.remove(0)),
            None => return lines.split_off(lines.len() - room),
        }
    }
}

/// Returns the texts of the current step below its head, each before it is wrapped.
fn texts(app: &App, width: usize) -> Vec<StepLine> {
    let Some((step, now)) = app.lesson_step() else { return Vec::new() };
    let of = |text: &str, role: Role| (told(app, text), role);
    let mut texts = Vec::new();
    match (&step.question, now.answer) {
        (Some(question), None) => {
            texts.push(of(&step.text, Role::Text));
            texts.push(of(question, Role::Focus));
            let chosen = app.lessons.progress.as_ref().map_or(0, |progress| progress.choice);
            let named = LETTERS.iter().zip(&step.answers).enumerate();
            let named = named.map(|(place, (letter, text))| {
                format!("{}[{letter}] {text}", if place == chosen { '▸' } else { ' ' })
            });
            let named: Vec<String> = named.map(|text| told(app, &text)).collect();
            let one = named.join("  ");
            // The answers share a line if they fit.
            match columns(&one) <= width {
                true => texts.push((one, Role::Focus)),
                false => texts.extend(named.into_iter().map(|line| (line, Role::Focus))),
            }
            return texts;
        }
        (Some(question), Some(answer)) => {
            if width >= WIDE {
                texts.push(of(question, Role::Quiet));
            }
            texts.push(of(&judged(step, answer), Role::Good));
            texts.extend(step.reason.iter().map(|reason| of(reason, Role::Text)));
        }
        (None, _) => texts.push(of(&step.text, Role::Text)),
    }
    texts.extend(step.equation.iter().map(|equation| of(equation, Role::First)));
    texts.extend(step.task.iter().map(|task| match now.done {
        true => of(&format!("[x] {task}"), Role::Good),
        false => of(&format!("[ ] {task}"), Role::Focus),
    }));
    texts
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
        (true, _) => "a b c answer",
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
pub fn step_rows(app: &App, width: usize) -> u16 {
    u16::try_from(lines(app, width, usize::MAX).len() + 2).unwrap_or(u16::MAX)
}

/// Returns the current step as text, in lines of `width` columns; empty if no lesson is open.
pub fn lesson_text(app: &App, width: u16) -> Vec<String> {
    let (left, right) = head(app, usize::from(width));
    let head = [left, right].join("   ");
    let lines = lines(app, usize::from(width), usize::MAX).into_iter().map(|(line, _)| line);
    let is_open = app.lessons.progress.is_some();
    std::iter::once(head).chain(lines).filter(|_| is_open).collect()
}

pub fn draw_step(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let width = usize::from(area.width);
    let (left, right) = head(app, width);
    let bold = look.style(Role::Focus).add_modifier(Modifier::BOLD);
    print(buffer, area, 0, &left, bold);
    let start = u16::try_from(width.saturating_sub(columns(&right))).unwrap_or(0);
    let beside = Rect { x: area.x + start, width: area.width - start, ..area };
    print(buffer, beside, 0, &right, look.style(Role::Good));
    let room = usize::from(area.height.saturating_sub(2));
    for (row, (text, role)) in (1..area.height).zip(&lines(app, width, room)) {
        print(buffer, area, row, text, look.style(*role));
    }
    let last = area.height.saturating_sub(1);
    let rule = look.either("─", "-").repeat(width);
    print(buffer, area, last, &rule, look.style(Role::Quiet));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;
    use crate::tui::command::Command;

    #[test]
    fn a_step_that_is_too_long_begins_at_the_start_of_a_sentence() {
        let mut app = on_screen();
        for place in 0..lessons::all().len() {
            app.begin_lesson(place);
            let whole = texts(&app, 40).into_iter().map(|(text, _)| text);
            let whole = whole.collect::<Vec<_>>().join(". ");
            let (all, cut) = (lines(&app, 40, usize::MAX), lines(&app, 40, 5));
            assert!(cut.len() <= 5 && all.ends_with(&cut[cut.len() - 1..]), "{cut:?}");
            let (before, _) = whole.split_once(&cut[0].0).unwrap();
            assert!(before.is_empty() || before.ends_with(". "), "{cut:?}");
        }
    }

    #[test]
    fn arrows_choose_an_answer_and_enter_gives_it() {
        let mut app = on_screen();
        app.begin_lesson(1);
        let knob = app.selected().map(|knob| knob.path);
        for command in [Command::Below, Command::Above, Command::Below, Command::Accept] {
            app.act(command);
        }
        assert_eq!(app.lesson_step().unwrap().1.answer, Some(1));
        assert_eq!(app.selected().map(|knob| knob.path), knob);
    }
}
