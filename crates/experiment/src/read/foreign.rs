//! Recognition of binary files of instruments. The program refuses these files with an error that
//! says how to export their data as text.

use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};
use std::path::Path;

/// Binary format of an instrument or a program.
struct Format {
    /// Extensions of the names of the files of this format.
    extensions: &'static [&'static str],
    /// First bytes of the files of this format; empty if they are unknown.
    signature: &'static [u8],
    name: &'static str,
    /// Part of the error message that says how the user can export the data as text.
    way: &'static str,
}

const FORMATS: [Format; 12] = [
    Format {
        extensions: &["jpk-force", "jpk-force-map", "jpk-qi-data", "jpk-qi-series"],
        signature: b"",
        name: "curves of a JPK instrument",
        way: "the text of JPK Data Processing (File, Export)",
    },
    Format {
        extensions: &["ibw", "pxp", "ardf"],
        signature: b"",
        name: "a damaged wave or an experiment of Igor Pro",
        way: "the binary wave (IBW) of one curve, or the text of Igor Pro (Data, Save Waves, Save Delimited Text)",
    },
    Format {
        extensions: &["h5", "hdf5", "hdf"],
        signature: b"\x89HDF",
        name: "a file of HDF5",
        way: "the table that PyJibe exports (.tab)",
    },
    Format {
        extensions: &["nid"],
        signature: b"",
        name: "a file of Nanosurf",
        way: "the text of Nanosurf Studio (File, Export, CSV)",
    },
    Format {
        extensions: &["spm", "pfc", "000", "001", "002"],
        signature: b"\\*F",
        name: "a file of Nanoscope",
        way: "the text of NanoScope Analysis (Export, ASCII, with the columns Ramp and Defl)",
    },
    Format {
        extensions: &["tdms"],
        signature: b"TDSm",
        name: "a file of LabVIEW",
        way: "the text of DIAdem, or of Python's npTDMS",
    },
    Format {
        extensions: &["mdt"],
        signature: b"\x01\xb0\x93\xff",
        name: "a file of NT-MDT",
        way: "the text of Nova (File, Export, ASCII)",
    },
    Format {
        extensions: &["xlsx"],
        signature: b"",
        name: "a table of Excel",
        way: "the table saved as CSV",
    },
    Format {
        extensions: &["xls"],
        signature: b"\xd0\xcf\x11\xe0",
        name: "a table of Excel",
        way: "the table saved as CSV",
    },
    Format {
        extensions: &["mat"],
        signature: b"MATLAB",
        name: "a file of MATLAB",
        way: "a table by writematrix",
    },
    Format {
        extensions: &["npz"],
        signature: b"",
        name: "an archive of NumPy arrays",
        way: "one array by numpy.save, with a column each",
    },
    Format {
        extensions: &["zip"],
        signature: b"PK",
        name: "an archive",
        way: "the files in it",
    },
];

/// Returns an error if the content of a file is binary. The error names the format of the file, if
/// it is known, and says how to export a text. `path` is the path of the file, and `bytes` its
/// content.
pub(crate) fn check_is_text(path: &Path, bytes: &[u8]) -> Result<(), SurfaceError> {
    let is_utf16 = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    if is_utf16 || !bytes.contains(&0) {
        return Ok(());
    }
    let Some(format) = format_of(path, bytes) else {
        let allowed = "text, CSV or an array of NumPy: the text that the program of the instrument \
            exports, or the table that PyJibe exports";
        return Err(refused(Place::File, "a binary file", allowed));
    };
    let found = format!("{}, which is no text", format.name);
    let mut allowed = format!("text, CSV or an array of NumPy: {}", format.way);
    if !format.way.contains("PyJibe") {
        allowed += ", or the table that PyJibe exports";
    }
    Err(refused(Place::File, found, allowed))
}

/// Returns the format of a file by the end of its name, or else by its first bytes.
fn format_of(path: &Path, bytes: &[u8]) -> Option<&'static Format> {
    let extension = path.extension().unwrap_or_default();
    let extension = extension.to_string_lossy().to_lowercase();
    let by_name = FORMATS
        .iter()
        .find(|format| format.extensions.contains(&&*extension));
    let has_signature =
        |format: &&Format| !format.signature.is_empty() && bytes.starts_with(format.signature);
    by_name.or_else(|| FORMATS.iter().find(has_signature))
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
            (
                "a.IBW",
                b"\x05\0\x11",
                "a damaged wave or an experiment of Igor",
            ),
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
