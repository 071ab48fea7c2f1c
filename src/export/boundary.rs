//! Boundaries of vanishing adhesion as text, JSON and a table.

use super::report::{Json, Report};
use super::sheet::Sheet;
use crate::io::{Kind, Table};
use crate::scene::RoughnessParameter;
use crate::study::{Boundaries, Boundary, Crossing, DEFINITIONS, protocol_name};
use serde_json::{Map, Value, json};
use std::cmp::Ordering;

fn columns(over: RoughnessParameter) -> Vec<(&'static str, f64)> {
    match over {
        RoughnessParameter::Kappa => DEFINITIONS.to_vec(),
        RoughnessParameter::ElasticEnergyRatio => vec![(over.name(), 1.0)],
    }
}

impl Report for Boundaries {
    fn text(&self) -> Option<String> {
        let is_kappa = self.over == RoughnessParameter::Kappa;
        let mut heading: Vec<String> = self.others.iter().map(|axis| axis.symbol_or_path()).collect();
        heading.extend(["protocol", "level", self.symbol(), "95 %"].map(String::from));
        heading.extend(is_kappa.then(|| "q in 1/m".into()));
        let mut rows = vec![heading];
        for Boundary { others, protocol, level, crossing } in &self.found {
            let Crossing { value, side, interval } = *crossing;
            let beyond = ["< ", "", "> "][(side as i8 + 1) as usize];
            let interval = interval.map_or_else(String::new, |(low, high)| format!("{low:.2} to {high:.2}"));
            let cycles = crossing.known().map(|(value, _)| format!("{:.2}", DEFINITIONS[1].1 * value));
            let mut row: Vec<String> = others.iter().map(ToString::to_string).collect();
            row.extend([
                protocol_name(*protocol).to_owned(),
                level.to_string(),
                format!("{beyond}{value:.2}"),
                interval,
            ]);
            row.extend(is_kappa.then(|| cycles.unwrap_or_default()));
            rows.push(row);
        }
        let mut sheet = Sheet::default();
        sheet.table(&rows);
        let paper = if is_kappa { "; the paper gives 0.6" } else { "" };
        sheet.paragraph(&format!("{} over {} random profiles{paper}.", self.symbol(), self.lines));
        Some(sheet.into_text())
    }

    /// A boundary outside the study has the end of the study in place of its value.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let object = |boundary: &Boundary| {
            let mut object = Map::new();
            let mut set = |name: &str, value: Value| drop(object.insert(name.to_owned(), value));
            for (axis, value) in self.others.iter().zip(&boundary.others) {
                set(&axis.symbol_or_path(), json!(value));
            }
            set("protocol", json!(protocol_name(boundary.protocol)));
            set("level", json!(boundary.level));
            let Crossing { value, side, interval } = boundary.crossing;
            match side {
                Ordering::Equal => {
                    columns(self.over).iter().for_each(|(name, factor)| set(name, json!(factor * value)));
                    set("confidence_interval", json!(interval));
                }
                Ordering::Less => set("below", json!(value)),
                Ordering::Greater => set("above", json!(value)),
            }
            Value::Object(object)
        };
        let found: Vec<Value> = self.found.iter().map(object).collect();
        Some(Box::new(json!({ "lines": self.lines, "boundaries": found })))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table = Table::of(|| self.found.iter());
        for (place, axis) in self.others.iter().enumerate() {
            table = match axis.is_whole() {
                true => table.with(axis.symbol_or_path(), Kind::Whole, move |one| one.others[place] as u64),
                false => table.with(axis.symbol_or_path(), Kind::Real, move |one| one.others[place]),
            };
        }
        table = table
            .with("protocol", Kind::Text("zero force".len()), |one| protocol_name(one.protocol))
            .real("level", |one| one.level);
        for (name, factor) in columns(self.over) {
            table = table.real(name, move |one| one.crossing.known().map(|(value, _)| factor * value));
        }
        let beyond = |one: &Boundary, side| (one.crossing.side == side).then_some(one.crossing.value);
        table = table
            .real("low", |one| Some(one.crossing.interval?.0))
            .real("high", |one| Some(one.crossing.interval?.1))
            .real("below", move |one| beyond(one, Ordering::Less))
            .real("above", move |one| beyond(one, Ordering::Greater));
        Some(table.done())
    }
}
