//! Whirl of damped modes and critical speeds, against closed forms.

use super::{head, modes, off};
use crate::support::warnings_of;

/// An overhung disc on a shaft without mass, which turns freely about it; [m, J_t, J_p] and the length of the shaft.
fn overhung(speeds: &str, [m, jt, jp]: [f64; 3], length: f64) -> String {
    let h = 1e-3;
    head(&format!("modes = 5\ndamped = true\n{speeds}"), h, h)
        + &format!(
            "[points]\na = [0.0, 0.0, 0.0]\nb = [{length:?}, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\npath = [\"a\", \"b\"]\nelements = 1\n\
             material = \"steel\"\nsection = \"s\"\norientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"disc\"\n\
             center = [{length:?}, 0.0, 0.0]\nmass = {m:?}\ninertia = [{jp:?}, {jt:?}, {jt:?}]\nangular_velocity = [-7.0, 0.0, 0.0]\n\
             [[attachments]]\nbody = \"disc\"\nnodes = [\"b\"]\ndofs = [\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"]\n\
             [[supports]]\nat = \"a\"\nfix = \"all\"\n"
        )
}

/// At a critical speed Ω a circular orbit turns with the disc, or against it: (k₁₁ − m Ω²)(k₂₂ − (J_t ∓ J_p) Ω²) = k₁₂² (J. P. Den Hartog,
/// Mechanical Vibrations, 6.11). A flat disc has one forward speed and two backward ones. Shear of the shaft adds 5e-7 to a flexibility.
#[test]
fn overhung_disc() {
    let ([m, jt, jp], length) = ([2e-3, 2e-6, 4e-6], 0.8_f64);
    let ei = 210e9 * 1e-12 / 12.0;
    let [k11, k12, k22] = [12.0 * ei / length.powi(3), -6.0 * ei / length.powi(2), 4.0 * ei / length];
    let mut known: Vec<(f64, f64)> = Vec::new();
    for sense in [1.0, -1.0] {
        let j = jt - sense * jp;
        // m j x² − (k₁₁ j + k₂₂ m) x + det = 0 with x = Ω².
        let (a, b, c) = (m * j, -(k11 * j + k22 * m), k11 * k22 - k12 * k12);
        let root = (b * b - 4.0 * a * c).sqrt();
        let squares = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
        known.extend(squares.iter().filter(|square| **square > 0.0).map(|square| (square.sqrt(), sense)));
    }
    known.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(known.len(), 3);
    let found = modes(&overhung("speeds = { to = 400.0, steps = 9 }", [m, jt, jp], length));
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let [speeds, senses]: [Vec<f64>; 2] = [
        found.critical_speeds.iter().map(|c| c.speed).collect(),
        found.critical_speeds.iter().map(|c| c.mode.whirl.unwrap().sense).collect(),
    ];
    assert_eq!(speeds.len(), 3, "{speeds:?}");
    let wanted: Vec<f64> = known.iter().map(|known| known.0).collect();
    assert!(off(&speeds, &wanted) < 1e-4, "{speeds:?} {wanted:?}");
    // Orbits of a round rotor are circles.
    assert!(senses.iter().zip(&known).all(|(sense, known)| (sense - known.1).abs() < 1e-6), "{senses:?} {known:?}");
    assert_eq!((found.speeds.len(), found.speeds[0].speed, found.speeds[8].speed), (9, 0.0, 400.0));
    // The modes about the spin of the deck itself whirl both ways; the one without stiffness does not oscillate.
    assert_eq!(found.list[0].whirl, None);
    let whirls: Vec<f64> = found.list[1..].iter().map(|mode| mode.whirl.unwrap().sense).collect();
    assert!(whirls.iter().all(|whirl| (whirl.abs() - 1.0).abs() < 1e-6) && whirls.iter().sum::<f64>().abs() < 1e-6);
}

