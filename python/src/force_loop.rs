//! The force loop of a loading: its curve as arrays, its figures, and its picture.

use crate::computing::computed;
use crate::failure::Failure;
use crate::profile::{Profile, Shape};
use crate::quantity::array;
use crate::scene::Scene;
use asperity::contact::{CurvePoint, Edges, LegRecord};
use asperity::data::format_quantity;
use asperity::scene::{Document, Figures, Outcome, Simulation, displacements, estimate, marks, read_loading};
use asperity::{Contact, Cycle, Material};
use asperity_plot::Figure;
use asperity_report::{ForceLoop, LoopUnits, loop_chart};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::{Arc, OnceLock};

/// Force loop of a loading that begins separated. Arrays have one value for each point of the curve, in SI units.
///
/// Compression is positive, and the indentation is 0 at first touch. A figure that the loop does not have is None. The numbers
/// `kappa`, `tabor`, `regime`, `share` and `pull_off_error` need the form and the roughness of the body, which a profile of
/// heights does not tell apart; they are None for such a profile.
#[pyclass(frozen, module = "asperity._native")]
pub struct Loop {
    source: Source,
    /// Stiffness of the instrument, N/m.
    stiffness: f64,
}

enum Source {
    Heights(Cycle),
    /// A computed scene, with the error of the pull-off force once it is asked for.
    Scene(Document, Arc<Outcome>, OnceLock<Option<f64>>),
}

impl Loop {
    /// The loop of a computed scene.
    pub fn of_scene(document: Document, outcome: Arc<Outcome>) -> Loop {
        let stiffness = document.scene().loading_stiffness.unwrap_or(f64::INFINITY);
        Loop { source: Source::Scene(document, outcome, OnceLock::new()), stiffness }
    }

    fn stages(&self) -> &[LegRecord] {
        match &self.source {
            Source::Heights(cycle) => cycle.legs(),
            Source::Scene(_, outcome, _) => &outcome.history.legs,
        }
    }

    fn outcome(&self) -> Option<&Outcome> {
        if let Source::Scene(_, outcome, _) = &self.source { Some(outcome) } else { None }
    }

    fn column<T>(&self, of: impl Fn(&CurvePoint) -> T) -> Vec<T> {
        self.stages().iter().flat_map(|stage| &stage.curve).map(of).collect()
    }
}

