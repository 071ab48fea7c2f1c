//! Criteria by which theories decide whether nominally flat, randomly rough bodies adhere.
//!
//! The criteria depend on three numbers of the two-dimensional surface: rms height h, rms gradient
//! g, and rms mean curvature c, which is half of the rms Laplacian. The equivalent profile has the
//! same h, g and c, because its spectrum is C1D = πq C2D.

use super::criterion::{Criterion, long_ranged, number};
use asperity_scene::Governing;
use asperity_surface::{Amplitude, SelfAffine};
use std::f64::consts::{E, PI, TAU};

/// Largest range of the attraction with which the criterion of Pastewka and Robbins holds, as a
/// share of the gap (16/3)g²/c; Monti, Sanner and Pastewka (2021).
const MOST_OF_GAP: f64 = 0.1;

/// Hurst exponents for which the bearing area model has the repulsion 0.75 q_L h E* e^(−2u/h).
const HURST_OF_BEARING_AREA: [f64; 2] = [0.7, 0.9];

/// Value of θ (Fuller and Tabor) above which surfaces never bond; Gui et al. (1999).
const NEVER_BONDS: f64 = 12.0;

const PERSSON_TOSATTI: Criterion = Criterion::new(
    "Persson & Tosatti 2001",
    "e_el/γ",
    "Persson, Tosatti: J. Chem. Phys. 115 (2001) 5597",
    1.0,
);
/// The threshold of P is π(3/16)^(2/3), written out here as a constant.
const PASTEWKA_ROBBINS: Criterion = Criterion::new(
    "Pastewka & Robbins 2014",
    "P",
    "Pastewka, Robbins: PNAS 111 (2014) 3298",
    1.029_162_738_875_668,
);
const BEARING_AREA: Criterion = Criterion::new(
    "bearing area 2018",
    "h/h_c",
    "Ciavarella: Meccanica 53 (2018) 241",
    1.0,
);
const FULLER_TABOR: Criterion = Criterion::new(
    "Fuller & Tabor 1975",
    "θ",
    "Fuller, Tabor: Proc. R. Soc. A 345 (1975) 327; Gui et al.: J. Appl. Phys. 85 (1999) 7448",
    1.0,
);

/// Contact of nominally flat, randomly rough bodies with adhesion, to which the criteria apply.
pub(super) struct RoughContact {
    pub amplitude: Amplitude,
    /// Work of adhesion divided by the effective modulus, γ/E*, in m.
    pub stretch: f64,
    /// Range z₀ of the attraction between the surfaces in m.
    pub range: f64,
    /// Spectrum of a self-affine surface; `None` for a measured surface.
    pub spectrum: Option<SelfAffine>,
    /// Length L of the profile in m.
    pub length: f64,
    pub tabor_number: Option<f64>,
}

impl RoughContact {
    pub(super) fn criteria(&self) -> Vec<Criterion> {
        vec![
            self.persson_tosatti(),
            self.pastewka_robbins(),
            self.bearing_area(),
            self.fuller_tabor(),
        ]
    }

    /// Returns the rms mean curvature c of the surface in 1/m, which is half of its rms Laplacian.
    /// The rms Laplacian of the surface equals the rms curvature of the profile.
    fn mean_curvature(&self) -> f64 {
        0.5 * self.amplitude.rms_curvature
    }

    /// Criterion of Persson and Tosatti (2001): the elastic energy of the bodies pressed flat,
    /// divided by the work of adhesion. Bodies conform if adhesion gains more energy than they
    /// store elastically. For H ≤ ½ the elastic energy has no limit as shorter and shorter waves
    /// are added.
    fn persson_tosatti(&self) -> Criterion {
        let rough = self
            .spectrum
            .map(|spectrum| spectrum.hurst)
            .filter(|hurst| *hurst <= 0.5);
        let rough = rough.map(|hurst| format!("H {}, needs H > 0.5", number(hurst)));
        let value = self.amplitude.elastic_energy(1.0) / self.stretch;
        PERSSON_TOSATTI.judge(value, &[long_ranged(self.tabor_number), rough])
    }

