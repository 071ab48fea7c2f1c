//! X3P of ISO 25178-72: an archive with `main.xml` and usually a binary file of heights. Lengths are in m.

use super::Unit;
use super::bytes::{Archive, Bytes, Number, Order, unpacked_size};
use super::reading::Reading;
use super::{Place, TopographyError, refused, shown};
use encoding_rs::{Encoding, UTF_8};
use roxmltree::{Document, Node, ParsingOptions};

const LONGEST_INDEX: usize = 1 << 26;

/// Limit of the number of attributes of `main.xml`, including declarations of namespaces. The parser compares each
/// attribute with all others of its element, and each declaration with all that the element inherits.
const MOST_ATTRIBUTES: usize = 256;

pub(super) const INDEX: &str = "main.xml";

const TYPES: [(&str, Number); 4] =
    [("I", Number::I16), ("L", Number::I32), ("F", Number::F32), ("D", Number::F64)];

pub(super) fn read(mut archive: Archive<'_>) -> Result<Reading, TopographyError> {
    let content = archive.unpacked(INDEX, LONGEST_INDEX)?;
    // A byte order mark overrules the declaration.
    let (index, ..) = declared_encoding(&content).unwrap_or(UTF_8).decode(&content);
    check_index(&index)?;
    let options = ParsingOptions { allow_dtd: false, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&index, options)
        .map_err(|error| wrong(shown(&error.to_string()), "XML without a document type"))?;
    let root = document.root_element();
    let axis = |name: &str| find(root, name).ok_or_else(|| wrong(format!("no axis {name}"), "CX, CY and CZ"));
    let [x, y, z] = [axis("CX")?, axis("CY")?, axis("CZ")?];
    let (along, between) = (number(x, "Increment")?, number(y, "Increment")?);
    let (scale, offset) = (number(z, "Increment")?.unwrap_or(1.0), number(z, "Offset")?.unwrap_or(0.0));
    if let Some(axis) = [x, y].into_iter().find(|axis| text(*axis, "AxisType") != "I") {
        let kind = shown(text(axis, "AxisType"));
        let fault = format!("the axis {} is of type {kind:?}", axis.tag_name().name());
        return Err(wrong(fault, "\"I\", even distances"));
    }
    let (columns, rows) = (count(root, "SizeX")?, count(root, "SizeY")?);
    if count(root, "SizeZ")? != 1 {
        return Err(wrong("several layers", "SizeZ of 1"));
    }
    let points = columns.saturating_mul(rows);
    let mut heights = match find(root, "PointDataLink") {
        Some(link) => linked(&mut archive, root, trimmed(link), points, text(z, "DataType"))?,
        None => listed(root, points)?,
    };
    heights.iter_mut().for_each(|height| *height = *height * scale + offset);
    let spacing = along.zip(between).map(|(along, between)| [along, between]);
    Ok(Reading::even("X3P", heights, columns, spacing, [Some(Unit::METRE); 3]))
}

/// Encoding that the XML declaration states, if it is one that contains ASCII.
fn declared_encoding(content: &[u8]) -> Option<&'static Encoding> {
    let declaration = content.strip_prefix(b"<?xml")?.split(|byte| *byte == b'>').next()?;
    let (_, rest) = str::from_utf8(declaration).ok()?.split_once("encoding")?;
    Encoding::for_label(rest.trim_start().strip_prefix('=')?.split(['"', '\'']).nth(1)?.as_bytes())
}

/// Returns an error for an index whose parsing would take far more time or memory than its length suggests.
fn check_index(index: &str) -> Result<(), TopographyError> {
    // The parser reserves memory for each of these signs; an element has four characters.
    if index.bytes().filter(|byte| b"<=".contains(byte)).count() > index.len() / 4 {
        return Err(wrong("more than a quarter of the characters are < or =", "XML"));
    }
    let is_quoted = |value: &&str| value.trim_start().starts_with(['"', '\'']);
    let attributes = index.split('=').skip(1).filter(is_quoted).count();
    if attributes > MOST_ATTRIBUTES {
        let fault = format!("{attributes} attributes and declarations of namespaces");
        return Err(wrong(fault, &format!("at most {MOST_ATTRIBUTES}")));
    }
    Ok(())
}

