//! The choice of the mesh. Errors follow from differences between meshes, as L. F. Richardson has it: the first rate is assumed, later ones
//! are measured.

use super::numbers::two_digits;
use super::pilot_run::PilotRun;
use super::pilots::Pilots;
use results::observed::RunDifference;
use study::{CoarserMesh, RefinableParts, is_affordable};

/// Largest number of finer meshes that are tried.
const MOST_ROUNDS: usize = 6;
/// Largest number of refinements of a group between two runs. The error exceeds this multiple of its share and falls at a measured rate, or no error
/// of lines of low order is known.
const AT_ONCE: i32 = 2;
const FAR: f64 = 4.0;
/// The assumed error of a mesh without any comparison. It decides how often meshes are refined, and tells no error.
const UNKNOWN: f64 = 0.1;
/// A mesh is no worse than the best if its difference to the finest is within this factor.
const NO_WORSE: f64 = 1.1;
/// Range of the believed factor between the errors of two meshes, for each refinement. A larger one may be chance.
const BELIEVED: [f64; 2] = [1.5, 30.0];
/// The largest believed factor that no third mesh has measured. Under a sudden load it is 7.7 from one beam of order 3 to two, where smooth motion has 28.
const UNMEASURED: f64 = 8.0;
/// Largest gain over the assumed factor that the next mesh is trusted to have. A very coarse mesh, such as a beam of two nodes for a rod that
/// bends, says little of the next.
const GAIN: f64 = 1.5;
/// The factor between the errors of two meshes where differences no longer fall: the difference itself is the error.
const NO_RATE: f64 = 2.0;
/// A mesh converges if differences fall by this factor at least.
const CONVERGES: f64 = 1.2;

/// The chosen mesh.
pub struct ChosenMesh {
    /// The overrides that make it.
    pub sets: Vec<String>,
    /// The estimated error of its results; `None` where it is not known.
    pub error: Option<f64>,
    /// A coarser mesh, for error bars, and the results of a pilot run with it.
    pub coarser: Option<(CoarserMesh, Option<PilotRun>)>,
    /// The results of the pilot run with the chosen mesh.
    pub observed: PilotRun,
    /// Reasons for errors that remain or are not known.
    pub remarks: Vec<String>,
}

/// The search for a mesh.
struct Search {
    base: Vec<RefinableParts>,
    /// The best mesh so far, and its results.
    now: Vec<RefinableParts>,
    observed: PilotRun,
    /// The earlier meshes from the coarsest on, each with the ratio of its error to that of the next one, and its results.
    earlier: Vec<(Vec<RefinableParts>, f64, PilotRun)>,
    /// The estimated errors by group; infinite where nothing is known.
    errors: Vec<f64>,
    /// The difference between the two meshes, and the least factor that was assumed.
    last: Option<(f64, f64)>,
    /// The measured factor over the assumed one; `None` where it has not been measured.
    surplus: Option<f64>,
    worst: String,
    /// Largest believed surplus.
    gain: f64,
}

/// A finer mesh.
struct Planned {
    finer: Vec<RefinableParts>,
    /// Number of refinements by group.
    times: Vec<i32>,
    /// The expected errors by group.
    expected: Vec<f64>,
    /// True for groups without a measured error from this mesh.
    fixed: Vec<bool>,
    /// The assumed factor between the errors of both meshes in the groups with a measured error. If one of them had no known error, it
    /// is the least of their factors.
    assumed: f64,
}

impl Planned {
    fn most_times(&self) -> i32 {
        self.times.iter().copied().max().unwrap_or(1)
    }

    /// The known errors of the other groups.
    fn of_others(&self) -> f64 {
        let others = self.expected.iter().zip(&self.fixed).filter(|(error, fixed)| **fixed && error.is_finite());
        others.map(|(error, _)| error).sum()
    }

    /// The errors by group, if those of the groups with a measured error sum to `of_told`.
    fn errors(&self, of_told: f64) -> Vec<f64> {
        let both = || self.expected.iter().zip(&self.fixed);
        let sum: f64 = both().filter(|(_, fixed)| !**fixed).map(|(error, _)| error).sum();
        both().map(|(error, fixed)| if *fixed { *error } else { error * of_told / sum }).collect()
    }
}

