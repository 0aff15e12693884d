//! What decks mean: the numbers of the model.

use rdsolve::diagnostic::Source;
use rdsolve::elements::beam::IntegrationRule;
use rdsolve::elements::pressure::Face;
use rdsolve::materials::{Hardening, MaterialLaw, Overstress, Viscosity};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::model::{
    self, ArcLength, Bar, Beam, Cadence, DisplacementTarget, ExpectAt, History, Link, LinkKind, MassKind, Method,
    Model, PartIndex, PartKind, Shell, StepLength, Tolerance, When,
};
use rdsolve::sections::Fibre;

/// Every table once.
const ALL: &str = include_str!("../everything.toml");
const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/everything.toml");

fn everything() -> Model {
    let (model, problems) = model::read(&Source::new(PATH, ALL, &[]));
    let source = Source::new(PATH, ALL, &[]);
    // Parts lie on each other and share corners alone, and contacts are small beside what touches them, which is said.
    let said = [
        "nothing holds the two together along them",
        "it may pass between them",
        "brakes velocities against the ground",
        "gravity acts at once as the ground begins to move",
        "to the parts that supports hold: it falls freely",
    ];
    let other = problems.iter().filter(|problem| !said.iter().any(|said| problem.message.contains(said)));
    let drawn: Vec<String> = other.map(|problem| problem.draw(&source, false)).collect();
    assert!(drawn.is_empty(), "{}", drawn.join("\n\n"));
    model.unwrap()
}

fn node(model: &Model, label: &str) -> usize {
    model.nodes.iter().position(|node| node.label == label).unwrap_or_else(|| panic!("no node {label}"))
}

#[test]
fn nodes_come_in_the_order_points_bodies_the_rest() {
    let model = everything();
    let labels: Vec<&str> = model.nodes.iter().map(|node| node.label.as_str()).collect();
    assert_eq!(labels[..9], ["a", "b", "c", "d", "hook", "top", "pin", "block", "wheel"]);
    assert!(model.nodes[..11].iter().all(|node| node.named));
    assert!(model.nodes[11..].iter().all(|node| !node.named));
}

#[test]
fn beams_follow_their_path() {
    let model = everything();
    let beams: Vec<&Beam> = model.each().collect();
    let beam = beams[0];
    assert_eq!((beam.order, beam.elements.len()), (2, 3));
    let [a, b, c] = ["a", "b", "c"].map(|name| node(&model, name));
    let start = node(&model, "frame.start");
    assert_eq!(model.nodes[start].x, Vec3::new(0.0, 0.0, 0.5));
    let dependent = model.constraints.dependents.iter().find(|dependent| dependent.node == start).unwrap();
    assert_eq!((dependent.master, dependent.dofs), (a, [true; 6]));
    let ends: Vec<[usize; 2]> = beam.elements.iter().map(|e| [e.nodes[0], e.nodes[2]]).collect();
    assert_eq!((ends[0][0], ends[1][1], ends[2]), (start, b, [b, c]));
    assert_eq!(ends[0][1], ends[1][0]);
    // The Lobatto point of an element of degree two is its middle.
    assert_eq!(model.nodes[beam.elements[2].nodes[1]].x, Vec3::new(0.5, 0.0, 2.0));
    assert_eq!(model.nodes[beam.elements[0].nodes[1]].label, "frame[1]");
    // x along the segment, y towards the orientation, z = x × y.
    assert_eq!(beam.elements[0].frame, Mat3::from_columns(&[Vec3::z(), Vec3::y(), -Vec3::x()]));
    assert_eq!(beam.elements[2].frame, Mat3::from_columns(&[Vec3::x(), Vec3::y(), Vec3::z()]));
}

#[test]
fn beams_of_one_section_and_material_share_a_stiffness() {
    let model = everything();
    let beams: Vec<&Beam> = model.each().collect();
    let index = |beam: usize| beams[beam].elements[0].section;
    assert_eq!(index(0), index(1));
    assert_ne!(index(0), index(2));
    let given = &model.stiffnesses[index(2)];
    assert_eq!((given.N[(0, 0)], given.mass_per_length), (1e8, 3.0));
}

