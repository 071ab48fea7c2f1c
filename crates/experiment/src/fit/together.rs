//! Fit of several curves of one specimen together, such as curves at several speeds. The curves
//! share all parameters but the displacement at first touch and the force before contact.

use crate::curve::MeasuredCurve;
use crate::error::{ExperimentError, refused};
use crate::fit::evaluation::fit_result;
use crate::fit::further::{FurtherCurve, PartOfSearch};
use crate::fit::model::Model;
use crate::fit::parameter::{Free, Parameter};
use crate::fit::population::Member;
use crate::fit::relaxation::{notes_on_time, other_relaxations};
use crate::fit::result::FitResult;
use crate::fit::scene::{pause_of, wrong};
use crate::fit::search::{Search, SearchResult};
use crate::fit::searched::{compared_with_all, without_rest};
use crate::fit::space::Space;
use crate::fit::touch::{Touch, fixed_contact_point, touch_of_best};
use crate::fit::{EXTENSIONS, Fit};
use asperity_data::{Control, Note, counted, format_quantity, median};
use asperity_scene::{Document, Scene, Simulation};

/// Largest number of curves that are fitted together.
pub(crate) const MOST_TOGETHER: usize = 10;

/// A curve of the specimen, with what its computation needs.
struct Part<'a> {
    name: &'a str,
    curve: &'a MeasuredCurve,
    simulation: Simulation,
    touch: Option<Touch>,
}

/// The curves of one specimen, and the fit that they share.
struct Specimen<'a> {
    parts: Vec<Part<'a>>,
    given: &'a Document,
    free: &'a [Free],
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl Fit<'_> {
    /// Fits the free parameters to several curves of one specimen together, on one thread. The
    /// curves have the same values of all parameters except the offset and the zero, of which each
    /// curve has its own. With relaxation, the speed of each curve follows from the times of its
    /// points, or from the scene if the curve has no times.
    ///
    /// Returns a result for each curve, in which the shared parameters have the same values and
    /// intervals. The result of a single curve is that of [`Fit::run`].
    ///
    /// # Errors
    /// Returns an error with the name of the curve in the cases of [`Fit::run`], and an error if
    /// there is no curve or more than 10.
    pub fn run_together(
        &self,
        curves: &[(String, MeasuredCurve)],
        mut control: Control<'_>,
    ) -> Result<Vec<FitResult>, ExperimentError> {
        if let [(name, curve)] = curves {
            let result = self.run(curve, control);
            return Ok(vec![result.map_err(|error| in_curve(name, error))?]);
        }
        if curves.is_empty() || curves.len() > MOST_TOGETHER {
            let found = format!("{} fitted together", counted(curves.len() as u64, "curve"));
            return refused(
                found,
                format!("1 to {MOST_TOGETHER} curves of one specimen"),
            );
        }
        let stop = control.stop();
        let mut parts = Vec::with_capacity(curves.len());
        for (name, curve) in curves {
            let mut simulation = self.simulation();
            let touch = touch_of_best(curve, self.document, &self.free, &mut simulation, stop);
            parts.push(Part {
                name,
                curve,
                simulation,
                touch: touch.map_err(|error| in_curve(name, error))?,
            });
        }
        let mut specimen = Specimen {
            parts,
            given: self.document,
            free: &self.free,
            stop,
        };
        specimen.find(&mut |computed| control.report(computed as u64))
    }
}

fn in_curve(name: &str, error: ExperimentError) -> ExperimentError {
    ExperimentError::InCurve {
        name: name.to_owned(),
        error: Box::new(error),
    }
}