/// Jeffcott's rotor on bearings of two stiffnesses: critical speeds √(k_y/m) and √(k_z/m) with orbits along lines, damping ratio c/(2√(km)).
#[test]
fn rotor_on_two_springs() {
    let text = "[analysis]\nkind = \"modal\"\ndamped = true\nmodes = 3\nspeeds = { from = 1.0, to = 20.0, steps = 5 }\n[[bodies]]\n\
                name = \"disc\"\ncenter = [0.0, 0.0, 0.0]\nmass = 4.0\ninertia = [0.5, 0.25, 0.25]\nangular_velocity = [3.0, 0.0, 0.0]\n\
                [[supports]]\nat = \"disc\"\nfix = [\"ux\", \"ry\", \"rz\"]\n[[links]]\nname = \"y\"\nfrom = { ground = [0.0, -1.0, 0.0] }\n\
                to = { body = \"disc\" }\nstiffness = 400.0\ndamping = 1.6\n[[links]]\nname = \"z\"\nfrom = { ground = [0.0, 0.0, -1.0] }\n\
                to = { body = \"disc\" }\nstiffness = 900.0\n";
    let found = modes(text);
    let speeds: Vec<f64> = found.critical_speeds.iter().map(|critical| critical.speed).collect();
    let ratio = 1.6 / (2.0 * (400.0_f64 * 4.0).sqrt());
    assert!(speeds.len() == 2 && off(&speeds, &[10.0 * (1.0 - ratio * ratio).sqrt(), 15.0]) < 1e-9, "{speeds:?}");
    let damping = found.critical_speeds[0].mode.damping_ratio().unwrap();
    assert!((damping - ratio).abs() < 1e-9, "{damping}");
    assert!(found.critical_speeds.iter().all(|critical| critical.mode.whirl.unwrap().sense.abs() < 1e-9));
    // Too few modes are said, and so is a scene in which nothing spins.
    let few = modes(&text.replace("modes = 3", "modes = 1"));
    assert!(few.warnings.join(" ").contains("critical speeds above may be missing"), "{:?}", few.warnings);
    let idle = warnings_of(&text.replace("angular_velocity = [3.0, 0.0, 0.0]\n", ""));
    assert!(idle.join(" ").contains("nothing spins at t = 0"), "{idle:?}");
}

/// A disc in the middle of a shaft that is clamped against twist at one end: torsion at √(G I_t/(l J_p)) has no orbit, though rounding has.
#[test]
fn torsion_has_no_orbit() {
    let (inertia, length, thickness) = (0.6, 0.5, 0.04);
    let text = head("modes = 6\ndamped = true", thickness, thickness)
        + &format!(
            "[points]\na = [0.0, 0.0, 0.0]\nm = [{length:?}, 0.0, 0.0]\nb = [1.0, 0.0, 0.0]\n[[beams]]\nname = \"shaft\"\n\
             path = [\"a\", \"m\", \"b\"]\nelements = 2\norder = 2\nmaterial = \"steel\"\nsection = \"s\"\n\
             orientation = [0.0, 1.0, 0.0]\nmass = \"none\"\n[[bodies]]\nname = \"disc\"\ncenter = [{length:?}, 0.0, 0.0]\nmass = 30.0\n\
             inertia = [{inertia:?}, 0.3, 0.3]\nangular_velocity = [1.0, 0.0, 0.0]\n[[attachments]]\nbody = \"disc\"\nnodes = \"m\"\n\
             [[supports]]\nat = \"a\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\"]\n[[supports]]\nat = \"b\"\nfix = [\"uy\", \"uz\"]\n"
        );
    // I_t = 0.1406 a⁴ of a square.
    let torsion = (210e9 / 2.6 * 0.1406 * f64::powi(thickness, 4) / (length * inertia)).sqrt() / std::f64::consts::TAU;
    let found = modes(&text);
    let near = |mode: &&rdsolve::modes::EigenMode| (mode.frequency() - torsion).abs() < 1e-3 * torsion;
    let mode = found.list.iter().find(near).unwrap_or_else(|| panic!("{torsion}: {:?}", found.list.len()));
    assert_eq!(mode.whirl.map(|whirl| (whirl.sense, whirl.kind())), Some((0.0, "torsion or axial")));
}
