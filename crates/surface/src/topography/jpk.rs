//! Images of JPK, which are TIFF files. The tags of a file describe the grid, the channels, and the
//! calibrations of the channels, which the format calls slots. The first row in the file is the
//! lowest row of the map, unless the grid is reflected.

use super::channel::{self, Label, Wanted};
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::tiff::Directory;
use super::transpose::reverse_rows;
use super::unit::Unit;
use crate::error::{SurfaceError, refused};
use asperity_data::shown;

/// Largest number of slots (calibrations) of a channel.
const MOST_SLOTS: usize = 64;

/// The number of a tag grows by this difference from one slot to the next.
const SLOT: u16 = 0x30;

/// Numbers of the tags of the grid, which are in the first directory of the file.
mod grid {
    pub const WIDTH: u16 = 0x8042;
    pub const HEIGHT: u16 = 0x8043;
    pub const IS_REFLECTED: u16 = 0x8045;
}

/// Numbers of the tags of a channel. For slots, these are the numbers in the first slot.
mod tag {
    pub const PHOTOMETRIC: u16 = 262;
    pub const NAME: u16 = 0x8050;
    pub const IS_RETRACE: u16 = 0x8051;
    pub const FULL_NAME: u16 = 0x8052;
    pub const SLOTS: u16 = 0x8080;
    pub const DEFAULT_SLOT: u16 = 0x8081;
    pub const SLOT_NAME: u16 = 0x8090;
    pub const UNIT: u16 = 0x80a2;
    pub const SCALING: u16 = 0x80a3;
    pub const MULTIPLIER: u16 = 0x80a4;
    pub const OFFSET: u16 = 0x80a5;
}

/// Largest photometric code of an image without colours. An image with colours is only a thumbnail.
const GREY: f64 = 1.0;

