//! `[study]`: quantities, step lengths and schemes to compare. Checked here with the rest of the deck; read by [`study`] alone.

pub use crate::data::{Choice, Quantity, Study};
use crate::data::{Method, Node};
use crate::places::place::Place;
use crate::procedure::accuracy::can_be_kept;
pub use crate::procedure::choose_scheme::choose_scheme;
use crate::procedure::{check_yielding, scheme as read_scheme};
use crate::report::{Owner, Report};
use crate::scene::Scene;
use crate::values::keys;
use ::deck::analysis as deck;
use ::deck::study::Study as Written;
use ::deck::words::kinds::OneOf;
use ::deck::words::{Ladder, Maybe, OneOrMany, PER_DECADE, rungs};
use base::diagnostic::{At, Span};
use base::names::nearest;
use base::quantities::{self, MOTION};
use mechanics::integrators::{SCHEMES, Scheme};
use std::sync::Arc;

/// Quantities of a node or body besides its motion: angular velocity in body axes, and the rotation matrix.
const DERIVED: [&str; 12] =
    ["body_wx", "body_wy", "body_wz", "r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"];

/// Largest number of entries of a list; more are taken for a typing error.
const MOST_ENTRIES: usize = 60;
/// Largest number of steps of a ladder in a decade.
const MOST_PER_DECADE: u64 = 20;
const MOST_SAMPLES: u64 = 1_000_000;

/// Checks `[study]` of a deck whose own scheme is known.
pub(crate) fn study<'d>(
    scene: &Scene<'d>,
    scheme: &Arc<dyn Scheme>,
    nodes: &[Node],
    report: &mut Report<'d>,
) -> Option<Study> {
    let table = scene.deck.study.as_ref()?;
    Some(Reader { scene, scheme, nodes, report }.study(table))
}

struct Reader<'a, 'd> {
    scene: &'a Scene<'d>,
    /// The deck's own.
    scheme: &'a Arc<dyn Scheme>,
    nodes: &'a [Node],
    report: &'a mut Report<'d>,
}

