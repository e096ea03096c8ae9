//! The event solver on the motions whose numbers are known.

#![expect(clippy::unwrap_used, reason = "tests state what must hold")]

use rubscope::motion::{Event, Touching, Verdict};
use rubscope::scene::Scene;

fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::default();
    for (key, value) in changes {
        scene.set(key, value).unwrap();
    }
    scene.check().unwrap();
    scene
}

fn run(changes: &[(&str, &str)], until: f64) -> Event {
    let mut motion = Event::new(&scene(changes));
    motion.advance(until).unwrap();
    motion
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value:e} is not {expected:e}");
}

const ZETA: &str = "casing.damping_ratio";
const PULSE: &str = "operation.pulse_n";
const SPEED: &str = "operation.speed_rad_s";
const RAMP: &str = "operation.speed_ramp_rad_s2";
const DIAMETERS: &str = "operation.nodal_diameters";

#[test]
fn case_a_has_its_two_impacts_and_decays() {
    let motion = run(&[], 0.1);
    let impacts = &motion.contacts().impacts;
    // MODEL.md prints six digits of the times and eight of the state.
    close(impacts[0].t_s, 0.228_219e-3, 5e-10);
    close(impacts[1].t_s, 0.292_811e-3, 5e-10);
    let blades: Vec<_> =
        impacts.iter().map(|impact| motion.machine().rim.blades_of_side(impact.side)).collect();
    assert_eq!(blades, [[19], [4]]);
    let state = motion.state();
    close(state.u[0], 1.228_513_3e-6, 5e-14);
    close(state.u[1], 1.310_205_9e-7, 5e-15);
    assert_eq!(motion.settled(), Some(Verdict::Decay));
}

#[test]
fn case_c_rocks_into_a_corner() {
    let motion = run(&[(ZETA, "0"), (PULSE, "51742")], 0.1);
    close(motion.contacts().since, 0.0580, 5e-5);
    assert!(matches!(motion.contacts().touching, Touching::Corner(..)));
    assert_eq!(motion.settled(), Some(Verdict::Locked));
    let machine = motion.machine();
    let expected = machine.locked_multipliers(500.0).unwrap();
    for ((_, multiplier), expected) in motion.multipliers().iter().zip(expected) {
        close(*multiplier, expected, 1e-12 * expected.abs());
    }
    let amplitude = machine.locked_amplitude().unwrap();
    close(motion.state().amplitude(), amplitude, 1e-12 * amplitude);
}
