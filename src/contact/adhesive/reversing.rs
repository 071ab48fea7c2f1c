//! Unloadings from ever deeper turning points of one loading, each derived from the previous one.
//!
//! Inside a fragment of the loading nothing depends on the turning point: a span parts at the smallest indentation that
//! holds any of the spans around it in the fragment. A deeper turning point lengthens fragments and merges them, which
//! caps the indentations of everything inside. So the runs of the next unloading are those of the last one, less those
//! beyond the cap, and the runs of the spans that are new; the line between is walked once for all reversals.

use super::dissipation::Range;
use super::edge_model::EdgeModel;
use super::levels::Levels;
use super::run::{Ground, Held, Run};
use super::span::Span;
use super::tree::Branch;
use super::unloading::{Descent, Opened, Part};
use crate::contact::contact_model::Reversed;
use crate::contact::grid::CompensatedSum;
use crate::contact::{ContactError, push, reserve, resized};
use std::mem::take;
use std::ops::Range as Indices;

/// A fragment at the turning point and the runs of its unloading.
#[derive(Clone, Copy, Debug)]
struct Listed {
    branch: Branch,
    ends: [u32; 2],
    /// Range of its runs in the list.
    runs: [usize; 2],
    /// True if its runs do not depend on the turning point.
    is_whole: bool,
}

/// Squares of the stretches over which the springs of a run detach, m²; see [`Ground::squared_stretch`].
#[derive(Clone, Copy, Debug, Default)]
struct Detaching {
    /// Three times the squares over the stretch of the line that detaches at once when the run parts, once known.
    jump: Option<CompensatedSum>,
    /// Squares over the springs that detach while the run passes from span to span, from its smallest span up to this
    /// one.
    slide: Option<(CompensatedSum, [u32; 2])>,
}

/// One unloading: its fragments and their runs.
#[derive(Clone, Debug, Default)]
struct Unloading {
    fragments: Vec<Listed>,
    runs: Vec<Run>,
    detaching: Vec<Detaching>,
}

/// The unloading from the present turning point, and the input of the next one.
#[derive(Clone, Debug, Default)]
pub struct Reversing {
    present: Unloading,
    before: Unloading,
    /// Fragments of the unloading before that the list has passed.
    passed: usize,
    /// Span that each run of the loading fills at the present turning point, or its smallest one.
    spans: Vec<[u32; 2]>,
    /// Squares of the stretches of attachments up to each turning point: three times those of attachments at once, and
    /// those of the runs that have ended there.
    attached: Vec<[CompensatedSum; 2]>,
    parts: Vec<Part>,
}

