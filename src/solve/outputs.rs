//! Quantities that are computed only to be shown: energies, forces of links, joints and contacts, stress resultants, strains.
//! A step itself needs none of them.

use crate::model::{Model, PartKind};
use crate::state::State;
use crate::system::energy::{Energy, PartEnergy};
use crate::system::results::{LinkState, SectionPoint, ShellState};
use crate::system::{ContactState, JointState, System};

/// Which of the derived quantities the observer needs; what is not wanted is not computed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Wanted {
    /// Something is written of every step.
    pub steps: bool,
    pub energy: bool,
    pub reactions: bool,
    pub links: bool,
    pub contacts: bool,
    pub sections: bool,
    pub parts: bool,
    pub plastic_strains: bool,
    pub shells: bool,
}

impl Wanted {
    pub const ALL: Wanted = Wanted {
        steps: true,
        energy: true,
        reactions: true,
        links: true,
        contacts: true,
        sections: true,
        parts: true,
        plastic_strains: true,
        shells: true,
    };
}

/// The derived quantities of one accepted step. Their buffers are kept from step to step, so that nothing is allocated once
/// they have grown.
#[derive(Default)]
pub struct Outputs {
    pub energy: Option<Energy>,
    pub links: Vec<LinkState>,
    pub joints: Vec<JointState>,
    pub contacts: Vec<ContactState>,
    pub plastic_strains: Vec<f64>,
    pub sections: Vec<SectionPoint>,
    pub parts: Vec<PartEnergy>,
    pub shells: Vec<ShellState>,
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
    /// Energies are needed to watch for growth, whoever else wants them.
    pub watched: bool,
    pub threads: usize,
}

impl Outputs {
    pub fn new(model: &Model) -> Self {
        Outputs { contacts: Vec::with_capacity(model.count(PartKind::Contact)), ..Outputs::default() }
    }

    /// Computes what is wanted of this step and empties the rest.
    pub fn compute(&mut self, wanted: &Wanted, request: &Request) {
        self.clear();
        let &Request { model, system, state, due, drawn, balance, watched, threads } = request;
        if wanted.plastic_strains && (due || drawn) {
            system.plastic_strains(&state.configuration(), &mut self.plastic_strains);
        }
        if wanted.shells && (due || drawn) {
            system.shell_states(model, &state.configuration(), &mut self.shells);
        }
        if !due {
            return;
        }
        if wanted.energy || watched {
            self.energy = Some(system.energy(state, balance, threads));
        }
        if wanted.reactions {
            system.joint_states(&state.nodes, &state.multipliers, &mut self.joints);
        }
        if wanted.links {
            system.link_states(&state.nodes, &mut self.links);
        }
        if wanted.contacts {
            system.contact_states(model, &state.configuration(), &mut self.contacts);
        }
        if wanted.sections {
            system.section_points(model, &state.configuration(), &mut self.sections);
        }
        if wanted.parts {
            system.part_energies(model, &state.configuration(), &mut self.parts);
        }
    }

    fn clear(&mut self) {
        self.energy = None;
        self.links.clear();
        self.joints.clear();
        self.contacts.clear();
        self.plastic_strains.clear();
        self.sections.clear();
        self.parts.clear();
        self.shells.clear();
    }
}
