//! X3P of ISO 25178-72: an archive with `main.xml` and usually a binary file of heights. Lengths are in m.

use super::Unit;
use super::bytes::{Bytes, Number, Order};
use super::error::{Place, TopographyError, refused, shown};
use super::expansion::most_expanded;
use super::reading::{Format, RawGrid, Reading};
use crate::io::{into_text, read_limited};
use roxmltree::{Document, Node, ParsingOptions};
use std::io::Cursor;
use zip::ZipArchive;
use zip::result::ZipError;

/// Most bytes of `main.xml`.
const LONGEST_INDEX: u64 = 1 << 26;

/// Most attributes of `main.xml`, declarations of namespaces among them. The parser compares each with all others of
/// its element, and those of an element with all that it inherits.
const MOST_ATTRIBUTES: usize = 256;

/// Name of the index in the archive.
const INDEX: &str = "main.xml";

/// Letters of the types of heights.
const TYPES: [(&str, Number); 4] =
    [("I", Number::I16), ("L", Number::I32), ("F", Number::F32), ("D", Number::F64)];

pub(super) fn read(bytes: &[u8]) -> Result<Reading, TopographyError> {
    let archive = ZipArchive::new(Cursor::new(bytes))
        .map_err(|error| refused(Place::File, format!("a damaged archive ({error})"), "an X3P archive"))?;
    let mut archive = Archive { archive, most: most_expanded(bytes.len() as u64) };
    let content = archive.read(INDEX, LONGEST_INDEX)?;
    let index =
        into_text(content).map_err(|error| refused(part(INDEX), error.to_string(), "XML in UTF-8"))?;
    check_index(&index)?;
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&index, options)
        .map_err(|error| refused(part(INDEX), shown(&error.to_string()), "XML without a document type"))?;
    let root = document.root_element();
    let axes = [axis(root, "CX")?, axis(root, "CY")?, axis(root, "CZ")?];
    for (axis, name) in axes[..2].iter().zip(["CX", "CY"]) {
        if axis.kind != "I" {
            let fault = format!("the axis {name} is of type {:?}", shown(&axis.kind));
            return Err(refused(part(INDEX), fault, "\"I\", even distances"));
        }
    }
    let columns = count(root, "SizeX")?;
    let rows = count(root, "SizeY")?;
    if count(root, "SizeZ")? != 1 {
        return Err(refused(part(INDEX), "several layers", "SizeZ of 1"));
    }
    let points = columns.saturating_mul(rows);
    let raw = match find(root, "PointDataLink") {
        Some(link) => linked(&mut archive, root, &text_of(link), points, &axes[2])?,
        None => listed(root, points)?,
    };
    let z = &axes[2];
    let heights = raw.into_iter().map(|height| height * z.increment.unwrap_or(1.0) + z.offset).collect();
    let spacing = axes[0].increment.zip(axes[1].increment).map(|(along, between)| [along, between]);
    Ok(Reading {
        format: Format::X3p,
        heights,
        grid: RawGrid::of(columns, rows, spacing),
        lateral_unit: Some(Unit::METRE),
        height_unit: Some(Unit::METRE),
        first_missing: None,
    })
}

/// Refuses an index that takes the parser much more time or memory than its length.
fn check_index(index: &str) -> Result<(), TopographyError> {
    // The parser reserves memory for each of these signs; an element has four characters.
    if index.bytes().filter(|byte| b"<=".contains(byte)).count() > index.len() / 4 {
        return Err(refused(part(INDEX), "more than a quarter of the characters are < or =", "XML"));
    }
    let is_quoted = |value: &&str| value.trim_start().starts_with(['"', '\'']);
    let attributes = index.split('=').skip(1).filter(is_quoted).count();
    if attributes > MOST_ATTRIBUTES {
        let fault = format!("{attributes} attributes and declarations of namespaces");
        return Err(refused(part(INDEX), fault, format!("at most {MOST_ATTRIBUTES}")));
    }
    Ok(())
}

fn part(name: &str) -> Place {
    Place::Part(name.to_owned())
}

/// Archive with a limit of its expanded size.
struct Archive<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    most: u64,
}

impl Archive<'_> {
    /// Content of a file of the archive, at most `most` bytes.
    fn read(&mut self, name: &str, most: u64) -> Result<Vec<u8>, TopographyError> {
        let damaged = |error: &dyn std::fmt::Display| {
            refused(part(name), format!("cannot be unpacked ({error})"), "a file stored or deflated")
        };
        let entry = match self.archive.by_name(name) {
            Ok(entry) => entry,
            Err(ZipError::FileNotFound) => {
                return Err(refused(
                    Place::File,
                    format!("no file {} in the archive", shown(name)),
                    "an X3P archive",
                ));
            }
            Err(error) => return Err(damaged(&error)),
        };
        let most = most.min(self.most);
        read_limited(entry, most as usize).map_err(|error| damaged(&error))
    }
}

