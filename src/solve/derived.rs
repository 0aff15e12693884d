//! Quantities that are computed only to be shown: energies, forces of links, joints and contacts, stress resultants, strains.
//! A step itself needs none of them.

use crate::model::{Model, PartKind};
use crate::state::State;
use crate::system::energy::{Energy, PartEnergy};
use crate::system::results::{LinkState, SectionPoint, ShellState};
use crate::system::{ContactState, JointState, System};
use std::ops::BitOr;

/// A set of derived quantities: those that the observer needs. What is not wanted is not computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Wanted(u16);

impl Wanted {
    pub const NOTHING: Wanted = Wanted(0);
    /// Something is written of every step.
    pub const EVERY_STEP: Wanted = Wanted(1);
    pub const ENERGY: Wanted = Wanted(1 << 1);
    /// Those of supports and of joints.
    pub const REACTIONS: Wanted = Wanted(1 << 2);
    pub const LINKS: Wanted = Wanted(1 << 3);
    pub const CONTACTS: Wanted = Wanted(1 << 4);
    pub const SECTIONS: Wanted = Wanted(1 << 5);
    pub const PARTS: Wanted = Wanted(1 << 6);
    pub const PLASTIC_STRAINS: Wanted = Wanted(1 << 7);
    pub const SHELLS: Wanted = Wanted(1 << 8);
    pub const ALL: Wanted = Wanted((1 << 9) - 1);

    /// Whether all of `what` is in the set.
    pub const fn has(self, what: Wanted) -> bool {
        self.0 & what.0 == what.0
    }

    #[must_use]
    pub const fn without(self, what: Wanted) -> Wanted {
        Wanted(self.0 & !what.0)
    }
}

impl BitOr for Wanted {
    type Output = Wanted;

    fn bitor(self, other: Wanted) -> Wanted {
        Wanted(self.0 | other.0)
    }
}

/// The derived quantities of one accepted step, each empty unless it is wanted and the step is due. The buffers are kept from
/// step to step, so that nothing is allocated once they have grown.
#[derive(Debug, Clone, Default)]
pub struct Derived {
    pub energy: Option<Energy>,
    /// In the order of the links in [`Model::parts`].
    pub links: Vec<LinkState>,
    /// In the order of [`Model::joints`].
    pub joints: Vec<JointState>,
    /// In the order of the contacts in [`Model::parts`].
    pub contacts: Vec<ContactState>,
    /// Largest accumulated plastic strain of each element of all beams, then of all bars and shells, in deck order. Computed for
    /// fields too, when the tables are not due.
    pub plastic_strains: Vec<f64>,
    /// Of all elements of all shells in deck order. Computed for fields too, when the tables are not due.
    pub shells: Vec<ShellState>,
    /// Of all integration points of all beams in deck order.
    pub sections: Vec<SectionPoint>,
    /// Of all beams, bars and shells in deck order.
    pub parts: Vec<PartEnergy>,
}

/// What one accepted step is asked for.
pub struct Request<'a> {
    pub model: &'a Model,
    pub system: &'a System,
    pub state: &'a State,
    /// The tables are due.
    pub due: bool,
    /// The fields are drawn.
    pub drawn: bool,
    /// Total energy at t = 0, against which the balance is drawn up; `None` where no energy is summed.
    pub balance: Option<f64>,
    pub threads: usize,
}

impl Derived {
    pub fn new(model: &Model) -> Self {
        Derived { contacts: Vec::with_capacity(model.count(PartKind::Contact)), ..Derived::default() }
    }

    /// Computes what is wanted of this step and empties the rest.
    pub fn compute(&mut self, wanted: Wanted, request: &Request) {
        self.clear();
        let &Request { model, system, state, due, drawn, balance, threads } = request;
        let now = &state.configuration();
        let is_wanted = |what| due && wanted.has(what);
        let is_drawn = |what| (due || drawn) && wanted.has(what);
        if is_drawn(Wanted::PLASTIC_STRAINS) {
            system.plastic_strains(now, &mut self.plastic_strains);
        }
        if is_drawn(Wanted::SHELLS) {
            system.shell_states(model, now, &mut self.shells);
        }
        if is_wanted(Wanted::ENERGY) {
            self.energy = Some(system.energy(state, balance, threads));
        }
        if is_wanted(Wanted::REACTIONS) {
            system.joint_states(&state.nodes, &state.multipliers, &mut self.joints);
        }
        if is_wanted(Wanted::LINKS) {
            system.link_states(&state.nodes, &mut self.links);
        }
        if is_wanted(Wanted::CONTACTS) {
            system.contact_states(model, now, &mut self.contacts);
        }
        if is_wanted(Wanted::SECTIONS) {
            system.section_points(model, now, &mut self.sections);
        }
        if is_wanted(Wanted::PARTS) {
            system.part_energies(model, now, &mut self.parts);
        }
    }

    fn clear(&mut self) {
        self.energy = None;
        self.links.clear();
        self.joints.clear();
        self.contacts.clear();
        self.plastic_strains.clear();
        self.shells.clear();
        self.sections.clear();
        self.parts.clear();
    }
}
