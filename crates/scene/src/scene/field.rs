//! Description of one field of a scene: path, symbol, unit, range, step, default and meaning.

use super::range::{Range, choice_name};
use super::slot::Place;
use super::spheres::Member;
use super::stages::{STAGES, read_loading, stages_in_ron};
use super::text::{ron_float, ron_string};
use asperity_contact::Move;
use asperity_data::{QuantityError, in_unit, parse_quantity, unit_of};
use asperity_surface::Sphere;

/// Description of one field of a scene: a row of the table
/// [`FIELDS`](crate::scene::fields::FIELDS).
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Path of the field from the top of the scene, with dots between its parts: `roughness.hurst`.
    pub path: &'static str,
    /// Choice to which this field belongs, such as the form `Paraboloid` for its radius. `None` if
    /// the field belongs to every scene.
    pub variant: Option<&'static str>,
    /// Name of the field in words, such as `Hurst exponent`.
    pub name: &'static str,
    /// Symbol of the field in the equations; empty if it has none.
    pub symbol: &'static str,
    /// SI unit of the field. It is `1` for a number without a unit, and empty for a field that is
    /// not a number.
    pub unit: &'static str,
    /// Allowed values of the field.
    pub range: Range,
    /// How one press of a key in the explorer changes the value of the field.
    pub step: Step,
    /// Value of the field if the scene omits it, as RON text; empty if the field is required.
    pub default: &'static str,
    /// Meaning of the field in one line.
    pub meaning: &'static str,
    /// Further words for the field, from tribology and from everyday language, by which a search
    /// finds it.
    pub words: &'static str,
    /// Function that converts typed text to RON.
    pub(super) read: Read,
    /// Where a scene stores the value of the field.
    pub(super) place: Place,
}

/// Function that converts typed text, without blanks around it, to the value of a field in RON.
pub(super) type Read = fn(&Field, &str) -> Result<String, QuantityError>;

/// How one press of a key in the explorer changes the value of a field, by a small or by a large
/// step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A small step adds the first number, a large step the second one. The result is rounded to a
    /// multiple of the first number.
    Linear(f64, f64),
    /// Goes to the next preferred number. In a small step this is the next number of the Renard
    /// series R20, which has 20 numbers in each decade. In a large step it is the next number of
    /// the series …, 1, 2, 5, 10, 20, 50, ….
    Logarithmic,
    /// A small step adds the first integer, a large step the second one.
    Integer(u64, u64),
    /// A small step goes to the next power of two. A large step is as far as four small steps.
    Doubling,
    /// Changes one number of a pair that limits a range of waves: two modes (numbers of waves on
    /// the length) or two wavelengths. A small step changes the second number of the pair, a large
    /// step the first.
    Band,
    /// Goes to the next allowed choice.
    Choice,
    /// Keys do not change the value; it can only be typed.
    Typed,
}

/// Creates the description of a required field. Its unit and its step follow from the range, and
/// its name is its path.
pub(super) const fn row(path: &'static str, place: Place, range: Range) -> Field {
    let step = match range {
        Range::Real(..) => Step::Logarithmic,
        Range::Band(..) | Range::Wavelengths(..) => Step::Band,
        Range::Choice(_) => Step::Choice,
        Range::Whole(..) | Range::Text { .. } | Range::List { .. } | Range::Group => Step::Typed,
    };
    let unit = match range {
        Range::Real(..) | Range::Whole(..) | Range::Band(..) | Range::Wavelengths(..) => "1",
        Range::Choice(_) | Range::Text { .. } | Range::List { .. } | Range::Group => "",
    };
    let read: Read = match range {
        Range::Real(..) => read_number,
        Range::Whole(..) => read_whole,
        Range::Band(..) | Range::Wavelengths(..) => read_pair,
        Range::Choice(_) => read_choice,
        Range::Text { .. } => read_text,
        Range::List { .. } | Range::Group => read_unchanged,
    };
    Field {
        path,
        variant: place.choice,
        name: path,
        symbol: "",
        unit,
        range,
        step,
        default: "",
        meaning: "",
        words: "",
        read,
        place,
    }
}

