//! Loading stages: the table of their kinds, and conversion between loadings and text.

use super::range::choice_name;
use super::text::real_in_ron;
use asperity_contact::Move;
use asperity_data::{QuantityError, parse_quantity, shown};
use std::mem::discriminant;

/// Largest number of stages of a loading.
pub(super) const MOST_STAGES: usize = 100_000;

/// A kind of loading stage. The kind states what ends the stage, such as a force or first touch.
#[derive(Debug)]
pub struct StageKind {
    example: &'static str,
    /// Word for users that names what ends the stage, such as `force`.
    word: &'static str,
    /// SI unit of the target value of a stage, such as N for a force; empty for a kind without a
    /// target value, such as first touch.
    pub unit: &'static str,
    /// Function that makes a stage from its target value. A kind without a target value ignores the
    /// argument.
    pub stage: fn(f64) -> Move,
}

impl StageKind {
    /// All kinds of loading stages. A key of the explorer selects them in this order.
    pub const ALL: [StageKind; 7] = [
        StageKind {
            example: "ToForce(1.0e-5)",
            word: "force",
            unit: "N",
            stage: Move::ToForce,
        },
        StageKind {
            example: "ToIndentation(1.0e-7)",
            word: "indentation",
            unit: "m",
            stage: Move::ToIndentation,
        },
        StageKind {
            example: "ToDisplacement(1.0e-7)",
            word: "displacement",
            unit: "m",
            stage: Move::ToDisplacement,
        },
        StageKind {
            example: "ToTouch",
            word: "touch",
            unit: "",
            stage: |_| Move::ToTouch,
        },
        StageKind {
            example: "ToZeroForce",
            word: "zero force",
            unit: "",
            stage: |_| Move::ToZeroForce,
        },
        StageKind {
            example: "ToSeparation",
            word: "separation",
            unit: "",
            stage: |_| Move::ToSeparation,
        },
        StageKind {
            example: "Hold(10.0)",
            word: "hold",
            unit: "s",
            stage: Move::Hold,
        },
    ];

    /// Returns the index in [`StageKind::ALL`] of the kind of a stage, and the target value of the
    /// stage. The target value is `None` for a kind that has none, such as first touch.
    pub fn of(stage: &Move) -> (usize, Option<f64>) {
        let kind = StageKind::ALL
            .iter()
            .position(|kind| discriminant(&(kind.stage)(0.0)) == discriminant(stage));
        let number = match *stage {
            Move::ToForce(number)
            | Move::ToIndentation(number)
            | Move::ToDisplacement(number)
            | Move::Hold(number) => Some(number),
            Move::ToTouch | Move::ToZeroForce | Move::ToSeparation => None,
        };
        (kind.unwrap_or_default(), number)
    }
}

/// Examples of all kinds of loading stages in RON.
pub(super) const STAGES: [&str; StageKind::ALL.len()] = {
    let mut examples = [""; StageKind::ALL.len()];
    let mut place = 0;
    while place < examples.len() {
        examples[place] = StageKind::ALL[place].example;
        place += 1;
    }
    examples
};

/// Returns the largest target force of the loading stages in N; 0 if no stage has a positive target
/// force.
pub fn pressing_force(loading: &[Move]) -> f64 {
    let mut largest = 0.0;
    for stage in loading {
        if let Move::ToForce(force) = *stage {
            largest = f64::max(largest, force);
        }
    }
    largest
}

/// Returns a loading stage in RON, such as `ToForce(1.0e-5)`.
pub fn stage_in_ron(stage: &Move) -> String {
    let (kind, number) = StageKind::of(stage);
    let name = choice_name(STAGES[kind]);
    match number {
        Some(number) => format!("{name}({})", real_in_ron(number)),
        None => name.to_owned(),
    }
}

/// Returns a list of loading stages in RON.
pub(super) fn stages_in_ron(stages: &[Move]) -> String {
    let stages: Vec<String> = stages.iter().map(stage_in_ron).collect();
    format!("[{}]", stages.join(", "))
}

/// Returns a loading stage as text, such as `10 µN` or `touch`. `format` writes the target value
/// with its unit.
fn stage_text(stage: &Move, format: fn(f64, &str) -> String) -> String {
    let (place, number) = StageKind::of(stage);
    let StageKind { word, unit, .. } = StageKind::ALL[place];
    let Some(number) = number else {
        return word.to_owned();
    };
    let number = format(number, unit);
    let first_of_unit = StageKind::ALL.iter().position(|kind| kind.unit == unit);
    if first_of_unit == Some(place) && !matches!(stage, Move::Hold(_)) {
        number
    } else {
        format!("{word} {number}")
    }
}

