//! Sharp ridges and folds of sheet: a point that is behind the plane of one face without having come through it, and one that comes upon a
//! wall already inside.

use super::go;
use rdsolve::solve::{Frame, Outcome};

/// A mesh file of triangles or quadrilaterals that are the group `sheet`, and of groups of points.
fn mesh(nodes: &[[f64; 3]], elements: &[[usize; 4]], points: &[(&str, &[usize])]) -> String {
    let mut text =
        format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n2 1 \"sheet\"\n", 1 + points.len());
    for (k, (name, _)) in points.iter().enumerate() {
        text += &format!("0 {} \"{name}\"\n", k + 2);
    }
    text += &format!("$EndPhysicalNames\n$Nodes\n{}\n", nodes.len());
    for (k, [x, y, z]) in nodes.iter().enumerate() {
        text += &format!("{} {x} {y} {z}\n", k + 1);
    }
    let alone = points.iter().map(|(_, of)| of.len()).sum::<usize>();
    text += &format!("$EndNodes\n$Elements\n{}\n", elements.len() + alone);
    let mut number = 0;
    let mut line = |kind: usize, group: usize, nodes: &[usize]| {
        number += 1;
        let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
        text += &format!("{number} {kind} 2 {group} {group} {}\n", nodes.join(" "));
    };
    elements.iter().for_each(|of| line(3, 1, of));
    for (k, (_, of)) in points.iter().enumerate() {
        of.iter().for_each(|&node| line(15, k + 2, &[node]));
    }
    text + "$EndElements\n"
}

/// Runs a deck with a mesh of its own.
fn go_with(mesh: &str, deck: &str, probe: &mut dyn FnMut(&Frame) -> Vec<f64>) -> crate::support::Done {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sheet.msh");
    std::fs::write(&file, mesh).expect("a file");
    go(&deck.replace("MESH", &file.display().to_string()), probe)
}

