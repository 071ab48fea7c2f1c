//! Shapes and words on a picture, drawn with plotters.

use super::label::typeset;
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::{
    Circle, Color, DrawingArea, FontDesc, FontFamily, FontStyle, FontTransform, IntoDrawingArea, PathElement,
    Polygon, RGBColor, Rectangle, SVGBackend, ShapeStyle, Text,
};
use plotters::style::TextStyle;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Units of the picture in a pixel: plotters knows whole numbers only.
const UNITS: f64 = 10.0;

/// Fonts that are asked for, the same letters nearly everywhere.
const FONTS: &str = "Helvetica, Arial, Liberation Sans, DejaVu Sans, sans-serif";

/// By how much plotters divides the sizes of fonts.
const FONT_FACTOR: f64 = 1.24;

pub(super) const INK: RGBColor = RGBColor(0, 0, 0);
pub(super) const PAPER: RGBColor = RGBColor(255, 255, 255);
pub(super) const FAINT: RGBColor = RGBColor(150, 150, 150);

/// A place on the picture, in pixels from the upper left.
pub(super) type Place = (f64, f64);

/// A picture while it is drawn.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Which point of a text stands at its place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
    /// The middle of text that runs upwards.
    Upwards,
}

/// How a line is drawn.
#[derive(Clone, Copy)]
pub(super) struct Stroke {
    pub colour: RGBColor,
    pub width: f64,
    pub dashed: bool,
}

pub(super) fn stroke(colour: RGBColor, width: f64) -> Stroke {
    Stroke { colour, width, dashed: false }
}

/// Draws a picture of so many pixels. Drawing into memory does not fail: what a shape returns is nothing that
/// could be acted on.
pub(super) fn picture(width: f64, height: f64, draw: impl FnOnce(&Canvas<'_>)) -> String {
    let mut svg = String::new();
    let units = |pixels: f64| (pixels * UNITS).round() as u32;
    {
        let area = SVGBackend::with_string(&mut svg, (units(width), units(height))).into_drawing_area();
        let canvas = Canvas { area };
        canvas.rectangle((0.0, 0.0), (width, height), PAPER);
        draw(&canvas);
        let _ = canvas.area.present();
    }
    // The size as people see it; the units stay those of the view box.
    let sized = svg.replacen(
        &format!("width=\"{}\" height=\"{}\"", units(width), units(height)),
        &format!("width=\"{}\" height=\"{}\"", width.round(), height.round()),
        1,
    );
    typeset(&sized)
}

impl Canvas<'_> {
    pub(super) fn rectangle(&self, from: Place, to: Place, fill: RGBColor) {
        let _ = self.area.draw(&Rectangle::new([units(from), units(to)], fill.filled()));
    }

    pub(super) fn frame(&self, from: Place, to: Place) {
        self.line(&[from, (to.0, from.1), to, (from.0, to.1), from, (to.0, from.1)], stroke(INK, 1.0));
    }

    pub(super) fn line(&self, places: &[Place], stroke: Stroke) {
        let style = ShapeStyle {
            color: stroke.colour.to_rgba(),
            filled: false,
            stroke_width: (stroke.width * UNITS).round() as u32,
        };
        let places = places.iter().copied().map(units);
        let _ = if stroke.dashed {
            let (dash, gap) = ((5.0 * UNITS) as i32, (3.5 * UNITS) as i32);
            self.area.draw(&DashedPathElement::new(places, dash, gap, style))
        } else {
            self.area.draw(&PathElement::new(places.collect::<Vec<_>>(), style))
        };
    }

    pub(super) fn area(&self, places: &[Place], colour: RGBColor, opacity: f64) {
        let places: Vec<_> = places.iter().copied().map(units).collect();
        let _ = self.area.draw(&Polygon::new(places, colour.mix(opacity).filled()));
    }

    pub(super) fn dot(&self, at: Place, radius: f64, fill: RGBColor) {
        let _ = self.area.draw(&Circle::new(units(at), (radius * UNITS).round() as i32, fill.filled()));
    }

    pub(super) fn text(&self, text: &str, at: Place, size: f64, anchor: Anchor) {
        self.coloured_text(text, at, size, anchor, INK);
    }

    pub(super) fn coloured_text(&self, text: &str, at: Place, size: f64, anchor: Anchor, colour: RGBColor) {
        let font = FontDesc::new(FontFamily::Name(FONTS), size * UNITS * FONT_FACTOR, FontStyle::Normal);
        let font = if anchor == Anchor::Upwards { font.transform(FontTransform::Rotate270) } else { font };
        let across = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle | Anchor::Upwards => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(across, VPos::Center));
        let _ = self.area.draw(&Text::new(text.to_owned(), units(at), style));
    }
}

fn units((x, y): Place) -> (i32, i32) {
    ((x * UNITS).round() as i32, (y * UNITS).round() as i32)
}
