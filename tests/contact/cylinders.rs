//! Cylinders on planes, on boxes and on each other: they roll without a bump, stand, lie, and keep energy and momentum.

use super::touch::vector;
use super::{go, watch};
use crate::support::{read_deck, run_to_the_end};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rdsolve::elements::contact::convex::{ConvexPose, depth};
use rdsolve::math::convex::ConvexShape;
use rdsolve::math::cylinder::RoundCylinder;
use rdsolve::math::polyhedron::Polyhedron;
use rdsolve::math::rotation::{exp, matrix};
use rdsolve::math::{Mat3, Vec3};
use rdsolve::solve::Frame;
use std::sync::Arc;

/// D² over the square of the depth of a cylinder that lies in a face: twelve times the variance of height in a segment of a parabola, 8/35 − 4/25.
const LYING: f64 = 12.0 * (8.0 / 35.0 - 4.0 / 25.0);

fn cylinder(radius: f64, half: f64) -> ConvexShape {
    ConvexShape::Cylinder(Arc::new(RoundCylinder::new(radius, half, Mat3::identity())))
}

fn cuboid(half: Vec3) -> ConvexShape {
    ConvexShape::Polyhedron(Arc::new(Polyhedron::cuboid(half)))
}

/// On a face of a box, on a plane and on another cylinder of any radius: standing, lying, and flush with an edge.
#[test]
fn the_depth_of_a_cylinder_that_stands_or_lies_is_known() {
    let one = cylinder(0.3, 0.5);
    let lies = matrix(&exp(&Vec3::new(std::f64::consts::FRAC_PI_2, 0.0, 0.0)));
    let block = cuboid(Vec3::new(1.0, 1.0, 0.2));
    let narrow = cuboid(Vec3::new(0.3, 0.3, 0.2));
    let floor = ConvexShape::half_space(1.0);
    let drum = cylinder(0.7, 0.2);
    for spin in [0.0, 0.1, 1.0, 2.5] {
        let spin = matrix(&exp(&Vec3::new(0.0, 0.0, spin)));
        for (other, top) in [(&block, 0.2), (&narrow, 0.2), (&floor, 0.0), (&drum, 0.2)] {
            for deep in [1e-3, 1e-6] {
                let y = Vec3::new(0.0, 0.0, top + 0.5 - deep);
                let found = depth(&ConvexPose { y, Q: spin, own: &one, other }, 0.0).expect("they overlap");
                // The plate is thin: (δ/R)², and rounding of 1e-16 over δ.
                assert!((found.D / deep - 1.0).abs() < 1e-4, "{} for {deep}", found.D);
                let g = found.g;
                assert!((g[2] + 1.0).abs() < 1e-4 && g[0].abs() + g[1].abs() < 1e-6, "{g}");
            }
        }
        for (other, top) in [(&block, 0.2), (&floor, 0.0)] {
            for deep in [1e-3, 1e-6] {
                let y = Vec3::new(0.1, 0.2, top + 0.3 - deep);
                let found = depth(&ConvexPose { y, Q: lies * spin, own: &one, other }, 0.0).expect("they overlap");
                // The segment is one of a circle: δ/R of D.
                assert!((found.D / deep / LYING.sqrt() - 1.0).abs() < 0.3 * deep / 0.3 + 1e-8, "{}", found.D);
                // Nothing turns it about its own axis.
                let axis = lies * Vec3::z();
                assert!(Vec3::new(found.g[3], found.g[4], found.g[5]).dot(&axis).abs() < 1e-12, "{}", found.g);
            }
        }
    }
}

