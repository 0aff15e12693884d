//! Tables whose keys depend on a word in them: the scheme of the integrator, the shape of a section, the kind of a joint.
//!
//! A kind states its word and its keys as a [`Kind`] in the file that computes with it, and its room lists all of them. A
//! table that is [`OneOf`] a room's kinds takes the keys of all of them; which belong to the kind that was chosen is asked
//! afterwards, by [`Given`], so that one mistake hides no other.

use std::borrow::Cow;
use std::cell::Cell;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{DeserializeSeed, Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};
use serde_json::{Map, Value as Json, json};

use super::{Maybe, Numbers, OneOrMany, Vector};
use crate::diagnostic::{At, Diagnostic, Span};
use crate::math::{Mat3, Vec3};
use crate::names::short;

/// A key that one or several kinds of a table take.
#[derive(Debug)]
pub struct Key {
    pub name: &'static str,
    pub form: Form,
    /// What it means, with unit, range and default, for the reference of the deck.
    pub about: &'static str,
}

/// What may be written behind a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    Number,
    /// A whole number.
    Count,
    /// Two numbers in brackets.
    Pair,
    /// Three numbers in brackets.
    Vector,
    /// A number, or several in brackets.
    Numbers,
    /// A whole number, or several in brackets.
    Counts,
    /// A list of vectors.
    Vectors,
    /// A list of pairs.
    Pairs,
}

/// One of the kinds that a table of the deck may be.
#[derive(Debug)]
pub struct Kind<M: 'static> {
    /// As the deck writes it.
    pub word: &'static str,
    /// Other words for it.
    pub aliases: &'static [&'static str],
    /// Words that other programs have for it: whoever writes one is told ours.
    pub guesses: &'static [&'static str],
    /// What it is, for the reference of the deck.
    pub about: &'static str,
    pub keys: &'static [Key],
    /// What the room wants of its kinds, such as the function that makes one of its keys.
    pub make: M,
}

impl<M> Kind<M> {
    fn is_called(&self, word: &str) -> bool {
        self.word == word || self.aliases.contains(&word)
    }

    /// The same kind for another use.
    pub const fn with<N>(&self, make: N) -> Kind<N> {
        let Kind { word, aliases, guesses, about, keys, .. } = *self;
        Kind { word, aliases, guesses, about, keys, make }
    }

    /// Whether it takes a key.
    pub fn takes(&self, key: &str) -> bool {
        self.keys.iter().any(|own| own.name == key)
    }
}

/// The keys that all kinds of a table share, and where the kinds are listed.
pub trait Kinds: 'static {
    /// The key whose value is the word of the kind, and what it means.
    const CHOOSER: &'static str;
    const ABOUT: &'static str;
    const REQUIRED: bool;
    type Make: 'static;

    fn list() -> &'static [&'static Kind<Self::Make>];
}

/// A table that is one of several kinds.
pub struct OneOf<C: Kinds> {
    pub kind: Maybe<&'static Kind<C::Make>>,
    /// Keys that belong to kinds, as written.
    pub values: Values,
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

/// Values of the keys of kinds.
#[derive(Debug, Clone, Default)]
pub struct Values(Vec<Value>);

/// Numbers behind a key: one, a few, or those of vectors one after the other.
#[derive(Debug, Clone)]
struct Value {
    key: &'static str,
    numbers: Vec<f64>,
    span: Span,
}

impl Values {
    fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|value| value.key == key)
    }

    /// The numbers behind a key; none where it is not written.
    pub fn numbers(&self, key: &str) -> &[f64] {
        self.get(key).map_or(&[], |value| &value.numbers)
    }

    /// Where a key's value stands.
    pub fn place(&self, key: &str) -> Option<&Span> {
        self.get(key).map(|value| &value.span)
    }

    /// Where all values stand.
    pub fn places(&self) -> impl Iterator<Item = &Span> {
        self.0.iter().map(|value| &value.span)
    }
}

