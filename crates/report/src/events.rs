//! The events of a loading as text and as a table: its jumps and the marked points of its force
//! curve.

use crate::report::{Json, Report};
use crate::run::{RunJson, RunReport};
use crate::sheet::Sheet;
use crate::warnings::{sentences_section, warning_texts};
use crate::words::{percent, whole_percent};
use asperity_contact::motion::{Jump, JumpKind};
use asperity_contact::{Direction, Event, Events, Mark, Patch};
use asperity_data::{Kind, Table, counted, format_range, format_rounded, grouped};
use serde::Serialize;

/// Number of significant digits of the numbers in the list.
const DIGITS: usize = 3;
/// Number of characters of the longest name of an event in the table.
const LONGEST_NAME: usize = 16;

/// Report on a computed scene with the events of its loading. The text and the table list the
/// events. The JSON object has all results of the scene and the events.
#[derive(Clone, Copy, Debug)]
pub struct EventsReport<'a> {
    /// Report on the results of the scene.
    pub run: RunReport<'a>,
    pub events: &'a Events,
    /// Smallest share of the largest energy of a jump with which a jump is listed.
    pub least_share: f64,
}

/// JSON object of a computed scene with the events of its loading.
#[derive(Serialize)]
struct EventsJson<'a> {
    #[serde(flatten)]
    run: RunJson<'a>,
    events: Option<Table<'a>>,
}

/// Returns an event in words, such as `pull-off · patch 5 shrinks`. Patches are counted from 1,
/// from left to right.
pub fn event_words(event: &Event) -> String {
    let mark = event.mark.map(|mark| mark.name().to_owned());
    let jump = event.jump.as_ref().map(jump_words);
    let instrument = event.instrument.map(|jump| {
        let target = format_rounded(jump.to, DIGITS, "m");
        format!("instrument jumps to {target}")
    });
    let parts: Vec<String> = [mark, jump, instrument].into_iter().flatten().collect();
    parts.join(" · ")
}

/// Returns words with the number of listed jumps of the instrument, such as ` and 2 of the
/// instrument`. The words follow the number of jumps of the contact. Returns an empty text if no
/// jump of the instrument is listed.
pub fn jumps_of_instrument(events: &Events) -> String {
    let of_instrument = events
        .list
        .iter()
        .filter(|event| event.instrument.is_some());
    match of_instrument.count() {
        0 => String::new(),
        count => format!(" and {} of the instrument", grouped(count as u64)),
    }
}

fn jump_words(jump: &Jump) -> String {
    let number = jump.number + 1;
    match jump.kind {
        JumpKind::Merges { patches: 2 } => {
            format!(
                "patches {} and {} merge",
                grouped(number),
                grouped(number + 1)
            )
        }
        JumpKind::Merges { patches } => {
            let last = number + patches - 1;
            format!("patches {} to {} merge", grouped(number), grouped(last))
        }
        JumpKind::Splits { parts } if parts > 2 => {
            format!("patch {} splits into {}", grouped(number), grouped(parts))
        }
        JumpKind::Several { changes } => format!("{} patches jump", grouped(changes)),
        kind => format!("patch {} {}", grouped(number), kind.name()),
    }
}

/// Returns an energy with its sign, such as `+0.7 pJ`, and zero without a sign.
pub fn signed_energy(energy: f64) -> String {
    let sign = if energy > 0.0 { "+" } else { "" };
    format!("{sign}{}", format_rounded(energy, DIGITS, "J"))
}

/// Returns the number of springs that attach or detach with its sign, such as `-1 194`.
fn signed_springs(springs: i64) -> String {
    let sign = if springs < 0 { "-" } else { "+" };
    format!("{sign}{}", grouped(springs.unsigned_abs()))
}

