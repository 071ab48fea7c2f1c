//! Profiles of rigid bodies and their force loops, for calls from Python: the force curve as
//! arrays, its main results, and its picture.

use crate::computing::{Progress, computed};
use crate::failure::Failure;
use crate::quantity::{Array, array};
use crate::scene::Scene;
use asperity::contact::motion::{JumpCollector, Stage};
use asperity::contact::{Events, Figures, Mark, NominalForm, StageRecord};
use asperity::data::Warning;
use asperity::scene::Outcome;
use asperity::scene::instrument::displacements;
use asperity::scene::loading::read_loading;
use asperity::{Contact, Edges, LoadOptions, Modulus, Move, ProfileBuilder};
use asperity_plot::Figure;
use asperity_report::{ForceLoop, LoopUnits, events_table, loop_chart, warning_texts};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;

/// Profile made from heights or from a scene. The Python class `asperity.Profile` wraps it.
#[pyclass(frozen, module = "asperity._native")]
pub struct Profile {
    pub profile: asperity::Profile,
}

#[pymethods]
impl Profile {
    #[new]
    fn new(
        py: Python<'_>,
        heights: PyReadonlyArray1<'_, f64>,
        spacing: f64,
        is_curved: Option<bool>,
    ) -> PyResult<Self> {
        let heights = heights.as_slice()?.to_vec();
        let nominal_form = match is_curved {
            Some(true) => NominalForm::Curved,
            Some(false) => NominalForm::Flat,
            None => NominalForm::Unstated,
        };
        computed(py, None, move |_| {
            let profile = asperity::Profile::from_heights(heights, spacing)?;
            Ok(Profile {
                profile: profile.with_nominal_form(nominal_form),
            })
        })
    }

    /// Returns the profile of a scene.
    #[staticmethod]
    fn of_scene(py: Python<'_>, scene: Py<Scene>) -> PyResult<Self> {
        computed(py, None, move |_| {
            let scene = scene.get();
            let profile = scene
                .simulation()
                .for_one_scene()
                .profile(scene.document.scene())?;
            Ok(Profile { profile })
        })
    }

    /// Returns a profile with the form of a scene, and with the given heights in m as its
    /// roughness.
    #[staticmethod]
    fn of_roughness(
        py: Python<'_>,
        scene: &Scene,
        heights: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Self> {
        let scene = scene.document.scene();
        let mut builder = ProfileBuilder::new(scene.length, heights.len()?);
        if let Some(form) = &scene.form {
            builder = builder.form(form.clone());
        }
        let heights = heights.as_slice()?.to_vec();
        computed(py, None, move |_| {
            Ok(Profile {
                profile: builder.build_with(heights)?,
            })
        })
    }

    /// Returns the positions, heights and gaps of the points in m.
    fn columns<'py>(&self, py: Python<'py>) -> [Array<'py, f64>; 3] {
        let profile = &self.profile;
        let mut positions = Vec::with_capacity(profile.points());
        for index in 0..profile.points() {
            positions.push(profile.position(index));
        }
        [
            array(py, positions),
            array(py, profile.heights().collect()),
            array(py, profile.gaps().to_vec()),
        ]
    }

    /// Returns the number of points, their distance in m, and the length of the profile in m.
    fn size(&self) -> (usize, f64, f64) {
        (
            self.profile.points(),
            self.profile.spacing(),
            self.profile.length(),
        )
    }
}

/// Effective modulus in Pa, works of adhesion on closing and on opening in J/m², and loading
/// stiffness in N/m. After these numbers come the loading stages as text, true for edges at whole
/// springs, and the number of samples.
type Load = ((f64, [f64; 2], f64), (String, bool, u64));

/// Contact of a profile that is given by its heights, and its loading.
struct Loading {
    contact: Contact,
    targets: Vec<Move>,
    /// Stiffness of the instrument, N/m.
    stiffness: f64,
    /// Number of points of the force curve of each stage.
    samples: u64,
}

