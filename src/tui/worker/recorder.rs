//! Samples of a motion as bins of least and greatest values, and contact
//! forces as means between snapshots.

use crate::tui::history::{Bin, CHANNELS, MOST_BINS, thin};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{ActiveSet, ContactLog, Motion, State};

/// Returns `z = (u_c + i u_s) exp(-i n_d theta)` \[m\], with `turned = n_d theta`.
pub fn in_blade_frame(u: [f64; 2], turned: f64) -> [f64; 2] {
    let (sin, cos) = turned.sin_cos();
    [u[0] * cos + u[1] * sin, u[1] * cos - u[0] * sin]
}

/// Returns the casing as the tips of the blades see it, `w = z - kappa l_b a` \[m\]: the point in
/// the polygon, with `turned = n_d theta`. It is `z` where tips do not move outward, and where the
/// disk has other diameters, so that no one point stands for all blades.
pub fn rim_point(machine: &Machine, state: &State, turned: f64) -> [f64; 2] {
    let z = in_blade_frame(state.u, turned);
    let outward = machine.radial_coupling * machine.blade_length;
    if outward == 0.0 || machine.blade_diameters != machine.nodal_diameters {
        return z;
    }
    let [a_c, a_s] = state.alpha;
    [z[0] - outward * a_c, z[1] - outward * a_s]
}

/// Records one motion.
#[derive(Debug, Default)]
pub struct Recorder {
    done: Vec<Bin>,
    open: Option<Bin>,
    impacts: u64,
    active_set: ActiveSet,
    last: Option<f64>,
    sums: Vec<(u32, f64)>,
    over: f64,
    means: Vec<(u32, f64)>,
}

impl Recorder {
    /// Creates a record that begins where the motion is.
    pub fn from(motion: &Motion) -> Self {
        let log = motion.contacts();
        Self { impacts: log.impact_count, active_set: log.active_set, ..Self::default() }
    }

    /// Records the motion as it is now, in this state; bins are closed after
    /// `length` seconds.
    pub fn record(&mut self, motion: &mut Motion, state: &State, length: f64) {
        let forces = motion.take_mean_forces();
        let push: f64 = forces.iter().map(|(_, force)| -force).sum();
        let gap = motion.blade_gaps().into_iter().fold(f64::INFINITY, f64::min);
        let turned = motion.machine().nodal_diameters * motion.rotor().angle(state.t_s);
        let [x, y] = in_blade_frame(state.u, turned);
        let [rim_x, rim_y] = rim_point(motion.machine(), state, turned);
        let values: [f64; CHANNELS] = [
            state.u[0],
            state.u[1],
            state.alpha[0],
            state.alpha[1],
            gap,
            rim_x.hypot(rim_y),
            push,
            x,
            y,
            rim_x,
            rim_y,
        ];
        let mut bin = Bin::of(self.last.unwrap_or(state.t_s), values);
        bin.to = state.t_s;
        let log = motion.contacts();
        bin.contact = self.contact(log, bin.from, bin.to);
        (self.impacts, self.active_set) = (log.impact_count, log.active_set);
        self.average(&forces, bin.to - bin.from);
        self.last = Some(state.t_s);
        match &mut self.open {
            Some(open) => open.join(&bin),
            None => self.open = Some(bin),
        }
        if self.open.is_some_and(|open| open.to - open.from >= length) {
            self.done.extend(self.open.take());
            if self.done.len() > MOST_BINS {
                thin(&mut self.done);
            }
        }
    }

    /// Returns the first and the last instant of contact since the last sample.
    fn contact(&self, log: &ContactLog, from: f64, to: f64) -> Option<(f64, f64)> {
        let known = usize::try_from(self.impacts).unwrap_or(usize::MAX);
        let new = log.impact_count.saturating_sub(self.impacts);
        let impacts = || log.impacts.iter().skip(known).map(|impact| impact.t_s);
        // Of impacts whose instants are not kept, only the sample is known.
        let unknown = usize::try_from(new).is_ok_and(|new| impacts().count() < new);
        let [was, is] = [self.active_set, log.active_set].map(|set| set != ActiveSet::Nothing);
        let ended = log.last_contact.filter(|t| *t > from && *t <= to);
        let last = if is { Some(to) } else { ended };
        let first = match (was, is) {
            (true, _) => Some(from),
            (false, true) => Some(log.since.clamp(from, to)),
            (false, false) => last,
        };
        let all = [first.zip(last), unknown.then_some((from, to))].into_iter().flatten();
        let all = all.chain(impacts().map(|t| (t, t)));
        all.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    fn average(&mut self, forces: &[(u32, f64)], elapsed: f64) {
        if elapsed.is_nan() || elapsed <= 0.0 {
            return;
        }
        self.over += elapsed;
        for (side, force) in forces.iter().filter(|(_, force)| force.is_finite()) {
            match self.sums.iter_mut().find(|(known, _)| known == side) {
                Some((_, sum)) => *sum += force * elapsed,
                None => self.sums.push((*side, force * elapsed)),
            }
        }
    }

    /// Returns the closed bins since last asked.
    pub fn take_bins(&mut self) -> Vec<Bin> {
        std::mem::take(&mut self.done)
    }

    /// Returns all bins, with the one that is open.
    pub fn finish(&mut self) -> Vec<Bin> {
        self.done.extend(self.open.take());
        self.take_bins()
    }

    /// Returns the mean force on each side since the last call; the former means if the motion did
    /// not move since.
    pub fn mean_forces(&mut self) -> Vec<(u32, f64)> {
        if self.over > 0.0 {
            self.means = self.sums.iter().map(|(side, sum)| (*side, sum / self.over)).collect();
            self.means.sort_by_key(|(side, _)| *side);
            self.sums.clear();
            self.over = 0.0;
        }
        self.means.clone()
    }
}
