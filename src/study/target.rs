//! What an axis may vary: the numbers of a scene by their paths, and quantities derived from several of them.

use crate::scene::{Adhesion, Form, Leg, Roughness, Scene, Solver, field, nearest};

/// Quantities that are no fields of a scene.
pub const DERIVED: &[&str] = &["kappa", "preload", "springs_per_wave"];

/// Something an axis varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A field.
    Field(Number),
    /// The force, N, or indentation, m, of a leg.
    Leg(usize),
    /// κ of eq. (11), by the work of adhesion; takes the place of the work the scene has.
    Kappa,
    /// Preload F_n in units of E* h L.
    Preload,
    /// Springs for each of the shortest waves: the last mode is points over this.
    SpringsPerWave,
}

/// The numbers of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// `material.youngs_modulus`
    YoungsModulus,
    /// `material.poisson_ratio`
    PoissonRatio,
    /// `material.effective_modulus`
    EffectiveModulus,
    /// `length`
    Length,
    /// `form.radius`
    Radius,
    /// `form.angle`
    Angle,
    /// `form.coefficient`
    Coefficient,
    /// `form.exponent`
    Exponent,
    /// `roughness.hurst`
    Hurst,
    /// `roughness.rms_height`
    RmsHeight,
    /// `roughness.rms_gradient`
    RmsGradient,
    /// `roughness.modes.0`
    FirstMode,
    /// `roughness.modes.1`
    LastMode,
    /// `adhesion.work`
    Work,
    /// `adhesion.kappa`
    AdhesionKappa,
    /// `numerics.points`
    Points,
    /// `numerics.samples`
    Samples,
    /// `numerics.solver.step`
    Step,
}

const NUMBERS: &[(&str, Number)] = &[
    ("material.youngs_modulus", Number::YoungsModulus),
    ("material.poisson_ratio", Number::PoissonRatio),
    ("material.effective_modulus", Number::EffectiveModulus),
    ("length", Number::Length),
    ("form.radius", Number::Radius),
    ("form.angle", Number::Angle),
    ("form.coefficient", Number::Coefficient),
    ("form.exponent", Number::Exponent),
    ("roughness.hurst", Number::Hurst),
    ("roughness.rms_height", Number::RmsHeight),
    ("roughness.rms_gradient", Number::RmsGradient),
    ("roughness.modes.0", Number::FirstMode),
    ("roughness.modes.1", Number::LastMode),
    ("adhesion.work", Number::Work),
    ("adhesion.kappa", Number::AdhesionKappa),
    ("numerics.points", Number::Points),
    ("numerics.samples", Number::Samples),
    ("numerics.solver.step", Number::Step),
];

/// No number of a scene has this path.
pub struct TargetError {
    /// What may have been meant.
    pub near: Option<&'static str>,
}

/// What must be made again where a number changes; later ones need least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shapes {
    /// The heights of the roughness, by a transform.
    Roughness,
    /// The line, from heights that are there.
    Line,
    /// Nothing but the passes over the tree.
    Passes,
}

impl Target {
    /// What a path means.
    pub fn of(path: &str) -> Result<Target, TargetError> {
        let known = |(name, number): &(&str, Number)| (*name == path).then_some(Target::Field(*number));
        let leg = || path.strip_prefix("loading.")?.strip_suffix(".0")?.parse().ok().map(Target::Leg);
        match path {
            "kappa" => return Ok(Target::Kappa),
            "preload" => return Ok(Target::Preload),
            "springs_per_wave" => return Ok(Target::SpringsPerWave),
            _ => {}
        }
        NUMBERS.iter().find_map(known).or_else(leg).ok_or_else(|| {
            let names = NUMBERS.iter().map(|(name, _)| *name).chain(DERIVED.iter().copied());
            TargetError { near: nearest(path, names) }
        })
    }

    /// Whether it is a whole number.
    pub fn is_whole(self) -> bool {
        matches!(self, Target::Field(Number::FirstMode | Number::LastMode | Number::Points | Number::Samples))
    }

    /// What must be made again where it changes.
    pub fn shapes(self) -> Shapes {
        match self {
            Target::SpringsPerWave
            | Target::Field(Number::Hurst | Number::FirstMode | Number::LastMode | Number::Points) => {
                Shapes::Roughness
            }
            Target::Field(
                Number::Length
                | Number::Radius
                | Number::Angle
                | Number::Coefficient
                | Number::Exponent
                | Number::RmsHeight
                | Number::RmsGradient,
            ) => Shapes::Line,
            Target::Leg(_) | Target::Kappa | Target::Preload | Target::Field(_) => Shapes::Passes,
        }
    }

