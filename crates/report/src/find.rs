//! Answers to an inverse question (at which number does a quantity reach a target?) as text, JSON
//! and a table.

use crate::ensemble::{profiles_named, rounded};
use crate::report::{Json, Report};
use crate::sensitivity::others_stay;
use crate::sheet::Sheet;
use crate::warnings::{counted_texts, sentences_section};
use asperity_data::{
    Kind, Table, counted, format_quantity, format_range, format_rounded, grouped, one_unit,
};
use asperity_scene::Scene;
use asperity_study::{Answer, Ensemble, Found, Quantity};
use serde::Serialize;

/// Largest number of profiles with several crossings that the report lists. Of the others, the
/// report states only the number.
const MOST_LISTED: usize = 8;

/// Report on a search for the value of one number of a scene, such as the preload, with which a
/// result, such as the pull-off force, has a wanted value.
#[derive(Clone, Copy, Debug)]
pub struct FindReport<'a> {
    pub title: &'a str,
    /// Scene, one number of which, such as the preload, is varied in the search.
    pub scene: &'a Scene,
    /// Answers of the search: for each profile, the values of the varied number with which the
    /// result has the wanted value.
    pub found: &'a Found,
}

/// Returns the answer of a search in one or two sentences. The answer of a profile is the value of
/// the varied number with which the result reaches the wanted value. The sentences state the median
/// and the quartiles of the answers over the profiles, how many profiles have no answer, and where
/// the search may have missed one.
pub fn found_in_words(found: &Found) -> String {
    let words = SearchWords::new(found);
    let reaches_always = found.answers.iter().all(reaches_everywhere);
    if found.question.seeks_least_preload() && reaches_always {
        return words.at_any_preload(found);
    }
    let with_value = found.answers.len() - found.unreached();
    if with_value == 0 {
        return words.nowhere(found);
    }
    let Some(median) = found.quantile(0.5) else {
        return words.on_too_few(found, with_value);
    };
    let median = format_quantity(median, found.question.axis.unit);
    match &found.answers[..] {
        [answer] => words.on_one(answer, &median),
        _ => words.on_several(found, &median),
    }
}

/// Part of an answer in few words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerPart {
    pub text: String,
    /// Further words for a text that has more room; empty if there are none.
    pub detail: String,
}

impl AnswerPart {
    fn new(text: String, detail: String) -> Self {
        AnswerPart { text, detail }
    }
}

/// Returns the answer of a search in few words, the most important part first. The first part is
/// the median over the profiles with the quartiles, such as `12.44 µN (6.71 to 17.3)`. The next
/// part is the number of profiles without an answer.
pub fn found_briefly(found: &Found) -> Vec<AnswerPart> {
    let words = SearchWords::new(found);
    let count = found.answers.len();
    let with_value = count - found.unreached();
    let anywhere = profiles_with_any_value(found);
    let name = &words.name;
    let searched = format!("searched: {name} {}", words.searched);
    let values = format!("{} {}", words.quantity, words.reachable);
    let mut parts = Vec::new();
    if anywhere == count && found.question.seeks_least_preload() {
        let text = format!("any {name} will do");
        return vec![AnswerPart::new(text, values)];
    }
    if anywhere == count {
        let text = format!("always above {}", words.target);
        return vec![AnswerPart::new(text, format!("{values}, {searched}"))];
    }
    match found.quantile(0.5) {
        _ if with_value == 0 && anywhere > 0 => {
            let among = among_profiles(found, anywhere);
            let text = format!("always above {}{among}", words.target);
            parts.push(AnswerPart::new(text, searched));
        }
        _ if with_value == 0 => {
            let text = format!("{} never", words.target);
            parts.push(AnswerPart::new(text, format!("{values}, {searched}")));
            if let Some(reason) = &found.refused {
                let text = format!("other values of {name} are not allowed");
                parts.push(AnswerPart::new(text, reason.clone()));
            }
            return parts;
        }
        None => {
            let range = found.range().unwrap_or_default();
            let range = format_range(range, 3, found.question.axis.unit);
            let text = format!("{range} on {with_value} of {count}, no median");
            parts.push(AnswerPart::new(text, searched));
        }
        Some(median) => parts.push(AnswerPart::new(median_briefly(found, median), searched)),
    }
    parts.extend(remarks_briefly(found, &words));
    parts
}

