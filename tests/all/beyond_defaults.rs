//! With the defaults of every key beyond the paper nothing changes: the scenes of the
//! paper's model are solved by its own solvers, bit for bit as without those keys.

use rubscope::motion::{RunReport, simulate};
use rubscope::scene::{BUILTIN, KEYS, Scene};

/// Keys that say nothing where nothing goes beyond the paper, with other values.
const IDLE: &[(&str, &str)] = &[
    ("casing.tangential_ratio", "0.333"),
    ("contact.stiffness_n_per_m", "12345"),
    ("contact.smoothing_m", "0"),
    ("bladed_disk.mistuning_seed", "77"),
];

/// Built-in scenes of the paper's model.
fn of_the_paper() -> Vec<(&'static str, Scene)> {
    let scenes =
        BUILTIN.iter().map(|builtin| (builtin.name, Scene::builtin(builtin.name).unwrap()));
    scenes.filter(|(_, scene)| !scene.goes_beyond()).collect()
}

fn bits(run: &RunReport) -> Vec<u64> {
    let end = &run.r#final;
    let checks = &run.checks;
    [end.t_s, end.u_c_m, end.u_s_m, end.alpha_c_rad, end.alpha_s_rad]
        .into_iter()
        .chain([checks.max_penetration_m, checks.max_blade_angle_rad])
        .map(f64::to_bits)
        .chain([run.impact_count])
        .collect()
}

#[test]
fn keys_that_say_nothing_do_not_change_a_bit() {
    let scenes = of_the_paper();
    assert_eq!(scenes.len(), 13);
    for (name, mut scene) in scenes {
        scene.solver.end_s = scene.solver.end_s.min(0.02);
        let before = simulate(&scene.checked().unwrap());
        for (path, value) in IDLE {
            scene.set(path, value).unwrap();
        }
        // The same diameters by name.
        scene.bladed_disk.nodal_diameters = scene.operation.nodal_diameters;
        assert!(!scene.goes_beyond(), "{name}");
        let after = simulate(&scene.checked().unwrap());
        assert_eq!(bits(&before), bits(&after), "{name}");
        assert_eq!(before.outcome, after.outcome, "{name}");
    }
}

/// Ends of runs as they were before these keys: `u_c`, `u_s` \[m\], verdict, impacts.
const BEFORE: &[(&str, f64, f64, &str, u64)] = &[
    ("paper-nd3", 5.9646681192018636e-05, -8.15413722325287e-05, "locked", 2),
    ("paper-nd4", 5.077564919210214e-05, -9.101645025902377e-05, "locked", 2),
    ("paper-figs-4-6", -8.237493646180037e-05, 5.849010050075913e-05, "locked", 142),
    ("paper-fig-7", -0.00010294229349202999, 1.6280365103110624e-05, "locked", 51),
    ("paper-fig-8", 5.9646681192018636e-05, -8.15413722325287e-05, "locked", 2),
    ("adhesive", 5.087662402293447e-05, 8.728282239282143e-05, "adhesive", 2),
    ("undamped", 9.874773719932788e-05, 7.142196631319329e-06, "bounce", 5),
    ("rocking", 0.00010068512971956991, -8.320254298528243e-06, "locked", 96),
    ("slip", 9.29298190457106e-05, -3.8727442225345004e-05, "slip", 111),
    ("grazing", -4.289315404794538e-05, -1.6848638511606063e-09, "decay", 1),
    ("near-critical", 3.466076604786638e-05, 9.489653984847855e-05, "locked", 0),
    ("run-down", -1.4057171658010427e-05, -9.932550898201488e-06, "decay", 2),
    ("half-n", 0.002214084534488701, -0.003182535885152761, "slip", 4),
];

#[test]
fn the_paper_s_scenes_end_as_before() {
    for &(name, u_c, u_s, verdict, impacts) in BEFORE {
        let run = simulate(&Scene::builtin(name).unwrap().checked().unwrap());
        let end = &run.r#final;
        // Round-off differs between machines, not more.
        for (now, before) in [(end.u_c_m, u_c), (end.u_s_m, u_s)] {
            assert!((now - before).abs() <= 1e-9 * u_c.hypot(u_s), "{name}: {now} {before}");
        }
        assert_eq!((run.outcome.verdict.as_ref(), run.impact_count), (verdict, impacts), "{name}");
    }
}

#[test]
fn an_empty_file_has_none_of_it() {
    let base = Scene::base();
    assert!(!base.goes_beyond());
    let changes = [
        ("bladed_disk.radial_coupling", "0.1", true),
        ("bladed_disk.nodal_diameters", "4", true),
        ("contact.friction", "0.1", true),
        ("contact.restitution", "0.5", true),
        ("solver.contact", "smooth", true),
        ("solver.contact", "bilateral", false),
        ("casing.tangential_ratio", "0.3", false),
    ];
    for (path, value, beyond) in changes {
        let mut scene = base.clone();
        scene.set(path, value).unwrap();
        assert_eq!(scene.goes_beyond(), beyond, "{path}");
    }
    assert!(KEYS.iter().any(|key| key.path == "bladed_disk.mistuning"));
}

/// What has no meaning is refused by name, in one line.
#[test]
fn combinations_without_a_meaning_are_refused() {
    let refused = |changes: &[(&str, &str)]| {
        Scene::base().with(changes).map_or_else(|error| error.to_string(), |_| String::new())
    };
    let (mu, kappa) = (("contact.friction", "0.3"), ("bladed_disk.radial_coupling", "-0.15"));
    let (full, smooth) = (("solver.model", "full"), ("solver.contact", "smooth"));
    let bilateral = ("solver.contact", "bilateral");
    for (changes, start) in [
        (&[mu, bilateral][..], "contact.friction = 0.3: allowed is 0 with solver.contact"),
        (
            &[mu, ("operation.speed_ramp_rad_s2", "-5000")],
            "contact.friction = 0.3: allowed is 0 where a ramp",
        ),
        (
            &[mu, kappa, full],
            "bladed_disk.radial_coupling = -0.15: allowed is not between 0 and -0.3",
        ),
        (
            &[("contact.restitution", "0.5"), bilateral],
            "contact.restitution = 0.5: allowed is 0, or",
        ),
        (&[("contact.restitution", "0.5"), smooth], "contact.restitution = 0.5: allowed is 0, or"),
        (&[("bladed_disk.mistuning", "0.02")], "bladed_disk.mistuning = 0.02: allowed is 0, or"),
        (&[("casing.radius_m", "0.49988")], "casing.radius_m = 0.49988: allowed is above"),
        (&[("casing.radius_m", "0.4999"), smooth], "casing.radius_m = 0.4999: allowed is other"),
        (
            &[smooth, ("solver.kind", "event")],
            "solver.contact = \"smooth\": allowed is \"unilateral\"",
        ),
        (
            &[("solver.kind", "event"), mu, ("operation.speed_ramp_rad_s2", "10")],
            "operation.speed_ramp_rad_s2 = 10: allowed is 0 with solver.kind",
        ),
    ] {
        let message = refused(changes);
        assert!(message.starts_with(start), "{changes:?}: {message}");
        assert_eq!(message.lines().count(), 1);
    }
    for allowed in [
        &[mu, kappa][..],
        &[mu, kappa, full, smooth, ("solver.step_s", "1e-7")],
        &[mu, ("operation.speed_rad_s", "0")],
        &[mu, ("operation.speed_rad_s", "-430")],
        &[smooth, ("casing.radius_m", "0.49988")],
        &[("bladed_disk.mistuning", "0.02"), full],
    ] {
        assert_eq!(refused(allowed), "", "{allowed:?}");
    }
}
