//! Shells in the equation of motion: their masses and blocks, and the resultants of their elements.

use super::assembled::{Assembled, NodeSpacing, NumberedBlock, Setting, pieces};
use super::masses::{LumpedElement, NodalMasses, NodalShare};
use crate::system::group::Group;
use crate::system::inertia::ConsistentMass;
use crate::system::plane::MotionPlane;
use crate::system::thread_partition::both;
use base::math::{Mat3, Vec3};
use mechanics::elements::shell::{
    self, CurvedQuadrilaterals, CurvedTriangles, NineNodes, Plate, Quadrilateral, Quadrilaterals, SixNodes, Triangle,
    Triangles,
};
use mechanics::elements::{ElementBlock, ShellResultants};
use mechanics::sections::Stiffness;
use mechanics::state::Configuration;
use model::{MassKind, Model, PartType, Shell};
use std::ops::Range;

/// The state of a shell element.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ShellState {
    /// The shell's index in [`Model::parts`].
    pub part: usize,
    /// The element's number in the deck's part.
    pub element: usize,
    /// Stress resultants, and the stresses of layers.
    pub at: ShellResultants,
}

impl ShellState {
    /// Von Mises stress in the lowest layer and in the highest.
    pub fn outer_von_mises(&self) -> [f64; 2] {
        let layers = self.at.layers();
        [layers.first(), layers.last()].map(|layer| layer.map_or(0.0, |layer| layer.von_mises()))
    }

    /// Von Mises stress, the largest over the layers.
    pub fn von_mises(&self) -> f64 {
        self.at.layers().iter().map(|layer| layer.von_mises()).fold(0.0, f64::max)
    }

    /// Accumulated plastic strain, the largest over the layers.
    pub fn plastic_strain(&self) -> f64 {
        self.at.layers().iter().map(|layer| layer.plastic_strain).fold(0.0, f64::max)
    }
}

impl Assembled for Shell {
    fn add_masses(&self, _: &[Stiffness], masses: &mut NodalMasses) {
        for (index, element) in self.elements.iter().enumerate() {
            let nodes = &element.nodes[..self.size()];
            masses.add(&lumped(self, index, masses));
            if self.mass == MassKind::Consistent {
                let corners: Vec<Vec3> = nodes.iter().map(|&n| masses.x[n]).collect();
                masses.consistent.push(ConsistentMass::of_shell(nodes, &corners, self.density * self.thickness(index)));
            }
        }
    }

    fn lumped(&self, element: usize, _: &[Stiffness], masses: &NodalMasses) -> Option<LumpedElement> {
        Some(lumped(self, element, masses))
    }

    /// Half the sum of the squares of its sides: of rectangles and of triangles with a right angle the sides themselves, of triangles with
    /// equal ones their heights. Elements of order 2 have a node on each side.
    fn spacing(&self, element: usize, masses: &NodalMasses) -> NodeSpacing {
        let (corners, parts) = match self.size() {
            size @ (3 | 4) => (size, 1.0),
            6 => (3, 2.0),
            _ => (4, 2.0),
        };
        let corner = |k: usize| masses.x[self.elements[element].nodes[k % corners]];
        let sides = (0..corners).map(|k| (corner(k + 1) - corner(k)) / parts);
        let squares: Mat3 = sides.map(|side| 0.5 * side * side.transpose()).sum();
        let across = squares.symmetric_eigen();
        // The least of the three belongs to the normal. Turns about the normal bulge the longer side.
        let normal = across.eigenvectors.column(across.eigenvalues.imin()).into_owned();
        let long = across.eigenvalues.max();
        let short = across.eigenvalues.sum() - long - across.eigenvalues.min();
        let about_normal = normal * normal.transpose();
        let bending = (long + short) * (Mat3::identity() - about_normal) - squares
            + normal.dot(&(squares * normal)) * about_normal;
        NodeSpacing { bending, drilling: long * about_normal }
    }

    fn blocks(&self, setting: &Setting) -> Vec<NumberedBlock> {
        let pieces = pieces(self.elements.len()).flat_map(|piece| alike(self, piece));
        pieces.map(|piece| (block(self, piece.clone(), setting), piece.start)).collect()
    }

    /// Shells bend out of any plane they lie in.
    fn stays_in(&self, _: &MotionPlane, _: &[Stiffness]) -> bool {
        self.elements.is_empty()
    }
}

