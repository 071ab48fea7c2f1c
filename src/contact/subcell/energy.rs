//! What joins and leaves under stretch: the energy that is lost.

use super::edges::SubCellEdges;
use crate::contact::ledger::CompensatedSum;

/// ∫ (c − θ)² dx over what joins or leaves between two indentations of a leg, θ being where it does so, in
/// cells times m².
///
/// Between the threshold of a node and that of its parent its edges slide; at either of them they jump.
pub fn squared_stretch(edges: &SubCellEdges, thresholds: &[f64], low: f64, high: f64) -> f64 {
    let (tree, gaps) = (edges.sets().tree(), edges.sets().gaps());
    let mut sum = CompensatedSum::default();
    let mut part = |node: usize, closes: f64| {
        let opens = thresholds[node];
        if opens > high || closes <= low {
            return;
        }
        let (gap, top) = (tree.gap(node), edges.sets().levels(node).top);
        if opens > low {
            let at_once = mass(gaps, tree.positions()[node] as usize);
            sum.add(at_once * (gap - opens).powi(2));
        }
        if top > gap && top < f64::INFINITY {
            let from = edges.level(node, opens.max(low));
            let to = edges.level(node, closes.min(high));
            sum.add(edges.squared_stretch_sliding(node, from, to));
            if opens > low {
                sum.add(edges.squared_stretch_at_once(node, gap, from, opens));
            }
            if closes <= high {
                sum.add(edges.squared_stretch_at_once(node, to, top, closes));
            }
        }
    };
    for parent in 0..tree.len() {
        let (left, right) = tree.children(parent);
        for child in [left, right].into_iter().flatten() {
            part(child, thresholds[parent]);
        }
    }
    if let Some(root) = tree.len().checked_sub(1) {
        part(root, f64::INFINITY);
    }
    sum.total()
}

/// Cells that join together with a spring: half of one at an end of the foundation, and the one to its left
/// where it is level.
fn mass(gaps: &[f64], position: usize) -> f64 {
    let half = |is_end: bool| if is_end { 0.5 } else { 0.0 };
    let before = position.checked_sub(1).and_then(|before| gaps.get(before));
    let is_level = before.is_some_and(|before| *before == gaps[position]);
    half(position == 0) + half(position + 1 == gaps.len()) + f64::from(u8::from(is_level))
}
