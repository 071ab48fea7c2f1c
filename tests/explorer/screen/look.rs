//! The part of the line in the profile pane, and the quantities of the curve.

use super::common::deadline::within;
use super::common::driver::Driver;
use super::common::scenes::{rough, smooth, without_adhesion};
use super::{default_scene, mid_retraction, pressed};
use asperity::contact::CurvePoint;
use asperity::explorer::app::Pane;
use asperity::explorer::layout::{Layout, inside};
use asperity::explorer::panel::Under;
use asperity::explorer::panes::{indentation_at, under};
use asperity::explorer::snapshot::Section;
use asperity::scene::{format_quantity, parse_quantity};
use ratatui::layout::Position;

fn profile(driver: &Driver) -> Section {
    driver.app.snapshot.as_ref().unwrap().profile.clone()
}

fn seen(driver: &Driver) -> (usize, usize) {
    let section = profile(driver);
    (section.first, section.springs)
}

#[test]
fn the_profile_is_looked_at_from_near_and_moved_along() {
    within(30, || {
        let mut driver = pressed("Tab");
        assert_eq!((driver.app.view.pane, seen(&driver)), (Pane::Profile, (0, 1024)));
        assert!(driver.text().contains("x to 100 µm"), "{}", driver.text());
        // There is nothing beside the whole line.
        driver.press(") (");
        assert_eq!(seen(&driver), (0, 1024));
        driver.press("+");
        assert_eq!(seen(&driver), (256, 512));
        assert!(driver.text().contains("x from 25 µm to 75 µm of 100 µm"), "{}", driver.text());
        driver.press(")");
        assert_eq!(seen(&driver), (384, 512));
        driver.press("( (");
        assert_eq!(seen(&driver), (128, 512));
        driver.press("( ( ( (");
        assert_eq!(seen(&driver), (0, 512));
        driver.press(") ) ) ) ) ) ) )");
        assert_eq!(seen(&driver), (512, 512));
        driver.press("+ +");
        assert_eq!(seen(&driver).1, 128);
        (0..20).for_each(|_| drop(driver.press("+")));
        assert_eq!(seen(&driver).1, 8);
        driver.press("0");
        assert_eq!(seen(&driver), (0, 1024));
        driver.press("+ -");
        assert_eq!(seen(&driver), (0, 1024));
    });
}

#[test]
fn a_part_of_the_profile_is_that_part() {
    within(30, || {
        let mut driver = pressed("Tab z");
        driver.resize((600, 40));
        let whole = profile(&driver);
        driver.press("+ )");
        let part = profile(&driver);
        assert_eq!(part.level, whole.level);
        // Every column of the whole is the union of the columns of the part above it.
        let place = |section: &Section, column: usize| {
            (section.first as f64 + column as f64 * section.springs as f64 / section.columns.len() as f64)
                as usize
        };
        let mut compared = 0;
        for (column, here) in part.columns.iter().enumerate() {
            let spring = place(&part, column);
            let around = whole.columns.iter().enumerate().filter(|(other, _)| {
                place(&whole, *other) <= spring + 1 && spring <= place(&whole, other + 1) + 1
            });
            let low = around.clone().map(|(_, one)| one.line.0).fold(f64::INFINITY, f64::min);
            let high = around.map(|(_, one)| one.line.1).fold(f64::NEG_INFINITY, f64::max);
            assert!(low <= here.line.0 && here.line.1 <= high, "column {column}");
            compared += 1;
        }
        assert!(compared > 500);
    });
}

#[test]
fn the_profile_follows_the_close_up() {
    within(30, || {
        let mut driver = pressed("w");
        assert!(driver.text().contains("· follows"), "{}", driver.text());
        let mut firsts = Vec::new();
        for _ in 0..6 {
            driver.press("n");
            let close_up = driver.app.snapshot.as_ref().unwrap().close_up.section.clone();
            let (first, springs) = seen(&driver);
            let middle = close_up.first + close_up.springs / 2;
            assert!((first..first + springs).contains(&middle), "{middle} not in {first} + {springs}");
            assert_eq!(springs, 256);
            firsts.push(first);
        }
        firsts.dedup();
        assert!(firsts.len() > 1, "it never moves: {firsts:?}");
        // Manual loading keeps the body in its place.
        driver.press("Tab (");
        let put = seen(&driver);
        driver.press("n n n");
        assert_eq!(seen(&driver), put);
        assert!(!driver.text().contains("· follows"));
        driver.press("w 0");
        assert_eq!(seen(&driver), (0, 1024));
        assert!(!driver.text().contains("· follows"));
    });
}

