//! The interface of all kinds of parts, implemented in the file of each kind. Defaults answer for kinds without a property.

use super::case::YieldLimit;
use super::integrals::MassIntegrals;
use super::loading::OwnDamping;
use super::node::Node;
use base::math::{Mat3, Vec3};
use deck::part_table::MassKind;
use mechanics::elements::heat::Heat;
use mechanics::sections::Stiffness;
use std::ops::Range;

/// How an element is drawn.
pub enum Drawing<'p> {
    /// A curve from the first node to the last.
    Curve {
        /// The nodes along the curve.
        nodes: &'p [usize],
        /// The axes of the section (columns, global at t = 0).
        axes: Mat3,
    },
    /// A face of three, four, six or nine nodes.
    Face {
        /// The nodes: corners around the face, then those on the sides, then the middle.
        nodes: &'p [usize],
    },
}

/// How a part acts on its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodalAction {
    /// Not at all.
    Nothing,
    /// By forces alone.
    Forces,
    /// By forces and moments.
    Moments,
}

/// A spring and a damper between two nodes whose force is linear.
pub struct LinearSpring {
    /// Its nodes.
    pub ends: [usize; 2],
    /// Force over elongation.
    pub stiffness: f64,
    /// Force over rate of elongation.
    pub damping: f64,
}

/// An element along a line, as a load per length sees it.
pub struct LineElement {
    /// Axes of its section (columns, global at t = 0); `None` where it has none.
    pub axes: Option<Mat3>,
    /// For a two-node element with exact bending: the shear numbers 12 EI/(GA h²) of deflections along y and z.
    pub shear: Option<[f64; 2]>,
}

/// A place on an element: its nodes, each with its weight.
pub type NodeWeights = Vec<(usize, f64)>;

/// The questions to a part, which [`super::Part`] hands to its kind.
pub trait PartAnswers {
    /// The deck's name of the part.
    fn name(&self) -> &str;

    /// True for a part with a separate table; false for a spring along a joint.
    fn is_listed(&self) -> bool {
        true
    }

    /// Lets material that yields stay elastic; returns where it would have yielded.
    fn make_elastic(&mut self) -> Option<YieldLimit> {
        None
    }

    /// The temperatures of the part; `None` where it does not expand.
    fn heat(&self) -> Option<&Heat> {
        None
    }

    /// [`PartAnswers::heat`], to be changed.
    fn heat_mut(&mut self) -> Option<&mut Heat> {
        None
    }

    /// Number of elements; a link is one, and so is each point and each box of a contact.
    fn elements(&self) -> usize;

    /// Nodes of an element of a deformable part, ends of a link, points of a contact without the node that carries the surface.
    fn nodes(&self, element: usize) -> &[usize];

    /// The ends or corners of an element of a deformable part.
    fn corners(&self, element: usize) -> Vec<usize> {
        let nodes = self.nodes(element);
        vec![nodes[0], nodes[nodes.len() - 1]]
    }

    /// Calls `visit` with every node of the part, for renumbering.
    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize));

    /// True where the material of the part yields.
    fn yields(&self) -> bool {
        false
    }

    /// True where the part may resist more than it does as it lies, all at once.
    fn may_stiffen(&self) -> bool {
        false
    }

    /// How it acts on its nodes.
    fn action(&self) -> NodalAction {
        NodalAction::Moments
    }

    /// True where flat elements at a node are so thin that they fold at their edges.
    fn folds_at(&self, _node: usize, _nodes: &[Node]) -> bool {
        false
    }

    /// The nodes that its surface lies on or is carried by, for a contact.
    fn touched_nodes(&self) -> Vec<usize> {
        Vec::new()
    }

    /// True where the part may store less energy than none, because it gives way under a preload or by its table.
    fn may_release(&self) -> bool {
        false
    }

    /// Keeps some of its elements, where they can be told apart: those of a beam.
    fn keep_elements(&mut self, _elements: &Range<usize>) {}

    /// True where the part may do work over a cycle, as matrices of bearings that are not symmetric do.
    fn may_feed(&self) -> bool {
        false
    }

    /// True for a part with an elastic stiffness on which Rayleigh's β acts.
    fn has_damped_stiffness(&self) -> bool {
        true
    }

    /// Rayleigh factors given for this part in the deck.
    fn own_damping(&self) -> OwnDamping {
        OwnDamping::default()
    }

    /// The distribution of the mass; `None` for a part without mass.
    fn mass_kind(&self) -> Option<MassKind> {
        None
    }

    /// The index of the section of an element, in [`super::Model::stiffnesses`]; `None` of parts without sections.
    fn section(&self, _element: usize) -> Option<usize> {
        None
    }

    /// The mass of an element at t = 0, whether or not the deck asks to keep it.
    fn element_mass(&self, _element: usize, _nodes: &[Node], _stiffnesses: &[Stiffness]) -> f64 {
        0.0
    }

    /// An element of this length for a spread load; `None` for elements without length.
    fn line(&self, _element: usize, _length: f64, _stiffnesses: &[Stiffness]) -> Option<LineElement> {
        None
    }

    /// The part as a linear spring along a line; `None` for other parts.
    fn linear_spring(&self) -> Option<LinearSpring> {
        None
    }

    /// The stretching stiffness of an element at t = 0: E A over its length, or E times the thickness of a shell; `None` for other parts.
    fn stretching(&self, _element: usize, _nodes: &[Node], _stiffnesses: &[Stiffness]) -> Option<f64> {
        None
    }

    /// The smaller and the larger depth of a cross-section. For a shell its thickness; for a beam the rectangle with the axial and bending
    /// stiffness of its first element. `None` for other parts.
    fn depths(&self, _stiffnesses: &[Stiffness]) -> Option<[f64; 2]> {
        None
    }

    /// The drawing of an element; `None` for a contact, drawn with its bodies.
    fn drawing(&self, _element: usize) -> Option<Drawing<'_>> {
        None
    }

    /// Unit normals at the nodes of an element of a surface, at t = 0; none for other parts.
    fn normals(&self, _element: usize) -> &[Vec3] {
        &[]
    }

    /// So many places between each two neighbouring nodes, and within faces, each once: there the part may be touched too.
    fn places_between(&self, _count: usize) -> Vec<NodeWeights> {
        Vec::new()
    }

    /// Moves the elements of the part into integrals over them, positions by `x`, because the part is rigid. Returns the nodes of each
    /// element for drawing.
    fn take_out(
        &mut self,
        _stiffnesses: &[Stiffness],
        _x: &dyn Fn(usize) -> Vec3,
        _sums: &mut MassIntegrals,
    ) -> Vec<Vec<usize>> {
        Vec::new()
    }
}
