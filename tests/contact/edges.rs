//! Curved surfaces, rims, landings that a step hardly sees, and every scheme.

use super::go;
use crate::support::read_deck as read;
use rdsolve::solve::Frame;

fn energies(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    vec![e.mechanical, e.numerical, e.friction, e.impact, frame.state.nodes[0].x.z]
}

/// A wheel of radius 0.1 rides on a driven drum of radius 0.5 whose rims move at 5 m/s: it keeps turning at −50 rad/s for 80 turns.
#[test]
fn a_wheel_keeps_rolling_on_a_drum() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 10.0, time_step = 2e-3 }
        amplitudes = { on = { kind = "constant" } }
        supports = [
            { at = "drum", fix = ["ux", "uy", "uz", "rx", "rz"], motion = { ry = { amplitude = "on", scale = 10.0, history = "velocity" } } },
            { at = "wheel", fix = ["ux", "uy", "rx", "rz"] },
        ]
        loads = [{ at = "wheel", force = [0.0, 0.0, -100.0] }]
        [[bodies]]
        name = "drum"
        center = [0.0, 0.0, 0.0]
        mass = 10.0
        shape = { kind = "sphere", radius = 0.5 }
        [[bodies]]
        name = "wheel"
        center = [0.0, 0.0, 0.5999]
        mass = 1.0
        shape = { kind = "sphere", radius = 0.1 }
        angular_velocity = [0.0, -50.0, 0.0]
        [[contacts]]
        name = "rim"
        surface = { shape = "cylinder", body = "drum", axis = [0.0, 1.0, 0.0], radius = 0.5, length = 1.0 }
        with = "wheel"
        radius = 0.1
        stiffness = 1e6
        friction = 0.5
    "#;
    let done = go(text, &mut |frame| vec![frame.state.nodes[1].omega.y]);
    let end = done.rows.last().expect("a row")[0];
    println!("{end}");
    // The wheel is 0.1 mm inside the drum, of 100 mm: its lever is that much shorter.
    assert!((end + 50.0).abs() < 0.1, "{end}");
}

/// A block slides over the edge of a table, tips and falls, whatever face of the box is the nearest on the way.
#[test]
fn a_block_slides_off_a_table() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 1.0, time_step = 1e-3 }
        environment = { gravity = [0.0, 0.0, -10.0] }
        bodies = [{ name = "block", center = [0.2, 0.0, 0.6], mass = 2.0, shape = { kind = "box", size = [0.2, 0.2, 0.2] }, velocity = [2.0, 0.0, 0.0] }]
        [[contacts]]
        name = "table"
        surface = { shape = "box", center = [0.0, 0.0, 0.0], size = [1.0, 1.0, 1.0] }
        with = "block"
        friction = 0.2
    "#;
    let done = go(text, &mut energies);
    let end = done.rows.last().expect("a row");
    println!("{end:?}, {} cuts", done.counts.cuts);
    assert!(end[4] < 0.0, "it has fallen off: {end:?}");
    assert!(end[1].abs() < 0.04, "of 4 J: {end:?}"); // a hundredth: two corners that leave springs behind
}

/// A ball comes down from rest, or barely above the floor, in steps far longer than the impact: no energy comes from nothing, in
/// any scheme.
#[test]
fn long_steps_do_not_throw_a_ball() {
    for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3"] {
        for height in [0.002, 0.01] {
            let text = format!(
                r#"
                analysis = {{ kind = "dynamic", end_time = 2.0, time_step = 0.02 }}
                integrator = {{ scheme = "{scheme}" }}
                environment = {{ gravity = [0.0, 0.0, -10.0] }}
                bodies = [{{ name = "ball", center = [0.0, 0.0, {:?}], mass = 2.0, shape = {{ kind = "sphere", radius = 0.1 }} }}]
                [[contacts]]
                name = "floor"
                surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
                with = "ball"
                stiffness = 2e8
                restitution = 0.5
                "#,
                0.1 + height
            );
            let mut highest = 0.0f64;
            let done = go(&text, &mut |frame| {
                highest = highest.max(frame.state.nodes[0].x.z - 0.1);
                energies(frame)
            });
            let end = done.rows.last().expect("a row");
            println!("{scheme:18} {height}: highest {highest:.2e}, numerical {:.2e} J of {}", end[1], 20.0 * height);
            assert!(highest < 1.5 * height, "{scheme} {height}: {highest}");
        }
    }
}

