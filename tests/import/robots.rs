//! Robots of URDF: motion against recursive equations written here, welded links, and files with faults.

use super::values::near;
use super::{reasons, refusals};
use crate::support;
use import::{ImportOptions, Imported, KeywordVerdict};
use rdsolve::diagnostic::Source;
use rdsolve::math::{Mat3, Vec3, rotation};
use rdsolve::model;
use rdsolve::text_file::Text;
use std::fmt::Write;

fn robot(text: &str) -> Imported {
    import::import_robot(&Text::new("a.urdf", text.as_bytes()), &ImportOptions::default())
}

/// A link and the joint that carries it, as numbers: origin, roll pitch yaw, axis; mass, centre, its roll pitch yaw, six moments.
struct Arm {
    origin: [f64; 3],
    angles: [f64; 3],
    axis: [f64; 3],
    mass: f64,
    center: [f64; 3],
    turn: [f64; 3],
    inertia: [f64; 6],
}

/// The file of a chain of links.
fn urdf(arms: &[Arm]) -> String {
    let mut text = String::from("<robot name=\"arm\">\n<link name=\"base\"/>\n");
    let three = |x: &[f64; 3]| format!("{} {} {}", x[0], x[1], x[2]);
    for (k, arm) in arms.iter().enumerate() {
        let parent = if k == 0 { "base".to_owned() } else { format!("link{k}") };
        let [xx, yy, zz, xy, xz, yz] = arm.inertia;
        let _ = write!(
            text,
            "<link name=\"link{0}\"><inertial><origin xyz=\"{1}\" rpy=\"{2}\"/><mass value=\"{3}\"/>\n\
             <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"{xy}\" ixz=\"{xz}\" iyz=\"{yz}\"/></inertial></link>\n\
             <joint name=\"joint{0}\" type=\"continuous\"><origin xyz=\"{4}\" rpy=\"{5}\"/><parent link=\"{parent}\"/>\n\
             <child link=\"link{0}\"/><axis xyz=\"{6}\"/></joint>\n",
            k + 1,
            three(&arm.center),
            three(&arm.turn),
            arm.mass,
            three(&arm.origin),
            three(&arm.angles),
            three(&arm.axis)
        );
    }
    text + "</robot>\n"
}

fn turned(angles: &[f64; 3]) -> Mat3 {
    let (sr, cr) = angles[0].sin_cos();
    let (sp, cp) = angles[1].sin_cos();
    let (sy, cy) = angles[2].sin_cos();
    // Yaw, pitch and roll multiplied out.
    Mat3::new(
        cy * cp,
        cy * sp * sr - sy * cr,
        cy * sp * cr + sy * sr,
        sy * cp,
        sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr,
        -sp,
        cp * sr,
        cp * cr,
    )
}

/// Moments in the joints for a motion by Newton and Euler, from the ground outwards and back; and the centre of the last link.
fn moments(arms: &[Arm], q: &[f64], rate: &[f64], second: &[f64]) -> (Vec<f64>, Vec3) {
    let (mut turn, mut x) = (Mat3::identity(), Vec3::zeros());
    let (mut w, mut wd, mut a) = (Vec3::zeros(), Vec3::zeros(), Vec3::new(0.0, 0.0, 9.81));
    let (mut of, mut center) = (Vec::new(), Vec3::zeros());
    for (k, arm) in arms.iter().enumerate() {
        let r = turn * Vec3::from(arm.origin);
        a += wd.cross(&r) + w.cross(&w.cross(&r));
        x += r;
        let frame = turn * turned(&arm.angles);
        let axis = frame * Vec3::from(arm.axis).normalize();
        wd += axis * second[k] + w.cross(&(axis * rate[k]));
        w += axis * rate[k];
        turn = rotation::matrix(&rotation::exp(&(axis * q[k]))) * frame;
        let c = turn * Vec3::from(arm.center);
        center = x + c;
        let [xx, yy, zz, xy, xz, yz] = arm.inertia;
        let own = turn * turned(&arm.turn);
        let inertia = own * Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * own.transpose();
        let force = (a + wd.cross(&c) + w.cross(&w.cross(&c))) * arm.mass;
        of.push((x, axis, center, force, inertia * wd + w.cross(&(inertia * w))));
    }
    let tau = (0..arms.len()).map(|k| {
        let (x, axis, ..) = of[k];
        of[k..].iter().map(|(_, _, at, force, moment)| axis.dot(&(moment + (at - x).cross(force)))).sum()
    });
    (tau.collect(), center)
}

