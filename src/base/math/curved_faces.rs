//! Curved faces: triangles of six nodes and quadrilaterals of nine, with shape functions of second degree.
//!
//! Node order of Gmsh, Abaqus and VTK: corners, then nodes on the sides from the first side on, then the middle node. Serendipity functions
//! give the middle of an eight-node quadrilateral.

use super::Vec3;

/// A face of N nodes over its coordinates (r, s).
pub trait CurvedFace<const N: usize>: Send + Sync + Sized + 'static {
    /// The number of corners.
    const CORNERS: usize;
    /// Coordinates of the nodes.
    const NODES: [[f64; 2]; N];
    /// Points and weights of a rule that is exact for the areas of the nodes of a flat face and their products two by two.
    const RULE: &'static [([f64; 2], f64)];
    /// Shape functions.
    fn values(at: [f64; 2]) -> [f64; N];
    /// Their derivatives by r and s.
    fn slopes(at: [f64; 2]) -> [[f64; N]; 2];
}

/// Nodes 0, 1, 2 at the corners, 3, 4, 5 on the sides 0-1, 1-2 and 2-0; r and s are 1 at nodes 1 and 2.
pub struct SixNodes;

/// Nodes 0 to 3 at the corners, 4 to 7 on the sides, 8 in the middle; r and s from −1 to 1.
pub struct NineNodes;

/// Strang & Fix: six points, of fourth degree.
const A: f64 = 0.445_948_490_915_964_9;
const B: f64 = 0.091_576_213_509_770_74;
const WA: f64 = 0.111_690_794_839_005_73;
const WB: f64 = 0.054_975_871_827_660_94;

impl CurvedFace<6> for SixNodes {
    const CORNERS: usize = 3;
    const NODES: [[f64; 2]; 6] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]];
    const RULE: &'static [([f64; 2], f64)] = &[
        ([A, A], WA),
        ([1.0 - 2.0 * A, A], WA),
        ([A, 1.0 - 2.0 * A], WA),
        ([B, B], WB),
        ([1.0 - 2.0 * B, B], WB),
        ([B, 1.0 - 2.0 * B], WB),
    ];

    fn values([r, s]: [f64; 2]) -> [f64; 6] {
        let t = 1.0 - r - s;
        [t * (2.0 * t - 1.0), r * (2.0 * r - 1.0), s * (2.0 * s - 1.0), 4.0 * t * r, 4.0 * r * s, 4.0 * s * t]
    }

    fn slopes([r, s]: [f64; 2]) -> [[f64; 6]; 2] {
        let t = 1.0 - r - s;
        [
            [1.0 - 4.0 * t, 4.0 * r - 1.0, 0.0, 4.0 * (t - r), 4.0 * s, -4.0 * s],
            [1.0 - 4.0 * t, 0.0, 4.0 * s - 1.0, -4.0 * r, 4.0 * r, 4.0 * (t - s)],
        ]
    }
}

/// Gauss's three points and their weights.
const G: f64 = 0.774_596_669_241_483_4;
const OUT: f64 = 5.0 / 9.0;
const MID: f64 = 8.0 / 9.0;
/// Indices of the two one-dimensional functions of each node along r and s; 0 and 2 are the ends.
const ALONG: [[usize; 2]; 9] = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1]];

fn line(r: f64) -> [f64; 3] {
    [0.5 * r * (r - 1.0), 1.0 - r * r, 0.5 * r * (r + 1.0)]
}

fn line_slopes(r: f64) -> [f64; 3] {
    [r - 0.5, -2.0 * r, r + 0.5]
}

impl CurvedFace<9> for NineNodes {
    const CORNERS: usize = 4;
    const NODES: [[f64; 2]; 9] = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
        [0.0, 0.0],
    ];
    const RULE: &'static [([f64; 2], f64)] = &[
        ([-G, -G], OUT * OUT),
        ([0.0, -G], MID * OUT),
        ([G, -G], OUT * OUT),
        ([-G, 0.0], OUT * MID),
        ([0.0, 0.0], MID * MID),
        ([G, 0.0], OUT * MID),
        ([-G, G], OUT * OUT),
        ([0.0, G], MID * OUT),
        ([G, G], OUT * OUT),
    ];

    fn values([r, s]: [f64; 2]) -> [f64; 9] {
        let (a, b) = (line(r), line(s));
        ALONG.map(|[i, j]| a[i] * b[j])
    }

    fn slopes([r, s]: [f64; 2]) -> [[f64; 9]; 2] {
        let (a, b, by_r, by_s) = (line(r), line(s), line_slopes(r), line_slopes(s));
        [ALONG.map(|[i, j]| by_r[i] * b[j]), ALONG.map(|[i, j]| a[i] * by_s[j])]
    }
}

/// The number of corners of a face of 3, 4, 6, 8 or 9 nodes.
pub fn corners(nodes: usize) -> usize {
    if nodes.is_multiple_of(3) && nodes < 9 { 3 } else { 4 }
}

