//! Reduced parts in the equation of motion: a superelement acts in place of the elements, whose nodes follow from it.

use super::group::{Group, GroupBlock};
use super::mass_sources;
use super::parts::{NumberedBlock, Setting, assembled};
use base::math::{Vec3, Vec6};
use mechanics::elements::Force;
use mechanics::elements::superelement::{FloatingElement, InnerNodes, ModalMass, NodalMass};
use mechanics::state::Node;
use model::{Model, Reduction};
use std::sync::Arc;

/// The nodes inside of a reduced part, with the superelement that they follow.
pub struct FollowingNodes {
    element: Arc<FloatingElement>,
    inner: InnerNodes,
    /// The deck's name of the part, or of the parts that are reduced together.
    pub name: String,
}

impl FollowingNodes {
    /// The inner nodes of a reduced part; `None` before its matrices have been computed.
    pub fn new(of: &Reduction, x: &[Vec3]) -> Option<FollowingNodes> {
        let made = of.made.as_ref()?;
        let element = FloatingElement::new(made.matrices.clone(), x, 0.0);
        let inner = InnerNodes::new(&element, &of.inner, x, made.shapes.clone());
        Some(FollowingNodes { element: Arc::new(element), inner, name: of.name.clone() })
    }

    /// True where the elastic forces of the part are linear in its frame.
    pub fn is_linear(&self) -> bool {
        self.element.is_linear()
    }

    /// The nodes.
    pub fn nodes(&self) -> &[usize] {
        self.inner.nodes()
    }

    /// Writes their motion from that of the superelement.
    pub fn recover(&self, nodes: &mut [Node]) {
        self.inner.recover(&self.element, nodes);
    }

    /// Writes their small motions from those of the superelement.
    pub fn carry(&self, nodes: &[Node], motions: &mut [Vec6]) {
        self.inner.carry(&self.element, nodes, motions);
    }

    /// Moves forces on them to the superelement.
    pub fn transfer(&self, nodes: &[Node], F: &mut [Force]) {
        self.inner.transfer(&self.element, nodes, F);
    }

    /// The largest rotation of one of them in the frame, in radians.
    pub fn rotation(&self, nodes: &[Node]) -> f64 {
        self.inner.rotation(&self.element, nodes)
    }
}

/// The superelement of a reduced part, with Rayleigh's β; `None` before its matrices have been computed.
pub fn element(model: &Model, of: &Reduction, x: &[Vec3], beta: f64) -> Option<FloatingElement> {
    debug_assert!(model.nodes.len() == x.len());
    Some(FloatingElement::new(of.made.as_ref()?.matrices.clone(), x, beta))
}

/// The masses of a reduced part, whose nodes have these places among those of its shapes.
pub fn masses(model: &Model, of: &Reduction, place: &[usize]) -> ModalMass {
    let x: Vec<Vec3> = model.nodes.iter().map(|node| node.x).collect();
    let parts = of.own_parts(&model.parts);
    let (lumped, consistent) = mass_sources::masses_of(model, &x, [].iter(), [].iter(), parts.iter());
    let mean = of.interface.iter().map(|&node| x[node]).sum::<Vec3>() / of.interface.len() as f64;
    let at_nodes = lumped.iter().map(|inertia| (place[inertia.node], place[inertia.node], inertia.mass));
    let pairs = consistent.iter().flat_map(|mass| mass.pairs().map(|(a, b, m)| (place[a], place[b], m)));
    ModalMass {
        Y: of.nodes().map(|node| x[node] - mean).collect(),
        masses: at_nodes.filter(|(.., mass)| *mass > 0.0).chain(pairs).collect(),
        rotary: lumped
            .iter()
            .filter(|inertia| inertia.rotary)
            .map(|inertia| NodalMass { node: place[inertia.node], J0: inertia.J0 })
            .collect(),
    }
}

/// The elements of reduced parts, which give results and exert no forces.
pub fn resting_groups(model: &Model, x: &[Vec3]) -> Vec<Group> {
    let setting = Setting { model, x, plane: None };
    let mut parts: Vec<usize> = model.reductions.iter().flat_map(|of| &of.parts).copied().collect();
    parts.sort_unstable();
    parts.dedup();
    let blocks = parts.into_iter().flat_map(|part| {
        let made = assembled(&model.parts[part]).blocks(&setting);
        made.into_iter().filter(|(block, _)| !block.is_empty()).map(move |made| (part, made))
    });
    let group = |(part, (block, first)): (usize, NumberedBlock)| Group {
        block: GroupBlock::Elements(block),
        kind: model.parts[part].kind(),
        part,
        first,
        history: 0..0,
        reduces: false,
    };
    blocks.map(group).collect()
}
