//! The pane of spectra.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{changed, rough};
use super::pressed;
use asperity::explorer::adhesion_spread::PROFILES;
use asperity::explorer::app::{Message, Pane};
use asperity::explorer::runtime::Studies;
use asperity::explorer::study::Accuracy;
use asperity::explorer::update::{Effect, study_tasks};
use asperity::scene::Document;
use std::path::Path;

#[test]
fn q_shows_the_spectrum_in_place_of_the_line() {
    within(60, || {
        let mut driver = pressed("Q");
        assert_eq!((driver.app.view.pane, driver.app.view.large), (Pane::Spectrum, Some(Pane::Spectrum)));
        driver.press("Q");
        assert_eq!((driver.app.view.pane, driver.app.view.large), (Pane::Force, None));
        // One pane at a time in that place.
        for (keys, pane) in
            [("Q A", Pane::Accuracy), ("Q", Pane::Spectrum), ("m", Pane::Chart), ("Q", Pane::Spectrum)]
        {
            driver.press(keys);
            assert_eq!(driver.app.view.large, Some(pane), "{keys}");
        }
        // Another scene has another spectrum.
        let before = driver.app.present().unwrap().spectra.clone().unwrap();
        driver.press("R");
        let after = driver.app.present().unwrap().spectra.clone().unwrap();
        assert_eq!(before.spectra.line, after.spectra.line);
        assert!(!after.spectra.heights.is_empty() && before.spectra.measured.is_empty());
    });
}

/// A scene of a measured profile of 512 µm, with its file.
fn measured(file: &Path) -> Document {
    let height = |i: u32| (1..60).map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k)).sum::<f64>();
    let rows: String = (0..512).map(|i| format!("{i} {}\n", 30.0 * height(i))).collect();
    std::fs::write(file, format!("x [um] z [nm]\n{rows}")).unwrap();
    let roughness = format!("Measured(file: {:?}, as_line: false)", file.to_str().unwrap());
    let scene = changed(&rough(), &[("roughness", &roughness), ("adhesion", "(work: 0.05)")]);
    Document::parse(scene.text(), "measured").unwrap()
}

#[test]
fn the_spread_over_lines_is_beside_that_of_the_fit() {
    within(120, || {
        let folder = tempfile::tempdir().unwrap();
        let document = measured(&folder.path().join("stylus.txt"));
        let document = document.set("numerics.points", "1024").unwrap();
        let mut driver = Driver::open(document);
        driver.studies = Studies::Inline(Box::new(Accuracy));
        driver.perform(vec![Effect::Ask]);
        // Not before the pane is shown.
        assert_eq!(driver.app.studies.adhesion_spread, None);
        driver.press("Q");
        assert_eq!(driver.app.studies.adhesion_spread.as_ref().unwrap().found.profiles.len(), PROFILES);
        assert!(study_tasks(&driver.app).is_empty());
        driver.press("z");
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            let screen = driver.text();
            assert!(
                screen.contains("F_a of 16 profiles: median ") && screen.contains(", fit ± "),
                "{screen}"
            );
        }
        driver.studies = Studies::None;
        driver.press("R");
        assert_eq!(driver.app.studies.adhesion_spread, None);
        assert!(driver.text().contains("0 of 16 profiles"), "{}", driver.text());
    });
}

#[test]
fn the_profile_itself_is_kept_beside_its_equivalent_line() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("stylus.txt");
        // The whole scan: the length of the equivalent line follows from the number of its points.
        let document = measured(&file)
            .set_all(&[("length".to_owned(), "512 µm".to_owned()), ("form".to_owned(), "None".to_owned())]);
        let mut driver = Driver::start(document.unwrap());
        let equivalent = driver.app.edit.document.clone();
        driver.press("|");
        let ghost = driver.app.ghosts.last().unwrap();
        assert!(ghost.document.scene().measured_as_line());
        let profile = ghost.computed.outcome.figures.adhesion_force;
        assert!(profile.is_some() && ghost.computed.outcome.governing.kappa.is_some());
        assert!(driver.text().contains("profile as line true"), "{}", driver.text());
        // A small pane has room for the letter only.
        driver.resize((80, 24));
        driver.press("z");
        assert!(driver.text().contains("profile as line true"), "{}", driver.text());
        driver.press("z");
        driver.resize((120, 40));
        assert_eq!(driver.app.edit.document.scene(), equivalent.scene());
        driver.press("|");
        assert_eq!(driver.app.ghosts.len(), 1);
        // And the other way round.
        driver.press("x");
        assert_eq!(driver.app.solved.as_ref().unwrap().outcome.figures.adhesion_force, profile);
        driver.press("C |");
        assert!(!driver.app.ghosts[0].document.scene().measured_as_line());
        // A missing file, and roughness that is not measured.
        let mut driver = Driver::start(equivalent);
        std::fs::remove_file(&file).unwrap();
        driver.press("|");
        let message = |driver: &Driver| match &driver.app.message {
            Some(Message::Error(text)) => text.clone(),
            other => panic!("{other:?}"),
        };
        assert!(message(&driver).contains("stylus.txt") && driver.app.ghosts.is_empty());
        let mut other = Driver::start(rough());
        other.press("|");
        assert!(message(&other).contains("not measured"));
    });
}

