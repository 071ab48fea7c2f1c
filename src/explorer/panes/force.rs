//! The pane of the force curve: the loop of loading and unloading, manual loading, and other curves
//! for comparison.

use super::compared::compared;
use super::force_loops::{
    chart, differences, quantities, shows_loss, shows_measured, stiffness, units,
};
use super::row::{Exported, PaneRow, outcome};
use crate::explorer::advice;
use crate::explorer::app::App;
use crate::explorer::caption::caption;
use crate::explorer::command_line::curve_arguments;
use crate::explorer::ghost::Ghost;
use crate::explorer::measured::{Measured, fitted};
use crate::explorer::panel::{Body, Panel};
use crate::explorer::request::Drive;
use crate::explorer::snapshot::{ContactSnapshot, FollowedPath};
use crate::explorer::text::Part;
use crate::explorer::theme::Meaning;
use asperity_contact::{CurvePoint, Direction, Mark, StageRecord};
use asperity_data::{AxisScale, counted, format_rounded, quantile};
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Name, Shape, Sign, Span};
use asperity_report::{FitReport, LoopQuantities, LoopUnits, Report, letter};
use asperity_scene::text::quoted;
use ratatui::layout::Size;
use ratatui::text::{Line, Span as Text};
use std::f64::consts::PI;

pub static ROW: PaneRow = PaneRow {
    panel,
    figure: |app, _| match fit_report(app) {
        Some(report) => report.figure(),
        None if app.edit.path.is_none() && !app.ghosts.is_empty() => compared(app),
        None => Some(Figure::of_chart(app.edit.document.title(), chart(app)?)),
    },
    report: |app| fit(app).or_else(|| outcome(app)),
    help: &[(
        "Curve",
        "force F over the indentation d: amber and dotted on loading, blue and solid on unloading; the shaded area of \
         the loop is the dissipated energy ΔW; ◇ jump-in, ▲ preload, ▼ pull-off, ◆ present state. Grey dashes with \
         letters are ghosts; coloured dashes show manual loading; dots are a measured curve, with its residuals below",
    )],
    ..PaneRow::EMPTY
};

/// Returns the report on the measured curve, with the computed forces and the residuals; `None` if
/// there is no measured curve, or if the fit is not computed yet.
fn fit_report(app: &App) -> Option<FitReport<'_>> {
    let Measured { name, curve, .. } = app.edit.measured.as_ref()?;
    Some(FitReport {
        title: name,
        curve,
        fit: fitted(&app.studies).filter(|_| app.is_current())?,
        wording: advice::row,
    })
}

/// Returns the report on the measured curve, and the command that computes the fit to this curve.
fn fit(app: &App) -> Exported<'_> {
    let report = fit_report(app)?;
    let options = &app.edit.measured.as_ref()?.options;
    let names: Vec<&str> = report
        .fit
        .parameters
        .iter()
        .map(|fitted| fitted.parameter.name())
        .collect();
    let command = format!(
        "asperity fit {}{} --free={}",
        quoted(report.title),
        curve_arguments(options),
        names.join(",")
    );
    Some((command.into(), Box::new(report)))
}

/// Smallest height in rows at which the pane describes the ghosts in lines above the chart.
const WITH_GHOSTS: u16 = 9;

fn panel(app: &App, size: Size) -> Panel {
    let Some(chart) = shown_chart(app) else {
        let reason = if app.is_computing() {
            "computing…"
        } else {
            "no curve"
        };
        return Panel::of_text(title(app, None, size.width), reason);
    };
    let mut names = Vec::new();
    if app.is_current() {
        names.extend(names_of_marks(app));
    }
    names.extend(letters_of_ghosts(app));
    if shows_loss(app) && app.is_current() && app.edit.path.is_none() {
        names.extend(name_of_loss(app));
    }
    let below = residuals(app, &chart.x);
    let mut panel = Panel {
        head: lines_of_ghosts(app, size),
        edge: edge(app),
        ..Panel::of_chart(title(app, Some(&chart.y), size.width), chart)
    };
    if let Body::Chart(plot) = &mut panel.body {
        plot.names = names;
        plot.below = below;
    }
    panel
}

/// Returns the names and forces of the marked points of the present curve, the most important
/// first.
fn names_of_marks(app: &App) -> Vec<Name> {
    const BY_IMPORTANCE: [Mark; 3] = [Mark::PullOff, Mark::Preload, Mark::JumpIn];
    let units = units(app);
    let mut marks = Mark::all(marked_stages(app));
    marks.retain(|marked| units.shows(marked.mark));
    marks.sort_by_key(|marked| {
        let place = BY_IMPORTANCE.iter().position(|mark| *mark == marked.mark);
        place.unwrap_or(BY_IMPORTANCE.len())
    });
    let mut names = Vec::new();
    for marked in marks {
        let name = marked.mark.name();
        let force = units.force_in_words(app.without_rounding(marked.point.force));
        names.push(Name {
            at: units.place_of_mark(&marked).into_iter().collect(),
            // A force alone might belong to any of several marks beside it.
            texts: vec![format!("{name} {force}"), name.to_owned()],
            ink: Ink::Text,
        });
    }
    names
}

