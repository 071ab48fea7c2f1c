//! The live map over H and κ or e_el/γ: a study in memory, computed from coarse to fine.

use super::levels::{COLUMNS, HURSTS, Level};
use crate::simulation::Simulation;
use crate::study::StudyError;
use crate::study::cells::Run;
use crate::study::grid::Grid;
use crate::study::plan::Plan;
use crate::study::recorder::Recorder;
use crate::study::results::Results;
use std::collections::BTreeMap;
use std::path::Path;

/// A map with the cells computed so far.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    results: Results,
    /// Reasons for cells that could not be computed.
    failed: BTreeMap<u64, String>,
}

impl LiveMap {
    /// A map of a plan of [`live_plan`](super::live_plan()), without cells.
    ///
    /// # Errors
    /// A map that is too large for the memory.
    pub fn new(plan: Plan) -> Result<Self, StudyError> {
        Ok(LiveMap { results: Results::empty(plan)?, failed: BTreeMap::new() })
    }

    /// The plan of all cells: number row · [`COLUMNS`] + column.
    pub fn plan(&self) -> &Plan {
        self.results.plan()
    }

    fn has_hurst(&self) -> bool {
        self.plan().axes.len() > 1
    }

    fn finest(&self) -> Level {
        Level::finest(self.plan().scene.numerics.points)
    }

