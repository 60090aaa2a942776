//! The part of a step in contact, in the units of the springs.

use super::nodes::{PerAxis, Units};
use crate::element::Element;

/// A motion over more than this many slip displacements is shortened to it: the force does not depend on the rest, and
/// the energy is proportional.
pub(super) const MAX_MOTION: f64 = 1e9;

/// The displacement of the springs in a step of which at least one end is in contact, and its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactPath {
    pub displacement: PerAxis<f64>,
    /// Whether the normal component is that of the start, bit by bit.
    pub constant_load: bool,
    /// Derivative by the tangential displacement \[1/m\].
    pub per_distance: f64,
    /// Derivatives by the normal component over its scale at the start and at the end, in each direction.
    pub per_input: PerAxis<[f64; 2]>,
    /// The factor by which the motion was shortened.
    pub scale: f64,
}

impl ContactPath {
    /// The path between two displacements and normal components, of contacts that are closed or not.
    pub fn new(element: &Element, units: &Units, [from, to]: [[f64; 3]; 2], closed: [bool; 2]) -> ContactPath {
        let (start, end) = (from[2], to[2]);
        let (part, slopes) = match closed {
            [true, false] => (element.crossing(start, end.min(0.0)), [0.0; 2]),
            [false, true] if element.by_approach() => {
                let (start, per) = (start.min(0.0), 1.0 / (end - start.min(0.0)).max(f64::MIN_POSITIVE));
                (end * per, [end * per * per, -start * per * per].map(|slope| element.input_scale() * slope))
            }
            _ => (1.0, [0.0; 2]),
        };
        let per_unit = 1.0 / (element.friction_coefficient * units.shift);
        let distance = [to[0] - from[0], to[1] - from[1]].map(|distance| distance * per_unit);
        let longest = (part * distance[0].abs().max(distance[1].abs())).max(MAX_MOTION);
        let per_scale = MAX_MOTION / longest;
        ContactPath {
            constant_load: closed == [true, true] && start.to_bits() == end.to_bits(),
            displacement: distance.map(|distance| part * distance * per_scale),
            per_distance: part * per_unit * per_scale,
            per_input: distance.map(|distance| slopes.map(|slope| distance * slope * per_scale)),
            scale: longest / MAX_MOTION,
        }
    }
}
