//! Faces of shells as surfaces: energies and momenta of impacts, sliding without bumps, shells that press each other and themselves.

use super::go;
use crate::support::{read_deck, run};
use rdsolve::solve::{Failure, Frame, Outcome};

/// A free plate of 1 by 1, 20 kg, and a ball of 2 kg that is thrown at it, off the middle.
fn ball_on_plate(scheme: &str, dt: f64, contact: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.03, time_step = {dt} }}
        integrator = {{ {scheme} }}
        output = {{ energy = true }}
        materials.soft = {{ model = "elastic", youngs_modulus = 2e9, poisson_ratio = 0.3, density = 1000.0 }}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }}
        shells = [{{ name = "plate", corners = ["a", "b", "c", "d"], elements = 6, thickness = 0.02, material = "soft" }}]
        bodies = [{{ name = "ball", center = [0.37, 0.41, 0.13], shape = {{ kind = "sphere", radius = 0.1 }}, mass = 2.0, velocity = [0.3, 0.1, -4.0] }}]
        [[contacts]]
        name = "hit"
        surface = {{ part = "plate" }}
        with = "ball"
        {contact}
        "#
    )
}

/// Mechanical energy, what the scheme took, contact energy, lost in friction and impact; momenta of the ball.
fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let ball = frame.model.bodies[0].node;
    vec![
        e.mechanical,
        e.numerical,
        e.contact,
        frame.state.nodes[ball].v.z,
        frame.derived.contacts.first().map_or(0.0, |c| c.f.z),
    ]
}

const SCHEMES: [&str; 4] = [
    r#"scheme = "newmark""#,
    r#"scheme = "generalized-alpha", spectral_radius = 0.9"#,
    r#"scheme = "esdirk3""#,
    r#"scheme = "central-difference""#,
];

/// The energy of an elastic impact, 16 J, comes back: what the scheme gives or takes is less than 1e-3 of it at 120 steps an impact.
#[test]
fn impacts_on_a_free_plate_keep_their_energy() {
    for scheme in SCHEMES {
        let done = go(&ball_on_plate(scheme, 2e-5, "stiffness = 1e6"), &mut watch);
        let pressed = done.rows.iter().map(|row| row[2]).fold(0.0, f64::max);
        let last = done.rows.last().unwrap();
        println!("{scheme}: pressed {pressed:.3} J, numerical {:.2e}, ball leaves at {:.3}", last[1], last[3]);
        assert!(pressed > 1.0 && last[2] == 0.0 && last[3] > 0.0, "{scheme}: no impact: {pressed} {last:?}");
        assert!(last[1].abs() < 1e-3 * 16.1, "{scheme}: {last:?}");
    }
}

/// Friction and restitution take energy, and nothing else does.
#[test]
fn losses_are_told() {
    for scheme in [SCHEMES[0], SCHEMES[3]] {
        let done = go(&ball_on_plate(scheme, 2e-5, "stiffness = 1e6\nfriction = 0.3\nrestitution = 0.5"), &mut watch);
        let last = done.rows.last().unwrap();
        println!("{scheme}: mechanical {:.3}, numerical {:.2e}", last[0], last[1]);
        assert!(last[0] < 15.0 && last[1].abs() < 2e-3 * 16.1, "{scheme}: {last:?}");
    }
}

/// A plate that is held, cut into triangles or quadrilaterals, and something that slides over it.
fn on_held_plate(kind: &str, elements: &str, body: &str, contact: &str, run: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", {run} }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        materials.steel = {{ model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }}
        points = {{ a = [-0.2, -0.3, 0.0], b = [1.3, -0.3, 0.0], c = [1.3, 0.3, 0.0], d = [-0.2, 0.3, 0.0] }}
        shells = [{{ name = "plate", corners = ["a", "b", "c", "d"], kind = "{kind}", elements = {elements}, thickness = 0.02, material = "steel" }}]
        supports = [{{ at = "plate", fix = "all" }}]
        bodies = [{{ name = "body", {body}, mass = 3.0 }}]
        [[contacts]]
        name = "on"
        surface = {{ part = "plate" }}
        with = "body"
        {contact}
        "#
    )
}

