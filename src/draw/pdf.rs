//! SVG documents as PDF of one page in its real size: the outlines of [`super::png::tree`], letters included.

use super::chart::Figure;
use super::png::tree;
use flate2::{Compression, write::ZlibEncoder};
use pdf_writer::types::LineJoinStyle;
use pdf_writer::writers::ExtGraphicsState;
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};
use resvg::tiny_skia::{Path as Outline, PathSegment, Point, Rect as Area};
use resvg::usvg::{
    Color, Group, LineJoin, LinearGradient, Node, Paint, Path, Pattern, ShapeRendering, Transform, Tree,
};
use std::collections::BTreeSet;
use std::io::{self, Write};

/// Points of a print for each px of a document, 1/96 inch.
const POINTS: f32 = 0.75;
/// Bands of equal colour in which a colour scale is drawn.
const BANDS: usize = 256;
/// Width by which adjacent cells overlap, px: viewers show the paper through edges that only touch.
const OVERLAP: f32 = 0.2;

impl Figure {
    /// The figure as the content of a PDF file.
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

/// The drawing operators of a page, and the opacities that they name, %.
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
        match path.fill().map(|fill| (fill.paint(), fill.opacity().get())) {
            Some((Paint::Color(colour), opacity)) => {
                let [red, green, blue] = rgb(*colour);
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
            Some((Paint::LinearGradient(scale), _)) => {
                self.outline(path.data()).clip_nonzero().end_path();
                self.bands(scale);
            }
            Some((Paint::Pattern(pattern), _)) => {
                self.outline(path.data()).clip_nonzero().end_path();
                self.tiles(pattern, path.bounding_box());
            }
            _ => {}
        }
        if let Some((stroke, Paint::Color(colour))) = path.stroke().map(|stroke| (stroke, stroke.paint())) {
            let [red, green, blue] = rgb(*colour);
            self.content.set_stroke_rgb(red, green, blue).set_line_width(stroke.width().get());
            if stroke.linejoin() == LineJoin::Round {
                self.content.set_line_join(LineJoinStyle::RoundJoin);
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

    /// Fills the area of the clip path with an upright colour scale, as wide and as high as this area.
    fn bands(&mut self, scale: &LinearGradient) {
        self.content.transform(matrix(scale.transform()));
        for band in 0..BANDS {
            let at = band as f32 / BANDS as f32;
            let stops = scale.stops();
            let after = stops.partition_point(|stop| stop.offset().get() <= at).clamp(1, stops.len() - 1);
            let [from, to] = [&stops[after - 1], &stops[after]];
            let [start, end] = [from, to].map(|stop| stop.offset().get());
            let share = (at - start) / (end - start);
            let [from, to] = [from, to].map(|stop| rgb(stop.color()));
            let [red, green, blue] = [0, 1, 2].map(|part| from[part] + share * (to[part] - from[part]));
            let y = scale.y1() + at * (scale.y2() - scale.y1());
            // The rest of the scale, below the bands that follow.
            self.content.set_fill_rgb(red, green, blue).rect(0.0, y, 1.0, scale.y2() - y).fill_nonzero();
        }
    }

    /// Fills an area with a pattern.
    fn tiles(&mut self, pattern: &Pattern, area: Area) {
        let size = (pattern.rect().width(), pattern.rect().height());
        let from = ((area.left() / size.0).floor() as i32, (area.top() / size.1).floor() as i32);
        let to = ((area.right() / size.0).ceil() as i32, (area.bottom() / size.1).ceil() as i32);
        for (row, column) in (from.1..to.1).flat_map(|row| (from.0..to.0).map(move |column| (row, column))) {
            let place = Transform::from_translate(column as f32 * size.0, row as f32 * size.1);
            self.group(pattern.root(), place);
        }
    }
}

/// Name of the graphics state of an opacity, %.
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
    fn letters_colour_scales_and_hatching_are_outlines() {
        let (_, letters) = drawn("<text x=\"1\" y=\"9\" font-family=\"DejaVu Sans\">µF</text>");
        assert!(letters.matches(" c\n").count() > 5 && letters.contains("f\n"), "{letters}");
        let scale = "<linearGradient id=\"s\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\"><stop offset=\"0\" \
                     stop-color=\"#000000\"/><stop offset=\"1\" stop-color=\"#ffffff\"/></linearGradient>";
        let (_, bands) = drawn(&format!("{scale}<rect width=\"4\" height=\"8\" fill=\"url(#s)\"/>"));
        assert_eq!(bands.matches(" re\nf\n").count(), BANDS);
        assert!(bands.contains("0 0 0 rg") && bands.contains("W\nn"), "{bands}");
        let tile = "<pattern id=\"t\" width=\"2\" height=\"2\" patternUnits=\"userSpaceOnUse\"><path \
                    d=\"M0 2L2 0\" stroke=\"#808080\"/></pattern>";
        let (_, tiles) = drawn(&format!("{tile}<rect width=\"4\" height=\"6\" fill=\"url(#t)\"/>"));
        assert_eq!(tiles.matches("S\n").count(), 6, "{tiles}");
    }
}
