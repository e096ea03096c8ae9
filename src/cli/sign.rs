//! The progress of a command: a spinner or a bar of indicatif on standard error, and none
//! where standard error is not a terminal.

use std::io::{Result, Write, stdout};
use std::sync::OnceLock;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Time between two frames of the spinner.
const TICK: Duration = Duration::from_millis(100);

/// The line of the command at work.
static SIGN: OnceLock<ProgressBar> = OnceLock::new();

fn style(sign: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        sign.set_style(style);
    }
}

/// Shows the spinner until [`end`].
pub fn begin() {
    let sign = SIGN.get_or_init(|| ProgressBar::new_spinner().with_message("at work"));
    style(sign, "{spinner} {msg} {elapsed}");
    sign.enable_steady_tick(TICK);
}

/// Shows what is being done now.
pub fn doing(what: impl Into<String>) {
    if let Some(sign) = SIGN.get() {
        sign.set_message(what.into());
    }
}

/// Shows a bar of this many parts, each counted by `inc`.
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

/// Removes the line: the work is done.
pub fn end() {
    if let Some(sign) = SIGN.get() {
        sign.finish_and_clear();
    }
}

/// Standard output. Its first byte ends the progress, also in a pipe: the reader may draw
/// on the same terminal.
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
