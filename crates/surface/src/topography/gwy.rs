//! The format GWY of the program Gwyddion. A file contains nested objects with named components, of
//! which only data fields are read.

use super::bytes::{Bytes, Number, Order, decoded};
use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use std::borrow::Cow;

pub(super) const SIGNATURE: &[u8] = b"GWYP";

/// Reads the data field `/N/data` of one channel of a GWY file. If `wanted` is neither a number nor
/// a name, reads the only channel whose unit is a length or, if there is none, the only channel
/// without a unit.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let mut channels = channels(bytes)?;
    let has_length = channels.iter().any(Channel::is_length);
    let labels: Vec<Label> = channels
        .iter()
        .map(|channel| channel.label(has_length))
        .collect();
    let index = channel::chosen(&labels, "channel", wanted)?;
    channels.swap_remove(index).into_reading()
}

/// Reads all channels that have a data field.
fn channels(bytes: &[u8]) -> Result<Vec<Channel<'_>>, SurfaceError> {
    let mut file = Bytes::new(bytes, Order::Little);
    file.take(SIGNATURE.len())?;
    let mut content = object(&mut file)?;
    let mut channels = Vec::new();
    let mut titles = Vec::new();
    while let Some(component) = component(&mut content)? {
        let name = &*component.name;
        match component.value {
            Value::Object(content) => {
                if let Some(number) = channel_number(name, "/data") {
                    let field = Field::parse(content)?;
                    let title = "".into();
                    channels.push(Channel {
                        number,
                        title,
                        field,
                    });
                }
            }
            Value::Text(text) => {
                if let Some(number) = channel_number(name, "/data/title") {
                    titles.push(Title { number, text });
                }
            }
            _ => {}
        }
    }
    for channel in &mut channels {
        if let Some(title) = titles.iter().find(|title| title.number == channel.number) {
            channel.title = title.text.clone();
        }
    }
    Ok(channels)
}

/// Title of the channel with the number `number`.
struct Title<'a> {
    number: u32,
    text: Cow<'a, str>,
}

/// Returns the number N of a channel from the name of a component, `/N/data` or `/N/data/title`.
/// `end` is the part of this name after N.
fn channel_number(name: &str, end: &str) -> Option<u32> {
    let name = name.strip_prefix('/')?;
    name.strip_suffix(end)?.parse().ok()
}

/// Value of a component of an object. Values of types that are not needed are skipped.
enum Value<'a> {
    Object(Bytes<'a>),
    Number(f64),
    Text(Cow<'a, str>),
    Doubles(Bytes<'a>),
    Other,
}

/// Returns the content of the next object. Its name and its size are skipped.
fn object<'a>(bytes: &mut Bytes<'a>) -> Result<Bytes<'a>, SurfaceError> {
    bytes.text()?;
    let size = bytes.size(Number::U32)?;
    bytes.part(size)
}

struct Component<'a> {
    name: Cow<'a, str>,
    value: Value<'a>,
}

/// Returns the next component of an object; `None` at the end of the object.
fn component<'a>(content: &mut Bytes<'a>) -> Result<Option<Component<'a>>, SurfaceError> {
    if content.left() == 0 {
        return Ok(None);
    }
    let name = String::from_utf8_lossy(content.text()?);
    let place = content.place();
    let kind = content.take(1)?[0];
    let count = if b"CIQDSO".contains(&kind) {
        content.size(Number::U32)?
    } else {
        1
    };
    let value = match kind {
        b'b' | b'c' | b'C' => skipped(content, count, 1)?,
        b'I' => skipped(content, count, 4)?,
        b'q' | b'Q' => skipped(content, count, 8)?,
        b'i' => Value::Number(content.number(Number::I32)?),
        b'd' => Value::Number(content.number(Number::F64)?),
        b's' => Value::Text(decoded(content.text()?)),
        b'o' => Value::Object(object(content)?),
        b'D' => Value::Doubles(content.part(count.saturating_mul(8))?),
        b'S' => {
            for _ in 0..count {
                content.text()?;
            }
            Value::Other
        }
        b'O' => {
            for _ in 0..count {
                object(content)?;
            }
            Value::Other
        }
        other => {
            let found = format!("a component of type {:?}", char::from(other).to_string());
            let allowed = "one of b c i q d s o and C I Q D S O";
            return Err(refused(place, found, allowed));
        }
    };
    Ok(Some(Component { name, value }))
}

