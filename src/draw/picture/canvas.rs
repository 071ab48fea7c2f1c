//! Drawing operations for figures, common to all formats of pictures.

use crate::draw::chart::Stroke;
use crate::draw::colour::Rgb;
use crate::draw::label::{Face, Label, SMALL};

/// A place in a picture, px from the upper left.
pub(super) type Place = (f64, f64);

/// Point of a label at its place; vertically always the middle.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
    /// Middle of a label that runs upwards.
    Upwards,
}

/// A pen: colour, width in px, dashes.
#[derive(Clone, Copy)]
pub(super) struct Pen {
    pub colour: Rgb,
    pub width: f64,
    pub stroke: Stroke,
}

impl Pen {
    pub(super) fn solid(colour: Rgb, width: f64) -> Pen {
        Pen { colour, width, stroke: Stroke::Solid }
    }

    /// Lengths of dashes and of the gaps between them, px.
    pub(super) fn dashes(self) -> Option<(f64, f64)> {
        match self.stroke {
            Stroke::Solid => None,
            Stroke::Dashed => Some((6.0, 3.5)),
            Stroke::Dotted => Some((2.5, 2.5)),
            Stroke::Sparse => Some((1.5, 4.5)),
        }
    }
}

/// A picture as a drawing surface for figures.
pub(super) trait Canvas {
    /// Fills a rectangle.
    fn rectangle(&mut self, from: Place, to: Place, fill: Rgb);

    /// Draws the border of a rectangle.
    fn frame(&mut self, from: Place, to: Place, pen: Pen);

    /// Draws a line through places.
    fn line(&mut self, places: &[Place], pen: Pen);

    /// Fills a polygon.
    fn area(&mut self, places: &[Place], fill: Rgb, opacity: f64);

    /// Fills boxes by their upper left and lower right corners, at least half a pixel wide and high.
    fn boxes(&mut self, boxes: &[(Place, Place)], fill: Rgb);

    /// Fills a circle, and draws its border with a pen.
    fn circle(&mut self, at: Place, radius: f64, fill: Rgb, pen: Option<Pen>);

    /// Writes a label in letters of a size.
    fn label(&mut self, label: &Label, at: Place, size: f64, anchor: Anchor, colour: Rgb);
}

/// Half the height of capital letters: distance of the base line from the middle of a label of this size, px.
pub(super) fn below_middle(size: f64) -> f64 {
    0.35 * size
}

/// Distance below the base line and size of a run of a label of this size, px.
pub(super) fn set(face: Face, size: f64) -> (f64, f64) {
    match face {
        Face::Upright | Face::Italic => (0.0, size),
        Face::Index => (0.25 * size, SMALL * size),
        Face::Exponent => (-0.42 * size, SMALL * size),
    }
}
