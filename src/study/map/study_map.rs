//! The maps of a finished study: over H and κ, or over other axes; one map for each value of the remaining axes.

use super::axis::{MapAxis, force_unit, moved};
use super::model::{Layer, MapModel};
use super::template::Template;
use crate::scene::{Adhesion, Document, Move, Numerics, Roughness, RoughnessParameter, Scene, SceneErrors};
use crate::study::axis::Axis;
use crate::study::error::StudyError;
use crate::study::figure::{FigureAxis, across_and_up, fixed};
use crate::study::finished::Finished;
use crate::study::numbering::places_of;
use crate::study::plan::Plan;
use crate::study::quantity::Quantity;
use crate::study::target::Target;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Paths of the axes of κ.
const KAPPA: [&str; 2] = ["kappa", "adhesion.kappa"];

/// Reason why a folder has no maps.
#[derive(Debug, Error)]
pub enum StudyMapError {
    /// The folder holds no merged study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The study has one cell.
    #[error(
        "{folder}: this study has neither map nor section: {axes}; a section needs an axis with two values at least"
    )]
    OneCell {
        /// The folder.
        folder: String,
        /// Axes of the study, each with its number of values.
        axes: String,
    },
    /// The scene cannot be explored.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
}

/// Map of a finished study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyMap {
    folder: PathBuf,
    study: Finished,
    /// Places among the axes: that across, that up, and the others, the preload's last.
    across: usize,
    up: Option<usize>,
    others: Vec<usize>,
    /// Quantities beside the regime in all cells of the study, each with its place among the recorded quantities.
    layers: Vec<(usize, Layer)>,
}

impl StudyMap {
    /// Opens the folder of a merged study.
    ///
    /// # Errors
    /// A folder of no study, or of a study of one cell.
    pub fn open(folder: &Path) -> Result<StudyMap, StudyMapError> {
        StudyMap::of(Finished::open(folder)?, folder)
    }

    /// The maps of a study that was read from a folder.
    ///
    /// # Errors
    /// A study of one cell.
    pub fn of(study: Finished, folder: &Path) -> Result<StudyMap, StudyMapError> {
        let axes = study.plan().all_axes();
        let free: Vec<usize> = (0..axes.len()).filter(|axis| axes[*axis].count() > 1).collect();
        let Some((across, up)) = across_and_up(&axes, &free) else {
            let said: Vec<String> = axes.iter().map(|axis| format!("{} (1 value)", axis.path())).collect();
            let axes =
                if said.is_empty() { "it has no axes".into() } else { format!("it has {}", said.join(", ")) };
            return Err(StudyMapError::OneCell { folder: folder.display().to_string(), axes });
        };
        let others = (0..axes.len()).filter(|axis| *axis != across && Some(*axis) != up).collect();
        let record = study.plan().record.iter().enumerate();
        let drawn = record.filter(|(_, quantity)| **quantity != Quantity::Regime);
        let layers = drawn.map(|(column, quantity)| (column, Layer::new(*quantity, study.estimates(column))));
        let layers = layers.collect();
        // Without a separator at its end.
        let folder = folder.components().collect();
        Ok(StudyMap { folder, across, up, others, layers, study })
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Name of the folder without its parents.
    #[must_use]
    pub fn name(&self) -> String {
        let whole = std::path::absolute(&self.folder).unwrap_or_else(|_| self.folder.clone());
        whole.file_name().unwrap_or(self.folder.as_os_str()).to_string_lossy().into_owned()
    }

    /// The plan of the study.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.study.plan()
    }

    fn axes(&self) -> Vec<&Axis> {
        self.plan().all_axes()
    }

    /// Number of maps.
    #[must_use]
    pub fn slices(&self) -> u64 {
        let axes = self.axes();
        self.others.iter().map(|&other| axes[other].count()).product()
    }

    /// The axes outside the maps, each with the place of a map on it.
    fn at(&self, slice: u64) -> Vec<(&Axis, usize, u64)> {
        let axes = self.axes();
        let places = places_of(slice, self.others.iter().map(|&other| axes[other].count()));
        self.others.iter().zip(places).map(|(&other, place)| (axes[other], other, place)).collect()
    }

