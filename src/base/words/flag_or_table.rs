//! Keys with a flag, or a table with details.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// `true`, `false`, or a table.
#[derive(Debug, Clone)]
pub enum FlagOrTable<T> {
    /// Switched on or off.
    Flag(bool),
    /// Switched on, with details.
    Table(T),
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for FlagOrTable<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Reader<T> {
            type Value = FlagOrTable<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("true, false or a table, such as { key = value }")
            }

            fn visit_bool<E: Error>(self, flag: bool) -> Result<FlagOrTable<T>, E> {
                Ok(FlagOrTable::Flag(flag))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FlagOrTable<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(FlagOrTable::Table)
            }
        }
        deserializer.deserialize_any(Reader(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for FlagOrTable<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("FlagOr{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let table = generator.subschema_for::<T>();
        json_schema!({ "anyOf": [{ "type": "boolean" }, table] })
    }
}
