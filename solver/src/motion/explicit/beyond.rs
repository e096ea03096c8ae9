//! What only motions beyond the paper keep (docs/theory.md, section 10), and a step of
//! theirs: tips that move outward as blades bend, friction, restitution, an elastic
//! lining, disks of other diameters and mistuned ones.

use super::disk::Disk;
use super::lasting::{Lasting, mark};
use super::lining::Lining;
use super::record::Account;
use super::rows::{Found, TipLaw};
use super::uneven::Uneven;
use super::{Coordinate, Explicit};
use crate::model::Machine;
use crate::motion::{ActiveSet, FailureReason};
use crate::scene::{CheckedScene, ModelSize};
use crate::tolerances::{ANGLE_LOOK, LONG_STEP};

/// State that only steps beyond the paper need, and what their verdict needs.
#[derive(Clone, Debug)]
pub(super) struct Beyond {
    /// Increments of the casing in the step before the last \[m\].
    pub before: [f64; 2],
    /// Rows that may touch, and the range in which they were searched for.
    pub candidates: Vec<u32>,
    pub found: Option<Found>,
    /// Bounds on the penetration left at the latest step and at the one before \[m\].
    pub dips: [f64; 2],
    /// Deepest distance to a target in the latest contact \[m\].
    pub depth: f64,
    /// Way of the casing in a step that passes much of a side \[m\], and the steps in a row
    /// that did.
    pub long: f64,
    pub long_steps: u32,
    pub lasting: Lasting,
    /// Loss of clearance in the latest step and in the one before \[m\].
    pub closed: [f64; 2],
    pub account: Account,
    /// Tips of their own, and a casing out of round.
    pub uneven: Option<Uneven>,
    /// Whether the tips rub as those of a rotor that turns backward.
    backward: bool,
    /// Step of the next look at the swing of rigid tips, and the steps between two.
    next_look: u64,
    steps_unseen: u64,
}

impl Beyond {
    pub fn of(scene: &CheckedScene, speed: f64) -> Self {
        Self {
            before: [0.0; 2],
            candidates: Vec::new(),
            found: None,
            dips: [0.0; 2],
            depth: 0.0,
            long: long_step(scene),
            long_steps: 0,
            lasting: Lasting::new(scene.solver.end_s),
            closed: [0.0; 2],
            account: Account::default(),
            uneven: None,
            backward: speed < 0.0,
            next_look: 0,
            steps_unseen: steps_unseen(scene),
        }
    }

    /// Returns the next step up to `n` at which the swing of the tips is due to be observed, and
    /// schedules the one after it.
    pub fn look_until(&mut self, n: u64) -> Option<u64> {
        let look = self.next_look;
        (look <= n).then(|| {
            self.next_look = look + self.steps_unseen;
            look
        })
    }

    /// Returns the number of steps from step `n` to that observation, at least one.
    pub fn unseen(&self, n: u64) -> u64 {
        self.next_look.saturating_sub(n).max(1)
    }

    /// Takes over the parameters of another scene, at this rotor speed. Gaps of earlier steps may
    /// change by as much as the clearance.
    pub fn set_parameters(&mut self, scene: &CheckedScene, machine: &Machine, speed: f64) {
        self.backward = speed < 0.0;
        self.steps_unseen = steps_unseen(scene);
        self.long = long_step(scene);
        self.found = None;
        self.dips = [machine.clearance().abs(); 2];
    }
}

/// Returns the motion of the casing in a step that passes much of a side \[m\].
fn long_step(scene: &CheckedScene) -> f64 {
    let machine = scene.machine();
    let polygon = &machine.polygon;
    let side = 2.0 * machine.clearance() * polygon.delta.tan();
    if polygon.has_corners() { LONG_STEP * side } else { f64::INFINITY }
}

/// Returns the number of steps between two observations of the swing of the tips.
fn steps_unseen(scene: &CheckedScene) -> u64 {
    let machine = scene.machine();
    let fastest = match scene.solver.model {
        ModelSize::Full => machine.omega_bd_max,
        ModelSize::Rigid | ModelSize::Modal => machine.omega_bd,
    };
    ((ANGLE_LOOK / (fastest * scene.solver.step_s)) as u64).max(1)
}

