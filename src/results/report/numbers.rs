//! The numbers that the scripts of the page read.

use base64::prelude::{BASE64_STANDARD, Engine};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// All numbers of a page. Of each array the highest bytes of all numbers come first, column by column, because alike bytes compress well.
#[derive(Default)]
pub struct PageNumbers(Vec<u8>);

impl PageNumbers {
    /// Adds rows of a width, and returns what the page needs to read them: the place, the number of numbers, the width.
    pub fn add(&mut self, values: &[f32], width: usize) -> [usize; 3] {
        let (place, width) = (self.0.len(), width.max(1));
        for byte in (0..4).rev() {
            for column in 0..width {
                self.0.extend(values.iter().skip(column).step_by(width).map(|value| value.to_le_bytes()[byte]));
            }
        }
        [place, values.len(), width]
    }

    /// The numbers as the page reads them: base64 of what zlib makes of the bytes.
    ///
    /// # Errors
    /// None, as memory takes the bytes.
    pub fn packed(self) -> std::io::Result<String> {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
        packed.write_all(&self.0)?;
        Ok(BASE64_STANDARD.encode(packed.finish()?))
    }
}