/// Accelerations of the joints without any moment: columns of the mass matrix come from the moments for one acceleration each.
fn accelerations(arms: &[Arm], q: &[f64], rate: &[f64]) -> Vec<f64> {
    let n = arms.len();
    let at_rest = moments(arms, q, rate, &vec![0.0; n]).0;
    let mut rows: Vec<Vec<f64>> = (0..n).map(|_| vec![0.0; n + 1]).collect();
    for j in 0..n {
        let unit: Vec<f64> = (0..n).map(|k| f64::from(u8::from(k == j))).collect();
        let column = moments(arms, q, rate, &unit).0;
        (0..n).for_each(|i| rows[i][j] = column[i] - at_rest[i]);
    }
    (0..n).for_each(|i| rows[i][n] = -at_rest[i]);
    // The matrix is positive definite: elimination needs no pivots.
    for k in 0..n {
        for i in (0..n).filter(|i| *i != k) {
            let factor = rows[i][k] / rows[k][k];
            for j in k..=n {
                let more = factor * rows[k][j];
                rows[i][j] -= more;
            }
        }
    }
    (0..n).map(|i| rows[i][n] / rows[i][i]).collect()
}

/// The centre of the last link after a time, from rest, by the classical method of Runge and Kutta.
fn swung(arms: &[Arm], end: f64, steps: usize) -> Vec3 {
    let (n, h) = (arms.len(), end / steps as f64);
    let (mut q, mut rate) = (vec![0.0; n], vec![0.0; n]);
    let add = |x: &[f64], dx: &[f64], h: f64| -> Vec<f64> { x.iter().zip(dx).map(|(x, dx)| x + h * dx).collect() };
    for _ in 0..steps {
        let k1 = (rate.clone(), accelerations(arms, &q, &rate));
        let v2 = add(&rate, &k1.1, 0.5 * h);
        let k2 = (v2.clone(), accelerations(arms, &add(&q, &k1.0, 0.5 * h), &v2));
        let v3 = add(&rate, &k2.1, 0.5 * h);
        let k3 = (v3.clone(), accelerations(arms, &add(&q, &k2.0, 0.5 * h), &v3));
        let v4 = add(&rate, &k3.1, h);
        let k4 = (v4.clone(), accelerations(arms, &add(&q, &k3.0, h), &v4));
        for i in 0..n {
            q[i] += h / 6.0 * (k1.0[i] + 2.0 * k2.0[i] + 2.0 * k3.0[i] + k4.0[i]);
            rate[i] += h / 6.0 * (k1.1[i] + 2.0 * k2.1[i] + 2.0 * k3.1[i] + k4.1[i]);
        }
    }
    moments(arms, &q, &rate, &vec![0.0; n]).1
}

/// The centre of the last link after a time in a run of the imported deck.
fn computed(arms: &[Arm], end: f64, step: f64) -> Vec3 {
    let made = robot(&urdf(arms));
    assert_eq!(refusals(&made), [""; 0]);
    let times = format!("end_time = {end:?}\ntime_step = {step:?}\n[integrator]\nscheme = \"runge-kutta\"\n");
    let deck = made.deck.replace("end_time = 1.0\ntime_step = \"auto\"\n", &times);
    let source = Source::new("a.toml", deck.as_str(), &[]);
    let (model, said) = model::read(&source);
    let model = model.unwrap_or_else(|| panic!("{}\n{deck}", said[0].draw(&source, false)));
    let at = model.bodies.last().unwrap().node;
    let done = support::run_to_the_end(&model, &mut |frame| frame.state.nodes[at].x.as_slice().to_vec());
    Vec3::from_column_slice(done.rows.last().unwrap())
}