impl Form {
    fn read<'de, A: MapAccess<'de>>(self, key: &'static str, map: &mut A) -> Result<Value, A::Error> {
        let whole = |count: &u64| *count as f64;
        let (numbers, span) = match self {
            Form::Number => {
                let At { value, span } = map.next_value::<At<f64>>()?;
                (vec![value], span)
            }
            Form::Count => {
                let At { value, span } = map.next_value::<At<u64>>()?;
                (vec![whole(&value)], span)
            }
            Form::Pair => {
                let At { value, span } = map.next_value::<At<Numbers<2>>>()?;
                (value.0.to_vec(), span)
            }
            Form::Vector => {
                let At { value, span } = map.next_value::<At<Vector>>()?;
                (value.0.to_vec(), span)
            }
            Form::Numbers => {
                let At { value, span } = map.next_value::<At<OneOrMany<f64>>>()?;
                (value.values.iter().map(|number| number.value).collect(), span)
            }
            Form::Counts => {
                let At { value, span } = map.next_value::<At<OneOrMany<u64>>>()?;
                (value.values.iter().map(|count| whole(&count.value)).collect(), span)
            }
            Form::Pairs => {
                let At { value, span } = map.next_value::<At<Vec<At<Numbers<2>>>>>()?;
                (value.iter().flat_map(|pair| pair.0).collect(), span)
            }
            Form::Vectors => {
                let At { value, span } = map.next_value::<At<Vec<Vector>>>()?;
                (value.iter().flat_map(|vector| vector.0).collect(), span)
            }
        };
        Ok(Value { key, numbers, span })
    }

    fn schema(self) -> Json {
        let list = |of: &str, count: Option<usize>| match count {
            Some(n) => json!({ "type": "array", "items": { "type": of }, "minItems": n, "maxItems": n }),
            None => json!({ "anyOf": [{ "type": of }, { "type": "array", "items": { "type": of } }] }),
        };
        match self {
            Form::Number => json!({ "type": "number" }),
            Form::Count => json!({ "type": "integer", "minimum": 0 }),
            Form::Pair => list("number", Some(2)),
            Form::Vector => list("number", Some(3)),
            Form::Numbers => list("number", None),
            Form::Counts => list("integer", None),
            Form::Pairs => json!({ "type": "array", "items": list("number", Some(2)) }),
            Form::Vectors => json!({ "type": "array", "items": list("number", Some(3)) }),
        }
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

/// Whose a key is.
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

/// Words as an error of serde lists them. They stay in memory: an error needs them for ever, and a deck has some errors at most.
fn listed(words: Vec<&'static str>) -> &'static [&'static str] {
    Vec::leak(words)
}

/// The kind of a word.
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

/// The names of the fields that a struct asks serde for.
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

impl<C: Kinds + JsonSchema> JsonSchema for OneOf<C> {
    fn schema_name() -> Cow<'static, str> {
        C::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = C::json_schema(generator);
        let word = |kind: &&Kind<C::Make>| {
            let words = std::iter::once(&kind.word).chain(kind.aliases);
            words.map(|word| json!({ "const": word, "description": kind.about })).collect::<Vec<_>>()
        };
        let words: Vec<Json> = C::list().iter().flat_map(word).collect();
        let mut properties = Map::new();
        properties.insert(C::CHOOSER.to_owned(), json!({ "description": C::ABOUT, "oneOf": words }));
        if let Some(Json::Object(common)) = schema.remove("properties") {
            properties.extend(common);
        }
        for key in C::list().iter().flat_map(|kind| kind.keys) {
            if !properties.contains_key(key.name) {
                let mut entry = key.form.schema();
                entry["description"] = describe::<C>(key.name).into();
                properties.insert(key.name.to_owned(), entry);
            }
        }
        schema.insert("properties".to_owned(), Json::Object(properties));
        if C::REQUIRED {
            let mut required = vec![Json::from(C::CHOOSER)];
            if let Some(Json::Array(common)) = schema.remove("required") {
                required.extend(common);
            }
            schema.insert("required".to_owned(), required.into());
        }
        schema
    }
}

/// What a key means, and for which kinds: "Outer radius. (tube)"
fn describe<C: Kinds>(name: &str) -> String {
    let mut texts: Vec<(&str, Vec<&str>)> = Vec::new();
    for kind in C::list() {
        for key in kind.keys.iter().filter(|key| key.name == name) {
            match texts.iter_mut().find(|(about, _)| *about == key.about) {
                Some((_, words)) => words.push(kind.word),
                None => texts.push((key.about, vec![kind.word])),
            }
        }
    }
    let every = texts.len() == 1 && texts[0].1.len() == C::list().len();
    let one = |(about, words): &(&str, Vec<&str>)| match every {
        true => (*about).to_owned(),
        false => format!("{about} ({})", words.join(", ")),
    };
    texts.iter().map(one).collect::<Vec<_>>().join(" ")
}

/// A table as its kind reads it: asks for keys, and collects what is wrong.
pub struct Given<'t> {
    /// The table, for messages: "section `square`".
    what: &'t str,
    span: &'t Span,
    values: &'t Values,
    /// Keys that are written, but could not be read: these have been reported.
    unreadable: Vec<&'t str>,
    pub problems: Vec<Diagnostic>,
}

impl<'t> Given<'t> {
    pub fn new(what: &'t str, span: &'t Span, values: &'t Values, unreadable: Vec<&'t str>) -> Self {
        Given { what, span, values, unreadable, problems: Vec::new() }
    }

