//! Halves of one map agree within their errors, whether the map is uniform or not, and scans that
//! differ have errors that hold the difference.

use crate::effort::cases;
use crate::generate::{Kind, Map, Spectrum};
use asperity_surface::{Analysis, AnalysisOptions, LineMoments, Moment, Topography, analyse};

const POINTS: usize = 256;

fn analysed(surfaces: &[Topography]) -> Analysis {
    analyse(surfaces, &AnalysisOptions::default()).unwrap()
}

/// Rms height, rms gradient and elastic energy.
fn moments(line: &LineMoments) -> [Moment; 3] {
    [line.rms_height, line.rms_gradient, line.energy_per_modulus]
}

/// Pairs of halves, and how many of them agree within two of their errors, for each moment.
#[derive(Default)]
struct Agreement {
    pairs: u32,
    within: [u32; 3],
    /// Maps whose parts differ by more than chance explains.
    uneven: u32,
    maps: u32,
}

impl Agreement {
    fn of_maps(kinds: &[Kind], seeds: std::ops::Range<u64>) -> Agreement {
        let mut agreement = Agreement::default();
        for kind in kinds {
            for seed in seeds.clone() {
                agreement.add(&kind.draw(POINTS, seed));
            }
        }
        println!(
            "{kinds:?}: {:?} of {} pairs, {} of {} maps uneven",
            agreement.within, agreement.pairs, agreement.uneven, agreement.maps
        );
        agreement
    }

    fn add(&mut self, map: &Map) {
        self.maps += 1;
        self.uneven += u32::from(analysed(&[map.whole()]).ratio_of_parts > 1.0);
        for [first, second] in map.halves() {
            let first = moments(&analysed(&[first]).line);
            let second = moments(&analysed(&[second]).line);
            self.pairs += 1;
            for index in 0..3 {
                let error = first[index].error.hypot(second[index].error);
                let difference = (first[index].value - second[index].value).abs();
                self.within[index] += u32::from(difference < 2.0 * error);
            }
        }
    }

    fn shares(&self) -> [f64; 3] {
        self.within
            .map(|count| f64::from(count) / f64::from(self.pairs))
    }
}

#[test]
fn halves_of_a_few_uneven_maps_agree_within_their_errors() {
    let agreement = Agreement::of_maps(&Kind::UNEVEN, 0..2);
    // Of 20 pairs 17 or more agree in all but a few of a hundred sets.
    assert!(
        agreement.shares().iter().all(|share| *share >= 0.85),
        "{:?}",
        agreement.within
    );
    assert!(agreement.uneven >= 8);
}

#[test]
#[ignore = "takes a minute or more; TEST_EFFORT multiplies the 20 maps"]
fn halves_of_uneven_maps_agree_within_their_errors() {
    let each = u64::from(cases(4));
    let agreement = Agreement::of_maps(&Kind::UNEVEN, 0..each);
    assert!(
        agreement.shares().iter().all(|share| *share >= 0.9),
        "{:?} of {}",
        agreement.within,
        agreement.pairs
    );
}

#[test]
#[ignore = "takes a minute or more; TEST_EFFORT multiplies the 40 maps"]
fn uniform_normal_maps_keep_their_errors() {
    let agreement = Agreement::of_maps(&[Kind::Normal], 100..100 + u64::from(cases(40)));
    let [height, gradient, energy] = agreement.shares();
    assert!(height >= 0.9 && (0.9..=0.99).contains(&gradient) && (0.9..=1.0).contains(&energy));
    // Chance makes about one map in a hundred look uneven.
    assert!(f64::from(agreement.uneven) <= 0.05 * f64::from(agreement.maps) + 1.0);
}

fn sample(seed: u64) -> Map {
    let spectrum = Spectrum {
        hurst: 0.7,
        roll_off: 10.0,
        last: 60.0,
    };
    Map::random(128, &spectrum, seed)
}

fn multiplied(map: &Map, factor: f64) -> Topography {
    let mut map = map.clone();
    for z in &mut map.heights {
        *z *= factor;
    }
    map.whole()
}

/// The error of several scans covers each of them, whatever they differ by.
#[test]
fn scans_that_differ_have_errors_that_cover_them() {
    let map = sample(1);
    let other = sample(2);
    for factor in [1.5, 3.0, 1000.0] {
        for second in [&map, &other] {
            let scans = [map.whole(), multiplied(second, factor)];
            let both = analysed(&scans);
            for scan in &scans {
                let alone = moments(&analysed(std::slice::from_ref(scan)).line);
                for (moment, alone) in moments(&both.line).iter().zip(alone) {
                    assert!(
                        (moment.value - alone.value).abs() < 2.0 * moment.error,
                        "{factor}: {moment:?} {alone:?}"
                    );
                }
            }
            let ratio = both.ratio_of_surfaces / factor;
            assert!((0.9..1.15).contains(&ratio), "{factor}: {ratio}");
        }
    }
    let equal = analysed(&[map.whole(), other.whole()]);
    assert_eq!(equal.ratio_of_surfaces, 1.0);
    let alone = analysed(&[map.whole()]);
    assert!(equal.line.rms_gradient.error < alone.line.rms_gradient.error);
}

/// Scans of different sizes are compared by the spectrum that is fitted to both.
#[test]
fn scans_of_different_sizes_that_differ_are_named() {
    let map = sample(3);
    let part = sample(4);
    let part_of = |factor: f64| {
        let mut part = part.clone();
        for z in &mut part.heights {
            *z *= factor;
        }
        part.part([0, 96], [0, 96])
    };
    let equal = analysed(&[map.whole(), part_of(1.0)]);
    assert_eq!(equal.ratio_of_surfaces, 1.0);
    let three = analysed(&[map.whole(), part_of(3.0)]);
    assert!(
        (2.0..4.0).contains(&three.ratio_of_surfaces),
        "{}",
        three.ratio_of_surfaces
    );
    let gradient = three.line.rms_gradient;
    assert!(gradient.error > 0.3 * gradient.value, "{gradient:?}");
}

/// One half of a map is rougher than the other, as in two scans that meet in the middle.
#[test]
fn a_map_of_two_halves_has_an_error_of_their_difference() {
    let mut map = sample(5);
    map.change(|z, x, _| if x < 0.5 { z } else { 1.6 * z });
    let analysis = analysed(&[map.whole()]);
    assert!(
        (1.3..2.0).contains(&analysis.ratio_of_parts),
        "{}",
        analysis.ratio_of_parts
    );
    // The gradients of the halves are 0.75 and 1.2 times the gradient of the map.
    let gradient = analysis.line.rms_gradient;
    assert!(gradient.error > 0.5 * 0.25 * gradient.value, "{gradient:?}");
    assert_eq!(analysed(&[sample(5).whole()]).ratio_of_parts, 1.0);
}

/// Surfaces with too few points for parts, or with next to none.
#[test]
fn small_surfaces_have_no_parts() {
    let map = sample(6);
    let small = analysed(&[map.part([0, 32], [0, 32])]);
    assert!(small.ratio_of_parts >= 1.0 && small.line.rms_height.error.is_finite());
    let row = map.part([0, 128], [0, 1]);
    assert!(analysed(&[row]).ratio_of_parts >= 1.0);
    let narrow = analysed(&[map.part([0, 128], [0, 33])]);
    assert!(narrow.line.rms_gradient.error.is_finite());
}
