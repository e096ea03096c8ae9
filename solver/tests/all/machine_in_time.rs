//! A machine that changes with the speed, in time: at a constant speed it is the machine of
//! that speed, by steps and by events; under a ramp it changes at every step, to second order
//! on a lining, against an integrator of its own; and what a change of speed gives to the
//! blades stands in the ledger. A case is some keys, among them the two that make it change.

use crate::keys::{KAPPA, KIND, LOSS, PULSE, RAMP, SPEED, STEP, STIFFENING};
use rubscope_solver::model::LiningLaw;
use rubscope_solver::motion::{ActiveSet, FailureReason, Motion, State};
use rubscope_solver::scene::{CheckedScene, Scene};

use crate::machine_at_speed::frozen;
use crate::tips_support::in_corner;

fn base(changes: &[(&str, &str)]) -> CheckedScene {
    let usual = [("solver.contact", "unilateral"), (STEP, "1e-6")];
    Scene::base().with(&[&usual, changes].concat()).unwrap()
}

fn preloaded(changes: &[(&str, &str)]) -> CheckedScene {
    Scene::builtin("coincidence").unwrap().with(changes).unwrap()
}

fn state_at(scene: &CheckedScene, t: f64) -> State {
    let mut motion = Motion::new(scene);
    motion.advance(t).unwrap();
    motion.state()
}

/// How far two states are from each other, over the size of the first.
fn apart(one: &State, other: &State) -> f64 {
    let pair = |a: [f64; 2], b: [f64; 2]| {
        let size = a[0].hypot(a[1]).max(f64::MIN_POSITIVE);
        (a[0] - b[0]).hypot(a[1] - b[1]) / size
    };
    pair(one.u, other.u).max(pair(one.alpha, other.alpha))
}

#[test]
fn at_a_constant_speed_it_is_the_machine_of_that_speed() {
    for (changes, allowed) in [
        (vec![(KAPPA, "0.3"), (SPEED, "450"), (PULSE, "1e5")], 1e-12),
        (vec![(KAPPA, "0.1"), ("contact.friction", "0.15")], 1e-11),
        (vec![(KAPPA, "0.1"), ("contact.friction", "0.15"), (KIND, "event")], 1e-12),
        // Radial tips are solved by the paper's steps where nothing changes with the speed.
        (vec![], 1e-9),
        (vec![(KAPPA, "0.1"), ("solver.model", "full"), ("bladed_disk.damping_ratio", "0")], 1e-11),
    ] {
        let changing = [(STIFFENING, "1.5"), (LOSS, "1e-10")];
        let scene = base(&[&changes[..], &changing].concat()).into_scene();
        let still = frozen(&scene, scene.operation.speed_rad_s);
        let [found, expected] =
            [scene, still].map(|scene| state_at(&scene.checked().unwrap(), 2e-3));
        let off = apart(&expected, &found);
        assert!(off < allowed, "{changes:?}: {off:e}");
    }
}

/// The equations of docs/theory.md, section 10, with a machine of now, by the method of Runge
/// and Kutta.
struct Plain {
    scene: CheckedScene,
}

