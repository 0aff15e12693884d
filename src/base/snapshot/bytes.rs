//! Bytes of a snapshot, and the types that they can hold.

/// A type that a snapshot can hold.
pub trait Keep {
    /// Writes the value into a snapshot, or reads it back.
    fn keep(&mut self, snapshot: &mut Snapshot);

    /// A value to be overwritten by one more entry of the snapshot; `None` for types that only a deck can build.
    fn blank() -> Option<Self>
    where
        Self: Sized,
    {
        None
    }
}

/// The bytes of a snapshot on their way: being written, or being read back.
pub struct Snapshot {
    bytes: Vec<u8>,
    /// The next byte to be read; `None` while bytes are written.
    at: Option<usize>,
    /// The bytes do not fit the structure that reads them.
    is_torn: bool,
}

impl Snapshot {
    /// An empty snapshot, to be written.
    pub fn taken() -> Snapshot {
        Snapshot { bytes: Vec::new(), at: None, is_torn: false }
    }

    /// A snapshot to be read back.
    pub fn of(bytes: Vec<u8>) -> Snapshot {
        Snapshot { bytes, at: Some(0), is_torn: false }
    }

    /// The bytes.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// True where values are taken from the snapshot.
    pub fn gives(&self) -> bool {
        self.at.is_some()
    }

    /// True where all bytes have been read back, and every one fitted.
    pub fn is_used_up(&self) -> bool {
        self.at == Some(self.bytes.len()) && !self.is_torn
    }

    /// Marks the bytes as unfit for the structure.
    pub fn tear(&mut self) {
        self.is_torn = true;
    }

    /// Writes a whole list of bytes, or reads one.
    pub fn all(&mut self, bytes: &mut Vec<u8>) {
        let length = self.length(bytes.len());
        match &mut self.at {
            None => self.bytes.extend_from_slice(bytes),
            Some(at) => {
                bytes.clear();
                bytes.extend_from_slice(&self.bytes[*at..*at + length]);
                *at += length;
            }
        }
    }

    /// Writes these bytes, or overwrites them by the next of the snapshot.
    pub(super) fn pass<const N: usize>(&mut self, value: [u8; N]) -> [u8; N] {
        let Some(at) = self.at else {
            self.bytes.extend_from_slice(&value);
            return value;
        };
        let next = self.bytes.get(at..at + N).and_then(|next| next.try_into().ok());
        self.at = Some(if next.is_some() { at + N } else { at });
        self.is_torn |= next.is_none();
        next.unwrap_or(value)
    }

    /// Writes the length of a list, or reads one; no list is longer than its bytes.
    pub(super) fn length(&mut self, mut length: usize) -> usize {
        length.keep(self);
        let left = self.at.map_or(usize::MAX, |at| self.bytes.len() - at);
        if length > left {
            self.tear();
            return 0;
        }
        length
    }
}
