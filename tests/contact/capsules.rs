//! Capsules and spheres against boxes, hulls and each other: as stiff as they should be, rolling, stacked, and in a chain that whips.

use super::go;
use rdsolve::elements::contact::convex::{ConvexPose, depth};
use rdsolve::math::convex::{ConvexShape, Spherocylinder};
use rdsolve::math::polyhedron::Polyhedron;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::solve::Frame;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

fn round(half: Vec3, radius: f64) -> ConvexShape {
    ConvexShape::Spherocylinder(Spherocylinder { half, radius })
}

/// Along a face p/√2, on its end p/2, as a sphere p/2; across a line p √(6 (8/35 − 4/25)), of the strip under a parabola. The hull of the box
/// does what the box does, though the parts of its surface are found in another way.
#[test]
fn what_lies_stands_and_crosses_has_the_depth_it_should() {
    let block = Polyhedron::cuboid(Vec3::new(0.5, 0.5, 0.1));
    let hull = Polyhedron::hull(block.corners()).expect("a hull").0;
    let (turn, p) = (matrix(&exp(&Vec3::new(0.0, FRAC_PI_2, 0.0))), 1e-4);
    for block in [block, hull].map(|shape| ConvexShape::Polyhedron(Arc::new(shape))) {
        let at = |own: &ConvexShape, x: f64, Q: Mat3, height: f64| {
            let y = Vec3::new(x, 0.02, 0.1 + height - p);
            depth(&ConvexPose { y, Q, own, other: &block }, 0.0).expect("in touch")
        };
        let capsule = round(Vec3::new(0.3, 0.0, 0.0), 0.05);
        // Where it hangs over the edge what lies on the face counts; the round of its end adds a little.
        for (x, exact) in [(0.0, 1e-12), (0.4, 0.03)] {
            let lies = at(&capsule, x, Mat3::identity(), 0.05);
            assert!((lies.D / (p / 2f64.sqrt()) - 1.0).abs() < exact, "{}", lies.D / p);
            assert!((lies.g[2] + 0.5f64.sqrt()).abs() < exact, "{}", lies.g);
        }
        let stands = at(&capsule, 0.1, turn, 0.35);
        assert!((stands.D / (0.5 * p) - 1.0).abs() < 1e-12 && (stands.g[2] + 0.5).abs() < 1e-12, "{stands:?}");
        let sphere = at(&round(Vec3::zeros(), 0.05), 0.1, turn, 0.05);
        assert!((sphere.D / (0.5 * p) - 1.0).abs() < 1e-12 && (sphere.g[2] + 0.5).abs() < 1e-12, "{sphere:?}");
    }
    // The parabola is that of the osculating circles, p/r smaller than the rest.
    let (one, other) = (round(Vec3::new(0.3, 0.0, 0.0), 0.05), round(Vec3::new(0.0, 0.3, 0.0), 0.07));
    let y = Vec3::new(0.1, -0.2, 0.12 - p);
    let found = depth(&ConvexPose { y, Q: Mat3::identity(), own: &one, other: &other }, 0.0).expect("in touch");
    let crossed = (6.0f64 * (8.0 / 35.0 - 4.0 / 25.0)).sqrt();
    assert!((found.D / (crossed * p) - 1.0).abs() < 1e-3, "{}", found.D / p);
}

/// A capsule rolls down a block that is a surface: its centre gains g sin α/(1 + J/m r²); sliding without friction g sin α.
#[test]
fn it_rolls_down_a_block() {
    let (slope, r, half) = (0.3f64, 0.1, 0.2);
    let way = |friction: f64, surface: &str| {
        let text = format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 0.8, time_step = 1e-3 }}
            environment = {{ gravity = [{}, 0.0, {}] }}
            [[bodies]]
            name = "log"
            mass = 2.0
            shape = {{ kind = "capsule", ends = [[-3.0, -{half}, {r}], [-3.0, {half}, {r}]], radius = {r} }}
            [[contacts]]
            name = "ground"
            surface = {{ {surface} }}
            with = "log"
            stiffness = 1e6
            damping = 1000.0
            friction = {friction:?}
            "#,
            10.0 * slope.sin(),
            -10.0 * slope.cos()
        );
        go(&text, &mut |frame: &Frame| vec![frame.state.nodes[0].v.x]).rows.last().expect("a row")[0]
    };
    // The moment of inertia about its line: a cylinder and a ball by their volumes.
    let (straight, ball) = (2.0 * half, 4.0 / 3.0 * r);
    let J = (0.5 * straight + 0.4 * ball) / (straight + ball);
    let block = "shape = \"box\", center = [0.0, 0.0, -0.5], size = [10.0, 4.0, 1.0]";
    let hull = "shape = \"hull\", points = [[-5, -2, -1], [-5, -2, 0], [-5, 2, -1], [-5, 2, 0], [5, -2, -1], [5, -2, 0], [5, 2, -1], [5, 2, 0]]";
    let plane = "shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]";
    for surface in [block, hull, plane] {
        let (slides, rolls) = (way(0.0, surface), way(0.5, surface));
        println!("{slides} {rolls}");
        let free = 0.8 * 10.0 * slope.sin();
        assert!((slides / free - 1.0).abs() < 1e-9, "{slides} for {free}");
        // It is put down at t = 0 without its weight on the surface, and slips until that is there, milliseconds of the 0.8 s.
        assert!((rolls / (free / (1.0 + J)) - 1.0).abs() < 3e-3, "{rolls} for {}", free / (1.0 + J));
    }
}

