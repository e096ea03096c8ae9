//! Each shortcut of the explicit solver gives the result of plain steps: random scenes with
//! live changes, without one shortcut at a time, with all and with none.

use rubscope_solver::motion::{Change, Motion, simulate, verdict_of};
use rubscope_solver::scene::{CheckedScene, ContactLaw, ModelSize, Scene, Shortcuts};

use crate::live_random::Dice;
use crate::plain::scenes::in_corner;

/// Every way to take shortcuts but plain steps.
fn ways() -> [Shortcuts; 6] {
    let all = Shortcuts::default();
    [
        all,
        Shortcuts { flight: false, ..all },
        Shortcuts { lock: false, ..all },
        Shortcuts { slide: false, ..all },
        Shortcuts { proofs: false, ..all },
        Shortcuts { proofs: true, ..Shortcuts::NONE },
    ]
}

/// A machine of the paper or beyond it, on a rigid casing or a lining.
fn random_scene(dice: &mut Dice) -> CheckedScene {
    loop {
        let mut scene = Scene::base();
        let rings = [(22, 3), (22, 3), (22, 4), (22, 11), (13, 2), (12, 3), (40, 7), (5, 1)];
        (scene.bladed_disk.blades, scene.operation.nodal_diameters) = dice.one_of(&rings);
        scene.solver.model =
            dice.one_of(&[ModelSize::Rigid, ModelSize::Modal, ModelSize::Modal, ModelSize::Full]);
        scene.solver.contact = dice.one_of(&[
            ContactLaw::Unilateral,
            ContactLaw::Unilateral,
            ContactLaw::Bilateral,
            ContactLaw::Smooth,
        ]);
        scene.solver.step_s = dice.one_of(&[1e-6, 2e-6, 4e-6]);
        scene.casing.damping_ratio = dice.one_of(&[0.0, 0.02, 0.05, 0.3]);
        scene.bladed_disk.damping_ratio = dice.one_of(&[0.0, 0.02, 0.1]);
        scene.bladed_disk.inertia_kg_m2 *= dice.scale(0.1, 1.0);
        scene.operation.speed_rad_s = dice.between(100.0, 550.0) * dice.one_of(&[1.0, 1.0, -1.0]);
        scene.operation.pulse_n = dice.scale(3e2, 2e5);
        if scene.solver.contact == ContactLaw::Smooth {
            scene.contact.stiffness_n_per_m = dice.scale(1e4, 1e7);
            scene.contact.smoothing_m = dice.one_of(&[0.0, 1e-6, 2e-5]);
            scene.casing.radius_m = dice.one_of(&[0.49988, 0.49989, 0.5, 0.5]);
        }
        if dice.chance(0.6) {
            scene.bladed_disk.radial_coupling = dice.one_of(&[0.0, 0.05, 0.3, -0.2]);
            scene.contact.friction = dice.one_of(&[0.0, 0.0, 0.1, 0.3]);
            scene.casing.tangential_ratio = dice.one_of(&[0.0, 0.0, 0.3]);
            if scene.solver.contact != ContactLaw::Smooth {
                scene.contact.restitution = dice.one_of(&[0.0, 0.0, 0.0, 0.5]);
            }
        }
        if dice.chance(0.1) {
            scene.operation.speed_ramp_rad_s2 = dice.between(-5e3, 5e3);
        }
        let corners = scene.machine().polygon.has_corners() && scene.machine().clearance() > 0.0;
        if dice.chance(0.3) && corners && scene.checked().is_ok() {
            scene = in_corner(scene);
        }
        if let Ok(scene) = scene.checked() {
            return scene;
        }
    }
}

/// A live change of a scene.
fn random_change(dice: &mut Dice, scene: &mut Scene) -> Vec<Change> {
    let before = scene.clone();
    match dice.bits() % 6 {
        0 => return vec![Change::Pulse],
        1 => scene.operation.speed_rad_s *= dice.between(0.8, 1.2),
        2 => scene.casing.damping_ratio = dice.one_of(&[0.0, 0.02, 0.2]),
        3 => scene.bladed_disk.damping_ratio = dice.one_of(&[0.0, 0.03, 0.3]),
        4 => scene.casing.modal_stiffness_n_per_m *= dice.between(0.8, 1.25),
        _ => scene.bladed_disk.stiffness_nm_per_rad *= dice.between(0.9, 1.5),
    }
    match (before.clone().checked(), scene.clone().checked()) {
        (Ok(old), Ok(new)) if Change::is_live(&old, &new) => Change::between(&old, &new),
        _ => {
            *scene = before;
            Vec::new()
        }
    }
}

