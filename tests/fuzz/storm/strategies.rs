//! Strategies for random scenes, which draw every field of the table of fields.

use asperity::data::is_control;
use asperity::scene::Document;
use asperity::scene::fields::{FIELDS, Field, Range, SPHERE_FIELDS, STAGE_FIELDS};
use asperity::scene::library::{DEFAULT, find_scene};
use asperity::scene::text::{ron_float, ron_string};
use proptest::prelude::*;

/// Most elements of a drawn list; longer lists add time and no other case.
const MOST_ELEMENTS: usize = 6;

/// Most characters of a drawn text.
const MOST_CHARACTERS: usize = 40;

/// Numbers of values in ten at an end of their range, or drawn over all its orders of magnitude.
const EXTREME: [u32; 3] = [1, 5, 10];

/// Options of the draws.
#[derive(Clone, Default)]
pub struct Drawn {
    /// Fields with values of another strategy, by path: a whole range would take too long to
    /// compute.
    narrowed: Vec<(&'static str, BoxedStrategy<String>)>,
    /// True to draw now and then values outside their ranges or of other types, missing and unknown
    /// fields.
    wrong: bool,
    /// Number of extreme values in ten.
    extreme: u32,
}

/// Returns a form of spheres with these radii and distances. If `is_ahead` is true, the first
/// sphere is ahead of all others.
fn spheres_in_ron(spheres: &[[String; 2]], is_ahead: bool) -> String {
    let mut written = Vec::new();
    for (index, [radius, behind]) in spheres.iter().enumerate() {
        written.push(if index == 0 && is_ahead {
            format!("(radius: {radius})")
        } else {
            format!("(radius: {radius}, behind: {behind})")
        });
    }
    format!("Spheres([{}])", written.join(", "))
}

impl Drawn {
    /// Sets another strategy for the values of one field.
    pub fn narrowed(mut self, path: &'static str, value: BoxedStrategy<String>) -> Self {
        self.narrowed.push((path, value));
        self
    }

    /// Draws mistakes as well.
    pub fn with_mistakes(self) -> Self {
        Drawn {
            wrong: true,
            ..self
        }
    }

    /// Texts of scenes: from ordinary ones to those with each value at an end of its range.
    pub fn scene_texts(&self) -> BoxedStrategy<String> {
        let of = |extreme| {
            Drawn {
                extreme,
                ..self.clone()
            }
            .group("", None, "")
        };
        proptest::strategy::Union::new(EXTREME.map(of)).boxed()
    }

    /// Scenes that can be computed, some of them with wavelengths in place of modes and with a
    /// roll-off.
    pub fn documents(&self) -> impl Strategy<Value = Document> + use<> {
        let roll_off = prop::option::weighted(0.3, 0.0..1.0_f64);
        (self.scene_texts(), any::<bool>(), roll_off).prop_filter_map(
            "a scene that is allowed",
            |(text, in_metres, roll_off)| {
                let document = Document::parse(&text, "drawn").ok()?;
                let Some(spectrum) = document.scene().spectrum() else {
                    return Some(document);
                };
                let [longest, shortest] = [spectrum.first, spectrum.last]
                    .map(|mode| document.scene().length / mode as f64);
                let set = |path: &str, value| (path.to_owned(), value);
                let mut sets = Vec::new();
                if in_metres {
                    let pair = format!("({}, {})", ron_float(longest), ron_float(shortest));
                    sets = vec![
                        set("roughness.modes", "None".into()),
                        set("roughness.wavelengths", pair),
                    ];
                }
                let share =
                    |share: f64| (longest + share * (shortest - longest)).clamp(shortest, longest);
                sets.extend(roll_off.map(|at| set("roughness.roll_off", ron_float(share(at)))));
                // A very short wave is outside the range of its field.
                Some(document.set_all(&sets).unwrap_or(document))
            },
        )
    }

    /// Overrides in the form of `--set`: path and value.
    pub fn overrides(&self, most: usize) -> BoxedStrategy<Vec<(String, String)>> {
        let of = |field: &'static Field| {
            let drawn = Drawn {
                extreme: EXTREME[0],
                ..self.clone()
            };
            drawn
                .value(field)
                .prop_map(|value| (field.path.to_string(), value))
                .boxed()
        };
        let stages = STAGE_FIELDS.map(|stage| {
            let value = Drawn {
                extreme: EXTREME[0],
                ..self.clone()
            }
            .value(stage);
            (0..3_usize, value)
                .prop_map(|(index, value)| (format!("loading.{index}.0"), value))
                .boxed()
        });
        let spheres = SPHERE_FIELDS.map(|field| {
            let value = Drawn {
                extreme: EXTREME[0],
                ..self.clone()
            }
            .value(field);
            (0..3_usize, value)
                .prop_map(|(index, value)| (format!("form.{index}.{}", field.last()), value))
                .boxed()
        });
        let fields = FIELDS.iter().map(of).chain(stages).chain(spheres);
        let one = proptest::strategy::Union::new(fields);
        prop::collection::vec(one, 1..=most).boxed()
    }