/// Returns what the answer of a search has beside its value: the steps there, and how many profiles
/// have any value, none, or crossings that may be missed.
fn remarks_briefly(found: &Found, words: &SearchWords) -> Vec<AnswerPart> {
    let mut parts = Vec::new();
    if let [
        Answer {
            step: Some(step), ..
        },
    ] = found.answers[..]
    {
        let [below, at] = step.map(|value| rounded(found.question.quantity, value, 3));
        let text = format!("there {} steps from {below} to {at}", words.quantity);
        parts.push(AnswerPart::new(text, String::new()));
    }
    let anywhere = profiles_with_any_value(found);
    if anywhere > 0 && found.unreached() < found.answers.len() {
        let any = format!("any {}{}", words.name, among_profiles(found, anywhere));
        parts.push(AnswerPart::new(any, String::new()));
    }
    let never = found.answers.iter().filter(|one| reaches_nowhere(one));
    let largest = never
        .clone()
        .filter_map(|one| one.reachable)
        .map(|(_, most)| most);
    if let Some(largest) = largest.reduce(f64::max) {
        let text = format!("never{}", among_profiles(found, never.count()));
        let most = values_in_words(found.question.quantity, (largest, largest));
        parts.push(AnswerPart::new(text, format!("at most {most}")));
    }
    let missed = found.answers.iter().filter(|one| one.may_miss).count();
    if missed > 0 {
        let text = format!("crossings may be missed{}", among_profiles(found, missed));
        parts.push(AnswerPart::new(text, String::new()));
    }
    parts
}

/// Returns the number of profiles on which any value has the wanted property.
fn profiles_with_any_value(found: &Found) -> usize {
    let anywhere = found
        .answers
        .iter()
        .filter(|answer| reaches_everywhere(answer));
    anywhere.count()
}

/// Returns how many of all profiles: ` on 3 of 16`; an empty text for a single profile.
fn among_profiles(found: &Found, number: usize) -> String {
    match found.answers.len() {
        1 => String::new(),
        count => format!(" on {number} of {count}"),
    }
}

/// Returns the median and, for several profiles, the quartiles: `12.44 µN (6.71 to 17.3)`. The unit
/// is written once, if it is the same.
fn median_briefly(found: &Found, median: f64) -> String {
    let unit = found.question.axis.unit;
    let median = format_quantity(median, unit);
    if found.answers.len() == 1 {
        return median;
    }
    let quartile = |share| match found.quantile(share) {
        Some(value) => format_rounded(value, 3, unit),
        None => "beyond".to_owned(),
    };
    let quartiles = one_unit([quartile(0.25), quartile(0.75)]);
    let unit = match median.split_once(' ') {
        Some((_, unit)) => format!(" {unit}"),
        None => String::new(),
    };
    let quartiles = quartiles.strip_suffix(&unit).unwrap_or(&quartiles);
    format!("{median} ({quartiles})")
}

/// Returns true if the quantity is larger than the target at all numbers of the searched range.
fn reaches_everywhere(answer: &Answer) -> bool {
    answer.crossings.is_empty() && answer.reached == [true; 2]
}

/// Returns true if the quantity is smaller than the target at all numbers of the searched range.
fn reaches_nowhere(answer: &Answer) -> bool {
    answer.crossings.is_empty() && answer.reached == [false; 2]
}

/// Words from which the sentences of an answer are composed.
struct SearchWords {
    /// The quantity that is to have the target value.
    of: Quantity,
    /// Name of the number that is sought, such as the preload.
    name: String,
    quantity: String,
    /// Wanted value of the quantity: `80 %`.
    wanted: String,
    /// The quantity with its wanted value: `F_a/F_a,max = 80 %`.
    target: String,
    /// Range of the searched numbers for which the answers hold.
    searched: String,
    /// Range of the values of the quantity in the searched range; empty if the quantity has no
    /// value there.
    reachable: String,
    /// Sentence on the profiles on which the search may have missed a crossing, with a blank before
    /// it; empty if there are no such profiles.
    missed: String,
}

