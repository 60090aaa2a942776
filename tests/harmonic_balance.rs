//! Harmonic balance of two masses with one contact, solved independently of the Fortran programs of `fortran_examples`.
//!
//! They condense the structure to the contact, work with complex amplitudes and take force and Jacobian from the library.
//! Here all harmonics of all degrees of freedom are real unknowns, the force comes from a time history of three periods, and the
//! Jacobian from central differences. Both must give the same motion.

mod common;

use common::{harmonic, step, unloaded};
use microslip::constant_load::harmonic_force::Rule;
use microslip::{Contact, Material, Parameters};
use nalgebra::{DMatrix, DVector};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::process::Command;

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fortran_examples")
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A symmetric matrix of a Matrix Market file: its lower triangle by coordinates.
fn matrix_market(path: &Path) -> DMatrix<f64> {
    let text = text(path);
    let (header, body) = text.split_once('\n').unwrap();
    assert_eq!(header, "%%MatrixMarket matrix coordinate real symmetric");
    let lines = body.lines().filter(|line| !line.starts_with('%'));
    let mut rows =
        lines.map(|line| line.split_whitespace().map(|word| word.parse::<f64>().unwrap()).collect::<Vec<_>>());
    let size = rows.next().unwrap();
    let mut matrix = DMatrix::zeros(size[0] as usize, size[1] as usize);
    for row in rows {
        let (i, j) = (row[0] as usize - 1, row[1] as usize - 1);
        (matrix[(i, j)], matrix[(j, i)]) = (row[2], row[2]);
    }
    matrix
}

/// The variables of a namelist file as `group.name`, each a list of words; `2*x` is x twice.
fn namelist(path: &Path) -> HashMap<String, Vec<String>> {
    let (mut group, mut variables) = (String::new(), HashMap::new());
    for line in text(path).lines().map(|line| line.split('!').next().unwrap().trim()) {
        if let Some(name) = line.strip_prefix('&') {
            group = name.to_string();
        } else if let Some((name, values)) = line.split_once('=') {
            let repeated = values.split(',').flat_map(|value| match value.trim().split_once('*') {
                Some((times, value)) => vec![value.to_string(); times.parse().unwrap()],
                None => vec![value.trim().trim_matches('\'').to_string()],
            });
            let before = variables.insert(format!("{group}.{}", name.trim()), repeated.collect());
            assert!(before.is_none(), "{line} twice");
        }
    }
    variables
}

/// The case `two_dof`: one excited degree of freedom, one contact to the ground.
struct Case {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    /// Amplitudes of the cosine.
    excitation: DVector<f64>,
    touching: usize,
    contact: Contact,
    harmonics: usize,
    samples: usize,
    frequencies: Vec<f64>,
}

fn case() -> Case {
    let variables = namelist(&examples().join("cases/two_dof.nml"));
    let words = |name: &str| &variables.get(name).unwrap_or_else(|| panic!("no {name}"))[..];
    let numbers = |name: &str| words(name).iter().map(|word| word.parse().unwrap()).collect::<Vec<f64>>();
    let number = |name: &str| numbers(name)[0];
    let matrix = |name: &str| matrix_market(&examples().join(&words(name)[0]));
    let [modulus, ratio] = ["contact.young_modulus", "contact.poisson_ratio"].map(numbers);
    let body = [0, 1].map(|one| Material { young_modulus: modulus[one], poisson_ratio: ratio[one] });
    let parameters = Parameters {
        flat_half_width: number("contact.flat_half_width"),
        edge_radius: number("contact.edge_radius"),
        length: number("contact.length"),
        normal_force: number("contact.normal_force"),
        friction_coefficient: number("contact.friction_coefficient"),
        material: body,
        displacement_reference: microslip::parameters::RIGID_STRIP,
        ..Parameters::default()
    };
    // Not supported here.
    assert_eq!(words("contact.law")[0], "microslip");
    assert_eq!(numbers("contact.dof")[1], 0.0);
    assert_eq!(number("excitation.phase"), 0.0);
    assert_eq!(words("contact.displacement_reference")[0], "rigid_strip");
    assert!(!variables.contains_key("contact.count"));
    let mass = matrix("model.mass");
    let mut excitation = DVector::zeros(mass.nrows());
    excitation[number("excitation.dof") as usize - 1] = number("excitation.amplitude");
    Case {
        mass,
        damping: matrix("model.damping"),
        stiffness: matrix("model.stiffness"),
        excitation,
        touching: numbers("contact.dof")[0] as usize - 1,
        contact: Contact::rounded_flat(&parameters).unwrap(),
        harmonics: number("harmonic_balance.harmonics") as usize,
        samples: number("harmonic_balance.samples") as usize,
        frequencies: numbers("points.frequency"),
    }
}

