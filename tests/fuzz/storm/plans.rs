//! Plans of studies: read, written and read back, and small ones computed.

use super::*;
use asperity::scene::check;
use asperity::study::{
    Axis, Changes, DERIVED, Folder, MOST_CELLS, Options, Plan, Quantity, Results, Shard, StudyError, merge,
    run,
};

/// Number of plans read.
const PLANS: u32 = 1000;

/// Number of plans computed.
const STUDIES: u32 = 25;

/// Most records of a computed study, and most samples of a curve in it.
const MOST_RECORDS: u64 = 60;
const MOST_SAMPLES: u64 = 1000;

/// Name of a plan in messages.
const NAME: &str = "drawn.ron";

/// Quantities of an axis: the numbers of a scene, derived ones, and a few unknown ones.
fn paths() -> impl Strategy<Value = &'static str> {
    let is_number = |field: &&Field| matches!(field.range, Range::Real(..) | Range::Whole(..));
    let mut paths: Vec<_> = FIELDS.iter().filter(is_number).map(|field| field.path).collect();
    paths.extend(DERIVED);
    paths.extend(["roughness.modes.1", "loading.0.0", "loading.7.0", "title", "nothing"]);
    prop::sample::select(paths)
}

/// Numbers in the range of the quantity of an axis.
fn numbers(path: &str) -> BoxedStrategy<f64> {
    let range = FIELDS.iter().find(|field| field.path == path).map(|field| field.range);
    let (low, high) = match range {
        Some(Range::Real(..) | Range::Whole(..)) => {
            let of = |end: Option<f64>| end.unwrap_or_default();
            let ends = range.and_then(|range| range.ends());
            (of(ends.map(|(least, _)| least)), of(ends.map(|(_, most)| most)))
        }
        _ => (1e-3, 1e3),
    };
    let least = low.max(high * 1e-12).max(1e-9);
    let most = high.min(least * 1e6);
    let inside = (least.ln()..=most.ln()).prop_map(f64::exp);
    prop_oneof![12 => inside.clone(), 4 => inside.prop_map(f64::round), 1 => prop::sample::select(vec![
        low, high, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e308
    ])]
    .boxed()
}

fn axis() -> impl Strategy<Value = String> {
    paths().prop_flat_map(|path| {
        let numbers = numbers(path);
        let ends = prop_oneof![12 => Just("Logarithmic"), 12 => Just("Linear"), 1 => Just("Quadratic")];
        let ends = (ends, numbers.clone(), numbers.clone(), prop_oneof![20 => 2_u64..5, 1 => 0..u64::MAX])
            .prop_map(move |(kind, one, other, count)| {
                let (from, to) = (ron_float(one.min(other)), ron_float(one.max(other)));
                format!("{kind}(path: {path:?}, from: {from}, to: {to}, count: {count})")
            });
        let list = prop::collection::vec(numbers, 0..4)
            .prop_map(move |values| format!("List(path: {path:?}, values: {})", list(values)));
        prop_oneof![ends, list]
    })
}

fn list(values: Vec<f64>) -> String {
    format!("[{}]", values.into_iter().map(ron_float).collect::<Vec<_>>().join(", "))
}

/// Texts of plans on allowed scenes.
fn plans() -> impl Strategy<Value = String> {
    let names: Vec<_> = Quantity::ALL.iter().map(|quantity| quantity.name()).collect();
    let most = names.len();
    let record = prop::sample::subsequence(names, 1..=most);
    let axes = prop::collection::vec(axis(), 0..3);
    let preloads = prop::option::of(prop::collection::vec(-6.0..1.0_f64, 1..3))
        .prop_map(|powers| powers.map(|powers| powers.into_iter().map(f64::exp).collect::<Vec<_>>()));
    let lines = prop_oneof![20 => 1_u64..4, 1 => any::<u64>()];
    let line = "[ -~µκ\u{202e}]{0,12}";
    (quick().documents(), axes, preloads, lines, any::<u64>(), record, line).prop_map(
        |(document, axes, preloads, lines, seed, record, title)| {
            let preloads =
                preloads.map_or_else(String::new, |shares| format!("preloads: {}, ", list(shares)));
            let lines = if lines == 1 { String::new() } else { format!("lines: {lines}, seed: {seed}, ") };
            format!(
                "(version: 1, title: {}, scene: {}, axes: [{}], {preloads}{lines}record: [{}])",
                ron_string(&title),
                document.text(),
                axes.join(", "),
                record.join(", ")
            )
        },
    )
}

