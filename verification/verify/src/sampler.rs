//! Random contacts and arguments, dense near the limits of the law and at every switch of formula.

use crate::{call, element};
use microslip::ffi::mslip_contact;
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{EllipticParameters, Layer, Material, Parameters};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use reference::family::load_of_size;
use reference::{Input, Reference};
use std::f64::consts::PI;

/// A contact of the library, and the same in multi-precision.
pub struct Case {
    pub contact: mslip_contact,
    pub reference: Reference,
    pub kind: &'static str,
}

/// An element of the library, and the same in multi-precision.
pub struct ElementCase {
    pub element: microslip::element::Element,
    pub reference: reference::element::Element,
    pub kind: &'static str,
    pub input: Input,
}

pub const KINDS: [&str; 8] = [
    "cylinder",
    "a/b < 1e-3",
    "a/b < 0.999",
    "a/b -> 1",
    "2L -> b, cylinder",
    "2L -> b, flat",
    "extreme scales",
    "ellipse",
];

pub struct Sampler(SmallRng);

impl Sampler {
    pub fn new(seed: u64) -> Sampler {
        Sampler(SmallRng::seed_from_u64(seed))
    }

    pub fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    pub fn unit(&mut self) -> f64 {
        self.0.random()
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// 10 to a random power.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    pub fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// A double within the given number of doubles from another, unless that is 0.
    pub fn near(&mut self, value: f64, units: i64) -> f64 {
        if value == 0.0 {
            return value;
        }
        let step = self.0.random_range(-units..=units);
        f64::from_bits((value.to_bits() as i64 + step) as u64)
    }

    fn material(&mut self, modulus: f64) -> Material {
        let ratio = match self.below(6) {
            0 => 0.0,
            1 => 0.5,
            2 => 0.5 - self.power(-16.0, -1.0),
            3 => self.power(-300.0, -1.0),
            _ => self.between(0.0, 0.5),
        };
        Material { young_modulus: modulus * self.power(-0.5, 0.5), poisson_ratio: ratio }
    }

    fn bodies(&mut self, modulus: f64) -> [Material; 2] {
        let first = self.material(modulus);
        let second = if self.chance(0.5) { first } else { self.material(modulus) };
        [first, second]
    }

    /// Parameters of a kind of contact; some are rejected by the library.
    pub fn parameters(&mut self, kind: &str) -> Input {
        let extreme = kind == "extreme scales";
        let (lengths, moduli) = if extreme { (self.power(-70.0, 70.0), self.power(-60.0, 60.0)) } else { (1.0, 1.0) };
        let size = lengths * self.power(-6.0, -2.0);
        let modulus = moduli * self.power(9.0, 12.0);
        let mut material = self.bodies(modulus);
        let friction_coefficient = if extreme { self.power(-60.0, 20.0) } else { self.power(-3.0, 1.0) };
        if kind == "ellipse" {
            let ratio = match self.below(4) {
                0 => 1.0,
                1 => 1.0 + self.power(-15.0, -1.0),
                2 => self.power(-8.0, 8.0),
                _ => self.power(-1.0, 1.0),
            };
            return Input::Ellipse(EllipticParameters {
                semi_axis_x: size,
                semi_axis_y: size * ratio,
                normal_force: self.power(-3.0, 5.0),
                friction_coefficient,
                material,
                ..EllipticParameters::default()
            });
        }
        // a and w over b; 1 - a/b may be below rounding.
        let (a, w) = match (kind, self.below(5)) {
            ("cylinder" | "2L -> b, cylinder", _) => (0.0, 1.0),
            ("a/b < 1e-3", 0) => (self.power(-300.0, -15.0), 1.0),
            ("a/b < 1e-3", _) => (self.power(-16.0, -3.0), 1.0),
            ("a/b -> 1", 0) => (1.0, (2.0 * self.power(-40.0, -15.0)).sqrt()),
            ("a/b -> 1", _) => {
                let share = self.power(-15.0, -3.0);
                (1.0 - share, (share * (2.0 - share)).sqrt())
            }
            // The formulas change at ψ = π/3.
            (_, 0) => {
                let psi = PI / 3.0 * (1.0 + self.power(-16.0, -2.0) * if self.chance(0.5) { 1.0 } else { -1.0 });
                (psi.cos(), psi.sin())
            }
            _ => {
                let a = self.between(1e-3, 0.999);
                (a, ((1.0 - a) * (1.0 + a)).sqrt())
            }
        };
        let slenderness = match kind {
            "2L -> b, cylinder" | "2L -> b, flat" => {
                if self.chance(0.7) {
                    material.iter_mut().for_each(|body| body.poisson_ratio = 0.0);
                }
                1.0 + self.power(-14.0, -0.3)
            }
            _ if self.chance(0.5) => self.power(0.5, 2.5),
            _ => self.power(0.05, 8.0),
        };
        let compliance = |body: &Material| (1.0 - body.poisson_ratio.powi(2)) / body.young_modulus;
        let composite = 1.0 / (compliance(&material[0]) + compliance(&material[1]));
        let edge_radius = lengths * self.power(-4.0, 0.0);
        let length = 0.5 * size * slenderness;
        Input::Flat(Parameters {
            flat_half_width: a * size,
            edge_radius,
            length,
            normal_force: size * size * (length / edge_radius) * composite * (0.25 * load_of_size(a, w)),
            friction_coefficient,
            material,
            displacement_reference: if self.chance(0.3) { RIGID_STRIP } else { CENTRE_POINT },
            layer: Layer::none(),
            reserved: 0,
        })
    }

    /// A contact of a kind that the library accepts.
    pub fn case(&mut self, kind: &'static str) -> Case {
        loop {
            let input = self.parameters(kind);
            if let Some(contact) = call::prepare(&input) {
                return Case { contact, reference: Reference::new(input), kind };
            }
        }
    }

    /// An element of a kind that the library accepts.
    pub fn element(&mut self, kind: &'static str) -> ElementCase {
        loop {
            let input = self.parameters(kind);
            if let Some((element, reference)) = element::prepare(&input, self.chance(0.5)) {
                return ElementCase { element, reference, kind, input };
            }
        }
    }

    /// A share of mu N, and its range.
    pub fn share_of_force(&mut self) -> (f64, &'static str) {
        match self.below(8) {
            0 if self.chance(0.05) => (self.power(-100.0, -12.0), "-> 0"),
            0 | 1 => (self.power(-12.0, -3.0), "-> 0"),
            2 | 3 => (1.0 - self.power(-16.0, -3.0), "-> slip"),
            4 => (self.near(0.5, 64), "switches"),
            5 if self.chance(0.1) => (1.0, "slip"),
            _ => (self.between(1e-3, 0.999), "between"),
        }
    }
}

pub fn text(input: &Input) -> String {
    let of_layer = |layer: &Layer| match layer.tangential_compliance {
        0.0 => String::new(),
        compliance => format!(" c_t {compliance:e} N_c {:e}", layer.stiffening_load),
    };
    let common = |load: f64, friction: f64, [one, two]: &[Material; 2]| {
        let ([e1, e2], [nu1, nu2]) = ([one, two].map(|m| m.young_modulus), [one, two].map(|m| m.poisson_ratio));
        format!("N {load:e} mu {friction:e} E {e1:e} {e2:e} nu {nu1:e} {nu2:e}")
    };
    match input {
        Input::Flat(p) => {
            let common = common(p.normal_force, p.friction_coefficient, &p.material);
            let (reference, layer) = (p.displacement_reference, of_layer(&p.layer));
            let [a, radius, length] = [p.flat_half_width, p.edge_radius, p.length];
            format!("a {a:e} R {radius:e} L {length:e} {common} reference {reference}{layer}")
        }
        Input::Ellipse(p) => {
            let common = common(p.normal_force, p.friction_coefficient, &p.material);
            format!("b {:e} l {:e} {common}{}", p.semi_axis_x, p.semi_axis_y, of_layer(&p.layer))
        }
    }
}
