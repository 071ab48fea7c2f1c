//! The prompt for a map of any quantity over any two numbers of the scene.

use super::edit;
use super::target::pressing_stage;
use crate::explorer::action::Task;
use crate::explorer::app::App;
use crate::explorer::map_state::{ChosenAxes, ChosenAxis, Live};
use crate::explorer::pane::Pane;
use crate::explorer::parameters::{Parameter, Setting};
use crate::explorer::prompt::Purpose;
use crate::explorer::search::Search;
use crate::explorer::text_line::TextLine;
use asperity_data::{counted, format_range, round_to};
use asperity_scene::fields::{Range, Step};
use asperity_study::{Plan, Quantity};
use std::ops::Bound;

/// Number of values on each side of the value of the scene.
const STEPS: i32 = 4;
/// Ratio of the largest value of an axis to the value of the scene.
const FACTOR: f64 = 3.0;
/// Share of the distance to an end of the allowed range that the values of an axis cover, if the
/// end itself is not allowed.
const BEFORE_OPEN_END: f64 = 0.9;
/// Paths of the numbers that are proposed if the user has not edited two rows yet.
const PROPOSED: [&str; 6] = [
    "material.youngs_modulus",
    "material.modulus",
    "roughness.rms_height",
    "form.radius",
    "adhesion.work",
    "length",
];

/// Asks for the quantity and the two numbers of a map. It proposes the selected row and the row
/// that was edited before it.
pub fn ask(app: &mut App) {
    let rows = numbers(app);
    let selected = app.edit.parameter();
    let is_number = |path: &str| rows.iter().any(|row| row.path == path);
    let mut paths: Vec<&str> = Vec::new();
    paths.extend(selected.map(|row| row.path.as_str()));
    // The heading of the loading and a separation have no number. The preload is meant then.
    let preload = pressing_stage(&app.edit.document.scene().loading);
    let preload = rows
        .iter()
        .find(|row| row.stage.is_some() && row.stage == preload);
    if selected.is_some_and(|row| row.group == "loading") {
        paths.extend(preload.map(|row| row.path.as_str()));
    }
    paths.extend(app.edit.edited_rows.iter().rev().map(String::as_str));
    paths.extend(PROPOSED);
    paths.retain(|path| is_number(path));
    let Some(first) = paths.first() else {
        return app.set_error("the scene has no two numbers for the axes of a map");
    };
    let other = paths.iter().find(|path| !are_same(first, path));
    let Some(second) = other else {
        return app.set_error("the scene has no second number for the other axis of a map");
    };
    let quantity = match app.edit.document.scene().adhesion {
        Some(_) => Quantity::AdhesionShare,
        None => Quantity::ContactFraction,
    };
    let named = |path: &str| {
        let row = rows.iter().find(|row| row.path == path);
        row.map_or_else(String::new, |row| name_of(app, row))
    };
    let (across, up) = (named(first), named(second));
    let text = format!("{} over {across} × {up}", quantity.symbol_or_name());
    app.ask(Purpose::Map, &text);
}

/// Returns true if two paths cannot be the two axes of a map, because they set the same number.
fn are_same(one: &str, other: &str) -> bool {
    const ADHESION: [&str; 3] = [
        "adhesion.work",
        "adhesion.kappa",
        "adhesion.elastic_energy_ratio",
    ];
    one == other || ADHESION.contains(&one) && ADHESION.contains(&other)
}

/// Returns the rows with a number of the scene that an axis can vary.
fn numbers(app: &App) -> Vec<&Parameter> {
    let mut rows = Vec::new();
    for row in app.edit.searchable() {
        let is_of_scene = !matches!(
            row.setting,
            Setting::Heading | Setting::CurveOption(_) | Setting::Profiles
        );
        // The seeds of the profiles of a map follow each other.
        if is_of_scene && row.path != "roughness.seed" && value_of(app, row).is_some() {
            rows.push(row);
        }
    }
    rows
}

/// Returns the number of a row in its SI unit, the first one of a pair; `None` if it has none.
fn value_of(app: &App, row: &Parameter) -> Option<f64> {
    if row.stage.is_some() && row.field.unit.is_empty() {
        return None;
    }
    let written = app.written(row)?;
    match row.field.range {
        Range::Band(..) | Range::Wavelengths(..) => {
            let (first, _) = ron::from_str::<(f64, f64)>(&written).ok()?;
            Some(first)
        }
        Range::Real(..) | Range::Whole(..) => written.parse().ok(),
        _ => None,
    }
}

