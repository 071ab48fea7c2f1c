//! The classic format of NetCDF (CDF-1 and CDF-2), as contact.engineering and SurfaceTopography
//! write it. A file has a variable `heights` over the positions `x` and, for a map, also `y`.

use super::bytes::{Bytes, Number, Order, decoded};
use super::positions::first_uneven;
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::transpose::transposed;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};

/// First bytes of a NetCDF file. The next byte is the number of the version.
pub(super) const SIGNATURE: &[u8] = b"CDF";

/// Number in front of the list of dimensions in the header.
const DIMENSIONS: usize = 10;

/// Number in front of the list of variables in the header.
const VARIABLES: usize = 11;

/// Number in front of a list of attributes in the header.
const ATTRIBUTES: usize = 12;

/// Code of the type character. All other types are numbers.
const CHARACTERS: usize = 2;

struct Variable<'a> {
    name: &'a [u8],
    /// Indices of the dimensions of the variable. The values vary fastest along the last one.
    dimensions: Vec<usize>,
    conversion: Conversion<'a>,
    number: Number,
    /// Offset of the values in the file.
    begin: usize,
}

/// Properties of the values of a variable, which its attributes state.
struct Conversion<'a> {
    /// Text of the unit; empty if the attributes state no unit.
    unit: &'a [u8],
    /// Values that mark missing points; NaN if the file states no such value.
    missing: [f64; 2],
    scale: f64,
    offset: f64,
    /// True if the values are positions on a periodic surface.
    is_periodic: bool,
}

/// Header of a file, and the bytes after it.
struct Dataset<'a> {
    bytes: &'a [u8],
    dimensions: Vec<usize>,
    variables: Vec<Variable<'a>>,
}

pub(super) fn read(bytes: &[u8]) -> Result<Reading, SurfaceError> {
    let dataset = Dataset::new(bytes)?;
    let Some(heights) = dataset.variable(b"heights") else {
        let allowed = "NetCDF with `heights` over `x`, and `y` of a map";
        return Err(refused(Place::File, "no variable `heights`", allowed));
    };
    let values = dataset.unmasked(heights)?;
    // Each variable may have its own unit, or none.
    let height_unit = heights.unit()?;
    let mut reading = match heights.dimensions[..] {
        [dimension] => profile(&dataset, dimension, values, height_unit),
        [slow, fast] => map(&dataset, slow, fast, values, height_unit),
        _ => {
            let count = heights.dimensions.len();
            let found = format!("`heights` over {count} dimensions");
            let allowed = "one of a profile, or two of a map";
            Err(refused(Place::File, found, allowed))
        }
    }?;
    reading.periodic = heights
        .dimensions
        .iter()
        .any(|dimension| dataset.is_periodic(*dimension));
    Ok(reading)
}

fn profile(
    dataset: &Dataset<'_>,
    dimension: usize,
    values: Vec<f64>,
    height_unit: Option<Unit>,
) -> Result<Reading, SurfaceError> {
    let units = StatedUnits::new(dataset.unit_over(dimension)?, height_unit);
    match dataset.positions_over(dimension) {
        Some(x) => {
            let positions = dataset.values(x)?;
            Ok(Reading::profile("NetCDF", positions, values, units))
        }
        None => {
            let points = values.len();
            Ok(Reading::even("NetCDF", values, points, None, units))
        }
    }
}

/// Reads a map whose heights vary faster along one dimension than along the other.
fn map(
    dataset: &Dataset<'_>,
    slow: usize,
    fast: usize,
    values: Vec<f64>,
    height_unit: Option<Unit>,
) -> Result<Reading, SurfaceError> {
    let fast_count = dataset.length(fast)?;
    let fast_distance = dataset.distance_over(fast)?;
    let slow_distance = dataset.distance_over(slow)?;
    let fast_unit = dataset.unit_over(fast)?;
    let slow_unit = dataset.unit_over(slow)?;
    let is_turned = dataset
        .positions_over(slow)
        .is_some_and(|positions| positions.name == b"x");
    if !is_turned {
        let units = StatedUnits {
            along: fast_unit,
            between: slow_unit,
            heights: height_unit,
        };
        let spacing = both(fast_distance, slow_distance);
        return Ok(Reading::even("NetCDF", values, fast_count, spacing, units));
    }
    // Here x is the slow dimension, so the matrix is transposed to get rows along x.
    let turned = transposed(&values, fast_count)?;
    let columns = dataset.length(slow)?;
    let units = StatedUnits {
        along: slow_unit,
        between: fast_unit,
        heights: height_unit,
    };
    let spacing = both(slow_distance, fast_distance);
    Ok(Reading::even("NetCDF", turned, columns, spacing, units))
}

