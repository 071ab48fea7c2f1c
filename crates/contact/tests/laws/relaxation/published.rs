//! Comparison with published solutions of the viscoelastic contact of a sphere. Their statements
//! are tested where the edge relaxes much faster than the bulk, as this model assumes. In addition,
//! the pull-off force at several speeds is compared with a quadrature.
//!
//! * Mandriota, Menga and Carbone, arXiv 2407.11524: after full relaxation, a retraction detaches
//!   like a flat punch, at constant contact.
//! * Violano and Afferrante (size effects in adhesive contacts of viscoelastic media), and Maghami
//!   et al., arXiv 2407.01347: the pull-off grows with the largest contact up to a limit.
//! * Afferrante and Violano, arXiv 2107.03796: at equal speeds of approach and retraction the
//!   dissipation has a peak over the speed.
//! * Ciavarella and Papangelo, arXiv 2211.13530: a flat punch pulls off between the forces of
//!   Kendall with the relaxed modulus and with the modulus at once.

use super::*;

const JKR: f64 = 1.5 * PI;
const SHARE: f64 = 0.5;

fn sphere(time: f64, speed: f64) -> Sphere {
    Sphere {
        points: 2001,
        work: 1.0,
        share: SHARE,
        time,
        speed,
        stiffness: f64::INFINITY,
    }
}

/// Pull-off force of a sphere with R = γ = E₀ = 1 that is pressed to `deepest` and pulled at unit
/// speed, by the memory of each radius on a fine grid, without springs of a line.
fn by_quadrature(deepest: f64, time: f64) -> f64 {
    let remaining = 1.0 - SHARE;
    // The edge on the approach: d = a² − √(2πa).
    let edge_at = |radius: f64| radius * radius - (2.0 * PI * radius).sqrt();
    let ascending = |seconds: f64| time * (1.0 - (-seconds / time).exp());
    let step = 2e-4;
    let mut radii = Vec::new();
    let mut memories = Vec::new();
    // Integrals of the memories, each decayed to the time zero of its own.
    let mut sums = vec![0.0];
    for index in 0.. {
        let radius = step * (f64::from(index) + 0.5);
        let attached = edge_at(radius).max(0.0);
        if attached > deepest {
            break;
        }
        let memory = attached - radius * radius - ascending(attached);
        let memory = memory * ((attached - deepest) / time).exp();
        sums.push(sums[sums.len() - 1] + step * memory);
        memories.push(memory);
        radii.push(radius);
    }
    let mut inside = radii.len();
    let mut smallest: f64 = 0.0;
    let mut since = 0.0;
    while inside > 0 {
        since += 2e-4;
        let depth = deepest - since;
        let decay = (-since / time).exp();
        let common = ascending(deepest) * decay - time * (1.0 - decay);
        let stress = |index: usize| {
            let elastic = remaining * (depth - radii[index] * radii[index]);
            elastic + SHARE * (common + memories[index] * decay)
        };
        while inside > 0 && stress(inside - 1) < -(2.0 * PI * radii[inside - 1]).sqrt() {
            inside -= 1;
        }
        let radius = step * inside as f64;
        let elastic = remaining * (radius * depth - radius.powi(3) / 3.0);
        let force = 2.0 * (elastic + SHARE * (common * radius + sums[inside] * decay));
        smallest = smallest.min(force);
    }
    -smallest
}

#[test]
fn the_pull_off_at_equal_speeds_is_that_of_the_memories() {
    for deepest in [1.0, 4.0] {
        let mut before = 0.0;
        for ratio in [1e-3, 1e-2, 1e-1, 1.0, 1e1] {
            let stages = [Move::ToIndentation(deepest), Move::ToSeparation];
            let cycle = sphere(deepest / ratio, 1.0).contact().load(&stages);
            let found = cycle.unwrap().pull_off_force().unwrap() / JKR;
            let expected = by_quadrature(deepest, deepest / ratio) / JKR;
            println!("{deepest} {ratio}: {found:.4} {expected:.4}");
            assert!((found - expected).abs() < 2e-3, "{found} {expected}");
            assert!(found > before && found < 1.001 / (1.0 - SHARE), "{found}");
            before = found;
        }
    }
}

