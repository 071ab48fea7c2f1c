//! Checks that find the invalid values of a scene. First each field is checked against its range.
//! Then fields are checked against each other, because values may contradict or exclude each other,
//! or a value may be missing.
//!
//! No check allocates memory in proportion to a value of the scene. A scene of excessive size is
//! therefore refused before any large array is made.

use super::adhesion::{Adhesion, Strength};
use super::errors::SceneError;
use super::field::{FILE_NAME, Field, STAGE_INDENTATION, TABLE, sphere_values, target_field};
use super::fields::{FIELDS, field};
use super::measured::Measured;
use super::model::{Material, Roughness, SPRINGS_PER_WAVE, Scene, Solver};
use super::range::Range;
use super::slot::Value;
use super::spheres::MOST_SPHERES;
use super::stages::stage_in_ron;
use super::text::index::is_within;
use super::text::{ron_float, ron_string};
use asperity_contact::{Edges, Move};
use asperity_data::{is_control, round_to};
use asperity_surface::{Form, Sphere, Unit};

/// Largest number of curve points of all loading stages together. A curve of this size fits into
/// the memory of a small machine.
const MOST_SAMPLES: u64 = 1 << 24;

/// Returns all errors of a scene in the order of its fields. The list is empty if the scene is
/// valid.
pub fn check(scene: &Scene) -> Vec<SceneError> {
    let mut found = Found {
        scene,
        errors: Vec::new(),
    };
    for field in FIELDS {
        found.check_range(field);
        if field.path == "loading" {
            found.check_targets();
        }
    }
    found.check_material();
    found.check_form();
    found.check_roughness();
    found.check_adhesion();
    found.check_loading();
    found.errors
}

/// Returns the invalid part of a text and the allowed values; `None` if the text is valid.
fn wrong_text(field: &Field, text: &str) -> Option<(String, String)> {
    // Only the rows of a table in place of its name are longer than a name.
    let is_name = field.range == TABLE && !text.starts_with(Form::ROWS_IN_PLACE);
    let range = match field.range {
        Range::Text { .. } if !is_name => field.range,
        _ => FILE_NAME,
    };
    let Range::Text { least, most, lines } = range else {
        return None;
    };
    // Control characters in a text would change the terminal of anyone who reads the scene.
    let forbidden = text
        .chars()
        .find(|sign| is_control(*sign) && !(lines && *sign == '\n'));
    if let Some(sign) = forbidden {
        let but = if lines { " but line breaks" } else { "" };
        let found = format!("text with {sign:?}");
        return Some((found, format!("no control characters{but}")));
    }
    let count = text.chars().count();
    if count > most {
        Some((format!("{count} characters"), field.allowed()))
    } else if count < least {
        Some((ron_string(text), field.allowed()))
    } else {
        None
    }
}

/// Number of digits of a limit that is computed from other values.
const LIMIT_DIGITS: usize = 8;

/// Returns an upper limit as text, rounded down so that the shown value is allowed.
fn largest(value: f64) -> String {
    let near = round_to(value, LIMIT_DIGITS);
    ron_float(if near > value {
        round_to(value * (1.0 - 1e-7), LIMIT_DIGITS)
    } else {
        near
    })
}

/// Returns a lower limit as text, rounded up so that the shown value is allowed.
fn smallest(value: f64) -> String {
    let near = round_to(value, LIMIT_DIGITS);
    ron_float(if near < value {
        round_to(value * (1.0 + 1e-7), LIMIT_DIGITS)
    } else {
        near
    })
}

fn is_empty_or_unit(text: &str) -> bool {
    text.is_empty() || text.parse::<Unit>().is_ok()
}

/// Errors that were found so far in a scene.
struct Found<'s> {
    scene: &'s Scene,
    errors: Vec<SceneError>,
}

