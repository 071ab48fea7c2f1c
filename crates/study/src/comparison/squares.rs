//! Results of a comparison on random square surfaces in three dimensions, and the memory and time
//! that they take.

use crate::comparison::lines::OwnLoading;
use crate::comparison::settings::Comparison;
use crate::error::StudyError;
use crate::profiles::on_threads_received;
use crate::reference::{ReferenceEvent, ReferenceOptions};
use crate::reference_time::{LEAST_CELLS, SquareTime, check_time};
use crate::spatial::{Loads, SquareLoading, Watch};
use asperity_data::{Control, check_room, memory_size};
use std::sync::mpsc::Sender;
use std::time::Instant;

/// Result of a random square surface. `coarse` is the result of the same surface on a coarser grid,
/// if it is computed.
pub(super) struct SquareResult {
    pub fine: Loads,
    pub coarse: Option<Loads>,
    /// Computing time in s of the surface on the finer grid.
    pub seconds: f64,
}

impl SquareResult {
    /// Returns the event that reports this surface: its force over the indentation, and the number
    /// by which it is compared with profiles.
    fn event(&self, loading: &SquareLoading) -> ReferenceEvent {
        let mut curve = Vec::new();
        match &self.fine.pulling {
            Some(pulling) => curve.clone_from(&pulling.curve),
            None => {
                for (pressing, force) in self.fine.pressings.iter().zip(&loading.forces) {
                    curve.push((pressing.indentation, *force));
                }
            }
        }
        ReferenceEvent::Square {
            curve,
            headline: self.fine.headline().unwrap_or(f64::NAN),
        }
    }
}

impl Comparison<'_> {
    pub fn bytes_of_square(&self) -> u64 {
        self.resolved.body.bytes(self.options.cells)
    }

    /// Returns the largest number of threads whose square surfaces fit into the memory at the same
    /// time.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice for a single square surface.
    pub fn threads_for_squares(&self) -> Result<usize, StudyError> {
        let bytes = self.bytes_of_square();
        let surfaces = usize::try_from(self.options.surfaces).unwrap_or(usize::MAX);
        for threads in (1..=self.threads.clamp(1, surfaces)).rev() {
            if check_room(bytes.saturating_mul(threads as u64)).is_ok() {
                return Ok(threads);
            }
        }
        let place = format!("{} cells", self.options.cells);
        let found = format!(
            "not enough memory for the {} of a square",
            memory_size(bytes)
        );
        Err(StudyError::refused(
            Some(&place),
            found,
            "fewer cells along the side",
        ))
    }

    /// Estimates the computing time of the square surfaces. Returns an error if it is too long.
    pub fn estimate(&self, own: &OwnLoading, threads: usize) -> Result<SquareTime, StudyError> {
        let ReferenceOptions {
            cells, surfaces, ..
        } = self.options;
        let loading = self.square_loading(own.turn, own.preload, own.depth);
        let body = &self.resolved.body;
        let time = SquareTime::estimate(body, cells, self.seed, &loading, self.stop)?;
        check_time(cells, surfaces, threads, &time)?;
        Ok(time)
    }

    /// Computes all square surfaces. `time` is the estimated computing time of a square surface,
    /// with which the progress is computed that `control` receives.
    ///
    /// # Errors
    /// Returns an error if a square surface cannot be computed, or if `control` stops the
    /// computation.
    pub fn squares(
        &self,
        loading: &SquareLoading,
        threads: usize,
        time: &SquareTime,
        control: &mut Control<'_, ReferenceEvent>,
    ) -> Result<Vec<SquareResult>, StudyError> {
        let worker = |sender: Sender<ReferenceEvent>| {
            move |map: u64| {
                let square = self.square(loading, map, time, &sender)?;
                let _ = sender.send(square.event(loading));
                Ok(square)
            }
        };
        on_threads_received(self.options.surfaces, threads, worker, &mut |event| {
            control.report(event)
        })
    }

    /// Computes the square surface with number `map` and, if half as many cells along the side are
    /// enough, the same surface on this coarser grid. The difference shows the error of the grid.
    fn square(
        &self,
        loading: &SquareLoading,
        map: u64,
        time: &SquareTime,
        sender: &Sender<ReferenceEvent>,
    ) -> Result<SquareResult, StudyError> {
        let ReferenceOptions {
            cells, surfaces, ..
        } = self.options;
        let seed = self.seed.wrapping_add(map);
        let begun = Instant::now();
        let loaded = || {
            let _ = sender.send(ReferenceEvent::Loaded {
                share: time.share_of_load(surfaces),
            });
        };
        let fine = self.resolved.body.load(
            cells,
            seed,
            loading,
            Watch {
                stop: self.stop,
                loaded: &loaded,
            },
        )?;
        let seconds = begun.elapsed().as_secs_f64();
        let mut coarse = None;
        if cells / 2 >= LEAST_CELLS {
            let watch = Watch {
                stop: self.stop,
                loaded: &|| (),
            };
            coarse = Some(self.resolved.body.load(cells / 2, seed, loading, watch)?);
        }
        Ok(SquareResult {
            fine,
            coarse,
            seconds,
        })
    }
}
