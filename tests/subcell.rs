//! Edges between grid points: second order against closed forms.

use asperity::contact::subcell::{LevelSets, SubCell};
use asperity::contact::{ContactTree, Foundation, HessRule, History, LegRecord, run};
use asperity::scene::{Form, Leg};
use asperity::surface::Line;
use std::sync::Arc;

fn history(form: Form, length: f64, points: usize, work: f64, legs: &[Leg]) -> History {
    let line = Line::new(length, points, Some(&form), None, 0.0).unwrap();
    let foundation = Foundation { spacing: line.spacing, effective_modulus: 1.0 };
    let tree = Arc::new(ContactTree::build(&line.gaps).unwrap());
    let sets = Arc::new(LevelSets::new(tree, &line.gaps).unwrap());
    let hess = (work > 0.0).then(|| HessRule::new(foundation, work));
    let mut body = SubCell::new(&sets, hess, foundation, 512, Vec::new()).unwrap();
    run(&mut body, legs, |_, _| Ok(())).unwrap()
}

fn area(legs: &[LegRecord]) -> f64 {
    let points: Vec<_> = legs.iter().flat_map(|leg| &leg.curve).collect();
    points.windows(2).map(|p| 0.5 * (p[0].force + p[1].force) * (p[1].indentation - p[0].indentation)).sum()
}

#[test]
fn look() {
    let exact = 1.5 * std::f64::consts::PI;
    for points in [100, 300, 1000, 3000, 10_000] {
        let form = Form::Paraboloid { radius: 1.0 };
        let legs = [Leg::ToIndentation(1.5), Leg::ToSeparation];
        let history = history(form, 12.0, points, 1.0, &legs);
        let smallest = history.legs[1].smallest;
        let energy: f64 = history.legs.iter().map(|leg| leg.dissipated_energy).sum();
        println!(
            "{points}: F {} error {:.2e} at {} l {} energy {energy} area {}",
            smallest.force,
            -smallest.force / exact - 1.0,
            smallest.indentation,
            smallest.contact_length,
            area(&history.legs)
        );
    }
}
