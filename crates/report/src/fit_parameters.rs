//! Section of a report on the fitted parameters: their table, the modulus after a long time, and
//! the parameters at the ends of their ranges.

use crate::sheet::Sheet;
use asperity_data::{
    Note, Remedy, Wording, format_quantity, format_range, format_rounded, format_within,
};
use asperity_experiment::{FitResult, FittedParameter, Parameter, RangeEnd, Reason};

/// If the best value lies at the end of the searched range, the report proposes a range whose end
/// is farther by this factor.
const FARTHER: f64 = 1000.0;

/// Section on the parameters of a fit.
#[derive(Clone, Copy)]
pub(crate) struct ParametersSection<'a> {
    pub fit: &'a FitResult,
    /// Function that returns true for the parameters that the section lists.
    pub is_shown: fn(Parameter) -> bool,
    pub wording: Wording,
}

impl<'a> ParametersSection<'a> {
    fn shown(self) -> impl Iterator<Item = &'a FittedParameter> {
        let parameters = self.fit.parameters.iter();
        parameters.filter(move |fitted| (self.is_shown)(fitted.parameter))
    }

    /// Adds the section to the text `sheet`.
    pub fn add(self, sheet: &mut Sheet) {
        let header = ["", "value", "95 % interval", "standard error", "start"];
        let mut rows = vec![header.map(String::from)];
        for fitted in self.shown() {
            let parameter = fitted.parameter.row();
            let (low, high) = fitted.interval;
            let name = format!("{} {}", parameter.term, parameter.symbol);
            let start = format_quantity(fitted.start, parameter.unit);
            if let Some(bound) = fitted.bound() {
                let none = "-".to_owned();
                rows.push([name, bound, none.clone(), none, start]);
                continue;
            }
            rows.push([
                name,
                fitted.text(fitted.value),
                format!("{} to {}", fitted.text(low), fitted.text(high)),
                format_quantity(fitted.noise_error, parameter.unit),
                start,
            ]);
        }
        sheet.table(&rows);
        if let Some(modulus) = self.fit.relaxed_modulus {
            let (low, high) = modulus.interval;
            let text = |value: f64| format_within(value, 0.5 * (high - low), "Pa");
            let [value, low, high] = [modulus.value, low, high].map(text);
            sheet.paragraph(&format!(
                "Modulus after a long time E∞ = E* (1 − s) = {value}, {low} to {high}."
            ));
        }
        for fitted in self.shown() {
            if let Some(sentence) = self.sentence_at_end(fitted) {
                sheet.paragraph(&sentence);
            }
        }
    }

    /// Returns a sentence on a parameter whose best value lies at the end of its range. Returns
    /// `None` for any other parameter, and for a parameter that the curve does not determine at
    /// all.
    fn sentence_at_end(self, fitted: &FittedParameter) -> Option<String> {
        let end = fitted.at_end?;
        if matches!(self.fit.reason, Some(Reason::Stiffness(..))) {
            return None;
        }
        let row = fitted.parameter.row();
        let (low, high) = fitted.range;
        let (name, next) = match end {
            RangeEnd::Low => ("lower", (low / FARTHER, 2.0 * low)),
            RangeEnd::High => ("upper", (0.5 * high, high * FARTHER)),
        };
        let range = format_range(fitted.range, 3, row.unit);
        let written = |value: f64| format_rounded(value, 2, row.unit).replace([' ', '\u{a0}'], "");
        let mut sentence = format!(
            "{} is at the {name} end of its range, {range}, and is no result.",
            row.symbol
        );
        if fitted.parameter == Parameter::RelaxationTime {
            sentence += match end {
                RangeEnd::Low => " The time is shorter than the curve shows.",
                RangeEnd::High => " The time is longer than the curve shows.",
            };
        }
        let farther = format!("{}={}..{}", row.name, written(next.0), written(next.1));
        let note = Note::new(sentence).with(Remedy::FreeIn(farther));
        Some(note.in_words(self.wording))
    }
}
