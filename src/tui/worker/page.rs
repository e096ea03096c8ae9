//! The page of time on the screen, recomputed at its own zoom from a copy of the motion, in slices.
//! The record of the playback is no substitute: at another zoom its bins differ, and it has no
//! future.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::full_run::SLICE;
use super::recorder::Recorder;
use crate::tui::engine::{FORECAST_LIMIT, PageRecord};
use crate::tui::history::{BinHistory, interpolated};
use rubscope_solver::motion::{Failure, GoOn, Motion};

/// Samples per recorded bin.
const SAMPLES: f64 = 4.0;
/// Smallest number of samples per turn of the wave relative to the blades.
pub const PER_TURN: f64 = 24.0;

/// The requested page, and the latest complete one.
#[derive(Debug, Default)]
pub struct Page {
    /// The latest request: the page (from, to), and the end of its computation \[s\].
    wanted: Option<((f64, f64), f64)>,
    /// The computation of the requested page; `None` if it is complete or was given up.
    job: Option<PageJob>,
    /// The latest complete page, which may be an earlier one.
    done: Option<Arc<PageRecord>>,
}

#[derive(Debug)]
struct PageJob {
    /// First and last time of the page \[s\].
    page: (f64, f64),
    /// End of the computation \[s\].
    until: f64,
    /// Length of a bin \[s\].
    bin: f64,
    /// Time step of the solver \[s\].
    step: f64,
    motion: Motion,
    recorder: Option<Recorder>,
    wall: Duration,
}

impl Page {
    /// Requests a page (from, to) \[s\] in bins of `bin` seconds, up to the end of the run. `from`
    /// gives a motion at or before the start of the page; if it gives none, nothing is computed.
    /// Does nothing if this page was the last one requested.
    pub fn want(
        &mut self,
        page: (f64, f64),
        bin: f64,
        (step, end): (f64, f64),
        from: impl FnOnce() -> Option<Motion>,
    ) {
        let until = page.1.min(end);
        if self.wanted == Some((page, until)) {
            return;
        }
        self.wanted = Some((page, until));
        let (recorder, wall) = (None, Duration::ZERO);
        self.job = from().map(|motion| PageJob { page, until, bin, step, motion, recorder, wall });
    }

    /// Returns whether no page is being computed.
    pub fn is_done(&self) -> bool {
        self.job.is_none()
    }

    /// Advances the page by one slice of wall-clock time.
    pub fn compute(&mut self) {
        let Some(job) = &mut self.job else { return };
        let began = Instant::now();
        let whole = job.go_on(&|| began.elapsed() < SLICE);
        job.wall += began.elapsed();
        if whole {
            self.done = Some(Arc::new(job.record()));
        }
        // If it is given up, the record of the playback stays on the screen.
        if whole || job.wall >= FORECAST_LIMIT {
            self.job = None;
        }
    }

    /// Returns the wall-clock time spent on the page being computed; 0 if there is none.
    pub fn wall(&self) -> Duration {
        self.job.as_ref().map_or(Duration::ZERO, |job| job.wall)
    }

    /// Discards the request, the computation and the record, because the motion has changed.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Returns the latest complete page; `None` if none was completed since the motion changed.
    pub fn record(&self) -> Option<Arc<PageRecord>> {
        self.done.clone()
    }
}

impl PageJob {
    /// Continues the computation; returns true once the page is complete.
    fn go_on(&mut self, go_on: GoOn<'_>) -> bool {
        let Some(recorder) = &mut self.recorder else {
            let reached = self.motion.advance_while(self.page.0, go_on);
            if reached != Ok(false) {
                let recorder = self.recorder.insert(Recorder::from(&self.motion));
                let state = self.motion.state();
                // If each step fills a bin, close the first one at once: lines are drawn from
                // sample to sample.
                let length = if self.step > self.bin { 0.0 } else { self.bin };
                recorder.record(&mut self.motion, &state, length);
            }
            return false;
        };
        let sample = sample_length(&self.motion, self.bin);
        // A solver with steps stops at the last one before `until`; the next is beyond the page.
        while self.motion.t_s() < self.until {
            let next = (self.motion.t_s() + sample).min(self.until);
            match next_sample(&mut self.motion, next, self.step, go_on) {
                Ok(true) => {}
                Ok(false) => return false,
                // A failed motion has nothing more to record.
                Err(_) => return true,
            }
            let state = self.motion.state();
            recorder.record(&mut self.motion, &state, self.bin);
            if !go_on() {
                return false;
            }
        }
        true
    }

