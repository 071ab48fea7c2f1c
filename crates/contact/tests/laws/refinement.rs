//! More springs on the same straight pieces of a line.

use super::*;

/// The same straight pieces with `factor`, odd, times as many springs.
fn refined(body: &Body, factor: usize) -> Body {
    let gaps = (0..factor * body.gaps.len()).map(|index| {
        let (cell, part) = (index / factor, index % factor);
        let beside = if part < factor / 2 {
            cell.checked_sub(1)
        } else {
            Some(cell + 1)
        };
        let here = body.gaps[cell];
        // Beyond the first and the last spring the profile is level.
        let there = beside
            .and_then(|beside| body.gaps.get(beside))
            .copied()
            .unwrap_or(here);
        here + (there - here) * (part.abs_diff(factor / 2) as f64 / factor as f64)
    });
    let foundation = Foundation {
        spacing: body.foundation.spacing / factor as f64,
        ..body.foundation
    };
    Body {
        gaps: gaps.collect(),
        foundation,
        ..body.clone()
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn more_springs_on_the_same_straight_pieces_change_nothing(body in bodies(200)) {
        let body = Body { edges: Edges::SubCell, ..body };
        let coarse = body.history(&body.tour(), 17);
        for factor in [3, 5] {
            let fine = refined(&body, factor).history(&body.tour(), 17);
            for (one, other) in coarse.stages.iter().zip(&fine.stages) {
                let of_end = (end(one).force - end(other).force).abs();
                let error = of_end.max((one.smallest.force - other.smallest.force).abs());
                prop_assert!(error <= 1e-14 * body.force_scale(), "{} times as many springs: {}", factor, error);
            }
        }
    }
}