/// Returns true if the directories of a TIFF file are those of an image of JPK. In such an image,
/// the first directory states the size of the grid.
pub(super) fn is_jpk(directories: &[Directory<'_>]) -> bool {
    let has = |directory: &Directory<'_>, tag: u16| matches!(directory.number(tag), Ok(Some(_)));
    directories
        .first()
        .is_some_and(|first| has(first, grid::WIDTH) && has(first, grid::HEIGHT))
}

/// Reads one channel of an image of JPK. Channels are numbered from 0, without the thumbnail. A
/// channel contains heights if its unit is a length and its name says that it contains heights.
pub(super) fn read(
    directories: &[Directory<'_>],
    wanted: Wanted<'_>,
) -> Result<Reading, SurfaceError> {
    let mut channels = Vec::new();
    let mut labels = Vec::new();
    for directory in directories {
        if directory
            .number(tag::PHOTOMETRIC)?
            .is_some_and(|code| code <= GREY)
            && directory.text(tag::NAME)?.is_some()
        {
            let channel = Channel::read(directory)?;
            labels.push(channel.label(labels.len() as u32));
            channels.push(channel);
        }
    }
    let index = channel::chosen(&labels, "channel", wanted)?;
    // The first directory exists, because [`is_jpk`] has already found the tags of the grid in it.
    let grid = &directories[0];
    channels[index].reading(grid)
}

struct Channel<'a> {
    directory: &'a Directory<'a>,
    name: String,
    is_retrace: bool,
    slot: Slot,
}

/// The slot (calibration) of a channel that the instrument shows by default.
#[derive(Default)]
struct Slot {
    unit: String,
    /// Kind of the conversion from stored numbers to values, such as linear; empty if there is no
    /// conversion.
    scaling: String,
    multiplier: Option<f64>,
    offset: f64,
}

impl Slot {
    fn read(directory: &Directory<'_>) -> Result<Self, SurfaceError> {
        let default = directory.text(tag::DEFAULT_SLOT)?.unwrap_or_default();
        let count = directory.number(tag::SLOTS)?.unwrap_or_default() as usize;
        for number in 0..count.min(MOST_SLOTS) as u16 {
            let tag_of = |first: u16| first + number * SLOT;
            let name = directory.text(tag_of(tag::SLOT_NAME))?;
            if name.as_deref() != Some(&*default) {
                continue;
            }
            let text = |tag: u16| -> Result<String, SurfaceError> {
                let text = directory.text(tag_of(tag))?;
                Ok(text.unwrap_or_default().into_owned())
            };
            return Ok(Slot {
                unit: text(tag::UNIT)?,
                scaling: text(tag::SCALING)?,
                multiplier: directory.number(tag_of(tag::MULTIPLIER))?,
                offset: directory.number(tag_of(tag::OFFSET))?.unwrap_or_default(),
            });
        }
        Ok(Slot::default())
    }
}

impl<'a> Channel<'a> {
    fn read(directory: &'a Directory<'a>) -> Result<Self, SurfaceError> {
        let full = directory.text(tag::FULL_NAME)?;
        let name = match full.filter(|name| !name.is_empty()) {
            Some(name) => name,
            None => directory.text(tag::NAME)?.unwrap_or_default(),
        };
        Ok(Channel {
            directory,
            name: name.into_owned(),
            is_retrace: directory.number(tag::IS_RETRACE)?.unwrap_or_default() != 0.0,
            slot: Slot::read(directory)?,
        })
    }

    fn label(&self, number: u32) -> Label {
        let direction = if self.is_retrace { "retrace" } else { "trace" };
        Label {
            number,
            name: self.name.clone(),
            direction: Some(direction.to_owned()),
            unit: Some(self.slot.unit.clone()),
            has_heights: Unit::is_name(&self.slot.unit) && channel::names_heights(&self.name),
            ..Label::default()
        }
    }

    /// Returns the heights of the channel. `grid` is the directory with the tags of the grid.
    fn reading(&self, grid: &Directory<'_>) -> Result<Reading, SurfaceError> {
        let slot = &self.slot;
        let place = || self.directory.place();
        let multiplier = match (&*slot.scaling, slot.multiplier) {
            ("LinearScaling", Some(multiplier)) => multiplier,
            ("NullScaling" | "", _) => 1.0,
            (scaling, _) => {
                let found = format!("the scaling {:?} of the heights", shown(scaling));
                return Err(refused(place(), found, "LinearScaling with a factor"));
            }
        };
        let heights_unit = Unit::stated(&slot.unit, place())?;
        let mut heights = self.directory.image()?;
        for height in &mut heights {
            *height = *height * multiplier + slot.offset;
        }
        let columns = self.directory.columns()?;
        let is_reflected = grid.number(grid::IS_REFLECTED)?.unwrap_or_default() != 0.0;
        if !is_reflected {
            reverse_rows(&mut heights, columns);
        }
        let rows = heights.len() / columns;
        let width = grid.number(grid::WIDTH)?.unwrap_or_default().abs();
        let height = grid.number(grid::HEIGHT)?.unwrap_or_default().abs();
        let has_size = width > 0.0 && height > 0.0;
        let spacing = has_size.then_some([width / columns as f64, height / rows as f64]);
        let units = StatedUnits::new(Some(Unit::METRE), heights_unit);
        Ok(Reading::even("JPK", heights, columns, spacing, units))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::bytes::Order;
    use super::super::tiff::tests::{Tag, Writer};
    use super::super::tiff_maker;
    use super::*;

    const NUMBERS: [i32; 6] = [1, -2, 3, 40, 50, 60];

    /// Returns a file with a thumbnail, two channels of heights and a channel of phase, on a grid
    /// of 6 µm × 2 µm.
    pub fn file(order: Order, bits: u16, is_reflected: bool) -> Vec<u8> {
        let writer = Writer { order };
        let mut file = writer.begin();
        let mut tags = vec![
            writer.short(tag::PHOTOMETRIC, 3),
            writer.double(grid::WIDTH, 6e-6),
            writer.double(grid::HEIGHT, -2e-6),
            writer.short(grid::IS_REFLECTED, is_reflected.into()),
            writer.text(tag::NAME, "thumbnail"),
        ];
        let mut link = writer.directory(&mut file, 4, &tags);
        for (name, retrace, unit) in [("Height", 0, "m"), ("Height", 1, "m"), ("Phase", 0, "deg")] {
            tags = writer.image(&mut file, &NUMBERS.map(|z| z + i32::from(retrace)), bits);
            tags.extend(channel(&writer, name, retrace, unit));
            link = writer.directory(&mut file, link, &tags);
        }
        file
    }

    fn channel(writer: &Writer, name: &str, retrace: u16, unit: &str) -> Vec<Tag> {
        vec![
            writer.text(tag::NAME, &name.to_lowercase()),
            writer.short(tag::IS_RETRACE, retrace),
            writer.text(tag::FULL_NAME, name),
            writer.long(tag::SLOTS, &[2]),
            writer.text(tag::DEFAULT_SLOT, "nominal"),
            writer.text(tag::SLOT_NAME, "raw"),
            writer.text(tag::SCALING, "NullScaling"),
            writer.text(tag::SLOT_NAME + SLOT, "nominal"),
            writer.text(tag::UNIT + SLOT, unit),
            writer.text(tag::SCALING + SLOT, "LinearScaling"),
            writer.double(tag::MULTIPLIER + SLOT, -2e-10),
            writer.double(tag::OFFSET + SLOT, 3e-6),
        ]
    }

    #[test]
    fn heights_follow_from_the_default_slot() {
        for (order, bits) in [(Order::Little, 16), (Order::Big, 32), (Order::Big, 16)] {
            let bytes = file(order, bits, false);
            let found = tiff_maker::read(&bytes, Wanted::Name("height retrace")).unwrap();
            assert_eq!((found.format, found.columns), ("JPK", 3));
            assert_eq!(found.spacing, Some([2e-6, 1e-6]));
            let expected = |number: i32| f64::from(number + 1) * -2e-10 + 3e-6;
            // The last row in the file is the upper row of the map.
            let upper_first = [40, 50, 60, 1, -2, 3].map(expected);
            assert_eq!(found.heights, upper_first);
            let reflected = tiff_maker::read(&file(order, bits, true), Wanted::Number(1)).unwrap();
            assert_eq!(reflected.heights, NUMBERS.map(expected));
        }
    }

    #[test]
    fn channels_are_listed_and_scalings_are_checked() {
        let bytes = file(Order::Little, 16, false);
        let error = tiff_maker::read(&bytes, Wanted::Heights)
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with(
                "2 channels of heights; channels: 0 \"Height\" trace in m, 1 \"Height\" retrace in m, 2 \
                 \"Phase\" trace in deg; allowed: the number or the name of one"
            ),
            "{error}"
        );
        let error = tiff_maker::read(&bytes, Wanted::Name("Phase")).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("\"deg\" is not a unit of length"),
            "{error}"
        );
        let place = bytes
            .windows(13)
            .position(|found| found == b"LinearScaling")
            .unwrap();
        let mut other = bytes.clone();
        other[place..place + 6].copy_from_slice(b"Square");
        let error = tiff_maker::read(&other, Wanted::Number(0))
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("the scaling \"SquareScaling\" of the heights"),
            "{error}"
        );
        for end in 4..bytes.len() {
            assert!(
                tiff_maker::read(&bytes[..end], Wanted::Number(0)).is_err(),
                "{end}"
            );
        }
    }
}
