//! The axis of adhesion against preload: its range and its scale.

use super::Effect;
use crate::draw::{AxisScale, Span};
use crate::explorer::app::{App, PreloadAxis};
use crate::explorer::panes::PreloadCurve;
use crate::scene::{LEG_FORCE, Move, format_quantity};

/// Least width of the axis, as a share of its largest coordinate.
const NARROWEST: f64 = 1e-6;

/// Changes between preloads at equal distances and at equal ratios, around that of the scene.
pub fn toggle_scale(app: &mut App) {
    let is_linear = app.view.preloads.scale == AxisScale::Linear;
    show(app, if is_linear { AxisScale::Logarithmic } else { AxisScale::Linear }, None);
}

/// Shows these preloads, in coordinates of the scale; `None`: those around that of the scene.
pub fn show(app: &mut App, scale: AxisScale, span: Option<Span>) {
    app.view.preloads = PreloadAxis { scale, span };
    app.effects.push(Effect::Study);
}

/// Multiplies the width of the axis by a factor, around the crosshair or the preload of the scene, and moves the axis by a
/// share of its width.
pub fn change(app: &mut App, factor: f64, share: f64) {
    let Some(curve) = app.studies.value::<PreloadCurve>() else { return };
    let PreloadAxis { scale, span } = app.view.preloads;
    let Some(shown) = span.or(curve.span().filter(|_| curve.axis.scale() == scale)) else { return };
    let present = app.current().and_then(|computed| computed.outcome.figures.preload);
    let present = present.map(|force| (scale.coordinate(force) - shown.low) / shown.width());
    let fixed = app.view.crosshair.or(present.filter(|share| (0.0..=1.0).contains(share))).unwrap_or(0.5);
    let low = shown.low + (fixed * (1.0 - factor) + share) * shown.width();
    let mut span = Span { low, high: low + factor * shown.width() };
    let reach = app.current().map(|computed| computed.reach).unwrap_or_default();
    let largest = LEG_FORCE.range.ends().map_or(f64::MAX, |(_, most)| most);
    let most = scale.coordinate(reach.force.min(largest)).max(shown.high);
    let touch = curve.staircase.touch.0;
    let least = if scale == AxisScale::Linear { touch } else { -scale.coordinate(largest) };
    if span.low < least {
        span = Span { low: least, high: least + span.width() };
        if share < 0.0 && scale == AxisScale::Linear {
            let touch = format_quantity(touch, "N");
            app.set_done(format!("no preload is below the force at first touch, {touch}"));
        }
    }
    if span.high > most {
        let why = reach.refusal(Move::ToForce(scale.number(span.high)));
        why.into_iter().for_each(|why| app.set_done(why));
        span = Span { low: span.low.min(shown.low), high: most };
    }
    if span.width() > NARROWEST * span.low.abs().max(span.high.abs()) {
        show(app, scale, Some(span));
    }
}
