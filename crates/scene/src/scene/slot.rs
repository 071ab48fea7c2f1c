//! Slots of a scene. A slot is the member of a scene in which the value of a field is stored. The
//! rows of the table of fields refer to slots.

use super::adhesion::Adhesion;
use super::model::{Material, MaterialRelaxation, Numerics, Observer, Roughness, Scene, Solver};
use super::spheres;
use super::stages::StageKind;
use asperity_contact::{Edges, Move};
use asperity_surface::{Detrend, Form, Sphere};

/// Value of a field in a scene. The variant depends on the range of the field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'s> {
    Real(f64),
    Whole(u64),
    Flag(bool),
    Text(&'s str),
    Texts(&'s [String]),
    /// First and last mode, as numbers of waves on the length of the profile.
    Modes(u64, u64),
    /// Longest and shortest wavelength in m.
    Wavelengths(f64, f64),
    /// Name of the selected choice. The values of the choice are separate fields.
    Choice(&'static str),
    /// A group without a name. Its values are separate fields.
    Group,
    Stages(&'s [Move]),
    /// The choice of a form with several spheres.
    Spheres(&'s [Sphere]),
    Observers(&'s [Observer]),
}

impl Value<'_> {
    /// Returns the name of the selected choice; `None` if the value is not a choice.
    pub(super) fn choice(&self) -> Option<&'static str> {
        match self {
            Value::Choice(name) => Some(name),
            Value::Spheres(_) => Some("Spheres"),
            _ => None,
        }
    }

    /// Returns the numerical value at the path `inside` within this value. The empty path means
    /// this value itself, `0` and `1` mean the two values of a pair, `2.0` means the target value
    /// of the third loading stage, and `2.radius` a value of the third sphere. Returns `None` if
    /// the path leads to no number.
    pub(super) fn number(&self, inside: &str) -> Option<f64> {
        match (*self, inside) {
            (Value::Real(number), "") => Some(number),
            (Value::Whole(number), "") => Some(number as f64),
            (Value::Modes(first, _), "0") => Some(first as f64),
            (Value::Modes(_, last), "1") => Some(last as f64),
            (Value::Wavelengths(longest, _), "0") => Some(longest),
            (Value::Wavelengths(_, shortest), "1") => Some(shortest),
            (Value::Stages(stages), inside) => {
                let (_, number) = StageKind::of(stages.get(stage_index(inside)?)?);
                number
            }
            (Value::Spheres(spheres), inside) => spheres::number(spheres, inside),
            _ => None,
        }
    }
}

/// Returns the index of a loading stage from the path of its target value inside the loading: 2 for
/// `2.0`.
fn stage_index(inside: &str) -> Option<usize> {
    inside.strip_suffix(".0")?.parse().ok()
}

/// A slot: the member of a scene that stores the value of a field. An optional slot may be empty,
/// if the scene does not state the value.
pub(super) trait Slot {
    /// Returns the value; `None` if the scene does not state it.
    fn value(&self) -> Option<Value<'_>>;

    /// Sets the numerical value at a path inside this slot; [`Value::number`] describes such paths.
    /// Returns false if the slot has no numerical value at this path.
    fn set_number(&mut self, _inside: &str, _number: f64) -> bool {
        false
    }

    /// Returns a slot with this numerical value, to fill an optional slot that is empty. Returns
    /// `None` for a kind of slot that is never empty, or whose value is not a number.
    fn of_number(_number: f64) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }
}

impl<T: Slot> Slot for Option<T> {
    fn value(&self) -> Option<Value<'_>> {
        self.as_ref()?.value()
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        if let Some(slot) = self {
            return slot.set_number(inside, number);
        }
        if inside.is_empty() {
            *self = T::of_number(number);
        }
        self.is_some()
    }
}

impl Slot for f64 {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Real(*self))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        if !inside.is_empty() {
            return false;
        }
        *self = number;
        true
    }

    fn of_number(number: f64) -> Option<f64> {
        Some(number)
    }
}

impl Slot for u64 {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Whole(*self))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        if !inside.is_empty() {
            return false;
        }
        *self = number as u64;
        true
    }

    fn of_number(number: f64) -> Option<u64> {
        Some(number as u64)
    }
}

