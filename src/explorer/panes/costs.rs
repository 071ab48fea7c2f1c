//! Cost of accuracy, as far as measured.

use crate::accuracy::{CostTable, Progress, measure};
use crate::scene::Scene;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Time for a whole measurement: that of `asperity cost`.
const BUDGET: Duration = Duration::from_secs(10);

/// The table of costs so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Costs {
    /// The rows so far.
    pub table: Option<Arc<CostTable>>,
    /// Setting tried at present.
    pub trying: Option<String>,
    /// True once all is measured.
    pub is_whole: bool,
}

impl Costs {
    /// Measures the costs of a scene; `report` receives the costs so far.
    ///
    /// # Errors
    /// When nothing can be compared.
    pub fn measure(
        scene: &Scene,
        folder: &Path,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(&Costs),
    ) -> Result<Costs, String> {
        let mut costs = Costs::default();
        let table = measure(scene, folder, BUDGET, stop, &mut |progress| {
            match progress {
                Progress::Trying(knob, setting) => costs.trying = Some(format!("{}: {setting}", knob.name())),
                Progress::Rows(table) => costs.table = Some(Arc::new(table.clone())),
            }
            report(&costs);
        })?;
        Ok(Costs { table: Some(Arc::new(table)), trying: None, is_whole: true })
    }
}
