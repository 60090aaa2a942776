//! Long and adversarial histories, with checks on every step.
//!
//! Every call traps invalid operations, divisions by zero and overflows.
//!
//! `stress [--scale X] [--seed N] [--only TEXT] [--jobs N]`; without a seed each run has another one, which is printed.

mod bank;
mod checked;
mod contacts;
mod histories;
mod library;
mod memory;
mod subjects;

use indicatif::{ProgressBar, ProgressStyle};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

/// An error is the message of a failed check.
pub type Outcome = Result<(), String>;

/// A condition, and the message if it does not hold.
#[macro_export]
macro_rules! ensure {
    ($holds:expr, $($message:tt)+) => {
        let holds: bool = $holds;
        if !holds {
            return Err(format!($($message)+));
        }
    };
}

/// The context of a case.
pub struct Run {
    pub rng: ChaCha8Rng,
    bar: ProgressBar,
}

impl Run {
    /// Reports progress by the given number of steps.
    pub fn done(&self, steps: u64) {
        self.bar.inc(steps);
    }
}

type Test = Box<dyn Fn(&mut Run) -> Result<String, String> + Send + Sync>;

/// One test: its name, its steps, and the test itself, which returns a remark.
pub struct Case {
    pub name: String,
    pub steps: u64,
    pub test: Test,
}

impl Case {
    pub fn new(
        name: String,
        steps: u64,
        test: impl Fn(&mut Run) -> Result<String, String> + Send + Sync + 'static,
    ) -> Case {
        Case { name, steps, test: Box::new(test) }
    }
}

struct Arguments {
    scale: f64,
    seed: u64,
    only: String,
    jobs: usize,
}

fn arguments() -> Result<Arguments, lexopt::Error> {
    use lexopt::prelude::*;
    let jobs = thread::available_parallelism().map_or(1, |jobs| jobs.get());
    let seed = std::time::UNIX_EPOCH.elapsed().map_or(1, |now| now.as_secs());
    let mut arguments = Arguments { scale: 1.0, seed, only: String::new(), jobs };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("scale") => arguments.scale = parser.value()?.parse()?,
            Long("seed") => arguments.seed = parser.value()?.parse()?,
            Long("only") => arguments.only = parser.value()?.parse()?,
            Long("jobs") => arguments.jobs = parser.value()?.parse()?,
            _ => return Err(argument.unexpected()),
        }
    }
    Ok(arguments)
}

/// The generator of a case, independent of other cases: its seed is a hash (Fowler, Noll, Vo) of its name.
fn random(seed: u64, name: &str) -> ChaCha8Rng {
    let hash = name.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    ChaCha8Rng::seed_from_u64(hash)
}

fn main() -> ExitCode {
    let Arguments { scale, seed, only, jobs } = match arguments() {
        Ok(arguments) => arguments,
        Err(error) => {
            eprintln!("{error}\nusage: stress [--scale X] [--seed N] [--only TEXT] [--jobs N]");
            return ExitCode::from(2);
        }
    };
    let mut cases = subjects::all(scale);
    cases.retain(|case| case.name.contains(&only));
    // The longest first, to keep all threads busy.
    cases.sort_by_key(|case| std::cmp::Reverse(case.steps));
    let start = Instant::now();
    println!("{} cases, seed {seed}, scale {scale}", cases.len());
    let style = "{elapsed_precise} {wide_bar} {human_pos}/{human_len} steps, {eta} left";
    let style = ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::new(cases.iter().map(|case| case.steps).sum()).with_style(style);
    let (next, failures) = (AtomicUsize::new(0), Mutex::new(0));
    thread::scope(|scope| {
        for _ in 0..jobs.max(1) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let begun = Instant::now();
                    let mut run = Run { rng: random(seed, &case.name), bar: bar.clone() };
                    let outcome = (case.test)(&mut run);
                    let seconds = begun.elapsed().as_secs_f64();
                    let mut failures = failures.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                    bar.suspend(|| match outcome {
                        Ok(remark) => println!("{:66} {seconds:6.2} s  {remark}", case.name),
                        Err(failure) => {
                            *failures += 1;
                            println!("FAILED: {}\n  {failure}", case.name);
                            println!(
                                "  again: make stress ARGUMENTS=\"--seed {seed} --scale {scale} --only '{}'\"",
                                case.name
                            );
                        }
                    });
                }
            });
        }
    });
    bar.finish_and_clear();
    let failures = failures.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
    println!("{:.0} s", start.elapsed().as_secs_f64());
    println!("{} passed, {failures} failed", cases.len() - failures);
    if failures == 0 && !cases.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
