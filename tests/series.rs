//! A contact with a layer in series against the contact without it and the layer, solved together by Newton's method.

mod common;

use common::{advance, harmonic, unloaded};
use microslip::constant_load::equivalents::{iwan, jenkins};
use microslip::constant_load::harmonic_force::Rule;
use microslip::element::{Directions, Element, NormalInput};
use microslip::{Contact, EllipticParameters, Error, Layer, Material, Parameters};
use std::f64::consts::{PI, TAU};

const NORMAL_FORCE: f64 = 150.0;
const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

/// Cylinder, flat, nearly flat contact and ellipse, each with a layer.
fn contacts(friction_coefficient: f64, layer: &dyn Fn(&Contact) -> Layer) -> Vec<[Contact; 2]> {
    let flat = |flat_half_width| {
        let parameters = |layer| Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length: 10e-3,
            normal_force: NORMAL_FORCE,
            friction_coefficient,
            material: [STEEL; 2],
            layer,
            displacement_reference: microslip::parameters::CENTRE_POINT,
            ..Parameters::default()
        };
        let alone = Contact::rounded_flat(&parameters(Layer::none())).unwrap();
        [alone, Contact::rounded_flat(&parameters(layer(&alone))).unwrap()]
    };
    let ellipse = |layer| EllipticParameters {
        semi_axis_x: 1e-4,
        semi_axis_y: 2e-4,
        normal_force: NORMAL_FORCE,
        friction_coefficient,
        material: [STEEL; 2],
        layer,
        ..EllipticParameters::default()
    };
    let alone = Contact::elliptic(&ellipse(Layer::none())).unwrap();
    let sphere = [alone, Contact::elliptic(&ellipse(layer(&alone))).unwrap()];
    vec![flat(0.0), flat(50e-6), flat(5e-3), sphere]
}

/// Compliances in units of that of the contact, and N_c in units of the normal force.
const LAYERS: [(f64, f64); 9] = [
    (0.3, 0.0),
    (10.0, f64::INFINITY),
    (1.0, 3.0),
    (0.3, 0.3),
    (3.0, 0.1),
    (0.1, 0.01),
    (0.3, 1e-3),
    (3.0, 1e-3),
    (10.0, 1e-3),
];

/// A contact without a layer and the layer, under one force.
struct Pair {
    contact: Contact,
    slip_force: f64,
    compliance: f64,
    /// N_c/N; infinite for a constant stiffness.
    stiffening: f64,
    /// State of the contact, and reversals and present point of the layer: force and displacement.
    state: Vec<f64>,
    reversals: Vec<[f64; 2]>,
    now: [f64; 2],
}

impl Pair {
    fn new(contact: &Contact, layer: &Layer) -> Pair {
        let stiffening = layer.stiffening_load / NORMAL_FORCE;
        let stiffening = if stiffening > 0.0 { stiffening } else { f64::INFINITY };
        let (slip_force, compliance) = (contact.slip_force, layer.tangential_compliance);
        Pair {
            contact: *contact,
            slip_force,
            compliance,
            stiffening,
            state: unloaded(64),
            reversals: vec![],
            now: [0.0; 2],
        }
    }

    /// Displacement and compliance of the layer under a force that rises from 0.
    fn layer(&self, force: f64) -> [f64; 2] {
        let tau = force / self.slip_force;
        if self.stiffening.is_infinite() {
            return [self.compliance * force, self.compliance];
        }
        let sum = 1.0 + self.stiffening;
        let logarithm = if tau < 0.9 { -(-tau / sum).ln_1p() } else { -((self.stiffening + (1.0 - tau)) / sum).ln() };
        [self.compliance * self.slip_force * sum * logarithm, self.compliance * sum / (self.stiffening + (1.0 - tau))]
    }

    /// Displacement and compliance of both under a force that rises from 0.
    fn curve(&self, force: f64) -> [f64; 2] {
        let (point, [displacement, compliance]) = (self.contact.curve_at_force(force).unwrap(), self.layer(force));
        [point.displacement() + displacement, point.compliance() + compliance]
    }