/// Each of these methods returns the description with another value of one member.
impl Field {
    pub(super) const fn name(self, name: &'static str) -> Field {
        Field { name, ..self }
    }

    pub(super) const fn quantity(
        self,
        name: &'static str,
        symbol: &'static str,
        unit: &'static str,
    ) -> Field {
        Field {
            name,
            symbol,
            unit,
            ..self
        }
    }

    pub(super) const fn default(self, default: &'static str) -> Field {
        Field { default, ..self }
    }

    pub(super) const fn meaning(self, meaning: &'static str) -> Field {
        Field { meaning, ..self }
    }

    pub(super) const fn read(self, read: Read) -> Field {
        Field { read, ..self }
    }
}

impl Field {
    /// Creates a description of a parameter that does not belong to a scene, but that a program
    /// shows beside the fields of a scene.
    pub const fn beside(
        path: &'static str,
        name: &'static str,
        range: Range,
        meaning: &'static str,
    ) -> Field {
        row(path, Place::NOWHERE, range).name(name).meaning(meaning)
    }

    /// Returns this description with this SI unit.
    pub const fn in_unit(self, unit: &'static str) -> Field {
        Field { unit, ..self }
    }

    /// Returns this description with this step of the arrow keys.
    pub const fn step(self, step: Step) -> Field {
        Field { step, ..self }
    }

    /// Returns this description with other words by which a search finds the field.
    pub const fn words(self, words: &'static str) -> Field {
        Field { words, ..self }
    }

    /// Returns the allowed values of this field in words, with the unit: `from 1 to 1e13 Pa`.
    pub fn allowed(&self) -> String {
        match self.unit {
            "" | "1" => self.range.to_string(),
            unit => format!("{} {unit}", self.range),
        }
    }

    /// Formats a value of this field with its unit, such as `100 µm, 200 nm`. `written` is the
    /// value in RON: a number or a pair of wavelengths. `format` formats each number with its unit.
    /// Returns `None` if `written` is neither a number nor a pair of wavelengths.
    pub fn quantities(&self, written: &str, format: fn(f64, &str) -> String) -> Option<String> {
        match self.range {
            Range::Real(..) => Some(format(written.parse().ok()?, self.unit)),
            Range::Wavelengths(..) => {
                let (longest, shortest) = ron::from_str::<(f64, f64)>(written).ok()?;
                let longest = format(longest, self.unit);
                let shortest = format(shortest, self.unit);
                Some(format!("{longest}, {shortest}"))
            }
            _ => None,
        }
    }

    /// Returns the typed number `typed` with a unit. If `typed` has no unit, the unit of the shown
    /// value `shown` is added: `50` becomes `50 mJ/m²` if the shown value is `4.356 mJ/m²`.
    pub fn in_shown_units(&self, typed: &str, shown: &str) -> String {
        if let Range::Real(..) = self.range {
            return in_unit(typed, unit_of(shown));
        }
        if let Range::Wavelengths(..) = self.range
            && let Some((shown_longest, shown_shortest)) = shown.split_once(", ")
            && let Some((longest, shortest)) = split_pair(typed)
        {
            let longest = in_unit(longest.trim(), unit_of(shown_longest));
            let shortest = in_unit(shortest.trim(), unit_of(shown_shortest));
            return format!("{longest}, {shortest}");
        }
        typed.to_owned()
    }

    /// Returns the path of the group of fields to which the field belongs. The path is empty if the
    /// field belongs to no group.
    pub fn parent(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(parent, _)| parent)
    }

    /// Returns the part of a path that follows the path of this field: `1` for `roughness.modes.1`,
    /// and empty for the path of the field itself. Returns `None` for a path that is not inside
    /// this field.
    pub(super) fn inside_path<'p>(&self, path: &'p str) -> Option<&'p str> {
        let rest = path.strip_prefix(self.path)?;
        if rest.is_empty() {
            Some(rest)
        } else {
            rest.strip_prefix('.')
        }
    }

    /// Returns the last part of the path of this field: `hurst` for `roughness.hurst`.
    pub fn last(&self) -> &'static str {
        self.path
            .rsplit_once('.')
            .map_or(self.path, |(_, last)| last)
    }
}

