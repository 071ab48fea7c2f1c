//! Profiles: spectra at their limits, few springs and many, ties, chains, and heights with a large offset.

use super::{
    RULES, SPECTRUM, WORK, ensure, largest, on_tour, press_and_pull, relative_error, rough, two_legs,
};
use crate::check::case::{CASE, Case, Evidence, Scope};
use crate::check::{Body, Extended, Fault, LENGTH, MODULUS, RMS_HEIGHT, end, follow, force_error};
use crate::scene::{Edges, Form, Move};
use crate::surface::{Line, MeasuredProfile, SelfAffine, UnitRoughness, phases};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Offset of the heights, in units of their rms height.
const OFFSET: f64 = 1e9;

pub const CASES: &[Case] = &[
    Case {
        name: "hurst-to-0",
        holds: "As H → 0, down to 1e−300, heights are the sum of their cosines, and the rms gradient goes to its \
                limit.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "height over rms height",
        scope: Scope::Line(2e-14),
        measure: |_| hurst_to(0.0, &[1e-3, 1e-9, 1e-16, 1e-300]),
        ..CASE
    },
    Case {
        name: "hurst-to-1",
        holds: "As H → 1, up to the last number before, heights are the sum of their cosines, and the rms \
                gradient, also by eq. (13), goes to its limit.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "height over rms height",
        scope: Scope::Line(2e-14),
        measure: |_| hurst_to(1.0, &[0.999, 1.0 - 1e-9, 1.0_f64.next_down()]),
        ..CASE
    },
    Case {
        name: "one-mode",
        holds: "A profile of one mode (first, inner, Nyquist) is one cosine, and contact and \
                forces on it are those of the rules.",
        evidence: &[Evidence::ClosedForm, Evidence::IndependentComputation],
        error_of: "height and force",
        scope: Scope::BothEdges(2e-14, 2e-14),
        measure: one_mode,
        ..CASE
    },
    Case {
        name: "modes-to-nyquist",
        holds: "With as many modes as springs allow, N even, odd, prime and a power of two, heights are the sum \
                of their cosines.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "height over rms height",
        scope: Scope::Line(2e-14),
        measure: |_| modes_to_nyquist(),
        ..CASE
    },
    Case {
        name: "springs-1-2-3-prime",
        holds: "With 1, 2, 3, 5, 17, 127 and 4099 springs contact and forces follow the rules.",
        measure: few_springs,
        ..RULES
    },
    Case {
        name: "springs-2^24",
        holds: "With 2^24 springs and half as many modes, forces at the preload and at pull-off are the sums \
                over the contact, and all springs that attach detach again.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "force, in documented units",
        scope: Scope::BothEdges(4e-16, 1e-15),
        large: true,
        measure: many_springs,
        ..CASE
    },
    Case {
        name: "flat-line",
        holds: "On a flat profile with equal gaps all springs attach and detach at once, at Kendall's force.",
        evidence: &[Evidence::ClosedForm],
        error_of: "force, indentation, energy",
        scope: Scope::BothEdges(2e-15, 2e-15),
        measure: flat,
        ..CASE
    },
    Case {
        name: "staircase",
        holds: "On 32 treads of 32 springs each, up, down, and up and down, contact and forces are those of the \
                rules.",
        measure: |edges| {
            shapes(
                edges,
                &[
                    |i, n| (32 * i / n) as f64,
                    |i, n| -((32 * i / n) as f64),
                    |i, n| {
                        let tread = (32 * i / n) as f64;
                        (tread - 15.5).abs()
                    },
                ],
            )
        },
        ..RULES
    },
    Case {
        name: "monotone-line",
        holds: "On straight and curved slopes, where the tree is one chain, contact and forces are those of the \
                rules.",
        measure: |edges| {
            shapes(
                edges,
                &[
                    |i, n| i as f64 / n as f64,
                    |i, n| -(i as f64 / n as f64),
                    |i, n| (i as f64 / n as f64).powi(2),
                    |i, n| (-8.0 * i as f64 / n as f64).exp(),
                ],
            )
        },
        ..RULES
    },
    Case {
        name: "sawtooth",
        holds: "On equal teeth of 2, 3 and 64 springs, leaning left or right, contact and forces are those of \
                the rules.",
        measure: |edges| {
            shapes(
                edges,
                &[
                    |i, _| (i % 2) as f64,
                    |i, _| (i % 3) as f64,
                    |i, _| (i % 64) as f64,
                    |i, _| -((i % 64) as f64),
                ],
            )
        },
        ..RULES
    },
    Case {
        name: "near-ties",
        holds: "On tents and plateaus whose gaps differ by roundings, without adhesion and with, pressed up to a \
                hundred times their depth, contact and forces follow the rules.",
        measure: near_ties,
        ..RULES
    },
    Case {
        name: "load-far-beyond-roughness",
        holds: "Pressed by 1 to 1e30 times their depth, to an indentation or to a force, without adhesion and with, \
                rough and smooth bodies are in contact over a length that only grows, up to the whole profile, and \
                carry the force of all springs.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "force, over the effect of a rounding of the indentation",
        scope: Scope::BothEdges(4.0, 4.0),
        measure: far_beyond_roughness,
        ..CASE
    },
    Case {
        name: "height-offset-1e9",
        holds: "A measured profile with an offset of 1e9 rms heights has the rms height, rms gradient and gaps of \
                its own roughness.",
        evidence: &[Evidence::IndependentComputation],
        error_of: "statistics and gaps",
        scope: Scope::Line(1e-13),
        measure: |_| offset(),
        ..CASE
    },
];

