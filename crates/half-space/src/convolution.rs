//! Convolution of a square grid of real numbers with a kernel that is real and even in both
//! directions.

use asperity_data::{OutOfMemory, resized};
use asperity_fourier::{
    Complex, ComplexToReal, Fft, Precision, RealToComplex, plan_forward, plan_inverse,
    plan_real_forward, plan_real_inverse,
};
use std::sync::Arc;

/// Number of bytes of each row that are transformed together as columns. With such blocks, memory
/// is read row by row, and each column is computed in contiguous memory.
const BLOCK: usize = 128;

/// Number of rows of a block that are gathered together, so that their values stay in the cache of
/// the processor.
const TILE: usize = 16;

/// A planned convolution of values of the type T. First all rows of the grid are transformed. Then
/// each block of columns is processed in a single pass over the memory: the block is gathered,
/// transformed, multiplied by the transform of the kernel, transformed back and stored.
pub struct Convolution<T> {
    /// Number of rows and columns of the grid.
    cells: usize,
    /// Number of rows and columns of the padded grid, which has a margin of zeros.
    padded: usize,
    /// Transform of the kernel divided by the number of padded cells, column by column.
    transfer: Vec<T>,
    rows: PlannedRows<T>,
    columns: PlannedColumns<T>,
    /// Half spectra of the rows of the grid. Neighbouring spectra have the distance
    /// [`Convolution::stride`].
    spectra: Vec<Complex<T>>,
    /// Memory for one padded row.
    row: Vec<T>,
    /// Padded columns of a block. Neighbouring columns have the distance [`Convolution::apart`].
    block: Vec<Complex<T>>,
    scratch: Vec<Complex<T>>,
}

struct PlannedRows<T> {
    forward: Arc<dyn RealToComplex<T>>,
    inverse: Arc<dyn ComplexToReal<T>>,
}

struct PlannedColumns<T> {
    forward: Arc<dyn Fft<T>>,
    inverse: Arc<dyn Fft<T>>,
}

impl<T: Precision + Default> Convolution<T> {
    /// Number of columns that are transformed together.
    const TOGETHER: usize = BLOCK / size_of::<Complex<T>>();

    /// Returns the memory in bytes that a planned convolution and its planning need. `cells` is the
    /// side of the grid and `padded` the side of the padded grid, both in cells.
    pub fn bytes(cells: usize, padded: usize) -> u64 {
        let half = padded / 2 + 1;
        let complex = Self::stride(padded) * cells + (2 * Self::TOGETHER + 4) * Self::apart(padded);
        (size_of::<T>() * (padded * half + 2 * complex) + 8 * half * half) as u64
    }

    /// Returns the distance of the rows of the half spectra. It is not a power of two, because rows
    /// at such a distance would share the same lines of the cache.
    fn stride(padded: usize) -> usize {
        (padded / 2 + 1).next_multiple_of(Self::TOGETHER) + Self::TOGETHER / 2
    }

    /// Returns the distance of the columns of a block. It is not a power of two, because columns at
    /// such a distance would share the same lines of the cache.
    fn apart(padded: usize) -> usize {
        padded + Self::TOGETHER
    }

