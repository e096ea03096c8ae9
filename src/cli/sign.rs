//! The progress line of a command: a spinner or a bar of indicatif on standard error. It is not
//! shown if standard error is not a terminal.

use std::io::{Result, Write, stdout};
use std::sync::OnceLock;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Time between two frames of the spinner.
const TICK: Duration = Duration::from_millis(100);

/// The progress line of this process; unset if the command never showed one.
static SIGN: OnceLock<ProgressBar> = OnceLock::new();

fn style(sign: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        sign.set_style(style);
    }
}

/// Shows a spinner until [`end`] is called or data is written to [`Out`].
pub fn begin() {
    let sign = SIGN.get_or_init(|| ProgressBar::new_spinner().with_message("at work"));
    style(sign, "{spinner} {msg} {elapsed}");
    sign.enable_steady_tick(TICK);
}

/// Shows what is being done now, if there is a progress line.
pub fn doing(what: impl Into<String>) {
    if let Some(sign) = SIGN.get() {
        sign.set_message(what.into());
    }
}

/// Turns the spinner into a bar of `parts` parts and returns it; `inc` counts the finished parts.
/// The bar is hidden if there is no progress line.
pub fn bar(parts: u64, template: &str) -> ProgressBar {
    let Some(sign) = SIGN.get() else { return ProgressBar::hidden() };
    style(sign, template);
    sign.set_length(parts);
    sign.set_position(0);
    sign.clone()
}

/// Runs `print` with the progress line removed from the terminal, and redraws the line after it.
pub fn aside<T>(print: impl FnOnce() -> T) -> T {
    match SIGN.get() {
        Some(sign) => sign.suspend(print),
        None => print(),
    }
}

/// Removes the progress line for good: the work is done.
pub fn end() {
    if let Some(sign) = SIGN.get() {
        sign.finish_and_clear();
    }
}

/// Standard output. Writing to it removes the progress line, also if it is a pipe, because the
/// reader of the pipe may draw on the same terminal.
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
