//! Names of formats that are not read, by their first bytes or the files of an archive. A message
//! can then state the way out.

use crate::error::{Place, SurfaceError, refused};

const GWYDDION: &str = "the same saved as GWY or X3P in Gwyddion";
const PICTURE: &str = "the heights as text, X3P, SUR or GWY, from the program that drew them";
const CURVE: &str = "a surface; a force curve exported as text, for asperity fit";
const ARRAYS: &str =
    "the heights saved by numpy.save, or as X3P, SUR or text by the program that wrote the file";
const MOUNTAINS: &str = "the same exported as SUR or X3P in MountainsMap";
const SHEET: &str = "the same saved as CSV";

/// A format that is not read.
struct Foreign {
    name: &'static str,
    /// What is allowed in its place.
    allowed: &'static str,
}

/// A format that is known by its first bytes.
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

const KNOWN_STARTS: [KnownStart; 29] = [
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
    starting(b"\x88\x1b\x03", "DAT of Zygo MetroPro", GWYDDION),
    starting(b"VK3", "VK3 of Keyence", GWYDDION),
    starting(b"VK4", "VK4 of Keyence", GWYDDION),
    starting(b"VK6", "VK6 of Keyence", GWYDDION),
    starting(b"KPK", "ZON of Keyence", GWYDDION),
    starting(b"FRTM_GL", "FRT of FormFactor", GWYDDION),
    starting(b"fileType      Image", "MI of Agilent", GWYDDION),
    starting(b"[DataSet]", "NID of Nanosurf", GWYDDION),
    starting(b"Binary TrueMap", "TMD of TrueMap", GWYDDION),
    starting(b":NANONIS_VERSION:", "SXM of Nanonis", GWYDDION),
    starting(b"\x01\xb0\x93\xff", "MDT of NT-MDT", GWYDDION),
    starting(b"fileformat = bcr", "BCR of SPIP", GWYDDION),
    starting(b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0", "BCR of SPIP", GWYDDION),
    starting(b"II*\0", "TIFF, also of JPK and Park", GWYDDION),
    starting(b"MM\0*", "TIFF, also of JPK and Park", GWYDDION),
    starting(b"MATLAB 5.0 MAT-file", "a MAT-file of MATLAB", ARRAYS),
    starting(b"\x05\0\x94", "IBW of Igor and Asylum", GWYDDION),
    starting(b"\x89PNG", "a picture (PNG)", PICTURE),
    starting(b"\xff\xd8\xff", "a picture (JPEG)", PICTURE),
    starting(b"GIF8", "a picture (GIF)", PICTURE),
    starting(b"%PDF", "a document (PDF)", PICTURE),
];

/// A format that is an archive, known by the end of the name of one of its files.
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

const WSXM: Foreign = Foreign {
    name: "STP or TOP of WSxM",
    allowed: GWYDDION,
};

/// First words of all files of WSxM, also of its texts.
const WSXM_START: &[u8] = b"WSxM file";

/// Second line of the images of WSxM that are no text.
const WSXM_IMAGE: &[u8] = b"SxM Image file";

const PLU: Foreign = Foreign {
    name: "PLU of Sensofar",
    allowed: GWYDDION,
};

/// Returns an error with the name of the format if the content has a format that is known, but not
/// read.
pub(super) fn check(bytes: &[u8]) -> Result<(), SurfaceError> {
    for known in &KNOWN_STARTS {
        if bytes.starts_with(known.start) {
            return Err(unread(&known.format));
        }
    }
    if is_plu(bytes) {
        return Err(unread(&PLU));
    }
    if is_wsxm_image(bytes) {
        return Err(unread(&WSXM));
    }
    Ok(())
}

/// Returns true for an image of WSxM in binary numbers.
fn is_wsxm_image(bytes: &[u8]) -> bool {
    let second_line = bytes.split(|byte| *byte == b'\n').nth(1);
    let has_image = second_line.is_some_and(|line| line.starts_with(WSXM_IMAGE));
    bytes.starts_with(WSXM_START) && (has_image || bytes.contains(&0))
}

/// Returns true for a date of 24 letters, then a zero.
fn is_plu(bytes: &[u8]) -> bool {
    match bytes.get(..25) {
        Some(head) => head[24] == 0 && head[13] == b':' && head[16] == b':',
        None => false,
    }
}

fn unread(format: &Foreign) -> SurfaceError {
    SurfaceError::UnreadFormat {
        place: Place::File,
        format: format.name,
        allowed: format.allowed,
    }
}

/// Returns the error for an archive with files of these names, none of which is an index.
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
