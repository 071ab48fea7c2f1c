//! The colours of the program: one table for terminals, for pictures of screens and for figures.
//!
//! Amber means that springs are pressed or that the body moves towards the surface, blue that
//! springs are pulled or that the body moves away. No other hue has a meaning in a loop or a
//! profile, so that people with colour blindness can read them.

use crate::colour::{Ink, Lab, Rgb, difference, ink_on, lab};
use ratatui::style::{Color, Modifier, Style};
use std::sync::LazyLock;

/// Colours that a terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Deserialize))]
pub enum Colours {
    /// No colours, only bold, dim and reversed text.
    Plain,
    /// The sixteen colours that the terminal itself chooses.
    Ansi16,
    /// 256 fixed colours, of 8 bits.
    Ansi256,
    /// All colours of red, green and blue, of 24 bits.
    TrueColour,
}

impl Colours {
    /// Returns the colours that a terminal has according to its environment. `variable` returns the
    /// value of an environment variable; a variable without a value counts as missing.
    ///
    /// A connection by SSH usually passes `TERM` but not `COLORTERM`, so that 256 colours are the
    /// usual answer there.
    pub fn of_environment(variable: impl Fn(&str) -> Option<String>) -> Colours {
        let value = |name: &str| variable(name).unwrap_or_default();
        let terminal = value("TERM");
        if !value("NO_COLOR").is_empty() || terminal == "dumb" {
            return Colours::Plain;
        }
        if ["truecolor", "24bit"].contains(&value("COLORTERM").as_str()) {
            return Colours::TrueColour;
        }
        let has_sixteen = matches!(&*terminal, "linux" | "ansi" | "xterm-color")
            || terminal.starts_with("vt")
            || terminal.contains("16color");
        if has_sixteen && !terminal.contains("256color") {
            Colours::Ansi16
        } else {
            Colours::Ansi256
        }
    }
}

/// Background of a terminal or of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Background {
    Dark,
    Light,
    /// The terminal does not state its background. The colours can be read on dark and on light
    /// backgrounds.
    Unknown,
}

impl Background {
    /// Luminances up to which a background is dark, and from which it is light. The colours of the
    /// two themes are chosen for backgrounds outside of this range.
    const DARK_AND_LIGHT: [f64; 2] = [0.06, 0.7];

    /// Returns the kind of a background from its red, green and blue, each from 0 to 1. `Unknown`
    /// for a background of medium brightness.
    pub fn of_colour(colour: [f64; 3]) -> Self {
        let [red, green, blue] = colour.map(|share| share.powf(2.2));
        let luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
        let [dark, light] = Background::DARK_AND_LIGHT;
        if luminance <= dark {
            Background::Dark
        } else if luminance >= light {
            Background::Light
        } else {
            Background::Unknown
        }
    }
}

/// Purpose of a colour, such as the colour of headings or of errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourRole {
    Text,
    /// Axes, frames, the rigid profile and curves in the background.
    Quiet,
    /// Loading, and springs that are pressed.
    Press,
    /// Unloading, and springs that are pulled.
    Pull,
    /// Springs without stress, and the free surface of the elastic body.
    Zero,
    /// Headings and symbols.
    Accent,
    /// Keys, and numbers to which the reader should pay attention.
    Key,
    Error,
    /// Background of the area inside a loop.
    LoopGround,
    /// Background of the rigid body.
    BodyGround,
    /// Background of the selected row.
    SelectionGround,
    /// Background of the area between two quartiles.
    QuartileGround,
}

/// Colour of a role on one background, for each kind of terminal.
#[derive(Clone, Copy)]
struct Swatch {
    rgb: Rgb,
    /// Number of the colour among the 256 fixed colours.
    index: u8,
    /// Colour among the sixteen colours of the terminal. `Reset` is its own colour of text.
    name: Color,
}

/// Colours of a role on a dark, a light and an unknown background. With `None`, a terminal shows
/// its own colour of text, or no ground.
struct Swatches {
    dark: Option<Swatch>,
    light: Option<Swatch>,
    unknown: Option<Swatch>,
}

const fn swatch(rgb: Rgb, index: u8, name: Color) -> Option<Swatch> {
    Some(Swatch { rgb, index, name })
}

