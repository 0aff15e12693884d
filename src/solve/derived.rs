//! Derived quantities, computed for output only: energies, forces of links, joints and contacts, stress resultants,
//! strains. A step itself needs none of them.

use super::effort::Effort;
use crate::guards::breakage::Broken;
use crate::system::energy::{self, Energy, PartEnergy};
use crate::system::{
    ContactState, ContactTouch, Excitation, JointState, LinkState, Loading, SectionPoint, ShearBalance, ShellState,
    Side, System, results,
};
use base::snapshot::keep;
use mechanics::state::State;
use model::Model;
use std::ops::BitOr;

/// A set of derived quantities, those that the observer needs; others are not computed. The bits form three groups: quantities for steps
/// with tables, for every accepted step, and for steps with fields.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Wanted(u64);

/// Bits of one group.
const GROUP: u32 = 16;

impl Wanted {
    /// No quantity.
    pub const NOTHING: Wanted = Wanted(0);
    /// Energies and momenta.
    pub const ENERGY: Wanted = Wanted(1 << 1);
    /// Reactions of supports and joints.
    pub const REACTIONS: Wanted = Wanted(1 << 2);
    /// Elongations and forces of links.
    pub const LINKS: Wanted = Wanted(1 << 3);
    /// Gaps and forces of contacts.
    pub const CONTACTS: Wanted = Wanted(1 << 4);
    /// Stress resultants of beams.
    pub const SECTIONS: Wanted = Wanted(1 << 5);
    /// Elastic energies of parts.
    pub const PARTS: Wanted = Wanted(1 << 6);
    /// Accumulated plastic strains.
    pub const PLASTIC_STRAINS: Wanted = Wanted(1 << 7);
    /// Stress resultants of shells.
    pub const SHELLS: Wanted = Wanted(1 << 8);
    /// Modes about the state at the end of the run.
    pub const MODES: Wanted = Wanted(1 << 9);
    /// Stress resultants at the nodes of beams, for fields.
    pub const NODAL_RESULTANTS: Wanted = Wanted(1 << 10);
    /// Forces of each touch of contacts.
    pub const CONTACT_TOUCHES: Wanted = Wanted(1 << 11);
    /// Axial forces of bars.
    pub const BARS: Wanted = Wanted(1 << 12);
    /// All quantities.
    pub const ALL: Wanted = Wanted((1 << 13) - 1);

    /// True if all of `what` is wanted for steps with tables.
    pub const fn has(self, what: Wanted) -> bool {
        self.0 & what.0 == what.0
    }

    /// The set with `what` too.
    #[must_use]
    pub const fn with(self, what: Wanted) -> Wanted {
        Wanted(self.0 | what.0)
    }

    /// The set without `what`.
    #[must_use]
    pub const fn without(self, what: Wanted) -> Wanted {
        Wanted(self.0 & !(what.0 | what.0 << GROUP | what.0 << (2 * GROUP)))
    }

    /// The set, wanted of every accepted step, whether or not tables are due.
    #[must_use]
    pub const fn at_every_step(self) -> Wanted {
        Wanted(self.0 | self.0 << GROUP)
    }

    /// The set, wanted only where tables are due.
    #[must_use]
    pub const fn where_due(self) -> Wanted {
        Wanted(self.0 & ((1 << GROUP) - 1))
    }

    /// The set, wanted only where fields are drawn.
    #[must_use]
    pub const fn where_drawn(self) -> Wanted {
        Wanted(self.0 << (2 * GROUP))
    }

    /// True if all of `what` is wanted for a step, with tables if `due` and fields if `drawn`.
    pub const fn has_now(self, what: Wanted, due: bool, drawn: bool) -> bool {
        let always = self.has(Wanted(what.0 << GROUP));
        always || due && self.has(what) || drawn && self.has(what.where_drawn())
    }
}

impl BitOr for Wanted {
    type Output = Wanted;

    fn bitor(self, other: Wanted) -> Wanted {
        Wanted(self.0 | other.0)
    }
}

/// The derived quantities of one accepted step, each empty unless it is wanted of this step. The buffers are
/// kept from step to step, so that nothing is allocated once they have grown.
#[derive(Debug, Clone, Default)]
pub struct Derived {
    /// Energies and momenta.
    pub energy: Option<Energy>,
    /// States of links, in the order of [`Model::parts`].
    pub links: Vec<LinkState>,
    /// States of joints, in the order of the model.
    pub joints: Vec<JointState>,
    /// States of contacts, in the order of [`Model::parts`].
    pub contacts: Vec<ContactState>,
    /// Each touch of these, contact by contact.
    pub contact_touches: Vec<ContactTouch>,
    /// Largest accumulated plastic strain of each element of all beams, bars and shells in deck order.
    pub plastic_strains: Vec<f64>,
    /// True for each of these elements that has failed; empty if none can fail.
    pub failed: Vec<bool>,
    /// Elements and links that failed in the step.
    pub broken: Vec<Broken>,
    /// Stress resultants of all shell elements in deck order.
    pub shells: Vec<ShellState>,
    /// Room for their shear forces.
    pub shear_balance: ShearBalance,
    /// N, V_y, V_z, T, M_y, M_z at each node of each element of all beams in deck order, for fields alone.
    pub nodal_resultants: Vec<[f64; 6]>,
    /// Stress resultants of all beams in deck order.
    pub sections: Vec<SectionPoint>,
    /// Axial forces of all elements of bars in deck order.
    pub bars: Vec<f64>,
    /// Elastic energies of all beams, bars and shells in deck order.
    pub parts: Vec<PartEnergy>,
    /// The loads at the instant, for the resultants at the ends of beams.
    pub loading: Loading,
    /// The effort of all steps since the last tables, including this one.
    pub effort: Effort,
}

