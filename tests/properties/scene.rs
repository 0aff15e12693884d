//! Scenes put together in code, and runs of them kept frame by frame.

use rand::rngs::StdRng;
use rand::{Rng, RngExt};
use rdsolve::amplitude::Amplitude;
use rdsolve::elements::beam::{FibreGroup, FibreModel, IntegrationRule};
use rdsolve::elements::damper::Damper;
use rdsolve::elements::heat::Heat;
use rdsolve::elements::isolator::IsolatorLaw;
use rdsolve::elements::link::LinkLaw;
use rdsolve::elements::pressure::Face;
use rdsolve::elements::shell::{self, DRILLING, Plate};
use rdsolve::integrators::{RotationUpdate, WilsonTheta};
use rdsolve::linear;
use rdsolve::materials::uniaxial::UniaxialLaw;
use rdsolve::materials::{Hardening, MaterialLaw as Material, Overstress, Viscosity};
use rdsolve::math::{Mat3, Vec3, quadrature, rotation};
use rdsolve::model::*;
use rdsolve::plan::Plan;
use rdsolve::sections::{Fibre, Stiffness};
use rdsolve::solids::sphere::SolidSphere;
use rdsolve::solve::{Counts, Frame, Observer, Outcome, Run, Wanted};
use rdsolve::state::State;
use rdsolve::system::System;
use rdsolve::system::energy::Energy;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub use crate::support::random::{turn, vector};

pub type Quat = nalgebra::Quaternion<f64>;
pub const ALL: [bool; 6] = [true; 6];
pub const TRANSLATIONS: [bool; 6] = [true, true, true, false, false, false];

/// A positive inertia that no axis favours.
pub fn inertia(rng: &mut impl Rng, size: f64) -> Mat3 {
    let R = rotation::matrix(&turn(rng));
    let [a, b, c] = [(); 3].map(|()| rng.random_range(0.5..1.0));
    // The moments of three masses on the axes: each below the sum of the other two.
    R * Mat3::from_diagonal(&Vec3::new(a + b, b + c, c + a)) * R.transpose() * size
}

/// Nothing in it. The iteration tolerance lies so low that iteration is not what tests see.
pub fn empty(kind: AnalysisKind, end_time: f64, time_step: f64) -> Model {
    Model {
        title: String::new(),
        analysis: Analysis {
            kind,
            is_linear: false,
            begin: 0.0,
            end_time,
            accuracy: None,
            stage: None,
            step_length: StepLength::Fixed { step: time_step },
            least_step: time_step * 1e-3,
            plane: false,
        },
        solution: Solution {
            choice: None,
            masses: rdsolve::model::ElementMasses::OfSections,
            scheme: Arc::new(WilsonTheta { theta: 1.4, rotation: RotationUpdate::Exponential }),
            iteration: Iteration {
                method: Method::TangentStiffness,
                update: Update::Auto,
                gyroscopic: Gyroscopic::Auto,
                tolerance: 1e-12,
                follows_step: false,
                limit: 30,
            },
        },
        nodes: vec![],
        bodies: vec![],
        masses: vec![],
        stiffnesses: vec![],
        stresses: vec![],
        parts: vec![],
        reductions: Vec::new(),
        constraints: Constraints { restraints: vec![], ..Constraints::default() },
        cases: LoadCases::default(),
        loading: Loading::default(),
        damping: Damping::default(),
        expects: vec![],
        origin: Origin::default(),
        output: Output {
            units: None,
            nodes: vec![],
            sets: Vec::new(),
            drifts: vec![],
            cadence: Cadence::Steps(1),
            cadence_is_open: false,
            energy: true,
            links: false,
            contacts: None,
            reactions: true,
            sections: None,
            failures: false,
            layers: false,
            parts: false,
            joints: false,
            fields: None,
            checkpoint: None,
        },
        study: None,
    }
}

pub fn node(m: &mut Model, x: Vec3) -> usize {
    let label = format!("n{}", m.nodes.len());
    m.nodes.push(Node {
        label,
        named: true,
        x,
        v: Vec3::zeros(),
        omega: Vec3::zeros(),
        is_number: false,
        given: [None, None],
        place: None,
    });
    m.nodes.len() - 1
}

pub fn body(m: &mut Model, x: Vec3, mass: f64, inertia: Mat3) -> usize {
    let n = node(m, x);
    m.bodies.push(Body { name: format!("b{n}"), node: n, mass, inertia, shape: Arc::new(SolidSphere { radius: 1.0 }) });
    n
}