impl Plain {
    fn slope(&self, t: f64, x: &[f64; 8]) -> [f64; 8] {
        let Scene { bladed_disk: disk, casing, operation, contact, .. } = &*self.scene;
        let blades = f64::from(disk.blades);
        let n = f64::from(operation.nodal_diameters);
        let speed = operation.speed_rad_s + operation.speed_ramp_rad_s2 * t;
        let theta = (operation.speed_rad_s + 0.5 * operation.speed_ramp_rad_s2 * t) * t;
        let turn = std::f64::consts::TAU / blades;
        let still = (disk.stiffness_nm_per_rad
            + 2.0 * disk.coupling_nm_per_rad * (1.0 - (turn * n).cos()))
            / disk.inertia_kg_m2;
        let stiff = still + disk.centrifugal_stiffening * speed * speed;
        let g0 = casing.radius_m - disk.blade_length_m - casing.clearance_loss_m_s2 * speed * speed;
        let (mass, inertia) = (casing.modal_mass_kg, 0.5 * blades * disk.inertia_kg_m2);
        let drag = 2.0 * casing.damping_ratio * (casing.modal_stiffness_n_per_m * mass).sqrt();
        let law = LiningLaw::of(contact);
        let [uc, us, vc, vs, ac, a_s, bc, bs] = *x;
        // It ends with a step.
        let pulse = if t < operation.pulse_s - 1e-12 { operation.pulse_n } else { 0.0 };
        let mut force = [pulse, 0.0];
        let mut torque = [0.0; 2];
        for i in 0..disk.blades {
            let psi = n * turn * f64::from(i);
            let (s, c) = psi.sin_cos();
            let angle = c * ac + s * a_s;
            let (sin, cos) = (n * theta + psi + n * angle).sin_cos();
            let rise = disk.radial_coupling * disk.blade_length_m;
            let push = law.push(g0 + uc * cos + us * sin - rise * angle);
            let moment = push * (n * (us * cos - uc * sin) - rise);
            (force[0], force[1]) = (force[0] + push * cos, force[1] + push * sin);
            (torque[0], torque[1]) = (torque[0] + moment * c, torque[1] + moment * s);
        }
        let casing = |u: f64, v: f64, force: f64| {
            (force - drag * v - casing.modal_stiffness_n_per_m * u) / mass
        };
        let blade = |a: f64, b: f64, torque: f64| {
            torque / inertia - stiff * a - 2.0 * disk.damping_ratio * still.sqrt() * b
        };
        [
            vc,
            vs,
            casing(uc, vc, force[0]),
            casing(us, vs, force[1]),
            bc,
            bs,
            blade(ac, bc, torque[0]),
            blade(a_s, bs, torque[1]),
        ]
    }

    /// `[u_c, u_s, alpha_c, alpha_s]` at a time.
    fn at(&self, end: f64, step: f64) -> [f64; 4] {
        let mut x = [0.0; 8];
        let count = (end / step).round() as u32;
        for k in 0..count {
            let t = f64::from(k) * step;
            let moved = |slope: &[f64; 8], part: f64| {
                let mut there = x;
                there.iter_mut().zip(slope).for_each(|(x, slope)| *x += part * step * slope);
                there
            };
            let a = self.slope(t, &x);
            let b = self.slope(t + 0.5 * step, &moved(&a, 0.5));
            let c = self.slope(t + 0.5 * step, &moved(&b, 0.5));
            let d = self.slope(t + step * (1.0 - 1e-6), &moved(&c, 1.0));
            for (place, x) in x.iter_mut().enumerate() {
                *x += step / 6.0 * (a[place] + 2.0 * b[place] + 2.0 * c[place] + d[place]);
            }
        }
        [x[0], x[1], x[4], x[5]]
    }
}

#[test]
fn a_run_up_converges_to_an_integrator_of_its_own_to_second_order() {
    // A gap that closes, from 5 um to -25 um.
    let end = 0.04;
    let scene = |step: &str| {
        preloaded(&[
            (STIFFENING, "0.8"),
            (LOSS, "1e-9"),
            (SPEED, "400"),
            (RAMP, "800"),
            ("casing.radius_m", "0.500065"),
            (STEP, step),
            ("contact.stiffness_n_per_m", "27e3"),
            (PULSE, "300"),
        ])
    };
    let exact = Plain { scene: scene("1e-6") }.at(end, 2e-6);
    let errors = ["2e-6", "1e-6", "5e-7"].map(|step| {
        let State { u, alpha, .. } = state_at(&scene(step), end);
        let off = [u[0], u[1], alpha[0], alpha[1]];
        let part = |k: usize| {
            let size = exact[k - k % 2].hypot(exact[k - k % 2 + 1]);
            (off[k] - exact[k]).abs() / size
        };
        (0..4).map(part).fold(0.0, f64::max)
    });
    let orders = [0, 1].map(|k| (errors[k] / errors[k + 1]).log2());
    assert!(orders.iter().all(|order| (1.8..2.2).contains(order)), "{errors:?} {orders:?}");
    assert!(errors[2] < 1e-4, "{errors:?}");
}

