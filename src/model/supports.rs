//! `[[supports]]`: directions whose motion is given.

use super::build::{Builder, Owner, chosen};
use super::places::{Reach, Spot};
use super::{AnalysisKind, DIRECTIONS, Held, History, Motion};
use crate::deck::supports as deck;
use crate::deck::words::Table;
use crate::diagnostic::{At, Span};

impl<'d> Builder<'d> {
    pub fn supports(&mut self) {
        for support in &self.deck.supports {
            let owner = Owner { what: "`[[supports]]`".to_owned(), span: &support.span };
            let spots = self.spots(&owner, "at", &support.at, Reach::Nodes);
            let mut motions = support.motion.as_ref().map_or_else(Vec::new, |motions| self.motions(motions));
            let fixed = support.fix.as_ref().map_or([false; 6], |fix| fix.0);
            let unread = self.is_spoiled(owner.span, "fix") || self.is_spoiled(owner.span, "motion");
            if fixed == [false; 6] && motions.is_empty() && support.motion.is_none() && !unread {
                let place = support.fix.as_ref().map_or(owner.span, |fix| &fix.span);
                self.error_with::<()>(place, "this support holds nothing", "give it `fix` or `motion`");
            }
            for (dof, _, place) in motions.extract_if(.., |(dof, ..)| fixed[*dof]) {
                self.error::<()>(place, format!("{} is both fixed and moved by this support", DIRECTIONS[dof]));
            }
            for spot in &spots {
                if self.is_loose(spot, "this support") {
                    continue;
                }
                let rides: [bool; 6] = std::array::from_fn(|dof| self.master(spot.node, dof).is_some());
                let fixes = (0..6).filter(|&dof| fixed[dof]).map(|dof| (dof, None, spot.span));
                let moves = motions.iter().map(|(dof, motion, place)| (*dof, Some(motion.clone()), *place));
                let riding: Vec<_> = fixes.chain(moves).filter(|(dof, ..)| rides[*dof]).collect();
                if !riding.is_empty() {
                    self.hold_rider(spot, &riding);
                }
                for dof in (0..6).filter(|&dof| fixed[dof] && !rides[dof]) {
                    self.hold(spot, dof, None, spot.span);
                }
                for (dof, motion, place) in motions.iter().filter(|(dof, ..)| !rides[*dof]) {
                    if self.is_taken(spot.node, *dof) {
                        self.hold(spot, *dof, Some(motion.clone()), place);
                    } else if self.sure {
                        let message = format!("nothing connected to `{}` moves in {}", spot.name, DIRECTIONS[*dof]);
                        self.error::<()>(place, message);
                    }
                }
            }
        }
        self.model.held = self.held.values().map(|(held, _)| held.clone()).collect();
    }

    fn motions(&mut self, motions: &'d At<Table<deck::Motions>>) -> Vec<(usize, Motion, &'d Span)> {
        let given = [&motions.ux, &motions.uy, &motions.uz, &motions.rx, &motions.ry, &motions.rz];
        if given.iter().all(|motion| motion.is_none()) {
            self.error_with::<()>(&motions.span, "`motion` is empty", "such as { ux = { amplitude = \"quake\" } }");
        }
        let mut read = Vec::new();
        for (dof, motion) in given.into_iter().enumerate() {
            let Some(motion) = motion else { continue };
            let owner = Owner { what: format!("the motion in {}", DIRECTIONS[dof]), span: &motion.span };
            let amplitude = self.need(&owner, "amplitude", &motion.amplitude).and_then(|name| self.amplitude(name));
            let history: History = chosen(&motion.history);
            if let Some(at) = &motion.history
                && self.model.analysis.kind == AnalysisKind::Static
                && history != History::Displacement
            {
                self.error::<()>(&at.span, "a static analysis knows displacements only");
            }
            let scale = motion.scale.as_ref().map_or(1.0, |scale| scale.value);
            let Some(amplitude) = amplitude else { continue };
            read.push((dof, Motion { amplitude, scale, history }, &motion.span));
        }
        read
    }

    /// Two supports may fix the same direction; if one of them moves it, they contradict each other.
    fn hold(&mut self, spot: &Spot, dof: usize, motion: Option<Motion>, place: &Span) {
        let node = spot.node;
        match self.held.get(&(node, dof)) {
            Some((held, _)) if held.motion.is_some() || motion.is_some() => {
                let message = format!("two supports give the motion of `{}` in {}", spot.name, DIRECTIONS[dof]);
                self.error::<()>(place, message);
            }
            Some(_) => {}
            None => {
                self.held.insert((node, dof), (Held { node, dof, motion }, place.clone()));
            }
        }
    }
}
