//! Header of a text: the lines above the numbers, which state units and sizes and may name columns.

use super::super::unit::Unit;
use asperity_data::text_table::{
    COMMENT, Decimal, HeadLines, Separator, TextCell, TextColumn, is_one_of,
};

/// Largest length in bytes of a header line that is examined.
const LONGEST: usize = 4096;

/// Keys with which a header states the width of a map, in English and in the other languages of the
/// program Gwyddion.
const WIDTH: &str = "width x-length šířka breite anchura largeur larghezza 幅 폭 largura ширина";

/// Keys with which a header states the height of a map (its size along y), in these languages.
const HEIGHT: &str = "height y-length výška höhe altura hauteur altezza 高さ 높이 высота";

/// Keys with which a header states the name of a channel, in these languages.
const CHANNEL: &str = "channel kanál kanal canal canale チャネル 채널 канал";

/// Words for `unit`, in several languages. A key with such a word states a unit.
const UNIT: &str = "unit units einheit einheiten jednotka jednotky unité unités unità unidad unidades единицы 単位 단위 値の単位";

/// Words that may occur beside `unit` in a key, and that mean the unit of the heights.
const OF_HEIGHTS: &str = "z value values height heights data hodnot valore valor 값";

/// Words that may occur beside `unit` in a key, and that mean the unit of positions along x and y.
const OF_POSITIONS: &str = "xy lateral position positions distance";

/// Words that may occur beside `unit` in a key, but do not say to which axis the unit belongs.
const OF_ALL: &str = "length lengths axis de измерения";

/// Keys with which a header states one distance between points, for both axes of a map.
const SPACING: [&str; 8] = [
    "xy calibration",
    "pixel size",
    "sampling distance",
    "sampling interval",
    "sample spacing",
    "point spacing",
    "spacing",
    "pixel_size",
];

/// Keys with which a header states the distance between points along one axis: x, then y.
const SPACING_OF_AXIS: [[&str; 4]; 2] = [
    ["scale x", "dx", "delta x", "x spacing"],
    ["scale y", "dy", "delta y", "y spacing"],
];

/// Keys with which files of the program WSxM state the sizes of a map. Of the size in z, which is
/// the range of the heights, only the unit is used.
const AMPLITUDES: [&str; 3] = ["x amplitude", "y amplitude", "z amplitude"];

/// Key of the unit of the heights of a profile in files of the program WSxM.
const UNIT_OF_ORDINATE: &str = "y axis unit";

/// Keys with which a header states the number of columns, then the number of rows.
const COUNTS: [&str; 2] = ["horizontal x-pixels nx", "vertical y-pixels ny"];

/// First words of the header of Wyko, a maker of interferometers. The rows of numbers in such a
/// file run along y. The number after these words says whether the heights are in nm or in
/// wavelengths.
const WYKO: &str = "wyko ascii data file format";

/// Number, counted from 1, of the header line with the distance between points in the format Zygo
/// XYZ.
const LINE_OF_DISTANCE: usize = 8;

/// Unit of lengths in headers of the program SPIP.
const NANOMETRE: &str = "nm";

/// Unit of lengths in headers of Wyko.
const MILLIMETRE: &str = "mm";

/// Index of x in arrays with one element for each of x, y and height.
pub(super) const X: usize = 0;

/// Index of y in arrays with one element for each of x, y and height.
pub(super) const Y: usize = 1;

/// Index of the heights in arrays with one element for each of x, y and height.
pub(super) const Z: usize = 2;

/// A length in a header. `unit` is `None` if no unit is written after the number.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Length {
    value: f64,
    unit: Option<Unit>,
}

impl Length {
    fn millimetres(value: f64) -> Self {
        Length {
            value,
            unit: MILLIMETRE.parse().ok(),
        }
    }

    fn bare(value: f64) -> Self {
        Length { value, unit: None }
    }

    /// Reads a length with its unit, or a number alone.
    fn with_or_without_unit(text: &str) -> Option<Self> {
        Length::parse(text).or_else(|| number(text).map(Length::bare))
    }

    /// Reads a length and its unit from a text such as `10.5 µm`, `24µm`, `24 (µm)` or
    /// `500 nm/pixel`.
    fn parse(text: &str) -> Option<Self> {
        let is_of_number = |c: char| c.is_ascii_digit() || ".,+-eE".contains(c);
        let end = text.find(|c: char| !is_of_number(c))?;
        let (value, unit) = text.split_at(end);
        let unit = unit.split('/').next()?.trim().trim_matches(BRACKETS);
        Some(Length {
            value: number(value)?,
            unit: Some(unit.parse().ok()?),
        })
    }
}

