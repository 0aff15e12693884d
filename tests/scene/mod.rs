//! A small scene of one of each, and a made-up motion for it: what observers are shown in their tests.

use nalgebra::{Quaternion, Unit, UnitQuaternion};
use rdsolve::elements::IntegrationPoint;
use rdsolve::elements::contact::{self, Surface};
use rdsolve::elements::damper::Damper;
use rdsolve::elements::heat::Heat;
use rdsolve::elements::link::LinkLaw;
use rdsolve::integrators::{RotationUpdate, WilsonTheta};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::*;
use rdsolve::sections::BeamStresses;
use rdsolve::solids::SolidShape;
use rdsolve::solids::cuboid::SolidCuboid;
use rdsolve::solids::hollow::HollowCylinder;
use rdsolve::solids::sphere::SolidSphere;
use rdsolve::solve::{ContactState, ContactTouch, Derived, Effort, Frame, LinkState, SectionPlace, SectionPoint};
use rdsolve::state::{self, State};
use rdsolve::system::energy::Energy;
use std::sync::Arc;

/// A cubic beam on nodes 0-3, a beam of two straight elements on 3-5, a bar, a link, and a body of every shape on 6-9.
pub fn model() -> Model {
    let mut nodes: Vec<Node> = (0..10)
        .map(|i| Node {
            label: format!("node[{i}]"),
            named: true,
            x: Vec3::new(f64::from(i), 0.1 * f64::from(i * i), 0.0),
            v: Vec3::zeros(),
            omega: Vec3::zeros(),
            is_number: false,
            given: [None, None],
            place: None,
        })
        .collect();
    nodes[2].label = "elbow, \"left\"".into();
    let element = |nodes: [usize; 5]| BeamElement::new(nodes, Mat3::identity(), 0);
    let beam = |name: &str, order, elements| Beam {
        name: name.into(),
        order,
        mass: MassKind::Consistent,
        rotary_inertia: true,
        damping: OwnDamping::default(),
        heat: Heat::NONE,
        graded: false,
        yielding: None,
        elements,
    };
    let axis = Vec3::new(1.0, 1.0, 0.0);
    let shapes: [Arc<dyn SolidShape>; 4] = [
        Arc::new(SolidCuboid { size: [1.0, 0.5, 0.2], axes: Mat3::identity() }),
        Arc::new(SolidSphere { radius: 0.5 }),
        Arc::new(HollowCylinder { radius: 0.5, inner_radius: 0.0, length: 1.0, axis }),
        Arc::new(HollowCylinder { radius: 0.5, inner_radius: 0.4, length: 1.0, axis }),
    ];
    let body =
        |(i, shape)| Body { name: format!("body {i}"), node: 6 + i, mass: 1.0, inertia: Mat3::identity(), shape };
    let law = LinkLaw::Linear { stiffness: 1.0, preload: 0.0 };
    Model {
        title: "one of each".into(),
        analysis: Analysis {
            kind: AnalysisKind::Dynamic,
            is_linear: false,
            begin: 0.0,
            end_time: 1.0,
            accuracy: None,
            stage: None,
            step_length: StepLength::Fixed { step: 0.1 },
            least_step: 1e-6,
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
                tolerance: 1e-8,
                follows_step: false,
                limit: 20,
            },
        },
        nodes,
        bodies: shapes.into_iter().enumerate().map(body).collect(),
        masses: vec![],
        stiffnesses: vec![],
        stresses: vec![],
        parts: vec![
            beam("arm", 3, vec![element([0, 1, 2, 3, 0])]).into(),
            beam("fore & aft", 1, vec![element([3, 4, 0, 0, 0]), element([4, 5, 0, 0, 0])]).into(),
            Part::Bar(Bar {
                name: "stay".into(),
                axial_stiffness: 1.0,
                mass_per_length: 0.0,
                mass: MassKind::None,
                damping: OwnDamping::default(),
                heat: Heat::NONE,
                tension_only: false,
                free: 1.0,
                yielding: None,
                elements: vec![[5, 0]],
            }),
            Part::Link(Link {
                name: "bumper".into(),
                ends: [2, 5],
                kind: LinkKind::Line { law, damper: Damper::linear(0.0), direction: None, free_length: 1.0 },
                own_damping: OwnDamping::default(),
                failure: None,
                take_up: None,
            }),
            Part::Contact(Contact {
                name: "seat".into(),
                surface: TouchedSurface::Shape(CarriedSurface {
                    node: 0,
                    surface: Surface {
                        center: Vec3::zeros(),
                        axes: Mat3::identity(),
                        shape: contact::SurfaceShape::Plane(contact::surfaces::Plane),
                    },
                }),
                points: vec![],
                law: None,
                chosen: None,
                size: 1.0,
                convex: Vec::new(),
                joined: Vec::new(),
                touchers: Default::default(),
            }),
        ],
        reductions: Vec::new(),
        constraints: Constraints {
            restraints: vec![Restraint { node: 0, dof: 0, motion: None }, Restraint { node: 0, dof: 5, motion: None }],
            ..Constraints::default()
        },
        cases: LoadCases::default(),
        loading: Loading::default(),
        damping: Damping::default(),
        expects: vec![],
        origin: Origin::default(),
        output: Output {
            units: None,
            nodes: vec![2, 0],
            sets: Vec::new(),
            drifts: vec![],
            cadence: Cadence::Steps(1),
            cadence_is_open: false,
            energy: true,
            links: true,
            contacts: Some(ContactRows::Both),
            reactions: true,
            sections: Some(SectionPlaces::Points),
            failures: false,
            layers: true,
            parts: false,
            joints: false,
            fields: None,
            checkpoint: None,
        },
        study: None,
    }
}