impl Reversing {
    /// Begins with a loading from separation and its turning points, m, in ascending order.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn begin<E: EdgeModel>(
        &mut self,
        loading: &Ground<'_, E>,
        runs: &[Run],
        turns: &[f64],
    ) -> Result<(), ContactError> {
        *self = Reversing::default();
        self.spans = reserve(runs.len())?;
        self.spans.extend(runs.iter().map(|run| run.bottom));
        self.attached = resized(Vec::new(), turns.len(), [CompensatedSum::default(); 2])?;
        let Some(&high) = turns.last() else { return Ok(()) };
        let range = Range { low: f64::NEG_INFINITY, high, unloading: false };
        let place = |at: f64| turns.partition_point(|&turn| turn < at);
        let attached = &mut self.attached;
        loading.each_change(
            runs,
            range,
            |_| {},
            |stretch| {
                attached[place(stretch.at)][0].add(loading.edges.squared_stretch(loading.gaps, &stretch))
            },
        );
        if E::SLIDES {
            for run in runs.iter().filter(|run| run.to <= high) {
                let ends = loading.ends_of(run, range);
                attached[place(run.to)][1].add(loading.edges.squared_stretch_sliding(loading.gaps, ends));
            }
        } else {
            loading.each_spring_of_chains(runs, false, |spring, at| {
                if at <= high {
                    let stretch = loading.gaps[spring] - at;
                    attached[place(at)][1].add(stretch * stretch);
                }
            });
        }
        for index in 1..attached.len() {
            let before = attached[index - 1];
            attached[index].iter_mut().zip(before).for_each(|(sum, before)| sum.add_sum(before));
        }
        Ok(())
    }

    /// Proceeds to the turning point of this number and lists the unloading from there, m.
    ///
    /// # Errors
    /// [`ContactError::OutOfMemory`].
    pub fn turn<E: EdgeModel>(
        &mut self,
        [loading, unloading]: [&Ground<'_, E>; 2],
        runs: &[Run],
        (index, at): (usize, f64),
        evaluations: &mut u64,
    ) -> Result<Reversed, ContactError> {
        std::mem::swap(&mut self.present, &mut self.before);
        self.passed = 0;
        self.present.clear();
        let [thirds, mut attached] = self.attached[index];
        let range = Range { low: f64::NEG_INFINITY, high: at, unloading: false };
        for (number, run) in runs.iter().enumerate().filter(|(_, run)| run.is_at(at)) {
            let from = loading.span(run.branch, self.spans[number]);
            let span = loading.filled(run, from, false, at);
            self.spans[number] = span.ends();
            if E::SLIDES {
                let ends = loading.levels_of(run, loading.bottom(run), span, range);
                attached.add(loading.edges.squared_stretch_sliding(loading.gaps, ends));
            }
            let [first, last] = span.ends();
            *evaluations += self.list(unloading, Held { branch: run.branch, first, last, pin: None }, at)?;
        }
        attached.add(thirds.total() / 3.0);
        let squared_stretches = [attached.total(), self.present.squared_stretch(unloading, at)];
        let separates = self.present.runs.iter().fold(f64::INFINITY, |least, run| least.min(run.from));
        Ok(Reversed { separates, squared_stretches })
    }

    /// Runs of the present unloading.
    pub fn runs(&self) -> &[Run] {
        &self.present.runs
    }

    /// Lists the runs of one fragment at the turning point; returns the evaluations of the rule.
    fn list<E: EdgeModel>(
        &mut self,
        ground: &Ground<'_, E>,
        held: Held,
        at: f64,
    ) -> Result<u64, ContactError> {
        let start = self.present.runs.len();
        let inside = self.passed;
        let is_inside = |listed: &Listed| listed.ends[0] >= held.first;
        self.passed += self.before.fragments[inside..].iter().take_while(|listed| is_inside(listed)).count();
        let inside = inside..self.passed;
        let ends = [held.first, held.last];
        let mut opened = Opened { separates: f64::INFINITY, springs: 0, evaluations: 1 };
        match self.before.alone(inside.clone(), held.branch) {
            Some(listed) if listed.ends == ends => self.present.copy(&self.before, listed)?,
            _ => {
                let mut parts = take(&mut self.parts);
                parts.push(Part::whole(&held, at));
                while let Some(part) = parts.pop() {
                    let inside = self.before.inside(inside.clone(), &part);
                    let known = self.before.alone(inside, part.branch);
                    let way = (None, known.map(|listed| listed.ends));
                    let descent = ground.descend(part, way, &mut self.present.runs, &mut opened)?;
                    self.present.fill_up()?;
                    match (descent, known) {
                        (Descent::Bottom(inside), _) => parts.extend(inside.into_iter().flatten()),
                        (Descent::Known { opens, above }, Some(listed)) => {
                            self.present.graft(ground, &self.before, listed, opens, above)?;
                        }
                        _ => {}
                    }
                }
                self.parts = parts;
            }
        }
        let span = ground.span(held.branch, ends);
        // A fragment that the turning point itself caps by a rounding is listed anew the next time.
        let is_whole = ground.holds_to(&span) <= at;
        let runs = [start, self.present.runs.len()];
        let listed = Listed { branch: held.branch, ends, runs, is_whole };
        push(&mut self.present.fragments, listed, ground.gaps.len())?;
        Ok(opened.evaluations)
    }
}

impl Unloading {
    fn clear(&mut self) {
        self.fragments.clear();
        self.runs.clear();
        self.detaching.clear();
    }

    /// The fragments of a range inside a part; fragments are listed from right to left.
    fn inside(&self, range: Indices<usize>, part: &Part) -> Indices<usize> {
        let listed = &self.fragments[range.clone()];
        let start = listed.partition_point(|listed| listed.ends[0] > part.last);
        let end = listed.partition_point(|listed| listed.ends[0] >= part.first);
        range.start + start..range.start + end
    }

    /// The only fragment of a range, if it lies on this branch and its runs serve again.
    fn alone(&self, range: Indices<usize>, branch: Branch) -> Option<Listed> {
        let [listed] = self.fragments[range] else { return None };
        Some(listed).filter(|listed| listed.branch == branch && listed.is_whole)
    }

    /// Extends the lists by a place for each run.
    fn fill_up(&mut self) -> Result<(), ContactError> {
        let count = self.runs.len();
        self.detaching = resized(take(&mut self.detaching), count, Detaching::default())?;
        Ok(())
    }

    /// Copies the runs of an unchanged fragment.
    fn copy(&mut self, before: &Unloading, listed: Listed) -> Result<(), ContactError> {
        let [start, end] = listed.runs;
        let out_of_memory = |_| ContactError::OutOfMemory { springs: end - start };
        self.runs.try_reserve(end - start).map_err(out_of_memory)?;
        self.detaching.try_reserve(end - start).map_err(out_of_memory)?;
        self.runs.extend_from_slice(&before.runs[start..end]);
        self.detaching.extend_from_slice(&before.detaching[start..end]);
        Ok(())
    }

