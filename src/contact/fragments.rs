//! Fragments of a contact given spring by spring.

/// First and last index of each run of springs in contact.
pub(crate) fn runs(contact: impl Iterator<Item = bool>) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for index in contact.enumerate().filter_map(|(index, contact)| contact.then_some(index)) {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == index => *last = index,
            _ => runs.push((index, index)),
        }
    }
    runs
}
