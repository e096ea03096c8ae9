//! Records samples of a motion as bins of minimum and maximum values.

use crate::tui::history::{Bin, CHANNELS, wider};
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{ActiveSet, ContactLog, Impact, Motion, State};

/// Returns the casing displacement in the frame of the blades, `z = (u_c + i u_s) exp(-i n_d
/// theta)` \[m\], with `turned = n_d theta`.
pub fn in_blade_frame(u: [f64; 2], turned: f64) -> [f64; 2] {
    let (sin, cos) = turned.sin_cos();
    [u[0] * cos + u[1] * sin, u[1] * cos - u[0] * sin]
}

/// Returns the casing displacement relative to the tips, `w = z - kappa l_b a` \[m\]: the point in
/// the polygon, with `turned = n_d theta`. It equals `z` without radial coupling, and if disk and
/// casing have different nodal diameters, because then no single point represents all blades.
pub fn rim_point(machine: &Machine, state: &State, turned: f64) -> [f64; 2] {
    let z = in_blade_frame(state.u, turned);
    let outward = machine.radial_coupling * machine.blade_length;
    if outward == 0.0 || machine.blade_diameters != machine.nodal_diameters {
        return z;
    }
    let [a_c, a_s] = state.alpha;
    [z[0] - outward * a_c, z[1] - outward * a_s]
}

/// Bins of one motion, as they are recorded.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// Closed bins.
    done: Vec<Bin>,
    /// The bin being filled; `None` before its first sample.
    open: Option<Bin>,
    /// Number of impacts of the motion up to the last sample.
    impacts: u64,
    /// Sides in contact at the last sample.
    active_set: ActiveSet,
    /// Time of the last sample \[s\]; `None` before the first.
    last: Option<f64>,
}

impl Recorder {
    /// Creates an empty record that begins at the current time of a motion.
    pub fn from(motion: &Motion) -> Self {
        let log = motion.contacts();
        Self { impacts: log.impact_count, active_set: log.active_set, ..Self::default() }
    }

    /// Adds a sample of the motion; a bin is closed after `length` seconds.
    pub fn record(&mut self, motion: &mut Motion, length: f64) {
        let state = motion.state();
        let forces = motion.take_mean_forces();
        let push: f64 = forces.iter().map(|(_, force)| -force).sum();
        let gap = motion.blade_gaps().into_iter().fold(f64::INFINITY, f64::min);
        let turned = motion.machine().nodal_diameters * motion.rotor().angle(state.t_s);
        let [x, y] = in_blade_frame(state.u, turned);
        let [rim_x, rim_y] = rim_point(motion.machine(), &state, turned);
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
        self.last = Some(state.t_s);
        match &mut self.open {
            Some(open) => open.join(&bin),
            None => self.open = Some(bin),
        }
        if self.open.is_some_and(|open| open.to - open.from >= length) {
            self.done.extend(self.open.take());
        }
    }

    /// Returns the first and last time of contact between two samples, at `from` and `to` \[s\];
    /// `None` if nothing touched.
    fn contact(&self, log: &ContactLog, from: f64, to: f64) -> Option<(f64, f64)> {
        let known = usize::try_from(self.impacts).unwrap_or(usize::MAX);
        let new = log.impacts.get(known..).unwrap_or(&[]);
        let [was, is] = [self.active_set, log.active_set].map(|set| set != ActiveSet::Nothing);
        let ended = log.last_contact.filter(|t| *t > from && *t <= to);
        let last = if is { Some(to) } else { ended };
        let begun = if is { Some(log.since.clamp(from, to)) } else { last };
        let first = if was { Some(from) } else { begun };
        // If the times of some impacts were not kept, the whole sample counts as contact.
        let unknown = (new.len() as u64) < log.impact_count.saturating_sub(self.impacts);
        let contact = if unknown { Some((from, to)) } else { first.zip(last) };
        new.iter().fold(contact, |contact, &Impact { t_s, .. }| {
            Some(contact.map_or((t_s, t_s), |contact| wider(contact, (t_s, t_s))))
        })
    }

    /// Returns the bins so far, including the open one.
    pub fn bins(&self) -> Vec<Bin> {
        self.done.iter().chain(&self.open).filter(|bin| bin.from.is_finite()).copied().collect()
    }
}