    /// Text of a value of a field.
    fn value(&self, field: &'static Field) -> BoxedStrategy<String> {
        if let Some((_, value)) = self.narrowed.iter().find(|(path, _)| *path == field.path) {
            return value.clone();
        }
        let value = match field.range {
            Range::Real(..) => self.number(field).prop_map(ron_float).boxed(),
            Range::Whole(min, max) => whole(min, max).prop_map(|value| value.to_string()).boxed(),
            Range::Band(min, max) => (whole(min, max), whole(min, max))
                .prop_map(|(one, other)| format!("({}, {})", one.min(other), one.max(other)))
                .boxed(),
            Range::Wavelengths(..) => (self.number(field), self.number(field))
                .prop_map(|(one, other)| {
                    format!(
                        "({}, {})",
                        ron_float(one.max(other)),
                        ron_float(one.min(other))
                    )
                })
                .boxed(),
            Range::Text { most, lines, .. } => text(most.min(MOST_CHARACTERS), lines),
            Range::Choice(of) => {
                let choice = |template: &&'static str| self.choice(field, template);
                proptest::strategy::Union::new(of.iter().map(choice)).boxed()
            }
            Range::List { of, least, most } => {
                let element = |template: &&'static str| self.choice(field, template);
                let element = proptest::strategy::Union::new(of.iter().map(element));
                prop::collection::vec(element, least..=most.min(MOST_ELEMENTS))
                    .prop_map(|elements| format!("[{}]", elements.join(", ")))
                    .boxed()
            }
            Range::Group => self.group(field.path, None, ""),
        };
        if self.wrong {
            prop_oneof![24 => value, 1 => mistake(field)].boxed()
        } else {
            value
        }
    }

    /// One of the choices of a field, given as a template: `Cone(angle: 0.1)`, `(work: 0.05)`,
    /// `ToForce(1.0e-5)` or `Exact`.
    fn choice(&self, field: &'static Field, template: &'static str) -> BoxedStrategy<String> {
        let (name, arguments) = template.split_once('(').unwrap_or((template, ""));
        if arguments.is_empty() {
            return Just(name.to_string()).boxed();
        }
        if arguments.starts_with('[') {
            let sphere = SPHERE_FIELDS.map(|field| self.value(field));
            let spheres = prop::collection::vec(sphere, 1..4);
            return (spheres, any::<bool>())
                .prop_map(|(spheres, is_ahead)| spheres_in_ron(&spheres, is_ahead))
                .boxed();
        }
        let argument = STAGE_FIELDS
            .into_iter()
            .find(|stage| (stage.path, stage.variant) == (field.path, Some(name)));
        match argument {
            Some(argument) => self
                .value(argument)
                .prop_map(move |value| format!("{name}({value})"))
                .boxed(),
            None => {
                let variant = Some(name).filter(|name| !name.is_empty());
                self.group(field.path, variant, arguments)
                    .prop_map(move |group| format!("{name}{group}"))
                    .boxed()
            }
        }
    }