impl ColourRole {
    /// Returns the colours of a role: the table of all colours. A test checks that they can be read
    /// and distinguished.
    #[rustfmt::skip]
    const fn swatches(self) -> Swatches {
        use Color::{Blue, Cyan, DarkGray, LightBlue, LightMagenta, LightRed, LightYellow, Magenta, Red, Reset, White};
        match self {
            // A terminal shows text in its own colour, so that only pictures use this row.
            ColourRole::Text => Swatches {
                dark: swatch([222, 226, 233], 254, Reset),
                light: swatch([32, 36, 44], 235, Reset),
                unknown: None,
            },
            ColourRole::Quiet => Swatches {
                dark: swatch([128, 138, 154], 245, DarkGray),
                light: swatch([104, 112, 126], 242, DarkGray),
                unknown: swatch([122, 122, 122], 243, DarkGray),
            },
            // The yellow of most terminals cannot be read on a light background.
            ColourRole::Press => Swatches {
                dark: swatch([245, 166, 60], 215, LightYellow),
                light: swatch([166, 84, 0], 130, Red),
                unknown: swatch([198, 108, 0], 130, LightRed),
            },
            ColourRole::Pull => Swatches {
                dark: swatch([92, 168, 255], 75, LightBlue),
                light: swatch([0, 92, 196], 26, Blue),
                unknown: swatch([44, 122, 224], 33, LightBlue),
            },
            ColourRole::Zero => Swatches {
                dark: swatch([206, 210, 216], 252, White),
                light: swatch([64, 68, 76], 238, Reset),
                unknown: None,
            },
            ColourRole::Accent => Swatches {
                dark: swatch([92, 200, 180], 80, Cyan),
                // The cyan of most terminals cannot be read on a light background.
                light: swatch([0, 116, 100], 30, Reset),
                unknown: swatch([0, 142, 122], 29, Cyan),
            },
            ColourRole::Key => Swatches {
                dark: swatch([240, 214, 110], 221, Reset),
                light: swatch([128, 96, 0], 94, Reset),
                unknown: None,
            },
            ColourRole::Error => Swatches {
                dark: swatch([255, 107, 107], 203, LightRed),
                light: swatch([190, 24, 36], 124, Magenta),
                unknown: swatch([222, 60, 60], 203, LightMagenta),
            },
            ColourRole::LoopGround => Swatches {
                dark: swatch([38, 48, 72], 236, Reset),
                light: swatch([226, 233, 246], 254, Reset),
                unknown: None,
            },
            ColourRole::BodyGround => Swatches {
                dark: swatch([30, 34, 44], 235, Reset),
                light: swatch([240, 242, 246], 255, Reset),
                unknown: None,
            },
            ColourRole::SelectionGround => Swatches {
                dark: swatch([44, 54, 76], 237, Reset),
                light: swatch([214, 224, 244], 254, Reset),
                unknown: None,
            },
            ColourRole::QuartileGround => Swatches {
                dark: swatch([40, 58, 84], 237, Reset),
                light: swatch([208, 222, 246], 189, Reset),
                unknown: None,
            },
        }
    }
}

/// Number of steps from the colour of zero stress to the colour of the largest stress. A screen
/// with few steps has longer runs of one colour than a screen with a ramp, and so fewer bytes.
pub(crate) const STRESS_STEPS: u8 = 4;

/// Numbers among the 256 fixed colours for the first three stress steps; the last step has the
/// colour of [`ColourRole::Press`] or [`ColourRole::Pull`].
struct StressIndices {
    press: [u8; 3],
    pull: [u8; 3],
}

/// Power of the stress to which the share of the full colour is proportional. It is below 1, so
/// that small stresses can be distinguished too.
const STRESS_POWER: f64 = 0.7;

/// Colours that a terminal or a picture uses: they can be shown there, and can be read on its
/// background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Colours that the terminal can show.
    pub colours: Colours,
    pub background: Background,
}

impl Palette {
    /// Colours of figures on paper, which are also the colours of pictures of light screens.
    pub const LIGHT: Palette = Palette {
        colours: Colours::TrueColour,
        background: Background::Light,
    };
    /// Colours of pictures of dark screens.
    pub const DARK: Palette = Palette {
        colours: Colours::TrueColour,
        background: Background::Dark,
    };
    /// Palette of a terminal or a file without colours.
    pub const PLAIN: Palette = Palette {
        colours: Colours::Plain,
        background: Background::Unknown,
    };

    /// Returns the colour of the paper or the screen in a picture.
    pub(crate) const fn paper(self) -> Rgb {
        match self.background {
            Background::Light => [255; 3],
            Background::Dark | Background::Unknown => [0x10, 0x13, 0x1a],
        }
    }

    const fn swatch(self, role: ColourRole) -> Option<Swatch> {
        let swatches = role.swatches();
        match self.background {
            Background::Dark => swatches.dark,
            Background::Light => swatches.light,
            Background::Unknown => swatches.unknown,
        }
    }

