//! `[[load_cases]]`, `[[combinations]]` and `[[envelopes]]`.

use super::data::{CaseActor, CaseTerm, ENVELOPE_ENDS, Envelope, LoadCase, LoadCases};
use super::procedure::stops::NamedActors;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::values::keys;
use base::diagnostic::{At, Diagnostic, Span};
use deck::Deck;
use deck::words::{Maybe, Names, OneOrMany};

/// The name by which cases call the weight.
const GRAVITY: &str = "gravity";

/// Reads the cases of a linear analysis; `actors` are the loads and motions with names.
pub(super) fn cases<'d>(scene: &Scene<'d>, actors: &NamedActors<'d>, report: &mut Report<'d>) -> LoadCases {
    let deck = scene.deck;
    if !scene.analysis.is_linear() {
        let spans = deck.load_cases.iter().map(|table| &table.span);
        let spans = spans.chain(deck.combinations.iter().map(|table| &table.span));
        for span in spans.chain(deck.envelopes.iter().map(|table| &table.span)) {
            let hint = "cases share one factorization in `[analysis] kind = \"static\"` with `geometry = \"linear\"`";
            report.error_with::<()>(span, "load cases need a linear analysis", hint);
        }
        return LoadCases::default();
    }
    let mut reader = Reader { scene, actors, names: Vec::new(), cases: LoadCases::default() };
    for table in &deck.load_cases {
        let owner = reader.owner("load case", &table.name, &table.span, report);
        let terms = reader.terms(&owner, (&table.loads, &table.factors), report);
        reader.cases.list.push(LoadCase { name: name_of(&table.name), terms });
    }
    let own = reader.cases.list.len();
    for table in &deck.combinations {
        let owner = reader.owner("combination", &table.name, &table.span, report);
        let named = report.require(&owner, "cases", &table.cases);
        let places = named.map_or_else(Vec::new, |names| reader.places(&names.values, own, report));
        let factors = factors(&owner, named, &table.factors, report);
        let shares = places.iter().zip(factors).filter_map(|(place, factor)| Some(((*place)?, factor)));
        let terms = shares.flat_map(|(place, factor)| {
            let of = reader.cases.list[place].terms.iter();
            of.map(move |term| CaseTerm { factor: factor * term.factor, ..term.clone() })
        });
        let terms = terms.collect();
        reader.cases.list.push(LoadCase { name: name_of(&table.name), terms });
    }
    let all = if own < reader.cases.list.len() { own..reader.cases.list.len() } else { 0..own };
    for table in &deck.envelopes {
        reader.owner("envelope", &table.name, &table.span, report);
        let cases = match &table.cases {
            Some(names) => {
                let count = reader.cases.list.len();
                reader.places(&names.values, count, report).into_iter().flatten().collect()
            }
            None => all.clone().collect(),
        };
        if own == 0 {
            report.error_with::<()>(
                &table.span,
                "an envelope needs `[[load_cases]]`",
                "its extremes are those over cases",
            );
        }
        reader.cases.envelopes.push(Envelope { name: name_of(&table.name), cases });
    }
    if own > 0 {
        check_acting(deck, report);
    }
    if own == 0
        && let Some(table) = deck.combinations.first()
    {
        report.error_with::<()>(&table.span, "a combination needs `[[load_cases]]`", "it is a sum of load cases");
    }
    reader.cases
}

/// Reports everything that acts in no load case.
fn check_acting<'d>(deck: &'d Deck, report: &mut Report<'d>) {
    let named = deck.load_cases.iter().filter_map(|case| case.loads.as_ref()).flat_map(|loads| &loads.values);
    let named: Vec<&str> = named.map(|name| name.as_str()).collect();
    let acts = |name: &Maybe<String>| name.as_ref().is_some_and(|name| named.contains(&name.as_str()));
    let loads = deck.loads.iter().filter(|load| !acts(&load.name)).map(|load| (&load.span, "this load"));
    let moving = deck.supports.iter().filter(|support| !acts(&support.name));
    let motions = moving.filter_map(|support| Some((&support.motion.as_ref()?.span, "this motion")));
    let hint = "name it in `loads` of a load case, or leave it out";
    for (span, what) in loads.chain(motions) {
        report.push(Diagnostic::warning(format!("{what} acts in no load case")).at(span).hint(hint));
    }
    let gravity = deck.environment.as_ref().and_then(|of| of.gravity.as_ref());
    if let Some(gravity) = gravity.filter(|_| !named.contains(&GRAVITY)) {
        let hint = "add \"gravity\" to `loads` of a load case, or leave it out";
        report.push(Diagnostic::warning("gravity acts in no load case").at(&gravity.span).hint(hint));
    }
    for joint in &deck.joints {
        let name = joint.name.as_ref().map_or("", |name| name.as_str());
        let hint = "cases name loads and supports: use these, or leave out `[[load_cases]]`";
        for (key, place) in keys!(joint; effort, motion).into_iter().filter_map(|(key, place)| Some((key, place?))) {
            report.error_with::<()>(place, format!("`{key}` of joint `{name}` acts in no load case"), hint);
        }
    }
}