impl EventsReport<'_> {
    fn has_instrument(&self) -> bool {
        self.run.outcome.instrument.is_some()
    }

    /// Returns true if the body relaxes: its events then have times, and its jumps are not known
    /// one by one.
    fn relaxes(&self) -> bool {
        self.run.scene.material.relaxation.is_some()
    }

    /// Returns how many of the jumps are listed, and why not all of them.
    fn heading(&self) -> String {
        let events = self.events;
        if self.relaxes() {
            return "Marks of the force curve. The jumps of a body that relaxes are not listed."
                .to_owned();
        }
        let all = counted(events.jumps as u64, "jump");
        let of_instrument = jumps_of_instrument(events);
        if events.listed_jumps == events.jumps {
            return format!("{all}{of_instrument}");
        }
        let listed = grouped(events.listed_jumps as u64);
        let share = percent(self.least_share, 4);
        format!("{listed} of {all}{of_instrument}: those of at least {share} of the largest energy")
    }

    fn row(&self, event: &Event) -> Vec<String> {
        if let Some(seconds) = event.seconds {
            return vec![
                grouped(event.stage as u64 + 1),
                format_rounded(seconds, DIGITS + 1, "s"),
                format_rounded(event.indentation, DIGITS + 1, "m"),
                format_rounded(event.forces[0], DIGITS, "N"),
                event_words(event),
            ];
        }
        let [before, after] = event.forces;
        let energy = match (event.jump, event.instrument) {
            (Some(jump), _) => signed_energy(jump.energy),
            // The springs and the instrument release this energy.
            (None, Some(jump)) => signed_energy(-jump.energy),
            (None, None) => String::new(),
        };
        vec![
            grouped(event.stage as u64 + 1),
            format_rounded(event.indentation, DIGITS + 1, "m"),
            energy,
            event
                .jump
                .map_or(String::new(), |jump| signed_springs(jump.springs)),
            format_range((before, after), DIGITS, "N"),
            event_words(event),
        ]
    }

    /// Returns what the energies mean, and which part of the energy of all springs the jumps have.
    fn meaning(&self) -> String {
        let figures = &self.run.outcome.figures;
        let mut gained = 0.0;
        let mut released = 0.0;
        for stage in &self.run.outcome.history.stages {
            match stage.direction {
                Direction::Loading => gained -= stage.released_energy,
                Direction::Unloading => released += stage.released_energy,
            }
        }
        let mut text = "Energy: elastic energy that springs gain (+) or release (-) at this \
                        indentation."
            .to_owned();
        let parts = [
            ("gain", self.events.gained, gained),
            ("release", self.events.released, released),
        ];
        for (verb, in_jumps, all) in parts {
            if all > 0.0 {
                let all_energy = format_rounded(all, DIGITS, "J");
                let share = whole_percent(in_jumps / all);
                text += &format!(" Springs {verb} {all_energy} in all, {share} of it in jumps.");
            }
        }
        if let Some(dissipated) = figures.dissipated_energy {
            let dissipated = format_rounded(dissipated, DIGITS, "J");
            text += &format!(
                " What they release more than they gain is the dissipated energy, {dissipated}."
            );
        }
        if self.has_instrument() {
            text += " The energy of a jump of the instrument is what the instrument and the body \
                     lose in it.";
        }
        text
    }
}

impl Report for EventsReport<'_> {
    fn warnings(&self) -> Vec<String> {
        warning_texts(&self.run.outcome.warnings)
    }

    fn text(&self) -> Option<String> {
        let run = &self.run;
        let mut sheet = Sheet::default();
        sheet.paragraph(&run.scene.title);
        sentences_section(&mut sheet, &self.warnings());
        let profile = match run.outcome.line.seed {
            Some(seed) => format!(", profile of seed {seed}"),
            None => String::new(),
        };
        sheet.heading(&format!("{}{profile}", self.heading()));
        if !self.events.list.is_empty() {
            let columns: &[&str] = if self.relaxes() {
                &["stage", "t", "d", "F", "event"]
            } else {
                &["stage", "d", "energy", "springs", "F", "event"]
            };
            let mut rows = vec![columns.iter().copied().map(String::from).collect()];
            rows.extend(self.events.list.iter().map(|event| self.row(event)));
            sheet.table(&rows);
        }
        if self.events.jumps > 0 {
            sheet.heading(&self.meaning());
        }
        Some(sheet.into_text())
    }

    fn json(&self) -> Option<Box<dyn Json + '_>> {
        Some(Box::new(EventsJson {
            run: RunJson::new(&self.run),
            events: self.table(),
        }))
    }

    /// Returns a table with a row for each event, in SI units. Stages, patches and springs are
    /// counted from 0.
    fn table(&self) -> Option<Table<'_>> {
        // A punch leaves springs beside it free. They count, as everywhere in files.
        Some(events_table(
            self.events,
            self.run.outcome.line.first,
            self.has_instrument(),
        ))
    }
}