    /// The force at a displacement: Newton's method between bounds.
    fn force(&self, displacement: f64) -> f64 {
        if displacement >= self.curve(self.slip_force)[0] {
            return self.slip_force;
        }
        let (mut low, mut high) = (0.0, self.slip_force);
        let mut force = 0.5 * high;
        for _ in 0..200 {
            let [found, compliance] = self.curve(force);
            *(if found < displacement { &mut low } else { &mut high }) = force;
            let next = force + (displacement - found) / compliance;
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - force).abs() <= 1e-16 * next {
                break;
            }
            force = next;
        }
        force
    }

    /// Displacement and compliance of the layer after its forces so far and another one, by Masing's rule, and the reversals then.
    fn layer_after(&self, force: f64) -> ([f64; 2], Vec<[f64; 2]>) {
        let mut reversals = self.reversals.clone();
        let [now, displacement] = self.now;
        let start = reversals.last().map_or(0.0, |[start, _]| *start);
        if (force - now) * (now - start) < 0.0 {
            reversals.push([now, displacement]);
        }
        loop {
            let &[start, displacement] = match reversals.as_slice() {
                [] => {
                    let [displacement, compliance] = self.layer(force.abs());
                    return ([displacement * force.signum(), compliance], reversals);
                }
                [.., last] => last,
            };
            let sign = if force >= start { 1.0 } else { -1.0 };
            // A branch ends at the reversal before its own, the first one at the mirror point of its own.
            let end = if let [.., before, _] = reversals.as_slice() { before[0] } else { -start };
            if sign * (force - end) < 0.0 {
                let [change, compliance] = self.layer(0.5 * (force - start).abs());
                return ([displacement + sign * 2.0 * change, compliance], reversals);
            }
            reversals.truncate(reversals.len().saturating_sub(2));
        }
    }

    /// A step to a displacement: force and stiffness.
    fn step(&mut self, displacement: f64) -> [f64; 2] {
        let reach = 4.0 * (self.curve(self.slip_force)[0] + displacement.abs());
        let (mut low, mut high) = (-reach, reach);
        let mut own = 0.0;
        for _ in 0..400 {
            let step = common::step(&self.contact, &self.state, own);
            let ([of_layer, compliance], _) = self.layer_after(step.force());
            let error = own + of_layer - displacement;
            *(if error < 0.0 { &mut low } else { &mut high }) = own;
            let next = own - error / (1.0 + compliance * step.stiffness());
            let next = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (next - own).abs() <= 1e-17 * reach {
                break;
            }
            own = next;
        }
        let (force, stiffness, _) = advance(&self.contact, &mut self.state, own);
        let ([of_layer, compliance], reversals) = self.layer_after(force);
        (self.now, self.reversals) = ([force, of_layer], reversals);
        [force, stiffness / (1.0 + compliance * stiffness)]
    }
}

/// A layer with a compliance in units of that of the contact, and N_c in units of the normal force.
fn layer_of((share, ratio): (f64, f64)) -> impl Fn(&Contact) -> Layer {
    move |contact| Layer {
        normal_compliance: 0.0,
        tangential_compliance: share / contact.initial_stiffness,
        stiffening_load: ratio * NORMAL_FORCE,
        reference_load: 0.0,
    }
}

/// All contacts with all layers: the contact alone, with the layer, and the layer.
fn all() -> impl Iterator<Item = (Contact, Contact, Layer)> {
    LAYERS.into_iter().flat_map(|layer| {
        let layer = layer_of(layer);
        contacts(0.4, &layer).into_iter().map(move |[alone, contact]| (alone, contact, layer(&alone)))
    })
}

