//! Tests of claims.

use super::super::figures;
use super::*;

fn verdict(checks: &'static [Check], values: &[(&str, f64)]) -> Outcome<Verdict> {
    let measured: Vec<Measured> =
        values.iter().map(|(what, value)| Measured { what: (*what).to_owned(), value: *value }).collect();
    Claim { text: "it is so", checks }.verdict("elek-2", &measured)
}

#[test]
fn a_claim_fails_with_its_first_number_that_does() {
    const CHECKS: [Check; 2] = [Check::Falls(&["a", "b", "c"]), Check::Within("a", 2.0, 3.0)];
    let all = verdict(&CHECKS, &[("a", 3.0), ("b", 2.0), ("c", 1.0)]).ok();
    let all = all.filter(|all| all.holds).map(|all| all.because);
    assert_eq!(all, Some(vec!["a 3.000 > b 2.000 > c 1.000".to_owned(), "a 3.000, within 2.000 to 3.000".to_owned()]));
    let one = verdict(&CHECKS, &[("a", 3.0), ("b", 2.0), ("c", 2.0)]).ok();
    let one = one.filter(|one| !one.holds).map(|one| one.because);
    assert_eq!(one, Some(vec!["a 3.000, then b 2.000, then c 2.000".to_owned()]));
    for nothing in [f64::NAN, 3.1, 1.9] {
        assert!(verdict(&CHECKS[1..], &[("a", nothing)]).is_ok_and(|verdict| !verdict.holds), "{nothing}");
    }
    assert!(verdict(&CHECKS, &[("a", 3.0)]).is_err());
}

/// A claim without a comparison would hold always.
#[test]
fn every_figure_has_a_claim_that_can_fail() {
    for figure in figures() {
        assert!(!figure.claim.checks.is_empty() && figure.claim.text.ends_with('.'), "{}", figure.name);
    }
}