/// Returns the loading stages whose marked points are shown: those of the scene or, under manual
/// loading, those of the whole path with its way to the first move, as on the timeline.
fn marked_stages(app: &App) -> &[StageRecord] {
    app.played_stages()
}

/// Returns the letters of the ghosts, which are written beside the curves, the newest first.
fn letters_of_ghosts(app: &App) -> Vec<Name> {
    let units = units(app);
    let mut names = Vec::new();
    for (number, ghost) in app.ghosts.iter().enumerate().rev() {
        names.push(Name {
            at: places_of_letter(ghost, units),
            texts: vec![letter(number)],
            ink: Ink::Compared,
        });
    }
    names
}

/// Returns the lines above the chart that describe the ghosts (scenes that the user keeps for
/// comparison), the newest first. The lines take at most a quarter of the pane.
fn lines_of_ghosts(app: &App, size: Size) -> Vec<Line<'static>> {
    let mut lines = Vec::new();
    if size.height < WITH_GHOSTS {
        return lines;
    }
    let most = usize::from(size.height / 4);
    for (number, ghost) in app.ghosts.iter().enumerate().rev().take(most) {
        let force = adhesion(app, ghost).map_or_else(String::new, |force| format!(" {force} ·"));
        let line = format!("{}:{force} {}", letter(number), differences(app, ghost));
        let style = app.view.appearance.palette().ink(Ink::Compared);
        lines.push(Line::styled(line, style));
    }
    lines
}

/// Returns the texts on the right of the title: F_a/F_a,max, and the shown state after the sign ◆.
fn edge(app: &App) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    // Under manual loading, the pane shows another loading than the one that has this share.
    if app.edit.path.is_none()
        && let Some(share) = app.adhesion_share_in_words()
    {
        parts.push(vec![Text::raw(share)]);
    }
    let cursor = app.view.appearance.style(Meaning::Cursor);
    for (number, text) in state(app).into_iter().enumerate() {
        let mut part = Vec::new();
        if number == 0 {
            part.push(Text::styled("◆ ", cursor));
        }
        part.push(Text::raw(text));
        parts.push(part);
    }
    parts
}

/// Returns the shown state as texts, the most important first: indentation d, force F and contact.
/// Under manual loading, the springs that changed in the last move and the energy that the moves
/// released are shown instead of the share of springs in
/// contact. E* l is the stiffness of the contact with fixed edges (Popov and Filippov 2012, eq.
/// (1)). p_m is the mean pressure: the force divided by the area of a circle with the contact
/// radius.
fn state(app: &App) -> Vec<String> {
    let (Some(snapshot), Some(outcome)) = (app.present(), app.outcome()) else {
        return Vec::new();
    };
    let point = snapshot.point;
    let force = app.without_rounding(point.force);
    let mut parts = vec![
        format!("d {}", format_rounded(point.indentation, 3, "m")),
        format!("F {}", units(app).force_in_words(force)),
    ];
    if let Some(seconds) = snapshot.seconds {
        parts.push(format!("t {}", format_rounded(seconds, 3, "s")));
    }
    match app.former_path().map(FollowedPath::moves) {
        Some(moves) => {
            let last = moves.last();
            let changed = last.map_or(0, |last| last.attached + last.detached);
            let released: f64 = moves.iter().map(|stage| stage.released_energy).sum();
            let released = format_rounded(released + 0.0, 2, "J");
            parts.push(format!("{} changed", counted(changed, "spring")));
            parts.push(format!("released {released}"));
        }
        None => {
            let percent = 100.0 * point.contact_length / outcome.line.length;
            parts.push(format!("contact {} %", format_rounded(percent, 2, "1")));
        }
    }
    parts.push(counted(point.patches, "patch"));
    let stiffness = outcome.governing.modulus * point.contact_length;
    parts.push(format!("E*l {}", format_rounded(stiffness, 2, "N/m")));
    let radius = snapshot.contact_radius;
    if radius > 0.0 {
        let pressure = force / (PI * radius * radius);
        parts.push(format!("p_m {}", format_rounded(pressure, 2, "Pa")));
    }
    parts
}

/// Smallest width in columns at which the title has room for the words *manual loading* beside the
/// indentation and the force.
const WITH_MANUAL: u16 = 56;

