//! Chains of bodies by attachments: elimination couples each body of a chain with all before it. Long chains use multipliers, which couple
//! only neighbours.

use crate::data::{DependentNode, Joint};
use crate::joints::equations;
use crate::places::nodes::Nodes;
use std::collections::HashSet;

/// Largest number of hinges in a chain for elimination. Its time grows with the third power of their number; at thirty both take the same.
const MOST_HINGES: usize = 24;

/// Replaces attachments of long chains by joints in the same directions, for the nodes in `open` (no method in the deck). Attachments must
/// not go round in a circle.
pub fn hold_long_chains(nodes: &mut Nodes, open: &HashSet<usize>, joints: &mut Vec<Joint>) {
    let hangs = Hangs::of(nodes);
    let long: HashSet<usize> =
        (0..hangs.root.len()).filter(|&node| hangs.hinges[node] > MOST_HINGES).map(|node| hangs.root[node]).collect();
    if long.is_empty() {
        return;
    }
    let is_held =
        |link: &DependentNode| is_hinge(link) && open.contains(&link.node) && long.contains(&hangs.root[link.node]);
    for (link, place) in nodes.detach(is_held) {
        let name = format!("{} on {}", nodes.label(link.node), nodes.label(link.master));
        let there = nodes.add_dependent(name.clone(), nodes.x(link.node), link.master, &place);
        nodes.connect(there, true);
        nodes.connect(link.node, link.dofs[3..].contains(&true));
        joints.push(Joint::new(name, [link.node, there], equations(link.dofs), false).of_attachment());
    }
}

/// True for an attachment with a free rotation.
fn is_hinge(link: &DependentNode) -> bool {
    link.dofs[3..].contains(&false)
}

/// For each node the independent root of its chain, and the number of hinges up to it.
struct Hangs {
    root: Vec<usize>,
    hinges: Vec<usize>,
}

impl Hangs {
    fn of(nodes: &Nodes) -> Hangs {
        let count = nodes.list.len();
        let (mut root, mut hinges): (Vec<Option<usize>>, _) = (vec![None; count], vec![0; count]);
        for start in 0..count {
            // Goes up to a node with a known root or without a master, then down again.
            let (mut way, mut node) = (Vec::new(), start);
            while let (None, Some(index)) = (root[node], nodes.attachment(node)) {
                way.push(index);
                node = nodes.dependents[index].master;
            }
            let found = *root[node].get_or_insert(node);
            for link in way.into_iter().rev().map(|index| &nodes.dependents[index]) {
                root[link.node] = Some(found);
                hinges[link.node] = hinges[link.master] + usize::from(is_hinge(link));
            }
        }
        Hangs { root: root.into_iter().enumerate().map(|(node, root)| root.unwrap_or(node)).collect(), hinges }
    }
}
