//! Manual loading against the exact solver: the same contact, bit for bit, at a cost proportional to the change.

use asperity::contact::{
    ContactError, ContactTree, CurvePoint, Foundation, GridEdges, HessRule, LegRecord, Manual, ManualError,
    ManualLoading, Move, Solver, exact,
};
use asperity::scene::{Edges, Leg};
use asperity::surface::{SelfAffine, UnitRoughness};
use proptest::prelude::*;
use std::sync::Arc;

/// Springs, with or without a work of adhesion.
#[derive(Clone, Debug)]
struct Body {
    /// m, the smallest 0.
    gaps: Vec<f64>,
    foundation: Foundation,
    /// γ, J/m².
    work: Option<f64>,
    /// γ₁/γ on closing.
    closing: f64,
}

impl Body {
    fn tree(&self) -> Arc<ContactTree> {
        Arc::new(ContactTree::build(&self.gaps, Edges::Grid).unwrap())
    }

    fn edges(&self) -> GridEdges {
        let rule = |work| HessRule::from_works(self.foundation, self.closing * work, work);
        GridEdges::new(self.work.map_or(HessRule::NO_ADHESION, rule))
    }

    fn exact<'a>(&'a self, tree: &'a ContactTree) -> Box<dyn Solver + 'a> {
        match self.work {
            Some(_) => Box::new(exact::adhesive(&self.gaps, tree, self.edges(), self.foundation, 2)),
            None => Box::new(exact::nonadhesive(&self.gaps, Edges::Grid, self.foundation, 2)),
        }
    }

    /// The body under manual loading, before first touch.
    fn separated(&self, tree: &Arc<ContactTree>) -> Manual<GridEdges> {
        Manual::new(&self.gaps, Arc::clone(tree), self.edges(), self.foundation).unwrap()
    }

    /// The body under manual loading, in this contact.
    fn in_contact(
        &self,
        tree: &Arc<ContactTree>,
        indentation: f64,
        fragments: &[(usize, usize)],
    ) -> Manual<GridEdges> {
        let tree = Arc::clone(tree);
        Manual::in_contact(&self.gaps, tree, self.edges(), self.foundation, indentation, fragments, &[])
            .unwrap()
    }

