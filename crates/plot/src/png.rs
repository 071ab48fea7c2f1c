//! Converts SVG documents to PNG files. The fonts are embedded in the program, so that equal
//! documents give equal pixels on every computer.

use super::chart::Figure;
use png::{BitDepth, ColorType, Encoder, PixelDimensions, Unit};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use std::io;
use std::sync::Arc;

/// The upright and the oblique font. Both contain the same Latin, Greek, Cyrillic and mathematical
/// characters. LICENSE in the folder `font` states their licence.
const FONTS: [&[u8]; 2] = [
    include_bytes!("font/sans.ttf"),
    include_bytes!("font/sans-oblique.ttf"),
];
/// Number of pixels for each px (1/96 inch) of a document, if the figure has no given width.
const SCALE: f32 = 2.0;
/// Number of pixels for each px (1/96 inch) of a figure with a given width, which gives 600 pixels
/// per inch.
const PRINT_SCALE: f32 = 6.25;
const MOST_PIXELS: f64 = (1_u32 << 26) as f64;
/// Number of px (1/96 inch) in a metre.
const PX: f32 = 96.0 / 0.0254;

impl Figure {
    /// Draws the figure and returns the content of a PNG file. The resolution is 600 dpi if the
    /// figure has a given [`Self::width`], otherwise 192 dpi.
    ///
    /// # Errors
    /// Returns an error if the picture would have more than 67 million pixels (2^26).
    pub fn png(&self) -> io::Result<Vec<u8>> {
        let scale = if self.width.is_some() {
            PRINT_SCALE
        } else {
            SCALE
        };
        png(&self.svg(), scale)
    }
}

/// Returns the content of a PNG file of a figure that was written as SVG, as [`Figure::png`] does
/// for a figure without a width.
///
/// # Errors
/// Returns an error if the text is no SVG, or if the picture would have too many pixels.
pub fn png_of_svg(svg: &str) -> io::Result<Vec<u8>> {
    png(svg, SCALE)
}

/// Converts an SVG document to a tree of outlines, with lengths in px (1/96 inch).
pub(super) fn tree(svg: &str) -> io::Result<Tree> {
    let mut fonts = Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    let options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    Tree::from_str(svg, &options).map_err(io::Error::other)
}

/// Draws an SVG document on a white background and returns the content of a PNG file.
fn png(svg: &str, scale: f32) -> io::Result<Vec<u8>> {
    let tree = tree(svg)?;
    let width = (scale * tree.size().width()).ceil();
    let height = (scale * tree.size().height()).ceil();
    if f64::from(width) * f64::from(height) > MOST_PIXELS {
        return Err(too_many_pixels(width, height));
    }
    let Some(mut pixmap) = Pixmap::new(width as u32, height as u32) else {
        return Err(too_many_pixels(width, height));
    };
    // The document may cover the last pixels only in part, so that the white background shows
    // there.
    pixmap.fill(Color::WHITE);
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixmap.as_mut(),
    );
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    let per_metre = (scale * PX).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: Unit::Meter,
    }));
    let pixels: Vec<u8> = pixmap
        .data()
        .chunks_exact(4)
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(file)
}

fn too_many_pixels(width: f32, height: f32) -> io::Error {
    io::Error::other(format!(
        "a picture of {width} × {height} pixels; allowed: at most {MOST_PIXELS} in all; SVG has no \
         limit"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(elements: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"40\" height=\"30.5\">{elements}</svg>"
        )
    }

    fn pixels(elements: &str) -> (usize, Vec<[u8; 3]>) {
        let file = png(&document(elements), SCALE).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file))
            .read_info()
            .unwrap();
        assert_eq!(reader.info().pixel_dims.map(|dims| dims.xppu), Some(7559));
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(
            (frame.width, frame.height, frame.color_type),
            (80, 61, ColorType::Rgb)
        );
        (frame.width as usize, bytes.as_chunks::<3>().0.to_vec())
    }

    #[test]
    fn shapes_are_at_their_places_on_white() {
        let (width, pixels) =
            pixels("<rect x=\"2\" y=\"2\" width=\"4\" height=\"3\" fill=\"#c81e0a\"/>");
        for (index, colour) in pixels.iter().enumerate() {
            let (x, y) = (index % width, index / width);
            let inside = (4..12).contains(&x) && (4..10).contains(&y);
            assert_eq!(
                *colour,
                if inside { [0xc8, 0x1e, 0x0a] } else { [255; 3] },
                "{x} {y}"
            );
        }
    }

    #[test]
    fn the_fonts_have_the_characters_of_figures() {
        let drawn = |character: char, style: &str| {
            let style = format!(
                "x=\"9\" y=\"20\" font-family=\"sans-serif, DejaVu Sans\" font-style=\"{style}\""
            );
            pixels(&format!("<text {style}>{character}</text>")).1
        };
        let missing = drawn('汉', "normal");
        for character in "Az09 µγκδπ−·×±≤∇√°⁻¹²³…–“”éßЖ".chars() {
            let both = ["normal", "italic"].map(|style| drawn(character, style));
            assert!(both.iter().all(|drawn| *drawn != missing), "{character}");
            assert!(
                !character.is_ascii_alphanumeric() || both[0] != both[1],
                "{character}"
            );
        }
    }

    #[test]
    fn too_many_pixels_are_refused() {
        let error = png(
            &document("").replace("40", "1e6").replace("30.5", "1e6"),
            SCALE,
        )
        .unwrap_err();
        assert!(
            error
                .to_string()
                .contains("2000000 × 2000000 pixels; allowed: at most 67108864"),
            "{error}"
        );
    }
}
