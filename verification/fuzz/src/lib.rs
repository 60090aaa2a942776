//! Inputs shared by the targets: numbers relative to a scale, displacement paths, and contacts; the calls of the tests.

#[allow(dead_code, missing_docs, reason = "the valid arguments are those of the tests")]
#[path = "../../../tests/calls/mod.rs"]
pub mod interface;

/// Asserts a bound of all values; NaN violates it.
#[macro_export]
macro_rules! all {
    ($values:expr, $bound:expr) => {
        assert!($values.iter().copied().all($bound), "{}: {:?}", stringify!($bound), $values)
    };
}

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use microslip::{Contact, EllipticParameters, Error, Layer, Material, Parameters};
use std::sync::OnceLock;

/// A number relative to a scale.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Number {
    Multiple(i16),
    BelowScale(u8),
    PowerOfTwo(i8),
    /// Units in the last place from the scale.
    NextToScale(i8),
    /// Units in the last place from an earlier number.
    Repeated(u8, i8),
    Special(u8),
    Bits(u64),
}

#[rustfmt::skip]
const SPECIAL: [f64; 20] = [
    0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, f64::MIN_POSITIVE, 1e-300, 1e-160, 1e-8, 0.5, 1e150, -1e150, 1.000_000_000_000_000_2e150,
    1e160, f64::MAX, f64::MIN, f64::INFINITY, f64::NEG_INFINITY, f64::NAN,
];

/// The numbers of an input so far: return points and neighbouring values need repetitions.
#[derive(Default)]
pub struct Numbers(Vec<f64>);

impl Numbers {
    pub fn one(&mut self, number: Number, scale: f64) -> f64 {
        let neighbour = |value: f64, ulps: i8| f64::from_bits(value.to_bits().wrapping_add_signed(ulps.into()));
        let value = match number {
            Number::Multiple(factor) => scale * f64::from(factor) / 8192.0,
            Number::BelowScale(bits) => scale * (1.0 - 2f64.powi(-i32::from(bits % 64))),
            Number::PowerOfTwo(exponent) => scale * 2f64.powi(exponent.into()),
            Number::NextToScale(ulps) => neighbour(scale, ulps / 8),
            Number::Repeated(back, ulps) => {
                let earlier = self.0.iter().rev().nth(back as usize % self.0.len().max(1));
                neighbour(*earlier.unwrap_or(&scale), if ulps % 2 == 0 { 0 } else { ulps / 8 })
            }
            Number::Special(index) => SPECIAL[index as usize % SPECIAL.len()],
            Number::Bits(bits) => f64::from_bits(bits),
        };
        self.0.push(value);
        value
    }

    pub fn all(&mut self, numbers: &[Number], scale: f64) -> Vec<f64> {
        numbers.iter().map(|&number| self.one(number, scale)).collect()
    }
}

/// Given displacements, followed by pseudo-random ones within a decreasing width, a quarter of which repeat one of the last 16.
#[derive(Arbitrary, Debug)]
pub struct Path {
    given: Vec<Number>,
    random: u8,
    width: Number,
    decay: u8,
    seed: u8,
}

impl Path {
    pub fn displacements(&self, scale: f64) -> Vec<f64> {
        let mut numbers = Numbers::default();
        let mut path = numbers.all(&self.given[..self.given.len().min(64)], scale);
        let (mut width, decay) = (numbers.one(self.width, scale), 1.0 - 2f64.powi(-i32::from(self.decay % 16)));
        let mut state = u32::from(self.seed) | 1;
        for _ in 0..4 * usize::from(self.random) {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            width *= decay;
            let repeated = path.len().checked_sub((state >> 8) as usize % 16 + 1);
            path.push(match repeated {
                Some(index) if state >> 30 == 0 => path[index],
                _ => width * (f64::from(state >> 8) * 2f64.powi(-23) - 1.0),
            });
        }
        path
    }
}

/// A parameter relative to its typical value.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Magnitude {
    Typical,
    Near(i8),
    Far(i8),
    Any(Number),
}

impl Magnitude {
    fn value(self, typical: f64) -> f64 {
        match self {
            Magnitude::Typical => typical,
            Magnitude::Near(eighths) => typical * 2f64.powf(f64::from(eighths) / 8.0),
            Magnitude::Far(exponent) => typical * 2f64.powi(4 * i32::from(exponent)),
            Magnitude::Any(number) => Numbers::default().one(number, typical),
        }
    }
}

/// A contact: one of the list, or by its parameters.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub enum Choice {
    Listed(u8),
    Flat { geometry: [Magnitude; 3], cylinder: bool, load: [Magnitude; 2], material: [Magnitude; 4], reference: u8 },
    Ellipse { geometry: [Magnitude; 2], load: [Magnitude; 2], material: [Magnitude; 4] },
}

