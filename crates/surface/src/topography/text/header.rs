//! Header before the numbers of a text: units, sizes, and the lines that may name columns.

use super::super::Unit;
use asperity_data::text_table::{
    COMMENT, Decimal, HeadLines, Separator, TextCell, TextColumn, is_one_of,
};

/// Largest length in bytes of a header line that is examined.
const LONGEST: usize = 4096;

/// Keys of sizes, channels and units in English and in the other languages of Gwyddion.
const WIDTH: &str = "width x-length šířka breite anchura largeur larghezza 幅 폭 largura ширина";
const HEIGHT: &str = "height y-length výška höhe altura hauteur altezza 高さ 높이 высота";
const CHANNEL: &str = "channel kanál kanal canal canale チャネル 채널 канал";
const UNIT: &str = "unit units einheit einheiten jednotka jednotky unité unités unità unidad unidades единицы 単位 단위 値の単位";

/// Words beside `unit` in a key, by what the unit is for: heights, both positions, or all lengths.
const OF_HEIGHTS: &str = "z value values height heights data hodnot valore valor 값";
const OF_POSITIONS: &str = "xy lateral position positions distance";
const OF_ALL: &str = "length lengths de измерения";

/// Keys of the distance between points of a map, along both axes and along each.
const SPACING: [&str; 4] = [
    "xy calibration",
    "pixel size",
    "sampling distance",
    "pixel_size",
];
const SPACING_OF_AXIS: [&str; 2] = ["scale x", "scale y"];

/// Keys of the number of columns and of rows.
const COUNTS: [&str; 2] = ["horizontal x-pixels nx", "vertical y-pixels ny"];

/// First words of the header of Wyko. Its rows run along y, and its heights are in nm or, by its
/// second number, in wavelengths.
const WYKO: &str = "wyko ascii data file format";

/// Unit of lengths in headers of SPIP and Wyko.
const NANOMETRE: &str = "nm";
const MILLIMETRE: &str = "mm";

/// A length, with its unit if it has one of its own.
type Length = (f64, Option<Unit>);

/// Header of a text: the lines above its numbers, with the units, sizes and names that they state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextHeader {
    /// Name of the channel, if the header states it.
    pub channel: Option<String>,
    /// Units of x, y and heights, from keys that name them.
    units: [Option<Unit>; 3],
    /// Unit of all lengths, from a key.
    unit: Option<Unit>,
    /// Unit of the heights if it is not a unit of length.
    pub other_unit: Option<String>,
    /// Width and height of a map.
    sizes: [Option<Length>; 2],
    /// Distances between points of a map along and between rows.
    spacing: [Option<Length>; 2],
    /// Number of columns and number of rows, if the header states them.
    pub counts: [Option<usize>; 2],
    /// Factor of the heights.
    factor: Option<f64>,
    /// Factor of the heights in nm, unless the file states a unit of heights.
    nanometres: Option<f64>,
    /// Factor of the heights that counts if another entry says so.
    data_scale: (Option<f64>, bool),
    /// True if the rows of numbers run along y.
    pub is_along_y: bool,
    /// True if heights are in wavelengths.
    is_in_wavelengths: bool,
    /// Last lines of the header that have no key and may name columns.
    pub lines: HeadLines,
}

impl TextHeader {
    /// Creates a header that states this unit for all lengths.
    pub fn in_unit(unit: Option<Unit>) -> TextHeader {
        TextHeader {
            unit,
            ..TextHeader::default()
        }
    }

    /// Reads a line. It may be `key: value`, `key = value` or `key,value` with a unit, a size or a
    /// channel; any other line may name columns.
    pub fn take(&mut self, line: &str) {
        let line = line.trim_start_matches(COMMENT).trim();
        if line.len() <= LONGEST && self.take_entry(line) {
            return;
        }
        self.lines.take(line);
    }

