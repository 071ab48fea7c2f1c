//! Studies in memory with preloads in N on an axis, and the pull-off force of one profile as a
//! function of the preload.

use super::axis::{Axis, Spacing, Target, check_ends, check_logarithm};
use super::error::StudyError;
use super::plan::PRELOAD;
use super::profiles::Stop;
use super::quantity::Quantity;
use super::results::Results;
use super::statistics::Statistics;
use asperity_contact::Move;
use asperity_data::{AxisScale, Control, parse_quantity};
use asperity_scene::fields::STAGE_FORCE;
use asperity_scene::{CheckedScene, RunError, Simulation};
use std::ops::RangeInclusive;

/// Number of preloads if the text of the axis does not state it.
const USUAL: usize = 64;
/// Part of error messages that says which texts of preloads are allowed.
const ALLOWED: &str = "two forces, and after colons the number of preloads and `log`, such as 0..20uN or 1e-8..1e-4:64:log";

/// Precision with which each step of a staircase is located, as a share of the axis of preloads.
const FINEST: f64 = 1.0 / 2048.0;
/// Relative difference up to which two pull-off forces count as equal.
pub(super) const SAME: f64 = 1e-9;

impl Axis {
    /// Allowed numbers of preloads on an axis, from the smallest to the largest.
    pub const PRELOADS: RangeInclusive<usize> = 2..=512;

    /// Reads preloads from text such as `1nN..20uN:64:log`: the first and the last preload, the
    /// number of preloads, and `log` for equal ratios of neighbouring preloads. If the number is
    /// left out, there are 64 preloads. If `log` is left out, neighbouring preloads have equal
    /// distances.
    ///
    /// # Errors
    /// Returns an error if the text has another form or if a number is not allowed.
    ///
    /// ```
    /// use asperity_study::Axis;
    ///
    /// let axis = Axis::parse_preloads("1nN..1uN:4:log").expect("two forces");
    /// assert_eq!(
    ///     (axis.values.len(), axis.values[0], axis.unit),
    ///     (4, 1e-9, "N")
    /// );
    /// assert!(
    ///     Axis::parse_preloads("2uN..1uN")
    ///         .unwrap_err()
    ///         .to_string()
    ///         .contains("`from` less than `to`")
    /// );
    /// ```
    pub fn parse_preloads(text: &str) -> Result<Axis, StudyError> {
        let mut parts = text.split(':').map(str::trim);
        let range = parts.next().unwrap_or_default();
        let ends = Axis::parse_range(range, "N").map_err(|error| match error {
            StudyError::Refused { found, .. } => StudyError::refused(None, found, ALLOWED),
            error => error,
        })?;
        let mut count = USUAL;
        let mut scale = AxisScale::Linear;
        for part in parts {
            match part.parse() {
                Ok(number) => count = number,
                Err(_) if part == "log" => scale = AxisScale::Logarithmic,
                Err(_) => return Err(StudyError::refused(None, format!("{part:?}"), ALLOWED)),
            }
        }
        Axis::of_preloads(ends, count, scale)
    }

    /// Reads a range from text such as `1uN..20uN` and returns its two ends in SI units. The first
    /// end must be the smaller one. `unit` is the expected SI unit, here `N`.
    ///
    /// # Errors
    /// Returns an error if the text has another form or another unit.
    ///
    /// ```
    /// assert_eq!(asperity_study::Axis::parse_range("1nm..2um", "m").ok(), Some((1e-9, 2e-6)));
    /// ```
    pub fn parse_range(text: &str, unit: &str) -> Result<(f64, f64), StudyError> {
        let allowed = "two numbers, such as 1..20";
        let Some((from, to)) = text.split_once("..") else {
            return Err(StudyError::refused(None, format!("{text:?}"), allowed));
        };
        match (parse_quantity(from, unit), parse_quantity(to, unit)) {
            (Ok(from), Ok(to)) => Ok((from, to)),
            (Err(error), _) | (_, Err(error)) => {
                Err(StudyError::refused(None, error.to_string(), allowed))
            }
        }
    }

