//! Motors along slots: the effort acts along the axis that the second part carries, whatever turns, and does its work along the coordinate.

use super::{all_schemes, opening, shown};
use crate::support::{read_deck, run_to_the_end};
use rdsolve::solve::Frame;

/// A body of 1 kg at the origin; `more` are further keys.
fn body(name: &str, inertia: [f64; 3], more: &str) -> String {
    format!("[[bodies]]\nname = \"{name}\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = {inertia:?}\n{more}\n")
}

/// A spinning ball is pushed along a slot on the ground: x = −f t²/2m.
#[test]
fn a_spinning_ball_is_pushed_along_its_slot() {
    for scheme in all_schemes() {
        let text = opening(scheme, 5e-3, 0.5, 0.5)
            + &body("ball", [0.1; 3], "angular_velocity = [0.0, 0.3, 3.0]")
            + "[[joints]]\nname = \"slot\"\nkind = \"in-line\"\naxis = [1.0, 0.0, 0.0]\nfrom = { body = \"ball\" }\n\
               to = { ground = [0.0, 0.0, 0.0] }\neffort = { value = 1.0 }\n";
        let last = *shown(&read_deck(&text), "slot").last().expect("a row");
        // Under a constant force every scheme of second order is exact, to the tolerance of the iteration; the work is f q.
        assert!((last.coordinate - 0.125).abs() < 1e-10, "{scheme}: {last:?}");
        assert!((last.external - 0.125).abs() < 1e-10, "{scheme}: {last:?}");
    }
}

/// A ball in a slot of a turntable: r″ = ω² r − f/m, so r = −f (cosh ωt − 1)/m ω².
#[test]
fn a_slot_on_a_turntable_turns_the_effort() {
    let (omega, end) = (3.0f64, 0.5);
    let exact = ((omega * end).cosh() - 1.0) / (omega * omega);
    for scheme in all_schemes() {
        let error = |dt: f64| {
            let text = opening(scheme, dt, end, end)
                + &body("table", [1.0; 3], &format!("angular_velocity = [0.0, 0.0, {omega:?}]"))
                + &body("ball", [0.1; 3], "angular_velocity = [0.0, 2.0, 1.0]")
                + &format!(
                    "[[supports]]\nat = \"table\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\n\
                     motion = {{ rz = {{ amplitude = \"on\", scale = {omega:?}, history = \"velocity\" }} }}\n\
                     [amplitudes.on]\nkind = \"step\"\nstart = -1.0\n\
                     [[joints]]\nname = \"slot\"\nkind = \"in-line\"\naxis = [1.0, 0.0, 0.0]\nfrom = {{ body = \"ball\" }}\n\
                     to = {{ body = \"table\" }}\neffort = {{ value = 1.0 }}\n"
                );
            let last = *shown(&read_deck(&text), "slot").last().expect("a row");
            (last.coordinate / exact - 1.0).abs()
        };
        let [coarse, fine] = [error(1e-2), error(5e-3)];
        println!("{scheme}: {coarse:e} {fine:e}");
        // Of second order or better; (ωΔt)² is 2.2e-4, of which Wilson-theta errs by most. Below 1e-8 the iteration's tolerance counts.
        assert!(fine < 1e-3 && (fine < 0.3 * coarse || fine < 1e-8), "{scheme}: {coarse:e} {fine:e}");
    }
}

/// Two free bodies that turn about different axes, with a motor or with a spring so long and soft that its force is nearly constant.
fn pair(scheme: &str, kind: &str, coordinate: &str, acts: &str, exchanged: bool) -> Vec<Vec<f64>> {
    let [from, to] = if exchanged { ["b", "a"] } else { ["a", "b"] };
    let spin = if kind == "in-line" { "angular_velocity = [1.0, -0.7, 2.0]" } else { "" };
    let text = opening(scheme, 5e-3, 0.5, 0.1)
        + &body("a", [0.3, 0.4, 0.5], spin)
        + &body("b", [0.2, 0.15, 0.1], "").replace("center = [0.0, 0.0, 0.0]", "center = [0.3, 0.1, 0.2]")
        + &format!(
            "[[joints]]\nname = \"motor\"\nkind = \"{kind}\"\naxis = [1.0, 0.3, 0.2]\nfrom = {{ body = \"{from}\", point = [0.1, 0.0, 0.1] }}\n\
             to = {{ body = \"{to}\", point = [0.1, 0.0, 0.1] }}\n{coordinate}\n{acts}\n"
        );
    let model = read_deck(&text);
    run_to_the_end(&model, &mut |frame: &Frame| {
        let energy = frame.derived.energy.expect("energies");
        let nodes = model.bodies.iter().map(|body| &frame.state.nodes[body.node]);
        let motion = nodes.flat_map(|node| node.x.iter().chain(node.v.iter()).chain(node.omega.iter()).copied());
        [energy.p.as_slice(), energy.l.as_slice(), &[energy.mechanical - energy.external]]
            .concat()
            .into_iter()
            .chain(motion)
            .collect()
    })
    .rows
}

