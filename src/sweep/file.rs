//! The file of a sweep: the deck, its varied entries, and the collected numbers.

use super::case_state::CaseState;
use base::diagnostic::{Diagnostic, Source, Span};
use base::names::{nearest, quoted};
use deck::number_slips;
use results::collected::{Collected, CollectedWhen, quantities};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The contents of the file of a sweep.
#[derive(Debug, Clone, Default)]
pub struct SweepFile {
    /// The path of the deck, relative to the file.
    pub deck: String,
    /// The entries of the deck that vary, in the order of the file.
    pub axes: Vec<VariedKey>,
    /// The path of a table of cases, relative to the file, whose header has the keys, with its place.
    pub table: Option<(String, Span)>,
    /// The sample of the ranges of all axes.
    pub sample: Option<SampleOfCases>,
    /// The numbers that are read from each result.
    pub collect: Vec<Collected>,
    /// The cases whose folders are kept.
    pub keep: KeptFolders,
}

/// The cases whose folders are kept.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum KeptFolders {
    /// All.
    #[default]
    All,
    /// Cases that failed or missed their expectations.
    Failed,
    /// None: the summary alone is left.
    Summary,
}

impl KeptFolders {
    /// All of them with the words of the file.
    const WORDS: [(&str, KeptFolders); 3] =
        [("all", KeptFolders::All), ("failed", KeptFolders::Failed), ("summary", KeptFolders::Summary)];

    /// Whether the folder of a case in this state stays.
    pub fn keeps(self, state: &CaseState) -> bool {
        match self {
            KeptFolders::All => true,
            KeptFolders::Failed => *state != CaseState::Done,
            KeptFolders::Summary => *state == CaseState::Pending,
        }
    }
}

/// An entry of the deck that varies.
#[derive(Debug, Clone)]
pub struct VariedKey {
    /// The key, in the form of `--set`.
    pub key: String,
    /// Its values.
    pub values: VariedValues,
    /// Its place in the file.
    pub place: Span,
}

/// The values of an entry.
#[derive(Debug, Clone, PartialEq)]
pub enum VariedValues {
    /// These values, as TOML.
    List(Vec<String>),
    /// A number of values from one end to the other, both included; of a sample any between them.
    Range {
        /// The first value.
        from: f64,
        /// The last value.
        to: f64,
        /// The number of values; `None` for a sample.
        steps: Option<usize>,
    },
}

/// A sample of ranges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleOfCases {
    /// The way its points are spread.
    pub kind: SampleKind,
    /// The number of cases.
    pub cases: usize,
    /// Another seed gives another sample of the same kind.
    pub seed: u64,
}

/// The distribution of the points of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleKind {
    /// Sobol's sequence.
    Sobol,
    /// A Latin hypercube.
    LatinHypercube,
}

/// The JSON Schema of the file. The keys of a deck and the contents of its tables are checked by the reader.
pub const SCHEMA: &str = include_str!("schema.json");

/// The keys of the file, of a range, of a sample and of a number that is collected.
const KEYS: [&str; 4] = ["deck", "vary", "collect", "keep"];
/// The keys of `[vary]` that are no entries of the deck.
const OF_VARY: [&str; 2] = ["table", "sample"];
const RANGE: [&str; 3] = ["from", "to", "steps"];
const SAMPLE: [&str; 3] = ["kind", "cases", "seed"];
const COLLECTED: [&str; 6] = ["at", "mode", "quantity", "stage", "peak", "time"];

/// The columns that every summary has.
const TAKEN: [&str; 4] = ["case", "status", "reason", "warnings"];

/// The largest number of values of an axis, and of cases.
pub const MOST_CASES: usize = 1_000_000;

/// Reads the file of a sweep, with all its faults; `None` if there are any.
pub fn read(source: &Source) -> (Option<SweepFile>, Vec<Diagnostic>) {
    let (root, errors) = DeTable::parse_recoverable(&source.text);
    let mut reader = Reader { source, problems: Vec::new() };
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        let slip = number_slips::explain(&source.text, span.start).map(|(message, hint)| format!("{message}: {hint}"));
        reader.error(&span, slip.unwrap_or_else(|| format!("this is not TOML: {}", error.message())));
    }
    let file = reader.file(root.get_ref());
    let problems = reader.problems;
    (problems.is_empty().then_some(file), problems)
}

struct Reader<'s> {
    source: &'s Source,
    problems: Vec<Diagnostic>,
}

type Entry<'t> = (&'t str, Span, &'t Spanned<DeValue<'t>>);

