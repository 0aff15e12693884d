//! Superelements in decks: their files, and what they compute beside the beams that they stand for.

use crate::support::{assert_says_what_to_change, decks, position, run_source};
use insta::assert_snapshot;
use nalgebra::{DMatrix, SymmetricEigen};
use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model, Superelement};
use rdsolve::solve::Outcome;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A piece of the blade of decks/spin_up/superelements, 1.25 long.
const PIECE: &str = r#"
[points]
a = [0.0, 0.0, 0.0]
b = [1.25, 0.0, 0.0]
[[superelements]]
name = "piece"
nodes = ["a", "b"]
stiffness = "stiffness.mtx"
mass = "mass.mtx"
"#;

/// The beam that it is made of, with the same elements.
const BEAM: &str = r#"
[points]
a = [0.0, 0.0, 0.0]
b = [1.25, 0.0, 0.0]
[sections.blade]
shape = "general"
axial_stiffness = 2.8e7
shear_stiffness = [1e7, 1e7]
torsional_stiffness = 1.4e4
bending_stiffness = [1.4e4, 1.4e4]
mass_per_length = 1.2
inertia_per_length = [1.2e-3, 6e-4, 6e-4]
[[beams]]
name = "piece"
path = ["a", "b"]
elements = 4
section = "blade"
orientation = [0.0, 1.0, 0.0]
mass = "consistent"
"#;

const MODES: &str = "[analysis]\nkind = \"modal\"\nmodes = 14\n";

fn source(text: &str) -> Source {
    Source::new(decks().join("spin_up/superelements/test.toml").display().to_string(), text, &[])
}

/// A symmetric Matrix Market array.
fn matrix(name: &str) -> DMatrix<f64> {
    let text = fs::read_to_string(decks().join("spin_up/superelements").join(name)).unwrap();
    let mut numbers = text.lines().filter(|line| !line.starts_with('%')).flat_map(str::split_whitespace);
    let rows: usize = numbers.next().unwrap().parse().unwrap();
    let mut values = numbers.skip(1).map(|word| word.parse::<f64>().unwrap());
    let mut matrix = DMatrix::zeros(rows, rows);
    for column in 0..rows {
        for row in column..rows {
            matrix[(row, column)] = values.next().unwrap();
            matrix[(column, row)] = matrix[(row, column)];
        }
    }
    matrix
}

fn read(folder: &Path, text: &str) -> (Option<Model>, String) {
    let source = Source::new(folder.join("deck.toml").display().to_string(), text, &[]);
    let (model, problems) = model::read(&source);
    problems.iter().for_each(assert_says_what_to_change);
    let said: Vec<String> = problems.iter().map(|problem| problem.draw(&source, false)).collect();
    (model, said.join("\n\n").replace(&folder.display().to_string(), "."))
}

#[test]
fn frequencies_are_those_of_the_matrices() {
    let (K, M) = (matrix("stiffness.mtx"), matrix("mass.mtx"));
    let inverse = M.cholesky().unwrap().l().try_inverse().unwrap();
    let mut squares: Vec<f64> =
        SymmetricEigen::new(&inverse * K * inverse.transpose()).eigenvalues.iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    let mut text = format!("{MODES}{PIECE}");
    for (mode, square) in (1..).zip(&squares).skip(6) {
        let frequency = square.sqrt() / TAU;
        // Rounding of the eigenvalues: 1e-16 of the largest, 1e4 times the square of the lowest.
        writeln!(text, "[[expect]]\nmode = {mode}\nquantity = \"frequency\"\nvalue = {frequency:e}\ntolerance = 1e-9")
            .unwrap();
    }
    // The six motions without stiffness have frequencies of rounding.
    let least = 1e-4 * squares[6].sqrt() / TAU;
    writeln!(text, "[[expect]]\nmode = 6\nquantity = \"frequency\"\nvalue = 0.0\nabsolute_tolerance = {least:e}")
        .unwrap();
    let done = run_source(&source(&text), &mut |_| Vec::new());
    assert_eq!(done.verdicts.len(), 9);
    done.verdicts.iter().for_each(|verdict| assert!(verdict.passed, "{verdict:?}"));
}

