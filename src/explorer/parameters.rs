//! The list of parameters: the fields of the present scene that can be changed, in groups.

use super::curve_options;
use super::measured::Measured;
use super::text::on_one_line;
use asperity_contact::Move;
use asperity_data::{format_quantity, grouped};
use asperity_scene::fields::{Effect, Field, Range, STAGE, choice_in_words, field, target_field};
use asperity_scene::loading::{loading_text, stage_in_ron};
use asperity_scene::text::ron_float;
use asperity_scene::{Document, RoughnessParameter, Scene};

/// Groups in the order of the list. Parameters that are varied most come first: adhesion, load and
/// roughness; form and material are usually chosen once for a scene, and a measured curve is beside
/// the scene.
const GROUPS: [&str; 8] = [
    "adhesion",
    "loading",
    "roughness",
    "form",
    "material",
    "numerics",
    "title",
    curve_options::GROUP,
];

/// Fields of the scene file without a row in the list; the choice of a tolerance sets the edges.
const HIDDEN: [&str; 5] = [
    "version",
    "observe",
    "numerics.samples",
    "numerics.edges",
    "numerics.solver",
];

/// Three ways to give the adhesion; each determines the others.
const ADHESION: [&str; 3] = [
    "adhesion.work",
    "adhesion.kappa",
    "adhesion.elastic_energy_ratio",
];

/// Two ways to give the amplitude of the roughness, of which the other follows.
const AMPLITUDE: [&str; 2] = ["roughness.rms_height", "roughness.rms_gradient"];

/// Order in a group: the first row, these fields, and the others as in the scene file.
const FIRST: [&str; 7] = [
    ADHESION[0],
    ADHESION[1],
    ADHESION[2],
    AMPLITUDE[0],
    AMPLITUDE[1],
    "roughness.hurst",
    "roughness.seed",
];

#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub field: &'static Field,
    pub path: String,
    /// Name of the group: the path of its first row.
    pub group: &'static str,
    /// Index of the loading stage, for a row of a stage.
    pub leg: Option<usize>,
    /// Value as written in the scene file.
    pub written: String,
    /// Value for readers; empty if the value follows from others and must be computed.
    pub shown: String,
    pub effect: Option<Effect>,
    pub setting: Setting,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    Field,
    /// It cannot be set: a group without a value of its own.
    Heading,
    /// κ or e_el/γ, in place of any of γ, κ and e_el/γ that the scene states.
    RoughnessParameter(RoughnessParameter),
    /// γ, in place of any of γ, κ and e_el/γ that the scene states.
    WorkOfAdhesion,
    /// Option of reading the measured curve, by its index in [`curve_options::OPTIONS`].
    CurveOption(usize),
}

impl Parameter {
    /// Creates the row of a field, without its value.
    fn new(field: &'static Field, path: &str) -> Self {
        Parameter {
            field,
            path: path.to_owned(),
            group: group_of(path),
            leg: None,
            written: String::new(),
            shown: String::new(),
            effect: effect_of(path),
            setting: setting_of(path),
        }
    }

    /// Name, with the number of the loading stage if it is of one.
    pub fn name(&self) -> String {
        match self.leg {
            Some(leg) => format!("{} {}", self.field.name, leg + 1),
            None => self.field.name.to_owned(),
        }
    }

    /// Returns true if the value is typed as a number.
    pub fn takes_number(&self) -> bool {
        let is_text = matches!(
            self.field.range,
            Range::Choice(_) | Range::List { .. } | Range::Text { .. }
        );
        match self.setting {
            Setting::Heading => false,
            // Numbers of segments and of points are typed as texts.
            Setting::CurveOption(_) => !matches!(self.field.range, Range::Choice(_)),
            // A stage in words may become one with a number.
            _ => self.leg.is_some() || !is_text,
        }
    }

    /// The stated quantity from which the shown value follows, and which typing a value replaces;
    /// `None` for a stated value.
    pub fn follows_from(&self, scene: &Scene) -> Option<&'static str> {
        let is_computed = self.shown.is_empty() || self.shown.starts_with('=');
        if !is_computed {
            return None;
        }
        match self.setting {
            Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion => {
                let given = scene.adhesion?.parameter();
                Some(given.map_or("γ", |(parameter, _)| parameter.symbol()))
            }
            Setting::Field => match self.path.as_str() {
                "roughness.modes" => Some("the wavelengths"),
                "roughness.wavelengths" => Some("the modes"),
                path => Some(field(replaced_by(path)?, None)?.symbol),
            },
            Setting::Heading | Setting::CurveOption(_) => None,
        }
    }

    /// Returns true for the first row of a group.
    pub fn is_head(&self) -> bool {
        self.path == self.group
    }

    /// Texts of a search: symbol, in Greek and spelled, path, name and meaning. The path has blanks
    /// in place of its separators, since the path of the length L is a whole word of other names.
    pub fn texts(&self) -> Vec<String> {
        let symbol = self.field.symbol;
        vec![
            symbol.to_owned(),
            spelled(symbol),
            self.path.replace(['.', '_'], " "),
            self.name(),
            self.field.meaning.to_owned(),
        ]
    }
}