    /// Criterion P = (g z₀/2ℓ)(g²/(c z₀))^(2/3) with ℓ = γ/E*, Pastewka and Robbins (2014), eq.
    /// (10). Contact spots are assumed to have the mean chord 4g/c and the mean pressure E*g/2, as
    /// in a contact without adhesion. The attraction acts in the rim around the spots, where the
    /// gap is below z₀. For P < π(3/16)^(2/3) it exceeds the repulsion in the spots.
    ///
    /// The curvature c is half of the Laplacian, as in the published example of
    /// `ContactEngineering/Adhesion`. With the whole Laplacian P would be 1.6 times smaller.
    fn pastewka_robbins(&self) -> Criterion {
        let gradient = self.amplitude.rms_gradient;
        let range = self.range;
        let scale = gradient.powi(2) / self.mean_curvature();
        let share = range / (16.0 / 3.0 * scale);
        let far = (share >= MOST_OF_GAP).then(|| {
            format!(
                "z₀ is {} of (16/3)g²/c, needs less than {MOST_OF_GAP}",
                number(share)
            )
        });
        let value = gradient * range / (2.0 * self.stretch) * (scale / range).powf(2.0 / 3.0);
        PASTEWKA_ROBBINS.judge(value, &[far])
    }

    /// Returns h/h_c with the critical rms height h_c; Ciavarella (2018). For h below h_c the
    /// attraction γφ(u/h)/h of the bearing area exceeds the repulsion 0.75 q_L h E* e^(−2u/h) at
    /// some mean gap u. Here φ is the density of the standard normal distribution. With ℓ = γ/E*
    /// and the longest wavelength λ_L = 2π/q_L, this gives h_c² = ℓλ_L e²/(0.75·√(2π)·2π) = 0.626
    /// ℓλ_L, published as 0.6 ℓλ_L.
    fn bearing_area(&self) -> Criterion {
        let Some(SelfAffine {
            hurst,
            first,
            roll_off_mode,
            ..
        }) = self.spectrum
        else {
            let reason = "needs a self-affine spectrum of H near 0.8".to_owned();
            return Criterion {
                reason: Some(reason),
                ..BEARING_AREA
            };
        };
        let soft = self
            .tabor_number
            .filter(|number| *number >= Governing::LEAST_TABOR_NUMBER);
        let soft = soft.map(|tabor_number| {
            let least = Governing::LEAST_TABOR_NUMBER;
            let tabor_number = number(tabor_number);
            format!("μ {tabor_number}, needs stiff bodies, less than {least}")
        });
        let [low, high] = HURST_OF_BEARING_AREA;
        let other =
            (hurst < low || hurst > high).then(|| format!("H {}, needs H near 0.8", number(hurst)));
        let longest = self.length / roll_off_mode.max(first as f64);
        let critical = (E.powi(2) / (0.75 * TAU.sqrt() * TAU) * self.stretch * longest).sqrt();
        BEARING_AREA.judge(self.amplitude.rms_height / critical, &[soft, other])
    }

    /// Criterion θ = (E*/γ)√(σ³/ρ) of Fuller and Tabor (1975), with the rms height σ of the summits
    /// and their radius ρ = 1/c. Surfaces bond by themselves for θ below 1, and never for θ above
    /// 12; Gui et al. (1999).
    ///
    /// The criterion holds if the summits are separate. They count as separate if together they
    /// cover at most the nominal area, where a summit pressed in by σ covers πρσ.
    fn fuller_tabor(&self) -> Criterion {
        let Summits { height, density } = Summits::of(self.amplitude);
        let curvature = self.mean_curvature();
        let covered = PI * height / curvature * density;
        let joined = (covered > 1.0).then(|| {
            let covered = number(covered);
            format!("summits pressed in by σ would cover {covered} times the area, needs at most 1")
        });
        let theta = (height.powi(3) * curvature).sqrt() / self.stretch;
        let judged = FULLER_TABOR.judge(theta, &[long_ranged(self.tabor_number), joined]);
        if judged.sticks == Some(false) && theta <= NEVER_BONDS {
            let reason = Some(format!("from 1 to {NEVER_BONDS}: adheres under pressure"));
            return Criterion {
                sticks: None,
                reason,
                ..judged
            };
        }
        judged
    }
}

/// Summits of an isotropic surface with normally distributed heights.
struct Summits {
    /// Rms height σ of the summits about their mean in m.
    height: f64,
    /// Number of summits per area in 1/m².
    density: f64,
}

