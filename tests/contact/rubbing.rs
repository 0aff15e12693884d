//! Friction: what rolls, slides and sticks; and what is pressed on surfaces of every shape.

use super::go;
use crate::support::slope;
use rdsolve::solve::Frame;

/// A ball of radius 0.1 and mass 2 that lies on a floor under its weight, 20, and is set going.
fn rolling(dt: f64, velocity: f64, spin: f64) -> String {
    let z = 0.1 - 20.0 / 1e6;
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.6, time_step = {dt} }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        bodies = [{{ name = "ball", center = [0.0, 0.0, {z:?}], shape = {{ kind = "sphere", radius = 0.1 }}, mass = 2.0, velocity = [{velocity:?}, 0.0, 0.0], angular_velocity = [0.0, {spin:?}, 0.0] }}]
        [[contacts]]
        name = "floor"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = "ball"
        stiffness = 1e6
        friction = 0.3
        "#
    )
}

fn motion(frame: &Frame) -> Vec<f64> {
    let (node, e) = (&frame.state.nodes[0], frame.derived.energy.expect("energies"));
    vec![frame.state.time, node.x.x, node.v.x, node.omega.y, e.friction, e.numerical]
}

/// Slides with −μg until it rolls at 5/7 of the speed, at t = 2 v₀/(7 μ g) (any textbook on mechanics); then for ever.
#[test]
fn a_ball_that_slides_begins_to_roll() {
    let (v0, mu, g) = (1.0, 0.3, 10.0);
    let begins = 2.0 * v0 / (7.0 * mu * g);
    let x_end = v0 * begins - 0.5 * mu * g * begins * begins + 5.0 / 7.0 * v0 * (0.6 - begins);
    let mut errors = Vec::new();
    for dt in [2e-3, 1e-3, 5e-4, 2.5e-4] {
        let done = go(&rolling(dt, v0, 0.0), &mut motion);
        let last = done.rows.last().unwrap();
        let slip = |row: &Vec<f64>| row[2] - 0.1 * row[3];
        // Slipping ends where the line of slip speeds, falling by 7/2 μ g, comes to zero.
        let sliding: Vec<&Vec<f64>> = done.rows.iter().filter(|row| row[0] > 0.02 && row[0] < 0.08).collect();
        let (a, b) = (sliding[0], sliding[sliding.len() - 1]);
        let t = a[0] + slip(a) / (slip(a) - slip(b)) * (b[0] - a[0]);
        println!("dt {dt}: v {:.2e}, t {:.2e}, x {:.2e}", last[2] - 5.0 / 7.0, t - begins, last[1] - x_end);
        // Angular momentum about the floor is kept, so the speed is 5/7 whatever the friction does. The spring that holds then
        // swings on by μ N/k, and the ball by μ g/√(7 k/2 m) = 2.3e-3 at most.
        assert!((last[2] - 5.0 / 7.0).abs() < 2.3e-3, "{last:?}");
        let swing = 5.0 / 7.0 * last[2] + 2.0 / 7.0 * 0.1 * last[3] - 5.0 / 7.0;
        assert!(swing.abs() < 1e-9, "{last:?}");
        // Slip falls on a straight line from the first.
        assert!((t - begins).abs() < 1e-6, "{t} {begins}");
        // ½ m v₀² · 2/7
        assert!((last[4] - 2.0 / 7.0).abs() < 1e-3, "{last:?}");
        errors.push((dt, (last[1] - x_end).abs()));
    }
    println!("slope {:.2}", slope(&errors));
    assert!(errors[3].1 < 3e-4, "{errors:?}");
}

/// Thrown with back spin ω = −20/s, r ω = −2 v₀: it rolls at (5 v₀ + 2 r ω)/7, backwards if that is negative.
#[test]
fn a_ball_with_back_spin_comes_back() {
    for (spin, v_end) in [(-20.0, (5.0 - 4.0) / 7.0), (-40.0, (5.0 - 8.0) / 7.0), (10.0, 1.0)] {
        let done = go(&rolling(1e-3, 1.0, spin), &mut motion);
        let last = done.rows.last().unwrap();
        // The spring's swing after the slip, as above.
        assert!((last[2] - v_end).abs() < 2.3e-3 && (last[2] - 0.1 * last[3]).abs() < 8e-3, "{spin}: {last:?}");
    }
}

