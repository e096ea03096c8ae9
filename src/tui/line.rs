//! Limits the data sent to a slow terminal. On a thin line, frames of the playing motion are spaced
//! to stay below five kilobytes a second, so that larger windows have fewer frames; answers to keys
//! may exceed that briefly.

use std::time::{Duration, Instant};

use strum::{EnumString, VariantNames};

/// How much the connection to the terminal carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumString, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum Line {
    /// Full until a write has to wait for the terminal, then thin; over SSH thin from the start.
    #[default]
    Auto,
    /// At most five kilobytes a second while the motion plays.
    Thin,
    /// No limit.
    Full,
}

/// Rate on a thin line of frames that the motion causes, and of all frames if writes have to wait
/// \[bytes/s\].
const THIN: f64 = 4500.0;
/// Rate on a thin line of frames that answer keys, unless writes have to wait \[bytes/s\].
const KEYS: f64 = 20_000.0;
/// Frames that answer keys may be sent this much earlier than the rate allows.
const AHEAD: Duration = Duration::from_secs(1);
/// Longest delay of a frame that answers a key, unless writes have to wait.
const SOON: Duration = Duration::from_millis(200);
/// Longest delay of a frame that answers a key, if writes have to wait.
const LATEST: Duration = Duration::from_secs(2);
/// Longest delay caused by one frame. At the thin rate it corresponds to 45 kB, most of a window of
/// 400 columns and 100 rows.
const LONGEST: Duration = Duration::from_secs(10);

/// Rate limiter for frames.
#[derive(Debug)]
pub struct Throttle {
    line: Line,
    /// Time at which the line, at its limited rate, has carried the bytes sent so far.
    free: Instant,
    sent: u64,
    /// Whether any write had to wait for the terminal.
    slow: bool,
}

impl Throttle {
    /// Creates a limiter that starts at `now`, when `sent` bytes have been sent already.
    pub fn new(line: Line, now: Instant, sent: u64) -> Self {
        Self { line, free: now, sent, slow: false }
    }

    /// Records a frame drawn at `now`, `by_key` if it answers a key. `sent` is the number of bytes
    /// of all frames so far; `slow` says that a write had to wait.
    pub fn spend(&mut self, sent: u64, by_key: bool, slow: bool, now: Instant) {
        let bytes = sent.saturating_sub(self.sent) as f64;
        (self.sent, self.slow) = (sent, slow);
        if self.line == Line::Full || (self.line == Line::Auto && !slow) {
            self.free = now;
            return;
        }
        let rate = if by_key && !slow { KEYS } else { THIN };
        let spent = Duration::from_secs_f64(bytes / rate).min(LONGEST);
        self.free = self.free.max(now).min(now + LONGEST) + spent;
    }

    /// Returns how long after `now` the next frame may be drawn; `by_key` if it answers a key.
    pub fn wait(&self, by_key: bool, now: Instant) -> Duration {
        let wait = self.free.saturating_duration_since(now);
        // An answer to a key has a bounded delay, whatever was sent before.
        match (by_key, self.slow) {
            (true, false) => wait.saturating_sub(AHEAD).min(SOON),
            (true, true) => wait.saturating_sub(AHEAD).min(LATEST),
            (false, _) => wait,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the rate if every frame has `bytes` and is sent as soon as allowed \[bytes/s\].
    fn rate(line: Line, bytes: u64, by_key: bool, slow: bool) -> f64 {
        let begin = Instant::now();
        let (mut now, mut sent) = (begin, 0);
        let mut throttle = Throttle::new(line, now, 0);
        for _ in 0..400 {
            now += throttle.wait(by_key, now).max(Duration::from_millis(16));
            sent += bytes;
            throttle.spend(sent, by_key, slow, now);
        }
        sent as f64 / now.duration_since(begin).as_secs_f64()
    }

    #[test]
    fn a_thin_line_takes_five_kilobytes_a_second_at_any_size_of_frame() {
        for bytes in [200, 1000, 3000, 9000, 25_000, 45_000] {
            let thin = rate(Line::Thin, bytes, false, false);
            assert!(thin < 5000.0, "{bytes}: {thin}");
        }
        for bytes in [200, 1000, 3000, 9000] {
            let slow = rate(Line::Auto, bytes, true, true);
            assert!(slow < 5500.0, "{bytes}: {slow}");
        }
        assert!(rate(Line::Thin, 1000, false, false) > 4000.0);
        assert!(rate(Line::Thin, 2000, true, false) < 22_000.0);
        // Earlier frames do not delay the answer to a key.
        let now = Instant::now();
        let mut throttle = Throttle::new(Line::Thin, now, 0);
        (1..9).for_each(|k| throttle.spend(k * 25_000, false, false, now));
        assert!(throttle.wait(true, now) <= SOON);
        assert!(rate(Line::Full, 1000, false, true) > 60_000.0);
        assert!(rate(Line::Auto, 1000, false, false) > 60_000.0);
    }
}
