//! A million springs in the hardest shapes for a tree: a chain, all gaps equal, or all patches
//! alike. All results are known.

use super::*;

const SPRINGS: usize = 1 << 20;

/// The stages of a line on springs of which a million are 1 m long, with E* = 1 Pa, and its patches
/// after the first stage.
fn stages(gaps: &[f64], work: f64, deepest: f64) -> ([StageRecord; 2], usize) {
    let foundation = Foundation::new(1.0 / SPRINGS as f64, 1.0);
    let mut solver = Body::new(gaps.to_vec(), Edges::Grid, foundation, work).on(64);
    let loading = solver.advance(Move::ToIndentation(deepest)).unwrap();
    let patches = solver.stage().patches(deepest).len();
    let unloading = solver.advance(Move::ToSeparation).unwrap();
    assert_eq!(
        (loading.attached, unloading.attached),
        (unloading.detached, 0)
    );
    ([loading, unloading], patches)
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} against {expected}"
    );
}

#[test]
fn a_ramp_is_a_wedge_that_peels_from_one_side() {
    // c = mx, one patch [0, a]: d(a) = ma − √(πaγ/E*), F = E*(d a − m a²/2).
    let (slope, work, deepest) = (1.0, 0.01, 0.5);
    let indentation = |a: f64| slope * a - (PI * a * work).sqrt();
    let force = |a: f64| indentation(a) * a - 0.5 * slope * a * a;
    // dd/da = 0 at detachment; dF/da = 0 at the smallest force.
    let last = PI * work / (4.0 * slope * slope);
    let smallest = 9.0 * PI * work / (4.0 * slope * slope);
    let rising: Vec<f64> = (0..SPRINGS)
        .map(|i| slope * i as f64 / SPRINGS as f64)
        .collect();
    let falling: Vec<f64> = rising.iter().rev().copied().collect();
    let (one, patches) = stages(&rising, work, deepest);
    let (other, patches_of_other) = stages(&falling, work, deepest);
    assert_eq!((patches, patches_of_other), (1, 1));
    for (one, other) in one.iter().zip(&other) {
        assert_eq!(one.curve, other.curve);
        assert_eq!((one.largest, one.smallest), (other.largest, other.smallest));
        near(one.released_energy, other.released_energy, 1e-12);
    }
    let [_, unloading] = &one;
    near(unloading.smallest.force, force(smallest), 1e-4);
    near(unloading.smallest.indentation, indentation(smallest), 1e-2);
    near(unloading.end(), indentation(last), 3e-4);
    for point in one
        .iter()
        .flat_map(|stage| &stage.curve)
        .filter(|point| point.springs > 0)
    {
        // Each point of the curve has the length at which the rule of Hess just holds.
        let length = point.springs as f64 / SPRINGS as f64;
        assert!(
            (point.indentation - indentation(length)).abs() < 1e-5,
            "{point:?}"
        );
        assert!((point.force - force(length)).abs() < 1e-5, "{point:?}");
    }
}
