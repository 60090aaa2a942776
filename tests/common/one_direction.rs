//! An element along a path in one direction, by displacements or forces.

use microslip::element::Element;
use microslip::law::LawStep;
use microslip::one_direction::{Law, OneDirection, state_length};

/// An element with its state, and the displacement that it has reached.
pub struct Path<'a> {
    pub element: &'a Element,
    pub state: Vec<f64>,
    pub displacement: f64,
}

impl Path<'_> {
    /// An open contact, whose state holds the given number of pieces.
    pub fn new(element: &Element, pieces: usize) -> Path<'_> {
        let mut state = vec![0.0; state_length(pieces)];
        OneDirection::state_init(&mut state).expect("a state");
        Path { element, state, displacement: 0.0 }
    }

    /// A step to a displacement and normal input.
    pub fn displace(&mut self, displacement: f64, normal: f64) -> LawStep<OneDirection> {
        self.displacement = displacement;
        OneDirection::step(self.element, &mut self.state, [displacement, normal]).expect("an admissible step")
    }

    /// A step to the displacement u within a distance with a u + b T = `target`, for weights a and b: Newton's method, bisection
    /// where it leaves the bracket.
    pub fn pull(&mut self, [a, b]: [f64; 2], target: f64, normal: f64, distance: f64) -> LawStep<OneDirection> {
        let start = self.state.clone();
        let (mut low, mut high) = (self.displacement - distance, self.displacement + distance);
        let mut next = self.displacement;
        for _ in 0..200 {
            self.state.copy_from_slice(&start);
            let step = self.displace(next, normal);
            let (u, excess) = (next, a * next + b * step.force[0] - target);
            *(if excess < 0.0 { &mut low } else { &mut high }) = u;
            next = u - excess / (a + b * step.tangent[0]);
            next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - u).abs() <= 1e-15 * (high.abs() + low.abs()) || low.next_up() >= high {
                break;
            }
        }
        self.state.copy_from_slice(&start);
        self.displace(next, normal)
    }
}
