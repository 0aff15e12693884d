//! The choice of contact stiffness if the deck gives none: it is raised until twice the value hardly changes the results.

use super::numbers::{number, two_digits};
use super::pilot_run::PilotRun;
use super::pilots::Pilots;
use deck::parts::PartKind;
use model::{Model, Part};

/// Largest number of times that it is raised, ...
const MOST_ROUNDS: usize = 3;
/// ... and largest factor at once.
const MOST_AT_ONCE: f64 = 64.0;
/// The error over the difference to the results with twice the stiffness k. Penetration at rest follows 1/k, that of an impact 1/√k.
const AT_REST: f64 = 2.0;
const OF_IMPACTS: f64 = 3.4;

/// The chosen stiffness of all contacts that leave it open.
pub struct ChosenContacts {
    /// The overrides.
    pub sets: Vec<String>,
    /// The estimated error of the results; `None` where it is not known.
    pub error: Option<f64>,
    /// Reasons for errors that remain or are not known.
    pub remarks: Vec<String>,
}

/// The contacts with a stiffness of the program's choice: the path of the table and the value.
pub fn open_contacts(pilots: &Pilots) -> Vec<(String, f64)> {
    let stiffness = |model: &Model, name: &str| {
        model.parts.iter().find_map(|part| match part {
            Part::Contact(contact) if contact.name == name && contact.chosen.is_some() => {
                contact.law.as_ref().map(|law| law.stiffness)
            }
            _ => None,
        })
    };
    let contacts = pilots.deck.parts().filter(|part| part.at.kind == PartKind::Contact);
    contacts.filter_map(|part| Some((part.table_path(), stiffness(pilots.model, part.name()?.as_str())?))).collect()
}

/// Chooses a stiffness with an error of at most `share`, for a given mesh and its results.
pub fn choose_stiffness(
    pilots: &mut Pilots,
    (mesh, observed): (&[String], &PilotRun),
    open: &[(String, f64)],
    share: f64,
) -> ChosenContacts {
    let with = |factor: f64| -> Vec<String> {
        open.iter().map(|(path, stiffness)| format!("{path}.stiffness={}", number(stiffness * factor))).collect()
    };
    let sets = |factor: f64| [mesh, &with(factor)[..]].concat();
    let of_difference = if pilots.model.analysis.is_dynamic() { OF_IMPACTS } else { AT_REST };
    let mut chosen = ChosenContacts { sets: Vec::new(), error: None, remarks: Vec::new() };
    let (mut factor, mut own) = (1.0_f64, None);
    for round in 0..=MOST_ROUNDS {
        let twice = pilots.run(&sets(2.0 * factor));
        let compared = twice.and_then(|twice| pilots.difference(&twice, own.as_ref().unwrap_or(observed)));
        let difference = match compared {
            Ok(difference) => difference,
            Err(reason) => {
                chosen.remarks.push(format!("the error by contact stiffness is not known: {reason}. Give `stiffness`, and compare with twice the value"));
                return chosen;
            }
        };
        let error = of_difference * difference.size;
        if chosen.error.is_some_and(|before| error > 0.7 * before) {
            chosen.remarks.push(format!(
                "stiffer contacts do not bring the results together: twice the stiffness changes the {} by {}. Give \
                 `stiffness` or `restitution`, and compare peaks: impacts shift in time",
                difference.of,
                two_digits(difference.size)
            ));
            chosen.error = None;
            return chosen;
        }
        (chosen.sets, chosen.error) = (if factor > 1.0 { with(factor) } else { Vec::new() }, Some(error));
        if error <= share {
            return chosen;
        }
        let rise = (error / share).log2().ceil().exp2().min(MOST_AT_ONCE);
        if round < MOST_ROUNDS {
            match pilots.run(&sets(factor * rise)) {
                Ok(run) => (factor, own) = (factor * rise, Some(run)),
                Err(reason) => {
                    chosen.remarks.push(format!("contacts cannot be stiffer: {reason}. Give `stiffness`"));
                    break;
                }
            }
        }
    }
    if let Some(error) = chosen.error {
        let error = two_digits(error);
        chosen.remarks.push(format!(
            "the error of the contact stiffness is about {error}. Raise `accuracy`, or give `stiffness`"
        ));
    }
    chosen
}