    /// m
    fn deepest(&self) -> f64 {
        self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// Largest stretch of a fragment over the whole line, m.
    fn largest_stretch(&self) -> f64 {
        let length = self.gaps.len() as f64 * self.foundation.spacing;
        let range = self.work.unwrap_or(0.0) / self.foundation.effective_modulus;
        (std::f64::consts::PI * length * range).sqrt()
    }

    /// Order of magnitude of the acting forces, N.
    fn force_scale(&self) -> f64 {
        let springs = self.gaps.len() as f64 * self.foundation.spring_stiffness();
        springs * (self.deepest() + self.largest_stretch()).max(1e-3)
    }
}

/// Gaps of a line of one of several kinds, up to 300 springs.
fn gaps() -> impl Strategy<Value = Vec<f64>> {
    let walk = prop::collection::vec(-1.0..1.0_f64, 1..300).prop_map(|steps| {
        let mut height = 0.0;
        let heights = steps.iter().map(|step| {
            height += 0.1 * step;
            height
        });
        heights.collect::<Vec<f64>>()
    });
    let noise = prop::collection::vec(0.0..1.0_f64, 1..120);
    let few = prop::collection::vec(0.0..1.0_f64, 1..5);
    let levels = prop::collection::vec(0_u8..5, 1..120)
        .prop_map(|levels| levels.iter().map(|&level| 0.25 * f64::from(level)).collect());
    let flat = (1_usize..50).prop_map(|count| vec![0.0; count]);
    let ramp = (1_usize..100, any::<bool>()).prop_map(|(count, falls)| {
        let rising = (0..count).map(|k| (k as f64 / 50.0).powi(2));
        if falls { rising.rev().collect() } else { rising.collect() }
    });
    // Neighbours in the last digit: attachment and detachment are at one number.
    let fine = prop::collection::vec(0_u64..9, 1..60).prop_map(|places| {
        let mut gaps: Vec<f64> = places.iter().map(|p| f64::from_bits(0.5_f64.to_bits() + p)).collect();
        gaps[0] = 0.0;
        gaps
    });
    prop_oneof![6 => walk, 2 => noise, 2 => few, 3 => levels, 1 => flat, 2 => ramp, 1 => fine].prop_map(
        |heights: Vec<f64>| {
            let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
            heights.iter().map(|height| height - lowest).collect()
        },
    )
}

/// Bodies about 1 m deep: without adhesion, with hardly any, and with far more than full adhesion needs.
fn body() -> impl Strategy<Value = Body> {
    let range = prop_oneof![
        3 => (-5.0..2.0_f64).prop_map(|power| Some(10_f64.powf(power))),
        1 => (-32.0..-5.0_f64).prop_map(|power| Some(10_f64.powf(power))),
        1 => Just(Some(0.0)),
        1 => Just(None),
    ];
    let closing = prop_oneof![2 => Just(1.0), 1 => Just(0.0), 2 => 0.0..1.0_f64];
    (gaps(), range, closing, 0.003..0.03_f64, 0.3..3.0_f64).prop_map(
        |(gaps, range, closing, spacing, effective_modulus)| {
            let work = range.map(|range| range * effective_modulus);
            Body { gaps, foundation: Foundation::endless(spacing, effective_modulus), work, closing }
        },
    )
}

/// Target of a move; forces in units of the acting ones.
#[derive(Clone, Copy, Debug)]
enum Goal {
    Indentation(f64),
    Force(f64),
    Separation,
}

impl Goal {
    fn leg(self, body: &Body) -> Leg {
        match self {
            Goal::Indentation(indentation) => Leg::ToIndentation(indentation),
            Goal::Force(share) => Leg::ToForce(share * body.force_scale()),
            Goal::Separation => Leg::ToSeparation,
        }
    }
}

fn indentation() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -0.8..1.2_f64, 2 => (-3_i8..6).prop_map(|l| 0.25 * f64::from(l))]
}

fn goals() -> impl Strategy<Value = Vec<Goal>> {
    let force = prop_oneof![
        4 => -0.5..1.0_f64, 2 => -0.02..0.02_f64, 1 => Just(0.0), 1 => Just(1e9), 1 => Just(-1e9)
    ];
    let goal = prop_oneof![
        5 => indentation().prop_map(Goal::Indentation),
        5 => force.prop_map(Goal::Force),
        1 => Just(Goal::Separation),
    ];
    prop::collection::vec(goal, 1..14)
}

