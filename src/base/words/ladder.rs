//! Keys that take numbers to go over: one, a list, or a ladder by equal factors from one number to another.

use crate::diagnostic::At;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// The number of rungs in a decade where the deck says none.
pub const PER_DECADE: u64 = 4;

/// Numbers to go over.
#[derive(Debug, Clone)]
pub enum Ladder {
    /// A number, or a list of them.
    Listed(Vec<At<f64>>),
    /// From one number to another by equal factors.
    Rungs(Rungs),
}

/// A ladder from one number to another.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rungs {
    /// The first number.
    pub from: At<f64>,
    /// The last number, which is reached exactly.
    pub to: At<f64>,
    /// Steps of the ladder in a decade. Default: 4, factors of 10^(1/4) = 1.78.
    pub per_decade: Option<At<u64>>,
}

/// The numbers of a ladder, `from` and `to` among them: as many to a decade as are asked for, or as few more as make the factors
/// equal.
pub fn rungs(from: f64, to: f64, per_decade: u64) -> Vec<f64> {
    let decades = (to / from).log10();
    // A ladder of whole decades is one of whole steps, whatever the last digit of the logarithm.
    let count = (decades.abs() * per_decade as f64 - 1e-9).ceil().max(1.0);
    let rung = |k: f64| match k {
        0.0 => from,
        k if k == count => to,
        k => from * 10f64.powf(decades * k / count),
    };
    (0..=count as usize).map(|k| rung(k as f64)).collect()
}

impl<'de> Deserialize<'de> for Ladder {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Ladder;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, a list of numbers, or a ladder, such as 0.01, [0.02, 0.01] or { from = 1e-2, to = 1e-4 }")
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Ladder, E> {
                self.visit_f64(number as f64)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Ladder, E> {
                Ok(Ladder::Listed(vec![At { value, span: 0..0 }]))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Ladder, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(Ladder::Listed(values))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Ladder, A::Error> {
                Rungs::deserialize(MapAccessDeserializer::new(map)).map(Ladder::Rungs)
            }
        }
        struct Inner(Ladder);
        impl<'de> Deserialize<'de> for Inner {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_any(Reader).map(Inner)
            }
        }

        let At { value: Inner(mut ladder), span } = At::deserialize(deserializer)?;
        // A number without brackets stands where the value of the key does.
        if let Ladder::Listed(values) = &mut ladder {
            values.iter_mut().filter(|value| value.span == (0..0)).for_each(|value| value.span = span.clone());
        }
        Ok(ladder)
    }
}

impl JsonSchema for Ladder {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Ladder".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, rungs) = (generator.subschema_for::<f64>(), generator.subschema_for::<Rungs>());
        json_schema!({ "anyOf": [one, { "type": "array", "items": one }, rungs] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rungs_are_by_quarters_of_a_decade() {
        let down = rungs(1e-1, 1e-3, 4);
        assert_eq!((down.len(), down[0], down[8]), (9, 1e-1, 1e-3));
        // Powers are rounded.
        assert!(down.windows(2).all(|pair| (pair[0] / pair[1] - 10f64.powf(0.25)).abs() < 1e-12), "{down:?}");
        // A range that is no whole number of quarters gets one more step, all equal.
        let odd = rungs(0.02, 0.005, 4);
        assert_eq!((odd.len(), odd[3]), (4, 0.005));
        assert!((odd[0] / odd[1] - odd[2] / odd[3]).abs() < 1e-12, "{odd:?}");
        assert_eq!((rungs(1e-3, 1e-1, 4)[8], rungs(2.0, 2.0, 4).as_slice()), (1e-1, &[2.0, 2.0][..]));
        assert_eq!(rungs(1.0, 1e-3, 1).len(), 4);
    }
}
