//! Whole springs against blind relaxation of the rules, independent of the library, after any
//! history.

use super::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Far above the rounding of a threshold, far below the distance between two, m.
const ROUNDING: f64 = 1e-9;

/// A foundation that knows only the rules: it tries any spring in any order until no rule applies.
#[derive(Clone)]
struct Blind<'a> {
    body: &'a Body,
    contact: Vec<bool>,
    order: Order,
    /// The springs in the order of a round.
    springs: Vec<usize>,
}

/// The order in which blind relaxation tries the springs.
#[derive(Clone, Copy, Debug)]
enum Order {
    /// Steps of this many springs, around and around.
    Stride(usize),
    RightToLeft,
    /// From both ends to the middle.
    Inwards,
    /// Shuffled anew for each round.
    Shuffled(u64),
}

impl<'a> Blind<'a> {
    /// Separated springs.
    fn new(body: &'a Body, order: Order) -> Self {
        let count = body.gaps.len();
        let mut springs: Vec<usize> = (0..count).collect();
        match order {
            Order::Stride(stride) => springs.sort_by_key(|index| (index % stride, *index)),
            Order::RightToLeft => springs.reverse(),
            Order::Inwards => springs.sort_by_key(|index| (*index).min(count - 1 - index)),
            Order::Shuffled(_) => {}
        }
        Blind {
            body,
            contact: vec![false; count],
            order,
            springs,
        }
    }

    /// Largest stretch of this number of springs under a work of adhesion, m.
    fn stretch(&self, springs: usize, work: f64) -> f64 {
        let Foundation {
            spacing, modulus, ..
        } = self.body.foundation;
        (PI * springs as f64 * spacing * (work / modulus)).sqrt()
    }

    /// Springs in the run of contact to the left and to the right of a spring.
    fn beside(&self, index: usize) -> [usize; 2] {
        let left = self.contact[..index]
            .iter()
            .rev()
            .take_while(|&&c| c)
            .count();
        let right = self.contact[index + 1..].iter().take_while(|&&c| c).count();
        [left, right]
    }

    /// Applies a rule to this spring; returns false if none applies.
    fn apply(&mut self, index: usize, d: f64) -> bool {
        let gap = self.body.gaps[index];
        let applies = if self.contact[index] {
            gap > d && {
                let [left, right] = self.beside(index);
                let run = &self.body.gaps[index - left..=index + right];
                gap - d >= self.stretch(run.len(), self.body.work)
                    && run.iter().all(|other| *other <= gap)
            }
        } else {
            let grows = |&n: &usize| n > 0 && gap - d <= self.stretch(n, self.body.closing_work);
            gap <= d || self.beside(index).iter().any(grows)
        };
        self.contact[index] ^= applies;
        applies
    }

    /// Relaxes at indentation d.
    fn relax(&mut self, d: f64) {
        let mut springs = std::mem::take(&mut self.springs);
        let mut quiet = false;
        while !quiet {
            if let Order::Shuffled(state) = &mut self.order {
                for last in (1..springs.len()).rev() {
                    *state = state
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1);
                    springs.swap(last, (*state >> 33) as usize % (last + 1));
                }
            }
            quiet = true;
            for &index in &springs {
                quiet &= !self.apply(index, d);
            }
        }
        self.springs = springs;
    }

    fn relaxed(&self, d: f64) -> Self {
        let mut there = self.clone();
        there.relax(d);
        there
    }

    fn patches(&self) -> Vec<Patch> {
        Patch::of_springs(self.contact.iter().copied())
    }
}

fn order() -> impl Strategy<Value = Order> {
    prop_oneof![
        2 => (1_usize..50).prop_map(Order::Stride),
        1 => Just(Order::Stride(1)),
        1 => Just(Order::RightToLeft),
        1 => Just(Order::Inwards),
        2 => any::<u64>().prop_map(Order::Shuffled),
    ]
}

/// Numbers of compared contact states, of springs in them, and of refused stages.
static COMPARED: [AtomicU64; 3] = [const { AtomicU64::new(0) }; 3];

fn count(index: usize, number: usize) {
    COMPARED[index].fetch_add(number as u64, Ordering::Relaxed);
}

