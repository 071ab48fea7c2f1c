//! Random loops under adhesion against the results of the former engine, which used a tree of all springs.

mod loops;
mod trace;

use asperity::contact::{
    ContactError, ContactTree, EdgeModel, Foundation, GridEdges, HessRule, LegRecord, Solver, SubCellEdges,
    exact,
};
use asperity::scene::Leg;
use loops::Loop;
use trace::{Quantity, Trace};

/// Number of recorded loops, including those without adhesion.
const LOOPS: u64 = 32_768;
/// Largest relative deviation of energies.
const OF_ENERGY: f64 = 1e-14;

/// Checksum and sum of absolute energies (J) of each loop under adhesion, in their order.
const RECORDED: &[u8] = include_bytes!("former_engine/recorded.bin");

/// Loops with edges between springs that unload to a force determined by its last digits: the indentation differs in
/// its last digits, since the interpolation begins at other ends.
const OTHER_TARGETS: [u64; 43] = [
    157, 377, 447, 679, 761, 905, 951, 1093, 1923, 3885, 3929, 4287, 4501, 5571, 5689, 6959, 9019, 11549,
    12543, 13085, 13251, 13951, 14061, 14339, 15553, 15831, 15923, 16409, 16459, 17447, 18557, 18859, 21103,
    23955, 25491, 26417, 26485, 27449, 27499, 28667, 29643, 29921, 32331,
];

/// Numbers of the loops under adhesion with this kind of edges, and the loops.
fn cases(sub_cell: bool) -> impl Iterator<Item = (u64, Loop)> {
    let numbers = (0..LOOPS).filter(move |&number| Loop::is_sub_cell(number) == sub_cell);
    numbers.map(|number| (number, Loop::new(number))).filter(|(_, case)| case.work > 0.0)
}

fn present(case: &Loop) -> Trace {
    let foundation = Foundation::endless(case.spacing, case.modulus);
    let hess = HessRule::new(foundation, case.work);
    if case.sub_cell {
        trace(case, SubCellEdges::new(hess), foundation)
    } else {
        trace(case, GridEdges::new(hess), foundation)
    }
}

fn trace<E: EdgeModel>(case: &Loop, edges: E, foundation: Foundation) -> Trace {
    let refusal = |error: &ContactError| match error {
        ContactError::NothingToPull { force, .. } => [1.0, *force],
        ContactError::DetachesBefore { smallest, .. } => [2.0, *smallest],
        ContactError::OutOfReach { .. } => [3.0, 0.0],
        other => panic!("{other}"),
    };
    let changes = |record: &LegRecord| [record.attached, record.detached];
    let tree = ContactTree::build(&case.gaps, E::EDGES).unwrap();
    let mut body = exact::adhesive(&case.gaps, &tree, edges, foundation, case.samples);
    let advance = |body: &mut exact::Exact<'_>, leg: Leg| body.advance(leg);
    let mut trace = Trace::new(&mut body, &case.legs, advance, refusal, changes);
    trace.zero_load(body.pull_off_at_touch().unwrap().0);
    trace
}

/// Curves, pull-off, patches and zero-load adhesion are the same bit for bit except in these loops; all energies are
/// the same to rounding.
fn check(sub_cell: bool, others: &[u64]) {
    let recorded = RECORDED.as_chunks::<12>().0;
    let mut different = Vec::new();
    let mut compared = 0;
    for (number, case) in cases(sub_cell) {
        let (checksum, energy) = recorded[number as usize].split_at(4);
        let found = present(&case);
        if found.checksum(sub_cell).to_le_bytes() != checksum {
            different.push(number);
        }
        let energy = f64::from_le_bytes(energy.try_into().unwrap());
        let deviation = (found.energy() - energy).abs();
        assert!(deviation <= OF_ENERGY * energy, "loop {number}: {deviation:e} of {energy:e} J");
        compared += 1;
    }
    assert!(compared > 15_000, "{compared}");
    assert_eq!(different, others);
}

#[test]
fn loops_of_whole_springs_are_those_of_the_former_engine() {
    check(false, &[]);
}

#[test]
fn loops_of_edges_between_springs_are_those_of_the_former_engine() {
    check(true, &OTHER_TARGETS);
}

/// Values of one quantity with one kind of edges.
#[derive(Clone, Copy, Default)]
struct Deviations {
    values: u64,
    different: u64,
    largest: f64,
}

#[test]
#[ignore = "needs the whole results that tests/engine/former_engine/record.sh writes"]
fn deviations_from_the_former_engine() {
    let path = std::env::var_os("FORMER_ENGINE").expect("FORMER_ENGINE: file of results");
    let recorded = std::fs::read(path).unwrap();
    let mut rest = recorded.as_slice();
    let former: Vec<_> = (0..LOOPS).map(|_| take_values(&mut rest)).collect();
    let mut table = [[Deviations::default(); 2]; Quantity::ALL.len()];
    for (number, case) in cases(false).chain(cases(true)) {
        let found = present(&case).to_bytes();
        let found = take_values(&mut found.as_slice());
        let former = &former[number as usize];
        assert_eq!(found.len(), former.len(), "loop {number}");
        let scales = Scales::new(former);
        let mut places = [0; Quantity::ALL.len()];
        for ((quantity, found), (of_former, former)) in found.into_iter().zip(former.iter().copied()) {
            assert_eq!(quantity, of_former, "loop {number}");
            let place = &mut places[quantity];
            let row = &mut table[quantity][usize::from(case.sub_cell)];
            row.values += 1;
            row.different += u64::from(found != former);
            let [found, former] = [found, former].map(f64::from_bits);
            if found != former {
                row.largest = row.largest.max((found - former).abs() / scales.of(quantity, *place));
            }
            *place += 1;
        }
    }
    println!("quantity: values, different, largest deviation; whole springs | edges between springs");
    for (quantity, row) in Quantity::ALL.into_iter().zip(table) {
        let [grid, sub_cell] = row
            .map(|Deviations { values, different, largest }| format!("{values}, {different}, {largest:.1e}"));
        println!("{quantity:?}: {grid} | {sub_cell}");
    }
}

/// Largest absolute values in a loop: of indentation, force and contact length, and of the energies of its stages.
struct Scales([f64; 3], f64);

impl Scales {
    fn new(values: &[(usize, u64)]) -> Self {
        let of = |wanted: Quantity| {
            let values = values.iter().filter(move |(quantity, _)| *quantity == wanted as usize);
            values.map(|(_, bits)| f64::from_bits(*bits).abs())
        };
        let component = |first| of(Quantity::Point).skip(first).step_by(3).fold(0.0, f64::max);
        Scales([0, 1, 2].map(component), of(Quantity::Energy).fold(0.0, f64::max))
    }

    /// Scale of the value at this index of a quantity.
    fn of(&self, quantity: usize, place: usize) -> f64 {
        if quantity == Quantity::Energy as usize { self.1 } else { self.0[place % 3] }
    }
}

/// Quantities and bits of one loop.
fn take_values(bytes: &mut &[u8]) -> Vec<(usize, u64)> {
    let count = bytes.split_off(..4).expect("a number of values");
    let count = u32::from_le_bytes(count.try_into().unwrap()) as usize;
    let values = bytes.split_off(..9 * count).expect("as many values").as_chunks::<9>().0.iter();
    values.map(|value| (usize::from(value[0]), u64::from_le_bytes(value[1..].try_into().unwrap()))).collect()
}
