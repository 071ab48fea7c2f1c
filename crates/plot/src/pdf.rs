//! Converts SVG documents to PDF files of one page, which is as large as the document. The outlines
//! are those of [`super::png::tree`]. Text remains text in embedded fonts, so that viewers can
//! search the text and editors can change it.

use super::chart::Figure;
use super::pdf_font::PdfFont;
use super::png::tree;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::writers::ExtGraphicsState;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Path as Outline, PathSegment, Point};
use resvg::usvg::fontdb::{Database, ID};
use resvg::usvg::layout::{PositionedGlyph, Span};
use resvg::usvg::{
    Color, Group, LineCap, LineJoin, Node, Paint, Path, ShapeRendering, Text, Transform, Tree,
};
use std::collections::BTreeSet;
use std::io;
use std::io::Write;

/// Number of points (1/72 inch) of the page for each px (1/96 inch) of the SVG document.
const POINTS: f32 = 0.75;
/// Width in px by which adjacent cells overlap. Without this overlap, viewers show a thin line of
/// paper between the cells.
const OVERLAP: f32 = 0.2;
/// If the distance of a glyph from a line of text is at most this number times the font size, the
/// glyph belongs to the line.
const SAME: f32 = 1e-3;

impl Figure {
    /// Draws the figure and returns the content of a PDF file of one page, as large as the figure.
    ///
    /// # Errors
    /// Returns an error if the SVG document of the figure cannot be converted to PDF.
    pub fn pdf(&self) -> io::Result<Vec<u8>> {
        pdf(&tree(&self.svg())?, &self.title)
    }
}

/// Returns the content of a PDF file of a figure that was written as SVG, without its title.
///
/// # Errors
/// Returns an error if the text is no SVG.
pub fn pdf_of_svg(svg: &str) -> io::Result<Vec<u8>> {
    pdf(&tree(svg)?, "")
}

fn pdf(tree: &Tree, title: &str) -> io::Result<Vec<u8>> {
    let width = POINTS * tree.size().width();
    let height = POINTS * tree.size().height();
    let mut page = Page {
        content: Content::new(),
        opacities: BTreeSet::new(),
        letters: tree.fontdb(),
        fonts: Vec::new(),
    };
    page.content
        .transform([POINTS, 0.0, 0.0, -POINTS, 0.0, height]);
    page.group(tree.root(), Transform::identity());
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(page.content.finish().as_slice())?;
    let [catalog_ref, pages_ref, page_ref, stream_ref, info_ref] = [1, 2, 3, 4, 5].map(Ref::new);
    let first_of_fonts = info_ref.get() + 1;
    let mut pdf = Pdf::new();
    pdf.catalog(catalog_ref).pages(pages_ref);
    pdf.pages(pages_ref).kids([page_ref]).count(1);
    let mut page_object = pdf.page(page_ref);
    page_object
        .media_box(Rect::new(0.0, 0.0, width, height))
        .parent(pages_ref)
        .contents(stream_ref);
    let mut resources = page_object.resources();
    let mut states = resources.ext_g_states();
    for percent in page.opacities {
        let name = state(percent);
        let mut opacity = states
            .insert(Name(name.as_bytes()))
            .start::<ExtGraphicsState<'_>>();
        opacity.non_stroking_alpha(f32::from(percent) / 100.0);
    }
    states.finish();
    let mut fonts = resources.fonts();
    for (index, font) in page.fonts.iter().enumerate() {
        let reference = font.reference(first_of_fonts, index);
        fonts.pair(Name(font.name(index).as_bytes()), reference);
    }
    fonts.finish();
    resources.finish();
    page_object.finish();
    pdf.stream(stream_ref, &packed.finish()?)
        .filter(Filter::FlateDecode);
    pdf.document_info(info_ref).title(TextStr(title));
    for (index, font) in page.fonts.iter().enumerate() {
        font.write(&mut pdf, first_of_fonts, index)?;
    }
    Ok(pdf.finish())
}

/// Drawing operators of a page, with the opacities (in per cent) and the fonts that occur in the
/// operators.
struct Page<'a> {
    content: Content,
    opacities: BTreeSet<u8>,
    letters: &'a Database,
    fonts: Vec<PdfFont>,
}

/// Beginning of a run. A run is a sequence of glyphs on one base line, in one font and one font
/// size.
#[derive(Clone, Copy)]
struct RunStart {
    matrix: Transform,
    size: f32,
}

