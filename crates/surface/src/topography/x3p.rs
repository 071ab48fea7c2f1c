//! The format X3P of ISO 25178-72. A file is an archive with the index file `main.xml` and usually
//! a binary file of heights. Lengths are in m.

use super::archive::Archive;
use super::bytes::{Bytes, Number, Order, unpacked_size};
use super::grid::PointList;
use super::printed::Digits;
use super::reading::Reading;
use super::stated_units::StatedUnits;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Note, emptied, gathered, push, shown};
use encoding_rs::{Encoding, UTF_8};
use md5::{Digest, Md5};
use roxmltree::{Document, Node, ParsingOptions};
use std::fmt;

/// Largest allowed size of the index file `main.xml` in bytes.
const LONGEST_INDEX: usize = 1 << 26;

/// Largest allowed number of attributes in `main.xml`, including declarations of namespaces. The
/// time of the parser grows with the square of this number: each attribute is compared with all
/// others of its element, and each declaration with all declarations that the element inherits.
const MOST_ATTRIBUTES: usize = 256;

/// Name of the index file in the archive.
pub(super) const INDEX: &str = "main.xml";

/// Index of the heights in arrays of coordinates, after x and y.
const Z: usize = 2;

pub(super) fn read(mut archive: Archive<'_>) -> Result<Reading, SurfaceError> {
    let content = archive.unpacked(INDEX, LONGEST_INDEX)?;
    let encoding = declared_encoding(&content).unwrap_or(UTF_8);
    // If the content begins with a byte order mark, `decode` uses the encoding of this mark and not
    // that of the declaration.
    let (index, ..) = encoding.decode(&content);
    check_index(&index)?;
    let options = ParsingOptions {
        allow_dtd: false,
        ..ParsingOptions::default()
    };
    match Document::parse_with_options(&index, options) {
        Ok(document) => Surface::new(document.root_element())?.read(archive),
        Err(error) => {
            let found = shown(&error.to_string());
            Err(wrong(found, "XML without a document type"))
        }
    }
}

/// Returns the encoding that the XML declaration states; `None` unless the encoding contains ASCII.
fn declared_encoding(content: &[u8]) -> Option<&'static Encoding> {
    let declaration = content.strip_prefix(b"<?xml")?;
    let declaration = declaration.split(|byte| *byte == b'>').next()?;
    let (_, rest) = str::from_utf8(declaration).ok()?.split_once("encoding")?;
    let value = rest.trim_start().strip_prefix('=')?;
    let label = value.split(['"', '\'']).nth(1)?;
    Encoding::for_label(label.as_bytes())
}

/// Returns an error if parsing the index file would take far more time or memory than its length
/// suggests.
fn check_index(index: &str) -> Result<(), SurfaceError> {
    // The parser reserves memory for each `<` and each `=`. Real files have few of them, because
    // even the shortest element, `<a/>`, has four characters.
    let signs = index.bytes().filter(|byte| b"<=".contains(byte)).count();
    if signs > index.len() / 4 {
        let found = "more than a quarter of the characters are < or =";
        return Err(wrong(found, "XML"));
    }
    let is_quoted = |value: &&str| value.trim_start().starts_with(['"', '\'']);
    let attributes = index.split('=').skip(1).filter(is_quoted).count();
    if attributes > MOST_ATTRIBUTES {
        let found = format!("{attributes} attributes and declarations of namespaces");
        return Err(wrong(found, &format!("at most {MOST_ATTRIBUTES}")));
    }
    Ok(())
}

fn wrong(found: impl fmt::Display, allowed: &str) -> SurfaceError {
    refused(Place::Part(INDEX.to_owned()), found, allowed)
}

struct Axis<'a> {
    /// True if the file has a coordinate for each point. If it is false, the points are evenly
    /// spaced, and the increment is their distance.
    is_absolute: bool,
    increment: Option<f64>,
    offset: f64,
    data_type: &'a str,
}