    /// Returns the colour of a role in a picture.
    pub(crate) const fn rgb(self, role: ColourRole) -> Rgb {
        match (self.swatch(role), role.swatches().dark) {
            (Some(swatch), _) | (None, Some(swatch)) => swatch.rgb,
            (None, None) => self.paper(),
        }
    }

    /// Returns the colour in which a terminal shows a role. Text has the colour that the user chose
    /// for the terminal.
    pub fn colour(self, role: ColourRole) -> Color {
        match self.swatch(role) {
            Some(swatch) if role != ColourRole::Text => self.shown(swatch),
            _ => Color::Reset,
        }
    }

    fn shown(self, swatch: Swatch) -> Color {
        let [red, green, blue] = swatch.rgb;
        match self.colours {
            Colours::Plain => Color::Reset,
            Colours::Ansi16 => swatch.name,
            Colours::Ansi256 => Color::Indexed(swatch.index),
            Colours::TrueColour => Color::Rgb(red, green, blue),
        }
    }

    /// Returns the background colour with which a terminal shades an area of this role. Returns
    /// `None` for a terminal that shades no areas, because it has too few colours or an unknown
    /// background.
    pub fn ground(self, role: ColourRole) -> Option<Color> {
        if matches!(self.colours, Colours::Plain | Colours::Ansi16) {
            return None;
        }
        Some(self.shown(self.swatch(role)?))
    }

    /// Returns true for a terminal that can show the colour scale of a heat map.
    pub fn has_shades(self) -> bool {
        matches!(self.colours, Colours::Ansi256 | Colours::TrueColour)
    }

    /// Returns the style in which a terminal shows a role. Bold and dim text distinguish the roles
    /// even without colours.
    pub fn style(self, role: ColourRole) -> Style {
        let style = Style::new().fg(self.colour(role));
        match role {
            ColourRole::Key | ColourRole::Error => style.add_modifier(Modifier::BOLD),
            ColourRole::Quiet | ColourRole::Zero if self.colours == Colours::Plain => {
                style.add_modifier(Modifier::DIM)
            }
            _ => style,
        }
    }

    /// Returns the style in which a terminal shows a line, an area or a text with the meaning
    /// `ink`.
    pub fn ink(self, ink: Ink) -> Style {
        let style = self.style(ink.role());
        match ink {
            Ink::Text | Ink::Cursor => style.add_modifier(Modifier::BOLD),
            _ => style,
        }
    }

    /// Returns the colour of a spring in a terminal. `stress` is positive for a pressed spring, and
    /// its absolute value is the share of the largest stress, from 0 to 1.
    pub(crate) fn stress(self, stress: f64) -> Color {
        let step = stress_step(stress);
        let role = ColourRole::of_stress(stress);
        let Some(swatch) = self.swatch(role) else {
            return Color::Reset;
        };
        if step == STRESS_STEPS {
            return self.shown(swatch);
        }
        let indices = self.stress_indices();
        let indices = if role == ColourRole::Press {
            indices.press
        } else {
            indices.pull
        };
        self.shown(Swatch {
            rgb: self.stress_rgb(role, step),
            index: indices[usize::from(step) - 1],
            name: swatch.name,
        })
    }

    const fn stress_indices(self) -> StressIndices {
        match self.background {
            Background::Dark => StressIndices {
                press: [187, 180, 179],
                pull: [153, 110, 75],
            },
            Background::Light => StressIndices {
                press: [247, 137, 94],
                pull: [110, 67, 25],
            },
            Background::Unknown => StressIndices {
                press: [101, 137, 130],
                pull: [67, 67, 68],
            },
        }
    }

    /// Returns the colour of a step from 1 to [`STRESS_STEPS`] between zero stress and a role.
    pub(crate) fn stress_rgb(self, role: ColourRole, step: u8) -> Rgb {
        /// Colour next to zero stress on a light background. It is paler than all stresses, whereas
        /// the dark grey of the free surface would look like the largest stress.
        const PALE: Rgb = [176, 180, 188];
        let zero = match self.background {
            // On an unknown background, springs without stress have the grey that reads everywhere.
            Background::Unknown => self.rgb(ColourRole::Quiet),
            Background::Dark => self.rgb(ColourRole::Zero),
            Background::Light => PALE,
        };
        let full = self.rgb(role);
        let share = f64::from(step) / f64::from(STRESS_STEPS);
        std::array::from_fn(|channel| {
            let from = f64::from(zero[channel]);
            let to = f64::from(full[channel]);
            (from + (to - from) * share).round() as u8
        })
    }

