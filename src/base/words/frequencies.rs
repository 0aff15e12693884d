//! The frequencies of a response: one, a list, or so many from one to another.

use crate::diagnostic::At;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// Frequencies, in cycles per time.
#[derive(Debug, Clone)]
pub enum Frequencies {
    /// A number, or a list of them.
    Listed(Vec<At<f64>>),
    /// So many from one to another.
    Range(FrequencyRange),
}

/// Frequencies from one to another.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrequencyRange {
    /// The first frequency, in cycles per unit of time; above 0 with logarithmic spacing.
    pub from: At<f64>,
    /// The last frequency, which is reached exactly.
    pub to: At<f64>,
    /// Number of frequencies, both ends among them.
    pub steps: At<u64>,
    /// How they are spaced. Default: "linear".
    pub spacing: Option<At<Spacing>>,
    /// So many more frequencies on each side of every natural frequency in the range, and one at it. With an `unbalance`, those of critical speeds.
    /// Default: 0, none.
    pub around_resonances: Option<At<u64>>,
}

/// The spacing of frequencies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// By equal differences.
    #[default]
    Linear,
    /// By equal factors.
    Logarithmic,
}

impl Spacing {
    /// So many frequencies from one to another, both among them.
    pub fn between(self, from: f64, to: f64, steps: usize) -> Vec<f64> {
        let last = steps.saturating_sub(1).max(1);
        let at = |k: usize| {
            let part = k as f64 / last as f64;
            match (self, k) {
                (_, 0) => from,
                (_, k) if k == last => to,
                (Spacing::Linear, _) => from + part * (to - from),
                (Spacing::Logarithmic, _) => from * (to / from).powf(part),
            }
        };
        (0..steps).map(at).collect()
    }
}

impl<'de> Deserialize<'de> for Frequencies {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Frequencies;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a frequency, a list of them, or a range, such as 5.0, [5.0, 10.0] or { from = 1.0, to = 50.0, steps = 200 }",
                )
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Frequencies, E> {
                self.visit_f64(number as f64)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Frequencies, E> {
                Ok(Frequencies::Listed(vec![At { value, span: 0..0 }]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Frequencies, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(Frequencies::Listed(values))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Frequencies, A::Error> {
                FrequencyRange::deserialize(MapAccessDeserializer::new(map)).map(Frequencies::Range)
            }
        }
        struct Inner(Frequencies);
        impl<'de> Deserialize<'de> for Inner {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(Reader).map(Inner)
            }
        }

        let At { value: Inner(mut frequencies), span } = At::deserialize(deserializer)?;
        // A number without brackets stands where the value of the key does.
        if let Frequencies::Listed(values) = &mut frequencies {
            values.iter_mut().filter(|value| value.span == (0..0)).for_each(|value| value.span = span.clone());
        }
        Ok(frequencies)
    }
}

impl JsonSchema for Frequencies {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Frequencies".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, range) = (generator.subschema_for::<f64>(), generator.subschema_for::<FrequencyRange>());
        json_schema!({ "anyOf": [one, { "type": "array", "items": one }, range] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_reached() {
        assert_eq!(Spacing::Linear.between(1.0, 2.0, 5), [1.0, 1.25, 1.5, 1.75, 2.0]);
        let all = Spacing::Logarithmic.between(0.1, 1000.0, 5);
        // Powers are rounded.
        assert!((all[0], all[4]) == (0.1, 1000.0) && (all[2] / 10.0 - 1.0).abs() < 1e-14, "{all:?}");
        assert_eq!(Spacing::Linear.between(3.0, 7.0, 1), [3.0]);
    }
}
