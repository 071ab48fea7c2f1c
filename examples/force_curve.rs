//! Fit of a force curve: the work of adhesion and the modulus of a sphere from displacements and
//! forces with noise.
//!
//! `cargo run --release --example force_curve`

use asperity::data::Control;
use asperity::experiment::{CurveOptions, Fit, MeasuredCurve, Parameter};
use asperity::scene::instrument::displacements;
use asperity::scene::{open, run};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // In place of a measurement: the curve of a sphere on a spring of 20 N/m, with noise of 50 nN.
    let set = |path: &str, value: &str| (path.to_owned(), value.to_owned());
    let scene = open("jkr-sphere")?.set_all(&[
        set("loading_stiffness", "20"),
        set("numerics.points", "1024"),
    ])?;
    let stages = run(&scene)?.history.stages;
    let points = stages
        .iter()
        .flat_map(|stage| displacements(stage, 20.0).zip(stage.curve.iter().map(|at| at.force)));
    let before = (0..200).map(|index| (5.0e-9 * f64::from(index - 200), 0.0));
    let mut points: Vec<(f64, f64)> = before.chain(points).collect();
    points.dedup_by_key(|(displacement, _)| *displacement); // of a jump only its begin
    let (displacement, mut force): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
    for (index, force) in force.iter_mut().enumerate() {
        *force += 5.0e-8 * (12.9 * index as f64).sin() * std::f64::consts::SQRT_2;
    }
    let curve = MeasuredCurve::from_columns(&displacement, &force, &CurveOptions::default())?;
    let start = scene.set_all(&[
        set("adhesion.work", "0.02"),
        set("material.youngs_modulus", "4e6"),
    ])?;
    let free = [Parameter::Work, Parameter::Modulus, Parameter::Offset];
    let fit = free
        .into_iter()
        .fold(Fit::of(&start), Fit::free)
        .run(&curve, Control::default())?;
    for one in &fit.parameters {
        let (name, unit) = (one.parameter.name(), one.parameter.row().unit);
        println!(
            "{name}: {:.4e} {unit}, 95 % interval {:.4e} to {:.4e}",
            one.value, one.interval.0, one.interval.1
        );
    }
    println!("residual over noise {:.2}", fit.residual_over_noise);
    assert!(fit.describes() && (fit.parameters[0].value / 0.05 - 1.0).abs() < 0.02);
    Ok(())
}
