#![forbid(unsafe_code)]
#![doc = include_str!("../README.md")]

mod boundary;
mod check;
mod cost;
mod curve_map;
mod ensemble;
mod ensemble_fit;
mod event;
mod events;
mod find;
mod fit;
mod fit_parameters;
mod fits;
mod fits_spread;
mod loop_chart;
mod map;
mod measured_face;
mod parameters;
mod preloads;
mod printed_size;
mod provenance;
mod reference;
mod report;
mod reversals;
mod run;
mod scene_figure;
mod scene_spectra;
mod scenes;
mod section;
mod sensitivity;
mod sheet;
mod spectrum_figure;
mod spread;

mod status;
mod study_figure;
mod summary;
mod surface;
mod trust;
mod warnings;
mod words;
mod work_precision;
mod workload;

pub use cost::CostReport;
pub use ensemble_fit::EnsembleFitReport;
pub use event::event;
pub use events::{EventsReport, event_words, events_table, jumps_of_instrument, signed_energy};
pub use find::{AnswerPart, FindReport, found_briefly, found_in_words};
pub use fit::FitReport;
pub use fits::{CurveRow, FitsReport, RowWarning};
pub use loop_chart::{
    ForceLoop, LoopCurve, LoopQuantities, LoopUnits, force_figure, loop_chart, sign,
};
pub use measured_face::{MeasuredFace, SurfaceFile};
pub use parameters::parameter_lines;
pub use preloads::{PreloadReport, distribution, preload_chart, preload_figure, warning};
pub use printed_size::{LEAST_HEIGHT, LEAST_WIDTH, parse_printed_length, printed_pixels};
pub use provenance::{
    check_measured_files, entries, files_provenance, named_from, scene_provenance,
    scenes_provenance, with_warnings,
};
pub use reference::{ReferenceProgress, ReferenceReport, square_loops_words};
pub use report::{Format, Json, Report, alternatives, check_extension, missing_form, write};
pub use reversals::ReversalReport;
pub use run::{PathReport, RunReport};
pub use scene_figure::ContactSets;
pub use scene_spectra::SceneSpectra;
pub use scenes::{ComparedScene, ScenesReport};
pub use section::{LineColumns, Part, Section, SectionContact};
pub use sensitivity::{SensitivityReport, sensitivity_chart, sensitivity_table};
pub use sheet::Sheet;
pub use spectrum_figure::Spectra;
pub use status::{progress_text, status_text};
pub use study_figure::{study_curves, study_figure, study_map};
pub use summary::brief_summary;
pub use surface::{SurfaceReport, measured_adhesion_text};
pub use trust::{SPECTRUM_NOT_COMPUTED, error_rows, theories_briefly, theory_rows};
pub use warnings::{
    counted_record_texts, counted_section, counted_texts, outcome_warnings, warning_texts,
    warnings_section,
};
pub use words::{letter, percent};
pub use work_precision::work_precision;
pub use workload::parts_text;
