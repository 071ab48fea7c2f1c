//! Recognition of the format of a file by its first bytes, and choice of the reader for this
//! format.

use super::archive::{Archive, ZIP};
use super::bytes::{MOST_BYTES, MOST_EXPANSION, most_expanded};
use super::channel::Wanted;
use super::container::{self, Measurement};
use super::options::ReadOptions;
use super::reading::Reading;
use super::surface::Topography;
use super::{
    foreign, gsf, gwy, ibw, igor, nanoscope, netcdf, npy, sdf, sur, text, tiff, tiff_maker, vk,
    x3p, zygo,
};
use crate::error::{Place, SurfaceError, refused};
use asperity_data::{Note, ReadError, Remedy, read_limited, read_regular};
use flate2::read::MultiGzDecoder;
use std::borrow::Cow;
use std::path::Path;

/// First bytes of a file that is compressed by gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// A binary format that is recognised by its first bytes.
struct BinaryFormat {
    signature: &'static [u8],
    reader: Reader,
}

enum Reader {
    /// Reader of a format in which a file has a single surface without a name.
    Single(fn(&[u8]) -> Result<Reading, SurfaceError>),
    /// Reader of a format in which a file may have several channels. The second argument chooses a
    /// channel.
    Channels(fn(&[u8], Wanted<'_>) -> Result<Reading, SurfaceError>),
}

impl Reader {
    fn read(&self, bytes: &[u8], options: &ReadOptions) -> Result<Reading, SurfaceError> {
        match self {
            Reader::Single(read) => {
                check_unnamed(options)?;
                read(bytes)
            }
            Reader::Channels(read) => read(bytes, Wanted::new(options)?),
        }
    }
}

const fn single(
    signature: &'static [u8],
    read: fn(&[u8]) -> Result<Reading, SurfaceError>,
) -> BinaryFormat {
    let reader = Reader::Single(read);
    BinaryFormat { signature, reader }
}

const fn with_channels(
    signature: &'static [u8],
    read: fn(&[u8], Wanted<'_>) -> Result<Reading, SurfaceError>,
) -> BinaryFormat {
    let reader = Reader::Channels(read);
    BinaryFormat { signature, reader }
}

/// Binary formats with their first bytes. Any other file is read as SDF, a binary wave of Igor, an
/// archive or a text.
const BINARY_FORMATS: [BinaryFormat; 15] = [
    single(asperity_data::SIGNATURE, npy::read),
    single(gsf::SIGNATURE, gsf::read),
    single(netcdf::SIGNATURE, netcdf::read),
    with_channels(gwy::SIGNATURE, gwy::read),
    with_channels(nanoscope::SIGNATURE, nanoscope::read),
    with_channels(nanoscope::SIGNATURE_OF_ELECTROCHEMISTRY, nanoscope::read),
    single(sur::PLAIN, sur::read),
    single(sur::COMPRESSED, sur::read),
    with_channels(tiff::SIGNATURES[0], tiff_maker::read),
    with_channels(tiff::SIGNATURES[1], tiff_maker::read),
    with_channels(vk::SIGNATURES[0], vk::read),
    with_channels(vk::SIGNATURES[1], vk::read),
    single(zygo::SIGNATURES[0], zygo::read),
    single(zygo::SIGNATURES[1], zygo::read),
    single(zygo::SIGNATURES[2], zygo::read),
];

/// Reads a measured surface from a regular file of at most 1 GiB. If the file is an archive with
/// several measurements of a surface, all measurements are read.
///
/// # Errors
/// Returns [`SurfaceError`] if the file cannot be read or holds no surface.
///
/// ```
/// use asperity_surface::{Cut, ReadOptions, read};
///
/// let file = tempfile::NamedTempFile::new()?;
/// std::fs::write(file.path(), "1 2 3 2\n4 5 6 5\n7 8 9 8\n")?;
/// let (unit, spacing, cut) = (Some("nm".parse()?), Some(1e-6), Some(Cut::Row(2)));
/// let options = ReadOptions { unit, spacing, cut, ..ReadOptions::default() };
/// assert_eq!(read(file.path(), &options)?[0].heights, [4e-9, 5e-9, 6e-9, 5e-9]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(path: &Path, options: &ReadOptions) -> Result<Vec<Topography>, SurfaceError> {
    parse_all(&content(path)?, options)
}

/// Reads a regular file of at most 1 GiB, and returns its bytes without change.
///
/// # Errors
/// Returns an error if the file cannot be read or is larger than 1 GiB.
pub fn content(path: &Path) -> Result<Vec<u8>, SurfaceError> {
    Ok(read_regular(path, MOST_BYTES)?)
}

/// Parses the content of a file that has a single measurement, and returns its surface.
///
/// # Errors
/// Returns the errors of [`read`], and an error for a file with several measurements.
///
/// ```
/// use asperity_surface::{ReadOptions, parse};
///
/// let profile = parse(b"x [mm],z [um]\n0.0,1.5\n0.1,2.5\n0.2,1.0\n", &ReadOptions::default())?;
/// assert_eq!(profile.heights, [1.5e-6, 2.5e-6, 1.0e-6]);
/// assert!(parse(b"0,1.5\n0.1,2.5\n", &ReadOptions::default()).is_err(), "no unit is stated");
/// # Ok::<(), asperity_surface::SurfaceError>(())
/// ```
pub fn parse(bytes: &[u8], options: &ReadOptions) -> Result<Topography, SurfaceError> {
    let mut surfaces = parse_all(bytes, options)?;
    if surfaces.len() == 1 {
        return Ok(surfaces.swap_remove(0));
    }
    let found = format!("{} measurements of a surface", surfaces.len());
    Err(refused(Place::File, found, "one").with(Remedy::SurfaceName))
}

/// Parses the content of a file and returns its surface. If the file is an archive with several
/// measurements of one surface, all measurements are returned.
///
/// # Errors
/// Returns [`SurfaceError`] if the file holds no surface, or if the options do not fit the file.
pub fn parse_all(bytes: &[u8], options: &ReadOptions) -> Result<Vec<Topography>, SurfaceError> {
    if bytes.starts_with(ZIP) {
        return parse_archive(bytes, options);
    }
    let surface = reading(bytes, options)?.resolve_part(options)?;
    Ok(vec![surface])
}

/// Reads a surface from an archive, which is a container of contact.engineering or X3P.
fn parse_archive(bytes: &[u8], options: &ReadOptions) -> Result<Vec<Topography>, SurfaceError> {
    let mut archive = Archive::new(bytes)?;
    let [in_json, in_yaml] = container::INDICES;
    let indices = [x3p::INDEX, in_json, in_yaml];
    let Some(index) = archive.index(&indices)? else {
        return Err(foreign::archive(archive.names(), indices));
    };
    if index == x3p::INDEX {
        check_unnamed(options)?;
        let surface = x3p::read(archive)?.resolve_part(options)?;
        return Ok(vec![surface]);
    }
    let content = archive.unpacked(index, container::LONGEST_INDEX)?;
    let measurements = container::measurements(index, &content, options.surface_name.as_deref())?;
    parse_measurements(archive, measurements, options)
}

/// Reads the measurements of a surface in a container. A measurement that cannot be read is left
/// out with a warning. Returns an error if no measurement can be read.
fn parse_measurements(
    mut archive: Archive<'_>,
    measurements: Vec<Measurement>,
    options: &ReadOptions,
) -> Result<Vec<Topography>, SurfaceError> {
    let mut surfaces = Vec::new();
    let mut unreadable = Vec::new();
    for measurement in measurements {
        let options = measurement.options(options)?;
        let within = |error: SurfaceError| {
            error.within(|place| Place::Measurement(measurement.name.clone(), place))
        };
        let content = archive.unpacked(measurement.file()?, MOST_BYTES)?;
        let reading = match reading(&content, &options).map_err(within) {
            Ok(reading) => measurement.completed(reading),
            Err(error @ SurfaceError::OutOfMemory { .. }) => return Err(error),
            Err(error) => {
                unreadable.push(error);
                continue;
            }
        };
        // If a unit, a distance or heights are missing, an error is returned and the measurement is
        // not left out, because the user can supply them by an option.
        let mut surface = reading.resolve_part(&options).map_err(within)?;
        surface.warnings.extend(measurement.tip_radius());
        surface.detrend = measurement.detrend();
        surface.periodic |= measurement.is_periodic;
        surface.name = measurement.name;
        surfaces.push(surface);
    }
    let Some(first) = surfaces.first_mut() else {
        return Err(unreadable.swap_remove(0));
    };
    for error in unreadable {
        let warning = format!("another measurement is left out: {error}");
        first.warnings.push(Note::new(warning));
    }
    Ok(surfaces)
}

/// Reads the heights and distances of a file with one surface.
fn reading(bytes: &[u8], options: &ReadOptions) -> Result<Reading, SurfaceError> {
    let content = unpacked(bytes)?;
    if content.starts_with(ZIP) {
        check_unnamed(options)?;
        let mut archive = Archive::new(&content)?;
        archive.index(&[x3p::INDEX])?;
        return x3p::read(archive);
    }
    if sdf::is_sdf(&content) {
        check_unnamed(options)?;
        return sdf::read(&content);
    }
    if igor::is_igor_wave(&content) {
        return ibw::read(&content, Wanted::new(options)?);
    }
    foreign::check(&content)?;
    for format in &BINARY_FORMATS {
        if content.starts_with(format.signature) {
            return format.reader.read(&content, options);
        }
    }
    igor::check_sum(&content)?;
    text::read(&content, Wanted::new(options)?)
}

/// Returns an error if the options name a channel, for a format whose surface has no name.
fn check_unnamed(options: &ReadOptions) -> Result<(), SurfaceError> {
    if options.surface_name.is_none() {
        return Ok(());
    }
    let found = "a file of one surface, without a name";
    let allowed = "a file of several channels or surfaces, or no name of one";
    Err(refused(Place::File, found, allowed).with(Remedy::NoSurfaceName))
}

/// Returns the bytes of a file. If the file is compressed by gzip, the bytes are decompressed.
///
/// # Errors
/// Returns an error if the compressed bytes are damaged or expand to too many bytes.
pub fn unpacked(bytes: &[u8]) -> Result<Cow<'_, [u8]>, SurfaceError> {
    if !bytes.starts_with(&GZIP) {
        return Ok(bytes.into());
    }
    let most = most_expanded(bytes.len());
    let content = match read_limited(MultiGzDecoder::new(bytes), most.min(MOST_BYTES)) {
        Ok(content) => content,
        Err(ReadError::TooLong { .. }) if most <= MOST_BYTES => {
            let found = format!("gzip expands to more than {MOST_EXPANSION} times its size");
            return Err(refused(Place::File, found, "at most that and 1 MiB"));
        }
        Err(error) => return Err(error.into()),
    };
    if content.starts_with(&GZIP) {
        return Err(refused(Place::Byte(0), "gzip within gzip", "gzip once"));
    }
    Ok(content.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::cut::Cut;
    use crate::topography::unit::Unit;
    use asperity_data::Remedied;
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::fmt::Write as _;
    use std::io::Write;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn metres() -> ReadOptions {
        ReadOptions {
            unit: Some(Unit::METRE),
            ..ReadOptions::default()
        }
    }

    /// Returns the file `name` of the seeds for fuzzing, in which the first occurrence of the bytes
    /// `from` is replaced by `to`.
    fn file(name: &str, from: &[u8], to: &[u8]) -> Vec<u8> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../fuzz/seeds/surface")
            .join(name);
        let content = std::fs::read(path).unwrap();
        let at = content
            .windows(from.len().max(1))
            .position(|found| found.starts_with(from))
            .unwrap();
        [&content[..at], to, &content[at + from.len()..]].concat()
    }

    /// Returns the options with which the seed `name` can be read if it lacks units or distances.
    fn bare(name: &str) -> ReadOptions {
        let has_no_unit = name.ends_with(".npy") || name == "no-data.xyz";
        let unit = has_no_unit.then_some(Unit::METRE);
        let height_unit = (name == "points.nc").then_some(Unit::METRE);
        let has_channels = name.ends_with(".jpk") || name.ends_with(".vk3");
        ReadOptions {
            unit,
            height_unit,
            spacing: Some(0.5),
            interpolate: true,
            channel: has_channels.then_some(0),
            ..ReadOptions::default()
        }
    }

    #[test]
    fn files_of_every_format_are_surfaces() {
        let mut found = String::new();
        let names = "binary.sdf text.sdf field.gsf map.npy columns.npy profile.npy linked.x3p listed.x3p map.gwy \
                     plain.sur compressed.sur map.nc points.nc heights.txt matrix.txt points.txt latin1.txt utf16.txt descending.csv \
                     map.spm points.x3p wyko.asc spip.asc layers.ibw big-endian.ibw version-2.ibw channels.jpk \
                     big-endian.jpk park.tiff park-1.tiff zygo.dat map.vk3 map.vk4 wsxm.xyz no-data.xyz nist.sdf";
        for name in names.split(' ') {
            let mut surface = parse(&file(name, b"", b""), &bare(name)).unwrap();
            surface.heights.truncate(12);
            writeln!(found, "{name}: {surface:?}").unwrap();
        }
        insta::assert_snapshot!(found);
    }

    #[test]
    fn headers_decide_on_units_rows_and_channels() {
        let read = |name: &str, from: &[u8], to: &[u8], options: &ReadOptions| {
            parse(&file(name, from, to), options).unwrap()
        };
        // The letter µ may be encoded in a code page of MS-DOS.
        let micrometres = read("plain.sur", b"um", b"\xe6m", &bare(""));
        assert_eq!(micrometres, read("plain.sur", b"", b"", &bare("")));
        // If the order of the dimensions is exchanged, rows along x become rows along y.
        let (along_x, along_y) = (
            &b"heights\0\0\0\0\x02\0\0\0\0\0\0\0\x01"[..],
            &b"heights\0\0\0\0\x02\0\0\0\x01\0\0\0\0"[..],
        );
        let (turned, straight) = (
            read("map.nc", b"", b"", &bare("")),
            read("map.nc", along_x, along_y, &bare("")),
        );
        assert_eq!((turned.columns, straight.columns), (6, 6));
        assert_eq!(
            (turned.heights[1], turned.heights[6]),
            (straight.heights[4], straight.heights[1])
        );
        // The program SurfaceTopography states in an attribute of x whether the surface is
        // periodic.
        assert!(!straight.periodic);
        let stated = |number: u8| {
            let mut attribute = b"9Q\xb7\x17\0\0\0\x08periodic\0\0\0\x04\0\0\0\x01\0\0\0".to_vec();
            attribute.push(number);
            attribute
        };
        let plain = stated(0);
        let periodic = stated(1);
        assert!(!read("map.nc", &plain, &plain, &bare("")).periodic);
        assert!(read("map.nc", &plain, &periodic, &bare("")).periodic);
        // The axes of a map and its heights may each have a unit of their own.
        let before =
            b"9Q\xb7\x17\0\0\0\x08periodic\0\0\0\x04\0\0\0\x01\0\0\0\0\0\0\0\x04unit\0\0\0\x02\0\0\0";
        let (metre, nanometre) = (
            [&before[..], b"\x01m\0"].concat(),
            [&before[..], b"\x02nm"].concat(),
        );
        let [along, between] = straight.spacing().unwrap();
        let found = read("map.nc", &metre, &nanometre, &bare(""))
            .spacing()
            .unwrap();
        assert_eq!(
            (found[0] / along, (found[1] / between * 1e9).round()),
            (1.0, 1.0)
        );
        for (name, change) in [
            ("map.nc", (&b"unit"[..], &b"note"[..])),
            ("points.nc", (b"", b"")),
        ] {
            let error = parse(&file(name, change.0, change.1), &bare(""))
                .unwrap_err()
                .to_string();
            assert!(
                error.starts_with("no unit of heights is stated"),
                "{name}: {error}"
            );
        }
        let chosen = ReadOptions {
            channel: Some(0),
            ..bare("")
        };
        assert_eq!(
            read("map.gwy", b"", b"", &chosen),
            read("map.gwy", b"", b"", &bare(""))
        );
        let none = ReadOptions {
            channel: Some(4),
            ..bare("")
        };
        let error = parse(&file("map.gwy", b"", b""), &none)
            .unwrap_err()
            .to_string();
        assert_eq!(
            error,
            "no channel 4; channels: 0 \"Height\" in m; allowed: the number or the name of one"
        );
    }

    #[test]
    fn faults_have_a_place_and_the_allowed_content() {
        let mut errors = String::new();
        for (name, from, to) in [
            ("text.sdf", &b"9 1 2 3"[..], &b"9 1"[..]),
            ("text.sdf", b"9 1", b"9 1 4"),
            ("text.sdf", b"BAD", b"x"),
            ("text.sdf", b"NumPoints = 4", b"NumPoints = 2.5"),
            ("text.sdf", b"Zscale = 1e-9\n", b""),
            ("text.sdf", b"DataType = 5", b"DataType = 9"),
            ("text.sdf", b"*\n1", b"1"),
            ("binary.sdf", b"\xf0\xbf\0", b"\xf0\xbf\x01"),
            ("binary.sdf", b"\x04\0\x03", b"\x04\0\x04"),
            ("field.gsf", b"YRes = 3\n", b""),
            ("field.gsf", b"XRes = 4", b"XRes = -3"),
            ("field.gsf", b"XReal = 4e-6", b"XReal = wide"),
            ("field.gsf", b"ZUnits = m", b"ZUnits = V"),
            ("field.gsf", b"YRes = 3", b"YRes = 4294967296"),
            ("field.gsf", b"XRes = 4", b"XRes"),
            ("map.npy", b">i2", b"<c16"),
            ("map.npy", b"'>i2'", b"[('a', '<f8'), ('b', '<u8')]"),
            ("map.npy", b"'>i2'", b"[]"),
            ("map.npy", b"'>i2'", b"[('a')]"),
            (
                "map.npy",
                b";\0{'descr': '>i2'",
                b"D\0{'descr': [('a', '<f8')]",
            ),
            ("map.npy", b"fortran_order", b"order"),
            ("map.npy", b"(3, 4)", b"(3, 4, 1)"),
            ("map.npy", b"(3, 4)", b"(99999999999, 99999999999)"),
            ("columns.npy", b"?\0\0\0\0\0\0\xf0?", b"?\0\0\0\0\0\0\0\0"),
            ("map.gwy", b"m\0data", b"V\0data"),
            ("map.gwy", b"/0/data\0oG", b"/0/date\0oG"),
            ("map.gwy", b"xres\0i", b"xres\0z"),
            ("map.gwy", b"xres\0i\x04", b"xres\0i\x05"),
            ("plain.sur", b"\x02\0", b"\x05\0"),
            ("plain.sur", b"\x10\0", b"\x08\0"),
            ("plain.sur", b"\x04\0", b"\0\0"),
            ("plain.sur", b"\x03\0", b"\x09\0"),
            ("plain.sur", b"um", b"Vo"),
            ("compressed.sur", b"\x04\0\0\0\x03", b"\x04\0\0\x09\x03"),
            ("map.nc", b"CDF\x02", b"CDF\x05"),
            ("map.nc", b"heights", b"weights"),
            ("map.nc", b"x\0\0\0\0\0\0\x06", b"x\0\0\0\0\0\0\0"),
            ("map.nc", b"x\0\0\0\0\0\0\x06", b"x\0\0\0\xff\xff\xff\xff"),
            (
                "map.nc",
                b"s\0\0\0\0\x02\0\0\0\0",
                b"s\0\0\0\0\x02\0\0\0\x07",
            ),
            ("map.nc", b"?\x0a\x36", b"?\x0b\x36"),
        ] {
            let options = ReadOptions {
                interpolate: false,
                ..bare(name)
            };
            let error = parse(&file(name, from, to), &options)
                .unwrap_err()
                .to_string();
            assert!(error.contains("; allowed: "), "{error}");
            writeln!(errors, "{name}, {}: {error}", to.escape_ascii()).unwrap();
        }
        insta::assert_snapshot!(errors);
        // A file that is cut off is refused. The error states the offset at which bytes are
        // missing.
        for name in ["map.gwy", "map.nc", "compressed.sur", "binary.sdf"] {
            let whole = file(name, b"", b"");
            for end in 13..whole.len() {
                let error = parse(&whole[..end], &bare(name)).unwrap_err().to_string();
                assert!(error.starts_with("byte "), "{name}, {end}: {error}");
            }
        }
    }

    #[test]
    fn a_name_is_refused_where_surfaces_have_none() {
        let named = |name: &str| ReadOptions {
            surface_name: Some("Height".to_owned()),
            ..bare(name)
        };
        for name in [
            "text.sdf",
            "field.gsf",
            "map.npy",
            "listed.x3p",
            "plain.sur",
            "map.nc",
        ] {
            let error = parse(&file(name, b"", b""), &named(name)).unwrap_err();
            let error = error.to_string();
            assert!(
                error.starts_with("a file of one surface, without a name"),
                "{name}: {error}"
            );
        }
        assert!(parse(&file("map.gwy", b"", b""), &named("map.gwy")).is_ok());
        let both = ReadOptions {
            channel: Some(0),
            ..named("map.gwy")
        };
        let error = parse(&file("map.gwy", b"", b""), &both).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("channel 0 and channel \"Height\"; allowed: one")
        );
    }

