//! A font embedded in a PDF file. For each glyph the file also contains the letters that the glyph
//! shows, so that viewers can search the text.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::writers::PositionedItems;
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use resvg::usvg::fontdb::{Database, ID, Style};
use std::collections::BTreeMap;
use std::io;
use std::io::Write;
use ttf_parser::{Face, GlyphId};

/// Number of PDF objects that describe one font.
const OBJECTS: i32 = 5;
/// With the character collection Identity, the glyph numbers in the PDF file are those of the font.
const IDENTITY: SystemInfo<'_> = SystemInfo {
    registry: Str(b"Adobe"),
    ordering: Str(b"Identity"),
    supplement: 0,
};
/// Width of vertical stems of letters, in thousandths of the font size. If a viewer has to replace
/// the font, it uses this width to choose another font.
const STEM: f32 = 80.0;

pub(super) struct PdfFont {
    id: ID,
    name: String,
    is_italic: bool,
    data: Vec<u8>,
    units_per_em: f32,
    /// The glyphs that the page shows, by their numbers in the font.
    glyphs: BTreeMap<u16, ShownGlyph>,
}

struct ShownGlyph {
    /// Width in thousandths of the font size.
    width: f32,
    letters: String,
}

impl PdfFont {
    /// Reads the font `id` from `fonts`; `None` if the font cannot be read.
    pub(super) fn new(fonts: &Database, id: ID) -> Option<PdfFont> {
        let face = fonts.face(id)?;
        let name = face.post_script_name.clone();
        let is_italic = face.style != Style::Normal;
        let data = fonts.with_face_data(id, |data, _| data.to_vec())?;
        let units_per_em = f32::from(Face::parse(&data, 0).ok()?.units_per_em());
        Some(PdfFont {
            id,
            name,
            is_italic,
            data,
            units_per_em,
            glyphs: BTreeMap::new(),
        })
    }

    pub(super) fn is(&self, id: ID) -> bool {
        self.id == id
    }

    pub(super) fn units_per_em(&self) -> f32 {
        self.units_per_em
    }

    /// Returns the name that the page uses for the font with this index.
    pub(super) fn name(&self, index: usize) -> String {
        format!("f{index}")
    }

    /// Returns the first object number of the font with this index. `first` is the first object
    /// number of all fonts together.
    pub(super) fn reference(&self, first: i32, index: usize) -> Ref {
        Ref::new(first + OBJECTS * index as i32)
    }

    /// Shows a glyph on the page. Returns the width of the glyph in thousandths of the font size.
    /// `letters` is the text that the glyph shows.
    pub(super) fn show(
        &mut self,
        items: &mut PositionedItems<'_>,
        glyph: u16,
        letters: &str,
    ) -> f32 {
        items.show(Str(&glyph.to_be_bytes()));
        if let Some(shown) = self.glyphs.get(&glyph) {
            return shown.width;
        }
        let width = self.width(glyph);
        let letters = letters.to_owned();
        self.glyphs.insert(glyph, ShownGlyph { width, letters });
        width
    }

    /// Returns the width of a glyph in thousandths of the font size.
    fn width(&self, glyph: u16) -> f32 {
        let face = Face::parse(&self.data, 0).ok();
        let advance = face.and_then(|face| face.glyph_hor_advance(GlyphId(glyph)));
        1000.0 * f32::from(advance.unwrap_or(0)) / self.units_per_em
    }

    /// Writes the PDF objects of the font. `first` is the first object number of all fonts
    /// together, and `index` is the index of this font on the page.
    pub(super) fn write(&self, pdf: &mut Pdf, first: i32, index: usize) -> io::Result<()> {
        let reference = self.reference(first, index);
        let [cid, descriptor, letters, file] =
            [1, 2, 3, 4].map(|next| Ref::new(reference.get() + next));
        let name = Name(self.name.as_bytes());
        let face = Face::parse(&self.data, 0).map_err(io::Error::other)?;
        let scaled = |units: i16| 1000.0 * f32::from(units) / self.units_per_em;
        pdf.type0_font(reference)
            .base_font(name)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid)
            .to_unicode(letters);
        let mut font = pdf.cid_font(cid);
        font.subtype(CidFontType::Type2)
            .base_font(name)
            .system_info(IDENTITY)
            .font_descriptor(descriptor);
        font.cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = font.widths();
        for (glyph, shown) in &self.glyphs {
            widths.same(*glyph, *glyph, shown.width);
        }
        widths.finish();
        font.finish();
        let bounds = face.global_bounding_box();
        let bounding_box = Rect::new(
            scaled(bounds.x_min),
            scaled(bounds.y_min),
            scaled(bounds.x_max),
            scaled(bounds.y_max),
        );
        let style = if self.is_italic {
            FontFlags::ITALIC
        } else {
            FontFlags::empty()
        };
        pdf.font_descriptor(descriptor)
            .name(name)
            .flags(FontFlags::SYMBOLIC | style)
            .bbox(bounding_box)
            .italic_angle(face.italic_angle())
            .ascent(scaled(face.ascender()))
            .descent(scaled(face.descender()))
            .cap_height(scaled(face.capital_height().unwrap_or(face.ascender())))
            .stem_v(STEM)
            .font_file2(file);
        let mut cmap = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
        for (glyph, shown) in &self.glyphs {
            cmap.pair_with_multiple(*glyph, shown.letters.chars());
        }
        pdf.cmap(letters, cmap.finish().as_slice());
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
        packed.write_all(&self.data)?;
        let packed = packed.finish()?;
        pdf.stream(file, &packed)
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), self.data.len() as i32);
        Ok(())
    }
}
