//! The penalty factors of the constraint equations of joints: the force of a unit gap in the matrix, see [`super::joints`].

use super::dofs::DofMap;
use super::equations::System;
use super::multipliers::Multipliers;
use crate::tolerances::penalties::{FAINT, FIRM, MODERATE, NOTHING, UNFELT};
use base::math::{Mat6, Vec3, Vec6, angular, linear};
use linear::Solver;
use mechanics::constraints::joint::{ConstraintEquation, Joint, MOST_ENDS};
use mechanics::state::Node;

/// The data for the penalty factors of all joints.
pub(super) struct Diagonals {
    joints: Vec<Diagonal>,
    /// By node: the sum of [`Diagonal::moment`] over the joints that act on it, and the longest of their arms. Written where no inertia is in
    /// the matrix.
    on_nodes: Vec<[f64; 2]>,
    /// By node: the rounding of the rotational stiffness due to cancelling forces on dependent nodes. Zero where inertia is in the matrix.
    rounding: Vec<f64>,
    /// By constraint equation: its force, or zero if the force is rounding.
    forces: Vec<f64>,
    /// The size of the scene.
    extent: f64,
}

impl Diagonals {
    /// The slots of the diagonals of all joints.
    pub fn new(system: &System, independent_nodes: &[Vec<usize>], dofs: &DofMap, solver: &Solver) -> Self {
        let of = |joint| Diagonal::new(joint, independent_nodes, dofs, solver);
        Diagonals {
            joints: system.joints.iter().map(of).collect(),
            on_nodes: vec![[0.0; 2]; if system.joints.is_empty() { 0 } else { independent_nodes.len() }],
            rounding: vec![0.0; if system.joints.is_empty() { 0 } else { independent_nodes.len() }],
            forces: vec![0.0; system.multipliers()],
            extent: 0.0,
        }
    }

    /// Stores the forces of the equations for drives and for models `at_rest`, and sets rounding errors to zero. Rounding stems from gaps
    /// times the earlier penalty factor, and for moments also from the force of the same joint.
    fn take(&mut self, system: &System, nodes: &[Node], multipliers: &Multipliers, at_rest: bool) {
        if system.joints.is_empty() {
            return;
        }
        let farthest = |from: &Vec3| nodes.iter().map(|node| (node.x - from).amax()).fold(0.0, f64::max);
        // All equations ask for the size, forces or not.
        let extent = nodes.first().map_or(0.0, |node| farthest(&node.x));
        self.extent = extent;
        if !at_rest && !system.joints.iter().any(|joint| joint.drive.is_some()) {
            return;
        }
        let reach = farthest(&Vec3::zeros());
        for (joint, first) in system.numbered() {
            let rows = first..first + joint.equations.len();
            let all = || joint.equations.iter().zip(&multipliers.values[rows.clone()]);
            let translations = all().filter(|(row, _)| !row.is_rotational());
            let force = translations.map(|(_, lambda)| lambda.abs()).fold(0.0, f64::max);
            let to = self.forces[rows.clone()].iter_mut().zip(&multipliers.penalties[rows.clone()]);
            for ((row, lambda), (to, penalty)) in all().zip(to) {
                let rounding = match row.is_rotational() {
                    true => f64::max(NOTHING * penalty.max(reach * force), FAINT * extent * force),
                    false => NOTHING * penalty * reach,
                };
                *to = if lambda.abs() > rounding { *lambda } else { 0.0 };
            }
        }
    }

    /// Measures the rounding of the stiffness of masters due to forces on dependent nodes: under an even load on a rigid part their sum is
    /// zero. Beside inertia, where the scene is not `at_rest`, no entry counts as rounding.
    pub fn round(&mut self, system: &System, nodes: &[Node], on_dependents: &[Vec3], at_rest: bool) {
        self.rounding.fill(0.0);
        if system.joints.is_empty() || !at_rest {
            return;
        }
        for (dependent, f) in system.rigid_links.iter().zip(on_dependents) {
            let arm = dependent.arm(&nodes[dependent.master]);
            self.rounding[dependent.master] += NOTHING * f.norm() * arm.norm();
        }
    }