/// The next mesh after one with these errors by group, with the measured surplus and the believed one. Each group whose error is not known is refined.
fn plan(now: &[RefinableParts], errors: &[f64], (measured, surplus): (Option<f64>, f64), share: f64) -> Planned {
    let count = now.len();
    let (mut finer, mut times, mut factors) = (now.to_vec(), vec![0_i32; count], vec![1.0; count]);
    let is_unknown = |index: usize| errors[index].is_infinite();
    // A group without another mesh takes no part.
    let even = |index: usize| if now[index].finer().is_some() { UNKNOWN / count as f64 } else { 0.0 };
    let mut expected: Vec<f64> =
        (0..count).map(|index| if is_unknown(index) { even(index) } else { errors[index] }).collect();
    let before: f64 = expected.iter().sum();
    loop {
        let after: f64 = expected.iter().sum();
        let is_far = measured.is_some() && after > FAR * share;
        let at_once = |index: usize| {
            if is_far || is_unknown(index) && now[index].raises_order() { AT_ONCE } else { 1 }
        };
        let is_due = |index: usize| is_unknown(index) && times[index] == 0;
        let able = (0..count).filter(|&index| {
            (after > share || is_due(index)) && times[index] < at_once(index) && finer[index].finer().is_some()
        });
        let first =
            |&a: &usize, &b: &usize| is_due(a).cmp(&is_due(b)).then_with(|| expected[a].total_cmp(&expected[b]));
        let Some(index) = able.max_by(first) else { break };
        let Some((group, ratio)) = finer[index].finer() else { break };
        finer[index] = group;
        times[index] += 1;
        factors[index] *= ratio.max(BELIEVED[0]);
        expected[index] /= (ratio * surplus).clamp(BELIEVED[0], BELIEVED[1]);
    }
    let refined = |&index: &usize| times[index] > 0;
    let tells_ratios = (0..count).filter(refined).any(is_unknown);
    let assumed = if tells_ratios {
        (0..count).filter(refined).map(|index| factors[index]).fold(f64::INFINITY, f64::min)
    } else {
        (before / expected.iter().sum::<f64>() / surplus).max(BELIEVED[0])
    };
    let fixed: Vec<bool> = (0..count).map(|index| times[index] == 0 && (tells_ratios || is_unknown(index))).collect();
    let expected = expected.iter().zip(errors).zip(&fixed);
    let expected = expected.map(|((expected, error), fixed)| if *fixed { *error } else { *expected }).collect();
    Planned { finer, times, expected, fixed, assumed }
}

/// Chooses a mesh with an error of at most `share`. The search begins with the mesh of the deck and its results.
pub fn choose_mesh(pilots: &mut Pilots, base: Vec<RefinableParts>, share: f64, observed: PilotRun) -> ChosenMesh {
    let mut remarks = Vec::new();
    let errors = vec![f64::INFINITY; base.len()];
    let mut search = Search {
        now: base.clone(),
        base,
        observed,
        earlier: Vec::new(),
        errors,
        last: None,
        surplus: None,
        worst: String::new(),
        // Hinges at yield move with the mesh, so differences fall by chance.
        gain: if pilots.model.yields() { 1.0 } else { GAIN },
    };
    if !search.base.is_empty() {
        search.look_back(pilots, share);
        for _ in 0..MOST_ROUNDS {
            if search.is_within(share) {
                break;
            }
            match search.refine(pilots, share) {
                Ok(true) => {}
                Ok(false) => break,
                Err(reason) => {
                    remarks.push(format!(
                        "the mesh cannot be refined further: {reason}. Raise `accuracy`, or give another mesh"
                    ));
                    break;
                }
            }
        }
    }
    let error = search.error();
    if error.is_infinite() && remarks.is_empty() {
        remarks.push(
            "the error of the mesh is not known: some parts cannot have another mesh. Compare with a finer one"
                .to_owned(),
        );
    } else if error.is_finite() && error > share {
        let (worst, least) = (&search.worst, two_digits(error));
        remarks.push(format!(
            "the error of the mesh is about {least}, largest in the {worst}. Raise `accuracy`, or give more `elements`"
        ));
    }
    search.conclude(error, remarks)
}

impl Search {
    /// The estimated error of the best mesh so far.
    fn error(&self) -> f64 {
        self.errors.iter().sum()
    }

    /// True if all errors that are known, or can be, are together at most `share`.
    fn is_within(&self, share: f64) -> bool {
        let both = self.errors.iter().zip(&self.now);
        both.filter(|(error, group)| error.is_finite() || group.finer().is_some()).map(|(error, _)| error).sum::<f64>()
            <= share
    }

    /// The part of the measured surplus that the next mesh is trusted to have, too: a lack in full, a gain by its root.
    fn believed_surplus(&self) -> f64 {
        let surplus = self.surplus.unwrap_or(1.0);
        if surplus > 1.0 { surplus.sqrt().min(self.gain) } else { surplus }
    }

