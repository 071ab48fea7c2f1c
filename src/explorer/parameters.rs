//! The list of parameters, which shows the fields of the present scene that the user can change,
//! arranged in groups.

use super::curve_options;
use super::measured::Measured;
use super::profiles;
use super::text::on_one_line;
use asperity_contact::Move;
use asperity_data::{format_quantity, grouped};
use asperity_scene::fields::{
    Effect, Field, Range, STAGE, choice_in_words, field, sphere_values, target_field,
};
use asperity_scene::loading::{loading_text, stage_in_ron};
use asperity_scene::text::ron_float;
use asperity_scene::{Document, RoughnessParameter, Scene};
use asperity_study::Ensemble;
use asperity_surface::Form;
use std::collections::BTreeSet;

/// Groups in the order in which the list shows them. The groups that users change most often come
/// first: adhesion, loading and roughness. Form and material are usually chosen once. The measured
/// curve comes last, because it is not part of the scene.
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

/// Fields of the scene file that never have a row in the list. They change nothing that the
/// explorer shows.
const HIDDEN: [&str; 2] = ["version", "observe"];

/// Fields that have a row in the list only if the user has searched for them. `numerics.edges` is
/// among them because the choice of springs for a tolerance sets it together with the number of
/// springs.
const ON_SEARCH: [&str; 3] = ["numerics.samples", "numerics.edges", "numerics.solver"];

/// Three ways to state the adhesion. Each value determines the other two.
const ADHESION: [&str; 3] = [
    "adhesion.work",
    "adhesion.kappa",
    "adhesion.elastic_energy_ratio",
];

/// Two ways to state the amplitude of the roughness. Each value determines the other.
const AMPLITUDE: [&str; 2] = ["roughness.rms_height", "roughness.rms_gradient"];

/// Fields that come first in their group, directly after the heading of the group. The other fields
/// keep the order of the scene file.
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
    /// Name of the group to which the row belongs. It is the path of the first row of this group.
    pub group: &'static str,
    /// Index of the loading stage; `None` if the row is not a loading stage.
    pub stage: Option<usize>,
    /// Index of the sphere; `None` if the row is no value of one of several spheres.
    pub sphere: Option<usize>,
    /// Value of the parameter in the notation of the scene file.
    pub written: String,
    /// Value as the user sees it. The text is empty if the value follows from other values and must
    /// be computed.
    pub shown: String,
    pub effect: Option<Effect>,
    pub setting: Setting,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    Field,
    /// The row cannot be changed, because it is the heading of a group.
    Heading,
    /// The row is a roughness parameter: κ, or the ratio e_el/γ of elastic energy to work of
    /// adhesion. The scene file states only one of these two and the work of adhesion γ. A new
    /// value in this row therefore replaces the stated one.
    RoughnessParameter(RoughnessParameter),
    /// The row is the work of adhesion γ. The scene file states either γ or a roughness parameter
    /// (κ or e_el/γ) from which γ follows. A new value in this row therefore replaces the stated
    /// one.
    WorkOfAdhesion,
    /// The row is an option for reading the measured curve. The number is the index of the option
    /// in [`curve_options::OPTIONS`].
    CurveOption(usize),
    /// The row is the number of random profiles of the explorer.
    Profiles,
}

impl Parameter {
    /// Creates the row of a field, without its value.
    fn new(field: &'static Field, path: &str) -> Self {
        Parameter {
            field,
            path: path.to_owned(),
            group: group_of(path),
            stage: None,
            sphere: None,
            written: String::new(),
            shown: String::new(),
            effect: effect_of(path),
            setting: setting_of(path),
        }
    }

    /// Returns the name of the parameter. For a loading stage or a sphere, its number is added.
    pub fn name(&self) -> String {
        match self.stage.or(self.sphere) {
            Some(index) => format!("{} {}", self.field.name, index + 1),
            None => self.field.name.to_owned(),
        }
    }

    /// Returns true if the user can type a number as the value.
    pub fn takes_number(&self) -> bool {
        let is_text = matches!(
            self.field.range,
            Range::Choice(_) | Range::List { .. } | Range::Text { .. }
        );
        match self.setting {
            Setting::Heading => false,
            // Numbers of segments and of points are stored as text, but the user types them as
            // numbers.
            Setting::CurveOption(_) => !matches!(self.field.range, Range::Choice(_)),
            // A stage without a number takes one as well: it is then replaced by a stage with this
            // number.
            _ => self.stage.is_some() || !is_text,
        }
    }

