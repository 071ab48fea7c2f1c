//! NetCDF in its classic format (CDF-1 and CDF-2), as contact.engineering and SurfaceTopography
//! write it: a variable `heights` over positions `x`, and for a map also `y`.

use super::Unit;
use super::bytes::{Bytes, Number, Order, decoded};
use super::reading::Reading;
use super::surface::first_uneven;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::gathered;

/// First bytes of a file, before the version.
pub(super) const SIGNATURE: &[u8] = b"CDF";

/// Tags of the lists of dimensions, variables and attributes.
const DIMENSIONS: usize = 10;
const VARIABLES: usize = 11;
const ATTRIBUTES: usize = 12;

/// Type code of characters; all other types are numbers.
const CHARACTERS: usize = 2;

struct Variable<'a> {
    name: &'a [u8],
    /// Indices of the dimensions of the variable, the fastest varying last.
    dimensions: Vec<usize>,
    /// Text of the unit; empty if the variable has none.
    unit: &'a [u8],
    /// Values that mark missing points; NaN where the file states none.
    missing: [f64; 2],
    scale: f64,
    offset: f64,
    of: Number,
    begin: usize,
}

/// Header of a file, and the bytes after it.
struct Dataset<'a> {
    bytes: &'a [u8],
    dimensions: Vec<usize>,
    variables: Vec<Variable<'a>>,
}

pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let dataset = Dataset::new(bytes)?;
    let heights = dataset.variable(b"heights").ok_or_else(|| {
        refused(
            Place::File,
            "no variable `heights`",
            "NetCDF with `heights` over `x`, and `y` of a map",
        )
    })?;
    let mut values = dataset.values(heights)?;
    if let Some(mask) = dataset
        .variable(b"mask")
        .filter(|mask| mask.dimensions == heights.dimensions)
    {
        let mask = dataset.values(mask)?;
        values
            .iter_mut()
            .zip(mask)
            .filter(|(_, mask)| *mask != 0.0)
            .for_each(|(value, _)| *value = f64::NAN);
    }
    // The positions of a dimension have its name, or that of the axis.
    let over = |dimension: usize| {
        let is_position = |variable: &&Variable| [&b"x"[..], b"y"].contains(&variable.name);
        dataset
            .variables
            .iter()
            .filter(is_position)
            .find(|variable| variable.dimensions == [dimension])
    };
    // Each variable has its own unit, or none.
    let unit_over = |dimension: usize| over(dimension).map_or(Ok(None), Variable::unit);
    let height_unit = heights.unit()?;
    let (slow, fast) = match heights.dimensions[..] {
        [slow, fast] => (slow, fast),
        [along] => {
            let (unit, points) = (unit_over(along)?, values.len());
            return Ok(match over(along) {
                Some(x) => {
                    Reading::profile("NetCDF", dataset.values(x)?, values, [unit, height_unit])
                }
                None => Reading::even("NetCDF", values, points, None, [unit, unit, height_unit]),
            });
        }
        _ => {
            let fault = format!("`heights` over {} dimensions", heights.dimensions.len());
            return Err(refused(
                Place::File,
                fault,
                "one of a profile, or two of a map",
            ));
        }
    };
    let spacing = |dimension: usize| {
        over(dimension)
            .map(|positions| even_distance(&dataset.values(positions)?))
            .transpose()
    };
    let mut columns = dataset.length(fast)?;
    let mut spacing = spacing(fast)?
        .zip(spacing(slow)?)
        .map(|(fast, slow)| [fast, slow]);
    let mut units = [unit_over(fast)?, unit_over(slow)?, height_unit];
    if over(slow).is_some_and(|variable| variable.name == b"x") {
        // Rows are along x.
        let turned = (0..columns).flat_map(|x| values.iter().skip(x).step_by(columns).copied());
        values = gathered(values.len(), turned)?;
        columns = dataset.length(slow)?;
        spacing = spacing.map(|[fast, slow]| [slow, fast]);
        units.swap(0, 1);
    }
    Ok(Reading::even("NetCDF", values, columns, spacing, units))
}

impl<'a> Dataset<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, SurfaceError> {
        let mut header = Bytes::new(bytes, Order::Big);
        header.take(SIGNATURE.len())?;
        let place = header.place();
        let offsets = match header.size(Number::U8)? {
            1 => Number::U32,
            2 => Number::U64,
            version => {
                let fault = format!("version {version} of NetCDF");
                return Err(refused(place, fault, "1 or 2, the classic format"));
            }
        };
        header.take(4)?; // Number of records.
        let dimensions = list(&mut header, DIMENSIONS, |header| {
            name(header)?;
            header.size(Number::U32)
        })?;
        list(&mut header, ATTRIBUTES, |header| {
            attribute(header).map(drop)
        })?;
        let variables = list(&mut header, VARIABLES, |header| variable(header, offsets))?;
        Ok(Dataset {
            bytes,
            dimensions,
            variables,
        })
    }

    fn variable(&self, name: &[u8]) -> Option<&Variable<'a>> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    fn length(&self, dimension: usize) -> Result<usize, SurfaceError> {
        let (fault, allowed) = match self.dimensions.get(dimension) {
            Some(0) => (
                "a dimension without a fixed length".to_owned(),
                "fixed lengths".to_owned(),
            ),
            Some(length) => return Ok(*length),
            None => (
                format!("dimension {dimension}"),
                format!("below {}", self.dimensions.len()),
            ),
        };
        Err(refused(Place::File, fault, allowed))
    }

    /// Returns the values of a variable, with NaN for missing points.
    fn values(&self, variable: &Variable) -> Result<Vec<f64>, SurfaceError> {
        let mut lengths = variable
            .dimensions
            .iter()
            .map(|dimension| self.length(*dimension));
        let count = lengths.try_fold(1_usize, |count, length| {
            Ok::<_, SurfaceError>(count.saturating_mul(length?))
        })?;
        let mut data = Bytes::new(self.bytes, Order::Big);
        data.take(variable.begin)?;
        let mut values = data.numbers(count, variable.of)?;
        for value in &mut values {
            let is_missing = variable.missing.contains(value);
            *value = if is_missing {
                f64::NAN
            } else {
                variable.offset + variable.scale * *value
            };
        }
        Ok(values)
    }
}

