//! Binary files of instruments, which are refused with the way to a text.

use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};
use std::path::Path;

/// For each binary format: ends of file names, first bytes, name, and the way to a text file.
const FORMATS: [(&[&str], &[u8], &str, &str); 12] = [
    (
        &["jpk-force", "jpk-force-map", "jpk-qi-data", "jpk-qi-series"],
        b"",
        "curves of a JPK instrument",
        "the text of JPK Data Processing (File, Export)",
    ),
    (
        &["ibw", "pxp"],
        b"",
        "a wave of Igor Pro",
        "the text of Igor Pro (Data, Save Waves, Save Delimited Text)",
    ),
    (
        &["h5", "hdf5", "hdf"],
        b"\x89HDF",
        "a file of HDF5",
        "the table that PyJibe exports (.tab)",
    ),
    (
        &["nid"],
        b"",
        "a file of Nanosurf",
        "the text of Nanosurf Studio (File, Export, CSV)",
    ),
    (
        &["spm", "pfc", "000", "001", "002"],
        b"\\*F",
        "a file of Nanoscope",
        "the text of NanoScope Analysis (Export, ASCII, with the columns Ramp and Defl)",
    ),
    (
        &["tdms"],
        b"TDSm",
        "a file of LabVIEW",
        "the text of DIAdem, or of Python's npTDMS",
    ),
    (
        &["mdt"],
        b"\x01\xb0\x93\xff",
        "a file of NT-MDT",
        "the text of Nova (File, Export, ASCII)",
    ),
    (&["xlsx"], b"", "a table of Excel", "the table saved as CSV"),
    (
        &["xls"],
        b"\xd0\xcf\x11\xe0",
        "a table of Excel",
        "the table saved as CSV",
    ),
    (
        &["mat"],
        b"MATLAB",
        "a file of MATLAB",
        "a table by writematrix",
    ),
    (
        &["npz"],
        b"",
        "an archive of NumPy arrays",
        "one array by numpy.save, with a column each",
    ),
    (&["zip"], b"PK", "an archive", "the files in it"),
];

/// Returns an error for a binary file. The error names the format and the way to a text file.
pub(crate) fn check_is_text(path: &Path, bytes: &[u8]) -> Result<(), SurfaceError> {
    let is_wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    if is_wide || !bytes.contains(&0) {
        return Ok(());
    }
    let extension = path
        .extension()
        .map(|of| of.to_string_lossy().to_lowercase())
        .unwrap_or_default();
    let by_name = FORMATS
        .iter()
        .find(|format| format.0.contains(&&*extension));
    let by_bytes = || {
        FORMATS
            .iter()
            .find(|format| !format.1.is_empty() && bytes.starts_with(format.1))
    };
    let (fault, way) = match by_name.or_else(by_bytes) {
        Some((_, _, what, way)) => (format!("{what}, which is no text"), *way),
        None => (
            "a binary file".to_owned(),
            "the text that the program of the instrument exports",
        ),
    };
    let allowed =
        format!("text, CSV or an array of NumPy: {way}, or the table that PyJibe exports");
    let allowed = if way.contains("PyJibe") {
        format!("text, CSV or an array of NumPy: {way}")
    } else {
        allowed
    };
    Err(refused(Place::File, fault, allowed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn binary_files_are_named_with_the_way_to_a_text() {
        for (name, bytes, said) in [
            (
                "a.jpk-force",
                &b"PK\x03\x04\0"[..],
                "curves of a JPK instrument, which is no text",
            ),
            ("a.IBW", b"\x05\0\x11", "a wave of Igor Pro"),
            ("a", b"\x89HDF\r\n\0", "a file of HDF5"),
            ("a.nid", b"[DataSet]\r\n#!\0\x01", "a file of Nanosurf"),
            ("a.spm", b"\\*File list\r\n\x1a\0", "a file of Nanoscope"),
            (
                "a.dat",
                b"\\*Force file list\r\n\x1a\0",
                "a file of Nanoscope",
            ),
            ("a.tdms", b"TDSm\0", "a file of LabVIEW"),
            ("a.zip", b"PK\x03\x04\0", "an archive"),
            (
                "a.dat",
                b"\x01\0",
                "a binary file; allowed: text, CSV or an array of NumPy: the text that",
            ),
        ] {
            let error = check_is_text(Path::new(name), bytes)
                .unwrap_err()
                .to_string();
            assert!(
                error.starts_with(said) && error.contains("exports"),
                "{name}: {error}"
            );
        }
        for bytes in [&b"\xff\xfe1\0"[..], b"1,2\n", b"\\*File list\r\n1 2\n"] {
            assert_eq!(check_is_text(Path::new("a.spm"), bytes), Ok(()));
        }
    }
}
