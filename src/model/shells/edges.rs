//! The part of the bulge of each edge of a shell that the stress in its elements works on.

use crate::data::{Model, Part, PartType, Shell, ShellElement};
use crate::places::nodes::Topology;
use base::math::Vec3;
use mechanics::elements::shell::{FLAT, Interpolation, Quadrilateral, Triangle};
use std::collections::{HashMap, HashSet};

/// Part of the normal of an edge in its surface, squared, that is free at a node taken to be held across the edge: that of an edge
/// along the line of its support, up to the rounding of coordinates.
const FREE: f64 = 1e-6;

/// [`ShellElement::bulge`] of each element of a shell.
pub type Bulges = Vec<[f64; 4]>;

/// Sets [`ShellElement::bulge`]: nothing where both ends are held across the edge, by supports or by the same node, since what holds
/// an edge at its ends holds it between them too, and nothing where the surface is curved along it, since drilling by bending
/// alone would lock thin shells; otherwise the same part for all elements of the edge, so that a stress that passes through drives no
/// rotation. Never more than the `most` of a shell, where these are given: an edge that any stage of a run holds straight is straight in
/// all of them, or the stress in its elements would jump.
pub fn set_bulges(parts: &mut [Part], topology: &Topology, most: &[Bulges]) {
    let (mut curved, mut of_quadrilaterals) = (HashSet::new(), HashSet::new());
    let mixed = parts.iter().filter_map(Shell::of).any(|shell| shell.corners == 3);
    // Those of second order have curved sides of their own.
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

/// True for an edge along which the surface of an element is flat: it rises over its chord, or its ends turn against each other over its
/// length, by less than [`FLAT`] thicknesses.
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
    let held = |a: usize| is_held(topology, element.nodes[a], &element.normals[a].cross(&along));
    ends.into_iter().all(held) || carrier(topology, nodes[0]) == carrier(topology, nodes[1])
}

/// True for a node whose displacement along `direction` is given by supports.
fn is_held(topology: &Topology, node: usize, direction: &Vec3) -> bool {
    let free = (0..3).filter(|&dof| topology.restraint(node, dof).is_none()).map(|dof| direction[dof].powi(2));
    free.sum::<f64>() <= FREE * direction.norm_squared()
}

/// The node that a node follows in its displacements: itself where it follows none.
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
    /// Of a curved edge its nodes, one end, the other and that between, and the part of it from −1 to 1.
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
