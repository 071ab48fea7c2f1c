//! The format of a file, determined by its first bytes, and its reader.

use super::bytes::{MOST_EXPANSION, most_expanded};
use super::error::{Place, TopographyError, refused};
use super::reading::{ReadOptions, Reading};
use super::{Topography, gsf, gwy, netcdf, npy, sdf, sur, text, x3p};
use crate::io::{ReadError, read_limited, read_regular};
use flate2::read::MultiGzDecoder;
use std::path::Path;

/// Most bytes of a file.
pub const MOST_BYTES: usize = 1 << 30;

/// First bytes of gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// A reader of a whole binary file.
type BinaryReader = fn(&[u8], &ReadOptions) -> Result<Reading, TopographyError>;

/// First bytes of the binary formats. All others are text.
const SIGNATURES: [(&[u8], BinaryReader); 10] = [
    (npy::SIGNATURE, |bytes, _| npy::read(bytes)),
    (gsf::SIGNATURE, |bytes, _| gsf::read(bytes)),
    (netcdf::SIGNATURE, |bytes, _| netcdf::read(bytes)),
    (gwy::SIGNATURE, |bytes, options| gwy::read(bytes, options.channel)),
    (b"DIGITAL SURF", |bytes, _| sur::read(bytes)),
    (b"DSCOMPRESSED", |bytes, _| sur::read(bytes)),
    (b"aISO-1.0", |bytes, _| sdf::read_text(bytes)),
    (b"aBCR-1.0", |bytes, _| sdf::read_text(bytes)),
    (b"bISO-1.0", |bytes, _| sdf::read_binary(bytes)),
    (b"PK\x03\x04", |bytes, _| x3p::read(bytes)),
];

/// Reads a surface from a regular file of at most 1 GiB.
///
/// # Errors
/// [`TopographyError`] if the file cannot be read or is no surface.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Topography, TopographyError> {
    parse(&content(path)?, options)
}

/// Reads the bytes of a regular file of at most 1 GiB, for [`parse`].
///
/// # Errors
/// [`TopographyError`] if the file cannot be read or is longer.
pub fn content(path: &Path) -> Result<Vec<u8>, TopographyError> {
    Ok(read_regular(path, MOST_BYTES)?)
}

/// Reads a surface from the content of a file.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Topography, TopographyError> {
    let expanded = bytes.starts_with(&GZIP).then(|| expanded(bytes)).transpose()?;
    let content = expanded.as_deref().unwrap_or(bytes);
    if content.starts_with(&GZIP) {
        return Err(refused(Place::Byte(0), "gzip within gzip", "gzip once"));
    }
    let reader = SIGNATURES.iter().find(|(signature, _)| content.starts_with(signature));
    reader.map_or_else(|| text::read(content), |(_, read)| read(content, options))?.resolve(options)
}

/// Decompresses gzip.
fn expanded(bytes: &[u8]) -> Result<Vec<u8>, TopographyError> {
    let most = most_expanded(bytes.len());
    read_limited(MultiGzDecoder::new(bytes), most.min(MOST_BYTES)).map_err(|error| match error {
        ReadError::TooLong { .. } if most <= MOST_BYTES => {
            let fault = format!("gzip expands to more than {MOST_EXPANSION} times its size");
            refused(Place::File, fault, "at most that and 1 MiB")
        }
        error => error.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::Unit;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::io::Write;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn metres() -> ReadOptions {
        ReadOptions { unit: Some(Unit::METRE), ..ReadOptions::default() }
    }

    #[test]
    fn gzip_is_read_as_its_content() {
        let text = b"0 1\n1 2\n2 1\n";
        let plain = parse(text, &metres()).unwrap();
        assert_eq!(parse(&gzip(text), &metres()), Ok(plain.clone()));
        let members = [gzip(b"0 1\n1 2\n"), gzip(b"2 1\n")].concat();
        assert_eq!(parse(&members, &metres()), Ok(plain));
        let nested = parse(&gzip(&gzip(text)), &metres()).unwrap_err();
        assert_eq!(nested.to_string(), "byte 0: gzip within gzip; allowed: gzip once");
        assert!(parse(&gzip(text)[..15], &metres()).is_err());
    }

    #[test]
    fn decompression_ends_at_a_multiple_of_the_file() {
        let bomb = gzip(&b"# 1\n".repeat(1 << 20));
        assert!(bomb.len() < 10_000);
        let error = parse(&bomb, &metres()).unwrap_err().to_string();
        assert_eq!(error, "gzip expands to more than 32 times its size; allowed: at most that and 1 MiB");
    }

    #[test]
    fn folders_and_long_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile");
        let error = read(folder.path(), &metres()).unwrap_err().to_string();
        assert!(error.contains("this is a folder"), "{error}");
        // A sparse file takes no room on the disk.
        std::fs::File::create(&path).unwrap().set_len(MOST_BYTES as u64 + 1).unwrap();
        let error = read(&path, &metres()).unwrap_err().to_string();
        assert_eq!(error, "longer than 1073741824 bytes; allowed: at most 1073741824 bytes");
    }

    #[test]
    fn units_and_distances_are_never_guessed() {
        let none = ReadOptions::default();
        let error = parse(b"0 1\n1 2\n", &none).unwrap_err().to_string();
        assert_eq!(
            error,
            "no unit of heights is stated; allowed: a unit in the file or beside it: --unit um, in a scene roughness.unit"
        );
        let error = parse(b"1\n2\n", &metres()).unwrap_err().to_string();
        assert_eq!(
            error,
            "text columns without a distance between points; allowed: a distance beside the file: --spacing 0.5um, in a \
             scene roughness.spacing"
        );
        let error = parse(b"x [nm] z [nm]\n0 1\n1 2\n", &metres()).unwrap_err().to_string();
        assert!(
            error.starts_with("the file states nm as the unit of heights, the options state m"),
            "{error}"
        );
        let spaced = ReadOptions { spacing: Some(0.5), ..metres() };
        assert_eq!(parse(b"1\n2\n", &spaced).unwrap().spacing(), Ok([0.5; 2]));
    }

    #[test]
    fn missing_points_are_refused_or_filled() {
        let text = b"0 1\n1 bad\n2 3\n3 4\n";
        let error = parse(text, &metres()).unwrap_err().to_string();
        assert_eq!(
            error,
            "line 2: 1 of 4 points are missing (25.00 %), the first here; allowed: --interpolate, in a scene \
             roughness.interpolate, which fills them from their neighbours"
        );
        let options = ReadOptions { interpolate: true, ..metres() };
        let surface = parse(text, &options).unwrap();
        assert_eq!((surface.heights(), surface.interpolated()), (&[1.0, 2.0, 3.0, 4.0][..], 1));
    }
}
