//! The bodies of a comparison with three dimensions: random profiles and square surfaces that have
//! only the waves that the grid of the square surfaces resolves.

use super::error::StudyError;
use super::shells::{ComparedRoughness, Shells, Spectrum};
use super::spatial::Body;
use asperity_half_space::check_cells;
use asperity_scene::{CheckedScene, Roughness, RunError, Scene, Simulation};
use asperity_surface::lines::{MeasuredRoughness, ModeRange};
use asperity_surface::{Amplitude, EquivalentLine, SelfAffine};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Smallest number of grid cells per shortest wave on a square surface.
const CELLS_PER_WAVE: u64 = 8;
/// Number of springs per shortest wave on a profile.
const SPRINGS_PER_WAVE: u64 = 64;
/// Smallest number of springs of a profile.
const LEAST_SPRINGS: u64 = 4096;
/// Share of the largest gap of a profile up to which a difference of gaps counts as a rounding
/// error.
const ROUNDING: f64 = 1e-12;

/// Profiles and square surfaces of a scene, without the waves that the grid of the square surfaces
/// does not resolve.
pub(super) struct Resolved {
    /// Scene that is computed on the profiles.
    pub line: CheckedScene,
    /// Spectrum of the random profiles if the scene has a measured surface, without the waves that
    /// the square surfaces do not resolve.
    measured: Option<Arc<MeasuredRoughness>>,
    pub body: Body,
    /// Roughness of the profiles; `None` for smooth profiles.
    pub line_roughness: Option<ComparedRoughness>,
    /// Longest and shortest wave of the roughness, each as the number of its periods over the
    /// length of the profile; `None` for a smooth body.
    pub waves: Option<(u64, u64)>,
    /// Shortest wave of the scene, given as its number of periods over the length of the profile,
    /// if the grid of the square surfaces does not resolve this wave. Otherwise `None`.
    pub omitted: Option<u64>,
    /// True for a smooth body of revolution whose profile rises everywhere from the axis outwards.
    /// The profile model is exact for such a body as long as the contact does not reach the ends of
    /// the profile.
    pub line_is_exact: bool,
}