#[test]
fn the_close_up_is_moved_along_where_the_profile_is_not_chosen() {
    within(30, || {
        let mut driver = pressed("f");
        let first = |driver: &Driver| driver.app.snapshot.as_ref().unwrap().close_up.section.first;
        let before = first(&driver);
        let springs = driver.app.view.look.springs;
        driver.press(")");
        assert_eq!(first(&driver), before + springs / 4);
        driver.press("(");
        assert_eq!(first(&driver), before);
        (0..200).for_each(|_| drop(driver.press("(")));
        assert_eq!(first(&driver), 0);
        (0..200).for_each(|_| drop(driver.press(")")));
        assert_eq!(first(&driver), 1024 - springs);
        assert_eq!(seen(&driver), (0, 1024), "the profile stays");
    });
}

/// The text of the pane of the curve on the whole screen.
fn curve(driver: &mut Driver) -> String {
    driver.press("z");
    let text = driver.text();
    driver.press("z");
    text
}

#[test]
fn the_curve_has_three_views_in_two_units() {
    within(30, || {
        let mut driver = pressed("");
        let outcome = driver.app.solved.clone().unwrap().outcome.clone();
        let largest = |value: fn(&CurvePoint) -> f64| {
            let points = outcome.history.legs.iter().flat_map(|leg| &leg.curve);
            points.map(value).fold(f64::NEG_INFINITY, f64::max)
        };
        let smallest = |value: fn(&CurvePoint) -> f64| {
            let points = outcome.history.legs.iter().flat_map(|leg| &leg.curve);
            points.map(value).fold(f64::INFINITY, f64::min)
        };
        // The label of an axis with its unit, and the end of the axis in that unit.
        let end = |symbol: &str, (low, high): (f64, f64), room: f64, unit: f64, name: &str| {
            let value = (high + room * (high - low)) / unit;
            let shown = format_quantity(value.max(-low / unit), name);
            let prefixed = shown.split_once(' ').map_or("", |(_, unit)| unit);
            let divisor = parse_quantity(&format!("1 {prefixed}"), name).unwrap();
            let label =
                if prefixed.is_empty() { symbol.to_owned() } else { format!("{symbol} ({prefixed})") };
            (label, value / divisor)
        };
        let (d_low, d_high) = (smallest(|point| point.indentation), largest(|point| point.indentation));
        let (f_low, f_high) = (smallest(|point| point.force), largest(|point| point.force));
        let height = outcome.governing.amplitude.unwrap().rms_height;
        let ideal = outcome.ideal_adhesion_force.unwrap();
        let contact = largest(|point| point.contact_length);
        let length = outcome.line.length;
        let fragments = largest(|point| point.fragments as f64);
        let (d, f) = ((d_low, d_high), (f_low, f_high));
        let (l, n) = ((0.0, contact), (0.0, fragments));
        let views = [
            ("Force F(d)", end("d", d, 0.06, 1.0, "m"), end("F", f, 0.08, 1.0, "N")),
            (
                "Force F/F_a,max over d/h",
                end("d/h", d, 0.06, height, "1"),
                end("F/F_a,max", f, 0.08, ideal, "1"),
            ),
            ("Contact length l(F)", end("F", f, 0.06, 1.0, "N"), end("l", l, 0.08, 1.0, "m")),
            (
                "Contact length l/L over F/F_a,max",
                end("F/F_a,max", f, 0.06, ideal, "1"),
                end("l/L", l, 0.08, length, "1"),
            ),
            ("Contact patches n(d)", end("d", d, 0.06, 1.0, "m"), end("n", n, 0.08, 1.0, "1")),
            ("Contact patches n over d/h", end("d/h", d, 0.06, height, "1"), end("n", n, 0.08, 1.0, "1")),
        ];
        for (title, x, y) in views.chunks(2).flatten() {
            let text = curve(&mut driver);
            for expected in [title, x.0.as_str(), y.0.as_str()] {
                assert!(text.contains(expected), "{expected}\n{text}");
            }
            // The highest tick is in the upper half of the axis.
            let number = text.lines().find_map(|row| row.split_once(" ┤")?.0.split_whitespace().last());
            let number: f64 = number.unwrap().trim_start_matches('│').parse().unwrap();
            assert!(number <= y.1 && number >= 0.45 * y.1, "{number} {y:?}\n{text}");
            driver.press("N");
            if driver.app.view.curve.normalised {
                continue;
            }
            driver.press("v");
        }
        assert!(curve(&mut driver).contains("Force F(d)"), "they come round");
        // Without adhesion there is no F_a,max as a unit.
        let mut driver = mid_retraction(without_adhesion());
        driver.press("N");
        let text = curve(&mut driver);
        assert!(text.contains("d/h") && !text.contains("F_a,max"), "{text}");
    });
}