impl<B: Disk> Explicit<B> {
    /// Takes one step.
    pub(super) fn take_step_beyond(&mut self) -> Result<(), FailureReason> {
        let force = self.drive.force(self.n);
        self.follow_speed()?;
        let tips = self.tips_at(self.n);
        self.beyond.before = self.u.map(|coordinate| coordinate.increment);
        let mut unknown = self.predict(force);
        unknown |= self.push_lining(&tips);
        let met = self.touch(&tips);
        // Growth is what it is called, whatever it does to the contact.
        unknown |= met.as_ref().is_ok_and(|more| *more) || met.is_err();
        // Modes that only turn have an amplitude that does not grow.
        let within = unknown && self.blades.bound() <= self.watch.largest();
        self.look_at_blades(unknown && !within)?;
        met?;
        if !self.beyond.account.forgone {
            self.count_flows(force);
        }
        Ok(())
    }

    /// Looks for contact and corrects the step by it. Returns whether to look at the blades.
    fn touch(&mut self, tips: &TipLaw) -> Result<bool, FailureReason> {
        let (distance2, bound) = (self.distance2(), self.blades.bound());
        // Beyond it, even the nearest side is open, and above its target.
        let room = tips.least - tips.rise.abs() * bound - self.highest_target();
        if room > 0.0 && distance2 < room * room {
            self.leave_lining();
            self.part();
            return Ok(false);
        }
        self.stays_in_range(distance2)?;
        self.is_outrun(tips)?;
        if self.lining.is_some() {
            self.press(tips, bound);
            return Ok(false);
        }
        self.meet_target(tips, bound)
    }

    /// Checks that the casing surface moves more slowly than the tips along it, as friction
    /// assumes.
    ///
    /// # Errors
    /// It moves faster.
    fn is_outrun(&self, tips: &TipLaw) -> Result<(), FailureReason> {
        if tips.casing_friction == 0.0 {
            return Ok(());
        }
        let [c, s] = self.u.map(|coordinate| coordinate.increment);
        let by_step = self.machine.tangential_ratio / self.drive.step;
        let tip_m_s = self.tip_speed();
        if by_step * by_step * (c * c + s * s) > tip_m_s * tip_m_s {
            let speed_m_s = by_step * c.hypot(s);
            return Err(FailureReason::CasingSpeed { speed_m_s, tip_m_s });
        }
        Ok(())
    }

    /// Returns the speed of the tips along the casing \[m/s\].
    pub(super) fn tip_speed(&self) -> f64 {
        self.drive.speed(self.n).abs() * self.scene.casing.radius_m
    }

    /// Returns the law of the tips at step `n`: the sign of friction follows the rotor.
    pub(super) fn tips_at(&mut self, n: u64) -> TipLaw {
        let speed = self.drive.speed(n);
        if (speed < 0.0) != self.beyond.backward {
            self.beyond.backward = speed < 0.0;
            self.tips = TipLaw::at(&self.machine, speed);
        }
        self.tips
    }

    /// Records a step without contact.
    pub(super) fn part(&mut self) {
        self.open_gap();
        self.beyond.dips = [0.0, self.beyond.dips[0]];
        self.look_at_swing();
    }

