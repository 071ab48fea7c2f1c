//! Warnings in reports: the same words in text and in JSON.

use crate::sheet::Sheet;
use asperity_data::{Warning, grouped};
use asperity_study::trust::CountedWarning;
use serde::Serialize;

/// Adds a section with the premises that a result does not meet. Without warnings it adds nothing.
pub fn warnings_section(sheet: &mut Sheet, warnings: &[Warning]) {
    sentences_section(sheet, &warning_texts(warnings));
}

/// Adds a section with the premises that an ensemble of random profiles does not meet, each with
/// the number of profiles.
pub fn counted_section(sheet: &mut Sheet, warnings: &[CountedWarning], profiles: u64) {
    sentences_section(sheet, &counted_texts(warnings, profiles));
}

/// Returns the premises that do not hold on some of `profiles` random profiles:
/// `On 12 of 16 profiles: ` and the warning. The count is left out if the premise does not hold on
/// any profile.
pub fn counted_texts(warnings: &[CountedWarning], profiles: u64) -> Vec<String> {
    let mut texts = Vec::with_capacity(warnings.len());
    for counted in warnings {
        let text = counted.warning.to_string();
        let is_everywhere = counted.profiles == profiles;
        let share = format!(
            "On {} of {} profiles: ",
            grouped(counted.profiles),
            grouped(profiles)
        );
        texts.push(if is_everywhere { text } else { share + &text });
    }
    texts
}

/// Returns the entry `warnings` of the JSON object of an ensemble: for each premise its name, the
/// number of profiles that do not meet it, and the text of the first of them.
pub(crate) fn counted_values(warnings: &[CountedWarning]) -> Vec<CountedValue> {
    let mut values = Vec::with_capacity(warnings.len());
    for CountedWarning {
        warning, profiles, ..
    } in warnings
    {
        let text = warning.to_string();
        values.push(CountedValue {
            name: warning.name(),
            profiles: *profiles,
            text,
        });
    }
    values
}

/// A premise that some profiles do not meet, as a JSON object.
#[derive(Serialize)]
pub(crate) struct CountedValue {
    name: &'static str,
    profiles: u64,
    text: String,
}

/// Adds a section with warnings that are already sentences. Without sentences it adds nothing.
pub(crate) fn sentences_section(sheet: &mut Sheet, sentences: &[String]) {
    if sentences.is_empty() {
        return;
    }
    sheet.heading("Warnings");
    for sentence in sentences {
        sheet.paragraph(&format!("* {sentence}"));
    }
}

/// Returns the entry `warnings` of a JSON object: a text for each premise that a result does not
/// meet, and an empty list if all premises hold.
pub fn warning_texts(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(Warning::to_string).collect()
}