impl Summits {
    /// Computes the summits from the moments m₀ = h², m₂ = g²/2, m₄ = (3/8)⟨(∇²z)²⟩ of profiles cut
    /// from the surface: σ² = m₀(1 − 0.8968/α) with Nayak's bandwidth α = m₀m₄/m₂² (Bush, Gibson
    /// and Keogh 1976), density (m₄/m₂)/(6π√3) (Nayak 1971).
    fn of(amplitude: Amplitude) -> Summits {
        let Amplitude {
            rms_height,
            rms_gradient,
            rms_curvature,
            ..
        } = amplitude;
        let second = 0.5 * rms_gradient.powi(2);
        let fourth = 0.375 * rms_curvature.powi(2);
        let bandwidth = (rms_height / second).powi(2) * fourth;
        Summits {
            height: rms_height * (1.0 - 0.8968 / bandwidth).max(0.0).sqrt(),
            density: fourth / second / (6.0 * PI * 3.0_f64.sqrt()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a contact with a self-affine surface whose wavelengths go from `longest` to
    /// `longest`/`ratio`. The profile is 100 times as long as the longest wave.
    fn contact(
        hurst: f64,
        longest: f64,
        ratio: u64,
        height: f64,
        stretch: f64,
        range: f64,
    ) -> RoughContact {
        let spectrum = SelfAffine {
            hurst,
            first: 100,
            last: 100 * ratio,
            roll_off_mode: 0.0,
        };
        let length = 100.0 * longest;
        let amplitude = spectrum.unit_amplitude(length).scaled(height);
        RoughContact {
            amplitude,
            stretch,
            range,
            spectrum: Some(spectrum),
            length,
            tabor_number: None,
        }
    }

    fn near(found: f64, expected: f64, error: f64) -> bool {
        (found / expected - 1.0).abs() < error
    }

    /// Returns the root, between two positive numbers, of an increasing function.
    fn root(mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            if function(middle) < 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        low
    }

    #[test]
    fn published_scenes_have_their_numbers() {
        // These soft surfaces have H = 0.8 and waves from 100 µm to 0.1 µm.
        for (height, expected) in [(0.3e-6, [0.20, 0.013, 0.28]), (1e-6, [2.2, 0.095, 0.92])] {
            let rows = contact(0.8, 1e-4, 1000, height, 0.05 / 2.67e6, 0.3e-9).criteria();
            for (row, expected) in rows.iter().zip(expected) {
                assert_eq!(number(row.value.unwrap()), number(expected), "{row:?}");
            }
        }
        // This is the surface of the Contact-Mechanics Challenge (Müser et al. 2017). The profile
        // is ten times as long as the longest wave.
        let spectrum = SelfAffine {
            hurst: 0.8,
            first: 10,
            last: 10_000,
            roll_off_mode: 50.0,
        };
        let unit = spectrum.unit_amplitude(1e-3);
        let challenge = RoughContact {
            amplitude: unit.scaled(1.0 / unit.rms_gradient),
            spectrum: Some(spectrum),
            length: 1e-3,
            ..contact(0.8, 1e-4, 200, 1e-6, 0.05 / 25e6, 2.07e-9)
        };
        assert_eq!(number(1e6 * challenge.amplitude.rms_height), "0.78");
        let values = challenge
            .criteria()
            .iter()
            .map(|row| number(row.value.unwrap()))
            .collect::<Vec<_>>();
        assert_eq!(values[..3], ["41", "5.6", "4.9"]);
        assert!(
            challenge.criteria()[..3]
                .iter()
                .all(|row| row.sticks == Some(false))
        );
    }

    /// For a self-affine spectrum, e_el/γ of Persson and Tosatti agrees with its closed form.
    #[test]
    fn conformity_has_its_closed_form() {
        for (hurst, ratio) in [(0.6, 50), (0.8, 1000), (0.95, 200)] {
            let (height, longest, stretch) = (2e-7, 5e-5, 3e-8);
            let found = contact(hurst, longest, ratio, height, stretch, 3e-10).persson_tosatti();
            let (zeta, q) = (ratio as f64, TAU / longest);
            let bands = (1.0 - zeta.powf(1.0 - 2.0 * hurst)) / (1.0 - zeta.powf(-2.0 * hurst));
            let expected = height.powi(2) * q * 0.5 * hurst / (2.0 * hurst - 1.0) * bands / stretch;
            assert!(
                near(found.value.unwrap(), expected, 0.01),
                "{hurst}: {found:?} {expected}"
            );
            assert_eq!(found.sticks, Some(expected < 1.0));
        }
        let rough = contact(0.3, 1e-4, 100, 1e-7, 1e-8, 3e-10).persson_tosatti();
        assert_eq!(rough.sticks, None);
        assert!(
            rough
                .words()
                .ends_with("does not hold: H 0.3, needs H > 0.5"),
            "{}",
            rough.words()
        );
    }

    /// The threshold of P follows from the balance of forces. The contact is a strip of the width d
    /// on a cylinder of the radius R = 2/c. The gap beside the strip, which is integrated here,
    /// gives the width of the rim that attracts.
    #[test]
    fn the_edge_of_spots_attracts_as_much_as_they_repel_at_the_threshold() {
        assert!(near(
            PASTEWKA_ROBBINS.threshold,
            PI * (3.0_f64 / 16.0).powf(2.0 / 3.0),
            1e-15
        ));
        let soft = contact(0.8, 1e-4, 300, 4e-7, 1e-8, 1e-12);
        let (gradient, curvature) = (soft.amplitude.rms_gradient, soft.mean_curvature());
        let (diameter, radius) = (4.0 * gradient / curvature, 2.0 / curvature);
        let half = diameter / 2.0;
        // Gap at the distance s from the edge of the strip of half-width a: ∫√(x² − a²)dx/R from a
        // to a + s.
        let gap = |s: f64| {
            let step = s / 1e4;
            let slope = |index: u32| {
                let beyond = (f64::from(index) + 0.5) * step;
                (beyond * (2.0 * half + beyond)).sqrt()
            };
            (0..10_000).map(slope).sum::<f64>() * step / radius
        };
        let width = root(1e-9 * half, half, |s| gap(s) - soft.range);
        // The attraction (γ/z₀)·s along the perimeter of the spots, per nominal area, balances the
        // pressure E*g/2 in the spots. Spots with the mean chord d have the perimeter π/d per area.
        let stretch = gradient / 2.0 * diameter / PI * soft.range / width;
        let found = RoughContact { stretch, ..soft }
            .pastewka_robbins()
            .value
            .unwrap();
        assert!(near(found, PASTEWKA_ROBBINS.threshold, 1e-3), "{found}");
        // Here P does not apply, because the range of the attraction is larger than the gaps
        // between the spots.
        let far = contact(0.8, 1e-4, 1000, 3e-7, 1e-8, 1e-8).pastewka_robbins();
        assert!(
            far.sticks.is_none() && far.reason.unwrap().starts_with("does not hold: z₀ is 0.1")
        );
    }

    /// The critical height h_c agrees with the balance of attraction and repulsion, computed for
    /// all mean gaps.
    #[test]
    fn the_bearing_area_attracts_at_some_gap_up_to_the_critical_height() {
        let (longest, stretch) = (3e-5, 2e-9);
        let net = |height: f64| {
            let at = |index: u32| {
                let gap = f64::from(index) * 1e-3;
                let attraction = (-gap * gap / 2.0).exp() / TAU.sqrt() / height * stretch;
                let repulsion = 0.75 * TAU / longest * height * (-2.0 * gap).exp();
                repulsion - attraction
            };
            (0..5000).map(at).fold(f64::INFINITY, f64::min)
        };
        let critical = root(1e-9, 1e-5, net);
        let found = contact(0.8, longest, 200, critical, stretch, 3e-10).bearing_area();
        assert!(near(found.value.unwrap(), 1.0, 1e-5), "{found:?}");
        assert!(
            near(
                (stretch * longest).sqrt() / critical,
                0.6_f64.sqrt().recip(),
                0.03
            ),
            "published 0.6"
        );
        let soft = RoughContact {
            tabor_number: Some(189.0),
            ..contact(0.8, 1e-4, 200, 1e-7, 1e-8, 3e-10)
        };
        assert_eq!(
            soft.bearing_area().reason.unwrap(),
            "does not hold: μ 190, needs stiff bodies, less than 5"
        );
    }

    /// The formulas for the summits agree with the heights and the number of the maxima of random
    /// surfaces, which are sums of plane waves.
    #[test]
    fn summits_are_those_of_random_surfaces() {
        const SIDE: usize = 120;
        const STEP: f64 = 0.6;
        let mut state = 1_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        // The first surfaces have waves of one length, the others have lengths that differ by up to
        // a factor of three. The shortest length is 2π.
        for lowest in [1.0, 1.0 / 3.0] {
            let (mut heights, mut moments, surfaces) = (Vec::new(), [0.0; 3], 12);
            for _ in 0..surfaces {
                let mut z = vec![0.0; SIDE * SIDE];
                for _ in 0..60 {
                    let (q, angle, phase) = (
                        lowest + (1.0 - lowest) * random(),
                        TAU * random(),
                        TAU * random(),
                    );
                    let (x, y) = (q * STEP * angle.cos(), q * STEP * angle.sin());
                    for (index, z) in z.iter_mut().enumerate() {
                        *z += ((index % SIDE) as f64 * x + (index / SIDE) as f64 * y + phase).cos();
                    }
                    (0..3).for_each(|power| moments[power] += 0.5 * q.powi(2 * power as i32));
                }
                for row in 1..SIDE - 1 {
                    for column in 1..SIDE - 1 {
                        let at = |dy: usize, dx: usize| z[(row + dy - 1) * SIDE + column + dx - 1];
                        let own = at(1, 1);
                        let beside = (0..9)
                            .filter(|place| *place != 4)
                            .map(|place| at(place / 3, place % 3));
                        heights.extend(beside.fold(own, f64::max).eq(&own).then_some(own));
                    }
                }
            }
            let [height, gradient, curvature] =
                moments.map(|moment: f64| (moment / f64::from(surfaces)).sqrt());
            let amplitude = Amplitude {
                rms_height: height,
                rms_gradient: gradient,
                rms_curvature: curvature,
                mean_wave_number: 0.0,
            };
            let expected = Summits::of(amplitude);
            let area = f64::from(surfaces) * ((SIDE - 2) as f64 * STEP).powi(2);
            let found = heights.len() as f64 / area;
            assert!(
                near(found, expected.density, 0.1),
                "{lowest}: {found} {}",
                expected.density
            );
            let mean = heights.iter().sum::<f64>() / heights.len() as f64;
            let spread = (heights
                .iter()
                .map(|height| (height - mean).powi(2))
                .sum::<f64>()
                / heights.len() as f64)
                .sqrt();
            assert!(
                near(spread, expected.height, 0.1),
                "{lowest}: {spread} {}",
                expected.height
            );
        }
    }

    /// θ is proportional to the ratio of the Hertzian force that presses a summit in by σ to the
    /// pull-off force of the summit by JKR theory.
    #[test]
    fn theta_is_hertzian_repulsion_over_pull_off_force() {
        let narrow = contact(0.8, 1e-5, 2, 1e-8, 1e-9, 3e-10);
        let (sigma, radius) = (
            Summits::of(narrow.amplitude).height,
            1.0 / narrow.mean_curvature(),
        );
        let hertz = 4.0 / 3.0 * radius.sqrt() * sigma.powf(1.5);
        let pull_off = 1.5 * PI * radius * narrow.stretch;
        let found = narrow.fuller_tabor();
        assert!(
            near(
                found.value.unwrap() * 16.0 / 9.0 / TAU,
                hertz / pull_off,
                1e-12
            ),
            "{found:?}"
        );
        let verdict = |stretch: f64| {
            RoughContact {
                stretch,
                ..contact(0.8, 1e-5, 2, 1e-8, 1e-9, 3e-10)
            }
            .fuller_tabor()
        };
        let theta = found.value.unwrap();
        let at = |wanted: f64| verdict(1e-9 * theta / wanted);
        assert_eq!(
            [0.9, 1.1, 11.9, 12.1].map(|theta| at(theta).sticks),
            [Some(true), None, None, Some(false)]
        );
        assert_eq!(
            at(5.0).words(),
            "θ = 5; from 1 to 12: adheres under pressure"
        );
        let broad = contact(0.8, 1e-4, 1000, 3e-7, 1e-8, 3e-10).fuller_tabor();
        assert!(
            broad
                .reason
                .unwrap()
                .contains("would cover 7.9 times the area")
        );
    }
}
