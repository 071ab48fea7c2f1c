//! The rigid profile above the springs: its gaps at equally spaced points, and the contact trees
//! that are built from the gaps. A contact tree states where patches in contact can merge.

use super::adhesive::levels::Edges;
use super::adhesive::tree::ContactTree;
use super::error::{ContactError, LARGEST, check, is_positive};
use super::nominal_form::{NominalForm, falls_to_both_ends, radius_of_cut};
use super::totals::GapScale;
use asperity_data::Warning;
use std::sync::{Arc, OnceLock};

/// Largest number of points of a profile.
const MOST_POINTS: usize = 1 << 28;

/// Equivalent line of a rigid body: heights at equally spaced points. Heights are positive towards
/// the half-space, so the highest point touches first.
///
/// The equivalent line is not a cut through the body. A body of revolution with the depth f(r) has
/// the equivalent line g(x) = |x| ∫₀^|x| f′(r)/√(x² − r²) dr. The equivalent line of a sphere of
/// the radius R is therefore x²/R, while a cut through the sphere is x²/(2R). If a cut were used as
/// the equivalent line, the pull-off force of a sphere would be twice too large. For a rough
/// surface, the equivalent line and a cut have the same rms height, but the rms gradient of the cut
/// is 29 % smaller. `asperity_surface` makes the equivalent line of forms and of measured surfaces.
///
/// N points at a spacing Δx cover the length N Δx: half a spacing lies beyond the first and the
/// last point. Clones of a profile share their memory.
///
/// ```
/// use asperity_contact::Profile;
///
/// let profile = Profile::from_heights(vec![0.0, -4.0e-8, -1.0e-8], 1.0e-6)?; // m
/// assert_eq!((profile.points(), profile.length()), (3, 3.0 * 1.0e-6));
/// assert_eq!(profile.gaps(), [0.0, 4.0e-8, 1.0e-8]);
/// let refused = Profile::from_heights(&[0.0, f64::NAN], 1.0e-6).unwrap_err();
/// assert_eq!(refused.to_string(), "height with index 1 = NaN; allowed: from -1e50 to 1e50 m");
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Profile {
    pub(super) springs: Arc<Springs>,
    pub(super) spacing: f64,
    pub(super) length: f64,
    first: usize,
    summit: f64,
    nominal_form: NominalForm,
}

/// The gaps under a profile, and its contact trees. A contact tree states where patches in contact
/// can merge. It depends only on the gaps and on where the edges of patches may lie, and is built
/// when a contact first needs it.
#[derive(Debug)]
pub struct Springs {
    pub gaps: Arc<Vec<f64>>,
    pub deepest: f64,
    /// One contact tree for each edge model; the index is the edge model as an integer.
    trees: [OnceLock<Arc<ContactTree>>; 2],
}

impl Profile {
    /// Creates a profile from the heights in m of an equivalent line. Neighbouring points have the
    /// distance `spacing` in m. Heights measured along a line on a body are a cut, not an
    /// equivalent line; `asperity_surface::Topography` analyses such heights.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a profile without points, and for a spacing or a height
    /// out of its range.
    pub fn from_heights(heights: impl Into<Vec<f64>>, spacing: f64) -> Result<Self, ContactError> {
        let mut heights = heights.into();
        let [_, summit] = range(&heights, LARGEST).map_err(|index| ContactError::Value {
            name: format!("height with index {index}"),
            value: heights[index],
            allowed: "from -1e50 to 1e50 m",
        })?;
        for height in &mut heights {
            *height = summit - *height;
        }
        Ok(Profile {
            summit,
            ..Profile::from_gaps(heights, spacing)?
        })
    }

