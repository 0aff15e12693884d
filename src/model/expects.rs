//! `[[expect]]`: values that a run must reach.

use super::data::{
    Beam, DIRECTIONS, Expect, ExpectAt, JOINT_MAGNITUDES, LoadCases, ModeExtent, OverFrequencies, Part, PartType,
    ResponseOf, Tolerance, When, quantities_of,
};
use super::places::nodes::Topology;
use super::places::place::Place;
use super::procedure::displacement_targets::displacement_target;
use super::report::{Owner, Report};
use super::scene::Scene;
use super::values::keys;
use base::diagnostic::{At, Diagnostic};
use base::names::{nearest, short};
use base::quantities::{self, Column, PLASTIC_STRAIN, QUATERNION, SECTION_STRESSES};
use deck::expect as words;
use deck::parts::PartIndex;
use deck::words::{NumberOr, Table};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The remedy where a plastic strain of an elastic part is expected.
const ELASTIC_HINT: &str = "give its material `model` = \"elastic-plastic\", or name another quantity";

/// The remedy where a value of a rigid part is expected.
const RIGID_HINT: &str = "remove the part from `parts` of its body, or expect a motion";

/// The data behind expected values.
struct Expects<'a, 'd> {
    scene: &'a Scene<'d>,
    topology: &'a Topology,
    /// The restrained directions at all nodes of a label.
    held: HashMap<&'a str, [bool; 6]>,
    is_arc_length: bool,
    cases: &'a LoadCases,
    report: &'a mut Report<'d>,
}

/// Reads `[[expect]]`: the quantity, the instant and the tolerance of each entry.
pub(super) fn expects<'d>(
    scene: &Scene<'d>,
    topology: &Topology,
    is_arc_length: bool,
    cases: &LoadCases,
    report: &mut Report<'d>,
) -> Vec<Expect> {
    let mut held: HashMap<&str, [bool; 6]> = HashMap::new();
    topology.restraints().for_each(|of| held.entry(topology.label(of.node)).or_default()[of.dof] = true);
    let mut tables = Expects { scene, topology, held, is_arc_length, cases, report };
    let (has_modes, response) = (scene.analysis.has_modes(), scene.analysis.response().is_some());
    let is_seen = |entry: &words::Expect| {
        let of_response = response && !entry.is_of_modes() && entry.time.is_none() && entry.when.is_none();
        !has_modes || entry.is_of_modes() || entry.frequency.is_some() || of_response
    };
    for entry in scene.deck.expect.iter().filter(|entry| !is_seen(entry)) {
        let (message, hint) = match response {
            true => (
                "this is not looked at in a frequency response",
                "`frequency` in place of `time` expects an amplitude or a phase",
            ),
            false => {
                ("this is not looked at in an analysis of modes", "`mode` in place of `at` expects something of a mode")
            }
        };
        tables.report.push(Diagnostic::note(message).at(&entry.span).hint(hint));
    }
    let tables_of = scene.deck.expect.iter().enumerate().filter(|(_, entry)| is_seen(entry));
    let read = |(index, table): (usize, &'d At<Table<words::Expect>>)| {
        let expect = tables.expect(&Owner::new("`[[expect]]`", &table.span), table)?;
        Some(Expect { index, ..expect })
    };
    tables_of.filter_map(read).collect()
}

/// For each of `[sets]` with an expected reaction, the labels of its nodes; empty for the other sets.
pub(super) fn summed_reactions(scene: &Scene, expects: &[Expect], topology: &Topology) -> Vec<HashSet<String>> {
    let labels = |set: usize| match expects.iter().any(|expect| expect.at == ExpectAt::Reactions(set)) {
        true => scene.nodes_of(Place::Set(set)).into_iter().map(|node| topology.label(node).to_owned()).collect(),
        false => HashSet::new(),
    };
    (0..scene.deck.sets.0.len()).map(labels).collect()
}

