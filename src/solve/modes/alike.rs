//! Reduced parts that are alike: the same elements on the same nodes at another place. Their matrices are made once.

use super::linearized::Linearized;
use super::own_nodes::{OwnNodes, each_element};
use crate::system::reduced;
use crate::tolerances::reduction::ALIKE;
use mechanics::elements::superelement::{ModalMass, SuperelementData};
use model::{Model, ReducedPart, Reduction};
use std::ops::Range;
use std::sync::Arc;

/// What the matrices of a reduced part follow from.
pub struct Likeness {
    /// Nodes of the interface, bodies that carry nodes by their place there, modes asked for, the highest frequency, and whether there are terms of
    /// second order.
    asked: (usize, Vec<usize>, usize, Option<f64>, bool),
    masses: ModalMass,
    /// The nodes of each element, by their place in the part, and its stiffness.
    elements: Vec<(Vec<usize>, Vec<f64>)>,
}

/// Parts with matrices.
pub type Known = Vec<(Likeness, Arc<ReducedPart>)>;

impl Likeness {
    /// The likeness of a part.
    pub fn new(at: &Linearized, model: &Model, of: &Reduction, own: &OwnNodes) -> Likeness {
        let mut elements = Vec::new();
        each_element(at, &at.nodes_at_rest(), |of_element, _, K| {
            elements.push((of_element.iter().map(|&node| own.place[node]).collect(), K.to_vec()));
        });
        let carried = of.carried.iter().map(|(_, place)| *place).collect();
        let asked = (of.interface.len(), carried, of.modes, of.up_to, of.geometric);
        Likeness { asked, masses: reduced::masses(model, of, &own.place), elements }
    }

    /// True where the matrices of the other part are those of this one.
    fn is_alike(&self, other: &Likeness) -> bool {
        let (own, others) = (&self.masses, &other.masses);
        let places = |of: &ModalMass| of.Y.iter().flat_map(|Y| [Y.x, Y.y, Y.z]).collect::<Vec<f64>>();
        let masses = |of: &ModalMass| of.masses.iter().map(|(.., mass)| *mass).collect::<Vec<f64>>();
        let pairs = |of: &ModalMass| of.masses.iter().map(|(a, b, _)| (*a, *b)).collect::<Vec<_>>();
        let turning = |of: &ModalMass| of.rotary.iter().map(|of| of.node).collect::<Vec<_>>();
        self.asked == other.asked
            && pairs(own) == pairs(others)
            && turning(own) == turning(others)
            && is_near(&places(own), &places(others))
            && masses(own).iter().zip(&masses(others)).all(|(a, b)| is_near(&[*a], &[*b]))
            && own.rotary.iter().zip(&others.rotary).all(|(a, b)| is_near(a.J0.as_slice(), b.J0.as_slice()))
            && self.elements.len() == other.elements.len()
            && self.elements.iter().zip(&other.elements).all(|(a, b)| a.0 == b.0 && is_same_matrix(&a.1, &b.1))
    }

    /// The matrices of a known part that is alike, on the nodes of another.
    pub fn find(&self, known: &Known, of: &Reduction) -> Option<ReducedPart> {
        let (_, made) = known.iter().find(|(other, _)| self.is_alike(other))?;
        let amplitudes = &of.amplitudes[..made.matrices.amplitudes()];
        let nodes = of.interface.iter().chain(amplitudes).copied().collect();
        Some(ReducedPart { matrices: SuperelementData { nodes, ..made.matrices.clone() }, ..(**made).clone() })
    }
}

/// True where the part may be like another, whose matrices are then worth keeping.
pub fn may_be_like_another(model: &Model, of: &Reduction) -> bool {
    let size = |of: &Reduction| {
        let elements = of.parts.iter().map(|&part| model.parts[part].elements());
        (of.interface.len(), of.inner.len(), of.elements.as_ref().map_or(elements.sum::<usize>(), Range::len))
    };
    model.reductions.iter().filter(|other| size(other) == size(of)).count() > 1
}

/// True where matrices of stiffness agree but for rounding, each entry beside the diagonal of its row and its column: entries of stretching do
/// not hide those of bending.
fn is_same_matrix(a: &[f64], b: &[f64]) -> bool {
    let size = a.len().isqrt();
    let diagonal: Vec<f64> = (0..size).map(|i| a[i * size + i].abs().sqrt()).collect();
    let bound = |k: usize| ALIKE * diagonal[k / size] * diagonal[k % size];
    a.len() == b.len() && (0..a.len()).all(|k| (a[k] - b[k]).abs() <= bound(k))
}

/// True where numbers agree but for rounding, beside the largest of them.
fn is_near(a: &[f64], b: &[f64]) -> bool {
    let largest = a.iter().fold(0.0, |most: f64, a| most.max(a.abs()));
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE * largest)
}
