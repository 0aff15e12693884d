//! Rotations that supports give about several axes: they are the components of one rotation vector or the angles of a sequence, whatever
//! the scheme and the number of steps, beside a free rotation too.

use crate::support::{read_deck, run, run_source, run_to_the_end};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model};
use rdsolve::solve::{Failure, Frame, Outcome};

type Vec3 = Vector3<f64>;

const SCHEMES: [&str; 8] = [
    "newmark",
    "hht-alpha",
    "generalized-alpha",
    "bathe",
    "wilson-theta",
    "esdirk3",
    "runge-kutta",
    "central-difference",
];

/// The six sequences, by their words and the axes that they name.
const SEQUENCES: [(&str, [usize; 3]); 6] = [
    ("xyz", [0, 1, 2]),
    ("xzy", [0, 2, 1]),
    ("yxz", [1, 0, 2]),
    ("yzx", [1, 2, 0]),
    ("zxy", [2, 0, 1]),
    ("zyx", [2, 1, 0]),
];

fn analysis(scheme: &str, time_step: f64, end_time: f64) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time:?}\ntime_step = {time_step:?}\n[iteration]\ntolerance = 1e-12\n\
         [integrator]\nscheme = \"{scheme}\"\n"
    )
}

/// A body with three different moments of inertia, and the support that holds its centre.
fn body(support: &str) -> String {
    format!(
        "[[bodies]]\nname = \"ship\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n[[supports]]\nat = \"ship\"\n{support}\n"
    )
}

/// The rotation of the node of the first body, and its angular velocity, at every output time.
fn rotations(model: &Model) -> Vec<(f64, UnitQuaternion<f64>, Vec3)> {
    let node = model.bodies[0].node;
    let rows = run_to_the_end(model, &mut |frame: &Frame| {
        let (q, omega) = (frame.state.nodes[node].rotation, frame.state.nodes[node].omega);
        vec![frame.state.time, q.w, q.i, q.j, q.k, omega.x, omega.y, omega.z]
    })
    .rows;
    let of = |row: &Vec<f64>| {
        let q = nalgebra::Quaternion::new(row[1], row[2], row[3], row[4]);
        (row[0], UnitQuaternion::new_unchecked(q), Vec3::new(row[5], row[6], row[7]))
    };
    rows.iter().map(of).collect()
}

fn last(model: &Model) -> UnitQuaternion<f64> {
    rotations(model).last().expect("a row").1
}

/// The product of rotations about global axes.
fn sequence(axes: [usize; 3], angles: &Vec3) -> UnitQuaternion<f64> {
    let one = |axis: usize| Rotation3::new(Vec3::ith(axis, angles[axis]));
    UnitQuaternion::from_rotation_matrix(&(one(axes[0]) * one(axes[1]) * one(axes[2])))
}

const RAMP: &str = "[amplitudes.r]\nkind = \"ramp\"\nend = 1.0\n";

#[test]
fn rotations_given_in_statics_are_one_vector_with_any_number_of_steps() {
    let given = Vec3::new(1.5, 0.0, 1.0);
    for steps in [1, 7, 50] {
        for (rotation, exact) in [
            ("", UnitQuaternion::new(given)),
            ("rotation = \"vector\"\n", UnitQuaternion::new(given)),
            ("rotation = \"xyz\"\n", sequence([0, 1, 2], &given)),
            ("rotation = \"zyx\"\n", sequence([2, 1, 0], &given)),
        ] {
            let text = format!(
                "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = {:?}\n{RAMP}",
                1.0 / f64::from(steps)
            ) + &body(&format!(
                "fix = [\"ux\", \"uy\", \"uz\", \"ry\"]\n{rotation}motion = {{ rx = {{ amplitude = \"r\", scale = 1.5 }}, \
                 rz = {{ amplitude = \"r\", scale = 1.0 }} }}"
            ));
            let turned = last(&read_deck(&text));
            // Rounding of the steps.
            assert!(turned.angle_to(&exact) < 1e-12, "{steps} {rotation}: {turned} for {exact}");
        }
    }
}

