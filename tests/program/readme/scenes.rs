//! The page of the scene file: its fields and scenes match the program.

use asperity::scene::{FIELDS, LEG_FORCE, LEG_INDENTATION, Range, presets};
use std::path::Path;
use std::sync::Mutex;

/// One test at a time writes a page.
static PAGES: Mutex<()> = Mutex::new(());

/// True if the pages are to be written anew.
pub fn updating() -> bool {
    std::env::var_os("UPDATE_README").is_some()
}

/// Folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A page by its name from the root.
pub fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// Compares the part of this name on a page with the expected text, or writes it there.
pub fn check(page: &str, name: &str, expected: &str) {
    let _alone = PAGES.lock();
    let text = read(page);
    let (start, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = text.split_once(&start).unwrap_or_else(|| panic!("{page} has no {start}"));
    let (found, after) = rest.split_once(&end).unwrap_or_else(|| panic!("{page} has no {end}"));
    if updating() {
        std::fs::write(root().join(page), format!("{before}{start}{expected}{end}{after}")).unwrap();
    } else {
        assert_eq!(found, expected, "the part {name} of {page} is not the program's");
    }
}

#[test]
fn fields_are_those_of_the_table() {
    let mut fields =
        String::from("| field | symbol | allowed | left out | means |\n| --- | --- | --- | --- | --- |\n");
    let legs = [&LEG_FORCE, &LEG_INDENTATION];
    for field in FIELDS.iter().chain(legs).filter(|field| field.range != Range::Group) {
        let of = field.variant.map_or(String::new(), |variant| format!(" ({variant})"));
        let or_none = |text: &str| if text.is_empty() { String::new() } else { format!("`{text}`") };
        let allowed = match field.range {
            Range::Choice(choices) => choices.iter().map(|c| format!("`{c}`")).collect::<Vec<_>>().join(", "),
            _ => field.allowed(),
        };
        fields += &format!(
            "| `{}`{of} | {} | {allowed} | {} | {} |\n",
            field.path,
            field.symbol,
            or_none(field.default),
            field.meaning,
        );
    }
    check("docs/scene-file.md", "fields", &fields);
}

#[test]
fn scenes_are_the_presets() {
    let mut scenes = String::from("| scene | what it shows |\n| --- | --- |\n");
    for preset in presets() {
        let document = asperity::scene::open(preset.name).unwrap();
        scenes += &format!("| `{}` | {} |\n", preset.name, document.scene().notice);
    }
    check("docs/scene-file.md", "scenes", &scenes);
}
