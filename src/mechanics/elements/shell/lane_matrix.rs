//! The matrices of eight shell elements side by side: how a half of them becomes whole.

use base::math::lanes::Lanes;
use base::math::number::LaneVec3;

/// The matrices of eight elements: node and component of the row, then of the column.
pub(super) type LaneMatrix<const N: usize> = [[[[Lanes; 6]; N]; 6]; N];

/// Σ over so many indices.
#[inline(always)]
pub(super) fn product(of: impl Fn(usize) -> Lanes, count: usize) -> Lanes {
    let mut sum = of(0);
    (1..count).for_each(|i| sum += of(i));
    sum
}

/// Subtracts the matrix of c × at the position of `a` and the rotation of `b`.
#[inline(always)]
pub(super) fn subtract_skew<const N: usize>(LaneVec3([x, y, z]): &LaneVec3, a: usize, b: usize, H: &mut LaneMatrix<N>) {
    for (i, j, s) in [(1, 2, *x), (2, 0, *y), (0, 1, *z)] {
        H[a][i][b][3 + j] += s;
        H[a][j][b][3 + i] -= s;
    }
}

/// The whole matrix from its upper half without the position of the first node.
#[inline(always)]
pub(super) fn complete<const N: usize>(H: &mut LaneMatrix<N>) {
    for i in 0..3 {
        for b in 1..N {
            for j in 0..3 {
                // Blocks of positions are filled for a ≤ b only.
                let column = |a: usize| if a <= b { H[a][i][b][j] } else { H[b][j][a][i] };
                let first = Lanes::ZERO - product(|a| column(a + 1), N - 1);
                H[0][i][b][j] = first;
            }
        }
        for b in 0..N {
            for j in 3..6 {
                H[0][i][b][j] = Lanes::ZERO - product(|a| H[a + 1][i][b][j], N - 1);
            }
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            H[0][i][0][j] = Lanes::ZERO - product(|b| H[0][i][b + 1][j], N - 1);
        }
    }
    for a in 0..N {
        for i in 0..6 {
            for b in 0..N {
                for j in 0..6 {
                    let is_lower = match (i < 3, j < 3) {
                        (true, true) | (false, false) => (a, i) > (b, j),
                        (row, _) => !row,
                    };
                    if is_lower {
                        H[a][i][b][j] = H[b][j][a][i];
                    }
                }
            }
        }
    }
}

/// The rows and columns of the position of the first node, whatever they hold, from the others.
pub(super) fn hold_translations<const N: usize>(H: &mut LaneMatrix<N>) {
    for a in 0..N {
        for i in 0..6 {
            (0..3).for_each(|j| H[a][i][0][j] = Lanes::ZERO - product(|b| H[a][i][b + 1][j], N - 1));
        }
    }
    for b in 0..N {
        for j in 0..6 {
            (0..3).for_each(|i| H[0][i][b][j] = Lanes::ZERO - product(|a| H[a + 1][i][b][j], N - 1));
        }
    }
}
