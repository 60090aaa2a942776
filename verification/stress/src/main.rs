//! Long and adversarial histories of every contact: each kind with checks on every step, and all kinds against a bank of sliders.
//!
//! Every call traps invalid operations, divisions by zero and overflows.
//!
//! `stress [--scale X] [--seed N] [--only TEXT]`; without a seed each run has another one, which is printed.

mod bank;
mod checked;
mod contacts;
mod histories;
mod library;
mod memory;

use checked::CheckedHistory;
use library::Contact;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

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

struct Arguments {
    scale: f64,
    seed: u64,
    only: String,
}

fn arguments() -> Option<Arguments> {
    let seed = std::time::UNIX_EPOCH.elapsed().map_or(1, |now| now.as_secs());
    let mut arguments = Arguments { scale: 1.0, seed, only: String::new() };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next()?;
        match option.as_str() {
            "--scale" => arguments.scale = value.parse().ok()?,
            "--seed" => arguments.seed = value.parse().ok()?,
            "--only" => arguments.only = value,
            _ => return None,
        }
    }
    Some(arguments)
}

/// Steps with every check; afterwards the expensive ones are made from time to time.
const FULLY_CHECKED: u64 = 500;

/// A contact through one kind of history.
fn checked_history(contact: &Contact, kind: usize, steps: u64, rng: &mut SmallRng) -> Outcome {
    let (_, mut history) = histories::all(contact.slip()).swap_remove(kind);
    let mut checked = CheckedHistory::new(contact);
    for number in 0..steps {
        let displacement = history(&checked.memory, rng);
        let thorough = number < FULLY_CHECKED || rng.random_ratio(1, 64);
        checked.step(displacement, thorough, rng).map_err(|failure| format!("step {number}: {failure}"))?;
    }
    Ok(())
}

fn main() -> ExitCode {
    let Some(Arguments { scale, seed, only }) = arguments() else {
        eprintln!("usage: stress [--scale X] [--seed N] [--only TEXT]");
        return ExitCode::from(2);
    };
    println!("seed {seed}, scale {scale}");
    let steps = |full: f64| (full * scale).max(100.0) as u64;
    let contacts = contacts::all();
    let mut cases: Vec<(String, &Contact, Option<usize>)> = Vec::new();
    for contact in &contacts {
        cases.push((format!("bank: {}", contact.name), contact, None));
        let kinds = histories::all(1.0).into_iter().enumerate();
        cases
            .extend(kinds.map(|(kind, (name, _))| (format!("history: {}: {name}", contact.name), contact, Some(kind))));
    }
    cases.retain(|(name, ..)| name.contains(&only));
    let (next, failures) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        while let Some((name, contact, kind)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            // Independent of other cases: the seed is a hash (Fowler, Noll, Vo) of the name.
            let hash = name.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
            let mut rng = SmallRng::seed_from_u64(hash);
            let outcome = match *kind {
                Some(kind) => {
                    // In full length with one contact, a twentieth of it with the others.
                    let full = contacts.get(kind).is_some_and(|full| std::ptr::eq(full, *contact));
                    checked_history(contact, kind, steps(if full { 1e7 } else { 5e5 }), &mut rng)
                }
                None => bank::compare(contact, steps(1e6), &mut rng),
            };
            if let Err(failure) = outcome {
                failures.fetch_add(1, Ordering::Relaxed);
                println!("FAILED: {name}\n  {failure}\n  {:?}", contact.input);
                println!("  again: make stress ARGUMENTS=\"--seed {seed} --scale {scale} --only '{name}'\"");
            }
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, |threads| threads.get()) {
            scope.spawn(work);
        }
    });
    let failures = failures.into_inner();
    println!("{} passed, {failures} failed", cases.len() - failures);
    if failures == 0 && !cases.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
