//! Checks the available memory for a factor, because a system that overcommits kills programs without a message.

use base::names::amount;
use base::snapshot::{keep, keep_either};
use std::fmt;
use std::path::Path;
use std::sync::OnceLock;

/// Bytes for each unknown beside the numbers of a factorisation, at least: vectors of the solution, and lists of the structure. Whole runs of
/// shells take about 1000 beside them, elements and what there is before the plan included.
const BESIDE: f64 = 500.0;

/// The memory does not hold the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    /// Rows of the matrix.
    pub unknowns: usize,
    /// Bytes needed at least.
    pub needed: f64,
    /// Why the factor does not lie in a file either; `None` where all else has no room in memory.
    pub scratch: Option<NoScratch>,
}

/// Why there is no file for a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoScratch {
    /// The disk has no room.
    Full,
    /// The folder for temporary files is itself in memory.
    InMemory,
    /// Nothing can be written there.
    NotWritable,
}

keep!(TooLarge { unknowns, needed, scratch });
keep_either!(NoScratch { 0 => Full, 1 => InMemory, 2 => NotWritable });

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (unknowns, needed) = (self.unknowns, amount(self.needed));
        write!(
            f,
            "the matrix of {unknowns} unknowns needs at least {needed} when factorised: more memory than there is"
        )?;
        if let Some(reason) = self.scratch {
            let folder = std::env::temp_dir();
            let folder = folder.display();
            match reason {
                NoScratch::Full => write!(f, ", and more than the disk of {folder} holds")?,
                NoScratch::InMemory => write!(f, ", and {folder} is itself in memory")?,
                NoScratch::NotWritable => write!(f, ", and nothing can be written in {folder}")?,
            }
            f.write_str(". Set TMPDIR to a folder on a disk with room for the factor")?;
        }
        f.write_str(". Take a coarser mesh, or give `scheme = \"central-difference\"`, which factorizes no such matrix")
    }
}

impl std::error::Error for TooLarge {}

/// Least bytes of the buffers of products.
const LEAST_PRODUCTS: usize = 96 << 20;

/// Needs below so many bytes are not compared with the free memory: the answer takes 0.1 ms, which is felt in sweeps of small cases.
const SMALL: f64 = 1e7;

/// Bytes of buffers that products of large matrices take during a factorization: twice the third level of cache of all processors. A limit of
/// the process counts them, though most are never touched.
pub fn products() -> usize {
    static BYTES: OnceLock<usize> = OnceLock::new();
    let third_level = || -> Option<usize> {
        let read = |name: &str| std::fs::read_to_string(format!("/sys/devices/system/cpu/{name}")).ok();
        let size = read("cpu0/cache/index3/size")?.trim().strip_suffix('K')?.parse::<usize>().ok()?;
        let caches = listed(&read("online")?)?.div_ceil(listed(&read("cpu0/cache/index3/shared_cpu_list")?)?.max(1));
        Some((size << 10).saturating_mul(caches))
    };
    *BYTES.get_or_init(|| LEAST_PRODUCTS.max(third_level().map_or(0, |bytes| bytes.saturating_mul(2))))
}

/// The number of processors in a list such as `0-3,8`.
fn listed(list: &str) -> Option<usize> {
    list.trim().split(',').try_fold(0, |count, range| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        Some(count + last.parse::<usize>().ok()?.checked_sub(first.parse().ok()?)? + 1)
    })
}

/// Makes sure that the memory holds so many `numbers` of a matrix, its factor and its update matrices.
///
/// # Errors
/// It does not, or a limit of this process forbids it.
pub(super) fn require(unknowns: usize, numbers: usize) -> Result<(), TooLarge> {
    let needed = size_of::<f64>() as f64 * numbers as f64 + BESIDE * unknowns as f64;
    let fits = needed < SMALL || available().is_none_or(|available| needed <= available);
    // The available memory of the system does not show a limit of this process. The memory is given back at once, untouched.
    let granted = Vec::<u8>::new().try_reserve_exact((needed as usize).saturating_add(products())).is_ok();
    if fits && granted { Ok(()) } else { Err(TooLarge { unknowns, needed, scratch: None }) }
}

