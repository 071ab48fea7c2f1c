//! A scene with the waves that squares resolve, as a profile and in three dimensions.

use super::error::StudyError;
use super::shells::{ComparedRoughness, Shells, Spectrum};
use super::spatial::Body;
use asperity_half_space::check_cells;
use asperity_scene::{CheckedScene, Roughness, RunError, Scene, Simulation};
use asperity_surface::Amplitude;
use asperity_surface::lines::{MeasuredRoughness, ModeRange};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Number of cells for the shortest wave of a square.
const CELLS_PER_WAVE: u64 = 8;
/// Number of springs for the shortest wave of a profile.
const SPRINGS_PER_WAVE: u64 = 64;
const LEAST_SPRINGS: u64 = 4096;
/// Share of the largest gap of a profile that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// Scene with the waves that squares resolve.
pub(super) struct Resolved {
    /// Scene of the profiles.
    pub line: CheckedScene,
    /// Spectrum of the random profiles of a measured surface, without the waves that squares do not
    /// resolve.
    measured: Option<Arc<MeasuredRoughness>>,
    pub body: Body,
    /// Roughness of the profiles; `None` for smooth ones.
    pub line_roughness: Option<ComparedRoughness>,
    /// First and last wave over the length; `None` for a smooth body.
    pub waves: Option<(u64, u64)>,
    /// Last wave of the scene, if it is left out.
    pub omitted: Option<u64>,
    /// True for a smooth body of revolution whose profile rises everywhere from the axis outwards,
    /// for which the profile is exact while the contact ends before the profile does.
    pub line_is_exact: bool,
}

impl Resolved {
    /// Keeps the waves of a scene that squares with this number of cells along a side resolve.
    ///
    /// # Errors
    /// The number of cells is not allowed, or the scene has no body in three dimensions.
    pub fn of(
        scene: &CheckedScene,
        cells: usize,
        simulation: &mut Simulation,
    ) -> Result<Resolved, StudyError> {
        check_cells(cells)?;
        if scene.measured_as_line() {
            let allowed = "its equivalent line, which has a surface in three dimensions (roughness.as_line=false)";
            return Err(StudyError::refused(
                None,
                "the measured profile itself is the line",
                allowed,
            ));
        }
        let (line, _, governing) = simulation.make_line(scene).map_err(of_scene)?;
        let line_is_exact =
            scene.roughness.is_none() && scene.form.is_some() && rises_everywhere(&line.gaps);
        let mut changed = Scene::clone(scene);
        // The work of adhesion stays where waves are left out.
        if let Some((adhesion, work)) = scene.adhesion.zip(governing.work_of_adhesion) {
            changed.adhesion = Some(adhesion.with_work(work));
        }
        changed.observe.clear();
        let mut resolved = Resolved {
            line: scene.clone(),
            measured: None,
            body: Body {
                form: scene.form.clone(),
                shells: None,
                adhesive_height_factor: 1.0,
                side: scene.length,
                effective_modulus: governing.effective_modulus,
                works: governing.adhesive_works(),
            },
            line_roughness: None,
            waves: None,
            omitted: None,
            line_is_exact,
        };
        let finest = cells as u64 / CELLS_PER_WAVE;
        let points = |last: u64| {
            (SPRINGS_PER_WAVE * last)
                .next_power_of_two()
                .max(LEAST_SPRINGS)
        };
        let mut keep = |first: u64, whole: u64| {
            let last = whole.min(finest);
            (resolved.waves, resolved.omitted) =
                (Some((first, last)), (last < whole).then_some(whole));
            if first <= last {
                Ok(last)
            } else {
                Err(too_few(cells, first))
            }
        };
        if let (Some(spectrum), Some(amplitude)) = (scene.spectrum(), governing.amplitude) {
            let last = keep(spectrum.first, spectrum.last)?;
            let kept = asperity_surface::SelfAffine { last, ..spectrum };
            let first = amplitude.rms_height / spectrum.relative_rms();
            let Some(Roughness::SelfAffine {
                rms_height,
                rms_gradient,
                modes,
                wavelengths,
                ..
            }) = &mut changed.roughness
            else {
                unreachable!("a spectrum is that of self-affine roughness")
            };
            (*rms_height, *rms_gradient) = (Some(first * kept.relative_rms()), None);
            (*modes, *wavelengths) = (Some((kept.first, kept.last)), None);
            changed.numerics.points = points(last);
            let amplitude = kept
                .unit_amplitude(scene.length)
                .scaled(first * kept.relative_rms());
            let spectrum = Spectrum::SelfAffine {
                spectrum: kept,
                amplitude: first,
            };
            resolved.roughen(spectrum, (kept.first, kept.last), amplitude);
        } else if let Some(line) = simulation.equivalent_line() {
            let mut modes = line.modes(scene.length, usize::MAX)?;
            modes.last = keep(modes.first, modes.last)?;
            let ModeRange { first, last } = modes;
            let line = line.up_to(TAU * last as f64 / scene.length);
            changed.numerics.points = points(last);
            resolved.measured = Some(Arc::new(MeasuredRoughness::Equivalent(line.clone())));
            let amplitude = line.amplitude_of_modes(scene.length, modes);
            resolved.roughen(Spectrum::Measured(line), (first, last), amplitude);
        }
        resolved.line = changed
            .checked()
            .map_err(|errors| of_scene(errors.into()))?;
        Ok(resolved)
    }

    /// Gives the squares the waves of a spectrum. `amplitude` is that of the profiles with these
    /// modes.
    fn roughen(&mut self, spectrum: Spectrum, modes: (u64, u64), amplitude: Amplitude) {
        let shells = Shells::new(spectrum, self.body.side, modes);
        let line = ComparedRoughness {
            rms_height: amplitude.rms_height,
            rms_gradient: amplitude.rms_gradient,
            elastic_energy: amplitude.elastic_energy(self.body.effective_modulus),
        };
        let square = shells.roughness(self.body.effective_modulus);
        if square.elastic_energy > 0.0 {
            self.body.adhesive_height_factor = (line.elastic_energy / square.elastic_energy).sqrt();
        }
        self.body.shells = Some(shells);
        self.line_roughness = Some(line);
    }

    /// Returns a simulation of the profiles.
    pub fn simulation(&self) -> Simulation {
        let simulation = Simulation::default();
        match &self.measured {
            Some(measured) => simulation.with_measured(Arc::clone(measured)),
            None => simulation,
        }
    }
}

/// Returns true if a profile with these gaps rises everywhere on both sides of its deepest point.
fn rises_everywhere(gaps: &[f64]) -> bool {
    let deepest = gaps.iter().copied().fold(0.0, f64::max);
    let summit = (0..gaps.len())
        .min_by(|one, other| gaps[*one].total_cmp(&gaps[*other]))
        .unwrap_or(0);
    let rises = |inner: f64, outer: f64| outer >= inner - ROUNDING * deepest;
    gaps[summit..]
        .windows(2)
        .all(|pair| rises(pair[0], pair[1]))
        && gaps[..=summit]
            .windows(2)
            .all(|pair| rises(pair[1], pair[0]))
}

/// Converts an error of the scene itself.
pub(super) fn of_scene(error: RunError) -> StudyError {
    StudyError::Run {
        place: String::new(),
        error,
    }
}

fn too_few(cells: usize, first: u64) -> StudyError {
    StudyError::refused(
        Some(&format!("{cells} cells")),
        format!(
            "the longest wave of the scene has {} cells",
            cells as u64 / first
        ),
        format!(
            "at least {} cells along the side",
            (CELLS_PER_WAVE * first).next_power_of_two()
        ),
    )
}
