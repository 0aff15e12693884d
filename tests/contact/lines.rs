//! Beams and bars that touch each other by their radius: bars that cross, a beam that slides along another, what lands on a beam.

use super::go;
use crate::support::run_with_warnings;
use rdsolve::solve::{Frame, Outcome};

const SCHEMES: [&str; 3] = [
    r#"scheme = "newmark""#,
    r#"scheme = "generalized-alpha", spectral_radius = 0.9"#,
    r#"scheme = "central-difference""#,
];

/// Two bars of 4 kg across each other, rigid or not, one of which falls on the other at 2 m/s, so much beside the middle of both.
fn crossed(scheme: &str, dt: f64, [along, aside]: [f64; 2], rigid: bool, contact: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.02, time_step = {dt} }}
        integrator = {{ {scheme} }}
        output = {{ energy = true, contacts = true, every = 1 }}
        materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
        sections.round = {{ shape = "tube", radius = 0.0127, thickness = 0.0127 }}
        [points]
        a = [-0.5, 0.0, 0.0]
        b = [0.5, 0.0, 0.0]
        c = [{along}, {}, 0.03]
        d = [{along}, {}, 0.03]
        [[beams]]
        name = "lower"
        path = ["a", "b"]
        elements = 5
        material = "steel"
        section = "round"
        orientation = [0.0, 0.0, 1.0]
        rigid = {rigid}
        [[beams]]
        name = "upper"
        path = ["c", "d"]
        elements = 5
        material = "steel"
        section = "round"
        orientation = [0.0, 0.0, 1.0]
        rigid = {rigid}
        [[initial]]
        at = "upper"
        velocity = [0.0, 0.0, -2.0]
        [[contacts]]
        name = "hit"
        surface = {{ part = "lower" }}
        with = "upper"
        {contact}
        "#,
        aside - 0.5,
        aside + 0.5
    )
}

/// Energies, and the force of the contact on the upper bar.
fn watch(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let force = frame.derived.contacts.first().map_or(0.0, |contact| contact.f.z);
    vec![frame.state.time, e.mechanical, e.numerical, e.contact, -force, e.p.z]
}

/// Rigid bars that meet in their middles are two masses on a spring: v √(k m/2) at the most, for π √(m/2k), and the speed is handed on.
#[test]
fn bars_that_cross_rebound() {
    let (m, k, v) = (std::f64::consts::PI * 0.0127f64.powi(2) * 7850.0, 2e6, 2.0);
    for scheme in SCHEMES {
        let done = go(&crossed(scheme, 1e-5, [0.05, -0.04], true, "stiffness = 2e6"), &mut watch);
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        // Off the middles the mass that meets is less: 1/m + r²/J each, J = m L²/12 and what the section adds.
        let inertia = m * (1.0 / 12.0 + 0.0127f64.powi(2) / 4.0);
        let meeting = 1.0 / (2.0 / m + (0.05f64.powi(2) + 0.04f64.powi(2)) / inertia);
        let highest = done.rows.iter().map(|row| row[4]).fold(0.0, f64::max);
        let exact = v * (k * meeting).sqrt();
        // Of 280 samples an impact, the bars turning by a hundredth in it.
        assert!((highest / exact - 1.0).abs() < 2e-3, "{scheme}: {highest} {exact}");
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        assert!((last[1] / first[1] - 1.0).abs() < 1e-3 && last[3] == 0.0, "{scheme}: {last:?}");
        assert!((last[5] - first[5]).abs() < 1e-10 * first[5].abs(), "{scheme}: momentum {last:?}");
        let duration = done.rows.iter().filter(|row| row[4] > 0.0).count() as f64 * 1e-5;
        assert!((duration - std::f64::consts::PI * (meeting / k).sqrt()).abs() < 3e-5, "{scheme}: {duration}");
    }
}

/// Bars that bend keep their energy and momentum; restitution takes what is told.
#[test]
fn bars_that_bend_keep_their_energy() {
    for (scheme, contact) in SCHEMES
        .iter()
        .flat_map(|scheme| ["stiffness = 2e6", "stiffness = 2e6\nrestitution = 0.6"].map(|contact| (*scheme, contact)))
    {
        let dt = if scheme.contains("central") { 2e-6 } else { 1e-5 };
        let done = go(&crossed(scheme, dt, [0.23, 0.17], false, contact), &mut watch);
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        println!("{scheme} {contact:?}: {last:?}");
        let damped = scheme.contains("alpha");
        assert!(last[2].abs() < if damped { 2e-2 } else { 2e-3 } * first[1], "{scheme}: {last:?}");
        assert!((last[5] - first[5]).abs() < 1e-9 * first[5].abs(), "{scheme}: momentum {last:?}");
        let pressed = done.rows.iter().map(|row| row[3]).fold(0.0, f64::max);
        assert!(pressed > 0.05 * first[1], "{scheme}: {pressed}");
    }
}