/// Heights of a spectrum by their cosines: angles reduced as integers, sums with twice the digits.
fn cosines(spectrum: SelfAffine, seed: u64, points: usize) -> Vec<f64> {
    let SelfAffine { hurst, first, last } = spectrum;
    let amplitude = |mode: u64| (-(hurst + 0.5) * (mode as f64).ln()).exp();
    let squares = Extended::sum((first..=last).map(|mode| amplitude(mode).powi(2)));
    let rms = (squares.rounded() / 2.0).sqrt();
    let phases: Vec<f64> = phases(seed, first).take((last + 1 - first) as usize).collect();
    // Mode k at x = (i + ½)L/N: the angle is π k (2i + 1)/N.
    let height = |index: usize| {
        let terms = (first..=last).zip(&phases).map(|(mode, phase)| {
            let turns = mode * (2 * index as u64 + 1) % (2 * points as u64);
            amplitude(mode) * (PI * turns as f64 / points as f64 + phase).cos()
        });
        Extended::sum(terms).rounded() / rms
    };
    (0..points).map(height).collect()
}

/// Largest error of a synthesised profile, over its rms height.
fn height_error(spectrum: SelfAffine, seed: u64, points: usize) -> Result<f64, Fault> {
    let line = UnitRoughness::synthesize(spectrum, seed, points)?;
    let expected = cosines(spectrum, seed, points);
    largest(line.heights.iter().zip(&expected).map(|(a, b)| Ok((a - b).abs())))
}

fn hurst_to(limit: f64, exponents: &[f64]) -> Result<f64, Fault> {
    let of = |hurst| SelfAffine { hurst, ..SPECTRUM };
    let gradients = |hurst| {
        let spectrum = of(hurst);
        [spectrum.gradient_per_height(1.0), spectrum.continuum_gradient_per_height(1.0)]
    };
    let limits = gradients(limit);
    let mut worst = 0.0_f64;
    for &hurst in exponents {
        worst = worst.max(height_error(of(hurst), 4, 1000)?);
        for (found, limit_of) in gradients(hurst).into_iter().zip(limits) {
            // The logarithm of the gradient changes with H by at most ln of the ratio of the modes.
            let most = (SPECTRUM.last as f64).ln() * (hurst - limit).abs() + 1e-14;
            ensure((found / limit_of - 1.0).abs() <= most, || {
                format!("H = {hurst:e}: rms gradient {found:e}, in the limit {limit_of:e}")
            })?;
        }
    }
    Ok(worst)
}

fn one_mode(edges: Edges) -> Result<f64, Fault> {
    let profiles = [(2, 1), (64, 1), (1000, 1), (1000, 7), (1001, 500), (1000, 500)];
    largest(profiles.map(|(points, mode)| {
        let spectrum = SelfAffine { hurst: 0.5, first: mode, last: mode };
        let on_tour = on_tour(&Body::rough(spectrum, 5, points, WORK)?, edges);
        largest([height_error(spectrum, 5, points), on_tour])
    }))
}

fn modes_to_nyquist() -> Result<f64, Fault> {
    largest(
        [2, 3, 4, 1000, 1024, 1025, 1009, 2999].map(|points| {
            height_error(SelfAffine { hurst: 0.3, first: 1, last: points as u64 / 2 }, 6, points)
        }),
    )
}

fn few_springs(edges: Edges) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    for points in [1, 2, 3, 5, 17, 127, 4099] {
        for work in [0.0, 0.1 * WORK, WORK, 100.0 * WORK] {
            let body = if points == 1 {
                Body::below(vec![0.0], LENGTH, MODULUS, work)
            } else {
                rough(points, work)?
            };
            worst = worst.max(on_tour(&body, edges)?);
        }
    }
    Ok(worst)
}

