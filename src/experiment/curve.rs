//! A measured force curve: its segments, with pressing positive, the zero of the force, its drift and its noise.

use super::baseline::{FEWEST, Line, free_count};
use super::read::{Columns, CurveOptions, Drift, Negate};
use super::{ExperimentError, refused};
use crate::scene::format_quantity;
use crate::text::grouped;
use std::path::Path;

/// Most points that are fitted: more are averaged.
const MOST_POINTS: usize = 4096;
/// Fewest points of a curve.
const FEWEST_POINTS: usize = 4 * FEWEST;
/// Share of the range of the displacement by which it turns, and of the points in the mean that is looked at.
const TURN: f64 = 0.05;
const SMOOTHING: f64 = 1e-3;
/// Noise over the range of the force in a curve without noise.
const NO_NOISE: f64 = 1e-6;
/// Mean force at the end of the approach in standard deviations of the noise below which the sign is in doubt.
const PULLS: f64 = -5.0;

/// A measured curve in SI units: displacement of the instrument that grows on pressing, m, and force, N, without that
/// before contact; compression is positive.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Displacement of the instrument, m.
    pub displacement: Vec<f64>,
    /// Force, N.
    pub force: Vec<f64>,
    /// Number of the segment of each point; those of even number press.
    pub segment: Vec<usize>,
    /// Number of the first points, before contact.
    pub free: usize,
    /// Standard deviation of the force, N.
    pub noise: f64,
    /// Points left out since a value is missing.
    pub missing: usize,
    /// Points of the file in each point.
    pub averaged: usize,
    /// True if the zero of the force, and if a removed drift, are those before contact.
    pub(super) is_estimated: [bool; 2],
    /// Statements on the changes of the curve.
    pub statements: Vec<String>,
}

impl MeasuredCurve {
    /// Reads a curve: text, CSV or an array of NumPy, also compressed by gzip, of at most 1 GiB.
    ///
    /// # Errors
    /// A file that cannot be read, and a curve without a part before contact, a contact or a turning point.
    pub fn read(path: &Path, options: &CurveOptions) -> Result<Self, ExperimentError> {
        MeasuredCurve::prepare(Columns::read(path, options)?, options)
    }

