//! The files of superelements: they are read before the model is built.

use super::matrix_file::{self, MatrixType};
use crate::data::RecordFile;
use base::diagnostic::{At, Diagnostic};
use base::text_file::read_regular;
use deck::Deck;
use deck::superelements::Superelement;
use nalgebra::DMatrix;
use sha2::{Digest, Sha256};
use std::path::Path;

/// The matrices of a superelement as its files have them, all of the same size.
#[derive(Debug)]
pub struct GivenMatrices {
    /// Stiffness.
    pub stiffness: DMatrix<f64>,
    /// Mass.
    pub mass: Option<DMatrix<f64>>,
    /// Damping.
    pub damping: Option<DMatrix<f64>>,
    /// The files, for the model to remember.
    pub files: Vec<RecordFile>,
}

/// Reads the matrices of all superelements, in their order, from the deck's folder; `None` for those with errors.
pub fn load_matrices(deck: &Deck, folder: &Path) -> (Vec<Option<GivenMatrices>>, Vec<Diagnostic>) {
    let mut problems = Vec::new();
    let all = deck.superelements.iter().map(|table| load(table, folder, &mut problems)).collect();
    (all, problems)
}

fn load(table: &Superelement, folder: &Path, problems: &mut Vec<Diagnostic>) -> Option<GivenMatrices> {
    let mut files = Vec::new();
    let keys = [
        (&table.stiffness, MatrixType::Stiffness),
        (&table.mass, MatrixType::Mass),
        (&table.damping_matrix, MatrixType::Damping),
    ];
    let before = problems.len();
    let [stiffness, mass, damping] = keys.map(|(file, kind)| {
        let file = file.as_ref()?;
        match matrix(file, kind, folder) {
            Ok((matrix, origin)) => {
                files.push(origin);
                Some(matrix)
            }
            Err(problem) => {
                problems.push(problem);
                None
            }
        }
    });
    let (stiffness, size) = (stiffness?, problems.len());
    if size > before {
        return None;
    }
    for (matrix, file) in [(&mass, &table.mass), (&damping, &table.damping_matrix)] {
        if let (Some(matrix), Some(file)) = (matrix, file)
            && matrix.nrows() != stiffness.nrows()
        {
            let message =
                format!("`{}` has {} rows, and the stiffness has {}", file.value, matrix.nrows(), stiffness.nrows());
            let hint = "give matrices of the same unknowns in the same order";
            problems.push(Diagnostic::error(message).at(&file.span).hint(hint));
            return None;
        }
    }
    Some(GivenMatrices { stiffness, mass, damping, files })
}

fn matrix(file: &At<String>, kind: MatrixType, folder: &Path) -> Result<(DMatrix<f64>, RecordFile), Diagnostic> {
    let path = folder.join(&file.value).display().to_string();
    let bytes = read_regular(Path::new(&path)).map_err(|error| {
        let message = format!("cannot read the matrix `{path}`: {error}");
        Diagnostic::error(message).at(&file.span).hint("the path is relative to the deck's folder")
    })?;
    let matrix = matrix_file::read(&path, &bytes, kind).map_err(|fault| fault.at(&file.span))?;
    Ok((matrix, RecordFile { path, digest: Sha256::digest(&bytes).into() }))
}
