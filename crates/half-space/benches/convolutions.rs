//! Convolutions and times of contacts without adhesion, over areas from 1 to 60 %: eight cells for
//! the shortest wave, each load from the start, one thread, residual 1e-8 rms heights. Times are
//! those of the processor where the system states them.

use asperity_half_space::{AdhesiveSquare, Boundary, HalfSpace, Load, Square, random_map};
use std::time::Instant;

fn main() {
    println!("boundary  cells    H   convolutions median, worst   ms mean, worst   areas");
    for (cells, boundary) in [
        (128, Boundary::Periodic),
        (256, Boundary::Periodic),
        (512, Boundary::Periodic),
        (128, Boundary::Free),
        (256, Boundary::Free),
        (512, Boundary::Free),
    ] {
        for hurst in [0.3, 0.5, 0.8] {
            measure(cells, boundary, hurst);
        }
    }
    println!("adhesive loops of 40 steps, e_el/γ = 1   s, convolutions");
    for (cells, hurst) in [(64, 0.3), (64, 0.8), (128, 0.3), (128, 0.8)] {
        measure_loop(cells, hurst);
    }
}

/// A rough square, pressed to a force of 0.3 E* h L in 20 steps, and pulled off.
fn measure_loop(cells: usize, hurst: f64) {
    let (last, rms_height) = (cells as f64 / 8.0, 0.01);
    let power = |k: f64| {
        if k <= last {
            k.powf(-2.0 * hurst - 2.0)
        } else {
            0.0
        }
    };
    let mut heights = random_map(cells, power, 1).expect("memory");
    let rms =
        (heights.iter().map(|height| height * height).sum::<f64>() / heights.len() as f64).sqrt();
    heights
        .iter_mut()
        .for_each(|height| *height *= rms_height / rms);
    let waves =
        (-64..=64_i32).flat_map(|x| (-64..=64_i32).map(move |y| f64::from(x).hypot(f64::from(y))));
    let (energy, squares) = waves
        .filter(|k| *k > 0.0)
        .fold((0.0, 0.0), |(energy, squares), k| {
            (
                energy + 0.25 * std::f64::consts::TAU * k * power(k),
                squares + power(k),
            )
        });
    let work = rms_height * rms_height * energy / squares;
    let square = Square {
        heights: &heights,
        side: 1.0,
        modulus: 1.0,
    };
    let (start, used) = (Instant::now(), used());
    let mut body = AdhesiveSquare::new(&square, work, work).expect("a square");
    let mut to = |depth: f64| body.move_to(depth, &|| false).expect("a state");
    let (mut depth, mut steps, step) = (0.0, 1, 2.5 * rms_height / 20.0);
    while to(depth).force < 0.3 * rms_height && steps < 40 {
        (depth, steps) = (depth + step, steps + 1);
    }
    while to(depth).area > 0.0 && steps < 200 {
        (depth, steps) = (depth - step, steps + 1);
    }
    let elapsed = start.elapsed().as_secs_f64();
    let seconds = used
        .and_then(|before| Some(self::used()? - before))
        .unwrap_or(elapsed);
    println!(
        "{cells:>5}  {hurst}  {steps} steps   {seconds:.3}   {}",
        body.convolutions()
    );
}

/// Time, s, for which this thread has had a processor, as Linux counts it.
fn used() -> Option<f64> {
    let counts = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * counts.split_whitespace().next()?.parse::<f64>().ok()?)
}

fn measure(cells: usize, boundary: Boundary, hurst: f64) {
    let last = cells as f64 / 8.0;
    let power = |k: f64| {
        if k <= last {
            k.powf(-2.0 * hurst - 2.0)
        } else {
            0.0
        }
    };
    let mut heights = random_map(cells, power, 1).expect("memory");
    let rms =
        (heights.iter().map(|height| height * height).sum::<f64>() / heights.len() as f64).sqrt();
    heights.iter_mut().for_each(|height| *height *= 0.01 / rms);
    let square = Square {
        heights: &heights,
        side: 1.0,
        modulus: 1.0,
    };
    let gradient = {
        let slope = |at: usize| {
            let (x, y) = (at % cells, at / cells);
            let across = heights[y * cells + (x + 1) % cells] - heights[at];
            let along = heights[(y + 1) % cells * cells + x] - heights[at];
            (across * across + along * along) * (cells * cells) as f64
        };
        ((0..cells * cells).map(slope).sum::<f64>() / (cells * cells) as f64).sqrt()
    };
    let mut half_space = HalfSpace::new(cells, boundary).expect("a grid");
    let (mut counts, mut times, mut areas) = (Vec::new(), Vec::new(), Vec::new());
    // Area over the load is about 2/(E* h').
    for share in [
        0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8,
    ] {
        let force = share * gradient / 2.0;
        let (start, used) = (Instant::now(), used());
        let found = half_space
            .press(&square, Load::Force(force), 1e-8, &|| false)
            .expect("a contact");
        let elapsed = start.elapsed().as_secs_f64();
        times.push(
            1e3 * used
                .and_then(|before| Some(self::used()? - before))
                .unwrap_or(elapsed),
        );
        assert!(found.is_reached, "{share}: {}", found.residual);
        counts.push(found.convolutions);
        areas.push(found.area);
    }
    counts.sort_unstable();
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    let worst = times.iter().copied().fold(0.0, f64::max);
    println!(
        "{boundary:?}  {cells:>5}  {hurst}   {:>5} {:>5}   {mean:>8.1} {worst:>8.1}   {:.1} to {:.1} %",
        counts[6],
        counts[11],
        100.0 * areas[0],
        100.0 * areas[11]
    );
}
