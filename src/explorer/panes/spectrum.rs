//! Spectra over the wave number, both logarithmic: as measured, fitted, and of the line.

use super::{Pane, PaneRow, SceneSpectra};
use crate::draw::legend;
use crate::explorer::adhesion_spread::{AdhesionSpread, PROFILES};
use crate::explorer::app::App;
use crate::explorer::layout::inside;
use crate::explorer::study::{PaneData, Task};
use crate::explorer::theme::Meaning;
use crate::explorer::view::lines::{draw_around, draw_lines};
use crate::explorer::view::plot;
use crate::explorer::view::wrap::{filled, wrapped};
use crate::export::measured_adhesion_text;
use crate::scene::format_quantity;
use crate::spectrum::Moment;
use crate::text::per_cent;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use std::sync::Arc;

/// Row of the pane.
pub static ROW: PaneRow = PaneRow {
    title: |_| " Spectrum: C over q, log–log ".to_owned(),
    draw,
    figure: |app| {
        let spectra = &app.present()?.spectra.as_deref()?.spectra;
        Some(spectra.figure(app.edit.document.title())).filter(|figure| !figure.legend().is_empty())
    },
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

/// Fewest rows of a useful plot.
const FEWEST_PLOT_ROWS: u16 = 5;

/// Draws legend, chart and the moments with their errors, as far as there is room.
fn draw(frame: &mut Frame<'_>, area: Rect, app: &App) {
    let area = inside(area);
    let shown = app.present().and_then(|snapshot| snapshot.spectra.as_deref());
    let quiet = app.view.appearance.theme.style(Meaning::Quiet);
    let chart = shown.map(|shown| shown.spectra.chart()).filter(|chart| !chart.layers.is_empty());
    let below = words(app, shown);
    let below = below.iter().flat_map(|text| wrapped(&Line::styled(text.clone(), quiet), area.width));
    let below: Vec<Line<'static>> = below.collect();
    let Some(chart) = chart else { return draw_lines(frame, area, below) };
    let mut parts = vec![vec![Span::styled(chart.y.symbol_with_unit().to_string(), quiet)]];
    parts.extend(plot::in_theme(app.view.appearance, |style| legend(std::slice::from_ref(&chart), style)));
    let mut above = filled(parts, "  ", usize::from(area.width));
    above.truncate(
        usize::from(area.height.saturating_sub(FEWEST_PLOT_ROWS)).saturating_sub(below.len()).max(1),
    );
    let plot = draw_around(frame, area, (above, below), FEWEST_PLOT_ROWS);
    plot::draw_chart(frame, plot, &chart, app.view.appearance);
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
