//! The jumps of a motion: against the thresholds of all springs, one by one, and against the energy
//! that is stored and lost.

use super::*;
use asperity_contact::motion::{InstrumentJump, Jump, JumpCollector, JumpKind, Stepwise};
use asperity_contact::{Event, Events, LoadOptions, Mark};

const LEAST: usize = Jump::LEAST_SPRINGS as usize;

/// Springs of one patch that attach or detach at one indentation.
struct Change {
    larger: Patch,
    smaller: Vec<Patch>,
    springs: Vec<usize>,
}

/// The patches at an indentation, and those just below it.
fn patches_around(thresholds: &[f64], d: f64) -> [Vec<Patch>; 2] {
    let at = Patch::of_springs(thresholds.iter().map(|&threshold| threshold <= d));
    let below = Patch::of_springs(thresholds.iter().map(|&threshold| threshold < d));
    [at, below]
}

/// All patches that change at an indentation by at least as many springs as a jump has.
fn changes(thresholds: &[f64], d: f64) -> Vec<Change> {
    let [at, below] = patches_around(thresholds, d);
    let mut changes = Vec::new();
    for larger in at {
        let inside = |patch: &&Patch| larger.springs().contains(&patch.first);
        let smaller: Vec<Patch> = below.iter().filter(inside).copied().collect();
        let springs: Vec<usize> = larger
            .springs()
            .filter(|&spring| thresholds[spring] == d)
            .collect();
        if springs.len() >= LEAST {
            changes.push(Change {
                larger,
                smaller,
                springs,
            });
        }
    }
    changes
}

/// Compares the jumps of a motion with the thresholds of its springs. Returns the sum of the
/// energies of all jumps.
fn compare(body: &Body, stage: &Stage, low: f64, high: f64) -> Result<f64, TestCaseError> {
    let thresholds = stage.thresholds();
    let loads = stage.direction() == Direction::Loading;
    let mut expected: Vec<f64> = thresholds.clone();
    expected.retain(|&d| low < d && d <= high);
    expected.sort_by(f64::total_cmp);
    expected.dedup_by(|next, before| next == before);
    expected.retain(|&d| !changes(&thresholds, d).is_empty());
    if !loads {
        expected.reverse();
    }
    // Springs that never bear a stretch touch or leave without a jump of the force.
    let work = if loads { body.closing_work } else { body.work };
    if work == 0.0 {
        expected.clear();
    }
    let jumps = stage.jumps(low, high).unwrap();
    let found: Vec<f64> = jumps.iter().map(|jump| jump.indentation).collect();
    prop_assert_eq!(&found, &expected);
    let forces = stage.forces_at_jumps(&jumps).unwrap();
    let [force_scale, energy_scale] = body.scales();
    for (jump, forces) in jumps.iter().zip(forces) {
        let d = jump.indentation;
        let changes = changes(&thresholds, d);
        let all_springs: Vec<usize> = changes
            .iter()
            .flat_map(|change| change.springs.iter().copied())
            .collect();
        let sign: i32 = if loads { 1 } else { -1 };
        prop_assert_eq!(jump.springs, i64::from(sign) * all_springs.len() as i64);
        // The patch of which the most springs change, the leftmost of equals.
        let most = changes.iter().map(|change| change.springs.len()).max();
        let change = changes
            .iter()
            .find(|change| Some(change.springs.len()) == most)
            .unwrap();
        let parts = change.smaller.len() as u64;
        let kind = match (changes.len(), loads, parts) {
            (2.., ..) => JumpKind::Several {
                changes: changes.len() as u64,
            },
            (_, true, 0) => JumpKind::Touches,
            (_, true, 1) => JumpKind::Spreads,
            (_, true, patches) => JumpKind::Merges { patches },
            (_, false, 0) => JumpKind::Detaches,
            (_, false, 1) => JumpKind::Shrinks,
            (_, false, parts) => JumpKind::Splits { parts },
        };
        prop_assert_eq!(jump.kind, kind);
        let [at, below] = patches_around(&thresholds, d);
        let mut counts = [below.len() as u64, at.len() as u64];
        let mut states = [
            change.smaller.first().map(|first| Patch {
                first: first.first,
                last: change.smaller[change.smaller.len() - 1].last,
            }),
            Some(change.larger),
        ];
        if !loads {
            counts.reverse();
            states.reverse();
        }
        prop_assert_eq!(jump.patches, counts);
        prop_assert_eq!([jump.before, jump.after], states);
        let number = at.iter().position(|patch| *patch == change.larger);
        prop_assert_eq!(Some(jump.number), number.map(|number| number as u64));

        let [before, after] = if loads {
            [d.next_down(), d]
        } else {
            [d, d.next_down()]
        };
        let [before, after] = [before, after].map(|d| stage.point(d).unwrap());
        prop_assert_eq!(forces, [before.force, after.force].map(|force| force + 0.0));
        if body.edges == Edges::Grid {
            let squares = all_springs
                .iter()
                .map(|&spring| (body.gaps[spring] - d).powi(2));
            let energy = 0.5 * body.foundation.spring_stiffness() * squares.sum::<f64>();
            let energy = f64::from(sign) * energy;
            prop_assert!(
                (jump.energy - energy).abs() <= 1e-14 * energy_scale,
                "{:?}, not {} J",
                jump,
                energy
            );
        }
        // At a fixed indentation the stored energy changes by the energy that springs gain or
        // release, and the force by their stretch. This holds unless fewer springs of other patches
        // change at the same indentation. Where edges slide between springs, they may move fast
        // just before a jump.
        let changed = after.springs.abs_diff(before.springs);
        let slack = if body.edges == Edges::Grid {
            1e-14
        } else {
            1e-6
        };
        if changed == jump.springs.unsigned_abs() {
            let stored = after.stored_energy - before.stored_energy;
            prop_assert!(
                (jump.energy - stored).abs() <= slack * energy_scale,
                "{:?}: {} J stored",
                jump,
                stored
            );
        }
        let fall = f64::from(sign) * (forces[0] - forces[1]);
        prop_assert!(fall >= -slack * force_scale, "{:?}: {:?}", jump, forces);
        prop_assert!(f64::from(sign) * jump.energy >= 0.0);
    }
    Ok(jumps.iter().map(|jump| jump.energy).sum())
}

