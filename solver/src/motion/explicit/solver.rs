//! The common solver interface of the explicit solver: advance, observe, change.

use super::Explicit;
use crate::model::{LARGEST_BLADE_ANGLE, Machine};
use crate::motion::{
    ActiveSet, Checks, ContactLog, EnergyAccount, Failure, GoOn, Pulse, Rotor, Solver, State,
    Verdict,
};
use crate::scene::CheckedScene;
use crate::scene::STEP_ROUND_OFF;

/// Coordinate updates between two checks of `go_on`: some tens of microseconds.
const UPDATES_UNASKED: usize = 4096;

impl Explicit {
    /// Advances to `until` or, unless it `looks` into the stride that contains `until`, to the start
    /// of that stride.
    fn go_to(&mut self, until: f64, looks: bool, go_on: GoOn<'_>) -> Result<bool, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        // A step that ends within a millionth of itself after `until` belongs to it.
        let target = (until / self.drive.step + STEP_ROUND_OFF).floor().max(0.0) as u64;
        if self.n >= target {
            return Ok(true);
        }
        let mut begun = None;
        if let Some((stride, began)) = self.stride.take() {
            begun = Some(stride);
            if let Some(mut began) = began {
                // Forces already reported stay reported.
                began.record.keep_told(&mut self.record);
                *self = *began;
            }
        }
        let steps_unasked = UPDATES_UNASKED / (2 + self.disk.coordinates());
        let mut unasked = 0;
        while self.n < target {
            unasked += 1;
            if unasked > steps_unasked {
                unasked = 0;
                if !go_on() {
                    return Ok(false);
                }
            }
            let found = || if self.scene.solver.plain { None } else { self.find_stride() };
            match begun.take().or_else(found) {
                Some(stride) if self.n + stride.steps < target => {
                    self.take_stride(&stride, stride.steps, false);
                }
                Some(stride) if looks => {
                    let began = Box::new(self.clone());
                    self.take_stride(&stride, target - self.n, true);
                    self.stride = Some((stride, Some(began)));
                }
                Some(stride) => {
                    self.stride = Some((stride, None));
                    break;
                }
                None => self.take_step().map_err(|reason| {
                    self.record.end_contact(self.n);
                    let t_s = self.drive.time_of(self.n);
                    self.failure.insert(Failure { t_s, reason }).clone()
                })?,
            }
        }
        Ok(true)
    }
}

impl Solver for Explicit {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        self.go_to(until, true, go_on)
    }

    fn approach(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        self.go_to(until, false, go_on)
    }

    fn t_s(&self) -> f64 {
        self.drive.time_of(self.n)
    }

    fn state(&self) -> State {
        // The mean rate of the steps before and after; the casing of rigid contact has only that
        // of the step before.
        let (force, push, step) = (self.drive.force(self.n), self.lining_push(), self.drive.step);
        let [c, s] = self.u;
        let ahead = [self.casing.step(c, force + push.re), self.casing.step(s, push.im)];
        let mut disk_ahead = self.disk.clone();
        disk_ahead.predict(self.drive.driven(self.n));
        let held = self.lining.is_none() && self.record.log.active_set != ActiveSet::Nothing;
        let rate = |k: usize| {
            let last = self.u[k].increment;
            if held { last / step } else { (last + ahead[k].increment) / (2.0 * step) }
        };
        let (last, next) = (self.disk.modal_increments(), disk_ahead.modal_increments());
        State {
            t_s: self.t_s(),
            u: self.u.map(|at| at.x),
            v: [rate(0), rate(1)],
            alpha: self.disk.modal(),
            alpha_rate: [0, 1].map(|k| (last[k] + next[k]) / (2.0 * step)),
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.disk.every_angle()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let multipliers = match &self.lining {
            Some(lining) => lining.multipliers(&self.tips_of_rows),
            None => self.rows.iter().map(|row| (row.side, row.lambda)).collect(),
        };
        self.record.by_side(&self.machine.polygon, multipliers.into_iter())
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        if let Some(lining) = &mut self.lining {
            lining.give_impulses(&self.tips_of_rows, &mut self.record);
        }
        self.record.take_mean_forces(&self.machine.polygon, self.n)
    }

    fn over(&self) -> bool {
        self.cannot_touch_again()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        self.decided()
    }

    fn lasting(&self, window: f64) -> Verdict {
        let rests = || self.rest_rate().map(|rate| rate > 0.0);
        self.lasting.verdict(&self.machine, &self.record.log, [self.t_s(), window], rests)
    }

    fn rest_rate(&self) -> Option<f64> {
        self.decay_about_rest()
    }

    fn pulse(&self) -> &Pulse {
        &self.drive.pulse
    }

    fn contacts(&self) -> &ContactLog {
        &self.record.log
    }

    fn machine(&self) -> &Machine {
        &self.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.drive.rotor
    }

    fn steps(&self) -> Option<u64> {
        Some(self.n)
    }

    fn steps_skipped(&self) -> Option<u64> {
        Some(self.skipped)
    }

    fn pulls(&self) -> bool {
        self.law.pulls()
    }

    fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        let record = &self.record;
        Checks {
            max_penetration_m: record.deepest,
            max_predicted_penetration_m: self.lining.is_none().then_some(record.deepest_predicted),
            tensile_steps: record.log.tensile_steps,
            max_blade_angle_rad: self.disk.largest,
            energy_residual_j: self.energy_account().map(|ledger| ledger.residual()),
        }
    }

    fn energy_account(&self) -> Option<EnergyAccount> {
        // The step that failed is beyond what its energies describe.
        let known = self.ledger.counts && self.failure.is_none();
        let stored_j = || self.stored() - self.ledger.start;
        known.then(|| EnergyAccount { stored_j: stored_j(), ..self.ledger.sums })
    }

    fn forgo_checks(&mut self) {
        if let Some((_, Some(began))) = &mut self.stride {
            began.forgo_checks();
        }
        self.ledger.counts = false;
        // From now on only angles beyond the limit of the model are recorded.
        self.disk.largest = self.disk.largest.max(LARGEST_BLADE_ANGLE);
    }

    fn fire(&mut self) {
        self.begin_change();
        let before = self.stored();
        let force = self.drive.fire(self.n);
        self.u[0].increment -= self.casing.start_shift(force);
        self.ledger.start += self.stored() - before;
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.take_speed(speed, ramp);
    }

    /// In a held corner the casing follows the blades: it has no free rate.
    fn scale_rate(&mut self, factor: f64) {
        if self.held_corner().is_some() {
            return;
        }
        self.forget();
        let before = self.stored();
        self.u.iter_mut().for_each(|at| at.increment *= factor);
        self.ledger.start += self.stored() - before;
    }

    fn set_parameters(&mut self, scene: &CheckedScene) {
        self.take_parameters(scene);
    }

    fn set_end(&mut self, end: f64) {
        self.lasting.set_end(self.drive.time_of(self.n), end);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}
