//! Studies: background computations that follow the computation of a scene. Examples are the error
//! of the outcome, the number of springs for a tolerance, the data of a shown pane, and the curve
//! for a typed value.
//!
//! Each study has a value of its own type. The explorer holds one value of each type, with a key
//! that identifies the data from which it was computed. A separate thread performs the newest list
//! of studies, and stops when a newer list arrives.

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

/// Time between the last change of the scene and the start of the studies. While the user holds a
/// key, the scene changes all the time, and the solver needs the whole computer.
const QUIET: Duration = Duration::from_millis(300);

type Value = Arc<dyn Any + Send + Sync>;

/// Function that computes a value. Its simulation may have been used by other studies before. The
/// function can report intermediate values.
type Run = dyn FnOnce(&mut Simulation, Control<'_, Value>) -> Result<Value, String> + Send;

pub struct Study {
    kind: TypeId,
    key: String,
    /// True if demos leave the study out, because viewers would have to wait for it or because its
    /// result differs each time the demo is played.
    pub is_long: bool,
    run: Box<Run>,
}

impl Study {
    /// Creates a study (background computation) that `run` performs. `key` identifies the scene or
    /// the parameters on which the value of the study depends. The explorer shows each intermediate
    /// value that `run` reports.
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

    /// Returns true if this study computes a value of the type `T`.
    pub fn is<T: Any>(&self) -> bool {
        self.kind == TypeId::of::<T>()
    }

    /// Performs the study (background computation) and reports its value. After `stop` has returned
    /// true, nothing is reported. A panic counts as a failure of the study.
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

/// Returns the key for studies (background computations) on random profiles of a scene. It does not
/// depend on the texts of the scene, such as its title.
pub fn profiles_key(scene: &Scene) -> String {
    let scene = Scene {
        title: String::new(),
        notice: String::new(),
        observe: Vec::new(),
        ..scene.clone()
    };
    format!("profiles of {scene:?}")
}

/// Returns the key of the study (background computation) of a number of random profiles of a scene.
pub fn ensemble_key(profiles: u64, scene: &Scene) -> String {
    format!("{profiles} {}", profiles_key(scene))
}

/// Message from a study (background computation): its intermediate value, or the result with which
/// the study ended.
#[derive(Clone, Debug)]
pub struct Finding {
    kind: TypeId,
    slot: Slot,
}

/// Newest value of a study, possibly intermediate. If the study has ended, `end` is its result.
#[derive(Clone, Debug)]
struct Slot {
    key: String,
    value: Option<Value>,
    end: Option<Result<(), String>>,
}

/// Newest value of each study (background computation). There is at most one value of each type.
#[derive(Clone, Debug, Default)]
pub struct Findings {
    slots: HashMap<TypeId, Slot>,
    /// Final values of the scene before the last change.
    former: HashMap<TypeId, Value>,
}

impl Findings {
    fn slot<T: Any>(&self) -> Option<&Slot> {
        self.slots.get(&TypeId::of::<T>())
    }

    /// Returns the newest value of the type `T`, which may be an intermediate value; `None` if
    /// there is no value of this type.
    pub fn value<T: Any>(&self) -> Option<&T> {
        self.slot::<T>()?.value.as_ref()?.downcast_ref()
    }

    /// Returns true if there is a value of the type `T` and it is final.
    pub fn is_done<T: Any>(&self) -> bool {
        self.slot::<T>()
            .is_some_and(|slot| slot.end == Some(Ok(())))
    }

    /// Returns the reason why the study with a value of the type `T` failed; `None` if it has not
    /// failed.
    pub fn failure<T: Any>(&self) -> Option<&str> {
        self.slot::<T>()?
            .end
            .as_ref()?
            .as_ref()
            .err()
            .map(String::as_str)
    }

    /// Returns true if all studies that have begun have ended.
    pub fn are_all_done(&self) -> bool {
        self.slots.values().all(|slot| slot.end.is_some())
    }

    /// Sets the value of the type `T`. If `is_done` is true, the value is final. Otherwise the
    /// study with this key still has to compute the final value.
    pub fn set<T: Any + Send + Sync>(&mut self, key: impl ToString, value: T, is_done: bool) {
        let end = is_done.then_some(Ok(()));
        self.slots.insert(
            TypeId::of::<T>(),
            Slot {
                key: key.to_string(),
                value: Some(Arc::new(value)),
                end,
            },
        );
    }

    pub fn forget<T: Any>(&mut self) {
        self.slots.remove(&TypeId::of::<T>());
    }

    /// Removes all values whose key is not one of `keys`. The final values among them can still be
    /// shown as former values.
    pub fn keep(&mut self, keys: &[&str]) {
        let is_kept = |slot: &Slot| keys.contains(&slot.key.as_str());
        for (kind, slot) in &self.slots {
            if let Some(value) = &slot.value
                && slot.end == Some(Ok(()))
                && !is_kept(slot)
            {
                self.former.insert(*kind, Arc::clone(value));
            }
        }
        self.slots.retain(|_, slot| is_kept(slot));
    }

    /// Removes the former values, because another scene is shown.
    pub fn forget_former(&mut self) {
        self.former.clear();
    }

    /// Returns the last final value of the type `T` that was removed because the scene has changed;
    /// `None` if there is none.
    pub fn former<T: Any>(&self) -> Option<&T> {
        self.former.get(&TypeId::of::<T>())?.downcast_ref()
    }

    /// Stores a message from a study. The message is ignored if the value of this type has been
    /// removed or now has another key.
    pub fn take_in(&mut self, finding: Finding) {
        if let Some(slot) = self
            .slots
            .get_mut(&finding.kind)
            .filter(|slot| slot.key == finding.slot.key)
        {
            slot.value = finding.slot.value.or(slot.value.take());
            slot.end = finding.slot.end;
        }
    }

    /// Returns those studies (background computations) of the list that have not ended yet. From
    /// now on, the messages of the listed studies are stored.
    pub fn begin(&mut self, studies: Vec<Study>) -> Vec<Study> {
        let is_open = |study: &Study| {
            let slot = self.slots.entry(study.kind).or_insert_with(|| Slot {
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
    /// Starts the thread that performs the studies (background computations). `report` receives the
    /// messages of the studies.
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

    /// Stops the studies (background computations) that are being performed, and starts the studies
    /// `studies`.
    pub fn ask(&self, studies: Vec<Study>) {
        let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
        // Sending cannot fail, because the thread ends only together with the explorer.
        let _ = self.orders.send((number, studies));
    }

    /// Stops all studies because the scene has changed. The next studies start after the scene has
    /// stayed unchanged for the time `QUIET`.
    pub fn stop(&self) {
        self.ask(Vec::new());
    }
}

/// Performs lists of studies until the explorer ends. When a newer list arrives, the present one
/// stops.
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
