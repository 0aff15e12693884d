//! Columns as a user names them: `ux` in any file, `nodes.csv` with all of its columns, `nodes.csv:ux`.

use std::str::FromStr;

/// Some columns, by file, by name, or by both; by neither, all.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Selector {
    /// The name of the file; `None` means any file.
    pub file: Option<String>,
    /// The name of the column; `None` means any column.
    pub column: Option<String>,
}

impl Selector {
    /// Whether a column of a file is among those that are meant.
    pub fn takes(&self, file: &str, column: &str) -> bool {
        self.file.as_deref().is_none_or(|name| name == file) && self.column.as_deref().is_none_or(|name| name == column)
    }

    /// The rank of a selector: the name of a column counts more than the name of a file.
    fn closeness(&self) -> usize {
        2 * usize::from(self.column.is_some()) + usize::from(self.file.is_some())
    }
}

impl FromStr for Selector {
    type Err = String;

    fn from_str(word: &str) -> Result<Selector, String> {
        let (file, column) = match word.split_once(':') {
            Some((file, column)) => (Some(file), Some(column)),
            None if word.ends_with(".csv") => (Some(word), None),
            None => (None, Some(word)),
        };
        if file == Some("") || column == Some("") {
            return Err("write `ux`, `nodes.csv` or `nodes.csv:ux`".into());
        }
        Ok(Selector { file: file.map(String::from), column: column.map(String::from) })
    }
}

/// A tolerance for some columns, or for all.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnTolerance {
    /// The columns that it is for.
    pub of: Selector,
    /// The largest difference that passes, relative to the scale of the column.
    pub value: f64,
}

impl FromStr for ColumnTolerance {
    type Err = String;

    fn from_str(word: &str) -> Result<ColumnTolerance, String> {
        let (of, value) = match word.rsplit_once('=') {
            Some((of, value)) => (of.parse()?, value),
            None => (Selector::default(), word),
        };
        Ok(ColumnTolerance { of, value: size(value)? })
    }
}

/// Reads a tolerance, for clap.
///
/// # Errors
/// The word is not a finite number, or is negative.
pub fn size(word: &str) -> Result<f64, String> {
    let value: f64 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
    if value.is_finite() && value >= 0.0 { Ok(value) } else { Err("a tolerance is finite and not negative".into()) }
}

/// The tolerance that names a column most closely, and of several alike the last.
pub fn closest<'t>(all: &'t [ColumnTolerance], file: &str, column: &str) -> Option<&'t ColumnTolerance> {
    all.iter().filter(|tolerance| tolerance.of.takes(file, column)).max_by_key(|tolerance| tolerance.of.closeness())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closest_name_wins() {
        let all: Vec<ColumnTolerance> =
            ["1e-3", "nodes.csv:ux=1", "ux=2", "nodes.csv=3", "nodes.csv=4"].map(|word| word.parse().unwrap()).into();
        let value = |file, column| closest(&all, file, column).unwrap().value;
        assert_eq!(value("nodes.csv", "ux"), 1.0);
        assert_eq!(value("other.csv", "ux"), 2.0);
        assert_eq!(value("nodes.csv", "uy"), 4.0);
        assert_eq!(value("other.csv", "uy"), 1e-3);
        for wrong in ["", "a", "ux=-1", "=1", "nodes.csv:=1", "ux=inf", "ux=NaN"] {
            assert!(wrong.parse::<ColumnTolerance>().is_err(), "{wrong}");
        }
    }
}
