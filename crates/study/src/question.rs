//! An inverse question, and its answer on one profile. The question is: at which value of a number
//! of a scene, or at which preload, does a quantity reach a target?

use super::axis::{Axis, Spacing, Target};
use super::coordinates::{Allowed, Coordinates};
use super::error::StudyError;
use super::plan::{PRELOAD, Plan};
use super::quantity::Quantity;
use asperity_contact::{ContactError, Move};
use asperity_data::{AxisScale, Remedy, format_quantity, format_range, parse_quantity};
use asperity_scene::fields::Field;
use asperity_scene::{CheckedScene, RunError, Scene, Simulation, Solver};

/// Ratio of the upper end of the searched range to the value in the scene, and of this value to the
/// lower end.
const FACTOR: f64 = 100.0;
/// Ratio of the largest searched preload to the preload of full contact, for a scene whose loading
/// has no force.
const DEEPER: f64 = 10.0;
/// Largest width of the allowed range of a number with which the whole allowed range is searched.
const NARROW: f64 = 2.0;
/// Share of such a narrow range that is left out at each of its ends.
const MARGIN: f64 = 0.01;
/// If the searched range of preloads begins at 0 N, preloads are evenly spaced up to this share of
/// the largest preload. Above this share they are evenly spaced on a logarithmic scale.
const EVEN_PRELOADS: f64 = 1e-5;

/// Path of the work of adhesion in a scene.
const WORK: &str = "adhesion.work";

/// Question: at which value of one number of a scene does a quantity reach a target? The question
/// is answered on each of several random profiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Number of the scene whose value is sought, or the preload in N. The axis has the path, name
    /// and unit of this number, but no values.
    pub axis: Axis,
    /// Quantity that must reach [`Question::target`].
    pub quantity: Quantity,
    /// Target value of [`Question::quantity`] in the SI unit of the quantity.
    pub target: f64,
    /// Smallest and largest value of the sought number that are tried, in SI units. If the number
    /// is zero or negative in the scene, [`Question::new`] sets both to NaN, and the caller must
    /// set the range before the question is answered.
    pub searched: (f64, f64),
    /// Scale, linear or logarithmic, on which the values of the number are searched.
    scale: AxisScale,
    /// Plan of the scene on its random profiles. It records the quantities that the search needs.
    pub(super) plan: Plan,
}

/// Way in which the quantity depends on the sought number. It determines the method of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Course {
    /// The quantity is monotonic: as the sought number increases, it never falls, or it never
    /// rises.
    OneWay,
    /// The quantity is the ratio F_a/F_n of pull-off force and preload, as a function of the
    /// preload F_n.
    Ratio,
    /// The quantity depends on the preload only through the pull-off force F_a. F_a rises in steps
    /// as the preload increases. Between these steps F_a, and therefore the quantity, is constant.
    Steps,
    /// The quantity may rise and fall.
    Unknown,
}

/// Answer to a [`Question`] on one random profile.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Answer {
    /// Seed of the profile; `None` if the profile of the scene is fixed.
    pub seed: Option<u64>,
    /// Ascending values of the sought number, in SI units, at which the quantity crosses the
    /// target, or at which it becomes equal to the target and stays equal. The relative error of a
    /// value is at most 1e-9. If only some values are allowed, such as whole numbers, the list has
    /// an allowed value next to the crossing. This is the one at which the quantity is at least the
    /// target, apart from rounding errors.
    pub crossings: Vec<f64>,
    /// True if there may be more crossings than [`Answer::crossings`], because the quantity comes
    /// close to the target between two numbers at which it was computed. Even the first crossing
    /// may then be missing.
    pub may_miss: bool,
    /// True if no crossing can be missing. This is so if the quantity is monotonic, is known in
    /// closed form, or was computed at all allowed numbers. If false, the quantity was computed
    /// only at some numbers. Two crossings are then missed if the quantity passes the target and
    /// comes back between two neighbouring numbers.
    pub is_proven: bool,
    /// Number of values of the sought number at which the quantity was computed.
    pub tried: u64,
    /// Smallest and largest value of the sought number at which the quantity has a value; `None` if
    /// there is none. The range is narrower than [`Question::searched`] where the scene does not
    /// allow all searched values.
    pub computed: Option<(f64, f64)>,
    /// For the smallest and for the largest tried number: true if the quantity is at least the
    /// target there. Numbers at which the quantity has no value are ignored.
    pub reached: [bool; 2],
    /// True if F_a(d=0), the pull-off force after first touch, already reaches the target, so that
    /// no preload is needed. Always false if no preload is sought, or if the quantity is not a
    /// pull-off force after the preload.
    pub at_touch: bool,
    /// Smallest and largest value of the quantity at all numbers at which it was computed; `None`
    /// if the quantity has no value at any of these numbers.
    pub reachable: Option<(f64, f64)>,
    /// Values of the quantity just below the first crossing and at the crossing, if the quantity
    /// jumps over the target there. `None` if the quantity reaches the target gradually, or if only
    /// some numbers are allowed.
    pub step: Option<[f64; 2]>,
}