/// Brackets around units.
const BRACKETS: [char; 4] = ['[', ']', '(', ')'];

/// Header of a text: the lines above its numbers, with the units, sizes and names that they state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextHeader {
    /// Name of the channel; `None` if the header states none.
    pub channel: Option<String>,
    /// Units of x, y and heights, from keys that say to which of them the unit belongs.
    units: [Option<Unit>; 3],
    /// Unit of all lengths, from a key that does not say to which axis the unit belongs.
    unit: Option<Unit>,
    /// Unit of the heights if it is not a unit of length; otherwise `None`.
    pub other_unit: Option<String>,
    /// Width and height of a map.
    sizes: [Option<Length>; 2],
    /// Distances between points of a map, along the rows and between the rows.
    spacing: [Option<Length>; 2],
    /// Number of columns and number of rows that the header states; `None` for a number that the
    /// header does not state.
    pub counts: [Option<usize>; 2],
    /// Factor by which the numbers in the file are multiplied to give the heights.
    factor: Option<f64>,
    /// Factor by which the numbers in the file are multiplied to give the heights in nm. It is used
    /// only if the file states no unit of heights.
    nanometres: Option<f64>,
    /// Factor by which the numbers in the file are multiplied only if `is_data_scale_needed` is
    /// true.
    data_scale: Option<f64>,
    is_data_scale_needed: bool,
    /// True if neighbouring points in a row of numbers are neighbours along y.
    pub is_along_y: bool,
    /// True if the positions of points in the file are only the numbers of the columns and rows of
    /// the points, and not lengths.
    pub has_counted_positions: bool,
    /// True if the heights are in wavelengths of light.
    is_in_wavelengths: bool,
    /// Last lines of the header that have no key. One of them may name the columns.
    pub lines: HeadLines,
}

impl TextHeader {
    /// Creates a header that states the unit `unit` for all lengths, and nothing else.
    pub fn in_unit(unit: Option<Unit>) -> TextHeader {
        TextHeader {
            unit,
            ..TextHeader::default()
        }
    }

    /// Reads a line of the header. A line `key: value`, `key = value` or `key,value` may state a
    /// unit, a size or a channel. Any other line may name columns.
    pub fn take(&mut self, line: &str) {
        let line = line.trim_start_matches(COMMENT).trim();
        if line.len() <= LONGEST
            && let Some(entry) = Entry::parse(line)
            && self.take_entry(&entry).is_some()
        {
            return;
        }
        self.lines.take(line);
    }

    /// Takes what an entry of the header states. Returns `None` if its key or its value is unknown.
    fn take_entry(&mut self, entry: &Entry) -> Option<()> {
        let key = entry.key.as_str();
        let value = entry.value.as_str();
        if is_one_of(key, CHANNEL) {
            self.channel = Some(value.to_owned());
        } else if let Some(axis) = AMPLITUDES.iter().position(|name| *name == key) {
            self.take_amplitude(axis, value)?;
        } else if key == UNIT_OF_ORDINATE {
            self.take_unit(&[Z], value)?;
        } else if let Some(axes) = axes_of_unit(key) {
            self.take_unit(&axes, value)?;
        } else if let Some(axis) = [WIDTH, HEIGHT].iter().position(|keys| is_one_of(key, keys)) {
            self.sizes[axis] = Some(size(key, value)?);
        } else if SPACING.contains(&key) {
            match Length::parse(value) {
                Some(spacing) => self.spacing = [Some(spacing); 2],
                None => self.take_wyko(key, value)?,
            }
        } else if let Some(axis) = SPACING_OF_AXIS.iter().position(|keys| keys.contains(&key)) {
            self.spacing[axis] = Some(Length::with_or_without_unit(value)?);
        } else if let Some(axis) = COUNTS.iter().position(|keys| is_one_of(key, keys)) {
            self.counts[axis] = Some(value.parse().ok()?);
        } else if self.take_factor(key, value).is_none() {
            self.take_wyko(key, value)?;
        }
        Some(())
    }

    /// Takes an amplitude in a header of WSxM: along x or y it is the size of the map, and along z
    /// the range of the heights, of which only the unit is used.
    fn take_amplitude(&mut self, axis: usize, value: &str) -> Option<()> {
        if axis != Z {
            self.sizes[axis] = Some(Length::parse(value)?);
            return Some(());
        }
        let unit = value.trim_start_matches(|c: char| !c.is_alphabetic() || c == 'e' || c == 'E');
        self.take_unit(&[Z], unit)
    }