/// What two have in common, by random points: the depth from their variance.
#[test]
fn the_depth_is_that_of_the_solid_in_common() {
    let mut rng = StdRng::seed_from_u64(4);
    for k in 0..8 {
        let of_other = Vec3::from_fn(|_, _| rng.random_range(0.2..0.6));
        let length = rng.random_range(0.1..0.5);
        let (one, other) = (cylinder(0.3, length), cuboid(of_other));
        let Q = matrix(&exp(&vector(&mut rng, 2.0)));
        let way = vector(&mut rng, 1.0).normalize();
        let mut pose = ConvexPose { y: 0.9 * way, Q, own: &one, other: &other };
        while pose.least_axis().gap > -0.1 {
            pose.y -= 0.01 * way;
        }
        let (mut count, mut first, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
        // Points are drawn where the box meets a box about the cylinder.
        let reach = Vec3::repeat(0.3f64.hypot(length));
        let (low, high) = ((pose.y - reach).sup(&-of_other), (pose.y + reach).inf(&of_other));
        for _ in 0..300_000 {
            let x = (low + high) / 2.0 + ((high - low) / 2.0).component_mul(&vector(&mut rng, 1.0));
            if one.distance_from_core(&Q.tr_mul(&(x - pose.y))).0 <= 0.0 {
                count += 1.0;
                first += x;
                second += x * x.transpose();
            }
        }
        let mean = first / count;
        let S = second / count - mean * mean.transpose();
        let expected = (12.0 / S.try_inverse().expect("a solid").trace()).sqrt();
        let found = depth(&pose, 0.0).expect("they overlap");
        // More than ten thousand points fall inside: variances are known to a hundredth.
        assert!(count > 1e4, "{k}: {count} points");
        assert!((found.D / expected - 1.0).abs() < 0.015, "{k}: {} for {expected}, {count} points", found.D);
        assert!((found.c - mean).norm() < 5e-3, "{k}: {} for {mean}", found.c);
    }
}

fn scene(bodies: &str, contacts: &str, g: [f64; 3], end_time: f64, time_step: f64) -> String {
    format!(
        r#"
        analysis = {{ kind = "dynamic", end_time = {end_time}, time_step = {time_step} }}
        integrator = {{ scheme = "newmark" }}
        environment = {{ gravity = [{}, {}, {}] }}
        {bodies}
        {contacts}
        "#,
        g[0], g[1], g[2]
    )
}

const ON_PLANE: &str = "surface = { shape = \"plane\", point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }";
const ON_BOX: &str = "surface = { shape = \"box\", center = [0.0, 0.0, -0.5], size = [40.0, 4.0, 1.0] }";
const ON_DRUM: &str = "surface = { shape = \"cylinder\", center = [0.0, 0.0, -0.5], radius = 20.0, length = 1.0, axis = [0.0, 0.0, 1.0] }";

/// Down a slope of 0.1 it goes by 2/3 g sin α t²/2, on all of its side, as deep at any angle.
#[test]
fn a_drum_rolls_without_a_bump() {
    let (g, k, m) = (9.81, 1e7, 10.0);
    let (sine, cosine) = 0.1f64.sin_cos();
    for on in [ON_PLANE, ON_BOX, ON_DRUM] {
        let z = 0.2 - m * g * cosine / (4.0 * LYING * k);
        let drum = format!(
            "[[bodies]]\nname = \"drum\"\ncenter = [0.0, 0.0, {z}]\nmass = {m}\nshape = {{ kind = \"cylinder\", radius = 0.2, length = 0.5, axis = [0.3, 1.0, 0.0] }}"
        );
        let contact = format!(
            "[[contacts]]\nname = \"slope\"\n{on}\nwith = \"drum\"\nstiffness = {k}\nfriction = 0.5\ndamping = 100.0"
        );
        // Along the way across its axis.
        let across = Vec3::new(1.0, -0.3, 0.0).normalize();
        let pull = g * sine * across;
        let text = scene(&drum, &contact, [pull.x, pull.y, -g * cosine], 2.0, 2e-3);
        let done = go(&text, &mut |frame: &Frame| {
            let node = &frame.state.nodes[0];
            vec![frame.state.time, node.x.dot(&across), node.x.z, node.x.cross(&across).z, node.omega.norm()]
        });
        let v = g * sine * 2.0 / 3.0 * 2.0;
        for row in &done.rows {
            let way = g * sine / 3.0 * row[0] * row[0];
            // The spring of friction gives by 6.5 N/4e6 N/m and swings; the depth is that of a segment of a circle, δ/R of itself.
            assert!((row[1] - way).abs() < 2e-5 * (1.0 + way), "{on}: {} for {way} at {}", row[1], row[0]);
            // On the end of another cylinder it is a prism, which is softer by 0.4 % of the 3 µm that it lies deep.
            let left = if on == ON_DRUM { 2e-8 } else { 1e-8 };
            assert!((row[2] - z).abs() < left, "{on}: {} for {z} at {}", row[2], row[0]);
            assert!(row[3].abs() < 1e-9, "{on}: {} to the side at {}", row[3], row[0]);
        }
        let last = done.rows.last().expect("rows");
        // It has rolled by more than four turns.
        assert!((last[4] * 0.2 / v - 1.0).abs() < 1e-4, "{on}: {} for {}", last[4] * 0.2, v);
    }
}

/// It stands on its end as on four springs, and lies as on four times 0.82 of one.
#[test]
fn it_swings_on_its_springs() {
    let (k, m) = (1e5, 2.0);
    for (axis, height, stiffness) in [("[0.0, 0.0, 1.0]", 0.3, 4.0 * k), ("[1.0, 0.4, 0.0]", 0.2, 4.0 * LYING * k)] {
        for on in [ON_PLANE, ON_BOX] {
            let body = format!(
                "[[bodies]]\nname = \"drum\"\ncenter = [0.0, 0.0, {height}]\nmass = {m}\nshape = {{ kind = \"cylinder\", radius = 0.2, length = 0.6, axis = {axis} }}"
            );
            let contact = format!("[[contacts]]\nname = \"floor\"\n{on}\nwith = \"drum\"\nstiffness = {k}");
            let frequency = (stiffness / m).sqrt();
            let period = std::f64::consts::TAU / frequency;
            let text = scene(&body, &contact, [0.0, 0.0, -1.0], period, period / 400.0);
            let done = go(&text, &mut |frame: &Frame| vec![frame.state.time, frame.state.nodes[0].x.z]);
            for row in &done.rows {
                let exact = height - (1.0 - (frequency * row[0]).cos()) / (frequency * frequency);
                // (ω h)²/12 of the phase, 2e-5 · 2π, and δ/R = 1e-4.
                assert!((row[1] - exact).abs() * frequency * frequency < 5e-4, "{axis} {on}: {row:?} for {exact}");
            }
        }
    }
}

/// Thrown at a box, at another cylinder and at a capsule, turning, nothing is lost. They meet after 0.22 at the latest, for some 0.01.
#[test]
fn impacts_keep_energy_and_momentum() {
    let mut rng = StdRng::seed_from_u64(9);
    for k in 0..15 {
        let other = match k % 3 {
            0 => "kind = \"box\", size = [0.5, 0.6, 0.3]",
            1 => "kind = \"cylinder\", radius = 0.3, length = 0.4, axis = [0.2, 0.1, 1.0]",
            _ => "kind = \"capsule\", ends = [[0.0, -0.3, 0.0], [0.0, 0.3, 0.0]], radius = 0.2",
        };
        let (v, w, w2) = (vector(&mut rng, 0.3), vector(&mut rng, 3.0), vector(&mut rng, 3.0));
        let axis = vector(&mut rng, 1.0).normalize();
        let bodies = format!(
            r#"
            [[bodies]]
            name = "one"
            center = [0.0, 0.0, 1.0]
            mass = 2.0
            shape = {{ kind = "cylinder", radius = 0.2, length = {}, axis = [{}, {}, {}] }}
            velocity = [{}, {}, {}]
            angular_velocity = [{}, {}, {}]
            [[bodies]]
            name = "other"
            center = [0.0, 0.0, 0.0]
            mass = 3.0
            shape = {{ {other} }}
            angular_velocity = [{}, {}, {}]
            "#,
            rng.random_range(0.1..0.8),
            axis.x,
            axis.y,
            axis.z,
            v.x,
            v.y,
            v.z - 4.0,
            w.x,
            w.y,
            w.z,
            w2.x,
            w2.y,
            w2.z
        )
        .replace("center = [0.0, 0.0, 0.0]\n", if k % 3 == 2 { "\n" } else { "center = [0.0, 0.0, 0.0]\n" });
        let contact = "[[contacts]]\nname = \"blow\"\nsurface = { body = \"other\" }\nwith = \"one\"\nstiffness = 1e5";
        let text = scene(&bodies, contact, [0.0; 3], 0.3, 2.5e-5).replace("newmark", "central-difference");
        let done = go(&text, &mut watch);
        let (first, last) = (&done.rows[0], done.rows.last().expect("rows"));
        let most = done.rows.iter().map(|row| row[3]).fold(0.0, f64::max);
        assert!(most > 0.1, "{k}: they missed each other");
        // The scheme's own error falls with h² as the impacts of edges are resolved: up to 1e-3 at 1e-4, 4e-5 here, 1e-5 at half of it.
        // Of two cylinders one is a prism of fine sides, whose bulges leave some of it.
        let left = if k % 3 == 1 { 1e-3 } else { 1e-4 };
        assert!((last[1] - first[1]).abs() < left * most, "{k}: {} of {most}", last[1] - first[1]);
        for k in 5..8 {
            assert!((last[k] - first[k]).abs() < 1e-12, "momentum");
        }
        for k in 8..11 {
            // The scheme turns bodies with errors of its own, (ω h)².
            assert!((last[k] - first[k]).abs() < 1e-5, "angular momentum: {} {}", last[k], first[k]);
        }
    }
}

/// Three logs, two on the floor between posts and the third on both, without friction: it presses on each by W/√3, and these on the posts by W/2 tan 30°.
#[test]
fn three_logs_rest_on_each_other() {
    let (m, g, k) = (5.0, 10.0, 1e7);
    let log = |name: &str, x: f64, z: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [{x}, 0.0, {z}]\nmass = {m}\nshape = {{ kind = \"cylinder\", radius = 0.1, length = 1.0, axis = [0.0, 1.0, 0.0] }}\n"
        )
    };
    let bodies = log("left", -0.1, 0.1) + &log("right", 0.1, 0.1) + &log("top", 0.0, 0.1 + 0.03f64.sqrt());
    let contacts = format!(
        r#"
        [[contacts]]
        name = "logs"
        among = ["left", "right", "top"]
        stiffness = {k}
        damping = 2e3
        [[contacts]]
        name = "floor"
        {ON_PLANE}
        with = ["left", "right"]
        stiffness = {k}
        damping = 2e3
        [[contacts]]
        name = "post"
        surface = {{ shape = "box", center = [0.7, 0.0, 0.5], size = [1.0, 2.0, 2.0] }}
        with = "right"
        stiffness = {k}
        damping = 2e3
        [[contacts]]
        name = "other_post"
        surface = {{ shape = "box", center = [-0.7, 0.0, 0.5], size = [1.0, 2.0, 2.0] }}
        with = "left"
        stiffness = {k}
        damping = 2e3
        "#
    );
    let text = scene(&bodies, &contacts, [0.0, 0.0, -g], 0.5, 1e-3)
        .replace("environment", "output = { contacts = true }\nenvironment");
    let done = run_to_the_end(&read_deck(&text), &mut |frame: &Frame| {
        let forces = frame.derived.contacts.iter().flat_map(|contact| [contact.f.x, contact.f.z]);
        forces.chain(frame.state.nodes[..3].iter().map(|node| node.v.norm())).collect()
    });
    let last = done.rows.last().expect("rows");
    let speeds = &last[last.len() - 3..];
    // Damped with a time of some milliseconds.
    assert!(speeds.iter().all(|v| *v < 1e-6), "{last:?}");
    let (floor, post) = (last[3], last[4]);
    assert!((floor.abs() / (3.0 * m * g) - 1.0).abs() < 1e-4, "{floor}");
    // The lower two just touch; what all of them give, some 1e-5 of the radius, turns the force by as much.
    assert!((post.abs() / (0.5 * m * g * (1.0f64 / 3.0).sqrt()) - 1.0).abs() < 1e-2, "{post}: {last:?}");
}

/// A drum on the end of another, as large, smaller or larger, in either role: the pair tilts as a plate does, by D² = δ² + 3 θ² I/A with I/A = R²/4 of the
/// smaller, so that a small tilt about the middle has the stiffness 3 k R².
#[test]
fn drums_that_stand_on_each_other_tilt_as_plates_do() {
    for (own, other) in [(0.15, 0.15), (0.15, 0.3), (0.3, 0.15), (0.15, 0.150001)] {
        for off in [0.0, 1e-4] {
            let (one, below) = (cylinder(own, 0.2), cylinder(other, 0.1));
            let deep = 1e-4;
            let at = |tilt: f64| {
                let Q = matrix(&exp(&Vec3::new(tilt, 0.0, 0.0)));
                // About the middle of the end that stands.
                let y = Vec3::new(off, 0.0, 0.1 - deep) + Q * Vec3::new(0.0, 0.0, 0.2);
                depth(&ConvexPose { y, Q, own: &one, other: &below }, 0.0).expect("they overlap").D
            };
            let tilt = 1e-4;
            let stiffness = (at(tilt).powi(2) + at(-tilt).powi(2) - 2.0 * at(0.0).powi(2)) / (2.0 * tilt * tilt);
            let R = f64::min(own, other);
            // Of 32 sides, which lie as far out as the arcs on average, I/A is that of the round to 1e-3; the plate is bounded by two rims, `off` apart.
            assert!((stiffness / (0.75 * R * R) - 1.0).abs() < 5e-3, "{own} on {other}, {off}: {stiffness}");
        }
    }
}

/// Two logs that cross touch in a place, not along a line: a turn of the upper one about the axis of the lower moves it on, and the push goes along
/// the normal of the round there.
#[test]
fn logs_that_cross_push_along_their_normal() {
    let across = matrix(&exp(&Vec3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0)));
    for (own, other) in [(0.05, 0.5), (0.5, 0.05), (0.1, 0.1)] {
        let (one, below) = (cylinder(own, 1.0), cylinder(other, 1.0));
        // The lower one lies along its third axis, turned to lie along the second of the scene by the pose.
        for angle in [0.0, 0.2, 0.5] {
            for along in [0.0, 0.4] {
                let n = Vec3::new(f64::sin(angle), f64::cos(angle), 0.0);
                let Q = matrix(&exp(&Vec3::new(0.0, 0.0, -angle))) * across;
                let axis = Q * Vec3::z();
                let deep = 1e-4;
                let y = (own + other - deep) * n + along * axis;
                let found = depth(&ConvexPose { y, Q, own: &one, other: &below }, 0.0).expect("they overlap");
                let push = -Vec3::new(found.g[0], found.g[1], found.g[2]);
                // The bulges of the prism, an hundredth of the depth over sides as wide as what they have in common.
                assert!(push.cross(&n).norm() < 1e-3 * push.norm(), "{own} on {other}, {angle}, {along}: {push}");
                assert!((found.c - (other - 0.5 * deep) * n).norm() < 1e-3 * own, "{}", found.c);
                // No force acts about the axis of the lower one, nor about that of the upper.
                let (f, m) = (push, -Vec3::new(found.g[3], found.g[4], found.g[5]));
                assert!((m + y.cross(&f)).z.abs() < 1e-12, "{}", (m + y.cross(&f)).z);
                assert!(m.dot(&axis).abs() < 1e-12, "{}", m.dot(&axis));
            }
        }
    }
}

