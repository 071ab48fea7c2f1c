//! Recognition of formats that cannot be read, by their first bytes or by the files in an archive.
//! The error message can then name the format and say how to convert the file.

use crate::error::{Place, SurfaceError, refused};

const GWYDDION: &str = "the same saved as GWY or X3P in Gwyddion";
const PICTURE: &str = "the heights as text, X3P, SUR or GWY, from the program that drew them";
const CURVE: &str = "a surface; a force curve exported as text, for asperity fit";
const ARRAYS: &str =
    "the heights saved by numpy.save, or as X3P, SUR or text by the program that wrote the file";
const MOUNTAINS: &str = "the same exported as SUR or X3P in MountainsMap";
const SHEET: &str = "the same saved as CSV";
const RASTER: &str = "the same on an even grid (Rasterize), saved as GWY or X3P in Gwyddion";
const MESH: &str =
    "the heights on an even grid as X3P, SUR, GWY or text, from the program of the instrument";
const KEYENCE: &str = "the same as VK4, or the heights as CSV, from the program of the microscope";

/// A format that the program recognises but cannot read.
struct Foreign {
    name: &'static str,
    /// Part of the error message that says what can be read instead.
    allowed: &'static str,
}

/// A format that is recognised by its first bytes.
struct KnownStart {
    start: &'static [u8],
    format: Foreign,
}

const fn starting(start: &'static [u8], name: &'static str, allowed: &'static str) -> KnownStart {
    KnownStart {
        start,
        format: Foreign { name, allowed },
    }
}

