//! Boundaries where adhesion vanishes, as text, JSON and a table.

use crate::report::{Json, Report};
use crate::sheet::Sheet;
use asperity_data::{Kind, Table};
use asperity_scene::RoughnessParameter;
use asperity_study::maps::{AdhesionBoundary, Boundaries, Crossing};
use serde_json::{Map, Value, json};
use std::cmp::Ordering;

impl Report for Boundaries {
    fn text(&self) -> Option<String> {
        let mut heading: Vec<String> = self
            .others
            .iter()
            .map(|axis| axis.symbol_or_path())
            .collect();
        heading.extend(["protocol", "level", self.symbol(), "95 %"].map(String::from));
        let mut rows = vec![heading];
        for boundary in &self.found {
            let Crossing {
                value,
                side,
                interval,
            } = boundary.crossing;
            let beyond = ["< ", "", "> "][(side as i8 + 1) as usize];
            let interval =
                interval.map_or_else(String::new, |(low, high)| format!("{low:.2} to {high:.2}"));
            let mut row: Vec<String> = boundary.others.iter().map(ToString::to_string).collect();
            row.extend([
                boundary.protocol_name().to_owned(),
                boundary.level.to_string(),
                format!("{beyond}{value:.2}"),
                interval,
            ]);
            rows.push(row);
        }
        let mut sheet = Sheet::default();
        sheet.table(&rows);
        let is_kappa = self.over == RoughnessParameter::Kappa;
        let paper = if is_kappa {
            "; the paper gives 0.6"
        } else {
            ""
        };
        sheet.paragraph(&format!(
            "{} over {} random profiles{paper}.",
            self.symbol(),
            self.lines
        ));
        Some(sheet.into_text())
    }

    /// Returns an entry for each boundary: the κ or e_el/γ at which adhesion without a preload
    /// falls to a stated share of F_a,max.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let object = |boundary: &AdhesionBoundary| {
            let mut object = Map::new();
            let mut set = |name: &str, value: Value| drop(object.insert(name.to_owned(), value));
            for (axis, value) in self.others.iter().zip(&boundary.others) {
                set(&axis.symbol_or_path(), json!(value));
            }
            set("protocol", json!(boundary.protocol_name()));
            set("level", json!(boundary.level));
            let Crossing {
                value,
                side,
                interval,
            } = boundary.crossing;
            match side {
                Ordering::Equal => {
                    set(self.over.name(), json!(value));
                    set("confidence_interval", json!(interval));
                }
                Ordering::Less => set("below", json!(value)),
                Ordering::Greater => set("above", json!(value)),
            }
            Value::Object(object)
        };
        let found: Vec<Value> = self.found.iter().map(object).collect();
        Some(Box::new(
            json!({ "lines": self.lines, "boundaries": found }),
        ))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table = Table::of(|| self.found.iter());
        for (place, axis) in self.others.iter().enumerate() {
            table = match axis.is_whole() {
                true => table.with(axis.symbol_or_path(), Kind::Whole, move |one| {
                    one.others[place] as u64
                }),
                false => table.with(axis.symbol_or_path(), Kind::Real, move |one| {
                    one.others[place]
                }),
            };
        }
        table = table
            .with("protocol", Kind::Text("zero force".len()), |one| {
                one.protocol_name()
            })
            .real("level", |one| one.level);
        table = table.real(self.over.name(), |one| {
            one.crossing.known().map(|(value, _)| value)
        });
        let beyond = |one: &AdhesionBoundary, side| {
            (one.crossing.side == side).then_some(one.crossing.value)
        };
        table = table
            .real("low", |one| Some(one.crossing.interval?.0))
            .real("high", |one| Some(one.crossing.interval?.1))
            .real("below", move |one| beyond(one, Ordering::Less))
            .real("above", move |one| beyond(one, Ordering::Greater));
        Some(table.done())
    }
}
