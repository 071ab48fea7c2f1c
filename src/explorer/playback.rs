//! The last computed scene, ready to be played leg by leg or loaded manually.

use super::close_up::close_up;
use super::engine::Engine;
use super::manual_body::ManualBody;
use super::panes::{Pane, SceneSpectra};
use super::player::Player;
use super::request::{Drive, LineView, ManualMove, Newest, Place, SnapshotRequest};
use super::snapshot::{ContactSnapshot, Probe, Report, SolvedScene};
use crate::contact::{ContactError, Leg, LegRecord, Patch};
use crate::export::section::{Contact, LineColumns, Part};
use crate::scene::{Observer, Scene, Solver};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Most bytes of kept legs: further legs are computed again when the animation reaches them.
const BYTES_KEPT: usize = 1 << 29;

/// Points of the curve over the range of indentations, when the body is pulled off manually.
const STEPS_OF_A_PULL: f64 = 200.0;

/// Playback of the newest computed scene.
#[derive(Default)]
pub struct Playback {
    generation: u64,
    scene: Option<Arc<Scene>>,
    computed: Option<Arc<SolvedScene>>,
    /// Legs of the loading, as far as kept.
    legs: Vec<Option<Leg>>,
    held: Option<ManualBody>,
    /// Spectra of the scene, once requested.
    spectra: Option<Arc<SceneSpectra>>,
    /// Columns of the line, independent of the contact.
    profile: LineColumns,
    close_up: LineColumns,
}

impl Playback {
    /// Playback of a scene that could not be computed.
    pub fn without_scene(generation: u64) -> Self {
        Playback { generation, ..Playback::default() }
    }

    /// Generation of the scene.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The computed scene.
    pub fn computed(&self) -> Option<Arc<SolvedScene>> {
        self.computed.clone()
    }

    /// Computes a scene, or returns the reason why that failed, in one line; `None` when a newer scene is awaited.
    pub fn compute(
        &mut self,
        engine: &mut dyn Engine,
        generation: u64,
        scene: Arc<Scene>,
        newest: &Newest,
        report: &dyn Fn(Report) -> bool,
    ) -> Option<Result<(), String>> {
        *self = Playback::without_scene(generation);
        // The histogram beside the profile needs the heights.
        let mut observed = scene.as_ref().clone();
        if !observed.observe.contains(&Observer::HeightHistogram) {
            observed.observe.push(Observer::HeightHistogram);
        }
        let stop = || newest.is_newer_than(generation);
        let mut bytes = 0;
        let mut legs = Vec::new();
        let result = engine.run(&observed, &stop, &mut |stage, _, leg| {
            legs.push(Some(leg.clone()).filter(|_| bytes <= BYTES_KEPT));
            bytes += leg.bytes();
            report(Report::Progress { generation, legs: stage + 1 });
            Ok(())
        });
        match result {
            Ok(outcome) => {
                self.legs = legs;
                self.scene = Some(Arc::new(observed));
                self.computed = Some(Arc::new(SolvedScene { generation, scene, outcome }));
                Some(Ok(()))
            }
            Err(error) if error.is_interruption() => {
                // Unless it is awaited again.
                self.generation = 0;
                None
            }
            Err(error) => Some(Err(error.to_string())),
        }
    }

    /// Moves the body manually.
    pub fn obey(&mut self, engine: &mut dyn Engine, order: ManualMove) {
        match order {
            ManualMove::Take { leg, indentation } => {
                self.held = None;
                let Some(computed) = self.computed.clone() else { return };
                let mut scene = computed.scene.as_ref().clone();
                let leg = if scene.numerics.solver == Solver::Exact {
                    self.leg(engine, leg)
                } else {
                    // The stepwise solver knows no leg but those of the loading.
                    scene.numerics.solver = Solver::Exact;
                    leg_of(engine, &scene, leg)
                };
                let Some(leg) = leg else { return };
                let preload = computed.outcome.figures.preload.unwrap_or(0.0);
                let scales = (range_of(&computed) / STEPS_OF_A_PULL, preload);
                self.held = ManualBody::take(&leg, indentation, scales);
            }
            order => {
                if let Some(held) = &mut self.held {
                    held.obey(order);
                }
            }
        }
    }

