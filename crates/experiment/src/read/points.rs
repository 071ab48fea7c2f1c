//! The points of a curve in SI units, collected from the rows of a file.

use crate::error::ExperimentError;
use crate::read::columns::{Choice, Pair, Stated};
use crate::read::names::{DISPLACEMENT, FORCE, QUANTITIES, is_pause};
use crate::read::options::CurveOptions;
use asperity_data::grouped;
use asperity_data::text_table::TextColumn;
use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};
use std::borrow::Cow;

/// Largest magnitude of a displacement in m, and of a force in N, that a file may contain.
const LARGEST: [f64; 2] = [1e3, 1e6];
/// Distance from the central nine tenths of all displacements, in units of the range of these nine
/// tenths. A few displacements beyond this distance count as errors of the file.
const WILD: f64 = 10.0;

/// Label that a file gives to the points of one part of the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Label {
    /// Index of the part of the file to which the point belongs. A new part begins where the name
    /// of the segment changes in the file.
    pub part: usize,
    /// True if the instrument pauses in this part, according to the name of the part.
    pub is_pause: bool,
}

impl Label {
    /// Creates the label of an approach or a retraction.
    pub fn of_part(part: usize) -> Label {
        Label {
            part,
            is_pause: false,
        }
    }
}

/// Columns of a file in SI units, without the points at which a value is missing.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub displacement: Vec<f64>,
    pub force: Vec<f64>,
    /// Label of the segment of each point; empty if the file has no names of segments.
    pub labels: Vec<Label>,
    /// Time of each point in s; empty without a column of the time.
    pub seconds: Vec<f64>,
    /// True if approach and retraction were in separate columns of the file.
    pub is_beside: bool,
    /// Number of points left out because a value is missing.
    pub missing: usize,
    /// Stiffness of the instrument in N/m as the file states it, with its name in the file.
    pub stiffness: Option<(String, f64)>,
    /// Name of the column of displacements if these are displacements of the body, without the
    /// deflection of the instrument; otherwise `None`.
    pub of_body: Option<String>,
    /// Text for the report that describes the chosen columns and their units.
    pub assumed: String,
    /// Sentences for the report about names and units in the file that the options replace.
    pub statements: Vec<String>,
    /// Number of points left out because they are equal to the previous point.
    repeated: usize,
    /// Place of the first repeated point.
    first_repeated: Option<Place>,
    /// For each point, the number of its line, or its number among the points of the file.
    places: Vec<usize>,
}

impl Columns {
    /// Creates columns from displacements in m and forces in N. A point with a value that is not
    /// finite is left out. `seconds` are the times of the points in s; empty if they are not known.
    ///
    /// # Errors
    /// Returns an error if the slices differ in length, if a value is larger than an instrument
    /// could measure, or if a few displacements are far from all others.
    pub fn of_arrays(
        displacement: &[f64],
        force: &[f64],
        seconds: &[f64],
    ) -> Result<Self, ExperimentError> {
        if displacement.len() != force.len() {
            let found = format!(
                "{} displacements and {} forces",
                displacement.len(),
                force.len()
            );
            return crate::error::refused(found, "one force for each displacement");
        }
        let has_time = !seconds.is_empty();
        if has_time && seconds.len() != force.len() {
            let found = format!("{} forces and {} times", force.len(), seconds.len());
            return crate::error::refused(found, "one time for each force");
        }
        let assumed = if has_time {
            "displacements in m, forces in N, times in s"
        } else {
            "displacements in m, forces in N"
        };
        let mut columns = Columns {
            assumed: assumed.to_owned(),
            ..Columns::default()
        };
        let pair = Pair {
            places: [0, 1],
            units: [1.0; 2],
        };
        for (index, (displacement, force)) in displacement.iter().zip(force).enumerate() {
            let is_added = columns.push([*displacement, *force], &pair, Place::Point(index + 1))?;
            if is_added && has_time {
                columns.seconds.push(seconds[index]);
            }
        }
        columns.check_displacements(Place::Point)?;
        Ok(columns)
    }

    /// Returns phrases that state how many points were left out, and why; empty if no points were
    /// left out.
    pub fn left_out(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        if self.missing > 0 {
            let count = grouped(self.missing as u64);
            sentences.push(format!("{count} left out since a value is missing"));
        }
        if let Some(place) = &self.first_repeated {
            let count = grouped(self.repeated as u64);
            let place = place.to_string();
            let place = place.trim_end_matches([':', ' ']);
            sentences.push(format!(
                "{count} left out since they repeat the point before, first {place}"
            ));
        }
        sentences
    }

