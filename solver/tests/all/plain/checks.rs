//! What the program and the plain stepper must agree on, each to its round-off.

use rubscope_solver::motion::{ActiveSet, Verdict, verdict_of};
use rubscope_solver::scene::ModelSize;

use super::compare::{Pair, ROOM, distance};

impl Pair {
    /// Casing, blades, multipliers and records agree, each to its own round-off.
    pub fn check(&self, what: &str) {
        let (motion, plain) = (&self.motion, &self.plain);
        assert_eq!(motion.steps(), Some(plain.steps()), "{what}: steps");
        let state = motion.state();
        assert!((state.t_s - plain.time()).abs() <= 4.0 * f64::EPSILON * state.t_s, "{what}: time");
        if self.is_chaotic() {
            return;
        }
        let allowed = self.round_off();
        let apart = distance(state.u, plain.u());
        assert!(
            apart <= allowed,
            "{what}: u {:?} plain {:?}, {apart:e} apart, allowed {allowed:e} (amplified {:e}) at {}",
            state.u,
            plain.u(),
            self.amplified,
            state.t_s
        );
        self.check_rates(what, allowed);
        self.check_blades(what);
        self.check_multipliers(what, allowed);
        self.check_records(what, allowed);
    }

    fn check_rates(&self, what: &str, allowed: f64) {
        let (found, expected) = (self.motion.state().v, self.plain.rates());
        let apart = distance(found, expected);
        let omega = self.scene.machine().omega_c;
        let nu = self.scene.machine().nu(self.motion.rotor().speed(self.plain.time())).abs();
        let mut allowed = allowed * (omega + nu) + ROOM * self.jitter() / self.h();
        if self.is_meeting() {
            allowed += self.round_off() / self.h();
        }
        assert!(
            apart <= allowed,
            "{what}: v {found:?} plain {expected:?}, {apart:e} of {allowed:e}"
        );
    }

    /// Whether an impact is under way or just over: it takes two steps, and the
    /// position it begins at says how it is shared between them.
    fn is_meeting(&self) -> bool {
        let latest = self.plain.impacts.last().map_or(0.0, |impact| impact.0);
        latest > 0.0 && self.plain.time() < latest + 4.5 * self.h()
    }

    /// Blades answer impulses: the same relative error, on their own scale. The
    /// moment arm of an impulse adds the error of a position, and so does the
    /// excess push of the latest few steps, which the next ones correct.
    fn check_blades(&self, what: &str) {
        let relative = self.round_off() / self.clearance();
        let (found, expected) = (self.motion.blade_angles(), self.plain.blade_angles());
        assert_eq!(found.len(), expected.len(), "{what}: blades");
        let machine = self.scene.machine();
        let inertia = match self.scene.solver.model {
            ModelSize::Full => machine.blade_inertia,
            ModelSize::Rigid | ModelSize::Modal => machine.blade_modal_mass,
        };
        let moment_arm = ROOM * self.amplified * machine.nodal_diameters * self.jitter();
        let levers = moment_arm * self.plain.impulse / (inertia * machine.omega_bd);
        let push = 4.0 * moment_arm * self.clearance() * machine.casing_mass
            / (inertia * self.acuteness());
        // Levers of exactly zero are 1e-32 in double-double.
        let allowed = (relative + 1e-13) * self.plain.widest + levers + push + 1e-30;
        for (blade, (a, b)) in found.iter().zip(&expected).enumerate() {
            assert!(
                (a - b).abs() <= allowed,
                "{what}: blade {} at {a:e}, plain {b:e}, {:e} of {allowed:e} apart",
                blade + 1,
                (a - b).abs()
            );
        }
        for (a, b) in self.motion.state().alpha.iter().zip(self.plain.modal()) {
            assert!((a - b).abs() <= 2.0 * allowed, "{what}: modes {a:e} {b:e}");
        }
    }

    /// The multipliers alone.
    pub fn check_multipliers_now(&self, what: &str) {
        self.check_multipliers(what, self.round_off());
    }

    /// A multiplier is a second difference of positions; those of a corner push
    /// against each other, which costs the sine of its angle once more, and only
    /// the blades distinguish three sides.
    fn check_multipliers(&self, what: &str, allowed: f64) {
        let found = self.motion.multipliers();
        let mut expected = if self.plain.in_contact() { self.plain.multipliers() } else { &[] };
        let m = self.scene.machine();
        let (h, largest) = (self.h(), expected.iter().fold(0.0_f64, |s, x| s.max(x.1.abs())));
        let mass = m.casing_mass + 0.5 * h * m.casing_damping;
        let mut tolerance = ROOM * self.jitter() * mass / (h * h) / self.acuteness()
            + allowed * m.casing_mass * m.omega_c * (m.omega_c + 1.0 / h)
            + if expected.len() > 2 { 1e-8 } else { 1e-12 } * largest;
        if self.is_meeting() {
            tolerance += allowed * mass / (h * h);
        }
        let mut sorted: Vec<(u32, f64)> = found.clone();
        // Rows that end with no push are no contact.
        sorted.retain(|(_, value)| *value != 0.0);
        sorted.sort_by_key(|&(side, _)| side);
        if expected.len() != sorted.len() {
            expected = &[];
        }
        assert_eq!(
            sorted.len(),
            expected.len(),
            "{what}: {found:?} {:?}",
            self.plain.multipliers()
        );
        for (a, b) in sorted.iter().zip(expected) {
            assert!(
                a.0 == b.0 && (a.1 - b.1).abs() <= tolerance,
                "{what}: multipliers {found:?} plain {:?}, allowed {tolerance:e}",
                self.plain.multipliers()
            );
        }
    }

