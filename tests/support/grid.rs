//! The grids of fields, read as VTK's reference describes them.

use flate2::read::ZlibDecoder;
use std::fs;
use std::io::Read;
use std::path::Path;

/// A grid: its XML without the numbers, and the numbers.
pub struct Grid {
    pub xml: String,
    data: Vec<u8>,
}

impl Grid {
    pub fn read(path: &Path) -> Grid {
        let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let (begin, end) = (&b"<AppendedData encoding=\"raw\">\n_"[..], &b"\n</AppendedData>\n</VTKFile>\n"[..]);
        let at = bytes.windows(begin.len()).position(|window| window == begin).expect("appended data") + begin.len();
        assert!(bytes.ends_with(end));
        let data = bytes[at..bytes.len() - end.len()].to_vec();
        let xml = [&bytes[..at], end].concat();
        Grid { xml: String::from_utf8(xml).unwrap(), data }
    }

    /// The bytes of an array.
    pub fn array(&self, name: &str) -> Vec<u8> {
        let from = self.xml.find(&format!("Name=\"{name}\"")).unwrap_or_else(|| panic!("no array {name}"));
        let tag = self.xml[from..].split_once("/>").unwrap().0;
        let offset: usize = tag.split_once("offset=\"").unwrap().1.split('"').next().unwrap().parse().unwrap();
        let number = |k: usize| {
            let at = offset + 8 * k;
            u64::from_le_bytes(self.data[at..at + 8].try_into().unwrap()) as usize
        };
        let [blocks, size, last] = [0, 1, 2].map(number);
        let (mut at, mut bytes) = (offset + 8 * (3 + blocks), Vec::new());
        for k in 0..blocks {
            let end = at + number(3 + k);
            let before = bytes.len();
            ZlibDecoder::new(&self.data[at..end]).read_to_end(&mut bytes).unwrap();
            let is_short = k + 1 == blocks && last > 0;
            assert_eq!(bytes.len() - before, if is_short { last } else { size }, "block {k} of {name}");
            at = end;
        }
        bytes
    }

    pub fn numbers(&self, name: &str) -> Vec<f64> {
        self.array(name).chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().unwrap())).collect()
    }

    pub fn indices(&self, name: &str) -> Vec<usize> {
        let numbers = self.array(name);
        numbers.chunks_exact(8).map(|chunk| i64::from_le_bytes(chunk.try_into().unwrap()) as usize).collect()
    }
}