    /// Reads a line of a header in the format Zygo XYZ. `line_number` is the number of the line in
    /// the file, counted from 1. In line 8, the seventh number is the distance in m between columns
    /// and between rows; it is 0 if the distance is unknown.
    pub fn take_zygo(&mut self, line_number: usize, line: &str) {
        self.has_counted_positions = true;
        if line_number != LINE_OF_DISTANCE {
            return;
        }
        let distance = line.split_ascii_whitespace().nth(6).and_then(number);
        if let Some(value) = distance.filter(|distance| *distance > 0.0) {
            let unit = Some(Unit::METRE);
            self.spacing = [Some(Length { value, unit }); 2];
        }
    }

    /// Takes the unit of the given axes. If there are no axes, it is the unit of all lengths.
    fn take_unit(&mut self, axes: &[usize], value: &str) -> Option<()> {
        match value.trim_matches(BRACKETS).parse() {
            Ok(unit) if axes.is_empty() => self.unit = Some(unit),
            Ok(unit) => {
                for axis in axes {
                    self.units[*axis] = Some(unit);
                }
            }
            Err(_) if *axes == [Z] => self.other_unit = Some(value.to_owned()),
            Err(_) => return None,
        }
        Some(())
    }

    /// Takes a factor of the heights, or the entry that says whether such a factor is needed.
    fn take_factor(&mut self, key: &str, value: &str) -> Option<()> {
        let Some(factor) = number(value) else {
            if key != "datascaleneeded" {
                return None;
            }
            self.is_data_scale_needed |= value.eq_ignore_ascii_case("yes");
            return Some(());
        };
        if let Some(unit) = key.strip_prefix("height conversion factor") {
            let unit = unit.trim_matches([' ', '(', ')', '-', '>']);
            self.units[Z] = unit.parse().ok();
            self.factor = Some(factor);
        } else if key == "bit2nm" {
            self.nanometres = Some(factor);
        } else if key == "scale data" {
            self.data_scale = Some(factor);
        } else {
            return None;
        }
        Some(())
    }

    /// Takes an entry of a header of Wyko, which is a name, two numbers and a value.
    fn take_wyko(&mut self, key: &str, value: &str) -> Option<()> {
        if key.starts_with(WYKO) {
            self.is_along_y = true;
            self.is_in_wavelengths = !value.starts_with('1');
            self.units[Z] = NANOMETRE.parse().ok();
            return Some(());
        }
        // Only the first line of a file of Wyko sets this flag, so other files are left here.
        if !self.is_along_y {
            return None;
        }
        let number = number(value.rsplit(' ').next()?)?;
        let stated = self.spacing[0].map_or(1.0, |spacing| spacing.value);
        let factor = self.factor.unwrap_or(1.0);
        match key {
            "x size" => self.counts[1] = Some(number as usize),
            "y size" => self.counts[0] = Some(number as usize),
            // The header may state the aspect ratio before or after the size of a pixel.
            "pixel_size" => {
                let along = Length::millimetres(number * stated);
                self.spacing = [Some(along), Some(Length::millimetres(number))];
            }
            "aspect" => self.spacing[0] = Some(Length::millimetres(number * stated)),
            "wavelength" if self.is_in_wavelengths => self.factor = Some(factor * number),
            "mult" if self.is_in_wavelengths => self.factor = Some(factor / number),
            _ => return None,
        }
        Some(())
    }

    /// Returns the distance between points in m that the header states for a profile without
    /// positions; `None` if it states no distance or no unit for it.
    pub fn distance(&self) -> Option<f64> {
        let [along, _] = self.spacing;
        self.metres(along?, X, None)
    }

    /// Returns the distances between points in m, along and between the rows of a map; `None` if
    /// the header does not determine both. `columns` and `rows` are the numbers of columns and rows
    /// of the map.
    pub fn distances(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        self.distances_by_size(columns, rows).or_else(|| {
            let [along, between] = self.spacing;
            Some([
                self.metres(along?, X, None)?,
                self.metres(between?, Y, None)?,
            ])
        })
    }

    fn distances_by_size(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        let [width, height] = self.sizes;
        let nanometre = NANOMETRE.parse().ok();
        let width = self.metres(width?, X, nanometre)?;
        let height = self.metres(height?, Y, nanometre)?;
        Some([width / columns as f64, height / rows as f64])
    }

    /// Converts a length along an axis to m. `usual` is the unit of the length if the header states
    /// no unit for it.
    fn metres(&self, length: Length, axis: usize, usual: Option<Unit>) -> Option<f64> {
        let unit = length.unit.or(self.unit(axis, None)).or(usual)?;
        Some(unit.to_metres(length.value))
    }

