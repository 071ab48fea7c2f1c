//! Words for the ratio of the results of profiles and of three dimensions, for the difference that
//! follows from it, and for the error of the model.

use crate::words::percent;
use asperity_data::{format_rounded, grouped};
use asperity_study::half_space::{Compared, Reference};

/// Returns a sentence on the ratio of two means, and a sentence on the error of the model that
/// follows from this ratio. The ratio is the mean pull-off force over random profiles divided by
/// the mean pull-off force in three dimensions. Without adhesion, it is the ratio of the mean
/// indentations. Returns `None` if the ratio is unknown.
pub fn model_sentence(reference: &Reference) -> Option<String> {
    let ratio = ratio(reference.headline()?);
    let quantity = if reference.pull_off_force.is_some() {
        "the pull-off force"
    } else {
        "the indentation"
    };
    let waves = omitted_waves(reference);
    let error = error_sentence(reference);
    Some(format!(
        "The mean of {quantity} over random profiles is {ratio} times the mean over random squares in three dimensions{waves}. {error}"
    ))
}

/// Returns a sentence on the error of the model.
fn error_sentence(reference: &Reference) -> String {
    if reference.line_is_exact {
        return "The model is exact for this body, so that the difference is an error of the grid of the squares."
            .to_owned();
    }
    match reference.budget.model {
        Some(model) if model > 0.0 => {
            let error = percent(model, 2);
            let waves = omitted_waves(reference);
            format!(
                "The error of the model, at least {error}{waves}, remains with any number of springs."
            )
        }
        Some(_) => "Sample and grid of the squares can explain the difference.".to_owned(),
        None => "The error of the model is not known.".to_owned(),
    }
}

/// Returns in words the relative difference between the results with profiles and in three
/// dimensions, with its 95 % interval: `profile against three dimensions, +4 ± 45 %`. The results
/// in three dimensions belong to random square surfaces. If these surfaces lack waves of the scene,
/// the words also state which waves are compared. Returns `None` if the difference is unknown.
pub fn difference_words(reference: &Reference) -> Option<String> {
    let compared = reference.headline()?;
    let sign = if compared.difference() > 0.0 { "+" } else { "" };
    let difference = format_rounded(100.0 * compared.difference(), 2, "1");
    let error = match compared.error {
        Some(error) => format!(" ± {}", percent(error, 2)),
        None => " %".to_owned(),
    };
    let waves = omitted_waves(reference);
    Some(format!(
        "profile against three dimensions, {sign}{difference}{error}{waves}"
    ))
}

/// Returns the error of the model in words. It is the part of the difference between profiles and
/// three dimensions that the errors of the sample and of the grid do not explain.
pub fn model_words(reference: &Reference) -> String {
    if reference.line_is_exact {
        return "none: the profile is exact for this body of revolution".to_owned();
    }
    match reference.budget.model {
        Some(model) if model > 0.0 => {
            let error = percent(model, 2);
            let waves = omitted_waves(reference);
            format!("at least {error}, beyond sample and grid{waves}")
        }
        Some(_) => "not distinguished from sample and grid".to_owned(),
        None if reference.budget.grid.is_none() => {
            "not known, because the error of the grid is not known".to_owned()
        }
        None => "not known, because the error of the sample is not known".to_owned(),
    }
}

/// Returns in words which waves are compared if the square surfaces of the model in three
/// dimensions lack waves of the scene; otherwise an empty text. The waves are given by their
/// numbers of periods over the length, for example `, of waves 4 to 8 of 4 to 3 200`.
pub fn omitted_waves(reference: &Reference) -> String {
    let (Some((first, last)), Some(last_of_scene)) = (reference.waves, reference.omitted) else {
        return String::new();
    };
    let first = grouped(first);
    let last = grouped(last);
    let last_of_scene = grouped(last_of_scene);
    format!(", of waves {first} to {last} of {first} to {last_of_scene}")
}

pub(super) fn percent_or_unknown(share: Option<f64>) -> String {
    share.map_or_else(|| "not known".to_owned(), |share| percent(share, 2))
}

/// Returns the ratio of the results of the two models, with the half-width of its 95 % interval, as
/// text: `0.84 ± 0.05`.
pub(super) fn ratio(compared: &Compared) -> String {
    let ratio = decimals(compared.ratio);
    match compared.error {
        Some(error) => format!("{ratio} ± {}", decimals(error)),
        None => ratio,
    }
}

fn decimals(value: f64) -> String {
    if value < 10.0 {
        format!("{value:.2}")
    } else {
        format_rounded(value, 2, "1")
    }
}
