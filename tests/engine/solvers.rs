//! Exact solvers over the gaps of a test.

use asperity::contact::{Body, Contact, Foundation, HessRule};
use asperity::scene::Edges;

/// A separated body under adhesion; `samples` curve points are taken in each motion.
pub fn adhesive(gaps: &[f64], edges: Edges, hess: HessRule, foundation: Foundation, samples: usize) -> Body {
    Body::new(&Contact::new(gaps.to_vec(), edges, foundation, Some(hess)), samples)
}

/// A separated body without adhesion.
pub fn nonadhesive(gaps: &[f64], edges: Edges, foundation: Foundation, samples: usize) -> Body {
    Body::new(&Contact::new(gaps.to_vec(), edges, foundation, None), samples)
}
