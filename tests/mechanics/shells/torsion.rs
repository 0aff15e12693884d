//! Torsion of strips and of panels of cylinders, against nine-node elements of finer meshes.

use super::benchmarks::{deck, displacements, fix, load, point, read, shell};

/// Turn of the end of a strip.
fn strip(kind: &str, elements: [usize; 2], h: f64) -> f64 {
    let mut body = String::from("[points]\n");
    for (name, x) in [("a", [0.0, 0.0]), ("b", [10.0, 0.0]), ("c", [10.0, 1.0]), ("d", [0.0, 1.0])] {
        body += &point(name, [x[0], x[1], 0.0]);
    }
    body += &shell("strip", "a b c d", elements, kind, "");
    body += &fix("strip.edge4", "ux uy uz rx ry rz");
    body += "[[loads]]\nat = [\"b\", \"c\"]\nmoment = [1e-7, 0.0, 0.0]\n";
    let u = displacements(&read(&deck("strip", 1, [1e7, 0.3, h], &body)), &[("b", 2), ("c", 2)]);
    (u[1][1] - u[1][0]) / (1e-7 / h.powi(3))
}

/// Turn of the end of a panel of a cylinder under a couple of forces at its corners.
fn panel(kind: &str, elements: [usize; 2], angle: f64, length: f64, h: f64) -> f64 {
    let (s, c) = (0.5 * angle).to_radians().sin_cos();
    let mut body = String::from("[points]\n");
    body += &point("a", [0.0, -s, c]);
    body += &point("b", [length, -s, c]);
    body += &point("c", [length, s, c]);
    body += &point("d", [0.0, s, c]);
    body += &shell("panel", "a b c d", elements, kind, "kind = \"cylinder\", axis = [1.0, 0.0, 0.0]");
    body += &fix("panel.edge4", "ux uy uz rx ry rz");
    let f = 1e-6 * h.powi(3);
    body += &load("c", "force", [0.0, 0.0, f]);
    body += &load("b", "force", [0.0, 0.0, -f]);
    let u = displacements(&read(&deck("panel", 1, [1e7, 0.3, h], &body)), &[("b", 2), ("c", 2)]);
    (u[1][1] - u[1][0]) / 1e-6
}

/// Relative errors of meshes.
fn errors<const M: usize>(what: &str, found: [f64; M], wanted: f64, bound: f64) {
    let errors = found.map(|found| found / wanted - 1.0);
    println!("{what}: {errors:+.3?}");
    assert!(errors.iter().all(|error| error.abs() < bound), "{what}: {errors:?}, not {bound}");
}

/// Ten times as long as wide, of elements ten times as long as wide to squares. Without shear of the elements' own a strip is stiff by 0.63 h/b as the
/// plate of Kirchhoff is; what is wanted has it.
#[test]
fn strips_in_torsion() {
    for (h, bounds) in [(0.1, [0.06, 0.09]), (0.02, [0.01, 0.025])] {
        let wanted = strip("quadrilateral2", [80, 8], h);
        let meshes = [[4, 4], [8, 8], [40, 4], [10, 1], [20, 2], [20, 1], [5, 1]];
        for (kind, bound) in ["quadrilateral", "triangle"].into_iter().zip(bounds) {
            errors(&format!("strip {h} {kind}"), meshes.map(|n| strip(kind, n, h)), wanted, bound);
        }
    }
}

/// Panels that are not strongly curved; 90 degrees of thin ones take triangles finer than these.
#[test]
fn panels_in_torsion() {
    for (angle, length) in [(30.0, 4.0), (60.0, 4.0), (60.0, 8.0)] {
        for h in [0.1, 0.03] {
            let wanted = panel("quadrilateral2", [24, 8], angle, length, h);
            for (kind, bound) in [("quadrilateral", 0.15), ("triangle", 0.08)] {
                let found = [[8, 2], [16, 4], [32, 8]].map(|n| panel(kind, n, angle, length, h));
                errors(&format!("panel {angle} {length} {h} {kind}"), found, wanted, bound);
            }
        }
    }
}
