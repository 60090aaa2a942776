//! An element with two tangential directions and its state, and the harmonic force of a motion with one harmonic.

use microslip::element::{Directions, Element, NormalInput};
use microslip::law::LawStep;
use microslip::parameters::{CENTRE_POINT, EllipticParameters, Layer, Material, Parameters};
use microslip::two_directions::harmonic_force::{
    HarmonicOutput, TwoDirectionsWorkspace, harmonic_force, workspace_init, workspace_length,
};
use microslip::two_directions::{Law, TwoDirections};

pub const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

pub fn parameters(flat_half_width: f64) -> Parameters {
    Parameters {
        flat_half_width,
        edge_radius: 0.05,
        length: 0.02,
        normal_force: 1000.0,
        friction_coefficient: 0.4,
        material: [STEEL; 2],
        displacement_reference: CENTRE_POINT,
        ..Parameters::default()
    }
}

pub fn elliptic_parameters(semi_axis_x: f64, semi_axis_y: f64) -> EllipticParameters {
    let Parameters { normal_force, friction_coefficient, material, layer, .. } = parameters(0.0);
    EllipticParameters { semi_axis_x, semi_axis_y, normal_force, friction_coefficient, material, layer }
}

/// The element of two directions by its normal force.
pub fn element_of(parameters: &Parameters) -> Element {
    Element::rounded_flat(parameters, Directions::Two, NormalInput::Force).unwrap()
}

/// A layer in units of an element without one: compliances over those of the contact, and N_c over its normal force.
pub fn layer_of(element: &Element, (share, ratio): (f64, f64)) -> Layer {
    Layer {
        normal_compliance: share / element.normal_stiffness,
        tangential_compliance: share / element.tangential_stiffness,
        stiffening_load: ratio * element.normal_force,
        reference_load: 0.0,
    }
}

#[derive(Clone)]
pub struct Contact<'a> {
    pub element: &'a Element,
    pub state: Vec<f64>,
}

impl Contact<'_> {
    pub fn new(element: &Element) -> Contact<'_> {
        let mut state = vec![0.0; TwoDirections::STATE_LENGTH];
        TwoDirections::state_init(&mut state).unwrap();
        Contact { element, state }
    }

    pub fn to(&mut self, displacement: [f64; 3]) -> LawStep<TwoDirections> {
        TwoDirections::step(self.element, &mut self.state, displacement).unwrap()
    }

    pub fn trial(&self, displacement: [f64; 3]) -> LawStep<TwoDirections> {
        self.clone().to(displacement)
    }

    /// Dissipated energy of a path that is straight in the displacement and in S, in a number of steps.
    pub fn along(&mut self, from: [f64; 3], to: [f64; 3], steps: usize) -> f64 {
        let shifts = [from, to].map(|[_, _, load]| self.element.shift_under(load));
        let at = |step: usize| {
            let part = step as f64 / steps as f64;
            let load = self.element.load_under(shifts[0] + part * (shifts[1] - shifts[0]));
            [from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]), load]
        };
        let path: Vec<[f64; 3]> = (1..steps).map(at).chain([to]).collect();
        path.into_iter().map(|place| self.to(place).dissipated).sum()
    }
}

pub const HARMONICS: usize = 1;
pub const SAMPLES: usize = 32;
/// Of one component, and of all.
pub const ROW: usize = 2 * HARMONICS + 1;
pub const COEFFICIENTS: usize = 3 * ROW;

pub struct Harmonic {
    pub force: Vec<f64>,
    pub jacobian: Vec<f64>,
    pub dissipated: f64,
    pub drift: f64,
}

pub fn harmonic(element: &Element, periods: usize, motion: &[f64; COEFFICIENTS]) -> Harmonic {
    let (mut memory, mut drift) = (vec![0.0; workspace_length(HARMONICS, SAMPLES)], f64::NAN);
    workspace_init(HARMONICS, SAMPLES, periods, &mut memory).unwrap();
    let mut workspace = TwoDirectionsWorkspace::new(&mut memory).unwrap();
    let compute = |output: HarmonicOutput| {
        harmonic_force(element, &mut workspace, motion, HarmonicOutput { drift: Some(&mut drift), ..output })
    };
    let (force, jacobian, dissipated) = super::outputs(COEFFICIENTS, compute).unwrap();
    Harmonic { force, jacobian, dissipated, drift }
}
