//! What falls, flies and lands: restitution, energies, momenta, and surfaces that hold whatever the step.

use super::go;
use crate::support::slope;
use rdsolve::solve::Frame;

/// A ball of radius 0.1 and mass 2 at a height above a floor.
fn ball(height: f64, velocity: f64, gravity: f64, dt: f64, end: f64, contact: &str) -> String {
    let z = 0.1 + height;
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = {end}, time_step = {dt} }}
        environment = {{ gravity = [0.0, 0.0, -{gravity:?}] }}
        bodies = [{{ name = "ball", center = [0.0, 0.0, {z:?}], shape = {{ kind = "sphere", radius = 0.1 }}, mass = 2.0, velocity = [0.0, 0.0, {velocity:?}] }}]
        [[contacts]]
        name = "floor"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = "ball"
        {contact}
        "#
    )
}

/// Time, height, speed; total energy, what the scheme took, and lost in impacts.
fn fall(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let node = &frame.state.nodes[0];
    vec![frame.state.time, node.x.z - 0.1, node.v.z, e.mechanical, e.numerical, e.impact]
}

/// Thrown at the floor without gravity: the speed after the impact is e times that before, whatever mass and stiffness are.
#[test]
fn an_impact_gives_back_its_part_of_the_speed() {
    for e in [1.0, 0.9, 0.6, 0.2] {
        // ω = √(k/m) = 316: an impact lasts 10 ms.
        let mut errors = Vec::new();
        for dt in [5e-4, 2.5e-4, 1.25e-4, 6.25e-5] {
            let contact = format!("stiffness = 2e5\nrestitution = {e}");
            let done = go(&ball(0.01, -4.0, 0.0, dt, 0.06, &contact), &mut fall);
            let end = done.rows.last().unwrap();
            let error = (end[2] / (4.0 * e) - 1.0f64).abs();
            println!("e = {e}, dt = {dt}: {error:.2e}, numerical {:.2e} of 16", end[4]);
            errors.push((dt, error));
            // The balance closes: ½ m v² (1 − e²) is lost in the impact, the rest is the error of the scheme, 1 % at 20 steps an
            // impact and less with more of them.
            assert!((end[5] - 16.0 * (1.0 - e * e)).abs() < 0.16 * (dt / 5e-4), "{e} {dt}: {}", end[5]);
        }
        let slope = slope(&errors);
        println!("e = {e}: slope {slope:.2}");
        // Between first and second order, by where in a step the impact begins and ends; the kinks of the force make it uneven.
        assert!(slope > 1.0, "e = {e}: {slope}");
        assert!(errors[3].1 < 2e-3, "e = {e}: {errors:?}");
    }
}

/// Heights after a fall of one metre: e² and e⁴ of it, with a floor so stiff that the weight does nothing in an impact.
#[test]
fn bounces_go_as_high_as_they_should() {
    for e in [1.0, 0.8, 0.5] {
        // ω = 3162, an impact lasts 1 ms; g/(ω v₀) = 7e-4 is what the weight adds to the speed within it, and less e is longer.
        let contact = format!("stiffness = 2e7\nrestitution = {e}");
        let done = go(&ball(1.0, 0.0, 10.0, 5e-5, 2.0, &contact), &mut fall);
        let rows = &done.rows;
        // Exact while it falls.
        for row in rows.iter().take_while(|row| row[1] > 0.01) {
            assert!((row[1] - (1.0 - 5.0 * row[0] * row[0])).abs() < 1e-11, "{row:?}");
        }
        let mut at = 0;
        for bounce in 1..=2 {
            at += rows[at..].iter().position(|row| row[1] < 0.0).expect("it lands");
            at += rows[at..].iter().position(|row| row[1] > 0.0).expect("it flies");
            let height = rows[at..].iter().take_while(|row| row[1] > 0.0).map(|row| row[1]).fold(0.0, f64::max);
            let exact = f64::powi(e, 2 * bounce);
            println!("e = {e}, bounce {bounce}: {height:.5} for {exact:.5}");
            assert!((height / exact - 1.0).abs() < 0.01 * bounce as f64, "e = {e}, bounce {bounce}: {height} {exact}");
        }
        let last = rows.last().unwrap();
        println!("e = {e}: numerical {:.2e}, impact {:.4} of 20", last[4], last[5]);
        // Nothing is gained: what the scheme takes or gives is within 1 % of the energy, 20 J.
        assert!(last[4].abs() < 0.2, "{last:?}");
    }
}

/// Left to settle, the ball lies still at the depth that carries its weight.
#[test]
fn what_settles_lies_still() {
    let done = go(&ball(0.02, 0.0, 10.0, 1e-3, 3.0, "stiffness = 1e4\nrestitution = 0.5"), &mut fall);
    let last = done.rows.last().unwrap();
    // m g/k = 2 mm; at rest the damping is about a third of critical and three seconds are 200 of its times.
    assert!((last[1] + 2e-3).abs() < 1e-8 && last[2].abs() < 1e-6, "{last:?}");
}

