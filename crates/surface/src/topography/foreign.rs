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

/// First bytes, name of the format, and what is allowed in its place.
const SIGNATURES: [(&[u8], &str, &str); 30] = [
    (
        b"\\*Force file list",
        "a file of force curves of Nanoscope",
        CURVE,
    ),
    (b"?*File list", "Nanoscope as text", GWYDDION),
    (b"Data_File_Type", "Nanoscope of version 2", GWYDDION),
    (b"AliconaImaging", "AL3D of Alicona", GWYDDION),
    (
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "a document of MountainsMap (MNT) or of Office",
        MOUNTAINS,
    ),
    (
        b"\x89HDF\r\n\x1a\n",
        "HDF5, as DATX, H5 and NetCDF-4 are",
        ARRAYS,
    ),
    (b"\x01\0Directory", "OPD of Wyko", GWYDDION),
    (b"VCA DATA", "OPDx of Dektak and Vision64", GWYDDION),
    (b"\x88\x1b\x03", "DAT of Zygo MetroPro", GWYDDION),
    (b"VK3", "VK3 of Keyence", GWYDDION),
    (b"VK4", "VK4 of Keyence", GWYDDION),
    (b"VK6", "VK6 of Keyence", GWYDDION),
    (b"KPK", "ZON of Keyence", GWYDDION),
    (b"FRTM_GL", "FRT of FormFactor", GWYDDION),
    (b"fileType      Image", "MI of Agilent", GWYDDION),
    (b"[DataSet]", "NID of Nanosurf", GWYDDION),
    (b"WSxM file", "STP or TOP of WSxM", GWYDDION),
    (b"Binary TrueMap", "TMD of TrueMap", GWYDDION),
    (b":NANONIS_VERSION:", "SXM of Nanonis", GWYDDION),
    (b"\x01\xb0\x93\xff", "MDT of NT-MDT", GWYDDION),
    (b"fileformat = bcr", "BCR of SPIP", GWYDDION),
    (b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0", "BCR of SPIP", GWYDDION),
    (b"II*\0", "TIFF, also of JPK and Park", GWYDDION),
    (b"MM\0*", "TIFF, also of JPK and Park", GWYDDION),
    (b"MATLAB 5.0 MAT-file", "a MAT-file of MATLAB", ARRAYS),
    (b"\x05\0\x94", "IBW of Igor and Asylum", GWYDDION),
    (b"\x89PNG", "a picture (PNG)", PICTURE),
    (b"\xff\xd8\xff", "a picture (JPEG)", PICTURE),
    (b"GIF8", "a picture (GIF)", PICTURE),
    (b"%PDF", "a document (PDF)", PICTURE),
];

/// Ends of the names of files in an archive, name of its format, and what is allowed in its place.
const ARCHIVES: [(&str, &str, &str); 5] = [
    (".npy", "NPZ of NumPy", ARRAYS),
    ("xl/workbook.xml", "a workbook (XLSX)", SHEET),
    ("recipe.txt", "PLUX of Sensofar", GWYDDION),
    ("word/document.xml", "a document (DOCX)", PICTURE),
    ("header.properties", "an archive of JPK", CURVE),
];

/// Returns an error with the name of the format if the content has a format that is known, but not
/// read.
pub(super) fn check(bytes: &[u8]) -> Result<(), SurfaceError> {
    let known = SIGNATURES
        .iter()
        .find(|(signature, ..)| bytes.starts_with(signature));
    // A date of 24 letters, then zeros.
    let is_plu = bytes
        .get(..25)
        .is_some_and(|head| head[24] == 0 && head[13] == b':' && head[16] == b':');
    let plu = is_plu.then_some(("PLU of Sensofar", GWYDDION));
    let known = known.map(|(_, name, allowed)| (*name, *allowed));
    known
        .or(plu)
        .map_or(Ok(()), |(name, allowed)| Err(unread(name, allowed)))
}

fn unread(name: &str, allowed: &str) -> SurfaceError {
    refused(Place::File, format!("{name} is not read"), allowed)
}

/// Returns the error for an archive with files of these names, none of which is an index.
pub(super) fn archive<'a>(
    names: impl Iterator<Item = &'a str> + Clone,
    [x3p, in_json, in_yaml]: [&str; 3],
) -> SurfaceError {
    let found = ARCHIVES
        .iter()
        .find(|(end, ..)| names.clone().any(|name| name.ends_with(end)));
    if let Some((_, name, allowed)) = found {
        return unread(name, allowed);
    }
    let allowed = format!(
        "{x3p} of X3P, or {in_json} or {in_yaml} of a container; others saved as GWY or X3P in Gwyddion"
    );
    refused(Place::File, "an archive without an index", allowed)
}

#[cfg(test)]
mod tests {
    use super::super::bytes::tests::archive;
    use super::super::open::parse;
    use super::super::reading::ReadOptions;

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