impl SearchWords {
    fn new(found: &Found) -> Self {
        let question = &found.question;
        let quantity = question.quantity.symbol_or_name();
        let wanted = rounded(question.quantity, question.target, 4);
        SearchWords {
            of: question.quantity,
            name: question.axis.symbol_or_name().to_owned(),
            target: format!("{quantity} = {wanted}"),
            wanted,
            quantity: quantity.to_owned(),
            searched: format_range(found.answered_range(), 4, question.axis.unit),
            reachable: match found.reachable() {
                Some(ends) => values_in_words(question.quantity, ends),
                None => String::new(),
            },
            missed: missed_in_words(found),
        }
    }

    /// Returns the answer for the case that the target is reached at every preload of the searched
    /// range.
    fn at_any_preload(&self, found: &Found) -> String {
        let SearchWords {
            quantity,
            target,
            searched,
            reachable,
            ..
        } = self;
        let touch = at_touch_in_words(found);
        format!(
            "{target} is reached at any preload from {searched}{touch}: {quantity} is {reachable}."
        )
    }

    /// Returns the answer for the case that the quantity crosses the target on no profile.
    fn nowhere(&self, found: &Found) -> String {
        let SearchWords {
            name,
            quantity,
            wanted,
            target,
            searched,
            reachable,
            missed,
            ..
        } = self;
        let is_certain = |answer: &Answer| answer.is_proven && !answer.may_miss;
        let never = if found.answers.iter().all(is_certain) {
            "never reached"
        } else {
            "reached at none of the computed values"
        };
        let only = if found.refused.is_some() {
            ", beyond which the scene allows no value"
        } else {
            ""
        };
        let range = format!("{name} from {searched}{only}");
        if found.answers.iter().all(reaches_everywhere) {
            return format!(
                "{quantity} is always above {wanted} with {range}: it is {reachable}.{missed}"
            );
        }
        format!("{target} is {never} with {range}: {quantity} is {reachable}.{missed}")
    }

    /// Returns the answer for the case that the quantity reaches the target on less than half of
    /// the profiles.
    fn on_too_few(&self, found: &Found, with_value: usize) -> String {
        let SearchWords {
            name,
            quantity,
            target,
            searched,
            reachable,
            ..
        } = self;
        let count = found.answers.len();
        let range = match found.range() {
            Some(ends) => format!(", at {}", format_range(ends, 3, found.question.axis.unit)),
            None => String::new(),
        };
        format!(
            "{target} is reached on {with_value} of {count} profiles with {name} from {searched}{range}, which is too few \
             for a median: {quantity} is {reachable}."
        )
    }

    /// Returns the answer for a single profile.
    fn on_one(&self, answer: &Answer, value: &str) -> String {
        let SearchWords {
            name,
            quantity,
            target,
            ..
        } = self;
        let at_least = match (answer.may_miss, answer.crossings.len()) {
            (false, _) => String::new(),
            (true, 1) => ", the first of at least 1 crossing".to_owned(),
            (true, crossings) => format!(", the first of at least {crossings} crossings"),
        };
        let step = match answer.step {
            Some([below, at]) => format!(
                " There {quantity} steps from {} to {}.",
                rounded(self.of, below, 3),
                rounded(self.of, at, 3)
            ),
            None => String::new(),
        };
        format!("{name} = {value} for {target}{at_least}.{step}")
    }

    /// Returns the answer for several profiles, of which at least half reach the target.
    fn on_several(&self, found: &Found, median: &str) -> String {
        let SearchWords {
            name,
            target,
            missed,
            ..
        } = self;
        let count = found.answers.len();
        let mut beside = quartiles_in_words(found);
        if found.unreached() > 0 {
            let unreached = found.unreached();
            beside += &format!("; {unreached} of {count} profiles without a value");
        }
        format!("{name} = {median} ({beside}) for {target}: median of {count} profiles.{missed}")
    }
}

/// Returns the quartiles in words: `quartiles 6.71 to 17.3 µN`.
fn quartiles_in_words(found: &Found) -> String {
    let unit = found.question.axis.unit;
    match (found.quantile(0.25), found.quantile(0.75)) {
        (Some(low), Some(high)) => format!("quartiles {}", format_range((low, high), 3, unit)),
        (Some(low), None) => {
            let low = format_rounded(low, 3, unit);
            format!("lower quartile {low}, the upper one beyond the searched range")
        }
        (None, Some(high)) => {
            let high = format_rounded(high, 3, unit);
            format!("upper quartile {high}, the lower one beyond the searched range")
        }
        (None, None) => "both quartiles beyond the searched range".to_owned(),
    }
}