/// The places of the nodes round a face, in order: corners and, where it is curved, the nodes on the sides between them.
pub fn ring(nodes: usize) -> impl Iterator<Item = usize> + Clone {
    let n = corners(nodes);
    let each = if nodes > n { 2 } else { 1 };
    (0..each * n).map(move |k| if each == 1 || k % 2 == 0 { k / each } else { n + k / 2 })
}

/// Flat faces that cover a face of 3, 4, 6 or 9 nodes, by the places of their corners.
pub fn facets(nodes: usize) -> &'static [&'static [usize]] {
    match nodes {
        3 => &[&[0, 1, 2]],
        4 => &[&[0, 1, 2, 3]],
        6 => &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        9 => &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
        _ => &[],
    }
}

/// The middle of a quadrilateral of eight nodes at `x`, by the serendipity functions.
pub fn middle_of_eight(x: impl Fn(usize) -> Vec3) -> Vec3 {
    (0..8).map(|a| if a < 4 { -0.25 * x(a) } else { 0.5 * x(a) }).sum()
}

/// Tangents along r and s at each node of a curved face of 6, 8 or 9 nodes at `x`; of eight also in the middle.
pub fn tangents_of(nodes: usize, x: &impl Fn(usize) -> Vec3) -> Vec<[Vec3; 2]> {
    fn of<F: CurvedFace<N>, const N: usize>(x: impl Fn(usize) -> Vec3) -> Vec<[Vec3; 2]> {
        let sum = |by: &[f64; N]| (0..N).map(|a| by[a] * x(a)).sum();
        F::NODES.iter().map(|&at| F::slopes(at).each_ref().map(sum)).collect()
    }
    match nodes {
        6 => of::<SixNodes, 6>(x),
        8 => of::<NineNodes, 9>(|a| if a == 8 { middle_of_eight(x) } else { x(a) }),
        _ => of::<NineNodes, 9>(x),
    }
}

/// ∫ N_a N_b dA over a curved face whose nodes are at `x`.
pub fn products<F: CurvedFace<N>, const N: usize>(x: &[Vec3; N]) -> [[f64; N]; N] {
    let mut sums = [[0.0; N]; N];
    for &(at, w) in F::RULE {
        let [a, b] = F::slopes(at).map(|by| (0..N).map(|a| by[a] * x[a]).sum::<Vec3>());
        let (values, w) = (F::values(at), w * a.cross(&b).norm());
        for a in 0..N {
            (0..N).for_each(|b| sums[a][b] += w * values[a] * values[b]);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shape functions are one at their node, and their slopes are those of their values. Bound: truncation of differences.
    fn is_sound<F: CurvedFace<N>, const N: usize>() {
        for a in 0..N {
            let values = F::values(F::NODES[a]);
            assert!((0..N).all(|b| (values[b] - f64::from(u8::from(a == b))).abs() < 1e-15));
        }
        let at = [0.3, 0.2];
        let slopes = F::slopes(at);
        for k in 0..2 {
            let by = |h: f64| F::values(std::array::from_fn(|i| at[i] + if i == k { h } else { 0.0 }));
            let (ahead, behind) = (by(1e-5), by(-1e-5));
            assert!((0..N).all(|a| ((ahead[a] - behind[a]) / 2e-5 - slopes[k][a]).abs() < 1e-10));
        }
    }

    #[test]
    fn shape_functions() {
        is_sound::<SixNodes, 6>();
        is_sound::<NineNodes, 9>();
    }

    /// A flat rule: areas, and the products of a straight triangle, (6, 32)/180 of twice its area on the diagonal.
    #[test]
    fn products_are_exact() {
        let six = products::<SixNodes, 6>(&SixNodes::NODES.map(|[r, s]| Vec3::new(r, s, 0.0)));
        assert!((six.iter().flatten().sum::<f64>() - 0.5).abs() < 1e-15);
        assert!((six[0][0] - 6.0 / 360.0).abs() < 1e-15 && (six[3][3] - 32.0 / 360.0).abs() < 1e-15);
        let nine = products::<NineNodes, 9>(&NineNodes::NODES.map(|[r, s]| Vec3::new(r, s, 0.0)));
        assert!((nine[0][0] - 16.0 / 225.0).abs() < 1e-15 && (nine[8][8] - 256.0 / 225.0).abs() < 1e-14);
    }

    #[test]
    fn nodes_go_round() {
        assert_eq!(ring(3).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!(ring(6).collect::<Vec<_>>(), [0, 3, 1, 4, 2, 5]);
        assert_eq!(ring(8).collect::<Vec<_>>(), [0, 4, 1, 5, 2, 6, 3, 7]);
        assert_eq!(ring(9).collect::<Vec<_>>(), [0, 4, 1, 5, 2, 6, 3, 7]);
    }
}
