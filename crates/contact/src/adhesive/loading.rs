//! Loading: finds the indentation at which each node of the contact tree closes, and lists the
//! patches between these events.

use super::levels::{Levels, Span, larger, smaller};
use super::run::{Ground, Held, Listed, Run};
use super::tree::{Branch, Node};
use crate::error::ContactError;
use asperity_data::{gathered, push, resized};
use std::borrow::Cow;

/// Closing thresholds of the nodes of a contact tree, for a loading from separation.
///
/// A node closes when one of its two branches attaches the spring of the node. All springs of its
/// subtree are then one patch. The threshold of node v is s_v = min over its branches u of max(s_u,
/// φ on each span from u up to v), with φ of the module `run`.
#[derive(Debug)]
pub struct Closing {
    /// Indentation in m at which each node closes.
    closes: Vec<f64>,
    /// First and last spring that certainly attach with each node. The range widens while the
    /// branches above are walked.
    known: Vec<[u32; 2]>,
    pub evaluations: u64,
}

/// A loading that begins with patches in contact.
struct Loading<'a, const SLIDES: bool> {
    ground: &'a Ground<'a, SLIDES>,
    held: &'a [Held],
    closes: Cow<'a, [f64]>,
    known: &'a [[u32; 2]],
    listed: Listed,
}

/// Beginning of a branch, from which the branch is followed upwards.
#[derive(Clone, Copy)]
struct Start {
    closes: f64,
    known: [u32; 2],
    gap: f64,
}

/// A branch visited on the walk down from the root.
#[derive(Clone, Copy, Debug)]
struct Climb {
    branch: Branch,
    /// Indentation in m at which the branch merges into a larger patch.
    merges: f64,
    parent: usize,
    held: [usize; 2],
}

impl Closing {
    pub fn new<const SLIDES: bool>(ground: &Ground<'_, SLIDES>) -> Result<Self, ContactError> {
        let count = ground.tree.node_count();
        let mut closing = Closing {
            closes: resized(Vec::new(), count, 0.0)?,
            known: resized(Vec::new(), count, [0; 2])?,
            evaluations: 0,
        };
        let square = ground.square();
        for index in 0..count {
            let node = ground.tree.nodes[index];
            let (rank, right) = (node.rank as usize, node.right as usize);
            let left = node.size as usize - 1 - right;
            let mut closes = f64::INFINITY;
            let mut known = [0; 2];
            let parts = [
                (left, index.saturating_sub(1 + right)),
                (right, index.saturating_sub(1)),
            ];
            for (side, (size, child)) in parts.into_iter().enumerate() {
                // Both kinds of branches are read: a choice would often be mispredicted.
                let place = ground.tree.turns[2 * (rank + side)];
                let lowest = ground.gaps[place as usize];
                let (of_node, known_of_node) = (closing.closes[child], closing.known[child]);
                let is_leaf = size == 0;
                let closed = if is_leaf { lowest } else { of_node };
                let mut reach = if is_leaf { [place; 2] } else { known_of_node };
                let need = node.gap - closed;
                let taken = if need * need
                    <= square * ground.least_length(reach[0] as usize, reach[1] as usize)
                {
                    closed
                } else {
                    let gap = if is_leaf {
                        closed
                    } else {
                        ground.tree.nodes[child].gap
                    };
                    let start = Start {
                        closes: closed,
                        known: reach,
                        gap,
                    };
                    let place = ground.tree.maximum(&node);
                    let (taken, walked) = ground.climb(start, place, &mut closing.evaluations);
                    reach = walked;
                    if !is_leaf {
                        closing.known[child] = walked;
                    }
                    taken
                };
                known[side] = reach[side];
                closes = smaller(closes, taken);
            }
            closing.closes[index] = closes;
            closing.known[index] = known;
        }
        Ok(closing)
    }

    /// Lists the runs of a loading in the order of [`Run`], from right to left. `held` are the
    /// patches in contact at its beginning.
    pub fn list<const SLIDES: bool>(
        &self,
        ground: &Ground<'_, SLIDES>,
        held: &[Held],
    ) -> Result<Listed, ContactError> {
        let mut closes = Cow::Borrowed(self.closes.as_slice());
        if !held.is_empty() {
            closes = Cow::Owned(gathered(self.closes.len(), self.closes.iter().copied())?);
        }
        let listed = Listed {
            runs: Vec::new(),
            end: f64::NEG_INFINITY,
            evaluations: 0,
        };
        let mut loading = Loading {
            ground,
            held,
            closes,
            known: &self.known,
            listed,
        };
        loading.close_around()?;
        loading.list()?;
        Ok(loading.listed)
    }
}

