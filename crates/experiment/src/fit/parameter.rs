//! Parameters of a fit: their names, units and ranges. A fit searches coordinates, such as the
//! logarithm of a value, from which the values of the parameters follow.

use crate::error::{ExperimentError, refused};
use asperity_data::parse_quantity;
use asperity_scene::fields::field;
use asperity_scene::text::did_you_mean;
use serde::{Serialize, Serializer};
use std::str::FromStr;

/// Parameter of a scene or of a measured curve that a [`Fit`](crate::Fit) can find.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// Work of adhesion γ in J/m².
    Work,
    /// Work of adhesion on closing γ₁ in J/m²: the energy per area that is gained when the contact
    /// area grows.
    ClosingWork,
    /// Effective modulus E* in Pa.
    Modulus,
    /// Displacement D₀ in m that the measured curve has at first touch.
    Offset,
    /// Force F₀ in N that the instrument reports before contact.
    Zero,
    /// Stiffness of the instrument in N/m.
    Stiffness,
    /// Radius R in m of the form of the scene, such as a sphere.
    Radius,
    /// Radius R₂ in m of the second of several spheres on one probe.
    SecondRadius,
    /// Distance b in m between the apexes of the first two spheres on one probe, in the direction
    /// of motion. The apex of the second sphere is behind the apex of the first sphere.
    Behind,
    /// Share s of the modulus that relaxes, from 0 to 1. The parameter `Modulus` is then the
    /// instantaneous modulus, before any relaxation.
    RelaxationShare,
    /// Relaxation time τ in s: the time in which the part of the modulus that still has to relax
    /// falls by the factor e.
    RelaxationTime,
}

impl Serialize for Parameter {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Values of all parameters in SI units, in the order of [`Parameter::ALL`].
pub(crate) type Values = [f64; Parameter::ALL.len()];

/// Names, symbol and SI unit of a [`Parameter`].
#[derive(Clone, Copy, Debug)]
pub struct ParameterRow {
    /// Name on the command line and in JSON, such as `closing_work`.
    pub name: &'static str,
    /// Name in words, such as `work of adhesion on closing`.
    pub term: &'static str,
    /// Symbol, such as `γ`.
    pub symbol: &'static str,
    /// SI unit, such as `J/m²`.
    pub unit: &'static str,
}

impl Parameter {
    /// All parameters, in the order in which tables list them.
    pub const ALL: [Parameter; 11] = [
        Parameter::Work,
        Parameter::ClosingWork,
        Parameter::Modulus,
        Parameter::Offset,
        Parameter::Zero,
        Parameter::Stiffness,
        Parameter::Radius,
        Parameter::SecondRadius,
        Parameter::Behind,
        Parameter::RelaxationShare,
        Parameter::RelaxationTime,
    ];

    /// Returns names, symbol and SI unit of the parameter.
    ///
    /// ```
    /// use asperity_experiment::Parameter;
    ///
    /// let row = Parameter::Work.row();
    /// assert_eq!((row.symbol, row.unit, row.term), ("γ", "J/m²", "work of adhesion"));
    /// ```
    pub fn row(self) -> ParameterRow {
        let row = |name, term, symbol, unit| ParameterRow {
            name,
            term,
            symbol,
            unit,
        };
        match self {
            Parameter::Work => row("work", "work of adhesion", "γ", "J/m²"),
            Parameter::ClosingWork => {
                row("closing_work", "work of adhesion on closing", "γ₁", "J/m²")
            }
            Parameter::Modulus => row("modulus", "effective modulus", "E*", "Pa"),
            Parameter::Offset => row("offset", "displacement at first touch", "D₀", "m"),
            Parameter::Zero => row("zero", "force before contact", "F₀", "N"),
            Parameter::Stiffness => row("stiffness", "loading stiffness", "k", "N/m"),
            Parameter::Radius => row("radius", "radius of the form", "R", "m"),
            Parameter::SecondRadius => {
                row("second_radius", "radius of the second sphere", "R₂", "m")
            }
            Parameter::Behind => row("behind", "distance of the second sphere behind", "b", "m"),
            Parameter::RelaxationShare => row(
                "relaxation_share",
                "share of the modulus that relaxes",
                "s",
                "1",
            ),
            Parameter::RelaxationTime => row("relaxation_time", "relaxation time", "τ", "s"),
        }
    }