#[test]
fn a_ledger_under_a_ramp_closes_and_names_the_work_of_growth() {
    let ledger = |step: &str, rigid: bool| {
        let ramp = [(STIFFENING, "0.8"), (LOSS, "1e-9"), (SPEED, "400"), (RAMP, "800")];
        let scene = if rigid {
            let own = [(KAPPA, "0.3"), (PULSE, "1e5"), ("casing.radius_m", "0.50014")];
            base(&[&ramp[..], &own[..], &[(STEP, step), ("solver.end_s", "0.02")]].concat())
        } else {
            let own = [("casing.radius_m", "0.500065"), (PULSE, "300"), (STEP, step)];
            preloaded(&[&ramp[..], &own[..], &[("solver.end_s", "0.05")]].concat())
        };
        let mut motion = Motion::new(&scene);
        motion.advance(scene.solver.end_s).unwrap();
        motion.energy_account().unwrap()
    };
    for (rigid, steps, most) in [(false, ["4e-6", "2e-6"], 0.4), (true, ["4e-7", "1e-7"], 0.5)] {
        let [coarse, fine] = steps.map(|step| ledger(step, rigid));
        let size = fine.pulse_work_j.abs() + fine.growth_work_j.abs();
        assert!(fine.growth_work_j > 0.0, "{fine:?}");
        let [coarse, fine] = [coarse, fine].map(|ledger| ledger.residual().abs() / size);
        assert!(fine < 1e-3 && fine < most * coarse, "{rigid}: {coarse:e} {fine:e}");
    }
}

#[test]
fn a_sudden_speed_leaves_the_motion_and_its_work_is_the_rotors() {
    for model in ["modal", "full"] {
        let scene = preloaded(&[(STIFFENING, "0.5"), (STEP, "2e-6"), ("solver.model", model)]);
        let mut motion = Motion::new(&scene);
        motion.advance(0.02).unwrap();
        let (before, ledger) = (motion.state(), motion.energy_account().unwrap());
        motion.set_speed(440.0, 0.0);
        let (after, now) = (motion.state(), motion.energy_account().unwrap());
        assert_eq!((before.u, before.alpha), (after.u, after.alpha));
        // Rates are means of two steps, of which one is to come.
        for k in 0..2 {
            let size = before.alpha_rate[0].hypot(before.alpha_rate[1]);
            assert!((before.alpha_rate[k] - after.alpha_rate[k]).abs() < 1e-3 * size);
        }
        let work = now.rotor_work_j - ledger.rotor_work_j;
        let stored = now.stored_j - ledger.stored_j;
        assert!((work - stored).abs() < 1e-9 * work.abs(), "{work:e} {stored:e}");
        assert!((now.residual() - ledger.residual()).abs() < 1e-9 * work.abs());
        if model == "modal" {
            let amplitude = before.alpha[0].hypot(before.alpha[1]);
            let squares = 440.0 * 440.0 - 406.0 * 406.0;
            let mass = motion.machine().blade_modal_mass;
            let expected = 0.5 * 0.5 * mass * squares * amplitude * amplitude;
            assert!((work / expected - 1.0).abs() < 0.01, "{work:e} {expected:e}");
        }
        assert!(
            (motion.machine().omega_bd / scene.machine().at(440.0).omega_bd - 1.0).abs() < 1e-15
        );
        motion.advance(0.03).unwrap();
        let late = motion.energy_account().unwrap();
        assert!(late.residual().abs() < 1e-3 * late.pulse_work_j.abs(), "{late:?}");
    }
}