impl<'a> Axis<'a> {
    fn new(axis: Node<'a, '_>) -> Result<Self, SurfaceError> {
        let kind = text(axis, "AxisType");
        let name = axis.tag_name().name();
        // The axis of the heights always has a coordinate for each point.
        let is_absolute = name == "CZ" || kind == "A";
        if !is_absolute && kind != "I" {
            let found = format!("the axis {name} is of type {:?}", shown(kind));
            let allowed = "\"I\", even distances, or \"A\", a position of each point";
            return Err(wrong(found, allowed));
        }
        let offset = number(axis, "Offset")?.unwrap_or(0.0);
        Ok(Axis {
            is_absolute,
            increment: number(axis, "Increment")?,
            offset,
            data_type: text(axis, "DataType"),
        })
    }

    /// Returns the type of the coordinates on this axis in a binary file.
    fn number_type(&self) -> Result<Number, SurfaceError> {
        match self.data_type {
            "I" => Ok(Number::I16),
            "L" => Ok(Number::I32),
            "F" => Ok(Number::F32),
            "D" => Ok(Number::F64),
            other => {
                let found = format!("coordinates of type {:?}", shown(other));
                Err(wrong(found, "I, L, F or D"))
            }
        }
    }
}

/// Coordinates x, y and z of each point in m. The list of an axis without coordinates is empty.
type Coordinates = [Vec<f64>; 3];

/// A surface as the index file describes it.
struct Surface<'a, 'input> {
    root: Node<'a, 'input>,
    axes: [Axis<'a>; 3],
    /// Messages for the user about unusual properties of the file.
    warnings: Vec<Note>,
}

impl<'a, 'input> Surface<'a, 'input> {
    fn new(root: Node<'a, 'input>) -> Result<Self, SurfaceError> {
        let nodes = [axis(root, "CX")?, axis(root, "CY")?, axis(root, "CZ")?];
        let [x, y, z] = nodes.map(Axis::new);
        Ok(Surface {
            root,
            axes: [x?, y?, z?],
            warnings: Vec::new(),
        })
    }

    fn read(mut self, archive: Archive<'_>) -> Result<Reading, SurfaceError> {
        let mut reading = if text(self.root, "ListDimension").is_empty() {
            self.matrix(archive)?
        } else {
            self.list(archive)?
        };
        reading.warnings.append(&mut self.warnings);
        Ok(reading)
    }

    /// Reads points that are listed in any order.
    fn list(&mut self, mut archive: Archive<'_>) -> Result<Reading, SurfaceError> {
        let points = count(self.root, "ListDimension")?;
        if self.axes.iter().any(|axis| !axis.is_absolute) {
            let found = "a list of points with an incremental axis";
            return Err(wrong(found, "absolute axes"));
        }
        let coordinates = self.coordinates(&mut archive, points)?;
        scattered(sorted(coordinates)?, points)
    }

    /// Reads points that are arranged in rows and columns.
    fn matrix(&mut self, mut archive: Archive<'_>) -> Result<Reading, SurfaceError> {
        let columns = count(self.root, "SizeX")?;
        let rows = count(self.root, "SizeY")?;
        if count(self.root, "SizeZ")? != 1 {
            return Err(wrong("several layers", "SizeZ of 1"));
        }
        let points = columns.saturating_mul(rows);
        let mut coordinates = self.coordinates(&mut archive, points)?;
        let [x, y, _] = &self.axes;
        if x.is_absolute || y.is_absolute {
            if !x.is_absolute {
                let distance = x.increment.unwrap_or(1.0);
                let positions = (0..points).map(|index| (index % columns) as f64 * distance);
                coordinates[0] = gathered(points, positions)?;
            }
            if !y.is_absolute {
                let distance = y.increment.unwrap_or(1.0);
                let positions = (0..points).map(|index| (index / columns) as f64 * distance);
                coordinates[1] = gathered(points, positions)?;
            }
            return scattered(coordinates, columns);
        }
        let spacing = match (x.increment, y.increment) {
            (Some(along), Some(between)) => Some([along, between]),
            _ => None,
        };
        let [.., heights] = coordinates;
        let units = StatedUnits::METRES;
        Ok(Reading::even("X3P", heights, columns, spacing, units))
    }

