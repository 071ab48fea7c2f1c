//! Computation of the live map by the runner of studies, from coarse to fine.

use super::grid::Level;
use super::live_map::LiveMap;
use crate::simulation::{RunError, Simulation};
use crate::study::cell_summary::CellSummary;
use crate::study::cells::Cells;
use crate::study::recorder::{Recorder, Records};
use crate::study::solve::{Case, Next, Sink, Solver};
use crate::study::statistics::StudentT;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Computes the missing cells of a map, from coarse to fine and row by row: all κ of a row are on the same
/// profiles. `report` sees the map after each row. Files of the scene are looked up in `folder`. Stops as soon as
/// `stop` returns true; the unfinished row is then discarded.
///
/// A cell that cannot be computed holds the reason.
pub fn compute(map: &mut LiveMap, folder: &Path, stop: &dyn Fn() -> bool, report: &mut dyn FnMut(&LiveMap)) {
    let template = Arc::clone(map.template());
    let plan = template.plan();
    let cells = Cells::of(&plan);
    let mut recorder = Recorder::new(&plan, Simulation::new(folder.to_path_buf()), stop);
    let mut solver = Solver::new(&plan, &cells, |scene, seed| recorder.record(scene, seed));
    let mut quantiles = StudentT::default();
    for level in Level::ALL.into_iter().take_while(|level| *level <= template.finest()) {
        for &row in map.rows_of(level) {
            let missing = level.columns().filter(|&column| map.cell(column, row).is_none());
            let missing: Vec<(u64, usize)> = missing.map(|column| (map.index(column, row), column)).collect();
            if missing.is_empty() {
                continue;
            }
            let solved = missing.iter().map(|(run, _)| (*run, Ok(Vec::new()))).collect();
            let mut sink = RowSink { solved, stop };
            for line in 0..plan.lines {
                if solver.solve(&cells.whole_unit(row as u64, line), &mut sink).is_break() {
                    return;
                }
            }
            for (run, column) in missing {
                let Some(lines) = sink.solved.remove(&run) else { continue };
                let cell = lines.map(|lines| {
                    let lines: Vec<&[f64]> = lines.iter().map(Vec::as_slice).collect();
                    // Too few profiles for a confidence interval.
                    CellSummary::new(run, &plan.record, &lines, &mut quantiles).of_means()
                });
                map.set(column, row, cell.map_err(|error: RunError| error.to_string()));
            }
            report(map);
        }
    }
}

/// Sink of the missing cells of a row: the values of each profile so far, or a failure, by the number of the run.
struct RowSink<'a> {
    solved: BTreeMap<u64, Result<Vec<Vec<f64>>, RunError>>,
    stop: &'a dyn Fn() -> bool,
}

