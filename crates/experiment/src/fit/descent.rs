//! Descent to the lowest cost near a place, without derivatives (Nelder and Mead, Comput. J. 7,
//! 308, 1965).

/// Bounds at which the search ends. `FLAT` is the difference of the costs at the worst and the best
/// corner, divided by the cost at the best one. `CLOSE` is the largest difference of a coordinate
/// of the two corners, divided by the first step.
const FLAT: f64 = 1e-6;
const CLOSE: f64 = 1e-4;

/// Corner of a simplex, the figure that a descent moves through the space of coordinates.
struct Corner {
    place: Vec<f64>,
    cost: f64,
}

/// Returns the place with the lowest cost that a simplex finds. A place has one number for each
/// coordinate, and at most `most` costs are computed. The first corner of the simplex is the start.
/// Each other corner is `step` away from the start along one coordinate.
///
/// # Errors
/// Returns the first error of `cost`.
pub(crate) fn descend<E>(
    start: &[f64],
    step: f64,
    most: usize,
    cost: &mut dyn FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Vec<f64>, E> {
    let mut corners = Vec::with_capacity(start.len() + 1);
    for moved in 0..=start.len() {
        let mut place = start.to_vec();
        if let Some(coordinate) = place.get_mut(moved) {
            *coordinate += step;
        }
        let cost = cost(&place)?;
        corners.push(Corner { place, cost });
    }
    let mut computed = corners.len();
    let last = start.len();
    while computed < most {
        corners.sort_by(|corner, next| corner.cost.total_cmp(&next.cost));
        let best = corners[0].cost;
        let worst = corners[last].cost;
        let distance = farthest(&corners[0], &corners[last]);
        if worst - best <= FLAT * best.abs() && distance <= CLOSE * step.abs() {
            break;
        }
        let middle = middle_of(&corners[..last]);
        let reflected = corner(&middle, &corners[last].place, -1.0, cost)?;
        computed += 1;
        let next_worst = corners[last - 1].cost;
        if reflected.cost < best {
            let further = corner(&middle, &corners[last].place, -2.0, cost)?;
            computed += 1;
            let is_better = further.cost < reflected.cost;
            corners[last] = if is_better { further } else { reflected };
            continue;
        }
        if reflected.cost < next_worst {
            corners[last] = reflected;
            continue;
        }
        let towards = if reflected.cost < worst { -0.5 } else { 0.5 };
        let nearer = corner(&middle, &corners[last].place, towards, cost)?;
        computed += 1;
        if nearer.cost < worst.min(reflected.cost) {
            corners[last] = nearer;
            continue;
        }
        let best_place = corners[0].place.clone();
        for other in &mut corners[1..] {
            *other = corner(&best_place, &other.place, 0.5, cost)?;
            computed += 1;
        }
    }
    corners.sort_by(|corner, next| corner.cost.total_cmp(&next.cost));
    Ok(corners.swap_remove(0).place)
}

/// Returns the largest difference of a coordinate of two corners.
fn farthest(corner: &Corner, other: &Corner) -> f64 {
    let coordinates = corner.place.iter().zip(&other.place);
    coordinates
        .map(|(first, second)| (first - second).abs())
        .fold(0.0, f64::max)
}

fn middle_of(corners: &[Corner]) -> Vec<f64> {
    let mut middle = vec![0.0; corners[0].place.len()];
    for corner in corners {
        for (sum, coordinate) in middle.iter_mut().zip(&corner.place) {
            *sum += coordinate / corners.len() as f64;
        }
    }
    middle
}

/// Computes the cost at the corner that lies at the share `share` of the way from the place `from`
/// to the place `to`.
fn corner<E>(
    from: &[f64],
    to: &[f64],
    share: f64,
    cost: &mut dyn FnMut(&[f64]) -> Result<f64, E>,
) -> Result<Corner, E> {
    let coordinates = from.iter().zip(to);
    let place: Vec<f64> = coordinates
        .map(|(from, to)| from + share * (to - from))
        .collect();
    let cost = cost(&place)?;
    Ok(Corner { place, cost })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// The minimum is found in the curved valley of Rosenbrock's function, and also along a single
    /// coordinate.
    #[test]
    fn the_lowest_place_is_found() {
        let mut valley = |place: &[f64]| {
            let across = place[1] - place[0] * place[0];
            Ok::<f64, Infallible>(100.0 * across * across + (1.0 - place[0]).powi(2) + 1e-9)
        };
        let Ok(found) = descend(&[-1.2, 1.0], 0.3, 400, &mut valley);
        assert!(
            found
                .iter()
                .all(|coordinate| (coordinate - 1.0).abs() < 1e-3),
            "{found:?}"
        );
        let mut kink = |place: &[f64]| Ok::<f64, Infallible>((place[0] - 3.0).abs() + 1e-6);
        let Ok(found) = descend(&[0.0], 0.3, 100, &mut kink);
        assert!((found[0] - 3.0).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn an_error_ends_the_descent() {
        let mut computed = 0;
        let mut cost = |_: &[f64]| {
            computed += 1;
            if computed > 5 {
                Err("stop")
            } else {
                Ok(f64::from(computed))
            }
        };
        assert_eq!(descend(&[0.0, 0.0], 0.3, 100, &mut cost), Err("stop"));
    }
}
