//! The XML of VTK's unstructured grids: base64 arrays in little-endian order, each behind its length in bytes (UInt64).
//! Reference: VTKFileFormats, docs.vtk.org.

use base64::prelude::{BASE64_STANDARD, Engine};
use std::fmt::Write;

/// The beginning of a grid, up to its field data.
pub const OPEN: &str = "<?xml version=\"1.0\"?>\n\
    <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
    <UnstructuredGrid>\n";
/// The end of a grid, behind its cells.
pub const CLOSE: &str = "</UnstructuredGrid>\n</VTKFile>\n";

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

/// Appends a `DataArray` to `text`: tuples of so many `components`, one after the other; `bytes` is scratch. There are no arrays
/// of strings, for meshio refuses a file that has one.
pub fn array<T: Scalar>(
    text: &mut String,
    bytes: &mut Vec<u8>,
    name: &str,
    components: usize,
    values: impl Iterator<Item = T>,
) {
    bytes.clear();
    bytes.extend_from_slice(&[0; 8]);
    values.for_each(|value| value.append(bytes));
    let length = bytes.len() as u64 - 8;
    bytes[..8].copy_from_slice(&length.to_le_bytes());
    let kind = T::TYPE;
    let tuples = length as usize / (components * size_of::<T>());
    let _ = write!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" NumberOfTuples=\"{tuples}\" \
         format=\"binary\">"
    );
    BASE64_STANDARD.encode_string(bytes, text);
    text.push_str("</DataArray>\n");
}
