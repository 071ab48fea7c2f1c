//! Shortest length that a stylus or a probe of a tip radius resolves.

/// Share of the curvature of the tip at which artefacts set in (Sanner et al., Appl. Surf. Sci. Adv. 7, 100190, 2022).
const SAFETY: f64 = 0.5;

/// Reliability cut-off, m: the smallest stencil length 2sΔx (s whole) at which the smallest curvature
/// (z(x − sΔx) − 2z(x) + z(x + sΔx))/(sΔx)² of all rows is at least −1/(2R) for a tip radius R, m. Shorter waves may be
/// artefacts of the tip.
///
/// `None` if the condition already holds at the distance between points. Half the length of a row if it holds
/// nowhere: no wave is reliable.
pub(crate) fn reliability_cutoff(
    heights: &[f64],
    columns: usize,
    spacing: f64,
    tip_radius: f64,
) -> Option<f64> {
    let limit = -SAFETY / tip_radius;
    let is_reliable = |scale: usize| smallest_curvature(heights, columns, scale, spacing) >= limit;
    if is_reliable(1) {
        return None;
    }
    let most = (columns - 1) / 4;
    let (mut bad, mut good) = (1, None);
    while good.is_none() && bad < most {
        // In steps of a fifth, at least of one.
        let next = (bad + bad / 5 + 1).min(most);
        if is_reliable(next) { good = Some(next) } else { bad = next }
    }
    let Some(mut good) = good else { return Some(0.5 * columns as f64 * spacing) };
    while good - bad > 1 {
        let middle = bad + (good - bad) / 2;
        if is_reliable(middle) { good = middle } else { bad = middle }
    }
    Some(2.0 * good as f64 * spacing)
}

fn smallest_curvature(heights: &[f64], columns: usize, scale: usize, spacing: f64) -> f64 {
    let step = scale as f64 * spacing;
    let smallest = |row: &[f64]| {
        let stencils = row.iter().zip(&row[scale.min(row.len())..]).zip(&row[(2 * scale).min(row.len())..]);
        stencils
            .map(|((left, middle), right)| (left - middle) + (right - middle))
            .fold(f64::INFINITY, f64::min)
    };
    heights.chunks_exact(columns).map(smallest).fold(f64::INFINITY, f64::min) / (step * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_reliable_for_sharper_tips_only() {
        let spacing = 0.5;
        // Curvature −2 at every scale.
        let heights: Vec<f64> = (0..101).map(|i| -(0.5 * f64::from(i) - 25.0).powi(2)).collect();
        assert_eq!(reliability_cutoff(&heights, 101, spacing, 0.2), None);
        assert_eq!(reliability_cutoff(&heights, 101, spacing, 0.3), Some(0.5 * 101.0 * spacing));
    }

    #[test]
    fn a_spike_is_unreliable_below_a_length() {
        let mut heights = vec![0.0; 1001];
        heights[500] = 1.0;
        // At scale s the curvature is −2/(sΔx)², above −1/(2R) from sΔx = 2√R on.
        let cutoff = reliability_cutoff(&heights, 1001, 0.1, 1.0);
        assert!((cutoff.unwrap() - 4.0).abs() < 1e-12, "{cutoff:?}");
    }
}