    /// Returns the symbol or the name of the quantity that the scene states in place of this
    /// parameter. The shown value of the parameter follows from that quantity. If the user types a
    /// value, the typed value replaces that quantity in the scene. Returns `None` if the scene
    /// states this parameter itself.
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
            Setting::Heading | Setting::CurveOption(_) | Setting::Profiles => None,
        }
    }

    /// Returns true if this is the first row of a group.
    pub fn is_head(&self) -> bool {
        self.path == self.group
    }

    /// Returns the texts in which a search looks for words: the symbol, the symbol with Greek
    /// letters in words, the path, the name and the meaning. In the path, blanks replace the
    /// separators, because the path `length` of the length L is also a word in other paths.
    pub fn texts(&self) -> Vec<String> {
        let symbol = self.field.symbol;
        vec![
            symbol.to_owned(),
            spelled(symbol),
            self.path.replace(['.', '_'], " "),
            self.name(),
            self.field.words.to_owned(),
            self.field.meaning.to_owned(),
        ]
    }
}

/// Greek letters that occur in symbols, with their names, which the user can type instead.
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

/// Returns the group of a field, which is the first part of its path, with these exceptions: the
/// stiffness of the instrument belongs to the loading, the notice to the title, and every other
/// field whose path has only one part, such as the diameter, to the form.
fn group_of(path: &str) -> &'static str {
    let first = match path {
        "notice" => "title",
        "loading_stiffness" => "loading",
        _ => path.split('.').next().unwrap_or(path),
    };
    let group = GROUPS.into_iter().find(|group| *group == first);
    group.unwrap_or("form")
}

/// Returns the path of the field that loses its value when the field `path` gets a value. A scene
/// states either modes or wavelengths, and either the rms height or the rms gradient. `None` if no
/// field loses its value.
pub fn replaced_by(path: &str) -> Option<&'static str> {
    match path {
        "roughness.modes" => Some("roughness.wavelengths"),
        "roughness.wavelengths" => Some("roughness.modes"),
        "roughness.rms_height" => Some("roughness.rms_gradient"),
        "roughness.rms_gradient" => Some("roughness.rms_height"),
        _ => None,
    }
}

/// The parameters of a scene and of the measured curve that is compared with the scene.
pub struct Rows {
    /// Rows of the list.
    pub listed: Vec<Parameter>,
    /// Parameters that have no row unless the user searches for them.
    pub absent: Vec<Parameter>,
}

impl Rows {
    /// Returns the parameters for a scene, a measured curve and a number of random profiles. The
    /// number has a row only if the profile of the scene is random. The fields with the paths
    /// `revealed` have a row in any case.
    pub fn of(
        document: &Document,
        measured: Option<&Measured>,
        profiles: u64,
        revealed: &BTreeSet<&'static str>,
    ) -> Rows {
        let mut listed = Vec::new();
        let mut absent = Vec::new();
        for field in document.fields() {
            if HIDDEN.contains(&field.path) {
                continue;
            }
            match row_of_field(document, field) {
                Some(row) => listed.push(row),
                None if revealed.contains(field.path) => listed.extend(plain_row(document, field)),
                None => absent.extend(plain_row(document, field)),
            }
            if field.path == "loading" {
                listed.extend(stage_rows(&document.scene().loading));
            }
            if field.path == "form" {
                listed.extend(sphere_rows(document));
            }
        }
        add_other_adhesion(&mut listed);
        absent.retain(|row| !ADHESION.contains(&row.field.path));
        if Ensemble::profiles_of(document.scene()) > 1 {
            listed.push(Parameter {
                written: profiles.to_string(),
                shown: profiles.to_string(),
                setting: Setting::Profiles,
                ..Parameter::new(&profiles::FIELD, profiles::PATH)
            });
        }
        if let Some(measured) = measured {
            listed.extend(curve_rows(measured));
        }
        listed.sort_by_key(|parameter| {
            let group = GROUPS.iter().position(|group| *group == parameter.group);
            let first = FIRST.iter().position(|path| *path == parameter.path);
            (group, !parameter.is_head(), first.unwrap_or(FIRST.len()))
        });
        Rows { listed, absent }
    }
}

/// Returns the row of a field with its value as the scene states it; `None` if the scene cannot
/// have the field.
fn plain_row(document: &Document, field: &'static Field) -> Option<Parameter> {
    let written = document.value(field.path)?;
    Some(Parameter {
        written: written.to_owned(),
        shown: shown(field, written),
        ..Parameter::new(field, field.path)
    })
}

