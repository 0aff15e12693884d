//! Reduced parts: their stiffness and mass over the motions of the interface and modes with a fixed interface.
//!
//! The static shapes Ψ are the motions of inner nodes, without inertia, by unit motions of the interface; the modes φ have a fixed interface.
//! Static responses to rigid inertia loads join them (`inertia_shapes`). With Φ = [Ψ φ] the matrices are Φᵀ K Φ and Φᵀ M Φ. They keep the
//! rigid motions, the static stiffness and the mass of the part. K and M are those of the part at t = 0, without loads.
//! Source: R. R. Craig, M. C. C. Bampton, AIAA J. 6 (1968) 1313-1319.

use super::alike::{Known, Likeness, may_be_like_another};
use super::fault::ModesFault;
use super::inertia_shapes::inertia_shapes;
use super::linearized::Linearized;
use super::modal::natural_pairs;
use super::own_nodes::{OwnNodes, each_element};
use super::pencil::Pencil;
use super::second_order::second_order;
use crate::plan::Plan;
use crate::system::{Loading, System, reduced};
use crate::tolerances::reduction::{CARRIED, FEW, MOST, PAIR};
use crate::tolerances::second_order::LARGEST;
use base::diagnostic::Diagnostic;
use base::math::{Vec3, Vec6, stack};
use mechanics::elements::superelement::{
    FloatingElement, InertiaIntegrals, ModalMass, SecondOrder, SuperelementData, dot, products,
};
use mechanics::state::{Node, State};
use model::{
    AnalysisKind, Constraints, Damping, EQUAL_MODES, LoadCases, Loading as ModelLoading, ModeExtent, Model, ModesAsked,
    ReducedPart, Reduction, Restraint, StepLength, SuperelementMatrices, settle,
};
use nalgebra::DMatrix;
use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Computes the matrices of the reduced parts of all stages, which share them.
///
/// # Errors
/// The parts without matrices, in the words of the deck.
pub fn reduce(models: &mut [&mut Model]) -> Result<(), Vec<Diagnostic>> {
    let (mut problems, mut known) = (Vec::new(), Known::new());
    let count = models.first().map_or(0, |model| model.reductions.len());
    for index in 0..count {
        let model = &*models[0];
        let of = &model.reductions[index];
        match of.made.clone().map_or_else(|| reduced(model, of, &mut known), Ok) {
            Ok(made) => {
                problems.extend(models.iter().filter_map(|model| other_velocities(model, index, &made)));
                models.iter_mut().for_each(|model| keep(model, index, &made));
            }
            Err(why) => problems.push(
                Diagnostic::error(format!("{} cannot be reduced: {why}", of.title)).at(&(of.place[0]..of.place[1])),
            ),
        }
    }
    problems.retain(Diagnostic::is_error);
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// Gives a model the matrices of a reduced part. Nodes beyond its amplitudes lose their names, and have no unknown.
fn keep(model: &mut Model, index: usize, made: &Arc<ReducedPart>) {
    let Some(of) = model.reductions.get_mut(index) else { return };
    for node in of.amplitudes.drain(made.matrices.amplitudes()..) {
        model.nodes[node].label.clear();
    }
    of.made = Some(made.clone());
}

/// The error of initial velocities of inner nodes that are not those of the shapes.
fn other_velocities(model: &Model, index: usize, made: &ReducedPart) -> Option<Diagnostic> {
    let of = model.reductions.get(index).filter(|_| model.analysis.is_dynamic())?;
    let size = made.matrices.size();
    let mut at_interface = vec![0.0; size];
    for (i, &node) in of.interface.iter().enumerate() {
        at_interface[6 * i..6 * i + 3].copy_from_slice(model.nodes[node].v.as_slice());
        at_interface[6 * i + 3..6 * i + 6].copy_from_slice(model.nodes[node].omega.as_slice());
    }
    let largest = of.inner.iter().map(|&node| model.nodes[node].v.norm()).fold(0.0, f64::max);
    let differs = |(k, &node): (usize, &usize)| {
        let row = |axis: usize| -> f64 {
            let shape = made.shapes.iter().skip(6 * k + axis).step_by(6 * of.inner.len());
            shape.zip(&at_interface).map(|(shape, v)| shape * v).sum()
        };
        (model.nodes[node].v - Vec3::new(row(0), row(1), row(2))).norm() > CARRIED * largest
    };
    let (_, node) = of.inner.iter().enumerate().find(|(k, node)| differs((*k, node)))?;
    let message = format!(
        "the initial velocity of `{}`, inside of {}, is not that of the static shapes of its interface",
        model.nodes[*node].label, of.title
    );
    let hint =
        "give the whole part one rigid motion, by `velocity`, `angular_velocity` and `about`, or leave `reduced` out";
    Some(Diagnostic::error(message).at(&(of.place[0]..of.place[1])).hint(hint))
}

/// The part alone, with its interface held.
fn alone(model: &Model, of: &Reduction) -> Model {
    let mut own = Model {
        parts: of.own_parts(&model.parts),
        nodes: model.nodes.clone(),
        stiffnesses: model.stiffnesses.clone(),
        title: String::new(),
        analysis: model.analysis.clone(),
        solution: model.solution.clone(),
        bodies: Vec::new(),
        masses: Vec::new(),
        stresses: model.stresses.clone(),
        reductions: Vec::new(),
        constraints: Constraints::default(),
        loading: ModelLoading::default(),
        cases: LoadCases::default(),
        damping: Damping::default(),
        expects: Vec::new(),
        origin: Default::default(),
        output: model.output.clone(),
        study: None,
    };
    own.nodes.iter_mut().for_each(|node| {
        node.is_number = false;
        (node.v, node.omega) = (Vec3::zeros(), Vec3::zeros());
    });
    let held = |&node: &usize| (0..6).map(move |dof| Restraint { node, dof, motion: None });
    let carried = of.carried.iter().map(|(node, _)| node);
    own.constraints.restraints = of.interface.iter().chain(carried).flat_map(held).collect();
    let analysis = &mut own.analysis;
    let asked = ModesAsked { extent: ModeExtent::Count(of.modes), damped: false, speeds: Vec::new() };
    (analysis.kind, analysis.is_linear, analysis.plane) = (AnalysisKind::Modal(asked), false, false);
    (analysis.begin, analysis.end_time, analysis.stage) = (0.0, 1.0, None);
    analysis.step_length = StepLength::Fixed { step: 1.0 };
    own
}

/// Refuses interfaces whose full matrices cost more than the elements.
fn refuse_large(of: &Reduction) -> Result<(), String> {
    let (interface, inner) = (of.interface.len(), of.inner.len());
    if inner > 0 && 6 * interface <= MOST && (6 * interface <= FEW || interface <= inner) {
        return Ok(());
    }
    Err(format!(
        "its interface has {interface} nodes, beside {inner} inside, and its matrices over them are full. Support or join it at fewer nodes, at most {} and no more than inside, or leave `reduced` out",
        MOST / 6
    ))
}

fn reduced(model: &Model, of: &Reduction, known: &mut Known) -> Result<Arc<ReducedPart>, String> {
    refuse_large(of)?;
    let own = alone(model, of);
    let system = System::in_space(&own)?;
    let plan = Plan::new(&own, &system, 1);
    let never = AtomicBool::new(false);
    let state = State {
        nodes: own.nodes.iter().map(|node| Node::at_rest(node.x)).collect(),
        history: vec![0.0; system.history],
        ..State::default()
    };
    let loading = Loading::default();
    let at = Linearized {
        model: &own,
        system: &system,
        plan: &plan,
        state: &state,
        loading: &loading,
        factored: &loading,
        stop: &never,
    };
    let own = OwnNodes::new(of, own.nodes.len());
    let likeness = may_be_like_another(model, of).then(|| Likeness::new(&at, model, of, &own));
    if let Some(made) = likeness.as_ref().and_then(|likeness| likeness.find(known, of)) {
        return Ok(Arc::new(made));
    }
    let (mut solver, mut assembly) = at.symmetric_solver().map_err(|error| error.to_string())?;
    let mut pencil = Pencil::new(at, (&mut solver, &mut assembly));
    let mut pairs = inner_modes(&mut pencil, of)?;
    match pencil.factor(0.0) {
        Ok(0) => {}
        Ok(_) => return Err("with its interface held, it is unstable at t = 0".to_owned()),
        Err(row) => return Err(words(&pencil.singular(row))),
    }
    let rows: Vec<usize> = plan.dofs.nodal_dofs().iter().map(|(node, dof)| 6 * own.place[*node] + dof).collect();
    let masses = reduced::masses(model, of, &own.place);
    let (loads, count) = (masses.rigid_loads(), pairs.kept.len());
    let loads = loads.column_iter().map(|load| rows.iter().map(|&row| load[row]).collect()).collect();
    pairs.kept.extend(inertia_shapes(&mut pencil, loads, &pairs.kept));
    let columns = columns(&mut pencil, (of, &own, &rows), &pairs.kept);
    let shapes = Shapes { of, own, at, columns, masses };
    let made = Arc::new(shapes.into_part(&pairs, count)?);
    known.extend(likeness.map(|likeness| (likeness, made.clone())));
    Ok(made)
}

/// The modes with a fixed interface.
struct InnerModes {
    /// ω² and the motion of the unknowns; static shapes follow the modes.
    kept: Vec<(f64, Vec<f64>)>,
    /// The frequency of the first mode beyond.
    next: Option<f64>,
}

fn inner_modes(pencil: &mut Pencil, of: &Reduction) -> Result<InnerModes, String> {
    let asked = of.modes;
    let own = pencil.at.unknowns();
    if asked == 0 || pencil.mass.is_zero() {
        return Ok(InnerModes { kept: Vec::new(), next: None });
    }
    let with_mass = (0..own).filter(|&row| pencil.mass.row(row).any(|(_, mass)| mass != 0.0)).count();
    let count = (asked + EQUAL_MODES).min(with_mass);
    let mut kept = natural_pairs(pencil, ModeExtent::Count(count)).map_err(|fault| words(&fault))?;
    let frequency = |square: f64| square.max(0.0).sqrt() / TAU;
    let within = kept.iter().take(asked).filter(|(square, _)| of.up_to.is_none_or(|most| frequency(*square) <= most));
    let mut within = within.count();
    // Equal frequencies stay together, so that a round part has the same shapes in all directions.
    while within > 0 && kept.get(within).is_some_and(|(next, _)| *next <= (1.0 + PAIR) * kept[within - 1].0) {
        within += 1;
    }
    let next = kept.get(within).map(|(square, _)| frequency(*square));
    kept.truncate(within);
    Ok(InnerModes { kept, next })
}

/// The fault of the part with its interface held, in words.
fn words(fault: &ModesFault) -> String {
    match fault {
        ModesFault::Singular { label, direction } => {
            format!(
                "with its interface held, nothing resists at `{label}` in direction {direction}. Support the part there, or leave `reduced` out"
            )
        }
        fault => fault.to_string(),
    }
}

/// The motions of the nodes of a part by a unit of each degree of freedom of the superelement: six rows for each node.
fn columns(
    pencil: &mut Pencil,
    (of, own, rows): (&Reduction, &OwnNodes, &[usize]),
    modes: &[(f64, Vec<f64>)],
) -> DMatrix<f64> {
    let at = pencil.at;
    let placed = 6 * of.interface.len();
    let mut statics = vec![vec![0.0; at.unknowns()]; placed];
    let moved = |nodes: &[Node], statics: &[Vec<f64>]| -> Vec<Vec<Vec6>> {
        let of_unit = |(k, x): (usize, &Vec<f64>)| {
            let mut motions = own.of(&at.motions(nodes, x));
            motions[k / 6][k % 6] = 1.0;
            let [d, theta] = [0, 3].map(|at| Vec3::from_fn(|axis, _| f64::from(k % 6 == at + axis)));
            for &(node, _) in of.carried.iter().filter(|(_, place)| *place == k / 6) {
                let arm = at.model.nodes[node].x - at.model.nodes[of.interface[k / 6]].x;
                motions[own.place[node]] = stack(&(d + theta.cross(&arm)), &theta);
            }
            motions
        };
        statics.iter().enumerate().map(of_unit).collect()
    };
    // The second solution removes the rounding of the first: rigid motions, and axial forces beside bending, need its digits.
    for _ in 0..2 {
        let columns = own.matrix(&moved(&pencil.nodes, &statics));
        let forces = forces(&at, &pencil.nodes, own, &columns);
        let unknown = |column: usize| rows.iter().map(|&row| -forces[(row, column)]).collect();
        let mut missing: Vec<Vec<f64>> = (0..placed).map(unknown).collect();
        pencil.solve_all(&mut missing);
        statics.iter_mut().flatten().zip(missing.iter().flatten()).for_each(|(sum, x)| *sum += x);
    }
    let mut columns = moved(&pencil.nodes, &statics);
    columns.extend(modes.iter().map(|(_, x)| own.of(&at.motions(&pencil.nodes, x))));
    own.matrix(&columns)
}

/// K times motions of the nodes of a part.
fn forces(at: &Linearized, nodes: &[Node], own: &OwnNodes, columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut forces = DMatrix::zeros(columns.nrows(), columns.ncols());
    let (mut rows, mut moved) = (Vec::new(), Vec::new());
    each_element(at, nodes, |nodes, d, K| {
        rows.clear();
        rows.extend((0..d * nodes.len()).map(|i| 6 * own.place[nodes[i / d]] + i % d));
        for (column, mut forces) in columns.column_iter().zip(forces.column_iter_mut()) {
            moved.clear();
            moved.extend(rows.iter().map(|&row| column[row]));
            for (&row, K) in rows.iter().zip(K.chunks_exact(rows.len())) {
                forces[row] += dot(K, &moved);
            }
        }
    });
    forces
}

/// The shapes of a part.
struct Shapes<'a> {
    of: &'a Reduction,
    own: OwnNodes,
    at: Linearized<'a>,
    /// Six rows for each node of the part, and a column for each degree of freedom of the superelement.
    columns: DMatrix<f64>,
    masses: ModalMass,
}