fn place(frame: &Frame) -> Vec<f64> {
    let node = &frame.state.nodes[frame.model.bodies[0].node];
    vec![frame.state.time, node.x.x, node.x.z, node.v.x, node.v.z, node.omega.norm()]
}

/// A ball that slides without friction over a hundred triangles of one plane feels none of their edges.
#[test]
fn coplanar_faces_are_one_plane() {
    let ball =
        r#"center = [0.013, 0.017, 0.1099997], shape = { kind = "sphere", radius = 0.1 }, velocity = [2.0, 0.3, 0.0]"#;
    for (kind, elements) in [("triangle", "[25, 9]"), ("quadrilateral", "[25, 9]")] {
        // It rests 30 N/1e8 deep.
        let text = on_held_plate(kind, elements, ball, "stiffness = 1e8", "end_time = 0.5, time_step = 1e-3");
        let done = go(&text, &mut place);
        for row in &done.rows {
            // Rounding of positions, and the tolerance of the iteration.
            assert!((row[3] - 2.0).abs() < 1e-6 && row[4].abs() < 1e-6, "{kind}: {row:?}");
            assert!((row[2] - 0.1099997).abs() < 1e-9, "{kind}: {row:?}");
        }
    }
}

/// A ball that is thrown along the plate slips until it rolls, at 5/7 of its speed, and goes on rolling over all edges.
#[test]
fn a_ball_begins_to_roll_over_faces() {
    let ball =
        r#"center = [0.0, 0.03, 0.109997], shape = { kind = "sphere", radius = 0.1 }, velocity = [1.4, 0.0, 0.0]"#;
    for scheme in ["newmark", "central-difference"] {
        let run = "end_time = 0.6, time_step = 2e-4";
        let text = on_held_plate("triangle", "[25, 9]", ball, "stiffness = 1e7\nfriction = 0.2", run);
        let text = format!("integrator = {{ scheme = \"{scheme}\" }}\n{text}");
        let done = go(&text, &mut place);
        let last = done.rows.last().unwrap();
        println!("{scheme}: {last:?}");
        // v₀ + slip ends after 2 v₀/7 μ g = 0.2 s; then nothing changes but for the swing of the spring, whose part is (μ N/k)/… 1e-3.
        assert!((last[3] - 1.0).abs() < 2e-3 && (last[5] - 10.0).abs() < 2e-2, "{scheme}: {last:?}");
    }
}

/// A fast ball and thin plates: no step takes it through.
#[test]
fn nothing_passes_through() {
    for speed in [5.0, 50.0] {
        let ball = format!(
            r#"center = [0.4, 0.05, 0.3], shape = {{ kind = "sphere", radius = 0.02 }}, velocity = [0.0, 0.0, -{speed:?}]"#
        );
        // Without cuts the steps would be some radii long.
        let run = format!("end_time = {:?}, time_step = {:?}", 1.0 / speed, 0.05 / speed);
        let stiffness = 3.0 * (speed / 0.01) * (speed / 0.01);
        let text = on_held_plate("quadrilateral", "[7, 3]", &ball, &format!("stiffness = {stiffness:?}"), &run);
        let done = go(&text, &mut place);
        let last = done.rows.last().unwrap();
        assert!(last[2] > 0.03 && last[4] > 0.8 * speed, "{speed}: {last:?}");
    }
}

