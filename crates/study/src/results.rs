//! The values that a study has recorded. They are read from the files that the processes of the
//! study wrote, from the table that [`merge`](crate::merge) wrote, or are computed in memory.

use super::axis::Axis;
use super::error::StudyError;
use super::grid::{Grid, GridCell, GridLayer, scale_of, scale_of_colours};
use super::missing_profiles::{Failures, MissingProfiles, SolvedProfile};
use super::plan::Plan;
use super::quantity::{Quantity, regime_of};
use super::recorder::Recorded;
use super::statistics::{RegimeCounts, Statistics};
use super::store::{Folder, ShardFile};
use asperity_contact::ContactError;
use asperity_data::{AxisScale, Control, CountedWarning, Warning};
use asperity_scene::{Regime, RunError, Scene, Simulation, Solver};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of records, or of cells, that a message lists.
const MOST_NAMED: usize = 8;

/// Results of a study: the values of the recorded quantities in each [cell](Plan) on each random
/// profile.
#[derive(Clone)]
pub struct Results {
    pub(super) plan: Plan,
    /// Values of all records, ordered by cell and then by profile; NaN for missing values.
    values: Vec<f64>,
    done: Vec<bool>,
    records_done: u64,
    /// Reasons why some records cannot be computed, by the index of the record.
    failed: BTreeMap<u64, String>,
    /// Premises of the model that some records do not meet, by the index of the record. They are
    /// known only for records that were computed in memory.
    warnings: BTreeMap<u64, Vec<Warning>>,
}

/// Numbers of records that [`merge`](crate::merge) found in the files of a study. A record has the
/// values of one [cell](Plan) on one random profile.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Merged {
    /// Number of records in the files of the study. A repeated record is counted once.
    pub records: u64,
    /// Number of records that have no values because they cannot be computed.
    pub failed: u64,
    /// The first few records that cannot be computed: number of the [cell](Plan), seed of the
    /// profile, and reason.
    pub first_failed: Vec<(u64, u64, String)>,
    /// Number of records that the study has once it is complete.
    pub total: u64,
    /// Number of repeated records in the files. A repeated record has exactly the same values as
    /// another record of the same [cell](Plan) and profile.
    pub duplicates: u64,
    /// Number of incomplete or damaged lines in the files of the study, which are ignored.
    pub damaged: u64,
    /// Number of [cells](Plan) that lack the records of some profiles.
    pub missing_cells: u64,
    /// Numbers of the first few [cells](Plan) that lack the records of some profiles.
    pub first_missing: Vec<u64>,
    /// Number of files in the folder of the study that have at least one record.
    pub files: usize,
    /// Versions of the program that wrote the records.
    pub programs: Vec<String>,
}

impl PartialEq for Results {
    /// Returns true if the plans are equal and all values have the same bits. Two missing values
    /// count as equal.
    fn eq(&self, other: &Self) -> bool {
        self.plan == other.plan && same(&self.values, &other.values) && self.failed == other.failed
    }
}

impl std::fmt::Debug for Results {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} of {} records",
            self.count(),
            self.plan.records_in_all()
        )
    }
}

/// Returns true if the values have the same bits. Any two NaN count as equal.
fn same(first: &[f64], second: &[f64]) -> bool {
    if first.len() != second.len() {
        return false;
    }
    for (first, second) in first.iter().zip(second) {
        let are_nan = first.is_nan() && second.is_nan();
        if first.to_bits() != second.to_bits() && !are_nan {
            return false;
        }
    }
    true
}

/// Returns true if a file has a record with this index.
fn has_record(folder: &Folder, file: &ShardFile, place: u64) -> bool {
    let Ok(records) = folder.records(file) else {
        return false;
    };
    for record in records {
        if let Ok(Some((found, _))) = record
            && found == place
        {
            return true;
        }
    }
    false
}

fn same_record(first: &Recorded, second: &Recorded) -> bool {
    match (first, second) {
        (Ok(first), Ok(second)) => same(first, second),
        _ => first.is_err() && first == second,
    }
}

impl Results {
    /// Creates results of a plan in which all records are missing.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice for the table.
    pub(super) fn empty(plan: Plan) -> Result<Results, StudyError> {
        let records = plan.records_in_all();
        let mut values = Vec::new();
        let count = records as usize * plan.record.len();
        values
            .try_reserve_exact(count)
            .map_err(|_| StudyError::TooManyRecords(records))?;
        values.resize(count, f64::NAN);
        Ok(Results {
            plan,
            values,
            done: vec![false; records as usize],
            records_done: 0,
            failed: BTreeMap::new(),
            warnings: BTreeMap::new(),
        })
    }

