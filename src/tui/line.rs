//! How much the terminal is sent. On a thin line the frames of a playing motion come as often
//! as five kilobytes a second allow, more seldom in a larger window; what a key asks for may
//! take more for a moment.

use std::time::{Duration, Instant};

use strum::{EnumString, VariantNames};

/// Limit on the bytes that are sent to the terminal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumString, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum Line {
    /// Thin over SSH, or once a write had to wait.
    #[default]
    Auto,
    /// At most five kilobytes a second while the motion plays, in a window of any size.
    Thin,
    /// Every frame that was asked for.
    Full,
}

/// Bytes a second of frames while the motion plays.
const THIN: f64 = 4500.0;
/// Bytes a second of answers to keys, unless writes have to wait.
const KEYS: f64 = 20_000.0;
/// Time that answers to keys may run ahead of that.
const AHEAD: Duration = Duration::from_secs(1);
/// Longest wait of an answer to a key.
const SOON: Duration = Duration::from_millis(200);
/// Longest wait of an answer to a key on a line where writes have to wait.
const LATEST: Duration = Duration::from_secs(2);
/// Longest pause between two frames, whatever the last one took: 45 kB are most of a window of
/// 400 columns and 100 rows.
const LONGEST: Duration = Duration::from_secs(10);

/// The account of what the line has taken.
#[derive(Debug)]
pub struct Throttle {
    line: Line,
    /// Instant at which the line is free again.
    free: Instant,
    sent: u64,
    /// Whether writes have to wait.
    slow: bool,
}

impl Throttle {
    /// Creates an account that begins at `now`, with `sent` bytes sent already.
    pub fn new(line: Line, now: Instant, sent: u64) -> Self {
        Self { line, free: now, sent, slow: false }
    }

    /// Records that a frame has been sent; `sent` is the number of bytes in all.
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

    /// Returns how long the next frame must wait from `now`.
    pub fn wait(&self, by_key: bool, now: Instant) -> Duration {
        let wait = self.free.saturating_duration_since(now);
        // A key is answered soon, whatever was sent before.
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

    /// Bytes a second when every frame has `bytes` and is sent as soon as allowed.
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
        // The answer to a key does not wait for the frames before it.
        let now = Instant::now();
        let mut throttle = Throttle::new(Line::Thin, now, 0);
        (1..9).for_each(|k| throttle.spend(k * 25_000, false, false, now));
        assert!(throttle.wait(true, now) <= SOON);
        assert!(rate(Line::Full, 1000, false, true) > 60_000.0);
        assert!(rate(Line::Auto, 1000, false, false) > 60_000.0);
    }

    #[test]
    fn a_key_is_answered_at_once_even_after_a_large_frame() {
        let now = Instant::now();
        let mut throttle = Throttle::new(Line::Thin, now, 0);
        throttle.spend(4000, false, false, now);
        assert!(throttle.wait(false, now) > Duration::from_millis(800));
        assert_eq!(throttle.wait(true, now), Duration::ZERO);
    }
}