/// Two plates of unlike meshes, the upper pressed on the lower by its weight alone: nodes bear what lies over them.
#[test]
fn shells_bear_each_other() {
    let text = r#"
        analysis = { kind = "static", end_time = 1.0, time_step = 0.5 }
        output = { contacts = true }
        environment = { gravity = [0.0, 0.0, -10.0] }
        materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 8000.0 }
        points = { a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0],
            e = [0.1, 0.1, 0.03], f = [0.9, 0.1, 0.03], g = [0.9, 0.9, 0.03], h = [0.1, 0.9, 0.03] }
        shells = [
            { name = "lower", corners = ["a", "b", "c", "d"], elements = 3, thickness = 0.04, material = "steel" },
            { name = "upper", corners = ["e", "f", "g", "h"], elements = 4, thickness = 0.02, material = "steel" },
        ]
        supports = [{ at = "lower", fix = "all" }, { at = "upper", fix = ["ux", "uy", "rz"] }]
        [[contacts]]
        name = "between"
        surface = { part = "lower" }
        with = "upper"
        stiffness = 1e6
    "#;
    let done = go(text, &mut |frame: &Frame| {
        let contact = &frame.derived.contacts;
        contact.iter().flat_map(|c| [c.touching as f64, c.f.z, c.m.x, c.m.y]).collect()
    });
    let last = done.rows.last().unwrap();
    println!("{last:?}");
    let weight = 8000.0 * 0.02 * 0.64 * 10.0;
    assert_eq!(last[0], 25.0);
    // The tolerance of the iteration; moments of a weight in the middle, at 0.5, about the origin.
    assert!((last[1] / -weight - 1.0).abs() < 1e-6, "{last:?}");
    assert!(
        (last[2] / (-0.5 * weight) - 1.0).abs() < 1e-6 && (last[3] / (0.5 * weight) - 1.0).abs() < 1e-6,
        "{last:?}"
    );
}

/// A mesh of a strip bent to a hairpin with legs 0.2 long and 0.06 apart, of which it is the group `strip`.
fn hairpin() -> String {
    let leg = |i: usize| 0.025 * i as f64;
    let turn = |k: usize| (std::f64::consts::PI * k as f64 / 8.0).sin_cos();
    let upper = (0..9).map(|i| (0.2 - leg(i), 0.03));
    let bend = (1..8).map(|k| (-0.03 * turn(k).0, 0.03 * turn(k).1));
    let line: Vec<(f64, f64)> = upper.chain(bend).chain((0..9).map(|i| (leg(i), -0.03))).collect();
    let mut mesh =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 4 \"strip\"\n$EndPhysicalNames\n".to_owned();
    mesh += &format!("$Nodes\n{}\n", 3 * line.len());
    for (i, (x, z)) in line.iter().enumerate() {
        (0..3).for_each(|j| mesh += &format!("{} {x} {} {z}\n", 3 * i + j + 1, 0.02 * j as f64));
    }
    mesh += &format!("$EndNodes\n$Elements\n{}\n", 2 * (line.len() - 1));
    for e in 0..2 * (line.len() - 1) {
        let a = 3 * (e / 2) + e % 2 + 1;
        mesh += &format!("{} 3 2 4 1 {a} {} {} {}\n", e + 1, a + 3, a + 4, a + 1);
    }
    mesh + "$EndElements\n"
}

/// A hairpin whose legs are thrown at each other: they meet, part, and what was there is there still.
#[test]
fn a_hairpin_touches_itself() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hairpin.msh");
    std::fs::write(&file, hairpin()).unwrap();
    let text = |scheme: &str, dt: f64| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.01, time_step = {dt} }}
            integrator = {{ scheme = "{scheme}" }}
            output = {{ contacts = true }}
            mesh = {{ file = "{}" }}
            materials.soft = {{ model = "elastic", youngs_modulus = 1e7, poisson_ratio = 0.3, density = 1000.0 }}
            shells = [{{ group = "strip", thickness = 0.004, material = "soft" }}]
            amplitudes.inward = {{ kind = "table", points = [[-0.06, 12.0], [0.06, -12.0]] }}
            initial = [{{ at = "strip", velocity = [0.0, 0.0, 1.0], profile = [{{ amplitude = "inward", direction = [0.0, 0.0, 1.0] }}] }}]
            [[contacts]]
            name = "legs"
            surface = {{ part = "strip" }}
            with = "itself"
            stiffness = 2e4
            "#,
            file.display()
        )
    };
    // An impact of two nodes of 2 g lasts 0.7 ms.
    for (scheme, dt) in [("newmark", 3.5e-5), ("central-difference", 5e-6)] {
        let done = go(&text(scheme, dt), &mut |frame: &Frame| {
            let e = frame.derived.energy.expect("energies");
            let momentum = frame.state.nodes.iter().map(|node| node.v.z).sum::<f64>();
            let touching = frame.derived.contacts.first().map_or(0, |contact| contact.touching);
            vec![e.mechanical, e.numerical, e.contact, touching as f64, momentum]
        });
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        let most = |of: usize| done.rows.iter().map(|row| row[of]).fold(0.0, f64::max);
        println!("{scheme}: {:.3} J pressed {:.3} by {}, numerical {:.1e}", first[0], most(2), most(3), last[1]);
        assert!(
            most(2) > 0.3 * first[0] && most(3) > 20.0 && last[2] == 0.0,
            "{scheme}: its legs do not meet and part"
        );
        assert!(last[1].abs() < 0.01 * first[0], "{scheme}: {last:?}");
    }
}