/// A block of 0.4 × 0.2 × 0.02 and mass 4 on its four corners, the incline put level.
fn block(dt: f64, end: f64, angle: f64, mu: f64, velocity: f64) -> String {
    let (s, c) = f64::sin_cos(angle);
    let z = 0.01 - 10.0 * c / 1e6;
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = {end}, time_step = {dt} }}
        environment = {{ gravity = [{:?}, 0.0, {:?}] }}
        bodies = [{{ name = "block", center = [0.0, 0.0, {z:?}], shape = {{ kind = "box", size = [0.4, 0.2, 0.02] }}, mass = 4.0, velocity = [{velocity:?}, 0.0, 0.0] }}]
        [[contacts]]
        name = "incline"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = "block"
        stiffness = 1e6
        friction = {mu}
        "#,
        10.0 * s,
        -10.0 * c
    )
}

#[test]
fn a_block_slides_down_as_coulomb_says() {
    let (angle, mu) = (0.5f64, 0.2);
    let a = 10.0 * (angle.sin() - mu * angle.cos());
    let mut errors = Vec::new();
    for dt in [2e-3, 1e-3, 5e-4] {
        let done = go(&block(dt, 1.0, angle, mu, 0.0), &mut motion);
        let at = |t: f64| done.rows.iter().find(|row| row[0] > t - 1e-9).unwrap()[2];
        let measured = (at(1.0) - at(0.5)) / 0.5;
        println!("dt {dt}: a {:.2e}, x {:.2e}", measured / a - 1.0, done.rows.last().unwrap()[1] / (0.5 * a) - 1.0);
        errors.push((measured / a - 1.0f64).abs());
    }
    // Once it slides the acceleration is exact but for the block's rocking on its springs, 1e-4 and zero in the mean.
    assert!(errors.iter().all(|e| *e < 1e-3), "{errors:?}");
}

/// On a flatter plane the block stops after v₀²/2a and stays.
#[test]
fn a_block_stops_where_it_should() {
    let (angle, mu, v0) = (0.1f64, 0.4, 1.0);
    let way = v0 * v0 / (20.0 * (mu * angle.cos() - angle.sin()));
    let mut errors = Vec::new();
    for dt in [2e-3, 1e-3, 5e-4, 2.5e-4] {
        let done = go(&block(dt, 1.0, angle, mu, v0), &mut motion);
        let last = done.rows.last().unwrap();
        errors.push((dt, (last[1] / way - 1.0).abs()));
        assert!(last[2].abs() < 2e-3, "it swings on its springs alone: {last:?}");
    }
    println!("{errors:?}");
    // The stretch of the springs, μ N/k = 4e-6 of 0.17, and the block's rocking on them.
    assert!(errors.iter().all(|e| e.1 < 1e-4), "{errors:?}");
}

/// Steeper friction than slope: for ten seconds the block does not creep.
#[test]
fn what_sticks_stays() {
    let done = go(&block(2e-3, 10.0, 0.3, 0.5, 0.0), &mut motion);
    let mean = |from: f64, to: f64| {
        let rows: Vec<f64> = done.rows.iter().filter(|row| row[0] > from && row[0] <= to).map(|row| row[1]).collect();
        rows.iter().sum::<f64>() / rows.len() as f64
    };
    let (early, late) = (mean(1.0, 2.0), mean(9.0, 10.0));
    println!("after 2 s {early:.3e}, after 10 s {late:.3e}");
    // It lies 3e-6 down on its tangential springs, m g sin/4k, and a little where it slipped at first; then nothing moves.
    assert!((late - early).abs() < 1e-9 && late.abs() < 1e-5, "{early} {late}");
}

/// A point pressed on a surface by a force comes to rest at f = k δ, along the normal.
#[test]
fn a_force_presses_to_the_depth_of_its_stiffness() {
    let shapes = [
        ("shape = \"plane\", point = [0.0, 0.0, 0.5], normal = [0.0, 0.0, 1.0]", [0.1, 0.2], 0.5),
        ("shape = \"box\", center = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0]", [0.1, 0.2], 0.5),
        ("shape = \"sphere\", center = [0.0, 0.0, 0.0], radius = 0.5", [0.0, 0.0], 0.5),
        (
            "shape = \"cylinder\", center = [0.0, 0.0, 0.0], axis = [1.0, 0.0, 0.0], radius = 0.5, length = 2.0",
            [0.1, 0.0],
            0.5,
        ),
        (
            "shape = \"cylinder\", center = [0.0, 0.0, 0.0], axis = [0.0, 0.0, 1.0], radius = 0.4, length = 1.0",
            [0.1, 0.2],
            0.5,
        ),
        ("shape = \"capsule\", ends = [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]], radius = 0.5", [0.1, 0.0], 0.5),
    ];
    for (shape, [x, y], top) in shapes {
        for radius in [0.0, 0.1] {
            let z = top + radius;
            let text = format!(
                r#"
                analysis = {{ kind = "static", end_time = 1.0, time_step = 0.25 }}
                masses = [{{ at = "tip", mass = 1.0 }}]
                points = {{ tip = [{x:?}, {y:?}, {z:?}], post = [{x:?}, {y:?}, 2.0] }}
                links = [{{ name = "guide", from = {{ node = "post" }}, to = {{ node = "tip" }}, bushing = [1e3, 1e3, 1.0, 1.0, 1.0, 1.0] }}]
                supports = [{{ at = "post", fix = "all" }}]
                loads = [{{ at = "tip", force = [0.0, 0.0, -30.0] }}]
                [[contacts]]
                name = "seat"
                surface = {{ {shape} }}
                with = "tip"
                radius = {radius:?}
                stiffness = 1e5
                "#
            );
            let done = go(&text, &mut |frame| vec![frame.state.nodes[0].x.z]);
            let depth = z - done.rows.last().unwrap()[0];
            // The guide bears 1 per length beside 1e5. The iteration ends at 1e-8.
            assert!((depth / (30.0 / (1e5 + 1.0)) - 1.0).abs() < 1e-7, "{shape}, {radius}: {depth}");
        }
    }
}

