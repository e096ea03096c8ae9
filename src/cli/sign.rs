//! The sign of life of a command: one line on standard error that moves while the
//! command is at work, whatever it does. It is there from a moment after the start,
//! and gone before anything is printed. Where standard error is no terminal, there
//! is none.

use std::io::{IsTerminal, Result, Write, stderr, stdout};
use std::sync::OnceLock;
use std::thread;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A command that ends sooner shows nothing.
const SOON: Duration = Duration::from_millis(300);

/// How often it moves.
const TICK: Duration = Duration::from_millis(100);

/// What is shown until a command says more.
const PLAIN: &str = "{spinner} {msg} {elapsed}";

/// The line, once a command has begun on a terminal.
static SIGN: OnceLock<ProgressBar> = OnceLock::new();

fn style(sign: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        sign.set_style(style);
    }
}

/// Shows it from now on, as long as the command is at work.
pub fn begin() {
    if !stderr().is_terminal() {
        return;
    }
    let sign = SIGN.get_or_init(|| ProgressBar::new_spinner().with_message("at work"));
    style(sign, PLAIN);
    let begun = || {
        thread::sleep(SOON);
        sign.enable_steady_tick(TICK);
    };
    // Without a thread the work is done all the same.
    let _ = thread::Builder::new().name("rubscope-sign".into()).spawn(begun);
}

/// Says what is being done now.
pub fn doing(what: impl Into<String>) {
    if let Some(sign) = SIGN.get() {
        sign.set_message(what.into());
    }
}

/// Says how many parts the work has, in this form; each is counted by `inc`.
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

/// The work is done.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_goes_before_the_first_byte_of_the_output_wherever_that_goes() {
        let sign = SIGN.get_or_init(ProgressBar::hidden);
        Out.write_all(b" ").unwrap();
        assert!(sign.is_finished());
    }
}
