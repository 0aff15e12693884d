//! VTK's unstructured grids: XML that names the arrays, and behind it their numbers, little-endian and compressed by zlib in blocks.
//! Reference: VTKFileFormats, docs.vtk.org; "appended raw" data with `vtkZLibDataCompressor`.

use super::disk::{at, create};
use adler2::adler32_slice;
use flate2::{Compress, CompressError, Compression, FlushCompress, Status};
use std::fmt::Write;
use std::io::{self, Write as _};
use std::path::Path;

/// The beginning of a grid, up to its field data.
const OPEN: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
    compressor=\"vtkZLibDataCompressor\">\n\
    <UnstructuredGrid>\n";
/// The text after the cells and before the numbers.
pub const APPENDED: &str = "</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
/// The end of a grid, behind the numbers.
const CLOSE: &str = "\n</AppendedData>\n</VTKFile>\n";
/// The number of bytes that are compressed together.
const BLOCK: usize = 1 << 16;
/// Blocks of fewer bytes are stored uncompressed: preparing the compression costs more time, and gains a fifth of the bytes at most.
const SMALL: usize = 1 << 12;

/// Types of cells, by the numbers of VTK.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Cell {
    Line = 3,
    Triangle = 5,
    Polygon = 7,
    Quad = 9,
    Hexahedron = 12,
    QuadraticEdge = 21,
    QuadraticTriangle = 22,
    BiquadraticQuad = 28,
    LagrangeCurve = 68,
}

/// A number that an array can hold.
pub trait Scalar: Copy {
    const TYPE: &'static str;
    fn append(self, bytes: &mut Vec<u8>);
}

