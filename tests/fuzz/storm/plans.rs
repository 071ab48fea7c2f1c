//! Plans of studies: read, written and read back.

use super::*;
use asperity::study::{Axis, Changes, Plan, Quantity};

/// Name of a plan in messages.
const NAME: &str = "drawn.ron";

/// Numbers in the range of the quantity of an axis, and a few others.
fn numbers(path: &str) -> BoxedStrategy<f64> {
    let range = FIELDS
        .iter()
        .find(|field| field.path == path)
        .map(|field| field.range);
    let (low, high) = range.and_then(|range| range.ends()).unwrap_or((1e-3, 1e3));
    let least = low.max(high * 1e-12).max(1e-9);
    let inside = (least.ln()..=high.min(least * 1e6).ln()).prop_map(f64::exp);
    let others = vec![low, high, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e308];
    prop_oneof![12 => inside.clone(), 4 => inside.prop_map(f64::round), 1 => prop::sample::select(others)]
        .boxed()
}

/// Axes over the numbers of a scene, derived ones, and a few unknown ones.
fn axis() -> impl Strategy<Value = String> {
    let is_number = |field: &&Field| matches!(field.range, Range::Real(..) | Range::Whole(..));
    let mut paths: Vec<_> = FIELDS
        .iter()
        .filter(is_number)
        .map(|field| field.path)
        .collect();
    paths.extend(Axis::DERIVED);
    paths.extend([
        "roughness.modes.1",
        "roughness.wavelengths.0",
        "loading.0.0",
        "loading.7.0",
        "title",
        "nothing",
    ]);
    prop::sample::select(paths).prop_flat_map(|path| {
        let kind =
            prop_oneof![12 => Just("Logarithmic"), 12 => Just("Linear"), 1 => Just("Quadratic")];
        let count = prop_oneof![20 => 2_u64..5, 1 => 0..u64::MAX];
        let ends = (kind, numbers(path), numbers(path), count).prop_map(
            move |(kind, one, other, count)| {
                let (from, to) = (ron_float(one.min(other)), ron_float(one.max(other)));
                format!("{kind}(path: {path:?}, from: {from}, to: {to}, count: {count})")
            },
        );
        let list = prop::collection::vec(numbers(path), 0..4)
            .prop_map(move |values| format!("List(path: {path:?}, values: {})", list(&values)));
        prop_oneof![ends, list]
    })
}

fn list(values: &[f64]) -> String {
    format!(
        "[{}]",
        values
            .iter()
            .copied()
            .map(ron_float)
            .collect::<Vec<_>>()
            .join(", ")
    )
}

/// Texts of plans on allowed scenes.
fn plans() -> impl Strategy<Value = String> {
    let names: Vec<_> = Quantity::ALL
        .iter()
        .map(|quantity| quantity.name())
        .collect();
    let count = names.len();
    let record = prop::sample::subsequence(names, 1..=count);
    let axes = prop::collection::vec(axis(), 0..3);
    let preloads = prop::option::of(prop::collection::vec(
        (-6.0..1.0_f64).prop_map(f64::exp),
        1..3,
    ));
    let lines = prop_oneof![20 => 1_u64..4, 1 => any::<u64>()];
    let title = "[ -~µκ\u{202e}]{0,12}";
    (quick().documents(), axes, preloads, lines, any::<u64>(), record, title).prop_map(
        |(document, axes, preloads, lines, seed, record, title)| {
            let preloads = preloads.map_or(String::new(), |shares| format!("preloads: {}, ", list(&shares)));
            let lines = if lines == 1 { String::new() } else { format!("profiles: {lines}, seed: {seed}, ") };
            let (title, text, axes, record) =
                (ron_string(&title), document.text(), axes.join(", "), record.join(", "));
            format!("(version: 1, title: {title}, scene: {text}, axes: [{axes}], {preloads}{lines}record: [{record}])")
        },
    )
}

/// An accepted plan is written and read back the same, and each of its cells is an allowed scene;
/// refusals begin with the name of the plan in each line. True if the plan is accepted.
fn assert_plan(text: &str) -> Result<bool, TestCaseError> {
    let plan = match Plan::parse(text, NAME, &Changes::default()) {
        Ok(plan) => plan,
        Err(errors) => {
            let is_message = |line: &str| {
                line.starts_with(NAME)
                    && !line.contains(char::is_control)
                    && line.chars().count() <= 2000
            };
            let errors = errors.to_string();
            prop_assert!(
                !errors.is_empty() && errors.lines().all(is_message),
                "{}",
                errors
            );
            return Ok(false);
        }
    };
    let written = plan.to_ron();
    let read = Plan::parse(&written, NAME, &Changes::default()).ok();
    prop_assert_eq!(read.as_ref(), Some(&plan), "{}", written);
    prop_assert_eq!(
        plan.cells(),
        plan.axes.iter().map(Axis::count).product::<u64>()
    );
    prop_assert!((1..=Plan::MOST_CELLS).contains(&plan.cells()));
    for cell in [0, plan.cells() / 2, plan.cells() - 1] {
        let values = plan.values(cell);
        let is_on_axes = values
            .iter()
            .zip(&plan.axes)
            .all(|(value, axis)| axis.values.contains(value));
        prop_assert!(
            values.len() == plan.axes.len() && is_on_axes,
            "{:?}",
            values
        );
    }
    for scene in (0..plan.cells()).map(|cell| plan.scene_of(cell)) {
        prop_assert!(scene.is_ok(), "{:?}", scene);
    }
    Ok(true)
}

#[test]
fn texts_of_plans() {
    let allowed = std::cell::Cell::new(0);
    proptest!(draws(1000), |(text in plans())| {
        allowed.set(allowed.get() + u32::from(assert_plan(&text)?));
    });
    // A storm of refused plans would prove little.
    assert!(allowed.get() >= 20, "{} plans are allowed", allowed.get());
}
