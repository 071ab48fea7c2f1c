//! Ticks of the axes of a chart: their positions and labels.

use super::label::{Label, number};
use super::scale::Span;
use asperity_data::AxisScale;
use std::ops::RangeInclusive;

/// If the coordinates of a logarithmic axis lie in this range, the axis shows plain numbers instead
/// of powers of ten. The numbers are then between about 0.0003 and 30 000.
const PLAIN: RangeInclusive<f64> = -3.5..=4.5;

#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Coordinate of the tick. On a linear axis it is the number at the tick, on a logarithmic axis
    /// the decadic logarithm of this number.
    pub at: f64,
    /// Number or name that is written at the tick; `None` for a minor tick.
    pub label: Option<Label>,
}

/// Returns the ticks in a range of coordinates of an axis. About `most` ticks have a label. The
/// numbers in the labels are divided by `divisor`, which belongs to the prefix of the unit. On a
/// linear axis, the distance between ticks is at least `least`, in the unit without prefix.
pub(super) fn ticks(
    scale: AxisScale,
    span: Span,
    divisor: f64,
    most: usize,
    least: f64,
) -> Vec<Tick> {
    let Span { low, high } = span;
    if high <= low || !(high - low).is_finite() {
        return Vec::new();
    }
    match scale {
        AxisScale::Linear => {
            let mut ticks = linear(low / divisor, high / divisor, most, least / divisor);
            for tick in &mut ticks {
                tick.at *= divisor;
            }
            ticks
        }
        AxisScale::Logarithmic => {
            let shift = divisor.log10();
            let mut ticks = logarithmic(low - shift, high - shift, most);
            for tick in &mut ticks {
                tick.at += shift;
            }
            ticks
        }
    }
}

/// Returns true if a logarithmic axis with this range of coordinates shows plain numbers after
/// division by `divisor`. Otherwise it shows powers of ten.
pub(super) fn are_plain(span: Span, divisor: f64) -> bool {
    let shift = divisor.log10();
    span.low - shift >= *PLAIN.start() && span.high - shift <= *PLAIN.end()
}

/// Distance between two ticks with labels, and number of parts into which the minor ticks between
/// them divide this distance.
#[derive(Clone, Copy)]
struct Step {
    width: f64,
    parts: usize,
}

/// Returns a step of 1, 2 or 5 times a power of ten, such that a range of this width has about
/// `most` steps.
fn step_for(width: f64, most: usize) -> Step {
    let least = width / most.max(1) as f64;
    let power = 10_f64.powf(least.log10().floor());
    for (factor, parts) in [(1.0, 5), (2.0, 4), (5.0, 5)] {
        if factor * power >= 0.8 * least {
            return Step {
                width: factor * power,
                parts,
            };
        }
    }
    Step {
        width: 10.0 * power,
        parts: 5,
    }
}

fn linear(low: f64, high: f64, most: usize, least: f64) -> Vec<Tick> {
    let mut step = step_for(high - low, most);
    if step.width <= least {
        step = Step {
            width: least,
            parts: 1,
        };
    } else if step.width < least * step.parts as f64 {
        step.parts = (step.width / least) as usize;
    }
    let small = step.width / step.parts as f64;
    let hair = 1e-6 * step.width;
    let first = ((low - hair) / small).ceil() as i64;
    let last = ((high + hair) / small).floor() as i64;
    let mut ticks = Vec::new();
    for index in first..=last {
        let at = index as f64 * small;
        let is_labelled = index.rem_euclid(step.parts as i64) == 0;
        ticks.push(Tick {
            at,
            label: is_labelled.then(|| Label::plain(&number(at, step.width))),
        });
    }
    ticks
}