fn go(body: &mut dyn ManualLoading, leg: Leg) -> Result<Move, ManualError> {
    match leg {
        Leg::ToIndentation(indentation) => body.move_to_indentation(indentation),
        Leg::ToForce(force) => body.move_to_force(force),
        _ => Ok(body.separate()),
    }
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// All bits of a point.
fn bits(point: &CurvePoint) -> [u64; 4] {
    [point.indentation.to_bits(), point.force.to_bits(), point.springs, point.fragments]
}

fn fragments(body: &dyn ManualLoading) -> Vec<(usize, usize)> {
    body.fragments().collect()
}

/// State of a body: all bits of its point, and its fragments.
fn state(body: &dyn ManualLoading) -> ([u64; 4], Vec<(usize, usize)>) {
    (bits(&body.point()), fragments(body))
}

/// The fragments of a solver at the end of a leg.
fn fragments_after(solver: &dyn Solver, record: &LegRecord) -> Vec<(usize, usize)> {
    let end = record.curve.last().unwrap();
    if end.springs == 0 { Vec::new() } else { solver.fragments(end.indentation) }
}

/// The springs around one that touch before that one, where of equal gaps the leftmost touches last.
fn span_of(gaps: &[f64], spring: usize) -> (usize, usize) {
    let gap = gaps[spring];
    let before = gaps[..spring].iter().rev().take_while(|&&other| other < gap).count();
    let after = gaps[spring + 1..].iter().take_while(|&&other| other <= gap).count();
    (spring - before, spring + after)
}

/// Checks an energy Σ ½ k e² to the rounding of the indentations θ that the stretches e = c − θ are taken from.
fn check_energy(body: &Body, found: f64, expected: f64) -> Result<(), TestCaseError> {
    let stiffness = body.foundation.effective_modulus * body.foundation.spacing * body.gaps.len() as f64;
    let rounding = f64::EPSILON * body.deepest();
    let stretch = (2.0 * expected.abs() / stiffness).sqrt();
    // Squares are summed in units of 2^28 squared quanta of 2^-62 of the depth.
    let unit = (body.deepest() * 2_f64.powi(-47)).powi(2);
    let allowed = 1e-12 * expected.abs() + 4.0 * stiffness * (rounding * stretch + unit);
    prop_assert!((found - expected).abs() <= allowed, "{} J against {} J", found, expected);
    Ok(())
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn its_state_is_that_of_the_exact_solver(body in body(), goals in goals()) {
        let tree = body.tree();
        let (mut solver, mut manual) = (body.exact(&tree), body.separated(&tree));
        for (index, goal) in goals.iter().enumerate() {
            let leg = goal.leg(&body);
            let before = state(&manual);
            let (found, expected) = (go(&mut manual, leg), solver.advance(leg));
            match (found, expected) {
                (Ok(found), Ok(record)) => {
                    let end = record.curve.last().unwrap();
                    prop_assert_eq!(bits(&manual.point()), bits(end), "{} {:?}: {:?} against {:?}",
                        index, leg, manual.point(), end);
                    prop_assert_eq!(fragments(&manual), fragments_after(&*solver, &record));
                    prop_assert_eq!((found.attaches, found.detaches), (record.attached, record.detached));
                    check_energy(&body, found.released_energy, record.released_energy)?;
                }
                (Err(found), Err(expected)) => {
                    prop_assert_eq!(state(&manual), before);
                    let alike = match (&found, &expected) {
                        (ManualError::NothingToPull { .. }, ContactError::NothingToPull { .. })
                        | (ManualError::OutOfReach { .. }, ContactError::OutOfReach { .. }) => true,
                        (
                            ManualError::DetachesBefore { smallest: one, .. },
                            ContactError::DetachesBefore { smallest: other, .. },
                        ) => one.to_bits() == other.to_bits(),
                        _ => false,
                    };
                    prop_assert!(alike, "{:?} against {:?}", found, expected);
                }
                (found, expected) => prop_assert!(false, "{:?} against {:?}", found, expected),
            }
        }
    }

    #[test]
    fn a_force_is_checked_without_a_move(body in body(), goals in goals()) {
        let tree = body.tree();
        let (mut manual, mut unchecked) = (body.separated(&tree), body.separated(&tree));
        for goal in goals {
            let leg = goal.leg(&body);
            let before = state(&manual);
            let checked = match leg {
                Leg::ToForce(force) => Some(manual.check_force(force)),
                _ => None,
            };
            prop_assert_eq!(state(&manual), before);
            let moved = go(&mut manual, leg).map(drop);
            if let Some(checked) = checked {
                prop_assert_eq!(checked, moved.clone());
            }
            prop_assert_eq!(moved, go(&mut unchecked, leg).map(drop));
            prop_assert_eq!(state(&manual), state(&unchecked));
        }
    }

    #[test]
    fn a_move_in_many_parts_is_one_move(
        body in body(),
        goals in goals(),
        to in indentation(),
        parts in prop::collection::vec(0.0..1.0_f64, 1..40),
    ) {
        let tree = body.tree();
        let (mut whole, mut split) = (body.separated(&tree), body.separated(&tree));
        for goal in goals {
            let leg = goal.leg(&body);
            prop_assert_eq!(go(&mut whole, leg).is_ok(), go(&mut split, leg).is_ok());
        }
        let from = whole.point().indentation;
        let mut stops: Vec<f64> = parts.iter().map(|part| from + part * (to - from)).collect();
        stops.sort_by(|a, b| if to < from { b.total_cmp(a) } else { a.total_cmp(b) });
        stops.push(to);
        let once = whole.move_to_indentation(to).unwrap();
        let mut sum = Move::default();
        for stop in stops {
            let part = split.move_to_indentation(stop).unwrap();
            sum.attaches += part.attaches;
            sum.detaches += part.detaches;
            sum.events += part.events;
            sum.released_energy += part.released_energy;
        }
        prop_assert_eq!(state(&whole), state(&split));
        prop_assert_eq!((once.attaches, once.detaches, once.events), (sum.attaches, sum.detaches, sum.events));
        check_energy(&body, sum.released_energy, once.released_energy)?;
    }

    #[test]
    fn minor_loops_close(body in body(), deepest in 0.0..1.2_f64, shares in [0.0..1.0_f64, 0.0..1.0]) {
        let tree = body.tree();
        let mut manual = body.separated(&tree);
        let outer = -0.5 + shares[0] * (deepest + 0.5);
        let inner = outer + shares[1] * (deepest - outer);
        let mut states = Vec::new();
        for to in [deepest, outer, inner, outer, deepest] {
            manual.move_to_indentation(to).unwrap();
            states.push(state(&manual));
        }
        prop_assert_eq!(&states[1], &states[3]);
        prop_assert_eq!(&states[0], &states[4]);
    }

    #[test]
    fn begun_in_any_contact_it_goes_on_as_if_it_had_come_there(
        body in body(),
        history in prop::collection::vec(indentation(), 1..6),
        share in 0.0..=1.0_f64,
        goals in goals(),
    ) {
        let tree = body.tree();
        let (mut solver, mut came) = (body.exact(&tree), body.separated(&tree));
        let mut last = None;
        for &to in &history {
            last = Some(solver.advance(Leg::ToIndentation(to)).unwrap());
        }
        // A state of the last leg.
        let last = last.unwrap();
        let moment = last.start() + share * (last.end() - last.start());
        for &to in &history[..history.len() - 1] {
            came.move_to_indentation(to).unwrap();
        }
        came.move_to_indentation(moment).unwrap();
        let mut taken = body.in_contact(&tree, moment, &solver.fragments(moment));
        prop_assert_eq!(state(&taken), state(&came));
        for goal in goals {
            let leg = goal.leg(&body);
            let (one, other) = (go(&mut taken, leg), go(&mut came, leg));
            prop_assert_eq!(one.map(|one| Move { touched: 0, ..one }), other.map(|other| Move { touched: 0, ..other }));
            prop_assert_eq!(state(&taken), state(&came));
        }
    }

    #[test]
    fn of_any_contact_the_largest_spans_are_taken(
        body in body(),
        runs in prop::collection::vec((0_usize..310, 0_usize..40), 0..12),
    ) {
        let tree = body.tree();
        let runs: Vec<_> = runs.iter().map(|&(first, more)| (first, first + more)).collect();
        let held = |index| runs.iter().any(|&(first, last)| (first..=last).contains(&index));
        let mut expected: Vec<(usize, usize)> = (0..body.gaps.len())
            .map(|spring| span_of(&body.gaps, spring))
            .filter(|&(first, last)| (first..=last).all(held))
            .collect();
        let all = expected.clone();
        let within = |one: &(usize, usize), other: &(usize, usize)| other.0 <= one.0 && one.1 <= other.1;
        expected.retain(|one| !all.iter().any(|other| one != other && within(one, other)));
        expected.sort_unstable();
        let mut manual = body.in_contact(&tree, 0.1, &runs);
        prop_assert_eq!(fragments(&manual), expected.clone());
        let springs: usize = expected.iter().map(|&(first, last)| last + 1 - first).sum();
        let point = manual.point();
        prop_assert_eq!((point.springs, point.fragments), (springs as u64, expected.len() as u64));
        let force: f64 = expected.iter().flat_map(|&(first, last)| &body.gaps[first..=last])
            .map(|gap| body.foundation.spring_stiffness() * (0.1 - gap)).sum();
        prop_assert!((point.force - force).abs() <= 1e-12 * body.force_scale());
        // In equilibrium or not: pressed beyond all gaps everything touches, pulled apart nothing does.
        manual.move_to_indentation(body.deepest().max(0.2)).unwrap();
        prop_assert_eq!(manual.point().springs, body.gaps.len() as u64);
        prop_assert_eq!(manual.separate().detaches, body.gaps.len() as u64);
        prop_assert_eq!(fragments(&manual), vec![]);
    }

    #[test]
    fn numbers_that_are_none_are_refused(body in body(), goals in goals()) {
        let tree = body.tree();
        let mut manual = body.separated(&tree);
        for goal in goals {
            let _ = go(&mut manual, goal.leg(&body));
            let before = state(&manual);
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let refused = |moved| matches!(moved, Err(ManualError::NotFinite { .. }));
                prop_assert!(refused(manual.move_to_indentation(value)));
                prop_assert!(refused(manual.move_to_force(value)));
                let tree = Arc::clone(&tree);
                let taken = Manual::in_contact(&body.gaps, tree, body.edges(), body.foundation, value, &[], &[]);
                let is_refused = matches!(taken, Err(ManualError::NotFinite { .. }));
                prop_assert!(is_refused);
            }
            prop_assert_eq!(state(&manual), before);
        }
    }
}

