//! The motion of the instrument by the times of a file, in pieces of one speed.

/// Part of a motion over which the instrument moves at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// Displacement in m at the end of the piece.
    pub end: f64,
    /// Speed in m/s, which is positive.
    pub speed: f64,
}

/// Displacement in m of the instrument at a time in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Passage {
    pub displacement: f64,
    pub seconds: f64,
}

/// Largest difference between the times of the points and those of the pieces, as a share of the
/// duration of the motion.
const EVEN: f64 = 0.01;
/// Factor by which this largest difference is increased as long as a motion has too many pieces.
const COARSER: f64 = 2.0;
/// Largest number of pieces of a motion.
const MOST_PIECES: usize = 12;
/// Smallest length of a piece, as a share of the length of the motion.
const SHORTEST: f64 = 1e-6;

/// Divides a motion in one direction into pieces, so that the times of the points follow from the
/// speeds of the pieces. `passages` are in the order of time. Points at which the instrument is not
/// farther than before, because of noise, do not count. A rest becomes a short piece of low speed.
/// `speed` in m/s is the speed of the whole motion, which is kept if one piece is enough.
pub(crate) fn pieces_of(passages: &[Passage], speed: f64) -> Vec<Piece> {
    let ahead = farther(passages);
    let (Some(first), Some(last)) = (ahead.first(), ahead.last()) else {
        return Vec::new();
    };
    let mut tolerance = EVEN * (last.seconds - first.seconds);
    let mut knots = knots_of(&ahead, tolerance);
    while knots.len() > MOST_PIECES + 1 {
        tolerance *= COARSER;
        knots = knots_of(&ahead, tolerance);
    }
    if knots.len() <= 2 {
        return vec![Piece {
            end: last.displacement,
            speed,
        }];
    }
    let mut pieces = Vec::with_capacity(knots.len() - 1);
    for pair in knots.windows(2) {
        let way = (pair[1].displacement - pair[0].displacement).abs();
        pieces.push(Piece {
            end: pair[1].displacement,
            speed: way / (pair[1].seconds - pair[0].seconds),
        });
    }
    pieces
}

/// Returns the passages at which the instrument is farther in the direction of its motion than at
/// all earlier ones.
fn farther(passages: &[Passage]) -> Vec<Passage> {
    let (Some(first), Some(last)) = (passages.first(), passages.last()) else {
        return Vec::new();
    };
    let way = last.displacement - first.displacement;
    let least = SHORTEST * way.abs();
    let mut ahead: Vec<Passage> = Vec::with_capacity(passages.len());
    for passage in passages {
        let Some(before) = ahead.last() else {
            ahead.push(*passage);
            continue;
        };
        let step = (passage.displacement - before.displacement) * way.signum();
        if step > least && passage.seconds > before.seconds {
            ahead.push(*passage);
        }
    }
    ahead
}

/// Returns the passages between which the others lie on straight lines, up to a difference of the
/// times of `tolerance` in s (Douglas and Peucker, Cartographica 10, 112, 1973).
fn knots_of(passages: &[Passage], tolerance: f64) -> Vec<Passage> {
    let Some(end) = passages.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut is_knot = vec![false; passages.len()];
    is_knot[0] = true;
    is_knot[end] = true;
    let mut parts = vec![[0, end]];
    while let Some([first, last]) = parts.pop() {
        let [from, to] = [passages[first], passages[last]];
        let slope = (to.seconds - from.seconds) / (to.displacement - from.displacement);
        let mut farthest = first;
        let mut most = tolerance;
        for (index, passage) in passages.iter().enumerate().take(last).skip(first + 1) {
            let straight = from.seconds + slope * (passage.displacement - from.displacement);
            let difference = (passage.seconds - straight).abs();
            if difference > most {
                most = difference;
                farthest = index;
            }
        }
        if farthest > first {
            is_knot[farthest] = true;
            parts.push([first, farthest]);
            parts.push([farthest, last]);
        }
    }
    let knots = passages.iter().zip(is_knot);
    knots
        .filter(|(_, is_knot)| *is_knot)
        .map(|(passage, _)| *passage)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns passages every 10 nm over a motion of 1 µm that begins at 0. The motion has four
    /// speeds in m/s, each over 250 nm, and rests for `rest` in s between the second and the third.
    /// `sign` is the sign of the displacements.
    fn passages(speeds: [f64; 4], rest: f64, sign: f64) -> Vec<Passage> {
        let mut seconds = 0.0;
        let mut passages = Vec::new();
        for step in 0..=100 {
            passages.push(Passage {
                displacement: sign * 1e-8 * f64::from(step),
                seconds,
            });
            seconds += 1e-8 / speeds[(step / 25).min(3) as usize];
            if step == 50 {
                seconds += rest;
            }
        }
        passages
    }

    /// Returns the time in s at which pieces reach a displacement.
    fn time_at(pieces: &[Piece], displacement: f64) -> f64 {
        let mut seconds = 0.0;
        let mut from: f64 = 0.0;
        for piece in pieces {
            if displacement.abs() <= piece.end.abs() {
                return seconds + (displacement - from).abs() / piece.speed;
            }
            seconds += (piece.end - from).abs() / piece.speed;
            from = piece.end;
        }
        seconds
    }

    #[test]
    fn an_even_motion_is_one_piece_with_its_speed() {
        let passages = passages([1e-7; 4], 0.0, -1.0);
        let pieces = pieces_of(&passages, 1.01e-7);
        let expected = Piece {
            end: passages[100].displacement,
            speed: 1.01e-7,
        };
        assert_eq!(pieces, [expected]);
        assert_eq!(pieces_of(&[], 1.0), []);
    }

    #[test]
    fn the_times_of_pieces_are_those_of_the_points() {
        for sign in [1.0, -1.0] {
            for (speeds, rest) in [
                ([1e-7, 1e-6, 1e-7, 5e-7], 0.0),
                ([1e-7; 4], 20.0),
                ([1e-8, 1e-7, 1e-6, 1e-5], 3.0),
            ] {
                let passages = passages(speeds, rest, sign);
                let pieces = pieces_of(&passages, 1.0);
                assert!(pieces.len() <= 6, "{pieces:?}");
                let duration = passages[100].seconds;
                for passage in passages {
                    let found = time_at(&pieces, passage.displacement);
                    assert!(
                        (found - passage.seconds).abs() < 1.1 * EVEN * duration,
                        "{passage:?} {found}"
                    );
                }
            }
        }
    }

    /// If the displacement changes during a rest only by rounding, the rest becomes no piece.
    #[test]
    fn a_rest_is_no_piece_of_a_length_by_rounding() {
        let mut passages = passages([1e-7; 4], 20.0, 1.0);
        let rounded = Passage {
            displacement: passages[50].displacement * (1.0 + 1e-9),
            seconds: passages[50].seconds + 10.0,
        };
        passages.insert(51, rounded);
        let mut from = 0.0;
        for piece in pieces_of(&passages, 1.0) {
            assert!(piece.end - from >= 1e-12, "{piece:?}");
            from = piece.end;
        }
    }

    #[test]
    fn an_uneven_motion_has_few_pieces() {
        let mut passages = passages([1e-7; 4], 0.0, 1.0);
        for (index, passage) in passages.iter_mut().enumerate() {
            passage.seconds += 3.0 * (index as f64).sin().powi(2) * passage.seconds / 10.0;
        }
        let pieces = pieces_of(&passages, 1e-7);
        assert!((1..=MOST_PIECES).contains(&pieces.len()), "{pieces:?}");
        assert!(pieces.iter().all(|piece| piece.speed > 0.0));
    }
}
