//! The curves of the page of time on the screen: minimum and maximum in bins, recorded at the
//! page's own zoom from a copy of the motion, in slices, up to the end of the run.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::recorder::Recorder;
use crate::tui::engine::{FORECAST_LIMIT, PageRecord, SLICE};
use crate::tui::history::interpolated;
use rubscope_solver::motion::{Failure, GoOn, Motion, Scripted};

/// Bins per page: more than a wide screen has sub-pixels.
const BINS: f64 = 1024.0;
/// Samples per recorded bin.
const SAMPLES: f64 = 4.0;
/// Smallest number of samples per turn of the wave relative to the blades.
pub const PER_TURN: f64 = 24.0;

/// The requested page, and the latest one that was computed.
#[derive(Clone, Debug, Default)]
pub struct Page {
    /// First and last time of the latest page requested, and the end of its computation \[s\].
    wanted: Option<((f64, f64), f64)>,
    /// The computation; `None` before the first request, and once it is complete or given up.
    job: Option<PageJob>,
    /// The latest page that was computed, which may be an earlier one, as far as it is computed.
    pub done: Option<Arc<PageRecord>>,
}

#[derive(Clone, Debug)]
struct PageJob {
    /// First and last time of the page \[s\].
    page: (f64, f64),
    /// End of the computation \[s\].
    until: f64,
    /// The motion; `None` before it begins, and after the end.
    at: Option<Scripted>,
    /// The bins; `None` before the start of the page.
    recorder: Option<Recorder>,
    wall: Duration,
}

impl Page {
    /// Requests a page (from, to) \[s\] up to `end`, the end of the run. Does nothing if this page
    /// was the last one requested.
    pub fn want(&mut self, page: (f64, f64), end: f64) {
        let until = page.1.min(end);
        let wanted = Some((page, until));
        if std::mem::replace(&mut self.wanted, wanted) != wanted {
            let (at, recorder, wall) = (None, None, Duration::ZERO);
            self.job = Some(PageJob { page, until, at, recorder, wall });
        }
    }

    /// Returns whether no page is to be computed.
    pub fn is_done(&self) -> bool {
        self.job.is_none()
    }

    /// Returns the start of the page that is to be computed \[s\], and whether it has begun.
    pub fn due(&self) -> Option<(f64, bool)> {
        self.job.as_ref().map(|job| (job.page.0, job.at.is_some()))
    }

    /// Advances the page by one slice of wall-clock time; it begins with `from`, a motion at or
    /// before its start, of a scene with the time step `step` \[s\].
    pub fn compute(&mut self, from: Option<Scripted>, step: f64) {
        let Some(job) = &mut self.job else { return };
        job.at = job.at.take().or(from);
        let began = Instant::now();
        let is_whole = job.go_on(step, &|| began.elapsed() < SLICE);
        job.wall += began.elapsed();
        if let Some(recorder) = &job.recorder {
            let bins = interpolated(&recorder.bins(), job.bin(), job.page);
            self.done = Some(Arc::new(PageRecord { page: job.page, bins, is_whole }));
        }
        if is_whole || job.wall >= FORECAST_LIMIT {
            self.job = None;
        }
    }

    /// Returns the wall-clock time spent on the page being computed; 0 if there is none.
    pub fn wall(&self) -> Duration {
        self.job.as_ref().map_or(Duration::ZERO, |job| job.wall)
    }
}

impl PageJob {
    /// Returns the length of a bin \[s\].
    fn bin(&self) -> f64 {
        (self.page.1 - self.page.0) / BINS
    }

    /// Continues the computation with a time step of `step` seconds; returns true once the page is
    /// complete, or has no motion to begin with.
    fn go_on(&mut self, step: f64, go_on: GoOn<'_>) -> bool {
        let bin = self.bin();
        let Some(at) = &mut self.at else { return true };
        let Some(recorder) = &mut self.recorder else {
            let reached = at.advance_while(self.page.0, go_on);
            if reached != Ok(false) {
                let recorder = self.recorder.insert(Recorder::from(&at.motion));
                // If each step fills a bin, close the first one at once: lines are drawn from
                // sample to sample.
                recorder.record(&mut at.motion, if step > bin { 0.0 } else { bin });
            }
            return false;
        };
        let sample = sample_length(&at.motion, self.page);
        // A solver with steps stops at the last one before `until`; the next is beyond the page.
        while at.motion.t_s() < self.until {
            let next = (at.motion.t_s() + sample).min(self.until);
            match next_sample(at, next, step, go_on) {
                Ok(true) => {}
                Ok(false) => return false,
                // A failed motion has nothing more to record.
                Err(_) => return true,
            }
            recorder.record(&mut at.motion, bin);
            if !go_on() {
                return false;
            }
        }
        true
    }
}