/// The same on a point of a body, which holds the body there, and on the end of a beam, which bends back to nothing.
#[test]
fn attached_points_and_ends_of_beams_turn_alike() {
    let support = "fix = [\"ux\", \"uy\", \"uz\", \"ry\"]\nmotion = { rx = { amplitude = \"r\", scale = 1.5 }, \
                   rz = { amplitude = \"r\", scale = 1.0 } }\n";
    let opening = format!("[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n{RAMP}");
    let attached = format!(
        "{opening}[points]\nbow = [2.0, 0.0, 0.0]\n[[attachments]]\nbody = \"ship\"\nnodes = \"bow\"\n[[bodies]]\nname = \"ship\"\n\
         center = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n[[supports]]\nat = \"bow\"\n{support}"
    );
    let beam = format!(
        "{opening}[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 1e9\n\
         poisson_ratio = 0.3\ndensity = 1.0\n[sections.s]\nshape = \"rectangle\"\nwidth = 0.1\nheight = 0.1\n[[beams]]\nname = \"bar\"\n\
         path = [\"a\", \"b\"]\nelements = 2\nmaterial = \"m\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n\
         [[supports]]\nat = \"a\"\n{support}"
    );
    let exact = UnitQuaternion::new(Vec3::new(1.5, 0.0, 1.0));
    for (text, arm) in [(attached, Vec3::new(-2.0, 0.0, 0.0)), (beam, Vec3::new(1.0, 0.0, 0.0))] {
        let model = read_deck(&text);
        let label = if arm.x < 0.0 { "ship" } else { "b" };
        let held = if arm.x < 0.0 { Vec3::new(2.0, 0.0, 0.0) } else { Vec3::zeros() };
        let node = model.nodes.iter().position(|node| node.label == label).expect("the node");
        let rows = run_to_the_end(&model, &mut |frame: &Frame| frame.state.nodes[node].x.as_slice().to_vec()).rows;
        let x = Vec3::from_column_slice(rows.last().expect("a row"));
        // The tolerance of the iteration is 1e-8 of forces that the bent beam has on the way.
        assert!((x - held - exact * arm).norm() < 1e-7, "{label}: {x}");
    }
}

/// Ten periods of roll and pitch with yaw held: at every time the rotation vector is what the deck gives, and its angular velocity that of
/// differences. The moments of the support change the angular momentum, and their work is the energy.
#[test]
fn a_ship_rolls_and_pitches_without_yaw() {
    let exact = |t: f64| Vec3::new(0.2 * t.sin(), 0.4 * (0.5 * t).sin().powi(2), 0.0);
    let text = "fix = [\"ux\", \"uy\", \"uz\", \"rz\"]\n\
                motion = { rx = { amplitude = \"roll\", scale = 0.2 }, ry = { amplitude = \"pitch\", scale = 0.4 } }\n\
                [amplitudes.roll]\nkind = \"sine\"\nangular_frequency = 1.0\n\
                [amplitudes.pitch]\nkind = \"sine-squared\"\nangular_frequency = 0.5\n[output]\nreactions = true\n";
    for scheme in SCHEMES {
        let model = read_deck(&(analysis(scheme, 0.25, 20.0 * std::f64::consts::PI) + &body(text)));
        for (t, turned, omega) in rotations(&model) {
            let given = UnitQuaternion::new(exact(t));
            // Rounding of 252 steps.
            assert!(turned.angle_to(&given) < 1e-12, "{scheme} {t}: {turned} for {given}");
            let h = 1e-4; // h² is 1e-8
            let [a, b] = [-h, h].map(|h| UnitQuaternion::new(exact(t + h)));
            let spin = (b * a.inverse()).scaled_axis() / (2.0 * h);
            assert!((omega - spin).norm() < 1e-7, "{scheme} {t}: {omega} for {spin}");
        }
        let rows = run_to_the_end(&model, &mut |frame: &Frame| {
            let energy = frame.derived.energy.expect("energies");
            let moments = model.constraints.restraints.iter().zip(frame.reactions).filter(|(held, _)| held.dof > 2);
            let moments: Vec<f64> = moments.map(|(_, moment)| *moment).collect();
            [&[frame.state.time, energy.numerical], energy.l.as_slice(), &moments].concat()
        })
        .rows;
        for three in rows.windows(3) {
            let change = |i: usize| (three[2][2 + i] - three[0][2 + i]) / (three[2][0] - three[0][0]);
            let miss = (0..3).map(|i| (three[1][5 + i] - change(i)).abs()).fold(0.0, f64::max);
            // The differences of second order miss h²/6 of a second derivative near 1, h = 0.25; Wilson-theta carries its moments over steps.
            assert!(miss < 0.04, "{scheme} {}: {miss} of {three:?}", three[1][0]);
        }
        let lost = rows.iter().fold(0.0f64, |most, row| most.max(row[1].abs()));
        // The work of the support by the mean of its moments at the ends of steps is of second order: (0.25)²/12 of 0.1.
        assert!(lost < 2e-3, "{scheme}: {lost}");
    }
}

