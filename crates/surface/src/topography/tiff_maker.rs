//! Recognition of the maker of a TIFF file by the tags of its first image.

use super::channel::Wanted;
use super::reading::Reading;
use super::{jpk, park, tiff};
use crate::error::{Place, SurfaceError, refused};

/// Reads one channel of a TIFF file of JPK or Park Systems; `wanted` chooses the channel.
pub(super) fn read(bytes: &[u8], wanted: Wanted<'_>) -> Result<Reading, SurfaceError> {
    let directories = tiff::directories(bytes)?;
    if park::is_park(&directories) {
        return park::read(&directories, wanted);
    }
    if jpk::is_jpk(&directories) {
        return jpk::read(&directories, wanted);
    }
    let found = "a picture (TIFF) without the heights that JPK and Park store in it";
    let allowed = "the heights as text, X3P, SUR or GWY, from the program that drew them, or the \
                   same saved as GWY or X3P in Gwyddion";
    Err(refused(Place::File, found, allowed))
}

#[cfg(test)]
mod tests {
    use super::super::bytes::Order;
    use super::super::tiff::tests::Writer;
    use super::*;

    #[test]
    fn pictures_are_refused() {
        for order in [Order::Little, Order::Big] {
            let writer = Writer { order };
            let mut file = writer.begin();
            let tags = writer.image(&mut file, &[1, 2, 3], 16);
            writer.directory(&mut file, 4, &tags);
            let error = read(&file, Wanted::Heights).unwrap_err().to_string();
            assert!(
                error.starts_with("a picture (TIFF) without the heights"),
                "{error}"
            );
        }
    }
}
