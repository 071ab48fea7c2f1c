//! Bytes that an edit of a number costs in a terminal of 24-bit colours at 120 × 36: a frame with
//! the answer of the solver, and a frame with the results of the studies.

use super::common::driver::Driver;
use super::common::script::draw;
use asperity::explorer::action::{Action, Task};
use asperity::explorer::cell_writer::CellWriter;
use asperity::explorer::commands::accuracy::studies;
use asperity::explorer::cursor::LineFeeds;
use asperity::explorer::pen::remove_ink_of_blanks;
use asperity::explorer::theme::Theme;

use asperity::scene::{Document, Simulation, open, presets};
use asperity_plot::Colours;
use ratatui::backend::{Backend, ClearType};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use std::cell::RefCell;
use std::io;
use std::io::Write;
use std::rc::Rc;

const COLUMNS: u16 = 120;
const ROWS: u16 = 36;

/// Bytes around a frame that is shown at once.
const MARKS: usize = 16;

/// Largest number of bytes of an edit of a number, and of a new profile.
const MOST_OF_EDIT: usize = 4_000;
const MOST_OF_PROFILE: usize = 8_000;

/// Rows whose values are no numbers, or give another profile.
const CHOICES: [&str; 4] = ["adhesion", "roughness", "form", "roughness.seed"];

/// Scenes with more springs are left out, because their profiles take long to compute.
const MOST_SPRINGS: u64 = 1 << 16;

/// Bytes that a terminal has received.
#[derive(Clone, Default)]
struct Received(Rc<RefCell<Vec<u8>>>);

impl Write for Received {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// An explorer and the bytes of its frames.
struct Counted {
    driver: Driver,
    writer: CellWriter<Received>,
    received: Received,
    shown: Buffer,
}

impl Counted {
    /// Opens a scene, shows its pull-off, and draws it with the results of all studies.
    fn open(document: Document, theme: Theme) -> Self {
        let mut driver = Driver::open_with(document, Simulation::run, |_| false);
        driver.app.view.appearance.theme = theme;
        driver.app.view.appearance.colours = Colours::TrueColour;
        driver.act(Action::Resize(COLUMNS, ROWS));
        driver.perform(vec![Task::Ask]);
        driver.press("!");
        let received = Received::default();
        let mut writer = CellWriter::new(received.clone(), LineFeeds::KeepColumn);
        writer.clear_region(ClearType::All).unwrap();
        let mut counted = Counted {
            driver,
            writer,
            received,
            shown: Buffer::empty(Rect::new(0, 0, COLUMNS, ROWS)),
        };
        counted.frames();
        counted
    }

    /// Draws a frame. Returns the number of its bytes.
    fn frame(&mut self) -> usize {
        let before = self.received.0.borrow().len();
        let mut screen = draw(&self.driver.app);
        remove_ink_of_blanks(&mut screen);
        let changed = self.shown.diff(&screen);
        self.writer.draw(changed.into_iter()).unwrap();
        self.shown = screen;
        self.received.0.borrow().len() - before + MARKS
    }

    /// Draws the present state, and then the results of the studies. Returns the bytes of both
    /// frames.
    fn frames(&mut self) -> usize {
        let bytes = self.frame();
        for study in studies(&mut self.driver.app) {
            let mut findings = Vec::new();
            study.perform(&mut Simulation::default(), &|| false, &mut |finding| {
                findings.push(finding);
            });
            for finding in findings {
                self.driver.act(Action::Found(finding));
            }
        }
        bytes + self.frame()
    }

    /// Presses a key. Returns the bytes of the frames that follow.
    fn cost_of(&mut self, key: &str) -> usize {
        self.driver.press(key);
        self.frames()
    }

    /// The value of the selected row in the notation of the scene file, without its digits; `None`
    /// if it is no number.
    fn shape_of_value(&self) -> Option<String> {
        let parameter = self.driver.app.edit.parameter()?;
        let written = &parameter.written;
        let is_number = written.contains(|sign: char| sign.is_ascii_digit());
        let is_choice = CHOICES.contains(&parameter.path.as_str());
        (is_number && !is_choice)
            .then(|| written.replace(|sign: char| "0123456789.e-_".contains(sign), ""))
    }

