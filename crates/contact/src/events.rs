//! The events of a loading: the jumps of all stages and the marked points of the force curve, in
//! the order of the motion.

use super::error::ContactError;
use super::figures::{Mark, MarkedPoint};
use super::history::{Direction, StageRecord};
use super::motion::Stage;
use super::stage::forces::InstrumentJump;
use super::stage::jumps::Jump;
use std::cmp::Ordering;

/// A mark shares the event of a jump that follows it within this share of the range of
/// indentations.
const NEAR: f64 = 1e-3;

/// Collects the jumps of a loading, stage after stage, while the loading is computed.
///
/// ```
/// use asperity_contact::motion::{JumpCollector, JumpKind};
/// use asperity_contact::{Contact, LoadOptions, Mark, Modulus, Move, Profile};
///
/// # let gaps: Vec<f64> = (-512..=512).map(|i| (f64::from(i) * 1.0e-7).powi(2) / 1.0e-4).collect();
/// # let sphere = Profile::from_gaps(gaps, 1.0e-7)?;
/// # let contact = Contact::builder(&sphere, Modulus::effective(1.0e6)?)
/// #     .work_of_adhesion(0.05)
/// #     .build()?;
/// let mut jumps = JumpCollector::default();
/// let options = LoadOptions::default().jumps(&mut jumps);
/// let cycle = contact.load_with(&[Move::ToForce(1.0e-4), Move::ToSeparation], options)?;
/// // A sphere jumps into contact and out of it. Between the two jumps its edges slide.
/// let events = jumps.events(cycle.stages(), 0.01, 4096)?;
/// let marks: Vec<Option<Mark>> = events.list.iter().map(|event| event.mark).collect();
/// use Mark::{JumpIn, JumpOut, Preload, PullOff};
/// assert_eq!(marks, [Some(JumpIn), Some(Preload), Some(PullOff), Some(JumpOut)]);
/// assert_eq!(events.list[0].jump.unwrap().kind, JumpKind::Touches);
/// assert_eq!((events.list[0].forces[0], events.list[3].forces[1]), (0.0, 0.0));
/// # Ok::<(), asperity_contact::ContactError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct JumpCollector {
    stages: Vec<JumpsOfStage>,
}

/// All jumps of one stage in the order of the motion, and the motion itself.
#[derive(Clone, Debug)]
struct JumpsOfStage {
    stage: Stage,
    jumps: Vec<Jump>,
    /// Jumps of the instrument.
    instrument: Vec<InstrumentJump>,
    /// Extreme compression in m of contact and instrument together on the motions in this
    /// direction, up to the end of the stage; `None` if no instrument jumps.
    extreme: Option<f64>,
}

/// The events of a loading, as [`JumpCollector::events`] chooses them.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Events {
    /// The chosen jumps and all marks, in the order of the motion.
    pub list: Vec<Event>,
    /// Number of all jumps of the loading.
    pub jumps: usize,
    /// Number of the jumps in `list`.
    pub listed_jumps: usize,
    /// Elastic energy in J that springs gain in all jumps of the loading.
    pub gained: f64,
    /// Elastic energy in J that springs release in all jumps of the loading, a positive number.
    pub released: f64,
}

/// Event of a loading: a jump of the contact, a marked point of the force curve, or both, or a jump
/// of the instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// Index of the loading stage, from 0.
    pub stage: usize,
    /// Indentation in m.
    pub indentation: f64,
    /// Time in s since first touch; `None` without [relaxation](crate::Relaxation), because time
    /// then has no effect.
    pub seconds: Option<f64>,
    /// Force of the whole contact in N before and after the event. Both are equal unless the
    /// contact jumps.
    pub forces: [f64; 2],
    /// Mark of the force curve at this point, or just before the jump.
    pub mark: Option<Mark>,
    /// Jump of the contact.
    pub jump: Option<Jump>,
    /// Jump of a compliant instrument, which begins at this indentation. Such an event has neither
    /// mark nor jump of the contact. The energies of all jumps of a stage add up to
    /// [`StageRecord::jump_energy`].
    pub instrument: Option<InstrumentJump>,
}

impl Event {
    fn new(stage: usize, indentation: f64, forces: [f64; 2]) -> Self {
        Event {
            stage,
            indentation,
            seconds: None,
            forces,
            mark: None,
            jump: None,
            instrument: None,
        }
    }
}

