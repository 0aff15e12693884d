//! Shell elements laid out in packs of eight, where explicit schemes ask for forces alone.

use super::camber::Camber;
use super::edge_bending::EdgeBending;
use super::interpolation::Interpolation;
use super::kinematics::Shell;
use super::lanes::ShellPack;
use super::packed::{InPlaneLanes, PackedSections};
use super::section::ShellSection;
use base::math::lanes::{LANES, Lanes, lanes};
use base::math::number::LaneVec3;
use std::array::from_fn;

/// Up to eight elements, with their sections side by side.
#[inline(always)]
pub(super) fn shell_pack<
    K: Interpolation<N, V, P>,
    const N: usize,
    const V: usize,
    const P: usize,
    const E: usize,
    S,
    B,
>(
    elements: &[Shell<N, V, P, E, S>],
    sections: B,
) -> ShellPack<N, V, P, E, B> {
    let at = |lane: usize| &elements[lane.min(elements.len() - 1)];
    let of = |value: &dyn Fn(&Shell<N, V, P, E, S>) -> f64| lanes(|lane| value(at(lane)));
    ShellPack {
        count: elements.len(),
        nodes: from_fn(|a| from_fn(|lane| at(lane).nodes[a])),
        axes: from_fn(|a| {
            [
                LaneVec3::gather(|lane| at(lane).D[a]),
                LaneVec3::gather(|lane| at(lane).T[a][0]),
                LaneVec3::gather(|lane| at(lane).T[a][1]),
            ]
        }),
        slopes: from_fn(|i| from_fn(|a| of(&|e| e.slopes[i][a]))),
        arc: from_fn(|i| from_fn(|j| of(&|e| e.arc[i][j]))),
        camber: if K::CAMBERED {
            Camber(from_fn(|m| from_fn(|n| from_fn(|k| of(&|e| e.camber().0[m][n][k])))))
        } else {
            Camber([[[Lanes::ZERO; 3]; 3]; 3])
        },
        edges: from_fn(|i| from_fn(|j| from_fn(|k| of(&|e| e.edges[i].0[j][k])))),
        start: InPlaneLanes {
            membrane: from_fn(|i| of(&|e| e.start.plane.membrane[i])),
            bending: from_fn(|i| of(&|e| e.start.plane.bending[i])),
        },
        start_shear: from_fn(|i| of(&|e| e.start.shear[i])),
        shear: from_fn(|i| from_fn(|j| of(&|e| e.shear[i][j]))),
        bent: if K::EDGES_BEND {
            EdgeBending(from_fn(|i| from_fn(|j| of(&|e| e.bent.0[i][j]))))
        } else {
            EdgeBending([[Lanes::ZERO; N]; 3])
        },
        sections,
    }
}

/// Elements in packs of eight; none where their sections must be computed one by one.
pub(super) fn pack<
    K: Interpolation<N, V, P>,
    const N: usize,
    const V: usize,
    const P: usize,
    const E: usize,
    S: ShellSection<P, E>,
>(
    elements: &[Shell<N, V, P, E, S>],
) -> Vec<ShellPack<N, V, P, E, S::Packed>> {
    let of = |elements: &[Shell<N, V, P, E, S>]| {
        let sections: Vec<&S> = elements.iter().map(|element| &element.section).collect();
        S::Packed::pack(&sections).map(|sections| shell_pack::<K, N, V, P, E, S, _>(elements, sections))
    };
    elements.chunks(LANES).map(of).collect::<Option<_>>().unwrap_or_default()
}
