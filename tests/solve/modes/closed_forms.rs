//! Frequencies of continua and of small mechanisms.

use super::{head, modes, off, omegas};
use std::f64::consts::{PI, TAU};

const E: f64 = 210e9;
const RHO: f64 = 7850.0;

/// A slender cantilever: Euler and Bernoulli's roots, cosh β cos β = −1. Shear and rotary inertia take (β h/L)² of some tenths,
/// 2e-7 to 6e-6 with h/L = 1/2000 here; elements of third order leave less.
#[test]
fn cantilever() {
    let text = head("modes = 8\nplane = \"off\"", 2e-3, 1e-3)
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 24\n\
           material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n\
           [[supports]]\nat = \"a\"\nfix = \"all\"\n";
    let found = modes(&text);
    let beta = [1.875104068711961f64, 4.694091132974174, 7.854757438237613, 10.995540734875467, 14.13716839104647];
    let omega = |height: f64, beta: f64| (E / RHO / 12.0).sqrt() * height * (beta / 2.0).powi(2);
    let mut exact: Vec<f64> = beta.iter().flat_map(|&b| [omega(1e-3, b), omega(2e-3, b)]).collect();
    exact.sort_by(f64::total_cmp);
    let error = off(&omegas(&found), &exact[..8]);
    println!("cantilever: {error:e}");
    assert!(error < 2e-5, "{error:e}");
    // Three times its own mass besides halves all frequencies.
    let added = format!("[sections.s]\nadded_mass = {:?}\n", 3.0 * RHO * 2e-6);
    let halves = omegas(&modes(&text.replacen("[sections.s]\n", &added, 1)));
    let error = off(&halves.iter().map(|omega| 2.0 * omega).collect::<Vec<_>>(), &exact[..8]);
    assert!(error < 2e-5, "{error:e}");
    // Published effective masses of the first modes: 0.6131, 0.1883, 0.0647, 0.0331 of the beam's own.
    let mass = RHO * 2e-6 * 2.0;
    assert!((found.masses[2] / mass - 1.0).abs() < 1e-12, "{:?}", found.masses);
    let soft: Vec<f64> = found.list.iter().map(|mode| mode.effective_mass(2) / mass).filter(|m| *m > 1e-6).collect();
    for (m, published) in soft.iter().zip([0.6131, 0.1883, 0.0647]) {
        assert!((m - published).abs() < 1e-4, "{soft:?}");
    }
    // A mode of bending keeps all its energy in the beam; axial stiffness is 1e9 of that of bending, and rounds.
    assert!(found.list.iter().all(|mode| (mode.shares[0].strain - 1.0).abs() < 1e-5), "{:?}", found.list[0].shares);
}

/// A free beam: six motions without stiffness, then β L = 4.73004, 7.85320 about both axes. Its nodes in their own order are no postorder of
/// the elimination, which multifrontal factors need. Shear and rotary inertia take (β h/L)² of some tenths, 1e-5.
#[test]
fn free_beam() {
    let text = head("modes = 10", 3e-3, 2e-3)
        + "[points]\na = [0.0, 0.0, 0.0]\nb = [2.0, 0.0, 0.0]\n[[beams]]\nname = \"arm\"\npath = [\"a\", \"b\"]\nelements = 40\norder = 2\n\
           material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"consistent\"\n";
    let found = omegas(&modes(&text));
    assert!(found[..6].iter().all(|omega| *omega == 0.0), "{found:?}");
    let omega = |height: f64, beta: f64| (E / RHO / 12.0).sqrt() * height * (beta / 2.0).powi(2);
    let mut exact =
        [2e-3, 3e-3].map(|height| [4.730040744862704f64, 7.853204624095838].map(|beta| omega(height, beta))).concat();
    exact.sort_by(f64::total_cmp);
    let error = off(&found[6..], &exact);
    println!("free beam: {error:e}");
    // Elements of second order, 10 to a half wave, leave 1e-4.
    assert!(error < 3e-4, "{error:e}");
}

