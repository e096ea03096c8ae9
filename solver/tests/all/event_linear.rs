//! The event solver of what goes beyond the paper's model: reference motions from
//! independent codes, and agreement with the paper's event solver where both apply.

use crate::close;
use crate::keys::{KAPPA, MU, PULSE, SPEED, TAU, ZETA};
use rubscope_solver::motion::{
    ExactEvents, LinearEvents, Motion, Sample, Sampling, Script, Solver, Verdict, run_to_end,
};
use rubscope_solver::scene::{CheckedScene, Scene};

const REBOUND: &str = "contact.restitution";

pub fn scene(model: &str, changes: &[(&str, f64)]) -> CheckedScene {
    crate::event_cases::scene_of(model, changes).checked().unwrap()
}

/// The impulse of an impact \[N s\], from the jump of the casing's rate.
fn impulse(scene: &CheckedScene, t: f64, casing_friction: f64) -> f64 {
    let rate = |until: f64| {
        let mut motion = LinearEvents::new(scene);
        motion.advance(until).unwrap();
        motion.state().v
    };
    let ([x, y], [u, v]) = (rate(t - 1e-14), rate(t + 1e-14));
    2.0 * (u - x).hypot(v - y) / 1_f64.hypot(casing_friction)
}

#[test]
fn a_pulse_from_rest_gives_the_impacts_and_the_state_of_two_other_codes() {
    // kappa, mu, tau, speed, pulse; impacts; u and alpha at 3 ms.
    let third = 1.0 / 3.0;
    let rows = [
        (
            [0.0, 0.15, third, 500.0, 2e4],
            2,
            [(2.282193119e-4, 19, 0.947924652), (2.832963790e-4, 4, 0.064438654)],
            [-7.922536056e-5, -3.104829819e-5, 7.604223474e-5, -2.379975693e-5],
        ),
        (
            [0.1, 0.15, 0.0, 500.0, 2e4],
            2,
            [(2.282193119e-4, 19, 0.942782203), (2.926811221e-4, 4, 0.051539822)],
            [-7.402036377e-5, -1.518005149e-5, 1.246661342e-4, -3.856202900e-5],
        ),
        (
            [0.3, 0.0, 0.0, 450.0, 1e5],
            13,
            [(6.524747608e-5, 12, 4.840636832), (8.203355149e-5, 19, 0.169506552)],
            [-7.172602518e-5, 4.70840646e-6, 8.219805653e-4, -9.535922915e-5],
        ),
        (
            [-0.15, 0.3, 0.0, 280.0, 3e5],
            21,
            [(3.654455708e-5, 12, 10.987527851), (7.485125456e-5, 19, 0.156075131)],
            [1.277824521e-4, 2.83963907e-5, 1.249771904e-3, -8.80750795e-6],
        ),
    ];
    for ([kappa, mu, tau, speed, pulse], count, impacts, at_3_ms) in rows {
        let keys = [(KAPPA, kappa), (MU, mu), (TAU, tau), (SPEED, speed), (PULSE, pulse)];
        let scene = scene("modal", &keys);
        let mut motion = LinearEvents::new(&scene);
        motion.advance(3e-3).unwrap();
        let log = motion.contacts();
        assert_eq!(log.impact_count, count);
        for (found, (t, blade, expected)) in log.impacts.iter().zip(impacts) {
            // Ten digits are printed.
            close(found.t_s, t, 6e-10 * t);
            assert_eq!(motion.machine().polygon.blades_of_side(found.side), [blade]);
            // Up to 300 kN act on the casing in between.
            close(impulse(&scene, found.t_s, mu * tau), expected, 3e-8);
        }
        let state = motion.state();
        let found = [state.u, state.alpha].concat();
        for (pair, expected) in found.chunks(2).zip(at_3_ms.chunks(2)) {
            // Nine to ten digits are printed.
            let size = f64::hypot(expected[0], expected[1]);
            close(pair[0], expected[0], 8e-10 * size);
            close(pair[1], expected[1], 8e-10 * size);
        }
    }
}