/// Elastic energy that springs gain which attach or detach outside jumps, J: of whole springs.
fn slide_energy(body: &Body, stage: &Stage, low: f64, high: f64) -> f64 {
    let thresholds = stage.thresholds();
    let mut squares = 0.0;
    for (spring, (&d, gap)) in thresholds.iter().zip(&body.gaps).enumerate() {
        let jumps = || {
            let changes = changes(&thresholds, d);
            changes
                .iter()
                .any(|change| change.springs.contains(&spring))
        };
        if low < d && d <= high && !jumps() {
            squares += (gap - d).powi(2);
        }
    }
    let energy = 0.5 * body.foundation.spring_stiffness() * squares;
    match stage.direction() {
        Direction::Loading => energy,
        Direction::Unloading => -energy,
    }
}

fn indentations_of(jumps: &[Jump]) -> Vec<f64> {
    jumps.iter().map(|jump| jump.indentation).collect()
}

/// All jumps of a loading, stage after stage.
fn all_jumps(body: &Body, targets: &[Move]) -> Vec<Jump> {
    let mut jumps = Vec::new();
    load_body(&mut body.on(2), targets, |record, stage| {
        let [low, high] = record.passed();
        jumps.extend(stage.jumps(low, high)?);
        Ok(())
    })
    .unwrap();
    jumps
}

proptest! {
    #![proptest_config(cases(1500))]

    /// With one work of adhesion and with two, with reversals, minor loops and full contact.
    #[test]
    fn jumps_are_those_of_the_thresholds(body in bodies(60), drawn in targets(8)) {
        let mut solver = body.on(2);
        for drawn in drawn {
            let target = body.target(drawn, &solver);
            let Ok(record) = solver.advance(target) else {
                continue;
            };
            let [low, high] = record.passed();
            let stage = solver.stage();
            let jumped = compare(&body, &stage, low, high)?;
            if body.edges == Edges::Grid {
                let gained = jumped + slide_energy(&body, &stage, low, high);
                let [_, energy_scale] = body.scales();
                prop_assert!(
                    (gained + record.released_energy).abs() <= 1e-14 * energy_scale,
                    "{} J gained, {} J released", gained, record.released_energy
                );
            }
        }
    }

    #[test]
    fn a_divided_motion_has_the_same_jumps(
        body in bodies(200), deep in 0.2..1.2_f64, shares in prop::array::uniform2(0.0..1.0_f64),
    ) {
        let mut solver = body.on(2);
        for target in [Move::ToIndentation(deep), Move::ToSeparation] {
            let record = solver.advance(target).unwrap();
            let stage = solver.stage();
            let [low, high] = record.passed();
            let whole = stage.jumps(low, high).unwrap();
            let begin = stage.end().min(record.end());
            let mut cuts = shares.map(|share| begin + share * (high - begin));
            cuts.sort_by(f64::total_cmp);
            let mut parts = Vec::new();
            let mut ranges = vec![[low, cuts[0]], cuts, [cuts[1], high]];
            if stage.direction() == Direction::Unloading {
                ranges.reverse();
            }
            for [low, high] in ranges {
                parts.extend(stage.jumps(low, high).unwrap());
            }
            prop_assert_eq!(&parts, &whole);
            // A jump of any number of springs is a jump of the force.
            let of_force = stage.force_jumps(low, high, 0.0);
            prop_assert!(indentations_of(&whole).iter().all(|d| of_force.contains(d)));
        }
    }
}

