//! Gwyddion's own format: nested objects of named components; only data fields are read.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::reading::{Format, RawGrid, Reading};

pub(super) const SIGNATURE: &[u8] = b"GWYP";

/// Reads the data field of a channel: `/N/data` for number N; without a number, of the only channel whose heights
/// have a unit of length.
pub(super) fn read(bytes: &[u8], channel: Option<u32>) -> Result<Reading, TopographyError> {
    let mut file = Bytes::new(bytes, Order::Little);
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
    let is_chosen =
        |(number, field): &(u32, Field)| channel.map_or(field.unit_z == "m", |one| one == *number);
    let mut chosen: Vec<_> = fields.into_iter().filter(is_chosen).collect();
    let (fault, allowed) = match (chosen.pop(), chosen.is_empty(), channel) {
        (Some((number, field)), true, _) => return field.into_reading(number),
        (Some(_), false, _) => {
            ("several channels of heights; all channels".to_owned(), "--channel with the number of one")
        }
        (None, _, Some(channel)) => (format!("no channel {channel}; channels"), "a channel of heights"),
        (None, ..) => ("no channel with heights in m; channels".to_owned(), "a channel of heights"),
    };
    Err(refused(Place::File, format!("{fault}: {}", shown(&numbers)), allowed))
}

/// Value of a component, as far as needed.
enum Value<'a> {
    Object(Bytes<'a>),
    Number(f64),
    Text(&'a str),
    Doubles { count: usize, values: Bytes<'a> },
    Other,
}

/// Returns the content of the next object, after its name and its size.
fn object<'a>(bytes: &mut Bytes<'a>) -> Result<Bytes<'a>, TopographyError> {
    bytes.text()?;
    let size = bytes.size(Number::U32)?;
    bytes.part(size)
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
        let count = match kind {
            b'C' | b'I' | b'Q' | b'D' | b'S' | b'O' => content.size(Number::U32)?,
            _ => 1,
        };
        let value = match kind {
            b'i' => Value::Number(content.number(Number::I32)?),
            b'd' => Value::Number(content.number(Number::F64)?),
            b's' => Value::Text(str::from_utf8(content.text()?).unwrap_or("\u{fffd}")),
            b'o' => Value::Object(object(&mut content)?),
            b'D' => Value::Doubles { count, values: content.part(count.saturating_mul(8))? },
            b'b' | b'c' | b'q' | b'C' | b'I' | b'Q' => {
                let size = match kind {
                    b'I' => 4,
                    b'q' | b'Q' => 8,
                    _ => 1,
                };
                content.take(count.saturating_mul(size))?;
                Value::Other
            }
            b'S' | b'O' => {
                for _ in 0..count {
                    if kind == b'S' { content.text().map(drop)? } else { object(&mut content).map(drop)? }
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
    columns: f64,
    rows: f64,
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
                ("xres", Value::Number(columns)) => field.columns = columns,
                ("yres", Value::Number(rows)) => field.rows = rows,
                ("xreal", Value::Number(size)) => field.sizes[0] = size,
                ("yreal", Value::Number(size)) => field.sizes[1] = size,
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
        let (columns, rows) = (self.columns as usize, self.rows as usize);
        if columns == 0 || rows == 0 {
            let fault = format!("xres = {}, yres = {}", self.columns, self.rows);
            return Err(refused(place(), fault, "above 0"));
        }
        if columns.checked_mul(rows) != Some(count) {
            let fault = format!("{count} heights for {columns} times {rows} points");
            return Err(refused(place(), fault, "a height for each point"));
        }
        let [width, height] = self.sizes;
        let grid = RawGrid::of(columns, rows, Some([width / columns as f64, height / rows as f64]));
        let units = [Unit::stated(&self.unit_xy, place())?, Unit::stated(&self.unit_z, place())?];
        Ok(Reading::new(Format::Gwy, values.numbers(count, Number::F64)?, grid, units))
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
mod tests {
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
    fn file(units: &[&str]) -> Vec<u8> {
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