    fn take_entry(&mut self, line: &str) -> bool {
        let Some((key, value)) = entry(line) else {
            return false;
        };
        if is_one_of(&key, CHANNEL) {
            self.channel = Some(value);
        } else if let Some(axes) = axes_of_unit(&key) {
            match (
                value.trim_matches(['[', ']', '(', ')']).parse().ok(),
                &axes[..],
            ) {
                (Some(unit), []) => self.unit = Some(unit),
                (Some(unit), axes) => axes.iter().for_each(|axis| self.units[*axis] = Some(unit)),
                (None, [2]) => self.other_unit = Some(value),
                (None, _) => return false,
            }
        } else if let Some(axis) = [WIDTH, HEIGHT]
            .iter()
            .position(|names| is_one_of(&key, names))
        {
            // Lengths of SPIP are in nm, unless it states a unit for the axis.
            let bare = number(&value)
                .filter(|_| key.ends_with("length"))
                .map(|size| (size, None));
            let Some(size) = length(&value).or(bare) else {
                return false;
            };
            self.sizes[axis] = Some(size);
        } else if SPACING.contains(&&*key) {
            let Some(spacing) = length(&value) else {
                return self.take_wyko(&key, &value);
            };
            self.spacing = [Some(spacing); 2];
        } else if let Some(axis) = SPACING_OF_AXIS.iter().position(|name| *name == key) {
            let Some(spacing) = number(&value) else {
                return false;
            };
            self.spacing[axis] = Some((spacing, None));
        } else if let Some(axis) = COUNTS.iter().position(|names| is_one_of(&key, names)) {
            let Ok(count) = value.parse() else {
                return false;
            };
            self.counts[axis] = Some(count);
        } else {
            return self.take_factor(&key, &value) || self.take_wyko(&key, &value);
        }
        true
    }

    /// Reads a factor of the heights.
    fn take_factor(&mut self, key: &str, value: &str) -> bool {
        let Some(factor) = number(value) else {
            let is_needed = key == "datascaleneeded";
            self.data_scale.1 |= is_needed && value.eq_ignore_ascii_case("yes");
            return is_needed;
        };
        if let Some(unit) = key.strip_prefix("height conversion factor") {
            self.units[2] = unit.trim_matches([' ', '(', ')', '-', '>']).parse().ok();
            self.factor = Some(factor);
        } else if key == "bit2nm" {
            self.nanometres = Some(factor);
        } else if key == "scale data" {
            self.data_scale.0 = Some(factor);
        } else {
            return false;
        }
        true
    }

    /// Reads an entry of the header of Wyko: a name, two numbers and a value.
    fn take_wyko(&mut self, key: &str, value: &str) -> bool {
        if key.starts_with(WYKO) {
            self.is_along_y = true;
            self.is_in_wavelengths = !value.starts_with('1');
            self.units[2] = NANOMETRE.parse().ok();
            return true;
        }
        let Some(number) = value
            .rsplit(' ')
            .next()
            .and_then(number)
            .filter(|_| self.is_along_y)
        else {
            return false;
        };
        let unit: Option<Unit> = MILLIMETRE.parse().ok();
        let factor = self.factor.unwrap_or(1.0);
        match key {
            "x size" => self.counts[1] = Some(number as usize),
            "y size" => self.counts[0] = Some(number as usize),
            "pixel_size" => {
                let aspect = self.spacing[0].map_or(1.0, |(aspect, _)| aspect);
                self.spacing = [Some((number * aspect, unit)), Some((number, unit))];
            }
            "aspect" => {
                let pixel = self.spacing[0].map_or(1.0, |(pixel, _)| pixel);
                self.spacing[0] = Some((number * pixel, unit));
            }
            "wavelength" if self.is_in_wavelengths => self.factor = Some(factor * number),
            "mult" if self.is_in_wavelengths => self.factor = Some(factor / number),
            _ => return false,
        }
        true
    }