/// Returns the table of the events of a loading in SI units. `first_spring` is the index of the
/// first spring under the body. Only a table with an instrument has the energies that the
/// instrument loses, and only a table of a body that relaxes has times, in s since first touch.
pub fn events_table(events: &Events, first_spring: usize, has_instrument: bool) -> Table<'_> {
    let place = move |patch: Option<Patch>, end: fn(Patch) -> usize| {
        patch.map(|patch| (first_spring + end(patch)) as u64)
    };
    let first = |patch: Patch| patch.first;
    let last = |patch: Patch| patch.last;
    let table = Table::of(|| events.list.iter()).whole("stage", |event| event.stage as u64);
    let has_times = events.list.iter().any(|event| event.seconds.is_some());
    let table = if has_times {
        table.real("time", |event| event.seconds)
    } else {
        table
    };
    let table = table
        .real("indentation", |event| event.indentation)
        .with("mark", Kind::Text(LONGEST_NAME), |event| {
            event.mark.map_or("", Mark::name)
        })
        .with("event", Kind::Text(LONGEST_NAME), |event| event_name(event))
        .real("energy", |event| event.jump.map(|jump| jump.energy))
        .real("springs", |event| event.jump.map(|jump| jump.springs))
        .real("force_before", |event| event.forces[0])
        .real("force_after", |event| event.forces[1])
        .real("patches_before", |event| {
            event.jump.map(|jump| jump.patches[0])
        })
        .real("patches_after", |event| {
            event.jump.map(|jump| jump.patches[1])
        })
        .real("patch", |event| event.jump.map(|jump| jump.number))
        .real("first_before", move |event| {
            place(event.jump.and_then(|jump| jump.before), first)
        })
        .real("last_before", move |event| {
            place(event.jump.and_then(|jump| jump.before), last)
        })
        .real("first_after", move |event| {
            place(event.jump.and_then(|jump| jump.after), first)
        })
        .real("last_after", move |event| {
            place(event.jump.and_then(|jump| jump.after), last)
        });
    let table = if has_instrument {
        table
            .real("jumps_to", |event| event.instrument.map(|jump| jump.to))
            .real("instrument_loss", |event| {
                event.instrument.map(|jump| jump.energy)
            })
    } else {
        table
    };
    table
        .done()
        .with_note("Stages, patches and springs are counted from 0; the text counts from 1.")
}

