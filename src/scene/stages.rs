//! Loading stages: the one table of their kinds, and a loading as text, which reads back as the same loading.

use super::errors::shown;
use super::quantity::{QuantityError, parse_quantity};
use super::range::choice_name;
use super::text::ron_float;
use crate::contact::Move;
use crate::text::round_to;
use std::mem::discriminant;

/// Most stages of a loading.
pub(super) const MOST_STAGES: usize = 100_000;

/// A kind of loading stage.
#[derive(Debug)]
pub struct StageKind {
    /// An example in RON.
    example: &'static str,
    /// The target in words.
    word: &'static str,
    /// SI unit of its number; empty without a number.
    pub unit: &'static str,
    /// The stage with a number.
    pub stage: fn(f64) -> Move,
}

/// All kinds, in the order in which a key changes them. Of the kinds with one unit the first is written as its number
/// alone, the others as their word and their number.
pub const STAGE_KINDS: [StageKind; 6] = [
    StageKind { example: "ToForce(1.0e-5)", word: "force", unit: "N", stage: Move::ToForce },
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
    StageKind { example: "ToTouch", word: "touch", unit: "", stage: |_| Move::ToTouch },
    StageKind { example: "ToZeroForce", word: "zero force", unit: "", stage: |_| Move::ToZeroForce },
    StageKind { example: "ToSeparation", word: "separation", unit: "", stage: |_| Move::ToSeparation },
];

/// The examples of all kinds.
pub(super) const STAGES: [&str; STAGE_KINDS.len()] = {
    let (mut examples, mut place) = ([""; STAGE_KINDS.len()], 0);
    while place < examples.len() {
        examples[place] = STAGE_KINDS[place].example;
        place += 1;
    }
    examples
};

/// Place of the kind of a stage in the table, and the number of the stage, if it has one.
pub fn kind_and_number(stage: &Move) -> (usize, Option<f64>) {
    let is_same = |kind: &StageKind| discriminant(&(kind.stage)(0.0)) == discriminant(stage);
    let number = match *stage {
        Move::ToForce(number) | Move::ToIndentation(number) | Move::ToDisplacement(number) => Some(number),
        Move::ToTouch | Move::ToZeroForce | Move::ToSeparation => None,
    };
    (STAGE_KINDS.iter().position(is_same).unwrap_or_default(), number)
}

/// Largest force of loading stages, N; 0 where no stage presses to a force.
pub fn pressing_force(loading: &[Move]) -> f64 {
    let force = |stage: &Move| if let Move::ToForce(force) = *stage { force } else { 0.0 };
    loading.iter().map(force).fold(0.0, f64::max)
}

/// A stage in RON.
pub fn stage_in_ron(stage: &Move) -> String {
    let (kind, number) = kind_and_number(stage);
    let name = choice_name(STAGES[kind]);
    number.map_or_else(|| name.to_owned(), |number| format!("{name}({})", ron_float(number)))
}

/// A stage as text, its number in a format: `10 µN`, `touch`.
fn stage_text(stage: &Move, format: fn(f64, &str) -> String) -> String {
    let (place, number) = kind_and_number(stage);
    let StageKind { word, unit, .. } = STAGE_KINDS[place];
    let is_first = STAGE_KINDS.iter().position(|kind| kind.unit == unit) == Some(place);
    match number.map(|number| format(number, unit)) {
        None => word.to_owned(),
        Some(number) if is_first => number,
        Some(number) => format!("{word} {number}"),
    }
}

/// A loading as text, with runs of stages that repeat as one item: `10 µN, 3 loops 0 N to 10 µN, separation`. With
/// [`exact_quantity`](super::exact_quantity) as format, [`read_loading`] returns the same loading.
pub fn loading_text(loading: &[Move], format: fn(f64, &str) -> String) -> String {
    runs(loading).iter().map(|run| run.text(format)).collect::<Vec<_>>().join(", ")
}

/// A loading as [`loading_text`] writes it, in brackets or not; stages may be in RON, with units or not.
///
/// # Errors
/// Text that is no stage, or too many stages.
pub fn read_loading(text: &str) -> Result<Vec<Move>, QuantityError> {
    let list = text.trim().strip_prefix('[').and_then(|list| list.strip_suffix(']')).unwrap_or(text);
    let mut loading = Vec::new();
    for item in list.split(',') {
        loading.extend(Run::read(item.trim())?.stages());
        if loading.len() > MOST_STAGES {
            return Err(QuantityError(format!("too many stages; allowed: at most {MOST_STAGES}")));
        }
    }
    Ok(loading)
}

