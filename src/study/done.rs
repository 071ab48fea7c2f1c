//! The existing records of a study, one bit for each.

/// Set of the existing records, by their places.
pub(super) struct Done(Vec<u64>);

impl Done {
    pub fn none(count: u64) -> Done {
        Done(vec![0; count.div_ceil(64) as usize])
    }

    pub fn add(&mut self, place: u64) {
        self.0[place as usize / 64] |= 1 << (place % 64);
    }

    /// Number of records.
    pub fn count(&self) -> u64 {
        self.0.iter().map(|word| u64::from(word.count_ones())).sum()
    }

    pub fn has(&self, place: u64) -> bool {
        self.0[place as usize / 64] & (1 << (place % 64)) != 0
    }
}
