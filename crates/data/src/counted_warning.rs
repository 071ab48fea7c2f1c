//! Premises of the model that some of several random profiles do not meet.

use crate::warning::Warning;

/// A premise of the model that some of several random profiles do not meet.
///
/// ```
/// use asperity_data::{CountedWarning, Warning};
///
/// let mut counted = Vec::new();
/// for springs in [7, 9] {
///     CountedWarning::count(&mut counted, &Warning::FewSpringsInContact { springs });
/// }
/// assert_eq!(counted.len(), 1);
/// assert_eq!(counted[0].profiles, 2);
/// assert_eq!(counted[0].warning, Warning::FewSpringsInContact { springs: 7 });
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CountedWarning {
    /// The premise, with the values of the first profile that does not meet it.
    pub warning: Warning,
    /// Number of profiles that do not meet the premise.
    pub profiles: u64,
}

impl CountedWarning {
    /// Counts one more profile that has the warning `warning`. `counted` is the list of all
    /// warnings of the profiles so far, each with the number of its profiles.
    pub fn count(counted: &mut Vec<CountedWarning>, warning: &Warning) {
        match counted
            .iter_mut()
            .find(|known| known.warning.name() == warning.name())
        {
            Some(known) => known.profiles += 1,
            None => counted.push(CountedWarning {
                warning: warning.clone(),
                profiles: 1,
            }),
        }
    }
}
