//! A measured force curve beside the scene.

use super::*;
use asperity::contact::Move;
use asperity::experiment::{CurveOptions, Drift, FitResult};
use asperity::explorer::command_line::curve_arguments;
use asperity::explorer::measured::Fitting;
use asperity::explorer::measured::Measured;
use std::fmt::Write;
use std::sync::Arc;
use tempfile::TempDir;

/// A sphere that is pressed by 50 µN and pulled off.
fn sphere(work: &str) -> Document {
    let fields = [
        ("numerics.points", "256"),
        ("numerics.samples", "200"),
        ("adhesion.work", work),
    ];
    open("jkr-sphere")
        .unwrap()
        .set_all(&fields.map(|(path, value)| (path.into(), value.into())))
        .unwrap()
}

/// Writes the curve of a sphere of 50 mJ/m² with a ripple of 0.3 µN, 400 nm from its first touch.
fn write_curve(path: &Path) {
    let scene = sphere("0.05").scene().clone();
    let outcome = Simulation::default()
        .run(&scene, &|| false, &mut |_, _, _| Ok(()))
        .unwrap();
    let free = |from: f64| (0..100).map(move |index| (from - 1e-8 * f64::from(index), 0.0));
    let stages = &outcome.history.stages;
    let touching = |stage: usize| stages[stage].curve.iter().filter(|point| point.springs > 0);
    let points = |stage: usize| touching(stage).map(|point| (point.indentation, point.force));
    let last = stages[1].curve.last().unwrap().indentation;
    let approach = free(-1e-8)
        .collect::<Vec<_>>()
        .into_iter()
        .rev()
        .chain(points(0));
    let mut text = "displacement [nm],force [uN]\n".to_owned();
    for (index, (at, force)) in approach
        .chain(points(1))
        .chain(free(last - 1e-8))
        .enumerate()
    {
        let ripple = 0.3 * (1.7 * index as f64).sin();
        writeln!(text, "{},{}", 1e9 * at + 400.0, 1e6 * force + ripple).unwrap();
    }
    fs::write(path, text).unwrap();
}

fn options() -> CurveOptions {
    CurveOptions {
        drift: Drift::Remove,
        noise: Some(2e-7),
        ..CurveOptions::default()
    }
}

/// The explorer on a sphere of another work of adhesion, with these studies.
fn explorer(measured: Option<Measured>, performs: fn(&Study) -> bool) -> Driver {
    let opening = Opening {
        measured,
        ..Opening::from(sphere("0.03"))
    };
    let mut driver = Driver::open_with(opening, Simulation::run, performs);
    driver.perform(vec![Task::Ask]);
    driver
}

/// Studies of the residual of the curve, and fits to it.
fn is_of_curve(study: &Study) -> bool {
    study.is::<Arc<FitResult>>() || study.is::<Fitting>()
}

fn is_none(_: &Study) -> bool {
    false
}

/// The explorer with the curve and these studies, and the folder of its file.
fn shown(performs: fn(&Study) -> bool) -> (TempDir, Driver) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    write_curve(&path);
    let measured = Measured {
        name: "curve.csv".to_owned(),
        ..Measured::read(&path, options()).unwrap()
    };
    (folder, explorer(Some(measured), performs))
}

/// Number after `misfit` in the status line.
fn misfit(driver: &Driver) -> f64 {
    let text = driver.text();
    let after = text
        .split("misfit ")
        .nth(1)
        .unwrap_or_else(|| panic!("{text}"));
    let number =
        after.split(|character: char| !(character.is_ascii_digit() || ".e".contains(character)));
    number
        .into_iter()
        .next()
        .and_then(|number| number.parse().ok())
        .unwrap_or_else(|| panic!("{text}"))
}