#[test]
fn the_curve_and_its_inverse_are_those_of_the_pair() {
    for (alone, contact, layer) in all() {
        let pair = Pair::new(&alone, &layer);
        let slip = pair.curve(pair.slip_force)[0];
        assert!((contact.slip_displacement / slip - 1.0).abs() < 1e-14);
        assert!((contact.initial_stiffness * pair.curve(0.0)[1] - 1.0).abs() < 1e-14);
        // At gross slip a layer changes nothing of the stick zone: 0 but for a flat.
        let [end, alone_at_end] =
            [&contact, &alone].map(|one| one.curve_at_force(one.slip_force).unwrap().stick_half_width());
        assert_eq!(end, alone_at_end, "{layer:?}");
        for part in [1e-9, 0.01, 0.1, 0.3, 0.39, 0.41, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 0.999, 0.9999] {
            let force = part * pair.slip_force;
            let [displacement, compliance] = pair.curve(force);
            let (point, of_contact) = (contact.curve_at_force(force).unwrap(), alone.curve_at_force(force).unwrap());
            assert!((point.displacement() / displacement - 1.0).abs() < 1e-12, "{layer:?} {part}");
            assert!((point.compliance() / compliance - 1.0).abs() < 1e-11, "{layer:?} {part}");
            // Stick zone and tractions at a force are those of the contact alone.
            assert!((point.stick_half_width() / of_contact.stick_half_width() - 1.0).abs() < 1e-12, "{layer:?} {part}");
            for x in [0.0, 0.5, 0.9].map(|x| x * alone.half_width) {
                assert!(
                    (point.shear(x) - of_contact.shear(x)).abs() < 1e-11 * 0.4 * alone.pressure(0.0),
                    "{layer:?} {part}"
                );
                assert_eq!(contact.pressure(x), alone.pressure(x));
            }
            let displacement = part * slip;
            let (force, found) = (pair.force(displacement), contact.curve_at_displacement(displacement).unwrap());
            assert!((found.force() - force).abs() < 1e-11 * force, "{layer:?} {part} {} {force}", found.force());
            // Near gross slip a force that is rounded to 1e-16 of mu N gives the compliance to 1e-13/N_c only.
            let stiffness = 1.0 / pair.curve(force)[1];
            assert!((found.stiffness() / stiffness - 1.0).abs() < 1e-9, "{layer:?} {part}");
        }
    }
}

#[test]
fn histories_are_those_of_the_pair() {
    for (alone, contact, layer) in all() {
        let (mut pair, mut state) = (Pair::new(&alone, &layer), unloaded(64));
        let mut phase = 0.7_f64;
        for step in 0..60 {
            phase = (phase * 997.0).sin();
            let displacement = phase * contact.slip_displacement * if step % 20 == 19 { 1.2 } else { 0.97 };
            let ([force, stiffness], found) = (pair.step(displacement), advance(&contact, &mut state, displacement));
            assert!((found.0 - force).abs() < 1e-11 * contact.slip_force, "{layer:?} {step} {} {force}", found.0);
            assert!((found.1 - stiffness).abs() < 1e-9 * contact.initial_stiffness, "{layer:?} {step}");
        }
    }
}

