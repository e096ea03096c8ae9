//! Runs that tell themselves whether they are certain: cells of four maps have the
//! flag of the three runs that define it (docs/theory.md, section 9).

use rubscope::motion::{
    Certainty, Script, is_sensitive, run_to_verdict, run_with_certainty, run_with_sensitivity,
    to_the_end,
};
use rubscope::scene::{CheckedScene, ContactLaw, ModelSize, Scene, SolverKind};

/// Scene and casing damping of the four maps: 0 to 500 rad/s, 0 to 1 MN.
const MAPS: [(&str, f64); 4] =
    [("paper-nd3", 0.05), ("paper-nd3", 0.01), ("paper-nd4", 0.05), ("paper-nd3", 0.0)];

/// From 0 to 1, without a pattern (SplitMix64).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut x = *state;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn cell(map: usize, model: ModelSize, state: &mut u64) -> CheckedScene {
    let (name, zeta) = MAPS[map];
    let mut scene = Scene::builtin(name).unwrap();
    scene.solver.kind = SolverKind::Event;
    scene.solver.contact = ContactLaw::Unilateral;
    scene.solver.model = model;
    scene.casing.damping_ratio = zeta;
    scene.operation.speed_rad_s = 500.0 * random(state);
    scene.operation.pulse_n = 1e6 * random(state);
    scene.checked().unwrap()
}

/// How many of so many cells of each map are certain by one run, after comparing all
/// flags.
fn compare(count: usize, model: ModelSize, seed: u64) -> [usize; 4] {
    std::array::from_fn(|map| {
        let (mut state, mut certain, mut differ) = (seed + map as u64, 0, Vec::new());
        for _ in 0..count {
            let scene = cell(map, model, &mut state);
            let plain = run_to_verdict(&scene, &to_the_end).unwrap();
            let (reached, certainty) = run_with_certainty(&scene, &to_the_end).unwrap();
            assert_eq!(plain, reached, "the columns changed the run");
            let three = is_sensitive(&scene, &Script::default(), plain, &to_the_end).unwrap();
            let (_, one) = run_with_sensitivity(&scene, &to_the_end).unwrap();
            certain += usize::from(certainty == Certainty::Certain);
            if one != three {
                differ.push((scene.operation.speed_rad_s, scene.operation.pulse_n, three));
            }
        }
        assert!(differ.is_empty(), "map {map}, {model}: {differ:?}");
        println!("map {map}, {model}: {certain} of {count} certain");
        certain
    })
}

#[test]
fn cells_have_the_flags_of_the_three_runs() {
    for model in [ModelSize::Rigid, ModelSize::Modal] {
        let certain = compare(60, model, 7);
        assert!(certain[0] > 30 && certain[2] > 50, "{certain:?} certain cells of 60");
    }
}

/// Sensitive by a near miss that no look comes close to.
#[test]
fn a_near_miss_far_from_any_look_is_a_tie() {
    let mut scene = cell(1, ModelSize::Modal, &mut 1).into_scene();
    scene.operation.speed_rad_s = 244.69671847570606;
    scene.operation.pulse_n = 976_406.056_575_353_5;
    let scene = scene.checked().unwrap();
    let reached = run_to_verdict(&scene, &to_the_end).unwrap();
    let three = is_sensitive(&scene, &Script::default(), reached, &to_the_end).unwrap();
    assert!(three);
    assert_eq!(run_with_sensitivity(&scene, &to_the_end).unwrap(), (reached, three));
}

#[test]
#[ignore = "20,000 cells, for release builds: cargo test --release -- --ignored --nocapture"]
fn ten_thousand_cells_have_the_flags_of_the_three_runs() {
    compare(2500, ModelSize::Rigid, 2026);
    compare(2500, ModelSize::Modal, 2027);
}

/// Scene, model, casing damping, speed, pulse \[N\], its duration and the end of the run,
/// next to where one decision turns, which nothing else in the run tells of: each is found
/// by one of the questions asked of a run.
const NEXT_TO_A_TIE: [(&str, &str, f64, f64, f64, f64, f64); 15] = [
    // A slide under a pulse that turns twice, the second time close to an end of the side.
    (
        "nd3",
        "rigid",
        0.1,
        503.6196746995487,
        26387.344079809252,
        0.0012115702254965983,
        0.05403068050602293,
    ),
    // A contact at the end of the run that blades bring forward.
    ("nd4", "modal", 0.01, 395.538496937232, 94149.88672950112, 5e-5, 0.003992155772344817),
    // By the noise alone, and a flight that just misses a side.
    ("nd4", "rigid", 0.01, 65.72992660818522, 566032.1785792182, 7.58215672111019e-5, 0.1),
    // A contact at the instant from which the verdict is judged.
    ("nd4", "rigid", 0.1, 330.45902299843203, 61146.35228112918, 5e-5, 0.0045043657009875395),
    // A touch without speed.
    ("nd4", "rigid", 0.05, 455.99248566353714, 83007.2792051798, 5e-5, 0.052218603092444485),
    // A slide that turns back at the end of a side.
    ("nd3", "rigid", 0.002, 56.84431874956247, 3781.6961074429337, 0.009533864774670822, 0.1),
    // A touch in a corner.
    ("nd4", "rigid", 0.05, 430.76247315478327, 5355.5824796969355, 5e-5, 0.1),
    // A touch at the end of the run, and an end of a side there.
    ("nd4", "rigid", 0.0, 244.97428034835488, 99591.47303916822, 5e-5, 0.1),
    ("nd4", "rigid", 0.0, 344.98807902730937, 76622.81877967434, 5e-5, 0.00592876052757539),
    // A touch that nearly turns back before.
    ("nd4", "modal", 0.1, 249.40416560101676, 472017.2705265101, 5e-5, 0.1),
    // Crossings that are summed one earlier or later, and such a sum at the end of the run.
    ("nd4", "rigid", 0.002, 40.45981229092181, 39152.217858829106, 0.001592240427415285, 0.1),
    (
        "nd4",
        "rigid",
        0.002,
        445.087009799069,
        55196.25399612782,
        9.021777412190821e-5,
        0.017093503844238318,
    ),
    // The time of a lock.
    ("nd4", "rigid", 0.002, 417.5514431972515, 156068.0220737322, 8.937094224936591e-5, 0.1),
    // A touch without a push.
    ("nd3", "modal", 0.01, 464.16520578970784, 21298.028698751703, 0.0054639211027116144, 0.1),
    // Energy that just reaches a side, at the end of the run.
    (
        "nd4",
        "modal",
        0.002,
        427.27523050186187,
        1374.1923081582381,
        0.0004323663502656503,
        0.012500655620308262,
    ),
];