/// Returns a sentence on the profiles on which the search may have missed a crossing, with a blank
/// before it; empty if there are no such profiles.
fn missed_in_words(found: &Found) -> String {
    let answers = found.answers.iter();
    let count = answers.filter(|answer| answer.may_miss).count();
    let profiles = found.answers.len();
    if count == 0 {
        String::new()
    } else if profiles == 1 {
        " Crossings may be missed.".to_owned()
    } else {
        format!(" On {count} of {profiles} profiles crossings may be missed.")
    }
}

/// Returns words on the profiles that reach the target without a preload.
fn at_touch_in_words(found: &Found) -> String {
    let answers = found.answers.iter();
    let count = answers.filter(|answer| answer.at_touch).count();
    let profiles = found.answers.len();
    if count == 0 {
        String::new()
    } else if count == profiles {
        ", and also turned at first touch".to_owned()
    } else {
        format!(", and on {count} of {profiles} profiles also turned at first touch")
    }
}

/// Returns a range of values of a quantity in words.
fn values_in_words(quantity: Quantity, range: (f64, f64)) -> String {
    let (least, most) = range;
    one_unit([least, most].map(|value| rounded(quantity, value, 4)))
}

/// Returns words on the numbers at which the quantity was computed. They are left out for a profile
/// on which a proof, and not a trial of numbers, gives the crossings.
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
    let (Some(&least), Some(&most)) = (tried.iter().min(), tried.iter().max()) else {
        return waves.to_owned();
    };
    let count = if least == most {
        grouped(most)
    } else {
        format!("{} to {}", grouped(least), grouped(most))
    };
    let each = if found.answers.len() > 1 {
        " on each profile"
    } else {
        ""
    };
    format!(", computed at {count} values{each}{waves}")
}

