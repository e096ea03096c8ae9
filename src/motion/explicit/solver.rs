//! The explicit solver as every solver is seen: advanced, looked at, and changed on
//! the way.

use super::held::Held;
use super::{BladeModel, Coordinate, Explicit};
use crate::model::Machine;
use crate::motion::{
    ActiveSet, Checks, ContactLog, Failure, GoOn, Pulse, Rotor, Solver, State, Verdict,
};
use crate::scene::CheckedScene;
use crate::tolerances::UPDATES_UNASKED;

impl<B: BladeModel> Solver for Explicit<B> {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        // A step that ends within a millionth of itself after `until` belongs to it.
        let target = (until / self.drive.step + 1e-6).floor().max(0.0) as u64;
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
            let moved = if self.is_sliding() {
                self.slide((target - self.n).min(steps_unasked as u64));
                unasked = steps_unasked;
                Ok(())
            } else if self.open_block() {
                self.use_block(target);
                Ok(())
            } else {
                self.take_step()
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
        let n = self.latest_step();
        let in_contact = self.record.log.active_set != ActiveSet::Nothing;
        let rate = |coordinate: Coordinate, force: f64| {
            if in_contact {
                coordinate.increment / self.drive.step
            } else {
                self.casing.rate(coordinate, force)
            }
        };
        let (alpha, alpha_rate) = blades.modal();
        State {
            t_s: self.time_of(n),
            u: u.map(|coordinate| coordinate.x),
            v: [rate(u[0], self.drive.force(n)), rate(u[1], 0.0)],
            alpha,
            alpha_rate,
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.materialized().1.every_angle(&self.machine)
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        if self.record.log.active_set == ActiveSet::Nothing {
            return Vec::new();
        }
        if let Some(sliding) = &self.sliding {
            return vec![(sliding.side, sliding.multiplier)];
        }
        let polygon = &self.machine.polygon;
        match self.held.as_ref().filter(|_| self.block.used() > 0) {
            Some(held) => self.record.by_side(polygon, held.multipliers(self.block.used())),
            None => {
                let rows = self.rows.iter().map(|row| (row.side, row.lambda));
                self.record.by_side(polygon, rows)
            }
        }
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        self.record.take_mean_forces(&self.machine.polygon, self.latest_step())
    }

    fn over(&self) -> bool {
        self.no_contact_to_come()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        self.decided()
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
        Some(self.skipped + self.block.used())
    }

    fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        Checks {
            max_penetration_m: self.record.deepest,
            max_predicted_penetration_m: Some(self.record.deepest_predicted),
            tensile_steps: self.record.log.tensile_steps,
            max_blade_angle_rad: self.largest_angle(),
            energy_residual_j: None,
        }
    }

    fn fire(&mut self) {
        self.interrupt();
        let unknown = self.drive.fire(self.n);
        self.u[0] = self.casing.start_with(self.u[0], unknown);
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.interrupt();
        self.drive.set_speed(self.n, speed, ramp);
        self.side_map = None;
    }

    /// In a held corner the casing follows the blades: it has no free rate.
    fn scale_rate(&mut self, factor: f64) {
        if matches!(self.held, Some(Held::Corner(_))) {
            return;
        }
        self.close_block();
        self.same_sides = 0;
        for coordinate in &mut self.u {
            coordinate.increment *= factor;
        }
    }

    fn set_parameters(&mut self, scene: &CheckedScene) {
        self.take_parameters(scene);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}
