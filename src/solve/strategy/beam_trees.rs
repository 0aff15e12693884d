//! The trees formed by the beams of a model and by parts rigidly attached to them.

use crate::context::{Context, at_rest};
use crate::system::Group;
use crate::tolerances::beam_trees::SLENDER;
use base::math::{Vec3, frame_along};
use mechanics::constraints::joint::Joint;
use mechanics::elements::Moduli;
use mechanics::state::{Configuration, Node};
use std::collections::VecDeque;
use std::ops::Range;

/// The most nodes of a beam element.
pub const MOST_NODES: usize = 5;

/// A beam element, or a rigid arm, of a tree.
#[derive(Debug, Clone, Copy)]
pub struct Branch {
    nodes: [usize; MOST_NODES],
    count: usize,
    /// Number, within the branch, of the node nearest to the root.
    pub parent: usize,
    /// The master where the branch is an arm.
    pub master: Option<usize>,
    /// Group and number of the element, if the branch is not an arm.
    element: [usize; 2],
}

impl Branch {
    fn new(nodes: &[usize], master: Option<usize>, element: [usize; 2]) -> Branch {
        let mut own = [0; MOST_NODES];
        own[..nodes.len()].copy_from_slice(nodes);
        Branch { nodes: own, count: nodes.len(), parent: 0, master, element }
    }

    /// Its nodes, of a beam from one end to the other.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.count]
    }
}

/// Trees of beams and rigid arms, each restrained at one node or at none.
pub struct BeamTrees {
    /// The trees that nothing holds, by their ranges of [`BeamTrees::nodes`].
    pub free: Vec<Range<usize>>,
    /// The largest EA L²/EI.
    pub slenderness: f64,
    /// The branches of all trees, those nearer to a root before those farther out.
    pub branches: Vec<Branch>,
    /// All nodes of trees.
    pub nodes: Vec<usize>,
}

/// EA L²/EI over the length of a tree: how much more easily it bends than it stretches; zero without beams.
fn slenderness(cx: &Context, branches: &[Branch], now: &Configuration) -> f64 {
    let (mut length, mut largest) = (0.0, 0.0f64);
    for branch in branches.iter().filter(|branch| branch.master.is_none()) {
        let of = branch.nodes();
        let line = now.nodes[of[of.len() - 1]].x - now.nodes[of[0]].x;
        length += line.norm();
        let [group, e] = branch.element;
        largest = largest.max(stretching_to_bending(&cx.system.groups[group], (e, of), now, &line));
    }
    largest * length * length
}

/// EA/EI of a beam at rest, the larger of both directions, from its matrix along `line` from end to end. `of`: its nodes.
fn stretching_to_bending(group: &Group, (e, of): (usize, &[usize]), now: &Configuration, line: &Vec3) -> f64 {
    let width = 6 * group.block.nodes(e).len();
    let along = line.normalize();
    let frame = frame_along(&along);
    let half = 0.5 * line.norm();
    let mut K = vec![0.0; width * width];
    group.block.tangent(e, &group.configuration(now), 0.0, Moduli::Elastic, &mut K);
    let energy = |motion: &dyn Fn(f64) -> [Vec3; 2]| {
        let place = |node: &Node| 2.0 * (node.x - now.nodes[of[0]].x).dot(line) / line.norm_squared() - 1.0;
        let x: Vec<f64> =
            of.iter().flat_map(|&node| motion(place(&now.nodes[node]))).flat_map(|v| [v.x, v.y, v.z]).collect();
        let rows = K.chunks(width).zip(&x);
        rows.map(|(row, x_i)| x_i * row.iter().zip(&x).map(|(k, x_j)| k * x_j).sum::<f64>()).sum::<f64>()
    };
    let stretching = energy(&|s| [half * s * along, Vec3::zeros()]);
    let bending = |axis: usize| {
        let turn: Vec3 = frame.column(axis).into_owned();
        energy(&|s| [half * half * 0.5 * s * s * turn.cross(&along), half * s * turn])
    };
    stretching / bending(0).min(bending(1))
}

/// The branches of a scene, and which meet at each node.
struct Graph {
    branches: Vec<Branch>,
    at: Vec<Vec<usize>>,
    /// Nodes with joints or with deformable parts other than beams, and partly attached nodes.
    foreign: Vec<bool>,
    dependent: Vec<bool>,
}

/// The nodes and branches that a search has reached.
struct Seen {
    nodes: Vec<bool>,
    branches: Vec<bool>,
}

impl Seen {
    fn new(graph: &Graph) -> Seen {
        Seen { nodes: vec![false; graph.at.len()], branches: vec![false; graph.branches.len()] }
    }
}