/// Gauss-Legendre quadrature with 8 nodes on parts of (0, 1) that halve towards 1.
fn graded(integrand: impl Fn(f64) -> f64) -> f64 {
    const NODES: [[f64; 2]; 4] = [
        [0.183_434_642_495_649_8, 0.362_683_783_378_362],
        [0.525_532_409_916_329, 0.313_706_645_877_887_3],
        [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
        [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
    ];
    let mut sum = 0.0;
    for half in 0..130 {
        let (low, high) = (1.0 - 0.75_f64.powi(half), 1.0 - 0.75_f64.powi(half + 1));
        let (middle, length) = (0.5 * (low + high), 0.5 * (high - low));
        for [node, weight] in NODES {
            sum += length * weight * (integrand(middle - node * length) + integrand(middle + node * length));
        }
    }
    sum
}

#[test]
fn energies_and_complex_stiffnesses_are_those_of_the_pair() {
    for (alone, contact, layer) in all() {
        let pair = Pair::new(&alone, &layer);
        // At one force the energies add up. That of the layer is the area of a loop by Masing's rule, by parts, 8 ∫ (T - T0/2) dδ.
        let energy = |force: f64| {
            let of_layer = graded(|x| 8.0 * (x - 0.5) * pair.layer(force * x)[1]);
            alone.dissipated_energy(force).unwrap() + force * force * of_layer
        };
        for part in [0.1, 0.45, 0.55, 0.9, 1.0] {
            let force = part * pair.slip_force;
            let expected = energy(force);
            let found = contact.dissipated_energy(force).unwrap();
            let scale = force * pair.curve(force)[0];
            assert!((found - expected).abs() < 1e-11 * scale, "{layer:?} {part} {found} {expected}");
        }
        for part in [0.1, 0.3, 0.5, 0.75, 0.9, 0.98, 0.9995, 1.02, 1.3, 5.0] {
            let amplitude = part * contact.slip_displacement;
            let top = pair.force(amplitude);
            // K' = 8/(π δ0²) ∫ sqrt(δ (δ0 - δ)) dT, with T = T0 sin² φ.
            let real = 8.0 / PI / amplitude / amplitude
                * graded(|x| {
                    let (sine, cosine) = (0.5 * PI * x).sin_cos();
                    let force = top * sine * sine;
                    let displacement = pair.curve(force)[0];
                    (displacement * (amplitude - displacement).max(0.0)).sqrt() * top * PI * sine * cosine
                });
            let slip = (amplitude - contact.slip_displacement).max(0.0);
            let imaginary = (energy(top) + 4.0 * pair.slip_force * slip) / (PI * amplitude * amplitude);
            let found = contact.complex_stiffness(amplitude).unwrap();
            let scale = real.hypot(imaginary);
            assert!((found.real() - real).abs() < 1e-11 * scale, "{layer:?} {part} {} {real}", found.real());
            assert!(
                (found.imaginary() - imaginary).abs() < 1e-11 * scale,
                "{layer:?} {part} {} {imaginary}",
                found.imaginary()
            );
        }
    }
}

/// The harmonic force by uniform sampling is the transform of the forces of the pair, and its Jacobian their derivative; event-driven, that
/// of a harmonic motion is the complex stiffness.
#[test]
fn harmonic_forces_are_those_of_the_pair() {
    const SAMPLES: usize = 64;
    for (alone, contact, layer) in all() {
        let shape = [0.1, 0.6, -0.1, 0.0, 0.2];
        let coefficients = |scale: f64| shape.map(|part| scale * part * contact.slip_displacement);
        for scale in [0.9, 2.0] {
            let displacement = coefficients(scale);
            let mut pair = Pair::new(&alone, &layer);
            let mut expected = [0.0; 5];
            for sample in 0..2 * SAMPLES {
                let t = TAU * sample as f64 / SAMPLES as f64;
                let row = [1.0, t.cos(), t.sin(), (2.0 * t).cos(), (2.0 * t).sin()];
                let u: f64 = row.iter().zip(displacement).map(|(phi, u)| phi * u).sum();
                let [force, _] = pair.step(u);
                if sample >= SAMPLES {
                    expected.iter_mut().zip(row).enumerate().for_each(|(i, (sum, phi))| {
                        *sum += force * phi * if i == 0 { 1.0 } else { 2.0 } / SAMPLES as f64;
                    });
                }
            }
            let (force, jacobian, _) = harmonic(&contact, Rule::UniformSampling, SAMPLES, &displacement);
            for (found, expected) in force.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-11 * contact.slip_force, "{layer:?} {scale} {found} {expected}");
            }
            let h = 1e-6 * contact.slip_displacement;
            for column in 0..5 {
                let at = |step: f64| {
                    let mut displacement = displacement;
                    displacement[column] += step;
                    harmonic(&contact, Rule::UniformSampling, SAMPLES, &displacement).0
                };
                // One-sided, with an error of h times the second derivative, unless a sample is next to gross slip.
                for ((one, other), derivative) in at(h).iter().zip(at(-h)).zip(&jacobian[5 * column..]) {
                    let error = ((one - other) / (2.0 * h) - derivative).abs();
                    assert!(error < 1e-3 * contact.initial_stiffness, "{layer:?} {scale} {column} {error:e}");
                }
            }
        }
        for part in [0.3, 0.9, 1.5] {
            let amplitude = part * contact.slip_displacement;
            let (force, _, dissipated) = harmonic(&contact, Rule::EventDriven, 512, &[0.0, amplitude, 0.0]);
            let complex = contact.complex_stiffness(amplitude).unwrap();
            let found = [force[1], -force[2], dissipated / (PI * amplitude)].map(|force| force / amplitude);
            // The rule converges with the nodes between two events.
            for (found, expected) in found.iter().zip([complex.real(), complex.imaginary(), complex.imaginary()]) {
                assert!((found - expected).abs() < 1e-9 * complex.real(), "{layer:?} {part} {found} {expected}");
            }
        }
    }
}

