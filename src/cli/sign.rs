//! The sign of life on standard error while a command works; of a run that takes long, how far
//! it is, and once what bounds it.

use std::io::{IsTerminal, Result, Write, stderr, stdout};
use std::sync::OnceLock;
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};

use super::status::say;
use crate::report::number::{grouped, rounded, short, time};
use rubscope_solver::motion::{Motion, Watch};
use rubscope_solver::scene::{CheckedScene, SolverKind};
use rubscope_solver::tolerances::{MOST_EVENTS, MOST_LOOKS};

/// A command that ends sooner shows nothing.
const SOON: Duration = Duration::from_millis(300);

/// Time between two steps of its animation.
const TICK: Duration = Duration::from_millis(100);

/// Template of the line until a command shows more.
const PLAIN: &str = "{spinner} {msg} {elapsed}";

/// Time between two lines where standard error is no terminal.
const APART: Duration = Duration::from_secs(10);

/// The line, once a command has begun; it is drawn on a terminal only.
static SIGN: OnceLock<ProgressBar> = OnceLock::new();

fn style(sign: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        sign.set_style(style.with_key("rate", rate));
    }
}

/// Writes the rate, and the time that is left by it, once there is one.
fn rate(state: &ProgressState, out: &mut dyn std::fmt::Write) {
    let rate = rounded(state.per_sec(), 2);
    if rate > 0.0 {
        // What is not written is not seen.
        let _ = write!(out, ", {}/s, {:#} left", short(rate), HumanDuration(state.eta()));
    }
}

/// Shows the sign of life from now on, as long as the command is at work: a line that moves on a
/// terminal, elsewhere a line from time to time.
pub fn begin() {
    let seen = stderr().is_terminal();
    let new = if seen { ProgressBar::new_spinner } else { ProgressBar::hidden };
    let sign = SIGN.get_or_init(|| new().with_message("at work"));
    style(sign, PLAIN);
    let begun = move || match seen {
        true => {
            thread::sleep(SOON);
            sign.enable_steady_tick(TICK);
        }
        false => loop {
            thread::sleep(APART);
            if sign.is_finished() {
                return;
            }
            say(&now(sign));
        },
    };
    // Without a thread the work is done all the same.
    let _ = thread::Builder::new().name("rubscope-sign".into()).spawn(begun);
}

/// Returns how far the work is.
fn now(sign: &ProgressBar) -> String {
    let part = sign.length().filter(|parts| *parts > 0);
    let part = part.map(|parts| format!(", {} %", 100 * sign.position() / parts));
    let elapsed = sign.elapsed().as_secs();
    format!("rubscope: {}{} after {elapsed} s", sign.message(), part.unwrap_or_default())
}

/// Shows what is being done now.
pub fn doing(what: impl Into<String>) {
    if let Some(sign) = SIGN.get() {
        sign.set_message(what.into());
    }
}

/// Shows how many parts the work has, in this form; each is counted by `inc`.
pub fn bar(parts: u64, template: &str) -> ProgressBar {
    let Some(sign) = SIGN.get() else { return ProgressBar::hidden() };
    style(sign, template);
    sign.set_length(parts);
    sign.set_position(0);
    sign.clone()
}

/// Prints while the line is away.
pub fn aside<T>(print: impl FnOnce() -> T) -> T {
    match SIGN.get() {
        Some(sign) => sign.suspend(print),
        None => print(),
    }
}

/// Ends the sign of life: the work is done.
pub fn end() {
    if let Some(sign) = SIGN.get() {
        sign.finish_and_clear();
    }
}

/// Standard output. What is written takes the place of the sign, also in a pipe: its
/// reader may draw on the same terminal.
pub struct Out;

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        end();
        stdout().write(bytes)
    }

    fn flush(&mut self) -> Result<()> {
        stdout().flush()
    }
}

/// Time between two moves of the bar.
const LOOK: Duration = Duration::from_millis(100);
/// Time that a run may take before its bound is printed.
const SILENCE: Duration = Duration::from_secs(2);
/// Length of the bar.
const PARTS: u64 = 1000;

/// The bar of one run.
pub(super) struct LongRun {
    bar: ProgressBar,
    end_s: f64,
    started: Instant,
    /// Wall time of the next look, from the start.
    next: Duration,
    bound: Option<String>,
}

impl LongRun {
    /// Creates the bar of a run that begins now, followed by `changed` more.
    pub(super) fn of(scene: &CheckedScene, changed: usize) -> Self {
        Self {
            bar: bar(PARTS, "{spinner} {bar:30} {msg} {elapsed}"),
            end_s: scene.solver.end_s,
            started: Instant::now(),
            next: LOOK,
            bound: Some(bound(scene, changed)),
        }
    }

    /// Returns whether a look is due after this much wall time.
    fn is_due(&self, elapsed: Duration) -> bool {
        elapsed >= self.next
    }