/// A ball passes over the ridge of two steep faces, at first beside it on one slope and not yet touching, and bounces off the ridge, whichever
/// face comes first in the mesh: its speed is kept.
#[test]
fn a_ball_bounces_off_a_sharp_ridge() {
    let nodes = [
        [-0.0017431, -0.01, -0.0199239],
        [-0.0017431, 0.01, -0.0199239],
        [0.0, -0.01, 0.0],
        [0.0, 0.01, 0.0],
        [0.0017431, -0.01, -0.0199239],
        [0.0017431, 0.01, -0.0199239],
    ];
    let faces = [[1, 3, 4, 2], [3, 5, 6, 4]];
    let deck = r#"
        analysis = { kind = "dynamic", end_time = 0.02, time_step = 1e-5 }
        integrator = { scheme = "central-difference" }
        output = { contacts = true }
        mesh = { file = "MESH" }
        materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }
        shells = [{ group = "sheet", thickness = 0.002, material = "steel" }]
        supports = [{ at = "sheet", fix = "all" }]
        bodies = [{ name = "ball", center = [-0.00575, 0.0, 0.00996], mass = 0.01, shape = { kind = "sphere", radius = 0.004 } }]
        initial = [{ at = "ball", velocity = [0.746, 0.0, -0.526] }]
        [[contacts]]
        name = "ridge"
        surface = { part = "sheet" }
        with = "ball"
        stiffness = 1e5
        "#;
    let start = 0.5 * 0.01 * (0.746f64.powi(2) + 0.526f64.powi(2));
    for faces in [faces, [faces[1], faces[0]]] {
        let done = go_with(&mesh(&nodes, &faces, &[]), deck, &mut |frame: &Frame| {
            let e = frame.derived.energy.expect("energies");
            vec![e.kinetic, e.contact, frame.state.nodes[frame.model.bodies[0].node].v.z]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let last = done.rows.last().expect("a row");
        let most = done.rows.iter().map(|row| row[1]).fold(0.0, f64::max);
        println!("{last:?}, pressed {most:e}");
        // An impact of thirty steps.
        assert!(
            most > 1e-4 && last[2] > -0.526 + 0.2 && (last[0] / start - 1.0).abs() < 1e-3,
            "{last:?} of {start}, {most}"
        );
        assert!(!done.warnings.iter().any(|warning| warning.contains("the penetration of")), "{:?}", done.warnings);
    }
}

/// A corner of sheet folds upon itself more sharply than its thickness allows: its tip is led down past the fold, a little inside one wall, and
/// then round the corner to the other, as deep as before. What comes upon a wall from inside is not pressed by all of its depth.
#[test]
fn what_goes_round_a_corner_inside_a_fold_is_not_thrown_out() {
    let mut nodes = Vec::new();
    for z in [0.0, 0.0026, 0.0052] {
        nodes.extend([[-0.0025, 0.0, z], [0.0, 0.0, z], [0.0, -0.0025, z]]);
    }
    let faces = [[1, 2, 5, 4], [2, 3, 6, 5], [4, 5, 8, 7], [5, 6, 9, 8]];
    let points: [(&str, &[usize]); 2] = [("tip", &[8]), ("held", &[1, 2, 3, 4, 5, 6])];
    let deck = r#"
        analysis = { kind = "dynamic", end_time = 3e-3, time_step = 1e-6 }
        integrator = { scheme = "central-difference" }
        output = { interval = 2e-5, contacts = true }
        mesh = { file = "MESH" }
        materials.soft = { model = "elastic", youngs_modulus = 1e5, poisson_ratio = 0.3, density = 7850.0 }
        shells = [{ group = "sheet", thickness = 1.6e-3, material = "soft" }]
        [[supports]]
        at = "held"
        fix = "all"
        [[supports]]
        name = "tip"
        at = "tip"
        fix = "rotations"
        motion = { ux = { amplitude = "x", scale = 1e-3 }, uy = { amplitude = "y", scale = 1e-3 }, uz = { amplitude = "z", scale = 1e-3 } }
        [amplitudes]
        x = { kind = "table", points = [[0.0, 0.0], [1e-3, 0.1], [2e-3, 0.1], [2.5e-3, 0.07], [3e-3, -0.05]] }
        y = { kind = "table", points = [[0.0, 0.0], [1e-3, -0.05], [2e-3, -0.05], [2.5e-3, 0.07], [3e-3, 0.1]] }
        z = { kind = "table", points = [[0.0, 0.0], [2e-3, -3.2], [3e-3, -3.2]] }
        [[contacts]]
        name = "folds"
        surface = { part = "sheet" }
        with = "itself"
        stiffness = 1e7
        "#;
    let done = go_with(&mesh(&nodes, &faces, &points), deck, &mut |frame: &Frame| {
        vec![frame.derived.energy.expect("energies").contact]
    });
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    let most = done.rows.iter().map(|row| row[0]).fold(0.0, f64::max);
    println!("pressed {most:e}");
    // It is led a tenth of a millimetre beyond where it slid in: ½ 1e7 0.1e-3², with either wall. A point thrown out from 1.5 mm brings 11 J.
    assert!(most < 0.1, "{most}");
}

/// A ball falls on the line in which a stem of sheet meets a top from below, and slides along it and across it: it bounces with the speed that it
/// had, whatever the sum of the normals there is.
#[test]
fn a_ball_bounces_off_a_line_in_which_three_sheets_meet() {
    let mut nodes = Vec::new();
    for y in [-0.2, 0.2] {
        nodes.extend([[-0.3, y, 0.0], [0.0, y, 0.0], [0.3, y, 0.0], [0.0, y, -0.3]]);
    }
    let stem_first = [[2, 6, 8, 4], [1, 2, 6, 5], [2, 3, 7, 6]];
    let stem_last = [[1, 2, 6, 5], [3, 2, 6, 7], [4, 2, 6, 8]];
    for faces in [stem_first, stem_last] {
        for (x, v) in [(-0.02, [0.2, 0.0]), (1.8e-17, [0.0, 0.5]), (0.05, [-0.5, 0.0])] {
            let deck = format!(
                r#"
                analysis = {{ kind = "dynamic", end_time = 0.16, time_step = 1e-4 }}
                integrator = {{ scheme = "central-difference" }}
                mesh = {{ file = "MESH" }}
                materials.steel = {{ model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }}
                shells = [{{ group = "sheet", thickness = 0.01, material = "steel" }}]
                supports = [{{ at = "sheet", fix = "all" }}]
                bodies = [{{ name = "ball", center = [{x:?}, 0.0, 0.3], mass = 1.0, shape = {{ kind = "sphere", radius = 0.05 }} }}]
                initial = [{{ at = "ball", velocity = [{:?}, {:?}, -2.0] }}]
                [[contacts]]
                name = "top"
                surface = {{ part = "sheet" }}
                with = "ball"
                stiffness = 2e5
                "#,
                v[0], v[1]
            );
            let done = go_with(&mesh(&nodes, &faces, &[]), &deck, &mut |frame: &Frame| {
                vec![frame.state.nodes[frame.model.bodies[0].node].v.z]
            });
            let last = done.rows.last().expect("a row")[0];
            // Seventy steps an impact.
            assert!((last / 2.0 - 1.0).abs() < 2e-3, "{last} from {x}");
            assert!(!done.warnings.iter().any(|warning| warning.contains("the penetration of")), "{:?}", done.warnings);
        }
    }
}

/// A rope draws a point under 1000 N over faces that rise and fall by 0.002 in turn: it pulls with 1000 (μ ± 0.002) N. Without friction the force
/// jumps where the point crosses a fold, and no load step is shortened there.
#[test]
fn a_point_drawn_over_shallow_folds_needs_no_shorter_steps() {
    let height = |k: usize| if k.is_multiple_of(2) { 0.0 } else { -2e-5 };
    let nodes: Vec<[f64; 3]> = (0..9).flat_map(|k| [-0.01, 0.01].map(|y| [0.01 * k as f64, y, height(k)])).collect();
    let faces: Vec<[usize; 4]> = (0..8).map(|k| [2 * k + 1, 2 * k + 3, 2 * k + 4, 2 * k + 2]).collect();
    let deck = r#"
        analysis = { kind = "static", end_time = 2.0, time_step = 0.02 }
        mesh = { file = "MESH" }
        materials.steel = { model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }
        points = { p = [0.0051, 0.0, 0.004985], q = [0.0251, 0.0, 0.004985] }
        shells = [{ group = "sheet", thickness = 0.002, material = "steel" }]
        masses = [{ at = "p", mass = 1.0 }]
        links = [{ name = "rope", from = { node = "p" }, to = { node = "q" }, stiffness = 1e6 }]
        loads = [{ at = "p", force = [0.0, 0.0, -1000.0], amplitude = "press" }]
        [[supports]]
        at = "sheet"
        fix = "all"
        [[supports]]
        at = "p"
        fix = ["uy", "rotations"]
        [[supports]]
        at = "q"
        fix = ["uy", "uz"]
        motion = { ux = { amplitude = "pull", scale = 0.05 } }
        [amplitudes]
        pull = { kind = "ramp", start = 1.0, end = 2.0 }
        press = { kind = "ramp", start = 0.0, end = 1.0 }
        [[contacts]]
        name = "strip"
        surface = { part = "sheet" }
        with = "p"
        radius = 0.004
        stiffness = 1e8
        friction = FRICTION
        "#;
    for friction in [0.0, 0.2] {
        let deck = deck.replace("FRICTION", &format!("{friction:?}"));
        let done = go_with(&mesh(&nodes, &faces, &[]), &deck, &mut |frame: &Frame| {
            let x = |label: &str| {
                let node = frame.model.nodes.iter().position(|node| node.label == label).expect("a point");
                frame.state.nodes[node].x
            };
            vec![frame.state.time, 1e6 * ((x("q") - x("p")).norm() - 0.02)]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        // The point slips from a tenth of the way on; on a slope the force follows (μ ± θ)/(1 ∓ μθ).
        for row in done.rows.iter().filter(|row| row[0] > 1.1) {
            let off = [-2e-3, 2e-3].map(|slope| {
                let force = 1000.0 * (friction + slope) / (1.0 - friction * slope);
                (row[1] - force).abs() / force.abs()
            });
            assert!(off[0].min(off[1]) < 1e-3, "{row:?}");
        }
        if friction == 0.0 {
            assert_eq!(done.rows.iter().filter(|row| row[0] > 1.0 + 1e-9).count(), 50, "no step is shortened");
        }
    }
}

/// A point under 1000 N is led over one fold, up or down, at which the plane of the first face soon lies far from the second one: equilibrium is
/// found, and few steps are shortened.
#[test]
fn a_point_is_led_over_steep_folds() {
    for (slope, stiffness) in [(-0.02, 1e9), (-0.05, 1e8), (-0.13, 1e8), (0.02, 1e8), (0.05, 1e8), (0.13, 1e8)] {
        let nodes: Vec<[f64; 3]> = [[-0.02, 0.0], [0.0063, 0.0], [0.05, 0.0437 * slope]]
            .into_iter()
            .flat_map(|[x, z]| [-0.02, 0.02].map(|y| [x, y, z]))
            .collect();
        let deck = format!(
            r#"
            analysis = {{ kind = "static", end_time = 2.0, time_step = 0.05 }}
            mesh = {{ file = "MESH" }}
            materials.steel = {{ model = "elastic", youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7850.0 }}
            points = {{ p = [0.0051, 0.0, 0.004985] }}
            shells = [{{ group = "sheet", thickness = 0.002, material = "steel" }}]
            masses = [{{ at = "p", mass = 1.0 }}]
            loads = [{{ at = "p", force = [0.0, 0.0, -1000.0], amplitude = "press" }}]
            contacts = [{{ name = "strip", surface = {{ part = "sheet" }}, with = "p", radius = 0.004, stiffness = {stiffness:e} }}]
            [[supports]]
            at = "sheet"
            fix = "all"
            [[supports]]
            at = "p"
            fix = ["uy", "rotations"]
            motion = {{ ux = {{ amplitude = "pull", scale = 0.002 }} }}
            [amplitudes]
            pull = {{ kind = "ramp", start = 1.0, end = 2.0 }}
            press = {{ kind = "ramp", start = 0.0, end = 1.0 }}
            "#
        );
        let faces = [[1, 3, 4, 2], [3, 5, 6, 4]];
        let done = go_with(&mesh(&nodes, &faces, &[]), &deck, &mut |frame: &Frame| vec![frame.state.time]);
        assert!(matches!(done.outcome, Outcome::Done), "{slope}: {:?}", done.outcome);
        // 40 of the deck, and as many shortened ones as fit a fold that jumps.
        assert!(done.rows.len() <= 70, "{slope}: {} steps", done.rows.len());
    }
}
