//! The map of the results of a scene over two axes: κ or e_el/γ, and the Hurst exponent H. The map
//! is a study in memory, which is computed first at a coarse and then at finer resolutions.

use super::axis::Axis;
use super::cells::Streak;
use super::error::StudyError;
use super::grid::Grid;
use super::plan::Plan;
use super::profiles::Stop;
use super::recorder::Recorder;
use super::results::Results;
use asperity_data::Control;
use asperity_scene::Simulation;
use std::collections::BTreeMap;
use std::mem::take;
use std::ops::ControlFlow;

/// Numbers of springs above which the finest resolution of a map is one level coarser (`MANY`) or
/// two levels coarser (`VERY_MANY`), because each cell takes longer.
const MANY: u64 = 1 << 14;
const VERY_MANY: u64 = 1 << 17;

/// Resolution of a [`LiveMap`]: how many values each of its two axes has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// 5 values on the axis of the roughness parameter (κ or e_el/γ), and 5 values of the Hurst
    /// exponent.
    Coarse,
    /// 9 values on the axis of the roughness parameter (κ or e_el/γ), and 9 values of the Hurst
    /// exponent.
    Medium,
    /// 17 values on the axis of the roughness parameter (κ or e_el/γ), and all values of the Hurst
    /// exponent.
    Fine,
    /// All values on the axis of the roughness parameter (κ or e_el/γ), and all values of the Hurst
    /// exponent.
    Whole,
}

impl Level {
    /// All resolutions of a map, the coarsest first.
    pub const ALL: [Level; 4] = [Level::Coarse, Level::Medium, Level::Fine, Level::Whole];

    /// Returns the finest level of a map whose scene has this number of springs.
    fn finest(springs: u64) -> Level {
        let too_fine = usize::from(springs > MANY) + usize::from(springs > VERY_MANY);
        Level::ALL[3 - too_fine]
    }

    /// Returns the indices of the values on axis number `axis` of a plan that belong to this level.
    /// If the plan has no such axis, the only index is 0.
    fn places_on(self, plan: &Plan, axis: usize) -> Vec<usize> {
        match plan.axes.get(axis) {
            Some(axis) => self.places(axis),
            None => vec![0],
        }
    }

    /// Returns the indices of the values of an axis that belong to this level, at about equal
    /// distances. If the axis has few values, all of them belong to the level.
    fn places(self, axis: &Axis) -> Vec<usize> {
        let wanted = [5, 9, 17, 33][self as usize];
        let all = axis.values.len();
        if 4 * all <= 5 * wanted {
            return (0..all).collect();
        }
        let step = (all - 1) as f64 / (wanted - 1) as f64;
        (0..wanted)
            .map(|index| (step * index as f64).round_ties_even() as usize)
            .collect()
    }
}

/// Map of the results of a scene over two axes: a roughness parameter (κ, or the ratio e_el/γ of
/// elastic energy to work of adhesion), and the Hurst exponent H. The map can be shown while it is
/// computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    results: Results,
    failed: BTreeMap<u64, String>,
}

impl LiveMap {
    /// Creates a map without results for a plan that [`Plan::of_map`] made.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice for the map.
    pub fn new(plan: Plan) -> Result<Self, StudyError> {
        Ok(LiveMap {
            results: Results::empty(plan)?,
            failed: BTreeMap::new(),
        })
    }

    /// Returns the plan of the study whose results the map shows.
    pub fn plan(&self) -> &Plan {
        self.results.plan()
    }

    /// Returns the numbers of those [cells](Plan) that the map has at this resolution. Cells with
    /// the same Hurst exponent form a group.
    pub fn cells(&self, level: Level) -> Vec<Vec<u64>> {
        let plan = self.plan();
        let parameters = level.places_on(plan, 0);
        let mut rows = Vec::new();
        for hurst in level.places_on(plan, 1) {
            let mut cells = Vec::with_capacity(parameters.len());
            for &parameter in &parameters {
                cells.push(plan.cell_at(&[parameter, hurst]));
            }
            rows.push(cells);
        }
        rows
    }

