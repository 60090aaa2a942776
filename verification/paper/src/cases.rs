//! Contacts by the paper's dimensionless ratios, and the units in which its figures are drawn.
//!
//! In these units the results do not depend on the size, modulus and friction chosen here.

use microslip::constant_load::{ConstantLoad, Law, masing, state};
use microslip::element::{Directions, Element, NormalInput};
use microslip::{Contact, CurvePoint, EllipticParameters, Material, Parameters};
use reference::Input;
use reference::family::load_of_size;
use std::f64::consts::PI;

/// Half-width b of the contacts \[m\].
const HALF_WIDTH: f64 = 1e-3;
/// Large compared with b, as for half-planes.
const EDGE_RADIUS: f64 = 50.0 * HALF_WIDTH;
const FRICTION: f64 = 0.5;
const STEEL: Material = Material { young_modulus: 2.1e11, poisson_ratio: POISSON };

/// The paper gives no Poisson's ratio.
pub const POISSON: f64 = 0.3;

/// A contact with its units.
pub struct Case {
    pub contact: Contact,
    input: Input,
    /// a \[m\].
    pub flat: f64,
    /// R \[m\].
    pub edge_radius: f64,
    /// L \[m\].
    pub length: f64,
    /// N \[N\].
    pub normal_force: f64,
}

/// E* of two like bodies (Eq. 2).
fn composite_modulus() -> f64 {
    STEEL.young_modulus / (2.0 * (1.0 - POISSON.powi(2)))
}

impl Case {
    /// A flat with rounded edges, or a cylinder, by a/b and L/b.
    pub fn flat(flat_over_width: f64, length_over_width: f64) -> Case {
        let (flat, length) = (flat_over_width * HALF_WIDTH, length_over_width * HALF_WIDTH);
        let w = ((HALF_WIDTH - flat) * (HALF_WIDTH + flat)).sqrt();
        let line_load = composite_modulus() * load_of_size(flat, w) / (4.0 * EDGE_RADIUS);
        Case::loaded(flat, EDGE_RADIUS, length, line_load * length)
    }

    /// A flat by a/R, L/R and P/(E* R). `widened` is 1, or 2 for Eq. 1 as printed, which is that of twice the radius.
    pub fn under_load(flat_over_radius: f64, length_over_radius: f64, load: f64, widened: f64) -> Case {
        let (flat, length) = (flat_over_radius * EDGE_RADIUS, length_over_radius * EDGE_RADIUS);
        let normal_force = load * composite_modulus() * EDGE_RADIUS * length;
        Case::loaded(flat, widened * EDGE_RADIUS, length, normal_force)
    }

    fn loaded(flat: f64, edge_radius: f64, length: f64, normal_force: f64) -> Case {
        let parameters = Parameters {
            flat_half_width: flat,
            edge_radius,
            length,
            normal_force,
            friction_coefficient: FRICTION,
            material: [STEEL; 2],
            displacement_reference: microslip::parameters::CENTRE_POINT,
            ..Parameters::default()
        };
        let contact = Contact::rounded_flat(&parameters).expect("a contact of the paper");
        Case { contact, input: Input::Flat(parameters), flat, edge_radius, length, normal_force }
    }

    /// The elliptical contact of section 3.3 corresponding to the cylinder of this L/b: semi-axes b and L/2, the same normal force.
    pub fn ellipse(length_over_width: f64) -> Case {
        let cylinder = Case::flat(0.0, length_over_width);
        Case::hertz(cylinder.contact.half_width, cylinder.length / 2.0, cylinder.normal_force)
    }

    pub fn sphere() -> Case {
        Case::hertz(HALF_WIDTH, HALF_WIDTH, 1000.0)
    }

    fn hertz(semi_axis_x: f64, semi_axis_y: f64, normal_force: f64) -> Case {
        let parameters = EllipticParameters {
            semi_axis_x,
            semi_axis_y,
            normal_force,
            friction_coefficient: FRICTION,
            material: [STEEL; 2],
            ..EllipticParameters::default()
        };
        let contact = Contact::elliptic(&parameters).expect("an ellipse of the paper");
        let length = 2.0 * semi_axis_y;
        let input = Input::Ellipse(parameters);
        Case { contact, input, flat: 0.0, edge_radius: f64::NAN, length, normal_force }
    }

    /// The same contact under a normal force that varies.
    pub fn element(&self, directions: Directions, input: NormalInput) -> Element {
        match &self.input {
            Input::Flat(parameters) => Element::rounded_flat(parameters, directions, input),
            Input::Ellipse(parameters) => Element::elliptic(parameters, directions, input),
        }
        .expect("an element of the paper")
    }

    /// a/b of the contact.
    pub fn flat_over_width(&self) -> f64 {
        self.flat / self.contact.half_width
    }

    /// P \[N/m\].
    pub fn line_load(&self) -> f64 {
        self.normal_force / self.length
    }