    /// Changes the number of each row by one step and back. Returns the bytes of each edit with the
    /// path of its row and the key.
    fn edits(&mut self, rows: &[&str]) -> Vec<Edit> {
        let mut edits = Vec::new();
        let paths: Vec<String> = self
            .driver
            .app
            .edit
            .parameters
            .iter()
            .map(|parameter| parameter.path.clone())
            .filter(|path| rows.is_empty() || rows.contains(&path.as_str()))
            .collect();
        for path in paths {
            self.driver.select(&path);
            let Some(shape) = self.shape_of_value() else {
                continue;
            };
            self.frames();
            for key in ["l", "h"] {
                let generation = self.driver.app.edit.generation;
                let bytes = self.cost_of(key);
                let is_edit = self.driver.app.edit.generation != generation
                    && self.shape_of_value().as_ref() == Some(&shape)
                    && self.driver.app.solved.is_some();
                if is_edit {
                    let name = format!("{}: {path} {key}", self.driver.app.edit.document.name());
                    edits.push(Edit { name, bytes });
                }
            }
        }
        edits
    }
}

struct Edit {
    name: String,
    bytes: usize,
}

/// Prints the least, the median and the largest number of bytes.
fn print(title: &str, edits: &[Edit]) {
    let mut bytes: Vec<usize> = edits.iter().map(|edit| edit.bytes).collect();
    bytes.sort_unstable();
    if let [least, .., most] = bytes[..] {
        let (count, median) = (bytes.len(), bytes[bytes.len() / 2]);
        println!("{title:22} {count:3} edits: {least:5} {median:5} {most:5}");
    }
}

/// Returns the edits of these rows of a scene, of all rows if there are none, and asserts the bytes
/// of a new profile.
fn edits_of(name: &str, theme: Theme, rows: &[&str]) -> Vec<Edit> {
    let mut counted = Counted::open(open(name).unwrap(), theme);
    let edits = counted.edits(rows);
    print(name, &edits);
    let profile = counted.cost_of("R");
    println!("{name:22} another profile: {profile}");
    assert!(profile <= MOST_OF_PROFILE, "{name}: {profile} bytes");
    edits
}

#[test]
fn an_edit_of_a_number_costs_few_bytes() {
    // In the last two scenes, a step of these rows changes the whole contact.
    let scenes: [(&str, &[&str]); 3] = [
        (
            "pressure-sensitive",
            &[
                "loading.0.0",
                "roughness.rms_height",
                "roughness.hurst",
                "material.youngs_modulus",
                "adhesion.kappa",
            ],
        ),
        (
            "profile-hurst-025",
            &["roughness.rms_height", "material.youngs_modulus"],
        ),
        (
            "elastic-energy-below",
            &["adhesion.elastic_energy_ratio", "length"],
        ),
    ];
    for (scene, rows) in scenes {
        for edit in edits_of(scene, Theme::Dark, rows) {
            assert!(edit.bytes <= MOST_OF_EDIT, "{}: {}", edit.name, edit.bytes);
        }
    }
}

#[test]
#[ignore = "takes a minute; .ci/run runs it"]
fn each_edit_of_a_number_in_each_scene_costs_few_bytes() {
    for theme in [Theme::Dark, Theme::Light] {
        println!("{theme:?}: least, median, most bytes");
        let mut all = Vec::new();
        for preset in presets() {
            let document = open(preset.name).unwrap();
            if document.scene().numerics.points <= MOST_SPRINGS {
                all.extend(edits_of(preset.name, theme, &[]));
            }
        }
        print("all", &all);
        let mut large = 0;
        for edit in all.iter().filter(|edit| edit.bytes > MOST_OF_EDIT) {
            println!("{}: {}", edit.name, edit.bytes);
            large += 1;
        }
        assert_eq!(large, 0, "{large} of {} edits", all.len());
    }
}
