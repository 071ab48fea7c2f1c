//! Descriptions in a built-in scene: its title, its notice and the comments of its text.
//!
//! They describe the values of the scene. If a value on which the solution depends is changed, the
//! notice and the comment beside the value are therefore removed, and the title states that the
//! scene is changed. If the value is changed back, the descriptions come back. In any other scene
//! the author has written the descriptions, so they always stay.

use std::sync::OnceLock;

use super::document::Document;
use super::errors::Origin;
use super::fields::FIELDS;
use super::library::presets;
use super::model::Scene;
use super::read::read;
use super::statements::describes;
use super::text::index::{Text, is_within};
use super::typed::with_typed;

/// Returns true if a scene, as it was opened, has the values of a built-in scene. Its text may
/// differ from the built-in text, for example in a table of results.
fn is_built_in(opened: &Scene) -> bool {
    built_in_scenes().contains(opened)
}

fn built_in_scenes() -> &'static [Scene] {
    static BUILT_IN: OnceLock<Vec<Scene>> = OnceLock::new();
    BUILT_IN.get_or_init(|| {
        presets()
            .iter()
            .filter_map(|preset| read(preset.text, |_| Origin::Scene).ok())
            .collect()
    })
}

/// Returns true if the computation of two scenes gives the same solution.
fn have_same_solution(first: &Scene, second: &Scene) -> bool {
    let mut first = first.clone();
    let mut second = second.clone();
    first.strip();
    second.strip();
    first == second
}

/// Returns true if a field inside `group`, a top-level field such as `material`, differs between
/// two scenes.
fn has_changed(first: &Scene, second: &Scene, group: &str) -> bool {
    FIELDS
        .iter()
        .filter(|field| is_within(field.path, group))
        .any(|field| field.value(first) != field.value(second))
}

/// Returns the title of a changed built-in scene. `name` is the name of its file or of the built-in
/// scene.
fn title_of_changed(name: &str) -> String {
    format!("{name}, changed")
}

impl Document {
    /// Returns the text of this document without the title, notice and comments that are false for
    /// the present values. Returns `None` if no value has changed. Also returns `None` if the scene
    /// is not a built-in scene, because its author has then written the descriptions.
    pub(super) fn text_with_true_words(&self) -> Option<Text> {
        let opened = read(self.opened(), |_| Origin::Scene).ok()?;
        if !self.is_changed() || !is_built_in(&opened) {
            return None;
        }
        if have_same_solution(&opened, self.scene()) {
            self.opened_with_descriptions()
        } else {
            Some(self.without_false_words(&opened))
        }
    }

    /// Returns the text as it was opened, with those changes that do not affect the solution and
    /// with each default that the user has stated.
    fn opened_with_descriptions(&self) -> Option<Text> {
        let mut text = Text::new(self.opened()).ok()?;
        for (path, value) in self.overrides() {
            if describes(path) || text.written(path).is_none() {
                text = with_typed(&text, path, value).ok()?;
            }
        }
        Some(text)
    }

    /// Returns the text without the descriptions that are false for the present values. `opened` is
    /// the scene as it was opened.
    fn without_false_words(&self, opened: &Scene) -> Text {
        let mut text = self.indexed_text().clone();
        for (path, _) in self.overrides() {
            let group = path.split('.').next().unwrap_or_default();
            if !describes(path) && has_changed(opened, self.scene(), group) {
                text = text.without_comments_beside(group);
            }
        }
        if !self.has_override("notice") {
            text = text.without_entry("notice");
        }
        if !self.has_override("title") {
            let title = format!("{:?}", title_of_changed(self.file_name()));
            text = with_typed(&text, "title", &title).unwrap_or(text);
        }
        text
    }

    fn has_override(&self, path: &str) -> bool {
        self.overrides().iter().any(|(own, _)| own == path)
    }

    /// Returns true if the title states that this is a changed built-in scene.
    pub fn is_changed_built_in(&self) -> bool {
        self.is_changed() && self.scene().title == title_of_changed(self.file_name())
    }

    /// Returns true if the scene has the title of a built-in scene. If it is this scene, a change
    /// of its values replaces the title.
    pub fn has_built_in_title(&self) -> bool {
        built_in_scenes()
            .iter()
            .any(|scene| scene.title == self.scene().title)
    }

