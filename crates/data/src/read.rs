//! Reading of files that users name. Only regular files up to a given size are read.
//!
//! Other files are refused, because opening a pipe would wait for its writer, opening a terminal
//! would wait for its user, and a device may never end. The bytes are counted while they are read,
//! because the size that the system states for a file may be zero or too small.

use std::fs::{File, OpenOptions};
use std::io;
use std::io::Read;
use std::path::Path;
use thiserror::Error;

/// Reason why a file was not read. The message does not contain the name of the file.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The path is a folder.
    #[error("this is a folder; allowed: a file")]
    Folder,
    /// The path is a pipe, a socket, a terminal or another device.
    #[error("this is not a regular file")]
    NotRegular,
    /// The file is a NumPy array, although the caller expects a scene.
    #[error("an array of NumPy holds no scene; allowed: a scene, or a table of results in CSV")]
    Array,
    /// The file is longer than the caller allows.
    #[error("longer than {limit} bytes; allowed: at most {limit} bytes")]
    TooLong {
        /// Largest allowed length in bytes.
        limit: usize,
    },
    /// The bytes are not text in UTF-8.
    #[error("this is not UTF-8 text: byte {byte} is not")]
    NotText {
        /// Index of the first byte that is not valid in UTF-8.
        byte: usize,
    },
    /// The system refused to read the file, or there is not enough memory for the content.
    #[error("cannot be read: {}", reason(.0))]
    Failed(#[from] io::Error),
}

/// Returns the message of the system, but plain words if the file does not exist.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string(),
    }
}

/// Opens a regular file for reading. Returns an error at once for a pipe, a terminal or another
/// device.
pub fn open_regular(path: &Path) -> Result<File, ReadError> {
    // Opening a device can have effects on it, and opening a pipe wakes its writer. Therefore the
    // kind of the file is checked before it is opened.
    check_regular(&path.metadata()?)?;
    let mut options = OpenOptions::new();
    options.read(true);
    // `NONBLOCK`: opening and reading return at once, even for files such as `/proc/kmsg`, which
    // the system wrongly reports as regular. `NOCTTY`: a terminal does not become the controlling
    // terminal of the process.
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags((OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed());
    }
    let file = options.open(path)?;
    // Another file may have got this name between the check and the opening, so the kind is checked
    // again.
    check_regular(&file.metadata()?)?;
    Ok(file)
}

/// Reads a regular file. Returns an error if the file has more than `limit` bytes.
pub fn read_regular(path: &Path, limit: usize) -> Result<Vec<u8>, ReadError> {
    let file = open_regular(path)?;
    // A file that is too long is refused before it is read. `read_limited` also refuses a file that
    // grows too long while it is read.
    if file.metadata()?.len() > limit as u64 {
        Err(ReadError::TooLong { limit })
    } else {
        read_limited(file, limit)
    }
}

/// Reads a regular file as text in UTF-8. Returns an error if the file has more than `limit` bytes.
pub fn read_regular_text(path: &Path, limit: usize) -> Result<String, ReadError> {
    into_text(read_regular(path, limit)?)
}

/// Reads a stream, such as standard input, to its end. Returns an error if the stream has more than
/// `limit` bytes.
pub fn read_limited(source: impl Read, limit: usize) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    // Reading one byte beyond the limit shows whether the stream is longer than the limit.
    source.take(limit as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > limit {
        Err(ReadError::TooLong { limit })
    } else {
        Ok(bytes)
    }
}

/// Converts bytes in UTF-8 to a text, without copying the bytes. Returns an error if the bytes are
/// not valid UTF-8.
pub fn into_text(bytes: Vec<u8>) -> Result<String, ReadError> {
    String::from_utf8(bytes).map_err(|error| ReadError::NotText {
        byte: error.utf8_error().valid_up_to(),
    })
}

fn check_regular(found: &std::fs::Metadata) -> Result<(), ReadError> {
    if found.is_dir() {
        Err(ReadError::Folder)
    } else if found.is_file() {
        Ok(())
    } else {
        Err(ReadError::NotRegular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_the_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text");
        std::fs::write(&path, "12345").unwrap();
        assert_eq!(read_regular(&path, 5).unwrap(), b"12345");
        assert_eq!(read_regular_text(&path, 6).unwrap(), "12345");
        assert!(matches!(
            read_regular(&path, 4),
            Err(ReadError::TooLong { limit: 4 })
        ));
        std::fs::write(&path, b"a\xff").unwrap();
        assert!(matches!(
            read_regular_text(&path, 5),
            Err(ReadError::NotText { byte: 1 })
        ));
        assert!(matches!(
            read_regular(folder.path(), 5),
            Err(ReadError::Folder)
        ));
        let none = read_regular(&folder.path().join("none"), 5).unwrap_err();
        assert_eq!(none.to_string(), "cannot be read: there is no such file");
    }

    #[test]
    fn a_source_without_an_end_is_not_read_further_than_the_limit() {
        struct Endless(usize);
        impl Read for Endless {
            fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
                self.0 += buffer.len();
                Ok(buffer.len())
            }
        }
        let mut endless = Endless(0);
        assert!(matches!(
            read_limited(&mut endless, 1000),
            Err(ReadError::TooLong { limit: 1000 })
        ));
        assert_eq!(endless.0, 1001);
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_regular_file_is_refused_at_once() {
        use rustix::fs::{CWD, FileType, Mode, mknodat};
        use std::os::unix::net::UnixListener;
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::from_raw_mode(0o600), 0).unwrap();
        let link = folder.path().join("link");
        std::os::unix::fs::symlink(&pipe, &link).unwrap();
        let socket = folder.path().join("socket");
        let _listener = UnixListener::bind(&socket).unwrap();
        for path in [
            &pipe,
            &link,
            &socket,
            Path::new("/dev/zero"),
            Path::new("/dev/null"),
        ] {
            let read = read_regular(path, 5);
            assert!(
                matches!(read, Err(ReadError::NotRegular)),
                "{}: {read:?}",
                path.display()
            );
        }
    }
}