    /// Compares the mesh of the deck with coarser ones, first in all groups, then in each.
    fn look_back(&mut self, pilots: &mut Pilots, share: f64) {
        let coarser: Vec<Option<(RefinableParts, f64)>> = self.now.iter().map(RefinableParts::coarser).collect();
        let apart = coarser.iter().flatten().map(|(_, ratio)| *ratio).fold(f64::INFINITY, f64::min);
        let all: Vec<RefinableParts> = coarser
            .iter()
            .zip(&self.now)
            .map(|(coarser, own)| coarser.as_ref().map_or(own, |(group, _)| group).clone())
            .collect();
        let is_whole = coarser.iter().all(Option::is_some);
        if apart.is_infinite() {
            return;
        }
        let told = self.compared(pilots, &all);
        let Ok((difference, run)) = told else { return };
        self.last = Some((difference, apart));
        let apart = apart.min(UNMEASURED);
        self.earlier.push((all, apart, run));
        if is_whole {
            let each = difference / (apart - 1.0) / self.now.len() as f64;
            self.errors.fill(each);
        }
        if (is_whole && self.error() <= share) || self.now.len() == 1 {
            return;
        }
        for (index, coarser) in coarser.into_iter().enumerate() {
            let Some((group, ratio)) = coarser else { continue };
            let mut alone = self.now.clone();
            alone[index] = group;
            // The run above tells the error of a group that alone has a coarser mesh.
            let is_told = self.earlier.iter().any(|(mesh, ..)| *mesh == alone);
            let told = if is_told { Ok(difference) } else { self.compared(pilots, &alone).map(|(size, _)| size) };
            if let Ok(difference) = told {
                self.errors[index] = difference / (ratio.min(UNMEASURED) - 1.0);
            }
        }
    }

    /// The difference of the best results to those on another mesh, and these.
    fn compared(&mut self, pilots: &mut Pilots, mesh: &[RefinableParts]) -> Result<(f64, PilotRun), String> {
        let theirs = pilots.run(&self.sets(mesh))?;
        let difference = pilots.difference(&self.observed, &theirs)?;
        self.worst = difference.of;
        Ok((difference.size, theirs))
    }

    fn sets(&self, mesh: &[RefinableParts]) -> Vec<String> {
        mesh.iter().zip(&self.base).flat_map(|(group, base)| group.sets(base)).collect()
    }

    /// Refines the groups of largest error until the expected error is small enough, and measures it. False if nothing can be refined.
    ///
    /// # Errors
    /// The run with the finer mesh fails, or differences no longer fall.
    fn refine(&mut self, pilots: &mut Pilots, share: f64) -> Result<bool, String> {
        let planned = plan(&self.now, &self.errors, (self.surplus, self.believed_surplus()), share);
        if planned.finer == self.now {
            return Ok(false);
        }
        if !is_affordable(&planned.finer) {
            return Err("it would have more than 100,000 elements".to_owned());
        }
        let run = pilots.run(&self.sets(&planned.finer))?;
        let difference = pilots.difference(&run, &self.observed)?;
        let Planned { assumed, .. } = planned;
        if let Some((last, before)) = self.last {
            let measured = 1.0 + last / difference.size * (1.0 - 1.0 / assumed);
            if last < CONVERGES * difference.size && difference.size > share {
                let error = self.go_back(pilots, &run, difference);
                return Err(format!(
                    "results of finer meshes differ by {} from those of this one, in the {}, and not less than before. Motion that amplifies \
                     small changes, or buckling between elements, may cause this",
                    two_digits(error),
                    self.worst
                ));
            }
            self.surplus = Some(measured / before);
        }
        let most = match self.last {
            // Errors fall no faster than differences did, whatever the order of the elements promises.
            Some((last, _)) => BELIEVED[1].powi(planned.most_times()).min(last / difference.size),
            None => UNMEASURED,
        };
        let apart = (assumed * self.believed_surplus()).min(most).max(BELIEVED[0]);
        let of_refined = difference.size / (apart - 1.0);
        self.errors = planned.errors(of_refined);
        self.worst = difference.of;
        let (size, of_others) = (difference.size, planned.of_others());
        // Errors of other groups are the same on both meshes.
        let whole = |apart: f64| if of_others > 0.0 { 1.0 + size / (size / (apart - 1.0) + of_others) } else { apart };
        self.last = Some((size, whole(assumed)));
        let apart = whole(apart);
        let before = std::mem::replace(&mut self.observed, run);
        self.earlier.push((std::mem::replace(&mut self.now, planned.finer), apart, before));
        Ok(true)
    }

