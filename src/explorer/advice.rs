//! Words of the explorer for remedies. A remedy removes the cause of an error or a warning, and the
//! words name the row or the key of the explorer that applies it.

use asperity_data::Remedy;

/// Returns words that state how the user applies a remedy in the explorer. A remedy is a step that
/// removes the cause of an error or a warning. If the explorer has no row for the remedy, the words
/// describe an option of the command line.
pub fn row(remedy: &Remedy) -> String {
    let words = match remedy {
        Remedy::SurfaceName => "the row roughness.surface_name",
        Remedy::NoSurfaceName => "no roughness.surface_name",
        Remedy::Channel => "the row roughness.channel",
        Remedy::Unit(unit) => return format!("{unit} on the row roughness.unit"),
        Remedy::HeightUnit(unit) => return format!("{unit} on the row roughness.height_unit"),
        Remedy::Spacing => "0.5um on the row roughness.spacing",
        Remedy::Interpolate => "the row roughness.interpolate",
        Remedy::Resample => "the row roughness.resample",
        Remedy::Robust => "the row roughness.robust replaces it",
        Remedy::TipRadius(radius) => {
            return format!("asperity surface --tip-radius {radius} uses it");
        }
        Remedy::Columns => "1,3 or height,force on the row columns",
        Remedy::Units => "nm,nN on the row units",
        Remedy::ForceOfOne => "nm,3.01nN on the row units",
        Remedy::Ramp => "500nm on the row ramp",
        Remedy::NegateDisplacement => "displacement on the row negate",
        Remedy::NegateForce => "force on the row negate where tension counts as positive",
        Remedy::NegateNone => "none on the row negate for a body that is pulled there",
        Remedy::FreePoints => "a number on the row free points",
        Remedy::Segment(1) => "1 on the row segments for an approach alone",
        Remedy::Segment(2) => "2 on the row segments for the retraction alone",
        Remedy::Segment(number) => return format!("{number} on the row segments"),
        Remedy::RemoveDrift => "remove on the row drift takes it off",
        Remedy::RemoveTilt => "remove on the row tilt takes it off",
        Remedy::Noise => "a force on the row noise",
        Remedy::Free(parameter) => return format!("a fit of {parameter} too"),
        Remedy::FreeRange => "another range by asperity fit",
        Remedy::FreeIn(range) => return format!("asperity fit --free {range} searches beyond"),
        Remedy::ManyProfiles => "asperity fit compares the curve with many of them",
        Remedy::Profiles(count) => return format!("{count} profiles"),
        Remedy::MoreProfiles => "the row profiles",
        Remedy::NoProfiles => "a fit of the profile of the scene",
        Remedy::RoughnessErrors => "asperity fit takes them into account",
        Remedy::NoRoughnessErrors => "no errors of the roughness",
        Remedy::Grid(cells) => return format!("{cells} cells"),
        Remedy::FinerGrid => "asperity reference refines the squares",
        Remedy::Surfaces => "asperity reference takes more of them",
        Remedy::Tolerance => "the key %",
        Remedy::Preload => "a loading that presses before",
        Remedy::Range => "a range by asperity find",
        Remedy::FormOfScene => "a form, such as Paraboloid(radius: 1e-5), makes it a sphere",
        Remedy::FigureAxes => "two axes of the study",
        Remedy::FixAxis(value) => return format!("{value} fixes one"),
        Remedy::OtherValue(path) => return format!("another value of {path}"),
        Remedy::RoughnessField(name, None) => return format!("roughness.{name}"),
        Remedy::RoughnessField(name, Some(value)) => return format!("roughness.{name}: {value}"),
        Remedy::FewerThreads => "fewer threads",
    };
    words.to_owned()
}
