//! Where a picture of the scene is seen from. The page begins with the same view, in camera.js.

/// The directions of the view in radians: about z from x, and above the plane.
const HOME: [f64; 2] = [-1.05, 0.4];
/// The distance from the centre, as a part of the diagonal of the scene.
const DISTANCE: f64 = 1.4;
/// A side below this part of the diagonal makes a scene plane.
const PLANE: f64 = 1e-3;

/// The difference of two vectors.
pub fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// The vector product.
pub fn product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length of a vector.
pub fn span(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The scalar product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// A view that fills a picture with the scene.
pub struct ScreenView {
    centre: [f64; 3],
    distance: f64,
    /// Right, up, and out of the screen.
    axes: [[f64; 3]; 3],
    /// Pixels for one length at the distance of the centre.
    scale: f64,
    /// The pixel of the centre.
    middle: [f64; 2],
}

impl ScreenView {
    /// A view of points in a picture of a size in pixels, between its rims: upper, lower and at the sides.
    pub fn of(points: impl Iterator<Item = [f64; 3]> + Clone, size: [f64; 2], rims: [f64; 3]) -> ScreenView {
        let [least, most] = bounds(points.clone());
        let sides = minus(most, least);
        let whole = if span(sides) > 0.0 { span(sides) } else { 1.0 };
        let mut sight = ScreenView {
            centre: [0, 1, 2].map(|i| 0.5 * (least[i] + most[i])),
            distance: DISTANCE * whole,
            axes: directions(sides, whole),
            scale: 1.0,
            middle: [0.0; 2],
        };
        let seen = points.map(|p| sight.place(p)).map(|[x, y]| [x, y, 0.0]);
        let [low, high] = bounds(seen.collect::<Vec<_>>().into_iter());
        let room = [size[0] - 2.0 * rims[2], size[1] - rims[0] - rims[1]];
        let fit = |i: usize| room[i] / (high[i] - low[i]).max(1e-3 * whole);
        sight.scale = fit(0).min(fit(1));
        let rim = [rims[2], rims[0]];
        sight.middle = [0, 1].map(|i| rim[i] + 0.5 * room[i] - 0.5 * sight.scale * (low[i] + high[i]));
        sight
    }

    /// The pixel of a point.
    pub fn place(&self, point: [f64; 3]) -> [f64; 2] {
        let from = minus(point, self.centre);
        let [right, up, out] = self.axes.map(|axis| dot(axis, from));
        let nearer = self.scale * self.distance / (self.distance - out);
        [self.middle[0] + nearer * right, self.middle[1] - nearer * up]
    }

    /// The component of a vector out of the screen.
    pub fn toward(&self, vector: [f64; 3]) -> f64 {
        dot(self.axes[2], vector)
    }

    /// The right and the upward component of a global axis.
    pub fn axis(&self, axis: usize) -> [f64; 2] {
        [self.axes[0][axis], self.axes[1][axis]]
    }

    /// Pixels for one length at the distance of the centre.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The diagonal of the scene.
    pub fn whole(&self) -> f64 {
        self.distance / DISTANCE
    }
}

/// From in front, a little from the side and above; straight at a scene that is plane.
fn directions(sides: [f64; 3], whole: f64) -> [[f64; 3]; 3] {
    let thin = |axis: usize| sides[axis] < PLANE * whole;
    let right_angle = std::f64::consts::FRAC_PI_2;
    let [yaw, pitch] = match () {
        () if thin(1) => [-right_angle, 0.0],
        () if thin(2) => [-right_angle, right_angle],
        () if thin(0) => [0.0, 0.0],
        () => HOME,
    };
    let ((sy, cy), (sp, cp)) = (yaw.sin_cos(), pitch.sin_cos());
    let (out, right) = ([cp * cy, cp * sy, sp], [-sy, cy, 0.0]);
    [right, product(out, right), out]
}

/// The least and the largest of each component.
fn bounds(points: impl Iterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    points.fold([[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], |[least, most], p| {
        [[0, 1, 2].map(|i| least[i].min(p[i])), [0, 1, 2].map(|i| most[i].max(p[i]))]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_begins_with_the_same_view() {
        let page = include_str!("camera.js");
        for part in [format!("[{}, {}]", HOME[0], HOME[1]), format!("{DISTANCE} * this.whole"), "1e-3 * whole".into()] {
            assert!(page.contains(&part), "{part}");
        }
    }

    /// Points in the plane of the screen through the centre keep their distances, and z stands upright.
    #[test]
    fn a_plane_scene_is_seen_straight_on_and_fills_its_room() {
        let corners = [[0.0, 7.0, 0.0], [2.0, 7.0, 0.0], [2.0, 7.0, 1.0]];
        let sight = ScreenView::of(corners.into_iter(), [240.0, 180.0], [10.0, 20.0, 20.0]);
        let [a, b, c] = corners.map(|corner| sight.place(corner));
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-9, "{x} is not {y}");
        near(a[0], 20.0);
        near(b[0], 220.0);
        near(a[1], 135.0);
        near(c[1], 35.0);
        near(sight.scale(), 100.0);
    }
}