/// Formats a loading as text for users, such as `10 µN, 3 loops 0 N to 10 µN, separation`. If
/// `format` is [`exact_quantity`](asperity_data::exact_quantity), [`read_loading`] converts the
/// text back to the same loading.
///
/// ```
/// use asperity_contact::Move;
/// use asperity_data::format_quantity;
/// use asperity_scene::loading::loading_text;
///
/// let loading = [Move::ToForce(1.0e-5), Move::ToZeroForce, Move::ToSeparation];
/// assert_eq!(loading_text(&loading, format_quantity), "10 µN, zero force, separation");
/// ```
pub fn loading_text(loading: &[Move], format: fn(f64, &str) -> String) -> String {
    let mut items = Vec::new();
    let mut remaining = loading;
    while let Some(first) = remaining.first() {
        let high = stage_text(first, format);
        let loops = loops_at_start(remaining);
        if loops >= 2 {
            let low = stage_text(&remaining[1], format);
            items.push(format!("{loops} loops {low} to {high}"));
            remaining = &remaining[1 + 2 * loops..];
        } else {
            items.push(high);
            remaining = &remaining[1..];
        }
    }
    items.join(", ")
}

/// Returns the number of loops at the beginning of a loading. After the first stage, each loop
/// consists of the second stage and then the first stage again.
fn loops_at_start(loading: &[Move]) -> usize {
    loading[1..]
        .chunks_exact(2)
        .take_while(|pair| pair[0] == loading[1] && pair[1] == loading[0])
        .count()
}

/// Reads a loading in the notation of [`loading_text`]. The text may be in square brackets, and a
/// stage may also be in RON.
///
/// # Errors
/// Returns an error if a part of the text is not a stage, or if there are more than 100 000 stages.
pub fn read_loading(text: &str) -> Result<Vec<Move>, QuantityError> {
    let list = text
        .trim()
        .strip_prefix('[')
        .and_then(|list| list.strip_suffix(']'))
        .unwrap_or(text);
    let mut loading = Vec::new();
    for item in list.split(',').map(str::trim) {
        if let Some((count, ends)) = item.split_once(" loops ")
            && let Some((low, high)) = ends.split_once(" to ")
        {
            let count = count.parse().map_err(|_| refused(item))?;
            if !(1..=MOST_STAGES / 2).contains(&count) {
                return Err(refused(item));
            }
            let low = read_stage(low, None)?;
            let high = read_stage(high, None)?;
            loading.push(high);
            loading.extend([low, high].repeat(count));
        } else {
            loading.push(read_stage(item, None)?);
        }
        if loading.len() > MOST_STAGES {
            return Err(QuantityError(format!(
                "too many stages; allowed: at most {MOST_STAGES}"
            )));
        }
    }
    Ok(loading)
}

/// Reads a loading stage in the notation of [`loading_text`]. A number without a unit is the target
/// value of a stage. The kind of this stage is the item of [`StageKind::ALL`] with the index
/// `usual`. If `usual` is `None`, the number is a force in N.
///
/// # Errors
/// Returns an error if the text is not a stage.
///
/// ```
/// use asperity_contact::Move;
/// use asperity_scene::loading::read_stage;
///
/// assert_eq!(read_stage("10 µN", None), Ok(Move::ToForce(1.0e-5)));
/// assert_eq!(read_stage("separation", None), Ok(Move::ToSeparation));
/// assert!(read_stage("10 kg", None).is_err());
/// ```
pub fn read_stage(text: &str, usual: Option<usize>) -> Result<Move, QuantityError> {
    let plain = text.replace(['(', ')'], " ");
    let plain = plain.trim();
    for kind in &StageKind::ALL {
        let after_name = plain
            .strip_prefix(choice_name(kind.example))
            .or_else(|| plain.strip_prefix(kind.word));
        let Some(number) = after_name else {
            continue;
        };
        if !kind.unit.is_empty() {
            return parse_quantity(number, kind.unit).map(kind.stage);
        }
        if number.is_empty() {
            return Ok((kind.stage)(0.0));
        }
    }
    // The text does not begin with the name of a kind, so the unit of the target value decides the
    // kind. If no kind has this unit, the target is a force.
    let mut kinds: Vec<&StageKind> = Vec::new();
    kinds.extend(usual.map(|usual| &StageKind::ALL[usual]));
    kinds.extend(
        StageKind::ALL
            .iter()
            .filter(|kind| plain.ends_with(kind.unit)),
    );
    kinds.push(&StageKind::ALL[0]);
    for kind in kinds {
        if !kind.unit.is_empty()
            && let Ok(number) = parse_quantity(plain, kind.unit)
        {
            return Ok((kind.stage)(number));
        }
    }
    Err(refused(text))
}

