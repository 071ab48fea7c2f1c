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
/// Last mode of the roughness.
pub const LAST_MODE: u64 = POINTS as u64 / 4;
/// Seed of the random phases.
pub const SEED: u64 = 1;
/// Work of adhesion γ in J/m², for which κ is about 8.
pub const WORK_OF_ADHESION: f64 = 5.0e-4;
/// Largest force in N.
pub const FORCE: f64 = 1.0e-5;
/// Number of points of the curve on each loading stage.
pub const SAMPLES: usize = 512;

/// Effects of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// A smooth sphere without adhesion, pressed.
    SmoothPressed,
    /// A rough profile without adhesion, pressed and unloaded.
    RoughLoop,
    /// A rough profile with adhesion, pressed.
    AdhesivePressed,
    /// A rough profile with adhesion, touched and pulled off.
    AdhesiveTouch,
    /// A rough profile with adhesion, pressed and pulled off; also touched and pulled off.
    AdhesiveLoop,
    /// A loop with adhesion, with contact patches and the histogram of heights.
    AdhesiveObserved,
}

/// A scene whose instructions are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// Its effects.
    pub class: Class,
    /// Edge model of its fragments.
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
    /// All cases.
    pub fn all() -> Vec<Case> {
        let edges = [Edges::Grid, Edges::SubCell];
        edges
            .into_iter()
            .flat_map(|edges| Class::ALL.map(|class| Case { class, edges }))
            .collect()
    }

    /// Index among all cases.
    pub fn index(&self) -> usize {
        Case::all()
            .iter()
            .position(|case| case == self)
            .expect("one of all")
    }

    /// Name in words.
    pub fn name(&self) -> String {
        format!("{}, {:?}", self.class.name(), self.edges)
    }

    /// True if the line is rough.
    pub fn is_rough(&self) -> bool {
        self.class != Class::SmoothPressed
    }

    /// True with adhesion.
    pub fn is_adhesive(&self) -> bool {
        !matches!(self.class, Class::SmoothPressed | Class::RoughLoop)
    }

    /// True if a leg unloads.
    pub fn goes_back(&self) -> bool {
        !matches!(self.class, Class::SmoothPressed | Class::AdhesivePressed)
    }

    /// True if fragments and heights are observed.
    pub fn is_observed(&self) -> bool {
        self.class == Class::AdhesiveObserved
    }

    /// The scene as read from a file.
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
            "Fragments, HeightHistogram"
        } else {
            ""
        };
        let text = format!(
            "(version: 1, material: (effective_modulus: {EFFECTIVE_MODULUS:e}), length: {LENGTH:e}, {body}, \
             adhesion: {adhesion}, loading: [{loading}], observe: [{observe}], \
             numerics: (points: {POINTS}, samples: {SAMPLES}, edges: {:?}))",
            self.edges
        );
        Document::parse(&text, "counted").expect("a scene")
    }
}
