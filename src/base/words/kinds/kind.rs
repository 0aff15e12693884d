//! A kind of table: the word that chooses it, and its keys.

use super::form::Form;

/// A key that one or several kinds of a table take.
#[derive(Debug)]
pub struct Key {
    /// The key as the deck writes it.
    pub name: &'static str,
    /// The form of its value.
    pub form: Form,
    /// Its meaning with unit, range and default, in the words of the reference of the deck.
    pub about: &'static str,
}

/// One of the kinds that a table of the deck may be.
#[derive(Debug)]
pub struct Kind<M: 'static> {
    /// The word that chooses it, as the deck writes it.
    pub word: &'static str,
    /// Other words that choose it.
    pub aliases: &'static [&'static str],
    /// Words of other programs, with the word of the deck for a message.
    pub guesses: &'static [&'static str],
    /// Its description in the words of the reference of the deck.
    pub about: &'static str,
    /// The keys that belong to it; other kinds may take some of them as well.
    pub keys: &'static [Key],
    /// Data of the kind for its room, such as the function that builds an object from the keys.
    pub make: M,
}

impl<M> Kind<M> {
    /// Whether a word of the deck chooses it.
    pub(super) fn is_called(&self, word: &str) -> bool {
        self.word == word || self.aliases.contains(&word)
    }

    /// Returns the kind with data for another use.
    pub const fn with<N>(&self, make: N) -> Kind<N> {
        let Kind { word, aliases, guesses, about, keys, .. } = *self;
        Kind { word, aliases, guesses, about, keys, make }
    }

    /// True if the kind allows a key.
    pub fn takes(&self, key: &str) -> bool {
        self.keys.iter().any(|own| own.name == key)
    }
}

/// A set of kinds among which a table chooses. The struct that carries it holds the keys common to all kinds.
pub trait Kinds: 'static {
    /// The key whose value is the word of the kind.
    const CHOOSER: &'static str;
    /// The meaning of that key, in the words of the reference of the deck.
    const ABOUT: &'static str;
    /// True if the schema requires the kind; false if a default kind exists.
    const REQUIRED: bool;
    /// Data of the kinds for their room.
    type Make: 'static;

    /// All kinds, in the order of the reference of the deck.
    fn list() -> &'static [&'static Kind<Self::Make>];
}