    /// Returns a message if the MD5 checksum of binary content differs from the checksum that the
    /// index file states. ISO 25178-72 demands that they are equal. `element` is the name of the
    /// element that states the checksum.
    fn changed(&self, name: &str, content: &[u8], element: &str) -> Option<String> {
        let stated = trimmed(find(self.root, element)?);
        let is_checksum = stated.len() == 32 && stated.bytes().all(|byte| byte.is_ascii_hexdigit());
        if !is_checksum {
            return None;
        }
        let mut found = String::with_capacity(32);
        for byte in Md5::digest(content) {
            found.push_str(&format!("{byte:02x}"));
        }
        if stated.eq_ignore_ascii_case(&found) {
            return None;
        }
        let name = shown(name);
        Some(format!(
            "{name} has the MD5 {found}, and {INDEX} states {stated}: the file was changed or \
             damaged after it was written"
        ))
    }

    /// Reads the coordinates of each point from a binary file of the archive, or from a list in the
    /// index file.
    fn coordinates(
        &mut self,
        archive: &mut Archive<'_>,
        points: usize,
    ) -> Result<Coordinates, SurfaceError> {
        let mut coordinates = match find(self.root, "PointDataLink") {
            Some(link) => self.linked(archive, trimmed(link), points)?,
            None => self.listed(points)?,
        };
        for (values, axis) in coordinates.iter_mut().zip(&self.axes) {
            let scale = axis.increment.unwrap_or(1.0);
            for value in values {
                *value = *value * scale + axis.offset;
            }
        }
        Ok(coordinates)
    }

    /// Reads the coordinates, point by point, from a binary file of the archive. Points that a
    /// field of bits marks as invalid become missing points.
    fn linked(
        &mut self,
        archive: &mut Archive<'_>,
        link: &str,
        points: usize,
    ) -> Result<Coordinates, SurfaceError> {
        let stored = self.stored_coordinates()?;
        let size = stored.iter().map(|coordinate| coordinate.number.size());
        let expected = unpacked_size(points, size.sum(), Place::Part(INDEX.to_owned()))?;
        let allowed = format!("{expected} bytes for {points} points");
        let content = exactly(archive, link, expected, allowed)?;
        let changed = self.changed(link, &content, "MD5ChecksumPointData");
        self.warnings.extend(changed.map(Note::new));

        let mut data = Bytes::new(&content, Order::Little);
        let mut coordinates = [const { Vec::new() }; 3];
        if let [only] = &stored[..] {
            coordinates[only.axis] = data.numbers(points, only.number)?;
        } else {
            for coordinate in &stored {
                coordinates[coordinate.axis] = emptied(Vec::new(), points)?;
            }
            for _ in 0..points {
                for coordinate in &stored {
                    let value = data.number(coordinate.number)?;
                    coordinates[coordinate.axis].push(value);
                }
            }
        }
        if let Some(link) = find(self.root, "ValidPointsLink") {
            let allowed = format!("a bit for each of {points} points");
            let link = trimmed(link);
            let valid = exactly(archive, link, points.div_ceil(8), allowed)?;
            let changed = self.changed(link, &valid, "MD5ChecksumValidPoints");
            self.warnings.extend(changed.map(Note::new));
            remove_invalid(&mut coordinates, &valid);
        }
        Ok(coordinates)
    }

    /// Returns which coordinates a binary file has for each point, in the order in which they are
    /// stored.
    fn stored_coordinates(&self) -> Result<Vec<StoredCoordinate>, SurfaceError> {
        let mut stored = Vec::new();
        for (index, axis) in self.axes.iter().enumerate() {
            if axis.is_absolute {
                stored.push(StoredCoordinate {
                    axis: index,
                    number: axis.number_type()?,
                });
            }
        }
        Ok(stored)
    }

