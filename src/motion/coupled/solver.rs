//! The explicit solver beyond the paper as every solver is seen: advanced, looked at,
//! and changed on the way.

use super::blades::TipModel;
use super::energy::EnergyLedger;
use super::lining_step::push;
use super::rows::TipLaw;
use super::{Coupled, driven};
use crate::model::Machine;
use crate::motion::contacts::in_phase_order;
use crate::motion::explicit::Phasor;
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
        let target = (until / self.step + 1e-6).floor().max(0.0) as u64;
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
                self.log.touch(failure.t_s, ActiveSet::Nothing);
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
        let force = self.force(self.n);
        let mut ahead = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        let mut blades = self.blades.clone();
        blades.predict(driven(self.excitation.as_ref(), &self.rotor, self.t_s()));
        if self.lining.is_some() {
            let tips = TipLaw::at(&self.machine, self.rotor.speed(self.t_s()));
            let diameters = self.machine.nodal_diameters;
            let (c, s) = self.phasor.look(self.n, &self.rotor, diameters, self.step);
            push(&self.rows, &tips, Plane::new(c, s), &self.casing, &mut ahead, &mut blades);
        }
        let held = self.lining.is_none() && self.log.active_set != ActiveSet::Nothing;
        let rate = |k: usize| {
            let last = self.u[k].increment;
            if held { last } else { 0.5 * (last + ahead[k].increment) }
        };
        State {
            t_s: self.t_s(),
            u: self.u.map(|coordinate| coordinate.x),
            v: [rate(0), rate(1)].map(|moved| moved / self.step),
            alpha: self.blades.modal().0,
            alpha_rate: blades.modal().1.map(|moved| moved / self.step),
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.blades.every_angle()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        if self.log.active_set == ActiveSet::Nothing {
            return Vec::new();
        }
        let mut sums: Vec<(u32, f64)> = Vec::new();
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            match sums.iter_mut().find(|(side, _)| *side == row.side) {
                Some((_, sum)) => *sum += row.lambda,
                None => sums.push((row.side, row.lambda)),
            }
        }
        in_phase_order(&self.machine.polygon, &mut sums);
        sums
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        let span = (self.n - self.impulses_since) as f64 * self.step;
        self.impulses_since = self.n;
        let mut means = Vec::new();
        for (side, impulse) in self.impulses.iter_mut().enumerate() {
            if *impulse != 0.0 && span > 0.0 {
                means.push((side as u32, *impulse / span));
                *impulse = 0.0;
            }
        }
        in_phase_order(&self.machine.polygon, &mut means);
        means
    }

    fn over(&self) -> bool {
        self.no_contact_to_come()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        match &self.failure {
            Some(failure) => Some(failure.verdict_beyond(&self.pulse)),
            None => self.no_contact_to_come().then_some(Verdict::Decay),
        }
    }

    fn lasting(&self, window: f64) -> Verdict {
        let clearance = self.machine.clearance();
        self.lasting.verdict(&self.log, self.t_s(), window, clearance, self.lining.is_some())
    }

    fn swing(&self) -> f64 {
        self.lasting.swing()
    }

    fn pulse(&self) -> &Pulse {
        &self.pulse
    }

    fn contacts(&self) -> &ContactLog {
        &self.log
    }

    fn machine(&self) -> &Machine {
        &self.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.rotor
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
            max_penetration_m: self.deepest,
            max_predicted_penetration_m: self.lining.is_none().then_some(self.deepest_predicted),
            tensile_steps: self.log.tensile_steps,
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

    /// What the pulse before gave in the half step until now is kept.
    fn fire(&mut self) {
        self.lasting.forget();
        let (start, next) = (self.t_s(), self.next_pulse);
        let half = 0.5 * self.step;
        let old = self.pulse;
        self.pulse = Pulse { start, end: start + next.end, force: next.force };
        if self.n == 0 {
            // The start knew the old force.
            let before = self.stored();
            let change = self.pulse.mean(0.0, half) - old.mean(0.0, half);
            self.u[0].increment -= 0.5 * self.step * self.step * change / self.machine.casing_mass;
            self.account.start += self.stored() - before;
        } else {
            let until_now = Pulse { end: old.end.min(start), ..old };
            let before = if self.left_over.0 == self.n { self.left_over.1 } else { 0.0 };
            self.left_over = (self.n, before + until_now.mean(start - half, start + half));
        }
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.lasting.forget();
        self.rotor.change(self.t_s(), speed, ramp);
        self.phasor = Phasor::new(&self.rotor, self.machine.nodal_diameters, self.step);
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
