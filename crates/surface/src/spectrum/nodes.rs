//! Nodes of a spectrum: the wave numbers q at which the spectrum C2D is given. Between nodes, ln
//! C2D is linear in ln q. The module also has the terms of sums over such a spectrum.

use super::quadrature::{GaussPoint, gauss};

/// Whether a spectrum continues beyond the shortest wave that the measured points resolve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum End {
    /// The surface has no waves shorter than the shortest wave that the points resolve.
    #[default]
    Ends,
    /// The surface has shorter waves, up to this wave number in rad/m. Their spectrum is a power
    /// law, which continues the last part of the measured spectrum.
    Continues(f64),
}

/// First and last wave number of a spectrum in rad/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WaveRange {
    pub first: f64,
    pub last: f64,
}

/// Nodes that are equally spaced in ln q. A node is a wave number q at which a spectrum is given.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Nodes {
    /// Natural logarithm of the first wave number in rad/m.
    pub first: f64,
    /// Difference of ln q between neighbouring nodes.
    pub step: f64,
    pub count: usize,
    /// Largest wave number of the spectrum in rad/m. It is larger than the wave number of the last
    /// node if the spectrum continues beyond the resolved waves.
    pub end: f64,
}

/// Place of a wave number relative to two neighbouring nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NodePlace {
    /// Index of the node at or below the wave number. A node is a wave number at which the spectrum
    /// is given.
    pub index: usize,
    /// Distance in ln q from this node to the wave number, divided by the distance between two
    /// nodes.
    pub share: f64,
}

impl NodePlace {
    /// Interpolates linearly between the values at the two neighbouring nodes. `values` has a value
    /// for each node.
    pub fn interpolate(&self, values: &[f64]) -> f64 {
        (1.0 - self.share) * values[self.index] + self.share * values[self.index + 1]
    }

    /// Converts a derivative with respect to ln C2D at this place to derivatives with respect to ln
    /// C2D at the two neighbouring nodes. C2D is the two-dimensional spectral density. The two
    /// derivatives are added to `gradient`, which has one element for each node.
    pub fn distribute(&self, derivative: f64, gradient: &mut [f64]) {
        gradient[self.index] += (1.0 - self.share) * derivative;
        gradient[self.index + 1] += self.share * derivative;
    }
}

/// Interval of wave numbers in rad/m in which a spectrum is a power law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub low: f64,
    pub high: f64,
}

impl Piece {
    /// Returns the points of a Gauss quadrature over this interval. The variable of integration is
    /// ln q.
    pub fn logarithms(&self) -> impl Iterator<Item = GaussPoint> {
        gauss(self.low.ln(), self.high.ln())
    }
}

impl Nodes {
    /// Creates nodes, the wave numbers at which a spectrum is given. The nodes cover `range`, with
    /// at least `per_decade` nodes per decade. `end` states whether the spectrum continues beyond
    /// `range`.
    pub fn new(range: WaveRange, per_decade: f64, end: End) -> Self {
        let ratio = range.last / range.first;
        let pieces = (per_decade * ratio.log10()).ceil().max(2.0);
        let end = match end {
            End::Ends => range.last,
            End::Continues(end) => end.max(range.last),
        };
        Nodes {
            first: range.first.ln(),
            step: ratio.ln() / pieces,
            count: pieces as usize + 1,
            end,
        }
    }

    /// Returns the wave number of a node in rad/m.
    pub fn wave_number(&self, index: usize) -> f64 {
        (self.first + index as f64 * self.step).exp()
    }

    /// Returns where the logarithm `ln_q` of a wave number q lies between the nodes. Below the
    /// first node, the place is that of the first node, so that the spectrum is constant there.
    /// Beyond the last node, the spectrum is extrapolated.
    pub fn place(&self, ln_q: f64) -> NodePlace {
        let place = ((ln_q - self.first) / self.step).max(0.0);
        let index = (place as usize).min(self.count - 2);
        NodePlace {
            index,
            share: place - index as f64,
        }
    }

    /// Returns the intervals of the wave number, in rad/m, on which the spectrum is a power law.
    /// Together the intervals reach from `low` to the end of the spectrum.
    pub fn pieces_from(&self, low: f64) -> Vec<Piece> {
        let node_number = |wave_number: f64| (wave_number.ln() - self.first) / self.step;
        // For `low` = 0 the logarithm is −∞, which is smaller than ln q of every node.
        let first = (node_number(low).floor() + 1.0).max(0.0) as usize;
        let last = node_number(self.end).ceil() as usize;
        let bounds = (first..=last).map(|index| self.wave_number(index).min(self.end));

        let mut pieces = Vec::new();
        let mut begin = low.min(self.end);
        for bound in bounds.chain([self.end]) {
            if bound > begin {
                pieces.push(Piece {
                    low: begin,
                    high: bound,
                });
                begin = bound;
            }
        }
        pieces
    }

    /// Returns the term `weight` × C2D(q) of a sum over the spectrum, where C2D is the
    /// two-dimensional spectral density and q a wave number in rad/m.
    pub fn term(&self, q: f64, weight: f64) -> Term {
        let ln_q = q.ln();
        Term {
            weight,
            ln_q,
            place: self.place(ln_q),
        }
    }
}

/// A term of a sum over a spectrum: a weight times the spectral density C2D at the wave number q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    pub weight: f64,
    pub ln_q: f64,
    pub place: NodePlace,
}

impl Term {
    /// Returns the value of the term. `values` is ln C2D at the nodes, the wave numbers at which
    /// the spectral density C2D is given.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.weight * self.place.interpolate(values).exp()
    }
}
