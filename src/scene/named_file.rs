//! Names of files in a table of results, whose folder may differ from that of its scene.

use std::path::Path;

/// Name of a file relative to `folder` in a table that is written into `destination`: unchanged in the same folder,
/// else the absolute path.
#[must_use]
pub fn named_from(file: &str, folder: &Path, destination: &Path) -> String {
    match std::path::absolute(folder.join(file)) {
        Ok(absolute) if !is_same_folder(folder, destination) => absolute.to_string_lossy().into_owned(),
        _ => file.to_owned(),
    }
}

fn is_same_folder(one: &Path, other: &Path) -> bool {
    let whole = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        folder.canonicalize().ok()
    };
    one == other || whole(one).is_some_and(|folder| Some(folder) == whole(other))
}