impl<const SLIDES: bool> Loading<'_, SLIDES> {
    /// Splits the range `begin..end` of held patches into the patches left and right of a spring.
    fn split(&self, [begin, end]: [usize; 2], spring: usize) -> [[usize; 2]; 2] {
        let inside = &self.held[begin..end];
        let middle = begin + inside.partition_point(|held| (held.first as usize) < spring);
        [[begin, middle], [middle, end]]
    }

    /// Returns the held patch of the range `begin..end` that lies on this very branch, not on a
    /// branch below it.
    fn held_on(&self, [begin, end]: [usize; 2], branch: Branch) -> Option<&Held> {
        self.held
            .get(begin)
            .filter(|held| end - begin == 1 && held.branch == branch)
    }

    /// Finds when the nodes around held patches close. All other nodes close as on a loading from
    /// separation.
    fn close_around(&mut self) -> Result<(), ContactError> {
        let tree = self.ground.tree;
        let mut waiting = vec![(tree.root(), [0, self.held.len()])];
        let mut around = Vec::new();
        // A node comes before those in its parts.
        while let Some((branch, held)) = waiting.pop() {
            if let (Ok(node), None, true) = (
                branch.origin(),
                self.held_on(held, branch),
                held[0] < held[1],
            ) {
                let parts = tree
                    .parts(node)
                    .into_iter()
                    .zip(self.split(held, tree.maximum(&tree.nodes[node])));
                for part in parts.clone() {
                    push(&mut waiting, part)?;
                }
                push(&mut around, (node, held))?;
            }
        }
        for (node, held) in around.into_iter().rev() {
            let place = tree.maximum(&tree.nodes[node]);
            let mut closes = f64::INFINITY;
            for (part, held) in tree.parts(node).into_iter().zip(self.split(held, place)) {
                let start = self.start(part, self.held_on(held, part));
                let (taken, _) = self
                    .ground
                    .climb(start, place, &mut self.listed.evaluations);
                closes = smaller(closes, taken);
            }
            self.closes.to_mut()[node] = closes;
        }
        Ok(())
    }

    /// Returns the beginning of a branch: the patch held on the branch, or else the span at which
    /// the branch closes.
    fn start(&self, branch: Branch, held: Option<&Held>) -> Start {
        let Ground { tree, gaps, .. } = *self.ground;
        if let Some(held) = held {
            let known = [held.first, held.last];
            return Start {
                closes: f64::NEG_INFINITY,
                known,
                gap: self.ground.span(branch, known).gap,
            };
        }
        match branch.origin() {
            Ok(node) => Start {
                closes: self.closes[node],
                known: self.known[node],
                gap: tree.nodes[node].gap,
            },
            Err(rank) => {
                let place = tree.minimum(rank);
                Start {
                    closes: gaps[place],
                    known: [place as u32; 2],
                    gap: gaps[place],
                }
            }
        }
    }

    /// Lists the runs of the loading, and finds the smallest indentation of full contact in m.
    fn list(&mut self) -> Result<(), ContactError> {
        let tree = self.ground.tree;
        let held = [0, self.held.len()];
        let mut branches = vec![Climb {
            branch: tree.root(),
            merges: f64::INFINITY,
            parent: usize::MAX,
            held,
        }];
        while let Some(climb) = branches.pop() {
            let Climb {
                branch,
                merges,
                held,
                ..
            } = climb;
            let state = self.held_on(held, branch).copied();
            let start = self.start(branch, state.as_ref());
            let node = branch.origin().ok().map(|index| (index, tree.nodes[index]));
            let lowest = node.map_or(start.gap, |(_, node)| node.lowest);
            // What is in contact already stays so, however far it is stretched.
            if lowest >= merges && held[0] == held[1] {
                continue;
            }
            if start.closes < merges {
                self.climb(&climb, start, state.and_then(|held| held.pin))?;
            }
            if let (Some((index, node)), None) = (node, state) {
                let merges = smaller(start.closes, merges);
                let parent = tree.maximum(&node);
                for (branch, held) in tree.parts(index).into_iter().zip(self.split(held, parent)) {
                    push(
                        &mut branches,
                        Climb {
                            branch,
                            merges,
                            parent,
                            held,
                        },
                    )?;
                }
            }
        }
        Ok(())
    }

    /// Lists the runs of one branch, the largest first. `pin` is the height in m of the pinned
    /// edges of a held patch above its largest gap.
    fn climb(
        &mut self,
        climb: &Climb,
        start: Start,
        mut pin: Option<f64>,
    ) -> Result<(), ContactError> {
        let (
            ground,
            Listed {
                runs,
                end: complete,
                evaluations,
            },
        ) = (self.ground, &mut self.listed);
        let gaps = ground.gaps;
        let square = ground.square();
        let mut span = ground.lowest(start);
        let mut closes = start.closes;
        let listed = runs.len();
        // The levels of the span below, while its run may go on.
        let mut below: Option<Levels> = None;
        loop {
            let Some(wall) = span.wall(gaps) else {
                *complete = closes;
                if closes < climb.merges {
                    push(runs, Run::new(climb.branch, &span, closes, climb.merges))?;
                }
                break;
            };
            let need = gaps[wall] - closes;
            let mut attaches = closes;
            if need * need > square * ground.least_length(span.first, span.last) {
                *evaluations += 1;
                let levels = ground.levels(&span);
                attaches = larger(closes, ground.attachment(&levels, gaps[wall]));
                let end = smaller(attaches, climb.merges);
                if let Some(rise) = pin.take() {
                    let released = smaller(levels.release(ground.stretch, rise).0, end);
                    push(
                        runs,
                        Run {
                            pin: rise,
                            ..Run::new(climb.branch, &span, closes, released)
                        },
                    )?;
                    closes = released;
                }
                if closes < end {
                    match (runs.last_mut(), below) {
                        (Some(run), Some(lower)) if ground.slides_on(&lower, &levels) => {
                            (run.to, run.top) = (end, span.ends());
                        }
                        _ => push(runs, Run::new(climb.branch, &span, closes, end))?,
                    }
                    below = Some(levels);
                } else {
                    below = None;
                }
            } else {
                below = None;
            }
            if wall == climb.parent || attaches >= climb.merges {
                break;
            }
            span = span.with(gaps, wall);
            closes = attaches;
        }
        runs[listed..].reverse();
        Ok(())
    }
}