    #[test]
    fn gzip_is_read_as_its_content() {
        let text = b"0 1\n1 2\n2 1\n";
        let plain = parse(text, &metres()).unwrap();
        assert_eq!(parse(&gzip(text), &metres()), Ok(plain.clone()));
        let members = [gzip(b"0 1\n1 2\n"), gzip(b"2 1\n")].concat();
        assert_eq!(parse(&members, &metres()), Ok(plain));
        let nested = parse(&gzip(&gzip(text)), &metres()).unwrap_err();
        assert_eq!(
            nested.to_string(),
            "byte 0: gzip within gzip; allowed: gzip once"
        );
        assert!(parse(&gzip(text)[..15], &metres()).is_err());
    }

    #[test]
    fn decompression_ends_at_a_multiple_of_the_file() {
        let bomb = gzip(&b"# 1\n".repeat(1 << 20));
        assert!(bomb.len() < 10_000);
        let error = parse(&bomb, &metres()).unwrap_err().to_string();
        assert_eq!(
            error,
            "gzip expands to more than 32 times its size; allowed: at most that and 1 MiB"
        );
    }

    #[test]
    fn folders_and_long_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile");
        let error = read(folder.path(), &metres()).unwrap_err().to_string();
        assert!(error.contains("this is a folder"), "{error}");
        // The file is sparse, so that it takes no space on the disk.
        std::fs::File::create(&path)
            .unwrap()
            .set_len(MOST_BYTES as u64 + 1)
            .unwrap();
        let error = read(&path, &metres()).unwrap_err().to_string();
        assert_eq!(
            error,
            "longer than 1073741824 bytes; allowed: at most 1073741824 bytes"
        );
    }

    #[test]
    fn units_and_distances_are_never_guessed() {
        let none = ReadOptions::default();
        let error = parse(b"0 1\n1 2\n", &none).unwrap_err();
        assert_eq!(
            error.to_string(),
            "no unit of heights is stated; allowed: a unit in the file or beside it"
        );
        assert_eq!(error.remedies(), [Remedy::Unit("um".to_owned())]);
        let error = parse(b"1\n2\n", &metres()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "text columns without a distance between points; allowed: a distance beside the file"
        );
        assert_eq!(error.remedies(), [Remedy::Spacing]);
        let error = parse(b"x [nm] z [nm]\n0 1\n1 2\n", &metres())
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("the file states nm as the unit of heights, the options state m"),
            "{error}"
        );
        let spaced = ReadOptions {
            spacing: Some(0.5),
            ..metres()
        };
        assert_eq!(parse(b"1\n2\n", &spaced).unwrap().spacing(), Ok([0.5; 2]));
    }

    #[test]
    fn missing_points_are_refused_or_filled() {
        let text = b"0 1\n1 bad\n2 3\n3 4\n";
        let error = parse(text, &metres()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "line 2: 1 of 4 points are missing (25.00 %), the first here; allowed: points that are filled from their neighbours"
        );
        assert_eq!(error.remedies(), [Remedy::Interpolate]);
        let options = ReadOptions {
            interpolate: true,
            ..metres()
        };
        let surface = parse(text, &options).unwrap();
        assert_eq!(
            (&surface.heights[..], surface.interpolated()),
            (&[1.0, 2.0, 3.0, 4.0][..], 1)
        );
    }

    #[test]
    fn a_row_needs_its_own_points_alone() {
        let read = |cut: Cut| {
            let options = ReadOptions {
                spacing: Some(1.0),
                cut: Some(cut),
                ..metres()
            };
            parse(b"1 2 3 4\n5 nan 6 7\n2 3 4 5\n", &options)
                .map(|surface| (surface.heights.clone(), surface.interpolated()))
        };
        assert_eq!(read(Cut::Row(1)).unwrap(), (vec![1.0, 2.0, 3.0, 4.0], 0));
        assert_eq!(read(Cut::Column(4)).unwrap(), (vec![4.0, 7.0, 5.0], 0));
        for cut in [Cut::Row(2), Cut::Column(2)] {
            let error = read(cut).unwrap_err().to_string();
            assert!(
                error.starts_with("line 2: 1 of 12 points are missing (8.33 %), the first here"),
                "{error}"
            );
        }
    }

    #[test]
    fn empty_rows_and_columns_at_the_border_are_left_out_and_counted() {
        let spaced = ReadOptions {
            spacing: Some(1.0),
            ..metres()
        };
        let read = |text: &str, cut: Option<Cut>| {
            parse(
                text.as_bytes(),
                &ReadOptions {
                    cut,
                    ..spaced.clone()
                },
            )
            .map_err(|error| error.to_string())
        };
        let map = "nan nan nan nan nan\nnan 1 2 3 nan\nnan 4 5 6 nan\nnan nan nan nan nan\nnan nan nan nan nan\n";
        let found = read(map, None).unwrap();
        assert_eq!(
            (found.columns, &found.heights[..]),
            (3, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0][..])
        );
        assert_eq!((found.cropped.counts(), found.interpolated()), ([2, 3], 0));
        // The row and the column are chosen by their numbers in the file.
        let (row, column) = (
            read(map, Some(Cut::Row(3))).unwrap(),
            read(map, Some(Cut::Column(2))).unwrap(),
        );
        assert_eq!(
            (row.heights, row.cropped.counts()),
            (vec![4.0, 5.0, 6.0], [2, 0])
        );
        assert_eq!(
            (column.heights, column.cropped.counts()),
            (vec![1.0, 4.0], [3, 0])
        );
        assert_eq!(
            read(map, Some(Cut::Row(1))).unwrap_err(),
            "row 1; allowed: rows 2 to 3"
        );
        let error = read(&map.replace('5', "nan"), None).unwrap_err();
        assert!(
            error.starts_with("point 13: 1 of 6 points are missing (16.67 %), the first here"),
            "{error}"
        );
        let profile = read("0 nan\n1 5\n2 6\n3 4\n4 nan\n", None).unwrap();
        assert_eq!(
            (profile.cropped.counts(), profile.into_profile()),
            ([2, 0], Ok((vec![1.0, 2.0, 3.0], vec![5.0, 6.0, 4.0])))
        );
        // A map with a single measured row does not become a profile.
        let error = read("nan nan nan nan\n1 2 3 4\nnan nan nan nan\n", None).unwrap_err();
        assert!(error.contains("8 of 12 points are missing"), "{error}");
    }
}
