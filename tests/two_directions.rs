//! The law for two tangential directions: judged paths, invariants, tangents.

use microslip::parameters::{CENTRE_POINT, EllipticParameters, Material, Parameters};
use microslip::varying_load::element::{Directions, Element, NormalInput};

use microslip::varying_load::two_directions::{Step, advance, state_check, state_init, state_length};

const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

fn flat(flat_half_width: f64, input: NormalInput, directions: Directions) -> Element {
    let parameters = Parameters {
        flat_half_width,
        edge_radius: 0.05,
        length: 0.02,
        normal_force: 1000.0,
        friction_coefficient: 0.4,
        material: [STEEL; 2],
        displacement_reference: CENTRE_POINT,
        reserved: 0,
    };
    Element::rounded_flat(&parameters, directions, input).unwrap()
}

fn ellipse(ratio: f64) -> Element {
    let parameters = EllipticParameters {
        semi_axis_x: 1e-3,
        semi_axis_y: ratio * 1e-3,
        normal_force: 1000.0,
        friction_coefficient: 0.4,
        material: [STEEL; 2],
    };
    Element::elliptic(&parameters, Directions::Two, NormalInput::Force).unwrap()
}

/// The shift of the contact under its normal force: motions are given in units of mu times it.
fn unit(element: &Element) -> f64 {
    element.friction_coefficient * element.shift_under(element.normal_force)
}

struct Contact<'a> {
    element: &'a Element,
    state: Vec<f64>,
}

impl Contact<'_> {
    fn new(element: &Element) -> Contact<'_> {
        let mut state = vec![0.0; state_length()];
        state_init(&mut state).unwrap();
        Contact { element, state }
    }

    fn to(&mut self, displacement: [f64; 3]) -> Step {
        advance(self.element, &mut self.state, displacement).unwrap()
    }

    fn trial(&self, displacement: [f64; 3]) -> Step {
        advance(self.element, &mut self.state.clone(), displacement).unwrap()
    }
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn tangents_are_derivatives() {
    let mut random = Random(1);
    let elements = [
        flat(0.0, NormalInput::Force, Directions::Two),
        flat(2e-4, NormalInput::Force, Directions::Two),
        flat(3e-3, NormalInput::Approach, Directions::Two),
        ellipse(1.0),
        ellipse(3.0),
    ];
    let (mut errors, mut beyond) = (Vec::new(), 0);
    for element in &elements {
        let (unit, full) =
            (unit(element), if element.normal_input == 1 { element.normal_force } else { element.approach });
        let mut contact = Contact::new(element);
        let mut at = [0.0, 0.0, full];
        contact.to(at);
        for k in 0..200 {
            let size = [0.05, 0.3, 1.0, 3.0][k % 4] * unit;
            let load = if k % 3 == 0 { at[2] } else { full * (random.next() * 1.3 - 0.15) };
            let load = if element.normal_input == 1 { load.max(0.0) } else { load };
            let next = [at[0] + size * (random.next() - 0.5), at[1] + size * (random.next() - 0.5), load];
            let next = if k % 10 < 2 { [next[0], at[1], next[2]] } else { next };
            let step = contact.trial(next);
            for column in 0..3 {
                if column == 2 && next[2] <= 0.0 || next[2] == at[2] && column == 2 {
                    continue;
                }
                let h = if column < 2 { 1e-6 * unit } else { 1e-6 * full };
                let moved = |h: f64| {
                    let mut to = next;
                    to[column] += h;
                    contact.trial(to).force
                };
                let (high, low) = (moved(h), moved(-h));
                for row in 0..2 {
                    let scale = element.tangential_stiffness * if column < 2 { 1.0 } else { unit / full };
                    let difference = (high[row] - low[row]) / (2.0 * h) / scale;
                    let error = (difference - step.tangent[3 * column + row] / scale).abs();
                    if error > 1e-4 {
                        beyond += 1;
                        println!(
                            "{k} {row} {column}: {difference:.6} {:.6} load {:.3}->{:.3}",
                            step.tangent[3 * column + row] / scale,
                            at[2] / full,
                            next[2] / full
                        );
                    }
                    errors.push(error);
                }
            }
            at = next;
            contact.to(at);
            state_check(&contact.state).unwrap();
        }
    }
    errors.sort_by(f64::total_cmp);
    println!("median {:.1e}, {} of {} beyond 1e-4", errors[errors.len() / 2], beyond, errors.len());
    assert!(beyond == 0);
}