impl<'d> Reader<'_, 'd> {
    fn study(&mut self, study: &'d Written) -> Study {
        let (quantities, columns) = self.quantities(study);
        let time_steps = self.climbed("time_steps", &study.time_steps).into_iter().rev().collect::<Vec<_>>();
        let error_tolerances: Vec<f64> =
            self.climbed("error_tolerances", &study.error_tolerances).into_iter().rev().collect();
        if let (Some(at), Some(&largest)) = (&study.error_tolerances, error_tolerances.first())
            && largest >= 1.0
        {
            self.report.error_with::<()>(&at.span, "`error_tolerances` must lie below 1", "they are relative");
        }
        let halvings = self.halvings(study, time_steps.len());
        let samples = study.samples.as_ref().and_then(|samples| match samples.value {
            1..=MOST_SAMPLES => Some(samples.value as usize),
            _ => self.report.error(&samples.span, format!("`samples` must lie between 1 and {MOST_SAMPLES}")),
        });
        let end = self.scene.analysis.end_time;
        if let (Some(samples), Some(&longest), Some(at)) = (samples, time_steps.first(), &study.time_steps)
            && longest > end / samples as f64 * (1.0 + 1e-9)
            && end < f64::MAX
        {
            let message =
                format!("the time step {longest} is longer than the {} between two samples", end / samples as f64);
            self.report.error_with::<()>(&at.span, message, "steps end at every sample time: take fewer `samples`");
        }
        let finest = study.finest.as_ref().is_some_and(|finest| finest.value);
        let schemes = self.schemes(study);
        if let (Some(at), Some(&least)) = (&study.error_tolerances, error_tolerances.last()) {
            let listed: Vec<Arc<dyn Scheme>> = schemes.iter().map(|choice| choice.scheme.clone()).collect();
            let all = if listed.is_empty() { vec![self.scheme.clone()] } else { listed };
            for scheme in &all {
                can_be_kept("error_tolerances", least, &**scheme, &at.span, self.report);
            }
        }
        let methods = self.methods(&study.methods);
        let iteration_tolerances = self.iteration_tolerances(study);
        let meshes = self.sorted("meshes", &study.meshes);
        let beam_orders = self.beam_orders(&study.beam_orders);
        let wanted_errors = self.sorted("wanted_error", &study.wanted_error).into_iter().rev().collect();
        Study {
            quantities,
            reference: study.reference.as_ref().filter(|_| !finest).map(|file| file.value.clone()),
            columns,
            samples,
            time_steps,
            error_tolerances,
            halvings,
            schemes,
            methods,
            iteration_tolerances,
            meshes,
            beam_orders,
            wanted_errors,
        }
    }

    /// The node and component of each quantity, and its column in the reference.
    fn quantities(&mut self, study: &'d Written) -> (Vec<Quantity>, Vec<String>) {
        if study.reference.is_none() {
            let places: Vec<&Span> = study.columns.0.iter().map(|(column, _)| &column.span).collect();
            if let Some(place) = places.first() {
                self.report.error_with::<()>(place, "`columns` is about a reference", "there is no `reference`");
            }
        }
        let listed = study.quantities.as_ref().map(|at| (&at.span, &at.values));
        if let Some((span, [])) = listed.map(|(span, values)| (span, values.as_slice())) {
            self.report.error::<()>(span, "`quantities` is empty");
        }
        let of_columns = || study.columns.0.iter().map(|(_, word)| word).collect::<Vec<_>>();
        let words: Vec<&'d At<String>> = listed.map_or_else(of_columns, |(_, values)| values.iter().collect());
        let mut found: Vec<(Quantity, String)> = Vec::new();
        for word in words {
            let Some(quantity) = self.quantity(word) else { continue };
            if found.iter().any(|(other, _)| *other == quantity) {
                self.report.error::<()>(&word.span, format!("`{}` is listed twice", word.value));
                continue;
            }
            let column = study.columns.0.iter().find(|(_, of)| of.value == word.value);
            found.push((quantity, column.map_or_else(|| word.value.clone(), |(column, _)| column.value.clone())));
        }
        if let Some((_, values)) = listed.filter(|_| study.reference.is_some()) {
            // With a list from the command, other columns need no check.
            for (_, word) in &study.columns.0 {
                if !values.iter().any(|value| value.value == word.value) {
                    self.quantity(word);
                }
            }
        }
        found.into_iter().unzip()
    }

    fn quantity(&mut self, word: &'d At<String>) -> Option<Quantity> {
        let Some((name, column)) = word.rsplit_once('.') else {
            return self.report.error_with(
                &word.span,
                format!("`{}` is no quantity", word.value),
                "such as \"tip.uz\"",
            );
        };
        let name = At { value: name.to_owned(), span: word.span.clone() };
        let (label, body) = match self.scene.place_or_node(&name) {
            Some(Place::Point(node)) => (self.nodes[node].label.clone(), false),
            Some(Place::Body(body)) => (self.scene.bodies[body].name.clone(), true),
            Some(place) => {
                let message = format!("`{}` is {}", name.value, place.kind());
                return self.report.error_with(&word.span, message, "quantities are at points and bodies");
            }
            None => {
                let known = || self.scene.names.known(|place| matches!(place, Place::Point(_) | Place::Body(_)));
                return self.scene.names.unknown("point or body", &name, known, self.report);
            }
        };
        let motion = quantities::names(&MOTION).into_iter().filter(|word| !(body && ["rx", "ry", "rz"].contains(word)));
        let known: Vec<&'static str> = motion.chain(DERIVED).collect();
        match known.iter().find(|known| **known == column) {
            Some(&column) => Some(Quantity { name: name.value, label, body, column }),
            None => {
                let message = format!("there is no quantity `{column}` at `{}`", name.value);
                match nearest(column, known.iter().copied()).filter(|_| column.len() > 2) {
                    Some(near) => self.report.error_with(&word.span, message, format!("did you mean `{near}`?")),
                    None => self.report.error_with(&word.span, message, format!("there are {}", known.join(", "))),
                }
            }
        }
    }

    /// Numbers above zero, each once, sorted.
    fn sorted(&mut self, key: &str, list: &'d Maybe<OneOrMany<f64>>) -> Vec<f64> {
        let Some(list) = list else { return Vec::new() };
        self.ascending(key, &list.span, &list.values)
    }

    /// The numbers of a list or a ladder, each once, sorted.
    fn climbed(&mut self, key: &str, ladder: &'d Maybe<Ladder>) -> Vec<f64> {
        let Some(at) = ladder else { return Vec::new() };
        match &at.value {
            Ladder::Listed(values) => self.ascending(key, &at.span, values),
            Ladder::Rungs(ladder) => {
                let mut sound = true;
                for end in [&ladder.from, &ladder.to].into_iter().filter(|end| end.value <= 0.0 || end.value.is_nan()) {
                    self.report.error::<()>(&end.span, format!("`{key}` must be above zero"));
                    sound = false;
                }
                let per_decade = ladder.per_decade.as_ref().map_or(PER_DECADE, |at| at.value);
                if !(1..=MOST_PER_DECADE).contains(&per_decade) {
                    let place = ladder.per_decade.as_ref().map_or(&at.span, |at| &at.span);
                    let message = format!("`per_decade` must lie between 1 and {MOST_PER_DECADE}");
                    return self.report.error(place, message).unwrap_or_default();
                }
                let count = (ladder.to.value / ladder.from.value).log10().abs() * per_decade as f64;
                if sound && count > MOST_ENTRIES as f64 {
                    let message =
                        format!("`{key}` has {count:.0} steps from {} to {}", ladder.from.value, ladder.to.value);
                    self.report.error_with::<()>(&at.span, message, format!("at most {MOST_ENTRIES} are allowed"));
                    sound = false;
                }
                if !sound {
                    return Vec::new();
                }
                let mut numbers = rungs(ladder.from.value, ladder.to.value, per_decade);
                numbers.sort_by(f64::total_cmp);
                numbers.dedup();
                numbers
            }
        }
    }

    /// Listed numbers above zero, each once, sorted.
    fn ascending(&mut self, key: &str, place: &'d Span, list: &'d [At<f64>]) -> Vec<f64> {
        if list.is_empty() {
            self.report.error::<()>(place, format!("`{key}` is empty"));
        }
        if list.len() > MOST_ENTRIES {
            let message = format!("`{key}` has {} entries", list.len());
            self.report.error_with::<()>(place, message, format!("at most {MOST_ENTRIES} are allowed"));
        }
        for value in list.iter().filter(|value| value.value <= 0.0) {
            self.report.error::<()>(&value.span, format!("`{key}` must be above zero"));
        }
        let mut numbers: Vec<f64> = list.iter().map(|value| value.value).collect();
        numbers.sort_by(f64::total_cmp);
        numbers.dedup();
        numbers
    }

    /// The degrees of the elements of beams, each once, ascending.
    fn beam_orders(&mut self, list: &'d Maybe<OneOrMany<u64>>) -> Vec<u64> {
        let Some(list) = list else { return Vec::new() };
        if list.values.is_empty() {
            self.report.error::<()>(&list.span, "`beam_orders` is empty");
        }
        for at in list.values.iter().filter(|at| !(1..=4).contains(&at.value)) {
            self.report.error::<()>(&at.span, "`beam_orders` can be 1, 2, 3 or 4");
        }
        let mut orders: Vec<u64> = list.values.iter().map(|at| at.value).collect();
        orders.sort_unstable();
        orders.dedup();
        orders
    }

    /// The tolerances of the iteration, largest first.
    fn iteration_tolerances(&mut self, study: &'d Written) -> Vec<f64> {
        let tolerances = self.climbed("iteration_tolerances", &study.iteration_tolerances);
        if let (Some(at), Some(&largest)) = (&study.iteration_tolerances, tolerances.last())
            && largest >= 1.0
        {
            self.report.error_with::<()>(&at.span, "`iteration_tolerances` must lie below 1", "they are relative");
        }
        tolerances.into_iter().rev().collect()
    }

    fn halvings(&mut self, study: &'d Written, time_steps: usize) -> usize {
        let Some(halvings) = &study.halvings else { return 0 };
        if halvings.value > 30 {
            self.report.error_with::<()>(&halvings.span, "`halvings` is above 30", "each doubles the steps of a run");
        }
        if time_steps > 1 && halvings.value > 0 {
            self.report.error_with::<()>(
                &halvings.span,
                "`halvings` goes with one time step",
                "`time_steps` lists several",
            );
        }
        usize::try_from(halvings.value).unwrap_or(0)
    }

    fn schemes(&mut self, study: &'d Written) -> Vec<Choice> {
        let own = self.scene.deck.integrator.as_ref();
        let yields = self.scene.parts.list.iter().any(|part| part.yields());
        let mut choices: Vec<Choice> = Vec::new();
        for at in &study.schemes {
            let owner = Owner::new("a scheme of `schemes`", &at.span);
            if self.report.require(&owner, "scheme", &at.kind).is_none() {
                continue;
            }
            // Errors use the words of `[integrator]`; warnings about a scheme are dropped, because the study shows its results.
            let mark = self.report.mark();
            let mut scheme = read_scheme(at, self.report);
            self.report.forget_warnings_since(mark);
            let word = scheme.word();
            self.report.reject_unused("a scheme of a study", &keys!(at; mass_scaling));
            let mut entries = entries(at);
            let rotation = own.and_then(|own| own.rotation_update.as_ref()).map(|update| update.value.word());
            let takes_own = word == self.scheme.word() && entries.is_empty();
            if takes_own && let Some(own) = own {
                entries = self::entries(own);
                scheme = self.scheme.clone();
            } else if let Some(rotation) = rotation
                && !entries.iter().any(|(key, _)| *key == "rotation_update")
            {
                entries.push(("rotation_update", format!("\"{rotation}\"")));
            }
            check_yielding(&*scheme, &at.span, yields, self.report);
            let choice = choice(&scheme, &entries);
            if choices.iter().any(|other| other.label == choice.label) {
                // A scheme with the parameters of `[integrator]` differs between the runs of a study; it may equal another one in one of
                // them.
                if takes_own && own.is_some_and(|own| !self::entries(own).is_empty()) {
                    continue;
                }
                self.report.error::<()>(&at.span, format!("`{}` is listed twice", choice.label));
            }
            choices.push(choice);
        }
        choices
    }

    fn methods(&mut self, list: &'d [At<Method>]) -> Vec<Method> {
        let mut methods = Vec::new();
        for at in list {
            let method = at.value;
            if methods.contains(&method) {
                self.report.error::<()>(&at.span, format!("`{}` is listed twice", method.word()));
            }
            methods.push(method);
        }
        methods
    }
}