/// Turned by 1.9 rad and loaded, the tip is where that of the beam is, at small strains.
#[test]
fn a_turned_superelement_bends_like_its_beam() {
    let rest = r#"
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.1
[[supports]]
at = "a"
fix = ["ux", "uy", "uz"]
motion = { rx = { amplitude = "r", scale = 0.5 }, ry = { amplitude = "r", scale = 0.3 }, rz = { amplitude = "r", scale = 1.9 } }
[amplitudes.r]
kind = "ramp"
end = 1.0
[[loads]]
at = "b"
force = [3.0, -4.0, 2.0]
moment = [0.3, 0.5, -0.6]
amplitude = "r"
[environment]
gravity = [0.0, 0.0, -9.81]
gravity_amplitude = "r"
"#;
    let tip = |part: &str| -> Vec<f64> {
        let done = run_source(&source(&format!("{rest}{part}")), &mut |frame| position(&frame.state.nodes[1]).to_vec());
        assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
        done.rows.last().unwrap().clone()
    };
    let (beam, piece) = (tip(BEAM), tip(PIECE));
    // Rotations in the frame are 7e-4: an arc is longer than its chord by a third of the square, 2e-7.
    let off = beam.iter().zip(&piece).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 4e-7, "{off:e}");
}

/// Thrown and spinning, a free superelement keeps its momenta, and the energy to the order of the scheme.
#[test]
fn a_thrown_superelement_keeps_momenta_and_energy() {
    let thrown = |step: f64| {
        let text = format!(
            "[analysis]\nkind = \"dynamic\"\nend_time = 0.4\ntime_step = {step}\n[integrator]\nscheme = \"newmark\"\n{PIECE}\n\
             [[initial]]\nat = \"all\"\nvelocity = [30.0, 10.0, 20.0]\nangular_velocity = [3.0, 9.0, 4.0]\nabout = [0.3, 0.0, 0.0]\n"
        );
        let done = run_source(&source(&text), &mut |frame| {
            let energy = frame.derived.energy.unwrap();
            [energy.p.as_slice(), energy.l.as_slice(), &[energy.mechanical]].concat()
        });
        let (first, last) = (&done.rows[0], done.rows.last().unwrap());
        let off = |range: std::ops::Range<usize>| {
            let size: f64 = first[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
            range.map(|k| (last[k] - first[k]).abs()).fold(0.0, f64::max) / size
        };
        [off(0..3), off(3..6), off(6..7)]
    };
    let [coarse, fine] = [4e-3, 2e-3].map(thrown);
    // The residual of each of 200 steps, 1e-8 of elastic forces 1e-2 of the inertia forces.
    assert!(coarse[0] < 1e-9 && fine[0] < 1e-9, "{coarse:?} {fine:?}");
    // The trapezoidal rule is of the second order: a quarter at half the step.
    for k in 1..3 {
        assert!(fine[k] < 0.3 * coarse[k] + 1e-10 && fine[k] < 1e-4, "{coarse:?} {fine:?}");
    }
}

/// The same matrix in three formats, in another order and along other axes, is the same superelement.
#[test]
fn formats_orders_and_axes_agree() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (K, M) = (matrix("stiffness.mtx"), matrix("mass.mtx"));
    let n = K.nrows();
    for (name, matrix) in [("stiffness", &K), ("mass", &M)] {
        let mut listed = format!("%%MatrixMarket matrix coordinate real general\n% a comment\n{n} {n} {}\n", n * n);
        let mut rows = format!("** a comment\n*USER ELEMENT, NODES=2\n1, 2\n*MATRIX, TYPE={}\n", name.to_uppercase());
        for column in 0..n {
            for row in 0..n {
                writeln!(listed, "{} {} {:e}", row + 1, column + 1, matrix[(row, column)]).unwrap();
            }
            let upper: Vec<String> = (0..=column).map(|row| format!("{:e}", matrix[(row, column)])).collect();
            upper.chunks(4).for_each(|line| writeln!(rows, "{}", line.join(", ")).unwrap());
        }
        fs::write(folder.join(format!("{name}.mtx")), listed).unwrap();
        fs::write(folder.join(format!("{name}.inp")), rows).unwrap();
    }
    // Rows from the last to the first, and components along axes turned about x by a quarter: y' = z, z' = −y.
    let mut order: Vec<String> = Vec::new();
    for point in ["a", "b"] {
        order.extend(["ux", "uy", "uz", "rx", "ry", "rz"].map(|direction| format!("\"{point}.{direction}\"")));
    }
    order.extend(["\"mode\"".to_owned(), "\"mode\"".to_owned()]);
    for (name, matrix) in [("stiffness", &K), ("mass", &M)] {
        let mut turned = format!("%%MatrixMarket matrix array real general\n{n} {n}\n");
        let place = |k: usize| match k % 3 {
            _ if k > 11 => (k, 1.0),
            0 => (k, 1.0),
            1 => (k + 1, 1.0),
            _ => (k - 1, -1.0),
        };
        // Modes keep their order among themselves.
        let reversed = |k: usize| if k < 2 { 12 + k } else { n - 1 - k };
        for column in 0..n {
            for row in 0..n {
                let ((i, a), (j, b)) = (place(reversed(row)), place(reversed(column)));
                writeln!(turned, "{:e}", a * b * matrix[(i, j)]).unwrap();
            }
        }
        fs::write(folder.join(format!("{name}.turned")), turned).unwrap();
    }
    let unknowns: Vec<String> =
        (0..n).map(|k| if k < 2 { order[12 + k].clone() } else { order[n - 1 - k].clone() }).collect();
    let made = |ending: &str, more: &str| {
        let text = format!("{MODES}{}{more}", PIECE.replace("mtx", ending));
        let (model, said) = read(folder, &text);
        let model = model.unwrap_or_else(|| panic!("{said}"));
        let part = model.each::<Superelement>().next().unwrap().matrices.clone();
        [part.stiffness, part.mass]
    };
    let first = made("mtx", "");
    let turned = format!("unknowns = [{}]\naxes = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]\n", unknowns.join(", "));
    for other in [made("inp", ""), made("turned", &turned)] {
        for (first, other) in first.iter().zip(&other) {
            let size = first.iter().fold(0.0, |most: f64, k| most.max(k.abs()));
            let off = first.iter().zip(other.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Rounding of sums.
            assert!(off <= 1e-14 * size, "{off:e} of {size:e}");
        }
    }
}

/// Rotations and amplitudes without mass beside a joint move as the others do.
#[test]
fn massless_directions_move_beside_a_joint() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, matrix: &DMatrix<f64>| {
        let numbers: Vec<String> = matrix.iter().map(|entry| format!("{entry:e}")).collect();
        let (n, numbers) = (matrix.nrows(), numbers.join("\n"));
        let text = format!("%%MatrixMarket matrix array real general\n{n} {n}\n{numbers}\n");
        fs::write(folder.path().join(name), text).unwrap();
    };
    write("stiffness.mtx", &matrix("stiffness.mtx"));
    let masses: Vec<f64> = (0..14).map(|k| if k < 12 && k % 6 < 3 { 0.75 } else { 0.0 }).collect();
    write("mass.mtx", &DMatrix::from_diagonal(&masses.into()));
    let text = format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = 0.02\ntime_step = 1e-3\n[integrator]\nscheme = \"newmark\"\n{PIECE}\n\
         [[joints]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0.0, 1.0, 0.0]\nfrom = {{ ground = [0.0, 0.0, 0.0] }}\n\
         to = {{ node = \"a\" }}\n[environment]\ngravity = [0.0, 0.0, -9.81]\n"
    );
    let source = Source::new(folder.path().join("deck.toml").display().to_string(), text, &[]);
    let done = run_source(&source, &mut |frame| position(&frame.state.nodes[1]).to_vec());
    assert!(matches!(done.outcome, Outcome::Done), "{:?}", done.outcome);
    let fallen = -done.rows.last().unwrap()[2];
    // A mass at the end of a rod falls freely at first, and vibrates by less than a hundredth of that: 0.5 g t².
    assert!((fallen / (0.5 * 9.81 * 0.02 * 0.02) - 1.0).abs() < 0.05, "{fallen}");
}

