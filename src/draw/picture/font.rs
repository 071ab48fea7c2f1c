//! Letters of raster pictures: outlines of two fonts, the same on every machine.

use super::canvas::set;
use crate::draw::label::{Face as Set, Label};
use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::{Face, FaceParsingError, OutlineBuilder};

/// Latin, Greek, Cyrillic and mathematical characters; see LICENSE beside the files.
const SANS: &[u8] = include_bytes!("font/sans.ttf");
/// Monospaced characters, with arrows and geometric shapes.
const MONO: &[u8] = include_bytes!("font/mono.ttf");
/// Slope of italics.
const SLANT: f32 = 0.2;

/// A font.
pub(crate) struct Font {
    face: Face<'static>,
}

impl Font {
    /// The sans-serif font of figures.
    ///
    /// # Errors
    /// An unreadable outline.
    pub(super) fn sans() -> Result<Font, FaceParsingError> {
        Font::read(SANS)
    }

    /// The monospaced font of screens.
    ///
    /// # Errors
    /// An unreadable outline.
    pub(crate) fn mono() -> Result<Font, FaceParsingError> {
        Font::read(MONO)
    }

    fn read(file: &'static [u8]) -> Result<Font, FaceParsingError> {
        Ok(Font { face: Face::parse(file, 0)? })
    }

    /// Outlines of a label, the base line at y = 0 from x = 0 on, with their width. A character missing from the
    /// font is a box.
    pub(crate) fn outlines(&self, label: &Label, size: f64) -> (Option<Path>, f64) {
        let mut outlines = Outlines { path: PathBuilder::new(), place: Transform::identity() };
        let mut x = 0.0;
        for (face, text) in label.runs() {
            let (down, size) = set(*face, size);
            let scale = size / f64::from(self.face.units_per_em());
            let slant = if *face == Set::Italic { SLANT } else { 0.0 };
            for character in text.chars() {
                let glyph = self.face.glyph_index(character).unwrap_or_default();
                let shape = Transform::from_row(1.0, 0.0, slant, 1.0, 0.0, 0.0);
                outlines.place =
                    shape.post_scale(scale as f32, -scale as f32).post_translate(x as f32, down as f32);
                self.face.outline_glyph(glyph, &mut outlines);
                x += scale * f64::from(self.face.glyph_hor_advance(glyph).unwrap_or_default());
            }
        }
        (outlines.path.finish(), x)
    }

    /// True for a character of the font.
    #[cfg(test)]
    pub(super) fn has(&self, character: char) -> bool {
        self.face.glyph_index(character).is_some()
    }
}

/// A path of glyphs, each at its place.
struct Outlines {
    path: PathBuilder,
    place: Transform,
}

impl Outlines {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        let mut point = tiny_skia::Point::from_xy(x, y);
        self.place.map_point(&mut point);
        (point.x, point.y)
    }
}

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_the_characters_of_figures() {
        let needed = "Az09 µγκδπ−·×±≤∇√°⁻¹²³…–“”éßЖ";
        for (font, further) in [(Font::sans(), ""), (Font::mono(), "⟨⟩◇○◆▸▾›↑→⁰₀●")]
        {
            let font = font.unwrap();
            let missing: String =
                needed.chars().chain(further.chars()).filter(|character| !font.has(*character)).collect();
            assert_eq!(missing, "");
            assert!(!font.has('汉'));
        }
    }

    #[test]
    fn labels_are_about_as_wide_as_the_layout_expects() {
        let font = Font::sans().unwrap();
        for label in [Label::plain("adhesion force"), Label::symbol("F_a,max"), Label::power_of_ten(-12)] {
            let (path, width) = font.outlines(&label, 10.0);
            assert!((0.75..1.3).contains(&(width / (10.0 * label.width()))), "{label}: {width}");
            let bounds = path.unwrap().bounds();
            assert!(f64::from(bounds.right()) < width + 2.0 && bounds.left() > -1.0, "{label}");
            // Above the base line except for an index.
            assert!(bounds.top() < -5.0 && bounds.bottom() < 5.0, "{label}");
        }
        assert!(font.outlines(&Label::default(), 10.0).0.is_none());
        assert!(font.outlines(&Label::plain("汉"), 10.0).0.is_some(), "a box in place of a character");
    }
}