/// A stage as [`loading_text`] writes it. A number without unit is of the usual kind, by default a force.
///
/// # Errors
/// Text that is no stage.
pub fn read_stage(text: &str, usual: Option<usize>) -> Result<Move, QuantityError> {
    let plain = text.replace(['(', ')'], " ");
    let plain = plain.trim();
    for StageKind { example, word, unit, stage } in &STAGE_KINDS {
        let rest = [choice_name(example), word].into_iter().find_map(|name| plain.strip_prefix(name));
        match rest {
            Some("") if unit.is_empty() => return Ok(stage(0.0)),
            Some(number) if !unit.is_empty() => return parse_quantity(number, unit).map(stage),
            _ => {}
        }
    }
    let of_unit = STAGE_KINDS.iter().filter(|kind| plain.ends_with(kind.unit));
    let kinds = usual.map(|kind| &STAGE_KINDS[kind]).into_iter().chain(of_unit).chain(&STAGE_KINDS[..1]);
    let mut kinds = kinds.filter(|kind| !kind.unit.is_empty());
    let found = kinds.find_map(|kind| parse_quantity(plain, kind.unit).ok().map(kind.stage));
    found.ok_or_else(|| refused(text))
}

fn refused(text: &str) -> QuantityError {
    let examples = "10 µN, 200 nm, displacement 200 nm, touch, zero force, separation, 3 loops 5 µN to 10 µN, 4 reversals to 10 µN";
    let most = MOST_STAGES / 2;
    QuantityError(format!("{:?} is not a stage; such as {examples} (at most {most})", shown(text)))
}

/// Part of a loading: a stage, or stages that repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Run {
    /// A single stage.
    Stage(Move),
    /// The second stage, then this number of times the first one and the second one: minor loops.
    Loops(usize, Move, Move),
    /// This number of turning points, equally spaced up to this one, each followed by a separation.
    Reversals(usize, Move),
}

impl Run {
    /// Its stages.
    pub fn stages(self) -> Vec<Move> {
        match self {
            Run::Stage(stage) => vec![stage],
            Run::Loops(count, low, high) => {
                [high].into_iter().chain((0..count).flat_map(|_| [low, high])).collect()
            }
            Run::Reversals(count, high) => {
                let (kind, number) = kind_and_number(&high);
                let part = |k| round_to(number.unwrap_or_default() * k as f64 / count as f64, 12);
                let turn = |k| if k == count { high } else { (STAGE_KINDS[kind].stage)(part(k)) };
                (1..=count).flat_map(|k| [turn(k), Move::ToSeparation]).collect()
            }
        }
    }

    fn text(self, format: fn(f64, &str) -> String) -> String {
        let text = |stage| stage_text(&stage, format);
        match self {
            Run::Stage(stage) => text(stage),
            Run::Loops(count, low, high) => format!("{count} loops {} to {}", text(low), text(high)),
            Run::Reversals(count, high) => format!("{count} reversals to {}", text(high)),
        }
    }

    fn read(text: &str) -> Result<Run, QuantityError> {
        let parsed = |count: &str| count.parse().ok().filter(|count| (1..=MOST_STAGES / 2).contains(count));
        let number = |count| parsed(count).ok_or_else(|| refused(text));
        let stage = |text| read_stage(text, None);
        let (loops, reversals) = (text.split_once(" loops "), text.split_once(" reversals to "));
        let loops = loops.and_then(|(count, ends)| Some((count, ends.split_once(" to ")?)));
        match (loops, reversals) {
            (Some((count, (low, high))), _) => Ok(Run::Loops(number(count)?, stage(low)?, stage(high)?)),
            (None, Some((count, high))) => Ok(Run::Reversals(number(count)?, stage(high)?)),
            (None, None) => stage(text).map(Run::Stage),
        }
    }
}

