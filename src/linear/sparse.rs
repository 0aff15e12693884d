//! A sparse matrix by rows for products: the assembled matrix without zeros.

/// A square sparse matrix by rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sparse {
    /// Start of each row in the lists, and their end.
    start: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Sparse {
    /// The matrix of `rows` rows with the entries that `each` passes to its visitor, twice in the same order. Entries of one place are
    /// added, and zeros are left out.
    pub fn from_entries(rows: usize, each: impl Fn(&mut dyn FnMut(usize, usize, f64))) -> Sparse {
        let mut start = vec![0; rows + 1];
        each(&mut |row, _, value| start[row + 1] += usize::from(value != 0.0));
        for row in 0..rows {
            start[row + 1] += start[row];
        }
        let mut next = start.clone();
        let (mut columns, mut values) = (vec![0; start[rows]], vec![0.0; start[rows]]);
        each(&mut |row, column, value| {
            if value != 0.0 {
                (columns[next[row]], values[next[row]]) = (column as u32, value);
                next[row] += 1;
            }
        });
        Sparse { start, columns, values }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// True where the matrix has no entry.
    pub fn is_zero(&self) -> bool {
        self.values.is_empty()
    }

    /// The columns and numbers of a row.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[row]..self.start[row + 1];
        self.columns[range.clone()].iter().map(|&column| column as usize).zip(self.values[range].iter().copied())
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (row, y) in y.iter_mut().enumerate() {
            *y = self.row(row).map(|(column, value)| value * x[column]).sum();
        }
    }

    /// A x for several vectors.
    pub fn products(&self, x: &[&[f64]]) -> Vec<Vec<f64>> {
        let product = |x: &&[f64]| {
            let mut y = vec![0.0; self.rows()];
            self.multiply(x, &mut y);
            y
        };
        x.iter().map(product).collect()
    }

    /// The combination Σ factor × matrix of matrices of the same size.
    pub fn sum(of: &[(f64, &Sparse)]) -> Sparse {
        let rows = of.iter().map(|(_, matrix)| matrix.rows()).max().unwrap_or(0);
        let merged = |visit: &mut dyn FnMut(usize, usize, f64)| {
            let mut row_sum = std::collections::BTreeMap::new();
            for row in 0..rows {
                row_sum.clear();
                for (factor, matrix) in of {
                    for (column, value) in matrix.row(row) {
                        *row_sum.entry(column).or_insert(0.0) += factor * value;
                    }
                }
                row_sum.iter().for_each(|(&column, &value)| visit(row, column, value));
            }
        };
        Sparse::from_entries(rows, merged)
    }

    /// Every entry by row and column, in the order of rows.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        (0..self.rows()).flat_map(|row| self.row(row).map(move |(column, value)| (row, column, value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_sums() {
        let of = |entries: &[(usize, usize, f64)]| {
            Sparse::from_entries(3, |visit| entries.iter().for_each(|&(i, j, a)| visit(i, j, a)))
        };
        let a = of(&[(0, 0, 2.0), (1, 2, -1.0), (0, 2, 3.0), (2, 1, 0.0)]);
        let b = of(&[(0, 2, -3.0), (2, 1, 4.0)]);
        let mut y = [0.0; 3];
        a.multiply(&[1.0, 10.0, 100.0], &mut y);
        assert_eq!(y, [302.0, -100.0, 0.0]);
        // 3 − 3 cancels, and zeros are left out.
        let sum = Sparse::sum(&[(1.0, &a), (1.0, &b)]);
        assert_eq!(sum.entries().collect::<Vec<_>>(), [(0, 0, 2.0), (1, 2, -1.0), (2, 1, 4.0)]);
    }
}
