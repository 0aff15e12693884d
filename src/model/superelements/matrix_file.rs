//! Matrices in files: Matrix Market, as coordinates or as an array, and `*MATRIX` of Abaqus, the upper half column by column.

use base::text_file::{Fault, Text, TextLine, Word};
use nalgebra::DMatrix;

/// What a matrix is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixType {
    /// Force per displacement.
    Stiffness,
    /// Force per acceleration.
    Mass,
    /// Force per velocity.
    Damping,
}

/// The largest number of rows: a larger full matrix is slower than its mesh.
const MOST_ROWS: usize = 1500;

/// Reads a square matrix; of Abaqus the first of its type.
///
/// # Errors
/// The text is no matrix of these formats.
pub fn read(path: &str, bytes: &[u8], kind: MatrixType) -> Result<DMatrix<f64>, Fault> {
    let mut text = Text::new(path, bytes);
    match text.line() {
        Some(line) if line.bytes.to_ascii_lowercase().starts_with(b"%%matrixmarket") => market(&mut text, line),
        Some(line) => abaqus(&mut text, line, kind),
        None => Err(text.fault_at_end("the file is empty")),
    }
}

fn market(text: &mut Text, head: TextLine) -> Result<DMatrix<f64>, Fault> {
    let words: Vec<String> = head.words().map(|word| word.text().to_ascii_lowercase()).collect();
    let word = |k: usize| words.get(k).map_or("", String::as_str);
    let is_listed = match word(2) {
        "coordinate" => true,
        "array" => false,
        _ => return Err(text.fault("the matrix is neither of the format `coordinate` nor `array`", head.number)),
    };
    if !matches!(word(3), "real" | "double" | "integer") {
        return Err(text.fault("the entries must be `real`", head.number));
    }
    let is_half = match word(4) {
        "symmetric" => true,
        "general" => false,
        _ => return Err(text.fault("the matrix must be `general` or `symmetric`", head.number)),
    };
    let mut numbers = Numbers { text, line: Vec::new(), next: 0 };
    let (rows, columns) = (numbers.whole()?, numbers.whole()?);
    if rows != columns || rows == 0 || rows > MOST_ROWS {
        return Err(numbers.fault(format!(
            "the matrix has {rows} rows and {columns} columns; it must be square, of {MOST_ROWS} rows at most"
        )));
    }
    let mut matrix = DMatrix::zeros(rows, rows);
    let mut set = |i: usize, j: usize, value: f64| {
        matrix[(i, j)] = value;
        if is_half {
            matrix[(j, i)] = value;
        }
    };
    if is_listed {
        let mut given = vec![false; rows * rows];
        for _ in 0..numbers.whole()? {
            let (i, j) = (numbers.whole()?, numbers.whole()?);
            if !(1..=rows).contains(&i) || !(1..=rows).contains(&j) {
                return Err(numbers.fault(format!("the entry ({i}, {j}) lies outside the matrix of {rows} rows")));
            }
            let places = [(i - 1) * rows + j - 1, (j - 1) * rows + i - 1];
            if given[places[0]] || is_half && given[places[1]] {
                return Err(numbers.fault(format!("the entry ({i}, {j}) stands here twice")));
            }
            given[places[0]] = true;
            set(i - 1, j - 1, numbers.number()?);
        }
    } else {
        for column in 0..rows {
            for row in if is_half { column } else { 0 }..rows {
                set(row, column, numbers.number()?);
            }
        }
    }
    Ok(matrix)
}

/// The words of a file one after the other, without lines of comments.
struct Numbers<'a, 't> {
    text: &'a mut Text<'t>,
    line: Vec<Word<'t>>,
    next: usize,
}

impl<'t> Numbers<'_, 't> {
    fn word(&mut self) -> Result<Word<'t>, Fault> {
        while self.next == self.line.len() {
            let Some(line) = self.text.line() else {
                return Err(self.text.fault_at_end("the file ends before the matrix does"));
            };
            self.line = if line.bytes.starts_with(b"%") { Vec::new() } else { line.words().collect() };
            self.next = 0;
        }
        self.next += 1;
        Ok(self.line[self.next - 1])
    }

    fn number(&mut self) -> Result<f64, Fault> {
        let word = self.word()?;
        word.fortran_number().ok_or_else(|| self.text.fault_at("a finite number must stand here", &word))
    }

    fn whole(&mut self) -> Result<usize, Fault> {
        let word = self.word()?;
        let whole = word.whole().and_then(|whole| usize::try_from(whole).ok());
        whole.ok_or_else(|| self.text.fault_at("a whole number must stand here", &word))
    }

    /// A fault at the word that was read last.
    fn fault(&self, message: String) -> Fault {
        self.text.fault_at(message, &self.line[self.next.saturating_sub(1)])
    }
}

/// The numbers of the first `*MATRIX` with this `TYPE`, or of a file with one that has none.
fn abaqus(text: &mut Text, first: TextLine, kind: MatrixType) -> Result<DMatrix<f64>, Fault> {
    let word = match kind {
        MatrixType::Stiffness => "STIFFNESS",
        MatrixType::Mass => "MASS",
        MatrixType::Damping => "DAMPING",
    };
    let mut entries: Vec<f64> = Vec::new();
    let (mut is_inside, mut begun) = (false, None);
    let mut next = Some(first);
    while let Some(line) = next {
        let upper: String = String::from_utf8_lossy(line.bytes).to_ascii_uppercase().replace(' ', "");
        if upper.starts_with("**") {
        } else if upper.starts_with('*') {
            if begun.is_some() {
                break;
            }
            if ["*USERELEMENT,", "*MATRIX,"].iter().any(|key| upper.starts_with(key)) && upper.contains("UNSYMM") {
                return Err(text
                    .fault("matrices that are not symmetric are not read: take out UNSYMM and one half", line.number));
            }
            is_inside = upper.starts_with("*MATRIX,") && upper.split(',').any(|part| part == format!("TYPE={word}"));
            if is_inside {
                begun = Some(line.number);
            }
        } else if is_inside {
            for field in line.fields().filter(|field| !field.bytes.is_empty()) {
                let number = field.fortran_number();
                entries.push(number.ok_or_else(|| text.fault_at("a finite number must stand here", &field))?);
            }
        }
        next = text.line();
    }
    let Some(begun) = begun else {
        let message = format!("the file is no Matrix Market file, and has no `*MATRIX, TYPE={word}`");
        return Err(text.fault_at_end(message));
    };
    let rows = ((8 * entries.len() + 1).isqrt() - 1) / 2;
    if rows == 0 || rows > MOST_ROWS || rows * (rows + 1) / 2 != entries.len() {
        let message = format!(
            "the matrix has {} numbers; the upper half of n rows has n (n + 1)/2, and n is {MOST_ROWS} at most",
            entries.len()
        );
        return Err(text.fault(message, begun));
    }
    let mut matrix = DMatrix::zeros(rows, rows);
    let mut entries = entries.into_iter();
    for column in 0..rows {
        for row in 0..=column {
            let entry = entries.next().unwrap_or(0.0);
            (matrix[(row, column)], matrix[(column, row)]) = (entry, entry);
        }
    }
    Ok(matrix)
}