/// Spring-sliders replace the curve of the pair.
#[test]
fn spring_sliders_are_those_of_the_pair() {
    for (alone, contact, layer) in all() {
        let pair = Pair::new(&alone, &layer);
        let mut sliders = Vec::new();
        let error = iwan(&contact, 8, |slider| sliders.push(slider)).unwrap();
        let largest = (1..400).map(|k| {
            let displacement = contact.slip_displacement * f64::from(k) / 400.0;
            let force: f64 = sliders.iter().map(|one| (one.stiffness * displacement).min(one.slip_force)).sum();
            (force - pair.force(displacement)).abs() / pair.slip_force
        });
        let largest = largest.fold(0.0, f64::max);
        assert!(largest < error * (1.0 + 1e-9) && largest > 0.9 * error, "{layer:?} {largest} {error}");
        let amplitude = 0.8 * contact.slip_displacement;
        let (one, complex) = (jenkins(&contact, amplitude).unwrap(), contact.complex_stiffness(amplitude).unwrap());
        let cosine = 1.0 - 2.0 * one.slip_force / (one.stiffness * amplitude);
        let (angle, sine) = (cosine.acos(), (1.0 - cosine * cosine).sqrt());
        // The angle has the rounding error of the cosine, near -1 its root.
        let found = [angle - sine * cosine, sine * sine].map(|part| one.stiffness / PI * part);
        for (found, expected) in found.iter().zip([complex.real(), complex.imaginary()]) {
            assert!((found - expected).abs() < 1e-11 * complex.real(), "{layer:?} {found} {expected}");
        }
    }
}

/// Contact and layer have together 60 N/um under 300 N, as measured, whatever the normal force of the parameters. A reference load of 0
/// is that normal force.
#[test]
fn a_layer_holds_at_its_reference_load() {
    let (measured, reference_load) = (60e6, 300.0);
    let parameters = |normal_force, layer| Parameters {
        flat_half_width: 0.5e-3,
        edge_radius: 3e-3,
        length: 20e-3,
        normal_force,
        friction_coefficient: 0.5,
        material: [STEEL; 2],
        layer,
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    };
    let smooth = Contact::rounded_flat(&parameters(reference_load, Layer::none())).unwrap();
    let compliance = 1.0 / measured - 1.0 / smooth.initial_stiffness;
    for stiffening_load in [0.0, 15.0, f64::INFINITY] {
        let of = |reference_load| Layer {
            normal_compliance: 0.8 * compliance,
            tangential_compliance: compliance,
            stiffening_load,
            reference_load,
        };
        let element =
            |layer| Element::rounded_flat(&parameters(4000.0, layer), Directions::One, NormalInput::Approach).unwrap();
        let found = element(of(reference_load)).displacement_under(0, 1e-9, reference_load);
        // The displacement under 1e-9 N has lost nothing, and nothing slips yet: 1e-9/(mu N) = 7e-12.
        assert!((measured * found.slope - 1.0).abs() < 1e-11, "{stiffening_load} {found:?}");
        let contact = Contact::rounded_flat(&parameters(reference_load, of(0.0))).unwrap();
        assert!((contact.initial_stiffness / measured - 1.0).abs() < 4e-15);
        let [same, given] = [of(0.0), of(4000.0)].map(|layer| {
            (format!("{:?}", Contact::rounded_flat(&parameters(4000.0, layer))), format!("{:?}", element(layer)))
        });
        assert!(same == given);
    }
}

