//! Bodies with hardly any inertia about one axis, against the equations of their motion integrated here: every scheme has the error of
//! its order, whatever the ratio of the inertias.

use crate::support::{node, position, read_deck, run_to_the_end, slope, tables_of};
use rdsolve::math::{Vec3, rotation};

/// The classical Runge-Kutta scheme.
fn integrate<const N: usize>(
    mut y: [f64; N],
    end: f64,
    steps: usize,
    rate: impl Fn(&[f64; N]) -> [f64; N],
) -> [f64; N] {
    let h = end / steps as f64;
    let at = |y: &[f64; N], k: &[f64; N], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
    for _ in 0..steps {
        let k1 = rate(&y);
        let k2 = rate(&at(&y, &k1, 0.5 * h));
        let k3 = rate(&at(&y, &k2, 0.5 * h));
        let k4 = rate(&at(&y, &k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    y
}

/// A rod that hangs by a hinge from an arm that turns about the vertical: the place of its centre at t = 1 by Lagrange's equations of
/// the two angles.
fn hung_from_an_arm(own: f64) -> [f64; 3] {
    let [arm, mass, reach, half, across, g] = [0.1, 0.5, 0.4, 0.3, 0.015, 9.81];
    let rate = |&[_, swing, turning, swinging]: &[f64; 4]| {
        let (s, c) = swing.sin_cos();
        let away = reach - half * s;
        let inertia = arm + mass * away * away + across * s * s + own * c * c;
        let slope = -2.0 * mass * away * half * c + 2.0 * (across - own) * s * c;
        let falls = (0.5 * slope * turning * turning - mass * g * half * s) / (mass * half * half + across);
        [turning, swinging, -slope * swinging * turning / inertia, falls]
    };
    // 1e-4 by the fourth power.
    let [turn, swing, ..] = integrate([0.0, 0.0, 4.0, 0.0], 1.0, 10_000, rate);
    let away = reach - half * swing.sin();
    [away * turn.cos(), away * turn.sin(), -half * swing.cos()]
}

fn hung_rod(scheme: &str, own: f64, step: f64) -> [f64; 3] {
    let model = read_deck(&format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = {step:e}\n[integrator]\nscheme = \"{scheme}\"\n\
         [environment]\ngravity = [0.0, 0.0, -9.81]\n[output]\ninterval = 1.0\n\
         [[bodies]]\nname = \"arm\"\ncenter = [0.0, 0.0, 0.0]\nmass = 2.0\ninertia = [0.1, 0.1, 0.1]\nangular_velocity = [0.0, 0.0, 4.0]\n\
         [[bodies]]\nname = \"rod\"\ncenter = [0.4, 0.0, -0.3]\nmass = 0.5\ninertia = [0.015, 0.015, {own:?}]\n\
         velocity = [0.0, 1.6, 0.0]\nangular_velocity = [0.0, 0.0, 4.0]\n\
         [[joints]]\nname = \"shaft\"\nkind = \"revolute\"\naxis = [0.0, 0.0, 1.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
         to = {{ body = \"arm\" }}\n\
         [[joints]]\nname = \"hook\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\n\
         from = {{ body = \"arm\", point = [0.4, 0.0, 0.0] }}\nto = {{ body = \"rod\" }}\n"
    ));
    let rod = node(&model, "rod");
    let done = run_to_the_end(&model, &mut |frame| position(&frame.state.nodes[rod]).to_vec());
    let last = done.rows.last().expect("the end");
    [last[0], last[1], last[2]]
}

fn largest(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// In joints: with momenta in space, Wilson-θ was off by 0.5 m at a ratio of 7e-8 and generalized-α by 0.03 m.
#[test]
fn in_joints_no_ratio_of_inertias_matters() {
    let schemes =
        ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe", "esdirk3", "central-difference"];
    let stout = hung_from_an_arm(0.015);
    for scheme in schemes {
        let error_of_stout = largest(&hung_rod(scheme, 0.015, 4e-3), &stout);
        for ratio in [0.0, 1e-14, 1.1e-12, 1e-9, 7e-8, 1e-6, 1e-3, 0.03, 0.1] {
            if scheme == "central-difference" && ratio < 1e-12 {
                continue; // Explicit schemes refuse bodies without inertia.
            }
            let own = 0.015 * ratio;
            let error = largest(&hung_rod(scheme, own, 4e-3), &hung_from_an_arm(own));
            println!("{scheme:18} {ratio:8.1e} {error:.2e}, {error_of_stout:.2e} for a stout one");
            // The motion of a thin rod differs from that of a stout one, so that the errors do by half.
            assert!(error < 2.0 * error_of_stout, "{scheme}, ratio {ratio:e}: {error:e} for {error_of_stout:e}");
        }
    }
}

/// The order in the window in which runs were lost.
#[test]
fn in_joints_thin_rods_have_the_order_of_the_scheme() {
    let exact = hung_from_an_arm(1e-9);
    for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe"] {
        let points = [8e-3, 4e-3, 2e-3].map(|step| (step, largest(&hung_rod(scheme, 1e-9, step), &exact)));
        println!("{scheme:18} {points:?}, order {:.2}", slope(&points));
        assert!((1.8..2.2).contains(&slope(&points)), "{scheme}: {points:?}");
    }
}

/// A rod with spin about its axis whose end hangs on a spring, without joints: place of its centre and its angular velocity in axes of
/// the rod at t = 0.5, with Euler's equations for those and the quaternion of the rotation.
fn on_a_spring(J: [f64; 3]) -> [f64; 6] {
    let rate = |y: &[f64; 13]| {
        let R = rotation::matrix(&nalgebra::Quaternion::new(y[6], y[7], y[8], y[9]));
        let w = Vec3::new(y[10], y[11], y[12]);
        let arm = Vec3::new(0.0, 0.0, 0.3);
        let force = (Vec3::new(0.2, 0.1, 0.8) - Vec3::new(y[0], y[1], y[2]) - R * arm) * 40.0;
        let moment = arm.cross(&R.tr_mul(&force));
        let a = force / 0.5;
        let turned =
            nalgebra::Quaternion::new(y[6], y[7], y[8], y[9]) * nalgebra::Quaternion::new(0.0, w.x, w.y, w.z) * 0.5;
        let spun = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            ((J[j] - J[k]) * w[j] * w[k] + moment[i]) / J[i]
        };
        [y[3], y[4], y[5], a.x, a.y, a.z, turned.w, turned.i, turned.j, turned.k, spun(0), spun(1), spun(2)]
    };
    let start = [0.0, 0.0, 0.0, 0.3, -0.2, 0.1, 1.0, 0.0, 0.0, 0.0, 1.0, 2.0, 6.0];
    let y = integrate(start, 0.5, 5000, rate);
    [y[0], y[1], y[2], y[10], y[11], y[12]]
}

fn sprung_rod(scheme: &str, J: [f64; 3], step: f64) -> [f64; 6] {
    let model = read_deck(&format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.5\ntime_step = {step:e}\n[integrator]\nscheme = \"{scheme}\"\n\
         [output]\ninterval = 0.5\n\
         [[bodies]]\nname = \"rod\"\ncenter = [0.0, 0.0, 0.0]\nmass = 0.5\ninertia = [{:?}, {:?}, {:?}]\n\
         velocity = [0.3, -0.2, 0.1]\nangular_velocity = [1.0, 2.0, 6.0]\n\
         [points]\ntip = [0.0, 0.0, 0.3]\n[[attachments]]\nnodes = \"tip\"\nbody = \"rod\"\n\
         [[links]]\nname = \"spring\"\nfrom = {{ ground = [0.2, 0.1, 0.8] }}\nto = {{ node = \"tip\" }}\nstiffness = 40.0\n\
         free_length = 1e-9\n",
        J[0], J[1], J[2]
    ));
    let rod = node(&model, "rod");
    let done = run_to_the_end(&model, &mut |frame| {
        let now = &frame.state.nodes[rod];
        let own = now.R().tr_mul(&now.omega);
        vec![now.x.x, now.x.y, now.x.z, own.x, own.y, own.z]
    });
    let last = done.rows.last().expect("the end");
    std::array::from_fn(|i| last[i])
}

/// Without joints, with axes across that differ by half of the inertia about the rod: with momenta in space the spin was lost from a ratio
/// of 1e-3 on, by 16 rad/s with the trapezoidal rule.
#[test]
fn on_springs_no_ratio_of_inertias_matters() {
    for scheme in ["wilson-theta", "newmark", "hht-alpha", "generalized-alpha", "bathe"] {
        let errors = |ratio: f64| {
            let J = [0.015, 0.015 * (1.0 - 0.5 * ratio), 0.015 * ratio];
            let exact = on_a_spring(J);
            let error = |step: f64| {
                let found = sprung_rod(scheme, J, step);
                (step, found.iter().zip(exact).fold(0.0f64, |most, (a, b)| most.max((a - b).abs())))
            };
            [error(4e-3), error(2e-3)]
        };
        let stout = errors(0.1)[0].1;
        for ratio in [1e-11, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2, 0.05, 0.1] {
            let points = errors(ratio);
            println!("{scheme:18} {ratio:8.1e} {points:?} {:.2}", slope(&points));
            // Thin rods are thrown about more by the same spring.
            assert!(points[0].1 < 3.0 * stout, "{scheme}, ratio {ratio:e}: {points:?} for {stout:e}");
            // Wilson-θ at a ratio of 0.1 is at 1.73: terms of third order are a tenth of the error at 4e-3.
            assert!((1.7..2.2).contains(&slope(&points)), "{scheme}, ratio {ratio:e}: {points:?}");
        }
    }
}

/// A free rod that tumbles and spins, against the exact motion of a body of revolution: precession about its angular momentum, and spin about
/// its axis.
#[test]
fn free_rods_turn_with_third_order() {
    let (omega, end) = (Vec3::new(2.0, -1.0, 5.0), 2.0);
    for scheme in ["wilson-theta", "newmark", "bathe"] {
        for ratio in [0.0, 1e-14, 1e-12, 1e-10, 1e-9, 1e-6, 1e-3, 0.03, 0.3] {
            let momentum = Vec3::new(omega.x, omega.y, ratio * omega.z);
            let spin = Vec3::new(0.0, 0.0, (1.0 - ratio) * omega.z);
            let exact = rotation::matrix(&(rotation::exp(&(momentum * end)) * rotation::exp(&(spin * end))));
            let points = [0.02, 0.01].map(|step: f64| {
                let model = read_deck(&format!(
                    "[analysis]\nkind = \"dynamic\"\nend_time = {end:?}\ntime_step = {step:e}\n[integrator]\nscheme = \"{scheme}\"\n\
                     [iteration]\ntolerance = 1e-11\n[output]\ninterval = {end:?}\n\
                     [[bodies]]\nname = \"rod\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, {ratio:?}]\n\
                     angular_velocity = [{:?}, {:?}, {:?}]\n",
                    omega.x, omega.y, omega.z
                ));
                let rod = node(&model, "rod");
                let done = run_to_the_end(&model, &mut |frame| {
                    let now = &frame.state.nodes[rod];
                    vec![(now.R() - exact).amax(), (now.R().tr_mul(&now.omega).z - omega.z).abs()]
                });
                let last = done.rows.last().expect("the end");
                // The error of the spin is that of the rotation.
                assert!(last[1] < 20.0 * step.powi(3), "{scheme}, ratio {ratio:e}: {last:?}");
                (step, last[0])
            });
            println!("{scheme:18} {ratio:8.1e} {points:?} {:.2}", slope(&points));
            // An inertia raised to 1e-8 has so much momentum of spin, which turns the axis for 2 s.
            assert!(
                slope(&points) > 2.9 || ratio < 1e-8 && points[1].1 < 2e-7,
                "{scheme}, ratio {ratio:e}: {points:?}"
            );
        }
    }
}

/// Rods about whose axes nothing exerts a moment keep their spin, and move as one of a ratio of 1e-7 does: free, on springs and dampers along the
/// axis, on a ball joint, on a rod without mass, two in a chain, and on a hinge along
/// the axis. With their own inertias free rods were lost within 5 s from 1e-10 on,
/// and sprung ones spun with 41 for 5 rad/s at 1e-11, without a warning.
#[test]
fn what_nothing_turns_keeps_its_spin_at_any_ratio() {
    let joint = |name: &str, kind: &str, from: &str, to: &str| {
        format!("[[joints]]\nname = \"{name}\"\nkind = \"{kind}\"\nfrom = {{ {from} }}\nto = {{ {to} }}\n")
    };
    let end = "body = \"rod\", point = [0.0, 0.0, 0.5]";
    let spring = |name: &str, from: &str, at: &str| {
        format!(
            "[[links]]\nname = \"{name}\"\nfrom = {{ ground = {from} }}\nto = {{ body = \"rod\", point = {at} }}\nstiffness = 40.0\ndamping = 0.5\n"
        )
    };
    let springs =
        spring("a", "[0.2, 0.1, 0.8]", "[0.0, 0.0, 0.3]") + &spring("b", "[0.3, -0.4, -0.2]", "[0.0, 0.0, -0.4]");
    let second = |own: f64| {
        format!(
            "[[bodies]]\nname = \"other\"\ncenter = [0.0, 0.0, 1.0]\nmass = 2.0\ninertia = [2.0, 2.0, {own:?}]\nvelocity = [1.5, -0.9, 0.1]\n\
             angular_velocity = [0.4, 0.9, 3.0]\n"
        )
    };
    let chain = joint("link", "spherical", end, "body = \"other\"");
    let shaft = "[[bodies]]\nname = \"other\"\ncenter = [0.0, 0.0, 1.0]\nmass = 2.0\ninertia = [2.0, 1.5, 1.0]\nvelocity = [2.0, -1.0, 0.0]\n\
                 angular_velocity = [1.0, 2.0, 3.0]\n"
        .to_owned()
        + &joint("shaft", "revolute", end, "body = \"other\"")
        + "axis = [0.0, 0.0, 1.0]\n";
    for (what, held, own_of_second) in [
        ("free", String::new(), None),
        ("springs", springs, None),
        ("ball", joint("ball", "spherical", "ground = [0.0, 0.0, 0.5]", end), None),
        ("distance", joint("stay", "distance", "ground = [0.3, 0.0, 1.0]", end), None),
        ("chain", chain, Some(2.0)),
        ("shaft", shaft, None),
    ] {
        for scheme in ["wilson-theta", "newmark", "generalized-alpha", "bathe", "esdirk3", "central-difference"] {
            let run = |ratio: f64| {
                let model = read_deck(&format!(
                    "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[integrator]\nscheme = \"{scheme}\"\n\
                     [output]\ninterval = 1.0\n\
                     [[bodies]]\nname = \"rod\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, {ratio:?}]\n\
                     angular_velocity = [1.0, 2.0, 5.0]\n{}{held}",
                    own_of_second.map_or_else(String::new, |own| second(own * ratio))
                ));
                let rod = node(&model, "rod");
                let done = run_to_the_end(&model, &mut |frame| {
                    let now = &frame.state.nodes[rod];
                    let axis = now.R() * Vec3::z();
                    vec![now.R().tr_mul(&now.omega).z, axis.x, axis.y, axis.z, now.x.x, now.x.y, now.x.z]
                });
                done.rows.last().expect("the end").clone()
            };
            let stout = run(1e-7);
            for ratio in [0.0, 1e-13, 2e-12, 1e-11, 3e-10] {
                let found = run(ratio);
                // The momentum of the spin moves the axis by 1e-7; iterations leave 1e-8 of the moments, which a small inertia turns
                // into spin.
                let off = found[1..].iter().zip(&stout[1..]).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                assert!((found[0] - 5.0).abs() < 1e-3, "{what} {scheme}, ratio {ratio:e}: {found:?}");
                // Central differences err by 1e-4 at this step, which the ratio changes.
                let close = if scheme == "central-difference" { 1e-4 } else { 1e-6 };
                assert!(off < close, "{what} {scheme}, ratio {ratio:e}: {found:?} for {stout:?}");
            }
        }
    }
}

/// A rod of a ratio of inertias of 1e-10 that tumbles and spins, with other tables of the deck.
fn spinning_rod(scheme: &str, more: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 1.0\ntime_step = 0.01\n[integrator]\nscheme = \"{scheme}\"\n\
         [output]\ninterval = 0.5\nenergy = true\n[points]\ntip = [0.0, 0.0, 0.5]\nside = [0.1, 0.0, 0.2]\nfar = [0.0, 0.0, 1.5]\n\
         [[bodies]]\nname = \"rod\"\ncenter = [0.0, 0.0, 0.0]\nmass = 1.0\ninertia = [1.0, 1.0, 1e-10]\n\
         angular_velocity = [1.0, 2.0, 5.0]\n{more}"
    )
}

/// The inertia is raised where nothing exerts a moment about the axis, and nowhere else.
#[test]
fn an_inertia_is_raised_only_where_nothing_turns_its_axis() {
    let attached = |node: &str, dofs: &str| format!("[[attachments]]\nbody = \"rod\"\nnodes = \"{node}\"\n{dofs}");
    let load = |at: &str, what: &str| format!("[[loads]]\nat = \"{at}\"\n{what}\n");
    let damper = |at: &str, what: &str| format!("[[damping.nodal]]\nat = \"{at}\"\n{what} = 1.0\n");
    let to_rod = |point: &str| format!("to = {{ body = \"rod\", point = {point} }}\n");
    let link = |point: &str, what: &str| {
        format!("[[links]]\nname = \"link\"\nfrom = {{ ground = [0.3, 0.2, 0.9] }}\n{}{what}\n", to_rod(point))
    };
    let joint = |kind: &str, more: &str| {
        format!(
            "[[joints]]\nname = \"joint\"\nkind = \"{kind}\"\nfrom = {{ ground = [0.0, 0.0, 0.5] }}\n{}{more}\n",
            to_rod("[0.0, 0.0, 0.5]")
        )
    };
    let other = "[[bodies]]\nname = \"other\"\ncenter = [0.1, 0.0, 0.2]\nmass = 1.0\ninertia = [1.0, 1.0, 1.0]\n";
    let beam = "[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 2e11\npoisson_ratio = 0.3\ndensity = 7850.0\n\
                [sections.square]\nshape = \"rectangle\"\nwidth = 0.01\nheight = 0.01\n\
                [[beams]]\nname = \"beam\"\npath = [\"tip\", \"far\"]\nsection = \"square\"\nmaterial = \"steel\"\norientation = [0.0, 1.0, 0.0]\nelements = 2\n";
    let box_of = |body: &str, of: &str| {
        format!(
            "[[contacts]]\nname = \"touch\"\nsurface = {{ {body}shape = \"box\", center = [0.0, 0.0, 0.2], size = [0.1, 0.1, 0.1] }}\n\
                 with = \"{of}\"\nstiffness = 1e4\n"
        )
    };
    let weight = "[environment]\ngravity = [3.0, 0.0, -9.81]\n".to_owned();
    let tip = attached("tip", "");
    let side = attached("side", "");
    for (what, is_raised, more) in [
        ("nothing", true, String::new()),
        ("weight", true, weight),
        ("Rayleigh's alpha", true, "[damping]\nmass_factor = 0.5\n".to_owned()),
        ("a force at the tip", true, tip.clone() + &load("tip", "force = [1.0, 2.0, 3.0]\nfollower = true")),
        ("a force beside", false, side.clone() + &load("side", "force = [0.0, 1.0, 0.0]")),
        ("a moment", false, load("rod", "moment = [0.0, 0.0, 1e-10]")),
        ("a follower moment", false, load("rod", "moment = [0.0, 0.0, 1e-10]\nfollower = true")),
        ("a moment at the tip", false, tip.clone() + &load("tip", "moment = [1.0, 0.0, 0.0]")),
        ("a spring at the tip", true, link("[0.0, 0.0, 0.5]", "stiffness = 10.0")),
        ("a spring beside", false, link("[0.1, 0.0, 0.2]", "stiffness = 10.0")),
        ("a bushing", false, link("[0.0, 0.0, 0.5]", "bushing = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0]")),
        ("a damper at the tip", true, tip.clone() + &damper("tip", "translation")),
        ("a damper beside", false, side.clone() + &damper("side", "translation")),
        ("a damper of rotations", false, damper("rod", "rotation")),
        ("a ball joint", true, joint("spherical", "")),
        ("a shaft", true, joint("revolute", "axis = [0.0, 0.0, 1.0]")),
        ("a motor", false, joint("revolute", "axis = [0.0, 0.0, 1.0]\neffort = { value = 1e-10 }")),
        ("a drive", false, joint("revolute", "axis = [0.0, 0.0, 1.0]\nmotion = { velocity = 5.0 }")),
        ("friction of a joint", false, joint("revolute", "axis = [0.0, 0.0, 1.0]\nfriction_moment = 1e-10")),
        ("a spring of a joint", false, joint("revolute", "axis = [0.0, 0.0, 1.0]\nstiffness = 1e-9")),
        ("a hinge across", false, joint("revolute", "axis = [0.0, 1.0, 0.0]")),
        ("a support", false, "[[supports]]\nat = \"rod\"\nfix = \"rz\"\n".to_owned()),
        ("a support of places", true, "[[supports]]\nat = \"rod\"\nfix = \"translations\"\n".to_owned()),
        ("a mass beside", false, side.clone() + "[[masses]]\nat = \"side\"\nmass = 0.1\n"),
        ("a mass on the axis", false, tip.clone() + "[[masses]]\nat = \"tip\"\nmass = 0.1\n"),
        ("a body beside", false, attached("other", "") + other),
        ("a beam", false, tip + beam),
        ("its turns alone", false, attached("tip", "dofs = \"rotations\"\n")),
        ("points against its box", false, box_of("body = \"rod\", ", "other") + other),
        ("its shape", false, format!("[bodies.shape]\nkind = \"box\"\nsize = [0.1, 0.1, 0.5]\n{}", box_of("", "rod"))),
        ("a contact of others", true, box_of("", "other") + other),
    ] {
        let model = read_deck(&spinning_rod("newmark", &more));
        let system = rdsolve::system::System::new(&model).unwrap();
        let rod = node(&model, "rod");
        let inertia = system.inertias.iter().find(|inertia| inertia.node == rod).expect("the rod");
        assert_eq!(inertia.of_deck.is_some(), is_raised, "{what}");
    }
}

/// Moments about the axis turn the inertia of the deck: 1e-10 N m add 1 rad/s in a second. The energy of a free rod is that of the deck too.
#[test]
fn moments_and_energies_have_the_inertia_of_the_deck() {
    for scheme in ["wilson-theta", "newmark", "generalized-alpha", "bathe", "esdirk3"] {
        let pushed =
            "[[loads]]\nat = \"rod\"\nmoment = [0.0, 0.0, 1e-10]\n[[supports]]\nat = \"rod\"\nfix = \"translations\"\n";
        let text = spinning_rod(scheme, pushed).replace("[1.0, 2.0, 5.0]", "[0.0, 0.0, 5.0]");
        let model = read_deck(&text);
        let rod = node(&model, "rod");
        let done = run_to_the_end(&model, &mut |frame| vec![frame.state.nodes[rod].omega.z]);
        let spin = done.rows.last().expect("the end")[0];
        assert!((spin - 6.0).abs() < 1e-9, "{scheme}: {spin}");
        let fast = spinning_rod(scheme, "").replace("[1.0, 2.0, 5.0]", "[0.0, 1e-3, 50.0]");
        for row in tables_of(&read_deck(&fast)).rows("energy.csv") {
            // The spin has a quarter of the energy of the tumbling, and 25 times it with the inertia of the run.
            let (kinetic, deck) = (row.number("kinetic"), 0.5 * (1e-6 + 1e-10 * 2500.0));
            // Half a radian of spin in a step costs esdirk3 1e-3.
            assert!((kinetic / deck - 1.0).abs() < 2e-3, "{scheme}: {kinetic} for {deck}");
        }
    }
}
