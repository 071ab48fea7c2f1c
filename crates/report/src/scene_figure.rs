//! Figures of the contact: the profile in contact, and contact patches over the indentation.

use crate::section::{LineColumns, Part, SectionContact};
use asperity_contact::motion::Leg;
use asperity_contact::{Branch, CurvePoint, Direction, LegRecord, Patch};
use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Span, value_label};
use asperity_scene::Outcome;
use asperity_surface::lines::Line;
use std::slice;

/// Number of indentations of a loading stage at which contact patches are drawn.
const ROWS: usize = 160;
/// Largest number of loading stages whose contact patches are drawn.
const MOST_STAGES: usize = 4;
/// Share of the profile below which a gap between contact patches is drawn as closed.
const LEAST_GAP: f64 = 5e-4;

/// Size of the frame of a chart of contact patches, px.
const PATCHES: (f64, f64) = (400.0, 300.0);

/// Contact patches at an indentation, m.
struct Patches {
    indentation: f64,
    patches: Vec<Patch>,
}

/// Contact patches of a scene, which are collected while its loading is computed. Figures are drawn
/// from them.
#[derive(Default)]
pub struct ContactSets {
    over_indentation: bool,
    /// Largest force of the loading stages so far in N, with the patches at this force.
    preload: Option<(f64, Patches)>,
    stages: Vec<(Direction, Vec<Patches>)>,
    /// Number of loading stages with contact that exceed [`MOST_STAGES`].
    left_out: usize,
}

impl ContactSets {
    /// Begins a collection without patches. [`Self::patches_figure`] needs `over_indentation` to be
    /// true.
    pub fn new(over_indentation: bool) -> ContactSets {
        ContactSets {
            over_indentation,
            ..ContactSets::default()
        }
    }

    /// Adds the patches of a loading stage that was just computed. `record` has the force curve of
    /// this stage, and `leg` returns the patches at any indentation of this stage.
    pub fn observe(&mut self, record: &LegRecord, leg: &Leg) {
        let at = |indentation: f64| Patches {
            indentation,
            patches: leg.patches(indentation),
        };
        let larger = |point: &CurvePoint| {
            self.preload
                .as_ref()
                .is_none_or(|(force, _)| point.force > *force)
        };
        let preload = Branch::preload(slice::from_ref(record)).map(|(_, point)| point);
        if let Some(point) = preload.filter(larger) {
            self.preload = Some((point.force, at(point.indentation)));
        }
        let touching = record
            .curve
            .iter()
            .filter(|point| point.springs > 0)
            .map(|point| point.indentation);
        let (low, high) = touching.fold((f64::INFINITY, f64::NEG_INFINITY), |ends, d| {
            (ends.0.min(d), ends.1.max(d))
        });
        if !self.over_indentation || low >= high {
            return;
        }
        if self.stages.len() == MOST_STAGES {
            self.left_out += 1;
            return;
        }
        let step = (high - low) / ROWS as f64;
        let rows = (0..ROWS)
            .map(|row| at(low + step * (row as f64 + 0.5)))
            .collect();
        self.stages.push((record.direction, rows));
    }

    /// Returns the figure of the contact at the largest force: heights of rigid profile and elastic
    /// surface over the position along the profile.
    pub fn profile_figure(&self, title: &str, outcome: &Outcome, line: &Line) -> Figure {
        let separated = (
            0.0,
            Patches {
                indentation: 0.0,
                patches: Vec::new(),
            },
        );
        let (
            force,
            Patches {
                indentation,
                patches,
            },
        ) = self.preload.as_ref().unwrap_or(&separated);
        let (force, indentation) = (*force, *indentation);
        let contact = SectionContact {
            gaps: &line.gaps,
            summit: line.summit,
            indentation,
            patches,
        };
        let section = contact.section(Part::drawn(0, line.gaps.len()), &mut LineColumns::default());
        let (low, high) = section.heights;
        let z = Span::around(
            [low, high, section.level.min(high + 0.5 * (high - low))].into_iter(),
            0.05,
        );
        let mut chart = section.chart(outcome.line, z);
        chart.x = position(outcome);
        let at = Label::plain("largest force: ")
            .join(&value_label("", "F", "N", force))
            .then(", ");
        let notes = vec![at.join(&value_label("", "d", "m", indentation))];
        Figure {
            notes,
            size: Figure::LOW,
            ..Figure::of_chart(title, chart)
        }
    }

