//! The event solver with moving blades, against a plain integration of the equations of motion
//! with the constraints differentiated twice. A case is a start on a side or in its corner, and
//! the speed ramp and the force that act on it.

use crate::close;
use crate::event_cases::scene_of;
use crate::tips_support::carried;
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{ActiveSet, Events, Solver, State};
use rubscope_solver::scene::Scene;

fn scene(changes: &[(&str, f64)]) -> Scene {
    scene_of("modal", changes)
}

/// `[u_c, u_s, alpha_c, alpha_s]` and their rates.
type Phase = [f64; 8];

/// Equations of motion as the paper writes them, with a speed ramp.
struct Plain {
    m: Machine,
    speed: f64,
    ramp: f64,
    force: f64,
}

impl Plain {
    fn of(scene: &Scene) -> Self {
        let operation = &scene.operation;
        let (speed, ramp) = (operation.speed_rad_s, operation.speed_ramp_rad_s2);
        Self { m: scene.machine(), speed, ramp, force: operation.pulse_n }
    }

    /// Gradient of the gap of a side, and the part of the gap's second derivative that does not
    /// depend on accelerations.
    fn gap(&self, side: u32, x: &Phase, t: f64) -> ([f64; 4], f64) {
        let n = self.m.nodal_diameters;
        let (pc, ps) = self.m.polygon.direction(side);
        let angle = (self.speed + 0.5 * self.ramp * t) * t;
        let beta = ps.atan2(pc) + n * (angle + pc * x[2] + ps * x[3]);
        let (sin, cos) = beta.sin_cos();
        let turn = n * (self.speed + self.ramp * t + pc * x[6] + ps * x[7]);
        let a = x[1] * cos - x[0] * sin;
        let gradient = [cos, sin, n * a * pc, n * a * ps];
        let bend = 2.0 * turn * (x[5] * cos - x[4] * sin) - turn * turn * (x[0] * cos + x[1] * sin)
            + a * n * self.ramp;
        (gradient, bend)
    }

    fn masses(&self) -> [f64; 4] {
        let (c, b) = (self.m.casing_mass, self.m.blade_modal_mass);
        [c, c, b, b]
    }

    /// Accelerations and multipliers with these sides held.
    fn acceleration(&self, x: &Phase, t: f64, held: &[u32]) -> ([f64; 4], Vec<f64>) {
        let m = &self.m;
        let (d, k) = (m.casing_damping, m.casing_stiffness);
        let (e, l) = (m.blade_modal_damping, m.blade_modal_stiffness);
        let masses = self.masses();
        let mut a = [
            (self.force - d * x[4] - k * x[0]) / masses[0],
            (-d * x[5] - k * x[1]) / masses[1],
            (-e * x[6] - l * x[2]) / masses[2],
            (-e * x[7] - l * x[3]) / masses[3],
        ];
        let rows: Vec<_> = held.iter().map(|&side| self.gap(side, x, t)).collect();
        let weight = |p: &[f64; 4], q: &[f64; 4]| (0..4).map(|i| p[i] * q[i] / masses[i]).sum();
        let opening: Vec<f64> =
            rows.iter().map(|row| row.1 + (0..4).map(|i| row.0[i] * a[i]).sum::<f64>()).collect();
        // M a + C lambda = F with C the gradients: lambda < 0 pushes.
        let lambdas: Vec<f64> = match rows.as_slice() {
            [] => vec![],
            [one] => vec![opening[0] / weight(&one.0, &one.0)],
            [p, q, ..] => {
                let (pp, qq, pq): (f64, f64, f64) =
                    (weight(&p.0, &p.0), weight(&q.0, &q.0), weight(&p.0, &q.0));
                let det = pp * qq - pq * pq;
                vec![
                    (qq * opening[0] - pq * opening[1]) / det,
                    (pp * opening[1] - pq * opening[0]) / det,
                ]
            }
        };
        for (row, lambda) in rows.iter().zip(&lambdas) {
            for i in 0..4 {
                a[i] -= row.0[i] * lambda / masses[i];
            }
        }
        (a, lambdas)
    }

    fn step(&self, x: &Phase, t: f64, h: f64, held: &[u32]) -> Phase {
        let rate = |x: &Phase, t: f64| -> Phase {
            let (a, _) = self.acceleration(x, t, held);
            [x[4], x[5], x[6], x[7], a[0], a[1], a[2], a[3]]
        };
        let along = |k: &Phase, h: f64| -> Phase { std::array::from_fn(|i| x[i] + h * k[i]) };
        let k1 = rate(x, t);
        let k2 = rate(&along(&k1, 0.5 * h), t + 0.5 * h);
        let k3 = rate(&along(&k2, 0.5 * h), t + 0.5 * h);
        let k4 = rate(&along(&k3, h), t + h);
        std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    }