    fn prepare(columns: Columns, options: &CurveOptions) -> Result<Self, ExperimentError> {
        let Columns { mut displacement, mut force, segment, missing } = columns;
        let points = displacement.len();
        if points < FEWEST_POINTS {
            return refused(
                format!("{points} points with displacement and force"),
                format!("at least {FEWEST_POINTS}"),
            );
        }
        let mut segment = match segment.is_empty() {
            true => by_turning_points(&displacement),
            false => by_numbers(&segment, &displacement),
        };
        if segment[points - 1] == 0 {
            let allowed = "an approach and a retraction; segments of several files joined in one";
            return refused("the displacement does not turn: one segment", allowed);
        }
        let first_end = segment.partition_point(|&number| number == 0);
        let falls = displacement[first_end - 1] < displacement[0];
        let negate = options.negate.unwrap_or(if falls { Negate::Displacement } else { Negate::None });
        for (values, one) in [(&mut displacement, Negate::Displacement), (&mut force, Negate::Force)] {
            if negate == one || negate == Negate::Both {
                values.iter_mut().for_each(|value| *value = -*value);
            }
        }
        if displacement[first_end - 1] < displacement[0] {
            let allowed = "an approach first; --negate displacement for a distance between the bodies";
            return refused(
                format!("the body moves away in the first segment with --negate {negate}"),
                allowed,
            );
        }
        let averaged = points.div_ceil(MOST_POINTS);
        if averaged > 1 {
            let (mut ranges, mut start) = (Vec::new(), 0);
            for chunk in segment.chunk_by(|one, next| one == next).flat_map(|part| part.chunks(averaged)) {
                ranges.push(start..start + chunk.len());
                start += chunk.len();
            }
            let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            [displacement, force] = [displacement, force]
                .map(|values| ranges.iter().map(|range| mean(&values[range.clone()])).collect());
            segment = ranges.iter().map(|range| segment[range.start]).collect();
        }
        let approach = segment.partition_point(|&number| number == 0);
        let (low, high) = ends(force.iter().copied());
        let least = NO_NOISE * (high - low);
        let free = options.free_points.map(|free| free / averaged);
        let Some(free) = free.or_else(|| free_count(&force[..approach], least)) else {
            let allowed = "a part before contact, then a change by more than the noise; --free-points COUNT for \
                           a weak contact";
            return refused("no contact: the force follows one straight line in the approach", allowed);
        };
        if !(FEWEST..approach).contains(&free) {
            let fault = format!("no part before contact: {free} of {approach} points of the approach");
            return refused(fault, format!("at least {FEWEST}, found or by --free-points"));
        }
        let line = Line::through(&force[..free]);
        let last = (force.len() - 1) as f64;
        let (slope, drift) = match options.drift {
            Drift::Keep => (0.0, "stays (--drift remove takes it off)"),
            Drift::Remove => (line.slope, "was removed"),
            Drift::Known(drift) => (drift / last, "was removed as given"),
        };
        let (zero, middle) = (options.zero.unwrap_or(line.mean), 0.5 * (free - 1) as f64);
        force
            .iter_mut()
            .enumerate()
            .for_each(|(index, force)| *force -= zero + slope * (index as f64 - middle));
        let noise = options.noise.unwrap_or(line.noise).max(least);
        let pressed = &force[approach - (approach / 20).max(1)..approach];
        let pressed = pressed.iter().sum::<f64>() / pressed.len() as f64;
        let newton = |force: f64| format_quantity(force, "N");
        if options.negate.is_none() && pressed < PULLS * noise {
            let fault = format!(
                "the force is negative where the body presses: {} at the end of the approach",
                newton(pressed)
            );
            return refused(
                fault,
                "--negate force where tension counts as positive, --negate none for a body that is pulled there",
            );
        }
        let count = |count: usize| grouped(count as u64);
        let mut statements = vec![format!(
            "{} points in {} segments, {} left out since a value is missing, {} before contact.",
            count(points),
            segment[force.len() - 1] + 1,
            count(missing),
            count(free * averaged)
        )];
        if averaged > 1 {
            statements
                .push(format!("Means of {averaged} points each are used: {} of them.", count(force.len())));
        }
        if negate != Negate::None {
            statements.push(format!("Reversed, so that pressing is positive: {negate}."));
        }
        let found = if options.noise.is_some() { "given" } else { "that before contact" };
        statements.push(format!(
            "Zero of the force at {}. Drift over the whole curve, by the part before contact: {} ± {}; it {drift}. Noise {}, \
             {found}.",
            newton(zero), newton(line.slope * last), newton(line.slope_error() * last), newton(noise)
        ));
        let is_estimated = [options.zero.is_none(), options.drift == Drift::Remove];
        Ok(MeasuredCurve {
            displacement,
            force,
            segment,
            free,
            noise,
            missing,
            averaged,
            is_estimated,
            statements,
        })
    }

    /// Displacements at which the segments end, m.
    pub fn turns(&self) -> Vec<f64> {
        let points = self.segment.iter().zip(&self.displacement);
        let of = |number| points.clone().filter(move |(segment, _)| **segment == number).map(|(_, at)| *at);
        let end = |number| if number % 2 == 0 { ends(of(number)).1 } else { ends(of(number)).0 };
        (0..=self.segment.last().copied().unwrap_or(0)).map(end).collect()
    }
}

/// Smallest and largest value.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Numbers of the segments between the turning points of the smoothed displacement: those from which it comes back by a
/// share of its range.
fn by_turning_points(displacement: &[f64]) -> Vec<usize> {
    let last = displacement.len() - 1;
    let half = (0.5 * SMOOTHING * last as f64) as usize;
    let smooth = |index: usize| {
        let half = half.min(index).min(last - index);
        displacement[index - half..=index + half].iter().sum::<f64>() / (2 * half + 1) as f64
    };
    let smooth: Vec<f64> = (0..=last).map(smooth).collect();
    let (low, high) = ends(smooth.iter().copied());
    let least = TURN * (high - low);
    // Highest and lowest place since the last turn, and the direction, 0 at the beginning.
    let (mut places, mut direction, mut number) = ([0, 0], 0.0, 0);
    let mut numbers = vec![0; displacement.len()];
    for (index, &value) in smooth.iter().enumerate() {
        for (place, sign) in places.iter_mut().zip([1.0, -1.0]) {
            if sign * (value - smooth[*place]) > 0.0 {
                *place = index;
            }
        }
        let back = places.map(|place| (value - smooth[place]).abs() >= least && least > 0.0);
        let turned = if back[0] && direction >= 0.0 {
            0
        } else if back[1] && direction <= 0.0 {
            1
        } else {
            continue;
        };
        if direction != 0.0 {
            number += 1;
            numbers[places[turned] + 1..].fill(number);
        }
        direction = if turned == 0 { -1.0 } else { 1.0 };
        places = [index, index];
    }
    numbers
}

