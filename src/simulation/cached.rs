//! A value kept with the key that it was made from.

/// A value and its key: another key needs another value.
pub(super) struct Cached<K, V>(Option<(K, V)>);

impl<K, V> Default for Cached<K, V> {
    fn default() -> Self {
        Cached(None)
    }
}

impl<K: PartialEq, V> Cached<K, V> {
    /// Returns the value of a key, if that is kept.
    pub fn get(&self, key: &K) -> Option<&V> {
        self.0.as_ref().filter(|(kept, _)| kept == key).map(|(_, value)| value)
    }

    /// Returns the value, whatever its key.
    pub fn value(&self) -> Option<&V> {
        self.0.as_ref().map(|(_, value)| value)
    }

    /// Returns the value, whatever its key, to take memory from.
    pub fn value_mut(&mut self) -> Option<&mut V> {
        self.0.as_mut().map(|(_, value)| value)
    }

    /// Keeps a value in place of the last one.
    pub fn keep(&mut self, key: K, value: V) {
        self.0 = Some((key, value));
    }

    /// Forgets the value and returns it for its memory.
    pub fn take(&mut self) -> Option<V> {
        self.0.take().map(|(_, value)| value)
    }
}
