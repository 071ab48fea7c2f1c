//! Reader of force curves from binary waves, as microscopes of Asylum Research write them. A binary
//! wave is an array file of the program Igor. It has a column for each quantity, and a note with
//! the properties of the cantilever.

use crate::read::columns::Stated;
use crate::read::metadata::Metadata;
use crate::read::options::CurveOptions;
use crate::read::points::{Columns, Rows};
use asperity_data::shown;
use asperity_data::text_table::TextColumn;
use asperity_surface::files::{IgorWave, refused};
use asperity_surface::{Place, SurfaceError};

/// Largest allowed number of columns in a wave.
const MOST_COLUMNS: usize = 64;

/// Reads the columns of a curve from the content of a binary wave (an array file of Igor).
pub(crate) fn of_wave(bytes: &[u8], options: &CurveOptions) -> Result<Vec<Columns>, SurfaceError> {
    let wave = IgorWave::parse(bytes)?;
    let [points, names, ..] = &wave.dimensions;
    let columns = columns(&wave)?;
    let mut metadata = Metadata::default();
    for line in wave.note.split(['\r', '\n']) {
        metadata.take(line);
    }
    let mut values = Vec::with_capacity(names.count);
    for column in 0..names.count {
        values.push(wave.numbers(column * points.count, points.count)?);
    }
    let stated = Stated {
        metadata: &metadata,
        is_si: false,
    };
    let mut rows = Rows::new(&columns, stated, options)?;
    let segments = Segments::of(&wave);
    for row in 0..points.count {
        if let Some(name) = segments.as_ref().and_then(|segments| segments.name(row)) {
            rows.begin_segment(name);
        }
        let cells: Vec<f64> = values.iter().map(|column| column[row]).collect();
        rows.take(
            &Place::Point(row + 1),
            |column| Ok(cells[column]),
            |column| cells[column].to_string().into(),
        )?;
    }
    Ok(rows.finished())
}

/// Returns the columns with their names. Every column has the unit that the wave states. Returns an
/// error if the wave is not a table with named columns.
fn columns(wave: &IgorWave<'_>) -> Result<Vec<TextColumn>, SurfaceError> {
    let [points, names, layers, _] = &wave.dimensions;
    let is_table = (2..=MOST_COLUMNS).contains(&names.count) && layers.count == 0;
    if !is_table || names.labels.len() < names.count {
        let found = format!(
            "a wave of {} times {} times {} numbers with {} names of columns",
            points.count,
            names.count,
            layers.count,
            names.labels.len()
        );
        let allowed = "a wave with a named column for each quantity, such as Defl and ZSnsr";
        return Err(refused(Place::File, found, allowed));
    }
    let unit = (!wave.unit.is_empty()).then(|| shown(&wave.unit));
    let columns = names.labels.iter().take(names.count);
    Ok(columns
        .map(|name| TextColumn {
            name: name.clone(),
            unit: unit.clone(),
            ..TextColumn::default()
        })
        .collect())
}

/// Segments of the curve that the note of a wave states. Each has the index of its last point and
/// its direction.
struct Segments(Vec<Segment>);

struct Segment {
    end: usize,
    name: &'static str,
}

impl Segments {
    /// Returns the segments from two lists in the note: the indices of the last points, and the
    /// directions. The first element of each list belongs to the beginning of the curve and is
    /// skipped. Returns `None` if a list is missing or if the lists do not fit together.
    fn of(wave: &IgorWave<'_>) -> Option<Self> {
        let list = |key: &str| {
            let text = wave.entry(key)?;
            Some(text.trim_matches(',').split(',').map(str::trim).skip(1))
        };
        let mut segments = Vec::new();
        for (end, direction) in list("Indexes")?.zip(list("Direction")?) {
            let name = match direction.parse::<f64>().ok()? {
                1.0 => "approach",
                -1.0 => "retraction",
                0.0 => "pause",
                _ => return None,
            };
            let end = end.parse::<f64>().ok()? as usize;
            segments.push(Segment { end, name });
        }
        let ascends = segments.is_sorted_by(|segment, next| segment.end < next.end);
        (ascends && !segments.is_empty()).then_some(Segments(segments))
    }