    /// Records since when the rows that push are the same.
    pub(super) fn keep_lasting(&mut self) {
        let (mut set, mut count) = (0_u64, 0);
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            set = set.wrapping_add(mark(row.index));
            count += 1;
        }
        let all = count == self.blades.table().count();
        let since = self.beyond.lasting.touch(self.time_of(self.n), set, all);
        if self.record.log.active_set == ActiveSet::Many {
            self.record.log.since = since;
        }
    }

    /// Records how far the tips swing, as often as needed.
    pub(super) fn look_at_swing(&mut self) {
        if self.n >= self.beyond.next_look {
            self.beyond.next_look = self.n + self.beyond.steps_unseen;
            let (t, swing) = (self.time_of(self.n), self.swing_of_blades());
            self.beyond.lasting.look_at_tips(t, swing);
        }
    }

    /// Returns how far the tips swing outward about their mean \[m\].
    pub(super) fn swing_of_blades(&mut self) -> f64 {
        let rise = self.tips.rise.abs();
        if rise == 0.0 { 0.0 } else { rise * self.blades.swing() }
    }

    /// Returns the motion of the casing over the last two steps \[m\].
    pub(super) fn moved(&self) -> [f64; 2] {
        let [c, s] = self.beyond.before;
        [self.u[0].increment + c, self.u[1].increment + s]
    }

    /// Adds the energy flows of the step just taken, except those of contact.
    fn count_flows(&mut self, force: f64) {
        let [c, s] = self.moved();
        let [loss, work] = self.blades.flows();
        let sums = &mut self.beyond.account.sums;
        sums.pulse_work_j += 0.5 * force * c;
        sums.casing_loss_j += self.casing.lost() * (c * c + s * s);
        sums.blade_loss_j += loss;
        sums.pulse_work_j += work;
    }

    /// Returns the energy of casing, blades and lining between the last two steps \[J\].
    pub(super) fn stored(&self) -> f64 {
        if self.leaps.are_ahead() {
            let (u, blades) = self.materialized();
            return self.stored_in(u, &blades);
        }
        self.stored_in(self.u, &self.blades)
    }

    fn stored_in(&self, u: [Coordinate; 2], blades: &B) -> f64 {
        let casing: f64 = u.iter().map(|&at| self.casing.twice_energy(at)).sum();
        // No leap presses a lining.
        let pressed = self.lining.as_ref().filter(|_| !self.leaps.are_ahead());
        let lining = pressed.map_or(0.0, Lining::stored);
        0.5 * casing + blades.energy() + lining
    }

    /// Returns `stored`, or zero in the paper's model, which has no energy account.
    pub(super) fn stored_beyond(&self) -> f64 {
        if self.goes_beyond { self.stored() } else { 0.0 }
    }

    /// Returns whether the energies of casing and blades are too small for another contact.
    pub(super) fn rests(&self) -> bool {
        let clearance = self.tips.least;
        if clearance <= 0.0 || self.drive.excitation.is_some() || self.follows_speed() {
            return false;
        }
        let (u, blades) = self.materialized();
        let tips = self.rise_to_come(&blades);
        let resting = !self.lining.as_ref().is_some_and(Lining::presses);
        resting && tips < clearance && self.casing.reach_of(u).0 + tips < clearance
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::Solver;
    use crate::motion::explicit::{Explicit, ModalBlades};
    use crate::scene::Scene;

    /// Tips that are inclined and rub, under an excitation.
    fn scene(contact: &str) -> Scene {
        let mut scene = Scene::base();
        for (path, value) in [
            ("solver.contact", contact),
            ("solver.step_s", "1e-6"),
            ("contact.stiffness_n_per_m", "1e6"),
            ("contact.friction", "0.1"),
            ("casing.tangential_ratio", "0.3"),
            ("bladed_disk.radial_coupling", "0.2"),
            ("excitation.amplitude_nm", "0.1"),
            ("excitation.order", "3"),
        ] {
            scene.set(path, value).unwrap();
        }
        scene
    }

    /// What a motion has from its parameters.
    fn taken(motion: &Explicit<ModalBlades>) -> String {
        let Explicit { casing, blades, tips, law, lining, drive, neighbours_matter, .. } = motion;
        let lining = lining.as_ref().map(|lining| lining.law);
        let driven = (drive.excitation, motion.beyond.steps_unseen, neighbours_matter);
        let mut fired = motion.clone();
        fired.fire();
        let pulse = fired.pulse().force;
        format!(
            "{casing:?} {:?} {tips:?} {law:?} {lining:?} {driven:?} {pulse}",
            blades.oscillator()
        )
    }

    #[test]
    fn friction_turns_round_with_the_rotor() {
        let mut motion = Explicit::<ModalBlades>::new(&scene("unilateral").checked().unwrap());
        for speed in [300.0, -300.0, -450.0, 200.0] {
            motion.set_speed(speed, 0.0);
            let tips = motion.tips_at(motion.n);
            assert_eq!(tips.friction, 0.1_f64.copysign(speed));
            assert_eq!(tips.casing_friction, motion.machine.casing_friction_at(speed));
        }
    }

    #[test]
    fn a_casing_outruns_the_tips_whichever_way_it_moves() {
        let motion = Explicit::<ModalBlades>::new(&scene("unilateral").checked().unwrap());
        let longest = motion.tip_speed() * motion.drive.step / motion.machine.tangential_ratio;
        for way in 0..8 {
            let (s, c) = (0.7 * f64::from(way)).sin_cos();
            for (part, runs) in [(0.999, false), (1.001, true)] {
                let mut moved = motion.clone();
                moved.u[0].increment = part * longest * c;
                moved.u[1].increment = part * longest * s;
                assert_eq!(moved.is_outrun(&moved.tips).is_err(), runs, "{way} {part}");
            }
        }
    }

    #[test]
    fn the_same_parameters_again_leave_the_ledger_of_a_lining_as_it_is() {
        let scene = Scene::base().with(&[
            ("solver.contact", "smooth"),
            ("solver.step_s", "1e-6"),
            ("casing.radius_m", "0.49988"),
            ("contact.stiffness_n_per_m", "1e5"),
            ("bladed_disk.radial_coupling", "0.3"),
            ("operation.pulse_n", "1e3"),
        ]);
        let scene = scene.unwrap();
        let mut motion = Explicit::<ModalBlades>::new(&scene);
        motion.advance(1e-3).unwrap();
        let mut again = motion.clone();
        again.set_parameters(&scene);
        let [a, b] = [&mut motion, &mut again].map(|motion| {
            motion.advance(2e-3).unwrap();
            motion.energy_account().unwrap().residual()
        });
        assert!((a - b).abs() < 1e-11 * motion.stored(), "{a:e} {b:e}");
    }

    #[test]
    fn a_running_motion_takes_over_each_parameter_and_its_ledger_goes_on() {
        let turns = [
            ("casing.damping_ratio", "0.2"),
            ("casing.modal_stiffness_n_per_m", "5e5"),
            ("casing.tangential_ratio", "0.1"),
            ("bladed_disk.damping_ratio", "0.2"),
            ("bladed_disk.stiffness_nm_per_rad", "5e3"),
            ("bladed_disk.radial_coupling", "0.4"),
            ("contact.friction", "0.3"),
            ("excitation.amplitude_nm", "0.2"),
            ("operation.pulse_n", "3e4"),
        ];
        for contact in ["unilateral", "smooth"] {
            let from = scene(contact);
            let mut motion = Explicit::<ModalBlades>::new(&from.checked().unwrap());
            motion.advance(2e-3).unwrap();
            for (path, value) in turns {
                let mut to = from.clone();
                to.set(path, value).unwrap();
                let to = to.checked().unwrap();
                let mut turned = motion.clone();
                turned.set_parameters(&to);
                let fresh = Explicit::<ModalBlades>::new(&to);
                assert_eq!(taken(&turned), taken(&fresh), "{contact}: {path}");
                assert_ne!(taken(&turned), taken(&motion), "{contact}: {path}");
                let [now, before] = [&turned, &motion].map(|of| of.energy_account().unwrap());
                let apart = (now.stored_j - before.stored_j).abs();
                assert!(apart < 1e-12 * motion.stored(), "{contact}: {path} {apart:e}");
                // Gaps of the steps before may be others now.
                assert_eq!(turned.beyond.dips, [turned.machine.clearance(); 2]);
            }
            let before = motion.energy_account().unwrap().stored_j;
            let stored = motion.stored();
            motion.fire();
            let apart = (motion.energy_account().unwrap().stored_j - before).abs();
            assert!(apart < 1e-12 * stored, "{contact} {apart:e}");
        }
    }
}