fn wrong(fault: impl std::fmt::Display, allowed: &str) -> TopographyError {
    refused(Place::Part(INDEX.to_owned()), fault, allowed)
}

/// Reads the heights of a binary file of an archive; heights marked invalid in the bit field are missing.
fn linked(
    archive: &mut Archive<'_>,
    root: Node<'_, '_>,
    link: &str,
    points: usize,
    kind: &str,
) -> Result<Vec<f64>, TopographyError> {
    let Some((_, number)) = TYPES.into_iter().find(|(letter, _)| *letter == kind) else {
        return Err(wrong(format!("heights of type {:?}", shown(kind)), "I, L, F or D"));
    };
    let mut read = |name: &str, bytes: usize, allowed: String| match archive.unpacked_up_to(name, bytes)? {
        content if content.len() == bytes => Ok(content),
        content => Err(refused(Place::Part(name.to_owned()), format!("{} bytes", content.len()), allowed)),
    };
    let expected = unpacked_size(points, number, Place::Part(INDEX.to_owned()))?;
    let content = read(link, expected, format!("{expected} bytes for {points} points"))?;
    let mut heights = Bytes::new(&content, Order::Little).numbers(points, number)?;
    if let Some(link) = find(root, "ValidPointsLink") {
        let valid = read(trimmed(link), points.div_ceil(8), format!("a bit for each of {points} points"))?;
        let is_missing = |index: usize| valid[index / 8] >> (index % 8) & 1 == 0;
        let missing = heights.iter_mut().enumerate().filter(|(index, _)| is_missing(*index));
        missing.for_each(|(_, height)| *height = f64::NAN);
    }
    Ok(heights)
}

/// Reads the heights of a list in the index: the last number of each entry; an empty entry is a missing point.
fn listed(root: Node<'_, '_>, points: usize) -> Result<Vec<f64>, TopographyError> {
    let list =
        find(root, "DataList").ok_or_else(|| wrong("neither PointDataLink nor DataList", "one of them"))?;
    let mut heights = Vec::new();
    for datum in list.children().filter(|node| node.tag_name().name() == "Datum") {
        let text = trimmed(datum);
        let last = text.rsplit(';').next().unwrap_or_default().trim();
        let height = if last.is_empty() { Ok(f64::NAN) } else { last.parse::<f64>() };
        heights.push(
            height
                .map_err(|_| wrong(format!("Datum {} = {:?}", heights.len() + 1, shown(text)), "numbers"))?,
        );
    }
    if heights.len() != points {
        let fault = format!("{} heights in the list", heights.len());
        return Err(wrong(fault, &format!("{points}, SizeX times SizeY")));
    }
    Ok(heights)
}

/// Returns the first element of this name below a node, in any namespace.
fn find<'a, 'input>(node: Node<'a, 'input>, name: &str) -> Option<Node<'a, 'input>> {
    node.descendants().find(|node| node.is_element() && node.tag_name().name() == name)
}

fn trimmed<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Returns the text of the first element of this name below a node; empty if there is none.
fn text<'a>(node: Node<'a, '_>, name: &str) -> &'a str {
    find(node, name).map_or("", trimmed)
}

/// Returns the number in the first element of this name; `None` if the element is missing or empty.
fn number(axis: Node<'_, '_>, name: &str) -> Result<Option<f64>, TopographyError> {
    let Some(text) = find(axis, name).map(trimmed).filter(|text| !text.is_empty()) else { return Ok(None) };
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    let fault = || format!("{name} of {} = {:?}", axis.tag_name().name(), shown(text));
    number.map(Some).ok_or_else(|| wrong(fault(), "a number"))
}

fn count(root: Node<'_, '_>, name: &str) -> Result<usize, TopographyError> {
    let text = text(root, name);
    let count = text.parse().ok().filter(|count| *count > 0);
    count.ok_or_else(|| wrong(format!("{name} = {:?}", shown(text)), "a whole number above 0"))
}

