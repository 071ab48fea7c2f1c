//! The pane of spectra.

use super::*;
use asperity::study::Ensemble;
use asperity::study::trust::MeasuredAdhesion;
use asperity_report::SceneSpectra;

/// A scene of a measured profile of 512 µm, with its file.
fn measured(file: &Path) -> Document {
    let height = |i: u32| {
        (1..60)
            .map(|k| f64::from(i * k * k + 7 * k).sin() / f64::from(k))
            .sum::<f64>()
    };
    let rows: String = (0..512)
        .map(|i| format!("{i} {}\n", 30.0 * height(i)))
        .collect();
    fs::write(file, format!("x [um] z [nm]\n{rows}")).unwrap();
    let roughness = format!(
        "Measured(file: {:?}, as_line: false)",
        file.to_str().unwrap()
    );
    let scene = changed(
        &rough(),
        &[("roughness", &roughness), ("adhesion", "(work: 0.05)")],
    );
    Document::parse(scene.text(), "measured").unwrap()
}

#[test]
fn a_measured_surface_has_its_spectrum_fit_and_errors() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("stylus.txt");
    let mut driver = Driver::start(measured(&file));
    driver.press("Q z");
    driver.shows_all([
        "measured, 1D PSD along x",
        "fit",
        "heights of the profile",
        "κ = ",
        "e_el/γ = ",
        "⟨∇z⟩ ± ",
    ]);
    driver.resize((80, 24));
    driver.shows_all(["measured, 1D PSD", "κ = ", "e_el/γ = "]);
    driver.resize((120, 40));
    // The message names a missing file.
    fs::remove_file(&file).unwrap();
    driver.sees("R", "stylus.txt");
}

#[test]
fn a_measured_surface_is_the_roughness_by_its_path_alone() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("stylus.txt");
    measured(&file);
    let name = folder.path().join("scene.ron");
    let document = changed(&rough(), &[("adhesion", "(work: 0.05)")]);
    let document = Document::parse(document.text(), name.to_str().unwrap()).unwrap();
    let performs = |study: &Study| study.is::<SceneSpectra>() || study.is::<MeasuredAdhesion>();
    let mut driver = Driver::open_with(document, Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    // The typed text replaces the value.
    driver.select("roughness");
    driver.press(&format!("Enter `{}/sty` Tab", folder.path().display()));
    assert_eq!(
        driver.app.prompt.as_ref().map(|prompt| prompt.line.text()),
        file.to_str()
    );
    driver.press("Enter");
    let scene = driver.document().scene();
    assert_eq!(
        (scene.measured_files(), scene.measured_as_line()),
        (vec![file.to_str().unwrap()], false)
    );
    assert!(
        driver
            .outcome()
            .governing
            .kappa
            .is_some_and(|kappa| kappa > 0.0)
    );
    assert!(
        driver
            .outcome()
            .figures
            .pull_off_force
            .is_some_and(|force| force > 0.0)
    );
    driver.press("Q");
    assert_eq!(
        driver
            .app
            .studies
            .value::<MeasuredAdhesion>()
            .map(|found| found.profiles.len()),
        Some(16)
    );
    driver.sees("z", "F_a of 16 profiles: median ");
}

#[test]
fn the_path_of_a_measured_surface_is_completed_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["stylus-1.txt", "stylus-2.txt", "other.txt"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let scene = rough();
    let name = folder.path().join("scene.ron");
    let mut driver = Driver::start(Document::parse(scene.text(), name.to_str().unwrap()).unwrap());
    let typed = |driver: &Driver| {
        driver
            .app
            .prompt
            .as_ref()
            .expect("a prompt")
            .line
            .text()
            .to_owned()
    };
    let paths = |driver: &Driver| driver.app.prompt.as_ref().expect("a prompt").paths.len();
    driver.select("roughness");
    driver.press("Enter Ctrl+u `Measured(file: \"st` Tab");
    assert_eq!(typed(&driver), "Measured(file: \"stylus-");
    assert_eq!(paths(&driver), 2);
    driver.press("`2` Tab");
    assert_eq!(typed(&driver), "Measured(file: \"stylus-2.txt");
    // From the root as well, and not outside of quotes.
    driver.press("Ctrl+u");
    driver.type_text(&format!("Measured(file: \"{}/ot", folder.path().display()));
    driver.press("Tab");
    assert_eq!(
        typed(&driver),
        format!("Measured(file: \"{}/other.txt", folder.path().display())
    );
    for (field, text) in [
        ("roughness", "SelfAffine(st"),
        ("material.youngs_modulus", "\"st"),
    ] {
        driver.press("Esc");
        driver.select(field);
        driver.press("Enter Ctrl+u");
        driver.type_text(text);
        driver.press("Tab");
        assert_eq!(
            (typed(&driver).as_str(), paths(&driver)),
            (text, 0),
            "{field}"
        );
    }
}

/// The error by the uncertainty of the measured spectrum is computed whatever pane is shown. The
/// card names it as the largest error, or says that it is not computed.
#[test]
fn the_results_have_the_error_of_a_measured_surface_without_its_pane() {
    let folder = tempfile::tempdir().unwrap();
    let document = measured(&folder.path().join("stylus.txt"));
    let mut without = Driver::open_with(document.clone(), Simulation::run, Study::is::<Ensemble>);
    without.perform(vec![Task::Ask]);
    without.resize((160, 45));
    without.shows("surface not known");
    let performs = |study: &Study| study.is::<Ensemble>() || study.is::<MeasuredAdhesion>();
    let mut driver = Driver::open_with(document, Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    driver.hides("surface not known");
    driver.shows("error       surface ± ");
    let found = driver.app.studies.value::<MeasuredAdhesion>().unwrap();
    assert!(found.fit_deviation().is_some() && found.profiles.len() == 16);
    driver.press("A z");
    driver.shows_all([
        "by the uncertainty of the measured spectrum",
        "surface: more or larger scans reduce it",
    ]);
}