/// Row of the Fourier series at a phase: 1, cos t, sin t, cos 2t, ...
fn fourier_row(coefficients: usize, phase: f64) -> Vec<f64> {
    (0..coefficients)
        .map(|c| {
            let angle = c.div_ceil(2) as f64 * phase;
            if c % 2 == 1 || c == 0 { angle.cos() } else { angle.sin() }
        })
        .collect()
}

/// Force and Jacobian of a contact from its displacement, coefficients [c0, cos1, sin1, ...].
type Law<'a> = dyn Fn(&[f64]) -> (Vec<f64>, DMatrix<f64>) + 'a;

/// The library's harmonic force with its own Jacobian.
fn library(contact: &Contact, samples: usize) -> impl Fn(&[f64]) -> (Vec<f64>, DMatrix<f64>) {
    move |displacement| {
        let (force, jacobian, _) = harmonic(contact, Rule::UniformSampling, samples, displacement);
        (force, DMatrix::from_vec(displacement.len(), displacement.len(), jacobian))
    }
}

/// The contact stepped through three periods; derivatives by central differences.
fn stepped(contact: &Contact, samples: usize) -> impl Fn(&[f64]) -> (Vec<f64>, DMatrix<f64>) {
    let force = move |displacement: &[f64]| -> Vec<f64> {
        let row = |sample: usize| fourier_row(displacement.len(), 2.0 * PI * sample as f64 / samples as f64);
        let rows: Vec<Vec<f64>> = (0..samples).map(row).collect();
        let mut state = unloaded(samples + 1);
        let mut sums = vec![0.0; displacement.len()];
        for sample in 0..3 * samples {
            let row = &rows[sample % samples];
            let displacement: f64 = row.iter().zip(displacement).map(|(value, coefficient)| value * coefficient).sum();
            let step = step(contact, &state, displacement);
            step.write(&mut state);
            if sample >= 2 * samples {
                sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += step.force() * value);
            }
        }
        let mean = |(c, sum): (usize, f64)| sum * if c == 0 { 1.0 } else { 2.0 } / samples as f64;
        sums.into_iter().enumerate().map(mean).collect()
    };
    move |displacement| {
        // Rounding of 1e-16/1e-5 and truncation of (1e-5)².
        let width = 1e-5 * displacement.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
        let column = |j: usize| {
            let moved = |sign: f64| {
                let mut moved = displacement.to_vec();
                moved[j] += sign * width;
                DVector::from_vec(force(&moved))
            };
            (moved(1.0) - moved(-1.0)) / (2.0 * width)
        };
        let columns: Vec<DVector<f64>> = (0..displacement.len()).map(column).collect();
        (force(displacement), DMatrix::from_columns(&columns))
    }
}

/// The balance at one frequency. Unknown `coefficient * dofs + dof`.
struct Balance<'a> {
    case: &'a Case,
    coefficients: usize,
    linear: DMatrix<f64>,
    excitation: DVector<f64>,
}

/// A motion, and the residuals of all iterations over the norm of the excitation.
struct Solution {
    motion: DVector<f64>,
    residuals: Vec<f64>,
}

