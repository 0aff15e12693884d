//! The frequencies of a response, with those around natural ones.

use crate::tolerances::frequencies::{FAR, NEAR};
use model::ResponseAsked;

/// The wanted frequencies, and those around these natural ones that lie in the range.
pub fn frequencies(asked: &ResponseAsked, natural: &[f64]) -> Vec<f64> {
    let mut all = asked.frequencies.clone();
    let Some(around) = asked.resonances else { return all };
    let [from, to] = around.range;
    for at in natural.iter().filter(|at| (from..=to).contains(*at) && **at > 0.0) {
        all.push(*at);
        let last = around.count.saturating_sub(1).max(1) as f64;
        for k in 0..around.count {
            let apart = NEAR * (FAR / NEAR).powf(k as f64 / last);
            all.extend([at * (1.0 - apart), at * (1.0 + apart)].into_iter().filter(|f| (from..=to).contains(f)));
        }
    }
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
