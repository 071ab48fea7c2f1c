//! Steps of a field by a key: from the text of the present value to the text of the next value.

use super::field::{Field, Step};
use super::fields::fields_inside;
use super::range::{Range, choice_key, choice_name};
use super::text::ron_float;

/// Preferred numbers for small steps: the Renard series R20 of ISO 3.
const FINE_SERIES: &[f64] = &[
    1.0, 1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8, 3.15, 3.55, 4.0, 4.5, 5.0, 5.6, 6.3, 7.1,
    8.0, 9.0,
];
const COARSE_SERIES: &[f64] = &[1.0, 2.0, 5.0];

/// Relative difference below which a value counts as a member of a series.
const SAME: f64 = 1e-9;

impl Field {
    /// Returns the value of this field, in RON, after `steps` presses of a key in the explorer.
    /// `value` is the present value in RON. Negative `steps` lead to smaller values or earlier
    /// choices. If `coarse` is true, each step is a large one ([`Step`]); otherwise it is a small
    /// one. An optional field has the RON text `None` as a further choice. The function returns
    /// this choice as `Some("None")`.
    ///
    /// Returns `None` at the end of the range, or if keys cannot change the field. The steps of
    /// wavelengths depend on the length of the profile; [`Field::stepped_on`] computes them.
    pub fn stepped(&self, value: &str, steps: i32, coarse: bool) -> Option<String> {
        if steps == 0 {
            return None;
        }
        let next = match self.step {
            Step::Linear(fine, large) => {
                let size = if coarse { (large / fine).round() } else { 1.0 };
                let grid = (number(value)? / fine).round() + size * f64::from(steps);
                self.kept(decimal(grid * fine, fine))
            }
            Step::Logarithmic => self.kept(self.preferred(number(value)?, steps, coarse)?),
            Step::Integer(fine, large) => {
                let size = if coarse { large } else { fine };
                let distance = u64::from(steps.unsigned_abs()).saturating_mul(size);
                let value: u64 = ron::from_str(value).ok()?;
                let next = if steps < 0 {
                    value.saturating_sub(distance)
                } else {
                    value.saturating_add(distance)
                };
                self.kept_whole(next)
            }
            Step::Doubling => {
                let times = if coarse {
                    steps.saturating_mul(4)
                } else {
                    steps
                };
                self.kept_whole(doubled(ron::from_str(value).ok()?, times))
            }
            Step::Band => self.stepped_modes(value, steps, coarse),
            Step::Choice => self.chosen(value, steps),
            Step::Typed => None,
        };
        let next = next?;
        let is_same_number = number(&next).is_some_and(|next| number(value) == Some(next));
        (next != value && !is_same_number).then_some(next)
    }

    /// Returns the next pair of modes. Returns `None` for wavelengths, because their steps depend
    /// on the length of the profile.
    fn stepped_modes(&self, value: &str, steps: i32, coarse: bool) -> Option<String> {
        if let Range::Wavelengths(..) = self.range {
            return None;
        }
        let (mut first, mut last) = ron::from_str(value).ok()?;
        if coarse {
            first = doubled(first, steps);
        } else {
            last = doubled(last, steps);
        }
        let is_allowed =
            first <= last && self.range.contains_whole(first) && self.range.contains_whole(last);
        is_allowed.then(|| format!("({first}, {last})"))
    }

    /// Returns the value of this field after `steps` presses of a key, for a profile of the length
    /// `length` in m. Only wavelengths depend on the length; for all other fields the result is
    /// that of [`Field::stepped`]. A step of a wavelength changes how many waves fit on the length,
    /// and the new number of waves is a whole number. Among the possible wavelengths, the result is
    /// the nearest to a preferred number.
    ///
    /// ```
    /// let field = asperity_scene::fields::field("roughness.wavelengths", None).unwrap();
    /// // Ten waves in place of five. A profile of 100 µm has no wave between 100 and 50 µm.
    /// assert_eq!(
    ///     field.stepped_on(1e-4, "(2e-5, 1e-6)", -1, true).as_deref(),
    ///     Some("(1.0e-5, 1.0e-6)")
    /// );
    /// assert_eq!(
    ///     field.stepped_on(1e-4, "(5e-5, 1e-6)", 1, true).as_deref(),
    ///     Some("(1.0e-4, 1.0e-6)")
    /// );
    /// ```
    pub fn stepped_on(&self, length: f64, value: &str, steps: i32, coarse: bool) -> Option<String> {
        if !matches!(self.range, Range::Wavelengths(..)) {
            return self.stepped(value, steps, coarse);
        }
        let (mut longest, mut shortest) = ron::from_str::<(f64, f64)>(value).ok()?;
        let changed = if coarse { &mut longest } else { &mut shortest };
        *changed = self.whole_wave(length, *changed, steps, coarse)?;
        if !self.range.contains(*changed) {
            return None;
        }
        // The numbers of waves are compared instead of the wavelengths. The longest wavelength may
        // not be a whole fraction of the length and may round to the same number of waves as the
        // shortest one.
        let is_ordered = (length / longest).round() <= (length / shortest).round();
        if !is_ordered {
            return None;
        }
        Some(format!(
            "({}, {})",
            ron_float(longest.max(shortest)),
            ron_float(shortest.min(longest))
        ))
    }

