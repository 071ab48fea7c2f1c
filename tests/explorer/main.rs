//! The explorer without a terminal: screens after each key, random keys, and the solver.

#[path = "../common"]
mod common {
    pub mod deadline;
    pub mod draws;
    pub mod driver;
    pub mod effort;
    pub mod scenes;
    pub mod script;
    pub mod study;
}
mod bytes;
mod path;
mod places;
mod random;
mod random_bytes;
mod screen;
mod solver;
