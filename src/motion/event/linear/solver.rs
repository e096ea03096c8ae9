//! What every solver offers, by this one.

use super::Joined;
use crate::model::Machine;
use crate::motion::{
    Checks, ContactLog, EnergyLedger, Failure, FailureReason, GoOn, Plane, Pulse, Rotor, Solver,
    State, Verdict, in_phase_order,
};
use crate::tolerances::{EVENT_RANGE, LOOKS_UNASKED};

impl Solver for Joined {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        loop {
            if let Some(failure) = &self.failure {
                return Err(failure.clone());
            }
            if self.next.0 > self.elapsed(until) {
                self.clock.arrive(until);
                if !self.held.rows.is_empty() {
                    self.log.touch(self.clock.now, self.log.active_set);
                }
                return Ok(true);
            }
            if self.looks.is_multiple_of(LOOKS_UNASKED) && !go_on() {
                return Ok(false);
            }
            self.pass();
        }
    }

    fn t_s(&self) -> f64 {
        self.clock.now
    }

    fn state(&self) -> State {
        let (s, point) = (self.elapsed(self.clock.now), self.point_now());
        let turn = Plane::cis(self.phase + self.parameters.nu * s);
        let (u, v) = (point.z * turn, self.parameters.carried(&point) * turn);
        State {
            t_s: self.clock.now,
            u: [u.re, u.im],
            v: [v.re, v.im],
            alpha: [point.a.re, point.a.im],
            alpha_rate: [point.da.re, point.da.im],
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        let (tips, a) = (&self.parameters.tips, self.point_now().a);
        let angle = |blade| {
            let (cos, sin) = tips.direction(tips.side_of_blade(blade));
            cos * a.re + sin * a.im
        };
        (1..=tips.blades).map(angle).collect()
    }

    fn blade_gaps(&self) -> Vec<f64> {
        let (parameters, point) = (&self.parameters, self.point_now());
        let polygon = &parameters.machine.polygon;
        let gap = |(blade, angle): (u32, f64)| {
            let (cos, sin) = polygon.direction(polygon.side_of_blade(blade));
            let open = parameters.clearance() + cos * point.z.re + sin * point.z.im;
            open - parameters.arm() * angle
        };
        (1..=polygon.blades).zip(self.blade_angles()).map(gap).collect()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let mass = self.parameters.machine.casing_mass;
        let pushes = self.held.with(self.stretch.pushes_at(self.elapsed(self.clock.now)));
        let mut sides: Vec<(u32, f64)> = Vec::new();
        for (row, push) in pushes {
            let Some(row) = self.parameters.rows.get(row) else { continue };
            match sides.iter_mut().find(|(side, _)| *side == row.side) {
                Some((_, sum)) => *sum -= push * mass,
                None => sides.push((row.side, -push * mass)),
            }
        }
        in_phase_order(&self.parameters.machine.polygon, &mut sides);
        sides
    }

    fn over(&self) -> bool {
        self.stretch.free
    }

    fn final_verdict(&self) -> Option<Verdict> {
        if let Some(failure) = &self.failure {
            Some(failure.verdict_beyond(&self.pulse))
        } else if self.over() {
            Some(Verdict::Decay)
        } else {
            self.held_for_good(self.elapsed(self.clock.now)).then_some(Verdict::Locked)
        }
    }

    fn pulse(&self) -> &Pulse {
        &self.pulse
    }

    fn contacts(&self) -> &ContactLog {
        &self.log
    }

    fn machine(&self) -> &Machine {
        &self.parameters.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.rotor
    }

    fn events(&self) -> Option<u64> {
        Some(self.events)
    }

    fn swing(&self) -> f64 {
        let rise = self.machine().radial_coupling * self.machine().blade_length;
        rise.abs() * self.swings.lasting()
    }

    fn linearised(&self) -> bool {
        self.parameters.blades.is_some()
    }

    fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        let (s, parameters) = (self.elapsed(self.clock.now), &self.parameters);
        let residual = self.ledger_now().residual(parameters.energy(&self.point_now()));
        Checks {
            max_penetration_m: self.deepest,
            max_blade_angle_rad: self.widest_until(s),
            energy_residual_j: Some(parameters.machine.casing_mass * residual),
            ..Checks::default()
        }
    }

    fn energy_ledger(&self) -> Option<EnergyLedger> {
        let mass = self.parameters.machine.casing_mass;
        let ledger = self.checked.then(|| self.ledger_now())?;
        let stored = self.parameters.energy(&self.point_now()) - ledger.start;
        Some(EnergyLedger {
            pulse_work_j: mass * ledger.pulse,
            // Against friction it works on a casing at rest too: that part is all heat.
            rotor_work_j: mass * (ledger.rotor + ledger.sliding),
            casing_loss_j: mass * ledger.casing,
            blade_loss_j: mass * ledger.blades,
            friction_heat_j: mass * (ledger.sliding - ledger.dragged),
            impact_loss_j: mass * ledger.impacts,
            stored_j: mass * stored,
        })
    }

    fn forgo_checks(&mut self) {
        self.checked = false;
    }

    fn fire(&mut self) {
        let length = self.pulse.end - self.pulse.start;
        self.swings.forget();
        self.intervene(|joined, _| {
            let now = joined.clock.now;
            joined.pulse = Pulse { start: now, end: now + length, ..joined.pulse };
        });
    }

    /// A ramp is none of this solver's: it fails there.
    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.swings.forget();
        self.intervene(|joined, _| {
            joined.rotor.change(joined.clock.now, speed, ramp);
            joined.parameters.turn_at(speed);
        });
        if ramp != 0.0 {
            self.fail(0.0, FailureReason::Ramp);
        }
    }

    fn scale_rate(&mut self, factor: f64) {
        if self.over() || self.held.rows.len() > 1 {
            return;
        }
        self.intervene(|joined, point| {
            let side = joined.held.rows.first().and_then(|&row| joined.parameters.rows.get(row));
            let free = match side {
                None => joined.parameters.carried(point),
                Some(side) => {
                    let along = Plane::i() * side.casing;
                    along * (along.conj() * point.dz).re
                }
            };
            point.dz += free * (factor - 1.0);
        });
    }

    fn scale_tolerance(&mut self, factor: f64) {
        let tolerance = factor * self.parameters.tolerance;
        self.parameters.tolerance = tolerance.clamp(*EVENT_RANGE.start(), *EVENT_RANGE.end());
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}
