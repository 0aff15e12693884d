//! Mass scaling of explicit dynamics ([`super::element_stability`]): elements with a critical time step below the wanted one get additional
//! rotary inertia and mass, once, at t = 0. The additional mass has inertia but no weight, so equilibrium under weight is unchanged.

use super::element_stability::{ElementScaling, factor, fastest, scaling};
use super::group::Group;
use super::inertia::Inertia;
use super::parts::{LumpedElement, NodalMasses, NodeSpacing, assembled};
use crate::tolerances::element_stability::{BORDER, OF_USE};
use base::math::{Mat3, Vec3};
use mechanics::elements::Moduli;
use mechanics::integrators::stability_limit::{largest_stiffness, longest_step};
use mechanics::state::{Configuration, Node};
use model::{AnalysisKind, ElementMasses, MassKind, Model, Part, PartKind};

/// Number of elements whose tangents are formed at once.
const CHUNK: usize = 64;

/// The mass scaling of a model.
#[derive(Debug, Clone)]
pub struct MassScaling {
    /// The critical time step that every element has at least.
    pub critical_step: f64,
    /// The shortest critical time step of elements without added rotary inertia, where that alone is raised; `None` with
    /// `mass_scaling_step`.
    pub of_sections: Option<f64>,
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
    /// Largest factor on the rotary inertia of an element at a node.
    pub rotary_factor: f64,
}

/// The element with the shortest critical time step.
#[derive(Debug, Clone, PartialEq)]
pub struct GoverningElement {
    /// Its critical time step.
    pub step: f64,
    /// The part of the model, by its index.
    pub part: usize,
    /// Its number within the part.
    pub element: usize,
}

impl MassScaling {
    /// Adds mass to the inertias of nodes if the deck requires it; `None` otherwise.
    pub(super) fn new(model: &Model, x: &[Vec3], groups: &[Group], inertias: &mut [Inertia]) -> Option<MassScaling> {
        if model.analysis.kind != AnalysisKind::Dynamic {
            return None;
        }
        let elements = Elements::new(model, x);
        let (critical_step, of_sections) = match model.solution.masses {
            ElementMasses::OfSections => return None,
            ElementMasses::ForStep(step) => (step, None),
            ElementMasses::Rotary => {
                elements.raised(groups).map(|[own, raised]| ((1.0 - BORDER) * raised, Some(own)))?
            }
        };
        let mass = inertias.iter().map(|inertia| inertia.mass).sum();
        let none = vec![Vec::new(); model.parts.len()];
        let mut scaling = MassScaling { critical_step, of_sections, parts: Vec::new(), mass, elements: none };
        let mut place = vec![usize::MAX; x.len()];
        inertias.iter().enumerate().for_each(|(at, inertia)| place[inertia.node] = at);
        for group in groups.iter().filter(|group| elements.may_scale(group)) {
            let limit = elements.limit(group, critical_step);
            let mut given = Vec::with_capacity(group.block.len());
            elements.each(group, |_, K, element| {
                given.push(element.map_or(ElementScaling::KEPT, |of| self::scaling(K, of, limit)))
            });
            scaling.add_group(group, given, (model, &elements.masses), (inertias, &place));
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
                if share.J0.trace() > 0.0 {
                    told.rotary_factor = told.rotary_factor.max(J0.trace() / share.J0.trace());
                }
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
            rotary_factor: 1.0,
        }
    }

    /// Mass that is added over the mass of the part.
    pub fn share(&self) -> f64 {
        if self.added > 0.0 { self.added / self.mass } else { 0.0 }
    }
}

/// The element with the shortest critical time step, in the configuration at t = 0 and with Rayleigh damping; `None` without elements that
/// have lumped mass. Of elements with `mass_scaling_step`, which have one step at least, none is named.
pub fn governing(model: &Model, groups: &[Group], is_raised: bool) -> Option<GoverningElement> {
    if matches!(model.solution.masses, ElementMasses::ForStep(_)) {
        return None;
    }
    let x: Vec<Vec3> = model.nodes.iter().map(|node| node.x).collect();
    Elements::new(model, &x).governing(groups, is_raised.then_some(1.0))
}