/// Returns the name of an event in tables; empty for a mark alone.
fn event_name(event: &Event) -> &'static str {
    match (event.jump, event.instrument) {
        (Some(jump), _) => jump.kind.name(),
        (None, Some(_)) => "instrument",
        (None, None) => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::motion::JumpCollector;
    use asperity_scene::{Outcome, Scene, Simulation, open};

    /// Computes a built-in scene with overrides. Returns the scene, its outcome, and the events of
    /// which the energies are at least a share of the largest one.
    fn computed(
        name: &str,
        overrides: &[(&str, &str)],
        least_share: f64,
    ) -> (Scene, Outcome, Events) {
        let mut document = open(name).unwrap();
        for (path, value) in overrides {
            document = document.set(path, value).unwrap();
        }
        let scene = document.scene();
        let mut jumps = JumpCollector::default();
        let outcome = Simulation::default()
            .run(scene, &|| false, &mut |_, record, stage| {
                jumps.observe(record, stage)
            })
            .unwrap();
        let stages = &outcome.history.stages;
        let events = jumps.events(stages, least_share, usize::MAX).unwrap();
        (Scene::clone(scene), outcome, events)
    }

    fn report<'a>(
        scene: &'a Scene,
        outcome: &'a Outcome,
        events: &'a Events,
        least_share: f64,
    ) -> EventsReport<'a> {
        EventsReport {
            run: RunReport {
                wording: |remedy| format!("{remedy:?}"),
                title: "",
                scene,
                outcome,
                choice: None,
                estimate: None,
                ensemble: None,
                deviation: None,
            },
            events,
            least_share,
        }
    }

    #[test]
    fn words_name_the_patches_that_jump() {
        let (_, _, events) = computed("pressure-sensitive", &[("numerics.points", "4096")], 0.0);
        let mut kinds = Vec::new();
        for event in &events.list {
            let words = event_words(event);
            let Some(jump) = event.jump else {
                assert_eq!(Some(words.as_str()), event.mark.map(Mark::name));
                continue;
            };
            let number = jump.number + 1;
            let expected = match jump.kind {
                JumpKind::Touches => format!("patch {number} touches"),
                JumpKind::Spreads => format!("patch {number} spreads"),
                JumpKind::Merges { patches: 2 } => {
                    format!("patches {number} and {} merge", number + 1)
                }
                JumpKind::Merges { patches } => {
                    format!("patches {number} to {} merge", number + patches - 1)
                }
                JumpKind::Shrinks => format!("patch {number} shrinks"),
                JumpKind::Splits { parts: 2 } => format!("patch {number} splits"),
                JumpKind::Splits { parts } => format!("patch {number} splits into {parts}"),
                JumpKind::Detaches => format!("patch {number} detaches"),
                kind => panic!("no two patches of a random profile jump together: {kind:?}"),
            };
            let mark = event
                .mark
                .map_or(String::new(), |mark| format!("{} · ", mark.name()));
            assert_eq!(words, mark + &expected);
            kinds.push(jump.kind.name());
        }
        for kind in [
            "touches", "spreads", "merges", "shrinks", "splits", "detaches",
        ] {
            assert!(kinds.contains(&kind), "{kind}");
        }
    }

    #[test]
    fn a_list_says_how_many_jumps_it_leaves_out() {
        let overrides = [("numerics.points", "4096")];
        let heading = |share| {
            let (scene, outcome, events) = computed("pressure-sensitive", &overrides, share);
            let report = report(&scene, &outcome, &events, share);
            let text = report.text().unwrap();
            assert!(
                text.lines().all(|line| line.chars().count() <= 80),
                "{text}"
            );
            let rows = text.lines().filter(|line| line.contains("patch")).count();
            assert_eq!(rows, events.listed_jumps);
            (report.heading(), events)
        };
        let (all, events) = heading(0.0);
        assert_eq!(all, format!("{} jumps", events.jumps));
        let (large, events) = heading(0.01);
        let listed = events.listed_jumps;
        assert!(0 < listed && listed < events.jumps);
        let expected = format!("{listed} of {} jumps: those of at least 1 %", events.jumps);
        assert!(large.starts_with(&expected), "{large}");
    }

    #[test]
    fn contacts_without_jumps_have_their_marks_only() {
        for (name, overrides, marks) in [
            ("pressure-sensitive", ("adhesion", "None"), "preload"),
            (
                "pressure-sensitive",
                ("loading", "[ToIndentation(-1e-9)]"),
                "",
            ),
            (
                "jkr-sphere",
                ("numerics.points", "2"),
                "jump-in preload pull-off",
            ),
        ] {
            let (scene, outcome, events) = computed(name, &[overrides], 0.01);
            let found: Vec<String> = events.list.iter().map(event_words).collect();
            assert_eq!((events.jumps, found.join(" ")), (0, marks.to_owned()));
            let text = report(&scene, &outcome, &events, 0.01).text().unwrap();
            assert!(text.contains("\n0 jumps"), "{text}");
        }
    }

    #[test]
    fn the_table_counts_from_zero_and_has_the_instrument_if_there_is_one() {
        let (scene, outcome, events) = computed("jkr-sphere", &[], 0.01);
        let report_of_rigid = report(&scene, &outcome, &events, 0.01);
        let names = |table: &Table<'_>| {
            let columns = table.columns().iter();
            columns
                .map(|(name, _)| name.to_string())
                .collect::<Vec<_>>()
        };
        let table = report_of_rigid.table().unwrap();
        let mut csv = Vec::new();
        table.write_csv(&mut csv, "").unwrap();
        assert!(csv.starts_with(b"# Stages, patches and springs are counted from 0;"));
        assert_eq!(names(&table).last().unwrap(), "last_after");
        let first = table.rows().next().unwrap();
        assert_eq!(
            (&first[2], &first[3], &first[10]),
            (&"jump-in".into(), &"touches".into(), &0.into())
        );

        let compliant = [("loading_stiffness", "10.0")];
        let (scene, outcome, events) = computed("jkr-sphere", &compliant, 0.01);
        let report = report(&scene, &outcome, &events, 0.01);
        let table = report.table().unwrap();
        assert_eq!(names(&table).last().unwrap(), "instrument_loss");
        assert!(
            table
                .rows()
                .any(|row| row[3] == "instrument" && row[16].as_f64() > Some(0.0))
        );
        assert!(report.text().unwrap().contains("instrument jumps"));
    }
}