/// A rigid plate that is clamped at a corner under an even load, whose forces at arms about the centre cancel; its support turns or does not. The
/// support carries the load and its moment.
#[test]
fn a_clamped_rigid_plate_carries_an_even_load() {
    let turns = [
        ("fix = \"all\"", Vec3::zeros()),
        (
            "fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\nmotion = { rz = { amplitude = \"r\", scale = 1.0 } }",
            Vec3::new(0.0, 0.0, 1.0),
        ),
        (
            "fix = \"translations\"\nmotion = { rx = { amplitude = \"r\", scale = 1.2 }, ry = { amplitude = \"r\", scale = 0.3 }, \
             rz = { amplitude = \"r\", scale = -0.5 } }",
            Vec3::new(1.2, 0.3, -0.5),
        ),
    ];
    let loads = [
        Vec3::new(50.0, 70.0, 0.0),
        Vec3::new(0.0, -50.0, 0.0),
        Vec3::new(0.0, 0.0, -100.0),
        Vec3::new(1e-3, 2e-3, 3e-3),
    ];
    for ((support, turn), load) in turns.iter().flat_map(|turn| loads.iter().map(move |load| (turn, load))) {
        let text = format!(
            "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.5\n{RAMP}[points]\np1 = [0.0, 0.0, 0.0]\np2 = [1.0, 0.0, 0.0]\n\
             p3 = [1.0, 1.0, 0.0]\np4 = [0.0, 1.0, 0.0]\n[materials.m]\nmodel = \"elastic\"\nyoungs_modulus = 1e9\npoisson_ratio = 0.3\n\
             density = 1.0\n[[shells]]\nname = \"plate\"\ncorners = [\"p1\", \"p2\", \"p3\", \"p4\"]\nelements = [2, 2]\nthickness = 0.01\n\
             material = \"m\"\nrigid = true\n[[supports]]\nat = \"p1\"\n{support}\n[[loads]]\npart = \"plate\"\nforce_per_area = {:?}\n\
             [output]\nreactions = true\n",
            load.as_slice()
        );
        let model = read_deck(&text);
        let rows = run_to_the_end(&model, &mut |frame: &Frame| frame.reactions.to_vec()).rows;
        let arm = UnitQuaternion::new(*turn) * Vec3::new(0.5, 0.5, 0.0);
        let exact = [-load, load.cross(&arm)];
        let exact: Vec<f64> = exact.iter().flat_map(|of| of.iter().copied()).collect();
        let last = rows.last().expect("a row");
        let off = last.iter().zip(&exact).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        // The tolerance of the iteration is 1e-8 of the forces.
        assert!(last.len() == 6 && off < 1e-6 * load.norm(), "{support} {load}: {last:?} for {exact:?}");
    }
}

/// All three angles move, by displacements or by velocities; a full turn and more is no limit.
#[test]
fn sequences_are_products_of_rotations() {
    let given = Vec3::new(0.8, -1.1, 7.5);
    for (word, axes) in SEQUENCES {
        for history in ["displacement", "velocity"] {
            let (kind, factor) = match history {
                "velocity" => ("kind = \"table\"\npoints = [[0.0, 1.0], [1.0, 1.0]]", 1.0),
                _ => ("kind = \"ramp\"\nend = 1.0", 1.0),
            };
            let [x, y, z] = [given.x, given.y, given.z]
                .map(|scale| format!("{{ amplitude = \"r\", scale = {:?}, history = \"{history}\" }}", factor * scale));
            let text = analysis("newmark", 0.125, 1.0)
                + &body(&format!(
                    "fix = \"translations\"\nrotation = \"{word}\"\nmotion = {{ rx = {x}, ry = {y}, rz = {z} }}\n[amplitudes.r]\n{kind}"
                ));
            let (turned, exact) = (last(&read_deck(&text)), sequence(axes, &given));
            assert!(turned.angle_to(&exact) < 1e-12, "{word} {history}: {turned} for {exact}"); // rounding
        }
    }
}

