//! The tractor of decks/safety_cab: each blow until the cab has sprung back from it. Whole runs, finer meshes and the balance
//! of energies are the business of decks/safety_cab/safety_cab.py.

use crate::support;
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::output::expect::Verdict;
use rdsolve::solve::Outcome;
use std::fs;

fn read(blow: &str, sets: &[&str]) -> Model {
    let path = support::decks().join("safety_cab").join(format!("{blow}.toml"));
    let text = fs::read_to_string(&path).expect("a deck");
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let source = Source::new(path.display().to_string(), text, &sets);
    let (model, problems) = model::read(&source);
    model
        .unwrap_or_else(|| panic!("{}", problems.iter().map(|p| p.draw(&source, false)).collect::<Vec<_>>().join("\n")))
}

fn run(blow: &str, sets: &[&str]) -> Vec<Verdict> {
    let done = support::run(&read(blow, sets), &mut |_| Vec::new());
    assert!(matches!(done.outcome, Outcome::Done), "{blow}: {:?}", done.outcome);
    println!("{blow:6} {:5} unknowns, {:5} steps, {:6.2} s", done.unknowns, done.counts.steps, done.seconds);
    done.verdicts
}

/// The cab is deflected the most at 0.08 to 0.17 s.
const END: &str = "analysis.end_time=0.2";

/// Steps half as long again as those of the decks: they change the deflections by 0.2 %, of a tolerance of 1 %, and the balance of energies
/// is up to half of what the decks allow.
const STEP: &str = "analysis.time_step=7.5e-4";

/// Twice the steps of the decks change the ratio of two deflections by 0.0005, of 0.04.
const LONG_STEP: &str = "analysis.time_step=1e-3";

#[test]
fn every_blow_meets_its_values() {
    for blow in ["rear", "front", "side"] {
        for verdict in run(blow, &[END, STEP]) {
            assert!(verdict.passed, "{blow}: {}: {}", verdict.label, verdict.reason.unwrap_or_default());
        }
    }
}

/// What the paper is about: the answer hardly asks whether the tractor bends.
#[test]
fn the_tractor_may_be_rigid() {
    let coarse = "mesh.file=cab_coarse.msh";
    let deflection = |sets: &[&str]| run("side", sets)[0].value.expect("a peak");
    let rigid = deflection(&[END, LONG_STEP, coarse]);
    let bends = deflection(&[END, LONG_STEP, coarse, "beams.backbone.rigid=false"]);
    // The backbone gives way by a few of some 250 mm, and the cab is spared as much.
    assert!((bends / rigid - 1.0).abs() < 0.04, "{rigid} {bends}");
    assert!(bends != rigid);
}

/// All of the approval on one cab: three blows, between which it comes to rest, the crushing test and the belts. Twice the steps of the deck
/// in the blows leave the values within 0.9 % and half of the energies, of 1.5 % and all.
#[test]
fn the_approval_meets_its_values() {
    let path = support::decks().join("safety_cab").join("approval.toml");
    let text = fs::read_to_string(&path).expect("a deck");
    let long_steps = [0, 2, 4].map(|stage| format!("stages.{stage}.time_step=1e-3"));
    let done = support::run_source(&Source::new(path.display().to_string(), text, &long_steps), &mut |_| Vec::new());
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    for verdict in done.verdicts {
        assert!(verdict.passed, "{}: {}", verdict.label, verdict.reason.unwrap_or_default());
    }
}