/// An accepted plan is written and read back the same, and each of its cells is an allowed scene; refusals begin with
/// the name of the plan in each line.
fn assert_plan(text: &str) -> Result<Option<Plan>, TestCaseError> {
    let plan = match Plan::parse(text, NAME, &Changes::default()) {
        Ok(plan) => plan,
        Err(errors) => {
            prop_assert!(!errors.0.is_empty());
            for line in errors.to_string().lines() {
                prop_assert!(line.starts_with(NAME), "{:?} of {}", line, text);
                prop_assert!(!line.contains(char::is_control), "{:?}", line);
                prop_assert!(line.chars().count() <= 2000, "{}", line);
            }
            return Ok(None);
        }
    };
    let written = plan.to_ron();
    let read = Plan::parse(&written, NAME, &Changes::default());
    prop_assert_eq!(read.as_ref(), Ok(&plan), "{}", written);
    prop_assert_eq!(read.map(|plan| plan.to_ron()), Ok(written));
    prop_assert_eq!(plan.cells(), plan.axes.iter().map(Axis::count).product::<u64>());
    prop_assert!((1..=MOST_CELLS).contains(&plan.cells()));
    prop_assert_eq!(plan.records_in_all(), plan.cells() * plan.lines);
    for cell in [0, plan.cells() / 2, plan.cells() - 1] {
        let values = plan.values(cell);
        prop_assert_eq!(values.len(), plan.axes.len());
        for (value, axis) in values.iter().zip(&plan.axes) {
            prop_assert!(axis.values.contains(value), "{} = {}", axis.path, value);
        }
    }
    for scene in (0..plan.cells()).map(|cell| plan.scene_of(cell)) {
        prop_assert_eq!(scene.map(|scene| check(&scene)), Ok(vec![]));
    }
    Ok(Some(plan))
}

/// True if a study is done in tenths of a second.
fn is_small(plan: &Plan) -> bool {
    let mut scenes = (0..plan.cells()).filter_map(|cell| plan.scene_of(cell).ok());
    plan.records_in_all() <= MOST_RECORDS
        && scenes.all(|scene| scene.numerics.points <= MOST_POINTS && scene.numerics.samples <= MOST_SAMPLES)
}

/// The study is computed and merged, or one of its cells is named with the reason; the merged results read back.
fn assert_study(plan: &Plan) -> Result<(), TestCaseError> {
    let place = tempfile::tempdir().unwrap();
    let fail = |error: StudyError| TestCaseError::fail(error.to_string());
    let folder = match Folder::create(&place.path().join("study"), plan) {
        // Measured files of these names do not exist, and the field is named.
        Err(error) if error.to_string().starts_with("roughness.file = ") => return Ok(()),
        folder => folder.map_err(fail)?,
    };
    match run(&folder, Options { jobs: 1, shard: Shard::WHOLE }, &|| false, &mut |_| ()) {
        Ok(ended) => prop_assert!(ended.is_complete()),
        Err(StudyError::Run { cell, coordinates, .. }) => {
            prop_assert!(cell < plan.cells());
            prop_assert_eq!(coordinates, plan.coordinates(cell));
            return Ok(());
        }
        Err(error) => return Err(fail(error)),
    }
    merge(&folder, false).map_err(fail)?;
    let results = Results::open(folder.path()).map_err(fail)?;
    prop_assert_eq!(results.plan(), plan);
    for cell in 0..plan.cells() {
        prop_assert!(results.is_whole(cell));
        for quantity in &plan.record {
            let Some(estimate) = results.estimate(cell, *quantity) else { continue };
            let (least, most) = estimate.range;
            prop_assert!(least.is_finite() && most.is_finite(), "{:?}", estimate);
            let (low, high) = estimate.interval.unwrap_or((estimate.mean, estimate.mean));
            prop_assert!(low <= estimate.mean && estimate.mean <= high, "{:?}", estimate);
        }
    }
    Ok(())
}

#[test]
fn texts_of_plans() {
    let allowed = std::cell::Cell::new(0);
    proptest!(draws(PLANS), |(text in plans())| {
        allowed.set(allowed.get() + u32::from(assert_plan(&text)?.is_some()));
    });
    // A storm of refused plans would prove little.
    assert!(allowed.get() >= PLANS / 50, "{} plans are allowed", allowed.get());
}

#[test]
fn small_studies() {
    let small = plans().prop_filter_map("a small plan that is allowed", |text| {
        Plan::parse(&text, NAME, &Changes::default()).ok().filter(is_small)
    });
    proptest!(draws(STUDIES), |(plan in small)| assert_study(&plan)?);
}