    /// Returns true for a cell that is computed or is known to have no result.
    fn is_known(&self, cell: u64) -> bool {
        self.failed.contains_key(&cell) || self.results.is_whole(cell)
    }

    /// Sets the results of one [cell](Plan) on the random profile with the index `line`. The values
    /// are in the order of [`Plan::record`].
    pub fn set(&mut self, cell: u64, line: u64, values: &[f64]) {
        self.results.set(cell * self.plan().lines + line, values);
    }

    fn levels(&self) -> impl Iterator<Item = Level> + use<> {
        let finest = Level::finest(self.plan().scene.numerics.points);
        Level::ALL.into_iter().filter(move |level| *level <= finest)
    }

    fn has(&self, level: &Level) -> bool {
        self.cells(*level)
            .concat()
            .iter()
            .all(|cell| self.is_known(*cell))
    }

    /// Returns the finest resolution at which all [cells](Plan) of the map are computed; `None` if
    /// the map is not complete even at the coarsest resolution.
    pub fn level(&self) -> Option<Level> {
        self.levels().take_while(|level| self.has(level)).last()
    }

    /// Returns true if all [cells](Plan) of the map are computed.
    pub fn is_whole(&self) -> bool {
        self.levels().all(|level| self.has(&level))
    }

    /// Computes the missing [cells](Plan) of this map on the calling thread, first at the coarse
    /// and then at the finer resolutions. As soon as all cells with one value of the Hurst exponent
    /// are computed, `control` receives the map. If `control` stops the computation, the map keeps
    /// the results computed so far.
    pub fn compute(&mut self, simulation: &mut Simulation, mut control: Control<'_, LiveMap>) {
        let plan = self.plan().clone();
        let mut recorder = Recorder::new(&plan, take(simulation), control.stop());
        let rows: Vec<Vec<u64>> = self.levels().flat_map(|level| self.cells(level)).collect();
        for row in rows {
            if row.iter().all(|cell| self.is_known(*cell)) {
                continue;
            }
            if self
                .compute_row(&row, &mut recorder, control.stop())
                .is_break()
            {
                break;
            }
            control.report(&*self);
        }
        *simulation = recorder.simulation;
    }

