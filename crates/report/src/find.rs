//! The number at which a quantity reaches a target, as text, JSON and a table.

use crate::ensemble::{profiles_named, rounded};
use crate::report::{Json, Report};
use crate::sensitivity::others_stay;
use crate::sheet::Sheet;
use crate::warnings::{counted_section, counted_texts};
use asperity_data::{
    Kind, Table, format_quantity, format_range, format_rounded, grouped, object, one_unit,
};
use asperity_scene::Scene;
use asperity_study::{Answer, Ensemble, Found};

/// Largest number of listed profiles with several crossings. Further ones are counted.
const MOST_LISTED: usize = 8;

/// Report on a search in a scene: which value of a number, such as the preload, gives a wanted
/// value of a result, such as the adhesion force.
#[derive(Clone, Copy, Debug)]
pub struct FindReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene in which the number is varied.
    pub scene: &'a Scene,
    /// Values of the number at which the result reaches the wanted value, on each profile.
    pub found: &'a Found,
}

/// Returns the answer of a search in one or two sentences. They have the median and the quartiles,
/// over the profiles, of the number at which the result reaches the wanted value, and state how
/// many profiles have no such number and where a crossing may be missed.
pub fn found_in_words(found: &Found) -> String {
    let question = &found.question;
    let count = found.answers.len();
    let (name, quantity) = (
        question.axis.symbol_or_name(),
        question.quantity.symbol_or_name(),
    );
    let (target, searched) = (
        target_in_words(found),
        format_range(question.searched, 4, question.axis.unit),
    );
    let reachable = found
        .reachable()
        .map_or_else(String::new, |ends| values_in_words(found, ends));
    let is_enough = |answer: &Answer| answer.crossings.is_empty() && answer.reached == [true; 2];
    if question.seeks_least_preload() && found.answers.iter().all(is_enough) {
        let touch = at_touch_in_words(found);
        return format!(
            "{target} is reached at any preload from {searched}{touch}: {quantity} is {reachable}."
        );
    }
    let with_value = count - found.unreached();
    if with_value == 0 {
        let never = never_in_words(found);
        let missed = missed_in_words(found).map_or_else(String::new, |missed| format!(" {missed}"));
        return format!(
            "{target} is {never} with {name} from {searched}: {quantity} is {reachable}.{missed}"
        );
    }
    let Some(median) = found.quantile(0.5) else {
        let range = found.range().map_or_else(String::new, |ends| {
            format!(", at {}", format_range(ends, 3, question.axis.unit))
        });
        return format!(
            "{target} is reached on {with_value} of {count} profiles with {name} from {searched}{range}, which is too few \
             for a median: {quantity} is {reachable}."
        );
    };
    let median = format_quantity(median, question.axis.unit);
    if count == 1 {
        let crossings = found.answers[0].crossings.len();
        let at_least = match (found.answers[0].may_miss, crossings) {
            (false, _) => String::new(),
            (true, 1) => ", the first of at least 1 crossing".to_owned(),
            (true, _) => format!(", the first of at least {crossings} crossings"),
        };
        return format!("{name} = {median} for {target}{at_least}.");
    }
    let mut beside = vec![quartiles_in_words(found)];
    if found.unreached() > 0 {
        beside.push(format!(
            "{} of {count} profiles without a value",
            found.unreached()
        ));
    }
    let beside = beside.join("; ");
    let missed = missed_in_words(found).map_or_else(String::new, |missed| format!(" {missed}"));
    format!("{name} = {median} ({beside}) for {target}: median of {count} profiles.{missed}")
}

/// Returns the quartiles in words: `quartiles 6.71 to 17.3 µN`.
fn quartiles_in_words(found: &Found) -> String {
    let unit = found.question.axis.unit;
    match [0.25, 0.75].map(|share| found.quantile(share)) {
        [Some(low), Some(high)] => format!("quartiles {}", format_range((low, high), 3, unit)),
        [Some(low), None] => {
            format!(
                "lower quartile {}, the upper one beyond the searched range",
                format_rounded(low, 3, unit)
            )
        }
        [None, Some(high)] => {
            format!(
                "upper quartile {}, the lower one beyond the searched range",
                format_rounded(high, 3, unit)
            )
        }
        [None, None] => "both quartiles beyond the searched range".to_owned(),
    }
}

/// Returns words for a target without a crossing on any profile.
fn never_in_words(found: &Found) -> &'static str {
    let is_proven = found
        .answers
        .iter()
        .all(|answer| answer.is_proven && !answer.may_miss);
    if is_proven {
        "never reached"
    } else {
        "reached at none of the computed values"
    }
}

