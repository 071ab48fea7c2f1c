//! Moments of heights and gradients of the measured points.

/// Statistics of the points of one or more surfaces, after detrending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// Number of points.
    pub points: usize,
    /// Root mean square height about the mean (Rq of profiles, Sq of maps), m.
    pub rms_height: f64,
    /// Root mean square of the slope along rows, from differences of neighbours (RΔq).
    pub rms_slope: f64,
    /// Root mean square gradient of maps (Sdq): slopes along and between rows.
    pub rms_gradient: Option<f64>,
    /// Mean cube of the height over the cube of the rms height.
    pub skewness: f64,
    /// Mean fourth power of the height over that of the rms height: 3 for normally distributed heights.
    pub kurtosis: f64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    points: usize,
    squares: f64,
    cubes: f64,
    fourths: f64,
    /// Squares of slopes along and between rows, and their numbers.
    slopes: [(f64, usize); 2],
    has_profile: bool,
}

impl Sums {
    /// Adds the heights (m) in rows of `columns` points at distances (m) along and between rows, relative to the
    /// mean of each surface.
    pub fn add(&mut self, heights: &[f64], columns: usize, [along, between]: [f64; 2]) {
        let level = heights[0];
        let mean = level + heights.iter().map(|z| z - level).sum::<f64>() / heights.len() as f64;
        self.points += heights.len();
        for height in heights {
            let z = height - mean;
            self.squares += z * z;
            self.cubes += z * z * z;
            self.fourths += (z * z) * (z * z);
        }
        let mut add = |axis: usize, difference: f64| {
            self.slopes[axis].0 += difference * difference;
            self.slopes[axis].1 += 1;
        };
        for row in heights.chunks_exact(columns) {
            row.windows(2).for_each(|pair| add(0, (pair[1] - pair[0]) / along));
        }
        let rows = heights.len() / columns;
        for (below, above) in heights.iter().zip(heights.iter().skip(columns)) {
            add(1, (above - below) / between);
        }
        self.has_profile |= rows < 2;
    }

    pub fn statistics(&self) -> Statistics {
        let count = self.points as f64;
        let square = self.squares / count;
        let mean_square = |(sum, count): (f64, usize)| sum / count.max(1) as f64;
        let [along, between] = self.slopes.map(mean_square);
        Statistics {
            points: self.points,
            rms_height: square.sqrt(),
            rms_slope: along.sqrt(),
            rms_gradient: (!self.has_profile).then(|| (along + between).sqrt()),
            skewness: self.cubes / count / square.powf(1.5),
            kurtosis: self.fourths / count / (square * square),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_map_and_a_profile_are_those_by_hand() {
        let mut sums = Sums::default();
        sums.add(&[1.0, 2.0, 4.0, 1.0, 5.0, 5.0], 3, [0.5, 2.0]);
        let found = sums.statistics();
        // Mean 3: −2 −1 1 −2 2 2.
        assert!((found.rms_height - 3.0_f64.sqrt()).abs() < 1e-15);
        assert!((found.skewness - 0.0).abs() < 1e-15);
        assert!((found.kurtosis - (66.0 / 6.0) / 9.0).abs() < 1e-15);
        // Along rows 2 4 8 0, between rows 0 1.5 0.5.
        assert!((found.rms_slope.powi(2) - 84.0 / 4.0).abs() < 1e-13);
        assert!((found.rms_gradient.unwrap().powi(2) - (21.0 + 2.5 / 3.0)).abs() < 1e-13);
        sums.add(&[7.0, 7.0, 7.0], 3, [1.0; 2]);
        assert_eq!((sums.statistics().points, sums.statistics().rms_gradient), (9, None));
    }
}