#[test]
fn bad_superelements_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let write = |name: &str, matrix: &DMatrix<f64>| {
        let numbers: Vec<String> = matrix.iter().map(|entry| format!("{entry:e}")).collect();
        let (n, numbers) = (matrix.nrows(), numbers.join("\n"));
        fs::write(folder.join(name), format!("%%MatrixMarket matrix array real general\n{n} {n}\n{numbers}\n"))
            .unwrap();
    };
    let (K, M) = (matrix("stiffness.mtx"), matrix("mass.mtx"));
    write("stiffness.mtx", &K);
    write("mass.mtx", &M);
    let change = |of: &DMatrix<f64>, entries: &[(usize, usize, f64)]| {
        let mut changed = of.clone();
        entries.iter().for_each(|(i, j, more)| changed[(*i, *j)] += more);
        changed
    };
    write("grounded.mtx", &change(&K, &[(1, 1, 1e6)]));
    write("rounded.mtx", &change(&K, &[(1, 1, 0.5)]));
    write("skew.mtx", &change(&K, &[(1, 8, 1e5)]));
    write("soft.mtx", &change(&K, &[(12, 12, -1e9)]));
    write("added.mtx", &change(&M, &[(1, 1, 0.5)]));
    write("small.mtx", &M.view((0, 0), (10, 10)).into_owned());
    fs::write(folder.join("short.mtx"), "%%MatrixMarket matrix array real symmetric\n2 2\n1.0\n").unwrap();
    fs::write(folder.join("outside.mtx"), "%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1.0\n").unwrap();
    fs::write(folder.join("words.mtx"), "%%MatrixMarket matrix array real general\n1 1\nsoft\n").unwrap();
    fs::write(folder.join("complex.mtx"), "%%MatrixMarket matrix array complex general\n1 1\n1 0\n").unwrap();
    fs::write(folder.join("other.inp"), "*MATRIX, TYPE=MASS\n1.0\n").unwrap();
    fs::write(folder.join("twice.mtx"), "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n2 1 1.0\n1 2 1.0\n")
        .unwrap();
    fs::write(folder.join("unsymmetric.inp"), "*MATRIX, TYPE=STIFFNESS, UNSYMM\n1.0\n").unwrap();
    fs::write(folder.join("five.inp"), "*MATRIX, TYPE=STIFFNESS\n1.0, 2.0, 3.0, 4.0, 5.0\n").unwrap();
    let mut said = String::new();
    let mut tell = |title: &str, edits: &[(&str, &str)]| {
        let text = edits.iter().fold(format!("{MODES}{PIECE}"), |text, (old, new)| {
            assert_eq!(text.matches(old).count(), 1, "{old}");
            text.replace(old, new)
        });
        writeln!(said, "# {title}\n{}\n", read(folder, &text).1).unwrap();
    };
    tell("nothing", &[]);
    for file in ["missing", "grounded", "rounded", "skew", "soft", "small", "short", "outside", "words", "complex"] {
        tell(file, &[("stiffness.mtx", &format!("{file}.mtx"))]);
    }
    tell("another type", &[("stiffness.mtx", "other.inp")]);
    tell("entries given twice", &[("stiffness.mtx", "twice.mtx")]);
    tell("not symmetric", &[("stiffness.mtx", "unsymmetric.inp")]);
    tell("five numbers", &[("stiffness.mtx", "five.inp")]);
    tell("added mass", &[("mass.mtx", "added.mtx")]);
    tell("another size", &[("mass.mtx", "small.mtx")]);
    tell("the other way round", &[("[\"a\", \"b\"]", "[\"b\", \"a\"]")]);
    tell("twice", &[("[\"a\", \"b\"]", "[\"a\", \"a\"]")]);
    tell("unknown", &[("[\"a\", \"b\"]", "[\"a\", \"c\"]")]);
    tell("a line of translations", &[("[\"a\", \"b\"]", "[\"a\", \"b\"]\ndofs = \"translations\"")]);
    tell("unknowns", &[("mass =", "unknowns = [\"a.ux\", \"mode\"]\nmass =")]);
    tell(
        "explicit",
        &[(
            "kind = \"modal\"\nmodes = 14",
            "kind = \"dynamic\"\nend_time = 1.0\ntime_step = 1e-4\n[integrator]\nscheme = \"central-difference\"",
        )],
    );
    let turning = "[[loads]]\ncentrifugal = { speed = 10.0, axis = [0.0, 0.0, 1.0] }\n[[superelements]]";
    tell(
        "a centrifugal load",
        &[("kind = \"modal\"\nmodes = 14", "kind = \"static\""), ("[[superelements]]", turning)],
    );
    assert_snapshot!("superelements", said);
}
