//! Loading: the indentation at which each part of the line closes, and the fragments between.

use super::edge_model::EdgeModel;
use super::levels::Levels;
use super::run::{Ground, Held, Run};
use super::span::{Span, larger, smaller};
use super::tree::{Branch, Node};
use crate::contact::{ContactError, push, resized};

/// Closing thresholds of the nodes of a tree.
///
/// A node closes, and all its subtree is one fragment, when one of its two branches attaches its spring:
/// s_v = min over branches u of max(s_u, φ on each span from u up to v).
#[derive(Clone, Debug, Default)]
pub struct Closing {
    /// Indentation at which each node closes on a loading from separation, m.
    closes: Vec<f64>,
    /// Springs that surely attach with each node; bounds that grow as the chains above the node are walked.
    known: Vec<[u32; 2]>,
    /// True if `closes` holds for the present line and rule.
    ready: bool,
    /// Thresholds that a loading from present fragments has replaced, in the order of the changes.
    replaced: Vec<(u32, f64)>,
    frames: Vec<Frame>,
    branches: Vec<Climb>,
}

/// A branch followed from its beginning upwards.
#[derive(Clone, Copy)]
struct Start {
    closes: f64,
    known: [u32; 2],
    gap: f64,
}

/// A node some of whose parts are in contact when a loading begins.
#[derive(Clone, Copy, Debug)]
struct Frame {
    node: u32,
    /// Range of the present fragments inside, and their number on the left of the node.
    held: [u32; 2],
    left: u32,
    is_open: bool,
}

/// A branch visited on the walk down from the root.
#[derive(Clone, Copy, Debug)]
struct Climb {
    branch: Branch,
    /// Indentation at which the branch merges into a larger fragment, m.
    merges: f64,
    /// Spring of the node above it.
    parent: usize,
    held: [u32; 2],
}

impl Closing {
    /// Forgets the line and the rule.
    pub fn forget(&mut self) {
        self.ready = false;
    }

    /// True once the nodes have been closed under the present rule.
    pub fn is_ready(&self) -> bool {
        self.ready
    }

    /// Closes all nodes on a loading from separation. Returns the evaluations of the rule.
    pub fn close<E: EdgeModel>(&mut self, ground: &Ground<'_, E>) -> Result<u64, ContactError> {
        while let Some((node, closes)) = self.replaced.pop() {
            self.closes[node as usize] = closes;
        }
        if self.ready {
            return Ok(0);
        }
        let count = ground.tree.node_count();
        self.closes = resized(std::mem::take(&mut self.closes), count, 0.0)?;
        self.known = resized(std::mem::take(&mut self.known), count, [0; 2])?;
        let square = ground.square();
        let mut evaluations = 0;
        for index in 0..count {
            let node = ground.tree.nodes()[index];
            let (rank, right) = (node.rank as usize, node.right as usize);
            let left = node.size as usize - 1 - right;
            let mut closes = f64::INFINITY;
            let mut known = [0; 2];
            let parts = [(left, index.saturating_sub(1 + right)), (right, index.saturating_sub(1))];
            for (side, (size, child)) in parts.into_iter().enumerate() {
                // Both kinds of branches are read: a choice would often be mispredicted.
                let place = ground.tree.turns()[2 * (rank + side)];
                let lowest = ground.gaps[place as usize];
                let (of_node, known_of_node) = (self.closes[child], self.known[child]);
                let is_leaf = size == 0;
                let closed = if is_leaf { lowest } else { of_node };
                let mut reach = if is_leaf { [place; 2] } else { known_of_node };
                let need = node.gap - closed;
                let taken = if need * need <= square * E::least_length(reach[0] as usize, reach[1] as usize) {
                    closed
                } else {
                    let gap = if is_leaf { closed } else { ground.tree.nodes()[child].gap };
                    let start = Start { closes: closed, known: reach, gap };
                    let (taken, walked) = ground.climb(start, ground.tree.maximum(&node), &mut evaluations);
                    reach = walked;
                    if !is_leaf {
                        self.known[child] = walked;
                    }
                    taken
                };
                known[side] = reach[side];
                closes = smaller(closes, taken);
            }
            self.closes[index] = closes;
            self.known[index] = known;
        }
        self.ready = true;
        Ok(evaluations)
    }