    /// Returns the wavelength near the preferred number that is `steps` steps away, chosen so that
    /// a whole number of waves fits on the length. Returns `None` if not even one wave fits.
    fn whole_wave(&self, length: f64, wavelength: f64, steps: i32, coarse: bool) -> Option<f64> {
        if steps == 0 {
            return None;
        }
        let wanted = (length / self.preferred(wavelength, steps, coarse)?).round();
        let present = (length / wavelength).round();
        let waves = if steps > 0 {
            wanted.min(present - 1.0)
        } else {
            wanted.max(present + 1.0)
        };
        (waves >= 1.0).then(|| length / waves)
    }

    /// Returns the preferred number that is `steps` steps away from `value`. If the range of the
    /// field ends on the way, returns the first preferred number outside the range.
    fn preferred(&self, value: f64, steps: i32, coarse: bool) -> Option<f64> {
        let series = if coarse { COARSE_SERIES } else { FINE_SERIES };
        let mut next = preferred(value, series, steps > 0)?;
        for _ in 1..steps.unsigned_abs() {
            if !self.range.contains(next) {
                break;
            }
            next = preferred(next, series, steps > 0)?;
        }
        Some(next)
    }

    fn kept(&self, value: f64) -> Option<String> {
        let value = match self.range.ends() {
            Some((min, max)) if !self.range.contains(value) => value.clamp(min, max),
            _ => value,
        };
        self.range.contains(value).then(|| ron_float(value))
    }

    fn kept_whole(&self, value: u64) -> Option<String> {
        let Range::Whole(min, max) = self.range else {
            return None;
        };
        Some(value.clamp(min, max).to_string())
    }

    fn chosen(&self, value: &str, steps: i32) -> Option<String> {
        let Range::Choice(choices) = self.range else {
            return None;
        };
        let mut circle = Vec::new();
        if self.default == "None" {
            circle.push("None");
        }
        for choice in choices {
            if !self.requires_text(choice) {
                circle.push(choice);
            }
        }
        let here = circle
            .iter()
            .position(|choice| choice_key(choice) == choice_key(value));
        let count = i64::try_from(circle.len()).ok()?;
        let next = (i64::try_from(here.unwrap_or(0)).ok()? + i64::from(steps)).rem_euclid(count);
        let next = circle.get(usize::try_from(next).ok()?)?;
        Some((*next).to_owned())
    }

    /// Returns true if a choice requires a text such as the name of a file. Keys skip such a choice
    /// because a step cannot provide the text; the user has to type it.
    fn requires_text(&self, choice: &str) -> bool {
        fields_inside(self.path, Some(choice_name(choice)))
            .any(|field| field.default.is_empty() && matches!(field.range, Range::Text { .. }))
    }
}

fn number(text: &str) -> Option<f64> {
    ron::from_str(text)
        .ok()
        .filter(|value: &f64| value.is_finite())
}

/// Rounds a multiple of `unit` to the number of decimal digits of `unit`: 0.71 instead of
/// 0.7100000000000001.
fn decimal(value: f64, unit: f64) -> f64 {
    let digits = (-unit.log10()).ceil().max(0.0) as usize;
    format!("{value:.digits$}").parse().unwrap_or(value)
}

/// Returns the power of two that is `times` steps above a value, or below if `times` is negative.
fn doubled(value: u64, times: i32) -> u64 {
    let mut value = value;
    for _ in 0..times.unsigned_abs().min(64) {
        if times > 0 {
            let above = value.saturating_add(1).checked_next_power_of_two();
            value = above.unwrap_or(u64::MAX);
        } else if value > 1 {
            value = 1 << (value - 1).ilog2();
        }
    }
    value
}

/// Returns the member of a series of preferred numbers that follows `value`. The series is given in
/// [1, 10) and repeats in all decades.
fn preferred(value: f64, series: &[f64], up: bool) -> Option<f64> {
    if value == 0.0 {
        return None;
    }
    // Exponent and mantissa are read from the decimal text, which is exact at powers of ten,
    // whereas `log10` is not.
    let text = format!("{:e}", value.abs());
    let (mantissa, exponent) = text.split_once('e')?;
    let mantissa: f64 = mantissa.parse().ok()?;
    let mut exponent: i32 = exponent.parse().ok()?;
    let is_larger = up == (value > 0.0);
    let next_in_decade = if is_larger {
        series
            .iter()
            .find(|member| **member > mantissa * (1.0 + SAME))
    } else {
        series
            .iter()
            .rev()
            .find(|member| **member < mantissa * (1.0 - SAME))
    };
    let next_mantissa = match next_in_decade {
        Some(next) => *next,
        None if is_larger => {
            exponent += 1;
            1.0
        }
        None => {
            exponent -= 1;
            *series.last()?
        }
    };
    let next: f64 = format!("{next_mantissa}e{exponent}").parse().ok()?;
    Some(next.copysign(value))
}

#[cfg(test)]
mod tests {
    use super::super::fields::field;

