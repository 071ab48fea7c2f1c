//! Edits of the number of random profiles.

use super::edit;
use crate::explorer::app::App;
use crate::explorer::editor::Edited;
use crate::explorer::parameters::Setting;
use crate::explorer::profiles::ALLOWED;

/// Returns true if the selected row is the number of random profiles.
pub fn is_selected(app: &App) -> bool {
    let selected = app.edit.parameter();
    selected.is_some_and(|parameter| parameter.setting == Setting::Profiles)
}

/// Sets the number of random profiles to a typed number.
pub fn accept(app: &mut App, typed: &str) -> Result<(), String> {
    let [least, most] = [*ALLOWED.start(), *ALLOWED.end()];
    match typed.trim().parse() {
        Ok(count) if ALLOWED.contains(&count) => {
            set(app, count);
            Ok(())
        }
        _ => Err(format!(
            "{}: allowed: a whole number from {least} to {most}",
            typed.trim()
        )),
    }
}

/// Changes the number of random profiles by a number of steps.
pub fn step(app: &mut App, steps: i32, coarse: bool) {
    edit::show_parameters(app);
    let Some(parameter) = app.edit.parameter() else {
        return;
    };
    let present = app.edit.profiles.to_string();
    let next = parameter.field.stepped(&present, steps, coarse);
    match next.and_then(|next| next.parse().ok()) {
        Some(count) => set(app, count),
        None => {
            let allowed = parameter.field.allowed();
            edit::refuse(app, format!("no further step; allowed: {allowed}"));
        }
    }
}

fn set(app: &mut App, profiles: u64) {
    let edited = Edited {
        profiles,
        ..app.edit.edited()
    };
    edit::adopt_all(app, edited);
}
