//! Forces reached exactly where the contact jumps.

use super::*;

proptest! {
    #![proptest_config(cases(300))]

    /// One spring carries just the wanted force where a second one attaches, stretched by s, and reduces the force
    /// accordingly: both carry it half of s deeper than the second one touches by itself, less half of the first one's
    /// depth.
    #[test]
    fn a_force_lost_as_it_is_reached_is_met_further_on(wall in 0.25..1.0_f64, share in 0.05..0.9_f64, first: bool) {
        // E* Δx = 1 N/m: force and compression are the same number.
        let foundation = Foundation::endless(0.25, 4.0);
        let work = (share * wall).powi(2) * 4.0 / (0.25 * std::f64::consts::PI);
        let gaps = if first { vec![0.0, wall] } else { vec![wall, 0.0] };
        let rule = HessRule::new(foundation, work);
        let attaches = wall - rule.largest_stretch(1);
        let expected = 0.5 * (attaches + wall);
        let mut body = adhesive(&gaps, Edges::Grid, rule, foundation, 5);
        let record = body.advance(Move::ToForce(attaches)).unwrap();
        prop_assert!((record.end() - expected).abs() < 4.0 * f64::EPSILON, "{} {}", record.end(), expected);
    }

    /// The smallest force of an unloading is reached except for its rounding, and no smaller one.
    #[test]
    fn the_smallest_force_is_reached_and_none_below(body in body(), deep in 0.2..1.2_f64) {
        let foundation = Foundation::endless(0.25, 4.0);
        let body = Body { foundation, work: body.work / body.foundation.effective_modulus * 0.1, ..body };
        let turned = || {
            let mut solver = body.on(9);
            solver.advance(Move::ToIndentation(deep)).unwrap();
            solver
        };
        let smallest = turned().advance(Move::ToSeparation).unwrap().smallest;
        prop_assume!(smallest.springs > 0 && smallest.force < 0.0);
        let rounding = 1e-14 * body.force_scale();
        let reached = turned().advance(Move::ToForce(smallest.force + rounding)).unwrap();
        prop_assert!(reached.end() >= smallest.indentation);
        prop_assert!((reached.curve.last().unwrap().force - smallest.force).abs() <= 2.0 * rounding);
        prop_assert!(turned().advance(Move::ToForce(smallest.force - rounding)).is_err());
    }
}