const KNOWN_STARTS: [KnownStart; 30] = [
    starting(
        b"\\*Force file list",
        "a file of force curves of Nanoscope",
        CURVE,
    ),
    starting(b"?*File list", "Nanoscope as text", GWYDDION),
    starting(b"Data_File_Type", "Nanoscope of version 2", GWYDDION),
    starting(b"AliconaImaging", "AL3D of Alicona", GWYDDION),
    starting(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a document of MountainsMap (MNT) or of Office",
        MOUNTAINS,
    ),
    starting(
        b"\x89HDF\r\n\x1a\n",
        "HDF5, as DATX, H5 and NetCDF-4 are",
        ARRAYS,
    ),
    starting(b"\x01\0Directory", "OPD of Wyko", GWYDDION),
    starting(b"VCA DATA", "OPDx of Dektak and Vision64", GWYDDION),
    starting(b"VK6", "VK6 of Keyence", KEYENCE),
    starting(b"VK7", "VK7 of Keyence", KEYENCE),
    starting(b"Gwyddion XYZ Field", "GXYZF of Gwyddion", RASTER),
    starting(b"OmniSurf3D", "OS3D of Digital Metrology", GWYDDION),
    starting(b"Zeta-Instruments", "ZMG of Zeta", GWYDDION),
    starting(b"OLYMPUSRAWFORMAT", "OIR of Olympus", GWYDDION),
    starting(b"ply\n", "a mesh (PLY)", MESH),
    starting(b"ply\r\n", "a mesh (PLY)", MESH),
    starting(b"KPK", "ZON of Keyence", GWYDDION),
    starting(b"FRTM_GL", "FRT of FormFactor", GWYDDION),
    starting(b"fileType      Image", "MI of Agilent", GWYDDION),
    starting(b"[DataSet]", "NID of Nanosurf", GWYDDION),
    starting(b"Binary TrueMap", "TMD of TrueMap", GWYDDION),
    starting(b":NANONIS_VERSION:", "SXM of Nanonis", GWYDDION),
    starting(b"\x01\xb0\x93\xff", "MDT of NT-MDT", GWYDDION),
    starting(b"fileformat = bcr", "BCR of SPIP", GWYDDION),
    starting(b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0", "BCR of SPIP", GWYDDION),
    starting(b"MATLAB 5.0 MAT-file", "a MAT-file of MATLAB", ARRAYS),
    starting(b"\x89PNG", "a picture (PNG)", PICTURE),
    starting(b"\xff\xd8\xff", "a picture (JPEG)", PICTURE),
    starting(b"GIF8", "a picture (GIF)", PICTURE),
    starting(b"%PDF", "a document (PDF)", PICTURE),
];

/// A format that is an archive. It is recognised by the end of the name of one of its files.
struct KnownArchive {
    file_end: &'static str,
    format: Foreign,
}

const fn archive_with(
    file_end: &'static str,
    name: &'static str,
    allowed: &'static str,
) -> KnownArchive {
    KnownArchive {
        file_end,
        format: Foreign { name, allowed },
    }
}

const KNOWN_ARCHIVES: [KnownArchive; 5] = [
    archive_with(".npy", "NPZ of NumPy", ARRAYS),
    archive_with("xl/workbook.xml", "a workbook (XLSX)", SHEET),
    archive_with("recipe.txt", "PLUX of Sensofar", GWYDDION),
    archive_with("word/document.xml", "a document (DOCX)", PICTURE),
    archive_with("header.properties", "an archive of JPK", CURVE),
];

/// A format that is recognised by more than its first bytes.
struct KnownContent {
    has: fn(&[u8]) -> bool,
    format: Foreign,
}

const fn containing(
    has: fn(&[u8]) -> bool,
    name: &'static str,
    allowed: &'static str,
) -> KnownContent {
    KnownContent {
        has,
        format: Foreign { name, allowed },
    }
}

const KNOWN_CONTENTS: [KnownContent; 7] = [
    containing(is_plu, "PLU of Sensofar", GWYDDION),
    containing(is_wsxm_image, "STP or TOP of WSxM", GWYDDION),
    containing(is_sm4, "SM4 of RHK", GWYDDION),
    containing(is_createc, "DAT of Createc", GWYDDION),
    containing(is_mesh, "a mesh (STL)", MESH),
    containing(is_asd, "ASD of a high-speed microscope", GWYDDION),
    containing(is_nms, "NMS of NanoFocus", GWYDDION),
];

/// Returns an error if the content of a file has a known format that cannot be read. The error
/// names this format.
pub(super) fn check(bytes: &[u8]) -> Result<(), SurfaceError> {
    for known in &KNOWN_STARTS {
        if bytes.starts_with(known.start) {
            return Err(unread(&known.format));
        }
    }
    for known in &KNOWN_CONTENTS {
        if (known.has)(bytes) {
            return Err(unread(&known.format));
        }
    }
    Ok(())
}

/// Returns true for a binary image of the program WSxM. Its first words alone do not suffice,
/// because the text files of WSxM, which can be read, begin with the same words.
fn is_wsxm_image(bytes: &[u8]) -> bool {
    let second_line = bytes.split(|byte| *byte == b'\n').nth(1);
    let has_image = second_line.is_some_and(|line| line.starts_with(b"SxM Image file"));
    bytes.starts_with(b"WSxM file") && (has_image || bytes.contains(&0))
}

/// Returns true for the format PLU of Sensofar. Such a file begins with a date of 24 letters and a
/// zero byte.
fn is_plu(bytes: &[u8]) -> bool {
    match bytes.get(..25) {
        Some(head) => head[24] == 0 && head[13] == b':' && head[16] == b':',
        None => false,
    }
}

/// Returns true for the format SM4 of RHK. Such a file has, after the size of the header, the name
/// of the format in letters of two bytes.
fn is_sm4(bytes: &[u8]) -> bool {
    let name = bytes.get(2..).unwrap_or_default();
    name.starts_with(b"S\0T\0i\0M\0a\0g\0e\0 \0")
}

/// Returns true for a file of Createc: it begins with one of three words and contains binary
/// numbers.
fn is_createc(bytes: &[u8]) -> bool {
    let starts: [&[u8]; 3] = [b"[Parameter]", b"[Paramet32]", b"[Paramco32]"];
    starts.iter().any(|start| bytes.starts_with(start)) && bytes.contains(&0)
}

/// Returns true for a mesh of triangles (format STL), as text or in binary form. The binary form
/// has a header of 80 bytes, the number of triangles, and 50 bytes for each triangle.
fn is_mesh(bytes: &[u8]) -> bool {
    const HEADER: usize = 80;
    const TRIANGLE: usize = 50;
    let head = &bytes[..bytes.len().min(1_024)];
    if head.starts_with(b"solid") && head.windows(5).any(|word| word == b"facet") {
        return true;
    }
    let Some(count) = little_endian(bytes, HEADER) else {
        return false;
    };
    let size = count.saturating_mul(TRIANGLE).saturating_add(HEADER + 4);
    count > 0 && bytes.len() == size
}

/// Returns true for the format ASD: a version number below 3, and the two letters of a channel at
/// the offset that belongs to this version.
fn is_asd(bytes: &[u8]) -> bool {
    const CHANNELS: [[u8; 2]; 4] = [*b"TP", *b"PT", *b"ER", *b"PH"];
    let letters = match (little_endian(bytes, 0), bytes.get(..28)) {
        (Some(0), Some(head)) => [head[4], head[5]],
        (Some(1 | 2), Some(head)) if head[25] == 0 && head[27] == 0 => [head[24], head[26]],
        _ => return false,
    };
    CHANNELS.contains(&letters)
}

/// Returns true for the format NMS: a header of fixed size whose numbers of columns and rows agree
/// with the size of the file.
fn is_nms(bytes: &[u8]) -> bool {
    const HEADER: usize = 3_468;
    const COUNTS: usize = 1_368;
    let (Some(columns), Some(rows)) = (
        little_endian(bytes, COUNTS),
        little_endian(bytes, COUNTS + 4),
    ) else {
        return false;
    };
    let points = columns.saturating_mul(rows);
    points > 0 && bytes.len() == points.saturating_mul(2).saturating_add(HEADER)
}

/// Returns the number that is encoded in the four bytes at this offset, the lowest byte first.
fn little_endian(bytes: &[u8], offset: usize) -> Option<usize> {
    let bytes = bytes.get(offset..offset + 4)?;
    Some(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize)
}

fn unread(format: &Foreign) -> SurfaceError {
    SurfaceError::UnreadFormat {
        place: Place::File,
        format: format.name,
        allowed: format.allowed,
    }
}

/// Returns the error for an archive that contains files with the names `names` but no index file.
pub(super) fn archive<'a>(
    names: impl Iterator<Item = &'a str> + Clone,
    indices: [&str; 3],
) -> SurfaceError {
    for known in &KNOWN_ARCHIVES {
        if names.clone().any(|name| name.ends_with(known.file_end)) {
            return unread(&known.format);
        }
    }
    let [x3p, in_json, in_yaml] = indices;
    let allowed = format!(
        "{x3p} of X3P, or {in_json} or {in_yaml} of a container; others saved as GWY or X3P in Gwyddion"
    );
    refused(Place::File, "an archive without an index", allowed)
}