/// A point without mass has no impacts, in statics as little as anything: the spring alone carries.
#[test]
fn what_has_no_mass_rests_on_its_spring() {
    let text = r#"
        analysis = { kind = "static", end_time = 1.0, time_step = 0.25 }
        points = { tip = [0.0, 0.0, 0.0], post = [0.0, 0.0, 1.0], far = [9.0, 0.0, 0.0] }
        links = [{ name = "guide", from = { node = "post" }, to = { node = "tip" }, bushing = [1e3, 1e3, 1.0, 1.0, 1.0, 1.0] }]
        supports = [{ at = ["post", "far"], fix = "all" }]
        masses = [{ at = "far", mass = 1.0 }]
        loads = [{ at = "tip", force = [0.0, 0.0, -1.0] }]
        [[contacts]]
        name = "seat"
        surface = { shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }
        with = "tip"
        stiffness = 1e5
        restitution = 0.5
    "#;
    let model = read(text);
    let tip = model.nodes.iter().position(|node| node.label == "tip").expect("a point");
    let done = go(text, &mut |frame| vec![frame.state.nodes[tip].x.z]);
    let exact = -1.0 / (1e5 + 1.0);
    let end = done.rows.last().expect("a row")[0];
    assert!((end / exact - 1.0).abs() < 1e-6, "{end} for {exact}"); // the tolerance of the iteration
}

/// A slab lands on a post in its middle, where it has no corner: all of it touches.
#[test]
fn a_slab_lands_between_its_corners() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 1.0, time_step = 1e-3 }
        environment = { gravity = [0.0, 0.0, -10.0] }
        damping = { mass_factor = 5.0 }
        bodies = [{ name = "slab", center = [0.0, 0.0, 0.2], mass = 2.0, shape = { kind = "box", size = [1.0, 1.0, 0.1] } }]
        [[contacts]]
        name = "post"
        surface = { shape = "box", center = [0.0, 0.0, 0.0], size = [0.2, 0.2, 0.2] }
        with = "slab"
        restitution = 0.3
    "#;
    let done = go(text, &mut energies);
    let end = done.rows.last().expect("a row");
    // It lies on the post, at 0.15, to the depth of its weight.
    assert!((end[4] - 0.15).abs() < 2e-3, "{end:?}");
}

/// A peg that stands still and touches a moving box needs nothing else to hold it.
#[test]
fn a_fixed_peg_stops_a_hammer() {
    let text = r#"
        analysis = { kind = "dynamic", end_time = 0.5, time_step = 1e-3 }
        points = { peg = [0.6, 0.0, 0.0] }
        supports = [{ at = "peg", fix = ["ux", "uy", "uz"] }]
        bodies = [{ name = "hammer", center = [0.0, 0.0, 0.0], mass = 2.0, shape = { kind = "box", size = [1.0, 0.2, 0.2] }, velocity = [1.0, 0.0, 0.0] }]
        [[contacts]]
        name = "blow"
        surface = { shape = "box", body = "hammer", center = [0.0, 0.0, 0.0], size = [1.0, 0.2, 0.2] }
        with = "peg"
        stiffness = 1e6
        restitution = 0.5
    "#;
    let model = read(text);
    let hammer = model.bodies[0].node;
    let done = go(text, &mut |frame| vec![frame.state.nodes[hammer].v.x]);
    let end = done.rows.last().expect("a row")[0];
    // As exact as an impact of 20 steps and more: see impact.rs.
    assert!((end + 0.5).abs() < 0.02, "{end}");
}
