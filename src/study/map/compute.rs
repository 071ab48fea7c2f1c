//! Computes a map.

use super::grid::{Level, hurst, kappa};
use super::{Cell, LiveMap, Template};
use crate::analysis::{CellRegime, Regime};
use crate::simulation::{Outcome, RunError, Simulation};
use std::path::Path;

/// Contribution of one line to a cell; forces in N, zero where there is none.
#[derive(Clone, Copy)]
struct OfLine {
    zero_load_adhesion: f64,
    adhesion: f64,
    preload: f64,
    ideal_adhesion: f64,
    regime: Option<Regime>,
}

/// Computes the cells that a map lacks, from coarse to fine and row by row: all κ of a row are those of the same
/// lines. `tell` sees the map after each row. Files the scene names are looked for in `folder`. Gives up as
/// soon as `stop` says so; the row under way is then lost.
///
/// A cell that cannot be computed tells why in its place.
pub fn chart(map: &mut LiveMap, folder: &Path, stop: &dyn Fn() -> bool, tell: &mut dyn FnMut(&LiveMap)) {
    let basis = std::sync::Arc::clone(map.basis());
    let mut simulation = Simulation::new(folder.to_path_buf());
    for level in Level::ALL.into_iter().take_while(|level| *level <= basis.finest()) {
        for &row in map.rows_of(level) {
            let columns: Vec<usize> =
                level.columns().filter(|&column| map.cell(column, row).is_none()).collect();
            if columns.is_empty() {
                continue;
            }
            let Some(cells) = cells(&mut simulation, &basis, hurst(row), &columns, stop) else { return };
            for (column, cell) in columns.into_iter().zip(cells) {
                map.set(column, row, cell);
            }
            tell(map);
        }
    }
}