    /// Returns the name of the parameter on the command line and in JSON, such as `closing_work`.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// Returns true for a parameter that may be positive or negative.
    pub(crate) fn is_signed(self) -> bool {
        matches!(self, Parameter::Offset | Parameter::Zero)
    }

    /// Returns true for a parameter that only a body with several spheres has.
    pub(crate) fn is_of_two_spheres(self) -> bool {
        matches!(self, Parameter::SecondRadius | Parameter::Behind)
    }

    /// Returns true for a parameter of the relaxation of the half-space.
    pub fn is_of_relaxation(self) -> bool {
        matches!(self, Parameter::RelaxationShare | Parameter::RelaxationTime)
    }

    /// Returns the smallest and the largest value, in SI units, that a scene allows for the
    /// parameter. `None` if scenes have no such limits, or if no search comes close to the limits.
    pub(crate) fn allowed_by_scenes(self) -> Option<(f64, f64)> {
        let path = match self {
            Parameter::Modulus => "material.youngs_modulus",
            Parameter::Stiffness => "loading_stiffness",
            Parameter::RelaxationShare => "material.relaxation.share",
            Parameter::RelaxationTime => "material.relaxation.time",
            _ => return None,
        };
        let (least, most) = field(path, None)?.range.ends()?;
        // Young's modulus is at least 3/4 of the effective modulus, so the smallest effective
        // modulus has to be larger by 4/3 for every Poisson ratio to be allowed.
        let factor = if self == Parameter::Modulus {
            4.0 / 3.0
        } else {
            1.0
        };
        Some((factor * least, most))
    }

    /// Returns true for a parameter that may be 0 but not negative.
    fn may_be_zero(self) -> bool {
        matches!(
            self,
            Parameter::Work
                | Parameter::ClosingWork
                | Parameter::Behind
                | Parameter::RelaxationShare
        )
    }

    /// Returns true for a parameter whose coordinate is its value divided by [`Coordinate::unit`].
    fn is_linear(self) -> bool {
        self.is_signed() || self == Parameter::Behind
    }

    /// Returns true if the parameter can be searched in the range from `low` to `high`.
    fn allows(self, low: f64, high: f64) -> bool {
        let is_allowed = self.is_signed() || low > 0.0 || self.may_be_zero() && low == 0.0;
        is_allowed && low < high && low.is_finite() && high.is_finite()
    }

    /// Returns the ranges in which the parameter can be searched, in words.
    fn ranges(self) -> String {
        let least = if self.is_signed() {
            ""
        } else if self.may_be_zero() {
            " of at least 0"
        } else {
            " above 0"
        };
        format!("two values{least}, the first below the second")
    }

    /// Returns in words a further measurement that helps if a fit cannot separate the parameters
    /// `first` and `second`. If both are the same parameter, the measurement helps to determine
    /// this parameter.
    ///
    /// ```
    /// use asperity_experiment::Parameter;
    ///
    /// let remedy = Parameter::remedy(Parameter::Modulus, Parameter::Radius);
    /// assert_eq!(remedy, "the radius from an image of the form");
    /// ```
    pub fn remedy(first: Parameter, second: Parameter) -> &'static str {
        use Parameter::{
            Behind, ClosingWork, Modulus, Offset, Radius, SecondRadius, Stiffness, Work, Zero,
        };
        if first.is_of_relaxation() || second.is_of_relaxation() {
            return "a rest between approach and retraction, or a curve at another speed";
        }
        if first == second {
            return "less noise, a larger preload, or its value from another measurement";
        }
        // The match below has each pair only in the order of [`Parameter::ALL`].
        let is_in_order = (first as usize) < second as usize;
        let pair = if is_in_order {
            (first, second)
        } else {
            (second, first)
        };
        match pair {
            (Modulus, Stiffness) => {
                "the stiffness of the instrument from a curve on a hard specimen"
            }
            (Modulus, Radius) => "the radius from an image of the form",
            (Work, Radius) => {
                "the radius from an image of the form, since the pull-off force has γR alone"
            }
            (Work, ClosingWork) => {
                "turning points at several preloads, since γ₁ acts where the contact grows"
            }
            (Work | Modulus | Radius, SecondRadius) => {
                "one radius from an image of the probe, since the pull-off forces have γR and γR₂ alone"
            }
            (SecondRadius, Behind) => "a preload at which both spheres are in contact",
            (Offset, Zero) => "a longer part before contact for the zero of the force",
            (Modulus, Offset) | (Offset, Stiffness) => {
                "a larger preload, or more points near first touch"
            }
            (Work, Modulus) => "a larger preload, where the elastic force exceeds the adhesion",
            _ => "a curve with another preload, or one of both from another measurement",
        }
    }
}

