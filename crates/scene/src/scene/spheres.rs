//! The spheres of a form with several contacts: their values by path, and their text.

use super::text::real_in_ron;
use asperity_surface::Sphere;

/// Largest number of spheres of a form.
pub(super) const MOST_SPHERES: usize = 10_000;

/// Names of the values of a sphere.
pub(super) const MEMBERS: [&str; 2] = ["radius", "behind"];

/// A value of one sphere of a form: the index of the sphere, and the name of the value.
pub(super) struct Member<'p> {
    pub(super) sphere: usize,
    pub(super) name: &'p str,
}

impl<'p> Member<'p> {
    /// Returns the value at a path inside the form: `1.radius` is the radius of the second sphere.
    /// Returns `None` for a path that cannot lead to a value of a sphere.
    pub(super) fn inside_form(path: &'p str) -> Option<Self> {
        let (index, name) = path.split_once('.')?;
        let is_number = index.bytes().all(|digit| digit.is_ascii_digit());
        let sphere = index.parse().ok().filter(|_| is_number)?;
        let is_member = sphere < MOST_SPHERES && MEMBERS.contains(&name);
        is_member.then_some(Member { sphere, name })
    }
}

/// Returns the value at a path inside the form, such as `1.radius`.
pub(super) fn number(spheres: &[Sphere], path: &str) -> Option<f64> {
    let member = Member::inside_form(path)?;
    let sphere = spheres.get(member.sphere)?;
    Some(match member.name {
        "radius" => sphere.radius,
        _ => sphere.behind,
    })
}

/// Sets the value at a path inside the form. Returns false if there is no such value.
pub(super) fn set_number(spheres: &mut [Sphere], path: &str, number: f64) -> bool {
    let Some(member) = Member::inside_form(path) else {
        return false;
    };
    let Some(sphere) = spheres.get_mut(member.sphere) else {
        return false;
    };
    match member.name {
        "radius" => sphere.radius = number,
        _ => sphere.behind = number,
    }
    true
}

/// Returns the form with these spheres in RON.
pub(super) fn spheres_in_ron(spheres: &[Sphere]) -> String {
    let mut written = Vec::new();
    for Sphere { radius, behind } in spheres {
        let radius = real_in_ron(*radius);
        written.push(if *behind == 0.0 {
            format!("(radius: {radius})")
        } else {
            format!("(radius: {radius}, behind: {})", real_in_ron(*behind))
        });
    }
    format!("Spheres([{}])", written.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_spheres_have_paths() {
        let sphere = |radius: f64, behind: f64| Sphere { radius, behind };
        let mut spheres = vec![sphere(1.0, 0.0), sphere(2.0, 0.5)];
        for (path, value) in [
            ("0.radius", Some(1.0)),
            ("1.behind", Some(0.5)),
            ("2.radius", None),
            ("1", None),
            ("1.width", None),
            ("+1.radius", None),
            (".radius", None),
            ("10000.radius", None),
        ] {
            assert_eq!(number(&spheres, path), value, "{path}");
            let mut changed = spheres.clone();
            assert_eq!(set_number(&mut changed, path, 3.0), value.is_some());
            assert_eq!(changed == spheres, value.is_none(), "{path}");
        }
        assert!(set_number(&mut spheres, "1.behind", 0.0));
        let text = "Spheres([(radius: 1.0), (radius: 2.0)])";
        assert_eq!(spheres_in_ron(&spheres), text);
    }
}