fn name_of(name: &Maybe<String>) -> String {
    name.as_ref().map_or_else(String::new, |name| name.value.clone())
}

struct Reader<'a, 'd> {
    scene: &'a Scene<'d>,
    actors: &'a NamedActors<'d>,
    names: Vec<&'d str>,
    cases: LoadCases,
}

impl<'d> Reader<'_, 'd> {
    /// A table with a name that no other case, combination or envelope has.
    fn owner(&mut self, what: &str, name: &'d Maybe<String>, span: &'d Span, report: &mut Report<'d>) -> Owner<'d> {
        let called = name.as_ref().map_or(String::new(), |name| format!(" `{}`", name.value));
        let owner = Owner::new(format!("{what}{called}"), span);
        if let Some(name) = report.require(&owner, "name", name) {
            if name.is_empty() {
                report.error::<()>(&name.span, "a name must not be empty");
            } else if self.names.contains(&name.as_str()) {
                let message = format!("two cases, combinations or envelopes have the name `{}`", name.value);
                report.error_with::<()>(&name.span, message, "give one of them another name");
            } else if ENVELOPE_ENDS.iter().any(|end| name.ends_with(end)) {
                let message = format!("`{}` is a name of rows of an envelope", name.value);
                report.error_with::<()>(&name.span, message, "end it other than with .max and .min");
            }
            self.names.push(name.as_str());
        }
        owner
    }

    /// The loads of a case with their factors.
    fn terms(
        &self,
        owner: &Owner<'d>,
        (loads, given): (&'d Maybe<Names>, &'d Maybe<OneOrMany<f64>>),
        report: &mut Report<'d>,
    ) -> Vec<CaseTerm> {
        let named = report.require(owner, "loads", loads);
        let factors = factors(owner, named, given, report);
        let names = named.map_or(&[][..], |names| &names.values);
        let found = |(name, factor): (&At<String>, f64)| {
            self.acting(name, report).into_iter().map(move |acts| CaseTerm { acts, factor })
        };
        names.iter().zip(factors).flat_map(found).collect()
    }

    /// The loads and motions of a name, which several tables may share.
    fn acting(&self, name: &At<String>, report: &mut Report<'d>) -> Vec<CaseActor> {
        let like = self.actors.iter().filter(|(other, _)| other.value == name.value);
        let all: Vec<CaseActor> = like.map(|(_, acts)| CaseActor::Named(acts.clone())).collect();
        if !all.is_empty() {
            return all;
        }
        if name.value == GRAVITY {
            let has_gravity = self.scene.deck.environment.as_ref().is_some_and(|of| of.gravity.is_some());
            if !has_gravity {
                let hint = "such as `gravity = [0.0, 0.0, -9.81]` in `[environment]`";
                report.error_with::<()>(&name.span, "there is no gravity to act in this case", hint);
            }
            return vec![CaseActor::Gravity];
        }
        let known = self.actors.iter().map(|(name, _)| name.as_str()).chain([GRAVITY]);
        report.unknown::<()>("load, or support with a motion,", name, known);
        Vec::new()
    }

    /// The places of the named cases among the first so many.
    fn places(&self, names: &[At<String>], count: usize, report: &mut Report<'d>) -> Vec<Option<usize>> {
        let known = &self.cases.list[..count];
        let place = |name: &At<String>| {
            let found = known.iter().position(|case| case.name == name.value);
            found.or_else(|| report.unknown("load case", name, known.iter().map(|case| case.name.as_str())))
        };
        names.iter().map(place).collect()
    }
}

/// A factor for each of the names.
fn factors(owner: &Owner, names: Option<&At<Names>>, given: &Maybe<OneOrMany<f64>>, report: &mut Report) -> Vec<f64> {
    let count = names.map_or(0, |names| names.values.len());
    match given {
        None => vec![1.0; count],
        Some(given) if given.single => vec![given.values[0].value; count],
        Some(given) => {
            if names.is_some() && given.values.len() != count {
                let message = format!("{} has {count} names and {} factors", owner.what, given.values.len());
                report.error_with::<()>(&given.span, message, "give one factor for each name, or one for all");
            }
            given.values.iter().map(|factor| factor.value).collect()
        }
    }
}