#[test]
fn events_and_steps_agree_after_a_sudden_speed() {
    for changes in [
        vec![(KAPPA, "0.1"), ("contact.friction", "0.15"), (STIFFENING, "1")],
        vec![(LOSS, "1e-10")],
        vec![(STIFFENING, "2")],
    ] {
        let after = |kind: &str, step: &str| {
            let mut motion =
                Motion::new(&base(&[&changes[..], &[(KIND, kind), (STEP, step)]].concat()));
            motion.advance(1e-3).unwrap();
            let before = motion.state();
            motion.set_speed(480.0, 0.0);
            let now = motion.state();
            assert!((now.u[0] - before.u[0]).hypot(now.u[1] - before.u[1]) < 4e-6);
            motion.advance(1.4e-3).unwrap();
            (motion.state(), motion.checks().energy_residual_j.unwrap())
        };
        let (events, missing) = after("event", "1e-6");
        let (steps, _) = after("explicit", "2e-8");
        let off = apart(&events, &steps);
        assert!(off < 5e-3, "{changes:?}: {off:e}");
        assert!(missing.abs() < 1e-9, "{changes:?}: {missing:e}");
    }
}

#[test]
fn a_gap_that_closes_on_the_way_ends_a_rigid_run_at_its_instant() {
    let scene = base(&[(LOSS, "3.9e-10"), (SPEED, "400"), (PULSE, "0")]);
    let mut motion = Motion::new(&scene);
    motion.advance(1e-3).unwrap();
    motion.set_speed(400.0, 1e4);
    let failure = motion.advance(0.1).unwrap_err();
    let closed = (1e-4_f64 / 3.9e-10).sqrt();
    assert!(
        matches!(failure.reason, FailureReason::Closed { speed_rad_s } if (speed_rad_s - closed).abs() < 0.02)
    );
    assert!((failure.t_s - (1e-3 + (closed - 400.0) / 1e4)).abs() < 2e-6, "{failure}");
    // At once, by either solver; and no event solver follows a ramp.
    for kind in ["explicit", "event"] {
        let mut motion = Motion::new(&base(&[(LOSS, "3.9e-10"), (KIND, kind)]));
        motion.set_speed(600.0, 0.0);
        let failure = motion.advance(0.01).unwrap_err();
        assert!(matches!(failure.reason, FailureReason::Closed { .. }), "{kind}: {failure}");
    }
    for changes in [[(LOSS, "1e-10"), (KAPPA, "0")], [(STIFFENING, "1"), (KAPPA, "0.1")]] {
        let mut motion = Motion::new(&base(&[&changes[..], &[(KIND, "event")]].concat()));
        motion.set_speed(500.0, 10.0);
        assert_eq!(motion.advance(0.01).unwrap_err().reason, FailureReason::Ramp);
    }
}

#[test]
fn a_clearance_that_shrinks_under_a_lock_takes_energy_and_leaves_no_tip_in_the_casing() {
    for restitution in ["0", "0.3"] {
        let corner = [
            ("solver.kind", "event"),
            ("solver.model", "rigid"),
            ("operation.pulse_n", "0"),
            ("operation.speed_rad_s", "450"),
            ("casing.clearance_loss_m_s2", "1e-10"),
            ("contact.restitution", restitution),
        ];
        let scene = Scene::builtin("undamped").unwrap().with(&corner).unwrap().into_scene();
        let mut motion = Motion::new(&in_corner(scene).checked().unwrap());
        motion.advance(1e-3).unwrap();
        assert!(matches!(motion.contacts().active_set, ActiveSet::Corner(..)), "{restitution}");
        let stored = 0.5 * motion.machine().casing_stiffness * motion.state().amplitude().powi(2);
        motion.set_speed(480.0, 0.0);
        motion.advance(1.1e-3).unwrap();
        let gaps = motion.blade_gaps();
        assert!(gaps.iter().all(|gap| *gap >= -1e-15), "{restitution}: {gaps:?}");
        let residual = motion.checks().energy_residual_j.unwrap();
        assert!(residual.abs() < 1e-9 * stored, "{restitution}: {residual} of {stored}");
        if let Some(account) = motion.energy_account() {
            assert!(account.growth_work_j < 0.0, "{account:?}");
        }
    }
}
