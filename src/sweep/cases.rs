//! The cases of a sweep: overrides of the deck, one set for each.

use super::file::{MOST_CASES, SampleKind, SampleOfCases, SweepFile, VariedKey, VariedValues};
use super::sampling::{MOST_DIMENSIONS, latin_hypercube, sobol};
use base::text_file::read_regular;
use std::path::Path;

/// The cases of a sweep in their order, counted from 1 where they are named.
#[derive(Debug, Clone, PartialEq)]
pub struct Cases {
    /// The keys that vary.
    pub keys: Vec<String>,
    /// The values of all keys in each case, as TOML.
    pub values: Vec<Vec<String>>,
}

impl Cases {
    /// The cases of the file; a table of cases is read relative to the folder of the file.
    ///
    /// # Errors
    /// The fault in a sentence: the table cannot be read, or there are too many cases or dimensions.
    pub fn new(file: &SweepFile, folder: &Path) -> Result<Cases, String> {
        if let Some((path, _)) = &file.table {
            return of_table(&folder.join(path));
        }
        let keys = file.axes.iter().map(|axis| axis.key.clone()).collect();
        let values = match file.sample {
            Some(sample) => of_sample(&file.axes, sample)?,
            None => combinations(&file.axes)?,
        };
        Ok(Cases { keys, values })
    }

    /// The overrides of a case, counted from 0.
    pub fn sets(&self, case: usize) -> Vec<String> {
        let pairs = self.keys.iter().zip(&self.values[case]);
        pairs.map(|(key, value)| format!("{key}={value}")).collect()
    }
}

/// All combinations, the last axis first.
fn combinations(axes: &[VariedKey]) -> Result<Vec<Vec<String>>, String> {
    let lists: Vec<Vec<String>> = axes.iter().map(|axis| values(&axis.values)).collect();
    let count = lists.iter().try_fold(1_usize, |count, list| count.checked_mul(list.len()));
    let Some(count) = count.filter(|count| *count <= MOST_CASES) else {
        return Err(format!("there are more than {MOST_CASES} combinations"));
    };
    let case = |index: usize| {
        let mut rest = index;
        let mut case: Vec<String> = lists
            .iter()
            .rev()
            .map(|list| {
                let value = list[rest % list.len()].clone();
                rest /= list.len();
                value
            })
            .collect();
        case.reverse();
        case
    };
    Ok((0..count).map(case).collect())
}

/// The values of an axis; none of a range without steps.
fn values(values: &VariedValues) -> Vec<String> {
    match values {
        VariedValues::List(list) => list.clone(),
        &VariedValues::Range { from, to, steps } => {
            let last = steps.unwrap_or(0).saturating_sub(1).max(1) as f64;
            // Both ends are met to the last bit.
            let at = |k: usize| if k as f64 == last { to } else { between(from, to, k as f64 / last) };
            (0..steps.unwrap_or(0)).map(|k| number(at(k))).collect()
        }
    }
}

fn of_sample(
    axes: &[VariedKey],
    SampleOfCases { kind, cases, seed }: SampleOfCases,
) -> Result<Vec<Vec<String>>, String> {
    let ranges = axes.iter().filter(|axis| matches!(axis.values, VariedValues::Range { .. })).count();
    if kind == SampleKind::Sobol && ranges > MOST_DIMENSIONS {
        return Err(format!("Sobol's sequence has {MOST_DIMENSIONS} dimensions here; take a Latin hypercube for more"));
    }
    let coordinates = |dimension: usize| match kind {
        SampleKind::Sobol => (0..cases).map(|point| sobol(point as u32, dimension, seed)).collect(),
        SampleKind::LatinHypercube => latin_hypercube(cases, dimension, seed),
    };
    let mut dimensions = 0..ranges;
    let mut column = |axis: &VariedKey| -> Vec<String> {
        match &axis.values {
            VariedValues::List(list) => list.iter().take(1).cycle().take(cases).cloned().collect(),
            &VariedValues::Range { from, to, .. } => {
                let units: Vec<f64> = dimensions.next().map(coordinates).unwrap_or_default();
                units.into_iter().map(|unit| number(between(from, to, unit))).collect()
            }
        }
    };
    let columns: Vec<Vec<String>> = axes.iter().map(&mut column).collect();
    Ok((0..cases).map(|case| columns.iter().map(|column| column[case].clone()).collect()).collect())
}