impl Resolved {
    /// Makes the bodies of a scene for the comparison. `cells` is the number of grid cells along
    /// the side of a square surface. Waves that this grid does not resolve are left out of the
    /// bodies.
    ///
    /// # Errors
    /// Returns an error if the number of cells is not allowed, or if the scene has no body in three
    /// dimensions.
    pub fn of(
        scene: &CheckedScene,
        cells: usize,
        simulation: &mut Simulation,
    ) -> Result<Resolved, StudyError> {
        check_cells(cells)?;
        if scene.measured_as_line() {
            let found = "the measured profile itself is the line";
            let allowed = "its equivalent line, which has a surface in three dimensions (roughness.as_line=false)";
            return Err(StudyError::refused(None, found, allowed));
        }
        let (line, _, governing) = simulation.make_line(scene).map_err(of_scene)?;
        let line_is_exact =
            scene.roughness.is_none() && scene.form.is_some() && rises_everywhere(&line.gaps);
        let mut changed = Scene::clone(scene);
        // Without some waves, κ would give another work of adhesion. The bodies therefore get the
        // work of adhesion of the complete scene.
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
                modulus: governing.modulus,
                works: governing.adhesive_works(),
            },
            line_roughness: None,
            waves: None,
            omitted: None,
            line_is_exact,
        };
        if let (Some(spectrum), Some(amplitude)) = (scene.spectrum(), governing.amplitude) {
            resolved.keep_self_affine(spectrum, amplitude, cells, &mut changed)?;
        } else if let Some(line) = simulation.equivalent_line() {
            resolved.keep_measured(line, cells, &mut changed)?;
        }
        resolved.line = changed
            .checked()
            .map_err(|errors| of_scene(errors.into()))?;
        Ok(resolved)
    }

    /// Removes the waves of a self-affine spectrum that the grid of the square surfaces does not
    /// resolve, from these surfaces and from the profiles. `amplitude` is that of the complete
    /// spectrum.
    fn keep_self_affine(
        &mut self,
        spectrum: SelfAffine,
        amplitude: Amplitude,
        cells: usize,
        scene: &mut Scene,
    ) -> Result<(), StudyError> {
        let last = self.keep_waves(spectrum.first, spectrum.last, cells)?;
        let kept = SelfAffine { last, ..spectrum };
        let first_amplitude = amplitude.rms_height / spectrum.relative_rms();
        let kept_height = first_amplitude * kept.relative_rms();
        let Some(Roughness::SelfAffine {
            rms_height,
            rms_gradient,
            modes,
            wavelengths,
            ..
        }) = &mut scene.roughness
        else {
            unreachable!("a spectrum is that of self-affine roughness")
        };
        *rms_height = Some(kept_height);
        *rms_gradient = None;
        *modes = Some((kept.first, kept.last));
        *wavelengths = None;
        scene.numerics.points = springs(last);
        let amplitude = kept.unit_amplitude(scene.length).scaled(kept_height);
        let modes = (kept.first, kept.last);
        let spectrum = Spectrum::SelfAffine {
            spectrum: kept,
            amplitude: first_amplitude,
        };
        self.roughen(spectrum, modes, amplitude);
        Ok(())
    }

    /// Removes the waves of a measured spectrum that the grid of the square surfaces does not
    /// resolve, from these surfaces and from the profiles.
    fn keep_measured(
        &mut self,
        line: &EquivalentLine,
        cells: usize,
        scene: &mut Scene,
    ) -> Result<(), StudyError> {
        let whole = line.modes(scene.length, usize::MAX)?;
        let first = whole.first;
        let last = self.keep_waves(first, whole.last, cells)?;
        let line = line.up_to(TAU * last as f64 / scene.length);
        scene.numerics.points = springs(last);
        self.measured = Some(Arc::new(MeasuredRoughness::Equivalent(line.clone())));
        let amplitude = line.amplitude_of_modes(scene.length, ModeRange { first, last });
        self.roughen(Spectrum::Measured(line), (first, last), amplitude);
        Ok(())
    }

    /// Returns the last wave that a grid with `cells` cells along the side resolves. The waves of
    /// the scene go from `first` to `whole`, counted in periods over the length.
    ///
    /// # Errors
    /// Returns an error if the grid resolves none of these waves.
    fn keep_waves(&mut self, first: u64, whole: u64, cells: usize) -> Result<u64, StudyError> {
        let last = whole.min(cells as u64 / CELLS_PER_WAVE);
        self.waves = Some((first, last));
        self.omitted = (last < whole).then_some(whole);
        if first > last {
            return Err(too_few(cells, first));
        }
        Ok(last)
    }

    /// Sets the roughness of the square surfaces from a spectrum. `amplitude` is that of the
    /// profiles with the same modes.
    fn roughen(&mut self, spectrum: Spectrum, modes: (u64, u64), amplitude: Amplitude) {
        let shells = Shells::new(spectrum, self.body.side, modes);
        let line = ComparedRoughness {
            rms_height: amplitude.rms_height,
            rms_gradient: amplitude.rms_gradient,
            elastic_energy: amplitude.elastic_energy(self.body.modulus),
        };
        let square = shells.roughness(self.body.modulus);
        if square.elastic_energy > 0.0 {
            self.body.adhesive_height_factor = (line.elastic_energy / square.elastic_energy).sqrt();
        }
        self.body.shells = Some(shells);
        self.line_roughness = Some(line);
    }

    /// Returns a simulation for the profiles. If the profiles have a measured roughness, the
    /// simulation already contains this roughness.
    pub fn simulation(&self) -> Simulation {
        let simulation = Simulation::default();
        match &self.measured {
            Some(measured) => simulation.with_measured(Arc::clone(measured)),
            None => simulation,
        }
    }
}

/// Returns the number of springs of a profile whose shortest wave has `last` periods over the
/// length of the profile.
fn springs(last: u64) -> u64 {
    let springs = (SPRINGS_PER_WAVE * last).next_power_of_two();
    springs.max(LEAST_SPRINGS)
}

/// Returns true if the surface falls everywhere from its highest point to both sides, so that the
/// gaps rise.
fn rises_everywhere(gaps: &[f64]) -> bool {
    let deepest = gaps.iter().copied().fold(0.0, f64::max);
    let summit = (0..gaps.len())
        .min_by(|first, second| gaps[*first].total_cmp(&gaps[*second]))
        .unwrap_or(0);
    let rounding = ROUNDING * deepest;
    let mut right = gaps[summit..].windows(2);
    let mut left = gaps[..=summit].windows(2);
    right.all(|pair| pair[1] >= pair[0] - rounding)
        && left.all(|pair| pair[0] >= pair[1] - rounding)
}

/// Converts an error that occurs in the computation of a scene of the comparison.
pub(super) fn of_scene(error: RunError) -> StudyError {
    error.into()
}

fn too_few(cells: usize, first: u64) -> StudyError {
    let place = format!("{cells} cells");
    let of_wave = cells as u64 / first;
    let found = format!("the longest wave of the scene has {of_wave} cells");
    let least = (CELLS_PER_WAVE * first).next_power_of_two();
    let allowed = format!("at least {least} cells along the side");
    StudyError::refused(Some(&place), found, allowed)
}