/// No step is so long that the ball gets through a sheet of a thousandth of the way it flies in that step.
#[test]
fn nothing_goes_through_a_thin_sheet() {
    for (dt, thickness) in [(1.0, 0.001), (0.1, 0.001), (0.013, 0.002), (1e-3, 0.01)] {
        for shape in [
            format!("shape = \"box\", center = [0.0, 0.0, 0.0], size = [1.0, 1.0, {thickness}]"),
            format!(
                "shape = \"cylinder\", center = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0], radius = 0.5, length = {thickness}"
            ),
            format!("shape = \"capsule\", ends = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], radius = {thickness}"),
            format!("shape = \"sphere\", center = [0.0, 0.0, 0.0], radius = {thickness}"),
        ] {
            let text = format!(
                r#"
                analysis = {{ kind = "dynamic", end_time = 1.0, time_step = {dt} }}
                bodies = [{{ name = "ball", center = [0.0, 0.0, 3.0], shape = {{ kind = "sphere", radius = 0.001 }}, mass = 0.01, velocity = [0.0, 0.0, -10.0] }}]
                [[contacts]]
                name = "sheet"
                surface = {{ {shape} }}
                with = "ball"
                stiffness = 1e7
                "#
            );
            let done = go(&text, &mut fall);
            let last = done.rows.last().unwrap();
            println!("{shape}, dt {dt}: {} steps, {} cuts, v = {}", done.counts.steps, done.counts.cuts, last[2]);
            // Back at the speed it came, within what nine steps an impact leave.
            assert!(last[1] > 0.0 && (last[2] / 10.0 - 1.0).abs() < 0.1, "{shape}, {dt}: {last:?}");
            assert!(done.counts.steps < 200 + (1.0 / dt) as usize, "{} steps", done.counts.steps);
        }
    }
}

/// Two free bodies that meet off their centres: momenta are kept, and e is that of the contact.
#[test]
fn momenta_are_kept() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 0.4, time_step = 2e-4 }
        [[bodies]]
        name = "block"
        center = [0.0, 0.0, 0.0]
        shape = { kind = "box", size = [0.4, 0.5, 0.6] }
        mass = 3.0
        angular_velocity = [0.3, -0.2, 0.5]
        [[bodies]]
        name = "ball"
        center = [0.1, 0.6, 0.15]
        shape = { kind = "sphere", radius = 0.1 }
        mass = 1.0
        velocity = [0.1, -3.0, 0.2]
        angular_velocity = [5.0, 1.0, 2.0]
        [[contacts]]
        name = "hit"
        surface = { shape = "box", body = "block", size = [0.4, 0.5, 0.6] }
        with = "ball"
        stiffness = 1e5
        restitution = 0.7
        friction = 0.4
    "#;
    let mut drift = [0.0f64; 2];
    let mut first = None;
    let done = go(text, &mut |frame| {
        let e = frame.derived.energy.expect("energies");
        let (p0, l0) = *first.get_or_insert((e.p, e.l));
        drift = [drift[0].max((e.p - p0).norm()), drift[1].max((e.l - l0).norm())];
        vec![frame.state.nodes[1].v.y, e.friction, e.impact, e.numerical]
    });
    let last = done.rows.last().unwrap();
    assert!(last[0] > -1.0 && last[1] > 0.0 && last[2] > 0.0, "{last:?}");
    println!(
        "drift of momentum {:.1e} of 3, of angular momentum {:.1e} of 2, energy {:.1e}",
        drift[0], drift[1], last[3]
    );
    // Linear momentum to the tolerance of the iteration, 1e-8 of an impact's. Angular momentum is kept by the forces, and by
    // the scheme to second order: the force of an instant ahead acts at the arm of its end.
    assert!(drift[0] < 1e-8 && drift[1] < 1e-4, "{drift:?}");
}

