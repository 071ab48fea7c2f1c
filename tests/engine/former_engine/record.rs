//! Writes results of the former engine, a program beside `loops.rs` and `trace.rs` in the former source: `record.sh`.
//!
//! Arguments: number of loops, file of whole results, file of checksums and energies.

mod loops;
mod trace;

use asperity::contact::subcell::{self, LevelSets};
use asperity::contact::{
    BodyMemory, ContactError, ContactTree, Foundation, GridEdges, HessRule, LegRecord, Solver, exact,
};
use asperity::scene::Leg;
use loops::Loop;
use std::env::args;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::sync::Arc;
use trace::Trace;

fn main() {
    let count = args().nth(1).and_then(|count| count.parse().ok()).expect("a number of loops");
    let [mut whole, mut short] = [2, 3].map(|place| {
        BufWriter::new(File::create(args().nth(place).expect("a file")).expect("a file that can be written"))
    });
    for case in (0..count).map(Loop::new) {
        // Without adhesion another solver has replaced the former one.
        let trace = if case.work > 0.0 { former(&case) } else { Trace::default() };
        whole.write_all(&trace.to_bytes()).expect("room in the file");
        short.write_all(&trace.checksum(case.sub_cell).to_le_bytes()).expect("room in the file");
        short.write_all(&trace.energy().to_le_bytes()).expect("room in the file");
    }
}

fn former(case: &Loop) -> Trace {
    let foundation = Foundation { spacing: case.spacing, effective_modulus: case.modulus };
    let hess = HessRule::new(foundation, case.work);
    let tree = Arc::new(ContactTree::build(&case.gaps).expect("memory"));
    if case.sub_cell {
        let sets = Arc::new(LevelSets::new(Arc::clone(&tree), &case.gaps).expect("memory"));
        let body = |samples| {
            subcell::adhesive_in(BodyMemory::default(), &sets, Some(hess), foundation, samples).expect("memory")
        };
        trace(&mut body(case.samples), &case.legs, &mut body(2))
    } else {
        let body = |samples| exact::adhesive(&tree, GridEdges::new(hess), foundation, samples).expect("memory");
        trace(&mut body(case.samples), &case.legs, &mut body(2))
    }
}

fn trace<S: Solver>(body: &mut S, legs: &[Leg], touching: &mut S) -> Trace {
    let refusal = |error: &ContactError| match error {
        ContactError::NothingToPull { force, .. } => [1.0, *force],
        ContactError::LetsGoBefore { smallest, .. } => [2.0, *smallest],
        ContactError::OutOfReach { .. } => [3.0, 0.0],
        other => panic!("{other}"),
    };
    let changes = |record: &LegRecord| [record.joins, record.leaves];
    let mut trace = Trace::new(body, legs, S::advance, refusal, changes);
    let [_, unloading] =
        [Leg::ToTouch, Leg::ToSeparation].map(|leg| touching.advance(leg).expect("a leg that can be reached"));
    trace.zero_load(unloading.smallest.force);
    trace
}
