//! The events of the shown loading, as the solver has listed them.

use super::manual_path::ManualPath;
use asperity_contact::Events;
use std::sync::Arc;
use strum::VariantArray;

/// Smallest energy of a listed jump, as a share of the largest energy of all jumps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, VariantArray)]
pub enum LeastShare {
    TenPercent,
    #[default]
    OnePercent,
    TenthOfPercent,
    /// All jumps are listed.
    Zero,
}

impl LeastShare {
    pub fn value(self) -> f64 {
        match self {
            LeastShare::TenPercent => 0.1,
            LeastShare::OnePercent => 0.01,
            LeastShare::TenthOfPercent => 0.001,
            LeastShare::Zero => 0.0,
        }
    }

    /// Returns the next smaller share, with which more jumps are listed; `None` if there is none.
    pub fn smaller(self) -> Option<Self> {
        Self::VARIANTS.get(self as usize + 1).copied()
    }

    /// Returns the next larger share, with which fewer jumps are listed; `None` if there is none.
    pub fn larger(self) -> Option<Self> {
        let before = (self as usize).checked_sub(1)?;
        Some(Self::VARIANTS[before])
    }

    /// Returns the share as the value of the option `--events` of the command line.
    pub fn argument(self) -> &'static str {
        match self {
            LeastShare::TenPercent => "10%",
            LeastShare::OnePercent => "1%",
            LeastShare::TenthOfPercent => "0.1%",
            LeastShare::Zero => "all",
        }
    }

    /// Returns the share in words for a title.
    pub fn in_words(self) -> &'static str {
        match self {
            LeastShare::TenPercent => "from 10 %",
            LeastShare::OnePercent => "from 1 %",
            LeastShare::TenthOfPercent => "from 0.1 %",
            LeastShare::Zero => "all jumps",
        }
    }
}

/// Largest number of listed jumps.
pub const MOST_LISTED: usize = 4096;

/// Events of the loading of a scene or of a path of manual loading.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedEvents {
    pub generation: u64,
    /// Path of manual loading; `None` for the loading of the scene.
    pub path: Option<Arc<ManualPath>>,
    /// Share with which the jumps were chosen.
    pub least_share: LeastShare,
    /// The events. If the jumps cannot be listed, the error is the reason, on one line.
    pub events: Result<Events, String>,
}