/// Roll driven, pitch held, yaw free under a moment: the components are kept, the energy too, and all schemes lead to one motion.
#[test]
fn beside_a_free_rotation_the_others_are_kept() {
    let text = |scheme: &str, rotation: &str| {
        analysis(scheme, 5e-3, 1.0)
            + &body(&format!(
                "fix = [\"ux\", \"uy\", \"uz\", \"ry\"]\n{rotation}motion = {{ rx = {{ amplitude = \"r\", scale = 0.5 }} }}\n\
                 [amplitudes.r]\nkind = \"sine\"\nangular_frequency = 2.0\n[[loads]]\nat = \"ship\"\nmoment = [0.1, 0.2, 0.5]\n"
            ))
    };
    for rotation in ["", "rotation = \"zyx\"\n", "rotation = \"xyz\"\n", "rotation = \"yzx\"\n"] {
        let reference = last(&read_deck(&text("runge-kutta", rotation)));
        for scheme in SCHEMES {
            let model = read_deck(&text(scheme, rotation));
            for (t, turned, _) in rotations(&model) {
                let roll = 0.5 * (2.0 * t).sin();
                let [x, y] = match rotation {
                    "" => [turned.scaled_axis().x, turned.scaled_axis().y],
                    _ if rotation.contains("zyx") => {
                        let (x, y, _) = turned.euler_angles();
                        [x, y]
                    }
                    _ => continue,
                };
                // Constraints are held to rounding.
                assert!((x - roll).abs() < 1e-11 && y.abs() < 1e-11, "{scheme} {rotation}{t}: {x} {y}");
            }
            let end = last(&model);
            let lost =
                run_to_the_end(&model, &mut |frame: &Frame| vec![frame.derived.energy.expect("energies").numerical]);
            let lost = lost.rows.iter().fold(0.0f64, |most, row| most.max(row[0].abs()));
            println!("{scheme} {rotation}: {:e}, energy {lost:e}", end.angle_to(&reference));
            // (2 Δt)² is 1e-4; schemes of second order leave a twelfth of that, Wilson-theta four times as much.
            assert!(end.angle_to(&reference) < 5e-5, "{scheme} {rotation}");
            assert!(lost < 1e-4, "{scheme} {rotation}: {lost}");
        }
    }
}

/// A universal joint holds the same: the arm on the ground is the first axis of the sequence, that on the body the last one.
#[test]
fn a_held_middle_angle_is_a_universal_joint() {
    let load = "[[loads]]\nat = \"ship\"\nmoment = [0.7, 0.3, 1.5]\n";
    let joint = "[[joints]]\nname = \"cross\"\nkind = \"universal\"\naxis = [0.0, 0.0, 1.0]\ncross_axis = [1.0, 0.0, 0.0]\n\
                 from = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"ship\" }\n";
    let opening = analysis("runge-kutta", 5e-3, 2.0);
    let by_joint = opening.clone()
        + "[[bodies]]\nname = \"ship\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 2.0, 2.5]\n"
        + joint
        + load;
    let by_support = opening + &body("fix = [\"ux\", \"uy\", \"uz\", \"ry\"]\nrotation = \"zyx\"") + load;
    let [one, other] = [by_joint, by_support].map(|text| rotations(&read_deck(&text)));
    assert_eq!(one.len(), other.len());
    for ((t, a, _), (_, b, _)) in one.iter().zip(&other) {
        // The scheme is of fourth order: 5e-3⁴ is 6e-10, and both are held to rounding.
        assert!(a.angle_to(b) < 1e-8, "{t}: {a} {b}");
    }
    assert!(one.last().expect("a row").1.angle() > 0.5);
}

/// With the key a single fixed rotation is a component of the rotation vector; beside it the body turns about both other axes.
#[test]
fn a_fixed_component_stays_while_the_others_turn() {
    let text = analysis("esdirk3", 0.02, 3.0)
        + &body("fix = [\"ux\", \"uy\", \"uz\", \"rz\"]\nrotation = \"vector\"\n")
        + "[[loads]]\nat = \"ship\"\nmoment = [0.5, 0.0, 0.0]\namplitude = \"a\"\n[[loads]]\nat = \"ship\"\nmoment = [0.0, 1.0, 0.0]\n\
           amplitude = \"b\"\n[amplitudes.a]\nkind = \"sine\"\nangular_frequency = 2.0\n[amplitudes.b]\nkind = \"sine-squared\"\n\
           angular_frequency = 2.0\n";
    let mut area = 0.0f64;
    for (t, turned, _) in rotations(&read_deck(&text)) {
        let phi = turned.scaled_axis();
        assert!(phi.z.abs() < 1e-11, "{t}: {phi}"); // constraints are held to rounding
        area = area.max(phi.x.abs().min(phi.y.abs()));
    }
    assert!(area > 0.1, "{area}");
}