/// An axis of the record of axes.
struct Axis {
    kind: String,
    data: String,
    increment: Option<f64>,
    offset: f64,
}

fn axis(root: Node<'_, '_>, name: &str) -> Result<Axis, TopographyError> {
    let found = find(root, name);
    let node = found.ok_or_else(|| refused(part(INDEX), format!("no axis {name}"), "CX, CY and CZ"))?;
    let number = |key: &str| match find(node, key).map(text_of) {
        None => Ok(None),
        Some(text) => match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(refused(part(INDEX), format!("{key} of {name} = {:?}", shown(&text)), "a number")),
        },
    };
    let text = |key: &str| find(node, key).map(text_of).unwrap_or_default();
    Ok(Axis {
        kind: text("AxisType"),
        data: text("DataType"),
        increment: number("Increment")?,
        offset: number("Offset")?.unwrap_or(0.0),
    })
}

/// Heights of a binary file of the archive; those marked invalid in its bit field are missing.
fn linked(
    archive: &mut Archive<'_>,
    root: Node<'_, '_>,
    link: &str,
    points: usize,
    axis: &Axis,
) -> Result<Vec<f64>, TopographyError> {
    let number = TYPES.iter().find(|(letter, _)| *letter == axis.data).map(|(_, number)| *number);
    let number = number.ok_or_else(|| {
        refused(part(INDEX), format!("heights of type {:?}", shown(&axis.data)), "I, L, F or D")
    })?;
    let expected = points.saturating_mul(number.size());
    let content = archive.read(link, expected as u64)?;
    if content.len() != expected {
        let fault = format!("{} bytes", content.len());
        return Err(refused(part(link), fault, format!("{expected} bytes for {points} points")));
    }
    let mut heights = Bytes::new(&content).numbers(points, number, Order::Little)?;
    if let Some(link) = find(root, "ValidPointsLink").map(text_of) {
        let valid = archive.read(&link, points.div_ceil(8) as u64)?;
        if valid.len() != points.div_ceil(8) {
            let fault = format!("{} bytes", valid.len());
            return Err(refused(part(&link), fault, format!("a bit for each of {points} points")));
        }
        for (index, height) in heights.iter_mut().enumerate() {
            if valid[index / 8] >> (index % 8) & 1 == 0 {
                *height = f64::NAN;
            }
        }
    }
    Ok(heights)
}

/// Heights of a list in the index: the last number of each entry; an empty entry is a missing point.
fn listed(root: Node<'_, '_>, points: usize) -> Result<Vec<f64>, TopographyError> {
    let list = find(root, "DataList")
        .ok_or_else(|| refused(part(INDEX), "neither PointDataLink nor DataList", "one of them"))?;
    let mut heights = Vec::new();
    for datum in list.children().filter(|node| node.tag_name().name() == "Datum") {
        let text = text_of(datum);
        let last = text.rsplit(';').next().unwrap_or_default().trim();
        let height = if last.is_empty() { Ok(f64::NAN) } else { last.parse::<f64>() };
        heights.push(height.map_err(|_| {
            refused(part(INDEX), format!("Datum {} = {:?}", heights.len() + 1, shown(&text)), "numbers")
        })?);
    }
    if heights.len() != points {
        let fault = format!("{} heights in the list", heights.len());
        return Err(refused(part(INDEX), fault, format!("{points}, SizeX times SizeY")));
    }
    Ok(heights)
}

/// The first element of this name below a node, in any namespace.
fn find<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.descendants().find(|node| node.is_element() && node.tag_name().name() == name)
}

fn text_of(node: Node<'_, '_>) -> String {
    node.text().unwrap_or_default().trim().to_owned()
}

