//! Recorded edits of a document, which can be undone one by one after any later edits.

use super::computed::Computed;
use super::effects::Effect;
use super::text::Text;

/// An effect switched off by edits, with the edits whose undoing restores it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SwitchedOff {
    pub(super) effect: Effect,
    pub(super) edits: Vec<Edit>,
    /// Values of the scene with the effect.
    pub(super) computed: Computed,
}

/// Change of the value at one path of a text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Edit {
    pub(super) path: String,
    /// Value before, as written; `None` if the text had no such entry.
    before: Option<String>,
    /// Value after.
    after: Option<String>,
}

impl Edit {
    /// The change at a path from one text to another; `None` for identical values.
    pub(super) fn between(before: &str, after: &str, path: &str) -> Option<Edit> {
        let written = |text| Text::new(text).ok()?.written(path).map(str::to_string);
        let (before, after) = (written(before), written(after));
        (before != after).then(|| Edit { path: path.to_string(), before, after })
    }

    /// The text with the value before; `None` if the value has been changed since and no part of the edit can be
    /// undone. Elements of a list or a group changed since are kept.
    pub(super) fn undone(&self, text: &str) -> Option<String> {
        let read = Text::new(text).ok()?;
        let present = read.written(&self.path);
        if present != self.after.as_deref() {
            let (before, after, present) = (self.before.as_deref()?, self.after.as_deref()?, present?);
            let merged = merged_list(before, after, present).or_else(|| merged_group(before, after, present));
            return read.replace(&self.path, &merged?).ok();
        }
        match &self.before {
            Some(before) => read.replace(&self.path, before).ok(),
            None => read.remove(&self.path).ok(),
        }
    }
}

/// The group before an edit, with the later changes of its fields; `None` if one of the values is no group.
fn merged_group(before: &str, after: &str, present: &str) -> Option<String> {
    let (edited, now) = (Text::new(after).ok()?, Text::new(present).ok()?);
    let names = [Text::new(before).ok()?.names()?, edited.names()?, now.names()?].concat();
    let mut group = before.to_string();
    for name in names {
        let (was, is) = (edited.written(name), now.written(name));
        let text = Text::new(&group).ok()?;
        group = match (is, text.written(name)) {
            _ if was == is => continue,
            (None, None) => continue,
            (None, Some(_)) => text.remove(name).ok()?,
            (Some(value), None) => text.insert("", name, value, &[]).ok()?,
            (Some(value), Some(_)) => text.replace(name, value).ok()?,
        };
    }
    Some(group)
}

/// The list before an edit that has removed elements, with the later changes of the list; `None` if one of the
/// values is no list, or the edit has done more than remove elements.
fn merged_list(before: &str, after: &str, present: &str) -> Option<String> {
    let elements = |list| Text::new(list).ok()?.elements();
    let (all, kept, now): (Vec<&str>, Vec<&str>, Vec<&str>) =
        (elements(before)?, elements(after)?, elements(present)?);
    // Places of the elements left by the edit.
    let mut left = kept.iter().peekable();
    let places: Vec<usize> =
        (0..all.len()).filter(|place| left.next_if_eq(&&all[*place]).is_some()).collect();
    if places.len() < kept.len() || all.is_empty() {
        return None;
    }
    let is_same = |(one, other): &(&&str, &&str)| one == other;
    let start = kept.iter().zip(&now).take_while(is_same).count();
    let shorter = kept.len().min(now.len()) - start;
    let end = kept.iter().rev().zip(now.iter().rev()).take(shorter).take_while(is_same).count();
    let (gone, come) = (&places[start..places.len() - end], &now[start..now.len() - end]);
    // Elements that replace each one.
    let mut slots: Vec<Vec<&str>> = all.iter().map(|element| vec![*element]).collect();
    if gone.len() == come.len() {
        gone.iter().zip(come).for_each(|(place, element)| slots[*place] = vec![*element]);
    } else {
        gone.iter().for_each(|place| slots[*place].clear());
        match gone.first().or(start.checked_sub(1).map(|last| &places[last])) {
            Some(place) => slots[*place].extend(come),
            None => drop(slots[places.first().copied().unwrap_or(0)].splice(..0, come.iter().copied())),
        }
    }
    with_slots(before, &slots)
}

/// A list with each element replaced by others.
fn with_slots(list: &str, slots: &[Vec<&str>]) -> Option<String> {
    let mut list = list.to_string();
    // From the end, so that earlier places remain valid.
    for (place, slot) in slots.iter().enumerate().rev() {
        let (text, path) = (Text::new(&list).ok()?, place.to_string());
        let span = text.span(&path)?.value;
        list = match &slot[..] {
            [] => text.remove(&path).ok()?,
            [same] if list.get(span.clone()) == Some(same) => continue,
            _ => format!("{}{}{}", &list[..span.start], slot.join(", "), &list[span.end..]),
        };
    }
    Some(list)
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

    #[test]
    fn elements_left_out_come_back_beside_changed_ones() {
        let before = "[A(1), /* c */ B, A(2), // d\n C,]";
        for (after, present, merged) in [
            ("[A(2)]", "[A(3)]", Some("[A(1), /* c */ B, A(3), // d\n C,]")),
            ("[A(2)]", "[A(2), D]", Some("[A(1), /* c */ B, A(2), D, // d\n C,]")),
            ("[A(2)]", "[D, A(2)]", Some("[A(1), /* c */ B, D, A(2), // d\n C,]")),
            ("[A(1), A(2)]", "[A(5), A(6)]", Some("[A(5), /* c */ B, A(6), // d\n C,]")),
            ("[A(1), A(2)]", "[A(1), A(6)]", Some("[A(1), /* c */ B, A(6), // d\n C,]")),
            ("[A(1), A(2)]", "[A(2)]", Some("[ /* c */ B, A(2), // d\n C,]")),
            ("[]", "[D]", Some("[D, A(1), /* c */ B, A(2), // d\n C,]")),
            ("[B, C]", "[]", Some("[A(1), /* c */  A(2), // d\n ]")),
            ("[A(3)]", "[A(2)]", None),
            ("None", "[A(2)]", None),
            ("[A(2)]", "(a: 2)", None),
        ] {
            let found = merged_list(before, after, present);
            assert_eq!(found.as_deref(), merged, "{after} {present}");
        }
        assert_eq!(merged_list("[]", "[]", "[A]"), None);
    }

    #[test]
    fn fields_of_a_group_come_back_beside_changed_ones() {
        let (before, after) = ("(a: 1, /* c */ b: (2), d: 5)", "(e: 3, d: 5)");
        for (present, merged) in [
            ("(e: 3, d: 5, f: 4)", "(a: 1, /* c */ b: (2), d: 5, f: 4)"),
            ("(e: 7, d: 5)", "(a: 1, /* c */ b: (2), d: 5, e: 7)"),
            ("(e: 3, d: 6)", "(a: 1, /* c */ b: (2), d: 6)"),
            ("(e: 3)", "(a: 1, /* c */ b: (2))"),
            ("(d: 5)", "(a: 1, /* c */ b: (2), d: 5)"),
        ] {
            assert_eq!(merged_group(before, after, present).as_deref(), Some(merged), "{present}");
        }
        for present in ["None", "[1]", "Cone(angle: 1)"] {
            assert_eq!(merged_group(before, after, present), None, "{present}");
        }
    }
}
