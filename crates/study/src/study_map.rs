//! The maps of a finished study over two of its axes.

use super::axis::Axis;
use super::error::StudyError;
use super::grid::{Grid, GridLayer, across_and_up};
use super::place::{governing, press, scene_with};
use super::plan::Plan;
use super::results::Results;
use asperity_scene::{Adhesion, Document, Roughness, Scene, SceneErrors};
use std::path::{Path, PathBuf};

/// Results of a study as maps over two of its axes. There is one map for each combination of values
/// on the other axes. If the study has only one axis, the map is a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyMap {
    folder: PathBuf,
    study: Results,
    /// Index of the horizontal axis of the maps in the plan.
    across: usize,
    up: Option<usize>,
    others: Vec<usize>,
    /// Quantities that the maps show. Each has one scale for all maps.
    layers: Vec<GridLayer>,
}

impl StudyMap {
    /// Reads the maps of a study from its folder.
    ///
    /// # Errors
    /// Returns an error if [`merge`](crate::merge) has not written the tables of the study yet, or
    /// if no axis of the study has two values.
    pub fn open(folder: &Path) -> Result<StudyMap, StudyError> {
        StudyMap::of(Results::open(folder)?, folder)
    }

    /// Makes the maps of the study whose results are `study`. `folder` is the folder from which the
    /// results were read.
    ///
    /// # Errors
    /// Returns an error if no axis of the study has two values.
    pub fn of(study: Results, folder: &Path) -> Result<StudyMap, StudyError> {
        let axes = &study.plan().axes;
        let free: Vec<usize> = (0..axes.len())
            .filter(|axis| axes[*axis].values.len() > 1)
            .collect();
        let Some((across, up)) = across_and_up(axes, &free) else {
            let reason = "this study has one cell and no map; a curve needs an axis with two values at least";
            return Err(StudyError::folder(folder, reason));
        };
        let others = (0..axes.len())
            .filter(|axis| *axis != across && Some(*axis) != up)
            .collect();
        // `components` leaves out a separator at the end of the path.
        let folder = folder.components().collect();
        Ok(StudyMap {
            folder,
            across,
            up,
            others,
            layers: study.layers(),
            study,
        })
    }

    /// Returns the path of the folder from which the results of the study were read.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the name of the study, which is the last part of the path of the folder.
    pub fn name(&self) -> String {
        let whole = std::path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone());
        whole
            .file_name()
            .unwrap_or(self.folder.as_os_str())
            .to_string_lossy()
            .into_owned()
    }

    /// Returns the plan of the study whose results the maps show.
    pub fn plan(&self) -> &Plan {
        self.study.plan()
    }

    /// Returns the number of maps. There is one map for each combination of values on the axes of
    /// the study that are not shown as axes of the maps.
    pub fn slices(&self) -> u64 {
        self.others
            .iter()
            .map(|&other| self.plan().axes[other].count())
            .product()
    }

    /// Returns the index of the value on each axis of the study for map number `slice`. On the axes
    /// of the maps the index is 0.
    fn places(&self, slice: u64) -> Vec<usize> {
        self.plan().places_on(self.others.iter().copied(), slice)
    }

    /// Returns the axes of the study that are not axes of the maps. Each comes with the index of
    /// the value that it has in map number `slice`.
    fn at(&self, slice: u64) -> impl Iterator<Item = (&Axis, usize)> {
        let places = self.places(slice);
        self.others
            .iter()
            .map(move |&other| (&self.plan().axes[other], places[other]))
    }

    /// Returns map number `slice`. The first map has the number 0.
    pub fn grid(&self, slice: u64) -> Grid {
        self.study.grid(
            (self.across, self.up),
            self.places(slice),
            self.layers.clone(),
        )
    }

    fn over(&self) -> impl Iterator<Item = &Axis> {
        [Some(self.across), self.up]
            .into_iter()
            .flatten()
            .map(|axis| &self.plan().axes[axis])
    }

    /// Returns the scene of map number `slice` on the first profile of the study. `over` has values
    /// on the axes of the map. On an axis without a value in `over`, the scene has the value that
    /// the scene of the plan has.
    fn scene(&self, slice: u64, over: &[(&Axis, f64)]) -> Result<Scene, SceneErrors> {
        let plan = self.plan();
        let mut scene = plan.scene.clone();
        if scene.title.is_empty() {
            (scene.title, scene.notice) = (plan.title.clone(), plan.notice.clone());
        }
        if scene.adhesion.is_none() {
            let mut axes = self.over();
            scene.adhesion = axes.find_map(|axis| {
                let parameter = axis.target.parameter()?;
                let middle = axis.values[axis.values.len() / 2];
                Some(Adhesion::by_parameter(parameter, middle))
            });
        }
        scene.set_seed(plan.seed);
        let of_slice = self
            .at(slice)
            .map(|(axis, place)| (axis, axis.values[place]));
        let values: Vec<(&Axis, f64)> = of_slice.chain(over.iter().copied()).collect();
        scene = scene_with(&scene, values.iter().copied())?;
        let preload = values
            .iter()
            .find(|(axis, _)| axis.is_of_preloads())
            .copied();
        if let Some((axis, preload)) =
            preload.or_else(|| plan.preloads().map(|axis| (axis, axis.values[0])))
        {
            press(&mut scene, axis, preload);
        }
        Ok(scene)
    }

    /// Returns a scene file for the explorer. It has the scene of the study with the values of map
    /// number 0 on all axes.
    ///
    /// # Errors
    /// Returns an error if a value of the scene is not allowed.
    pub fn document(&self) -> Result<Document, SceneErrors> {
        // The path is written as the user has given it. A command with this path then opens the
        // study again.
        Document::from_scene(&self.scene(0, &[])?, &self.folder.display().to_string())
    }

    /// Returns true if a scene has a place on map number `slice`. It may differ from the scene of
    /// the map in two respects only: the values on the axes of the map, and the number of points of
    /// the force curve.
    pub fn is_of(&self, slice: u64, scene: &Scene) -> bool {
        let known: Vec<_> = self
            .over()
            .filter_map(|axis| Some((axis, axis.value_in(scene, None)?)))
            .collect();
        let Ok(mut of_map) = self.scene(slice, &known) else {
            return false;
        };
        let mut scene = scene.clone();
        match [&of_map, &scene].map(Plan::of_map) {
            [Ok(one), Ok(other)] => one == other && is_close(place(&of_map), place(&scene)),
            _ => {
                of_map.strip();
                scene.strip();
                of_map == scene
            }
        }
    }

    /// Returns a copy of a scene file in which the quantities of the other axes of the study, which
    /// are not axes of the maps, have the values of map number `slice`.
    ///
    /// # Errors
    /// Returns an error if the scene does not allow these values.
    pub fn follow(&self, slice: u64, document: &Document) -> Result<Document, SceneErrors> {
        let values: Vec<_> = self
            .at(slice)
            .map(|(axis, place)| (axis, axis.values[place]))
            .collect();
        Axis::set_all(document, &values)
    }
}