    /// Returns the factor by which the numbers in the file are multiplied to give the heights in
    /// their unit.
    pub fn scale(&self) -> f64 {
        let mut scale = 1.0;
        if let Some(factor) = self.factor {
            scale *= factor;
        }
        if let Some(nanometres) = self.nanometres
            && self.units[Z].is_none()
        {
            scale *= nanometres;
        }
        if let Some(data_scale) = self.data_scale
            && self.is_data_scale_needed
        {
            scale *= data_scale;
        }
        scale
    }

    /// Returns the unit of x, y or the heights, chosen by `axis` ([`X`], [`Y`] or [`Z`]). It is the
    /// unit in the name of the column. If this name has no unit, it is the unit that a key of the
    /// header states. Returns `None` if neither states a unit.
    pub fn unit(&self, axis: usize, column: Option<&TextColumn>) -> Option<Unit> {
        if let Some(unit) = column.and_then(unit_of_column) {
            return Some(unit);
        }
        if let Some(unit) = self.units[axis] {
            return Some(unit);
        }
        if axis == Z && self.nanometres.is_some() {
            return NANOMETRE.parse().ok();
        }
        self.unit
    }
}

fn unit_of_column(column: &TextColumn) -> Option<Unit> {
    column.unit.as_deref()?.parse().ok()
}

/// Reads the size of a map. Sizes in files of the program SPIP, such as `x-length`, are in nm,
/// unless the header states a unit for this axis.
fn size(key: &str, value: &str) -> Option<Length> {
    if let Some(size) = Length::parse(value) {
        return Some(size);
    }
    if key.ends_with("length") {
        return number(value).map(Length::bare);
    }
    None
}

/// A key of the header with its value.
struct Entry {
    /// Key in lower case.
    key: String,
    value: String,
}

impl Entry {
    fn parse(line: &str) -> Option<Entry> {
        if let Some((key, value)) = line.split_once([':', '=', '：']) {
            return Some(Entry {
                key: bare(key).to_lowercase(),
                value: bare(value).to_owned(),
            });
        }
        let mut cells = Separator::of(line).split(line);
        let key = cells.next()?.to_lowercase();
        let value = cells.collect::<Vec<_>>().join(" ");
        let value = bare(&value);
        if value.is_empty() {
            return None;
        }
        Some(Entry {
            key,
            value: value.to_owned(),
        })
    }
}

/// Returns a text without the quotation marks, separators and white space at its two ends.
fn bare(text: &str) -> &str {
    text.trim_matches(['"', ',', ';', ' ', '\t'])
}

/// Returns the axes whose unit a key states. The list is empty if the unit is that of all lengths.
/// Returns `None` if the key does not state a unit.
fn axes_of_unit(key: &str) -> Option<Vec<usize>> {
    let mut words: Vec<&str> = key.split(|c: char| !c.is_alphanumeric()).collect();
    words.retain(|word| !word.is_empty());
    if !words.iter().any(|word| is_one_of(word, UNIT)) {
        return None;
    }
    let mut axes = Vec::new();
    for word in words {
        if is_one_of(word, UNIT) || is_one_of(word, OF_ALL) {
            continue;
        }
        match word {
            "x" => axes.push(X),
            "y" => axes.push(Y),
            word if is_one_of(word, OF_POSITIONS) => axes.extend([X, Y]),
            word if is_one_of(word, OF_HEIGHTS) => axes.push(Z),
            _ => return None,
        }
    }
    // Japanese writes "unit of values" as one word, so that the word for `unit` is not found
    // separately.
    if key == "値の単位" {
        return Some(vec![Z]);
    }
    Some(axes)
}

