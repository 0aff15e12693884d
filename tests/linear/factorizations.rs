//! Both factorisations against a dense one, over structures of every shape.

use crate::structures::{
    Random, Values, chain, connectivity, entries, fill, frame, quadratic_chain, sheet, slots, tree,
};
use nalgebra::{DMatrix, DVector};
use rdsolve::linear::{Factorization, Solver, Structure};

fn shapes(random: &mut Random) -> Vec<Structure> {
    let mut shapes = vec![
        chain(1, 6),
        chain(20, 6),
        chain(9, 3),
        chain(7, 1),
        quadratic_chain(10, 6),
        quadratic_chain(6, 2),
        sheet(5, 6, 5),
        frame(3, 3, 3, 6),
        frame(1, 4, 5, 3),
        Structure { sizes: vec![6, 2, 3], connectivity: vec![], multipliers: 0, positions: Vec::new() },
        Structure { sizes: vec![], connectivity: vec![], multipliers: 0, positions: Vec::new() },
    ];
    for groups in [2, 5, 17, 40] {
        shapes.push(tree(groups, random));
        shapes.push(connectivity(groups, random));
    }
    shapes
}

fn unknowns(structure: &Structure) -> usize {
    structure.sizes.iter().sum()
}

fn dense(n: usize, entries: &[(usize, usize, f64)]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(n, n);
    for &(i, j, value) in entries {
        matrix[(i, j)] += value;
    }
    matrix
}

/// Factors and solves for a random right-hand side; compares with a dense LU.
fn check(solver: &mut Solver, structure: &Structure, values: Values, random: &mut Random) {
    let n = unknowns(structure);
    let entries = entries(structure, values, random);
    let matrix = dense(n, &entries);
    let b = DVector::from_fn(n, |_, _| random.number());
    let slots = slots(solver, &entries);
    fill(solver, &slots);
    solver.factor().unwrap();
    let mut x = b.clone();
    solver.solve(x.as_mut_slice());
    if n == 0 {
        return; // nalgebra does not divide by nothing
    }

    let residual = (&matrix * &x - &b).norm() / (matrix.norm() * x.norm() + b.norm()).max(1e-300);
    assert!(residual <= 1e-14, "{}: residual {residual:e}", solver.describe());
    let expected = matrix.lu().solve(&b).unwrap();
    assert!((&x - &expected).norm() <= 1e-12 * expected.norm(), "{}", solver.describe());
}

#[test]
fn both_agree_with_a_dense_factorisation() {
    let mut random = Random(1);
    for structure in shapes(&mut random) {
        let mut block = Solver::new(&structure, Factorization::BlockLu, 1).unwrap();
        let mut cholesky = Solver::new(&structure, Factorization::Cholesky, 1).unwrap();
        assert!(!block.is_symmetric() && cholesky.is_symmetric());
        for _ in 0..3 {
            for values in [Values::Unsymmetric, Values::Definite, Values::Indefinite] {
                check(&mut block, &structure, values, &mut random);
            }
            for values in [Values::Definite, Values::Indefinite, Values::Definite] {
                check(&mut cholesky, &structure, values, &mut random);
            }
        }
    }
}

#[test]
fn slots_are_symmetric_unique_and_inside_the_structure() {
    let mut random = Random(2);
    for structure in shapes(&mut random) {
        let n = unknowns(&structure);
        let group: Vec<usize> = structure.sizes.iter().enumerate().flat_map(|(g, &s)| vec![g; s]).collect();
        for kind in [Factorization::BlockLu, Factorization::Cholesky] {
            let mut solver = Solver::new(&structure, kind, 1).unwrap();
            let mut taken = vec![false; solver.values().len()];
            taken[solver.spare()] = true;
            for i in 0..n {
                for j in 0..n {
                    let slot = solver.slot(i, j);
                    let (g, h) = (group[i], group[j]);
                    let coupled = g == h || structure.connectivity.iter().any(|c| c.contains(&g) && c.contains(&h));
                    assert_eq!(slot.is_some(), coupled, "{kind:?} ({i}, {j})");
                    if let (Some(slot), true) = (slot, !solver.is_symmetric() || i >= j) {
                        assert!(!std::mem::replace(&mut taken[slot], true), "{kind:?} ({i}, {j})");
                    }
                    if solver.is_symmetric() {
                        assert_eq!(slot, solver.slot(j, i));
                    }
                }
            }
            assert_eq!(solver.slot(n, 0), None);
        }
    }
}

