//! L D Lᵀ of one front, without exchange of rows: as accurate as the leading minors are away from zero.

use super::dense::{gemm, syrk, trsm};
use super::packed::Packed;
use faer::dyn_stack::{MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::{LdltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, Par};

/// Columns eliminated together.
const BLOCK: usize = 128;

/// The scratch for panels of up to so many columns and rows, and the numbers of L D.
pub(super) fn ldlt_scratch(columns: usize, rows: usize) -> (StackReq, usize) {
    let block = columns.min(BLOCK);
    (cholesky_in_place_scratch::<f64>(block, Par::Seq, Default::default()), rows * block)
}

/// Eliminates the columns of a panel, which becomes L with D on its diagonal, and writes −L D Lᵀ of the rows below its square to a packed
/// triangle.
///
/// # Errors
/// The column whose pivot is zero or not finite.
pub(super) fn ldlt(
    mut panel: MatMut<f64>,
    (shape, update): (Packed, &mut [f64]),
    scaled: &mut [f64],
    scratch: &mut MemStack,
    threads: bool,
) -> Result<(), usize> {
    let columns = panel.ncols();
    for begin in (0..columns).step_by(BLOCK) {
        let count = BLOCK.min(columns - begin);
        let right = columns - begin - count;
        let (block, rest) = panel.rb_mut().split_at_row_mut(begin).1.split_at_col_mut(begin).1.split_at_col_mut(count);
        let (mut square, mut below) = block.split_at_row_mut(count);
        let done = cholesky_in_place(square.rb_mut(), Default::default(), Par::Seq, scratch, Default::default());
        done.map_err(|LdltError::ZeroPivot { index }| begin + index)?;

        // With L D in `below` it is divided by D.
        trsm(square.rb(), below.rb_mut(), true, threads);
        let rows = below.nrows();
        let mut scaled = MatMut::from_column_major_slice_mut(&mut scaled[..rows * count], rows, count);
        scaled.copy_from(below.rb());
        for j in 0..count {
            let pivot = square[(j, j)];
            below.rb_mut().col_mut(j).iter_mut().for_each(|l| *l /= pivot);
        }

        let (L_right, L_below) = below.rb().split_at_row(right);
        let (LD_right, LD_below) = scaled.rb().split_at_row(right);
        let (triangle, rectangle) = rest.split_at_row_mut(count).1.split_at_row_mut(right);
        syrk(Accum::Add, L_right, LD_right, triangle, threads);
        gemm(Accum::Add, L_below, LD_right, rectangle, threads);
        let accum = if begin == 0 { Accum::Replace } else { Accum::Add };
        shape.subtract(accum, (L_below, LD_below), update, threads);
    }
    Ok(())
}
