//! The next change of contact of a motion, found to round-off whatever the page
//! of time on the screen.

use crate::tui::trace::{Mark, Marks};
use rubscope_solver::motion::{GoOn, Motion};

/// Most steps of the search.
const MOST_STEPS: usize = 20_000;
/// Most halvings of the step in which the change is; doubles need no more.
const MOST_HALVINGS: usize = 80;

/// Returns when the contact changes next, looked for in steps of `step` \[s\]; none if no change
/// comes soon, or `go_on` says no.
pub fn next_change(motion: &Motion, step: f64, go_on: GoOn<'_>) -> Option<f64> {
    let log = motion.contacts();
    let before = (log.active_set, log.impact_count);
    let changed = |motion: &Motion| {
        let log = motion.contacts();
        (log.active_set, log.impact_count) != before
    };
    let mut at = motion.clone();
    let mut now = motion.t_s();
    for _ in 0..MOST_STEPS {
        if at.over() || at.final_verdict().is_some() {
            return None;
        }
        let mut ahead = at.clone();
        let mut until = now + step;
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

/// Returns what changed since `marks` began, seen from the motion after it.
pub fn met(mut marks: Marks, motion: &Motion) -> Option<Mark> {
    marks.look(motion.contacts());
    marks.seen.last().copied()
}
