//! With the defaults of every key beyond the paper nothing changes: the scenes of the
//! paper's model are solved by its own solvers, bit for bit as without those keys. And the bounds
//! of tips whose pushes would close their own gap.

use crate::cli_support::{refusal, words};
use rubscope_solver::motion::{RunReport, simulate};
use rubscope_solver::scene::{BUILTIN, Scene};

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
    assert_eq!(scenes.len(), 11);
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

/// `kappa (kappa + mu) l_b^2/m_a` not above `-1/m_c`: a push closes its own gap. Refused
/// between bounds that are themselves accepted.
#[test]
fn tips_whose_pushes_close_their_own_gap_are_refused_with_the_bounds() {
    let with = |mu: f64, kappa: f64, inertia: f64, more: &[(&str, &str)]| {
        let [mu, kappa, inertia] = [mu, kappa, inertia].map(|value| value.to_string());
        let own = [
            ("contact.friction", mu.as_str()),
            ("bladed_disk.radial_coupling", &kappa),
            ("bladed_disk.inertia_kg_m2", &inertia),
        ];
        Scene::base().with(&[&own[..], more].concat())
    };
    let event = [("solver.kind", "event")];
    let backward = [("operation.speed_rad_s", "-500")];
    for (mu, kappa, inertia, more) in [
        (5.0, -2.5, 0.20825, &[][..]),
        (5.0, -2.5, 0.20825, &event[..]),
        (1.0, -0.5, 0.01, &[]),
        (1.0, -0.5, 0.01, &event),
        (1.0, 0.5, 0.01, &backward),
    ] {
        // N = 22 blades have 11 times the inertia of one in each mode.
        let product = |kappa: f64| {
            let felt = if more == backward { -mu } else { mu };
            kappa * (kappa + felt) * 0.4999 * 0.4999 * 2.0 / (11.0 * inertia)
        };
        assert!(product(kappa) < -1.0);
        let message = with(mu, kappa, inertia, more).unwrap_err().to_string();
        let key = "bladed_disk.radial_coupling = ";
        assert!(message.starts_with(key) && message.contains("friction = "), "{message}");
        assert_eq!(message.lines().count(), 1);
        let bounds = message.split("not from ").nth(1).unwrap().split(" with").next().unwrap();
        for bound in bounds.split(" to ").map(|bound| bound.parse::<f64>().unwrap()) {
            assert!((product(bound) + 1.0).abs() < 2e-3, "{bound}: {}", product(bound));
            let scene = with(mu, bound, inertia, more).unwrap();
            assert!(product(bound) > -1.0 && scene.bladed_disk.radial_coupling == bound);
            let inward = bound + 2e-3 * (kappa - bound);
            assert!(with(mu, inward, inertia, more).is_err(), "{inward}");
        }
        // A lining has a push for every gap.
        let lining = [("solver.contact", "smooth"), ("solver.kind", "explicit")];
        let smooth = [more, &lining[..]].concat();
        assert!(with(mu, kappa, inertia, &smooth).is_ok());
    }
    let set = "hbm digs-in --set contact.friction=5 --set bladed_disk.radial_coupling=-2.5";
    let hbm = refusal(&words(set));
    assert!(hbm.starts_with("rubscope: bladed_disk.radial_coupling = -2.5: allowed is not from"));
}
