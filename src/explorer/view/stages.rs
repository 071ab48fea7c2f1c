//! Stages of the scene with their times; skipped ones are dimmed.

use super::text::filled;
use crate::explorer::app::App;
use crate::explorer::theme::Meaning;
use crate::scene::format_rounded;
use crate::simulation::{Plan, Stage, Timings};
use ratatui::text::{Line, Span};

/// A timed part of a run.
struct Part {
    name: &'static str,
    /// Its stages, any of which needs the part. Line and curve always run.
    stages: &'static [Stage],
    seconds: fn(&Timings) -> f64,
}

const PARTS: [Part; 5] = [
    Part { name: "profile", stages: &[], seconds: |timings| timings.line },
    Part { name: "tree", stages: &[Stage::Tree], seconds: |timings| timings.tree },
    Part {
        name: "passes",
        stages: &[Stage::LoadingPass, Stage::UnloadingPass, Stage::Relaxation],
        seconds: |timings| timings.passes,
    },
    Part { name: "curve", stages: &[], seconds: |timings| timings.curve },
    Part { name: "F_a(0)", stages: &[Stage::ZeroLoadAdhesion], seconds: |timings| timings.zero_load },
];

/// Names and times of the parts that ran.
pub fn times(app: &App) -> Vec<(&'static str, String)> {
    let Some(computed) = app.current() else { return Vec::new() };
    let plan = Plan::of(&computed.scene);
    let ran = PARTS.iter().filter(|part| part.runs(&plan));
    ran.map(|part| (part.name(&plan), part.time(&computed.outcome.timings))).collect()
}

impl Part {
    fn runs(&self, plan: &Plan) -> bool {
        self.stages.is_empty() || self.stages.iter().any(|stage| plan.runs(*stage))
    }

    fn name(&self, plan: &Plan) -> &'static str {
        if plan.runs(Stage::Relaxation) && self.name == "passes" { "steps" } else { self.name }
    }

    fn time(&self, timings: &Timings) -> String {
        format_rounded((self.seconds)(timings), 2, "s")
    }
}

/// The stages in as many lines as needed, as far as there is room.
pub fn strip(app: &App, width: u16, rows: usize) -> Vec<Line<'static>> {
    let Some(computed) = app.current() else { return Vec::new() };
    let theme = app.view.appearance.theme;
    let plan = Plan::of(&computed.scene);
    let timings = &computed.outcome.timings;
    let total = format_rounded(timings.total(), 2, "s");
    let ran = if app.view.shows_times { format!("ran {total}:") } else { "ran:".to_owned() };
    let mut parts: Vec<Vec<Span<'static>>> = vec![vec![Span::styled(ran, theme.style(Meaning::Quiet))]];
    for part in PARTS {
        let name = part.name(&plan);
        parts.push(match part.runs(&plan) {
            true if app.view.shows_times => {
                let time = part.time(timings);
                vec![Span::raw(format!("{name} ")), Span::styled(time, theme.style(Meaning::Title))]
            }
            true => vec![Span::raw(name)],
            false => vec![Span::styled(format!("{name} skipped"), theme.style(Meaning::Quiet))],
        });
    }
    let mut lines = filled(parts, "  ", usize::from(width));
    lines.truncate(rows);
    lines
}