#[test]
fn the_row_of_a_vanishing_pivot_is_named_and_the_solver_lives_on() {
    let mut random = Random(3);
    for structure in shapes(&mut random).into_iter().filter(|s| !s.sizes.is_empty()) {
        let good = entries(&structure, Values::Definite, &mut random);
        let first: Vec<usize> =
            structure.sizes.iter().scan(0, |sum, s| Some(std::mem::replace(sum, *sum + s))).collect();
        for kind in [Factorization::BlockLu, Factorization::Cholesky] {
            let mut solver = Solver::new(&structure, kind, 1).unwrap();
            let all = slots(&solver, &good);

            // A row and its column are zero.
            let row = random.below(unknowns(&structure));
            let without: Vec<_> = good.iter().copied().filter(|&(i, j, _)| i != row && j != row).collect();
            let kept = slots(&solver, &without);
            fill(&mut solver, &kept);
            assert_eq!(solver.factor().unwrap_err().row, row, "{kind:?}");

            // A group is held by nothing.
            let g = random.below(structure.sizes.len());
            let rows = first[g]..first[g] + structure.sizes[g];
            let without: Vec<_> =
                good.iter().copied().filter(|(i, j, _)| !rows.contains(i) && !rows.contains(j)).collect();
            let kept = slots(&solver, &without);
            fill(&mut solver, &kept);
            assert!(rows.contains(&solver.factor().unwrap_err().row), "{kind:?}");

            // A number that is none.
            for bad in [f64::NAN, f64::INFINITY] {
                fill(&mut solver, &all);
                let slot = all[random.below(all.len())].0;
                solver.values()[slot] = bad;
                assert!(solver.factor().is_err(), "{kind:?} {bad}");
            }

            check(&mut solver, &structure, Values::Definite, &mut random);
        }
    }
}

/// Springs between neighbours and none to the ground: the exact pivot of the last is zero, rounding leaves a little.
#[test]
fn a_floating_chain_of_springs_is_singular() {
    for n in [2, 10, 300] {
        let structure = chain(n, 1);
        for kind in [Factorization::BlockLu, Factorization::Cholesky] {
            let mut solver = Solver::new(&structure, kind, 1).unwrap();
            let mut random = Random(n as u64);
            let springs = (1..n).flat_map(|i| {
                let k = 2.0 + random.number();
                [(i, i, k), (i - 1, i - 1, k), (i, i - 1, -k), (i - 1, i, -k)]
            });
            let slots = slots(&solver, &springs.collect::<Vec<_>>());
            fill(&mut solver, &slots);
            assert!(solver.factor().is_err(), "{n} {kind:?}");
        }
    }
}

