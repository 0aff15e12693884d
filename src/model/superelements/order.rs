//! The order of the rows of matrices: by the points and their directions, or as `unknowns` has it.

use crate::data::DIRECTIONS;
use crate::report::{Owner, Report};
use base::math::Mat3;
use deck::superelements as words;
use nalgebra::DMatrix;

/// The place of each row of the files among six degrees of freedom of each point, then amplitudes.
pub struct UnknownOrder {
    places: Vec<usize>,
    points: usize,
    /// The number of amplitudes.
    pub modes: usize,
}

/// The word of a modal amplitude in `unknowns`.
const MODE: &str = "mode";

/// The order of the rows of a matrix of this size.
pub fn rows<'d>(
    owner: &Owner<'d>,
    table: &'d words::Superelement,
    (turns, size): (bool, usize),
    report: &mut Report<'d>,
) -> Option<UnknownOrder> {
    let names = &table.nodes.as_ref()?.value.values;
    let (points, each) = (names.len(), if turns { 6 } else { 3 });
    if size < each * points {
        let message = format!(
            "{} has matrices of {size} rows, and its {points} points have {} degrees of freedom",
            owner.what,
            each * points
        );
        let hint = "with matrices of displacements alone give `dofs` = \"translations\"";
        return report.error_with(&table.stiffness.as_ref()?.span, message, hint);
    }
    let modes = size - each * points;
    let by_points = (0..each * points).map(|row| row / each * 6 + row % each);
    let Some(list) = &table.unknowns else {
        let places = by_points.chain((0..modes).map(|mode| 6 * points + mode)).collect();
        return Some(UnknownOrder { places, points, modes });
    };
    if list.values.len() != size {
        let message = format!("`unknowns` has {} names, and the matrices {size} rows", list.values.len());
        return report.error_with(&list.span, message, "give one for each row");
    }
    let mut places: Vec<usize> = Vec::new();
    let mut found = 0;
    for unknown in &list.values {
        let place = match unknown.as_str() {
            MODE => {
                found += 1;
                Some(6 * points + found - 1)
            }
            name => of_point(name, names.iter().map(|at| at.as_str()), each),
        };
        match place.filter(|place| !places.contains(place)) {
            Some(place) => places.push(place),
            None => {
                let message = format!("`{}` is no unknown of {}, or stands here twice", unknown.value, owner.what);
                let hint = format!(
                    "write a point of `nodes` with a direction, such as \"{}.uz\", or \"{MODE}\"",
                    names[0].value
                );
                return report.error_with(&unknown.span, message, hint);
            }
        }
    }
    if found != modes {
        let message =
            format!("`unknowns` has {found} modes, and the matrices have {modes} rows beyond those of the points");
        return report.error_with(&list.span, message, "name each direction of each point once");
    }
    Some(UnknownOrder { places, points, modes })
}

/// The place of "tip.uz".
fn of_point<'n>(name: &str, mut names: impl Iterator<Item = &'n str>, each: usize) -> Option<usize> {
    let (point, direction) = name.rsplit_once('.')?;
    let direction = DIRECTIONS[..each].iter().position(|word| *word == direction)?;
    Some(6 * names.position(|name| name == point)? + direction)
}

impl UnknownOrder {
    /// A matrix of the files in the order of the superelement, with components turned from `axes` to global ones.
    pub fn in_order(&self, matrix: &DMatrix<f64>, axes: &Mat3, turns: bool) -> DMatrix<f64> {
        let size = 6 * self.points + self.modes;
        let mut ordered = DMatrix::zeros(size, size);
        for (i, &row) in self.places.iter().enumerate() {
            for (j, &column) in self.places.iter().enumerate() {
                ordered[(row, column)] = matrix[(i, j)];
            }
        }
        let mut turn = DMatrix::identity(size, size);
        let vectors = if turns { 2 } else { 1 };
        for point in 0..self.points {
            (0..vectors)
                .for_each(|k| turn.fixed_view_mut::<3, 3>(6 * point + 3 * k, 6 * point + 3 * k).copy_from(axes));
        }
        &turn * ordered * turn.transpose()
    }
}