#[test]
fn a_rebound_comes_back_as_it_should() {
    for (e, expected) in [
        (0.5, vec![(2.282193119e-4, 19), (1.084411777e-3, 14), (2.525766754e-3, 8)]),
        (0.8, vec![(2.282193119e-4, 19), (7.659427621e-4, 22), (1.475382593e-3, 3)]),
    ] {
        let scene = scene("rigid", &[(REBOUND, e)]);
        let mut motion = Motion::new(&scene);
        motion.advance(1e-2).unwrap();
        for (found, (t, blade)) in motion.contacts().impacts.iter().zip(expected) {
            // The reference has blades that turn a little: 6e-9 at the third impact.
            close(found.t_s, t, 6e-9 * t);
            assert_eq!(motion.machine().polygon.blades_of_side(found.side), [blade]);
        }
        assert!(motion.checks().energy_residual_j.unwrap().abs() < 1e-14);
    }
    // Case C.
    let scene = scene("rigid", &[(REBOUND, 0.8), (PULSE, 51742.0), (ZETA, 0.0)]);
    let mut motion = Motion::new(&scene);
    motion.advance(0.1).unwrap();
    assert_eq!(motion.final_verdict(), Some(Verdict::Locked));
}

#[test]
fn rigid_blades_without_friction_move_as_the_papers_event_solver_says() {
    for (name, ends) in [
        ("base", vec![1e-3, 3e-3, 0.1]),
        ("rocking", vec![0.01, 0.05, 0.2]),
        ("slip", vec![0.005, 0.01]),
        ("grazing", vec![1e-3, 0.1]),
    ] {
        let mut scene = match name {
            "base" => Scene::base(),
            name => Scene::builtin(name).unwrap(),
        }
        .as_reference();
        scene.set("solver.model", "rigid").unwrap();
        let scene = scene.checked().unwrap();
        assert!(!scene.goes_beyond());
        let (mut paper, mut joined) =
            (ExactEvents::new(&scene).unwrap(), LinearEvents::new(&scene));
        for t in ends {
            paper.advance(t).unwrap();
            joined.advance(t).unwrap();
            let (expected, found) = (paper.state(), joined.state());
            let g0 = scene.clearance();
            for (a, b) in expected.u.into_iter().zip(found.u) {
                close(b, a, 1e-9 * g0);
            }
            for (a, b) in expected.v.into_iter().zip(found.v) {
                close(b, a, 1e-9 * g0 * joined.machine().omega_c);
            }
            assert_eq!(paper.contacts().active_set, joined.contacts().active_set, "{name} {t}");
            close(joined.contacts().since, paper.contacts().since, 1e-9 * t);
            assert_eq!(paper.final_verdict(), joined.final_verdict(), "{name} {t}");
            for ((side, a), (other, b)) in paper.multipliers().into_iter().zip(joined.multipliers())
            {
                assert_eq!(side, other);
                close(b, a, 1e-9 * a.abs());
            }
        }
        assert!(joined.checks().energy_residual_j.unwrap().abs() < 1e-11, "{name}");
        assert!(!joined.linearised());
    }
}

/// The next change of the sides in contact after `t`, before which nothing changes in
/// `step` seconds \[s\].
fn next_side(motion: &mut Motion, step: f64) -> f64 {
    let since = motion.contacts().since;
    for _ in 0..1000 {
        let until = motion.t_s() + step;
        motion.advance(until).unwrap();
        if motion.contacts().since != since {
            return motion.contacts().since;
        }
    }
    panic!("the wave stands still");
}

