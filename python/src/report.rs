//! A result that is written in the formats of the program.

use asperity::scene::Document;
use asperity_report::{Format, scene_provenance};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::io;
use std::path::Path;

/// Function that writes a result in a format.
type Write = dyn Fn(Format) -> io::Result<Vec<u8>> + Send + Sync;

/// A result in the formats of the program: JSON, a table as CSV or as an array of NumPy, text, and a figure.
#[pyclass(frozen, module = "asperity._native")]
pub struct Report {
    write: Box<Write>,
}

impl Report {
    /// The result of a function that borrows the report of what it owns.
    pub fn new(write: impl Fn(Format) -> io::Result<Vec<u8>> + Send + Sync + 'static) -> Self {
        Report { write: Box::new(write) }
    }
}

/// A report as bytes.
pub fn bytes(report: &impl asperity_report::Report, format: Format, provenance: &str) -> io::Result<Vec<u8>> {
    let mut written = Vec::new();
    asperity_report::write(&mut written, report, format, provenance)?;
    Ok(written)
}

/// A report of a scene as bytes; tables and figures state the scene.
pub fn of_scene(
    document: &Document,
    report: &impl asperity_report::Report,
    format: Format,
) -> io::Result<Vec<u8>> {
    if !matches!(format, Format::Csv | Format::Svg) {
        return bytes(report, format, "");
    }
    let folder = document.resolve("");
    let provenance = scene_provenance("import asperity", document.scene(), &folder, Path::new(""));
    bytes(report, format, &provenance.map_err(io::Error::other)?)
}

#[pymethods]
impl Report {
    /// The result in a format: text, json, csv, npy, svg, png or pdf.
    fn write<'py>(&self, py: Python<'py>, format: &str) -> PyResult<Bound<'py, PyBytes>> {
        let known = Format::ALL.into_iter().find(|one| one.name() == format || one.extension() == format);
        let known = known.ok_or_else(|| {
            let names = Format::ALL.map(Format::extension).join(", ");
            PyValueError::new_err(format!("format {format:?}; allowed: {names}"))
        })?;
        let written = py.detach(|| (self.write)(known));
        Ok(PyBytes::new(py, &written.map_err(|error| PyValueError::new_err(error.to_string()))?))
    }
}