    /// Joins the points of an approach and of a retraction that were in separate columns of the
    /// file.
    pub fn joined(parts: Vec<Columns>) -> Columns {
        let mut parts = parts.into_iter();
        let mut joined = parts.next().unwrap_or_default();
        for part in parts {
            joined.append_retraction(part);
        }
        joined
    }

    /// Adds the points of a retraction after those of an approach. If the last point of the
    /// retraction is nearer to the end of the approach than the first point, the retraction is
    /// reversed.
    fn append_retraction(&mut self, mut retraction: Columns) {
        if let Some(turn) = self.displacement.last()
            && let Some(first) = retraction.displacement.first()
            && let Some(last) = retraction.displacement.last()
            && (last - turn).abs() < (first - turn).abs()
        {
            retraction.displacement.reverse();
            retraction.force.reverse();
            retraction.places.reverse();
        }
        self.labels = vec![Label::of_part(0); self.displacement.len()];
        let labels = vec![Label::of_part(1); retraction.displacement.len()];
        self.labels.extend(labels);
        self.displacement.extend(retraction.displacement);
        self.force.extend(retraction.force);
        self.places.extend(retraction.places);
        self.missing += retraction.missing;
        self.repeated += retraction.repeated;
        self.first_repeated = self.first_repeated.take().or(retraction.first_repeated);
        self.is_beside = true;
    }

    /// Adds a point with these values of displacement and force in the units of the file. A point
    /// is not added if a value is missing or if it is equal to the previous point. Returns true if
    /// the point was added.
    fn push(&mut self, values: [f64; 2], pair: &Pair, place: Place) -> Result<bool, SurfaceError> {
        if !values.iter().all(|value| value.is_finite()) {
            self.missing += 1;
            return Ok(false);
        }
        let displacement = in_si(values[DISPLACEMENT], pair.units[DISPLACEMENT]);
        let force = in_si(values[FORCE], pair.units[FORCE]);
        if self.displacement.last() == Some(&displacement) && self.force.last() == Some(&force) {
            self.repeated += 1;
            self.first_repeated.get_or_insert(place);
            return Ok(false);
        }
        check_magnitude(displacement, DISPLACEMENT, &place)?;
        check_magnitude(force, FORCE, &place)?;
        self.displacement.push(displacement);
        self.force.push(force);
        self.places.push(match place {
            Place::Line(number) | Place::Point(number) => number,
            _ => 0,
        });
        Ok(true)
    }

    /// Returns an error if a few displacements are far from all others. Such displacements are
    /// errors in the file. They must be refused because the segments are found from the range of
    /// all displacements. `place` converts the number of a line or of a point to its place in the
    /// file.
    pub fn check_displacements(&self, place: fn(usize) -> Place) -> Result<(), SurfaceError> {
        let mut sorted = self.displacement.clone();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let twentieth = count / 20;
        let (Some(&low), Some(&high)) = (
            sorted.get(twentieth),
            sorted.get((count - twentieth).max(1) - 1),
        ) else {
            return Ok(());
        };
        let room = WILD * (high - low);
        let is_wild =
            |displacement: &f64| *displacement < low - room || *displacement > high + room;
        let Some(first_wild) = self.displacement.iter().position(is_wild) else {
            return Ok(());
        };
        sorted.retain(|displacement| !is_wild(displacement));
        let wild_count = count - sorted.len();
        if room <= 0.0 || wild_count > (count / 50).max(1) {
            return Ok(());
        }
        let found = format!(
            "a displacement of {:e} m far from all others",
            self.displacement[first_wild]
        );
        let allowed = format!(
            "near those from {:e} m to {:e} m; NaN leaves a point out",
            sorted[0],
            sorted[sorted.len() - 1]
        );
        Err(refused(place(self.places[first_wild]), found, allowed))
    }
}

/// Returns a value in SI units. If 1/`unit` is a whole number, the value is divided by this number,
/// because a unit such as 1e-9 is itself rounded, and a multiplication would round twice.
fn in_si(value: f64, unit: f64) -> f64 {
    let divisor = (1.0 / unit).round();
    if (divisor * unit - 1.0).abs() < 1e-12 {
        value / divisor
    } else {
        value * unit
    }
}

/// Returns an error for a value that is larger than any value an instrument could measure.
fn check_magnitude(value: f64, quantity: usize, place: &Place) -> Result<(), SurfaceError> {
    let largest = LARGEST[quantity];
    if (-largest..=largest).contains(&value) {
        return Ok(());
    }
    let term = QUANTITIES[quantity].term;
    let unit = QUANTITIES[quantity].si_unit;
    let found = format!("a {term} of {value:e} {unit}");
    let allowed = format!("at most {largest:e} {unit} either way");
    Err(refused(place.clone(), found, allowed))
}