/// Returns a sentence on the profiles on which a crossing may be missed; `None` without such a
/// profile.
fn missed_in_words(found: &Found) -> Option<String> {
    let count = found
        .answers
        .iter()
        .filter(|answer| answer.may_miss)
        .count();
    let all = found.answers.len();
    match (count, all) {
        (0, _) => None,
        (_, 1) => Some("Crossings may be missed.".to_owned()),
        _ => Some(format!(
            "On {count} of {all} profiles crossings may be missed."
        )),
    }
}

/// Returns words on the profiles that reach the target without a preload.
fn at_touch_in_words(found: &Found) -> String {
    match found
        .answers
        .iter()
        .filter(|answer| answer.at_touch)
        .count()
    {
        0 => String::new(),
        touch if touch == found.answers.len() => ", and also turned at first touch".to_owned(),
        touch => {
            format!(
                ", and on {touch} of {} profiles also turned at first touch",
                found.answers.len()
            )
        }
    }
}

/// Returns the target in words: `F_a/F_a,max = 80 %`.
fn target_in_words(found: &Found) -> String {
    let quantity = found.question.quantity;
    format!(
        "{} = {}",
        quantity.symbol_or_name(),
        rounded(quantity, found.question.target, 4)
    )
}

/// Returns the range of possible values of the quantity in words.
fn values_in_words(found: &Found, (least, most): (f64, f64)) -> String {
    one_unit([least, most].map(|value| rounded(found.question.quantity, value, 4)))
}

/// Returns words on the numbers at which the quantity was computed. They are empty if the crossings
/// follow from a proof.
fn computed_in_words(found: &Found) -> String {
    let waves = if found.question.is_of_whole_waves() {
        ", only where a whole number of waves fits on the length"
    } else {
        ""
    };
    let mut tried: Vec<u64> = Vec::new();
    for answer in &found.answers {
        if !answer.is_proven {
            tried.push(answer.tried);
        }
    }
    let (Some(least), Some(most)) = (tried.iter().min(), tried.iter().max()) else {
        return waves.to_owned();
    };
    let count = if least == most {
        grouped(*most)
    } else {
        format!("{} to {}", grouped(*least), grouped(*most))
    };
    let each = if found.answers.len() > 1 {
        " on each profile"
    } else {
        ""
    };
    format!(", computed at {count} values{each}{waves}")
}

impl FindReport<'_> {
    /// Returns sentences on the profiles whose answer is not a single number.
    fn exceptions(&self) -> Vec<String> {
        let (found, question) = (self.found, &self.found.question);
        let (name, quantity) = (
            question.axis.symbol_or_name(),
            question.quantity.symbol_or_name(),
        );
        let all = found.answers.len();
        let of_profiles = |is: &dyn Fn(&Answer) -> bool| {
            let count = found.answers.iter().filter(|answer| is(answer)).count();
            (count > 0 && all > 1).then(|| format!("On {count} of {all} profiles"))
        };
        let is_free = |answer: &Answer| answer.crossings.is_empty();
        let mut sentences = Vec::new();
        let alike = |answer: &Answer| is_free(answer) && answer.reached == found.answers[0].reached;
        if found.answers.iter().all(alike) {
            // The answer itself says so.
            return sentences;
        }
        if question.seeks_least_preload() {
            let least = format_quantity(question.searched.0, question.axis.unit);
            let enough = of_profiles(&|answer| answer.reached[0]);
            sentences.extend(enough.map(|on| format!("{on} {least} is enough, and counts.")));
            let touch = of_profiles(&|answer| answer.at_touch);
            sentences.extend(touch.map(|on| format!("{on} first touch is enough.")));
        } else {
            let larger = of_profiles(&|answer| is_free(answer) && answer.reached == [true; 2]);
            sentences.extend(
                larger.map(|on| format!("{on} {quantity} is larger at any {name} of the range.")),
            );
        }
        let never = |answer: &Answer| is_free(answer) && answer.reached == [false; 2];
        let most = found
            .answers
            .iter()
            .filter(|answer| never(answer))
            .filter_map(|answer| answer.reachable);
        if let (Some(on), Some(most)) = (
            of_profiles(&never),
            most.map(|ends| ends.1).reduce(f64::max),
        ) {
            let most = values_in_words(found, (most, most));
            sentences.push(format!(
                "{on} {quantity} never reaches that value: it is at most {most}."
            ));
        }
        sentences
    }

    /// Returns rows of the profiles whose quantity crosses the target more than once, or falls
    /// below it again.
    fn several(&self) -> Vec<(String, String)> {
        let unit = self.found.question.axis.unit;
        let several = self
            .found
            .answers
            .iter()
            .filter(|answer| answer.crossings.len() > 1);
        let row = |answer: &Answer| {
            let numbers: Vec<String> = answer
                .crossings
                .iter()
                .map(|number| format_rounded(*number, 3, unit))
                .collect();
            let at_least = if answer.may_miss {
                format!("at least {}: ", numbers.len())
            } else {
                String::new()
            };
            let seed = answer
                .seed
                .map_or("this profile".to_owned(), |seed| format!("seed {seed}"));
            (seed, format!("{at_least}{}", numbers.join(", ")))
        };
        several.map(row).collect()
    }
}