#[test]
fn the_whirl_turns_as_the_fixed_point_of_its_passing_says() {
    // kappa, mu, first speed, speed, pulse; passing time, mean push, impulse of the
    // corner, max |z|, max |a|.
    for ([kappa, mu, first, speed, pulse], [passing, push, corner, z, a]) in [
        (
            [0.3, 0.0, 450.0, 420.0, 1e5],
            [1.031892446e-3, 72.875203, 0.0170549600, 1.709318e-4, 5.7190e-4],
        ),
        (
            [0.3, 0.0, 450.0, 450.0, 1e5],
            [1.094461687e-3, 183.189019, 0.0170610436, 2.153966e-4, 7.9071e-4],
        ),
        (
            [0.3, 0.0, 500.0, 500.0, 1e5],
            [1.200812268e-3, 440.275279, 0.0180105761, 2.654851e-4, 1.10548e-3],
        ),
        (
            [0.3, 0.15, 450.0, 450.0, 1e5],
            [1.127385385e-3, 281.519514, 0.0172582322, 3.184557e-4, 1.47153e-3],
        ),
        (
            [-0.15, 0.3, 300.0, 300.0, 3e5],
            [9.440509250e-4, 181.306383, 0.0179329119, 1.330297e-4, 5.01028e-4],
        ),
    ] {
        let keys = [(KAPPA, kappa), (MU, mu), (SPEED, first), (PULSE, pulse)];
        let mut motion = Motion::new(&scene("modal", &keys));
        motion.advance(0.3).unwrap();
        motion.set_speed(speed, 0.0);
        motion.advance(4.0).unwrap();
        let from = next_side(&mut motion, 1e-4);
        let to = next_side(&mut motion, 1e-4);
        // Six digits and more; a difference of two instants has lost some.
        close(to - from, passing, 3e-9 * passing + 2e-15);
        let (mut widest, mut swing, mut mean) = (0.0_f64, 0.0_f64, 0.0);
        let looks = 2000;
        // The casing is farthest where the next blade comes.
        let from = to + passing;
        motion.advance(from).unwrap();
        widest = widest.max(motion.state().amplitude());
        for look in 0..looks {
            motion.advance(from + passing * (f64::from(look) + 0.5) / f64::from(looks)).unwrap();
            let state = motion.state();
            widest = widest.max(state.amplitude());
            swing = swing.max(state.alpha[0].hypot(state.alpha[1]));
            let pushes: f64 = motion.multipliers().iter().map(|(_, force)| -force).sum();
            mean += pushes / f64::from(looks);
        }
        close(widest, z, 3e-6 * z);
        close(swing, a, 1e-4 * a);
        // Impacts are no forces: each has its share of the mean.
        close(mean + corner / passing, push, 2e-4 * push);
        assert!(motion.checks().energy_residual_j.unwrap().abs() < 1e-9);
    }
}

#[test]
fn a_divergent_run_ends_in_one_state_with_its_energy() {
    let keys = [(KAPPA, 0.58), (MU, 0.27), (SPEED, 517.0), (PULSE, 15699.0)];
    let mut scene = scene("modal", &keys).into_scene();
    scene.solver.end_s = 0.05;
    let scene = scene.checked().unwrap();
    let mut last = None;
    let sampling = Sampling { intervals: 200_000, gaps: false };
    let mut keep = |sample: &Sample| last = Some(sample.state);
    let report = run_to_end(&scene, &Script::default(), sampling, &mut keep);
    assert_eq!(report.outcome.verdict, Verdict::Divergent);
    let (last, end) = (last.unwrap(), &report.r#final);
    // A quarter of a microsecond between samples: nothing moves far.
    let later = end.t_s - last.t_s;
    assert!((0.0..=2.5e-7).contains(&later), "{later}");
    let moved = (end.alpha_c_rad - last.alpha[0]).hypot(end.alpha_s_rad - last.alpha[1]);
    let rate = last.alpha_rate[0].hypot(last.alpha_rate[1]);
    assert!(moved <= 1.1 * rate * later + 1e-12, "{moved} in {later}");
    assert!(end.alpha_c_rad.hypot(end.alpha_s_rad) > 0.1, "the state is that which was told");
    let ledger = report.energy.unwrap();
    let residual = report.checks.energy_residual_j.unwrap();
    assert!((ledger.residual() - residual).abs() <= 1e-9 * ledger.stored_j);
    assert!(residual.abs() <= 1e-9 * ledger.stored_j, "{residual} of {ledger:?}");
    assert!(ledger.friction_heat_j > 0.0 && ledger.rotor_work_j > ledger.stored_j, "{ledger:?}");
    let message = report.outcome.message.unwrap();
    assert!(message.starts_with("left the range of the model at t = 2.6"), "{message}");
}
