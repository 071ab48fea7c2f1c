//! The list of parameters: the fields of the present scene that can be changed, in groups.

use super::measured::Measured;
use super::reading;
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
    reading::GROUP,
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
    /// Option of reading the measured curve, by its index in [`reading::OPTIONS`].
    Reading(usize),
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
            Setting::Reading(_) => !matches!(self.field.range, Range::Choice(_)),
            // A stage in words may become one with a number.
            _ => self.leg.is_some() || !is_text,
        }
    }

    /// The stated quantity from which the shown value follows, and which typing a value replaces;
    /// `None` for a stated value.
    pub fn follows_from(&self, scene: &Scene) -> Option<&'static str> {
        let is_computed = self.shown.is_empty() || self.shown.starts_with('=');
        match (self.setting, self.path.as_str()) {
            (Setting::RoughnessParameter(_) | Setting::WorkOfAdhesion, _) if is_computed => {
                let given = scene.adhesion?.parameter();
                Some(given.map_or("γ", |(parameter, _)| parameter.symbol()))
            }
            (Setting::Field, "roughness.modes") if is_computed => Some("the wavelengths"),
            (Setting::Field, "roughness.wavelengths") if is_computed => Some("the modes"),
            (Setting::Field, path) if is_computed => {
                let given = field(replaced_by(path)?, None)?;
                Some(given.symbol)
            }
            _ => None,
        }
    }

    /// Returns true for the first row of a group.
    pub fn is_head(&self) -> bool {
        self.path == self.group
    }

    /// Texts of a search: symbol, in Greek and spelled, path, name and meaning. The path of the
    /// length L is a whole word of other names.
    pub fn texts(&self) -> Vec<String> {
        let symbol = self.field.symbol;
        let words = self.path.replace(['.', '_'], " ");
        vec![
            symbol.to_owned(),
            spelled(symbol),
            words,
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
    GREEK
        .iter()
        .fold(symbol.to_owned(), |text, (letter, name)| {
            text.replace(*letter, name)
        })
}

/// The group of a field: that of its path, but the form for the diameter, the loading for the
/// stiffness of the instrument, and the title for the notice.
fn group_of(path: &str) -> &'static str {
    let first = match path {
        "notice" => "title",
        "loading_stiffness" => "loading",
        _ => path.split('.').next().unwrap_or(path),
    };
    GROUPS
        .into_iter()
        .find(|group| *group == first)
        .unwrap_or("form")
}

/// Path of the field that a field replaces where it gets a value: modes and wavelengths, rms height
/// and rms gradient.
pub fn replaced_by(path: &str) -> Option<&'static str> {
    let pairs = [["roughness.modes", "roughness.wavelengths"], AMPLITUDE];
    pairs.into_iter().find_map(|[one, other]| match path {
        _ if path == one => Some(other),
        _ if path == other => Some(one),
        _ => None,
    })
}

/// The rows for a scene and the measured curve beside it.
pub fn parameters(document: &Document, measured: Option<&Measured>) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for field in document.fields() {
        if HIDDEN.iter().any(|hidden| field.path.starts_with(hidden)) {
            continue;
        }
        if field.range == Range::Group {
            let heading = Parameter::new(field, field.path);
            parameters.push(Parameter {
                effect: None,
                setting: Setting::Heading,
                ..heading
            });
            continue;
        }
        let Some(written) = document.value(field.path) else {
            continue;
        };
        // A rigid instrument has a row where a stage prescribes its displacement.
        let displaces = |stage: &Move| matches!(stage, Move::ToDisplacement(_));
        if field.path == "loading_stiffness"
            && written == "None"
            && !document.scene().loading.iter().any(displaces)
        {
            continue;
        }
        let is_given = written != "None" || field.parent().is_empty();
        // Other fields without a value are equivalent to those in use.
        if !is_given && AMPLITUDE.contains(&field.path) {
            parameters.push(Parameter::new(field, field.path));
            continue;
        }
        let written = if is_given {
            Some(written.to_owned())
        } else {
            waves(document, field)
        };
        let Some(written) = written else { continue };
        let shown = match field.path {
            "loading" => loading_text(&document.scene().loading, format_quantity),
            "roughness.roll_off" if !is_given => "none".to_owned(),
            _ if !is_given => format!("= {}", shown(field, &written)),
            _ => shown(field, &written),
        };
        parameters.push(Parameter {
            written,
            shown,
            ..Parameter::new(field, field.path)
        });
        if field.path == "loading" {
            parameters.extend(stage_rows(&document.scene().loading));
        }
    }
    add_other_adhesion(&mut parameters);
    parameters.extend(measured.into_iter().flat_map(reading_rows));
    parameters.sort_by_key(|parameter| {
        let group = GROUPS.iter().position(|group| *group == parameter.group);
        let first = FIRST.iter().position(|path| *path == parameter.path);
        (group, !parameter.is_head(), first.unwrap_or(FIRST.len()))
    });
    parameters
}