    /// The table, for messages: "section `square`".
    pub fn what(&self) -> &'t str {
        self.what
    }

    /// All values of the table.
    pub fn values(&self) -> &'t Values {
        self.values
    }

    /// Reports keys that `kind` does not take; `what` is a thing of that kind.
    pub fn reject_others<M>(&mut self, kind: &Kind<M>, what: &str) {
        for value in self.values.0.iter().filter(|value| !kind.takes(value.key)) {
            let message = format!("`{}` does not apply to {what}", value.key);
            self.problems.push(Diagnostic::error(message).at(&value.span));
        }
    }

    pub fn has(&self, key: &str) -> bool {
        self.values.get(key).is_some()
    }

    /// Reports an error about a key, or about the table where the key is not written.
    pub fn error<T>(&mut self, key: &str, message: impl Into<String>) -> Option<T> {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::error(message).at(place));
        None
    }

    /// [`Given::error`] with a hint at the caret.
    pub fn error_with<T>(&mut self, key: &str, message: impl Into<String>, hint: impl Into<String>) -> Option<T> {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::error(message).at(place).hint(hint));
        None
    }

    pub fn warn(&mut self, key: &str, message: impl Into<String>, hint: impl Into<String>) {
        let place = self.values.place(key).unwrap_or(self.span);
        self.problems.push(Diagnostic::warning(message).at(place).hint(hint));
    }

    /// The numbers behind a key that must be there.
    pub fn require(&mut self, key: &str) -> Option<&'t [f64]> {
        if let Some(value) = self.values.get(key) {
            return Some(&value.numbers);
        }
        if !self.unreadable.contains(&key) {
            let message = format!("{} needs `{key}`", self.what);
            self.error::<()>(key, message);
        }
        None
    }

    /// Reports that one of two keys must be there, neither of which is written.
    pub fn require_either<T>(&mut self, one: &str, other: &str) -> Option<T> {
        if self.is_unreadable(one) || self.is_unreadable(other) {
            return None;
        }
        let message = format!("{} needs `{one}` or `{other}`", self.what);
        self.error(one, message)
    }

    /// The number behind a key, which may be left out.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.values.numbers(key).first().copied()
    }

    /// The numbers behind a key; none where it is not written.
    pub fn numbers(&self, key: &str) -> &'t [f64] {
        self.values.numbers(key)
    }

    /// A number above zero, if it is there.
    pub fn positive(&mut self, key: &str) -> Option<f64> {
        match self.number(key)? {
            number if number > 0.0 => Some(number),
            _ => self.error(key, format!("`{key}` must be above zero")),
        }
    }

    /// A number above zero.
    pub fn require_positive(&mut self, key: &str) -> Option<f64> {
        self.require(key)?;
        self.positive(key)
    }

    /// Two numbers above zero.
    pub fn require_positive_pair(&mut self, key: &str) -> Option<[f64; 2]> {
        match *self.require(key)? {
            [a, b] if a > 0.0 && b > 0.0 => Some([a, b]),
            _ => self.error(key, format!("both values of `{key}` must be above zero")),
        }
    }

    /// A number of zero or more; `default` where it is not written.
    pub fn not_negative(&mut self, key: &str, default: f64) -> f64 {
        match self.number(key) {
            Some(number) if number < 0.0 => {
                self.error::<()>(key, format!("`{key}` must not be negative"));
                default
            }
            number => number.unwrap_or(default),
        }
    }

    /// A number within a range; `default` where it is not written or lies outside.
    pub fn between(&mut self, key: &str, [low, high]: [f64; 2], default: f64) -> f64 {
        match self.number(key) {
            Some(number) if !(low..=high).contains(&number) => {
                let range = format!("from {} to {}", short(low), short(high));
                self.error_with::<()>(key, format!("`{key}` lies out of its range"), range);
                default
            }
            number => number.unwrap_or(default),
        }
    }

    /// The vector behind a key that must be there.
    pub fn require_vector(&mut self, key: &str) -> Option<Vec3> {
        self.require(key).and_then(|numbers| numbers.try_into().ok()).map(|numbers: [f64; 3]| Vec3::from(numbers))
    }

    /// The vector behind a key, which may be left out.
    pub fn vector(&self, key: &str) -> Option<Vec3> {
        self.numbers(key).try_into().ok().map(|numbers: [f64; 3]| Vec3::from(numbers))
    }

    /// A vector's unit vector; the vector must be there and not be zero.
    pub fn require_unit(&mut self, key: &str) -> Option<Vec3> {
        let v = self.require_vector(key)?;
        unit(&v).or_else(|| self.error(key, format!("`{key}` must not be zero")))
    }

    /// The frame whose x lies along the first of two vectors and whose x-y plane holds the second; global axes where the key is
    /// not written.
    pub fn axes(&mut self, key: &str) -> Option<Mat3> {
        if self.is_unreadable(key) {
            return None;
        }
        let vectors: Vec<Vec3> = self.numbers(key).chunks_exact(3).map(Vec3::from_column_slice).collect();
        if !self.has(key) {
            return Some(Mat3::identity());
        }
        axes(&vectors).map_or_else(|wrong| self.error(key, wrong), Some)
    }

    /// Whether a key is written, but so that it could not be read.
    pub fn is_unreadable(&self, key: &str) -> bool {
        self.unreadable.contains(&key)
    }
}

/// The unit vector along a direction; `None` where it has none.
pub fn unit(v: &Vec3) -> Option<Vec3> {
    // Scaled first: the square of a large component may overflow, that of a small one vanish.
    let unit = v.try_normalize(0.0).or_else(|| (v / v.amax()).try_normalize(0.0));
    unit.filter(|unit| unit.amax().is_finite())
}

/// The frame whose x lies along the first of two vectors and whose x-y plane holds the second.
///
/// Errors, in words: other than two vectors; vectors that are zero or parallel.
pub fn axes(vectors: &[Vec3]) -> Result<Mat3, &'static str> {
    let [x, y] = vectors else {
        return Err("`axes` takes two vectors: x, and a vector in the x-y plane");
    };
    let (x, y) = (x.try_normalize(0.0), y.try_normalize(0.0));
    let z = x.zip(y).and_then(|(x, y)| x.cross(&y).try_normalize(1e-6));
    let (x, z) = x.zip(z).ok_or("the two vectors of `axes` must be neither zero nor parallel")?;
    Ok(Mat3::from_columns(&[x, z.cross(&x), z]))
}
