//! Known parameters are recovered from computed loops, the intervals contain them as often as they should, the verdict is right.

mod common;
use common::*;
use microslip::element::{Directions, Element, NormalInput};
use microslip::one_direction::{advance, state_init, state_length};
use microslip_fit::{
    Contact, Error, Estimate, Geometry, Measurement, NormalForce, Options, Report, ShapeParameter, Status, fit,
    fit_json,
};
use std::thread;

/// Reports of loops of two amplitudes, one with and one without gross slip; the series compliance in units of the contact's.
fn report(series: f64, noise: [f64; 2], seed: u64) -> Result<Report, Error> {
    let (contact, mut random) = (flat(), Random::new(seed));
    let series_compliance = series / library_contact(&contact, 800.0).initial_stiffness;
    let rig = |amplitude: f64| Rig { series_compliance, amplitude, noise, samples: 60, ..RIG };
    let loops = [0.8, 2.0].map(|amplitude| measured(&contact, &rig(amplitude), &mut random));
    fit(&contact, &loops, &Options::default())
}

/// Friction coefficient, series, contact and total compliance, shape.
fn estimates(report: &Report) -> [Estimate; 5] {
    let Report { friction_coefficient, series_compliance, contact_compliance, total_compliance, .. } = *report;
    [friction_coefficient, series_compliance, contact_compliance, total_compliance, report.shape.unwrap()]
}

fn truth(series: f64) -> [f64; 5] {
    let law = library_contact(&flat(), 800.0);
    let compliance = 1.0 / law.initial_stiffness;
    [0.5, series * compliance, 1.0, (1.0 + series) * compliance, 0.1e-3 / law.half_width]
}

const SEEDS: u64 = 200;

/// How often the intervals contain the truth, and the reports.
fn coverage(series: f64, noise: [f64; 2]) -> ([usize; 5], Vec<Report>) {
    let part = move |seeds: std::ops::Range<u64>| -> Vec<_> {
        seeds.map(|seed| report(series, noise, seed).unwrap()).collect()
    };
    let half = thread::spawn(move || part(SEEDS / 2..SEEDS));
    let reports = [part(0..SEEDS / 2), half.join().unwrap()].concat();
    let contains = |report: &Report, i: usize| {
        let Estimate { lower, upper, .. } = estimates(report)[i];
        (lower..=upper.unwrap_or(f64::INFINITY)).contains(&truth(series)[i])
    };
    (std::array::from_fn(|i| reports.iter().filter(|report| contains(report, i)).count()), reports)
}

fn count(reports: &[Report], is: impl Fn(&Report) -> bool) -> usize {
    reports.iter().filter(|report| is(report)).count()
}

#[test]
fn intervals_cover_and_the_shape_is_determined_if_the_contact_dominates() {
    let (hits, reports) = coverage(0.2, [5e-4, 5e-5]);
    let determined = count(&reports, |report| report.shape.unwrap().status == Status::Determined);
    println!("contact dominates: {hits:?} of {SEEDS} intervals contain the truth, shape determined {determined} times");
    // The number of successes of 200 with probability 0.95 is in this range with probability 0.997.
    assert!(hits.iter().all(|hits| (180..200).contains(hits)), "{hits:?}");
    assert_eq!(determined, 200);
    assert_eq!(count(&reports, |report| report.friction_coefficient.status == Status::Determined), 200);
    assert!(reports[0].verdict.iter().any(|sentence| sentence.starts_with("The shape is determined")));
    // A spring and a slider have no such curves.
    assert!(reports.iter().all(|report| report.spring_slider.misfit.force_rms > 2.0 * report.law.force_rms));
}

#[test]
fn the_shape_is_hidden_by_a_series_compliance() {
    let (hits, reports) = coverage(20.0, [1e-2, 1e-3]);
    let hidden = count(&reports, |report| report.shape.unwrap().status == Status::NotDetermined);
    println!("rig dominates: {hits:?} of {SEEDS} intervals contain the truth, shape hidden {hidden} times");
    // Intervals that enclose those of all shapes, and half-infinite ones, cover more often. All shapes are admitted nearly as often
    // as the true one: their curves differ by less than the noise.
    assert!(hits.iter().all(|hits| *hits >= 180), "{hits:?}");
    assert!(hidden >= 180, "{hidden}");
    assert_eq!(count(&reports, |report| report.shape.unwrap().status == Status::Determined), 0);
    assert_eq!(count(&reports, |report| report.total_compliance.status == Status::Determined), 200);
    let hides = |report: &Report| report.verdict.iter().any(|sentence| sentence.contains("hides the microslip"));
    assert_eq!(count(&reports, hides), hidden);
}