keep!(Derived { effort } without {
    energy, links, joints, contacts, contact_touches, plastic_strains, failed, broken, shells, shear_balance, nodal_resultants, sections, bars, parts, loading,
});

/// The request for the derived quantities of one accepted step.
pub struct Request<'a> {
    /// The model.
    pub model: &'a Model,
    /// The system of equations.
    pub system: &'a System,
    /// Loads as functions of time.
    pub excitation: &'a Excitation<'a>,
    /// The state at the end of the step.
    pub state: &'a State,
    /// The loads in this state, where they are not those of its time.
    pub loads: Option<&'a Loading>,
    /// True for the state at the beginning of a run or stage.
    pub begins: bool,
    /// True where tables are due.
    pub due: bool,
    /// True where fields are drawn.
    pub drawn: bool,
    /// Mechanical energy at t = 0, the reference of the balance; `None` if energies are not summed.
    pub balance: Option<f64>,
    /// Number of threads.
    pub threads: usize,
}

impl Derived {
    /// Empty quantities, with room for all contacts.
    pub fn new(model: &Model) -> Self {
        let contacts = model.parts.iter().filter(|part| part.kind().is_unilateral()).count();
        Derived {
            contacts: Vec::with_capacity(contacts),
            // A box lies on four corners, or is among others.
            contact_touches: Vec::with_capacity(8 * contacts),
            ..Derived::default()
        }
    }

    /// Computes the quantities wanted for this step and clears the others.
    pub fn compute(&mut self, wanted: Wanted, request: &Request) {
        self.clear();
        let &Request { model, system, excitation, state, loads, begins, due, drawn, balance, threads } = request;
        let now = &state.configuration();
        let is_wanted = |what| wanted.has_now(what, due, drawn);
        if is_wanted(Wanted::PLASTIC_STRAINS) {
            results::plastic_strains(system, now, &mut self.plastic_strains);
            results::failed(system, now, &mut self.failed);
        }
        if is_wanted(Wanted::SHELLS) {
            results::shell_states(system, model, (now, threads), &mut self.shear_balance, &mut self.shells);
        }
        if drawn && is_wanted(Wanted::NODAL_RESULTANTS) {
            results::nodal_resultants(system, model, now, &mut self.nodal_resultants);
        }
        if is_wanted(Wanted::ENERGY) {
            self.energy = Some(Energy::of(system, state, balance, threads));
        }
        if is_wanted(Wanted::REACTIONS) {
            system.joint_states(&state.nodes, &state.multipliers, &mut self.joints);
        }
        if is_wanted(Wanted::LINKS) {
            results::link_states(system, now, &mut self.links);
        }
        if is_wanted(Wanted::CONTACTS) {
            system.contact_states(model, now, &mut self.contacts);
        }
        if is_wanted(Wanted::CONTACT_TOUCHES) {
            system.contact_touches(model, now, &mut self.contact_touches);
        }
        if is_wanted(Wanted::SECTIONS) {
            match loads {
                Some(loads) => self.loading.clone_from(loads),
                // Loads that begin with a run or stage act from its beginning; jumps at the end of a step act after it.
                None => {
                    let side = if begins { Side::After } else { Side::Before };
                    excitation.loading(state.time, side, &mut self.loading);
                }
            }
            results::section_points(system, model, (now, &self.loading), &mut self.sections);
        }
        if is_wanted(Wanted::BARS) {
            results::axial_forces(system, now, &mut self.bars);
        }
        if is_wanted(Wanted::PARTS) {
            energy::part_energies(system, model, now, &mut self.parts);
        }
    }

    /// Takes over the quantities of others, effort and loads aside.
    pub fn take_from(&mut self, other: &Derived) {
        self.energy = other.energy;
        self.links.clone_from(&other.links);
        self.joints.clone_from(&other.joints);
        self.contacts.clone_from(&other.contacts);
        self.contact_touches.clone_from(&other.contact_touches);
        self.plastic_strains.clone_from(&other.plastic_strains);
        self.failed.clone_from(&other.failed);
        self.broken.clear();
        self.shells.clone_from(&other.shells);
        self.nodal_resultants.clone_from(&other.nodal_resultants);
        self.sections.clone_from(&other.sections);
        self.bars.clone_from(&other.bars);
        self.parts.clone_from(&other.parts);
    }

    fn clear(&mut self) {
        self.energy = None;
        self.links.clear();
        self.joints.clear();
        self.contacts.clear();
        self.contact_touches.clear();
        self.plastic_strains.clear();
        self.failed.clear();
        self.broken.clear();
        self.shells.clear();
        self.nodal_resultants.clear();
        self.sections.clear();
        self.bars.clear();
        self.parts.clear();
    }
}