fn effect_of(path: &str) -> Option<Effect> {
    Effect::ALL
        .into_iter()
        .filter(|effect| effect.path() != "observe")
        .find(|effect| path == effect.path() || path.starts_with(&format!("{}.", effect.path())))
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
    let is_listed = |path: &str| parameters.iter().any(|one| one.path == path);
    let others: Vec<&str> = ADHESION
        .into_iter()
        .filter(|path| !is_listed(path))
        .collect();
    if others.len() < ADHESION.len() {
        let fields = others.into_iter().filter_map(|path| field(path, None));
        parameters.extend(fields.map(|field| Parameter::new(field, field.path)));
    }
}

/// Value of a field that follows from others: the other way to give the waves of a self-affine
/// profile, and as a roll-off without effect the longest wave.
fn waves(document: &Document, field: &Field) -> Option<String> {
    let spectrum = document.scene().spectrum()?;
    let [longest, shortest] = [spectrum.first, spectrum.last]
        .map(|mode| ron_float(document.scene().length / mode as f64));
    match field.path {
        "roughness.modes" => Some(format!("({}, {})", spectrum.first, spectrum.last)),
        "roughness.wavelengths" => Some(format!("({longest}, {shortest})")),
        "roughness.roll_off" => Some(longest),
        _ => None,
    }
}

/// A row with the name of the measured curve, and one for each option of reading.
fn reading_rows(measured: &Measured) -> impl Iterator<Item = Parameter> {
    let row = |field, setting, shown| Parameter {
        setting,
        shown,
        ..Parameter::new(field, field.path)
    };
    let option = move |(index, option): (usize, &'static reading::ReadingOption)| {
        row(
            &option.field,
            Setting::Reading(index),
            option.shown(measured),
        )
    };
    let head = row(&reading::HEAD, Setting::Heading, measured.name.clone());
    [head]
        .into_iter()
        .chain(reading::OPTIONS.iter().enumerate().map(option))
}

/// A row for each loading stage, at the path of its number if it has one.
fn stage_rows(loading: &[Move]) -> impl Iterator<Item = Parameter> {
    loading.iter().enumerate().map(|(index, stage)| {
        let number = target_field(*stage);
        let path = format!(
            "loading.{index}{}",
            if number.is_some() { ".0" } else { "" }
        );
        Parameter {
            leg: Some(index),
            written: number.map_or_else(|| stage_in_ron(stage), |(_, value)| ron_float(value)),
            shown: match number {
                Some((field, value)) => format_quantity(value, field.unit),
                None => loading_text(&[*stage], format_quantity),
            },
            effect: Some(Effect::Unloading),
            ..Parameter::new(number.map_or(&STAGE, |(field, _)| field), &path)
        }
    })
}

/// A written value in the format for readers.
fn shown(field: &Field, written: &str) -> String {
    if let Some(quantities) = field.quantities(written, format_quantity) {
        return quantities;
    }
    match field.range {
        _ if written == "None" => "none".to_owned(),
        Range::Choice(_) => {
            // The parts of a choice have rows of their own.
            let name = written.split('(').next().unwrap_or(written).trim();
            match (name, field.path) {
                ("", "material" | "adhesion") => first_name(written).to_owned(),
                (name, _) => choice_in_words(name),
            }
        }
        Range::Band(..) => written.trim_matches(['(', ')']).to_owned(),
        Range::Whole(..) if field.path != "roughness.seed" => {
            written.parse().map_or(written.to_owned(), grouped)
        }
        Range::Text { .. } => text_of(written),
        _ => written.split_whitespace().collect::<Vec<_>>().join(" "),
    }
}

/// The text of a string as written in RON, on one line; any other value as it is written.
pub(super) fn text_of(written: &str) -> String {
    let text: String = ron::from_str(written).unwrap_or_else(|_| written.to_owned());
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The first name in a group, in words: `work` of `(work: 0.05)`.
fn first_name(written: &str) -> &str {
    let name = written
        .trim_start_matches('(')
        .split(':')
        .next()
        .unwrap_or("")
        .trim();
    match name {
        "work" => "by work of adhesion",
        "kappa" => "by κ",
        "elastic_energy_ratio" => "by e_el/γ",
        "effective_modulus" => "by E*",
        "youngs_modulus" | "poisson_ratio" => "by E and ν",
        other => other,
    }
}