/// Returns the title: the name and the unit of the vertical quantity, and the event at the shown
/// state. `width` is the width of the pane in columns.
fn title(app: &App, y: Option<&ChartAxis>, width: u16) -> String {
    let name = match quantities(app) {
        LoopQuantities::ForceIndentation
        | LoopQuantities::ForceDisplacement
        | LoopQuantities::ForceTime => "Force",
        LoopQuantities::LengthForce => "Contact length",
        LoopQuantities::PatchesIndentation => "Contact patches",
    };
    let name = match y {
        Some(axis) => format!("{name} {}", axis.symbol_with_unit()),
        None => name.to_owned(),
    };
    let is_stopped = app
        .followed()
        .is_some_and(|followed| followed.stopped.is_some());
    let leaves_out_manual = width < WITH_MANUAL && app.drive() == Drive::Manual && !is_stopped;
    let event = match caption(app) {
        _ if app.is_computing() => " · computing".to_owned(),
        // The user pulls until the force has a wanted value, which matters more than these words.
        _ if leaves_out_manual => String::new(),
        Some(event) => format!(" · {event}"),
        None => String::new(),
    };
    format!("{name}{event}")
}

/// Returns the dissipated energy, which is written inside the loop, where the loop is widest.
fn name_of_loss(app: &App) -> Option<Name> {
    let energy = app.outcome()?.figures.dissipated_energy?;
    let units = units(app);
    let mut at = Vec::new();
    for place in places_inside(app) {
        at.extend(units.place(&place, None));
    }
    let energy = format_rounded(energy, 3, "J");
    Some(Name {
        at,
        // An energy alone might be taken for a value of the mark beside it.
        texts: vec![format!("ΔW {energy}")],
        ink: Ink::Text,
    })
}

/// Number of points on the curve of the unloading beside which the dissipated energy may be
/// written.
const PLACES_INSIDE: usize = 24;

/// Returns points inside the loop, those at which it is widest first. They lie halfway between the
/// unloading and the loading at the same indentation. Points at which the loop is narrow are left
/// out.
fn places_inside(app: &App) -> Vec<CurvePoint> {
    /// Smallest distance between the two curves, as a share of the largest distance.
    const LEAST_SHARE: f64 = 0.5;
    let mut stages = app.stages().iter();
    let Some(loading) = stages.find(|stage| stage.direction == Direction::Loading) else {
        return Vec::new();
    };
    let Some(unloading) = stages.find(|stage| stage.direction == Direction::Unloading) else {
        return Vec::new();
    };
    let mut places: Vec<(CurvePoint, f64)> = Vec::new();
    let step = (unloading.curve.len() / PLACES_INSIDE).max(1);
    for point in unloading.curve.iter().step_by(step) {
        let loaded = &loading.curve;
        let above = loaded.partition_point(|other| other.indentation < point.indentation);
        let Some(other) = loaded.get(above) else {
            continue;
        };
        let middle = CurvePoint {
            force: f64::midpoint(point.force, other.force),
            ..*point
        };
        places.push((middle, (other.force - point.force).abs()));
    }
    places.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    let widest = places.first().map_or(0.0, |(_, distance)| *distance);
    places.retain(|(_, distance)| *distance >= LEAST_SHARE * widest);
    places.into_iter().map(|(place, _)| place).collect()
}

/// Returns the indentation in m that belongs to the number `x` on the horizontal axis of the force
/// curve; `None` if `x` does not determine the indentation.
pub fn indentation_at(app: &App, x: f64) -> Option<f64> {
    app.indentations().and(units(app).indentation(x))
}

/// Returns the chart of the residuals of the measured curve, divided by the noise. `x` is its
/// horizontal axis. Until the residuals are computed, the chart has no points. `None` if there is
/// no measured curve, or if the pane cannot show it.
fn residuals(app: &App, x: &ChartAxis) -> Option<Chart> {
    if !shows_measured(app) {
        return None;
    }
    let units = units(app);
    let measured = app.edit.measured.as_ref()?;
    let residuals = match fitted(&app.studies) {
        Some(fit) if app.is_current() => measured.residuals(&fit.model),
        _ => Vec::new(),
    };
    let measured_points = measured.points(stiffness(app)?);
    let mut points = Vec::new();
    for (point, residual) in measured_points.iter().zip(&residuals) {
        if let Some((across, _)) = units.place(point, None) {
            points.push((across, *residual));
        }
    }
    let half = half_range(residuals);
    let span = Span {
        low: -half,
        high: half,
    };
    let y = ChartAxis::new(AxisScale::Linear, span, "residual over noise", "", "1");
    let layers = vec![
        Layer::unnamed(Ink::Quiet, Shape::Level(0.0)),
        Layer::unnamed(Ink::Kept, Shape::signs(points, Sign::Point)),
    ];
    Some(Chart::new(x.clone(), y, layers))
}

