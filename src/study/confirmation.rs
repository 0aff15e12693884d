//! The judgement of a reference by a scheme of another family: finer runs of one family cannot show a common error of that family.

/// The judgement of a reference by a scheme of another family.
#[derive(Debug, Clone, PartialEq)]
pub enum Confirmation {
    /// Nothing: none has been run, or none has an answer.
    None,
    /// It tends to the same as far as both are known.
    Agrees(Difference),
    /// It tends to something else.
    Disagrees(Difference),
}

/// How far two answers are apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The label of the line that gives the other answer.
    pub label: String,
    /// The error of one answer against the other.
    pub apart: f64,
    /// The difference within the bounds of both.
    pub allowed: f64,
}

impl Confirmation {
    /// It in words, behind those about the reference.
    pub fn in_words(&self) -> String {
        match self {
            Confirmation::None => "not confirmed: all schemes are of one family".to_owned(),
            Confirmation::Agrees(of) => {
                format!("confirmed by {}, which tends to the same within {:.1e}", of.label, of.apart)
            }
            Confirmation::Disagrees(of) => format!(
                "CONTRADICTED by {}: their limits differ by {:.1e}, and the errors of both explain {:.1e}. One of the two is wrong, so errors \
                 below this are not reliable. Take finer steps, and see which one moves",
                of.label, of.apart, of.allowed
            ),
        }
    }
}