/// A ball on a plate of shells held at its edges: down by its weight it comes to rest in the end, before that momentum goes
/// to and fro between them; free plates keep it.
#[test]
fn a_ball_on_a_free_plate_of_shells() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 0.02, time_step = 2e-5 }
        [materials.steel]
        model = "elastic"
        youngs_modulus = 2e11
        poisson_ratio = 0.3
        density = 7800.0
        [points]
        a = [0.0, 0.0, 0.0]
        b = [0.4, 0.0, 0.0]
        c = [0.4, 0.4, 0.0]
        d = [0.0, 0.4, 0.0]
        [[shells]]
        name = "plate"
        corners = ["a", "b", "c", "d"]
        elements = [4, 4]
        material = "steel"
        thickness = 0.005
        [[bodies]]
        name = "ball"
        center = [0.23, 0.26, 0.0535]
        shape = { kind = "sphere", radius = 0.05 }
        mass = 1.0
        velocity = [0.0, 0.0, -1.0]
        [[contacts]]
        name = "hit"
        surface = { shape = "sphere", body = "ball", radius = 0.05 }
        with = "plate"
        stiffness = 1e6
        points = 3
    "#;
    let mut most = 0.0f64;
    let mut drift = 0.0f64;
    let done = go(text, &mut |frame| {
        let e = frame.derived.energy.expect("energies");
        drift = drift.max((e.p.z + 1.0).abs());
        most = most.max(e.contact);
        let ball = frame.model.bodies[0].node;
        vec![frame.state.nodes[ball].v.z, e.mechanical, e.numerical]
    });
    let last = done.rows.last().unwrap();
    println!(
        "ball at {:.3} m/s, most stored in the contact {most:.2e} J, momentum to {drift:.1e}, numerical {:.1e}",
        last[0], last[2]
    );
    // The plate weighs 6.24 kg; the tolerance of the iteration is 1e-8 of the forces, over a thousand steps.
    assert!(last[0] > -0.5 && most > 1e-3 && drift < 1e-7, "{last:?} {most} {drift}");
    // Modes of the mesh that 2e-5 does not resolve are damped; nothing is gained.
    assert!(last[2] > -0.005 && last[2] < 0.1, "{last:?}");
}

/// A restitution of 0: what lands stays, without weight and with it, whatever mass the stiffness was meant for, and all of its energy is
/// gone.
#[test]
fn nothing_rebounds_with_a_restitution_of_zero() {
    for scheme in ["newmark", "wilson-theta", "generalized-alpha", "esdirk3", "central-difference", "runge-kutta"] {
        for gravity in [0.0, 10.0] {
            let with = format!("stiffness = 2e5\nrestitution = 0\n[integrator]\nscheme = \"{scheme}\"");
            let done = go(&ball(0.01, -4.0, gravity, 2e-4, 0.06, &with), &mut fall);
            let fastest = done.rows.iter().map(|row| row[2]).fold(f64::NEG_INFINITY, f64::max);
            let last = done.rows.last().unwrap();
            println!("{scheme}, g = {gravity}: {:.1e}, {last:?}", fastest / 4.0);
            // The spring takes over at 1e-7 of the size of the scene in a time 1/ω, and pushes by some of these: 1e-5 of the speed. Under weight
            // the spring takes the way over at g/ω = 0.03 for some 1/ω, and is pressed in by up to three times the weight: it swings back by
            // twice g/ω at most, and never leaves the surface.
            let most = if gravity > 0.0 { 0.063 } else { 1e-4 };
            assert!(fastest < most, "{scheme}: {fastest}");
            // What is lost of 16 J: in the impact, and 15 % at most by steps that are a sixteenth of 1/ω.
            let lost = 16.0 + 2.0 * gravity * (0.01 - last[1]);
            assert!(
                (last[5] + last[4] - lost).abs() < 0.01 * lost && last[4].abs() < 0.15 * lost,
                "{scheme}: {last:?}"
            );
        }
    }
}

/// A box, on which four corners press, a hundred times as heavy as the ball that the stiffness was chosen for, and boxes `among` each other.
#[test]
fn nothing_rebounds_from_faces_either() {
    let box_on = |name: &str, mass: f64, contact: &str| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.4, time_step = 1e-3 }}
            integrator = {{ scheme = "newmark" }}
            environment = {{ gravity = [0.0, 0.0, -10.0] }}
            [[bodies]]
            name = "{name}"
            center = [0.0, 0.0, 0.3]
            mass = {mass:?}
            shape = {{ kind = "box", size = [0.4, 0.4, 0.4] }}
            [[bodies]]
            name = "floor"
            center = [0.0, 0.0, -0.1]
            mass = 10.0
            shape = {{ kind = "box", size = [2.0, 2.0, 0.2] }}
            [[supports]]
            at = "floor"
            fix = "all"
            [[contacts]]
            name = "c"
            {contact}
            restitution = 0
            stiffness = 1e6
            "#
        )
    };
    let ways = [
        r#"surface = { body = "floor" }
            with = "a""#,
        r#"among = ["a", "floor"]"#,
        r#"surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
            with = "a""#,
    ];
    for contact in ways {
        for mass in [2.0, 200.0] {
            let done = go(&box_on("a", mass, contact), &mut |frame| {
                vec![frame.state.nodes[0].x.z - 0.2, frame.state.nodes[0].v.z]
            });
            let landed = done.rows.iter().position(|row| row[0] < 0.0).expect("it lands");
            let fastest = done.rows[landed..].iter().map(|row| row[1]).fold(f64::NEG_INFINITY, f64::max);
            println!("{contact}, {mass}: {fastest:.1e}, {:?}", done.rows.last());
            // It falls at 1.4 m/s, and swings by twice g/ω at most, ω² = 4 k/m.
            assert!(fastest < 2.0 * 10.0 * (mass / 4e6f64).sqrt(), "{mass}: {fastest}");
        }
    }
}
