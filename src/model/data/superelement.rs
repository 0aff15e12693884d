//! Superelements: parts by their matrices.

use super::loading::OwnDamping;
use super::node::Node;
use super::part_answers::{Drawing, PartAnswers};
use base::math::Mat3;
use base::quantities::Column;
use deck::part_table::MassKind;
use mechanics::elements::superelement::SuperelementData;
use mechanics::sections::Stiffness;

/// A part by matrices of stiffness, mass and damping.
#[derive(Debug, Clone)]
pub struct Superelement {
    /// The deck's name.
    pub name: String,
    /// Nodes and matrices.
    pub matrices: SuperelementData,
    /// The mass of the whole.
    pub mass: f64,
    /// Rayleigh factors of this part.
    pub damping: OwnDamping,
}

impl Superelement {
    /// The quantities for `[[expect]]`.
    pub(super) const QUANTITIES: &'static [&'static [Column]] = &[];
}

impl PartAnswers for Superelement {
    fn name(&self) -> &str {
        &self.name
    }

    fn elements(&self) -> usize {
        1
    }

    fn nodes(&self, _: usize) -> &[usize] {
        &self.matrices.nodes[..self.matrices.interface]
    }

    fn visit_nodes(&mut self, visit: &mut dyn FnMut(&mut usize)) {
        self.matrices.nodes.iter_mut().for_each(visit);
    }

    fn own_damping(&self) -> OwnDamping {
        self.damping
    }

    fn mass_kind(&self) -> Option<MassKind> {
        Some(if self.mass > 0.0 { MassKind::Consistent } else { MassKind::None })
    }

    fn element_mass(&self, _: usize, _: &[Node], _: &[Stiffness]) -> f64 {
        self.mass
    }

    /// A line from its first point to its last, through the others.
    fn drawing(&self, element: usize) -> Option<Drawing<'_>> {
        let nodes = self.nodes(element);
        (nodes.len() > 1).then(|| Drawing::Curve { nodes, axes: Mat3::identity() })
    }
}