fn many_springs(edges: Edges) -> Result<f64, Fault> {
    let points = 1 << 24;
    let body = Body::rough(SelfAffine { last: points as u64 / 2, ..SPECTRUM }, 7, points, WORK)?;
    body.with(edges, 33, |solver| {
        let loading = solver.advance(Move::ToIndentation(0.4 * body.deepest()))?;
        let mut worst = force_error(&body, edges, solver, &end(&loading))?;
        let unloading = solver.advance(Move::ToSeparation)?;
        ensure(unloading.smallest.force < 0.0, || "it does not stick".into())?;
        worst = worst.max(force_error(&body, edges, solver, &unloading.smallest)?);
        ensure(unloading.detached == loading.attached && end(&unloading).springs == 0, || {
            format!("{} springs attached, {} detached", loading.attached, unloading.detached)
        })?;
        Ok(worst)
    })
}

fn flat(edges: Edges) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    for points in [1, 2, 3, 1000, 65_537] {
        let body = Body::below(vec![0.0; points], LENGTH, MODULUS, WORK);
        let history = body.history(edges, &press_and_pull(RMS_HEIGHT), 9)?;
        let [loading, unloading] = two_legs(&history)?;
        let last = unloading.smallest;
        let all = points as u64;
        ensure((last.springs, last.fragments, unloading.detached) == (all, 1, all), || format!("{last:?}"))?;
        let [length, modulus, work] = [LENGTH, MODULUS, WORK].map(Extended::from);
        let detachment = -(Extended::PI * length * work / modulus).sqrt();
        let lost = Extended::from(0.5) * modulus * length * detachment * detachment;
        for (found, expected) in [
            (last.force, modulus * length * detachment),
            (last.indentation, detachment),
            (end(unloading).indentation, detachment),
            (unloading.released_energy, lost),
            (end(loading).force, modulus * length * Extended::from(RMS_HEIGHT)),
        ] {
            worst = worst.max(relative_error(found, expected));
        }
    }
    Ok(worst)
}

/// Heights of a shape with the largest magnitude [`RMS_HEIGHT`].
fn heights_of(points: usize, shape: impl Fn(usize) -> f64) -> Vec<f64> {
    let heights: Vec<f64> = (0..points).map(shape).collect();
    let largest = heights.iter().fold(0.0, |most: f64, height| most.max(height.abs()));
    heights.iter().map(|height| height * (RMS_HEIGHT / largest)).collect()
}

/// Follows bodies of these shapes, from almost no adhesion to much.
fn shapes(edges: Edges, shapes: &[fn(usize, usize) -> f64]) -> Result<f64, Fault> {
    let points = 1024;
    largest(shapes.iter().flat_map(|shape| {
        let heights = heights_of(points, |index| -shape(index, points));
        [0.0, 0.01 * WORK, 0.1 * WORK, WORK, 10.0 * WORK]
            .map(|work| on_tour(&Body::below(heights.clone(), LENGTH, MODULUS, work), edges))
    }))
}

fn near_ties(edges: Edges) -> Result<f64, Fault> {
    let mut worst = 0.0_f64;
    let mut noise = phases(9, 1).map(|phase| phase / TAU - 0.5);
    for points in [6, 7, 64, 1000] {
        let tent = |index: usize| -(index as f64 + 0.5 - points as f64 / 2.0).abs();
        let plateau = |index: usize| (index * 8 / points % 2) as f64;
        for shape in [&tent as &dyn Fn(usize) -> f64, &plateau] {
            // A few units in the last place of the largest height, and far less for heights near zero.
            let mut jitter = |height: f64| {
                height + (height + 1e-6 * RMS_HEIGHT) * f64::EPSILON * 4.0 * noise.next().unwrap_or(0.0)
            };
            let heights: Vec<f64> = heights_of(points, shape).into_iter().map(&mut jitter).collect();
            for work in [0.0, 0.01 * WORK, WORK] {
                let body = Body::below(heights.clone(), LENGTH, MODULUS, work);
                let pressed =
                    [1.0, 2.0, 10.0, 100.0].map(|share| Move::ToIndentation(share * body.deepest()));
                let legs = [pressed.to_vec(), body.tour()].concat();
                worst = worst.max(follow(&body, edges, &legs)?.force);
            }
        }
    }
    Ok(worst)
}

fn far_beyond_roughness(edges: Edges) -> Result<f64, Fault> {
    let sphere = Line::new(LENGTH, 257, Some(&Form::Paraboloid { radius: 1.0e-4 }), None, 0.0)?;
    let mut worst = 0.0_f64;
    for work in [0.0, WORK] {
        let smooth = Body { gaps: sphere.gaps.to_vec(), ..rough(257, work)? };
        for body in [rough(257, work)?, smooth] {
            for power in 0..=30 {
                worst = worst.max(pressed_far(&body, edges, 10.0_f64.powi(power) * body.deepest())?);
            }
        }
    }
    Ok(worst)
}

