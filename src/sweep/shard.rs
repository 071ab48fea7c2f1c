//! Parts of a plan, for processes that share it.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Most parts.
const MOST: u32 = 1_000_000;

/// The `number`-th of `count` parts, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Shard {
    /// Which part, from 1.
    pub number: u32,
    /// Number of parts.
    pub count: u32,
}

impl Shard {
    /// The whole plan.
    pub const WHOLE: Shard = Shard { number: 1, count: 1 };

    /// Whether a unit of work belongs to this part.
    pub(super) fn has(self, unit: u64) -> bool {
        unit % u64::from(self.count) == u64::from(self.number) - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/').and_then(|(number, count)| {
            Some(Shard { number: number.trim().parse().ok()?, count: count.trim().parse().ok()? })
        });
        parts
            .filter(|shard| (1..=MOST).contains(&shard.count) && (1..=shard.count).contains(&shard.number))
            .ok_or_else(|| format!("allowed: K/N with K from 1 to N, N at most {MOST}, such as 3/8"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_read_and_written() {
        let shard: Shard = "3/8".parse().unwrap();
        assert_eq!((shard, shard.to_string()), (Shard { number: 3, count: 8 }, "3/8".into()));
        assert!((0..100).all(|unit| Shard::WHOLE.has(unit)));
        assert_eq!((0..20).filter(|&unit| shard.has(unit)).collect::<Vec<_>>(), [2, 10, 18]);
        for wrong in ["", "3", "0/8", "9/8", "1/0", "-1/2", "1/2/3", "a/b", "1/99999999999", "1/1000001"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains("such as 3/8"), "{wrong}");
        }
    }
}
