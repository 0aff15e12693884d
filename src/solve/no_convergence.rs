//! The evidence in the last step of an iteration without convergence, and its message.

use base::names::short;
use base::snapshot::keep;

/// The evidence of a step that did not converge.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NoConvergence {
    /// True where a tangent of a load step had a negative or a vanishing pivot: no equilibrium may lie nearby.
    pub at_limit: bool,
    /// The `least_step` of the deck, where it forbids the next cutback.
    pub least_step: Option<f64>,
    /// The number of iterations that would suffice at the last contraction, unless it is far away.
    pub enough: Option<usize>,
    /// True in dynamics.
    pub moves: bool,
}

keep!(NoConvergence: Default { at_limit, least_step, enough, moves });

impl NoConvergence {
    /// The message up to the list of forces. `open` is the part that has opened last, in quotes; `yielded` yields most at a limit load. With
    /// `lacks_slip` the matrix omits a part of friction. `worst` is the node, direction and size of the largest residual force.
    pub fn message(
        &self,
        iterations: usize,
        [open, yielded]: [Option<&str>; 2],
        lacks_slip: bool,
        worst: Option<(&str, &str, f64)>,
    ) -> String {
        let slips = match lacks_slip {
            true => {
                ". Friction slips, and the matrix omits its unsymmetric part: `gyroscopic = \"left\"` in [iteration] includes it"
            }
            false => "",
        };
        if open.is_none() && self.at_limit {
            let where_lost = yielded.map_or_else(String::new, |part| format!("; {part}"));
            return format!(
                "no equilibrium is found beyond this load: the structure buckles or reaches its limit load, for a pivot of the tangent is \
                 negative or vanishes{where_lost}{slips}. Give `control` = \"arc-length\" to follow the path on which the load falls, or \
                 `kind = \"dynamic\"` to follow the motion. After {iterations} iterations the largest unbalanced forces are"
            );
        }
        let cause = self.cause(open, worst);
        format!("no convergence in {iterations} iterations{cause}{slips}; the largest unbalanced forces are")
    }

    fn cause(&self, open: Option<&str>, worst: Option<(&str, &str, f64)>) -> String {
        if let Some(name) = open {
            return format!(
                ": {name} is open or slack, and perhaps nothing else holds the structure. Add a support or a soft spring there"
            );
        }
        if let Some(enough) = self.enough {
            return format!(", though corrections still shrink. Give `limit` = {enough} in [iteration]");
        }
        let place = worst.map_or_else(String::new, |(label, direction, residual)| {
            let out = if residual.is_finite() { format!("by {residual:.1e}") } else { "and not finite".to_owned() };
            format!(": `{label}` is out of balance in direction {direction} {out}")
        });
        match self.least_step {
            Some(least) => format!(
                "{place}, and `least_step` = {} forbids shorter steps. Give `least_step` = {}",
                short(least),
                short(0.01 * least)
            ),
            None => format!(
                "{place}, however short the step. Look there for a jump of a load or motion, or for a part that opens, slips or yields suddenly. \
                 Add a soft spring there{}",
                if self.moves { "" } else { ", or give `kind = \"dynamic\"`" }
            ),
        }
    }
}
