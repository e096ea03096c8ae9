//! Sentences of every verdict, doubt and width.

use super::*;
use rubscope_solver::motion::{Sampling, Script, run_to_end};
use rubscope_solver::scene::{BUILTIN, Scene};

const WIDTHS: std::ops::RangeInclusive<usize> = 40..=200;

fn facts(verdict: Verdict) -> Facts {
    Facts {
        verdict,
        blades: vec![19, 12],
        pulling: Vec::new(),
        touches: 5,
        law: ContactLaw::Unilateral,
        pressed: false,
        damped: true,
        broken: None,
        failure: None,
        doubts: Vec::new(),
    }
}

fn failures() -> Vec<FailureReason> {
    use FailureReason as Reason;
    let (angle_rad, rows) = (0.1, 7);
    vec![
        Reason::BladeAngle { angle_rad },
        Reason::CornerAngle { angle_rad, most_rad: 0.01 },
        Reason::TwoSides { angle_rad },
        Reason::NoCorner { radius_m: 0.1 },
        Reason::Ramp,
        Reason::Series,
        Reason::Events,
        Reason::EventsAtOnce,
        Reason::Looks,
        Reason::Rows { rows },
        Reason::Displacement { distance_m: 1.0, radius_m: 0.1 },
        Reason::CasingSpeed { speed_m_s: 1.0, tip_m_s: 0.5 },
        Reason::LongStep { moved_m: 1.0, side_m: 0.5 },
        Reason::Penetration { depth_m: 1.0, clearance_m: 0.5 },
        Reason::Singular { rows },
    ]
}

/// Whole sentences that fit, of at most twelve words each.
/// Looks at the sentences of all widths. One that has room in a width is the one of every
/// width down to its own: what does not fit above does not fit there.
fn assert_reads_well(facts: &Facts) {
    let mut width = *WIDTHS.end();
    while WIDTHS.contains(&width) {
        let sentence = facts.sentence(width);
        let own = sentence.to_string().chars().count();
        assert!(own <= width, "{width}: {sentence}");
        assert_is_whole(&sentence, width);
        width = own - 1;
    }
}

#[test]
fn a_sentence_is_the_one_of_every_width_down_to_its_own() {
    for doubts in
        [vec![], vec![Doubt::Pulls(7, Some(Verdict::Decay)), Doubt::Sensitive { ends: true }]]
    {
        for verdict in Verdict::ALL {
            let facts = Facts { doubts: doubts.clone(), ..facts(verdict) };
            for width in WIDTHS {
                let wide = facts.sentence(width);
                let own = wide.to_string().chars().count();
                assert_eq!(facts.sentence(own.max(*WIDTHS.start())), wide, "{width}");
            }
        }
    }
}

fn assert_is_whole(told: &Sentence, width: usize) {
    let line = told.to_string();
    assert!(line.is_ascii(), "{width}: {line}");
    let doubts = told.doubt.iter().flat_map(|doubt| doubt.split_inclusive(". "));
    for sentence in std::iter::once(told.what.as_str()).chain(doubts).map(str::trim_end) {
        assert!(sentence.ends_with('.') && !sentence.contains(".."), "{width}: {line}");
        assert!(sentence.split_whitespace().count() <= 12, "{width}: {line}");
        assert!(
            sentence.starts_with(|c: char| c.is_ascii_uppercase() || c.is_ascii_digit()),
            "{line}"
        );
    }
}