/// Radius of the contact of a sphere with E₀ = γ = 1 at the indentation `depth` on the approach.
fn radius_at(depth: f64) -> f64 {
    let [mut low, mut high]: [f64; 2] = [1.8, 10.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle * middle - (2.0 * PI * middle).sqrt() < depth {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// After full relaxation the force over the radius is (4/3) E∞ a³ − √(8πE₀γa³). Below the radius
/// of its minimum the contact stays constant up to the pull-off, which then depends on the largest
/// contact. The speed does not matter.
#[test]
fn after_full_relaxation_a_small_contact_detaches_like_a_punch() {
    let remaining = 1.0 - SHARE;
    let critical = (1.5 * (8.0 * PI).sqrt() / (4.0 * remaining)).powf(2.0 / 3.0);
    for speed in [1e-3, 1.0, 1e3] {
        for deepest in [0.2, 1.0, 1.7, 4.0] {
            let radius = radius_at(deepest).min(critical);
            let expected =
                (8.0 * PI * radius.powi(3)).sqrt() - 4.0 / 3.0 * remaining * radius.powi(3);
            let stages = [
                Move::ToIndentation(deepest),
                Move::Hold(40.0),
                Move::ToSeparation,
            ];
            let cycle = sphere(1.0, speed).contact().load(&stages).unwrap();
            let found = cycle.pull_off_force().unwrap();
            println!("{speed} {deepest}: {found:.4} {expected:.4}");
            assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
            let curve = &cycle.stages()[2].curve;
            let lowest = curve.iter().min_by(|a, b| a.force.total_cmp(&b.force));
            let shrunk = lowest.unwrap().contact_length / curve[0].contact_length;
            let stays = radius_at(deepest) < critical;
            assert_eq!(shrunk > 0.99, stays, "{deepest}: {shrunk}");
        }
    }
}

#[test]
fn at_equal_speeds_the_bulk_dissipates_most_between() {
    let deepest = 2.0;
    let mut energies = Vec::new();
    for exponent in -6..=6 {
        let time = deepest / 10.0_f64.powf(0.5 * f64::from(exponent));
        let stages = [Move::ToIndentation(deepest), Move::ToSeparation];
        let cycle = sphere(time, 1.0).contact().load(&stages).unwrap();
        let bulk = cycle.stages().iter().map(|stage| stage.dashpot_energy);
        energies.push(bulk.sum::<f64>());
    }
    println!("{energies:.3?}");
    let largest = energies.iter().copied().fold(0.0, f64::max);
    let peak = energies
        .iter()
        .position(|energy| *energy == largest)
        .unwrap();
    assert!((5..=9).contains(&peak), "{energies:?}");
    assert!(energies[..=peak].windows(2).all(|pair| pair[0] < pair[1]));
    assert!(energies[peak..].windows(2).all(|pair| pair[0] > pair[1]));
    assert!(energies[0] < 0.01 * largest, "{energies:?}");
}

/// The law of this program is the limit of a fast edge: the punch pulls off with the modulus at
/// once, at any speed. The full solution comes down to the relaxed modulus at low speeds.
#[test]
fn a_punch_pulls_off_with_the_modulus_at_once_at_any_speed() {
    let profile = Profile::from_gaps(vec![0.0; 101], 0.01).unwrap();
    let length: f64 = 1.01;
    let kendall = (PI * length.powi(3)).sqrt();
    for speed in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
        let contact = Contact::builder(&profile, Modulus::effective(1.0).unwrap())
            .work_of_adhesion(1.0)
            .relaxation(Relaxation::new(SHARE, 1.0).unwrap())
            .loading_speed(speed)
            .build()
            .unwrap();
        let stages = [
            Move::ToIndentation(0.5),
            Move::Hold(5.0),
            Move::ToSeparation,
        ];
        let found = contact.load(&stages).unwrap().pull_off_force().unwrap();
        assert!(
            (found / kendall - 1.0).abs() < 2e-3,
            "{speed}: {found} {kendall}"
        );
    }
}