    /// Plans the convolution with a kernel that is given by its Fourier transform. The arguments of
    /// `transform` are the wave numbers (k_x, k_y): numbers of waves on the side of the padded
    /// grid, from 0 to half of `padded`. Negative wave numbers are not needed, because the kernel
    /// is even.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn by_transform(
        cells: usize,
        padded: usize,
        transform: impl Fn(f64, f64) -> f64,
    ) -> Result<Self, OutOfMemory> {
        let mut planned = Convolution::plan(cells, padded)?;
        let scale = 1.0 / (padded * padded) as f64;
        for (column, values) in planned.transfer.chunks_exact_mut(padded).enumerate() {
            for (row, value) in values.iter_mut().enumerate() {
                *value = number(scale * transform(column as f64, row.min(padded - row) as f64));
            }
        }
        Ok(planned)
    }

    /// Plans the convolution with a kernel that is given by its values. The arguments of `kernel`
    /// are the distances (x, y) in cells. The side of the padded grid, `padded`, must be at least
    /// twice the side of the grid, `cells`.
    ///
    /// # Errors
    /// Returns an error if the memory does not suffice.
    pub fn by_kernel(
        cells: usize,
        padded: usize,
        kernel: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, OutOfMemory> {
        let mut planned = Convolution::plan(cells, padded)?;
        let half = padded / 2 + 1;
        // The transform of an even kernel is real. The rows of the transform above the half are
        // equal to the mirrored rows below the half.
        let mut rows = resized(Vec::new(), half * half, 0.0)?;
        let mut row = vec![0.0; padded];
        let mut spectrum = vec![Complex::default(); half];
        let plan = plan_real_forward::<f64>(padded);
        let mut scratch = plan.make_scratch_vec();
        for (y, values) in rows.chunks_exact_mut(half).enumerate() {
            for (x, value) in row.iter_mut().enumerate() {
                *value = kernel(x.min(padded - x), y);
            }
            // The lengths of the arrays suit the plan, so no error can occur.
            let _ = plan.process_with_scratch(&mut row, &mut spectrum, &mut scratch);
            for (value, wave) in values.iter_mut().zip(&spectrum) {
                *value = wave.re;
            }
        }
        let scale = 1.0 / (padded * padded) as f64;
        for (k, values) in planned.transfer.chunks_exact_mut(padded).enumerate() {
            for (y, value) in row.iter_mut().enumerate() {
                *value = rows[y.min(padded - y) * half + k];
            }
            let _ = plan.process_with_scratch(&mut row, &mut spectrum, &mut scratch);
            for (y, value) in values.iter_mut().enumerate() {
                *value = number(scale * spectrum[y.min(padded - y)].re);
            }
        }
        Ok(planned)
    }

    fn plan(cells: usize, padded: usize) -> Result<Self, OutOfMemory> {
        let rows = PlannedRows {
            forward: plan_real_forward(padded),
            inverse: plan_real_inverse(padded),
        };
        let columns = PlannedColumns {
            forward: plan_forward(padded),
            inverse: plan_inverse(padded),
        };
        let scratch_of_rows = rows
            .forward
            .get_scratch_len()
            .max(rows.inverse.get_scratch_len());
        let scratch_of_columns = columns
            .forward
            .get_inplace_scratch_len()
            .max(columns.inverse.get_inplace_scratch_len());
        let scratch = scratch_of_rows.max(scratch_of_columns);
        let spectra = Self::stride(padded) * cells;
        let block = Self::TOGETHER * Self::apart(padded);
        Ok(Convolution {
            cells,
            padded,
            transfer: resized(Vec::new(), padded * (padded / 2 + 1), T::zero())?,
            spectra: resized(Vec::new(), spectra, Complex::default())?,
            row: resized(Vec::new(), padded, T::zero())?,
            block: resized(Vec::new(), block, Complex::default())?,
            scratch: resized(Vec::new(), scratch, Complex::default())?,
            rows,
            columns,
        })
    }

    /// Convolves a grid row by row. `from` writes the row of the grid with the given index, and
    /// `to` reads the row of the result with the given index. Both functions receive `context`. Row
    /// by row, the values are made and used while they are in the cache of the processor.
    pub fn apply<C>(
        &mut self,
        context: &mut C,
        mut from: impl FnMut(&mut C, usize, &mut [T]),
        mut to: impl FnMut(&mut C, usize, &[T]),
    ) {
        let cells = self.cells;
        let half = self.padded / 2 + 1;
        let stride = Self::stride(self.padded);
        for (row, spectrum) in self.spectra.chunks_exact_mut(stride).enumerate() {
            from(context, row, &mut self.row[..cells]);
            if self.row[..cells].iter().all(T::is_zero) {
                spectrum[..half].fill(Complex::default());
                continue;
            }
            self.row[cells..].fill(T::zero());
            // The lengths of the arrays suit the plan, so no error can occur.
            let _ = self.rows.forward.process_with_scratch(
                &mut self.row,
                &mut spectrum[..half],
                &mut self.scratch,
            );
        }
        for first in (0..half).step_by(Self::TOGETHER) {
            let width = Self::TOGETHER.min(half - first);
            self.gather(first, width);
            self.multiply(first, width);
            self.scatter(first, width);
        }
        for (row, spectrum) in self.spectra.chunks_exact_mut(stride).enumerate() {
            // The spectrum of real values has no imaginary part at the first and the last mode, but
            // rounding leaves one.
            spectrum[0].im = T::zero();
            spectrum[half - 1].im = T::zero();
            let _ = self.rows.inverse.process_with_scratch(
                &mut spectrum[..half],
                &mut self.row,
                &mut self.scratch,
            );
            to(context, row, &self.row[..cells]);
        }
    }

    /// Copies `width` columns of the spectra to the block, beginning with the column `first`.
    fn gather(&mut self, first: usize, width: usize) {
        let stride = Self::stride(self.padded);
        let apart = Self::apart(self.padded);
        for (tile, rows) in self.spectra.chunks(TILE * stride).enumerate() {
            for (column, to) in self.block.chunks_exact_mut(apart).take(width).enumerate() {
                let values = rows[first + column..].iter().step_by(stride);
                for (to, value) in to[tile * TILE..].iter_mut().zip(values) {
                    *to = *value;
                }
            }
        }
    }

    /// Transforms the columns of the block, multiplies them by the transform of the kernel, and
    /// transforms them back.
    fn multiply(&mut self, first: usize, width: usize) {
        let apart = Self::apart(self.padded);
        let transfer = self.transfer[first * self.padded..].chunks_exact(self.padded);
        for (column, transfer) in self.block.chunks_exact_mut(apart).zip(transfer).take(width) {
            let column = &mut column[..self.padded];
            column[self.cells..].fill(Complex::default());
            self.columns
                .forward
                .process_with_scratch(column, &mut self.scratch);
            for (value, factor) in column.iter_mut().zip(transfer) {
                *value = *value * *factor;
            }
            self.columns
                .inverse
                .process_with_scratch(column, &mut self.scratch);
        }
    }

    /// Copies the columns of the block back to the spectra.
    fn scatter(&mut self, first: usize, width: usize) {
        let stride = Self::stride(self.padded);
        let apart = Self::apart(self.padded);
        for (tile, rows) in self.spectra.chunks_mut(TILE * stride).enumerate() {
            for (column, values) in self.block.chunks_exact(apart).take(width).enumerate() {
                let to = rows[first + column..].iter_mut().step_by(stride);
                for (to, value) in to.zip(&values[tile * TILE..]) {
                    *to = *value;
                }
            }
        }
    }
}

