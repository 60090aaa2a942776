//! An element with two tangential directions and its state, and the harmonic force of a motion with one harmonic.

use microslip::element::Element;
use microslip::two_directions::harmonic_force::{
    HarmonicOutput, Workspace, harmonic_force, workspace_init, workspace_length,
};
use microslip::two_directions::{Law, Step, TwoDirections};

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

    pub fn to(&mut self, displacement: [f64; 3]) -> Step {
        TwoDirections::step(self.element, &mut self.state, displacement).unwrap()
    }

    pub fn trial(&self, displacement: [f64; 3]) -> Step {
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
    let mut workspace = Workspace::new(&mut memory).unwrap();
    let compute = |output: HarmonicOutput| {
        harmonic_force(element, &mut workspace, motion, HarmonicOutput { drift: Some(&mut drift), ..output })
    };
    let (force, jacobian, dissipated) = super::outputs(COEFFICIENTS, compute).unwrap();
    Harmonic { force, jacobian, dissipated, drift }
}