/// Without the key a single fixed rotation drifts by half the area that the others enclose, and the run says so.
#[test]
fn a_rotation_fixed_alone_that_drifts_is_told() {
    let text = |rotation: &str| {
        analysis("newmark", 0.02, 3.0)
            + &body(&format!("fix = [\"ux\", \"uy\", \"uz\", \"rz\"]\n{rotation}"))
            + "[[initial]]\nat = \"ship\"\nangular_velocity = [0.5, 0.0, 0.0]\n[[loads]]\nat = \"ship\"\nmoment = [0.0, 1.0, 0.0]\n\
               amplitude = \"b\"\n[amplitudes.b]\nkind = \"sine-squared\"\nangular_frequency = 1.0\n"
    };
    let warnings_of = |rotation: &str| run(&read_deck(&text(rotation)), &mut |_: &Frame| Vec::new()).warnings;
    let told = warnings_of("");
    assert!(told.iter().any(|warning| warning.contains("rz of `ship` is fixed alone and has drifted")), "{told:?}");
    let silent = warnings_of("rotation = \"vector\"");
    assert!(silent.iter().all(|warning| !warning.contains("drifted")), "{silent:?}");
}

/// Two rotations that are held leave a free turn about the third axis, and one that is driven alone goes through full turns.
#[test]
fn turns_about_one_axis_have_no_limit() {
    let free = "fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\n[[initial]]\nat = \"ship\"\nangular_velocity = [0.0, 0.0, 9.0]\n";
    let driven = "fix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\nmotion = { rz = { amplitude = \"r\", scale = 9.0 } }\n\
                  [amplitudes.r]\nkind = \"ramp\"\nend = 1.0\n";
    let alone = "fix = \"translations\"\nmotion = { rz = { amplitude = \"r\", scale = 9.0 } }\n[amplitudes.r]\nkind = \"ramp\"\nend = 1.0\n";
    for support in [free, driven, alone] {
        let turned = last(&read_deck(&(analysis("newmark", 0.02, 1.0) + &body(support))));
        let exact = UnitQuaternion::new(Vec3::new(0.0, 0.0, 9.0));
        assert!(turned.angle_to(&exact) < 1e-10, "{support}: {turned}"); // the tolerance of the iteration is 1e-12
    }
}

/// A static stage turns the body, a dynamic one takes it on and back.
#[test]
fn rotations_go_on_over_stages() {
    let text = "[[stages]]\nname = \"lean\"\nkind = \"static\"\nduration = 1.0\ntime_step = 0.25\n\
                [[stages]]\nname = \"rock\"\nkind = \"dynamic\"\nduration = 2.0\ntime_step = 0.05\n"
        .to_owned()
        + &body(
            "fix = [\"ux\", \"uy\", \"uz\", \"rz\"]\n\
             motion = { rx = { amplitude = \"r\", scale = 1.2 }, ry = { amplitude = \"p\", scale = 0.9 } }\n\
             [amplitudes.r]\nkind = \"table\"\npoints = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.5], [3.0, 0.0]]\n\
             [amplitudes.p]\nkind = \"table\"\npoints = [[0.0, 0.0], [0.5, 1.0], [1.0, 1.0], [2.0, 0.0], [3.0, 0.5]]\n",
        );
    let source = Source::new("deck.toml", &text, &[]);
    let mut rows = Vec::new();
    run_source(&source, &mut |frame: &Frame| {
        let node = &frame.state.nodes[frame.model.bodies[0].node];
        let q = node.rotation;
        rows.push((frame.state.time, UnitQuaternion::new_unchecked(q)));
        Vec::new()
    });
    for (time, exact) in
        [(1.0, Vec3::new(1.2, 0.9, 0.0)), (2.0, Vec3::new(0.6, 0.0, 0.0)), (3.0, Vec3::new(0.0, 0.45, 0.0))]
    {
        let (_, turned) = rows.iter().rfind(|(t, _)| (t - time).abs() < 1e-9).expect("a row");
        assert!(turned.angle_to(&UnitQuaternion::new(exact)) < 1e-11, "{time}: {turned}"); // rounding of the steps
    }
}