impl RunStart {
    /// Returns the distance of a glyph from the beginning of the run along the base line, divided
    /// by the font size. `matrix` places the glyph on the page. Returns `None` if the glyph is not
    /// on the base line of the run, or differs from the run in size or direction.
    fn distance_to(self, matrix: Transform) -> Option<f32> {
        let begin = self.matrix;
        let dx = (matrix.tx - begin.tx) / self.size;
        let dy = (matrix.ty - begin.ty) / self.size;
        let across = dx * begin.ky - dy * begin.sx;
        let along = dx * begin.sx + dy * begin.ky;
        let is_alike = (matrix.sx - begin.sx).hypot(matrix.ky - begin.ky) < SAME * self.size;
        (is_alike && across.abs() < SAME * self.size).then(|| along / self.size)
    }
}

impl Page<'_> {
    fn group(&mut self, group: &Group, to_page: Transform) {
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner, to_page.pre_concat(inner.transform())),
                Node::Text(text) => self.text(text, to_page),
                Node::Path(path) => self.path(path, to_page),
                // Figures have no images.
                Node::Image(_) => {}
            }
        }
    }

    fn text(&mut self, text: &Text, to_page: Transform) {
        for span in text.layouted() {
            // The text of figures has only plain colours.
            if let Some(Paint::Color(colour)) = span.fill.as_ref().map(|fill| fill.paint()) {
                let [red, green, blue] = rgb(*colour);
                self.content
                    .save_state()
                    .set_fill_rgb(red, green, blue)
                    .begin_text();
                self.letters(span, to_page);
                self.content.end_text().restore_state();
            }
        }
    }

    /// Writes the glyphs of a text into the page, divided into runs.
    fn letters(&mut self, span: &Span, to_page: Transform) {
        let mut rest = span.positioned_glyphs.as_slice();
        while let Some(first) = rest.first() {
            let Some(index) = self.font(first.font) else {
                return;
            };
            let em = self.fonts[index].units_per_em();
            let start_matrix = glyph_matrix(first, to_page, em);
            let start = RunStart {
                matrix: start_matrix,
                size: start_matrix.sx.hypot(start_matrix.ky),
            };
            let mut distances: Vec<f32> = Vec::new();
            for glyph in rest {
                let distance = start.distance_to(glyph_matrix(glyph, to_page, em));
                match distance {
                    Some(distance) if glyph.font == first.font => distances.push(distance),
                    _ => break,
                }
            }
            let (run, next) = rest.split_at(distances.len().max(1));
            let font = &mut self.fonts[index];
            self.content
                .set_font(Name(font.name(index).as_bytes()), 1.0)
                .set_text_matrix(matrix(start.matrix));
            let mut shown = self.content.show_positioned();
            let mut items = shown.items();
            let mut reached = 0.0;
            for (glyph, distance) in run.iter().zip(distances) {
                // The operator of PDF moves the next glyph to the left by this number, which is in
                // thousandths of the font size.
                let adjusted = 1000.0 * (reached - distance);
                if adjusted.abs() > 0.5 {
                    items.adjust(adjusted);
                    reached = distance;
                }
                reached += font.show(&mut items, glyph.id.0, &glyph.text) / 1000.0;
            }
            rest = next;
        }
    }

    /// Returns the index of a font on this page, and adds the font if necessary; `None` if the font
    /// cannot be read.
    fn font(&mut self, id: ID) -> Option<usize> {
        let known = self.fonts.iter().position(|font| font.is(id));
        known.or_else(|| {
            self.fonts.push(PdfFont::new(self.letters, id)?);
            Some(self.fonts.len() - 1)
        })
    }

    fn path(&mut self, path: &Path, to_page: Transform) {
        self.content.save_state().transform(matrix(to_page));
        // The areas of figures have only plain colours.
        if let Some((fill, Paint::Color(colour))) = path.fill().map(|fill| (fill, fill.paint())) {
            let [red, green, blue] = rgb(*colour);
            let opacity = fill.opacity().get();
            self.content
                .set_fill_rgb(red, green, blue)
                .set_stroke_rgb(red, green, blue);
            if opacity < 1.0 {
                let percent = (100.0 * opacity).round() as u8;
                self.opacities.insert(percent);
                self.content.set_parameters(Name(state(percent).as_bytes()));
            }
            if path.rendering_mode() == ShapeRendering::CrispEdges {
                self.content.set_line_width(OVERLAP);
                self.outline(path.data()).fill_nonzero_and_stroke();
            } else {
                self.outline(path.data()).fill_nonzero();
            }
        }
        if let Some((stroke, Paint::Color(colour))) =
            path.stroke().map(|stroke| (stroke, stroke.paint()))
        {
            let [red, green, blue] = rgb(*colour);
            self.content
                .set_stroke_rgb(red, green, blue)
                .set_line_width(stroke.width().get());
            if stroke.linejoin() == LineJoin::Round {
                self.content.set_line_join(LineJoinStyle::RoundJoin);
            }
            if stroke.linecap() == LineCap::Round {
                self.content.set_line_cap(LineCapStyle::RoundCap);
            }
            if let Some(dashes) = stroke.dasharray() {
                self.content.set_dash_pattern(dashes.iter().copied(), 0.0);
            }
            self.outline(path.data()).stroke();
        }
        self.content.restore_state();
    }

    fn outline(&mut self, outline: &Outline) -> &mut Content {
        let mut last = Point::default();
        for segment in outline.segments() {
            match segment {
                PathSegment::MoveTo(to) => self.content.move_to(to.x, to.y),
                PathSegment::LineTo(to) => self.content.line_to(to.x, to.y),
                PathSegment::QuadTo(by, to) => {
                    // PDF has no quadratic curves. This cubic curve has the same shape.
                    let near =
                        |end: Point| (end.x + (by.x - end.x) / 1.5, end.y + (by.y - end.y) / 1.5);
                    let (x1, y1) = near(last);
                    let (x2, y2) = near(to);
                    self.content.cubic_to(x1, y1, x2, y2, to.x, to.y)
                }
                PathSegment::CubicTo(first, second, to) => self
                    .content
                    .cubic_to(first.x, first.y, second.x, second.y, to.x, to.y),
                PathSegment::Close => self.content.close_path(),
            };
            if let PathSegment::MoveTo(to)
            | PathSegment::LineTo(to)
            | PathSegment::QuadTo(_, to)
            | PathSegment::CubicTo(_, _, to) = segment
            {
                last = to;
            }
        }
        &mut self.content
    }
}

