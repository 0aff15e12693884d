//! stub
use crate::math::quadrature::gauss;
/// A part of a section that has one stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fibre {
    pub area: f64,
    pub y: f64,
    pub z: f64,
    pub shear: [[f64; 3]; 2],
}
pub fn rectangle(w: f64, h: f64, counts: [usize; 2]) -> Vec<Fibre> {
    let axis = |l: f64, n: usize| -> Vec<(f64, f64)> {
        let (p, wt) = gauss(2);
        let cells = n / 2;
        (0..cells)
            .flat_map(|c| {
                (0..2).map(move |i| {
                    let d = l / cells as f64;
                    (-0.5 * l + d * (c as f64 + 0.5 * (1.0 + p[i])), 0.5 * d * wt[i])
                })
            })
            .collect()
    };
    let (ys, zs) = (axis(w, counts[0]), axis(h, counts[1]));
    let k = (5.0f64 / 6.0).sqrt();
    ys.iter()
        .flat_map(|&(y, wy)| {
            zs.iter().map(move |&(z, wz)| Fibre { area: wy * wz, y, z, shear: [[k, 0.0, -z], [0.0, k, y]] })
        })
        .collect()
}
pub fn flattened(fibres: &[Fibre], along_z: bool) -> Vec<Fibre> {
    let mut out: Vec<Fibre> = Vec::new();
    for f in fibres {
        let c = if along_z { f.z } else { f.y };
        let s = if along_z { f.shear[1][1] } else { f.shear[0][0] };
        let key = |g: &Fibre| if along_z { g.z } else { g.y };
        if let Some(g) = out.iter_mut().find(|g| (key(g) - c).abs() < 1e-9) {
            g.area += f.area;
            continue;
        }
        let shear = if along_z { [[0.0, s, 0.0], [0.0; 3]] } else { [[s, 0.0, 0.0], [0.0; 3]] };
        out.push(Fibre { area: f.area, y: if along_z { 0.0 } else { c }, z: if along_z { c } else { 0.0 }, shear });
    }
    out
}