pub fn mass(m: &mut Model, node: usize, mass: f64, inertia: Mat3) {
    m.masses.push(Mass { node, mass, inertia });
}

pub fn attach(m: &mut Model, node: usize, master: usize, dofs: [bool; 6]) {
    m.constraints.dependents.push(DependentNode { node, master, dofs, place: None });
}

/// A section whose stiffnesses are of the same order, so that all of them show.
pub fn section(m: &mut Model) {
    m.stiffnesses.push(Stiffness {
        N: Mat3::new(900.0, 0.0, 0.0, 0.0, 400.0, 30.0, 0.0, 30.0, 300.0),
        M: Mat3::new(30.0, 0.0, 0.0, 0.0, 40.0, 5.0, 0.0, 5.0, 60.0),
        NM: Mat3::new(0.0, 0.0, 0.0, 6.0, 0.0, 0.0, -4.0, 0.0, 0.0),
        mass_center: [0.0; 2],
        mass_per_length: 0.7,
        inertia_per_length: Mat3::new(0.05, 0.0, 0.0, 0.0, 0.02, 0.005, 0.0, 0.005, 0.03),
    });
}

/// A beam of the last section made; `y` lies in its local x-y plane.
pub fn beam(m: &mut Model, ends: [usize; 2], elements: usize, order: usize, y: Vec3, mass: MassKind) {
    let [x0, x1] = ends.map(|n| m.nodes[n].x);
    let e1 = (x1 - x0).normalize();
    let e3 = e1.cross(&y).normalize();
    let frame = Mat3::from_columns(&[e1, e3.cross(&e1), e3]);
    let at = quadrature::lobatto(order + 1).0;
    let mut made = vec![];
    let mut last = ends[0];
    for e in 0..elements {
        let mut nodes = [last; 5];
        for k in 1..=order {
            let s = (e as f64 + 0.5 + 0.5 * at[k]) / elements as f64;
            let end = e + 1 == elements && k == order;
            nodes[k] = if end { ends[1] } else { node(m, x0 + (x1 - x0) * s) };
        }
        last = nodes[order];
        made.push(BeamElement::new(nodes, frame, m.stiffnesses.len() - 1));
    }
    let name = format!("beam{}", m.count(PartKind::Beam));
    m.add(Beam {
        name,
        order,
        mass,
        rotary_inertia: true,
        damping: OwnDamping::default(),
        heat: Heat::NONE,
        yielding: None,
        graded: false,
        elements: made,
    });
}

pub fn line(m: &mut Model, ends: [usize; 2], law: LinkLaw, damping: f64, direction: Option<Vec3>) {
    let arm = m.nodes[ends[1]].x - m.nodes[ends[0]].x;
    let free_length = direction.map_or(arm.norm(), |d| d.dot(&arm));
    let kind = LinkKind::Line { law, damper: Damper::linear(damping), direction, free_length };
    let name = format!("link{}", m.count(PartKind::Link));
    m.add(Link { name, ends, kind, own_damping: OwnDamping::default(), failure: None, take_up: None });
}

pub fn spring(m: &mut Model, ends: [usize; 2], stiffness: f64, damping: f64) {
    line(m, ends, LinkLaw::Linear { stiffness, preload: 0.0 }, damping, None);
}

pub fn bar(m: &mut Model, ends: [usize; 2], axial_stiffness: f64, mass_per_length: f64, mass: MassKind) {
    let name = format!("bar{}", m.count(PartKind::Bar));
    m.add(Bar {
        name,
        axial_stiffness,
        mass_per_length,
        mass,
        damping: OwnDamping::default(),
        heat: Heat::NONE,
        tension_only: false,
        free: 1.0,
        yielding: None,
        elements: vec![ends],
    });
}