impl PartialEq for Field {
    fn eq(&self, other: &Field) -> bool {
        (self.path, self.variant) == (other.path, other.variant)
    }
}

pub(super) const FILE_NAME: Range = Range::Text {
    least: 1,
    most: 4096,
    lines: false,
};

/// Name of the file of a table, or the rows of the table in place of the name.
pub(super) const TABLE: Range = Range::Text {
    least: 1,
    most: 500_000,
    lines: false,
};

/// Description of the target value of a loading stage [`ToForce`](asperity_contact::Move::ToForce):
/// the force in N at which the stage ends.
pub const STAGE_FORCE: Field = row(
    "loading",
    Place::NOWHERE.of("ToForce"),
    Range::closed(-1e30, 1e30),
)
.quantity("force of stage", "F", "N")
.meaning(
    "target: the stage ends where the force first reaches this value; compression is positive",
);

/// Description of the target value of a loading stage
/// [`ToIndentation`](asperity_contact::Move::ToIndentation): the indentation in m at which the
/// stage ends.
pub const STAGE_INDENTATION: Field = row(
    "loading",
    Place::NOWHERE.of("ToIndentation"),
    Range::closed(-1e6, 1e6),
)
.quantity("indentation of stage", "d", "m")
.meaning("target: the stage ends at this indentation; 0 is first touch, positive is deeper");

/// Description of one loading stage. The allowed choices are the kinds of stages, such as a force
/// or separation.
pub const STAGE: Field = row("loading", Place::NOWHERE, Range::Choice(&STAGES)).name("stage").meaning(
    "target of the stage: a force (10 µN), an indentation (200 nm), a displacement, touch, zero force, separation, or a time at rest (hold 10 s)",
);
/// Description of the target value of a loading stage
/// [`ToDisplacement`](asperity_contact::Move::ToDisplacement): the displacement of the instrument
/// in m at which the stage ends.
pub const STAGE_DISPLACEMENT: Field = row(
    "loading",
    Place::NOWHERE.of("ToDisplacement"),
    Range::closed(-1e6, 1e6),
)
.quantity("displacement of stage", "D", "m")
.meaning("target: the stage ends at this displacement of the instrument, D = d + F/k");

/// Description of the value of a loading stage [`Hold`](asperity_contact::Move::Hold): the time in
/// s for which the drive of the instrument stays in place.
pub const STAGE_HOLD: Field = row(
    "loading",
    Place::NOWHERE.of("Hold"),
    Range::closed(0.0, 1e12),
)
.quantity("time of hold", "t", "s")
.meaning(
    "the instrument keeps its place for this time; without relaxation the contact does not change",
);

/// Descriptions of the values of loading stages: force, indentation, displacement and time.
pub const STAGE_FIELDS: [&Field; 4] = [
    &STAGE_FORCE,
    &STAGE_INDENTATION,
    &STAGE_DISPLACEMENT,
    &STAGE_HOLD,
];

/// Returns the target value of a loading stage, and its description. Returns `None` for a stage
/// without a target value, such as separation.
pub fn target_field(stage: Move) -> Option<(&'static Field, f64)> {
    match stage {
        Move::ToForce(force) => Some((&STAGE_FORCE, force)),
        Move::ToIndentation(indentation) => Some((&STAGE_INDENTATION, indentation)),
        Move::ToDisplacement(displacement) => Some((&STAGE_DISPLACEMENT, displacement)),
        Move::Hold(seconds) => Some((&STAGE_HOLD, seconds)),
        Move::ToTouch | Move::ToZeroForce | Move::ToSeparation => None,
    }
}

