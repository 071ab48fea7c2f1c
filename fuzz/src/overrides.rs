//! Overrides in the form of `--set`.

use super::{assert_document, assert_errors, text};
use asperity::scene::library::{DEFAULT, find_scene};
use asperity::scene::{Document, Origin, SceneErrors};

/// Most overrides at a time; for each of them the whole text is read again.
const MOST: usize = 16;

/// The first line names a built-in scene (the default if there is none of that name), each further
/// one is an override.
///
/// Accepted overrides make a sound scene, together as one by one, and those listed by a document
/// make the scene again; refused ones are named.
pub fn overrides(bytes: &[u8]) {
    let text = text(bytes);
    let mut lines = text.lines();
    let preset = lines
        .next()
        .and_then(|name| find_scene(name.trim()))
        .or_else(|| find_scene(DEFAULT));
    let Some(base) = preset.and_then(|preset| Document::parse(preset.text, preset.name).ok())
    else {
        panic!("{DEFAULT} is a scene")
    };
    // Split as on the command line.
    let pair = |line: &str| {
        line.split_once('=')
            .map(|(path, value)| (path.trim().into(), value.into()))
    };
    let pairs: Vec<(String, String)> = lines.filter_map(pair).take(MOST).collect();

    let all = base.set_all(&pairs);
    let one_by_one = pairs
        .iter()
        .try_fold(base.clone(), |document, (path, value)| {
            document.set(path, value)
        });
    match &all {
        Ok(changed) => {
            assert_document(changed);
            let listed = base
                .set_all(changed.overrides())
                .unwrap_or_else(|errors| panic!("{errors}"));
            assert_eq!(
                listed.scene(),
                changed.scene(),
                "{:?} listed for {pairs:?}",
                changed.overrides()
            );
            assert!(changed.overrides().iter().all(|pair| pairs.contains(pair)));
        }
        Err(errors) => assert_named(errors, &pairs),
    }
    match (&all, one_by_one) {
        (Ok(all), Ok(one_by_one)) => assert_eq!(all.text(), one_by_one.text(), "{pairs:?}"),
        (Err(errors), Ok(_)) => panic!("allowed one by one, refused together: {pairs:?}: {errors}"),
        // Some are allowed only together.
        (_, Err(errors)) => assert_named(&errors, &pairs),
    }
}

/// Errors name given overrides.
fn assert_named(errors: &SceneErrors, pairs: &[(String, String)]) {
    assert_errors(errors, |origin| match origin {
        Origin::Overrides(named) => {
            assert!(!named.is_empty(), "{errors}");
            for one in named {
                let given = pairs
                    .iter()
                    .any(|(path, value)| *one == format!("{path}={value}"));
                assert!(given, "{one:?} is not in {pairs:?}");
            }
        }
        other => panic!("an override is to blame, not {other:?}: {errors}"),
    });
}
