//! Parts of a plan, for processes that share it.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Largest number of parts.
const MOST: u32 = 1_000_000;

/// The `number`-th of `count` parts, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "Parts")]
pub struct Shard {
    /// Number of the part, from 1.
    pub number: u32,
    /// Number of parts.
    pub count: u32,
}

/// A shard of a header before the check.
#[derive(Deserialize)]
struct Parts {
    number: u32,
    count: u32,
}

impl TryFrom<Parts> for Shard {
    type Error = String;

    fn try_from(parts: Parts) -> Result<Shard, String> {
        let Parts { number, count } = parts;
        let sound = (1..=MOST).contains(&count) && (1..=count).contains(&number);
        let allowed = || format!("shard {number}/{count}: allowed: K/N with K from 1 to N, N at most {MOST}");
        if sound { Ok(Shard { number, count }) } else { Err(allowed()) }
    }
}

impl Shard {
    /// The whole plan.
    pub const WHOLE: Shard = Shard { number: 1, count: 1 };

    /// The units of work of this part, out of so many.
    pub(super) fn units(self, units: u64) -> impl Iterator<Item = u64> {
        (u64::from(self.number) - 1..units).step_by(self.count as usize)
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
            Some(Parts { number: number.trim().parse().ok()?, count: count.trim().parse().ok()? })
        });
        parts
            .and_then(|parts| Shard::try_from(parts).ok())
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
        assert!(Shard::WHOLE.units(100).eq(0..100));
        assert_eq!(shard.units(20).collect::<Vec<_>>(), [2, 10, 18]);
        assert_eq!(shard.units(2).count(), 0);
        for wrong in ["", "3", "0/8", "9/8", "1/0", "-1/2", "1/2/3", "a/b", "1/99999999999", "1/1000001"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains("such as 3/8"), "{wrong}");
        }
        let read = |text: &str| serde_json::from_str::<Shard>(text);
        assert_eq!(read(r#"{"number":3,"count":8}"#).unwrap(), shard);
        for wrong in [(1, 0), (0, 1), (2, 1), (1, 1_000_001)] {
            let text = format!(r#"{{"number":{},"count":{}}}"#, wrong.0, wrong.1);
            assert!(read(&text).unwrap_err().to_string().contains("allowed: K/N"), "{text}");
        }
    }
}
