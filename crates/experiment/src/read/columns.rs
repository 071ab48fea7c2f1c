//! The columns of a measured curve: which columns hold displacement, force and segment, and in
//! which units.

use crate::read::metadata::Metadata;
use crate::read::names::{
    APPROACH, DISPLACEMENT, FORCE, OF_BODY, QUANTITIES, Quantity, RETRACTION, SEGMENT, TIME,
    direction, letters, names_unit, unit,
};
use crate::read::options::CurveOptions;
use asperity_data::text_table::{TextColumn, is_one_of};
use asperity_data::{Remedy, format_quantity, parse_quantity, shown};
use asperity_surface::files::refused;
use asperity_surface::{Place, SurfaceError};

/// Displacement in m for each row of a file with forces only. It serves as a placeholder until the
/// displacements are computed from the travel of the piezo.
const OF_ROW: f64 = 1e-9;
/// Part of error messages that says which columns are allowed, for columns that are not recognised.
const COLUMNS: &str = "displacement and force by names or numbers of their columns, or four where a retraction is beside its \
    approach";
/// Addition to [`COLUMNS`] in the error message for a file that states neither names nor units.
const UNITS: &str = ", with their units, since the file states none";
/// Beginning of the word by which the options state the column of the time.
const TIME_IS: &str = "time=";
/// Index of the unit of the time among the units that the options state.
const UNIT_OF_TIME: usize = 2;

/// A column of displacements and a column of forces. `places` are the indices of these two columns.
/// `units` are their units, each as the SI value of one unit, such as 1e-9 for nm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub places: [usize; 2],
    pub units: [f64; 2],
}

/// The column of the time of each point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeColumn {
    pub place: usize,
    /// Size of the unit in SI units, such as 1e-3 for ms.
    pub unit: f64,
}

/// The columns of a file that are used.
#[derive(Debug)]
pub(crate) struct Choice {
    /// Columns of displacement and force. There is one pair of columns, or two pairs if approach
    /// and retraction have columns of their own.
    pub pairs: Vec<Pair>,
    pub segment: Option<usize>,
    /// Column of the time. `None` if the file has none whose unit is known, and for approach and
    /// retraction side by side.
    pub time: Option<TimeColumn>,
    /// Travel of the piezo in m, if the file has forces without displacements. The forces are then
    /// evenly spaced over this travel.
    pub ramp: Option<f64>,
    /// Name of the column of displacements if these are displacements of the body, without the
    /// deflection of the instrument; otherwise `None`.
    pub of_body: Option<String>,
    /// Text for the report that describes the chosen columns and their units.
    pub assumed: String,
    /// Sentences for the report about names and units in the file that the options replace.
    pub statements: Vec<String>,
}

/// Information in the header of the file.
#[derive(Clone, Copy)]
pub(crate) struct Stated<'a> {
    pub metadata: &'a Metadata,
    /// True for a file in SI units, whose columns need no unit.
    pub is_si: bool,
}

impl Choice {
    /// Chooses the columns of displacement, force and segment by their names and units.
    ///
    /// # Errors
    /// Returns an error if the names and units do not determine the columns of displacement and
    /// force.
    pub fn new(
        columns: &[TextColumn],
        stated: Stated<'_>,
        options: &CurveOptions,
    ) -> Result<Self, SurfaceError> {
        let table = Table::new(columns, stated, options);
        let ramp = table.ramp()?;
        let Roles { places, segment } = table.roles(ramp)?;

        let mut statements = Vec::new();
        statements.extend(table.overruled_names(&places));
        let mut pairs = Vec::with_capacity(places.len());
        let mut descriptions = Vec::new();
        for &places in &places {
            let mut units = [1.0; 2];
            for (quantity, place) in places.into_iter().enumerate() {
                if quantity == DISPLACEMENT
                    && let Some(ramp) = ramp
                {
                    units[quantity] = OF_ROW;
                    let length = format_quantity(ramp, "m");
                    descriptions.push(format!(
                        "none of the displacement ({length} there and back)"
                    ));
                    continue;
                }
                let unit = table.unit(quantity, place)?;
                units[quantity] = unit.value;
                descriptions.push(format!("{} ({})", table.name(place), unit.description));
                statements.extend(unit.statement);
            }
            pairs.push(Pair { places, units });
        }
        statements.dedup();
        let mut assumed = format!("Columns: {}", descriptions[..2].join(", "));
        if descriptions.len() > 2 {
            let retraction = descriptions[2..].join(", ");
            assumed += &format!(", the retraction in {retraction}");
        }
        let time = table.time(pairs.len())?;
        Ok(Choice {
            of_body: table.displacement_of_body(places[0][DISPLACEMENT]),
            pairs,
            segment,
            time,
            ramp,
            assumed,
            statements,
        })
    }
}