/// A rigid bar slides along two straight beams of twenty elements, across them, under its weight and without friction: its speed and height do
/// not change by what it passes.
#[test]
fn nothing_is_felt_of_the_elements_of_a_straight_beam() {
    // It lies as deep as its weight presses it in, so that nothing swings.
    let weight = std::f64::consts::PI * 0.02f64.powi(2) * 1.0 * 7850.0 * 10.0;
    let z = 0.04 - 0.5 * weight / 1e5;
    for scheme in SCHEMES {
        let text = format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.5, time_step = 1e-3 }}
            integrator = {{ {scheme} }}
            output = {{ energy = true }}
            environment.gravity = [0.0, 0.0, -10.0]
            materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
            sections.round = {{ shape = "tube", radius = 0.02, thickness = 0.02 }}
            [points]
            a = [0.0, 0.0, 0.0]
            b = [2.0, 0.0, 0.0]
            c = [0.0, 1.0, 0.0]
            d = [2.0, 1.0, 0.0]
            e = [0.13, 0.0, {z:?}]
            f = [0.13, 1.0, {z:?}]
            [[beams]]
            name = "left"
            path = ["a", "b"]
            elements = 20
            material = "steel"
            section = "round"
            orientation = [0.0, 0.0, 1.0]
            rigid = true
            [[beams]]
            name = "right"
            path = ["c", "d"]
            elements = 20
            material = "steel"
            section = "round"
            orientation = [0.0, 0.0, 1.0]
            rigid = true
            [[supports]]
            at = ["left", "right"]
            fix = "all"
            [[beams]]
            name = "bar"
            path = ["e", "f"]
            elements = 1
            material = "steel"
            section = "round"
            orientation = [0.0, 0.0, 1.0]
            rigid = true
            [[initial]]
            at = "bar"
            velocity = [3.0, 0.0, 0.0]
            [[contacts]]
            name = "on_left"
            surface = {{ part = "left" }}
            with = "bar"
            stiffness = 1e5
            [[contacts]]
            name = "on_right"
            surface = {{ part = "right" }}
            with = "bar"
            stiffness = 1e5
            "#
        );
        let done = go(&text, &mut |frame| {
            let bar = frame.model.bodies.iter().find(|body| body.name == "bar").expect("the bar").node;
            let node = &frame.state.nodes[bar];
            vec![node.v.x, node.x.z, node.x.x]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        assert!(done.rows.last().unwrap()[2] > 1.6, "{scheme}: it has not come over most of the elements");
        for row in &done.rows {
            // Of 98 N that hold it, rounding leaves 1e-14, and the iteration 1e-8.
            assert!((row[0] - 3.0).abs() < 1e-8 && (row[1] - z).abs() < 1e-10, "{scheme}: {row:?}");
        }
    }
}

/// A ball on a beam, bodies' points and a rope of bars over it: what touches lines need not be lines. And a beam that comes round touches itself.
#[test]
fn a_ball_lands_on_a_beam() {
    for scheme in SCHEMES {
        let text = format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.02, time_step = 1e-5 }}
            integrator = {{ {scheme} }}
            output = {{ energy = true }}
            materials.steel = {{ model = "elastic", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}
            sections.round = {{ shape = "tube", radius = 0.02, thickness = 0.02 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0] }}
            bodies = [{{ name = "ball", center = [0.43, 0.02, 0.09], shape = {{ kind = "sphere", radius = 0.06 }}, mass = 3.0, velocity = [0.0, 0.0, -2.0] }}]
            [[beams]]
            name = "beam"
            path = ["a", "b"]
            elements = 1
            material = "steel"
            section = "round"
            orientation = [0.0, 0.0, 1.0]
            rigid = true
            [[contacts]]
            name = "hit"
            surface = {{ part = "beam" }}
            with = "ball"
            stiffness = 1e6
            "#
        );
        let done = go(&text, &mut watch);
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        let pressed = done.rows.iter().map(|row| row[3]).fold(0.0, f64::max);
        assert!(
            (last[1] / first[1] - 1.0).abs() < 1e-3 && pressed > 0.3 * first[1] && last[3] == 0.0,
            "{scheme}: {last:?}"
        );
    }
}

