//! Figures of the contact: the profile at the largest force, and the contact patches at each
//! indentation.

use crate::section::{LineColumns, Part, SectionContact};
use asperity_contact::motion::Stage;
use asperity_contact::{Branch, Direction, Patch, StageRecord};
use asperity_data::AxisScale;
use asperity_plot::{Chart, ChartAxis, Figure, Ink, Label, Layer, Shape, Span, value_label};
use asperity_scene::Outcome;
use asperity_scene::workload::LineFacts;
use asperity_surface::lines::Line;
use std::slice;

/// Number of indentations of each loading stage at which contact patches are drawn.
const ROWS: usize = 160;

/// Largest number of loading stages whose contact patches are drawn.
const MOST_STAGES: usize = 4;

/// A gap between two contact patches that is narrower than this share of the profile is not drawn.
const LEAST_GAP: f64 = 5e-4;

/// Width and height in px of the frame of a chart of contact patches.
const PATCHES: (f64, f64) = (400.0, 300.0);

/// Contact patches, and the indentation in m at which they exist.
#[derive(Default)]
struct Patches {
    indentation: f64,
    patches: Vec<Patch>,
}

impl Patches {
    /// Returns the patches of a loading stage at an indentation in m.
    fn of_stage(stage: &Stage, indentation: f64) -> Self {
        Patches {
            indentation,
            patches: stage.patches(indentation),
        }
    }
}

/// Contact patches of a scene, from which figures are drawn. They are collected while the loading
/// of the scene is computed.
#[derive(Default)]
pub struct ContactSets {
    over_indentation: bool,
    /// Largest force of the loading stages so far in N, with the patches at this force.
    preload: Option<(f64, Patches)>,
    stages: Vec<(Direction, Vec<Patches>)>,
    /// Number of loading stages with contact that are not drawn, because there are more than
    /// [`MOST_STAGES`].
    left_out: usize,
}

impl ContactSets {
    /// Begins a collection without patches. If `over_indentation` is true, the patches at many
    /// indentations are collected, which [`Self::patches_figure`] needs.
    pub fn new(over_indentation: bool) -> ContactSets {
        ContactSets {
            over_indentation,
            ..ContactSets::default()
        }
    }

    /// Adds the patches of a loading stage that has just been computed. `record` contains the force
    /// curve of this stage, and `stage` returns the patches at any of its indentations.
    pub fn observe(&mut self, record: &StageRecord, stage: &Stage) {
        if let Some((_, point)) = Branch::preload(slice::from_ref(record)) {
            let preload = self.preload.as_ref();
            if preload.is_none_or(|(force, _)| point.force > *force) {
                self.preload = Some((point.force, Patches::of_stage(stage, point.indentation)));
            }
        }
        if self.over_indentation {
            self.add_stage(record, stage);
        }
    }

    /// Adds the patches at [`ROWS`] indentations of a loading stage with contact.
    fn add_stage(&mut self, record: &StageRecord, stage: &Stage) {
        let mut low = f64::INFINITY;
        let mut high = f64::NEG_INFINITY;
        for point in &record.curve {
            if point.springs > 0 {
                low = low.min(point.indentation);
                high = high.max(point.indentation);
            }
        }
        if low >= high {
            return;
        }
        if self.stages.len() == MOST_STAGES {
            self.left_out += 1;
            return;
        }
        let step = (high - low) / ROWS as f64;
        let mut rows = Vec::with_capacity(ROWS);
        for row in 0..ROWS {
            let indentation = low + step * (row as f64 + 0.5);
            rows.push(Patches::of_stage(stage, indentation));
        }
        self.stages.push((record.direction, rows));
    }

    /// Returns the figure of the contact at the largest force. It shows the heights of the rigid
    /// profile and of the elastic surface over the position along the profile.
    pub fn profile_figure(&self, title: &str, outcome: &Outcome, line: &Line) -> Figure {
        let separated = (0.0, Patches::default());
        let (force, at_force) = self.preload.as_ref().unwrap_or(&separated);
        let contact = SectionContact {
            gaps: &line.gaps,
            summit: line.summit,
            indentation: at_force.indentation,
            patches: &at_force.patches,
        };
        let section = contact.section(Part::drawn(0, line.gaps.len()), &mut LineColumns::default());
        let (low, high) = section.heights;
        // An elastic surface far above the profile is left out of the range of the axis.
        let level = section.level.min(high + 0.5 * (high - low));
        let z = Span::around([low, high, level].into_iter(), 0.05);
        let mut chart = section.chart(outcome.line, z, section.largest_stress().unwrap_or(1.0));
        chart.x = position_axis(outcome);
        let note = Label::plain("largest force: ")
            .join(&value_label("", "F", "N", *force))
            .then(", ")
            .join(&value_label("", "d", "m", at_force.indentation));
        Figure {
            notes: vec![note],
            size: Figure::LOW,
            ..Figure::of_chart(title, chart)
        }
    }