    fn run(&self, mut x: Phase, to: f64, steps: u32, held: &[u32]) -> Phase {
        let h = to / f64::from(steps);
        for n in 0..steps {
            x = self.step(&x, f64::from(n) * h, h, held);
        }
        x
    }
}

fn phase(s: &State) -> Phase {
    [s.u[0], s.u[1], s.alpha[0], s.alpha[1], s.v[0], s.v[1], s.alpha_rate[0], s.alpha_rate[1]]
}

/// Compares casing and blades, each to `tolerance` of its own size.
fn agree(found: &Phase, expected: &Phase, tolerance: f64) {
    for pair in [[0, 1], [2, 3], [4, 5], [6, 7]] {
        let size = expected[pair[0]].hypot(expected[pair[1]]);
        for i in pair {
            assert!(
                (found[i] - expected[i]).abs() <= tolerance * size,
                "coordinate {i}: {:e} is not {:e} of {size:e}",
                found[i],
                expected[i]
            );
        }
    }
}

/// Blades light and soft enough to have an effect: a thousandth of Table 1's.
const SOFT: [(&str, f64); 3] = [
    ("bladed_disk.inertia_kg_m2", 2e-7),
    ("bladed_disk.stiffness_nm_per_rad", 0.15),
    ("bladed_disk.coupling_nm_per_rad", 0.003),
];

/// A start on side 0, or in its corner with the next, carried by the rotor.
pub fn on_side_0(scene: &mut Scene, corner: bool, pace: f64) {
    let machine = scene.machine();
    let y = if corner { -machine.polygon.half_side() } else { 0.0 };
    carried(scene, [-machine.clearance(), y]);
    scene.initial.v_s_m_s += pace;
}

#[test]
fn sliding_with_blades_agrees_with_the_constrained_equations() {
    let steady = (0.0, 0.0);
    for (soft, (ramp, pulse)) in
        [(false, steady), (true, steady), (false, (-3e4, -50.0)), (true, (2e4, 30.0))]
    {
        let mut scene = if soft { scene(&SOFT) } else { scene(&[]) };
        on_side_0(&mut scene, false, -4e-3);
        scene.operation.speed_ramp_rad_s2 = ramp;
        scene.operation.pulse_n = pulse;
        scene.operation.pulse_s = 1.0;
        let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
        let start = phase(&motion.state());
        assert_eq!(motion.contacts().active_set, ActiveSet::Side(0));
        let mut end = motion.clone();
        let until = 0.9 * end.next_event(1.0).unwrap();
        motion.advance(until).unwrap();
        let plain = Plain::of(&scene);
        let x = plain.run(start, until, 4000, &[0]);
        agree(&phase(&motion.state()), &x, 1e-9);
        let (_, lambdas) = plain.acceleration(&x, until, &[0]);
        let found = motion.multipliers();
        close(found[0].1, lambdas[0], 1e-9 * lambdas[0].abs());
        assert!(until > 1e-4);
        assert!(motion.checks().energy_residual_j.unwrap().abs() < 1e-14);
    }
}

#[test]
fn locked_with_blades_agrees_with_the_constrained_equations() {
    for (soft, ramp, pulse) in
        [(false, 0.0, 0.0), (true, 0.0, 0.0), (false, -1000.0, -2.0), (true, 2000.0, 2.0)]
    {
        let mut scene = if soft { scene(&SOFT) } else { scene(&[]) };
        on_side_0(&mut scene, true, 0.0);
        scene.operation.speed_ramp_rad_s2 = ramp;
        scene.operation.pulse_n = pulse;
        scene.operation.pulse_s = 1.0;
        let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
        assert_eq!(motion.contacts().active_set, ActiveSet::Corner(0, 1), "{soft}");
        let start = phase(&motion.state());
        let until = 0.02;
        motion.advance(until).unwrap();
        assert_eq!((motion.events(), motion.contacts().since), (Some(0), 0.0));
        let plain = Plain::of(&scene);
        let x = plain.run(start, until, 20_000, &[0, 1]);
        agree(&phase(&motion.state()), &x, 1e-9);
        let (_, lambdas) = plain.acceleration(&x, until, &[0, 1]);
        for ((_, found), lambda) in motion.multipliers().iter().zip(lambdas) {
            close(*found, lambda, 1e-9 * lambda.abs());
        }
        assert!(motion.checks().energy_residual_j.unwrap().abs() < 1e-14);
    }
}
