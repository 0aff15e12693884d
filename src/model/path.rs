//! What leads a static analysis on: `control` of `[analysis]` and the words that go with it.

use super::build::{Builder, Owner, span};
use super::places::Place;
use super::{AnalysisKind, ArcLength, Cadence, Held, History, Method, Passage, StepLength, Update};
use crate::deck::analysis as deck;
use crate::deck::words::Table;
use crate::diagnostic::{At, Span};
use crate::names::short;

impl<'d> Builder<'d> {
    /// After the supports: a displacement to stop at must be free.
    pub fn control(&mut self) {
        let Some(analysis) = &self.deck.analysis else { return };
        if self.is_spoiled(&analysis.span, "control") {
            // Whatever it was to be, it is not held against the words that go with it.
            self.set_arc_length(None, None, 1.0);
            return;
        }
        let Some(at) = analysis.control.as_ref().filter(|at| at.value == deck::Control::ArcLength) else {
            let keys = [("stop", span(&analysis.stop)), ("steps", span(&analysis.steps))];
            return self.stray("`control = \"time\"`", &[&keys[..], &[("growth", span(&analysis.growth))]].concat());
        };
        if self.model.analysis.kind != AnalysisKind::Static {
            self.error::<()>(&at.span, "`arc-length` leads a static analysis, and this one is dynamic");
            return;
        }
        self.check_iteration();
        self.check_history();
        let stop = analysis.stop.as_ref().and_then(|stop| self.passage("`stop`", stop));
        let steps = analysis.steps.as_ref().map(|_| self.count("steps", &analysis.steps, 1));
        let growth = self.positive("growth", &analysis.growth).unwrap_or(f64::INFINITY);
        if let Some(at) = analysis.growth.as_ref().filter(|at| at.value > 0.0 && at.value < 1.0) {
            self.error::<()>(&at.span, "`growth` must be at least 1: `time_step` sets the first step");
        }
        self.set_arc_length(stop, steps, growth);
    }

    /// The step of the deck becomes the first of the path.
    fn set_arc_length(&mut self, stop: Option<Passage>, steps: Option<usize>, growth: f64) {
        let first = self.model.analysis.nominal_step();
        self.model.analysis.step_length = StepLength::ArcLength(ArcLength { first, stop, steps, growth });
    }

    /// Only the derivative at hand tells where the path goes.
    fn check_iteration(&mut self) {
        let Some(iteration) = &self.deck.iteration else { return };
        let reason = "arc-length takes the derivative at every iteration";
        if let Some(at) = iteration.method.as_ref().filter(|at| at.value == Method::InitialLoad) {
            self.error_with::<()>(&at.span, "`initial-load` cannot follow a path by arc length", reason);
        }
        let kept = |at: &&At<Update>| matches!(at.value, Update::Step | Update::Never);
        if let Some(at) = iteration.update.as_ref().filter(kept) {
            self.error_with::<()>(&at.span, "`update` must be \"auto\" or \"iteration\" with arc-length", reason);
        }
        (self.model.iteration.method, self.model.iteration.update) = (Method::TangentStiffness, Update::Iteration);
    }

    /// A path goes on where loads and materials do; neither jumps nor rates of a time that may fall belong to it.
    fn check_history(&mut self) {
        for contact in &self.deck.contacts {
            if contact.stiffness.as_ref().is_none_or(|at| at.value != 0.0) {
                self.error::<()>(
                    &contact.span,
                    "arc-length does not follow contacts: where they close the path has a kink",
                );
            }
        }
        for (name, material) in &self.deck.materials.0 {
            if let Some(at) = &material.viscosity {
                let message = format!("material `{}` is viscous, and with arc-length time is only a load", name.value);
                self.error::<()>(&at.span, message);
            }
        }
        for (index, (name, amplitude)) in self.deck.amplitudes.0.iter().enumerate() {
            let jumps = self.model.amplitudes.get(index).is_some_and(|amplitude| !amplitude.jumps().is_empty());
            if jumps && self.used.contains(&("amplitude", index)) {
                let message = format!("amplitude `{}` jumps, and no path leads across by arc length", name.value);
                self.error_with::<()>(&amplitude.span, message, "let it rise over a while");
            }
            // A velocity that turns leaves a motion that may not.
            let moves = |held: &Held| {
                let motion = held.motion.as_ref().filter(|motion| motion.amplitude == index);
                motion.is_some_and(|motion| motion.history != History::Displacement)
            };
            let turn = self.model.amplitudes.get(index).and_then(|read| read.turn(self.model.analysis.end_time));
            if let Some(time) = turn
                && self.used.contains(&("amplitude", index))
                && !self.model.held.iter().any(moves)
            {
                let message = format!("amplitude `{}` turns at t = {}", name.value, short(time));
                let hint = "with arc-length a load that turns leads back along its path: let it only rise or only fall";
                self.error_with::<()>(&amplitude.span, message, hint);
            }
        }
    }

    /// With arc-length times come as they come.
    pub fn check_cadence(&mut self, interval: &Span) {
        if self.is_arc_length() && matches!(self.model.output.cadence, Cadence::Interval(_)) {
            let hint = "give `every`, in steps";
            self.error_with::<()>(interval, "with arc-length steps do not land on multiples of a time", hint);
        }
    }

    pub fn is_arc_length(&self) -> bool {
        self.model.analysis.step_length.is_arc_length()
    }

    /// A displacement that some step is to land on; it must be one of the unknowns.
    pub fn passage(&mut self, what: &str, passage: &'d At<Table<deck::Passage>>) -> Option<Passage> {
        let owner = Owner { what: what.to_owned(), span: &passage.span };
        let words: &'d deck::Passage = &passage.value;
        let name = self.need(&owner, "at", &words.at);
        let quantity = self.need(&owner, "quantity", &words.quantity);
        let value = self.need(&owner, "value", &words.value);
        let pass = self.count("pass", &words.pass, 1);
        let name = name?;
        let node = match self.place_or_node(name) {
            Some(Place::Point(node)) => node,
            Some(Place::Body(body)) => self.model.bodies.get(body)?.node,
            Some(place) => {
                let message = format!("{what} wants a point or body, and `{}` is {}", name.value, place.kind());
                return self.error(&name.span, message);
            }
            None => {
                let mut known: Vec<&str> = self.places.keys().copied().collect();
                known.sort_unstable();
                return self.unknown("point or body", name, known.into_iter());
            }
        };
        let (quantity, value) = (quantity?, value?);
        let (dof, word) = match quantity.value {
            deck::Displacement::Ux => (0, "ux"),
            deck::Displacement::Uy => (1, "uy"),
            deck::Displacement::Uz => (2, "uz"),
        };
        if let Some(master) = self.master(node, dof) {
            let master = &self.model.nodes[master].label;
            let message = format!("`{}` moves with `{master}`", name.value);
            return self.error_with(&name.span, message, format!("{what} wants one that moves by itself"));
        }
        if self.held.contains_key(&(node, dof)) {
            return self.error(&quantity.span, format!("a support gives {word} of `{}`", name.value));
        }
        if self.sure && !self.is_taken(node, dof) {
            let message = format!("nothing acts on `{}` in direction {word}", name.value);
            return self.error_with(&quantity.span, message, format!("{what} wants a displacement that is an unknown"));
        }
        if value.value == 0.0 {
            return self.error_with(&value.span, format!("{word} begins at zero"), "a passage lies off the start");
        }
        let place = [quantity.span.start, quantity.span.end];
        Some(Passage { node, dof, value: value.value, pass, place })
    }
}