fn lumped(part: &Shell, element: usize, masses: &NodalMasses) -> LumpedElement {
    let (h, nodes) = (part.thickness(element), &part.elements[element].nodes[..part.size()]);
    let corners: Vec<Vec3> = nodes.iter().map(|&n| masses.x[n]).collect();
    let areas = shell::lumped_shares(&corners);
    let share = |(&node, area): (&usize, f64)| {
        let mass = if masses.has_mass(part.mass, node) { part.density * h * area } else { 0.0 };
        // The inertia about the normal, which a director does not have, gets the same value, so every direction has inertia.
        let rotary =
            if masses.has_rotary_inertia(part.mass, node) { part.density * h.powi(3) / 12.0 * area } else { 0.0 };
        NodalShare { node, arm: Vec3::zeros(), mass, J0: rotary * Mat3::identity(), turns: masses.turns(node) }
    };
    LumpedElement(nodes.iter().zip(areas).map(share).collect())
}

/// Runs of elements that a block can hold: layers that yield have one thickness.
fn alike(part: &Shell, piece: Range<usize>) -> Vec<Range<usize>> {
    if part.yielding.is_none() || part.thicknesses.is_empty() {
        return vec![piece];
    }
    let changes = |&e: &usize| e == piece.start || part.thickness(e) != part.thickness(e - 1);
    let starts: Vec<usize> = piece.clone().filter(changes).collect();
    let ends = starts.iter().skip(1).copied().chain([piece.end]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

fn block(part: &Shell, piece: Range<usize>, &Setting { model, x, .. }: &Setting) -> Box<dyn ElementBlock> {
    let beta = model.damping.beta(&part.damping);
    let size = part.size();
    let heat = &part.heat.piece(piece.clone());
    let plate = &Plate { thickness: part.thickness(piece.start), ..part.plate };
    let elements = piece.map(|index| (&part.elements[index], index)).map(|(e, index)| shell::ShellGeometry {
        thickness: Some(part.thickness(index)),
        nodes: &e.nodes[..size],
        normals: &e.normals[..size],
        bulge: e.bulge,
    });
    match (&part.yielding, size) {
        (None, 6) => Box::new(CurvedTriangles::new(elements, x, plate, beta).heated(heat, x)),
        (None, 9) => Box::new(CurvedQuadrilaterals::new(elements, x, plate, beta).heated(heat, x)),
        (Some(yielding), 6) => yielding.curved_shells::<SixNodes, 6, 9, 9, 9>(elements, x, (plate, heat), beta),
        (Some(yielding), 9) => yielding.curved_shells::<NineNodes, 9, 20, 24, 12>(elements, x, (plate, heat), beta),
        (None, 3) => Box::new(Triangles::new(elements, x, plate, beta).heated(heat, x)),
        (None, _) => Box::new(Quadrilaterals::new(elements, x, plate, beta).heated(heat, x)),
        (Some(yielding), 3) => yielding.shells::<Triangle, 3, 2, 3, 7>(elements, x, (plate, heat), beta),
        (Some(yielding), _) => yielding.shells::<Quadrilateral, 4, 3, 6, 11>(elements, x, (plate, heat), beta),
    }
}

/// Writes the stress resultants of all elements of all shells into `out`, in deck order.
pub fn shell_states<'g>(
    groups: impl Iterator<Item = &'g Group> + Clone + Send + Sync,
    model: &'g Model,
    now: &Configuration,
    threads: bool,
    out: &mut Vec<ShellState>,
) {
    let of_shells = groups.filter_map(|group| Some((group, Shell::of(&model.parts[group.part])?)));
    let all = 0..of_shells.clone().count();
    out.resize(elements(&of_shells, &all), ShellState::default());
    write_states(&of_shells, all, (model, now), threads, out);
}

/// The number of elements of these groups of shells.
fn elements<'g>(of_shells: &(impl Iterator<Item = (&'g Group, &'g Shell)> + Clone), range: &Range<usize>) -> usize {
    of_shells.clone().skip(range.start).take(range.len()).map(|(group, _)| group.block.len()).sum()
}

/// Writes the stress resultants of these groups of shells, in halves.
fn write_states<'g>(
    of_shells: &(impl Iterator<Item = (&'g Group, &'g Shell)> + Clone + Sync),
    range: Range<usize>,
    (model, now): (&Model, &Configuration),
    threads: bool,
    out: &mut [ShellState],
) {
    if range.len() > 1 {
        let middle = range.start + range.len() / 2;
        let (left, right) = (range.start..middle, middle..range.end);
        let (first, second) = out.split_at_mut(elements(of_shells, &left));
        both(
            threads,
            || write_states(of_shells, left, (model, now), threads, first),
            || write_states(of_shells, right, (model, now), threads, second),
        );
        return;
    }
    let Some((group, shell)) = of_shells.clone().nth(range.start).filter(|_| !range.is_empty()) else { return };
    let now = group.configuration(now);
    group.block.resultants(&shell.axis, &|node| model.nodes[node].x, &now, &mut |e, mut at| {
        let element = group.first + e;
        if at.layers().is_empty() {
            at.set_elastic_layers(shell.thickness(element));
        }
        out[e] = ShellState { part: group.part, element: shell.number(element), at };
    });
}
