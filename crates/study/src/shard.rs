//! Shards of a plan. A shard is a part of the plan; different processes can compute different
//! shards.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

const MOST: u32 = 1_000_000;

/// Part of a plan that one process computes. The plan is divided into `count` parts of about the
/// same size, and this is part number `number`.
///
/// ```
/// use asperity_study::Shard;
///
/// let shard: Shard = "3/8".parse().expect("a part of eight");
/// assert_eq!(shard.to_string(), "3/8");
/// assert!("9/8".parse::<Shard>().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Shard {
    /// Number of the part, counted from 1.
    pub number: u32,
    /// Number of parts into which the plan is divided.
    pub count: u32,
}

impl Shard {
    /// The whole plan as a single part, for a study that is not divided.
    pub const WHOLE: Shard = Shard {
        number: 1,
        count: 1,
    };

    /// Creates a part of a plan.
    ///
    /// # Errors
    /// Returns a message that says what is allowed if the numbers are not allowed.
    pub(super) fn new(number: u32, count: u32) -> Result<Shard, String> {
        let is_sound = (1..=MOST).contains(&count) && (1..=count).contains(&number);
        let allowed =
            || format!("shard {number}/{count}: allowed: K/N with K from 1 to N, N at most {MOST}");
        is_sound
            .then_some(Shard { number, count })
            .ok_or_else(allowed)
    }

    /// Returns the indices of the units of work that this part of the plan contains. The whole plan
    /// has `units` units, each of which one thread computes.
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
        let parts = text.split_once('/');
        let shard = parts.and_then(|(number, count)| {
            Shard::new(number.trim().parse().ok()?, count.trim().parse().ok()?).ok()
        });
        shard.ok_or_else(|| {
            format!("allowed: K/N with K from 1 to N, N at most {MOST}, such as 3/8")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_read_and_written() {
        let shard: Shard = "3/8".parse().unwrap();
        assert_eq!(
            (shard, shard.to_string()),
            (
                Shard {
                    number: 3,
                    count: 8
                },
                "3/8".into()
            )
        );
        assert!(Shard::WHOLE.units(100).eq(0..100));
        assert_eq!(shard.units(20).collect::<Vec<_>>(), [2, 10, 18]);
        assert_eq!(shard.units(2).count(), 0);
        for wrong in [
            "",
            "3",
            "0/8",
            "9/8",
            "1/0",
            "-1/2",
            "1/2/3",
            "a/b",
            "1/99999999999",
            "1/1000001",
        ] {
            assert!(
                wrong.parse::<Shard>().unwrap_err().contains("such as 3/8"),
                "{wrong}"
            );
        }
    }
}
