//! Verdict over the last part of a run, from its contacts and from the swing of the tips and the
//! motion of the casing that are recorded during the run (docs/theory.md, sections 9 and 10).

use super::verdict::Trend;
use super::{ActiveSet, ContactLog, LAST_PART, Plane, Verdict};
use crate::model::Machine;

/// Swing of the blade tips, as a part of the clearance, above which a slip is a whirl:
/// blades that move contact rather than follow it. Smaller: blades that friction shakes
/// count.
const WHIRL_SWING: f64 = 0.25;

/// Part of the clearance below which a wave on a lining is at rest.
const WAVE_AT_REST: f64 = 1e-3;

/// Part of the clearance below which a wave is only round-off.
const WAVE_ROUND_OFF: f64 = 1e-12;

/// A wave on a lining decays if its extrapolated trend falls below this part of its present size.
/// Larger: a wave that settles on a limit cycle from above counts as decaying.
const WAVE_DYING: f64 = 0.5;

/// After a recent change, when there is no trend yet, a wave decays if it is below this part of the
/// wave in the previous stretch; below 1 by the round-off of extremes.
const WAVE_FALLS_SOON: f64 = 1.0 - 1e-6;

/// Extremes over one stretch of time.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Largest swing of a tip, `|kappa| l_b |a|` \[m\].
    swing: f64,
    /// Minimum and maximum of both components of the casing wave in the blade frame, and of the tip
    /// displacement by the blade modes \[m\].
    ends: [(f64, f64); 4],
}

impl Default for Stretch {
    fn default() -> Self {
        Self { swing: 0.0, ends: [(f64::INFINITY, f64::NEG_INFINITY); 4] }
    }
}

impl Stretch {
    /// Returns the amplitude of the wave, half the size of the box that contains it \[m\].
    fn wave(&self) -> f64 {
        let [a, b, ..] = self.ends.map(half);
        a.hypot(b) + self.tips()
    }

    /// Returns the amplitude of the tip displacement by the blade modes \[m\].
    fn tips(&self) -> f64 {
        let [_, _, c, d] = self.ends.map(half);
        c.hypot(d)
    }

    /// Returns the distance of the centre of that box from zero \[m\].
    fn centre(&self) -> f64 {
        let [a, b, ..] = self.ends.map(|(low, high)| 0.5 * (low + high));
        a.hypot(b)
    }
}

fn half((low, high): (f64, f64)) -> f64 {
    if high > low { 0.5 * (high - low) } else { 0.0 }
}

/// Contact state over the last part of the run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lasting {
    /// Length of a stretch: half of the last part of the run \[s\].
    length: f64,
    since: f64,
    now: Stretch,
    before: Stretch,
    /// Trends of the tip swing, of the tip displacement by the modes, and of the wave amplitude.
    trends: [Trend; 3],
    /// Hash of the set of rows that touch, and the time since which it is constant \[s\].
    set: u64,
    set_since: f64,
    /// Time since which every row touches \[s\].
    all_since: Option<f64>,
}

impl Lasting {
    pub fn new(end: f64) -> Self {
        Self {
            length: 0.5 * LAST_PART * end,
            since: 0.0,
            now: Stretch::default(),
            before: Stretch::default(),
            trends: [Trend::over(end); 3],
            set: 0,
            set_since: 0.0,
            all_since: None,
        }
    }

    /// Records one observation: casing displacement in the blade frame, outward tip displacement by
    /// the modes, and tip swing \[m\].
    pub fn look(&mut self, t: f64, casing: Plane, tips: Plane, swing: f64) {
        if t > self.since + self.length {
            self.before = self.now;
            let seen = [self.before.swing, self.before.tips(), self.before.wave()];
            self.trends.iter_mut().zip(seen).for_each(|(trend, value)| trend.see(t, value));
            self.now = Stretch::default();
            self.since = t;
        }
        let values = [casing.re, casing.im, tips.re, tips.im];
        for ((low, high), value) in self.now.ends.iter_mut().zip(values) {
            *low = if value < *low { value } else { *low };
            *high = if value > *high { value } else { *high };
        }
        self.now.swing = self.now.swing.max(swing);
    }

    /// Records the rows that touch now, as the sum of their `mark`s, and whether all rows do. Returns
    /// the time since which they are the same \[s\].
    pub fn touch(&mut self, t: f64, set: u64, all: bool) -> f64 {
        if set != self.set {
            (self.set, self.set_since) = (set, t);
        }
        if all {
            self.all_since.get_or_insert(t);
        } else {
            self.all_since = None;
        }
        self.set_since
    }

    /// Returns the largest tip swing of the last two stretches \[m\].
    pub fn swing(&self) -> f64 {
        self.now.swing.max(self.before.swing)
    }

    /// Returns whether the casing moves by more than round-off, for a clearance of this size \[m\].
    fn moves(&self, size: f64) -> bool {
        self.largest_wave() > WAVE_ROUND_OFF * size
    }

    /// Returns the largest wave amplitude of the last two stretches \[m\].
    fn largest_wave(&self) -> f64 {
        self.now.wave().max(self.before.wave())
    }

    /// Returns whether every row has touched over the last two stretches.
    pub fn is_pressed(&self, now: f64) -> bool {
        self.all_since.is_some_and(|since| since <= now - 2.0 * self.length)
    }

    /// Restarts the trends after a change during the run, at `t` \[s\].
    pub fn change(&mut self, t: f64) {
        self.trends.iter_mut().for_each(|trend| trend.change(t));
    }