    /// Computes the missing cells of a row, which all have the same value of H.
    fn compute_row(
        &mut self,
        row: &[u64],
        recorder: &mut Recorder<'_>,
        stop: &Stop<'_>,
    ) -> ControlFlow<()> {
        for line in 0..self.plan().lines {
            for &cell in row {
                if self.failed.contains_key(&cell) || self.results.has(cell, line) {
                    continue;
                }
                if stop() {
                    return ControlFlow::Break(());
                }
                let cells = cell..cell + 1;
                match recorder.record(&Streak { cells, line }) {
                    Ok(records) => self.set(cell, line, &records.concat()),
                    Err(error) if error.is_interruption() => return ControlFlow::Break(()),
                    Err(error) => {
                        self.failed.insert(cell, error.to_string());
                    }
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Returns the results computed so far as a [`Grid`]. Its horizontal axis is the Hurst
    /// exponent, and its vertical axis is the roughness parameter (κ or e_el/γ). If the scene has
    /// no Hurst exponent, the grid has only a horizontal axis, the roughness parameter.
    pub fn grid(&self) -> Grid {
        let last = self.plan().axes.len() - 1;
        let mut grid = self.results.grid(
            (last, (last > 0).then_some(0)),
            vec![0; last + 1],
            self.results.layers(),
        );
        for (number, cell) in (0..).zip(&mut grid.cells) {
            if let Some(why) = self.failed.get(&number) {
                *cell = Some(Err(why.clone()));
            } else if !self.results.is_whole(number) {
                *cell = None;
            }
            let statistics = cell
                .iter_mut()
                .flatten()
                .flat_map(|cell| &mut cell.statistics);
            statistics.flatten().for_each(|all| all.spread = None);
        }
        grid.stand_ins = (0..self.plan().cells())
            .map(|cell| self.stand_in(cell) as usize)
            .collect();
        grid
    }

    /// Returns the index of the cell whose result is shown for `cell`: `cell` itself or, until it
    /// is computed, a cell of a coarser level.
    fn stand_in(&self, cell: u64) -> u64 {
        for level in Level::ALL.into_iter().rev() {
            let nearest = self.nearest_on(level, cell);
            if self.is_known(nearest) {
                return nearest;
            }
        }
        cell
    }

    /// Returns the index of the cell nearest to `cell` among the cells of a level.
    fn nearest_on(&self, level: Level, cell: u64) -> u64 {
        let plan = self.plan();
        let mut nearest = Vec::with_capacity(plan.axes.len());
        for (place, axis) in plan.places(cell).into_iter().zip(&plan.axes) {
            let places = level.places(axis).into_iter();
            nearest.extend(places.min_by_key(|known| known.abs_diff(place)));
        }
        plan.cell_at(&nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan_text::Changes;
    use crate::quantity::Quantity;
    use crate::run::run_study;
    use crate::shard::Shard;
    use crate::store::Folder;
    use crate::study_map::StudyMap;
    use crate::tables::merge;
    use asperity_scene::text::to_ron;
    use asperity_scene::{Regime, open};
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    const HURSTS: usize = 19;
    const KAPPAS: usize = 33;

    fn map() -> LiveMap {
        let document = open("pressure-sensitive").unwrap();
        let small = [("numerics.points", "128"), ("roughness.modes", "(1, 32)")];
        let small = small.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = document.set_all(&small).unwrap();
        LiveMap::new(Plan::of_map(document.scene()).unwrap()).unwrap()
    }

    /// Computes the map until `most` rows have been reported, and returns the number of reported
    /// rows.
    fn compute_rows(map: &mut LiveMap, most: usize) -> usize {
        let rows = AtomicUsize::new(0);
        let stop = || rows.load(Relaxed) == most;
        let mut count = |_: &LiveMap| {
            rows.fetch_add(1, Relaxed);
        };
        let control = Control::default()
            .stopped_by(&stop)
            .reporting_to(&mut count);
        map.compute(&mut Simulation::default(), control);
        rows.into_inner()
    }

    #[test]
    fn a_map_goes_from_coarse_to_fine_and_adhesion_falls_with_kappa() {
        let (mut map, mut levels, mut rows) = (map(), Vec::new(), 0);
        let mut see = |map: &LiveMap| {
            rows += 1;
            levels.extend(map.level());
        };
        let control = Control::default().reporting_to(&mut see);
        map.compute(&mut Simulation::default(), control);
        levels.dedup();
        assert_eq!(levels, Level::ALL);
        assert_eq!(rows, 5 + 9 + 19 + 19);
        let grid = map.grid();
        assert_eq!(grid.size(), (HURSTS, KAPPAS), "H across");
        let shares = grid.statistics(Quantity::FirstTouchAdhesionShare, false);
        for column in 0..HURSTS {
            let cell = |row| grid.shown(column, row).unwrap().0.clone().unwrap();
            let regime = |row| cell(row).regimes[0].most().unwrap().0;
            assert_eq!(regime(0), Regime::PressureInsensitive);
            assert_eq!(regime(KAPPAS - 1), Regime::NonAdhesive);
            assert!((0..KAPPAS).all(|row| cell(row).regimes[0].profiles() == 4));
            let mean = |row: usize| shares[row * HURSTS + column].unwrap().mean;
            assert!(mean(0) > 0.5 && mean(KAPPAS - 1) < 0.01);
        }
        let (_, column, row) = grid.nearest((0.31, Some(1.02))).unwrap();
        assert_eq!(
            (
                grid.up.as_ref().unwrap().values[row],
                grid.across.values[column]
            ),
            (1.0, 0.3)
        );
    }

    #[test]
    fn the_map_of_a_study_of_the_same_cells_is_the_same() {
        let mut live = map();
        compute_rows(&mut live, 5);
        let [up, across] = [0, 1].map(|axis| Level::Coarse.places(&live.plan().axes[axis]));
        let list = |axis: usize, places: &[usize]| {
            let value = |&place: &usize| format!("{:?}", live.plan().axes[axis].values[place]);
            places.iter().map(value).collect::<Vec<_>>().join(", ")
        };
        let text = format!(
            "(version: 1, title: \"Map\", scene: {}, profiles: {}, record: [first_touch_adhesion_share, \
             adhesion_coefficient, regime, zero_force_adhesion_share, regime_after_zero_force, adhesion_share], axes: [List(path: \"adhesion.kappa\", values: [{}]), \
             List(path: \"roughness.hurst\", values: [{}])])",
            to_ron(&live.plan().scene),
            live.plan().lines,
            list(0, &up),
            list(1, &across),
        );
        let plan = Plan::parse(&text, "map", &Changes::default()).unwrap();
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::create(&place.path().join("study"), &plan).unwrap();
        run_study(&folder, Shard::WHOLE, Control::default().on_threads(1)).unwrap();
        merge(&folder).unwrap();
        let study = StudyMap::open(folder.path()).unwrap().grid(0);
        let (live, mut disagreeing) = (live.grid(), 0);
        for (row, &kappa) in up.iter().enumerate() {
            for (column, &hurst) in across.iter().enumerate() {
                let [mut studied, shown] = [study.shown(column, row), live.shown(hurst, kappa)]
                    .map(|place| place.unwrap().0.clone().unwrap());
                studied
                    .statistics
                    .iter_mut()
                    .flatten()
                    .for_each(|all| all.spread = None);
                assert_eq!(studied, shown, "{column} {row}");
                disagreeing += u64::from(studied.regimes[0].most().unwrap().1 < 4);
            }
        }
        assert!(disagreeing > 0, "no cell in which profiles differ");
    }

    #[test]
    fn known_cells_are_not_computed_again() {
        let mut once = map();
        compute_rows(&mut once, usize::MAX);
        let mut map = map();
        let mut rows = compute_rows(&mut map, 7);
        assert_eq!((rows, map.level()), (7, Some(Level::Coarse)));
        rows += compute_rows(&mut map, usize::MAX);
        assert_eq!(rows, 5 + 9 + 19 + 19);
        assert_eq!(map, once);
        assert_eq!(compute_rows(&mut map, usize::MAX), 0, "nothing is missing");
    }

    #[test]
    fn missing_cells_are_shown_by_the_nearest_of_a_coarser_level() {
        let mut map = map();
        assert!(map.grid().shown(3, 3).is_none());
        compute_rows(&mut map, 5);
        let grid = map.grid();
        for (asked, expected) in [
            ((0, 0), (0, 0)),
            ((1, 3), (0, 0)),
            ((3, 5), (4, 8)),
            ((18, 32), (18, 32)),
        ] {
            let (_, column, row) = grid.shown(asked.0, asked.1).unwrap();
            assert_eq!((column, row), expected, "{asked:?}");
        }
        let computed = grid.statistics(Quantity::FirstTouchAdhesionShare, false);
        assert_eq!(computed.iter().flatten().count(), 25);
        assert!(grid.shown(HURSTS, 0).is_none() && grid.shown(0, KAPPAS).is_none());
    }

    #[test]
    fn a_cell_that_cannot_be_computed_keeps_the_reason() {
        let document = open("pressure-sensitive").unwrap();
        let never = document
            .set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]")
            .unwrap();
        let mut map = LiveMap::new(Plan::of_map(never.scene()).unwrap()).unwrap();
        compute_rows(&mut map, 1);
        assert!(
            map.grid()
                .shown(0, 0)
                .is_some_and(|(cell, ..)| cell.as_ref().is_err_and(|why| !why.is_empty()))
        );
    }
}
