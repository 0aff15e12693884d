//! Where the numbers of a factor lie: in memory, or, where that does not hold them, in a file, which the system reads and writes page by
//! page. A factorisation writes them in order and a substitution reads them forwards and backwards, so that each runs at the speed of the disk;
//! update matrices, which are read again at once, stay in memory. The bits are the same.

use super::memory::{self, NoScratch, TooLarge};
use memmap2::MmapMut;
use std::fs::File;
use std::io;
use std::ops::{Deref, DerefMut};

/// The numbers of a factor.
pub(super) enum FactorStore {
    Memory(Vec<f64>),
    /// A file without a name, which is gone with the last use of it.
    File(MmapMut, File),
}

impl FactorStore {
    /// Zeros for so many `numbers` of a factor, in a file where the memory does not hold them and `others` of a matrix with so many unknowns.
    ///
    /// # Errors
    /// The memory does not hold the others either, or there is no disk for the file.
    pub fn new(unknowns: usize, numbers: usize, others: usize) -> Result<FactorStore, TooLarge> {
        let Err(error) = memory::require(unknowns, numbers.saturating_add(others)) else {
            return Ok(FactorStore::Memory(vec![0.0; numbers]));
        };
        memory::require(unknowns, others).map_err(|_| error)?;
        FactorStore::in_file(numbers).map_err(|scratch| TooLarge { scratch: Some(scratch), ..error })
    }

    /// Zeros in a file in the folder for temporary files.
    ///
    /// # Errors
    /// There is no room, or the folder is itself in memory.
    pub fn in_file(numbers: usize) -> Result<FactorStore, NoScratch> {
        let file = tempfile::tempfile().map_err(|_| NoScratch::NotWritable)?;
        if is_in_memory(&file) {
            return Err(NoScratch::InMemory);
        }
        let bytes = numbers as u64 * size_of::<f64>() as u64;
        reserve(&file, bytes).map_err(|_| NoScratch::Full)?;
        // An empty file cannot be mapped.
        if bytes == 0 {
            return Ok(FactorStore::Memory(Vec::new()));
        }
        // SAFETY: the file has no name, so that nobody else opens or shortens it while it is mapped, and all of its bytes are reserved.
        let map = unsafe { MmapMut::map_mut(&file) }.map_err(|_| NoScratch::NotWritable)?;
        Ok(FactorStore::File(map, file))
    }

    /// Makes the numbers zeros, for all are to be written anew: the system has not to read what stands in the file before it writes a page.
    /// Nothing happens in memory, or where the system has no such thing.
    pub fn forget(&self) {
        #[cfg(target_os = "linux")]
        if let FactorStore::File(map, file) = self {
            let _ = rustix::fs::fallocate(file, rustix::fs::FallocateFlags::ZERO_RANGE, 0, map.len() as u64);
        }
    }

    /// True where the numbers lie in a file.
    pub fn is_file(&self) -> bool {
        matches!(self, FactorStore::File(..))
    }
}

impl Deref for FactorStore {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        match self {
            FactorStore::Memory(numbers) => numbers,
            FactorStore::File(map, _) => bytemuck::cast_slice(map),
        }
    }
}

impl DerefMut for FactorStore {
    fn deref_mut(&mut self) -> &mut [f64] {
        match self {
            FactorStore::Memory(numbers) => numbers,
            FactorStore::File(map, _) => bytemuck::cast_slice_mut(map),
        }
    }
}

/// True where what is written to the file takes memory.
#[cfg(target_os = "linux")]
fn is_in_memory(file: &File) -> bool {
    const IN_MEMORY: [u64; 2] = [0x0102_1994, 0x8584_58f6];
    rustix::fs::fstatfs(file).is_ok_and(|of| IN_MEMORY.contains(&(of.f_type as u64)))
}

#[cfg(not(target_os = "linux"))]
fn is_in_memory(_: &File) -> bool {
    false
}

/// Makes the file as long as it will be. A page of a mapped file for which there is no room when it is written ends the program, so that all are
/// reserved where the system can do that.
///
/// # Errors
/// There is no room, or no way to reserve it.
#[cfg(target_os = "linux")]
fn reserve(file: &File, bytes: u64) -> io::Result<()> {
    if bytes > 0 {
        rustix::fs::fallocate(file, rustix::fs::FallocateFlags::empty(), 0, bytes)?;
    }
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn reserve(file: &File, bytes: u64) -> io::Result<()> {
    file.set_len(bytes)
}