    /// Creates a profile from the gaps in m of an equivalent line. Neighbouring points have the
    /// distance `spacing` in m. A gap is the depth of a point below the highest point of the
    /// equivalent line, so at least one gap is 0. The equivalent line of a sphere of the radius R
    /// has the gaps x²/R. These gaps are twice the depths x²/(2R) of a cut through the sphere.
    ///
    /// ```
    /// use asperity_contact::Profile;
    ///
    /// let wedge: Vec<f64> = (-50..=50).map(|i| 1.0e-8 * f64::from(i).abs()).collect();
    /// assert_eq!(Profile::from_gaps(wedge, 1.0e-7)?.deepest(), 50.0 * 1.0e-8);
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a profile without points, for a spacing or a gap out of
    /// its range, or if the smallest gap is not 0.
    pub fn from_gaps(gaps: impl Into<Arc<Vec<f64>>>, spacing: f64) -> Result<Self, ContactError> {
        let gaps = gaps.into();
        let points = gaps.len();
        let length = spacing * points as f64;
        let is_allowed = (1..=MOST_POINTS).contains(&points);
        let allowed = "from 1 to 268435456";
        check("number of points", points as f64, is_allowed, allowed)?;
        let metres = "from 1e-50 to 1e50 m";
        check("spacing", spacing, is_positive(spacing), metres)?;
        check("spacing times points", length, is_positive(length), metres)?;
        let [smallest, deepest] = range(&gaps, f64::MAX).map_err(|index| ContactError::Value {
            name: format!("gap with index {index}"),
            value: gaps[index],
            allowed: "from 0 to 1e50 m",
        })?;
        let allowed = "0: the highest point has no gap";
        let name = "smallest gap of the profile";
        check(name, smallest, smallest == 0.0, allowed)?;
        let name = "largest gap of the profile";
        check(name, deepest, deepest <= LARGEST, "at most 1e50 m")?;
        let springs = Arc::new(Springs {
            gaps,
            deepest,
            trees: Default::default(),
        });
        Ok(Profile {
            springs,
            spacing,
            length,
            first: 0,
            summit: 0.0,
            nominal_form: NominalForm::Unstated,
        })
    }

    /// Places the profile on a foundation, a row of springs, of the length `length` in m. The
    /// foundation may be longer than the profile. `first` is the index of the leftmost spring under
    /// the profile.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a length that is not from 1e-50 to 1e50 m, or if the
    /// profile would extend beyond the right end of the foundation.
    ///
    /// ```
    /// use asperity_contact::Profile;
    ///
    /// // A punch of four springs in the middle of ten.
    /// let punch = Profile::from_gaps(vec![0.0; 4], 1.0e-6)?.on_foundation(1.0e-5, 3)?;
    /// assert_eq!((punch.points(), punch.length(), punch.position(0)), (4, 1.0e-5, 3.5e-6));
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn on_foundation(self, length: f64, first: usize) -> Result<Self, ContactError> {
        let end = (first as f64 + self.points() as f64) * self.spacing;
        let is_allowed = is_positive(length) && end <= length * (1.0 + 1e-9);
        let allowed = "at least the end of the profile, at most 1e50 m";
        check("length of the foundation", length, is_allowed, allowed)?;
        Ok(Profile {
            length,
            first,
            ..self
        })
    }

    /// Returns this profile with other springs: each cell is divided into `parts` parts, and `gaps`
    /// are the gaps in m of the springs after the division.
    pub(super) fn divided(&self, gaps: Vec<f64>, parts: usize) -> Result<Self, ContactError> {
        let divided = Profile::from_gaps(gaps, self.spacing / parts as f64)?;
        Ok(Profile {
            springs: divided.springs,
            spacing: divided.spacing,
            first: self.first * parts,
            ..self.clone()
        })
    }

    /// Shifts the heights of the profile so that the height of its highest point is `summit` in m.
    ///
    /// # Errors
    /// Returns [`ContactError::Value`] for a height that is not from −1e50 to 1e50 m.
    pub fn with_summit(self, summit: f64) -> Result<Self, ContactError> {
        let is_allowed = summit.abs() <= LARGEST;
        let allowed = "from -1e50 to 1e50 m";
        check("height of the highest point", summit, is_allowed, allowed)?;
        Ok(Profile { summit, ..self })
    }

