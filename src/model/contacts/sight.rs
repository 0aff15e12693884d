//! Whether a surface may pass between the points that are to touch it.

use crate::report::{Owner, Report};
use base::names::short;
use mechanics::elements::contact::{Surface, Toucher, passing_width};
use std::collections::BTreeSet;

/// Largest number of points between two nodes; more are taken for a typing error.
pub const MOST_POINTS: usize = 100;

/// The widest opening between the points of a body or a part.
pub struct Opening {
    /// Its width.
    pub width: f64,
    /// The contact radius of its points where the contact gives none.
    pub radius: f64,
    /// True where `points` make it narrower.
    pub divides: bool,
}

/// Coverage of the touching bodies in a contact.
#[derive(Default)]
pub struct Sight {
    /// Its shapes.
    pub touchers: BTreeSet<Toucher>,
    /// The openings between its points.
    pub openings: Vec<Opening>,
    /// The contact radius of all points, where the contact gives one.
    pub radius: Option<f64>,
}

impl Sight {
    /// Warns of surfaces that may pass between points undetected. `points` is the deck's number between nodes and corners; `by_points` is
    /// true for contact by points alone.
    pub fn check(
        &self,
        owner: &Owner,
        (points, by_points): (Option<u64>, bool),
        surface: &Surface,
        report: &mut Report,
    ) {
        /// Decks have some digits only.
        const DIGITS: f64 = 1e-6;
        let (width, word) = (passing_width(&surface.shape), surface.shape.word());
        let free = |opening: &&Opening| opening.width - 2.0 * self.radius.unwrap_or(opening.radius);
        let widest = self.openings.iter().max_by(|a, b| free(a).total_cmp(&free(b)));
        if let Some(opening) = widest.filter(|opening| free(opening) > width * (1.0 + DIGITS)) {
            let message = format!(
                "{} touches with points up to {} apart, and the {word} is {} wide: it may pass between them",
                owner.what,
                short(opening.width),
                short(width)
            );
            let whole = opening.width * (points.unwrap_or(0) + 1) as f64;
            let between = (whole / (width + opening.width - free(&opening)) - DIGITS).ceil() - 1.0;
            let hint = match opening.divides {
                true if between <= MOST_POINTS as f64 => format!("give `points` = {between} or more, or a finer mesh"),
                _ => "give a finer mesh".to_owned(),
            };
            report.warn(owner.span, message, hint);
            return;
        }
        let may_pass = |toucher: &&Toucher| points.is_none() && toucher.may_pass(&surface.shape, by_points);
        for toucher in self.touchers.iter().filter(may_pass) {
            let unseen = toucher.unseen(&surface.shape, by_points).unwrap_or_default();
            let message = format!("{} does not see {unseen}, so a {word} may enter there", owner.what);
            report.warn(owner.span, message, "give `points`, so many that they lie closer than the surface is wide");
        }
    }
}
