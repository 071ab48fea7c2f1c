//! Table of the parts of the computation of a scene.

use crate::sheet::Sheet;
use asperity_data::{counted, grouped, memory_size};
use asperity_scene::workload::{PlannedPart, Workload};

/// Returns a table of the parts of the computation of a scene, such as the part that makes the
/// profile. Each row has the number of passes over the springs, an upper bound of the number of
/// springs visited in all passes, the memory that the part needs, and the reason why the part is
/// computed or skipped.
pub fn parts_text(plan: &Workload) -> String {
    let mut rows = vec![["part", "passes", "springs", "memory", "because"].map(String::from)];
    rows.extend(plan.parts.iter().map(row));
    let mut sheet = Sheet::default();
    sheet.table(&rows);
    let springs = counted(plan.springs, "spring");
    let peak = memory_size(plan.resident_bytes);
    let program = memory_size(Workload::PROGRAM);
    sheet.heading(&format!(
        "{springs} under the body; about {peak} of memory at any one time, {program} of them the program"
    ));
    sheet.into_text()
}

fn row(planned: &PlannedPart) -> [String; 5] {
    let passes = match planned.passes {
        _ if !planned.runs => "skipped".to_owned(),
        None => "per stage".to_owned(),
        Some(0) => "runs".to_owned(),
        Some(passes) => grouped(passes),
    };
    let springs = match planned.springs_touched {
        None | Some(0) => String::new(),
        Some(springs) => grouped(springs),
    };
    let memory = match planned.bytes {
        0 => String::new(),
        bytes => memory_size(bytes),
    };
    [
        planned.part.name().into(),
        passes,
        springs,
        memory,
        planned.because.into(),
    ]
}
