//! Warning for models without free degrees of freedom.

use crate::places::nodes::Topology;
use crate::report::Report;
use deck::Deck;

/// Warns where supports hold every degree of freedom at zero, as one on a set with more nodes than were meant does.
pub fn check_all_held(deck: &Deck, topology: &Topology, report: &mut Report) {
    let Some(support) = deck.supports.first() else { return };
    let mut held = 0;
    for (node, dof) in (0..topology.list.len()).flat_map(|node| (0..6).map(move |dof| (node, dof))) {
        if !topology.is_connected(node, dof) || topology.master_in(node, dof).is_some() {
            continue;
        }
        match topology.restraint(node, dof) {
            Some(restraint) if restraint.motion.is_none() => held += 1,
            _ => return,
        }
    }
    if held > 0 {
        let message = format!("the supports hold all {held} degrees of freedom at zero, so that nothing moves");
        let hint = "loads go into reactions alone; see that `at` names no more nodes than are meant to be held";
        report.warn(&support.span, message, hint);
    }
}