#[test]
fn a_measured_surface_has_its_spectrum_fit_and_errors() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("stylus.txt");
        let mut driver = Driver::start(measured(&file));
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
        // The message names a missing file.
        std::fs::remove_file(&file).unwrap();
        driver.press("R");
        assert!(driver.text().contains("stylus.txt"), "{}", driver.text());
    });
}

#[test]
fn a_measured_surface_is_the_roughness_by_its_path_alone() {
    within(120, || {
        for size in [(120, 40), (80, 24), (40, 12)] {
            let folder = tempfile::tempdir().unwrap();
            let file = folder.path().join("stylus.txt");
            measured(&file);
            let text = changed(&rough(), &[("adhesion", "(work: 0.05)"), ("numerics.points", "1024")]);
            let name = folder.path().join("scene.ron");
            let document = Document::parse(text.text(), name.to_str().unwrap()).unwrap();
            let mut driver = Driver::start(document);
            driver.resize(size);
            driver.select("roughness");
            driver.press("Enter");
            // The typed text replaces the value.
            driver.type_text(&format!("{}/sty", folder.path().display()));
            driver.press("Tab");
            let typed = driver.app.prompt.as_ref().map(|prompt| prompt.line.text());
            assert_eq!(typed, file.to_str());
            driver.press("Enter");
            let scene = driver.app.edit.document.scene();
            let named = vec![file.to_str().unwrap()];
            assert_eq!((scene.measured_files(), scene.measured_as_line()), (named, false));
            let computed = driver.app.solved.as_ref().unwrap();
            assert!(computed.outcome.governing.kappa.is_some_and(|kappa| kappa > 0.0));
            assert!(computed.outcome.figures.adhesion_force.is_some_and(|force| force > 0.0));
            let screen = driver.text();
            assert!(screen.contains("F_a"), "{screen}");
            driver.studies = Studies::Inline(Box::new(Accuracy));
            driver.press("Q");
            assert_eq!(driver.app.studies.adhesion_spread.as_ref().unwrap().found.profiles.len(), PROFILES);
            driver.press("z");
            let screen = driver.text();
            // The smallest screen has room for the spectra only.
            assert!(size.0 == 40 || screen.contains("F_a of 16 profiles: median "), "{screen}");
            assert!(screen.contains("Spectr"), "{screen}");
        }
    });
}

#[test]
fn the_path_of_a_measured_surface_is_completed_beside_the_scene() {
    within(60, || {
        let folder = tempfile::tempdir().unwrap();
        for name in ["stylus-1.txt", "stylus-2.txt", "other.txt"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let scene = rough();
        let name = folder.path().join("scene.ron");
        let mut driver = Driver::start(Document::parse(scene.text(), name.to_str().unwrap()).unwrap());
        let typed = |driver: &Driver| driver.app.prompt.as_ref().expect("a prompt").line.text().to_owned();
        let paths = |driver: &Driver| driver.app.prompt.as_ref().expect("a prompt").paths.len();
        driver.select("roughness");
        driver.press("Enter Ctrl+u");
        driver.type_text("Measured(file: \"st");
        driver.press("Tab");
        assert_eq!(typed(&driver), "Measured(file: \"stylus-");
        assert_eq!(paths(&driver), 2);
        driver.type_text("2");
        driver.press("Tab");
        assert_eq!(typed(&driver), "Measured(file: \"stylus-2.txt");
        // From the root as well, and not outside of quotes.
        driver.press("Ctrl+u");
        driver.type_text(&format!("Measured(file: \"{}/ot", folder.path().display()));
        driver.press("Tab");
        assert_eq!(typed(&driver), format!("Measured(file: \"{}/other.txt", folder.path().display()));
        for (field, text) in [("roughness", "SelfAffine(st"), ("material.youngs_modulus", "\"st")] {
            driver.press("Esc");
            driver.select(field);
            driver.press("Enter Ctrl+u");
            driver.type_text(text);
            driver.press("Tab");
            assert_eq!((typed(&driver).as_str(), paths(&driver)), (text, 0), "{field}");
        }
    });
}
