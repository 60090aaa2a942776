//! A contact, prepared once and then only read: the family it belongs to, and the units that turn its numbers into forces
//! and displacements.

use crate::constant_load::interpolant::{ForceInterpolant, INNER_FRACTION};
use crate::error::Error;
use crate::numerics::fp_class::abs_le;
use crate::numerics::sn_midpoint::GAUSS;
use crate::parameters::{CENTRE_POINT, EllipticParameters, Material, Pair, Parameters};
use crate::shape::SizeFamily;
use crate::shape::hertz_ellipse::Elliptic;
use crate::shape::rounded_flat::RoundedFlat;
use crate::shape::rounded_punch::RoundedPunch;
use crate::tag::LAYOUT;
use core::f64::consts::{LN_2, PI};

/// The bound keeps products with forces and energies representable.
pub(crate) const LARGEST_DISPLACEMENT: f64 = 1e150;

pub(crate) fn check_displacement(displacement: f64) -> Result<(), Error> {
    if abs_le(displacement, LARGEST_DISPLACEMENT) { Ok(()) } else { Err(Error::BadDisplacement) }
}

/// A prepared contact: plain data of fixed size that may be copied, stored and sent.
///
/// An open contact (no normal force) has zero width, force and stiffness; one without friction has zero force and
/// stiffness.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// E* of Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: the semi-axis along the tangential force.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at which gross slip starts on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// Slope of the monotonic curve at 0 \[N/m\].
    pub initial_stiffness: f64,
    /// Dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    tag: u64,
    /// Displacement for an approach of 1 \[m\].
    pub(crate) displacement_scale: f64,
    /// Its inverse; 0 without friction.
    pub(crate) per_displacement_scale: f64,
    /// Stiffness for a compliance of 1 \[N/m\].
    pub(crate) stiffness_scale: f64,
    /// Pressure for one of 1 \[Pa\].
    pub(crate) pressure_scale: f64,
    pub(crate) friction_coefficient: f64,
    /// a \[m\].
    pub(crate) flat_half_width: f64,
    /// mu N less `slip_force`: what rounding took.
    pub(crate) slip_force_rounding: f64,
    /// What makes of a displacement the argument of the inverse's first polynomial, and of what is left until gross slip that
    /// of the others \[1/m\]; elliptical: the second, over all of the way.
    pub(crate) inner_scale: f64,
    pub(crate) outer_scale: f64,
    rounded_flat: RoundedFlat,
    interpolant: ForceInterpolant,
    /// x and dτ at the nodes of the complex stiffness in gross slip.
    gross_slip_quadrature: GrossSlipQuadrature,
    /// Makes the sum of all words 0, in a contact that was written by the C interface.
    pub(crate) checksum: u64,
}

/// x, and dτ with the weight of a node.
pub(crate) type GrossSlipQuadrature = [[f64; GAUSS.len()]; 2];

/// Tag of an initialised contact: a magic number, the version of the layout, and the geometry.
const TAG_ROUNDED_FLAT: u64 = (0x6d73_6c69_7001 << 16) | (LAYOUT << 8);
const TAG_ELLIPTIC: u64 = TAG_ROUNDED_FLAT | 1;

const _: () = assert!(size_of::<Contact>() == 1976);

/// Exponent of 2 beyond which no intermediate product may come: squares stay representable.
const LARGEST_EXPONENT: i32 = 500;

/// The exponent of 2 of a product of quotients, from the numbers' exponents alone, so that nothing overflows.
fn exponent_of(numerators: &[f64], denominators: &[f64]) -> i32 {
    let exponent = |value: &f64| ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    numerators.iter().map(exponent).sum::<i32>() - denominators.iter().map(exponent).sum::<i32>()
}

fn in_range(numerators: &[f64], denominators: &[f64]) -> Result<(), Error> {
    if exponent_of(numerators, denominators).abs() <= LARGEST_EXPONENT { Ok(()) } else { Err(Error::OutOfRange) }
}

