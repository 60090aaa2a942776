//! A sphere under oblique forces: the incremental formulas of Mindlin and Deresiewicz (J. Appl. Mech. 20, 1953, 327-344), integrated
//! along forces that change together, T faster than mu N.

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

fn contact_radius(load: f64) -> f64 {
    let shear_modulus = YOUNG_MODULUS / (2.0 * (1.0 + POISSON_RATIO));
    (3.0 * (1.0 - POISSON_RATIO) * load * RADIUS / (8.0 * shear_modulus)).cbrt()
}

/// (2 - ν)/(4Ga), of both bodies together.
fn compliance(load: f64) -> f64 {
    let shear_modulus = YOUNG_MODULUS / (2.0 * (1.0 + POISSON_RATIO));
    (2.0 - POISSON_RATIO) / (4.0 * shear_modulus * contact_radius(load))
}

/// A straight path in forces, after a reversal at T* (`None` on the first one).
struct Branch {
    from: [f64; 2],
    to: [f64; 2],
    reversal: Option<f64>,
}

impl Branch {
    fn at(&self, fraction: f64) -> [f64; 2] {
        [0, 1].map(|i: usize| self.from[i] + fraction * (self.to[i] - self.from[i]))
    }

    /// du/d(fraction): the growing contact sticks at mu dN, the excess spreads over the slip zone.
    fn rate(&self, fraction: f64) -> f64 {
        let [load, force] = self.at(fraction);
        let (growth, motion) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let sign = motion.signum();
        let share = match self.reversal {
            None => force * sign / (FRICTION * load),
            Some(reversal) => (force - moved(reversal, sign, load - self.from[0])) * sign / (2.0 * FRICTION * load),
        };
        let oblique = sign * FRICTION * growth;
        compliance(load) * (oblique + (motion - oblique) / (1.0 - share).cbrt())
    }
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
        let (from, to) = (ends[0], ends[1]);
        let sign = (to[1] - from[1]).signum();
        if sign != direction {
            (reversal, direction) = (Some(from[1]), sign);
        }
        let branch = Branch { from, to, reversal };
        let h = 1.0 / f64::from(STEPS);
        for i in 0..STEPS {
            // Runge and Kutta's method of fourth order is Simpson's rule, since the rate does not depend on u.
            let t = f64::from(i) * h;
            displacement += h / 6.0 * (branch.rate(t) + 4.0 * branch.rate(t + 0.5 * h) + branch.rate(t + h));
            let [load, force] = branch.at(t + h);
            worst = worst.max((path.displace(displacement, load).force[0] - force).abs() / (FRICTION * load));
        }
        reversal = reversal.map(|reversal| moved(reversal, sign, to[0] - from[0]));
    }
    documents.check(worst < 1e-10, format!("Mindlin and Deresiewicz: the forces differ by {worst:e} of mu N"));
}

/// T* after a change of the load: dT* = ±mu dN.
fn moved(reversal: f64, sign: f64, growth: f64) -> f64 {
    reversal - sign * FRICTION * growth
}
