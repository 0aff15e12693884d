//! The stiffness that the program chooses: by what touches, not by the step.

use super::go;
use crate::support::read_deck as read;
use rdsolve::model::{Contact, Model};

fn stiffness(model: &Model) -> f64 {
    let contact = model.each::<Contact>().next().expect("a contact");
    assert!(contact.chosen.is_some());
    contact.law.expect("it acts").stiffness
}

/// A leg with a foot is thrown on the floor and yields.
fn leg(step: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.008, time_step = {step} }}
        environment = {{ gravity = [0.0, 0.0, -9.81] }}
        materials = {{ steel = {{ model = "elastic-plastic", youngs_modulus = 2.1e11, poisson_ratio = 0.3, density = 7850.0, yield_stress = 2.5e8, hardening_modulus = 1e9 }} }}
        sections = {{ square = {{ shape = "rectangle", width = 0.03, height = 0.03 }} }}
        points = {{ heel = [0.0, 0.0, 0.016], hip = [0.3, 0.0, 0.5] }}
        beams = [{{ name = "leg", path = ["heel", "hip"], elements = 4, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0] }}]
        masses = [{{ at = "hip", mass = 20.0 }}]
        initial = [{{ at = "leg", velocity = [0.0, 0.0, -12.0] }}]
        [[contacts]]
        name = "floor"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
        with = "leg"
        "#
    )
}

#[test]
fn the_stiffness_chosen_is_that_of_the_part_whatever_the_step() {
    let mut works = Vec::new();
    for step in ["1e-4", "5e-5", "2.5e-5", "1.25e-5"] {
        let text = leg(step);
        let extent = 0.3f64.hypot(0.484);
        let exact = 2.1e11 * 9e-4 / extent;
        // Round-off of some products.
        assert!((stiffness(&read(&text)) / exact - 1.0).abs() < 1e-12, "{step}");
        let done = go(&text, &mut |frame| vec![frame.derived.energy.expect("energies").plastic]);
        works.push(done.rows.last().expect("a row")[0]);
    }
    println!("plastic work {works:?}");
    let change: Vec<f64> = works.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    // Impacts that the steps hardly resolve leave an order near one: each change is less than three quarters of the one before.
    assert!(change[1] < 0.75 * change[0] && change[2] < 0.75 * change[1], "{works:?}");
    assert!(works[3] > 100.0 && change[2] < 0.02 * works[3], "{works:?}");
}

/// Two bodies alone: by the speed at which they meet, or by their weight; automatic steps find the same.
#[test]
fn bodies_choose_by_speed_and_weight() {
    let ball = |step: &str, gravity: f64, velocity: f64, height: f64| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.1, {step} }}
            environment = {{ gravity = [0.0, 0.0, -{gravity:?}] }}
            bodies = [{{ name = "ball", center = [0.0, 0.0, {:?}], shape = {{ kind = "sphere", radius = 0.1 }}, mass = 2.0, velocity = [0.0, 0.0, {velocity:?}] }}]
            [[contacts]]
            name = "floor"
            surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}
            with = "ball"
            "#,
            0.1 + height
        )
    };
    let cases = [
        // m (v/ 0.01 d)², with v² = v0² + 2 g h.
        (10.0, -3.0, 0.35, 2.0 * (9.0 + 7.0) / 4e-6),
        (0.0, -3.0, 0.35, 2.0 * 9.0 / 4e-6),
        // m g over 0.001 d.
        (10.0, 0.0, 0.0, 2.0 * 10.0 / 2e-4),
    ];
    for (gravity, velocity, height, exact) in cases {
        for step in ["time_step = 1e-3", "time_step = 1e-5", "time_step = \"auto\""] {
            let found = stiffness(&read(&ball(step, gravity, velocity, height)));
            // Round-off of positions of some decimals, over a gap.
            assert!((found / exact - 1.0).abs() < 1e-9, "{step}: {found} for {exact}");
        }
    }
}