/// A patch of n by m shell elements over the parallelogram of `a`, `b` and `d`; returns its nodes, row by row from `a`.
pub fn shell(
    model: &mut Model,
    [a, b, d]: [Vec3; 3],
    [n, m]: [usize; 2],
    corners: usize,
    mass: MassKind,
) -> Vec<usize> {
    let at = |i: usize, j: usize| a + (b - a) * (i as f64 / n as f64) + (d - a) * (j as f64 / m as f64);
    let nodes: Vec<usize> = (0..(n + 1) * (m + 1)).map(|k| node(model, at(k % (n + 1), k / (n + 1)))).collect();
    let normals = [(b - a).cross(&(d - a)).normalize(); 4];
    let mut elements = vec![];
    for k in (0..n * m).map(|k| k / n * (n + 1) + k % n) {
        let of = [k, k + 1, k + n + 2, k + n + 1].map(|k| nodes[k]);
        let split = [[of[0], of[1], of[2], of[2]], [of[0], of[2], of[3], of[3]]];
        let whole = [of];
        let of: &[[usize; 4]] = if corners == 3 { &split } else { &whole };
        elements.extend(of.iter().map(|&nodes| ShellElement {
            bulge: shell::ShellGeometry::new(&nodes[..corners], &normals).bulge,
            ..ShellElement::new(&nodes, &normals)
        }));
    }
    let name = format!("shell{}", model.count(PartKind::Shell));
    let plate = Plate { thickness: 0.1, E: 2e3, nu: 0.3, drilling: DRILLING };
    model.add(Shell {
        name,
        plate,
        density: 3.0,
        mass,
        damping: OwnDamping::default(),
        heat: Heat::NONE,
        yielding: None,
        axis: Vec3::x(),
        corners,
        order: 1,
        elements,
        numbers: vec![],
        thicknesses: vec![],
    });
    nodes
}

/// Pressure that follows on all shells.
pub fn press(m: &mut Model, pressure: f64, amplitude: Option<usize>) {
    let elements = m.each::<Shell>().flat_map(|s| s.elements.iter().map(|e| &e.nodes[..s.corners]));
    let faces = elements.filter_map(Face::of).collect();
    m.loading.pressures.push(Pressure { faces, pressure, amplitude });
}

pub fn fix(m: &mut Model, node: usize, dofs: impl IntoIterator<Item = usize>) {
    m.constraints.restraints.extend(dofs.into_iter().map(|dof| Restraint { node, dof, motion: None }));
}

pub fn push(m: &mut Model, node: usize, force: Vec3, moment: Vec3, follower: bool, amplitude: Option<usize>) {
    m.loading.nodal.push(Load { node, force, moment, follower, amplitude, origin: None, moment_counts: true });
}

pub fn sine_squared(m: &mut Model, angular_frequency: f64) -> usize {
    m.loading.amplitudes.push(Amplitude::SineSquared { angular_frequency, start: 0.0, end: f64::INFINITY });
    m.loading.amplitudes.len() - 1
}

