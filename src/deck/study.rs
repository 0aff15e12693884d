//! `[study]`: settings and quantities of `rdsolve study`. A run ignores it.

use std::borrow::Cow;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::analysis::{Integrator, Method};
use super::set;
use super::words::kinds::OneOf;
use super::words::{Ladder, Maybe, Named, Names, OneOrMany};
use base::diagnostic::{At, Diagnostic, Span};

/// Settings of `rdsolve study`: time steps, schemes, iteration methods, meshes.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Quantities of the errors, as name.quantity of points and bodies: x y z, ux uy uz, rx ry rz (not of bodies), vx vy vz, wx wy wz, ax
    /// ay az, alphax alphay alphaz, body_wx body_wy body_wz (in body axes), r11 to r33 (rotation matrix). Default: those of `columns`; else
    /// ux, uy, uz of all points in nodes.csv and of all bodies.
    pub quantities: Maybe<Names>,
    /// CSV file beside the deck: the time, then one column for each quantity. Default: the finest runs, extrapolated.
    pub reference: Maybe<String>,
    /// Measure against the finest runs all the same. Default: false.
    pub finest: Maybe<bool>,
    /// Quantities by the columns of the reference that hold them. Default: a column has the name of its quantity.
    #[serde(default)]
    pub columns: Named<String>,
    /// Intervals between the times of the errors, from 0 to the end. Default: as the reference has them, or 200.
    pub samples: Maybe<u64>,
    /// Time steps; none may be longer than an interval of the samples. A ladder goes by factors of 10^(1/4): `{ from = 1e-2, to = 1e-4 }`.
    /// Default: 8 times the step of `[analysis]`, if possible, and six halvings of it.
    pub time_steps: Maybe<Ladder>,
    /// Halve one time step so many times, instead of a list.
    pub halvings: Maybe<u64>,
    /// With an automatic time step, separate lines for these tolerances, or a range of them. Default: where the deck's step is automatic,
    /// its own tolerance times 10, 1, 0.1 and 0.01.
    pub error_tolerances: Maybe<Ladder>,
    /// Tables like `[integrator]`, or words with parameters: "wilson-theta", "newmark:gamma=0.6:beta=0.31". Default: the deck's own. A
    /// scheme without parameters uses those of `[integrator]` if that names the same scheme.
    #[serde(default)]
    #[schemars(with = "Vec<Written>")]
    pub schemes: Vec<At<OneOf<Integrator>>>,
    /// Methods of `[iteration]`. Default: the deck's own.
    #[serde(default)]
    pub methods: Vec<At<Method>>,
    /// Values of `tolerance` of `[iteration]`, or a ladder of them. Default: the deck's own.
    pub iteration_tolerances: Maybe<Ladder>,
    /// Factors on the `elements` of all beams and shells, and of bars that have several on a segment. Default: 1.
    pub meshes: Maybe<OneOrMany<f64>>,
    /// Polynomial degrees of the elements of all beams, 1 to 4: their `order`. Default: the deck's own.
    pub beam_orders: Maybe<OneOrMany<u64>>,
    /// Errors for which the study names the cheapest setting. Default: 1e-2, 1e-3 and 1e-4.
    pub wanted_error: Maybe<OneOrMany<f64>>,
}

/// For the schema: how a scheme may be written.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code)] // only its schema is used
enum Written {
    Word(String),
    Table(Box<OneOf<Integrator>>),
}

/// A scheme written as a word, at a place of `study.schemes`.
pub struct Word {
    item: usize,
    span: Span,
    scheme: String,
    /// `key=value`, as [`set::toml`] makes them, each with its place in the deck.
    parameters: Vec<(usize, String)>,
}

/// Schemes that are written as words.
pub fn words(root: &DeTable) -> Vec<Word> {
    let schemes = root.get("study").and_then(|study| study.get_ref().as_table()?.get("schemes"));
    let list = schemes.and_then(|list| list.get_ref().as_array());
    let items = list.into_iter().flat_map(|list| list.iter().enumerate());
    let word = |(item, value): (usize, &Spanned<DeValue>)| {
        let (text, span) = (value.get_ref().as_str()?, value.span());
        let mut pieces = text.split(':');
        let scheme = pieces.next().unwrap_or_default();
        // Behind the quote, unless something in the text was escaped.
        let mut at = span.start + 1 + scheme.len();
        let parameters = pieces.map(|piece| {
            at += 1;
            let begin = at;
            at += piece.len();
            (begin, set::toml(piece))
        });
        let parameters = parameters.collect();
        Some(Word { item, span, scheme: scheme.to_owned(), parameters })
    };
    items.filter_map(word).collect()
}

/// Makes tables of the words: "newmark:gamma=0.6" is { scheme = "newmark", gamma = 0.6 }. Reports words that are no `key=value`.
pub fn expand<'i>(root: &mut DeTable<'i>, words: &'i [Word]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    let Some(DeValue::Table(study)) = root.get_mut("study").map(Spanned::get_mut) else { return problems };
    let Some(DeValue::Array(list)) = study.get_mut("schemes").map(Spanned::get_mut) else { return problems };
    for word in words {
        let span = word.span.clone();
        let mut table = DeTable::new();
        let scheme = DeValue::String(Cow::Borrowed(word.scheme.as_str()));
        table.insert(Spanned::new(span.clone(), Cow::Borrowed("scheme")), Spanned::new(span.clone(), scheme));
        for (begin, parameter) in &word.parameters {
            match DeTable::parse(parameter) {
                Ok(entries) => table.extend(set::moved(entries.into_inner(), *begin)),
                Err(_) => {
                    let message = format!("`{}` is not key=value", parameter.trim());
                    let hint = "a scheme with parameters is written \"newmark:gamma=0.6:beta=0.31\"";
                    problems.push(Diagnostic::error(message).at(&span).hint(hint));
                }
            }
        }
        if let Some(item) = list.get_mut(word.item) {
            *item = Spanned::new(span, DeValue::Table(table));
        }
    }
    problems
}
