//! Sets of the six directions of a node.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeSeed, Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// A set of directions, in the order `ux uy uz rx ry rz`. A deck writes "all", "translations", "rotations", one direction, or a
/// list of directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Directions(pub [bool; 6]);

impl Directions {
    /// All six directions.
    pub const ALL: Directions = Directions([true; 6]);
}

/// The words for several directions, and those for one.
const WORDS: [&str; 9] = ["all", "translations", "rotations", "ux", "uy", "uz", "rx", "ry", "rz"];

impl Directions {
    /// The directions of a word of [`WORDS`].
    fn of_word<E: Error>(word: &str) -> Result<Directions, E> {
        match word {
            "all" => Ok(Directions::ALL),
            "translations" => Ok(Directions([true, true, true, false, false, false])),
            "rotations" => Ok(Directions([false, false, false, true, true, true])),
            _ => {
                let one = WORDS[3..].iter().position(|direction| *direction == word);
                let one = one.ok_or_else(|| E::unknown_variant(word, &WORDS))?;
                Ok(Directions(std::array::from_fn(|direction| direction == one)))
            }
        }
    }
}

impl<'de> Deserialize<'de> for Directions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Directions;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("\"all\", \"translations\", \"rotations\" or a list, such as [\"ux\", \"ry\"]")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Directions, E> {
                Directions::of_word(word)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Directions, A::Error> {
                let mut directions = [false; 6];
                while let Some(Directions(more)) = list.next_element_seed(OneWord)? {
                    directions = std::array::from_fn(|dof| directions[dof] || more[dof]);
                }
                Ok(Directions(directions))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Reads an entry of a list of directions.
struct OneWord;

impl<'de> DeserializeSeed<'de> for OneWord {
    type Value = Directions;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Directions, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl Visitor<'_> for OneWord {
    type Value = Directions;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a direction in quotes")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Directions, E> {
        Directions::of_word(word)
    }
}

impl JsonSchema for Directions {
    fn schema_name() -> Cow<'static, str> {
        "Directions".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let word = json_schema!({ "enum": WORDS });
        json_schema!({ "anyOf": [word, { "type": "array", "items": word }] })
    }
}