#[pymethods]
impl Loop {
    /// Loads a profile of heights.
    #[staticmethod]
    #[pyo3(signature = (profile, modulus, work, closing_work, loading, loading_stiffness, edges, samples, progress))]
    #[expect(clippy::too_many_arguments, reason = "called once, with the arguments of `asperity.load`")]
    fn of_heights(
        py: Python<'_>,
        profile: &Profile,
        modulus: f64,
        work: f64,
        closing_work: Option<f64>,
        loading: &str,
        loading_stiffness: Option<f64>,
        edges: &str,
        samples: u64,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Loop> {
        let Shape::Heights(profile) = &profile.shape else {
            return Err(Failure::Value("the profile has a scene".to_owned()).exception(py));
        };
        let stiffness = loading_stiffness.unwrap_or(f64::INFINITY);
        computed(py, progress, |_| {
            let edges = if edges == "Grid" { Edges::Grid } else { Edges::SubCell };
            let stages =
                read_loading(loading).map_err(|error| Failure::explained("stages", loading, &error))?;
            let contact = Contact::builder(profile, Material::effective(modulus)).work_of_adhesion(work);
            let contact = closing_work.into_iter().fold(contact, |contact, work| contact.closing_work(work));
            let contact = contact.loading_stiffness(stiffness).edges(edges).samples(samples).build()?;
            Ok(Loop { source: Source::Heights(contact.load(&stages)?), stiffness })
        })
    }

    /// Loads the body of a scene.
    #[staticmethod]
    fn of_body(py: Python<'_>, scene: &Scene, progress: Option<Py<PyAny>>) -> PyResult<Loop> {
        let document = scene.document.clone();
        computed(py, progress, |watch| {
            let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
            let outcome = simulation.run(document.scene(), &|| watch.stop(), &mut |_, _, _| Ok(()))?;
            Ok(Loop::of_scene(document, Arc::new(outcome)))
        })
    }

    /// Indentation, m.
    #[getter]
    fn d<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.column(|point| point.indentation))
    }

    /// Force, N.
    #[getter(F)]
    fn force<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.column(|point| point.force))
    }

    /// Displacement of the instrument D = d + F/k, m; the indentation if the instrument is rigid.
    #[getter(D)]
    fn displacement<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.stages().iter().flat_map(|stage| displacements(stage, self.stiffness)).collect())
    }

    /// Index of the loading stage, from 0.
    #[getter]
    fn stage<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        let stages = self.stages().iter().zip(0..);
        array(py, stages.flat_map(|(stage, number)| vec![number; stage.curve.len()]).collect())
    }

    /// Length in contact, m.
    #[getter]
    fn length<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.column(|point| point.contact_length))
    }

    /// Number of contact patches.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        array(py, self.column(|point| point.fragments as i64))
    }

    /// Stored elastic energy, J.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.column(|point| point.stored_energy))
    }

    /// Released elastic energy of each stage, J; over a closed loop the sum is the dissipated energy.
    #[getter]
    fn released<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.stages().iter().map(|stage| stage.released_energy).collect())
    }

    /// Pull-off force, N: minus the smallest force of the last unloading.
    #[getter]
    fn pull_off(&self) -> Option<f64> {
        self.figures().adhesion_force
    }

    /// Indentation at the pull-off force, m.
    #[getter]
    fn pull_off_d(&self) -> Option<f64> {
        self.figures().pull_off_indentation
    }

    /// Preload, N: largest force while loading, since the last separation and before the last unloading.
    #[getter]
    fn preload(&self) -> Option<f64> {
        self.figures().preload
    }

    /// Dissipated energy of a loop that ends separated, J.
    #[getter]
    fn dissipated(&self) -> Option<f64> {
        self.figures().dissipated_energy
    }

    /// Marked points of the loop by their names (jump-in, preload, pull-off, jump-out): indentation in m and force in N. A jump
    /// into contact, and one out of contact after the pull-off, are marked where the contact forms and where it is lost.
    #[getter]
    fn jumps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for (mark, point) in marks(self.stages()) {
            named.set_item(mark.name(), (point.indentation, point.force))?;
        }
        Ok(named)
    }

    /// Roughness-adhesion parameter κ; None for a profile of heights, without adhesion, and without roughness.
    #[getter]
    fn kappa(&self) -> Option<f64> {
        self.outcome()?.governing.kappa
    }

    /// Tabor number μ; None for a profile of heights, without adhesion, and without a radius of curvature.
    #[getter]
    fn tabor(&self) -> Option<f64> {
        self.outcome()?.tabor_number
    }

    /// Regime of adhesion from first touch; None for a profile of heights, and without a tensile force.
    #[getter]
    fn regime(&self) -> Option<&'static str> {
        Some(self.outcome()?.regime?.name())
    }

    /// Pull-off force over that of ideal contact, F_a/F_a,max; None for a profile of heights, and without either.
    #[getter]
    fn share(&self) -> Option<f64> {
        self.outcome()?.adhesion_share()
    }

    /// Estimated error of the pull-off force by the number of springs, N, computed when it is first asked for; None for a profile
    /// of heights, which cannot be refined.
    #[getter]
    fn pull_off_error(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        let Source::Scene(document, outcome, error) = &self.source else { return Ok(None) };
        if let Some(known) = error.get() {
            return Ok(*known);
        }
        let found = computed(py, None, |watch| {
            let found = estimate(document.scene(), &document.resolve(""), outcome, &|| watch.stop());
            Ok(found.and_then(|found| found.of_adhesion_force(outcome)))
        })?;
        Ok(*error.get_or_init(|| found))
    }

    /// The curve as a table of pandas.
    fn to_pandas<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let columns = PyDict::new(py);
        columns.set_item("stage", self.stage(py))?;
        columns.set_item("d", self.d(py))?;
        columns.set_item("F", self.force(py))?;
        columns.set_item("D", self.displacement(py))?;
        columns.set_item("length", self.length(py))?;
        columns.set_item("patches", self.patches(py))?;
        columns.set_item("energy", self.energy(py))?;
        py.import("pandas")?.call_method1("DataFrame", (columns,))
    }

    /// The force curve as a figure in SVG.
    fn _repr_svg_(&self) -> String {
        let title = if let Source::Scene(document, ..) = &self.source { document.title() } else { "" };
        let chart = loop_chart(&[ForceLoop::new(self.stages())], LoopUnits::default());
        Figure::of_chart(title, chart).svg()
    }

    fn __len__(&self) -> usize {
        self.stages().iter().map(|stage| stage.curve.len()).sum()
    }

    fn __repr__(&self) -> String {
        let words =
            |value: Option<f64>, unit| value.map_or("None".to_owned(), |value| format_quantity(value, unit));
        let Figures { adhesion_force, preload, dissipated_energy, .. } = self.figures();
        let [force, preload] = [adhesion_force, preload].map(|value| words(value, "N"));
        format!("<Loop: pull_off {force}, preload {preload}, dissipated {}>", words(dissipated_energy, "J"))
    }
}

impl Loop {
    fn figures(&self) -> Figures {
        match &self.source {
            Source::Heights(cycle) => Figures {
                preload: cycle.preload(),
                adhesion_force: cycle.pull_off_force(),
                pull_off_indentation: cycle.pull_off_indentation(),
                dissipated_energy: cycle.dissipated_energy(),
                ..Figures::default()
            },
            Source::Scene(_, outcome, _) => outcome.figures,
        }
    }
}