#[test]
fn bars_have_stiffness_and_mass() {
    let model = everything();
    let bars: Vec<&Bar> = model.each().collect();
    let [stay, rope] = [bars[0], bars[1]];
    assert_eq!((stay.axial_stiffness, stay.mass_per_length), (210e9 * 1e-4, 7850.0 * 1e-4));
    assert_eq!((rope.axial_stiffness, rope.mass_per_length, rope.tension_only), (1e6, 0.5, true));
    assert_eq!(rope.elements.len(), 2);
}

#[test]
fn materials_that_yield_reach_their_parts() {
    let model = everything();
    let beams: Vec<&Beam> = model.each().collect();
    assert!(beams[..3].iter().all(|beam| beam.yielding.is_none()));
    let brace = beams[3].yielding.as_ref().unwrap();
    assert_eq!((brace.rule, brace.points, brace.shear), (IntegrationRule::Lobatto, 4, false));
    let hardening = Hardening::Linear { yield_stress: 235e6, modulus: 1e9 };
    let (law, fibres) = brace.plastic().unwrap();
    assert_eq!(*law, MaterialLaw::new(210e9, 0.3, hardening, 0.5, None));
    // Whatever the fibres are, they are the section.
    let sum = |of: fn(&Fibre) -> f64| fibres.iter().map(|fibre| fibre.area * of(fibre)).sum::<f64>();
    let (area, moment) = (0.05 * 0.05, 0.05f64.powi(4) / 12.0);
    assert!((sum(|_| 1.0) - area).abs() < 1e-14 * area);
    for of in [|f: &Fibre| f.y * f.y, |f: &Fibre| f.z * f.z] {
        assert!((sum(of) - moment).abs() < 1e-13 * moment);
    }
    let bars: Vec<&Bar> = model.each().collect();
    assert!(bars[..2].iter().all(|bar| bar.yielding.is_none()));
    let cable = bars[2];
    let hardening = Hardening::table(vec![[0.0, 235e6], [0.02, 240e6], [0.2, 360e6]]).unwrap();
    let viscosity = Viscosity { fluidity: 40.4, overstress: Overstress::Power { exponent: 5.0 } };
    assert_eq!(cable.yielding, Some(MaterialLaw::new(210e9, 0.3, hardening, 0.0, Some(viscosity))));
    assert!(cable.tension_only);
    assert_eq!((model.solution.iteration.method, model.solution.iteration.limit), (Method::InitialLoad, 15));
}

#[test]
fn shells_are_patches() {
    let model = everything();
    let [wall, roof] = ["wall", "roof"].map(|name| model.each::<Shell>().find(|shell| shell.name == name).unwrap());
    assert_eq!((wall.corners, wall.elements.len(), roof.corners, roof.elements.len()), (3, 12, 3, 4));
    assert_eq!((wall.yielding.as_ref().unwrap().layers, roof.yielding.is_none()), (3, true));
    assert_eq!(
        (wall.axis, roof.axis, wall.mass, roof.mass),
        (Vec3::z(), Vec3::x(), MassKind::Consistent, MassKind::Lumped)
    );
    // On a circle about (0.5, 1), edges b-c and c-hook straight. Bound: a rounding.
    let radius = |n: usize| (model.nodes[n].x.x - 0.5).hypot(model.nodes[n].x.y - 1.0);
    assert!(wall.elements.iter().flat_map(|e| e.nodes).all(|n| (radius(n) - 1.25f64.sqrt()).abs() < 1e-15));
    assert!(roof.elements.iter().flat_map(|e| e.normals).all(|n| n.z.abs() < 1e-15 && n.x.abs() < 1e-15));
    let [follower] = &model.loading.pressures[..] else { panic!("one of them follows") };
    assert_eq!((follower.pressure, follower.amplitude, follower.faces.len()), (-3.0, Some(0), 16));
    assert_eq!(follower.faces[0], Face::of(&roof.elements[0].nodes[..3]).unwrap());
    let at = model.parts.iter().position(|part| part.name() == "roof").unwrap();
    assert_eq!(model.expects[4].at, ExpectAt::Shells(at, at + 1));
    assert!(model.output.sections.is_some() && model.output.layers);
}

