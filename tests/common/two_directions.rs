//! An element with two tangential directions and its state.

use microslip::element::Element;
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
