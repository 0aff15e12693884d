//! Which loops several threads share, in words. Each loop decides by the size of the scene alone. Below it threads cost more time than they
//! save, and results do not depend on the number of threads.

use super::explanation::Explanation;
use crate::plan::Plan;
use crate::system::System;

/// Adds a line about the threads of a step. The factorisation says its own part.
pub fn explain(text: &mut Explanation, plan: &Plan, system: &System) {
    let mut shared = Vec::new();
    if system.has_many_elements() {
        shared.push("elements");
    }
    if plan.explicit && plan.has_many_nodes() {
        shared.push("nodes");
    }
    let what = match shared[..] {
        [] => "one for elements and nodes: several would take longer in a scene of this size".to_owned(),
        _ => format!("all for {}", shared.join(" and ")),
    };
    text.add("threads", what);
}
