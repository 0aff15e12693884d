//! Edges and folds of meshes that contacts look at.

use rdsolve::math::Vec3;
use rdsolve::model::inner::{MeshEdge, mesh_edges};

/// A roof of two squares, the ridge along y at the height given, with eaves at x = ±1.
fn roof(height: f64) -> Vec<MeshEdge> {
    let places = [-1.0, 0.0, 1.0].map(|x: f64| [x, if x == 0.0 { height } else { 0.0 }]);
    let x = |node: usize| Vec3::new(places[node % 3][0], (node / 3) as f64, places[node % 3][1]);
    mesh_edges(&[vec![0, 1, 4, 3], vec![1, 2, 5, 4]], x)
}

/// A straight thing two long whose ends touch either slope of a roof at 45° lies 1/√2 below its ridge; from below nothing lies over it, nor on a
/// flat sheet.
#[test]
fn folds_bulge_to_one_side() {
    let fold = |height: f64| roof(height).into_iter().find(|edge| !edge.is_border).unwrap();
    let (above, below) = (Vec3::new(0.0, 0.5, 3.0), Vec3::new(0.0, 0.5, -3.0));
    assert!((fold(1.0).sink(&above, 2.0) - 0.5f64.sqrt()).abs() < 1e-15);
    assert_eq!(fold(1.0).sink(&below, 2.0), 0.0);
    assert_eq!((fold(-1.0).sink(&above, 2.0), fold(-1.0).sink(&below, 2.0) > 0.7), (0.0, true));
    assert!(fold(0.0).sink(&above, 2.0) < 1e-15 && fold(0.0).sink(&below, 2.0) < 1e-15);
}

/// The border is six of seven edges, and something above the eaves is as far from them as it is along the slope.
#[test]
fn borders_are_edges_of_one_face() {
    let edges = roof(0.0);
    assert_eq!((edges.len(), edges.iter().filter(|edge| edge.is_border).count()), (7, 6));
    let place = Vec3::new(0.75, 0.5, 9.0);
    let nearest = edges.iter().filter(|edge| edge.is_border).map(|edge| edge.distance(&place));
    assert_eq!(nearest.fold(f64::INFINITY, f64::min), 0.25);
}
