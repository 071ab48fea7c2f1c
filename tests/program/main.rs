//! The program without the explorer: commands, results, studies, tables for others, and the documentation.

#[path = "../common"]
mod common {
    pub mod deadline;
    pub mod effort;
}
mod cli;
mod cost;
#[cfg(feature = "parquet")]
mod parquet;
mod program;
mod readme;
mod rounding;
#[cfg(target_os = "linux")]
mod slurm;
mod surfaces;
mod sweep;
mod sweep_boundary;
mod sweep_plot;
mod tables;