/// Without noise the error is that of the minimisation.
fn assert_recovered(estimate: Estimate, truth: f64, name: &str) {
    assert!((estimate.value - truth).abs() <= 2e-4 * truth, "{name}: {} instead of {truth}", estimate.value);
}

#[test]
fn loops_without_noise_return_the_parameters() {
    let report = report(0.5, [0.0; 2], 1).unwrap();
    for ((estimate, truth), name) in
        estimates(&report).into_iter().zip(truth(0.5)).zip(["mu", "series", "contact", "total", "shape"])
    {
        assert_recovered(estimate, truth, name);
    }
    assert!(report.law.energy < 1e-4 && report.warnings.is_empty(), "{:?} {:?}", report.law, report.warnings);
}

#[test]
fn loops_at_several_loads_and_another_radius() {
    let (mut contact, mut random) = (flat(), Random::new(3));
    let stiffness = library_contact(&contact, 800.0).initial_stiffness;
    let rig = Rig { series_compliance: 0.3 / stiffness, contact_compliance: 1.25, samples: 100, ..RIG };
    let rigs = [400.0, 800.0].map(|normal_force| Rig { normal_force, ..rig });
    let loops = rigs.map(|rig| measured(&contact, &rig, &mut random));
    let shape = 0.1e-3 / library_contact(&contact, 800.0).half_width;
    let Geometry::Flat { edge_radius, .. } = &mut contact.geometry else { panic!() };
    *edge_radius *= 1.7;
    let options =
        Options { shape: ShapeParameter::EdgeRadius, series_compliance: Some(0.3 / stiffness), ..Options::default() };
    let report = fit(&contact, &loops, &options).unwrap();
    assert_recovered(report.shape.unwrap(), shape, "a/b");
    assert_recovered(report.contact_compliance, 1.25, "contact compliance");
    assert_eq!(report.series_compliance.status, Status::Fixed);
    // The file has the modulus and the radius divided by the factor.
    let line = report.contact_toml.lines().find(|line| line.starts_with("edge_radius")).unwrap();
    let radius: f64 = line.split(" = ").nth(1).unwrap().parse().unwrap();
    assert!((radius / (50e-3 / report.contact_compliance.value) - 1.0).abs() < 1e-3, "{line}");
}

/// Report of three loops under loads up to 800 N in the ratio of 1 to `range`: of a contact with a layer of this N_c, or with a
/// spring; and the compliance of either, half that of the contact.
fn layered(stiffening_load: Option<f64>, range: f64, seed: u64) -> (Report, f64) {
    let (contact, mut random) = (flat(), Random::new(seed));
    let compliance = 0.5 / library_contact(&contact, 800.0).initial_stiffness;
    let rig = Rig { noise: [1e-3, 1e-4], samples: 100, ..RIG };
    let rig = match stiffening_load {
        Some(load) => Rig { layer: [compliance, load], ..rig },
        None => Rig { series_compliance: compliance, ..rig },
    };
    let rigs = [(0.6, 800.0 / range), (2.0, 800.0 / range.sqrt()), (1.2, 800.0)];
    let loops =
        rigs.map(|(amplitude, load)| measured(&contact, &Rig { amplitude, normal_force: load, ..rig }, &mut random));
    let options = Options { shape: ShapeParameter::Fixed, ..Options::default() };
    (fit(&contact, &loops, &options).unwrap(), compliance)
}

