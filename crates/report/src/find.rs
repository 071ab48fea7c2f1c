//! The number at which a quantity reaches a target, as text, JSON and a table.

use crate::ensemble::{profiles_named, rounded};
use crate::report::{Json, Report};
use crate::sensitivity::others_stay;
use crate::sheet::Sheet;
use crate::warnings::{warning_texts, warnings_section};
use asperity_data::{
    Kind, Table, Warning, format_quantity, format_range, format_rounded, grouped, object, one_unit,
};
use asperity_scene::Scene;
use asperity_study::{Answer, Ensemble, Found};

/// Largest number of listed profiles with several crossings. Further ones are counted.
const MOST_LISTED: usize = 8;

/// Report on a search in a scene: which value of a number, such as the preload, gives a wanted value of a result, such as the
/// adhesion force.
#[derive(Clone, Copy, Debug)]
pub struct FindReport<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Scene in which the number is varied.
    pub scene: &'a Scene,
    /// Values of the number at which the result reaches the wanted value, on each profile.
    pub found: &'a Found,
    /// Premises of the model that the scene with the median answer does not meet.
    pub warnings: &'a [Warning],
}

/// Returns the answer of a search in one sentence. It has the median and the quartiles, over the profiles, of the number at which
/// the result reaches the wanted value.
pub fn found_in_words(found: &Found) -> String {
    let question = &found.question;
    let (axis, count) = (&question.axis, found.answers.len());
    let (name, quantity) = (axis.symbol_or_name(), question.quantity.symbol_or_name());
    let (target, searched) = (target_in_words(found), format_range(question.searched, 4, axis.unit));
    let reachable = found.reachable().map_or_else(String::new, |ends| values_in_words(found, ends));
    let numbers = |ends: (f64, f64)| format_range(ends, 3, axis.unit);
    let everywhere = |answer: &&Answer| answer.crossings.is_empty() && answer.reached == [true; 2];
    let reached = found.answers.iter().filter(everywhere).count();
    let met = found.values().iter().flatten().count();
    if reached == count {
        let any = if question.is_of_preload() { "preload" } else { name };
        let touch = at_touch_in_words(found);
        return format!(
            "{target} is reached at any {any} from {searched}{touch}: {quantity} is {reachable}."
        );
    }
    if met + reached == 0 {
        return format!("{target} is never reached with {name} from {searched}: {quantity} is {reachable}.");
    }
    match [0.25, 0.5, 0.75].map(|share| found.quantile(share)) {
        [_, Some(median), _] if count == 1 => {
            format!("{name} = {} for {target}.", format_quantity(median, axis.unit))
        }
        [low, Some(median), high] => {
            let quartile = |end: Option<f64>| end.map(|end| numbers((end, end)));
            let quartiles = match (low.zip(high), quartile(low), quartile(high)) {
                (Some(both), ..) => format!("quartiles {}", numbers(both)),
                (None, Some(low), _) => {
                    format!("lower quartile {low}, the upper one beyond the searched range")
                }
                (None, _, Some(high)) => {
                    format!("upper quartile {high}, the lower one beyond the searched range")
                }
                (None, None, None) => "both quartiles beyond the searched range".to_owned(),
            };
            let median = format_quantity(median, axis.unit);
            format!("{name} = {median} for {target}: median of {count} profiles, {quartiles}.")
        }
        [_, None, _] if met == 0 => {
            format!(
                "{target} is crossed on no profile with {name} from {searched}: {quantity} is {reachable}."
            )
        }
        [_, None, _] => {
            let range = found.range().map_or_else(String::new, |ends| format!(", at {}", numbers(ends)));
            format!(
                "{target} is crossed on {met} of {count} profiles with {name} from {searched}{range}, which is too few for a \
                 median: {quantity} is {reachable}."
            )
        }
    }
}

/// Returns words on the profiles that reach the target without a preload.
fn at_touch_in_words(found: &Found) -> String {
    match found.answers.iter().filter(|answer| answer.at_touch).count() {
        0 => String::new(),
        touch if touch == found.answers.len() => ", and also turned at first touch".to_owned(),
        touch => {
            format!(", and on {touch} of {} profiles also turned at first touch", found.answers.len())
        }
    }
}

/// Returns the target in words: `F_a/F_a,max = 80 %`.
fn target_in_words(found: &Found) -> String {
    let quantity = found.question.quantity;
    format!("{} = {}", quantity.symbol_or_name(), rounded(quantity, found.question.target, 4))
}

/// Returns the range of possible values of the quantity in words.
fn values_in_words(found: &Found, (least, most): (f64, f64)) -> String {
    one_unit([least, most].map(|value| rounded(found.question.quantity, value, 4)))
}

