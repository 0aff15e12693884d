//! The schema of a table with one of several kinds: each word with its meaning, each key with its kinds.

use super::kind::{Kind, Kinds};
use super::one_of::OneOf;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Map, Value as Json, json};
use std::borrow::Cow;

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

/// The meaning of a key and the kinds that take it: "Outer radius. (tube)"
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