/// The Braille dots of the screen: column and row of each.
fn dots(driver: &Driver) -> Vec<(u16, u16)> {
    const PLACES: [(u16, u16); 8] = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)];
    let screen = driver.screen();
    let mut dots = Vec::new();
    for row in 0..screen.area.height {
        for column in 0..screen.area.width {
            let symbol = screen[(column, row)].symbol().chars().next().unwrap_or(' ');
            let Some(pattern) = (symbol as u32).checked_sub(0x2800).filter(|pattern| *pattern < 256) else {
                continue;
            };
            for (bit, (x, y)) in PLACES.into_iter().enumerate() {
                if pattern & (1 << bit) != 0 {
                    dots.push((2 * column + x, 4 * row + y));
                }
            }
        }
    }
    dots
}

/// The force of a branch at an indentation; 0 beyond its ends.
fn force_at(curve: &[CurvePoint], indentation: f64) -> f64 {
    let between = |pair: &&[CurvePoint]| {
        let (a, b) = (pair[0].indentation, pair[1].indentation);
        a != b && (a.min(b)..=a.max(b)).contains(&indentation)
    };
    curve.windows(2).find(between).map_or(0.0, |pair| {
        let share = (indentation - pair[0].indentation) / (pair[1].indentation - pair[0].indentation);
        pair[0].force + share * (pair[1].force - pair[0].force)
    })
}

#[test]
fn the_loss_is_shaded_inside_the_loop_and_nowhere_else() {
    within(60, || {
        for document in [default_scene(), smooth()] {
            let mut driver = mid_retraction(document);
            driver.press("z");
            let before = dots(&driver);
            let unshaded = driver.screen();
            driver.press("a");
            let energy = driver.app.solved.as_ref().unwrap().outcome.figures.dissipated_energy.unwrap();
            let energy: f64 = format!("{energy:.2e}").parse().unwrap();
            let title = format!("ΔW {}", format_quantity(energy, "J"));
            assert!(driver.text().contains(&title), "{title}\n{}", driver.text());
            let new: Vec<_> = dots(&driver).into_iter().filter(|dot| !before.contains(dot)).collect();
            // In each column every other dot between the branches, so their number follows the distance.
            let area = inside(Layout::of(&driver.app).panes[0].1);
            let legs = driver.app.legs();
            let last = area.right();
            let apart = |column: u16| {
                let cell = Position::new(column, area.y + 5);
                let Some((_, Under::Data(x, _))) = under(&driver.app, cell) else { panic!("{cell}") };
                let at = indentation_at(&driver.app, x).unwrap();
                (force_at(&legs[0].curve, at) - force_at(&legs[1].curve, at)).max(0.0)
            };
            // The first columns are those of the axis.
            let columns: Vec<(f64, f64)> = (area.x + 9..last)
                .map(|column| {
                    let found = new.iter().filter(|(x, _)| x / 2 == column).count() as f64;
                    (found, apart(column))
                })
                .collect();
            let sums = columns.iter().fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
            assert!(sums.0 > 200.0, "{sums:?}");
            let scale = sums.0 / sums.1;
            let mut wrong = 0;
            for (number, (found, apart)) in columns.iter().enumerate() {
                // Dots of the curve itself, a jump within a column and springs that attach or detach one by one make a
                // difference.
                let neighbours = columns[number.saturating_sub(1)..(number + 2).min(columns.len())].iter();
                let (low, high) = neighbours
                    .fold((f64::INFINITY, 0.0_f64), |range, one| (range.0.min(one.1), range.1.max(one.1)));
                let fits = (scale * low - 6.0..=scale * high + 6.0).contains(found);
                wrong += usize::from(!fits);
                assert!(*apart > 0.0 || high > 0.0 || *found <= 2.0, "outside the loop: column {number}");
            }
            assert!(wrong * 20 < columns.len(), "{wrong} of {}: {columns:?} {scale}", columns.len());
            driver.press("a");
            assert_eq!(driver.screen(), unshaded);
        }
        // A loop that is not closed has no dissipated energy yet.
        let mut driver = Driver::start(rough().set("loading", "[ToForce(1.0e-5)]").unwrap());
        driver.press("a");
        assert!(driver.text().contains("ΔW open"), "{}", driver.text());
    });
}