impl BeamTrees {
    /// The trees without joints and without deformable parts other than beams; `None` if there are none.
    pub fn find(cx: &Context) -> Option<BeamTrees> {
        let graph = Graph::new(cx);
        let mut trees = BeamTrees { free: Vec::new(), slenderness: 0.0, branches: Vec::new(), nodes: Vec::new() };
        let nodes = at_rest(cx.model);
        let history = vec![0.0; cx.system.history];
        let now = Configuration { nodes: &nodes, history: &history, dt: 0.0, previous: None };
        let (mut seen, mut from_root) = (Seen::new(&graph), Seen::new(&graph));
        for start in 0..graph.at.len() {
            if seen.nodes[start] || graph.at[start].is_empty() {
                continue;
            }
            let (nodes, _) = graph.grow(start, &mut seen);
            trees.add((cx, &now), &graph, &nodes, &mut from_root);
        }
        (!trees.nodes.is_empty()).then_some(trees)
    }

    /// Adds the tree of these connected nodes, if it is one. `seen`: those of trees before.
    fn add(&mut self, (cx, now): (&Context, &Configuration), graph: &Graph, nodes: &[usize], seen: &mut Seen) {
        let unknown = |node: usize, dof: usize| cx.plan.dofs.row(node, dof).is_some();
        let is_held = |node: &usize| !graph.dependent[*node] && (0..3).all(|dof| !unknown(*node, dof));
        let turns = |node: usize| (3..6).filter(|&dof| unknown(node, dof)).count() != 2;
        let moves = |node: usize| (0..3).all(|dof| cx.system.plane == Some(dof) || unknown(node, dof));
        let fits = |node: &usize| {
            !graph.foreign[*node] && (graph.dependent[*node] || turns(*node) && (is_held(node) || moves(*node)))
        };
        let mut held = nodes.iter().copied().filter(is_held);
        let first = held.next();
        let root = first.unwrap_or(nodes[0]);
        if held.next().is_some() || !nodes.iter().all(fits) {
            return;
        }
        let (nodes, Some(branches)) = graph.grow(root, seen) else { return };
        let slenderness = slenderness(cx, &branches, now);
        if slenderness >= SLENDER {
            self.slenderness = slenderness.max(self.slenderness);
            if first.is_none() {
                self.free.push(self.nodes.len()..self.nodes.len() + nodes.len());
            }
            self.branches.extend(branches);
            self.nodes.extend(nodes);
        }
    }
}

impl Graph {
    fn new(cx: &Context) -> Graph {
        let count = cx.model.nodes.len();
        let mut branches = Vec::new();
        let (mut foreign, mut dependent) = (vec![false; count], vec![false; count]);
        for (number, group) in cx.system.groups.iter().enumerate() {
            let block = &group.block;
            let is_beam = group.kind.has_sections();
            for e in 0..block.len() {
                let is_place = |node: &usize| !cx.model.nodes[*node].is_number;
                let own = block.nodes(e).iter().take_while(|node| is_place(node)).count();
                let nodes = &block.nodes(e)[..own];
                if is_beam {
                    branches.push(Branch::new(nodes, None, [number, e]));
                } else {
                    nodes.iter().for_each(|&node| foreign[node] = true);
                }
            }
        }
        cx.system.joints.iter().flat_map(Joint::ends).for_each(|node| foreign[node] = true);
        for link in &cx.system.rigid_links {
            branches.push(Branch::new(&[link.master, link.node], Some(link.master), [0; 2]));
            foreign[link.node] |= !link.rigid;
            dependent[link.node] = true;
        }
        let mut at = vec![Vec::new(); count];
        for (k, branch) in branches.iter().enumerate() {
            branch.nodes().iter().for_each(|&node| at[node].push(k));
        }
        Graph { branches, at, foreign, dependent }
    }

    /// All nodes connected to `start`, and the branches from there outwards; `None` in place of branches that close a loop.
    fn grow(&self, start: usize, seen: &mut Seen) -> (Vec<usize>, Option<Vec<Branch>>) {
        let (mut nodes, mut outwards, mut is_tree) = (vec![start], Vec::new(), true);
        let mut queue = VecDeque::from([start]);
        seen.nodes[start] = true;
        while let Some(node) = queue.pop_front() {
            for &k in &self.at[node] {
                if std::mem::replace(&mut seen.branches[k], true) {
                    continue;
                }
                let mut branch = self.branches[k];
                branch.parent = branch.nodes().iter().position(|&of| of == node).unwrap_or(0);
                for &next in branch.nodes().iter().filter(|&&next| next != node) {
                    is_tree &= !seen.nodes[next];
                    if !std::mem::replace(&mut seen.nodes[next], true) {
                        nodes.push(next);
                        queue.push_back(next);
                    }
                }
                outwards.push(branch);
            }
        }
        (nodes, is_tree.then_some(outwards))
    }
}