impl<'d> Expects<'_, 'd> {
    fn expect(&mut self, owner: &Owner<'d>, expect: &'d words::Expect) -> Option<Expect> {
        if let Some(number) = &expect.critical_speed {
            return self.expect_critical_speed(owner, expect, number);
        }
        if let Some(number) = &expect.mode {
            return self.expect_mode(owner, expect, number);
        }
        let of_response = self.scene.analysis.response().is_some();
        if of_response || expect.frequency.is_some() {
            return self.expect_response(owner, expect, of_response);
        }
        let name = self.report.require(owner, "at", &expect.at);
        let at = name.and_then(|name| self.expect_at(name));
        let quantity = self.report.require(owner, "quantity", &expect.quantity);
        let mut column = None;
        if let (Some((at, columns)), Some(quantity), Some(name)) = (&at, quantity, name) {
            let strain = quantity.value == PLASTIC_STRAIN.name && !columns.contains(&PLASTIC_STRAIN);
            if strain && matches!(at, ExpectAt::Shells(..) | ExpectAt::Sections(_) | ExpectAt::Elements(..)) {
                let message = format!("the material of `{}` is elastic, so it has no plastic strain", name.value);
                return self.report.error_with(&quantity.span, message, ELASTIC_HINT);
            }
            let reaction = quantities::REACTION.iter().position(|column| column.name == quantity.value);
            if let (ExpectAt::Node(_), Some(dof)) =
                (at, reaction.filter(|_| !columns.iter().any(|of| of.name == quantity.value)))
            {
                let message = format!("`{}` has no support in {}, so it has no reaction", name.value, DIRECTIONS[dof]);
                let hint = match self.scene.deck.stages.is_empty() {
                    true => "reactions are those of `[[supports]]`",
                    false => "reactions are those of `[[supports]]`: give `stage`, the name of one with such a support",
                };
                return self.report.error_with(&quantity.span, message, hint);
            }
            column = self.column(columns, quantity, name);
        }
        let when = self.when(owner, expect);
        let judged = self.judged(owner, expect);
        let ((at, _), quantity, when, (value, tolerance)) = (at?, column?, when?, judged?);
        let moment = self.moment(expect, &when);
        let stage = expect.stage.as_ref().map_or(String::new(), |stage| match when {
            When::End => String::new(),
            _ => format!(" in stage `{}`", stage.value),
        });
        Some(Expect {
            index: 0,
            at,
            quantity: quantity.to_owned(),
            when,
            value,
            tolerance,
            source: expect.source.as_ref().map(|source| source.value.clone()).unwrap_or_default(),
            label: format!("{quantity} of {} {moment}{stage}", name?.value),
        })
    }

    /// The instant in words, as `at t = 0.5`.
    fn moment(&self, expect: &words::Expect, when: &When) -> String {
        match when {
            When::Time(time) => format!("at t = {time}"),
            When::Case(place) => format!("in case `{}`", self.cases.list[*place].name),
            When::Target(at) => {
                let (node, direction) = (&self.topology.list[at.node].label, DIRECTIONS[at.dof]);
                let pass = if at.pass == 1 { String::new() } else { format!(", pass {}", at.pass) };
                format!("where {direction} of {node} is {}{pass}", at.value)
            }
            When::End => expect
                .stage
                .as_ref()
                .map_or("at the end".to_owned(), |at| format!("at the end of stage `{}`", at.value)),
            When::Max => "at its maximum".to_owned(),
            When::Min => "at its minimum".to_owned(),
            When::Abs => "at its greatest absolute value".to_owned(),
        }
    }

    /// A quantity of a mode.
    fn expect_mode(&mut self, owner: &Owner<'d>, expect: &'d words::Expect, number: &At<u64>) -> Option<Expect> {
        let keys = keys!(expect; at, time, when, peak, frequency);
        self.report.reject_unused("a mode", &keys);
        if !self.scene.analysis.has_modes() {
            let hint = "`kind = \"modal\"` or `\"buckling\"` of `[analysis]`, or of a stage, finds modes";
            return self.report.error_with(&number.span, "`mode` needs an analysis of modes", hint);
        }
        if !self.scene.analysis.lists_modes() {
            let hint = "`method = \"modal\"` in `[analysis]` finds modes";
            return self.report.error_with(
                &number.span,
                "the direct solution of a frequency response has no modes",
                hint,
            );
        }
        if number.value == 0 {
            return self.report.error(&number.span, "`mode` must be at least 1");
        }
        if let ModeExtent::Count(count) = self.scene.analysis.extent()
            && number.value > count as u64
        {
            let hint = format!("`modes` is {count}");
            return self.report.error_with(&number.span, "this mode is not computed", hint);
        }
        let quantity = self.report.require(owner, "quantity", &expect.quantity);
        let name = At { value: format!("mode {}", number.value), span: number.span.clone() };
        let column = quantity.and_then(|quantity| self.column(&quantities::MODE, quantity, &name));
        let ((value, tolerance), quantity) = (self.judged(owner, expect)?, column?);
        let at = ExpectAt::Mode(number.value as usize - 1);
        Some(self.of_modes(expect, at, (quantity, value, tolerance), &name))
    }

    /// A quantity of a critical speed.
    fn expect_critical_speed(
        &mut self,
        owner: &Owner<'d>,
        expect: &'d words::Expect,
        number: &At<u64>,
    ) -> Option<Expect> {
        let keys = keys!(expect; at, mode, time, when, peak, frequency);
        self.report.reject_unused("a critical speed", &keys);
        if self.scene.analysis.speeds().is_empty() {
            let hint = "`speeds` of a modal analysis with `damped = true` finds them";
            return self.report.error_with(&number.span, "`critical_speed` needs speeds of rotation", hint);
        }
        if number.value == 0 {
            return self.report.error(&number.span, "`critical_speed` must be at least 1");
        }
        let quantity = self.report.require(owner, "quantity", &expect.quantity);
        let name = At { value: format!("critical speed {}", number.value), span: number.span.clone() };
        let column = quantity.and_then(|quantity| self.column(&quantities::CRITICAL_SPEED, quantity, &name));
        let ((value, tolerance), quantity) = (self.judged(owner, expect)?, column?);
        let at = ExpectAt::CriticalSpeed(number.value as usize - 1);
        Some(self.of_modes(expect, at, (quantity, value, tolerance), &name))
    }

    /// An expected value of an analysis of modes, which has one value.
    fn of_modes(
        &self,
        expect: &words::Expect,
        at: ExpectAt,
        (quantity, value, tolerance): (&str, f64, Tolerance),
        name: &str,
    ) -> Expect {
        let stage = expect.stage.as_ref().map_or(String::new(), |stage| format!(" in stage `{}`", stage.value));
        Expect {
            index: 0,
            at,
            quantity: quantity.to_owned(),
            when: When::Abs,
            value,
            tolerance,
            source: expect.source.as_ref().map(|source| source.value.clone()).unwrap_or_default(),
            label: format!("{quantity} of {name}{stage}"),
        }
    }

    /// An amplitude or a phase of a frequency response.
    fn expect_response(&mut self, owner: &Owner<'d>, expect: &'d words::Expect, is_response: bool) -> Option<Expect> {
        if let Some(at) = expect.frequency.as_ref().filter(|_| !is_response) {
            let hint = "`kind = \"frequency-response\"` in `[analysis]` goes over frequencies";
            return self.report.error_with(&at.span, "`frequency` needs a frequency response", hint);
        }
        self.report.reject_unused("a frequency response", &keys!(expect; time, when));
        let over = self.over_frequencies(owner, expect);
        let name = self.report.require(owner, "at", &expect.at);
        let of = name.and_then(|name| match self.scene.place_or_node(name) {
            Some(Place::Point(node)) => Some(ResponseOf::Node(node)),
            Some(Place::Body(body)) => Some(ResponseOf::Node(self.scene.names.body_node(body))),
            Some(Place::Part(part)) if part.kind.word() == "link" => Some(ResponseOf::LinkForce(part.index)),
            Some(place) => {
                let message = format!("`{}` is {}, without a response", name.value, place.kind());
                self.report.error_with(&name.span, message, "name a point, a body or a link")
            }
            None => {
                let known = || self.scene.names.known(|place| matches!(place, Place::Point(_) | Place::Body(_)));
                self.scene.names.unknown("point, body or link", name, known, self.report)
            }
        });
        let quantity = self.report.require(owner, "quantity", &expect.quantity);
        let columns = match of {
            Some(ResponseOf::LinkForce(_)) => &quantities::RESPONSE_LINK,
            _ => &quantities::RESPONSE,
        };
        let column = quantity.zip(name).and_then(|(quantity, name)| self.column(columns, quantity, name));
        let ((value, tolerance), over, of, quantity) = (self.judged(owner, expect)?, over?, of?, column?);
        let moment = match over {
            OverFrequencies::At(frequency) => format!("at frequency {frequency}"),
            OverFrequencies::Max => "at its maximum over frequencies".to_owned(),
            OverFrequencies::Min => "at its minimum over frequencies".to_owned(),
            OverFrequencies::Abs => "at its greatest absolute value over frequencies".to_owned(),
        };
        Some(Expect {
            index: 0,
            at: ExpectAt::Response(of, over),
            quantity: quantity.to_owned(),
            when: When::Abs,
            value,
            tolerance,
            source: expect.source.as_ref().map(|source| source.value.clone()).unwrap_or_default(),
            label: format!("{quantity} of {} {moment}", name?.value),
        })
    }

    /// The frequency of an expected value, or the extreme over all.
    fn over_frequencies(&mut self, owner: &Owner<'d>, expect: &'d words::Expect) -> Option<OverFrequencies> {
        match (&expect.frequency, &expect.peak) {
            (Some(_), Some(peak)) => {
                self.report.error(&peak.span, "an expected value has `frequency` or `peak`, not both")
            }
            (Some(at), None) if !(at.value >= 0.0 && at.value.is_finite()) => {
                self.report.error(&at.span, "a frequency must not be negative")
            }
            (Some(at), None) => Some(OverFrequencies::At(at.value)),
            (None, Some(peak)) => Some(match peak.value {
                words::Peak::Max => OverFrequencies::Max,
                words::Peak::Min => OverFrequencies::Min,
                words::Peak::Abs => OverFrequencies::Abs,
            }),
            (None, None) if expect.at_least.is_some() => Some(OverFrequencies::Min),
            (None, None) if expect.at_most.is_some() => Some(OverFrequencies::Max),
            (None, None) if ["frequency", "peak"].iter().any(|key| self.report.is_spoiled(owner.span, key)) => None,
            (None, None) => self.report.error(owner.span, format!("{} needs `frequency` or `peak`", owner.what)),
        }
    }

    /// Finds the place of the expected value, and its columns.
    fn expect_at(&mut self, name: &At<String>) -> Option<(ExpectAt, Vec<Column>)> {
        if name.value == "energy" {
            return Some((ExpectAt::Energy, quantities::ENERGY.to_vec()));
        }
        if name.value == "analysis" && self.scene.names.declared("analysis").is_none() {
            return Some((ExpectAt::Analysis, vec![quantities::TIME]));
        }
        // Ties share no names with other things, which come first.
        let is_meant = |tie: &At<Table<deck::ties::Tie>>| tie.name.as_ref().is_some_and(|at| at.value == name.value);
        if self.scene.names.declared(&name.value).is_none()
            && let Some(tie) = self.scene.deck.ties.iter().position(is_meant)
        {
            return Some((ExpectAt::Tie(tie), quantities::TIE.to_vec()));
        }
        match self.scene.place_or_node(name) {
            Some(Place::Point(node)) => {
                let columns = [quantities::MOTION.concat(), self.reactions(node)].concat();
                Some((ExpectAt::Node(node), columns))
            }
            Some(Place::Body(body)) => {
                let node = self.scene.names.body_node(body);
                let columns = [&quantities::MOTION.concat()[..], &QUATERNION, &self.reactions(node)].concat();
                Some((ExpectAt::Node(node), columns))
            }
            Some(Place::Joint(joint)) => {
                let mut columns = [&quantities::JOINT_REACTION[..], &JOINT_MAGNITUDES].concat();
                let of_deck = self.scene.deck.joints.get(joint);
                if of_deck.and_then(|joint| joint.kind.as_ref()).is_some_and(|kind| !kind.make.coordinates.is_empty()) {
                    columns.extend(quantities::JOINT_COORDINATE);
                }
                if of_deck.is_some_and(|joint| joint.motion.is_some() || joint.effort.is_some()) {
                    columns.push(quantities::JOINT_POWER);
                }
                Some((ExpectAt::Joint(joint), columns))
            }
            Some(Place::Drift(drift)) => Some((ExpectAt::Drift(drift), quantities::DRIFT.to_vec())),
            Some(Place::Part(part)) if part.kind.is_surface() => self.expect_stress(part, name),
            Some(Place::Part(part)) if part.kind.has_sections() => self.expect_forces(part, name),
            Some(Place::Part(part)) if part.kind.is_deformable() => self.expect_strain(part, name),
            Some(Place::Part(part)) => Some((ExpectAt::Part(part), quantities_of(part.kind))),
            Some(Place::Set(set)) if !self.reactions_of(set).is_empty() => {
                Some((ExpectAt::Reactions(set), self.reactions_of(set)))
            }
            Some(place) => {
                let message = format!("`{}` is {}, without values", name.value, place.kind());
                self.report.error_with(
                    &name.span,
                    message,
                    "name a point, body, part, link, joint, contact, drift or set with supports, or \"energy\"",
                )
            }
            None => self.unknown(name),
        }
    }

    /// Reports a name without values. For a support the hint names one of its points.
    fn unknown<T>(&mut self, name: &At<String>) -> Option<T> {
        if let Some(node) = self.held_by(name) {
            let message = format!("`{}` is the name of a support, which has no values", name.value);
            let such = node.filter(|node| !self.reactions(*node).is_empty()).map_or_else(String::new, |node| {
                let list = &self.topology.list;
                let columns: Vec<String> = self.reactions(node).iter().map(|of| format!("\"{}\"", of.name)).collect();
                format!(", such as at = \"{}\" with quantity = {}", list[node].label, columns.join(" or "))
            });
            return self.report.error_with(
                &name.span,
                message,
                format!("for its reaction give a point that it holds{such}"),
            );
        }
        let known = || {
            let mut known = self.scene.names.known(|_| true);
            known.push("energy");
            known.sort_unstable();
            known
        };
        self.scene.names.unknown("point, body, part or link", name, known, self.report)
    }

    /// The first point or body in the support of this name, if one has its own name; `None` without such a support.
    fn held_by(&self, name: &At<String>) -> Option<Option<usize>> {
        let is_named =
            |of: &&At<Table<deck::supports::Support>>| of.name.as_ref().is_some_and(|own| own.value == name.value);
        let support = self.scene.deck.supports.iter().find(is_named)?;
        let places = support.at.iter().flat_map(|at| &at.values).filter_map(|at| self.scene.place_or_node(at));
        let mut leaves = places.flat_map(|place| self.scene.names.leaves(place));
        Some(leaves.find_map(|place| match place {
            Place::Point(node) => Some(node),
            Place::Body(body) => Some(self.scene.names.body_node(body)),
            _ => None,
        }))
    }

    /// The columns of reactions at a node: the directions restrained by supports, at the node or at the support point of its name.
    fn reactions(&self, node: usize) -> Vec<Column> {
        let held = self.held.get(self.topology.label(node)).copied().unwrap_or_default();
        let columns = quantities::REACTION.into_iter().zip(held);
        columns.filter_map(|(column, is_held)| is_held.then_some(column)).collect()
    }

    /// The columns of reactions of a set: all directions with a support at one of its nodes.
    fn reactions_of(&self, set: usize) -> Vec<Column> {
        let nodes = self.scene.nodes_of(Place::Set(set));
        let held: Vec<Column> = nodes.into_iter().flat_map(|node| self.reactions(node)).collect();
        quantities::REACTION.into_iter().filter(|column| held.contains(column)).collect()
    }

    /// A surface; one with errors, which have been reported, has no parts.
    fn expect_stress(&mut self, at: PartIndex, name: &At<String>) -> Option<(ExpectAt, Vec<Column>)> {
        let Range { start, end } = self.scene.parts.entry(at)?.range;
        let first = self.scene.parts.of(at).first()?;
        if self.scene.parts.of(at).iter().all(|part| part.elements() == 0) {
            let message = format!("`{}` is rigid, so it has no stress and no plastic strain", name.value);
            return self.report.error_with(&name.span, message, RIGID_HINT);
        }
        let mut columns = quantities_of(at.kind);
        columns.retain(|column| first.yields() || *column != PLASTIC_STRAIN);
        Some((ExpectAt::Shells(start, end), columns))
    }

    /// A beam; one with errors, which have been reported, has no part.
    fn expect_forces(&mut self, at: PartIndex, name: &At<String>) -> Option<(ExpectAt, Vec<Column>)> {
        let part = self.scene.parts.entry(at)?.range.start;
        let beam = self.scene.parts.of(at).first()?;
        if beam.elements() == 0 {
            let message = format!("`{}` is rigid, so it has no section forces and no plastic strain", name.value);
            return self.report.error_with(&name.span, message, RIGID_HINT);
        }
        let mut columns = quantities_of(at.kind);
        columns.retain(|column| beam.yields() || *column != PLASTIC_STRAIN);
        let stresses = &self.scene.parts.stresses;
        let has = |section: usize| stresses.get(section).is_some_and(Option::is_some);
        let has_stresses = Beam::of(beam).is_some_and(|beam| beam.sections().all(has));
        columns.retain(|column| has_stresses || !SECTION_STRESSES.contains(column));
        Some((ExpectAt::Sections(part), columns))
    }

    /// A bar that yields; counted as [`ExpectAt::Elements`] counts.
    fn expect_strain(&mut self, at: PartIndex, name: &At<String>) -> Option<(ExpectAt, Vec<Column>)> {
        // A part with errors, which have been reported, would put the count off.
        let mut lines = self.scene.parts.entries().filter(|(part, _)| !part.kind.is_surface());
        if lines.any(|(_, entry)| entry.range.is_empty()) {
            return None;
        }
        let Range { start, end } = self.scene.parts.entry(at)?.range;
        let elements = |parts: &[Part]| parts.iter().map(|part| part.elements()).sum::<usize>();
        let (from, count) = (elements(&self.scene.parts.list[..start]), elements(&self.scene.parts.list[start..end]));
        if count == 0 {
            let message = format!("`{}` is rigid, so it has no axial force and no plastic strain", name.value);
            return self.report.error_with(&name.span, message, RIGID_HINT);
        }
        let mut columns = quantities_of(at.kind);
        columns.retain(|column| self.scene.parts.list[start].yields() || *column != PLASTIC_STRAIN);
        Some((ExpectAt::Elements(from, from + count), columns))
    }

    /// The name of the column for a word.
    fn column(&mut self, columns: &[Column], quantity: &At<String>, name: &At<String>) -> Option<&'static str> {
        if let Some(column) = columns.iter().find(|column| column.name == quantity.value) {
            return Some(column.name);
        }
        let known: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let message = format!("there is no quantity `{}` at `{}`", quantity.value, name.value);
        let diagnostic = Diagnostic::error(message).at(&quantity.span);
        self.report.push(match nearest(quantity, known.iter().copied()) {
            Some(near) if quantity.chars().count() > 2 => diagnostic.hint(format!("did you mean `{near}`?")),
            _ => {
                let there = if known.len() == 1 { "there is" } else { "there are" };
                diagnostic.hint("not a column").hint(format!("{there} {}", known.join(", ")))
            }
        });
        None
    }

    fn when(&mut self, owner: &Owner<'d>, expect: &'d words::Expect) -> Option<When> {
        if let Some(case) = &expect.case {
            return self.in_case(expect, case);
        }
        if let (Some(time), false) = (&expect.time, self.cases.list.is_empty()) {
            let hint = "name the load case or the combination by `case`";
            return self.report.error_with(&time.span, "`time` does not apply to load cases", hint);
        }
        if let Some(when) = &expect.when {
            for (key, place) in keys!(expect; time, peak) {
                if let Some(place) = place {
                    self.report.error::<()>(place, format!("an expected value has `{key}` or `when`, not both"));
                }
            }
            if !self.is_arc_length {
                let hint = match &self.scene.stage {
                    Some(_) if expect.stage.is_none() => "give `stage`: one of displacement or arc-length control",
                    _ => "give `time`, or `control = \"displacement\"`",
                };
                return self.report.error_with(
                    &when.span,
                    "`when` needs arc-length or displacement control: time steps do not end at given displacements",
                    hint,
                );
            }
            self.report.reject_unused("`when`", &keys!(when; required));
            return displacement_target("`when`", when, self.scene, self.topology, self.report).map(When::Target);
        }
        let given = expect.time.as_ref().map(|at| (at.value, &at.span));
        if let (Some(stage), Some((NumberOr::Number(time), _))) = (&expect.stage, given) {
            let hint = "`time = \"end\"` is the end of the stage, without `peak` that of a `value` too";
            let message = format!("an expected value has `time` or `stage`, and this one is at t = {time}");
            return self.report.error_with(&stage.span, message, hint);
        }
        let end = self.end_of_run();
        match (given, &expect.peak) {
            (None, None) if expect.stage.is_some() && expect.at_least.is_none() && expect.at_most.is_none() => {
                Some(When::End)
            }
            (Some(_), Some(peak)) => self.report.error(&peak.span, "an expected value has `time` or `peak`, not both"),
            (Some((NumberOr::Number(time), span)), None) if !(time >= 0.0 && time <= end) => {
                let message = format!("the run goes from 0 to {end}");
                self.report.error_with(span, "`time` lies outside the run", message)
            }
            (Some((NumberOr::Number(time), _)), None) => Some(When::Time(time)),
            (Some((NumberOr::Word(_), _)), None) => Some(When::End),
            (None, Some(peak)) => Some(match peak.value {
                words::Peak::Max => When::Max,
                words::Peak::Min => When::Min,
                words::Peak::Abs => When::Abs,
            }),
            (None, None) if expect.at_least.is_some() => Some(When::Min),
            (None, None) if expect.at_most.is_some() => Some(When::Max),
            (None, None) if ["time", "peak", "when"].iter().any(|key| self.report.is_spoiled(owner.span, key)) => None,
            (None, None) => self.report.error(owner.span, format!("{} needs `time` or `peak`", owner.what)),
        }
    }

    /// The latest time that the run may reach.
    fn end_of_run(&self) -> f64 {
        match self.scene.stage {
            Some(stage) if stage.sequence.is_shortened => f64::INFINITY,
            Some(stage) => stage.sequence.end(),
            None => self.scene.analysis.end_time,
        }
    }

    /// The case in which a value is expected.
    fn in_case(&mut self, expect: &'d words::Expect, case: &At<String>) -> Option<When> {
        self.report.reject_unused("a value in a load case", &keys!(expect; time, when, peak, stage));
        let known = || self.cases.list.iter().map(|case| case.name.as_str());
        let found = known().position(|name| name == case.value);
        let place = found.or_else(|| self.report.unknown("load case", case, known()));
        place.map(When::Case)
    }

    /// A value and how near to come to it, or a bound.
    fn judged(&mut self, owner: &Owner<'d>, expect: &'d words::Expect) -> Option<(f64, Tolerance)> {
        let (bound, tolerance) = match (&expect.at_least, &expect.at_most) {
            (Some(_), Some(most)) => {
                let hint = "write two `[[expect]]`";
                return self.report.error_with(
                    &most.span,
                    "an expected value has `at_least` or `at_most`, not both",
                    hint,
                );
            }
            (Some(least), None) => (least, Tolerance::AtLeast),
            (None, Some(most)) => (most, Tolerance::AtMost),
            (None, None) if ["at_least", "at_most"].iter().any(|key| self.report.is_spoiled(owner.span, key)) => {
                return None;
            }
            (None, None) => {
                let value = self.report.require(owner, "value", &expect.value);
                let tolerance = self.tolerance(owner, expect);
                return Some((value?.value, tolerance?));
            }
        };
        let keys = keys!(expect; value, tolerance, absolute_tolerance);
        self.report.reject_unused("a bound", &keys);
        Some((bound.value, tolerance))
    }

    fn tolerance(&mut self, owner: &Owner<'d>, expect: &'d words::Expect) -> Option<Tolerance> {
        match (&expect.tolerance, &expect.absolute_tolerance) {
            (Some(_), Some(absolute)) => {
                self.report.error(&absolute.span, "an expected value has `tolerance` or `absolute_tolerance`, not both")
            }
            (Some(relative), None) if expect.value.as_ref().is_some_and(|value| value.value == 0.0) => {
                let message = "`tolerance` is relative, and the expected value is zero";
                self.report.error_with(&relative.span, message, "give `absolute_tolerance` instead")
            }
            (Some(relative), None) => {
                if relative.value > 1.0 {
                    let [percent, part] = [100.0 * relative.value, 0.01 * relative.value].map(short);
                    let message = format!("`tolerance` is {percent} % of the expected value");
                    self.report.note(
                        &relative.span,
                        message,
                        format!("it is a part: {part} is {} %", short(relative.value)),
                    );
                }
                self.report.positive("tolerance", &expect.tolerance).map(Tolerance::Relative)
            }
            (None, Some(_)) => {
                self.report.positive("absolute_tolerance", &expect.absolute_tolerance).map(Tolerance::Absolute)
            }
            (None, None)
                if ["tolerance", "absolute_tolerance"].iter().any(|key| self.report.is_spoiled(owner.span, key)) =>
            {
                None
            }
            (None, None) => {
                self.report.error(owner.span, format!("{} needs `tolerance` or `absolute_tolerance`", owner.what))
            }
        }
    }
}