impl Variable<'_> {
    fn unit(&self) -> Result<Option<Unit>, SurfaceError> {
        let place = Place::Part(format!("variable {}", String::from_utf8_lossy(self.name)));
        Unit::stated(decoded(self.unit).trim_matches([' ', '\0']), place)
    }
}

fn list<'a, T>(
    header: &mut Bytes<'a>,
    tag: usize,
    entry: impl Fn(&mut Bytes<'a>) -> Result<T, SurfaceError>,
) -> Result<Vec<T>, SurfaceError> {
    let place = header.place();
    match (header.size(Number::U32)?, header.size(Number::U32)?) {
        (0, 0) => Ok(Vec::new()),
        // No memory is reserved for the number, which the file may overstate.
        (found, count) if found == tag => std::iter::repeat_with(|| entry(header))
            .take(count)
            .collect(),
        (found, _) => Err(refused(
            place,
            format!("mark {found}"),
            format!("{tag}, or an empty list"),
        )),
    }
}

/// Returns `count` bytes, and skips their padding to a multiple of four.
fn padded<'a>(header: &mut Bytes<'a>, count: usize) -> Result<&'a [u8], SurfaceError> {
    let bytes = header.take(count)?;
    header.take(count.next_multiple_of(4) - count)?;
    Ok(bytes)
}

fn name<'a>(header: &mut Bytes<'a>) -> Result<&'a [u8], SurfaceError> {
    let length = header.size(Number::U32)?;
    padded(header, length)
}

/// Reads a type code; `None` for characters.
fn number(header: &mut Bytes) -> Result<Option<Number>, SurfaceError> {
    let place = header.place();
    Ok(Some(match header.size(Number::U32)? {
        1 => Number::I8,
        CHARACTERS => return Ok(None),
        3 => Number::I16,
        4 => Number::I32,
        5 => Number::F32,
        6 => Number::F64,
        other => return Err(refused(place, format!("type {other}"), "types 1 to 6")),
    }))
}

/// Name, type (`None`: characters) and content of an attribute.
type Attribute<'a> = (&'a [u8], Option<Number>, &'a [u8]);

fn attribute<'a>(header: &mut Bytes<'a>) -> Result<Attribute<'a>, SurfaceError> {
    let name = name(header)?;
    let of = number(header)?;
    let count = header.size(Number::U32)?;
    Ok((
        name,
        of,
        padded(header, count.saturating_mul(of.map_or(1, Number::size)))?,
    ))
}

fn variable<'a>(header: &mut Bytes<'a>, offsets: Number) -> Result<Variable<'a>, SurfaceError> {
    let name = name(header)?;
    let mut dimensions = Vec::new();
    for _ in 0..header.size(Number::U32)? {
        dimensions.push(header.size(Number::U32)?);
    }
    let (mut unit, mut missing, mut scale, mut offset) = (&b""[..], [f64::NAN; 2], 1.0, 0.0);
    for (name, of, content) in list(header, ATTRIBUTES, attribute)? {
        let number = of.and_then(|of| Bytes::new(content, Order::Big).number(of).ok());
        match (name, number) {
            (b"unit" | b"units" | b"length_unit", None) if of.is_none() => unit = content,
            (b"missing_value", Some(value)) => missing[0] = value,
            (b"_FillValue", Some(value)) => missing[1] = value,
            (b"scale_factor", Some(value)) => scale = value,
            (b"add_offset", Some(value)) => offset = value,
            _ => {}
        }
    }
    // The values of text are never read.
    let of = number(header)?.unwrap_or(Number::U8);
    header.take(4)?; // Bytes of the values, which follow from the dimensions.
    let begin = header.size(offsets)?;
    Ok(Variable {
        name,
        dimensions,
        unit,
        missing,
        scale,
        offset,
        of,
        begin,
    })
}

fn even_distance(positions: &[f64]) -> Result<f64, SurfaceError> {
    let ([first, .., last], count) = (positions, positions.len()) else {
        return Err(refused(
            Place::File,
            "a map of one row",
            "at least 2 positions along each axis",
        ));
    };
    let distance = (last - first) / (count - 1) as f64;
    match first_uneven(positions, *first, distance) {
        Some(index) => Err(refused(
            Place::Point(index + 1),
            "uneven positions of a map",
            "even ones",
        )),
        None => Ok(distance.abs()),
    }
}
