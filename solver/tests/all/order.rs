//! The explicit solver against the event solver: its order, its thresholds, and
//! where the two contact laws differ.

use rubscope_solver::motion::{Motion, State, Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::Scene;

fn scene(changes: &[(&str, &str)]) -> Scene {
    Scene::base().with(changes).unwrap().into_scene()
}

/// Puts the wave into the corner of sides 15 and 16, turning with the rotor.
fn start_in_corner(scene: &mut Scene, speed: f64) {
    let machine = scene.machine();
    let angle = machine.polygon.phase(15) + machine.polygon.delta;
    let amplitude = machine.locked_amplitude().unwrap();
    let (x, y) = (-amplitude * angle.cos(), -amplitude * angle.sin());
    let nu = machine.nu(speed);
    scene.operation.speed_rad_s = speed;
    (scene.initial.u_c_m, scene.initial.u_s_m) = (x, y);
    (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, nu * x);
}

/// Rigid blades, explicit, locked from the start.
fn locked(speed: f64, step: f64) -> Scene {
    let mut scene = scene(&[
        ("operation.pulse_n", "0"),
        ("solver.model", "rigid"),
        ("solver.end_s", "0.02"),
        ("solver.step_s", &step.to_string()),
    ]);
    start_in_corner(&mut scene, speed);
    scene
}

fn end(scene: &Scene) -> State {
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(scene.solver.end_s).unwrap();
    motion.state()
}

fn distance(a: &State, b: &State) -> f64 {
    (a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1])
}

/// Slope of log error over log step, by least squares.
fn slope(steps: &[f64], errors: &[f64]) -> f64 {
    let logs: Vec<(f64, f64)> =
        steps.iter().zip(errors).map(|(h, e)| (h.log10(), e.log10())).collect();
    let count = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(x, y), (a, b)| (x + a / count, y + b / count));
    let (xy, xx) = logs
        .iter()
        .fold((0.0, 0.0), |(xy, xx), (a, b)| (xy + (a - mx) * (b - my), xx + (a - mx).powi(2)));
    xy / xx
}

#[test]
fn first_order_in_contact_from_1e_5_to_1e_8() {
    // Locked from the start and never released: a smooth contact. A slide that
    // starts in the middle of a side is smooth too.
    let smooth = |step: &str| {
        let g0 = Scene::base().machine().clearance();
        // On the side of blade 1 (phase 0), at rest in the frame of the blades.
        let (u, v) = ((-g0).to_string(), (-1500.0 * g0).to_string());
        let start = [("initial.u_c_m", u.as_str()), ("initial.v_s_m_s", v.as_str())];
        scene(&[
            ("operation.pulse_n", "0"),
            start[0],
            start[1],
            ("solver.end_s", "0.001"),
            ("solver.model", "rigid"),
            ("solver.step_s", step),
        ])
    };
    let mut exact = smooth("1e-7");
    exact.set("solver.kind", "event").unwrap();
    let exact = end(&exact);
    let steps = [1e-5, 1e-6, 1e-7, 1e-8];
    let errors = steps.map(|step: f64| distance(&end(&smooth(&step.to_string())), &exact));
    let slope = slope(&steps, &errors);
    assert!((slope - 1.0).abs() < 0.1, "slope {slope} of {errors:?}");
}

#[test]
fn locked_multipliers_converge_with_the_known_coefficient() {
    let machine = Scene::base().machine();
    let exact = machine.locked_multipliers(500.0).unwrap();
    let nu: f64 = machine.nu(500.0);
    let stiffness = machine.casing_stiffness - nu * nu * machine.casing_mass;
    let (sin, cos) = machine.polygon.delta.sin_cos();
    // The scheme turns K + iD by -nu h: an extra damping nu h |K|, and a
    // stiffness larger by nu h D.
    let drag = machine.casing_damping * nu;
    let coefficient = machine.clearance() / (2.0 * cos) * nu * (stiffness.abs() / sin - drag / cos);
    // Held from the start. The multiplier is a second difference of positions:
    // its round-off is 1e-3 N at 1e-7 s, so the steps are not smaller.
    let steps = [2e-6, 1e-6, 5e-7];
    let errors = steps.map(|step: f64| {
        let report = crate::run_once(&locked(500.0, step).checked().unwrap());
        assert_eq!(report.outcome.verdict, Verdict::Locked);
        exact[0] - report.outcome.contacts[0].multiplier_n
    });
    for (step, error) in steps.iter().zip(errors) {
        // The next order is smaller by about nu h = 3e-3.
        assert!((error / (coefficient * step) - 1.0).abs() < 4e-3, "{step} {error}");
    }
    let slope = slope(&steps, &errors);
    assert!((slope - 1.0).abs() < 0.01, "{slope}");
}

#[test]
fn the_lock_speed_by_bisection_of_runs() {
    // Started in a corner, turning with it, until a lock holds or breaks.
    for (zeta, end_s) in [("0.05", "0.2"), ("0.01", "0.2")] {
        let holds = |speed: f64| {
            let mut scene = scene(&[
                ("casing.damping_ratio", zeta),
                ("operation.pulse_n", "0"),
                ("solver.kind", "event"),
                ("solver.model", "rigid"),
                ("solver.end_s", end_s),
            ]);
            start_in_corner(&mut scene, speed);
            run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().verdict
                == Verdict::Locked
        };
        let (mut low, mut high) = (293.0, 500.0);
        while high - low > 1e-4 {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        let exact = scene(&[("casing.damping_ratio", zeta)]).machine().lock_speed().unwrap();
        assert!((high - exact).abs() < 1e-3, "{high} {exact}");
    }
}

#[test]
fn the_adhesive_threshold_of_the_equality_law() {
    // 1 MN presses the wave into a corner; the printed algorithm then holds it
    // by pulling, down to 294.99 rad/s.
    let holds = |speed: f64| {
        let scene = scene(&[
            ("operation.pulse_n", "1e6"),
            ("operation.speed_rad_s", &speed.to_string()),
            ("solver.contact", "bilateral"),
            ("solver.model", "rigid"),
            ("solver.step_s", "1e-7"),
            ("solver.end_s", "0.05"),
        ]);
        matches!(
            run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().verdict,
            Verdict::Locked | Verdict::Adhesive
        )
    };
    let (mut low, mut high) = (290.0, 300.0);
    while high - low > 0.02 {
        let middle = 0.5 * (low + high);
        if holds(middle) { high = middle } else { low = middle }
    }
    let exact = Scene::base().machine().adhesive_speed().unwrap();
    assert!((high - exact).abs() < 0.1, "{high} {exact}");
}

#[test]
fn blades_of_the_explicit_and_the_event_solver_agree() {
    let blades = |kind: &str, step: &str| {
        let scene = scene(&[
            ("solver.kind", kind),
            ("solver.step_s", step),
            ("solver.end_s", "0.01"),
            ("operation.pulse_n", "20000"),
        ]);
        end(&scene).alpha
    };
    let exact = blades("event", "1e-7");
    let size = exact[0].hypot(exact[1]);
    assert!(size > 1e-9);
    let error = |step: &str| {
        let found = blades("explicit", step);
        (found[0] - exact[0]).hypot(found[1] - exact[1]) / size
    };
    // The scheme uses the moment arm of an impact one step late: first order.
    let (coarse, fine) = (error("1e-6"), error("1e-8"));
    assert!(fine < 1e-3 && fine < coarse / 10.0, "{coarse} {fine}");
}