/// Returns the two distances, or `None` unless both are known.
fn both(along: Option<f64>, between: Option<f64>) -> Option<[f64; 2]> {
    Some([along?, between?])
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
                let found = format!("version {version} of NetCDF");
                return Err(refused(place, found, "1 or 2, the classic format"));
            }
        };
        // The number of records in the header is not needed.
        header.take(4)?;
        let dimensions = list(&mut header, DIMENSIONS, |header| {
            name(header)?;
            header.size(Number::U32)
        })?;
        list(&mut header, ATTRIBUTES, attribute)?;
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

    /// Returns the variable that has the positions along a dimension. This variable is called `x`
    /// or `y`, whatever the name of the dimension is.
    fn positions_over(&self, dimension: usize) -> Option<&Variable<'a>> {
        self.variables.iter().find(|variable| {
            [&b"x"[..], b"y"].contains(&variable.name) && variable.dimensions == [dimension]
        })
    }

    /// Returns the unit of the positions along a dimension.
    fn unit_over(&self, dimension: usize) -> Result<Option<Unit>, SurfaceError> {
        match self.positions_over(dimension) {
            Some(positions) => positions.unit(),
            None => Ok(None),
        }
    }

    /// Returns true if an attribute of the positions along a dimension states that the surface is
    /// periodic. The program SurfaceTopography writes this attribute only for x, but it applies to
    /// both axes.
    fn is_periodic(&self, dimension: usize) -> bool {
        self.positions_over(dimension)
            .is_some_and(|positions| positions.conversion.is_periodic)
    }

    /// Returns the distance between neighbouring positions along a dimension.
    fn distance_over(&self, dimension: usize) -> Result<Option<f64>, SurfaceError> {
        match self.positions_over(dimension) {
            Some(positions) => even_distance(&self.values(positions)?).map(Some),
            None => Ok(None),
        }
    }

    fn length(&self, dimension: usize) -> Result<usize, SurfaceError> {
        match self.dimensions.get(dimension) {
            Some(0) => {
                let found = "a dimension without a fixed length";
                Err(refused(Place::File, found, "fixed lengths"))
            }
            Some(length) => Ok(*length),
            None => {
                let found = format!("dimension {dimension}");
                let allowed = format!("below {}", self.dimensions.len());
                Err(refused(Place::File, found, allowed))
            }
        }
    }

    /// Returns the values of a variable, in which missing points are NaN.
    fn values(&self, variable: &Variable) -> Result<Vec<f64>, SurfaceError> {
        let mut count = 1_usize;
        for dimension in &variable.dimensions {
            count = count.saturating_mul(self.length(*dimension)?);
        }
        let mut data = Bytes::new(self.bytes, Order::Big);
        data.take(variable.begin)?;
        let mut values = data.numbers(count, variable.number)?;
        let conversion = &variable.conversion;
        for value in &mut values {
            *value = if conversion.missing.contains(value) {
                f64::NAN
            } else {
                conversion.offset + conversion.scale * *value
            };
        }
        Ok(values)
    }

    /// Returns the heights. Missing points, and points that the variable `mask` excludes, are NaN.
    fn unmasked(&self, heights: &Variable) -> Result<Vec<f64>, SurfaceError> {
        let mut values = self.values(heights)?;
        let Some(mask) = self.variable(b"mask") else {
            return Ok(values);
        };
        if mask.dimensions == heights.dimensions {
            for (value, mask) in values.iter_mut().zip(self.values(mask)?) {
                if mask != 0.0 {
                    *value = f64::NAN;
                }
            }
        }
        Ok(values)
    }
}

impl Variable<'_> {
    fn unit(&self) -> Result<Option<Unit>, SurfaceError> {
        let place = Place::Part(format!("variable {}", String::from_utf8_lossy(self.name)));
        let text = decoded(self.conversion.unit);
        Unit::stated(text.trim_matches([' ', '\0']), place)
    }
}

