//! NetCDF in its classic format (CDF-1 and CDF-2), as written by contact.engineering and SurfaceTopography: a
//! variable `heights` over positions `x`, and `y` for a map.

use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, gathered, refused};
use super::reading::{Format, RawGrid, Reading};
use super::surface::first_uneven;
use super::unit::Unit;

/// First bytes, without the version.
pub(super) const SIGNATURE: &[u8] = b"CDF";

/// Tags of the lists of dimensions, variables and attributes.
const DIMENSIONS: usize = 10;
const VARIABLES: usize = 11;
const ATTRIBUTES: usize = 12;

/// Type of characters; all others are numbers.
const CHARACTERS: usize = 2;

/// A variable of a file.
struct Variable<'a> {
    name: &'a [u8],
    /// Indices of its dimensions, the fastest last.
    dimensions: Vec<usize>,
    unit: Option<Unit>,
    /// Values that mark missing points; NaN where there is none.
    missing: [f64; 2],
    scale: f64,
    offset: f64,
    of: Number,
    begin: usize,
}

/// A file after its header.
struct Dataset<'a> {
    bytes: &'a [u8],
    /// Lengths.
    dimensions: Vec<usize>,
    variables: Vec<Variable<'a>>,
}

/// Reads the variable `heights`.
pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let dataset = Dataset::new(bytes)?;
    let heights = dataset.variable(b"heights").ok_or_else(|| {
        refused(Place::File, "no variable `heights`", "NetCDF with `heights` over `x`, and `y` of a map")
    })?;
    let mut values = dataset.values(heights)?;
    if let Some(mask) = dataset.variable(b"mask").filter(|mask| mask.dimensions == heights.dimensions) {
        let mask = dataset.values(mask)?;
        values.iter_mut().zip(mask).filter(|(_, mask)| *mask != 0.0).for_each(|(value, _)| *value = f64::NAN);
    }
    // The positions of a dimension have its name, or that of the axis.
    let over = |dimension: usize| {
        let is_position = |variable: &&Variable| [&b"x"[..], b"y"].contains(&variable.name);
        dataset.variables.iter().filter(is_position).find(|variable| variable.dimensions == [dimension])
    };
    let position_unit = dataset.variable(b"x").and_then(|x| x.unit);
    let grid = match heights.dimensions[..] {
        [along] => match over(along) {
            Some(x) => RawGrid::Positions(dataset.values(x)?),
            None => RawGrid::Profile(None),
        },
        [slow, fast] => {
            let spacing = |dimension: usize| {
                over(dimension).map(|positions| even_distance(&dataset.values(positions)?)).transpose()
            };
            let (rows, columns) = (dataset.length(slow)?, dataset.length(fast)?);
            let spacings = spacing(fast)?.zip(spacing(slow)?).map(|(fast, slow)| [fast, slow]);
            if over(slow).is_some_and(|variable| variable.name == b"x") {
                // Rows are along x.
                let turned = (0..columns).flat_map(|x| values.iter().skip(x).step_by(columns).copied());
                values = gathered(values.len(), turned)?;
                RawGrid::of(rows, columns, spacings.map(|[fast, slow]| [slow, fast]))
            } else {
                RawGrid::of(columns, rows, spacings)
            }
        }
        _ => {
            let fault = format!("`heights` over {} dimensions", heights.dimensions.len());
            return Err(refused(Place::File, fault, "one of a profile, or two of a map"));
        }
    };
    Ok(Reading::new(Format::NetCdf, values, grid, [position_unit, heights.unit.or(position_unit)]))
}

impl<'a> Dataset<'a> {
    fn new(bytes: &'a [u8]) -> Result<Self, TopographyError> {
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
        list(&mut header, ATTRIBUTES, |header| attribute(header).map(drop))?;
        let variables = list(&mut header, VARIABLES, |header| variable(header, offsets))?;
        Ok(Dataset { bytes, dimensions, variables })
    }

    fn variable(&self, name: &[u8]) -> Option<&Variable<'a>> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    fn length(&self, dimension: usize) -> Result<usize, TopographyError> {
        let (fault, allowed) = match self.dimensions.get(dimension) {
            Some(0) => ("a dimension without a fixed length".to_owned(), "fixed lengths".to_owned()),
            Some(length) => return Ok(*length),
            None => (format!("dimension {dimension}"), format!("below {}", self.dimensions.len())),
        };
        Err(refused(Place::File, fault, allowed))
    }

    /// Returns the values of a variable; NaN for missing points.
    fn values(&self, variable: &Variable) -> Result<Vec<f64>, TopographyError> {
        let mut count = 1_usize;
        for dimension in &variable.dimensions {
            count = count.saturating_mul(self.length(*dimension)?);
        }
        let mut data = Bytes::new(self.bytes, Order::Big);
        data.take(variable.begin)?;
        let mut values = data.numbers(count, variable.of)?;
        for value in &mut values {
            let is_missing = variable.missing.contains(value);
            *value = if is_missing { f64::NAN } else { variable.offset + variable.scale * *value };
        }
        Ok(values)
    }
}