impl FindReport<'_> {
    /// Returns words such as `On 3 of 16 profiles`, where 3 is the number of profiles whose answers
    /// have a property. Returns `None` if no answer has the property, or if there is only one
    /// profile.
    fn on_profiles(&self, has_property: impl Fn(&Answer) -> bool) -> Option<String> {
        let answers = self.found.answers.iter();
        let count = answers.filter(|answer| has_property(answer)).count();
        let profiles = self.found.answers.len();
        if count == 0 || profiles == 1 {
            return None;
        }
        Some(format!("On {count} of {profiles} profiles"))
    }

    /// Returns sentences on the profiles whose answers are not a single number.
    fn exceptions(&self) -> Vec<String> {
        let answers = &self.found.answers;
        let is_like_first =
            |answer: &Answer| answer.crossings.is_empty() && answer.reached == answers[0].reached;
        if answers.iter().all(is_like_first) {
            // If the answers on all profiles are alike, the main sentence already states this.
            return Vec::new();
        }
        let question = &self.found.question;
        let name = question.axis.symbol_or_name();
        let quantity = question.quantity.symbol_or_name();
        let mut sentences = Vec::new();
        if question.seeks_least_preload() {
            if let Some(on_profiles) = self.on_profiles(|answer| answer.reached[0]) {
                let least = format_quantity(question.searched.0, question.axis.unit);
                sentences.push(format!("{on_profiles} {least} is enough, and counts."));
            }
            if let Some(on_profiles) = self.on_profiles(|answer| answer.at_touch) {
                sentences.push(format!("{on_profiles} first touch is enough."));
            }
        } else if let Some(on_profiles) = self.on_profiles(reaches_everywhere) {
            sentences.push(format!(
                "{on_profiles} {quantity} is larger at any {name} of the range."
            ));
        }
        if let Some(on_profiles) = self.on_profiles(|answer| answer.step.is_some()) {
            sentences.push(format!(
                "{on_profiles} {quantity} steps over that value there."
            ));
        }
        let never = answers.iter().filter(|answer| reaches_nowhere(answer));
        let largest = never
            .filter_map(|answer| answer.reachable)
            .map(|(_, most)| most)
            .reduce(f64::max);
        if let Some(on_profiles) = self.on_profiles(reaches_nowhere)
            && let Some(largest) = largest
        {
            let most = values_in_words(question.quantity, (largest, largest));
            sentences.push(format!(
                "{on_profiles} {quantity} never reaches that value: it is at most {most}."
            ));
        }
        sentences
    }

    /// Adds the profiles on which the quantity crosses the target more than once, upwards or
    /// downwards. Adds nothing if there are no such profiles.
    fn add_several_crossings(&self, sheet: &mut Sheet) {
        let answers = self.found.answers.iter();
        let several: Vec<&Answer> = answers
            .filter(|answer| answer.crossings.len() > 1)
            .collect();
        if several.is_empty() {
            return;
        }
        sheet.heading("Several crossings, of which the first counts");
        for answer in several.iter().take(MOST_LISTED) {
            let profile = match answer.seed {
                Some(seed) => format!("seed {seed}"),
                None => "this profile".to_owned(),
            };
            sheet.row(&profile, self.crossings_in_words(answer));
        }
        if several.len() > MOST_LISTED {
            let more = grouped((several.len() - MOST_LISTED) as u64);
            sheet.row("and more", format!("{more} profiles"));
        }
    }

    /// Returns a text with all answers of the search on a profile: `at least 2: 1.2 µN, 3.4 µN`.
    fn crossings_in_words(&self, answer: &Answer) -> String {
        let unit = self.found.question.axis.unit;
        let numbers: Vec<String> = answer
            .crossings
            .iter()
            .map(|number| format_rounded(*number, 3, unit))
            .collect();
        let all = numbers.join(", ");
        if answer.may_miss {
            format!("at least {}: {all}", numbers.len())
        } else {
            all
        }
    }

    /// Returns sentences on the searched range, on the numbers that stay constant, and on the
    /// profiles.
    fn conditions(&self) -> String {
        let found = self.found;
        let question = &found.question;
        let axis = &question.axis;
        let name = &axis.name;
        let range = format_range(question.searched, 4, axis.unit);
        let computed = computed_in_words(found);
        let refused = match &found.refused {
            Some(reason) => format!(" Not all of these numbers are allowed: {reason}."),
            None => String::new(),
        };
        let others = if question.is_of_preload() {
            "The preload replaces the loading of the scene.".to_owned()
        } else if axis.path.starts_with("adhesion.") {
            others_stay(None)
        } else {
            others_stay(self.scene.adhesion)
        };
        let profiles = match found.answers.first().and_then(|answer| answer.seed) {
            Some(first) => {
                let profiles = profiles_named(question.profiles(), first);
                let springs = counted(self.scene.numerics.points, "spring");
                format!("{profiles}, {springs}.")
            }
            None => Ensemble::FIXED.to_owned(),
        };
        format!("Searched: {name} from {range}{computed}.{refused} {others} {profiles}")
    }
}

impl Report for FindReport<'_> {
    fn warnings(&self) -> Vec<String> {
        counted_texts(&self.found.warnings, self.found.question.profiles())
    }

    fn text(&self) -> Option<String> {
        let mut sheet = Sheet::default();
        sheet.paragraph(self.title);
        sheet.heading(&found_in_words(self.found));
        for sentence in self.exceptions() {
            sheet.paragraph(&sentence);
        }
        sentences_section(&mut sheet, &self.warnings());
        self.add_several_crossings(&mut sheet);
        sheet.heading(&self.conditions());
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(FindJson::new(self.scene, self.found)))
    }

    /// Returns a table with a row for each profile. Its columns are the number that was found, how
    /// often the result crosses the wanted value in the searched range, 1 if the search may have
    /// missed further crossings and otherwise 0, and the smallest and the largest result in this
    /// range.
    fn table(&self) -> Option<Table<'_>> {
        let answers = &self.found.answers;
        let values = self.found.values();
        let mut table = Table::of(move || answers.iter().zip(values.clone()));
        if answers.iter().all(|answer| answer.seed.is_some()) {
            table = table.whole("seed", |(answer, _)| answer.seed.unwrap_or_default());
        }
        let path = self.found.question.axis.path.clone();
        let table = table
            .with(path, Kind::Real, |(_, value)| *value)
            .whole("crossings", |(answer, _)| answer.crossings.len() as u64)
            .whole("at_least", |(answer, _)| u64::from(answer.may_miss))
            .real("least", |(answer, _)| answer.reachable.map(|ends| ends.0))
            .real("most", |(answer, _)| answer.reachable.map(|ends| ends.1));
        Some(table.done())
    }
}