    /// Sets the form of the body behind the profile. [`Cycle::warnings`](crate::Cycle::warnings)
    /// depends on this form; forces and energies do not.
    #[must_use]
    pub fn with_nominal_form(self, nominal_form: NominalForm) -> Self {
        Profile {
            nominal_form,
            ..self
        }
    }

    /// Returns the form of the body that was stated by [`Profile::with_nominal_form`].
    pub fn nominal_form(&self) -> NominalForm {
        self.nominal_form
    }

    /// Returns true if the body is curved, so that its contact should end inside the profile. The
    /// form set by [`Profile::with_nominal_form`] decides. If no form is set, the heights decide:
    /// the profile is divided into 16 parts, and the body counts as curved if two conditions hold.
    ///
    /// * The mean gap grows from the part with the smallest mean gap to both ends of the profile.
    /// * Near the ends the mean gap grows at least 0.75 times as fast as on average.
    pub fn is_curved(&self) -> bool {
        match self.nominal_form {
            NominalForm::Curved => true,
            NominalForm::Flat => false,
            NominalForm::Unstated => falls_to_both_ends(self.gaps()),
        }
    }

    /// Returns a warning that the heights may not be those of an equivalent line. Returns `None` if
    /// the form of the body has been stated. Also returns `None` for a profile without height
    /// differences, because a flat profile is its own equivalent line.
    pub fn doubt(&self) -> Option<Warning> {
        if self.nominal_form != NominalForm::Unstated || self.deepest() == 0.0 {
            return None;
        }
        let doubt = match radius_of_cut(self.gaps(), self.spacing) {
            Some(radius) => Warning::CutLikeHeights { radius },
            None => Warning::HeightsAsProfile,
        };
        Some(doubt)
    }

    /// Returns the number of points N, one for each spring under the profile.
    pub fn points(&self) -> usize {
        self.gaps().len()
    }

    /// Returns the distance Δx between neighbouring points in m.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Returns the length in m of the foundation, the row of springs under the profile. The length
    /// is the number of points times the spacing, unless [`Profile::on_foundation`] has set another
    /// length.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the gap of each point in m, at least 0: how far the point lies below the highest
    /// point.
    pub fn gaps(&self) -> &[f64] {
        &self.springs.gaps
    }

    /// Returns the gap of each point in m as a shared array.
    pub fn shared_gaps(&self) -> &Arc<Vec<f64>> {
        &self.springs.gaps
    }

    /// Returns the largest gap in m: the depth of the lowest point below the highest point.
    pub fn deepest(&self) -> f64 {
        self.springs.deepest
    }

    /// Returns the height of each point in m. The last digit may differ from the given height
    /// because of rounding.
    pub fn heights(&self) -> impl Iterator<Item = f64> {
        self.gaps().iter().map(|gap| self.summit - gap)
    }

    /// Returns the position x in m of the point with this index. Positions are measured from the
    /// left end of the foundation.
    pub fn position(&self, index: usize) -> f64 {
        self.place(index as f64 + 0.5)
    }

    /// Returns the position of a point in m from the left end of the foundation. `cells` is the
    /// distance of the point from the left end of the profile, in units of the spring spacing.
    pub(super) fn place(&self, cells: f64) -> f64 {
        (self.first as f64 + cells) * self.spacing
    }

    /// Builds the contact tree of the profile, which states where patches in contact can merge.
    /// `edges` states where the edges of contact patches may lie. The new tree reuses the memory of
    /// `memory`, a [tree](ContactTree) that is no longer needed. Without this call, the first
    /// contact with adhesion builds the tree in new memory.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if the tree does not fit into memory.
    ///
    /// ```
    /// use asperity_contact::motion::ContactTree;
    /// use asperity_contact::{Edges, Profile};
    ///
    /// let profile = Profile::from_gaps(vec![0.0, 3.0e-8, 1.0e-8], 1.0e-6)?;
    /// profile.build_tree(Edges::SubCell, ContactTree::default())?;
    /// // The next profile reuses the memory.
    /// Profile::from_gaps(vec![2.0e-8, 0.0], 1.0e-6)?
    ///     .build_tree(Edges::SubCell, profile.into_tree())?;
    /// # Ok::<(), asperity_contact::ContactError>(())
    /// ```
    pub fn build_tree(&self, edges: Edges, memory: ContactTree) -> Result<(), ContactError> {
        self.springs.tree_in(memory, edges).map(|_| ())
    }