/// Presses a body to an indentation, back, and by the force found there; the error of the force over the change of
/// force by one rounding of the indentation for all springs.
fn pressed_far(body: &Body, edges: Edges, indentation: f64) -> Result<f64, Fault> {
    // Also between springs: half a cell at each end makes the integral over straight cells this sum.
    let whole = Extended::sum(body.gaps.iter().map(|&gap| indentation - gap)).rounded();
    let stiffness = body.foundation.spring_stiffness();
    let most = LENGTH * (1.0 + 2.0 * f64::EPSILON);
    body.with(edges, 17, |solver| {
        let pressed = solver.advance(Move::ToIndentation(indentation))?;
        let back = solver.advance(Move::ToIndentation(0.5 * body.deepest()))?;
        let force = end(&pressed).force;
        let again = solver.advance(Move::ToForce(force))?;
        for record in [&pressed, &back, &again] {
            let mut points: Vec<_> = record.curve.clone();
            points.sort_by(|a, b| a.indentation.total_cmp(&b.indentation));
            let grows = points.windows(2).all(|pair| pair[0].contact_length <= pair[1].contact_length);
            let inside = points.iter().all(|point| (0.0..=most).contains(&point.contact_length));
            ensure(grows && inside, || format!("contact lengths at {indentation:e} m: {points:?}"))?;
        }
        let full = end(&pressed).contact_length;
        ensure((full / LENGTH - 1.0).abs() <= 2.0 * f64::EPSILON, || {
            format!("{full:e} m at {indentation:e} m")
        })?;
        let place = indentation - indentation.next_down();
        let unit = stiffness * body.gaps.len() as f64 * place + f64::EPSILON * force;
        let errors = [force - stiffness * whole, end(&again).force - force];
        Ok(errors.into_iter().fold(0.0, |worst: f64, error| worst.max(error.abs() / unit)))
    })
}

fn offset() -> Result<f64, Fault> {
    // As many points as in files of instruments: an offset affects sums over many points.
    let points = 200_000;
    let rough = UnitRoughness::synthesize(SPECTRUM, 8, points)?;
    let mut text = String::new();
    let spacing = LENGTH / (points - 1) as f64;
    let on_offset: Vec<f64> =
        rough.heights.iter().map(|height| RMS_HEIGHT * OFFSET + RMS_HEIGHT * height).collect();
    let positions: Vec<f64> = (0..points).map(|index| index as f64 * spacing).collect();
    for (x, z) in positions.iter().zip(&on_offset) {
        // Writing to a string cannot fail, and the shortest digits are read back as the same number.
        let _ = writeln!(text, "{x:e},{z:e}");
    }
    let profile = MeasuredProfile::parse(&text).map_err(|error| Fault::Wrong(error.to_string()))?;
    let (height, gradient) = profile.rms_height_and_gradient();
    let (expected_height, expected_gradient) = statistics(&positions, &on_offset);
    let mut worst = (height / expected_height - 1.0).abs().max((gradient / expected_gradient - 1.0).abs());
    // Springs midway between the points of the file: half a step further on.
    let length = profile.length();
    let heights = profile.sample(length, points - 1, 0.0).map_err(Fault::Wrong)?;
    let line = Line::new(length, points - 1, None, Some(&heights), 1.0)?;
    let midway: Vec<f64> =
        on_offset.windows(2).map(|z| 0.5 * (z[0] - z[1]) + (z[1] - on_offset[0])).collect();
    let summit = midway.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (gap, height) in line.gaps.iter().zip(&midway) {
        worst = worst.max((gap - (summit - height)).abs() / RMS_HEIGHT);
    }
    Ok(worst)
}

/// Rms height about the mean and rms gradient of straight pieces, with twice the digits.
fn statistics(positions: &[f64], heights: &[f64]) -> (f64, f64) {
    let pieces = || {
        positions.windows(2).zip(heights.windows(2)).map(|(x, z)| {
            let [x0, x1, a, b] = [x[0], x[1], z[0], z[1]].map(Extended::from);
            (x1 - x0, a, b)
        })
    };
    let zero = Extended::default();
    let length = pieces().fold(zero, |sum, (dx, ..)| sum + dx);
    let half = Extended::from(0.5);
    let mean = pieces().fold(zero, |sum, (dx, a, b)| sum + dx * (a + b) * half) / length;
    let square = pieces().fold(zero, |sum, (dx, a, b)| {
        let (a, b) = (a - mean, b - mean);
        sum + dx * (a * a + a * b + b * b) / Extended::from(3.0)
    });
    let gradient = pieces().fold(zero, |sum, (dx, a, b)| sum + (b - a) * (b - a) / dx);
    ((square / length).sqrt().rounded(), (gradient / length).sqrt().rounded())
}
