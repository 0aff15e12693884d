//! Checks if joints form a tree with the ground: no constraint equation of a tree is redundant.

use mechanics::constraints::joint::Joint;
use mechanics::constraints::rigid_link::RigidLink;
use model::Model;
use std::collections::HashSet;

/// True where no way over joints, attachments and supports leads from a node back to it. Then every constraint equation is independent of all
/// others, wherever the scene goes. A tie is no way where nothing else holds its node: the equations then have unknowns of their own.
pub fn is_tree(model: &Model, joints: &[Joint], links: &[RigidLink]) -> bool {
    let ground = model.nodes.len();
    let mut sets = Sets((0..=ground).collect());
    let drives: HashSet<usize> = joints.iter().filter_map(|joint| Some(joint.drive.as_ref()?.node)).collect();
    let held: HashSet<usize> = model.constraints.restraints.iter().map(|restraint| restraint.node).collect();
    let mut ways = vec![0usize; ground];
    let of_links = links.iter().map(|link| link.node);
    joints.iter().flat_map(Joint::ends).chain(of_links).chain(held.iter().copied()).for_each(|node| ways[node] += 1);
    let is_way = |joint: &&Joint| joint.more.is_empty() || ways[joint.nodes[0]] > 1;
    // A restrained node belongs to the ground; one edge represents all its directions.
    held.into_iter().filter(|node| !drives.contains(node)).all(|node| sets.join(node, ground))
        && links.iter().all(|link| sets.join(link.node, link.master))
        && joints.iter().filter(is_way).all(|joint| joint.ends().skip(1).all(|end| sets.join(joint.nodes[0], end)))
}

/// Disjoint sets of nodes: each node names another one of its set, the last itself.
struct Sets(Vec<usize>);

impl Sets {
    fn last(&mut self, mut node: usize) -> usize {
        while self.0[node] != node {
            self.0[node] = self.0[self.0[node]];
            node = self.0[node];
        }
        node
    }

    /// Unites the sets of two nodes; false where they were one already.
    fn join(&mut self, a: usize, b: usize) -> bool {
        let [a, b] = [self.last(a), self.last(b)];
        self.0[a] = b;
        a != b
    }
}