#[test]
fn a_series_stiffness_that_grows_with_the_load_is_seen_from_several_loads() {
    let says = |report: &Report, part: &str| report.verdict.iter().any(|sentence| sentence.contains(part));
    let covers = |at: Estimate, truth: f64| (at.lower..=at.upper.unwrap()).contains(&truth);
    let (mut hits, mut constant) = ([0; 2], 0);
    for seed in 0..40 {
        let (report, compliance) = layered(Some(400.0), 8.0, seed);
        // N_c = 400 N under 800 N: 2/3 of the stiffness grow with the load.
        let (share, series) = (report.series_stiffening, report.series_compliance);
        assert!(share.status == Status::Determined && series.status == Status::Determined, "{:?}", report.verdict);
        hits[0] += usize::from(covers(share, 2.0 / 3.0));
        hits[1] += usize::from(covers(series, compliance));
        assert!(says(&report, "grows in proportion to N + N_c"));
        constant += usize::from(layered(None, 8.0, seed).0.series_stiffening.lower == 0.0);
    }
    println!("{hits:?} of 40 intervals contain share and compliance; {constant} of 40 springs are constant");
    // Of 40 with probability 0.95, 33 or more succeed with probability 0.999.
    assert!(hits.iter().all(|hits| *hits >= 33) && constant >= 33);

    // The file has the layer; a constant stiffness has no N_c.
    let number = |report: &Report, name: &str| -> Option<f64> {
        report.contact_toml.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(" = ")?.parse().ok())
    };
    let (report, compliance) = layered(Some(400.0), 8.0, 1);
    assert!((number(&report, "stiffening_load").unwrap() / 400.0 - 1.0).abs() < 0.02, "{}", report.contact_toml);
    assert!((number(&report, "tangential_compliance").unwrap() / compliance - 1.0).abs() < 0.02);
    let (report, _) = layered(None, 8.0, 1);
    assert!(number(&report, "stiffening_load").is_none() && says(&report, "A constant series stiffness explains all"));
    // One load shows nothing of it.
    let (report, _) = layered(None, 1.0, 1);
    assert_eq!((report.series_stiffening.status, report.series_stiffening.value), (Status::Fixed, 0.0));
}

/// A sphere: the law against Mindlin's closed form `T = μN (1 - (1 - d/d0)^(3/2))`, loops by Masing's rule.
#[test]
fn a_sphere_has_no_shape() {
    let axis = 0.2e-3;
    let contact = Contact { geometry: Geometry::Ellipse { semi_axis_x: axis, semi_axis_y: axis }, ..flat() };
    // Mindlin's stiffness 8 G* a, 1/G* = sum of (2-ν)/G; d0 = 3/2 μN/k.
    let shear = 2e11 / 2.6;
    let stiffness = 8.0 * axis / (2.0 * 1.7 / shear);
    let (force, series) = (0.4 * 800.0, 0.25 / stiffness);
    let end = 1.5 * force / stiffness;
    let curve = |d: f64| force * (1.0 - (1.0 - (d / end).min(1.0)).powf(1.5));
    let loops = [0.7, 1.8].map(|part: f64| {
        let amplitude = part * end;
        let at = |i: i32| {
            let branch = 50 - (i % 200 - 100).abs();
            let (from, sign) = if i % 200 < 100 { (-1.0, 1.0) } else { (1.0, -1.0) };
            let d = amplitude * (std::f64::consts::PI * f64::from(branch) / 100.0).sin();
            let tangential = sign * (2.0 * curve(0.5 * (d - from * amplitude).abs()) - curve(amplitude));
            (d + series * tangential, tangential)
        };
        let (displacement, force) = (0..500).map(at).unzip();
        Measurement { displacement, force, ..Measurement::default() }
    });
    let report = fit(&contact, &loops, &Options::default()).unwrap();
    assert_recovered(report.friction_coefficient, 0.4, "mu");
    assert_recovered(report.series_compliance, series, "series");
    assert_recovered(report.contact_compliance, 1.0, "contact");
    assert!(report.shape.is_none() && report.profile.is_empty());
}

