//! The columns of a measured curve: which ones hold displacement, force and segment, and their units.

use crate::options::CurveOptions;
use asperity_data::parse_quantity;
use asperity_surface::Column;
use asperity_surface::{Place, TopographyError, refused, shown};

/// Term, SI unit and example unit of displacement and force, and the names of their columns as letters, preferred names
/// first: the displacement of the instrument before the displacement of the body, which lacks the deflection of the
/// instrument.
const QUANTITIES: [(&str, &str, &str, &[&str]); 2] = [
    (
        "displacement",
        "m",
        "nm",
        &[
            "displacement",
            "heightmeasured",
            "measuredheight",
            "smoothedmeasuredheight",
            "zsense",
            "zsensor",
            "piezo",
            "position",
            "height",
            "distance",
            "heightpiezo",
            "indentation",
            "tipposition",
            "d",
            "z",
            "x",
        ],
    ),
    ("force", "N", "nN", &["force", "load", "vdeflection", "verticaldeflection", "f"]),
];
/// Names of a column with the displacement of the body alone.
const OF_BODY: [&str; 2] = ["indentation", "tipposition"];
/// Words for approach and for retraction in the names of columns side by side.
const DIRECTIONS: [&[&str]; 2] = [
    &["approach", "extend", "extension", "ext", "ex", "trace", "loading", "advance", "forward"],
    &["retraction", "retract", "ret", "rt", "retrace", "withdraw", "unloading", "backward"],
];
/// Option that helps if the columns are not recognised.
const COLUMNS: &str = "--columns DISPLACEMENT,FORCE by names or numbers, such as --columns 1,3, or four where a retraction is \
    beside its approach";

/// Indices of the columns of displacement and force, and the SI values of 1 in these columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub places: [usize; 2],
    pub units: [f64; 2],
}

/// The columns of a file that are used.
#[derive(Debug)]
pub(crate) struct Choice {
    /// One pair, or one for an approach and one for the retraction beside it.
    pub pairs: Vec<Pair>,
    pub segment: Option<usize>,
    /// Sentences on columns that were chosen by name, and on units of the file that the options override.
    pub statements: Vec<String>,
}

impl Choice {
    /// Chooses among columns with these names and units; the columns of a file in SI units need no unit.
    pub fn new(columns: &[Column], is_si: bool, options: &CurveOptions) -> Result<Self, TopographyError> {
        let wrong = |fault: String| refused(Place::File, fault, COLUMNS);
        let count = columns.len();
        let names = columns.iter().map(|column| &*column.name).filter(|name| !name.is_empty());
        let all = format!("{count} columns {}", names.map(shown).collect::<Vec<_>>().join(", "));
        let place = |wanted: &String| {
            let letters = letters(wanted);
            let is_it = |column: &Column| !letters.is_empty() && self::letters(&column.name) == letters;
            let named = columns.iter().position(is_it);
            let number = || wanted.parse().ok().filter(|number| (1..=count).contains(number));
            let place = named.or_else(|| Some(number()? - 1));
            place.ok_or_else(|| wrong(format!("{all}: none is {:?}", shown(wanted))))
        };
        let mut statements = Vec::new();
        let is_unnamed = columns.iter().all(|column| column.name.is_empty());
        let (pairs, segment) = match &options.columns[..] {
            [] if count == 2 && (is_unnamed || are_unknown(columns) && options.units.len() == 2) => {
                (vec![[0, 1]], None)
            }
            [] => {
                let pairs =
                    known(columns).map_err(|term| wrong(format!("{all}: none is known as the {term}")))?;
                let name = |place: usize| shown(&columns[place].name);
                if count > 2 {
                    let mut text = format!("Displacement and force from the columns {}", name(pairs[0][0]));
                    text += &format!(" and {}", name(pairs[0][1]));
                    if let Some(beside) = pairs.get(1) {
                        let [at, force] = beside.map(name);
                        text += &format!(", beside them the retraction from {at} and {force}");
                    }
                    statements.push(text + ".");
                }
                if OF_BODY.contains(&&*letters(&columns[pairs[0][0]].name)) {
                    statements.push(format!(
                        "The column {} is a displacement of the body: the deflection of the instrument is taken off already, \
                         and --set loading_stiffness=None fits it.",
                        name(pairs[0][0])
                    ));
                }
                (pairs, None)
            }
            [at, force] => (vec![[place(at)?, place(force)?]], None),
            [at, force, segment] => (vec![[place(at)?, place(force)?]], Some(place(segment)?)),
            [at, force, back, back_force] => {
                (vec![[place(at)?, place(force)?], [place(back)?, place(back_force)?]], None)
            }
            other => return Err(wrong(format!("--columns with {}", other.len()))),
        };
        let pair = |places: [usize; 2]| {
            let mut units = [1.0; 2];
            for (quantity, place) in places.into_iter().enumerate() {
                let stated = columns[place].unit.as_deref();
                units[quantity] = of_one(quantity, stated, is_si, options, &mut statements)?;
            }
            Ok(Pair { places, units })
        };
        let pairs = pairs.into_iter().map(pair).collect::<Result<_, TopographyError>>()?;
        statements.dedup();
        Ok(Choice { pairs, segment, statements })
    }
}

