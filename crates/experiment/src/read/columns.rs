//! The columns of a measured curve: which columns hold displacement, force and segment, and in
//! which units.

use crate::read::metadata::Metadata;
use crate::read::names::{
    OF_BODY, QUANTITIES, SEGMENT, direction, is_one_of, is_unit, letters, unit,
};
use crate::read::options::CurveOptions;
use asperity_data::text_table::TextColumn;
use asperity_data::{format_quantity, parse_quantity, shown};
use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};

/// Displacement per row in m, used before the rows have displacements.
const OF_ROW: f64 = 1e-9;
/// Option that helps if the columns are not recognised.
const COLUMNS: &str = "--columns DISPLACEMENT,FORCE by names or numbers, such as --columns 1,3, or four where a retraction is \
    beside its approach, such as --columns 1,2,1,3";
/// Options that a file without names and units needs in addition to `--columns`.
const UNITS: &str = "; with it --units, such as --units nm,nN, since the file states no units";

/// Indices of the columns of displacement and force, and the SI values of 1 in these columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub places: [usize; 2],
    pub units: [f64; 2],
}

/// The columns of a file that are used.
#[derive(Debug)]
pub(crate) struct Choice {
    /// One pair, or two pairs: one for an approach, one for the retraction beside it.
    pub pairs: Vec<Pair>,
    pub segment: Option<usize>,
    /// Travel of the piezo in m, over which forces without a column of displacements are evenly
    /// spaced.
    pub ramp: Option<f64>,
    /// Name of the column of the displacement, if the column excludes the deflection of the
    /// instrument.
    pub of_body: Option<String>,
    /// The columns with their units, in words.
    pub assumed: String,
    /// Sentences on names and units of the file that the options replace.
    pub statements: Vec<String>,
}

/// Metadata that the file states in its header.
#[derive(Clone, Copy)]
pub(crate) struct Stated<'a> {
    pub metadata: &'a Metadata,
    /// True for a file in SI units, whose columns need no unit.
    pub is_si: bool,
}

