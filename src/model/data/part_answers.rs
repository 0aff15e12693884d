//! What every kind of part answers, each in the file of its kind. What a kind does not have is what is answered by default.

use super::integrals::MassIntegrals;
use super::loading::OwnDamping;
use super::node::Node;
use base::math::{Mat3, Vec3};
use base::quantities::Column;
use deck::part_table::MassKind;
use mechanics::sections::Stiffness;

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
    /// Of an element of two nodes that bends like the exact beam: 12 EI/(GA h²), the parts of shear in deflections along y and z.
    pub shear: Option<[f64; 2]>,
}

/// A place on an element: its nodes, each with its weight.
pub type NodeWeights = Vec<(usize, f64)>;

/// The questions to a part. [`super::Part`] hands each of them to its kind, and says what they mean.
pub trait PartAnswers {
    /// What `[[expect]]` may ask of such a part; plastic strain, where its material yields.
    const QUANTITIES: &'static [&'static [Column]];

    fn name(&self) -> &str;

    fn is_listed(&self) -> bool {
        true
    }

    fn elements(&self) -> usize;

    fn nodes(&self, element: usize) -> &[usize];

    fn visit_nodes(&mut self, visit: &mut impl FnMut(&mut usize));

    fn yields(&self) -> bool {
        false
    }

    fn may_stiffen(&self) -> bool {
        false
    }

    fn may_release(&self) -> bool {
        false
    }

    fn has_damped_stiffness(&self) -> bool {
        true
    }

    fn own_damping(&self) -> OwnDamping {
        OwnDamping::default()
    }

    fn mass_kind(&self) -> Option<MassKind> {
        None
    }

    fn element_mass(&self, _element: usize, _nodes: &[Node], _stiffnesses: &[Stiffness]) -> f64 {
        0.0
    }

    fn line(&self, _element: usize, _length: f64, _stiffnesses: &[Stiffness]) -> Option<LineElement> {
        None
    }

    fn linear_spring(&self) -> Option<LinearSpring> {
        None
    }

    fn stretching(&self, _element: usize, _nodes: &[Node], _stiffnesses: &[Stiffness]) -> Option<f64> {
        None
    }

    fn depths(&self, _stiffnesses: &[Stiffness]) -> Option<[f64; 2]> {
        None
    }

    fn drawing(&self, _element: usize) -> Option<Drawing<'_>> {
        None
    }

    fn normals(&self, _element: usize) -> &[Vec3] {
        &[]
    }

    fn places_between(&self, _count: usize) -> Vec<NodeWeights> {
        Vec::new()
    }

    fn take_out(
        &mut self,
        _stiffnesses: &[Stiffness],
        _x: &dyn Fn(usize) -> Vec3,
        _sums: &mut MassIntegrals,
    ) -> Vec<Vec<usize>> {
        Vec::new()
    }
}
