//! Boundaries of vanishing adhesion as text, JSON and a table.

use super::report::{Json, Report};
use super::sheet::Sheet;
use crate::io::{Kind, Table};
use crate::scene::RoughnessParameter;
use crate::study::{Boundaries, Boundary, Crossing, DEFINITIONS, protocol_name};
use serde_json::{Map, Value, json};

/// Columns of a boundary in a parameter, each with its factor.
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
            let (value, interval, cycles) = match *crossing {
                Crossing::At(value, interval) => (
                    format!("{value:.2}"),
                    interval.map_or_else(String::new, |(low, high)| format!("{low:.2} to {high:.2}")),
                    format!("{:.2}", DEFINITIONS[1].1 * value),
                ),
                Crossing::Below(smallest) => (format!("< {smallest:.2}"), String::new(), String::new()),
                Crossing::Above(largest) => (format!("> {largest:.2}"), String::new(), String::new()),
            };
            let mut row: Vec<String> = others.iter().map(ToString::to_string).collect();
            row.extend([protocol_name(*protocol).to_owned(), level.to_string(), value, interval]);
            row.extend(is_kappa.then_some(cycles));
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
            match boundary.crossing {
                Crossing::At(value, interval) => {
                    columns(self.over).iter().for_each(|(name, factor)| set(name, json!(factor * value)));
                    set("confidence_interval", json!(interval.map(|(low, high)| [low, high])));
                }
                Crossing::Below(smallest) => set("below", json!(smallest)),
                Crossing::Above(largest) => set("above", json!(largest)),
            }
            Value::Object(object)
        };
        let found: Vec<Value> = self.found.iter().map(object).collect();
        Some(Box::new(json!({ "lines": self.lines, "boundaries": found })))
    }

    fn table(&self) -> Option<Table<'_>> {
        let at = |boundary: &Boundary| match boundary.crossing {
            Crossing::At(value, interval) => Some((value, interval)),
            _ => None,
        };
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
            table = table.real(name, move |one| at(one).map(|(value, _)| factor * value));
        }
        table = table
            .real("low", move |one| Some(at(one)?.1?.0))
            .real("high", move |one| Some(at(one)?.1?.1))
            .real("below", |one| match one.crossing {
                Crossing::Below(smallest) => Some(smallest),
                _ => None,
            })
            .real("above", |one| match one.crossing {
                Crossing::Above(largest) => Some(largest),
                _ => None,
            });
        Some(table.done())
    }
}
