//! Axes of a parameter study: the quantities of a scene that vary, and their values.

use super::error::StudyError;
use asperity_contact::Move;
use asperity_data::{AxisScale, format_quantity, printable, round_to};
use asperity_scene::fields::{FIELDS, Field, Range, field};
use asperity_scene::text::did_you_mean;
use asperity_scene::{RoughnessParameter, Scene};
use serde::{Deserialize, Serialize};

/// Largest number of values on one [`Axis`].
pub const MOST_VALUES: u64 = 1_000_000;

/// Number of significant digits of values between the ends of an axis. Without rounding the value
/// 0.15 would become 0.15000000000000002.
const DIGITS: usize = 12;

/// Smallest relative difference with which two values of an axis count as different. A smaller
/// difference is a rounding error.
const APART: f64 = 1e-6;

/// Smallest ratio of the largest to the smallest value of an axis with which figures show it on a
/// logarithmic scale, if its values are listed one by one.
const LOGARITHMIC_RATIO: f64 = 50.0;

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Axis")]
pub(super) enum AxisText {
    Linear {
        path: String,
        from: f64,
        to: f64,
        count: u64,
    },
    Logarithmic {
        path: String,
        from: f64,
        to: f64,
        count: u64,
    },
    List {
        path: String,
        values: Vec<f64>,
    },
}

/// How the values of an [`Axis`] are spaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Spacing {
    /// Equal differences between neighbouring values.
    Linear,
    /// Equal ratios between neighbouring values.
    Logarithmic,
    /// Values given one by one, at any distances.
    List,
}

/// Axis of a study. An axis is a quantity of the scene that the study varies, with the values that
/// the study gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Path of the field of the scene that varies, such as `roughness.hurst`. For a quantity
    /// without a field, this is one of the names [`Axis::DERIVED`], such as `preload`.
    pub path: String,
    /// Name of the quantity in words, such as `Hurst exponent`.
    pub name: String,
    /// Symbol of the quantity, such as `F_n`, in which `_` begins a subscript; empty if the
    /// quantity has no symbol.
    pub symbol: &'static str,
    /// SI unit of the values; `1` for numbers without a unit.
    pub unit: &'static str,
    /// How the values are spaced.
    pub spacing: Spacing,
    /// Values of the quantity in the unit [`Axis::unit`], in the order in which the plan of the
    /// study lists them. On an axis of a [`Grid`](crate::maps::Grid) the values ascend.
    pub values: Vec<f64>,
    pub(super) target: Target,
}

impl Axis {
    /// Quantities that an axis may vary although a scene has no field for them: `preload` (in units
    /// of E* h L), `preload_in_N`, and `springs_per_wave` (number of springs per shortest wave of
    /// the roughness). E* is the effective modulus, h the rms height and L the length of the
    /// profile.
    pub const DERIVED: &[&str] = &["preload", "preload_in_N", "springs_per_wave"];

