//! The pane of spectra over the wave number, on logarithmic axes: the measured spectrum, the fitted
//! spectrum and the spectrum of the profile.

use super::row::PaneRow;
use crate::explorer::app::App;
use crate::explorer::pane::Pane;
use crate::explorer::panel::Panel;
use crate::explorer::snapshot::SolvedScene;
use crate::explorer::studies::Study;
use crate::explorer::text::wrapped;
use crate::explorer::theme::Meaning;
use asperity_data::{format_quantity, per_cent};
use asperity_report::{SceneSpectra, measured_adhesion_text};
use asperity_scene::{Governing, Roughness, RunError, Scene, Solver};
use asperity_study::trust::{MeasuredAdhesion, ProfileAdhesion};
use asperity_surface::lines::read_faces;
use asperity_surface::{EquivalentLine, LineMoments, Moment};
use ratatui::layout::Size;
use ratatui::text::Line;
use std::path::Path;
use std::sync::Arc;

pub static ROW: PaneRow = PaneRow {
    panel,
    studies: |_, computed| {
        let solved = Arc::clone(computed);
        let spectra = Study::new(computed.generation, false, move |simulation, _| {
            SceneSpectra::new(&solved.scene, &solved.outcome, simulation)
        });
        vec![spectra]
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
    let mut lines = Vec::new();
    for text in words(app, shown) {
        let line = Line::styled(text, app.style(Meaning::Quiet));
        lines.extend(wrapped(&line, size.width));
    }
    let chart = shown.map(|shown| shown.spectra.chart());
    let Some(mut chart) = chart.filter(|chart| !chart.layers.is_empty()) else {
        return Panel {
            head: lines,
            ..Panel::of_text(title, "")
        };
    };
    chart.y.name.clear();
    let title = format!("{title} {}, log–log", chart.y.symbol_with_unit());
    Panel {
        foot: lines,
        ..Panel::of_chart(title, chart)
    }
}

/// Returns the texts below the chart: the moments with their errors and the pull-off force, or the
/// reason why there is no chart.
fn words(app: &App, shown: Option<&SceneSpectra>) -> Vec<String> {
    let Some(shown) = shown else {
        let text = if let Some(why) = app.studies.failure::<SceneSpectra>() {
            why
        } else if app.is_current() {
            "the spectrum is being computed"
        } else {
            "no spectrum yet"
        };
        return vec![text.to_owned()];
    };
    let mut words = Vec::new();
    words.extend(shown.missing.clone());
    if let Some(moments) = &shown.moments {
        if let Some(governing) = app.governing() {
            words.push(moments_in_words(moments, &governing));
        }
        words.extend(adhesion(app));
    }
    if words.is_empty() && shown.spectra == asperity_report::Spectra::default() {
        words.push("the profile has no roughness and no spectrum".to_owned());
    }
    words
}

/// Returns the fitted moments, and the parameters that follow from them, with their standard
/// errors.
fn moments_in_words(moments: &LineMoments, governing: &Governing) -> String {
    let mut parts = vec![
        format!("fit: h ± {}", relative_error(moments.rms_height)),
        format!("⟨∇z⟩ ± {}", relative_error(moments.rms_gradient)),
    ];
    if let Some(kappa) = governing.kappa {
        // κ² is proportional to h⟨∇z⟩, so the relative error of κ is half the relative error of
        // h⟨∇z⟩.
        let error = 0.5 * moments.height_gradient.error / moments.height_gradient.value;
        let kappa = format_quantity(kappa, "1");
        parts.push(format!("κ = {kappa} ± {}", per_cent(error)));
    }
    if let Some(ratio) = governing.elastic_energy_ratio {
        let error = relative_error(moments.energy_per_modulus);
        let ratio = format_quantity(ratio, "1");
        parts.push(format!("e_el/γ = {ratio} ± {error}"));
    }
    parts.join(" · ")
}

fn relative_error(moment: Moment) -> String {
    per_cent(moment.error / moment.value)
}

/// Returns the pull-off force with two kinds of scatter: over the random profiles, and due to the
/// fit of the spectrum. A scatter that is not computed yet is left out. `None` if the profile of
/// the scene is not the equivalent line of a measured surface.
fn adhesion(app: &App) -> Option<String> {
    if !is_sampled(&app.solved.as_ref()?.scene) {
        return None;
    }
    if let Some(why) = app.studies.failure::<MeasuredAdhesion>() {
        return Some(why.to_owned());
    }
    let sampled = app.studies.value::<MeasuredAdhesion>();
    let count = sampled.map_or(0, |sampled| sampled.profiles.len());
    let progress = if count == PROFILES {
        String::new()
    } else {
        format!(" · {count} of {PROFILES} profiles")
    };
    let force = sampled.and_then(measured_adhesion_text);
    let force = force.unwrap_or_else(|| "profiles: …".to_owned());
    Some(format!("F_a of {force}{progress}"))
}

pub const PROFILES: usize = 16;

/// Returns true if the scene has adhesion, and its profile is the equivalent line of a measured
/// surface.
fn is_sampled(scene: &Scene) -> bool {
    let is_measured = matches!(scene.roughness, Some(Roughness::Measured { .. }));
    let is_adhesive = scene.adhesion.is_some() && scene.numerics.solver == Solver::Exact;
    is_measured && is_adhesive && !scene.measured_as_line()
}

/// Returns the study (background computation) that computes the pull-off force of those random
/// profiles of a measured surface that have not been computed yet. From them follows the error due
/// to the uncertainty of the spectrum, which the results and the pane of accuracy state as well.
/// `None` for other scenes, and for many springs unless the pane of spectra is shown.
pub fn measured_adhesion(app: &App, computed: &SolvedScene) -> Option<Study> {
    let is_quick = computed.scene.numerics.points <= MeasuredAdhesion::MOST_SPRINGS;
    let is_wanted = is_quick || app.view.large == Some(Pane::Spectrum);
    if !is_wanted || !is_sampled(&computed.scene) {
        return None;
    }
    let earlier = app.studies.value::<MeasuredAdhesion>().cloned();
    let scene = Arc::clone(&computed.scene);
    Some(Study::new(
        computed.generation,
        false,
        move |_, mut control| {
            let faces = read_faces(&scene.measured_paths(Path::new("")))?;
            let line = EquivalentLine::new(&faces, &scene.measured_options())?;
            let mut found = earlier.unwrap_or_else(|| MeasuredAdhesion::new(&line));
            let first = scene.seed().unwrap_or(0);
            while found.profiles.len() < PROFILES {
                let seed = first.wrapping_add(found.profiles.len() as u64);
                let profile = ProfileAdhesion::solve(&scene, &line, seed, control.stop())?;
                found.profiles.push(profile);
                control.report(&found);
            }
            Ok::<_, RunError>(found)
        },
    ))
}
