//! SVG documents as a PDF of one page in its real size: the outlines of [`super::png::tree`], letters included.

use super::chart::Figure;
use super::png::tree;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{LineCapStyle, LineJoinStyle};
use pdf_writer::writers::ExtGraphicsState;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Path as Outline, PathSegment, Point};
use resvg::usvg::{Color, Group, LineCap, LineJoin, Node, Paint, Path, ShapeRendering, Transform, Tree};
use std::collections::BTreeSet;
use std::io;
use std::io::Write;

/// Points (1/72 inch) of a print for each px (1/96 inch) of a document.
const POINTS: f32 = 0.75;
/// Width by which adjacent cells overlap, px: viewers show the paper between edges that only touch.
const OVERLAP: f32 = 0.2;

impl Figure {
    /// Draws the figure and returns the content of a PDF file.
    pub fn pdf(&self) -> io::Result<Vec<u8>> {
        pdf(&tree(&self.svg())?, &self.title)
    }
}

fn pdf(tree: &Tree, title: &str) -> io::Result<Vec<u8>> {
    let [width, height] = [tree.size().width(), tree.size().height()].map(|side| POINTS * side);
    let mut page = Page { content: Content::new(), opacities: BTreeSet::new() };
    page.content.transform([POINTS, 0.0, 0.0, -POINTS, 0.0, height]);
    page.group(tree.root(), Transform::identity());
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(page.content.finish().as_slice())?;
    let [catalog, pages, only, stream, info] = [1, 2, 3, 4, 5].map(Ref::new);
    let mut pdf = Pdf::new();
    pdf.catalog(catalog).pages(pages);
    pdf.pages(pages).kids([only]).count(1);
    let mut one = pdf.page(only);
    one.media_box(Rect::new(0.0, 0.0, width, height)).parent(pages).contents(stream);
    let mut resources = one.resources();
    let mut states = resources.ext_g_states();
    for percent in page.opacities {
        let name = state(percent);
        let mut opacity = states.insert(Name(name.as_bytes())).start::<ExtGraphicsState<'_>>();
        opacity.non_stroking_alpha(f32::from(percent) / 100.0);
    }
    states.finish();
    resources.finish();
    one.finish();
    pdf.stream(stream, &packed.finish()?).filter(Filter::FlateDecode);
    pdf.document_info(info).title(TextStr(title));
    Ok(pdf.finish())
}

/// Drawing operators of a page, and the opacities in per cent that they refer to.
struct Page {
    content: Content,
    opacities: BTreeSet<u8>,
}

impl Page {
    fn group(&mut self, group: &Group, to_page: Transform) {
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner, to_page.pre_concat(inner.transform())),
                Node::Text(text) => self.group(text.flattened(), to_page),
                Node::Path(path) => self.path(path, to_page),
                // Figures have no images.
                Node::Image(_) => {}
            }
        }
    }

    fn path(&mut self, path: &Path, to_page: Transform) {
        self.content.save_state().transform(matrix(to_page));
        // Figures have plain colours alone.
        if let Some((fill, Paint::Color(colour))) = path.fill().map(|fill| (fill, fill.paint())) {
            let ([red, green, blue], opacity) = (rgb(*colour), fill.opacity().get());
            self.content.set_fill_rgb(red, green, blue).set_stroke_rgb(red, green, blue);
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
        if let Some((stroke, Paint::Color(colour))) = path.stroke().map(|stroke| (stroke, stroke.paint())) {
            let [red, green, blue] = rgb(*colour);
            self.content.set_stroke_rgb(red, green, blue).set_line_width(stroke.width().get());
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
                    // The cubic curve of the same shape.
                    let near = |end: Point| (end.x + (by.x - end.x) / 1.5, end.y + (by.y - end.y) / 1.5);
                    let (one, other) = (near(last), near(to));
                    self.content.cubic_to(one.0, one.1, other.0, other.1, to.x, to.y)
                }
                PathSegment::CubicTo(one, other, to) => {
                    self.content.cubic_to(one.x, one.y, other.x, other.y, to.x, to.y)
                }
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

fn state(percent: u8) -> String {
    format!("o{percent}")
}

fn rgb(colour: Color) -> [f32; 3] {
    [colour.red, colour.green, colour.blue].map(|part| f32::from(part) / 255.0)
}

fn matrix(of: Transform) -> [f32; 6] {
    [of.sx, of.ky, of.kx, of.sy, of.tx, of.ty]
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// The size of a page, pt, and its drawing operators.
    fn drawn(elements: &str) -> (String, String) {
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80mm\" height=\"40mm\" viewBox=\"0 0 40 20\">{elements}</svg>"
        );
        let file = pdf(&tree(&svg).unwrap(), "Rough µ").unwrap();
        let find = |words: &[u8]| file.windows(words.len()).position(|window| window == words).unwrap();
        let size = String::from_utf8_lossy(&file[find(b"/MediaBox")..]).split(']').next().unwrap().to_owned();
        let (from, to) = (find(b"\nstream\n") + 8, find(b"\nendstream"));
        let mut content = String::new();
        ZlibDecoder::new(&file[from..to]).read_to_string(&mut content).unwrap();
        (size, content)
    }

    #[test]
    fn a_page_has_its_real_size_and_its_shapes_as_operators() {
        let (size, content) = drawn("<rect x=\"2\" y=\"3\" width=\"4\" height=\"5\" fill=\"#ff0000\"/>");
        let ends: Vec<f32> =
            size.split(' ').skip(1).filter_map(|end| end.trim_matches('[').parse().ok()).collect();
        let points = [80.0, 40.0].map(|mm| mm / 25.4 * 72.0);
        assert!(
            ends.len() == 4 && (ends[2] - points[0]).abs() < 0.01 && (ends[3] - points[1]).abs() < 0.01,
            "{size}"
        );
        assert!(content.contains("1 0 0 RG\n2 3 m\n6 3 l\n6 8 l\n2 8 l\nh\nf\n"), "{content}");
        let (_, line) =
            drawn("<path d=\"M0 0Q1 2 3 0\" fill=\"none\" stroke=\"#0000ff\" stroke-dasharray=\"6 3\"/>");
        assert!(line.contains("0 0 1 RG") && line.contains("[6 3] 0 d") && line.contains(" c\nS"), "{line}");
    }

    #[test]
    fn letters_are_outlines() {
        let (_, letters) = drawn("<text x=\"1\" y=\"9\" font-family=\"DejaVu Sans\">µF</text>");
        assert!(letters.matches(" c\n").count() > 5 && letters.contains("f\n"), "{letters}");
    }
}