/// A slender cantilever of plane beams, axial 10⁴ times stiffer than bending, oblique to the axes: stiffnesses far
/// apart meet in each block, and its inverse is what the LU keeps. The error is measured backwards,
/// ‖b − K x‖ / (‖K‖ ‖x‖ + ‖b‖).
#[test]
fn stiff_directions_do_not_spoil_the_soft_ones() {
    let n = 50;
    let structure = chain(n, 3);
    let (c, s) = (0.6_f64.cos(), 0.6_f64.sin());
    #[rustfmt::skip]
    let local = DMatrix::from_row_slice(6, 6, &[
        1e4, 0., 0., -1e4, 0., 0.,   0., 12., 6., 0., -12., 6.,   0., 6., 4., 0., -6., 2.,
        -1e4, 0., 0., 1e4, 0., 0.,   0., -12., -6., 0., 12., -6.,  0., 6., 2., 0., -6., 4.,
    ]);
    #[rustfmt::skip]
    let turn = DMatrix::from_row_slice(6, 6, &[
        c, s, 0., 0., 0., 0.,  -s, c, 0., 0., 0., 0.,  0., 0., 1., 0., 0., 0.,
        0., 0., 0., c, s, 0.,  0., 0., 0., -s, c, 0.,  0., 0., 0., 0., 0., 1.,
    ]);
    let element = turn.transpose() * local * turn;
    let beam = |first: usize| (0..36).map(move |e| (first + e / 6, first + e % 6, (e / 6, e % 6)));
    let mut entries: Vec<_> = (1..n).flat_map(|g| beam(3 * g - 3)).map(|(i, j, at)| (i, j, element[at])).collect();
    entries.extend((0..9).map(|e| (e / 3, e % 3, element[(3 + e / 3, 3 + e % 3)])));
    let matrix = dense(3 * n, &entries);
    let b = DVector::from_fn(3 * n, |i, _| if i == 3 * n - 2 { 1.0 } else { 0.0 });
    for kind in [Factorization::BlockLu, Factorization::Cholesky] {
        let mut solver = Solver::new(&structure, kind, 1).unwrap();
        let slots = slots(&solver, &entries);
        fill(&mut solver, &slots);
        solver.factor().unwrap();
        let mut x = b.clone();
        solver.solve(x.as_mut_slice());
        let residual = &matrix * &x - &b;
        let error = residual.norm() / (matrix.norm() * x.norm() + b.norm());
        let deflection = (n as f64).powi(3) / 3.0 * c * c;
        assert!(error <= 1e-16, "{kind:?}: {error:e}");
        assert!((x[3 * n - 2] / deflection - 1.0).abs() <= 1e-3, "{kind:?}");
    }
}

/// A block without a diagonal needs its rows exchanged.
#[test]
fn rows_are_exchanged_within_a_block() {
    let structure =
        Structure { sizes: vec![6, 6], connectivity: vec![vec![0, 1]], multipliers: 0, positions: Vec::new() };
    let mut solver = Solver::new(&structure, Factorization::BlockLu, 1).unwrap();
    let matrix = DMatrix::from_fn(12, 12, |i, j| match ((i + 1) % 6 == j % 6, i / 6 == j / 6) {
        (true, true) => 2.0 + i as f64,
        (true, false) => 0.3,
        _ => 0.0,
    });
    let entries: Vec<_> = (0..144).map(|e| (e / 12, e % 12, matrix[(e / 12, e % 12)])).collect();
    let slots = slots(&solver, &entries);
    fill(&mut solver, &slots);
    solver.factor().unwrap();
    let b = DVector::from_fn(12, |i, _| 1.0 + i as f64);
    let mut x = b.clone();
    solver.solve(x.as_mut_slice());
    assert!((&matrix * &x - &b).norm() <= 1e-13 * b.norm());
}

#[test]
fn chains_go_to_blocks_and_large_frames_to_cholesky() {
    assert_eq!(Factorization::choose(&chain(2, 6)), Factorization::BlockLu);
    assert_eq!(Factorization::choose(&chain(2000, 6)), Factorization::BlockLu);
    assert_eq!(Factorization::choose(&frame(10, 6, 6, 6)), Factorization::Cholesky);
    assert_eq!(
        Factorization::choose(&Structure {
            sizes: vec![],
            connectivity: vec![],
            multipliers: 0,
            positions: Vec::new()
        }),
        Factorization::BlockLu
    );
}

#[test]
fn threads_do_not_change_a_bit() {
    let structure = frame(11, 11, 11, 6);
    for values in [Values::Definite, Values::Indefinite] {
        let entries = entries(&structure, values, &mut Random(4));
        let solutions = [1, 2, 3].map(|threads| {
            let mut solver = Solver::new(&structure, Factorization::Cholesky, threads).unwrap();
            assert!(solver.stats().flops > 5e8, "too small for threads: {}", solver.describe());
            let slots = slots(&solver, &entries);
            fill(&mut solver, &slots);
            solver.factor().unwrap();
            let mut b: Vec<f64> = (0..unknowns(&structure)).map(|i| (i as f64).sin()).collect();
            solver.solve(&mut b);
            b
        });
        assert!(solutions[0] == solutions[1] && solutions[0] == solutions[2], "{values:?}");
    }
}

