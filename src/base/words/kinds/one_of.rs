//! A table of the deck with one of several kinds: it reads the keys of all kinds, and serde reads the common keys.

use super::kind::{Key, Kind, Kinds};
use super::values::Values;
use crate::diagnostic::At;
use crate::words::Maybe;
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{DeserializeSeed, Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};
use std::borrow::Cow;
use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

/// A table that is one of several kinds.
pub struct OneOf<C: Kinds> {
    /// The kind chosen; `None` if the deck does not name one.
    pub kind: Maybe<&'static Kind<C::Make>>,
    /// Keys of all kinds as written, including those that the chosen kind does not allow.
    pub values: Values,
    /// The keys that all kinds share.
    common: C,
}

impl<C: Kinds> Deref for OneOf<C> {
    type Target = C;

    fn deref(&self) -> &C {
        &self.common
    }
}

impl<C: Kinds + Clone> Clone for OneOf<C> {
    fn clone(&self) -> Self {
        OneOf { kind: self.kind.clone(), values: self.values.clone(), common: self.common.clone() }
    }
}

impl<C: Kinds + fmt::Debug> fmt::Debug for OneOf<C> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let word = self.kind.as_ref().map(|kind| kind.word);
        f.debug_struct("OneOf")
            .field("kind", &word)
            .field("values", &self.values)
            .field("common", &self.common)
            .finish()
    }
}

impl<'de, C: Kinds + Deserialize<'de>> Deserialize<'de> for OneOf<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<C>(PhantomData<C>);
        impl<'de, C: Kinds + Deserialize<'de>> Visitor<'de> for Reader<C> {
            type Value = OneOf<C>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table, such as { key = value }")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let (mut kind, mut values) = (None, Values::default());
                let sorted = Sorted::<A, C> { map, kind: &mut kind, values: &mut values };
                let common = C::deserialize(MapAccessDeserializer::new(sorted))?;
                Ok(OneOf { kind, values, common })
            }
        }
        deserializer.deserialize_map(Reader(PhantomData))
    }
}

/// A table on its way to the struct of the common keys: the chooser and the keys of kinds are taken out.
struct Sorted<'a, A, C: Kinds> {
    map: A,
    kind: &'a mut Maybe<&'static Kind<C::Make>>,
    values: &'a mut Values,
}

impl<'de, A: MapAccess<'de>, C: Kinds + Deserialize<'de>> MapAccess<'de> for Sorted<'_, A, C> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        while let Some(name) = self.map.next_key::<Name<C>>()? {
            match name {
                Name::Chooser => {
                    let At { value, span } = self.map.next_value::<At<Word<C>>>()?;
                    *self.kind = Some(At { value: value.0, span });
                }
                Name::Own(key) => self.values.0.push(key.form.read(key.name, &mut self.map)?),
                Name::Common(name, _) => return seed.deserialize(StrDeserializer::new(name)).map(Some),
            }
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
}

/// A key of the table by owner: the chooser, one kind, or all kinds.
enum Name<C> {
    Chooser,
    Own(&'static Key),
    Common(&'static str, PhantomData<C>),
}

impl<'de, C: Kinds + Deserialize<'de>> Deserialize<'de> for Name<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let word = Cow::<str>::deserialize(deserializer)?;
        if word == C::CHOOSER {
            return Ok(Name::Chooser);
        }
        let own = || C::list().iter().flat_map(|kind| kind.keys);
        if let Some(key) = own().find(|key| key.name == word) {
            return Ok(Name::Own(key));
        }
        let common = fields::<C>();
        match common.iter().find(|name| **name == word) {
            Some(name) => Ok(Name::Common(name, PhantomData)),
            None => {
                let mut known = vec![C::CHOOSER];
                known.extend(common);
                own().for_each(|key| {
                    if !known.contains(&key.name) {
                        known.push(key.name)
                    }
                });
                Err(D::Error::unknown_field(&word, listed(known)))
            }
        }
    }
}

/// Words as an error of serde lists them. They stay in memory for good, which errors of serde demand, and a deck has few errors.
fn listed(words: Vec<&'static str>) -> &'static [&'static str] {
    Vec::leak(words)
}

/// The kind that a word of the deck chooses.
struct Word<C: Kinds>(&'static Kind<C::Make>);

impl<'de, C: Kinds> Deserialize<'de> for Word<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<C>(PhantomData<C>);
        impl<C: Kinds> Visitor<'_> for Reader<C> {
            type Value = Word<C>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a word in quotes")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Word<C>, E> {
                if let Some(kind) = C::list().iter().find(|kind| kind.is_called(word)) {
                    return Ok(Word(kind));
                }
                let words =
                    |kind: &&'static Kind<C::Make>| std::iter::once(kind.word).chain(kind.aliases.iter().copied());
                let known: Vec<&str> = C::list().iter().flat_map(words).collect();
                Err(E::unknown_variant(word, listed(known)))
            }
        }
        deserializer.deserialize_identifier(Reader(PhantomData))
    }
}

/// Names of the fields of a struct: the struct is read from an empty source that records the requests of serde.
fn fields<'de, C: Deserialize<'de>>() -> &'static [&'static str] {
    struct Asked<'a>(&'a Cell<&'static [&'static str]>);
    impl<'de> Deserializer<'de> for Asked<'_> {
        type Error = serde::de::value::Error;

        fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
            Err(Error::custom("no struct"))
        }

        fn deserialize_struct<V: Visitor<'de>>(
            self,
            _: &'static str,
            fields: &'static [&'static str],
            _: V,
        ) -> Result<V::Value, Self::Error> {
            self.0.set(fields);
            Err(Error::custom("only asked"))
        }

        forward_to_deserialize_any! {
            bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map enum identifier ignored_any
        }
    }
    let found = Cell::new(&[][..]);
    let _ = C::deserialize(Asked(&found));
    found.get()
}