/// A structure of one of each: beams of all orders and masses, a bar, links, a bushing; a body with dependent nodes of all six
/// directions, of translations only, and on a dependent node; an offset node on a free node; loads that follow.
pub fn zoo(rng: &mut StdRng, kind: AnalysisKind, time_step: f64) -> Model {
    let mut m = empty(kind, 1.0, time_step);
    section(&mut m);
    let spots = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [3.5, 2.5, 0.5], [1.0, 3.0, 1.0], [0.0, 2.0, 2.0]];
    let p: Vec<usize> = spots.iter().map(|&x| node(&mut m, Vec3::from(x) + vector(rng, 0.2))).collect();
    let masses = [MassKind::Lumped, MassKind::Consistent, MassKind::Lumped, MassKind::Consistent];
    for (order, kind) in (1..=4).zip(masses) {
        beam(&mut m, [p[order - 1], p[order]], 2, order, Vec3::new(0.3, -0.2, 1.0) + vector(rng, 0.1), kind);
    }
    fix(&mut m, p[0], 0..6);
    let centre = (m.nodes[p[4]].x + m.nodes[p[5]].x) * 0.5;
    let hub = body(&mut m, centre, 2.0, inertia(rng, 0.4));
    attach(&mut m, p[4], hub, ALL);
    attach(&mut m, p[5], hub, TRANSLATIONS);
    // On the ball joint hangs a beam with a free end, and on that end sits an arm.
    let out = node(&mut m, centre + Vec3::new(-1.0, 1.0, 2.5) + vector(rng, 0.2));
    beam(&mut m, [p[5], out], 1, 3, Vec3::new(0.0, 1.0, 0.1), MassKind::Lumped);
    let offset = node(&mut m, centre + Vec3::new(-1.3, 1.4, 2.8));
    attach(&mut m, offset, out, ALL);
    // A dependent node on a dependent node.
    let far = node(&mut m, centre + Vec3::new(0.7, 0.4, -0.6));
    let farther = node(&mut m, centre + Vec3::new(1.2, 0.1, -1.1));
    attach(&mut m, far, hub, ALL);
    attach(&mut m, farther, far, ALL);
    let ground = node(&mut m, Vec3::new(2.0, 2.0, -2.0));
    fix(&mut m, ground, 0..6);
    bar(&mut m, [offset, farther], 50.0, 0.2, MassKind::Consistent);
    let tip = m.nodes[p[3]].x;
    let free = node(&mut m, tip + Vec3::new(0.5, -0.2, 1.0));
    mass(&mut m, free, 0.6, Mat3::zeros());
    bar(&mut m, [p[3], free], 80.0, 0.0, MassKind::None);
    spring(&mut m, [farther, free], 40.0, 0.0);
    line(
        &mut m,
        [far, ground],
        LinkLaw::Linear { stiffness: 30.0, preload: 2.0 },
        0.0,
        Some(vector(rng, 1.0).normalize()),
    );
    line(&mut m, [free, ground], LinkLaw::Table { points: vec![[-9.0, -90.0], [0.0, 0.0], [9.0, 200.0]] }, 0.0, None);
    m.add(Link {
        name: "bushing".into(),
        ends: [p[2], offset],
        kind: LinkKind::Bushing {
            stiffness: [9.0, 12.0, 8.0, 3.0, 4.0, 2.0],
            damping: [0.0; 6],
            axes: rotation::matrix(&turn(rng)),
        },
        own_damping: OwnDamping::default(),
        failure: None,
        take_up: None,
    });
    // Rubber that does not yield: its first end moves and turns.
    m.add(Link {
        name: "rubber".into(),
        ends: [p[1], offset],
        kind: LinkKind::Isolator {
            law: IsolatorLaw::Rubber { yield_force: 1e9, post_yield_stiffness: 3.0 },
            stiffness: 9.0,
            axial_stiffness: 15.0,
            axes: rotation::matrix(&turn(rng)),
        },
        own_damping: OwnDamping::default(),
        failure: None,
        take_up: None,
    });
    for (at, follower) in [(p[1], true), (p[3], false), (farther, true), (hub, true), (offset, true), (p[5], true)] {
        push(&mut m, at, vector(rng, 8.0), vector(rng, 3.0), follower, None);
    }
    mass(&mut m, p[2], 0.5, inertia(rng, 0.1));
    m.loading.gravity = vector(rng, 5.0);
    for n in &mut m.nodes {
        n.v = Vec3::zeros();
    }
    m
}

/// Makes all beams and bars of a material that yields at a stress; E = 2000. The parts take turns in what there is to choose.
pub fn soften(m: &mut Model, yield_stress: f64) {
    let hardening = || Hardening::Linear { yield_stress, modulus: 200.0 };
    let viscosity = Viscosity { fluidity: 5.0, overstress: Overstress::Power { exponent: 2.0 } };
    let laws = [None, Some(viscosity)].map(|viscosity| Material::new(2e3, 0.3, hardening(), 0.4, viscosity));
    // A square of 0.5 by 0.5, below the stiffness of `section` in all respects.
    let at = |i: usize| (i as f64 - 1.5) * 0.125;
    let fibres = (0..4).flat_map(|i| (0..4).map(move |j| (at(i), at(j))));
    let fibre = |(y, z): (f64, f64)| Fibre { area: 0.0156, y, z, shear: [[0.9, 0.0, -z], [0.0, 0.9, y]] };
    let fibres: Vec<Fibre> = fibres.map(fibre).collect();
    for (i, beam) in m.each_mut::<Beam>().enumerate() {
        let (rule, points) =
            if i % 3 == 1 { (IntegrationRule::Lobatto, 5) } else { (IntegrationRule::Gauss, beam.order + i % 2) };
        let groups = vec![FibreGroup { law: UniaxialLaw::Plastic(laws[i % 2].clone()), fibres: fibres.clone() }];
        beam.yielding = Some(FibreModel { groups, shear: i % 4 < 2, rule, points: points.min(5) });
    }
    for (i, bar) in m.each_mut::<Bar>().enumerate() {
        bar.yielding = Some(laws[i % 2].clone());
        bar.tension_only = i % 2 == 1;
    }
    for (i, part) in m.each_mut::<Shell>().enumerate() {
        part.yielding = Some(shell::LayerModel { law: laws[i % 2].clone(), layers: 3, logarithmic: i % 2 == 1 });
    }
}