    /// Closes the nodes around fragments in contact (from left to right) when a loading begins, and no others.
    pub fn close_around<E: EdgeModel>(
        &mut self,
        ground: &Ground<'_, E>,
        held: &[Held],
    ) -> Result<u64, ContactError> {
        let mut evaluations = self.close(ground)?;
        let (mut frames, count) = (std::mem::take(&mut self.frames), held.len() as u32);
        frames.clear();
        let enter = |branch: Branch, range: [u32; 2], frames: &mut Vec<Frame>| {
            let is_present = range[1] - range[0] == 1 && held[range[0] as usize].branch == branch;
            if let (Ok(node), false) = (branch.origin(), is_present || range[0] == range[1]) {
                frames.push(Frame { node: node as u32, held: range, left: 0, is_open: false });
            }
        };
        enter(ground.tree.root(), [0, count], &mut frames);
        while let Some(frame) = frames.last_mut() {
            let index = frame.node as usize;
            let node = ground.tree.nodes()[index];
            let place = ground.tree.maximum(&node);
            let parts = ground.tree.parts(index);
            if !frame.is_open {
                let [begin, end] = frame.held;
                let inside = &held[begin as usize..end as usize];
                let middle = begin + inside.partition_point(|held| (held.first as usize) < place) as u32;
                (frame.is_open, frame.left) = (true, middle);
                enter(parts[0], [begin, middle], &mut frames);
                enter(parts[1], [middle, end], &mut frames);
                continue;
            }
            let ranges = [[frame.held[0], frame.left], [frame.left, frame.held[1]]];
            let mut closes = f64::INFINITY;
            for (part, range) in parts.into_iter().zip(ranges) {
                let start = self.start(ground, part, held_on(held, range, part));
                let (taken, _) = ground.climb(start, place, &mut evaluations);
                closes = smaller(closes, taken);
            }
            self.replaced.push((index as u32, self.closes[index]));
            self.closes[index] = closes;
            frames.pop();
        }
        self.frames = frames;
        Ok(evaluations)
    }

    /// Beginning of a branch: a fragment in contact, else the span at which the branch closes.
    fn start<E: EdgeModel>(&self, ground: &Ground<'_, E>, branch: Branch, held: Option<&Held>) -> Start {
        if let Some(held) = held {
            let known = [held.first, held.last];
            return Start { closes: f64::NEG_INFINITY, known, gap: ground.span(branch, known).gap };
        }
        match branch.origin() {
            Ok(node) => {
                let gap = ground.tree.nodes()[node].gap;
                Start { closes: self.closes[node], known: self.known[node], gap }
            }
            Err(rank) => {
                let place = ground.tree.minimum(rank);
                let gap = ground.gaps[place];
                Start { closes: gap, known: [place as u32; 2], gap }
            }
        }
    }

    /// Lists the runs of a loading from these fragments in contact (from left to right) in place of `runs`. Returns the
    /// smallest indentation of full contact, m.
    pub fn list<E: EdgeModel>(
        &mut self,
        ground: &Ground<'_, E>,
        held: &[Held],
        runs: &mut Vec<Run>,
        evaluations: &mut u64,
    ) -> Result<f64, ContactError> {
        runs.clear();
        let mut branches = std::mem::take(&mut self.branches);
        branches.clear();
        let nowhere = usize::MAX;
        let all = [0, held.len() as u32];
        branches.push(Climb {
            branch: ground.tree.root(),
            merges: f64::INFINITY,
            parent: nowhere,
            held: all,
        });
        let mut complete = f64::NEG_INFINITY;
        while let Some(climb) = branches.pop() {
            let Climb { branch, merges, .. } = climb;
            let state = held_on(held, climb.held, branch);
            let start = self.start(ground, branch, state);
            let node = branch.origin().ok().map(|index| (index, ground.tree.nodes()[index]));
            let lowest = node.map_or(start.gap, |(_, node)| node.lowest);
            // What is in contact already stays so, however far it is stretched.
            if lowest >= merges && climb.held[0] == climb.held[1] {
                continue;
            }
            if start.closes < merges {
                let pin = state.and_then(|held| held.pin);
                self.climb_and_list(ground, &climb, (start, pin), runs, &mut complete, evaluations)?;
            }
            if let (Some((index, node)), None) = (node, state) {
                let merges = smaller(start.closes, merges);
                let parent = ground.tree.maximum(&node);
                let [begin, end] = climb.held;
                let inside = &held[begin as usize..end as usize];
                let middle = begin + inside.partition_point(|held| (held.first as usize) < parent) as u32;
                let parts = ground.tree.parts(index).into_iter().zip([[begin, middle], [middle, end]]);
                for (branch, held) in parts {
                    push(&mut branches, Climb { branch, merges, parent, held }, ground.gaps.len())?;
                }
            }
        }
        self.branches = branches;
        Ok(complete)
    }