    /// Copies the runs of a fragment that now lies inside another one, which parts at the indentation `opens`, m;
    /// `above` are the levels of the span around the fragment, where its run may go on.
    fn graft<E: EdgeModel>(
        &mut self,
        ground: &Ground<'_, E>,
        before: &Unloading,
        listed: Listed,
        opens: f64,
        above: Option<Levels>,
    ) -> Result<(), ContactError> {
        let [start, end] = listed.runs;
        let out_of_memory = |_| ContactError::OutOfMemory { springs: ground.gaps.len() };
        self.runs.try_reserve(end - start).map_err(out_of_memory)?;
        self.detaching.try_reserve(end - start).map_err(out_of_memory)?;
        for index in start..end {
            let (mut run, mut detaching) = (before.runs[index], before.detaching[index]);
            if run.from >= opens {
                continue;
            }
            if run.to > opens {
                let top = ground.held_below(&run, opens);
                let is_cut = top.ends() != run.top_ends();
                if E::SLIDES || is_cut {
                    detaching.slide = None;
                }
                run.raise(&top, opens);
                if let (true, false, Some(upper), Some(last)) =
                    (index == start, is_cut, above, self.runs.last_mut())
                    && ground.edges.slides_on(&ground.levels(&top), &upper)
                {
                    last.lower(&ground.bottom(&run), run.from);
                    if let Some(of_last) = self.detaching.last_mut() {
                        *of_last = detaching;
                    }
                    continue;
                }
            }
            self.runs.push(run);
            self.detaching.push(detaching);
        }
        Ok(())
    }

    /// Σ e² over the springs that detach, m², when the unloading begins at an indentation, m.
    fn squared_stretch<E: EdgeModel>(&mut self, ground: &Ground<'_, E>, high: f64) -> f64 {
        let Unloading { runs, detaching, .. } = self;
        let wanted: Vec<usize> = (0..runs.len()).filter(|&index| detaching[index].jump.is_none()).collect();
        if !wanted.is_empty() {
            wanted.iter().for_each(|&index| detaching[index].jump = Some(CompensatedSum::default()));
            let mut next = wanted.iter().peekable();
            ground.each_jump(
                runs,
                high,
                |index| next.next_if(|&&wanted| wanted == index).is_some(),
                |index, stretch| {
                    let squares = ground.edges.squared_stretch(ground.gaps, &stretch);
                    detaching[index].jump.get_or_insert_default().add(squares);
                },
            );
        }
        let (mut thirds, mut sliding) = (CompensatedSum::default(), CompensatedSum::default());
        for (run, detaching) in runs.iter().zip(detaching) {
            thirds.add_sum(detaching.jump.unwrap_or_default());
            sliding.add_sum(ground.slide(run, high, &mut detaching.slide));
        }
        sliding.add(thirds.total() / 3.0);
        sliding.total()
    }
}

impl<E: EdgeModel> Ground<'_, E> {
    /// The largest span of an unloading run that is held below an indentation, m.
    fn held_below(&self, run: &Run, opens: f64) -> Span {
        let mut span = self.top(run);
        let bottom = run.branch.origin().map_or(f64::NEG_INFINITY, |node| self.tree.nodes()[node].gap);
        while span.ends() != run.bottom && self.holds_to(&span) >= opens {
            span = span.shrunk(self.gaps, bottom);
        }
        span
    }

    /// Σ e² over the springs that detach while a run passes from span to span, m², from those already known.
    fn slide(&self, run: &Run, high: f64, known: &mut Option<(CompensatedSum, [u32; 2])>) -> CompensatedSum {
        let top = run.top_ends();
        if E::SLIDES {
            return match *known {
                Some((sum, _)) => sum,
                None => {
                    let range = Range { low: f64::NEG_INFINITY, high, unloading: true };
                    let ends = self.levels_of(run, self.bottom(run), self.top(run), range);
                    let mut sum = CompensatedSum::default();
                    sum.add(self.edges.squared_stretch_sliding(self.gaps, ends));
                    // Edges of a fragment at the turning point end where the turning point is.
                    *known = (run.to < f64::INFINITY).then_some((sum, top));
                    sum
                }
            };
        }
        let (sum, ends) = known.get_or_insert((CompensatedSum::default(), run.bottom));
        let mut span = self.span(run.branch, *ends);
        while span.ends() != top {
            let above = span.grown(self.gaps);
            let at = self.holds_to(&above);
            let spring = if above.last > span.last { above.last } else { above.first };
            let stretch = self.gaps[spring] - at;
            sum.add(stretch * stretch);
            span = above;
        }
        *ends = top;
        *sum
    }
}