/// Reads the entries of a list.
fn list<'a, T>(
    header: &mut Bytes<'a>,
    tag: usize,
    entry: impl Fn(&mut Bytes<'a>) -> Result<T, TopographyError>,
) -> Result<Vec<T>, TopographyError> {
    let place = header.place();
    match (header.size(Number::U32)?, header.size(Number::U32)?) {
        (0, 0) => Ok(Vec::new()),
        // No memory is reserved for the number, which the file may overstate.
        (found, count) if found == tag => std::iter::repeat_with(|| entry(header)).take(count).collect(),
        (found, _) => Err(refused(place, format!("mark {found}"), format!("{tag}, or an empty list"))),
    }
}

/// Returns bytes that are padded to a multiple of four.
fn padded<'a>(header: &mut Bytes<'a>, count: usize) -> Result<&'a [u8], TopographyError> {
    let bytes = header.take(count)?;
    header.take(count.next_multiple_of(4) - count)?;
    Ok(bytes)
}

fn name<'a>(header: &mut Bytes<'a>) -> Result<&'a [u8], TopographyError> {
    let length = header.size(Number::U32)?;
    padded(header, length)
}

/// Returns the type of numbers; `None` for characters.
fn number(header: &mut Bytes) -> Result<Option<Number>, TopographyError> {
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

/// Name of an attribute, and its text or its first number, if it has any.
type Attribute<'a> = (&'a [u8], Option<&'a [u8]>, Option<f64>);

fn attribute<'a>(header: &mut Bytes<'a>) -> Result<Attribute<'a>, TopographyError> {
    let name = name(header)?;
    let of = number(header)?;
    let count = header.size(Number::U32)?;
    let bytes = padded(header, count.saturating_mul(of.map_or(1, Number::size)))?;
    Ok(match of {
        None => (name, Some(bytes), None),
        Some(of) => (name, None, Bytes::new(bytes, Order::Big).number(of).ok()),
    })
}

fn variable<'a>(header: &mut Bytes<'a>, offsets: Number) -> Result<Variable<'a>, TopographyError> {
    let name = name(header)?;
    let mut dimensions = Vec::new();
    for _ in 0..header.size(Number::U32)? {
        dimensions.push(header.size(Number::U32)?);
    }
    let (mut unit, mut missing, mut scale, mut offset) = (None, [f64::NAN; 2], 1.0, 0.0);
    for attribute in list(header, ATTRIBUTES, attribute)? {
        match attribute {
            (b"unit" | b"units", Some(text), _) => {
                unit = str::from_utf8(text).ok().and_then(|text| text.trim().parse().ok());
            }
            (b"missing_value", _, Some(value)) => missing[0] = value,
            (b"_FillValue", _, Some(value)) => missing[1] = value,
            (b"scale_factor", _, Some(value)) => scale = value,
            (b"add_offset", _, Some(value)) => offset = value,
            _ => {}
        }
    }
    // The values of text are never read.
    let of = number(header)?.unwrap_or(Number::U8);
    header.take(4)?; // Bytes of the values, which follow from the dimensions.
    let begin = header.size(offsets)?;
    Ok(Variable { name, dimensions, unit, missing, scale, offset, of, begin })
}