/// Far beyond full contact the force passes its target between two neighbouring indentations: the leg back to the same
/// force ends below it.
#[test]
fn a_force_passed_by_a_rounding_is_met_again_from_above() {
    let gaps: Vec<f64> = (0..10).map(|k| (f64::from(k) / 50.0).powi(2)).collect();
    let body = Body { gaps, foundation: Foundation::endless(0.003, 0.3), work: None, closing: 1.0 };
    let tree = body.tree();
    let leg = Goal::Force(1e9).leg(&body);
    let Leg::ToForce(force) = leg else { panic!("{leg:?}") };
    let (mut solver, mut manual) = (body.exact(&tree), body.separated(&tree));
    let mut reached = Vec::new();
    for _ in 0..2 {
        go(&mut manual, leg).unwrap();
        let record = solver.advance(leg).unwrap();
        let end = *record.curve.last().unwrap();
        assert_eq!(bits(&manual.point()), bits(&end));
        reached.push(end.force);
    }
    assert!(reached[0] > force && reached[1] <= force, "{reached:?} for {force}");
}

/// A self-affine line about 1 m deep.
fn rough(springs: usize, work: Option<f64>) -> Body {
    let spectrum = SelfAffine { hurst: 0.7, first: 1, last: springs as u64 / 4 };
    let heights = UnitRoughness::synthesize(spectrum, 1, springs).unwrap().heights;
    let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let gaps = heights.iter().map(|height| 0.2 * (summit - height)).collect();
    Body { gaps, foundation: Foundation::endless(1.0 / springs as f64, 1.0), work, closing: 1.0 }
}