/// Bytes that this program may still take, as Linux and its control group say; none on other systems.
pub fn available() -> Option<f64> {
    let free = free_of_machine()?;
    Some(free_of_control_group().map_or(free, |left| left.min(free)))
}

/// Bytes that the limits of the control group of this process, and of those above it, still leave; none without a limit.
fn free_of_control_group() -> Option<f64> {
    let lines = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let left = lines.lines().flat_map(|line| {
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, path) = (fields.next().unwrap_or_default(), fields.next().unwrap_or_default());
        // Version 2 has one hierarchy without a name, version 1 one for memory.
        let (root, names) = match controllers {
            "" => ("/sys/fs/cgroup", ["memory.max", "memory.current", "inactive_file"]),
            "memory" => {
                ("/sys/fs/cgroup/memory", ["memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"])
            }
            _ => return Vec::new(),
        };
        let folders = Path::new(path.trim_start_matches('/')).ancestors();
        folders.filter_map(|folder| left_by_group(&Path::new(root).join(folder), names)).collect()
    });
    left.reduce(f64::min)
}

/// Bytes below the limit of one control group. Cached files of the group count as free, because the system drops unused ones on demand.
fn left_by_group(folder: &Path, [limit, used, spare]: [&str; 3]) -> Option<f64> {
    let number = |name: &str| -> Option<f64> { std::fs::read_to_string(folder.join(name)).ok()?.trim().parse().ok() };
    let stat = std::fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let spare = stat.lines().find_map(|line| line.strip_prefix(spare)?.trim().parse().ok()).unwrap_or(0.0);
    Some((number(limit)? - number(used)? + spare).max(0.0))
}

/// Bytes that the machine may still give to programs.
fn free_of_machine() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let kilobytes = |key: &str| -> Option<f64> {
        let line = text.lines().find_map(|line| line.strip_prefix(key))?;
        line.trim().strip_suffix("kB")?.trim().parse().ok()
    };
    Some(1024.0 * (kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a folder with the files of version 2: a limit of 500, 300 in use, 120 of them files that nobody uses.
    #[test]
    fn a_control_group_leaves_its_limit_less_what_is_in_use() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["memory.max", "memory.current", "inactive_file"];
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        assert_eq!(left_by_group(folder.path(), names), None);
        write("memory.current", "300\n");
        write("memory.stat", "anon 180\ninactive_file 120\n");
        write("memory.max", "max\n");
        assert_eq!(left_by_group(folder.path(), names), None);
        write("memory.max", "500\n");
        assert_eq!(left_by_group(folder.path(), names), Some(320.0));
    }

    #[test]
    fn a_factor_beyond_all_memory_is_refused_in_words() {
        assert_eq!(require(12, 100), Ok(()));
        // 16 TB, and more than addresses reach.
        for numbers in [2_000_000_000_000, usize::MAX / 8] {
            let error = require(9_000_000, numbers).unwrap_err();
            assert_eq!(error.needed, 8.0 * numbers as f64 + 500.0 * 9e6);
        }
        let said = require(9_000_000, 2_000_000_000_000).unwrap_err().to_string();
        assert_eq!(
            said,
            "the matrix of 9000000 unknowns needs at least 16004.5 GB when factorised: more memory than there is. Take a coarser \
             mesh, or give `scheme = \"central-difference\"`, which factorizes no such matrix"
        );
        let error = TooLarge { unknowns: 2, needed: 2e9, scratch: Some(NoScratch::Full) };
        let folder = std::env::temp_dir();
        let said = error.to_string();
        assert!(said.contains(&format!("and more than the disk of {} holds. Set TMPDIR", folder.display())), "{said}");
    }
}
