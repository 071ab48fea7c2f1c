//! Ways to bring an effect back as it stood in an earlier document, the best first.

use super::blame::within;
use super::document::Document;
use super::effects::{Effect, pressing};
use super::model::{Adhesion, Leg, Observer, Roughness};
use super::switch::{by_work, has_amplitude, others, pair, suited_height};
use super::text::{Text, ron_float};
use super::write::{legs, to_ron};

/// Paths and values to set together.
type Overrides = Vec<(String, String)>;

/// Ways to bring an effect back to `here` as it stood in `from`, the best first; not all of them may
/// be allowed.
pub(super) fn ways_back(here: &Document, effect: Effect, from: &Document) -> Vec<Overrides> {
    match effect {
        Effect::Form => set_as_in(from, "form", &[]),
        Effect::Roughness => roughness(here, from),
        Effect::Adhesion => adhesion(here, from),
        Effect::Unloading => unloading(here, from),
        Effect::Fragments => observed(here, from, Observer::Fragments),
        Effect::HeightHistogram => observed(here, from, Observer::HeightHistogram),
    }
}

/// Ways to bring roughness back, the best first.
fn roughness(here: &Document, from: &Document) -> Vec<Overrides> {
    let Some(roughness) = &from.scene().roughness else { return Vec::new() };
    let mut ways = Vec::new();
    if let Some(Adhesion { work, kappa: Some(kappa) }) = from.scene().adhesion {
        if stands_in(here, "adhesion", "roughness") {
            for adhesion in values(from, "adhesion") {
                ways.extend(set_as_in(from, "roughness", &[pair("adhesion", adhesion)]));
            }
        }
        if work.is_some() && !has_amplitude(roughness) {
            // κ sets the amplitude again, with whatever work of adhesion there is now.
            ways.extend(set_as_in(from, "roughness", &[pair("adhesion.kappa", ron_float(kappa))]));
        }
    }
    ways.extend(set_as_in(from, "roughness", &[]));
    if !has_amplitude(roughness) {
        let height = pair("roughness.rms_height", ron_float(suited_height(here.scene())));
        ways.extend(set_as_in(from, "roughness", &[]).into_iter().map(|way| and(&way, &height)));
    }
    if let Roughness::SelfAffine { modes: (first, last), .. } = *roughness {
        // As it stood but for waves that are too short for the springs there are now.
        let last = last.min(here.scene().numerics.points / 2);
        let carried = pair("roughness.modes", format!("({}, {last})", first.min(last)));
        ways = ways.into_iter().flat_map(|way| [and(&way, &carried), way].into_iter().rev()).collect();
    }
    ways
}

/// Ways to bring adhesion back, the best first.
fn adhesion(here: &Document, from: &Document) -> Vec<Overrides> {
    let mut ways = Vec::new();
    if stands_in(here, "roughness.rms_height", "adhesion") {
        let mut before = here.scene().roughness.clone();
        if let Some(Roughness::SelfAffine { rms_height, .. }) = &mut before {
            *rms_height = None;
        }
        if before == from.scene().roughness {
            for roughness in values(from, "roughness") {
                ways.extend(set_as_in(from, "adhesion", &[pair("roughness", roughness)]));
            }
        }
        ways.extend(set_as_in(from, "adhesion", &[pair("roughness.rms_height", "None")]));
    }
    ways.extend(set_as_in(from, "adhesion", &[]));
    if let Some(Adhesion { work: Some(work), kappa: Some(_) }) = from.scene().adhesion {
        ways.push(vec![pair("adhesion", by_work(work))]);
    }
    ways
}

/// Ways to bring the legs that pull back: the whole loading, or after other legs that press.
fn unloading(here: &Document, from: &Document) -> Vec<Overrides> {
    let (loading, before) = (&here.scene().loading, &from.scene().loading);
    let left = pressing(before);
    if left == *loading {
        return set_as_in(from, "loading", &[]);
    }
    let last = before.iter().rposition(|leg| Some(leg) == left.last());
    let pulling = before.iter().skip(last.map_or(0, |last| last + 1));
    let all: Vec<Leg> = loading.iter().chain(pulling).copied().collect();
    vec![vec![pair("loading", legs(&all))]]
}

/// Ways to bring an observer back: in its old place, if the others are those there were.
fn observed(here: &Document, from: &Document, observer: Observer) -> Vec<Overrides> {
    let same = others(from.scene(), observer) == here.scene().observe;
    if same { set_as_in(from, "observe", &[]) } else { Vec::new() }
}

/// Whether what was set in place of an effect, when it was switched off, still stands.
fn stands_in(here: &Document, substitute: &str, effect: &str) -> bool {
    let overrides = here.overrides();
    let off = overrides.iter().rposition(|(path, value)| path == effect && value == "None");
    off.is_some_and(|off| {
        let set = off > 0 && overrides[off - 1].0 == substitute;
        let mut later = overrides[off..].iter();
        set && !later.any(|(path, _)| within(path, substitute) || within(substitute, path))
    })
}

fn and(way: &[(String, String)], more: &(String, String)) -> Overrides {
    [way, std::slice::from_ref(more)].concat()
}

/// Overrides that set a field as it stands in another document, after others.
fn set_as_in(from: &Document, path: &str, others: &[(String, String)]) -> Vec<Overrides> {
    values(from, path).into_iter().map(|value| and(others, &pair(path, value))).collect()
}

/// A field as it is written, with the comments in it, and in canonical form: a text that enables an
/// extension of RON may write what another one cannot.
fn values(from: &Document, path: &str) -> Vec<String> {
    let text = to_ron(from.scene());
    let canonical = Text::new(&text).ok().and_then(|outline| outline.value(path).map(str::to_string));
    from.value(path).map(str::to_string).into_iter().chain(canonical).collect()
}