    /// Counts as rounding what vanishes beside the stiffest entry of the matrix. Forces that are rounding themselves turn rigid parts with a
    /// stiffness of their size; factors as small would make the next forces smaller still, and no iteration would end.
    fn leave_out_unfelt(&mut self, values: &[f64]) {
        if self.rounding.is_empty() {
            return;
        }
        let least = UNFELT * values.iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
        self.rounding.iter_mut().for_each(|rounding| *rounding = rounding.max(least));
    }

    /// Measures the stiffness that the forces of joints have.
    fn measure(&mut self, system: &System, nodes: &[Node], projections: &[Vec<Mat6>]) {
        self.on_nodes.fill([0.0; 2]);
        for ((joint, first), diagonal) in system.numbered().zip(&self.joints) {
            let [moment, arm] = diagonal.moment(joint, nodes, projections, (&self.forces[first..], self.extent));
            for place in &diagonal.0 {
                let [sum, longest] = &mut self.on_nodes[place.independent];
                *sum += moment;
                *longest = longest.max(arm);
            }
        }
    }

    /// The penalty factors for translations and rotations of the `j`-th joint if it alone supports weights. Then nothing at its ends
    /// resists translations, so rotational stiffness stems only from forces at arms; or all stiffness is below that of the joint forces. No
    /// other stiffness then indicates how large a restraint these forces require. `None` for other joints. `values`: the matrix.
    fn firm(&self, j: usize, values: &[f64]) -> Option<[f64; 2]> {
        let places = &self.joints[j].0;
        let on_nodes = places.iter().map(|place| self.on_nodes[place.independent]);
        let [moment, arm] = on_nodes.fold([0.0f64; 2], |most, of| [most[0].max(of[0]), most[1].max(of[1])]);
        let mut stiff = [0.0f64; 2];
        for (dof, size) in places.iter().flat_map(|place| place.sizes(values, &self.rounding).into_iter().enumerate()) {
            let stiff = &mut stiff[usize::from(dof > 2)];
            *stiff = size.map_or(*stiff, |size| stiff.max(size));
        }
        let [translations, rotations] = stiff;
        let moment = match translations == 0.0 {
            true => moment.max(rotations),
            false if rotations.max(translations * arm * arm) <= moment => moment,
            false => return None,
        };
        (moment > 0.0).then_some(firm_factors(moment, arm))
    }
}

/// The places of the diagonal of the matrix on which a joint acts.
struct Diagonal(Vec<Place>);

/// The place of an independent node that an end of a joint moves with.
struct Place {
    end: usize,
    /// The node of the end.
    node: usize,
    /// The index in [`super::dependents::independent_nodes`] of the independent node, and that node.
    index: usize,
    independent: usize,
    /// The slots of its six degrees of freedom on the diagonal.
    slots: [Option<u32>; 6],
}

impl Place {
    /// The sizes of the numbers on the diagonal, zero where they are rounding.
    fn sizes(&self, values: &[f64], rounding: &[f64]) -> [Option<f64>; 6] {
        std::array::from_fn(|dof| {
            let entry = values[self.slots[dof]? as usize];
            Some(if dof > 2 && entry.abs() <= rounding[self.independent] { 0.0 } else { outweighing(entry) })
        })
    }
}

impl Diagonal {
    /// The slots of a joint's diagonal.
    fn new(joint: &Joint, independent_nodes: &[Vec<usize>], dofs: &DofMap, solver: &Solver) -> Self {
        let slot = |node: usize, dof: usize| {
            let row = dofs.row(node, dof)?;
            solver.slot(row, row).map(|slot| slot as u32)
        };
        let of = |(end, node): (usize, usize)| {
            let places = independent_nodes[node].iter().enumerate();
            let place = move |(index, &independent): (usize, &usize)| Place {
                end,
                node,
                index,
                independent,
                slots: std::array::from_fn(|dof| slot(independent, dof)),
            };
            places.map(place).collect::<Vec<_>>()
        };
        Diagonal(joint.ends().enumerate().flat_map(of).collect())
    }