/// A free ring has six motions without stiffness, and then pairs of equal frequency: bending in its plane,
/// ω² = n² (n² − 1)²/(n² + 1) E I/(ρ A R⁴), and out of it, with torsion,
/// ω² = n² (n² − 1)²/(n² + 1 + ν) E I/(ρ A R⁴) (S. P. Timoshenko, Vibration Problems in Engineering; G J of the circle).
#[test]
fn free_ring() {
    let (r, radius) = (0.002f64, 1.0f64);
    let n = 48;
    let mut text = format!(
        "[analysis]\nkind = \"modal\"\nmodes = 14\n[materials.steel]\nmodel = \"elastic\"\nyoungs_modulus = 210e9\n\
         poisson_ratio = 0.3\ndensity = 7850.0\n[sections.s]\nshape = \"tube\"\nradius = {r:?}\nthickness = {r:?}\n[points]\n"
    );
    for k in 0..n {
        let angle = TAU * k as f64 / n as f64;
        text += &format!("p{k} = [{:?}, {:?}, 0.0]\n", radius * angle.cos(), radius * angle.sin());
    }
    let path: Vec<String> = (0..=n).map(|k| format!("\"p{}\"", k % n)).collect();
    text += &format!(
        "[[beams]]\nname = \"ring\"\npath = [{}]\nelements = 1\nmaterial = \"steel\"\nsection = \"s\"\norientation = [0.0, 0.0, 1.0]\n\
         mass = \"consistent\"\n",
        path.join(", ")
    );
    let found = omegas(&modes(&text));
    assert!(found[..6].iter().all(|omega| *omega == 0.0), "{:?}", &found[..6]);
    let unit = (E * 0.25 * r * r / RHO).sqrt() / (radius * radius);
    let of = |n: f64, more: f64| unit * n * (n * n - 1.0) / (n * n + 1.0 + more).sqrt();
    let mut exact: Vec<f64> =
        [2.0, 3.0].iter().flat_map(|&n| [of(n, 0.0), of(n, 0.0), of(n, 0.3), of(n, 0.3)]).collect();
    exact.sort_by(f64::total_cmp);
    let error = off(&found[6..], &exact);
    println!("free ring: {error:e} {:?}", &found[6..]);
    // Straight elements of a polygon of 48 sides: its perimeter is (2π/48)²/24 = 7e-4 short, and R⁴ and the length count: three times.
    assert!(error < 3e-3, "{error:e}");
    // Pairs are equal to the digits that symmetry has in the positions.
    for pair in found[6..].chunks(2) {
        assert!((pair[0] / pair[1] - 1.0).abs() < 1e-8, "{pair:?}");
    }
}

/// A string of equal masses between springs under tension T, across: ω = 2 √(T/(m a)) sin(k π/2n), exact for this chain (J. L.
/// Lagrange). Only K(σ) resists. Each mode comes twice, in both directions across.
#[test]
fn taut_string() {
    let (n, length, free, stiffness, mass) = (40, 2.0, 1.98, 1e5, 0.3);
    let text = format!(
        "[analysis]\nkind = \"modal\"\nmodes = 12\n[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[bars]]\nname = \"s\"\n\
         path = [\"a\", \"b\"]\nelements = {n}\naxial_stiffness = {stiffness:?}\nmass_per_length = {mass:?}\ntension_only = true\n\
         free_length = {free:?}\n[[supports]]\nat = [\"a\", \"b\"]\nfix = \"all\"\n"
    );
    let tension = stiffness * (length - free) / free;
    let a = length / n as f64;
    // Mass is per length without force, or as it lies: the total tells.
    let found = modes(&text);
    let m = found.masses[0] / n as f64;
    let exact = (1..=6).map(|k| 2.0 * (tension / (m * a)).sqrt() * (0.5 * PI * k as f64 / n as f64).sin());
    let exact: Vec<f64> = exact.flat_map(|omega| [omega, omega]).collect();
    let error = off(&omegas(&found), &exact);
    println!("taut string: {error:e}");
    assert!(error < 1e-9, "{error:e}");
}

/// Two point masses on rigid rods, joined by hinges, hang at rest: ω² = g/L (1 + μ)(1 ± √(μ/(1 + μ))), μ the lower mass over the
/// upper. Joints carry the weight by multipliers, whose derivative is all the stiffness there is.
#[test]
fn double_pendulum() {
    let (upper, lower) = (2.0, 3.0);
    let body = |name: &str, z: f64, m: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\ncenter = [0.0, 0.0, {z:?}]\nmass = {m:?}\ninertia = [1e-12, 1e-12, 1e-12]\n"
        )
    };
    let text = "[analysis]\nkind = \"modal\"\nmodes = 2\n[environment]\ngravity = [0.0, 0.0, -9.81]\n".to_owned()
        + &body("a", -1.0, upper)
        + &body("b", -2.0, lower)
        + "[[joints]]\nname = \"top\"\nkind = \"revolute\"\nfrom = { ground = [0.0, 0.0, 0.0] }\nto = { body = \"a\" }\n\
           axis = [0.0, 1.0, 0.0]\n[[joints]]\nname = \"middle\"\nkind = \"revolute\"\n\
           from = { body = \"a\", point = [0.0, 0.0, -1.0] }\nto = { body = \"b\" }\naxis = [0.0, 1.0, 0.0]\n";
    let found = omegas(&modes(&text));
    let mu: f64 = lower / upper;
    let root = (mu / (1.0 + mu)).sqrt();
    let exact = [1.0 - root, 1.0 + root].map(|factor| (9.81 * (1.0 + mu) * factor).sqrt());
    let error = off(&found, &exact);
    println!("double pendulum: {error:e} {found:?}");
    // The moments of inertia of the bodies add 1e-12 of m L².
    assert!(error < 1e-10, "{error:e}");
}

