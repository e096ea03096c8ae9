//! Sentences of every verdict, history and width.

use super::*;
use rubscope_solver::motion::simulate;
use rubscope_solver::scene::Scene;

const WIDTHS: std::ops::RangeInclusive<usize> = 40..=200;

fn facts(verdict: Verdict) -> Facts {
    let scene = Scene::base().with(&[("solver.end_s", "1e-6")]).unwrap();
    let all = Facts::of(&simulate(&scene));
    let (blades, law) = (vec![19, 12], ContactLaw::Unilateral);
    Facts { verdict, blades, touches: 5, law, seen: None, still: false, ..all }
}

const SEEN: Seen = Seen { span_s: 0.01, without_contact_s: 0.012_345, reach: Some(0.943) };

const ENDS: Certainty = Certainty { sensitive: true, ends_otherwise: true, depends_on_step: None };

fn pulled(verdict: Verdict, other: Option<Verdict>) -> Facts {
    Facts { pulled: true, other, law: ContactLaw::Bilateral, ..facts(verdict) }
}

fn failures() -> Vec<FailureReason> {
    use FailureReason as Reason;
    let (angle_rad, rows) = (0.1, 7);
    vec![
        Reason::BladeAngle { angle_rad },
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

/// Asserts whole sentences that fit, of at most eighteen words each. One that has room in a
/// width is the one of every width down to its own.
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
    for sensitive in [Certainty::default(), ENDS] {
        for verdict in Verdict::ALL {
            let facts = Facts { certainty: sensitive, ..pulled(verdict, Some(Verdict::Decay)) };
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
    let sentences = told.history.iter().chain([&told.what]);
    for sentence in sentences.flat_map(|text| text.split_inclusive(". ")).map(str::trim_end) {
        assert!(sentence.ends_with('.') && !sentence.contains(".."), "{width}: {line}");
        assert!(sentence.split_whitespace().count() <= 18, "{width}: {line}");
        assert!(
            sentence.starts_with(|c: char| c.is_ascii_uppercase() || c.is_ascii_digit()),
            "{line}"
        );
    }
}

type Change = fn(&mut Facts);

/// Every kind of history, as a change of the facts of a run, and whether it makes the result
/// suspect.
fn histories() -> Vec<(bool, Change)> {
    vec![
        (false, |_| {}),
        (false, |facts| facts.certainty = ENDS),
        (false, |facts| facts.certainty = Certainty { ends_otherwise: false, ..ENDS }),
        (true, |facts| facts.certainty.depends_on_step = Some(true)),
        (false, |facts| facts.seen = Some(SEEN)),
        (true, |facts| facts.growth = Some(12.345)),
        (false, |facts| facts.round = Some(2.439_28e-7)),
        (false, |facts| facts.caught = Some((292.149, true))),
        (false, |facts| facts.caught = Some((-4_292.149, false))),
        (false, |facts| facts.pulled = true),
        (false, |facts| (facts.pulled, facts.certainty) = (true, ENDS)),
    ]
}

#[test]
fn every_verdict_law_failure_and_history_has_whole_sentences_at_every_width() {
    let blades: [&[u32]; 6] =
        [&[], &[7], &[1012, 1019], &[1001, 1006, 1012], &[1, 6, 12, 17], &[1, 2, 3, 4, 5, 6]];
    let mut stopped: Vec<Option<FailureReason>> = failures().into_iter().map(Some).collect();
    stopped.push(None);
    let others =
        [None, Some(Verdict::Decay), Some(Verdict::Locked), Some(Verdict::Failed)].into_iter();
    for (verdict, other) in Verdict::ALL
        .into_iter()
        .flat_map(|verdict| others.clone().map(move |other| (verdict, other)))
    {
        let run = facts(verdict);
        for law in [ContactLaw::Unilateral, ContactLaw::Bilateral, ContactLaw::Smooth] {
            for (wrong, change) in histories() {
                let early = matches!(verdict, Verdict::Failed | Verdict::Divergent);
                for reason in stopped.iter().filter(|reason| early || reason.is_none()) {
                    for (case, blades) in blades.iter().enumerate() {
                        let mut facts = Facts {
                            law,
                            blades: blades.to_vec(),
                            pulling: blades.iter().copied().take(case % 3).collect(),
                            touches: [0, 1, 5, 143, 2, 1_234_567][case],
                            clearance_m: if law == ContactLaw::Smooth && case % 2 == 0 {
                                -1e-5
                            } else {
                                1e-4
                            },
                            damped: case != 2,
                            broken: (case == 3).then_some(411.933_5),
                            failure: reason
                                .clone()
                                .map(|reason| Failure { t_s: 1.234_5e-4, reason }),
                            other,
                            ..run.clone()
                        };
                        change(&mut facts);
                        assert_reads_well(&facts);
                        let sure = !facts.certainty.sensitive && !facts.pulled;
                        let differs = sure && other.is_some_and(|other| other != verdict);
                        assert_eq!(facts.sentence(200).wrong, wrong || differs, "{facts:?}");
                    }
                }
            }
        }
    }
}

/// A line of the picture is one run's facts, at the width of a terminal.
#[test]
fn a_run_says_its_own_facts() {
    use Verdict::{Adhesive, Decay, Locked};
    let (locked, decay) = (facts(Locked), facts(Decay));
    let on_step = Certainty { depends_on_step: Some(true), ..Certainty::default() };
    let judged = Facts { seen: Some(SEEN), ..decay.clone() };
    let near = |reach| Facts { seen: Some(Seen { reach: Some(reach), ..SEEN }), ..decay.clone() };
    let rubs = Some(Seen { without_contact_s: 0.0, ..SEEN });
    let failed = Facts { failure: Some(failure()), ..facts(Verdict::Failed) };
    let round = Facts { round: Some(2.439_28e-7), ..locked.clone() };
    let mut told = Vec::new();
    let sure = Certainty::default();
    for (width, certainty) in
        [(40, sure), (79, sure), (120, sure), (60, ENDS), (80, ENDS), (200, ENDS)]
    {
        let facts = Facts { certainty, ..pulled(Locked, Some(Decay)) };
        told.push(facts.sentence(width).to_string());
    }
    for facts in [
        locked.clone(),
        pulled(Locked, None),
        pulled(Locked, Some(Locked)),
        Facts { caught: Some((291.98, true)), ..locked.clone() },
        round.clone(),
        Facts { tips: Some(7.5e-7), ..round },
        Facts { certainty: ENDS, ..locked.clone() },
        Facts { certainty: Certainty { ends_otherwise: false, ..ENDS }, ..locked.clone() },
        Facts { certainty: on_step, ..locked.clone() },
        Facts { blades: vec![4], ..locked },
        Facts { pulling: vec![19], ..pulled(Adhesive, Some(Decay)) },
        decay.clone(),
        Facts { touches: 0, damped: false, ..decay.clone() },
        Facts { broken: Some(380.26), ..decay.clone() },
        near(0.9949),
        near(0.9951),
        near(1.06),
        Facts { seen: rubs, law: ContactLaw::Smooth, ..decay.clone() },
        Facts { still: true, touches: 0, ..decay },
        Facts { verdict: Verdict::Slip, ..judged.clone() },
        judged,
        failed.clone(),
        Facts { certainty: on_step, ..failed },
    ] {
        told.push(facts.sentence(200).to_string());
    }
    insta::assert_snapshot!(told.join("\n"));
}

fn failure() -> Failure {
    let reason = FailureReason::Penetration { depth_m: 1.0, clearance_m: 0.5 };
    Failure { t_s: 2e-4, reason }
}