/// Returns the distance between equally spaced positions.
fn even_distance(positions: &[f64]) -> Result<f64, TopographyError> {
    let ([first, .., last], count) = (positions, positions.len()) else {
        return Err(refused(Place::File, "a map of one row", "at least 2 positions along each axis"));
    };
    let distance = (last - first) / (count - 1) as f64;
    match first_uneven(positions, *first, distance) {
        Some(index) => Err(refused(Place::Point(index + 1), "uneven positions of a map", "even ones")),
        None => Ok(distance.abs()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::{Grid, ReadOptions, parse};

    /// Name, numbers of the dimensions, unit and values of a variable.
    type Variable<'a> = (&'a str, &'a [u32], &'a str, &'a [f64]);

    /// A file with these dimensions and variables of doubles.
    fn file(dimensions: &[(&str, u32)], variables: &[Variable<'_>]) -> Vec<u8> {
        let text = |text: &str| {
            let mut bytes = (text.len() as u32).to_be_bytes().to_vec();
            bytes.extend(text.as_bytes());
            bytes.resize(bytes.len().next_multiple_of(4), 0);
            bytes
        };
        let words = |words: &[u32]| words.iter().flat_map(|word| word.to_be_bytes()).collect::<Vec<u8>>();
        let mut bytes =
            [b"CDF\x01".to_vec(), words(&[0, DIMENSIONS as u32, dimensions.len() as u32])].concat();
        for (name, length) in dimensions {
            bytes.extend([text(name), words(&[*length])].concat());
        }
        bytes.extend(words(&[0, 0, VARIABLES as u32, variables.len() as u32]));
        let header = |begin: &dyn Fn(usize) -> u32| {
            let of = |(index, (name, dimensions, unit, values)): (usize, &Variable<'_>)| {
                let fill = [text("_FillValue"), words(&[4, 1, 999_999])].concat();
                let unit = [text("unit"), words(&[CHARACTERS as u32]), text(unit)].concat();
                let head = [text(name), words(&[dimensions.len() as u32]), words(dimensions)].concat();
                let data = words(&[6, 8 * values.len() as u32, begin(index)]);
                [head, words(&[ATTRIBUTES as u32, 2]), fill, unit, data].concat()
            };
            variables.iter().enumerate().flat_map(of).collect::<Vec<u8>>()
        };
        let first = (bytes.len() + header(&|_| 0).len()) as u32;
        let before =
            |index: usize| variables[..index].iter().map(|variable| 8 * variable.3.len() as u32).sum::<u32>();
        bytes.extend(header(&|index| first + before(index)));
        bytes.extend(variables.iter().flat_map(|variable| variable.3).flat_map(|value| value.to_be_bytes()));
        bytes
    }

    #[test]
    fn profiles_and_maps_are_read_with_their_units() {
        let none = ReadOptions::default();
        let profile = file(
            &[("n", 3)],
            &[("x", &[0], "um", &[0.0, 1.0, 4.0]), ("heights", &[0], "nm", &[1.0, 5.0, 2.0])],
        );
        let surface = parse(&profile, &none).unwrap();
        assert_eq!((surface.format(), surface.heights()), (Format::NetCdf, &[1e-9, 5e-9, 2e-9][..]));
        assert_eq!(surface.grid(), &Grid::Positions(vec![0.0, 1e-6, 4e-6]));
        let axes: [Variable<'_>; 2] = [("x", &[0], "m", &[0.0, 2.0]), ("y", &[1], "m", &[0.0, 1.0, 2.0])];
        let heights: Variable<'_> = ("heights", &[0, 1], "", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let map = parse(&file(&[("x", 2), ("y", 3)], &[heights, axes[0], axes[1]]), &none).unwrap();
        // Two points along x in each of three rows.
        assert_eq!(map.heights(), [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
        assert_eq!(map.grid(), &Grid::Map { columns: 2, spacing: [2.0, 1.0] });
        let missing = file(&[("n", 2)], &[("heights", &[0], "m", &[1.0, 999_999.0])]);
        let error = parse(&missing, &ReadOptions { spacing: Some(1.0), ..none }).unwrap_err().to_string();
        assert!(error.starts_with("point 2: 1 of 2 points are missing"), "{error}");
    }

    #[test]
    fn wrong_files_are_refused() {
        let heights: Variable<'_> = ("heights", &[0], "m", &[1.0, 2.0]);
        let whole = file(&[("n", 2)], &[heights]);
        let error = |bytes: &[u8]| read(bytes).map(drop).unwrap_err().to_string();
        for end in 4..whole.len() {
            assert!(error(&whole[..end]).contains("up to the end; allowed: at least"), "{end}");
        }
        assert!(error(b"CDF\x05\0\0\0\0").contains("version 5 of NetCDF; allowed: 1 or 2"));
        assert!(error(&file(&[("n", 2)], &[])).contains("no variable `heights`"));
        assert!(error(&file(&[("n", 0)], &[heights])).contains("without a fixed length"));
        assert!(error(&file(&[("n", u32::MAX)], &[heights])).contains("up to the end"));
        assert!(error(&file(&[], &[heights])).contains("dimension 0; allowed: below 0"));
        let uneven: (&str, &[u32], &str, &[f64]) = ("x", &[0], "m", &[0.0, 1.0, 3.0]);
        let map: (&str, &[u32], &str, &[f64]) = ("heights", &[0, 1], "m", &[0.0; 6]);
        let y: (&str, &[u32], &str, &[f64]) = ("y", &[1], "m", &[0.0, 1.0]);
        assert!(error(&file(&[("x", 3), ("y", 2)], &[map, uneven, y])).contains("uneven positions of a map"));
    }
}