#[test]
fn right_hand_sides_together_have_the_bits_of_each_alone() {
    let mut random = Random(11);
    // A large one has panels that are taken in blocks, and supernodes above its subtrees.
    let structures = shapes(&mut random).into_iter().chain([sheet(60, 60, 6), frame(9, 9, 9, 6)]);
    for (structure, threads) in structures.zip([1, 2, 3].into_iter().cycle()) {
        let n = unknowns(&structure);
        for (kind, values) in [
            (Factorization::BlockLu, Values::Unsymmetric),
            (Factorization::Cholesky, Values::Definite),
            (Factorization::Cholesky, Values::Indefinite),
        ] {
            if n > 1000 && kind == Factorization::BlockLu {
                continue;
            }
            let mut solver = Solver::new(&structure, kind, threads).unwrap();
            let slots = slots(&solver, &entries(&structure, values, &mut random));
            fill(&mut solver, &slots);
            solver.factor().unwrap();
            for sides in 0..8 {
                let b: Vec<Vec<f64>> = (0..sides).map(|_| (0..n).map(|_| random.number()).collect()).collect();
                let (mut together, mut alone) = (b.clone(), b);
                solver.solve_all(&mut together);
                alone.iter_mut().for_each(|b| solver.solve(b));
                assert!(together == alone, "{sides} of {}", solver.describe());
            }
        }
    }
}

/// Fronts of every kind: subtrees on stacks of their own, those above them, dense operations cut in halves. Rounding of a
/// backward stable factorisation of some thousand rows leaves less than 1e-15 of the largest product; the bound is tenfold.
#[test]
fn large_sheets_and_frames_leave_no_residual() {
    for structure in [sheet(60, 50, 6), sheet(45, 80, 5), frame(9, 10, 11, 6)] {
        let entries = entries(&structure, Values::Definite, &mut Random(8));
        let n = unknowns(&structure);
        let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        for threads in [1, 3] {
            let mut solver = Solver::new(&structure, Factorization::Cholesky, threads).unwrap();
            assert!(solver.stats().flops > 1e8, "too small to be cut: {}", solver.describe());
            let slots = slots(&solver, &entries);
            // Twice: what is left of a factorisation does not enter the next.
            for _ in 0..2 {
                fill(&mut solver, &slots);
                solver.factor().unwrap();
                assert_eq!(solver.negative_eigenvalues(), 0);
            }
            let mut x = b.clone();
            solver.solve(&mut x);
            let (mut residual, mut size) = (b.clone(), vec![0.0; n]);
            for &(i, j, value) in &entries {
                residual[i] -= value * x[j];
                size[i] += (value * x[j]).abs();
            }
            let worst = residual.iter().zip(&size).map(|(r, size)| r.abs() / size).fold(0.0, f64::max);
            assert!(worst <= 1e-14, "{}: {worst:e}", solver.describe());
        }
    }
}

/// Blocks of two groups lie where their entries do.
#[test]
fn blocks_lie_where_their_entries_do() {
    let structure = Structure {
        sizes: vec![6, 6, 5, 6, 6, 3],
        connectivity: vec![vec![0, 1, 2], vec![4, 1, 5], vec![3, 4]],
        multipliers: 0,
        positions: Vec::new(),
    };
    let solver = Solver::new(&structure, Factorization::Cholesky, 1).unwrap();
    let first = [0, 6, 12, 17, 23, 29];
    let (mut there, mut missing) = (0, 0);
    for g in 0..structure.sizes.len() {
        for h in 0..structure.sizes.len() {
            let Some((block, swapped)) = solver.block_slot(first[g], first[h]) else {
                missing += 1;
                continue;
            };
            there += 1;
            let (row, col) = if swapped { (first[h], first[g]) } else { (first[g], first[h]) };
            for j in 0..6 {
                for i in if g == h { j } else { 0 }..6 {
                    let slot = solver.slot(row + i, col + j);
                    assert_eq!(slot, Some(block.column(j) + i), "{g} {h} {i} {j}");
                }
            }
        }
    }
    // Four groups of six by themselves and three couplings of them, both ways.
    assert_eq!((there, missing), (4 + 6, 36 - 10));
    assert!(Solver::new(&structure, Factorization::BlockLu, 1).unwrap().block_slot(first[0], first[1]).is_none());
}

