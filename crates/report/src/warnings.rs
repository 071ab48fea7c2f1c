//! Warnings in reports: the same words in text and in JSON.

use crate::sheet::Sheet;
use asperity_data::{Warning, grouped};
use asperity_study::trust::CountedWarning;

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
