//! The changes of contact of a run.

use rubscope_solver::motion::{ActiveSet, ContactLog};

/// Largest number of contact changes that are kept.
const MOST_MARKS: usize = 2000;

/// A change of contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    /// A blade group, given by its side of the polygon, touched the casing and left it at once.
    Impact(u32),
    /// The set of sides in contact changed, from the first to the second.
    Contact(ActiveSet, ActiveSet),
    /// The last sides in contact, given here, separated.
    Release(ActiveSet),
}

/// A change of contact and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Simulated time of the change \[s\].
    pub t_s: f64,
    /// What changed.
    pub what: Happening,
}

/// Collects the contact changes of a motion whose log is read from time to time.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Changes found so far, in order of time, at most `MOST_MARKS`.
    pub seen: Vec<Mark>,
    active_set: ActiveSet,
    impacts: u64,
}

impl Marks {
    /// Starts collecting from the present state of the log.
    pub fn from(log: &ContactLog) -> Self {
        Self { seen: Vec::new(), active_set: log.active_set, impacts: log.impact_count }
    }

    /// Returns the marks up to `t` \[s\] of a motion that goes on from there with this log. Half of
    /// the room is left for those to come.
    pub fn up_to(&self, t: f64, log: &ContactLog) -> Self {
        let known = self.seen.partition_point(|mark| mark.t_s <= t);
        let seen = self.seen.iter().take(known).skip(known.saturating_sub(MOST_MARKS / 2));
        Self { seen: seen.copied().collect(), ..Self::from(log) }
    }

    /// Reads the new entries of the log. It contains the instants of the first thousand impacts; of
    /// several contacts since the last call, only the latest is found.
    pub fn look(&mut self, log: &ContactLog) {
        let known = usize::try_from(self.impacts).unwrap_or(usize::MAX);
        let mut new: Vec<Mark> = Vec::new();
        let changed = log.active_set != self.active_set;
        for impact in log.impacts.iter().skip(known) {
            // A lasting contact begins with an impact, which needs no mark of its own.
            let lasts = changed && impact.t_s == log.since && log.active_set.includes(impact.side);
            if !lasts {
                new.push(Mark { t_s: impact.t_s, what: Happening::Impact(impact.side) });
            }
        }
        if changed {
            let what = match log.active_set {
                ActiveSet::Nothing => Happening::Release(log.before),
                now => Happening::Contact(log.before, now),
            };
            new.push(Mark { t_s: log.since, what });
        }
        new.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        let room = MOST_MARKS.saturating_sub(self.seen.len());
        self.seen.extend(new.into_iter().take(room));
        (self.active_set, self.impacts) = (log.active_set, log.impact_count);
    }
}