/// Returns the row of a field of the scene; `None` if the list has no row for the field in this
/// scene.
fn row_of_field(document: &Document, field: &'static Field) -> Option<Parameter> {
    let row = Parameter::new(field, field.path);
    if field.range == Range::Group {
        return Some(Parameter {
            effect: None,
            setting: Setting::Heading,
            ..row
        });
    }
    if ON_SEARCH.iter().any(|path| field.path.starts_with(path)) {
        return None;
    }
    let written = document.value(field.path)?;
    // If the instrument is rigid, its stiffness has a row only if a stage prescribes the
    // displacement of the instrument.
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
        // The explorer computes the value of this field together with the scene.
        return Some(row);
    }
    // Any other field without a value has a row only if its value follows from other fields.
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

/// Returns the effect (such as adhesion) to which a field belongs; `None` if the field belongs to
/// no effect. The group `observe` is left out, because it has no influence on the contact.
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

/// Adds rows for the two of γ, κ and e_el/γ that the scene does not state. Their values follow from
/// the one that the scene states.
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

/// Returns the value of a field of a self-affine spectrum that follows from other fields. These are
/// the modes or the wavelengths, whichever the scene does not state. For the roll-off, returns the
/// longest wavelength, with which the roll-off has no effect.
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

/// Returns the rows of the measured curve: a heading with the name of its file, and one row for
/// each option with which the file is read.
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

/// Returns the rows of all spheres of the form: the radius of each sphere, and its distance behind
/// the sphere that is ahead.
fn sphere_rows(document: &Document) -> Vec<Parameter> {
    let form = document.scene().form.as_ref();
    let spheres = form.map_or(&[][..], Form::spheres);
    let mut rows = Vec::new();
    for (index, sphere) in spheres.iter().enumerate() {
        for (field, value) in sphere_values(*sphere) {
            rows.push(Parameter {
                sphere: Some(index),
                written: ron_float(value),
                shown: format_quantity(value, field.unit),
                ..Parameter::new(field, &format!("form.{index}.{}", field.last()))
            });
        }
    }
    rows
}

/// Returns one row for each loading stage.
fn stage_rows(loading: &[Move]) -> Vec<Parameter> {
    let mut rows = Vec::new();
    for (index, stage) in loading.iter().enumerate() {
        rows.push(stage_row(index, *stage));
    }
    rows
}

/// Returns the row of a loading stage. If the stage has a number, such as its force, the path of
/// the row is the path of this number.
fn stage_row(index: usize, stage: Move) -> Parameter {
    let Some((field, value)) = target_field(stage) else {
        return Parameter {
            stage: Some(index),
            written: stage_in_ron(&stage),
            shown: loading_text(&[stage], format_quantity),
            effect: Some(Effect::Unloading),
            ..Parameter::new(&STAGE, &format!("loading.{index}"))
        };
    };
    Parameter {
        stage: Some(index),
        written: ron_float(value),
        shown: format_quantity(value, field.unit),
        effect: Some(Effect::Unloading),
        ..Parameter::new(field, &format!("loading.{index}.0"))
    }
}

/// Converts a value from the notation of the scene file to the form that is shown to the user.
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

/// Returns the name of a choice in words. The fields within the choice are left out, because they
/// have rows of their own.
fn shown_choice(field: &Field, written: &str) -> String {
    let name = written.split('(').next().unwrap_or(written).trim();
    let is_named_by_its_first =
        matches!(field.path, "material" | "adhesion" | "material.relaxation");
    if name.is_empty() && is_named_by_its_first {
        first_name(written).to_owned()
    } else {
        choice_in_words(name)
    }
}

/// Returns the text of a string that is written in the notation of RON, on one line. If `written`
/// is not a string, returns it unchanged.
pub(super) fn text_of(written: &str) -> String {
    match ron::from_str::<String>(written) {
        Ok(text) => on_one_line(&text),
        Err(_) => on_one_line(written),
    }
}

/// Returns the first name in a group, in words. For example, it returns the words for `work` in
/// `(work: 0.05)`.
fn first_name(written: &str) -> &str {
    let group = written.trim_start_matches('(');
    let name = group.split(':').next().unwrap_or("").trim();
    match name {
        "work" => "by work of adhesion",
        "kappa" => "by κ",
        "elastic_energy_ratio" => "by e_el/γ",
        "modulus" => "by E*",
        "share" => "by share and time",
        "youngs_modulus" | "poisson_ratio" => "by E and ν",
        other => other,
    }
}
