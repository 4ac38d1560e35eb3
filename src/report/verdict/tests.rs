//! Tests of verdicts by method and in both systems of units.

use super::*;
use crate::model::Stages;

fn sentences(limits: &[(&str, &str)], system: System) -> Vec<String> {
    let mut case = Case::table_1();
    for (quantity, text) in limits {
        case.set_limit(quantity, text).unwrap();
    }
    let solution = crate::model::solve(&case.inputs().unwrap(), Stages::ALL).unwrap();
    verdicts(&case, &solution)
        .iter()
        .map(|verdict| format!("{} {}", verdict.standing.word(), verdict.sentence(system)))
        .collect()
}

#[test]
fn a_limit_on_the_free_impact_is_followed_by_the_counterpart_in_the_method() {
    let verdicts = |method, limit| {
        let mut case = Case::table_1();
        case.set("model.method", method).unwrap();
        case.set_limit("impact_force", limit).unwrap();
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
        verdicts(&case, &solution)
            .iter()
            .map(|verdict| (verdict.standing, verdict.to_string()))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        verdicts("exact", "2500 N"),
        [(Standing::Within, "impact_force 2191.0 N <= 2500 N (88 %)".to_owned())]
    );
    let [(standing, sentence)] = &verdicts("dynamic", "2100 N")[..] else { panic!("one limit") };
    assert_eq!(*standing, Standing::Within);
    assert!(
        sentence.ends_with(
            " for the free impact. Method dynamic: dynamic_peak_approach_force 1410.8 N; this \
                quantity has no limit"
        ),
        "{sentence}"
    );
    let [(standing, sentence)] = &verdicts("static", "1 kN")[..] else { panic!("one limit") };
    assert_eq!(*standing, Standing::Exceeded);
    assert!(
        sentence.ends_with(
            " for the free impact. Method static: static_force_at_start 1466.2 N, above this \
                limit; this quantity has no limit"
        ),
        "{sentence}"
    );
}

#[test]
fn a_limit_without_a_value_gives_the_reason_and_passes_only_without_contact() {
    let stands = |method, relief, key, limit| {
        let mut case = Case::table_1();
        case.set("model.method", method).unwrap();
        case.set("driven.tip_relief", relief).unwrap();
        case.set("limits.impact_force", "").unwrap();
        case.set_limit(key, limit).unwrap();
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
        let verdict = verdicts(&case, &solution).remove(0);
        (verdict.standing, verdict.to_string())
    };
    let (standing, sentence) = stands("exact", "0 um", "dynamic_peak_force", "2 kN");
    assert_eq!(standing, Standing::Unknown);
    assert_eq!(
        sentence,
        "dynamic_peak_force has no value (limit 2 kN): method exact does not compute this \
            quantity; dynamic and auto do"
    );
    // The closed form has no result for the motion.
    assert_eq!(stands("exact", "80 um", "dynamic_peak_force", "2 kN").0, Standing::Unknown);
    assert_eq!(stands("exact", "80 um", "impact_force", "2 kN").0, Standing::NotApplicable);
    let (standing, sentence) = stands("static", "80 um", "pitch_contact_jump", "2 kN");
    assert_eq!(standing, Standing::Unknown);
    assert!(sentence.ends_with("the case has no operation.friction_coefficient"), "{sentence}");
    for key in ["steady_back_force", "dynamic_back_strikes"] {
        let limit = if key.ends_with("force") { "1 N" } else { "1" };
        let (_, sentence) = stands("dynamic", "0 um", key, limit);
        assert!(sentence.contains("the case has no deviations.backlash"), "{sentence}");
    }
    assert_eq!(
        stands("static", "80 um", "static_first_contact_angle", "1 deg").0,
        Standing::NotApplicable
    );
}

#[test]
fn a_counterpart_with_a_limit_of_its_own_needs_no_hint() {
    let mut case = Case::table_1();
    case.set("model.method", "static").unwrap();
    case.set_limit("static_force_at_start", "1 kN").unwrap();
    let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
    let sentence = verdicts(&case, &solution)[0].to_string();
    assert!(sentence.ends_with("Method static: static_force_at_start 1466.2 N"), "{sentence}");
}

#[test]
fn a_verdict_prints_the_limit_as_written_in_both_systems() {
    let limits = [("impact_force", "500 lbf"), ("contact_ratio", "1.5")];
    assert_eq!(
        sentences(&limits, System::Metric),
        [
            "ok impact_force 2191.0 N <= 500 lbf (99 %)",
            "EXCEEDED contact_ratio 1.5568 > 1.5 (104 %)"
        ]
    );
    assert_eq!(sentences(&limits, System::Inch)[0], "ok impact_force 492.56 lbf <= 500 lbf (99 %)");
}

#[test]
fn a_refused_case_gives_the_reason_for_every_limit() {
    let case = Case::table_1();
    let verdicts = refused(
        &case,
        &Refusal::ContactRatioBelowOne { ratio: 0.9, is_deflection_taken: true, cut: None },
    );
    assert!(!verdicts[0].standing.holds());
    assert!(
        verdicts[0]
            .to_string()
            .starts_with("impact_force cannot be computed: the contact ratio is 0.9000")
    );
}