/// Returns the matrix that places a glyph on the page. Its argument is a glyph of font size 1.
fn glyph_matrix(glyph: &PositionedGlyph, to_page: Transform, em: f32) -> Transform {
    to_page
        .pre_concat(glyph.outline_transform())
        .pre_concat(Transform::from_scale(em, em))
}

/// Returns the name of the graphics state with this opacity in per cent.
fn state(percent: u8) -> String {
    format!("o{percent}")
}

fn rgb(colour: Color) -> [f32; 3] {
    [colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0)
}

fn matrix(transform: Transform) -> [f32; 6] {
    let Transform {
        sx,
        kx,
        ky,
        sy,
        tx,
        ty,
    } = transform;
    [sx, ky, kx, sy, tx, ty]
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    fn document(elements: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80mm\" height=\"40mm\" viewBox=\"0 0 40 20\">{elements}</svg>"
        )
    }

    fn find(file: &[u8], words: &[u8]) -> usize {
        file.windows(words.len())
            .position(|window| window == words)
            .unwrap()
    }

    /// Returns the drawing operators of a PDF file. They are in the first stream of the file.
    fn inflated(file: &[u8]) -> String {
        let (from, to) = (find(file, b"\nstream\n") + 8, find(file, b"\nendstream"));
        let mut content = String::new();
        ZlibDecoder::new(&file[from..to])
            .read_to_string(&mut content)
            .unwrap();
        content
    }

    /// Returns the page size in points, and the drawing operators of the page.
    fn drawn(elements: &str) -> (String, String) {
        let file = pdf(&tree(&document(elements)).unwrap(), "Rough µ").unwrap();
        let size = String::from_utf8_lossy(&file[find(&file, b"/MediaBox")..]);
        (size.split(']').next().unwrap().to_owned(), inflated(&file))
    }

    #[test]
    fn a_page_has_its_real_size_and_its_shapes_as_operators() {
        let (size, content) =
            drawn("<rect x=\"2\" y=\"3\" width=\"4\" height=\"5\" fill=\"#ff0000\"/>");
        let ends: Vec<f32> = size
            .split(' ')
            .skip(1)
            .filter_map(|end| end.trim_matches('[').parse().ok())
            .collect();
        let points = [80.0, 40.0].map(|mm| mm / 25.4 * 72.0);
        assert!(
            ends.len() == 4
                && (ends[2] - points[0]).abs() < 0.01
                && (ends[3] - points[1]).abs() < 0.01,
            "{size}"
        );
        assert!(
            content.contains("1 0 0 RG\n2 3 m\n6 3 l\n6 8 l\n2 8 l\nh\nf\n"),
            "{content}"
        );
        let (_, line) = drawn(
            "<path d=\"M0 0Q1 2 3 0\" fill=\"none\" stroke=\"#0000ff\" stroke-dasharray=\"6 3\"/>",
        );
        assert!(
            line.contains("0 0 1 RG") && line.contains("[6 3] 0 d") && line.contains(" c\nS"),
            "{line}"
        );
    }

    /// Returns the text of a PDF file, with one line for each run. The table of glyphs in the file
    /// gives the letters of each glyph.
    fn read(file: &[u8]) -> String {
        let text = String::from_utf8_lossy(file);
        let number = |hex: &str| u32::from_str_radix(hex, 16).unwrap();
        let mut letters = std::collections::BTreeMap::new();
        for block in text.split(" beginbfchar\n").skip(1) {
            for line in block.split("endbfchar").next().unwrap().lines() {
                let pair: Vec<&str> = line.split(['<', '>']).collect();
                letters.insert(number(pair[1]), char::from_u32(number(pair[3])).unwrap());
            }
        }
        let content = inflated(file);
        let runs = content
            .split('[')
            .skip(1)
            .filter_map(|run| Some(run.rsplit_once("] TJ")?.0));
        let line = |run| {
            glyphs(run)
                .into_iter()
                .map(|glyph| letters[&glyph])
                .collect::<String>()
        };
        runs.map(line).collect::<Vec<_>>().join("\n")
    }

    /// Returns the glyph numbers in the strings of a run, two bytes for each glyph. Bytes are
    /// written as letters, as escaped letters or as pairs of hexadecimal digits.
    fn glyphs(run: &str) -> Vec<u32> {
        let (mut bytes, mut rest) = (Vec::new(), run.chars().peekable());
        while let Some(opening) = rest.next() {
            match opening {
                '<' => {
                    let digits: Vec<u32> = rest
                        .by_ref()
                        .map_while(|digit| digit.to_digit(16))
                        .collect();
                    bytes.extend(digits.chunks(2).map(|pair| 16 * pair[0] + pair[1]));
                }
                '(' => loop {
                    bytes.push(match rest.next().unwrap() {
                        ')' => break,
                        '\\' => match rest.next().unwrap() {
                            'n' => 10,
                            'r' => 13,
                            't' => 9,
                            'b' => 8,
                            'f' => 12,
                            first @ '0'..='7' => {
                                let digits = [first, rest.next().unwrap(), rest.next().unwrap()];
                                digits
                                    .iter()
                                    .fold(0, |octal, digit| 8 * octal + digit.to_digit(8).unwrap())
                            }
                            other => u32::from(other),
                        },
                        letter => u32::from(letter),
                    });
                },
                _ => {}
            }
        }
        bytes
            .chunks(2)
            .map(|pair| 256 * pair[0] + pair[1])
            .collect()
    }

    #[test]
    fn text_is_text_in_an_embedded_font() {
        let style = "font-family=\"DejaVu Sans\" font-size=\"2\"";
        let elements = format!(
            "<text x=\"1\" y=\"9\" {style}>κ = √µN</text><text x=\"5\" y=\"9\" {style} transform=\"rotate(-90 5 9)\">force \
             <tspan font-style=\"italic\">F</tspan> (µN)</text>"
        );
        let file = pdf(&tree(&document(&elements)).unwrap(), "").unwrap();
        assert_eq!(read(&file), "κ = √µN\nforce \nF\n (µN)");
        let content = inflated(&file);
        // The page contains no curves, so letters are not drawn as outlines. The label that is
        // written upwards is turned by 90 degrees.
        assert!(
            !content.contains(" c\n") && content.contains(" -15.118111 -15.118111 "),
            "{content}"
        );
        let text = String::from_utf8_lossy(&file);
        assert_eq!(text.matches("/FontFile2").count(), 2, "two faces");
    }
}
