//! Columns of a file, by name or by number.

use super::one_or_many::Item;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// A column of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ColumnName {
    /// Its name in the first line.
    Name(String),
    /// Its number, counted from 1.
    Number(u64),
}

impl Item for ColumnName {
    const EXPECTED: &'static str =
        "a column, or a list of them, by name or by number from 1, such as [\"time\", \"acceleration\"] or [1, 3]";
}

impl<'de> Deserialize<'de> for ColumnName {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = ColumnName;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a column or its number from 1")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<ColumnName, E> {
                Ok(ColumnName::Name(name.to_owned()))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<ColumnName, E> {
                match u64::try_from(number) {
                    Ok(number) if number > 0 => Ok(ColumnName::Number(number)),
                    _ => Err(E::invalid_value(Unexpected::Signed(number), &self)),
                }
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for ColumnName {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "ColumnName".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 1 }] })
    }
}
