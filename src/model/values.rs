//! Conversions of values from the deck.

use super::data::DIRECTIONS;
use base::diagnostic::Span;
use base::math::Vec3;
use base::names::joined;
use deck::words::{Maybe, Vector};

/// The vector of three numbers of the deck.
pub(super) fn vec3(value: &Vector) -> Vec3 {
    Vec3::from(value.0)
}

/// The vector behind a key, zero where it is not written.
pub(super) fn vec3_or_zero(value: &Maybe<Vector>) -> Vec3 {
    value.as_ref().map_or_else(Vec3::zeros, |value| vec3(value))
}

/// The place of the value of a key; `None` where it is not given.
pub(super) fn span<T>(value: &Maybe<T>) -> Option<&Span> {
    value.as_ref().map(|value| &value.span)
}

/// The keys of a table with the places of their values: `keys!(link; stiffness, gap)`.
macro_rules! keys {
    ($table:expr; $($key:ident),+) => {
        [$((stringify!($key), $crate::values::span(&$table.$key))),+]
    };
}
pub(super) use keys;

/// The word of a key with a few choices, or its default.
pub(super) fn chosen<T: Copy + Default>(value: &Maybe<T>) -> T {
    value.as_ref().map_or_else(T::default, |value| value.value)
}

/// A switch, or its default if it is not given.
pub(super) fn flag(value: &Maybe<bool>, default: bool) -> bool {
    value.as_ref().map_or(default, |value| value.value)
}

/// Directions in prose: "ux, uy and rz".
pub(super) fn directions(dofs: impl IntoIterator<Item = usize>) -> String {
    let words: Vec<&str> = dofs.into_iter().map(|dof| DIRECTIONS[dof]).collect();
    joined(&words)
}