impl Shapes<'_> {
    /// The part, with so many modes among the shapes of its inside.
    fn into_part(mut self, modes: &InnerModes, count: usize) -> Result<ReducedPart, String> {
        let (of, placed) = (self.of, 6 * self.of.interface.len());
        let mut mass = self.masses.matrix(&self.columns);
        let total = (0..3).map(|axis| self.total(&mass, axis)).sum::<f64>() / 3.0;
        // Amplitudes are as large as displacements that have their energy.
        for column in placed..self.columns.ncols() {
            let scale = (total / mass[(column, column)]).sqrt();
            self.columns.column_mut(column).scale_mut(scale);
            mass.row_mut(column).scale_mut(scale);
            mass.column_mut(column).scale_mut(scale);
        }
        let mut stiffness = self.stiffness();
        for (mode, (square, _)) in modes.kept.iter().enumerate() {
            let k = placed + mode;
            stiffness.row_mut(k).fill(0.0);
            stiffness.column_mut(k).fill(0.0);
            stiffness[(k, k)] = square * mass[(k, k)];
        }
        if of.interface.len() == 1 {
            // One node moves the part rigidly, so its stiffness is rounding.
            stiffness.view_mut((0, 0), (placed, placed)).fill(0.0);
        }
        let has_mass = total > 0.0;
        let x: Vec<Vec3> = of.interface.iter().map(|&node| self.at.model.nodes[node].x).collect();
        let made = SuperelementMatrices { stiffness, mass: has_mass.then_some(mass), damping: None };
        let (made, ..) = settle(made, &x, true)
            .map_err(|wrong| format!("{}, by rounding. Take fewer elements, or leave `reduced` out", wrong.message))?;
        let entries = |matrix: &DMatrix<f64>| Arc::from(matrix.as_slice());
        let amplitudes = &of.amplitudes[..modes.kept.len()];
        let mut matrices = SuperelementData {
            nodes: of.interface.iter().chain(amplitudes).copied().collect(),
            interface: of.interface.len(),
            turns: true,
            stiffness: entries(&made.stiffness),
            mass: made.mass.as_ref().map_or_else(|| Arc::from([]), entries),
            damping: Arc::from([]),
            second_order: None,
        };
        if of.geometric && placed + count <= LARGEST {
            matrices.second_order = self.second_order(&made.stiffness, &matrices).map(Arc::new);
        }
        let first = placed + 6 * of.carried.len();
        let shapes = self.columns.column_iter().flat_map(|column| column.into_owned().as_slice()[first..].to_vec());
        let shapes = shapes.collect();
        let integrals = has_mass.then(|| Arc::new(InertiaIntegrals::new(&self.masses, &self.columns)));
        let frequencies = modes.kept[..count].iter().map(|(square, _)| square.max(0.0).sqrt() / TAU).collect();
        let replaced = self.at.unknowns();
        let inertia_shapes = modes.kept.len() - count;
        Ok(ReducedPart { matrices, shapes, integrals, frequencies, inertia_shapes, next: modes.next, replaced })
    }

    /// The mass that moves along an axis.
    fn total(&self, mass: &DMatrix<f64>, axis: usize) -> f64 {
        let along = || (0..self.of.interface.len()).map(|i| 6 * i + axis);
        along().flat_map(|row| along().map(move |column| (row, column))).map(|at| mass[at]).sum()
    }

    /// The terms of second order.
    fn second_order(&self, stiffness: &DMatrix<f64>, made: &SuperelementData) -> Option<SecondOrder> {
        let x: Vec<Vec3> = self.at.model.nodes.iter().map(|node| node.x).collect();
        let element = FloatingElement::new(made.clone(), &x, 0.0);
        second_order(&self.at, (&self.own, &self.columns), (stiffness, &element))
    }

    /// Φᵀ K Φ.
    fn stiffness(&self) -> DMatrix<f64> {
        products(&self.columns, &forces(&self.at, &self.at.nodes_at_rest(), &self.own, &self.columns))
    }
}
