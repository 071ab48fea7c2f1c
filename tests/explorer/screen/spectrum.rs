//! The pane of spectra.

use super::common::driver::Driver;
use super::common::scenes::{changed, rough};
use super::pressed;
use asperity::explorer::action::Task;
use asperity::explorer::pane::Pane;
use asperity::explorer::studies::Study;
use asperity::export::scene_spectra::SceneSpectra;
use asperity::scene::Document;
use asperity::scene::Simulation;
use asperity::study::MeasuredAdhesion;
use std::path::Path;

#[test]
fn q_shows_the_spectrum_in_place_of_the_line() {
    let mut driver = pressed("Q");
    assert_eq!((driver.app.view.pane, driver.app.view.large), (Pane::Spectrum, Some(Pane::Spectrum)));
    driver.press("Q");
    assert_eq!((driver.app.view.pane, driver.app.view.large), (Pane::Force, None));
    // One pane at a time in that place.
    for (keys, pane) in
        [("Q A", Pane::Accuracy), ("Q", Pane::Spectrum), ("m", Pane::Map), ("Q", Pane::Spectrum)]
    {
        driver.press(keys);
        assert_eq!(driver.app.view.large, Some(pane), "{keys}");
    }
    // Another scene has another spectrum.
    let spectra = |driver: &Driver| driver.app.studies.value::<SceneSpectra>().cloned().unwrap();
    let before = spectra(&driver);
    driver.press("R");
    let after = spectra(&driver);
    assert_eq!(before.spectra.line, after.spectra.line);
    assert!(!after.spectra.heights.is_empty());
}

/// Number of random profiles computed so far.
fn profiles(driver: &Driver) -> Option<usize> {
    driver.app.studies.value::<MeasuredAdhesion>().map(|found| found.profiles.len())
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
fn a_measured_surface_has_its_spectrum_fit_and_errors() {
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
}

#[test]
fn a_measured_surface_is_the_roughness_by_its_path_alone() {
    for size in [(120, 40), (80, 24), (40, 12)] {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("stylus.txt");
        measured(&file);
        let text = changed(&rough(), &[("adhesion", "(work: 0.05)"), ("numerics.points", "1024")]);
        let name = folder.path().join("scene.ron");
        let document = Document::parse(text.text(), name.to_str().unwrap()).unwrap();
        let performs = |study: &Study| study.is::<SceneSpectra>() || study.is::<MeasuredAdhesion>();
        let mut driver = Driver::open_with(document, Simulation::run, performs);
        driver.perform(vec![Task::Ask]);
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
        driver.press("Q");
        assert_eq!(profiles(&driver), Some(16));
        driver.press("z");
        let screen = driver.text();
        // The smallest screen has room for the spectra only.
        assert!(size.0 == 40 || screen.contains("F_a of 16 profiles: median "), "{screen}");
        assert!(screen.contains("Spectr"), "{screen}");
    }
}

#[test]
fn the_path_of_a_measured_surface_is_completed_beside_the_scene() {
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
}
