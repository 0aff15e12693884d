//! The default settings of `rdsolve study --recommend`: the default time steps, and automatic steps around the wanted error. If the deck
//! names no scheme, these include one of another family, which confirms the reference.

use base::words::rungs;
use model::Model;
use study::follows_tolerance;

/// Halvings of the longest default time step.
const HALVINGS: u64 = 6;

/// The overrides of `[study]` that complete it for an error.
pub fn defaults(model: &Model, wanted: f64) -> Vec<String> {
    let study = model.study.clone().unwrap_or_default();
    let mut sets = Vec::new();
    let is_dynamic = model.analysis.is_dynamic();
    if study.time_steps.is_empty() && study.halvings == 0 && study.error_tolerances.is_empty() {
        sets.push(format!("study.halvings={HALVINGS}"));
        let mut listed = study.schemes.iter().map(|choice| &choice.scheme);
        let follows = match study.schemes[..] {
            [] => follows_tolerance(&*model.solution.scheme),
            _ => listed.all(|scheme| follows_tolerance(&**scheme)),
        };
        // From three times the error wanted to a tenth of it: automatic steps err by less than asked for, or by more.
        let tolerances = rungs(wanted * 10f64.sqrt(), wanted / 10.0, 2);
        let tolerances: Vec<f64> = tolerances.into_iter().filter(|tolerance| *tolerance < 1.0).collect();
        if is_dynamic && follows && !tolerances.is_empty() {
            sets.push(format!("study.error_tolerances={tolerances:?}"));
        }
    }
    sets
}
