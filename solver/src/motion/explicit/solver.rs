//! The explicit solver as every solver is seen: advanced, looked at, and changed on
//! the way.

use super::disk::Disk;
use super::lasting::Surface;
use super::rows::TipLaw;
use super::{Coordinate, Explicit};
use crate::model::Machine;
use crate::motion::verdict::judge;
use crate::motion::{
    ActiveSet, Checks, ContactLog, EnergyAccount, Failure, GoOn, LinearRest, Plane, Pulse, Rotor,
    Solver, State, Verdict,
};
use crate::scene::CheckedScene;
use crate::tolerances::{LARGEST_BLADE_ANGLE, STEP_ROUND_OFF, UPDATES_UNASKED};

impl<B: Disk> Solver for Explicit<B> {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        // A step that ends within a millionth of itself after `until` belongs to it.
        let target = (until / self.drive.step + STEP_ROUND_OFF).floor().max(0.0) as u64;
        let steps_unasked = UPDATES_UNASKED / self.blades.coordinates();
        let mut unasked = 0;
        while self.latest_step() < target {
            unasked += 1;
            if unasked > steps_unasked {
                unasked = 0;
                if !go_on() {
                    return Ok(false);
                }
            }
            let moved = match self.leap(target, steps_unasked) {
                Some(steps) => {
                    unasked += steps;
                    Ok(())
                }
                None => self.take_step(),
            };
            if let Err(reason) = moved {
                let failure = Failure { t_s: self.time_of(self.n), reason };
                self.record.end_contact(self.n);
                self.failure = Some(failure.clone());
                return Err(failure);
            }
        }
        Ok(true)
    }

    fn t_s(&self) -> f64 {
        self.time_of(self.latest_step())
    }

    fn state(&self) -> State {
        let (u, blades) = self.materialized();
        let (n, step) = (self.latest_step(), self.drive.step);
        // The mean rate of the steps before and after.
        let (ahead, blades_ahead) = self.ahead(u, &blades);
        let held = self.lining.is_none() && self.record.log.active_set != ActiveSet::Nothing;
        let rate = |k: usize| {
            let last = u[k].increment;
            if held { last / step } else { (last + ahead[k].increment) / (2.0 * step) }
        };
        State {
            t_s: self.time_of(n),
            u: u.map(|coordinate| coordinate.x),
            v: [rate(0), rate(1)],
            alpha: blades.modal(),
            alpha_rate: blades.modal_rates(&blades_ahead, step),
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.materialized().1.every_angle()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        if self.record.log.active_set == ActiveSet::Nothing {
            return Vec::new();
        }
        let rows = || match &self.lining {
            Some(lining) => lining.multipliers(),
            None => self.rows.iter().map(|row| (row.side, row.lambda)).collect(),
        };
        let multipliers: Vec<(u32, f64)> = self.leaps.multipliers().unwrap_or_else(rows);
        self.record.by_side(&self.machine.polygon, multipliers.into_iter())
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        if let Some(lining) = &mut self.lining {
            lining.give_impulses(&mut self.record);
        }
        self.record.take_mean_forces(&self.machine.polygon, self.latest_step())
    }

    fn over(&self) -> bool {
        self.no_contact_to_come()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        self.decided()
    }

    fn lasting(&self, window: f64) -> Verdict {
        let (log, now) = (&self.record.log, self.t_s());
        if !self.goes_beyond {
            return judge(log, now, window);
        }
        let (lasting, clearance) = (&self.beyond.lasting, self.machine.clearance());
        let lining = self.lining.is_some();
        let surface = Surface {
            lining,
            uneven_tips: self.machine.has_unequal_tips(),
            lobes_rub: lining && self.machine.out_of_round() > clearance.abs(),
        };
        // A beat that lifts blades must be over within another run.
        let rests = || Some(self.rest()?.rate > 0.0 && self.stays_linear(now)?);
        let verdict = lasting.verdict(log, now, window, clearance, surface, rests);
        verdict.unless_forced(&self.machine, log, now - window)
    }

    fn linear_rest(&self) -> Option<LinearRest> {
        let linear = || self.dies() || self.stays_linear(0.0) == Some(true);
        let rest = self.rest().filter(|_| linear())?;
        let since_s = self.beyond.lasting.all_since()?;
        Some(LinearRest { rate_per_s: rest.rate, since_s })
    }

    fn swing(&self) -> f64 {
        self.beyond.lasting.swing()
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
        Some(self.latest_step())
    }

    fn steps_skipped(&self) -> Option<u64> {
        Some(self.leaps.skipped())
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
            max_blade_angle_rad: self.largest_angle(),
            energy_residual_j: self.energy_account().map(|ledger| ledger.residual()),
        }
    }

    fn energy_account(&self) -> Option<EnergyAccount> {
        let account = &self.beyond.account;
        let kept = self.goes_beyond && !account.forgone;
        kept.then(|| EnergyAccount { stored_j: self.stored() - account.start, ..account.sums })
    }

    fn forgo_checks(&mut self) {
        self.beyond.account.forgone = true;
        // Only an angle beyond the model is looked for.
        self.watch.skipped(LARGEST_BLADE_ANGLE, self.watch.bound());
    }

    fn fire(&mut self) {
        self.interrupt();
        self.beyond.lasting.forget();
        let before = self.stored_beyond();
        let unknown = self.drive.fire(self.n);
        self.u[0] = self.casing.begin(self.u[0], unknown);
        self.beyond.account.start += self.stored_beyond() - before;
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.interrupt();
        self.beyond.lasting.forget();
        self.drive.set_speed(self.n, speed, ramp);
        self.take_shape();
        self.take_speed();
    }

    /// In a held corner the casing follows the blades: it has no free rate.
    fn scale_rate(&mut self, factor: f64) {
        if self.leaps.holds_corner() {
            return;
        }
        self.close_block();
        let before = self.stored_beyond();
        for coordinate in &mut self.u {
            coordinate.increment *= factor;
        }
        self.beyond.account.start += self.stored_beyond() - before;
    }

    fn set_parameters(&mut self, scene: &CheckedScene) {
        self.beyond.lasting.forget();
        self.take_parameters(scene);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}

impl<B: Disk> Explicit<B> {
    /// Returns the casing and blades one step on from the latest, before what contact does to it.
    fn ahead(&self, u: [Coordinate; 2], blades: &B) -> ([Coordinate; 2], B) {
        let n = self.latest_step();
        let (force, mut blades) = (self.drive.force(n), blades.clone());
        let mut ahead = [self.casing.step(u[0], force), self.casing.step(u[1], 0.0)];
        blades.predict(self.drive.driven(n));
        if self.lining.is_some() {
            let tips = TipLaw::at(&self.machine, self.drive.speed(n));
            let shift = self.push_ahead(&tips, &mut blades);
            let (c, s) = self.drive.look_at_turn(n);
            let moved = shift * Plane::new(c, s);
            ahead[0].increment += moved.re;
            ahead[1].increment += moved.im;
        }
        (ahead, blades)
    }
}
