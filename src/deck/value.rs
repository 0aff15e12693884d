//! Values of TOML for serde with structured faults. The deserializer of `toml` would write sentences, and [`super::read`] writes ours.

use std::fmt::{self, Display, Formatter};
use std::slice;

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, Error, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeString, DeValue};

use base::diagnostic::{PLACED, Span};

/// Fault and place of a failed read.
#[derive(Debug)]
pub struct Wrong {
    /// The problem.
    pub problem: Problem,
    /// The place of the innermost value or key that is wrong.
    pub place: Option<Span>,
    /// Description of the value found: "a list", "the number 2.5".
    pub found: String,
}

/// The kinds of problems that serde may stumble over.
#[derive(Debug)]
pub enum Problem {
    /// A key unknown to its table, with the known keys.
    UnknownKey {
        known: Vec<&'static str>,
    },
    /// A word that is none of those known here.
    UnknownWord {
        word: String,
        known: Vec<&'static str>,
    },
    /// A value of another type.
    Type(Wanted),
    /// A list of wrong length, with the expected length in words.
    Length {
        length: usize,
        expected: String,
    },
    Other(String),
}

/// Expected value of a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    Number,
    /// A number, where one stands in quotes, perhaps with a unit.
    NumberWithoutQuotes,
    Count,
    Flag,
    Text,
    Word,
    List,
    /// A list, where a table stands.
    ListOfTables,
    /// Description by the type itself.
    Said(String),
}

impl Display for Wanted {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Wanted::Number | Wanted::NumberWithoutQuotes => "a number, such as 2.5",
            Wanted::Count => "a whole number of 1 or more, such as 12",
            Wanted::Flag => "true or false",
            Wanted::Text => "text in quotes, such as \"steel\"",
            Wanted::Word => "a word in quotes",
            Wanted::List | Wanted::ListOfTables => "a list in brackets, such as [1.0, 2.0, 3.0]",
            Wanted::Said(text) => text,
        })
    }
}

impl Wrong {
    fn new(problem: Problem) -> Self {
        Wrong { problem, place: None, found: String::new() }
    }

    /// The fault at this place, unless a deeper place is known.
    fn at(self, place: &Span, found: impl FnOnce() -> String) -> Self {
        match self.place {
            Some(_) => self,
            None => Wrong { place: Some(place.clone()), found: found(), ..self },
        }
    }
}

impl Display for Wrong {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "{:?}", self.problem)
    }
}

impl std::error::Error for Wrong {}

impl Error for Wrong {
    fn custom<T: Display>(message: T) -> Self {
        Wrong::new(Problem::Other(message.to_string()))
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Wrong::new(Problem::Type(Wanted::Said(expected.to_string())))
    }

    fn invalid_value(found: Unexpected, expected: &dyn Expected) -> Self {
        Wrong::invalid_type(found, expected)
    }

    fn invalid_length(length: usize, expected: &dyn Expected) -> Self {
        Wrong::new(Problem::Length { length, expected: expected.to_string() })
    }

    fn unknown_variant(word: &str, known: &'static [&'static str]) -> Self {
        Wrong::new(Problem::UnknownWord { word: word.to_owned(), known: known.to_vec() })
    }

    fn unknown_field(_: &str, known: &'static [&'static str]) -> Self {
        Wrong::new(Problem::UnknownKey { known: known.to_vec() })
    }
}

/// A value, for serde.
#[derive(Clone, Copy)]
pub struct Value<'a, 'i>(pub &'a Spanned<DeValue<'i>>);

impl Value<'_, '_> {
    /// Description in words.
    fn described(self) -> String {
        match self.0.get_ref() {
            DeValue::String(text) => format!("the text {text:?}"),
            DeValue::Integer(number) => format!("the number {number}"),
            DeValue::Float(number) => format!("the number {number}"),
            DeValue::Boolean(flag) => flag.to_string(),
            DeValue::Datetime(date) => format!("the date {date}"),
            DeValue::Array(_) => "a list".to_owned(),
            DeValue::Table(_) => "a table".to_owned(),
        }
    }

    /// Reads by `seed`; a fault belongs to this place unless it lies deeper.
    fn read<'de, S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Wrong> {
        seed.deserialize(self).map_err(|wrong| wrong.at(&self.0.span(), || self.described()))
    }

    fn visit<'de, V: Visitor<'de>>(self, fits: bool, wanted: Wanted, visitor: V) -> Result<V::Value, Wrong> {
        if fits { self.deserialize_any(visitor) } else { Err(Wrong::new(Problem::Type(wanted))) }
    }
}