impl Found<'_> {
    /// Returns true if an error of the field at `path`, or of a field inside it, was found.
    fn has(&self, path: &str) -> bool {
        self.errors
            .iter()
            .any(|error| is_within(&error.field, path))
    }

    /// Adds an error about the field `path` if the condition `is_met` is false. No error is added
    /// if one of the `compared` fields already has one. `allowed` is empty if `message` contains
    /// the allowed values. If the field is a group, its value is not repeated in the error.
    fn require(
        &mut self,
        is_met: bool,
        compared: &[&str],
        path: &str,
        allowed: &str,
        message: &str,
    ) {
        if is_met || compared.iter().any(|path| self.has(path)) {
            return;
        }
        let field = FIELDS
            .iter()
            .find(|field| field.path == path && field.is_in(self.scene));
        let value = field
            .filter(|field| field.inside(self.scene).is_empty())
            .and_then(|field| field.written(self.scene))
            .unwrap_or_default();
        self.refuse(path, value, allowed, message);
    }

    fn refuse(&mut self, path: &str, value: String, allowed: &str, message: &str) {
        self.errors.push(SceneError {
            field: path.to_owned(),
            value,
            allowed: allowed.to_owned(),
            message: message.to_owned(),
            ..SceneError::default()
        });
    }

    fn check_range(&mut self, field: &Field) {
        let scene = self.scene;
        let Some(value) = field.value(scene) else {
            return;
        };
        let range = &field.range;
        let is_allowed = match value {
            Value::Real(number) => range.contains(number),
            Value::Whole(number) => range.contains_whole(number),
            Value::Modes(first, last) => {
                first <= last && range.contains_whole(first) && range.contains_whole(last)
            }
            Value::Wavelengths(longest, shortest) => {
                longest >= shortest && range.contains(longest) && range.contains(shortest)
            }
            Value::Text(text) => return self.check_text(field, text),
            Value::Texts(texts) => {
                self.check_count(field, texts.len());
                for text in texts {
                    self.check_text(field, text);
                }
                return;
            }
            Value::Stages(stages) => return self.check_count(field, stages.len()),
            Value::Observers(observers) => return self.check_count(field, observers.len()),
            Value::Spheres(spheres) => return self.check_spheres(spheres),
            Value::Flag(_) | Value::Choice(_) | Value::Group => return,
        };
        if !is_allowed {
            let written = field.written(scene).unwrap_or_default();
            self.refuse(field.path, written, &field.allowed(), field.name);
        }
    }

    fn check_text(&mut self, field: &Field, text: &str) {
        if let Some((value, allowed)) = wrong_text(field, text) {
            self.refuse(field.path, value, &allowed, field.name);
        }
    }

    fn check_count(&mut self, field: &Field, count: usize) {
        let Range::List { least, most, .. } = field.range else {
            return;
        };
        if (least..=most).contains(&count) {
            return;
        }
        let value = if count == 0 {
            "[]".to_owned()
        } else {
            format!("a list of {count}")
        };
        self.refuse(field.path, value, &field.allowed(), field.name);
    }

    fn check_targets(&mut self) {
        let scene = self.scene;
        for (index, stage) in scene.loading.iter().enumerate() {
            if let Some((field, value)) = target_field(*stage)
                && !field.range.contains(value)
            {
                let path = format!("loading.{index}.0");
                self.refuse(&path, ron_float(value), &field.allowed(), field.name);
            }
        }
    }

    /// Checks the number of spheres of a form and the range of their values.
    fn check_spheres(&mut self, spheres: &[Sphere]) {
        if !(1..=MOST_SPHERES).contains(&spheres.len()) {
            let value = match spheres.len() {
                0 => "Spheres([])".to_owned(),
                count => format!("a list of {count} spheres"),
            };
            let allowed = format!("a list of 1 to {MOST_SPHERES}, such as [(radius: 5.0e-6)]");
            return self.refuse("form", value, &allowed, "spheres of the form");
        }
        for (index, sphere) in spheres.iter().enumerate() {
            for (field, value) in sphere_values(*sphere) {
                if !field.range.contains(value) {
                    let path = format!("form.{index}.{}", field.last());
                    self.refuse(&path, ron_float(value), &field.allowed(), field.name);
                }
            }
        }
    }

    fn check_material(&mut self) {
        let Material {
            youngs_modulus,
            poisson_ratio,
            modulus,
            relaxation: _,
        } = self.scene.material;
        let wrong = match (modulus, youngs_modulus, poisson_ratio) {
            (Some(_), None, None) | (None, Some(_), Some(_)) => "",
            (Some(_), ..) => {
                "modulus replaces youngs_modulus and poisson_ratio: give one or the other"
            }
            (None, Some(_), None) => "youngs_modulus requires poisson_ratio, which is missing",
            (None, None, Some(_)) => "poisson_ratio requires youngs_modulus, which is missing",
            (None, None, None) => "give youngs_modulus with poisson_ratio, or modulus",
        };
        self.require(wrong.is_empty(), &[], "material", "", wrong);
        let modulus = self.scene.material.modulus_in_pascals();
        let Some(field) = field("material.modulus", None) else {
            return;
        };
        if !field.range.contains(modulus) && !self.has("material") {
            let value = format!("E* = {}", ron_float(modulus));
            self.refuse(
                "material",
                value,
                &field.allowed(),
                "effective modulus E/(1 − ν²)",
            );
        }
    }

    fn check_form(&mut self) {
        let scene = self.scene;
        let Some(form) = &scene.form else {
            return;
        };
        if let Some(radius) = form.flat_end() {
            return self.check_flat_end(radius);
        }
        if let Form::Table { unit, .. } = form {
            self.require(
                is_empty_or_unit(unit),
                &["form"],
                "form.unit",
                Unit::ALLOWED,
                "unit of the table",
            );
        }
        if let &Form::WavySphere { wavelength, .. } = form {
            let shortest = SPRINGS_PER_WAVE as f64 * scene.spacing();
            let allowed = format!("at least {} m", smallest(shortest));
            let reason = format!(
                "a wave has at least {SPRINGS_PER_WAVE} springs: more points or longer waves"
            );
            self.require(
                wavelength >= shortest,
                &["form", "length", "numerics.points"],
                "form.wavelength",
                &allowed,
                &reason,
            );
        }
        if let Form::Spheres(spheres) = form {
            self.check_places(spheres);
        }
        self.check_depth(form);
    }

    /// Checks that one sphere is ahead of all others, from which the distances of the others are
    /// measured, and that each sphere has springs.
    fn check_places(&mut self, spheres: &[Sphere]) {
        let behinds = spheres.iter().map(|sphere| sphere.behind);
        let least = behinds.fold(f64::INFINITY, f64::min);
        let most = ron_float(round_to(least, LIMIT_DIGITS));
        let reason =
            format!("no sphere is ahead: behind is 0 for one of them, so take {most} from each");
        self.require(least == 0.0, &["form"], "form", "", &reason);
        let points = self.scene.numerics.points;
        let count = spheres.len();
        let reason = format!("{count} spheres have {points} springs: more points or fewer spheres");
        self.require(
            count as u64 <= points,
            &["form", "numerics.points"],
            "form",
            "",
            &reason,
        );
    }

    /// Checks that the flat end of a punch is not wider than the profile, and that at least one
    /// spring lies under it.
    fn check_flat_end(&mut self, radius: f64) {
        let scene = self.scene;
        let half = scene.length / 2.0;
        let reason = format!(
            "a punch is not wider than the line: at most length/2 = {}",
            largest(half)
        );
        self.require(
            radius <= half,
            &["form", "length"],
            "form.radius",
            "",
            &reason,
        );
        let reason = format!(
            "no spring lies under the punch: the springs are {} m apart; more points or a larger radius",
            ron_float(round_to(scene.spacing(), LIMIT_DIGITS))
        );
        self.require(
            !scene.springs_under_body().is_empty(),
            &["form", "length", "numerics.points"],
            "form.radius",
            "",
            &reason,
        );
    }

    /// Checks that the depth of the body at the ends of the profile is within the allowed range of
    /// indentations.
    fn check_depth(&mut self, form: &Form) {
        let scene = self.scene;
        let half = scene.length / 2.0;
        let depth = form.depth_within(scene.length);
        let wave_depth = form.wave_depth(half);
        // The field in the error message is the first number of the form, because this number
        // determines the depth. For a wavy sphere it is the amplitude if the waves are deeper than
        // the sphere.
        let is_size = |field: &&Field| {
            if wave_depth > depth {
                field.path == "form.amplitude"
            } else {
                field.parent() == "form" && field.is_in(scene)
            }
        };
        let size = FIELDS
            .iter()
            .find(is_size)
            .map_or("form", |field| field.path);
        let most = STAGE_INDENTATION.range.ends().map_or(0.0, |(_, most)| most);
        let reason = format!(
            "the form is too steep: it exceeds the largest indentation ({most} m) within the length of the profile"
        );
        self.require(
            STAGE_INDENTATION.range.contains(depth + wave_depth),
            &["form", "length"],
            size,
            "",
            &reason,
        );
    }

    fn check_roughness(&mut self) {
        match &self.scene.roughness {
            None => {}
            &Some(Roughness::SelfAffine {
                rms_height,
                rms_gradient,
                modes,
                wavelengths,
                roll_off,
                ..
            }) => {
                self.check_waves(modes, wavelengths, roll_off);
                let wrong = match (rms_height, rms_gradient) {
                    (Some(_), Some(_)) => {
                        "rms_height and rms_gradient determine each other: give one of them"
                    }
                    (None, None) => "the amplitude is missing: give rms_height or rms_gradient",
                    _ => "",
                };
                self.require(wrong.is_empty(), &[], "roughness", "", wrong);
            }
            Some(Roughness::Measured(measured)) => self.check_measured(measured),
        }
    }

    /// Checks the units of a measured surface. Also checks that a profile is one row or one column
    /// of a single file, because several files have a common spectrum but no common profile.
    fn check_measured(&mut self, measured: &Measured) {
        let units = [
            ("roughness.unit", &measured.unit),
            ("roughness.height_unit", &measured.height_unit),
        ];
        for (path, unit) in units {
            let is_unit = is_empty_or_unit(unit);
            self.require(is_unit, &[path], path, Unit::ALLOWED, "unit of the file");
        }
        self.require(
            measured.row.is_none() || measured.column.is_none(),
            &[],
            "roughness.column",
            "",
            "a profile is a row or a column: give one of them",
        );
        self.require(
            !measured.as_line || measured.opposite.is_none(),
            &[],
            "roughness.opposite",
            "",
            "spectra of two faces add, their profiles do not: give as_line: false",
        );
        self.require(
            !measured.as_line || measured.further_files.is_empty(),
            &[],
            "roughness.further_files",
            "",
            "several files have one spectrum, and no profile: give as_line: false",
        );
    }

    /// Checks that the waves fit on the length, that the springs resolve them, and that the
    /// roll-off wavelength is between the longest and the shortest wave.
    fn check_waves(
        &mut self,
        modes: Option<(u64, u64)>,
        wavelengths: Option<(f64, f64)>,
        roll_off: Option<f64>,
    ) {
        let length = self.scene.length;
        if modes.is_some() && wavelengths.is_some() {
            let reason = "modes and wavelengths determine each other: give one of them and set the other to None";
            return self.refuse("roughness", String::new(), "", reason);
        }
        let Some(spectrum) = self.scene.spectrum() else {
            let reason =
                "give modes, in waves per length, or wavelengths (longest, shortest), in m";
            return self.refuse("roughness", String::new(), "", reason);
        };
        let path = if modes.is_some() {
            self.check_last_mode(spectrum.last);
            "roughness.modes"
        } else {
            self.check_shortest_wave(spectrum.last);
            "roughness.wavelengths"
        };
        let (longest, shortest) = wavelengths.unwrap_or((
            length / spectrum.first as f64,
            length / spectrum.last as f64,
        ));
        let allowed = format!("longest at most length = {} m", largest(length));
        self.require(
            longest <= length,
            &[path, "length"],
            path,
            &allowed,
            "a longer wave does not fit the profile",
        );
        let allowed = format!("from {} to {} m", smallest(shortest), largest(longest));
        self.require(
            roll_off.is_none_or(|wavelength| (shortest..=longest).contains(&wavelength)),
            &[path, "roughness.roll_off", "length"],
            "roughness.roll_off",
            &allowed,
            "a roll-off lies within the waves of the profile",
        );
    }

    /// Checks that the springs resolve the last of the given modes.
    fn check_last_mode(&mut self, last: u64) {
        let points = self.scene.numerics.points;
        let most = points / 2;
        let allowed = format!("last mode at most points/2 = {most}");
        let reason = format!("{points} springs carry no shorter wave");
        self.require(
            last <= most,
            &["roughness.modes", "numerics.points"],
            "roughness.modes",
            &allowed,
            &reason,
        );
    }

    /// Checks that the springs resolve the shortest of the given wavelengths. `last` is the mode of
    /// this wavelength.
    fn check_shortest_wave(&mut self, last: u64) {
        let points = self.scene.numerics.points;
        let most = points / 2;
        let shortest = smallest(self.scene.length / most as f64);
        let allowed = format!("shortest at least two springs = {shortest} m");
        let reason = format!("{points} springs carry no shorter wave");
        self.require(
            last <= most,
            &["roughness.wavelengths", "numerics.points", "length"],
            "roughness.wavelengths",
            &allowed,
            &reason,
        );
    }

    /// Checks that the work of adhesion on closing does not exceed the work on opening. Also checks
    /// that κ or e_el/γ is given only for a rough body.
    fn check_adhesion(&mut self) {
        let Some(Adhesion { strength, .. }) = self.scene.adhesion else {
            return;
        };
        match strength {
            // If the work on closing were larger than the work on opening, a spring would detach as
            // soon as it has attached.
            Strength::Work { opening, closing } => {
                let allowed = format!("0 to {} J/m²", largest(opening));
                self.require(
                    closing.is_none_or(|closing| closing <= opening),
                    &["adhesion"],
                    "adhesion.closing_work",
                    &allowed,
                    "at most adhesion.work",
                );
            }
            Strength::Parameter(parameter, _) if self.scene.roughness.is_none() => {
                let end = "there is none: give roughness, or adhesion by work";
                let reason = format!(
                    "{} measures adhesion against roughness, and {end}",
                    parameter.symbol()
                );
                self.refuse(parameter.path(), String::new(), "", &reason);
            }
            Strength::Parameter(..) => {}
        }
    }

    fn check_loading(&mut self) {
        let scene = self.scene;
        let mut is_separated = true;
        for (index, stage) in scene.loading.iter().enumerate() {
            let pulls = *stage == Move::ToSeparation
                || matches!(stage, Move::ToForce(force) if *force < 0.0);
            if is_separated && pulls {
                let reason =
                    "cannot pull before contact: start with ToTouch, ToForce or ToIndentation";
                let path = format!("loading.{index}");
                self.refuse(&path, stage_in_ron(stage), "", reason);
            }
            is_separated = *stage == Move::ToSeparation;
        }
        let stages = scene.loading.len() as u64;
        let samples = scene.numerics.samples;
        let allowed = format!("at most {}", MOST_SAMPLES / stages.max(1));
        let reason = format!(
            "too many points: samples × loading stages ({stages}) must not exceed {MOST_SAMPLES}"
        );
        self.require(
            stages.saturating_mul(samples) <= MOST_SAMPLES,
            &["numerics.samples", "loading"],
            "numerics.samples",
            &allowed,
            &reason,
        );
        let is_exact = scene.numerics.solver == Solver::Exact;
        self.require(
            is_exact || scene.loading_stiffness.is_none(),
            &[],
            "loading_stiffness",
            "",
            "the stepwise solver moves the body itself: numerics.solver: Exact, or no loading_stiffness",
        );
        self.require(
            is_exact || scene.numerics.edges == Edges::Grid,
            &[],
            "numerics.edges",
            "",
            "the stepwise solver moves whole springs: edges: Grid",
        );
        self.check_relaxation();
    }

    /// Checks that a scene with relaxation states its speed, and asks nothing that needs an elastic
    /// half-space.
    fn check_relaxation(&mut self) {
        let scene = self.scene;
        if !scene.relaxes() {
            return;
        }
        self.require(
            scene.loading_speed.is_some(),
            &[],
            "loading_speed",
            "",
            "relaxation needs the speed of the loading: loading_speed: 1.0e-6",
        );
        self.require(
            scene.numerics.solver == Solver::Exact,
            &[],
            "numerics.solver",
            "",
            "the stepwise solver has no time: numerics.solver: Exact, or no material.relaxation",
        );
        self.require(
            scene.numerics.edges == Edges::SubCell,
            &[],
            "numerics.edges",
            "",
            "relaxation needs edges between springs: edges: SubCell, or no material.relaxation",
        );
        let mut has_separated = false;
        for (index, stage) in scene.loading.iter().enumerate() {
            let approaches = !matches!(stage, Move::ToSeparation | Move::Hold(_));
            if has_separated && approaches {
                let path = format!("loading.{index}");
                let reason = "the surface has not recovered after the separation: one approach \
                              with relaxation, or no material.relaxation";
                self.refuse(&path, stage_in_ron(stage), "", reason);
                return;
            }
            has_separated |= *stage == Move::ToSeparation;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::Document;
    use super::*;

    fn sound() -> Scene {
        const TEXT: &str = r#"(
            version: 1,
            title: "A line",
            material: (youngs_modulus: 2.0e6, poisson_ratio: 0.5),
            length: 1.0e-4,
            roughness: SelfAffine(hurst: 0.7, rms_height: 1.0e-7, modes: (1, 512), seed: 1),
            adhesion: (work: 0.05),
            loading: [ToForce(1.0e-5), ToSeparation],
            numerics: (points: 4096, edges: Grid),
        )"#;
        Scene::clone(Document::parse(TEXT, "sound").unwrap().scene())
    }

    fn errors_with(sets: &str) -> Vec<String> {
        let sound = Document::from_scene(&sound(), "sound").unwrap();
        let pairs = sets.split("; ").filter_map(|set| set.split_once('='));
        let pairs: Vec<_> = pairs
            .map(|(path, value)| (path.to_owned(), value.to_owned()))
            .collect();
        let errors = sound.set_all(&pairs).err();
        errors
            .iter()
            .flat_map(|errors| errors.iter().map(SceneError::what))
            .collect()
    }

    #[test]
    fn fields_that_contradict_each_other_are_refused() {
        let no_amplitude = "roughness=SelfAffine(hurst: 0.7, modes: (1, 512), seed: 1)";
        let measured = "roughness=Measured(file: \"a.txt\", as_line: true";
        let waves = |pair: &str| format!("roughness.modes=None; roughness.wavelengths={pair}");
        for (sets, said) in [
            (
                "material=(modulus: 1e6, poisson_ratio: 0.5)",
                "modulus replaces ",
            ),
            (
                "material=(youngs_modulus: 1e6)",
                "requires poisson_ratio, which is missing",
            ),
            (
                "material=(poisson_ratio: 0.5)",
                "requires youngs_modulus, which is missing",
            ),
            ("material=()", "give youngs_modulus with poisson_ratio, or"),
            // E and ν are within their ranges, but for ν near −1 the effective modulus E* is out of
            // its range.
            (
                "material=(youngs_modulus: 1e6, poisson_ratio: -0.999999999)",
                "material = E* = 5.0",
            ),
            (
                "material=(youngs_modulus: 1e6, poisson_ratio: -0.999999)",
                "",
            ),
            (
                "roughness.rms_gradient=0.1",
                "rms_height and rms_gradient determine each other",
            ),
            (
                "adhesion.kappa=2.0",
                "adhesion: work and kappa determine each other: give (work: 0.05) or (kappa: 2.0)",
            ),
            ("adhesion.work=None; adhesion.elastic_energy_ratio=2.0", ""),
            (
                "adhesion=(kappa: 2.0, elastic_energy_ratio: 1.0)",
                "kappa and elastic_energy_ratio determine each other: give (kappa: 2.0) or",
            ),
            (
                "adhesion=()",
                "adhesion: give work, kappa or elastic_energy_ratio",
            ),
            ("adhesion=(work: 0.0)", ""),
            (
                "adhesion=(kappa: 2.0); roughness=None",
                "κ measures adhesion against roughness",
            ),
            (no_amplitude, "roughness: the amplitude is missing"),
            ("adhesion.closing_work=0.05", ""),
            (
                "adhesion.closing_work=0.0500001",
                "allowed: 0 to 0.05 J/m² (at most adhesion.work)",
            ),
            (
                "adhesion.work=0.061234567890123; adhesion.closing_work=0.07",
                "allowed: 0 to 0.061234562 J/m² (at most",
            ),
            (
                "adhesion=(kappa: 2.0, closing_work: 0.0)",
                "closing_work requires adhesion.work",
            ),
            ("numerics.points=1024", ""),
            (
                "numerics.points=1023",
                "roughness.modes = (1, 512): allowed: last mode at most points/2 = 511",
            ),
            ("roughness.modes=(5, 4)", "(5, 4): allowed: a pair"),
            ("roughness.modes=(0, 4)", "(0, 4): allowed: a pair"),
            (
                "roughness.wavelengths=(1e-4, 1e-6)",
                "roughness: modes and wavelengths determine each other",
            ),
            (
                "roughness.modes=None",
                "roughness: give modes, in waves per length, or wavelengths (longest",
            ),
            (&waves("50 µm, 1 µm"), ""),
            (&waves("1 µm, 50 µm"), "longest ≥ shortest"),
            (
                &waves("1 µm, 0 m"),
                "roughness.wavelengths = (1.0e-6, 0.0): allowed: a pair",
            ),
            (
                &waves("100 µm, 48 nm"),
                "allowed: shortest at least two springs = 4.8828125e-8 m",
            ),
            (
                &waves("100.1 µm, 1 µm"),
                "allowed: longest at most length = 1.0e-4 m",
            ),
            ("roughness.roll_off=1e-4", ""),
            (
                "roughness.roll_off=1.1e-4",
                "roll_off = 1.1e-4: allowed: from 1.953125e-7 to 1.0e-4 m",
            ),
            (
                &format!("{}; roughness.roll_off=60um", waves("50 µm, 1 µm")),
                "allowed: from 1.0e-6 to 5.0e-5 m",
            ),
            (
                &format!("{}; length=4e-5", waves("50 µm, 1 µm")),
                "allowed: longest at most length = 4.0e-5 m",
            ),
            (
                "form=Punch(radius: 5.1e-5)",
                "a punch is not wider than the line",
            ),
            // If the radius is less than a quarter of the spacing, the diameter is rounded to zero
            // cells.
            (
                "form=Punch(radius: 5.8e-9)",
                "no spring lies under the punch",
            ),
            ("form=Punch(radius: 6.4e-9)", ""),
            (
                "form=WavySphere(radius: 1.0, amplitude: 1e-9, wavelength: 9e-8)",
                "at least 4 springs",
            ),
            (
                "length=10; form=Cone(angle: 1.570796)",
                "form.angle = 1.570796: the form is too steep",
            ),
            (
                "length=1; form=WavySphere(radius: 1.0, amplitude: 1e6, wavelength: 0.1)",
                "1.0e6: the form is too steep",
            ),
            (
                "loading=[ToSeparation]",
                "loading.0 = ToSeparation: cannot pull before contact",
            ),
            (
                "loading=[ToForce(-1e-6)]",
                "loading.0 = ToForce(-1.0e-6): cannot pull",
            ),
            (
                "loading=[ToTouch, ToSeparation, ToForce(-1.0)]",
                "loading.2 = ToForce(-1.0): ",
            ),
            (
                "loading=[ToForce(1.0), ToForce(-1e-6), ToSeparation, ToForce(0.0), ToZeroForce]",
                "",
            ),
            (
                "numerics.solver=Stepwise(step: 1e-9); numerics.edges=SubCell",
                "whole springs: edges: Grid",
            ),
            (
                &format!("{measured}, row: 1, column: 2)"),
                "a profile is a row or a column",
            ),
            (
                &format!("{measured}, opposite: \"b.txt\")"),
                "spectra of two faces add",
            ),
            (
                &format!("{measured}, further_files: [\"b.txt\"])"),
                "several files have one spectrum",
            ),
            (
                &format!("{measured}, unit: \"px\")"),
                "roughness.unit = \"px\": allowed: m, cm",
            ),
            (
                "roughness=Measured(file: \"a\", as_line: false, further_files: [\"\"])",
                "further_files = \"\": ",
            ),
            (
                "title=\"a\\nb\"",
                "title = text with '\\n': allowed: no control characters",
            ),
            ("notice=\"a\\nb\"", ""),
            (
                "notice=\"\\u{1b}[2J\"",
                "allowed: no control characters but line breaks",
            ),
        ] {
            match (errors_with(sets).as_slice(), said) {
                ([], "") => {}
                ([error], said) if !said.is_empty() => {
                    assert!(error.contains(said), "{sets}: {error}")
                }
                (errors, _) => panic!("{sets}: {errors:?}"),
            }
        }
    }

    #[test]
    fn samples_of_all_stages_are_bounded_together() {
        let mut scene = sound();
        scene.loading = vec![Move::ToTouch; 1 << 14];
        scene.numerics.samples = 1 << 10;
        assert_eq!(check(&scene), vec![]);
        scene.numerics.samples += 1;
        assert_eq!(check(&scene)[0].field, "numerics.samples");
    }
}