impl Loading {
    fn new(profile: &Profile, load: &Load) -> Result<Self, Failure> {
        let ((modulus, works, stiffness), (stages, is_grid, samples)) = load;
        let targets = read_loading(stages);
        let targets = targets.map_err(|error| Failure::explained("stages", stages, &error))?;
        let contact = Contact::builder(&profile.profile, Modulus::effective(*modulus)?);
        let edges = if *is_grid {
            Edges::Grid
        } else {
            Edges::SubCell
        };
        let contact = contact
            .works_of_adhesion(*works)
            .loading_stiffness(*stiffness)
            .edges(edges)
            .build()?;
        Ok(Loading {
            contact,
            targets,
            stiffness: *stiffness,
            samples: *samples,
        })
    }
}

/// Returns the table of events in the format NPY. `first_spring` is the index of the first spring
/// under the body, and `stiffness` that of the instrument in N/m.
fn npy(events: &Events, first_spring: usize, stiffness: f64) -> io::Result<Vec<u8>> {
    let mut table = Vec::new();
    events_table(events, first_spring, stiffness.is_finite()).write_npy(&mut table)?;
    Ok(table)
}

/// Indentation in m and force in N of each marked point. The key is the name of the point.
type Marks = BTreeMap<&'static str, (f64, f64)>;

/// Force loop of a profile or of a computed scene. The Python class `asperity.Loop` wraps it.
#[pyclass(frozen, module = "asperity._native")]
pub struct Loop {
    stages: Vec<StageRecord>,
    figures: Figures,
    /// Stiffness of the instrument, N/m.
    stiffness: f64,
    title: String,
    /// Premises of the model that the loading does not meet.
    warnings: Vec<Warning>,
    /// Outcome of the scene; `None` if the profile was given by its heights.
    pub outcome: Option<Arc<Outcome>>,
}

#[pymethods]
impl Loop {
    /// Computes the loading of a profile that is given by its heights.
    #[staticmethod]
    fn of_heights(
        py: Python<'_>,
        profile: Py<Profile>,
        load: Load,
        progress: Progress,
    ) -> PyResult<Loop> {
        computed(py, progress, move |watch| {
            let Loading {
                contact,
                targets,
                stiffness,
                samples,
            } = Loading::new(profile.get(), &load)?;
            let mut proceed = |stage| {
                watch.report(stage as u64, targets.len() as u64);
                !watch.stop()
            };
            let options = LoadOptions::default()
                .samples(samples)
                .before_stage(&mut proceed);
            let cycle = contact.load_with(&targets, options)?;
            let warnings = cycle.warnings();
            Ok(Loop {
                stages: cycle.stages().to_vec(),
                figures: cycle.figures(),
                stiffness,
                title: String::new(),
                warnings,
                outcome: None,
            })
        })
    }