#[test]
fn every_verdict_law_failure_and_doubt_has_a_whole_sentence_at_every_width() {
    let blades: [&[u32]; 5] =
        [&[], &[7], &[1012, 1019], &[1001, 1006, 1012, 1017], &[1, 2, 3, 4, 5, 6]];
    let mut doubts = vec![
        None,
        Some(Doubt::Sensitive { ends: true }),
        Some(Doubt::Sensitive { ends: false }),
        Some(Doubt::Step),
    ];
    for other in Verdict::ALL {
        doubts.extend([1, 1_000_000].map(|steps| Some(Doubt::Pulls(steps, Some(other)))));
        doubts.extend([Cause::Step, Cause::Angles].map(|cause| Some(Doubt::Differs(other, cause))));
    }
    doubts.push(Some(Doubt::Pulls(2, None)));
    let mut doubts: Vec<Vec<Doubt>> =
        doubts.into_iter().map(|doubt| doubt.into_iter().collect()).collect();
    doubts.push(vec![Doubt::Pulls(7, Some(Verdict::Decay)), Doubt::Sensitive { ends: true }]);
    let mut stopped: Vec<Option<FailureReason>> = failures().into_iter().map(Some).collect();
    stopped.push(None);
    for verdict in Verdict::ALL {
        for law in [ContactLaw::Unilateral, ContactLaw::Bilateral, ContactLaw::Smooth] {
            for doubt in &doubts {
                let early = matches!(verdict, Verdict::Failed | Verdict::Divergent);
                for reason in stopped.iter().filter(|reason| early || reason.is_none()) {
                    for (case, blades) in blades.iter().enumerate() {
                        let facts = Facts {
                            law,
                            blades: blades.to_vec(),
                            pulling: blades.iter().copied().take(case % 3).collect(),
                            touches: [0, 1, 5, 143, 1_234_567][case],
                            pressed: law == ContactLaw::Smooth && case % 2 == 0,
                            damped: case != 2,
                            broken: (case == 3).then_some(411.933_5),
                            failure: reason
                                .clone()
                                .map(|reason| Failure { t_s: 1.234_5e-4, reason }),
                            doubts: doubt.clone(),
                            ..facts(verdict)
                        };
                        assert_reads_well(&facts);
                        assert_eq!(facts.sentence(200).doubt.is_none(), doubt.is_empty());
                    }
                }
            }
        }
    }
}

#[test]
fn every_built_in_scene_ends_in_a_whole_sentence() {
    for scene in BUILTIN {
        let scene = Scene::builtin(scene.name).unwrap().checked().unwrap();
        let report = run_to_end(&scene, &Script::default(), Sampling::default(), &mut |_| {});
        let facts = Facts::of(&report);
        assert_eq!(facts.verdict, report.outcome.verdict);
        assert_reads_well(&facts);
    }
}

#[test]
fn a_run_that_pulls_is_called_sensitive_too_where_it_is() {
    let both = Facts {
        doubts: vec![Doubt::Pulls(2, Some(Verdict::Decay)), Doubt::Sensitive { ends: true }],
        ..facts(Verdict::Locked)
    };
    let doubt = |width| both.sentence(width).doubt.unwrap();
    assert_eq!(
        doubt(200),
        "A real contact would let go: 2 steps pull. \
         A tiny change of pulse or speed ends otherwise."
    );
    assert_eq!(doubt(80), "A real contact would let go. Sensitive.");
    assert_eq!(doubt(55), "But 2 steps pull. Sensitive.");
    assert_eq!(doubt(49), "But it pulls. Sensitive.");
    // The worse one alone, where there is no room for two.
    assert_eq!(doubt(48), "But 2 steps pull.");
}

#[test]
fn what_is_told_at_the_widths_of_terminals() {
    let locked = Facts {
        doubts: vec![Doubt::Pulls(2, Some(Verdict::Decay))],
        law: ContactLaw::Bilateral,
        ..facts(Verdict::Locked)
    };
    let told = |facts: &Facts, width| facts.sentence(width).to_string();
    for (width, line) in [
        (40, "LOCKED  12 + 19 hold it. But it pulls."),
        (60, "LOCKED  Blades 12 and 19 hold the wave. But 2 steps pull."),
        (80, "LOCKED  Blades 12 and 19 hold the casing's wave. A real contact would let go."),
        (
            120,
            "LOCKED  Blades 12 and 19 hold the casing's wave and carry it round. \
             A real contact would let go: 2 steps pull.",
        ),
    ] {
        assert_eq!(told(&locked, width), line);
    }
}

#[test]
fn a_run_says_its_own_facts() {
    let told = |facts: Facts| facts.sentence(120).to_string();
    let decay = facts(Verdict::Decay);
    assert_eq!(
        told(decay.clone()),
        "DECAY  The blades let go after 5 touches; the casing comes to rest."
    );
    let free = Facts { touches: 0, damped: false, ..decay.clone() };
    assert_eq!(told(free), "DECAY  No blade touches; the casing swings on freely.");
    let broken = Facts { broken: Some(380.26), ..decay };
    assert_eq!(
        told(broken),
        "DECAY  The lock breaks at 380.3 rad/s; then the casing comes to rest."
    );
    let held = Facts { blades: vec![4], ..facts(Verdict::Locked) };
    assert_eq!(told(held), "LOCKED  Blade 4 holds the casing's wave and carries it round.");
    let failure = Failure {
        t_s: 2e-4,
        reason: FailureReason::Penetration { depth_m: 1.0, clearance_m: 0.5 },
    };
    let failed = Facts { failure: Some(failure), ..facts(Verdict::Failed) };
    assert_eq!(told(failed), "FAILED  The computation stops at 200 us: the step is too long.");
}
