//! Lengths of the contact patches: their number over their length, both logarithmic.

use super::{PaneRow, Place};
use crate::draw::{Axis, AxisScale, Chart, Ink, Layer, Shape, Sign, Span, Stroke};
use crate::explorer::app::App;
use crate::explorer::keys::Context;
use crate::explorer::panel::Panel;
use ratatui::layout::Size;
use ratatui::text::Line;

pub static ROW: PaneRow = PaneRow {
    place: Place::CloseUp,
    panel,
    keys: Some(Context::Crosshair),
    help: &[(
        "Lengths",
        "D: number n of contact patches over their length δx, both logarithmic; ○ is the patches in a step of length by √2 \
         at the indentation shown, steps without patches are left out",
    )],
    ..PaneRow::EMPTY
};

fn panel(app: &App, _: Size) -> Panel {
    let title = "Contact patches by length, log–log".to_owned();
    let (Some(snapshot), Some(computed)) = (&app.snapshot, &app.solved) else {
        return Panel::of_text(title, "");
    };
    let bins = &snapshot.lengths;
    if bins.is_empty() {
        return Panel::of_text(title, "nothing is in contact");
    }
    // The fewest springs whose square has this binary logarithm.
    let least = |square: u32| 2_f64.powf(f64::from(square) / 2.0).ceil();
    let points = bins.iter().map(|(&square, &count)| {
        let mean = (least(square) * (least(square + 1) - 1.0)).sqrt();
        (mean * computed.outcome.line.spacing, count as f64)
    });
    let points: Vec<(f64, f64)> = points.collect();
    let axis = |numbers: &mut dyn Iterator<Item = f64>, symbol: &str, unit: &str| {
        let span = Span::decades(numbers.map(f64::log10));
        Axis::new(AxisScale::Logarithmic, span, "", symbol, unit)
    };
    let x = axis(&mut points.iter().map(|point| point.0), "δx", "m");
    let y = axis(&mut points.iter().map(|point| point.1), "n", "1");
    let shape = Shape::Curve { points, stroke: Some(Stroke::Dotted), sign: Some(Sign::Ring) };
    let chart = Chart::new(x, y, vec![Layer::new("n".into(), Ink::Contact, shape)]);
    let count: u64 = bins.values().sum();
    let foot = vec![Line::raw(format!("○ n, {count} in all, in steps of δx by √2"))];
    Panel { foot, ..Panel::of_chart(title, chart) }
}
