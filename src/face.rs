//! A face with an uneven pressure, divided along its length into parts: each is a line contact with its own normal force.
//!
//! A part of length L_i = s L has the force of a contact of length L under the same load per length, times s. This is the force of
//! a contact of length L whose Young's moduli are multiplied by s and whose layer is s times as stiff under the same load per
//! length: its compliances are divided by s, N_c and N_r multiplied by s. A part without load does not count in L. (Parts of a line
//! contact in `docs/derivation.md`)

use crate::error::{Error, ensure};
use crate::numerics::fp_class::in_0_to;
use crate::parameters::Parameters;
use crate::shape::Geometry;

/// Bounds of areas, pressures and loads, for which the shares of the parts and their products with the parameters are
/// representable.
const LEAST: f64 = 1e-50;
const LARGEST: f64 = 1e50;
/// Compliances and loads of a layer are limited to this value: no contact has a larger compliance, and a layer with a larger N_c
/// has a constant stiffness under any load.
const LARGEST_OF_LAYER: f64 = 1e160;

/// Parameters of the parts of a face, with the given number of pairs of nodes each, and weights of the pairs: their share in the
/// normal force of their part, or in its area if it has no load. The normal force of the whole is the sum of all pairs.
/// Errors: `BadArea`, `BadPressure`, or that of the first other parameter that is invalid.
pub fn divide(
    mut whole: Parameters,
    pairs: usize,
    area: &[f64],
    pressure: &[f64],
    parts: &mut [Parameters],
    weight: &mut [f64],
) -> Result<(), Error> {
    for (values, error) in [(area, Error::BadArea), (pressure, Error::BadPressure)] {
        ensure(values.iter().all(|value| in_0_to(*value, LARGEST)), error)?;
    }
    let pairs = pairs.max(1);
    // Areas and forces of the pairs of a part, with their sums.
    let rows = || {
        area.chunks(pairs).zip(pressure.chunks(pairs)).map(|(area, pressure)| {
            let forces = area.iter().zip(pressure).map(|(area, pressure)| (*area, area * pressure));
            let [sum, load] = forces.clone().fold([0.0; 2], |[sum, load], (area, force)| [sum + area, load + force]);
            (forces, sum, if load < LEAST { 0.0 } else { load })
        })
    };
    let mut all = 0.0;
    let mut touching = 0.0;
    whole.normal_force = 0.0;
    for (_, area, load) in rows() {
        if area < LEAST {
            return Err(Error::BadArea);
        }
        all += area;
        whole.normal_force += load;
        touching += if load > 0.0 { area } else { 0.0 };
    }
    if whole.normal_force <= 0.0 {
        return Err(Error::BadPressure);
    }
    whole.checked()?.composite_modulus()?;
    whole.length *= touching / all;
    if whole.layer.reference_load <= 0.0 {
        whole.layer.reference_load = whole.normal_force;
    }
    for ((_, area, load), part) in rows().zip(parts) {
        let share = area / touching;
        *part = Parameters { normal_force: load, ..whole };
        part.material.iter_mut().for_each(|body| body.young_modulus *= share);
        let layer = &mut part.layer;
        for (value, factor) in [
            (&mut layer.normal_compliance, 1.0 / share),
            (&mut layer.tangential_compliance, 1.0 / share),
            (&mut layer.stiffening_load, share),
            (&mut layer.reference_load, share),
        ] {
            *value = value.min(LARGEST_OF_LAYER) * factor;
        }
    }
    for ((forces, sum, load), weight) in rows().zip(weight.chunks_mut(pairs)) {
        for ((area, force), weight) in forces.zip(weight) {
            *weight = if load > 0.0 { force / load } else { area / sum };
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::Contact;
    use crate::element::{Directions, Element, NormalInput};
    use crate::parameters::{Layer, Material, RIGID_STRIP};
    use std::vec;
    use std::vec::Vec;

    const PAIRS: usize = 3;
    const AREA: [f64; 4 * PAIRS] = [2e-5, 1e-5, 0.0, 3e-5, 4e-5, 3e-5, 1e-5, 1e-5, 1e-5, 1e-6, 1e-6, 2e-6];
    const PRESSURE: f64 = 5e6;

    fn flank(layer: Layer) -> Parameters {
        let body = |young_modulus| Material { young_modulus, poisson_ratio: 0.32 };
        Parameters {
            flat_half_width: 1.2e-3,
            edge_radius: 3e-3,
            length: 24e-3,
            friction_coefficient: 0.3,
            material: [body(114e9), body(200e9)],
            layer,
            displacement_reference: RIGID_STRIP,
            ..Parameters::default()
        }
    }

    fn divided(whole: Parameters, area: &[f64], pressure: &[f64]) -> Result<(Vec<Parameters>, Vec<f64>), Error> {
        let (mut parts, mut weight) = (vec![whole; area.len() / PAIRS], vec![f64::NAN; area.len()]);
        divide(whole, PAIRS, area, pressure, &mut parts, &mut weight).map(|()| (parts, weight))
    }

    /// Equal to some roundings.
    fn close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-14, "{found}, {expected}");
    }

    fn add_up(parts: impl Iterator<Item = [f64; 3]>, whole: [f64; 3]) {
        let sum = parts.fold([0.0; 3], |sum, part| core::array::from_fn(|i| sum[i] + part[i]));
        sum.iter().zip(whole).for_each(|(sum, whole)| close(*sum, whole));
    }

    /// Parts of equal pressure are the undivided contact, with a layer and without, also as elements.
    #[test]
    fn equal_pressures() {
        let soft =
            Layer { normal_compliance: 2e-9, tangential_compliance: 3e-9, stiffening_load: 90.0, ..Layer::none() };
        for layer in [soft, Layer { reference_load: 400.0, stiffening_load: f64::INFINITY, ..soft }, Layer::none()] {
            let whole = Parameters { normal_force: PRESSURE * AREA.iter().sum::<f64>(), ..flank(layer) };
            let (parts, _) = divided(flank(layer), &AREA, &[PRESSURE; AREA.len()]).unwrap();
            let onset = Contact::rounded_flat(&whole).unwrap().slip_displacement;
            for amplitude in [0.01 * onset, 0.99 * onset, 1.5 * onset] {
                let forces = |p: &Parameters| {
                    let contact = Contact::rounded_flat(p).unwrap();
                    let stiffness = contact.complex_stiffness(amplitude).unwrap();
                    let force = contact.curve_at_displacement(amplitude).unwrap().force();
                    [force, stiffness.real, stiffness.imaginary]
                };
                add_up(parts.iter().map(forces), forces(&whole));
            }
            let element = |p: &Parameters| {
                let element = Element::rounded_flat(p, Directions::One, NormalInput::Approach).unwrap();
                [element.normal_force / element.approach, element.normal_stiffness, element.tangential_stiffness]
            };
            add_up(parts.iter().map(element), element(&whole));
        }
    }

    /// A part without load is an open contact with weights; the others are those of a shorter face.
    #[test]
    fn open_parts() {
        let layer = Layer { tangential_compliance: 3e-9, stiffening_load: 90.0, ..Layer::none() };
        let mut pressure: Vec<f64> = (0..AREA.len()).map(|i| 1e6 * i as f64).collect();
        pressure[3..6].fill(1e-60);
        let (parts, weight) = divided(flank(layer), &AREA, &pressure).unwrap();
        let stiffness = |p: &Parameters| Contact::rounded_flat(p).unwrap().complex_stiffness(1e-6).unwrap().real;
        assert_eq!([stiffness(&parts[1]), weight[3], weight[4]], [0.0, 0.3, 0.4]);
        weight.chunks(PAIRS).for_each(|weight| close(weight.iter().sum(), 1.0));
        let [area, pressure] = [&AREA[..], &pressure].map(|values| [&values[..3], &values[6..]].concat());
        let length = 24e-3 * area.iter().sum::<f64>() / AREA.iter().sum::<f64>();
        let (rest, of_rest) = divided(Parameters { length, ..flank(layer) }, &area, &pressure).unwrap();
        assert_eq!(weight[6..], of_rest[3..]);
        parts[2..].iter().zip(&rest[1..]).for_each(|(part, rest)| close(stiffness(part), stiffness(rest)));
    }

    #[test]
    fn invalid_faces() {
        let whole = flank(Layer::none());
        let pressure = [PRESSURE; AREA.len()];
        let status = |whole, area: &[f64], pressure: &[f64]| divided(whole, area, pressure).err();
        assert_eq!(status(whole, &[&AREA[..3], &[0.0; 3]].concat(), &pressure[..6]), Some(Error::BadArea));
        assert_eq!(status(whole, &AREA, &[0.0; AREA.len()]), Some(Error::BadPressure));
        assert_eq!(divide(whole, 0, &[], &[], &mut [whole], &mut []), Err(Error::BadPressure));
        let stiff = [Material { young_modulus: 1e200, poisson_ratio: 0.3 }; 2];
        for (whole, error) in [
            (Parameters { normal_force: f64::NAN, ..whole }, None),
            (Parameters { length: f64::NAN, ..whole }, Some(Error::BadLength)),
            (Parameters { material: stiff, ..whole }, Some(Error::OutOfRange)),
            (Parameters { displacement_reference: -1, ..whole }, Some(Error::BadDisplacementReference)),
            (flank(Layer { tangential_compliance: -1.0, ..Layer::none() }), Some(Error::BadTangentialCompliance)),
        ] {
            assert_eq!(status(whole, &AREA, &pressure), error);
        }
    }
}