fn arm(origin: [f64; 3], angles: [f64; 3], axis: [f64; 3], mass: f64) -> Arm {
    Arm {
        origin,
        angles,
        axis,
        mass,
        center: [0.25, 0.02, -0.01],
        turn: [0.3, -0.5, 0.7],
        inertia: [0.02 * mass, 0.03 * mass, 0.04 * mass, 0.002 * mass, -0.001 * mass, 0.003 * mass],
    }
}

/// Both solutions converge: that of the deck by the fourth power of its step, so that 2 ms err by about 1e-8 m.
#[test]
fn a_chain_of_two_links() {
    let arms = [
        arm([0.1, 0.0, 0.5], [0.0, 0.0, 0.4], [0.0, 1.0, 0.0], 2.0),
        arm([0.5, 0.0, 0.0], [0.2, 0.0, -0.3], [0.0, 1.0, 0.0], 1.0),
    ];
    let error = (computed(&arms, 0.3, 2e-3) - swung(&arms, 0.3, 150)).norm();
    assert!(error < 1e-6, "{error:e}");
}

/// Six joints whose frames and moments of inertia all are turned.
#[test]
fn an_arm_of_six_joints() {
    let arms = [
        arm([0.0, 0.0, 0.3], [0.0, 0.0, 0.2], [0.0, 0.0, 1.0], 6.0),
        arm([0.1, 0.0, 0.2], [1.2, 0.1, 0.0], [0.0, 0.0, 1.0], 5.0),
        arm([0.5, 0.0, 0.0], [0.0, 0.4, -0.6], [0.0, 1.0, 0.0], 4.0),
        arm([0.4, 0.1, 0.0], [-0.5, 0.0, 1.0], [1.0, 0.0, 0.0], 3.0),
        arm([0.3, 0.0, 0.1], [0.0, -0.7, 0.3], [0.0, 1.0, 1.0], 2.0),
        arm([0.2, 0.0, 0.0], [0.9, 0.2, 0.1], [1.0, 0.0, 0.5], 1.0),
    ];
    let error = (computed(&arms, 0.2, 1e-3) - swung(&arms, 0.2, 100)).norm();
    assert!(error < 1e-6, "{error:e}");
}

const WELDED: &str = "<?xml version=\"1.0\"?>\n<robot name=\"r\">\n<link name=\"world\"/>\n\
    <link name=\"rod\"><inertial><mass value=\"2\"/><inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.25\"/></inertial>\n\
    <visual><geometry><box size=\"0.1 0.1 0.4\"/></geometry></visual></link>\n\
    <link name=\"weight\"><inertial><origin rpy=\"0 0 1.5707963267948966\"/><mass value=\"1\"/><inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.25\"/></inertial></link>\n\
    <joint name=\"slide\" type=\"prismatic\"><parent link=\"world\"/><child link=\"rod\"/><origin xyz=\"0 0 1\"/><axis xyz=\"0 0 1\"/>\n\
    <limit lower=\"-0.5\" upper=\"0.5\" effort=\"20\" velocity=\"1\"/><dynamics damping=\"3\" friction=\"4\"/></joint>\n\
    <joint name=\"weld\" type=\"fixed\"><parent link=\"rod\"/><child link=\"weight\"/><origin xyz=\"0.3 0 0\"/></joint>\n\
    <transmission name=\"t\"/>\n</robot>\n";