/// Why a model cannot be studied; `None`: it can.
pub fn obstacle(model: &crate::data::Model) -> Option<&'static str> {
    let is_path = model.analysis.step_length.is_arc_length();
    is_path.then_some("a study goes over time steps, and with `control = \"arc-length\"` there are none")
}

/// The keys of an integrator besides its scheme, as TOML.
fn entries(integrator: &OneOf<deck::Integrator>) -> Vec<(&'static str, String)> {
    let keys = SCHEMES.iter().flat_map(|kind| kind.keys);
    let mut entries: Vec<(&'static str, String)> =
        keys.filter_map(|key| Some((key.name, integrator.values.numbers(key.name).first()?.to_string()))).collect();
    if let Some(update) = &integrator.rotation_update {
        entries.push(("rotation_update", format!("\"{}\"", update.value.word())));
    }
    entries
}

fn choice(scheme: &Arc<dyn Scheme>, entries: &[(&'static str, String)]) -> Choice {
    let word = scheme.word();
    let (mut label, mut table) = (word.to_owned(), format!("{{ scheme = \"{word}\""));
    for (key, value) in entries {
        label += &format!(":{key}={}", value.trim_matches('"'));
        table += &format!(", {key} = {value}");
    }
    Choice { label, scheme: scheme.clone(), table: table + " }" }
}
