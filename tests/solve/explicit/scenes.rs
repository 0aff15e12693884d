//! What the decks of these tests have in common.

use super::scene;
use rdsolve::model::Model;
use std::fmt::Display;

pub const AUTO: &str = "\"auto\"";

/// The head of a deck: a dynamic analysis by a scheme.
pub fn dynamic(end_time: impl Display, time_step: impl Display, scheme: &str) -> String {
    format!(
        "[analysis]\nkind = \"dynamic\"\nend_time = {end_time}\ntime_step = {time_step}\n[integrator]\nscheme = \"{scheme}\"\n"
    )
}

/// Masses 2 on springs of 100 in a row, the first on the ground, with a damper there.
pub fn row_of_masses(count: usize, damping: f64) -> String {
    let mut text = dynamic("2.0", AUTO, "central-difference");
    text += "[output]\ninterval = 2.0\n[points]\n";
    (1..=count).for_each(|k| text += &format!("p{k} = [{k}.0, 0.0, 0.0]\n"));
    for k in 1..=count {
        text += &format!("[[masses]]\nat = \"p{k}\"\nmass = 2.0\n");
        let from = if k == 1 { "ground = [0.0, 0.0, 0.0]".to_string() } else { format!("node = \"p{}\"", k - 1) };
        let damper = if k == 1 && damping > 0.0 { format!("damping = {damping}\n") } else { String::new() };
        text += &format!(
            "[[links]]\nname = \"s{k}\"\nfrom = {{ {from} }}\nto = {{ node = \"p{k}\" }}\nstiffness = 100.0\n\
             direction = [1.0, 0.0, 0.0]\n{damper}"
        );
    }
    text + "[[initial]]\nat = \"p1\"\nvelocity = [1.0, 0.0, 0.0]\n"
}

/// The same, every step of it.
pub fn steps_of_row(count: usize, damping: f64, sets: &[&str]) -> Model {
    scene(&row_of_masses(count, damping).replace("interval = 2.0", "every = 1"), sets)
}
