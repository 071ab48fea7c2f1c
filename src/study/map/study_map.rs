//! The maps of a finished study: one for each preload, and each value of what else it varies beside κ and H.

use super::Template;
use super::model::{MapModel, MapScale};
use super::template::governing;
use crate::scene::{Adhesion, Document, Leg, Roughness, Scene, SceneErrors, quoted, ron_float};
use crate::study::axis::Axis;
use crate::study::error::StudyError;
use crate::study::figure_axis::{figure_axis, fixed};
use crate::study::finished::Finished;
use crate::study::numbering::places_of;
use crate::study::plan::Plan;
use crate::study::quantity::Quantity;
use crate::study::target::Target;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Paths of axes that are κ and H.
const KAPPA: [&str; 2] = ["kappa", "adhesion.kappa"];
const HURST: [&str; 1] = ["roughness.hurst"];

/// Reason why a folder opens as no maps.
#[derive(Debug, Error)]
pub enum StudyMapError {
    /// The folder holds no merged study.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The study does not vary κ and H.
    #[error(
        "{folder}: this study has no map over κ and H: {axes}; allowed: axes kappa and roughness.hurst, each with two \
         values at least. asperity sweep plot {} draws what it has",
        quoted(folder)
    )]
    NoMap {
        /// The folder.
        folder: String,
        /// The axes it has, each with its number of values.
        axes: String,
    },
    /// The scene cannot be explored.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyMap {
    folder: PathBuf,
    study: Finished,
    /// Places among the axes: κ, H, and the others, the preload's last.
    kappa: usize,
    hurst: usize,
    others: Vec<usize>,
    /// Quantities beside the regime by their places among the recorded, with the scales of all maps.
    scales: Vec<(usize, MapScale)>,
}

impl StudyMap {
    /// Opens the folder of a merged study.
    ///
    /// # Errors
    /// Where it is none, or has no map over κ and H.
    pub fn open(folder: &Path) -> Result<StudyMap, StudyMapError> {
        StudyMap::of(Finished::open(folder)?, folder)
    }

