//! Premises of the model that a scene does not meet.

use super::governing::{Governing, SteepWaves};
use crate::scene::model::{Roughness, Scene, Solver};
use asperity_contact::{Direction, History, Move};
use asperity_data::{Warning, path_name};
use asperity_surface::{Form, Sphere};
use std::f64::consts::TAU;
use std::path::Path;

/// Distance from the axis at which the edge of a contact begins, as a share of its radius.
const EDGE: f64 = 0.95;

/// Number of halvings that find a distance to 15 digits.
const HALVINGS: usize = 50;

/// Returns the largest distance in m from the axis, up to `most`, at which the equivalent profile
/// of a form is no deeper than `depth` in m.
fn distance_at_depth(form: &Form, depth: f64, most: f64) -> f64 {
    if form.mdr_profile(most) <= depth {
        return most;
    }
    let mut low = 0.0;
    let mut high = most;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if form.mdr_profile(middle) <= depth {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Facts about the profile of a scene with a measured surface. They follow from the surface and not
/// from the fields of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MeasuredFacts {
    /// Length of the scan in m.
    pub scan: f64,
    /// Rms height of the surface in m, and rms height in m of the profile that was made from it.
    pub rms_heights: [f64; 2],
    /// Share of long waves, which are longer than a quarter of the scan, in the mean squared height
    /// of the profile.
    pub long_wave_share: f64,
    /// Smallest number of periods over the profile such that the waves with at most as many periods
    /// have together at least a tenth of its mean squared height. `None` if the profile is not
    /// random.
    pub long_waves: Option<f64>,
}

impl Scene {
    /// Returns a warning for each premise of the model that this scene does not meet, as far as the
    /// fields of the scene show this. Other warnings need a computation, for example if the contact
    /// reaches the ends of the profile, or if a measured surface is unsuitable.
    /// [`Outcome::warnings`](crate::Outcome::warnings) has all warnings.
    ///
    /// ```
    /// use asperity_contact::{Modulus, Move};
    /// use asperity_scene::ProfileBuilder;
    ///
    /// let coarse = ProfileBuilder::new(1.0e-4, 256)
    ///     .self_affine(0.7)
    ///     .rms_height(1.0e-7)
    ///     .modes(8, 100);
    /// let scene = coarse.scene(Modulus::effective(1.0e6)?, None, &[Move::ToTouch])?;
    /// let warnings = scene.warnings();
    /// assert_eq!(
    ///     (warnings.len(), warnings[0].name()),
    ///     (1, "few_springs_per_wave")
    /// );
    /// # Ok::<(), asperity_scene::Error>(())
    /// ```
    pub fn warnings(&self) -> Vec<Warning> {
        let unit = self
            .spectrum()
            .map(|spectrum| spectrum.unit_amplitude(self.length));
        self.warnings_of(&Governing::of(self, unit, None), None)
    }

    /// Returns a warning for each premise that this scene does not meet. `governing` has the
    /// governing parameters of the scene. `measured` has the facts about the measured surface of
    /// the scene; `None` if there is no such surface.
    pub(crate) fn warnings_of(
        &self,
        governing: &Governing,
        measured: Option<MeasuredFacts>,
    ) -> Vec<Warning> {
        let adheres = governing.adhesive_work().is_some();
        let mut warnings = Vec::new();
        warnings.extend(self.heights_as_profile());
        warnings.extend(self.rest_without_relaxation());
        if let Some(number) = governing.tabor_number(self) {
            warnings.extend(Warning::of_tabor_number(number));
        }
        if let Some(amplitude) = governing.amplitude {
            let is_measured = self.measured().is_some();
            warnings.extend(Warning::of_gradient(amplitude.rms_gradient, is_measured));
        }
        if let Some(waves) = SteepWaves::of(self, governing) {
            warnings.extend(Warning::of_wave_ratio(waves.ratio, waves.jkr_factor));
        }
        warnings.extend(self.improbable_form());
        if adheres {
            warnings.extend(self.falling_profile());
        }
        if let Some(facts) = measured {
            let MeasuredFacts {
                scan,
                rms_heights,
                long_wave_share,
                ..
            } = facts;
            if let Some(surface) = self.measured() {
                let file = path_name(Path::new(&surface.file));
                warnings.extend(Warning::of_lengths(&file, scan, rms_heights[0]));
            }
            warnings.extend(Warning::of_scan(scan, self.length, rms_heights));
            warnings.extend(Warning::of_short_scan(scan, self.length, long_wave_share));
        }
        warnings.extend(self.rounded_waves());
        if adheres && let Some(waves) = self.long_waves(measured) {
            warnings.extend(Warning::of_long_waves(waves));
        }
        if let Some(springs) = self.springs_per_wave() {
            warnings.extend(Warning::of_springs_per_wave(springs));
        }
        warnings
    }

    /// Returns a warning if the loading rests and the half-space does not relax.
    fn rest_without_relaxation(&self) -> Option<Warning> {
        let mut seconds = 0.0;
        for stage in &self.loading {
            if let Move::Hold(time) = stage {
                seconds += time;
            }
        }
        let is_without_effect = seconds > 0.0 && self.material.relaxation.is_none();
        is_without_effect.then_some(Warning::RestWithoutRelaxation { seconds })
    }

    /// Returns a warning if measured heights are the profile itself and the scene also has a form.
    /// This warning depends only on the fields of the scene. Warnings that depend on the heights
    /// are returned by [`Profile::doubt`](asperity_contact::Profile::doubt).
    fn heights_as_profile(&self) -> Option<Warning> {
        let has_form = self.form.is_some();
        (self.measured_as_line() && has_form).then_some(Warning::HeightsAsProfile)
    }

    /// Returns a warning if the table of the form is so long that its unit is probably wrong. The
    /// table must have been read.
    fn improbable_form(&self) -> Option<Warning> {
        let form = self.form.as_ref()?;
        let table = form.table()?;
        let file = match form.table_file() {
            Some(file) => path_name(Path::new(file)),
            None => "rows of the form".to_owned(),
        };
        Warning::of_reach(&file, table.reach(), self.length)
    }

    /// Returns a warning if the steps of the stepwise solver are too coarse for a loading;
    /// otherwise `None`.
    ///
    /// A force on unloading may jump past the force at which a stage should end, however short the
    /// steps are. Only stages of loading therefore show by their forces that the steps are coarse.
    pub(crate) fn coarse_steps(&self, history: &History) -> Option<Warning> {
        let Solver::Stepwise { step } = self.numerics.solver else {
            return None;
        };
        let mut forces = Vec::new();
        let mut highest = f64::INFINITY;
        let mut deepest = f64::NEG_INFINITY;
        for stage in &history.stages {
            for point in stage.curve.iter().filter(|point| point.springs > 0) {
                highest = highest.min(point.indentation);
                deepest = deepest.max(point.indentation);
            }
            if let (Move::ToForce(target), Direction::Loading, Some(end)) =
                (stage.target, stage.direction, stage.end_in_contact())
                && target > 0.0
            {
                forces.push([target, end.force]);
            }
        }
        // A body that touches at one place or nowhere makes no steps that matter.
        let has_moved = deepest > highest || !forces.is_empty();
        let way = (deepest - highest).max(0.0);
        has_moved.then(|| Warning::of_steps(step, way, &forces))?
    }

    fn falling_profile(&self) -> Option<Warning> {
        let table = self.form.as_ref().and_then(Form::table)?;
        let from = table.falls_from(0.5 * self.length)?;
        Some(Warning::FallingProfile { from })
    }

    /// Returns a warning if the form of the body is steep at the edge of the largest contact of a
    /// loading; otherwise `None`. Waves of the form are left out, because they count as roughness.
    pub(crate) fn steep_form(&self, history: &History) -> Option<Warning> {
        let form = self.form.as_ref()?.without_waves();
        let mut contact_length = 0.0_f64;
        let mut deepest = 0.0_f64;
        for point in history.stages.iter().flat_map(|stage| &stage.curve) {
            contact_length = contact_length.max(point.contact_length);
            deepest = deepest.max(point.indentation);
        }
        // Several spheres have several contacts, which share the contact length and the length of
        // the profile.
        let bodies = form.contacts() as f64;
        let half_length = 0.5 * self.length / bodies;
        let half_contact = 0.5 * contact_length / bodies;
        let touched = distance_at_depth(&form, deepest, half_length);
        let radius = touched.max(half_contact).min(half_length);
        // The slope is a mean over the outer part of the contact, which also exists for a form
        // given by a table.
        let inner = EDGE * radius;
        let fall = form.depth(radius)? - form.depth(inner)?;
        Warning::of_slope_of_form(fall / (radius - inner))
    }

    /// Returns a warning if the contact of one of several spheres reaches an end of its part of the
    /// profile, where the next sphere begins. The warning states the length of this part. Roughness
    /// is left out.
    ///
    /// A contact of half-width w grows up to w where the indentation of its sphere is
    /// w²/R − √(2πwγ₁/E*).
    pub(crate) fn wide_sphere(&self, history: &History, governing: &Governing) -> Option<Warning> {
        let spheres = self.form.as_ref()?.spheres();
        let part = self.length / spheres.len() as f64;
        let half_width = 0.5 * part - self.spacing();
        let closing_work = governing
            .adhesive_works()
            .map_or(0.0, |[closing, _]| closing);
        let stretch = (TAU * half_width * closing_work / governing.modulus).sqrt();
        let points = history.stages.iter().flat_map(|stage| &stage.curve);
        let in_contact = points.filter(|point| point.springs > 0);
        let deepest = in_contact.map(|point| point.indentation).reduce(f64::max)?;
        let reaches_end = |sphere: &Sphere| {
            deepest - sphere.behind >= half_width * half_width / sphere.radius - stretch
        };
        let is_wide = spheres.iter().any(reaches_end);
        is_wide.then_some(Warning::ContactAtEnds { length: part })
    }

    /// Returns a warning if the waves of the profile differ from the wavelengths that the scene
    /// states.
    fn rounded_waves(&self) -> Option<Warning> {
        let Some(Roughness::SelfAffine {
            wavelengths: Some((longest, shortest)),
            modes: None,
            ..
        }) = self.roughness
        else {
            return None;
        };
        let spectrum = self.spectrum()?;
        let used = [spectrum.first, spectrum.last].map(|mode| self.length / mode as f64);
        Warning::of_waves([longest, shortest], used)
    }

    /// Returns how many of the longest waves of a random roughness fit on the flat face of the
    /// body. Returns `None` if the body is not nominally flat.
    fn long_waves(&self, measured: Option<MeasuredFacts>) -> Option<f64> {
        let share_of_length = match &self.form {
            None => 1.0,
            Some(form) => 2.0 * form.flat_end()? / self.length,
        };
        let waves = match self.spectrum() {
            // At wavelengths above the roll-off, the waves of the profile become lower with the
            // wavelength. The roll-off wavelength therefore counts as the longest wave.
            Some(spectrum) => (spectrum.first as f64).max(spectrum.roll_off_mode),
            None => measured?.long_waves?,
        };
        Some(waves * share_of_length)
    }

    /// Returns the number of springs for each shortest wave of a random roughness. Returns `None`
    /// if the scene does not state the shortest wave.
    fn springs_per_wave(&self) -> Option<f64> {
        match self.roughness.as_ref()? {
            Roughness::SelfAffine { .. } => {
                Some(self.numerics.points as f64 / self.spectrum()?.last as f64)
            }
            Roughness::Measured(measured) => Some(measured.continue_to? / self.spacing()),
        }
    }
}
