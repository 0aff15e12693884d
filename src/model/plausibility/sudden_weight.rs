//! Warning for gravity that acts at once as an earthquake begins.

use crate::report::Report;
use deck::Deck;
use deck::analysis::AnalysisKind;
use deck::stages::StageKind;

/// Warns of gravity that acts at once under an earthquake. The structure sags to twice its deflection at rest, and vibrates besides the motion by
/// the record. A free fall or a drop has no such deflection, and no moving ground.
pub fn check_sudden_weight(deck: &Deck, report: &mut Report) {
    let Some(environment) = &deck.environment else { return };
    let Some(gravity) = environment.gravity.as_ref().filter(|_| environment.gravity_amplitude.is_none()) else {
        return;
    };
    let is_at_once = match deck.stages.iter().find_map(|stage| stage.kind.as_ref()) {
        Some(first) => first.value == StageKind::Dynamic && environment.gravity_stages.is_none(),
        None => deck
            .analysis
            .iter()
            .filter_map(|analysis| analysis.kind.as_ref())
            .any(|at| at.value == AnalysisKind::Dynamic),
    };
    if environment.base_acceleration.is_empty()
        || !is_at_once
        || gravity.value.0.iter().all(|component| *component == 0.0)
    {
        return;
    }
    let message = "gravity acts at once as the ground begins to move: the structure sags to twice its deflection at rest, and vibrates";
    let hint = "let the weight grow in a stage before, `[[stages]]` of `kind = \"static\"`, or leave gravity out";
    report.warn(&gravity.span, message, hint);
}