    /// 2μP/(πE*) \[m\]: the factor of Eq. 10 under μP.
    pub fn displacement_unit(&self) -> f64 {
        2.0 * self.contact.slip_force / (PI * self.contact.composite_modulus * self.length)
    }

    /// 2(μP)²L/(πE*) \[J\]: the energy of Eq. 16.
    pub fn energy_unit(&self) -> f64 {
        self.contact.slip_force * self.displacement_unit()
    }

    /// E* L \[N/m\].
    pub fn stiffness_unit(&self) -> f64 {
        self.contact.composite_modulus * self.length
    }

    /// Displacement of gross slip, in its unit.
    pub fn slip_displacement(&self) -> f64 {
        self.contact.slip_displacement / self.displacement_unit()
    }

    /// Initial stiffness, in its unit.
    pub fn initial_stiffness(&self) -> f64 {
        self.contact.initial_stiffness / self.stiffness_unit()
    }

    /// The point of the monotonic curve at Q/μP.
    pub fn at_force(&self, force: f64) -> CurvePoint<'_> {
        self.contact.curve_at_force(force * self.contact.slip_force).expect("a force up to gross slip")
    }

    /// Displacement on the monotonic curve at Q/μP.
    pub fn displacement(&self, force: f64) -> f64 {
        self.at_force(force).displacement() / self.displacement_unit()
    }

    /// Q/μP on the monotonic curve at a displacement in its unit.
    pub fn force(&self, displacement: f64) -> f64 {
        let displacement = displacement * self.displacement_unit();
        self.contact.curve_at_displacement(displacement).expect("a displacement").force() / self.contact.slip_force
    }

    /// Half-width of the stick zone over b at Q/μP.
    pub fn stick_zone(&self, force: f64) -> f64 {
        self.at_force(force).stick_half_width() / self.contact.half_width
    }

    /// A traction at x/b over P/b; 0 at the edge, though the rounded b may differ.
    fn traction(&self, x: f64, at: impl FnOnce(f64) -> f64) -> f64 {
        let b = self.contact.half_width;
        if x.abs() >= 1.0 { 0.0 } else { at(x * b) * b / self.line_load() }
    }

    /// b p/P at x/b.
    pub fn pressure(&self, x: f64) -> f64 {
        self.traction(x, |x| self.contact.pressure(x))
    }

    /// b q/(μP) at x/b and Q/μP.
    pub fn shear(&self, x: f64, force: f64) -> f64 {
        self.traction(x, |x| self.at_force(force).shear(x)) / FRICTION
    }

    /// Slip at x/b and Q/μP, in the unit of the displacement.
    pub fn slip(&self, x: f64, force: f64) -> f64 {
        self.at_force(force).slip(x * self.contact.half_width).expect("a rounded flat") / self.displacement_unit()
    }

    /// The state after displacements in their unit.
    pub fn state_after(&self, displacements: &[f64]) -> Vec<f64> {
        let mut state = vec![0.0; state::state_length(2)];
        ConstantLoad::state_init(&mut state).expect("a state");
        for displacement in displacements {
            let displacement = displacement * self.displacement_unit();
            ConstantLoad::step(&self.contact, &mut state, displacement).expect("a step");
        }
        state
    }

    /// b q/(μP) at x/b of a state.
    pub fn shear_of_state(&self, state: &[f64], x: f64) -> f64 {
        let mut shear = [0.0];
        let mut at = |x| {
            masing::shear_tractions(&self.contact, state, &[x], &mut shear).expect("a traction");
            shear[0]
        };
        self.traction(x, &mut at) / FRICTION
    }

    /// Energy per cycle between ± Q/μP, in its unit.
    pub fn energy(&self, force: f64) -> f64 {
        let energy = self.contact.dissipated_energy(force * self.contact.slip_force);
        energy.expect("a force up to gross slip") / self.energy_unit()
    }

    /// K' and K'' at a displacement amplitude, in their unit.
    pub fn complex_stiffness(&self, amplitude: f64) -> (f64, f64) {
        let stiffness = self.contact.complex_stiffness(amplitude * self.displacement_unit()).expect("an amplitude");
        (stiffness.real / self.stiffness_unit(), stiffness.imaginary / self.stiffness_unit())
    }

    /// The closed loop of a displacement amplitude: displacements and forces at the given number of instants and again the first.
    pub fn hysteresis_loop(&self, amplitude: f64, instants: usize) -> (Vec<f64>, Vec<f64>) {
        let cycle = self.contact.hysteresis_loop(amplitude * self.displacement_unit()).expect("an amplitude");
        (0..=instants)
            .map(|i| {
                let (displacement, force) = (cycle.displacement(i, instants), cycle.force(i, instants));
                (displacement / self.displacement_unit(), force / self.contact.slip_force)
            })
            .unzip()
    }
}
