//! Warnings of friction that steps or stiffnesses do not resolve.

use base::names::to_digits;
use base::snapshot::keep;
use std::fmt;

/// Steps that do not resolve a contact throw off a resting body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactThrows {
    /// The name of the contact.
    pub name: String,
    /// The largest speed with which it parts.
    pub speed: f64,
    /// The way that it slides while it is apart.
    pub slid: f64,
    /// The stiffness, and one that steps resolve.
    pub stiffness: [f64; 2],
    /// The step, and one that resolves the contact.
    pub step: [f64; 2],
}

keep!(ContactThrows: Default { name, speed, slid, stiffness, step });

/// Slip begins again with a velocity that it should not have.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SlipBegins {
    /// The name of the contact or joint.
    pub name: String,
    /// The error of the slip.
    pub error: f64,
    /// The largest slip.
    pub farthest: f64,
    /// The stiffness of a contact, and one that does.
    pub stiffness: Option<[f64; 2]>,
    /// A `stick` of a joint that does.
    pub stick: Option<f64>,
    /// A sufficient step, if the deck gives the step.
    pub step: Option<f64>,
}

keep!(SlipBegins: Default { name, error, farthest, stiffness, stick, step });

impl fmt::Display for ContactThrows {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [now, enough] = self.stiffness.map(|k| to_digits(k, 2));
        let [long, short] = self.step.map(|dt| to_digits(dt, 2));
        write!(
            f,
            "contact `{}`: steps of {long} do not resolve its stiffness of {now}. They throw off a resting body with a speed of up to {}. It then slides \
             by {} while the contact is open, where friction would hold it. Give `stiffness` = {enough}, `time_step` = {short}, or `restitution` = 0",
            self.name,
            to_digits(self.speed, 2),
            to_digits(self.slid, 2)
        )
    }
}

impl fmt::Display for SlipBegins {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (what, remedy) = match (self.stiffness, self.stick) {
            (Some([now, enough]), _) => {
                ("contact", format!("`stiffness` = {} (now {})", to_digits(enough, 2), to_digits(now, 3)))
            }
            (None, stick) => ("joint", format!("`stick` = {}", to_digits(stick.unwrap_or_default(), 2))),
        };
        let step = self.step.map_or_else(String::new, |step| format!(", and `time_step` = {}", to_digits(step, 2)));
        write!(
            f,
            "{what} `{}`: after reversals slip begins with a false speed, because the spring of its friction is too soft and the steps are too long. \
             The slip has an error of up to about {}, {} % of the largest slip of {}. Give {remedy}{step}",
            self.name,
            to_digits(self.error, 2),
            to_digits(100.0 * self.error / self.farthest, 2),
            to_digits(self.farthest, 3)
        )
    }
}
