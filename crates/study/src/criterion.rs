//! One criterion of adhesion: its number, its threshold, and its verdict.

use asperity_data::{Warning, format_quantity, format_rounded};
use serde::Serialize;

/// Criterion by which one theory decides whether bodies adhere without a preload. The theory
/// computes a number from the scene and compares it with a threshold.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Criterion {
    /// Name of the theory, or `this program`.
    pub name: &'static str,
    /// Symbol of the number that is compared with [`Criterion::threshold`].
    pub symbol: &'static str,
    /// Publication that states the criterion.
    pub reference: &'static str,
    /// Value of the number that is compared with [`Criterion::threshold`]; `None` if the scene does
    /// not determine this number.
    pub value: Option<f64>,
    /// Threshold with which [`Criterion::value`] is compared. It separates bodies that adhere
    /// without a preload from bodies that do not.
    pub threshold: f64,
    /// Verdict: true if the bodies adhere without a preload. `None` if the conditions of the theory
    /// are not met, or if the number alone does not decide whether the bodies adhere.
    pub sticks: Option<bool>,
    /// If [`Criterion::sticks`] is `None`, the reason why there is no verdict. Otherwise it is a
    /// remark on how [`Criterion::value`] was computed, or `None`.
    pub reason: Option<String>,
}

impl Criterion {
    /// Tabor number below which neither the theory of Johnson, Kendall and Roberts (JKR) nor the
    /// rule of Hess for the largest stretch of a spring applies.
    pub const LEAST_TABOR_NUMBER: f64 = Warning::LEAST_TABOR_NUMBER;

    /// Name of the criteria of this program, in place of the name of a theory.
    pub const THIS_PROGRAM: &str = "this program";

    /// Makes a criterion whose number is not known yet.
    pub(super) const fn new(
        name: &'static str,
        symbol: &'static str,
        reference: &'static str,
        threshold: f64,
    ) -> Criterion {
        Criterion {
            name,
            symbol,
            reference,
            value: None,
            threshold,
            sticks: None,
            reason: None,
        }
    }

    /// Returns the reason after the punctuation mark `sign`; empty if there is no reason.
    fn reason_after(&self, sign: &str) -> String {
        match &self.reason {
            Some(reason) => format!("{sign} {reason}"),
            None => String::new(),
        }
    }

    /// Returns the criterion as one line of text, with the verdict [`Criterion::sticks`] or the
    /// reason why there is no verdict.
    pub fn words(&self) -> String {
        let Some(value) = self.value else {
            return format!("{} is not known{}", self.symbol, self.reason_after(":"));
        };
        let number = format!("{} = {}", self.symbol, format_quantity(value, "1"));
        let Some(sticks) = self.sticks else {
            return number + &self.reason_after(";");
        };
        let verdict = if sticks { "adheres" } else { "does not adhere" };
        let side = if value < self.threshold {
            "below"
        } else {
            "at least"
        };
        let threshold = format_quantity((100.0 * self.threshold).round() / 100.0, "1");
        let reason = self
            .reason
            .as_ref()
            .map_or_else(String::new, |reason| format!(" ({reason})"));
        format!("{number}, {side} {threshold}: {verdict}{reason}")
    }

    /// Returns the criterion with its number and its verdict: the bodies adhere if the number is
    /// below the threshold. If a condition of the theory is not met, `refusals` contains the
    /// reason, and there is no verdict.
    pub(super) fn judge(self, value: f64, refusals: &[Option<String>]) -> Criterion {
        let refusals: Vec<&str> = refusals.iter().flatten().map(String::as_str).collect();
        let value = Some(value).filter(|value| value.is_finite());
        let sticks = value
            .filter(|_| refusals.is_empty())
            .map(|value| value < self.threshold);
        let reason =
            (!refusals.is_empty()).then(|| format!("does not hold: {}", refusals.join("; ")));
        Criterion {
            value,
            sticks,
            reason,
            ..self
        }
    }
}

/// Returns a number as text with two significant digits.
pub(super) fn number(value: f64) -> String {
    format_rounded(value, 2, "1")
}

/// Returns the reason why a theory of short-ranged attraction does not apply; `None` if the theory
/// applies.
pub(super) fn long_ranged(tabor_number: Option<f64>) -> Option<String> {
    let below = tabor_number.filter(|number| *number < Criterion::LEAST_TABOR_NUMBER)?;
    Some(format!(
        "μ {}, needs at least {}",
        number(below),
        Criterion::LEAST_TABOR_NUMBER
    ))
}