/// Bars that fall on each other side by side are warned of, at 3 degrees; such as cross at 30 are not.
#[test]
fn bars_side_by_side_are_said() {
    for (degrees, warned) in [(3.0f64, true), (30.0, false)] {
        let (s, c) = degrees.to_radians().sin_cos();
        let text = crossed("scheme = \"newmark\"", 1e-5, [0.0, 0.0], true, "stiffness = 1e6")
            .replace("end_time = 0.02", "end_time = 0.01")
            .replace("c = [0, -0.5, 0.03]", &format!("c = [{}, {}, 0.03]", -0.5 * c, -0.5 * s))
            .replace("d = [0, 0.5, 0.03]", &format!("d = [{}, {}, 0.03]", 0.5 * c, 0.5 * s));
        let (outcome, said) = run_with_warnings(&text);
        assert!(matches!(outcome, Outcome::Done), "{outcome:?}");
        let found =
            said.iter().any(|said| said.contains("contact `hit`: beams, bars or edges press each other side by side"));
        assert_eq!(found, warned, "{degrees}: {said:?}");
    }
}

/// What lies across two rails of beams, bent here and there by a node, and its motion at t = 0; all of steel and rigid.
fn on_rails(scheme: &str, dt: f64, gravity: [f64; 3], bar: &str, rails: [[[f64; 2]; 2]; 2], more: &str) -> String {
    let [[a, b], [c, d]] = rails;
    let point = |name: &str, [x, y]: [f64; 2]| format!("{name} = [{x:?}, {y:?}, 0.0]\n");
    let rail = |name: &str, from: &str, to: &str| {
        format!(
            "[[beams]]\nname = \"{name}\"\npath = [\"{from}\", \"{to}\"]\nelements = 20\nmaterial = \"steel\"\nsection = \"round\"\n\
             orientation = [0.0, 0.0, 1.0]\nrigid = true\n[[contacts]]\nname = \"on_{name}\"\nsurface = {{ part = \"{name}\" }}\n\
             with = \"bar\"\nstiffness = 1e6\nfriction = 0.3\n"
        )
    };
    format!(
        "analysis = {{ kind = \"dynamic\", end_time = 0.5, time_step = {dt} }}\nintegrator = {{ {scheme} }}\noutput = {{ energy = true }}\n\
         environment.gravity = {gravity:?}\n\
         materials.steel = {{ model = \"elastic\", youngs_modulus = 200e9, poisson_ratio = 0.3, density = 7850.0 }}\n\
         sections.round = {{ shape = \"tube\", radius = 0.02, thickness = 0.02 }}\n\
         [points]\n{}{}{}{}{bar}\n{}{}[[supports]]\nat = [\"left\", \"right\"]\nfix = \"all\"\n{more}",
        point("a", a),
        point("b", b),
        point("c", c),
        point("d", d),
        rail("left", "a", "b"),
        rail("right", "c", "d"),
    )
}

/// A bar between two points, of so many elements.
fn bar(from: [f64; 3], to: [f64; 3], elements: usize) -> String {
    format!(
        "e = {from:?}\nf = {to:?}\n[[beams]]\nname = \"bar\"\npath = [\"e\", \"f\"]\nelements = {elements}\nmaterial = \"steel\"\n\
         section = \"round\"\norientation = [0.0, 0.0, 1.0]\nrigid = true\n"
    )
}

/// Time, velocity along x, place, dissipated by friction, numerical, mechanical energy.
fn slide(frame: &Frame) -> Vec<f64> {
    let e = frame.derived.energy.expect("energies");
    let bar = frame.model.bodies.iter().find(|body| body.name == "bar").expect("the bar").node;
    let node = &frame.state.nodes[bar];
    vec![frame.state.time, node.v.x, node.x.x, e.friction, e.numerical, e.mechanical]
}

/// Depth at which a bar of 9.86 kg a metre rests on two rails of stiffness 1e6, each with half of its weight.
fn sunk(length: f64) -> f64 {
    0.5 * std::f64::consts::PI * 0.02f64.powi(2) * length * 7850.0 * 10.0 / 1e6
}

const THROWN: &str = "[[initial]]\nat = \"bar\"\nvelocity = [3.0, 0.0, 0.0]\n";