/// Columns by their roles: the displacement and the force, as one pair or as one pair for each of
/// approach and retraction, and the column of the segments.
struct Roles {
    places: Vec<[usize; 2]>,
    segment: Option<usize>,
}

/// Unit of a column.
struct Unit {
    /// SI value that the number 1 in the column means.
    value: f64,
    description: String,
    /// Sentence that names the unit in the file, if an option replaces this unit.
    statement: Option<String>,
}

/// The columns of a file, with everything that determines their roles (displacement, force or
/// segment).
struct Table<'a> {
    columns: &'a [TextColumn],
    named: Vec<Named>,
    stated: Stated<'a>,
    options: &'a CurveOptions,
}

impl<'a> Table<'a> {
    fn new(columns: &'a [TextColumn], stated: Stated<'a>, options: &'a CurveOptions) -> Self {
        Table {
            columns,
            named: columns.iter().map(Named::of).collect(),
            stated,
            options,
        }
    }

    /// Returns the travel of the piezo in m for a file with forces only; `None` for a file with
    /// several columns.
    fn ramp(&self) -> Result<Option<f64>, SurfaceError> {
        if self.columns.len() != 1 {
            return Ok(None);
        }
        let ramp = self.options.ramp.or(self.stated.metadata.ramp);
        if ramp.is_none() {
            let allowed = "a column of displacements too, or the travel of an approach and a retraction over which the forces \
                are spaced";
            let error = refused(Place::File, "one column of numbers", allowed);
            return Err(error.with(Remedy::Ramp));
        }
        Ok(ramp)
    }

    /// Returns the roles of the columns. The options state them, or else they follow from the names
    /// of the columns.
    fn roles(&self, ramp: Option<f64>) -> Result<Roles, SurfaceError> {
        if ramp.is_some() {
            return Ok(self.with_named_segment(vec![[0, 0]]));
        }
        match &self.stated_columns()[..] {
            [] if self.is_pair_in_order() => Ok(self.with_named_segment(vec![[0, 1]])),
            [] => {
                let places = known(&self.named).map_err(|term| {
                    self.wrong(format!("{}: none is known as the {term}", self.listed()))
                })?;
                Ok(self.with_named_segment(places))
            }
            [displacement, force] => {
                let places = [self.place(displacement)?, self.place(force)?];
                Ok(self.with_named_segment(vec![places]))
            }
            [displacement, force, segment] => Ok(Roles {
                places: vec![[self.place(displacement)?, self.place(force)?]],
                segment: Some(self.place(segment)?),
            }),
            [displacement, force, retracted, retracting_force] => {
                let approach = [self.place(displacement)?, self.place(force)?];
                let retraction = [self.place(retracted)?, self.place(retracting_force)?];
                Ok(Roles {
                    places: vec![approach, retraction],
                    segment: None,
                })
            }
            other => Err(self.wrong(format!("{} stated columns", other.len()))),
        }
    }