    /// Computes the loading of a profile that is given by its heights, and returns its events: the
    /// bytes of a table in the format NPY.
    #[staticmethod]
    fn events_of_heights<'py>(
        py: Python<'py>,
        profile: Py<Profile>,
        load: Load,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let table = computed(py, None, move |watch| {
            let Loading {
                contact,
                targets,
                stiffness,
                samples,
            } = Loading::new(profile.get(), &load)?;
            let mut proceed = |_| !watch.stop();
            let mut jumps = JumpCollector::default();
            let options = LoadOptions::default()
                .samples(samples)
                .jumps(&mut jumps)
                .before_stage(&mut proceed);
            let cycle = contact.load_with(&targets, options)?;
            let events = jumps.events(cycle.stages(), 0.0, usize::MAX)?;
            Ok(npy(&events, 0, stiffness))
        })?;
        Ok(PyBytes::new(py, &table?))
    }

    /// Computes the loading of the body of a scene, and returns its events as
    /// [`Self::events_of_heights`] does.
    #[staticmethod]
    fn events_of_scene<'py>(py: Python<'py>, scene: Py<Scene>) -> PyResult<Bound<'py, PyBytes>> {
        let table = computed(py, None, move |watch| {
            let scene = scene.get();
            let mut simulation = scene.simulation().for_one_scene();
            let scene = scene.document.scene();
            let mut jumps = JumpCollector::default();
            let mut observe =
                |_: usize, record: &StageRecord, stage: &Stage| jumps.observe(record, stage);
            let outcome = simulation.run(scene, &|| watch.stop(), &mut observe)?;
            let events = jumps.events(&outcome.history.stages, 0.0, usize::MAX)?;
            let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
            Ok(npy(&events, outcome.line.first, stiffness))
        })?;
        Ok(PyBytes::new(py, &table?))
    }

    /// Computes the loading of the body of a scene.
    #[staticmethod]
    fn of_scene(py: Python<'_>, scene: Py<Scene>, progress: Progress) -> PyResult<Loop> {
        computed(py, progress, move |watch| {
            let scene = scene.get();
            let mut simulation = scene.simulation().for_one_scene();
            let scene = scene.document.scene();
            let mut done = 0;
            let outcome = simulation.run(scene, &|| watch.stop(), &mut |_, _, _| {
                done += 1;
                watch.report(done, scene.loading.len() as u64);
                Ok(())
            })?;
            let stiffness = scene.loading_stiffness.unwrap_or(f64::INFINITY);
            Ok(Loop {
                stages: outcome.history.stages.clone(),
                figures: outcome.figures,
                stiffness,
                title: scene.title.clone(),
                warnings: outcome.warnings.clone(),
                outcome: Some(Arc::new(outcome)),
            })
        })
    }

    /// Returns the columns of the force curve in the order of `asperity.Loop`: first the columns of
    /// whole numbers, then the others. The last array but one is not a column; it has the released
    /// energy in J of each stage. The last one has the times in s, and is empty if the body does
    /// not relax.
    fn columns<'py>(&self, py: Python<'py>) -> ([Array<'py, i64>; 2], [Array<'py, f64>; 7]) {
        let mut counts = [const { Vec::new() }; 2];
        let mut columns = [const { Vec::new() }; 7];
        let relaxes = self.stages.iter().any(|stage| stage.times().is_some());
        for (number, stage) in self.stages.iter().enumerate() {
            for point in &stage.curve {
                counts[0].push(number as i64);
                counts[1].push(point.patches as i64);
                columns[0].push(point.indentation);
                columns[1].push(point.force);
                columns[3].push(point.contact_length);
                columns[4].push(point.stored_energy);
            }
            columns[2].extend(displacements(stage, self.stiffness));
            columns[5].push(stage.released_energy);
            if relaxes && stage.seconds.is_empty() {
                // The body stays where it is.
                let last = columns[6].last().copied().unwrap_or(0.0);
                columns[6].extend(stage.curve.iter().map(|_| last));
            }
            columns[6].extend(&stage.seconds);
        }
        (
            counts.map(|column| array(py, column)),
            columns.map(|column| array(py, column)),
        )
    }

    /// Returns pull-off force (N), indentation at pull-off (m), preload (N), dissipated energy (J),
    /// κ, Tabor number and share of ideal contact. After these numbers come the regime and the
    /// marked points.
    fn figures(&self) -> ([Option<f64>; 7], Option<&'static str>, Marks) {
        let mut figures = [
            self.figures.pull_off_force,
            self.figures.pull_off_indentation,
            self.figures.preload,
            self.figures.dissipated_energy,
            None,
            None,
            None,
        ];
        let mut regime = None;
        if let Some(outcome) = &self.outcome {
            figures[4] = outcome.governing.kappa;
            figures[5] = outcome.tabor_number;
            figures[6] = outcome.adhesion_share();
            regime = outcome.regime.map(|regime| regime.name());
        }
        let mut marks = Marks::new();
        for marked in Mark::all(&self.stages) {
            let point = marked.point;
            marks.insert(marked.mark.name(), (point.indentation, point.force));
        }
        (figures, regime, marks)
    }

    /// Returns a sentence for each premise of the model that the loading does not meet.
    fn warnings(&self) -> Vec<String> {
        warning_texts(&self.warnings)
    }

    /// Returns the force curve as a figure in SVG.
    fn svg(&self) -> String {
        let chart = loop_chart(&[ForceLoop::new(&self.stages)], LoopUnits::default());
        Figure::of_chart(&self.title, chart).svg()
    }
}
