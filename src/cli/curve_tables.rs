//! Tables in a folder, one for each of several fitted curves, with the measured and the computed
//! force at each point.

use super::error::CliError;
use asperity_data::{grouped, path_name, printable, write_new_file};
use asperity_experiment::CurveSource;
use asperity_report::{FitReport, Format, write};
use std::collections::HashMap;
use std::fs::{File, canonicalize, create_dir_all};
use std::io::Read;
use std::path::{Path, PathBuf};

/// Extension of the tables.
const EXTENSION: &str = "csv";

/// Folder in which each fitted curve gets a table.
pub(super) struct CurveTables {
    /// Provenance that is written at the beginning of each table.
    provenance: String,
    /// Path of the table of each curve, by the name of the curve.
    paths: HashMap<String, PathBuf>,
}

impl CurveTables {
    /// Chooses the path of the table of each curve, and creates the folder. An existing file is
    /// replaced only if it is a table of the same command, or if `overwrite` is true.
    ///
    /// # Errors
    /// Returns an error if two curves would have the same table, if the folder cannot be created,
    /// or if a table would replace one of the measured curves, the file `output` or any other file
    /// that may not be replaced.
    pub fn prepare(
        folder: &Path,
        curves: &[CurveSource],
        output: Option<&Path>,
        provenance: String,
        overwrite: bool,
    ) -> Result<CurveTables, CliError> {
        let mut tables = CurveTables {
            provenance,
            paths: HashMap::new(),
        };
        let mut curve_of_table: HashMap<PathBuf, String> = HashMap::new();
        for curve in curves {
            let path = folder.join(format!("{}.{EXTENSION}", curve.stem()));
            if let Some(other) = curve_of_table.insert(path.clone(), curve.name()) {
                let (other, curve) = (printable(&other).into_owned(), curve.name());
                let curve = printable(&curve);
                let found = format!("{other} and {curve} would have the same table");
                return Err(CliError::named(
                    path_name(&path),
                    format!("{found}; allowed: curves of different names, or fewer in one command"),
                ));
            }
            tables.paths.insert(curve.name(), path);
        }
        create_dir_all(folder).map_err(|error| {
            CliError::named(
                path_name(folder),
                format!("this folder cannot be created: {error}"),
            )
        })?;
        tables.check_replaced(&curve_of_table, curves, output, overwrite)?;
        Ok(tables)
    }

    /// Returns an error if a table would replace a file that may not be replaced.
    fn check_replaced(
        &self,
        curve_of_table: &HashMap<PathBuf, String>,
        curves: &[CurveSource],
        output: Option<&Path>,
        overwrite: bool,
    ) -> Result<(), CliError> {
        let kept: Vec<PathBuf> = curves
            .iter()
            .map(|curve| curve.path())
            .chain(output)
            .filter_map(|path| canonicalize(path).ok())
            .collect();
        let mut existing: Vec<&PathBuf> =
            curve_of_table.keys().filter(|path| path.exists()).collect();
        existing.sort();
        for path in &existing {
            let is_kept = canonicalize(path).is_ok_and(|path| kept.contains(&path));
            if is_kept || output.is_some_and(|output| output == path.as_path()) {
                let fault = "this is a measured curve or the output; allowed: another folder for the tables";
                return Err(CliError::named(path_name(path), fault));
            }
        }
        existing.retain(|path| !overwrite && !self.is_own(path));
        match existing.split_first() {
            None => Ok(()),
            Some((first, others)) => {
                let others = match others.len() {
                    0 => String::new(),
                    count => format!(", as are {} others", grouped(count as u64)),
                };
                let fault = format!(
                    "this file is no table of this command{others}; allowed: another folder, or --force, which overwrites them"
                );
                Err(CliError::named(path_name(first), fault))
            }
        }
    }

    /// Returns true if a file begins with the provenance of these tables.
    fn is_own(&self, path: &Path) -> bool {
        let mut expected = String::new();
        for line in self.provenance.lines() {
            expected += &format!("# {line}\n");
        }
        let mut found = vec![0; expected.len()];
        let read = File::open(path).and_then(|mut file| file.read_exact(&mut found));
        read.is_ok() && found == expected.as_bytes()
    }

    /// Returns true if the table of a curve exists.
    pub fn has(&self, curve: &str) -> bool {
        self.paths.get(curve).is_some_and(|path| path.exists())
    }

    /// Writes the table of a curve.
    pub fn write(&self, curve: &str, report: &FitReport<'_>) -> Result<(), CliError> {
        let Some(path) = self.paths.get(curve) else {
            return Ok(());
        };
        Ok(write_new_file(path, true, |out| {
            write(out, report, Format::Csv, &self.provenance)
        })?)
    }
}