/// A log on two others that are held: each bears half its weight, and pushes across by tan α of that, α that of the line between the axes; lying
/// parallel, end over end, and askew in its own plane.
#[test]
fn a_log_rests_on_two() {
    let scene = |shift: f64| {
        let log = |name: &str, x: f64, y: f64, z: f64| {
            let (a, b) = ([x, y - 0.5, z], [x, y + 0.5, z]);
            format!(
                "[[bodies]]\nname = \"{name}\"\nmass = 3.0\nshape = {{ kind = \"capsule\", ends = [{a:?}, {b:?}], radius = 0.1 }}\n"
            )
        };
        let z = 0.2 * (1.0f64 - 0.36).sqrt();
        format!(
            r#"
            analysis = {{ kind = "dynamic", end_time = 1.0, time_step = 1e-3 }}
            environment = {{ gravity = [0.0, 0.0, -10.0] }}
            output = {{ contacts = true }}
            supports = [{{ at = ["left", "right"], fix = "all" }}]
            {}{}{}
            [[contacts]]
            name = "on_left"
            surface = {{ body = "left" }}
            with = "top"
            stiffness = 1e5
            damping = 1000.0
            [[contacts]]
            name = "on_right"
            surface = {{ body = "right" }}
            with = "top"
            stiffness = 1e5
            damping = 1000.0
            "#,
            log("left", -0.12, 0.0, 0.0),
            log("right", 0.12, 0.0, 0.0),
            log("top", 0.0, shift, z)
        )
    };
    for shift in [0.0, 0.3] {
        let done = go(&scene(shift), &mut |frame| {
            frame.derived.contacts.iter().flat_map(|contact| [contact.f.x, contact.f.z]).collect()
        });
        let found = done.rows.last().expect("a row");
        println!("{found:?}");
        let (down, across) = (-15.0, 15.0 * 0.12 / 0.16);
        for (found, expected) in found.iter().zip([-across, down, across, down]) {
            // It lies some 1e-4 deeper than drawn, by which the lines turn.
            assert!((found / expected - 1.0).abs() < 3e-3, "{found} for {expected}");
        }
    }
}

/// A chain of capsules is thrown round a post and onto itself, without loss: the energy is kept within a thousandth of what the blows store.
#[test]
fn a_whipped_chain_keeps_its_energy() {
    let (mut bodies, mut joints, mut names) = (String::new(), String::new(), Vec::new());
    for k in 0..12 {
        let [a, b] = [k, k + 1].map(|k| 0.1 * f64::from(k));
        bodies += &format!(
            "[[bodies]]\nname = \"link_{k}\"\nmass = 0.1\nvelocity = [0.0, {:?}, 0.0]\nangular_velocity = [0.0, 0.0, 6.0]\nshape = {{ kind = \"capsule\", ends = [[{:?}, 0.0, 0.0], [{:?}, 0.0, 0.0]], radius = 0.015 }}\n",
            6.0 * 0.5 * (a + b),
            a + 0.015,
            b - 0.015
        );
        let from = match k {
            0 => "ground = [0.0, 0.0, 0.0]".to_owned(),
            _ => format!("body = \"link_{}\", point = [{a:?}, 0.0, 0.0]", k - 1),
        };
        joints += &format!(
            "[[joints]]\nname = \"j{k}\"\nkind = \"spherical\"\nfrom = {{ {from} }}\nto = {{ body = \"link_{k}\" }}\n"
        );
        names.push(format!("link_{k}"));
    }
    let text = format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = 0.6, time_step = 5e-5 }}
        integrator = {{ scheme = "central-difference" }}
        environment = {{ gravity = [0.0, 0.0, -3.0] }}
        output = {{ contacts = true }}
        {bodies}{joints}
        [[contacts]]
        name = "post"
        surface = {{ shape = "capsule", ends = [[0.2, 0.3, -1.0], [0.2, 0.3, 1.0]], radius = 0.05 }}
        with = {names:?}
        stiffness = 1e5
        [[contacts]]
        name = "itself"
        among = {names:?}
        stiffness = 1e5
        "#
    );
    let (mut most, mut touching) = (0.0f64, [0, 0]);
    let done = go(&text, &mut |frame| {
        let e = frame.derived.energy.expect("energies");
        most = most.max(e.contact);
        for (sum, contact) in touching.iter_mut().zip(&frame.derived.contacts) {
            *sum += contact.touching;
        }
        vec![e.mechanical - e.external]
    });
    let (first, last) = (&done.rows[0], done.rows.last().expect("a row"));
    println!("{first:?} {last:?} most {most} {touching:?}");
    assert!(most > 1.0 && touching[0] > 100 && touching[1] > 100, "{most} {touching:?}");
    // Some sixty steps an impact.
    assert!((last[0] - first[0]).abs() < 1e-3 * most, "{first:?} {last:?} of {most}");
}