/// The number at a share of the way from one end to the other; their difference may be beyond the range of numbers.
fn between(from: f64, to: f64, share: f64) -> f64 {
    let distance = to - from;
    if distance.is_finite() { from + distance * share } else { from * (1.0 - share) + to * share }
}

/// A number as TOML reads it back.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn of_table(path: &Path) -> Result<Cases, String> {
    let shown = path.display();
    let bytes = read_regular(path).map_err(|error| format!("cannot read the table of cases `{shown}`: {error}"))?;
    let fault = |error: csv::Error| format!("cannot read the table of cases `{shown}`: {error}");
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(bytes.as_slice());
    let keys: Vec<String> = reader.headers().map_err(fault)?.iter().map(str::to_owned).collect();
    if let Some(empty) = keys.iter().position(String::is_empty) {
        return Err(format!("column {} of the table of cases `{}` has no key", empty + 1, path.display()));
    }
    let mut values = Vec::new();
    for record in reader.records() {
        let record = record.map_err(fault)?;
        values.push(record.iter().map(str::to_owned).collect());
        if values.len() > MOST_CASES {
            return Err(format!("the table of cases has more than {MOST_CASES} rows"));
        }
    }
    if values.is_empty() {
        return Err(format!("the table of cases `{}` has no rows", path.display()));
    }
    Ok(Cases { keys, values })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(key: &str, values: VariedValues) -> VariedKey {
        VariedKey { key: key.into(), values, place: 0..0 }
    }

    fn list(values: &[&str]) -> VariedValues {
        VariedValues::List(values.iter().map(|value| (*value).to_owned()).collect())
    }

    #[test]
    fn combinations_are_all_and_in_order() {
        let axes = vec![
            axis("a", list(&["1", "\"x\""])),
            axis("b[0]", VariedValues::Range { from: 2.0, to: 6.0, steps: Some(3) }),
        ];
        let cases = Cases::new(&SweepFile { axes, ..SweepFile::default() }, Path::new("")).unwrap();
        assert_eq!(cases.values.len(), 6);
        assert_eq!(cases.sets(0), ["a=1", "b[0]=2.0"]);
        assert_eq!(cases.sets(1), ["a=1", "b[0]=4.0"]);
        assert_eq!(cases.sets(5), ["a=\"x\"", "b[0]=6.0"]);
        let one = values(&VariedValues::Range { from: 0.1, to: 0.7, steps: Some(1) });
        assert_eq!(one, ["0.1"]);
        let wide = values(&VariedValues::Range { from: -1e308, to: 1e308, steps: Some(5) });
        assert_eq!(wide, ["-1e308", "-5e307", "0.0", "5e307", "1e308"]);
        let many = values(&VariedValues::Range { from: 0.1, to: 0.7, steps: Some(4) });
        assert_eq!(many[3], "0.7");
    }

    #[test]
    fn samples_lie_within_their_ranges() {
        for kind in [SampleKind::Sobol, SampleKind::LatinHypercube] {
            let axes = vec![axis("a", VariedValues::Range { from: -1.0, to: 3.0, steps: None })];
            let sample = Some(SampleOfCases { kind, cases: 64, seed: 1 });
            let cases = Cases::new(&SweepFile { axes, sample, ..SweepFile::default() }, Path::new("")).unwrap();
            let values: Vec<f64> = cases.values.iter().map(|case| case[0].parse().unwrap()).collect();
            assert!(values.iter().all(|value| (-1.0..3.0).contains(value)));
            // One in each of 64 parts: the mean is that of the range to half a part.
            assert!((values.iter().sum::<f64>() / 64.0 - 1.0).abs() < 0.5 * 4.0 / 64.0);
        }
    }
}
