//! Values of a scene's fields, read and written one by one.

use super::model::{Adhesion, Edges, Form, Leg, Material, Numerics, Observer, Roughness, Scene, Solver};
use crate::spectrum::Detrend;

/// Value of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'s> {
    /// An optional field that is left out.
    None,
    /// Real number.
    Real(f64),
    /// Whole number.
    Whole(u64),
    /// Pair of whole numbers, first and last.
    Band(u64, u64),
    /// Text.
    Text(&'s str),
    /// Name of the variant of a choice; empty for a group of fields without variants.
    Choice(&'static str),
    /// Loading stages.
    Legs(&'s [Leg]),
    /// Observed quantities.
    Observers(&'s [Observer]),
}

/// Access to one field of a scene; [`at!`] makes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Access {
    /// Value in a scene; `None` where the field belongs to a choice that the scene does not make.
    pub(super) get: fn(&Scene) -> Option<Value<'_>>,
    /// Gives the field a value; `false`, with the scene as it was, where the scene or the field has no such value.
    pub(super) set: fn(&mut Scene, Value<'_>) -> bool,
}

impl Access {
    /// Access to nothing, for what is no field of every scene.
    pub(super) const NONE: Access = Access { get: |_| None, set: |_, _| false };
}

/// Access to a member of the scene: `at!(numerics.points)`; to a member of a group that is made where it is missing:
/// `at!(adhesion?.work)`; to a member of a variant: `at!(form, Some(Form::Cone { angle }) => angle)`.
macro_rules! at {
    ($group:ident ? . $member:ident) => {
        Access {
            get: |scene| scene.$group.as_ref().map(|group| Part::get(&group.$member)),
            set: |scene, value| {
                let mut group = scene.$group.unwrap_or_default();
                let done = group.$member.set(value);
                if done {
                    scene.$group = Some(group);
                }
                done
            },
        }
    };
    ($($member:ident).+) => {
        Access {
            get: |scene| Some(Part::get(&scene.$($member).+)),
            set: |scene, value| scene.$($member).+.set(value),
        }
    };
    ($($member:ident).+, $variant:pat => $value:ident) => {
        Access {
            get: |scene| if let $variant = &scene.$($member).+ { Some(Part::get($value)) } else { None },
            set: |scene, value| if let $variant = &mut scene.$($member).+ { $value.set(value) } else { false },
        }
    };
}
pub(super) use at;

/// A type of the scene's members.
pub(super) trait Part {
    /// The value it holds.
    fn get(&self) -> Value<'_>;
    /// Takes a value of its kind; `false` for one of another kind.
    fn set(&mut self, value: Value<'_>) -> bool;
}

/// Types that hold one kind of value: how it is read, and how it is made of the value.
macro_rules! parts {
    ($($type:ty: $part:ident => $get:expr, $kind:pat => $made:expr;)+) => {$(
        impl Part for $type {
            fn get(&self) -> Value<'_> {
                let $part = self;
                $get
            }
            fn set(&mut self, value: Value<'_>) -> bool {
                let made = match value {
                    $kind => $made,
                    _ => None,
                };
                made.map(|made| *self = made).is_some()
            }
        }
    )+};
}

parts! {
    f64: part => Value::Real(*part), Value::Real(value) => Some(value);
    u64: part => Value::Whole(*part), Value::Whole(value) => Some(value);
    u32: part => Value::Whole(u64::from(*part)), Value::Whole(value) => value.try_into().ok();
    (u64, u64): part => Value::Band(part.0, part.1), Value::Band(first, last) => Some((first, last));
    String: part => Value::Text(part), Value::Text(text) => Some(text.to_string());
    Vec<Leg>: part => Value::Legs(part), Value::Legs(legs) => Some(legs.to_vec());
    Vec<Observer>: part => Value::Observers(part), Value::Observers(observers) => Some(observers.to_vec());
}

impl Part for Option<f64> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        match value {
            Value::None => *self = None,
            Value::Real(value) => *self = Some(value),
            _ => return false,
        }
        true
    }
}

impl Part for Option<u64> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        match value {
            Value::None => *self = None,
            Value::Whole(value) => *self = Some(value),
            _ => return false,
        }
        true
    }
}

impl Part for Option<String> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        match value {
            Value::None => *self = None,
            Value::Text(text) => *self = Some(text.to_owned()),
            _ => return false,
        }
        true
    }
}

impl Part for bool {
    fn get(&self) -> Value<'_> {
        Value::Choice(if *self { "true" } else { "false" })
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        match value {
            Value::Choice("true") => *self = true,
            Value::Choice("false") => *self = false,
            _ => return false,
        }
        true
    }
}

impl Part for Option<bool> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        let mut some = false;
        let is_some = some.set(value);
        if is_some || value == Value::None {
            *self = is_some.then_some(some);
        }
        is_some || value == Value::None
    }
}

/// A choice or group of fields: its parts are fields of their own, and as a whole it is only read.
trait Choice {
    /// Name of the variant; empty for a group.
    fn variant(&self) -> &'static str {
        ""
    }
}

impl<T: Choice> Part for T {
    fn get(&self) -> Value<'_> {
        Value::Choice(self.variant())
    }

    fn set(&mut self, _: Value<'_>) -> bool {
        false
    }
}

impl<T: Choice> Part for Option<T> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn set(&mut self, value: Value<'_>) -> bool {
        let leaves_out = value == Value::None;
        if leaves_out {
            *self = None;
        }
        leaves_out
    }
}

impl Choice for Material {}
impl Choice for Adhesion {}
impl Choice for Numerics {}

impl Choice for Form {
    fn variant(&self) -> &'static str {
        match self {
            Form::Paraboloid { .. } => "Paraboloid",
            Form::Cone { .. } => "Cone",
            Form::Power { .. } => "Power",
            Form::WavySphere { .. } => "WavySphere",
            Form::Punch { .. } => "Punch",
        }
    }
}

impl Choice for Roughness {
    fn variant(&self) -> &'static str {
        match self {
            Roughness::SelfAffine { .. } => "SelfAffine",
            Roughness::Measured { .. } => "Measured",
        }
    }
}

impl Choice for Detrend {
    fn variant(&self) -> &'static str {
        match self {
            Detrend::None => "Nothing",
            Detrend::Mean => "Mean",
            Detrend::Tilt => "Tilt",
            Detrend::Curvature => "Curvature",
        }
    }
}

impl Choice for Solver {
    fn variant(&self) -> &'static str {
        match self {
            Solver::Exact => "Exact",
            Solver::Stepwise { .. } => "Stepwise",
        }
    }
}

impl Choice for Edges {
    fn variant(&self) -> &'static str {
        self.name()
    }
}
