//! The body under manual loading. It follows the stages of a path one after the other, each in one
//! exact motion, just as a scene with these stages as its loading does.

use super::events::{LeastShare, MOST_LISTED};
use asperity_contact::motion::{Body, JumpCollector, MovingBody, Stage};
use asperity_contact::{Contact, ContactError, CurvePoint, Events, Move, StageRecord};
use asperity_data::format_quantity;
use asperity_scene::workload::Reach;

/// Largest memory in bytes for the bodies after earlier stages. If they need more, the oldest ones
/// are dropped, and computed again when they are needed.
const BYTES_KEPT: usize = 1 << 28;

/// Reason why a body that relaxes cannot be moved by hand.
pub const NEEDS_TIMES: &str = "a body that relaxes is not moved by hand, because its force depends \
                               on the time: use stages and hold, or relaxation none";

pub struct ManualBody {
    start: Body,
    /// True if the foundation relaxes. The body then follows no stage.
    relaxes: bool,
    reach: Reach,
    /// Largest memory in bytes for the bodies after earlier stages.
    bytes_kept: usize,
    records: Vec<StageRecord>,
    /// Jumps of all stages.
    jumps: JumpCollector,
    /// Bodies after some of the stages, in the order of the stages. If there are any stages, the
    /// last body is the present one.
    kept: Vec<KeptBody>,
}

/// The body after a number of stages.
#[derive(Clone)]
struct KeptBody {
    stages: usize,
    body: Body,
}

impl ManualBody {
    /// Creates a separated body. The force curve of each stage is computed at `samples` points.
    pub fn new(contact: &Contact, samples: usize) -> Self {
        ManualBody {
            start: Body::new(contact, samples),
            relaxes: false,
            reach: Reach::of(contact),
            bytes_kept: BYTES_KEPT,
            records: Vec::new(),
            jumps: JumpCollector::default(),
            kept: Vec::new(),
        }
    }

    /// Creates a body on a foundation that relaxes. It follows no stage.
    pub fn relaxing(contact: &Contact, samples: usize) -> Self {
        ManualBody {
            relaxes: true,
            ..ManualBody::new(contact, samples)
        }
    }

    pub fn records(&self) -> &[StageRecord] {
        &self.records
    }

    /// Lists the events of all stages.
    pub fn events(&self, least_share: LeastShare) -> Result<Events, ContactError> {
        self.jumps
            .events(&self.records, least_share.value(), MOST_LISTED)
    }

    pub fn point(&self) -> CurvePoint {
        self.present().point()
    }

    pub fn stage(&self) -> Stage {
        self.present().stage()
    }

    fn present(&self) -> &Body {
        self.kept.last().map_or(&self.start, |kept| &kept.body)
    }

