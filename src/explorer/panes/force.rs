//! The force curve: the hysteresis loop with loading and unloading, curves compared with it, and
//! manual loading.

use super::row::{Exported, PaneRow, outcome};
use crate::explorer::app::App;
use crate::explorer::caption::caption;
use crate::explorer::ghost::Ghost;
use crate::explorer::measured::{Measured, fitted};
use crate::explorer::panel::{Body, Panel, meaning};
use crate::explorer::theme::Meaning;
use asperity_contact::{CurvePoint, Direction, Mark};
use asperity_data::{AxisScale, format_rounded, grouped, quantile};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Name, Shape, Sign, Span, Stroke};
use asperity_report::{
    FitReport, ForceLoop, LoopQuantities, LoopUnits, Report, counted, force_figure, letter,
    loop_chart,
};
use asperity_scene::Governing;
use asperity_scene::text::quoted;
use asperity_study::half_space::SquareLoops;
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::f64::consts::PI;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| match fit_report(app) {
        Some(report) => report.figure(),
        None if app.manual.is_none() && !app.ghosts.is_empty() => compared(app),
        None => Some(Figure::of_chart(app.edit.document.title(), chart(app)?)),
    },
    report: |app| fit(app).or_else(|| outcome(app)),
    help: &[(
        "Curve",
        "force F over the indentation d: dotted on loading, solid on unloading; ◇ jump-in, ▲ preload, ▼ pull-off, ◆ \
         present state. Curves with letters are ghosts; dashes show manual loading; dots are a measured curve, with \
         its residuals below",
    )],
    ..PaneRow::EMPTY
};

/// The measured curve with the model and the residuals; `None` without a measured curve.
fn fit_report(app: &App) -> Option<FitReport<'_>> {
    let Measured { name, curve, .. } = app.edit.measured.as_ref()?;
    Some(FitReport {
        title: name,
        curve,
        fit: fitted(&app.studies).filter(|_| app.is_current())?,
    })
}

/// The curves of the kept scenes and of the present one, by their titles, or by what differs where
/// it is the same scene or the titles are the same.
fn compared(app: &App) -> Option<Figure> {
    let present = &app.edit.document;
    let mut names: Vec<String> = Vec::new();
    for ghost in &app.ghosts {
        let kept = &ghost.document;
        let is_same = kept.name() == present.name() || kept.title() == present.title();
        names.push(if is_same {
            differences(app, ghost)
        } else {
            kept.title().to_owned()
        });
    }
    names.push(present.title().to_owned());
    let outcomes = app
        .ghosts
        .iter()
        .map(|ghost| &*ghost.outcome)
        .chain([&app.current()?.outcome]);
    Some(force_figure(
        &names
            .iter()
            .map(String::as_str)
            .zip(outcomes)
            .collect::<Vec<_>>(),
        units(app),
    ))
}

/// The report of the measured curve, with the command that computes the fit.
fn fit(app: &App) -> Exported<'_> {
    let (report, options) = (fit_report(app)?, &app.edit.measured.as_ref()?.options);
    let names: Vec<_> = report
        .fit
        .parameters
        .iter()
        .map(|one| one.parameter.name())
        .collect();
    let command = format!(
        "asperity fit {}{options} --free={}",
        quoted(report.title),
        names.join(",")
    );
    Some((command.into(), Box::new(report)))
}

/// Smallest number of rows of a pane that lists the kept scenes.
const WITH_GHOSTS: u16 = 12;

