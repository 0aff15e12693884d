//! Points of a hull in the deck.

use base::math::Vec3;
use base::math::polyhedron::{MOST_CORNERS, MOST_POINTS, NoHull, Polyhedron};
use base::words::kinds::{Form, Given, Key};

/// The key of the points.
pub const POINTS: Key = Key {
    name: "points",
    form: Form::Vectors,
    about: "Points, at least four and not in one plane, global axes at t = 0. Inner points are ignored.",
};

/// The hull of the deck's points about its centre, and that centre.
pub fn hull_of(given: &mut Given) -> Option<(Polyhedron, Vec3)> {
    let numbers = given.require("points")?;
    let points: Vec<Vec3> = numbers.chunks_exact(3).map(Vec3::from_column_slice).collect();
    if points.len() > MOST_POINTS {
        let message = format!("a hull of {} points: at most {MOST_POINTS} are allowed", points.len());
        return given.error_with("points", message, "leave out those inside, and corners of blunt edges");
    }
    match Polyhedron::hull(&points) {
        Ok(found) => Some(found),
        Err(NoHull::Flat) => {
            let message = format!("{} points in one plane, or nearly so, have no hull", points.len());
            given.error_with("points", message, "give at least four that do not lie in one plane")
        }
        Err(NoHull::TooManyCorners(count)) => {
            let message = format!("the hull has {count} corners: at most {MOST_CORNERS} are allowed");
            given.error_with(
                "points",
                message,
                "leave out corners of blunt edges, or take a sphere, a capsule or a cylinder",
            )
        }
        Err(NoHull::Ragged) => {
            let message = "some points lie on an edge or a face to some six digits only";
            given.error_with("points", message, "leave them out, or give more digits")
        }
    }
}
