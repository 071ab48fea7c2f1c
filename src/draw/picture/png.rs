//! Pictures in PNG: red, green and blue of eight bits.

use super::canvas::{Anchor, Canvas, Pen, Place, below_middle};
use super::font::Font;
use crate::draw::colour::Rgb;
use crate::draw::label::Label;
use flate2::write::ZlibEncoder;
use flate2::{Compression, Crc};
use std::io::Write;
use thiserror::Error;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Shader, Stroke, StrokeDash,
    Transform,
};

/// Pixels for each px of a figure.
const SCALE: f64 = 2.0;
/// Most pixels of a picture.
const MOST_PIXELS: f64 = (1_u32 << 26) as f64;
/// Pixels per metre of a print on which a px is 1/96 inch.
const PER_METRE: u32 = 7559;

/// Error of a raster picture.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PngError {
    /// Too many pixels.
    #[error(
        "a picture of {width} × {height} pixels; allowed: at most {MOST_PIXELS} in all; SVG has no limit"
    )]
    TooLarge {
        /// Pixels across.
        width: f64,
        /// Pixels down.
        height: f64,
    },
    /// Letters or data could not be encoded.
    #[error("the picture could not be encoded: {0}")]
    Encoding(String),
}

impl From<ttf_parser::FaceParsingError> for PngError {
    fn from(error: ttf_parser::FaceParsingError) -> Self {
        PngError::Encoding(error.to_string())
    }
}

/// A raster picture, drawn in px.
pub(crate) struct Pixels(Pixmap);

impl Pixels {
    /// An empty picture of the size in px.
    ///
    /// # Errors
    /// More pixels than allowed; detected before the allocation.
    pub(crate) fn new(width: f64, height: f64) -> Result<Pixels, PngError> {
        let [width, height] = [width, height].map(|side| (SCALE * side).ceil());
        let too_large = PngError::TooLarge { width, height };
        // NaN is no size either.
        if (width * height).is_nan() || width * height > MOST_PIXELS {
            return Err(too_large);
        }
        Ok(Pixels(Pixmap::new(width as u32, height as u32).ok_or(too_large)?))
    }

    /// Fills a path, antialiased if `smooth`.
    pub(crate) fn fill(&mut self, path: Option<Path>, colour: Rgb, opacity: f64, smooth: bool) {
        let Some(path) = path else { return };
        let paint = Paint { anti_alias: smooth, ..paint(colour, opacity) };
        self.0.fill_path(&path, &paint, FillRule::Winding, scale(), None);
    }

    /// Draws a path with a pen.
    pub(crate) fn stroke(&mut self, path: Option<Path>, colour: Rgb, stroke: &Stroke) {
        let Some(path) = path else { return };
        self.0.stroke_path(&path, &paint(colour, 1.0), stroke, scale(), None);
    }

    /// The picture as the content of a file.
    ///
    /// # Errors
    /// Failed compression of the data.
    pub(crate) fn finish(self) -> Result<Vec<u8>, PngError> {
        let (width, height) = (self.0.width(), self.0.height());
        let mut rows = ZlibEncoder::new(Vec::new(), Compression::default());
        let mut encode = || -> std::io::Result<()> {
            for row in self.0.data().chunks_exact(4 * width as usize) {
                // No filter: large areas of one colour compress without.
                let mut line = vec![0];
                line.extend(row.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]));
                rows.write_all(&line)?;
            }
            Ok(())
        };
        let failed = |error: std::io::Error| PngError::Encoding(error.to_string());
        encode().map_err(failed)?;
        let packed = rows.finish().map_err(failed)?;
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        // Eight bits, colours, the only compression and filter method, not interlaced.
        let kind = [8, 2, 0, 0, 0];
        chunk(&mut file, *b"IHDR", &[&width.to_be_bytes()[..], &height.to_be_bytes(), &kind].concat());
        let per_metre = PER_METRE.to_be_bytes();
        chunk(&mut file, *b"pHYs", &[&per_metre[..], &per_metre, &[1]].concat());
        chunk(&mut file, *b"IDAT", &packed);
        chunk(&mut file, *b"IEND", &[]);
        Ok(file)
    }
}

/// Adds a chunk: length, kind, data, checksum of kind and data.
fn chunk(file: &mut Vec<u8>, kind: [u8; 4], data: &[u8]) {
    file.extend((data.len() as u32).to_be_bytes());
    let from = file.len();
    file.extend(kind);
    file.extend(data);
    let mut sum = Crc::new();
    sum.update(&file[from..]);
    file.extend(sum.sum().to_be_bytes());
}

