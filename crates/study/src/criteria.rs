//! Criteria by which other theories and this program decide whether a randomly rough body adheres
//! without a preload.
//!
//! Each criterion has its own conditions. If its conditions are not met, the criterion gives a
//! reason instead of a verdict. The criteria may disagree, because their theories have different
//! limits.

use super::criterion::{Criterion, long_ranged};
use super::ensemble::Ensemble;
use super::quantity::Quantity;
use super::rough_contact::RoughContact;
use asperity_scene::{Governing, Outcome, Regime, Scene};

const TABOR: Criterion = Criterion::new(
    "Tabor number",
    "μ",
    "Tabor: J. Colloid Interface Sci. 58 (1977) 2",
    Criterion::LEAST_TABOR_NUMBER,
);
const THIS_PROGRAM: Criterion = Criterion::new(
    Criterion::THIS_PROGRAM,
    "",
    "Popov, Filippov: Phys. Mesomech. 15 (2012)",
    Regime::VANISHING_SHARE,
);

/// Returns the criteria by which other theories and this program judge whether the bodies of a
/// computed scene adhere without a preload. The list is empty for a scene without adhesion. The
/// criteria of this program come last. They use the medians over `ensemble` or, if there is no
/// ensemble, the values of the scene's own profile.
///
/// Criteria for rough surfaces ignore the form of the body, and are left out for a smooth body.
///
/// ```
/// let scene = asperity_scene::open("jkr-sphere")?.set("numerics.points", "1024")?;
/// let rows = asperity_study::trust::criteria(scene.scene(), &asperity_scene::run(&scene)?, None);
/// assert_eq!(rows[0].name, "Tabor number");
/// assert!(rows[1..].iter().all(|row| row.sticks == Some(true)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn criteria(scene: &Scene, outcome: &Outcome, ensemble: Option<&Ensemble>) -> Vec<Criterion> {
    let governing = &outcome.governing;
    let Some((work, adhesion)) = governing.adhesive_work().zip(scene.adhesion) else {
        return Vec::new();
    };
    let rough = governing
        .amplitude
        .filter(|amplitude| amplitude.rms_curvature > 0.0);
    let rough = rough.map(|amplitude| RoughContact {
        amplitude,
        stretch: work / governing.modulus,
        range: adhesion.attraction_range(),
        spectrum: scene.spectrum(),
        length: scene.length,
        tabor_number: outcome.tabor_number,
    });
    let mut rows = rough.map_or_else(Vec::new, |rough| rough.criteria());
    rows.push(tabor(outcome.tabor_number));
    rows.extend(this_program(outcome, ensemble));
    rows
}

fn tabor(tabor_number: Option<f64>) -> Criterion {
    let reason = match tabor_number {
        None => "the form has no radius of curvature",
        Some(number) if number < Criterion::LEAST_TABOR_NUMBER => {
            "below 1: JKR theory and this program do not apply, DMT theory does"
        }
        Some(number) if number < Governing::LEAST_TABOR_NUMBER => {
            "from 1 to 5: between JKR and DMT theory"
        }
        Some(_) => "at least 5: JKR theory applies, as in this program",
    };
    Criterion {
        value: tabor_number,
        reason: Some(reason.to_owned()),
        ..TABOR
    }
}

/// Returns the criteria of this program: F_a(d=0) and F_a(F=0), each divided by the pull-off force
/// of the smooth body. Below [`Regime::VANISHING_SHARE`] adhesion counts as vanished, as in the
/// definition of the regimes.
fn this_program(outcome: &Outcome, ensemble: Option<&Ensemble>) -> Vec<Criterion> {
    let smooth = outcome.smooth_pull_off_force.filter(|smooth| *smooth > 0.0);
    let mut first_touch = outcome.first_touch_pull_off_force;
    let mut zero_force = outcome.zero_force_pull_off_force;
    let mut of_profiles = String::new();
    if let Some(ensemble) = ensemble {
        first_touch = median_of(ensemble, Quantity::FirstTouchPullOffForce);
        zero_force = median_of(ensemble, Quantity::ZeroForcePullOffForce);
        of_profiles = format!(", median of {} profiles", ensemble.computed());
    }
    let rows = [
        ("F_a(d=0)/F_smooth", "turned at first touch", first_touch),
        ("F_a(F=0)/F_smooth", "turned at zero force", zero_force),
    ];
    let refusal = long_ranged(outcome.tabor_number);
    let mut criteria = Vec::new();
    for (symbol, protocol, force) in rows {
        let (Some(force), Some(smooth)) = (force, smooth) else {
            continue;
        };
        let share = force / smooth;
        if !share.is_finite() {
            continue;
        }
        let sticks = share >= Regime::VANISHING_SHARE;
        let (sticks, reason) = match &refusal {
            Some(refusal) => (None, format!("does not hold: {refusal}")),
            None => (Some(sticks), format!("{protocol}{of_profiles}")),
        };
        criteria.push(Criterion {
            symbol,
            value: Some(share),
            sticks,
            reason: Some(reason),
            ..THIS_PROGRAM
        });
    }
    criteria
}