/// Share of the residuals that lie within the range of their chart. The other, larger residuals,
/// for example at a jump of the contact, are drawn at the edge of the chart.
const IN_RANGE: f64 = 0.98;

/// Returns the smallest of the numbers 5, 10, 20, 50 and so on that is not below the absolute value
/// of nearly all residuals.
fn half_range(residuals: Vec<f64>) -> f64 {
    let mut sizes: Vec<f64> = residuals.into_iter().map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let most = quantile(&sizes, IN_RANGE).unwrap_or(0.0);
    for power in 0..12 {
        for step in [5.0, 10.0, 20.0] {
            let half = step * 10_f64.powi(power);
            if half >= most {
                return half;
            }
        }
    }
    most
}

/// Returns the chart of the pane, with a marker at the shown state. The names of marks, ghosts and
/// axes are left out of the chart, because the pane writes them elsewhere.
fn shown_chart(app: &App) -> Option<Chart> {
    let mut chart = chart(app)?.with_symbols();
    if let Some(snapshot) = app.present()
        && let Some((x, y)) = units(app).place(&shown_point(app, snapshot), snapshot.seconds)
    {
        let x = x.clamp(chart.x.span.low, chart.x.span.high);
        let y = y.clamp(chart.y.span.low, chart.y.span.high);
        let mark = Shape::signs(vec![(x, y)], Sign::Diamond);
        chart.layers.push(Layer::unnamed(Ink::Cursor, mark));
    }
    for layer in &mut chart.layers {
        if matches!(layer.ink, Ink::Text | Ink::Compared) {
            layer.name = Label::default();
        }
    }
    Some(chart)
}

/// Returns the point of the force curve at which the present state is marked. While a compliant
/// instrument jumps, its displacement stays where it was before the jump, and the force is that of
/// the instrument.
fn shown_point(app: &App, snapshot: &ContactSnapshot) -> CurvePoint {
    let point = snapshot.point;
    let stage = match snapshot.drive {
        Drive::Stage(number) | Drive::Path(number) => app.played_stages().get(number),
        Drive::Manual => None,
    };
    let (Some(stage), Some(stiffness)) = (stage, stiffness(app)) else {
        return point;
    };
    if stiffness.is_infinite() || quantities(app) != LoopQuantities::ForceDisplacement {
        return point;
    }
    let sign = match stage.direction {
        Direction::Loading => 1.0,
        Direction::Unloading => -1.0,
    };
    // The largest displacement in the direction of the stage that it has reached up to here.
    let mut reached = sign * point.displacement(stiffness);
    for passed in &stage.curve {
        if sign * passed.indentation <= sign * point.indentation {
            reached = reached.max(sign * passed.displacement(stiffness));
        }
    }
    CurvePoint {
        force: stiffness * (sign * reached - point.indentation),
        ..point
    }
}

/// Number of points on the curve of each loading stage beside which the letter of a ghost may be
/// written.
const PLACES: usize = 8;

/// Returns the places beside which the letter of a ghost may be written, the best first: its marks,
/// beginning with the pull-off, and then points on its curve, beginning with the last stage.
fn places_of_letter(ghost: &Ghost, units: LoopUnits) -> Vec<(f64, f64)> {
    let stages = &ghost.outcome.history.stages;
    let mut places = Vec::new();
    for marked in Mark::all(stages).iter().rev() {
        if marked.mark != Mark::JumpOut {
            places.extend(units.place_of_mark(marked));
        }
    }
    for stage in stages.iter().rev() {
        let step = (stage.curve.len() / PLACES).max(1);
        for (index, point) in stage.curve.iter().enumerate().step_by(step) {
            places.extend(units.place(point, stage.seconds.get(index).copied()));
        }
    }
    places
}

/// Returns the pull-off force of a ghost, and by how much the pull-off force of the present scene
/// is larger or smaller: `F_a 12 µN, now 3 µN more`.
fn adhesion(app: &App, ghost: &Ghost) -> Option<String> {
    let units = units(app);
    let kept = ghost.outcome.figures.pull_off_force?;
    let kept_in_words = units.force_in_words(kept);
    let present = app
        .current()
        .and_then(|computed| computed.outcome.figures.pull_off_force);
    let Some(present) = present.filter(|present| *present != kept) else {
        return Some(format!("F_a {kept_in_words}"));
    };
    let more = if present > kept { "more" } else { "less" };
    let difference = units.force_in_words((present - kept).abs());
    Some(format!("F_a {kept_in_words}, now {difference} {more}"))
}
