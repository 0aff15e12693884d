//! Rayleigh damping in words: parts that each factor acts on, and the reference of velocities.

use super::explanation::Explanation;
use base::names::{joined, short};
use model::{MassKind, Model, MovingFrame, Part};

/// The most parts that a line names one by one.
const NAMED: usize = 6;

/// Adds a line for α and one for β where they act.
pub fn explain(text: &mut Explanation, model: &Model) {
    if model.analysis.is_static() {
        return;
    }
    let modal = &model.damping.modal;
    if let (Some(first), true) = (modal.first(), model.analysis.is_dynamic()) {
        let ratio = match modal.iter().all(|ratio| ratio == first) {
            true => short(*first),
            false => "their ratios".to_owned(),
        };
        text.add("damping", format!("{ratio} of critical on {} modes of the drawn state", modal.len()));
    }
    let has_mass = !model.bodies.is_empty() || !model.masses.is_empty();
    let massive = |part: &Part| part.mass_kind().is_some_and(|kind| kind != MassKind::None);
    let alphas = factors(model, |part| massive(part).then(|| model.damping.alpha(&part.own_damping())));
    let rest = (model.damping.mass_factor > 0.0 && has_mass).then(|| "bodies and point masses".to_owned());
    if let Some(on) = listed(&alphas, model.damping.mass_factor, rest) {
        text.add("damping", format!("alpha on the mass of {on}, velocities relative to {}", reference(model)));
    }
    let betas = factors(model, |part| part.has_damped_stiffness().then(|| model.damping.beta(&part.own_damping())));
    if let Some(on) = listed(&betas, model.damping.stiffness_factor, None) {
        text.add("damping", format!("beta on the elastic stiffness of {on}"));
    }
}

/// The factor of each part of the deck, with its title.
fn factors(model: &Model, of: impl Fn(&Part) -> Option<f64>) -> Vec<(String, f64)> {
    let mut all: Vec<(String, f64)> = Vec::new();
    for part in &model.parts {
        let word = if part.is_listed() { part.kind().word() } else { "joint" };
        let title = format!("{word} `{}`", part.name());
        if let Some(factor) = of(part)
            && all.last().is_none_or(|(last, _)| *last != title)
        {
            all.push((title, factor));
        }
    }
    all
}

/// "all parts (0.3), beam `a` (0.1)"; `None` where no factor is above zero.
fn listed(factors: &[(String, f64)], of_all: f64, rest: Option<String>) -> Option<String> {
    let others = || factors.iter().filter(|(_, factor)| *factor > 0.0);
    let named = |(title, factor): &(String, f64)| format!("{title} ({})", short(*factor));
    let mut words: Vec<String> = others().map(named).collect();
    if words.len() > NAMED {
        let more = words.len() - NAMED;
        words.truncate(NAMED);
        words.push(format!("{more} more parts"));
    }
    words.extend(rest.map(|rest| format!("{rest} ({})", short(of_all))));
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    (!words.is_empty()).then(|| joined(&words))
}

/// The frames against whose velocities masses are damped.
fn reference(model: &Model) -> String {
    let label = |frame: &MovingFrame| {
        let node = frame.rotation.map(|(node, _)| node).or_else(|| frame.translation.into_iter().flatten().next())?;
        Some(format!("the support `{}`", model.nodes[node].label))
    };
    let mut frames: Vec<String> = model.damping.frames.list.iter().filter_map(label).collect();
    frames.sort_unstable();
    frames.dedup();
    match frames.len() {
        0 => "the ground".to_owned(),
        1..=NAMED => joined(&frames.iter().map(String::as_str).collect::<Vec<_>>()),
        more => format!("{more} supports that move"),
    }
}