#[cfg(test)]
mod tests {
    use super::super::bytes::tests::archive;
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

    /// The surface with an index in one folder, and its files in another one.
    fn in_folders(main: &[u8], [folder, bindata]: [&str; 2]) -> Result<Reading, String> {
        let heights = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0];
        let name = |folder: &str, name: &str| format!("{folder}{name}");
        let names =
            [name(folder, INDEX), name(bindata, "bindata/data.bin"), name(bindata, "bindata/valid.bin")];
        let files = [(&*names[0], main), (&names[1], &heights[..]), (&names[2], &[0b10_1111])];
        let bytes = archive(&files);
        let mut archive = Archive::new(&bytes).unwrap();
        archive.index(&[INDEX]).map_err(|error| error.to_string())?;
        read(archive).map_err(|error| error.to_string())
    }

    fn same(one: &Reading, other: &Reading) -> bool {
        let bits = |reading: &Reading| reading.heights.iter().map(|z| z.to_bits()).collect::<Vec<_>>();
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
            assert!(same(&in_folders(main.as_bytes(), folders).unwrap(), &plain), "{folders:?}");
        }
        let (head, rest) = MAIN.split_once("<Record1>").unwrap();
        let head = head.replacen("UTF-8", "ISO-8859-1", 1);
        let in_latin = [head.as_bytes(), b"<!-- 5 \xb5m --><Record1>", rest.as_bytes()].concat();
        assert!(same(&in_folders(&in_latin, ["", ""]).unwrap(), &plain));
        let in_utf_16: Vec<u8> =
            format!("\u{feff}{MAIN}").encode_utf16().flat_map(u16::to_le_bytes).collect();
        assert!(same(&in_folders(&in_utf_16, ["", ""]).unwrap(), &plain));
        // The scale of heights that is not stated is 1, the distance between points is asked for.
        let no_scale = with(&MAIN.replacen("<Increment>1e-9</Increment>", "<Increment/>", 1)).unwrap();
        assert_eq!(no_scale.heights[0], 1.0 + 5e-9);
        assert_eq!(with(&MAIN.replacen("<Increment>1e-6", "<Increment>", 1)).unwrap().spacing, None);
    }

    #[test]
    fn heights_may_be_compressed_to_any_size() {
        let (columns, rows) = (2000, 500);
        let main = MAIN.replacen("<SizeX>3", &format!("<SizeX>{columns}"), 1);
        let main =
            main.replacen("<SizeY>2", &format!("<SizeY>{rows}"), 1).replacen("<DataType>I", "<DataType>D", 1);
        let (before, rest) = main.split_once("<ValidPointsLink>").unwrap();
        let main = format!("{before}{}", rest.split_once("</ValidPointsLink>").unwrap().1);
        let heights = vec![0; 8 * columns * rows];
        let bytes = archive(&[(INDEX, main.as_bytes()), ("bindata/data.bin", &heights)]);
        assert!(heights.len() > 500 * bytes.len(), "{}", bytes.len());
        assert_eq!(read(Archive::new(&bytes).unwrap()).unwrap().heights.len(), columns * rows);
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
        assert_eq!(error, "main.xml: 5 heights in the list; allowed: 6, SizeX times SizeY");
    }

    #[test]
    fn faults_have_a_place() {
        for (from, to, expected) in [
            ("<SizeX>3", "<SizeX>0", "main.xml: SizeX = \"0\"; allowed: a whole number above 0"),
            ("<SizeX>3", "<SizeX>4", "bindata/data.bin: 12 bytes; allowed: 16 bytes for 8 points"),
            (
                "<SizeX>3",
                "<SizeX>99999999999",
                "main.xml: 199999999998 compressed heights of 2 bytes; allowed: ",
            ),
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
        let long = with(&format!("{}{}", MAIN, " ".repeat(40 << 20))).unwrap_err();
        assert!(long.starts_with("main.xml: cannot be unpacked (longer than"), "{long}");
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
}
