//! A plane frame given in space (decks/portal_and_block, elastic) against the same frame whose nodes are held in the plane one by one:
//! what is left out by itself must not cost more. Least of repeats taken in turn, time loops alone, one thread.

use rdsolve::diagnostic::Source;
use rdsolve::model::{self, Model, Restraint};
use rdsolve::plan::Plan;
use rdsolve::solve::{Outcome, Run, Wanted};
use rdsolve::system::System;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// uy, rx, rz.
const ACROSS: [usize; 3] = [1, 3, 5];

fn held_in_plane(mut model: Model) -> Model {
    model.analysis.plane = false;
    for node in 0..model.nodes.len() {
        for dof in ACROSS {
            let depends =
                model.constraints.dependents.iter().any(|dependent| dependent.node == node && dependent.dofs[dof]);
            if !depends && !model.constraints.restraints.iter().any(|held| held.node == node && held.dof == dof) {
                model.constraints.restraints.push(Restraint { node, dof, motion: None });
            }
        }
    }
    model.constraints.restraints.sort_by_key(|held| (held.node, held.dof));
    model
}

fn main() {
    let deck = include_str!("../decks/portal_and_block/deck.toml");
    for material in ["elastic", "elastic-plastic"] {
        let mut sets = vec!["expect=[]".to_owned(), "output={every=1000000}".to_owned()];
        if material == "elastic" {
            sets.push(
                "materials.steel={model=\"elastic\",youngs_modulus=210e9,poisson_ratio=0.3,density=7850.0}".to_owned(),
            );
            sets.push("sections.square={shape=\"rectangle\",width=0.05,height=0.05}".to_owned());
            sets.push("beams.portal={name=\"portal\",path=[\"foot_left\",\"knee_left\",\"knee_right\",\"foot_right\"],elements=8,order=3,material=\"steel\",section=\"square\",orientation=[0.0,1.0,0.0]}".to_owned());
        }
        let read = || model::read(&Source::new("deck.toml", deck, &sets)).0.expect("a sound deck");
        let models = [read(), held_in_plane(read())];
        let mut least = [f64::INFINITY; 2];
        let mut unknowns = [0; 2];
        let stop = AtomicBool::new(false);
        for _ in 0..10 {
            for (k, model) in models.iter().enumerate() {
                let system = System::new(model).expect("a system");
                let plan = Plan::new(model, &system, 1);
                unknowns[k] = plan.dofs.unknowns();
                let mut run = Run::new(model, &system, &plan, Wanted::default(), &stop).expect("memory");
                let began = Instant::now();
                let (outcome, _) = run.run(&mut ());
                assert!(matches!(outcome, Outcome::Done));
                least[k] = least[k].min(began.elapsed().as_secs_f64());
            }
        }
        println!(
            "{material}: in space {:.4} s, {} unknowns; held in the plane {:.4} s, {}; ratio {:.3}",
            least[0],
            unknowns[0],
            least[1],
            unknowns[1],
            least[0] / least[1]
        );
    }
}