    /// Creates an axis that varies one numeric field of a scene. `path` is the path of this field,
    /// such as `roughness.hurst`. `values` are its values in its SI unit.
    ///
    /// # Errors
    /// Returns an error if a scene has no numeric field with this path.
    ///
    /// ```
    /// use asperity_study::{Axis, Spacing};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?;
    /// let axis = Axis::new(
    ///     "roughness.hurst",
    ///     Spacing::List,
    ///     vec![0.2, 0.8],
    ///     scene.scene(),
    /// )?;
    /// assert_eq!(
    ///     (axis.symbol, axis.count(), axis.next_beyond(0.2, 1)),
    ///     ("H", 2, Some(0.8))
    /// );
    /// let error =
    ///     Axis::new("roughness.hurts", Spacing::List, Vec::new(), scene.scene()).unwrap_err();
    /// assert!(error.to_string().contains("did you mean roughness.hurst?"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(
        path: &str,
        spacing: Spacing,
        values: Vec<f64>,
        scene: &Scene,
    ) -> Result<Axis, StudyError> {
        let target = Target::of(path)?;
        let (name, symbol, unit) = target.label(path, scene);
        Ok(Axis {
            path: path.to_owned(),
            name,
            symbol,
            unit,
            spacing,
            values,
            target,
        })
    }

    /// Creates an axis from the text of a plan, and checks it.
    ///
    /// # Errors
    /// Returns a message if the axis has an error. The message says what is allowed.
    pub(super) fn of(text: &AxisText, scene: &Scene) -> Result<Axis, String> {
        let (AxisText::Linear { path, .. }
        | AxisText::Logarithmic { path, .. }
        | AxisText::List { path, .. }) = text;
        let path = printable(path);
        let axis = Axis::new(&path, Spacing::List, Vec::new(), scene)
            .map_err(|error| format!("axis {error}"))?;
        axis.with_values(text)
            .map_err(|what| format!("axis {path}: {what}"))
    }

    /// Adds the values to the axis: those that `text` lists, or those that it requests between two
    /// ends.
    fn with_values(self, text: &AxisText) -> Result<Axis, String> {
        let mut axis = self;
        match *text {
            AxisText::List { ref values, .. } => {
                axis.spacing = Spacing::List;
                axis.values.clone_from(values);
            }
            AxisText::Linear {
                from, to, count, ..
            } => {
                check_ends(from, to, count, MOST_VALUES).map_err(|error| error.to_string())?;
                if !(to - from).is_finite() {
                    return Err(format!(
                        "from {from:?} to {to:?}: the range overflows a 64-bit float"
                    ));
                }
                axis.spacing = Spacing::Linear;
                axis.values =
                    axis.between(from, to, count, |share| from * (1.0 - share) + to * share);
            }
            AxisText::Logarithmic {
                from, to, count, ..
            } => {
                check_ends(from, to, count, MOST_VALUES).map_err(|error| error.to_string())?;
                check_logarithm(from).map_err(|error| error.to_string())?;
                let first = from.ln();
                let last = to.ln();
                axis.spacing = Spacing::Logarithmic;
                axis.values = axis.between(from, to, count, |share| {
                    (first * (1.0 - share) + last * share).exp()
                });
            }
        }
        axis.check_values()?;
        Ok(axis)
    }

    fn check_values(&self) -> Result<(), String> {
        let count = self.values.len();
        if count == 0 {
            return Err("no values; allowed: at least one".into());
        }
        if count as u64 > MOST_VALUES {
            return Err(format!("{count} values; allowed: at most {MOST_VALUES}"));
        }
        if let Some(value) = self.values.iter().find(|value| !value.is_finite()) {
            return Err(format!("{value:?}: values must be finite"));
        }
        if self.is_whole() {
            for value in &self.values {
                let is_whole = *value >= 0.0 && value.fract() == 0.0;
                if !is_whole {
                    return Err(format!("{value:?}: allowed: whole numbers"));
                }
            }
        }
        for pair in self.ascending().values.windows(2) {
            if pair[0] == pair[1] {
                return Err(format!("the value {:?} appears twice", pair[0]));
            }
        }
        Ok(())
    }

    /// Returns `count` values from `from` to `to`. `value` returns the value at a share of the
    /// distance, from 0 to 1. Values between the ends are rounded to 12 significant digits, or to
    /// whole numbers if the quantity has only whole numbers.
    fn between(&self, from: f64, to: f64, count: u64, value: impl Fn(f64) -> f64) -> Vec<f64> {
        let last = count - 1;
        let mut values = vec![from];
        for index in 1..last {
            let value = value(index as f64 / last as f64);
            values.push(if self.is_whole() {
                value.round()
            } else {
                round_to(value, DIGITS)
            });
        }
        values.push(to);
        values
    }

    /// Returns true if the quantity of this axis has only whole numbers as values, such as a number
    /// of springs.
    pub fn is_whole(&self) -> bool {
        self.target.is_whole()
    }

    /// Returns true if the quantity of this axis is the preload.
    pub fn is_of_preloads(&self) -> bool {
        matches!(self.target, Target::Preload { .. })
    }

    /// Returns the number of values on the axis.
    pub fn count(&self) -> u64 {
        self.values.len() as u64
    }

    /// Returns the scale, linear or logarithmic, on which figures show the values of this axis.
    pub fn scale(&self) -> AxisScale {
        let low = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = self
            .values
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        match self.spacing {
            Spacing::Logarithmic => AxisScale::Logarithmic,
            Spacing::List if low > 0.0 && high >= LOGARITHMIC_RATIO * low => AxisScale::Logarithmic,
            _ => AxisScale::Linear,
        }
    }

    /// Returns the symbol of the quantity of this axis, or the name of the quantity if it has no
    /// symbol.
    pub fn symbol_or_name(&self) -> &str {
        if self.symbol.is_empty() {
            &self.name
        } else {
            self.symbol
        }
    }

    /// Returns the symbol of the quantity of this axis, or [`Axis::path`] if the quantity has no
    /// symbol.
    pub fn symbol_or_path(&self) -> String {
        if self.symbol.is_empty() {
            self.path.clone()
        } else {
            self.symbol.to_owned()
        }
    }

    /// Returns one value of the axis as text, with the symbol or name of the axis, such as `H =
    /// 0.3`. `place` is the index of the value.
    pub(super) fn at(&self, place: usize) -> String {
        let equals = if self.symbol.is_empty() { "" } else { "= " };
        format!(
            "{} {equals}{}",
            self.symbol_or_name(),
            format_quantity(self.values[place], self.unit)
        )
    }

    /// Returns another value of this axis, counted from `value`: the one `steps` values further up,
    /// or further down if `steps` is negative. The values of the axis must ascend. If fewer than
    /// `steps` values lie in this direction, the last value of the axis in this direction is
    /// returned. If no value lies in this direction, `None` is returned.
    pub fn next_beyond(&self, value: f64, steps: i32) -> Option<f64> {
        let values = &self.values;
        let apart = APART * value.abs();
        let further = steps.unsigned_abs().checked_sub(1)? as usize;
        if steps > 0 {
            let above = value + apart;
            let next = values.iter().position(|known| *known > above)?;
            let index = next.saturating_add(further).min(values.len() - 1);
            return Some(values[index]);
        }
        let below = value - apart;
        let next = values.iter().rposition(|known| *known < below)?;
        Some(values[next.saturating_sub(further)])
    }

    /// Returns the indices of the values of this axis, sorted so that the values ascend.
    pub(super) fn order(&self) -> Vec<usize> {
        let mut places: Vec<usize> = (0..self.values.len()).collect();
        places.sort_by(|first, second| self.values[*first].total_cmp(&self.values[*second]));
        places
    }

    pub(super) fn ascending(&self) -> Axis {
        let mut axis = self.clone();
        axis.values.sort_by(f64::total_cmp);
        axis
    }
}

