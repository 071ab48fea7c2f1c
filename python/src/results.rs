//! Results of scenes, for calls from Python: functions that call the libraries and return reports.

use crate::advice::argument;
use crate::computing::{Call, Case, DEFECT};
use crate::failure::Failure;
use crate::force_loop::Loop;
use asperity::data::{AxisScale, parse_quantity};
use asperity::scene::{CheckedScene, Document, estimate};
use asperity::study::half_space::{Reference, ReferenceEvent, ReferenceOptions};
use asperity::study::trust::{MeasuredAdhesion, warnings_of_reversals};
use asperity::study::{
    Axis, Ensemble, Found, Plan, Quantity, Question, Results, Spacing, Staircase, compute,
    compute_with_measured,
};
use asperity::surface::lines::MeasuredRoughness;
use asperity_plot::{pdf_of_svg, png_of_svg};
use asperity_report::{
    FindReport, Format, PreloadReport, ReferenceReport, Report as Reported, ReversalReport,
    RunReport, missing_form, scene_provenance,
};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;

/// A result that can be written in the formats of the program: text, JSON, a table as CSV or as a
/// NumPy array, and a figure.
#[pyclass(frozen, module = "asperity._native")]
pub struct Report(Box<dyn Fn(Format) -> io::Result<Vec<u8>> + Send + Sync>);

impl Report {
    /// Creates a result. `write` returns the report of the result in a given format, as bytes.
    pub fn new(write: impl Fn(Format) -> io::Result<Vec<u8>> + Send + Sync + 'static) -> Self {
        Report(Box::new(write))
    }
}

/// Returns the document that tables and figures state as the origin of a result. `None` if the
/// scene has a roughness that exists only in memory, because no scene file can contain it.
pub fn named<'a>(
    document: &'a Document,
    in_memory: &Option<Arc<MeasuredRoughness>>,
) -> Option<&'a Document> {
    in_memory.is_none().then_some(document)
}

/// Returns a report in a format, as bytes. `of` is the scene from which the result was computed. It
/// is stated in reports as CSV and SVG.
pub fn bytes(of: Option<&Document>, report: &impl Reported, format: Format) -> io::Result<Vec<u8>> {
    let mut written = Vec::new();
    let mut provenance = String::new();
    if let Some(document) = of
        && matches!(format, Format::Csv | Format::Svg)
    {
        let folder = document.resolve("");
        let lines = scene_provenance("import asperity", document.scene(), &folder, Path::new(""));
        provenance = lines.map_err(io::Error::other)?;
    }
    asperity_report::write(&mut written, report, format, &provenance)?;
    Ok(written)
}

