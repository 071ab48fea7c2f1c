//! The program without the explorer: commands, results, studies, tables for others, and the
//! documentation.

#[path = "../common"]
mod common {
    pub mod deadline;
    pub mod draws;
    pub mod effort;
}
mod cases;
mod claims;
#[cfg(target_os = "linux")]
mod console;
mod cost;
mod documentation;
mod estimates;
mod gallery;
mod generated;
mod length;
mod maps_of_curves;
mod notices;
mod processes;
mod program;
mod python;
#[cfg(target_os = "linux")]
mod results;
mod rounding;
#[cfg(target_os = "linux")]
mod signals;
mod site;
#[cfg(target_os = "linux")]
mod slurm;
mod source;
mod surfaces;
mod sweep;
mod sweep_boundary;
mod sweep_plot;
mod vocabulary;
mod warnings;