    /// Returns the figure that shows at which positions along the profile there is contact at each
    /// indentation. It has a chart for each of the first four loading stages with contact.
    pub fn patches_figure(&self, title: &str, outcome: &Outcome) -> Figure {
        let y = self.indentation_axis();
        let mut charts = Vec::new();
        for (direction, rows) in &self.stages {
            charts.push(patches_chart(*direction, rows, outcome, &y));
        }
        if charts.is_empty() {
            charts.push(patches_chart(Direction::Loading, &[], outcome, &y));
        }
        Figure {
            title: title.to_owned(),
            notes: self.note().into_iter().collect(),
            charts,
            size: PATCHES,
            ..Figure::default()
        }
    }

    /// Returns the axis of indentations, which all charts share.
    fn indentation_axis(&self) -> ChartAxis {
        let rows = self.stages.iter().flat_map(|(_, rows)| rows);
        let span = Span::around(rows.map(|row| row.indentation), 0.02);
        ChartAxis::new(AxisScale::Linear, span, "indentation", "d", "m")
    }

    /// Returns a note on loading stages that the figure does not show; `None` if it shows all
    /// stages.
    fn note(&self) -> Option<Label> {
        let drawn = self.stages.len();
        if drawn == 0 {
            return Some(Label::plain("nothing comes into contact"));
        }
        if self.left_out == 0 {
            return None;
        }
        let stages = drawn + self.left_out;
        let note = format!("the first {drawn} of {stages} loading stages");
        Some(Label::plain(&note))
    }
}

/// Returns a chart of the contact patches of a loading stage, over position and indentation.
fn patches_chart(
    direction: Direction,
    rows: &[Patches],
    outcome: &Outcome,
    indentation: &ChartAxis,
) -> Chart {
    let half_step = match rows {
        [first, second, ..] => 0.5 * (second.indentation - first.indentation),
        _ => 0.0,
    };
    let mut boxes = Vec::new();
    for row in rows {
        let heights = (row.indentation - half_step, row.indentation + half_step);
        for positions in drawn_patches(&row.patches, outcome.line) {
            boxes.push((positions, heights));
        }
    }
    let heading = match direction {
        Direction::Loading => "loading",
        Direction::Unloading => "unloading",
    };
    let layer = Layer::new("contact".into(), Ink::Contact, Shape::Boxes(boxes));
    Chart {
        heading: heading.into(),
        ..Chart::new(position_axis(outcome), indentation.clone(), vec![layer])
    }
}

/// Returns the positions in m of the two ends of each drawn contact patch. If the gap between two
/// patches is small, the two are drawn as one patch.
fn drawn_patches(patches: &[Patch], line: LineFacts) -> Vec<(f64, f64)> {
    let least_gap = LEAST_GAP * line.length;
    let position = |spring: usize| (line.first + spring) as f64 * line.spacing;
    let mut drawn: Vec<(f64, f64)> = Vec::new();
    for patch in patches {
        let from = position(patch.first);
        let to = position(patch.last + 1);
        match drawn.last_mut() {
            Some((_, end)) if from - *end < least_gap => *end = to.max(*end),
            _ => drawn.push((from, to)),
        }
    }
    drawn
}

/// Returns the axis of positions along the whole profile.
fn position_axis(outcome: &Outcome) -> ChartAxis {
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
            .run(document.scene(), &|| false, &mut |_, record, stage| {
                sets.observe(record, stage);
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
        assert_eq!(names(&figure), ["surface", "profile", "pressed", "pulled"]);
        let mut springs = 0;
        for layer in &figure.charts[0].layers[3..] {
            let Shape::Envelope { columns, .. } = &layer.shape else {
                panic!()
            };
            assert_eq!(columns.len(), line.gaps.len());
            springs += columns.iter().flatten().count();
        }
        let preload = outcome.history.stages[0].largest;
        assert_eq!(
            springs as u64, preload.springs,
            "one column for each spring"
        );
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
            // Even a gap of a single spring is wide enough to be drawn. Therefore the total length
            // of the drawn patches is the contact length.
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
