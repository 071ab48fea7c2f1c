//! Checks of the curve and of the options that a caller passes to a fit.

use super::parameter::{Free, Parameter};
use super::{ExperimentError, MeasuredCurve, refused};
use crate::scene::{format_quantity, format_range};

/// Forces, N, and displacements, m, beyond those of any instrument.
const MOST: [f64; 2] = [1e9, 1e6];

/// Checks the values of a curve, which a caller may have changed.
pub(super) fn check_curve(curve: &MeasuredCurve) -> Result<(), ExperimentError> {
    let counts = [curve.displacement.len(), curve.segment.len()];
    if counts != [curve.force.len(); 2] || curve.free >= curve.force.len() {
        let fault = format!("{} forces, {counts:?} displacements and segments", curve.force.len());
        return refused(fault, "as many of each, and points after those before contact");
    }
    let quantities = [(&curve.force, "force", "N"), (&curve.displacement, "displacement", "m")];
    for ((values, name, unit), most) in quantities.into_iter().zip(MOST) {
        if let Some((index, value)) =
            values.iter().enumerate().find(|(_, value)| value.is_nan() || value.abs() > most)
        {
            let fault = format!("{name} of point {} = {}", index + 1, format_quantity(*value, unit));
            return refused(fault, format_range((-most, most), 1, unit));
        }
    }
    if !(curve.noise > 0.0 && curve.noise.is_finite()) {
        return refused(format!("noise = {}", format_quantity(curve.noise, "N")), "a force above 0");
    }
    Ok(())
}

/// Checks options that no command line has checked.
pub(super) fn check_options(free: &[Free], lines: u64, jobs: usize) -> Result<(), ExperimentError> {
    if free.is_empty() {
        let names = Parameter::ALL.map(Parameter::name).join(", ");
        return refused("no free parameter", format!("one or more of {names}"));
    }
    for (index, Free { parameter, range }) in free.iter().enumerate() {
        let name = parameter.name();
        if free[..index].iter().any(|other| other.parameter == *parameter) {
            return refused(format!("{name} is free twice"), "each parameter once");
        }
        if let Some((low, high)) = range.filter(|range| !parameter.allows(*range)) {
            return refused(format!("range of {name} = {low:e}..{high:e}"), parameter.ranges());
        }
    }
    for (name, count) in [("lines", lines), ("jobs", jobs as u64)] {
        if count == 0 {
            return refused(format!("{name} = 0"), "1 or more");
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::fit::{FitOptions, fit};
    use super::super::made::{on_rubber, read, rubber};
    use super::super::options::Drift;
    use super::*;

    #[test]
    fn options_and_curves_beyond_what_is_allowed_are_refused() {
        let curve = read(rubber(4e-8, 1, |_, _| 1.0).into_iter(), Drift::Keep);
        let refused =
            |curve: &MeasuredCurve, free: &[(Parameter, Option<(f64, f64)>)], [lines, jobs]: [usize; 2]| {
                let free = free.iter().map(|&(parameter, range)| Free { parameter, range }).collect();
                let options = FitOptions { free, lines: lines as u64, jobs };
                fit(curve, &on_rubber(1e-3, 2e6), &options, &|| false, &mut |_| ()).unwrap_err().to_string()
            };
        use Parameter::{Modulus, Offset, Work};
        let work = |low: f64, high: f64| [(Work, Some((low, high)))];
        for (free, counts, said) in [
            (
                &work(2.0, 1.0)[..],
                [1, 1],
                "range of work = 2e0..1e0; allowed: two values of at least 0, the first below",
            ),
            (&work(f64::NAN, 1.0), [1, 1], "range of work = NaN..1e0; allowed: "),
            (&work(-1.0, 1.0), [1, 1], "range of work = -1e0..1e0; allowed: "),
            (&work(0.0, f64::INFINITY), [1, 1], "range of work = 0e0..inf; allowed: "),
            (
                &[(Modulus, Some((0.0, 1.0)))],
                [1, 1],
                "range of modulus = 0e0..1e0; allowed: two values above 0",
            ),
            (
                &[(Offset, Some((1.0, 1.0)))],
                [1, 1],
                "range of offset = 1e0..1e0; allowed: two values, the first",
            ),
            (&[(Work, None), (Work, None)], [1, 1], "work is free twice; allowed: each parameter once"),
            (&[], [1, 1], "no free parameter; allowed: one or more of work, closing_work"),
            (&[(Work, None)], [0, 1], "lines = 0; allowed: 1 or more"),
            (&[(Work, None)], [1, 0], "jobs = 0; allowed: 1 or more"),
        ] {
            let error = refused(&curve, free, counts);
            assert!(error.starts_with(said), "{said}: {error}");
        }
        let changed = |change: fn(&mut MeasuredCurve)| {
            let mut curve = curve.clone();
            change(&mut curve);
            refused(&curve, &[(Work, None)], [1, 1])
        };
        for (error, said) in [
            (changed(|curve| curve.force[7] = 1e299), "force of point 8 = "),
            (changed(|curve| curve.force[7] = f64::NAN), "force of point 8 = NaN"),
            (
                changed(|curve| curve.displacement[0] = -1e11),
                "displacement of point 1 = -100 Gm; allowed: -1 to 1 Mm",
            ),
            (
                changed(|curve| curve.free = 200),
                "200 forces, [200, 200] displacements and segments; allowed: as many",
            ),
            (changed(|curve| curve.segment.truncate(9)), "200 forces, [200, 9] displacements and segments"),
            (changed(|curve| curve.noise = 0.0), "noise = 0 N; allowed: a force above 0"),
            (changed(|curve| curve.noise = -5e-9), "noise = -5 nN; allowed: "),
            (changed(|curve| curve.noise = f64::INFINITY), "noise = inf N; allowed: "),
        ] {
            assert!(error.starts_with(said), "{said}: {error}");
        }
    }
}
