//! Units of positions and heights: what the file states, else what the user states, else a
//! convention.

use super::options::ReadOptions;
use super::unit::Unit;
use crate::error::{Place, SurfaceError, refused};

/// Units that a file states; `None` where it states none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StatedUnits {
    /// Unit of positions along the rows, or of the positions of a profile.
    pub along: Option<Unit>,
    /// Unit of positions between the rows.
    pub between: Option<Unit>,
    pub heights: Option<Unit>,
}

impl StatedUnits {
    pub const METRES: StatedUnits = StatedUnits {
        along: Some(Unit::METRE),
        between: Some(Unit::METRE),
        heights: Some(Unit::METRE),
    };

    /// Creates the units of a file with one unit for all positions.
    pub fn new(positions: Option<Unit>, heights: Option<Unit>) -> Self {
        StatedUnits {
            along: positions,
            between: positions,
            heights,
        }
    }
}

/// The units of a file and the units of the options, from which each quantity has one.
pub(super) struct Units<'a> {
    stated: StatedUnits,
    options: &'a ReadOptions,
    /// Unit of the options that applies to positions whose unit the file states. Another one than
    /// the file states is an error.
    option_of_positions: Option<Unit>,
    /// Unit of the options that applies to the heights.
    option_of_heights: Option<Unit>,
}

impl<'a> Units<'a> {
    /// Decides which of the options apply to what the file states. `has_positions` is true for a
    /// profile with a position of each point.
    pub fn new(stated: StatedUnits, has_positions: bool, options: &'a ReadOptions) -> Self {
        let mut option_of_positions = options.unit;
        let mut option_of_heights = options.height_unit.or(options.unit);
        if options.height_unit.is_none() {
            // An option for what the file does not state contradicts nothing that it states.
            match (stated.along, stated.heights) {
                (None, Some(_)) => option_of_heights = None,
                (Some(_), None) => option_of_positions = None,
                // Distances of a grid are lengths, such as 500 nm, whatever the unit of the
                // heights is.
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

    /// Returns the unit of the distances along (0) or between (1) the rows.
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

    /// Returns the unit of a quantity: as the file states, else as the options state, else by
    /// convention.
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

/// Returns the error of a quantity without a unit. `of_positions` is a unit that the file states
/// for the positions alone.
fn no_unit(quantity: &'static str, of_positions: Option<Unit>) -> SurfaceError {
    SurfaceError::NoUnit {
        place: Place::File,
        quantity,
        unit_of_positions: of_positions.map(|unit| unit.to_string()),
    }
}
