//! The line that confirms a reference: a scheme of another family, with the finest steps of the grid on its finest mesh. Its limit
//! is an answer of its own.

use super::family::Family;
use super::lines::StudyLine;
use base::diagnostic::Diagnostic;
use deck::Deck;
use mechanics::integrators::Scheme;
use model::Model;
use model::study::{Confirm, choose_scheme, scheme_of};
use std::sync::Arc;

/// The number of steps, the finest of the grid, that the line which confirms is run with: as many as show an order.
const STEPS: usize = 3;

/// The schemes that confirm, in the order in which they are thought of behind that of automatic steps.
const AUTOMATIC: [&str; 3] = ["esdirk3", "bathe", "newmark"];

/// The line that is to confirm the reference of a grid of these lines; `None` where lines of the grid do already.
///
/// # Errors
/// The scheme named is of the family of all lines.
pub fn line(
    model: &Model,
    deck: &Deck,
    confirm: &Confirm,
    lines: &[StudyLine],
) -> Result<Option<StudyLine>, Diagnostic> {
    let Some(best) = lines.iter().max_by(|a, b| a.rank().partial_cmp(&b.rank()).unwrap_or(std::cmp::Ordering::Equal))
    else {
        return Ok(None);
    };
    let is_new = |scheme: &dyn Scheme| lines.iter().all(|line| line.family != Family::of(scheme));
    let scheme: Arc<dyn Scheme> = match confirm {
        Confirm::By(scheme) if is_new(&**scheme) => scheme.clone(),
        Confirm::By(scheme) if lines.iter().all(|line| line.family == Family::of(&**scheme)) => {
            let message = format!("`{}` cannot confirm `{}`: it is of the same family", scheme.word(), lines[0].scheme);
            let hint = "\"auto\" takes one of another; \"bathe\", \"esdirk3\" and \"newmark\" are of three";
            return Err(Diagnostic::error(message).hint(hint));
        }
        // Its own lines, or those of its kin, stand in the grid beside others.
        Confirm::By(_) => return Ok(None),
        Confirm::Auto if lines.iter().any(|line| line.family != lines[0].family) => return Ok(None),
        Confirm::Auto => {
            let others = AUTOMATIC.into_iter().filter_map(scheme_of);
            let mut all = std::iter::once(choose_scheme(model)).chain(others);
            match all.find(|scheme| is_new(&**scheme)) {
                Some(scheme) => scheme,
                None => return Ok(None),
            }
        }
    };
    let own = deck.integrator.as_ref().and_then(|own| own.rotation_update.as_ref());
    let rotation = own.filter(|_| !scheme.is_explicit());
    let rotation = rotation.map_or(String::new(), |at| format!(", rotation_update = \"{}\"", at.value.word()));
    let mut line = best.clone();
    line.take(scheme.word(), &*scheme);
    line.sets.retain(|set| !set.starts_with("integrator="));
    line.sets.push(format!("integrator={{ scheme = \"{}\"{rotation} }}", scheme.word()));
    (line.label, line.confirms) = (format!("{}, to confirm", scheme.word()), true);
    Ok(Some(line))
}

/// The finest of these steps or tolerances.
pub fn finest(resolutions: &[f64]) -> &[f64] {
    &resolutions[resolutions.len().saturating_sub(STEPS)..]
}