    /// Creates the results of [`Results::of_scene`] with all values missing.
    ///
    /// # Errors
    /// Returns the errors of [`Results::of_scene`], except those of the computation.
    pub(super) fn begin(
        scene: &Scene,
        record: &[Quantity],
        lines: u64,
        preloads: Option<&Axis>,
    ) -> Result<Results, StudyError> {
        StudyError::check_profiles(scene, lines)?;
        if preloads.is_some() && scene.numerics.solver != Solver::Exact {
            return Err(RunError::NeedsExactSolver.into());
        }
        if preloads.is_some() && scene.relaxes() {
            return Err(RunError::from(ContactError::NotElastic).into());
        }
        let axes = preloads.into_iter().cloned().collect();
        Results::empty(Plan {
            axes,
            ..Plan::of_scene(scene, lines, record)
        })
    }

    /// Computes a checked scene on `lines` random profiles, as a study in memory. `record` are the
    /// recorded quantities. If `preloads` is given, this axis of preloads in N is the only axis of
    /// the study, and its preloads replace the loading of the scene. Otherwise the study has no
    /// axis. After each profile, `control` receives the results computed so far.
    ///
    /// # Errors
    /// Returns an error if zero threads are requested, if `lines` is above 1 and the profile of the
    /// scene is fixed, or if `preloads` are given and the solver of the scene is not
    /// [`Solver::Exact`] or its half-space relaxes. It is also an error if the memory does not
    /// suffice, if a profile or its contact cannot be computed, or if `control` stops the
    /// computation.
    pub fn of_scene(
        scene: &Scene,
        record: &[Quantity],
        lines: u64,
        preloads: Option<&Axis>,
        simulation: &mut Simulation,
        mut control: Control<'_, Results>,
    ) -> Result<Results, StudyError> {
        StudyError::check_threads(control.threads())?;
        let mut results = Results::begin(scene, record, lines, preloads)?;
        let threads = control.threads();
        let stop = control.stop();
        let missing = results.missing(Failures::End);
        missing.solve(simulation, threads, stop, &mut |solved| {
            results.take_in(solved);
            control.report(&results);
        })?;
        Ok(results)
    }

    /// Returns the profiles that are not computed yet.
    pub(super) fn missing(&self, failures: Failures) -> MissingProfiles {
        let lines = 0..self.plan.lines;
        MissingProfiles {
            plan: self.plan.clone(),
            lines: lines.filter(|line| !self.has(0, *line)).collect(),
            failures,
        }
    }

    /// Stores the records of a computed profile, one for each cell.
    pub(super) fn take_in(&mut self, solved: SolvedProfile) {
        for (cell, record) in (0..).zip(solved.records) {
            self.set_record(cell * self.plan.lines + solved.line, record);
        }
        self.set_warnings(solved.line, solved.warnings);
    }

    /// Stores the premises of the model that cells do not meet on the profile with the index
    /// `line`. `warnings` has the number of each such cell, with its premises.
    pub(super) fn set_warnings(&mut self, line: u64, warnings: Vec<(u64, Vec<Warning>)>) {
        for (cell, warnings) in warnings {
            let place = cell * self.plan.lines + line;
            self.warnings.insert(place, warnings);
        }
    }

    /// Reads the files of results of a study, one for each process that has worked on the study.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read, or if two records of the same cell and profile
    /// differ.
    pub(super) fn of_shards(folder: &Folder) -> Result<(Results, Merged), StudyError> {
        let mut results = Results::empty(folder.plan().clone())?;
        let files = folder.files()?;
        let mut duplicates = 0;
        let mut damaged = 0;
        let mut with_records = 0;
        let mut programs = BTreeSet::new();
        for file in &files {
            let mut has_records = false;
            for record in folder.records(file)? {
                let Some((place, record)) = record? else {
                    damaged += 1;
                    continue;
                };
                has_records = true;
                match results.recorded(place) {
                    None => results.set_record(place, record),
                    Some(known) if same_record(&known, &record) => duplicates += 1,
                    Some(_) => return Err(results.conflict(folder, &files, place, file)),
                }
            }
            if has_records {
                with_records += 1;
                programs.insert(file.header.program.clone());
            }
        }
        let plan = &results.plan;
        let mut first_failed = Vec::new();
        for (cell, line, reason) in results.failed().take(MOST_NAMED) {
            first_failed.push((cell, plan.seed_of(line), reason.to_owned()));
        }
        let missing: Vec<u64> = (0..plan.cells())
            .filter(|cell| !results.is_whole(*cell))
            .collect();
        let merged = Merged {
            records: results.count(),
            failed: results.failed.len() as u64,
            first_failed,
            total: plan.records_in_all(),
            duplicates,
            damaged,
            missing_cells: missing.len() as u64,
            first_missing: missing.into_iter().take(MOST_NAMED).collect(),
            files: with_records,
            programs: programs.into_iter().collect(),
        };
        Ok((results, merged))
    }

