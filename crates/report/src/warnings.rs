//! Warnings in reports. Text and JSON state them in the same words.

use crate::sheet::Sheet;
use asperity_data::{CountedWarning, Warning, grouped};
use asperity_scene::Outcome;
use asperity_study::Ensemble;

/// Adds a section to the text `sheet` with the premises of the model that a result does not meet.
/// Adds nothing if there are no warnings.
pub fn warnings_section(sheet: &mut Sheet, warnings: &[Warning]) {
    sentences_section(sheet, &warning_texts(warnings));
}

/// Adds a section to the text `sheet` with the premises of the model that are not met on some of
/// the random profiles. Each warning states the number of these profiles.
pub fn counted_section(sheet: &mut Sheet, warnings: &[CountedWarning], profiles: u64) {
    sentences_section(sheet, &counted_texts(warnings, profiles));
}

/// Returns texts on the premises that are not met on some of `profiles` random profiles:
/// `On 12 of 16 profiles: ` and then the warning. If no profile meets a premise, the number is left
/// out.
pub fn counted_texts(warnings: &[CountedWarning], profiles: u64) -> Vec<String> {
    texts_with_shares(warnings, profiles, "profiles")
}

/// Returns texts on the premises that are not met in some of `records` records of a study:
/// `On 12 of 16 records: ` and then the warning. If no record meets a premise, the number is left
/// out.
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

/// Puts a number before the text of a premise: `On 12 of 16 profiles: `. The number is that of the
/// profiles or records for which the premise is not met. If this is so for all of them, the text
/// stays as it is.
pub(crate) fn with_share(text: &str, count: u64, all: u64, things: &str) -> String {
    if count == all {
        return text.to_owned();
    }
    format!("On {} of {} {things}: {text}", grouped(count), grouped(all))
}

/// Returns the warnings about the results of a scene. If there are several random profiles, each
/// warning states to how many of them it applies.
pub fn outcome_warnings(outcome: &Outcome, ensemble: Option<&Ensemble>) -> Vec<String> {
    match ensemble {
        Some(ensemble) => counted_texts(&ensemble.warnings(), ensemble.profiles()),
        None => warning_texts(&outcome.warnings),
    }
}

/// Adds a section with warnings that are already sentences. Adds nothing if there are no sentences.
pub(crate) fn sentences_section(sheet: &mut Sheet, sentences: &[String]) {
    if sentences.is_empty() {
        return;
    }
    sheet.heading("Warnings");
    for sentence in sentences {
        sheet.paragraph(&format!("* {sentence}"));
    }
}

/// Returns the entry `warnings` of a JSON object, which is a list of texts. The list has a text for
/// each premise that a result does not meet, and is empty if all premises are met.
pub fn warning_texts(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(Warning::to_string).collect()
}