fn refused(text: &str) -> QuantityError {
    let examples =
        "10 µN, 200 nm, displacement 200 nm, touch, zero force, separation, 3 loops 5 µN to 10 µN";
    let most = MOST_STAGES / 2;
    QuantityError(format!(
        "{:?} is not a stage, such as {examples} (at most {most} loops)",
        shown(text)
    ))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::Move::*;
    use super::*;
    use asperity_data::{exact_quantity, format_quantity};

    /// Generates parts of loadings: a single stage, or a minor loop that is repeated. Some target
    /// values occur often, so that stages may be equal.
    fn stages() -> impl Strategy<Value = Vec<Move>> {
        let number = prop_oneof![
            prop::sample::select(vec![1e-5, 5e-6, 0.0, -2e-6]),
            (-30.0..30.0_f64, -1.0..1.0_f64)
                .prop_map(|(power, digits)| digits * 10.0_f64.powf(power)),
        ];
        let stage = (0..StageKind::ALL.len(), number)
            .prop_map(|(kind, number)| (StageKind::ALL[kind].stage)(number));
        prop_oneof![
            4 => stage.clone().prop_map(|stage| vec![stage]),
            1 => (1..4_usize, stage.clone(), stage)
                .prop_map(|(count, low, high)| [vec![high], [low, high].repeat(count)].concat()),
        ]
    }

    proptest! {
        #[test]
        fn what_is_shown_reads_back_as_the_same_loading(parts in prop::collection::vec(stages(), 1..8)) {
            let loading: Vec<Move> = parts.concat();
            let text = loading_text(&loading, exact_quantity);
            prop_assert_eq!(&read_loading(&text), &Ok(loading.clone()), "{}", text);
            let ron = format!("[{}]", loading.iter().map(stage_in_ron).collect::<Vec<_>>().join(","));
            prop_assert_eq!(ron::from_str(&ron), Ok(loading.clone()), "{}", ron);
            prop_assert_eq!(read_loading(&ron), Ok(loading), "{}", ron);
        }
    }

    #[test]
    fn a_loading_is_a_list_of_stages_and_loops() {
        for (text, loading) in [
            (
                "10 µN, 0 N, -5 nm, separation",
                vec![
                    ToForce(1e-5),
                    ToForce(0.0),
                    ToIndentation(-5e-9),
                    ToSeparation,
                ],
            ),
            (
                "2 loops 0 N to 10 µN",
                vec![
                    ToForce(1e-5),
                    ToForce(0.0),
                    ToForce(1e-5),
                    ToForce(0.0),
                    ToForce(1e-5),
                ],
            ),
            ("zero force, touch", vec![ToZeroForce, ToTouch]),
        ] {
            assert_eq!(read_loading(text).as_ref(), Ok(&loading), "{text}");
            assert_eq!(loading_text(&loading, format_quantity), text);
        }
        for (text, usual, stage) in [
            ("20", 0, ToForce(20.0)),
            ("20", 1, ToIndentation(20.0)),
            ("50m", 0, ToForce(0.05)),
            ("5 nm", 0, ToIndentation(5e-9)),
            ("5 nm", 2, ToDisplacement(5e-9)),
            ("displacement -5 nm", 0, ToDisplacement(-5e-9)),
            ("force 5 µN", 1, ToForce(5e-6)),
            ("ToForce(5 µN)", 4, ToForce(5e-6)),
            ("ToTouch", 4, ToTouch),
            ("2e-6", 4, ToForce(2e-6)),
        ] {
            assert_eq!(read_stage(text, Some(usual)), Ok(stage), "{text}");
        }
    }

    #[test]
    fn text_that_is_no_loading_is_refused_with_what_is() {
        for (text, why) in [
            (
                "",
                "\"\" is not a stage, such as 10 µN, 200 nm, displacement 200 nm, touch",
            ),
            ("10 µN, separaton", "\"separaton\" is not a stage"),
            ("10 kg", "\"10 kg\" is not a stage"),
            (
                "[ToForce(10 kg)]",
                "kg is not a unit of force: use N, mN, µN, nN",
            ),
            (
                "0 loops 0 N to 1 N",
                "3 loops 5 µN to 10 µN (at most 50000 loops)",
            ),
            (
                "50000 loops touch to 1 N",
                "too many stages; allowed: at most 100000",
            ),
        ] {
            let refused = read_loading(text).unwrap_err().to_string();
            assert!(refused.contains(why), "{text}: {refused}");
        }
    }
}