/// Numbers in [0, 1) without a pattern.
fn shares() -> impl Iterator<Item = f64> {
    (1_u32..).map(|k| (f64::from(k) * 0.618_033_988_749_894_9).fract())
}

/// Most entries read for each spring that changes, plus one, in units of log₂ N.
const MOST_TOUCHED: f64 = 4.0;

#[test]
fn a_step_costs_what_changes() {
    // A cost in proportion to the springs would be hundreds of times the bound.
    const SPRINGS: usize = 1 << 14;
    let rows = SPRINGS.ilog2();
    let mut largest = 0.0_f64;
    for work in [None, Some(1e-6), Some(1e-3), Some(0.02), Some(0.3), Some(1e3)] {
        let body = rough(SPRINGS, work);
        let tree = body.tree();
        let (mut solver, mut manual) = (body.exact(&tree), body.separated(&tree));
        let mut check = |moved: Move| {
            let changed = moved.attaches + moved.detaches;
            assert!(moved.events <= changed, "{moved:?}");
            let touched = moved.touched as f64 / (changed + 1) as f64 / f64::from(rows);
            largest = largest.max(touched);
            assert!(touched <= MOST_TOUCHED, "γ = {work:?}: {moved:?}");
            // Without adhesion springs are counted by their order.
            assert!(work.is_none() || moved.touched >= changed, "γ = {work:?}: {moved:?}");
            if changed == 0 {
                assert_eq!((moved.touched, moved.released_energy), (0, 0.0), "γ = {work:?}");
            }
            changed
        };
        // Small steps to and fro about some turning points, and jumps between them.
        let mut still = 0;
        for (turn, share) in shares().take(12).enumerate() {
            let middle = 1.1 * share - 0.2;
            for (step, share) in shares().skip(100 * turn).take(300).enumerate() {
                let size = 10_f64.powi(-(step as i32 % 7) - 1);
                let changed = check(manual.move_to_indentation(middle + size * (share - 0.5)).unwrap());
                still += usize::from(changed == 0);
            }
            // The history in between, by the exact solver.
            let runs = fragments(&manual);
            let at = manual.point();
            let mut taken = body.in_contact(&tree, at.indentation, &runs);
            assert_eq!(state(&taken), state(&manual));
            for leg in [Leg::ToIndentation(middle), Leg::ToForce(0.01), Leg::ToSeparation] {
                let one = go(&mut manual, leg);
                assert_eq!(one.is_ok(), go(&mut taken, leg).is_ok());
                if let Ok(moved) = one {
                    check(moved);
                }
                assert_eq!(state(&taken), state(&manual));
            }
            if manual.point().springs == 0 {
                solver.advance(Leg::ToSeparation).unwrap();
            }
            for leg in [Leg::ToIndentation(1.0 - share), Leg::ToIndentation(0.3 * share)] {
                let record = solver.advance(leg).unwrap();
                check(go(&mut manual, leg).unwrap());
                assert_eq!(bits(&manual.point()), bits(record.curve.last().unwrap()));
                assert_eq!(fragments(&manual), fragments_after(&*solver, &record));
            }
        }
        assert!(still > 20, "γ = {work:?}: {still} steps without a change");
    }
    println!("at most {largest:.2} (k + 1) log2 N entries");
}

