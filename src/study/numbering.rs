//! Numbers of the cells of a grid: the last axis is the fastest.

/// Places of a cell on axes with so many values.
pub(super) fn places_of(number: u64, counts: impl DoubleEndedIterator<Item = u64>) -> Vec<u64> {
    let mut rest = number;
    let place = |count: u64| {
        let place = rest % count;
        rest /= count;
        place
    };
    let mut places: Vec<u64> = counts.rev().map(place).collect();
    places.reverse();
    places
}

/// Number of the cell at places on axes with so many values; `None` beyond an end or with another number of axes.
pub(super) fn number_at(places: &[u64], counts: impl ExactSizeIterator<Item = u64>) -> Option<u64> {
    let same = counts.len() == places.len();
    let number = counts
        .zip(places)
        .try_fold(0, |number, (count, place)| (*place < count).then_some(number * count + place));
    number.filter(|_| same)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_places_are_each_other() {
        let counts = [3, 1, 4, 2];
        for number in 0..24 {
            let places = places_of(number, counts.into_iter());
            assert_eq!(number_at(&places, counts.into_iter()), Some(number));
        }
        assert_eq!(places_of(23, counts.into_iter()), [2, 0, 3, 1]);
        assert_eq!(places_of(1, counts.into_iter()), [0, 0, 0, 1]);
        for beyond in [&[3, 0, 0, 0][..], &[0, 0, 0, 2], &[0, 0, 0], &[0; 5]] {
            assert_eq!(number_at(beyond, counts.into_iter()), None, "{beyond:?}");
        }
    }
}