macro_rules! scalar {
    ($($rust:ty, $vtk:literal;)*) => {$(
        impl Scalar for $rust {
            const TYPE: &'static str = $vtk;
            fn append(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )*};
}
scalar! { f64, "Float64"; i64, "Int64"; u8, "UInt8"; }

/// A grid that is being put together. Its memory serves again for the next one.
pub struct GridText {
    text: String,
    /// The compressed arrays, one behind the other.
    data: Vec<u8>,
    /// The number of their bytes that all grids begin with.
    kept: usize,
    /// An array before it is compressed.
    bytes: Vec<u8>,
    coder: Compress,
    /// The first array that could not be compressed, if there is one.
    fault: Option<io::Error>,
}

impl GridText {
    /// No grid yet.
    pub fn new() -> GridText {
        // The fastest level: the others gain 2 % on numbers that a solver has computed.
        let coder = Compress::new(Compression::fast(), true);
        GridText { text: String::new(), data: Vec::new(), kept: 0, bytes: Vec::new(), coder, fault: None }
    }

    /// Compresses an array of constant numbers for all grids, and returns its tag. It must come before the first grid begins.
    pub fn keep<T: Scalar>(&mut self, name: &str, components: usize, values: impl Iterator<Item = T>) -> String {
        self.text.clear();
        self.array(name, components, values);
        self.kept = self.data.len();
        std::mem::take(&mut self.text)
    }

    /// Begins a grid.
    pub fn begin(&mut self) {
        self.data.truncate(self.kept);
        self.text.clear();
        self.text.push_str(OPEN);
    }

    /// Adds text.
    pub fn push(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Adds an array: tuples of so many `components`, one after the other. There are no arrays of strings, for meshio refuses a file
    /// that has one.
    pub fn array<T: Scalar>(&mut self, name: &str, components: usize, values: impl Iterator<Item = T>) {
        self.bytes.clear();
        values.for_each(|value| value.append(&mut self.bytes));
        let tuples = self.bytes.len() / (components * size_of::<T>());
        let (kind, offset) = (T::TYPE, self.data.len());
        let _ = writeln!(
            self.text,
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" NumberOfTuples=\"{tuples}\" \
             format=\"appended\" offset=\"{offset}\"/>"
        );
        self.compress();
    }

    /// Appends the array to the data. It consists of UInt64 numbers (the number of blocks, the bytes of a block, the bytes of a shorter
    /// last block, the compressed bytes of each block) and the blocks.
    fn compress(&mut self) {
        let GridText { data, bytes, coder, fault, .. } = self;
        let blocks = bytes.chunks(BLOCK);
        for number in [blocks.len(), BLOCK, bytes.len() % BLOCK] {
            data.extend_from_slice(&(number as u64).to_le_bytes());
        }
        let mut length_at = data.len();
        data.resize(length_at + 8 * blocks.len(), 0);
        for block in blocks {
            let begins = data.len();
            if block.len() < SMALL {
                store(block, data);
            } else if let Err(error) = deflate(block, coder, data) {
                fault.get_or_insert(io::Error::other(error));
            }
            let length = (data.len() - begins) as u64;
            data[length_at..length_at + 8].copy_from_slice(&length.to_le_bytes());
            length_at += 8;
        }
    }

    /// Ends the grid and writes it.
    ///
    /// # Errors
    /// The file cannot be written; the error names it.
    pub fn write(&mut self, path: &Path) -> io::Result<()> {
        if let Some(fault) = self.fault.take() {
            return Err(at(path, fault));
        }
        self.text.push_str(APPENDED);
        // One call writes all of the file.
        self.bytes.clear();
        for part in [self.text.as_bytes(), &self.data, CLOSE.as_bytes()] {
            self.bytes.extend_from_slice(part);
        }
        create(path).and_then(|mut file| file.write_all(&self.bytes)).map_err(|e| at(path, e))
    }
}

/// Appends a block as a zlib stream of one stored block (RFC 1950 and 1951).
fn store(block: &[u8], data: &mut Vec<u8>) {
    let length = block.len() as u16;
    data.extend_from_slice(&[0x78, 0x01, 0x01]);
    data.extend_from_slice(&length.to_le_bytes());
    data.extend_from_slice(&(!length).to_le_bytes());
    data.extend_from_slice(block);
    data.extend_from_slice(&adler32_slice(block).to_be_bytes());
}

/// Appends a block as a compressed zlib stream.
fn deflate(block: &[u8], coder: &mut Compress, data: &mut Vec<u8>) -> Result<(), CompressError> {
    coder.reset();
    loop {
        // Incompressible data grows by a few bytes in ten thousand.
        data.reserve(block.len() + block.len() / 64 + 256);
        if coder.compress_vec(&block[coder.total_in() as usize..], data, FlushCompress::Finish)? == Status::StreamEnd {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::bufread::ZlibDecoder;
    use std::io::Read;

    /// Numbers without a pattern, as many as fill no block, one block in part, one exactly, and more than two, after an array that all
    /// grids share.
    #[test]
    fn arrays_of_any_length_come_back() {
        let mut grid = GridText::new();
        assert!(grid.keep("types", 1, [3_u8; 5].into_iter()).contains("offset=\"0\""));
        for count in [0, 1, 100, 511, 512, 8191, 8192, 8193, 20_000] {
            let values: Vec<f64> = (0..count).map(|k| (1e9 * f64::from(k).sin()).sin()).collect();
            grid.begin();
            let offset = grid.data.len();
            grid.array("x", 1, values.iter().copied());
            let data = &grid.data[offset..];
            let number =
                |k: usize| data.as_chunks::<8>().0.get(k).map_or(0, |&eight| u64::from_le_bytes(eight) as usize);
            let bytes = 8 * values.len();
            assert_eq!([number(0), number(1), number(2)], [bytes.div_ceil(BLOCK), BLOCK, bytes % BLOCK]);
            let (mut at, mut found) = (8 * (3 + number(0)), Vec::new());
            for k in 0..number(0) {
                ZlibDecoder::new(&data[at..at + number(3 + k)]).read_to_end(&mut found).expect("a whole block");
                at += number(3 + k);
            }
            assert_eq!(at, data.len());
            assert!(found.as_chunks().0.iter().map(|&eight| f64::from_le_bytes(eight)).eq(values));
        }
    }
}
