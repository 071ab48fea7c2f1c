//! Names that files of curves use for columns, directions, segments and units.

use asperity_data::parse_quantity;
use asperity_data::text_table::is_one_of;

/// Quantity that a column of a file may contain, with the names of such columns.
pub(crate) struct Quantity {
    pub term: &'static str,
    pub si_unit: &'static str,
    pub unit_example: &'static str,
    /// Known names of columns of this quantity, separated by blanks. The preferred names come
    /// first. Names have only letters and digits in lower case, as [`letters`] returns them.
    pub names: &'static str,
}

/// Index of the displacement in [`QUANTITIES`].
pub(crate) const DISPLACEMENT: usize = 0;
/// Index of the force in [`QUANTITIES`].
pub(crate) const FORCE: usize = 1;
/// Displacement and force, with the names of their columns; preferred names come first. The
/// displacement of the instrument is preferred to the displacement of the body, which lacks the
/// deflection of the instrument. A force is preferred to a deflection.
pub(crate) const QUANTITIES: [Quantity; 2] = [
    Quantity {
        term: "displacement",
        si_unit: "m",
        unit_example: "nm",
        names: "displacement heightmeasured measuredheight smoothedmeasuredheight straingaugeheight smoothedstraingaugeheight \
         capacitivesensorheight zsense zsensor zsnsr piezo piezoposition piezodisplacement piezoz zpiezo calcramp ramp \
         stageposition stagedisplacement motorposition position height distance heightpiezo zposition zheight indentation \
         tipposition verticaltipposition separation tipsampleseparation tipsampledistance depth z d x",
    },
    Quantity {
        term: "force",
        si_unit: "N",
        unit_example: "nN",
        names: "force normalforce load appliedload vdeflection verticaldeflection deflection defl dfl cantileverdeflection \
         cantilever memsdisplacement memsdispl tb fn f forceavg avgforce averageforce meanforce forcemean favg fmean",
    },
];
/// Time of each point, with the names of its columns.
pub(crate) const TIME: Quantity = Quantity {
    term: "time",
    si_unit: "s",
    unit_example: "s",
    names: "seriestime time t elapsedtime timestamp times seconds",
};
/// Names of columns with the displacement of the body, without the deflection of the instrument.
pub(crate) const OF_BODY: &str = "indentation tipposition verticaltipposition separation tipsampleseparation tipsampledistance depth";
/// Names of a column with the segment of each point.
pub(crate) const SEGMENT: &str = "segment segmentname segmenttype phase direction";
/// Index of the approach in [`DIRECTIONS`].
pub(crate) const APPROACH: usize = 0;
/// Index of the retraction in [`DIRECTIONS`].
pub(crate) const RETRACTION: usize = 1;
/// Words for approach and for retraction in the names of columns side by side.
const DIRECTIONS: [&str; 2] = [
    "approach approaching extend extension ext ex trace loading advance forward",
    "retraction retract retracting ret rt retrace withdraw unloading backward",
];
/// Words for a pause in the names of segments.
const PAUSES: &str = "pause hold dwell delay wait";

/// Returns the letters and digits of a name in lower case, so that `Z-Sense` and `z_sense` become
/// equal.
pub(crate) fn letters(name: &str) -> String {
    name.chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// Returns the direction that a word states, [`APPROACH`] or [`RETRACTION`]; `None` for another
/// word.
pub(crate) fn direction(word: &str) -> Option<usize> {
    let word = letters(word);
    DIRECTIONS.iter().position(|words| is_one_of(&word, words))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric())
}

/// Returns true for the name of a segment in which the instrument waits.
pub(crate) fn is_pause(text: &str) -> bool {
    words(text).any(|word| is_one_of(&letters(word), PAUSES))
}

/// Returns true if a line is the name of a segment: a pause, an approach or a retraction.
pub(crate) fn names_segment(text: &str) -> bool {
    is_pause(text) || words(text).any(|word| direction(word).is_some())
}

/// Returns true if a word is a unit of length or of force.
pub(crate) fn is_unit(text: &str) -> bool {
    QUANTITIES
        .iter()
        .any(|quantity| unit(text, quantity.si_unit).is_some())
}

/// Returns true if a word in the name of a column is a unit of length, force or voltage. A single
/// letter counts as a symbol of a quantity and not as a unit, except V.
pub(crate) fn names_unit(word: &str) -> bool {
    if word.chars().count() > 1 {
        return is_unit(word) || unit(word, "V").is_some();
    }
    word == "V"
}

/// Returns the SI value of one unit, such as 1e-9 for nm. `si_unit` is the SI unit of the expected
/// quantity; `None` if the unit belongs to another quantity.
pub(crate) fn unit(text: &str, si_unit: &str) -> Option<f64> {
    let value = parse_quantity(&format!("1 {text}"), si_unit).ok()?;
    text.ends_with(si_unit).then_some(value)
}
