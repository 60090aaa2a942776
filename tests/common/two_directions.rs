//! An element with two tangential directions and its state.

use microslip::element::Element;
use microslip::two_directions::{Step, advance, state_init, state_length};

#[derive(Clone)]
pub struct Contact<'a> {
    pub element: &'a Element,
    pub state: Vec<f64>,
}

impl Contact<'_> {
    pub fn new(element: &Element) -> Contact<'_> {
        let mut state = vec![0.0; state_length()];
        state_init(&mut state).unwrap();
        Contact { element, state }
    }

    pub fn to(&mut self, displacement: [f64; 3]) -> Step {
        advance(self.element, &mut self.state, displacement).unwrap()
    }

    pub fn trial(&self, displacement: [f64; 3]) -> Step {
        self.clone().to(displacement)
    }
}