fn logarithmic(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let hair = 1e-9;
    let decades = (low - hair).floor() as i32..=(high + hair).ceil() as i32;
    let inside = |at: f64| (low - hair..=high + hair).contains(&at);
    let whole = decades
        .clone()
        .filter(|decade| inside(f64::from(*decade)))
        .count();
    // If the axis has fewer than three powers of ten, 2 and 5 times these powers are labelled as
    // well.
    let labelled: &[i32] = match whole {
        0..=1 if high - low < 0.7 => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
        0..=2 => &[1, 2, 5],
        _ => &[1],
    };
    let every = whole.div_ceil(most.max(1)).max(1) as i32;
    let is_plain = are_plain(Span { low, high }, 1.0);
    let mut ticks = Vec::new();
    for decade in decades {
        for digit in 1..10_i32 {
            let at = f64::from(decade) + f64::from(digit).log10();
            if !inside(at) {
                continue;
            }
            let is_labelled = labelled.contains(&digit) && decade.rem_euclid(every) == 0;
            ticks.push(Tick {
                at,
                label: is_labelled.then(|| logarithmic_label(digit, decade, is_plain)),
            });
        }
    }
    // A narrow range may contain fewer than two of these labelled numbers. In this case, the ticks
    // are at the numbers that a linear axis would show.
    if ticks.iter().filter(|tick| tick.label.is_some()).count() < 2 {
        let numbers = linear(10_f64.powf(low), 10_f64.powf(high), most, 0.0);
        return numbers
            .into_iter()
            .map(|tick| Tick {
                at: tick.at.log10(),
                ..tick
            })
            .collect();
    }
    ticks
}

/// Returns the label of the number `digit` · 10^`decade`, where `digit` is from 1 to 9.
fn logarithmic_label(digit: i32, decade: i32, is_plain: bool) -> Label {
    if is_plain {
        let power = 10_f64.powi(decade);
        return Label::plain(&number(f64::from(digit) * power, power));
    }
    let power = Label::power_of_ten(decade);
    if digit == 1 {
        power
    } else {
        Label::plain(&format!("{digit}·")).join(&power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: AxisScale, (low, high): (f64, f64), divisor: f64) -> Vec<String> {
        let ticks = ticks(scale, Span { low, high }, divisor, 6, 0.0).into_iter();
        ticks
            .filter_map(|tick| Some(tick.label?.to_string()))
            .collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        use AxisScale::{Linear, Logarithmic};
        assert_eq!(
            labels(Linear, (0.1, 0.9), 1.0),
            ["0.2", "0.4", "0.6", "0.8"]
        );
        assert_eq!(
            labels(Linear, (0.0, 2.5e-5), 1e-6),
            ["0", "5", "10", "15", "20", "25"]
        );
        assert_eq!(
            labels(Logarithmic, (-0.5, 1.0), 1.0),
            ["0.5", "1", "2", "5", "10"]
        );
        assert_eq!(
            labels(Logarithmic, (-3.0, 1.0), 1.0),
            ["0.001", "0.01", "0.1", "1", "10"]
        );
        assert_eq!(labels(Logarithmic, (0.3, 0.6), 1.0), ["2", "3"]);
        assert_eq!(
            labels(Logarithmic, (0.0, 0.02), 1.0),
            ["1.00", "1.01", "1.02", "1.03", "1.04"]
        );
        assert_eq!(
            labels(Logarithmic, (-9.0, -3.0), 1.0).len(),
            3,
            "every other decade"
        );
        assert_eq!(labels(Linear, (1.0, 1.0), 1.0), [""; 0]);
    }

    #[test]
    fn ticks_lie_within() {
        for (low, high) in [(-1.3, 4.2), (0.0, 1e-12), (5.0, 5.001), (-8.1, 9.3)] {
            for scale in [AxisScale::Linear, AxisScale::Logarithmic] {
                let ticks = ticks(scale, Span { low, high }, 1.0, 6, 0.0);
                let room = 1e-5 * (high - low) + 1e-8;
                assert!(
                    ticks
                        .iter()
                        .all(|tick| (low - room..=high + room).contains(&tick.at)),
                    "{ticks:?}"
                );
                assert!(
                    ticks.iter().filter(|tick| tick.label.is_some()).count() <= 10,
                    "{ticks:?}"
                );
            }
        }
    }
}
