//! Every failure of a run in words: what and where with its value, what it means, what to change.

use crate::support::assert_three_parts;
use insta::assert_snapshot;
use rdsolve::solve::inner::{Instability, NoConvergence};
use rdsolve::solve::modes::ModesFault;
use rdsolve::solve::{Failure, NamedResidual};

fn largest() -> Vec<NamedResidual> {
    let residual = |label: &str, residual| NamedResidual { label: label.to_owned(), direction: "uz", residual };
    vec![residual("tip", -31.4), residual("knee", f64::NAN)]
}

/// All but those of modes, those with several wordings more than once.
fn failures() -> Vec<Failure> {
    let (label, name, direction) = (|| "tip".to_owned(), || "floor".to_owned(), "uz");
    let open = || Some("contact `floor` (gap 0.001)".to_owned());
    let growth = |scheme: Option<&str>| Failure::EnergyGrowth {
        ratio: 3.0,
        scheme: scheme.map(str::to_owned),
        shortens: "time_step".to_owned(),
        kept_until: 0.2,
    };
    let singular = |open, at_start| Failure::Singular { label: label(), direction, open, at_start, yielded: None };
    let massless = |rotation, buckles, open| Failure::MasslessDirection {
        label: label(),
        rotation,
        direction: [0.0, 0.6, 0.8],
        buckles,
        open,
    };
    let stuck = |cause: NoConvergence, open, lacks_slip| Failure::NotConverged {
        iterations: 20,
        cause: Box::new(cause),
        open,
        lacks_slip,
        yielded: cause.at_limit.then(|| "shell `wall` yields most".to_owned()),
        largest: largest(),
    };
    let inertia = |label: &str, residual| NamedResidual { label: label.to_owned(), direction: "", residual };
    let none = NoConvergence::default();
    let found =
        Instability { time: 0.41, certain: true, modes: 1, label: label(), direction, ..Instability::default() };
    vec![
        singular(None, true),
        singular(open(), false),
        massless(false, false, None),
        massless(true, false, open()),
        massless(false, true, None),
        stuck(none, None, false),
        stuck(none, open(), false),
        stuck(NoConvergence { at_limit: true, ..none }, None, false),
        stuck(NoConvergence { least_step: Some(1e-3), ..none }, None, false),
        stuck(NoConvergence { moves: true, ..none }, None, false),
        stuck(NoConvergence { enough: Some(37), ..none }, None, true),
        Failure::ConstraintsViolated { largest: largest(), inertias: Vec::new() },
        Failure::ConstraintsViolated {
            largest: Vec::new(),
            inertias: vec![inertia("rod", 1e-14), inertia("hub", 2.0)],
        },
        Failure::TooManySubsteps {
            steps: 1,
            substeps: 1024,
            dt: 1e-6,
            cause: Box::new(Failure::ContactNotResolved { name: name() }),
        },
        Failure::NoEquilibriumOnArc { largest: largest() },
        Failure::NoLoadIncrement { time: 0.5 },
        Failure::TooManySteps { steps: 100 },
        Failure::ContactNotResolved { name: name() },
        Failure::ContactNotClosed { name: name(), out: 3.2 },
        Failure::BushingTurnedOver { name: name() },
        Failure::BushingTurnsTooFar { name: name(), dt: 1e-3 },
        Failure::GivenRotationLost { label: label() },
        Failure::Unstable { dt: 1e-5, longest: 8.6e-6, automatic: false },
        Failure::Unstable { dt: 1e-5, longest: 8.6e-6, automatic: true },
        growth(None),
        growth(Some("newmark")),
        Failure::RotationTooLarge { dt: 1e-3 },
        Failure::LoadStepTurns { label: label(), angle: 1.6 },
        Failure::NodeTurns { label: label(), angle: 1.6 },
        Failure::TurnedOver { name: name() },
        Failure::EquilibriumJumps {
            label: label(),
            direction,
            work: 3.0,
            stored: 1.0,
            smooth: Some("plates".to_owned()),
        },
        Failure::UnstableStep,
        Failure::Buckles(found),
        Failure::ErrorTooLarge { dt: 1e-9 },
        Failure::NotFinite { largest: largest() },
        Failure::Stopped,
        Failure::PathCreeps { steps: 200, from: 0.24581, to: 0.24612 },
        Failure::TimeWentBack { begin: 1.39, end: 0.61 },
        Failure::OutOfReach { name: "cylinder".to_owned(), position: 1.0583, times: 1234.5 },
    ]
}

/// The number of a kind: a new one is a number here, and an entry above.
fn kind(failure: &Failure) -> usize {
    match failure {
        Failure::Singular { .. } => 0,
        Failure::MasslessDirection { .. } => 1,
        Failure::NotConverged { .. } => 2,
        Failure::ConstraintsViolated { .. } => 3,
        Failure::TooManySubsteps { .. } => 4,
        Failure::NoEquilibriumOnArc { .. } => 5,
        Failure::NoLoadIncrement { .. } => 6,
        Failure::TooManySteps { .. } => 7,
        Failure::ContactNotResolved { .. } => 8,
        Failure::ContactNotClosed { .. } => 9,
        Failure::BushingTurnedOver { .. } => 10,
        Failure::BushingTurnsTooFar { .. } => 11,
        Failure::GivenRotationLost { .. } => 12,
        Failure::Unstable { .. } => 13,
        Failure::EnergyGrowth { .. } => 14,
        Failure::RotationTooLarge { .. } => 15,
        Failure::LoadStepTurns { .. } => 16,
        Failure::NodeTurns { .. } => 17,
        Failure::TurnedOver { .. } => 18,
        Failure::EquilibriumJumps { .. } => 19,
        Failure::UnstableStep => 20,
        Failure::Buckles(_) => 21,
        Failure::ErrorTooLarge { .. } => 22,
        Failure::NotFinite { .. } => 23,
        Failure::Stopped => 24,
        Failure::PathCreeps { .. } => 25,
        Failure::OutOfReach { .. } => 26,
        Failure::TimeWentBack { .. } => 27,
        Failure::Modes(_) => 28,
    }
}

#[test]
fn every_failure_says_what_it_means_and_what_to_change() {
    let failures = failures();
    for number in 0..=27 {
        assert!(failures.iter().any(|failure| kind(failure) == number), "no example of kind {number}");
    }
    let texts: Vec<String> = failures.iter().map(ToString::to_string).collect();
    texts.iter().for_each(|text| assert_three_parts(text));
    assert_snapshot!("failures", texts.join("\n\n"));
}

#[test]
fn every_failure_of_modes_says_what_to_change() {
    let faults = [
        ModesFault::NoMass,
        ModesFault::Singular { label: "tip".to_owned(), direction: "uz" },
        ModesFault::NotConverged { wanted: 9 },
        ModesFault::Missed { found: 4, there: 7 },
        ModesFault::TooMany { there: 900, most: 500 },
        ModesFault::MovedSupport,
        ModesFault::UnstableUnloaded,
        ModesFault::NoLoads,
        ModesFault::NoBuckling,
        ModesFault::NothingExcites,
        ModesFault::Stopped,
    ];
    let texts: Vec<String> = faults.into_iter().map(|fault| Failure::Modes(fault).to_string()).collect();
    texts.iter().for_each(|text| assert_three_parts(text));
    assert_snapshot!("failures_of_modes", texts.join("\n\n"));
}