/// Greek letters of symbols, which keyboards rarely have, with their names.
const GREEK: [(char, &str); 6] = [
    ('γ', "gamma"),
    ('κ', "kappa"),
    ('λ', "lambda"),
    ('θ', "theta"),
    ('ν', "nu"),
    ('Δ', "delta "),
];

fn spelled(symbol: &str) -> String {
    let mut spelled = symbol.to_owned();
    for (letter, name) in GREEK {
        spelled = spelled.replace(letter, name);
    }
    spelled
}

/// The group of a field, which is the first name of its path. The diameter belongs to the form, the
/// stiffness of the instrument to the loading, and the notice to the title.
fn group_of(path: &str) -> &'static str {
    let first = match path {
        "notice" => "title",
        "loading_stiffness" => "loading",
        _ => path.split('.').next().unwrap_or(path),
    };
    let group = GROUPS.into_iter().find(|group| *group == first);
    group.unwrap_or("form")
}

/// Path of the field that a field replaces where it gets a value: modes and wavelengths, rms height
/// and rms gradient.
pub fn replaced_by(path: &str) -> Option<&'static str> {
    match path {
        "roughness.modes" => Some("roughness.wavelengths"),
        "roughness.wavelengths" => Some("roughness.modes"),
        "roughness.rms_height" => Some("roughness.rms_gradient"),
        "roughness.rms_gradient" => Some("roughness.rms_height"),
        _ => None,
    }
}

/// The rows for a scene and the measured curve beside it.
pub fn parameters(document: &Document, measured: Option<&Measured>) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for field in document.fields() {
        if HIDDEN.iter().any(|hidden| field.path.starts_with(hidden)) {
            continue;
        }
        parameters.extend(row_of_field(document, field));
        if field.path == "loading" {
            parameters.extend(stage_rows(&document.scene().loading));
        }
    }
    add_other_adhesion(&mut parameters);
    if let Some(measured) = measured {
        parameters.extend(curve_rows(measured));
    }
    parameters.sort_by_key(|parameter| {
        let group = GROUPS.iter().position(|group| *group == parameter.group);
        let first = FIRST.iter().position(|path| *path == parameter.path);
        (group, !parameter.is_head(), first.unwrap_or(FIRST.len()))
    });
    parameters
}

/// The row of a field of the scene; `None` for a field that the list does not show in this scene.
fn row_of_field(document: &Document, field: &'static Field) -> Option<Parameter> {
    let row = Parameter::new(field, field.path);
    if field.range == Range::Group {
        return Some(Parameter {
            effect: None,
            setting: Setting::Heading,
            ..row
        });
    }
    let written = document.value(field.path)?;
    // The stiffness of a rigid instrument has a row only where a stage prescribes its displacement.
    let is_rigid = field.path == "loading_stiffness" && written == "None";
    if is_rigid && !has_displacement_stage(document.scene()) {
        return None;
    }
    let is_given = written != "None" || field.parent().is_empty();
    if is_given {
        let shown = match field.path {
            "loading" => loading_text(&document.scene().loading, format_quantity),
            _ => shown(field, written),
        };
        return Some(Parameter {
            written: written.to_owned(),
            shown,
            ..row
        });
    }
    if AMPLITUDE.contains(&field.path) {
        // Its value is computed with the scene.
        return Some(row);
    }
    // Any other field without a value is shown only if its value follows from the scene.
    let written = waves(document, field)?;
    let shown = match field.path {
        "roughness.roll_off" => "none".to_owned(),
        _ => format!("= {}", shown(field, &written)),
    };
    Some(Parameter {
        written,
        shown,
        ..row
    })
}

fn has_displacement_stage(scene: &Scene) -> bool {
    let mut stages = scene.loading.iter();
    stages.any(|stage| matches!(stage, Move::ToDisplacement(_)))
}

/// The effect that a field belongs to; observation is no effect of the contact.
fn effect_of(path: &str) -> Option<Effect> {
    let mut effects = Effect::ALL.into_iter();
    effects.find(|effect| {
        let group = effect.path();
        group != "observe" && (path == group || path.starts_with(&format!("{group}.")))
    })
}