/// A rigid body beyond the end of a pipe without mass, on an arm: with the flexibility of the cantilever at the centre of mass,
/// f = [[L³/3 + L² e + L e², L²/2 + L e], [·, L]]/EI, the frequencies are those of f diag(m, J). The pipe is cubic, which one element of
/// third order holds; slender, its shear adds 3 E I/(G A_s L²) = 5e-7.
#[test]
fn pipe_with_a_body_on_an_arm() {
    let (length, e, m, j, h) = (3.0f64, 0.4, 800.0, 150.0, 2e-3f64);
    let text = head("modes = 2\nplane = \"auto\"", h, h)
        + &format!(
            "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"pipe\"\npath = [\"a\", \"b\"]\nelements = 1\n\
             material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"box\"\n\
             center = [{:?}, 0.0, 0.0]\nmass = {m:?}\ninertia = [{j:?}, {j:?}, {j:?}]\n[[attachments]]\nbody = \"box\"\n\
             nodes = [\"b\"]\n[[supports]]\nat = \"a\"\nfix = \"all\"\n",
            length + e
        );
    let ei = E * h.powi(4) / 12.0;
    let f = [
        [length.powi(3) / 3.0 + length.powi(2) * e + length * e * e, length.powi(2) / 2.0 + length * e],
        [length.powi(2) / 2.0 + length * e, length],
    ];
    let a = [[f[0][0] * m / ei, f[0][1] * j / ei], [f[1][0] * m / ei, f[1][1] * j / ei]];
    let (half, det) = (0.5 * (a[0][0] + a[1][1]), a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let root = (half * half - det).sqrt();
    let exact = [1.0 / (half + root).sqrt(), ((half + root) / det).sqrt()];
    let found = omegas(&modes(&text));
    let error = off(&found, &exact);
    println!("pipe with a body: {error:e} {found:?} {exact:?}");
    assert!(error < 2e-6, "{error:e}");
}

/// A hinged square plate: ω = π² (m² + n²)/L² √(D/ρh) (C. L. M. H. Navier). Modes (1, 2) and (2, 1) both come. Elements of the plate
/// are of second order, the waves of (2, 2) 12 elements long: 6e-3.
#[test]
fn hinged_plate() {
    let h: f64 = 0.01;
    let text = head("modes = 6", 1.0, 1.0)
        + &format!(
            "[points]\na = [0.0, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\nc = [1.0, 1.0, 0.0]\nd = [0.0, 1.0, 0.0]\n[[shells]]\nname = \"p\"\n\
             corners = [\"a\", \"b\", \"c\", \"d\"]\nelements = 24\nthickness = {h:?}\nmaterial = \"steel\"\nmass = \"consistent\"\n\
             [[supports]]\nat = [\"p.edge1\", \"p.edge2\", \"p.edge3\", \"p.edge4\"]\nfix = \"translations\"\n"
        );
    let model = crate::support::read_deck(
        &text.replace("[sections.s]\nshape = \"rectangle\"\nwidth = 1.0\nheight = 1.0\n", ""),
    );
    let found = super::modes_of(&model);
    let unit = PI * PI * (E * h * h / (12.0 * (1.0 - 0.09) * RHO)).sqrt();
    let exact: Vec<f64> = [2.0, 5.0, 5.0, 8.0, 10.0, 10.0].map(|sum| unit * sum).to_vec();
    let omegas = omegas(&found);
    let error = off(&omegas, &exact);
    println!("hinged plate: {error:e} {omegas:?} {exact:?}");
    assert!(error < 2e-2, "{error:e}");
    assert!((omegas[1] / omegas[2] - 1.0).abs() < 1e-8 && (omegas[4] / omegas[5] - 1.0).abs() < 1e-2, "{omegas:?}");
}
