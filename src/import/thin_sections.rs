//! Sections by their walls or integrals: SECTION=HEX, ARBITRARY, TRAPEZOID, CHANNEL and HAT, and boxes of unlike walls.

use crate::file_content::SectionValue;

/// Keys of a section of the deck, and the place of its centroid from the node.
pub type KeysAndCentroid = (Vec<(&'static str, SectionValue)>, [f64; 2]);

/// The sums over the walls of a section.
struct Integrals {
    area: f64,
    /// Second moments about the first and the second axis, and the product moment.
    moments: [f64; 3],
    torsion: f64,
    /// The part of the area that shear acts on.
    shear: f64,
}

impl Integrals {
    fn keys(&self) -> Vec<(&'static str, SectionValue)> {
        use SectionValue::{Number, Numbers, Word};
        let [first, second, product] = self.moments;
        let shear = self.shear * self.area;
        let mut keys = vec![
            ("shape", Word("general")),
            ("area", Number(self.area)),
            ("moments", Numbers(vec![first, second])),
            ("torsion_constant", Number(self.torsion)),
            ("shear_areas", Numbers(vec![shear, shear])),
        ];
        if product != 0.0 {
            keys.push(("product_moment", Number(product)));
        }
        keys
    }
}

/// A regular hexagon by the radius of its corners and the thickness of its walls; the shear factor is that of Abaqus.
pub fn hexagon(radius: f64, thickness: f64) -> Result<KeysAndCentroid, String> {
    let root = 3.0_f64.sqrt();
    let inner = radius - 2.0 * thickness / root;
    if !(thickness > 0.0 && inner > 0.0) {
        return Err("the walls of this hexagon are thicker than its radius allows".to_owned());
    }
    let side = radius - thickness / root;
    let moment = 5.0 * root / 16.0 * (radius.powi(4) - inner.powi(4));
    let enclosed = 1.5 * root * side * side;
    let integrals = Integrals {
        area: 1.5 * root * (radius * radius - inner * inner),
        moments: [moment, moment, 0.0],
        torsion: 4.0 * enclosed * enclosed * thickness / (6.0 * side),
        shear: 0.53,
    };
    Ok((integrals.keys(), [0.0; 2]))
}

/// A trapezoid by the width of its base, its height, the width of its top, and the height of the node over the base. Saint-Venant's estimate
/// gives the torsion constant; the shear factor is that of Abaqus.
pub fn trapezoid(sizes: &[f64]) -> Result<KeysAndCentroid, String> {
    let [base, height, top, node, ..] = *sizes else { return Err("a trapezoid has four sizes".to_owned()) };
    if !(base >= 0.0 && top >= 0.0 && base + top > 0.0 && height > 0.0) {
        return Err("the height and a width of this trapezoid must be above zero".to_owned());
    }
    let (sum, squares) = (base + top, base * base + top * top);
    let area = 0.5 * sum * height;
    let first = height.powi(3) * (squares + 4.0 * base * top) / (36.0 * sum);
    let second = height * sum * squares / 48.0;
    let torsion = area.powi(4) / (40.0 * (first + second));
    let integrals = Integrals { area, moments: [first, second, 0.0], torsion, shear: 0.822 };
    Ok((integrals.keys(), [0.0, height * (base + 2.0 * top) / (3.0 * sum) - node]))
}

/// A box by its width and height and the thickness of its walls towards +1, +2, −1 and −2, where the node is in the middle. Bredt's formula
/// gives the torsion constant; walls along a force take its shear.
pub fn box_of_unlike_walls(sizes: &[f64]) -> Result<KeysAndCentroid, String> {
    use SectionValue::{Number, Numbers, Word};
    let [a, b, right, top, left, bottom, ..] = *sizes else { return Err("a box has six sizes".to_owned()) };
    let inner = [a - left - right, b - bottom - top];
    if [right, top, left, bottom].iter().chain(&inner).any(|size| *size <= 0.0) {
        return Err("the walls of a box have a thickness, and leave a hollow".to_owned());
    }
    let hollow = [0.5 * (left - right), 0.5 * (bottom - top)];
    let hole = inner[0] * inner[1];
    let area = a * b - hole;
    let center = hollow.map(|x| -hole * x / area);
    // Parallel axes: the solid about the middle, less the hollow, moved to the centroid.
    let second = |i: usize, sides: [f64; 2]| {
        let solid = sides[1 - i] * sides[i].powi(3) / 12.0;
        let less = inner[1 - i] * inner[i].powi(3) / 12.0 + hole * hollow[i] * hollow[i];
        solid - less - area * center[i] * center[i]
    };
    let product = -hole * hollow[0] * hollow[1] - area * center[0] * center[1];
    let [width, height] = [a - 0.5 * (left + right), b - 0.5 * (bottom + top)];
    let flow = height / left + height / right + width / bottom + width / top;
    let mut keys = vec![
        ("shape", Word("general")),
        ("area", Number(area)),
        ("moments", Numbers(vec![second(1, [a, b]), second(0, [a, b])])),
        ("torsion_constant", Number(4.0 * (width * height).powi(2) / flow)),
        ("shear_areas", Numbers(vec![width * (bottom + top), height * (left + right)])),
    ];
    if product != 0.0 {
        keys.push(("product_moment", Number(product)));
    }
    Ok((keys, center))
}

/// A channel, whose flanges point along +1. Its sizes are the height of the node over its lower side, its height, and the widths of the lower and
/// the upper flange. Then come the thicknesses of both and of the web, and the place of the node from the back of the web.
pub fn channel(sizes: &[f64]) -> Result<KeysAndCentroid, String> {
    use SectionValue::{Number, Word};
    let [l, height, lower, upper, below, above, web, o, ..] = *sizes else { return Err(needs_eight("CHANNEL")) };
    if [height, lower, upper, below, above, web].iter().any(|size| *size <= 0.0)
        || web >= lower.min(upper)
        || below + above >= height
    {
        return Err("a channel has a web that leaves flanges, and flanges that leave a web".to_owned());
    }
    let (back, top) = (0.5 * web, height - 0.5 * above);
    let points = [[upper, top], [back, top], [back, 0.5 * below], [lower, 0.5 * below]];
    let (mut keys, [mut y, z]) = walls(&points, &[above, web, below], false);
    if lower == upper && below == above {
        // The centroid of a web over the whole height and of two plates beside it.
        let [back, plates] = [height * web, 2.0 * (lower - web) * below];
        y = 0.5 * (back * web + plates * (lower + web)) / (back + plates);
        keys = vec![
            ("shape", Word("c")),
            ("height", Number(height)),
            ("width", Number(lower)),
            ("web_thickness", Number(web)),
            ("flange_thickness", Number(below)),
        ];
    }
    Ok((keys, [y - o, z - l]))
}

/// A hat, whose webs join the ends of top and rims. Its sizes are the height of the node over its lower side, its height, its width below, and the
/// widths of its top and of each rim. Then come the thicknesses of top, rims and webs.
pub fn hat(sizes: &[f64]) -> Result<KeysAndCentroid, String> {
    let [l, height, width, top, rim, above, below, web, ..] = *sizes else { return Err(needs_eight("HAT")) };
    let is_thin = 0.5 * (above + below) < height && 2.0 * rim < width;
    if !is_thin || [top, rim, above, below, web].iter().any(|size| *size <= 0.0) {
        return Err("a hat has walls, a height above their thickness, and rims below its width".to_owned());
    }
    let right = [[0.5 * top, height - 0.5 * above], [0.5 * width - rim, 0.5 * below], [0.5 * width, 0.5 * below]];
    let left = right.iter().rev().map(|[y, z]| [-y, *z]);
    let points: Vec<[f64; 2]> = left.chain(right).collect();
    let (keys, [y, z]) = walls(&points, &[below, web, above, web, below], false);
    Ok((keys, [y, z - l]))
}

fn needs_eight(word: &str) -> String {
    format!("SECTION={word} needs 8 numbers on the line below")
}

/// A line of walls through points; `rows`: the number of walls, the first two points and a thickness, then a point and a thickness each.
pub fn arbitrary(rows: &[Vec<f64>]) -> Result<KeysAndCentroid, String> {
    let count = rows.first().and_then(|row| row.first()).map_or(0, |count| *count as usize);
    let Some([_, a, b, c, d, t]) = rows.first().map(Vec::as_slice) else {
        return Err(
            "SECTION=ARBITRARY needs the number of walls, two points and a thickness on the line below".to_owned()
        );
    };
    let (mut points, mut thicknesses) = (vec![[*a, *b], [*c, *d]], vec![*t]);
    for row in rows.iter().take(count).skip(1) {
        let [x, y, t] = row[..] else { return Err("a further wall has a point and a thickness".to_owned()) };
        points.push([x, y]);
        thicknesses.push(t);
    }
    if thicknesses.len() != count {
        return Err(format!("SECTION=ARBITRARY lacks some of its {count} walls"));
    }
    let meets = |k: usize| points[k + 1..].contains(&points[k]);
    let is_closed = points.first() == points.last();
    if (0..points.len()).any(|k| meets(k) && !(is_closed && k == 0)) || thicknesses.iter().any(|t| *t <= 0.0) {
        return Err("the walls of a section form one line, open or closed, and have a thickness".to_owned());
    }
    Ok(walls(&points, &thicknesses, is_closed))
}

fn walls(points: &[[f64; 2]], thicknesses: &[f64], is_closed: bool) -> KeysAndCentroid {
    let all = || points.windows(2).zip(thicknesses).map(|(ends, t)| (ends[0], ends[1], *t));
    let length = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
    let area: f64 = all().map(|(p, q, t)| length(p, q) * t).sum();
    let center: [f64; 2] =
        [0, 1].map(|i| all().map(|(p, q, t)| 0.5 * (p[i] + q[i]) * length(p, q) * t).sum::<f64>() / area);
    // Moments of a wall: those of its middle line, and of its thickness across.
    let second = |i: usize, j: usize| -> f64 {
        all()
            .map(|(p, q, t)| {
                let l = length(p, q);
                let (along, across) = ([(q[0] - p[0]) / l, (q[1] - p[1]) / l], [(p[1] - q[1]) / l, (q[0] - p[0]) / l]);
                let middle = [0, 1].map(|k| 0.5 * (p[k] + q[k]) - center[k]);
                let own = l * l / 12.0 * along[i] * along[j] + t * t / 12.0 * across[i] * across[j];
                l * t * (middle[i] * middle[j] + own)
            })
            .sum()
    };
    let open: f64 = all().map(|(p, q, t)| length(p, q) * t.powi(3) / 3.0).sum();
    let enclosed: f64 = 0.5 * all().map(|(p, q, _)| p[0] * q[1] - p[1] * q[0]).sum::<f64>();
    let flow: f64 = all().map(|(p, q, t)| length(p, q) / t).sum();
    let closed = if is_closed { 4.0 * enclosed * enclosed / flow } else { 0.0 };
    let integrals =
        Integrals { area, moments: [second(1, 1), second(0, 0), second(0, 1)], torsion: open + closed, shear: 1.0 };
    (integrals.keys(), center)
}