    /// Moves the body along these stages, beginning at separation. Stages that the body has
    /// followed already are not computed again. Returns the reason if the contact cannot follow a
    /// stage; the body then stays at the end of the stage before.
    ///
    /// # Errors
    /// Returns an error if `stop` returns true between two stages.
    pub fn follow(
        &mut self,
        stages: &[Move],
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<String>, ContactError> {
        if self.relaxes {
            return Ok(Some(NEEDS_TIMES.to_owned()));
        }
        let followed = self.records.iter().zip(stages);
        let same = followed
            .take_while(|(record, stage)| record.target == **stage)
            .count();
        if let Err(why) = self.go_back(same) {
            // There is not enough memory to follow the earlier stages again.
            self.records.clear();
            self.jumps = JumpCollector::default();
            self.kept.clear();
            return Ok(Some(why.to_string()));
        }
        for &stage in &stages[same..] {
            if stop() {
                return Err(ContactError::Interrupted);
            }
            if let Err(why) = self.advance(stage) {
                return Ok(Some(why));
            }
        }
        Ok(None)
    }

    /// Moves the body to the target of one stage, or returns the reason why it cannot get there.
    fn advance(&mut self, target: Move) -> Result<(), String> {
        if let Some(beyond) = self.reach.beyond(target) {
            let found = format_quantity(beyond.found, beyond.unit);
            let full_contact = format_quantity(beyond.full_contact, beyond.unit);
            return Err(format!(
                "{found} is far beyond full contact at {full_contact}"
            ));
        }
        let mut body = self.present().clone();
        let record = body.advance(target);
        let record = record.map_err(|error| error.in_words(target))?;
        self.jumps
            .observe(&record, &body.stage())
            .map_err(|error| error.in_words(target))?;
        self.records.push(record);
        self.keep(body);
        Ok(())
    }

    /// Keeps the body after the last stage.
    fn keep(&mut self, body: Body) {
        self.kept.push(KeptBody {
            stages: self.records.len(),
            body,
        });
        let bytes = self.kept.iter().map(|kept| kept.body.stage().bytes());
        let mut bytes: usize = bytes.sum();
        // The last stage is often replaced by a longer one. Therefore the body before it is always
        // kept.
        while bytes > self.bytes_kept && self.kept.len() > 2 {
            let oldest = self.kept.remove(0);
            bytes -= oldest.body.stage().bytes();
        }
    }

    /// Moves the body back to its state after the first `count` stages.
    fn go_back(&mut self, count: usize) -> Result<(), ContactError> {
        if count == self.records.len() {
            return Ok(());
        }
        let body = self.body_after(count)?;
        self.records.truncate(count);
        self.jumps.truncate(count);
        self.kept.retain(|kept| kept.stages < count);
        if count > 0 {
            self.keep(body);
        }
        Ok(())
    }

    /// Returns the stage of the stage with this index, counted from 0.
    pub fn stage_of(&self, stage: usize) -> Result<Stage, ContactError> {
        Ok(self.body_after(stage + 1)?.stage())
    }

    /// Returns the body after the first `count` stages. If it is not kept, it is moved there again
    /// from the last kept state before.
    fn body_after(&self, count: usize) -> Result<Body, ContactError> {
        let mut earlier = self.kept.iter().rev();
        let kept = earlier.find(|kept| kept.stages <= count);
        let (mut body, from) = match kept {
            Some(kept) => (kept.body.clone(), kept.stages),
            None => (self.start.clone(), 0),
        };
        for record in self.records.iter().take(count).skip(from) {
            body.advance(record.target)?;
        }
        Ok(body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_contact::motion::load_body;
    use asperity_scene::{Simulation, open};

    const STAGES: [Move; 6] = [
        Move::ToForce(1.0e-5),
        Move::ToIndentation(4.0e-7),
        Move::ToForce(2.0e-5),
        Move::ToZeroForce,
        Move::ToForce(1.5e-5),
        Move::ToSeparation,
    ];

    fn contact() -> Contact {
        let scene = open("pressure-sensitive").unwrap();
        let scene = scene.set("numerics.points", "1024").unwrap();
        Simulation::default().contact(scene.scene()).unwrap().0
    }

    /// Follows the stages and checks that the body is that of a fresh run.
    fn check(body: &mut ManualBody, stages: &[Move]) {
        assert_eq!(body.follow(stages, &|| false), Ok(None));
        let mut fresh = Body::new(&contact(), 64);
        let mut motions = Vec::new();
        let history = load_body(&mut fresh, stages, |_, motion| {
            motions.push(motion.clone());
            Ok(())
        });
        assert_eq!(body.records(), history.unwrap().stages);
        assert_eq!(body.point(), fresh.point());
        for (number, motion) in motions.iter().enumerate() {
            let found = body.stage_of(number).unwrap();
            let middle = 0.5 * (body.records()[number].start() + body.records()[number].end());
            assert_eq!(found.point(middle), motion.point(middle));
        }
    }

    #[test]
    fn with_and_without_kept_bodies_it_goes_back_and_on() {
        for bytes_kept in [0, 20_000, BYTES_KEPT] {
            let mut body = ManualBody {
                bytes_kept,
                ..ManualBody::new(&contact(), 64)
            };
            for count in [1, 3, 6, 5, 2, 6, 0, 4] {
                check(&mut body, &STAGES[..count]);
            }
            let other = [STAGES[0], Move::ToTouch, STAGES[2], Move::ToSeparation];
            check(&mut body, &other);
        }
    }

    #[test]
    fn it_stays_before_a_stage_that_it_cannot_follow() {
        let mut body = ManualBody::new(&contact(), 64);
        let far = [STAGES[0], Move::ToForce(-1.0), Move::ToForce(2.0e-5)];
        let why = body.follow(&far, &|| false).unwrap().unwrap();
        assert!(why.starts_with("the contact detaches before -1 N"), "{why}");
        assert_eq!(body.records().len(), 1);
        let deep = [STAGES[0], Move::ToForce(1.0e3)];
        let why = body.follow(&deep, &|| false).unwrap().unwrap();
        assert!(
            why.starts_with("1 kN is far beyond full contact at "),
            "{why}"
        );
        check(&mut body, &STAGES);
        let stopped = body.follow(&[Move::ToTouch], &|| true);
        assert_eq!(stopped, Err(ContactError::Interrupted));
        check(&mut body, &STAGES);
    }
}