    /// Returns the error for two records with the same index but different values. `other` is the
    /// file with the second record.
    fn conflict(
        &self,
        folder: &Folder,
        files: &[ShardFile],
        place: u64,
        other: &ShardFile,
    ) -> StudyError {
        let first = files
            .iter()
            .find(|file| has_record(folder, file, place))
            .unwrap_or(other);
        let cell = place / self.plan.lines;
        let seed = self.plan.seed_of(place % self.plan.lines);
        let place = format!("cell {cell}, seed {seed} ({})", self.plan.coordinates(cell));
        StudyError::Conflict {
            place,
            files: [first.path.clone(), other.path.clone()],
        }
    }

    /// Returns the number of records that are done: they have values, or a reason why they have
    /// none.
    pub(super) fn count(&self) -> u64 {
        self.records_done
    }

    /// Returns the number of profiles on which all cells are computed. A cell is one combination of
    /// values on the axes.
    pub fn profiles_done(&self) -> u64 {
        self.count() / self.plan.cells().max(1)
    }

    fn set_done(&mut self, place: u64) {
        let done = &mut self.done[place as usize];
        self.records_done += u64::from(!*done);
        *done = true;
    }

    /// Stores the values of the record with the index `place`. Records are numbered by cell and
    /// then by profile.
    pub(super) fn set(&mut self, place: u64, values: &[f64]) {
        let columns = self.plan.record.len();
        self.values[place as usize * columns..][..columns].copy_from_slice(values);
        self.set_done(place);
    }

    /// Stores the values of a record, or the reason why it has none.
    pub(super) fn set_record(&mut self, place: u64, record: Recorded) {
        match record {
            Ok(values) => self.set(place, &values),
            Err(reason) => {
                self.set_done(place);
                self.failed.insert(place, reason);
            }
        }
    }

    /// Returns the record with this index; `None` if it is missing.
    fn recorded(&self, place: u64) -> Option<Recorded> {
        match self.failed.get(&place) {
            Some(reason) => Some(Err(reason.clone())),
            None => self.at(place).map(|values| Ok(values.to_vec())),
        }
    }

    /// Returns the pairs of a cell and a profile that cannot be computed. Each item is the number
    /// of the [cell](Plan), the index of the profile, and the reason.
    pub fn failed(&self) -> impl Iterator<Item = (u64, u64, &str)> {
        let lines = self.plan.lines;
        self.failed
            .iter()
            .map(move |(place, reason)| (place / lines, place % lines, reason.as_str()))
    }

    /// Returns the reason why a record could not be computed; `None` if it has values or is
    /// missing.
    pub(super) fn reason(&self, cell: u64, line: u64) -> Option<&str> {
        self.failed
            .get(&(cell * self.plan.lines + line))
            .map(String::as_str)
    }

    /// Returns the reason why a cell has no values at all, because it cannot be computed on any
    /// profile. Otherwise `None`.
    pub(super) fn failure_of(&self, cell: u64) -> Option<&str> {
        let places = cell * self.plan.lines..(cell + 1) * self.plan.lines;
        let mut reasons = self.failed.range(places).map(|(_, reason)| reason.as_str());
        let first = reasons.next()?;
        let failed = 1 + reasons.count() as u64;
        (failed == self.plan.lines).then_some(first)
    }

    /// Returns the premises of the model that the profiles of a [cell](Plan) do not meet, each with
    /// the number of profiles that do not meet it. The list is empty for results that were read
    /// from files, in which only the number of premises is recorded, as [`Quantity::Warnings`].
    pub fn warnings(&self, cell: u64) -> Vec<CountedWarning> {
        let places = cell * self.plan.lines..(cell + 1) * self.plan.lines;
        let mut counted: Vec<CountedWarning> = Vec::new();
        for warning in self
            .warnings
            .range(places)
            .flat_map(|(_, warnings)| warnings)
        {
            CountedWarning::count(&mut counted, warning);
        }
        counted
    }

