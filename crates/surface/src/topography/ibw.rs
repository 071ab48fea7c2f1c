//! Surfaces in binary waves, which are the array files of the program Igor, as microscopes of
//! Asylum Research write them. A wave with one dimension is a profile, with two a map, and with
//! three several maps (layers). The lowest row of a map comes first.

use super::channel::{self, Label, Wanted};
use super::igor::IgorWave;
use super::reading::Reading;
use super::stated_units::StatedUnits;
use super::transpose::reverse_rows;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};
use asperity_data::shown;

/// Largest allowed number of layers in a wave.
const MOST_LAYERS: usize = 256;

/// Names of the columns of a wave that is a force curve and not a surface.
const OF_CURVES: [&str; 2] = ["Defl", "ZSnsr"];

/// Reads one layer of a binary wave. Layers are numbered from 0. If `wanted` is neither a number
/// nor a name, reads the only layer of heights.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let wave = IgorWave::parse(bytes)?;
    let [x, y, layers, higher] = &wave.dimensions;
    if is_curve(&wave) {
        let columns = shown(&y.labels.join(", "));
        let found = format!("a force curve with the columns {columns}");
        let allowed = "a surface; force curves are read by asperity fit";
        return Err(refused(Place::File, found, allowed));
    }
    let count = layers.count.max(1);
    if higher.count > 1 || count > MOST_LAYERS {
        let found = format!(
            "a wave of {} times {} times {} times {} numbers",
            x.count, y.count, layers.count, higher.count
        );
        let allowed = format!("a profile, or a map of at most {MOST_LAYERS} layers");
        return Err(refused(Place::File, found, allowed));
    }
    let labels: Vec<Label> = (0..count)
        .zip(0..)
        .map(|(layer, number)| label(&wave, layer, number))
        .collect();
    let index = channel::chosen(&labels, "channel", wanted)?;

    let rows = y.count.max(1);
    let points = x.count.saturating_mul(rows);
    let mut heights = wave.numbers(index.saturating_mul(points), points)?;
    reverse_rows(&mut heights, x.count);
    let spacing = Spacing::of(&wave)?;
    // A wave states one unit for all its layers. It is the unit of the layers of heights only.
    let unit = match labels[index].has_heights {
        true => Unit::stated(&wave.unit, Place::Part("unit of the wave".to_owned()))?,
        false => None,
    };
    let units = StatedUnits {
        heights: unit,
        ..spacing.units
    };
    Ok(Reading::even(
        "IBW",
        heights,
        x.count,
        spacing.distances,
        units,
    ))
}

/// Returns true if the wave is a force curve. Instruments of Asylum Research give the columns of
/// force curves these names.
fn is_curve(wave: &IgorWave<'_>) -> bool {
    let labels = &wave.dimensions[1].labels;
    OF_CURVES
        .iter()
        .any(|name| labels.iter().any(|label| label == name))
}

/// Returns the label of a layer. A single layer and a layer without a name contain heights. Any
/// other layer contains heights if its name says so.
fn label(wave: &IgorWave<'_>, layer: usize, number: u32) -> Label {
    let layers = &wave.dimensions[2];
    let name = layers.labels.get(layer).cloned().unwrap_or_default();
    let is_only = layers.count <= 1;
    Label {
        number,
        has_heights: is_only || name.is_empty() || channel::names_heights(&name),
        name,
        ..Label::default()
    }
}

/// Distances between the points of a map, and the units of these distances.
struct Spacing {
    distances: Option<[f64; 2]>,
    units: StatedUnits,
}