/// At an edge and at a corner of a box a ball is pushed along the line from there to its middle.
#[test]
fn a_ball_on_an_edge_and_on_a_corner() {
    for corner in [[0.5, 0.5, 0.0], [0.5, 0.5, 0.5]] {
        let n: Vec<f64> = corner.iter().map(|c| if *c == 0.0 { 0.0 } else { 1.0 }).collect();
        let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
        let at: Vec<f64> = (0..3).map(|i| corner[i] + 0.1 * n[i] / length).collect();
        let f: Vec<f64> = n.iter().map(|c| -30.0 * c / length).collect();
        let text = format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.25 }}
            masses = [{{ at = "tip", mass = 1.0 }}]
            points = {{ tip = {at:?}, post = {at:?} }}
            links = [{{ name = "guide", from = {{ node = "post" }}, to = {{ node = "tip" }}, bushing = [1e3, 1e3, 1e3, 1.0, 1.0, 1.0] }}]
            supports = [{{ at = "post", fix = "all" }}]
            loads = [{{ at = "tip", force = {f:?} }}]
            [[contacts]]
            name = "seat"
            surface = {{ shape = "box", center = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0] }}
            with = "tip"
            radius = 0.1
            stiffness = 1e5
            "#
        );
        let done = go(&text, &mut |frame| frame.state.nodes[0].x.iter().copied().collect());
        let x = done.rows.last().unwrap();
        let moved: Vec<f64> = (0..3).map(|i| at[i] - x[i]).collect();
        for i in 0..3 {
            // Spring of the guide and contact side by side; the iteration ends at 1e-8.
            assert!((moved[i] - n[i] / length * 30.0 / 1.01e5).abs() < 1e-11, "{corner:?}: {moved:?}");
        }
    }
}

/// A beam laid over a sphere between its nodes: what the sphere bears is what bends the beam, F = 48 EI w/L³ for its middle.
#[test]
fn a_beam_over_a_sphere_between_its_nodes() {
    for (elements, points, x) in [(9, 1, 0.5), (5, 3, 0.3)] {
        let text = format!(
            r#"
            analysis = {{ kind = "static", end_time = 1.0, time_step = 0.25 }}
            materials = {{ soft = {{ model = "elastic", youngs_modulus = 2e9, poisson_ratio = 0.0, density = 1.0 }} }}
            sections = {{ square = {{ shape = "rectangle", width = 0.02, height = 0.02 }} }}
            points = {{ left = [0.0, 0.0, 0.11], right = [1.0, 0.0, 0.11] }}
            beams = [{{ name = "beam", path = ["left", "right"], elements = {elements}, order = 3, material = "soft", section = "square", orientation = [0.0, 1.0, 0.0] }}]
            supports = [
                {{ at = "left", fix = ["ux", "uy", "rx", "rz"], motion = {{ uz = {{ amplitude = "down", scale = -0.001 }} }} }},
                {{ at = "right", fix = ["uy", "rx", "rz"], motion = {{ uz = {{ amplitude = "down", scale = -0.001 }} }} }},
            ]
            amplitudes = {{ down = {{ kind = "ramp", end = 1.0 }} }}
            expect = [{{ at = "seat", quantity = "force", time = 1.0, at_least = 0.0 }}]
            [[contacts]]
            name = "seat"
            surface = {{ shape = "sphere", center = [{x:?}, 0.0, 0.0], radius = 0.1 }}
            with = "beam"
            stiffness = 1e6
            points = {points}
            "#
        );
        let done = go(&text, &mut |frame| {
            frame.derived.contacts.iter().flat_map(|c| [c.f.z, c.gap, c.touching as f64]).collect()
        });
        let [f, gap, touching] = done.rows.last().unwrap()[..] else { panic!("one contact") };
        let (EI, EA, L, a) = (2e9 * 0.02f64.powi(4) / 12.0, 2e9 * 4e-4, 1.0, x);
        let b = L - a;
        // Bending and shear (5/6 of the area, G = E/2) of a beam on two supports, w under the force.
        let flexibility = a * a * b * b / (3.0 * EI * L) + a * b / L / (5.0 / 6.0 * 0.5 * EA);
        let exact = -(0.001 + gap) / flexibility;
        println!("{elements} elements: {f:.4} for {exact:.4}, {touching} touching, gap {gap:.2e}");
        assert!(touching == 1.0 && (f + 1e6 * -gap).abs() < 1e-6 * f.abs().max(1.0), "{f} {gap}");
        // The element's own bending under a force between its nodes, h³/192 EI at most, is only partly in its shape.
        let h: f64 = L / f64::from(elements);
        let missed = h.powi(3) / (192.0 * EI) / flexibility;
        assert!((f / exact - 1.0).abs() < missed, "{f} {exact} {missed}");
    }
}

