//! Edits that a document remembers, so that they can be undone one by one.

use super::text::Text;

/// Change of the value at one path of a text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Edit {
    pub(super) path: String,
    /// Value before, as written; `None` where the text had no such entry.
    before: Option<String>,
    /// Value after.
    after: Option<String>,
}

impl Edit {
    /// The change at a path from one text to another; `None` where the value is written the same way.
    pub(super) fn between(before: &str, after: &str, path: &str) -> Option<Edit> {
        let written = |text| Text::new(text).ok()?.written(path).map(str::to_string);
        let (before, after) = (written(before), written(after));
        (before != after).then(|| Edit { path: path.to_string(), before, after })
    }

    /// The text with the value before; `None` where the value has been changed since.
    pub(super) fn undone(&self, text: &str) -> Option<String> {
        let read = Text::new(text).ok()?;
        if read.written(&self.path) != self.after.as_deref() {
            return None;
        }
        match &self.before {
            Some(before) => read.replace(&self.path, before).ok(),
            None => read.remove(&self.path).ok(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_is_undone_while_its_value_is_there() {
        let (before, after) = ("(a: 1, /* c */ b: (2 /* d */))", "(a: 1, /* c */ b: None, e: 5)");
        let edits = ["a", "b", "e"].map(|path| Edit::between(before, after, path));
        assert_eq!(edits[0], None);
        let [_, Some(b), Some(e)] = edits else { panic!("{edits:?}") };
        let text = e.undone(after).unwrap();
        assert_eq!(text, "(a: 1, /* c */ b: None)");
        assert_eq!(b.undone(&text).as_deref(), Some(before));
        assert_eq!((b.undone("(b: 3)"), e.undone("(b: None)")), (None, None));
    }
}