    /// Returns the name of the segment to which the point `row` belongs. Points after the end of
    /// the last segment belong to the last segment.
    fn name(&self, row: usize) -> Option<&'static str> {
        let segment = self.0.iter().find(|segment| row <= segment.end);
        segment.or(self.0.last()).map(|segment| segment.name)
    }
}

#[cfg(test)]
mod tests {
    use crate::common::{from_bytes, lines, of_spring};
    use crate::read::options::CurveOptions;
    use crate::read::tests::assert_same;
    use asperity_surface::files::is_igor_wave;

    /// Returns the content of a binary wave of version 5 with these columns and this note. The
    /// values are stored column by column.
    fn wave(names: &[&str], values: &[Vec<f64>], note: &str) -> Vec<u8> {
        let points = values[0].len();
        let mut header = vec![0; 384];
        let mut put = |offset: usize, bytes: &[u8]| {
            header[offset..offset + bytes.len()].copy_from_slice(bytes);
        };
        put(0, &5_u16.to_le_bytes());
        put(12, &(note.len() as u32).to_le_bytes());
        put(40, &(32 * (names.len() as u32 + 1)).to_le_bytes());
        put(76, &((points * values.len()) as u32).to_le_bytes());
        put(80, &4_u16.to_le_bytes());
        put(132, &(points as u32).to_le_bytes());
        put(136, &(values.len() as u32).to_le_bytes());
        put(212, b"m");
        let sum = header
            .chunks_exact(2)
            .map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
            .fold(0, u16::wrapping_add);
        header[2..4].copy_from_slice(&sum.wrapping_neg().to_le_bytes());
        let numbers: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|z| z.to_le_bytes())
            .collect();
        let mut labels = vec![0; 32];
        for name in names {
            labels.extend(name.as_bytes());
            labels.resize(labels.len().next_multiple_of(32), 0);
        }
        [&header[..], &numbers, note.as_bytes(), &labels].concat()
    }

    /// Returns a binary wave with the curve of a spring. Its columns are raw positions, deflections
    /// of a cantilever of 4 N/m, and positions, all in m.
    fn curve(note: &str) -> Vec<u8> {
        let points = of_spring(600);
        let positions: Vec<f64> = points.iter().map(|(d, _)| 1e-9 * d).collect();
        let deflections = points.iter().map(|(_, f)| 1e-9 * f / 4.0).collect();
        let raw = vec![0.5; points.len()];
        wave(
            &["Raw", "Defl", "ZSnsr"],
            &[raw, deflections, positions],
            note,
        )
    }

    #[test]
    fn a_wave_of_asylum_is_the_curve() {
        let plain = CurveOptions::default();
        let expected = from_bytes(lines(of_spring(600)).as_bytes(), &plain).unwrap();
        let note = "SpringConstant: 4\rInvOLS: 1e-07\rImagingMode:Contact";
        let bytes = curve(note);
        assert!(is_igor_wave(&bytes));
        let found = from_bytes(&bytes, &plain).unwrap();
        assert_same(&found, &expected, note);
        assert_eq!(
            found.stiffness.as_ref().map(|(_, stiffness)| *stiffness),
            Some(4.0)
        );
        // Here the note states the indices and the directions of the segments.
        let segments = format!("{note}\rIndexes: 0,299,599,\rDirection: NaN,1,-1,");
        let found = from_bytes(&curve(&segments), &plain).unwrap();
        assert_eq!(
            (found.segment[299], found.segment[300], found.segment[599]),
            (0, 1, 1)
        );
        let error = from_bytes(&curve("InvOLS: 1e-07"), &plain).unwrap_err();
        assert!(
            error.starts_with("the force is a deflection in m, and the file states no stiffness"),
            "{error}"
        );
    }

    #[test]
    fn other_waves_are_refused() {
        let map = wave(&[], &vec![vec![0.0; 40]; 40], "");
        let error = from_bytes(&map, &CurveOptions::default()).unwrap_err();
        assert!(
            error.starts_with("a wave of 40 times 40 times 0 numbers with 0 names"),
            "{error}"
        );
        let bytes = curve("SpringConstant: 4");
        for end in (0..bytes.len()).step_by(97) {
            assert!(
                from_bytes(&bytes[..end], &CurveOptions::default()).is_err(),
                "{end}"
            );
        }
    }
}
