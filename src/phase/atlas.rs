//! The maps of a finished study: one for each preload, and each value of what else it varies beside κ and H.

use super::Basis;
use super::basis::governing;
use super::plane::{Layer, Plane, Spot, usual};
use crate::analysis::Regime;
use crate::scene::{Adhesion, Document, Leg, Roughness, Scene, SceneErrors, quoted, ron_float};
use crate::sweep::figure::{AxisScale, Estimate};
use crate::sweep::{
    Axis, CellSummary, Finished, Plan, Quantity, SweepError, Target, ascending, estimate, figure_axis, fixed,
    regime, scale_of,
};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Paths of axes that are κ and H.
const KAPPA: [&str; 2] = ["kappa", "adhesion.kappa"];
const HURST: [&str; 1] = ["roughness.hurst"];
/// Where a smaller share of lines is in one regime, the lines of a cell are divided.
const AGREED: f64 = 0.75;

/// Why a folder opens as no maps.
#[derive(Debug, Error)]
pub enum AtlasError {
    /// It is not the folder of a merged study.
    #[error(transparent)]
    Study(#[from] SweepError),
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
    /// Its scene is not one that can be explored.
    #[error(transparent)]
    Scene(#[from] SceneErrors),
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct Atlas {
    folder: PathBuf,
    study: Finished,
    /// Places among the axes: κ, H, and the others, the preload's last.
    kappa: usize,
    hurst: usize,
    others: Vec<usize>,
    /// What it tells beside the regime, with scale and glyphs: those of all its maps.
    quantities: Vec<(Quantity, AxisScale, [f64; 3])>,
}

impl Atlas {
    /// Opens the folder of a merged study.
    ///
    /// # Errors
    /// Where it is none, or has no map over κ and H.
    pub fn open(folder: &Path) -> Result<Atlas, AtlasError> {
        Atlas::of(Finished::open(folder)?, folder)
    }

    /// The maps of a study that was read from a folder.
    ///
    /// # Errors
    /// Where it does not vary κ and H.
    pub fn of(study: Finished, folder: &Path) -> Result<Atlas, AtlasError> {
        let axes: Vec<&Axis> = study.plan().axes.iter().chain(&study.plan().preloads).collect();
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
            return Err(AtlasError::NoMap { folder: folder.display().to_string(), axes });
        };
        let others = (0..axes.len()).filter(|axis| ![kappa, hurst].contains(axis)).collect();
        let told = study.plan().record.iter().copied().filter(|quantity| *quantity != Quantity::Regime);
        let quantities = told.map(|quantity| {
            let (scale, steps) = usual(quantity).unwrap_or_else(|| {
                let cells = (0..study.plan().cells()).filter_map(|cell| study.cell(cell));
                glyphs(&cells.map(|cell| estimate(&study, cell, quantity)).collect::<Vec<_>>())
            });
            (quantity, scale, steps)
        });
        let quantities = quantities.collect();
        // Without a separator at its end.
        let folder = folder.components().collect();
        Ok(Atlas { folder, kappa, hurst, others, quantities, study })
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Its name, without the folders it is in.
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
        self.plan().axes.iter().chain(&self.plan().preloads).collect()
    }

    /// How many maps it has.
    #[must_use]
    pub fn slices(&self) -> u64 {
        let axes = self.axes();
        self.others.iter().map(|&other| axes[other].count()).product()
    }

    /// The axes that are neither κ nor H, each with the place that a map has on it.
    fn at(&self, slice: u64) -> Vec<(&Axis, usize, u64)> {
        let (axes, mut rest) = (self.axes(), slice);
        let mut at: Vec<_> = Vec::with_capacity(self.others.len());
        for &other in self.others.iter().rev() {
            let axis = axes[other];
            at.push((axis, other, rest % axis.count()));
            rest /= axis.count();
        }
        at.reverse();
        at
    }

    /// Where a map stands on the axes that are neither κ nor H, as people read it: `F_n/(E* h L) = 0.1`.
    #[must_use]
    pub fn stands_at(&self, slice: u64) -> Vec<String> {
        self.at(slice).into_iter().map(|(axis, _, place)| fixed(self.plan(), axis, place)).collect()
    }

    /// One of its maps.
    #[must_use]
    pub fn plane(&self, slice: u64) -> Plane {
        let (plan, axes) = (self.plan(), self.axes());
        let mut places = vec![0; axes.len()];
        for (_, other, place) in self.at(slice) {
            places[other] = place;
        }
        let mut found: Vec<Option<&CellSummary>> = Vec::new();
        for row in ascending(axes[self.hurst]) {
            for column in ascending(axes[self.kappa]) {
                (places[self.hurst], places[self.kappa]) = (row, column);
                found.push(self.study.at(&places));
            }
        }
        let layer = |&(quantity, scale, steps): &(Quantity, AxisScale, [f64; 3])| {
            let estimates = found.iter().map(|cell| estimate(&self.study, (*cell)?, quantity)).collect();
            Layer { quantity, scale, steps, estimates }
        };
        Plane::new(
            (figure_axis(plan, axes[self.kappa]), Some(figure_axis(plan, axes[self.hurst]))),
            self.quantities.iter().map(layer).collect(),
            found.iter().map(|cell| cell.map(|cell| Ok(spot(cell)))).collect(),
            found.iter().enumerate().map(|(index, cell)| cell.map(|_| index)).collect(),
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
            scene.adhesion = Some(Adhesion { work: None, kappa: Some(middle) });
        }
        if let Some(Roughness::SelfAffine { seed, hurst, .. }) = &mut scene.roughness {
            (*seed, *hurst) = (plan.seed, at_hurst.unwrap_or(*hurst));
        }
        let at = self.at(slice);
        // What is derived from other numbers comes after them.
        for late in [false, true] {
            for (axis, _, place) in &at {
                if let Ok(target) = Target::of(axis.path())
                    && matches!(target, Target::SpringsPerWave) == late
                {
                    // The plan has been checked with it.
                    let _ = target.set(&mut scene, axis.value(*place));
                }
            }
        }
        let preload = at.iter().find(|(axis, ..)| axis.path() == "preload");
        let unit = governing(&scene).and_then(|governing| {
            Some(governing.effective_modulus * governing.amplitude?.rms_height * scene.length)
        });
        if let Some(((axis, _, place), unit)) = preload.zip(unit) {
            scene.loading = vec![Leg::ToForce(axis.value(*place) * unit), Leg::ToSeparation];
        } else if scene.loading.is_empty() {
            // A study of F_a(0) needs no loading; what is explored does.
            scene.loading = vec![Leg::ToTouch, Leg::ToSeparation];
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
        Document::of_scene(&self.scene(0, None), &name)
    }

    /// Whether a scene is that of a map, but for κ and H and how finely its curve is computed.
    #[must_use]
    pub fn is_of(&self, slice: u64, scene: &Scene) -> bool {
        let Some(Roughness::SelfAffine { hurst, .. }) = scene.roughness else { return false };
        let of_map = Basis::of(&self.scene(slice, Some(hurst)));
        of_map.is_ok() && of_map == Basis::of(scene)
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

/// What a cell of the study says.
fn spot(cell: &CellSummary) -> Spot {
    let of_most = regime(cell);
    let share = |one: Regime| {
        let place = Finished::REGIMES.iter().position(|regime| *regime == one);
        cell.regimes.zip(place).map_or(0.0, |(shares, place)| shares[place])
    };
    let most = of_most.map_or(0.0, share);
    let others = Finished::REGIMES.into_iter().filter(|one| Some(*one) != of_most && share(*one) > 0.0);
    let second = others.max_by(|a, b| share(*a).total_cmp(&share(*b)));
    Spot {
        regime: of_most,
        split: second.filter(|_| most < AGREED),
        agreeing: (most * cell.lines as f64).round() as u64,
        lines: cell.lines,
    }
}

/// Scale and steps of a quantity by its values: a quarter of their range for each glyph.
fn glyphs(estimates: &[Option<Estimate>]) -> (AxisScale, [f64; 3]) {
    let scale = scale_of(estimates);
    let places = || estimates.iter().flatten().map(|estimate| scale.coordinate(estimate.mean));
    let (low, high) =
        places().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let step = |share: f64| {
        let value = scale.number(low + share * (high - low));
        format!("{value:.1e}").parse().unwrap_or(value)
    };
    if low > high { (AxisScale::Linear, [0.0; 3]) } else { (scale, [0.75, 0.5, 0.25].map(step)) }
}
