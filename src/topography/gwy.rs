//! Gwyddion's own format: nested objects of named components; only data fields are read.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};

pub(super) const SIGNATURE: &[u8] = b"GWYP";

/// Reads the data field of a channel: `/N/data` for number N; without a number, of the only channel whose heights
/// have a unit of length.
pub(super) fn read(bytes: &[u8], channel: Option<u32>) -> Result<Reading, TopographyError> {
    let mut file = Bytes::new(bytes);
    file.take(SIGNATURE.len())?;
    let mut fields = Vec::new();
    for_each_component(object(&mut file)?, &mut |name, value| {
        let number = name.strip_prefix('/').and_then(|rest| rest.strip_suffix("/data")?.parse::<u32>().ok());
        if let (Some(number), Value::Object(content)) = (number, value) {
            fields.push((number, Field::parse(content)?));
        }
        Ok(())
    })?;
    let numbers = fields.iter().map(|(number, _)| number.to_string()).collect::<Vec<_>>().join(", ");
    let is_height = |field: &Field<'_>| field.unit_z == "m";
    let mut chosen: Vec<(u32, Field<'_>)> = match channel {
        Some(channel) => fields.into_iter().filter(|(number, _)| *number == channel).collect(),
        None => fields.into_iter().filter(|(_, field)| is_height(field)).collect(),
    };
    match (chosen.pop(), chosen.is_empty()) {
        (Some((number, field)), true) => field.into_reading(number),
        (Some(_), false) => Err(refused(
            Place::File,
            format!("several channels of heights; all channels: {}", shown(&numbers)),
            "--channel with the number of one",
        )),
        (None, _) => Err(refused(
            Place::File,
            match channel {
                Some(channel) => format!("no channel {channel}; channels: {}", shown(&numbers)),
                None => format!("no channel with heights in m; channels: {}", shown(&numbers)),
            },
            "a channel of heights",
        )),
    }
}

/// Value of a component, as far as needed.
enum Value<'a> {
    Object(Bytes<'a>),
    Integer(i32),
    Double(f64),
    Text(&'a str),
    Doubles { count: usize, values: Bytes<'a> },
    Other,
}

/// Content of the next object, after its name and its size.
fn object<'a>(bytes: &mut Bytes<'a>) -> Result<Bytes<'a>, TopographyError> {
    bytes.text()?;
    let size = bytes.u32()? as usize;
    bytes.part(size)
}

/// Skips so many bytes.
fn skipped<'a>(content: &mut Bytes<'a>, bytes: usize) -> Result<Value<'a>, TopographyError> {
    content.take(bytes).map(|_| Value::Other)
}

/// Skips a list of values of so many bytes each.
fn skipped_list<'a>(content: &mut Bytes<'a>, size: usize) -> Result<Value<'a>, TopographyError> {
    let count = content.u32()? as usize;
    skipped(content, count.saturating_mul(size))
}

/// Calls `each` for the components of an object, without those of nested objects.
fn for_each_component<'a>(
    mut content: Bytes<'a>,
    each: &mut dyn FnMut(&str, Value<'a>) -> Result<(), TopographyError>,
) -> Result<(), TopographyError> {
    while content.left() > 0 {
        let name = String::from_utf8_lossy(content.text()?);
        let place = content.place();
        let kind = content.take(1)?[0];
        let value = match kind {
            b'b' | b'c' => skipped(&mut content, 1)?,
            b'q' => skipped(&mut content, 8)?,
            b'i' => Value::Integer(content.i32()?),
            b'd' => Value::Double(content.f64()?),
            b's' => Value::Text(str::from_utf8(content.text()?).unwrap_or("\u{fffd}")),
            b'o' => Value::Object(object(&mut content)?),
            b'D' => {
                let count = content.u32()? as usize;
                let values = content.part(count.saturating_mul(8))?;
                Value::Doubles { count, values }
            }
            b'C' => skipped_list(&mut content, 1)?,
            b'I' => skipped_list(&mut content, 4)?,
            b'Q' => skipped_list(&mut content, 8)?,
            b'S' | b'O' => {
                for _ in 0..content.u32()? {
                    if kind == b'S' {
                        content.text()?;
                    } else {
                        object(&mut content)?;
                    }
                }
                Value::Other
            }
            other => {
                let fault = format!("a component of type {:?}", char::from(other).to_string());
                return Err(refused(place, fault, "one of b c i q d s o and C I Q D S O"));
            }
        };
        each(&name, value)?;
    }
    Ok(())
}

/// Components of a data field.
#[derive(Default)]
struct Field<'a> {
    columns: i32,
    rows: i32,
    sizes: [f64; 2],
    unit_xy: String,
    unit_z: String,
    heights: Option<(usize, Bytes<'a>)>,
}

impl<'a> Field<'a> {
    fn parse(content: Bytes<'a>) -> Result<Self, TopographyError> {
        let mut field = Field::default();
        for_each_component(content, &mut |name, value| {
            match (name, value) {
                ("xres", Value::Integer(columns)) => field.columns = columns,
                ("yres", Value::Integer(rows)) => field.rows = rows,
                ("xreal", Value::Double(size)) => field.sizes[0] = size,
                ("yreal", Value::Double(size)) => field.sizes[1] = size,
                ("si_unit_xy", Value::Object(unit)) => field.unit_xy = unit_text(unit)?,
                ("si_unit_z", Value::Object(unit)) => field.unit_z = unit_text(unit)?,
                ("data", Value::Doubles { count, values }) => field.heights = Some((count, values)),
                _ => {}
            }
            Ok(())
        })?;
        Ok(field)
    }