/// The runs of a loading.
pub fn runs(loading: &[Move]) -> Vec<Run> {
    let (mut runs, mut rest) = (Vec::new(), loading);
    while let Some(&first) = rest.first() {
        let pairs = |from: usize| rest.get(from..).unwrap_or_default().chunks_exact(2);
        let loops = pairs(1).take_while(|pair| *pair == [rest[1], first]).count();
        let has_number = |stage| kind_and_number(stage).1.is_some();
        let turns = pairs(0).take_while(|pair| has_number(&pair[0]) && pair[1] == Move::ToSeparation).count();
        let run = match (loops, turns) {
            (2.., _) => Run::Loops(loops, rest[1], first),
            (_, 2..) => Run::Reversals(turns, rest[2 * turns - 2]),
            _ => Run::Stage(first),
        };
        let stages = run.stages();
        let (these, others) = rest.split_at(stages.len());
        // Turning points in other distances are single stages.
        match these == stages {
            true => runs.push(run),
            false => runs.extend(these.iter().map(|stage| Run::Stage(*stage))),
        }
        rest = others;
    }
    runs
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::quantity::{exact_quantity, format_quantity};
    use super::Move::*;
    use super::*;

    /// Numbers and stages of which some occur again and again.
    fn run() -> impl Strategy<Value = Run> {
        let number = prop_oneof![
            prop::sample::select(vec![1e-5, 5e-6, 2.5e-6, 7.5e-6, 0.0, -2e-6]),
            (-30.0..30.0_f64, -1.0..1.0_f64).prop_map(|(power, digits)| digits * 10.0_f64.powf(power)),
        ];
        let stage =
            (0..STAGE_KINDS.len(), number).prop_map(|(kind, number)| (STAGE_KINDS[kind].stage)(number));
        let number_of = |stage: &Move| kind_and_number(stage).1.is_some();
        let turn = stage.clone().prop_filter("a turning point has a number", number_of);
        prop_oneof![
            4 => stage.clone().prop_map(Run::Stage),
            1 => (1..4_usize, stage.clone(), stage).prop_map(|(count, low, high)| Run::Loops(count, low, high)),
            1 => (1..5_usize, turn).prop_map(|(count, high)| Run::Reversals(count, high)),
        ]
    }

    proptest! {
        #[test]
        fn what_is_shown_reads_back_as_the_same_loading(parts in prop::collection::vec(run(), 1..8)) {
            let loading: Vec<Move> = parts.into_iter().flat_map(Run::stages).collect();
            let text = loading_text(&loading, exact_quantity);
            prop_assert_eq!(&read_loading(&text), &Ok(loading.clone()), "{}", text);
            prop_assert_eq!(&read_loading(&format!("[{text}]")), &Ok(loading.clone()), "[{}]", text);
            let ron = format!("[{}]", loading.iter().map(stage_in_ron).collect::<Vec<_>>().join(","));
            prop_assert_eq!(ron::from_str(&ron), Ok(loading.clone()), "{}", ron);
            prop_assert_eq!(read_loading(&ron), Ok(loading), "{}", ron);
        }
    }

    #[test]
    fn a_loading_is_a_list_of_stages_and_runs() {
        for (text, loading) in [
            (
                "10 µN, 0 N, -5 nm, separation",
                vec![ToForce(1e-5), ToForce(0.0), ToIndentation(-5e-9), ToSeparation],
            ),
            (
                "2 loops 0 N to 10 µN",
                vec![ToForce(1e-5), ToForce(0.0), ToForce(1e-5), ToForce(0.0), ToForce(1e-5)],
            ),
            (
                "2 reversals to 200 nm",
                vec![ToIndentation(1e-7), ToSeparation, ToIndentation(2e-7), ToSeparation],
            ),
            ("zero force, touch", vec![ToZeroForce, ToTouch]),
        ] {
            assert_eq!(read_loading(text).as_ref(), Ok(&loading), "{text}");
            assert_eq!(loading_text(&loading, format_quantity), text);
        }
        // Turning points in other distances.
        let loading = [ToForce(1e-5), ToSeparation, ToForce(3e-5), ToSeparation];
        assert_eq!(loading_text(&loading, format_quantity), "10 µN, separation, 30 µN, separation");
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
            ("", "\"\" is not a stage; such as 10 µN, 200 nm, displacement 200 nm, touch"),
            ("10 µN, separaton", "\"separaton\" is not a stage"),
            ("10 kg", "\"10 kg\" is not a stage"),
            ("[ToForce(10 kg)]", "kg is not a unit of force: use N, mN, µN, nN"),
            ("0 loops 0 N to 1 N", "4 reversals to 10 µN (at most 50000)"),
            ("99999999999999999999999 reversals to 1 N", "(at most 50000)"),
            ("50000 loops touch to 1 N", "too many stages; allowed: at most 100000"),
        ] {
            let refused = read_loading(text).unwrap_err().to_string();
            assert!(refused.contains(why), "{text}: {refused}");
        }
    }
}