    /// The effective stiffness behind an equation: the inverse of Σ g²/K over its degrees of freedom, zero without stiffness. Then the
    /// largest K g² of translations, or of rotations for a rotational equation. With `even`, K is the mean over the translations or
    /// rotations of a node, which does not depend on axes. Arms are omitted if the equation has other terms, so joints of one body share
    /// loads equally at all places. Components of g that are rounding do not count: the stiffness behind them, over their square, has no limit.
    fn stiffness(
        &self,
        G: &[Vec6],
        (rotational, even): (bool, bool),
        projections: &[Vec<Mat6>],
        (values, diagonals): (&[f64], &Diagonals),
    ) -> [f64; 2] {
        let (mut compliance, mut of_kind, mut largest) = (0.0, 0.0, 0.0f64);
        let sizes_of_g = |g: Vec6| [linear(&g).amax(), angular(&g).amax()];
        let [ways, turns] = G.iter().map(|g| sizes_of_g(*g)).fold([0.0f64; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let felt = [NOTHING * ways, NOTHING * turns.max(ways * diagonals.extent)];
        for place in &self.0 {
            let &Place { end, node, index, .. } = place;
            let g = projections[node][index].tr_mul(&G[end]);
            let sizes = place.sizes(values, &diagonals.rounding);
            let mean = |dofs: &[Option<f64>]| {
                let known = || dofs.iter().flatten();
                known().sum::<f64>() / known().count().max(1) as f64
            };
            let means = if even { [mean(&sizes[..3]), mean(&sizes[3..])] } else { [0.0; 2] };
            for (dof, (g, own)) in g.iter().zip(sizes).enumerate() {
                let Some(own) = own.filter(|_| g.abs() > felt[usize::from(dof > 2)]) else { continue };
                let K = if even { means[usize::from(dof > 2)] } else { own };
                if K > 0.0 {
                    compliance += g * g / K;
                }
                if rotational == (dof > 2) {
                    of_kind += if K > 0.0 { g * g / K } else { 0.0 };
                    largest = largest.max(K * g * g);
                }
            }
        }
        if even && of_kind > 0.0 {
            compliance = of_kind;
        }
        [if compliance > 0.0 && compliance.is_finite() { 1.0 / compliance } else { 0.0 }, largest]
    }

    /// The magnitude of the rotational stiffness due to the forces of a joint: Σ |force| arm + Σ |moment| of its equations on independent
    /// nodes. And the longest of these arms.
    fn moment(
        &self,
        joint: &Joint,
        nodes: &[Node],
        projections: &[Vec<Mat6>],
        (values, extent): (&[f64], f64),
    ) -> [f64; 2] {
        let mut room = [Vec6::zeros(); MOST_ENDS];
        // The arm of a node at the place of its master is rounding.
        let felt = |arm: f64| if arm > NOTHING * extent { arm } else { 0.0 };
        let arm = |node: usize, k: usize| felt(projections[node][k].fixed_view::<3, 3>(0, 3).amax());
        let longest = self.0.iter().map(|place| arm(place.node, place.index)).fold(0.0, f64::max);
        let of = |((k, row), lambda): ((usize, &ConstraintEquation), &f64)| {
            let G = joint.gradient(k, nodes, &mut room);
            let on = |&Place { end, node, index, .. }: &Place| {
                arm(node, index) * linear(&G[end]).amax() + angular(&G[end]).amax()
            };
            let lever = self.0.iter().map(on).fold(0.0, f64::max);
            // The lever of a force that goes through a node is rounding.
            let is_one = row.is_rotational() || lever > FAINT * extent;
            if is_one { lambda.abs() * lever } else { 0.0 }
        };
        [joint.equations.iter().enumerate().zip(values).map(of).sum(), longest]
    }
}

/// Finds the penalty factors, which rest on the matrix before any joint has added to it.
///
/// A light part may couple an equation to a heavy part behind it. With the factor of the light part each iteration would multiply a gap by
/// ε times the mass ratio. With the factor of the heaviest part the light one would be lost in rounding. A geometric mean nearer to the
/// heaviest works for both up to ratios of 1e16; for moderate ratios the factor is not changed. An equation without stiffness has the
/// largest factor, and 1 if no equation has stiffness. `at_rest`: no inertia is in the matrix.
pub(super) fn set(
    system: &System,
    nodes: &[Node],
    (diagonals, projections): (&mut Diagonals, &[Vec<Mat6>]),
    multipliers: &mut Multipliers,
    values: &[f64],
    at_rest: bool,
) {
    diagonals.take(system, nodes, multipliers, at_rest);
    if at_rest {
        diagonals.leave_out_unfelt(values);
        diagonals.measure(system, nodes, projections);
    }
    let firm = |j: usize| if at_rest { diagonals.firm(j, values) } else { None };
    let (mut largest, mut firmest) = ([0.0f64; 2], [0.0f64; 2]);
    let mut room = [Vec6::zeros(); MOST_ENDS];
    let mut first = 0;
    for (j, (joint, diagonal)) in system.joints.iter().zip(&diagonals.joints).enumerate() {
        let firm = firm(j);
        let [translations, rotations] = firm.unwrap_or_default();
        firmest = [firmest[0].max(translations), firmest[1].max(rotations)];
        for (k, row) in joint.equations.iter().enumerate().filter(|_| firm.is_none()) {
            let how = (row.is_rotational(), multipliers.may_share());
            let [s, heaviest] =
                diagonal.stiffness(joint.gradient(k, nodes, &mut room), how, projections, (values, &*diagonals));
            let s = match joint.is_driven(k) {
                true => drive_penalty(
                    s,
                    row,
                    diagonal.moment(joint, nodes, projections, (&diagonals.forces[first..], diagonals.extent))[0],
                ),
                false => s,
            };
            multipliers.penalties[first + k] = s;
            let largest = &mut largest[usize::from(row.is_rotational())];
            *largest = largest.max(s).max(heaviest);
        }
        if multipliers.may_share() && firm.is_none() {
            make_even(joint, &mut multipliers.penalties[first..]);
        }
        first += joint.equations.len();
    }
    let mut first = 0;
    for (j, joint) in system.joints.iter().enumerate() {
        let firm = firm(j);
        for (s, row) in multipliers.penalties[first..].iter_mut().zip(&joint.equations) {
            let kind = usize::from(row.is_rotational());
            *s = beside(*s, firm.map(|firm| firm[kind]), largest[kind], firmest[kind]);
        }
        first += joint.equations.len();
    }
}

/// The penalty factor of an equation, from its effective stiffness `s` or from the factor `firm` of a joint that alone supports weights.
/// The largest values of both limit it.
fn beside(s: f64, firm: Option<f64>, heaviest: f64, firmest: f64) -> f64 {
    let s = match firm {
        Some(firm) if firm > NOTHING * heaviest => return firm,
        Some(_) => 0.0,
        None => s,
    };
    match heaviest > 0.0 {
        _ if s * MODERATE >= heaviest && s > 0.0 => s,
        _ if s > UNFELT * heaviest => heaviest * (s / heaviest).sqrt().sqrt(),
        true => heaviest,
        false if firmest > 0.0 => firmest,
        false => 1.0,
    }
}

/// The magnitude of a diagonal entry for the choice of a penalty factor: a factor equal to a negative entry would cancel it to zero.
fn outweighing(entry: f64) -> f64 {
    if entry < 0.0 { -INDEFINITE * entry } else { entry }
}

/// Gives the translations of a joint one penalty factor, and its rotations one, by their mean compliance. Redundant equations share loads
/// in proportion to the factors. With separate factors loads would depend on the axes of the equations.
fn make_even(joint: &Joint, penalties: &mut [f64]) {
    for rotational in [false, true] {
        let is_one = |k: &usize| joint.equations[*k].is_rotational() == rotational && !joint.is_driven(*k);
        let rows = || (0..joint.equations.len()).filter(is_one);
        let compliance = rows().map(|k| penalties[k].recip()).sum::<f64>() / rows().count().max(1) as f64;
        if compliance > 0.0 && compliance.is_finite() {
            rows().for_each(|k| penalties[k] = compliance.recip());
        }
    }
}

/// The penalty factors for translations and rotations of a joint whose forces have this stiffness, at arms of this length.
fn firm_factors(moment: f64, arm: f64) -> [f64; 2] {
    // Without an arm translations turn nothing over.
    [if arm > 0.0 { FIRM * moment / (arm * arm) } else { FIRM }, FIRM * moment]
}

/// The factor of penalties in shifted matrices (K − σ M), where a negative term equal to a penalty would cancel it to zero. No simple mass
/// ratio causes this with this factor.
pub(super) const INDEFINITE: f64 = 2.618_033_988_749_895;

/// The penalty factor of a drive from the factor of other equations. It remains effective if the driven part has zero or negative
/// stiffness, such as a weight that is turned upright. `moment` is of the size of the stiffness that the forces of the joint have.
fn drive_penalty(s: f64, row: &ConstraintEquation, moment: f64) -> f64 {
    INDEFINITE * if row.is_rotational() { s.max(moment) } else { s }
}