    /// Creates an axis of `count` preloads in N. `ends` are the first and the last preload. The
    /// preloads have equal distances on a linear scale, and equal ratios of neighbouring preloads
    /// on a logarithmic scale.
    ///
    /// # Errors
    /// Returns an error if a preload or the number of preloads is not allowed.
    pub fn of_preloads(
        ends: (f64, f64),
        count: usize,
        scale: AxisScale,
    ) -> Result<Axis, StudyError> {
        let (from, to) = ends;
        check_ends(from, to, count as u64, *Axis::PRELOADS.end() as u64)?;
        let range = STAGE_FORCE.range;
        if !(range.contains(from) && range.contains(to)) {
            let found = format!("from {from:?} to {to:?}");
            return Err(StudyError::refused(None, found, format!("{range} N")));
        }
        let mut spacing = Spacing::Linear;
        if scale == AxisScale::Logarithmic {
            check_logarithm(from)?;
            spacing = Spacing::Logarithmic;
        }
        let low = scale.coordinate(from);
        let high = scale.coordinate(to);
        let mut values = vec![from];
        for index in 1..count - 1 {
            let share = index as f64 / (count - 1) as f64;
            values.push(scale.number(low + (high - low) * share).clamp(from, to));
        }
        values.push(to);
        Ok(Axis {
            spacing,
            values,
            ..Axis::of_preload()
        })
    }

    /// Returns an axis of preloads in N that has no values yet.
    pub(super) fn of_preload() -> Axis {
        Axis {
            path: PRELOAD.into(),
            name: "preload".into(),
            symbol: "F_n",
            unit: "N",
            spacing: Spacing::List,
            values: Vec::new(),
            target: Target::Preload { in_newtons: true },
        }
    }
}

/// Pull-off force of one profile as a function of the preload. The force rises in steps: at certain
/// preloads it jumps to a larger value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Staircase {
    /// Scale, linear or logarithmic, of the axis of preloads.
    pub scale: AxisScale,
    /// Two forces of a loop that turns at first touch, in N: the force at first touch, and the
    /// pull-off force F_a(d=0).
    pub touch: (f64, f64),
    /// Pull-off force F_a(F=0) in N of a loop that turns at zero force.
    pub zero_force: f64,
    /// Ascending preloads in N, each with the pull-off force in N after this preload. The pull-off
    /// force is 0 if the force of the unloading is never negative.
    pub forces: Vec<(f64, f64)>,
}