    /// Gives it a value in a scene; the preload, which is no part of one, is left to the run.
    ///
    /// # Errors
    /// Why the scene has no such number.
    pub fn set(self, scene: &mut Scene, value: f64) -> Result<(), String> {
        let adhesion = |scene: &mut Scene| scene.adhesion.unwrap_or(Adhesion { work: None, kappa: None });
        match self {
            Target::Preload => {}
            Target::Kappa => scene.adhesion = Some(Adhesion { work: None, kappa: Some(value) }),
            Target::SpringsPerWave => {
                let last = (scene.numerics.points as f64 / value).round() as u64;
                *modes(scene).ok_or("the scene has no self-affine roughness")? =
                    (modes(scene).map_or(1, |modes| modes.0), last);
            }
            Target::Leg(index) => match scene.loading.get_mut(index) {
                Some(Leg::ToForce(to) | Leg::ToIndentation(to)) => *to = value,
                Some(_) => return Err(format!("leg {index} of the scene has no number")),
                None => return Err(format!("the scene has {} legs, the first is 0", scene.loading.len())),
            },
            Target::Field(number) => match number {
                Number::YoungsModulus => scene.material.youngs_modulus = Some(value),
                Number::PoissonRatio => scene.material.poisson_ratio = Some(value),
                Number::EffectiveModulus => scene.material.effective_modulus = Some(value),
                Number::Length => scene.length = value,
                Number::Radius | Number::Angle | Number::Coefficient | Number::Exponent => {
                    *form(scene, number).ok_or("the form of the scene has no such number")? = value;
                }
                Number::Hurst | Number::RmsHeight | Number::RmsGradient => {
                    let Some(Roughness::SelfAffine { hurst, rms_height, rms_gradient, .. }) =
                        &mut scene.roughness
                    else {
                        return Err("the scene has no self-affine roughness".into());
                    };
                    match number {
                        Number::Hurst => *hurst = value,
                        Number::RmsHeight => *rms_height = Some(value),
                        _ => *rms_gradient = Some(value),
                    }
                }
                Number::FirstMode => {
                    modes(scene).ok_or("the scene has no self-affine roughness")?.0 = value as u64;
                }
                Number::LastMode => {
                    modes(scene).ok_or("the scene has no self-affine roughness")?.1 = value as u64;
                }
                Number::Work => {
                    scene.adhesion = Some(Adhesion { work: Some(value), ..adhesion(scene) });
                }
                Number::AdhesionKappa => {
                    scene.adhesion = Some(Adhesion { kappa: Some(value), ..adhesion(scene) });
                }
                Number::Points => scene.numerics.points = value as u64,
                Number::Samples => scene.numerics.samples = value as u64,
                Number::Step => match &mut scene.numerics.solver {
                    Solver::Stepwise { step } => *step = value,
                    Solver::Exact => return Err("the exact solver has no step".into()),
                },
            },
        }
        Ok(())
    }
}

fn modes(scene: &mut Scene) -> Option<&mut (u64, u64)> {
    match &mut scene.roughness {
        Some(Roughness::SelfAffine { modes, .. }) => Some(modes),
        _ => None,
    }
}

fn form(scene: &mut Scene, number: Number) -> Option<&mut f64> {
    match (scene.form.as_mut()?, number) {
        (Form::Paraboloid { radius } | Form::Punch { radius }, Number::Radius) => Some(radius),
        (Form::Cone { angle }, Number::Angle) => Some(angle),
        (Form::Power { coefficient, .. }, Number::Coefficient) => Some(coefficient),
        (Form::Power { exponent, .. }, Number::Exponent) => Some(exponent),
        _ => None,
    }
}

/// Symbol and SI unit of what an axis varies; `1` for numbers without a unit, empty where there is no symbol.
#[must_use]
pub fn symbol_and_unit(path: &str) -> (&'static str, &'static str) {
    match Target::of(path) {
        Ok(Target::Kappa) => ("κ", "1"),
        Ok(Target::Preload) => ("F_n/(E* h L)", "1"),
        Ok(Target::SpringsPerWave) => ("", "1"),
        Ok(Target::Field(Number::FirstMode)) => ("k_min", "1"),
        Ok(Target::Field(Number::LastMode)) => ("k_max", "1"),
        _ => field(path, None).map_or(("", "1"), |field| (field.symbol, field.unit)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::open;

    #[test]
    fn numbers_are_set_as_by_overrides() {
        let rough = open("rough-sphere").unwrap();
        for (base, path, value, overrides) in [
            ("rough-sphere", "roughness.hurst", 0.55, vec![("roughness.hurst", "0.55")]),
            ("rough-sphere", "roughness.modes.1", 64.0, vec![("roughness.modes.1", "64")]),
            ("rough-sphere", "numerics.points", 8192.0, vec![("numerics.points", "8192")]),
            ("rough-sphere", "length", 1.5e-4, vec![("length", "1.5e-4")]),
            ("rough-sphere", "form.radius", 2.5e-3, vec![("form.radius", "2.5e-3")]),
            ("rough-sphere", "loading.0.0", 2.5e-5, vec![("loading.0.0", "2.5e-5")]),
            ("rough-sphere", "kappa", 1.5, vec![("adhesion", "(kappa: 1.5)")]),
            ("rough-sphere", "adhesion.work", 0.015, vec![("adhesion.work", "0.015")]),
            ("kendall-punch", "form.radius", 2.5e-5, vec![("form.radius", "2.5e-5")]),
        ] {
            let document = open(base).unwrap();
            let overrides: Vec<_> =
                overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
            let expected = document.set_all(&overrides).unwrap();
            let mut scene = document.scene().clone();
            Target::of(path).ok().unwrap().set(&mut scene, value).unwrap();
            assert_eq!(&scene, expected.scene(), "{path}");
        }
        let mut scene = rough.scene().clone();
        Target::SpringsPerWave.set(&mut scene, 8.0).unwrap();
        let points = scene.numerics.points;
        assert_eq!(modes(&mut scene).unwrap().1, points / 8);
    }

    #[test]
    fn every_number_of_the_table_can_be_varied() {
        use crate::scene::{FIELDS, Range};
        for field in FIELDS {
            let number = matches!(field.range, Range::Real { .. } | Range::Whole { .. });
            // The version is no parameter, and seeds are counted from the plan's.
            let meant = number && !["version", "roughness.seed"].contains(&field.path);
            assert_eq!(Target::of(field.path).is_ok(), meant, "{}", field.path);
        }
    }

    #[test]
    fn what_a_scene_does_not_have_is_told() {
        let mut scene = open("jkr-sphere").unwrap().scene().clone();
        for path in
            ["roughness.hurst", "form.angle", "loading.7.0", "numerics.solver.step", "springs_per_wave"]
        {
            assert!(Target::of(path).ok().unwrap().set(&mut scene, 1.0).is_err(), "{path}");
        }
    }
}