fn setting_of(path: &str) -> Setting {
    match RoughnessParameter::named(path) {
        Some(parameter) => Setting::RoughnessParameter(parameter),
        None if path == "adhesion.work" => Setting::WorkOfAdhesion,
        None => Setting::Field,
    }
}

/// Adds rows for the two of γ, κ and e_el/γ that follow from the stated one.
fn add_other_adhesion(parameters: &mut Vec<Parameter>) {
    let mut others = ADHESION.to_vec();
    others.retain(|path| !parameters.iter().any(|listed| listed.path == *path));
    if others.len() == ADHESION.len() {
        return;
    }
    for path in others {
        if let Some(field) = field(path, None) {
            parameters.push(Parameter::new(field, field.path));
        }
    }
}

/// Value of a field that follows from others: the other way to give the waves of a self-affine
/// profile, and as a roll-off without effect the longest wave.
fn waves(document: &Document, field: &Field) -> Option<String> {
    let scene = document.scene();
    let spectrum = scene.spectrum()?;
    let longest = ron_float(scene.length / spectrum.first as f64);
    let shortest = ron_float(scene.length / spectrum.last as f64);
    match field.path {
        "roughness.modes" => Some(format!("({}, {})", spectrum.first, spectrum.last)),
        "roughness.wavelengths" => Some(format!("({longest}, {shortest})")),
        "roughness.roll_off" => Some(longest),
        _ => None,
    }
}

/// A row with the name of the measured curve, and one for each option of reading it.
fn curve_rows(measured: &Measured) -> Vec<Parameter> {
    let head = &curve_options::HEAD;
    let mut rows = vec![Parameter {
        setting: Setting::Heading,
        shown: measured.name.clone(),
        ..Parameter::new(head, head.path)
    }];
    for (index, option) in curve_options::OPTIONS.iter().enumerate() {
        rows.push(Parameter {
            setting: Setting::CurveOption(index),
            shown: option.shown(measured),
            ..Parameter::new(&option.field, option.field.path)
        });
    }
    rows
}

/// A row for each loading stage.
fn stage_rows(loading: &[Move]) -> Vec<Parameter> {
    let mut rows = Vec::new();
    for (index, stage) in loading.iter().enumerate() {
        rows.push(stage_row(index, *stage));
    }
    rows
}

/// The row of a loading stage; a stage with a number has the path of its number.
fn stage_row(index: usize, stage: Move) -> Parameter {
    let Some((field, value)) = target_field(stage) else {
        return Parameter {
            leg: Some(index),
            written: stage_in_ron(&stage),
            shown: loading_text(&[stage], format_quantity),
            effect: Some(Effect::Unloading),
            ..Parameter::new(&STAGE, &format!("loading.{index}"))
        };
    };
    Parameter {
        leg: Some(index),
        written: ron_float(value),
        shown: format_quantity(value, field.unit),
        effect: Some(Effect::Unloading),
        ..Parameter::new(field, &format!("loading.{index}.0"))
    }
}

/// A written value in the format for readers.
fn shown(field: &Field, written: &str) -> String {
    if let Some(quantities) = field.quantities(written, format_quantity) {
        return quantities;
    }
    if written == "None" {
        return "none".to_owned();
    }
    match field.range {
        Range::Choice(_) => shown_choice(field, written),
        Range::Band(..) => written.trim_matches(['(', ')']).to_owned(),
        Range::Whole(..) if field.path != "roughness.seed" => match written.parse() {
            Ok(number) => grouped(number),
            Err(_) => written.to_owned(),
        },
        Range::Text { .. } => text_of(written),
        _ => on_one_line(written),
    }
}

/// The name of a choice in words; its parts have rows of their own.
fn shown_choice(field: &Field, written: &str) -> String {
    let name = written.split('(').next().unwrap_or(written).trim();
    if name.is_empty() && matches!(field.path, "material" | "adhesion") {
        first_name(written).to_owned()
    } else {
        choice_in_words(name)
    }
}

/// The text of a string as written in RON, on one line; any other value as it is written.
pub(super) fn text_of(written: &str) -> String {
    match ron::from_str::<String>(written) {
        Ok(text) => on_one_line(&text),
        Err(_) => on_one_line(written),
    }
}

/// The first name in a group, in words: `work` of `(work: 0.05)`.
fn first_name(written: &str) -> &str {
    let group = written.trim_start_matches('(');
    let name = group.split(':').next().unwrap_or("").trim();
    match name {
        "work" => "by work of adhesion",
        "kappa" => "by κ",
        "elastic_energy_ratio" => "by e_el/γ",
        "effective_modulus" => "by E*",
        "youngs_modulus" | "poisson_ratio" => "by E and ν",
        other => other,
    }
}
