//! The thread of the studies: the newest order wins.

use super::common::deadline::within;
use super::*;
use asperity::explorer::studies::{Finding, Findings, StudyThread};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

const PATIENCE: Duration = Duration::from_secs(20);

/// A study that reports its key, waits until it is stopped, and reports too late.
fn endless(key: u32, events: &Sender<String>) -> Study {
    let events = events.clone();
    Study::new(key, false, move |_, mut control| {
        control.report(key);
        events.send(format!("{key} begun")).unwrap();
        while !control.is_stopped() {
            std::thread::yield_now();
        }
        control.report(0);
        events.send(format!("{key} stopped")).unwrap();
        Ok::<u32, String>(0)
    })
}

fn thread() -> (StudyThread, Receiver<Finding>) {
    let (report, findings) = channel();
    (
        StudyThread::start(move |finding| report.send(finding).unwrap()).unwrap(),
        findings,
    )
}

#[test]
fn a_study_ends_as_soon_as_another_one_is_ordered() {
    within(60, || {
        let ((thread, findings), (sender, events)) = (thread(), channel());
        let next = || events.recv_timeout(PATIENCE).unwrap();
        let mut known = Findings::default();
        for key in 1..=3 {
            let studies = vec![endless(key, &sender)];
            thread.ask(known.begin(studies));
            if key > 1 {
                assert_eq!(next(), format!("{} stopped", key - 1));
            }
            assert_eq!(next(), format!("{key} begun"));
            known.take_in(findings.recv_timeout(PATIENCE).unwrap());
            assert_eq!(known.value::<u32>(), Some(&key), "and nothing too late");
        }
        thread.stop();
        assert_eq!(next(), "3 stopped");
        drop(thread);
        assert!(
            findings.recv_timeout(PATIENCE).is_err(),
            "the thread ends with the explorer"
        );
    });
}

#[test]
fn a_key_held_down_begins_nothing() {
    within(60, || {
        let ((thread, findings), (sender, events)) = (thread(), channel());
        for key in 1..=50 {
            thread.stop();
            thread.ask(vec![endless(key, &sender)]);
        }
        assert_eq!(events.recv_timeout(PATIENCE).unwrap(), "50 begun");
        thread.stop();
        assert_eq!(events.recv_timeout(PATIENCE).unwrap(), "50 stopped");
        assert_eq!(findings.try_iter().count(), 1);
    });
}

#[test]
fn a_value_belongs_to_its_key_and_a_panic_is_a_reason() {
    let perform = |known: &mut Findings, study: Study| {
        for study in known.begin(vec![study]) {
            let mut found = Vec::new();
            study.perform(&mut Simulation::default(), &|| false, &mut |finding| {
                found.push(finding)
            });
            found.into_iter().for_each(|finding| known.take_in(finding));
        }
    };
    let sum = |key: &str, value: u32| Study::new(key, false, move |_, _| Ok::<u32, String>(value));
    let mut known = Findings::default();
    perform(&mut known, sum("a", 1));
    perform(&mut known, sum("a", 2));
    assert_eq!(
        (known.value::<u32>(), known.is_done::<u32>()),
        (Some(&1), true),
        "computed once"
    );
    perform(&mut known, sum("b", 3));
    assert_eq!(known.value::<u32>(), Some(&3));
    // A finding of a dropped value, or of another key, changes nothing.
    let mut late = Vec::new();
    sum("a", 4).perform(&mut Simulation::default(), &|| false, &mut |finding| {
        late.push(finding)
    });
    late.iter()
        .for_each(|finding| known.take_in(finding.clone()));
    assert_eq!(known.value::<u32>(), Some(&3));
    known.keep(&["a"]);
    late.into_iter().for_each(|finding| known.take_in(finding));
    assert_eq!(known.value::<u32>(), None);
    perform(
        &mut known,
        Study::new("c", false, |_, _| -> Result<u32, String> {
            panic!("no such spring")
        }),
    );
    assert!(
        known
            .failure::<u32>()
            .is_some_and(|why| why.contains("internal error"))
    );
}