    fn stepped(path: &str, value: &str, steps: i32, coarse: bool) -> Option<String> {
        field(path, None).unwrap().stepped(value, steps, coarse)
    }

    #[test]
    fn each_kind_of_field_steps_in_its_way() {
        for row in [
            "roughness.hurst|0.7|1|0.71",
            "roughness.hurst|0.7|-1c|0.6",
            "roughness.hurst|0.99|1|",
            "material.poisson_ratio|0.45|1c|0.5",
            "adhesion.work|0.05|1|0.056",
            "adhesion.work|0.1|-1c|0.05",
            "adhesion.work|0.0|1|",
            "length|1.0e-4|-1|9.0e-5",
            "length|1.0e-4|20|1.0e-3",
            "length|10.0|1|",
            "roughness.seed|1|-1c|0",
            "roughness.seed|18446744073709551615|1|",
            "numerics.points|1000|-1|512",
            "numerics.points|16384|1|32768",
            "numerics.points|1|-1|",
            "roughness.modes|(1, 512)|1|(1, 1024)",
            "roughness.modes|(1, 512)|1c|(2, 512)",
            "roughness.modes|(4, 4)|-1|",
            "form|None|1|Paraboloid(radius: 1.0e-3)",
            "form|Punch(radius: 0.3)|1|Spheres([(radius: 5.0e-6), (radius: 3.0e-6, behind: 2.0e-7)])",
            "form|Spheres([(radius: 1.0e-6)])|1|None",
            "numerics.solver|Exact|1|Stepwise(step: 1.0e-9)",
            "title|\"a\"|1|",
        ] {
            let [path, value, steps, next] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            let (number, coarse) = (
                steps.trim_end_matches('c').parse().unwrap(),
                steps.ends_with('c'),
            );
            assert_eq!(
                stepped(path, value, number, coarse).unwrap_or_default(),
                next,
                "{row}"
            );
        }
    }

    /// Each step changes the number of waves on the length. It reaches the next preferred
    /// wavelength if a whole number of these waves fits on the length.
    #[test]
    fn wavelengths_step_by_whole_waves() {
        for row in [
            "100|(1.0e-4, 2.0e-7)|1|(1.0e-4, 2.242152466367713e-7)",
            "100|(1.0e-4, 2.0e-7)|-1c|(5.0e-5, 2.0e-7)",
            // One wave is the smallest number of waves, so the longest wave cannot become longer
            // than the profile.
            "100|(1.0e-4, 2.0e-7)|1c|",
            "100|(8.0e-5, 2.0e-7)|1c|",
            // Two waves fit on the length, and for the next preferred wavelengths the number is
            // also two. The step therefore goes on to three waves.
            "100|(5.0e-5, 5.0e-5)|-1|(5.0e-5, 3.3333333333333335e-5)",
            "100|(1.0e-4, 5.0e-5)|1|(1.0e-4, 1.0e-4)",
            "100|(5.0e-5, 5.0e-5)|1|",
            "100|(5.0e-5, 5.0e-5)|-1c|",
            "320|(8.0e-5, 1.0e-6)|1c|(1.0666666666666667e-4, 1.0e-6)",
            "320|(8.0e-5, 1.0e-6)|-1c|(5.333333333333333e-5, 1.0e-6)",
            "320|(8.0e-5, 1.0e-6)|0|",
        ] {
            let [length, value, steps, next] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            let (number, coarse) = (
                steps.trim_end_matches('c').parse().unwrap(),
                steps.ends_with('c'),
            );
            let length = 1e-6 * length.parse::<f64>().unwrap();
            let field = field("roughness.wavelengths", None).unwrap();
            let stepped = field
                .stepped_on(length, value, number, coarse)
                .unwrap_or_default();
            assert_eq!(stepped.is_empty(), next.is_empty(), "{row}: {stepped}");
            if next.is_empty() {
                continue;
            }
            let [found, expected] =
                [&*stepped, next].map(|pair| ron::from_str::<(f64, f64)>(pair).unwrap());
            let deviations = [found.0 / expected.0 - 1.0, found.1 / expected.1 - 1.0];
            assert!(
                deviations.iter().all(|deviation| deviation.abs() < 1e-12),
                "{row}: {stepped}"
            );
        }
        assert_eq!(
            stepped("roughness.wavelengths", "(1.0e-4, 2.0e-7)", 1, false),
            None
        );
        // Each step must change the number of waves on the profile, and the steps must end when one
        // wave is left.
        let (mut value, mut counts) = ("(1.0e-4, 3.0e-7)".to_owned(), Vec::new());
        while let Some(next) = field("roughness.wavelengths", None)
            .unwrap()
            .stepped_on(1e-4, &value, 1, false)
        {
            let shortest: f64 = ron::from_str::<(f64, f64)>(&next).unwrap().1;
            counts.push((1e-4 / shortest).round());
            assert!(
                (1e-4 / shortest - counts[counts.len() - 1]).abs() < 1e-6,
                "{next}"
            );
            value = next;
        }
        assert!(
            counts.windows(2).all(|pair| pair[1] < pair[0]) && counts.last() == Some(&1.0),
            "{counts:?}"
        );
    }
}
