//! How the adhesion of a pad depends on its length: the table of docs/learn.md, and the advice that
//! follows from it.

use crate::generated::{check, root};
use asperity_contact::Move;
use asperity_data::Warning;
use asperity_scene::{Document, Simulation};
use asperity_study::{Ensemble, Quantity, Statistics};

/// Numbers of the longest waves of 80 µm on the length.
const WAVES: [u64; 7] = [1, 2, 4, 8, 16, 32, 64];
const LONGEST: f64 = 8.0e-5;
/// Rms heights of the table, m.
const HEIGHTS: [f64; 2] = [8.0e-7, 4.0e-7];
const PROFILES: u64 = 32;

/// F_a/F_a,max of random profiles of the pad with this number of longest waves and this rms height
/// in m, under the same mean pressure.
fn shares(pad: &Document, waves: u64, height: f64) -> Statistics {
    let own = pad.scene();
    let Move::ToForce(force) = own.loading[0] else {
        panic!("{:?}", own.loading)
    };
    let length = waves as f64 * LONGEST;
    let area_ratio = (length / own.length).powi(2);
    let longer = own.with(|scene| {
        scene.length = length;
        scene.numerics.points = 512 * waves;
        scene.loading[0] = Move::ToForce(force * area_ratio);
        if let Some(asperity_scene::Roughness::SelfAffine { rms_height, .. }) = &mut scene.roughness
        {
            *rms_height = Some(height);
        }
    });
    let control = asperity_data::Control::default().on_threads(2);
    let simulation = &mut Simulation::default();
    let found = Ensemble::of(&longer.unwrap(), &[], PROFILES, simulation, control).unwrap();
    found.statistics(Quantity::AdhesionShare).unwrap()
}

fn per_cent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

#[test]
fn the_share_of_a_pad_grows_with_its_length() {
    let path = root().join("docs/examples/pad.ron");
    let pad = asperity_scene::open(path.to_str().unwrap()).unwrap();
    let mut table = "\n| length L | longest waves on L | F_a/F_a,max | quartiles | F_a/F_a,max at h = 0.4 µm | quartiles |\n\
                     |---|---|---|---|---|---|\n"
        .to_owned();
    let mut before = [0.0; 2];
    for waves in WAVES {
        let found = HEIGHTS.map(|height| shares(&pad, waves, height));
        let [lower, median, upper] = found[0].quartiles;
        let [smooth_lower, smooth_median, smooth_upper] = found[1].quartiles;
        let millimetres = 1e3 * LONGEST * waves as f64;
        table += &format!(
            "| {millimetres:.2} mm | {waves} | {} | {} to {} | {} | {} to {} |\n",
            per_cent(median),
            per_cent(lower),
            per_cent(upper),
            per_cent(smooth_median),
            per_cent(smooth_lower),
            per_cent(smooth_upper)
        );
        // The share never stops growing, and the profiles scatter less.
        assert!(median > before[0] && smooth_median > before[1], "{table}");
        before = [median, smooth_median];
        let width = (upper - lower) / median;
        let is_few = Warning::of_long_waves(waves as f64).is_some();
        assert_eq!(is_few, width > 0.1, "{waves}: {width}");
    }
    check("docs/learn.md", "lengths", &(table + "\n"));
}