    /// Moves the end of the run \[s\], seen from the time `t` \[s\].
    pub fn set_end(&mut self, t: f64, end: f64) {
        self.length = 0.5 * LAST_PART * end;
        self.trends.iter_mut().for_each(|trend| trend.set_end(t, end));
    }

    /// Returns the verdict at time `now` over the last `window` seconds. Where the motion about rest
    /// on a lining is linear and known, that decides by `comes_to_rest`, whatever the wave did in so
    /// short a time.
    pub fn verdict(
        &self,
        machine: &Machine,
        log: &ContactLog,
        [now, window]: [f64; 2],
        comes_to_rest: impl FnOnce() -> Option<bool>,
    ) -> Verdict {
        let start = now - window;
        self.of_contacts(machine, log, [now, start], comes_to_rest)
            .unless_forced(machine, log, start)
    }

    /// As [`verdict`](Self::verdict), without a look at longer tips in contact.
    fn of_contacts(
        &self,
        machine: &Machine,
        log: &ContactLog,
        [now, start]: [f64; 2],
        comes_to_rest: impl FnOnce() -> Option<bool>,
    ) -> Verdict {
        let lasted = |since: Option<f64>| since.is_some_and(|t| t <= start);
        let (size, lining) = (machine.clearance().abs(), machine.lining.is_some());
        let swing = self.trends[0].falls_to(self.swing()).unwrap_or_else(|| self.swing());
        let whirls = swing > WHIRL_SWING * size;
        if !lasted(log.unbroken_since) {
            let touched = log.last_contact.is_some_and(|t| t >= start);
            return if touched { Verdict::Bounce } else { Verdict::Decay };
        }
        // A stretch that has hardly begun has seen no full swing.
        let young = now - self.since < 0.5 * self.length;
        let stretch = if young { self.before } else { self.now };
        // What the casing does by itself dies soon; the wave that both have is in the tips.
        let (trend, size_now, size_before) = match stretch.tips() > 0.0 {
            true => (self.trends[1], stretch.tips(), self.before.tips()),
            false => (self.trends[2], stretch.wave(), self.before.wave()),
        };
        let falls = match trend.falls_to(size_now) {
            Some(left) => left < WAVE_DYING * size_now,
            None => !trend.is_known() && !young && size_now < WAVE_FALLS_SOON * size_before,
        };
        let dies = stretch.wave() < WAVE_AT_REST * size || falls;
        let held = match log.active_set {
            ActiveSet::Corner(..) | ActiveSet::Many => true,
            ActiveSet::Side(_) => lining,
            ActiveSet::Nothing => false,
        };
        let still = !young && self.largest_wave() < WAVE_AT_REST * size;
        let lobes_rub = lining && machine.out_of_round() > size;
        if lobes_rub && still && self.now.wave() < self.before.wave() {
            // Lobes press on arcs at rest, too.
            return Verdict::Decay;
        }
        if lining && lasted(self.all_since) {
            let known = if self.moves(size) { comes_to_rest() } else { None };
            match (known.unwrap_or(dies), whirls) {
                // Longer tips drag the wave round with the rotor.
                (true, _)
                    if machine.has_unequal_tips() && stretch.centre() > WAVE_AT_REST * size =>
                {
                    Verdict::Forced
                }
                (true, _) => Verdict::Decay,
                (false, true) => Verdict::Whirl,
                (false, false) => Verdict::Slip,
            }
        } else if held && self.set_since.max(log.since) <= start {
            let pulled = log.last_tensile.is_some_and(|t| t >= start);
            if pulled { Verdict::Adhesive } else { Verdict::Locked }
        } else if whirls {
            Verdict::Whirl
        } else {
            Verdict::Slip
        }
    }
}

/// Odd constant without a pattern, so that its multiples are well mixed.
const MARK: u64 = 0x9e37_79b9_7f4a_7c15;

/// Returns the hash of a row index (the finisher of SplitMix64); the sum over a set identifies it.
pub(super) fn mark(row: usize) -> u64 {
    let mut x = (row as u64 + 1).wrapping_mul(MARK);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x ^ (x >> 27)
}

#[cfg(test)]
mod tests {
    use crate::motion::Solver;
    use crate::motion::explicit::Explicit;
    use crate::scene::{CheckedScene, Scene};

    type Turn = fn(&mut Explicit, &CheckedScene);

    #[test]
    fn trends_are_forgotten_where_someone_changes_the_motion() {
        let mut scene = Scene::base();
        let end = scene.solver.end_s;
        let mut motion = Explicit::new(&scene.clone().checked().unwrap());
        for part in (0..100).map(|n| f64::from(n) / 100.0) {
            let trends = motion.lasting.trends.iter_mut();
            trends.for_each(|trend| trend.see(part * end, (-part).exp()));
        }
        let known = |motion: &Explicit| motion.lasting.trends.map(|trend| trend.is_known());
        assert_eq!(known(&motion), [true; 3]);
        scene.casing.damping_ratio = 0.06;
        let other = scene.checked().unwrap();
        let turns: [Turn; 3] = [
            |motion, _| motion.fire(),
            |motion, _| motion.set_speed(400.0, 0.0),
            |motion, scene| motion.set_parameters(scene),
        ];
        for turn in turns {
            let mut turned = motion.clone();
            turn(&mut turned, &other);
            assert_eq!(known(&turned), [false; 3]);
        }
    }
}