#[cfg(test)]
mod tests {
    use super::super::archive::tests::archive;
    use super::super::open::parse;
    use super::super::options::ReadOptions;

    #[test]
    fn known_formats_that_are_not_read_are_named_with_a_way_out() {
        let parse = |bytes: &[u8]| {
            parse(bytes, &ReadOptions::default())
                .unwrap_err()
                .to_string()
        };
        for (head, expected) in [
            (
                &b"AliconaImaging\0\r\n"[..],
                "AL3D of Alicona is not read; allowed: the same saved as GWY or X3P in Gwyddion",
            ),
            (
                b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0\0",
                "a document of MountainsMap (MNT) or of Office is not read; allowed: the same exported as SUR",
            ),
            (
                b"\\*Force file list\r\n\\Version: 1\r\n",
                "a file of force curves of Nanoscope is not read; allowed: a surface; a force curve exported as text",
            ),
            (
                b"Fri Mar 10 16:35:59 2023\0\0\0",
                "PLU of Sensofar is not read; allowed: ",
            ),
            (
                b"WSxM file copyright UAM\nSxM Image file\nImage header size: 9\n",
                "STP or TOP of WSxM is not read; allowed: the same saved as GWY",
            ),
            (
                b"\x8e\0S\0T\0i\0M\0a\0g\0e\0 \x000\0",
                "SM4 of RHK is not read; allowed: ",
            ),
            (
                b"[Paramco32]\r\nNum.X=4\r\n\0\0",
                "DAT of Createc is not read; allowed: ",
            ),
            (
                b"Gwyddion XYZ Field 1.0\nNChannels = 1\n",
                "GXYZF of Gwyddion is not read; allowed: the same on an even grid (Rasterize)",
            ),
            (
                b"solid part\n facet normal 0 0 1\n",
                "a mesh (STL) is not read; allowed: the heights on an even grid",
            ),
            (
                &[&[7; 80][..], &[1, 0, 0, 0], &[7; 50]].concat(),
                "a mesh (STL) is not read; allowed: the heights on an even grid",
            ),
            (
                &[b"\0\0\0\0TPER", &[1; 20][..]].concat(),
                "ASD of a high-speed microscope is not read; allowed: ",
            ),
            (
                &[b"\x01\0\0\0", &[9; 20][..], b"T\0P\0"].concat(),
                "ASD of a high-speed microscope is not read; allowed: ",
            ),
            (
                &[&[1; 1_368][..], &[2, 0, 0, 0, 3, 0, 0, 0], &[1; 2_092 + 12]].concat(),
                "NMS of NanoFocus is not read; allowed: ",
            ),
            (
                b"VK6\0",
                "VK6 of Keyence is not read; allowed: the same as VK4",
            ),
            (
                b"ab\0\x01\x02",
                "line 1: byte 2 of the line is zero, so this is no text; allowed: text, SDF",
            ),
        ] {
            assert!(parse(head).starts_with(expected), "{}", parse(head));
        }
        for (name, expected) in [
            (
                "arr_0.npy",
                "NPZ of NumPy is not read; allowed: the heights saved by numpy.save",
            ),
            (
                "xl/workbook.xml",
                "a workbook (XLSX) is not read; allowed: the same saved as CSV",
            ),
            (
                "a.txt",
                "an archive without an index; allowed: main.xml of X3P, or index.json or meta.yml of a container; others",
            ),
        ] {
            let error = parse(&archive(&[(name, b"1 2")]));
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
