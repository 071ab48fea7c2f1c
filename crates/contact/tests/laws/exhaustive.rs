//! Complete small worlds: every order of few gaps, ties included, against the definitions of the
//! thresholds, and every history of a few springs against the bare rules.

use super::body::Foundation;
use asperity_contact::motion::{Body, MovingBody};
use asperity_contact::{ContactError, Edges, Move, Patch};
use std::f64::consts::PI;

const SPACING: f64 = 0.01;
const FOUNDATION: Foundation = Foundation::new(SPACING, 1.0);
/// Gaps of the levels, m: no difference of two is a largest stretch.
const LEVELS: [f64; 8] = [0.0, 0.13, 0.31, 0.37, 0.59, 0.71, 0.83, 1.0];
/// γ/E*, m: largest stretches of one spring from 0.03 to 0.5 m.
const RANGES: [f64; 3] = [0.03, 0.7, 8.0];
/// γ₁/E* on closing and γ₂/E* on opening, m.
const WORKS: [[f64; 2]; 3] = [[0.7, 0.7], [0.0, 0.7], [0.3, 3.1]];
/// Heights of the five springs of a history, and the indentations at which it turns, m.
const HEIGHTS: [f64; 5] = [0.0, 0.2, 0.35, 0.6, 1.0];
const TURNS: [f64; 7] = [-0.45, -0.2, 0.0, 0.17, 0.35, 0.7, 1.1];
/// Turning points of a history.
const MOVES: usize = 3;
/// Agreement of two thresholds, m.
const AGREE: f64 = 1e-12;

/// Compares the thresholds of a loading to full contact with both edge models, and of the way back
/// with whole springs, on every line of this number of springs with gaps in any order, ties
/// included. Springs out of reach on the left, `before` of them, move the others across the ends of
/// blocks. Returns the number of lines.
fn every_order(springs: usize, before: usize) -> Result<u64, String> {
    let mut gaps: Vec<f64> = (0..before)
        .map(|place| 3.0 + (before - place) as f64)
        .collect();
    gaps.resize(before + springs, 0.0);
    let mut lines = 0;
    for levels in sequences(springs.min(LEVELS.len()), springs) {
        let highest = levels.iter().copied().max().unwrap_or(0);
        // One line of each order: that which leaves no level out.
        if (0..highest).all(|level| levels.contains(&level)) {
            gaps[before..]
                .iter_mut()
                .zip(levels)
                .for_each(|(gap, level)| *gap = LEVELS[level]);
            for range in RANGES {
                compare(&gaps, range, Edges::Grid)?;
                compare(&gaps, range, Edges::SubCell)?;
            }
            lines += 1;
        }
    }
    Ok(lines)
}

/// All sequences of `count` digits below `base`.
fn sequences(base: usize, count: usize) -> impl Iterator<Item = Vec<usize>> {
    let digits = move |number| {
        (0..count as u32)
            .map(move |digit| number / base.pow(digit) % base)
            .collect()
    };
    (0..base.pow(count as u32)).map(digits)
}

fn compare(gaps: &[f64], range: f64, edges: Edges) -> Result<(), String> {
    let mut body = Body::new(&FOUNDATION.contact(gaps, edges, [range; 2]), 2);
    let definition = Definition {
        gaps,
        stretch: FOUNDATION.largest_stretch(range, 1),
        edges,
    };
    let whole = Patch {
        first: 0,
        last: gaps.len() - 1,
    };
    let deepest = gaps.iter().copied().fold(0.0, f64::max) + 0.1;
    let mut expected = vec![f64::INFINITY; gaps.len()];
    definition.close(whole, &mut expected);
    let check = |body: &mut Body, to: f64, expected: &[f64]| {
        body.move_to(Move::ToIndentation(to))
            .map_err(|error: ContactError| error.to_string())?;
        let found = body.stage().thresholds();
        let agree = found
            .iter()
            .zip(expected)
            .all(|(one, other)| (one - other).abs() < AGREE);
        let differ =
            || format!("{gaps:?}, γ/E* = {range} m, {edges:?}: {found:?}, not {expected:?}");
        if agree { Ok(()) } else { Err(differ()) }
    };
    check(&mut body, deepest, &expected)?;
    if edges == Edges::SubCell {
        return Ok(());
    }
    definition.open(whole, deepest, &mut expected);
    check(&mut body, deepest - 0.05, &expected)
}

/// Thresholds by definition, over the max-Cartesian tree of the gaps.
struct Definition<'a> {
    gaps: &'a [f64],
    /// Largest stretch of a patch of one cell, m.
    stretch: f64,
    edges: Edges,
}