    /// Goes back to the coarsest mesh that differs no more from the `finest` than the last one does, by `difference`. This difference is then the
    /// estimated error, which is returned.
    fn go_back(&mut self, pilots: &Pilots, finest: &PilotRun, difference: RunDifference) -> f64 {
        let told =
            |run: &PilotRun| pilots.difference(finest, run).ok().filter(|told| told.size <= NO_WORSE * difference.size);
        // No mesh becomes coarser than in the deck.
        let allowed = self.earlier.iter().enumerate().skip_while(|(_, (mesh, ..))| *mesh != self.base);
        let no_worse = allowed.filter_map(|(place, (.., run))| Some((place, told(run)?))).next();
        let mut error = difference.size;
        self.worst = difference.of;
        if let Some((place, told)) = no_worse {
            if told.size > error {
                (error, self.worst) = (told.size, told.of);
            }
            if let Some((mesh, _, run)) = self.earlier.drain(place..).next() {
                (self.now, self.observed) = (mesh, run);
            }
        }
        if let Some((_, apart, _)) = self.earlier.last_mut() {
            *apart = apart.min(NO_RATE);
        }
        self.errors.fill(error / self.now.len() as f64);
        error
    }

    fn conclude(mut self, error: f64, remarks: Vec<String>) -> ChosenMesh {
        ChosenMesh {
            sets: self.sets(&self.now),
            error: error.is_finite().then_some(error),
            coarser: self.coarser().filter(|_| error.is_finite()),
            observed: self.observed,
            remarks,
        }
    }

    /// A coarser mesh in all groups: the previous one, and in groups that have not changed since the next coarser one. Its results are known if
    /// all groups have changed.
    fn coarser(&mut self) -> Option<(CoarserMesh, Option<PilotRun>)> {
        let (before, mut apart, run) = self.earlier.pop()?;
        let (mut sets, mut run) = (Vec::new(), Some(run));
        for (now, before) in self.now.iter().zip(before) {
            match now.coarser().filter(|_| before == *now) {
                Some((coarser, ratio)) => {
                    sets.extend(coarser.sets(now));
                    apart = apart.min(ratio);
                    run = None;
                }
                None => sets.extend(before.sets(now)),
            }
        }
        Some((CoarserMesh { sets, apart, unchanged: Vec::new(), coarsest: Vec::new() }, run))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::load::build;
    use super::*;
    use base::diagnostic::Source;

    /// So many beams with one element of order 2.
    fn beams(count: usize) -> Vec<RefinableParts> {
        let text =
            include_str!("../../../decks/half_circle/deck.toml").replace("elements = 1", "elements = 1\norder = 2");
        let (before, rest) = text.split_once("[[beams]]").expect("a beam");
        let (beam, after) = rest.split_once("[[supports]]").expect("a support");
        let copies: String = (0..count)
            .map(|k| format!("[[beams]]{}", beam.replace("\"strip\"\npath", &format!("\"{k}\"\npath"))))
            .collect();
        let source = Source::new("deck.toml", format!("{before}{copies}[[supports]]{after}"), &[]);
        let (Some(deck), _) = deck::read(&source) else { panic!("the deck can be read") };
        let Ok(loaded) = build(source, &[]) else { panic!("the deck is sound") };
        study::mesh_groups(&deck, &loaded.model).0
    }

    /// An assumed error of an unknown mesh would make the factor 13, and the error told four times too small.
    #[test]
    fn the_least_factor_holds_where_an_error_is_not_known() {
        let planned = plan(&beams(2), &[f64::INFINITY, 0.02], (None, 1.0), 1e-3);
        assert_eq!((planned.times.as_slice(), planned.assumed), (&[2, 1][..], 4.0));
        let told = planned.errors(3e-3);
        assert!((told.iter().sum::<f64>() - 3e-3).abs() < 1e-15, "{told:?}");
    }

    #[test]
    fn each_mesh_of_unknown_error_is_refined() {
        let planned = plan(&beams(3), &[f64::INFINITY, 1e-9, f64::INFINITY], (None, 1.0), 0.5);
        assert_eq!((planned.times.as_slice(), planned.assumed), (&[1, 0, 1][..], 4.0));
        assert_eq!((planned.errors(3e-3), planned.of_others()), (vec![1.5e-3, 1e-9, 1.5e-3], 1e-9));
    }
}