#[pymethods]
impl Report {
    /// Returns the result in a format: text, json, csv, npy, svg, png or pdf.
    fn write(&self, py: Python<'_>, format: &str) -> PyResult<Vec<u8>> {
        let mut formats = Format::ALL.into_iter();
        let Some(known) =
            formats.find(|known| known.name() == format || known.extension() == format)
        else {
            let names = Format::ALL.map(Format::extension).join(", ");
            let message = format!("format {format:?}; allowed: {names}");
            return Err(PyValueError::new_err(message));
        };
        // A panic shows a defect of the program. It becomes a Python exception.
        let written = py
            .detach(|| catch_unwind(AssertUnwindSafe(|| (self.0)(known))))
            .map_err(|_| PyRuntimeError::new_err(DEFECT))?;
        written.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Returns the result in each format that it has, for its copies and for other processes. PNG
    /// and PDF follow from SVG.
    fn __reduce__(&self, py: Python<'_>) -> PyResult<(Py<PyAny>, (Forms,))> {
        let mut forms = Forms::new();
        for format in Format::ALL {
            if !matches!(format, Format::Png | Format::Pdf)
                && let Ok(written) = self.write(py, format.name())
            {
                forms.insert(format.name().to_owned(), written);
            }
        }
        let restored = py.get_type::<Report>().getattr("restored")?;
        Ok((restored.unbind(), (forms,)))
    }

    /// Returns the result whose forms [`Self::__reduce__`] has returned.
    #[staticmethod]
    fn restored(forms: Forms) -> Report {
        Report::new(move |format| {
            if let Some(written) = forms.get(format.name()) {
                return Ok(written.clone());
            }
            let svg = forms.get(Format::Svg.name()).map(Vec::as_slice);
            let svg = str::from_utf8(svg.unwrap_or_default()).map_err(io::Error::other)?;
            match format {
                Format::Png if !svg.is_empty() => png_of_svg(svg),
                Format::Pdf if !svg.is_empty() => pdf_of_svg(svg),
                _ => Err(missing_form(format)),
            }
        })
    }
}

/// Bytes of a result by the names of the formats in which it was written.
type Forms = BTreeMap<String, Vec<u8>>;

fn done_of_ensemble(ensemble: &Ensemble) -> Option<u64> {
    Some(ensemble.computed())
}

fn done_of_results(results: &Results) -> Option<u64> {
    Some(results.profiles_done())
}

/// Returns `None` for all reports of a computation that is too short to count its finished parts.
fn unchanged<P>(_: &P) -> Option<u64> {
    None
}

/// Returns the number of finished parts, for a computation whose reports are this number.
fn done(parts: &u64) -> Option<u64> {
    Some(*parts)
}

/// Computes a scene on its random profiles. `further` are quantities that are recorded in addition
/// to the usual ones.
fn on_profiles(case: &Case<'_>, further: &[Quantity]) -> Result<Ensemble, Failure> {
    let scene = case.document.scene();
    case.check_profiles()?;
    case.watched(case.profiles, done_of_ensemble, |control| {
        Ensemble::of(
            scene,
            further,
            case.profiles,
            &mut case.simulation(),
            control,
        )
    })
}

/// Returns the report of a computed scene, with the results on its random profiles.
#[pyfunction]
pub fn run(py: Python<'_>, call: Call, computed: &Loop) -> PyResult<Report> {
    let further = if call.1.is_some() {
        &Ensemble::FURTHER[..]
    } else {
        &[]
    };
    let outcome = computed
        .outcome
        .clone()
        .ok_or_else(|| PyValueError::new_err("no scene"))?;
    call.computed(py, move |case| {
        let scene = case.document.scene();
        let folder = case.document.resolve("");
        let mut ensemble = None;
        let mut deviation = None;
        if case.profiles > 1 {
            ensemble = Some(on_profiles(&case, further)?);
        }
        let estimate = estimate(scene, &folder, &outcome, &|| case.watch.stop());
        if let Some(ensemble) = &ensemble {
            deviation = case.watched(case.profiles, unchanged, |control| {
                MeasuredAdhesion::quick_deviation(&case.document, ensemble.profiles(), control)
            })?;
        }
        Ok(Report::new(move |format| {
            let report = RunReport {
                title: case.document.title(),
                scene: case.document.scene(),
                outcome: &outcome,
                choice: None,
                estimate: estimate.as_ref(),
                ensemble: ensemble.as_ref(),
                deviation,
                wording: argument,
            };
            bytes(named(&case.document, &case.in_memory), &report, format)
        }))
    })
}

/// Computes a scene on random profiles.
#[pyfunction]
pub fn ensemble(py: Python<'_>, call: Call) -> PyResult<Report> {
    call.computed(py, move |case| {
        let ensemble = on_profiles(&case, &Ensemble::FURTHER)?;
        Ok(Report::new(move |format| {
            bytes(named(&case.document, &case.in_memory), &ensemble, format)
        }))
    })
}

/// Finds the value of a number of a scene at which a quantity reaches a given value.
#[pyfunction]
pub fn find(
    py: Python<'_>,
    call: Call,
    field: String,
    value: String,
    range: Option<String>,
) -> PyResult<Report> {
    call.computed(py, move |case| {
        case.check_profiles()?;
        let scene = case.document.scene();
        let mut simulation = case.simulation();
        let mut question = Question::new(
            scene,
            &field,
            Question::parse_condition(&value)
                .map_err(|error| Failure::of_argument("where", &value, &error))?,
            case.profiles,
            &mut simulation,
        )
        .map_err(|error| Failure::of_refusal("field", &field, error))?;
        if let Some(range) = range {
            question.searched = Axis::parse_range(&range, question.axis.unit)
                .map_err(|error| Failure::of_argument("range", &range, &error))?;
        }
        let found = case.watched(case.profiles, done, |control| {
            Found::of(question, &mut simulation, control)
        })?;
        Ok(Report::new(move |format| {
            let report = FindReport {
                title: case.document.title(),
                scene: case.document.scene(),
                found: &found,
            };
            bytes(named(&case.document, &case.in_memory), &report, format)
        }))
    })
}

/// Computes the pull-off force of a scene as a function of the preload. `preloads` is a text in the
/// notation of `asperity run --preloads`.
#[pyfunction]
pub fn preloads(py: Python<'_>, call: Call, preloads: String) -> PyResult<Report> {
    call.computed(py, move |case| {
        case.check_profiles()?;
        let scene = case.document.scene();
        let axis = Axis::parse_preloads(&preloads)
            .map_err(|error| Failure::of_argument("between", &preloads, &error))?;
        let mut simulation = case.simulation();
        let staircase = case.watched(case.profiles, unchanged, |control| {
            Staircase::of(scene, &axis, &mut simulation, control)
        })?;
        let results = case.watched(case.profiles, done_of_results, |control| {
            Results::of_scene(
                scene,
                &Results::OF_PRELOADS,
                case.profiles,
                Some(&axis),
                &mut simulation,
                control,
            )
        })?;
        Ok(Report::new(move |format| {
            let report = PreloadReport {
                title: case.document.title(),
                choice: None,
                results: &results,
                staircase: Some(&staircase),
                curves: false,
            };
            bytes(named(&case.document, &case.in_memory), &report, format)
        }))
    })
}

/// Computes the unloadings of a scene that begin at many turning points.
#[pyfunction]
pub fn reversals(
    py: Python<'_>,
    call: Call,
    range: Option<String>,
    count: usize,
) -> PyResult<Report> {
    call.computed(py, move |case| {
        let mut ends = None;
        if let Some(range) = range {
            ends = Some(
                Axis::parse_range(&range, "N")
                    .map_err(|error| Failure::of_argument("between", &range, &error))?,
            );
        }
        let mut simulation = case.simulation().for_one_scene();
        let map =
            simulation.reversal_map(case.document.scene(), ends, count, &|| case.watch.stop())?;
        let scene = case.document.scene();
        let warnings = warnings_of_reversals(&map, scene, &mut simulation)?;
        let largest = map
            .reversals
            .iter()
            .map(|reversal| reversal.turn.force)
            .fold(0.0, f64::max);
        let mut preloads = None;
        let mut staircase = None;
        // The chart needs at least one turning point at which the bodies are pressed together.
        if let Ok(axis) =
            Axis::of_preloads(ends.unwrap_or((0.0, largest)), count, AxisScale::Linear)
        {
            preloads = Some(case.watched(1, unchanged, |control| {
                Results::of_scene(
                    scene,
                    &Results::OF_PRELOADS,
                    1,
                    Some(&axis),
                    &mut case.simulation(),
                    control,
                )
            })?);
            staircase = Some(case.watched(1, unchanged, |control| {
                Staircase::of(scene, &axis, &mut simulation, control)
            })?);
        }
        Ok(Report::new(move |format| {
            let report = ReversalReport {
                title: case.document.title(),
                scene: case.document.scene(),
                map: &map,
                warnings: &warnings,
                preloads: preloads.as_ref(),
                staircase: staircase.as_ref(),
            };
            bytes(named(&case.document, &case.in_memory), &report, format)
        }))
    })
}

/// Compares the results of a scene on profiles (lines) with the results on square surfaces in three
/// dimensions. `cells` is the number of grid cells along the side of a square surface, and
/// `surfaces` is the number of random square surfaces.
#[pyfunction]
pub fn reference(
    py: Python<'_>,
    call: Call,
    cells: usize,
    surfaces: Option<u64>,
) -> PyResult<Report> {
    let lines = call.1;
    call.computed(py, move |case| {
        let scene = case.document.scene();
        let usual = ReferenceOptions::of(scene, surfaces);
        let options = ReferenceOptions {
            cells,
            profiles: lines.unwrap_or(usual.profiles),
            ..usual
        };
        let mut squares = 0;
        let done = |event: &ReferenceEvent| {
            if !matches!(event, ReferenceEvent::Square { .. }) {
                return None;
            }
            squares += 1;
            Some(squares)
        };
        let found = case.watched(options.surfaces, done, |control| {
            Reference::of(scene, options, &mut case.simulation(), control)
        })?;
        Ok(Report::new(move |format| {
            let report = ReferenceReport {
                title: case.document.title(),
                scene: case.document.scene(),
                reference: &found,
                wording: argument,
            };
            bytes(named(&case.document, &case.in_memory), &report, format)
        }))
    })
}

/// Value on an axis of a study. It is a number in the SI unit of the axis, or a text that may have
/// a unit.
#[derive(FromPyObject)]
pub enum AxisValue {
    Number(f64),
    Text(String),
}

/// Path of the field that varies along an axis, and the values on the axis.
type GivenAxis = (String, Vec<AxisValue>);

/// Axes of a study, and the names of the quantities that it records.
#[derive(FromPyObject)]
pub struct StudyDesign(Vec<GivenAxis>, Vec<String>);

fn read_axis(
    scene: &CheckedScene,
    (path, values): &GivenAxis,
) -> Result<(String, Vec<f64>), Failure> {
    let unit = Axis::new(path, Spacing::List, Vec::new(), scene)
        .map_err(|error| Failure::of_argument("axes", path, &error))?
        .unit;
    let mut numbers = Vec::with_capacity(values.len());
    for value in values {
        numbers.push(match value {
            AxisValue::Number(number) => *number,
            AxisValue::Text(text) => read_axis_value(text, path, unit)?,
        });
    }
    Ok((path.clone(), numbers))
}

fn read_axis_value(text: &str, path: &str, unit: &str) -> Result<f64, Failure> {
    parse_quantity(text, unit).map_err(|error| {
        if path == "preload" {
            let allowed = "a number in units of E* h L; the axis preload_in_N takes forces";
            return Failure::field("preload", text, allowed);
        }
        Failure::explained(path, text, &error)
    })
}

/// Returns the plan of a study of a scene.
pub fn plan_of_study(case: &Case<'_>, design: &StudyDesign) -> Result<Plan, Failure> {
    case.check_profiles()?;
    let StudyDesign(axes, record) = design;
    let mut quantities = Vec::with_capacity(record.len());
    for name in record {
        quantities.push(
            Quantity::named(name).map_err(|error| Failure::of_argument("record", name, &error))?,
        );
    }
    let mut read = Vec::new();
    for axis in axes {
        read.push(read_axis(case.document.scene(), axis)?);
    }
    let mut axes = Vec::with_capacity(read.len());
    for (path, values) in &read {
        axes.push((path.as_str(), values.as_slice()));
    }
    Plan::new(&case.document, &axes, case.profiles, &quantities).map_err(|error| {
        let paths: Vec<&str> = axes.iter().map(|axis| axis.0).collect();
        Failure::of_refusal("axes", &paths.join(", "), error)
    })
}

/// Computes a scene for each combination of values on the axes. Each combination is computed on
/// several random profiles.
#[pyfunction]
pub fn study(py: Python<'_>, call: Call, design: StudyDesign) -> PyResult<Report> {
    call.computed(py, move |case| {
        let plan = plan_of_study(&case, &design)?;
        let results = case.watched(plan.records_in_all(), done, |control| {
            match &case.in_memory {
                Some(measured) => compute_with_measured(&plan, Arc::clone(measured), control),
                None => compute(&plan, control),
            }
        })?;
        Ok(Report::new(move |format| {
            bytes(named(&case.document, &case.in_memory), &results, format)
        }))
    })
}
