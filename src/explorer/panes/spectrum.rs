//! Spectra over the wave number, both logarithmic: as measured, as fitted, and of the line.

use super::row::PaneRow;
use crate::explorer::app::App;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::wrapped;
use crate::explorer::theme::Meaning;
use asperity_data::{format_quantity, per_cent};
use asperity_report::{SceneSpectra, measured_adhesion_text};
use asperity_scene::{Roughness, RunError, Scene, Solver};
use asperity_study::trust::{MeasuredAdhesion, ProfileAdhesion};
use asperity_surface::lines::read_faces;
use asperity_surface::{EquivalentLine, Moment};
use ratatui::layout::Size;
use ratatui::text::Line;
use std::path::Path;
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel,
    studies: |app, computed| {
        let solved = Arc::clone(computed);
        let spectra = Study::new(computed.generation, false, move |simulation, _| {
            SceneSpectra::new(&solved.scene, &solved.outcome, simulation)
        });
        let profiles = is_sampled(&computed.scene).then(|| profiles(app, computed));
        [spectra].into_iter().chain(profiles).collect()
    },
    help: &[(
        "Spectrum",
        "key Q: power spectrum C over the wave number q; for a measured surface also h, ⟨∇z⟩ and κ or e_el/γ with their \
         standard errors",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, size: Size) -> Panel {
    let title = "Spectrum".to_owned();
    let shown = app.studies.value::<SceneSpectra>();
    let quiet = app.view.appearance.theme.style(Meaning::Quiet);
    let words = words(app, shown).into_iter();
    let words = words
        .flat_map(|text| wrapped(&Line::styled(text, quiet), size.width))
        .collect();
    let chart = shown
        .map(|shown| shown.spectra.chart())
        .filter(|chart| !chart.layers.is_empty());
    let Some(mut chart) = chart else {
        return Panel {
            head: words,
            ..Panel::of_text(title, "")
        };
    };
    chart.y.name.clear();
    let title = format!("{title} {}, log–log", chart.y.symbol_with_unit());
    Panel {
        foot: words,
        ..Panel::of_chart(title, chart)
    }
}

/// Text below the chart: moments with their errors, or the reason why there is no chart.
fn words(app: &App, shown: Option<&SceneSpectra>) -> Vec<String> {
    let Some(shown) = shown else {
        let text = if app.is_current() {
            "the spectrum is being computed"
        } else {
            "no spectrum yet"
        };
        return vec![
            app.studies
                .failure::<SceneSpectra>()
                .unwrap_or(text)
                .to_owned(),
        ];
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
            let error =
                per_cent(0.5 * moments.height_gradient.error / moments.height_gradient.value);
            parts.push(format!("κ = {} ± {error}", format_quantity(kappa, "1")));
        }
        if let Some(ratio) = governing.elastic_energy_ratio {
            let error = percent(moments.energy_per_modulus);
            parts.push(format!(
                "e_el/γ = {} ± {error}",
                format_quantity(ratio, "1")
            ));
        }
        words.push(parts.join(" · "));
    }
    if shown.moments.is_some() {
        words.extend(adhesion(app));
    }
    if words.is_empty() && shown.spectra == asperity_report::Spectra::default() {
        words.push("the profile has no roughness and no spectrum".to_owned());
    }
    words
}

/// Adhesion force with its spread over random profiles and with the spread due to the fit, as far
/// as computed.
fn adhesion(app: &App) -> Option<String> {
    if !is_sampled(&app.solved.as_ref()?.scene) {
        return None;
    }
    if let Some(why) = app.studies.failure::<MeasuredAdhesion>() {
        return Some(why.to_owned());
    }
    let found = app.studies.value::<MeasuredAdhesion>();
    let goes_on = match found.map_or(0, |found| found.profiles.len()) {
        PROFILES => String::new(),
        count => format!(" · {count} of {PROFILES} profiles"),
    };
    let force = found
        .and_then(measured_adhesion_text)
        .unwrap_or_else(|| "profiles: …".to_owned());
    Some(format!("F_a of {force}{goes_on}"))
}

pub const PROFILES: usize = 16;

/// Returns true if the profile of a scene is an equivalent line with adhesion.
fn is_sampled(scene: &Scene) -> bool {
    let is_measured = matches!(scene.roughness, Some(Roughness::Measured { .. }));
    let adheres = scene.adhesion.is_some() && scene.numerics.solver == Solver::Exact;
    is_measured && adheres && !scene.measured_as_line()
}

/// Computes the adhesion force of the random profiles that are not computed yet.
fn profiles(app: &App, computed: &SolvedScene) -> Study {
    let mut found = app
        .studies
        .value::<MeasuredAdhesion>()
        .cloned()
        .unwrap_or_default();
    let scene = Arc::clone(&computed.scene);
    Study::new(computed.generation, false, move |_, mut control| {
        let faces = read_faces(&scene.measured_paths(Path::new("")))?;
        let line = EquivalentLine::new(&faces, &scene.measured_options())?;
        let first = scene.seed().unwrap_or(0);
        while found.profiles.len() < PROFILES {
            let seed = first.wrapping_add(found.profiles.len() as u64);
            let profile = ProfileAdhesion::solve(&scene, &line, seed, control.stop())?;
            found.profiles.push(profile);
            control.report(&found);
        }
        Ok::<_, RunError>(found)
    })
}
