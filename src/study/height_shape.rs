//! Deviation of the heights of one profile from a normal distribution.

/// Shape of a profile's own distribution of heights; both values are zero for the ensemble's normal distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightShape {
    /// ⟨z³⟩/⟨z²⟩^(3/2), heights counted from their mean.
    pub skewness: f64,
    /// ⟨z⁴⟩/⟨z²⟩² − 3.
    pub excess_kurtosis: f64,
}

impl HeightShape {
    /// Shape of these heights; `None` where all are equal.
    pub fn of(heights: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let (count, sum) =
            heights.clone().fold((0.0, 0.0), |(count, sum), height| (count + 1.0, sum + height));
        let mean = sum / count;
        let square = heights.clone().map(|height| (height - mean).powi(2)).sum::<f64>() / count;
        // In units of the rms height: third and fourth powers of heights could leave the range of numbers.
        let unit = square.sqrt();
        let (third, fourth) = heights.fold((0.0, 0.0), |(third, fourth), height| {
            let z = (height - mean) / unit;
            (third + z * z * z, fourth + z * z * z * z)
        });
        let shape = HeightShape { skewness: third / count, excess_kurtosis: fourth / count - 3.0 };
        (unit > 0.0 && shape.skewness.is_finite() && shape.excess_kurtosis.is_finite()).then_some(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_known_heights() {
        // A sine: ⟨sin⁴⟩ = 3/8, ⟨sin²⟩ = 1/2.
        let sine = (0..1000).map(|k| 3e-9 * (std::f64::consts::TAU * f64::from(k) / 1000.0).sin() + 1e-9);
        let shape = HeightShape::of(sine).unwrap();
        assert!(shape.skewness.abs() < 1e-12 && (shape.excess_kurtosis + 1.5).abs() < 1e-12, "{shape:?}");
        // One height of four is far off: deviations −1, −1, −1, 3 from the mean.
        let shape = HeightShape::of([0.0, 0.0, 0.0, 4.0].into_iter()).unwrap();
        assert!((shape.skewness - 6.0 / 3.0_f64.powf(1.5)).abs() < 1e-12);
        assert!((shape.excess_kurtosis - (21.0 / 9.0 - 3.0)).abs() < 1e-12);
        assert_eq!(HeightShape::of([2.0; 5].into_iter()), None);
        assert_eq!(HeightShape::of(std::iter::empty()), None);
    }
}
