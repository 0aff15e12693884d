//! `[[expect]]` and `[output]`.

use super::build::{Builder, Owner, span};
use super::places::{Place, Reach};
use super::{Cadence, DIRECTIONS, Expect, ExpectAt, Output, Part, Tolerance, When};
use crate::deck::expect as deck;
use crate::diagnostic::{At, Diagnostic};
use crate::names::nearest;
use std::ops::Range;

/// Columns of nodes.csv, apart from displacements and rotations.
const MOTION: [&str; 15] = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "ax", "ay", "az", "bx", "by", "bz"];
const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];
const JOINT: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];
const LINK: [&str; 2] = ["force", "elongation"];
/// Of a contact: points that touch, the least gap, force and moment on the surface, and the size of the force.
pub const CONTACT: [&str; 9] = ["touching", "gap", "fx", "fy", "fz", "mx", "my", "mz", "force"];
/// The energy balance and the momenta.
pub const ENERGY: [&str; 18] = [
    "kinetic",
    "strain",
    "plastic",
    "viscous",
    "damping",
    "links",
    "external",
    "numerical",
    "total",
    "px",
    "py",
    "pz",
    "lx",
    "ly",
    "lz",
    "contact",
    "friction",
    "impact",
];

/// More output times are a slip of the keyboard, and would only exhaust memory.
const MOST_ROWS: f64 = 1e7;

impl<'d> Builder<'d> {
    pub fn expects(&mut self) {
        for expect in &self.deck.expect {
            let owner = Owner { what: "`[[expect]]`".to_owned(), span: &expect.span };
            if let Some(read) = self.expect(&owner, expect) {
                self.model.expects.push(read);
            }
        }
    }

    fn expect(&mut self, owner: &Owner<'d>, expect: &'d deck::Expect) -> Option<Expect> {
        let name = self.need(owner, "at", &expect.at);
        let at = name.and_then(|name| self.expect_at(name));
        let quantity = self.need(owner, "quantity", &expect.quantity);
        if let (Some((at, columns)), Some(quantity), Some(name)) = (&at, quantity, name) {
            let strain = quantity.value == "plastic_strain" && !columns.contains(&"plastic_strain");
            if strain && matches!(at, ExpectAt::Shells(..)) {
                let message = format!("the material of `{}` is elastic, so it has no plastic strain", name.value);
                return self.error(&quantity.span, message);
            }
            self.column(columns, quantity, name);
        }
        let when = self.when(owner, expect);
        let judged = self.judged(owner, expect);
        let ((at, _), quantity, when, (value, tolerance)) = (at?, quantity?, when?, judged?);
        let moment = match when {
            When::Time(time) => format!("at t = {time}"),
            When::Passing(at) => {
                let (node, direction) = (&self.model.nodes[at.node].label, DIRECTIONS[at.dof]);
                let pass = if at.pass == 1 { String::new() } else { format!(", pass {}", at.pass) };
                format!("where {direction} of {node} is {}{pass}", at.value)
            }
            When::Max => "at its maximum".to_owned(),
            When::Min => "at its minimum".to_owned(),
            When::Abs => "at its greatest absolute value".to_owned(),
        };
        Some(Expect {
            at,
            quantity: quantity.value.clone(),
            when,
            value,
            tolerance,
            source: expect.source.as_ref().map(|source| source.value.clone()).unwrap_or_default(),
            label: format!("{} of {} {moment}", quantity.value, name?.value),
        })
    }

    /// Where, and the columns there are.
    fn expect_at(&mut self, name: &At<String>) -> Option<(ExpectAt, Vec<&'static str>)> {
        if name.value == "energy" {
            return Some((ExpectAt::Energy, ENERGY.to_vec()));
        }
        if name.value == "analysis" && !self.places.contains_key("analysis") {
            return Some((ExpectAt::Analysis, vec!["time"]));
        }
        match self.place_or_node(name) {
            Some(Place::Point(node)) => Some((ExpectAt::Node(node), [&MOTION[..], &DIRECTIONS].concat())),
            Some(Place::Body(body)) => {
                let columns = [&MOTION[..], &DIRECTIONS, &QUATERNION].concat();
                Some((ExpectAt::Node(self.model.bodies[body].node), columns))
            }
            Some(Place::Link(link)) => Some((ExpectAt::Link(link), LINK.to_vec())),
            Some(Place::Joint(joint)) => Some((ExpectAt::Joint(joint), JOINT.to_vec())),
            Some(Place::Contact(contact)) => Some((ExpectAt::Contact(contact), CONTACT.to_vec())),
            Some(place @ (Place::Beam(_) | Place::Bar(_))) => self.expect_strain(place, name),
            // Where a shell has errors, these have been said.
            Some(Place::Shell(shell)) if !self.shell_parts[shell].is_empty() => {
                let Range { start, end } = self.shell_parts[shell];
                if self.model.parts[start..end].iter().all(|part| part.elements() == 0) {
                    let message = format!("`{}` is rigid, so it has no stress and no plastic strain", name.value);
                    return self.error(&name.span, message);
                }
                let yields = self.model.parts[start].yields();
                let columns = if yields { vec!["von_mises", "plastic_strain"] } else { vec!["von_mises"] };
                Some((ExpectAt::Shells(start, end), columns))
            }
            Some(Place::Shell(_)) => None,
            Some(place) => {
                let message = format!("`{}` is {}", name.value, place.kind());
                self.error_with(
                    &name.span,
                    message,
                    "values are at points, bodies, parts, links, joints, contacts or \"energy\"",
                )
            }
            None => {
                let mut known: Vec<&str> = self.places.keys().copied().chain(["energy"]).collect();
                known.sort_unstable();
                self.unknown("point, body, part or link", name, known.into_iter())
            }
        }
    }

