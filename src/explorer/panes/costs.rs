//! Cost of accuracy, as far as measured.

use crate::accuracy::{CostTable, Progress, measure};
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Time for a whole measurement: that of `asperity cost`.
const BUDGET: Duration = Duration::from_secs(10);

/// The table of costs so far.
#[derive(Clone, Debug, Default)]
pub struct Costs {
    /// The rows so far.
    pub table: Option<CostTable>,
    /// Setting tried at present.
    pub trying: Option<String>,
}

/// Measures the costs of a scene. Their times are measured together: an interrupted measurement begins anew.
pub fn study(computed: &SolvedScene) -> Study {
    let scene = Arc::clone(&computed.scene);
    Study::new(computed.generation, true, move |_, stop, report| {
        let mut costs = Costs::default();
        let measured = measure(&scene, Path::new(""), BUDGET, stop, &mut |progress| {
            match progress {
                Progress::Trying(knob, setting) => costs.trying = Some(format!("{}: {setting}", knob.name())),
                Progress::Rows(table) => costs.table = Some(table.clone()),
            }
            report(costs.clone());
        });
        Ok(Costs { table: Some(measured?), trying: None })
    })
}
