//! Measures the error of every output of the library against the multi-precision reference, and checks properties of long
//! histories, at random contacts, elements, layers and histories. No call may raise a floating-point exception that an application
//! can trap.
//!
//!     verify [--points N] [--only TEXT] [--regions FILE] [--promises FILE] [--replay FILE]
//!
//! `MICROSLIP_SEED` is the seed, 1 without it. Regions and promises are written to CSV files. `--only` takes the measurements whose
//! name contains a text. `--replay` compares the worst inputs of a CSV of regions again, beside the random points.

mod bounds;
mod call;
#[allow(dead_code, reason = "not all is used here")]
#[path = "../../../tests/calls/mod.rs"]
mod calls;
mod curve;
mod element;
mod harmonic;
mod histories;
mod history;
mod layer;
mod modes;
mod replay;
mod report;
mod sampler;
mod steps;
mod stiffness;
mod tally;
mod tractions;
mod two_directions;

use microslip::Parameters;
use reference::Input;
use sampler::{Case, ElementCase, KINDS, Sampler};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
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

/// Names, measurements, about how many points each counts as, and how many are one job.
const MEASUREMENTS: [(&str, Measurement, f64, usize); 17] = [
    ("curve::fields", Contact(curve::fields), 1.0, 4000),
    ("curve::at_forces", Contact(curve::at_forces), 50.0, 200),
    ("curve::at_displacements", Contact(curve::at_displacements), 50.0, 200),
    ("curve::sensitivities", Contact(curve::sensitivities), 100.0, 20),
    ("layer::curve", Contact(layer::curve), 100.0, 20),
    ("tractions::at_forces", Contact(tractions::at_forces), 48.0, 80),
    ("history::along_a_path", Contact(history::along_a_path), 48.0, 80),
    ("history::closed_loop", Contact(history::closed_loop), 48.0, 120),
    ("harmonic::uniform_sampling", Contact(harmonic::uniform_sampling), 200.0, 100),
    ("curve::sliders", Contact(curve::sliders), 1e5, 10),
    ("stiffness::at_amplitudes", Contact(stiffness::at_amplitudes), 500.0, 10),
    ("element::normal_law", Element(element::normal_law), 25.0, 200),
    ("element::along_a_path", Element(element::along_a_path), 32.0, 80),
    ("steps::of_contact", Contact(steps::of_contact), 20.0, 50),
    ("steps::of_element", Element(steps::of_element), 40.0, 50),
    ("two_directions::histories", Element(two_directions::histories), 200.0, 10),
    ("modes::check_all_laws", Contact(modes::check_all_laws), 10.0, 20),
];

/// Measurements, kinds and seeds of jobs that have raised an exception: squares of derivatives overflowed; a size underflowed where
/// the compliance of a short contact nearly vanishes; a stick zone larger than such a contact.
const FOUND: [(&str, &str, u64); 4] = [
    ("two_directions::histories", "extreme scales", 11400714819323245717),
    ("two_directions::histories", "a/b -> 1", 11400714819323246898),
    ("steps::of_element", "2L -> b, flat", 17366393550078969282),
    ("steps::of_contact", "2L -> b, flat", 1456069854528987750),
];

/// Measurements of one kind of contact; the seed is the same if other jobs are left out.
struct Job {
    name: &'static str,
    measurement: Measurement,
    kind: &'static str,
    count: usize,
    seed: u64,
}

/// Jobs for about the given number of points of every output.
fn jobs(points: f64, only: &str) -> Vec<Job> {
    let (mut jobs, mut seed) = (Vec::new(), reference::seed().wrapping_mul(0x9e37_79b9_7f4a_7c15));
    for (name, measurement, weight, piece) in MEASUREMENTS {
        let pieces = (points / weight / piece as f64).ceil().max(KINDS.len() as f64) as usize;
        let count = (points / weight / pieces as f64).ceil() as usize;
        for i in 0..pieces {
            if name.contains(only) {
                jobs.push(Job { name, measurement, kind: KINDS[i % KINDS.len()], count, seed });
            }
            seed = seed.wrapping_add(1);
        }
    }
    for (name, measurement, _, count) in MEASUREMENTS.into_iter().filter(|(name, ..)| name.contains(only)) {
        let found = FOUND.into_iter().filter(|found| found.0 == name);
        jobs.extend(found.map(|(_, kind, seed)| Job { name, measurement, kind, count, seed }));
    }
    jobs
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (mut points, mut only, mut regions, mut promises, mut worst) = (1e7, String::new(), None, None, None);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| panic!("{argument} needs a value"));
        match argument.as_str() {
            "--points" => points = value().parse().expect("a number of points"),
            "--only" => only = value(),
            "--regions" => regions = Some(PathBuf::from(value())),
            "--replay" => worst = Some(PathBuf::from(value())),
            "--promises" => promises = Some(PathBuf::from(value())),
            other => panic!("unknown argument {other}"),
        }
    }
    println!("seed {}", reference::seed());
    let (jobs, next, all) = (jobs(points, &only), AtomicUsize::new(0), Mutex::new(Tally::default()));
    let stopped = Mutex::new(BTreeSet::new());
    let work = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(Job { name, measurement, kind, count, seed }) = jobs.get(i) else { break };
            if i * 100 / jobs.len() != (i + 1) * 100 / jobs.len() && jobs.len() > 1000 {
                eprintln!("{} %", (i + 1) * 100 / jobs.len());
            }
            let mut tally = Tally::default();
            let mut sampler = Sampler::new(*seed);
            for _ in 0..*count {
                let inputs = RefCell::new(Input::Flat(Parameters::default()));
                let measured = catch_unwind(AssertUnwindSafe(|| match measurement {
                    Contact(measure) => {
                        let case = sampler.case(kind);
                        *inputs.borrow_mut() = case.reference.input;
                        measure(&case, &mut sampler, &mut tally);
                    }
                    Element(measure) => {
                        let case = sampler.element(kind);
                        *inputs.borrow_mut() = case.input;
                        measure(&case, &mut sampler, &mut tally);
                    }
                }));
                // The message is printed already; the next point would begin where this one ended.
                if measured.is_err() {
                    println!("{name} failed: {kind}, seed {seed}, {}", sampler::text(&inputs.borrow()));
                    stopped.lock().unwrap().insert(*name);
                    break;
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
    if let Some(path) = promises {
        report::write_promises(&tally, &path);
    }
    // Beside the outputs, the measurements that check properties; a failed check of any kind is an assertion.
    let (passed, failed) = report::summary(&tally);
    let stopped = stopped.into_inner().unwrap().len();
    let names: BTreeSet<&str> = jobs.iter().map(|job| job.name).collect();
    let (passed, failed) = (passed + names.len() - stopped, failed + stopped);
    println!("{passed} passed, {failed} failed");
    std::process::exit(i32::from(failed > 0 || passed == 0));
}
