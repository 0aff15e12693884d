//! Tables whose keys depend on a word in them: the scheme of the integrator, the shape of a section, the kind of a joint.
//!
//! A kind states its word and its keys as a [`Kind`] in the file that computes with it, and its room lists all of them. A table that is
//! [`OneOf`] the kinds of a room reads the keys of all kinds. [`Given`] then checks the keys of the chosen kind, so no mistake hides
//! another.

mod form;
mod frame;
mod given;
mod kind;
mod one_of;
mod schema;
mod values;

pub use form::Form;
pub use frame::{axes, unit};
pub use given::Given;
pub use kind::{Key, Kind, Kinds};
pub use one_of::OneOf;
pub use values::Values;
