//! Complex modes: damping, bodies that spin, loads that follow.

use super::{head, modes, off};
use rdsolve::modes::EigenMode;

/// A mass on a spring and a damper: s = −c/2m ± √(k/m − c²/4m²) i; and one that is damped beyond oscillation.
#[test]
fn one_degree_of_freedom() {
    let text = |damping: f64| {
        format!(
            "[analysis]\nkind = \"modal\"\nmodes = 2\ndamped = true\n[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[masses]]\nat = \"b\"\n\
             mass = 2.0\n[[links]]\nname = \"l\"\nfrom = {{ node = \"a\" }}\nto = {{ node = \"b\" }}\nlaw = \"linear\"\nstiffness = 50.0\n\
             damping = {damping:?}\n[[supports]]\nat = \"a\"\nfix = \"all\"\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n"
        )
    };
    let found = modes(&text(4.0)).list;
    assert_eq!(found.len(), 1);
    assert!(
        (found[0].root[0] + 1.0).abs() < 1e-10 && (found[0].root[1] - 24f64.sqrt()).abs() < 1e-10,
        "{:?}",
        found[0].root
    );
    assert!((found[0].damping_ratio().unwrap() - 0.2).abs() < 1e-10);
    // 2 s² + 52 s + 50: roots −1 and −25.
    let found: Vec<f64> = modes(&text(52.0)).list.iter().map(|mode| mode.root[0]).collect();
    assert!(off(&found, &[-1.0, -25.0]) < 1e-9, "{found:?}");
}

/// Rayleigh damping C = α M + β K keeps the shapes: ζ = α/2ω + β ω/2 with the undamped ω. Pairs of equal frequency come twice.
#[test]
fn rayleigh_damping() {
    let text = |analysis: &str| {
        head(analysis, 0.01, 0.01)
            + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 6\n\
               material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n\
               [damping]\nalpha = 3.0\nbeta = 2e-5\n"
    };
    let (plain, damped) = (modes(&text("modes = 8")), modes(&text("modes = 8\ndamped = true")));
    for (plain, damped) in plain.list.iter().zip(&damped.list) {
        let omega = plain.angular_frequency();
        let size = damped.root[0].hypot(damped.root[1]);
        let zeta = 0.5 * (3.0 / omega + 2e-5 * omega);
        // The residual tolerance 1e-11 times the ratio of the square of the last root to the first.
        assert!((size / omega - 1.0).abs() < 1e-7, "{size} {omega}");
        assert!((damped.damping_ratio().unwrap() / zeta - 1.0).abs() < 1e-6, "{:?} {zeta}", damped.damping_ratio());
    }
    assert_eq!(damped.list.len(), 8);
}

/// The roots ω of a rotor by its deflection and slope: (K + diag(−m ω², J_p Ω ω − J_t ω²)) has no determinant.
fn whirl(k: [f64; 3], [m, jt, jp]: [f64; 3], spin: f64) -> Vec<f64> {
    let value = |w: f64| (k[0] - m * w * w) * (k[2] + jp * spin * w - jt * w * w) - k[1] * k[1];
    let mut roots = Vec::new();
    let (n, most) = (400_000, 4000.0);
    for i in -n..n {
        let [mut a, mut b] = [i, i + 1].map(|i| f64::from(i) * most / f64::from(n));
        if value(a) * value(b) < 0.0 {
            for _ in 0..60 {
                let c = 0.5 * (a + b);
                if value(a) * value(c) <= 0.0 { b = c } else { a = c }
            }
            roots.push(a.abs());
        }
    }
    roots.sort_by(f64::total_cmp);
    roots
}

