//! The command `layer`: the compliances of a layer in series with a contact, from measured stiffnesses or from the roughness.

use crate::args::LayerOptions;
use crate::commands::Report;
use crate::contact_spec::ContactSpec;
use crate::error::{Result, input, usage};
use crate::number::format_number;
use crate::table::Table;
use crate::units::Quantity::{Force, Length};
use microslip::Layer;
use microslip::element::{Directions, NormalInput};

/// Persson (2007): stiffness N/u0 with u0 from 0.4 to 0.5 times the rms height.
const SHARES: [f64; 3] = [0.4, 0.45, 0.5];
/// N_c over N, if it is not known: with N/1000 instead the loss at half of mu N is 2 % larger.
const STIFFENING: f64 = 0.01;

pub fn layer(options: &LayerOptions, spec: &ContactSpec) -> Result<Report> {
    let Some(normal_force) = spec.given.normal_force.filter(|force| *force > 0.0) else {
        return input("the compliance of a rough surface is that under a normal force: normal_force must be > 0");
    };
    let ratio = spec.given.tangential_ratio()?;
    let [least, middle, largest] = SHARES;
    let layer = match (&options.measured_stiffness[..], options.rms_height) {
        ([], Some(height)) => {
            let stiffness = (1.0 + STIFFENING) * normal_force / (middle * positive("rms-height", height)?);
            Layer {
                normal_compliance: 1.0 / stiffness,
                tangential_compliance: ratio / stiffness,
                stiffening_load: STIFFENING * normal_force,
                reference_load: normal_force,
            }
        }
        ([_] | [_, _], None) => measured(options, spec, normal_force, ratio)?,
        _ => return usage("give --measured-stiffness of one or two loads, or --rms-height"),
    };
    // Whether the library accepts it.
    spec.element_with(layer, Directions::One, NormalInput::Force)?;
    let (compliance, force) = (format!("{}/N", spec.units.unit(Length)), spec.units.unit(Force));
    let values = [
        ("normal_compliance", layer.normal_compliance, compliance.as_str()),
        ("tangential_compliance", layer.tangential_compliance, &compliance),
        ("stiffening_load", layer.stiffening_load, force),
        ("reference_load", layer.reference_load, force),
    ];
    let row = |(name, value, unit): (&str, f64, &str)| {
        let end = |share: f64| format_number(value * share / middle);
        let has_range = options.rms_height.is_some() && unit != force;
        let [lower, upper] = if has_range { [least, largest].map(end) } else { Default::default() };
        format!("{name},{},{lower},{upper},{unit}", format_number(value))
    };
    let table = Table::of_text("quantity,value,lower,upper,unit", values.map(row).into());
    let report = values.iter().fold(Report::new(spec, table, Vec::new()), |report, (name, value, _)| {
        report.with_remark(&format!("{name} = {}", format_number(*value)))
    });
    let numbers = values.map(|(_, value, _)| format!("{value:e}_wp"));
    Ok(report.with_remark(&format!("p%layer = mslip_layer({})", numbers.join(", "))))
}

/// Measured is the stiffness of contact and layer together: the layer has the compliance that the smooth contact lacks under the
/// same load. Two loads give the stiffness of the layer twice, and N_c by its growth in proportion to N + N_c.
fn measured(options: &LayerOptions, spec: &ContactSpec, normal_force: f64, ratio: f64) -> Result<Layer> {
    let mut loads = options.at.clone();
    if loads.is_empty() {
        loads.push(normal_force);
    }
    let stiffnesses = &options.measured_stiffness;
    if loads.len() != stiffnesses.len() {
        return usage("--at must have as many values as --measured-stiffness");
    }
    let secant = options.secant_force.map_or(Ok(0.0), |force| positive("secant-force", force))?;
    let friction = positive("friction-coefficient", spec.given.friction_coefficient.unwrap_or(0.0))?;
    if stiffnesses.len() == 2 && options.secant_force.is_some() {
        return usage("--secant-force is for a single --measured-stiffness");
    }
    let smooth = spec.element_with(Layer::none(), Directions::One, NormalInput::Force)?;
    let mut layers = Vec::new();
    for (&stiffness, &load) in stiffnesses.iter().zip(&loads) {
        let (stiffness, load) = (positive("measured-stiffness", stiffness)?, positive("at", load)?);
        if let Err(error) = smooth.check_normal_force(load).and_then(|()| smooth.check_static(secant, load)) {
            return input(format!("under {} N: {error}", format_number(load)));
        }
        let point = smooth.displacement_under(0, secant, load);
        let compliance = if secant == 0.0 { point.slope } else { point.value / secant };
        if 1.0 / stiffness <= compliance {
            let [stiffness, smooth] = [stiffness, 1.0 / compliance].map(format_number);
            return input(format!(
                "a measured stiffness of {stiffness} is not below that of the smooth contact under {load} N, {smooth}: a layer \
                 makes no contact stiffer"
            ));
        }
        layers.push(1.0 / stiffness - compliance);
    }
    let (load, compliance) = (loads[0], layers[0]);
    let stiffening_load = match (layers.get(1), loads.get(1)) {
        (Some(other), Some(&other_load)) => {
            // (N + N_c) c is the same under both.
            let stiffening = (load * compliance - other_load * other) / (other - compliance);
            let grows = (load - other_load) * (other - compliance) > 0.0;
            if !grows || stiffening < 0.0 {
                return input(
                    "the stiffness of a layer grows with the load, at most in proportion to it, and this one does not: give one load",
                );
            }
            stiffening.max(1e-3 * normal_force)
        }
        _ => spec.given.stiffening_load.unwrap_or((STIFFENING * load).max(1e-3 * normal_force)),
    };
    // The layer under a tangential force T: mu (N + N_c) ln(1/(1 - y)), y = T/(mu (N + N_c)), over T.
    let y = secant / (friction * (load + stiffening_load));
    let secant_over_initial =
        if secant > 0.0 && stiffening_load > 0.0 && stiffening_load.is_finite() { -(-y).ln_1p() / y } else { 1.0 };
    let tangential_compliance = compliance / secant_over_initial;
    Ok(Layer {
        normal_compliance: tangential_compliance / ratio,
        tangential_compliance,
        stiffening_load,
        reference_load: load,
    })
}

fn positive(option: &str, value: f64) -> Result<f64> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { usage(format!("--{option} must be finite and > 0")) }
}