/// Diagonals outweigh their rows, so by Gershgorin's circles the negative ones tell the negative eigenvalues.
#[test]
fn negative_eigenvalues_are_counted() {
    let mut random = Random(17);
    for structure in
        [chain(20, 6), chain(20, 3), frame(3, 3, 3, 6), tree(40, &mut Random(3)), connectivity(30, &mut Random(4))]
    {
        for (values, negative) in [(Values::Definite, false), (Values::Indefinite, true)] {
            let expected: usize = structure.sizes.iter().skip(1).step_by(3).sum();
            for kind in [Factorization::BlockLu, Factorization::Cholesky] {
                let mut solver = Solver::new(&structure, kind, 1).unwrap();
                let slots = slots(&solver, &entries(&structure, values, &mut random));
                fill(&mut solver, &slots);
                solver.factor().unwrap();
                assert_eq!(solver.negative_eigenvalues(), if negative { expected } else { 0 }, "{kind:?} {values:?}");
            }
        }
    }
}

/// Two springs side by side that pull each other's way: zeros on the diagonal, one eigenvalue of each sign in every group.
#[test]
fn negative_eigenvalues_off_the_diagonal_are_counted() {
    let structure = chain(5, 2);
    let mut solver = Solver::new(&structure, Factorization::BlockLu, 1).unwrap();
    let entries: Vec<_> = (0..5).flat_map(|g| [(2 * g, 2 * g + 1, 1.0), (2 * g + 1, 2 * g, 1.0)]).collect();
    let slots = slots(&solver, &entries);
    fill(&mut solver, &slots);
    solver.factor().unwrap();
    assert_eq!(solver.negative_eigenvalues(), 5);
}

/// Against the determinant of the same matrix by LU with exchange of rows.
#[test]
fn the_sign_of_a_determinant_is_told_of_matrices_that_are_not_symmetric() {
    let mut random = Random(23);
    let mut negative = 0;
    for structure in [chain(7, 3), chain(5, 6), frame(2, 2, 2, 6)] {
        for _ in 0..20 {
            let mut solver = Solver::new(&structure, Factorization::BlockLu, 1).unwrap();
            let n: usize = structure.sizes.iter().sum();
            let mut A = DMatrix::zeros(n, n);
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                if let Some(slot) = solver.slot(i, j) {
                    A[(i, j)] = random.number();
                    solver.values()[slot] = A[(i, j)];
                }
            }
            solver.factor().unwrap();
            let expected = A.determinant() < 0.0;
            assert_eq!(solver.is_determinant_negative(), expected);
            negative += usize::from(expected);
        }
    }
    assert!((20..40).contains(&negative), "{negative}");
}

/// A factorisation that is stopped leaves no factors; the next has the bits of one that nobody has stopped, whatever memory was given back.
#[test]
fn a_factorisation_that_is_stopped_costs_the_next_nothing() {
    let mut random = Random(7);
    let structure = sheet(24, 24, 6);
    for threads in [1, 2] {
        let mut solver = Solver::new(&structure, Factorization::Cholesky, threads).unwrap();
        let entries = entries(&structure, Values::Definite, &mut random);
        let slots = slots(&solver, &entries);
        let b: Vec<f64> = (0..unknowns(&structure)).map(|_| random.number()).collect();
        let solved = |solver: &mut Solver| {
            let mut x = b.clone();
            solver.solve(&mut x);
            x
        };
        fill(&mut solver, &slots);
        assert_eq!(solver.factor_unless(&|| false), Ok(true));
        let first = solved(&mut solver);
        fill(&mut solver, &slots);
        assert_eq!(solver.factor_unless(&|| true), Ok(false));
        solver.rest();
        fill(&mut solver, &slots);
        solver.factor().unwrap();
        solver.rest();
        assert!(solved(&mut solver) == first, "{threads} threads");
        // L D Lᵀ of the same matrix: other roundings, and no negative pivot.
        fill(&mut solver, &slots);
        solver.factor_indefinite().unwrap();
        assert_eq!(solver.negative_eigenvalues(), 0);
        let other = solved(&mut solver);
        let size = first.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        assert!(first.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-11 * size), "{threads} threads");
    }
}
