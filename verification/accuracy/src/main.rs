//! Measures the error of every output of the library against the multi-precision reference.
//!
//!     accuracy [--check] [--points N] [--seed N] [--elements] [--regions FILE] [--document FILE] [--replay FILE]
//!
//! `--check` is short, with a new seed each time. Regions are written to a CSV, tables to a document. `--elements` leaves out the law
//! of a constant load. `--replay` compares the worst inputs of a CSV of regions again, beside the random points.

mod bounds;
mod call;
mod curve;
mod element;
mod harmonic;
mod history;
mod layer;
mod replay;
mod report;
mod sampler;
mod stiffness;
mod tally;
mod tractions;

use sampler::{Case, ElementCase, KINDS, Sampler};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use tally::Tally;

/// Compares some outputs at random arguments of one contact or element.
#[derive(Clone, Copy)]
enum Measurement {
    Contact(fn(&Case, &mut Sampler, &mut Tally)),
    Element(fn(&ElementCase, &mut Sampler, &mut Tally)),
}
use Measurement::{Contact, Element};

/// Measurements, about how many points each counts as, and how many are one job.
const MEASUREMENTS: [(Measurement, f64, usize); 15] = [
    (Contact(curve::fields), 1.0, 4000),
    (Contact(curve::at_forces), 50.0, 200),
    (Contact(curve::at_displacements), 50.0, 200),
    (Contact(curve::sensitivities), 100.0, 20),
    (Contact(layer::curve), 100.0, 20),
    (Contact(tractions::at_forces), 48.0, 80),
    (Contact(history::along_a_path), 48.0, 80),
    (Contact(history::closed_loop), 48.0, 120),
    (Contact(harmonic::uniform_sampling), 200.0, 100),
    (Contact(curve::neighbours), 2e4, 10),
    (Contact(curve::sliders), 1e5, 10),
    (Contact(stiffness::at_amplitudes), 500.0, 10),
    (Contact(stiffness::event_driven), 200.0, 25),
    (Element(element::normal_law), 25.0, 200),
    (Element(element::along_a_path), 32.0, 80),
];

/// Measurements of one kind of contact.
struct Job {
    measurement: Measurement,
    kind: &'static str,
    count: usize,
}

/// Jobs for about the given number of points of every output.
fn jobs(points: f64, elements_only: bool) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (measurement, weight, piece) in MEASUREMENTS {
        if elements_only && matches!(measurement, Contact(_)) {
            continue;
        }
        let pieces = (points / weight / piece as f64).ceil().max(KINDS.len() as f64) as usize;
        let count = (points / weight / pieces as f64).ceil() as usize;
        jobs.extend((0..pieces).map(|i| Job { measurement, kind: KINDS[i % KINDS.len()], count }));
    }
    jobs
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let now = std::time::UNIX_EPOCH.elapsed().map_or(0, |now| now.as_secs());
    let (mut points, mut seed, mut regions, mut document, mut worst, mut elements_only) =
        (1e7, 1u64, None, None, None, false);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| panic!("{argument} needs a value"));
        match argument.as_str() {
            "--check" => (points, seed) = (1e4, now),
            "--points" => points = value().parse().expect("a number of points"),
            "--seed" => seed = value().parse().expect("a seed"),
            "--elements" => elements_only = true,
            "--regions" => regions = Some(PathBuf::from(value())),
            "--replay" => worst = Some(PathBuf::from(value())),
            "--document" => document = Some(PathBuf::from(value())),
            other => panic!("unknown argument {other}"),
        }
    }
    println!("seed {seed}");
    let (jobs, next, all) = (jobs(points, elements_only), AtomicUsize::new(0), Mutex::new(Tally::default()));
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
                match measurement {
                    Contact(measure) => measure(&sampler.case(kind), &mut sampler, &mut tally),
                    Element(measure) => measure(&sampler.element(kind), &mut sampler, &mut tally),
                }
            }
            all.lock().unwrap().add(tally);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, |n| n.get()) {
            scope.spawn(work);
        }
    });
    let mut tally = all.into_inner().unwrap();
    if let Some(path) = worst {
        replay::replay(&path, &mut tally);
    }
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
