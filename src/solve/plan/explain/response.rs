//! A frequency response in words.

use base::names::{joined, short};
use model::{Load, ModeExtent, Model, ResponseAsked, ResponseMethod};

/// Excitation, frequencies and method of a frequency response.
pub fn explain(response: &ResponseAsked, model: &Model) -> String {
    let all = &response.frequencies;
    let range = match (all.as_slice(), all.len()) {
        ([only], _) => format!("at frequency {}", short(*only)),
        ([first, .., last], count) => format!("at {count} frequencies from {} to {}", short(*first), short(*last)),
        _ => String::new(),
    };
    let around = response.resonances.map_or(String::new(), |around| {
        let of = if model.loading.unbalanced_node().is_some() { "critical speed" } else { "natural frequency" };
        format!(", {} more on each side of every {of} there", around.count)
    });
    let how = match (response.method, response.extent) {
        (ResponseMethod::Direct, _) => "by a factorization at each frequency".to_owned(),
        (ResponseMethod::Modal, ModeExtent::Count(count)) => {
            format!("by the {count} lowest modes, all others as springs")
        }
        (ResponseMethod::Modal, ModeExtent::UpTo(frequency)) => {
            format!("by all modes up to {} per time, all others as springs", short(frequency))
        }
    };
    format!(
        "frequency response to {} {range}{around}, {how}, about the equilibrium under what else acts at t = 0",
        excitation(model)
    )
}

/// The harmonic excitation in words.
fn excitation(model: &Model) -> String {
    let loading = &model.loading;
    let harmonic = |i: Option<usize>| i.is_some_and(|i| loading.amplitudes[i].harmonic_phase().is_some());
    let (turning, fixed): (Vec<&Load>, _) =
        loading.nodal.iter().filter(|load| harmonic(load.amplitude)).partition(|load| load.is_unbalance());
    let pressures = loading.pressures.iter().filter(|load| harmonic(load.amplitude)).count();
    let ground = loading.base_accelerations.iter().filter(|base| harmonic(Some(base.amplitude))).count();
    let motions = model.constraints.restraints.iter().filter_map(|restraint| restraint.motion.as_ref());
    let motions = motions.filter(|motion| harmonic(Some(motion.amplitude))).count();
    let count = |count: usize, one: &str, many: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        _ => Some(format!("{count} {many}")),
    };
    let all = [
        count(turning.len() / 2, "unbalance", "unbalances"),
        count(fixed.len() + pressures, "load", "loads"),
        count(motions, "prescribed degree of freedom", "prescribed degrees of freedom"),
        count(ground, "acceleration of the ground", "accelerations of the ground"),
        harmonic(loading.gravity_amplitude).then(|| "gravity".to_owned()),
    ];
    let all: Vec<String> = all.into_iter().flatten().collect();
    joined(&all.iter().map(String::as_str).collect::<Vec<_>>())
}
