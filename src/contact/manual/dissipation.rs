//! Energy of the springs that attach or detach under a stretch on one move.

use super::fragments::{Event, Fragment};
use crate::contact::Direction;
use crate::contact::adhesive::{EdgeModel, Ground, SquaredStretch};
use crate::contact::grid::CompensatedSum;
use std::collections::HashMap;
use std::slice::from_ref;

/// Squared stretches of the parts of the line that have attached or detached on a move.
///
/// Whole springs attach and detach one by one, or many at once. Edges between springs slide, and jump where the
/// fragment passes to another span. Where edges only slide on, the width of the jump is a rounding, which changes the
/// energy by its square: a small jump and a slide over the same width differ in that order alone.
pub struct Dissipation {
    direction: Direction,
    /// Indentation at which the move begins, m.
    from: f64,
    /// By slot, where edges slide: the level at which the fragment began to fill its span on the move, m.
    levels: HashMap<usize, f64>,
    /// ∫ (c − θ)² dx over the springs or cells that attach or detach, in cells times m².
    squares: CompensatedSum,
}

impl Dissipation {
    /// Returns empty sums for a move in this direction from an indentation, m.
    pub fn new(direction: Direction, from: f64) -> Self {
        Dissipation { direction, from, levels: HashMap::new(), squares: CompensatedSum::default() }
    }

    /// ∫ (c − θ)² dx, in cells times m².
    pub fn squared_stretch(self) -> f64 {
        self.squares.total()
    }

    /// Adds an event at an indentation, m: a fragment has formed from these parts, or has detached a spring and they
    /// remain; or its pinned edges begin to slide.
    pub fn change<E: EdgeModel>(
        &mut self,
        ground: Ground<'_, E>,
        at: f64,
        Event { whole, springs }: &Event,
        parts: &[Fragment],
    ) {
        if *springs == 0 {
            self.levels.extend(whole.pin.map(|rise| (whole.slot, whole.span.gap + rise)));
            return;
        }
        let (before, after) = match self.direction {
            Direction::Loading => (parts, from_ref(whole)),
            Direction::Unloading => (from_ref(whole), parts),
        };
        for fragment in before {
            self.slide(ground, fragment, at);
        }
        self.jump(ground, at, whole, parts);
        if E::SLIDES {
            for fragment in before {
                self.levels.remove(&fragment.slot);
            }
            let begin = |fragment: &Fragment| (fragment.slot, ground.level(&fragment.span, fragment.pin, at));
            self.levels.extend(after.iter().map(begin));
        }
    }

    /// Slides the edges of a fragment to those of an indentation, m.
    pub fn slide<E: EdgeModel>(&mut self, ground: Ground<'_, E>, fragment: &Fragment, to: f64) {
        if E::SLIDES {
            let begun = self.levels.get(&fragment.slot).copied();
            let from = begun.unwrap_or_else(|| ground.level(&fragment.span, fragment.pin, self.from));
            let to = level_at_end(self.direction, ground, fragment, to);
            let between = match self.direction {
                Direction::Loading => [from, to],
                Direction::Unloading => [to, from],
            };
            let between = between.map(|level| (fragment.span, level));
            let is_unloading = self.direction == Direction::Unloading;
            self.squares.add(ground.edges.squared_stretch_sliding(ground.gaps, between, is_unloading));
        }
    }

    /// Adds all of a fragment but these parts of it, attached or detached at once.
    fn jump<E: EdgeModel>(&mut self, ground: Ground<'_, E>, at: f64, whole: &Fragment, parts: &[Fragment]) {
        let mut sum = SquaredStretch::new(&ground, at.abs());
        sum.add(&ground, 1, (&whole.span, ground.level(&whole.span, whole.pin, at)), at);
        for part in parts {
            sum.add(&ground, -1, (&part.span, level_at_end(self.direction, ground, part, at)), at);
        }
        self.squares.add(sum.total());
    }
}

/// Level of the edges of a fragment at an indentation up to the end of the range in which it fills its span, m.
fn level_at_end<E: EdgeModel>(
    direction: Direction,
    ground: Ground<'_, E>,
    Fragment { span, pin, .. }: &Fragment,
    at: f64,
) -> f64 {
    match direction {
        Direction::Loading => ground.level_up_to(span, *pin, at, false),
        Direction::Unloading => ground.level(span, *pin, at),
    }
}