#[test]
fn shapes_give_mass_and_inertia() {
    let model = everything();
    let wheel = &model.bodies[1];
    // A ring of density 1000, radii 0.5 and 0.4, width 0.1, about y.
    let mass = 1000.0 * std::f64::consts::PI * (0.25 - 0.16) * 0.1;
    let along = mass * (0.25 + 0.16) / 2.0;
    let across = mass * (0.25 + 0.16) / 4.0 + mass * 0.01 / 12.0;
    // A few roundings of numbers of order one.
    assert!((wheel.mass - mass).abs() < 1e-13);
    assert!((wheel.inertia - Mat3::from_diagonal(&Vec3::new(across, along, across))).amax() < 1e-13);
    let from_axis = |p: &Vec3| p.x.hypot(p.z);
    let inner_radius = wheel.shape.outline().points.iter().map(from_axis).fold(f64::INFINITY, f64::min);
    assert!((inner_radius - 0.4).abs() < 1e-15);
    let block = &model.bodies[0];
    assert_eq!((block.mass, block.inertia[(0, 1)], block.inertia[(2, 0)]), (500.0, 1.0, 0.5));
}

#[test]
fn supports_are_sorted_and_say_what_they_do() {
    let model = everything();
    let order: Vec<(usize, usize)> = model.constraints.restraints.iter().map(|held| (held.node, held.dof)).collect();
    assert!(order.is_sorted_by(|a, b| a < b));
    let moved = model.constraints.restraints.iter().find(|held| held.motion.is_some()).unwrap();
    let motion = moved.motion.as_ref().unwrap();
    assert_eq!((moved.node, moved.dof), (node(&model, "d"), 0));
    assert_eq!((motion.scale, motion.history), (0.5, History::Acceleration));
    let ground = node(&model, "anchor.to");
    assert_eq!(order.iter().filter(|(held, _)| *held == ground).count(), 6);
}

#[test]
fn links_measure_from_where_they_are() {
    let model = everything();
    let links: Vec<&Link> = model.each().collect();
    let free = |index: usize| match &links[index].kind {
        LinkKind::Line { free_length, direction, .. } => (*free_length, *direction),
        _ => panic!("no line"),
    };
    assert_eq!(free(0), (0.25, None));
    assert_eq!(free(1), (0.25, Some(-Vec3::x())));
    assert_eq!(free(2), (2.0, None));
    // At its centre a link acts on the body itself, elsewhere on a new node that rides on it.
    assert_eq!(links[2].ends[0], model.bodies[0].node);
    let dependent = model.constraints.dependents.iter().find(|dependent| dependent.node == links[0].ends[0]).unwrap();
    assert_eq!((dependent.master, dependent.dofs), (model.bodies[0].node, [true; 6]));
    let LinkKind::Bushing { stiffness, axes, .. } = &links[3].kind else { panic!("no bushing") };
    assert_eq!((stiffness[5], axes.column(0).into_owned()), (6.0, Vec3::y()));
    assert_eq!(axes.column(2).into_owned(), -Vec3::z());
}

#[test]
fn parts_of_a_mesh_are_rigid_or_not() {
    let model = everything();
    let lid: Vec<_> = model.each::<Shell>().filter(|shell| shell.name == "lid").collect();
    assert_eq!(lid.iter().map(|part| (part.corners, part.elements.len())).collect::<Vec<_>>(), [(4, 1), (3, 2)]);
    assert_eq!(model.nodes[lid[0].elements[0].nodes[2]].x, Vec3::new(6.0, 1.0, 0.5));
    let names: Vec<&str> = model.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["block", "wheel", "frame_of_parts", "plate"]);
    // ρ h A with A = 1 + ½, and of the mast.
    assert!((model.bodies[3].mass - 7850.0 * 0.02 * 1.5).abs() < 1e-12 * 7850.0);
    assert!((model.bodies[2].mass - 7850.0 * 0.0025 * 2.0).abs() < 1e-12 * 7850.0);
    assert_eq!(model.nodes[model.bodies[2].node].x, Vec3::new(0.0, 0.0, 3.0));
    // Corners of the rigid plate that nothing else has are gone, and so is a lone node of the file.
    let gone = ["mesh.1", "mesh.5", "mesh.14"];
    assert!(model.nodes.iter().all(|node| !gone.contains(&node.label.as_str())));
    let [rim, rib] = ["mesh.8", "mesh.6"].map(|label| node(&model, label));
    let dependent = model.constraints.dependents.iter().find(|dependent| dependent.node == rim).unwrap();
    assert_eq!((dependent.master, dependent.dofs), (rib, [true; 6]));
}

