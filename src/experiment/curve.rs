//! A measured force curve: its segments, with pressing positive, the zero of the force, its drift and its noise.

use super::baseline::{ends, right_angled};
use super::free::FEWEST;
use super::options::{CurveOptions, Drift, Negate, Tilt};
use super::points::{Points, kept};
use super::read::Columns;
use super::segment::{Segments, are_shuffled};
use super::zero::FreeParts;
use super::{ExperimentError, refused};
use crate::numerics::mean;
use crate::scene::format_quantity;
use crate::text::grouped;
use std::path::Path;

/// Most points that are fitted: more are averaged.
const MOST_POINTS: usize = 4096;
/// Fewest points of a curve.
const FEWEST_POINTS: usize = 4 * FEWEST;
/// Noise over the range of the force in a curve without noise.
const NO_NOISE: f64 = 1e-6;
/// Force in standard deviations of the noise that is a tension: at the end of the approach its sign is in doubt.
const PULLS: f64 = -5.0;

/// A measured curve in SI units: displacement of the instrument that grows on pressing, m, and force, N, without the force
/// before contact; compression is positive.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    pub(crate) displacement: Vec<f64>,
    pub(crate) force: Vec<f64>,
    /// Number of the segment of each point; segments of even number press.
    pub(crate) segment: Vec<usize>,
    /// Number of the first points, before contact.
    pub(super) free: usize,
    /// Displacement at which the contact seems to begin, m.
    pub(crate) touch: f64,
    /// Standard deviation of the force, N.
    pub(crate) noise: f64,
    /// Points of the file that are used.
    pub(crate) points: usize,
    /// Points left out since a value is missing.
    pub(crate) missing: usize,
    /// Displacements at which the segments end, m.
    pub(super) turns: Vec<f64>,
    /// True at the points of a pause.
    pub(super) is_still: Vec<bool>,
    /// Changes of the force over time, over the displacement, and from before to after contact that remain in the curve, N: 0
    /// where there is none.
    pub(super) remaining: [f64; 3],
    /// Time and displacement of each point, as shares of the whole curve.
    pub(super) shares: [Vec<f64>; 2],
    /// True if the zero of the force, a drift and a tilt are estimated from the points without contact and taken off.
    is_estimated: [bool; 3],
    /// Statements on the changes of the curve.
    pub(crate) statements: Vec<String>,
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
        let Columns { displacement, force, segment: labels, missing, mut statements, .. } = columns;
        let count = displacement.len();
        if count < FEWEST_POINTS {
            let fault = format!("{count} points with displacement and force");
            return refused(fault, format!("at least {FEWEST_POINTS}"));
        }
        if let Some(noise) = options.noise.filter(|noise| !(*noise > 0.0 && noise.is_finite())) {
            return refused(format!("a noise of {noise} N"), "a standard deviation above 0");
        }
        if are_shuffled(&displacement) {
            let fault = "the displacement goes to and fro from point to point";
            return refused(
                fault,
                "points in the order of time, and the column of the displacement by --columns",
            );
        }
        let averaged = count.div_ceil(MOST_POINTS);
        let segments = Segments::of(&displacement, &labels);
        let mut points = Points::averaged(&displacement, &force, &segments, averaged);
        let (low, high) = ends(points.force.iter().copied());
        let least = NO_NOISE * (high - low);
        let is_single = points.segment.last() == Some(&0);
        if is_single && points.is_retraction(least) {
            points.segment.fill(1);
            statements.push("A retraction alone: the model is loaded up to its first point.".to_owned());
        } else if is_single && options.segments != [1] {
            let allowed = "an approach and a retraction, of several files joined in one; a retraction alone that ends without \
                           contact; --segments 1 for an approach alone";
            return refused("the displacement does not turn: one segment", allowed);
        }
        let negate = points.reverse(options.negate)?;
        let free = FreeParts::of(&points, options, averaged, least)?;
        let noise = options.noise.unwrap_or(free.line(&points).noise).max(least);
        let (remaining, text) = free.take_off_lines(&mut points, options, noise)?;
        check_sign(&points, options, noise)?;
        let kept = kept(&points, options)?;
        let grouped_of = |count: usize| grouped(count as u64);
        let sum = |kept: &dyn Fn(usize) -> bool| {
            grouped_of(
                (0..points.counts.len()).filter(|index| kept(*index)).map(|index| points.counts[index]).sum(),
            )
        };
        let last = points.segment[points.segment.len() - 1];
        let place = match (points.segment[0], free.before) {
            (0, Some(free)) => format!("{} before contact", sum(&|index| index < free)),
            _ => format!("{} after contact", sum(&|index| index >= points.counts.len() - free.after)),
        };
        statements.push(format!(
            "{} points in {}, {} left out since a value is missing, {place}.",
            grouped_of(count),
            if last == points.segment[0] { "1 segment".to_owned() } else { format!("{} segments", last + 1) },
            grouped_of(missing)
        ));
        if averaged > 1 {
            statements.push(format!(
                "Means of {averaged} points each are used: {} of them.",
                grouped_of(points.force.len())
            ));
        }
        let pauses = points.is_still.contains(&true).then(|| sum(&|index| points.is_still[index]));
        if !options.segments.is_empty() {
            let numbers: Vec<String> = options.segments.iter().map(ToString::to_string).collect();
            let without =
                pauses.map_or_else(String::new, |count| format!(", without {count} points of pauses"));
            let used = sum(&|index| kept.binary_search(&index).is_ok());
            statements.push(format!("Segments used: {}, {used} points{without}.", numbers.join(", ")));
        } else if let Some(count) = pauses {
            statements.push(format!("{count} points are of pauses; --segments 1,2 leaves them out."));
        }
        if negate != Negate::None {
            statements.push(format!("Reversed, so that pressing is positive: {negate}."));
        }
        let found = match (options.noise, free.before) {
            (Some(_), _) => "given",
            (None, Some(_)) => "that before contact",
            (None, None) => "that after contact",
        };
        statements.push(format!("{text} Noise {}, {found}.", format_quantity(noise, "N")));
        let chosen = options.segments.iter().max().map_or(last, |most| (most - 1).min(last));
        // After the last approach that is used the body is pulled off.
        let turns =
            points.turns(chosen + usize::from(chosen.is_multiple_of(2) && (chosen < last || last == 0)));
        let of_kept = |values: &[f64]| kept.iter().map(|index| values[*index]).collect::<Vec<f64>>();
        Ok(MeasuredCurve {
            displacement: of_kept(&points.displacement),
            force: of_kept(&points.force),
            segment: kept.iter().map(|index| points.segment[*index]).collect(),
            free: kept.partition_point(|index| free.before.is_some_and(|before| *index < before)),
            touch: free.touch(&points),
            noise,
            points: kept.iter().map(|index| points.counts[*index]).sum(),
            missing,
            turns,
            is_still: kept.iter().map(|index| points.is_still[*index]).collect(),
            remaining,
            shares: free.shares.each_ref().map(|shares| of_kept(shares)),
            is_estimated: [
                options.zero.is_none(),
                options.drift == Drift::Remove,
                options.tilt == Tilt::Remove,
            ],
            statements,
        })
    }

    /// Displacement, m, and force, N, of each point.
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.displacement.iter().copied().zip(self.force.iter().copied())
    }

    /// Largest tension of the retractions, N, if it exceeds the noise.
    pub fn pull_off_force(&self) -> Option<f64> {
        let pulled = self.force.iter().zip(&self.segment).filter(|(_, segment)| *segment % 2 == 1);
        let force = -ends(pulled.map(|(force, _)| *force)).0;
        (force > PULLS.abs() * self.noise && force.is_finite()).then_some(force)
    }

    /// Straight lines of the zero of the force, of a removed drift and of a removed tilt, of length 1 and at right angles,
    /// if they are estimated from the curve: they are refined with each model.
    pub(super) fn lines(&self, has_zero: bool) -> Vec<Vec<f64>> {
        let [time, displacement] = self.shares.clone();
        let columns = [vec![1.0; time.len()], time, displacement];
        let [zero, drift, tilt] = self.is_estimated;
        let used = columns.into_iter().zip([zero && !has_zero, drift, tilt]);
        right_angled(&used.filter_map(|(column, is_used)| is_used.then_some(column)).collect::<Vec<_>>())
    }
}

