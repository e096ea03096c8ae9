//! The explicit solver beyond the paper as every solver is seen: advanced, looked at,
//! and changed on the way.

use super::Coupled;
use super::blades::TipModel;
use super::energy::EnergyLedger;
use super::lining_step::push;
use super::rows::TipLaw;
use crate::model::Machine;
use crate::motion::{
    ActiveSet, Checks, ContactLog, Failure, GoOn, Plane, Pulse, Rotor, Solver, State, Verdict,
};
use crate::scene::CheckedScene;
use crate::tolerances::UPDATES_UNASKED;

impl<B: TipModel> Solver for Coupled<B> {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        // A step that ends within a millionth of itself after `until` belongs to it.
        let target = (until / self.drive.step + 1e-6).floor().max(0.0) as u64;
        let steps_unasked = UPDATES_UNASKED / self.blades.coordinates();
        let mut unasked = 0;
        while self.n < target {
            unasked += 1;
            if unasked > steps_unasked {
                unasked = 0;
                if !go_on() {
                    return Ok(false);
                }
            }
            if let Err(reason) = self.take_step() {
                let failure = Failure { t_s: self.time_of(self.n), reason };
                self.record.end_contact(self.n);
                self.failure = Some(failure.clone());
                return Err(failure);
            }
        }
        Ok(true)
    }

    fn t_s(&self) -> f64 {
        self.time_of(self.n)
    }

    fn state(&self) -> State {
        // The mean rate of the steps before and after.
        let force = self.drive.force(self.n);
        let mut ahead = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        let mut blades = self.blades.clone();
        blades.predict(self.drive.driven(self.n));
        if self.lining.is_some() {
            let tips = TipLaw::at(&self.machine, self.drive.speed(self.n));
            let (c, s) = self.drive.look_at_turn(self.n);
            push(&self.rows, &tips, Plane::new(c, s), &self.casing, &mut ahead, &mut blades);
        }
        let held = self.lining.is_none() && self.record.log.active_set != ActiveSet::Nothing;
        let rate = |k: usize| {
            let last = self.u[k].increment;
            if held { last } else { 0.5 * (last + ahead[k].increment) }
        };
        State {
            t_s: self.t_s(),
            u: self.u.map(|coordinate| coordinate.x),
            v: [rate(0), rate(1)].map(|moved| moved / self.drive.step),
            alpha: self.blades.modal().0,
            alpha_rate: blades.modal().1.map(|moved| moved / self.drive.step),
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.blades.every_angle()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let rows = self.rows.iter().map(|row| (row.side, row.lambda));
        self.record.by_side(&self.machine.polygon, rows)
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        self.record.take_mean_forces(&self.machine.polygon, self.n)
    }

    fn over(&self) -> bool {
        self.no_contact_to_come()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        match &self.failure {
            Some(failure) => Some(failure.verdict_beyond(&self.drive.pulse)),
            None => self.no_contact_to_come().then_some(Verdict::Decay),
        }
    }

    fn lasting(&self, window: f64) -> Verdict {
        let clearance = self.machine.clearance();
        self.lasting.verdict(&self.record.log, self.t_s(), window, clearance, self.lining.is_some())
    }

    fn swing(&self) -> f64 {
        self.lasting.swing()
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
        Some(0)
    }

    fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        Checks {
            max_penetration_m: self.record.deepest,
            max_predicted_penetration_m: self
                .lining
                .is_none()
                .then_some(self.record.deepest_predicted),
            tensile_steps: self.record.log.tensile_steps,
            max_blade_angle_rad: self.largest_angle,
            energy_residual_j: self.energy_ledger().map(|ledger| ledger.residual()),
        }
    }

    fn energy_ledger(&self) -> Option<EnergyLedger> {
        let stored_j = self.stored() - self.account.start;
        (!self.account.forgone).then_some(EnergyLedger { stored_j, ..self.account.sums })
    }

    fn forgo_checks(&mut self) {
        self.account.forgone = true;
    }

    fn fire(&mut self) {
        self.lasting.forget();
        let before = self.stored();
        let unknown = self.drive.fire(self.n);
        self.u[0] = self.casing.start_with(self.u[0], unknown);
        self.account.start += self.stored() - before;
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.lasting.forget();
        self.drive.set_speed(self.n, speed, ramp);
    }

    fn scale_rate(&mut self, factor: f64) {
        let before = self.stored();
        for coordinate in &mut self.u {
            coordinate.increment *= factor;
        }
        self.account.start += self.stored() - before;
    }

    fn set_parameters(&mut self, scene: &CheckedScene) {
        self.lasting.forget();
        self.take_parameters(scene);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}