fn paint([red, green, blue]: Rgb, opacity: f64) -> Paint<'static> {
    let colour = tiny_skia::Color::from_rgba8(red, green, blue, (255.0 * opacity).round() as u8);
    Paint { shader: Shader::SolidColor(colour), anti_alias: true, ..Paint::default() }
}

fn scale() -> Transform {
    Transform::from_scale(SCALE as f32, SCALE as f32)
}

fn box_between(from: Place, to: Place) -> Option<Rect> {
    Rect::from_ltrb(from.0 as f32, from.1 as f32, to.0 as f32, to.1 as f32)
}

/// Lines through places.
fn through(places: &[Place], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    let (first, rest) = places.split_first()?;
    path.move_to(first.0 as f32, first.1 as f32);
    rest.iter().for_each(|place| path.line_to(place.0 as f32, place.1 as f32));
    if closed {
        path.close();
    }
    path.finish()
}

/// A figure in pixels.
pub(super) struct Raster {
    pixels: Pixels,
    font: Font,
}

impl Raster {
    /// An empty picture of the size in px.
    pub(super) fn new(width: f64, height: f64) -> Result<Raster, PngError> {
        Ok(Raster { pixels: Pixels::new(width, height)?, font: Font::sans()? })
    }

    /// The picture as the content of a file.
    pub(super) fn finish(self) -> Result<Vec<u8>, PngError> {
        self.pixels.finish()
    }

    fn draw(&mut self, path: Option<Path>, pen: Pen, join: LineJoin) {
        let dash = pen.dashes().and_then(|(dash, gap)| StrokeDash::new(vec![dash as f32, gap as f32], 0.0));
        let width = pen.width as f32;
        let stroke = Stroke { width, dash, line_cap: LineCap::Butt, line_join: join, ..Stroke::default() };
        self.pixels.stroke(path, pen.colour, &stroke);
    }
}

impl Canvas for Raster {
    fn rectangle(&mut self, from: Place, to: Place, fill: Rgb) {
        self.pixels.fill(box_between(from, to).map(PathBuilder::from_rect), fill, 1.0, true);
    }

    fn frame(&mut self, from: Place, to: Place, pen: Pen) {
        self.draw(box_between(from, to).map(PathBuilder::from_rect), pen, LineJoin::Miter);
    }

    fn line(&mut self, places: &[Place], pen: Pen) {
        self.draw(through(places, false), pen, LineJoin::Round);
    }

    fn area(&mut self, places: &[Place], fill: Rgb, opacity: f64) {
        self.pixels.fill(through(places, true), fill, opacity, true);
    }

    fn boxes(&mut self, boxes: &[(Place, Place)], fill: Rgb) {
        let mut path = PathBuilder::new();
        for (from, to) in boxes {
            let to = (to.0.max(from.0 + 0.5), to.1.max(from.1 + 0.5));
            if let Some(one) = box_between(*from, to) {
                path.push_rect(one);
            }
        }
        self.pixels.fill(path.finish(), fill, 1.0, false);
    }

    fn circle(&mut self, at: Place, radius: f64, fill: Rgb, pen: Option<Pen>) {
        let path = PathBuilder::from_circle(at.0 as f32, at.1 as f32, radius as f32);
        self.pixels.fill(path.clone(), fill, 1.0, true);
        if let Some(pen) = pen {
            self.draw(path, pen, LineJoin::Miter);
        }
    }