fn median_of(ensemble: &Ensemble, quantity: Quantity) -> Option<f64> {
    let [_, median, _] = ensemble.statistics(quantity)?.quartiles;
    Some(median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Document, Simulation, run};

    fn document(fields: &str) -> Document {
        let text = format!("(version: 1, length: 1.0e-5, numerics: (points: 4096), {fields})");
        Document::parse(&text, "test").unwrap_or_else(|errors| panic!("{errors}"))
    }

    fn rows(document: &Document, ensemble: Option<&Ensemble>) -> Vec<Criterion> {
        criteria(document.scene(), &run(document).unwrap(), ensemble)
    }

    /// Tests ruby on nanocrystalline diamond (Thimons et al. 2021), a stiff pair whose summits have
    /// a radius of 40 nm.
    #[test]
    fn the_tabor_number_refuses_hard_bodies() {
        let hard = document(
            "material: (modulus: 2.9e11), adhesion: (work: 0.05), loading: [ToForce(1.0e-6), ToSeparation], \
             roughness: SelfAffine(hurst: 0.8, rms_gradient: 0.1, wavelengths: (1.0e-6, 1.0e-8), seed: 1)",
        );
        let rows = rows(&hard, None);
        let of = |name: &str| {
            rows.iter()
                .filter(|row| row.name == name)
                .collect::<Vec<_>>()
        };
        let tabor = of("Tabor number")[0];
        assert!(
            (0.01..0.1).contains(&tabor.value.unwrap()) && tabor.sticks.is_none(),
            "{tabor:?}"
        );
        assert!(
            tabor
                .reason
                .as_ref()
                .unwrap()
                .contains("JKR theory and this program do not apply")
        );
        for name in [
            "Persson & Tosatti 2001",
            "Fuller & Tabor 1975",
            "this program",
        ] {
            for row in of(name) {
                assert!(row.sticks.is_none() && row.value.is_some(), "{row:?}");
                assert!(
                    row.reason.as_ref().unwrap().contains(", needs at least 1"),
                    "{row:?}"
                );
            }
        }
        // These two criteria are made for stiff bodies. Their conditions are met, and they decide
        // that the bodies do not stick.
        for name in ["Pastewka & Robbins 2014", "bearing area 2018"] {
            assert_eq!(of(name)[0].sticks, Some(false), "{:?}", of(name));
        }
    }

    #[test]
    fn rows_are_those_that_the_scene_calls_for() {
        let names = |rows: &[Criterion]| rows.iter().map(|row| row.name).collect::<Vec<_>>();
        let smooth = document(
            "material: (modulus: 1.0e6), form: Paraboloid(radius: 1.0e-5), adhesion: (work: 0.05)",
        );
        let found = rows(&smooth, None);
        assert_eq!(
            names(&found),
            ["Tabor number", "this program", "this program"]
        );
        assert!(
            found[1..].iter().all(|row| row.sticks == Some(true)),
            "{found:?}"
        );
        assert_eq!(rows(&document("material: (modulus: 1.0e6)"), None), []);
        let rough = document(
            "material: (modulus: 1.0e6), adhesion: (work: 0.05), \
             roughness: SelfAffine(hurst: 0.3, rms_height: 1.0e-7, modes: (1, 64), seed: 1)",
        );
        let simulation = &mut Simulation::default();
        let ensemble = Ensemble::of(rough.scene(), &[], 5, simulation, Control::default()).unwrap();
        let found = rows(&rough, Some(&ensemble));
        assert_eq!(
            names(&found)[4..],
            ["Tabor number", "this program", "this program"]
        );
        let smooth = run(&rough).unwrap().smooth_pull_off_force.unwrap();
        for (row, quantity) in found[5..].iter().zip([
            Quantity::FirstTouchPullOffForce,
            Quantity::ZeroForcePullOffForce,
        ]) {
            let mut forces: Vec<f64> = ensemble.values(quantity).into_iter().flatten().collect();
            forces.sort_by(f64::total_cmp);
            assert_eq!((forces.len(), row.value), (5, Some(forces[2] / smooth)));
            assert_eq!(
                row.sticks,
                Some(forces[2] >= Regime::VANISHING_SHARE * smooth)
            );
        }
        assert!(
            found[5]
                .words()
                .ends_with("(turned at first touch, median of 5 profiles)"),
            "{}",
            found[5].words()
        );
    }
}