fn panel(app: &App, size: Size) -> Panel {
    let Some(chart) = shown_chart(app) else {
        let reason = if app.is_computing() {
            "computing…"
        } else {
            "no curve"
        };
        return Panel::of_text(title(app, None), reason);
    };
    let (theme, units) = (app.view.appearance.theme, units(app));
    let (mut head, mut names) = (Vec::new(), Vec::new());
    if app.is_current() {
        let mut marks = Mark::all(app.legs());
        marks.retain(|(mark, _)| units.shows(*mark));
        // The most important first.
        marks.sort_by_key(|(mark, _)| {
            [Mark::PullOff, Mark::Preload, Mark::JumpIn]
                .iter()
                .position(|one| one == mark)
                .unwrap_or(3)
        });
        for (mark, point) in marks {
            let (name, force) = (
                mark.name(),
                units.force_in_words(app.without_rounding(point.force)),
            );
            let texts = vec![format!("{name} {force}"), force, name.to_owned()];
            names.push(Name {
                at: vec![units.place(&point)],
                texts,
                ink: Ink::Text,
            });
        }
    }
    for (number, ghost) in app.ghosts.iter().enumerate().rev() {
        let force = adhesion(app, ghost).map_or_else(String::new, |force| format!(" {force} ·"));
        let ink = Ink::Compared(number);
        let line = format!("{}:{force} {}", letter(number), differences(app, ghost));
        // The curve keeps the larger part of the pane.
        if size.height >= WITH_GHOSTS && head.len() < usize::from(size.height / 4) {
            head.push(Line::styled(line, theme.style(meaning(ink))));
        }
        let at = marked(ghost).iter().map(|at| units.place(at)).collect();
        names.push(Name {
            at,
            texts: vec![letter(number)],
            ink,
        });
    }
    let below = residuals(app, &chart.x);
    let sign = Text::styled("◆ ", theme.style(Meaning::Cursor));
    let share = app
        .adhesion_share_in_words()
        .map(|share| vec![Text::raw(share)]);
    let edge = state(app).into_iter().enumerate().map(|(number, text)| {
        let sign = (number == 0).then(|| sign.clone());
        sign.into_iter().chain([Text::raw(text)]).collect()
    });
    let mut panel = Panel {
        head,
        edge: share.into_iter().chain(edge).collect(),
        ..Panel::of_chart(title(app, Some(&chart.y)), chart)
    };
    if let Body::Chart(plot) = &mut panel.body {
        (plot.names, plot.below) = (names, below);
    }
    panel
}

/// The shown state in words, the most important first: indentation, force and contact, and under
/// manual loading what the last move changed. E* l is the stiffness with fixed edges (Popov and
/// Filippov 2012, eq. (1)), p_m the mean pressure on a circle with the radius of the contact.
fn state(app: &App) -> Vec<String> {
    let (Some(snapshot), Some(computed)) = (app.present(), app.solved.as_ref()) else {
        return Vec::new();
    };
    let (outcome, point, units) = (&computed.outcome, snapshot.point, units(app));
    let force = app.without_rounding(point.force);
    let mut parts = vec![
        format!("d {}", format_rounded(point.indentation, 3, "m")),
        format!("F {}", units.force_in_words(force)),
    ];
    match &app.manual {
        Some(state) => {
            parts.push(format!("{} changed", counted(state.changed, "spring")));
            parts.push(format!(
                "released {}",
                format_rounded(state.released_energy, 2, "J")
            ));
        }
        None => {
            let percent = 100.0 * point.contact_length / outcome.line.length;
            parts.push(format!("contact {} %", format_rounded(percent, 2, "1")));
        }
    }
    let patches = if point.fragments == 1 {
        "patch"
    } else {
        "patches"
    };
    parts.push(format!("{} {patches}", grouped(point.fragments)));
    let stiffness = outcome.governing.effective_modulus * point.contact_length;
    parts.push(format!("E*l {}", format_rounded(stiffness, 2, "N/m")));
    let radius = snapshot.contact_radius;
    if radius > 0.0 {
        parts.push(format!(
            "p_m {}",
            format_rounded(force / (PI * radius * radius), 2, "Pa")
        ));
    }
    parts
}

/// Name of the vertical quantity with its unit, and the event at the shown state.
fn title(app: &App, y: Option<&ChartAxis>) -> String {
    let name = match app.view.curve.quantities {
        LoopQuantities::ForceIndentation | LoopQuantities::ForceDisplacement => "Force",
        LoopQuantities::LengthForce => "Contact length",
        LoopQuantities::FragmentsIndentation => "Contact patches",
    };
    let name = y.map_or_else(
        || name.to_owned(),
        |y| format!("{name} {}", y.symbol_with_unit()),
    );
    let loss =
        if app.view.curve.loss && app.view.curve.quantities == LoopQuantities::ForceIndentation {
            match app
                .solved
                .as_ref()
                .and_then(|computed| computed.outcome.figures.dissipated_energy)
            {
                Some(energy) => {
                    let number = app
                        .solved
                        .as_ref()
                        .and_then(|computed| computed.outcome.tabor_number);
                    let number = number.map_or_else(String::new, |number| {
                        let is_low = number < Governing::LEAST_TABOR_NUMBER;
                        let low = if is_low {
                            format!(" < {}", Governing::LEAST_TABOR_NUMBER)
                        } else {
                            String::new()
                        };
                        format!(", Tabor μ {}{low}", format_rounded(number, 3, "1"))
                    });
                    format!(" · ΔW {}{number}", format_rounded(energy, 3, "J"))
                }
                None => " · ΔW open".to_owned(),
            }
        } else {
            String::new()
        };
    let event = match caption(app) {
        _ if app.is_computing() => " · computing".to_owned(),
        Some(event) => format!(" · {event}"),
        None => String::new(),
    };
    format!("{name}{loss}{event}")
}