impl Definition<'_> {
    /// The largest of these gaps, the leftmost of equals, and the parts on its sides.
    fn split(&self, Patch { first, last }: Patch) -> (usize, impl Iterator<Item = Patch>) {
        let larger = |best: usize, next: usize| {
            if self.gaps[next] > self.gaps[best] {
                next
            } else {
                best
            }
        };
        let root = (first..=last).fold(first, larger);
        let parts = [
            (root > first).then(|| Patch {
                first,
                last: root - 1,
            }),
            (root < last).then_some(Patch {
                first: root + 1,
                last,
            }),
        ];
        (root, parts.into_iter().flatten())
    }

    /// Length of a patch over these springs, in cells, with its edges at the level of a spring next
    /// to it.
    fn length(&self, patch: Patch, level: f64) -> f64 {
        let Patch { first, last } = patch;
        if self.edges == Edges::Grid {
            return patch.springs().len() as f64;
        }
        let gaps = self.gaps;
        let share =
            |inside: usize, outside: Option<usize>| match outside.and_then(|at| gaps.get(at)) {
                None => 0.5,
                Some(&gap) if gap == gaps[inside] => 1.0,
                Some(gap) => ((level - gaps[inside]) / (gap - gaps[inside])).min(1.0),
            };
        (last - first) as f64 + share(first, first.checked_sub(1)) + share(last, Some(last + 1))
    }

    /// Indentation at which all of a subtree is one patch on loading, and the thresholds of its
    /// springs so far.
    fn close(&self, patch: Patch, thresholds: &mut [f64]) -> f64 {
        let (root, parts) = self.split(patch);
        let gap = self.gaps[root];
        let taken = parts.map(|part| {
            let closes = self.close(part, thresholds);
            closes.max(gap - self.stretch * self.length(part, gap).sqrt())
        });
        let closes = taken.fold(gap, f64::min);
        thresholds[patch.springs()]
            .iter_mut()
            .for_each(|one| *one = one.min(closes));
        closes
    }

    /// Thresholds of springs on the way back from full contact, under a subtree that opens at
    /// `opens`, m.
    fn open(&self, patch: Patch, opens: f64, thresholds: &mut [f64]) {
        let (root, parts) = self.split(patch);
        let gap = self.gaps[root];
        let opens = opens
            .min(gap - self.stretch * (patch.springs().len() as f64).sqrt())
            .min(gap);
        thresholds[root] = opens;
        parts.for_each(|part| self.open(part, opens, thresholds));
    }
}

/// Compares the patches after each move with those of the bare rules, for every history of three
/// moves on every `step`-th line of five springs, under one and two works of adhesion. Returns the
/// number of contacts compared.
fn every_history(step: usize) -> Result<u64, String> {
    let mut compared = 0;
    for heights in sequences(HEIGHTS.len(), 5).step_by(step) {
        let heights: Vec<f64> = heights.into_iter().map(|height| HEIGHTS[height]).collect();
        let summit = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let gaps: Vec<f64> = heights.iter().map(|height| height - summit).collect();
        for works in WORKS {
            let contact = FOUNDATION.contact(&gaps, Edges::Grid, works);
            for turns in sequences(TURNS.len(), MOVES) {
                let mut body = Body::new(&contact, 2);
                let mut bare = vec![false; gaps.len()];
                for at in turns.iter().map(|&turn| TURNS[turn]) {
                    body.move_to(Move::ToIndentation(at))
                        .map_err(|error| error.to_string())?;
                    relax(&gaps, &mut bare, at, works);
                    let mut found = vec![false; gaps.len()];
                    for patch in body.stage().patches(at) {
                        found[patch.springs()].fill(true);
                    }
                    if found != bare {
                        let history = format!("at {at} m of turns {turns:?} of {TURNS:?} m");
                        return Err(format!(
                            "{gaps:?}, γ/E* = {works:?} m, {history}: {found:?}"
                        ));
                    }
                    compared += 1;
                }
            }
        }
    }
    Ok(compared)
}

/// Applies the rules of touch, growth and detachment to any spring until none applies.
fn relax(gaps: &[f64], contact: &mut [bool], at: f64, works: [f64; 2]) {
    let stretch = |springs: usize, work: f64| (PI * springs as f64 * SPACING * work).sqrt();
    loop {
        let mut quiet = true;
        for spring in 0..gaps.len() {
            let left = contact[..spring]
                .iter()
                .rev()
                .take_while(|&&holds| holds)
                .count();
            let right = contact[spring + 1..]
                .iter()
                .take_while(|&&holds| holds)
                .count();
            let reach = gaps[spring] - at;
            let applies = if contact[spring] {
                let patch = &gaps[spring - left..=spring + right];
                let most_stretched = patch.iter().all(|gap| *gap <= gaps[spring]);
                reach > 0.0 && most_stretched && reach >= stretch(patch.len(), works[1])
            } else {
                let grows = |springs: usize| springs > 0 && reach <= stretch(springs, works[0]);
                reach <= 0.0 || grows(left) || grows(right)
            };
            contact[spring] ^= applies;
            quiet &= !applies;
        }
        if quiet {
            return;
        }
    }
}

#[test]
fn every_order_of_few_gaps_has_the_thresholds_of_the_definition() {
    // The numbers of weak orders (Fubini).
    let counts: Vec<u64> = (1..=6)
        .map(|springs| every_order(springs, 0).unwrap())
        .collect();
    assert_eq!(counts, [1, 3, 13, 75, 541, 4683]);
    assert!(
        (59..64).all(|before| every_order(4, before) == Ok(75)),
        "across the end of a block"
    );
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn every_order_of_eight_gaps_has_the_thresholds_of_the_definition() {
    assert_eq!(
        [every_order(7, 0), every_order(8, 0)],
        [Ok(47_293), Ok(545_835)]
    );
    assert!(
        (58..64).all(|before| every_order(6, before) == Ok(4683)),
        "across the end of a block"
    );
}

#[test]
fn histories_of_five_springs_agree_with_the_bare_rules() {
    assert_eq!(every_history(23), Ok(136 * 3 * 343 * 3));
}

#[test]
#[ignore = "takes ten seconds or more; .ci/run runs it"]
fn every_history_of_five_springs_agrees_with_the_bare_rules() {
    assert_eq!(every_history(1), Ok(3125 * 3 * 343 * 3));
}
