//! The computing stages of a scene in words.

use crate::sheet::Sheet;
use asperity_data::{grouped, memory_size};
use asperity_scene::stages::{PlannedStage, Workload};

/// Returns a table of the steps in which the program computes a scene, such as making the profile.
/// Each row has the number of passes over the springs, an upper bound of the spring visits of all
/// passes together, the memory that the step needs, and the reason why the step runs or is skipped.
pub fn stages_text(plan: &Workload) -> String {
    let mut rows = vec![["stage", "passes", "springs", "memory", "because"].map(String::from)];
    let count = |count: u64| {
        if count > 0 {
            grouped(count)
        } else {
            String::new()
        }
    };
    for PlannedStage {
        stage,
        runs,
        because,
        passes,
        springs_touched,
        bytes,
    } in &plan.stages
    {
        let memory = if *bytes > 0 {
            memory_size(*bytes)
        } else {
            String::new()
        };
        let passes = match *passes {
            _ if !runs => "skipped".to_owned(),
            None => "per stage".to_owned(),
            Some(0) => "runs".to_owned(),
            Some(passes) => grouped(passes),
        };
        let touched = springs_touched.map_or_else(String::new, count);
        rows.push([
            stage.name().into(),
            passes,
            touched,
            memory,
            (*because).into(),
        ]);
    }
    let mut sheet = Sheet::default();
    sheet.table(&rows);
    let (springs, peak) = (grouped(plan.springs), memory_size(plan.resident_bytes));
    let program = memory_size(Workload::PROGRAM);
    sheet.heading(&format!(
        "{springs} springs under the body; about {peak} of memory at any one time, {program} of them the program"
    ));
    sheet.into_text()
}
