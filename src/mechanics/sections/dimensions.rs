//! Helpers of several section shapes: checks of dimensions, and properties of rectangles side by side.

/// Area, centroid, and moments about the centroid of rectangles side by side, each as (y, z) of its centre, width, height.
pub fn rectangles(parts: &[([f64; 2], f64, f64)]) -> (f64, [f64; 2], [f64; 3]) {
    let area = parts.iter().map(|(_, w, h)| w * h).sum::<f64>();
    let mean = |axis: usize| parts.iter().map(|(c, w, h)| w * h * c[axis]).sum::<f64>() / area;
    let center = [mean(0), mean(1)];
    let mut moments = [0.0; 3];
    for (c, w, h) in parts {
        let (y, z) = (c[0] - center[0], c[1] - center[1]);
        moments[0] += w * h * (z * z + h * h / 12.0);
        moments[1] += w * h * (y * y + w * w / 12.0);
        moments[2] += w * h * y * z;
    }
    (area, center, moments)
}

/// Area, centroid, and moments about the centroid of a polygon, its corners (y, z) counter-clockwise.
pub fn polygon(corners: &[[f64; 2]]) -> (f64, [f64; 2], [f64; 3]) {
    let (mut area, mut first, mut second) = (0.0, [0.0; 2], [0.0; 3]);
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let cross = a[0] * b[1] - b[0] * a[1];
        let square = |axis: usize| a[axis] * a[axis] + a[axis] * b[axis] + b[axis] * b[axis];
        area += 0.5 * cross;
        first = [0, 1].map(|axis| first[axis] + cross * (a[axis] + b[axis]) / 6.0);
        second[0] += cross * square(1) / 12.0;
        second[1] += cross * square(0) / 12.0;
        second[2] += cross * (a[0] * b[1] + 2.0 * a[0] * a[1] + 2.0 * b[0] * b[1] + b[0] * a[1]) / 24.0;
    }
    let [y, z] = first.map(|moment| moment / area);
    let about = [second[0] - area * z * z, second[1] - area * y * y, second[2] - area * y * z];
    (area, [y, z], about)
}

/// Every dimension must be a positive number.
pub fn positive(dimensions: &[(&str, f64)]) -> Result<(), String> {
    match dimensions.iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)) {
        Some((key, value)) => Err(format!("`{key}` is {value}, but must be a positive number")),
        None => Ok(()),
    }
}

/// `part` must be smaller than `whole`; `rule` says why.
pub fn smaller(part: (&str, f64), whole: (&str, f64), rule: &str) -> Result<(), String> {
    if part.1 < whole.1 {
        return Ok(());
    }
    Err(format!("`{}` is {}, but {rule} {} = {}", part.0, part.1, whole.0, whole.1))
}