/// Skips `count` values, each of which has `size` bytes.
fn skipped<'a>(
    content: &mut Bytes<'_>,
    count: usize,
    size: usize,
) -> Result<Value<'a>, SurfaceError> {
    content.take(count.saturating_mul(size))?;
    Ok(Value::Other)
}

struct Channel<'a> {
    number: u32,
    /// Name of the channel; empty if the channel has no name.
    title: Cow<'a, str>,
    field: Field<'a>,
}

#[derive(Default)]
struct Field<'a> {
    columns: f64,
    rows: f64,
    sizes: [f64; 2],
    unit_xy: Cow<'a, str>,
    unit_z: Cow<'a, str>,
    heights: Option<Bytes<'a>>,
}

impl<'a> Field<'a> {
    fn parse(mut content: Bytes<'a>) -> Result<Self, SurfaceError> {
        let mut field = Field::default();
        while let Some(Component { name, value }) = component(&mut content)? {
            match (&*name, value) {
                ("xres", Value::Number(columns)) => field.columns = columns,
                ("yres", Value::Number(rows)) => field.rows = rows,
                ("xreal", Value::Number(size)) => field.sizes[0] = size,
                ("yreal", Value::Number(size)) => field.sizes[1] = size,
                ("si_unit_xy", Value::Object(unit)) => field.unit_xy = unit_text(unit)?,
                ("si_unit_z", Value::Object(unit)) => field.unit_z = unit_text(unit)?,
                ("data", Value::Doubles(values)) => field.heights = Some(values),
                _ => {}
            }
        }
        Ok(field)
    }
}

impl Channel<'_> {
    fn is_length(&self) -> bool {
        Unit::is_name(&self.field.unit_z)
    }

    /// Returns the label of the channel. `has_length` is true if any channel of the file has a unit
    /// of length.
    fn label(&self, has_length: bool) -> Label {
        let unit = &self.field.unit_z;
        Label {
            number: self.number,
            name: self.title.to_string(),
            unit: Some(unit.to_string()),
            has_heights: if has_length {
                self.is_length()
            } else {
                unit.is_empty()
            },
            ..Label::default()
        }
    }

    fn into_reading(self) -> Result<Reading, SurfaceError> {
        let field = self.field;
        let place = Place::Part(format!("channel {}", self.number));
        let Some(mut values) = field.heights else {
            return Err(refused(place, "no heights", "a component data of numbers"));
        };
        let columns = field.columns as usize;
        let rows = field.rows as usize;
        let count = values.left() / 8;
        if columns == 0 || rows == 0 {
            let found = format!("xres = {}, yres = {}", field.columns, field.rows);
            return Err(refused(place, found, "above 0"));
        }
        if columns.checked_mul(rows) != Some(count) {
            let found = format!("{count} heights for {columns} times {rows} points");
            return Err(refused(place, found, "a height for each point"));
        }
        let [width, height] = field.sizes;
        let spacing = Some([width / columns as f64, height / rows as f64]);
        let lateral = Unit::stated(&field.unit_xy, place.clone())?;
        let units = StatedUnits::new(lateral, Unit::stated(&field.unit_z, place)?);
        let heights = values.numbers(count, Number::F64)?;
        Ok(Reading::even("GWY", heights, columns, spacing, units))
    }
}

fn unit_text<'a>(mut content: Bytes<'a>) -> Result<Cow<'a, str>, SurfaceError> {
    let mut unit = "".into();
    while let Some(Component { name, value }) = component(&mut content)? {
        if let ("unitstr", Value::Text(text)) = (&*name, value) {
            unit = text;
        }
    }
    Ok(unit)
}

#[cfg(test)]
mod tests {
    use super::super::options::ReadOptions;
    use super::*;
    use crate::error::SurfaceError;

    fn component(name: &str, kind: u8, content: &[u8]) -> Vec<u8> {
        [name.as_bytes(), b"\0", &[kind], content].concat()
    }