impl Question {
    /// Reads a condition such as `F_a/F_a,max = 80 %` or `dissipated energy = 2 pJ`. The left side
    /// is the symbol or the name of a [`Quantity`]. The right side is a value with a unit, and the
    /// unit may have a prefix.
    ///
    /// # Errors
    /// Returns an error if the text has another form, or if the quantity cannot have this value.
    ///
    /// ```
    /// use asperity_study::Quantity;
    /// use asperity_study::Question;
    ///
    /// assert_eq!(
    ///     Question::parse_condition("F_a/F_a,max = 80 %").ok(),
    ///     Some((Quantity::AdhesionShare, 0.8))
    /// );
    /// assert!(
    ///     Question::parse_condition("F_a/F_a,max = 120 %")
    ///         .unwrap_err()
    ///         .to_string()
    ///         .contains("allowed: from 0 to 1")
    /// );
    /// ```
    pub fn parse_condition(text: &str) -> Result<(Quantity, f64), StudyError> {
        // The text is split at the last `=`, because the symbol F_a(F=0) contains this sign.
        let example = "a quantity and its value, such as \"F_a/F_a,max = 80 %\"";
        let Some((name, value)) = text.rsplit_once('=') else {
            return Err(StudyError::refused(None, format!("{text:?}"), example));
        };
        let quantity =
            Quantity::named(name).map_err(|found| StudyError::refused(None, found, example))?;
        if quantity.is_regime() {
            let found = format!("{} is not a number", quantity.name());
            return Err(StudyError::refused(None, found, example));
        }
        let target = parse_quantity(value, quantity.unit()).map_err(|error| {
            let found = format!("value of {}: {error}", quantity.symbol_or_name());
            StudyError::refused(None, found, example)
        })?;
        let (least, most) = quantity.bounds();
        if target < least || target > most {
            let [found, least, end] =
                [target, least, most].map(|value| format_quantity(value, quantity.unit()));
            let allowed = if most.is_finite() {
                format!("from {least} to {end}")
            } else {
                format!("at least {least}")
            };
            let found = format!("{} = {found}", quantity.symbol_or_name());
            return Err(StudyError::refused(None, found, allowed));
        }
        Ok((quantity, target))
    }

    /// Makes the question: at which value of the number at `path` does a quantity have a given
    /// value? `path` may be `preload`. `condition` is the quantity and its wanted value in SI
    /// units. The question is for `profiles` random profiles of a checked scene.
    ///
    /// The searched values of the number are from a hundredth to a hundred times its value in the
    /// scene. If the allowed range of the number is narrow, as for the Hurst exponent, nearly the
    /// whole allowed range is searched. Preloads are searched from 0 N to a hundred times the
    /// largest force to which the scene is loaded.
    ///
    /// # Errors
    /// Returns an error if the scene lacks the number, or if several profiles are requested and the
    /// profile of the scene is fixed. A preload is refused if the solver of the scene is not
    /// [`Solver::Exact`], or if its half-space relaxes.
    pub fn new(
        scene: &CheckedScene,
        path: &str,
        condition: (Quantity, f64),
        profiles: u64,
        simulation: &mut Simulation,
    ) -> Result<Question, StudyError> {
        let (quantity, target) = condition;
        let Sought {
            axis,
            usual,
            scene: base,
        } = if path == PRELOAD {
            Sought::preload(scene, simulation)?
        } else {
            Sought::number(scene, path, simulation)?
        };
        let UsualRange { scale, ends } = usual;
        StudyError::check_profiles(scene, profiles)?;
        let plan = Plan::of_scene(&base, profiles, &recorded(&axis, quantity));
        // The usual range is a range of ratios, so there is none around zero or a negative number.
        let searched = ends.unwrap_or((f64::NAN, f64::NAN));
        Ok(Question {
            axis,
            quantity,
            target,
            searched,
            scale,
            plan,
        })
    }

    /// Returns an error if the range of searched values ([`Question::searched`]) is empty, or if
    /// one of its ends is NaN.
    pub(super) fn check(&self) -> Result<(), StudyError> {
        let (from, to) = self.searched;
        // This comparison also refuses an end that is NaN.
        if from < to && (to - from).is_finite() {
            return self.check_allowed();
        }
        if from.is_nan() {
            let found = "there is no usual range around a number that is not above 0";
            return Err(self.refused(found, "a range").with(Remedy::Range));
        }
        let first = format_quantity(from, self.axis.unit);
        let last = format_quantity(to, self.axis.unit);
        let allowed = "two finite numbers, the first below the second";
        Err(self.refused(&format!("range {first} to {last}"), allowed))
    }