/// Pressed by 30 and pulled by 20 along a guide of 1e3 with a friction of 0.5: 15 of it rub, the guide bears the rest.
#[test]
fn friction_holds_in_statics_too() {
    let text = r#"
        analysis = { kind = "static", end_time = 2.0, time_step = 0.1 }
        points = { tip = [0.0, 0.0, 0.0], post = [0.0, 0.0, 1.0] }
        masses = [{ at = "tip", mass = 1.0 }]
        links = [{ name = "guide", from = { node = "post" }, to = { node = "tip" }, bushing = [1e3, 1e3, 1.0, 1.0, 1.0, 1.0] }]
        supports = [{ at = "post", fix = "all" }]
        loads = [
            { at = "tip", force = [0.0, 0.0, -30.0], amplitude = "press" },
            { at = "tip", force = [20.0, 0.0, 0.0], amplitude = "pull" },
        ]
        amplitudes = { press = { kind = "table", points = [[0.0, 0.0], [1.0, 1.0], [2.0, 1.0]] }, pull = { kind = "table", points = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]] } }
        [[contacts]]
        name = "seat"
        surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
        with = "tip"
        stiffness = 1e5
        friction = 0.5
    "#;
    let done = go(text, &mut |frame| {
        let e = frame.derived.energy.expect("energies");
        vec![frame.state.nodes[0].x.x, e.friction, e.numerical]
    });
    let [x, friction, numerical] = done.rows.last().unwrap()[..] else { panic!("three numbers") };
    let N = 30.0 * 1e5 / (1e5 + 1.0); // the guide bears a little of it
    assert!((x - (20.0 - 0.5 * N) / 1e3).abs() < 1e-10, "{x}");
    // Slip is the way less the stretch of the spring, under 15 N. The step in which it begins counts the mean of the pulls at its
    // ends, 1.1 N apart, over 8.5e-4: 4.8e-4; as the work of the loads does, so that the balance closes to round-off.
    assert!((friction - 0.5 * N * (x - 0.5 * N / 1e5)).abs() < 6e-4, "{friction}");
    assert!(numerical.abs() < 1e-9, "{numerical}");
}

/// A die thrown on a floor tumbles, slides and comes to rest on a face; energy only goes.
#[test]
fn a_die_comes_to_rest_on_a_face() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 1.5, time_step = 5e-4 }
        environment = { gravity = [0.0, 0.0, -10.0] }
        bodies = [{ name = "die", center = [0.0, 0.0, 0.6], shape = { kind = "box", size = [0.2, 0.2, 0.2] }, mass = 1.0, velocity = [0.7, 0.2, 0.0], angular_velocity = [3.0, 5.0, 1.0] }]
        [[contacts]]
        name = "floor"
        surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
        with = "die"
        stiffness = 1e5
        restitution = 0.4
        friction = 0.4
    "#;
    let done = go(text, &mut |frame| {
        let e = frame.derived.energy.expect("energies");
        vec![frame.state.nodes[0].x.z, e.numerical, e.friction + e.impact, e.kinetic]
    });
    let least = done.rows.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
    let last = done.rows.last().unwrap();
    // Half an edge less m g/4k = 2.5e-5.
    assert!((last[0] - 0.099975).abs() < 1e-6 && last[3] < 1e-6, "{last:?}");
    // It began with 5 J above the floor; the scheme takes some thousandths of that and gives nothing.
    assert!(least > -1e-3 && last[1] < 0.05 && (last[2] - 5.39).abs() < 0.05, "{least} {last:?}");
}
