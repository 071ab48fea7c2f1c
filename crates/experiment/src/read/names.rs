//! Names of columns, directions, segments and units that files of curves use.

use asperity_data::parse_quantity;

/// For displacement and force: name in words, SI unit, example of a unit, and known names of
/// columns as letters. Preferred names come first. The displacement of the instrument is preferred
/// to the displacement of the body, which lacks the deflection of the instrument. A force is
/// preferred to a deflection.
pub(crate) const QUANTITIES: [(&str, &str, &str, &str); 2] = [
    (
        "displacement",
        "m",
        "nm",
        "displacement heightmeasured measuredheight smoothedmeasuredheight straingaugeheight smoothedstraingaugeheight \
         capacitivesensorheight zsense zsensor zsnsr piezo piezoposition piezodisplacement piezoz zpiezo calcramp ramp \
         stageposition stagedisplacement motorposition position height distance heightpiezo zposition zheight indentation \
         tipposition verticaltipposition separation tipsampleseparation tipsampledistance depth d z x",
    ),
    (
        "force",
        "N",
        "nN",
        "force normalforce load appliedload vdeflection verticaldeflection deflection defl dfl cantileverdeflection \
         cantilever memsdisplacement memsdispl tb fn f",
    ),
];
/// Names of columns with the displacement of the body, without the deflection of the instrument.
pub(crate) const OF_BODY: &str = "indentation tipposition verticaltipposition separation tipsampleseparation tipsampledistance depth";
/// Names of a column of segments.
pub(crate) const SEGMENT: &str = "segment segmentname segmenttype phase direction";
/// Words for approach and for retraction in the names of columns side by side, and words for a
/// pause in the names of segments.
const DIRECTIONS: [&str; 2] = [
    "approach approaching extend extension ext ex trace loading advance forward",
    "retraction retract retracting ret rt retrace withdraw unloading backward",
];
const PAUSES: &str = "pause hold dwell delay wait";

pub(crate) fn is_one_of(word: &str, words: &str) -> bool {
    words.split(' ').any(|one| one == word)
}

/// The letters of a name in lower case, so that `Z-Sense` and `z_sense` are the same.
pub(crate) fn letters(name: &str) -> String {
    name.chars()
        .filter(|c| c.is_alphanumeric())
        .flat_map(char::to_lowercase)
        .collect()
}

/// Direction that a word states: 0 approach, 1 retraction.
pub(crate) fn direction(word: &str) -> Option<usize> {
    let word = letters(word);
    DIRECTIONS.iter().position(|words| is_one_of(&word, words))
}

/// Returns true for the name of a segment in which the instrument waits.
pub(crate) fn is_pause(text: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric())
        .any(|word| is_one_of(&letters(word), PAUSES))
}

/// Returns true for a line that names a segment.
pub(crate) fn names_segment(text: &str) -> bool {
    is_pause(text)
        || text
            .split(|c: char| !c.is_alphanumeric())
            .any(|word| direction(word).is_some())
}

/// Returns true for a unit of length, force or voltage.
pub(crate) fn is_unit(text: &str) -> bool {
    QUANTITIES.iter().any(|row| unit(text, row.1).is_some())
}

/// A unit, such as nm, as a number of SI units.
pub(crate) fn unit(text: &str, si: &str) -> Option<f64> {
    parse_quantity(&format!("1 {text}"), si)
        .ok()
        .filter(|_| text.ends_with(si))
}
