//! Computed measurements: loops of the library, in series with a spring, with offset, drift and noise.

use microslip::constant_load::state::state_length;
use microslip::constant_load::{ConstantLoad, Law};
use microslip::{Layer, Parameters};
use microslip_fit::{
    Contact, ContactParameters, DisplacementReference, Estimate, Geometry, Material, Measurement, NormalForce, Report,
};
use std::f64::consts::TAU;
use std::{env, fs, thread};

/// Fits of each kind for the tables of the document: `make identification`.
const ALL: usize = 200;

pub const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/identification.md");

/// A number from the environment.
pub fn variable(name: &str) -> Option<usize> {
    env::var(name).ok().map(|value| value.parse().expect("a number"))
}

/// The given number of results, or `MICROSLIP_FITS`, of the seeds from 0 on.
pub fn of_seeds<T: Send>(number: usize, of_seed: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let number = variable("MICROSLIP_FITS").unwrap_or(number);
    let part = |start: usize| (start..number).step_by(2).map(|seed| of_seed(seed as u64)).collect::<Vec<_>>();
    thread::scope(|scope| {
        let odd = scope.spawn(|| part(1));
        let even = part(0);
        even.into_iter().chain(odd.join().unwrap()).collect()
    })
}

pub fn count<T>(results: &[T], is: impl Fn(&T) -> bool) -> usize {
    results.iter().filter(|result| is(result)).count()
}

/// Friction coefficient, series, contact and total compliance, shape and parallel stiffness.
pub fn estimates(report: &Report) -> [Estimate; 6] {
    let Report { friction_coefficient, series_compliance, contact_compliance, .. } = *report;
    let [total, shape] = [report.total_compliance, report.shape.unwrap()];
    [friction_coefficient, series_compliance, contact_compliance, total, shape, report.parallel_stiffness]
}

/// Whether the verdict says this.
pub fn says(report: &Report, text: &str) -> bool {
    report.verdict.iter().any(|sentence| sentence.contains(text))
}

/// The rows of a table of the document, each with its number of fits. All fits write it; of fewer, the counts must be those of a
/// part.
pub fn check_table(name: &str, rows: &[(usize, String)]) {
    let text = fs::read_to_string(DOCUMENT).unwrap();
    let ends = ["begin", "end"].map(|end| format!("<!-- {name}: {end} -->"));
    let mut lines: Vec<_> = text.lines().collect();
    let [begin, end] = ends.map(|end| lines.iter().position(|line| line.trim() == end).unwrap());
    let (indent, table) = (lines[begin].split('<').next().unwrap(), begin + 3..end);
    let is_part = |fits: usize, [few, all]: [&str; 2]| match [few, all].map(str::parse::<usize>) {
        [Ok(few), Ok(all)] => few <= all && all - few <= ALL - fits,
        _ => few == all,
    };
    if rows.iter().any(|(fits, _)| *fits < ALL) {
        assert_eq!(rows.len(), table.len(), "{name}");
        for ((fits, row), line) in rows.iter().zip(&lines[table]) {
            let [few, all] = [row.as_str(), line.trim()].map(|row| row.split([' ', ',']));
            assert!(few.clone().count() == all.clone().count(), "{row}: {line}");
            assert!(few.zip(all).all(|(few, all)| is_part(*fits, [few, all])), "{row}: {line}");
        }
        return;
    }
    let rows: Vec<_> = rows.iter().map(|(_, row)| format!("{indent}{row}")).collect();
    lines.splice(table, rows.iter().map(String::as_str));
    fs::write(DOCUMENT, lines.join("\n") + "\n").unwrap();
}

pub const STEEL: Material = Material { young_modulus: 2e11, poisson_ratio: 0.3 };

/// The contact of `microslip example`: a/b = 0.33.
pub fn flat() -> Contact {
    let geometry = Geometry::Flat {
        flat_half_width: 0.1e-3,
        edge_radius: 50e-3,
        length: 20e-3,
        displacement_reference: DisplacementReference::CentrePoint,
    };
    Contact { geometry, normal_force: 800.0, friction_coefficient: 0.5, material: [STEEL; 2] }
}