const FOUNDATION: Foundation = Foundation::new(0.01, 1.0);

fn sphere(summit: i32, count: i32) -> Vec<f64> {
    (0..count)
        .map(|spring| f64::from(spring - summit).powi(2) * 1e-3)
        .collect()
}

#[test]
fn a_sphere_jumps_into_and_out_of_contact() {
    for edges in [Edges::Grid, Edges::SubCell] {
        let body = Body::new(sphere(50, 101), edges, FOUNDATION, 0.02);
        let jumps = all_jumps(&body, &[Move::ToIndentation(0.3), Move::ToSeparation]);
        let kinds: Vec<JumpKind> = jumps.iter().map(|jump| jump.kind).collect();
        assert_eq!(kinds, [JumpKind::Touches, JumpKind::Detaches]);
        let [touch, leave] = [jumps[0], jumps[1]];
        assert_eq!(
            (touch.indentation, touch.patches, leave.patches),
            (0.0, [0, 1], [1, 0])
        );
        assert_eq!(
            (touch.before, leave.after, touch.number, leave.number),
            (None, None, 0, 0)
        );
        assert!(touch.energy > 0.0 && leave.energy < 0.0 && leave.indentation < 0.0);
        assert_eq!(touch.springs as usize, touch.after.unwrap().springs().len());
    }
}

#[test]
fn two_equal_summits_jump_together_and_merge() {
    for edges in [Edges::Grid, Edges::SubCell] {
        let mut gaps = sphere(50, 101);
        gaps.extend(sphere(50, 101));
        let body = Body::new(gaps, edges, FOUNDATION, 0.02);
        let jumps = all_jumps(&body, &[Move::ToIndentation(2.4), Move::ToSeparation]);
        let kinds: Vec<JumpKind> = jumps.iter().map(|jump| jump.kind).collect();
        let both = JumpKind::Several { changes: 2 };
        assert_eq!(kinds[0], both);
        assert_eq!((jumps[0].patches, jumps[0].number), ([0, 2], 0));
        assert!(kinds.contains(&JumpKind::Merges { patches: 2 }));
        assert!(kinds.contains(&JumpKind::Splits { parts: 2 }));
        assert_eq!(
            (kinds.last(), jumps.last().unwrap().patches),
            (Some(&both), [2, 0])
        );
    }
}

#[test]
fn a_flat_punch_jumps_out_of_contact_only() {
    for edges in [Edges::Grid, Edges::SubCell] {
        let body = Body::new(vec![0.0; 64], edges, FOUNDATION, 0.02);
        let jumps = all_jumps(&body, &[Move::ToIndentation(0.1), Move::ToSeparation]);
        // All springs touch at d = 0, without a stretch, and detach at the largest stretch.
        let expected = 0.5 * FOUNDATION.spring_stiffness() * 64.0 * body.largest_stretch().powi(2);
        assert_eq!(
            (jumps.len(), jumps[0].energy, jumps[0].springs),
            (2, 0.0, 64)
        );
        assert!((jumps[1].energy / -expected - 1.0).abs() < 1e-12);
    }
}

#[test]
fn nothing_jumps_without_adhesion_or_with_few_springs() {
    let loading = [Move::ToIndentation(3.0), Move::ToSeparation];
    for edges in [Edges::Grid, Edges::SubCell] {
        for gaps in [sphere(50, 101), vec![0.0; 64], vec![0.0], vec![0.0, 1.0]] {
            let work = if gaps.len() > 2 { 0.0 } else { 0.02 };
            assert!(all_jumps(&Body::new(gaps, edges, FOUNDATION, work), &loading).is_empty());
        }
        // Nothing is touched.
        let body = Body::new(sphere(50, 101), edges, FOUNDATION, 0.02);
        assert!(all_jumps(&body, &[Move::ToIndentation(-0.2), Move::ToSeparation]).is_empty());
        assert!(all_jumps(&body, &[]).is_empty());
    }
}

