//! Energy of the springs that attach or detach under a stretch on one move.

use super::fragments::{Event, Fragment};
use crate::contact::adhesive::{AtOnce, Boundary, Edge, EdgeModel, Ground, Span};
use crate::contact::grid::CompensatedSum;
use std::collections::HashMap;

/// Squared stretches of the parts of the line that have attached or detached on a move.
///
/// Whole springs attach and detach one by one, or many at once. Edges between springs slide from span to span until the
/// fragment jumps, merges or parts, as on the runs of a leg.
pub struct Dissipation {
    /// Indentation at which the move begins, m.
    from: f64,
    /// By slot, the fragments whose spans have formed on the move, where edges slide.
    formed: HashMap<usize, Formed>,
    /// ∫ (c − θ)² dx over what attaches or detaches while edges slide, in cells times m².
    sliding: CompensatedSum,
    /// Three times the same over what does so at once.
    thirds: CompensatedSum,
}

/// The beginning of a span of a fragment.
#[derive(Clone, Copy)]
struct Formed {
    /// Indentation, m.
    at: f64,
    /// Level of the edges then, m.
    level: f64,
}

impl Dissipation {
    /// Nothing yet on a move from an indentation, m.
    pub fn new(from: f64) -> Self {
        let (sliding, thirds) = (CompensatedSum::default(), CompensatedSum::default());
        Dissipation { from, formed: HashMap::new(), sliding, thirds }
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
        let Fragment { slot, span } = event.whole;
        if E::SLIDES
            && let ([part], 1) = (parts, event.springs)
            && attaches_at(ground, &part.span) == Some(at)
            && attaches_at(ground, &span).is_none_or(|next| next > at)
            && self.slides_on(ground, at, part.slot, (&part.span, &span))
        {
            let from = self.level_before(ground, part);
            self.slide(ground, (&part.span, from), (&span, span.gap));
            self.formed.insert(slot, Formed { at, level: span.gap });
            return;
        }
        for part in parts {
            self.slide_up(ground, part, at);
        }
        let level = level(ground, &span, at);
        self.jump(ground, at, (&span, level), parts, |part| ground.level_up_to(&part.span, at, false));
        if E::SLIDES {
            for part in parts {
                self.formed.remove(&part.slot);
            }
            self.formed.insert(slot, Formed { at, level });
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
        let Fragment { slot, span } = event.whole;
        if E::SLIDES
            && let [part] = parts
            && holds_to(ground, &span) == at
            && holds_to(ground, &part.span) < at
            && self.slides_on(ground, at, slot, (&part.span, &span))
        {
            let from = self.level_before(ground, &event.whole);
            self.slide(ground, (&part.span, span.gap), (&span, from));
            self.formed.insert(slot, Formed { at, level: span.gap });
            return;
        }
        self.slide_down(ground, &event.whole, at);
        self.jump(ground, at, (&span, level(ground, &span, at)), parts, |part| level(ground, &part.span, at));
        if E::SLIDES {
            self.formed.remove(&slot);
            for part in parts {
                self.formed.insert(part.slot, Formed { at, level: level(ground, &part.span, at) });
            }
        }
    }

    /// The edges of a fragment slide up to those of an indentation, m.
    pub fn slide_up<E: EdgeModel>(&mut self, ground: Ground<'_, E>, fragment: &Fragment, to: f64) {
        if E::SLIDES {
            let from = self.level_before(ground, fragment);
            let to = ground.level_up_to(&fragment.span, to, false);
            self.slide(ground, (&fragment.span, from), (&fragment.span, to));
        }
    }

    /// The edges of a fragment slide down to those of an indentation, m.
    pub fn slide_down<E: EdgeModel>(&mut self, ground: Ground<'_, E>, fragment: &Fragment, to: f64) {
        if E::SLIDES {
            let from = self.level_before(ground, fragment);
            let to = level(ground, &fragment.span, to);
            self.slide(ground, (&fragment.span, to), (&fragment.span, from));
        }
    }

    /// Whether the edges of a fragment that was at rest before `at` pass between two of its spans without a jump.
    fn slides_on<E: EdgeModel>(
        &self,
        ground: Ground<'_, E>,
        at: f64,
        slot: usize,
        (lower, upper): (&Span, &Span),
    ) -> bool {
        let was_at_rest = self.formed.get(&slot).is_none_or(|formed| formed.at != at);
        let length = |span: &Span| ground.edges.length(ground.gaps, span);
        was_at_rest && ground.edges.slides_on((lower, length(lower)), (upper, length(upper)))
    }

    /// Level of the edges of a fragment where its span began on this move.
    fn level_before<E: EdgeModel>(&self, ground: Ground<'_, E>, fragment: &Fragment) -> f64 {
        match self.formed.get(&fragment.slot) {
            Some(formed) => formed.level,
            None => level(ground, &fragment.span, self.from),
        }
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

/// Level of the edges of a span at an indentation, m.
fn level<E: EdgeModel>(ground: Ground<'_, E>, span: &Span, indentation: f64) -> f64 {
    ground.edges.level(span, ground.edges.length(ground.gaps, span), indentation)
}

/// Indentation at which a span takes in its wall, m; `None` where it fills the line.
fn attaches_at<E: EdgeModel>(ground: Ground<'_, E>, span: &Span) -> Option<f64> {
    let length = ground.edges.length(ground.gaps, span);
    span.wall(ground.gaps).map(|wall| ground.edges.attaches_at(span, length, ground.gaps[wall]))
}

/// Indentation to which a span holds its most stretched spring, m.
fn holds_to<E: EdgeModel>(ground: Ground<'_, E>, span: &Span) -> f64 {
    ground.edges.holds_to(span, ground.edges.length(ground.gaps, span))
}