    /// Returns the colour in which a terminal shows a colour of a scale that
    /// [`Palette::has_shades`].
    pub(crate) fn shade(self, colour: Rgb) -> Color {
        let [red, green, blue] = colour;
        match self.colours {
            Colours::Plain | Colours::Ansi16 => Color::Reset,
            Colours::Ansi256 => Color::Indexed(nearest_index(colour)),
            Colours::TrueColour => Color::Rgb(red, green, blue),
        }
    }

    /// Returns the colour of a sign on a shade of a heat map.
    pub(crate) fn ink_on_shade(self, ground: Color) -> Color {
        match ground {
            Color::Rgb(red, green, blue) => self.shade(ink_on([red, green, blue])),
            Color::Indexed(index) if index >= FIRST_FIXED => {
                self.shade(ink_on(fixed_colour(index)))
            }
            _ => Color::Reset,
        }
    }
}

impl ColourRole {
    /// Returns the role of a spring with this stress.
    pub(crate) fn of_stress(stress: f64) -> ColourRole {
        if stress < 0.0 {
            ColourRole::Pull
        } else {
            ColourRole::Press
        }
    }
}

/// Returns the step, from 1 to [`STRESS_STEPS`], of the colour for a stress from -1 to 1.
pub(crate) fn stress_step(stress: f64) -> u8 {
    let share = stress.abs().min(1.0).powf(STRESS_POWER);
    ((share * f64::from(STRESS_STEPS)).ceil() as u8).clamp(1, STRESS_STEPS)
}

/// Returns the largest stress that has the colour of this step, as a share of the largest stress.
pub(crate) fn stress_of_step(step: u8) -> f64 {
    (f64::from(step) / f64::from(STRESS_STEPS)).powf(STRESS_POWER.recip())
}

/// Number of the first of the 256 colours that are the same in all terminals. The colours before it
/// are the sixteen colours that a terminal chooses.
const FIRST_FIXED: u8 = 16;
/// Number of the first grey after the cube of colours.
const FIRST_GREY: u8 = 232;

/// Returns one of the 256 colours: a cube of 6 × 6 × 6 colours, and then 24 greys.
fn fixed_colour(index: u8) -> Rgb {
    /// Levels of each channel in the cube.
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    if index >= FIRST_GREY {
        return [8 + 10 * (index - FIRST_GREY); 3];
    }
    let place = index - FIRST_FIXED;
    [place / 36, place / 6 % 6, place % 6].map(|level| LEVELS[usize::from(level)])
}

/// Returns the number of the most similar of the 256 colours.
fn nearest_index(colour: Rgb) -> u8 {
    /// All fixed colours with their positions in the space of perceived colours.
    static FIXED: LazyLock<Vec<(u8, Lab)>> = LazyLock::new(|| {
        (FIRST_FIXED..=u8::MAX)
            .map(|index| (index, lab(fixed_colour(index))))
            .collect()
    });
    let wanted = lab(colour);
    let mut nearest = FIRST_FIXED;
    let mut least = f64::INFINITY;
    for (index, place) in FIXED.iter() {
        let distance = difference(*place, wanted);
        if distance < least {
            nearest = *index;
            least = distance;
        }
    }
    nearest
}

impl Ink {
    /// Returns the role that determines the colour of a line, an area or a text with this meaning.
    pub fn role(self) -> ColourRole {
        /// Colours of the curves of a figure. Neighbouring colours differ in lightness, so that
        /// they can be distinguished in a print without colours.
        const SERIES: [ColourRole; 5] = [
            ColourRole::Pull,
            ColourRole::Press,
            ColourRole::Text,
            ColourRole::Accent,
            ColourRole::Quiet,
        ];
        match self {
            Ink::Text | Ink::Cursor => ColourRole::Text,
            Ink::Quiet | Ink::Profile | Ink::Kept | Ink::Compared => ColourRole::Quiet,
            Ink::Surface => ColourRole::Zero,
            Ink::Contact => ColourRole::Accent,
            Ink::Press => ColourRole::Press,
            Ink::Pull => ColourRole::Pull,
            Ink::Loop => ColourRole::LoopGround,
            Ink::Body => ColourRole::BodyGround,
            Ink::Series(number) => SERIES[number % SERIES.len()],
        }
    }

    /// Returns true for an area that a terminal shows as the ground of cells, if it can.
    pub(crate) fn is_ground(self) -> bool {
        matches!(self, Ink::Loop | Ink::Body)
    }

    /// Returns the colour, in a figure with a white background, of a line, an area or a text with
    /// this meaning.
    pub fn on_paper(self) -> Rgb {
        Palette::LIGHT.rgb(self.role())
    }
}

#[cfg(test)]
mod tests;