#[test]
fn one_word_makes_a_beam_rigid_that_nodes_are_attached_to() {
    // A part without a name of its own goes by its group.
    let source = Source::new(PATH, ALL, &["beams.ribs.rigid=true".to_owned()]);
    let model = model::read(&source).0.expect("a sound deck");
    let ribs = model.bodies.iter().find(|body| body.name == "ribs").expect("a body");
    for label in ["mesh.8", "mesh.9"] {
        let label = node(&model, label);
        let dependent =
            model.constraints.dependents.iter().find(|dependent| dependent.node == label).expect("it rides");
        assert_eq!((dependent.master, dependent.dofs), (ribs.node, [true; 6]));
    }
}

#[test]
fn initial_motion_is_that_of_a_rigid_body_where_it_should_be() {
    let model = everything();
    let omega = Vec3::new(0.0, 0.0, 2.0);
    for element in &model.each::<Beam>().nth(1).unwrap().elements {
        let inner = &model.nodes[element.nodes[1]];
        assert_eq!(inner.v, Vec3::new(1.0, 0.0, 0.0) + omega.cross(&(inner.x - Vec3::new(0.0, 0.0, 2.0))));
        assert_eq!(inner.omega, omega);
    }
    // `hook` rides on the wheel, which turns.
    let (hook, wheel) = (&model.nodes[node(&model, "hook")], &model.nodes[node(&model, "wheel")]);
    assert_eq!(hook.v, wheel.v + wheel.omega.cross(&(hook.x - wheel.x)));
    assert_eq!(model.nodes[node(&model, "a")].v, Vec3::zeros());
}

#[test]
fn the_rest_is_taken_as_written() {
    let model = everything();
    assert_eq!(model.masses[0].inertia, Mat3::zeros());
    assert_eq!(model.loading.nodal[0].node, node(&model, "c"));
    assert_eq!(model.loading.base_accelerations[0].direction, Vec3::new(0.0, 3.0, 0.0));
    assert_eq!((model.damping.mass_factor, model.damping.nodal[0].translation), (0.1, 2.0));
    let expect = &model.expects[0];
    assert_eq!((expect.at, expect.when), (ExpectAt::Node(node(&model, "c")), When::Time(0.3)));
    assert_eq!(expect.tolerance, Tolerance::Relative(0.02));
    assert_eq!(expect.label, "ux of c at t = 0.3");
    assert_eq!(model.expects[1].at, ExpectAt::Part(PartIndex { kind: PartKind::Link, index: 0 }));
    // After the frame, the leg and the arm.
    assert_eq!(model.expects[2].at, ExpectAt::Sections(3));
    assert_eq!(model.expects[3].tolerance, Tolerance::Absolute(1e-3));
    assert_eq!(model.output.nodes, [node(&model, "a"), node(&model, "c"), node(&model, "d")]);
    assert_eq!(
        (model.output.cadence, model.output.fields.map(|files| files.cadence)),
        (Cadence::Interval(0.01), Some(Cadence::Steps(20)))
    );
    assert_eq!(model.analysis.least_step, 1e-4 / 1048576.0);
}