#[test]
fn the_stepwise_solver_has_no_jumps() {
    let body = Body::new(sphere(50, 101), Edges::Grid, FOUNDATION, 0.02);
    let contact = body.contact();
    let mut solver = Stepwise::new(&contact, 0.01, 2, &|| false).unwrap();
    let record = solver.advance(Move::ToIndentation(0.3)).unwrap();
    let [low, high] = record.passed();
    assert_eq!(solver.stage().jumps(low, high), Err(ContactError::Stepwise));
}

/// Events of a loading, with the records of its stages.
fn events_of(
    contact: &Contact,
    targets: &[Move],
    least_share: f64,
    most: usize,
) -> (Events, Vec<StageRecord>) {
    let mut jumps = JumpCollector::default();
    let options = LoadOptions::default().samples(64).jumps(&mut jumps);
    let cycle = contact.load_with(targets, options).unwrap();
    let events = jumps.events(cycle.stages(), least_share, most).unwrap();
    (events, cycle.stages().to_vec())
}

proptest! {
    #![proptest_config(cases(700))]

    #[test]
    fn events_are_all_jumps_and_marks_in_order(
        body in bodies(150), stiff: bool, share in 0.0..0.5_f64, most in 1_usize..9,
    ) {
        let mut targets = body.tour();
        if !stiff {
            targets = vec![Move::ToDisplacement(0.3), Move::ToDisplacement(0.1), Move::ToSeparation];
        }
        let stiffness = if stiff { f64::INFINITY } else { 0.3 * body.stiffness() };
        let contact = body.under(stiffness);
        let (all, records) = events_of(&contact, &targets, 0.0, usize::MAX);
        let marks: Vec<Mark> = Mark::all(&records).iter().map(|marked| marked.mark).collect();
        let mut found: Vec<Mark> = all.list.iter().filter_map(|event| event.mark).collect();
        found.sort_by_key(|mark| marks.iter().position(|other| mark == other));
        prop_assert_eq!(found, marks);
        prop_assert_eq!(all.listed_jumps, all.jumps);
        let in_order = all.list.windows(2).all(|pair| {
            let loads = records[pair[0].stage].direction == Direction::Loading;
            let sign = if loads { 1.0 } else { -1.0 };
            let onward = sign * (pair[1].indentation - pair[0].indentation) >= 0.0;
            pair[0].stage < pair[1].stage || pair[0].stage == pair[1].stage && onward
        });
        prop_assert!(in_order, "{:?}", all.list);
        // The energies of all jumps are a part of those of the whole motion.
        let [_, slack] = body.scales().map(|scale| 1e-12 * scale);
        let energies = all.list.iter().filter_map(|event| event.jump).map(|jump| jump.energy);
        let energies: Vec<f64> = energies.collect();
        let whole = |direction: Direction| -> f64 {
            let stages = records.iter().filter(|stage| stage.direction == direction);
            stages.map(|stage| stage.released_energy).sum()
        };
        prop_assert!((all.gained - all.released - energies.iter().sum::<f64>()).abs() <= slack);
        prop_assert!(all.gained <= -whole(Direction::Loading) + slack);
        prop_assert!(all.released <= whole(Direction::Unloading) + slack);
        for (stage, record) in records.iter().enumerate() {
            let of_stage = all.list.iter().filter(|event| event.stage == stage);
            let jumps: Vec<InstrumentJump> =
                of_stage.filter_map(|event| event.instrument).collect();
            let lost: f64 = jumps.iter().map(|jump| jump.energy).sum();
            prop_assert!((lost - record.jump_energy).abs() <= slack, "{lost}: {record:?}");
        }

        let (few, _) = events_of(&contact, &targets, share, most);
        let largest = energies.iter().fold(0.0, |largest, energy| energy.abs().max(largest));
        let mut expected: Vec<f64> = energies.iter().map(|energy| energy.abs()).collect();
        expected.retain(|energy| *energy >= share * largest);
        expected.sort_by(|energy, other| other.total_cmp(energy));
        expected.truncate(most);
        let listed = few.list.iter().filter_map(|event| event.jump);
        let mut found: Vec<f64> = listed.map(|jump| jump.energy.abs()).collect();
        found.sort_by(|energy, other| other.total_cmp(energy));
        prop_assert_eq!((few.jumps, few.listed_jumps), (all.jumps, found.len()));
        prop_assert_eq!(found, expected);
    }
}

