//! Invalid values of a scene: every field against its range, then the fields against each other, where values over-
//! or under-determine a scene, or exclude each other.
//!
//! No allocation here is proportional to a value of the scene, so an excessive scene is refused before anything is
//! built.

use serde_json::Value;

use super::errors::SceneError;
use super::field::{FILE_NAME, Field, LEG_INDENTATION, field};
use super::fields::FIELDS;
use super::form::Form;
use super::model::{Adhesion, Edges, Move, Roughness, SPRINGS_PER_WAVE, Scene, Solver};
use super::range::Range;
use super::text::{is_within, ron_float, ron_string};
use super::tree::{Tree, in_ron, written};
use crate::text::is_control;
use crate::topography::{Unit, UnitError};

/// Most samples of all loading stages together; a curve of this size still fits the memory of a small machine.
const MOST_SAMPLES: u64 = 1 << 24;

/// The line carries the transformed profile, which is at most this many times deeper than the profile.
const MOST_GROWTH: f64 = 20.0;

/// Fields that determine the amplitude of the roughness; all but the first three may specify adhesion.
const AMPLITUDE: &[&str] = &[
    "roughness",
    "roughness.rms_height",
    "roughness.rms_gradient",
    "adhesion.work",
    "adhesion.kappa",
    "adhesion.elastic_energy_ratio",
];

/// All errors of a scene, in the order of its fields; empty for a scene that can be computed.
pub fn check(scene: &Scene) -> Vec<SceneError> {
    let mut found = Found { scene, tree: Tree::of(scene), errors: Vec::new() };
    for field in FIELDS {
        found.check_range(field);
    }
    found.check_material();
    found.check_form();
    found.check_modes();
    found.check_measured();
    found.check_closing_work();
    found.check_amplitude();
    found.check_loading();
    found.check_edges();
    found.errors
}

/// The errors found so far in a scene.
struct Found<'s> {
    scene: &'s Scene,
    tree: Tree,
    errors: Vec<SceneError>,
}