#[test]
fn a_path_is_taken_as_written() {
    let text = r#"
[analysis]
kind = "static"
control = "arc-length"
end_time = 1.0
time_step = 0.1
stop = { at = "b", quantity = "uy", value = -0.8, pass = 2 }
steps = 50
growth = 4.0
[points]
a = [0.0, 0.0, 0.0]
b = [1.0, 0.0, 0.0]
[[beams]]
name = "beam"
path = ["a", "b"]
elements = 2
section = "strip"
orientation = [0.0, 1.0, 0.0]
[sections.strip]
shape = "general"
axial_stiffness = 1e3
shear_stiffness = [1e3, 1e3]
torsional_stiffness = 1.0
bending_stiffness = [1.0, 1.0]
[[supports]]
at = "a"
fix = "all"
[[loads]]
at = "b"
force = [-1.0, -0.1, 0.0]
[[expect]]
at = "analysis"
quantity = "time"
when = { at = "b", quantity = "ux", value = -0.5 }
value = 0.3
tolerance = 0.1
"#;
    let (model, problems) = model::read(&Source::new("path.toml", text, &[]));
    assert!(problems.is_empty(), "{problems:?}");
    let model = model.unwrap();
    // The words of the directions, with their quotes.
    let place = |word: &str| text.find(word).map(|start| [start, start + word.len()]).unwrap();
    let stop = DisplacementTarget { node: 1, dof: 1, value: -0.8, pass: 2, required: true, place: place("\"uy\"") };
    let path = ArcLength {
        first: model.analysis.nominal_step(),
        stop: Some(stop),
        steps: Some(50),
        increment: None,
        growth: 4.0,
    };
    assert_eq!(model.analysis.step_length, StepLength::ArcLength(path));
    let expect = &model.expects[0];
    assert_eq!(expect.at, ExpectAt::Analysis);
    assert_eq!(
        expect.when,
        When::Target(DisplacementTarget {
            node: 1,
            dof: 0,
            value: -0.5,
            pass: 1,
            required: true,
            place: place("\"ux\"")
        })
    );
    assert_eq!(expect.label, "time of analysis where ux of b is -0.5");
    assert!(matches!(everything().analysis.step_length, StepLength::Fixed { .. }));
}

#[test]
fn a_study_knows_its_quantities_and_settings() {
    let model = everything();
    let study = model.study.as_ref().unwrap();
    let quantities: Vec<(String, bool)> = study.quantities.iter().map(|q| (q.word(), q.body)).collect();
    let expected = [("c.uz", false), ("block.body_wx", true), ("top.r11", false)];
    assert_eq!(quantities, expected.map(|(word, body)| (word.to_owned(), body)));
    assert_eq!(study.columns, ["uz_of_c", "block.body_wx", "top.r11"]);
    assert_eq!((study.reference.as_deref(), study.samples), (Some("everything.csv"), Some(300)));
    assert_eq!((study.time_steps.as_slice(), study.halvings), (&[1e-3][..], 2));
    assert_eq!(study.error_tolerances, [1e-2, 1e-3]);
    // The deck's rotation update goes with every scheme that has none of its own.
    let schemes: Vec<(&str, &str)> = study.schemes.iter().map(|s| (s.label.as_str(), s.table.as_str())).collect();
    let rotation = "rotation_update = \"second-order\" }";
    assert_eq!(schemes[0].1, format!("{{ scheme = \"bathe\", {rotation}"));
    assert_eq!(schemes[1].0, "newmark:gamma=0.6:beta=0.31:rotation_update=second-order");
    assert_eq!(schemes[1].1, format!("{{ scheme = \"newmark\", gamma = 0.6, beta = 0.31, {rotation}"));
    assert_eq!(schemes[2].1, format!("{{ scheme = \"wilson-theta\", theta = 1.5, {rotation}"));
    assert_eq!(study.methods, [Method::Auto, Method::InitialLoad]);
    assert_eq!((study.meshes.as_slice(), study.wanted_errors.as_slice()), (&[1.0, 2.0][..], &[1e-2, 1e-3][..]));
    assert_eq!(study.iteration_tolerances.len(), 5);
    assert_eq!((study.iteration_tolerances[0], study.iteration_tolerances[4]), (1e-4, 1e-8));
    assert_eq!(study.beam_orders, [1, 3]);
    assert!(model.output.parts);
}
