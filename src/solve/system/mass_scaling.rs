//! Mass scaling of explicit dynamics ([`super::element_stability`]): elements with a critical time step below the wanted one get additional
//! rotary inertia and mass, once, at t = 0. The additional mass has inertia but no weight, so equilibrium under weight is unchanged.

use super::element_stability::{ElementScaling, scaling};
use super::group::Group;
use super::inertia::Inertia;
use super::parts::{NodalMasses, assembled};
use base::math::{Mat3, Vec3};
use mechanics::integrators::stability_limit::largest_stiffness;
use mechanics::state::{Configuration, Node};
use model::{AnalysisKind, Model, Part, PartKind};

/// Number of elements whose tangents are formed at once.
const CHUNK: usize = 64;

/// The mass scaling of a model.
#[derive(Debug, Clone)]
pub struct MassScaling {
    /// The critical time step that every element has at least.
    pub critical_step: f64,
    /// The parts of the deck that have mass, in its order.
    pub parts: Vec<ScaledPart>,
    /// Mass of the model without mass scaling.
    pub mass: f64,
    /// For each part of the model, the scaling of each element; empty for parts without scaling.
    elements: Vec<Vec<ElementScaling>>,
}

/// The mass scaling of a part.
#[derive(Debug, Clone)]
pub struct ScaledPart {
    /// Its name.
    pub name: String,
    kind: PartKind,
    /// Number of elements.
    pub elements: usize,
    /// Number of those that are given mass, ...
    pub heavier: usize,
    /// ... and of those that are given rotary inertia.
    pub rotary: usize,
    /// Mass without mass scaling.
    pub mass: f64,
    /// Mass that is added.
    pub added: f64,
    /// Largest factor on the mass of an element.
    pub factor: f64,
}

impl MassScaling {
    /// Adds mass to the inertias of nodes if the deck requires it; `None` otherwise.
    pub(super) fn new(model: &Model, x: &[Vec3], groups: &[Group], inertias: &mut [Inertia]) -> Option<MassScaling> {
        let critical_step = model.solution.scheme.mass_scaling_step()?;
        if model.analysis.kind != AnalysisKind::Dynamic {
            return None;
        }
        let mass = inertias.iter().map(|inertia| inertia.mass).sum();
        let elements = vec![Vec::new(); model.parts.len()];
        let mut scaling = MassScaling { critical_step, parts: Vec::new(), mass, elements };
        let masses = NodalMasses::new(model, x);
        let mut place = vec![usize::MAX; x.len()];
        inertias.iter().enumerate().for_each(|(at, inertia)| place[inertia.node] = at);
        let nodes: Vec<Node> = x.iter().map(|&x| Node::at_rest(x)).collect();
        for group in groups.iter().filter(|group| group.kind.is_deformable()) {
            let given = needed(group, (model, &masses), &nodes, critical_step);
            scaling.add_group(group, given, (model, &masses), (inertias, &place));
        }
        Some(scaling)
    }

    /// Adds the scaling of the elements of a group to the inertias of their nodes, and to the report.
    fn add_group(
        &mut self,
        group: &Group,
        given: Vec<ElementScaling>,
        (model, masses): (&Model, &NodalMasses),
        (inertias, place): (&mut [Inertia], &[usize]),
    ) {
        let told = self.part(&model.parts[group.part]);
        let alpha = model.damping.alpha(&model.parts[group.part].own_damping());
        for (e, scaling) in given.iter().enumerate() {
            let Some(element) = assembled(&model.parts[group.part]).lumped(group.first + e, &model.stiffnesses, masses)
            else {
                continue;
            };
            let own: f64 = element.0.iter().map(|share| share.mass).sum();
            told.elements += 1;
            told.mass += own;
            if *scaling == ElementScaling::KEPT {
                continue;
            }
            told.added += (scaling.factor - 1.0) * own;
            told.factor = told.factor.max(scaling.factor);
            told.heavier += usize::from(scaling.factor > 1.0);
            told.rotary += usize::from(scaling.gyration != Mat3::zeros());
            for share in element.0.iter().filter(|share| share.mass > 0.0) {
                let (mass, J0) = scaling.of(share);
                let inertia = &mut inertias[place[share.node]];
                if let Some(drag) = &mut inertia.drag {
                    drag.mass += alpha * (mass - share.mass);
                    drag.J0 += alpha * (J0 - share.J0);
                }
                inertia.mass += mass - share.mass;
                inertia.J0 += J0 - share.J0;
            }
        }
        self.elements[group.part].extend(given);
    }

    /// The report of the part of the deck with this name and kind.
    fn part(&mut self, part: &Part) -> &mut ScaledPart {
        let of = |told: &ScaledPart| told.kind == part.kind() && told.name == part.name();
        let at = self.parts.iter().position(of).unwrap_or_else(|| {
            self.parts.push(ScaledPart::new(part));
            self.parts.len() - 1
        });
        &mut self.parts[at]
    }

    /// The scaling of an element, by its part and its number there.
    pub(super) fn of(&self, part: usize, element: usize) -> ElementScaling {
        self.elements[part].get(element).copied().unwrap_or(ElementScaling::KEPT)
    }

    /// Mass that is added to the scene.
    pub fn added(&self) -> f64 {
        self.parts.iter().map(|part| part.added).sum()
    }
}

impl ScaledPart {
    fn new(part: &Part) -> ScaledPart {
        ScaledPart {
            name: part.name().to_owned(),
            kind: part.kind(),
            elements: 0,
            heavier: 0,
            rotary: 0,
            mass: 0.0,
            added: 0.0,
            factor: 1.0,
        }
    }

    /// Mass that is added over the mass of the part.
    pub fn share(&self) -> f64 {
        if self.added > 0.0 { self.added / self.mass } else { 0.0 }
    }
}

/// The scaling that the elements of a group need for a critical time step in the configuration at t = 0, with Rayleigh damping.
fn needed(group: &Group, (model, masses): (&Model, &NodalMasses), nodes: &[Node], step: f64) -> Vec<ElementScaling> {
    let block = &group.block;
    let own = model.parts[group.part].own_damping();
    let limit = largest_stiffness(step, model.damping.alpha(&own), model.damping.beta(&own));
    let history = vec![0.0; group.history.len()];
    let now = Configuration { history: &history, ..Configuration::of(nodes) };
    let length = (block.dofs() * block.nodes(0).len()).pow(2);
    let mut K = vec![0.0; CHUNK * length];
    let part = assembled(&model.parts[group.part]);
    let mut given = Vec::with_capacity(block.len());
    for first in (0..block.len()).step_by(CHUNK) {
        let K = &mut K[..length * CHUNK.min(block.len() - first)];
        block.tangents(first, &now, 0.0, mechanics::elements::Moduli::Elastic, K);
        given.extend(K.chunks(length).zip(first..).map(|(K, e)| {
            let element = part.lumped(group.first + e, &model.stiffnesses, masses);
            let spacing = part.spacing(group.first + e, masses);
            element.map_or(ElementScaling::KEPT, |element| scaling(K, (&element, &spacing), limit))
        }));
    }
    given
}