/// A thick strip that a hinge folds upon itself, more sharply than its thickness allows: what lies inside comes to facets that it may touch
/// along the surface, and is not thrown out by energy that nothing has brought; only what goes deeper is pressed.
#[test]
fn what_slides_into_itself_along_a_fold_is_not_thrown_out() {
    let deck = r#"
        analysis = { kind = "dynamic", end_time = 0.02, time_step = "auto" }
        integrator = { scheme = "central-difference" }
        output = { interval = 2e-4, contacts = true }
        materials.soft = { model = "elastic", youngs_modulus = 1e7, poisson_ratio = 0.0, density = 1000.0 }
        points = { a = [0.07, 0.0, 0.0], b = [0.13, 0.0, 0.0], c = [0.13, 0.02, 0.0], d = [0.07, 0.02, 0.0] }
        shells = [{ name = "fold", corners = ["a", "b", "c", "d"], elements = [12, 2], thickness = 0.01, material = "soft" }]
        supports = [{ at = "fold.edge4", fix = "all" }]
        bodies = [{ name = "leg", center = [0.15, 0.01, 0.0], mass = 1.0, inertia = [0.01, 0.01, 0.01] }]
        attachments = [{ body = "leg", nodes = "fold.edge2" }]
        amplitudes.turn = { kind = "table", points = [[0.0, 0.0], [0.04, 6.2]] }
        [[joints]]
        name = "pivot"
        kind = "revolute"
        axis = [0.0, -1.0, 0.0]
        from = { ground = [0.1, 0.01, 0.006] }
        to = { body = "leg" }
        motion = { position = 1.0, amplitude = "turn" }
        [[contacts]]
        name = "itself"
        surface = { part = "fold" }
        with = "itself"
        stiffness = 1e5
        "#;
    let done = go(deck, &mut |frame: &Frame| {
        let e = frame.derived.energy.expect("energies");
        let touching = frame.derived.contacts.first().map_or(0, |contact| contact.touching);
        vec![e.numerical, e.contact, e.external, touching as f64]
    });
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    let most = |of: usize| done.rows.iter().map(|row| row[of]).fold(0.0, f64::max);
    let least = done.rows.iter().map(|row| row[0]).fold(0.0, f64::min);
    println!("pressed {:.2e} by {}, numerical {least:.1e} to {:.1e} of {:.2}", most(1), most(3), most(0), most(2));
    assert!(most(3) > 2.0 && most(1) > 0.0, "the fold does not touch itself");
    // Thrown out by half of its thickness a single node would bring ½ 1e5 0.005² = 1.25 J; points that leave what they have slid into
    // take some of the work along.
    assert!(least > -1e-2 * most(2) && most(0) < 0.05 * most(2), "{least} and {} of {}", most(0), most(2));
}