impl Slot for u32 {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Whole(u64::from(*self)))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        if !inside.is_empty() {
            return false;
        }
        *self = number as u32;
        true
    }
}

impl Slot for (u64, u64) {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Modes(self.0, self.1))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        match inside {
            "0" => self.0 = number as u64,
            "1" => self.1 = number as u64,
            _ => return false,
        }
        true
    }
}

impl Slot for (f64, f64) {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Wavelengths(self.0, self.1))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        match inside {
            "0" => self.0 = number,
            "1" => self.1 = number,
            _ => return false,
        }
        true
    }
}

impl Slot for Vec<Move> {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Stages(self))
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        let Some(stage) = stage_index(inside).and_then(|index| self.get_mut(index)) else {
            return false;
        };
        let (kind, present) = StageKind::of(stage);
        if present.is_none() {
            return false;
        }
        *stage = (StageKind::ALL[kind].stage)(number);
        true
    }
}

impl Slot for bool {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Flag(*self))
    }
}

impl Slot for String {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Text(self))
    }
}

impl Slot for Vec<String> {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Texts(self))
    }
}

impl Slot for Vec<Observer> {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Observers(self))
    }
}

impl Slot for Form {
    fn value(&self) -> Option<Value<'_>> {
        Some(match self {
            Form::Spheres(spheres) => Value::Spheres(spheres),
            _ => Value::Choice(self.into()),
        })
    }

    fn set_number(&mut self, inside: &str, number: f64) -> bool {
        match self {
            Form::Spheres(spheres) => spheres::set_number(spheres, inside, number),
            _ => false,
        }
    }
}

impl Slot for Roughness {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Choice(self.into()))
    }
}

impl Slot for Detrend {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Choice(self.into()))
    }
}

impl Slot for Solver {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Choice(self.into()))
    }
}

impl Slot for Edges {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Choice(self.name()))
    }
}

impl Slot for Material {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Group)
    }
}

impl Slot for MaterialRelaxation {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Group)
    }
}

impl Slot for Adhesion {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Group)
    }
}

impl Slot for Numerics {
    fn value(&self) -> Option<Value<'_>> {
        Some(Value::Group)
    }
}

/// The slot of a field in any scene, as two functions: one for reading and one for writing. Both
/// functions return `None` if the scene has another choice, such as another form. The macro
/// `place!` makes both functions from one expression.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Choice to which the field belongs, such as `Cone` for an angle; `None` for a field that
    /// every scene has.
    pub(super) choice: Option<&'static str>,
    pub(super) slot: fn(&Scene) -> Option<&dyn Slot>,
    pub(super) slot_mut: fn(&mut Scene) -> Option<&mut dyn Slot>,
}

impl Place {
    /// Place of a parameter that is not a field of a scene, such as the number of a loading stage.
    pub(super) const NOWHERE: Place = Place {
        choice: None,
        slot: |_| None,
        slot_mut: |_| None,
    };

    /// Returns this place, restricted to scenes with the choice `choice`, such as the form `Cone`.
    pub(super) const fn of(self, choice: &'static str) -> Place {
        Place {
            choice: Some(choice),
            ..self
        }
    }
}

/// Makes the [`Place`] of a field. A member that every scene has is written as
/// `place!(numerics.points)`, and a member that only some scenes have as
/// `place!(form, Some(Form::Cone { angle }) => angle)`.
macro_rules! place {
    ($($member:ident).+) => {
        $crate::scene::slot::Place {
            choice: None,
            slot: |scene| Some(&scene.$($member).+),
            slot_mut: |scene| Some(&mut scene.$($member).+),
        }
    };
    ($($group:ident).+, $pattern:pat => $member:ident) => {
        $crate::scene::slot::Place {
            choice: None,
            slot: |scene| match &scene.$($group).+ {
                $pattern => Some($member),
                _ => None,
            },
            slot_mut: |scene| match &mut scene.$($group).+ {
                $pattern => Some($member),
                _ => None,
            },
        }
    };
}
pub(super) use place;
