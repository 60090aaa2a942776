//! The command `layer`: the compliances of a rough surface in series with a contact, from its roughness.

use crate::args::RoughLayer;
use crate::commands::Report;
use crate::contact_spec::ContactSpec;
use crate::error::{Result, input, usage};
use crate::number::format_number;
use crate::table::Table;
use crate::units::Quantity::{Force, Length};
use std::f64::consts::{PI, TAU};

/// The stiffness under the normal force and N_c over it.
struct Rough {
    stiffness: f64,
    stiffening: f64,
    /// Least and largest stiffness over this one.
    range: Option<[f64; 2]>,
}

/// Persson (2007): stiffness N/u0 with u0 from 0.4 to 0.5 times the rms height.
const SHARES: [f64; 3] = [0.4, 0.45, 0.5];
/// N_c over N, if it is not known.
const STIFFENING: f64 = 0.01;

pub fn layer(options: &RoughLayer, spec: &ContactSpec) -> Result<Report> {
    let Some(normal_force) = spec.given.normal_force.filter(|force| *force > 0.0) else {
        return input("the compliance of a rough surface is that under a normal force: normal_force must be > 0");
    };
    let asperities = [options.asperity_radius, options.asperity_density, options.height_deviation];
    let rough = match (options.rms_height, asperities) {
        (Some(height), [None, None, None]) => persson(normal_force, positive("rms-height", height)?),
        (None, [Some(radius), Some(density), Some(deviation)]) => {
            let radius = positive("asperity-radius", radius)?;
            let (density, deviation) =
                (positive("asperity-density", density)?, positive("height-deviation", deviation)?);
            let scale = spec.contact.composite_modulus * (radius * deviation).sqrt() * density * nominal_area(spec);
            greenwood_williamson(normal_force, scale, deviation)?
        }
        _ => return usage("give --rms-height, or --asperity-radius, --asperity-density and --height-deviation"),
    };
    let normal = 1.0 / rough.stiffness;
    let tangential = normal * spec.given.tangential_ratio()?;
    let stiffening = (rough.stiffening * normal_force).max(1e-3 * normal_force);
    let unit = format!("{}/N", spec.units.unit(Length));
    let row = |name: &str, value: f64| {
        let [lower, upper] = rough.range.map_or([String::new(), String::new()], |[least, largest]| {
            [value / largest, value / least].map(format_number)
        });
        format!("{name},{},{lower},{upper},{unit}", format_number(value))
    };
    let rows = vec![
        row("normal_compliance", normal),
        row("tangential_compliance", tangential),
        format!("stiffening_load,{},,,{}", format_number(stiffening), spec.units.unit(Force)),
        format!(
            "tangential_compliance_over_that_of_the_contact,{},,,-",
            format_number(tangential * spec.contact.initial_stiffness)
        ),
    ];
    Ok(Report::new("layer", spec, &options.text(), Table::of_text("quantity,value,lower,upper,unit", rows), Vec::new()))
}

impl RoughLayer {
    /// The options that repeat the command.
    fn text(&self) -> String {
        let options = [
            ("rms-height", self.rms_height),
            ("asperity-radius", self.asperity_radius),
            ("asperity-density", self.asperity_density),
            ("height-deviation", self.height_deviation),
        ];
        let given = options.into_iter().filter_map(|(name, value)| Some((name, value?)));
        given.map(|(name, value)| format!(" --{name} {}", format_number(value))).collect()
    }
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