/// A ball on the middle of a sheet that is stretched either way alike stays there: friction holds it to the material under it, not to a corner
/// of the face.
#[test]
fn friction_goes_along_with_a_sheet_that_stretches() {
    let deck = r#"
        analysis = { kind = "dynamic", end_time = 0.5, time_step = 2e-3 }
        integrator = { scheme = "generalized-alpha" }
        environment = { gravity = [0.0, 0.0, -9.81] }
        output = { interval = 0.1 }
        materials.rubber = { model = "elastic", youngs_modulus = 1e7, poisson_ratio = 0.3, density = 1000.0 }
        points = { a = [-0.15, -0.15, 0.0], b = [0.15, -0.15, 0.0], c = [0.15, 0.15, 0.0], d = [-0.15, 0.15, 0.0] }
        shells = [{ name = "sheet", corners = ["a", "b", "c", "d"], elements = 3, thickness = 0.02, material = "rubber" }]
        bodies = [{ name = "ball", center = [0.0, 0.0, 0.029999], shape = { kind = "sphere", radius = 0.02 }, mass = 1.0 }]
        amplitudes.pull = { kind = "ramp", start = 0.1, end = 0.4 }
        supports = [
            { at = "sheet", fix = ["uz", "rx", "ry", "rz"] },
            { at = "sheet.edge2", fix = "uy", motion = { ux = { amplitude = "pull", scale = 0.03 } } },
            { at = "sheet.edge4", fix = "uy", motion = { ux = { amplitude = "pull", scale = -0.03 } } },
            { at = "ball", fix = "rotations" },
        ]
        [[contacts]]
        name = "under"
        surface = { part = "sheet" }
        with = "ball"
        stiffness = 1e6
        friction = 0.5
        damping = 500.0
        "#;
    let done = go(deck, &mut |frame: &Frame| {
        let ball = frame.model.bodies[0].node;
        let x = frame.state.nodes[ball].x;
        vec![x.x, x.y]
    });
    // By symmetry it does not move; what the iteration leaves of friction, 1e-8 of 5 N, moves it by nanometres.
    for row in &done.rows {
        assert!(row[0].abs() < 1e-7 && row[1].abs() < 1e-7, "{row:?}");
    }
}

/// A ball that a step would carry through a sheet, and one that a soft contact lets through, do not get there without a word.
#[test]
fn nothing_passes_a_face_in_one_step() {
    let deck = |scheme: &str, dt: f64, speed: f64, stiffness: f64| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.01, time_step = {dt} }}
            integrator = {{ scheme = "{scheme}" }}
            materials.steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7850.0 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [0.4, 0.0, 0.0], c = [0.4, 0.4, 0.0], d = [0.0, 0.4, 0.0] }}
            shells = [{{ name = "plate", corners = ["a", "b", "c", "d"], elements = 2, thickness = 0.002, material = "steel" }}]
            bodies = [{{ name = "ball", center = [0.13, 0.17, 0.04], shape = {{ kind = "sphere", radius = 0.01 }}, mass = 0.01, velocity = [0.0, 0.0, -{speed}] }}]
            supports = [{{ at = "plate", fix = "all" }}]
            [[contacts]]
            name = "hit"
            surface = {{ part = "plate" }}
            with = "ball"
            stiffness = {stiffness}
            "#
        )
    };
    for scheme in ["newmark", "bathe", "wilson-theta", "generalized-alpha"] {
        for (dt, speed) in [(1e-3, 40.0), (1e-3, 80.0), (5e-4, 150.0)] {
            let done = run(&read_deck(&deck(scheme, dt, speed, 1e9)), &mut |frame: &Frame| {
                let ball = &frame.state.nodes[frame.model.bodies[0].node];
                vec![ball.x.z, ball.v.z]
            });
            // Wilson's method with the longest step throws the ball back with fourteen times its energy, which is refused at the end.
            let is_whole =
                matches!(done.outcome, Outcome::Done | Outcome::Failed { failure: Failure::EnergyGrowth { .. }, .. });
            assert!(is_whole, "{scheme} {dt} {speed}: {:?} {:?}", done.outcome, done.warnings);
            let last = done.rows.last().expect("rows");
            assert!(last[0] > 0.0 && last[1] > 0.0, "{scheme} {dt} {speed}: {last:?}");
        }
        // 16 J of speed, and 3 J at most that a spring of this stiffness can hold: it ends, or a scheme that takes the rest says how deep it was.
        let (outcome, said) = crate::support::run_with_warnings(&deck(scheme, 1e-3, 57.0, 5e4));
        match outcome {
            Outcome::Failed { failure: Failure::ContactNotResolved { name }, .. } => assert_eq!(name, "hit"),
            Outcome::Done => {
                assert!(said.iter().any(|text| text.contains("the penetration of")), "{scheme}: {said:?}")
            }
            _ => panic!("{scheme}: {outcome:?}"),
        }
    }
}
