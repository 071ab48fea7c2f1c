//! Energy of the springs that attach or detach under a stretch on one move.

use super::fragments::{Event, Fragment};
use crate::contact::adhesive::{AtOnce, Boundary, Edge, EdgeModel, Ground, Span};
use crate::contact::grid::CompensatedSum;
use std::collections::HashMap;

/// Squared stretches of the parts of the line that have attached or detached on a move.
///
/// Whole springs attach and detach one by one, or many at once. Edges between springs slide, and jump where the fragment
/// passes to another span. Where they only slide on, the jump has no width but that of rounding, which changes the
/// energy by its square: a jump by a small width and a slide over the same width differ in that order alone.
pub struct Dissipation {
    /// Indentation at which the move begins, m.
    from: f64,
    /// By slot, where edges slide: the level at which the fragment began to fill its span on the move, m.
    levels: HashMap<usize, f64>,
    /// ∫ (c − θ)² dx over the places passed while edges slide, in cells times m².
    sliding: CompensatedSum,
    /// Three times ∫ (c − θ)² dx over the parts that attach or detach at once, in cells times m².
    thirds: CompensatedSum,
}

impl Dissipation {
    /// Nothing yet on a move from an indentation, m.
    pub fn new(from: f64) -> Self {
        let (sliding, thirds) = (CompensatedSum::default(), CompensatedSum::default());
        Dissipation { from, levels: HashMap::new(), sliding, thirds }
    }

    /// ∫ (c − θ)² dx, in cells times m².
    pub fn squared_stretch(mut self) -> f64 {
        self.sliding.add(self.thirds.total() / 3.0);
        self.sliding.total()
    }

    /// A fragment has formed from these parts at an indentation, m.
    pub fn attach<E: EdgeModel>(
        &mut self,
        ground: Ground<'_, E>,
        at: f64,
        event: &Event,
        parts: &[Fragment],
    ) {
        let Fragment { slot, span, .. } = event.whole;
        for part in parts {
            self.slide_up(ground, part, at);
        }
        let level = level(ground, &span, at);
        self.jump(ground, at, (&span, level), parts, |part| level_up_to(ground, part, at));
        if E::SLIDES {
            for part in parts {
                self.levels.remove(&part.slot);
            }
            self.levels.insert(slot, level);
        }
    }

    /// A fragment has detached a spring at an indentation (m), and these parts remain.
    pub fn detach<E: EdgeModel>(
        &mut self,
        ground: Ground<'_, E>,
        at: f64,
        event: &Event,
        parts: &[Fragment],
    ) {
        let Fragment { slot, span, .. } = event.whole;
        self.slide_down(ground, &event.whole, at);
        self.jump(ground, at, (&span, level_down_to(ground, &event.whole, at)), parts, |part| {
            level(ground, &part.span, at)
        });
        if E::SLIDES {
            self.levels.remove(&slot);
            for part in parts {
                self.levels.insert(part.slot, level(ground, &part.span, at));
            }
        }
    }

    /// The pinned edges of a fragment begin to slide.
    pub fn release(&mut self, fragment: &Fragment) {
        if let Some(rise) = fragment.pin {
            self.levels.insert(fragment.slot, fragment.span.gap + rise);
        }
    }

    /// The edges of a fragment slide up to those of an indentation, m.
    pub fn slide_up<E: EdgeModel>(&mut self, ground: Ground<'_, E>, fragment: &Fragment, to: f64) {
        if E::SLIDES {
            let from = self.level_before(ground, fragment);
            let to = level_up_to(ground, fragment, to);
            self.slide(ground, (&fragment.span, from), (&fragment.span, to));
        }
    }

    /// The edges of a fragment slide down to those of an indentation, m.
    pub fn slide_down<E: EdgeModel>(&mut self, ground: Ground<'_, E>, fragment: &Fragment, to: f64) {
        if E::SLIDES {
            let from = self.level_before(ground, fragment);
            let to = level_down_to(ground, fragment, to);
            self.slide(ground, (&fragment.span, to), (&fragment.span, from));
        }
    }

    /// Level of the edges of a fragment where its span began on this move.
    fn level_before<E: EdgeModel>(&self, ground: Ground<'_, E>, fragment: &Fragment) -> f64 {
        let begun = self.levels.get(&fragment.slot).copied();
        begun.unwrap_or_else(|| level_down_to(ground, fragment, self.from))
    }

    fn slide<E: EdgeModel>(&mut self, ground: Ground<'_, E>, lower: (&Span, f64), upper: (&Span, f64)) {
        self.sliding.add(ground.edges.squared_stretch_sliding(ground.gaps, lower, upper));
    }

    /// All of a fragment attaches or detaches at once, but for these parts of it.
    fn jump<E: EdgeModel>(
        &mut self,
        ground: Ground<'_, E>,
        at: f64,
        (whole, level): (&Span, f64),
        parts: &[Fragment],
        level_of: impl Fn(&Fragment) -> f64,
    ) {
        let mut add = |AtOnce { at, between }| {
            self.thirds.add(ground.edges.squared_stretch(ground.gaps, between, at));
        };
        let mut from = Boundary::Outer(Edge { spring: whole.first, level });
        for part in parts {
            let level = level_of(part);
            let to = Boundary::Part(Edge { spring: part.span.first, level });
            add(AtOnce { at, between: (from, to) });
            from = Boundary::Part(Edge { spring: part.span.last, level });
        }
        add(AtOnce { at, between: (from, Boundary::Outer(Edge { spring: whole.last, level })) });
    }
}

/// Level of the edges of a fragment at the upper end of the range in which it fills its span or below, m.
fn level_up_to<E: EdgeModel>(ground: Ground<'_, E>, fragment: &Fragment, indentation: f64) -> f64 {
    let Fragment { span, pin, .. } = fragment;
    pin.map_or_else(|| ground.level_up_to(span, indentation, false), |rise| span.gap + rise)
}

/// The same at the lower end or above.
fn level_down_to<E: EdgeModel>(ground: Ground<'_, E>, fragment: &Fragment, indentation: f64) -> f64 {
    let Fragment { span, pin, .. } = fragment;
    pin.map_or_else(|| level(ground, span, indentation), |rise| span.gap + rise)
}

/// Level of the edges of a span at an indentation, m.
fn level<E: EdgeModel>(ground: Ground<'_, E>, span: &Span, indentation: f64) -> f64 {
    ground.edges.level(span, ground.edges.length(ground.gaps, span), indentation)
}