#[test]
fn marked_forces_are_stated_with_their_values() {
    within(30, || {
        let labelled = |force: f64| format_quantity(format!("{force:.2e}").parse().unwrap(), "N");
        let mut driver = mid_retraction(smooth());
        let text = curve(&mut driver);
        let legs = driver.app.legs();
        for expected in [
            format!("▲ preload {}", labelled(legs[0].largest.force)),
            format!("▼ pull-off {}", labelled(legs[1].smallest.force)),
        ] {
            assert!(text.contains(&expected), "{expected}\n{text}");
        }
        // The glyphs are on the curve as well.
        for glyph in ['▲', '▼'] {
            assert_eq!(text.matches(glyph).count(), 2, "{glyph}\n{text}");
        }
        let mut driver = mid_retraction(without_adhesion());
        let text = curve(&mut driver);
        assert!(text.contains("▲ preload") && !text.contains('▼') && !text.contains('◇'), "{text}");
    });
}

/// The number in superscript digits.
fn exponent(digits: std::str::Chars<'_>) -> Option<i32> {
    let digit = |c| {
        Some(if c == '⁻' {
            '-'
        } else {
            char::from_digit("⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|one| one == c)? as u32, 10)?
        })
    };
    digits.map(digit).collect::<Option<String>>()?.parse().ok()
}

/// Numbers on the scale beside the plot of a pane, from the top.
fn scale(driver: &Driver, pane: Pane) -> Vec<f64> {
    let area = inside(Layout::of(&driver.app).pane(pane).unwrap());
    let screen = driver.screen();
    let row = |y| (area.x..area.right()).map(|x| screen[(x, y)].symbol()).collect::<String>();
    let number = |y| {
        let row = row(y);
        let text = row.split_once(" ┤")?.0.trim();
        let power =
            text.strip_prefix("10").and_then(|digits| exponent(digits.chars())).map(|at| 10_f64.powi(at));
        power.or_else(|| text.parse().ok())
    };
    (area.y..area.bottom()).filter_map(number).collect()
}

#[test]
fn profile_and_close_up_have_scales_of_position_and_height() {
    within(30, || {
        let mut driver = pressed("b");
        for size in [(120, 40), (80, 24)] {
            driver.resize(size);
            for (pane, section) in [
                (Pane::Profile, profile(&driver)),
                (Pane::CloseUp, driver.app.snapshot.as_ref().unwrap().close_up.section.clone()),
            ] {
                // In nm, as in the frame.
                let numbers = scale(&driver, pane);
                assert!(numbers.len() >= 2, "{pane:?} {size:?}\n{}", driver.text());
                let (low, high) = section.heights;
                let inside = |number: &f64| (1.2e9 * low..=1.2e9 * high.max(section.level)).contains(number);
                assert!(numbers.iter().all(inside), "{numbers:?} {low} {high}");
                let rows = driver.rows();
                let area = Layout::of(&driver.app).pane(pane).unwrap();
                let text = |row: u16| -> String {
                    let columns = rows[usize::from(row)].chars().skip(usize::from(area.x));
                    columns.take(usize::from(area.width)).collect()
                };
                let frame = text(area.bottom() - 1);
                assert!(frame.contains("z (nm)") && frame.contains("profile"), "{frame}");
                let below = (area.y..area.bottom()).map(text).find(|row| row.contains("x (µm)"));
                let below = below.unwrap_or_else(|| panic!("{pane:?}\n{}", driver.text()));
                let marked = |word: &str| word.parse::<f64>().ok().map(|x| 1e-6 * x);
                let positions: Vec<f64> = below.split_whitespace().filter_map(marked).collect();
                let spacing = driver.app.snapshot.as_ref().unwrap().line.spacing;
                let ends = [section.first, section.first + section.springs].map(|at| at as f64 * spacing);
                let within = |x: &&f64| (ends[0] - 1e-12..=ends[1] + 1e-12).contains(*x);
                // The last ones are those of the histogram.
                assert!(positions.iter().filter(within).count() >= 2, "{below}");
            }
        }
    });
}

#[test]
fn marks_have_names_where_there_is_room() {
    within(30, || {
        let mut driver = mid_retraction(smooth());
        driver.press("z");
        let rows = driver.rows();
        for (glyph, name) in [('▲', "preload"), ('▼', "pull-off")] {
            let plot = &rows[5..37];
            let at = plot.iter().position(|row| row.contains(glyph)).unwrap();
            let near = plot[at.saturating_sub(1)..(at + 2).min(plot.len())].join("\n");
            assert!(near.contains(name), "{name}\n{}", driver.text());
        }
        for size in [(120, 40), (80, 24), (60, 20)] {
            driver = mid_retraction(default_scene());
            driver.resize(size);
            let text = driver.text();
            assert!(["preload ▲", "pull-off ▼"].iter().any(|named| text.contains(named)), "{text}");
        }
    });
}