/// Parameter that a fit searches, with the range of the search if one is given. The parameter can
/// be parsed from a text: `work`, or `work=10mJ/m^2..1J/m^2` with a range.
///
/// ```
/// use asperity_experiment::{Free, Parameter};
///
/// assert_eq!(
///     "work=10mJ/m^2..1J/m^2".parse(),
///     Free::within(Parameter::Work, (0.01, 1.0)).map_err(|error| error.to_string())
/// );
/// let error = Free::within(Parameter::Modulus, (2e6, 1e6)).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "modulus: 2000000.0..1000000.0 Pa; allowed: two values above 0, the first below the second"
/// );
/// assert_eq!(Free::from(Parameter::Offset).range(), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free {
    /// Parameter that is searched.
    pub parameter: Parameter,
    /// Lower and upper end of the range in SI units. `None` means that the fit chooses a range
    /// around the initial value.
    pub(crate) range: Option<(f64, f64)>,
}

impl Free {
    /// Creates a free parameter with the lower and the upper end of its range, in the SI unit of
    /// the parameter.
    ///
    /// # Errors
    /// Returns an error if an end is not finite, if the lower end is not below the upper end, or if
    /// the parameter cannot have these values. Only `Offset` and `Zero` can be negative. Of the
    /// other parameters only `Work`, `ClosingWork`, `Behind` and `RelaxationShare` can be 0.
    pub fn within(parameter: Parameter, range: (f64, f64)) -> Result<Self, ExperimentError> {
        if parameter.allows(range.0, range.1) {
            return Ok(Free {
                parameter,
                range: Some(range),
            });
        }
        let ParameterRow { name, unit, .. } = parameter.row();
        refused(
            format!("{name}: {:?}..{:?} {unit}", range.0, range.1),
            parameter.ranges(),
        )
    }

    /// Returns both ends of the range in the SI unit of the parameter; `None` if the fit chooses
    /// the range.
    pub fn range(&self) -> Option<(f64, f64)> {
        self.range
    }
}

impl From<Parameter> for Free {
    fn from(parameter: Parameter) -> Self {
        Free {
            parameter,
            range: None,
        }
    }
}

impl FromStr for Free {
    type Err = String;

    /// Parses `work`, or `work=10mJ/m^2..1J/m^2` with a range.
    fn from_str(text: &str) -> Result<Self, String> {
        let Some((name, range)) = text.split_once('=') else {
            return Ok(parameter_of(text)?.into());
        };
        let parameter = parameter_of(name)?;
        Ok(Free {
            parameter,
            range: Some(range_of(parameter, range)?),
        })
    }
}

fn parameter_of(name: &str) -> Result<Parameter, String> {
    for parameter in Parameter::ALL {
        if parameter.name() == name {
            return Ok(parameter);
        }
    }
    let names = Parameter::ALL.map(Parameter::name);
    let near = did_you_mean(name, names);
    Err(format!(
        "{name:?} is not a parameter{near}; allowed: {}",
        names.join(", ")
    ))
}