/// Logs beside each other with flush ends, parallel to the last bits: rounding tears faces, and what is left of one is nothing.
#[test]
fn flush_logs_are_as_deep_as_they_are() {
    let mut rng = StdRng::seed_from_u64(5);
    let axes = |rng: &mut StdRng, size: f64| rdsolve::math::frame_along(&(Vec3::y() + vector(rng, size)).normalize());
    for k in 0..4000 {
        let (one, other) = (cylinder(0.1, 0.5), cylinder([0.1, 0.05, 0.3][k % 3], 0.5));
        let (ConvexShape::Cylinder(first), ConvexShape::Cylinder(second)) = (&one, &other) else { unreachable!() };
        let size = [1e-16, 7e-16, 2e-15, 1e-300][k / 3 % 4];
        let (A, B) = (axes(&mut rng, size), axes(&mut rng, size));
        let angle = if k % 2 == 0 { std::f64::consts::FRAC_PI_3 } else { rng.random_range(0.0..6.3) };
        let deep = [1e-3, 1.3e-6, 1e-8][k / 12 % 3];
        let apart = first.radius() + second.radius() - deep;
        let d = apart * Vec3::new(-angle.cos(), 0.0, angle.sin());
        let found = depth(&ConvexPose { y: A.tr_mul(&d), Q: A.tr_mul(&B), own: &other, other: &one }, 0.0);
        let D = found.expect("they overlap").D;
        // Between two rounds about 0.83 of it, by the variance of a lens.
        assert!(D > 0.75 * deep && D < 0.95 * deep, "{k}: {D} of {deep}");
    }
}

