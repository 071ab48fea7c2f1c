//! Units of positions and heights. The unit that the file states is used. If the file states none,
//! the unit in the options is used, or else the unit of a convention.

use super::options::ReadOptions;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};

/// Units that a file states for positions and heights. A unit that the file does not state is
/// `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StatedUnits {
    /// Unit of the positions along the rows of a map, or of the positions of a profile; `None` if
    /// the file states none.
    pub along: Option<Unit>,
    /// Unit of the positions across the rows of a map; `None` if the file states none.
    pub between: Option<Unit>,
    pub heights: Option<Unit>,
}

impl StatedUnits {
    pub const METRES: StatedUnits = StatedUnits {
        along: Some(Unit::METRE),
        between: Some(Unit::METRE),
        heights: Some(Unit::METRE),
    };

    /// Creates the units of a file that states one unit for all its positions.
    pub fn new(positions: Option<Unit>, heights: Option<Unit>) -> Self {
        StatedUnits {
            along: positions,
            between: positions,
            heights,
        }
    }
}

/// The units that a file states, and the options of the user. From both, the unit of each quantity
/// is chosen.
pub(super) struct Units<'a> {
    stated: StatedUnits,
    options: &'a ReadOptions,
    /// Unit in the options with which the unit of the positions in the file is compared; a
    /// difference is an error. `None` if the unit in the options is not meant for the positions.
    option_of_positions: Option<Unit>,
    /// Unit in the options for the heights. It is compared with the unit of the heights in the
    /// file, or used if the file states none. `None` if no unit in the options is meant for the
    /// heights.
    option_of_heights: Option<Unit>,
}

impl<'a> Units<'a> {
    /// Decides to which quantities the units in the options apply. `has_positions` is true for a
    /// profile in which each point has a position.
    pub fn new(stated: StatedUnits, has_positions: bool, options: &'a ReadOptions) -> Self {
        let mut option_of_positions = options.unit;
        let mut option_of_heights = options.height_unit.or(options.unit);
        if options.height_unit.is_none() {
            // If the file states only one of the two units, the unit in the options is meant for
            // the other quantity. It is not compared with the stated unit.
            match (stated.along, stated.heights) {
                (None, Some(_)) => option_of_heights = None,
                (Some(_), None) => option_of_positions = None,
                // A grid has a single distance between points, such as 500 nm. The unit of this
                // distance may differ from the unit of the heights, for which the unit in the
                // options is then meant.
                (Some(_), Some(unit)) => {
                    if !has_positions && options.unit == Some(unit) {
                        option_of_positions = None;
                    }
                }
                (None, None) => {}
            }
        }
        Units {
            stated,
            options,
            option_of_positions,
            option_of_heights,
        }
    }

    pub fn heights(&self) -> Result<Unit, SurfaceError> {
        let stated = self.stated.heights;
        let unit = self.chosen("heights", stated, self.option_of_heights)?;
        unit.ok_or_else(|| no_unit("heights", self.stated.along))
    }

    pub fn positions(&self) -> Result<Unit, SurfaceError> {
        self.lateral("positions", self.stated.along)
    }

    /// Returns the unit of the distances between points: along the rows if `axis` is 0,
    /// perpendicular to the rows if `axis` is 1.
    ///
    /// # Errors
    /// Returns an error if neither the file nor the options state the unit.
    pub fn distances(&self, axis: usize) -> Result<Unit, SurfaceError> {
        let stated = [self.stated.along, self.stated.between];
        self.lateral("distances", stated[axis])
    }

    fn lateral(&self, name: &'static str, stated: Option<Unit>) -> Result<Unit, SurfaceError> {
        let option = match stated {
            Some(_) => self.option_of_positions,
            None => self.options.unit,
        };
        let unit = self.chosen(name, stated, option)?;
        unit.ok_or_else(|| no_unit(name, None))
    }

    /// Returns the unit of a quantity. The unit in the file is used, or else the unit in the
    /// options, or else the unit of the convention.
    fn chosen(
        &self,
        name: &str,
        stated: Option<Unit>,
        option: Option<Unit>,
    ) -> Result<Option<Unit>, SurfaceError> {
        if let (Some(stated), Some(option)) = (stated, option)
            && stated != option
        {
            let found = format!(
                "the file states {stated} as the unit of {name}, the options state {option}"
            );
            return Err(refused(Place::File, found, "the unit of the file, or none"));
        }
        Ok(stated.or(option).or(self.options.convention))
    }
}

/// Returns the error for a quantity whose unit is not stated. `of_positions` is the unit of the
/// positions, if the file states this unit but no unit of the heights.
fn no_unit(quantity: &'static str, of_positions: Option<Unit>) -> SurfaceError {
    SurfaceError::NoUnit {
        place: Place::File,
        quantity,
        unit_of_positions: of_positions.map(|unit| unit.to_string()),
    }
}
