//! Periodograms of maps, which give the power of each plane wave of a map.

use super::axis_power::{AxisPlace, WavesByAxis};
use super::levelled::LevelledSurface;
use super::periodogram::{Wave, transform_rows, window};
use crate::error::SurfaceError;
use asperity_data::{check_room, emptied};
use asperity_fourier::{Complex64, plan_forward};
use std::f64::consts::{PI, TAU};

/// Memory in bytes per point that the computation of the spectrum of a map needs.
const BYTES: u64 = 48;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapPower {
    pub windowed: bool,
    /// Smallest wave numbers in rad/m, along the rows and perpendicular to the rows. They belong to
    /// the waves with one period over the map.
    pub steps: [f64; 2],
    /// Wave numbers 2π/Δ in rad/m, along the rows and perpendicular to the rows. Δ is the distance
    /// between points in this direction.
    pub sampling: [f64; 2],
    /// The waves with their power spectral densities C2D in m⁴, sorted by wave number, up to the
    /// smaller of the two Nyquist wave numbers. They cover only one half of the plane of wave
    /// numbers, because the other half has the same powers.
    pub waves: Vec<Wave>,
    /// True if short waves parallel to one axis are left out, because whole rows or columns are
    /// offset against each other.
    pub offsets: bool,
    /// Difference between the remaining waves parallel to an axis and the waves in neighbouring
    /// directions. It is the difference between the squared gradient of the waves parallel to the
    /// axis and the squared gradient that the neighbouring directions lead to expect, as a share of
    /// the squared gradient of the map. It is 0 if it is negligible or may be chance.
    pub apart: f64,
}

impl MapPower {
    /// Computes the power spectrum of a map. If each row was levelled, the waves perpendicular to
    /// the rows are left out, because levelling changes these waves.
    ///
    /// # Errors
    /// Returns an error if a Fourier transform fails, or if the memory does not suffice.
    pub fn new(map: &LevelledSurface) -> Result<Self, SurfaceError> {
        let [along, between] = map.distances;
        let steps = steps(map);
        let mut waves = waves_by_axis(map, steps)?.without_offsets();
        waves
            .waves
            .sort_unstable_by(|a, b| a.wave_number.total_cmp(&b.wave_number));
        Ok(MapPower {
            windowed: map.windowed,
            steps,
            sampling: [TAU / along, TAU / between],
            waves: waves.waves,
            offsets: waves.offsets,
            apart: waves.apart,
        })
    }
}

/// Returns all waves of a map up to the smaller of the two Nyquist wave numbers, in any order.
pub(super) fn waves_of_map(map: &LevelledSurface) -> Result<Vec<Wave>, SurfaceError> {
    Ok(waves_by_axis(map, steps(map))?.all())
}

/// Returns the smallest wave numbers in rad/m, along the rows and perpendicular to the rows. They
/// belong to the waves with one period over the map.
fn steps(map: &LevelledSurface) -> [f64; 2] {
    let [along, between] = map.distances;
    [
        TAU / (map.columns as f64 * along),
        TAU / (map.rows as f64 * between),
    ]
}

/// Computes the powers of the waves in one half of the plane of wave numbers. `steps` are the
/// smallest wave numbers in rad/m, along the rows and across the rows: the wave numbers of the
/// waves that fit once on the map.
fn waves_by_axis(map: &LevelledSurface, steps: [f64; 2]) -> Result<WavesByAxis, SurfaceError> {
    let [along, between] = map.distances;
    let columns = map.columns;
    let rows = map.rows;
    let points = map.heights.len();
    let half = columns / 2 + 1;
    check_room(BYTES * points as u64)?;
    let coefficients = transformed_rows(map)?;
    let plan = plan_forward(rows);
    let mut scratch = vec![Complex64::ZERO; plan.get_inplace_scratch_len()];
    let mut column = vec![Complex64::ZERO; rows];
    let row_window = window(rows, map.windowed);

    // A window function spreads the power of waves parallel to an axis over the next waves.
    let reach = if map.windowed { 1.0 } else { 0.0 };
    let mut waves = WavesByAxis::new(reach, emptied(Vec::new(), half * rows)?);
    let nyquist = (PI / along).min(PI / between);
    let scale = along * between / points as f64;
    let first = if map.aligned { reach as usize + 1 } else { 0 };
    for x in first..half {
        for (y, value) in column.iter_mut().enumerate() {
            *value = coefficients[y * half + x] * row_window[y];
        }
        plan.process_with_scratch(&mut column, &mut scratch);
        for (y, value) in column.iter().enumerate() {
            let x = x as f64;
            let y = signed_number(y, rows);
            // A wave and its mirror image have the same power, so only one of them is used.
            let is_first = x > 0.0 || y > 0.0;
            let wave_number = (x * steps[0]).hypot(y * steps[1]);
            if !is_first || wave_number >= nyquist {
                continue;
            }
            let wave = Wave {
                wave_number,
                power: scale * value.norm_sqr(),
            };
            let from_columns = AxisPlace {
                across: x,
                along: y.abs() / rows as f64,
            };
            let from_rows = AxisPlace {
                across: y.abs(),
                along: x / columns as f64,
            };
            waves.add(wave, [from_columns, from_rows]);
        }
    }
    Ok(waves)
}

/// Returns the Fourier coefficients of each row of a map.
fn transformed_rows(map: &LevelledSurface) -> Result<Vec<Complex64>, SurfaceError> {
    let columns = map.columns;
    let mut coefficients = emptied(Vec::new(), (columns / 2 + 1) * map.rows)?;
    let rows = map.heights.chunks_exact(columns);
    let rows = rows.map(|row| row.iter().copied());
    transform_rows(rows, columns, map.windowed, |row| {
        coefficients.extend_from_slice(row);
    })?;
    Ok(coefficients)
}

/// Returns the number of a wave across the rows, from its index in the Fourier transform. For
/// indices above half the number of rows, the number is negative.
fn signed_number(index: usize, rows: usize) -> f64 {
    if 2 * index > rows {
        index as f64 - rows as f64
    } else {
        index as f64
    }
}
