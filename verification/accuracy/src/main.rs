//! Measures the error of every output of the library against the multi-precision reference.
//!
//!     accuracy [--check] [--points N] [--minutes N] [--seed N] [--only NAMES] [--regions FILE] [--document FILE]
//!
//! `--check` is short, with a new seed each time; after `--minutes` no further job starts. Regions are written to a CSV, also
//! from time to time during a run; tables to a document, with `--points 0` those of the CSV without a run.

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

use sampler::{KINDS, Sampler};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;
use tally::Tally;

/// What is measured, on which kind of contact, how often.
#[derive(Clone, Copy)]
struct Job {
    what: &'static str,
    kind: &'static str,
    count: usize,
}

/// Jobs for about the given number of points of every output.
fn jobs(points: f64) -> Vec<Job> {
    let mut jobs = Vec::new();
    // Points of one count, and counts of one job.
    for (what, per_count, piece) in [
        ("fields", 1.0, 4000),
        ("forces", 1.0, 10000),
        ("displacements", 1.0, 10000),
        ("tractions", 1.0, 4000),
        ("histories", 1.0, 4000),
        ("loops", 1.0, 6000),
        ("harmonic", 200.0, 100),
        ("neighbours", 2e4, 10),
        ("sliders", 1e5, 10),
        ("amplitudes", 100.0, 50),
        ("event_driven", 200.0, 25),
    ] {
        let pieces = (points / per_count / piece as f64).ceil().max(KINDS.len() as f64) as usize;
        let count = (points / per_count / pieces as f64).ceil() as usize;
        let place = |i: usize| (i as f64 + 0.5) / pieces as f64;
        jobs.extend((0..pieces).map(|i| (place(i), Job { what, kind: KINDS[i % KINDS.len()], count })));
    }
    // Interleaved, so that a run that is cut short has some of each.
    jobs.sort_by(|one, two| one.0.total_cmp(&two.0));
    jobs.into_iter().map(|(_, job)| job).collect()
}

fn run(job: &Job, sampler: &mut Sampler, tally: &mut Tally) {
    let Job { what, kind, count } = *job;
    if what == "fields" {
        (0..count).for_each(|_| curve::fields(sampler, kind, tally));
        return;
    }
    let mut left = count as i64;
    while left > 0 {
        let case = sampler.case(kind, &mut tally.rejected);
        let mut done = 1;
        match what {
            "forces" => done = curve::at_forces(&case, sampler, 50, tally),
            "displacements" => done = curve::at_displacements(&case, sampler, 50, tally),
            "tractions" => done = tractions::at_forces(&case, sampler, 48, tally),
            "histories" => done = history::along_a_path(&case, sampler, 48, tally),
            "loops" => done = history::closed_loop(&case, sampler, tally),
            "harmonic" => harmonic::uniform_sampling(&case, sampler, tally),
            "neighbours" => curve::neighbours(&case, sampler, tally),
            "sliders" => curve::sliders(&case, sampler, tally),
            "amplitudes" => done = stiffness::at_amplitudes(&case, sampler, 5, tally),
            "event_driven" => stiffness::event_driven(&case, sampler, tally),
            other => panic!("no job {other}"),
        }
        left -= done;
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (mut check, mut points, mut minutes) = (false, 1e7, f64::MAX);
    let (mut seed, mut only, mut regions, mut document) = (None, None, None, None);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().unwrap_or_else(|| panic!("{argument} needs a value"));
        match argument.as_str() {
            "--check" => (check, points) = (true, 1e4),
            "--points" => points = value().parse().expect("a number of points"),
            "--minutes" => minutes = value().parse().expect("a number of minutes"),
            "--seed" => seed = Some(value().parse().expect("a seed")),
            "--only" => only = Some(value()),
            "--regions" => regions = Some(PathBuf::from(value())),
            "--document" => document = Some(PathBuf::from(value())),
            other => panic!("unknown argument {other}"),
        }
    }
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0, |now| now.as_secs());
    let seed: u64 = seed.unwrap_or(if check { now } else { 1 });
    println!("seed {seed}");
    let jobs: Vec<Job> = jobs(points)
        .into_iter()
        .filter(|job| only.as_ref().is_none_or(|only: &String| only.split(',').any(|only| job.what == only)))
        .collect();
    if points == 0.0 {
        let (regions, document) = (regions.expect("--regions"), document.expect("--document"));
        report::write_tables(&report::read_regions(&regions), &document);
        return;
    }
    let (next, all) = (AtomicUsize::new(0), Mutex::new(Tally::default()));
    let start = Instant::now();
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    let Some(job) = jobs.get(i) else { break };
                    if start.elapsed().as_secs_f64() > 60.0 * minutes {
                        break;
                    }
                    let mut tally = Tally::default();
                    let mut sampler = Sampler::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(i as u64));
                    run(job, &mut sampler, &mut tally);
                    let mut all = all.lock().unwrap();
                    all.add(tally);
                    if let Some(path) = &regions
                        && i % 100 == 99
                    {
                        report::write_regions(&all, path);
                    }
                    drop(all);
                    if !check && (i < 64 || i % 100 == 0) {
                        let minutes = start.elapsed().as_secs_f64() / 60.0;
                        eprintln!("{i} of {} pieces, {minutes:.1} min: {} on {}", jobs.len(), job.what, job.kind);
                    }
                }
            });
        }
    });
    let tally = all.into_inner().unwrap();
    if let Some(path) = regions {
        report::write_regions(&tally, &path);
    }
    if let Some(path) = document {
        report::write_tables(&tally, &path);
    }
    let (passed, failed) = report::summary(&tally);
    println!("{passed} passed, {failed} failed");
    std::process::exit(i32::from(failed > 0));
}