/// An overhung disc on a shaft without mass whirls forwards and backwards (J. P. Den Hartog, Mechanical Vibrations, 6.11): four
/// frequencies that part with speed. The disc turns freely about the shaft. One element of third order holds the shaft's deflection;
/// shear adds 3 E I/(G A L²) = 5e-7 to a flexibility, more to the higher pair.
#[test]
fn overhung_disc() {
    let (length, h, m, jt, jp) = (0.8f64, 1e-3f64, 2e-3, 2e-6, 4e-6);
    for spin in [0.0, 30.0, 200.0] {
        let text = head("modes = 5\ndamped = true", h, h)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 1\n\
                 material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"disc\"\n\
                 center = [{length:?}, 0.0, 0.0]\nmass = {m:?}\ninertia = [{jp:?}, {jt:?}, {jt:?}]\nangular_velocity = [{spin:?}, 0.0, 0.0]\n\
                 [[attachments]]\nbody = \"disc\"\nnodes = [\"b\"]\ndofs = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n\
                 [[supports]]\nat = \"a\"\nfix = \"all\"\n"
            );
        let ei = 210e9 * h.powi(4) / 12.0;
        let k = [12.0 * ei / length.powi(3), -6.0 * ei / length.powi(2), 4.0 * ei / length];
        let exact = whirl(k, [m, jt, jp], spin);
        let found = modes(&text);
        // The disc turns freely about the shaft: the first mode has no stiffness.
        assert_eq!(found.list[0].root, [0.0; 2], "{:?}", found.list[0].root);
        let omegas: Vec<f64> = found.list[1..].iter().map(EigenMode::angular_frequency).collect();
        println!("spin {spin}: {omegas:?} {exact:?}");
        let wanted = if spin == 0.0 { vec![exact[0]; 2] } else { exact[..2].to_vec() };
        assert!(off(&omegas, &wanted) < 1e-5, "{omegas:?} {exact:?}");
        assert!(off(&omegas[2..], &exact[exact.len() - 2..]) < 1e-4, "{omegas:?} {exact:?}");
        assert!(found.list.iter().all(|mode| mode.root[0].abs() < 1e-6 * omegas[3]), "{:?}", found.list[1].root);
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    }
}

/// A reduced shaft with a disc whirls as all of its elements do, with its own gyroscopic moments. A flat section is warned of.
#[test]
fn reduced_rotor() {
    let of = |section: &str, key: &str| {
        let text = head("modes = 7\ndamped = true", 0.05, 0.03)
            .replace("shape = \"rectangle\"\nwidth = 0.05\nheight = 0.03", section)
            + "[points]\na = [0.0, 0.0, 0.0]\nm = [0.6, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"m\", \"b\"]\n\
               elements = 5\nmaterial = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n"
            + key
            + "[[bodies]]\nname = \"disc\"\ncenter = [0.6, 0.0, 0.0]\nmass = 20.0\ninertia = [0.4, 0.22, 0.22]\nangular_velocity = [2000.0, 0.0, 0.0]\n\
               [[attachments]]\nbody = \"disc\"\nnodes = \"m\"\n[[initial]]\nat = [\"shaft\"]\nangular_velocity = [2000.0, 0.0, 0.0]\n\
               [[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"uz\"]\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n";
        modes(&text)
    };
    let round = "shape = \"circle\"\nradius = 0.03";
    let (full, few) = (of(round, ""), of(round, "reduced = 12\n"));
    let omegas = |of: &[EigenMode]| -> Vec<f64> { of[1..].iter().map(EigenMode::angular_frequency).collect() };
    println!("{:?} {:?}", omegas(&full.list), omegas(&few.list));
    // Modes beyond the twelfth; without its own moments the shaft errs by 4e-3.
    assert!(off(&omegas(&few.list), &omegas(&full.list)) < 2e-4);
    // Orbits are circles, to the rounding of shapes.
    let senses = |of: &[EigenMode]| -> Vec<f64> { of[1..].iter().map(|mode| mode.whirl.unwrap().sense).collect() };
    assert!(
        full.list[1..].iter().zip(senses(&few.list)).all(|(mode, few)| (mode.whirl.unwrap().sense - few).abs() < 1e-5),
        "{:?}",
        senses(&few.list)
    );
    assert_eq!((few.warnings.len(), full.warnings.len()), (0, 0), "{:?}", few.warnings);
    let flat = of("shape = \"rectangle\"\nwidth = 0.05\nheight = 0.03", "reduced = 12\n").warnings.join(" ");
    assert!(flat.contains("not symmetric about this axis"), "{flat}");
    // Its weight bends the shaft by 5e-5, and a soft drive holds it against turning.
    let weight = "[environment]\ngravity = [0.0, 0.0, -9.81]\n[[links]]\nname = \"drive\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\n\
                  bushing = [0.0, 0.0, 0.0, 10.0, 0.0, 0.0]\n";
    let sagging = of(round, &format!("reduced = 12\n{weight}"));
    assert!(off(&omegas(&sagging.list), &omegas(&full.list)) < 2e-4, "{:?}", omegas(&sagging.list));
    assert!(sagging.warnings.is_empty(), "{:?}", sagging.warnings);
    // A shaft beside the axis of the disc that carries it goes round with it.
    let beside = head("modes = 3\ndamped = true", 0.02, 0.02)
        .replace("shape = \"rectangle\"\nwidth = 0.02\nheight = 0.02", round)
        + "[points]\na = [0.0, 0.1, 0.0]\nb = [0.5, 0.1, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 5\nmaterial = \"steel\"\n\
           section = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\nreduced = 4\n[[bodies]]\nname = \"disc\"\ncenter = [0.0, 0.0, 0.0]\n\
           mass = 20.0\ninertia = [0.4, 0.22, 0.22]\nangular_velocity = [200.0, 0.0, 0.0]\n[[attachments]]\nbody = \"disc\"\nnodes = \"a\"\n\
           [[initial]]\nat = [\"shaft\"]\nangular_velocity = [200.0, 0.0, 0.0]\nabout = [0.0, 0.0, 0.0]\n[[supports]]\nat = \"disc\"\nfix = [\"translations\"]\n";
    let beside = modes(&beside).warnings.join(" ");
    assert!(beside.contains("`a` spins beside the axis"), "{beside}");
}

