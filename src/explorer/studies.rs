//! Values computed after the outcome: its error, springs for a tolerance, data of a shown pane, the
//! curve for a typed value. The explorer holds one value of each type, with a key for what it was
//! computed from. A thread of its own performs the newest order of studies; a newer order ends it.

use crate::explorer::advice;
use asperity_data::Control;
use asperity_data::Remedied;
use asperity_scene::{Scene, Simulation};
use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// Time between a change of the scene and the beginning of a study: a key held down needs the
/// machine.
const QUIET: Duration = Duration::from_millis(300);

type Value = Arc<dyn Any + Send + Sync>;

/// Computation of a value, on a simulation that other studies may have used. Parts of the value are
/// reported as they are computed.
type Run = dyn FnOnce(&mut Simulation, Control<'_, Value>) -> Result<Value, String> + Send;

pub struct Study {
    kind: TypeId,
    key: String,
    /// True if a demo leaves the study out, since viewers would have to wait or results differ from
    /// run to run.
    pub is_long: bool,
    run: Box<Run>,
}

impl Study {
    /// Creates a study; its key identifies the scene or the parameters it depends on. The value so
    /// far is shown whenever `run` reports it.
    pub fn new<T: Any + Clone + Send + Sync, E: Remedied>(
        key: impl ToString,
        is_long: bool,
        run: impl FnOnce(&mut Simulation, Control<'_, T>) -> Result<T, E> + Send + 'static,
    ) -> Self {
        let run: Box<Run> = Box::new(move |simulation, mut control| {
            let control_of_value = control.of_part();
            let mut report = |part: &T| {
                let part: Value = Arc::new(part.clone());
                control.report(part);
            };
            let value = run(simulation, control_of_value.reporting_to(&mut report))
                .map_err(|error| error.in_words(advice::row))?;
            Ok(Arc::new(value))
        });
        Study {
            kind: TypeId::of::<T>(),
            key: key.to_string(),
            is_long,
            run,
        }
    }

    /// Returns true if the study computes a value of this type.
    pub fn is<T: Any>(&self) -> bool {
        self.kind == TypeId::of::<T>()
    }

    /// Performs the study. Nothing is reported once `stop` has returned true; a panic counts as a
    /// failure.
    pub fn perform(
        self,
        simulation: &mut Simulation,
        stop: &(dyn Fn() -> bool + Sync),
        report: &mut dyn FnMut(Finding),
    ) {
        let Study { kind, key, run, .. } = self;
        let mut report = |value, end| {
            if !stop() {
                report(Finding {
                    kind,
                    slot: Slot {
                        key: key.clone(),
                        value,
                        end,
                    },
                });
            }
        };
        let mut report_part = |part: &Value| report(Some(Arc::clone(part)), None);
        let control = Control::default()
            .stopped_by(stop)
            .reporting_to(&mut report_part);
        let done = catch_unwind(AssertUnwindSafe(|| run(simulation, control)));
        match done {
            Ok(Ok(value)) => report(Some(value), Some(Ok(()))),
            Ok(Err(why)) => report(None, Some(Err(why))),
            Err(_) => {
                *simulation = Simulation::default();
                report(
                    None,
                    Some(Err("internal error, please report it".to_owned())),
                );
            }
        }
    }
}

/// Key of the random profiles of a scene, which do not depend on its texts.
pub fn ensemble_key(scene: &Scene) -> String {
    let scene = Scene {
        title: String::new(),
        notice: String::new(),
        observe: Vec::new(),
        ..scene.clone()
    };
    format!("ensemble of {scene:?}")
}

/// Part of a value, or the end of a study.
#[derive(Clone, Debug)]
pub struct Finding {
    kind: TypeId,
    slot: Slot,
}

/// A value so far, and how its study ended if it has.
#[derive(Clone, Debug)]
struct Slot {
    key: String,
    value: Option<Value>,
    end: Option<Result<(), String>>,
}

/// Values of the studies so far, one of each type.
#[derive(Clone, Debug, Default)]
pub struct Findings(HashMap<TypeId, Slot>);

impl Findings {
    fn slot<T: Any>(&self) -> Option<&Slot> {
        self.0.get(&TypeId::of::<T>())
    }

    /// The value of a type so far.
    pub fn value<T: Any>(&self) -> Option<&T> {
        self.slot::<T>()?.value.as_ref()?.downcast_ref()
    }

    /// Returns true if the value of a type is complete.
    pub fn is_done<T: Any>(&self) -> bool {
        self.slot::<T>()
            .is_some_and(|slot| slot.end == Some(Ok(())))
    }

    /// Reason why the value of a type is missing or incomplete, if its study failed.
    pub fn failure<T: Any>(&self) -> Option<&str> {
        self.slot::<T>()?
            .end
            .as_ref()?
            .as_ref()
            .err()
            .map(String::as_str)
    }

    /// Sets a value; complete, or to be completed by a study with this key.
    pub fn set<T: Any + Send + Sync>(&mut self, key: impl ToString, value: T, is_done: bool) {
        let end = is_done.then_some(Ok(()));
        self.0.insert(
            TypeId::of::<T>(),
            Slot {
                key: key.to_string(),
                value: Some(Arc::new(value)),
                end,
            },
        );
    }

    pub fn forget<T: Any>(&mut self) {
        self.0.remove(&TypeId::of::<T>());
    }

    /// Drops all values except values with one of these keys.
    pub fn keep(&mut self, keys: &[&str]) {
        self.0.retain(|_, slot| keys.contains(&slot.key.as_str()));
    }

    /// Stores a finding, unless its value was dropped or depends on another key by now.
    pub fn take_in(&mut self, finding: Finding) {
        if let Some(slot) = self
            .0
            .get_mut(&finding.kind)
            .filter(|slot| slot.key == finding.slot.key)
        {
            slot.value = finding.slot.value.or(slot.value.take());
            slot.end = finding.slot.end;
        }
    }

    /// Returns the studies among these that have not ended; their findings will be stored.
    pub fn begin(&mut self, studies: Vec<Study>) -> Vec<Study> {
        let is_open = |study: &Study| {
            let slot = self.0.entry(study.kind).or_insert_with(|| Slot {
                key: study.key.clone(),
                value: None,
                end: None,
            });
            if slot.key != study.key {
                (slot.key, slot.end) = (study.key.clone(), None);
            }
            slot.end.is_none()
        };
        studies.into_iter().filter(is_open).collect()
    }
}

pub struct StudyThread {
    orders: Sender<(u64, Vec<Study>)>,
    newest: Arc<AtomicU64>,
}

impl StudyThread {
    /// Starts the thread of the studies. `report` receives the findings.
    pub fn start(report: impl Fn(Finding) + Send + 'static) -> std::io::Result<Self> {
        let (orders, inbox) = channel();
        let newest = Arc::new(AtomicU64::new(0));
        let watched = Arc::clone(&newest);
        let serve = move || serve(&watched, &inbox, &report);
        std::thread::Builder::new()
            .name("studies".to_owned())
            .spawn(serve)?;
        Ok(StudyThread { orders, newest })
    }

    /// Ends the running studies and performs these in their place.
    pub fn ask(&self, studies: Vec<Study>) {
        let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        // The thread only ends with the explorer.
        let _ = self.orders.send((number, studies));
    }

    /// Ends the running studies because the scene changes; the next ones wait for a quiet time.
    pub fn stop(&self) {
        self.ask(Vec::new());
    }
}

/// Performs the newest order, again and again, until the explorer is gone.
fn serve(newest: &AtomicU64, orders: &Receiver<(u64, Vec<Study>)>, report: &dyn Fn(Finding)) {
    let mut simulation = Simulation::default();
    let mut begin = Instant::now();
    let mut next = None;
    while let Some((number, studies)) = next.take().or_else(|| orders.recv().ok()) {
        if studies.is_empty() {
            begin = Instant::now() + QUIET;
            continue;
        }
        match orders.recv_timeout(begin.saturating_duration_since(Instant::now())) {
            Ok(newer) => next = Some(newer),
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                let stop = || newest.load(Ordering::Relaxed) != number;
                for study in studies.into_iter().take_while(|_| !stop()) {
                    study.perform(&mut simulation, &stop, &mut |finding| report(finding));
                }
            }
        }
    }
}