    /// The requested snapshot; `None` where the leg does not exist or manual loading has not begun.
    pub fn show(&mut self, engine: &mut dyn Engine, request: &SnapshotRequest) -> Option<ContactSnapshot> {
        let mut drive = request.drive;
        let (leg, point) = match request.drive {
            Drive::Leg(number) => {
                self.held = None;
                let legs = &self.computed.as_deref()?.outcome.history.legs;
                let player = Player { leg: number, done: 0.0, playing: false };
                let player = match request.place {
                    Place::Share(done) => Player { done, ..player }.within(legs),
                    Place::Indentation(_) => player,
                };
                let indentation = match request.place {
                    Place::Share(_) => player.indentation(legs),
                    Place::Indentation(indentation) => indentation,
                };
                let leg = self.leg(engine, player.leg)?;
                drive = Drive::Leg(player.leg);
                let point = leg.point(indentation).ok()?;
                (leg, point)
            }
            Drive::Manual => self.held.as_ref().map(|held| (held.leg().clone(), held.point()))?,
        };
        let patches = leg.patches(point.indentation);
        let line = engine.line()?;
        let SolvedScene { scene, outcome, .. } = self.computed.as_deref()?;
        let contact = Contact {
            gaps: &line.gaps,
            summit: line.summit,
            indentation: point.indentation,
            patches: &patches,
        };
        // Gaps between patches are whole cells; the outermost edges may lie inside of theirs.
        let outermost = patches.first().zip(patches.last()).map(|(one, other)| other.last - one.first + 1);
        let between = outermost.map_or(0, |springs| springs as u64 - point.springs);
        let radius = 0.5 * (point.contact_length + between as f64 * outcome.line.spacing);
        let close_up = close_up(&contact, &leg, request, &mut self.close_up);
        let middle = close_up.section.first + close_up.section.springs / 2;
        let profile = profile_part(request, line.gaps.len(), middle);
        let shows_spectra = request.large.is_some_and(|pane| pane.row().needs_spectra);
        if shows_spectra && self.spectra.is_none() {
            self.spectra = Some(Arc::new(SceneSpectra::new(scene, outcome, line)));
        }
        Some(ContactSnapshot {
            generation: self.generation,
            drive,
            line: outcome.line,
            focus: request.focus,
            point,
            contact_radius: radius,
            profile: contact.section(profile, &mut self.profile),
            close_up,
            strip: strip(&contact, request.strip_cells),
            probe: request.crosshair.and_then(|position| probe(&contact, position)),
            lengths: (request.lower == Pane::Lengths).then(|| lengths(&patches)),
            spectra: self.spectra.clone().filter(|_| shows_spectra),
            manual: match request.drive {
                Drive::Leg(_) => None,
                Drive::Manual => self.held.as_mut().map(ManualBody::travel),
            },
        })
    }

    /// A leg of the loading, computed again if it has not been kept.
    fn leg(&mut self, engine: &mut dyn Engine, leg: usize) -> Option<Leg> {
        if self.legs.get(leg)?.is_none() {
            self.recall(engine, leg);
        }
        self.legs.get(leg)?.clone()
    }

    /// Computes a leg again that was not kept.
    fn recall(&mut self, engine: &mut dyn Engine, wanted: usize) {
        let Some(found) = self.scene.as_ref().and_then(|scene| leg_of(engine, scene, wanted)) else { return };
        // Only one recalled leg is kept at a time.
        let firsts = BYTES_KEPT / found.bytes().max(1);
        self.legs.iter_mut().skip(firsts + 1).for_each(|leg| *leg = None);
        if let Some(leg) = self.legs.get_mut(wanted) {
            *leg = Some(found);
        }
    }
}

/// Runs a scene up to a leg.
fn leg_of(engine: &mut dyn Engine, scene: &Scene, wanted: usize) -> Option<Leg> {
    let mut found = None;
    let mut after = |stage: usize, _: &LegRecord, leg: &Leg| {
        if stage < wanted {
            return Ok(());
        }
        found = Some(leg.clone());
        // Nothing after this leg is needed.
        Err(ContactError::Interrupted)
    };
    // The run ends as soon as the leg is found.
    let _ = engine.run(scene, &|| false, &mut after);
    found
}

/// Contact of the whole profile in a row of cells.
fn strip(contact: &Contact<'_>, cells: usize) -> String {
    let whole = Part { first: 0, springs: contact.gaps.len(), columns: cells };
    let glyph = |cell| {
        let springs = whole.springs_of(cell);
        match contact.within(springs.clone()).map(|part| part.len()).sum::<usize>() {
            0 => '·',
            touching if touching == springs.len() => '■',
            _ => '▪',
        }
    };
    (0..cells).map(glyph).collect()
}

/// Counts patches of n springs over ⌊log₂ n²⌋: lengths that grow by a factor √2.
fn lengths(patches: &[Patch]) -> BTreeMap<u32, u64> {
    let mut counts = BTreeMap::new();
    for patch in patches {
        *counts.entry((patch.springs().len() as u64).pow(2).ilog2()).or_default() += 1;
    }
    counts
}

/// Profile and contact at a share of the profile; `None` for a profile without springs.
fn probe(contact: &Contact<'_>, position: f64) -> Option<Probe> {
    let last = contact.gaps.len().checked_sub(1)?;
    let spring = ((position * contact.gaps.len() as f64) as usize).min(last);
    let next = contact.patches.partition_point(|patch| patch.last < spring);
    Some(Probe {
        spring,
        height: contact.height(spring),
        level: contact.level(),
        patch: contact.patches.get(next).filter(|patch| patch.first <= spring).map(|_| next),
    })
}

/// Range of indentations of a scene's curves, m.
fn range_of(computed: &SolvedScene) -> f64 {
    let points = computed.outcome.history.legs.iter().flat_map(|leg| &leg.curve);
    let (low, high) = points.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
        (low.min(point.indentation), high.max(point.indentation))
    });
    (high - low).max(0.0)
}

/// The springs of the profile pane: a part within the line.
fn profile_part(request: &SnapshotRequest, count: usize, close_up: usize) -> Part {
    let LineView { centre, share, follow } = request.profile;
    let springs = ((count as f64 * share).round() as usize).clamp(1, count.max(1));
    let middle = if follow { close_up } else { (count as f64 * centre) as usize };
    let first = middle.saturating_sub(springs / 2).min(count.saturating_sub(springs));
    Part { first, springs, columns: request.profile_columns }
}