    /// Reads the coordinates from a list in the index file. The last number in each entry is a
    /// height, and an empty entry is a missing point.
    fn listed(&self, points: usize) -> Result<Coordinates, SurfaceError> {
        let Some(list) = find(self.root, "DataList") else {
            let found = "neither PointDataLink nor DataList";
            return Err(wrong(found, "one of them"));
        };
        let mut coordinates = [const { Vec::new() }; 3];
        for datum in list.children() {
            if datum.tag_name().name() != "Datum" {
                continue;
            }
            let text = trimmed(datum);
            let mut cells = text.rsplit(';').map(str::trim);
            for axis in [Z, 1, 0] {
                if !self.axes[axis].is_absolute {
                    continue;
                }
                let cell = cells.next().unwrap_or_default();
                let is_missing = cell.is_empty() && (axis == Z || text.is_empty());
                let value = if is_missing {
                    f64::NAN
                } else if let Ok(value) = cell.parse::<f64>() {
                    value
                } else {
                    let number = coordinates[axis].len() + 1;
                    let found = format!("Datum {number} = {:?}", shown(text));
                    return Err(wrong(found, "numbers"));
                };
                push(&mut coordinates[axis], value)?;
            }
        }
        if coordinates[Z].len() != points {
            let found = format!("{} heights in the list", coordinates[Z].len());
            return Err(wrong(found, &format!("{points}, the number of points")));
        }
        Ok(coordinates)
    }
}

fn axis<'a, 'input>(root: Node<'a, 'input>, name: &str) -> Result<Node<'a, 'input>, SurfaceError> {
    find(root, name).ok_or_else(|| wrong(format!("no axis {name}"), "CX, CY and CZ"))
}

/// A coordinate that a binary file stores for each point.
struct StoredCoordinate {
    /// Index of the axis.
    axis: usize,
    number: Number,
}

/// Returns the content of a file of the archive. Returns an error unless it has exactly `bytes`
/// bytes.
fn exactly(
    archive: &mut Archive<'_>,
    name: &str,
    bytes: usize,
    allowed: String,
) -> Result<Vec<u8>, SurfaceError> {
    let content = archive.unpacked_up_to(name, bytes)?;
    if content.len() == bytes {
        return Ok(content);
    }
    let found = format!("{} bytes", content.len());
    Err(refused(Place::Part(name.to_owned()), found, allowed))
}

/// Removes the coordinates of points whose bit in the field of bits is 0. The stored coordinates of
/// such a point, including its position, have no meaning.
fn remove_invalid(coordinates: &mut Coordinates, valid: &[u8]) {
    for values in coordinates {
        for (index, value) in values.iter_mut().enumerate() {
            let is_valid = valid[index / 8] >> (index % 8) & 1 == 1;
            if !is_valid {
                *value = f64::NAN;
            }
        }
    }
}

/// Sorts the points of a list by y, and points with the same y by x.
fn sorted(coordinates: Coordinates) -> Result<Coordinates, SurfaceError> {
    let [x, y, _] = &coordinates;
    let mut order = gathered(x.len(), 0..x.len())?;
    order.sort_unstable_by(|first, second| {
        let by_y = y[*first].total_cmp(&y[*second]);
        by_y.then(x[*first].total_cmp(&x[*second]))
    });
    let in_order = |values: Vec<f64>| {
        let values = order.iter().map(|index| values[*index]);
        gathered(order.len(), values)
    };
    let [x, y, heights] = coordinates.map(in_order);
    Ok([x?, y?, heights?])
}

/// Returns a profile if all points are in one row and have the same y, otherwise a map of points
/// with their positions x and y. A point whose x or y is missing is left out.
fn scattered(mut coordinates: Coordinates, columns: usize) -> Result<Reading, SurfaceError> {
    let is_one_row = columns == coordinates[Z].len();
    let [x, y, _] = &coordinates;
    let measured = x.iter().zip(y).map(|(x, y)| x.is_finite() && y.is_finite());
    let measured = gathered(x.len(), measured)?;
    for values in &mut coordinates {
        let mut is_measured = measured.iter();
        values.retain(|_| is_measured.next() == Some(&true));
    }
    let [x, y, heights] = coordinates;
    let units = StatedUnits::METRES;
    if is_one_row && y.iter().all(|position| *position == y[0]) {
        return Ok(Reading::profile("X3P", x, heights, units));
    }
    let list = PointList {
        x: &x,
        y: &y,
        heights: &heights,
        digits: [Digits::EXACT; 2],
        place: |index| Place::Point(index + 1),
    };
    let map = list.map()?;
    let heights = map.heights;
    Ok(Reading::even(
        "X3P",
        heights,
        map.columns,
        map.distances,
        units,
    ))
}

/// Returns the first element with this name below a node. Its namespace does not matter.
fn find<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.descendants()
        .find(|node| node.is_element() && node.tag_name().name() == name)
}

