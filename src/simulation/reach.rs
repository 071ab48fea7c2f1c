//! Forces that a contact does not reach or is not to reach, in words, with the nearest force within reach.

use crate::contact::ContactError;
use crate::scene::{Move, format_quantity};
use crate::text::round_to;

/// Largest force over that at full contact: beyond full contact the curve is a straight line.
const MOST_OVER_FULL_CONTACT: f64 = 10.0;

/// Largest force for a force at full contact, N; any where nothing separates the springs.
pub fn largest_force(full_contact: f64) -> f64 {
    if full_contact > 0.0 { MOST_OVER_FULL_CONTACT * full_contact } else { f64::INFINITY }
}

/// Reason against a force far beyond that at full contact and a force that was reached before, N.
pub fn beyond_full_contact(force: f64, full_contact: f64, reached: f64) -> Option<String> {
    let largest = MOST_OVER_FULL_CONTACT * full_contact.max(reached);
    let [force_text, full, most] =
        [force, full_contact, -rounded_up(-largest)].map(|force| format_quantity(force, "N"));
    let why = || format!("{force_text} is far beyond full contact at {full}; allowed: at most {most}");
    (force > largest).then(why)
}

/// Reason for which a body does not move to a target, with forces rounded into the allowed range.
pub fn out_of_reach(error: &ContactError, target: Move) -> String {
    match (error, target) {
        (ContactError::Stage { index, target, reason }, _) => {
            format!("stage {}: {}", index + 1, out_of_reach(reason, *target))
        }
        (ContactError::DetachesBefore { smallest }, Move::ToForce(force)) => {
            let [force, least] = [force, rounded_up(*smallest)].map(|force| format_quantity(force, "N"));
            format!("the contact detaches before {force}; smallest force within reach: {least}")
        }
        (error, _) => error.to_string(),
    }
}

/// The nearest number of four digits not below a value.
pub(super) fn rounded_up(value: f64) -> f64 {
    let nearest = round_to(value, 4);
    let last_digit = 10.0_f64.powi((value.abs().log10().floor() as i32).saturating_sub(3));
    if nearest >= value { nearest } else { round_to(value + last_digit, 4) }
}