    /// Returns the columns that the options state, without the column of the time.
    fn stated_columns(&self) -> Vec<&'a str> {
        let columns = self.options.columns.iter().map(String::as_str);
        columns
            .filter(|column| !column.starts_with(TIME_IS))
            .collect()
    }

    /// Returns the column of the time: the one that the options state, or else the one whose name
    /// and unit mean a time. A stated column without a unit is in s.
    fn time(&self, pairs: usize) -> Result<Option<TimeColumn>, SurfaceError> {
        let columns = self.options.columns.iter();
        let stated = columns
            .filter_map(|column| column.strip_prefix(TIME_IS))
            .next_back();
        if pairs > 1 {
            return Ok(None);
        }
        let place = match stated {
            Some(wanted) => Some(self.place(wanted)?),
            None => named_time(&self.named),
        };
        let Some(place) = place else {
            return Ok(None);
        };
        let option = self.options.units.get(UNIT_OF_TIME).map(String::as_str);
        let of_column = self.columns[place].unit.as_deref();
        let of_file = (self.stated.is_si || stated.is_some()).then_some(TIME.si_unit);
        let text = option.or(of_column).or(self.named[place].unit.as_deref());
        let Some(text) = text.or(of_file) else {
            return Ok(None);
        };
        let unit = unit_value(text, TIME.si_unit, option.is_some());
        if unit.is_none() && (stated.is_some() || option.is_some()) {
            let found = format!("{:?} is not a unit of the {}", shown(text), TIME.term);
            let allowed = format!("{}, ms, min and the like", TIME.unit_example);
            return Err(refused(Place::File, found, allowed));
        }
        Ok(unit.map(|unit| TimeColumn { place, unit }))
    }

    /// Returns the roles with these pairs of displacement and force. A column whose name means the
    /// segment is added, unless approach and retraction have separate columns, which need no
    /// segments.
    fn with_named_segment(&self, places: Vec<[usize; 2]>) -> Roles {
        let mut segment = None;
        if places.len() == 1 {
            segment = self.named.iter().position(|column| {
                column.direction.is_none() && is_one_of(&column.quantity_name, SEGMENT)
            });
        }
        Roles { places, segment }
    }

    /// Returns true if the file has two columns whose names do not exclude that the first is the
    /// displacement and the second the force.
    fn is_pair_in_order(&self) -> bool {
        if self.columns.len() != 2 {
            return false;
        }
        self.is_unnamed() || self.is_unknown() && self.options.units.len() == 2
    }

    fn is_unnamed(&self) -> bool {
        self.columns.iter().all(|column| column.name.is_empty())
    }

    /// Returns true if no column has a name that is known for a displacement or a force.
    fn is_unknown(&self) -> bool {
        for column in &self.named {
            for quantity in &QUANTITIES {
                if is_one_of(&column.quantity_name, quantity.names) {
                    return false;
                }
            }
        }
        true
    }

    /// Returns the index of the column that an option states: `wanted` is its name, or its number
    /// counted from 1.
    fn place(&self, wanted: &str) -> Result<usize, SurfaceError> {
        let wanted_letters = letters(wanted);
        if !wanted_letters.is_empty() {
            for (place, column) in self.columns.iter().enumerate() {
                if letters(&column.name) == wanted_letters {
                    return Ok(place);
                }
            }
        }
        match wanted.parse::<usize>() {
            Ok(number) if (1..=self.columns.len()).contains(&number) => Ok(number - 1),
            _ => Err(self.wrong(format!("{}: none is {:?}", self.listed(), shown(wanted)))),
        }
    }

    /// Returns the name of a column, or its number if it has no name.
    fn name(&self, place: usize) -> String {
        match &*self.columns[place].name {
            "" => (place + 1).to_string(),
            name => shown(name),
        }
    }

    /// Returns a list of the columns for an error message.
    fn listed(&self) -> String {
        let count = self.columns.len();
        if self.is_unnamed() {
            return format!("{count} columns without names");
        }
        let mut names = Vec::with_capacity(count);
        for column in self.columns {
            if !column.name.is_empty() {
                names.push(shown(&column.name));
            }
        }
        format!("{count} columns {}", names.join(", "))
    }

    /// Returns a sentence on columns that the options choose as displacement or force although
    /// their names mean something else; `None` if there are no such columns.
    fn overruled_names(&self, places: &[[usize; 2]]) -> Option<String> {
        if self.stated_columns().is_empty() {
            return None;
        }
        let by_name = known(&self.named).ok()?;
        if by_name == places {
            return None;
        }
        let [displacement, force] = by_name[0].map(|place| self.name(place));
        Some(format!(
            "Columns as stated beside the file; by its names they are {displacement} and {force}."
        ))
    }

    /// Returns the name of the column of the displacement if this name means a displacement without
    /// the deflection of the instrument. Returns `None` if the options choose the column by its
    /// number, because the meaning of its name is then ignored.
    fn displacement_of_body(&self, place: usize) -> Option<String> {
        if let Some(typed) = self.stated_columns().first()
            && typed.parse::<usize>().is_ok()
        {
            return None;
        }
        is_one_of(&self.named[place].quantity_name, OF_BODY).then(|| self.name(place))
    }

    /// Returns the error for columns that are not recognised.
    fn wrong(&self, found: String) -> SurfaceError {
        let has_units = !self.options.units.is_empty()
            || self.columns.iter().any(|column| column.unit.is_some());
        if self.is_unnamed() && !has_units {
            let error = refused(Place::File, found, format!("{COLUMNS}{UNITS}"));
            return error.with(Remedy::Columns).with(Remedy::Units);
        }
        refused(Place::File, found, COLUMNS).with(Remedy::Columns)
    }

    /// Returns the unit of the column `place`, which has the quantity with this index in
    /// [`QUANTITIES`]. A unit in the options has precedence over the unit in the file. A deflection
    /// is converted to a force by the stiffness that the file states.
    fn unit(&self, quantity: usize, place: usize) -> Result<Unit, SurfaceError> {
        let Quantity {
            term,
            si_unit,
            unit_example,
            ..
        } = QUANTITIES[quantity];
        let option = self.options.units.get(quantity).map(String::as_str);
        let of_column = self.columns[place].unit.as_deref();
        let of_name = self.named[place].unit.as_deref();
        let of_file = self.stated.is_si.then_some(si_unit);
        let stated = of_column.or(of_name).or(of_file);

        let Some(text) = option.or(stated) else {
            let found = format!("no unit of the {term} is stated");
            let allowed = "units of displacement and force";
            return Err(refused(Place::File, found, allowed).with(Remedy::Units));
        };
        if quantity == FORCE
            && option.is_none()
            && let Some(deflection) = of_deflection(text, self.stated.metadata)
        {
            return deflection;
        }

        let Some(value) = unit_value(text, si_unit, option.is_some()) else {
            let found = format!("{:?} is not a unit of the {term}", shown(text));
            let allowed = format!("{unit_example} and the like, or the value of 1");
            return Err(refused(Place::File, found, allowed).with(Remedy::ForceOfOne));
        };
        let mut statement = None;
        if let (Some(option), Some(stated)) = (option, stated)
            && unit(stated, si_unit) != Some(value)
        {
            statement = Some(format!(
                "Unit of the {term} as stated beside the file: {}; the file states {}.",
                shown(option),
                shown(stated)
            ));
        }
        Ok(Unit {
            value,
            description: shown(text),
            statement,
        })
    }
}