impl Report for FindReport<'_> {
    fn text(&self) -> Option<String> {
        let (found, question) = (self.found, &self.found.question);
        let axis = &question.axis;
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&found_in_words(found));
        self.exceptions()
            .iter()
            .for_each(|sentence| sheet.paragraph(sentence));
        counted_section(
            &mut sheet,
            &self.found.warnings,
            self.found.question.profiles(),
        );
        let several = self.several();
        if !several.is_empty() {
            sheet.heading("Several crossings, of which the first counts");
            several
                .iter()
                .take(MOST_LISTED)
                .for_each(|(seed, all)| sheet.row(seed, all));
            let more = several.len().saturating_sub(MOST_LISTED);
            sheet.row_of(
                "and more",
                (more > 0).then(|| format!("{} profiles", grouped(more as u64))),
            );
        }
        let refused = found
            .refused
            .as_ref()
            .map(|why| format!(" Not all of these numbers are allowed: {why}."));
        let searched = format!(
            "Searched: {} from {}{}.",
            axis.name,
            format_range(question.searched, 4, axis.unit),
            computed_in_words(found)
        );
        let profiles = match found.answers.first().and_then(|answer| answer.seed) {
            Some(first) => format!(
                "{}, {} springs.",
                profiles_named(question.profiles(), first),
                grouped(self.scene.numerics.points)
            ),
            None => Ensemble::FIXED.to_owned(),
        };
        let others = if question.is_of_preload() {
            "The preload replaces the loading of the scene.".to_owned()
        } else {
            others_stay(
                self.scene
                    .adhesion
                    .filter(|_| !axis.path.starts_with("adhesion.")),
            )
        };
        sheet.heading(&format!(
            "{searched}{} {others} {profiles}",
            refused.unwrap_or_default()
        ));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let (found, question) = (self.found, &self.found.question);
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| found.quantile(share));
        Some(Box::new(object! {
            "scene": self.scene,
            "warnings": counted_texts(&self.found.warnings, self.found.question.profiles()),
            "field": &question.axis.path,
            "unit": question.axis.unit,
            "quantity": question.quantity,
            "target": question.target,
            "value": median,
            "profiles": question.profiles(),
            "unreached": found.unreached(),
            "quartiles": [low, high],
            "range": found.range(),
            "values": found.values(),
            "crossings": found.answers.iter().map(|answer| answer.crossings.len()).collect::<Vec<_>>(),
            "at_least": found.answers.iter().map(|answer| answer.may_miss).collect::<Vec<_>>(),
            "all_crossings": found.answers.iter().map(|answer| &answer.crossings).collect::<Vec<_>>(),
            "at_first_touch": question.is_of_preload().then(|| found.answers.iter().filter(|answer| answer.at_touch).count()),
            "reachable": found.reachable(),
            "searched": question.searched,
            "answer": found_in_words(found),
        }))
    }

    /// Returns a table with a row for each profile: the number that was found, how often the result
    /// crosses the wanted value in the searched range, 1 if it may cross it more often and
    /// otherwise 0, and the smallest and largest result in this range.
    fn table(&self) -> Option<Table<'_>> {
        let values = self.found.values();
        let rows = move || self.found.answers.iter().zip(values.clone());
        let mut table = Table::of(rows);
        if self
            .found
            .answers
            .iter()
            .all(|answer| answer.seed.is_some())
        {
            table = table.whole("seed", |(answer, _)| answer.seed.unwrap_or_default());
        }
        let table = table
            .with(
                self.found.question.axis.path.clone(),
                Kind::Real,
                |(_, value)| *value,
            )
            .whole("crossings", |(answer, _)| answer.crossings.len() as u64)
            .whole("at_least", |(answer, _)| u64::from(answer.may_miss))
            .real("least", |(answer, _)| answer.reachable.map(|ends| ends.0))
            .real("most", |(answer, _)| answer.reachable.map(|ends| ends.1));
        Some(table.done())
    }
}
