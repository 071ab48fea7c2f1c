//! Laws for every line, both edge models, and any works of adhesion: symmetries, memory, order, energy, exact extremes
//! and crossings of the force, refusals, and finite numbers from extreme input.

mod all_segments;
mod energy;
mod memory;
mod patches;
mod refusals;
mod search;
mod symmetries;
mod work;

use super::body::*;
use asperity::contact::{CurvePoint, Direction, Edges, Foundation, Leg, LegRecord, Move, Patch, Solver};
use proptest::prelude::*;