impl Staircase {
    /// Computes the pull-off force of a checked scene at the preloads in N of an axis. Further
    /// preloads are then added near the jumps of the pull-off force, until each jump lies between
    /// two preloads that differ by at most 1/2048 of the axis, on the scale of the axis. `control`
    /// receives the staircase after the preloads of the axis, and again after each refinement.
    ///
    /// # Errors
    /// Returns an error if a preload is below the force at first touch. The errors of
    /// [`Simulation::reverse`] are possible too.
    ///
    /// ```
    /// use asperity_data::{AxisScale, Control};
    /// use asperity_scene::{Simulation, open};
    /// use asperity_study::{Axis, Staircase};
    ///
    /// let scene = open("pressure-sensitive")?.set("numerics.points", "2048")?;
    /// let preloads = Axis::of_preloads((0.0, 4e-5), 9, AxisScale::Linear)?;
    /// let simulation = &mut Simulation::default();
    /// let stairs = Staircase::of(scene.scene(), &preloads, simulation, Control::default())?;
    /// assert!(stairs.is_whole());
    /// // The pull-off force never falls with the preload.
    /// assert!(stairs.forces.windows(2).all(|pair| pair[0].1 <= pair[1].1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        scene: &CheckedScene,
        preloads: &Axis,
        simulation: &mut Simulation,
        mut control: Control<'_, Staircase>,
    ) -> Result<Staircase, StudyError> {
        let stop = control.stop();
        let turns = turns_at(scene, &[Move::ToTouch, Move::ToZeroForce], simulation, stop)?;
        let touched = turns[0];
        let at_zero_force = turns[1];
        let below_touch = preloads
            .values
            .first()
            .filter(|preload| **preload < touched.force);
        if let Some(&preload) = below_touch {
            let touch = touched.force;
            return Err(RunError::BelowTouch { preload, touch }.into());
        }
        let mut staircase = Staircase {
            scale: preloads.scale(),
            touch: (touched.force, touched.pull_off_force),
            zero_force: at_zero_force.pull_off_force,
            forces: Vec::new(),
        };
        let mut missing = preloads.values.clone();
        while !missing.is_empty() {
            let ends: Vec<Move> = missing.iter().map(|&force| Move::ToForce(force)).collect();
            let turns = turns_at(scene, &ends, simulation, stop)?;
            for (preload, turn) in missing.into_iter().zip(turns) {
                staircase.forces.push((preload, turn.pull_off_force));
            }
            staircase
                .forces
                .sort_by(|first, second| first.0.total_cmp(&second.0));
            control.report(&staircase);
            missing = staircase.halves();
        }
        Ok(staircase)
    }

    /// Returns true if the staircase is complete, which means that the preload of each jump is
    /// known precisely. The jump lies between two computed preloads that differ by at most 1/2048
    /// of the axis of preloads, on the scale of this axis.
    pub fn is_whole(&self) -> bool {
        !self.forces.is_empty() && self.halves().is_empty()
    }

    /// Returns the middle of each interval of preloads that contains a step and is wider than
    /// [`FINEST`].
    fn halves(&self) -> Vec<f64> {
        let [first, .., last] = &self.forces[..] else {
            return Vec::new();
        };
        let width = self.scale.coordinate(last.0) - self.scale.coordinate(first.0);
        let mut middles = Vec::new();
        for pair in self.forces.windows(2) {
            let from = self.scale.coordinate(pair[0].0);
            let to = self.scale.coordinate(pair[1].0);
            let has_step = pair[1].1 - pair[0].1 > SAME * pair[1].1;
            if has_step && to - from > FINEST * width {
                middles.push(self.scale.number(f64::midpoint(from, to)));
            }
        }
        middles
    }

    /// Returns the pull-off force as a function of the preload, as the corners of a polygonal line
    /// for a chart. Each corner is a preload in N and a pull-off force in N.
    pub fn line(&self) -> Vec<(f64, f64)> {
        let mut corners: Vec<(f64, f64)> = self.forces.first().copied().into_iter().collect();
        for pair in self.forces.windows(2) {
            corners.push((pair[1].0, pair[0].1));
            corners.push(pair[1]);
        }
        corners
    }
}

/// Force at a turning point of the loading, and pull-off force of the unloading from this point.
#[derive(Clone, Copy, Default)]
struct Turned {
    /// Force at the turning point in N.
    force: f64,
    /// Pull-off force of the unloading in N; 0 if the force is never negative.
    pull_off_force: f64,
}

/// Moves a separated body by each of the moves `ends`, and unloads it from the end of this move.
fn turns_at(
    scene: &CheckedScene,
    ends: &[Move],
    simulation: &mut Simulation,
    stop: &Stop<'_>,
) -> Result<Vec<Turned>, RunError> {
    let mut turns = vec![Turned::default(); ends.len()];
    simulation.reverse(scene, ends, &[], stop, &mut |index, reversal| {
        turns[index] = Turned {
            force: reversal.turn.force,
            pull_off_force: reversal.pull_off_force().unwrap_or(0.0),
        };
        Ok(())
    })?;
    Ok(turns)
}

impl Results {
    /// Quantities that are recorded in a study of the pull-off force as a function of the preload.
    pub const OF_PRELOADS: [Quantity; 4] = [
        Quantity::PreloadIndentation,
        Quantity::PullOffForce,
        Quantity::PullOffIndentation,
        Quantity::DissipatedEnergy,
    ];

