//! Laws for every line, both edge models, and any works of adhesion: symmetries, memory, order,
//! energy, exact extremes and crossings of the force, refusals, exact sums, and the contact against
//! brute force on small and on large lines.

mod all_segments;
mod body;
#[path = "../../../../tests/common/effort.rs"]
mod effort;
mod energy;
mod equilibrium;
mod exhaustive;
mod front;
mod instrument;
mod jumps;
mod large_lines;
mod levels;
mod memory;
mod patches;
mod premises;
mod refinement;
mod refusals;
mod relaxation;
mod reversals;
mod search;
mod stepwise;
mod symmetries;
mod work;

use asperity_contact::motion::{MovingBody, Stage, load_body};
use asperity_contact::{
    self as contact, Contact, ContactError, CurvePoint, Direction, Edges, Move, Patch, StageRecord,
};
use body::*;
use proptest::prelude::*;
use std::f64::consts::PI;