/// A column clamped at its foot under a force that follows its head does not buckle, it flutters beyond 20.05 E I/L² (M. Beck, ZAMP 3
/// (1952)): below, no mode grows, above, one does.
#[test]
fn becks_column() {
    let (length, h) = (1.0, 2e-3f64);
    let ei = 210e9 * h.powi(4) / 12.0;
    let growth = |part: f64| {
        let text = head("modes = 2\ndamped = true\nplane = \"auto\"", h, h)
            + &format!(
                "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 12\n\
                 material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n\
                 [[supports]]\nat = \"a\"\nfix = \"all\"\n[[loads]]\nat = \"b\"\nfollower = true\nforce = [{:?}, 0.0, 0.0]\n",
                -part * ei / (length * length)
            );
        let found = modes(&text);
        let most = found.list.iter().map(|mode| mode.root[0] / mode.angular_frequency()).fold(0.0, f64::max);
        println!("{part} E I/L²: {most:e}, {:?}", found.list.iter().map(|mode| mode.root).collect::<Vec<_>>());
        most
    };
    // 20.05 to four digits; elements and the axial shortening of 7e-6 leave 1e-4.
    assert!(growth(20.0) < 1e-6 && growth(20.1) > 1e-3);
}

/// A beam that nothing holds: six motions without stiffness, whose double roots rounding splits, and the others as without damping.
#[test]
fn free_beam() {
    let text = |analysis: &str| {
        head(analysis, 0.03, 0.02)
            + "[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 16\n\
               material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n"
    };
    let (plain, damped) = (modes(&text("modes = 10")), modes(&text("modes = 10\ndamped = true")));
    let omega =
        |modes: &rdsolve::modes::Modes| -> Vec<f64> { modes.list.iter().map(EigenMode::angular_frequency).collect() };
    let (plain, of_damped) = (omega(&plain), omega(&damped));
    assert!(damped.list[..6].iter().all(|mode| mode.root == [0.0; 2]), "{of_damped:?}");
    // The residual tolerance of 1e-11 times the square of the ratio of the frequencies, and rounding of 1e-9.
    assert!(off(&of_damped[6..], &plain[6..]) < 1e-7, "{plain:?} {of_damped:?}");
    assert_eq!((damped.unstable, damped.list.len()), (0, 10));
}

/// What modes without damping leave out is said: spins, and loads that follow; softness that rounding of stiff parts hides, too.
#[test]
fn warnings() {
    let arm = |more: &str| {
        head("modes = 2", 0.02, 0.02)
            + "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 2\n\
               material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n"
            + more
    };
    let of = |text: &str| modes(text).warnings.join("; ");
    let follower = of(&arm("[[loads]]\nat = \"b\"\nforce = [-1.0, 0.0, 0.0]\nfollower = true\n"));
    assert!(follower.contains("have no potential"), "{follower}");
    let disc = "[[bodies]]\nname = \"disc\"\ncenter = [1.0, 0.0, 0.0]\nmass = 1.0\ninertia = [0.02, 0.01, 0.01]\n\
                angular_velocity = [50.0, 0.0, 0.0]\n[[attachments]]\nbody = \"disc\"\nnodes = [\"b\"]\n\
                dofs = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n";
    let spins = of(&arm(disc));
    assert!(spins.contains("`disc` spins, and modes omit its gyroscopic moments"), "{spins}");
    // Softness of 1e-3 N/m under a beam of 1e11 N/m: the frequencies of 1e-3 are lost; those of a free beam are zero, and nothing is said.
    let free = head("modes = 8", 0.03, 0.02)
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 200\n\
           material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n";
    let soft = "[[links]]\nname = \"l\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { node = \"a\" }\nbushing = [1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3]\n";
    let soft = of(&(free.clone() + soft));
    assert!(soft.contains("below the rounding error of stiffer parts"), "{soft}");
    assert_eq!(of(&free), "");
}