/// The mass that a critical time step would add.
pub fn added_at(model: &Model, groups: &[Group], step: f64) -> f64 {
    let x: Vec<Vec3> = model.nodes.iter().map(|node| node.x).collect();
    let elements = Elements::new(model, &x);
    let mut added = 0.0;
    for group in groups.iter().filter(|group| elements.may_scale(group)) {
        let limit = elements.limit(group, step);
        elements.each(group, |_, K, element| {
            added += element.map_or(0.0, |of| {
                let mass: f64 = of.0.0.iter().map(|share| share.mass).sum();
                (factor(K, of, limit) - 1.0) * mass
            });
        });
    }
    added
}

/// The elements of a model at t = 0.
struct Elements<'m> {
    model: &'m Model,
    masses: NodalMasses<'m>,
    nodes: Vec<Node>,
}

impl<'m> Elements<'m> {
    fn new(model: &'m Model, x: &'m [Vec3]) -> Elements<'m> {
        Elements { model, masses: NodalMasses::new(model, x), nodes: x.iter().map(|&x| Node::at_rest(x)).collect() }
    }

    /// True for deformable elements with lumped masses.
    fn may_scale(&self, group: &Group) -> bool {
        let kind = self.model.parts[group.part].mass_kind();
        group.kind.is_deformable() && !matches!(kind, Some(MassKind::Consistent | MassKind::None))
    }

    /// The largest square of a frequency of an element that a step allows.
    fn limit(&self, group: &Group, step: f64) -> f64 {
        let [alpha, beta] = self.damping(group);
        largest_stiffness(step, alpha, beta)
    }

    fn damping(&self, group: &Group) -> [f64; 2] {
        let (damping, own) = (&self.model.damping, self.model.parts[group.part].own_damping());
        [damping.alpha(&own), damping.beta(&own)]
    }

    /// Hands out each element of a group: its number within the part, its elastic tangent, and its lumped mass with the squared distances
    /// of its nodes, if it has mass.
    fn each(&self, group: &Group, mut each: impl FnMut(usize, &[f64], Option<(&LumpedElement, &NodeSpacing)>)) {
        let block = &group.block;
        let history = vec![0.0; group.history.len()];
        let now = Configuration { history: &history, ..Configuration::of(&self.nodes) };
        let part = &self.model.parts[group.part];
        let (width, own) = (block.dofs() * block.nodes(0).len(), block.dofs() * part.nodes(0).len());
        let length = width.pow(2);
        let mut K = vec![0.0; CHUNK * length];
        let part = assembled(part);
        for first in (0..block.len()).step_by(CHUNK) {
            let K = &mut K[..length * CHUNK.min(block.len() - first)];
            block.tangents(first, &now, 0.0, Moduli::Elastic, K);
            for (K, e) in K.chunks_mut(length).zip(group.first + first..) {
                // Temperatures have no mass.
                (0..own).for_each(|row| K.copy_within(row * width..row * width + own, row * own));
                let K = &K[..own * own];
                let element = part.lumped(e, &self.model.stiffnesses, &self.masses);
                let spacing = part.spacing(e, &self.masses);
                each(e, K, element.as_ref().map(|element| (element, &spacing)));
            }
        }
    }

    /// The element with the shortest critical time step, with rotary inertia raised by this part of the most.
    fn governing(&self, groups: &[Group], part: Option<f64>) -> Option<GoverningElement> {
        let mut found: Option<GoverningElement> = None;
        for group in groups.iter().filter(|group| self.may_scale(group)) {
            let [alpha, beta] = self.damping(group);
            self.each(group, |element, K, of| {
                // Only elements faster than the fastest known one need their frequency.
                let limit = found.as_ref().map_or(0.0, |known| largest_stiffness(known.step, alpha, beta));
                if let Some(square) = of.and_then(|of| fastest(K, of, part, limit)).filter(|&square| square > 0.0) {
                    let step = longest_step(square, alpha + beta * square);
                    found = Some(GoverningElement { step, part: group.part, element });
                }
            });
        }
        found
    }

    /// The shortest critical time steps, first with the rotary inertia of the sections, then with raised inertia. `None` without a gain.
    fn raised(&self, groups: &[Group]) -> Option<[f64; 2]> {
        let own = self.governing(groups, None)?.step;
        let raised = self.governing(groups, Some(1.0))?.step;
        (raised > (1.0 + OF_USE) * own).then_some([own, raised])
    }
}
