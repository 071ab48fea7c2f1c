//! Words of Python for remedies. A remedy removes the cause of an error or a warning, usually by an
//! argument of a Python function.

use asperity::data::Remedy;

/// Returns words that state how the user applies a remedy in Python. A remedy is a step that
/// removes the cause of an error or a warning. The words are an argument with its value, or an
/// entry of the dictionary `options` of `asperity.fit`.
pub fn argument(remedy: &Remedy) -> String {
    let words = match remedy {
        Remedy::SurfaceName => "channel or surface_name with its name",
        Remedy::NoSurfaceName => "no surface_name",
        Remedy::Channel => "channel",
        Remedy::Unit(unit) => return format!("unit=\"{unit}\""),
        Remedy::HeightUnit(unit) => return format!("height_unit=\"{unit}\""),
        Remedy::Spacing => "spacing=\"0.5um\"",
        Remedy::Interpolate => "interpolate=True",
        Remedy::Resample => "resample=True",
        Remedy::Robust => "robust=True replaces it",
        Remedy::TipRadius(radius) => return format!("tip_radius=\"{radius}\" uses it"),
        Remedy::Columns => "options[\"columns\"], such as [1, 3] or [1, 2, 1, 3]",
        Remedy::Units => "options={\"units\": [\"nm\", \"nN\"]}",
        Remedy::ForceOfOne => "options={\"units\": [\"nm\", \"3.01nN\"]}",
        Remedy::Ramp => "options={\"ramp\": \"500nm\"}",
        Remedy::NegateDisplacement => "options={\"negate\": \"displacement\"}",
        Remedy::NegateForce => "options={\"negate\": \"force\"} where tension counts as positive",
        Remedy::NegateNone => "options={\"negate\": \"none\"} for a body that is pulled there",
        Remedy::FreePoints => "options[\"free_points\"]",
        Remedy::Segment(1) => "options={\"segments\": 1} for an approach alone",
        Remedy::Segment(2) => "options={\"segments\": 2} for the retraction alone",
        Remedy::Segment(number) => return format!("options={{\"segments\": {number}}}"),
        Remedy::RemoveDrift => "options={\"drift\": \"remove\"} takes it off",
        Remedy::RemoveTilt => "options={\"tilt\": \"remove\"} takes it off",
        Remedy::Noise => "options[\"noise\"]",
        Remedy::Free(parameter) => return format!("\"{parameter}\" in free fits it"),
        Remedy::FreeRange => "free with ranges",
        Remedy::FreeIn(range) => return format!("free=[\"{range}\"] searches beyond"),
        Remedy::ManyProfiles => "profiles compares the curve with many of them",
        Remedy::Profiles(count) => return format!("profiles={count}"),
        Remedy::MoreProfiles => "profiles",
        Remedy::NoProfiles => "no profiles",
        Remedy::RoughnessErrors => "options[\"height_error\"], options[\"hurst_error\"] state them",
        Remedy::NoRoughnessErrors => "no height_error and hurst_error in options",
        Remedy::Grid(cells) => return format!("grid={cells}"),
        Remedy::FinerGrid => "grid refines the squares",
        Remedy::Surfaces => "surfaces takes more of them",
        Remedy::Tolerance => "more points",
        Remedy::Preload => "preload presses before",
        Remedy::Range => "range",
        Remedy::FormOfScene => {
            "a form in a Scene with this roughness, such as Paraboloid(radius: 1e-5), makes it a sphere"
        }
        Remedy::FigureAxes => "two axes of the study",
        Remedy::FixAxis(value) => return format!("{value} fixes one"),
        Remedy::OtherValue(path) => return format!("another value of {path}"),
        Remedy::RoughnessField(name, None) => name,
        Remedy::RoughnessField(name, Some(value)) => {
            return format!("{name}=\"{}\"", value.to_lowercase());
        }
        Remedy::FewerThreads => "jobs",
    };
    words.to_owned()
}

/// Returns the name of the argument with which the user applies a remedy, or the name of the entry
/// in the dictionary `options` of `asperity.fit`. `None` if a remedy has neither.
pub fn name(remedy: &Remedy) -> Option<&'static str> {
    let name = match remedy {
        Remedy::SurfaceName | Remedy::NoSurfaceName => "surface_name",
        Remedy::Channel => "channel",
        Remedy::Unit(_) => "unit",
        Remedy::HeightUnit(_) => "height_unit",
        Remedy::Spacing => "spacing",
        Remedy::Interpolate => "interpolate",
        Remedy::Resample => "resample",
        Remedy::Robust => "robust",
        Remedy::TipRadius(_) => "tip_radius",
        Remedy::Columns => "columns",
        Remedy::Units | Remedy::ForceOfOne => "units",
        Remedy::Ramp => "ramp",
        Remedy::NegateDisplacement | Remedy::NegateForce | Remedy::NegateNone => "negate",
        Remedy::FreePoints => "free_points",
        Remedy::Segment(_) => "segments",
        Remedy::RemoveDrift => "drift",
        Remedy::RemoveTilt => "tilt",
        Remedy::Noise => "noise",
        Remedy::Free(_) | Remedy::FreeRange | Remedy::FreeIn(_) => "free",
        Remedy::ManyProfiles | Remedy::Profiles(_) | Remedy::MoreProfiles | Remedy::NoProfiles => {
            "profiles"
        }
        Remedy::RoughnessErrors | Remedy::NoRoughnessErrors => "height_error",
        Remedy::Grid(_) | Remedy::FinerGrid => "grid",
        Remedy::Surfaces => "surfaces",
        Remedy::Preload => "preload",
        Remedy::Range => "range",
        Remedy::FewerThreads => "jobs",
        Remedy::Tolerance
        | Remedy::FormOfScene
        | Remedy::FigureAxes
        | Remedy::FixAxis(_)
        | Remedy::OtherValue(_)
        | Remedy::RoughnessField(..) => {
            return None;
        }
    };
    Some(name)
}