/// What one way makes of a scene, looked at at these instants.
struct Run {
    motion: Motion,
    scene: Scene,
    shortcuts: Shortcuts,
    ended: bool,
}

impl Run {
    fn new(scene: &CheckedScene, shortcuts: Shortcuts) -> Self {
        let motion = Motion::new(&scene.clone().with_shortcuts(shortcuts));
        Self { motion, scene: scene.clone().into_scene(), shortcuts, ended: false }
    }

    fn apply(&mut self, changes: &[Change]) {
        for change in changes {
            match change {
                Change::Parameters(scene) => {
                    let scene = scene.clone().with_shortcuts(self.shortcuts);
                    self.motion.apply(&Change::Parameters(Box::new(scene)));
                }
                other => self.motion.apply(other),
            }
        }
    }

    fn advance(&mut self, until: f64) {
        self.ended |= self.motion.advance(until).is_err();
    }

    /// Numbers of the motion, each in parts of its scale.
    fn numbers(&mut self) -> Vec<f64> {
        let machine = self.scene.machine();
        let length = machine.clearance().abs();
        let angle = length / machine.blade_length.max(machine.radial_coupling.abs());
        let (state, checks) = (self.motion.state(), self.motion.checks());
        let mut numbers = vec![checks.max_penetration_m / length];
        numbers.extend(state.u.map(|u| u / length));
        numbers.extend(state.v.map(|v| v / (length * machine.omega_c)));
        numbers.extend(state.alpha.map(|alpha| alpha / angle));
        numbers
    }

    /// The ledger of energy, in parts of what the casing stores at the clearance.
    fn ledger(&self) -> Vec<f64> {
        let Some(account) = self.motion.energy_account() else { return Vec::new() };
        let machine = self.scene.machine();
        let energy = machine.casing_stiffness * machine.clearance().powi(2);
        let sums = [account.rotor_work_j, account.casing_loss_j, account.blade_loss_j];
        let heat = [account.friction_heat_j, account.impact_loss_j, account.stored_j];
        sums.into_iter().chain(heat).map(|sum| sum / energy).collect()
    }
}

/// The largest difference of two lists of numbers, in parts of one or of their size.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let parts = a.iter().zip(b).map(|(a, b)| (a - b).abs() / (1.0 + a.abs().max(b.abs())));
    parts.fold(0.0, f64::max)
}

/// A change of the pulse, and of the rate at each look, by this part shows how the motion amplifies what is different.
const NUDGE: f64 = 1e-9;
/// What a leap leaves out, as a part of that: the map of a lock leaves out up to 1e-10.
const LEFT_OUT: f64 = 0.1;
/// Round-off of the steps between two looks, where nothing is amplified.
const ROUND_OFF: f64 = 1e-11;
/// What the sums over the steps of a held lock leave out of its ledger.
const LEDGER: f64 = 1e-9;
/// Beyond it, the motion is chaotic and nothing is compared.
const CHAOS: f64 = 1e-4;

