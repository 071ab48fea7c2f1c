//! Warnings in reports, with the same words in text and in JSON.

use crate::sheet::Sheet;
use asperity_data::{CountedWarning, Warning, grouped};

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
    texts_with_shares(warnings, profiles, "profiles")
}

/// Returns the premises that do not hold for some of `records` records of a study:
/// `On 12 of 16 records: ` and the warning, as [`counted_texts`] does for profiles.
pub fn counted_record_texts(warnings: &[CountedWarning], records: u64) -> Vec<String> {
    texts_with_shares(warnings, records, "records")
}

fn texts_with_shares(warnings: &[CountedWarning], all: u64, things: &str) -> Vec<String> {
    let mut texts = Vec::with_capacity(warnings.len());
    for counted in warnings {
        let text = counted.warning.to_string();
        texts.push(with_share(&text, counted.profiles, all, things));
    }
    texts
}

/// Puts the number of profiles or records on which a premise does not hold before the text of the
/// premise: `On 12 of 16 profiles: `. If the premise holds on no profile or record, nothing is put
/// before its text.
pub(crate) fn with_share(text: &str, count: u64, all: u64, things: &str) -> String {
    if count == all {
        return text.to_owned();
    }
    format!("On {} of {} {things}: {text}", grouped(count), grouped(all))
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
