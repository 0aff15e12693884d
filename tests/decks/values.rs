//! Every deck runs and meets the values it carries. One that is meant to end otherwise says so among its comments:
//!   # exit code 4        no convergence; it need not carry values
//!   # says: WORDS        of the failure
//!   # warns: WORDS       of what is said when the deck is read
//! What they expect and what comes out is the table of docs/validation.md.

use crate::docs::{self, Validated};
use crate::support;
use rdsolve::solve::Outcome;

#[test]
fn every_deck_meets_its_values() {
    let found = support::deck_names();
    let (mut misses, mut validated) = (Vec::new(), Vec::new());
    for name in &found {
        let comments = support::comments(name);
        let said = support::warnings(name, &[]);
        for words in comments.after("warns: ") {
            if !said.iter().any(|warning| warning.contains(words)) {
                misses.push(format!("{name} does not warn of `{words}`: {said:?}"));
            }
        }
        let model = support::read(name, &[]);
        let (stages, whole);
        let done = match model.analysis.stage {
            Some(_) => {
                stages = support::run_deck(name, &mut |_| Vec::new());
                &stages
            }
            None => {
                whole = support::witness::whole(name);
                &whole.done
            }
        };
        let c = done.counts;
        println!(
            "{name:40} {:3} values, {:7} steps, {:4.1} iterations a step, {:6} factorizations, {:3} cuts, {:8.4} s",
            done.verdicts.len(),
            c.steps,
            c.iterations as f64 / c.steps as f64,
            c.factorizations,
            c.cuts,
            done.seconds
        );
        let fails = comments.after("exit code ").any(|code| code == "4");
        match &done.outcome {
            Outcome::Done if fails => misses.push(format!("{name} should not have come to its end")),
            Outcome::Done => {}
            Outcome::Failed { failure, .. } if fails => {
                let text = failure.to_string();
                let missing = comments.after("says: ").filter(|words| !text.contains(words));
                misses.extend(missing.map(|words| format!("{name} does not say `{words}`: {text}")));
                if done.verdicts.is_empty() {
                    continue;
                }
            }
            Outcome::Failed { time, failure } => misses.push(format!("{name}: at t = {time}: {failure}")),
            other => misses.push(format!("{name}: {other:?}")),
        }
        if done.verdicts.is_empty() {
            misses.push(format!("{name} carries no values"));
        }
        let missed = done.verdicts.iter().filter(|verdict| !verdict.passed);
        misses.extend(missed.map(|v| format!("{name}: {}: {}", v.label, v.reason.as_deref().unwrap_or_default())));
        validated.push(Validated { deck: name.clone(), title: model.title.clone(), verdicts: done.verdicts.clone() });
    }
    assert!(misses.is_empty(), "\n{}", misses.join("\n"));
    docs::keep_validation(&validated);
}
