//! Whether height and slope of the loops suit the contact: errors of units, and what the loops cannot show.

use crate::cycles::Loop;
use crate::data::ends;
use crate::error::{Error, error};

/// Friction coefficients that occur.
const FRICTION: [f64; 2] = [0.01, 10.0];
/// A measured stiffness may exceed that of the contact by this factor: geometry and moduli are known that well.
const STIFFER: f64 = 20.0;
/// A contact that has less of the measured compliance than this deserves a question about units.
const SOFTER: f64 = 1e-3;
/// Amplitudes or loads that differ by less are one.
const EQUAL: f64 = 0.1;

/// Warnings, from the ratio of force to load and the initial compliance of the loops, and the initial compliances of the contact.
pub(crate) fn check(loops: &[Loop], contact: &[f64], friction: f64, compliance: f64) -> Result<Vec<String>, Error> {
    let [low, high] = FRICTION;
    if !(low..=high).contains(&friction) {
        return error(format!(
            "the largest force is {friction:.3e} of the normal force, which is no friction coefficient ({low} to {high}): is \
             one of the forces in another unit, for example mN or kN?"
        ));
    }
    let softest = contact.iter().copied().fold(0.0, f64::max);
    let mut warnings = Vec::new();
    if compliance * STIFFER < softest {
        return error(format!(
            "the loops are {:.1e} times stiffer after a reversal than the contact alone, {:.3e} against {:.3e}: is the \
             displacement in another unit, for example mm instead of um, or the geometry wrong?",
            softest / compliance,
            1.0 / compliance,
            1.0 / softest
        ));
    }
    // After a reversal a loop is stiffer than its chord.
    let chord = loops.iter().map(|one| one.amplitude / one.height()).fold(0.0, f64::max);
    if compliance > STIFFER * chord {
        return error(format!(
            "the compliances, {compliance:.3e} together, are {:.1e} times those of the loops: is a fixed one in another unit?",
            compliance / chord
        ));
    }
    if softest < SOFTER * compliance {
        warnings.push(format!(
            "the contact alone is {:.1e} times stiffer than the loops: rig and bodies dominate, unless the displacement is in \
             another unit",
            compliance / softest
        ));
    }
    let [least, largest] = ends(loops.iter().map(|one| one.amplitude / one.normal_force));
    if largest / least - 1.0 < EQUAL {
        warnings.push(
            "one amplitude only: compliances and shape follow from the form of the loop alone, so that friction that depends on \
             the amplitude, and errors of the rig, are not distinguished from them"
                .to_owned(),
        );
    }
    Ok(warnings)
}
