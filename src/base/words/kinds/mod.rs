//! Tables whose keys depend on a word in them: the scheme of the integrator, the shape of a section, the kind of a joint.
//!
//! A kind states its word and its keys as a [`Kind`] in the file that computes with it, and its room lists all of them. A
//! table that is [`OneOf`] a room's kinds takes the keys of all of them; which belong to the kind that was chosen is asked
//! afterwards, by [`Given`], so that one mistake hides no other.

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
