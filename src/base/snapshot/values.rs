//! Numbers, texts and lists of them as bytes.

use super::bytes::{Keep, Snapshot};
use crate::math::Vec3;
use nalgebra::{Quaternion, SMatrix};
use std::ops::Range;

macro_rules! keep_numbers {
    ($($number:ty),*) => {
        $(impl Keep for $number {
            fn keep(&mut self, snapshot: &mut Snapshot) {
                *self = <$number>::from_le_bytes(snapshot.pass(self.to_le_bytes()));
            }

            fn blank() -> Option<Self> {
                Some(Self::default())
            }
        })*
    };
}

keep_numbers!(f64, u8, u32, u64, i32);

impl Keep for usize {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        *self = u64::from_le_bytes(snapshot.pass((*self as u64).to_le_bytes())) as usize;
    }

    fn blank() -> Option<Self> {
        Some(0)
    }
}

impl Keep for bool {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        *self = snapshot.pass([u8::from(*self)]) != [0];
    }

    fn blank() -> Option<Self> {
        Some(false)
    }
}

impl Keep for String {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let mut bytes = std::mem::take(self).into_bytes();
        bytes.keep(snapshot);
        match String::from_utf8(bytes) {
            Ok(text) => *self = text,
            Err(_) => snapshot.tear(),
        }
    }

    fn blank() -> Option<Self> {
        Some(String::new())
    }
}

/// A word of the program itself: the few of a run that are read back live as long as it does.
impl Keep for &'static str {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let mut text = (*self).to_owned();
        text.keep(snapshot);
        if text != *self {
            *self = text.leak();
        }
    }

    fn blank() -> Option<Self> {
        Some("")
    }
}

impl<const R: usize, const C: usize> Keep for SMatrix<f64, R, C> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.iter_mut().for_each(|number| number.keep(snapshot));
    }

    fn blank() -> Option<Self> {
        Some(Self::zeros())
    }
}

impl Keep for Quaternion<f64> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.coords.keep(snapshot);
    }

    fn blank() -> Option<Self> {
        Some(Quaternion::from_parts(1.0, Vec3::zeros()))
    }
}

impl<T: Keep, const N: usize> Keep for [T; N] {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.iter_mut().for_each(|item| item.keep(snapshot));
    }

    fn blank() -> Option<Self> {
        let blank: Option<Vec<T>> = (0..N).map(|_| T::blank()).collect();
        blank?.try_into().ok()
    }
}

impl<A: Keep, B: Keep> Keep for (A, B) {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.0.keep(snapshot);
        self.1.keep(snapshot);
    }

    fn blank() -> Option<Self> {
        Some((A::blank()?, B::blank()?))
    }
}

impl Keep for Range<usize> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        self.start.keep(snapshot);
        self.end.keep(snapshot);
    }

    fn blank() -> Option<Self> {
        Some(0..0)
    }
}

impl<T: Keep> Keep for Box<T> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        (**self).keep(snapshot);
    }

    fn blank() -> Option<Self> {
        T::blank().map(Box::new)
    }
}

/// An optional value may disappear; a value that only a deck can build must exist.
impl<T: Keep> Keep for Option<T> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let mut is_there = self.is_some();
        is_there.keep(snapshot);
        match is_there {
            false => *self = None,
            true if self.is_none() => *self = T::blank(),
            true => {}
        }
        match self {
            Some(value) => value.keep(snapshot),
            None if is_there => snapshot.tear(),
            None => {}
        }
    }

    fn blank() -> Option<Self> {
        Some(None)
    }
}

/// A list keeps its memory as far as it goes.
impl<T: Keep> Keep for Vec<T> {
    fn keep(&mut self, snapshot: &mut Snapshot) {
        let length = snapshot.length(self.len());
        self.truncate(length);
        while self.len() < length {
            let Some(item) = T::blank() else { return snapshot.tear() };
            self.push(item);
        }
        self.iter_mut().for_each(|item| item.keep(snapshot));
    }

    fn blank() -> Option<Self> {
        Some(Vec::new())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Some = (Vec<f64>, (Option<String>, (Vec<[bool; 2]>, Option<Box<u32>>)));

    fn passed(value: &mut Some) -> Vec<u8> {
        let mut snapshot = Snapshot::taken();
        value.keep(&mut snapshot);
        snapshot.into_bytes()
    }

    #[test]
    fn what_is_kept_comes_back_bit_for_bit() {
        let mut value: Some =
            (vec![0.1, -0.0, f64::NAN], (Some("Träger".into()), (vec![[true, false]], Some(Box::new(7)))));
        let bytes = passed(&mut value);
        let mut back: Some = (vec![5.0; 9], (None, (Vec::new(), None)));
        let mut snapshot = Snapshot::of(bytes.clone());
        back.keep(&mut snapshot);
        assert!(snapshot.is_used_up());
        assert_eq!(back.1, value.1);
        assert_eq!(passed(&mut back), bytes);
    }

    #[test]
    fn bytes_that_do_not_fit_are_torn() {
        let bytes = passed(&mut (vec![0.1, 2.0], (None, (Vec::new(), None))));
        for end in 0..bytes.len() {
            let mut snapshot = Snapshot::of(bytes[..end].to_vec());
            <Some as Keep>::blank().unwrap().keep(&mut snapshot);
            assert!(!snapshot.is_used_up(), "{end} of {}", bytes.len());
        }
    }
}