    /// Returns an error for a range that contains no allowed number, such as no whole number.
    fn check_allowed(&self) -> Result<(), StudyError> {
        if self.coordinates().is_some() {
            return Ok(());
        }
        let range = format_range(self.searched, 4, self.axis.unit);
        let allowed = if self.allowed() == Allowed::Whole {
            "a range with a whole number"
        } else {
            "a range with a number for which whole waves fit on the length"
        };
        Err(self.refused(&format!("range {range}"), allowed))
    }

    pub(super) fn refused(&self, found: &str, allowed: &str) -> StudyError {
        StudyError::refused(Some(&self.axis.path), found, allowed)
    }

    /// Returns the number of random profiles on which the question is answered.
    pub fn profiles(&self) -> u64 {
        self.plan.lines
    }

    /// Returns true if the question asks for a preload.
    pub fn is_of_preload(&self) -> bool {
        self.axis.is_of_preloads()
    }

    /// Returns the way in which the quantity depends on the sought number, as far as it is known
    /// without a computation on a profile.
    pub(super) fn course(&self) -> Course {
        match self.axis.target {
            Target::Preload { .. } => match self.quantity {
                Quantity::AdhesionCoefficient => Course::Ratio,
                Quantity::PullOffIndentation => Course::Steps,
                Quantity::Patches => Course::Unknown,
                // A larger preload leaves more springs in contact at each indentation of the
                // unloading. Therefore the pull-off force and the dissipated energy never fall with
                // the preload. Quantities that do not depend on the loading are constant.
                _ => Course::OneWay,
            },
            _ if self.is_adhesion_over_work() => Course::OneWay,
            _ => Course::Unknown,
        }
    }

    /// Returns true if the question asks for a work of adhesion, κ or e_el/γ, and the quantity is
    /// the pull-off force of a loop of an elastic body on a rigid instrument. With a larger work of
    /// adhesion more springs stay in contact at each indentation, so this force never falls.
    fn is_adhesion_over_work(&self) -> bool {
        let is_work = matches!(self.axis.target, Target::Number(Field { path: WORK, .. }));
        let scene = &self.plan.scene;
        let is_loop = match scene.loading[..] {
            [Move::ToTouch | Move::ToZeroForce, Move::ToSeparation] => true,
            [
                Move::ToForce(press) | Move::ToIndentation(press),
                Move::ToSeparation,
            ] => press >= 0.0,
            _ => false,
        };
        let is_loop_force = match self.quantity {
            Quantity::PullOffForce => is_loop,
            Quantity::FirstTouchPullOffForce | Quantity::ZeroForcePullOffForce => true,
            _ => false,
        };
        let is_rigid = scene.loading_stiffness.is_none() && scene.numerics.solver == Solver::Exact;
        let is_rigid = is_rigid && !scene.relaxes();
        (is_work || self.axis.target.parameter().is_some()) && is_loop_force && is_rigid
    }

    /// Returns true if the question asks for the smallest preload at which the quantity reaches the
    /// target. This is so for a quantity that never falls with the preload.
    pub fn seeks_least_preload(&self) -> bool {
        self.is_of_preload() && self.course() == Course::OneWay
    }

    /// Returns true if only those values can be answers for which a whole number of waves fits on
    /// the length. This is so if the roughness is given by wavelengths and the sought number
    /// changes how many waves fit.
    pub fn is_of_whole_waves(&self) -> bool {
        matches!(
            self.allowed(),
            Allowed::Fractions(_) | Allowed::Multiples(_)
        )
    }

    /// Returns the values that the sought number can have.
    pub(super) fn allowed(&self) -> Allowed {
        Allowed::of(&self.axis, &self.plan.scene)
    }

    /// Returns the scale on which the search divides the searched range, such as a logarithmic
    /// scale; `None` if the range contains no allowed value of the sought number.
    pub(super) fn coordinates(&self) -> Option<Coordinates> {
        let (from, to) = self.searched;
        let is_of_preload = self.is_of_preload();
        if is_of_preload && from <= 0.0 && self.course() != Course::OneWay {
            let unit = EVEN_PRELOADS * to.abs().max(from.abs());
            return Some(Coordinates::on_both_sides(unit, [from, to]));
        }
        let scale = if is_of_preload && self.course() == Course::OneWay {
            AxisScale::Linear
        } else if is_of_preload {
            AxisScale::Logarithmic
        } else {
            self.scale
        };
        Coordinates::on(scale, [from, to], self.allowed())
    }
}