/// SI value of 1 in a column of a quantity: as the options state, else as the file states.
fn of_one(
    quantity: usize,
    stated: Option<&str>,
    is_si: bool,
    options: &CurveOptions,
    statements: &mut Vec<String>,
) -> Result<f64, TopographyError> {
    let (term, si, example, _) = QUANTITIES[quantity];
    let option = options.units.get(quantity).map(String::as_str);
    let wrong = |fault: String, allowed: &str| refused(Place::File, fault, allowed);
    let text = option.or(stated).or(is_si.then_some(si)).ok_or_else(|| {
        wrong(format!("no unit of the {term} is stated"), "--units nm,nN for displacement and force")
    })?;
    let is_multiple = text.starts_with(|first: char| first.is_ascii_digit());
    let value = if is_multiple && option.is_some() {
        parse_quantity(text, si).ok().filter(|of_one| *of_one > 0.0)
    } else {
        unit(text, si)
    };
    let value = value.ok_or_else(|| {
        wrong(
            format!("{:?} is not a unit of the {term}", shown(text)),
            &format!("{example} and the like, or the value of 1, such as --units nm,3.01nN"),
        )
    })?;
    let file = stated.or(is_si.then_some(si)).filter(|file| unit(file, si) != Some(value));
    if let Some((file, option)) = file.zip(option) {
        let file = shown(file);
        statements.push(format!("Unit of the {term} by --units: {}; the file states {file}.", shown(option)));
    }
    Ok(value)
}

/// Indices of the columns of displacement and force that names identify, twice if approach and retraction are side by side;
/// the error is the term of the quantity that no name identifies.
fn known(columns: &[Column]) -> Result<Vec<[usize; 2]>, &'static str> {
    let words: Vec<_> = columns.iter().map(|column| direction(&column.name)).collect();
    let of = |quantity: usize, direction: Option<usize>| {
        let is = |known: &&str| words.iter().position(|(of, rest)| *of == direction && rest == known);
        QUANTITIES[quantity].3.iter().find_map(is)
    };
    let beside = |of_direction: usize| {
        let displacement = of(0, Some(of_direction)).or_else(|| of(0, None))?;
        Some([displacement, of(1, Some(of_direction))?])
    };
    if let Some(pairs) = beside(0).zip(beside(1)) {
        return Ok(vec![pairs.0, pairs.1]);
    }
    match ([of(0, None), of(1, None)], columns.len()) {
        ([Some(displacement), Some(force)], _) => Ok(vec![[displacement, force]]),
        // Of two columns the other one.
        ([Some(displacement), None], 2) => Ok(vec![[displacement, 1 - displacement]]),
        ([None, Some(force)], 2) => Ok(vec![[1 - force, force]]),
        ([None, _], _) => Err(QUANTITIES[0].0),
        ([_, None], _) => Err(QUANTITIES[1].0),
    }
}

fn are_unknown(columns: &[Column]) -> bool {
    let is_known = |name: &str| QUANTITIES.iter().any(|row| row.3.contains(&&*letters(name)));
    !columns.iter().any(|column| is_known(&column.name))
}

/// The letters of a name in lower case, so that `Z-Sense` and `z_sense` are the same.
fn letters(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Direction that the name of a column states (0 approach, 1 retraction), and the letters of its other words.
fn direction(name: &str) -> (Option<usize>, String) {
    let words: Vec<String> = name.split(|c: char| !c.is_alphanumeric()).map(letters).collect();
    let of = |word: &String| DIRECTIONS.iter().position(|words| words.contains(&&**word));
    let rest: String = words.iter().filter(|word| of(word).is_none()).map(String::as_str).collect();
    (words.iter().find_map(of), rest)
}

/// Returns true for a unit of length or force.
pub(crate) fn is_unit(text: &str) -> bool {
    QUANTITIES.iter().any(|row| unit(text, row.1).is_some())
}

/// A unit of length or force, such as nm, as a number of SI units.
fn unit(text: &str, si: &str) -> Option<f64> {
    parse_quantity(&format!("1 {text}"), si).ok().filter(|_| text.ends_with(si))
}
