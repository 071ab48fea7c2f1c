//! The list of parameters: the fields of the scene that can be changed as it stands.

use crate::scene::{
    Document, FIELDS, Field, Form, LEG_FORCE, LEG_INDENTATION, Leg, Range, Roughness, Solver,
    format_quantity, locate, parse_quantity, ron_float,
};

/// A parameter as the list shows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// What the table of fields says of it.
    pub field: &'static Field,
    /// The leg it belongs to, where it is the target of a leg.
    pub leg: Option<usize>,
    /// Its value as written in the scene file.
    pub written: String,
    /// Its value as people read it.
    pub shown: String,
}

/// Fields that describe the scene rather than the contact.
const NOT_LISTED: &[&str] = &["version", "title", "notice", "observe"];

impl Parameter {
    /// Name with the number of its leg.
    #[must_use]
    pub fn name(&self) -> String {
        match self.leg {
            Some(leg) => format!("leg {} {}", leg + 1, self.field.name),
            None => self.field.name.to_owned(),
        }
    }

    /// The override that gives this parameter the value `written` (as in a scene file).
    #[must_use]
    pub fn change(&self, document: &Document, written: &str) -> (String, String) {
        let Some(changed) = self.leg else { return (self.field.path.to_owned(), written.to_owned()) };
        let legs = document.scene().loading.iter().enumerate().map(|(index, leg)| match leg {
            Leg::ToForce(_) if index == changed => format!("ToForce({written})"),
            Leg::ToIndentation(_) if index == changed => format!("ToIndentation({written})"),
            Leg::ToForce(force) => format!("ToForce({})", ron_float(*force)),
            Leg::ToIndentation(indentation) => format!("ToIndentation({})", ron_float(*indentation)),
            other => format!("{other:?}"),
        });
        ("loading".to_owned(), format!("[{}]", legs.collect::<Vec<_>>().join(", ")))
    }

    /// What was typed, as it is written in a scene file: numbers may have prefix and unit.
    ///
    /// # Errors
    /// What is wrong with it and what is allowed.
    pub fn read_typed(&self, typed: &str) -> Result<String, String> {
        let typed = typed.trim();
        match self.field.range {
            Range::Real { .. } => parse_quantity(typed, self.field.unit)
                .map(ron_float)
                .map_err(|error| format!("{error}; allowed: {}", self.field.allowed())),
            // Counts may be typed as 64Ki, but a seed has more digits than a float keeps.
            Range::Whole { .. } if typed.parse::<u64>().is_err() => {
                match parse_quantity(typed, self.field.unit) {
                    Ok(value) if value.fract() == 0.0 && (0.0..9.0e15).contains(&value) => {
                        Ok(format!("{}", value as u64))
                    }
                    Ok(_) => Err(format!("{typed}: allowed: a whole number, {}", self.field.allowed())),
                    Err(error) => Err(format!("{error}; allowed: {}", self.field.allowed())),
                }
            }
            _ => Ok(typed.to_owned()),
        }
    }
}

/// The parameters of a scene, in the order of the scene file.
#[must_use]
pub fn parameters(document: &Document) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for field in FIELDS {
        let listed = !NOT_LISTED.contains(&field.path) && field.range != Range::Group;
        if !listed || !applies(field, document) {
            continue;
        }
        let text = document.text();
        let written = locate(text, field.path).map(|place| text[place.value].to_owned());
        let optional_alternative = field.parent() != "" && field.default == "None";
        let written = match written {
            Some(written) => written,
            None if optional_alternative => continue,
            None => field.default.to_owned(),
        };
        let shown = shown(field, &written);
        parameters.push(Parameter { field, leg: None, written, shown });
        if field.path == "loading" {
            parameters.extend(leg_targets(&document.scene().loading));
        }
    }
    parameters
}

fn leg_targets(loading: &[Leg]) -> impl Iterator<Item = Parameter> {
    loading.iter().enumerate().filter_map(|(index, leg)| {
        let (field, value) = match *leg {
            Leg::ToForce(force) => (&LEG_FORCE, force),
            Leg::ToIndentation(indentation) => (&LEG_INDENTATION, indentation),
            _ => return None,
        };
        let shown = format_quantity(value, field.unit);
        Some(Parameter { field, leg: Some(index), written: ron_float(value), shown })
    })
}

/// Whether a field belongs to the choices the scene has made.
fn applies(field: &Field, document: &Document) -> bool {
    let scene = document.scene();
    let chosen = match field.parent() {
        "form" => scene.form.map(|form| match form {
            Form::Paraboloid { .. } => "Paraboloid",
            Form::Cone { .. } => "Cone",
            Form::Power { .. } => "Power",
            Form::Punch { .. } => "Punch",
        }),
        "roughness" => scene.roughness.as_ref().map(|roughness| match roughness {
            Roughness::SelfAffine { .. } => "SelfAffine",
            Roughness::Measured { .. } => "Measured",
        }),
        "numerics.solver" => match scene.numerics.solver {
            Solver::Exact => Some("Exact"),
            Solver::Stepwise { .. } => Some("Stepwise"),
        },
        "adhesion" => scene.adhesion.map(|_| ""),
        _ => Some(""),
    };
    chosen.is_some_and(|chosen| field.variant.is_none_or(|variant| variant == chosen))
}

/// A written value as people read it.
fn shown(field: &Field, written: &str) -> String {
    match (field.range, written.parse::<f64>()) {
        (Range::Real { .. }, Ok(value)) => format_quantity(value, field.unit),
        (Range::Choice(_), _) => {
            // The parts of a choice stand in rows of their own.
            let name = written.split('(').next().unwrap_or(written).trim();
            match (name, field.path) {
                ("", "material" | "adhesion") => first_name(written).to_owned(),
                ("None", _) => "none".to_owned(),
                (name, _) => name.to_owned(),
            }
        }
        _ => written.split_whitespace().collect::<Vec<_>>().join(" "),
    }
}

/// The first name in a group: `work` of `(work: 0.05)`, in words.
fn first_name(written: &str) -> &str {
    let name = written.trim_start_matches('(').split(':').next().unwrap_or("").trim();
    match name {
        "work" => "by work of adhesion",
        "kappa" => "by κ",
        "effective_modulus" => "by E*",
        "youngs_modulus" | "poisson_ratio" => "by E and ν",
        other => other,
    }
}
