//! The screen as a picture of pixels, the same on every machine.

use super::letters::{BASE, FONT_SIZE};
use super::outline::{HEIGHT, WIDTH};
use super::sheet::{MARGIN, Part, Pen, Sheet, size};
use crate::draw::{Font, Label, Palette, Pixels, PngError};
use kurbo::{BezPath, PathEl, Point};
use ratatui::buffer::Buffer;
use tiny_skia::{LineCap, LineJoin, Path, PathBuilder, Rect, Stroke, Transform};

/// Width of the line around bold letters, px.
const BOLD: f32 = 0.5;
/// Slope of italics.
const SLANT: f32 = 0.2;

/// A picture of the screen in PNG: the same bytes for the same screen.
///
/// # Errors
/// For a picture of too many pixels.
pub fn png(buffer: &Buffer, palette: &Palette) -> Result<Vec<u8>, PngError> {
    let (width, height) = size(buffer);
    let mut pixels = Pixels::new(f64::from(width), f64::from(height))?;
    let font = Font::mono()?;
    let page = Rect::from_xywh(0.0, 0.0, width as f32, height as f32).map(PathBuilder::from_rect);
    pixels.fill(page, palette.background, 1.0, false);
    let (parts, letters) = Sheet::new(buffer, palette).parts();
    for Part { path, colour, pen } in parts {
        let path = outline(&path)?;
        match pen {
            None => pixels.fill(path, colour, 1.0, true),
            Some(pen) => pixels.stroke(path, colour, &stroke(pen)),
        }
    }
    for (face, runs) in letters.runs() {
        for run in runs {
            let (path, width) = font.outlines(&Label::plain(&run.text), FONT_SIZE);
            let x = MARGIN + u32::from(run.column) * WIDTH;
            let y = MARGIN + u32::from(run.row) * HEIGHT + BASE;
            let stretch = f64::from(u32::from(run.columns) * WIDTH) / width;
            let slant = if face.italic { -SLANT } else { 0.0 };
            let place = Transform::from_row(stretch as f32, 0.0, slant, 1.0, x as f32, y as f32);
            let path = path.and_then(|path| path.transform(place));
            if face.bold {
                pixels.stroke(path.clone(), face.colour, &Stroke { width: BOLD, ..Stroke::default() });
            }
            pixels.fill(path, face.colour, 1.0, true);
        }
    }
    pixels.finish()
}

fn stroke(pen: Pen) -> Stroke {
    let (line_cap, line_join) = match pen {
        Pen::Whole(_) => (LineCap::Square, LineJoin::Miter),
        Pen::Dot => (LineCap::Round, LineJoin::Round),
        Pen::Dashed(_) | Pen::Rule => (LineCap::Butt, LineJoin::Miter),
    };
    Stroke { width: pen.width(), line_cap, line_join, ..Stroke::default() }
}

/// Path from SVG data, at its place in the picture.
fn outline(data: &str) -> Result<Option<Path>, PngError> {
    let path = BezPath::from_svg(data).map_err(|error| PngError::Encoding(error.to_string()))?;
    let mut builder = PathBuilder::new();
    let at = |point: Point| (point.x as f32, point.y as f32);
    for &element in path.elements() {
        match element {
            PathEl::MoveTo(to) => builder.move_to(at(to).0, at(to).1),
            PathEl::LineTo(to) => builder.line_to(at(to).0, at(to).1),
            PathEl::QuadTo(by, to) => builder.quad_to(at(by).0, at(by).1, at(to).0, at(to).1),
            PathEl::CurveTo(from, by, to) => {
                builder.cubic_to(at(from).0, at(from).1, at(by).0, at(by).1, at(to).0, at(to).1);
            }
            PathEl::ClosePath => builder.close(),
        }
    }
    let margin = Transform::from_translate(MARGIN as f32, MARGIN as f32);
    Ok(builder.finish().and_then(|path| path.transform(margin)))
}