impl JumpCollector {
    /// Adds the jumps of a stage that has just been computed. Single jumps are not known on a
    /// foundation that [relaxes](crate::Relaxation). No jump is then added, and the events of the
    /// loading are only the marks of the force curve.
    ///
    /// # Errors
    /// Returns [`ContactError::Stepwise`] if the stage was computed by the [stepwise
    /// solver](crate::motion::Stepwise).
    pub fn observe(&mut self, record: &StageRecord, motion: &Stage) -> Result<(), ContactError> {
        let jumps = if record.times().is_some() {
            Vec::new()
        } else {
            let [low, high] = record.passed();
            motion.jumps(low, high)?
        };
        let mut extreme = self.extreme_before(record);
        let instrument = if record.jump_energy == 0.0 && extreme.is_none() {
            Vec::new()
        } else {
            motion.instrument_jumps(record, &mut extreme)?
        };
        self.stages.push(JumpsOfStage {
            stage: motion.clone(),
            jumps,
            instrument,
            extreme,
        });
        Ok(())
    }

    /// Returns the extreme compression that contact and instrument have reached before a motion in
    /// the same direction; `None` if the direction is new or the body touches.
    fn extreme_before(&self, record: &StageRecord) -> Option<f64> {
        let last = self.stages.last()?;
        let touches = record.curve.first().is_some_and(|point| point.springs == 0);
        let is_same = last.stage.direction() == record.direction;
        last.extreme.filter(|_| is_same && !touches)
    }

    /// Removes the jumps of all stages except the first `count` stages, for a body that returns to
    /// an earlier state.
    pub fn truncate(&mut self, count: usize) {
        self.stages.truncate(count);
    }

    /// Returns all jumps of a stage in the order of the motion. `stage` is the index of the stage,
    /// from 0.
    pub fn jumps(&self, stage: usize) -> &[Jump] {
        self.stages.get(stage).map_or(&[], |stage| &stage.jumps)
    }

    /// Returns the largest energy in J that springs gain or release in a jump; 0 if there is none.
    pub fn largest_energy(&self) -> f64 {
        let jumps = self.stages.iter().flat_map(|stage| &stage.jumps);
        jumps.fold(0.0, |largest, jump| jump.energy.abs().max(largest))
    }

    /// Returns the events of the loading, of which `stages` are the records. All marks of the force
    /// curve are listed. A jump is listed if its energy is at least `least_share` of the largest
    /// energy of a jump. If more than `most` jumps have such an energy, only the `most` jumps with
    /// the largest energies are listed.
    ///
    /// The forces of all patches are added up at each listed jump, which takes longer than to find
    /// the jumps.
    ///
    /// # Errors
    /// Returns [`ContactError::OutOfMemory`] if an array does not fit into memory.
    pub fn events(
        &self,
        records: &[StageRecord],
        least_share: f64,
        most: usize,
    ) -> Result<Events, ContactError> {
        let mut events = Events::default();
        for jump in self.stages.iter().flat_map(|stage| &stage.jumps) {
            events.jumps += 1;
            events.gained += jump.energy.max(0.0);
            events.released -= jump.energy.min(0.0);
        }
        let mut chosen = self.chosen_jumps(least_share, most).into_iter();
        let marks = Mark::all(records);
        let range = NEAR * range_of(records);
        for (stage, record) in records.iter().enumerate() {
            let mut of_stage = self.listed_jumps(stage, &chosen.next().unwrap_or_default())?;
            events.listed_jumps += of_stage.len();
            for marked in marks.iter().filter(|marked| marked.stage == stage) {
                add_mark(&mut of_stage, marked, record, range);
            }
            let of_instrument = self.listed_instrument_jumps(stage, least_share, most);
            for event in of_instrument {
                let place = of_stage.partition_point(|other| {
                    is_before(other.indentation, event.indentation, record.direction)
                });
                of_stage.insert(place, event);
            }
            events.list.extend(of_stage);
        }
        Ok(events)
    }