/// Returns the name of a row in the prompt: the symbol or, for a stage or a row without a symbol,
/// the name.
fn name_of(app: &App, row: &Parameter) -> String {
    let stage = pressing_stage(&app.edit.document.scene().loading);
    if row.stage.is_some() && row.stage == stage {
        Quantity::PreloadForce.symbol().to_owned()
    } else if row.stage.is_some() || row.field.symbol.is_empty() {
        row.name()
    } else {
        row.field.symbol.to_owned()
    }
}

/// The words of the prompt: a quantity, and the names of the numbers across and upwards.
struct Words<'a> {
    quantity: &'a str,
    across: &'a str,
    up: &'a str,
}

impl Words<'_> {
    fn read(typed: &str) -> Option<Words<'_>> {
        let (quantity, axes) = typed.split_once(" over ")?;
        // The sign × is on no keyboard.
        let separators = [" × ", " x ", "×", "*", ",", " and "];
        let mut split = separators.iter().filter_map(|sign| axes.split_once(sign));
        let (across, up) = split.next()?;
        Some(Words {
            quantity: quantity.trim(),
            across: across.trim(),
            up: up.trim(),
        })
    }
}

/// Returns the axes and the quantity that the user has typed, or the reason why they are refused.
fn chosen(app: &App, typed: &str) -> Result<ChosenAxes, String> {
    const FORM: &str = "type a quantity and two rows, such as F_a/F_a,max over E × h";
    let Some(Words {
        quantity,
        across,
        up,
    }) = Words::read(typed)
    else {
        return Err(FORM.to_owned());
    };
    let quantity = Quantity::named(quantity)?;
    let chosen = ChosenAxes {
        across: axis(app, across)?,
        up: axis(app, up)?,
        quantity,
    };
    if are_same(&chosen.across.path, &chosen.up.path) {
        return Err(format!("{across} and {up} set the same number"));
    }
    Ok(chosen)
}

/// Returns the axis for a row that the user has named by its symbol, its path, its name or words.
fn axis(app: &App, name: &str) -> Result<ChosenAxis, String> {
    let rows = numbers(app);
    let is_named = |row: &Parameter| {
        name_of(app, row) == name || row.path == name || row.name().eq_ignore_ascii_case(name)
    };
    let texts: Vec<_> = rows.iter().map(|row| row.texts()).collect();
    let row = match rows.iter().find(|row| is_named(row)) {
        Some(row) => row,
        None => {
            let found = Search::new(&texts, name);
            let first = found.found.first().filter(|_| !name.is_empty());
            let first = first.filter(|_| found.unknown.is_empty());
            let first = first.ok_or_else(|| format!("no row with a number is called {name}"))?;
            rows[*first]
        }
    };
    let value = value_of(app, row).unwrap_or_default();
    let values = around(row, value)?;
    let path = match row.field.range {
        Range::Band(..) | Range::Wavelengths(..) => format!("{}.0", row.path),
        _ => row.path.clone(),
    };
    Ok(ChosenAxis { path, values })
}

/// Returns ascending values around the value of a row, from a third to three times the value, as
/// far as they are allowed.
fn around(row: &Parameter, value: f64) -> Result<Vec<f64>, String> {
    let name = row.name();
    if value == 0.0 {
        return Err(format!(
            "{name} is 0, and there is no range of ratios around it"
        ));
    }
    let is_whole = matches!(row.field.range, Range::Whole(..) | Range::Band(..));
    let is_linear = matches!(row.field.step, Step::Linear(..));
    let [low, high] = ends(row, value);
    let mut values = Vec::new();
    for step in -STEPS..=STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let exact = match (is_linear, step < 0) {
            (true, true) => value + share * (value - low),
            (true, false) => value + share * (high - value),
            (false, _) => value * FACTOR.powf(share),
        };
        let rounded = if is_whole {
            exact.round()
        } else {
            round_to(exact, 3)
        };
        let listed = if step == 0 { value } else { rounded };
        if row.field.range.contains(listed) || step == 0 || is_whole && listed >= 1.0 {
            values.push(listed);
        }
    }
    values.sort_by(f64::total_cmp);
    values.dedup();
    if values.len() < 2 {
        return Err(format!("{name} has no other allowed values near this one"));
    }
    Ok(values)
}

/// Returns the smallest and the largest value of an axis with evenly spaced values: a third and
/// three times the value, or nearer ends of the allowed range.
fn ends(row: &Parameter, value: f64) -> [f64; 2] {
    let mut low = value - value.abs() * (1.0 - 1.0 / FACTOR);
    let mut high = value + value.abs() * (FACTOR - 1.0);
    if let Range::Real(least, most) = row.field.range {
        match least {
            Bound::Included(end) => low = low.max(end),
            Bound::Excluded(end) => low = low.max(value + BEFORE_OPEN_END * (end - value)),
            Bound::Unbounded => {}
        }
        match most {
            Bound::Included(end) => high = high.min(end),
            Bound::Excluded(end) => high = high.min(value + BEFORE_OPEN_END * (end - value)),
            Bound::Unbounded => {}
        }
    }
    [low, high]
}

