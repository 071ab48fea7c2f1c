//! Corrections of heights by medians: removal of outliers and levelling of rows. Outliers are
//! heights far from the heights around them, such as spikes of an instrument and grains of dust.

use asperity_data::{OutOfMemory, gathered, median};

/// Largest number of points on either side of a point, along each axis, whose heights are compared
/// with the height of this point.
const REACH: usize = 2;

/// Smallest distance of an outlier from the median of the heights around it, in units of the
/// standard deviation of all such distances.
const FAR: f64 = 4.0;

/// Ratio of the standard deviation of a normal distribution to its median absolute deviation.
const PER_MEDIAN_DEVIATION: f64 = 1.482_602_218_505_602;

/// Marks outliers as missing (NaN) by the identifier of Hampel, and returns their number. `columns`
/// is the number of points in a row.
///
/// A height is an outlier if it differs from the median of the heights around it by more than
/// [`FAR`] standard deviations. The standard deviation follows from the median of all such
/// differences. A tilt of the surface does not change the result, not even at borders, where a
/// point has fewer neighbours on one side.
pub(super) fn remove_outliers(heights: &mut [f64], columns: usize) -> Result<usize, OutOfMemory> {
    let distances = LevelledMap::new(heights, columns)?.distances()?;
    let known = || distances.iter().filter(|distance| distance.is_finite());
    let mut sizes = gathered(known().count(), known().map(|distance| distance.abs()))?;
    let most = FAR * PER_MEDIAN_DEVIATION * median(&mut sizes).unwrap_or(0.0);
    // Heights with few digits may give distances that are mostly zero. The standard deviation of
    // the distances is then unknown.
    if most <= 0.0 {
        return Ok(0);
    }
    let mut count = 0;
    for (height, distance) in heights.iter_mut().zip(&distances) {
        if distance.abs() > most {
            *height = f64::NAN;
            count += 1;
        }
    }
    Ok(count)
}

/// Heights in rows, with the tilt of the surface.
struct LevelledMap<'a> {
    heights: &'a [f64],
    columns: usize,
    rows: usize,
    /// Median differences between neighbours along and between the rows.
    tilt: [f64; 2],
}

impl<'a> LevelledMap<'a> {
    fn new(heights: &'a [f64], columns: usize) -> Result<Self, OutOfMemory> {
        let rows = heights.len() / columns;
        let along = median_difference(heights, 1)?;
        let between = if rows > 1 {
            median_difference(heights, columns)?
        } else {
            0.0
        };
        Ok(LevelledMap {
            heights,
            columns,
            rows,
            tilt: [along, between],
        })
    }

    /// Returns the height of a point without the tilt.
    fn level(&self, index: usize) -> f64 {
        let [along, between] = self.tilt;
        let row = index / self.columns;
        let column = index % self.columns;
        self.heights[index] - along * column as f64 - between * row as f64
    }

    /// Returns the distance of each height from the median of the heights around it.
    fn distances(&self) -> Result<Vec<f64>, OutOfMemory> {
        let mut around = Vec::with_capacity((2 * REACH + 1) * (2 * REACH + 1));
        let distances = (0..self.heights.len()).map(|index| {
            self.collect_around(index, &mut around);
            match median(&mut around) {
                Some(median) => self.level(index) - median,
                // A corner has no neighbours on opposite sides, so its height is not compared.
                None => 0.0,
            }
        });
        gathered(self.heights.len(), distances)
    }

    /// Collects the heights around a point, without the tilt. Along each axis equal numbers of
    /// points are taken on both sides, so that a remaining tilt does not change the median.
    fn collect_around(&self, index: usize, around: &mut Vec<f64>) {
        let row = index / self.columns;
        let column = index % self.columns;
        let rows_aside = reach(row, self.rows);
        let columns_aside = reach(column, self.columns);
        around.clear();
        for row in row - rows_aside..=row + rows_aside {
            let first = row * self.columns + column - columns_aside;
            for other in first..=first + 2 * columns_aside {
                let height = self.level(other);
                if other != index && height.is_finite() {
                    around.push(height);
                }
            }
        }
    }
}

/// Returns the number of points that are compared on either side of a place, along a line of
/// `count` points.
fn reach(place: usize, count: usize) -> usize {
    REACH.min(place).min(count - 1 - place)
}

/// Returns the median difference between heights that are `step` points apart.
fn median_difference(heights: &[f64], step: usize) -> Result<f64, OutOfMemory> {
    let differences = heights
        .iter()
        .zip(heights.iter().skip(step))
        .map(|(height, next)| next - height)
        .filter(|difference| difference.is_finite());
    let mut differences = gathered(heights.len(), differences)?;
    Ok(median(&mut differences).unwrap_or(0.0))
}

/// Subtracts from each row of `columns` points its median height.
pub(super) fn level_rows(heights: &mut [f64], columns: usize) -> Result<(), OutOfMemory> {
    let mut known = gathered(columns, std::iter::repeat_n(0.0, columns))?;
    for row in heights.chunks_exact_mut(columns) {
        known.clear();
        known.extend(row.iter().filter(|height| height.is_finite()));
        let level = median(&mut known).unwrap_or(0.0);
        for height in row {
            *height -= level;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spikes_are_outliers_and_slopes_are_not() {
        let columns = 40;
        let rough = |i: usize| (7.3 * (i * i % 101) as f64).sin();
        let tilted =
            |i: usize| 50.0 * (i % columns) as f64 - 20.0 * (i / columns) as f64 + rough(i);
        for rows in [1, 30] {
            let heights: Vec<f64> = (0..columns * rows).map(tilted).collect();
            let mut same = heights.clone();
            assert_eq!(
                (remove_outliers(&mut same, columns), &same),
                (Ok(0), &heights)
            );
            let mut spiked = heights.clone();
            let places = [17, columns * rows - 10];
            places.iter().for_each(|&place| spiked[place] += 400.0);
            spiked[5] = f64::NAN;
            assert_eq!(remove_outliers(&mut spiked, columns), Ok(places.len()));
            assert!(places.iter().all(|&place| spiked[place].is_nan()));
        }
        let mut flat = vec![1.0; 64];
        flat[30] = 9.0;
        assert_eq!(remove_outliers(&mut flat, 8), Ok(0));
    }

    #[test]
    fn levelled_rows_have_medians_of_zero() {
        let mut heights = [
            1.0,
            5.0,
            2.0,
            9.0,
            f64::NAN,
            7.0,
            f64::NAN,
            f64::NAN,
            f64::NAN,
        ];
        level_rows(&mut heights, 3).unwrap();
        assert_eq!(heights[..4], [-1.0, 3.0, 0.0, 1.0]);
        assert!(heights[5] == -1.0 && heights[6..].iter().all(|height| height.is_nan()));
    }
}