/// At a constant normal force an element has the curve of the contact under that force, in both directions.
#[test]
fn displacements_of_elements_under_static_forces_are_those_of_contacts() {
    let ellipse = |[semi_axis_x, semi_axis_y]: [f64; 2], layer| EllipticParameters {
        semi_axis_x,
        semi_axis_y,
        normal_force: NORMAL_FORCE,
        friction_coefficient: 0.4,
        material: [STEEL; 2],
        layer,
        ..EllipticParameters::default()
    };
    let check = |element: &Element, direction: usize, contact: &Contact, normal_force: f64| {
        for part in [1e-12, -1e-3, 0.1, 0.24, 0.26, -0.7, 0.99, 1.0, -1.0] {
            let force = part * contact.slip_force;
            let (found, point) =
                (element.displacement_under(direction, force, normal_force), contact.curve_at_force(force).unwrap());
            assert!(
                (found.value / point.displacement() - 1.0).abs() < 4e-14,
                "{part} {found:?} {}",
                point.displacement()
            );
            let compliance = point.compliance();
            assert!(
                found.slope == compliance || (found.slope / compliance - 1.0).abs() < 1e-13,
                "{part} {found:?} {compliance}"
            );
        }
        let beyond = element.check_static(1.001 * contact.slip_force, normal_force);
        assert_eq!(beyond, Err(Error::ForceExceedsSlip));
    };
    for layer in [
        Layer::none(),
        Layer { normal_compliance: 1e-9, tangential_compliance: 5e-9, stiffening_load: 30.0, reference_load: 0.0 },
    ] {
        for input in [NormalInput::Approach, NormalInput::Force] {
            // The layer remains the same under less load.
            let (load, of_less) = (0.4 * NORMAL_FORCE, Layer { reference_load: NORMAL_FORCE, ..layer });
            for flat_half_width in [0.0, 50e-6] {
                let parameters = Parameters {
                    flat_half_width,
                    edge_radius: 5e-3,
                    length: 10e-3,
                    normal_force: NORMAL_FORCE,
                    friction_coefficient: 0.4,
                    material: [STEEL; 2],
                    layer,
                    displacement_reference: microslip::parameters::CENTRE_POINT,
                    ..Parameters::default()
                };
                let element = Element::rounded_flat(&parameters, Directions::One, input).unwrap();
                check(&element, 0, &Contact::rounded_flat(&parameters).unwrap(), NORMAL_FORCE);
                let less = Parameters { normal_force: load, layer: of_less, ..parameters };
                check(&element, 0, &Contact::rounded_flat(&less).unwrap(), load);
                let error = element.check_direction(1);
                assert_eq!(error, Err(Error::BadDirections));
            }
            let axes = [1e-4, 2e-4];
            let element = Element::elliptic(&ellipse(axes, layer), Directions::One, input).unwrap();
            let [across, along] =
                [axes, [axes[1], axes[0]]].map(|axes| Contact::elliptic(&ellipse(axes, layer)).unwrap());
            check(&element, 0, &across, NORMAL_FORCE);
            let element = Element::elliptic(&ellipse(axes, layer), Directions::Two, input).unwrap();
            check(&element, 0, &across, NORMAL_FORCE);
            check(&element, 1, &along, NORMAL_FORCE);
        }
    }
}
