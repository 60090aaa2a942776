//! Long and adversarial histories of every contact: each kind with checks on every step, and all kinds against a bank of sliders.
//!
//! Every call traps invalid operations, divisions by zero and overflows.
//!
//! `stress [--scale X] [--only TEXT]`; `MICROSLIP_SEED` is the seed, 1 without it.

mod bank;
mod checked;
mod contacts;
mod element;
mod histories;
mod library;
mod memory;

use checked::CheckedHistory;
use element::Element;
use library::Contact;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use reference::Input;
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
    only: String,
}

fn arguments() -> Option<Arguments> {
    let mut arguments = Arguments { scale: 1.0, only: String::new() };
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next()?;
        match option.as_str() {
            "--scale" => arguments.scale = value.parse().ok()?,
            "--only" => arguments.only = value,
            _ => return None,
        }
    }
    Some(arguments)
}

/// Steps with every check; afterwards the expensive one is made from time to time.
const FULLY_CHECKED: u64 = 500;

/// A contact through one kind of history.
fn checked_history(contact: &Contact, kind: usize, steps: u64, rng: &mut SmallRng) -> Outcome {
    let (_, mut history) = histories::all(contact.slip()).swap_remove(kind);
    let mut checked = CheckedHistory::new(contact);
    for number in 0..steps {
        let displacement = history(&checked.memory, rng);
        let thorough = number < FULLY_CHECKED || rng.random_ratio(1, 64);
        checked.step(displacement, thorough).map_err(|failure| format!("step {number}: {failure}"))?;
    }
    Ok(())
}

/// A named case.
struct Case<'a> {
    name: String,
    run: Box<dyn Fn(&mut SmallRng) -> Outcome + Sync + 'a>,
}

impl<'a> Case<'a> {
    fn new(name: String, input: Input, run: impl Fn(&mut SmallRng) -> Outcome + Sync + 'a) -> Case<'a> {
        Case { name, run: Box::new(move |rng| run(rng).map_err(|failure| format!("{failure}\n  {input:?}"))) }
    }
}

/// The law of a constant load: each contact in each kind of history, and against a bank.
fn constant_load<'a>(contacts: &'a [Contact], steps: &'a (dyn Fn(f64) -> u64 + Sync)) -> Vec<Case<'a>> {
    let mut cases = Vec::new();
    for (number, contact) in contacts.iter().enumerate() {
        let Contact { name, input, .. } = contact;
        let run = |rng: &mut SmallRng| bank::compare(contact, steps(1e6), rng);
        if !contacts::has_layer(input) {
            cases.push(Case::new(format!("bank: {name}"), *input, run));
        }
        for (kind, (history, _)) in histories::all(1.0).into_iter().enumerate() {
            // In full length with one contact, a twentieth of it with the others.
            let full = if kind == number { 1e7 } else { 5e5 };
            let run = move |rng: &mut SmallRng| checked_history(contact, kind, steps(full), rng);
            cases.push(Case::new(format!("history: {name}: {history}"), *input, run));
        }
    }
    cases
}

/// Elements of each contact that is not too wide for its length, with both normal inputs.
fn elements(contacts: &[Contact]) -> Vec<(String, Element)> {
    let element = |contact: &Contact, by_force: bool| {
        let name = format!("{}, {}", contact.name, if by_force { "force" } else { "approach" });
        Some((name, Element::new(&contact.input, by_force)?))
    };
    contacts.iter().flat_map(|contact| [false, true].map(|by_force| element(contact, by_force))).flatten().collect()
}

/// The law of a varying load.
fn varying_load<'a>(elements: &'a [(String, Element)], steps: &'a (dyn Fn(f64) -> u64 + Sync)) -> Vec<Case<'a>> {
    let mut cases = Vec::new();
    for (number, (name, element)) in elements.iter().enumerate() {
        for (place, kind) in element::KINDS.into_iter().enumerate() {
            let full = if place == number % element::KINDS.len() { 1e7 } else { 1e6 };
            let run = move |rng: &mut SmallRng| element::checked_history(element, kind, steps(0.2 * full), rng);
            cases.push(Case::new(format!("element: {name}: {kind}"), element.input, run));
        }
        let full = if number == 0 { 1e8 } else { 1e6 };
        let cycles = move |rng: &mut SmallRng| element::cycles(element, steps(full), rng);
        cases.push(Case::new(format!("element, cycles: {name}"), element.input, cycles));
        if element.by_force() && !contacts::has_layer(&element.input) {
            let springs = |rng: &mut SmallRng| element::springs::compare(element, steps(1e5), rng);
            cases.push(Case::new(format!("element, springs: {name}"), element.input, springs));
        }
    }
    for number in 0..16 {
        let run = move |rng: &mut SmallRng| element::two_directions::histories(steps(1e5), rng);
        cases.push(Case { name: format!("element, two directions: {number}"), run: Box::new(run) });
    }
    cases.push(Case {
        name: "element: Mindlin and Deresiewicz".to_owned(),
        run: Box::new(|_| element::mindlin::compare()),
    });
    cases
}

fn main() -> ExitCode {
    let Some(Arguments { scale, only }) = arguments() else {
        eprintln!("usage: stress [--scale X] [--only TEXT]");
        return ExitCode::from(2);
    };
    let seed = reference::seed();
    println!("seed {seed}, scale {scale}");
    let steps = |full: f64| (full * scale).max(100.0) as u64;
    let steps: &(dyn Fn(f64) -> u64 + Sync) = &steps;
    let contacts = contacts::all();
    let elements = elements(&contacts);
    let mut cases: Vec<Case> = constant_load(&contacts, steps);
    cases.extend(varying_load(&elements, steps));
    cases.retain(|case| case.name.contains(&only));
    let (next, failures) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(Case { name, run }) = cases.get(number) else { break };
            if scale >= 0.1 {
                eprintln!("{} of {}: {name}", number + 1, cases.len());
            }
            // Independent of other cases: the seed is a hash (Fowler, Noll, Vo) of the name.
            let hash = name.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
            if let Err(failure) = run(&mut SmallRng::seed_from_u64(hash)) {
                failures.fetch_add(1, Ordering::Relaxed);
                println!("FAILED: {name}\n  {failure}");
                println!("  again: MICROSLIP_SEED={seed} make stress ARGUMENTS=\"--scale {scale} --only '{name}'\"");
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
