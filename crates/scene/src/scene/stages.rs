//! Loading stages: the table of their kinds, and loadings as text that can be read back.

use super::range::choice_name;
use super::text::real_in_ron;
use asperity_contact::Move;
use asperity_data::{QuantityError, parse_quantity, shown};
use std::mem::discriminant;

/// Largest number of stages of a loading.
pub(super) const MOST_STAGES: usize = 100_000;

/// A kind of loading stage: what ends the stage, such as a force or first touch.
#[derive(Debug)]
pub struct StageKind {
    example: &'static str,
    /// Name in words of what ends the stage.
    word: &'static str,
    /// SI unit of the number that ends the stage; empty for a kind without a number.
    pub unit: &'static str,
    /// Function that makes the stage from its number. A kind without a number ignores the argument.
    pub stage: fn(f64) -> Move,
}

impl StageKind {
    /// All kinds of loading stages, in the order in which a key of the explorer goes through them.
    pub const ALL: [StageKind; 6] = [
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
    ];

    /// Returns the index of the kind of a stage in [`StageKind::ALL`], and the number that ends the
    /// stage, if it has one.
    pub fn of(stage: &Move) -> (usize, Option<f64>) {
        let is_same = |kind: &StageKind| discriminant(&(kind.stage)(0.0)) == discriminant(stage);
        let number = match *stage {
            Move::ToForce(number) | Move::ToIndentation(number) | Move::ToDisplacement(number) => {
                Some(number)
            }
            Move::ToTouch | Move::ToZeroForce | Move::ToSeparation => None,
        };
        (
            StageKind::ALL.iter().position(is_same).unwrap_or_default(),
            number,
        )
    }
}

/// Examples of all kinds in RON.
pub(super) const STAGES: [&str; StageKind::ALL.len()] = {
    let (mut examples, mut place) = ([""; StageKind::ALL.len()], 0);
    while place < examples.len() {
        examples[place] = StageKind::ALL[place].example;
        place += 1;
    }
    examples
};

/// Returns the largest target force of the loading stages in N; 0 if no stage has a positive target
/// force.
pub fn pressing_force(loading: &[Move]) -> f64 {
    let force = |stage: &Move| {
        if let Move::ToForce(force) = *stage {
            force
        } else {
            0.0
        }
    };
    loading.iter().map(force).fold(0.0, f64::max)
}

/// Returns a loading stage in RON, such as `ToForce(1.0e-5)`.
pub fn stage_in_ron(stage: &Move) -> String {
    let (kind, number) = StageKind::of(stage);
    let name = choice_name(STAGES[kind]);
    number.map_or_else(
        || name.to_owned(),
        |number| format!("{name}({})", real_in_ron(number)),
    )
}

/// Returns a list of loading stages in RON.
pub(super) fn stages_in_ron(stages: &[Move]) -> String {
    let stages: Vec<String> = stages.iter().map(stage_in_ron).collect();
    format!("[{}]", stages.join(", "))
}

/// Returns a loading stage as text, with its number in this format: `10 µN`, `touch`.
fn stage_text(stage: &Move, format: fn(f64, &str) -> String) -> String {
    let (place, number) = StageKind::of(stage);
    let StageKind { word, unit, .. } = StageKind::ALL[place];
    let is_first = StageKind::ALL.iter().position(|kind| kind.unit == unit) == Some(place);
    match number.map(|number| format(number, unit)) {
        None => word.to_owned(),
        Some(number) if is_first => number,
        Some(number) => format!("{word} {number}"),
    }
}

/// Formats a loading as text for readers, such as `10 µN, 3 loops 0 N to 10 µN, separation`. If
/// `format` is [`exact_quantity`](asperity_data::exact_quantity), [`read_loading`] turns the text
/// into the same loading again.
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
    let (mut items, mut rest) = (Vec::new(), loading);
    while let Some(&first) = rest.first() {
        let pairs = rest[1..].chunks_exact(2);
        let loops = pairs
            .take_while(|pair| pair[0] == rest[1] && pair[1] == first)
            .count();
        let (item, stages) = match loops {
            2.. => (
                format!(
                    "{loops} loops {} to {}",
                    stage_text(&rest[1], format),
                    stage_text(&first, format)
                ),
                loops,
            ),
            _ => (stage_text(&first, format), 0),
        };
        items.push(item);
        rest = &rest[1 + 2 * stages..];
    }
    items.join(", ")
}

/// Reads a loading as [`loading_text`] writes it. The text may be in square brackets, and a stage
/// may also be in RON.
///
/// # Errors
/// Returns an error if a part of the text is no stage, or if there are more than 100 000 stages.
pub fn read_loading(text: &str) -> Result<Vec<Move>, QuantityError> {
    let list = text
        .trim()
        .strip_prefix('[')
        .and_then(|list| list.strip_suffix(']'))
        .unwrap_or(text);
    let mut loading = Vec::new();
    for item in list.split(',').map(str::trim) {
        let loops = item
            .split_once(" loops ")
            .and_then(|(count, ends)| Some((count, ends.split_once(" to ")?)));
        if let Some((count, (low, high))) = loops {
            let count = count
                .parse()
                .ok()
                .filter(|count| (1..=MOST_STAGES / 2).contains(count));
            let count = count.ok_or_else(|| refused(item))?;
            let [low, high] = [read_stage(low, None)?, read_stage(high, None)?];
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

/// Reads a loading stage as [`loading_text`] writes it. A number without a unit becomes a stage of
/// the kind with the index `usual` in [`StageKind::ALL`], or a force in N if `usual` is `None`.
///
/// # Errors
/// Returns an error if the text is no stage.
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
    for StageKind {
        example,
        word,
        unit,
        stage,
    } in &StageKind::ALL
    {
        let rest = [choice_name(example), word]
            .into_iter()
            .find_map(|name| plain.strip_prefix(name));
        match rest {
            Some("") if unit.is_empty() => return Ok(stage(0.0)),
            Some(number) if !unit.is_empty() => return parse_quantity(number, unit).map(stage),
            _ => {}
        }
    }
    let of_unit = StageKind::ALL
        .iter()
        .filter(|kind| plain.ends_with(kind.unit));
    let kinds = usual
        .map(|kind| &StageKind::ALL[kind])
        .into_iter()
        .chain(of_unit)
        .chain(&StageKind::ALL[..1]);
    let mut kinds = kinds.filter(|kind| !kind.unit.is_empty());
    let found = kinds.find_map(|kind| parse_quantity(plain, kind.unit).ok().map(kind.stage));
    found.ok_or_else(|| refused(text))
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

    /// A stage, or a minor loop that is repeated, of numbers some of which occur again and again.
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
