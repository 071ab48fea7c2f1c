//! Measured profiles, as written by instruments and people, and invalid ones.

use super::properties::profile;
use super::*;

/// Profile file of scenes with a measured profile.
pub const FILE: &str = "profile.csv";

/// Profiles.
const PROFILES: u32 = 2500;

/// Most rows of a drawn profile.
const MOST_ROWS: usize = 40;

/// A profile on a length of 1: ascending positions from 0 to 1, and heights of the size of 1.
#[derive(Clone, Debug)]
pub struct Shape {
    positions: Vec<f64>,
    heights: Vec<f64>,
}

impl Shape {
    /// The profile on `length` m, `height` m high.
    pub fn text(&self, length: f64, height: f64) -> String {
        let row = |(x, z): (&f64, &f64)| format!("{:?}\t{:?}\n", x * length, z * height);
        self.positions.iter().zip(&self.heights).map(row).collect()
    }
}

/// Shapes with heights of a few levels, which nearly tie, and with heights of all sizes.
pub fn shapes() -> impl Strategy<Value = Shape> {
    let near_tie = (0_u8..4, 0_u32..5)
        .prop_map(|(level, steps)| (0..steps).fold(0.25 * f64::from(level), |height, _| height.next_up()));
    let any_size = (-40.0..0.0_f64).prop_map(f64::exp);
    let of = |height: BoxedStrategy<f64>| prop::collection::vec((any_step(), height), 1..MOST_ROWS);
    (prop_oneof![of(near_tie.boxed()), of(any_size.boxed()), of((-1.0..1.0_f64).boxed())], -1.0..1.0_f64)
        .prop_map(|(rows, first)| {
            let end: f64 = rows.iter().map(|(step, _)| step).sum();
            let mut x = 0.0;
            let mut shape = Shape { positions: vec![0.0], heights: vec![first] };
            for (step, height) in rows {
                x += step;
                shape.positions.push(x / end);
                shape.heights.push(height);
            }
            shape
        })
}

/// Equal steps, and steps of many sizes.
fn any_step() -> impl Strategy<Value = f64> {
    prop_oneof![3 => Just(1.0), 1 => (-12.0..2.0_f64).prop_map(f64::exp)]
}

/// A number of a column, of any size, and now and then none.
fn column() -> BoxedStrategy<String> {
    prop_oneof![
        12 => (any::<bool>(), -30.0..21.0_f64)
            .prop_map(|(negative, log)| format!("{:e}", if negative { -log.exp() } else { log.exp() })),
        2 => any::<i32>().prop_map(|number| number.to_string()),
        1 => prop::sample::select(vec!["NaN", "inf", "1e9", "-1e9", "1.0000001e9", "x", "", "1,5", "\u{feff}0", "+.5"])
            .prop_map(str::to_string),
    ]
    .boxed()
}

/// Rows whose positions mostly ascend, between headers, comments, empty lines and rows of other numbers of columns.
fn texts() -> impl Strategy<Value = String> {
    let separator = prop::sample::select(vec![",", ";", "\t", " ", "  ", ", "]);
    let row = (-9.0..9.0_f64, column()).prop_map(|(step, z)| (Some(step.exp()), z));
    let other = prop_oneof![
        column().prop_map(|x| (None, x)),
        Just((None, "# x,z".to_string())),
        Just((None, String::new())),
        (column(), column()).prop_map(|(x, z)| (None, format!("{x} {z}"))),
    ];
    let rows = prop::collection::vec(prop_oneof![30 => row, 1 => other], 0..MOST_ROWS);
    let start = prop::sample::select(vec!["", "", "\u{feff}", "x,z\n", "x z\n", "# 1 2\n\n", "a\nb\n"]);
    let ending = prop::sample::select(vec!["\n", "\r\n"]);
    (start, rows, separator, ending, -1e3..1e3_f64).prop_map(|(start, rows, separator, ending, mut x)| {
        let mut text = start.to_string();
        for (step, rest) in rows {
            if let Some(step) = step {
                x += step;
                text += &format!("{x:?}{separator}");
            }
            text += &rest;
            text += ending;
        }
        text
    })
}

#[test]
fn texts_of_profiles() {
    proptest!(draws(PROFILES), |(text in texts())| profile(text.as_bytes()));
}

#[test]
fn shapes_are_profiles() {
    let sizes = (-20.0..2.0_f64, -40.0..2.0_f64).prop_map(|(length, height)| (length.exp(), height.exp()));
    proptest!(draws(PROFILES / 4), |(shape in shapes(), (length, height) in sizes)| {
        profile(shape.text(length, height).as_bytes());
    });
}