/// Compares one scene by every way; how many looks were compared, and steps skipped.
fn compare(seed: u64, steps: u32) -> (u32, u64) {
    let mut dice = Dice(seed);
    let scene = random_scene(&mut dice);
    let end = f64::from(steps) * scene.solver.step_s;
    let mut scene = scene.into_scene();
    scene.solver.end_s = end;
    let Ok(scene) = scene.checked() else { return (0, 0) };
    let mut nudged = scene.clone().into_scene();
    nudged.operation.pulse_n *= 1.0 + NUDGE;
    nudged.initial.u_c_m *= 1.0 - NUDGE;
    nudged.initial.u_s_m *= 1.0 - NUDGE;
    let mut beside = Run::new(&nudged.checked().unwrap(), Shortcuts::NONE);
    let mut plain = Run::new(&scene, Shortcuts::NONE);
    let mut runs = ways().map(|way| Run::new(&scene, way));
    let (mut now, mut told, mut amplified) = (scene.clone().into_scene(), String::new(), 0.0_f64);
    let looks = 16;
    let changes = dice.bits() % 3;
    for look in 1..=looks {
        let until = end * f64::from(look) / f64::from(looks);
        plain.advance(until);
        beside.advance(until);
        beside.motion.scale_rate(1.0 + NUDGE);
        let expected = plain.numbers();
        amplified = amplified.max(apart(&expected, &beside.numbers()));
        let counts = [&plain, &beside].map(|run| run.motion.contacts().impact_count);
        if amplified > CHAOS || counts[0] != counts[1] || plain.ended != beside.ended {
            return (look - 1, 0);
        }
        for run in &mut runs {
            run.advance(until);
            let what = format!("seed {seed} at {until:e}, {:?}: {scene:?}{told}", run.shortcuts);
            assert_eq!(
                run.ended,
                plain.ended,
                "{:?} {:?} {what}",
                run.motion.failure(),
                plain.motion.failure()
            );
            let allowed = ROUND_OFF + LEFT_OUT * amplified;
            for (found, expected, allowed) in [
                (run.numbers(), &expected, allowed),
                (run.ledger(), &plain.ledger(), allowed + LEDGER),
            ] {
                let error = apart(&found, expected);
                assert!(error < allowed, "{error:e} of {allowed:e}: {found:?} {expected:?} {what}");
            }
            // The top of a swing falls between two steps.
            let turn = run.scene.machine().omega_bd_max * run.scene.solver.step_s;
            let [most, expected_most] =
                [&run.motion, &plain.motion].map(|motion| motion.checks().max_blade_angle_rad);
            let error = (most - expected_most).abs() / expected_most.max(1e-300);
            assert!(error < allowed + turn * turn, "{most:e} {expected_most:e} {what}");
            let logs = [&*run, &plain].map(|run| {
                let log = run.motion.contacts();
                (log.impact_count, log.tensile_steps, log.active_set, log.since, log.last_contact)
            });
            assert_eq!(logs[0], logs[1], "{what}");
        }
        if plain.ended {
            return (look, 0);
        }
        if u64::from(look % 4 == 0) * changes > 0 && look < looks {
            let change = random_change(&mut dice, &mut now);
            told += &format!("\n at {until:e}: {change:?}");
            for run in runs.iter_mut().chain([&mut plain, &mut beside]) {
                run.apply(&change);
            }
        }
    }
    let window = 0.1 * end;
    let expected = verdict_of(&plain.motion, window);
    for run in &runs {
        let found = run.motion.lasting(window);
        assert_eq!(found, expected, "seed {seed} {:?}: {scene:?}{told}", run.shortcuts);
        // That a wave on a lining will die is known before it is seen.
        let proved = run.motion.final_verdict();
        if let Some(proved) = proved.filter(|_| scene.solver.contact != ContactLaw::Smooth) {
            assert_eq!(proved, expected, "seed {seed} {:?}: {scene:?}{told}", run.shortcuts);
        }
    }
    (looks, runs[0].motion.steps_skipped().unwrap())
}

#[test]
fn every_shortcut_gives_what_plain_steps_give() {
    let found: Vec<_> = (0..300).map(|seed| compare(seed, 6000)).collect();
    let whole = found.iter().filter(|(looks, _)| *looks == 16).count();
    let skipped = found.iter().filter(|(_, skipped)| *skipped > 1000).count();
    assert!(whole > 150 && skipped > 40, "{whole} {skipped}");
}

#[test]
fn flights_beyond_the_paper_are_leapt() {
    let keys =
        [("solver.kind", "explicit"), ("solver.step_s", "1e-6"), ("operation.pulse_n", "1000")];
    let rub =
        Scene::builtin("rub").unwrap().with(&[&keys[..], &[("solver.end_s", "0.5")]].concat());
    let scene = rub.unwrap().checked().unwrap();
    let [leapt, plain] = [Shortcuts::default(), Shortcuts::NONE]
        .map(|shortcuts| simulate(&scene.clone().with_shortcuts(shortcuts)));
    assert_eq!(plain.solver.steps_skipped, Some(0));
    assert!(leapt.solver.steps.unwrap() < 1000, "{:?}", leapt.solver);
    assert_eq!(leapt.outcome.verdict, plain.outcome.verdict);
    // What is left after 0.5 s is nothing; the ledger is that of the whole run.
    let [a, b] = [leapt.energy, plain.energy].map(Option::unwrap);
    let apart = (a.casing_loss_j - b.casing_loss_j).abs();
    assert!(apart < 1e-11 * a.casing_loss_j, "{a:?} {b:?}");
}
