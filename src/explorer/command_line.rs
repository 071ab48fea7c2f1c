//! Shell commands that repeat what the explorer shows now: a command that opens the scene, and
//! options that read the measured curve.

use asperity_experiment::{CurveOptions, Drift, Tilt};
use asperity_scene::text::quoted;

/// Returns the command for a POSIX shell that opens the scene `name` in `program` and changes its
/// fields by `--set`. Each override is the path of a field and its new value.
pub fn command_line(program: &str, name: &str, overrides: &[(String, String)]) -> String {
    let mut sets = String::new();
    for (path, value) in overrides {
        let set = format!("{path}={value}");
        sets += &format!(" --set {}", quoted(set));
    }
    // A name that begins with `-` is written after `--`, so that it is not read as an option.
    if name.starts_with('-') {
        format!("{program}{sets} -- {}", quoted(name))
    } else {
        format!("{program} {}{sets}", quoted(name))
    }
}

/// Returns the options of a measured curve as arguments of a command. A blank precedes each
/// argument.
pub fn curve_arguments(options: &CurveOptions) -> String {
    let segments: Vec<String> = options.segments.iter().map(ToString::to_string).collect();
    let mut text = String::new();
    add_list(&mut text, "columns", &options.columns);
    add_list(&mut text, "units", &options.units);
    add_list(&mut text, "segments", &segments);
    if let Some(ramp) = options.ramp {
        text += &format!(" --ramp={ramp:?}m");
    }
    if let Some(negate) = options.negate {
        text += &format!(" --negate={negate}");
    }
    if let Some(zero) = options.zero {
        text += &format!(" --zero={zero:?}N");
    }
    match options.drift {
        Drift::Keep => {}
        Drift::Remove => text += " --drift=remove",
        Drift::Known(force) => text += &format!(" --drift={force:?}N"),
    }
    if options.tilt == Tilt::Remove {
        text += " --tilt=remove";
    }
    if let Some(noise) = options.noise {
        text += &format!(" --noise={noise:?}N");
    }
    if let Some(count) = options.free_points {
        text += &format!(" --free-points={count}");
    }
    text
}

fn add_list(text: &mut String, name: &str, values: &[String]) {
    if !values.is_empty() {
        *text += &format!(" --{name}={}", quoted(values.join(",")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_quote_what_a_shell_would_change() {
        let sets = [("form", "None"), ("title", "\"it's\"")]
            .map(|(path, value)| (path.into(), value.into()));
        assert_eq!(
            command_line("asperity", "a.ron", &sets),
            r#"asperity a.ron --set form=None --set 'title="it'\''s"'"#
        );
        assert_eq!(
            command_line("asperity", "-a.ron", &sets[..1]),
            "asperity --set form=None -- -a.ron"
        );
    }
}
