//! The points of the rest between approach and retraction, which only a fit with relaxation uses.

use crate::curve::MeasuredCurve;

impl MeasuredCurve {
    /// Returns the curve with the points of the rest between approach and retraction, which lasts
    /// `seconds`. If the points have no times, they are evenly spaced over the rest. Returns `None`
    /// if there are no such points, or if the rest takes no time.
    pub(crate) fn with_rest(&self, seconds: f64) -> Option<MeasuredCurve> {
        let points = &self.timing.points;
        if points.is_empty() || seconds <= 0.0 {
            return None;
        }
        let place = self.segment.partition_point(|segment| *segment == 0);
        let mut curve = self.clone();
        curve.seconds_at_rest = vec![None; self.force.len()];
        for (number, point) in points.iter().enumerate() {
            let index = place + number;
            let evenly = (number as f64 + 0.5) / points.len() as f64 * seconds;
            let time = point.seconds.unwrap_or(evenly).min(seconds);
            curve.displacement.insert(index, point.displacement);
            curve.force.insert(index, point.force);
            curve.segment.insert(index, 0);
            curve.seconds_at_rest.insert(index, Some(time));
            let columns = curve.subtracted.columns.iter_mut();
            for (column, value) in columns.zip(&point.lines) {
                column.insert(index, *value);
            }
        }
        Some(curve)
    }

    /// Returns those of the `values` that belong to points of motions. `values` has a value for
    /// each point of a curve with a rest.
    pub(crate) fn without_rest<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let mut moving = Vec::with_capacity(values.len());
        for (index, value) in values.iter().enumerate() {
            if self.seconds_at_rest.get(index).copied().flatten().is_none() {
                moving.push(*value);
            }
        }
        moving
    }
}

#[cfg(test)]
mod tests {
    use crate::common::{from_text, of_spring};
    use crate::read::options::CurveOptions;

    /// Returns a file of the spring that is pressed at 100 nm/s, rests for 2 s at 50 nm in 100
    /// points with a force that falls, and is pulled at 200 nm/s. `time` writes the time in s.
    fn text(header: &str, time: impl Fn(f64) -> String) -> String {
        let mut text = header.to_owned();
        let points = of_spring(600);
        for (index, (displacement, force)) in points.iter().enumerate() {
            let pressed = (displacement + 100.0) / 100.0;
            let pulled = 1.5 + 2.0 + (50.0 - displacement) / 200.0;
            let seconds = if index < 300 { pressed } else { pulled };
            if index == 300 {
                for number in 0..100 {
                    let since = 0.02 * (f64::from(number) + 0.5);
                    text += &format!("{},50,{}\n", time(1.5 + since), 101.0 - 10.0 * since);
                }
            }
            text += &format!("{},{displacement},{force}\n", time(seconds));
        }
        text
    }

    fn columns(words: &[&str], units: &[&str]) -> CurveOptions {
        CurveOptions {
            columns: words.iter().map(ToString::to_string).collect(),
            units: units.iter().map(ToString::to_string).collect(),
            ..CurveOptions::default()
        }
    }

    #[test]
    fn speeds_and_rest_follow_from_the_times() {
        let in_seconds = |seconds: f64| seconds.to_string();
        let in_milliseconds = |seconds: f64| (1e3 * seconds).to_string();
        let header = "time [ms],displacement [nm],force [nN]\n";
        for (text, options) in [
            (text(header, in_milliseconds), CurveOptions::default()),
            (
                text("a,b [nm],c [nN]\n", in_seconds),
                columns(&["b", "c", "time=a"], &[]),
            ),
            (
                text("Series Time,displacement,force\n", in_milliseconds),
                columns(&["time=1"], &["nm", "nN", "ms"]),
            ),
        ] {
            let curve = from_text(&text, &options).unwrap();
            let speeds = curve.timing.speeds.unwrap();
            assert!((speeds.approach / 1e-7 - 1.0).abs() < 0.01, "{speeds:?}");
            assert!((speeds.retraction / 2e-7 - 1.0).abs() < 0.01, "{speeds:?}");
            let rest = curve.timing.rest.unwrap();
            assert!((rest / 2.0 - 1.0).abs() < 0.01, "{rest}");
            // The points of the motions next to the turn count too.
            assert_eq!(curve.timing.points.len(), 102);
            let with_rest = curve.with_rest(rest).unwrap();
            let places: Vec<usize> = (0..with_rest.force.len())
                .filter(|index| with_rest.seconds_at_rest[*index].is_some())
                .collect();
            assert_eq!(places.len(), 102);
            for (number, place) in places[1..101].iter().enumerate() {
                let seconds = with_rest.seconds_at_rest[*place].unwrap();
                assert!(
                    (seconds - 0.02 * (number as f64 + 0.5)).abs() < 0.01,
                    "{seconds}"
                );
                let force = 1e-7 - 1e-8 * seconds;
                assert!((with_rest.force[*place] - force).abs() < 1e-9);
            }
            assert_eq!(with_rest.without_rest(&with_rest.force), curve.force);
            assert_eq!(with_rest.free, curve.free);
        }
    }

    /// Without times the points of the rest are evenly spaced over the time that the scene states,
    /// and times that fall are no times.
    #[test]
    fn a_curve_without_times_rests_as_long_as_is_stated() {
        let unknown = text("a,displacement [nm],force [nN]\n", |_| "0".to_owned());
        let falls = text("time [s],displacement [nm],force [nN]\n", |seconds| {
            (-seconds).to_string()
        });
        for text in [unknown, falls] {
            let curve = from_text(&text, &CurveOptions::default()).unwrap();
            let says = curve
                .statements
                .iter()
                .any(|statement| statement.to_string().contains("times do not grow"));
            assert_eq!(says, text.starts_with("time"), "{:?}", curve.statements);
            assert_eq!((curve.timing.speeds, curve.timing.rest), (None, None));
            let with_rest = curve.with_rest(4.0).unwrap();
            let times: Vec<f64> = with_rest
                .seconds_at_rest
                .iter()
                .flatten()
                .copied()
                .collect();
            assert_eq!((times.len(), times[0]), (102, 2.0 / 102.0));
            assert!(curve.with_rest(0.0).is_none());
        }
    }
}
