//! The force loop of a loading: its curve as arrays, its figures, and its picture.

use crate::computing::computed;
use crate::failure::Failure;
use crate::profile::Profile;
use crate::quantity::array;
use crate::scene::Scene;
use asperity::contact::points::marks;
use asperity::contact::{CurvePoint, Figures, LegRecord};
use asperity::scene::instrument::displacements;
use asperity::scene::loading::read_loading;
use asperity::scene::{Document, Outcome, Simulation, estimate};
use asperity::{Contact, Cycle, Edges, LoadOptions, Modulus};
use asperity_plot::Figure;
use asperity_report::{ForceLoop, LoopUnits, loop_chart};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// The loop of a profile of heights or of a computed scene; `asperity.Loop` gives its parts their names.
#[pyclass(frozen, module = "asperity._native")]
pub struct Loop {
    source: Source,
    /// Stiffness of the instrument, N/m.
    stiffness: f64,
}

enum Source {
    Heights(Box<Cycle>),
    Scene(Box<Document>, Arc<Outcome>),
}

impl Loop {
    /// The loop of a computed scene.
    pub fn of_scene(document: Document, outcome: Arc<Outcome>) -> Loop {
        let stiffness = document.scene().loading_stiffness.unwrap_or(f64::INFINITY);
        Loop { source: Source::Scene(Box::new(document), outcome), stiffness }
    }

    fn stages(&self) -> &[LegRecord] {
        match &self.source {
            Source::Heights(cycle) => cycle.stages(),
            Source::Scene(_, outcome) => &outcome.history.legs,
        }
    }

    fn column<T>(&self, of: impl Fn(&CurvePoint) -> T) -> Vec<T> {
        self.stages().iter().flat_map(|stage| &stage.curve).map(of).collect()
    }
}

#[pymethods]
impl Loop {
    /// Loads a profile of heights: modulus (Pa), works of adhesion on closing and on opening (J/m²), loading stiffness (N/m),
    /// stages, whole springs or not, and samples on each stage.
    #[staticmethod]
    fn of_heights(
        py: Python<'_>,
        profile: &Profile,
        foundation: (f64, [f64; 2], f64),
        loading: (String, bool, u64),
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Loop> {
        let ((modulus, works, stiffness), (stages, is_grid, samples)) = (foundation, loading);
        computed(py, progress, |watch| {
            let legs =
                read_loading(&stages).map_err(|error| Failure::explained("stages", &stages, &error))?;
            let contact =
                Contact::builder(&profile.profile, Modulus::effective(modulus)?).works_of_adhesion(works);
            let edges = if is_grid { Edges::Grid } else { Edges::SubCell };
            let contact = contact.loading_stiffness(stiffness).edges(edges).build()?;
            let mut proceed = |stage| {
                watch.report(stage as u64, legs.len() as u64);
                !watch.stop()
            };
            let options = LoadOptions::default().samples(samples).before_stage(&mut proceed);
            Ok(Loop { source: Source::Heights(Box::new(contact.load_with(&legs, options)?)), stiffness })
        })
    }

    /// Loads the body of a scene.
    #[staticmethod]
    fn of_body(py: Python<'_>, scene: &Scene, progress: Option<Py<PyAny>>) -> PyResult<Loop> {
        let document = scene.document.clone();
        computed(py, progress, |watch| {
            let mut simulation = Simulation::new(document.resolve("")).for_one_scene();
            let (stages, mut done) = (document.scene().loading.len() as u64, 0);
            let outcome = simulation.run(document.scene(), &|| watch.stop(), &mut |_, _, _| {
                done += 1;
                watch.report(done, stages);
                Ok(())
            })?;
            Ok(Loop::of_scene(document, Arc::new(outcome)))
        })
    }

    /// Columns of the curve, and the released energy of each stage.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (columns, stages) = (PyDict::new(py), self.stages());
        let numbered = stages.iter().zip(0_i64..);
        let stage = numbered.flat_map(|(stage, number)| vec![number; stage.curve.len()]);
        let displacement = stages.iter().flat_map(|stage| displacements(stage, self.stiffness));
        columns.set_item("stage", array::<i64>(py, stage.collect()))?;
        columns.set_item("d", array(py, self.column(|point| point.indentation)))?;
        columns.set_item("F", array(py, self.column(|point| point.force)))?;
        columns.set_item("D", array::<f64>(py, displacement.collect()))?;
        columns.set_item("length", array(py, self.column(|point| point.contact_length)))?;
        columns.set_item("patches", array(py, self.column(|point| point.fragments as i64)))?;
        columns.set_item("energy", array(py, self.column(|point| point.stored_energy)))?;
        let released = stages.iter().map(|stage| stage.released_energy);
        columns.set_item("released", array::<f64>(py, released.collect()))?;
        Ok(columns)
    }

    /// Figures of the loop, and its marked points.
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (figures, outcome): (Figures, Option<&Outcome>) = match &self.source {
            Source::Heights(cycle) => (cycle.figures(), None),
            Source::Scene(_, outcome) => (outcome.figures, Some(outcome)),
        };
        let values = PyDict::new(py);
        values.set_item("pull_off", figures.adhesion_force)?;
        values.set_item("pull_off_d", figures.pull_off_indentation)?;
        values.set_item("preload", figures.preload)?;
        values.set_item("dissipated", figures.dissipated_energy)?;
        values.set_item("kappa", outcome.and_then(|outcome| outcome.governing.kappa))?;
        values.set_item("tabor", outcome.and_then(|outcome| outcome.tabor_number))?;
        values.set_item("regime", outcome.and_then(|outcome| Some(outcome.regime?.name())))?;
        values.set_item("share", outcome.and_then(Outcome::adhesion_share))?;
        let named = marks(self.stages()).into_iter();
        let named: Vec<_> =
            named.map(|(mark, point)| (mark.name(), (point.indentation, point.force))).collect();
        values.set_item("jumps", PyDict::from_sequence(&named.into_pyobject(py)?)?)?;
        Ok(values)
    }

    /// Estimated error of the pull-off force by the number of springs, N; None for a profile of heights.
    fn error(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        let Source::Scene(document, outcome) = &self.source else { return Ok(None) };
        computed(py, None, |watch| {
            let found = estimate(document.scene(), &document.resolve(""), outcome, &|| watch.stop());
            Ok(found.and_then(|found| found.of_adhesion_force(outcome)))
        })
    }

    /// The force curve as a figure in SVG.
    fn svg(&self) -> String {
        let title = if let Source::Scene(document, _) = &self.source { document.title() } else { "" };
        Figure::of_chart(title, loop_chart(&[ForceLoop::new(self.stages())], LoopUnits::default())).svg()
    }
}
