//! Chains of bodies that hang one on the other: elimination couples each body of a chain with all before it, so long ones are held by
//! multipliers, which couple neighbours alone.

use crate::data::{DependentNode, Joint};
use crate::joints::equations;
use crate::places::nodes::Nodes;
use std::collections::HashSet;

/// Hinges one behind the other up to which elimination is kept. Its time grows with the third power of their number; at thirty both
/// take the same.
const MOST_HINGES: usize = 24;

/// Replaces attachments of long chains among the `open` nodes, whose method the deck leaves open, by joints that hold the same directions.
/// Attachments must not go round in a circle.
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

/// True for an attachment that leaves the node some rotation of its own.
fn is_hinge(link: &DependentNode) -> bool {
    link.dofs[3..].contains(&false)
}

/// On what each node hangs: the node that depends on no other, and the hinges between the two.
struct Hangs {
    root: Vec<usize>,
    hinges: Vec<usize>,
}

impl Hangs {
    fn of(nodes: &Nodes) -> Hangs {
        let count = nodes.list.len();
        let (mut root, mut hinges): (Vec<Option<usize>>, _) = (vec![None; count], vec![0; count]);
        for start in 0..count {
            // Up to a node whose root is known, or that has no master, then down again.
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
