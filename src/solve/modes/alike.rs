//! Reduced parts that are alike: the same elements on the same nodes at another place. Their matrices are made once.

use super::linearized::Linearized;
use super::reduction::{OwnNodes, each_element};
use crate::system::reduced;
use crate::tolerances::reduction::ALIKE;
use mechanics::elements::superelement::{ModalMass, SuperelementData};
use model::{Model, ReducedPart, Reduction};
use std::sync::Arc;

/// What the matrices of a reduced part follow from.
pub struct Likeness {
    /// Nodes of the interface, modes asked for, and the highest frequency.
    asked: (usize, usize, Option<f64>),
    masses: ModalMass,
    /// The nodes of each element, by their place in the part.
    nodes: Vec<Vec<usize>>,
    /// The stiffnesses of the elements.
    stiffness: Vec<f64>,
}

/// Parts with matrices.
pub type Known = Vec<(Likeness, Arc<ReducedPart>)>;

impl Likeness {
    /// The likeness of a part.
    pub fn new(at: &Linearized, model: &Model, of: &Reduction, own: &OwnNodes) -> Likeness {
        let (mut nodes, mut stiffness) = (Vec::new(), Vec::new());
        each_element(at, &at.nodes_at_rest(), |of_element, _, K| {
            nodes.push(of_element.iter().map(|&node| own.place[node]).collect());
            stiffness.extend_from_slice(K);
        });
        let asked = (of.interface.len(), of.amplitudes.len(), of.up_to);
        Likeness { asked, masses: reduced::masses(model, of, &own.place), nodes, stiffness }
    }

    /// True where the matrices of the other part are those of this one.
    fn is_alike(&self, other: &Likeness) -> bool {
        let (own, others) = (&self.masses, &other.masses);
        let places = |of: &ModalMass| of.Y.iter().flat_map(|Y| [Y.x, Y.y, Y.z]).collect::<Vec<f64>>();
        let masses = |of: &ModalMass| of.masses.iter().map(|(.., mass)| *mass).collect::<Vec<f64>>();
        let pairs = |of: &ModalMass| of.masses.iter().map(|(a, b, _)| (*a, *b)).collect::<Vec<_>>();
        let rotary = |of: &ModalMass| of.rotary.iter().flat_map(|of| of.J0.iter().copied()).collect::<Vec<f64>>();
        let turning = |of: &ModalMass| of.rotary.iter().map(|of| of.node).collect::<Vec<_>>();
        self.asked == other.asked
            && self.nodes == other.nodes
            && pairs(own) == pairs(others)
            && turning(own) == turning(others)
            && is_near(&places(own), &places(others))
            && is_near(&masses(own), &masses(others))
            && is_near(&rotary(own), &rotary(others))
            && is_near(&self.stiffness, &other.stiffness)
    }

    /// The matrices of a known part that is alike, on the nodes of another.
    pub fn find(&self, known: &Known, of: &Reduction) -> Option<ReducedPart> {
        let (_, made) = known.iter().find(|(other, _)| self.is_alike(other))?;
        let amplitudes = &of.amplitudes[..made.frequencies.len()];
        let nodes = of.interface.iter().chain(amplitudes).copied().collect();
        Some(ReducedPart { matrices: SuperelementData { nodes, ..made.matrices.clone() }, ..(**made).clone() })
    }
}

/// True where numbers agree but for rounding.
fn is_near(a: &[f64], b: &[f64]) -> bool {
    let largest = a.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE * largest)
}
