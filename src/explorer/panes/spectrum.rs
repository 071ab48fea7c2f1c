//! Spectra over the wave number, both logarithmic: as measured, fitted, and of the line.

use super::{PaneRow, SceneSpectra};
use crate::draw::legend;
use crate::explorer::layout::inside;
use crate::explorer::model::Model;
use crate::explorer::theme::Meaning;
use crate::explorer::view::lines::draw_around;
use crate::explorer::view::plot;
use crate::explorer::view::wrap::{filled, wrapped};
use crate::scene::format_quantity;
use crate::spectrum::Estimate;
use crate::text::per_cent;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;

/// Row of the pane.
pub static ROW: PaneRow =
    PaneRow { title: |_| " Spectrum: C over q, log–log ".to_owned(), draw, ..PaneRow::EMPTY };

/// Rows of plot that make it worth drawing.
const FEWEST_PLOT_ROWS: u16 = 5;

/// Draws legend, chart and how well the moments are known, as far as there is room.
fn draw(frame: &mut Frame<'_>, area: Rect, model: &Model) {
    let area = inside(area);
    let shown = model.present().and_then(|moment| moment.spectra.as_deref());
    let quiet = model.appearance.theme.style(Meaning::Quiet);
    let chart = shown.map(|shown| shown.spectra.chart()).filter(|chart| !chart.layers.is_empty());
    let below = words(model, shown);
    let below = below.iter().flat_map(|text| wrapped(&Line::styled(text.clone(), quiet), area.width));
    let below: Vec<Line<'static>> = below.collect();
    let plot_rows = if chart.is_some() { FEWEST_PLOT_ROWS } else { 0 };
    let mut above = chart.as_ref().map_or_else(Vec::new, |chart| {
        let parts = plot::in_theme(model.appearance, |style| legend(std::slice::from_ref(chart), style));
        filled(parts, "  ", usize::from(area.width))
    });
    above.truncate(usize::from(area.height.saturating_sub(plot_rows)).saturating_sub(below.len()));
    let plot = draw_around(frame, area, (above, below), plot_rows);
    if let Some(chart) = chart {
        plot::draw_chart(frame, plot, &chart, model.appearance);
    }
}

/// Text below the chart: moments with their errors, else the reason for which there is no chart.
fn words(model: &Model, shown: Option<&SceneSpectra>) -> Vec<String> {
    let Some(shown) = shown else {
        let text = if model.is_current() { "the spectrum is being computed" } else { "no spectrum yet" };
        return vec![text.to_owned()];
    };
    let mut words: Vec<String> = shown.missing.clone().into_iter().collect();
    let governing = model.governing();
    if let (Some(moments), Some(governing)) = (shown.moments, governing) {
        let percent = |estimate: Estimate| per_cent(estimate.error / estimate.value.abs());
        let mut parts = vec![
            format!("h ± {}", percent(moments.rms_height)),
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
    if words.is_empty() && shown.spectra == crate::export::Spectra::default() {
        words.push("the profile has no roughness and no spectrum".to_owned());
    }
    words
}