impl Reader<'_> {
    fn error(&mut self, place: &Span, message: impl Into<String>) {
        self.problems.push(Diagnostic::error(message).at(place));
    }

    /// The entries of a table; keys that are not known are errors.
    fn entries<'t>(&mut self, what: &str, table: &'t DeTable<'t>, known: &[&str]) -> Vec<Entry<'t>> {
        let all = table.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value));
        let (found, strange): (Vec<Entry>, Vec<Entry>) = all.partition(|(key, ..)| known.contains(key));
        for (key, span, _) in strange {
            let hint = match nearest(key, known.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None if known == KEYS && OF_VARY.contains(&key) => format!("`{key}` stands below `[vary]`"),
                None => format!("it has {}", quoted(known.iter().copied())),
            };
            self.problems.push(Diagnostic::error(format!("{what} has no key `{key}`")).at(&span).hint(hint));
        }
        found
    }

    fn file<'t>(&mut self, root: &'t DeTable<'t>) -> SweepFile {
        let mut file = SweepFile::default();
        let entries = self.entries("a sweep", root, &KEYS);
        if !entries.iter().any(|(key, ..)| *key == "deck") {
            self.error(&(0..0), "`deck` is missing: give the path of the deck that varies");
        }
        if !entries.iter().any(|(key, ..)| *key == "vary") {
            self.error(&(0..0), "`[vary]` is missing: give the entries of the deck that vary");
        }
        for (key, _, value) in entries {
            match (key, value.get_ref()) {
                ("deck", DeValue::String(path)) => file.deck = path.to_string(),
                ("deck", _) => self.error(&value.span(), "`deck` must be the path of a deck, in quotes"),
                ("keep", DeValue::String(word)) if KeptFolders::WORDS.iter().any(|(name, _)| name == word) => {
                    file.keep = KeptFolders::WORDS
                        .iter()
                        .find(|(name, _)| name == word)
                        .map_or(KeptFolders::All, |(_, keep)| *keep);
                }
                ("keep", _) => self.error(&value.span(), "`keep` can be \"all\", \"failed\" or \"summary\""),
                ("vary", DeValue::Table(table)) => self.vary(table, &value.span(), &mut file),
                ("collect", DeValue::Table(table)) => {
                    file.collect = table.iter().filter_map(|(key, value)| self.collected(key, value)).collect();
                }
                _ => self.error(&value.span(), format!("`[{key}]` must be a table")),
            }
        }
        file
    }

    fn vary<'t>(&mut self, table: &'t DeTable<'t>, place: &Span, file: &mut SweepFile) {
        for (key, value) in table {
            match (key.get_ref().as_ref(), value.get_ref()) {
                ("table", DeValue::String(path)) => file.table = Some((path.to_string(), value.span())),
                ("sample", DeValue::Table(table)) => file.sample = self.sample(table, &value.span()),
                (name, _) => file.axes.extend(self.axis(name, key.span(), value)),
            }
        }
        let ranges = file.axes.iter().any(|axis| matches!(axis.values, VariedValues::Range { .. }));
        let varies = if file.sample.is_some() { ranges } else { !file.axes.is_empty() || file.table.is_some() };
        if !varies && self.problems.is_empty() {
            self.error(place, "nothing varies: add an entry of the deck with its values to `[vary]`");
        }
        if let (Some((_, place)), false) = (&file.table, file.axes.is_empty() && file.sample.is_none()) {
            self.error(&place.clone(), "a `table` of cases has all that varies: remove the other entries");
        }
        for axis in &file.axes {
            match (&axis.values, file.sample) {
                // One value holds in all cases.
                (VariedValues::List(values), Some(_)) if values.len() == 1 => {}
                (VariedValues::List(_) | VariedValues::Range { steps: Some(_), .. }, Some(_)) => {
                    let message = format!(
                        "a sample needs ranges: give `{}` = {{ from = .., to = .. }}, or one value in a list for all cases",
                        axis.key
                    );
                    self.error(&axis.place, message);
                }
                (VariedValues::Range { steps: None, .. }, None) => {
                    let message = format!("`{}` needs `steps`, the number of its values, or a `sample`", axis.key);
                    self.error(&axis.place, message);
                }
                _ => {}
            }
        }
    }

    fn axis<'t>(&mut self, key: &str, place: Span, value: &'t Spanned<DeValue<'t>>) -> Option<VariedKey> {
        let values = match value.get_ref() {
            DeValue::Array(list) if list.is_empty() => {
                self.error(&value.span(), format!("`{key}` has no values: add one, or remove the key"));
                return None;
            }
            DeValue::Array(list) => {
                VariedValues::List(list.iter().map(|value| self.source.text[value.span()].to_owned()).collect())
            }
            DeValue::Table(table) if table.iter().any(|(key, _)| RANGE.contains(&key.get_ref().as_ref())) => {
                self.range(key, table, &value.span())?
            }
            DeValue::Table(_) => {
                let hint = format!("put the whole key into quotes: \"{key}.…\" = [..]");
                let message = format!("`{key}` is a table, not a list of values or a range");
                self.problems.push(Diagnostic::error(message).at(&place).hint(hint));
                return None;
            }
            _ => {
                let message = format!("`{key}` must be a list of values or {{ from = .., to = .., steps = .. }}");
                self.error(&value.span(), message);
                return None;
            }
        };
        Some(VariedKey { key: key.to_owned(), values, place })
    }

    fn range<'t>(&mut self, key: &str, table: &'t DeTable<'t>, place: &Span) -> Option<VariedValues> {
        let before = self.problems.len();
        let (mut ends, mut steps) = ([None; 2], None);
        for (name, _, value) in self.entries(&format!("the range of `{key}`"), table, &RANGE) {
            match name {
                "from" => ends[0] = self.number(name, value),
                "to" => ends[1] = self.number(name, value),
                _ => steps = self.count(name, value, 1),
            }
        }
        let [Some(from), Some(to)] = ends else {
            if self.problems.len() == before {
                self.error(place, format!("the range of `{key}` needs `from` and `to`"));
            }
            return None;
        };
        Some(VariedValues::Range { from, to, steps })
    }

    fn sample<'t>(&mut self, table: &'t DeTable<'t>, place: &Span) -> Option<SampleOfCases> {
        let (mut kind, mut cases, mut seed) = (None, None, 0);
        let before = self.problems.len();
        for (name, _, value) in self.entries("a sample", table, &SAMPLE) {
            match (name, value.get_ref()) {
                ("kind", DeValue::String(word)) if word.as_ref() == "sobol" => kind = Some(SampleKind::Sobol),
                ("kind", DeValue::String(word)) if word.as_ref() == "latin-hypercube" => {
                    kind = Some(SampleKind::LatinHypercube);
                }
                ("kind", _) => self.error(&value.span(), "`kind` can be \"sobol\" or \"latin-hypercube\""),
                ("cases", _) => cases = self.count(name, value, 1),
                _ => seed = self.count(name, value, 0).unwrap_or(0) as u64,
            }
        }
        if self.problems.len() == before && (kind.is_none() || cases.is_none()) {
            self.error(place, "a sample needs `kind` and `cases`");
        }
        Some(SampleOfCases { kind: kind?, cases: cases?, seed })
    }

    fn collected<'t>(
        &mut self,
        key: &Spanned<toml::de::DeString<'t>>,
        value: &'t Spanned<DeValue<'t>>,
    ) -> Option<Collected> {
        let name = key.get_ref().to_string();
        let DeValue::Table(table) = value.get_ref() else {
            self.error(&value.span(), format!("`{name}` must be a table with `at`, `quantity` and `peak` or `time`"));
            return None;
        };
        let before = self.problems.len();
        let (mut at, mut quantity, mut stage, mut when) = (None, None, None, None);
        for (key, place, value) in self.entries(&format!("`{name}`"), table, &COLLECTED) {
            match (key, value.get_ref()) {
                ("at", DeValue::String(text)) => at = Some(text.to_string()),
                ("quantity", DeValue::String(text)) => quantity = self.quantity(text, &value.span()),
                ("stage", DeValue::String(text)) => stage = Some(text.to_string()),
                ("mode", _) => at = self.count(key, value, 1).map(|mode| mode.to_string()).or(at),
                ("at" | "quantity" | "stage", _) => {
                    self.error(&value.span(), format!("`{key}` must be a name in quotes"))
                }
                _ if when.is_some() => self.error(&place, format!("`{name}` takes `peak` or `time`, not both")),
                ("peak", DeValue::String(word)) if word.as_ref() == "max" => when = Some(CollectedWhen::Max),
                ("peak", DeValue::String(word)) if word.as_ref() == "min" => when = Some(CollectedWhen::Min),
                ("peak", DeValue::String(word)) if word.as_ref() == "abs" => when = Some(CollectedWhen::Abs),
                ("peak", _) => self.error(&value.span(), "`peak` can be \"max\", \"min\" or \"abs\""),
                ("time", DeValue::String(word)) if word.as_ref() == "end" => when = Some(CollectedWhen::End),
                _ => when = self.number("time", value).map(CollectedWhen::Time),
            }
        }
        // A mode has one row in each stage of modes, and needs no time.
        let when = when.or(table.contains_key("mode").then_some(CollectedWhen::End));
        if table.contains_key("mode") && table.contains_key("at") {
            self.error(&value.span(), format!("`{name}` takes `at` or `mode`, not both"));
        }
        if self.problems.len() == before && (at.is_none() || quantity.is_none() || when.is_none()) {
            self.error(
                &value.span(),
                format!("`{name}` needs `at`, `quantity` and `peak` or `time`; or `mode` and `quantity`"),
            );
        }
        if TAKEN.contains(&name.as_str()) {
            self.error(&key.span(), format!("`{name}` is a column of the summary already"));
        }
        Some(Collected { name, at: at?, quantity: quantity?, stage, when: when? })
    }

    /// A column of some table.
    fn quantity(&mut self, word: &str, place: &Span) -> Option<String> {
        if !quantities().any(|known| known == word) {
            let problem = Diagnostic::error(format!("no table has a column `{word}`")).at(place);
            let near = nearest(word, quantities()).map(|near| format!("did you mean `{near}`?"));
            self.problems.push(problem.hint(near.unwrap_or("docs/results.md lists the columns of all tables".into())));
        }
        Some(word.to_owned())
    }

    fn number<'t>(&mut self, name: &str, value: &'t Spanned<DeValue<'t>>) -> Option<f64> {
        let text = self.source.text[value.span()].replace('_', "");
        let is_number = matches!(value.get_ref(), DeValue::Integer(_) | DeValue::Float(_));
        let number = text.parse().ok().filter(|number: &f64| is_number && number.is_finite());
        if number.is_none() {
            self.error(&value.span(), format!("`{name}` must be a number"));
        }
        number
    }

    fn count<'t>(&mut self, name: &str, value: &'t Spanned<DeValue<'t>>, least: usize) -> Option<usize> {
        let text = self.source.text[value.span()].replace('_', "");
        let count = text.parse().ok().filter(|count| (least..=MOST_CASES).contains(count));
        if count.is_none() {
            self.error(&value.span(), format!("`{name}` must be a whole number from {least} to {MOST_CASES}"));
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// The keys of an object of the schema, in their order.
    fn keys(schema: &Value) -> Vec<&str> {
        schema["properties"].as_object().unwrap().keys().map(String::as_str).collect()
    }

    fn sorted<const N: usize>(mut keys: [&str; N]) -> Vec<&str> {
        keys.sort_unstable();
        keys.to_vec()
    }

    /// Reader and schema accept the same keys and words; the reader reports all others as errors.
    #[test]
    fn the_schema_is_that_of_the_reader() {
        let schema: Value = serde_json::from_str(SCHEMA).unwrap();
        let of = |name: &str| &schema["$defs"][name];
        assert_eq!(keys(&schema), sorted(KEYS));
        assert_eq!(keys(of("Range")), sorted(RANGE));
        assert_eq!(keys(of("Sample")), sorted(SAMPLE));
        assert_eq!(keys(of("Collected")), sorted(COLLECTED));
        let read = |text: &str| super::read(&Source::new("s.toml", text, &[])).1.len();
        for kind in of("Sample")["properties"]["kind"]["enum"].as_array().unwrap() {
            let text =
                format!("deck = 'd'\n[vary]\nsample = {{ kind = {kind}, cases = 2 }}\na = {{ from = 0, to = 1 }}\n");
            assert_eq!(read(&text), 0, "{kind}");
        }
        for peak in of("Collected")["properties"]["peak"]["enum"].as_array().unwrap() {
            let of = |more: &str| {
                let one = format!("at = 'b', quantity = 'ux', peak = {peak}{more}");
                format!("deck = 'd'\n[vary]\na = [1]\n[collect]\nx = {{ {one} }}\n")
            };
            assert_eq!((read(&of("")), read(&of(", time = 'end'"))), (0, 1), "{peak}");
        }
        let words = schema["properties"]["keep"]["enum"].as_array().unwrap();
        assert_eq!(
            words.iter().map(|word| word.as_str().unwrap()).collect::<Vec<_>>(),
            KeptFolders::WORDS.map(|(word, _)| word)
        );
        let least = of("Range")["properties"]["steps"]["maximum"].as_u64();
        assert_eq!(least, Some(MOST_CASES as u64));
        assert_eq!(schema["properties"]["collect"]["propertyNames"]["not"]["enum"], serde_json::json!(TAKEN));
        for taken in TAKEN {
            let collect = format!("{taken} = {{ at = 'b', quantity = 'ux', time = 'end' }}");
            assert_eq!(read(&format!("deck = 'd'\n[vary]\na = [1]\n[collect]\n{collect}\n")), 1, "{taken}");
        }
    }
}
