//! Finds the next change of contact of a motion to round-off, independent of the zoom of the page.

use super::page::longest_sample;
use rubscope_solver::motion::{GoOn, Scripted};

/// Largest number of search steps.
const MOST_STEPS: usize = 20_000;
/// Largest number of bisections of the step that has the change; doubles need no more.
const MOST_HALVINGS: usize = 80;

/// Returns the time of the next change of contact up to `end` \[s\], searched in steps that follow
/// the wave and refined by bisection. `None` if no change comes within the search, the motion ends
/// or fails before it, its verdict is already proved, or `go_on` stops the search.
pub fn next_change(from: &Scripted, end: f64, go_on: GoOn<'_>) -> Option<f64> {
    let log = from.motion.contacts();
    let before = (log.active_set, log.impact_count);
    let changed = |at: &Scripted| {
        let log = at.motion.contacts();
        (log.active_set, log.impact_count) != before
    };
    let mut at = from.clone();
    let (mut now, step) = (at.motion.t_s(), longest_sample(&at.motion));
    for _ in 0..MOST_STEPS {
        let decided = at.motion.over() || at.motion.final_verdict().is_some();
        if now >= end || (decided && at.is_through()) {
            return None;
        }
        let mut ahead = at.clone();
        let mut until = (now + step).min(end);
        if ahead.advance_while(until, go_on) != Ok(true) {
            return None;
        }
        if !changed(&ahead) {
            (at, now) = (ahead, until);
            continue;
        }
        for _ in 0..MOST_HALVINGS {
            let middle = 0.5 * (now + until);
            if middle <= now || middle >= until {
                break;
            }
            let mut half = at.clone();
            if half.advance_while(middle, go_on) != Ok(true) {
                return None;
            }
            if changed(&half) { until = middle } else { (at, now) = (half, middle) }
        }
        return Some(until);
    }
    None
}
