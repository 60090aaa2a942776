//! Tractions after a history: the sizes between two knots of the diagram carry D times their pressure in shear.

use crate::element::Element;
use crate::error::Error;
use crate::law::Law;
use crate::limits::check_positions;
use crate::one_direction::OneDirection;
use crate::one_direction::diagram::Knot;
use crate::one_direction::state::read;

/// Pressure and shear traction \[Pa\] at the points x \[m\] along the width (elliptical: on the x axis), `q(x) = ∫ D dp(x)` over
/// the sizes of the contact; 0 outside it. Errors: `StateTooShort`, `BadState`; `BadPosition` if a point is not finite.
pub fn tractions(
    element: &Element,
    state: &[f64],
    x: &[f64],
    pressure: Option<&mut [f64]>,
    shear: Option<&mut [f64]>,
) -> Result<(), Error> {
    OneDirection::check_header(state)?;
    check_positions(x)?;
    let shape = element.shape();
    let (header, knots) = read(state);
    if let Some(pressure) = pressure {
        let w = shape.at_load(header.normal.load.max(0.0));
        pressure.iter_mut().zip(x).for_each(|(pressure, x)| *pressure = shape.pressure_between(0.0, w, *x));
    }
    if let Some(shear) = shear {
        shear.fill(0.0);
        let (mut inner, mut from) = (Knot::centre(header.displacement), 0.0);
        for &knot in knots {
            let to = shape.at_load(knot.load.max(0.0));
            let slope = knot.slope_from(&inner, element.friction_coefficient);
            shear.iter_mut().zip(x).for_each(|(shear, x)| *shear += slope * shape.pressure_between(from, to, *x));
            (inner, from) = (knot, to);
        }
    }
    Ok(())
}