    /// Returns the text of the scene for a file of the user. If the scene is a changed built-in
    /// scene, its title is left out, because the name of the file identifies the scene.
    pub fn text_for_own_file(&self) -> String {
        let text = self.indexed_text();
        let text = if self.is_changed_built_in() {
            text.without_entry("title")
        } else {
            text.clone()
        };
        text.as_str().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open::open;
    use crate::scene::written::to_ron;

    fn pressure_sensitive() -> Document {
        open("pressure-sensitive").unwrap()
    }

    #[test]
    fn the_first_change_removes_the_words_that_it_makes_false() {
        let before = pressure_sensitive();
        let changed = before.set("adhesion.kappa", "3.0").unwrap();
        assert_eq!(changed.title(), "pressure-sensitive, changed");
        assert_eq!(changed.scene().notice, "");
        assert!(
            !changed.text().contains("between the two other regimes"),
            "{}",
            changed.text()
        );
        // The comment of a value that has not changed stays.
        assert!(
            changed.text().contains("// soft rubber"),
            "{}",
            changed.text()
        );
        assert_eq!(
            Document::parse(changed.text(), "x").unwrap().scene(),
            changed.scene()
        );
        let as_soft = changed.set("material.poisson_ratio", "0.5").unwrap();
        assert_eq!(as_soft.comments(), 1);
        let softer = changed.set("material.youngs_modulus", "1.0e6").unwrap();
        assert_eq!(softer.comments(), 0);
        assert_eq!(softer.title(), "pressure-sensitive, changed");
    }

    #[test]
    fn each_change_of_any_built_in_scene_leaves_no_words_of_it() {
        for preset in presets() {
            let before = open(preset.name).unwrap();
            assert!(!before.scene().title.is_empty(), "{}", preset.name);
            let twice = format!("{:e}", 2.0 * before.scene().length);
            let stages = [(Some(0), before.scene().loading[0])];
            for changed in [
                before.set("length", &twice),
                before.set("numerics.edges", "Grid"),
                before
                    .set("observe", "[Patches]")
                    .unwrap()
                    .set("length", &twice),
                before.with_stages(&[stages, stages].concat()),
            ] {
                let Ok(changed) = changed else { continue };
                let title = format!("{}, changed", preset.name);
                assert_eq!(changed.title(), title, "{}", changed.text());
                assert_eq!(changed.scene().notice, "", "{}", changed.text());
                assert_eq!(
                    Document::parse(changed.text(), "x").unwrap().scene(),
                    changed.scene()
                );
            }
        }
    }

    #[test]
    fn what_the_solution_does_not_depend_on_changes_no_words() {
        let before = pressure_sensitive();
        let described = before.set_all(
            &[("numerics.samples", "64"), ("observe", "[Patches]")]
                .map(|(path, value)| (path.to_owned(), value.to_owned())),
        );
        let described = described.unwrap();
        assert_eq!(described.title(), before.title());
        assert_eq!(described.scene().notice, before.scene().notice);
        assert_eq!(described.comments(), before.comments());
    }

    #[test]
    fn the_words_come_back_with_the_values() {
        let before = pressure_sensitive();
        let changed = before.set("adhesion.kappa", "3.0").unwrap();
        assert_eq!(changed.set("adhesion.kappa", "6").unwrap(), before);
        let observing = changed.set("observe", "[Patches]").unwrap();
        let back = observing.set("adhesion.kappa", "6.0").unwrap();
        assert_eq!(
            back.text(),
            before.set("observe", "[Patches]").unwrap().text()
        );
        assert_eq!(back.title(), before.title());
    }

    #[test]
    fn words_of_the_user_stay() {
        let before = pressure_sensitive();
        let own = before
            .set("title", "\"My pad\"")
            .unwrap()
            .set("notice", "\"Mine.\"")
            .unwrap();
        let own = own.set("adhesion.kappa", "3.0").unwrap();
        assert_eq!(
            (own.title(), own.scene().notice.as_str()),
            ("My pad", "Mine.")
        );
        let file = "(version: 1, title: \"A\", notice: \"B\", material: (modulus: 1.0e6), length: 1.0e-4 /* wide */)";
        let file = Document::parse(file, "mine.ron")
            .unwrap()
            .set("length", "2.0e-4")
            .unwrap();
        assert_eq!(
            (file.title(), file.scene().notice.as_str(), file.comments()),
            ("A", "B", 1)
        );
    }

    #[test]
    fn a_copy_of_a_built_in_scene_has_no_words_of_its_own() {
        for text in [
            pressure_sensitive().text().to_owned(),
            to_ron(pressure_sensitive().scene()),
        ] {
            let copy = Document::parse(&text, "folder/pad.ron").unwrap();
            let changed = copy.set("length", "2.0e-4").unwrap();
            assert_eq!(
                (changed.title(), changed.scene().notice.as_str()),
                ("pad.ron, changed", "")
            );
            let saved = Document::parse(&changed.text_for_own_file(), "folder/pad.ron").unwrap();
            assert_eq!(saved.title(), "pad.ron");
        }
        let changed = pressure_sensitive().set("length", "2.0e-4").unwrap();
        assert!(changed.is_changed_built_in() && !pressure_sensitive().is_changed_built_in());
        assert!(
            !changed.text_for_own_file().contains("title"),
            "{}",
            changed.text_for_own_file()
        );
    }
}