/// What just touches has a gap of zero, wherever two logs cross, lie beside each other or stand.
#[test]
fn the_gap_of_cylinders_is_exact() {
    let (one, other) = (cylinder(0.1, 1.2), cylinder(0.2, 3.0));
    let gap = |y: Vec3, turn: Vec3| {
        let pose = ConvexPose { y, Q: matrix(&exp(&turn)), own: &one, other: &other };
        (pose.distance(), pose.least_axis().gap)
    };
    let right = std::f64::consts::FRAC_PI_2;
    for apart in [1e-2, 1e-5, -1e-5, -1e-3] {
        for along in [0.0, 0.7, 2.0] {
            // Across, at any place along both; beside; on the end; and with the end of the one at the side of the other, off its middle.
            for (y, turn) in [
                (Vec3::new(0.3 + apart, 0.5, along), Vec3::new(right, 0.0, 0.0)),
                (Vec3::new(0.3 + apart, 0.0, along), Vec3::zeros()),
                (Vec3::new(0.05, 0.0, 4.2 + apart), Vec3::zeros()),
                (Vec3::new(1.4 + apart, 0.06, along), Vec3::new(0.0, right, 0.0)),
            ] {
                let (distance, least) = gap(y, turn);
                // An axis is level to 1e-12, over a length of 3.
                assert!((distance - apart).abs() < 1e-11 && (least - apart).abs() < 1e-11, "{y}: {distance} {least}");
            }
        }
    }
}