    /// Lists the runs of one branch, the largest first; the edges of a fragment in contact may be pinned at a rise, m.
    fn climb_and_list<E: EdgeModel>(
        &self,
        ground: &Ground<'_, E>,
        climb: &Climb,
        (start, mut pin): (Start, Option<f64>),
        runs: &mut Vec<Run>,
        complete: &mut f64,
        evaluations: &mut u64,
    ) -> Result<(), ContactError> {
        let gaps = ground.gaps;
        let square = ground.square();
        let known = (start.known[0] as usize, start.known[1] as usize);
        let mut span = Span::around(gaps, known, start.gap);
        let mut closes = start.closes;
        let listed = runs.len();
        // The levels of the span below, while its run may go on.
        let mut below: Option<Levels> = None;
        loop {
            let Some(wall) = span.wall(gaps) else {
                *complete = closes;
                if closes < climb.merges {
                    push(runs, Run::new(climb.branch, &span, closes, climb.merges), gaps.len())?;
                }
                break;
            };
            let need = gaps[wall] - closes;
            let mut attaches = closes;
            if need * need > square * E::least_length(span.first, span.last) {
                *evaluations += 1;
                let levels = ground.levels(&span);
                attaches = larger(closes, ground.attachment(&levels, gaps[wall]));
                let end = smaller(attaches, climb.merges);
                if let Some(rise) = pin.take() {
                    let released = smaller(levels.release(ground.stretch, rise).0, end);
                    push(runs, Run::pinned(climb.branch, &span, rise, closes, released), gaps.len())?;
                    closes = released;
                }
                if closes < end {
                    match (runs.last_mut(), below) {
                        (Some(run), Some(lower)) if ground.slides_on(&lower, &levels) => {
                            run.raise(&span, end)
                        }
                        _ => push(runs, Run::new(climb.branch, &span, closes, end), gaps.len())?,
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

/// The fragment in contact on a branch itself, not in a part of it, among these.
fn held_on(held: &[Held], [begin, end]: [u32; 2], branch: Branch) -> Option<&Held> {
    held.get(begin as usize).filter(|held| end - begin == 1 && held.branch == branch)
}

impl<E: EdgeModel> Ground<'_, E> {
    /// Largest φ from the beginning of a branch up to the spring `parent`, not below its own threshold; and the springs
    /// that the branch surely holds at its lowest span.
    ///
    /// No φ below a gap b exceeds b − s√n with n cells known inside, so that most chains need no evaluation.
    #[inline(never)]
    fn climb(&self, start: Start, parent: usize, evaluations: &mut u64) -> (f64, [u32; 2]) {
        let gaps = self.gaps;
        let square = self.square();
        let may_rise = |closes: f64, gap: f64, span: &Span| {
            let need = gap - closes;
            need > 0.0 && need * need > square * E::least_length(span.first, span.last)
        };
        let known = (start.known[0] as usize, start.known[1] as usize);
        let mut span = Span::around(gaps, known, start.gap);
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

    /// The largest span of a branch, with the spring `parent` next to it.
    fn below(&self, span: &Span, parent: usize) -> Span {
        let (gaps, wall) = (self.gaps, self.gaps[parent]);
        let Span { gap, mut first, mut last } = *span;
        if parent > last {
            last = parent - 1;
            while first > 0 && gaps[first - 1] < wall {
                first -= 1;
            }
        } else {
            first = parent + 1;
            while last + 1 < gaps.len() && gaps[last + 1] <= wall {
                last += 1;
            }
        }
        Span { gap: larger(gap, larger(gaps[first], gaps[last])), first, last }
    }
}

/// Gap and lowest gap of a node are read together.
const _: () = assert!(size_of::<Node>() == 32);