#[test]
fn the_misfit_of_a_measured_curve_follows_the_scene_and_a_fit_can_be_undone() {
    let (_folder, mut driver) = shown(is_of_curve);
    assert!(
        driver.pane(Pane::Force).concat().contains("measured"),
        "{}",
        driver.text()
    );
    driver.shows("the loading of the measured curve");
    driver.press("Space");
    let far = misfit(&driver);
    driver.set("adhesion.work", "0.049 J/m²");
    let near = misfit(&driver);
    assert!(far > 2.0 * near && near < 3.0, "{far} {near}");
    let measured = driver.app.edit.measured.clone().unwrap();
    assert!((measured.offset - 4e-7).abs() < 2e-8, "{}", measured.offset);
    // The measured points lie on the curve of the scene.
    let points = measured.points(f64::INFINITY).into_iter();
    let least = points
        .min_by(|one, other| one.force.total_cmp(&other.force))
        .unwrap()
        .indentation;
    let pull_off = driver.outcome().figures.pull_off_indentation.unwrap();
    assert!((least - pull_off).abs() < 5e-8, "{least} {pull_off}");

    driver.press("Ctrl+f Ctrl+u `work,ofset` Enter");
    assert!(
        driver
            .refusal()
            .is_some_and(|why| why.contains("did you mean offset?")),
        "{:?}",
        driver.refusal()
    );
    driver.press("Ctrl+u `work, offset` Enter");
    let work = driver.document().scene().adhesion.unwrap().work().unwrap();
    assert!((work - 0.05).abs() < 5e-4, "{work}");
    driver.shows_all(["fit: γ ", "u undoes"]);
    steps(&mut driver, "Right");
    assert!(
        is_up_to_date(&driver.app) && misfit(&driver) < near,
        "{}",
        driver.text()
    );

    for (name, expected) in [
        ("fit.csv", "displacement,force,model,residual"),
        ("fit.svg", "residual over noise"),
    ] {
        driver.press("E Ctrl+u");
        driver.type_text(name);
        driver.press("Enter");
        assert!(driver.file(name).contains(expected), "{name}");
    }
    assert!(driver.file("fit.csv").contains(
        "# command: asperity fit curve.csv --drift=remove --noise=2e-7N --free=work,offset jkr-sphere"
    ));
    driver.press("u");
    assert_eq!(
        driver.document().scene().adhesion.unwrap().work(),
        Some(0.049)
    );
}

#[test]
fn a_curve_is_opened_by_its_path_and_closed_by_an_undo() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    write_curve(&path);
    let mut driver = explorer(None, is_none);
    let before = driver.document().clone();
    driver.press("o");
    driver.type_text(path.to_str().unwrap());
    driver.press("Enter");
    driver.shows_all([
        "the scene has the loading of the measured curve; u closes it",
        "points used in 2 segments",
    ]);
    let loading = driver.document().scene().loading.clone();
    assert!(matches!(loading[0], Move::ToDisplacement(_)), "{loading:?}");
    assert_eq!(
        driver.app.edit.parameter().map(|row| &*row.path),
        Some("measured")
    );
    driver.press("y");
    let copied = driver.copied.last().unwrap();
    assert!(
        copied.starts_with("asperity --measured=") && copied.contains("curve.csv jkr-sphere"),
        "{copied}"
    );
    driver.press("u");
    assert_eq!(
        (driver.app.edit.measured.is_none(), driver.document().text()),
        (true, before.text())
    );
    driver.states("without the measured curve");
    driver.press("U");
    driver.states("measured curve ");
    assert_eq!(driver.document().scene().loading, loading);
}

