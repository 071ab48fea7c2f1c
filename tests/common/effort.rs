//! Number of random cases in a test: few by default, four times as many in the slow tests of
//! `.ci/run`.

/// Cases of a test: `quick`, times `TEST_EFFORT` from the environment.
pub fn cases(quick: u32) -> u32 {
    let effort = std::env::var("TEST_EFFORT").map_or(1.0, |effort| match effort.parse() {
        Ok(times) if f64::is_normal(times) && times > 0.0 => times,
        _ => panic!("TEST_EFFORT = {effort:?}; allowed: a number above 0"),
    });
    (f64::from(quick) * effort).ceil() as u32
}