impl Contact {
    /// Initialises a flat with rounded edges, or a cylinder.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `LengthTooShort` if 2L <= b or the initial stiffness would not be
    /// positive; `OutOfRange` if results are not representable.
    pub fn rounded_flat(parameters: &Parameters) -> Result<Contact, Error> {
        parameters.check()?;
        // No zero has a sign, which would be seen in what is told of sizes.
        let flat_half_width = parameters.flat_half_width.abs();
        let parameters = &Parameters { flat_half_width, ..*parameters };
        let Parameters { length, normal_force, friction_coefficient, .. } = *parameters;
        check_moduli(&parameters.material)?;
        let pair = Pair::new(&parameters.material);
        let open =
            Contact { composite_modulus: pair.composite_modulus, tag: TAG_ROUNDED_FLAT, friction_coefficient, ..EMPTY };
        if normal_force == 0.0 {
            return Ok(open);
        }
        let (half_width, shape) = size_of_contact(parameters, pair.composite_modulus)?;
        in_range(&[normal_force], &[length, half_width])?;
        let compliance = full_stick_compliance(parameters, &pair, half_width)?;
        let geometry = Contact {
            half_width,
            flat_half_width,
            pressure_scale: normal_force / length / half_width,
            stiffness_scale: 0.5 * PI * pair.composite_modulus * length,
            rounded_flat: RoundedFlat::new(&shape, compliance),
            ..open
        };
        geometry.with_friction(normal_force)
    }

    /// Prepares an elliptical Hertz contact; a sphere when both semi-axes are equal.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `OutOfRange` where results are not representable.
    pub fn elliptic(parameters: &EllipticParameters) -> Result<Contact, Error> {
        parameters.check()?;
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, friction_coefficient, ref material } =
            *parameters;
        check_moduli(material)?;
        let modulus = Pair::new(material).composite_modulus;
        let open = Contact { composite_modulus: modulus, tag: TAG_ELLIPTIC, friction_coefficient, ..EMPTY };
        if normal_force == 0.0 {
            return Ok(open);
        }
        for axis in [semi_axis_x, semi_axis_y] {
            in_range(&[axis], &[])?;
            in_range(&[axis, modulus], &[])?;
        }
        in_range(&[semi_axis_x], &[semi_axis_y])?;
        in_range(&[normal_force], &[semi_axis_x, semi_axis_y])?;
        let compliance = Elliptic::initial_compliance(semi_axis_x, semi_axis_y, material);
        let geometry = Contact {
            half_width: semi_axis_x,
            pressure_scale: normal_force / semi_axis_x / semi_axis_y,
            stiffness_scale: 1.0 / compliance,
            ..open
        };
        geometry.with_friction(normal_force)
    }

    /// The tangential law, from geometry and stiffness.
    fn with_friction(self, normal_force: f64) -> Result<Contact, Error> {
        if self.friction_coefficient == 0.0 {
            return Ok(self);
        }
        in_range(&[self.friction_coefficient], &[])?;
        in_range(&[self.friction_coefficient, normal_force], &[])?;
        in_range(&[self.friction_coefficient, self.pressure_scale], &[])?;
        let slip_force = self.friction_coefficient * normal_force;
        in_range(&[slip_force], &[self.stiffness_scale])?;
        let displacement_scale = slip_force / self.stiffness_scale;
        let family = self.family();
        let at_slip = family.at_load_remaining(0.0);
        let energy = family.dissipation_beyond_half(&at_slip);
        let slip_energy = slip_force * displacement_scale * energy;
        if !slip_energy.is_normal() {
            return Err(Error::OutOfRange);
        }
        // One that could not be asked for would never be reached.
        let slip_displacement = displacement_scale * family.slip_shift();
        check_displacement(slip_displacement).map_err(|_| Error::OutOfRange)?;
        let (from_origin, remaining) =
            if self.is_elliptic() { (1.0, 1.0) } else { (INNER_FRACTION, 1.0 - INNER_FRACTION) };
        Ok(Contact {
            slip_force,
            slip_force_rounding: self.friction_coefficient.mul_add(normal_force, -slip_force),
            displacement_scale,
            per_displacement_scale: 1.0 / displacement_scale,
            slip_displacement,
            inner_scale: 1.0 / (from_origin * slip_displacement),
            outer_scale: 1.0 / (remaining * slip_displacement),
            interpolant: if self.is_elliptic() { ForceInterpolant::NONE } else { self.rounded_flat.interpolant() },
            initial_stiffness: self.stiffness_scale / family.origin().compliance,
            slip_energy,
            gross_slip_quadrature: gross_slip_quadrature(family),
            ..self
        })
    }

    pub(crate) fn gross_slip_quadrature(&self) -> &GrossSlipQuadrature {
        &self.gross_slip_quadrature
    }

    /// Whether the curve, followed back beyond its origin, comes to the point where its compliance vanishes within that share
    /// of the displacement of gross slip: to first order at `-Λ²/(2 h'')`.
    #[inline(always)]
    pub(crate) fn has_singularity_within(&self, share: f64) -> bool {
        let origin = self.family().origin();
        let second_derivative = 2.0 * share * origin.initial_curvature() * self.family().slip_shift();
        origin.compliance * origin.compliance < second_derivative
    }

    /// 1 over the displacement of gross slip; 0 without friction.
    pub(crate) fn per_slip_displacement(&self) -> f64 {
        if self.is_elliptic() { self.outer_scale } else { INNER_FRACTION * self.inner_scale }
    }

    /// K' over the initial stiffness and its derivative by y, where the inverse is one polynomial.
    #[inline(always)]
    pub(crate) fn polynomial_cycle(&self, y: f64) -> Option<(f64, f64)> {
        if self.is_elliptic() { None } else { self.interpolant.cycle(y) }
    }

    /// Whether this memory was initialised by a library of this version.
    #[inline(always)]
    pub(crate) fn is_initialised(&self) -> bool {
        self.tag | 1 == TAG_ELLIPTIC
    }

    pub(crate) fn is_elliptic(&self) -> bool {
        self.tag == TAG_ELLIPTIC
    }

    pub(crate) fn interpolant(&self) -> &ForceInterpolant {
        &self.interpolant
    }

    pub(crate) fn shape(&self) -> &RoundedFlat {
        &self.rounded_flat
    }

    pub(crate) fn family(&self) -> &dyn SizeFamily {
        if self.is_elliptic() { &Elliptic } else { &self.rounded_flat }
    }

    /// No tangential force is possible: an open contact, or one without friction.
    pub(crate) fn is_frictionless(&self) -> bool {
        self.slip_force <= 0.0
    }

    /// Energy for a dissipation of 1 \[J\].
    pub(crate) fn energy_scale(&self) -> f64 {
        self.slip_force * self.displacement_scale
    }
}