    /// Returns the premises of the model that are not met in the study, in all [cells](Plan)
    /// together. Each premise has the number of profiles that do not meet it in at least one cell.
    pub fn all_warnings(&self) -> Vec<CountedWarning> {
        let mut counted: Vec<CountedWarning> = Vec::new();
        for line in 0..self.plan.lines {
            let places = (0..self.plan.cells()).map(|cell| cell * self.plan.lines + line);
            let of_profile: Vec<&Warning> = places
                .filter_map(|place| self.warnings.get(&place))
                .flatten()
                .collect();
            let mut names = BTreeSet::new();
            for warning in of_profile {
                if names.insert(warning.name()) {
                    CountedWarning::count(&mut counted, warning);
                }
            }
        }
        counted
    }

    /// Returns the plan of the study.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the values of the recorded quantities in a [cell](Plan) on the profile with the
    /// index `line`, in the order of [`Plan::record`] and in SI units. A quantity without a value
    /// is NaN. A regime is given as its index in [`asperity_scene::Regime::ALL`]. Returns `None` if
    /// the cell is not computed on this profile or cannot be computed.
    pub fn record(&self, cell: u64, line: u64) -> Option<&[f64]> {
        self.at(cell * self.plan.lines + line)
    }

    fn at(&self, place: u64) -> Option<&[f64]> {
        let columns = self.plan.record.len();
        let values = self
            .values
            .get(place as usize * columns..)?
            .get(..columns)?;
        (self.done[place as usize] && !self.failed.contains_key(&place)).then_some(values)
    }

    /// Returns the value of a quantity in a [cell](Plan) on the profile with the index `line`, in
    /// the SI unit of the quantity. `None` if the quantity is not recorded or has no value.
    pub fn value(&self, cell: u64, line: u64, quantity: Quantity) -> Option<f64> {
        let column = self.plan.column(quantity)?;
        self.record(cell, line)
            .map(|values| values[column])
            .filter(|value| !value.is_nan())
    }

    /// Returns the regime of adhesion of a [cell](Plan) on the profile with the index `line`;
    /// `None` if it is not recorded or not known. `regime` is one of [`Quantity::REGIMES`].
    pub fn regime(&self, cell: u64, line: u64, regime: Quantity) -> Option<Regime> {
        regime_of(self.value(cell, line, regime)?)
    }

    /// Returns the profiles on which a [cell](Plan) is computed. Each item is the index of the
    /// profile and the values of the quantities in the order of [`Plan::record`].
    pub fn records_of(&self, cell: u64) -> impl Iterator<Item = (u64, &[f64])> {
        (0..self.plan.lines).filter_map(move |line| Some((line, self.record(cell, line)?)))
    }

    pub(super) fn has(&self, cell: u64, line: u64) -> bool {
        self.done[(cell * self.plan.lines + line) as usize]
    }

    /// Returns true if a [cell](Plan) is complete: on each profile it is computed, or is known to
    /// be impossible to compute.
    pub fn is_whole(&self, cell: u64) -> bool {
        (0..self.plan.lines).all(|line| self.has(cell, line))
    }

    /// Returns the values of a quantity in a [cell](Plan), in the SI unit of the quantity. Profiles
    /// on which the quantity has no value are left out.
    pub fn values(&self, cell: u64, quantity: Quantity) -> Vec<f64> {
        let Some(column) = self.plan.column(quantity) else {
            return Vec::new();
        };
        self.records_of(cell)
            .map(|(_, values)| values[column])
            .filter(|value| !value.is_nan())
            .collect()
    }