impl Spacing {
    /// Returns the distances that the dimensions of the wave state. If the dimensions have no unit,
    /// they only count elements; the distances then follow from the size of the scan in m, which
    /// the note states.
    fn of(wave: &IgorWave<'_>) -> Result<Self, SurfaceError> {
        let [x, y, ..] = &wave.dimensions;
        let place = |name: &str| Place::Part(format!("unit of dimension {name}"));
        let along = Unit::stated(&x.unit, place("0"))?;
        let between = Unit::stated(&y.unit, place("1"))?.or(along);
        let is_map = y.count > 1;
        let steps = [x.step.abs(), y.step.abs()];
        let has_steps = steps[0] > 0.0 && (steps[1] > 0.0 || !is_map);
        let mut units = StatedUnits::new(along, None);
        units.between = between;
        if along.is_some() && has_steps {
            return Ok(Spacing {
                distances: Some(steps),
                units,
            });
        }
        let width = wave.number("FastScanSize").unwrap_or_default();
        let height = wave.number("SlowScanSize").unwrap_or_default();
        if along.is_none() && is_map && width > 0.0 && height > 0.0 {
            let distances = [width / x.count as f64, height / y.count as f64];
            return Ok(Spacing {
                distances: Some(distances),
                units: StatedUnits::METRES,
            });
        }
        Ok(Spacing {
            distances: None,
            units: StatedUnits::default(),
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::bytes::Order;
    use super::super::igor::tests::{Written, file, old_file};
    use super::*;

    const NOTE: &str = "ScanSize: 2e-05\rFastScanSize: 6e-06\rSlowScanSize: 2e-06\rInvOLS: 1e-07";

    const LAYERS: [&str; 3] = ["HeightTrace", "HeightRetrace", "PhaseTrace"];

    /// Returns a map of 3 × 2 points with several layers. The heights in layer n are 10 n + 1 to 10
    /// n + 6, times 1e-9.
    pub fn map<'a>(order: Order, labels: &'a [&'a str]) -> Written<'a> {
        let mut numbers = Vec::new();
        for layer in 0..labels.len() {
            for point in 1..=6 {
                let height = 1e-9 * (10 * layer + point) as f32;
                numbers.extend(match order {
                    Order::Little => height.to_le_bytes(),
                    Order::Big => height.to_be_bytes(),
                });
            }
        }
        Written {
            counts: [3, 2, labels.len() as u32, 0],
            steps: [2e-6, 1e-6, 1.0, 1.0],
            unit: "m",
            units: ["m", "m", "", ""],
            labels: [&[], &[], labels, &[]],
            note: NOTE,
            kind: 2,
            numbers,
        }
    }

    fn found(wave: &Written<'_>, wanted: Wanted<'_>) -> Result<Reading, String> {
        read(&file(wave, Order::Little), wanted).map_err(|error| error.to_string())
    }

    #[test]
    fn layers_are_channels_whose_rows_begin_at_the_bottom() {
        for order in [Order::Little, Order::Big] {
            let bytes = file(&map(order, &LAYERS), order);
            let found = read(&bytes, Wanted::Name("heightretrace")).unwrap();
            assert_eq!((found.format, found.columns), ("IBW", 3));
            assert_eq!(found.spacing, Some([2e-6, 1e-6]));
            assert_eq!(found.units, StatedUnits::METRES);
            // The second row in the file is the upper row of the map.
            let expected = [14, 15, 16, 11, 12, 13].map(|n: i16| f64::from(1e-9 * f32::from(n)));
            assert_eq!(found.heights, expected);
        }
        let error = found(&map(Order::Little, &LAYERS), Wanted::Heights).unwrap_err();
        assert!(
            error.starts_with(
                "2 channels of heights; channels: 0 \"HeightTrace\", 1 \"HeightRetrace\", 2 \"PhaseTrace\"; allowed: the number"
            ),
            "{error}"
        );
        // The unit that the wave states applies to the heights, and not to the layer with the
        // phase.
        let phase = found(&map(Order::Little, &LAYERS), Wanted::Number(2)).unwrap();
        assert_eq!(phase.units.heights, None);
        let one = found(&map(Order::Little, &["UserIn0"]), Wanted::Heights).unwrap();
        assert_eq!(one.units.heights, Some(Unit::METRE));
    }

    #[test]
    fn distances_are_stated_by_units_or_by_the_note() {
        let mut wave = map(Order::Little, &["Height"]);
        wave.units = ["um", "nm", "", ""];
        let with_units = found(&wave, Wanted::Heights).unwrap();
        let units = [with_units.units.along, with_units.units.between];
        assert_eq!(
            units.map(|unit| unit.map(Unit::name)),
            [Some("µm"), Some("nm")]
        );
        // If the dimensions have no unit, they only count elements, and the note gives the
        // distances.
        wave.units = [""; 4];
        wave.steps = [1.0; 4];
        let by_note = found(&wave, Wanted::Heights).unwrap();
        assert_eq!(
            (by_note.spacing, by_note.units.along),
            (Some([2e-6, 1e-6]), Some(Unit::METRE))
        );
        wave.note = "";
        let without = found(&wave, Wanted::Heights).unwrap();
        assert_eq!((without.spacing, without.units.along), (None, None));
        wave.units[0] = "V";
        let error = found(&wave, Wanted::Heights).unwrap_err();
        assert!(
            error.starts_with("unit of dimension 0: \"V\" is not a unit"),
            "{error}"
        );
    }

    #[test]
    fn profiles_are_read_and_curves_are_named() {
        for order in [Order::Little, Order::Big] {
            let profile = read(&old_file(&[1.0, 3.0, 2.0], order), Wanted::Heights).unwrap();
            assert_eq!(
                (&profile.heights[..], profile.spacing),
                (&[1.0, 3.0, 2.0][..], Some([2.0; 2]))
            );
            let units = [profile.units.along, profile.units.heights];
            assert_eq!(
                units.map(|unit| unit.map(Unit::name)),
                [Some("µm"), Some("nm")]
            );
        }
        let curve = Written {
            counts: [2, 3, 0, 0],
            labels: [&[], &["Raw", "Defl", "ZSnsr"], &[], &[]],
            kind: 2,
            numbers: vec![0; 24],
            ..Written::default()
        };
        let error = found(&curve, Wanted::Heights).unwrap_err();
        assert!(
            error.starts_with("a force curve with the columns Raw, Defl, ZSnsr; allowed: a s"),
            "{error}"
        );
        let mut volume = map(Order::Little, &LAYERS);
        volume.counts = [3, 1, 3, 2];
        assert!(
            found(&volume, Wanted::Heights)
                .unwrap_err()
                .starts_with("a wave of 3 times 1 times 3 times 2")
        );
    }
}
