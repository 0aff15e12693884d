//! Numbers of nodes and elements in the file, and their indices.

/// An index or a line as 32 bits: files of a few gigabytes have fewer of them.
pub fn short(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}

/// A map from numbers in the file to indices: a table where the numbers are dense, else a sorted list.
#[derive(Debug)]
pub enum Ids {
    /// Index + 1, by number; 0 for none.
    Table(Vec<u32>),
    /// (number, index), ascending.
    Sorted(Vec<(u64, u32)>),
}

impl Ids {
    /// The map, and the indices of numbers that occurred before.
    pub fn new(ids: impl ExactSizeIterator<Item = u64> + Clone) -> (Ids, Vec<usize>) {
        let (count, last) = (ids.len() as u64, ids.clone().max().unwrap_or(0));
        let mut again = Vec::new();
        if last <= 8 * count + 1000 {
            let mut table = vec![0u32; last as usize + 1];
            for (index, id) in ids.enumerate() {
                let entry = &mut table[id as usize];
                if *entry == 0 {
                    *entry = short(index + 1);
                } else {
                    again.push(index);
                }
            }
            return (Ids::Table(table), again);
        }
        let mut sorted: Vec<(u64, u32)> = ids.enumerate().map(|(index, id)| (id, short(index))).collect();
        sorted.sort_unstable();
        sorted.dedup_by(|later, first| {
            let same = later.0 == first.0;
            if same {
                again.push(later.1 as usize);
            }
            same
        });
        (Ids::Sorted(sorted), again)
    }

    /// The index of a number.
    pub fn get(&self, id: u64) -> Option<usize> {
        match self {
            Ids::Table(table) => (*table.get(usize::try_from(id).ok()?)? as usize).checked_sub(1),
            Ids::Sorted(sorted) => {
                let at = sorted.binary_search_by_key(&id, |entry| entry.0).ok()?;
                Some(sorted[at].1 as usize)
            }
        }
    }
}