impl Choice {
    /// Chooses among columns with these names and units.
    pub fn new(
        columns: &[TextColumn],
        stated: Stated<'_>,
        options: &CurveOptions,
    ) -> Result<Self, SurfaceError> {
        let count = columns.len();
        let is_unnamed = columns.iter().all(|column| column.name.is_empty());
        let has_units =
            !options.units.is_empty() || columns.iter().any(|column| column.unit.is_some());
        let units = if is_unnamed && !has_units { UNITS } else { "" };
        let wrong = |fault: String| refused(Place::File, fault, COLUMNS.to_owned() + units);
        let names = columns
            .iter()
            .map(|column| &*column.name)
            .filter(|name| !name.is_empty());
        let all = match &*names.map(shown).collect::<Vec<_>>().join(", ") {
            "" => format!("{count} columns without names"),
            names => format!("{count} columns {names}"),
        };
        let named: Vec<Named> = columns.iter().map(Named::of).collect();
        let known = known(&named);
        let place = |wanted: &String| {
            let letters = letters(wanted);
            let is_it =
                |column: &TextColumn| !letters.is_empty() && self::letters(&column.name) == letters;
            let found = columns.iter().position(is_it);
            let number = || {
                wanted
                    .parse()
                    .ok()
                    .filter(|number| (1..=count).contains(number))
            };
            let place = found.or_else(|| Some(number()? - 1));
            place.ok_or_else(|| wrong(format!("{all}: none is {:?}", shown(wanted))))
        };
        let is_unknown = !named
            .iter()
            .any(|one| QUANTITIES.iter().any(|row| is_one_of(&one.rest, row.3)));
        let ramp = options.ramp.or(stated.metadata.ramp).filter(|_| count == 1);
        if count == 1 && ramp.is_none() {
            let allowed = "a column of displacements too, or --ramp 500nm for forces of an approach and a retraction over 500 nm";
            return Err(refused(Place::File, "one column of numbers", allowed));
        }
        let (places, mut segment) = match &options.columns[..] {
            _ if ramp.is_some() => (vec![[0, 0]], None),
            [] if count == 2 && (is_unnamed || is_unknown && options.units.len() == 2) => {
                (vec![[0, 1]], None)
            }
            [] => {
                let places = known
                    .clone()
                    .map_err(|term| wrong(format!("{all}: none is known as the {term}")))?;
                (places, None)
            }
            [at, force] => (vec![[place(at)?, place(force)?]], None),
            [at, force, segment] => (vec![[place(at)?, place(force)?]], Some(place(segment)?)),
            [at, force, back, back_force] => (
                vec![
                    [place(at)?, place(force)?],
                    [place(back)?, place(back_force)?],
                ],
                None,
            ),
            other => return Err(wrong(format!("--columns with {}", other.len()))),
        };
        if places.len() == 1 && segment.is_none() {
            let is_segment = |one: &Named| one.direction.is_none() && is_one_of(&one.rest, SEGMENT);
            segment = named.iter().position(is_segment);
        }
        let mut statements = Vec::new();
        let name = |place: usize| match &*columns[place].name {
            "" => (place + 1).to_string(),
            name => shown(name),
        };
        if let (Ok(by_name), false) = (&known, options.columns.is_empty())
            && *by_name != places
        {
            let [at, force] = by_name[0].map(name);
            statements.push(format!(
                "Columns by --columns; by the names of the file they are {at} and {force}."
            ));
        }
        let mut words = Vec::new();
        let mut pair = |places: [usize; 2]| {
            let mut units = [1.0; 2];
            for (quantity, place) in places.into_iter().enumerate() {
                if let Some(ramp) = ramp.filter(|_| quantity == 0) {
                    units[quantity] = OF_ROW;
                    words.push(format!(
                        "none of the displacement ({} there and back)",
                        format_quantity(ramp, "m")
                    ));
                    continue;
                }
                let unit = columns[place]
                    .unit
                    .as_deref()
                    .or(named[place].unit.as_deref());
                let (value, word) = of_one(quantity, unit, stated, options, &mut statements)?;
                units[quantity] = value;
                words.push(format!("{} ({word})", name(place)));
            }
            Ok(Pair { places, units })
        };
        let pairs = places
            .iter()
            .map(|places| pair(*places))
            .collect::<Result<_, SurfaceError>>()?;
        statements.dedup();
        let mut assumed = format!("Columns: {}", words[..2].join(", "));
        if let Some(beside) = words.get(2..).filter(|beside| !beside.is_empty()) {
            assumed += &format!(", the retraction in {}", beside.join(", "));
        }
        // A number in place of the name overrules what the name says.
        let is_by_name = options
            .columns
            .first()
            .is_none_or(|typed| typed.parse::<usize>().is_err());
        let first = places[0][0];
        let of_body = (is_by_name && is_one_of(&named[first].rest, OF_BODY)).then(|| name(first));
        Ok(Choice {
            pairs,
            segment,
            ramp,
            of_body,
            assumed,
            statements,
        })
    }
}

/// Returns the SI value of 1 in a column of a quantity, and the unit in words. The options have
/// precedence over the file. A deflection becomes a force by the stiffness that the file states.
fn of_one(
    quantity: usize,
    stated: Option<&str>,
    file: Stated<'_>,
    options: &CurveOptions,
    statements: &mut Vec<String>,
) -> Result<(f64, String), SurfaceError> {
    let (term, si, example, _) = QUANTITIES[quantity];
    let option = options.units.get(quantity).map(String::as_str);
    let wrong = |fault: String, allowed: &str| refused(Place::File, fault, allowed);
    let text = option
        .or(stated)
        .or(file.is_si.then_some(si))
        .ok_or_else(|| {
            wrong(
                format!("no unit of the {term} is stated"),
                "--units nm,nN for displacement and force",
            )
        })?;
    if quantity == 1
        && option.is_none()
        && let Some(of_one) = of_deflection(text, file.metadata)
    {
        let (value, by) = of_one?;
        return Ok((value, format!("{} by {by}", shown(text))));
    }
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
    let other = stated
        .or(file.is_si.then_some(si))
        .filter(|other| unit(other, si) != Some(value));
    if let Some((other, option)) = other.zip(option) {
        let other = shown(other);
        statements.push(format!(
            "Unit of the {term} by --units: {}; the file states {other}.",
            shown(option)
        ));
    }
    Ok((value, shown(text)))
}