impl FindReport<'_> {
    /// Returns sentences on the profiles whose answer is not a single number.
    fn exceptions(&self) -> Vec<String> {
        let (found, question) = (self.found, &self.found.question);
        let (name, quantity) = (question.axis.symbol_or_name(), question.quantity.symbol_or_name());
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
        if question.is_of_preload() {
            let least = format_quantity(question.searched.0, question.axis.unit);
            let enough = of_profiles(&|answer| answer.reached[0]);
            sentences.extend(enough.map(|on| format!("{on} {least} is enough, and counts.")));
            let touch = of_profiles(&|answer| answer.at_touch);
            sentences.extend(touch.map(|on| format!("{on} first touch is enough.")));
        } else {
            let larger = of_profiles(&|answer| is_free(answer) && answer.reached == [true; 2]);
            sentences
                .extend(larger.map(|on| format!("{on} {quantity} is larger at any {name} of the range.")));
        }
        let never = |answer: &Answer| is_free(answer) && answer.reached == [false; 2];
        let most = found.answers.iter().filter(|answer| never(answer)).filter_map(|answer| answer.reachable);
        if let (Some(on), Some(most)) = (of_profiles(&never), most.map(|ends| ends.1).reduce(f64::max)) {
            let most = values_in_words(found, (most, most));
            sentences.push(format!("{on} {quantity} never reaches that value: it is at most {most}."));
        }
        sentences
    }

    /// Returns rows of the profiles whose quantity crosses the target more than once, or falls below it again.
    fn several(&self) -> Vec<(String, String)> {
        let unit = self.found.question.axis.unit;
        let several = self.found.answers.iter().filter(|answer| answer.crossings.len() > 1);
        let row = |answer: &Answer| {
            let all: Vec<String> =
                answer.crossings.iter().map(|number| format_rounded(*number, 3, unit)).collect();
            let seed = answer.seed.map_or("this profile".to_owned(), |seed| format!("seed {seed}"));
            (seed, all.join(", "))
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
        self.exceptions().iter().for_each(|sentence| sheet.paragraph(sentence));
        warnings_section(&mut sheet, self.warnings);
        let several = self.several();
        if !several.is_empty() {
            sheet.heading("Several crossings, of which the first counts");
            several.iter().take(MOST_LISTED).for_each(|(seed, all)| sheet.row(seed, all));
            let more = several.len().saturating_sub(MOST_LISTED);
            sheet.row_of("and more", (more > 0).then(|| format!("{} profiles", grouped(more as u64))));
        }
        let refused =
            found.refused.as_ref().map(|why| format!(" Not all of these numbers are allowed: {why}."));
        let searched =
            format!("Searched: {} from {}.", axis.name, format_range(question.searched, 4, axis.unit));
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
            others_stay(self.scene.adhesion.filter(|_| !axis.path.starts_with("adhesion.")))
        };
        sheet.heading(&format!("{searched}{} {others} {profiles}", refused.unwrap_or_default()));
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let (found, question) = (self.found, &self.found.question);
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| found.quantile(share));
        Some(Box::new(object! {
            "scene": self.scene,
            "warnings": warning_texts(self.warnings),
            "field": &question.axis.path,
            "unit": question.axis.unit,
            "quantity": question.quantity,
            "value": question.target,
            "profiles": question.profiles(),
            "median": median,
            "quartiles": [low, high],
            "range": found.range(),
            "values": found.values(),
            "crossings": found.answers.iter().map(|answer| answer.crossings.len()).collect::<Vec<_>>(),
            "all_crossings": found.answers.iter().map(|answer| &answer.crossings).collect::<Vec<_>>(),
            "at_first_touch": question.is_of_preload().then(|| found.answers.iter().filter(|answer| answer.at_touch).count()),
            "reachable": found.reachable(),
            "searched": question.searched,
            "answer": found_in_words(found),
        }))
    }

    /// Returns a table with a row for each profile: the number that was found, how often the result crosses the wanted value
    /// in the searched range, and the smallest and largest result in this range.
    fn table(&self) -> Option<Table<'_>> {
        let values = self.found.values();
        let rows = move || self.found.answers.iter().zip(values.clone());
        let mut table = Table::of(rows);
        if self.found.answers.iter().all(|answer| answer.seed.is_some()) {
            table = table.whole("seed", |(answer, _)| answer.seed.unwrap_or_default());
        }
        let table = table
            .with(self.found.question.axis.path.clone(), Kind::Real, |(_, value)| *value)
            .whole("crossings", |(answer, _)| answer.crossings.len() as u64)
            .real("least", |(answer, _)| answer.reachable.map(|ends| ends.0))
            .real("most", |(answer, _)| answer.reachable.map(|ends| ends.1));
        Some(table.done())
    }
}