/// A file with several curves names them, and each of them is opened by its number.
#[test]
fn a_curve_of_a_map_is_opened_by_its_number() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("curve.csv");
    write_curve(&path);
    let curve = fs::read_to_string(&path).unwrap();
    let (names, points) = curve.split_once('\n').unwrap();
    // The first curve of the map has fewer points than the second.
    let fewer: String = points.split_inclusive('\n').skip(10).collect();
    let map = format!("{names}\n# x: 1 um, y: 2 um\n{fewer}# x: 3 um, y: 2 um\n{points}");
    // The names may also follow each place.
    let other =
        format!("# x: 1 um\n# y: 2 um\n{names}\n{points}\n# x: 3 um\n# y: 2 um\n{names}\n{points}");
    let other_path = folder.path().join("other.csv");
    fs::write(&other_path, other).unwrap();
    let mut driver = explorer(None, is_none);
    driver.press("o");
    driver.type_text(&format!("{}#2", other_path.display()));
    driver.press("Enter");
    driver.shows("the scene has the loading of the measured curve; u closes it");
    let map_path = folder.path().join("map.csv");
    fs::write(&map_path, map).unwrap();
    let mut driver = explorer(None, is_none);
    driver.press("o");
    driver.type_text(map_path.to_str().unwrap());
    driver.press("Enter");
    let refusal = driver.refusal().unwrap_or_default();
    assert!(
        refusal.contains("2 curves in one file; allowed: one of them")
            && refusal.contains("map.csv#1 to"),
        "{refusal}"
    );
    driver.type_text("#2");
    driver.press("Enter");
    driver.shows("the scene has the loading of the measured curve; u closes it");
    let whole = Measured::read(&path, CurveOptions::default()).unwrap();
    let opened = driver.app.edit.measured.as_ref().unwrap();
    assert!(opened.name.ends_with("map.csv#2"));
    assert_eq!(opened.curve.points, whole.curve.points);
}

/// Row of an option, keys, what the row then shows, and the option as an argument.
#[test]
fn options_of_reading_are_rows_that_an_undo_restores() {
    let (_folder, mut driver) = shown(is_none);
    for row in [
        "measured.zero|Enter Ctrl+u `20 nN` Enter|20 nN| --zero=2e-8N",
        "measured.zero|5 Enter|5 nN| --zero=5e-9N",
        "measured.noise|Right|224 nN| --noise=2.24e-7N",
        "measured.noise|Shift+Left|100 nN| --noise=1e-7N",
        "measured.noise|Enter Ctrl+u Enter|= |",
        "measured.drift|Right|keep|",
        "measured.drift|Enter Ctrl+u `3 nN` Enter|3 nN| --drift=3e-9N",
        "measured.tilt|Right|remove| --tilt=remove",
        "measured.segments|Right|1,2| --segments=1,2",
        "measured.segments|2 Enter|2| --segments=2",
        "measured.columns|Enter Ctrl+u `displacement,force` Enter|displacement,force| --columns=displacement,force",
        "measured.units|Enter Ctrl+u `nm,mN` Enter|nm,mN| --units=nm,mN",
        "measured.negate|Right|none| --negate=none",
        "measured.free_points|6 0 Enter|60| --free-points=60",
    ] {
        let [path, keys, value, argument] = row.split('|').collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        driver.select(path);
        driver.press(keys);
        let measured = driver.app.edit.measured.clone().unwrap();
        let shown = &driver.app.edit.parameter().unwrap().shown;
        let is_as = if value.len() > 2 {
            shown == value
        } else {
            shown.starts_with(value)
        };
        assert!(
            is_as && driver.app.prompt.is_none(),
            "{row}: {shown} {:?}",
            driver.refusal()
        );
        let read = curve_arguments(&measured.options);
        assert!(read.contains(argument), "{row}: {read}");
        let others = measured.options != options();
        assert!(others && is_up_to_date(&driver.app), "{row}");
        driver.press("u");
        driver.states(" → ");
        let restored = driver.app.edit.measured.clone().unwrap();
        assert_eq!(
            (
                restored.options,
                driver.app.edit.parameter().unwrap().path.as_str()
            ),
            (options(), path)
        );
    }
}

