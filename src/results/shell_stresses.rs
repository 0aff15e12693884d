//! Stress and strain at the nodes of shells.

use base::math::Mat3;
use model::{PartType, Shell};
use solve::Frame;
use std::collections::{BTreeMap, HashMap};

/// Stress and strain at the upper side of shells by node: means over the elements that meet there, global components. Strains are
/// those of the elastic law.
pub fn upper_sides(frame: &Frame) -> [BTreeMap<usize, Mat3>; 2] {
    let mut sums: BTreeMap<usize, (Mat3, Mat3, f64)> = BTreeMap::new();
    let mut counts: HashMap<usize, usize> = HashMap::new();
    for state in &frame.derived.shells {
        let Some(shell) = Shell::of(&frame.model.parts[state.part]) else { continue };
        let next = counts.entry(state.part).or_insert(0);
        let (Some(layer), Some(nodes)) = (state.at.layers().last(), place(shell, state.element, *next)) else {
            continue;
        };
        *next += 1;
        let [a, b, ab] = layer.stress;
        let (modulus, nu) = (shell.plate.E, shell.plate.nu);
        let (ea, eb, eab) = ((a - nu * b) / modulus, (b - nu * a) / modulus, (1.0 + nu) * ab / modulus);
        let across = -nu * (a + b) / modulus;
        let turned = |x: Mat3| state.at.frame * x * state.at.frame.transpose();
        let stress = turned(Mat3::new(a, ab, 0.0, ab, b, 0.0, 0.0, 0.0, 0.0));
        let strain = turned(Mat3::new(ea, eab, 0.0, eab, eb, 0.0, 0.0, 0.0, across));
        for node in nodes {
            let sum = sums.entry(*node).or_insert((Mat3::zeros(), Mat3::zeros(), 0.0));
            (sum.0, sum.1, sum.2) = (sum.0 + stress, sum.1 + strain, sum.2 + 1.0);
        }
    }
    let mean = |of: fn(&(Mat3, Mat3, f64)) -> Mat3| sums.iter().map(|(node, sum)| (*node, of(sum) / sum.2)).collect();
    [mean(|sum| sum.0), mean(|sum| sum.1)]
}

/// The nodes of an element of a shell by the number that the deck's part has for it; `likely` is its place as a rule.
fn place(shell: &Shell, number: usize, likely: usize) -> Option<&[usize]> {
    let all = 0..shell.elements.len();
    let is_it = |at: &usize| shell.number(*at) == number;
    let at = Some(likely).filter(|at| all.contains(at) && is_it(at)).or_else(|| all.clone().find(is_it))?;
    Some(&shell.elements[at].nodes[..shell.size()])
}