/// Beside a free rotation a rotation vector ends near half a turn: the run says so, and a sequence goes on.
#[test]
fn a_rotation_vector_beside_a_free_rotation_ends_at_half_a_turn() {
    let text = |rotation: &str| {
        analysis("newmark", 0.01, 2.0)
            + &body(&format!(
                "fix = [\"ux\", \"uy\", \"uz\", \"ry\"]\n{rotation}motion = {{ rx = {{ amplitude = \"r\", scale = 0.5 }} }}\n\
                 [amplitudes.r]\nkind = \"sine\"\nangular_frequency = 2.0\n[[loads]]\nat = \"ship\"\nmoment = [0.0, 0.0, 9.0]\n"
            ))
    };
    let done = run(&read_deck(&text("")), &mut |_: &Frame| Vec::new());
    let Outcome::Failed { failure, .. } = done.outcome else { panic!("{:?}", done.outcome) };
    assert!(matches!(&failure, Failure::GivenRotationLost { label } if label == "ship"), "{failure:?}");
    let end = last(&read_deck(&text("rotation = \"zyx\"\n")));
    let (roll, pitch, _) = end.euler_angles();
    assert!((roll - 0.5 * 4.0f64.sin()).abs() < 1e-11 && pitch.abs() < 1e-11, "{roll} {pitch}"); // held to rounding
}

#[test]
fn bad_rotations_are_told() {
    let said = |support: &str| {
        let text = analysis("newmark", 0.01, 1.0) + &body(support);
        let source = Source::new("deck.toml", &text, &[]);
        model::read(&source).1.iter().map(|problem| problem.draw(&source, false)).collect::<Vec<_>>().join("\n")
    };
    let motion = "motion = { rx = { amplitude = \"r\" } }";
    let cosine = "[amplitudes.r]\nkind = \"sine\"\nangular_frequency = 2.0\nphase = 1.5\n";
    let all = [
        said("fix = \"translations\"\nrotation = \"xyz\""),
        said("fix = \"all\"\nrotation = \"zxz\""),
        said(&format!(
            "fix = [\"rz\"]\nrotation = \"xyz\"\n[[supports]]\nat = \"ship\"\nrotation = \"zyx\"\n{motion}\n{cosine}"
        )),
        said(&format!("fix = [\"ux\", \"rz\"]\n{motion}\n{cosine}")),
    ];
    insta::assert_snapshot!("rotations_bad", all.join("\n\n"));
}

/// A support that leans by a = 1.2 rad about x and shakes about y turns what it carries by T(u) e_y: by sin a / a and (1 − cos a) / a of the amplitude
/// about y and z. The second body follows by a bushing far stiffer than its inertia.
#[test]
fn a_support_that_leans_shakes_by_the_spin_of_its_rotation() {
    let mut text =
        "[analysis]\nkind = \"frequency-response\"\nfrequencies = { from = 0.001, to = 0.01, steps = 2 }\n".to_owned();
    for name in ["b", "c"] {
        text += &format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n"
        );
    }
    text += "[[links]]\nname = \"k\"\nfrom = { body = \"b\" }\nto = { body = \"c\" }\nbushing = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n\
             [[supports]]\nat = \"b\"\nfix = [\"ux\", \"uy\", \"uz\", \"rz\"]\n\
             motion = { rx = { amplitude = \"lean\", scale = 1.2 }, ry = { amplitude = \"shake\", scale = 0.01 } }\n\
             [amplitudes.lean]\nkind = \"step\"\nstart = -1.0\n[amplitudes.shake]\nkind = \"harmonic\"\n";
    let a = 1.2f64;
    for (quantity, value) in [("ry", 0.01 * a.sin() / a), ("rz", 0.01 * (1.0 - a.cos()) / a)] {
        text += &format!(
            "[[expect]]\nat = \"c\"\nquantity = \"{quantity}\"\nfrequency = 0.001\nvalue = {value:?}\ntolerance = 1e-6\nsource = \"T(u) e_y\"\n"
        );
    }
    // ω² over the stiffness is 4e-11.
    let done = run_to_the_end(&read_deck(&text), &mut |_: &Frame| Vec::new());
    assert!(
        done.verdicts.len() == 2 && done.verdicts.iter().all(|verdict| verdict.passed),
        "rotations of the second body"
    );
}
