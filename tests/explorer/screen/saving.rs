//! Saving the scene, and leaving with or without saving.

use super::*;

#[test]
fn what_could_not_be_saved_is_stated_and_not_forgotten() {
    let mut driver = pressed("l s Ctrl+u");
    driver.type_text(REFUSED);
    driver.press("Enter");
    let status = driver.status();
    assert!(
        status.starts_with("! ") && driver.footer().starts_with(&format!("Save as: {REFUSED}")),
        "{status}"
    );
    assert!(driver.app.edit.is_unsaved());
    // The typed name stays, and can be corrected.
    driver.press("Home Delete");
    assert!(
        driver
            .status()
            .starts_with(&format!("Save as: {}", &REFUSED[1..])),
        "{}",
        driver.status()
    );
    driver.press("Ctrl+u");
    assert!(driver.press("Enter").is_empty() && driver.files().is_empty());
    assert!(
        driver.status().starts_with("! type the name of a file"),
        "{}",
        driver.status()
    );
    driver.press("`mine.csv` Enter");
    assert!(
        driver
            .status()
            .starts_with("! unsupported file extension .csv; use .ron"),
        "{}",
        driver.status()
    );
}

#[test]
fn a_changed_scene_asks_before_it_is_left() {
    let asked = |keys: &str| {
        let mut driver = pressed("l q");
        assert_eq!(driver.app.keys(), Context::Leave);
        assert!(!driver.app.finished);
        driver.shows("unsaved");
        assert!(driver.rows()[0].contains("changed"), "{}", driver.text());
        driver.press(keys);
        driver
    };
    for keys in ["n", "Esc"] {
        let driver = asked(keys);
        assert!(
            !driver.app.finished && driver.app.prompt.is_none(),
            "{keys}"
        );
    }
    for keys in ["q", "y", "Ctrl+c"] {
        let driver = asked(keys);
        assert!(driver.app.finished && driver.files().is_empty(), "{keys}");
    }
    let driver = asked("s Enter");
    assert!(driver.app.finished);
    assert_eq!(driver.files().len(), 1);
    // Cancelling the save prompt also cancels leaving.
    for keys in ["s Esc", "s Ctrl+u Enter Esc"] {
        assert!(!asked(keys).app.finished, "{keys}");
    }
    let mut driver = asked("n");
    fs::write(driver.folder.join("rough-line.ron"), "theirs").unwrap();
    driver.press("q s Enter");
    assert!(!driver.app.finished, "first it is asked about the file");
    driver.press("y");
    assert!(driver.app.finished);
    assert_ne!(driver.file("rough-line.ron"), "theirs");
}

#[test]
fn a_comment_that_goes_with_what_is_replaced_is_stated() {
    let text = rough()
        .text()
        .replace("loading: [", "loading: [ // as in the experiment\n");
    let document = Document::parse(&text, "mine.ron").unwrap();
    let comments = document.comments();
    let mut driver = Driver::start(document);
    driver.set("loading", "[ToForce(1.0e-5), ToSeparation]");
    assert_eq!(driver.document().comments(), comments - 1);
    driver.shows("1 comment removed");
    driver.press("u");
    assert_eq!(driver.document().text(), text);
    driver.select("roughness.hurst");
    driver.press("l");
    driver.hides("gone");
}

#[test]
fn title_and_notice_are_rows_and_the_name_gets_its_extension() {
    let mut driver = pressed("");
    driver.set("title", "My \"own\" line");
    driver.set("notice", "Look here.");
    assert!(
        driver.rows()[0].starts_with("My \"own\" line [changed]  Look here."),
        "{}",
        driver.text()
    );
    driver.press("s Ctrl+u `mine` Enter");
    let saved = Document::parse(&driver.file("mine.ron"), "mine.ron").unwrap();
    let scene = saved.scene();
    assert_eq!(
        (scene.title.as_str(), scene.notice.as_str()),
        ("My \"own\" line", "Look here.")
    );
    assert_eq!(scene, driver.document().scene());
    assert_eq!(saved.comments(), rough().comments());
    assert!(!driver.app.edit.is_unsaved() && driver.document().name() == "mine.ron");
}

#[test]
fn scenes_in_whose_place_others_were_opened_are_not_forgotten() {
    let mut driver = pressed("l o 1 Enter q");
    assert_eq!(
        driver.app.keys(),
        Context::Leave,
        "the first scene is unsaved"
    );
    driver.answers("n l q", "2 scenes have unsaved changes");
    driver.press("n u u");
    assert_eq!(driver.document().name(), "rough-line");
    assert_eq!(
        driver.app.edit.unsaved().len(),
        1,
        "it is the explored scene again"
    );
    // Each is saved before the explorer ends.
    driver.press("l o 1 Enter l q s Ctrl+u `first` Enter");
    for _ in 0..3 {
        if driver.app.keys() == Context::Leave {
            driver.press("s Enter");
        }
    }
    assert!(driver.app.finished, "{}", driver.text());
    assert_eq!(driver.files(), ["first.ron", "rough-line.ron"]);
    // A second q leaves without saving.
    let driver = pressed("l o 1 Enter q q");
    assert!(driver.app.finished && driver.files().is_empty());
}

#[test]
fn what_changes_only_the_view_or_the_writing_of_a_number_is_no_change() {
    let mut driver = pressed("v N a n + - A A m t X m z z T d d");
    driver.select("roughness.hurst");
    driver.press("l h");
    assert!(
        driver.app.edit.unsaved().is_empty(),
        "{}",
        driver.document().text()
    );
    driver.press("q");
    assert!(driver.app.finished);
}