/// Members of a family from the smallest to b, for integrals over all of it: sizes σ whose spacing grows in proportion to their
/// distance from the branch points of the family, and shrinks towards b, where integrands have roots.
fn gross_slip_quadrature(family: &dyn SizeFamily) -> GrossSlipQuadrature {
    let log_branch_distance = family.log_branch_distance();
    // σ = sinh(spread y)/sinh(spread), y = z (2-z).
    let scale = 0.5 / (0.5 * (log_branch_distance.exp() - (-log_branch_distance).exp()));
    let mut nodes = [[0.0; GAUSS.len()]; 2];
    let [consumed, weights] = &mut nodes;
    for ((consumed, slip_weight), (z, weight)) in consumed.iter_mut().zip(weights).zip(GAUSS) {
        let (up, down) = ((log_branch_distance * z * (2.0 - z)).exp(), (-log_branch_distance * z * (2.0 - z)).exp());
        let rate = log_branch_distance * scale * (up + down) * 2.0 * (1.0 - z);
        let station = family.station((scale * (up - down)).min(1.0));
        (*consumed, *slip_weight) = (station.shift.consumed, weight * rate * station.dload_dsigma);
    }
    nodes
}

/// An open contact of no law.
const EMPTY: Contact = Contact {
    composite_modulus: 0.0,
    half_width: 0.0,
    slip_force: 0.0,
    slip_displacement: 0.0,
    initial_stiffness: 0.0,
    slip_energy: 0.0,
    tag: 0,
    displacement_scale: 0.0,
    per_displacement_scale: 0.0,
    stiffness_scale: 0.0,
    pressure_scale: 0.0,
    friction_coefficient: 0.0,
    flat_half_width: 0.0,
    slip_force_rounding: 0.0,
    inner_scale: 0.0,
    outer_scale: 0.0,
    rounded_flat: RoundedFlat::EMPTY,
    interpolant: ForceInterpolant::NONE,
    gross_slip_quadrature: [[0.0; GAUSS.len()]; 2],
    checksum: 0,
};

fn check_moduli(material: &[Material; 2]) -> Result<(), Error> {
    material.iter().try_for_each(|body| in_range(&[body.young_modulus], &[]))
}