    /// Mean forces since the latest look: a change of momentum, so their error
    /// is that of a rate.
    pub(super) fn check_impulses(&mut self) {
        let (now, before) = (self.plain.time(), self.looked);
        let mut found = vec![0.0; self.plain.impulses.len()];
        for (side, force) in self.motion.take_mean_forces() {
            found[side as usize] = force * (now - before);
        }
        self.impulses.resize(found.len(), 0.0);
        let m = self.scene.machine();
        let rate = self.round_off() * m.omega_c + ROOM * self.jitter() / self.h();
        let mut allowed = 2.0 * m.casing_mass * rate / self.acuteness() + 1e-30;
        if self.is_meeting() {
            allowed += m.casing_mass * self.round_off() / self.h();
        }
        if !self.is_chaotic() {
            for (side, a) in found.iter().enumerate() {
                let b = self.plain.impulses[side] - self.impulses[side];
                let total = 1e-12 * self.plain.impulse;
                assert!(
                    (a - b).abs() <= allowed + total,
                    "impulse on side {side} {a} plain {b}, {:e} of {allowed:e}, until {now}",
                    (a - b).abs()
                );
            }
        }
        self.impulses.clone_from(&self.plain.impulses);
        self.looked = now;
    }

    fn check_records(&self, what: &str, allowed: f64) {
        let (log, plain) = (self.motion.contacts(), &self.plain);
        let half = 0.5 * self.h();
        assert_eq!(log.impact_count, plain.impacts.len() as u64, "{what}: impacts");
        // Sides met in the same step have no order.
        let ordered = |impacts: Vec<(f64, u32)>| {
            let mut steps: Vec<(u64, u32)> =
                impacts.iter().map(|(t, side)| ((t / self.h()).round() as u64, *side)).collect();
            steps.sort_unstable();
            steps
        };
        let found = ordered(log.impacts.iter().map(|impact| (impact.t_s, impact.side)).collect());
        let expected = ordered(plain.impacts.clone());
        assert!(
            found == expected[..found.len()],
            "{what}: impacts {found:?} plain {expected:?} (in steps)"
        );
        assert_eq!(log.tensile_steps, plain.tensile_steps, "{what}: tensile steps");
        let sides: Vec<u32> = plain.history().spans.last().map_or(Vec::new(), |s| s.sides.clone());
        let expected = if plain.in_contact() { ActiveSet::of(&sides) } else { ActiveSet::Nothing };
        assert_eq!(log.active_set, expected, "{what}: sides in contact");
        let kept = plain.kept_since();
        if let Some(since) = kept {
            assert!((log.since - since).abs() < half, "{what}: since {} {since}", log.since);
        }
        let unbroken = plain.history().unbroken_since(plain.steps()).map(|n| n as f64 * self.h());
        assert_eq!(log.unbroken_since.is_some(), unbroken.is_some(), "{what}: unbroken");
        for (a, b) in log.unbroken_since.iter().zip(unbroken) {
            assert!((a - b).abs() < half, "{what}: unbroken since {a} {b}");
        }
        let checks = self.motion.checks();
        let left = (checks.max_penetration_m - plain.deepest).abs();
        // A gap rounds as the clearance does, and the square of a bend twice as the bend.
        let rounds = 1e-15 * self.clearance() + 1e-11 * self.amplified * plain.deepest;
        assert!(left <= rounds + 1e-3 * plain.deepest, "{what}: {checks:?} {:e}", plain.deepest);
        let deepest = checks.max_predicted_penetration_m.unwrap_or(f64::NAN);
        assert!(
            (deepest - plain.deepest_predicted).abs() <= allowed + 1e-12 * deepest,
            "{what}: deepest {deepest:e} {:e}",
            plain.deepest_predicted
        );
    }

    /// The verdict over the last `window` seconds, from the plain history alone.
    pub fn check_verdict(&self, what: &str, window: f64) {
        if self.is_chaotic() || self.plain.time() < 1.1 * window {
            return;
        }
        let found = verdict_of(&self.motion, window);
        // A window may begin a step earlier or later.
        let shifted = [0.0, 1.5, -1.5].map(|steps| window + steps * self.h());
        let mut expected: Vec<Verdict> = shifted.map(|window| self.lasting(window)).to_vec();
        // The energy of the scheme differs from that of the motion by h omega/2.
        let (reach, margin) = (self.reach(), self.scene.machine().omega_c * self.h());
        if reach < 1.0 + margin {
            if reach < 1.0 - margin {
                expected.clear();
            }
            expected.push(Verdict::Decay);
        }
        assert!(expected.contains(&found), "{what}: {found}, expected {expected:?}");
    }

    /// How far the casing can still move with its energy, in clearances;
    /// infinite while a pulse acts.
    fn reach(&self) -> f64 {
        let (plain, m) = (&self.plain, self.scene.machine());
        let [u, v] = [plain.u(), plain.rates()].map(|x| x[0].hypot(x[1]));
        let reach = v.hypot(m.omega_c * u) / (m.omega_c * m.clearance());
        if plain.is_pulsed() { f64::INFINITY } else { reach }
    }

    /// The lasting motion, by contacts alone. Later checks must confirm a
    /// verdict that the program calls certain.
    fn lasting(&self, window: f64) -> Verdict {
        let locked =
            matches!(self.motion.final_verdict(), Some(Verdict::Locked | Verdict::Adhesive));
        let held = self.plain.window(if locked { 32.0 * self.h() } else { window });
        if held.kept.is_some_and(|sides| sides.len() > 1) {
            return if held.pulled { Verdict::Adhesive } else { Verdict::Locked };
        }
        let all = self.plain.window(window);
        match (all.unbroken, all.touched) {
            (true, _) => Verdict::Slip,
            (false, true) => Verdict::Bounce,
            (false, false) => Verdict::Decay,
        }
    }
}