/// Paths of the numbers of a scene that cannot be varied. The version is not a parameter of the
/// contact, and the seeds of the profiles follow from the seed of the plan.
const FIXED: &[&str] = &["version", "roughness.seed"];

/// Endings of the paths of numbers. A single number has no ending; the two numbers of a pair have
/// the endings `.0` and `.1`.
const ENDS: [&str; 3] = ["", ".0", ".1"];

/// Quantity that an axis varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Target {
    /// A numeric field of a scene, or one of the two numbers of a field that is a pair.
    Number(&'static Field),
    /// Force in N or indentation in m at which a stage of the loading ends. The contained index of
    /// the stage begins at 0.
    Stage(usize),
    /// Preload F_n: in N if `in_newtons` is true, otherwise in units of E* h L (effective modulus,
    /// rms height, length of the profile).
    Preload { in_newtons: bool },
    /// Number of springs per shortest wave of the roughness. The shortest wave has as many periods
    /// over the length of the profile as the number of all springs divided by this number.
    SpringsPerWave,
}

/// Part of the computation that has to be repeated if a number of the scene changes. A later
/// variant of this enum repeats less than an earlier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shapes {
    /// All steps are repeated, beginning with the Fourier transform that computes the heights of
    /// the roughness.
    Roughness,
    /// The profile is made again from known heights of the roughness. The contact tree and the
    /// loading are then computed again.
    Profile,
    /// Only the loading is computed again, on the same profile and contact tree.
    Passes,
}

/// Returns the field of a scene that holds the number at a path; `None` for a path that cannot be
/// varied.
fn number(path: &str) -> Option<&'static Field> {
    for end in ENDS {
        let Some(field) = path.strip_suffix(end).and_then(|path| field(path, None)) else {
            continue;
        };
        let is_number = match field.range {
            Range::Real(..) | Range::Whole(..) => end.is_empty(),
            Range::Band(..) | Range::Wavelengths(..) => !end.is_empty(),
            _ => false,
        };
        if is_number && !FIXED.contains(&field.path) {
            return Some(field);
        }
    }
    None
}

/// Returns a question such as `did you mean roughness.hurst?` that names the path most similar to a
/// wrong path; empty if no path is similar.
fn nearest_path(path: &str) -> String {
    if let Some(parameter) = RoughnessParameter::named(path) {
        return format!("; did you mean {}?", parameter.path());
    }
    let [first, second] = [".0", ".1"].map(|end| format!("{path}{end}"));
    if number(&first).is_some() && number(&second).is_some() {
        return format!("; did you mean {first} or {second}?");
    }
    let mut numbers = Vec::new();
    for field in FIELDS {
        for end in ENDS {
            let path = format!("{}{end}", field.path);
            if number(&path).is_some() {
                numbers.push(path);
            }
        }
    }
    let numbers = numbers.iter().map(String::as_str);
    did_you_mean(path, numbers.chain(Axis::DERIVED.iter().copied()))
}