/// Half-width b, and the contact in units of it: Eq. 1 in units that keep both the flat and the load at most 1.
fn size_of_contact(parameters: &Parameters, modulus: f64) -> Result<(f64, RoundedPunch), Error> {
    let Parameters { flat_half_width: flat, edge_radius, length, normal_force, .. } = *parameters;
    in_range(&[length], &[])?;
    in_range(&[length, modulus], &[])?;
    in_range(&[edge_radius], &[length])?;
    in_range(&[normal_force], &[modulus])?;
    in_range(&[edge_radius, normal_force], &[length, modulus])?;
    // On a flat too wide for its load the rounded edge carries nothing that a double can tell from nothing.
    let too_wide = exponent_of(&[edge_radius, normal_force], &[length, modulus, flat, flat]) < -900;
    if flat > 0.0 && (exponent_of(&[flat], &[]) > LARGEST_EXPONENT || too_wide) {
        return Err(Error::OutOfRange);
    }
    let load = 4.0 * ((edge_radius / length) * (normal_force / modulus));
    let unit = flat.max((load / PI).sqrt());
    let contact = RoundedPunch::from_load(flat / unit, load / unit / unit);
    let size = contact.half_width;
    let shape = RoundedPunch { flat: contact.flat / size, w: contact.w / size, half_width: 1.0, ..contact };
    Ok((unit * size, shape))
}

/// Λ of Eq. 10, which must be positive for there to be any curve at all.
fn full_stick_compliance(parameters: &Parameters, pair: &Pair, half_width: f64) -> Result<f64, Error> {
    let slenderness = parameters.length / half_width;
    let centre = (2.0 * slenderness).ln() + pair.mean(|nu| nu / (1.0 - nu));
    let compliance = match parameters.displacement_reference {
        CENTRE_POINT => centre,
        _ => centre - strip_correction(pair, 1.0 / slenderness),
    };
    if slenderness > 0.5 && compliance > 0.0 { Ok(compliance) } else { Err(Error::LengthTooShort) }
}