impl Specimen<'_> {
    /// Fits the parameters. `report` receives the number of force curves computed so far. Ranges
    /// are widened as in the fit of a single curve.
    fn find(&mut self, report: &mut dyn FnMut(usize)) -> Result<Vec<FitResult>, ExperimentError> {
        let touches = self.parts.iter().filter_map(|part| part.touch);
        let mut computed: usize = touches.map(|touch| touch.evaluations).sum();
        let mut ranges = self.free.to_vec();
        let mut extensions = 0;
        loop {
            let mut documents = Vec::with_capacity(self.parts.len());
            let mut spaces = Vec::with_capacity(self.parts.len());
            for part in &mut self.parts {
                let prepared = Space::of(
                    part.curve,
                    self.given,
                    &mut part.simulation,
                    &ranges,
                    self.stop,
                );
                let (document, mut space) = prepared.map_err(|error| in_curve(part.name, error))?;
                if let Some(touch) = part.touch {
                    space.base[Parameter::Offset as usize] = touch.displacement;
                }
                documents.push(document);
                spaces.push(space);
            }
            share_coordinates(&mut spaces);
            let mut with_rests = Vec::with_capacity(spaces.len());
            for (space, document) in spaces.iter().zip(&documents) {
                let rest = pause_of(document.scene());
                with_rests.push(space.curve.with_rest(rest).filter(|_| space.relaxes()));
            }
            let mut compared = spaces.clone();
            for (space, with_rest) in compared.iter_mut().zip(&with_rests) {
                space.curve = with_rest.as_ref().unwrap_or(space.curve);
            }
            let joint = Joint::of(&compared);
            let mut report_all = |evaluations: usize| report(computed + evaluations);
            let found = self.search(&joint, &compared, &documents, &mut report_all)?;
            computed += found.evaluations;
            let place = &found.result.best.place;
            if extensions < EXTENSIONS
                && let Some(wider) = joint.space.extended(place, self.free, &ranges)
            {
                ranges = wider;
                extensions += 1;
                continue;
            }
            return self.results(
                &joint,
                [&spaces, &compared],
                &documents,
                &found.result,
                computed,
            );
        }
    }

    /// Searches the parameters of all curves.
    fn search(
        &mut self,
        joint: &Joint<'_>,
        spaces: &[Space<'_>],
        documents: &[Document],
        report: &mut dyn FnMut(usize),
    ) -> Result<Found, ExperimentError> {
        let mut models = Vec::with_capacity(spaces.len());
        for ((part, space), document) in self.parts.iter_mut().zip(spaces).zip(documents) {
            let simulation = &mut part.simulation;
            models.push(Model::new(space.curve, document.scene(), simulation));
        }
        let mut models = models.into_iter();
        let Some(model) = models.next() else {
            return refused("no curve", "at least one curve");
        };
        let mut lines = joint.space.lines();
        let mut further = Vec::with_capacity(spaces.len() - 1);
        for (index, model) in models.enumerate() {
            let space = &spaces[index + 1];
            lines.push(space.lines());
            further.push(FurtherCurve {
                space,
                model,
                part: joint.parts[index + 1].clone(),
            });
        }
        let mut search = Search {
            space: &joint.space,
            model,
            lines,
            further,
            report,
        };
        let result = search.find()?;
        Ok(Found {
            result,
            evaluations: search.evaluations(),
        })
    }

    /// Returns the result of each curve. `spaces` are the spaces of the curves, first without and
    /// then with the points of rests.
    fn results(
        &mut self,
        joint: &Joint<'_>,
        spaces: [&[Space<'_>]; 2],
        documents: &[Document],
        found: &SearchResult,
        evaluations: usize,
    ) -> Result<Vec<FitResult>, ExperimentError> {
        let [of_motions, with_rests] = spaces;
        let note = self.note();
        let mut results = Vec::with_capacity(self.parts.len());
        for (index, part) in self.parts.iter_mut().enumerate() {
            let space = &with_rests[index];
            let document = &documents[index];
            let mut no_report = |_| {};
            let model = Model::new(space.curve, document.scene(), &mut part.simulation);
            let mut search = Search::of_curve(space, model, &mut no_report);
            let result = result_of(&joint.parts[index], found);
            let searched = compared_with_all(&mut search, result)?;
            let mut searched = without_rest(searched, space.curve);
            searched.evaluations = evaluations;
            let space = &of_motions[index];
            let mut result = fit_result(document, &mut part.simulation, space, searched)?;
            if let Some(touch) = part.touch {
                let note = fixed_contact_point(part.curve, touch.displacement);
                result.assumptions.push(note);
            }
            if space.relaxes() {
                let mut notes = notes_on_time(part.curve, self.given.scene());
                notes.extend(speed_of_scene(part.curve, document.scene()));
                result.assumptions.splice(..0, notes);
            }
            let (_, instrument) = part.curve.with_instrument(self.given).map_err(wrong)?;
            result.assumptions.splice(..0, instrument.map(Note::new));
            result.assumptions.insert(0, note.clone());
            results.push(result);
        }
        share_intervals(&mut results);
        Ok(results)
    }

    /// Returns a sentence on the parameters that the curves share.
    fn note(&self) -> Note {
        let mut symbols = Vec::new();
        for parameter in Parameter::ALL {
            let is_free = self.free.iter().any(|free| free.parameter == parameter);
            if is_free && !parameter.is_signed() {
                symbols.push(parameter.row().symbol);
            }
        }
        let symbols = symbols.join(", ");
        let count = self.parts.len();
        Note::new(format!(
            "{count} curves of one specimen together give {symbols}."
        ))
    }
}

/// Returns a sentence on the speed of a curve without times; `None` for a curve with times.
fn speed_of_scene(curve: &MeasuredCurve, scene: &Scene) -> Option<Note> {
    let speed = scene
        .loading_speed
        .filter(|_| curve.timing.speeds.is_none())?;
    let speed = format_quantity(speed, "m/s");
    Some(Note::new(format!(
        "Loading speed {speed} by the scene, since the file has no times."
    )))
}

/// Result of a search, and the number of force curves that it computed.
struct Found {
    result: SearchResult,
    evaluations: usize,
}

/// Coordinates of several curves: all coordinates of the first curve, and for each other curve the
/// coordinates that it does not share with the first one.
struct Joint<'a> {
    space: Space<'a>,
    parts: Vec<PartOfSearch>,
}

impl<'a> Joint<'a> {
    fn of(spaces: &[Space<'a>]) -> Self {
        let mut space = spaces[0].clone();
        let mut parts: Vec<PartOfSearch> = Vec::with_capacity(spaces.len());
        let mut first = 0;
        for (number, of_curve) in spaces.iter().enumerate() {
            let mut coordinates = Vec::with_capacity(of_curve.coordinates.len());
            for (index, coordinate) in of_curve.coordinates.iter().enumerate() {
                if number == 0 || !coordinate.parameter.is_signed() {
                    coordinates.push(index);
                } else {
                    coordinates.push(space.coordinates.len());
                    space.coordinates.push(*coordinate);
                }
            }
            let end = first + of_curve.curve.force.len();
            parts.push(PartOfSearch {
                coordinates,
                points: first..end,
            });
            first = end;
        }
        Joint { space, parts }
    }
}

/// Returns the result of a search for one of its curves alone. Its samples are those of the search
/// without the coordinates of other curves. All residuals and blocks stay, since all curves
/// determine the parameters.
fn result_of(part: &PartOfSearch, all: &SearchResult) -> SearchResult {
    SearchResult {
        best: Member {
            place: part.place(&all.best.place),
            residuals: all.best.residuals[part.points.clone()].to_vec(),
            in_contact: all.best.in_contact[part.points.clone()].to_vec(),
        },
        residuals: all.residuals.clone(),
        noise: all.noise,
        samples: part.places(&all.samples),
        alternatives: part.places(&all.alternatives),
        blocks: all.blocks.clone(),
        without_adhesion: all.without_adhesion,
    }
}

/// Gives the shared coordinates of several spaces one range, which contains all of their ranges,
/// and one start, the median of their starts.
fn share_coordinates(spaces: &mut [Space<'_>]) {
    let mut seconds: Option<f64> = None;
    for space in spaces.iter() {
        let longest = seconds.unwrap_or(0.0);
        seconds = space
            .seconds_in_contact
            .map(|own| own.max(longest))
            .or(seconds);
    }
    for index in 0..spaces[0].coordinates.len() {
        let mut shared = spaces[0].coordinates[index];
        if shared.parameter.is_signed() {
            continue;
        }
        let mut starts = Vec::with_capacity(spaces.len());
        for space in spaces.iter() {
            let coordinate = space.coordinates[index];
            shared.range.0 = shared.range.0.min(coordinate.range.0);
            shared.range.1 = shared.range.1.max(coordinate.range.1);
            starts.push(coordinate.start);
        }
        shared.start = median(&mut starts).unwrap_or(shared.start);
        for space in spaces.iter_mut() {
            space.coordinates[index] = shared;
            space.base[shared.parameter as usize] = shared.start;
        }
    }
    for space in spaces.iter_mut() {
        let is_free = |parameter| {
            let mut coordinates = space.coordinates.iter();
            coordinates.any(|coordinate| coordinate.parameter == parameter)
        };
        space.relaxations = other_relaxations(&space.base, is_free);
        space.seconds_in_contact = seconds;
    }
}

/// Gives the shared parameters of all results one interval, the part that all of them have in
/// common. The intervals of the work of adhesion may differ, because the pull-off of a curve limits
/// its interval.
fn share_intervals(results: &mut [FitResult]) {
    for index in 0..results[0].parameters.len() {
        let mut shared = results[0].parameters[index];
        if shared.parameter.is_signed() {
            continue;
        }
        for result in results.iter() {
            let fitted = result.parameters[index];
            shared.interval.0 = shared.interval.0.max(fitted.interval.0);
            shared.interval.1 = shared.interval.1.min(fitted.interval.1);
            shared.at_end = shared.at_end.or(fitted.at_end);
        }
        for result in results.iter_mut() {
            result.parameters[index] = shared;
        }
    }
}
