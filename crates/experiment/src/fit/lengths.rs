//! The lengths of a form, such as the radius of a sphere, that a fit can search.

use crate::fit::parameter::{Parameter, Values};
use asperity_surface::Form;

/// Lengths of a form in m. A length that the form does not have is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lengths {
    pub radius: f64,
    pub second_radius: f64,
    pub behind: f64,
}

impl Lengths {
    pub fn of(values: &Values) -> Self {
        Lengths {
            radius: values[Parameter::Radius as usize],
            second_radius: values[Parameter::SecondRadius as usize],
            behind: values[Parameter::Behind as usize],
        }
    }

    pub fn of_form(form: &Form) -> Self {
        let mut lengths = Lengths {
            radius: form.clone().radius_mut().map_or(0.0, |radius| *radius),
            ..Lengths::default()
        };
        if let Some(second) = form.spheres().get(1) {
            lengths.second_radius = second.radius;
            lengths.behind = second.behind;
        }
        lengths
    }

    pub fn put_into(self, form: &mut Form) {
        if let Some(radius) = form.radius_mut() {
            *radius = self.radius;
        }
        if let Form::Spheres(spheres) = form
            && let Some(second) = spheres.get_mut(1)
        {
            second.radius = self.second_radius;
            second.behind = self.behind;
        }
    }

    pub fn put_into_values(self, values: &mut Values) {
        values[Parameter::Radius as usize] = self.radius;
        values[Parameter::SecondRadius as usize] = self.second_radius;
        values[Parameter::Behind as usize] = self.behind;
    }
}