fn units(app: &App) -> LoopUnits {
    let quantities = app.view.curve.quantities;
    match app.solved.as_ref() {
        Some(computed) => {
            LoopUnits::of_scene(quantities, &computed.outcome, app.view.curve.normalised)
        }
        None => LoopUnits::si(quantities),
    }
}

/// Indentation at a number on the horizontal axis, m; `None` if that axis does not determine it.
pub fn indentation_at(app: &App, x: f64) -> Option<f64> {
    app.indentations().and(units(app).indentation(x))
}

/// Name of the measured points in the legend.
const MEASURED: &str = "measured";

/// The residuals of the measured curve over this horizontal axis, in units of the noise; without
/// points until they are computed, and `None` without a curve or an axis of the force.
fn residuals(app: &App, x: &ChartAxis) -> Option<Chart> {
    let units = units(app);
    let measured = app.edit.measured.as_ref().filter(|_| units.shows_force())?;
    let fit = fitted(&app.studies).filter(|_| app.is_current());
    let residuals: Vec<f64> = fit.map_or_else(Vec::new, |fit| measured.residuals(&fit.model));
    let points = measured.points(stiffness(app)?);
    let points: Vec<_> = points
        .iter()
        .zip(&residuals)
        .map(|(point, residual)| (units.place(point).0, *residual))
        .collect();
    let half = half_range(residuals);
    let y = ChartAxis::new(
        AxisScale::Linear,
        Span {
            low: -half,
            high: half,
        },
        "residual over noise",
        "",
        "1",
    );
    let dots = Layer::unnamed(Ink::Kept, Shape::signs(points, Sign::Point));
    Some(Chart::new(
        x.clone(),
        y,
        vec![Layer::unnamed(Ink::Quiet, Shape::Level(0.0)), dots],
    ))
}

/// Share of the residuals in the range of their strip; the few others, as at a jump of the contact,
/// are at its edge.
const IN_RANGE: f64 = 0.98;

/// The smallest of 5, 10, 20, 50 and so on that is as large as nearly all residuals.
fn half_range(mut residuals: Vec<f64>) -> f64 {
    residuals
        .iter_mut()
        .for_each(|residual| *residual = residual.abs());
    residuals.sort_by(f64::total_cmp);
    let most = quantile(&residuals, IN_RANGE).unwrap_or(0.0);
    let steps = (0..12).flat_map(|power| [5.0, 10.0, 20.0].map(|step| step * 10_f64.powi(power)));
    steps.into_iter().find(|step| *step >= most).unwrap_or(most)
}

/// Stiffness of the instrument of the shown scene, N/m; `None` before a scene is computed.
fn stiffness(app: &App) -> Option<f64> {
    let outcome = &app.solved.as_ref()?.outcome;
    Some(
        outcome
            .instrument
            .map_or(f64::INFINITY, |instrument| instrument.stiffness),
    )
}

/// The chart without the names that the pane writes elsewhere: of marks, kept scenes and axes.
fn shown_chart(app: &App) -> Option<Chart> {
    let mut chart = chart(app)?.with_symbols();
    if let Some(snapshot) = app.present() {
        let (x, y) = units(app).place(&snapshot.point);
        let at = (
            x.clamp(chart.x.span.low, chart.x.span.high),
            y.clamp(chart.y.span.low, chart.y.span.high),
        );
        chart.layers.push(Layer::unnamed(
            Ink::Cursor,
            Shape::signs(vec![at], Sign::Diamond),
        ));
    }
    for layer in chart
        .layers
        .iter_mut()
        .filter(|layer| matches!(layer.ink, Ink::Text | Ink::Compared(_)))
    {
        layer.name = Label::default();
    }
    Some(chart)
}