impl Target {
    /// Returns the quantity that a path names, such as `roughness.hurst` or `preload`.
    ///
    /// # Errors
    /// Returns an error with the nearest path if no number has this path.
    pub fn of(path: &str) -> Result<Target, StudyError> {
        match path {
            "preload" => return Ok(Target::Preload { in_newtons: false }),
            "preload_in_N" => return Ok(Target::Preload { in_newtons: true }),
            "springs_per_wave" => return Ok(Target::SpringsPerWave),
            _ => {}
        }
        if let Some(field) = number(path) {
            return Ok(Target::Number(field));
        }
        let stage = path
            .strip_prefix("loading.")
            .and_then(|stage| stage.strip_suffix(".0"));
        if let Some(Ok(stage)) = stage.map(str::parse) {
            return Ok(Target::Stage(stage));
        }
        let found = format!("no such number{}", nearest_path(path));
        let derived = Axis::DERIVED.join(", ");
        let allowed = format!("numbers of a scene by their paths, and {derived}");
        Err(StudyError::refused(Some(path), found, allowed))
    }

    /// Returns true if the quantity can only be a whole number.
    pub fn is_whole(self) -> bool {
        matches!(self, Target::Number(field) if !matches!(field.range, Range::Real(..) | Range::Wavelengths(..)))
    }

    /// Returns this quantity as a roughness parameter; `None` for any other quantity. The two
    /// roughness parameters, κ and e_el/γ, compare the roughness with the work of adhesion, and a
    /// scene may state one of them in place of the work of adhesion.
    pub fn parameter(self) -> Option<RoughnessParameter> {
        match self {
            Target::Number(field) => RoughnessParameter::named(field.path),
            _ => None,
        }
    }

    /// Returns which part of the computation is repeated when the quantity changes.
    pub fn shapes(self) -> Shapes {
        let field = match self {
            Target::SpringsPerWave => return Shapes::Roughness,
            Target::Stage(_) | Target::Preload { .. } => return Shapes::Passes,
            Target::Number(field) => field,
        };
        let group = field.path.split('.').next().unwrap_or_default();
        match (group, field.path) {
            // The heights of the roughness are computed for one amplitude and then scaled.
            ("form", _) | (_, "length" | "roughness.rms_height" | "roughness.rms_gradient") => {
                Shapes::Profile
            }
            ("roughness", _) | (_, "numerics.points") => Shapes::Roughness,
            _ => Shapes::Passes,
        }
    }

    /// Returns the name, the symbol and the SI unit of this quantity. `path` is its path in
    /// `scene`. The symbol is empty if the quantity has none.
    pub fn label(self, path: &str, scene: &Scene) -> (String, &'static str, &'static str) {
        match self {
            Target::Preload { in_newtons: true } => ("preload".into(), "F_n", "N"),
            Target::Preload { in_newtons: false } => ("preload".into(), "F_n/(E* h L)", "1"),
            Target::SpringsPerWave => ("springs per wave".into(), "", "1"),
            Target::Stage(stage) => match scene.loading.get(stage) {
                Some(Move::ToIndentation(_)) => {
                    (format!("indentation of stage {}", stage + 1), "", "m")
                }
                Some(Move::ToDisplacement(_)) => {
                    (format!("displacement of stage {}", stage + 1), "", "m")
                }
                Some(Move::Hold(_)) => (format!("time of stage {}", stage + 1), "", "s"),
                _ => (format!("force of stage {}", stage + 1), "", "N"),
            },
            Target::Number(Field {
                range: Range::Band(..),
                ..
            }) if path.ends_with(".0") => ("first mode".into(), "k_min", "1"),
            Target::Number(Field {
                range: Range::Band(..),
                ..
            }) => ("last mode".into(), "k_max", "1"),
            Target::Number(Field {
                range: Range::Wavelengths(..),
                symbol,
                unit,
                ..
            }) => {
                let which = if path.ends_with(".0") {
                    "longest"
                } else {
                    "shortest"
                };
                (format!("{which} wavelength"), symbol, unit)
            }
            Target::Number(field) => (field.name.into(), field.symbol, field.unit),
        }
    }
}

pub(super) fn check_logarithm(from: f64) -> Result<(), StudyError> {
    if from > 0.0 {
        return Ok(());
    }
    let found = format!("a logarithmic axis from {from:?}");
    Err(StudyError::refused(None, found, "one that begins above 0"))
}

