//! The values of κ or e_el/γ and of H on a map, and the order of their computation.

use crate::scene::RoughnessParameter;

/// Values of κ: quarters of octaves from 1/8 to 32; of e_el/γ, which grows with κ²: half octaves from 1/64 to 1024.
pub const COLUMNS: usize = 33;
/// Values of H, from 0.05 to 0.95.
pub const HURSTS: usize = 19;

/// Number of springs above which a map gets fewer cells, and still fewer far above.
const MANY: u64 = 1 << 14;
const VERY_MANY: u64 = 1 << 17;

/// The κ or e_el/γ of a column, to three digits, so that a scene set to a shown value is that of the cell.
pub fn parameter_value(parameter: RoughnessParameter, column: usize) -> f64 {
    let per_octave = match parameter {
        RoughnessParameter::Kappa => 4.0,
        RoughnessParameter::ElasticEnergyRatio => 2.0,
    };
    let exact = ((column as f64 - 12.0) / per_octave).exp2();
    format!("{exact:.2e}").parse().unwrap_or(exact)
}

/// The H of a row.
pub fn hurst(row: usize) -> f64 {
    (row + 1) as f64 * 5.0 / 100.0
}

/// Resolution of a map. Every level contains the cells of the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// 5 × 5 cells.
    Coarse,
    /// 9 × 9 cells.
    Medium,
    /// 17 values of κ or e_el/γ, all of H.
    Fine,
    /// All cells.
    Whole,
}

impl Level {
    /// All levels, the coarsest first.
    pub const ALL: [Level; 4] = [Level::Coarse, Level::Medium, Level::Fine, Level::Whole];

    /// Finest level of maps with so many springs: waves that need very many have fewer cells.
    pub fn finest(springs: u64) -> Level {
        if springs <= MANY {
            Level::Whole
        } else if springs <= VERY_MANY {
            Level::Fine
        } else {
            Level::Medium
        }
    }

    /// Columns of the level.
    pub fn columns(self) -> impl Iterator<Item = usize> {
        let stride = match self {
            Level::Coarse => 8,
            Level::Medium => 4,
            Level::Fine => 2,
            Level::Whole => 1,
        };
        (0..COLUMNS).step_by(stride)
    }

    /// Rows of the level, the lowest H first.
    pub fn rows(self) -> &'static [usize] {
        match self {
            Level::Coarse => &[0, 4, 9, 14, 18],
            Level::Medium => &[0, 2, 4, 7, 9, 11, 14, 16, 18],
            Level::Fine | Level::Whole => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_values_are_round() {
        let [kappa, ratio] =
            RoughnessParameter::ALL.map(|parameter| move |column| parameter_value(parameter, column));
        assert_eq!([0, 4, 8, 12, 16, 24, 32].map(kappa), [0.125, 0.25, 0.5, 1.0, 2.0, 8.0, 32.0]);
        assert_eq!([0, 8, 12, 14, 32].map(ratio), [0.0156, 0.25, 1.0, 2.0, 1020.0]);
        assert_eq!((kappa(13), ratio(13)), (1.19, 1.41));
        assert_eq!([0, 9, 13, 18].map(hurst), [0.05, 0.5, 0.7, 0.95]);
        assert!(
            (1..COLUMNS).all(|column| kappa(column) > kappa(column - 1) && ratio(column) > ratio(column - 1))
        );
    }

    #[test]
    fn every_level_has_the_cells_of_the_one_before() {
        for pair in Level::ALL.windows(2) {
            let finer: Vec<_> = pair[1].columns().collect();
            assert!(pair[0].columns().all(|column| finer.contains(&column)));
            assert!(pair[0].rows().iter().all(|row| pair[1].rows().contains(row)));
        }
        let counts = Level::ALL.map(|level| (level.columns().count(), level.rows().len()));
        assert_eq!(counts, [(5, 5), (9, 9), (17, 19), (COLUMNS, HURSTS)]);
        assert!(Level::ALL.iter().all(|level| level.columns().last() == Some(COLUMNS - 1)));
        assert!(Level::ALL.iter().all(|level| level.rows().last() == Some(&(HURSTS - 1))));
    }
}
