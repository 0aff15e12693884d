//! The part of the bulge of each edge of a shell that the stress in its elements works on.

use crate::data::{Model, Part, PartType, Shell, ShellElement};
use crate::places::nodes::Topology;
use base::math::Vec3;
use mechanics::elements::shell::{FLAT, Interpolation, Quadrilateral, Triangle};
use std::collections::{HashMap, HashSet};

/// Largest free part, squared, of the normal direction across an edge at a restrained node: rounding of coordinates for an edge along its
/// line of support.
const FREE: f64 = 1e-6;

/// [`ShellElement::bulge`] of each element of a shell.
pub type Bulges = Vec<[f64; 4]>;

/// Sets [`ShellElement::bulge`]. It is zero where supports or a common master restrain both ends across the edge, because they restrain the
/// edge between them too. It is zero where the surface is curved along the edge, because drilling by bending alone would lock thin shells.
/// Otherwise it is equal in all elements of the edge, so that a continuous stress drives no rotation. It never exceeds `most`, if given: an
/// edge straight in any stage is straight in all of them, otherwise stress would jump between stages.
pub fn set_bulges(parts: &mut [Part], topology: &Topology, most: &[Bulges]) {
    let (mut curved, mut of_quadrilaterals) = (HashSet::new(), HashSet::new());
    let mixed = parts.iter().filter_map(Shell::of).any(|shell| shell.corners == 3);
    // Elements of second order have curved sides already.
    for shell in parts.iter().filter_map(Shell::of).filter(|shell| shell.order == 1) {
        for element in &shell.elements {
            let edges = (0..shell.corners).map(|a| (a, element.edge(a, shell.corners)));
            if mixed && shell.corners == 4 {
                of_quadrilaterals.extend(edges.clone().map(|(_, edge)| edge));
            }
            let flat = |a: usize| is_flat(topology, element, [a, (a + 1) % shell.corners], shell.plate.thickness);
            curved.extend(edges.filter(|(a, _)| !flat(*a)).map(|(_, edge)| edge));
        }
    }
    for (index, shell) in parts.iter_mut().filter_map(Shell::of_mut).enumerate() {
        let corners = shell.corners;
        if shell.order == 2 {
            continue;
        }
        for (number, element) in shell.elements.iter_mut().enumerate() {
            let most = most.get(index).map_or(&[f64::INFINITY; 4], |shell| &shell[number]);
            for a in 0..corners {
                let edge = element.edge(a, corners);
                let straight = curved.contains(&edge) || is_straight(topology, element, [a, (a + 1) % corners]);
                element.bulge[a] = if straight {
                    0.0
                } else if corners == 4 || of_quadrilaterals.contains(&edge) {
                    Quadrilateral::BULGE
                } else {
                    Triangle::BULGE
                }
                .min(most[a]);
            }
        }
    }
}

/// The bulges of all shells of a model.
pub fn bulges(model: &Model) -> Vec<Bulges> {
    model.each::<Shell>().map(|shell| shell.elements.iter().map(|element| element.bulge).collect()).collect()
}

/// The least bulge of each edge of all shells in any of the models of a scene; `None` where they are the same in all.
pub fn least_bulges(models: &[Model]) -> Option<Vec<Bulges>> {
    let mut all = models.iter().map(bulges);
    let first = all.next()?;
    let mut least = first.clone();
    let mut differ = false;
    for other in all {
        differ |= other != first;
        let edges = least.iter_mut().zip(&other).flat_map(|(least, other)| least.iter_mut().zip(other));
        edges.for_each(|(least, other)| (0..4).for_each(|a| least[a] = least[a].min(other[a])));
    }
    differ.then_some(least)
}

/// True for an edge along a flat part of the surface: its rise over the chord, and the turn of its ends times its length, are below
/// [`FLAT`] thicknesses.
fn is_flat(topology: &Topology, element: &ShellElement, ends: [usize; 2], thickness: f64) -> bool {
    let along = topology.x(element.nodes[ends[1]]) - topology.x(element.nodes[ends[0]]);
    let [n, m] = ends.map(|a| element.normals[a]);
    let rise = n.dot(&along).abs().max(m.dot(&along).abs());
    ((n - m).norm() * along.norm()).max(2.0 * rise) <= FLAT * thickness
}

/// True for an edge whose ends are both held across it.
fn is_straight(topology: &Topology, element: &ShellElement, ends: [usize; 2]) -> bool {
    let nodes = ends.map(|a| element.nodes[a]);
    let along = topology.x(nodes[1]) - topology.x(nodes[0]);
    // A node beside the one that carries it is held where that one cannot turn either.
    let holder = |node: usize| match topology.carrier(node) {
        holder if holder != node && (3..6).all(|dof| topology.restraint(holder, dof).is_some()) => holder,
        _ => node,
    };
    let held = |a: usize| is_held(topology, holder(element.nodes[a]), &element.normals[a].cross(&along));
    ends.into_iter().all(held) || carrier(topology, nodes[0]) == carrier(topology, nodes[1])
}

/// True for a node whose displacement along `direction` is given by supports.
fn is_held(topology: &Topology, node: usize, direction: &Vec3) -> bool {
    let free = (0..3).filter(|&dof| topology.restraint(node, dof).is_none()).map(|dof| direction[dof].powi(2));
    free.sum::<f64>() <= FREE * direction.norm_squared()
}

/// The node with the same displacements at the end of the chain of masters; an independent node is its own carrier.
fn carrier(topology: &Topology, mut node: usize) -> usize {
    while let Some(master) = topology.master_in(node, 0)
        && (1..3).all(|dof| topology.master_in(node, dof) == Some(master))
    {
        node = master;
    }
    node
}

/// An edge of a shell.
pub struct Edge {
    /// Mean normal of its ends.
    pub normal: Vec3,
    /// See [`set_bulges`].
    pub bulge: f64,
    /// For a curved edge its nodes (one end, the other, the middle), and the range of its coordinate within −1 to 1.
    pub curve: Option<([usize; 3], [f64; 2])>,
}

/// The edges of all shells by their nodes, the lower first; of a fold the edge of the first shell. Curved edges are there as a whole, by
/// their ends, and by halves.
pub fn edges_of_shells(parts: &[Part]) -> HashMap<[usize; 2], Edge> {
    let mut edges = HashMap::new();
    for shell in parts.iter().filter_map(Shell::of) {
        let corners = shell.corners;
        for element in &shell.elements {
            for a in 0..corners {
                if shell.order == 2 {
                    let [first, last] = element.edge(a, corners);
                    let middle = element.nodes[corners + a];
                    let nodes = [first, last, middle];
                    for (ends, part) in
                        [([first, last], [-1.0, 1.0]), ([first, middle], [-1.0, 0.0]), ([last, middle], [0.0, 1.0])]
                    {
                        let edge = Edge { normal: element.normals[a], bulge: 0.0, curve: Some((nodes, part)) };
                        edges.entry([ends[0].min(ends[1]), ends[0].max(ends[1])]).or_insert(edge);
                    }
                    continue;
                }
                let normal = (element.normals[a] + element.normals[(a + 1) % corners]).normalize();
                edges.entry(element.edge(a, corners)).or_insert(Edge { normal, bulge: element.bulge[a], curve: None });
            }
        }
    }
    edges
}
