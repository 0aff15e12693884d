//! Pieces of a reduced part. Pieces that neither elements nor rigid links join turn apart, and one frame does not follow both.

use crate::data::Model;

/// A node of each of two pieces; `None` where the parts are in one.
pub(super) fn apart(model: &Model, parts: &[usize]) -> Option<[usize; 2]> {
    let mut above: Vec<usize> = (0..model.nodes.len()).collect();
    let elements =
        || parts.iter().map(|&part| &model.parts[part]).flat_map(|part| (0..part.elements()).map(|e| part.nodes(e)));
    elements().for_each(|nodes| nodes.iter().for_each(|&node| join(&mut above, nodes[0], node)));
    let rigid = model.constraints.dependents.iter().filter(|dependent| dependent.dofs == [true; 6]);
    rigid.for_each(|dependent| join(&mut above, dependent.master, dependent.node));
    let first = elements().next()?[0];
    let one = root(&mut above, first);
    let other = elements().map(|nodes| nodes[0]).find(|&node| root(&mut above, node) != one)?;
    Some([first, other])
}

/// Makes one piece of those of two nodes.
fn join(above: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(above, a), root(above, b));
    above[b] = a;
}

/// The node that stands for the piece of a node.
fn root(above: &mut [usize], mut node: usize) -> usize {
    while above[node] != node {
        above[node] = above[above[node]];
        node = above[node];
    }
    node
}