/// Description of the radius of each sphere of a form. The path is that of the first sphere.
pub const SPHERE_RADIUS: Field = row(
    "form.0.radius",
    Place::NOWHERE.of("Spheres"),
    Range::above(0.0, 1e9),
)
.quantity("radius of sphere", "R", "m")
.meaning("radius of curvature of the first sphere; form.1 is the second sphere");

/// Description of the distance of each sphere of a form behind the sphere that is ahead. The path
/// is that of the first sphere.
pub const SPHERE_BEHIND: Field = row(
    "form.0.behind",
    Place::NOWHERE.of("Spheres"),
    Range::closed(0.0, 1e6),
)
.quantity("distance behind of sphere", "b", "m")
.default("0.0")
.meaning("depth of its apex below that of the sphere ahead");

/// Descriptions of the values of each sphere of a form: radius and distance.
pub const SPHERE_FIELDS: [&Field; 2] = [&SPHERE_RADIUS, &SPHERE_BEHIND];

/// Returns the description of a value of a sphere from its path in a scene, such as
/// `form.1.radius`; `None` for any other path.
pub(super) fn sphere_field(path: &str) -> Option<&'static Field> {
    let member = Member::inside_form(path.strip_prefix("form.")?)?;
    SPHERE_FIELDS
        .into_iter()
        .find(|field| field.last() == member.name)
}