impl Found<'_> {
    /// Returns true if an error of this field, or of anything inside it, was found.
    fn has(&self, path: &str) -> bool {
        self.errors.iter().any(|error| is_within(&error.field, path))
    }

    /// Refuses the value of a field for a reason other than its range. `allowed` is empty if `message` contains the
    /// allowed values; the value of a group is not repeated.
    fn refuse(&mut self, path: &str, allowed: &str, message: &str, involves: &'static [&'static str]) {
        let here = FIELDS.iter().find(|field| field.path == path && self.tree.has(field));
        let here = here.filter(|field| self.tree.inside(field).is_empty());
        let value = here.and_then(|field| self.tree.written(field)).unwrap_or_default();
        self.refuse_value(path, value, allowed, message, involves);
    }

    /// Refuses a value that is only part of a field.
    fn refuse_value(
        &mut self,
        path: &str,
        value: String,
        allowed: &str,
        message: &str,
        involves: &'static [&'static str],
    ) {
        let [field, allowed, message] = [path, allowed, message].map(str::to_owned);
        self.errors.push(SceneError { field, value, allowed, message, involves, ..SceneError::default() });
    }

    /// Checks the value of a field against its range.
    fn check_range(&mut self, field: &Field) {
        let Some(value) = self.tree.value(field) else { return };
        let range = &field.range;
        let wrong = match (range, value) {
            (Range::Real(..), value) => {
                (!value.as_f64().is_some_and(|value| range.contains(value))).then(|| written(value))
            }
            (Range::Whole(..), value) => {
                (!value.as_u64().is_some_and(|value| range.contains_whole(value))).then(|| written(value))
            }
            (Range::Band(..), Value::Array(ends)) => {
                let ends: Vec<u64> = ends.iter().filter_map(Value::as_u64).collect();
                let is_allowed = ends.is_sorted() && ends.iter().all(|end| range.contains_whole(*end));
                (!is_allowed).then(|| format!("({}, {})", ends[0], ends[1]))
            }
            (Range::List { least, most, .. }, Value::Array(list))
                if !(*least..=*most).contains(&list.len()) =>
            {
                Some(if list.is_empty() { "[]".to_owned() } else { format!("a list of {}", list.len()) })
            }
            _ => None,
        };
        let texts: Vec<String> = match (range, value) {
            (Range::Text { .. }, Value::String(text)) => vec![text.clone()],
            (Range::List { .. }, Value::Array(list)) if field.variant.is_some() => {
                list.iter().filter_map(|text| text.as_str().map(str::to_owned)).collect()
            }
            _ => Vec::new(),
        };
        if let Some(value) = wrong {
            self.refuse_value(field.path, value, &field.allowed(), field.name, &[]);
        }
        for text in texts {
            self.check_text(field, &text);
        }
        if field.path == "loading" {
            self.check_targets();
        }
    }

    fn check_text(&mut self, field: &Field, text: &str) {
        let range = if let Range::Text { .. } = field.range { field.range } else { FILE_NAME };
        let Range::Text { least, most, lines } = range else { return };
        // Control characters would reach the terminal of any reader of the scene.
        let forbidden = |c: &char| is_control(*c) && !(lines && *c == '\n');
        let count = text.chars().count();
        let (value, allowed) = match text.chars().find(forbidden) {
            Some(c) if lines => (format!("text with {c:?}"), "no control characters but line breaks".into()),
            Some(c) => (format!("text with {c:?}"), "no control characters".into()),
            None if count > most => (format!("{count} characters"), field.allowed()),
            None if count < least => (ron_string(text), field.allowed()),
            None => return,
        };
        self.refuse_value(field.path, value, &allowed, field.name, &[]);
    }

    fn check_targets(&mut self) {
        let scene = self.scene;
        for (index, stage) in scene.loading.iter().enumerate() {
            if let Some((field, value)) = stage.field()
                && !field.range.contains(value)
            {
                let path = format!("loading.{index}.0");
                self.refuse_value(&path, ron_float(value), &field.allowed(), field.name, &[]);
            }
        }
    }

    fn check_material(&mut self) {
        let material = self.scene.material;
        let given = [material.effective_modulus, material.youngs_modulus, material.poisson_ratio];
        let reason = match given.map(|value| value.is_some()) {
            [true, false, false] => return,
            [false, true, true] => return self.check_effective_modulus(material.effective_modulus()),
            [true, ..] => {
                "effective_modulus replaces youngs_modulus and poisson_ratio: give one or the other"
            }
            [false, true, false] => "youngs_modulus goes with poisson_ratio, which is missing",
            [false, false, true] => "poisson_ratio goes with youngs_modulus, which is missing",
            [false, false, false] => "give youngs_modulus with poisson_ratio, or effective_modulus",
        };
        let involves = &["material.effective_modulus", "material.youngs_modulus", "material.poisson_ratio"];
        self.refuse("material", "", reason, involves);
    }

    fn check_effective_modulus(&mut self, modulus: f64) {
        let Some(field) = field("material.effective_modulus", None) else { return };
        if !self.has("material") && !field.range.contains(modulus) {
            let value = format!("E* = {}", ron_float(modulus));
            let involves = &["material.youngs_modulus", "material.poisson_ratio"];
            self.refuse_value("material", value, &field.allowed(), "effective modulus E/(1 − ν²)", involves);
        }
    }

    fn check_form(&mut self) {
        let scene = self.scene;
        let Some(form) = scene.form.filter(|_| !self.has("form") && !self.has("length")) else { return };
        if let Some(radius) = form.flat_end() {
            return self.check_flat_end(radius);
        }
        let shortest = SPRINGS_PER_WAVE as f64 * scene.spacing();
        if let Form::WavySphere { wavelength, .. } = form
            && !self.has("numerics.points")
            && wavelength < shortest
        {
            let reason =
                format!("a wave has at least {SPRINGS_PER_WAVE} springs: more points or longer waves");
            let allowed = format!("at least {} m", ron_float(shortest));
            return self.refuse("form.wavelength", &allowed, &reason, &["numerics.points", "length"]);
        }
        let (depth, of_waves) = (form.depth(scene.length / 2.0), form.wave_depth(scene.length / 2.0));
        if !LEG_INDENTATION.range.contains(MOST_GROWTH * depth) {
            let most = LEG_INDENTATION.range.ends().map_or(0.0, |(_, most)| most);
            let reason = format!(
                "the body rises too steeply: at the ends of the line it is higher than the {most} m an indentation \
                 can reach"
            );
            // The first number of a form is its size; waves may be higher than their sphere.
            let is_size = |field: &&Field| match 2.0 * of_waves > depth {
                true => field.path == "form.amplitude",
                false => field.parent() == "form" && self.tree.has(field),
            };
            let size = FIELDS.iter().find(is_size).map_or("form", |field| field.path);
            self.refuse(size, "", &reason, &["form", "form.exponent", "form.amplitude", "length"]);
        }
    }

    fn check_flat_end(&mut self, radius: f64) {
        let (half, spacing) = (self.scene.length / 2.0, self.scene.spacing());
        if radius > half {
            let reason =
                format!("a punch is not wider than the line: at most length/2 = {}", ron_float(half));
            self.refuse("form.radius", "", &reason, &["length"]);
        } else if !self.has("numerics.points") && self.scene.springs_under_body().is_empty() {
            let reason = format!(
                "no spring lies under the punch: the springs are {} m apart; more points or a larger radius",
                ron_float(spacing)
            );
            self.refuse("form.radius", "", &reason, &["length", "numerics.points"]);
        }
    }

    fn check_modes(&mut self) {
        let points = self.scene.numerics.points;
        if let Some(Roughness::SelfAffine { modes: (_, last), .. }) = self.scene.roughness
            && last > points / 2
            && !self.has("roughness.modes")
            && !self.has("numerics.points")
        {
            let allowed = format!("last mode at most points/2 = {}", points / 2);
            let reason = format!("{points} springs carry no shorter wave");
            self.refuse("roughness.modes", &allowed, &reason, &["numerics.points"]);
        }
    }

    /// A profile is one row or one column; several files have a common spectrum and no profile.
    fn check_measured(&mut self) {
        let Some(Roughness::Measured { unit, height_unit, further_files, opposite, row, column, .. }) =
            &self.scene.roughness
        else {
            return;
        };
        for (path, unit) in [("roughness.unit", unit), ("roughness.height_unit", height_unit)] {
            if !unit.is_empty() && !self.has(path) && unit.parse::<Unit>().is_err() {
                self.refuse(path, UnitError::ALLOWED, "unit of the file", &[]);
            }
        }
        if row.is_some() && column.is_some() {
            let reason = "a profile is a row or a column: give one of them";
            self.refuse("roughness.column", "", reason, &["roughness.row"]);
        }
        if opposite.is_some() && self.scene.measured_as_line() {
            let reason = "spectra of two faces add, their profiles do not: give as_line: false";
            self.refuse("roughness.opposite", "", reason, &["roughness.as_line", "version"]);
        }
        if !further_files.is_empty() && self.scene.measured_as_line() {
            let reason = "several files have one spectrum, and no profile: give as_line: false";
            self.refuse("roughness.further_files", "", reason, &["roughness.as_line", "version"]);
        }
    }

    /// A spring that attaches with more energy than it detaches with would detach at once.
    fn check_closing_work(&mut self) {
        let Some(Adhesion { work, closing_work: Some(closing), .. }) = self.scene.adhesion else { return };
        let (allowed, reason) = match work {
            _ if self.has("adhesion") => return,
            Some(work) if closing > work => {
                (format!("0 to {} J/m²", ron_float(work)), "at most adhesion.work")
            }
            Some(_) => return,
            None => (
                String::new(),
                "closing_work goes with adhesion.work, which is missing: κ and e_el/γ refer to one work of adhesion",
            ),
        };
        self.refuse("adhesion.closing_work", &allowed, reason, &["adhesion.work"]);
    }

    /// Amplitude of the roughness, work of adhesion and κ or e_el/γ: any two determine the third.
    fn check_amplitude(&mut self) {
        let adhesion = self.scene.adhesion.unwrap_or_default();
        let given =
            [adhesion.work, adhesion.kappa, adhesion.elastic_energy_ratio].map(|value| value.is_some());
        let by_adhesion = &AMPLITUDE[3..];
        match given {
            [false, false, false] if self.scene.adhesion.is_some() => {
                return self.refuse("adhesion", "", "give work, kappa or elastic_energy_ratio", by_adhesion);
            }
            [_, true, true] => {
                let reason = "kappa and elastic_energy_ratio determine each other: give one of them";
                return self.refuse("adhesion", "", reason, by_adhesion);
            }
            _ => {}
        }
        let parameter = adhesion.parameter().map(|(parameter, _)| parameter);
        let Some(roughness) = &self.scene.roughness else {
            if let Some(parameter) = parameter {
                let reason = format!(
                    "{} measures adhesion against roughness, and there is none: give roughness, or adhesion by work",
                    parameter.symbol()
                );
                let involves = &["roughness", "adhesion"];
                self.refuse_value(parameter.path(), String::new(), "", &reason, involves);
            }
            return;
        };
        if let Roughness::SelfAffine { rms_height: Some(_), rms_gradient: Some(_), .. } = roughness {
            let reason = "rms_height and rms_gradient determine each other: give one of them";
            return self.refuse("roughness", "", reason, &AMPLITUDE[1..3]);
        }
        let (path, reason) = match (roughness.has_amplitude(), adhesion.work, parameter) {
            (true, Some(_), Some(parameter)) => {
                let name = parameter.name();
                let end = "two determine the third, so leave one out or set it to None";
                ("adhesion", format!("roughness amplitude, work and {name}: {end}"))
            }
            (false, Some(0.0), Some(parameter)) => {
                let (symbol, end) = (parameter.symbol(), "give rms_height or rms_gradient");
                ("roughness", format!("without work of adhesion {symbol} does not set an amplitude: {end}"))
            }
            (false, Some(_), Some(_)) | (true, ..) => return,
            (false, ..) => {
                let end = "give rms_height or rms_gradient, or adhesion by work and kappa";
                ("roughness", format!("the amplitude is missing: {end}"))
            }
        };
        self.refuse(path, "", &reason, AMPLITUDE);
    }

    fn check_loading(&mut self) {
        let (scene, mut is_separated) = (self.scene, true);
        for (index, stage) in scene.loading.iter().enumerate() {
            let pulls = *stage == Move::ToSeparation || matches!(stage, Move::ToForce(force) if *force < 0.0);
            if is_separated && pulls {
                let reason =
                    "from separation nothing can pull: press first, with ToTouch, ToForce or ToIndentation";
                self.refuse_value(&format!("loading.{index}"), in_ron(stage), "", reason, &["loading"]);
            }
            is_separated = *stage == Move::ToSeparation;
        }
        let stages = scene.loading.len() as u64;
        let is_too_fine = stages.saturating_mul(scene.numerics.samples) > MOST_SAMPLES;
        if is_too_fine && !self.has("numerics.samples") && !self.has("loading") {
            let allowed = format!("at most {}", MOST_SAMPLES / stages.max(1));
            let reason = format!("{stages} legs have at most {MOST_SAMPLES} samples together");
            self.refuse("numerics.samples", &allowed, &reason, &["loading"]);
        }
    }

    fn check_edges(&mut self) {
        let numerics = self.scene.numerics;
        if matches!(numerics.solver, Solver::Stepwise { .. }) && numerics.edges == Edges::SubCell {
            let reason = "the stepwise solver moves whole springs: edges: Grid";
            self.refuse("numerics.edges", "", reason, &["numerics.solver"]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::RoughnessParameter;
    use super::super::model::Material;
    use super::super::strategies::sound;
    use super::*;

    fn only(scene: &Scene) -> (String, String) {
        let errors = check(scene);
        assert_eq!(errors.len(), 1, "{errors:?}");
        (errors[0].field.clone(), errors[0].message.clone())
    }

    #[test]
    fn a_material_is_determined_once() {
        for (effective_modulus, youngs_modulus, poisson_ratio, said) in [
            (Some(1e6), Some(1e6), Some(0.5), "one or the other"),
            (Some(1e6), Some(1e6), None, "one or the other"),
            (Some(1e6), None, Some(0.5), "one or the other"),
            (None, Some(1e6), None, "poisson_ratio, which is missing"),
            (None, None, Some(0.5), "youngs_modulus, which is missing"),
            (None, None, None, "give youngs_modulus with poisson_ratio, or"),
        ] {
            let mut scene = sound();
            scene.material = Material { youngs_modulus, poisson_ratio, effective_modulus };
            let (field, reason) = only(&scene);
            assert_eq!(field, "material");
            assert!(reason.contains(said), "{reason}");
        }
    }

    #[test]
    fn the_effective_modulus_is_in_its_range_too() {
        let material = |poisson_ratio| Material {
            youngs_modulus: Some(1e6),
            poisson_ratio: Some(poisson_ratio),
            effective_modulus: None,
        };
        let mut scene = sound();
        // Nearly −1: E* is enormous, though E and ν are in their ranges.
        scene.material = material(-1.0 + 1e-9);
        assert_eq!(only(&scene).0, "material");
        scene.material = material(-1.0 + 1e-6);
        assert_eq!(check(&scene), vec![]);
    }

    #[test]
    fn amplitude_work_and_kappa_determine_each_other() {
        let set = |height: bool, gradient: bool, adhesion: Option<(Option<f64>, Option<f64>)>| {
            let mut scene = sound();
            if let Some(Roughness::SelfAffine { rms_height, rms_gradient, .. }) = &mut scene.roughness {
                *rms_height = height.then_some(1e-7);
                *rms_gradient = gradient.then_some(0.1);
            }
            scene.adhesion = adhesion.map(|(work, kappa)| Adhesion {
                work,
                ..kappa.map_or_else(Adhesion::default, |kappa| Adhesion::default().with_kappa(kappa))
            });
            scene
        };
        let (work, kappa) = (Some(0.05), Some(2.0));
        for sound in [
            set(true, false, None),
            set(false, true, Some((work, None))),
            set(true, false, Some((Some(0.0), None))),
            set(true, false, Some((None, kappa))),
            set(false, false, Some((work, kappa))),
        ] {
            assert_eq!(check(&sound), vec![]);
        }
        for (scene, field, said) in [
            (set(true, true, None), "roughness", "determine each other"),
            (set(true, true, Some((work, kappa))), "roughness", "determine each other"),
            (set(true, false, Some((work, kappa))), "adhesion", "determine the third"),
            (set(false, false, None), "roughness", "the amplitude is missing"),
            (set(false, false, Some((work, None))), "roughness", "the amplitude is missing"),
            (set(false, false, Some((None, kappa))), "roughness", "the amplitude is missing"),
            (set(false, false, Some((Some(0.0), kappa))), "roughness", "does not set an amplitude"),
            (set(true, false, Some((None, None))), "adhesion", "give work, kappa or elastic_energy_ratio"),
        ] {
            let (path, reason) = only(&scene);
            assert_eq!(path, field);
            assert!(reason.contains(said), "{reason}");
        }
    }

    #[test]
    fn the_work_of_closing_is_at_most_that_of_opening() {
        let mut scene = sound();
        for (work, closing, said) in [
            (Some(0.05), 0.0, None),
            (Some(0.05), 0.05, None),
            (Some(0.0), 0.0, None),
            (Some(0.05), 0.050_000_1, Some("at most adhesion.work")),
            (Some(0.0), 1e-9, Some("at most adhesion.work")),
            (None, 0.0, Some("goes with adhesion.work")),
        ] {
            let kappa = work.is_none().then_some(2.0);
            scene.adhesion =
                Some(Adhesion { work, closing_work: Some(closing), kappa, ..Adhesion::default() });
            match said {
                None => assert_eq!(check(&scene), vec![]),
                Some(said) => {
                    let (path, reason) = only(&scene);
                    assert_eq!(path, "adhesion.closing_work");
                    assert!(reason.contains(said), "{reason}");
                }
            }
        }
        for closing in [-1e-3, f64::NAN, 2e6] {
            scene.adhesion =
                Some(Adhesion { closing_work: Some(closing), ..Adhesion::default().with_work(0.05) });
            assert!(check(&scene).iter().all(|found| found.field == "adhesion.closing_work"));
            assert!(!check(&scene).is_empty());
        }
    }

    #[test]
    fn parameters_of_roughness_need_roughness_and_exclude_each_other() {
        let smooth = Scene { roughness: None, ..sound() };
        assert_eq!(check(&smooth), vec![]);
        let measured = Scene { roughness: Some(Roughness::measured("line.csv")), ..sound() };
        for parameter in RoughnessParameter::ALL {
            let given = Adhesion::default().with_parameter(parameter, 2.0);
            let with = |scene: &Scene, adhesion| Scene { adhesion: Some(adhesion), ..scene.clone() };
            let (field, reason) = only(&with(&smooth, given));
            assert_eq!(field, parameter.path());
            assert!(reason.starts_with(parameter.symbol()), "{reason}");
            assert_eq!(check(&with(&measured, given)), vec![]);
            let (field, reason) = only(&with(&measured, Adhesion { work: Some(0.05), ..given }));
            assert_eq!(field, "adhesion");
            assert!(reason.contains(parameter.name()), "{reason}");
            let both = Adhesion { kappa: Some(2.0), elastic_energy_ratio: Some(1.0), ..given };
            for scene in [&smooth, &measured] {
                let (field, reason) = only(&with(scene, both));
                assert_eq!(field, "adhesion");
                assert!(reason.contains("give one of them"), "{reason}");
            }
        }
    }

    #[test]
    fn no_wave_is_shorter_than_two_springs() {
        let mut scene = sound();
        for (points, sound) in [(1024, true), (1025, true), (1023, false), (1, false)] {
            scene.numerics.points = points;
            assert_eq!(check(&scene).is_empty(), sound, "{points}");
        }
        scene.numerics.points = 64;
        let errors = check(&scene);
        assert_eq!(errors[0].allowed, "last mode at most points/2 = 32");
        assert_eq!(errors[0].value, "(1, 512)");
    }

    #[test]
    fn a_punch_is_on_the_line_and_over_a_spring() {
        let mut scene = sound();
        scene.roughness = None;
        for points in [1, 2, 3, 4096, 4097] {
            scene.numerics.points = points;
            let spacing = scene.spacing();
            // Below a quarter of the spacing the diameter is nearer to no cell than to one.
            for (radius, sound) in
                [(5e-5, true), (5.1e-5, false), (0.26 * spacing, true), (0.24 * spacing, false)]
            {
                scene.form = Some(Form::Punch { radius });
                assert_eq!(check(&scene).is_empty(), sound, "{radius} on {points} points");
            }
        }
    }

    #[test]
    fn a_body_does_not_rise_beyond_all_indentations() {
        let mut scene = sound();
        scene.length = 10.0;
        for form in [
            Form::Paraboloid { radius: 1e-300 },
            Form::Cone { angle: std::f64::consts::FRAC_PI_2 - 1e-9 },
            Form::Power { coefficient: 1e300, exponent: 100.0 },
        ] {
            scene.form = Some(form);
            assert!(only(&scene).1.contains("rises too steeply"));
        }
        // The message names the waves if they cause the height.
        scene.length = 1.0;
        for (radius, amplitude, field) in [(1.0, 1e6, "form.amplitude"), (1e-6, 1e-9, "form.radius")] {
            scene.form = Some(Form::WavySphere { radius, amplitude, wavelength: 0.1 });
            let (named, reason) = only(&scene);
            assert!(named == field && reason.contains("rises too steeply"), "{named}: {reason}");
        }
    }

    #[test]
    fn nothing_is_pulled_that_does_not_touch() {
        use Move::*;
        let mut scene = sound();
        for (loading, field) in [
            (vec![ToSeparation], "loading.0"),
            (vec![ToForce(-1e-6)], "loading.0"),
            (vec![ToTouch, ToSeparation, ToForce(-1.0)], "loading.2"),
            (vec![ToTouch, ToSeparation, ToSeparation], "loading.2"),
        ] {
            scene.loading = loading;
            assert_eq!(only(&scene).0, field);
        }
        // A zero force does not pull.
        scene.loading = vec![ToForce(1.0), ToForce(-1e-6), ToTouch, ToSeparation, ToForce(0.0), ToZeroForce];
        assert_eq!(check(&scene), vec![]);
    }

    #[test]
    fn samples_of_all_legs_are_bounded_together() {
        let mut scene = sound();
        scene.loading = vec![Move::ToTouch; 1 << 14];
        scene.numerics.samples = 1 << 10;
        assert_eq!(check(&scene), vec![]);
        scene.numerics.samples += 1;
        assert_eq!(only(&scene).0, "numerics.samples");
    }

    fn fields_of(scene: &Scene) -> Vec<String> {
        check(scene).into_iter().map(|error| error.field).collect()
    }

    #[test]
    fn a_sound_scene_has_no_errors() {
        assert_eq!(check(&sound()), vec![]);
    }

    #[test]
    fn all_errors_are_found_together() {
        let mut scene = sound();
        scene.version = 3;
        scene.length = -1.0;
        scene.material.poisson_ratio = Some(0.7);
        scene.numerics.samples = 1;
        scene.loading = vec![];
        assert_eq!(
            fields_of(&scene),
            ["version", "material.poisson_ratio", "length", "loading", "numerics.samples"]
        );
    }

    #[test]
    fn an_error_states_the_value_and_the_allowed_range() {
        let mut scene = sound();
        scene.length = 20.0;
        assert_eq!(
            check(&scene),
            [SceneError {
                field: "length".into(),
                value: "20.0".into(),
                allowed: "from 1e-9 to 10 m".into(),
                message: "apparent diameter".into(),
                ..SceneError::default()
            }]
        );
    }

    #[test]
    fn nan_and_infinities_are_refused_everywhere() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut scene = sound();
            scene.length = value;
            assert_eq!(fields_of(&scene), ["length"], "{value}");
            let mut scene = sound();
            scene.material =
                Material { youngs_modulus: None, poisson_ratio: None, effective_modulus: Some(value) };
            assert_eq!(fields_of(&scene), ["material.effective_modulus"], "{value}");
            let mut scene = sound();
            scene.adhesion = Some(Adhesion::default().with_work(value));
            assert_eq!(fields_of(&scene), ["adhesion.work"], "{value}");
            let mut scene = sound();
            scene.loading = vec![Move::ToForce(1.0), Move::ToIndentation(value), Move::ToForce(value)];
            assert_eq!(fields_of(&scene), ["loading.1.0", "loading.2.0"], "{value}");
            let mut scene = sound();
            scene.numerics.solver = Solver::Stepwise { step: value };
            assert_eq!(fields_of(&scene), ["numerics.solver.step"], "{value}");
            for form in [
                Form::Paraboloid { radius: value },
                Form::Cone { angle: value },
                Form::Power { coefficient: value, exponent: 2.0 },
                Form::Power { coefficient: 1.0, exponent: value },
                Form::Punch { radius: value },
            ] {
                let mut scene = sound();
                scene.form = Some(form);
                assert_eq!(fields_of(&scene).len(), 1, "{form:?}");
            }
        }
    }

    #[test]
    fn sizes_from_nanometres_to_metres_are_allowed() {
        for length in [1e-9, 1e-6, 1.0, 10.0] {
            for height in [1e-15, 1.0, 10.0] {
                let mut scene = sound();
                scene.length = length;
                if let Some(Roughness::SelfAffine { rms_height, .. }) = &mut scene.roughness {
                    *rms_height = Some(height * length);
                }
                assert_eq!(check(&scene), vec![]);
            }
        }
    }

    #[test]
    fn modes_are_a_band() {
        for (modes, sound) in [((1, 1), true), ((4, 512), true), ((5, 4), false), ((0, 4), false)] {
            let mut scene = sound_scene_with(modes);
            assert_eq!(check(&scene).is_empty(), sound, "{modes:?}");
            scene.numerics.points = 1 << 28;
            assert_eq!(check(&scene).is_empty(), sound, "{modes:?}");
        }
        let scene = sound_scene_with((1, u64::MAX));
        assert_eq!(fields_of(&scene), ["roughness.modes"]);
    }

    fn sound_scene_with(band: (u64, u64)) -> Scene {
        let mut scene = sound();
        if let Some(Roughness::SelfAffine { modes, .. }) = &mut scene.roughness {
            *modes = band;
        }
        scene
    }

    #[test]
    fn control_characters_do_not_reach_the_screen() {
        let mut scene = sound();
        scene.title = "one\ntwo".into();
        scene.notice = "one\ntwo".into();
        assert_eq!(fields_of(&scene), ["title"]);
        scene.title = "one".into();
        scene.notice = "\u{1b}[2J".into();
        assert_eq!(fields_of(&scene), ["notice"]);
    }
}
