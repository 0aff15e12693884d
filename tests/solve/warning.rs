//! Every warning and remark of a run in words: what and where with its value, what it means, what to change.

use crate::support::assert_three_parts;
use insta::assert_snapshot;
use rdsolve::solve::Warning;
use rdsolve::solve::inner::{ContactThrows, Instability, Remark, SlipBegins};

fn instability(already: bool, certain: bool) -> Instability {
    let (label, direction) = ("knee".to_owned(), "uy");
    Instability { time: 0.41, already, certain, modes: 1, seen: 0.45, label, direction, ..Instability::default() }
}

fn slip(name: &str) -> SlipBegins {
    SlipBegins { name: name.to_owned(), error: 2e-3, farthest: 0.05, ..SlipBegins::default() }
}

/// All of them, those with several wordings more than once.
fn warnings() -> Vec<Warning> {
    let name = || "floor".to_owned();
    let throws = ContactThrows { name: name(), speed: 0.02, slid: 1e-3, stiffness: [1e8, 2e5], step: [1e-3, 2e-5] };
    let on_contact = SlipBegins { stiffness: Some([1e5, 1e7]), step: Some(1e-4), ..slip("floor") };
    let in_joint = SlipBegins { stick: Some(1e-6), ..slip("pin") };
    vec![
        Warning::InitialVelocities { change: 0.25 },
        Warning::StepError { asked: 1e-3, estimate: Some(4.2e-3) },
        Warning::StepError { asked: 1e-3, estimate: None },
        Warning::RunsPart { asked: 1e-3, difference: 0.3 },
        Warning::Unbalanced { residual: 2e-5 },
        Warning::DeepContact { name: name(), depth: 0.06, size: 0.1, stiffness: [9e3, 5.2e4, 2e-5] },
        Warning::Unstable(instability(false, true)),
        Warning::Unstable(instability(true, false)),
        Warning::UnstableOutOfPlane(instability(false, true)),
        Warning::UnstableOutOfPlane(instability(true, false)),
        Warning::Grows { modes: 2, rate: 3.132, fastest: 1 },
        Warning::Modes("no mode lies below `up_to` = 1, so the list is empty. Give `up_to` = 10".to_owned()),
        Warning::SideBySide { name: name() },
        Warning::Crowded { name: name() },
        Warning::BeginsClosed { name: name(), depth: 0.012 },
        Warning::LargeStrain { name: "hood".to_owned(), strain: 0.0832, logarithmic: false },
        Warning::LargeStrain { name: "hood".to_owned(), strain: -0.0768, logarithmic: false },
        Warning::LargeStrain { name: "hood".to_owned(), strain: 0.78, logarithmic: true },
        Warning::LargeRotation { label: "tip".to_owned(), turn: 0.21 },
        Warning::BeyondYield { name: "post".to_owned(), stress: 4.1e8, limit: 2.35e8 },
        Warning::BeyondElastic { name: "tie".to_owned(), stress: 6e10, strain: 0.286 },
        Warning::Bent { name: "blade".to_owned(), reduced: false, linear: true, turn: 0.24 },
        Warning::Bent { name: "rod".to_owned(), reduced: true, linear: false, turn: 0.4 },
        Warning::RotationDrifts { label: "ship".to_owned(), direction: "rz", drift: 0.031 },
        Warning::ContactThrows(throws),
        Warning::SlipBegins(on_contact),
        Warning::SlipBegins(in_joint),
        Warning::ScaledStep { wanted: 2e-6, longest: 1.4e-6, label: "p11".to_owned(), cause: "spring".to_owned() },
        Warning::ScaledStep { wanted: 2e-6, longest: 1.4e-6, label: "p11".to_owned(), cause: String::new() },
    ]
}

/// The number of a kind: a new one is a number here, and an entry above.
fn kind(warning: &Warning) -> usize {
    match warning {
        Warning::InitialVelocities { .. } => 0,
        Warning::StepError { .. } => 1,
        Warning::RunsPart { .. } => 2,
        Warning::Unbalanced { .. } => 3,
        Warning::DeepContact { .. } => 4,
        Warning::Unstable(_) => 5,
        Warning::UnstableOutOfPlane(_) => 6,
        Warning::Grows { .. } => 7,
        Warning::Modes(_) => 8,
        Warning::SideBySide { .. } => 9,
        Warning::Crowded { .. } => 10,
        Warning::BeginsClosed { .. } => 11,
        Warning::LargeStrain { .. } => 12,
        Warning::RotationDrifts { .. } => 13,
        Warning::ContactThrows(_) => 14,
        Warning::SlipBegins(_) => 15,
        Warning::ScaledStep { .. } => 16,
        Warning::LargeRotation { .. } => 17,
        Warning::BeyondYield { .. } => 18,
        Warning::Bent { .. } => 19,
        Warning::BeyondElastic { .. } => 20,
    }
}

#[test]
fn every_warning_says_what_it_means_and_what_to_change() {
    let warnings = warnings();
    for number in 0..=20 {
        assert!(warnings.iter().any(|warning| kind(warning) == number), "no example of kind {number}");
    }
    let texts: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    texts.iter().for_each(|text| assert_three_parts(text));
    assert_snapshot!("warnings", texts.join("\n\n"));
}

#[test]
fn every_remark_says_what_to_change() {
    let place = || ("knee".to_owned(), "uy");
    let remarks = [
        Remark::JudgedAsHeld { places: vec![place(), ("hip".to_owned(), "rx")] },
        Remark::NotHeld { place: place() },
        Remark::Jointed,
        Remark::Slipping,
    ];
    let texts: Vec<String> = remarks.iter().map(ToString::to_string).collect();
    texts.iter().for_each(|text| assert_three_parts(text));
    assert_snapshot!("remarks", texts.join("\n\n"));
}