    /// The rows of a level on this map: one for a scene without H.
    pub fn rows_of(&self, level: Level) -> &'static [usize] {
        if self.has_hurst() { level.rows() } else { &[0] }
    }

    /// Number of a cell, row by row.
    fn number(column: usize, row: usize) -> u64 {
        (row * COLUMNS + column) as u64
    }

    /// Returns true for a computed cell, or one that cannot be computed.
    fn is_known(&self, cell: u64) -> bool {
        self.failed.contains_key(&cell) || self.results.is_whole(cell)
    }

    /// Sets the values of a cell on a profile, in the order of [`super::RECORD`].
    pub fn set(&mut self, column: usize, row: usize, line: u64, values: &[f64; super::RECORD.len()]) {
        self.results.set(Self::number(column, row) * self.plan().lines + line, values);
    }

    /// Returns true if all cells of a level are known.
    pub fn has(&self, level: Level) -> bool {
        let rows = self.rows_of(level).iter();
        rows.copied().all(|row| level.columns().all(|column| self.is_known(Self::number(column, row))))
    }

    /// The finest complete level.
    pub fn level(&self) -> Option<Level> {
        Level::ALL.into_iter().take_while(|level| self.has(*level)).last()
    }

    /// Returns true for a complete map.
    pub fn is_whole(&self) -> bool {
        self.has(self.finest())
    }

    /// Computes the missing cells, from coarse to fine and row by row: all κ of a row are on the same profiles. `report`
    /// sees the map after each row. Files of the scene are looked up in `folder`. Stops as soon as `stop` returns true
    /// and keeps the records so far. A cell that cannot be computed keeps the reason.
    pub fn compute(&mut self, folder: &Path, stop: &dyn Fn() -> bool, report: &mut dyn FnMut(&LiveMap)) {
        let plan = self.results.plan().clone();
        let mut recorder = Recorder::new(&plan, Simulation::new(folder.to_path_buf()), stop);
        let finest = self.finest();
        for level in Level::ALL.into_iter().take_while(|level| *level <= finest) {
            for &row in self.rows_of(level) {
                let wanted: Vec<u64> = level.columns().map(|column| Self::number(column, row)).collect();
                if wanted.iter().all(|cell| self.is_known(*cell)) {
                    continue;
                }
                for line in 0..plan.lines {
                    for &cell in &wanted {
                        if self.failed.contains_key(&cell) || self.results.has(cell, line) {
                            continue;
                        }
                        if stop() {
                            return;
                        }
                        match recorder.record(&Run { cells: cell..cell + 1, line }) {
                            Ok(records) => self.results.set(cell * plan.lines + line, &records.concat()),
                            Err(error) if error.is_interruption() => return,
                            Err(error) => drop(self.failed.insert(cell, error.to_string())),
                        }
                    }
                }
                report(self);
            }
        }
    }

    /// The map for display: H across, and κ or e_el/γ up as in the paper. Of too few profiles for a confidence, cells
    /// have the range of the profiles alone.
    pub fn grid(&self) -> Grid {
        let (has_hurst, count) = (self.has_hurst(), self.plan().axes.len());
        let mut grid = self.results.grid((0, has_hurst.then_some(1)), vec![0; count], self.results.layers());
        for index in 0..grid.cells.len() {
            let (column, row) = if has_hurst { (index / HURSTS, index % HURSTS) } else { (index, 0) };
            let (number, cell) = (Self::number(column, row), &mut grid.cells[index]);
            if let Some(why) = self.failed.get(&number) {
                *cell = Some(Err(why.clone()));
            } else if !self.results.is_whole(number) {
                *cell = None;
            }
            let estimates = cell.iter_mut().flatten().flat_map(|cell| &mut cell.estimates);
            estimates.flatten().for_each(|estimate| estimate.interval = None);
            let (column, row) = self.stand_in(column, row);
            grid.stand_ins[index] = if has_hurst { column * HURSTS + row } else { column };
        }
        grid
    }

    /// The cell shown for this cell: itself or, until it is computed, one of a coarser level.
    fn stand_in(&self, column: usize, row: usize) -> (usize, usize) {
        let near = |all: &mut dyn Iterator<Item = usize>, wanted: usize| {
            all.min_by_key(|one| one.abs_diff(wanted)).unwrap_or(wanted)
        };
        let on_level = |level: Level| {
            let column = near(&mut level.columns(), column);
            let row = near(&mut self.rows_of(level).iter().copied(), row);
            self.is_known(Self::number(column, row)).then_some((column, row))
        };
        Level::ALL.into_iter().rev().find_map(on_level).unwrap_or((column, row))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{StudyMap, hurst, live_plan, parameter_value};
    use super::*;
    use crate::analysis::Regime;
    use crate::scene::{RoughnessParameter, open, to_ron};
    use crate::study::{Changes, Folder, Options, Quantity, Shard, merge, run};
    use std::cell::Cell;

    fn kappa(column: usize) -> f64 {
        parameter_value(RoughnessParameter::Kappa, column)
    }

    /// Map of a small scene over κ.
    fn map() -> LiveMap {
        map_over(RoughnessParameter::Kappa)
    }

    fn map_over(parameter: RoughnessParameter) -> LiveMap {
        let document = open("pressure-sensitive").unwrap();
        let small = [("numerics.points", "128"), ("roughness.modes", "(1, 32)")];
        let small = small.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = document.set_all(&small).unwrap();
        LiveMap::new(live_plan(document.scene(), parameter).unwrap()).unwrap()
    }

    #[test]
    fn a_map_goes_from_coarse_to_fine_and_adhesion_falls_with_kappa() {
        let (mut map, mut levels, mut rows) = (map(), Vec::new(), 0);
        map.compute(Path::new(""), &|| false, &mut |map| {
            rows += 1;
            levels.extend(map.level());
        });
        levels.dedup();
        assert_eq!(levels, Level::ALL);
        assert_eq!(rows, 5 + 9 + 19 + 19);
        let grid = map.grid();
        assert_eq!(grid.size(), (HURSTS, COLUMNS), "H across");
        let shares = grid.estimates(Quantity::ZeroLoadAdhesionShare, false);
        for column in 0..HURSTS {
            let cell = |row| grid.shown(column, row).unwrap().0.clone().unwrap();
            let regime = |row| cell(row).regime.unwrap().regime;
            assert_eq!(regime(0), Regime::PressureInsensitive);
            assert_eq!(regime(COLUMNS - 1), Regime::NonAdhesive);
            assert!((0..COLUMNS).all(|row| (1..=4).contains(&cell(row).agreeing()) && cell(row).lines == 4));
            let mean = |row: usize| shares[row * HURSTS + column].unwrap().mean;
            assert!(mean(0) > 0.5 && mean(COLUMNS - 1) < 0.01);
        }
        let (_, column, row) = grid.nearest((0.31, Some(1.02))).unwrap();
        assert_eq!((kappa(row), hurst(column)), (1.0, 0.3));
    }

    #[test]
    fn the_map_of_a_study_of_the_same_cells_is_the_same() {
        for parameter in RoughnessParameter::ALL {
            let (mut live, rows) = (map_over(parameter), Cell::new(0));
            live.compute(Path::new(""), &|| rows.get() == 5, &mut |_| rows.set(rows.get() + 1));
            let (columns, rows): (Vec<_>, Vec<_>) =
                (Level::Coarse.columns().collect(), live.rows_of(Level::Coarse).to_vec());
            let list = |values: Vec<f64>| {
                values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", ")
            };
            let text = format!(
                "(version: 1, title: \"Map\", scene: {}, lines: {}, record: [zero_load_adhesion_share, \
                 adhesion_coefficient, regime], axes: [List(path: \"{}\", values: [{}]), \
                 List(path: \"roughness.hurst\", values: [{}])])",
                to_ron(&live.plan().scene),
                live.plan().lines,
                parameter.name(),
                list(columns.iter().map(|&column| parameter_value(parameter, column)).collect()),
                list(rows.iter().map(|&row| hurst(row)).collect()),
            );
            let plan = Plan::parse(&text, "map", &Changes::default()).unwrap();
            let place = tempfile::tempdir().unwrap();
            let folder = Folder::create(&place.path().join("study"), &plan).unwrap();
            run(&folder, Options { jobs: 1, shard: Shard::WHOLE }, &|| false, &mut |_| ()).unwrap();
            merge(&folder, false).unwrap();
            let study = StudyMap::open(folder.path()).unwrap().grid(0);
            let (live, mut disagreeing) = (live.grid(), 0);
            for (up, &column) in columns.iter().enumerate() {
                for (across, &row) in rows.iter().enumerate() {
                    let [mut studied, shown] = [study.shown(across, up), live.shown(row, column)]
                        .map(|place| place.unwrap().0.clone().unwrap());
                    studied.estimates.iter_mut().flatten().for_each(|estimate| estimate.interval = None);
                    assert_eq!(studied, shown, "{parameter:?}, {across} {up}");
                    disagreeing += u64::from(studied.agreeing() < studied.lines);
                }
            }
            assert!(disagreeing > 0, "no cell in which profiles differ");
        }
    }

    #[test]
    fn known_cells_are_not_computed_again() {
        let mut once = map();
        once.compute(Path::new(""), &|| false, &mut |_| ());
        let (mut map, rows) = (map(), Cell::new(0));
        map.compute(Path::new(""), &|| rows.get() == 7, &mut |_| rows.set(rows.get() + 1));
        assert_eq!((rows.get(), map.level()), (7, Some(Level::Coarse)));
        map.compute(Path::new(""), &|| false, &mut |_| rows.set(rows.get() + 1));
        assert_eq!(rows.get(), 5 + 9 + 19 + 19);
        assert_eq!(map, once);
        map.compute(Path::new(""), &|| false, &mut |_| panic!("nothing is missing"));
    }

    #[test]
    fn a_cell_that_cannot_be_computed_keeps_the_reason() {
        let document = open("pressure-sensitive").unwrap();
        let never = document.set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]").unwrap();
        let mut map = LiveMap::new(live_plan(never.scene(), RoughnessParameter::Kappa).unwrap()).unwrap();
        let reported = Cell::new(false);
        map.compute(Path::new(""), &|| reported.get(), &mut |_| reported.set(true));
        assert!(
            map.grid().shown(0, 0).is_some_and(|(cell, ..)| cell.as_ref().is_err_and(|why| !why.is_empty()))
        );
    }
}
