//! Words of the command line for remedies. A remedy removes the cause of an error or a warning,
//! usually by an option.

use asperity_data::{Note, Remedied, Remedy, shown};
use asperity_experiment::ExperimentError;
use asperity_scene::{Origin, RunError, SceneError, SceneErrors};
use asperity_study::StudyError;
use asperity_surface::SurfaceError;
use std::error::Error;

/// Returns the words of the command line for a remedy. These are an option with its value and, if a
/// field of the scene has the same effect, the path of this field.
pub fn option(remedy: &Remedy) -> String {
    let words = match remedy {
        Remedy::SurfaceName => "--channel with its name, in a scene roughness.surface_name",
        Remedy::NoSurfaceName => "no --channel, in a scene no roughness.surface_name",
        Remedy::Channel => "--channel, in a scene roughness.channel or roughness.surface_name",
        Remedy::Unit(unit) => return format!("--unit {unit}, in a scene roughness.unit"),
        Remedy::HeightUnit(unit) => {
            return format!("--height-unit {unit}, in a scene roughness.height_unit");
        }
        Remedy::Spacing => "--spacing 0.5um, in a scene roughness.spacing",
        Remedy::Interpolate => "--interpolate, in a scene roughness.interpolate",
        Remedy::Resample => "--resample, in a scene roughness.resample",
        Remedy::Robust => "--robust replaces it",
        Remedy::TipRadius(radius) => return format!("--tip-radius {radius} uses it"),
        Remedy::Columns => {
            "--columns DISPLACEMENT,FORCE, such as --columns 1,3 or --columns 1,2,1,3"
        }
        Remedy::Units => "--units nm,nN",
        Remedy::ForceOfOne => "--units nm,3.01nN",
        Remedy::Ramp => "--ramp 500nm",
        Remedy::NegateDisplacement => "--negate displacement",
        Remedy::NegateForce => "--negate force where tension counts as positive",
        Remedy::NegateNone => "--negate none for a body that is pulled there",
        Remedy::FreePoints => "--free-points COUNT",
        Remedy::Segment(1) => "--segments 1 for an approach alone",
        Remedy::Segment(2) => "--segments 2 for the retraction alone",
        Remedy::Segment(number) => return format!("--segments {number}"),
        Remedy::RemoveDrift => "--drift remove takes it off",
        Remedy::RemoveTilt => "--tilt remove takes it off",
        Remedy::Noise => "--noise FORCE",
        Remedy::Free(parameter) => return format!("--free {parameter} fits it"),
        Remedy::FreeRange => "--free NAME=A..B",
        Remedy::FreeIn(range) => return format!("--free {range} searches beyond"),
        Remedy::ManyProfiles => "--profiles compares the curve with many of them",
        Remedy::Profiles(count) => return format!("--profiles {count}"),
        Remedy::MoreProfiles => "--profiles",
        Remedy::NoProfiles => "no --profiles",
        Remedy::RoughnessErrors => "--height-error, --hurst-error state them",
        Remedy::NoRoughnessErrors => "no --height-error and --hurst-error",
        Remedy::Grid(cells) => return format!("--grid {cells}"),
        Remedy::FinerGrid => "--grid refines the squares",
        Remedy::Surfaces => "--surfaces takes more of them",
        Remedy::Tolerance => "--tolerance",
        Remedy::Preload => "--preload presses before",
        Remedy::Range => "--range A..B",
        Remedy::FormOfScene => {
            "a form in the scene of --scene, such as Paraboloid(radius: 1e-5), makes it a sphere"
        }
        Remedy::FigureAxes => "--x and --y name the two",
        Remedy::FixAxis(value) => return format!("--at {value} fixes one"),
        Remedy::OtherValue(path) => return format!("--at {path}=VALUE selects another one"),
        Remedy::RoughnessField(name, None) => return format!("roughness.{name}"),
        Remedy::RoughnessField(name, Some(value)) => return format!("roughness.{name}: {value}"),
        Remedy::FewerThreads => "--jobs",
    };
    words.to_owned()
}

/// Returns a note as text. If the note has remedies, the text ends with the options of the command
/// line that apply them.
pub fn note(note: &Note) -> String {
    note.in_words(option)
}

/// Returns an error as text, with the options of the command line that remove its cause or that
/// have caused it.
pub fn advised(error: &(dyn Error + 'static)) -> String {
    if let Some(error) = error.downcast_ref::<SurfaceError>() {
        return error.in_words(option);
    }
    if let Some(error) = error.downcast_ref::<ExperimentError>() {
        return error.in_words(option);
    }
    if let Some(error) = error.downcast_ref::<StudyError>() {
        return error.in_words(option);
    }
    match error.downcast_ref::<RunError>() {
        Some(RunError::Values(errors)) => return of_scene(errors),
        Some(error) => return error.in_words(option),
        None => {}
    }
    match error.downcast_ref::<SceneErrors>() {
        Some(errors) => of_scene(errors),
        None => error.to_string(),
    }
}

/// Returns the errors of a scene, one in each line. If a field was changed on the command line, its
/// error begins with the option `--set` that changed it.
pub fn of_scene(errors: &SceneErrors) -> String {
    let lines: Vec<String> = errors.iter().map(line_of_scene).collect();
    lines.join("\n")
}

fn line_of_scene(error: &SceneError) -> String {
    let Origin::Overrides(overrides) = &error.origin else {
        return error.to_string();
    };
    let mut options = Vec::with_capacity(overrides.len());
    for set in overrides {
        options.push(format!("--set {}", shown(set)));
    }
    format!("{}: {}", options.join(" "), error.what())
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::open;

    #[test]
    fn errors_have_the_options_that_help_or_caused_them() {
        let bytes = b"0 1\n1 bad\n2 3\n3 4\n";
        let unknown = asperity_surface::parse(bytes, &Default::default()).unwrap_err();
        assert_eq!(
            advised(&unknown),
            "no unit of heights is stated; allowed: a unit in the file or beside it: --unit um, in a scene roughness.unit"
        );
        let nested = ExperimentError::File(unknown);
        assert!(advised(&nested).ends_with(": --unit um, in a scene roughness.unit"));

        let scene = open("jkr-sphere").unwrap();
        let set = [("length".to_owned(), "-1".to_owned())];
        let errors = scene.set_all(&set).unwrap_err();
        assert!(errors.to_string().starts_with("length=-1: length = -1"));
        assert!(advised(&errors).starts_with("--set length=-1: length = -1"));
    }
}
