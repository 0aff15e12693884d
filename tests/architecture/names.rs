//! A name of a type means one thing: no two types that others may use share one. Tables of the deck are named after what they
//! mean in the model, and are not counted.

use super::ratchet::{Known, compare};
use super::source::Source;
use std::collections::BTreeMap;
use syn::{Item, Visibility};

/// Names that several types bear, and how many: what the model says and what computes it.
const SHARED: Known =
    &[("Beam", 2), ("Joint", 2), ("Link", 2), ("Loading", 2), ("Names", 2), ("Node", 2), ("Shell", 2)];

pub fn types_have_names_of_their_own(source: &Source) {
    let mut homes = BTreeMap::<String, Vec<&str>>::new();
    for file in source.files.iter().filter(|file| !file.path.starts_with("deck/")) {
        for item in &file.items {
            let (name, seen) = match item {
                Item::Struct(item) => (&item.ident, &item.vis),
                Item::Enum(item) => (&item.ident, &item.vis),
                Item::Trait(item) => (&item.ident, &item.vis),
                Item::Type(item) => (&item.ident, &item.vis),
                _ => continue,
            };
            if !matches!(seen, Visibility::Inherited) {
                homes.entry(name.to_string()).or_default().push(&file.path);
            }
        }
    }
    assert!(homes.len() > 300, "{} types", homes.len());
    homes.retain(|_, files| files.len() > 1);
    homes.iter().for_each(|(name, files)| println!("{name}: {}", files.join(", ")));
    let found = homes.into_iter().map(|(name, files)| (name, files.len())).collect();
    compare("types of one name", SHARED, &found);
}