/// Returns what the typed map will have, or the reason why it is refused; `None` if the prompt of a
/// map is not open.
pub fn answer(app: &App) -> Option<String> {
    let prompt = app.prompt.as_ref()?;
    let Purpose::Map = prompt.purpose else {
        return None;
    };
    let chosen = match chosen(app, prompt.line.text()) {
        Ok(chosen) => chosen,
        Err(why) => return Some(why),
    };
    let ChosenAxes { across, up, .. } = &chosen;
    let mut state = app.map.clone();
    state.chosen = Some(chosen.clone());
    let plan = match state.plan(app.edit.document.scene()) {
        Ok(plan) => plan,
        Err(why) => return Some(why.to_string()),
    };
    let mut parts = vec![format!(
        "{} × {} cells, {}",
        across.values.len(),
        up.values.len(),
        counted(plan.lines, "profile")
    )];
    for axis in plan.axes.iter().rev() {
        let ends = (axis.values[0], axis.values[axis.values.len() - 1]);
        let range = format_range(ends, 3, axis.unit);
        parts.push(format!("{} {range}", axis.symbol_or_name()));
    }
    let adhesion = app.edit.document.scene().adhesion;
    if let Some((stated, _)) = adhesion.and_then(|adhesion| adhesion.parameter())
        && !plan
            .axes
            .iter()
            .any(|axis| axis.path.starts_with("adhesion."))
    {
        parts.push(format!("{} stays", stated.symbol()));
    }
    parts.push("Enter".to_owned());
    Some(parts.join(" · "))
}

/// Shows the map that the user has typed, and begins to compute it.
pub fn accept(app: &mut App, typed: &str) -> Result<(), String> {
    let chosen = chosen(app, typed)?;
    let quantity = chosen.quantity;
    let mut state = app.map.clone();
    state.chosen = Some(chosen);
    state.of_study = false;
    state.plan_file = None;
    state.quantity = quantity;
    state.scale = None;
    state
        .plan(app.edit.document.scene())
        .map_err(|error| error.to_string())?;
    app.map = state;
    app.studies.forget::<Live>();
    app.show(Pane::Map);
    app.effects.push(Task::Study);
    Ok(())
}

/// Replaces the last name in the prompt by the name of the next row with a number.
pub fn next_row(app: &mut App) {
    let Some(prompt) = &app.prompt else {
        return;
    };
    let typed = prompt.line.text();
    let Some(Words {
        quantity,
        across,
        up,
    }) = Words::read(typed)
    else {
        return;
    };
    let rows = numbers(app);
    let names: Vec<String> = rows.iter().map(|row| name_of(app, row)).collect();
    let place = names.iter().position(|name| name == up);
    let start = place.map_or(0, |place| place + 1);
    let mut following = (0..names.len()).map(|step| &names[(start + step) % names.len()]);
    let Some(next) = following.find(|name| *name != across) else {
        return;
    };
    let text = format!("{quantity} over {across} × {next}");
    edit::edit_line(app, |line| *line = TextLine::new(&text));
}

/// Returns the plan of a study of the cells of the live map, with the scene as it is and
/// `profiles` random profiles.
///
/// # Errors
/// Returns the reason if the scene has no live map.
pub fn plan(app: &App, profiles: u64) -> Result<Plan, String> {
    let document = &app.edit.document;
    let scene = document.scene().with_files_named(|file: &str| {
        let path = document.resolve(file);
        let path = std::path::absolute(&path).unwrap_or(path);
        path.to_string_lossy().into_owned()
    });
    let plan = app.map.plan(&scene).map_err(|error| error.to_string())?;
    let plan = plan.for_scene(&scene, app.governing().as_ref());
    let mut plan = plan.map_err(|error| error.to_string())?;
    let is_axis = plan.axes.iter().any(|axis| axis.path == "numerics.points");
    if !is_axis {
        plan.scene.numerics.points = scene.numerics.points;
    }
    // The axis across comes first.
    let axes: Vec<&str> = plan
        .axes
        .iter()
        .rev()
        .map(|axis| axis.symbol_or_name())
        .collect();
    plan.title = format!(
        "{} over {}",
        app.map.quantity.symbol_or_name(),
        axes.join(" × ")
    );
    plan.lines = if plan.lines > 1 { profiles } else { 1 };
    if let Some(chosen) = &app.map.chosen {
        // The figure of a study has its first axis across, and draws what it records.
        plan.axes.reverse();
        plan.record = vec![chosen.quantity];
    }
    Ok(plan)
}
