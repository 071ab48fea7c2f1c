//! The format of a file, determined by its first bytes, and its reader.

use super::error::{Place, TopographyError, refused};
use super::expansion::{MOST_EXPANSION, most_expanded};
use super::read_ahead::read_ahead;
use super::reading::{ReadOptions, Reading};
use super::{Topography, gsf, gwy, netcdf, npy, sdf, sur, text, x3p};
use crate::io::{open_regular, read_limited};
use crate::parallel::threads;
use flate2::read::MultiGzDecoder;
use std::cell::Cell;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::rc::Rc;

/// Most bytes of a file.
pub const MOST_BYTES: u64 = 1 << 30;

/// First bytes of gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Size of the read buffer, bytes.
const BUFFER: usize = 1 << 16;

/// Size from which on another thread reads a file ahead, and passes its bytes on.
const LARGE: u64 = 1 << 24;

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
    read_observed(path, options, &mut |_| ())
}

/// [`read`] with all bytes of the file passed to `seen`, in order; for a large file on another thread.
///
/// # Errors
/// As [`read`].
pub fn read_observed(
    path: &Path,
    options: &ReadOptions,
    seen: &mut (dyn FnMut(&[u8]) + Send),
) -> Result<Topography, TopographyError> {
    read_up_to(path, MOST_BYTES, options, seen)
}

fn read_up_to(
    path: &Path,
    most: u64,
    options: &ReadOptions,
    seen: &mut (dyn FnMut(&[u8]) + Send),
) -> Result<Topography, TopographyError> {
    let file = open_regular(path)?;
    let is_shared = file.metadata()?.len() >= LARGE && threads() > 1;
    let mut source = Observed { source: file, left: most, most, seen };
    let shared =
        is_shared.then(|| read_ahead(&mut source, |content| from_source(content, options))).flatten();
    let surface = match shared {
        Some(surface) => surface?,
        None => from_source(BufReader::with_capacity(BUFFER, &mut source), options)?,
    };
    // Bytes after the surface belong to the file as well.
    io::copy(&mut source, &mut io::sink())?;
    Ok(surface)
}

/// Reads a surface from the content of a file.
///
/// # Errors
/// As [`read`].
pub fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Topography, TopographyError> {
    from_source(bytes, options)
}

fn from_source(mut source: impl BufRead, options: &ReadOptions) -> Result<Topography, TopographyError> {
    let reading = if starts_with(&mut source, &GZIP)? {
        let read = Rc::new(Cell::new(0));
        let counted = Counted { source, read: Rc::clone(&read) };
        let expanded = Expanded { source: MultiGzDecoder::new(counted), read, expanded: 0 };
        from_content(BufReader::with_capacity(BUFFER, expanded), options)?
    } else {
        from_content(source, options)?
    };
    reading.resolve(options)
}

fn from_content(mut source: impl BufRead, options: &ReadOptions) -> Result<Reading, TopographyError> {
    if starts_with(&mut source, &GZIP)? {
        return Err(refused(Place::Byte(0), "gzip within gzip", "gzip once"));
    }
    for (signature, reader) in SIGNATURES {
        if starts_with(&mut source, signature)? {
            return reader(&read_limited(source, MOST_BYTES as usize)?, options);
        }
    }
    text::read(source)
}

/// Returns true if the next bytes are these. A source that is shorter than the signature, or returns its first
/// bytes in pieces, is compared as far as possible.
fn starts_with(source: &mut impl BufRead, signature: &[u8]) -> io::Result<bool> {
    Ok(source.fill_buf()?.starts_with(signature))
}

/// File whose bytes are passed to an observer, up to a limit.
struct Observed<'a, R> {
    source: R,
    left: u64,
    most: u64,
    seen: &'a mut (dyn FnMut(&[u8]) + Send),
}

impl<R: Read> Read for Observed<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.source.read(buffer)?;
        let Some(left) = self.left.checked_sub(read as u64) else {
            let most = self.most;
            return Err(io::Error::other(format!("longer than {most} bytes; allowed: at most {most} bytes")));
        };
        self.left = left;
        (self.seen)(&buffer[..read]);
        Ok(read)
    }
}

/// Source with a count of its bytes.
struct Counted<R> {
    source: R,
    read: Rc<Cell<u64>>,
}

impl<R: Read> Read for Counted<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.read.set(self.read.get() + read as u64);
        Ok(read)
    }
}

/// Decompressed content within [`most_expanded`].
struct Expanded<R> {
    source: R,
    read: Rc<Cell<u64>>,
    expanded: u64,
}

impl<R: Read> Read for Expanded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let expanded = self.source.read(buffer)?;
        self.expanded += expanded as u64;
        if self.expanded > most_expanded(self.read.get()) {
            let fault = format!("gzip expands to more than {MOST_EXPANSION} times its size");
            return Err(io::Error::other(format!("{fault}; allowed: at most that and 1 MiB")));
        }
        Ok(expanded)
    }
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
        let bomb = gzip(&b"1 1\n".repeat(1 << 20));
        assert!(bomb.len() < 10_000);
        let error = parse(&bomb, &metres()).unwrap_err().to_string();
        // The second line already does not ascend; with a comment the reader continues to the limit.
        assert!(error.contains("line 2"), "{error}");
        let bomb = gzip(&b"# 1\n".repeat(1 << 20));
        let error = parse(&bomb, &metres()).unwrap_err().to_string();
        assert!(error.contains("gzip expands to more than 32 times its size; allowed: "), "{error}");
    }

    #[test]
    fn all_bytes_of_a_file_are_seen_up_to_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile");
        let content = gzip(b"0 1\n1 2\n2 1\n");
        std::fs::write(&path, &content).unwrap();
        let mut seen = Vec::new();
        read_observed(&path, &metres(), &mut |bytes| seen.extend_from_slice(bytes)).unwrap();
        assert_eq!(seen, content);
        let most = content.len() as u64 - 1;
        let error = read_up_to(&path, most, &metres(), &mut |_| ()).unwrap_err().to_string();
        assert!(
            error.contains(&format!("longer than {most} bytes; allowed: at most {most} bytes")),
            "{error}"
        );
        let error = read(folder.path(), &metres()).unwrap_err().to_string();
        assert!(error.contains("this is a folder"), "{error}");
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
        let options = ReadOptions { missing: crate::topography::Missing::Interpolate, ..metres() };
        let surface = parse(text, &options).unwrap();
        assert_eq!((surface.heights(), surface.interpolated()), (&[1.0, 2.0, 3.0, 4.0][..], 1));
    }
}
