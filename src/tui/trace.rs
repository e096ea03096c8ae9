//! A run ahead of the playback: its coordinates at equal intervals, and the
//! changes of contact on the way.

use rubscope_solver::motion::{ActiveSet, ContactLog};

/// Most changes of contact kept.
const MOST_MARKS: usize = 2000;

/// `u_c`, `u_s` \[m\], `alpha_c`, `alpha_s` \[rad\] at equal intervals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// The first instant \[s\].
    pub from: f64,
    /// Time between two points \[s\].
    pub step: f64,
    /// The points.
    pub points: Vec<[f64; 4]>,
}

impl Trace {
    /// Returns the part of one coordinate that overlaps `[from, to]`, as points over time.
    pub fn between(
        &self,
        place: usize,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = (f64, f64)> + '_ {
        let index = |t: f64| ((t - self.from) / self.step).floor().max(0.0) as usize;
        let sound = self.step > 0.0 && to > from;
        let range = if sound { index(from)..index(to).saturating_add(2) } else { 0..0 };
        let points = self.points.iter().enumerate().take(range.end).skip(range.start);
        points.filter_map(move |(k, point)| {
            Some((self.from + k as f64 * self.step, *point.get(place)?))
        })
    }
}

/// Change of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    /// A blade group met the casing and left it at once.
    Impact(u32),
    /// Other sides touch: those before, and now.
    Contact(ActiveSet, ActiveSet),
    /// Separation of these sides, after which nothing touches.
    Release(ActiveSet),
}

/// A change of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Instant \[s\].
    pub t_s: f64,
    /// Content of the file.
    pub what: Happening,
}

/// Collects the changes of contact of a motion that is looked at now and then.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Changes seen so far.
    pub seen: Vec<Mark>,
    active_set: ActiveSet,
    impacts: u64,
}

impl Marks {
    /// Creates a record of changes of contact from here on.
    pub fn from(log: &ContactLog) -> Self {
        Self { seen: Vec::new(), active_set: log.active_set, impacts: log.impact_count }
    }

    /// Looks at the record. The first thousand impacts have their own instants;
    /// of contacts that came and went since the last look, the last is seen.
    pub fn look(&mut self, log: &ContactLog) {
        let known = usize::try_from(self.impacts).unwrap_or(usize::MAX);
        let mut new: Vec<Mark> = Vec::new();
        let changed = log.active_set != self.active_set;
        for impact in log.impacts.iter().skip(known) {
            // A contact that lasts begins with an impact: one mark is enough.
            let lasts = changed && impact.t_s == log.since && log.active_set.includes(impact.side);
            if !lasts {
                new.push(Mark { t_s: impact.t_s, what: Happening::Impact(impact.side) });
            }
        }
        if changed {
            let what = match log.active_set {
                ActiveSet::Nothing => Happening::Release(self.active_set),
                now => Happening::Contact(self.active_set, now),
            };
            new.push(Mark { t_s: log.since, what });
        }
        new.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
        let room = MOST_MARKS.saturating_sub(self.seen.len());
        self.seen.extend(new.into_iter().take(room));
        (self.active_set, self.impacts) = (log.active_set, log.impact_count);
    }
}