    fn object(name: &str, content: &[u8]) -> Vec<u8> {
        [
            name.as_bytes(),
            b"\0",
            &(content.len() as u32).to_le_bytes(),
            content,
        ]
        .concat()
    }

    /// Returns a file that has, for each of these units, a channel of 2 × 2 heights.
    fn file(units: &[&str]) -> Vec<u8> {
        let channel = |(number, unit): (usize, &&str)| {
            let unit_of = |unit: &str| {
                object(
                    "GwySIUnit",
                    &component("unitstr", b's', &[unit.as_bytes(), b"\0"].concat()),
                )
            };
            let heights = [1.0_f64, 2.0, 3.0, 4.0].map(f64::to_le_bytes).concat();
            let content = [
                component("xres", b'i', &2_i32.to_le_bytes()),
                component("yres", b'i', &2_i32.to_le_bytes()),
                component("xreal", b'd', &2.0_f64.to_le_bytes()),
                component("yreal", b'd', &2.0_f64.to_le_bytes()),
                component("si_unit_xy", b'o', &unit_of("m")),
                component("si_unit_z", b'o', &unit_of(unit)),
                component("data", b'D', &[&4_u32.to_le_bytes(), &heights[..]].concat()),
            ];
            component(
                &format!("/{number}/data"),
                b'o',
                &object("GwyDataField", &content.concat()),
            )
        };
        let channels: Vec<u8> = units.iter().enumerate().flat_map(channel).collect();
        [SIGNATURE, &object("GwyContainer", &channels)].concat()
    }

    #[test]
    fn channels_have_titles_and_units_of_older_programs() {
        let title = component("/1/data/title", b's', b"Retrace\0");
        let titled = |bytes: Vec<u8>| {
            // The content of the container begins after the signature and after the name and the
            // size of the container.
            let start = SIGNATURE.len() + "GwyContainer".len() + 1 + 4;
            let content = [&bytes[start..], &title].concat();
            [SIGNATURE, &object("GwyContainer", &content)].concat()
        };
        let both = titled(file(&["m", "m"]));
        let error = read(&both, Wanted::Heights).unwrap_err().to_string();
        assert!(
            error.starts_with("2 channels of heights; channels: 0 in m, 1 \"Retrace\" in m;"),
            "{error}"
        );
        let named = read(&both, Wanted::Name("retrace")).unwrap();
        assert_eq!(named, read(&both, Wanted::Number(1)).unwrap());
        // The letter µ in the unit may be encoded in Windows-1252.
        let mut latin = file(&["\u{7f}m"]);
        let place = latin.iter().position(|byte| *byte == 0x7f).unwrap();
        latin[place] = 0xb5;
        let found = read(&latin, Wanted::Heights).unwrap();
        assert_eq!(found.units.heights.map(Unit::name), Some("µm"));
    }

    #[test]
    fn heights_without_a_unit_are_those_of_the_channel_whose_unit_is_asked_for() {
        let height = |units: &[&str], unit: Option<&str>| {
            let options = ReadOptions {
                height_unit: unit.map(|unit| unit.parse().unwrap()),
                ..ReadOptions::default()
            };
            let read =
                read(&file(units), Wanted::Heights).and_then(|reading| reading.resolve(&options));
            read.map(|surface| surface.heights[3])
                .map_err(|error: SurfaceError| error.to_string())
        };
        assert_eq!(height(&[""], Some("nm")), Ok(4e-9));
        let error = height(&[""], None).unwrap_err();
        assert!(error.starts_with("no unit of heights is stated"), "{error}");
        assert_eq!(height(&["nm"], None), Ok(4e-9));
        assert_eq!(height(&["deg", "", "um"], None), Ok(4e-6));
        for (units, expected) in [
            (
                &["deg", "V"][..],
                "no channel of heights; channels: 0 in deg, 1 in V; allowed: ",
            ),
            (
                &["m", "nm"],
                "2 channels of heights; channels: 0 in m, 1 in nm; allowed: the number or the name of one",
            ),
            (
                &["", ""],
                "2 channels of heights; channels: 0 without unit, 1 without unit; allowed: the number or the name of one",
            ),
        ] {
            let error = height(units, Some("m")).unwrap_err();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
