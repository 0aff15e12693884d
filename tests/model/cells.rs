//! Points near segments and triangles.

use rdsolve::math::Vec3;
use rdsolve::model::inner::Cells;

/// Every point near a long segment and a large triangle is met, few others are.
#[test]
fn points_near_pieces_are_met() {
    let grid = (0..100_000).map(|i| (i, Vec3::new((i % 100) as f64, (i / 100 % 100) as f64, (i / 10_000) as f64)));
    let cells = Cells::new(1.0, Vec3::zeros(), grid.clone());
    let segment = [Vec3::new(0.0, 0.0, 3.0), Vec3::new(99.0, 99.0, 3.0)];
    let mut met = std::collections::HashSet::new();
    cells.visit_along(&segment, 1e-6, &mut |point| {
        met.insert(point);
    });
    let on = |x: &Vec3| x.x == x.y && x.z == 3.0;
    assert!(grid.filter(|(_, x)| on(x)).all(|(point, _)| met.contains(&point)));
    assert!(met.len() < 3000, "{}", met.len());
}
