//! Margins of a machine with inclined tips: limits that the paper's has not, with their
//! sensitivities.

use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{LimitName, Margins};

fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::base();
    scene.set("bladed_disk.radial_coupling", "0.2").unwrap();
    scene.set("contact.friction", "0.05").unwrap();
    scene.set("casing.tangential_ratio", "0.3").unwrap();
    changes.iter().for_each(|(path, value)| scene.set(path, value).unwrap());
    scene
}

#[test]
fn sensitivities_of_inclined_tips_are_those_of_their_neighbours() {
    let limits = [
        LimitName::OmegaLock,
        LimitName::WhirlOnset,
        LimitName::FlutterSpeed,
        LimitName::PushA,
        LimitName::PushB,
        LimitName::Torque,
    ];
    let base = Margins::of(&scene(&[]).checked().unwrap());
    for (path, value) in [
        ("bladed_disk.radial_coupling", 0.2),
        ("contact.friction", 0.05),
        ("casing.tangential_ratio", 0.3),
        ("casing.damping_ratio", 0.05),
        ("casing.modal_mass_kg", 2.0),
        ("bladed_disk.inertia_kg_m2", 0.20825),
        ("bladed_disk.damping_ratio", 0.04),
    ] {
        let step = 1e-5;
        let beside = [1.0 - step, 1.0 + step].map(|part| {
            let text = (value * part).to_string();
            Margins::of(&scene(&[(path, &text)]).checked().unwrap())
        });
        for name in limits {
            let of = |margins: &Margins| margins.limit(name).unwrap().value.unwrap();
            let [low, high] = [of(&beside[0]), of(&beside[1])];
            let measured = (high - low) / (2.0 * step) / of(&base);
            let told = base.limit(name).unwrap().sensitivities.by(path).unwrap();
            let error = (told - measured).abs();
            assert!(error < 1e-6 + 1e-5 * measured.abs(), "{name} {path}: {told} {measured}");
        }
    }
}

#[test]
fn the_papers_tips_have_neither_whirl_nor_flutter() {
    let margins = Margins::of(&Scene::base().checked().unwrap());
    assert!(margins.limit(LimitName::WhirlOnset).is_none());
    assert!(margins.limit(LimitName::FlutterSpeed).is_none());
}