    /// Returns each preload in N with the statistics of the pull-off force in N over the profiles.
    /// The axis of the study must have preloads in N. A preload with fewer than two computed
    /// profiles is left out. A profile on which the force is never negative has the pull-off force
    /// 0 N.
    pub fn spread_of_adhesion(&self) -> Vec<(f64, Statistics)> {
        let mut spread = Vec::new();
        for cell in 0..self.plan.cells() {
            let (preload, forces) = self.forces_in(cell);
            let statistics = Statistics::of(forces, Quantity::PullOffForce.bounds());
            if let Some(statistics) = statistics
                && statistics.spread.is_some()
            {
                spread.push((preload, statistics));
            }
        }
        spread
    }

    /// Returns the preload in N on the axis that is nearest to `preload`, and the pull-off force in
    /// N after this preload on each computed profile. The axis of the study must have preloads in
    /// N; `None` if this axis has no values.
    pub fn forces_near(&self, preload: f64) -> Option<(f64, Vec<f64>)> {
        let mut nearest = None;
        let mut least = f64::NAN;
        for cell in 0..self.plan.cells() {
            let distance = (self.plan.value(cell, 0) - preload).abs();
            // If two preloads are equally near, the first one counts.
            if nearest.is_none() || distance.total_cmp(&least).is_lt() {
                nearest = Some(cell);
                least = distance;
            }
        }
        nearest.map(|cell| self.forces_in(cell))
    }

