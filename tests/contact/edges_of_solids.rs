//! Edges of boxes and hulls that cross beams and free edges of shells between corners and nodes; and bodies made of shells on edges.

use super::{go, watch};
use rdsolve::solve::{Frame, Outcome};
use std::f64::consts::PI;

const SCHEMES: [&str; 3] = [
    r#"scheme = "newmark""#,
    r#"scheme = "generalized-alpha", spectral_radius = 0.9"#,
    r#"scheme = "central-difference""#,
];

const STEEL: &str = "output = { energy = true, contacts = true, every = 1 }\n\
                     materials.steel = { model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }\n\
                     sections.round = { shape = \"tube\", radius = 0.02, thickness = 0.02 }\n";

fn motion(scheme: &str, end: f64, dt: f64) -> String {
    format!(
        "analysis = {{ kind = \"dynamic\", end_time = {end:?}, time_step = {dt:?} }}\nintegrator = {{ {scheme} }}\n{STEEL}"
    )
}

/// A block of 0.3 by 0.2 by 0.1 whose lower face is at `z`, as a box or as the hull of its corners.
fn block(kind: &str, [x, y, z]: [f64; 3], more: &str) -> String {
    let shape = match kind {
        "box" => "kind = \"box\", size = [0.3, 0.2, 0.1]".to_owned(),
        _ => {
            let corner = |k: usize| {
                let side = |bit: usize, half: f64| if k & bit > 0 { half } else { -half };
                format!("[{:?}, {:?}, {:?}]", x + side(1, 0.15), y + side(2, 0.1), z + 0.05 + side(4, 0.05))
            };
            format!("kind = \"hull\", points = [{}]", (0..8).map(corner).collect::<Vec<_>>().join(", "))
        }
    };
    let center = if kind == "box" { format!("center = [{x:?}, {y:?}, {:?}]\n", z + 0.05) } else { String::new() };
    format!("[[bodies]]\nname = \"block\"\n{center}mass = 8.0\nshape = {{ {shape} }}\n{more}")
}

/// Rods of radius 0.02 and one element along x, at these y and z = 0, from −0.5 to 0.5; or sheets below them, whose edges lie there. Rigid.
fn rods(what: &str, at: &[f64], contact: &str) -> String {
    let mut text = "[points]\n".to_owned();
    for (k, y) in at.iter().enumerate() {
        text += &format!("a{k} = [-0.5, {y:?}, 0.0]\nb{k} = [0.5, {y:?}, 0.0]\n");
        text += &format!("c{k} = [0.5, {y:?}, -0.5]\nd{k} = [-0.5, {y:?}, -0.5]\n");
    }
    for k in 0..at.len() {
        let (part, edges) = match what {
            "beam" => (
                format!(
                    "[[beams]]\npath = [\"a{k}\", \"b{k}\"]\nelements = 1\nsection = \"round\"\norientation = [0.0, 0.0, 1.0]"
                ),
                "",
            ),
            _ => (
                format!(
                    "[[shells]]\ncorners = [\"a{k}\", \"b{k}\", \"c{k}\", \"d{k}\"]\nelements = [1, 1]\nthickness = 0.04"
                ),
                ", edges = true",
            ),
        };
        text += &format!(
            "{part}\nname = \"rod{k}\"\nmaterial = \"steel\"\nrigid = true\n\
             [[contacts]]\nname = \"on{k}\"\nsurface = {{ part = \"rod{k}\"{edges} }}\nwith = \"block\"\n{contact}\n"
        );
    }
    text
}

/// A block falls across a free rod, or across the edge of a sheet, which both of its lower edges cross between all nodes: two springs between
/// two masses. Box and hull do the same, and no energy, momentum or angular momentum comes or goes.
#[test]
fn a_block_falls_across_a_rod() {
    let (k, v) = (1e7, 1.0);
    for (what, below) in [("beam", PI * 0.02f64.powi(2) * 7850.0), ("edge", 0.5 * 0.04 * 7850.0)] {
        for scheme in SCHEMES {
            let mut of_boxes: Option<Vec<f64>> = None;
            for (kind, aside) in [("box", 0.0), ("hull", 0.0), ("box", 0.03), ("hull", 0.03)] {
                let at = [0.05 * aside, aside, 0.0205];
                let text = format!(
                    "{}{}{}",
                    motion(scheme, 0.01, 5e-6),
                    rods(what, &[0.0], &format!("stiffness = {k:?}")),
                    block(kind, at, &format!("velocity = [0.0, 0.0, {:?}]\n", -v))
                );
                let done = go(&text, &mut watch);
                assert!(matches!(done.outcome, Outcome::Done), "{what} {scheme}: {:?}", done.outcome);
                let (first, last) = (&done.rows[0], done.rows.last().unwrap());
                let highest = done.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
                println!("{what} {scheme} {kind} {aside}: {highest} {last:?}");
                let exact = v * (2.0 * k / (1.0 / 8.0 + 1.0 / below)).sqrt();
                // The edge of a sheet lies beside its centre along z alone, in the line of the blow.
                if aside == 0.0 {
                    assert!((highest / exact - 1.0).abs() < 1e-3, "{what} {scheme}: {highest} for {exact}");
                }
                assert!(highest > 0.3 * exact && last[3] == 0.0, "{what} {scheme}: {last:?}");
                assert!((last[1] / first[1] - 1.0).abs() < 1e-3, "{what} {scheme}: {last:?}");
                for i in 5..11 {
                    assert!((last[i] - first[i]).abs() < 1e-9, "{what} {scheme}: momentum {i}: {first:?} {last:?}");
                }
                match (&of_boxes, kind) {
                    // The hull has its corners in another order: rounding, and the tolerance of the iteration.
                    (Some(row), "hull") => {
                        assert!((row[1] / last[1] - 1.0).abs() < 1e-6, "{what} {scheme}: {row:?} {last:?}")
                    }
                    _ => of_boxes = Some(last.clone()),
                }
            }
        }
    }
}

