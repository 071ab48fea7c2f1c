//! The pane of spectra.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{changed, rough};
use super::pressed;
use asperity::explorer::model::Pane;
use asperity::scene::Document;

#[test]
fn q_shows_the_spectrum_in_place_of_the_line() {
    within(60, || {
        let mut driver = pressed("Q");
        assert_eq!(
            (driver.model.pane, driver.model.in_place_of_the_line()),
            (Pane::Spectrum, Some(Pane::Spectrum))
        );
        driver.press("Q");
        assert_eq!((driver.model.pane, driver.model.in_place_of_the_line()), (Pane::Force, None));
        // One thing at a time is in that place.
        for (keys, pane) in
            [("Q A", Pane::Accuracy), ("Q", Pane::Spectrum), ("m", Pane::Chart), ("Q", Pane::Spectrum)]
        {
            driver.press(keys);
            assert_eq!(driver.model.in_place_of_the_line(), Some(pane), "{keys}");
        }
        // Another scene has another spectrum.
        let before = driver.model.present().unwrap().spectra.clone().unwrap();
        driver.press("R");
        let after = driver.model.present().unwrap().spectra.clone().unwrap();
        assert_eq!(before.spectra.line, after.spectra.line);
        assert!(!after.spectra.heights.is_empty() && before.spectra.measured.is_empty());
    });
}

#[test]
fn a_measured_surface_has_its_spectrum_fit_and_errors() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        let height = |i: u32| (1..60).map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k)).sum::<f64>();
        let rows: String = (0..512).map(|i| format!("{i} {}\n", 30.0 * height(i))).collect();
        let file = folder.path().join("stylus.txt");
        std::fs::write(&file, format!("x [um] z [nm]\n{rows}")).unwrap();
        let roughness = format!("Measured(file: {:?}, as_line: false)", file.to_str().unwrap());
        let scene = changed(&rough(), &[("roughness", &roughness), ("adhesion", "(work: 0.05)")]);
        let mut driver = Driver::start(Document::parse(scene.text(), "measured").unwrap());
        driver.press("Q z");
        for (size, words) in [
            (
                (120, 40),
                &["measured, 1D PSD along x", "fit", "heights of the line", "κ = ", "e_el/γ = ", "⟨∇z⟩ ± "][..],
            ),
            ((80, 24), &["measured, 1D PSD", "κ = ", "e_el/γ = "]),
            ((40, 12), &["10"]),
        ] {
            driver.resize(size);
            let screen = driver.text();
            for word in words {
                assert!(screen.contains(word), "{word}: {screen}");
            }
        }
        driver.resize((120, 40));
        // A file that is gone is named.
        std::fs::remove_file(&file).unwrap();
        driver.press("R");
        assert!(driver.text().contains("stylus.txt"), "{}", driver.text());
    });
}