    fn into_reading(self, number: u32) -> Result<Reading, TopographyError> {
        let place = || Place::Part(format!("channel {number}"));
        let Some((count, mut values)) = self.heights else {
            return Err(refused(place(), "no heights", "a component data of numbers"));
        };
        let axis = |points: i32| usize::try_from(points).ok().filter(|points| *points > 0);
        let (Some(columns), Some(rows)) = (axis(self.columns), axis(self.rows)) else {
            let fault = format!("xres = {}, yres = {}", self.columns, self.rows);
            return Err(refused(place(), fault, "above 0"));
        };
        if columns.checked_mul(rows) != Some(count) {
            let fault = format!("{count} heights for {columns} times {rows} points");
            return Err(refused(place(), fault, "a height for each point"));
        }
        let unit = |text: &str| match text {
            "" => Ok(None),
            text => Unit::stated(text, place()).map(Some),
        };
        let [width, height] = self.sizes;
        Ok(Reading {
            format: Format::Gwy,
            heights: values.numbers(count, Number::F64, Order::Little)?,
            grid: RawGrid::of(columns, rows, Some([width / columns as f64, height / rows as f64])),
            lateral_unit: unit(&self.unit_xy)?,
            height_unit: unit(&self.unit_z)?,
            first_missing: None,
        })
    }
}

fn unit_text(content: Bytes<'_>) -> Result<String, TopographyError> {
    let mut unit = String::new();
    for_each_component(content, &mut |name, value| {
        if let ("unitstr", Value::Text(text)) = (name, value) {
            text.clone_into(&mut unit);
        }
        Ok(())
    })?;
    Ok(unit)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    fn component(name: &str, kind: u8, value: &[u8]) -> Vec<u8> {
        [name.as_bytes(), &[0, kind], value].concat()
    }

    fn object(name: &str, content: &[u8]) -> Vec<u8> {
        [name.as_bytes(), &[0], &(content.len() as u32).to_le_bytes(), content].concat()
    }

    fn field(unit: &str, heights: &[f64]) -> Vec<u8> {
        let of =
            |text: &str| object("GwySIUnit", &component("unitstr", b's', &[text.as_bytes(), &[0]].concat()));
        let numbers: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
        let content = [
            component("xres", b'i', &3_i32.to_le_bytes()),
            component("yres", b'i', &2_i32.to_le_bytes()),
            component("xreal", b'd', &6e-6_f64.to_le_bytes()),
            component("yreal", b'd', &8e-6_f64.to_le_bytes()),
            component("square", b'b', &[0]),
            component("note", b'S', &[&2_u32.to_le_bytes()[..], b"a\0b\0"].concat()),
            component("si_unit_xy", b'o', &of("m")),
            component("si_unit_z", b'o', &of(unit)),
            component("data", b'D', &[&(heights.len() as u32).to_le_bytes()[..], &numbers].concat()),
        ];
        object("GwyDataField", &content.concat())
    }

    /// A file with channels 0, 1, … with the units of their numbers.
    pub fn file(units: &[&str]) -> Vec<u8> {
        let channels = units.iter().enumerate().map(|(number, unit)| {
            component(
                &format!("/{number}/data"),
                b'o',
                &field(unit, &[1.0, 2.0, 3.0, 4.0, 5.0, number as f64]),
            )
        });
        let title = component("/0/data/title", b's', b"Height\0");
        let content = channels.chain([title]).collect::<Vec<_>>().concat();
        [SIGNATURE, &object("GwyContainer", &content)].concat()
    }

    #[test]
    fn the_channel_of_heights_is_read() {
        let reading = read(&file(&["V", "m"]), None).unwrap();
        assert_eq!(reading.grid, RawGrid::Map { columns: 3, spacing: Some([2e-6, 4e-6]) });
        assert_eq!(reading.heights, [1.0, 2.0, 3.0, 4.0, 5.0, 1.0]);
        assert_eq!(reading.height_unit, Some(Unit::METRE));
        assert_eq!(read(&file(&["m", "m"]), Some(1)).unwrap().heights[5], 1.0);
    }

    #[test]
    fn faults_name_channels_and_bytes() {
        for (units, channel, expected) in [
            (&["m", "m"][..], None, "several channels of heights; all channels: 0, 1; allowed: --channel"),
            (&["V"], None, "no channel with heights in m; channels: 0"),
            (&["m"], Some(4), "no channel 4; channels: 0; allowed: a channel of heights"),
            (&["V"], Some(0), "channel 0: \"V\" is no unit of length"),
        ] {
            let error = read(&file(units), channel).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        let whole = file(&["m"]);
        for end in 5..whole.len() {
            let error = read(&whole[..end], None).unwrap_err().to_string();
            assert!(error.starts_with("byte "), "{end}: {error}");
        }
        let mut odd = whole.clone();
        let at = odd.windows(5).position(|five| five == b"xres\0").unwrap() + 5;
        odd[at] = b'z';
        assert!(read(&odd, None).unwrap_err().to_string().contains("a component of type \"z\""));
    }
}
