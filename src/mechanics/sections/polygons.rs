//! The section that polygons of elastic materials make up. Finite elements of the section give its stiffness, so the model room computes it.

use super::section_shape::{CrossSection, MakeSection, SectionKind};
use base::words::kinds::{Form, Given, Key};

/// The shape's word, keys and maker.
pub static KIND: SectionKind = SectionKind {
    word: "polygons",
    aliases: &[],
    guesses: &["polygon", "mesh", "meshed", "outline", "composite"],
    about: "Areas between straight edges, of one or several elastic materials; finite elements of the section give its stiffness.",
    keys: &[
        Key {
            name: "axis",
            form: Form::Pair,
            about: "Place `[y, z]` of the axis of the beam in the coordinates of the polygons. Default: the centroid, where each area counts by its \
                    Young's modulus.",
        },
        Key {
            name: "mesh_size",
            form: Form::Number,
            about: "Length of the edges of the mesh of triangles, above 0. Default: a sixteenth of the root of the area of a polygon, or two thirds of its \
                    area over its perimeter, which is a third of a thin wall, if that is less.",
        },
    ],
    make: MakeSection { read, takes_material: |_| true },
};

fn read(given: &mut Given, _: bool) -> Option<CrossSection> {
    let mesh_size = given.positive("mesh_size");
    if given.has("mesh_size") && mesh_size.is_none() {
        return None;
    }
    let axis = match *given.numbers("axis") {
        [y, z] => Some([y, z]),
        _ => None,
    };
    Some(CrossSection::Polygons { axis, mesh_size })
}