    fn record(&mut self) -> PageRecord {
        let bins = self.recorder.as_mut().map(Recorder::finish).unwrap_or_default();
        let mut record = BinHistory::default();
        record.extend(&interpolated(&bins, self.bin, self.page));
        PageRecord { page: self.page, record }
    }
}

/// Returns the time between samples for bins of `bin` seconds, short enough to follow the turn of
/// the wave.
pub fn sample_length(motion: &Motion, bin: f64) -> f64 {
    (bin / SAMPLES).min(longest_sample(motion)).max(1e-12)
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
pub fn next_sample(
    motion: &mut Motion,
    until: f64,
    step: f64,
    go_on: GoOn<'_>,
) -> Result<bool, Failure> {
    let before = motion.t_s();
    let reached = motion.advance_while(until, go_on)?;
    if reached && motion.t_s() <= before {
        // Half a step more, because round-off could leave the motion where it is.
        return motion.advance_while(before + 1.5 * step, go_on);
    }
    Ok(reached)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::history::Channel;
    use rubscope_solver::scene::Scene;

    /// Computes a page over the first millisecond of a scene, up to `end`.
    fn computed(scene: Scene, end: f64) -> (Page, Motion) {
        let motion = Motion::new(&scene.checked().unwrap());
        let mut page = Page::default();
        page.want((0.0, 1e-3), 1e-5, (scene.solver.step_s, end), || Some(motion.clone()));
        while !page.is_done() {
            page.compute();
        }
        (page, motion)
    }

    #[test]
    fn a_page_is_computed_again_where_the_run_has_another_end() {
        let (mut page, motion) = computed(Scene::base(), 5e-4);
        let reached =
            |page: &Page| page.record().unwrap().record.between(0.0, 1.0).last().unwrap().to;
        assert!((reached(&page) - 5e-4).abs() < 2e-7, "{}", reached(&page));
        let mut want = |end: f64| {
            page.want((0.0, 1e-3), 1e-5, (1e-7, end), || Some(motion.clone()));
            page.is_done()
        };
        assert!(want(5e-4) && !want(8e-4));
    }

    #[test]
    fn between_two_steps_a_page_is_the_straight_line_from_one_to_the_other() {
        let scene = Scene::base();
        let (step, page) = (scene.solver.step_s, (1e-3, 1e-3 + 5.0 * scene.solver.step_s));
        let checked = scene.checked().unwrap();
        let mut wanted = Page::default();
        let motion = || Some(Motion::new(&checked));
        wanted.want(page, step / 50.0, (step, page.1), motion);
        while !wanted.is_done() {
            wanted.compute();
        }
        let record = wanted.record().unwrap();
        let at = |steps: f64| {
            let mut motion = Motion::new(&checked);
            motion.advance(page.0 + steps * step).unwrap();
            motion.state().u[0]
        };
        for k in [0.0, 1.0, 2.0, 3.0] {
            let (from, to) = (at(k), at(k + 1.0));
            for bin in record.record.between(page.0 + (k + 0.1) * step, page.0 + (k + 0.9) * step) {
                let part = (bin.to - page.0) / step - k;
                let apart = bin.middle(Channel::UC) - from - part * (to - from);
                assert!(apart.abs() < 1e-6 * (to - from).abs(), "{k} {part}: {apart:e}");
            }
        }
    }

    #[test]
    fn a_page_begins_with_its_first_instant() {
        let mut scene = Scene::base();
        (scene.initial.v_c_m_s, scene.operation.pulse_n) = (-0.05, 0.0);
        let (page, _) = computed(scene, 1e-3);
        let first = page.record().unwrap().record.between(0.0, 1e-5)[0];
        // The casing moves away from its start and does not return.
        assert_eq!((first.from, first.high[0]), (0.0, 0.0));
    }
}
