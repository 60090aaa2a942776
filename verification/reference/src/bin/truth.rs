//! Exact values of the law, rounded to doubles: `truth < cases.csv > truth.csv`.
//!
//! Each row of standard input is `task,a,R,L,N,mu,E1,nu1,E2,nu2,arguments...` in SI units (flat half-width, edge radius, length,
//! normal force, friction coefficient, Young's modulus and Poisson's ratio of both bodies; the displacement is that of the centre
//! point). Standard output has a row of values for each, in the same order. Empty rows and rows that start with `#` are copied.
//!
//! | task | arguments | values |
//! |---|---|---|
//! | `contact` | | b, slip force, slip displacement, initial stiffness, energy of a cycle at incipient gross slip |
//! | `force` | displacement >= 0 | force and tangent stiffness on the initial loading curve |
//! | `displacement` | force >= 0 | displacement and compliance on the initial loading curve |
//! | `stiffness` | amplitude | K', K'', dK', dK'' |
//! | `harmonic` | samples, u0, c1, s1, ... | force coefficients f0, c1, s1, ...; exact integrals with 0 samples, else by their rule |
//! | `masing` | displacements | force after each of them, from the unloaded state |
//! | `element` | input, u, w, u, w, ... | T and N after each step of an element, from the open contact |
//! | `element_harmonic` | input, samples, u0, c1, s1, ..., w0, c1, s1, ... | coefficients of T, then of N, and the work of T, by the rule of uniform samples |
//!
//! The input of an element is 0 if w is the normal approach, 1 if it is the normal force.
//!
//! Before rounding, results have 33 digits, K' 20, its derivative 19 on the scale of K'/amplitude, exact harmonic forces 19 on that
//! of mu N.

use microslip::{Material, Parameters};
use reference::element::{Element, harmonic_force};
use reference::history::History;
use reference::{Input, Real, Reference, harmonic, stiffness};
use std::io::{Read, stdin};

fn row(line: &str) -> String {
    if line.is_empty() || line.starts_with('#') {
        return line.to_string();
    }
    let (task, numbers) = line.split_once(',').unwrap_or_else(|| panic!("{line}: no comma"));
    let numbers: Vec<f64> =
        numbers.split(',').map(|text| text.trim().parse().unwrap_or_else(|_| panic!("{line}: {text}"))).collect();
    assert!(numbers.len() >= 9, "{line}: nine parameters");
    let (given, arguments) = numbers.split_at(9);
    let body = |i: usize| Material { young_modulus: given[i], poisson_ratio: given[i + 1] };
    let contact = Reference::new(Input::Flat(Parameters {
        flat_half_width: given[0],
        edge_radius: given[1],
        length: given[2],
        normal_force: given[3],
        friction_coefficient: given[4],
        material: [body(5), body(7)],
        displacement_reference: microslip::parameters::CENTRE_POINT,
        ..Parameters::default()
    }));
    let values: Vec<Real> = match (task, arguments) {
        ("contact", []) => {
            let law = contact.law(0);
            let energy = law.energy_unit() * law.slip_point().energy;
            let initial = &law.stiffness_unit / &law.full_stick;
            let slip = &law.displacement_unit * &law.x_slip;
            vec![law.half_width.clone(), law.slip_force.clone(), slip, initial, energy]
        }
        ("force", [displacement]) => {
            let (law, point) = contact.at_displacement(*displacement);
            vec![&law.slip_force * &point.tau, &law.stiffness_unit * point.stiffness()]
        }
        ("displacement", [force]) => {
            let (law, point) = contact.at_force(*force);
            vec![&law.displacement_unit * &point.x, &point.compliance / &law.stiffness_unit]
        }
        ("stiffness", [amplitude]) => stiffness::complex_stiffness(&contact, *amplitude).into(),
        ("harmonic", [samples, u @ ..]) if u.len() % 2 == 1 => harmonic::force(&contact, u, *samples as usize),
        ("masing", displacements) => {
            let law = contact.law(50);
            let mut history = History::new(law.clone());
            let force = |u: &f64| {
                history.go(&law.x(*u), 0);
                &law.slip_force * &history.force()[0]
            };
            displacements.iter().map(force).collect()
        }
        ("element", [kind, steps @ ..]) => {
            let element = Element::new(&contact.input, *kind == 1.0);
            let mut state = element.open();
            let forces = steps.as_chunks().0.iter().flat_map(|&[u, w]| {
                let step = element.step(&mut state, &element.real(u), &element.real(w));
                [step.force, step.load]
            });
            forces.collect()
        }
        ("element_harmonic", [kind, samples, coefficients @ ..]) if coefficients.len() % 4 == 2 => {
            let element = Element::new(&contact.input, *kind == 1.0);
            let coefficients: Vec<Real> = coefficients.iter().map(|value| element.real(*value)).collect();
            let (mut values, work) = harmonic_force(&element, &coefficients, *samples as usize);
            values.push(work);
            values
        }
        _ => panic!("{line}: no such task, or wrong arguments"),
    };
    values.iter().map(|value| format!("{:e}", value.f64())).collect::<Vec<_>>().join(",")
}

fn main() {
    let mut text = String::new();
    stdin().read_to_string(&mut text).expect("standard input");
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let share =
        |first: usize| -> Vec<String> { lines.iter().skip(first).step_by(threads).map(|line| row(line)).collect() };
    let parts: Vec<Vec<String>> = std::thread::scope(|scope| {
        let share = &share;
        let workers: Vec<_> = (0..threads).map(|first| scope.spawn(move || share(first))).collect();
        workers.into_iter().map(|worker| worker.join().expect("every row")).collect()
    });
    for i in 0..lines.len() {
        println!("{}", parts[i % threads][i / threads]);
    }
}