/// Reads a number with a decimal point or a decimal comma; `None` if the text is not a finite
/// number.
fn number(text: &str) -> Option<f64> {
    match Decimal::default().read(text, Separator::SPACE) {
        TextCell::Number(value) if value.is_finite() => Some(value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::text_table::Role;

    fn header(lines: &[&str]) -> TextHeader {
        let mut header = TextHeader::default();
        lines.iter().for_each(|line| header.take(line));
        header
    }

    /// Returns the units of positions and heights of a table that has the columns x and height.
    fn units(lines: &[&str]) -> [Option<&'static str>; 2] {
        let header = header(lines);
        let columns = header.lines.columns(2, 2, Separator::SPACE, Unit::is_name);
        [(0, 0), (2, 1)]
            .map(|(axis, column)| header.unit(axis, Some(&columns[column])).map(Unit::name))
    }

    #[test]
    fn units_belong_to_the_column_or_axis_that_names_them() {
        let both = [Some("µm"), Some("nm")];
        for lines in [
            &["x [µm]\tz [nm]"][..],
            &["X (um);Z (nm)"],
            &["x/µm z/nm"],
            &["# x [um], z [nm]"],
            &["scan position [µm] height [nm]"],
            &["x_um,z_nm"],
            &["Lateral um,Raw nanometer,"],
            &["Position,Height", "µm,nm"],
            &["\"x [µm]\";\"z [nm]\""],
            &["columns: x [µm], z [nm]"],
            &["x unit: µm", "z unit = nm"],
            &["Unit Data = nm", "Unit X = um"],
            &["Unit X = um", "Unit Data = nm"],
            &["Unit: nm", "X unit: µm"],
            &["\"XY unit\",\"um\"", "\"Z unit\",\"nm\""],
            &["Sample 7 (old)", "x [µm] z [nm]"],
            &["x [µm] z [nm]", "--- ---", "Points = 3"],
        ] {
            assert_eq!(units(lines), both, "{lines:?}");
        }
        assert_eq!(units(&["# units: mm"]), [Some("mm"); 2]);
        for unknown in [
            &["x,z"][..],
            &["x [px], z [V]"],
            &["Length 5 mm"],
            &["Length,5 mm"],
            &["Cut-off (mm),0.8,Stylus tip (um),2", "X,Z"],
            &["Cut-off (mm),Stylus tip (um)", "X,Z"],
            &["Force unit: mm"],
            &["Cut-off unit = mm", "x z"],
            &[""],
        ] {
            assert_eq!(units(unknown), [None, None], "{unknown:?}");
        }
    }

    #[test]
    fn names_say_what_columns_hold() {
        use Role::{Height, Number, Unknown, Valid, X, Y};
        for (line, roles) in [
            ("x y z", vec![X, Y, Height]),
            (
                "Index;Position X;Position Y;Height [nm]",
                vec![Number, X, Y, Height],
            ),
            (",z,x", vec![Number, Height, X]),
            ("no. of point;a", vec![Number, Unknown]),
            ("X;Y;valid", vec![X, Y, Valid]),
            ("Höhe;Weg", vec![Height, X]),
            ("z_sensor,signal", vec![Height, Unknown]),
        ] {
            let count = roles.len();
            let mut header = TextHeader::default();
            header.lines.take(line);
            let found = header
                .lines
                .columns(count, count, Separator::of(line), Unit::is_name);
            assert_eq!(
                found.iter().map(|column| column.role).collect::<Vec<_>>(),
                roles,
                "{line}"
            );
        }
    }

    #[test]
    fn sizes_distances_and_channels_are_entries() {
        let sizes = header(&[
            "# Width: 2,5 µm",
            "# Height: 1.0mm",
            "# Width of nothing: 5",
        ])
        .distances(1, 1);
        assert_eq!(sizes, Some([2.5e-6, 1e-3]));
        for [width, height, channel, unit] in [
            ["Breite: 4,0 µm", "Höhe: 3 µm", "Kanal: A", "Einheiten: nm"],
            [
                "Šířka: 4 µm",
                "Výška: 3 (µm)",
                "Kanál: A",
                "Jednotky hodnot: nm",
            ],
            ["Largeur = 4 µm", "Hauteur: 3 µm", "Canal : A", "Unités: nm"],
            ["幅：4 µm", "高さ：3 µm", "チャネル：A", "値の単位：nm"],
        ] {
            let found = header(&[width, height, channel, unit]);
            assert_eq!(found.distances(1, 1), Some([4e-6, 3e-6]), "{width}");
            assert_eq!(
                (
                    found.channel.as_deref(),
                    found.unit(2, None).map(Unit::name)
                ),
                (Some("A"), Some("nm"))
            );
        }
        let keyence = header(&[
            "\"XY calibration\",\"500\",\"nm/pixel\"",
            "\"Output image data\",\"Height\"",
            "\"Horizontal\",\"40\"",
            "\"Unit\",\"um\"",
            "\"Height\"",
        ]);
        assert_eq!(
            (keyence.distances(40, 2), keyence.counts),
            (Some([5e-7; 2]), [Some(40), None])
        );
        assert_eq!(keyence.unit(2, None).map(Unit::name), Some("µm"));
        assert_eq!(
            header(&["Value units: deg"]).other_unit.as_deref(),
            Some("deg")
        );
    }
}
