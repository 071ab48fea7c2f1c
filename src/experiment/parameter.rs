//! Parameters of a fit: names, units, ranges, and the coordinates in which a fit looks for them.

use crate::scene::{did_you_mean, parse_quantity};
use std::str::FromStr;

/// Parameter of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Work of adhesion.
    Work,
    /// Work of adhesion on closing.
    ClosingWork,
    /// Effective modulus.
    Modulus,
    /// Measured displacement at first touch.
    Offset,
    /// Force before contact.
    Zero,
    /// Stiffness of the instrument.
    Stiffness,
    /// Radius of the form.
    Radius,
}

/// Values of all parameters in SI units, in the order of [`Parameter::ALL`].
pub(super) type Values = [f64; 7];

/// Texts of a parameter, see [`Parameter::row`].
type Row = (&'static str, &'static str, &'static str, &'static str);

impl Parameter {
    /// All parameters, in the order of tables.
    pub const ALL: [Parameter; 7] = {
        use Parameter::{ClosingWork, Modulus, Offset, Radius, Stiffness, Work, Zero};
        [Work, ClosingWork, Modulus, Offset, Zero, Stiffness, Radius]
    };

    /// Name on the command line and in JSON, technical term, symbol and SI unit.
    pub fn row(self) -> Row {
        const ROWS: [Row; 7] = [
            ("work", "work of adhesion", "γ", "J/m²"),
            ("closing_work", "work of adhesion on closing", "γ₁", "J/m²"),
            ("modulus", "effective modulus", "E*", "Pa"),
            ("offset", "displacement at first touch", "D₀", "m"),
            ("zero", "force before contact", "F₀", "N"),
            ("stiffness", "loading stiffness", "k", "N/m"),
            ("radius", "radius of the form", "R", "m"),
        ];
        ROWS[self as usize]
    }

    /// Name on the command line and in JSON.
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// Returns true for a parameter of either sign.
    pub(super) fn is_signed(self) -> bool {
        matches!(self, Parameter::Offset | Parameter::Zero)
    }

    /// Measurement that separates two parameters, or one from all others, where a curve does not.
    pub fn remedy(one: Parameter, other: Parameter) -> &'static str {
        use Parameter::{ClosingWork, Modulus, Offset, Radius, Stiffness, Work, Zero};
        let rows = [
            (Modulus, Stiffness, "the stiffness of the instrument from a curve on a hard specimen"),
            (Modulus, Radius, "the radius from an image of the form"),
            (Work, Radius, "the radius from an image of the form, since the pull-off force has γR alone"),
            (Work, ClosingWork, "turning points at several preloads, since γ₁ acts where the contact grows"),
            (Offset, Zero, "a longer part before contact for the zero of the force"),
            (Modulus, Offset, "a larger preload, or more points near first touch"),
            (Offset, Stiffness, "a larger preload, or more points near first touch"),
            (Work, Modulus, "a larger preload, where the elastic force exceeds the adhesion"),
        ];
        let is = |row: &&(Parameter, Parameter, &str)| [(one, other), (other, one)].contains(&(row.0, row.1));
        let usual = if one == other {
            "less noise, a larger preload, or its value from another measurement"
        } else {
            "a curve with another preload, or one of both from another measurement"
        };
        rows.iter().find(is).map_or(usual, |row| row.2)
    }
}

/// A parameter to be found, with its range if that is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free {
    /// The parameter.
    pub parameter: Parameter,
    /// Ends of its range in SI units; `None`: around its start.
    pub range: Option<(f64, f64)>,
}

impl FromStr for Free {
    type Err = String;

    /// Parses `work`, or with a range `work=10mJ/m^2..1J/m^2`.
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, range) = text.split_once('=').map_or((text, None), |(name, range)| (name, Some(range)));
        let names = Parameter::ALL.map(Parameter::name);
        let parameter = Parameter::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| {
            let near = did_you_mean(name, names);
            format!("{name:?} is not a parameter{near}; allowed: {}", names.join(", "))
        })?;
        let above = if parameter.is_signed() { "" } else { " above 0" };
        let allowed =
            || format!("allowed: two values{above}, the first below the second, such as {name}=1..2");
        let end = |text: &str| {
            parse_quantity(text, parameter.row().3).map_err(|error| format!("{error}; {}", allowed()))
        };
        let ends = |range: &str| {
            let (low, high) = range.split_once("..").ok_or_else(allowed)?;
            let (low, high) = (end(low)?, end(high)?);
            if low < high && (low > 0.0 || parameter.is_signed()) { Ok((low, high)) } else { Err(allowed()) }
        };
        Ok(Free { parameter, range: range.map(ends).transpose()? })
    }
}

/// Coordinate of a free parameter: its value over a unit, its share of the work of adhesion, or its logarithm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coordinate {
    pub parameter: Parameter,
    pub start: f64,
    pub range: (f64, f64),
    /// Unit of a parameter of either sign.
    pub unit: f64,
}

impl Coordinate {
    pub fn of(&self, value: f64, values: &Values) -> f64 {
        match self.parameter {
            Parameter::ClosingWork => (value / values[Parameter::Work as usize]).min(1.0),
            parameter if parameter.is_signed() => value / self.unit,
            _ => value.ln(),
        }
    }

    /// Value at a coordinate, for these values of the other parameters.
    pub fn value(&self, at: f64, values: &Values) -> f64 {
        match self.parameter {
            Parameter::ClosingWork => at.clamp(0.0, 1.0) * values[Parameter::Work as usize],
            parameter if parameter.is_signed() => at * self.unit,
            _ => at.exp(),
        }
    }

    /// Coordinates of the ends of the range.
    pub fn ends(&self) -> (f64, f64) {
        match self.parameter {
            Parameter::ClosingWork => (0.0, 1.0),
            _ => (self.of(self.range.0, &[1.0; 7]), self.of(self.range.1, &[1.0; 7])),
        }
    }
}