    /// The fields below a path, in parentheses. A template names the fields of a complete group;
    /// other optional fields are mostly left out.
    fn group(&self, parent: &str, variant: Option<&str>, template: &str) -> BoxedStrategy<String> {
        let belongs = |field: &&Field| {
            field.parent() == parent
                && field.path != parent
                && (field.variant.is_none() || variant.is_none() || field.variant == variant)
        };
        let entry = |field: &'static Field| {
            let named = template.contains(&format!("{}:", field.last()));
            let given = match field.default {
                "" if self.wrong => 0.99,
                "" => 1.0,
                "None" if named => 0.95,
                // Texts such as units are rarely allowed.
                "None" | "[]" | "\"\"" if !template.is_empty() => 0.05,
                _ => 0.7,
            };
            let name = if self.wrong {
                prop_oneof![60 => Just(field.last()), 1 => Just("colour")].boxed()
            } else {
                Just(field.last()).boxed()
            };
            let entry =
                (name, self.value(field)).prop_map(|(name, value)| format!("{name}: {value}"));
            if given < 1.0 {
                prop::option::weighted(given, entry).boxed()
            } else {
                entry.prop_map(Some).boxed()
            }
        };
        let entries: Vec<_> = FIELDS.iter().filter(belongs).map(entry).collect();
        entries
            .prop_map(|entries| {
                format!(
                    "({})",
                    entries.into_iter().flatten().collect::<Vec<_>>().join(", ")
                )
            })
            .boxed()
    }

    /// Numbers around the usual value of the field, and extreme ones: the ends of the range, and
    /// all its orders of magnitude alike.
    fn number(&self, field: &'static Field) -> BoxedStrategy<f64> {
        let (least, most) = field.range.ends().unwrap_or_default();
        let least = if field.range.contains(least) {
            least
        } else {
            least.next_up()
        };
        let most = if field.range.contains(most) {
            most
        } else {
            most.next_down()
        };
        let size = least.abs().max(most.abs());
        let smallest = if least > 0.0 {
            least
        } else {
            1e-300_f64.max(f64::MIN_POSITIVE / size)
        };
        let signed = |size: BoxedStrategy<f64>| {
            (size, any::<bool>()).prop_map(move |(size, negative)| {
                let value = if negative && least < 0.0 { -size } else { size };
                value.clamp(least, most)
            })
        };
        let decades = (smallest.ln()..size.ln()).prop_map(f64::exp).boxed();
        let usual = usual(field).unwrap_or((smallest.max(1e-3) * size.min(1e3)).sqrt());
        let near = (-5.0..5.0_f64)
            .prop_map(move |power| usual * power.exp())
            .boxed();
        let ends = prop_oneof![Just(least), Just(most), Just(0.0_f64.clamp(least, most))];
        let inside = (0.0..1.0_f64)
            .prop_map(move |share| (least + share * (most - least)).clamp(least, most));
        let extreme = prop_oneof![1 => ends, 2 => inside, 4 => signed(decades)];
        prop_oneof![10 - self.extreme.min(9) => signed(near), self.extreme.max(1) => extreme]
            .boxed()
    }
}

/// Whole numbers, all orders of magnitude alike, and the ends of their range.
fn whole(min: u64, max: u64) -> BoxedStrategy<u64> {
    let decades = ((min.max(1) as f64).ln()..=(max as f64).ln())
        .prop_map(move |log| (log.exp().round() as u64).clamp(min, max));
    prop_oneof![1 => Just(min), 1 => Just(max), 10 => decades].boxed()
}

/// Text with characters of all kinds except control characters.
fn text(most: usize, lines: bool) -> BoxedStrategy<String> {
    let character =
        prop_oneof![4 => proptest::char::range(' ', '~'), 1 => any::<char>(), 1 => Just('\n')];
    let allowed = move |c: &char| !is_control(*c) || (lines && *c == '\n');
    prop::collection::vec(character, 1..=most.max(1))
        .prop_map(move |text| {
            let mut text: String = text.into_iter().filter(allowed).collect();
            if text.is_empty() {
                text.push('x');
            }
            ron_string(&text)
        })
        .boxed()
}

/// Values that a field does not allow: beyond the ends of the range, another type, nothing.
fn mistake(field: &'static Field) -> BoxedStrategy<String> {
    let mut values: Vec<String> = [
        "",
        "NaN",
        "-inf",
        "-1",
        "1e999",
        "None",
        "()",
        "[]",
        "\"\\u{1b}[2J\"",
        "Nothing",
    ]
    .map(str::to_string)
    .to_vec();
    for end in field
        .range
        .ends()
        .into_iter()
        .flat_map(|(least, most)| [least, most])
    {
        let away = end.abs().max(f64::MIN_POSITIVE) * 1e-9;
        values.extend([ron_float(end - away), ron_float(end + away)]);
    }
    prop::sample::select(values).boxed()
}

/// A usual value of a number: that of the template of its choice, or of the default scene.
fn usual(field: &Field) -> Option<f64> {
    let number = |text: &str| {
        let end = text.find([',', ')']).unwrap_or(text.len());
        text[..end].trim().parse::<f64>().ok()
    };
    let of_templates = |templates: &[&str]| {
        templates
            .iter()
            .filter(|template| template.starts_with(field.variant.unwrap_or("")))
            .find_map(
                |template| match template.split_once(&format!("{}: ", field.last())) {
                    Some((_, rest)) => number(rest),
                    None => number(template.split_once('(')?.1),
                },
            )
    };
    let parent = if field.parent().is_empty() {
        field.path
    } else {
        field.parent()
    };
    let templates = FIELDS
        .iter()
        .find(|other| other.path == parent)
        .map(|other| other.range);
    let found = match templates {
        Some(Range::Choice(of) | Range::List { of, .. }) => of_templates(of),
        _ => None,
    };
    found.or_else(|| {
        let scene = find_scene(DEFAULT)?;
        number(
            Document::parse(scene.text, scene.name)
                .ok()?
                .value(field.path)?,
        )
    })
}