/// The effort of a motor is that of a spring along the same coordinate, which knows only this; momenta stay.
#[test]
fn a_motor_acts_along_the_coordinate_of_every_kind_of_joint() {
    let kinds = [
        ("in-line", ""),
        ("prismatic", ""),
        ("cylindrical", ""),
        ("cylindrical", "coordinate = \"angle\""),
        ("revolute", ""),
        ("planar", ""),
        ("screw", "lead = 0.2"),
        ("screw", "lead = 0.2\ncoordinate = \"distance\""),
    ];
    const SOFT: f64 = 1e-7;
    for (kind, coordinate) in kinds {
        for exchanged in [false, true] {
            let [motor, spring] =
                ["effort = { value = 2.0 }".to_owned(), format!("stiffness = {SOFT:?}\nrest = {:?}", 2.0 / SOFT)]
                    .map(|acts| pair("esdirk3", kind, coordinate, &acts, exchanged));
            assert!(motor.len() > 4 && motor.len() == spring.len());
            for (a, b) in motor.iter().zip(&spring) {
                // The spring's force changes by its stiffness times the way, 1e-7 at most of 2.
                let far = a[7..].iter().zip(&b[7..]).fold(0.0f64, |far, (a, b)| far.max((a - b).abs()));
                assert!(far < 3e-6, "{kind} {coordinate} {exchanged}: {far:e}");
                let moved = a[..6].iter().zip(&motor[0][..6]).fold(0.0f64, |far, (a, b)| far.max((a - b).abs()));
                assert!(moved < 2e-6, "{kind} {coordinate} {exchanged}: momentum {moved:e}");
                // The scheme is of third order: it dissipates a part 1e-5 of an energy near 1.
                assert!((a[6] - motor[0][6]).abs() < 1e-5, "{kind} {coordinate} {exchanged}: {}", a[6] - motor[0][6]);
            }
        }
    }
}

/// In statics a slot that is turned by 1.2 rad takes the effort and the spring along with it: q = f/k along the turned axis.
#[test]
fn a_slot_that_turns_in_statics_turns_the_effort() {
    let text = "[analysis]\nkind = \"static\"\nend_time = 1.0\ntime_step = 0.25\n[iteration]\ntolerance = 1e-12\n"
        .to_owned()
        + &body("table", [1.0; 3], "")
        + &body("ball", [0.1; 3], "")
        + "[[supports]]\nat = \"table\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\"]\n\
           motion = { rz = { amplitude = \"on\", scale = 1.2 } }\n[amplitudes.on]\nkind = \"ramp\"\nend = 1.0\n\
           [[supports]]\nat = \"ball\"\nfix = \"rotations\"\n\
           [[joints]]\nname = \"slot\"\nkind = \"in-line\"\naxis = [1.0, 0.0, 0.0]\nfrom = { body = \"ball\" }\n\
           to = { body = \"table\" }\neffort = { value = 3.0 }\nstiffness = 10.0\n";
    let model = read_deck(&text);
    let rows =
        run_to_the_end(&model, &mut |frame: &Frame| frame.state.nodes[model.bodies[1].node].x.as_slice().to_vec()).rows;
    let [x, y, z] = rows.last().expect("a row")[..] else { panic!("{rows:?}") };
    let (sin, cos) = 1.2f64.sin_cos();
    // The tolerance of the iteration is 1e-12.
    assert!((x + 0.3 * cos).abs() < 1e-10 && (y + 0.3 * sin).abs() < 1e-10 && z.abs() < 1e-10, "{rows:?}");
}