    /// Returns the distances in m along and between the rows of a map with these numbers of columns
    /// and rows.
    pub fn distances(&self, columns: usize, rows: usize) -> Option<[f64; 2]> {
        let metres = |lengths: &[Option<Length>; 2], axis: usize, usual: Option<Unit>| {
            let (length, unit) = lengths[axis]?;
            Some(unit.or(self.unit(axis, None)).or(usual)?.to_metres(length))
        };
        let nanometre = NANOMETRE.parse().ok();
        let size = |axis: usize| metres(&self.sizes, axis, nanometre);
        let of_sizes = size(0)
            .zip(size(1))
            .map(|(width, height)| [width / columns as f64, height / rows as f64]);
        of_sizes.or_else(|| {
            metres(&self.spacing, 0, None)
                .zip(metres(&self.spacing, 1, None))
                .map(<[f64; 2]>::from)
        })
    }

    /// Returns the factor by which the heights are multiplied.
    pub fn scale(&self) -> f64 {
        let of_unit = self.nanometres.filter(|_| self.units[2].is_none());
        let of_data = self.data_scale.0.filter(|_| self.data_scale.1);
        [self.factor, of_unit, of_data]
            .into_iter()
            .flatten()
            .product()
    }

    /// Returns the unit of x (0), y (1) or heights (2): as the column states, else as a key states.
    pub fn unit(&self, axis: usize, column: Option<&TextColumn>) -> Option<Unit> {
        let of_column = column.and_then(|column| column.unit.as_deref()?.parse().ok());
        let of_axis = self.units[axis].or_else(|| {
            self.nanometres
                .filter(|_| axis == 2)
                .and(NANOMETRE.parse().ok())
        });
        of_column.or(of_axis).or(self.unit)
    }
}

/// Returns the key of a line in lower case, and its value.
fn entry(line: &str) -> Option<(String, String)> {
    let bare = |text: &str| text.trim_matches(['"', ',', ';', ' ', '\t']).to_owned();
    if let Some((key, value)) = line.split_once([':', '=', '：']) {
        return Some((bare(key).to_lowercase(), bare(value)));
    }
    let mut cells = Separator::of(line).split(line);
    let key = cells.next()?.to_lowercase();
    let value: Vec<&str> = cells.collect();
    Some((key, bare(&value.join(" ")))).filter(|(_, value)| !value.is_empty())
}

/// Returns the axes whose unit a key states: x (0), y (1) and heights (2). The list is empty for
/// the unit of all lengths, and `None` for another key.
fn axes_of_unit(key: &str) -> Option<Vec<usize>> {
    let words = || {
        key.split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty())
    };
    if !words().any(|word| is_one_of(word, UNIT)) {
        return None;
    }
    let mut axes = Vec::new();
    for word in words().filter(|word| !is_one_of(word, UNIT) && !is_one_of(word, OF_ALL)) {
        axes.extend_from_slice(match word {
            "x" => &[0],
            "y" => &[1],
            word if is_one_of(word, OF_POSITIONS) => &[0, 1],
            word if is_one_of(word, OF_HEIGHTS) => &[2],
            _ => return None,
        });
    }
    if key == "値の単位" {
        Some(vec![2])
    } else {
        Some(axes)
    }
}

/// Reads a number in any notation.
fn number(text: &str) -> Option<f64> {
    match Decimal::default().read(text, Separator::SPACE) {
        TextCell::Number(value) if value.is_finite() => Some(value),
        _ => None,
    }
}

/// Reads a length and its unit from a text such as `10.5 µm`, `24µm`, `24 (µm)` or `500 nm/pixel`.
fn length(text: &str) -> Option<Length> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || ".,+-eE".contains(c)))?;
    let (value, unit) = text.split_at(end);
    let unit = unit
        .split('/')
        .next()?
        .trim()
        .trim_matches(['[', ']', '(', ')']);
    Some((number(value)?, Some(unit.parse().ok()?)))
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

    /// Units of positions and heights of a table of x and height.
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