/// Collector that reads the chosen columns of each row of a file and adds them as points.
pub(crate) struct Rows {
    pub choice: Choice,
    /// One set of columns, or two sets if approach and retraction have separate columns in the
    /// file.
    pub parts: Vec<Columns>,
    label: Label,
    /// Name of the segment of the rows that are read now; empty before the first segment.
    name: String,
    /// Number of rows that have been read.
    count: usize,
}

impl Rows {
    pub fn new(
        columns: &[TextColumn],
        stated: Stated<'_>,
        options: &CurveOptions,
    ) -> Result<Self, SurfaceError> {
        let mut choice = Choice::new(columns, stated, options)?;
        let mut parts: Vec<_> = choice.pairs.iter().map(|_| Columns::default()).collect();
        parts[0].statements = std::mem::take(&mut choice.statements);
        parts[0].assumed = std::mem::take(&mut choice.assumed);
        parts[0].of_body = choice.of_body.take();
        parts[0].stiffness.clone_from(&stated.metadata.stiffness);
        Ok(Rows {
            choice,
            parts,
            label: Label::default(),
            name: String::new(),
            count: 0,
        })
    }

    /// Begins another segment if `name` differs from the name of the present segment.
    pub fn begin_segment(&mut self, name: &str) {
        if self.name != name {
            self.label = Label {
                part: self.label.part + 1,
                is_pause: is_pause(name),
            };
            name.clone_into(&mut self.name);
        }
    }

    /// Adds the points of a row. `value` returns the number in a column, or NaN if the number is
    /// missing. `text` returns the text of a cell.
    ///
    /// # Errors
    /// Returns an error if a number of the row cannot be read, or is larger than an instrument
    /// could measure.
    pub fn take<'a>(
        &mut self,
        place: &Place,
        mut value: impl FnMut(usize) -> Result<f64, SurfaceError>,
        text: impl Fn(usize) -> Cow<'a, str>,
    ) -> Result<(), SurfaceError> {
        if let Some(column) = self.choice.segment {
            self.begin_segment(&text(column));
        }
        let is_beside = self.parts.len() > 1;
        let is_labelled = !self.name.is_empty();
        for (part, pair) in self.parts.iter_mut().zip(&self.choice.pairs) {
            let force = value(pair.places[FORCE])?;
            // Without a column of displacements, the number of the row replaces the displacement.
            let displacement = match self.choice.ramp {
                Some(_) => self.count as f64,
                None => value(pair.places[DISPLACEMENT])?,
            };
            // If approach and retraction have separate columns, one of them may have fewer rows
            // than the other. The cells of its other rows are empty.
            if is_beside && pair.places.iter().all(|place| text(*place).is_empty()) {
                continue;
            }
            let is_added = part.push([displacement, force], pair, place.clone())?;
            if is_added && is_labelled {
                part.labels.push(self.label);
            }
            if is_added && let Some(time) = self.choice.time {
                // A cell without a number has no time, but the curve can still be read.
                let seconds = value(time.place).unwrap_or(f64::NAN);
                part.seconds.push(in_si(seconds, time.unit));
            }
        }
        self.count += 1;
        Ok(())
    }

    /// Returns the columns of all rows.
    pub fn finished(mut self) -> Vec<Columns> {
        if let Some(ramp) = self.choice.ramp {
            self.spread_over_ramp(ramp);
        }
        self.parts
    }

    /// Sets the displacements in a file with forces only. The first half of the points is evenly
    /// spaced over the travel `ramp` of the piezo in m, and the second half is evenly spaced on the
    /// way back.
    fn spread_over_ramp(&mut self, ramp: f64) {
        let Some(columns) = self.parts.first_mut() else {
            return;
        };
        let half = 0.5 * self.count as f64;
        let unit = self.choice.pairs[0].units[DISPLACEMENT];
        columns.labels = Vec::with_capacity(columns.displacement.len());
        for displacement in &mut columns.displacement {
            let row = (*displacement / unit).round();
            let is_retraction = row >= half;
            let steps = if is_retraction {
                2.0 * half - 1.0 - row
            } else {
                row
            };
            *displacement = ramp * steps / (half - 1.0);
            columns
                .labels
                .push(Label::of_part(usize::from(is_retraction)));
        }
        columns.is_beside = true;
    }
}
