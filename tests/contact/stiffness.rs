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
    for step in ["1e-4", "5e-5", "2.5e-5", "1.25e-5", "6.25e-6"] {
        let text = leg(step);
        let element = 0.3f64.hypot(0.484) / 4.0;
        let exact = 2.1e11 * 9e-4 / element;
        // Round-off of some products.
        assert!((stiffness(&read(&text)) / exact - 1.0).abs() < 1e-12, "{step}");
        let done = go(&text, &mut |frame| vec![frame.derived.energy.expect("energies").plastic]);
        works.push(done.rows.last().expect("a row")[0]);
    }
    println!("plastic work {works:?}");
    // Impacts that the steps hardly resolve leave order one: a halved step has at most three quarters of the distance to the finest run.
    let error: Vec<f64> = works[..4].iter().map(|work| (work - works[4]).abs()).collect();
    assert!(error.windows(2).all(|pair| pair[1] < 0.75 * pair[0]), "{works:?}");
    assert!(works[4] > 100.0 && error[3] < 0.02 * works[4], "{works:?}");
}

/// A rod of 1 m flies on a wall at 1 m/s.
fn rod(elements: usize, part: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 3e-4, time_step = {:?} }}
        integrator = {{ scheme = "newmark" }}
        output = {{ contacts = true }}
        materials = {{ steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 8000.0 }} }}
        sections = {{ square = {{ shape = "rectangle", width = 0.02, height = 0.02 }} }}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0] }}
        {part}
        initial = [{{ at = "rod", velocity = [-1.0, 0.0, 0.0] }}]
        [[contacts]]
        name = "wall"
        surface = {{ shape = "plane", point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }}
        with = "a"
        "#,
        2e-5 / elements as f64
    )
}

/// A wave leaves the struck end and presses it by E A v/c until it comes back from the other, at 2 L/c = 0.4 ms: Saint-Venant's blow. A
/// spring of E A/h builds that up within some h/c.
#[test]
fn a_blow_on_the_end_of_a_rod_has_the_force_of_its_wave() {
    let beam = |elements: usize, more: &str| {
        format!(
            r#"beams = [{{ name = "rod", path = ["a", "b"], elements = {elements}, material = "steel", section = "square", orientation = [0.0, 1.0, 0.0]{more} }}]"#
        )
    };
    let parts = [(10, beam(10, "")), (40, beam(40, "")), (10, beam(10, ", order = 2"))];
    for (elements, part) in parts {
        let done = go(&rod(elements, &part), &mut |frame| {
            vec![frame.state.time, frame.derived.contacts.first().map_or(0.0, |contact| contact.f.x)]
        });
        let times = done.rows.iter().filter(|row| row[0] > 1e-4 && row[0] < 3e-4);
        let forces: Vec<f64> = times.map(|row| -row[1]).collect();
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let swing = forces.iter().map(|force| (force / mean - 1.0).abs()).fold(0.0, f64::max);
        println!("{elements}: {mean} ± {swing}");
        // The mass lumped at nodes rings behind the front, by a twentieth of the force; on average over its periods next to nothing is left.
        assert!((mean / 16000.0 - 1.0).abs() < 0.01 && swing < 0.08, "{elements}: {mean} ± {swing}");
    }
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