    /// Returns the statistics of a quantity over the profiles of a [cell](Plan); `None` if no
    /// profile has a value.
    ///
    /// ```
    /// use asperity_data::Control;
    /// use asperity_study::{Plan, Quantity, compute};
    ///
    /// let scene = asperity_scene::open("pressure-sensitive")?.set("numerics.points", "1024")?;
    /// let plan = Plan::new(&scene, &[], 5, &[Quantity::PullOffForce, Quantity::Regime])?;
    /// let results = compute(&plan, Control::default())?;
    /// let force = results.statistics(0, Quantity::PullOffForce).ok_or("no profile pulls")?;
    /// assert_eq!((force.count, results.regimes(0)[0].profiles()), (5, 5));
    /// assert_eq!(results.values(0, Quantity::PullOffForce).len(), 5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn statistics(&self, cell: u64, quantity: Quantity) -> Option<Statistics> {
        Statistics::of(self.values(cell, quantity), quantity.bounds())
    }

    /// Returns the number of profiles of a [cell](Plan) in each regime of adhesion, as two counts.
    /// In the first count, the regime follows from F_a(d=0), the pull-off force of a loading that
    /// turns at first touch ([`Quantity::Regime`]). In the second count, it follows from F_a(F=0),
    /// the pull-off force of a loading that turns at zero force
    /// ([`Quantity::RegimeAfterZeroForce`]).
    pub fn regimes(&self, cell: u64) -> [RegimeCounts; 2] {
        Quantity::REGIMES.map(|quantity| {
            let records = self.records_of(cell);
            RegimeCounts::of(records.map(|(line, _)| self.regime(cell, line, quantity)))
        })
    }

    /// Returns the recorded quantities except regimes. Each has the scale that suits its means over
    /// the profiles in all cells of the study.
    pub(super) fn layers(&self) -> Vec<GridLayer> {
        let recorded = self
            .plan
            .record
            .iter()
            .filter(|quantity| !quantity.is_regime());
        recorded
            .map(|quantity| self.layer(*quantity, None))
            .collect()
    }

    /// Returns a recorded quantity with its scale. If `scale` is `None`, a share gets a linear
    /// scale on a map, and other quantities get the scale that suits their means over the profiles
    /// in all cells of the study.
    pub(super) fn layer(&self, quantity: Quantity, scale: Option<AxisScale>) -> GridLayer {
        let means: Vec<f64> = (0..self.plan.cells())
            .filter_map(|cell| Some(self.statistics(cell, quantity)?.mean))
            .collect();
        let mut axes = self.plan.axes.iter();
        let is_map = axes.by_ref().any(has_several) && axes.any(has_several);
        let scale = match scale {
            Some(scale) => scale,
            None if is_map => scale_of_colours(quantity, &means),
            None => scale_of(&means),
        };
        GridLayer::new(quantity, scale, &means)
    }

    /// Returns a grid of the cells over one or two axes, with the quantities of `layers`. On each
    /// other axis, `places` has the index of the fixed value.
    pub(super) fn grid(
        &self,
        axes_of_grid: (usize, Option<usize>),
        mut places: Vec<usize>,
        layers: Vec<GridLayer>,
    ) -> Grid {
        let (across, up) = axes_of_grid;
        let axes = &self.plan.axes;
        let quantities: Vec<Quantity> = layers.iter().map(|layer| layer.quantity).collect();
        let mut cells = Vec::new();
        for row in up.map_or(vec![0], |up| axes[up].order()) {
            if let Some(up) = up {
                places[up] = row;
            }
            for column in axes[across].order() {
                places[across] = column;
                let cell = self.plan.cell_at(&places);
                cells.push(match self.cell(cell, &quantities) {
                    Some(results) => Some(Ok(results)),
                    None => self.failure_of(cell).map(|reason| Err(reason.to_owned())),
                });
            }
        }
        let others = (0..axes.len()).filter(|axis| *axis != across && Some(*axis) != up);
        let fixed = others.map(|axis| axes[axis].at(places[axis])).collect();
        Grid::new(
            axes[across].ascending(),
            up.map(|up| axes[up].ascending()),
            fixed,
            layers,
            cells,
        )
    }

    /// Returns the statistics of these quantities in a cell; `None` if the cell has no records.
    pub(super) fn cell(&self, cell: u64, quantities: &[Quantity]) -> Option<GridCell> {
        let statistics = quantities
            .iter()
            .map(|quantity| self.statistics(cell, *quantity))
            .collect();
        let regimes = self.regimes(cell);
        (regimes[0].profiles() > 0).then_some(GridCell {
            statistics,
            regimes,
        })
    }
}

/// Returns true for an axis along which a study has several cells.
fn has_several(axis: &Axis) -> bool {
    axis.values.len() > 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_agree_bit_by_bit_but_for_the_kind_of_nan() {
        let other_nan = f64::from_bits(f64::NAN.to_bits() | 1);
        assert!(same(&[1.0, f64::NAN], &[1.0, other_nan]));
        for (first, second) in [
            (1.0, 1.0_f64.next_up()),
            (0.0, -0.0),
            (f64::NAN, 1.0),
            (1.0, f64::NAN),
        ] {
            assert!(!same(&[2.0, first], &[2.0, second]), "{first} {second}");
        }
    }
}