/// JSON object of the answer to an inverse question, in SI units. Each list has an entry for each
/// profile.
#[derive(Serialize)]
struct FindJson<'a> {
    scene: &'a Scene,
    warnings: Vec<String>,
    field: &'a str,
    unit: &'static str,
    quantity: Quantity,
    target: f64,
    /// Median over the profiles of the number that was sought.
    value: Option<f64>,
    profiles: u64,
    unreached: usize,
    quartiles: [Option<f64>; 2],
    range: Option<(f64, f64)>,
    values: Vec<Option<f64>>,
    crossings: Vec<usize>,
    at_least: Vec<bool>,
    all_crossings: Vec<&'a [f64]>,
    /// Number of profiles that reach the target at first touch, without a preload; `None` if the
    /// sought number is not a preload.
    at_first_touch: Option<usize>,
    reachable: Option<(f64, f64)>,
    searched: (f64, f64),
    answer: String,
}

impl<'a> FindJson<'a> {
    fn new(scene: &'a Scene, found: &'a Found) -> Self {
        let question = &found.question;
        let mut crossings = Vec::new();
        let mut at_least = Vec::new();
        let mut all_crossings = Vec::new();
        let mut at_first_touch = 0;
        for answer in &found.answers {
            crossings.push(answer.crossings.len());
            at_least.push(answer.may_miss);
            all_crossings.push(answer.crossings.as_slice());
            at_first_touch += usize::from(answer.at_touch);
        }
        FindJson {
            scene,
            warnings: counted_texts(&found.warnings, question.profiles()),
            field: &question.axis.path,
            unit: question.axis.unit,
            quantity: question.quantity,
            target: question.target,
            value: found.quantile(0.5),
            profiles: question.profiles(),
            unreached: found.unreached(),
            quartiles: [0.25, 0.75].map(|share| found.quantile(share)),
            range: found.range(),
            values: found.values(),
            crossings,
            at_least,
            all_crossings,
            at_first_touch: question.is_of_preload().then_some(at_first_touch),
            reachable: found.reachable(),
            searched: question.searched,
            answer: found_in_words(found),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_data::Control;
    use asperity_scene::{Simulation, open};
    use asperity_study::Question;

    fn asked(condition: &str) -> Found {
        let fields = [
            ("length", "3.2e-4"),
            (
                "roughness",
                "SelfAffine(hurst: 0.75, rms_height: 8.0e-7, wavelengths: (8.0e-5, 1.6e-6), seed: 1)",
            ),
            ("numerics.points", "1024"),
        ];
        let fields = fields.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = open("pressure-sensitive")
            .unwrap()
            .set_all(&fields)
            .unwrap();
        let condition = Question::parse_condition(condition).unwrap();
        let simulation = &mut Simulation::default();
        let question = Question::new(document.scene(), "length", condition, 2, simulation).unwrap();
        Found::of(question, simulation, Control::default()).unwrap()
    }

    /// On longer profiles the springs carry no short waves. An answer holds only for the lengths
    /// that the scene allows.
    #[test]
    fn an_answer_holds_for_the_values_that_the_scene_allows() {
        let never = asked("F_a/F_a,max = 99.99 %");
        let (from, to) = never.answered_range();
        assert!(from >= 8e-5 && to <= 8.2e-4, "{from:e} to {to:e}");
        assert!(never.question.searched.1 > 1e-2);
        let words = found_in_words(&never);
        let range = format_range((from, to), 4, "m");
        let part = format!("with L from {range}, beyond which the scene allows no value: ");
        assert!(words.contains(&part), "{words}");
        let parts = found_briefly(&never);
        let limit = parts.last().unwrap();
        assert_eq!(limit.text, "other values of L are not allowed");
        assert!(limit.detail.contains("springs carry no shorter wave"));

        let always = found_in_words(&asked("F_a/F_a,max = 1e-6 %"));
        assert!(always.contains("is always above "), "{always}");
    }
}
