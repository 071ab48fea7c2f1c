//! Approximate JKR solution of a scene, from its contact without adhesion.

use super::{RunError, Simulation};
use crate::analysis::ApproximateJkr;
use crate::contact::{ContactError, History, nonadhesive_curve};
use crate::scene::Scene;

/// Number of contacts without adhesion for the curve.
const POINTS: usize = 256;
/// Bisections for the largest contact.
const BISECTIONS: usize = 40;

impl Simulation {
    /// Approximate JKR solution of a checked scene, up to the largest contact length of its computed loading. Of
    /// two works of adhesion, that of opening is used.
    ///
    /// # Errors
    /// [`RunError::NoApproximateJkr`] without adhesion, contact or growth of the contact; a failure of the profile,
    /// insufficient memory or a stop.
    pub fn approximate_jkr(
        &mut self,
        scene: &Scene,
        history: &History,
        stop: &dyn Fn() -> bool,
    ) -> Result<ApproximateJkr, RunError> {
        let lengths = history.legs.iter().flat_map(|leg| &leg.curve).map(|point| point.contact_length);
        let longest = lengths.reduce(f64::max).filter(|&length| length > 0.0);
        let longest = longest.ok_or(none("the loading has no contact; allowed: a stage that presses"))?;
        let (line, _, governing) = self.make_line(scene)?;
        let work = governing.adhesive_work();
        let work = work.ok_or(none("nothing attracts; allowed: a work of adhesion above 0 J/m²"))?;
        let (foundation, edges) = (governing.foundation(line), scene.numerics.edges);
        let contact = |indentations: &[f64]| {
            if stop() {
                Err(ContactError::Interrupted)
            } else {
                nonadhesive_curve(&line.gaps, edges, foundation, indentations)
            }
        };
        let (mut low, mut high) = (0.0, line.deepest());
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let is_short = contact(&[middle])?.iter().any(|point| point.contact_length < longest);
            (low, high) = if is_short { (middle, high) } else { (low, middle) };
        }
        // The contact of a sphere then grows evenly from point to point.
        let at = |index: usize| high * (index as f64 / POINTS as f64).powi(2);
        let mut points = Vec::with_capacity(POINTS + 1);
        for index in 0..=POINTS {
            points.extend(contact(&[at(index)])?);
        }
        let curve = ApproximateJkr::new(&points, governing.effective_modulus, work);
        if curve.points.is_empty() {
            return Err(none("the contact does not grow; allowed: bodies other than a smooth flat face"));
        }
        Ok(curve)
    }
}

fn none(why: &'static str) -> RunError {
    RunError::NoApproximateJkr { why }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::PowerLaw;
    use crate::scene::{Document, open};

    fn approximate(document: &Document) -> Result<ApproximateJkr, RunError> {
        let (mut simulation, scene) = (Simulation::default(), document.scene());
        let outcome = simulation.run(scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
        simulation.approximate_jkr(scene, &outcome.history, &|| false)
    }

    fn set(name: &str, fields: &[(&str, &str)]) -> Document {
        let fields: Vec<_> =
            fields.iter().map(|(path, value)| (path.to_string(), value.to_string())).collect();
        open(name).unwrap().set_all(&fields).unwrap()
    }

    #[test]
    fn bodies_of_revolution_have_their_closed_form() {
        let sphere = set("jkr-sphere", &[("numerics.points", "4097")]);
        for form in
            ["Paraboloid(radius: 1.0e-4)", "Cone(angle: 0.05)", "Power(coefficient: 1.0e9, exponent: 3.0)"]
        {
            let body = sphere.set("form", form).unwrap();
            let scene = body.scene();
            let (modulus, work) = (scene.material.effective_modulus(), scene.adhesion.unwrap().work.unwrap());
            let closed = PowerLaw::of(scene.form.as_ref().unwrap(), modulus, work).unwrap();
            let curve = approximate(&body).unwrap();
            assert!(curve.points.len() > 100, "{form}: {}", curve.points.len());
            let scale = -closed.force_controlled_pull_off().1;
            for point in curve.points.iter().filter(|point| point.nonadhesive.contact_length > 1e-6) {
                let radius = 0.5 * point.nonadhesive.contact_length;
                let force = closed.force(radius);
                assert!((point.force - force).abs() < 2e-3 * scale, "{form}: {point:?}, {force}");
                let indentation = closed.indentation(radius);
                let lift = point.nonadhesive.indentation - indentation;
                assert!((point.indentation - indentation).abs() < 2e-3 * lift, "{form}: {point:?}");
            }
            let found = curve.adhesion_force().unwrap();
            assert!((found / scale - 1.0).abs() < 1e-3, "{form}: {found} {scale}");
        }
    }

    #[test]
    fn many_patches_pull_no_more_than_the_loop() {
        // Adhesion of single patches, of merged ones, and of the whole profile.
        for (kappa, range) in [("20.0", 0.9..=1.0), ("6.0", 0.0..=0.5), ("1.5", 0.3..=1.0)] {
            let fields = [("numerics.points", "4096"), ("adhesion.kappa", kappa)];
            let rough = set("pressure-sensitive", &fields);
            let (mut simulation, scene) = (Simulation::default(), rough.scene());
            let outcome = simulation.run(scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
            let curve = simulation.approximate_jkr(scene, &outcome.history, &|| false).unwrap();
            let share = curve.adhesion_force().unwrap() / outcome.figures.adhesion_force.unwrap();
            assert!(range.contains(&share), "κ = {kappa}: {share}");
            let longest = outcome.history.legs[0].curve.last().unwrap().contact_length;
            let last = curve.points.last().unwrap().nonadhesive.contact_length;
            assert!(
                last <= longest * (1.0 + 1e-9) && last > 0.9 * longest,
                "κ = {kappa}: {last} of {longest}"
            );
        }
    }

    #[test]
    fn bodies_without_such_a_curve_are_named() {
        for (document, expected) in [
            (set("kendall-punch", &[]), "does not grow"),
            (set("jkr-sphere", &[("adhesion", "None")]), "nothing attracts"),
            (set("jkr-sphere", &[("loading", "[ToIndentation(-1e-9)]")]), "no contact"),
        ] {
            let error = approximate(&document).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("allowed: "), "{error}");
        }
        let stopped = {
            let (mut simulation, scene) = (Simulation::default(), set("jkr-sphere", &[]).scene().clone());
            let outcome = simulation.run(&scene, &|| false, &mut |_, _, _| Ok(())).unwrap();
            simulation.approximate_jkr(&scene, &outcome.history, &|| true)
        };
        assert!(stopped.unwrap_err().is_interruption());
    }
}
