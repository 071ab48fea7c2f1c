//! Values of the fields of a scene: reading and writing one by one.

use super::model::{Adhesion, Edges, Material, Move, Numerics, Observer, Roughness, Scene, Solver};
use crate::spectrum::Detrend;
use crate::surface::Form;

/// Value of a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'s> {
    /// An omitted optional field.
    None,
    /// Real number.
    Real(f64),
    /// Whole number.
    Whole(u64),
    /// Pair of whole numbers, first and last.
    Band(u64, u64),
    /// Text.
    Text(&'s str),
    /// List of texts.
    Texts(&'s [String]),
    /// Name of the variant of a choice; empty for a group of fields without variants.
    Choice(&'static str),
    /// Loading stages.
    Legs(&'s [Move]),
    /// Observed quantities.
    Observers(&'s [Observer]),
}

/// Access to one field of a scene; made by [`at!`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Access {
    /// Value in a scene; `None` if the field belongs to an unselected choice.
    pub(super) get: fn(&Scene) -> Option<Value<'_>>,
    /// Sets the field; returns `false`, with the scene unchanged, if the scene or the field has no such value.
    pub(super) set: fn(&mut Scene, Value<'_>) -> bool,
}

impl Access {
    /// Access to nothing, for fields of loading stages, which not every scene has.
    pub(super) const NONE: Access = Access { get: |_| None, set: |_, _| false };
}

/// Row of a field with path and access: of a member of the scene, `at!(numerics.points)`; of a member of a group that
/// is made if missing, `at!(adhesion?.work)`; of a member of a variant, optional or not,
/// `at!(form?, Form::Cone.angle)` and `at!(numerics.solver, Solver::Stepwise.step)`.
macro_rules! at {
    ($group:ident ? . $member:ident) => {
        Field::new(
            concat!(stringify!($group), ".", stringify!($member)),
            None,
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
            },
        )
    };
    ($first:ident $(. $member:ident)*) => {
        Field::new(
            concat!(stringify!($first) $(, ".", stringify!($member))*),
            None,
            Access {
                get: |scene| Some(Part::get(&scene.$first $(.$member)*)),
                set: |scene, value| scene.$first $(.$member)*.set(value),
            },
        )
    };
    ($choice:ident ?, $type:ident :: $variant:ident . $member:ident) => {
        at!(@ $choice, $variant.$member, Some($type::$variant { $member, .. }))
    };
    ($first:ident . $choice:ident, $type:ident :: $variant:ident . $member:ident) => {
        at!(@ $first.$choice, $variant.$member, $type::$variant { $member, .. })
    };
    (@ $first:ident $(. $choice:ident)*, $variant:ident . $member:ident, $pattern:pat) => {
        Field::new(
            concat!(stringify!($first), $(".", stringify!($choice),)* ".", stringify!($member)),
            Some(stringify!($variant)),
            Access {
                get: |scene| match &scene.$first $(.$choice)* {
                    $pattern => Some(Part::get($member)),
                    _ => None,
                },
                set: |scene, value| match &mut scene.$first $(.$choice)* {
                    $pattern => $member.set(value),
                    _ => false,
                },
            },
        )
    };
}
pub(super) use at;

/// A type of the scene's members.
pub(super) trait Part: Sized {
    /// The contained value.
    fn get(&self) -> Value<'_>;
    /// The part with this value; `None` for a value of another kind.
    fn from_value(value: Value<'_>) -> Option<Self>;
    /// Sets a value of the same kind; returns `false` for one of another kind.
    fn set(&mut self, value: Value<'_>) -> bool {
        Self::from_value(value).map(|made| *self = made).is_some()
    }
}

impl<T: Part> Part for Option<T> {
    fn get(&self) -> Value<'_> {
        self.as_ref().map_or(Value::None, Part::get)
    }

    fn from_value(value: Value<'_>) -> Option<Self> {
        if value == Value::None { Some(None) } else { T::from_value(value).map(Some) }
    }
}

/// Types with one kind of value: conversion to the value and from the value. A choice or a group is only read as a
/// whole; its parts are fields of their own.
macro_rules! parts {
    ($($type:ty: $part:ident => $get:expr, $kind:pat => $made:expr;)+) => {$(
        impl Part for $type {
            fn get(&self) -> Value<'_> {
                let $part = self;
                $get
            }
            fn from_value(value: Value<'_>) -> Option<Self> {
                match value {
                    $kind => $made,
                    _ => None,
                }
            }
        }
    )+};
}

parts! {
    f64: part => Value::Real(*part), Value::Real(value) => Some(value);
    u64: part => Value::Whole(*part), Value::Whole(value) => Some(value);
    u32: part => Value::Whole(u64::from(*part)), Value::Whole(value) => value.try_into().ok();
    (u64, u64): part => Value::Band(part.0, part.1), Value::Band(first, last) => Some((first, last));
    bool: part => Value::Choice(if *part { "true" } else { "false" }), Value::Choice(name) => name.parse().ok();
    String: part => Value::Text(part), Value::Text(text) => Some(text.to_owned());
    Vec<String>: part => Value::Texts(part), Value::Texts(texts) => Some(texts.to_vec());
    Vec<Move>: part => Value::Legs(part), Value::Legs(legs) => Some(legs.to_vec());
    Vec<Observer>: part => Value::Observers(part), Value::Observers(observers) => Some(observers.to_vec());
    Form: part => Value::Choice(part.into()), Value::Choice(_) => None;
    Roughness: part => Value::Choice(part.into()), Value::Choice(_) => None;
    Detrend: part => Value::Choice(part.into()), Value::Choice(_) => None;
    Solver: part => Value::Choice(part.into()), Value::Choice(_) => None;
    Edges: part => Value::Choice(part.into()), Value::Choice(_) => None;
    Material: _part => Value::Choice(""), Value::Choice(_) => None;
    Adhesion: _part => Value::Choice(""), Value::Choice(_) => None;
    Numerics: _part => Value::Choice(""), Value::Choice(_) => None;
}