    /// The maps of a study that was read from a folder.
    ///
    /// # Errors
    /// Where it does not vary κ and H.
    pub fn of(study: Finished, folder: &Path) -> Result<StudyMap, StudyMapError> {
        let axes = study.plan().all_axes();
        let find = |paths: &[&str]| {
            let is = |path: &str| axes.iter().position(|axis| axis.path() == path && axis.count() > 1);
            paths.iter().find_map(|path| is(path))
        };
        let (Some(kappa), Some(hurst)) = (find(&KAPPA), find(&HURST)) else {
            let said = |axis: &&Axis| {
                let (count, plural) = (axis.count(), if axis.count() == 1 { "" } else { "s" });
                format!("{} ({count} value{plural})", axis.path())
            };
            let said: Vec<String> = axes.iter().map(said).collect();
            let axes =
                if said.is_empty() { "it has no axes".into() } else { format!("it has {}", said.join(", ")) };
            return Err(StudyMapError::NoMap { folder: folder.display().to_string(), axes });
        };
        let others = (0..axes.len()).filter(|axis| ![kappa, hurst].contains(axis)).collect();
        let record = study.plan().record.iter().enumerate();
        let drawn = record.filter(|(_, quantity)| **quantity != Quantity::Regime);
        let scales = drawn.map(|(column, quantity)| {
            let cells = || (0..study.plan().cells()).map(|cell| study.cell(cell)?.estimate(column)).collect();
            (column, MapScale::new(*quantity, cells))
        });
        let scales = scales.collect();
        // Without a separator at its end.
        let folder = folder.components().collect();
        Ok(StudyMap { folder, kappa, hurst, others, scales, study })
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Name of the folder, without those above it.
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

    /// The axes that are neither κ nor H, each with the place that a map has on it.
    fn at(&self, slice: u64) -> Vec<(&Axis, usize, u64)> {
        let axes = self.axes();
        let places = places_of(slice, self.others.iter().map(|&other| axes[other].count()));
        self.others.iter().zip(places).map(|(&other, place)| (axes[other], other, place)).collect()
    }

    /// Place of a map on the axes that are neither κ nor H, in words: `F_n/(E* h L) = 0.1`.
    #[must_use]
    pub fn stands_at(&self, slice: u64) -> Vec<String> {
        self.at(slice).into_iter().map(|(axis, _, place)| fixed(self.plan(), axis, place)).collect()
    }

    /// One of its maps.
    #[must_use]
    pub fn model(&self, slice: u64) -> MapModel {
        let (plan, axes) = (self.plan(), self.axes());
        let mut places = vec![0; axes.len()];
        for (_, other, place) in self.at(slice) {
            places[other] = place;
        }
        let cells = self.study.grid(self.kappa, Some(self.hurst), places);
        let cells: Vec<_> = cells.into_iter().map(|cell| cell.map(Ok)).collect();
        MapModel::new(
            (figure_axis(plan, axes[self.kappa]), Some(figure_axis(plan, axes[self.hurst]))),
            &self.scales,
            &cells,
            cells.iter().enumerate().map(|(index, cell)| cell.map(|_| index)).collect(),
        )
    }

    /// The scene of a map on the first line of the study, with the H that is given, and the κ that the plan's
    /// scene has.
    fn scene(&self, slice: u64, at_hurst: Option<f64>) -> Scene {
        let (plan, axes) = (self.plan(), self.axes());
        let mut scene = plan.scene.clone();
        if scene.title.is_empty() {
            (scene.title, scene.notice) = (plan.title.clone(), plan.notice.clone());
        }
        if scene.adhesion.is_none() {
            let middle = axes[self.kappa].value(axes[self.kappa].count() / 2);
            scene.adhesion = Some(Adhesion::default().with_kappa(middle));
        }
        if let Some(Roughness::SelfAffine { seed, hurst, .. }) = &mut scene.roughness {
            (*seed, *hurst) = (plan.seed, at_hurst.unwrap_or(*hurst));
        }
        let at = self.at(slice);
        let values = at
            .iter()
            .filter_map(|(axis, _, place)| Some((Target::of(axis.path()).ok()?, axis.value(*place))));
        // The plan has been checked with these values.
        let _ = Target::set_all(values, &mut scene);
        let of_map = at.iter().find(|(axis, ..)| axis.path() == "preload");
        let preload = of_map.map(|(axis, _, place)| axis.value(*place));
        let unit = governing(&scene).and_then(|governing| {
            Some(governing.effective_modulus * governing.amplitude?.rms_height * scene.length)
        });
        if let Some((preload, unit)) = preload.zip(unit) {
            scene.loading = vec![Leg::ToForce(preload * unit), Leg::ToSeparation];
        }
        scene
    }

    /// The scene of the study to be explored, named by its folder.
    ///
    /// # Errors
    /// Where it is not allowed.
    pub fn document(&self) -> Result<Document, SceneErrors> {
        // As it is typed, so that the command that opens it again is this name.
        let name = self.folder.display().to_string();
        Document::from_scene(&self.scene(0, None), &name)
    }

    /// Returns true for the scene of a map, but for κ, H and the resolution of its curve.
    #[must_use]
    pub fn is_of(&self, slice: u64, scene: &Scene) -> bool {
        let Some(Roughness::SelfAffine { hurst, .. }) = scene.roughness else { return false };
        let of_map = Template::of(&self.scene(slice, Some(hurst)));
        of_map.is_ok() && of_map == Template::of(scene)
    }

    /// A document with all that makes its scene that of a map, but for κ and H.
    ///
    /// # Errors
    /// Where this is not allowed in it.
    pub fn follow(&self, slice: u64, document: &Document) -> Result<Document, SceneErrors> {
        let Some(Roughness::SelfAffine { hurst, .. }) = document.scene().roughness else {
            return Ok(document.clone());
        };
        let scene = self.scene(slice, Some(hurst));
        let mut fields = Vec::new();
        for (axis, _, place) in self.at(slice) {
            match (axis.path(), &scene.roughness) {
                ("preload", _) => {}
                ("springs_per_wave", Some(Roughness::SelfAffine { modes, .. })) => {
                    fields.push(("roughness.modes.1".to_owned(), modes.1.to_string()));
                }
                (path, _) => {
                    let value = axis.value(place);
                    let whole = Target::of(path).is_ok_and(Target::is_whole);
                    let text = if whole { format!("{value:.0}") } else { ron_float(value) };
                    fields.push((path.to_owned(), text));
                }
            }
        }
        if let [Leg::ToForce(force), Leg::ToSeparation] = scene.loading[..]
            && self.plan().preloads.is_some()
        {
            fields.push(("loading".to_owned(), format!("[ToForce({}), ToSeparation]", ron_float(force))));
        }
        document.set_all(&fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Regime;
    use crate::study::figure::{AxisScale, Estimate};
    use crate::study::map::{Charted, MapCell};
    use crate::study::{Changes, Folder, SUMMARY};

    /// κ not in the order of its values, two preloads, another axis, five lines.
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

    /// Its tables: the coefficient of a cell is its number, and all but a fifth of its lines are in the regime of
    /// that number.
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
        assert_eq!(study_map.stands_at(0), ["k_max = 16", "F_n/(E* h L) = 0.5"]);
        assert_eq!(study_map.stands_at(1), ["k_max = 16", "F_n/(E* h L) = 2"]);
        assert_eq!(study_map.stands_at(2), ["k_max = 32", "F_n/(E* h L) = 0.5"]);
        for (slice, modes, preload) in [(0, 0, 0), (1, 0, 1), (2, 1, 0), (3, 1, 1)] {
            let map_model = study_map.model(slice);
            assert_eq!(map_model.size(), (3, 2));
            assert_eq!(map_model.across().values, [1.0, 2.0, 4.0], "κ ascends");
            assert_eq!(map_model.up().unwrap().values, [0.25, 0.75]);
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
    fn glyphs_tell_the_regime_and_all_that_was_recorded() {
        let map_model = study_map().model(0);
        assert_eq!(
            map_model.charted(),
            [
                Charted::Regime,
                Charted::Quantity(Quantity::AdhesionCoefficient),
                Charted::Quantity(Quantity::PreloadForce)
            ]
        );
        let layer = |quantity| map_model.layer(quantity).unwrap();
        assert_eq!(layer(Quantity::AdhesionCoefficient).steps, [1.0, 0.1, 0.01], "those of every map");
        // From 0 to 23 µN over all maps, whichever is shown.
        let force = layer(Quantity::PreloadForce);
        assert_eq!((force.scale, force.steps), (AxisScale::Linear, [1.7e-5, 1.2e-5, 5.8e-6]));
        assert_eq!([2.0e-5, 1.2e-5, 6.0e-6, 5.0e-6].map(|value| force.step(value)), [0, 1, 2, 3]);
        // Without regimes, and with nothing else.
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
        assert_eq!(map_model.layers()[0].steps, [1.0; 3], "one value");
    }

    #[test]
    fn the_scene_is_that_of_a_cell_on_the_first_line() {
        let study_map = study_map();
        let document = study_map.document().unwrap();
        let scene = document.scene();
        assert_eq!(scene.title, "A study");
        assert_eq!(scene.adhesion.unwrap().kappa, Some(1.0), "the plan's scene has none");
        let Some(Roughness::SelfAffine { seed, modes, hurst, .. }) = scene.roughness else { panic!() };
        assert_eq!((seed, modes, hurst), (7, (1, 16), 0.5));
        // 0.5 E* h L.
        let Leg::ToForce(force) = scene.loading[0] else { panic!("{:?}", scene.loading) };
        assert!((force / (0.5 * 2.0e6 * 1.0e-7 * 1.0e-4) - 1.0).abs() < 1e-12, "{force}");
        for slice in 0..4 {
            assert_eq!(study_map.is_of(slice, scene), slice == 0);
            let moved = Template::moved(&document, 3.0, 0.25).unwrap();
            assert_eq!(study_map.is_of(slice, moved.scene()), slice == 0, "κ and H are the mark's");
            let followed = study_map.follow(slice, &moved).unwrap();
            assert!(study_map.is_of(slice, followed.scene()), "{}", followed.text());
            assert_eq!(Template::place(followed.scene()), Some((3.0, 0.25)));
        }
        let without = PLAN.replace("preloads: [0.5, 2.0],", "");
        let unpressed = StudyMap::open(merged(&without).path()).unwrap();
        let legs = unpressed.document().unwrap().scene().loading.clone();
        assert_eq!(legs, unpressed.plan().scene.loading, "that of the plan");
        assert_eq!(unpressed.stands_at(0), ["k_max = 16"]);
        let other = document.set("material.effective_modulus", "3.0e6").unwrap();
        assert!(!study_map.is_of(0, other.scene()));
        assert!(!study_map.is_of(0, crate::scene::open("jkr-sphere").unwrap().scene()));
    }

    #[test]
    fn without_kappa_and_hurst_there_is_no_map() {
        let kappa = "List(path: \"kappa\", values: [4.0, 1.0, 2.0])";
        let hurst = "Linear(path: \"roughness.hurst\", from: 0.25, to: 0.75, count: 2)";
        for (axis, by, said) in [
            (kappa, "List(path: \"kappa\", values: [4.0])", "kappa (1 value)"),
            (kappa, "List(path: \"length\", values: [1.0e-4, 2.0e-4])", "length (2 values)"),
            (
                hurst,
                "List(path: \"roughness.rms_height\", values: [1.0e-7])",
                "roughness.rms_height (1 value)",
            ),
        ] {
            let plan = PLAN
                .replace(axis, by)
                .replace("numerics: (points: 128)", "numerics: (points: 128), adhesion: (kappa: 1.0)");
            let error = StudyMap::open(merged(&plan).path()).unwrap_err();
            assert!(matches!(error, StudyMapError::NoMap { .. }), "{error}");
            let told = error.to_string();
            assert!(
                told.contains(said) && told.contains("allowed: axes kappa and roughness.hurst"),
                "{told}"
            );
        }
        let plan = PLAN
            .replace("\"kappa\"", "\"adhesion.kappa\"")
            .replace("numerics:", "adhesion: (kappa: 1.0), numerics:");
        assert_eq!(StudyMap::open(merged(&plan).path()).unwrap().slices(), 4);
    }
}
