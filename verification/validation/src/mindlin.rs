//! A sphere under oblique forces: the incremental formulas of Mindlin and Deresiewicz (J. Appl. Mech. 20, 1953, 327-344),
//! integrated along forces that change together, T faster than mu N.

use crate::documents::Documents;
use crate::histories::line_or_sphere;
use crate::path::Path;
use microslip::element::Directions;
use microslip::{Material, Parameters};

const YOUNG_MODULUS: f64 = 7e10;
const POISSON_RATIO: f64 = 0.33;
const FRICTION: f64 = 0.3;
/// Radius of both spheres, and the largest load.
const RADIUS: f64 = 0.02;
const LARGEST: f64 = 60.0;

/// Steps of each path.
const STEPS: u32 = 2000;

/// (2 - ν)/(4Ga), of both bodies together.
fn compliance(load: f64) -> f64 {
    let shear_modulus = YOUNG_MODULUS / (2.0 * (1.0 + POISSON_RATIO));
    let contact_radius = (3.0 * (1.0 - POISSON_RATIO) * load * RADIUS / (8.0 * shear_modulus)).cbrt();
    (2.0 - POISSON_RATIO) / (4.0 * shear_modulus * contact_radius)
}

pub fn compare(documents: &mut Documents) {
    // Equal spheres are as a sphere of half the radius on a plane.
    let parameters = Parameters {
        edge_radius: 0.5 * RADIUS,
        normal_force: LARGEST,
        friction_coefficient: FRICTION,
        material: [Material { young_modulus: YOUNG_MODULUS, poisson_ratio: POISSON_RATIO }; 2],
        ..Parameters::default()
    };
    let element = line_or_sphere(&parameters, Directions::One);
    let mut path = Path::new(&element, 64);
    path.displace(0.0, 40.0);
    // T rises, falls and rises while N rises, falls, rises, falls and rises.
    let corners: [[f64; 2]; 6] = [[40.0, 0.0], [46.0, 9.0], [41.0, 2.0], [44.0, -3.0], [38.0, 4.0], [39.0, 6.0]];
    let (mut displacement, mut reversal, mut direction) = (0.0, None, 1.0);
    let mut worst: f64 = 0.0;
    for ends in corners.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let [growth, motion] = [0, 1].map(|i: usize| to[i] - from[i]);
        let sign = motion.signum();
        if sign != direction {
            (reversal, direction) = (Some(from[1]), sign);
        }
        // The growing contact sticks at mu dN, the excess spreads over the slip zone.
        let oblique = sign * FRICTION * growth;
        let at = |fraction: f64| [from[0] + fraction * growth, from[1] + fraction * motion];
        // du/d(fraction); T* changes by ±mu dN.
        let rate = |fraction: f64| {
            let [load, force] = at(fraction);
            let since = reversal.map_or(force, |reversal: f64| 0.5 * (force - reversal + fraction * oblique));
            let share = since * sign / (FRICTION * load);
            compliance(load) * (oblique + (motion - oblique) / (1.0 - share).cbrt())
        };
        let h = 1.0 / f64::from(STEPS);
        for i in 0..STEPS {
            // Runge and Kutta's method of fourth order is Simpson's rule, since the rate does not depend on u.
            let t = f64::from(i) * h;
            displacement += h / 6.0 * (rate(t) + 4.0 * rate(t + 0.5 * h) + rate(t + h));
            let [load, force] = at(t + h);
            worst = worst.max((path.displace(displacement, load).force[0] - force).abs() / (FRICTION * load));
        }
        reversal = reversal.map(|reversal| reversal - oblique);
    }
    documents.check(worst < 1e-10, format!("Mindlin and Deresiewicz: the forces differ by {worst:e} of mu N"));
}
