//! JSON objects that are made from a list of keys and values, in the order of the list.

use serde::ser::{Serialize, SerializeMap, Serializer};

/// JSON object that the macro [`object!`](crate::object!) makes.
pub struct Object<E>(pub E);

/// List of entries of an object. It is either empty, or a pair of the first entry and the list of
/// the other entries.
pub(crate) trait Entries {
    fn write<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error>;
}

impl Entries for () {
    fn write<M: SerializeMap>(&self, _: &mut M) -> Result<(), M::Error> {
        Ok(())
    }
}

/// Entry of an [`Object`]: a key and its value.
pub struct ObjectEntry<T>(pub &'static str, pub T);

/// Entry of an [`Object`] that is left out if its value is `None`.
pub struct Optional<T>(pub &'static str, pub Option<T>);

impl<T: Serialize, R: Entries> Entries for (ObjectEntry<T>, R) {
    fn write<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        let (ObjectEntry(key, value), others) = self;
        map.serialize_entry(key, value)?;
        others.write(map)
    }
}

impl<T: Serialize, R: Entries> Entries for (Optional<T>, R) {
    fn write<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        let (Optional(key, value), others) = self;
        if let Some(value) = value {
            map.serialize_entry(key, value)?;
        }
        others.write(map)
    }
}

impl<E: Entries> Serialize for Object<E> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        self.0.write(&mut map)?;
        map.end()
    }
}

/// Makes an [`Object`], which is written as JSON, from keys and values: `object! { "key": value }`.
/// An entry `"key"?: option` is left out if the option is `None`.
#[macro_export]
macro_rules! object {
    (@entries) => { () };
    (@entries $key:literal: $value:expr $(, $($rest:tt)*)?) => {
        ($crate::ObjectEntry($key, $value), $crate::object!(@entries $($($rest)*)?))
    };
    (@entries $key:literal?: $value:expr $(, $($rest:tt)*)?) => {
        ($crate::Optional($key, $value), $crate::object!(@entries $($($rest)*)?))
    };
    ($($entries:tt)*) => { $crate::Object($crate::object!(@entries $($entries)*)) };
}

#[cfg(test)]
mod tests {
    #[test]
    fn entries_keep_their_order() {
        let inner = [object! { "z": 1.5, "a": None::<f64> }];
        let text = serde_json::to_string(
            &object! { "b": "x", "c"?: None::<u8>, "d"?: Some(1), "a": inner },
        );
        assert_eq!(text.unwrap(), r#"{"b":"x","d":1,"a":[{"z":1.5,"a":null}]}"#);
    }
}
