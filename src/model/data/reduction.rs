//! Parts that deform by a few shapes.

use super::loading::OwnDamping;
use super::part::Part;
use mechanics::elements::superelement::{InertiaIntegrals, SuperelementData};
use std::ops::Range;
use std::sync::Arc;

/// The most modes of a reduced part beyond the number in the deck. They have the frequency of the last.
pub const EQUAL_MODES: usize = 2;

/// Parts with a common superelement, which acts on the interface in place of their elements.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// The deck's name.
    pub name: String,
    /// The part in words, like "shell `roof`".
    pub title: String,
    /// Indices into [`super::Model::parts`], ascending.
    pub parts: Vec<usize>,
    /// The elements of a beam that is cut into pieces; `None` for all elements of the parts.
    pub elements: Option<Range<usize>>,
    /// The nodes by which the rest of the scene acts on the parts, ascending.
    pub interface: Vec<usize>,
    /// Nodes of the parts that bodies carry, ascending, with the places of the bodies' nodes in the interface.
    pub carried: Vec<(usize, usize)>,
    /// The other nodes of the parts, ascending.
    pub inner: Vec<usize>,
    /// A node for each amplitude; until the matrices are there, as many as there may be.
    pub amplitudes: Vec<usize>,
    /// The number of modes in the deck.
    pub modes: usize,
    /// The highest frequency that is kept; `None` without a bound.
    pub up_to: Option<f64>,
    /// True with terms of second order.
    pub geometric: bool,
    /// Rayleigh factors of the parts.
    pub damping: OwnDamping,
    /// Where the deck asks for it: first byte, and the one after the last.
    pub place: [usize; 2],
    /// The matrices; `None` until they have been computed.
    pub made: Option<Arc<ReducedPart>>,
}

impl Reduction {
    /// The nodes of the shapes: the interface, those that bodies carry, and the others.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        let carried = self.carried.iter().map(|(node, _)| *node);
        self.interface.iter().copied().chain(carried).chain(self.inner.iter().copied())
    }

    /// True where the part has no terms of second order.
    pub fn is_linear(&self) -> bool {
        self.made.as_ref().is_none_or(|made| made.matrices.second_order.is_none())
    }

    /// The parts; of a beam that is cut into pieces, a beam of this piece.
    pub fn own_parts(&self, all: &[Part]) -> Vec<Part> {
        let mut own: Vec<Part> = self.parts.iter().map(|&part| all[part].clone()).collect();
        if let Some(elements) = &self.elements {
            own.iter_mut().for_each(|part| part.keep_elements(elements));
        }
        own
    }
}

impl ReducedPart {
    /// The mass.
    pub fn mass(&self) -> f64 {
        self.integrals.as_ref().map_or(0.0, |integrals| integrals.mass())
    }
}

/// A reduced part by its matrices and shapes.
#[derive(Debug, Clone)]
pub struct ReducedPart {
    /// The superelement: interface and amplitudes.
    pub matrices: SuperelementData,
    /// The shapes: for each degree of freedom of the superelement six numbers of each inner node; column-major.
    pub shapes: Arc<[f64]>,
    /// The integrals over its mass; `None` without mass.
    pub integrals: Option<Arc<InertiaIntegrals>>,
    /// Frequencies of the modes with a fixed interface, ascending.
    pub frequencies: Vec<f64>,
    /// The number of static shapes of inertia loads, whose amplitudes follow those of the modes.
    pub inertia_shapes: usize,
    /// The frequency of the first mode that is left out; `None` where none is, or it is not known.
    pub next: Option<f64>,
    /// Unknowns of the inner nodes, which the amplitudes replace.
    pub replaced: usize,
}
