//! Rows of a comma separated table as text, in memory that is reused. Numbers are the shortest text that reads back to the same double.
//! Formatting numbers dominates the time of tables, so it belongs to a crate that is compiled with full optimisation.

/// The most bytes of a number with its comma.
const LONGEST: usize = 32;
/// From here on, exponents come with a plus, which tables omit: 1e16.
const LARGE: f64 = 1e16;

/// Finished rows, and the row that is being written.
#[derive(Debug, Default)]
pub struct RowText {
    bytes: Vec<u8>,
}

impl RowText {
    /// No rows yet, with room for so many bytes.
    pub fn with_capacity(bytes: usize) -> RowText {
        RowText { bytes: Vec::with_capacity(bytes) }
    }

    /// All rows.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Removes all rows; their memory stays.
    pub fn clear(&mut self) {
        self.bytes.clear();
    }

    /// Adds a whole row.
    pub fn line(&mut self, text: &str) {
        self.bytes.extend_from_slice(text.as_bytes());
        self.end();
    }

    /// Ends a row.
    pub fn end(&mut self) {
        self.bytes.push(b'\n');
    }

    /// Begins a row with a whole number.
    pub fn begin(&mut self, mut value: usize) {
        let (mut digits, mut at) = ([0; 20], 20);
        loop {
            at -= 1;
            digits[at] = b'0' + (value % 10) as u8;
            value /= 10;
            if value == 0 {
                break;
            }
        }
        self.bytes.extend_from_slice(&digits[at..]);
    }

    /// Adds a field with a whole number.
    pub fn count(&mut self, value: usize) {
        self.bytes.push(b',');
        self.begin(value);
    }

    /// Adds a field for each number, and returns how many fields stay empty because their number is not finite.
    pub fn numbers(&mut self, values: &[f64]) -> usize {
        self.bytes.reserve(LONGEST * values.len());
        let (mut digits, mut empty) = (zmij::Buffer::new(), 0);
        for &value in values {
            self.bytes.push(b',');
            if value.is_finite() {
                let text = digits.format_finite(value);
                if value.abs() < LARGE {
                    self.bytes.extend_from_slice(text.as_bytes());
                } else {
                    text.split('+').for_each(|part| self.bytes.extend_from_slice(part.as_bytes()));
                }
            } else {
                empty += 1;
            }
        }
        empty
    }

    /// Adds a field with a text, in quotes where it needs them.
    pub fn text(&mut self, text: &str) {
        self.bytes.push(b',');
        if text.contains([',', '"', '\n', '\r']) {
            self.bytes.extend_from_slice(format!("\"{}\"", text.replace('"', "\"\"")).as_bytes());
        } else {
            self.bytes.extend_from_slice(text.as_bytes());
        }
    }
}

/// The shortest text that reads back to the same number, or the word for one that is not finite.
pub fn shortest(number: f64) -> String {
    zmij::Buffer::new().format(number).replace('+', "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng, rngs::SmallRng};

    /// The text of a row with one number.
    fn written(value: f64) -> String {
        let mut row = RowText::default();
        row.begin(0);
        assert_eq!(row.numbers(&[value]), 0);
        String::from_utf8(row.bytes).unwrap()[2..].to_owned()
    }

    /// The standard library finds the shortest digits by another algorithm.
    #[test]
    fn numbers_are_the_shortest_text() {
        let mut random = SmallRng::seed_from_u64(3);
        let mut values =
            vec![0.0, -0.0, 1e15, 1e16, -2.5e16, 1e23, 5e-324, f64::MAX, f64::MIN_POSITIVE, 9007199254740993.0];
        values.extend((0..100_000).map(|_| f64::from_bits(random.next_u64())).filter(|x| x.is_finite()));
        for value in values {
            let text = written(value);
            let digits = |text: &str| {
                let mantissa = text.split('e').next().unwrap_or_default();
                mantissa.replace(['.', '-'], "").trim_matches('0').to_owned()
            };
            assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
            // Between two texts that are equally near, the algorithms choose differently.
            assert_eq!(digits(&text).len(), digits(&format!("{value:e}")).len(), "{text}");
            assert_eq!(text, shortest(value));
        }
    }

    #[test]
    fn numbers_have_the_form_that_tables_have() {
        let known = [
            (0.0, "0.0"),
            (-0.5, "-0.5"),
            (1e-5, "0.00001"),
            (1.5e-6, "1.5e-6"),
            (1234567890123456.0, "1234567890123456.0"),
            (1e16, "1e16"),
            (-1.25e300, "-1.25e300"),
        ];
        known.iter().for_each(|(value, text)| assert_eq!(written(*value), *text));
    }

    #[test]
    fn a_row_has_counts_numbers_empty_fields_and_texts() {
        let mut row = RowText::with_capacity(0);
        row.line("step,a,b,c");
        row.begin(1207);
        row.count(0);
        assert_eq!(row.numbers(&[1.0, f64::NAN, f64::INFINITY]), 2);
        row.text("a, \"b\"");
        row.end();
        row.begin(usize::MAX);
        row.end();
        let text = format!("step,a,b,c\n1207,0,1.0,,,\"a, \"\"b\"\"\"\n{}\n", usize::MAX);
        assert_eq!(row.bytes(), text.as_bytes());
        row.clear();
        assert!(row.bytes().is_empty());
    }
}