/// Refuses a force that is negative where the body presses most.
fn check_sign(points: &Points, options: &CurveOptions, noise: f64) -> Result<(), ExperimentError> {
    let first = points.of(points.segment[0]);
    let count = (first.len() / 20).max(1);
    let pressed = if points.segment[0] == 0 { first.end - count..first.end } else { 0..count };
    let pressed = mean(&points.force[pressed]);
    if options.negate.is_some() || pressed >= PULLS * noise {
        return Ok(());
    }
    let place = if points.segment[0] == 0 { "end of the approach" } else { "beginning of the retraction" };
    let found = format_quantity(pressed, "N");
    refused(
        format!("the force is negative where the body presses: {found} at the {place}"),
        "--negate force where tension counts as positive, --negate none for a body that is pulled there",
    )
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
        assert_eq!(expected.turns.len(), 2);
        let array = |descr: &str, shape: &str, values: &mut dyn Iterator<Item = f64>| {
            let mut bytes = Vec::new();
            crate::io::npy::write_header(&mut bytes, descr, shape).unwrap();
            bytes.extend(values.flat_map(f64::to_le_bytes));
            bytes
        };
        let all = points(600);
        let rows = || all.iter().flat_map(|&(d, f)| [d, f]);
        let axes = || all.iter().map(|point| point.0).chain(all.iter().map(|point| point.1));
        // Any number that changes with the segment.
        let labelled =
            || all.iter().zip(&expected.segment).flat_map(|(&(d, f), segment)| [d, f, 7.0 - *segment as f64]);
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
            (array("'<f8'", "600, 3", &mut labelled()), units(columns(&["1", "2", "3"]))),
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
        assert_eq!((curve.missing, curve.points), (2, 100_000));
        assert!(curve.statements[1].starts_with("Means of 25 points each"), "{:?}", curve.statements);
        assert!(curve.force.len() <= MOST_POINTS && curve.statements.len() == 3, "{:?}", curve.statements);
        assert!((curve.force[2000] / 1e-7 - 1.0).abs() < 0.01, "{:e}", curve.force[2000]);
        // Points of the file are counted, not means.
        let text = lines(points(9000));
        let options = CurveOptions { free_points: Some(2700), ..CurveOptions::default() };
        let curve = read(text.as_bytes(), &options).unwrap();
        assert_eq!((curve.force.len(), curve.free), (3000, 900));
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

    const HEADER: &str = "displacement [nm],force [nN]\n";

    fn lines(points: impl IntoIterator<Item = (f64, f64)>) -> String {
        points.into_iter().fold(HEADER.to_owned(), |all, (d, f)| all + &format!("{d},{f}\n"))
    }

    /// A curve of `count` points, of which `approach` belong to the approach.
    fn few(count: usize, approach: usize) -> String {
        let at =
            |index: usize| if index < approach { 10 * index } else { 10 * approach - 7 * (index - approach) };
        lines((0..count).map(|index| (at(index) as f64, (at(index) as f64 - 90.0).max(0.0))))
    }

    fn shuffled() -> String {
        let all = points(600);
        lines((0..600).map(|index| all[index * 251 % 600]))
    }

    fn retraction_first() -> String {
        let all = points(600);
        lines(all[300..].iter().chain(&all[..300]).copied())
    }

    /// Tables of analysis programs and instruments, also with approach and retraction side by side.
    #[test]
    fn exports_of_other_programs_are_read_without_options() {
        let all = points(600);
        let expected = read(lines(all.iter().copied()).as_bytes(), &CurveOptions::default()).unwrap();
        let joined = |head: &str, line: &dyn Fn(usize) -> String| {
            (0..600).fold(head.to_owned(), |all, index| all + &line(index) + "\n")
        };
        let tab = "# afmformats\n# BEGIN METADATA\n# {}\n# END METADATA\n# force\theight (measured)\theight (piezo)\ttime\n";
        let tab = joined(tab, &|index| {
            format!("{:e}\t{:e}\t0\t{index}", all[index].1 * 1e-9, -all[index].0 * 1e-9)
        });
        let jpk = "# segment: extend\n# columns: time height vDeflection\n# fancyNames: \"a b\" \"c d\"\n# units: s m N\n";
        let jpk = joined(jpk, &|index| {
            let again = if index == 300 { "# segment: retract\n" } else { "" };
            format!("{again}{index} {:e} {:e}", all[index].0 * 1e-9, all[index].1 * 1e-9)
        });
        // The retraction along the same direction as the approach, and with minus signs of a spreadsheet.
        let side =
            (0..300).fold("Z ext (nm);F ext (nN);Z ret (nm);F ret (nN)\n".to_owned(), |text, index| {
                let (one, other) = (all[index], all[599 - index]);
                text + &format!("{};{};{};{}\n", one.0, one.1, other.0, other.1)
            });
        let one_height = (0..300)
            .fold("x [nm],approach force [nN],retract force [nN]\n".to_owned(), |text, index| {
                text + &format!("{},{},{}\n", all[index].0, all[index].1, all[599 - index].1)
            });
        for (text, reversed) in
            [(tab, true), (jpk, false), (side.replace('-', "\u{2212}"), false), (one_height, false)]
        {
            let found = read(text.as_bytes(), &CurveOptions::default()).unwrap();
            let pairs = found.force.iter().zip(&expected.force);
            assert!(pairs.into_iter().all(|(one, other)| (one - other).abs() < 1e-20), "{text:.60}");
            assert_eq!((found.free, &found.segment), (expected.free, &expected.segment));
            assert_eq!(found.statements.iter().any(|text| text.starts_with("Reversed")), reversed);
        }
        let words = joined("d [nm],f [nN],s\n", &|index| {
            format!("{},{},{}", all[index].0, all[index].1, ["extend", "retract"][index / 300])
        });
        let found = read(words.as_bytes(), &columns(&["d", "f", "s"])).unwrap();
        assert_eq!((found.segment[299], found.segment[300]), (0, 1));
    }

    #[test]
    fn units_of_the_command_line_overrule_those_of_the_file() {
        // A divisor that is a whole number, and a factor.
        for unit in [4.0, 3.0] {
            let text = text("Piezo [nm],Deflection [nm]\n", |d, f| format!("{},{}", d / 1e3, f / unit));
            let units = vec!["um".to_owned(), format!("{unit}nN")];
            let curve = read(text.as_bytes(), &CurveOptions { units, ..CurveOptions::default() }).unwrap();
            let (turn, force) = (curve.turns[0], curve.force[300]);
            assert!(
                (turn / 5e-8 - 1.0).abs() < 0.01 && (force / 1e-7 - 1.0).abs() < 0.01,
                "{turn:e} {force:e}"
            );
            let of_force = format!("Unit of the force by --units: {unit}nN; the file states nm.");
            assert_eq!(curve.statements[0], "Unit of the displacement by --units: um; the file states nm.");
            assert_eq!(curve.statements[1], of_force);
        }
    }

    /// Drift over time and tilt over the displacement, separated by the parts before and after contact; a force that differs
    /// before and after contact is neither.
    #[test]
    fn what_remains_without_contact_is_named_with_its_remedy() {
        let made = |drift: f64, tilt: f64, step: f64| {
            lines(points(600).into_iter().enumerate().map(|(index, (d, f))| {
                let step = if index < 300 { 0.0 } else { step };
                (d, f + drift * index as f64 / 599.0 + tilt * (d + 100.0) / 150.0 + step)
            }))
        };
        let read = |text: &str, drift, tilt| {
            read(text.as_bytes(), &CurveOptions { drift, tilt, ..CurveOptions::default() }).unwrap()
        };
        let keep = |text: &str| read(text, Drift::Keep, Tilt::Keep).remaining.map(|one| (one * 1e9).round());
        assert_eq!(keep(&made(0.0, 0.0, 0.0)), [0.0; 3]);
        assert_eq!(keep(&made(0.0, 3.0, 0.0)), [0.0, 3.0, 0.0]);
        assert_eq!(keep(&made(-3.0, 0.0, 0.0)), [-3.0, 0.0, 0.0]);
        assert_eq!(keep(&made(2.0, -4.0, 0.0)), [2.0, -4.0, 0.0]);
        assert_eq!(keep(&made(0.0, 0.0, 2.0)), [0.0, 0.0, 2.0]);
        // Waves of the force are neither; a retraction alone has its own zero.
        let waves = points(600).into_iter().map(|(d, f)| (d, f + 2.0 * (0.1 * d).sin()));
        let waves = lines(waves);
        assert_eq!(keep(&waves), [0.0; 3]);
        let is_curved = |text: &str| {
            read(text, Drift::Keep, Tilt::Keep).statements.concat().contains("no straight lines")
        };
        assert!(is_curved(&waves) && !is_curved(&made(0.0, 0.0, 0.0)));
        let end = CurveOptions { segments: vec![2], ..CurveOptions::default() };
        let end = super::tests::read(made(0.0, 0.0, 2.0).as_bytes(), &end).unwrap();
        assert!(end.force[299].abs() < 3e-10, "{:e}", end.force[299]);
        let tilted = made(0.0, 3.0, 0.0);
        let stated = |drift, tilt| read(&tilted, drift, tilt).statements.concat();
        assert!(stated(Drift::Keep, Tilt::Keep).contains("A tilt remains: --tilt remove takes it off."));
        assert!(!stated(Drift::Keep, Tilt::Keep).contains("--drift"));
        assert!(!stated(Drift::Keep, Tilt::Remove).contains("remains"));
        let without = read(&made(2.0, 3.0, 0.0), Drift::Remove, Tilt::Remove);
        let plain = read(&made(0.0, 0.0, 0.0), Drift::Keep, Tilt::Keep);
        assert!(without.force.iter().zip(&plain.force).all(|(one, other)| (one - other).abs() < 1e-10));
    }

    /// The approach gives zero and contact of a retraction; a retraction alone has both at its end.
    #[test]
    fn chosen_segments_are_used_without_pauses() {
        let mut all = points(600);
        let pause = (0..200).map(|index| (50.0, 101.0 - 0.02 * f64::from(index))).collect::<Vec<_>>();
        let segments =
            |numbers: &[usize]| CurveOptions { segments: numbers.to_vec(), ..CurveOptions::default() };
        let whole = read(lines(all.iter().copied()).as_bytes(), &CurveOptions::default()).unwrap();
        let retraction = read(lines(all.iter().copied()).as_bytes(), &segments(&[2])).unwrap();
        assert_eq!((retraction.points, retraction.free, retraction.segment[0]), (300, 0, 1));
        assert_eq!((&retraction.force[..], retraction.touch), (&whole.force[300..], whole.touch));
        assert_eq!(retraction.turns, whole.turns);
        let alone = read(lines(all[300..].iter().copied()).as_bytes(), &CurveOptions::default()).unwrap();
        assert_eq!((alone.points, alone.segment[0], alone.turns.len()), (300, 1, 2));
        assert!(alone.force.iter().zip(&retraction.force).all(|(one, other)| (one - other).abs() < 5e-11));
        assert!((alone.touch - whole.touch).abs() < 2e-9, "{} {}", alone.touch, whole.touch);
        let approach = read(lines(all[..300].iter().copied()).as_bytes(), &segments(&[1])).unwrap();
        assert_eq!((&approach.force[..], approach.turns.len()), (&whole.force[..300], 2));
        all.splice(300..300, pause);
        let paused = read(lines(all.iter().copied()).as_bytes(), &CurveOptions::default()).unwrap();
        assert_eq!(paused.points, 800);
        assert!(
            paused.statements.concat().contains("--segments 1,2 leaves them out"),
            "{:?}",
            paused.statements
        );
        let moving = read(lines(all.iter().copied()).as_bytes(), &segments(&[1, 2])).unwrap();
        assert!((590..=600).contains(&moving.points), "{}", moving.points);
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
            (
                text(header, |d, f| comma(d, f + (d + 100.0).powi(2))),
                plain(),
                "no part before contact: the force",
            ),
            (text(header, |d, f| comma(d, f + 9.0 * d)), plain(), "no part before contact: the force"),
            (
                text(header, |d, _| comma(d, 9.0 * d + (d * 7.0).sin())),
                plain(),
                "no contact, or contact from the first",
            ),
            (few(42, 17), plain(), "18 points in the approach are too few"),
            (shuffled(), plain(), "the displacement goes to and fro"),
            (
                text(header, |d, f| comma(-d, f))
                    .lines()
                    .skip(1)
                    .fold(header.to_owned(), |all, line| all + line + "\n"),
                CurveOptions { negate: Some(Negate::None), ..plain() },
                "the body moves away",
            ),
            (retraction_first(), plain(), "the first segment begins in contact and ends without it"),
            (
                text(header, comma) + "1e11,0\n",
                plain(),
                "line 602: a displacement of 1e2 m far from all others",
            ),
            (text(header, comma) + "0,1e299\n", plain(), "line 602: a force of 1e290 N"),
            (text(header, comma) + &"9".repeat(400) + ",0\n", plain(), "line 602: column 1: \"999"),
            (
                text(header, comma),
                CurveOptions { noise: Some(-5e-9), ..plain() },
                "a noise of -0.000000005 N",
            ),
            (
                text(header, comma),
                CurveOptions { segments: vec![3], ..plain() },
                "--segments 3: the curve has no such segment",
            ),
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
            let error = read(content.as_bytes(), &options).map(|_| ()).expect_err(said);
            assert!(error.starts_with(said) && error.contains("allowed: "), "{said}: {error}");
        }
    }
}