/// Loops of the element under a normal force that swings by the given fraction, with its column; errors of
/// friction coefficient, total compliance and shape, with the column and without.
fn under_swing(swing: f64) -> [[f64; 3]; 2] {
    let contact = flat();
    let element =
        Element::rounded_flat(&library_parameters(&contact, 1000.0), Directions::One, NormalInput::Force).unwrap();
    let end = library_contact(&contact, 800.0).slip_displacement;
    let loops = [0.8, 2.0].map(|amplitude| {
        let mut state = vec![0.0; state_length(4000)];
        state_init(&mut state).unwrap();
        let (mut force, mut displacement, mut loads) = (Vec::new(), Vec::new(), Vec::new());
        for i in 0..700 {
            let phase = std::f64::consts::TAU * f64::from(i) / 200.0;
            let load = 800.0 * (1.0 + swing * (2.0 * phase + 0.7).sin());
            let at = amplitude * end * phase.sin();
            force.push(advance(&element, &mut state, [at, load], false).unwrap().force[0]);
            displacement.push(at);
            loads.push(load);
        }
        Measurement { displacement, force, normal_force: Some(NormalForce::Samples(loads)), ..Measurement::default() }
    });
    let without = loops.clone().map(|one| Measurement { normal_force: None, ..one });
    [&loops, &without].map(|loops| {
        let report = fit(&contact, loops, &Options::default()).unwrap();
        let law = library_contact(&contact, 800.0);
        [
            report.friction_coefficient.value / 0.5 - 1.0,
            report.total_compliance.value * law.initial_stiffness - 1.0,
            report.shape.unwrap().value - 0.1e-3 / law.half_width,
        ]
    })
}

/// The swing is included to first order, so that an error of its square remains.
#[test]
fn a_small_swing_of_the_normal_force_is_included() {
    for swing in [0.02, 0.08] {
        let [with, without] = under_swing(swing);
        println!("swing {swing}: errors {with:?}, without the column {without:?}");
        assert!(with.iter().all(|error| error.abs() < 10.0 * swing * swing), "{with:?}");
        assert!(without[0].abs() > 100.0 * with[0].abs());
    }
}

#[test]
fn without_gross_slip_friction_has_a_lower_bound_only() {
    let (contact, mut random) = (flat(), Random::new(5));
    let rig = |amplitude: f64| Rig { amplitude, noise: [1e-3, 0.0], samples: 100, ..RIG };
    let loops = [0.3, 0.5].map(|amplitude| measured(&contact, &rig(amplitude), &mut random));
    let report = fit(&contact, &loops, &Options::default()).unwrap();
    let friction = report.friction_coefficient;
    assert_eq!((friction.status, friction.upper), (Status::LowerBound, None));
    assert!((0.2..0.5).contains(&friction.lower), "{friction:?}");
    assert!(report.verdict[0].contains("lower bound"));
}

#[test]
fn one_amplitude_is_a_warning() {
    let (contact, mut random) = (flat(), Random::new(7));
    let loops = [measured(&contact, &RIG, &mut random)];
    let report = fit(&contact, &loops, &Options::default()).unwrap();
    assert!(report.warnings.iter().any(|warning| warning.contains("one amplitude only")));
}

type Change<'a> = &'a dyn Fn(&mut Measurement);

/// The message about a loop that was changed.
fn message(change: impl Fn(&mut Measurement)) -> String {
    let (contact, mut random) = (flat(), Random::new(11));
    let mut one = measured(&contact, &Rig { noise: [2e-3, 1e-5], ..RIG }, &mut random);
    change(&mut one);
    fit(&contact, &[one], &Options::default()).unwrap_err().to_string()
}