/// Returns the values of a sphere with their descriptions.
pub fn sphere_values(sphere: Sphere) -> [(&'static Field, f64); 2] {
    [
        (&SPHERE_RADIUS, sphere.radius),
        (&SPHERE_BEHIND, sphere.behind),
    ]
}

/// Whole numbers below this limit are exact as floating-point numbers. Above the limit,
/// floating-point numbers may skip whole numbers.
const MOST_EXACT: f64 = 9.0e15;

impl Field {
    /// Converts a typed value of this field to RON.
    ///
    /// * A number may have an SI prefix and the unit of the field: `50 mJ/m²`, `16k`.
    /// * The text `none` omits an optional part.
    /// * A loading may be a list of stages in the notation of
    ///   [`loading_text`](crate::scene::stages::loading_text), such as `10 µN, separation`.
    ///
    /// # Errors
    /// Returns an error for a number with another unit, a number too large for `f64`, or a choice
    /// without its numbers.
    pub fn read_typed(&self, typed: &str) -> Result<String, QuantityError> {
        match typed.trim() {
            // Outputs show an omitted part as `none`.
            "none" if self.default == "None" => Ok(self.default.to_owned()),
            typed => (self.read)(self, typed),
        }
    }
}

fn begins_as_number(typed: &str) -> bool {
    typed.starts_with(|sign: char| sign.is_ascii_digit() || matches!(sign, '+' | '-' | '.'))
}

/// Returns true if the text is a number with a prefix or a unit, which RON does not allow.
fn is_quantity(typed: &str) -> bool {
    begins_as_number(typed) && ron::from_str::<f64>(typed).is_err()
}

fn read_unchanged(_: &Field, typed: &str) -> Result<String, QuantityError> {
    Ok(typed.to_owned())
}

/// Reads a number in RON, or a number with a prefix or with the unit of the field.
fn read_number(field: &Field, typed: &str) -> Result<String, QuantityError> {
    if is_quantity(typed) {
        parse_quantity(typed, field.unit).map(ron_float)
    } else {
        Ok(typed.to_owned())
    }
}

/// Returns a number in RON as a whole number. Returns `None` if the number is not whole or too
/// large to be exact.
fn whole_in_ron(value: f64) -> Option<String> {
    let is_whole = value.fract() == 0.0 && (0.0..MOST_EXACT).contains(&value);
    is_whole.then(|| (value as u64).to_string())
}

/// Reads a whole number, which may have blanks between its digits or a prefix.
fn read_whole(field: &Field, typed: &str) -> Result<String, QuantityError> {
    let digits: String = typed.split_whitespace().collect();
    if digits.parse::<u64>().is_ok() {
        return Ok(digits);
    }
    // A seed can have more digits than a floating-point number holds, so a whole number is not read
    // as one.
    if begins_as_number(typed) && ron::from_str::<u64>(typed).is_err() {
        let whole = whole_in_ron(parse_quantity(typed, field.unit)?);
        return Ok(whole.unwrap_or_else(|| typed.to_owned()));
    }
    Ok(typed.to_owned())
}

/// Reads two numbers. A single number is read like a number of any other field.
fn read_pair(field: &Field, typed: &str) -> Result<String, QuantityError> {
    let is_whole = matches!(field.range, Range::Band(..));
    let Some((first, last)) = split_pair(typed) else {
        return if is_whole {
            read_whole(field, typed)
        } else {
            read_number(field, typed)
        };
    };
    let first = parse_quantity(first.trim(), field.unit)?;
    let last = parse_quantity(last.trim(), field.unit)?;
    if is_whole {
        let first = whole_in_ron(first).unwrap_or_else(|| ron_float(first));
        let last = whole_in_ron(last).unwrap_or_else(|| ron_float(last));
        Ok(format!("({first}, {last})"))
    } else {
        Ok(format!("({}, {})", ron_float(first), ron_float(last)))
    }
}

/// Reads a text with or without quotes.
fn read_text(field: &Field, typed: &str) -> Result<String, QuantityError> {
    let is_file = field.range == FILE_NAME || field.range == TABLE;
    let is_omitted = is_file && (typed.is_empty() || typed == "None");
    let is_quoted = typed.starts_with('"') || ron::from_str::<String>(typed).is_ok();
    Ok(if is_omitted || is_quoted {
        typed.to_owned()
    } else {
        ron_string(typed)
    })
}

/// Converts a typed choice to RON. The typed choice may be in RON or in words for users, such as
/// `sub-cell`.
fn read_choice(field: &Field, typed: &str) -> Result<String, QuantityError> {
    let Range::Choice(choices) = field.range else {
        return Ok(typed.to_owned());
    };
    for choice in choices {
        let name = choice_name(choice);
        if name != typed && choice_in_words(name) != typed {
            continue;
        }
        if name.len() < choice.len() {
            let reason = format!("its numbers are missing: give them as in {choice}");
            return Err(QuantityError(reason));
        }
        return Ok((*choice).to_owned());
    }
    Ok(typed.to_owned())
}

/// Converts a typed form to RON. The name of a file becomes a table that is read from this file.
pub(super) fn read_form(field: &Field, typed: &str) -> Result<String, QuantityError> {
    if is_file_name(typed) {
        Ok(format!("Table(file: {})", ron_string(typed)))
    } else {
        read_choice(field, typed)
    }
}

/// Converts a typed roughness to RON. The name of a file becomes a measured surface that is read
/// from this file.
pub(super) fn read_roughness(field: &Field, typed: &str) -> Result<String, QuantityError> {
    if is_file_name(typed) {
        Ok(format!("Measured(file: {})", ron_string(typed)))
    } else {
        read_choice(field, typed)
    }
}

/// Converts a typed adhesion to RON. A number with a unit becomes a work of adhesion.
pub(super) fn read_adhesion(field: &Field, typed: &str) -> Result<String, QuantityError> {
    if is_quantity(typed) {
        let work = parse_quantity(typed, "J/m²")?;
        Ok(format!("(work: {})", ron_float(work)))
    } else {
        read_choice(field, typed)
    }
}

/// Reads a list of loading stages in RON, or as text such as `10 µN, separation`.
pub(super) fn read_stages(_: &Field, typed: &str) -> Result<String, QuantityError> {
    if ron::from_str::<Vec<Move>>(typed).is_ok() {
        return Ok(typed.to_owned());
    }
    Ok(stages_in_ron(&read_loading(typed)?))
}

/// Splits a typed pair into its two parts: `4, 512`, `4–512`, `4 to 512`, with or without brackets.
fn split_pair(typed: &str) -> Option<(&str, &str)> {
    let pair = typed.trim_matches(['(', ')', ' ', ',']);
    [",", "–", " to "]
        .iter()
        .find_map(|between| pair.split_once(between))
}

/// Returns the name of a choice without fields as users read and type it: `sub-cell` for `SubCell`.
pub fn choice_in_words(name: &str) -> String {
    let mut words = String::new();
    for character in name.chars() {
        if character.is_uppercase() && !words.is_empty() {
            words.push('-');
        }
        words.extend(character.to_lowercase());
    }
    words
}

/// Returns true if a typed text is the name of a file: it contains a dot or a path separator, but
/// no bracket or quotation mark, which only RON has.
fn is_file_name(typed: &str) -> bool {
    typed.contains(['.', '/', '\\']) && !typed.contains(['(', '"'])
}

#[cfg(test)]
mod tests {
    use super::super::fields::field;

    #[test]
    fn numbers_may_have_prefix_and_unit() {
        for row in [
            "adhesion.work|50mJ/m2|0.05",
            "adhesion|none|None",
            "title|none|\"none\"",
            "loading|10 µN,0 N, -5 nm, separation|[ToForce(1.0e-5), ToForce(0.0), ToIndentation(-5.0e-9), ToSeparation]",
            "loading_stiffness|40 mN/m|0.04",
            "adhesion.work| 50 mN/m |0.05",
            "adhesion|30 mJ/m²|(work: 0.03)",
            "adhesion|(kappa: 2.0)|(kappa: 2.0)",
            "adhesion.work|5.0e-2|5.0e-2",
            "numerics.points|64Ki|65536",
            "numerics.points|1_024|1_024",
            "numerics.points|16 384|16384",
            "numerics.edges|sub-cell|SubCell",
            "roughness.modes|4, 512|(4, 512)",
            "roughness.modes|4–512|(4, 512)",
            "roughness.modes|(4, 1Ki)|(4, 1024)",
            "roughness.wavelengths|100 µm to 0.2 µm|(1.0e-4, 2.0e-7)",
            "numerics.points|1.5|1.5",
            "roughness.seed|18446744073709551616|18446744073709551616",
            "length|-inf|-inf",
            "form.angle|90°|1.5707963267948966",
            "title|\"10 µm\"|\"10 µm\"",
            "roughness|a b/1.txt|Measured(file: \"a b/1.txt\")",
            "roughness|Measured(file: \"a.txt\")|Measured(file: \"a.txt\")",
            "roughness|None|None",
            "roughness.wavelengths|100 µm, 0.2um|(1.0e-4, 2.0e-7)",
            "roughness.wavelengths|(1e-4, 2e-7,)|(1.0e-4, 2.0e-7)",
            "roughness.wavelengths|200 nm|2.0e-7",
            "roughness.roll_off|20 µm|2.0e-5",
            "roughness.file|7.txt|\"7.txt\"",
            "roughness.opposite|None|None",
        ] {
            let [path, typed, ron] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            assert_eq!(
                field(path, None).unwrap().read_typed(typed).as_deref(),
                Ok(ron),
                "{row}"
            );
        }
        for row in [
            "length|5|100 µm|5 µm",
            "roughness.wavelengths|80, 500|100 µm, 200 nm|80 µm, 500 nm",
            "roughness.wavelengths|(80, 0.5 µm)|= 100 µm, 200 nm|80 µm, 0.5 µm",
            "roughness.modes|4, 512|1, 64|4, 512",
        ] {
            let [path, typed, shown, read] = row.split('|').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            assert_eq!(
                field(path, None).unwrap().in_shown_units(typed, shown),
                read,
                "{row}"
            );
        }
        let wrong = field("length", None)
            .unwrap()
            .read_typed("10 kg")
            .unwrap_err();
        assert_eq!(
            wrong.to_string(),
            "kg is not a unit of length: use m, mm, µm, nm"
        );
    }
}
