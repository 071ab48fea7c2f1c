//! Test: a probe with two contacts is found from its curve.

use crate::common::{fit_from, gauss, sampled};
use asperity_data::Control;
use asperity_experiment::{CurveOptions, Fit, FitResult, MeasuredCurve, Parameter};
use asperity_scene::{Document, open, run};

/// Stiffness of the instrument, N/m.
const STIFFNESS: f64 = 3.0;

/// The probe of a series of measured curves.
#[derive(Clone, Copy, Debug)]
struct Probe {
    work: f64,
    closing_work: f64,
    modulus: f64,
    radius: f64,
    second_radius: f64,
    behind: f64,
}

const PROBE: Probe = Probe {
    work: 0.017,
    closing_work: 0.010,
    modulus: 8e5,
    radius: 5.4e-6,
    second_radius: 3.2e-6,
    behind: 2e-7,
};

impl Probe {
    fn document(self, points: u64, samples: u64) -> Document {
        let Probe {
            work,
            closing_work,
            modulus,
            radius,
            second_radius,
            behind,
        } = self;
        let changes = [
            ("material", format!("(effective_modulus: {modulus:e})")),
            ("adhesion", format!("(work: {work:e}, closing_work: {closing_work:e})")),
            (
                "form",
                format!("TwoSpheres(radius: {radius:e}, second_radius: {second_radius:e}, behind: {behind:e})"),
            ),
            ("loading_stiffness", format!("{STIFFNESS:e}")),
            ("numerics.points", points.to_string()),
            ("numerics.samples", samples.to_string()),
        ];
        let changes = changes.map(|(path, value)| (path.to_owned(), value));
        open("two-spheres").unwrap().set_all(&changes).unwrap()
    }

    /// The curve of this probe by the engine on a finer grid, with noise and an offset.
    fn curve(self, noise: f64, seed: u64) -> MeasuredCurve {
        let legs = run(&self.document(6000, 1 << 16)).unwrap().history.legs;
        let top = legs[0].curve.last().unwrap();
        let top = top.indentation + top.force / STIFFNESS;
        let points = sampled(&legs, STIFFNESS, -1.2 * top, top, 500);
        let mut displacements = Vec::new();
        let mut forces = Vec::new();
        for ((displacement, force), noise) in points.into_iter().zip(gauss(noise, seed)) {
            displacements.push(displacement + 3e-7);
            forces.push(force + noise);
        }
        MeasuredCurve::from_columns(&displacements, &forces, &CurveOptions::default()).unwrap()
    }

    fn truth(self, parameter: Parameter) -> f64 {
        match parameter {
            Parameter::Work => self.work,
            Parameter::ClosingWork => self.closing_work,
            Parameter::Modulus => self.modulus,
            Parameter::Radius => self.radius,
            Parameter::SecondRadius => self.second_radius,
            Parameter::Behind => self.behind,
            Parameter::Offset => 3e-7,
            _ => 0.0,
        }
    }
}

fn print(fit: &FitResult, probe: Probe) {
    for found in &fit.parameters {
        let truth = probe.truth(found.parameter);
        println!(
            "{:?} {:e} ({:e} to {:e}) truth {truth:e} start {:e} {:+.4}",
            found.parameter,
            found.value,
            found.interval.0,
            found.interval.1,
            found.start,
            found.value / truth - 1.0
        );
    }
    println!("misfit {} {:?} {}", fit.misfit, fit.reason, fit.evaluations);
}

#[test]
fn both_spheres_are_found_from_the_curve_alone() {
    let curve = PROBE.curve(5e-10, 1);
    println!("{:?} noise {:e}", curve.features, curve.noise);
    let start = Probe { work: 0.05, closing_work: 0.05, modulus: 2e6, second_radius: 5.4e-6, behind: 0.0, ..PROBE };
    let free = "work,closing_work,modulus,offset,second_radius,behind";
    let begun = std::time::Instant::now();
    let fit = fit_from(&curve, &start.document(2048, 512), free);
    println!("{:?}", begun.elapsed());
    print(&fit, PROBE);
    panic!();
}

#[test]
fn dbg_probes() {
    for (index, (radius, second_radius, behind, closing_work, noise, free)) in [
        (3e-6, 6e-6, 1e-7, 0.010, 5e-10, "work,closing_work,modulus,offset,second_radius,behind"),
        (5e-6, 5e-6, 5e-8, 0.017, 5e-10, "work,modulus,offset,second_radius,behind"),
        (5e-6, 2e-6, 3.5e-7, 0.010, 2e-9, "work,closing_work,modulus,offset,second_radius,behind"),
        (5.4e-6, 3.2e-6, 2e-7, 0.010, 5e-10, "work,closing_work,modulus,offset,radius,behind"),
        (5.4e-6, 3.2e-6, 2e-7, 0.010, 5e-10, "work,closing_work,modulus,offset,radius,second_radius,behind"),
        (5.4e-6, 3.2e-6, 2e-7, 0.010, 1e-8, "second_radius,behind"),
        (5.4e-6, 3.2e-6, 0.0, 0.010, 5e-10, "work,closing_work,modulus,offset,second_radius,behind"),
        (5.4e-6, 4.8e-6, 2e-8, 0.010, 2e-9, "work,closing_work,modulus,offset,second_radius,behind"),
    ].into_iter().enumerate() {
        let probe = Probe { radius, second_radius, behind, closing_work, ..PROBE };
        let curve = probe.curve(noise, index as u64);
        println!("{probe:?} {noise:e} {:?}", curve.features);
        let has = |name: &str| free.split(',').any(|one| one == name);
        let mut start = probe;
        if has("work") { start.work = 0.05; start.closing_work = 0.05; }
        if has("modulus") { start.modulus = 2e6; }
        if has("radius") { start.radius = 4e-6; }
        if has("second_radius") { start.second_radius = start.radius; }
        if has("behind") { start.behind = 0.0; }
        let fit = fit_from(&curve, &start.document(2048, 512), free);
        print(&fit, probe);
        println!("{:?}", fit.not_distinguished);
    }
}

#[test]
fn dbg_cost() {
    for (index, radius, second_radius, behind, noise) in [(6, 5.4e-6, 3.2e-6, 0.0, 5e-10), (7, 5.4e-6, 4.8e-6, 2e-8, 2e-9), (1, 5e-6, 5e-6, 5e-8, 5e-10)] {
        let closing_work = if index == 1 { 0.017 } else { 0.01 };
        let probe = Probe { radius, second_radius, behind, closing_work, ..PROBE };
        let curve = probe.curve(noise, index as u64);
        for points in [2048, 6000] {
        for free in ["offset", "work=16mJ/m2..18mJ/m2,modulus=0.7MPa..0.9MPa,offset,second_radius=2um..6um,behind=0..100nm"] {
            let fit = fit_from(&curve, &probe.document(points, 512), free);
            println!("{points} {free}");
            print(&fit, probe);
            println!("residual {}", fit.residual_over_noise);
        }}
    }
}