#[test]
fn bad_data_are_reported() {
    let times = |factor: f64| move |values: &mut Vec<f64>| values.iter_mut().for_each(|value| *value *= factor);
    let cases: [(&str, Change); 13] = [
        ("force of sample 8 is not a number", &|one| one.force[7] = f64::NAN),
        ("force has 499 values", &|one| one.force.truncate(499)),
        ("jumps by more than a quarter", &|one| {
            one.displacement.drain(80..140);
            one.force.drain(80..140);
        }),
        ("a gap of", &|one| {
            let time = (0..one.force.len()).map(|i| i as f64 + if i > 100 { 5.0 } else { 0.0 });
            one.time = Some(time.collect());
        }),
        ("saturated", &|one| one.force.iter_mut().for_each(|force| *force = force.min(300.0))),
        ("swapped", &|one| std::mem::swap(&mut one.force, &mut one.displacement)),
        ("sign of displacement or force", &|one| times(-1.0)(&mut one.force)),
        ("no friction coefficient", &|one| times(1e3)(&mut one.force)),
        ("is the displacement in another unit", &|one| times(1e-3)(&mut one.displacement)),
        ("less than one cycle", &|one| {
            one.displacement.truncate(80);
            one.force.truncate(80);
        }),
        ("the contact is open", &|one| one.normal_force = Some(NormalForce::Constant(0.0))),
        ("swings by", &|one| {
            let load = (0..one.force.len()).map(|i| 800.0 + 200.0 * (i as f64 / 30.0).sin());
            one.normal_force = Some(NormalForce::Samples(load.collect()));
        }),
        ("amplitude changes", &|one| {
            let decay = |(i, value): (usize, &mut f64)| *value *= (-(i as f64) / 300.0).exp();
            one.displacement.iter_mut().enumerate().for_each(decay);
        }),
    ];
    for (part, change) in cases {
        let message = message(change);
        assert!(message.contains(part), "{part}: {message}");
    }
    // A displacement in mm instead of m is a series compliance, unless one knows better.
    let mut one = measured(&flat(), &Rig { samples: 100, ..RIG }, &mut Random::new(1));
    times(1e4)(&mut one.displacement);
    let report = fit(&flat(), &[one], &Options::default()).unwrap();
    assert!(report.warnings.iter().any(|warning| warning.contains("another unit")), "{:?}", report.warnings);
    assert!(fit(&flat(), &[], &Options::default()).is_err());
}

#[test]
fn json_has_the_names_of_the_parameter_file() {
    let (contact, mut random) = (flat(), Random::new(1));
    let loops = [measured(&contact, &Rig { samples: 60, ..RIG }, &mut random)];
    let options = Options { contact_compliance: Some(1.0), ..Options::default() };
    let problem = format!(
        r#"{{"contact": {{"flat_half_width": 1e-4, "edge_radius": 0.05, "length": 0.02, "normal_force": 800,
        "displacement_reference": "centre_point", "friction_coefficient": 0.5, "material": [{{"young_modulus": 2e11, "poisson_ratio": 0.3}}, {{"young_modulus": 2e11, "poisson_ratio": 0.3}}]}},
        "loops": {}, "options": {{"contact_compliance": 1.0}}}}"#,
        serde_json::to_string(&loops).unwrap()
    );
    let report: Report = serde_json::from_str(&fit_json(&problem).unwrap()).unwrap();
    assert!(report == fit(&contact, &loops, &options).unwrap(), "{:?}", report.verdict);
    assert!(fit_json("{}").unwrap_err().to_string().contains("contact"));
    let _: &Contact = &contact;
}

/// Whatever the record, there is a report of finite numbers or a message.
#[test]
fn arbitrary_records_are_fitted_or_rejected() {
    let mut fitted = 0;
    for seed in 0..300 {
        let mut random = Random::new(seed);
        let count = 40 + (random.uniform() * 200.0) as usize;
        let mut walk = 0.0;
        let mut column = |kind: u64, size: f64| -> Vec<f64> {
            let value = |i: usize| {
                walk += random.normal();
                let phase = i as f64 / 15.0;
                size * match kind {
                    0 => random.normal(),
                    1 => walk,
                    2 => phase.sin() + 0.01 * random.normal(),
                    3 => (phase.sin() * 3.0).clamp(-1.0, 1.0) + 0.3 * (phase - 0.8).sin(),
                    _ => (phase.sin() * 1.2).round(),
                }
            };
            (0..count).map(value).collect()
        };
        let [displacement, force] = [column(seed % 5, 1e-6), column(seed / 5 % 5, 200.0)];
        let measurement = Measurement { displacement, force, ..Measurement::default() };
        match fit(&flat(), &[measurement], &Options::default()) {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(report) => {
                let numbers = estimates(&report).map(|estimate| [estimate.value, estimate.lower]);
                assert!(numbers.as_flattened().iter().all(|number| number.is_finite()), "{seed}: {numbers:?}");
                assert!(
                    report.law.force_rms.is_finite() && report.spring_slider.misfit.force_rms.is_finite(),
                    "{seed} {:?} {:?}",
                    report.law,
                    report.spring_slider
                );
                fitted += 1;
            }
        }
    }
    assert!(fitted > 20, "{fitted}");
}