pub(super) fn check_ends(from: f64, to: f64, count: u64, most: u64) -> Result<(), StudyError> {
    if !(2..=most).contains(&count) {
        let found = format!("count = {count}");
        let allowed = format!("from 2 to {most}");
        return Err(StudyError::refused(None, found, allowed));
    }
    let found = format!("from {from:?} to {to:?}");
    if !(from.is_finite() && to.is_finite()) {
        return Err(StudyError::refused(None, found, "two finite ends"));
    }
    if from >= to {
        return Err(StudyError::refused(None, found, "`from` less than `to`"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    fn axis(text: &str) -> Result<Axis, String> {
        Axis::of(
            &ron::from_str(text).unwrap(),
            open("rough-sphere").unwrap().scene(),
        )
    }

    #[test]
    fn values_between_the_ends_are_round() {
        for (text, values) in [
            (
                "Linear(path: \"roughness.hurst\", from: 0.1, to: 0.9, count: 17)",
                [0.1, 0.15, 0.2, 0.25],
            ),
            (
                "Logarithmic(path: \"adhesion.work\", from: 1e-3, to: 10.0, count: 5)",
                [1e-3, 0.01, 0.1, 1.0],
            ),
            (
                "Logarithmic(path: \"numerics.points\", from: 8, to: 128, count: 9)",
                [8.0, 11.0, 16.0, 23.0],
            ),
        ] {
            assert_eq!(axis(text).unwrap().values[..4], values, "{text}");
        }
    }

    #[test]
    fn errors_state_what_is_allowed() {
        for (text, said) in [
            (
                "Linear(path: \"roughness.hurts\", from: 0.1, to: 0.9, count: 3)",
                "you mean roughness.hurst?",
            ),
            (
                "Linear(path: \"kappa\", from: 0.1, to: 0.9, count: 3)",
                "did you mean adhesion.kappa?",
            ),
            (
                "Linear(path: \"adhesion.kappa\", from: 2.0, to: 1.0, count: 3)",
                "less than `to`",
            ),
            (
                "Linear(path: \"adhesion.kappa\", from: NaN, to: 1.0, count: 3)",
                "two finite ends",
            ),
            (
                "Linear(path: \"adhesion.kappa\", from: -1e308, to: 1.7e308, count: 3)",
                "overflows",
            ),
            (
                "Linear(path: \"adhesion.kappa\", from: 1.0, to: 2.0, count: 999999999)",
                "from 2 to 1000000",
            ),
            (
                "Logarithmic(path: \"adhesion.kappa\", from: 0.0, to: 1.0, count: 3)",
                "begins above 0",
            ),
            ("List(path: \"adhesion.kappa\", values: [])", "no values"),
            (
                "List(path: \"adhesion.kappa\", values: [1.0, inf])",
                "values must be finite",
            ),
            (
                "List(path: \"adhesion.kappa\", values: [1.0, 2.0, 1.0])",
                "the value 1.0 appears twice",
            ),
            (
                "Linear(path: \"numerics.points\", from: 2.0, to: 4.0, count: 9)",
                "appears twice",
            ),
            (
                "Linear(path: \"numerics.points\", from: 2.5, to: 4.0, count: 2)",
                "2.5: allowed: whole",
            ),
        ] {
            let wrong = axis(text).unwrap_err();
            assert!(wrong.contains(said), "{text}: {wrong}");
        }
    }

    #[test]
    fn steps_go_to_the_next_value_of_the_axis_and_end_with_it() {
        let scene = open("pressure-sensitive").unwrap().scene().clone();
        let axes = crate::plan::Plan::of_map(&scene).unwrap().axes;
        let to = |value, steps| axes[0].next_beyond(value, steps);
        assert_eq!(
            (to(6.0, 1), to(6.0, -1), to(6.0, 4)),
            (Some(6.73), Some(5.66), Some(11.3))
        );
        // If the present value differs from a value of the axis only by rounding, the next value of
        // the axis follows.
        assert_eq!(
            (to(1.0 + 1e-12, 1), to(1.0 - 1e-12, -1)),
            (Some(1.19), Some(0.841))
        );
        assert_eq!(
            (to(31.0, 100), to(32.0, 1), to(0.125, -1)),
            (Some(32.0), None, None)
        );
        assert_eq!(
            (to(100.0, -1), to(100.0, 1), to(1e-3, 1)),
            (Some(32.0), None, Some(0.125))
        );
        assert_eq!(
            (to(6.0, 0), to(6.0, i32::MIN), to(6.0, i32::MAX)),
            (None, Some(0.125), Some(32.0))
        );
    }
}