/// Moves a body and its blind relaxation to targets and compares them at probes on the way, which
/// are shares of it.
fn compare(
    body: &Body,
    order: Order,
    drawn: &[((Move, bool), Vec<f64>)],
) -> Result<(), TestCaseError> {
    let (mut solver, mut blind) = (body.on(2), Blind::new(body, order));
    let agree = |solver: &contact::motion::Body, blind: &Blind, d: f64| {
        prop_assert_eq!(solver.stage().patches(d), blind.patches(), "at {}", d);
        count(0, 1);
        count(1, body.gaps.len());
        Ok(())
    };
    for (drawn, probes) in drawn {
        let present = solver.point().indentation;
        let target = body.target(*drawn, &solver);
        let record = match solver.advance(target) {
            Ok(record) => record,
            Err(ContactError::NothingToPull | ContactError::DetachesBefore { .. }) => {
                // The body has not moved. The stage of a separation still has the contact of its
                // end.
                if blind.contact.contains(&true) {
                    agree(&solver, &blind, present)?;
                }
                count(2, 1);
                continue;
            }
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        let end = end(&record);
        // A separated body that stays may be at d = 0, just before first touch.
        let stays = record.curve.len() == 1;
        let separates = target == Move::ToSeparation;
        // Separation ends just where the last springs still hold: to rounding, the blind relaxation
        // may be on either side of it. Elsewhere both are at the same number.
        let to = if separates {
            (end.indentation + ROUNDING).min(present)
        } else {
            end.indentation
        };
        for probe in probes.iter().filter(|_| !stays) {
            let d = present + probe * (to - present);
            agree(&solver, &blind.relaxed(d), d)?;
        }
        if separates {
            if to < present {
                blind.relax(to);
                prop_assert!(blind.contact.contains(&true), "detached before {}", to);
                agree(&solver, &blind, to)?;
            }
            blind.relax(end.indentation - ROUNDING);
        } else {
            blind.relax(to);
            agree(&solver, &blind, to)?;
        }
        let patches = blind.patches();
        let counts = (indices(&patches).len() as u64, patches.len() as u64);
        prop_assert_eq!(
            (end.springs, end.patches),
            counts,
            "at the end of {:?}",
            target
        );
    }
    Ok(())
}

/// Histories of a whole run.
const HISTORIES: u32 = 12_000;

proptest! {
    #![proptest_config(cases(HISTORIES))]

    fn any_history(
        body in prop_oneof![8 => whole_springs(40), 1 => whole_springs(300)],
        order in order(),
        drawn in prop::collection::vec((any_target(), prop::collection::vec(0.001..1.0_f64, 0..8)), 1..=8),
    ) {
        compare(&body, order, &drawn)?;
    }
}

#[test]
fn contact_states_agree_with_blind_relaxation() {
    any_history();
    let [states, springs, refused] = COMPARED
        .each_ref()
        .map(|count| count.load(Ordering::Relaxed));
    println!("{states} contact states, {springs} states of springs, {refused} stages refused");
    let histories = u64::from(cases(HISTORIES).cases);
    assert!(states >= 12 * histories && springs >= 330 * histories && refused >= histories / 24);
}

/// At its threshold a spring beside a patch attaches, and a spring held by no more than Δl_max
/// detaches.
#[test]
fn springs_change_at_the_threshold_itself() {
    for (wall, work) in [(0.5, 0.3), (0.7, 1e-3), (0.9, 2.0)] {
        let body = Body::new(
            vec![0.0, wall],
            Edges::Grid,
            Foundation::new(0.01, 1.0),
            work,
        );
        let stretch = |springs| body.foundation.largest_stretch(work, springs);
        let springs = |turns: &[f64]| {
            end(body
                .history(&to_indentations(turns), 2)
                .stages
                .last()
                .unwrap())
            .springs
        };
        let attaches = wall - stretch(1);
        assert_eq!(
            [attaches.next_down(), attaches].map(|d| springs(&[d])),
            [1, 2]
        );
        let detaches = wall - stretch(2);
        assert_eq!(
            [detaches.next_up(), detaches].map(|d| springs(&[1.0, d])),
            [2, 1]
        );
        let separates = -stretch(1);
        assert_eq!(
            [separates.next_up(), separates].map(|d| springs(&[0.0, d])),
            [1, 0]
        );
    }
}
