//! Form of the body behind a profile: stated by the author of the profile, or concluded from the
//! heights.

/// Number of parts of equal length into which a profile is divided. The mean gaps of these parts
/// show whether a body is curved.
const PARTS: usize = 16;

/// Smallest steepness at the ends of a profile with which a body counts as curved. On each side of
/// the summit, the steepness is the fall from the last part but one to the outermost part, divided
/// by the mean fall from part to part. It is 1 for a cone and nearly 2 for a sphere. For a rough
/// flat body it is about a half, because its longest wave rises again at the ends of the profile.
const LEAST_FALL_AT_ENDS: f64 = 0.75;

/// Largest rms difference between heights and a parabola for which the heights count as smooth,
/// relative to the depth of the parabola. The limit allows for heights in files with four digits.
const SMOOTH: f64 = 1e-3;

/// Form of the body behind a profile, without the roughness of the body, as the author of the
/// profile states this form.
///
/// ```
/// use asperity_contact::{Contact, Modulus, Move, NominalForm, Profile};
///
/// // The equivalent profile x²/R of a sphere, on a length that is too short for the contact.
/// let gaps: Vec<f64> = (-50..=50)
///     .map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4)
///     .collect();
/// let sphere = Profile::from_gaps(gaps, 1.0e-7)?.with_nominal_form(NominalForm::Curved);
/// let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
///     .work_of_adhesion(0.05)
///     .build()?;
/// let cycle = contact.load(&[Move::ToForce(1.0e-4), Move::ToSeparation])?;
/// assert_eq!(cycle.warnings()[0].name(), "contact_at_ends");
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NominalForm {
    /// The form is not stated. It is also not known whether the heights are those of an equivalent
    /// profile.
    #[default]
    Unstated,
    /// The body is nominally flat. Its contact may reach the ends of the profile.
    Flat,
    /// The body is curved, such as a sphere or a cone, and the heights are those of its equivalent
    /// profile. Its contact must end inside the profile.
    Curved,
}

/// Returns true if a profile falls to both ends as a curved body does. `gaps` are in m. The profile
/// is divided into 16 parts. The mean gap must grow from the part with the smallest mean gap to
/// both ends, and near the ends almost as fast as on average.
pub fn falls_to_both_ends(gaps: &[f64]) -> bool {
    let part = gaps.len() / PARTS;
    if part == 0 {
        return false;
    }
    let mut means = Vec::with_capacity(PARTS);
    for part in gaps.chunks_exact(part).take(PARTS) {
        means.push(part.iter().sum::<f64>() / part.len() as f64);
    }
    let mut summit = 0;
    for (index, mean) in means.iter().enumerate() {
        if *mean < means[summit] {
            summit = index;
        }
    }
    let right = &means[summit..];
    let left: Vec<f64> = means[..=summit].iter().rev().copied().collect();
    falls_to_end(&left) && falls_to_end(right)
}

/// Returns true if the mean gaps grow like those of a curved body. `means` are in the order from
/// the summit to one end. They must grow from part to part, and at the end almost as fast as on
/// average.
fn falls_to_end(means: &[f64]) -> bool {
    let [.., before, last] = means else {
        return false;
    };
    let always_grow = means.windows(2).all(|pair| pair[0] < pair[1]);
    let mean_growth = (last - means[0]) / (means.len() - 1) as f64;
    always_grow && last - before >= LEAST_FALL_AT_ENDS * mean_growth
}

/// Returns the radius R in m of the sphere of which a cut has the gaps `gaps` in m, which are then
/// x²/(2R). Neighbouring points have the distance `spacing` in m. Returns `None` for rough gaps and
/// for gaps of another form.
pub fn radius_of_cut(gaps: &[f64], spacing: f64) -> Option<f64> {
    let [offset, slope, bend] = parabola(gaps)?;
    let middle = 0.5 * (gaps.len() - 1) as f64;
    let summit = middle - 0.5 * slope / bend;
    let depth = bend * middle * middle;
    let is_inside = bend > 0.0 && (0.0..=2.0 * middle).contains(&summit);
    if !is_inside {
        return None;
    }
    let mut squares = 0.0;
    for (index, gap) in gaps.iter().enumerate() {
        let x = index as f64 - middle;
        squares += ((gap - (offset + x * (slope + x * bend))) / depth).powi(2);
    }
    let is_smooth = (squares / gaps.len() as f64).sqrt() <= SMOOTH;
    let radius = spacing * spacing / (2.0 * bend);
    (is_smooth && radius.is_finite()).then_some(radius)
}

/// Returns the coefficients [a, b, c] of the parabola a + b x + c x² that fits the values best
/// (least squares). x is the index of a value minus the index of the middle. Returns `None` for
/// fewer than five values.
fn parabola(values: &[f64]) -> Option<[f64; 3]> {
    if values.len() < 5 {
        return None;
    }
    let middle = 0.5 * (values.len() - 1) as f64;
    let mut sum = 0.0;
    let mut first = 0.0;
    let mut second = 0.0;
    let mut squares = 0.0;
    let mut fourths = 0.0;
    for (index, value) in values.iter().enumerate() {
        // The index is scaled to the range from −1 to 1, so that no power of x is too large for a
        // floating-point number.
        let x = (index as f64 - middle) / middle;
        sum += value;
        first += x * value;
        second += x * x * value;
        squares += x * x;
        fourths += x * x * x * x;
    }
    let count = values.len() as f64;
    let bend = (count * second - squares * sum) / (count * fourths - squares * squares);
    let offset = (sum - bend * squares) / count;
    Some([offset, first / squares / middle, bend / (middle * middle)])
}
