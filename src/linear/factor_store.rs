//! Storage of a factor: memory, or a file that the system reads and writes page by page. A factorization writes in order, and a
//! substitution reads forwards and backwards, so both run at the speed of the disk. Update matrices are read at once and stay in memory.
//! The bits are the same.

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

    /// Sets the numbers to zero, so the system does not read a page of the file before overwriting it. Nothing happens in memory, or where
    /// the system has no such thing.
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

/// True if the file occupies memory.
#[cfg(target_os = "linux")]
fn is_in_memory(file: &File) -> bool {
    const IN_MEMORY: [u64; 2] = [0x0102_1994, 0x8584_58f6];
    rustix::fs::fstatfs(file).is_ok_and(|of| IN_MEMORY.contains(&(of.f_type as u64)))
}

#[cfg(not(target_os = "linux"))]
fn is_in_memory(_: &File) -> bool {
    false
}

/// Makes the file as long as it will be. A mapped page without room on the disk ends the program when it is written. All pages are
/// therefore reserved where the system supports it.
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