    /// A part that yields; counted as [`ExpectAt::Elements`] counts.
    fn expect_strain(&mut self, place: Place, name: &At<String>) -> Option<(ExpectAt, Vec<&'static str>)> {
        // Where a part has errors, these have been said, and the count is off.
        if [&self.beam_parts, &self.bar_parts].iter().any(|p| p.iter().any(Range::is_empty)) {
            return None;
        }
        let Range { start, end } = match place {
            Place::Bar(bar) => self.bar_parts[bar].clone(),
            Place::Beam(beam) => self.beam_parts[beam].clone(),
            _ => return None,
        };
        let elements = |parts: &[Part]| parts.iter().map(Part::elements).sum::<usize>();
        let (from, count) = (elements(&self.model.parts[..start]), elements(&self.model.parts[start..end]));
        if count == 0 {
            return self.error(&name.span, format!("`{}` is rigid, so it has no plastic strain", name.value));
        }
        if !self.model.parts[start].yields() {
            let message = format!("the material of `{}` is elastic, so it has no plastic strain", name.value);
            return self.error(&name.span, message);
        }
        Some((ExpectAt::Elements(from, from + count), vec!["plastic_strain"]))
    }

    fn column(&mut self, columns: &[&str], quantity: &At<String>, name: &At<String>) {
        if columns.contains(&quantity.as_str()) {
            return;
        }
        let message = format!("there is no quantity `{}` at `{}`", quantity.value, name.value);
        let diagnostic = Diagnostic::error(message).at(&quantity.span);
        self.problems.push(match nearest(quantity, columns.iter().copied()) {
            Some(near) if quantity.chars().count() > 2 => diagnostic.hint(format!("did you mean `{near}`?")),
            _ => {
                let there = if columns.len() == 1 { "there is" } else { "there are" };
                diagnostic.hint("not a column").hint(format!("{there} {}", columns.join(", ")))
            }
        });
    }

    fn when(&mut self, owner: &Owner<'d>, expect: &'d deck::Expect) -> Option<When> {
        if let Some(when) = &expect.when {
            for (key, place) in [("time", span(&expect.time)), ("peak", span(&expect.peak))] {
                if let Some(place) = place {
                    self.error::<()>(place, format!("an expected value has `{key}` or `when`, not both"));
                }
            }
            if !self.is_arc_length() {
                let hint = "`control = \"arc-length\"` of `[analysis]` does";
                return self.error_with(&when.span, "steps of given times do not land on displacements", hint);
            }
            return self.passage("`when`", when).map(When::Passing);
        }
        match (&expect.time, &expect.peak) {
            (Some(_), Some(peak)) => self.error(&peak.span, "an expected value has `time` or `peak`, not both"),
            (Some(time), None) if !(time.value >= 0.0 && time.value <= self.model.analysis.end_time) => {
                let message = format!("the run goes from 0 to {}", self.model.analysis.end_time);
                self.error_with(&time.span, "`time` lies outside the run", message)
            }
            (Some(time), None) => Some(When::Time(time.value)),
            (None, Some(peak)) => Some(match peak.value {
                deck::Peak::Max => When::Max,
                deck::Peak::Min => When::Min,
                deck::Peak::Abs => When::Abs,
            }),
            (None, None) if expect.at_least.is_some() => Some(When::Min),
            (None, None) if expect.at_most.is_some() => Some(When::Max),
            (None, None) if ["time", "peak", "when"].iter().any(|key| self.is_spoiled(owner.span, key)) => None,
            (None, None) => self.error(owner.span, format!("{} needs `time` or `peak`", owner.what)),
        }
    }

