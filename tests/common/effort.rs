//! Number of random cases in a test: an eighth of them by default, and all with `TEST_EFFORT=8`.

/// Cases of a test: `quick`, times `TEST_EFFORT` from the environment.
pub fn cases(quick: u32) -> u32 {
    let effort = std::env::var("TEST_EFFORT").map_or(1.0, |effort| match effort.parse() {
        Ok(times) if f64::is_normal(times) && times > 0.0 => times,
        _ => panic!("TEST_EFFORT = {effort:?}; allowed: a number above 0"),
    });
    (f64::from(quick) * effort).ceil() as u32
}
