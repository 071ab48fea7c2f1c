//! Error for a folder that holds the study of another plan.

use super::StudyError;
use super::measured::file_of;
use super::plan::{PLAN_FILE, Plan};
use super::plan_text::Changes;
use crate::text::{path_name, printable};
use std::path::Path;

/// Error for a folder that holds the text `there` of another plan than `plan`.
pub(super) fn refusal(path: &Path, there: &str, plan: &Plan) -> StudyError {
    let file = path.join(PLAN_FILE);
    // Where nothing but the content of the measured file is another, that is said.
    if let (Ok(of_folder), Some(measured)) =
        (Plan::parse(there, PLAN_FILE, &Changes::default()), file_of(plan))
        && (Plan { measured_sha256: plan.measured_sha256.clone(), ..of_folder.clone() }) == *plan
    {
        return match (of_folder.measured_sha256, plan.measured_sha256.clone()) {
            (Some(expected), Some(found)) => {
                StudyError::MeasuredChanged { file: measured, found, plan: path_name(&file), expected }
            }
            _ => StudyError::MeasuredUnknown { folder: path.to_path_buf(), file: measured },
        };
    }
    StudyError::OtherPlan { path: path.to_path_buf(), difference: difference(there, &plan.to_ron()) }
}

/// The first lines in which two plans differ.
fn difference(there: &str, asked: &str) -> String {
    let pairs = there.lines().map(Some).chain(std::iter::repeat(None));
    let asked = asked.lines().map(Some).chain(std::iter::repeat(None));
    let first = pairs.zip(asked).take_while(|pair| *pair != (None, None)).find(|(a, b)| a != b);
    let shown = |line: Option<&str>| {
        line.map_or_else(|| "nothing".into(), |line| printable(line.trim()).into_owned())
    };
    first.map_or_else(String::new, |(a, b)| format!("there: {}\nhere:  {}", shown(a), shown(b)))
}
