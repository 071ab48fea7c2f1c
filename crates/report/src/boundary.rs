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
        let symbol = self.symbol();
        let mut header: Vec<String> = self
            .others
            .iter()
            .map(|axis| axis.symbol_or_path())
            .collect();
        header.extend(["protocol", "level", symbol, "95 %"].map(String::from));
        let mut rows = vec![header];
        rows.extend(self.found.iter().map(row));
        let mut sheet = Sheet::default();
        sheet.table(&rows);
        let paper = if self.over == RoughnessParameter::Kappa {
            "; the paper gives 0.6"
        } else {
            ""
        };
        let lines = self.lines;
        sheet.paragraph(&format!("{symbol} over {lines} random profiles{paper}."));
        Some(sheet.into_text())
    }

    /// Returns an object whose list `boundaries` has an item for each boundary at which adhesion
    /// vanishes. A boundary is the value of κ or e_el/γ at which the pull-off force without a
    /// preload falls below a stated share of F_a,max.
    fn json(&self) -> Option<Box<dyn Json + '_>> {
        let boundaries: Vec<Value> = self
            .found
            .iter()
            .map(|boundary| boundary_object(self, boundary))
            .collect();
        Some(Box::new(
            json!({ "profiles": self.lines, "boundaries": boundaries }),
        ))
    }

    fn table(&self) -> Option<Table<'_>> {
        let mut table = Table::of(|| self.found.iter());
        for (place, axis) in self.others.iter().enumerate() {
            let name = axis.symbol_or_path();
            table = if axis.is_whole() {
                table.with(name, Kind::Whole, move |boundary| {
                    boundary.others[place] as u64
                })
            } else {
                table.with(name, Kind::Real, move |boundary| boundary.others[place])
            };
        }
        let table = table
            .with("protocol", Kind::Text("first touch".len()), |boundary| {
                boundary.protocol_name()
            })
            .real("level", |boundary| boundary.level)
            .real(self.over.name(), |boundary| {
                boundary.crossing.known().map(|(value, _)| value)
            })
            .real("low", |boundary| Some(boundary.crossing.interval?.0))
            .real("high", |boundary| Some(boundary.crossing.interval?.1))
            .real("below", |boundary| beyond(boundary, Ordering::Less))
            .real("above", |boundary| beyond(boundary, Ordering::Greater));
        Some(table.done())
    }
}

/// Returns the row for a boundary in the table of the text report.
fn row(boundary: &AdhesionBoundary) -> Vec<String> {
    let Crossing {
        value,
        side,
        interval,
    } = boundary.crossing;
    let sign = match side {
        Ordering::Less => "< ",
        Ordering::Equal => "",
        Ordering::Greater => "> ",
    };
    let interval = match interval {
        Some((low, high)) => format!("{low:.2} to {high:.2}"),
        None => String::new(),
    };
    let mut row: Vec<String> = boundary.others.iter().map(ToString::to_string).collect();
    row.push(boundary.protocol_name().to_owned());
    row.push(boundary.level.to_string());
    row.push(format!("{sign}{value:.2}"));
    row.push(interval);
    row
}

/// Returns the JSON object of a boundary. Its keys for the axes are the symbols of these axes.
fn boundary_object(boundaries: &Boundaries, boundary: &AdhesionBoundary) -> Value {
    let mut object = Map::new();
    for (axis, value) in boundaries.others.iter().zip(&boundary.others) {
        object.insert(axis.symbol_or_path(), json!(value));
    }
    object.insert("protocol".to_owned(), json!(boundary.protocol_name()));
    object.insert("level".to_owned(), json!(boundary.level));
    let crossing = &boundary.crossing;
    let value = json!(crossing.value);
    match crossing.side {
        Ordering::Equal => {
            object.insert(boundaries.over.name().to_owned(), value);
            let interval = json!(crossing.interval);
            object.insert("confidence_interval".to_owned(), interval);
        }
        Ordering::Less => {
            object.insert("below".to_owned(), value);
        }
        Ordering::Greater => {
            object.insert("above".to_owned(), value);
        }
    }
    Value::Object(object)
}

/// Returns the end of the studied range beyond which the boundary lies. `None` if the boundary does
/// not lie on the side `side` of the range.
fn beyond(boundary: &AdhesionBoundary, side: Ordering) -> Option<f64> {
    (boundary.crossing.side == side).then_some(boundary.crossing.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_study::Quantity;

    /// The names of both turning points fit into the columns of a NumPy array.
    #[test]
    fn boundaries_of_both_protocols_can_be_an_array() {
        let boundary = |protocol| AdhesionBoundary {
            others: Vec::new(),
            protocol,
            level: 0.05,
            crossing: Crossing {
                value: 0.6,
                side: Ordering::Equal,
                interval: Some((0.5, 0.7)),
            },
        };
        let boundaries = Boundaries {
            over: RoughnessParameter::Kappa,
            others: Vec::new(),
            lines: 4,
            found: Quantity::ADHESION_SHARES.map(boundary).to_vec(),
        };
        let mut array = Vec::new();
        let table = boundaries.table().unwrap();
        table.write_npy(&mut array).unwrap();
        assert!(!array.is_empty());
    }
}