/// Carried over a rod by supports, along it and across, over its edges and corners: what presses has a potential, and at no place is there
/// twice the force. The block slides off sideways over the corners of its lower face, and along the rod over its end.
#[test]
fn a_block_that_slides_off_a_rod_gets_its_work_back() {
    let (k, depth) = (1e6, 1e-3);
    // Sideways, along and askew.
    for (what, way) in [("aside", [0.0, 0.3]), ("along", [0.9, 0.0]), ("askew", [0.8, 0.17])] {
        let text = format!(
            "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 2e-3 }}\n{STEEL}amplitudes.way = {{ kind = \"ramp\", end = 1.0 }}\n{}{}\
             [[supports]]\nat = \"rod0\"\nfix = \"all\"\n[[supports]]\nat = \"block\"\nfix = [\"uz\", \"rx\", \"ry\", \"rz\"]\n\
             motion = {{ ux = {{ amplitude = \"way\", scale = {:?} }}, uy = {{ amplitude = \"way\", scale = {:?} }} }}\n",
            rods("beam", &[0.0], &format!("stiffness = {k:?}")),
            block("box", [0.0, 0.0, 0.02 - depth], ""),
            way[0],
            way[1]
        );
        let done = go(&text, &mut |frame| {
            let e = frame.derived.energy.expect("energies");
            vec![frame.state.time, e.contact, e.numerical, e.external, -frame.derived.contacts[0].f.z]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{what}: {:?}", done.outcome);
        let one = 0.5 * k * depth * depth;
        let first = &done.rows[0];
        // Where it begins two crossings press, and as it slides over ends and corners never more than what is there: two crossings and the
        // end of the rod.
        assert!((first[1] / (2.0 * one) - 1.0).abs() < 1e-6, "{what}: {first:?}");
        let most = done.rows.iter().map(|row| row[4] / (k * depth)).fold(0.0, f64::max);
        let last = done.rows.last().unwrap();
        println!("{what}: {most} {last:?}");
        assert!(most < 3.0 + 1e-6, "{what}: {most}");
        // 500 steps, some ten of them on the ways of 6 mm on which something comes or goes: the work of supports is the sum of trapezia.
        assert!((last[3] + first[1] - last[1]).abs() < 0.1 * one, "{what}: {first:?} {last:?}");
        assert!(what != "aside" || last[1] == 0.0, "{what}: {last:?}");
    }
}

/// At rest across two rods it presses with four crossings of equal share: as deep as a quarter of its weight over the stiffness.
#[test]
fn a_block_rests_across_two_rods() {
    for what in ["beam", "edge"] {
        for kind in ["box", "hull"] {
            let text = format!(
                "analysis = {{ kind = \"static\", end_time = 1.0, time_step = 0.25 }}\n{STEEL}environment.gravity = [0.0, 0.0, -10.0]\n{}{}\
                 [[supports]]\nat = [\"rod0\", \"rod1\"]\nfix = \"all\"\n[[supports]]\nat = \"block\"\nfix = [\"ux\", \"uy\", \"rz\"]\n",
                rods(what, &[-0.05, 0.06], "stiffness = 1e6"),
                block(kind, [0.1, 0.005, 0.02], "")
            );
            let probe = &mut |frame: &Frame| frame.derived.contacts.iter().flat_map(|of| [-of.f.z, of.gap]).collect();
            let done = go(&text, probe);
            assert!(matches!(done.outcome, Outcome::Done), "{what} {kind}: {:?}", done.outcome);
            let last = done.rows.last().unwrap();
            println!("{what} {kind}: {last:?}");
            for k in 0..2 {
                // Rounding at coordinates of half a metre, and the iteration.
                assert!((last[2 * k] / 40.0 - 1.0).abs() < 1e-6, "{what} {kind}: {last:?}");
                assert!((last[2 * k + 1] + 20.0 / 1e6).abs() < 1e-10, "{what} {kind}: {last:?}");
            }
        }
    }
}

/// A block whose edges lie along two rods, above their axes, rests on its corners, whatever rounding makes of what is parallel.
#[test]
fn a_block_along_two_rods_rests_on_its_corners() {
    for scheme in SCHEMES {
        let weight = 80.0;
        let text = format!(
            "{}environment.gravity = [0.0, 0.0, -10.0]\n{}{}[[supports]]\nat = [\"rod0\", \"rod1\"]\nfix = \"all\"\n",
            motion(scheme, 0.05, 1e-4),
            rods("beam", &[-0.1, 0.1], "stiffness = 1e6"),
            block("box", [0.03, 0.0, 0.02 - 0.25 * weight / 1e6], "")
        );
        let done = go(&text, &mut |frame| {
            let node =
                &frame.state.nodes[frame.model.bodies.iter().find(|body| body.name == "block").expect("it").node];
            let force: f64 = frame.derived.contacts.iter().map(|contact| -contact.f.z).sum();
            vec![force, node.x.z, node.rotation.i.abs() + node.rotation.j.abs()]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let first = done.rows[0].clone();
        for row in &done.rows {
            // Nothing swings: of 80 N the digits of the deck leave 1e-9.
            assert!(
                (row[0] / weight - 1.0).abs() < 1e-6 && (row[1] - first[1]).abs() < 1e-9 && row[2] < 1e-9,
                "{scheme}: {row:?}"
            );
        }
    }
}

/// It slides over two rods, along and askew, by Coulomb's law: over its own corners and over the nodes of rods of many elements too.
#[test]
fn a_block_slides_over_rods() {
    for scheme in SCHEMES {
        for (what, across) in [("across", true), ("along", false)] {
            let rods = match across {
                true => rods("beam", &[-0.05, 0.05], "stiffness = 1e6\nfriction = 0.3"),
                false => rods("beam", &[-0.06, 0.06], "stiffness = 1e6\nfriction = 0.3"),
            };
            // Two rods, four crossings.
            let at = if across { [0.0, 0.0, 0.02 - 20e-6] } else { [-0.3, 0.0, 0.02 - 20e-6] };
            let velocity = if across { "velocity = [0.0, 0.3, 0.0]" } else { "velocity = [1.0, 0.0, 0.0]" };
            let text = format!(
                "{}environment.gravity = [0.0, 0.0, -10.0]\n{rods}{}[[supports]]\nat = [\"rod0\", \"rod1\"]\nfix = \"all\"\n\
                 [[supports]]\nat = \"block\"\nfix = [\"rx\", \"ry\", \"rz\"]\n",
                motion(scheme, if across { 0.08 } else { 0.2 }, 1e-4),
                block("box", at, &format!("{velocity}\n"))
            );
            let done = go(&text, &mut |frame| {
                let e = frame.derived.energy.expect("energies");
                let node =
                    &frame.state.nodes[frame.model.bodies.iter().find(|body| body.name == "block").expect("it").node];
                vec![node.v.norm(), e.friction, e.numerical, e.mechanical, frame.state.time]
            });
            assert!(matches!(done.outcome, Outcome::Done), "{what} {scheme}: {:?}", done.outcome);
            let (first, last) = (&done.rows[0], done.rows.last().unwrap());
            println!("{what} {scheme}: {last:?}");
            // The springs of friction are stretched from the start; half a step at the end.
            assert!((last[0] - (first[0] - 3.0 * last[4])).abs() < 5e-4, "{what} {scheme}: {first:?} {last:?}");
            assert!((last[1] / (first[3] - last[3]) - 1.0).abs() < 2e-3, "{what} {scheme}: {first:?} {last:?}");
            assert!(last[2].abs() < 1e-3 * first[3], "{what} {scheme}: {last:?}");
        }
    }
}

/// A body that is made of a sheet touches edges and rods as the sheet does that is rigid by itself: to rounding the same.
#[test]
fn a_body_made_of_a_sheet_touches_as_the_sheet_does() {
    let sheet = |body: bool| {
        let (rigid, table) = match body {
            true => ("", "[[bodies]]\nname = \"block\"\nparts = \"sheet\"\nvelocity = [0.0, 0.0, -1.0]\n"),
            false => ("rigid = true\n", "[[initial]]\nat = \"sheet\"\nvelocity = [0.0, 0.0, -1.0]\n"),
        };
        let points =
            "[points]\ne = [0.1, -0.2, 0.0255]\nf = [0.1, 0.3, 0.0255]\ng = [0.1, 0.3, 0.3]\nh = [0.1, -0.2, 0.3]\n";
        let text = rods("edge", &[0.0], "stiffness = 1e7").replace("[points]\n", points);
        let text = if body { text } else { text.replace("with = \"block\"", "with = \"sheet\"") };
        format!(
            "{}{text}[[shells]]\nname = \"sheet\"\ncorners = [\"e\", \"f\", \"g\", \"h\"]\nelements = [2, 2]\nthickness = 0.01\nmaterial = \"steel\"\n{rigid}{table}",
            motion(SCHEMES[0], 0.004, 1e-5)
        )
    };
    let [one, other] = [true, false].map(|body| go(&sheet(body), &mut watch).rows);
    let highest = one.iter().map(|row| row[4]).fold(0.0, f64::max);
    assert!(highest > 1000.0 && one.len() == other.len(), "{highest}");
    for (a, b) in one.iter().zip(&other) {
        assert!((a[4] - b[4]).abs() < 1e-9 * highest, "{a:?} {b:?}");
    }
}
