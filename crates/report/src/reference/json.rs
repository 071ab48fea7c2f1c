//! JSON object of a comparison of profiles with three dimensions.

use crate::warnings::counted_texts;
use asperity_contact::Move;
use asperity_scene::Scene;
use asperity_study::Statistics;
use asperity_study::half_space::{
    Compared, ComparedRoughness, LeftOut, Reference, ReferenceBudget,
};
use serde::Serialize;

/// JSON object of a comparison of profiles with three dimensions, in SI units.
#[derive(Serialize)]
pub(super) struct ReferenceJson<'a> {
    scene: &'a Scene,
    warnings: Vec<String>,
    cells: usize,
    surfaces: u64,
    profiles: u64,
    waves: Option<(u64, u64)>,
    omitted: Option<u64>,
    compared_loading: [Move; 2],
    preload: f64,
    work: Option<f64>,
    profile: ModelJson<Statistics>,
    half_space: ModelJson<Statistics>,
    adhesive_half_space: Option<ComparedRoughness>,
    ratio: ModelJson<RatioJson>,
    left_out: &'a [LeftOut],
    profile_is_exact: bool,
    budget: ReferenceBudget,
    convolutions: u64,
    seconds: [f64; 2],
    seconds_of_square: f64,
}

/// Numbers of one model, or ratios of the numbers of both models.
#[derive(Serialize)]
struct ModelJson<V> {
    #[serde(flatten)]
    roughness: Option<ComparedRoughness>,
    pull_off_force: Option<V>,
    first_touch_pull_off_force: Option<V>,
    dissipated_energy: Option<V>,
    loading: Vec<LoadedJson<V>>,
}

/// Numbers of one model, or ratios of the numbers of both models, at one force of the loading
/// without adhesion.
#[derive(Serialize)]
struct LoadedJson<V> {
    force: f64,
    indentation: V,
    stiffness: V,
    /// Mean area of contact of the squares in m².
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_area: Option<f64>,
    /// Relative error due to the grid of the squares. The outer `None` leaves out the entry in the
    /// JSON object, and the inner `None` is an unknown error.
    #[serde(skip_serializing_if = "Option::is_none")]
    grid: Option<Option<f64>>,
}

/// Ratio of two means of a result: the mean over random profiles divided by the mean over random
/// square surfaces in three dimensions. `error` is the half-width of its 95 % interval, and `grid`
/// the relative error due to the grid of the square surfaces.
#[derive(Serialize)]
struct RatioJson {
    value: f64,
    error: Option<f64>,
    grid: Option<f64>,
}

impl RatioJson {
    fn new(compared: &Compared) -> Self {
        RatioJson {
            value: compared.ratio,
            error: compared.error,
            grid: compared.grid,
        }
    }
}

impl<V> ModelJson<V> {
    /// Collects one number from each comparison of a quantity. The roughness, the areas of contact
    /// and the errors of the grid are not set.
    fn new(reference: &Reference, number: fn(&Compared) -> V) -> Self {
        let mut loading = Vec::with_capacity(reference.loading.len());
        for loaded in &reference.loading {
            loading.push(LoadedJson {
                force: loaded.force,
                indentation: number(&loaded.indentation),
                stiffness: number(&loaded.stiffness),
                contact_area: None,
                grid: None,
            });
        }
        ModelJson {
            roughness: None,
            pull_off_force: reference.pull_off_force.as_ref().map(number),
            first_touch_pull_off_force: reference.first_touch_pull_off_force.as_ref().map(number),
            dissipated_energy: reference.dissipated_energy.as_ref().map(number),
            loading,
        }
    }

    /// Adds, at each force, the error due to the grid of the squares.
    fn with_grid(mut self, reference: &Reference) -> Self {
        for (point, loaded) in self.loading.iter_mut().zip(&reference.loading) {
            point.grid = Some(loaded.grid());
        }
        self
    }

    /// Adds, at each force, the area of contact of the squares.
    fn with_area(mut self, reference: &Reference) -> Self {
        for (point, loaded) in self.loading.iter_mut().zip(&reference.loading) {
            point.contact_area = Some(loaded.area);
        }
        self
    }
}

impl<'a> ReferenceJson<'a> {
    pub fn new(scene: &'a Scene, reference: &'a Reference) -> Self {
        let roughness = reference.roughness;
        let warned = reference.profiles_for_warnings();
        let profile = ModelJson::new(reference, |compared| compared.line);
        let half_space = ModelJson::new(reference, |compared| compared.half_space)
            .with_area(reference)
            .with_grid(reference);
        let ratio = ModelJson::new(reference, RatioJson::new).with_grid(reference);
        ReferenceJson {
            scene,
            warnings: counted_texts(&reference.warnings, warned),
            cells: reference.options.cells,
            surfaces: reference.options.surfaces,
            profiles: reference.options.profiles,
            waves: reference.waves,
            omitted: reference.omitted,
            compared_loading: reference.compared_loading,
            preload: reference.preload,
            work: reference.work_of_adhesion,
            profile: ModelJson {
                roughness: roughness.map(|roughness| roughness.line),
                ..profile
            },
            half_space: ModelJson {
                roughness: roughness.map(|roughness| roughness.half_space),
                ..half_space
            },
            adhesive_half_space: roughness.and_then(|roughness| roughness.adhesive_half_space),
            ratio,
            left_out: &reference.left_out,
            profile_is_exact: reference.line_is_exact,
            budget: reference.budget,
            convolutions: reference.convolutions,
            seconds: reference.seconds,
            seconds_of_square: reference.seconds_of_square,
        }
    }
}