    /// Place of a map on the axes outside it, in words: `F_n/(E* h L) = 0.1`.
    #[must_use]
    pub fn fixed_values(&self, slice: u64) -> Vec<String> {
        self.at(slice).into_iter().map(|(axis, _, place)| fixed(self.plan(), axis, place)).collect()
    }

    /// Map of this number.
    #[must_use]
    pub fn model(&self, slice: u64) -> MapModel {
        let (plan, axes) = (self.plan(), self.axes());
        let mut places = vec![0; axes.len()];
        for (_, other, place) in self.at(slice) {
            places[other] = place;
        }
        let cells = self.study.grid(self.across, self.up, places);
        let estimates = |column| cells.iter().map(|cell| (*cell)?.estimate(column)).collect();
        let layers = self.layers.iter().map(|(column, layer)| layer.with(estimates(*column))).collect();
        let cells: Vec<_> = cells.iter().map(|cell| cell.map(Ok)).collect();
        let axis = |place: usize| MapAxis {
            path: axes[place].path().to_owned(),
            figure: FigureAxis::new(plan, axes[place]),
        };
        MapModel::new(
            (axis(self.across), self.up.map(axis)),
            layers,
            &cells,
            cells.iter().enumerate().map(|(index, cell)| cell.map(|_| index)).collect(),
        )
    }

    /// Paths of the axes of the maps.
    fn over(&self) -> Vec<&Axis> {
        let axes = self.axes();
        [Some(self.across), self.up].into_iter().flatten().map(|axis| axes[axis]).collect()
    }

    /// The scene of a map on the first profile of the study, with these values on the axes of the maps; axes
    /// without a value here keep that of the plan's scene.
    fn scene(&self, slice: u64, over: &[(&str, f64)]) -> Scene {
        let plan = self.plan();
        let mut scene = plan.scene.clone();
        if scene.title.is_empty() {
            (scene.title, scene.notice) = (plan.title.clone(), plan.notice.clone());
        }
        let kappa = self.over().into_iter().find(|axis| KAPPA.contains(&axis.path()));
        if let (None, Some(kappa)) = (scene.adhesion, kappa) {
            scene.adhesion =
                Some(Adhesion::by_parameter(RoughnessParameter::Kappa, kappa.value(kappa.count() / 2)));
        }
        if let Some(Roughness::SelfAffine { seed, .. }) = &mut scene.roughness {
            *seed = plan.seed;
        }
        let at = self.at(slice);
        let at = at.iter().map(|(axis, _, place)| (axis.path(), axis.value(*place)));
        let values: Vec<(&str, f64)> = at.chain(over.iter().copied()).collect();
        let targets = values.iter().filter_map(|(path, value)| Some((Target::of(path).ok()?, *value)));
        // The plan has been checked with these values.
        let _ = Target::set_all(targets, &mut scene);
        let preload = values.iter().find(|(path, _)| *path == "preload").map(|(_, value)| *value);
        let first = || self.plan().preloads.as_ref().map(|axis| axis.value(0));
        if let Some((preload, unit)) = preload.or_else(first).zip(force_unit(&scene)) {
            scene.loading = vec![Move::ToForce(preload * unit), Move::ToSeparation];
        }
        scene
    }

    /// The scene of the study for the explorer, named by its folder.
    ///
    /// # Errors
    /// An invalid scene.
    pub fn document(&self) -> Result<Document, SceneErrors> {
        // As typed, so that this name in a command opens the study again.
        let name = self.folder.display().to_string();
        Document::from_scene(&self.scene(0, &[]), &name)
    }

    /// Returns true for the scene of a map, but for the axes that the map is over and the resolution of its curve.
    #[must_use]
    pub fn is_of(&self, slice: u64, scene: &Scene) -> bool {
        let axes = self.over();
        let known = axes.into_iter().filter_map(|axis| {
            let (path, figure) = (axis.path().to_owned(), FigureAxis::new(self.plan(), axis));
            Some((axis.path(), MapAxis { path, figure }.value(scene, None)?))
        });
        let of_map = self.scene(slice, &known.collect::<Vec<_>>());
        match (Template::of(&of_map), Template::of(scene)) {
            (Ok(one), Ok(other)) => {
                one == other && is_close(Template::place(&of_map), Template::place(scene))
            }
            _ => without_texts(&of_map) == without_texts(scene),
        }
    }