/// A bar that may not turn slides over rails that run askew, and along itself over its own nodes: μ g slows it down, and heats.
#[test]
fn a_bar_that_is_dragged_over_others_slides_by_coulombs_law() {
    let z = 0.04 - sunk(1.0);
    let across = bar([0.1, 0.0, z], [0.1, 1.0, z], 3);
    let long = 0.04 - sunk(1.6f64.sqrt());
    let askew = bar([0.1, -0.1, long], [0.5, 1.1, long], 1);
    let along = bar([-1.5, 0.5, 0.04 - sunk(4.0)], [2.5, 0.5, 0.04 - sunk(4.0)], 40);
    let rails = [[[0.0, 0.2], [2.0, 0.3]], [[0.0, 0.9], [2.0, 0.6]]];
    let crossing = [[[0.0, -0.5], [0.3, 1.5]], [[1.0, 1.5], [0.9, -0.5]]];
    for scheme in SCHEMES {
        for (what, bar, rails) in [("across", &across, rails), ("askew", &askew, rails), ("along", &along, crossing)] {
            let held = format!("{THROWN}[[supports]]\nat = \"bar\"\nfix = [\"uy\", \"rx\", \"ry\", \"rz\"]\n");
            let text = on_rails(scheme, 1e-4, [0.0, 0.0, -10.0], bar, rails, &held);
            let done = go(&text, &mut slide);
            assert!(matches!(done.outcome, Outcome::Done), "{what} {scheme}: {:?}", done.outcome);
            let (first, last) = (&done.rows[0], done.rows.last().unwrap());
            println!("{what} {scheme}: {last:?}");
            // The springs of friction are stretched from the start. Half a step at the end, and what passing nodes leaves: 1e-4 of the speed.
            assert!((last[1] - (3.0 - 0.3 * 10.0 * 0.5)).abs() < 3e-4, "{what} {scheme}: {last:?}");
            assert!((last[3] / (first[5] - last[5]) - 1.0).abs() < 1e-3, "{what} {scheme}: {last:?} {first:?}");
            assert!(last[4].abs() < 1e-3 * first[5], "{what} {scheme}: {last:?}");
        }
    }
}

/// A round bar that slides over rails comes to roll, at two thirds of its speed; a third of its energy has become heat. On a slope it rolls from
/// the start, at two thirds of g sin α.
#[test]
fn a_log_on_rails_rolls() {
    let z = 0.04 - sunk(1.0);
    let log = bar([0.1, 0.0, z], [0.1, 1.0, z], 3);
    let rails = [[[0.0, 0.2], [2.0, 0.2]], [[0.0, 0.8], [2.0, 0.8]]];
    for scheme in SCHEMES {
        let done = go(&on_rails(scheme, 1e-4, [0.0, 0.0, -10.0], &log, rails, THROWN), &mut slide);
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        println!("{scheme}: {last:?}");
        // Elastic slip, μ N/k = 15e-6 m, swings on: 5e-4 m/s.
        assert!((last[1] - 2.0).abs() < 2e-3, "{scheme}: {last:?}");
        // The arm is the radius less half of the depth. What swings on keeps 1e-6 of the energy.
        let (mass, arm) = (std::f64::consts::PI * 0.02f64.powi(2) * 7850.0, z / 0.04);
        let heat = 0.5 * mass * 9.0 / (1.0 + 2.0 * arm * arm);
        assert!((last[3] / heat - 1.0).abs() < 1e-4, "{scheme}: {last:?} {heat}");
        assert!(last[4].abs() < 1e-3 * first[5], "{scheme}: {last:?}");

        let (s, c) = 0.2f64.sin_cos();
        let done = go(&on_rails(scheme, 1e-4, [10.0 * s, 0.0, -10.0 * c], &log, rails, ""), &mut slide);
        assert!(matches!(done.outcome, Outcome::Done), "{scheme}: {:?}", done.outcome);
        let last = done.rows.last().unwrap();
        println!("{scheme}: {last:?}");
        assert!((last[1] / (10.0 * s * 0.5 * 2.0 / 3.0) - 1.0).abs() < 3e-3, "{scheme}: {last:?}");
        assert!(last[3].abs() < 1e-3 * last[5].abs(), "{scheme}: {last:?}");
    }
}

/// A rope of bars half round a beam, 60 against 40 kg: with friction they go as Euler and Eytelwein say, or not at all.
#[test]
fn a_rope_over_a_beam_is_held_as_by_a_capstan() {
    for friction in [0.05f64, 0.1, 0.2] {
        // Damped along the rope, so that the weights do not swing on it for long.
        let sets = [format!("contacts.bearing.friction={friction}"), "damping.stiffness_factor=0.02".to_owned()];
        let model = crate::support::read("rope_over_beam", &sets);
        let done = crate::support::run_to_the_end(&model, &mut |frame| {
            let node = crate::support::node(frame.model, "r0");
            vec![frame.state.time, frame.state.nodes[node].v.z]
        });
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        let hold = (friction * std::f64::consts::PI).exp();
        let wanted = 9.81 * (60.0 - 40.0 * hold).max(0.0) / (60.0 + 40.0 * hold);
        let half = done.rows.iter().find(|row| row[0] > 0.2 - 1e-9).unwrap();
        let last = done.rows.last().unwrap();
        let found = (half[1] - last[1]) / (last[0] - half[0]);
        println!("{friction}: {found} {wanted}");
        // What is left of the swing at half of the time: 0.2 % of g, and of what friction takes a sixth of a per cent for 24 sides.
        assert!((found - wanted).abs() < 5e-3, "{friction}: {found} for {wanted}");
    }
}