    /// Returns the places of the listed jumps among the jumps of each stage, in ascending order. Of
    /// jumps with the same energy the earlier ones are listed first.
    fn chosen_jumps(&self, least_share: f64, most: usize) -> Vec<Vec<usize>> {
        let least = least_share * self.largest_energy();
        let mut candidates = Vec::new();
        for (stage, of_stage) in self.stages.iter().enumerate() {
            for (place, jump) in of_stage.jumps.iter().enumerate() {
                let energy = jump.energy.abs();
                if energy >= least {
                    candidates.push(Candidate {
                        energy,
                        stage,
                        place,
                    });
                }
            }
        }
        if most < candidates.len() {
            candidates.select_nth_unstable_by(most, Candidate::before);
            candidates.truncate(most);
        }
        let mut chosen = vec![Vec::new(); self.stages.len()];
        for candidate in candidates {
            chosen[candidate.stage].push(candidate.place);
        }
        for of_stage in &mut chosen {
            of_stage.sort_unstable();
        }
        chosen
    }

    /// Returns the jumps of the instrument in a stage with at least `least_share` of the largest
    /// energy of a jump of the contact, and at most the `most` first of them. If the contact has no
    /// jumps, the largest energy is that of a jump of the instrument.
    fn listed_instrument_jumps(&self, stage: usize, least_share: f64, most: usize) -> Vec<Event> {
        let mut largest = self.largest_energy();
        if largest == 0.0 {
            let jumps = self.stages.iter().flat_map(|stage| &stage.instrument);
            largest = jumps.fold(0.0, |largest, jump| jump.energy.max(largest));
        }
        let mut events = Vec::new();
        let Some(of_stage) = self.stages.get(stage) else {
            return events;
        };
        for jump in &of_stage.instrument {
            if jump.energy < least_share * largest || events.len() == most {
                continue;
            }
            let stiffness = of_stage.stage.contact().loading_stiffness;
            let forces = [jump.from, jump.to].map(|end| stiffness * (jump.displacement - end));
            events.push(Event {
                instrument: Some(*jump),
                ..Event::new(stage, jump.from, forces)
            });
        }
        events
    }

    /// Returns the jumps of a stage at these places among all jumps of the stage.
    fn listed_jumps(&self, stage: usize, places: &[usize]) -> Result<Vec<Event>, ContactError> {
        let Some(JumpsOfStage {
            stage: motion,
            jumps,
            ..
        }) = self.stages.get(stage)
        else {
            return Ok(Vec::new());
        };
        let listed: Vec<Jump> = places.iter().map(|&place| jumps[place]).collect();
        let mut events = Vec::with_capacity(listed.len());
        for (jump, forces) in listed.iter().zip(motion.forces_at_jumps(&listed)?) {
            events.push(Event {
                jump: Some(*jump),
                ..Event::new(stage, jump.indentation, forces)
            });
        }
        Ok(events)
    }
}

/// A jump that may be listed.
struct Candidate {
    /// Magnitude of its energy in J.
    energy: f64,
    stage: usize,
    /// Index of the jump in the list of all jumps of the stage.
    place: usize,
}

impl Candidate {
    /// Returns [`Ordering::Less`] if this jump is listed before another one.
    fn before(&self, other: &Candidate) -> Ordering {
        let by_energy = other.energy.total_cmp(&self.energy);
        by_energy.then((self.stage, self.place).cmp(&(other.stage, other.place)))
    }
}

/// Returns the difference in m between the largest and the smallest indentation of a loading.
fn range_of(records: &[StageRecord]) -> f64 {
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for record in records {
        low = low.min(record.start()).min(record.end());
        high = high.max(record.start()).max(record.end());
    }
    (high - low).max(0.0)
}

/// Returns true if a motion in this direction passes one indentation before another one.
fn is_before(indentation: f64, other: f64, direction: Direction) -> bool {
    let order = indentation.total_cmp(&other);
    match direction {
        Direction::Loading => order == Ordering::Less,
        Direction::Unloading => order == Ordering::Greater,
    }
}

/// Adds a mark to the events of its stage, which are in the order of the motion. The mark is added
/// to a jump that follows it within the indentation `near` in m; otherwise it becomes an event of
/// its own.
fn add_mark(events: &mut Vec<Event>, marked: &MarkedPoint, record: &StageRecord, near: f64) {
    let point = marked.point;
    let place = events
        .partition_point(|event| is_before(event.indentation, point.indentation, record.direction));
    if let Some(next) = events.get_mut(place)
        && next.mark.is_none()
        && (next.indentation - point.indentation).abs() <= near
    {
        next.mark = Some(marked.mark);
        return;
    }
    let event = Event {
        mark: Some(marked.mark),
        seconds: marked.seconds,
        ..Event::new(marked.stage, point.indentation, [point.force; 2])
    };
    events.insert(place, event);
}
