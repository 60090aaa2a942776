//! Measures the error of every output of the library against the multi-precision reference.
//!
//!     accuracy [--check] [--points N] [--seed N] [--regions FILE] [--document FILE]
//!
//! `--check` is short, with a new seed each time. Regions are written to a CSV, tables to a document.

mod bounds;
mod call;
mod curve;
mod harmonic;
mod history;
mod report;
mod sampler;
mod stiffness;
mod tally;
mod tractions;

use sampler::{Case, KINDS, Sampler};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tally::Tally;

/// Compares some outputs at random arguments of one contact.
type Measurement = fn(&Case, &mut Sampler, &mut Tally);

/// Measurements, about how many points each counts as, and how many are one job.
const MEASUREMENTS: [(Measurement, f64, usize); 11] = [
    (curve::fields, 1.0, 4000),
    (curve::at_forces, 50.0, 200),
    (curve::at_displacements, 50.0, 200),
    (tractions::at_forces, 48.0, 80),
    (history::along_a_path, 48.0, 80),
    (history::closed_loop, 48.0, 120),
    (harmonic::uniform_sampling, 200.0, 100),
    (curve::neighbours, 2e4, 10),
    (curve::sliders, 1e5, 10),
    (stiffness::at_amplitudes, 500.0, 10),
    (stiffness::event_driven, 200.0, 25),
];

/// Measurements of one kind of contact.
struct Job {
    measurement: Measurement,
    kind: &'static str,
    count: usize,
}

/// Jobs for about the given number of points of every output.
fn jobs(points: f64) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (measurement, weight, piece) in MEASUREMENTS {
        let pieces = (points / weight / piece as f64).ceil().max(KINDS.len() as f64) as usize;
        let count = (points / weight / pieces as f64).ceil() as usize;
        jobs.extend((0..pieces).map(|i| Job { measurement, kind: KINDS[i % KINDS.len()], count }));
    }
    jobs
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let now = std::time::UNIX_EPOCH.elapsed().map_or(0, |now| now.as_secs());
    let (mut points, mut seed, mut regions, mut document) = (1e7, 1u64, None, None);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| panic!("{argument} needs a value"));
        match argument.as_str() {
            "--check" => (points, seed) = (1e4, now),
            "--points" => points = value().parse().expect("a number of points"),
            "--seed" => seed = value().parse().expect("a seed"),
            "--regions" => regions = Some(PathBuf::from(value())),
            "--document" => document = Some(PathBuf::from(value())),
            other => panic!("unknown argument {other}"),
        }
    }
    println!("seed {seed}");
    let (jobs, next, all) = (jobs(points), AtomicUsize::new(0), Mutex::new(Tally::default()));
    let work = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(Job { measurement, kind, count }) = jobs.get(i) else { break };
            if i * 100 / jobs.len() != (i + 1) * 100 / jobs.len() && jobs.len() > 1000 {
                eprintln!("{} %", (i + 1) * 100 / jobs.len());
            }
            let mut tally = Tally::default();
            let mut sampler = Sampler::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(i as u64));
            for _ in 0..*count {
                measurement(&sampler.case(kind), &mut sampler, &mut tally);
            }
            all.lock().unwrap().add(tally);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(work);
        }
    });
    let tally = all.into_inner().unwrap();
    if let Some(path) = regions {
        report::write_regions(&tally, &path);
    }
    if let Some(path) = document {
        report::write_table(&tally, &path);
    }
    let (passed, failed) = report::summary(&tally);
    println!("{passed} passed, {failed} failed");
    std::process::exit(i32::from(failed > 0));
}