/// Row of an option, keys, and the reason of the reader; the curve stays.
#[test]
fn an_option_with_which_the_curve_is_not_read_is_refused_with_the_reason() {
    let (_folder, mut driver) = shown(is_none);
    for row in [
        "measured.units|Enter Ctrl+u `nm,kg` Enter|is not a unit of the force",
        "measured.columns|Enter Ctrl+u `a,b` Enter|none is \"a\"",
        "measured.segments|7 Enter|the curve has no such segment",
        "measured.segments|0 Enter|numbers from 1 on",
        "measured.noise|- 3 Enter|a standard deviation above 0",
        "measured.negate|Enter `displacement` Enter|the body moves away",
        "measured.zero|Right|by the curve; Enter types a value",
        "measured|Right|a group: its fields are in the rows below",
    ] {
        let [path, keys, why] = row.split('|').collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        driver.app.view.pane = Pane::Parameters;
        driver.select(path);
        let before = driver.app.edit.measured.clone();
        driver.press(keys);
        let text = driver
            .text()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        let said = driver
            .refusal()
            .map(str::to_owned)
            .or_else(|| match &driver.app.message {
                Some(Message::Refused(why)) => Some(why.clone()),
                _ => None,
            });
        assert!(
            said.as_ref().is_some_and(|said| said.contains(why)),
            "{row}: {said:?}\n{text}"
        );
        driver.press("Esc");
        assert_eq!(driver.app.edit.measured, before, "{row}");
    }
}

/// The residuals are under the force curve where it is high enough.
#[test]
fn residuals_are_a_strip_in_units_of_the_noise() {
    let (_folder, mut driver) = shown(is_of_curve);
    for (size, keys, is_there) in [
        ((120, 36), "", true),
        ((80, 24), "", true),
        ((40, 12), "", false),
        ((80, 24), "z", true),
    ] {
        driver.press(keys);
        driver.resize(size);
        let pane = driver.pane(Pane::Force);
        let has = |words: &str| pane.iter().any(|row| row.contains(words));
        assert_eq!(
            has("residual over noise"),
            is_there,
            "{size:?} {keys}\n{}",
            driver.text()
        );
        // The residuals of another work of adhesion exceed 50 times the noise.
        assert_eq!(
            has("-200 ┤"),
            is_there,
            "{size:?} {keys}\n{}",
            driver.text()
        );
    }
    // Contact lengths have none.
    driver.sees("v", "Contact length");
    driver.hides("residual over noise");
}

/// Files in another place than theirs, and the line that names them.
#[test]
fn broken_curves_are_named_where_a_path_is_opened() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("flat.csv", "displacement [nm],force [nN]\n1,2\n");
    write("empty.csv", "displacement [nm],force [nN]\n");
    write("words.txt", "neither a scene nor numbers\n");
    for (name, said) in [
        (
            "flat.csv",
            "1 points with displacement and force; allowed: at least",
        ),
        ("empty.csv", "empty.csv:1:1: "),
        ("words.txt", "words.txt:1:1: "),
    ] {
        let mut driver = explorer(None, is_none);
        driver.press("o");
        driver.type_text(folder.path().join(name).to_str().unwrap());
        driver.press("Enter");
        let refusal = driver.refusal().unwrap_or_default();
        assert!(refusal.contains(said), "{name}: {refusal}");
        assert!(driver.app.edit.measured.is_none());
    }
}

#[test]
fn a_study_closes_a_curve_that_was_measured_on_another_contact() {
    let (folder, mut driver) = study::opened();
    let curve = folder.path().join("curve.csv");
    write_curve(&curve);
    driver.press(&format!("o `{}` Enter", curve.display()));
    assert!(driver.app.edit.measured.is_some(), "{}", driver.text());
    driver.press(&format!(
        "o `{}` Enter",
        folder.path().join("small").display()
    ));
    assert!(driver.app.edit.measured.is_none());
    driver.states("curve.csv is closed; u shows it again");
    driver.press("u");
    assert!(driver.app.edit.measured.is_some());
}
