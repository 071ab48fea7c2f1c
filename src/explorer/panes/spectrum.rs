//! Spectra over the wave number, both logarithmic: as measured, fitted, and of the line.

use super::{Pane, PaneRow, SceneSpectra};
use crate::explorer::adhesion_spread::{AdhesionSpread, PROFILES};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::{Panel, names};
use crate::explorer::study::{PaneData, Task};
use crate::explorer::theme::Meaning;
use crate::explorer::view::text::{filled, wrapped};
use crate::export::measured_adhesion_text;
use crate::scene::format_quantity;
use crate::spectrum::Moment;
use crate::text::per_cent;
use ratatui::layout::Size;
use ratatui::text::Line;
use std::sync::Arc;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    panel,
    keys: Some(Context::Crosshair),
    needs_spectra: true,
    task: |app, computed| {
        let begun = app.studies.adhesion_spread.clone();
        let spread = begun.or_else(|| AdhesionSpread::new(computed).map(Arc::new));
        let spread = spread.filter(|one| !one.is_whole());
        spread.map(|spread| Task::Extend { data: PaneData::Adhesion(spread), waits: app.studies.edited })
    },
    take_in: |app, data| {
        if let PaneData::Adhesion(spread) = data {
            app.studies.adhesion_spread = Some(spread);
        }
    },
    renew: |app| app.studies.adhesion_spread = None,
    help: &[(
        "Spectrum",
        "Q: power spectrum C over the wave number q, both logarithmic; below it, for a measured surface, rms height h, rms \
         slope ⟨∇z⟩ and κ or e_el/γ with their standard errors, and the adhesion force F_a over random profiles",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, size: Size) -> Panel {
    let title = "Spectrum: C over q, log–log".to_owned();
    let shown = app.present().and_then(|snapshot| snapshot.spectra.as_deref());
    let quiet = app.view.appearance.theme.style(Meaning::Quiet);
    let words = words(app, shown).into_iter();
    let words = words.flat_map(|text| wrapped(&Line::styled(text, quiet), size.width)).collect();
    let chart = shown.map(|shown| shown.spectra.chart()).filter(|chart| !chart.layers.is_empty());
    let Some(mut chart) = chart else { return Panel { head: words, ..Panel::of_text(title, "") } };
    // The title has the names of both axes.
    chart.y.label = chart.y.label.without_name();
    let head = filled(names(&chart, app.view.appearance), "  ", size.width.into());
    Panel { head, foot: words, ..Panel::of_chart(title, chart) }
}

/// Text below the chart: moments with their errors, else the reason why there is no chart.
fn words(app: &App, shown: Option<&SceneSpectra>) -> Vec<String> {
    let Some(shown) = shown else {
        let text = if app.is_current() { "the spectrum is being computed" } else { "no spectrum yet" };
        return vec![text.to_owned()];
    };
    let mut words: Vec<String> = shown.missing.clone().into_iter().collect();
    let governing = app.governing();
    if let (Some(moments), Some(governing)) = (shown.moments, governing) {
        let percent = |moment: Moment| per_cent(moment.error / moment.value);
        let mut parts = vec![
            format!("fit: h ± {}", percent(moments.rms_height)),
            format!("⟨∇z⟩ ± {}", percent(moments.rms_gradient)),
        ];
        if let Some(kappa) = governing.kappa {
            // κ² is proportional to h⟨∇z⟩.
            let error = per_cent(0.5 * moments.height_gradient.error / moments.height_gradient.value);
            parts.push(format!("κ = {} ± {error}", format_quantity(kappa, "1")));
        }
        if let Some(ratio) = governing.elastic_energy_ratio {
            let error = percent(moments.energy_per_modulus);
            parts.push(format!("e_el/γ = {} ± {error}", format_quantity(ratio, "1")));
        }
        words.push(parts.join(" · "));
    }
    if shown.moments.is_some() {
        words.extend(adhesion(app));
    }
    if words.is_empty() && shown.spectra == crate::export::Spectra::default() {
        words.push("the profile has no roughness and no spectrum".to_owned());
    }
    words
}

/// Adhesion force with its spread over random profiles beside that of the fit, as far as computed.
fn adhesion(app: &App) -> Option<String> {
    let none = || AdhesionSpread::new(app.solved.as_ref()?).map(Arc::new);
    let spread = app.studies.adhesion_spread.clone().or_else(none)?;
    if let Some(why) = app.studies.failures.get(&Pane::Spectrum) {
        return Some(why.clone());
    }
    let goes_on = match spread.found.profiles.len() {
        PROFILES => String::new(),
        count => format!(" · {count} of {PROFILES} profiles"),
    };
    let force = measured_adhesion_text(&spread.found).unwrap_or_else(|| "profiles: …".to_owned());
    Some(format!("F_a of {force}{goes_on}"))
}
