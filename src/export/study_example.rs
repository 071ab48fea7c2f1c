//! Figures of studies with known numbers, for tests.

use crate::analysis::Regime;
use crate::study::figure::{AxisScale, Boundary, Estimate, Figure, FigureAxis, FigureQuantity, Panel};

fn axis(name: &str, symbol: &str, scale: AxisScale, values: Vec<f64>) -> FigureAxis {
    FigureAxis { name: name.into(), symbol: symbol.into(), unit: "1".into(), scale, values }
}

/// An axis of preloads without values.
pub(super) fn preloads() -> FigureAxis {
    FigureAxis { unit: "N".into(), ..axis("preload", "F_n", AxisScale::Logarithmic, Vec::new()) }
}

fn quantity(name: &str, symbol: &str) -> FigureQuantity {
    FigureQuantity { name: name.into(), symbol: symbol.into(), unit: "1".into(), signed: false }
}

fn kappas() -> Vec<f64> {
    (0..17).map(|index| 0.25 * 10_f64.powf(f64::from(index) / 10.0)).collect()
}

fn share(kappa: f64, hurst: f64) -> f64 {
    1.0 / (1.0 + (kappa / (1.6 + 0.8 * hurst)).powi(5))
}

fn coefficient(kappa: f64, hurst: f64) -> f64 {
    let held = 1.0 - share(kappa, hurst);
    0.9 * held * (-(kappa - 2.0) / 1.1).exp()
}

fn estimate(mean: f64) -> Option<Estimate> {
    Some(Estimate { mean, low: mean * 0.85 - 0.004, high: mean * 1.15 + 0.004 })
}

/// A map of two quantities over H and κ, with gaps.
pub(super) fn phase_map() -> Figure {
    let hursts: Vec<f64> = (0..9).map(|index| f64::from(index + 1) / 10.0).collect();
    let cells =
        || kappas().into_iter().flat_map(|kappa| hursts.clone().into_iter().map(move |hurst| (kappa, hurst)));
    let panel = |name: &str, symbol: &str, value: fn(f64, f64) -> f64| Panel {
        quantity: quantity(name, symbol),
        estimates: cells()
            .enumerate()
            .map(|(index, (kappa, hurst))| {
                estimate(value(kappa, hurst)).filter(|_| ![3, 40, 41].contains(&index))
            })
            .collect(),
        scale: AxisScale::Linear,
        range: None,
        vanishes: name == "zero-load adhesion share",
    };
    let regime = |(kappa, hurst): (f64, f64)| {
        Some(match (share(kappa, hurst), coefficient(kappa, hurst)) {
            (share, _) if share > 0.5 => Regime::PressureInsensitive,
            (_, coefficient) if coefficient > 0.01 => Regime::PressureSensitive,
            _ => Regime::NonAdhesive,
        })
    };
    Figure {
        title: "Phase diagram of adhesion".into(),
        fixed: vec!["F_n/(E* h L) = 0.5".into()],
        across: axis("Hurst exponent", "H", AxisScale::Linear, hursts.clone()),
        up: Some(axis("governing parameter", "κ", AxisScale::Logarithmic, kappas())),
        series: None,
        panels: vec![
            panel("zero-load adhesion share", "F_a(0)/F_a,max", share),
            panel("adhesion coefficient", "F_a/F_n", coefficient),
        ],
        boundary: Some(Boundary {
            values: cells().map(|(kappa, hurst)| Some(share(kappa, hurst))).collect(),
            level: 0.05,
            label: "F_a(0) = 0.05 F_a,max".into(),
        }),
        regimes: cells().map(regime).collect(),
    }
}

/// Sections of both at H = 0.3, with a gap.
pub(super) fn sections() -> Figure {
    let panel = |name: &str, symbol: &str, value: fn(f64, f64) -> f64| Panel {
        quantity: quantity(name, symbol),
        estimates: kappas()
            .into_iter()
            .enumerate()
            .map(|(index, kappa)| estimate(value(kappa, 0.3)).filter(|_| index != 4))
            .collect(),
        scale: AxisScale::Linear,
        range: None,
        vanishes: name == "zero-load adhesion share",
    };
    Figure {
        title: "Sections at H = 0.3".into(),
        fixed: vec!["H = 0.3".into(), "F_n/(E* h L) = 0.5".into()],
        across: axis("governing parameter", "κ", AxisScale::Logarithmic, kappas()),
        up: None,
        series: None,
        panels: vec![
            panel("zero-load adhesion share", "F_a(0)/F_a,max", share),
            panel("adhesion coefficient", "F_a/F_n", coefficient),
        ],
        boundary: Some(Boundary {
            values: kappas().into_iter().map(|kappa| Some(share(kappa, 0.3))).collect(),
            level: 0.05,
            label: "F_a(0) = 0.05 F_a,max".into(),
        }),
        regimes: Vec::new(),
    }
}