/// The same contact as the library takes it.
pub fn library_parameters(contact: &Contact, normal_force: f64) -> Parameters {
    let ContactParameters::Flat(parameters) = contact.parameters(Layer::none()) else { panic!("a flat") };
    Parameters { normal_force, ..parameters }
}

pub fn library_contact(contact: &Contact, normal_force: f64) -> microslip::Contact {
    microslip::Contact::rounded_flat(&library_parameters(contact, normal_force)).unwrap()
}

/// Random numbers: a linear congruential generator of 64 bits.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Random {
        let mut random = Random(seed);
        (0..8).for_each(|_| _ = random.uniform());
        random
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    /// Normally distributed, of variance 1 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let (one, other) = (self.uniform(), self.uniform());
        (-2.0 * one.ln()).sqrt() * (TAU * other).cos()
    }
}

/// How a loop is measured. Noise, offset and drift of the force are fractions of the slip force, of the displacement of its range.
#[derive(Clone, Copy)]
pub struct Rig {
    pub series_compliance: f64,
    /// A layer with this compliance under the normal force of the contact and N_c; none if the compliance is 0.
    pub layer: [f64; 2],
    pub contact_compliance: f64,
    pub normal_force: f64,
    /// Amplitude of the contact's displacement over that of gross slip.
    pub amplitude: f64,
    pub samples: usize,
    pub cycles: usize,
    /// Noise of force and displacement.
    pub noise: [f64; 2],
    /// Correlation of the noise of successive samples.
    pub correlation: f64,
    pub offset: f64,
    pub drift: f64,
}

pub const RIG: Rig = Rig {
    series_compliance: 0.0,
    layer: [0.0, 0.0],
    contact_compliance: 1.0,
    normal_force: 800.0,
    amplitude: 1.5,
    samples: 200,
    cycles: 2,
    noise: [0.0; 2],
    correlation: 0.0,
    offset: 0.1,
    drift: 0.05,
};

pub fn measured(contact: &Contact, rig: &Rig, random: &mut Random) -> Measurement {
    let mut parameters = library_parameters(contact, rig.normal_force);
    let [compliance, load] = rig.layer;
    parameters.layer = Layer {
        tangential_compliance: compliance,
        stiffening_load: load,
        reference_load: contact.normal_force,
        ..Layer::default()
    };
    let law = &microslip::Contact::rounded_flat(&parameters).unwrap();
    let mut state = vec![0.0; state_length(16)];
    ConstantLoad::state_init(&mut state).unwrap();
    let amplitude = rig.amplitude * law.slip_displacement;
    let mut noise = [0.0; 2];
    let (mut displacement, mut force) = (Vec::new(), Vec::new());
    let total = rig.samples * rig.cycles + rig.samples / 2;
    // From rest to the first reversal and beyond, then complete cycles.
    for i in 0..total {
        // The reversals are between samples.
        let phase = TAU * (i as f64 + 0.3) / rig.samples as f64;
        let at = amplitude * phase.sin();
        let tangential = ConstantLoad::step(law, &mut state, at).unwrap().force;
        let scatter = (1.0 - rig.correlation * rig.correlation).sqrt();
        noise = noise.map(|last| rig.correlation * last + scatter * random.normal());
        let part = i as f64 / total as f64;
        let end = rig.contact_compliance * amplitude + rig.series_compliance * law.slip_force;
        let disturbance = rig.offset + rig.drift * part;
        force.push(tangential + law.slip_force * (disturbance + rig.noise[0] * noise[0]));
        displacement.push(
            rig.contact_compliance * at
                + rig.series_compliance * tangential
                + end * (disturbance + rig.noise[1] * noise[1]),
        );
    }
    Measurement {
        name: format!("{} N", rig.normal_force),
        displacement,
        force,
        normal_force: Some(NormalForce::Constant(rig.normal_force)),
        time: None,
    }
}