    /// Consumes the profile and returns its contact tree, so that [`Profile::build_tree`] can reuse
    /// the memory. The returned tree is empty if no tree has been built, or if a clone of the
    /// profile or a contact still uses the tree.
    pub fn into_tree(self) -> ContactTree {
        let Some(springs) = Arc::into_inner(self.springs) else {
            return ContactTree::default();
        };
        let trees = springs.trees.into_iter().filter_map(OnceLock::into_inner);
        trees.filter_map(Arc::into_inner).next().unwrap_or_default()
    }
}

/// Two profiles are equal if their points have the same positions and heights.
impl PartialEq for Profile {
    fn eq(&self, other: &Self) -> bool {
        self.spacing == other.spacing
            && self.length == other.length
            && self.summit == other.summit
            && self.first == other.first
            && self.springs.gaps == other.springs.gaps
    }
}

impl Springs {
    /// Returns the scale by which the gaps are converted to integers, so that their sums are exact.
    pub fn scale(&self) -> GapScale {
        GapScale::for_gaps_up_to(self.deepest)
    }

    /// Returns the contact tree of the gaps, which states where patches in contact can merge.
    /// `edges` states where the edges of contact patches may lie.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn tree(&self, edges: Edges) -> Result<&Arc<ContactTree>, ContactError> {
        self.tree_in(ContactTree::default(), edges)
    }

    fn tree_in(
        &self,
        memory: ContactTree,
        edges: Edges,
    ) -> Result<&Arc<ContactTree>, ContactError> {
        let tree = &self.trees[edges as usize];
        if let Some(tree) = tree.get() {
            return Ok(tree);
        }
        let built = Arc::new(memory.rebuild(&self.gaps, self.deepest, edges)?);
        Ok(tree.get_or_init(|| built))
    }
}

/// Number of independent comparisons in each step of the search for the smallest and the largest
/// value. The processor does them at the same time; with a single sequence, each comparison would
/// wait for the one before.
const LANES: usize = 8;

/// Returns the smallest and the largest value. If a value is not a number or has a magnitude above
/// `most`, returns the index of the first such value as the error.
fn range(values: &[f64], most: f64) -> Result<[f64; 2], usize> {
    let mut extremes = Extremes {
        smallest: [f64::INFINITY; LANES],
        largest: [f64::NEG_INFINITY; LANES],
        are_numbers: true,
    };
    let (blocks, last) = values.as_chunks::<LANES>();
    for block in blocks {
        extremes.include(block);
    }
    extremes.include(last);
    let smallest = extremes.smallest.into_iter().fold(f64::INFINITY, f64::min);
    let largest = extremes
        .largest
        .into_iter()
        .fold(f64::NEG_INFINITY, f64::max);
    let are_allowed = extremes.are_numbers && smallest.abs() <= most && largest.abs() <= most;
    if values.is_empty() || are_allowed {
        return Ok([smallest, largest]);
    }
    let is_allowed = |value: &f64| value.abs() <= most;
    let first = values.iter().position(|value| !is_allowed(value));
    Err(first.unwrap_or(0))
}

/// Smallest and largest value of each lane.
struct Extremes {
    smallest: [f64; LANES],
    largest: [f64; LANES],
    /// False if any value is not a number.
    are_numbers: bool,
}

impl Extremes {
    /// Updates the extremes with a block of values, one value for each lane. A block may be shorter
    /// than the number of lanes.
    #[inline]
    fn include(&mut self, values: &[f64]) {
        let lanes = self.smallest.iter_mut().zip(&mut self.largest);
        for ((smallest, largest), &value) in lanes.zip(values) {
            *smallest = if value < *smallest { value } else { *smallest };
            *largest = if value > *largest { value } else { *largest };
            self.are_numbers &= !value.is_nan();
        }
    }
}