/// Converts a number to the nearest value of the type T.
fn number<T: Precision>(value: f64) -> T {
    T::from_f64(value).unwrap_or_else(T::zero)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(count: usize) -> Vec<f64> {
        (0..count)
            .map(|index| (index as f64 * 12.9898).sin() * 43.758 % 1.0)
            .collect()
    }

    fn apply(planned: &mut Convolution<f64>, from: &[f64], cells: usize) -> Vec<f64> {
        let mut found = Vec::new();
        planned.apply(
            &mut found,
            |_, row, to| to.copy_from_slice(&from[row * cells..][..cells]),
            |found, _, row| found.extend_from_slice(row),
        );
        found
    }

    #[test]
    fn a_kernel_is_summed_over_all_pairs_of_cells() {
        for cells in [4, 6, 16] {
            let kernel = |x: usize, y: usize| 1.0 / (1.0 + (3 * x + x * y + 2 * y * y) as f64);
            let mut planned = Convolution::<f64>::by_kernel(cells, 2 * cells + 2, kernel).unwrap();
            let from = numbers(cells * cells);
            let to = apply(&mut planned, &from, cells);
            for (index, found) in to.iter().enumerate() {
                let mut sum = 0.0;
                for (source, value) in from.iter().enumerate() {
                    let x = (index % cells).abs_diff(source % cells);
                    let y = (index / cells).abs_diff(source / cells);
                    sum += value * kernel(x, y);
                }
                assert!((sum - found).abs() < 1e-13, "{cells}: {index}");
            }
        }
    }

    #[test]
    fn a_wave_is_multiplied_by_its_transform() {
        let cells = 12;
        let transform = |x: f64, y: f64| 1.0 / (1.0 + x * x + 3.0 * y);
        let mut planned = Convolution::<f64>::by_transform(cells, cells, transform).unwrap();
        for (kx, ky) in [(0, 0), (2, 5), (6, 1), (1, 6), (3, 0)] {
            let mut from = Vec::new();
            for index in 0..cells * cells {
                let waves = (kx * (index % cells) + ky * (index / cells)) as f64 / cells as f64;
                from.push((std::f64::consts::TAU * waves).cos());
            }
            let to = apply(&mut planned, &from, cells);
            let factor = transform(f64::from(kx as u32), f64::from(ky as u32));
            for (value, found) in from.iter().zip(&to) {
                assert!((factor * value - found).abs() < 1e-13);
            }
        }
    }
}