/// Returns the lower and the upper end of a range such as `1..2`.
fn range_of(parameter: Parameter, text: &str) -> Result<(f64, f64), String> {
    let name = parameter.name();
    let allowed = format!("allowed: {}, such as {name}=1..2", parameter.ranges());
    let Some((low, high)) = text.split_once("..") else {
        return Err(allowed);
    };
    let unit = parameter.row().unit;
    let low = parse_quantity(low, unit).map_err(|error| format!("{error}; {allowed}"))?;
    let high = parse_quantity(high, unit).map_err(|error| format!("{error}; {allowed}"))?;
    if parameter.allows(low, high) {
        Ok((low, high))
    } else {
        Err(allowed)
    }
}

/// Coordinate in which a free parameter is searched. For the offset, the zero and the distance
/// behind, the coordinate is the value divided by [`Coordinate::unit`]. For the work of adhesion on
/// closing, it is the position from 0 to 1 of this work within its range, which ends at most at the
/// work of adhesion. For the work of adhesion and for the share that relaxes, it is linear up to
/// `unit` and logarithmic above it, so that these parameters can be 0. For the other parameters the
/// coordinate is a logarithm. A curve that is short compared with the relaxation time determines
/// only the ratio of the share to the relaxation time. In logarithmic coordinates the places with
/// the same ratio lie on a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coordinate {
    pub parameter: Parameter,
    pub start: f64,
    pub range: (f64, f64),
    /// Scale of the coordinate, as a value of the parameter in its SI unit. For much smaller values
    /// of the parameter, the coordinate is the value divided by this scale. The scale is used for
    /// the offset, the zero, the distance behind, the work of adhesion, and the share that relaxes.
    pub unit: f64,
}

impl Coordinate {
    /// Returns the coordinate of a value of the parameter: the value on the scale of the search.
    /// `values` has the other parameters.
    pub fn of(&self, value: f64, values: &Values) -> f64 {
        match self.parameter {
            Parameter::Work | Parameter::RelaxationShare => (value / self.unit).asinh(),
            Parameter::ClosingWork => {
                let (low, high) = self.range_on_closing(values);
                if high > low {
                    ((value - low) / (high - low)).clamp(0.0, 1.0)
                } else {
                    1.0
                }
            }
            parameter if parameter.is_linear() => value / self.unit,
            _ => value.ln(),
        }
    }

    /// Returns the value of the parameter at a coordinate, its value on the scale of the search.
    /// `values` has the other parameters.
    pub fn value(&self, coordinate: f64, values: &Values) -> f64 {
        match self.parameter {
            Parameter::Work | Parameter::RelaxationShare => coordinate.sinh() * self.unit,
            Parameter::ClosingWork => {
                let (low, high) = self.range_on_closing(values);
                low + coordinate.clamp(0.0, 1.0) * (high - low)
            }
            parameter if parameter.is_linear() => coordinate * self.unit,
            _ => coordinate.exp(),
        }
    }

    /// Returns the range of the work of adhesion on closing, which is at most the work of adhesion.
    fn range_on_closing(&self, values: &Values) -> (f64, f64) {
        let work = values[Parameter::Work as usize];
        (self.range.0.min(work), self.range.1.min(work))
    }

    /// Returns the coordinates of the lower and the upper end of the range.
    pub fn ends(&self) -> (f64, f64) {
        if self.parameter == Parameter::ClosingWork {
            return (0.0, 1.0);
        }
        // No other coordinate depends on other parameters.
        let values = [1.0; Parameter::ALL.len()];
        (
            self.of(self.range.0, &values),
            self.of(self.range.1, &values),
        )
    }