fn trimmed<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Returns the text of the first element with this name below a node; an empty text if there is no
/// such element.
fn text<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    find(node, name).map_or("", trimmed)
}

/// Returns the number in the first element with this name; `None` if the element is missing or
/// empty.
fn number(axis: Node<'_, '_>, name: &str) -> Result<Option<f64>, SurfaceError> {
    let text = text(axis, name);
    if text.is_empty() {
        return Ok(None);
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(Some(number)),
        _ => {
            let axis = axis.tag_name().name();
            let found = format!("{name} of {axis} = {:?}", shown(text));
            Err(wrong(found, "a number"))
        }
    }
}

fn count(root: Node<'_, '_>, name: &str) -> Result<usize, SurfaceError> {
    let text = text(root, name);
    match text.parse::<usize>() {
        Ok(count) if count > 0 => Ok(count),
        _ => {
            let found = format!("{name} = {:?}", shown(text));
            Err(wrong(found, "a whole number above 0"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::archive::tests::archive;
    use super::*;

    const MAIN: &str = "<?xml version='1.0' encoding='UTF-8'?>\n\
        <p:ISO5436_2 xmlns:p='http://www.opengps.eu/2008/ISO5436_2'><Record1><Revision>ISO5436 - 2000</Revision>\
        <FeatureType>SUR</FeatureType><Axes>\
        <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1e-6</Increment><Offset>0</Offset></CX>\
        <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>0</Offset></CY>\
        <CZ><AxisType>A</AxisType><DataType>I</DataType><Increment>1e-9</Increment><Offset>5e-9</Offset></CZ>\
        </Axes></Record1><Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
        <DataLink><PointDataLink>bindata/data.bin</PointDataLink>\
        <ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink></Record3></p:ISO5436_2>";

    fn with(main: &str) -> Result<Reading, String> {
        in_folders(main.as_bytes(), ["", ""])
    }

    /// Reads a surface from an archive in which the index file is in one folder, and the other
    /// files are in another folder.
    fn in_folders(main: &[u8], [folder, bindata]: [&str; 2]) -> Result<Reading, String> {
        let heights = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0];
        let name = |folder: &str, name: &str| format!("{folder}{name}");
        let names = [
            name(folder, INDEX),
            name(bindata, "bindata/data.bin"),
            name(bindata, "bindata/valid.bin"),
        ];
        let files = [
            (&*names[0], main),
            (&names[1], &heights[..]),
            (&names[2], &[0b10_1111]),
        ];
        let bytes = archive(&files);
        let mut archive = Archive::new(&bytes).unwrap();
        archive.index(&[INDEX]).map_err(|error| error.to_string())?;
        read(archive).map_err(|error| error.to_string())
    }

    fn same(one: &Reading, other: &Reading) -> bool {
        let bits = |reading: &Reading| {
            reading
                .heights
                .iter()
                .map(|z| z.to_bits())
                .collect::<Vec<_>>()
        };
        bits(one) == bits(other) && (one.columns, one.spacing) == (other.columns, other.spacing)
    }

    #[test]
    fn archives_and_indices_of_other_programs_are_read() {
        let plain = with(MAIN).unwrap();
        let backslashes = MAIN.replace("bindata/", "bindata\\");
        let empty = MAIN.replacen("<Offset>0</Offset>", "<Offset/>", 1);
        for (main, folders) in [
            (MAIN, ["sample/", "sample/"]),
            (MAIN, ["./", ""]),
            (MAIN, ["a/b/", "a\\b\\"]),
            (&*backslashes, ["", ""]),
            (&*empty, ["", ""]),
        ] {
            assert!(
                same(&in_folders(main.as_bytes(), folders).unwrap(), &plain),
                "{folders:?}"
            );
        }
        let (head, rest) = MAIN.split_once("<Record1>").unwrap();
        let head = head.replacen("UTF-8", "ISO-8859-1", 1);
        let in_latin = [
            head.as_bytes(),
            b"<!-- 5 \xb5m --><Record1>",
            rest.as_bytes(),
        ]
        .concat();
        assert!(same(&in_folders(&in_latin, ["", ""]).unwrap(), &plain));
        let in_utf_16: Vec<u8> = format!("\u{feff}{MAIN}")
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        assert!(same(&in_folders(&in_utf_16, ["", ""]).unwrap(), &plain));
        // If the file states no scale of the heights, the scale is 1. If it states no distance
        // between points, this distance remains unknown.
        let no_scale =
            with(&MAIN.replacen("<Increment>1e-9</Increment>", "<Increment/>", 1)).unwrap();
        assert_eq!(no_scale.heights[0], 1.0 + 5e-9);
        assert_eq!(
            with(&MAIN.replacen("<Increment>1e-6", "<Increment>", 1))
                .unwrap()
                .spacing,
            None
        );
    }

    #[test]
    fn content_whose_checksum_differs_is_named() {
        let stating = |checksum: &str| {
            let element = format!("<MD5ChecksumPointData>{checksum}</MD5ChecksumPointData>");
            with(&MAIN.replacen(
                "<ValidPointsLink>",
                &format!("{element}<ValidPointsLink>"),
                1,
            ))
        };
        // This checksum of the twelve bytes of heights was computed with the program md5sum.
        let right = "f6050cdac59263109f2a853227bed520";
        let in_capitals = right.to_uppercase();
        for checksum in [right, &in_capitals, "", "none"] {
            assert_eq!(stating(checksum).unwrap().warnings, [], "{checksum}");
        }
        let wrong = "0".repeat(32);
        let [warning] = &stating(&wrong).unwrap().warnings[..] else {
            panic!("one warning");
        };
        let warning = warning.to_string();
        assert!(
            warning.starts_with(&format!("bindata/data.bin has the MD5 {right}"))
                && warning.contains(&wrong),
            "{warning}"
        );
    }

    #[test]
    fn heights_may_be_compressed_to_any_size() {
        let (columns, rows) = (2000, 500);
        let main = MAIN.replacen("<SizeX>3", &format!("<SizeX>{columns}"), 1);
        let main = main
            .replacen("<SizeY>2", &format!("<SizeY>{rows}"), 1)
            .replacen("<DataType>I", "<DataType>D", 1);
        let (before, rest) = main.split_once("<ValidPointsLink>").unwrap();
        let main = format!(
            "{before}{}",
            rest.split_once("</ValidPointsLink>").unwrap().1
        );
        let heights = vec![0; 8 * columns * rows];
        let bytes = archive(&[(INDEX, main.as_bytes()), ("bindata/data.bin", &heights)]);
        assert!(heights.len() > 500 * bytes.len(), "{}", bytes.len());
        assert_eq!(
            read(Archive::new(&bytes).unwrap()).unwrap().heights.len(),
            columns * rows
        );
        let longer = [&heights[..], &[0]].concat();
        let bytes = archive(&[(INDEX, main.as_bytes()), ("bindata/data.bin", &longer)]);
        let error = read(Archive::new(&bytes).unwrap()).unwrap_err().to_string();
        assert!(
            error.starts_with("bindata/data.bin: cannot be unpacked (longer than 8000000 bytes"),
            "{error}"
        );
    }

    #[test]
    fn heights_have_scale_offset_and_validity() {
        let reading = with(MAIN).unwrap();
        assert_eq!((reading.columns, reading.spacing), (3, Some([1e-6, 2e-6])));
        assert!((reading.heights[3] - 9e-9).abs() < 1e-20 && reading.heights[4].is_nan());
        let (before, rest) = MAIN.split_once("<DataLink>").unwrap();
        let (_, after) = rest.split_once("</DataLink>").unwrap();
        let list = "<DataList><Datum>0;0;1</Datum><Datum>2</Datum><Datum/><Datum>4</Datum><Datum>5</Datum>\
                    <Datum>6</Datum></DataList>";
        let reading = with(&format!("{before}{list}{after}")).unwrap();
        assert!((reading.heights[0] - 6e-9).abs() < 1e-20 && reading.heights[2].is_nan());
        let short = list.replace("<Datum>2</Datum>", "");
        let error = with(&format!("{before}{short}{after}")).unwrap_err();
        assert_eq!(
            error,
            "main.xml: 5 heights in the list; allowed: 6, the number of points"
        );
    }

    #[test]
    fn points_with_positions_of_their_own_are_profiles_and_maps() {
        let (before, rest) = MAIN.split_once("<MatrixDimension>").unwrap();
        let (_, after) = rest.split_once("</DataLink>").unwrap();
        let absolute = before.replacen("<CX><AxisType>I", "<CX><AxisType>A", 1);
        let both = absolute.replacen("<CY><AxisType>I", "<CY><AxisType>A", 1);
        let matrix = |columns: usize, rows: usize| {
            format!(
                "<MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension>"
            )
        };
        let list = |datums: &str| {
            let cells: String = datums
                .split(' ')
                .map(|datum| format!("<Datum>{datum}</Datum>"))
                .collect();
            format!("<DataList>{cells}</DataList>")
        };
        let read = |head: &str, dimension: &str, datums: &str| {
            with(&format!("{head}{dimension}{}{after}", list(datums)))
        };
        let found = read(&absolute, &matrix(3, 1), "1;5 3;6 7;7").unwrap();
        assert_eq!((found.positions.unwrap()[2] * 1e6, found.columns), (7.0, 3));
        // A list may have any order. Its point without a position is left out.
        let points = "<ListDimension>7</ListDimension>";
        let found = read(&both, points, "1;0;1 0;0;0 0;1;3 1;1;4 2;1;5  2;0;2").unwrap();
        assert_eq!((found.columns, found.spacing.unwrap()[0] * 1e6), (3, 1.0));
        let steps = |heights: &[f64]| {
            heights
                .iter()
                .map(|height| (height * 1e9).round() - 5.0)
                .collect::<Vec<_>>()
        };
        assert_eq!(steps(&found.heights), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        // The rows are evenly spaced, but the file states the position of each point along them.
        let found = read(&absolute, &matrix(2, 2), "0;1 3;2 0;3 3;4").unwrap();
        assert_eq!(
            (
                found.columns,
                found.spacing.map(|[x, y]| (x * 1e6, y * 1e6))
            ),
            (2, Some((3.0, 2.0)))
        );
        let numbers: Vec<u8> = [0, 0, 10, 1, 0, 11]
            .iter()
            .flat_map(|number: &i16| number.to_le_bytes())
            .collect();
        let linked = both.replace("<DataType>D", "<DataType>I")
            + "<ListDimension>2</ListDimension><DataLink><PointDataLink>a</PointDataLink></DataLink>"
            + after;
        let bytes = archive(&[(INDEX, linked.as_bytes()), ("a", &numbers)]);
        let found = super::read(Archive::new(&bytes).unwrap()).unwrap();
        assert_eq!(
            (steps(&found.heights), found.positions.unwrap()[1]),
            (vec![10.0, 11.0], 1e-6)
        );
        let uneven = read(
            &both,
            "<ListDimension>4</ListDimension>",
            "0;0;1 1;0;1 0;1;1 7;3;1",
        )
        .unwrap_err();
        assert!(
            uneven.contains("is off the even grid") || uneven.contains("positions x"),
            "{uneven}"
        );
        assert!(
            read(&absolute, points, "1;1")
                .unwrap_err()
                .contains("incremental axis")
        );
    }

    #[test]
    fn faults_have_a_place() {
        for (from, to, expected) in [
            (
                "<SizeX>3",
                "<SizeX>0",
                "main.xml: SizeX = \"0\"; allowed: a whole number above 0",
            ),
            (
                "<SizeX>3",
                "<SizeX>4",
                "bindata/data.bin: 12 bytes; allowed: 16 bytes for 8 points",
            ),
            (
                "<SizeX>3",
                "<SizeX>99999999999",
                "main.xml: 199999999998 compressed heights of 2 bytes; allowed: ",
            ),
            (
                "<CX><AxisType>I",
                "<CX><AxisType>Z",
                "main.xml: the axis CX is of type \"Z\"",
            ),
            (
                "<CX><AxisType>I",
                "<CX><AxisType>A",
                "bindata/data.bin: 12 bytes; allowed: 60 bytes for 6 points",
            ),
            (
                "<DataType>I",
                "<DataType>X",
                "main.xml: coordinates of type \"X\"; allowed: I, L, F or D",
            ),
            ("bindata/data.bin", "data", "no file data in the archive"),
            (
                "<Increment>1e-6",
                "<Increment>wide",
                "main.xml: Increment of CX = \"wide\"; allowed: a number",
            ),
            ("</Axes>", "", "main.xml: "),
            ("<SizeZ>1", "<SizeZ>2", "main.xml: several layers"),
        ] {
            let error = with(&MAIN.replacen(from, to, 1)).unwrap_err();
            assert!(error.starts_with(expected), "{to}: {error}");
        }
        let long = with(&format!("{}{}", MAIN, " ".repeat(40 << 20))).unwrap_err();
        assert!(
            long.starts_with("main.xml: cannot be unpacked (longer than"),
            "{long}"
        );
    }

    #[test]
    fn an_index_that_takes_long_to_parse_is_refused_at_once() {
        let declared = |count: usize| -> String {
            (0..count)
                .map(|i| format!(" xmlns:n{i} = 'u{i}'"))
                .collect()
        };
        let with_root = |more: &str| MAIN.replacen(" xmlns:p=", &format!("{more} xmlns:p="), 1);
        // The document has three attributes already without the declarations that are added.
        assert!(with(&with_root(&declared(MOST_ATTRIBUTES - 3))).is_ok());
        let nested: String = (0..40_000)
            .map(|i| format!("<a xmlns:n{i}=\"u{i}\">"))
            .collect();
        let attributes: String = (0..40_000).map(|i| format!(" a{i}=\"\"")).collect();
        let refused =
            "main.xml: 40003 attributes and declarations of namespaces; allowed: at most 256";
        for more in [declared(40_000), attributes] {
            assert_eq!(with(&with_root(&more)).unwrap_err(), refused);
        }
        assert_eq!(
            with(&MAIN.replacen("<Record1>", &format!("<Record1>{nested}"), 1)).unwrap_err(),
            refused
        );
        for marks in ["<", "="] {
            let error = with(&format!("{MAIN}<!--{}-->", marks.repeat(100_000))).unwrap_err();
            assert_eq!(
                error,
                "main.xml: more than a quarter of the characters are < or =; allowed: XML"
            );
        }
    }
}
