//! Scenes whose instructions are counted.

use asperity_contact::Edges;
use asperity_scene::Document;

/// Number of springs of every profile.
pub const POINTS: usize = 1 << 16;
/// Length L of the profile in m.
pub const LENGTH: f64 = 1.0e-4;
/// Effective modulus E* in Pa.
pub const EFFECTIVE_MODULUS: f64 = 2.7e6;
/// Radius R of the sphere in m.
pub const RADIUS: f64 = 1.0e-3;
/// Hurst exponent H of the roughness.
pub const HURST: f64 = 0.7;
/// Rms height h of the roughness in m.
pub const RMS_HEIGHT: f64 = 1.0e-7;
/// Last mode of the roughness, as the number of waves on the length of the profile.
pub const LAST_MODE: u64 = POINTS as u64 / 4;
/// Seed of the random phases.
pub const SEED: u64 = 1;
/// Work of adhesion γ in J/m², for which κ is about 8.
pub const WORK_OF_ADHESION: f64 = 5.0e-4;
/// Largest force of the loading in N.
pub const FORCE: f64 = 1.0e-5;
/// Number of points of the force curve of each loading stage.
pub const SAMPLES: usize = 512;

/// Kind of a scene: its roughness, its adhesion and its loading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A smooth sphere without adhesion that is pressed.
    SmoothPressed,
    /// A rough profile without adhesion that is pressed and unloaded.
    RoughLoop,
    /// A rough profile with adhesion that is pressed.
    AdhesivePressed,
    /// A rough profile with adhesion that is moved to first touch and pulled off.
    AdhesiveTouch,
    /// A rough profile with adhesion that is pressed and pulled off. Its pull-off force without a
    /// preload is also computed, by a motion to first touch and back to separation.
    AdhesiveLoop,
    /// The same loading as in `AdhesiveLoop`. The contact patches and a histogram of the heights
    /// are recorded as well.
    AdhesiveObserved,
}

/// A scene whose instructions are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// Kind of the scene.
    pub class: Class,
    /// Edge model of the contact patches of the scene.
    pub edges: Edges,
}

impl Class {
    const ALL: [Class; 6] = [
        Class::SmoothPressed,
        Class::RoughLoop,
        Class::AdhesivePressed,
        Class::AdhesiveTouch,
        Class::AdhesiveLoop,
        Class::AdhesiveObserved,
    ];

    fn name(self) -> &'static str {
        match self {
            Class::SmoothPressed => "smooth, pressed",
            Class::RoughLoop => "rough, loop",
            Class::AdhesivePressed => "rough with adhesion, pressed",
            Class::AdhesiveTouch => "rough with adhesion, touch and pull",
            Class::AdhesiveLoop => "rough with adhesion, loop",
            Class::AdhesiveObserved => "the same, observed",
        }
    }
}

impl Case {
    /// Returns all scenes: each kind with each edge model.
    pub fn all() -> Vec<Case> {
        let edges = [Edges::Grid, Edges::SubCell];
        edges
            .into_iter()
            .flat_map(|edges| Class::ALL.map(|class| Case { class, edges }))
            .collect()
    }

    /// Returns the index of this scene in the list [`Case::all`].
    pub fn index(&self) -> usize {
        Case::all()
            .iter()
            .position(|case| case == self)
            .expect("one of all")
    }

    /// Returns the name of the scene in the printed table.
    pub fn name(&self) -> String {
        format!("{}, {:?}", self.class.name(), self.edges)
    }

    /// Returns true if the profile is rough.
    pub fn is_rough(&self) -> bool {
        self.class != Class::SmoothPressed
    }

    /// Returns true if the contact has adhesion.
    pub fn is_adhesive(&self) -> bool {
        !matches!(self.class, Class::SmoothPressed | Class::RoughLoop)
    }

    /// Returns true if a loading stage unloads the body.
    pub fn goes_back(&self) -> bool {
        !matches!(self.class, Class::SmoothPressed | Class::AdhesivePressed)
    }

    /// Returns true if contact patches and heights are recorded.
    pub fn is_observed(&self) -> bool {
        self.class == Class::AdhesiveObserved
    }

    /// Returns the scene as a document, as if it had been read from a file.
    pub fn document(&self) -> Document {
        let body = if self.is_rough() {
            format!(
                "roughness: SelfAffine(hurst: {HURST}, rms_height: {RMS_HEIGHT:e}, modes: (1, {LAST_MODE}), \
                 seed: {SEED})"
            )
        } else {
            format!("form: Paraboloid(radius: {RADIUS:e})")
        };
        let adhesion = if self.is_adhesive() {
            format!("(work: {WORK_OF_ADHESION:e})")
        } else {
            "None".into()
        };
        let loading = match self.class {
            Class::AdhesiveTouch => "ToTouch, ToSeparation".to_string(),
            _ if self.goes_back() => format!("ToForce({FORCE:e}), ToSeparation"),
            _ => format!("ToForce({FORCE:e})"),
        };
        let observe = if self.is_observed() {
            "Patches, HeightHistogram"
        } else {
            ""
        };
        let text = format!(
            "(version: 1, material: (modulus: {EFFECTIVE_MODULUS:e}), length: {LENGTH:e}, {body}, \
             adhesion: {adhesion}, loading: [{loading}], observe: [{observe}], \
             numerics: (points: {POINTS}, samples: {SAMPLES}, edges: {:?}))",
            self.edges
        );
        Document::parse(&text, "counted").expect("a scene")
    }
}
