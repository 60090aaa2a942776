//! The command `layer`: the compliances of a layer in series with a contact, from measured stiffnesses or from the roughness.

use crate::args::LayerOptions;
use crate::commands::Report;
use crate::contact_spec::ContactSpec;
use crate::error::{Result, input, usage};
use crate::number::format_number;
use crate::table::Table;
use crate::units::Quantity::{Force, Length};
use microslip::Layer;
use std::f64::consts::{PI, TAU};

/// The normal stiffness under the normal force and N_c over it.
struct Rough {
    stiffness: f64,
    stiffening: f64,
    /// Least and largest stiffness over this one.
    range: Option<[f64; 2]>,
}

/// Persson (2007): stiffness N/u0 with u0 from 0.4 to 0.5 times the rms height.
const SHARES: [f64; 3] = [0.4, 0.45, 0.5];
/// N_c over N, if it is not known: with N/1000 instead the loss at half of mu N is 2 % larger.
const STIFFENING: f64 = 0.01;

pub fn layer(options: &LayerOptions, spec: &ContactSpec) -> Result<Report> {
    let Some(normal_force) = spec.given.normal_force.filter(|force| *force > 0.0) else {
        return input("the compliance of a rough surface is that under a normal force: normal_force must be > 0");
    };
    let asperities = [options.asperity_radius, options.asperity_density, options.height_deviation];
    let rough = match (&options.measured_stiffness[..], options.rms_height, asperities) {
        ([], Some(height), [None, None, None]) => Some(persson(normal_force, positive("rms-height", height)?)),
        ([], None, [Some(radius), Some(density), Some(deviation)]) => {
            let radius = positive("asperity-radius", radius)?;
            let (density, deviation) =
                (positive("asperity-density", density)?, positive("height-deviation", deviation)?);
            let scale = spec.contact.composite_modulus * (radius * deviation).sqrt() * density * nominal_area(spec);
            Some(greenwood_williamson(normal_force, scale, deviation)?)
        }
        ([_] | [_, _], None, [None, None, None]) => None,
        _ => {
            return usage(
                "give --measured-stiffness of one or two loads, --rms-height, or --asperity-radius, --asperity-density and \
                 --height-deviation",
            );
        }
    };
    let ratio = spec.given.tangential_ratio()?;
    let layer = match &rough {
        Some(rough) => Layer {
            normal_compliance: 1.0 / rough.stiffness,
            tangential_compliance: ratio / rough.stiffness,
            stiffening_load: rough.stiffening.max(1e-3) * normal_force,
            reference_load: normal_force,
        },
        None => measured(options, spec, normal_force, ratio)?,
    };
    spec.check_layer(&layer)?;
    let unit = format!("{}/N", spec.units.unit(Length));
    let range = rough.and_then(|rough| rough.range);
    let row = |name: &str, value: f64| {
        let [lower, upper] = range.map_or([String::new(), String::new()], |[least, largest]| {
            [value / largest, value / least].map(format_number)
        });
        format!("{name},{},{lower},{upper},{unit}", format_number(value))
    };
    let Layer { normal_compliance, tangential_compliance, stiffening_load, reference_load } = layer;
    let loads = [("stiffening_load", stiffening_load), ("reference_load", reference_load)];
    let compliances = [("normal_compliance", normal_compliance), ("tangential_compliance", tangential_compliance)];
    let mut rows: Vec<String> = compliances.iter().map(|(name, value)| row(name, *value)).collect();
    rows.extend(
        loads.iter().map(|(name, value)| format!("{name},{},,,{}", format_number(*value), spec.units.unit(Force))),
    );
    let numbers = compliances.iter().chain(&loads).map(|(_, value)| format!("{value:e}_wp")).collect::<Vec<_>>();
    let report = Report::new(spec, Table::of_text("quantity,value,lower,upper,unit", rows), Vec::new());
    let report = compliances
        .iter()
        .chain(&loads)
        .fold(report, |report, (name, value)| report.with_remark(&format!("{name} = {}", format_number(*value))));
    Ok(report.with_remark(&format!("p%layer = mslip_layer({})", numbers.join(", "))))
}