/// Returns the SI value of 1 in a column of a deflection, which is a length or a voltage, and what
/// makes it a force. Returns `None` for another unit.
fn of_deflection(text: &str, metadata: &Metadata) -> Option<Result<(f64, String), SurfaceError>> {
    let (of_length, of_voltage) = (unit(text, "m"), unit(text, "V"));
    let stiffness = metadata.stiffness.as_ref().map(|(_, stiffness)| *stiffness);
    let sensitivity = of_voltage.and(metadata.sensitivity);
    let deflection = of_length.or(of_voltage
        .zip(sensitivity)
        .map(|(volts, sensitivity)| volts * sensitivity));
    let missing = |what: &str| {
        let fault = format!(
            "the force is a deflection in {}, and the file states no {what}",
            shown(text)
        );
        Err(refused(
            Place::File,
            fault,
            "the force of 1 in the column, such as --units nm,3.01nN",
        ))
    };
    Some(match (of_length.or(of_voltage)?, deflection, stiffness) {
        (_, Some(deflection), Some(stiffness)) => {
            let by = sensitivity.map_or_else(String::new, |found| {
                format!("{} and ", format_quantity(found, "m/V"))
            });
            Ok((
                deflection * stiffness,
                format!("{by}{}", format_quantity(stiffness, "N/m")),
            ))
        }
        (_, Some(_), None) => missing("stiffness of the instrument"),
        (_, None, _) => missing("sensitivity"),
    })
}

/// Quantity and unit that follow from the name of a column.
#[derive(Clone, Debug)]
struct Named {
    /// 0 approach, 1 retraction.
    direction: Option<usize>,
    /// Letters of the words that state neither direction nor unit.
    rest: String,
    /// Unit among the words, as in `Defl_pN_Ex`.
    unit: Option<String>,
}

impl Named {
    fn of(column: &TextColumn) -> Named {
        let words: Vec<&str> = column
            .name
            .split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty())
            .collect();
        let is_unit = |word: &&&str| {
            **word == "V"
                || word.chars().count() > 1 && (is_unit(word) || unit(word, "V").is_some())
        };
        let unit = words.iter().skip(1).find(is_unit).copied();
        let rest = words
            .iter()
            .filter(|word| direction(word).is_none() && Some(**word) != unit);
        Named {
            direction: words.iter().find_map(|word| direction(word)),
            rest: rest.map(|word| letters(word)).collect(),
            unit: column.unit.clone().or(unit.map(str::to_owned)),
        }
    }

    /// Rank of the unit: 0 for a force, 1 for a deflection, 2 for any other unit.
    fn rank(&self) -> usize {
        match self.unit.as_deref() {
            None => 0,
            Some(text) if unit(text, "N").is_some() => 0,
            Some(text) if unit(text, "m").is_some() => 1,
            Some(_) => 2,
        }
    }
}

/// Returns the indices of the columns of displacement and force that names identify, twice if
/// approach and retraction are side by side. The error is the name of the quantity that no column
/// names.
fn known(named: &[Named]) -> Result<Vec<[usize; 2]>, &'static str> {
    let of = |quantity: usize, direction: Option<usize>| {
        let is = |known: &str| {
            let fits = |(_, one): &(usize, &Named)| one.direction == direction && one.rest == known;
            let ranked = named.iter().enumerate().filter(fits);
            ranked
                .min_by_key(|(_, one)| if quantity == 1 { one.rank() } else { 0 })
                .map(|(place, _)| place)
        };
        let found = QUANTITIES[quantity].3.split(' ').find_map(is);
        // A column may be named by its direction alone.
        found.or_else(|| direction.filter(|_| quantity == 1).and_then(|_| is("")))
    };
    let beside = |of_direction: usize| {
        let displacement = of(0, Some(of_direction)).or_else(|| of(0, None))?;
        Some([displacement, of(1, Some(of_direction))?])
    };
    if let Some(pairs) = beside(0).zip(beside(1)) {
        return Ok(vec![pairs.0, pairs.1]);
    }
    match ([of(0, None), of(1, None)], named.len()) {
        ([Some(displacement), Some(force)], _) => Ok(vec![[displacement, force]]),
        // Of two columns the other one.
        ([Some(displacement), None], 2) => Ok(vec![[displacement, 1 - displacement]]),
        ([None, Some(force)], 2) => Ok(vec![[1 - force, force]]),
        ([None, _], _) => Err(QUANTITIES[0].0),
        ([_, None], _) => Err(QUANTITIES[1].0),
    }
}