/// Cells of one row; `None` when told to stop.
fn cells(
    simulation: &mut Simulation,
    basis: &Template,
    hurst: f64,
    columns: &[usize],
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Result<Cell, String>>> {
    let mut lines: Vec<Result<Vec<OfLine>, RunError>> = vec![Ok(Vec::new()); columns.len()];
    for line in 0..basis.lines() {
        for (&column, cell) in columns.iter().zip(&mut lines) {
            let Ok(so_far) = cell else { continue };
            if stop() {
                return None;
            }
            match simulation.run(&basis.scene(kappa(column), hurst, line), stop, &mut |_, _, _| Ok(())) {
                Ok(outcome) => so_far.push(OfLine::of(&outcome)),
                Err(error) if error.is_interruption() => return None,
                Err(error) => *cell = Err(error),
            }
        }
    }
    Some(
        lines
            .into_iter()
            .map(|lines| lines.map(|lines| mean(&lines)).map_err(|error| error.to_string()))
            .collect(),
    )
}

impl OfLine {
    fn of(outcome: &Outcome) -> Self {
        OfLine {
            zero_load_adhesion: outcome.zero_load_adhesion_force.unwrap_or(0.0),
            adhesion: outcome.figures.adhesion_force.unwrap_or(0.0),
            preload: outcome.figures.preload.unwrap_or(0.0),
            ideal_adhesion: outcome.ideal_adhesion_force.unwrap_or(0.0),
            regime: outcome.regime,
        }
    }
}

/// A cell of its lines.
fn mean(lines: &[OfLine]) -> Cell {
    let mean = |of: fn(&OfLine) -> f64| lines.iter().map(of).sum::<f64>() / lines.len() as f64;
    Cell {
        zero_load_adhesion: mean(|line| line.zero_load_adhesion),
        adhesion: mean(|line| line.adhesion),
        preload: mean(|line| line.preload),
        ideal_adhesion: mean(|line| line.ideal_adhesion),
        regime: CellRegime::from_lines(lines.iter().map(|line| line.regime)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{open, to_ron};
    use crate::study::map::{KAPPAS, StudyMap};
    use crate::study::{Changes, Folder, Options, Plan, Quantity, Shard, merge, run};
    use std::sync::Arc;

    /// The map of a small scene.
    fn map() -> LiveMap {
        let document = open("pressure-sensitive").unwrap();
        let small = [("numerics.points", "128"), ("roughness.modes", "(1, 32)")];
        let small = small.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let document = document.set_all(&small).unwrap();
        LiveMap::new(Arc::new(Template::of(document.scene()).unwrap()))
    }

    #[test]
    fn a_map_goes_from_coarse_to_fine_and_from_what_sticks_to_what_does_not() {
        let (mut map, mut levels, mut rows) = (map(), Vec::new(), 0);
        chart(&mut map, Path::new(""), &|| false, &mut |map| {
            rows += 1;
            levels.extend(map.level());
        });
        levels.dedup();
        assert_eq!(levels, Level::ALL);
        assert_eq!(rows, 5 + 9 + 19 + 19);
        let plane = map.plane();
        assert_eq!(plane.size(), (KAPPAS, map.rows()));
        let share = plane.layer(Quantity::ZeroLoadAdhesionShare).unwrap();
        for row in 0..map.rows() {
            let spots: Vec<_> =
                (0..KAPPAS).map(|column| plane.shown(column, row).unwrap().spot.clone().unwrap()).collect();
            assert_eq!(spots[0].regime, Some(Regime::PressureInsensitive));
            assert_eq!(spots[KAPPAS - 1].regime, Some(Regime::NonAdhesive));
            assert!(spots.iter().all(|spot| (1..=4).contains(&spot.agreeing) && spot.lines == 4));
            let along = plane.along_kappa(share, row);
            assert_eq!(along.len(), KAPPAS);
            assert!(along[0].1.mean > 0.5 && along[KAPPAS - 1].1.mean < 0.01);
        }
        let place = plane.nearest(1.02, Some(0.31)).unwrap();
        assert_eq!((kappa(place.column), hurst(place.row)), (1.0, 0.3));
        let cell = map.cell(place.column, place.row).unwrap();
        assert_eq!(
            plane.along_hurst(share, place.column)[place.row].1.mean,
            cell.as_ref().unwrap().zero_load_share()
        );
        // What it says is what the scene of the cell gives.
        let mut forces = Vec::new();
        for line in 0..map.basis().lines() {
            let scene = map.basis().scene(1.0, 0.3, line);
            let outcome = Simulation::default().run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
            forces.push(outcome.zero_load_adhesion_force.unwrap());
        }
        assert_eq!(
            cell.as_ref().unwrap().zero_load_adhesion,
            forces.iter().sum::<f64>() / forces.len() as f64
        );
    }

    #[test]
    fn the_map_of_a_study_of_the_same_cells_has_the_same_regimes() {
        let (mut live, mut rows) = (map(), 0);
        let is_enough = std::cell::Cell::new(false);
        chart(&mut live, Path::new(""), &|| is_enough.get(), &mut |_| {
            rows += 1;
            is_enough.set(rows == 5);
        });
        let basis = Arc::clone(live.basis());
        let (columns, rows): (Vec<_>, Vec<_>) =
            (Level::Coarse.columns().collect(), live.rows_of(Level::Coarse).to_vec());
        let list =
            |values: Vec<f64>| values.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", ");
        let text = format!(
            "(version: 1, title: \"Map\", scene: {}, lines: {}, record: [regime], axes: [\
             List(path: \"kappa\", values: [{}]), List(path: \"roughness.hurst\", values: [{}])])",
            to_ron(&basis.scene(1.0, 0.5, 0)),
            basis.lines(),
            list(columns.iter().map(|&column| kappa(column)).collect()),
            list(rows.iter().map(|&row| hurst(row)).collect()),
        );
        let plan = Plan::parse(&text, "map", &Changes::default()).unwrap_or_else(|errors| panic!("{errors}"));
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::create(&place.path().join("study"), &plan).unwrap();
        run(&folder, Options { jobs: 1, shard: Shard::WHOLE }, &|| false, &mut |_| ()).unwrap();
        merge(&folder, false).unwrap();
        let study = StudyMap::open(folder.path()).unwrap().plane(0);
        let live = live.plane();
        let mut divided = 0;
        for (up, &row) in rows.iter().enumerate() {
            for (across, &column) in columns.iter().enumerate() {
                let [studied, shown] = [study.shown(across, up), live.shown(column, row)]
                    .map(|place| place.unwrap().spot.clone().unwrap());
                assert_eq!(studied, shown, "κ = {}, H = {}", kappa(column), hurst(row));
                divided += u64::from(studied.agreeing < studied.lines);
            }
        }
        assert!(divided > 0, "no cell in which lines differ");
    }

    #[test]
    fn what_is_known_is_not_computed_again_and_a_stop_keeps_whole_rows() {
        let mut once = map();
        chart(&mut once, Path::new(""), &|| false, &mut |_| ());
        let (mut map, rows) = (map(), std::cell::Cell::new(0));
        chart(&mut map, Path::new(""), &|| rows.get() == 7, &mut |_| rows.set(rows.get() + 1));
        assert_eq!((rows.get(), map.level()), (7, Some(Level::Coarse)));
        chart(&mut map, Path::new(""), &|| false, &mut |_| rows.set(rows.get() + 1));
        assert_eq!(rows.get(), 5 + 9 + 19 + 19);
        assert_eq!(map, once);
        chart(&mut map, Path::new(""), &|| false, &mut |_| panic!("nothing is missing"));
    }

    #[test]
    fn what_is_missing_is_shown_by_the_nearest_of_a_coarser_map() {
        let (mut map, rows) = (map(), std::cell::Cell::new(0));
        assert_eq!(map.plane().shown(3, 3), None);
        chart(&mut map, Path::new(""), &|| rows.get() == 5, &mut |_| rows.set(rows.get() + 1));
        let plane = map.plane();
        for (asked, stands) in [((0, 0), (0, 0)), ((3, 1), (0, 0)), ((5, 3), (8, 4)), ((32, 18), (32, 18))] {
            let place = plane.shown(asked.0, asked.1).unwrap();
            assert_eq!((place.column, place.row), stands, "{asked:?}");
        }
        // A section has what was computed, and nothing that only stands for it.
        assert_eq!(plane.along_kappa(&plane.layers()[0], 0).len(), 5);
        assert_eq!((plane.shown(KAPPAS, 0), plane.shown(0, 19)), (None, None));
    }

    #[test]
    fn what_cannot_be_computed_says_why() {
        let document = open("pressure-sensitive").unwrap();
        let never = document.set("loading", "[ToForce(1.0e-5), ToForce(-1.0)]").unwrap();
        let mut map = LiveMap::new(Arc::new(Template::of(never.scene()).unwrap()));
        let told = std::cell::Cell::new(false);
        chart(&mut map, Path::new(""), &|| told.get(), &mut |_| told.set(true));
        assert!(map.cell(0, 0).is_some_and(|cell| cell.as_ref().is_err_and(|why| !why.is_empty())));
    }
}