impl<'de> Deserializer<'de> for Value<'_, '_> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.0.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
                Ok(number) => visitor.visit_i64(number),
                Err(_) => Err(Wrong::custom("the number is too large")),
            },
            DeValue::Float(number) => match number.as_str().parse() {
                Ok(number) => visitor.visit_f64(number),
                Err(_) => Err(Wrong::custom("this is not a number")),
            },
            DeValue::Boolean(flag) => visitor.visit_bool(*flag),
            DeValue::Datetime(date) => visitor.visit_string(date.to_string()),
            DeValue::Array(list) => visitor.visit_seq(Items(list.iter())),
            DeValue::Table(table) => visitor.visit_map(Entries { entries: table.iter(), value: None }),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let value = self.0.get_ref();
        let quoted = value.as_str().is_some_and(|text| text.starts_with(|c: char| c.is_ascii_digit()));
        let wanted = if quoted { Wanted::NumberWithoutQuotes } else { Wanted::Number };
        self.visit(value.is_float() || value.is_integer(), wanted, visitor)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let whole = self.0.get_ref().as_integer().is_some_and(|number| !number.as_str().starts_with('-'));
        self.visit(whole, Wanted::Count, visitor)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.visit(self.0.get_ref().is_bool(), Wanted::Flag, visitor)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.visit(self.0.get_ref().is_str(), Wanted::Text, visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.visit(self.0.get_ref().is_str(), Wanted::Word, visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let value = self.0.get_ref();
        let wanted = if value.is_table() { Wanted::ListOfTables } else { Wanted::List };
        self.visit(value.is_array(), wanted, visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Wrong> {
        let wanted = Wanted::Said((&visitor as &dyn Expected).to_string());
        self.visit(self.0.get_ref().is_array(), wanted, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let wanted = Wanted::Said((&visitor as &dyn Expected).to_string());
        self.visit(self.0.get_ref().is_table(), wanted, visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(self, name: &str, _: usize, visitor: V) -> Result<V::Value, Wrong> {
        match name {
            PLACED => visitor.visit_seq(Placed::new(self.0.span(), self)),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match self.0.get_ref().as_str() {
            Some(word) => visitor.visit_enum(StrDeserializer::<Wrong>::new(word)),
            None => Err(Wrong::new(Problem::Type(Wanted::Word))),
        }
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u32 u128 f32 char bytes byte_buf unit unit_struct struct ignored_any
    }
}

struct Items<'a, 'i>(slice::Iter<'a, Spanned<DeValue<'i>>>);

impl<'de> SeqAccess<'de> for Items<'_, '_> {
    type Error = Wrong;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Wrong> {
        self.0.next().map(|item| Value(item).read(seed)).transpose()
    }
}

struct Entries<'a, 'i, I> {
    entries: I,
    /// The value of the key that was read last.
    value: Option<&'a Spanned<DeValue<'i>>>,
}

impl<'a, 'i: 'a, 'de, I> MapAccess<'de> for Entries<'a, 'i, I>
where
    I: Iterator<Item = (&'a Spanned<DeString<'i>>, &'a Spanned<DeValue<'i>>)>,
{
    type Error = Wrong;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Wrong> {
        let Some((key, value)) = self.entries.next() else { return Ok(None) };
        self.value = Some(value);
        seed.deserialize(Key(key)).map(Some).map_err(|wrong| wrong.at(&key.span(), || format!("`{}`", key.get_ref())))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Wrong> {
        let value = self.value.take().ok_or_else(|| Wrong::custom("a value was asked for before its key"))?;
        Value(value).read(seed)
    }
}

/// A key, for serde.
struct Key<'a, 'i>(&'a Spanned<DeString<'i>>);

impl<'de> Deserializer<'de> for Key<'_, '_> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_str(self.0.get_ref())
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(self, name: &str, _: usize, visitor: V) -> Result<V::Value, Wrong> {
        match name {
            PLACED => visitor.visit_seq(Placed::new(self.0.span(), self)),
            _ => self.deserialize_any(visitor),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple map struct enum identifier ignored_any
    }
}

/// A value or key with its place, in the form of [`base::diagnostic::At`]: start, end, value.
struct Placed<D> {
    bounds: std::vec::IntoIter<u64>,
    inner: Option<D>,
}

impl<D> Placed<D> {
    fn new(span: Span, inner: D) -> Self {
        Placed { bounds: vec![span.start as u64, span.end as u64].into_iter(), inner: Some(inner) }
    }
}

impl<'de, D: Deserializer<'de, Error = Wrong>> SeqAccess<'de> for Placed<D> {
    type Error = Wrong;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Wrong> {
        match (self.bounds.next(), self.inner.take()) {
            (Some(bound), inner) => {
                self.inner = inner;
                seed.deserialize(bound.into_deserializer()).map(Some)
            }
            (None, Some(inner)) => seed.deserialize(inner).map(Some),
            (None, None) => Ok(None),
        }
    }
}