    /// Looks at it after this much wall time.
    fn look_after(&mut self, elapsed: Duration, motion: &Motion) {
        self.next = elapsed + LOOK;
        let (part, message) = progress(motion, self.end_s);
        self.bar.set_position((part * PARTS as f64) as u64);
        self.bar.set_message(message);
        if let Some(bound) = self.bound.take_if(|_| elapsed >= SILENCE) {
            say(&bound);
        }
    }
}

impl Watch for LongRun {
    fn goes_on(&self) -> bool {
        !self.is_due(self.started.elapsed())
    }

    fn look(&mut self, motion: &Motion) {
        self.look_after(self.started.elapsed(), motion);
    }
}

/// Returns how much of a run to `end_s` is done, by its time or by its bound, and in words.
fn progress(motion: &Motion, end_s: f64) -> (f64, String) {
    let now = motion.t_s();
    let (part, text) = (now / end_s, format!("{} of {}", time(now), time(end_s)));
    match motion.events() {
        Some(events) => {
            let bound = events as f64 / MOST_EVENTS as f64;
            (part.max(bound), format!("{text}, changes of contact: {}", grouped(events)))
        }
        None => (part, text),
    }
}

/// Returns what bounds a run, and what follows it.
fn bound(scene: &CheckedScene, changed: usize) -> String {
    let end = time(scene.solver.end_s);
    let most = match scene.solver.kind {
        SolverKind::Explicit => {
            let steps = scene.solver.end_s / scene.solver.step_s;
            format!("after {} steps", grouped(steps as u64))
        }
        SolverKind::Event => format!(
            "or after {} changes of contact or {} looks ahead",
            grouped(MOST_EVENTS),
            grouped(MOST_LOOKS)
        ),
    };
    let follow = match changed {
        0 => String::new(),
        some => format!("; {some} changed runs follow (--no-sensitivity leaves them out)"),
    };
    format!("rubscope: a long run: it ends at {end}, {most}{follow}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pipe_is_told_how_far_the_work_is() {
        let sign = ProgressBar::hidden().with_message("at work");
        assert_eq!(now(&sign), "rubscope: at work after 0 s");
        sign.set_length(1071);
        sign.inc(107);
        assert_eq!(now(&sign), "rubscope: at work, 9 % after 0 s");
    }

    #[test]
    fn the_sign_goes_before_the_first_byte_of_the_output_wherever_that_goes() {
        let sign = SIGN.get_or_init(ProgressBar::hidden);
        Out.write_all(b" ").unwrap();
        assert!(sign.is_finished());
    }
}

#[cfg(test)]
mod long_run_tests {
    use super::*;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_long_run_tells_its_bound_once() {
        let mut scene = Scene::builtin("undamped").unwrap().as_reference();
        scene.solver.end_s = 1e6;
        let scene = scene.checked().unwrap();
        let mut motion = Motion::new(&scene);
        motion.advance(0.1).unwrap();
        let mut run = LongRun::of(&scene, 3);
        run.look_after(SILENCE - LOOK, &motion);
        assert!(run.bound.is_some(), "not before it is long");
        run.look_after(SILENCE, &motion);
        assert_eq!(run.bound, None);
        let text = bound(&scene, 3);
        for words in ["ends at 1e6 s, or after 10,000,000 changes of contact", "3 changed runs"] {
            assert!(text.contains(words), "{text}");
        }
    }

    #[test]
    fn progress_is_that_of_the_nearer_bound() {
        let scene = Scene::builtin("undamped").unwrap().as_reference().checked().unwrap();
        let mut motion = Motion::new(&scene);
        motion.advance(0.1).unwrap();
        let events = motion.events().unwrap();
        let text = format!("100 ms of 200 ms, changes of contact: {events}");
        assert_eq!(progress(&motion, 0.2), (0.5, text));
        assert_eq!(progress(&motion, 1e9).0, events as f64 / 1e7);
    }

    #[test]
    fn a_look_that_is_due_stops_the_run_until_it_is_made() {
        let scene = Scene::base().as_reference().checked().unwrap();
        let motion = Motion::new(&scene);
        let mut run = LongRun::of(&scene, 0);
        let now = Duration::from_secs(1);
        assert!(run.is_due(now));
        run.look_after(now, &motion);
        assert!(!run.is_due(now) && run.is_due(now + LOOK));
    }

    #[test]
    fn a_run_by_steps_is_bounded_by_their_number() {
        let mut scene = Scene::base();
        (scene.solver.step_s, scene.solver.end_s) = (0.5_f64.powi(20), 0.5);
        let text = "rubscope: a long run: it ends at 500 ms, after 524,288 steps";
        assert_eq!(bound(&scene.checked().unwrap(), 0), text);
    }
}