/// Returns the quantity without a preload that corresponds to `quantity`, such as F_a(d=0) for F_a.
/// `None` if `axis` is not the preload, or if `quantity` is no pull-off force. A loop that turns at
/// first touch has the smallest pull-off force, since this force never falls with the preload.
pub(super) fn at_touch(axis: &Axis, quantity: Quantity) -> Option<Quantity> {
    match (axis.target, quantity) {
        (Target::Preload { .. }, Quantity::PullOffForce) => Some(Quantity::FirstTouchPullOffForce),
        (Target::Preload { .. }, Quantity::AdhesionShare) => {
            Some(Quantity::FirstTouchAdhesionShare)
        }
        _ => None,
    }
}

/// Returns the quantities that are recorded at each number: the quantity of the question, its value
/// after a turn at first touch, and F_a if the search follows the steps of F_a.
fn recorded(axis: &Axis, quantity: Quantity) -> Vec<Quantity> {
    let follows_steps = matches!(
        quantity,
        Quantity::AdhesionCoefficient | Quantity::PullOffIndentation
    );
    let steps = (axis.is_of_preloads() && follows_steps).then_some(Quantity::PullOffForce);
    std::iter::once(quantity)
        .chain(at_touch(axis, quantity))
        .chain(steps)
        .collect()
}

/// Scale and range on which a number is searched unless the caller sets another range.
struct UsualRange {
    scale: AxisScale,
    /// Smallest and largest searched number; `None` if the value in the scene is zero or negative.
    ends: Option<(f64, f64)>,
}

impl UsualRange {
    /// Returns the usual range of a number whose value in the scene is `present`.
    fn around(axis: &Axis, present: f64) -> UsualRange {
        let mut allowed = None;
        if let Target::Number(field) = axis.target {
            allowed = field.range.ends();
        }
        let (least, most) = allowed.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        if most - least <= NARROW {
            let inside = MARGIN * (most - least);
            return UsualRange {
                scale: AxisScale::Linear,
                ends: Some((least + inside, most - inside)),
            };
        }
        let mut ends = None;
        if present > 0.0 {
            ends = Some(((present / FACTOR).max(least), (present * FACTOR).min(most)));
        }
        UsualRange {
            scale: AxisScale::Logarithmic,
            ends,
        }
    }
}

/// Axis and usual range of the sought number, and the scene with this number as a field.
struct Sought {
    axis: Axis,
    usual: UsualRange,
    scene: Scene,
}

impl Sought {
    fn preload(scene: &CheckedScene, simulation: &mut Simulation) -> Result<Sought, StudyError> {
        if scene.numerics.solver != Solver::Exact {
            return Err(RunError::NeedsExactSolver.into());
        }
        if scene.relaxes() {
            return Err(RunError::from(ContactError::NotElastic).into());
        }
        let reach = simulation.reach(scene)?;
        let mut largest: f64 = 0.0;
        for stage in &scene.loading {
            if let Move::ToForce(force) = stage {
                largest = largest.max(*force);
            }
        }
        let usual = if largest > 0.0 {
            FACTOR * largest
        } else {
            DEEPER * reach.full_contact.0
        };
        // Each profile can reach this force, at whatever indentation it comes into full contact.
        let most = usual.min(reach.force - reach.full_contact.0);
        Ok(Sought {
            axis: Axis::of_preload(),
            usual: UsualRange {
                scale: AxisScale::Linear,
                ends: Some((0.0, most)),
            },
            scene: Scene::clone(scene),
        })
    }

    fn number(
        scene: &CheckedScene,
        path: &str,
        simulation: &mut Simulation,
    ) -> Result<Sought, StudyError> {
        let axis = Axis::new(path, Spacing::List, Vec::new(), scene)?;
        let (_, _, governing) = simulation.make_line(scene)?;
        let mut scene = Scene::clone(scene);
        if let Some(adhesion) = scene.adhesion
            && let Some(work) = governing.work_of_adhesion
            && path == WORK
            && adhesion.parameter().is_some()
        {
            // A scene with κ or e_el/γ has no work of adhesion. The work that follows from it
            // becomes a field of the scene, so that it can be varied.
            scene.adhesion = Some(adhesion.with_work(work));
        }
        let Some(present) = axis.value_in(&scene, Some(&governing)) else {
            let found = "the scene has no such number";
            let allowed = "a number that the scene has";
            return Err(StudyError::refused(Some(path), found, allowed));
        };
        let usual = UsualRange::around(&axis, present);
        Ok(Sought { axis, usual, scene })
    }
}

impl Answer {
    /// Returns the value that answers the question on this profile: the smallest value of the
    /// sought number at which the quantity crosses its target, or the smallest preload that reaches
    /// the target. `None` if there is no such value in the searched range.
    pub(super) fn value(&self, question: &Question) -> Option<f64> {
        let already = question.seeks_least_preload() && self.reached[0];
        if already {
            Some(question.searched.0)
        } else {
            self.crossings.first().copied()
        }
    }
}