impl Choice {
    pub fn parameters(self) -> AnyParameters {
        let material = |[e1, nu1, e2, nu2]: [Magnitude; 4]| {
            [(e1, nu1), (e2, nu2)]
                .map(|(e, nu)| Material { young_modulus: e.value(2e11), poisson_ratio: nu.value(0.3) })
        };
        match self {
            Choice::Listed(index) => listed()[index as usize % listed().len()].0,
            Choice::Flat { geometry: [a, r, l], cylinder, load: [n, mu], material: m, reference } => {
                AnyParameters::Flat(Parameters {
                    flat_half_width: if cylinder { 0.0 } else { a.value(1e-3) },
                    edge_radius: r.value(1e-2),
                    length: l.value(1e-2),
                    normal_force: n.value(100.0),
                    friction_coefficient: mu.value(0.5),
                    material: material(m),
                    layer: Layer::none(),
                    displacement_reference: i32::from(if reference < 240 { reference % 2 } else { reference }),
                    ..Parameters::default()
                })
            }
            Choice::Ellipse { geometry: [x, y], load: [n, mu], material: m } => {
                AnyParameters::Ellipse(EllipticParameters {
                    semi_axis_x: x.value(1e-4),
                    semi_axis_y: y.value(2e-4),
                    normal_force: n.value(100.0),
                    friction_coefficient: mu.value(0.5),
                    material: material(m),
                    ..EllipticParameters::default()
                })
            }
        }
    }

    /// The contact and its parameters, if these are valid.
    pub fn contact(self) -> Option<(AnyParameters, Contact)> {
        match self {
            Choice::Listed(index) => Some(listed()[index as usize % listed().len()]),
            _ => self.parameters().contact().ok().map(|contact| (self.parameters(), contact)),
        }
    }
}

/// Parameters of either kind.
#[derive(Clone, Copy, Debug)]
pub enum AnyParameters {
    Flat(Parameters),
    Ellipse(EllipticParameters),
}

impl AnyParameters {
    pub fn contact(&self) -> Result<Contact, Error> {
        match self {
            AnyParameters::Flat(p) => Contact::rounded_flat(p),
            AnyParameters::Ellipse(p) => Contact::elliptic(p),
        }
    }
}

const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

const FLAT: Parameters = Parameters {
    flat_half_width: 1e-3,
    edge_radius: 1e-2,
    length: 1e-2,
    normal_force: 100.0,
    friction_coefficient: 0.5,
    material: [STEEL; 2],
    layer: Layer::none(),
    displacement_reference: 0,
    reserved: 0,
};

/// Contacts from the cylinder to the nearly flat, short, long, open, without friction, with layers, and in extreme units, initialised
/// once.
fn listed() -> &'static [(AnyParameters, Contact)] {
    static LISTED: OnceLock<Vec<(AnyParameters, Contact)>> = OnceLock::new();
    LISTED.get_or_init(|| {
        let flat = |flat_half_width| Parameters { flat_half_width, ..FLAT };
        let unlike = [STEEL, Material { young_modulus: 7e10, poisson_ratio: 0.5 }];
        let rubber = [Material { young_modulus: 1e6, poisson_ratio: 0.0 }; 2];
        let layer = |stiffening_load| Layer {
            normal_compliance: 1e-9,
            tangential_compliance: 2e-9,
            stiffening_load,
            reference_load: 0.0,
        };
        let flats = [
            flat(0.0),
            flat(1e-9),
            flat(50e-6),
            flat(1e-3),
            flat(9e-3),
            Parameters { length: 1.43e-4, ..flat(0.0) },
            Parameters { length: 4.51e-3, ..flat(9e-3) },
            Parameters { length: 1e6, ..flat(0.0) },
            Parameters { displacement_reference: 1, ..flat(0.0) },
            Parameters { displacement_reference: 1, material: unlike, ..flat(2e-4) },
            Parameters { material: rubber, length: 1.0, ..FLAT },
            Parameters { normal_force: 1e-12, ..FLAT },
            Parameters { normal_force: 0.0, ..FLAT },
            Parameters { friction_coefficient: 0.0, ..FLAT },
            Parameters { friction_coefficient: 1e30, ..flat(50e-6) },
            Parameters { layer: layer(0.0), ..flat(50e-6) },
            Parameters { layer: layer(200.0), ..flat(0.0) },
            Parameters { layer: layer(0.1), ..FLAT },
        ];
        let axes =
            [(1e-4, 1e-4, 100.0), (1e-5, 1e-3, 100.0), (1e-2, 1e-4, 100.0), (1e45, 1e46, 100.0), (1e-4, 1e-4, 0.0)];
        let ellipses = axes.map(|(semi_axis_x, semi_axis_y, normal_force)| {
            let (friction_coefficient, material) = (0.5, [STEEL; 2]);
            EllipticParameters {
                semi_axis_x,
                semi_axis_y,
                normal_force,
                friction_coefficient,
                material,
                ..EllipticParameters::default()
            }
        });
        let extreme_units = [(50e-6, 120, -100), (0.0, -90, 200)].map(|(flat_half_width, length, force)| {
            let (metre, newton) = (2f64.powi(length), 2f64.powi(force));
            Parameters {
                flat_half_width: flat_half_width * metre,
                edge_radius: FLAT.edge_radius * metre,
                length: FLAT.length * metre,
                normal_force: FLAT.normal_force * newton,
                material: [Material { young_modulus: STEEL.young_modulus * newton / metre / metre, ..STEEL }; 2],
                ..FLAT
            }
        });
        let all = flats.into_iter().map(AnyParameters::Flat).chain(ellipses.map(AnyParameters::Ellipse));
        all.chain(extreme_units.map(AnyParameters::Flat))
            .map(|p| (p, p.contact().unwrap_or_else(|error| panic!("{p:?}: {error}"))))
            .collect()
    })
}