/// Reads a list from the header. A list consists of the number `mark`, the number of its entries,
/// and the entries.
fn list<'a, T>(
    header: &mut Bytes<'a>,
    mark: usize,
    entry: impl Fn(&mut Bytes<'a>) -> Result<T, SurfaceError>,
) -> Result<Vec<T>, SurfaceError> {
    let place = header.place();
    let found = header.size(Number::U32)?;
    let count = header.size(Number::U32)?;
    if found == 0 && count == 0 {
        return Ok(Vec::new());
    }
    if found != mark {
        let allowed = format!("{mark}, or an empty list");
        return Err(refused(place, format!("mark {found}"), allowed));
    }
    // No memory is reserved for `count` entries, because the file may state a number that is far
    // too large.
    let mut entries = Vec::new();
    for _ in 0..count {
        entries.push(entry(header)?);
    }
    Ok(entries)
}

/// Returns `count` bytes, and skips the padding bytes up to the next multiple of four.
fn padded<'a>(header: &mut Bytes<'a>, count: usize) -> Result<&'a [u8], SurfaceError> {
    let bytes = header.take(count)?;
    header.take(count.next_multiple_of(4) - count)?;
    Ok(bytes)
}

fn name<'a>(header: &mut Bytes<'a>) -> Result<&'a [u8], SurfaceError> {
    let length = header.size(Number::U32)?;
    padded(header, length)
}

/// Reads the code of a type; `None` for characters.
fn number_type(header: &mut Bytes) -> Result<Option<Number>, SurfaceError> {
    let place = header.place();
    match header.size(Number::U32)? {
        1 => Ok(Some(Number::I8)),
        CHARACTERS => Ok(None),
        3 => Ok(Some(Number::I16)),
        4 => Ok(Some(Number::I32)),
        5 => Ok(Some(Number::F32)),
        6 => Ok(Some(Number::F64)),
        other => Err(refused(place, format!("type {other}"), "types 1 to 6")),
    }
}

struct Attribute<'a> {
    name: &'a [u8],
    /// Type of the values of the attribute; `None` for characters.
    number: Option<Number>,
    content: &'a [u8],
}

fn attribute<'a>(header: &mut Bytes<'a>) -> Result<Attribute<'a>, SurfaceError> {
    let name = name(header)?;
    let number = number_type(header)?;
    let count = header.size(Number::U32)?;
    let size = number.map_or(1, Number::size);
    Ok(Attribute {
        name,
        number,
        content: padded(header, count.saturating_mul(size))?,
    })
}

impl<'a> Conversion<'a> {
    fn new(attributes: Vec<Attribute<'a>>) -> Self {
        let mut conversion = Conversion {
            unit: b"",
            missing: [f64::NAN; 2],
            scale: 1.0,
            offset: 0.0,
            is_periodic: false,
        };
        for attribute in attributes {
            let Some(number) = attribute.number else {
                if [&b"unit"[..], b"units", b"length_unit"].contains(&attribute.name) {
                    conversion.unit = attribute.content;
                }
                continue;
            };
            let Ok(value) = Bytes::new(attribute.content, Order::Big).number(number) else {
                continue;
            };
            match attribute.name {
                b"missing_value" => conversion.missing[0] = value,
                b"_FillValue" => conversion.missing[1] = value,
                b"scale_factor" => conversion.scale = value,
                b"add_offset" => conversion.offset = value,
                b"periodic" => conversion.is_periodic = value != 0.0,
                _ => {}
            }
        }
        conversion
    }
}

fn variable<'a>(header: &mut Bytes<'a>, offsets: Number) -> Result<Variable<'a>, SurfaceError> {
    let name = name(header)?;
    let mut dimensions = Vec::new();
    for _ in 0..header.size(Number::U32)? {
        dimensions.push(header.size(Number::U32)?);
    }
    let conversion = Conversion::new(list(header, ATTRIBUTES, attribute)?);
    // A variable of text is never read, so a wrong type for it does no harm.
    let number = number_type(header)?.unwrap_or(Number::U8);
    // The size of the values in bytes is skipped, because it also follows from the dimensions.
    header.take(4)?;
    let begin = header.size(offsets)?;
    Ok(Variable {
        name,
        dimensions,
        conversion,
        number,
        begin,
    })
}

fn even_distance(positions: &[f64]) -> Result<f64, SurfaceError> {
    let [first, .., last] = positions else {
        let allowed = "at least 2 positions along each axis";
        return Err(refused(Place::File, "a map of one row", allowed));
    };
    let distance = (last - first) / (positions.len() - 1) as f64;
    match first_uneven(positions, *first, distance) {
        Some(index) => {
            let found = "uneven positions of a map";
            Err(refused(Place::Point(index + 1), found, "even ones"))
        }
        None => Ok(distance.abs()),
    }
}