/// What three-dimensional contact mechanics takes off Λ: the mean instead of the centre of the displacement along and
/// across the strip (1 - ln 2, and the term in b/L), and the redistribution of traction along it (0.093, fitted to
/// boundary-element results for 16 strips, which scatter from 0.081 to 0.102).
fn strip_correction(pair: &Pair, slenderness: f64) -> f64 {
    const REDISTRIBUTION: f64 = 0.093;
    let across = 8.0 / (PI * PI) * pair.mean(|nu| (1.0 - 2.0 * nu) / (1.0 - nu)) * slenderness;
    (1.0 - LN_2) + REDISTRIBUTION - across
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::parameters::{Material, RIGID_STRIP};

    pub(crate) const TITANIUM: Material = Material { young_modulus: 114e9, poisson_ratio: 0.32 };

    /// A small underplatform contact; half-widths of about 0.1 mm.
    pub(crate) fn parameters(flat_half_width: f64) -> Parameters {
        Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length: 10e-3,
            normal_force: 150.0,
            friction_coefficient: 0.4,
            material: [TITANIUM; 2],
            ..Parameters::default()
        }
    }

    /// Cylinder, slightly flattened, flat, and nearly all flat.
    pub(crate) const FLATS: [f64; 4] = [0.0, 1e-6, 50e-6, 5e-3];

    pub(crate) fn contact(flat_half_width: f64) -> Contact {
        Contact::rounded_flat(&parameters(flat_half_width)).unwrap()
    }

    /// A cylinder of that ratio of 2L to b.
    pub(crate) fn cylinder(slenderness: f64, poisson_ratio: f64, reference: i32) -> Result<Contact, Error> {
        let body = Material { young_modulus: 2e11, poisson_ratio };
        let half_width = 2.0 * 0.01 / slenderness;
        let modulus = Pair::new(&[body; 2]).composite_modulus;
        Contact::rounded_flat(&Parameters {
            normal_force: PI * modulus * 0.01 * half_width * half_width / (4.0 * 5e-3),
            material: [body; 2],
            displacement_reference: reference,
            ..parameters(0.0)
        })
    }

    pub(crate) fn ellipse(semi_axis_x: f64, semi_axis_y: f64) -> Contact {
        Contact::elliptic(&EllipticParameters {
            semi_axis_x,
            semi_axis_y,
            normal_force: 150.0,
            friction_coefficient: 0.4,
            material: [TITANIUM; 2],
        })
        .unwrap()
    }

    /// Λ, from the initial stiffness.
    fn compliance(contact: &Contact) -> f64 {
        contact.stiffness_scale / contact.initial_stiffness
    }

    #[test]
    fn the_half_width_obeys_equation_1() {
        for flat in FLATS {
            let contact = contact(flat);
            let load = 4.0 * 150.0 / 10e-3 * 5e-3 / contact.composite_modulus;
            let (b, sine) = (contact.half_width, flat / contact.half_width);
            let angle = sine.asin();
            // (π - 2φ0)/sin² φ0 - 2 cot φ0, times a² for the cylinder's sake.
            let expected = b * b * ((PI - 2.0 * angle) - 2.0 * sine * angle.cos());
            // Eq. 1 as it stands is a difference, (w/b)³ of its terms, and loses as many digits.
            let consumed = (1.0 - sine * sine).powf(-1.5);
            assert!((expected / load - 1.0).abs() < 1e-15 * (4.0 + consumed), "{flat}: {expected} {load}");
        }
    }

    #[test]
    fn unlike_bodies_have_each_their_own_compliance() {
        let steel = Material { young_modulus: 2.1e11, poisson_ratio: 0.28 };
        let one = Contact::rounded_flat(&Parameters { material: [steel, TITANIUM], ..parameters(20e-6) }).unwrap();
        let other = Contact::rounded_flat(&Parameters { material: [TITANIUM, steel], ..parameters(20e-6) }).unwrap();
        let of_body = |body: Material| {
            let nu = body.poisson_ratio;
            2.0 * (1.0 - nu * nu) / (PI * body.young_modulus) * ((2.0 * 10e-3 / one.half_width).ln() + nu / (1.0 - nu))
        };
        let expected = 10e-3 / (of_body(steel) + of_body(TITANIUM));
        // A few units of rounding, as between both orders.
        assert!((one.initial_stiffness / expected - 1.0).abs() < 2e-15);
        assert!((one.initial_stiffness / other.initial_stiffness - 1.0).abs() < 2e-15);
        assert!(one.initial_stiffness > contact(20e-6).initial_stiffness);
    }

    #[test]
    fn a_rigid_strip_is_stiffer_by_the_corrections_named() {
        for (nu, slenderness) in [(0.0, 4.0), (0.3, 10.0), (0.5, 100.0)] {
            let [centre, strip] =
                [CENTRE_POINT, RIGID_STRIP].map(|reference| cylinder(slenderness, nu, reference).unwrap());
            let across = 8.0 / (PI * PI) * (1.0 - 2.0 * nu) / (1.0 - nu) * 2.0 / slenderness;
            let expected = (1.0 - LN_2) + 0.093 - across;
            assert!((compliance(&centre) - compliance(&strip) - expected).abs() < 1e-14, "{nu}");
            assert_eq!((centre.half_width, centre.slip_force), (strip.half_width, strip.slip_force));
        }
        let two = cylinder(10.0, 0.3, 2).map(|_| ());
        assert_eq!(two, Err(Error::BadDisplacementReference));
    }

    #[test]
    fn a_length_below_half_the_half_width_is_refused() {
        for nu in [0.0, 0.3, 0.5] {
            for reference in [CENTRE_POINT, RIGID_STRIP] {
                // 2L = b to 1e-9: far beyond the rounding of both.
                let refused = cylinder(1.0 - 1e-9, nu, reference).map(|_| ());
                assert_eq!(refused, Err(Error::LengthTooShort), "{nu}");
                let barely = cylinder(1.0 + 1e-9, nu, reference).unwrap();
                assert!(barely.initial_stiffness > 0.0 && compliance(&barely) > 0.0, "{nu}");
            }
        }
        // A flat alone may be too wide for its length.
        let wide = Contact::rounded_flat(&parameters(20.1e-3)).map(|_| ());
        assert_eq!(wide, Err(Error::LengthTooShort));
    }

    /// Over numbers of any size: either refused, or finite and positive.
    #[test]
    fn what_is_accepted_is_representable() {
        let sizes = [1e-300, 1e-120, 1e-30, 1e-3, 1e5, 1e40, 1e150, 1e300];
        let (mut accepted, mut refused) = (0, 0);
        let mut check = |contact: Result<Contact, Error>| match contact {
            Ok(contact) => {
                accepted += 1;
                let Contact { half_width, slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
                for value in [half_width, slip_force, slip_displacement, initial_stiffness] {
                    assert!(value > 0.0 && value.is_finite(), "{contact:?}");
                }
                let work = slip_force * slip_displacement;
                assert!(slip_energy.is_normal() && slip_energy < 2.0 * work, "{contact:?}");
            }
            Err(error) => {
                refused += 1;
                assert!(matches!(error, Error::OutOfRange | Error::LengthTooShort), "{error:?}");
            }
        };
        for one in sizes {
            for two in sizes {
                for three in sizes {
                    for young_modulus in [1e-160, 1e11, 1e160] {
                        let material = [Material { young_modulus, poisson_ratio: 0.3 }; 2];
                        for flat in [0.0, 1e-200, 1e-4, 1e200] {
                            check(Contact::rounded_flat(&Parameters {
                                edge_radius: one,
                                length: two,
                                normal_force: three,
                                material,
                                ..parameters(flat)
                            }));
                        }
                        check(Contact::elliptic(&EllipticParameters {
                            semi_axis_x: one,
                            semi_axis_y: two,
                            normal_force: three,
                            friction_coefficient: 0.3,
                            material,
                        }));
                    }
                }
            }
        }
        assert!(accepted > 100 && refused > 1000, "{accepted} {refused}");
    }

    #[test]
    fn an_open_contact_and_one_without_friction_carry_no_force() {
        for flat in [0.0, 50e-6] {
            let open = Contact::rounded_flat(&Parameters { normal_force: 0.0, ..parameters(flat) }).unwrap();
            let smooth = Contact::rounded_flat(&Parameters { friction_coefficient: 0.0, ..parameters(flat) }).unwrap();
            assert_eq!((open.half_width, open.pressure(0.0)), (0.0, 0.0));
            assert_eq!((smooth.half_width, smooth.pressure(0.0)), {
                let rough = contact(flat);
                (rough.half_width, rough.pressure(0.0))
            });
            for contact in [open, smooth] {
                assert!(contact.is_initialised() && contact.composite_modulus > 0.0);
                let Contact { slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
                assert_eq!([slip_force, slip_displacement, initial_stiffness, slip_energy], [0.0; 4]);
                let point = contact.curve_at_displacement(1.0).unwrap();
                assert_eq!((point.force(), point.stiffness(), point.shear(0.0)), (0.0, 0.0, 0.0));
                let complex = contact.complex_stiffness(1.0).unwrap();
                assert_eq!((complex.real(), complex.imaginary()), (0.0, 0.0));
                assert_eq!((complex.d_real(), complex.d_imag()), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn a_negative_zero_is_a_zero() {
        let minus = Contact::rounded_flat(&Parameters { flat_half_width: -0.0, ..parameters(0.0) }).unwrap();
        assert_eq!(std::format!("{minus:?}"), std::format!("{:?}", contact(0.0)));
    }

    #[test]
    fn uninitialised_memory_is_recognised() {
        for contact in [contact(0.0), ellipse(1e-4, 2e-4)] {
            assert!(contact.is_initialised());
            for bit in 1..64 {
                assert!(!Contact { tag: contact.tag ^ (1 << bit), ..contact }.is_initialised());
            }
        }
    }

    /// Products in range whose factors are not: neither an overflow on the way nor a NaN that passes for a contact.
    #[test]
    fn factors_out_of_range_are_refused() {
        let body = Material { young_modulus: 5.5e85, poisson_ratio: 0.486 };
        let extreme = Parameters {
            flat_half_width: 0.0,
            edge_radius: 2.78e236,
            length: 4.8e-95,
            normal_force: 1.03e-171,
            friction_coefficient: 5.3e116,
            material: [body; 2],
            displacement_reference: 1,
            reserved: 0,
        };
        assert_eq!(Contact::rounded_flat(&extreme).map(|_| ()), Err(Error::OutOfRange));
    }

    #[test]
    fn a_displacement_of_gross_slip_that_no_call_takes_is_refused() {
        let (mut accepted, mut refused) = (0, 0);
        let soft = Material { young_modulus: 7.4e-57, ..TITANIUM };
        for exponent in 285..305 {
            let rough = EllipticParameters {
                semi_axis_x: 1e-4,
                semi_axis_y: 2e-4,
                normal_force: 100.0,
                friction_coefficient: 2f64.powi(exponent),
                material: [soft, TITANIUM],
            };
            match Contact::elliptic(&rough) {
                Ok(contact) => {
                    accepted += 1;
                    assert!(contact.curve_at_displacement(contact.slip_displacement).is_ok());
                }
                Err(error) => {
                    refused += 1;
                    assert_eq!(error, Error::OutOfRange);
                }
            }
        }
        assert!(accepted > 0 && refused > 0);
    }
}
