//! Typed values of fields, in `--set` and in the explorer alike.

use super::field::{FILE_NAME, Field};
use super::quantity::{QuantityError, parse_quantity};
use super::range::Range;
use super::text::{ron_float, ron_string};

/// Integers from here on are not all exact as floating-point numbers.
const MOST_EXACT: f64 = 9.0e15;

impl Field {
    /// The value in RON: a number may have an SI prefix and the unit of the field, `50 mJ/m²` or `16k`. The name of
    /// a file needs no quotes, and as a roughness becomes a measured surface with its equivalent line. Any other
    /// text is unchanged but for surrounding blanks.
    ///
    /// # Errors
    /// Text that begins as a number and continues as another unit, or a number that is too large.
    pub fn read_typed(&self, typed: &str) -> Result<String, QuantityError> {
        let typed = typed.trim();
        if self.path == "roughness" && is_file_name(typed) {
            return Ok(format!("Measured(file: {}, as_line: false)", ron_string(typed)));
        }
        if self.range == FILE_NAME && !(typed.is_empty() || typed == "None" || typed.starts_with('"')) {
            return Ok(ron_string(typed));
        }
        if matches!(self.range, Range::Text { .. }) && self.range != FILE_NAME && !typed.starts_with('"') {
            return Ok(ron_string(typed));
        }
        if !typed.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
            return Ok(typed.to_string());
        }
        match self.range {
            Range::Real(..) if ron::from_str::<f64>(typed).is_err() => {
                parse_quantity(typed, self.unit).map(ron_float)
            }
            // A seed has more digits than a floating-point number keeps.
            Range::Whole(..) | Range::Band(..) if ron::from_str::<u64>(typed).is_err() => {
                let value = parse_quantity(typed, self.unit)?;
                let is_whole = value.fract() == 0.0 && (0.0..MOST_EXACT).contains(&value);
                Ok(if is_whole { format!("{}", value as u64) } else { typed.to_string() })
            }
            _ => Ok(typed.to_string()),
        }
    }
}

/// Returns true for a name with an ending or a folder, unlike any choice of a field.
fn is_file_name(typed: &str) -> bool {
    typed.contains(['.', '/', '\\']) && !typed.contains(['(', '"'])
}

#[cfg(test)]
mod tests {
    use super::super::fields::FIELDS;
    use super::super::fields::field;
    use super::super::strategies::sound_scenes;
    use super::super::tree::Tree;
    use proptest::prelude::*;

    #[test]
    fn numbers_may_have_prefix_and_unit() {
        for row in [
            "adhesion.work|50mJ/m2|0.05",
            "adhesion.work| 50 mN/m |0.05",
            "adhesion.work|5.0e-2|5.0e-2",
            "numerics.points|64Ki|65536",
            "numerics.points|1_024|1_024",
            "numerics.points|1.5|1.5",
            "roughness.seed|18446744073709551616|18446744073709551616",
            "length|-inf|-inf",
            "form.angle|90°|1.5707963267948966",
            "title|\"10 µm\"|\"10 µm\"",
            "roughness|a b/1.txt|Measured(file: \"a b/1.txt\", as_line: false)",
            "roughness|Measured(file: \"a.txt\")|Measured(file: \"a.txt\")",
            "roughness|None|None",
            "roughness.file|7.txt|\"7.txt\"",
            "roughness.opposite|None|None",
        ] {
            let [path, typed, ron] = row.split('|').collect::<Vec<_>>()[..] else { panic!("{row}") };
            assert_eq!(field(path, None).unwrap().read_typed(typed).as_deref(), Ok(ron), "{row}");
        }
        let wrong = field("length", None).unwrap().read_typed("10 kg").unwrap_err();
        assert_eq!(wrong.to_string(), "kg is no length: m, mm, µm, nm");
    }

    proptest! {
        #[test]
        fn values_as_they_are_written_are_left_alone(scene in sound_scenes()) {
            for field in FIELDS {
                if let Some(written) = Tree::of(&scene).written(field) {
                    prop_assert_eq!(field.read_typed(&written), Ok(written), "{}", field.path);
                }
            }
        }
    }
}
