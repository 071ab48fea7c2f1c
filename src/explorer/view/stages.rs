//! Stages of the scene with their times; skipped ones are dimmed.

use super::text::filled;
use crate::explorer::app::App;
use crate::explorer::theme::Meaning;
use crate::scene::format_rounded;
use crate::simulation::{Plan, Stage, Timings};
use ratatui::text::{Line, Span};

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

/// Name of a part of the run, and its time unless the scene skips it.
type Timed = (&'static str, Option<String>);

/// Times of the present scene, and its parts.
fn parts(app: &App) -> Option<(&Timings, [Timed; PARTS.len()])> {
    let computed = app.current()?;
    let (plan, timings) = (Plan::of(&computed.scene), &computed.outcome.timings);
    let part = |Part { name, stages, seconds }: Part| {
        let ran = stages.is_empty() || stages.iter().any(|stage| plan.runs(*stage));
        let is_stepwise = name == "passes" && plan.runs(Stage::Relaxation);
        let time = ran.then(|| format_rounded(seconds(timings), 2, "s"));
        (if is_stepwise { "steps" } else { name }, time)
    };
    Some((timings, PARTS.map(part)))
}

/// The stages in as many lines as needed, as far as there is room.
pub fn strip(app: &App, width: u16, rows: usize) -> Vec<Line<'static>> {
    let Some((timings, stages)) = parts(app) else { return Vec::new() };
    let (theme, with_times) = (app.view.appearance.theme, app.view.shows_times);
    let total =
        if with_times { format!(" {}", format_rounded(timings.total(), 2, "s")) } else { String::new() };
    let mut parts = vec![vec![Span::styled(format!("ran{total}:"), theme.style(Meaning::Quiet))]];
    parts.extend(stages.into_iter().map(|(name, time)| match time {
        Some(time) if with_times => {
            vec![Span::raw(format!("{name} ")), Span::styled(time, theme.style(Meaning::Title))]
        }
        Some(_) => vec![Span::raw(name)],
        None => vec![Span::styled(format!("{name} skipped"), theme.style(Meaning::Quiet))],
    }));
    let mut lines = filled(parts, "  ", usize::from(width));
    lines.truncate(rows);
    lines
}