    /// A value and how near to come to it, or a bound.
    fn judged(&mut self, owner: &Owner<'d>, expect: &'d deck::Expect) -> Option<(f64, Tolerance)> {
        let (bound, tolerance) = match (&expect.at_least, &expect.at_most) {
            (Some(_), Some(most)) => {
                let hint = "write two `[[expect]]`";
                return self.error_with(&most.span, "an expected value has `at_least` or `at_most`, not both", hint);
            }
            (Some(least), None) => (least, Tolerance::AtLeast),
            (None, Some(most)) => (most, Tolerance::AtMost),
            (None, None) if ["at_least", "at_most"].iter().any(|key| self.is_spoiled(owner.span, key)) => return None,
            (None, None) => {
                let value = self.need(owner, "value", &expect.value);
                let tolerance = self.tolerance(owner, expect);
                return Some((value?.value, tolerance?));
            }
        };
        let keys = [
            ("value", span(&expect.value)),
            ("tolerance", span(&expect.tolerance)),
            ("absolute_tolerance", span(&expect.absolute_tolerance)),
        ];
        self.stray("a bound", &keys);
        Some((bound.value, tolerance))
    }

    fn tolerance(&mut self, owner: &Owner<'d>, expect: &'d deck::Expect) -> Option<Tolerance> {
        match (&expect.tolerance, &expect.absolute_tolerance) {
            (Some(_), Some(absolute)) => {
                self.error(&absolute.span, "an expected value has `tolerance` or `absolute_tolerance`, not both")
            }
            (Some(relative), None) if expect.value.as_ref().is_some_and(|value| value.value == 0.0) => {
                let message = "`tolerance` is relative, and the expected value is zero";
                self.error_with(&relative.span, message, "give `absolute_tolerance` instead")
            }
            (Some(_), None) => self.positive("tolerance", &expect.tolerance).map(Tolerance::Relative),
            (None, Some(_)) => self.positive("absolute_tolerance", &expect.absolute_tolerance).map(Tolerance::Absolute),
            (None, None) if ["tolerance", "absolute_tolerance"].iter().any(|key| self.is_spoiled(owner.span, key)) => {
                None
            }
            (None, None) => self.error(owner.span, format!("{} needs `tolerance` or `absolute_tolerance`", owner.what)),
        }
    }

    pub fn output(&mut self) {
        let is_body: Vec<usize> = self.model.bodies.iter().map(|body| body.node).collect();
        let nodes = self.model.nodes.iter().enumerate();
        let named = nodes.filter(|(i, node)| node.named && is_body.binary_search(i).is_err()).map(|(i, _)| i).collect();
        let Some(output) = &self.deck.output else {
            self.model.output.nodes = named;
            return;
        };
        let owner = Owner { what: "`[output]`".to_owned(), span: &output.span };
        let word = output.nodes.as_ref().filter(|nodes| nodes.single).map(|nodes| nodes.values[0].as_str());
        let nodes = match word {
            Some("named") => named,
            Some("all") => {
                self.writes_all = true;
                Vec::new()
            }
            _ if output.nodes.is_none() => named,
            _ => {
                let spots = self.spots(&owner, "nodes", &output.nodes, Reach::Nodes);
                for spot in spots.iter().filter(|spot| spot.direct && is_body.binary_search(&spot.node).is_ok()) {
                    let message = format!("`{}` is a body, and not written with the nodes", spot.name);
                    self.error_with::<()>(spot.span, message, "bodies always go to bodies.csv");
                }
                let mut nodes: Vec<usize> = spots.iter().map(|spot| spot.node).collect();
                nodes.retain(|node| is_body.binary_search(node).is_err());
                nodes.sort_unstable();
                nodes
            }
        };
        let cadence = match (&output.every, &output.interval) {
            (Some(_), Some(interval)) => {
                self.error::<()>(&interval.span, "`[output]` takes `every` or `interval`, not both");
                Cadence::Steps(1)
            }
            (None, Some(at)) => {
                let interval = self.positive("interval", &output.interval);
                let end = self.model.analysis.end_time;
                // Where the end time is missing, that has been said.
                if let Some(interval) = interval
                    && end < f64::MAX
                    && end / interval > MOST_ROWS
                {
                    let message = format!("`interval` asks for {:.1e} rows", end / interval);
                    self.error_with::<()>(&at.span, message, format!("at most {MOST_ROWS:.0e} are taken to be meant"));
                }
                interval.map_or(Cadence::Steps(1), Cadence::Interval)
            }
            _ => Cadence::Steps(self.count("every", &output.every, 1)),
        };
        self.model.output.cadence = cadence;
        if let Some(at) = &output.interval {
            self.check_cadence(&at.span);
        }
        let fields = output.fields.as_ref().map(|fields| {
            let owner = Owner { what: "`fields`".to_owned(), span: &fields.span };
            self.need(&owner, "format", &fields.format);
            self.count("every", &fields.every, 1)
        });
        let flag = |flag: &crate::deck::words::Maybe<bool>, default| flag.as_ref().map_or(default, |at| at.value);
        self.model.output = Output {
            nodes,
            cadence,
            energy: flag(&output.energy, true),
            links: flag(&output.links, false),
            contacts: flag(&output.contacts, false),
            reactions: flag(&output.reactions, false),
            sections: flag(&output.sections, false),
            layers: flag(&output.layers, false),
            parts: flag(&output.parts, false),
            fields,
        };
    }
}