/// Returns the time between the samples of a page (from, to) \[s\], short enough to follow the turn
/// of the wave.
pub fn sample_length(motion: &Motion, (from, to): (f64, f64)) -> f64 {
    ((to - from) / (BINS * SAMPLES)).min(longest_sample(motion)).max(1e-12)
}

/// Returns the longest sample that still follows the wave's turn relative to the blades: 1/24 of a
/// period at `omega_c + nu`.
pub fn longest_sample(motion: &Motion) -> f64 {
    let machine = motion.machine();
    let fastest = machine.omega_c + machine.nu(motion.rotor().speed(motion.t_s()).abs());
    std::f64::consts::TAU / fastest.max(f64::MIN_POSITIVE) / PER_TURN
}

/// Advances to the time `until` \[s\], or by one time step of `step` seconds if `until` is before
/// the next step. Returns false if `go_on` stopped it before.
///
/// # Errors
/// As `Solver::advance_while`.
fn next_sample(at: &mut Scripted, until: f64, step: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
    let before = at.motion.t_s();
    let reached = at.advance_while(until, go_on)?;
    if reached && at.motion.t_s() <= before {
        // Half a step more, because round-off could leave the motion where it is.
        return at.advance_while(before + 1.5 * step, go_on);
    }
    Ok(reached)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::history::{Channel, between};
    use rubscope_solver::motion::Script;
    use rubscope_solver::scene::Scene;

    /// Computes a page of a scene, up to `end`.
    fn computed(scene: &Scene, page: (f64, f64), end: f64) -> (Page, Scripted) {
        let motion = Motion::new(&scene.checked().unwrap());
        let at = Scripted::new(motion, &Script::default());
        let mut wanted = Page::default();
        wanted.want(page, end);
        while !wanted.is_done() {
            wanted.compute(Some(at.clone()), scene.solver.step_s);
        }
        (wanted, at)
    }

    #[test]
    fn a_page_is_computed_again_where_the_run_has_another_end() {
        let (mut page, _) = computed(&Scene::base(), (0.0, 1e-3), 5e-4);
        let reached = page.done.as_ref().unwrap().bins.last().unwrap().to;
        assert!((reached - 5e-4).abs() < 2e-7, "{reached}");
        let mut want = |end: f64| {
            page.want((0.0, 1e-3), end);
            page.is_done()
        };
        assert!(want(5e-4) && !want(8e-4));
    }

    #[test]
    fn between_two_steps_a_page_is_the_straight_line_from_one_to_the_other() {
        let scene = Scene::base();
        let (step, from) = (scene.solver.step_s, 1e-3);
        let to = from + 20.0 * step;
        let (page, start) = computed(&scene, (from, to), to);
        let at = |steps: f64| {
            let mut at = start.clone();
            at.motion.advance(from + steps * step).unwrap();
            at.motion.state().u[0]
        };
        let record = page.done.as_ref().unwrap();
        for k in [0.0, 1.0, 2.0, 3.0] {
            let (before, after) = (at(k), at(k + 1.0));
            let inside = between(&record.bins, from + (k + 0.1) * step, from + (k + 0.9) * step);
            assert!(inside.len() > 30);
            for bin in inside {
                let part = (bin.to - from) / step - k;
                let apart = bin.middle(Channel::UC) - before - part * (after - before);
                assert!(apart.abs() < 1e-6 * (after - before).abs(), "{k} {part}: {apart:e}");
            }
        }
    }

    #[test]
    fn a_page_begins_with_its_first_instant() {
        let mut scene = Scene::base();
        (scene.initial.v_c_m_s, scene.operation.pulse_n) = (-0.05, 0.0);
        let (page, _) = computed(&scene, (0.0, 1e-3), 1e-3);
        let first = page.done.as_ref().unwrap().bins[0];
        // The casing moves away from its start and does not return.
        assert_eq!((first.from, first.high[0]), (0.0, 0.0));
    }
}