    /// Returns the preload of a cell, and the pull-off force on each computed profile.
    fn forces_in(&self, cell: u64) -> (f64, Vec<f64>) {
        let mut forces = Vec::new();
        for (line, _) in self.records_of(cell) {
            let force = self.value(cell, line, Quantity::PullOffForce);
            forces.push(force.unwrap_or(0.0));
        }
        (self.plan.value(cell, 0), forces)
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::Streak;
    use super::super::error::StudyError;
    use super::super::plan::Plan;
    use super::super::plan_text::Changes;
    use super::super::recorder::Recorder;
    use super::*;
    use asperity_contact::Figures;
    use asperity_scene::{Document, open};

    fn preloads(ends: (f64, f64), count: usize) -> Axis {
        Axis::of_preloads(ends, count, AxisScale::Linear).unwrap()
    }

    fn solved(
        document: &Document,
        preloads: &Axis,
        lines: u64,
        jobs: usize,
    ) -> Result<Results, String> {
        let results = Results::of_scene(
            document.scene(),
            &Results::OF_PRELOADS,
            lines,
            Some(preloads),
            &mut Simulation::new(document.resolve("")),
            Control::default().on_threads(jobs),
        );
        results.map_err(|error| error.to_string())
    }

    #[test]
    fn adhesion_grows_with_the_preload_over_sixteen_profiles() {
        let document = open("pressure-sensitive").unwrap();
        let preloads = preloads((0.0, 2e-5), 9);
        assert_eq!(
            (
                preloads.values[0],
                preloads.values[8],
                preloads.values.len()
            ),
            (0.0, 2e-5, 9)
        );
        let results = solved(&document, &preloads, 16, 2).unwrap();
        // The results on the profile with the index 3 agree with a separate computation of the
        // scene, loaded to one of the preloads.
        let scene = document.scene().with_seed(results.plan().seed_of(3));
        let loading = vec![Move::ToForce(preloads.values[4]), Move::ToSeparation];
        let scene = scene.with(|scene| scene.loading = loading).unwrap();
        let outcome = Simulation::default()
            .run(&scene, &|| false, &mut |_, _, _| Ok(()))
            .unwrap();
        let found = |quantity| results.value(4, 3, quantity);
        assert_eq!(
            found(Quantity::PullOffForce),
            outcome.figures.pull_off_force
        );
        assert_eq!(
            found(Quantity::DissipatedEnergy),
            outcome.figures.dissipated_energy
        );
        for line in 0..16 {
            let curve: Vec<f64> = (0..9).map(|cell| results.forces_in(cell).1[line]).collect();
            assert!(curve.windows(2).all(|pair| pair[0] <= pair[1]), "{curve:?}");
        }
        let means: Vec<f64> = results
            .spread_of_adhesion()
            .iter()
            .map(|(_, statistics)| statistics.mean)
            .collect();
        assert!(means.windows(2).all(|pair| pair[0] < pair[1]), "{means:?}");
        // With twice the preload, the mean pull-off force is about twice as large.
        assert!(
            means[8] > 1.5 * means[4] && means[4] > 1.5 * means[2],
            "{means:?}"
        );
        assert!(means[0] < 0.1 * means[8], "{means:?}");
        assert_eq!(solved(&document, &preloads, 16, 1), Ok(results));
    }

    #[test]
    fn smooth_bodies_have_but_one_profile() {
        let (smooth, preloads) = (open("jkr-sphere").unwrap(), preloads((0.0, 1e-6), 2));
        assert_eq!(
            solved(&smooth, &preloads, 2, 1),
            Err(StudyError::fixed_profile().to_string())
        );
        let one = solved(&smooth, &preloads, 1, 1).unwrap();
        assert_eq!(
            (one.plan().cells(), one.spread_of_adhesion()),
            (2, Vec::new())
        );
        let stepwise = smooth
            .set("numerics.solver", "Stepwise(step: 1e-9)")
            .unwrap();
        let error = solved(&stepwise, &preloads, 1, 1).unwrap_err();
        assert!(
            error.starts_with("numerics.solver = Stepwise: reversals need the exact solver"),
            "{error}"
        );
    }

    /// Results for preloads in N agree with those of separate computations, also for a smooth body.
    /// The text of a plan keeps the unit N of its preloads.
    #[test]
    fn preloads_of_a_plan_may_be_in_newtons() {
        for base in ["jkr-sphere", "pressure-sensitive"] {
            let text = format!(
                "(version: 1, base: \"{base}\", set: {{\"numerics.points\": \"2048\"}}, axes: [List(path: \"preload_in_N\", \
                 values: [2e-6, 1e-5])], record: [pull_off_force, dissipated_energy])"
            );
            let plan = Plan::parse(&text, base, &Changes::default()).unwrap();
            assert_eq!(
                Plan::parse(&plan.to_ron(), base, &Changes::default()).unwrap(),
                plan
            );
            let streak = Streak {
                cells: 0..2,
                line: 0,
            };
            let records = Recorder::new(&plan, Simulation::default(), &|| false)
                .record(&streak)
                .unwrap();
            for (force, record) in [2e-6, 1e-5].into_iter().zip(records) {
                let loading = vec![Move::ToForce(force), Move::ToSeparation];
                let scene = plan
                    .scene_of(0)
                    .unwrap()
                    .with(|scene| scene.loading = loading)
                    .unwrap();
                let outcome = Simulation::default()
                    .run(&scene, &|| false, &mut |_, _, _| Ok(()))
                    .unwrap();
                let Figures {
                    pull_off_force,
                    dissipated_energy,
                    ..
                } = outcome.figures;
                let record: Vec<_> = record.into_iter().map(Some).collect();
                assert_eq!(
                    record,
                    [pull_off_force, dissipated_energy],
                    "{base} {force}"
                );
            }
        }
    }

    /// The steps of the staircase are those found on a fine grid of preloads. A loading to a
    /// negative preload turns at a point where adhesion still pulls the bodies together.
    #[test]
    fn a_staircase_has_its_steps_where_a_fine_grid_has_them() {
        let document = open("pressure-sensitive").unwrap();
        let scene = document
            .scene()
            .with(|scene| scene.numerics.points = 2048)
            .unwrap();
        let find = |ends, count, scale| {
            let axis = Axis::of_preloads(ends, count, scale).unwrap();
            let mut parts = Vec::new();
            let mut see = |part: &Staircase| parts.push(part.forces.len());
            let found = Staircase::of(
                &scene,
                &axis,
                &mut Simulation::default(),
                Control::default().reporting_to(&mut see),
            );
            match found {
                Ok(found) => Ok((found, parts)),
                Err(StudyError::Run { error, .. }) => Err(*error),
                Err(other) => panic!("{other}"),
            }
        };
        let (coarse, parts) = find((0.0, 4e-5), 5, AxisScale::Linear).unwrap();
        let (fine, _) = find((0.0, 4e-5), 512, AxisScale::Linear).unwrap();
        assert!(
            parts[0] == 5 && parts.windows(2).all(|pair| pair[0] < pair[1]),
            "{parts:?}"
        );
        let at = |all: &Staircase, preload: f64| {
            all.forces[all
                .forces
                .partition_point(|point| point.0 <= preload)
                .saturating_sub(1)]
            .1
        };
        let width = FINEST * 4e-5;
        let mut steps = 0;
        for (preload, force) in fine.forces {
            let (before, after) = (
                at(&coarse, preload - 2.0 * width),
                at(&coarse, preload + 2.0 * width),
            );
            assert!(
                before <= force * (1.0 + 1e-9) && force <= after * (1.0 + 1e-9),
                "{preload}"
            );
            steps += usize::from(before < after);
        }
        assert!(steps > 2, "{steps}");
        // Each segment of the polygonal line is horizontal or vertical.
        assert!(
            coarse
                .line()
                .windows(2)
                .all(|pair| pair[0].0 == pair[1].0 || pair[0].1 == pair[1].1)
        );
        let (touch, adhesion) = coarse.touch;
        assert!(touch < 0.0 && adhesion <= coarse.zero_force);
        let (drawn, _) = find((touch, -touch), 9, AxisScale::Linear).unwrap();
        assert_eq!(
            (drawn.forces[0], at(&drawn, 0.0)),
            ((touch, adhesion), coarse.zero_force)
        );
        let below = RunError::BelowTouch {
            preload: 2.0 * touch,
            touch,
        };
        assert_eq!(find((2.0 * touch, 1e-5), 9, AxisScale::Linear), Err(below));
        let (ratios, _) = find((1e-9, 1e-3), 64, AxisScale::Logarithmic).unwrap();
        assert_eq!(
            (ratios.forces[0].0, ratios.forces[ratios.forces.len() - 1].0),
            (1e-9, 1e-3)
        );
    }

    #[test]
    fn preloads_are_two_forces_a_number_and_a_scale() {
        let values = |text| Axis::parse_preloads(text).unwrap().values;
        assert_eq!(values("0..20uN").len(), 64);
        assert_eq!(values("-1e-6 .. 2e-6:4"), [-1e-6, 0.0, 1e-6, 2e-6]);
        for text in ["1nN..1uN:4:log", "1nN..1uN:log:4"] {
            let values = values(text);
            assert!(
                values.len() == 4 && (values[1] / 1e-8 - 1.0).abs() < 1e-12,
                "{values:?}"
            );
        }
        for (wrong, allowed) in [
            ("", "two forces"),
            ("1", "two forces"),
            ("1..", "two forces"),
            ("0..1:x", "two forces"),
            ("0..1:-5", "two forces"),
            ("0..1m/s", "two forces"),
            ("0..inf", "two forces"),
            ("2..1", "`from` less than `to`"),
            ("1..1", "`from` less than `to`"),
            ("0..1:1", "allowed: from 2 to 512"),
            ("0..1:513", "allowed: from 2 to 512"),
            ("0..1:log", "begins above 0"),
            ("-1..1:log", "begins above 0"),
            ("0..1e31", "allowed: from -1e30 to 1e30 N"),
        ] {
            let error = Axis::parse_preloads(wrong).unwrap_err().to_string();
            assert!(error.contains(allowed), "{wrong}: {error}");
        }
    }
}
