//! The choice of the mesh. Errors follow from differences between meshes, as L. F. Richardson has it: the first rate is assumed, later ones
//! are measured.

use super::numbers::two_digits;
use super::pilot_run::PilotRun;
use super::pilots::Pilots;
use study::{CoarserMesh, RefinableParts, is_affordable};

/// Largest number of finer meshes that are tried.
const MOST_ROUNDS: usize = 6;
/// Largest number of refinements of a group between two runs. The error exceeds this multiple of its share and falls at a measured rate, or no error
/// of lines of low order is known.
const AT_ONCE: i32 = 2;
const FAR: f64 = 4.0;
/// The assumed error of a mesh without any comparison.
const UNKNOWN: f64 = 0.1;
/// A mesh is no worse than the best if its difference to the finest is within this factor.
const NO_WORSE: f64 = 1.1;
/// Range of the believed factor between the errors of two meshes, for each refinement. A larger one may be chance.
const BELIEVED: [f64; 2] = [1.5, 30.0];
/// Largest gain over the assumed factor that the next mesh is trusted to have. A very coarse mesh, such as a beam of two nodes for a rod that
/// bends, says little of the next.
const GAIN: f64 = 1.5;
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
            if search.error() <= share {
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
            "the error of the mesh is not known: no part can have another mesh. Compare with a finer one".to_owned(),
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
        self.earlier.push((all, apart, run));
        self.last = Some((difference, apart));
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
            if let Ok((difference, _)) = self.compared(pilots, &alone) {
                self.errors[index] = difference / (ratio - 1.0);
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
        let (mut finer, mut times) = (self.now.clone(), vec![0_i32; self.now.len()]);
        let even = UNKNOWN / self.now.len() as f64;
        let mut expected: Vec<f64> =
            self.errors.iter().map(|error| if error.is_finite() { *error } else { even }).collect();
        let known: f64 = expected.iter().sum();
        let surplus = self.believed_surplus();
        while expected.iter().sum::<f64>() > share || self.error().is_infinite() && finer == self.now {
            let is_far = self.surplus.is_some() && expected.iter().sum::<f64>() > FAR * share;
            let at_once = |index: usize| {
                let is_unknown = self.errors[index].is_infinite() && self.now[index].raises_order();
                if is_far || is_unknown { AT_ONCE } else { 1 }
            };
            let able =
                (0..finer.len()).filter(|&index| times[index] < at_once(index) && finer[index].finer().is_some());
            let Some(index) = able.max_by(|&a, &b| expected[a].total_cmp(&expected[b])) else { break };
            let Some((group, ratio)) = finer[index].finer() else { break };
            finer[index] = group;
            times[index] += 1;
            expected[index] /= (ratio * surplus).clamp(BELIEVED[0], BELIEVED[1]);
        }
        if finer == self.now {
            return Ok(false);
        }
        if !is_affordable(&finer) {
            return Err("it would have more than 100,000 elements".to_owned());
        }
        let assumed = (known / expected.iter().sum::<f64>() / surplus).max(BELIEVED[0]);
        let run = pilots.run(&self.sets(&finer))?;
        let difference = pilots.difference(&run, &self.observed)?;
        if let Some((last, before)) = self.last {
            let measured = 1.0 + last / difference.size * (1.0 - 1.0 / assumed);
            if last < CONVERGES * difference.size && difference.size > share {
                self.go_back(pilots, &run, difference.size);
                return Err(format!(
                    "results of finer meshes differ by {} from those of this one, in the {}, and not less than before. Motion that amplifies \
                     small changes, or buckling between elements, may cause this",
                    two_digits(difference.size),
                    difference.of
                ));
            }
            self.surplus = Some(measured / before);
        }
        let most = BELIEVED[1].powi(times.into_iter().max().unwrap_or(1));
        let apart = (assumed * self.believed_surplus()).clamp(BELIEVED[0], most);
        let error = difference.size / (apart - 1.0);
        let sum: f64 = expected.iter().sum();
        expected.iter_mut().for_each(|expected| *expected *= error / sum);
        self.worst = difference.of;
        (self.last, self.errors) = (Some((difference.size, assumed)), expected);
        let before = std::mem::replace(&mut self.observed, run);
        self.earlier.push((std::mem::replace(&mut self.now, finer), apart, before));
        Ok(true)
    }

    /// Goes back to the coarsest mesh that differs no more from the `finest` than the last one does, by `difference`. This difference is then the
    /// estimated error.
    fn go_back(&mut self, pilots: &Pilots, finest: &PilotRun, difference: f64) {
        let least = |run: &PilotRun| {
            let size = pilots.difference(finest, run).ok()?.size;
            (size <= NO_WORSE * difference).then_some(size.max(difference))
        };
        // No mesh becomes coarser than in the deck.
        let earlier = std::mem::take(&mut self.earlier).into_iter();
        let mut allowed = earlier.skip_while(|(mesh, ..)| *mesh != self.base);
        let no_worse = allowed.find_map(|(mesh, _, run)| Some((least(&run)?, mesh, run)));
        let mut error = difference;
        if let Some(chosen) = no_worse {
            (error, self.now, self.observed) = chosen;
        }
        self.errors.fill(error / self.now.len() as f64);
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