/// A loop that is repeated has each jump twice. A short list has the largest jumps, whatever stage
/// they are in.
#[test]
fn of_equal_jumps_no_larger_one_is_left_out() {
    // Ten flat asperities of different heights and lengths.
    let gaps = (0..150).map(|spring| {
        let asperity = spring / 15;
        let is_flat = spring % 15 < 3 + asperity * 3 % 10;
        0.004 * f64::from(asperity * 7 % 10) + if is_flat { 0.0 } else { 0.2 }
    });
    let body = Body::new(gaps.collect(), Edges::Grid, FOUNDATION, 0.002);
    let contact = body.contact();
    let once = [Move::ToIndentation(0.05), Move::ToSeparation];
    let targets = [once, once].concat();
    let energies = |events: &Events| -> Vec<f64> {
        let jumps = events.list.iter().filter_map(|event| event.jump);
        let mut energies: Vec<f64> = jumps.map(|jump| jump.energy.abs()).collect();
        energies.sort_by(|energy, other| other.total_cmp(energy));
        energies
    };
    let (all, _) = events_of(&contact, &targets, 0.0, usize::MAX);
    let all = energies(&all);
    assert!(all.len() > 8, "{}", all.len());
    for most in 0..=all.len() {
        let (few, _) = events_of(&contact, &targets, 0.0, most);
        assert_eq!(energies(&few), all[..most]);
    }
}

#[test]
fn the_stepwise_solver_has_no_events() {
    let body = Body::new(sphere(50, 101), Edges::Grid, FOUNDATION, 0.02);
    let contact = body.contact();
    let mut jumps = JumpCollector::default();
    let mut solver = Stepwise::new(&contact, 0.01, 2, &|| false).unwrap();
    let refused = load_body(&mut solver, &[Move::ToTouch], |record, stage| {
        jumps.observe(record, stage)
    });
    assert_eq!(refused, Err(ContactError::Stepwise));
    assert_eq!(jumps.events(&[], 0.0, 9), Ok(Events::default()));
}

/// A sphere on a soft instrument jumps into contact and out of it. The forces at both ends of each
/// jump are those of the contact, at the same displacement, and the energy is the area between the
/// line of the instrument and the curve of the contact, summed in small steps.
#[test]
fn a_compliant_instrument_jumps_where_its_line_meets_the_curve_again() {
    let body = Body::new(sphere(50, 101), Edges::SubCell, FOUNDATION, 0.02);
    let targets = [Move::ToDisplacement(0.3), Move::ToSeparation];
    for stiffness in [0.02, 0.1, 0.4] {
        let contact = body.under(stiffness);
        let (events, records) = events_of(&contact, &targets, 0.0, 9);
        let jumps: Vec<&Event> = events
            .list
            .iter()
            .filter(|event| event.instrument.is_some())
            .collect();
        assert_eq!(
            jumps.iter().map(|event| event.stage).collect::<Vec<_>>(),
            [0, 1],
            "{jumps:?}"
        );
        let mut stages = Vec::new();
        let mut mover = asperity_contact::motion::Body::new(&contact, 64);
        for &target in &targets {
            mover.advance(target).unwrap();
            stages.push(mover.stage());
        }
        for event in jumps {
            let jump = event.instrument.unwrap();
            let curve = |indentation: f64| stages[event.stage].point(indentation).unwrap().force;
            let line = |indentation: f64| stiffness * (jump.displacement - indentation);
            let largest = records[1].smallest.force.abs();
            // The sphere touches with a jump of its own, and loses the contact in the end.
            let ends = [(jump.from, event.forces[0]), (jump.to, event.forces[1])];
            for (index, (indentation, force)) in ends.into_iter().enumerate() {
                assert!((force - line(indentation)).abs() <= 1e-9 * largest);
                let is_free = event.stage == index;
                let expected = if is_free { 0.0 } else { curve(indentation) };
                assert!(
                    (force - expected).abs() <= 1e-6 * largest,
                    "k {stiffness}, stage {}, end {index}: {force}, not {expected}",
                    event.stage
                );
            }
            let steps = 20_000;
            let step = (jump.to - jump.from) / f64::from(steps);
            let area: f64 = (0..steps)
                .map(|index| jump.from + (f64::from(index) + 0.5) * step)
                .map(|indentation| (line(indentation) - curve(indentation)) * step)
                .sum();
            assert!(
                (jump.energy - area).abs() <= 1e-4 * area.abs(),
                "k {stiffness}, stage {}: {}, not {area}",
                event.stage,
                jump.energy
            );
        }
        assert!(records.iter().all(|record| record.jump_energy > 0.0));
    }
    let (events, _) = events_of(&body.contact(), &targets, 0.0, 9);
    assert!(events.list.iter().all(|event| event.instrument.is_none()));
}