    /// Returns the figure that shows at which positions along the profile there is contact at each
    /// indentation, with a chart for each of the first four loading stages with contact.
    pub fn patches_figure(&self, title: &str, outcome: &Outcome) -> Figure {
        let facts = outcome.line;
        let least = LEAST_GAP * facts.length;
        let ends = self
            .stages
            .iter()
            .flat_map(|(_, rows)| rows)
            .map(|row| row.indentation);
        let d = ChartAxis::new(
            AxisScale::Linear,
            Span::around(ends, 0.02),
            "indentation",
            "d",
            "m",
        );
        let chart = |(direction, rows): &(Direction, Vec<Patches>)| {
            let half = rows.get(..2).map_or(0.0, |pair| {
                0.5 * (pair[1].indentation - pair[0].indentation)
            });
            let mut boxes = Vec::new();
            for Patches {
                indentation,
                patches,
            } in rows
            {
                let mut open: Option<(f64, f64)> = None;
                for patch in patches {
                    let [from, to] = [patch.first, patch.last + 1]
                        .map(|spring| (facts.first + spring) as f64 * facts.spacing);
                    match &mut open {
                        Some((_, end)) if from - *end < least => *end = to.max(*end),
                        _ => {
                            boxes.extend(open.replace((from, to)).map(|ends| (ends, *indentation)))
                        }
                    }
                }
                boxes.extend(open.map(|ends| (ends, *indentation)));
            }
            let boxes = boxes
                .into_iter()
                .map(|(x, d)| (x, (d - half, d + half)))
                .collect();
            let heading = if *direction == Direction::Loading {
                "loading"
            } else {
                "unloading"
            };
            let layers = vec![Layer::new(
                "contact".into(),
                Ink::Contact,
                Shape::Boxes(boxes),
            )];
            Chart {
                heading: heading.into(),
                ..Chart::new(position(outcome), d.clone(), layers)
            }
        };
        let mut charts: Vec<Chart> = self.stages.iter().map(chart).collect();
        if charts.is_empty() {
            charts.push(chart(&(Direction::Loading, Vec::new())));
        }
        let notes = match (self.stages.len(), self.left_out) {
            (0, _) => vec![Label::plain("nothing comes into contact")],
            (_, 0) => Vec::new(),
            (drawn, rest) => {
                vec![Label::plain(&format!(
                    "the first {drawn} of {} loading stages",
                    drawn + rest
                ))]
            }
        };
        Figure {
            title: title.to_owned(),
            notes,
            charts,
            size: PATCHES,
            ..Figure::default()
        }
    }
}

fn position(outcome: &Outcome) -> ChartAxis {
    let span = Span {
        low: 0.0,
        high: outcome.line.length,
    };
    ChartAxis::new(AxisScale::Linear, span, "position", "x", "m")
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_scene::{Document, Simulation};

    const SCENE: &str = "(
    version: 1,
    title: \"Rough <&>\",
    material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
    length: 1.0e-4,
    roughness: SelfAffine(hurst: 0.7, rms_height: 2.0e-7, modes: (1, 64), seed: 1),
    adhesion: (kappa: 3.0),
    loading: [ToForce(1.0e-5), ToSeparation],
    numerics: (points: 512, samples: 16),
)";

    fn computed(overrides: &[(&str, &str)]) -> (Outcome, ContactSets, Line) {
        let overrides: Vec<_> = overrides
            .iter()
            .map(|(path, value)| (path.to_string(), value.to_string()))
            .collect();
        let document = Document::parse(SCENE, "test")
            .unwrap()
            .set_all(&overrides)
            .unwrap();
        let mut simulation = Simulation::default();
        let mut sets = ContactSets::new(true);
        let outcome = simulation
            .run(document.scene(), &|| false, &mut |_, record, leg| {
                sets.observe(record, leg);
                Ok(())
            })
            .unwrap();
        let line = simulation.make_line(document.scene()).unwrap().0.clone();
        (outcome, sets, line)
    }

    fn names(figure: &Figure) -> Vec<String> {
        figure
            .legend()
            .iter()
            .map(|entry| entry.name.to_string())
            .collect()
    }

    #[test]
    fn the_profile_shows_the_contact_at_the_largest_force() {
        let (outcome, sets, line) = computed(&[]);
        let figure = sets.profile_figure("", &outcome, &line);
        assert_eq!(names(&figure), ["surface", "profile", "contact"]);
        let Shape::Envelope { columns, .. } = &figure.charts[0].layers[2].shape else {
            panic!()
        };
        let preload = outcome.history.legs[0].largest;
        assert_eq!(
            columns.iter().flatten().count() as u64,
            preload.springs,
            "one column for each spring"
        );
        assert_eq!(columns.len(), line.gaps.len());
        let (outcome, sets, line) = computed(&[("loading", "[ToTouch]"), ("adhesion", "None")]);
        let note = sets.profile_figure("", &outcome, &line).notes[0].to_string();
        assert_eq!(note, "largest force: F = 0 N, d = 0 m");
    }

    #[test]
    fn patches_cover_the_contact_length() {
        let (outcome, sets, _) = computed(&[]);
        let figure = sets.patches_figure("", &outcome);
        let headings: Vec<String> = figure
            .charts
            .iter()
            .map(|chart| chart.heading.to_string())
            .collect();
        assert_eq!(headings, ["loading", "unloading"]);
        for (chart, (_, rows)) in figure.charts.iter().zip(&sets.stages) {
            let Shape::Boxes(boxes) = &chart.layers[0].shape else {
                panic!()
            };
            let drawn: f64 = boxes.iter().map(|((from, to), _)| to - from).sum();
            let springs: usize = rows
                .iter()
                .flat_map(|row| &row.patches)
                .map(|patch| patch.springs().len())
                .sum();
            // Gaps of one spring are wider than the merged ones.
            assert!((drawn / (springs as f64 * outcome.line.spacing) - 1.0).abs() < 1e-9);
            assert_eq!(rows.len(), ROWS);
        }
        let many =
            "[ToForce(1e-5), ToZeroForce, ToForce(1e-5), ToZeroForce, ToForce(1e-5), ToSeparation]";
        let (outcome, sets, _) = computed(&[("loading", many)]);
        let figure = sets.patches_figure("", &outcome);
        assert_eq!(
            (figure.charts.len(), figure.notes[0].to_string().as_str()),
            (4, "the first 4 of 6 loading stages")
        );
        let (outcome, sets, _) = computed(&[("loading", "[ToTouch]"), ("adhesion", "None")]);
        assert_eq!(
            sets.patches_figure("", &outcome).notes[0].to_string(),
            "nothing comes into contact"
        );
    }
}