/// Returns κ and H of a scene with a self-affine roughness. Returns `None` for another scene: on a
/// measured profile, for example, κ and H depend on the file.
fn place(scene: &Scene) -> Option<(f64, f64)> {
    let Some(Roughness::SelfAffine { hurst, .. }) = scene.roughness else {
        return None;
    };
    Some((governing(scene)?.kappa?, hurst))
}

/// Returns true if two scenes have the same κ and H except for rounding errors, or if one of the
/// scenes does not state them.
fn is_close(first: Option<(f64, f64)>, second: Option<(f64, f64)>) -> bool {
    let (Some((kappa, hurst)), Some((other_kappa, other_hurst))) = (first, second) else {
        return true;
    };
    is_equal(kappa, other_kappa) && is_equal(hurst, other_hurst)
}

/// Returns true if two numbers are equal except for rounding errors.
fn is_equal(first: f64, second: f64) -> bool {
    (first - second).abs() <= 1e-9 * first.abs().max(second.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan_text::Changes;
    use crate::quantity::Quantity;
    use crate::store::Folder;
    use asperity_contact::Move;
    use asperity_data::AxisScale;
    use asperity_scene::{Regime, RoughnessParameter};

    /// In this plan κ comes before H and does not ascend. The plan also has two preloads, a third
    /// axis and five profiles.
    const PLAN: &str = r#"(
        version: 1,
        title: "A study",
        scene: (
            version: 1,
            material: (modulus: 2.0e6),
            length: 1.0e-4,
            roughness: SelfAffine(hurst: 0.5, rms_height: 1.0e-7, modes: (1, 32), seed: 1),
            numerics: (points: 128),
        ),
        axes: [
            List(path: "adhesion.kappa", values: [4.0, 1.0, 2.0]),
            List(path: "roughness.modes.1", values: [16, 32]),
            Linear(path: "roughness.hurst", from: 0.25, to: 0.75, count: 2),
        ],
        preloads: [0.5, 2.0],
        profiles: 5,
        seed: 7,
        record: [adhesion_coefficient, regime, preload_force],
    )"#;

    /// Makes the maps of a plan with made-up results. In each cell F_a/F_n is the number of the
    /// cell, the preload is the same number in µN, and the profiles have the regimes of `REGIMES`.
    /// Cell 5 is missing.
    fn study_map(plan: &str) -> StudyMap {
        let plan = Plan::parse(plan, "plan", &Changes::default()).unwrap();
        let folder = tempfile::tempdir().unwrap();
        Folder::create(folder.path(), &plan).unwrap();
        let mut study = Results::empty(plan.clone()).unwrap();
        for place in (0..plan.records_in_all()).filter(|place| place / plan.lines != 5) {
            let cell = place / plan.lines;
            let regime = REGIMES[cell as usize % 3][place as usize % 5];
            study.set(
                place,
                &[cell as f64, regime, 1e-6 * cell as f64][..plan.record.len()],
            );
        }
        StudyMap::of(study, folder.path()).unwrap()
    }

    const REGIMES: [[f64; 5]; 3] = [
        [0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 1.0, 1.0, 1.0],
        [1.0, 1.0, 2.0, 2.0, 2.0],
    ];

    #[test]
    fn maps_have_the_cells_of_the_study() {
        let study_map = study_map(PLAN);
        assert_eq!(study_map.slices(), 4);
        assert_eq!(
            study_map.grid(0).fixed,
            ["k_max = 16", "F_n/(E* h L) = 0.5"]
        );
        assert_eq!(study_map.grid(1).fixed, ["k_max = 16", "F_n/(E* h L) = 2"]);
        assert_eq!(
            study_map.grid(2).fixed,
            ["k_max = 32", "F_n/(E* h L) = 0.5"]
        );
        for (slice, modes, preload) in [(0, 0, 0), (1, 0, 1), (2, 1, 0), (3, 1, 1)] {
            let grid = study_map.grid(slice);
            assert_eq!(grid.across.values, [0.25, 0.75], "H across");
            assert_eq!(
                grid.up.as_ref().unwrap().values,
                [1.0, 2.0, 4.0],
                "κ ascends"
            );
            let quantities = [
                Quantity::Regime,
                Quantity::AdhesionCoefficient,
                Quantity::PreloadForce,
            ];
            assert_eq!(grid.quantities(), quantities);
            // All maps have the same scale, so the range covers the preloads of all maps, from 0 to
            // 23 µN.
            let force = grid.layer(Quantity::PreloadForce).unwrap();
            assert_eq!(
                (force.scale, force.range),
                (AxisScale::Linear, Some((0.0, 1e-6 * 23.0)))
            );
            for (row, kappa) in [1, 2, 0].into_iter().enumerate() {
                for hurst in 0..2 {
                    let number = ((kappa * 2 + modes) * 2 + hurst) * 2 + preload;
                    let Some((cell, column, up)) = grid.shown(hurst, row) else {
                        assert_eq!(number, 5);
                        continue;
                    };
                    let cell = cell.as_ref().unwrap();
                    let coefficient = cell.statistics[0].unwrap();
                    assert_eq!((column, up, coefficient.mean), (hurst, row, number as f64));
                    let (regime, split, agreeing) = [
                        (Regime::PressureInsensitive, None, 4),
                        (Regime::PressureSensitive, None, 4),
                        (Regime::NonAdhesive, Some(Regime::PressureSensitive), 3),
                    ][number % 3];
                    assert_eq!(cell.regimes[0].most(), Some((regime, agreeing)));
                    assert_eq!(
                        (cell.regimes[0].split(), cell.regimes[0].profiles()),
                        (split, 5)
                    );
                }
            }
        }
    }

    #[test]
    fn the_scene_is_that_of_a_cell_on_the_first_profile() {
        let study_map = study_map(PLAN);
        let document = study_map.document().unwrap();
        let scene = document.scene();
        assert_eq!(scene.title, "A study");
        assert_eq!(
            scene.adhesion,
            Some(Adhesion::by_parameter(RoughnessParameter::Kappa, 1.0)),
            "the plan's scene has none"
        );
        let Some(Roughness::SelfAffine {
            seed, modes, hurst, ..
        }) = scene.roughness
        else {
            panic!()
        };
        assert_eq!((seed, modes, hurst), (7, Some((1, 16)), 0.5));
        // The preload of the map is 0.5 in units of E* h L.
        let Move::ToForce(force) = scene.loading[0] else {
            panic!("{:?}", scene.loading)
        };
        assert!(
            (force / (0.5 * 2.0e6 * 1.0e-7 * 1.0e-4) - 1.0).abs() < 1e-12,
            "{force}"
        );
        let axes: Vec<&Axis> = study_map.over().collect();
        for slice in 0..4 {
            assert_eq!(study_map.is_of(slice, scene), slice == 0);
            let moved = Axis::set_all(&document, &[(axes[1], 3.0), (axes[0], 0.25)]).unwrap();
            assert_eq!(
                study_map.is_of(slice, moved.scene()),
                slice == 0,
                "κ and H are the mark's"
            );
            let followed = study_map.follow(slice, &moved).unwrap();
            assert!(
                study_map.is_of(slice, followed.scene()),
                "{}",
                followed.text()
            );
            assert_eq!(place(followed.scene()), Some((3.0, 0.25)));
        }
        let unpressed = self::study_map(&PLAN.replace("preloads: [0.5, 2.0],", ""));
        let stages = unpressed.document().unwrap().scene().loading.clone();
        assert_eq!(stages, unpressed.plan().scene.loading, "that of the plan");
        let other = document.set("material.modulus", "3.0e6").unwrap();
        assert!(!study_map.is_of(0, other.scene()));
        assert!(!study_map.is_of(0, asperity_scene::open("jkr-sphere").unwrap().scene()));
    }
}