/// Welded links are one body: mass 3, its centre a third of the way, and 2/3 · 0.3² m² of the reduced mass across.
#[test]
fn welded_links_and_effects() {
    let made = robot(WELDED);
    assert_eq!(refusals(&made), [""; 0]);
    let value = |key: &str| made.deck.lines().find(|line| line.starts_with(key)).unwrap().to_owned();
    let numbers = |key: &str| -> Vec<f64> {
        value(key).split(['[', ']', ',', ' ']).filter_map(|word| word.parse().ok()).collect()
    };
    assert_eq!(value("mass"), "mass = 3.0");
    let across = 2.0 / 3.0 * 0.09;
    let inertia = numbers("inertia");
    for (at, wanted) in [(0, 0.3), (1, 0.3 + across), (2, 0.5 + across)] {
        near(inertia[at], wanted, 1e-12);
    }
    near(numbers("center")[0], 0.1, 1e-12);
    near(numbers("center")[2], 1.0, 1e-12);
    for wanted in [
        "limits = [-0.5, 0.5]\nlimit_stiffness = 20000.0\n",
        "damping = 3.0\nfriction_force = 4.0\n",
        "[points]\nweight = [0.3, 0.0, 1.0]\n",
        "from = { ground = [0.0, 0.0, 1.0] }\nto = { body = \"rod\" }\naxis = [0.0, 0.0, 1.0]\n",
    ] {
        assert!(made.deck.contains(wanted), "{wanted} is not in\n{}", made.deck);
    }
    let ignored = reasons(&made, KeywordVerdict::Ignored);
    assert!(ignored[0].contains("beside the centre of mass"), "{ignored:?}");
    assert!(ignored[1].starts_with("10 <transmission> t: drives are"), "{ignored:?}");
    // Another joint that follows with half of the way.
    let follower = "<link name=\"b\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link>\n\
                    <joint name=\"f\" type=\"prismatic\"><parent link=\"world\"/><child link=\"b\"/><mimic joint=\"slide\" multiplier=\"0.5\"/></joint>\n</robot>";
    let made = robot(&WELDED.replace("</robot>", follower));
    assert!(made.deck.contains("gear = { joint = \"slide\", ratio = 0.5 }\n"), "{}", made.deck);
    let drawn = robot(&WELDED.replace("xyz=\"0.3 0 0\"", "xyz=\"0 0 0\""));
    assert!(drawn.deck.contains("shape = { kind = \"hull\""), "{}", drawn.deck);
}

/// Faults of a file have their line.
#[test]
fn files_with_faults() {
    for (old, new, wanted) in [
        ("</robot>", "", "1 <robot>: the root node was opened but never closed"),
        ("mass value=\"2\"", "mass value=\"two\"", "4 <link> rod: value=\"two\" must be a number"),
        ("xyz=\"0 0 1\"/>\n", "xyz=\"0 0\"/>\n", "7 <joint> slide: xyz=\"0 0\" must be three numbers"),
        ("type=\"fixed\"", "type=\"glued\"", "9 <joint> weld: joints of type glued are not known"),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", "7 <joint> slide: the axis of a joint must not be zero"),
        ("<child link=\"weight\"/>", "<child link=\"ring\"/>", "the links `world` and `weight` hang on no joint"),
        ("<parent link=\"rod\"/>", "<parent link=\"ring\"/>", "9 <joint> weld: no link is named `ring`"),
        ("izz=\"0.25\"/></inertial>\n", "izz=\"9\"/></inertial>\n", "4 <link> rod: no body has this inertia"),
        ("<transmission name=\"t\"/>", "<xacro:macro/>", ""),
        ("<transmission name=\"t\"/>", "<macro name=\"t\"/>", "10 <macro> t: <macro> is not known"),
    ] {
        assert!(WELDED.contains(old), "{old}");
        let said = refusals(&robot(&WELDED.replacen(old, new, 1)));
        assert!(said.iter().any(|said| said.contains(wanted)), "{wanted} is not in {said:?}");
    }
    for text in ["", "<a/>", "<robot/>", "<robot><link name=\"a\"/></robot>", "\u{feff}"] {
        assert!(!refusals(&robot(text)).is_empty(), "{text}");
    }
    for end in (0..WELDED.len()).step_by(5) {
        robot(&WELDED[..end]);
    }
}