/// The loop, curves compared with it, the path of manual loading, and marks.
fn chart(app: &App) -> Option<Chart> {
    app.indentations()?;
    let units = units(app);
    let unmarked = |outcome| ForceLoop {
        marks: Vec::new(),
        ..ForceLoop::of_outcome(outcome)
    };
    let ghosts = app
        .ghosts
        .iter()
        .enumerate()
        .map(|(number, ghost)| ForceLoop {
            name: Some(Label::plain(&format!(
                "{}: {}",
                letter(number),
                differences(app, ghost)
            ))),
            ink: Some(Ink::Compared(number)),
            stroke: Some(Stroke::Sparse),
            ..unmarked(&ghost.outcome)
        });
    let squares = app
        .studies
        .value::<SquareLoops>()
        .filter(|_| app.view.squares && units.shows_force());
    let bands = squares.map_or_else(Vec::new, SquareLoops::bands);
    let edges = bands.iter().flat_map(|band| {
        band.iter()
            .zip([Stroke::Sparse, Stroke::Solid, Stroke::Sparse])
    });
    let squares = edges.map(|(curve, stroke)| ForceLoop {
        curves: vec![(Direction::Unloading, curve)],
        ink: Some(Ink::Kept),
        stroke: Some(stroke),
        ..ForceLoop::new(&[])
    });
    let tried = app.tried_outcome().map(|outcome| ForceLoop {
        name: Some("preview".into()),
        ink: Some(Ink::Kept),
        stroke: Some(Stroke::Dashed),
        ..unmarked(outcome)
    });
    let outcome = &app.solved.as_ref()?.outcome;
    let points = app.edit.measured.as_ref().filter(|_| units.shows_force());
    let points = points
        .zip(stiffness(app))
        .map(|(measured, stiffness)| measured.points(stiffness));
    // Over dots a line without gaps is legible.
    let stroke = points.is_some().then_some(Stroke::Solid);
    // A curve of a scene changed since stays in the background until the new one is there.
    let present = match app.is_current() {
        true => ForceLoop {
            stroke,
            ..ForceLoop::of_outcome(outcome)
        },
        false => ForceLoop {
            ink: Some(Ink::Quiet),
            stroke,
            ..unmarked(outcome)
        },
    };
    let manual = app.manual.as_ref().map(|manual| ForceLoop {
        curves: vec![(Direction::Unloading, &manual.path)],
        name: Some("manual".into()),
        ink: Some(Ink::Manual),
        stroke: Some(Stroke::Dashed),
        ..ForceLoop::new(&[])
    });
    let data = points.as_ref().map(|points| ForceLoop {
        curves: vec![(Direction::Unloading, points)],
        name: Some(MEASURED.into()),
        ink: Some(Ink::Kept),
        ..ForceLoop::new(&[])
    });
    let loops: Vec<ForceLoop<'_>> = data
        .into_iter()
        .chain(squares)
        .chain(ghosts)
        .chain(tried)
        .chain([present])
        .chain(manual)
        .collect();
    let mut chart = loop_chart(&loops, units);
    for layer in chart
        .layers
        .iter_mut()
        .filter(|layer| layer.name.to_string() == MEASURED)
    {
        layer.shape = Shape::signs(layer.shape.points(), Sign::Point);
    }
    // Below the curves, which stay whole.
    for [lower, _, upper] in &bands {
        let border = lower
            .iter()
            .chain(upper.iter().rev())
            .map(|point| units.place(point))
            .collect();
        chart
            .layers
            .insert(1, Layer::unnamed(Ink::Kept, Shape::Inside(border)));
    }
    if app.view.curve.loss && app.view.curve.quantities == LoopQuantities::ForceIndentation {
        let border = app
            .legs()
            .iter()
            .flat_map(|leg| &leg.curve)
            .map(|point| units.place(point))
            .collect();
        chart
            .layers
            .insert(1, Layer::unnamed(Ink::Kept, Shape::Inside(border)));
    }
    Some(chart)
}

/// Values of a kept scene that differ from the present scene, in words.
fn differences(app: &App, ghost: &Ghost) -> String {
    ghost.changes(&app.edit.document, |change| {
        format!("{} {}", change.name, change.from)
    })
}

/// Number of points of each loading stage of a kept scene beside which its letter may stand.
const PLACES: usize = 8;

/// Points beside which the letter of a kept scene may stand: its marks, the pull-off first, and
/// some of its curve.
fn marked(ghost: &Ghost) -> Vec<CurvePoint> {
    let legs = &ghost.outcome.history.legs;
    let mut marks = Mark::all(legs);
    marks.retain(|(mark, _)| *mark != Mark::JumpOut);
    let curves = legs.iter().rev().map(|leg| &leg.curve);
    let some =
        curves.flat_map(|curve| curve.iter().step_by((curve.len() / PLACES).max(1)).copied());
    marks
        .into_iter()
        .rev()
        .map(|(_, point)| point)
        .chain(some)
        .collect()
}

/// Adhesion force of a kept scene, and how much more or less the present scene has:
/// `F_a 12 µN, now 3 µN more`.
fn adhesion(app: &App, ghost: &Ghost) -> Option<String> {
    let units = units(app);
    let force = ghost.outcome.figures.adhesion_force?;
    let present = app
        .current()
        .and_then(|one| one.outcome.figures.adhesion_force);
    let difference =
        present
            .filter(|present| *present != force)
            .map_or_else(String::new, |present| {
                let more = if present > force { "more" } else { "less" };
                format!(
                    ", now {} {more}",
                    units.force_in_words((present - force).abs())
                )
            });
    Some(format!("F_a {}{difference}", units.force_in_words(force)))
}