/// Measured is the stiffness of contact and layer together: the layer has the compliance that the smooth contact lacks under the same
/// load. Two loads give the stiffness of the layer twice, and N_c by its growth in proportion to N + N_c.
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
    let smooth = spec.smooth_element()?;
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

/// The area of the contact under its normal force.
fn nominal_area(spec: &ContactSpec) -> f64 {
    let half_width = spec.contact.half_width;
    match (spec.given.semi_axis_y, spec.given.length) {
        (Some(semi_axis), _) => PI * half_width * semi_axis,
        (None, length) => 2.0 * half_width * length.unwrap_or_default(),
    }
}

fn persson(normal_force: f64, rms_height: f64) -> Rough {
    let [least, middle, largest] = SHARES;
    Rough {
        stiffness: (1.0 + STIFFENING) * normal_force / (middle * rms_height),
        stiffening: STIFFENING,
        range: Some([middle / largest, middle / least]),
    }
}

/// Greenwood and Williamson (1966), heights with a normal distribution of deviation σ, asperities of radius R, n of them on the area:
/// with the separation tσ and `F_k(t) = ∫ (z-t)^k φ(z) dz` from t on, and `s = E* sqrt(R σ) n`, `N = 4/3 s σ F_3/2`, `dN/du = 2 s F_1/2`,
/// `d²N/du² = s F_-1/2/σ`.
fn greenwood_williamson(normal_force: f64, scale: f64, deviation: f64) -> Result<Rough> {
    let force = |t: f64| 4.0 / 3.0 * scale * deviation * moment(t, 1.5);
    let [mut low, mut high] = [-2.0, 8.0];
    if !(force(high)..force(low)).contains(&normal_force) {
        return input(
            "outside the model of Greenwood and Williamson: hardly an asperity touches, or nearly all of them do",
        );
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if force(middle) > normal_force { &mut low } else { &mut high }) = middle;
    }
    let stiffness = 2.0 * scale * moment(low, 0.5);
    let growth = scale * moment(low, -0.5) / deviation;
    // The stiffness in proportion to N + N_c has the same slope over N.
    Ok(Rough { stiffness, stiffening: stiffness / growth * stiffness / normal_force - 1.0, range: None })
}

/// `F_k(t)` by the midpoint rule in `x = sqrt(z-t)`, whose integrand is even for k = n + 1/2, and decays: accurate to rounding.
fn moment(t: f64, power: f64) -> f64 {
    const POINTS: u32 = 400;
    let step = 4.5 / f64::from(POINTS);
    let term = |i: u32| {
        let x = step * (f64::from(i) + 0.5);
        let z = t + x * x;
        2.0 * x.powf(2.0 * power + 1.0) * (-0.5 * z * z).exp()
    };
    (0..POINTS).map(term).sum::<f64>() * step / TAU.sqrt()
}

#[cfg(test)]
mod tests {
    use super::{greenwood_williamson, moment};

    /// A closed form, and F_k' = -k F_(k-1).
    #[test]
    fn moments_are_those_of_the_normal_distribution() {
        // 2^(-3/4) Γ(3/4)/sqrt(π).
        assert!((moment(0.0, 0.5) - 0.4110894793312294).abs() < 1e-14);
        for t in [-1.0, 0.0, 1.5, 4.0] {
            for power in [0.5, 1.5] {
                let difference = (moment(t + 1e-4, power) - moment(t - 1e-4, power)) / 2e-4;
                assert!((difference / moment(t, power - 1.0) / -power - 1.0).abs() < 1e-6, "{t} {power}");
            }
        }
    }

    #[test]
    fn the_layer_has_the_slopes_of_the_rough_surface() {
        let at = |force| greenwood_williamson(force, 1e9, 1e-6).unwrap();
        for force in [1e-3, 1.0, 100.0] {
            let (low, middle, high) = (at(0.999 * force), at(force), at(1.001 * force));
            let slope = (high.stiffness - low.stiffness) / (0.002 * force);
            assert!((slope * force * (1.0 + middle.stiffening) / middle.stiffness - 1.0).abs() < 1e-4, "{force}");
            // Nearly in proportion to the load, and the faster the fewer asperities touch.
            assert!(middle.stiffening > 0.0 && middle.stiffening < 0.5, "{force} {}", middle.stiffening);
        }
    }
}