/// Returns the SI value that the number 1 means in the unit `text`; `None` if the unit is of
/// another quantity. A unit from an option may be a multiple of a unit, such as 3.01nN.
fn unit_value(text: &str, si_unit: &str, is_option: bool) -> Option<f64> {
    if is_option && text.starts_with(|first: char| first.is_ascii_digit()) {
        let value = parse_quantity(text, si_unit).ok()?;
        return (value > 0.0).then_some(value);
    }
    unit(text, si_unit)
}

/// Returns the unit of a column that contains deflections (in a unit of length or voltage) instead
/// of forces. Its value is the force in N that corresponds to the number 1 in the column. Returns
/// `None` for another unit.
fn of_deflection(text: &str, metadata: &Metadata) -> Option<Result<Unit, SurfaceError>> {
    let mut factors = String::new();
    let deflection = match unit(text, "m") {
        Some(length) => length,
        None => {
            let voltage = unit(text, "V")?;
            let Some(sensitivity) = metadata.sensitivity else {
                return Some(Err(no_force(text, "sensitivity")));
            };
            factors = format!("{} and ", format_quantity(sensitivity, "m/V"));
            voltage * sensitivity
        }
    };
    let Some((_, stiffness)) = &metadata.stiffness else {
        return Some(Err(no_force(text, "stiffness of the instrument")));
    };
    factors += &format_quantity(*stiffness, "N/m");
    Some(Ok(Unit {
        value: deflection * *stiffness,
        description: format!("{} by {factors}", shown(text)),
        statement: None,
    }))
}

/// Returns the error for a deflection that cannot be converted to a force because the file does not
/// state the property `missing`.
fn no_force(unit: &str, missing: &str) -> SurfaceError {
    let unit = shown(unit);
    let found = format!("the force is a deflection in {unit}, and the file states no {missing}");
    refused(Place::File, found, "the force of 1 in the column").with(Remedy::ForceOfOne)
}

/// Quantity and unit of a column that follow from its name.
#[derive(Clone, Debug)]
struct Named {
    /// Direction of the column, [`APPROACH`] or [`RETRACTION`]; `None` if the name states neither.
    direction: Option<usize>,
    /// Words of the name that state neither a direction nor a unit, reduced to letters and digits.
    quantity_name: String,
    /// Unit among the words of the name, as in `Defl_pN_Ex`.
    unit: Option<String>,
}