#[test]
fn each_kind_of_tie_is_found() {
    for (name, model, zeta, speed, pulse, duration, end) in NEXT_TO_A_TIE {
        let mut scene = Scene::builtin(&format!("paper-{name}")).unwrap();
        scene.set("solver.model", model).unwrap();
        scene.solver.kind = SolverKind::Event;
        scene.solver.contact = ContactLaw::Unilateral;
        scene.solver.end_s = end;
        scene.casing.damping_ratio = zeta;
        (scene.operation.speed_rad_s, scene.operation.pulse_n) = (speed, pulse);
        scene.operation.pulse_s = duration;
        let scene = scene.checked().unwrap();
        let plain = run_to_verdict(&scene, &to_the_end).unwrap();
        let three = is_sensitive(&scene, &Script::default(), plain, &to_the_end).unwrap();
        assert!(three, "{speed} {pulse}: next to no tie");
        assert!(run_with_sensitivity(&scene, &to_the_end).unwrap().1, "{speed} {pulse}: missed");
    }
}

/// A rigid run by events of the paper's scene with these changes.
fn rigid(changes: &[(&str, &str)]) -> CheckedScene {
    let mut scene = Scene::builtin("paper-nd4").unwrap();
    scene.solver.kind = SolverKind::Event;
    scene.solver.contact = ContactLaw::Unilateral;
    scene.solver.model = ModelSize::Rigid;
    scene.with(changes).unwrap()
}

#[test]
fn a_side_that_a_long_look_nearly_meets_is_not_passed_over() {
    // Its last flight swings 2e-5 of the clearance beyond it, past sides that are 1e-5 away.
    let scene = rigid(&[
        ("casing.modal_stiffness_n_per_m", "1.544e6"),
        ("casing.damping_ratio", "0"),
        ("operation.speed_rad_s", "-358.64251275435083"),
        ("operation.pulse_n", "17754.761817879782"),
        ("operation.pulse_s", "0.0003593499359369136"),
        ("solver.end_s", "0.22530933587419094"),
    ]);
    let (reached, sensitive) = run_with_sensitivity(&scene, &to_the_end).unwrap();
    let three = is_sensitive(&scene, &Script::default(), reached, &to_the_end).unwrap();
    assert_eq!((sensitive, three), (true, true));
}

#[test]
fn round_off_that_outlives_the_pulse_is_not_taken_for_certain() {
    // Some fifty touches, of which the first let a change of the pulse die out, and the
    // later ones amplify what is left, which is round-off.
    for (diameters, blades, zeta, end, speed, pulse) in [
        (4, 22, 0.006132129827678246, 0.03817438146651537, 293.125735240716, 1014434.519717906),
        (2, 54, 0.08651578589583678, 0.029440380967940397, 146.69527545731594, 1135617.4110960308),
    ] {
        let mut scene = Scene::base();
        scene.solver.kind = SolverKind::Event;
        scene.solver.contact = ContactLaw::Unilateral;
        scene.solver.model = ModelSize::Rigid;
        scene.solver.end_s = end;
        scene.bladed_disk.blades = blades;
        scene.casing.damping_ratio = zeta;
        scene.operation.nodal_diameters = diameters;
        scene.operation.speed_rad_s = speed;
        scene.operation.pulse_n = pulse;
        let scene = scene.checked().unwrap();
        let (reached, sensitive) = run_with_sensitivity(&scene, &to_the_end).unwrap();
        let three = is_sensitive(&scene, &Script::default(), reached, &to_the_end).unwrap();
        assert_eq!((sensitive, three), (true, true), "{diameters} {blades} {speed}");
    }
}

#[test]
fn what_is_not_followed_is_run_three_times() {
    let base = cell(0, ModelSize::Rigid, &mut 1);
    let certainty = |change: &dyn Fn(&mut Scene)| {
        let mut scene = base.clone().into_scene();
        change(&mut scene);
        run_with_certainty(&scene.checked().unwrap(), &to_the_end).unwrap().1
    };
    assert_ne!(certainty(&|_| {}), Certainty::Unknown);
    for change in [
        &(|scene: &mut Scene| scene.operation.speed_ramp_rad_s2 = -100.0) as &dyn Fn(&mut Scene),
        &|scene| scene.initial.v_c_m_s = 1e-3,
        &|scene| scene.solver.kind = SolverKind::Explicit,
        &|scene| {
            scene.solver.model = ModelSize::Modal;
            scene.bladed_disk.inertia_kg_m2 = 1e-5;
        },
    ] {
        assert_eq!(certainty(change), Certainty::Unknown);
    }
}