fn count(root: Node<'_, '_>, name: &str) -> Result<usize, TopographyError> {
    let text = find(root, name).map(text_of).unwrap_or_default();
    match text.parse::<usize>() {
        Ok(count) if count > 0 => Ok(count),
        _ => Err(refused(part(INDEX), format!("{name} = {:?}", shown(&text)), "a whole number above 0")),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use std::io::Write;
    use zip::write::SimpleFileOptions;

    pub const MAIN: &str = "<?xml version='1.0' encoding='UTF-8'?>\n\
        <p:ISO5436_2 xmlns:p='http://www.opengps.eu/2008/ISO5436_2'><Record1><Revision>ISO5436 - 2000</Revision>\
        <FeatureType>SUR</FeatureType><Axes>\
        <CX><AxisType>I</AxisType><DataType>D</DataType><Increment>1e-6</Increment><Offset>0</Offset></CX>\
        <CY><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>0</Offset></CY>\
        <CZ><AxisType>A</AxisType><DataType>I</DataType><Increment>1e-9</Increment><Offset>5e-9</Offset></CZ>\
        </Axes></Record1><Record3><MatrixDimension><SizeX>3</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
        <DataLink><PointDataLink>bindata/data.bin</PointDataLink>\
        <ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink></Record3></p:ISO5436_2>";

    pub fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, content) in files {
            writer.start_file(*name, SimpleFileOptions::default()).unwrap();
            writer.write_all(content).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    pub fn heights() -> Vec<u8> {
        [1_i16, 2, 3, 4, 5, 6].iter().flat_map(|height| height.to_le_bytes()).collect()
    }

    fn with(main: &str) -> Result<Reading, String> {
        let files: [(&str, &[u8]); 3] =
            [(INDEX, main.as_bytes()), ("bindata/data.bin", &heights()), ("bindata/valid.bin", &[0b10_1111])];
        read(&archive(&files)).map_err(|error| error.to_string())
    }

    #[test]
    fn linked_heights_have_scale_offset_and_validity() {
        let reading = with(MAIN).unwrap();
        assert_eq!(reading.grid, RawGrid::Map { columns: 3, spacing: Some([1e-6, 2e-6]) });
        assert!((reading.heights[3] - 9e-9).abs() < 1e-20 && reading.heights[4].is_nan());
        assert_eq!(reading.height_unit, Some(Unit::METRE));
    }

    #[test]
    fn listed_heights_are_the_last_of_each_entry() {
        let (before, rest) = MAIN.split_once("<DataLink>").unwrap();
        let (_, after) = rest.split_once("</DataLink>").unwrap();
        let list = "<DataList><Datum>0;0;1</Datum><Datum>2</Datum><Datum/><Datum>4</Datum><Datum>5</Datum>\
                    <Datum>6</Datum></DataList>";
        let reading = with(&format!("{before}{list}{after}")).unwrap();
        assert!((reading.heights[0] - 6e-9).abs() < 1e-20 && reading.heights[2].is_nan());
        let short = list.replace("<Datum>2</Datum>", "");
        let error = with(&format!("{before}{short}{after}")).unwrap_err();
        assert_eq!(error, "main.xml: 5 heights in the list; allowed: 6, SizeX times SizeY");
    }

    #[test]
    fn faults_have_a_place() {
        for (from, to, expected) in [
            ("<SizeX>3", "<SizeX>0", "main.xml: SizeX = \"0\"; allowed: a whole number above 0"),
            ("<SizeX>3", "<SizeX>4", "bindata/data.bin: 12 bytes; allowed: 16 bytes for 8 points"),
            ("<SizeX>3", "<SizeX>99999999999", "bindata/data.bin: 12 bytes; allowed: "),
            ("<CX><AxisType>I", "<CX><AxisType>A", "main.xml: the axis CX is of type \"A\""),
            ("<DataType>I", "<DataType>X", "main.xml: heights of type \"X\"; allowed: I, L, F or D"),
            ("bindata/data.bin", "data", "no file data in the archive"),
            ("<Increment>1e-6", "<Increment>wide", "main.xml: Increment of CX = \"wide\"; allowed: a number"),
            ("</Axes>", "", "main.xml: "),
            ("<SizeZ>1", "<SizeZ>2", "main.xml: several layers"),
        ] {
            let error = with(&MAIN.replacen(from, to, 1)).unwrap_err();
            assert!(error.starts_with(expected), "{to}: {error}");
        }
        assert!(read(b"PK\x03\x04").unwrap_err().to_string().starts_with("a damaged archive"));
        let without = archive(&[("other", b"")]);
        assert!(read(&without).unwrap_err().to_string().starts_with("no file main.xml in the archive"));
    }

    #[test]
    fn an_index_that_takes_long_to_parse_is_refused_at_once() {
        let declared =
            |count: usize| -> String { (0..count).map(|i| format!(" xmlns:n{i} = 'u{i}'")).collect() };
        let with_root = |more: &str| MAIN.replacen(" xmlns:p=", &format!("{more} xmlns:p="), 1);
        // Three attributes are those of the document itself.
        assert!(with(&with_root(&declared(MOST_ATTRIBUTES - 3))).is_ok());
        let nested: String = (0..40_000).map(|i| format!("<a xmlns:n{i}=\"u{i}\">")).collect();
        let attributes: String = (0..40_000).map(|i| format!(" a{i}=\"\"")).collect();
        let refused = "main.xml: 40003 attributes and declarations of namespaces; allowed: at most 256";
        for more in [declared(40_000), attributes] {
            assert_eq!(with(&with_root(&more)).unwrap_err(), refused);
        }
        assert_eq!(with(&MAIN.replacen("<Record1>", &format!("<Record1>{nested}"), 1)).unwrap_err(), refused);
        for marks in ["<", "="] {
            let error = with(&format!("{MAIN}<!--{}-->", marks.repeat(100_000))).unwrap_err();
            assert_eq!(error, "main.xml: more than a quarter of the characters are < or =; allowed: XML");
        }
    }

    #[test]
    fn an_index_that_expands_too_far_is_refused() {
        let long = format!("{}{}", MAIN, " ".repeat(40 << 20));
        let error = with(&long).unwrap_err();
        assert!(error.starts_with("main.xml: cannot be unpacked (longer than"), "{error}");
    }
}
