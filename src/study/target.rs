//! Quantities that an axis may vary: the numbers of a scene by their paths, and others that are derived from several.

use crate::analysis::Governing;
use crate::scene::{
    Adhesion, FIELDS, Field, Move, Range, Roughness, RoughnessParameter, Scene, Tree, field, nearest,
};
use crate::surface::SelfAffine;

/// Quantities that are not fields of a scene.
pub const DERIVED: &[&str] = &["kappa", "elastic_energy_ratio", "preload", "springs_per_wave"];

/// Numbers that cannot be varied: the version is no parameter, and seeds are counted from the plan's.
const FIXED: &[&str] = &["version", "roughness.seed"];

/// A quantity that an axis varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A number, or an end of a pair; fields of several variants may share its path.
    Field(&'static Field, Part),
    /// The force, N, or indentation, m, of a loading stage.
    Leg(usize),
    /// κ or e_el/γ, by the work of adhesion; replaces the work of the scene.
    RoughnessParameter(RoughnessParameter),
    /// Preload F_n in units of E* h L.
    Preload,
    /// Springs per period of the shortest wave: the last mode is points over this number.
    SpringsPerWave,
}

/// Part of a field's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The number itself.
    All,
    /// First number of a pair.
    First,
    /// Last number of a pair.
    Last,
}

impl Part {
    /// Path of the part of a field.
    fn path(self, field: &Field) -> String {
        format!("{}{}", field.path, self.suffix())
    }

    /// End of the path after that of the field.
    fn suffix(self) -> &'static str {
        match self {
            Part::All => "",
            Part::First => ".0",
            Part::Last => ".1",
        }
    }
}

/// All numbers of a scene that an axis may vary, with their paths.
fn numbers() -> impl Iterator<Item = (String, &'static Field, Part)> {
    let parts = |field: &'static Field| match field.range {
        _ if FIXED.contains(&field.path) => &[][..],
        Range::Real { .. } | Range::Whole { .. } => &[Part::All],
        Range::Band { .. } => &[Part::First, Part::Last],
        _ => &[],
    };
    let all = FIELDS.iter().flat_map(move |field| parts(field).iter().map(move |part| (field, *part)));
    all.map(|(field, part)| (part.path(field), field, part))
}

/// No number of a scene has this path.
pub struct TargetError {
    /// The nearest valid path.
    pub near: Option<String>,
}

/// Part of a computation that a changed number repeats; later variants repeat least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shapes {
    /// The heights of the roughness, by a transform.
    Roughness,
    /// The profile, from known heights.
    Line,
    /// The passes over the tree alone.
    Passes,
}

impl Target {
    /// Quantity of a path.
    pub fn of(path: &str) -> Result<Target, TargetError> {
        match path {
            "preload" => return Ok(Target::Preload),
            "springs_per_wave" => return Ok(Target::SpringsPerWave),
            _ => {}
        }
        if let Some(parameter) = RoughnessParameter::named(path).filter(|one| one.name() == path) {
            return Ok(Target::RoughnessParameter(parameter));
        }
        let number = numbers().find(|(number, ..)| number == path);
        let leg = || path.strip_prefix("loading.")?.strip_suffix(".0")?.parse().ok().map(Target::Leg);
        number.map(|(_, field, part)| Target::Field(field, part)).or_else(leg).ok_or_else(|| {
            let names: Vec<String> =
                numbers().map(|(path, ..)| path).chain(DERIVED.iter().map(ToString::to_string)).collect();
            TargetError { near: nearest(path, names.iter().map(String::as_str)).map(str::to_string) }
        })
    }

    /// Returns true for an integer quantity.
    pub fn is_whole(self) -> bool {
        matches!(self, Target::Field(field, _) if !matches!(field.range, Range::Real { .. }))
    }

    /// Part of the computation that a change of the quantity repeats.
    pub fn shapes(self) -> Shapes {
        let field = match self {
            Target::SpringsPerWave => return Shapes::Roughness,
            Target::Leg(_) | Target::RoughnessParameter(_) | Target::Preload => return Shapes::Passes,
            Target::Field(field, _) => field,
        };
        match (field.parent(), field.path) {
            // Heights are scaled to their amplitude.
            ("form", _) | (_, "length" | "roughness.rms_height" | "roughness.rms_gradient") => Shapes::Line,
            ("roughness", _) | (_, "numerics.points") => Shapes::Roughness,
            _ => Shapes::Passes,
        }
    }

    /// Sets quantities to their values in a scene; quantities that depend on others are set last.
    ///
    /// # Errors
    /// The place of a number that the scene does not have, and the reason.
    pub fn set_all(
        values: impl Iterator<Item = (Target, f64)> + Clone,
        scene: &mut Scene,
    ) -> Result<(), (usize, String)> {
        // Consecutive fields are set in one tree.
        let (mut fields, mut last) = (None, 0);
        for follows in [false, true] {
            for (place, (target, value)) in values.clone().enumerate() {
                let failed = |reason: String| (place, reason);
                if (target == Target::SpringsPerWave) != follows {
                    continue;
                }
                if let Target::Field(field, part) = target {
                    last = place;
                    let tree = fields.get_or_insert_with(|| Tree::of(scene));
                    set(tree, &part.path(field), value).map_err(failed)?;
                } else {
                    if let Some(tree) = fields.take() {
                        *scene = tree.scene().map_err(|reason| (last, reason))?;
                    }
                    target.set(scene, value).map_err(failed)?;
                }
            }
        }
        if let Some(tree) = fields {
            *scene = tree.scene().map_err(|reason| (last, reason))?;
        }
        Ok(())
    }