    /// Document with the scene of a map, but for the axes of the map.
    ///
    /// # Errors
    /// Values that are invalid in the scene.
    pub fn follow(&self, slice: u64, document: &Document) -> Result<Document, SceneErrors> {
        let at = self.at(slice);
        let values: Vec<_> = at.iter().map(|(axis, _, place)| (axis.path(), axis.value(*place))).collect();
        moved(document, &values)
    }
}

/// Returns true if κ and H are equal but for rounding; unknown values are not compared.
fn is_close(one: Option<(f64, f64)>, other: Option<(f64, f64)>) -> bool {
    let is_close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
    one.zip(other).is_none_or(|((a, b), (c, d))| is_close(a, c) && is_close(b, d))
}

/// A scene without the fields that change no result but the resolution of a curve.
fn without_texts(scene: &Scene) -> Scene {
    Scene {
        title: String::new(),
        notice: String::new(),
        observe: Vec::new(),
        numerics: Numerics { samples: 2, ..scene.numerics },
        ..scene.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Regime;
    use crate::study::figure::{AxisScale, Estimate};
    use crate::study::map::{Charted, MapCell};
    use crate::study::{Changes, Folder, SUMMARY};

    /// κ not in the order of its values, two preloads, another axis, five profiles.
    const PLAN: &str = r#"(
        version: 1,
        title: "A study",
        scene: (
            version: 1,
            material: (effective_modulus: 2.0e6),
            length: 1.0e-4,
            roughness: SelfAffine(hurst: 0.5, rms_height: 1.0e-7, modes: (1, 32), seed: 1),
            numerics: (points: 128),
        ),
        axes: [
            List(path: "kappa", values: [4.0, 1.0, 2.0]),
            List(path: "roughness.modes.1", values: [16, 32]),
            Linear(path: "roughness.hurst", from: 0.25, to: 0.75, count: 2),
        ],
        preloads: [0.5, 2.0],
        lines: 5,
        seed: 7,
        record: [adhesion_coefficient, regime, preload_force],
    )"#;

    /// Tables of the study: the coefficient of a cell is its number, and all but a fifth of its profiles are in the
    /// regime of that number.
    fn merged(plan: &str) -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        let plan = Plan::parse(plan, "plan", &Changes::default()).unwrap();
        Folder::create(folder.path(), &plan).unwrap();
        let mut text = String::from("cell");
        plan.axes.iter().for_each(|axis| text += &format!(",{}", axis.path()));
        text += ",preload,lines,and so on,,,,,,,,,,\n";
        for cell in (0..plan.cells()).filter(|cell| *cell != 5) {
            let axes = ",".repeat(plan.axes.len());
            let shares = [["0.8", "0.2", "0"], ["0.2", "0.8", "0"], ["0", "0.4", "0.6"]][cell as usize % 3];
            let low = cell as f64 - 0.25;
            text += &format!("{cell},{axes},5,{cell},0.1,{low},{}.5,{},", cell, shares.join(","));
            text += &format!("{},,,\n", 1.0e-6 * cell as f64);
        }
        std::fs::write(folder.path().join(SUMMARY), text).unwrap();
        folder
    }

    fn study_map() -> StudyMap {
        StudyMap::open(merged(PLAN).path()).unwrap()
    }

    /// The number of a cell by its places on the axes of the plan.
    fn cell(kappa: u64, modes: u64, hurst: u64, preload: u64) -> f64 {
        (((kappa * 2 + modes) * 2 + hurst) * 2 + preload) as f64
    }

    #[test]
    fn maps_have_the_cells_of_the_study() {
        let study_map = study_map();
        assert_eq!(study_map.slices(), 4);
        assert_eq!(study_map.fixed_values(0), ["k_max = 16", "F_n/(E* h L) = 0.5"]);
        assert_eq!(study_map.fixed_values(1), ["k_max = 16", "F_n/(E* h L) = 2"]);
        assert_eq!(study_map.fixed_values(2), ["k_max = 32", "F_n/(E* h L) = 0.5"]);
        for (slice, modes, preload) in [(0, 0, 0), (1, 0, 1), (2, 1, 0), (3, 1, 1)] {
            let map_model = study_map.model(slice);
            assert_eq!(map_model.across().figure.values, [0.25, 0.75], "H across");
            assert_eq!(map_model.up().unwrap().figure.values, [1.0, 2.0, 4.0], "κ ascends");
            let map_model = map_model.transposed();
            assert_eq!(map_model.size(), (3, 2));
            let layer = map_model.layer(Quantity::AdhesionCoefficient).unwrap();
            for row in 0..2 {
                for (column, kappa) in [1, 2, 0].into_iter().enumerate() {
                    let number = cell(kappa, modes, row, preload);
                    let estimate = map_model.estimate(layer, column, row as usize);
                    if number == 5.0 {
                        assert_eq!((estimate, map_model.shown(column, row as usize)), (None, None));
                        continue;
                    }
                    let (mean, low, high) = (number, number - 0.25, number + 0.5);
                    assert_eq!(estimate, Some(Estimate { mean, low, high }), "{slice} {row} {column}");
                    let place = map_model.shown(column, row as usize).unwrap();
                    let (regime, split, agreeing) = [
                        (Regime::PressureInsensitive, None, 4),
                        (Regime::PressureSensitive, None, 4),
                        (Regime::NonAdhesive, Some(Regime::PressureSensitive), 3),
                    ][number as usize % 3];
                    let map_cell = MapCell { regime: Some(regime), split, agreeing, lines: 5 };
                    assert_eq!((place.column, place.row, place.cell), (column, row as usize, &Ok(map_cell)));
                }
            }
        }
    }

    #[test]
    fn the_regime_and_all_that_was_recorded_are_charted() {
        let map_model = study_map().model(0);
        assert_eq!(
            map_model.charted(),
            [
                Charted::Regime,
                Charted::Quantity(Quantity::AdhesionCoefficient),
                Charted::Quantity(Quantity::PreloadForce)
            ]
        );
        // From 0 to 23 µN over all maps, independent of the shown one.
        let force = map_model.layer(Quantity::PreloadForce).unwrap();
        assert_eq!((force.scale, force.range), (AxisScale::Linear, Some((0.0, 2.3e-5))));
        let transposed = map_model.transposed();
        assert_eq!(transposed.size(), (map_model.size().1, map_model.size().0));
        assert_eq!(
            transposed.shown(2, 1).map(|shown| shown.cell),
            map_model.shown(1, 2).map(|shown| shown.cell)
        );
        assert_eq!(transposed.transposed(), map_model);
        // Without regimes, and without any quantity.
        let map_model = |record: &str| {
            let plan = PLAN.replace("record: [adhesion_coefficient, regime, preload_force]", record);
            let plan = Plan::parse(&plan, "plan", &Changes::default()).unwrap();
            let folder = tempfile::tempdir().unwrap();
            Folder::create(folder.path(), &plan).unwrap();
            let values = if record.contains("regime") { "0.5,0.5,0" } else { "1,,," };
            let row = format!("0,4,16,0.25,0.5,5,{values}");
            let columns = "cell,kappa,roughness.modes.1,roughness.hurst,preload,lines".to_owned();
            let more = ",x".repeat(row.matches(',').count() - columns.matches(',').count());
            std::fs::write(folder.path().join(SUMMARY), format!("{columns}{more}\n{row}\n")).unwrap();
            StudyMap::open(folder.path()).unwrap().model(0)
        };
        assert_eq!(map_model("record: [regime]").charted(), [Charted::Regime]);
        let map_model = map_model("record: [fragments]");
        assert_eq!(map_model.charted(), [Charted::Quantity(Quantity::Fragments)]);
        assert_eq!(map_model.layers()[0].range, Some((1.0, 1.0)), "one value");
    }

    #[test]
    fn the_scene_is_that_of_a_cell_on_the_first_line() {
        let study_map = study_map();
        let document = study_map.document().unwrap();
        let scene = document.scene();
        assert_eq!(scene.title, "A study");
        assert_eq!(
            scene.adhesion,
            Some(Adhesion::by_parameter(RoughnessParameter::Kappa, 1.0)),
            "the plan's scene has none"
        );
        let Some(Roughness::SelfAffine { seed, modes, hurst, .. }) = scene.roughness else { panic!() };
        assert_eq!((seed, modes, hurst), (7, (1, 16), 0.5));
        // 0.5 E* h L.
        let Move::ToForce(force) = scene.loading[0] else { panic!("{:?}", scene.loading) };
        assert!((force / (0.5 * 2.0e6 * 1.0e-7 * 1.0e-4) - 1.0).abs() < 1e-12, "{force}");
        for slice in 0..4 {
            assert_eq!(study_map.is_of(slice, scene), slice == 0);
            let moved = moved(&document, &[("kappa", 3.0), ("roughness.hurst", 0.25)]).unwrap();
            assert_eq!(study_map.is_of(slice, moved.scene()), slice == 0, "κ and H are the mark's");
            let followed = study_map.follow(slice, &moved).unwrap();
            assert!(study_map.is_of(slice, followed.scene()), "{}", followed.text());
            assert_eq!(Template::place(followed.scene()), Some((3.0, 0.25)));
        }
        let without = PLAN.replace("preloads: [0.5, 2.0],", "");
        let unpressed = StudyMap::open(merged(&without).path()).unwrap();
        let legs = unpressed.document().unwrap().scene().loading.clone();
        assert_eq!(legs, unpressed.plan().scene.loading, "that of the plan");
        assert_eq!(unpressed.fixed_values(0), ["k_max = 16"]);
        let other = document.set("material.effective_modulus", "3.0e6").unwrap();
        assert!(!study_map.is_of(0, other.scene()));
        assert!(!study_map.is_of(0, crate::scene::open("jkr-sphere").unwrap().scene()));
    }

    #[test]
    fn studies_of_other_axes_have_maps_and_sections() {
        let kappa = "List(path: \"kappa\", values: [4.0, 1.0, 2.0])";
        let hurst = "Linear(path: \"roughness.hurst\", from: 0.25, to: 0.75, count: 2)";
        let length = "List(path: \"length\", values: [1.0e-4, 2.0e-4])";
        let axes = |plan: &str| {
            let plan =
                plan.replace("numerics: (points: 128)", "numerics: (points: 128), adhesion: (kappa: 1.0)");
            let study_map = StudyMap::open(merged(&plan).path())?;
            let map_model = study_map.model(0);
            // The first scene is that of the study, and remains so on the map.
            let document = study_map.document()?;
            let axes: Vec<&MapAxis> =
                [Some(map_model.across()), map_model.up()].into_iter().flatten().collect();
            let last = axes.iter().map(|axis| (axis.path.as_str(), *axis.figure.values.last().unwrap()));
            // The unit of the preload changes with the length.
            let moved = study_map.follow(0, &moved(&document, &last.collect::<Vec<_>>())?)?;
            for document in [&document, &moved] {
                assert!(study_map.is_of(0, document.scene()), "{}", document.text());
            }
            for axis in &axes {
                let (value, last) =
                    (axis.value(moved.scene(), None).unwrap(), axis.figure.values.last().unwrap());
                assert!((value / last - 1.0).abs() < 1e-9, "{}: {value} {last}", axis.path);
            }
            let paths: Vec<String> = axes.iter().map(|axis| axis.path.clone()).collect();
            Ok::<_, StudyMapError>(paths)
        };
        let one_kappa = "List(path: \"kappa\", values: [4.0])";
        let one_mode = "List(path: \"roughness.modes.1\", values: [16.0])";
        let modes = "List(path: \"roughness.modes.1\", values: [16, 32])";
        let unpressed = PLAN.replace("preloads: [0.5, 2.0],", "");
        for (plan, expected) in [
            (PLAN.replace(kappa, one_kappa), ["roughness.hurst", "roughness.modes.1"].as_slice()),
            (PLAN.replace(kappa, length), &["roughness.hurst", "length"]),
            (PLAN.replace(hurst, length), &["roughness.modes.1", "kappa"]),
            (PLAN.replace(hurst, length).replace(kappa, one_kappa), &["roughness.modes.1", "length"]),
            (
                unpressed.replace(hurst, length).replace(kappa, one_kappa).replace(modes, one_mode),
                &["length"],
            ),
            (
                PLAN.replace(&format!("{hurst},"), "").replace(kappa, one_kappa).replace(modes, one_mode),
                &["preload"],
            ),
        ] {
            assert_eq!(axes(&plan).unwrap(), expected, "{plan}");
        }
        let one =
            unpressed.replace(kappa, one_kappa).replace(modes, one_mode).replace(&format!("{hurst},"), "");
        let error = axes(&one).unwrap_err();
        assert!(matches!(error, StudyMapError::OneCell { .. }), "{error}");
        assert!(error.to_string().contains("a section needs an axis with two values at least"), "{error}");
    }
}