    /// Returns true if this is the coordinate of the work of adhesion and its range begins at 0.
    pub fn is_work_from_zero(&self) -> bool {
        self.parameter == Parameter::Work && self.range.0 == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinate(parameter: Parameter, range: (f64, f64)) -> Coordinate {
        Coordinate {
            parameter,
            start: range.0,
            range,
            unit: 0.5,
        }
    }

    #[test]
    fn values_come_back_from_their_coordinates() {
        let mut values = [1.0; Parameter::ALL.len()];
        values[Parameter::Work as usize] = 4.0;
        for (parameter, range, value, at) in [
            (Parameter::Work, (0.0, 10.0), 0.0, 0.0),
            (Parameter::Work, (0.0, 10.0), 3.0, 6.0_f64.asinh()),
            (Parameter::ClosingWork, (0.0, 10.0), 3.0, 0.75),
            (Parameter::ClosingWork, (2.0, 3.0), 2.5, 0.5),
            (Parameter::ClosingWork, (2.0, 10.0), 3.0, 0.5),
            (Parameter::Offset, (-3.0, 3.0), -2.0, -4.0),
            (Parameter::Zero, (-3.0, 3.0), 2.0, 4.0),
            (Parameter::Modulus, (1.0, 9.0), 5.0, 5.0_f64.ln()),
            (Parameter::Stiffness, (1.0, 9.0), 5.0, 5.0_f64.ln()),
            (Parameter::Radius, (1.0, 9.0), 5.0, 5.0_f64.ln()),
            (Parameter::SecondRadius, (1.0, 9.0), 5.0, 5.0_f64.ln()),
            (Parameter::Behind, (0.0, 9.0), 5.0, 10.0),
            (
                Parameter::RelaxationShare,
                (0.0, 0.95),
                0.5,
                1.0_f64.asinh(),
            ),
        ] {
            let found = coordinate(parameter, range);
            assert!((found.of(value, &values) - at).abs() < 1e-12, "{found:?}");
            assert!(
                (found.value(at, &values) - value).abs() < 1e-12,
                "{found:?}"
            );
        }
        // The work of adhesion on closing is at most the work of adhesion on opening, even if the
        // latter is 0.
        let closing = coordinate(Parameter::ClosingWork, (0.0, 10.0));
        assert_eq!(
            (closing.of(9.0, &values), closing.value(1.5, &values)),
            (1.0, 4.0)
        );
        assert_eq!(
            (
                closing.of(0.0, &[0.0; Parameter::ALL.len()]),
                closing.value(0.5, &[0.0; Parameter::ALL.len()])
            ),
            (1.0, 0.0)
        );
        assert_eq!(closing.ends(), (0.0, 1.0));
        assert_eq!(
            coordinate(Parameter::Offset, (-3.0, 3.0)).ends(),
            (-6.0, 6.0)
        );
        assert_eq!(
            coordinate(Parameter::Work, (0.0, 1.0)).ends(),
            (0.0, 2.0_f64.asinh())
        );
    }

    #[test]
    fn free_parameters_are_parsed_with_their_ranges() {
        let free = |text: &str| text.parse::<Free>();
        let range = |text: &str| free(text).unwrap().range;
        assert_eq!(
            free("offset"),
            Ok(Free {
                parameter: Parameter::Offset,
                range: None
            })
        );
        assert_eq!(range("work=0..1"), Some((0.0, 1.0)));
        assert_eq!(range("closing_work=0..20mJ/m^2"), Some((0.0, 0.02)));
        assert_eq!(range("behind=0..300nm"), Some((0.0, 3e-7)));
        assert_eq!(range("offset=-1um..0"), Some((-1e-6, 0.0)));
        for (text, said) in [
            (
                "work=-1..1",
                "allowed: two values of at least 0, the first below the second, such as work=1..2",
            ),
            (
                "modulus=0..1",
                "allowed: two values above 0, the first below the second, such as modulus=1..2",
            ),
            (
                "zero=2..1",
                "allowed: two values, the first below the second, such as zero=1..2",
            ),
            ("behind=-1..1", "allowed: two values of at least 0"),
            ("second_radius=0..1", "allowed: two values above 0"),
            ("radius=1", "allowed: two values above 0"),
            ("work=1..x", "\"x\""),
            ("wrok", "\"wrok\" is not a parameter"),
        ] {
            let error = free(text).unwrap_err();
            assert!(
                error.starts_with(said) || error.contains(said),
                "{text}: {error}"
            );
        }
    }
}
