//! A line contact with an uneven load, divided into parts, against parts that displace each other: the integral equation of the
//! section on parts in `docs/derivation.md`, without the effect of the ends, which no contact of the law has.

use crate::documents::Documents;
use crate::strips::parameters;
use microslip::face::divide;
use microslip::parameters::{CENTRE_POINT, Parameters};
use microslip::{Contact, Error};
use std::f64::consts::PI;

/// L over the half-width under the mean load. A cell of the reference is as long as its contact is wide: shorter ones would resolve
/// the width, which the equation does not contain.
const LENGTH: f64 = 39.0;
const CELLS: usize = 20;
const PARTS: usize = 10;

/// Forces of a line of cells under displacements; loads of the cells are relative to the mean.
fn forces(whole: &Parameters, loads: &[f64], displacements: &[f64]) -> Result<Vec<f64>, Error> {
    let cell = |load: &f64| Contact::rounded_flat(&Parameters { normal_force: load * whole.normal_force, ..*whole });
    let contacts = loads.iter().map(cell).collect::<Result<Vec<_>, Error>>()?;
    let force = |displacement: &f64| {
        let mut tractions = vec![0.0; loads.len()];
        for _ in 0..300 {
            let of_others = |i: usize| -> f64 {
                let term = |(j, traction): (usize, &f64)| (traction - tractions[i]) / i.abs_diff(j).max(1) as f64;
                // Half of 2/(pi E*), with E* = 1.
                tractions.iter().enumerate().map(term).sum::<f64>() / PI
            };
            let traction = |(i, contact): (usize, &Contact)| {
                Ok(contact.curve_at_displacement(displacement - of_others(i))?.force() / whole.length)
            };
            tractions = contacts.iter().enumerate().map(traction).collect::<Result<_, Error>>()?;
        }
        Ok(tractions.iter().sum::<f64>() * whole.length / loads.len() as f64)
    };
    displacements.iter().map(force).collect()
}

/// The table, with the largest errors of the force over mu N.
pub fn compare(documents: &mut Documents) {
    let mut text = String::from("| load per length | ten parts | undivided |\n|---|---:|---:|\n");
    let whole = parameters(0.5 * LENGTH, 0.0, CENTRE_POINT);
    for slope in [0.0, 0.25, 0.5, 0.9] {
        let row = errors(&whole, slope).expect("valid parameters");
        documents.check(slope > 0.0 || row[0] < 1e-12, format!("equal parts: {row:?}"));
        text += &format!("| mean ± {:.0} % | {:.1} % | {:.1} % |\n", 100.0 * slope, 100.0 * row[0], 100.0 * row[1]);
    }
    documents.table("derivation.md", "parts", &text);
}

/// Errors of the parts, and of the undivided contact, for a load that varies linearly.
fn errors(whole: &Parameters, slope: f64) -> Result<[f64; 2], Error> {
    let load = |i: usize, n: usize| 1.0 + slope * ((2 * i + 1) as f64 / n as f64 - 1.0);
    let loads: Vec<f64> = (0..CELLS).map(|i| load(i, CELLS)).collect();
    let pressure: Vec<f64> = (0..PARTS).map(|i| load(i, PARTS) * whole.normal_force).collect();
    let mut parts = [*whole; PARTS];
    divide(*whole, 1, &[1.0 / PARTS as f64; PARTS], &pressure, &mut parts, &mut [])?;
    let undivided = Contact::rounded_flat(whole)?;
    let parts = parts.iter().map(Contact::rounded_flat).collect::<Result<Vec<_>, Error>>()?;
    let displacements: Vec<f64> = (1..=40).map(|i| 0.05 * f64::from(i) * undivided.slip_displacement).collect();
    let reference = forces(whole, &loads, &displacements)?;
    let mut largest = [0.0_f64; 2];
    for (displacement, reference) in displacements.iter().zip(reference) {
        let force = |contact: &Contact| contact.curve_at_displacement(*displacement).map(|point| point.force());
        let sum = parts.iter().map(force).sum::<Result<f64, Error>>()?;
        for (largest, found) in largest.iter_mut().zip([sum, force(&undivided)?]) {
            *largest = largest.max((found - reference).abs() / undivided.slip_force);
        }
    }
    Ok(largest)
}