impl<'a> Balance<'a> {
    fn new(case: &'a Case, frequency: f64, harmonics: usize) -> Balance<'a> {
        let (dofs, coefficients) = (case.mass.nrows(), 2 * harmonics + 1);
        let mut linear = DMatrix::zeros(dofs * coefficients, dofs * coefficients);
        for harmonic in 0..=harmonics {
            let omega = 2.0 * PI * frequency * harmonic as f64;
            let direct = &case.stiffness - &case.mass * (omega * omega);
            let across = &case.damping * omega;
            let size = (dofs, dofs);
            if harmonic == 0 {
                linear.view_mut((0, 0), size).copy_from(&direct);
            } else {
                let (cosine, sine) = ((2 * harmonic - 1) * dofs, 2 * harmonic * dofs);
                linear.view_mut((cosine, cosine), size).copy_from(&direct);
                linear.view_mut((cosine, sine), size).copy_from(&across);
                linear.view_mut((sine, cosine), size).copy_from(&-&across);
                linear.view_mut((sine, sine), size).copy_from(&direct);
            }
        }
        let mut excitation = DVector::zeros(dofs * coefficients);
        excitation.rows_mut(dofs, dofs).copy_from(&case.excitation);
        Balance { case, coefficients, linear, excitation }
    }

    fn at(&self, coefficient: usize, dof: usize) -> usize {
        coefficient * self.case.mass.nrows() + dof
    }

    /// Coefficients of one degree of freedom.
    fn of_dof(&self, motion: &DVector<f64>, dof: usize) -> Vec<f64> {
        (0..self.coefficients).map(|c| motion[self.at(c, dof)]).collect()
    }

    fn residual_and_jacobian(&self, law: &Law, motion: &DVector<f64>) -> (DVector<f64>, DMatrix<f64>) {
        let (mut residual, mut jacobian) = (&self.linear * motion - &self.excitation, self.linear.clone());
        let (force, derivatives) = law(&self.of_dof(motion, self.case.touching));
        let at = |coefficient: usize| self.at(coefficient, self.case.touching);
        for i in 0..self.coefficients {
            residual[at(i)] += force[i];
            for j in 0..self.coefficients {
                jacobian[(at(i), at(j))] += derivatives[(i, j)];
            }
        }
        (residual, jacobian)
    }

    /// The motion with a linear spring in place of the contact.
    fn with_spring(&self, stiffness: f64) -> DVector<f64> {
        let mut linear = self.linear.clone();
        for c in 0..self.coefficients {
            linear[(self.at(c, self.case.touching), self.at(c, self.case.touching))] += stiffness;
        }
        linear.lu().solve(&self.excitation).unwrap()
    }

    /// Newton's method with step halving, down to rounding.
    fn newton(&self, law: &Law, mut motion: DVector<f64>) -> Solution {
        let at = |motion: &DVector<f64>| self.residual_and_jacobian(law, motion);
        let (mut residual, mut jacobian) = at(&motion);
        let mut residuals = vec![residual.norm() / self.excitation.norm()];
        for _ in 0..60 {
            if residuals.last().is_some_and(|left| *left < 1e-14) {
                break;
            }
            let step = jacobian.clone().lu().solve(&residual).unwrap();
            let halved = (0..10).map(|halvings| &motion - &step * 0.5f64.powi(halvings));
            let better = halved.map(|trial| (at(&trial), trial)).find(|((left, _), _)| left.norm() < residual.norm());
            let Some(((left, slope), next)) = better else { break };
            (motion, residual, jacobian) = (next, left, slope);
            residuals.push(residual.norm() / self.excitation.norm());
        }
        Solution { motion, residuals }
    }

    /// Newton's method from the motions with softer and softer springs in place of the contact, until it converges.
    fn solve(&self, law: &Law) -> Solution {
        let solution = |part| self.newton(law, self.with_spring(part * self.case.contact.initial_stiffness));
        let is_converged = |solution: &Solution| solution.residuals.last().is_some_and(|left| *left < 1e-11);
        [1.0, 0.4, 0.1].into_iter().map(solution).find(is_converged).expect("a balance")
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

fn difference(one: &[f64], two: &[f64]) -> f64 {
    norm(&one.iter().zip(two).map(|(one, two)| one - two).collect::<Vec<_>>())
}

/// Values for the log.
fn scientific(values: &[f64]) -> Vec<String> {
    values.iter().map(|value| format!("{value:.1e}")).collect()
}

/// Amplitude of the first harmonic.
fn fundamental(coefficients: &[f64]) -> f64 {
    coefficients[1].hypot(coefficients[2])
}

/// Rows of a table `frequency_hz, dof, c0, cos1, sin1, ...` of the Fortran program against the balance here.
fn compare(case: &Case, table: &str, name: &str) {
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(names[..5], ["frequency_hz", "dof", "c0", "cos1", "sin1"], "{name}");
    assert_eq!(names.len(), 3 + 2 * case.harmonics, "{name}");
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|word| word.trim().parse().unwrap()).collect()).collect();
    let dofs = case.mass.nrows();
    assert_eq!(rows.len(), dofs * case.frequencies.len(), "{name}");
    let mut worst: f64 = 0.0;
    for (rows, &frequency) in rows.chunks(dofs).zip(&case.frequencies) {
        let balance = Balance::new(case, frequency, case.harmonics);
        let solution = balance.solve(&stepped(&case.contact, case.samples));
        for (dof, row) in rows.iter().enumerate() {
            assert_eq!(row[..2], [frequency, (dof + 1) as f64], "{name}");
            let here = balance.of_dof(&solution.motion, dof);
            worst = worst.max(difference(&here, &row[2..]) / norm(&here));
        }
    }
    println!("{name}: largest difference {worst:.1e} of the motion");
    // The Fortran program leaves a residual of up to 1e-12 (its `tolerance`), which the Jacobian's inverse, near the
    // resonances of the stuck and of the slipping contact, amplifies five times.
    assert!(worst < 1e-11, "{name}: {worst:e}");
}

#[test]
fn the_stored_result_of_the_fortran_program_is_the_same_motion() {
    compare(&case(), &text(&examples().join("expected/two_dof.csv")), "stored");
}

/// The printed amplitudes and energies of the small program that users compare theirs with, here and in the document.
#[test]
fn the_first_hour_prints_the_same_motion_and_energy() {
    let case = case();
    let table = text(&examples().join("expected/first_hour_after.txt"));
    let rows: Vec<Vec<f64>> = (table.lines().skip(2))
        .map(|line| line.split(',').map(|word| word.trim().parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), case.frequencies.len());
    let document = text(&examples().join("../docs/spring-sliders.md")).replace("\n   ", "\n");
    for name in ["before", "after"] {
        assert!(document.contains(&text(&examples().join(format!("expected/first_hour_{name}.txt")))), "{name}");
    }
    for (row, &frequency) in rows.iter().zip(&case.frequencies) {
        assert_eq!(row[0], frequency);
        let balance = Balance::new(&case, frequency, case.harmonics);
        let law = stepped(&case.contact, case.samples);
        let solution = balance.solve(&law);
        let of_contact = balance.of_dof(&solution.motion, case.touching);
        let (force, _) = law(&of_contact);
        let work =
            |k: usize| PI * k as f64 * (force[2 * k - 1] * of_contact[2 * k] - force[2 * k] * of_contact[2 * k - 1]);
        let here = [
            fundamental(&balance.of_dof(&solution.motion, 0)),
            fundamental(&of_contact),
            (1..=case.harmonics).map(work).sum(),
        ];
        for (here, printed) in here.iter().zip(&row[1..]) {
            // Six decimals of a micrometre or microjoule, rounded.
            assert!((1e6 * here - printed).abs() < 0.51e-6, "{frequency} Hz: {here:e}");
        }
    }
}

/// The Fortran program itself, if `MICROSLIP_PREFIX` is set and a compiler is installed.
#[test]
fn the_fortran_program_finds_the_same_motion() {
    let compiler = std::env::var("FC").unwrap_or("gfortran".to_string());
    let Some(prefix) = std::env::var_os("MICROSLIP_PREFIX") else { return println!("MICROSLIP_PREFIX is not set") };
    if !Command::new(&compiler).arg("--version").output().is_ok_and(|output| output.status.success()) {
        return println!("no {compiler}");
    }
    // Built in a copy: the examples may be built elsewhere at the same time, with another library.
    let copy = Path::new(env!("CARGO_TARGET_TMPDIR")).join("harmonic_balance");
    let _ = std::fs::remove_dir_all(&copy);
    std::fs::create_dir_all(copy.join("results")).unwrap();
    let run = |command: &mut Command| {
        let output = command.current_dir(&copy).output().unwrap();
        assert!(output.status.success(), "{command:?}\n{}", String::from_utf8_lossy(&output.stderr));
    };
    run(Command::new("cp")
        .arg("-R")
        .args(["src", "cases", "model", "Makefile"].map(|name| examples().join(name)))
        .arg("."));
    let prefix = std::fs::canonicalize(&prefix).unwrap();
    let mut make = Command::new("make");
    // Not a child of a make that may have started this.
    ["MAKEFLAGS", "MFLAGS", "MAKELEVEL"].iter().for_each(|name| _ = make.env_remove(name));
    run(make.arg("build/forced_response").arg(format!("FC={compiler}")).arg(format!("PREFIX={}", prefix.display())));
    run(Command::new("build/forced_response").args(["cases/two_dof.nml", "results"]));
    compare(&case(), &text(&copy.join("results/two_dof_coefficients.csv")), "fresh");
}

#[test]
fn newton_with_the_exact_jacobian_converges_quadratically_to_the_same_motion() {
    let case = case();
    let mut regimes = [false; 2];
    for &frequency in &case.frequencies {
        let balance = Balance::new(&case, frequency, case.harmonics);
        let stepped = balance.solve(&stepped(&case.contact, case.samples));
        let library = balance.solve(&library(&case.contact, case.samples));
        let moved = norm((&stepped.motion - &library.motion).as_slice()) / norm(library.motion.as_slice());
        // Both are converged to rounding error.
        assert!(moved < 1e-12, "{frequency} Hz: {moved:e}");
        println!("{frequency} Hz, moved {moved:.1e}: {:?}", scientific(&library.residuals));
        // Near the solution each relative residual is at most the square of the previous one: the curvature of the force over
        // its slope is of order 1 in these units. With a Jacobian that is wrong by 1 % a step gains two digits only.
        let mut squares = 0;
        for pair in library.residuals.windows(2).filter(|pair| (1e-11..0.1).contains(&pair[0])) {
            let allowed = (pair[0] * pair[0]).max(1e-14);
            // Far from the solution samples still change between the branches.
            let near = pair[0] < 1e-2;
            assert!(!near || pair[1] <= allowed, "{frequency} Hz: {:e} after {:e}", pair[1], pair[0]);
            squares += usize::from(pair[1] <= allowed);
        }
        assert!(squares >= 2, "{frequency} Hz");
        regimes[usize::from(
            fundamental(&balance.of_dof(&library.motion, case.touching)) > case.contact.slip_displacement,
        )] = true;
    }
    // Microslip and gross slip are both among the frequencies.
    assert_eq!(regimes, [true; 2]);
}
