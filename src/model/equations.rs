//! `[[equations]]` → joints whose coordinates follow common numbers: each term is a number, and sums of numbers are numbers.

use super::data::{DIRECTIONS, Joint, JointCoordinate, JointDrive};
use super::joints::coordinate::size;
use super::places::nodes::Topology;
use super::places::place::Place;
use super::report::{Owner, Report};
use super::scene::Scene;
use base::diagnostic::At;
use base::math::Vec3;
use base::math::turn::RotationAngles;
use deck::equations as words;
use deck::words::Table;
use mechanics::constraints::given_angle::GivenAngle;
use mechanics::constraints::joint::ConstraintEquation;

/// A term: the node, its degree of freedom, and the factor.
#[derive(Clone, Copy)]
struct Term {
    node: usize,
    dof: usize,
    factor: f64,
}

/// Reads `[[equations]]`; their joints are added to the others. Returns true where sums need numbers that no plane of motion knows.
pub(super) fn equations<'d>(
    scene: &Scene<'d>,
    (topology, joints): (&mut Topology, &mut Vec<Joint>),
    report: &mut Report<'d>,
) -> bool {
    let mut has_sums = false;
    for (index, equation) in scene.deck.equations.iter().enumerate() {
        let (name, owner) = report.named(("equation", "equations", index), equation.name.as_ref(), &equation.span);
        let Some(table) = report.require(&owner, "terms", &equation.terms) else { continue };
        let terms: Vec<Option<Term>> = table.iter().map(|term| read(scene, &owner, term, topology, report)).collect();
        if terms.len() < 2 {
            let hint = "a displacement that is zero by itself is a support";
            report.error_with::<()>(&table.span, format!("{} needs two terms or more", owner.what), hint);
            continue;
        }
        let Some(terms) = terms.into_iter().collect::<Option<Vec<Term>>>() else { continue };
        let twice = |(k, term): (usize, &Term)| {
            terms[..k].iter().any(|other| (other.node, other.dof) == (term.node, term.dof)).then_some(*term)
        };
        if let Some(term) = terms.iter().enumerate().find_map(twice) {
            let (label, dof) = (topology.label(term.node), DIRECTIONS[term.dof]);
            let message = format!("{} has two terms with {dof} of `{label}`", owner.what);
            report.error_with::<()>(&table.span, message, "add their factors, and give one term");
            continue;
        }
        has_sums |= terms.len() > 2;
        let reach = if terms.iter().any(|term| term.dof < 3) { 1.0 } else { size(scene, topology, &name) };
        Sum { name: &name, ground: ground(&name, &terms, topology), topology, joints }.add(scaled(terms, reach));
    }
    has_sums
}

fn read<'d>(
    scene: &Scene<'d>,
    owner: &Owner<'d>,
    term: &'d At<Table<words::Term>>,
    topology: &Topology,
    report: &mut Report<'d>,
) -> Option<Term> {
    let owner = &Owner::new(format!("a term of {}", owner.what), &term.span);
    let name = report.require(owner, "node", &term.node);
    let dof = report.require(owner, "dof", &term.dof);
    let factor = report.require(owner, "factor", &term.factor);
    let name = name?;
    let node = match scene.place_or_node(name) {
        Some(Place::Point(node)) => node,
        Some(Place::Body(body)) => scene.names.body_node(body),
        Some(place) => {
            let message = format!("{} takes points and bodies, and `{}` is {}", owner.what, name.value, place.kind());
            return report.error_with(&name.span, message, "name a point on it");
        }
        None => return scene.names.unknown("point or body", name, || scene.names.known(|_| true), report),
    };
    let (dof, factor) = (dof?, factor?);
    if factor.value == 0.0 {
        return report.error(&factor.span, "the factor of a term must not be 0");
    }
    let at = dof.value as usize;
    if !topology.is_taken(node, at) {
        let message = format!("nothing connected to `{}` has the degree of freedom {}", name.value, DIRECTIONS[at]);
        let hint = "name a degree of freedom of a connected part, or remove the term";
        return if topology.is_complete() { report.error_with(&dof.span, message, hint) } else { None };
    }
    Some(Term { node, dof: at, factor: factor.value })
}

/// The terms with the largest factor of a displacement 1, or that of a rotation the `reach` of the scene, so that multipliers compare with
/// forces.
fn scaled(mut terms: Vec<Term>, reach: f64) -> Vec<Term> {
    let moves = terms.iter().any(|term| term.dof < 3);
    let counts = terms.iter().filter(|term| !moves || term.dof < 3);
    let largest = counts.map(|term| term.factor.abs()).fold(0.0, f64::max);
    terms.iter_mut().for_each(|term| term.factor *= reach / largest);
    terms
}

/// A node at rest against which displacements are measured.
fn ground(name: &str, terms: &[Term], topology: &mut Topology) -> usize {
    let node = topology.add_number(format!("{name}.ground"), terms[0].node);
    (0..6).for_each(|dof| topology.restrain(node, dof, None));
    node
}

struct Sum<'a> {
    name: &'a str,
    ground: usize,
    topology: &'a mut Topology,
    joints: &'a mut Vec<Joint>,
}

impl Sum<'_> {
    /// Adds the joints of an equation: the first term is a number, each next one adds to it, and the last is what is left of zero.
    fn add(mut self, terms: Vec<Term>) {
        let Some((last, others)) = terms.split_last() else { return };
        let mut sum = None;
        for (k, term) in others.iter().enumerate() {
            let number = self.number(&format!("term {}", k + 1), term.node);
            self.follow(term, number, 1.0 / term.factor);
            sum = Some(sum.map_or(number, |sum| self.plus(k, sum, number)));
        }
        if let Some(sum) = sum {
            self.follow(last, sum, -1.0 / last.factor);
        }
    }

    fn number(&mut self, what: &str, near: usize) -> usize {
        self.topology.add_number(format!("{}, {what}", self.name), near)
    }

    /// Lets a displacement be a multiple of a number.
    fn follow(&mut self, term: &Term, number: usize, ratio: f64) {
        let at = self.topology.x(term.node) - self.topology.x(self.ground);
        let lock = match term.dof {
            axis @ 0..3 => ConstraintEquation::GlobalAxis { axis, at: at[axis] },
            dof => ConstraintEquation::Given(GivenAngle::new(dof - 3, RotationAngles::Vector)),
        };
        let axis = Vec3::ith(term.dof % 3, 1.0);
        let label = self.topology.label(term.node).to_owned();
        self.join(
            format!("{}, {} of {label}", self.name, DIRECTIONS[term.dof]),
            [term.node, self.ground],
            (lock, axis),
            (number, ratio),
        );
    }

    /// The number that is the sum of two.
    fn plus(&mut self, k: usize, sum: usize, more: usize) -> usize {
        let next = self.number(&format!("sum {}", k + 1), more);
        let at = (self.topology.x(next) - self.topology.x(sum)).x;
        let lock = ConstraintEquation::GlobalAxis { axis: 0, at };
        self.join(format!("{}, sum {}", self.name, k + 1), [next, sum], (lock, Vec3::x()), (more, 1.0));
        next
    }

    fn join(
        &mut self,
        name: String,
        ends: [usize; 2],
        (lock, axis): (ConstraintEquation, Vec3),
        (node, ratio): (usize, f64),
    ) {
        let mut joint = Joint::new(name, ends, Vec::new(), true);
        joint.coordinate = Some(JointCoordinate { lock, axis, drive: None, effort: None, spring: None });
        joint.set_drive(JointDrive { node, ratio, is_free: true });
        self.joints.push(joint);
    }
}