    /// Value of the quantity in a scene, if stated by the scene: κ and the preload depend on several numbers.
    pub fn get(self, scene: &Scene) -> Option<f64> {
        match self {
            Target::RoughnessParameter(_) | Target::Preload => None,
            Target::SpringsPerWave => {
                let last = Target::of("roughness.modes.1").ok()?.get(scene)?;
                Some(scene.numerics.points as f64 / last)
            }
            Target::Leg(index) => match scene.loading.get(index)? {
                Move::ToForce(to) | Move::ToIndentation(to) => Some(*to),
                _ => None,
            },
            Target::Field(field, part) => Tree::of(scene).get(&part.path(field)),
        }
    }

    /// Sets the quantity to a value in a scene; the preload, which is no part of a scene, is left to the run.
    ///
    /// # Errors
    /// The scene has no such number.
    pub fn set(self, scene: &mut Scene, value: f64) -> Result<(), String> {
        match self {
            Target::Preload => {}
            Target::RoughnessParameter(parameter) => {
                let by_parameter = Ok(Adhesion::by_parameter(parameter, value));
                let changed = scene.adhesion.map_or(by_parameter, |one| one.with_parameter(parameter, value));
                scene.adhesion = Some(changed?);
            }
            Target::SpringsPerWave => {
                let last = (scene.numerics.points as f64 / value).round();
                Target::of("roughness.modes.1").map_or(Ok(()), |modes| modes.set(scene, last))?;
            }
            Target::Leg(index) => match scene.loading.get_mut(index) {
                Some(Move::ToForce(to) | Move::ToIndentation(to)) => *to = value,
                Some(_) => return Err(format!("leg {index} of the scene has no number")),
                None => return Err(format!("the scene has {} legs, the first is 0", scene.loading.len())),
            },
            Target::Field(field, part) => {
                let mut tree = Tree::of(scene);
                set(&mut tree, &part.path(field), value)?;
                *scene = tree.scene()?;
            }
        }
        Ok(())
    }
}

/// Sets the number at a path.
fn set(tree: &mut Tree, path: &str, number: f64) -> Result<(), String> {
    if tree.set(path, number) {
        Ok(())
    } else {
        Err(format!("the scene has no {}", path.trim_end_matches(".0").trim_end_matches(".1")))
    }
}

/// Governing parameters of a scene with a self-affine profile.
pub(super) fn governing(scene: &Scene) -> Option<Governing> {
    let Some(Roughness::SelfAffine { hurst, modes: (first, last), .. }) = scene.roughness else {
        return None;
    };
    let unit = SelfAffine { hurst, first, last }.unit_amplitude(scene.length);
    Some(Governing::of(scene, Some(unit), None))
}

/// Symbol and SI unit of the quantity at a path; `1` for numbers without a unit, empty without a symbol.
#[must_use]
pub fn symbol_and_unit(path: &str) -> (&'static str, &'static str) {
    match Target::of(path) {
        Ok(Target::RoughnessParameter(parameter)) => (parameter.symbol(), "1"),
        Ok(Target::Preload) => ("F_n/(E* h L)", "1"),
        Ok(Target::SpringsPerWave) => ("", "1"),
        Ok(Target::Field(_, Part::First)) => ("k_min", "1"),
        Ok(Target::Field(_, Part::Last)) => ("k_max", "1"),
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
            ("rough-sphere", "elastic_energy_ratio", 0.5, vec![("adhesion", "(elastic_energy_ratio: 0.5)")]),
            ("rough-sphere", "adhesion.work", 0.015, vec![("adhesion.work", "0.015")]),
            ("kendall-punch", "form.radius", 2.5e-5, vec![("form.radius", "2.5e-5")]),
        ] {
            let document = open(base).unwrap();
            let overrides: Vec<_> =
                overrides.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
            let expected = document.set_all(&overrides).unwrap();
            let mut scene = document.scene().clone();
            let target = Target::of(path).ok().unwrap();
            target.set(&mut scene, value).unwrap();
            assert_eq!(&scene, expected.scene(), "{path}");
            assert_eq!(
                target.get(&scene),
                Some(value).filter(|_| !matches!(target, Target::RoughnessParameter(_))),
                "{path}"
            );
        }
        let mut scene = rough.scene().clone();
        Target::SpringsPerWave.set(&mut scene, 8.0).unwrap();
        assert_eq!(Target::SpringsPerWave.get(&scene), Some(8.0));
        let points = scene.numerics.points;
        assert_eq!(Tree::of(&scene).get("roughness.modes.1"), Some((points / 8) as f64));
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
    fn fields_that_a_scene_does_not_have_are_stated() {
        let mut scene = open("jkr-sphere").unwrap().scene().clone();
        for path in
            ["roughness.hurst", "form.angle", "loading.7.0", "numerics.solver.step", "springs_per_wave"]
        {
            assert!(Target::of(path).ok().unwrap().set(&mut scene, 1.0).is_err(), "{path}");
        }
    }
}