    fn label(&mut self, label: &Label, at: Place, size: f64, anchor: Anchor, colour: Rgb) {
        let (path, width) = self.font.outlines(label, size);
        let left = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle | Anchor::Upwards => -width / 2.0,
            Anchor::Right => -width,
        };
        let upright = Transform::from_translate(left as f32, below_middle(size) as f32);
        let turned = if anchor == Anchor::Upwards { upright.post_rotate(-90.0) } else { upright };
        let path = path.and_then(|path| path.transform(turned.post_translate(at.0 as f32, at.1 as f32)));
        self.pixels.fill(path, colour, 1.0, true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::colour::Palette;
    use std::io::Read;

    /// Width, height and colours of the pixels of a file, whose chunks have the right checksums.
    fn read(file: &[u8]) -> (usize, usize, Vec<Rgb>) {
        let (head, mut rest) = file.split_at(8);
        assert_eq!(head, b"\x89PNG\r\n\x1a\n");
        let (mut kinds, mut packed, mut size) = (Vec::new(), Vec::new(), (0, 0));
        let number = |bytes: &[u8]| u32::from_be_bytes(bytes.try_into().unwrap()) as usize;
        while !rest.is_empty() {
            let length = number(&rest[..4]);
            let (kind, data) = (&rest[4..8], &rest[8..8 + length]);
            assert_eq!(
                number(&rest[8 + length..12 + length]),
                crc32fast::hash(&rest[4..8 + length]) as usize
            );
            match kind {
                b"IHDR" => size = (number(&data[..4]), number(&data[4..8])),
                b"IDAT" => packed.extend(data),
                _ => {}
            }
            kinds.push(String::from_utf8(kind.to_vec()).unwrap());
            rest = &rest[12 + length..];
        }
        assert_eq!(kinds, ["IHDR", "pHYs", "IDAT", "IEND"]);
        let mut rows = Vec::new();
        flate2::read::ZlibDecoder::new(&packed[..]).read_to_end(&mut rows).unwrap();
        assert_eq!(rows.len(), size.1 * (1 + 3 * size.0));
        let pixels =
            rows.chunks(1 + 3 * size.0).flat_map(|row| row[1..].chunks(3).map(|c| [c[0], c[1], c[2]]));
        (size.0, size.1, pixels.collect())
    }

    const INK: Rgb = [200, 30, 10];

    #[test]
    fn shapes_are_at_their_places() {
        let mut raster = Raster::new(40.0, 30.5).unwrap();
        let paper = Palette::LIGHT.background;
        raster.rectangle((0.0, 0.0), (40.0, 31.0), paper);
        raster.rectangle((2.0, 2.0), (6.0, 4.0), INK);
        raster.line(&[(10.0, 5.0), (20.0, 5.0)], Pen::solid(INK, 2.0));
        raster.area(&[(30.0, 2.0), (38.0, 2.0), (38.0, 10.0), (30.0, 10.0)], INK, 0.5);
        raster.circle((10.0, 20.0), 4.0, INK, Some(Pen::solid([0; 3], 2.0)));
        raster.boxes(&[((30.0, 20.0), (30.1, 25.0))], INK);
        let (width, height, pixels) = read(&raster.finish().unwrap());
        assert_eq!((width, height), (80, 61));
        let at = |x: f64, y: f64| pixels[(SCALE * y) as usize * width + (SCALE * x) as usize];
        assert_eq!([at(4.0, 3.0), at(15.0, 5.0), at(10.0, 20.0), at(30.2, 22.0)], [INK; 4]);
        assert_eq!([at(1.0, 1.0), at(8.0, 3.0), at(15.0, 8.0), at(31.0, 22.0)], [paper; 4]);
        assert_eq!(at(14.0, 20.0), [0; 3], "the border of the circle");
        let half: Vec<i32> = at(34.0, 6.0).into_iter().map(i32::from).collect();
        for (mixed, (ink, paper)) in half.into_iter().zip(INK.into_iter().zip(paper)) {
            assert!((mixed - (i32::from(ink) + i32::from(paper)) / 2).abs() <= 1);
        }
    }

    #[test]
    fn labels_are_on_their_side_and_run_upwards() {
        for (anchor, across, down) in [
            (Anchor::Left, (40.0, 80.0), (15.0, 25.0)),
            (Anchor::Right, (0.0, 40.0), (15.0, 25.0)),
            (Anchor::Middle, (15.0, 65.0), (15.0, 25.0)),
            (Anchor::Upwards, (35.0, 45.0), (0.0, 40.0)),
        ] {
            let mut raster = Raster::new(80.0, 40.0).unwrap();
            raster.rectangle((0.0, 0.0), (80.0, 40.0), [255; 3]);
            raster.label(&Label::plain("HEMH"), (40.0, 20.0), 10.0, anchor, [0; 3]);
            let (width, _, pixels) = read(&raster.finish().unwrap());
            let dark = pixels
                .iter()
                .enumerate()
                .filter(|(_, pixel)| pixel[0] < 128)
                .map(|(index, _)| ((index % width) as f64 / SCALE, (index / width) as f64 / SCALE));
            let dark: Vec<(f64, f64)> = dark.collect();
            assert!(dark.len() > 100, "{}", dark.len());
            let inside =
                |(x, y): &(f64, f64)| (across.0..across.1).contains(x) && (down.0..down.1).contains(y);
            assert!(dark.iter().all(inside));
        }
    }

    #[test]
    fn too_many_pixels_are_refused_before_they_are_stored() {
        let error = Raster::new(1e6, 1e6).map(drop).unwrap_err();
        assert!(error.to_string().contains("2000000 × 2000000 pixels; allowed: at most 67108864"), "{error}");
        assert!(Raster::new(f64::NAN, 1.0).is_err() && Raster::new(f64::INFINITY, 1.0).is_err());
    }
}