/// Numbers of the segments from those of a column: parts of one direction are one segment.
fn by_numbers(segment: &[f64], displacement: &[f64]) -> Vec<usize> {
    let (mut numbers, mut number, mut before) = (Vec::with_capacity(segment.len()), 0, None);
    for part in segment.chunk_by(|one, next| one == next) {
        let of = &displacement[numbers.len()..numbers.len() + part.len()];
        let presses = of[of.len() - 1] >= of[0];
        number += usize::from(before.replace(presses).is_some_and(|before| before != presses));
        numbers.extend(std::iter::repeat_n(number, part.len()));
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    fn read(content: &[u8], options: &CurveOptions) -> Result<MeasuredCurve, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve");
        std::fs::write(&path, content).unwrap();
        MeasuredCurve::read(&path, options).map_err(|error| error.to_string())
    }

    /// Displacements, nm, and forces, nN: a spring of 2 N/m from 0 nm on, with an alternating noise of 0.1 nN and a zero at
    /// 1 nN, pressed from −100 to 50 nm and back in `count` points.
    fn points(count: usize) -> Vec<(f64, f64)> {
        let point = |index: usize| {
            let way = 300.0 * index as f64 / (count - 1) as f64;
            let displacement = if way < 150.0 { way - 100.0 } else { 200.0 - way };
            let noise = if index.is_multiple_of(2) { 0.1 } else { -0.1 };
            (displacement, 1.0 + noise + 2.0 * displacement.max(0.0))
        };
        (0..count).map(point).collect()
    }

    /// Lines of a text with this header, each point in this form.
    fn text(header: &str, form: impl Fn(f64, f64) -> String) -> String {
        let mut text = header.to_owned();
        points(600).into_iter().for_each(|(d, f)| writeln!(text, "{}", form(d, f)).unwrap());
        text
    }

    fn columns(names: &[&str]) -> CurveOptions {
        CurveOptions { columns: names.iter().map(ToString::to_string).collect(), ..CurveOptions::default() }
    }

    #[test]
    fn a_curve_is_the_same_in_every_form() {
        let units = |columns: CurveOptions| CurveOptions { units: vec!["nm".into(), "nN".into()], ..columns };
        let plain = CurveOptions::default();
        let comma = |d: f64, f: f64| format!("{d},{f}");
        let expected = read(text("displacement [nm],force [nN]\n", comma).as_bytes(), &plain).unwrap();
        // Both points at the turn have one displacement.
        assert_eq!((expected.segment[298], expected.segment[301], expected.segment[599]), (0, 1, 1));
        assert!((190..=200).contains(&expected.free), "{}", expected.free);
        assert!((expected.noise / 1e-10 - 1.0).abs() < 0.02, "{:e}", expected.noise);
        assert!((expected.force[300] / 1e-7 - 1.0).abs() < 0.01, "{:e}", expected.force[300]);
        assert_eq!(expected.turns().len(), 2);
        let array = |descr: &str, shape: &str, values: &mut dyn Iterator<Item = f64>| {
            let mut bytes = Vec::new();
            crate::io::npy::write_header(&mut bytes, descr, shape).unwrap();
            bytes.extend(values.flat_map(f64::to_le_bytes));
            bytes
        };
        let all = points(600);
        let rows = || all.iter().flat_map(|&(d, f)| [d, f]);
        let axes = || all.iter().map(|point| point.0).chain(all.iter().map(|point| point.1));
        let fields = "[('load', '<f8'), ('height', '<f8')]";
        for (content, options) in [
            (text("x/nm;F/nN\n", |d, f| format!("{d};{f}")).into(), columns(&["x", "f"])),
            (
                text("# columns: time height force\n# units: s nm nN\n", |d, f| format!("0 {d} {f}")).into(),
                plain.clone(),
            ),
            (text("", |d, f| format!("{d}\t{f}")).into(), units(plain.clone())),
            (
                text("a (nm)\tb (nN)\n", |d, f| format!("{d}\t{f}").replace('.', ",")).into(),
                columns(&["1", "2"]),
            ),
            (
                text("separation [um],force [N]\n", |d, f| format!("{},{}", -d / 1e3, f / 1e9)).into(),
                columns(&["1", "2"]),
            ),
            (
                text("z [nm],deflection [nm]\n", |d, f| format!("{d},{}", f / 4.0)).into(),
                CurveOptions { units: vec!["nm".into(), "4nN".into()], ..columns(&["1", "2"]) },
            ),
            (array("'<f8'", "600, 2", &mut rows()), units(columns(&["1", "2"]))),
            (array("'<f8'", "2, 600", &mut axes()), units(columns(&["1", "2"]))),
            (array(fields, "600,", &mut all.iter().flat_map(|&(d, f)| [f, d])), units(plain.clone())),
        ] {
            let found = read(&content, &options).unwrap();
            let pairs = found
                .force
                .iter()
                .chain(&found.displacement)
                .zip(expected.force.iter().chain(&expected.displacement));
            assert!(pairs.into_iter().all(|(one, other)| (one - other).abs() < 1e-20), "{options:?}");
            assert_eq!((found.free, &found.segment), (expected.free, &expected.segment));
        }
    }

    #[test]
    fn many_points_are_averaged_and_missing_ones_counted() {
        let mut text = "displacement [nm],force [nN]\nNaN,1\n0,\n".to_owned();
        points(100_000).into_iter().for_each(|(d, f)| writeln!(text, "{d},{f}").unwrap());
        let curve = read(text.as_bytes(), &CurveOptions::default()).unwrap();
        assert_eq!((curve.missing, curve.averaged), (2, 25));
        assert!(curve.force.len() <= MOST_POINTS && curve.statements.len() == 3, "{:?}", curve.statements);
        assert!((curve.force[2000] / 1e-7 - 1.0).abs() < 0.01, "{:e}", curve.force[2000]);
    }

    #[test]
    fn drift_and_zero_are_of_the_part_before_contact() {
        let mut text = "displacement [nm],force [nN]\n".to_owned();
        for (index, (d, f)) in points(600).into_iter().enumerate() {
            writeln!(text, "{d},{}", f + 0.01 * index as f64).unwrap();
        }
        let read = |drift| read(text.as_bytes(), &CurveOptions { drift, ..CurveOptions::default() }).unwrap();
        let without = read(Drift::Remove);
        assert!(without.force[599].abs() < 3e-10, "{:e}", without.force[599]);
        assert!((read(Drift::Keep).force[599] / 5e-9 - 1.0).abs() < 0.05);
        let known = read(Drift::Known(5.99e-9));
        assert!((known.force[599] - without.force[599]).abs() < 2e-10);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        let header = "displacement [nm],force [nN]\n";
        let comma = |d: f64, f: f64| format!("{d},{f}");
        let plain = CurveOptions::default;
        let many = |form: &dyn Fn(f64, f64) -> String| text(header, form);
        for (content, options, said) in [
            (
                many(&|d, _| format!("{d},{}", if (d as i64) % 2 == 0 { 1.0 } else { 1.1 })),
                plain(),
                "no contact: ",
            ),
            // A curve that begins in contact: it has no line before a change.
            (text(header, |d, f| comma(d, f + (d + 100.0).powi(2))), plain(), "no contact: "),
            (
                text(header, comma).lines().take(302).collect::<Vec<_>>().join("\n"),
                plain(),
                "the displacement does not turn",
            ),
            (text(header, |d, f| comma(d, -f)), plain(), "the force is negative where the body presses: -9"),
            (text(header, comma) + "1,2,3\n", plain(), "line 602: 3 columns; allowed: 2"),
            (text(header, comma) + "1,2x\n", plain(), "line 602: column 2: \"2x\" is not a number"),
            (text("d,f\n", comma), plain(), "no unit of the displacement is stated"),
            (text("d [nm],f [V]\n", comma), plain(), "\"V\" is not a unit of the force"),
            (text("a [nm],b [nN]\n", comma), plain(), "2 columns a, b: none is known as the displacement"),
            (text(header, comma), columns(&["1", "5"]), "2 columns displacement, force: none is \"5\""),
            (
                header.to_owned() + "1,2\n",
                plain(),
                "1 points with displacement and force; allowed: at least 40",
            ),
            (String::new(), plain(), "0 points"),
            (
                text(header, comma),
                CurveOptions { negate: Some(Negate::Displacement), ..plain() },
                "the body moves away",
            ),
            (
                text(header, comma),
                CurveOptions { free_points: Some(400), ..plain() },
                "no part before contact: 400 of",
            ),
        ] {
            let error = read(content.as_bytes(), &options).expect_err(said);
            assert!(error.starts_with(said) && error.contains("allowed: "), "{said}: {error}");
        }
    }
}