/// The scene turned by R about the origin, then shifted. Restraint directions must come in whole triples.
pub fn turned(m: &Model, q: &Quat, shift: &Vec3) -> Model {
    let R = rotation::matrix(q);
    let mut t = m.clone();
    let tensor = |J: &mut Mat3| *J = R * *J * R.transpose();
    for n in &mut t.nodes {
        (n.x, n.v, n.omega) = (R * n.x + shift, R * n.v, R * n.omega);
    }
    t.bodies.iter_mut().for_each(|b| tensor(&mut b.inertia));
    t.masses.iter_mut().for_each(|b| tensor(&mut b.inertia));
    t.each_mut::<Beam>().flat_map(|b| &mut b.elements).for_each(|e| e.frame = R * e.frame);
    t.each_mut::<Shell>().flat_map(|s| &mut s.elements).for_each(|e| e.normals = e.normals.map(|n| R * n));
    for link in t.each_mut::<Link>() {
        match &mut link.kind {
            LinkKind::Line { direction, .. } | LinkKind::Hysteretic { direction, .. } => {
                *direction = direction.map(|d| R * d)
            }
            LinkKind::Bushing { axes, .. } | LinkKind::Bearing { axes, .. } | LinkKind::Isolator { axes, .. } => {
                *axes = R * *axes
            }
            LinkKind::Joint { .. } => unreachable!("the scene has no coordinates of joints"),
        }
    }
    for load in &mut t.loading.nodal {
        (load.force, load.moment) = (R * load.force, R * load.moment);
    }
    t.loading.gravity = R * t.loading.gravity;
    t.loading.base_accelerations.iter_mut().for_each(|b| b.direction = R * b.direction);
    // A motion along one axis becomes one with three components.
    let moved: Vec<Restraint> = t.constraints.restraints.extract_if(.., |h| h.motion.is_some()).collect();
    for h in moved {
        let motion = h.motion.expect("filtered");
        for i in 0..3 {
            let scale = motion.scale * R[(i, h.dof % 3)];
            let dof = h.dof / 3 * 3 + i;
            t.constraints.restraints.retain(|other| (other.node, other.dof) != (h.node, dof));
            t.constraints.restraints.push(Restraint {
                node: h.node,
                dof,
                motion: Some(PrescribedMotion { scale, ..motion.clone() }),
            });
        }
    }
    t.constraints.restraints.sort_by_key(|h| (h.node, h.dof));
    t
}

/// What a run showed at its due steps.
pub struct Record {
    pub states: Vec<State>,
    pub energies: Vec<Energy>,
    pub counts: Counts,
}

impl Record {
    pub fn last(&self) -> &State {
        self.states.last().expect("t = 0 is always shown")
    }
}

impl Observer for Record {
    fn on_step(&mut self, frame: &Frame) -> std::io::Result<()> {
        if frame.due {
            self.states.push(frame.state.clone());
            self.energies.extend(frame.derived.energy);
        }
        Ok(())
    }
}

/// Runs to the end; anything else fails the test.
pub fn run(m: &Model) -> Record {
    run_with(m, None)
}

pub fn run_with(m: &Model, solver: Option<linear::Factorization>) -> Record {
    let mut m = m.clone();
    m.constraints.restraints.sort_by_key(|h| (h.node, h.dof));
    let system = System::new(&m).unwrap();
    let mut plan = Plan::new(&m, &system, 1);
    plan.kind = solver.unwrap_or(plan.kind);
    let stop = AtomicBool::new(false);
    let wanted = Wanted::ENERGY | Wanted::REACTIONS;
    let mut run = Run::new(&m, &system, &plan, wanted, &stop).unwrap();
    let mut record = Record { states: vec![], energies: vec![], counts: Counts::default() };
    let (outcome, _) = run.run(&mut record);
    record.counts = run.counts();
    match outcome {
        Outcome::Done => record,
        Outcome::Failed { time, failure } => panic!("failed at t = {time}: {failure}"),
        other => panic!("{other:?}"),
    }
}

/// Largest difference of the positions of two states, of all nodes.
pub fn apart(a: &State, b: &State) -> f64 {
    a.nodes.iter().zip(&b.nodes).map(|(a, b)| (a.x - b.x).norm()).fold(0.0, f64::max)
}

/// Order with which an error falls when the step is halved: errors at Δt and Δt/2.
pub fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}
