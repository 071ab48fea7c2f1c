//! Parts of pages that the program generates: compared, or written anew with `UPDATE_DOCS=1`.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// One test at a time writes a page.
static PAGES: Mutex<()> = Mutex::new(());

/// Right to write pages.
pub fn alone() -> MutexGuard<'static, ()> {
    PAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// True if the pages are to be written anew.
pub fn updating() -> bool {
    std::env::var_os("UPDATE_DOCS").is_some()
}

/// Folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A page by its name from the root.
pub fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// All pages of a folder.
pub fn pages_in(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap();
    let names =
        entries.map(|entry| format!("{folder}/{}", entry.unwrap().file_name().to_string_lossy()));
    names.filter(|name| name.ends_with(".md")).collect()
}

/// Compares a file with its expected text, or writes it.
pub fn compare(file: &str, expected: &str) {
    if updating() {
        std::fs::write(root().join(file), expected).unwrap();
    } else {
        assert!(
            read(file) == expected,
            "{file} is not the program's; UPDATE_DOCS=1 writes it anew"
        );
    }
}

/// Compares the part of this name on a page with the expected text, or writes it there.
pub fn check(page: &str, name: &str, expected: &str) {
    let _alone = alone();
    let text = read(page);
    let (start, end) = (
        format!("<!-- {name} -->\n"),
        format!("<!-- end of {name} -->"),
    );
    let (before, rest) = text
        .split_once(&start)
        .unwrap_or_else(|| panic!("{page} has no {start}"));
    let (found, after) = rest
        .split_once(&end)
        .unwrap_or_else(|| panic!("{page} has no {end}"));
    if updating() {
        std::fs::write(
            root().join(page),
            format!("{before}{start}{expected}{end}{after}"),
        )
        .unwrap();
    } else {
        assert_eq!(
            found, expected,
            "the part {name} of {page} is not the program's"
        );
    }
}

/// Asserts that a page has this sentence, however its lines are broken.
pub fn assert_says(page: &str, sentence: &str) {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words(&read(page)).contains(&words(sentence)),
        "{page} lacks: {sentence}"
    );
}