/// Every node turns about its own axis at 5 rad per time and drifts; the numbers have all their digits.
pub fn state(model: &Model, time: f64) -> State {
    let nodes = model
        .nodes
        .iter()
        .enumerate()
        .map(|(i, node)| {
            let axis = Unit::new_normalize(Vec3::new(1.0, i as f64, -0.3));
            let q: Quaternion<f64> = *UnitQuaternion::from_axis_angle(&axis, 5.0 * time).quaternion();
            let swing = Vec3::new((3.0 * time).sin(), (2.0 * time).cos() - 1.0, time / 3.0);
            let at = state::Node::at_rest(node.x + swing);
            state::Node { rotation: q, v: swing / 7.0, omega: 5.0 * *axis, a: -swing, alpha: swing * 1e-9, ..at }
        })
        .collect();
    State {
        time,
        nodes,
        history: vec![],
        jerk: vec![],
        reactions: vec![],
        multipliers: vec![],
        algorithmic_accelerations: vec![],
        work: Default::default(),
    }
}

/// What goes with a state in a frame.
pub struct Extras {
    reactions: [f64; 2],
    derived: Derived,
}

impl Extras {
    pub fn at(time: f64) -> Extras {
        let p = Vec3::new(time, 1.0 / 3.0, -time);
        let point = |point| SectionPoint {
            part: 1,
            element: 0,
            place: SectionPlace::Point(point),
            at: IntegrationPoint {
                s: 0.5,
                forces: [time, 1.0, 2.0, 3.0, 4.0, 5.0],
                plastic_strain: 0.25,
                stresses: Some(BeamStresses { values: [6.0, -7.0, 8.0, 9.0] }),
            },
        };
        let derived = Derived {
            energy: Some(Energy {
                kinetic: time * time,
                strain: 0.1,
                plastic: 0.0,
                viscoplastic: 0.0,
                damping: 1e-20,
                links: 0.3,
                external: 1e20,
                numerical: -0.0,
                mechanical: time,
                p,
                l: -p,
                contact: 0.5,
                friction: 0.25,
                impact: 0.125,
                eroded: 0.0,
                verlet_energy_offset: 0.0,
            }),
            links: vec![LinkState {
                elongation: 0.1 - time,
                rate: -1.0,
                force: 7.0,
                f: p,
                m: Vec3::zeros(),
                failed: false,
            }],
            contacts: vec![ContactState { touching: 2, slipping: 1, gap: -1e-3, f: p, m: Vec3::zeros() }],
            // The second body touches twice, before and after the first.
            contact_touches: [7, 6, 7].map(|node| ContactTouch { contact: 0, nodes: [0, node], f: p, m: -p }).into(),
            sections: vec![point(0), point(1)],
            // That of two steps, of which the second is due.
            effort: Effort { iterations: 6, refactorizations: 2, residual: 1e-9, cuts: 1, error: 0.0 },
            ..Derived::default()
        };
        Extras { reactions: [time, -1.0], derived }
    }

    pub fn frame<'a>(&'a self, model: &'a Model, state: &'a State, step: usize) -> Frame<'a> {
        Frame {
            model,
            state,
            step,
            dt: if step == 0 { 0.0 } else { 0.1 },
            effort: Effort { iterations: 3, refactorizations: 1, residual: 1e-9, cuts: step % 2, error: 0.0 },
            due: step.is_multiple_of(2) || step == 10,
            drawn: matches!(model.output.fields, Some(FieldFiles { cadence: Cadence::Steps(every), .. }) if step.is_multiple_of(every))
                || step == 10,
            last: step == 10,
            inside: false,
            modes: None,
            case: None,
            rows: 0..0,
            compared: false,
            reactions: &self.reactions,
            derived: &self.derived,
            passed: &[],
            negative_pivots: None,
        }
    }
}
