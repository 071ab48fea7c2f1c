//! Stand-in for the studies beside the worker: returns the answers of a test, so that nothing depends on time.

use asperity::accuracy::{Choice, ChoiceError, Estimate};
use asperity::explorer::snapshot::SolvedScene;
use asperity::explorer::study::{Appraiser, PaneData};
use asperity::scene::Scene;
use std::sync::mpsc::Sender;

/// Receiver of data of a pane.
pub type Reported<'a> = &'a mut dyn FnMut(PaneData);
/// Extension of data of a pane, with a question for the end.
type Extension = dyn FnMut(PaneData, &dyn Fn() -> bool, Reported<'_>) -> Result<PaneData, String> + Send;
/// Choice of the number of springs for a tolerance.
type Chosen = fn(f64, &mut dyn FnMut(u64)) -> Result<Choice, ChoiceError>;

/// A stand-in; by default there is no estimate and no choice of a number of springs.
pub struct StandIn {
    pub estimate: Option<Estimate>,
    pub choose: Chosen,
    pub extend: Box<Extension>,
}

impl StandIn {
    pub fn new(
        extend: impl FnMut(PaneData, &dyn Fn() -> bool, Reported<'_>) -> Result<PaneData, String> + Send + 'static,
    ) -> Self {
        let choose: Chosen = |_, _| Err(ChoiceError::Stepwise);
        StandIn { estimate: None, choose, extend: Box::new(extend) }
    }

    /// Extends data until stopped, and reports too late; sends a message when it begins to wait and when it has
    /// stopped.
    pub fn endless(
        sender: Sender<&'static str>,
        mut extend: impl FnMut(PaneData, Reported<'_>) -> PaneData + Send + 'static,
    ) -> Self {
        StandIn::new(move |data, stop, report| {
            let data = extend(data, report);
            sender.send("begun").unwrap();
            while !stop() {
                std::thread::yield_now();
            }
            report(data.clone());
            sender.send("stopped").unwrap();
            Ok(data)
        })
    }
}

impl Appraiser for StandIn {
    fn estimate(&mut self, _: &SolvedScene, _: &dyn Fn() -> bool) -> Option<Estimate> {
        self.estimate.clone()
    }

    fn choose(
        &mut self,
        _: &Scene,
        tolerance: f64,
        _: &dyn Fn() -> bool,
        trying: &mut dyn FnMut(u64),
    ) -> Result<Choice, ChoiceError> {
        (self.choose)(tolerance, trying)
    }

    fn extend(
        &mut self,
        data: PaneData,
        stop: &dyn Fn() -> bool,
        report: &mut dyn FnMut(PaneData),
    ) -> Result<PaneData, String> {
        (self.extend)(data, stop, report)
    }
}
