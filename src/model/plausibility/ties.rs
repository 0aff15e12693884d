//! Which nodes something holds together without an element between them: joints, attachments, links, contacts, the ground.

use crate::data::Joint;
use crate::places::nodes::Topology;
use std::collections::HashSet;

/// Groups of nodes whose places depend on each other.
pub struct Ties {
    /// A node of the same group by node, and of the ground after the last node; the group's own node at the end of the chain.
    towards: Vec<usize>,
    /// Pairs of groups between which a link or a contact acts.
    linked: HashSet<[usize; 2]>,
}

impl Ties {
    /// The ties of a scene; links and contacts act between the pairs of nodes in `linked`.
    pub fn new(topology: &Topology, joints: &[Joint], linked: impl Iterator<Item = [usize; 2]>) -> Self {
        let count = topology.list.len();
        let mut ties = Ties { towards: (0..=count).collect(), linked: HashSet::new() };
        // Attachments with free directions join the two nodes too.
        for dependent in topology.dependents.iter().filter(|dependent| dependent.dofs[..3].contains(&true)) {
            ties.join(dependent.node, dependent.master);
        }
        joints.iter().for_each(|joint| joint.all_ends().for_each(|end| ties.join(joint.ends[0], end)));
        for node in 0..count {
            let rests = |dof| topology.restraint(node, dof).is_some_and(|restraint| restraint.motion.is_none());
            if (0..3).all(rests) {
                ties.join(node, count);
            }
        }
        for pair in linked {
            let groups = ties.groups(pair);
            // Links to the ground do not connect to other nodes on the ground.
            if groups[1] != ties.group(count) && groups[0] != ties.group(count) {
                ties.linked.insert(groups);
            }
        }
        ties
    }

    /// True where two nodes are held together.
    pub fn holds(&mut self, pair: [usize; 2]) -> bool {
        let groups = self.groups(pair);
        groups[0] == groups[1] || self.linked.contains(&groups)
    }

    fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [self.group(a), self.group(b)];
        self.towards[a.max(b)] = a.min(b);
    }

    /// The groups of two nodes in order.
    fn groups(&mut self, pair: [usize; 2]) -> [usize; 2] {
        let [a, b] = pair.map(|node| self.group(node));
        [a.min(b), a.max(b)]
    }

    fn group(&mut self, mut node: usize) -> usize {
        while self.towards[node] != node {
            self.towards[node] = self.towards[self.towards[node]];
            node = self.towards[node];
        }
        node
    }
}