impl Named {
    fn of(column: &TextColumn) -> Named {
        let words = column.name.split(|c: char| !c.is_alphanumeric());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        // The first word names the quantity, even if the word looks like a unit.
        let unit_of_name = words.iter().skip(1).copied().find(|word| names_unit(word));

        let mut direction_of_column = None;
        let mut quantity_name = String::new();
        for word in words {
            match direction(word) {
                Some(found) => direction_of_column = direction_of_column.or(Some(found)),
                None if unit_of_name == Some(word) => {}
                None => quantity_name += &letters(word),
            }
        }
        Named {
            direction: direction_of_column,
            quantity_name,
            unit: column.unit.clone().or(unit_of_name.map(str::to_owned)),
        }
    }

    /// Returns the rank of a column of forces by its unit; the smallest rank is preferred. The rank
    /// is 0 for a unit of force or no unit, 1 for a deflection, and 2 for any other unit.
    fn rank(&self) -> usize {
        match self.unit.as_deref() {
            None => 0,
            Some(text) if unit(text, "N").is_some() => 0,
            Some(text) if unit(text, "m").is_some() => 1,
            Some(_) => 2,
        }
    }
}

/// Returns the index of the column whose name means the time; `None` if no name does.
fn named_time(named: &[Named]) -> Option<usize> {
    for name in TIME.names.split(' ') {
        let column = named.iter().position(|column| column.quantity_name == name);
        if column.is_some() {
            return column;
        }
    }
    None
}

/// Returns the indices of the columns of displacement and force that follow from the names of the
/// columns. If approach and retraction have separate columns, the result has two pairs. The error
/// is the name of the quantity for which no column is found.
fn known(named: &[Named]) -> Result<Vec<[usize; 2]>, &'static str> {
    if let Some(approach) = pair_of_direction(named, APPROACH)
        && let Some(retraction) = pair_of_direction(named, RETRACTION)
    {
        return Ok(vec![approach, retraction]);
    }
    let displacement = find_column(named, DISPLACEMENT, None);
    let force = find_column(named, FORCE, None);
    match (displacement, force) {
        (Some(displacement), Some(force)) => Ok(vec![[displacement, force]]),
        // If the file has two columns and the quantity of one is known, the other column is taken
        // for the other quantity.
        (Some(displacement), None) if named.len() == 2 => {
            Ok(vec![[displacement, 1 - displacement]])
        }
        (None, Some(force)) if named.len() == 2 => Ok(vec![[1 - force, force]]),
        (None, _) => Err(QUANTITIES[DISPLACEMENT].term),
        (_, None) => Err(QUANTITIES[FORCE].term),
    }
}

/// Returns the columns of displacement and force of one direction (approach or retraction). Both
/// directions may have the same column of displacements. The name of a column of forces may be the
/// direction alone.
fn pair_of_direction(named: &[Named], direction: usize) -> Option<[usize; 2]> {
    let direction = Some(direction);
    let displacement = find_column(named, DISPLACEMENT, direction)
        .or_else(|| find_column(named, DISPLACEMENT, None))?;
    let force = find_column(named, FORCE, direction)
        .or_else(|| best_column(named, FORCE, direction, ""))?;
    Some([displacement, force])
}

/// Returns the column of a quantity in one direction. If several columns have a name of this
/// quantity, the column whose name comes first in [`Quantity::names`] is returned.
fn find_column(named: &[Named], quantity: usize, direction: Option<usize>) -> Option<usize> {
    for name in QUANTITIES[quantity].names.split(' ') {
        if let Some(place) = best_column(named, quantity, direction, name) {
            return Some(place);
        }
    }
    None
}

/// Returns the first column with this name and direction. Of several columns of forces, the one
/// with the best [`rank`](Named::rank) is returned.
fn best_column(
    named: &[Named],
    quantity: usize,
    direction: Option<usize>,
    name: &str,
) -> Option<usize> {
    let mut best: Option<(usize, usize)> = None;
    for (place, column) in named.iter().enumerate() {
        if column.direction != direction || column.quantity_name != name {
            continue;
        }
        let rank = if quantity == FORCE { column.rank() } else { 0 };
        if best.is_none_or(|(_, best_rank)| rank < best_rank) {
            best = Some((place, rank));
        }
    }
    best.map(|(place, _)| place)
}
