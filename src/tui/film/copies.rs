//! Copies of a motion, from which any instant of it is computed again.

use rubscope_solver::motion::{Script, Scripted};

/// Largest number of copies; beyond it, every second one is dropped.
const MOST: usize = 128;
/// Initial time between two copies, as a fraction of the length of the film's last part.
const PART: f64 = 1.0 / 64.0;

/// Copies of a motion at some times.
#[derive(Clone, Debug, Default)]
pub struct Copies {
    /// In order of time.
    kept: Vec<Scripted>,
    /// Smallest time between two copies \[s\].
    spacing: f64,
}

impl Copies {
    /// Adds a copy if the last one is at least the spacing earlier.
    pub fn follow(&mut self, at: &Scripted) {
        let last = self.kept.last().map_or(f64::NEG_INFINITY, |last| last.motion.t_s());
        if at.motion.t_s() - last >= self.spacing {
            self.push(at);
        }
    }

    /// Adds a copy after all others; one at an earlier time is not needed. If there are then too
    /// many, they are thinned out and the spacing is doubled.
    pub fn push(&mut self, at: &Scripted) {
        if self.kept.last().is_some_and(|last| last.motion.t_s() >= at.motion.t_s()) {
            return;
        }
        self.kept.push(at.clone());
        if self.kept.len() > MOST {
            self.spacing *= 2.0;
            self.kept = std::mem::take(&mut self.kept).into_iter().step_by(2).collect();
        }
    }

    /// Returns the last copy at or before `t` \[s\]; `None` if the first one is later.
    pub fn before(&self, t: f64) -> Option<&Scripted> {
        let after = self.kept.partition_point(|copy| copy.motion.t_s() <= t);
        self.kept.get(after.checked_sub(1)?)
    }

    /// Returns the copies that can go on with another script, which shares the first `common`
    /// changes, to a last part of `length` seconds.
    pub fn under(&self, script: &Script, common: usize, length: f64) -> Self {
        let kept = self.kept.iter().map_while(|copy| copy.under(script, common)).collect();
        Self { kept, spacing: length * PART }
    }

    /// Returns the last copy.
    pub fn last(&self) -> Option<&Scripted> {
        self.kept.last()
    }
}
