//! Warnings in reports: the same words in text and in JSON.

use crate::sheet::Sheet;
use asperity_data::Warning;

/// Adds a section with the premises that a result does not meet. Without warnings it adds nothing.
pub fn warnings_section(sheet: &mut Sheet, warnings: &[Warning]) {
    sentences_section(sheet, &warning_texts(warnings));
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

/// Returns the entry `warnings` of a JSON object: a text for each premise that a result does not meet, and an empty list if all
/// premises hold.
pub fn warning_texts(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(Warning::to_string).collect()
}
