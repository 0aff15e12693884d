//! Rigid parts in contact: they touch by half their thickness and between their nodes, as they do while they deform; and what parts share is as thick as
//! the thicker of them.

use super::go;
use rdsolve::solve::Frame;

fn sheet(rigid: bool, contact: &str) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 1.0, time_step = 1e-3 }}
        integrator = {{ scheme = "newmark" }}
        environment = {{ gravity = [0.0, 0.0, -10.0] }}
        materials.light = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 1000.0 }}
        points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0] }}
        [[shells]]
        name = "sheet"
        corners = ["a", "b", "c", "d"]
        elements = [3, 3]
        material = "light"
        thickness = 0.02
        rigid = {rigid}
        [[contacts]]
        name = "stop"
        with = "sheet"
        stiffness = 1e5
        damping = 1000.0
        {contact}
        "#
    )
}

fn end(text: &str) -> f64 {
    let done = go(text, &mut |frame: &Frame| {
        vec![frame.state.nodes.iter().map(|node| node.x.z).fold(f64::NEG_INFINITY, f64::max)]
    });
    done.rows.last().expect("rows")[0]
}

/// Half of its thickness above the plane, less what its weight of 200 N presses its 16 nodes in.
#[test]
fn a_rigid_sheet_rests_on_half_its_thickness() {
    let plane = "surface = { shape = \"plane\", point = [0.0, 0.0, -0.02], normal = [0.0, 0.0, 1.0] }";
    let z = end(&sheet(true, plane));
    // At rest to the tolerance of equilibria and what is left of its motion.
    assert!((z - (-0.01 - 200.0 / 16e5)).abs() < 1e-6, "{z}");
}

/// A ball of radius 0.1 below a place between its nodes, where `points` touch it.
#[test]
fn a_rigid_sheet_touches_between_its_nodes() {
    let ball = "surface = { shape = \"sphere\", center = [0.5, 0.5, -0.11], radius = 0.1 }\npoints = 5";
    let z = end(&sheet(true, ball));
    // One point of the lattice of 0.33/6 lies above its top.
    assert!((z - -200.0 / 1e5).abs() < 2e-4, "{z}");
}

/// The order of names does not matter: what two sheets share is as thick as the thicker of them.
#[test]
fn shared_nodes_are_as_thick_as_the_thicker_part() {
    let text = |with: &str| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 1e-3, time_step = 1e-3 }}
            materials.light = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 1000.0 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0], e = [2.0, 0.0, 0.0], f = [2.0, 1.0, 0.0] }}
            shells = [
                {{ name = "thin", corners = ["a", "b", "c", "d"], elements = [2, 2], material = "light", thickness = 0.02 }},
                {{ name = "thick", corners = ["b", "e", "f", "c"], elements = [2, 2], material = "light", thickness = 0.1 }},
            ]
            [[contacts]]
            name = "floor"
            surface = {{ shape = "plane", point = [0.0, 0.0, -1.0], normal = [0.0, 0.0, 1.0] }}
            with = {with}
            stiffness = 1e5
            "#
        )
    };
    let radii = |with: &str| {
        let model = crate::support::read_deck(&text(with));
        let contact = model.each::<rdsolve::model::Contact>().next().expect("a contact");
        let mut radii: Vec<(usize, f64)> = contact.points.iter().map(|point| (point.nodes[0], point.radius)).collect();
        radii.sort_unstable_by_key(|of| of.0);
        radii
    };
    let (one, other) = (radii("[\"thin\", \"thick\"]"), radii("[\"thick\", \"thin\"]"));
    assert_eq!(one, other);
    assert_eq!(one.iter().filter(|of| of.1 == 0.05).count(), 9, "the thick one and what it shares");
    assert_eq!(one.iter().filter(|of| of.1 == 0.01).count(), 6, "the rest");
}

/// A soft wire that hangs on a corner of a sheet says nothing of how stiff the contact of the sheet is.
#[test]
fn what_only_hangs_on_a_part_does_not_choose_its_stiffness() {
    let text = |wire: &str| {
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 1e-3, time_step = 1e-5 }}
            materials.steel = {{ model = "elastic", youngs_modulus = 2e11, poisson_ratio = 0.3, density = 7850.0 }}
            points = {{ a = [0.0, 0.0, 0.0], b = [1.0, 0.0, 0.0], c = [1.0, 1.0, 0.0], d = [0.0, 1.0, 0.0], far = [2.0, 2.0, 0.0] }}
            shells = [{{ name = "sheet", corners = ["a", "b", "c", "d"], elements = [2, 2], material = "steel", thickness = 0.01 }}]
            bodies = [{{ name = "ball", center = [0.5, 0.5, 0.2], mass = 1.0, shape = {{ kind = "sphere", radius = 0.1 }}, velocity = [0.0, 0.0, -1.0] }}]
            {wire}
            [[contacts]]
            name = "hit"
            surface = {{ part = "sheet" }}
            with = "ball"
            "#
        )
    };
    let stiffness = |wire: &str| {
        let model = crate::support::read_deck(&text(wire));
        model.each::<rdsolve::model::Contact>().next().expect("a contact").law.expect("a law").stiffness
    };
    let wire = "bars = [{ name = \"wire\", path = [\"c\", \"far\"], axial_stiffness = 1e3, mass = \"none\" }]\nmasses = [{ at = \"far\", mass = 1.0 }]";
    assert_eq!(stiffness(wire), stiffness(""));
}