impl<const SLIDES: bool> Ground<'_, SLIDES> {
    /// Returns the largest φ (m) of a branch from its beginning up to the spring `parent`, but at
    /// least the threshold of the branch. Also returns the first and the last spring that the
    /// branch certainly holds at its smallest span.
    ///
    /// On a span with n cells known inside, φ at a gap b is at most b − s√n. Most spans therefore
    /// need no evaluation.
    #[inline(never)]
    fn climb(&self, start: Start, parent: usize, evaluations: &mut u64) -> (f64, [u32; 2]) {
        let gaps = self.gaps;
        let square = self.square();
        let may_rise = |closes: f64, gap: f64, span: &Span| {
            let need = gap - closes;
            need > 0.0 && need * need > square * self.least_length(span.first, span.last)
        };
        let mut span = self.lowest(start);
        let ends = span.ends();
        let mut closes = start.closes;
        // At the top first: φ is mostly largest there.
        let top = self.below(&span, parent);
        if may_rise(closes, gaps[parent], &top) {
            *evaluations += 1;
            closes = larger(closes, self.attaches_at(&top, gaps[parent]));
        }
        if !may_rise(closes, top.gap, &span) {
            return (closes, ends);
        }
        span = span.up_to(gaps, self.sure_level(&span, closes), top.ends());
        while let Some(wall) = span.wall(gaps).filter(|&wall| wall != parent) {
            if may_rise(closes, gaps[wall], &span) {
                *evaluations += 1;
                closes = larger(closes, self.attaches_at(&span, gaps[wall]));
            }
            span = span.with(gaps, wall);
        }
        (closes, ends)
    }

    /// Returns the smallest span of a branch, around the springs that attach at its beginning.
    #[inline]
    fn lowest(&self, Start { gap, known, .. }: Start) -> Span {
        let [mut first, mut last] = known.map(|spring| spring as usize);
        while first > 0 && self.gaps[first - 1] < gap {
            first -= 1;
        }
        while last + 1 < self.gaps.len() && self.gaps[last + 1] <= gap {
            last += 1;
        }
        Span { gap, first, last }
    }

    /// Returns the largest span of a branch, which ends beside the spring `parent`.
    fn below(&self, span: &Span, parent: usize) -> Span {
        let (at, end) = (parent as u32, self.gaps.len() as u32 - 1);
        if parent > span.last {
            Span {
                last: parent - 1,
                ..*span
            }
            .up_to(self.gaps, self.gaps[parent], [0, at - 1])
        } else {
            Span {
                first: parent + 1,
                ..*span
            }
            .up_to(self.gaps, self.gaps[parent], [at + 1, end])
        }
    }
}

/// A node fits half a cache line, so that its gap and its lowest gap are read together.
const _: () = assert!(size_of::<Node>() == 32);