#[test]
fn entries_are_counted() {
    let body = rough(1 << 10, Some(0.02));
    let mut manual = body.separated(&body.tree());
    let counts = [Leg::ToIndentation(0.3), Leg::ToIndentation(0.1), Leg::ToSeparation].map(|leg| {
        let moved = go(&mut manual, leg).unwrap();
        (moved.attaches + moved.detaches, moved.touched)
    });
    assert_eq!(counts, [(341, 3810), (242, 3414), (99, 1444)]);
}

#[test]
fn a_line_of_no_springs_is_never_touched() {
    let body = Body { gaps: Vec::new(), foundation: Foundation::endless(1.0, 1.0), work: None, closing: 1.0 };
    let mut manual = body.separated(&body.tree());
    manual.move_to_indentation(3.0).unwrap();
    assert_eq!(manual.move_to_force(1.0), Err(ManualError::OutOfReach { force: 1.0 }));
    assert_eq!(manual.move_to_force(-1.0), Err(ManualError::NothingToPull { force: -1.0 }));
    assert_eq!(manual.separate(), Move::default());
    assert_eq!(state(&manual).1, vec![]);
    assert_eq!(manual.point().indentation, 3.0);
}

#[test]
fn a_force_no_indentation_reaches_is_refused() {
    let foundation = Foundation::endless(1e-3, 1.0);
    for work in [None, Some(0.1)] {
        let body = Body { gaps: vec![0.3, 0.0, 0.9, 0.2, 0.5], foundation, work, closing: 1.0 };
        let tree = body.tree();
        let (mut solver, mut manual) = (body.exact(&tree), body.separated(&tree));
        for leg in [Leg::ToIndentation(0.25), Leg::ToSeparation] {
            solver.advance(leg).unwrap();
            go(&mut manual, leg).unwrap();
            let before = state(&manual);
            let refused = solver.advance(Leg::ToForce(1e308));
            assert!(matches!(refused, Err(ContactError::OutOfReach { .. })), "{refused:?}");
            assert_eq!(manual.move_to_force(1e308), Err(ManualError::OutOfReach { force: 1e308 }));
            assert_eq!(state(&manual), before);
        }
    }
}