impl Sink for RowSink<'_> {
    fn next(&mut self, case: Case) -> Next {
        match self.solved.get(&case.run) {
            Some(Ok(_)) if (self.stop)() => Next::End,
            Some(Ok(_)) => Next::Solve,
            _ => Next::Skip,
        }
    }

    fn take(&mut self, case: Case, records: Result<Records, RunError>) -> ControlFlow<()> {
        match (self.solved.get_mut(&case.run), records) {
            (_, Err(error)) if error.is_interruption() => return ControlFlow::Break(()),
            (Some(lines), Err(error)) => *lines = Err(error),
            (Some(Ok(lines)), Ok(records)) => lines.extend(records),
            _ => {}
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Regime;
    use crate::scene::RoughnessParameter;
    use crate::scene::{Roughness, Scene, open, to_ron};
    use crate::study::map::{COLUMNS, MapModel, StudyMap, Template, hurst, parameter_value};
    use crate::study::{Changes, Folder, Options, Plan, Quantity, Shard, merge, run};
    use std::sync::Arc;

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
        LiveMap::new(Arc::new(Template::of(document.scene()).unwrap().over(parameter)))
    }

    /// Scene of a cell on one of its profiles.
    fn scene(map: &LiveMap, kappa: f64, wanted: f64, line: u64) -> Scene {
        let mut scene = map.template().plan().scene;
        scene.adhesion =
            Some(scene.adhesion.unwrap().with_parameter(RoughnessParameter::Kappa, kappa).unwrap());
        if let Some(Roughness::SelfAffine { hurst, seed, .. }) = &mut scene.roughness {
            (*hurst, *seed) = (wanted, *seed + line);
        }
        scene
    }

    #[test]
    fn a_map_goes_from_coarse_to_fine_and_from_what_sticks_to_what_does_not() {
        let (mut map, mut levels, mut rows) = (map(), Vec::new(), 0);
        compute(&mut map, Path::new(""), &|| false, &mut |map| {
            rows += 1;
            levels.extend(map.level());
        });
        levels.dedup();
        assert_eq!(levels, Level::ALL);
        assert_eq!(rows, 5 + 9 + 19 + 19);
        assert_eq!(map.model().size(), (map.rows(), COLUMNS), "H across");
        let shown = map.model().transposed();
        let share = shown.layer(Quantity::ZeroLoadAdhesionShare).unwrap();
        for row in 0..map.rows() {
            let map_cells: Vec<_> =
                (0..COLUMNS).map(|column| shown.shown(column, row).unwrap().cell.clone().unwrap()).collect();
            assert_eq!(map_cells[0].regime, Some(Regime::PressureInsensitive));
            assert_eq!(map_cells[COLUMNS - 1].regime, Some(Regime::NonAdhesive));
            assert!(
                map_cells.iter().all(|map_cell| (1..=4).contains(&map_cell.agreeing) && map_cell.lines == 4)
            );
            let along = shown.along_row(share, row);
            assert_eq!(along.len(), COLUMNS);
            assert!(along[0].1.mean > 0.5 && along[COLUMNS - 1].1.mean < 0.01);
        }
        let place = shown.nearest((1.02, Some(0.31))).unwrap();
        assert_eq!((kappa(place.column), hurst(place.row)), (1.0, 0.3));
        // The cell is the mean over its scenes.
        let mut shares = Vec::new();
        for line in 0..map.template().lines() {
            let scene = scene(&map, 1.0, 0.3, line);
            let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
            shares.push(outcome.zero_load_adhesion_force.unwrap() / outcome.ideal_adhesion_force.unwrap());
        }
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        let cell = map.cell(place.column, place.row).unwrap().as_ref().unwrap();
        let shown = shown.along_column(share, place.column)[place.row].1.mean;
        assert_eq!(Some(shown), cell.quantities[0].map(|spread| spread.mean));
        assert!((shown / mean - 1.0).abs() < 1e-14, "{shown} {mean}");
    }

    #[test]
    fn the_map_of_a_study_of_the_same_cells_is_the_same() {
        RoughnessParameter::ALL.into_iter().for_each(a_study_of_the_same_cells_has_the_same_map);
    }

    fn a_study_of_the_same_cells_has_the_same_map(parameter: RoughnessParameter) {
        let (mut live, mut rows) = (map_over(parameter), 0);
        let is_enough = std::cell::Cell::new(false);
        compute(&mut live, Path::new(""), &|| is_enough.get(), &mut |_| {
            rows += 1;
            is_enough.set(rows == 5);
        });
        let template = Arc::clone(live.template());
        let (columns, rows): (Vec<_>, Vec<_>) =
            (Level::Coarse.columns().collect(), live.rows_of(Level::Coarse).to_vec());
        let list =
            |values: Vec<f64>| values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", ");
        let text = format!(
            "(version: 1, title: \"Map\", scene: {}, lines: {}, record: [zero_load_adhesion_share, adhesion_coefficient, regime], axes: [\
             List(path: \"{}\", values: [{}]), List(path: \"roughness.hurst\", values: [{}])])",
            to_ron(&live.template().plan().scene),
            template.lines(),
            parameter.name(),
            list(columns.iter().map(|&column| parameter_value(parameter, column)).collect()),
            list(rows.iter().map(|&row| hurst(row)).collect()),
        );
        let plan = Plan::parse(&text, "map", &Changes::default()).unwrap_or_else(|errors| panic!("{errors}"));
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::create(&place.path().join("study"), &plan).unwrap();
        run(&folder, Options { jobs: 1, shard: Shard::WHOLE }, &|| false, &mut |_| ()).unwrap();
        merge(&folder, false).unwrap();
        let study = StudyMap::open(folder.path()).unwrap().model(0).transposed();
        let live = live.model().transposed();
        let mut divided = 0;
        for (up, &row) in rows.iter().enumerate() {
            for (across, &column) in columns.iter().enumerate() {
                let [studied, shown] = [study.shown(across, up), live.shown(column, row)]
                    .map(|place| place.unwrap().cell.clone().unwrap());
                let place = (parameter_value(parameter, column), hurst(row));
                assert_eq!(studied, shown, "{parameter:?}, H: {place:?}");
                for quantity in [Quantity::ZeroLoadAdhesionShare, Quantity::AdhesionCoefficient] {
                    let mean = |map: &MapModel, column, row| {
                        Some(map.estimate(map.layer(quantity)?, column, row)?.mean.to_bits())
                    };
                    assert_eq!(mean(&study, across, up), mean(&live, column, row), "{quantity:?}");
                    assert!(mean(&live, column, row).is_some());
                }
                divided += u64::from(studied.agreeing < studied.lines);
            }
        }
        assert!(divided > 0, "no cell in which lines differ");
    }

    #[test]
    fn what_is_known_is_not_computed_again_and_a_stop_keeps_whole_rows() {
        let mut once = map();
        compute(&mut once, Path::new(""), &|| false, &mut |_| ());
        let (mut map, rows) = (map(), std::cell::Cell::new(0));
        compute(&mut map, Path::new(""), &|| rows.get() == 7, &mut |_| rows.set(rows.get() + 1));
        assert_eq!((rows.get(), map.level()), (7, Some(Level::Coarse)));
        compute(&mut map, Path::new(""), &|| false, &mut |_| rows.set(rows.get() + 1));
        assert_eq!(rows.get(), 5 + 9 + 19 + 19);
        assert_eq!(map, once);
        compute(&mut map, Path::new(""), &|| false, &mut |_| panic!("nothing is missing"));
    }

    #[test]
    fn what_is_missing_is_shown_by_the_nearest_of_a_coarser_map() {
        let (mut map, rows) = (map(), std::cell::Cell::new(0));
        assert_eq!(map.model().shown(3, 3), None);
        compute(&mut map, Path::new(""), &|| rows.get() == 5, &mut |_| rows.set(rows.get() + 1));
        let shown = map.model().transposed();
        for (asked, expected) in [((0, 0), (0, 0)), ((3, 1), (0, 0)), ((5, 3), (8, 4)), ((32, 18), (32, 18))]
        {
            let place = shown.shown(asked.0, asked.1).unwrap();
            assert_eq!((place.column, place.row), expected, "{asked:?}");
        }
        // A section shows computed cells only, none in place of another.
        assert_eq!(shown.along_row(&shown.layers()[0], 0).len(), 5);
        assert_eq!((shown.shown(COLUMNS, 0), shown.shown(0, 19)), (None, None));
    }

    #[test]
    fn what_cannot_be_computed_says_why() {
        let document = open("pressure-sensitive").unwrap();
        let never = document.set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]").unwrap();
        let mut map = LiveMap::new(Arc::new(Template::of(never.scene()).unwrap()));
        let reported = std::cell::Cell::new(false);
        compute(&mut map, Path::new(""), &|| reported.get(), &mut |_| reported.set(true));
        assert!(map.cell(0, 0).is_some_and(|cell| cell.as_ref().is_err_and(|why| !why.is_empty())));
    }
}
